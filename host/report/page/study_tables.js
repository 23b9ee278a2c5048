// ------------------------------------------------------------------------------------------------------- tables of a study
const withUnit = (value, unit, digits = 5) => typeof value === "number" ? `${format(value, digits)} ${unit ?? ""}`.trim() : "–";

function showReferences(view) {
  const points = ids => (ids ?? []).map(id => view.byId.get(id)).filter(Boolean).map(p => labelWords(p.labels)).join("; ");
  const rows = view.quantities.map(q => ({name: q.name, unit: q.unit, ...(q.reference ?? {}), disagreement: q.disagreement}));
  const columns = [{title: "Quantity", key: "name"}, {title: "Reference", value: r => spelled(r.kind ?? "none")}, {title: "Value", number: true, value: r => withUnit(r.value, r.unit, 6)},
    {title: "Uncertainty", number: true, value: r => typeof r.value === "number" && r.uncertainty === null ? "not given" : withUnit(r.uncertainty, r.unit, 2)},
    {title: "Observed order", number: true, value: r => format(r.order, 3)}, {title: "From", value: r => r.source ?? ""}, {title: "Points", value: r => points(r.points)}, {title: "Remark", value: r => r.why_not ?? ""}];
  const says = column => rows.some(r => !["", "–"].includes(String(column.value ? column.value(r) : r[column.key] ?? "")));
  section("References", table(columns.filter(says), rows, {stacked: true}));
  const all = view.quantities.flatMap(q => (q.by_method ?? []).map(row => ({...row, quantity: q.name, unit: q.unit}))), methods = all.filter(r => typeof r.limit === "number" || typeof r.order === "number");
  const without = grouped(all.filter(r => !methods.includes(r)), r => `${r.quantity}: ${r.why_not ?? "no limit"}`);
  if (without.size) page.append(note(`Without a limit: ${[...without].map(([why, rows]) => `${why} (${rows.length} ${rows.length === 1 ? "method" : "methods"})`).join("; ")}.`));
  if (methods.length) page.append(element("h3", {}, "Limit of each method"), table([{title: "Method", value: r => labelWords(r.method ?? {}) || "all points"}, {title: "Quantity", key: "quantity"},
    {title: "Observed order", key: "order", number: true, value: r => format(r.order, 3)}, {title: "Limit", number: true, value: r => withUnit(r.limit, r.unit, 6), sort: r => r.limit},
    {title: "Uncertainty", number: true, value: r => withUnit(r.uncertainty, r.unit, 2), sort: r => r.uncertainty}, {title: "Remark", value: r => r.why_not ?? ""}], methods, {sortable: true, stacked: true}));
}

/// The table of points for the quantity that is shown, made anew with every other choice of it.
function showPoints(view) {
  const box = element("div", {class: "points"});
  section("Points", box, note("A title sorts by its column; a row, clicked or chosen with Enter, shows its point in the charts. study.csv has all quantities of all points."));
  let drawn = null;
  view.listeners.push(() => {
    if (drawn !== view.quantity) box.replaceChildren(pointTable(view));
    drawn = view.quantity;
    for (const row of box.querySelectorAll("tbody tr")) {
      const point = view.byId.get(Number(row.dataset.row));
      row.classList.toggle("chosen", point.id === view.point);
      row.classList.toggle("off", !view.shows(view.methodOf.get(point.id)));
    }
  });
}
function pointTable(view) {
  const {quantity} = view, front = new Set(view.study.fronts?.[quantity.name] ?? []), unit = quantity.unit ? `, ${quantity.unit}` : "";
  const time = which => ({number: true, value: r => r[which] ? spreadCell(r[which]) : null, sort: r => view.seconds(r, which)});
  return table([{title: "", value: r => swatch(view.methodOf.get(r.id)), sort: r => view.methods.indexOf(view.methodOf.get(r.id))},
    ...view.axes.map(axis => ({title: axis.name, value: r => r.labels[axis.name] ?? ""})),
    {title: "End", value: r => view.result(r).value === null && r.status === "completed" ? "no value" : statusWords[r.status] ?? r.status, mark: r => r.status === "completed" ? "" : "over"},
    {title: `${quantity.name}${unit}`, number: true, value: r => format(view.result(r).value, 5), sort: r => view.result(r).value},
    {title: `Error${view.unit ? `, ${view.unit}` : ""}`, number: true, value: r => typeof view.result(r).error === "number" ? format(view.result(r).error * view.factor, 3) : "–", sort: r => view.error(r)},
    {title: "Front", value: r => front.has(r.id) ? "yes" : ""},
    {title: "Wall time, s", ...time("wall_s")}, {title: "Processor time, s", ...time("cpu_s")}, {title: "Steps", key: "steps", number: true},
    {title: "Memory, MiB", number: true, value: r => r.peak_rss_bytes ? format(r.peak_rss_bytes / 1048576, 3) : "–", sort: r => r.peak_rss_bytes}, ...(new Set(view.points.map(p => p.threads)).size > 1 ? [{title: "Threads", key: "threads", number: true}] : [])],
    view.points, {sortable: true, attributes: r => ({"data-row": r.id, tabindex: 0, onclick: () => view.choose(r.id), onkeydown: event => { if (event.key === "Enter") view.choose(r.id); }})});
}
const spreadCell = time => typeof time.median !== "number" ? "–" : element("span", {}, format(time.median, 3), time.most > time.least ? element("span", {class: "quiet spread"}, ` ${format(time.least, 3)} … ${format(time.most, 3)}`) : "");

