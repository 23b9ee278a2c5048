// ------------------------------------------------------------------------------------------------------- charts of a study
/// Lines and failed points of a chart over `place` (of a point, a positive number or null), with `range` [low, high] of it.
function studyLines(view, place, range) {
  const lines = [], failed = [];
  for (const method of view.methods.filter(m => view.shows(m))) {
    const along = [...method.members].sort((a, b) => view.line ? view.line.labels.indexOf(a.labels[view.line.name]) - view.line.labels.indexOf(b.labels[view.line.name]) : 0);
    const points = along.map(point => {
      const error = view.error(point), x = place(point), [low, high] = range?.(point) ?? [x, x];
      if (error !== null && x !== null) return {id: point.id, x, y: error * view.factor, low, high};
      failed.push({id: point.id, x, tone: point.status === "completed" ? "--text" : "--bad", unknown: point.status === "completed"});
      return null;
    });
    lines.push({...method, faded: view.emphasis !== null && view.emphasis !== method.id, points});
  }
  return {lines, failed, drawn: lines.flatMap(line => line.points.filter(Boolean))};
}

/// What both charts have along y: the errors drawn, where the reference ends, and what is aimed at.
function errorAxis(view, drawn) {
  const positive = drawn.map(p => p.y).filter(y => y > 0), open = view.openness && view.openness * view.factor;
  const least = Math.min(...positive), most = Math.max(...positive);
  const near = [open, ...view.targets.map(t => t * view.factor)].filter(v => v > least / 12 && v < most * 12);
  const exact = drawn.some(p => p.y === 0) ? " A hollow mark on the lower border is an error of exactly 0." : "";
  return {
    y: {values: positive.concat(near)}, band: open ? {y: open, text: "within the reference's uncertainty"} : null,
    levels: view.targets.map(target => ({y: target * view.factor, text: view.errorText(target)})),
    note: (open && !near.includes(open) && open < least ? `The reference's uncertainty, ${view.errorText(view.openness)}, lies below what is drawn.` : "") + exact,
  };
}
const theError = name => name.endsWith("error") ? `the ${name}` : `the error of ${name}`;
const errorTitle = view => `${spelled(theError(view.quantity.name).slice(4))}${view.unit ? `, ${view.unit}` : ""}`;

function timeContent(view) {
  const place = point => { const t = view.seconds(point); return t > 0 ? t : null; };
  const content = studyLines(view, place, point => { const t = point[view.time]; return t ? [t.least > 0 ? t.least : t.median, t.most] : null; });
  if (!content.drawn.some(p => p.y > 0)) return null;
  const front = view.front.map(id => view.byId.get(id)).map(p => ({x: place(p), y: view.error(p) * view.factor})).filter(p => p.x !== null);
  return {...content, ...errorAxis(view, content.drawn), title: `${errorTitle(view)}, against ${view.timeTitle}`, front,
    x: {title: `${view.timeTitle}, s`, values: content.drawn.flatMap(p => [p.low, p.high]).concat(front.map(p => p.x))},
    rings: view.rings};
}

function lineContent(view) {
  const {line} = view;
  if (!line) return null;
  const named = line.labels.some((_, i) => !(line.positions[i] > 0)), at = point => line.labels.indexOf(point.labels[line.name]);
  const content = studyLines(view, point => named ? at(point) : line.positions[at(point)]);
  if (!content.drawn.some(p => p.y > 0)) return null;
  const axis = errorAxis(view, content.drawn);
  const x = named ? {title: line.name, names: line.labels}
    : {title: line.name, values: line.positions, ticks: line.labels.map((text, i) => ({value: line.positions[i], text})).sort((a, b) => a.value - b.value)};
  return {...content, ...axis, x, slopes: named ? [] : slopesOf(content), title: `${errorTitle(view)}, against ${line.name}`, rings: view.rings};
}

/// Lines of first and second order from the middle of the errors at the coarse end: where the lines of most methods are higher.
/// Errors of different methods say nothing of that.
function slopesOf({lines, drawn}) {
  const positive = drawn.filter(p => p.y > 0), xs = [...new Set(positive.map(p => p.x))].sort((a, b) => a - b);
  const ends = lines.map(line => line.points.filter(p => p?.y > 0).sort((a, b) => a.x - b.x)).filter(points => points.length > 1 && points[0].x < points.at(-1).x);
  const sign = Math.sign(ends.reduce((sum, points) => sum + Math.sign(points.at(-1).y - points[0].y), 0));
  if (xs.length < 2 || !sign) return [];
  const middle = x => median(positive.filter(p => p.x === x).map(p => p.y)), [coarse, fine] = sign > 0 ? [xs.at(-1), xs[0]] : [xs[0], xs.at(-1)];
  return [1, 2].map(order => ({from: {x: coarse, y: middle(coarse)}, to: {x: fine, y: middle(coarse) * (fine / coarse) ** (sign * order)}, text: `order ${order}`}));
}
function median(values) { const sorted = [...values].sort((a, b) => a - b); return sorted[sorted.length >> 1]; }

