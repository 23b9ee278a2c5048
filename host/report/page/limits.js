// --------------------------------------------------------------------------------------------------------- the page of limits
const count = (number, one, many = `${one}s`) => `${number} ${number === 1 ? one : many}`;

/// "stable up to 235 1/s, fails at 251 1/s (sound waves)".
function edgeSentence(row, unit) {
  const value = v => `${format(v, 3)} ${unit}`.trim(), {above, below} = row, how = edge => edge.failure ? ` (${reasonWords(edge.failure.reason ?? "")})` : "", text = edgeText(row, unit);
  if (text === "not known yet") return "nothing is known yet";
  const nowhere = [above, below].find(edge => edge && edge.stable_up_to === null);
  if (nowhere) return `fails everywhere that was tried${how(nowhere)}`;
  const parts = [below?.unstable_from != null ? `fails at ${value(below.unstable_from)} and below${how(below)}, stable from ${value(below.stable_up_to)}` : null,
    above?.unstable_from != null ? `stable up to ${value(above.stable_up_to)}, fails at ${value(above.unstable_from)}${how(above)}` : null].filter(Boolean);
  return parts.length ? parts.join("; ") : "stable at every value that was tried";
}

/// What the map comes to, in sentences.
function limitsSentences(result, rows, unit) {
  const said = [], {parameter} = result, name = spelled(parameter?.name ?? "the parameter");
  if (rows.length === 1) said.push(`${name}: ${edgeSentence(rows[0], unit)}.`);
  else if (rows.length) {
    const are = words => rows.filter(row => edgeText(row, unit) === words).length, unknown = are("not known yet"), nowhere = are("stable nowhere"), throughout = are("stable throughout");
    const edges = rows.filter(row => row.above?.unstable_from != null && row.above.stable_up_to !== null).sort((a, b) => a.above.stable_up_to - b.above.stable_up_to), [first, last] = [edges[0], edges.at(-1)];
    const ranged = [parameter.from, parameter.to].every(v => typeof v === "number") ? ` from ${format(parameter.from, 3)} to ${`${format(parameter.to, 3)} ${unit}`.trim()}` : "";
    const parts = [throughout ? `${throughout} ${throughout === 1 ? "is" : "are"} stable throughout` : null, nowhere ? `${nowhere} ${nowhere === 1 ? "fails" : "fail"} everywhere` : null,
      rows.length - nowhere - throughout - unknown ? `${count(rows.length - nowhere - throughout - unknown, "has an edge", "have an edge")}` : null, unknown ? `of ${unknown} nothing is known yet` : null].filter(Boolean);
    said.push(`${name}${ranged}, ${count(rows.length, "combination")}: ${parts.join(", ")}.`);
    if (first) said.push(`First to fail: ${first.name}, ${edgeSentence(first, unit)}.`);
    if (last && last !== first) said.push(`Last to fail: ${last.name}, ${edgeSentence(last, unit)}.`);
  }
  return said;
}

function showLimits(result) {
  const title = result.title || "Untitled limits", unit = result.parameter?.unit ?? "";
  document.title = `${title} – Rouleau`;
  page.append(element("h1", {}, title), note([result.limits_file, result.started, result.machine?.cpu].filter(Boolean).join(" · ")));
  const {methods: rows, varied} = methodsOf(result.axes ?? [], result.edges ?? []), said = limitsSentences(result, mapRows(result), unit);
  page.append(element("div", {class: "card status sentences"},
    element("ul", {}, ...(said.length ? said : ["Nothing has been tried yet."]).map(s => element("li", {}, s)))));
  const warnings = [...(result.complete === false ? ["The search is not finished; the same command continues it."] : []), ...(result.warnings ?? [])];
  if (warnings.length) page.append(warningBox(warnings));
  page.append(links);
  const map = rows.length ? showMap(result, varied, unit) : null;
  showEdges(result, unit);
  showSoundness(result);
  showOrigin(result, result.limits_file, "Limits");
  footer(programOf(result), "This page shows one search for limits; all that it draws is in it.", result.limits_file ? `rouleau limits ${result.limits_file}` : null, "with the file of the search");
  return map;
}

/// How long each trial ran, and what of one that completed counts as a failure.
function showSoundness({steps, sound, parameter}) {
  const facts = [["Steps of each trial", typeof steps === "number" ? format(steps) : null], ...(parameter?.pointers ?? []).map(pointer => ["Varied", pointer]),
    ["Edge found to", typeof parameter?.precision === "number" ? `${parameter.scale === "linear" ? "" : "a factor of "}${format(parameter.precision, 4)}` : null],
    ...Object.entries(sound ?? {}).map(([name, limit]) => [`Fails above: ${spelled(name).toLowerCase()}`, typeof limit === "number" ? format(limit) : null])];
  if (facts.some(([, text]) => text)) section("What counts as failed", factTable(facts), note("A run can also be stopped by its own checks. One that completes, but exceeds one of these values, has failed silently."));
}

function showMap(result, varied, unit) {
  const controls = element("div", {class: "controls"}), place = element("div", {}), hidden = new Set();
  section("Map of stability", controls);
  const map = new LimitsMap(place, result);
  page.append(element("div", {class: "card keys"}, mapLegend(map.rows)), place,
    note("A bar goes from the least to the most value tried. Point at a bar to read what a trial came to."));
  const order = element("select", {"aria-label": "Order", onchange: () => {
    const edge = row => row.above?.stable_up_to ?? row.below?.stable_up_to ?? -Infinity;
    const sorted = order.value === "edge" ? [...map.rows].sort((a, b) => edge(b) - edge(a)) : map.rows;
    map.axisLine.before(...sorted.map(row => row.line));
  }}, element("option", {value: ""}, "as in the matrix"), element("option", {value: "edge"}, "by edge"));
  controls.append(element("label", {}, "Order", order), ...(varied.length ? axisButtons(varied, hidden, () => { for (const row of map.rows) row.line.hidden = !labelsShown(row.labels, hidden); }) : []));
  if (varied.length > 1) page.append(element("h3", {}, "Stable range, as a grid"), gridTable(result, map.rows, varied, unit));
  return map;
}
const data = JSON.parse(document.getElementById("data").textContent);
const map = showLimits(data);
