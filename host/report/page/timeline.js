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

class Timeline {
  constructor(runs) {
    this.runs = runs;
    this.listeners = [];
    this.sheared = runs.some(grows);
    this.over = this.sheared ? "strain" : "time_s";
    this.instants = mergedInstants(runs, this.over);
    this.position = 0;
    this.frame = 0;
  }
  /// The horizontal axis of all charts from now on: "strain", "time_s" or "output". The instant that is shown stays.
  setOver(over) {
    this.stop();
    const shown = this.instant;
    this.over = over;
    if (this.runs.length === 1) return;
    this.instants = mergedInstants(this.runs, over);
    this.position = nearest(this.instants, shown, over);
  }
  get count() { return this.instants.length; }
  get instant() { return this.instants[this.position]; }
  get title() { return {strain: "strain", time_s: "time, s", output: "output"}[this.over]; }
  /// Number of the output that a run shows at a position.
  output(run, position = this.position) { return this.instants[position].outputs[run]; }
  /// Horizontal place of a run's output in a chart.
  at(run, output) { return this.over === "output" ? output : this.runs[run][this.over][output] ?? 0; }
  /// Horizontal place of a position; two runs are not compared over their outputs.
  place(position = this.position) {
    if (this.runs.length === 1) return this.at(0, position);
    return this.over === "strain" ? this.instants[position].strain : this.instants[position].time;
  }
  get words() {
    const x = this.place();
    return this.over === "strain" ? `at strain ${format(x, 3)}` : this.over === "output" ? `at output ${x}` : `at ${format(x, 3)} s`;
  }
  seek(position) {
    this.position = Math.max(0, Math.min(this.count - 1, Math.round(position)));
    for (const listener of this.listeners) listener();
  }
  /// The position whose place is nearest; of equal ones, such as while the strain stands still, the last.
  seekPlace(x) {
    let best = 0;
    for (let p = 0; p < this.count; ++p) if (Math.abs(this.place(p) - x) <= Math.abs(this.place(best) - x)) best = p;
    this.seek(best);
  }

  get playing() { return this.frame !== 0; }
  /// The whole run takes about 15 s at speed 1.
  play(speed, changed) {
    if (this.position >= this.count - 1) this.seek(0);
    this.changed = changed;
    let reached = this.position, last = performance.now();
    const tick = stamp => {
      reached += Math.max(0, stamp - last) / 1000 * Math.max(8, this.count / 15) * speed();
      last = stamp;
      this.frame = requestAnimationFrame(tick);
      if (Math.floor(reached) > this.position) this.seek(Math.floor(reached));
      if (this.position >= this.count - 1) this.stop();
    };
    this.frame = requestAnimationFrame(tick);
    changed();
  }
  stop() {
    cancelAnimationFrame(this.frame);
    this.frame = 0;
    this.changed?.();
  }
}
