// --------------------------------------------------------------------------------- the map: where each combination is stable
// What fails is warm, what is stable cool. Each reason to fail has a hatching of its own, so that they differ on any paper and
// for any eye.
const failureReasons = {
  node_step: ["--f0", "M0 3H8"], mach: ["--f1", "M3 0V8"], energy_growth: ["--f2", "M1 2h2M5 6h2"], area_drift: ["--f3", "M-2 10L10 -2M-2 2L2 -2M6 10L10 6"],
  crossing: ["--f4", "M0 0L8 8M0 8L8 0"], uneven_nodes: ["--f5", "M-2 -2L10 10M6 -2L10 2M-2 6L2 10"], "": ["--f6", "M3 3h1.6M7 7h1.6"],
};
/// Of a failure, one that has a hatching.
const reasonOf = failure => { const reason = failure?.reason === "area_loss" ? "area_drift" : failure?.reason ?? ""; return Object.hasOwn(failureReasons, reason) ? reason : ""; };
const reasonWords = reason => ({mach: "Mach number", "": "another reason"})[reason] ?? reason.replaceAll("_", " ");
const patternId = reason => `reason-${reason || "other"}`;
const patterns = () => element("svg", {width: 0, height: 0, class: "patterns", "aria-hidden": "true"}, element("defs", {}, ...Object.entries(failureReasons).map(([reason, [tone, d]]) =>
  element("pattern", {id: patternId(reason), width: 8, height: 8, patternUnits: "userSpaceOnUse"},
    element("rect", {width: 8, height: 8, fill: `var(${tone})`, opacity: .22}), element("path", {d, stroke: `var(${tone})`, "stroke-width": 1.7, fill: "none"})))));
const swatch = reason => element("svg", {width: 22, height: 14, "aria-hidden": "true"}, element("rect", {width: 22, height: 14, rx: 2, fill: `url(#${patternId(reason)})`, stroke: `var(${failureReasons[reason][0]})`}));

const failed = trial => Boolean(trial.reason) || (trial.end ?? "completed") !== "completed";  // a run that completed may have failed silently

/// The edges of a result by combination: {labels, name, above, below, trials, contradicting}.
function mapRows(result) {
  const {methods} = methodsOf(result.axes ?? [], result.edges ?? []);
  return methods.map(method => {
    const of = direction => method.members.find(edge => (edge.direction ?? "above") === direction) ?? null;
    return {...method, above: of("above"), below: of("below"), contradicting: new Set(method.members.flatMap(edge => edge.out_of_order ?? [])),
      trials: method.members.flatMap(edge => edge.trials ?? [])};
  });
}
const unknownEdge = edge => edge && edge.stable_up_to === null && edge.unstable_from === null;
/// Stretches of the axis, {from, to, what: stable | failing | open, failure}; an edge without a stable side failed
/// everywhere, one without an unstable side nowhere, and of one without either nothing is known yet.
function stretches(row, low, high) {
  const {above, below} = row, parts = [], nowhere = [above, below].find(edge => edge && edge.stable_up_to === null);
  if (unknownEdge(nowhere)) return [{from: low, to: high, what: "open"}];
  if (nowhere) return [{from: low, to: high, what: "failing", failure: nowhere.failure}];
  const first = below?.unstable_from == null ? low : below.stable_up_to, last = above?.unstable_from == null ? high : above.stable_up_to;
  if (below?.unstable_from != null) parts.push({from: low, to: below.unstable_from, what: "failing", failure: below.failure}, {from: below.unstable_from, to: first, what: "open"});
  parts.push({from: first, to: last, what: "stable"});
  if (above?.unstable_from != null) parts.push({from: last, to: above.unstable_from, what: "open"}, {from: above.unstable_from, to: high, what: "failing", failure: above.failure});
  return parts;
}
function edgeText(row, unit) {
  const {above, below} = row, value = v => `${format(v, 3)} ${unit}`.trim();
  if ([above, below].some(unknownEdge)) return "not known yet";
  if ([above, below].some(edge => edge && edge.stable_up_to === null)) return "stable nowhere";
  const low = below?.unstable_from != null ? below.stable_up_to : null, high = above?.unstable_from != null ? above.stable_up_to : null;
  if (low !== null && high !== null) return `stable from ${format(low, 3)} to ${value(high)}`;
  return low !== null ? `stable from ${value(low)}` : high !== null ? `stable up to ${value(high)}` : "stable throughout";
}

