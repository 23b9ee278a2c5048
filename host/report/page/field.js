// ------------------------------------------------------------------------------------------ the flow under the cells
// Greys for what has no sign, green and brown around nothing for what has one: both can be told apart without seeing
// red and green.
const ramps = {
  light: {speed: ["#ffffff", "#d3dce6", "#93a9be", "#4d6c8b", "#1f3a56"], vorticity: ["#01665e", "#7cc4b8", "#ffffff", "#d9b36c", "#8c510a"]},
  dark: {speed: ["#1d2126", "#33475b", "#557593", "#88a9c4", "#cfe1ef"], vorticity: ["#7fe0d2", "#2f7d74", "#1d2126", "#8a6426", "#f0c277"]},
};
const isDark = () => matchMedia("(prefers-color-scheme: dark)").matches && !printing;
const rampOf = name => ramps[isDark() ? "dark" : "light"][name];

/// 256 colours, as red, green, blue; the last stands for what is undefined.
function palette(name) {
  const stops = rampOf(name), colours = [];
  for (let level = 0; level < 255; ++level) colours.push(rampColour(stops, level / 254).match(/\d+/g).map(Number));
  colours.push([128, 128, 128]);
  return colours;
}

/// The fields of one run: pictures of a quantity, and the velocity at a point.
class Fields {
  constructor(run) {
    Object.assign(this, {run, fields: run.fields, pictures: new Map(), decoded: []});
  }
  quantity(name) { return this.fields.quantities.find(q => q.name === name); }
  get moves() { return Boolean(this.fields.velocity); }
  /// Between which fields an instant lies, {a, b, share} of field numbers: interpolated within a stage, else the last
  /// before it; null before the first.
  between({a, b, share}) {
    const {outputs} = this.fields, {stage, time_s: time} = this.run, low = outputs.findLastIndex(o => o <= a), high = low + 1;
    if (low < 0) return null;
    if (high >= outputs.length || stage[outputs[high]] !== stage[outputs[low]]) return {a: low, b: low, share: 0};
    const now = time[a] + share * (time[b] - time[a]), [from, to] = [low, high].map(i => time[outputs[i]]);
    return {a: low, b: high, share: to > from ? Math.min(1, Math.max(0, (now - from) / (to - from))) : 0};
  }
  /// The time of the last field before an instant, in words, where no later one says what came of it; else nothing.
  asOf(instant) {
    const now = this.between(instant), {outputs} = this.fields;
    return now && now.a === now.b && (outputs[now.a] < instant.a || instant.share > 0) ? `as of ${format(this.run.time_s[outputs[now.a]], 3)} s` : "";
  }
  /// A canvas of one pixel for each block; the first row is the lowest.
  picture(name, index) {
    const key = `${name} ${index} ${isDark()}`;
    if (!this.pictures.has(key)) {
      if (this.pictures.size > 8) this.pictures.delete(this.pictures.keys().next().value);
      const canvas = document.createElement("canvas"), {nx, ny} = this.fields;
      canvas.width = nx; canvas.height = ny;
      const levels = bytesOf(this.quantity(name).values[index]), colours = palette(name), context = canvas.getContext("2d"), image = context.createImageData(nx, ny);
      levels.forEach((level, i) => { image.data.set(colours[level], 4 * i); image.data[4 * i + 3] = 255; });
      context.putImageData(image, 0, 0);
      this.pictures.set(key, canvas);
    }
    return this.pictures.get(key);
  }
  /// A function of (x, y) in um that gives u, v in um/s, in an array of its own that the next call writes again; null
  /// outside of what was written.
  velocity({a, b, share}) {
    const {nx, ny, scale, values} = this.fields.velocity, [x0, y0, width, height] = this.fields.box_um, whole = Math.abs(width - this.run.domain.size_um[0]) < 1e-6 * width;
    const [from, to] = [a, b].map(i => this.decoded[i] ??= new Int8Array(bytesOf(values[i]).buffer)), factor = scale * 1e6 / 127, now = new Float32Array(from.length), result = [0, 0];
    for (let i = 0; i < now.length; ++i) now[i] = factor * (from[i] + share * (to[i] - from[i]));
    return (x, y) => {
      let i = (x - x0) / width * nx - .5, j = (y - y0) / height * ny - .5;
      if (whole) i -= Math.floor(i / nx) * nx; else if (i < -.5 || i > nx - .5) return null;
      if (j < -.5 || j > ny - .5) return null;
      i = whole ? i : Math.min(nx - 1, Math.max(0, i)); j = Math.min(ny - 1, Math.max(0, j));
      const left = Math.floor(i), low = Math.floor(j), right = whole ? (left + 1) % nx : Math.min(nx - 1, left + 1), high = Math.min(ny - 1, low + 1), fx = i - left, fy = j - low;
      const [ll, lr, hl, hr] = [low * nx + left, low * nx + right, high * nx + left, high * nx + right];
      for (let k = 0; k < 2; ++k)
        result[k] = (now[2 * ll + k] * (1 - fx) + now[2 * lr + k] * fx) * (1 - fy) + (now[2 * hl + k] * (1 - fx) + now[2 * hr + k] * fx) * fy;
      return result;
    };
  }
}

