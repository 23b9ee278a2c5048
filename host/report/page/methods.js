// ----------------------------------------------------------------------------- methods: combinations of axes, and their looks
const worded = (axis, label) => label !== "" && Number.isFinite(Number(label)) ? `${axis} ${label}` : label;
const placeOf = name => (data.axes ?? []).findIndex(axis => axis.name === name);
/// A point's settings in the order of the axes; those without a choice tell nothing.
const labelWords = labels => Object.entries(labels).filter(([name]) => !(data.axes ?? []).some(axis => axis.name === name && axis.labels.length === 1))
  .sort(([a], [b]) => placeOf(a) - placeOf(b)).map(([axis, label]) => worded(axis, label)).join(", ");

/// Distinct combinations that the labels of `things` make of `axes` (axes with one label say nothing and stand in none of
/// the names): {id, labels, name, tone, shape, dash}. Of two axes or more the one with the most labels, eight at most, has
/// the colours and the others together the marks.
function methodsOf(axes, things) {
  const found = new Map();
  for (const thing of things) {
    const labels = Object.fromEntries(axes.map(axis => [axis.name, thing.labels?.[axis.name] ?? ""])), id = JSON.stringify(labels);
    if (!found.has(id)) found.set(id, {id, labels, members: []});
    found.get(id).members.push(thing);
  }
  const methods = [...found.values()], varied = axes.filter(axis => new Set(methods.map(m => m.labels[axis.name])).size > 1);
  const order = method => axes.map(axis => axis.labels.indexOf(method.labels[axis.name]));
  methods.sort((a, b) => { const [i, j] = [order(a), order(b)], k = i.findIndex((v, n) => v !== j[n]); return k < 0 ? 0 : i[k] - j[k]; });
  const coloured = varied.length < 2 ? null : [...varied].sort((a, b) => (b.labels.length <= 8) - (a.labels.length <= 8) || b.labels.length - a.labels.length)[0];
  const rest = [...new Set(methods.map(m => JSON.stringify(varied.filter(a => a !== coloured).map(a => m.labels[a.name]))))];
  methods.forEach((method, i) => {
    const other = coloured ? rest.indexOf(JSON.stringify(varied.filter(a => a !== coloured).map(a => method.labels[a.name]))) : i;
    method.name = varied.map(axis => worded(axis.name, method.labels[axis.name])).join(", ") || "all points";
    method.tone = `--c${(coloured ? coloured.labels.indexOf(method.labels[coloured.name]) : i) % 8}`;
    method.shape = other % 8;
    method.dash = coloured || i > 7 ? ["", "7 3", "2 3", "9 3 2 3"][(coloured ? other : i >> 3) % 4] : "";
  });
  return {methods, varied};
}

/// Buttons that switch labels of axes on and off. `hidden` is a set of "axis\nlabel".
const labelKey = (axis, label) => `${axis}\n${label}`;
function axisButtons(axes, hidden, changed) {
  return axes.map(axis => element("div", {class: "choices", role: "group", "aria-label": axis.name}, element("span", {class: "quiet"}, axis.name),
    ...axis.labels.map(label => {
      const key = labelKey(axis.name, label), button = element("button", {type: "button", "aria-pressed": "true", onclick: () => {
        if (!hidden.delete(key)) hidden.add(key);
        button.setAttribute("aria-pressed", String(!hidden.has(key)));
        changed();
      }}, label);
      return button;
    })));
}
const labelsShown = (labels, hidden) => Object.entries(labels).every(([axis, label]) => !hidden.has(labelKey(axis, label)));

/// Rows of names and texts; those without a text are left out.
const factTable = rows => table([{title: "", value: r => r[0]}, {title: "", value: r => element("code", {}, r[1])}], rows.filter(([, text]) => text !== null && text !== undefined && text !== ""));
const mebibytes = bytes => bytes ? `${format(bytes / 1048576, 3)} MiB` : "–";
function showOrigin(result, file, name) {
  const machine = result.machine ?? {};
  section("Machine and provenance", factTable([[name, file], ["Scene", typeof result.scene_file === "string" ? result.scene_file : null],
    ["Program", result.program], ["Program, SHA-256", result.program_sha256], ["Processor", machine.cpu], ["Cores", machine.cores && String(machine.cores)],
    ["Memory", machine.memory_bytes && mebibytes(machine.memory_bytes)], ["System", machine.system], ["Compiler", machine.compiler], ["Started", result.started], ["Finished", result.finished]]));
}
