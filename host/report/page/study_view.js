// ------------------------------------------------------------------------------------------ a study, and what of it is shown
const statusWords = {completed: "completed", diverged: "diverged", refused: "refused", timed_out: "timed out", crashed: "crashed"};

class StudyView {
  constructor(study) {
    this.study = study;
    this.points = study.points ?? [];
    this.quantities = study.quantities ?? [];
    this.quantity = this.quantities[0];
    this.time = "wall_s";
    this.axes = (study.axes ?? []).map(axis => ({...axis, positions: axis.positions ?? []}));
    this.line = this.axes.find(axis => axis.name === study.line);
    Object.assign(this, methodsOf(this.axes.filter(axis => axis !== this.line), this.points));
    this.methodOf = new Map(this.methods.flatMap(method => method.members.map(point => [point.id, method])));
    this.byId = new Map(this.points.map(point => [point.id, point]));
    this.off = {methods: new Set(), labels: new Set()};
    this.emphasis = null;  // a method that is pointed at in the legend
    this.point = null;
    this.listeners = [];
  }
  changed() { for (const listener of this.listeners) listener(); }
  choose(id) { this.point = this.byId.has(id) ? id : null; this.changed(); }
  shows(method) { return !this.off.methods.has(method.id) && labelsShown(method.labels, this.off.labels); }

  result(point) { return point.results?.[this.quantity?.name] ?? {value: null, error: null, uncertainty: null, why_not: "not measured"}; }
  error(point) { const {error} = this.result(point); return typeof error === "number" ? Math.abs(error) : null; }
  seconds(point, which = this.time) { return point[which]?.median ?? null; }
  get relative() { return this.quantity.error === "relative"; }
  get factor() { return this.relative ? 100 : 1; }
  get unit() { return this.relative ? "%" : this.quantity.unit ?? ""; }
  errorText(error, digits = 3) { return typeof error === "number" ? `${format(error * this.factor, digits)} ${this.unit}`.trim() : "–"; }
  get timeTitle() { return this.time === "wall_s" ? "run time (wall)" : "processor time"; }
  spread(point, which) {
    const time = point[which];
    if (!time) return "–";
    const count = time.all?.length ?? 0;
    return time.most > time.least ? `${seconds(time.median)} (${format(time.least, 3)} … ${seconds(time.most)}${count ? `, ${count} runs` : ""})` : seconds(time.median);
  }
  /// Half the width of what the reference leaves open, as an error; null where it has none.
  get openness() {
    const {value, uncertainty} = this.quantity.reference ?? {};
    if (typeof uncertainty !== "number" || !(uncertainty > 0)) return null;
    return this.relative ? (value ? uncertainty / Math.abs(value) : null) : uncertainty;
  }

  /// Numbers of the points than which none is faster and better. Those of the wall time are the study's own.
  get front() {
    const told = this.study.fronts?.[this.quantity.name];
    if (this.time === "wall_s" && told) return told.filter(id => this.byId.has(id));
    const chosen = [];
    let best = Infinity;
    const usable = this.points.filter(point => this.error(point) !== null && this.seconds(point) !== null);
    for (const point of usable.sort((a, b) => this.seconds(a) - this.seconds(b) || this.error(a) - this.error(b)))
      if (this.error(point) < best) { best = this.error(point); chosen.push(point.id); }
    return chosen;
  }
  get sentences() { return (this.study.sentences ?? []).filter(sentence => sentence.quantity === this.quantity.name); }
  get targets() {
    return [...new Set(this.sentences.map(s => s.target).filter(level => typeof level === "number" && level > 0))];
  }
  get defaultPoint() {
    const wanted = Object.entries(this.study.default ?? {}), found = this.points.filter(p => wanted.every(([axis, label]) => p.labels[axis] === label));
    return wanted.length && found.length === 1 ? found[0] : null;
  }
  /// Whether a point's error is below the target even at the end of its uncertainty.
  meets(id, target) { const point = this.byId.get(id); return point !== undefined && this.error(point) !== null && this.error(point) + (this.result(point).uncertainty ?? 0) <= target; }
  /// Points with a name in the charts.
  get rings() {
    const named = new Map(), add = (id, text) => { if (this.byId.has(id)) named.set(id, [...new Set([...(named.get(id) ?? []), text])]); };
    if (this.defaultPoint) add(this.defaultPoint.id, "default");
    for (const s of this.sentences) if (typeof s.point === "number" && typeof s.target === "number") add(s.point, `${this.meets(s.point, s.target) ? "cheapest below" : "nearest to"} ${this.errorText(s.target)}`);
    const rings = Object.fromEntries([...named].map(([id, texts]) => [id, texts.join(", ")]));
    if (this.point !== null) rings[this.point] ??= "";
    return rings;
  }

  /// Why a point has no error to be drawn.
  why(point) {
    const {failure} = point, result = this.result(point);
    if (point.status !== "completed") return [statusWords[point.status] ?? point.status, failure?.reason && failure.reason !== point.status ? failure.reason : null,
      typeof failure?.step === "number" ? `at step ${format(failure.step)}` : null].filter(Boolean).join(", ");
    return result.value === null || result.value === undefined ? "no value" : "no error";
  }
  describe(id) {
    const point = this.byId.get(id), result = this.result(point), {failure} = point, method = this.methodOf.get(id);
    const rows = [], row = (name, text) => { if (text && text !== "–") rows.push(element("dt", {}, name), element("dd", {}, text)); };
    const failed = point.status !== "completed";
    const words = failed || this.error(point) === null ? [element("p", {class: "bad"}, element("b", {}, spelled(this.why(point)))),
      ...[failure?.message, failure?.remedy, failed ? null : result.why_not].filter(Boolean).map(text => element("p", {}, text))] : [];
    row(this.quantity.name, typeof result.value === "number" ? `${format(result.value, 5)} ${this.quantity.unit ?? ""}`.trim() : null);
    row("error", this.error(point) === null ? null : this.errorText(result.error) + (result.uncertainty ? ` ± ${this.errorText(result.uncertainty, 2)}` : ""));
    row("wall time", this.spread(point, "wall_s"));
    row("processor time", this.spread(point, "cpu_s"));
    row("steps", format(point.steps));
    row("memory", mebibytes(point.peak_rss_bytes));
    row("threads", format(point.threads));
    return [element("p", {class: "name"}, swatch(method), element("b", {}, labelWords(point.labels))), ...words, element("dl", {}, ...rows),
      ...(this.front.includes(id) ? [note("On the front: no other setting is both faster and more accurate.")] : [])];
  }
}