function showFailures(view) {
  const failed = view.points.filter(p => p.status !== "completed");
  const undefinedOnes = view.points.filter(p => p.status === "completed").flatMap(p => Object.entries(p.results ?? {})
    .filter(([, result]) => result.why_not && (result.value === null || result.error === null)).map(([name, result]) => ({labels: p.labels, name, why: result.why_not})));
  if (failed.length) section("Points that failed", table([{title: "Point", value: r => labelWords(r.labels)}, {title: "End", value: r => statusWords[r.status] ?? r.status, mark: () => "over"},
    {title: "Reason", value: r => r.failure?.reason ?? ""}, {title: "Step", number: true, value: r => r.failure?.step ?? null}, {title: "What happened", value: r => r.failure?.message ?? ""},
    {title: "What to change", value: r => r.failure?.remedy ?? ""}], failed, {stacked: true}));
  const reasons = [...grouped(undefinedOnes, r => JSON.stringify([r.name, r.why])).values()];
  if (reasons.length) section("Numbers that are not defined", table([{title: "Quantity", value: r => r[0].name}, {title: "Why", value: r => r[0].why}, {title: "Points", value: r => r.length === view.points.length ? "all" : r.length > 4 ? `${r.length} of ${view.points.length}` : r.map(p => labelWords(p.labels)).join("; ")}], reasons, {stacked: true}));
}

/// The changes of one setting that gain most for the quantity that is shown.
function showKnobs(view) {
  const most = 30, all = view.study.knobs ?? {};
  if (!Object.values(all).some(list => list.length)) return;
  const box = element("div", {});
  section("Which setting helps most", box);
  let drawn = null;
  view.listeners.push(() => {
    if (drawn === view.quantity) return;
    drawn = view.quantity;
    const rows = all[drawn.name] ?? [], factor = (key, sign) => ({number: true, value: r => typeof r[key] === "number" ? `${sign} ${format(r[key], 3)}` : "–", sort: r => r[key]});
    box.replaceChildren(rows.length ? table([{title: "Setting", key: "axis"}, {title: "From", key: "from"}, {title: "To", key: "to"}, {title: "With", value: r => labelWords(r.fixed ?? {})},
      {title: "Error", ...factor("error_factor", "÷")}, {title: "Time", ...factor("time_factor", "×")}, {title: "Gain", number: true, value: r => r.free ? "free" : format(r.gain, 3), sort: r => r.free ? Infinity : r.gain}],
      rows.slice(0, most), {sortable: true, stacked: true}) : note("No two points differ in one setting alone and have both an error."),
      note(`What a change of one setting does to ${theError(drawn.name)} and to the time, all else being equal; most gain first` + (rows.length > most ? `, ${most} of ${rows.length} (study.json has all). ` : ". ") +
        "Gain: by how many powers of ten the error falls when the time grows tenfold; free: the better setting is not the slower one."));
  });
}

function showPasses(view) {
  const timed = view.points.filter(p => p.passes?.length);
  if (!timed.length) return;
  const box = element("div", {}), select = element("select", {"aria-label": "Point", onchange: () => view.choose(Number(select.value))},
    ...timed.map(p => element("option", {value: p.id}, labelWords(p.labels))));
  section("Time by pass", element("div", {class: "controls"}, element("label", {}, "Point", select)), box);
  const first = view.defaultPoint?.passes?.length ? view.defaultPoint : timed[0];
  let drawn = null;
  view.listeners.push(() => {
    const point = view.byId.get(view.point) ?? first;
    if (drawn === point) return;
    drawn = point;
    select.value = point.id;
    box.replaceChildren(element("p", {}, element("b", {}, labelWords(point.labels))),
      point.passes?.length ? passTable(point.passes) : note(`No times: the point ${statusWords[point.status] ?? point.status}.`));
  });
}
