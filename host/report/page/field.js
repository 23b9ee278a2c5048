// ------------------------------------------------------------------------------------------ the flow under the cells
// Greys for what has no sign, green and brown around nothing for what has one: both can be told apart without seeing
// red and green, and leave the colours to the aggregates.
const ramps = {
  light: {speed: ["#ffffff", "#d3dce6", "#93a9be", "#4d6c8b", "#1f3a56"], vorticity: ["#01665e", "#7cc4b8", "#ffffff", "#d9b36c", "#8c510a"]},
  dark: {speed: ["#1d2126", "#33475b", "#557593", "#88a9c4", "#cfe1ef"], vorticity: ["#7fe0d2", "#2f7d74", "#1d2126", "#8a6426", "#f0c277"]},
};
const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches && !printing;
const rampOf = name => ramps[isDark() ? "dark" : "light"][name];

/// 256 colours, as red, green, blue; the last stands for what is undefined.
function palette(name) {
  const stops = rampOf(name).map(hex => [1, 3, 5].map(i => parseInt(hex.slice(i, i + 2), 16))), colours = [];
  for (let level = 0; level < 255; ++level) {
    const at = level / 254 * (stops.length - 1), i = Math.min(stops.length - 2, Math.floor(at));
    colours.push(stops[i].map((c, k) => Math.round(c + (stops[i + 1][k] - c) * (at - i))));
  }
  colours.push([128, 128, 128]);
  return colours;
}

const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

/// The fields of one run: pictures of a quantity at an output.
class Fields {
  constructor(fields) {
    this.fields = fields;
    this.canvas = document.createElement("canvas");
    this.canvas.width = fields.nx; this.canvas.height = fields.ny;
  }
  quantity(name) { return this.fields.quantities.find(q => q.name === name); }
  /// Number of the fields that hold at an output: those of it, or the last before it; -1 before the first.
  index(output) { return this.fields.outputs.findLastIndex(o => o <= output); }
  /// A canvas of one pixel for each block; the first row is the lowest.
  picture(name, index) {
    const key = `${name} ${index} ${isDark()}`;
    if (this.drawn === key) return this.canvas;
    this.drawn = key;
    const levels = bytesOf(this.quantity(name).values[index]), colours = palette(name), context = this.canvas.getContext("2d");
    const image = context.createImageData(this.fields.nx, this.fields.ny);
    levels.forEach((level, i) => { image.data.set(colours[level], 4 * i); image.data[4 * i + 3] = 255; });
    context.putImageData(image, 0, 0);
    return this.canvas;
  }
}

const fieldTitles = {speed: "velocity magnitude", vorticity: "vorticity"};

/// Speeds are told in the unit that keeps them readable.
function scaled(quantity) {
  if (quantity.unit !== "m/s") return {unit: quantity.unit, factor: 1};
  return [["m/s", 1], ["mm/s", 1e3], ["µm/s", 1e6]].map(([unit, factor]) => ({unit, factor})).find(s => quantity.scale * s.factor >= 1) || {unit: "µm/s", factor: 1e6};
}

/// Colour bar of a quantity: its range, with a word where some nodes lie beyond.
function colourBar(quantity, words) {
  const {unit, factor} = scaled(quantity), high = quantity.scale * factor;
  const end = (sign, beyond) => `${quantity.clipped ? beyond + " " : ""}${format(sign * high, 3)}`;
  return [element("div", {}, `${spelled(fieldTitles[quantity.name])}, ${unit}`, element("span", {class: "quiet"}, words ? ` – ${words}` : "")),
    element("div", {class: "ramp", style: `background:linear-gradient(to right, ${rampOf(quantity.name).join(", ")})`}),
    element("div", {class: "ends"}, ...(quantity.signed ? [end(-1, "≤"), "0", end(1, "≥")] : ["0", format(high / 2, 3), end(1, "≥")]).map(text => element("span", {}, text)))];
}
