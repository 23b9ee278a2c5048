// --------------------------------------------------------------------------------------------------- outlines and their colours
const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

/// Numbers of all nodes of a run, so many each: values(place among the cells that are there, axis, index among the numbers
/// that are written) of an output; NaN of cells that are not there.
function spreadOut({data, first, count}, output, axes, values) {
  const all = new Float32Array(axes * first[count]).fill(NaN), there = data.there[output] ?? Array.from({length: count}, (_, cell) => cell);
  let written = 0;
  there.forEach((cell, place) => { for (let i = axes * first[cell]; i < axes * first[cell + 1]; ++i) all[i] = values(place, i % axes, written++); });
  return all;
}

/// Nodes of an output in micrometres, so many coordinates each.
function decodedNodes(cells, output, axes) {
  const {nodes, origin_um, quantum_um: quantum} = cells.data, view = new DataView(bytesOf(nodes[output]).buffer), origins = origin_um[output];
  return spreadOut(cells, output, axes, (place, axis, i) => origins[axes * place + axis] + view.getInt16(2 * i, true) * quantum);
}

/// Tension over its scale, from -1 to 1, for each node, between outputs a and b.
function decodedTension(cells, a, b, share) {
  const [from, to] = [a, b].map(output => {
    const values = new Int8Array(bytesOf(cells.data.tension.values[output]).buffer);
    return spreadOut(cells, output, 1, (place, axis, i) => values[i] / 127);
  });
  return mixed(from, to, share);
}

/// Between two outputs. What only one of them has is there, as it is, in the half that belongs to that one.
const mixed = (from, to, share) => from.map((v, i) => {
  const w = to[i];
  return Number.isNaN(v) || Number.isNaN(w) ? (share < .5 ? v : w) : v + share * (w - v);
});

/// The lines of all cells as long as the run's outputs, null where a cell is not there.
function fillLines(run) {
  const {cells} = run, all = run.step.length, empty = length => Array(length).fill(null);
  if (!cells?.from) return;
  for (const [name, lines] of Object.entries(cells)) {
    if (["ids", "types", "from"].includes(name)) continue;
    const filled = (line, from, length) => [...empty(from), ...line, ...empty(length - from - line.length)];
    cells[name] = lines.map((line, i) => name === "aggregate" ? filled(line, 0, cells.ids.length) : filled(line, cells.from[i], all));
  }
}
/// The number that a cell of a page has in the scene.
const cellNumber = (run, cell) => run.cells?.ids?.[cell] ?? cell;
/// Whether there is something to be drawn in the plane, or in space.
const isInSpace = run => run.domain?.size_um.length === 3;
const isDrawn = run => Boolean(run.outlines || run.fields || run.surfaces || run.walls);
/// Whether cells come or leave.
const hasTraffic = run => Boolean(run.cells?.from);

/// Outlines of one run: nodes x, y in micrometres, not wrapped into the box, at an output or between two.
class Outlines {
  constructor(outlines) {
    Object.assign(this, {data: outlines, first: outlines.first, count: outlines.first.length - 1, known: []});
  }
  at(output) {
    return this.known[output] ??= decodedNodes(this, output, 2);
  }
  between({a, b, share}) {
    return share ? mixed(this.at(a), this.at(b), share) : this.at(a);
  }
  /// For each cell its lines, [{xy, tension}]: one, or none where it is not there.
  shapes(instant, withTension) {
    const nodes = this.between(instant), tension = withTension ? this.tension(instant) : null, {first} = this;
    return Array.from({length: this.count}, (_, cell) => Number.isNaN(nodes[2 * first[cell]]) ? []
      : [{xy: nodes.subarray(2 * first[cell], 2 * first[cell + 1]), tension: tension?.subarray(first[cell], first[cell + 1])}]);
  }
  has(shapes, cell) { return shapes[cell].length > 0; }
  /// Tension over its scale, from -1 to 1, for each node; null where there is none.
  tension({a, b, share}) {
    return this.data.tension?.scale_N_per_m ? decodedTension(this, a, b, share) : null;
  }
}

/// Red, green and blue, from 0 to 1, of a colour in the words of css.
const rgbOf = (() => {
  const context = document.createElement("canvas").getContext("2d", {willReadFrequently: true}), known = new Map();
  return text => {
    if (!known.has(text)) {
      context.fillStyle = "#888"; context.fillStyle = text; context.clearRect(0, 0, 1, 1); context.fillRect(0, 0, 1, 1);
      known.set(text, [...context.getImageData(0, 0, 1, 1).data].slice(0, 3).map(v => v / 255));
    }
    return known.get(text);
  };
})();

/// Interpolated colours as css texts. Cividis, and blue to orange: both in order for every eye.
const rampStops = {
  cividis: ["#00204d", "#2b3f6d", "#575c6d", "#7c7b78", "#a69d75", "#d3c164", "#ffe945"],
  tension: ["#0b4f9e", "#5b93cf", "#a9b4c2", "#e0934a", "#a84300"],
};
const rampColour = (stops, share) => `rgb(${rampRgb(stops, share).map(v => Math.round(255 * v)).join(",")})`;
/// Red, green and blue from 0 to 1.
function rampRgb(stops, share) {
  const at = Math.min(1, Math.max(0, share)) * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at));
  const [low, high] = [stops[i], stops[i + 1]].map(hex => [1, 3, 5].map(k => parseInt(hex.slice(k, k + 2), 16)));
  return low.map((c, k) => (c + (at - i) * (high[k] - c)) / 255);
}

