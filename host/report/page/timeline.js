// ------------------------------------------------------------------------- one instant for all animations and charts
// A run is what report_data.hpp describes. Of two runs the instants are those of both, in the order of the strain and,
// where it rests, of the time since it came to rest, or in the order of the time, as the charts are over the one or the
// other; each run shows its output that is nearest.
const grows = run => run.strain.some(s => s !== null && s !== run.strain[0]);

function instantsOf(run) {
  let begin = 0;
  return run.strain.map((strain, i) => {
    if (i > 0 && Math.abs((strain ?? 0) - (run.strain[i - 1] ?? 0)) > 1e-9) begin = i;
    return {strain: strain ?? 0, rest: run.time_s[i] - run.time_s[begin], time: run.time_s[i]};
  });
}
function median(values) { return [...values].sort((a, b) => a - b)[values.length >> 1]; }

/// Instants closer than a quarter of the usual distance count as one: two runs' steps are not the same.
function closeness(lists, key) {
  const usual = lists.map(list => median(list.slice(1).map((k, i) => k[key] - list[i][key]).filter(d => d > 1e-12))).filter(d => d > 0);
  return usual.length ? Math.min(...usual) / 4 : 0;
}
function nearest(list, wanted, over) {
  let best = 0;
  list.forEach((k, i) => {
    if (over === "time_s") { if (Math.abs(k.time - wanted.time) < Math.abs(list[best].time - wanted.time)) best = i; return; }
    const far = Math.abs(k.strain - wanted.strain) - Math.abs(list[best].strain - wanted.strain);
    if (far < -1e-9 || (far <= 1e-9 && Math.abs(k.rest - wanted.rest) < Math.abs(list[best].rest - wanted.rest))) best = i;
  });
  return best;
}
function mergedInstants(runs, over) {
  const lists = runs.map(instantsOf);
  if (runs.length === 1) return lists[0].map((k, i) => ({...k, outputs: [i]}));
  const strain = closeness(lists, "strain"), rest = closeness(lists, "rest"), time = closeness(lists, "time"), merged = [];
  const apart = over === "time_s" ? (k, last) => k.time - last.time > time
    : (k, last) => k.strain - last.strain > strain || (k.strain - last.strain <= 1e-9 && k.rest - last.rest > rest);
  for (const k of lists.flat().sort(over === "time_s" ? (a, b) => a.time - b.time : (a, b) => a.strain - b.strain || a.rest - b.rest))
    if (!merged.length || apart(k, merged.at(-1))) merged.push(k);
  return merged.map(k => ({...k, outputs: lists.map(list => list.length ? nearest(list, k, over) : 0)}));
}

/// The stages of a run by its outputs, {name, from, to, over}: each counts in strain where that grows in it, else in time.
function stagesOf(run) {
  const stages = [];
  run.stage.forEach((name, i) => { if (name === stages.at(-1)?.name) stages.at(-1).to = i; else stages.push({name, from: i, to: i}); });
  return stages.map(stage => {
    const before = run.strain[Math.max(0, stage.from - 1)] ?? 0, grown = Math.abs((run.strain[stage.to] ?? 0) - before) > 1e-9;
    return {...stage, over: grown ? "strain" : "time_s"};
  });
}

class Timeline {
  constructor(runs) {
    this.runs = runs;
    this.listeners = [];
    this.sheared = runs.some(grows);
    this.stages = stagesOf(runs[0]);
    this.over = runs.length === 1 && new Set(this.stages.map(s => s.over)).size > 1 ? "stages" : this.sheared ? "strain" : "time_s";
    this.instants = mergedInstants(runs, this.over);
    this.position = 0;  // between two instants while it plays
    this.frame = 0;
  }
  /// The horizontal axis of all charts from now on: "strain", "time_s" or "stages" (the outputs one after another, each
  /// stage in its own measure). The instant that is shown stays.
  setOver(over) {
    this.stop();
    const shown = this.instant;
    this.over = over;
    if (this.runs.length === 1) return;
    this.instants = mergedInstants(this.runs, over);
    this.position = nearest(this.instants, shown, over);
  }
  get count() { return this.instants.length; }
  get nearest() { return Math.round(this.position); }
  get instant() { return this.instants[this.nearest]; }
  get title() { return {strain: "strain", time_s: "time, s", stages: this.stages.map(s => `${s.name}: ${s.over === "strain" ? "strain" : "time, s"}`).join("  |  ")}[this.over]; }
  /// Number of the output that a run shows at a position.
  output(run, position = this.nearest) { return this.instants[position].outputs[run]; }
  /// The outputs that a run is between, and how far: {a, b, share}.
  between(run) {
    const low = Math.floor(this.position), a = this.output(run, low), b = this.output(run, Math.min(low + 1, this.count - 1));
    return {a, b, share: a === b ? 0 : this.position - low};
  }
  /// Horizontal place of a run's output in a chart.
  at(run, output) { return this.over === "stages" ? output : this.runs[run][this.over][output] ?? 0; }
  /// Horizontal place of a position.
  place(position = this.position) {
    const whole = p => this.runs.length === 1 ? this.at(0, p) : this.over === "strain" ? this.instants[p].strain : this.instants[p].time;
    const low = Math.floor(position), share = position - low;
    return share ? whole(low) + share * (whole(Math.min(low + 1, this.count - 1)) - whole(low)) : whole(low);
  }
  get words() {
    const over = this.over === "stages" ? this.stageAt(this.nearest).over : this.over, x = this.over === "stages" ? this.runs[0][over][this.nearest] : this.place(this.nearest);
    return over === "strain" ? `at strain ${format(x, 3)}` : `at ${format(x, 3)} s`;
  }
  stageAt(output) { return this.stages.findLast(stage => stage.from <= output) ?? this.stages[0]; }
  /// Goes to a position, which may lie between two instants.
  seek(position) {
    this.position = Math.max(0, Math.min(this.count - 1, position));
    for (const listener of this.listeners) listener();
  }
  /// The position whose place is nearest; of equal ones, such as while the strain stands still, the last.
  seekPlace(x) {
    let best = 0;
    for (let p = 0; p < this.count; ++p) if (Math.abs(this.place(p) - x) <= Math.abs(this.place(best) - x)) best = p;
    this.seek(best);
  }
  /// The instant nearest to a strain or a time of the first run, as a link names it.
  seekValue(over, value) {
    const values = this.runs[0][over], found = values.reduce((best, v, i) => Math.abs((v ?? 0) - value) <= Math.abs((values[best] ?? 0) - value) ? i : best, 0);
    this.seek(this.runs.length === 1 ? found : nearest(this.instants, instantsOf(this.runs[0])[found], over));
  }

  get playing() { return this.frame !== 0; }
  /// The whole run takes about 15 s at speed 1.
  play(speed = () => 1) {
    if (this.playing) return;
    if (this.position >= this.count - 1) this.seek(0);
    let last = performance.now();
    const tick = stamp => {
      const further = this.position + Math.max(0, stamp - last) / 1000 * Math.max(8, this.count / 15) * speed();
      last = stamp;
      this.frame = requestAnimationFrame(tick);
      this.seek(further);
      if (this.position >= this.count - 1) this.stop();
    };
    this.frame = requestAnimationFrame(tick);
    this.changed?.();
  }
  /// At the nearest instant.
  stop() {
    if (!this.playing) return;
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.seek(this.nearest);
    this.changed?.();
  }
}
