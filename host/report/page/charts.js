// ------------------------------------------------------------------------------------------------ charts, with uPlot
// Every chart follows the timeline: its cursor stands at the instant that is shown, and pointing at a chart goes there.
// A drag across a chart shows that stretch in all of them, a double click everything again.
const charts = [];
let zoomed = null;

/// How charts look: on paper twice as fine; dashes tell lines apart where colours do not.
function chartStyle() {
  const paper = printing;
  return {
    paper, fine: paper ? 2 : 1, text: css("--quiet"), grid: css("--grid"), line: css("--line"),
    dash: i => i % 4 > 0 ? [[8, 4], [2, 3], [10, 3, 2, 3]][i % 4 - 1] : undefined,
  };
}

/// A number of an axis whose numbers are `step` apart, with as many digits as tell it from its neighbours.
function axisNumber(v, step) {
  if (v === 0) return "0";
  const size = Math.abs(v), digits = Math.min(15, Math.max(1, Math.floor(Math.log10(size)) - Math.floor(Math.log10(step)) + 2));
  const [mantissa, exponent] = v.toExponential(digits - 1).split("e");
  return size >= 1e5 || size < 1e-4 ? `${Number(mantissa)}e${Number(exponent)}` : String(Number(v.toPrecision(digits)));
}
const axisNumbers = (u, splits, axis, space, step) => splits.map(v => v === null ? "" : axisNumber(v, step).replace(/^-/, "−"));

/// Where a column of uPlot's table has a value and neither neighbour has one: no line leads there. Undefined is what only
/// another run has.
function lonely(values) {
  const known = values.map((v, i) => i).filter(i => values[i] !== undefined);
  return known.filter((i, k) => values[i] !== null && (values[known[k - 1]] ?? null) === null && (values[known[k + 1]] ?? null) === null);
}
const wholeSteps = [1, 2, 5, 10, 20, 50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000, 50000, 100000];

/// What lies between the 5th and the 95th of a hundred values, with room, where the rest would hide it; else null.
function usualRange(lines) {
  const values = lines.flatMap(line => line.hidden ? [] : [...line.values, ...(line.band ?? [])]).filter(v => v !== null && v !== undefined);
  if (values.length < 12) return null;
  const [low, high] = [percentile(values, .05), percentile(values, .95)], spread = high - low;
  return spread > 0 && Math.max(...values) - Math.min(...values) > 3 * spread ? [low - .3 * spread, high + .3 * spread] : null;
}

function verticalRange(chart) {
  return (u, low, high) => {
    if (low === null || high === null) return [0, 1];
    const usual = !chart.everything && !chart.whole && usualRange(chart.lines);
    if (usual) { low = Math.max(low, usual[0]); high = Math.min(high, usual[1]); }
    if (chart.zero) { low = Math.min(low, 0); high = Math.max(high, 0); }
    const pad = chart.whole ? 0.5 : (high - low) * 0.06 || Math.abs(high) * 0.05 || 1;
    return [chart.zero && low === 0 ? 0 : low - pad, high + pad];
  };
}

/// Round places on an axis that shows every stage in its own measure: [{at (an output, or between two), text}].
function stageTicks(timeline, low, high, room) {
  const ticks = [], run = timeline.runs[0], each = room / Math.max(1e-9, high - low);  // pixels for each output
  for (const {from, to, over} of timeline.stages) {
    const values = run[over], begin = Math.max(from - (from > 0 ? 1 : 0), 0), span = values[to] - values[begin], wide = (Math.min(high, to) - Math.max(low, begin)) * each;
    if (wide < 20 || !(span > 0)) continue;
    const rough = (values[Math.min(to, Math.floor(high))] - values[Math.max(begin, Math.ceil(low))]) / Math.max(1, wide / 46), power = 10 ** Math.floor(Math.log10(rough || span)), step = power * [1, 2, 5, 10].find(m => m * power >= rough);
    for (let k = Math.ceil(values[begin] / step - 1e-9); k * step <= values[to] * (1 + 1e-9); ++k) {
      if (from > 0 && k * step <= values[begin]) continue;
      const i = values.findIndex((v, n) => n >= begin && v >= k * step * (1 - 1e-12)), share = i > begin ? (k * step - values[i - 1]) / (values[i] - values[i - 1]) : 0;
      const at = i > begin ? i - 1 + share : i;
      if (at >= low && at <= high) ticks.push({at, text: over === "time_s" ? `${axisNumber(k * step, step)} s` : axisNumber(k * step, step)});
    }
  }
  return ticks;
}

