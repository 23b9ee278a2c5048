// ------------------------------------------------------------------------------------- axes in pixels, and words beside a mark
function tickNumber(v) {
  const exponent = Math.floor(Math.log10(v) + 1e-9), mantissa = Number((v / 10 ** exponent).toPrecision(3));
  if (v >= 1e-3 && v < 1e5) return String(Number(v.toPrecision(3)));
  return mantissa === 1 ? `10${raised(exponent)}` : `${mantissa}·10${raised(exponent)}`;
}

/// A logarithmic axis over positive values, from pixel `from` to `to`: at(value), ticks [{value, text}], fine [value].
function logAxis(values, from, to, {room = .06, decades = .5, apart = 90} = {}) {
  const logs = values.map(Math.log10);
  let low = Math.min(...logs), high = Math.max(...logs);
  const lack = Math.max(0, decades - (high - low)), pad = room * Math.max(decades, high - low) + lack / 2;
  low -= pad; high += pad;
  const each = Math.abs(to - from) / (high - low), at = v => from + (Math.log10(v) - low) / (high - low) * (to - from);
  const inside = mantissas => {
    const found = [];
    for (let e = Math.floor(low); e <= Math.ceil(high); ++e) for (const m of mantissas) if (m * 10 ** e >= 10 ** low && m * 10 ** e <= 10 ** high) found.push(m * 10 ** e);
    return found;
  };
  const labelled = each > 4 * apart ? [1, 1.5, 2, 3, 4, 5, 7] : each > 1.6 * apart ? [1, 2, 5] : each > .9 * apart ? [1, 3] : [1];
  let ticks = inside(labelled);
  const skip = Math.ceil(apart / 2.5 / each);  // of decades too near to each other
  if (labelled.length === 1 && skip > 1) ticks = ticks.filter(v => Math.round(Math.log10(v)) % skip === 0);
  return {at, low: 10 ** low, high: 10 ** high, ticks: ticks.map(value => ({value, text: tickNumber(value)})), fine: each > 36 ? inside([1, 2, 3, 4, 5, 6, 7, 8, 9]) : []};
}
/// An axis of names, or of numbers of which some are not positive: evenly spaced.
function namedAxis(names, from, to) {
  const at = i => from + (i + .5) / names.length * (to - from);
  return {at, ticks: names.map((text, value) => ({value, text})), fine: []};
}
/// As logAxis, with even steps.
function linearAxis(values, from, to, {room = .04, apart = 90} = {}) {
  let low = Math.min(...values), high = Math.max(...values);
  const pad = room * (high - low) || Math.abs(low) * .1 || 1;
  low -= pad; high += pad;
  const rough = (high - low) * apart / Math.abs(to - from), power = 10 ** Math.floor(Math.log10(rough)), step = power * [1, 2, 5, 10].find(m => m * power >= rough);
  const ticks = [];
  for (let i = Math.ceil(low / step); i * step <= high; ++i) ticks.push({value: i * step, text: format(i * step, 12)});
  return {at: v => from + (v - low) / (high - low) * (to - from), low, high, ticks, fine: []};
}

/// An SVG path through points [x, y].
const pathThrough = points => points.map(([x, y], i) => `${i ? "L" : "M"}${x.toFixed(1)} ${y.toFixed(1)}`).join("");

/// Puts a box of words above the point (x, y) of `plot`, or below it where that is outside of the plot and below there is room.
function placeTip(tip, plot, x, y) {
  const above = y - tip.offsetHeight - 14, below = y + 16, frame = plot.getBoundingClientRect();
  const fits = frame.top + below + tip.offsetHeight < innerHeight || frame.top + above < 0;
  tip.style.left = `${Math.max(0, Math.min(x - tip.offsetWidth / 2, plot.clientWidth - tip.offsetWidth))}px`;
  tip.style.top = `${above < -30 && fits ? below : above}px`;
}
