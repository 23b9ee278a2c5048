// --------------------------------------------------------------------------------------------------- tables of a limits' page
/// Two axes or more: the last has the columns, and a cell says how far its combination is stable.
function gridTable(result, rows, varied, unit) {
  const across = varied.at(-1), down = varied.slice(0, -1), key = labels => JSON.stringify(down.map(axis => labels[axis.name]));
  const groups = [...new Set(rows.map(row => key(row.labels)))].map(id => rows.filter(row => key(row.labels) === id));
  return table([...down.map(axis => ({title: axis.name, value: group => group[0].labels[axis.name]})), ...across.labels.map(label => ({title: worded(across.name, label), value: group => {
    const row = group.find(r => r.labels[across.name] === label);
    if (!row) return "–";
    return element("span", {}, edgeText(row, unit).replace(/^stable /, ""), ...[row.below, row.above].filter(edge => edge?.failure).map(({failure}) =>
      element("span", {class: "quiet mode"}, swatch(reasonOf(failure)), reasonWords(failure.reason ?? ""))));
  }}))], groups, {stacked: true});
}

function showEdges(result, unit) {
  const rows = (result.edges ?? []).map(edge => ({...edge, failure: edge.failure ?? {}}));
  if (!rows.length) return;
  const varied = (result.axes ?? []).filter(axis => axis.labels.length > 1), failure = (title, key, more = {}) => ({title, value: r => r.failure[key] ?? "", sort: r => r.failure[key], ...more});
  const value = (title, key, missing) => ({title: `${title}${unit ? `, ${unit}` : ""}`, number: true, value: r => r[key] === null || r[key] === undefined ? missing : format(r[key], 4), sort: r => r[key]});
  section("Edges", table([...varied.map(axis => ({title: axis.name, value: r => r.labels[axis.name] ?? ""})), {title: "Unstable", value: r => r.unstable_from === null ? "nowhere" : r.direction ?? "above"},
    value("Last stable", "stable_up_to", "none"), value("First unstable", "unstable_from", "none"), failure("Reason", "reason"), failure("Step", "step", {number: true}),
    ...(rows.some(r => r.out_of_order?.length) ? [{title: "Contradicted at", value: r => (r.out_of_order ?? []).map(v => format(v, 3)).join(", ")}] : [])], rows, {sortable: true, stacked: true}));
  const told = rows.filter(r => r.failure.message || r.failure.remedy);
  if (told.length) page.append(element("h3", {}, "What the failures say"), table([{title: "Combination", value: r => labelWords(r.labels) || "all points"}, failure("Reason", "reason"),
    failure("What happened", "message"), failure("What to change", "remedy")], told, {stacked: true}));
  const trials = rows.flatMap(edge => (edge.trials ?? []).map(trial => ({...trial, labels: edge.labels})));
  if (trials.length) page.append(element("details", {}, element("summary", {}, `All ${trials.length} trials`), table([...varied.map(axis => ({title: axis.name, value: r => r.labels[axis.name] ?? ""})),
    value("Value", "value", "–"), {title: "End", value: r => (r.end ?? "").replace("_", " ")}, {title: "Reason", value: r => r.reason ?? ""}, {title: "Step", key: "step", number: true}], trials, {sortable: true})));
}