/// Numbers in [0, 1) that are always the same.
const scattered = n => { const v = Math.sin(n * 127.1 + 311.7) * 43758.5453; return v - Math.floor(v); };

/// Tracers, drawn as short trails: each starts at a place of its own, goes with the flow for about a second of the
/// animation and begins anew. What is seen depends on the instant alone, not on how it was reached.
function drawTracers(context, flow, {position, life, seconds, box: [x0, y0, width, height], scale, shift, number}) {
  const columns = Math.max(1, Math.round(Math.sqrt(number * width / height))), rows = Math.max(1, Math.round(number / columns)), steps = 9;
  context.lineCap = "round"; context.lineWidth = 1.5;
  for (let k = 0; k < columns * rows; ++k) {
    const turn = position / life + scattered(k), phase = turn - Math.floor(turn), generation = 7919 * Math.floor(turn);
    let x = x0 + (k % columns + scattered(2 * k + generation)) / columns * width, y = y0 + (Math.floor(k / columns) + scattered(2 * k + 1 + generation)) / rows * height;
    const trail = [], step = phase * seconds / steps;
    for (let i = 0; i <= steps; ++i) {
      if (i >= steps - 3) trail.push([x, y]);
      const here = flow(x, y);
      if (!here) break;
      const [u, v] = here, middle = flow(x + u * step / 2, y + v * step / 2) ?? [u, v];
      x += middle[0] * step; y += middle[1] * step;
    }
    if (trail.length < 2) continue;
    context.globalAlpha = .75 * Math.sin(Math.PI * phase);
    for (const move of shift(trail[0][0])) {
      context.beginPath();
      for (const [px, py] of trail) context.lineTo((px + move) * scale, py * scale);
      context.stroke();
    }
  }
  context.globalAlpha = 1;
}

const fieldTitles = {speed: "velocity magnitude", vorticity: "vorticity"};

/// Speeds are shown in the unit that keeps them readable.
function scaled(quantity) {
  if (quantity.unit !== "m/s") return {unit: quantity.unit, factor: 1};
  return [["m/s", 1], ["mm/s", 1e3], ["µm/s", 1e6]].map(([unit, factor]) => ({unit, factor})).find(s => quantity.scale * s.factor >= 1) || {unit: "µm/s", factor: 1e6};
}

/// Colour bar of a quantity: its range, with a word where some nodes lie beyond.
function colourBar(quantity, words) {
  const {unit, factor} = scaled(quantity), high = quantity.scale * factor;
  const end = (sign, beyond) => `${quantity.clipped ? beyond + " " : ""}${format(sign * high, 3)}`;
  return rampBar(element("span", {}, `${spelled(fieldTitles[quantity.name])}, ${unit}`, element("span", {class: "quiet"}, words ? ` – ${words}` : "")), rampOf(quantity.name),
    quantity.signed ? [end(-1, "≤"), "0", end(1, "≥")] : ["0", format(high / 2, 3), end(1, "≥")]);
}