/// A line is {label, values (of its run's outputs), run, tone, dashed, band (values of a lower edge; `values` is the
/// upper one and the space between is tinted), cell (which it is of), picked (true: of the cell that was chosen)}.
class Chart {
  constructor(parent, timeline, {title, about = "", unit = "", lines, events = [], height = 190, steps = false, whole = false, zero = false}) {
    Object.assign(this, {timeline, lines, height, steps, whole, zero, title: title + (unit ? `, ${unit}` : ""), everything: false});
    this.range = verticalRange(this);
    this.plot = element("div", {class: "plot"});
    this.instant = element("span", {class: "instant"});
    this.keys = lines.map((line, i) => this.key(line, i));
    this.more = button("Show outliers", () => { this.everything = !this.everything; this.draw(); }, {class: "small", hidden: ""});
    this.marks = events.map(event => ({event, node: element("button", {type: "button", class: `event ${event.kind}`, tabindex: -1, title: event.text, "aria-label": `go to: ${event.text}`, onclick: () => { timeline.stop(); timeline.seek(event.position); }})}));
    parent.append(element("div", {class: "card chart", role: "group", "aria-label": title},
      element("div", {class: "chart-head"}, element("h3", {title: about}, this.title), this.more,
        saveMenu("Save", [["CSV", () => this.saveCsv()], ["SVG", () => download(fileName(title, "svg"), new Blob([chartSvg(this)], {type: "image/svg+xml"}))], ["PNG", () => savePng(this.u.ctx.canvas, fileName(title, "png"), this.title)]], `Save ${title}`)),
      element("div", {class: "legend"}, this.instant, ...this.keys.map(key => key.button)), this.plot));
    new ResizeObserver(() => this.resize()).observe(this.plot);
    timeline.listeners.push(() => this.follow());
    charts.push(this);
    this.draw();
  }
  saveCsv() {
    const {timeline} = this, run = timeline.runs[0], cell = text => /[",\n]/.test(text) ? `"${text.replaceAll('"', '""')}"` : text;
    const columns = this.lines.flatMap(line => line.band ? [[`${line.label} from`, line.band, line.run], [`${line.label} to`, line.values, line.run]] : [[line.label || this.title, line.values, line.run]]);
    const blocks = timeline.runs.map((data, r) => {
      const own = columns.filter(([, , of]) => (of ?? 0) === r);
      return [["time_s", "strain", ...own.map(([name]) => name)].map(cell).join(","), ...data.step.map((_, i) => [data.time_s[i], data.strain[i], ...own.map(([, values]) => values[i] ?? "")].join(","))].join("\n");
    });
    download(fileName(this.title, "csv"), new Blob([`${blocks.join("\n\n")}\n`], {type: "text/csv"}));
  }

  key(line, i) {
    const value = element("span", {}), name = element("span", {}, line.label ?? "");
    const stroke = element("line", {x1: 0, x2: 18, y1: 5, y2: 5, stroke: `var(${line.tone})`, "stroke-width": line.band ? 8 : 2.5,
      ...(line.band ? {opacity: .3} : {}), ...(line.dashed ? {"stroke-dasharray": "5 3"} : {})});
    const button = element("button", {type: "button", "aria-pressed": "true", onclick: () => this.toggle(i)},
      element("svg", {width: 18, height: 10, "aria-hidden": "true"}, stroke), name, value);
    if (line.picked) button.hidden = true;
    if (!line.label) button.setAttribute("aria-label", "the line");
    return {button, name, value, stroke};
  }
  toggle(i) {
    const line = this.lines[i];
    line.hidden = !line.hidden;
    this.keys[i].button.setAttribute("aria-pressed", String(!line.hidden));
    for (const s of this.seriesOf[i]) this.u.setSeries(s, {show: !line.hidden});
  }

  /// uPlot's table: one row of places, and the columns of all lines. Of outputs at one place the last counts where two
  /// runs are joined.
  table() {
    const columns = line => line.band ? [line.values, line.band] : [line.values];
    this.seriesOf = [];
    let next = 1;
    for (const line of this.lines) this.seriesOf.push(columns(line).map(() => next++));
    const {timeline} = this, run = r => timeline.runs[r];
    const places = r => run(r).step.map((_, i) => timeline.at(r, i));
    if (timeline.runs.length === 1) {
      this.rows = [places(0).map((_, i) => i)];
      return [places(0), ...this.lines.flatMap(columns)];
    }
    // Lines stand in the order of their runs, so that the joined columns keep it.
    const kept = timeline.runs.map((_, r) => { const last = new Map(); places(r).forEach((x, i) => last.set(x, i)); return [...last.entries()]; });
    const tables = kept.map((entries, r) => [entries.map(([x]) => x),
      ...this.lines.filter(line => line.run === r).flatMap(columns).map(column => entries.map(([, i]) => column[i]))]);
    const joined = uPlot.join(tables), row = new Map(joined[0].map((x, i) => [x, i]));
    this.rows = timeline.runs.map((_, r) => places(r).map(x => row.get(x)));
    return joined;
  }

  options(style, table) {
    const {fine} = style, xs = table[0], font = `${12 * fine}px system-ui, sans-serif`;
    const range = xs[0] < xs.at(-1) ? [xs[0], xs.at(-1)] : [xs[0], xs[0] + 1];
    const axis = {font, stroke: style.text, grid: {stroke: style.grid, width: fine}, ticks: {stroke: style.line, width: fine, size: 4 * fine}, gap: 4 * fine, values: axisNumbers};
    const series = [{}], bands = [];
    this.lines.forEach((line, i) => {
      const stroke = css(line.tone), common = {stroke, show: !line.hidden, paths: this.steps ? uPlot.paths.stepped({align: 1}) : uPlot.paths.linear()};
      const [first, second] = this.seriesOf[i].map(s => {  // each with dots for the values that no line would show
        const dots = lonely(table[s]);
        return {...common, points: dots.length ? {show: true, filter: () => dots, size: 6 * fine, fill: stroke} : {show: false}};
      });
      const dash = line.dashed ? [5 * fine, 3 * fine] : line.picked || line.run > 0 ? undefined : style.dash(line.band ? 0 : i)?.map(d => d * fine);
      if (!line.band) { series.push({...first, width: (line.picked ? 2.6 : 1.8) * fine, dash}); return; }
      bands.push({series: this.seriesOf[i], fill: stroke + "30"});
      series.push({...first, width: .6 * fine}, {...second, width: .6 * fine});
    });
    return {
      width: this.width * fine, height: this.height * fine, series, bands, pxAlign: true, padding: [8 * fine, 24 * fine, 0, 0],
      legend: {show: false}, focus: {alpha: .25},
      scales: {x: {time: false, range: () => zoomed || range}, y: {range: this.range}},
      axes: [{...axis, size: 22 * fine, space: 64 * fine, label: this.timeline.title, labelFont: font, labelSize: 16 * fine, labelGap: 0, ...this.stageAxis(fine)},
             {...axis, space: 32 * fine, ...(this.whole ? {incrs: wholeSteps} : {}),
              size: (u, values) => 10 * fine + Math.max(24 * fine, ...(values || []).map(v => String(v).length * 6.6 * fine))}],
      cursor: {
        y: false, drag: {setScale: false, x: true, y: false, dist: 5},
        points: {size: 7, width: 0},
        dataIdx: (u, s, hovered) => s === 0 ? hovered : this.rows[this.runOf(s)][this.timeline.output(this.runOf(s))],
        bind: {
          mousemove: (u, target, handler) => e => e.buttons ? handler(e) : this.point(e),
          mouseleave: () => null,
          dblclick: () => () => zoom(null),
        },
      },
      hooks: {
        setSelect: [u => {
          const {left, width} = u.select;
          u.setSelect({left: 0, width: 0, top: 0, height: 0}, false);
          if (width > 5) zoom([u.posToVal(left, "x"), u.posToVal(left + width, "x")]);
        }],
        draw: [u => { this.drawStages(u, style); queueMicrotask(() => this.follow()); }],  // places are known only now
      },
    };
  }
  runOf(series) { return this.lines[this.seriesOf.findIndex(list => list.includes(series))].run ?? 0; }

  stageAxis(fine) {
    if (this.timeline.over !== "stages") return {};
    let ticks = [];
    return {splits: (u, i, low, high) => { ticks = stageTicks(this.timeline, low, high, u.width / fine - 60); return ticks.map(t => t.at); }, values: (u, splits) => splits.map(v => ticks.find(t => t.at === v)?.text ?? "")};
  }

  /// Where a stage begins, a line across; ticks where something happened.
  drawStages(u, style) {
    const {timeline} = this;
    if (timeline.runs.length > 1) return;
    const context = u.ctx, {top, height, left, width} = u.bbox, across = x => { context.beginPath(); context.moveTo(x, top); context.lineTo(x, top + height); context.stroke(); };
    const inside = x => x >= left - 1 && x <= left + width + 1;
    context.save();
    context.strokeStyle = context.fillStyle = style.text;
    for (const stage of timeline.over === "strain" ? [] : timeline.stages.slice(1)) {
      const x = Math.round(u.valToPos(timeline.at(0, stage.from - 1), "x", true)) + .5;
      context.setLineDash([2, 3]);
      if (inside(x)) across(x);
    }
    context.setLineDash([]);
    context.globalAlpha = .35;
    for (const {event, node} of this.marks) {
      const x = u.valToPos(timeline.at(0, event.position), "x", true), shown = inside(x);
      if (shown && event.kind !== "stage") { context.lineWidth = style.fine; across(x); }
      node.hidden = !shown || style.paper;
      node.style.left = `${u.valToPos(timeline.at(0, event.position), "x")}px`;
    }
    context.restore();
  }

  draw() {
    this.u?.destroy();
    this.style = chartStyle();
    this.width = this.style.paper ? 304 : Math.max(200, this.plot.clientWidth);
    const data = this.table();
    this.u = new uPlot(this.options(this.style, data), data, this.plot);
    this.u.over.append(...this.marks.map(m => m.node));
    this.more.hidden = this.whole || !usualRange(this.lines);
    this.more.textContent = this.everything ? "Usual range" : "Show outliers";
    if (this.style.paper) this.u.root.style.zoom = 1 / this.style.fine;
    this.u.over.addEventListener("pointerdown", e => { this.timeline.stop(); this.point(e); });
    this.u.over.addEventListener("pointermove", e => { if (e.pointerType !== "mouse" && e.buttons) this.point(e); });
    this.keys.forEach((key, i) => {
      const line = this.lines[i], dash = line.dashed ? [5, 3] : line.picked || line.run > 0 ? undefined : this.style.dash(i);
      if (dash && !this.lines[i].band) key.stroke.setAttribute("stroke-dasharray", dash.join(" ")); else key.stroke.removeAttribute("stroke-dasharray");
    });
    this.follow();
  }
  resize() {
    const width = Math.max(200, this.plot.clientWidth);
    if (this.style.paper || width === this.width) return;
    this.width = width;
    this.u.setSize({width, height: this.height});
  }
  point(event) {
    if (this.timeline.playing) return;
    this.timeline.seekPlace(this.u.posToVal(event.clientX - this.u.over.getBoundingClientRect().left, "x"));
  }
  /// Shows the line of a cell beside the others, or lifts it out of them.
  pick(cell, valuesOf, number = cell) {
    const own = this.lines.findIndex(line => line.picked), of = this.lines.findIndex(line => line.cell === cell);
    if (own >= 0) {
      const line = this.lines[own];
      line.values = cell === null ? line.values.map(() => null) : valuesOf(cell);
      line.label = cell === null ? "" : `cell ${number}`;
      this.keys[own].name.textContent = line.label; this.keys[own].button.hidden = cell === null;
      this.u.setData(this.table());
    }
    this.lifted = own < 0 && of >= 0 ? this.seriesOf[of][0] : null;
    this.u.setSeries(this.lifted, {focus: true});
    this.follow();
  }
  get folded() { return this.plot.closest("details:not([open])") !== null; }
  follow() {
    if (this.folded && !printing) return;
    const {timeline, u} = this, x = timeline.place(), {min, max} = u.scales.x;
    u.setCursor({left: x < min || x > max ? -10 : u.valToPos(x, "x"), top: 0}, false);
    if (this.shown === timeline.nearest && timeline.playing) return;
    this.shown = timeline.nearest;
    this.instant.textContent = timeline.words;
    this.keys.forEach((key, i) => {
      const line = this.lines[i], output = timeline.output(line.run ?? 0);
      key.value.textContent = line.band ? `${format(line.band[output], 3)} … ${format(line.values[output], 3)}` : format(line.values[output], 3);
    });
  }
}

/// Shows a stretch of the horizontal axis, or with null all of it.
function zoom(range) {
  zoomed = range;
  for (const chart of charts) { chart.u.setData(chart.u.data); chart.follow(); }
  document.dispatchEvent(new Event("zoomed"));
}
function redrawCharts() { for (const chart of charts) chart.draw(); }

/// A chart as SVG text: what it shows now, with axes and names of its own.
function chartSvg(chart) {
  const {u, timeline, lines} = chart, width = 640, height = 320, box = {left: 64, right: width - 130, top: 34, bottom: height - 44};
  const {min: x0, max: x1} = u.scales.x, {min: y0, max: y1} = u.scales.y, at = (x, y) => [box.left + (x - x0) / (x1 - x0) * (box.right - box.left), box.bottom - (y - y0) / (y1 - y0) * (box.bottom - box.top)];
  const text = (x, y, words, more = {}) => element("text", {x, y, "font-family": "sans-serif", "font-size": 12, fill: css("--text"), ...more}, words), line = (a, b, more) => element("path", {d: pathThrough([a, b]), fill: "none", ...more});
  const root = element("svg", {xmlns: "http://www.w3.org/2000/svg", viewBox: `0 0 ${width} ${height}`, width, height}, element("rect", {width, height, fill: css("--card")}), text(box.left, 18, chart.title, {"font-weight": 600}));
  const ticks = timeline.over === "stages" ? stageTicks(timeline, x0, x1, box.right - box.left) : linearAxis([x0, x1], box.left, box.right, {apart: 70}).ticks.filter(t => t.value >= x0 && t.value <= x1).map(({value, text}) => ({at: value, text}));
  for (const tick of ticks) root.append(line(at(tick.at, y0), [at(tick.at, y0)[0], box.top], {stroke: css("--grid")}), text(at(tick.at, y0)[0], box.bottom + 16, tick.text, {"text-anchor": "middle"}));
  for (const tick of linearAxis([y0, y1], box.bottom, box.top, {apart: 44}).ticks.filter(t => t.value >= y0 && t.value <= y1)) root.append(line(at(x0, tick.value), [box.right, at(x0, tick.value)[1]], {stroke: css("--grid")}), text(box.left - 6, at(x0, tick.value)[1] + 4, tick.text, {"text-anchor": "end"}));
  root.append(text(box.right, height - 8, timeline.title, {"text-anchor": "end"}), element("clipPath", {id: "box"}, element("rect", {x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top})));
  lines.forEach((l, i) => {
    if (l.hidden || (l.picked && !l.label)) return;
    const stroke = css(l.tone), run = l.run ?? 0, points = values => values.map((v, k) => v === null || v === undefined ? null : at(timeline.at(run, k), v)), dash = l.dashed ? [5, 3] : l.picked || run > 0 ? null : chart.style.dash(i);
    if (l.band) root.append(element("path", {d: `${pathThrough([...points(l.values), ...points(l.band).reverse()].filter(Boolean))}Z`, fill: stroke, opacity: .2, "clip-path": "url(#box)"}));
    else {
      const parts = points(l.values).reduce((list, p) => { if (p) list.at(-1).push(p); else list.push([]); return list; }, [[]]);
      const stepped = part => chart.steps ? part.flatMap((p, k) => k ? [[p[0], part[k - 1][1]], p] : [p]) : part;
      root.append(element("path", {d: parts.map(part => pathThrough(stepped(part))).join(""), fill: "none", stroke, "stroke-width": 1.8, "clip-path": "url(#box)", ...(dash ? {"stroke-dasharray": dash.join(" ")} : {})}));
    }
    const y = box.top + 8 + 18 * i;
    root.append(line([box.right + 10, y], [box.right + 30, y], {stroke, "stroke-width": l.band ? 8 : 2, ...(l.band ? {opacity: .3} : {}), ...(dash && !l.band ? {"stroke-dasharray": dash.join(" ")} : {})}), text(box.right + 35, y + 4, l.label || ""));
  });
  return new XMLSerializer().serializeToString(root);
}
