// ------------------------------------------------------------------------------------------------ charts, with uPlot
// Every chart follows the timeline: its cursor stands at the instant that is shown, and pointing at a chart goes there.
// A drag across a chart shows that stretch in all of them, a double click everything again.
const charts = [];
let zoomed = null;

/// How charts look: on paper twice as fine, and told apart by dashes where there is no colour.
function chartStyle() {
  const paper = printing;
  return {
    paper, fine: paper ? 2 : 1, text: css("--quiet"), grid: css("--grid"), line: css("--line"),
    dash: i => paper && i % 4 > 0 ? [[8, 4], [2, 3], [10, 3, 2, 3]][i % 4 - 1] : undefined,
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

function verticalRange({whole, zero}) {
  return (u, low, high) => {
    if (low === null || high === null) return [0, 1];
    if (zero) { low = Math.min(low, 0); high = Math.max(high, 0); }
    const pad = whole ? 0.5 : (high - low) * 0.06 || Math.abs(high) * 0.05 || 1;
    return [zero && low === 0 ? 0 : low - pad, high + pad];
  };
}

/// A line is {label, values (of its run's outputs), run, tone, dashed, band (values of a lower edge; `values` is the
/// upper one and the space between is tinted)}.
class Chart {
  constructor(parent, timeline, {title, about = "", unit = "", lines, height = 180, wide = false, steps = false, whole = false, zero = false}) {
    Object.assign(this, {timeline, lines, height, wide, steps, range: verticalRange({whole, zero}), whole});
    this.plot = element("div", {class: "plot"});
    this.instant = element("span", {class: "instant"});
    this.keys = lines.map((line, i) => this.key(line, i));
    parent.append(element("div", {class: "card chart", role: "group", "aria-label": title},
      element("h3", {title: about}, title + (unit ? `, ${unit}` : "")),
      element("div", {class: "legend"}, this.instant, ...this.keys.map(key => key.button)), this.plot));
    new ResizeObserver(() => this.resize()).observe(this.plot);
    timeline.listeners.push(() => this.follow());
    charts.push(this);
    this.draw();
  }

  key(line, i) {
    const value = element("span", {});
    const stroke = element("line", {x1: 0, x2: 18, y1: 5, y2: 5, stroke: `var(${line.tone})`, "stroke-width": line.band ? 8 : 2.5,
      ...(line.band ? {opacity: .3} : {}), ...(line.dashed ? {"stroke-dasharray": "5 3"} : {})});
    const button = element("button", {type: "button", "aria-pressed": "true", onclick: () => this.toggle(i)},
      element("svg", {width: 18, height: 10, "aria-hidden": "true"}, stroke), line.label ?? "", value);
    if (!line.label) button.setAttribute("aria-label", "the line");
    return {button, value, stroke};
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
    const whole = xs[0] < xs.at(-1) ? [xs[0], xs.at(-1)] : [xs[0], xs[0] + 1];
    const axis = {font, stroke: style.text, grid: {stroke: style.grid, width: fine}, ticks: {stroke: style.line, width: fine, size: 4 * fine}, gap: 4 * fine, values: axisNumbers};
    const series = [{}], bands = [];
    this.lines.forEach((line, i) => {
      const stroke = css(line.tone), common = {stroke, show: !line.hidden, paths: this.steps ? uPlot.paths.stepped({align: 1}) : uPlot.paths.linear()};
      const [first, second] = this.seriesOf[i].map(s => {  // each with dots for the values that no line would show
        const dots = lonely(table[s]);
        return {...common, points: dots.length ? {show: true, filter: () => dots, size: 6 * fine, fill: stroke} : {show: false}};
      });
      const dash = line.dashed ? [5 * fine, 3 * fine] : style.dash(i)?.map(d => d * fine);
      if (!line.band) { series.push({...first, width: 1.8 * fine, dash}); return; }
      bands.push({series: this.seriesOf[i], fill: stroke + "30"});
      series.push({...first, width: .6 * fine}, {...second, width: .6 * fine});
    });
    return {
      width: this.width * fine, height: this.height * fine, series, bands, pxAlign: true, padding: [8 * fine, 10 * fine, 0, 0],
      legend: {show: false},
      scales: {x: {time: false, range: () => zoomed || whole}, y: {range: this.range}},
      axes: [{...axis, size: 22 * fine, space: 64 * fine, label: this.timeline.title, labelFont: font, labelSize: 16 * fine, labelGap: 0,
              ...(this.timeline.over === "output" ? {incrs: wholeSteps} : {})},
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

  /// Where a stage begins, a line across; over the strain they lie where it rests.
  drawStages(u, style) {
    const {timeline} = this;
    if (timeline.runs.length > 1 || timeline.over === "strain") return;
    const run = timeline.runs[0], context = u.ctx, {top, height} = u.bbox;
    context.save();
    context.strokeStyle = context.fillStyle = style.text;
    context.setLineDash([2, 3]);
    run.stage.forEach((name, i) => {
      if (i === 0 || name === run.stage[i - 1]) return;
      const x = Math.round(u.valToPos(timeline.at(0, i - 1), "x", true)) + .5;
      if (x < u.bbox.left || x > u.bbox.left + u.bbox.width) return;
      context.beginPath(); context.moveTo(x, top); context.lineTo(x, top + height); context.stroke();
    });
    context.restore();
  }

  draw() {
    this.u?.destroy();
    this.style = chartStyle();
    this.width = this.style.paper ? (this.wide ? 650 : 304) : Math.max(200, this.plot.clientWidth);
    const data = this.table();
    this.u = new uPlot(this.options(this.style, data), data, this.plot);
    if (this.style.paper) this.u.root.style.zoom = 1 / this.style.fine;
    this.u.over.addEventListener("pointerdown", e => { this.timeline.stop(); this.point(e); });
    this.u.over.addEventListener("pointermove", e => { if (e.pointerType !== "mouse" && e.buttons) this.point(e); });
    this.keys.forEach((key, i) => {
      const dash = this.lines[i].dashed ? [5, 3] : this.style.dash(i);
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
  follow() {
    const {timeline, u} = this, x = timeline.place(), {min, max} = u.scales.x;
    u.setCursor({left: x < min || x > max ? -10 : u.valToPos(x, "x"), top: 0}, false);
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