/// One legend for both charts: a click hides a method, pointing at its name lifts its line out of the others.
function studyLegend(view, redraw) {
  const methodOf = labels => view.methods.find(m => Object.entries(m.labels).every(([axis, label]) => labels?.[axis] === label))?.id;
  const orders = () => new Map((view.quantity.by_method ?? []).map(row => [methodOf(row.method), row.order]));
  const entries = view.methods.map(method => {
    const order = element("span", {class: "quiet"}), lift = id => event => { if (event.pointerType === "mouse") { view.emphasis = id; redraw(); } };
    const button = element("button", {type: "button", "aria-pressed": "true", onpointerenter: lift(method.id), onpointerleave: lift(null), onclick: () => {
      if (!view.off.methods.delete(method.id)) view.off.methods.add(method.id);
      view.changed();
    }}, swatch(method), method.name, order);
    return {method, button, order};
  });
  view.listeners.push(() => {
    const told = orders();
    for (const {method, button, order} of entries) {
      const value = told.get(method.id);
      order.textContent = typeof value === "number" ? `order ${format(value, 2)}` : "";
      button.setAttribute("aria-pressed", String(view.shows(method)));
    }
  });
  const front = element("span", {class: "key"}, element("svg", {width: 26, height: 12, "aria-hidden": "true"}, element("path", {d: "M1 2H13V10H25", class: "front"})), "front: the best for its time");
  return element("div", {class: "legend many", role: "group", "aria-label": "Methods"}, ...entries.map(entry => entry.button), front);
}

function studyControls(view) {
  const select = (label, choices, now, change) => {
    const box = element("select", {"aria-label": label, onchange: () => { change(box.value); view.changed(); }}, ...choices.map(([v, text]) => element("option", {value: v}, text)));
    view.listeners.push(() => { box.value = now(); });
    return element("label", {}, label, box);
  };
  const controls = element("div", {class: "controls"});
  if (view.quantities.length > 1) controls.append(select("Quantity", view.quantities.map((q, i) => [String(i), q.name]), () => String(view.quantities.indexOf(view.quantity)), i => { view.quantity = view.quantities[i]; }));
  if (view.points.some(p => p.cpu_s)) controls.append(select("Time", [["wall_s", "wall"], ["cpu_s", "processor"]], () => view.time, which => { view.time = which; }));
  if (view.varied.length > 1) controls.append(...axisButtons(view.varied, view.off.labels, () => view.changed()));
  return controls;
}

function showStudyCharts(view) {
  const controls = studyControls(view), pair = element("div", {class: "halves"}), nothing = note(""), tell = id => view.describe(id);
  const charts = [];
  section("Error against run time", controls, nothing);
  const redraw = () => { for (const chart of charts) chart.draw(); };
  const legend = element("div", {class: "card keys"}, studyLegend(view, redraw)), hints = element("div", {});
  page.append(legend, pair, hints);
  const own = {describe: tell, chosen: id => view.choose(id)};
  charts.push(new ScatterChart(pair, {...own, title: "Error against time", content: () => timeContent(view)}),
    new ScatterChart(pair, {...own, title: "Error along the line's axis", content: () => lineContent(view)}));
  hints.append(note("Times are medians of the timed runs; whiskers go from the shortest to the longest. × marks a point that failed and ? one without a value, at its time. " +
    "Point at a mark to read its settings, click it for its time by pass below; click a name to hide its line."));
  view.listeners.push(() => {
    redraw();
    pair.hidden = charts.every(chart => chart.plot.hidden);
    for (const chart of charts) chart.plot.parentNode.hidden = chart.plot.hidden;
    legend.hidden = hints.hidden = pair.hidden;
    nothing.hidden = !pair.hidden;
    nothing.textContent = view.quantity.reference?.why_not ? `No errors to draw: ${view.quantity.reference.why_not}` : "No errors to draw; the table below says why for each point.";
  });
}