class LimitsMap {
  constructor(parent, result) {
    this.parameter = result.parameter ?? {};
    this.unit = this.parameter.unit ?? "";
    this.rows = mapRows(result);
    const tried = this.rows.flatMap(row => row.trials.map(trial => trial.value)).filter(v => typeof v === "number");
    this.low = Math.min(...tried, this.parameter.from ?? Infinity); this.high = Math.max(...tried, this.parameter.to ?? -Infinity);
    this.log = this.parameter.scale !== "linear" && this.low > 0;
    this.box = element("div", {class: "map", role: "group", "aria-label": `Stable range of ${this.parameter.name ?? "the parameter"} for each combination`});
    this.tip = element("div", {class: "tip", role: "status", hidden: ""});
    this.box.append(this.tip, ...this.rows.map(row => this.line(row)), this.axisLine = this.bare());
    parent.append(patterns(), element("div", {class: "card map-card"}, element("h3", {}, `${spelled(this.parameter.name ?? "parameter")}${this.unit ? `, ${this.unit}` : ""}`), this.box));
    this.box.addEventListener("pointerleave", () => this.show(null));
    new ResizeObserver(() => { if (!printing && this.axisLine.plot.clientWidth !== this.width) this.draw(); }).observe(this.box);
    redraws.push(() => this.draw());
    this.draw();
  }