/// Tones of the aggregates by output: single cells are grey, and aggregates that are there at the same time differ.
function aggregateTones(aggregates) {
  let before = new Map();
  return aggregates.map(labels => {
    const sizes = new Map();
    for (const label of labels) if (label !== null) sizes.set(label, (sizes.get(label) ?? 0) + 1);
    const now = new Map(), big = [...sizes.keys()].filter(label => sizes.get(label) > 1);
    for (const label of big) if (before.has(label)) now.set(label, before.get(label));
    for (const label of big) if (!now.has(label)) { let tone = 0; while ([...now.values()].includes(tone) && tone < lineTones.length - 1) ++tone; now.set(label, tone); }
    before = now;
    return labels.map(label => now.has(label) ? lineTones[now.get(label)] : "--single");
  });
}

const percentile = (values, share) => { const sorted = values.filter(v => v !== null).sort((a, b) => a - b); return sorted[Math.round(share * (sorted.length - 1))] ?? 0; };

/// What colours the cells of one run can have: name -> {title, tone (a style's name) or colour of a cell, bar}. A colour means the same in all `runs` of a page.
function cellColours(run, runs = [run]) {
  const {cells} = run, colours = {}, tonesOf = cells && aggregateTones(cells.aggregate);
  if (!run.outlines && !run.surfaces) return colours;
  // In space one cell hides another: they look as they do under a microscope until something else is asked for.
  if (run.surfaces) colours.blood = {title: "red", tone: () => "--blood", bar: () => []};
  if (cells && cells.types.length > 1) {
    colours.cell = {title: "cell", tone: cell => lineTones[cellNumber(run, cell) % lineTones.length], bar: () => []};
  }
  if (cells && cells.types.length > 1 && attracts(run)) {
    colours.aggregate = {title: "aggregate", tone: (cell, {a, b, share}) => tonesOf[share < .5 ? a : b][cell],
      bar: () => [element("span", {}, "Colour: aggregate"), element("span", {class: "quiet"}, "single cells are grey")]};
  }
  if (cells) {
    const types = [...new Set(cells.types)];
    colours.type = {title: "cell type", tone: cell => lineTones[types.indexOf(cells.types[cell]) % lineTones.length],
      bar: () => types.map((type, i) => element("span", {}, element("i", {class: "dot", style: `background:var(${lineTones[i % lineTones.length]})`}), type))};
    const ranged = (name, title, unit, low, high) => withScale({title, colour: (cell, {a, b, share}) => {
      const [at, then] = [a, b].map(output => cells[name][cell][output]), from = at ?? then, to = then ?? at;
      return from === null || to === null ? "#888" : rampColour(rampStops.cividis, ((from + share * (to - from)) - low) / (high - low || 1));
    }}, {title: `${spelled(title)}${unit}`, stops: rampStops.cividis, ends: [format(low, 3), format((low + high) / 2, 3), `≥ ${format(high, 3)}`]});
    const [deformation, speeds] = ["deformation", "speed_um_per_s"].map(name => cells[name] ? runs.flatMap(other => other.cells?.[name]?.flat() ?? []) : []);
    if (deformation.some(v => v !== null)) colours.deformation = ranged("deformation", "deformation", "", percentile(deformation, .01), percentile(deformation, .99));
    if (speeds.some(v => v !== null)) colours.speed = ranged("speed_um_per_s", "speed of the cell", ", µm/s", 0, percentile(speeds, .99));
  }
  const tensionOf = ({outlines, surfaces}) => outlines?.tension?.scale_N_per_m || surfaces?.tension?.scale_N_per_m || 0, scale = tensionOf(run) && Math.max(...runs.map(tensionOf)), own = tensionOf(run) / scale;
  if (scale) colours.tension = withScale({title: "membrane tension", tension: share => rampColour(rampStops.tension, (own * share + 1) / 2), rgb: share => rampRgb(rampStops.tension, (own * share + 1) / 2), tone: () => "--single"},
    {title: "Membrane tension, µN/m", stops: rampStops.tension, ends: [`≤ ${format(-scale * 1e6, 3)}`, "0", `≥ ${format(scale * 1e6, 3)}`]});
  colours.grey = {title: "grey", tone: () => "--single", bar: () => []};
  return colours;
}
const withScale = (colour, scale) => ({...colour, scale, bar: () => rampBar(scale.title, scale.stops, scale.ends)});
const rampBar = (title, stops, ends) => [element("div", {}, title), element("div", {class: "ramp", style: `background:linear-gradient(to right, ${stops.join(", ")})`}),
  element("div", {class: "ends"}, ...ends.map(text => element("span", {}, text)))];