  bare(name = "", text = "") {
    const line = element("div", {class: "map-row"}, element("b", {}, name), element("div", {class: "map-bar"}), element("span", {class: "map-text"}, text));
    line.plot = line.children[1];
    return line;
  }
  line(row) {
    const line = this.bare(row.name), failures = [row.below, row.above].filter(edge => edge?.failure).map(edge => edge.failure);
    line.lastChild.append(edgeText(row, this.unit), ...failures.map(failure => element("span", {class: "quiet"}, swatch(reasonOf(failure)), reasonWords(failure.reason ?? ""))));
    this.listen(line, row.trials, trial => this.describeTrial(row, trial));
    return row.line = line;
  }
  /// Pointing at a bar, or arrow keys on it, tell of the nearest of `things`.
  listen(line, things, describe) {
    const {plot} = line, sorted = [...things].sort((a, b) => a.value - b.value);
    let at = -1;
    const tell = i => { at = i; this.show(line, sorted[i] && describe(sorted[i]), sorted[i]?.value); };
    const near = event => {
      const x = (event.clientX - plot.getBoundingClientRect().left) * this.width / plot.clientWidth, far = sorted.map(thing => Math.abs(this.axis.at(thing.value) - x));
      tell(far.indexOf(Math.min(...far)));
    };
    plot.tabIndex = 0;
    plot.setAttribute("role", "group");
    plot.setAttribute("aria-label", `${line.firstChild.textContent}: ${sorted.length} values; arrow keys go through them`);
    plot.addEventListener("pointermove", near);
    plot.addEventListener("pointerdown", near);
    plot.addEventListener("blur", () => this.show(null));
    plot.addEventListener("keydown", event => {
      const step = {ArrowRight: 1, ArrowLeft: -1}[event.key];
      if (!step || !sorted.length) return;
      tell((at + step + sorted.length) % sorted.length);
      event.preventDefault();
    });
  }
  describeTrial(row, trial) {
    const {failure} = [row.above, row.below].find(edge => edge?.unstable_from === trial.value) ?? {}, fails = failed(trial);
    const rows = [["reason", trial.reason], ["onset", typeof trial.step === "number" ? `step ${format(trial.step)}` : null]].filter(([, text]) => text);
    return [element("p", {class: "name"}, element("b", {}, `${format(trial.value, 4)} ${this.unit}`), row.name === "all points" ? "" : `, ${row.name}`),
      element("p", fails ? {class: "bad"} : {}, spelled(fails ? trial.end === "completed" ? "silent failure" : trial.end ?? "failed" : "stable")),
      element("dl", {}, ...rows.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)])),
      ...(failure?.message ? [element("p", {}, failure.message)] : []), ...(failure?.remedy ? [note(failure.remedy)] : []),
      ...(row.contradicting.has(trial.value) ? [element("p", {class: "bad"}, "Contradicts the edge that was found: there is more than one.")] : [])];
  }

  draw() {
    const width = this.width = printing ? 330 : Math.max(160, this.axisLine.plot.clientWidth), values = [this.low, this.high];
    this.tip.hidden = true;
    this.axis = (this.log ? logAxis : linearAxis)(values, 0, width, {room: .03, apart: 84});
    for (const row of this.rows) this.drawBar(row);
    const ticks = this.axis.ticks.flatMap(({value, text}) => {
      const x = this.axis.at(value), anchor = x < 14 ? "start" : x > width - 14 ? "end" : "middle";
      return [element("text", {x, y: 16, "text-anchor": anchor}, text)];
    });
    this.drawInto(this.axisLine.plot, 22, ticks);
  }
  drawInto(plot, height, drawn) {
    const grid = this.axis.ticks.map(({value}) => element("path", {d: `M${this.axis.at(value)} 0V${height === 22 ? 4 : height}`, class: "grid"}));
    plot.replaceChildren(element("svg", {viewBox: `0 0 ${this.width} ${height}`, "aria-hidden": "true"}, ...grid, ...drawn));
  }
  drawBar(row) {
    const at = v => this.axis.at(v), drawn = stretches(row, this.low, this.high).filter(part => part.to > part.from).map(part => {
      const reason = reasonOf(part.failure), look = part.what === "failing" ? {fill: `url(#${patternId(reason)})`, stroke: `var(${failureReasons[reason][0]})`} : {};
      return element("rect", {x: at(part.from), y: 5, width: at(part.to) - at(part.from), height: 22, class: part.what, ...look});
    });
    for (const trial of row.trials) {
      const x = at(trial.value);
      drawn.push(failed(trial) ? element("path", {d: `M${x - 4} 12L${x + 4} 20M${x - 4} 20L${x + 4} 12`, class: "trial"}) : element("path", {d: `M${x} 10V22`, class: "trial"}));
    }
    this.drawInto(row.line.plot, 32, drawn);
  }

  show(line, words, value) {
    this.tip.hidden = !words;
    if (!words) return;
    this.tip.replaceChildren(...words);
    const [frame, bar] = [this.box.getBoundingClientRect(), line.plot.getBoundingClientRect()];
    placeTip(this.tip, this.box, bar.left - frame.left + this.axis.at(value) * bar.width / this.width, bar.top - frame.top + 6);
  }
}

function mapLegend(rows) {
  const key = (mark, text) => element("span", {class: "key"}, mark, text), box = (name, look = {}) => element("svg", {width: 22, height: 14, "aria-hidden": "true"}, element("rect", {x: 1, y: 1, width: 20, height: 12, class: name, ...look}));
  const tick = d => element("svg", {width: 14, height: 14, "aria-hidden": "true"}, element("path", {d, class: "trial"}));
  const failures = rows.flatMap(row => [row.above, row.below]).filter(edge => edge?.failure).map(edge => edge.failure), looks = grouped(failures, reasonOf);
  return element("div", {class: "legend map"}, key(box("stable"), "stable"), key(box("open"), "not known: between stable and unstable"), ...[...looks].map(([look, alike]) => key(swatch(look), `fails: ${[...new Set(alike.map(failure => reasonWords(failure.reason ?? "")))].join(", ")}`)),
    key(tick("M7 1V13"), "tried, stable"), key(tick("M3 3L11 11M3 11L11 3"), "tried, failed"));
}
