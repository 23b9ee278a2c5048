// ------------------------------------------------------------------------------------- what came out, in a sentence and four numbers
const listedWords = words => words.length < 2 ? words.join("") : `${words.slice(0, -1).join(", ")} and ${words.at(-1)}`;
const capital = text => text.replace(/^./u, c => c.toUpperCase());

/// Where an event of a run lies, in words: strain where its stage counts in that, else time.
function whenOf(run, position) {
  const stage = stagesOf(run).findLast(s => s.from <= position) ?? {over: "time_s"};
  return stage.over === "strain" ? `strain ${format(run.strain[position])}` : `${format(run.time_s[position], 3)} s`;
}

/// What a column of series.csv came to: its mean with a measured error or, where it is steady, a bar of 95 %; else its value at the end.
function meanOf(run, name) {
  const summary = run.summary || {}, stage = (summary.rheology || []).findLast(s => typeof s.means?.[name]?.mean === "number"), bar = summary.error_bars?.[name];
  if (!stage) return null;
  const known = stage.statistics?.[name], last = run.series?.[name]?.findLast(v => v !== null);
  if (typeof bar?.error === "number") return {value: bar.value ?? stage.means[name].mean, error: bar.error, about: "mean of the stage's second half, ± its measured error"};
  if (typeof known?.mean === "number") return {value: known.mean, error: known.bar_95, about: `mean of stage ${stage.stage} from ${format(known.from_s, 3)} s on, ± its bar of 95 %, which knows chance and not the lattice`};
  const why = `no mean: ${known?.verdict ?? "too short"}`;
  return typeof last === "number" ? {value: last, error: null, about: `at the end; ${why}`} : {value: stage.means[name].mean, error: null, about: `over the stage's second half; ${why}`};
}

/// A value with as many digits as its error, rounded up as the terminal does, has a meaning for: "0.347 ± 0.005"; without an
/// error three.
function withError(value, error) {
  if (!(error > 0)) return format(value, 3);
  const size = Math.floor(Math.log10(error)), decimals = Math.max(0, Math.min(8, 1 - size - (error / 10 ** size >= 2 ? 1 : 0)));
  const up = Math.ceil(error * 10 ** decimals * (1 - 1e-12)) / 10 ** decimals;
  return `${value.toFixed(decimals)} ± ${up.toFixed(decimals)}`.replace("-", "−");
}

/// A mean speed in the unit that keeps it readable.
function speedWords({value, error}) {
  const [unit, factor] = Math.abs(value) >= 1e-3 ? ["mm/s", 1e3] : ["µm/s", 1e6];
  return `${withError(factor * value, factor * error)} ${unit}`;
}

/// What the aggregates did: {sentences, numbers}, of runs with two cells or more.
function aggregation(run) {
  const history = joinHistory(run), cells = run.cells?.types.length ?? 0, at = h => outputAt(run, h.time_s), sentences = [], numbers = [];
  if (cells < 2 || !history.length) return {sentences, numbers};
  const largest = h => Math.max(...h.members.map(m => m.length)), began = history[0], last = history.at(-1), number = (value, label, h, about) => numbers.push({value, label, about, position: at(h)});
  const most = history.reduce((best, h) => largest(h) > largest(best) || (largest(h) === largest(best) && h.count < best.count) ? h : best), size = largest(most), when = h => whenOf(run, at(h));
  if (size === 1) return {sentences: [hasTraffic(run) ? "No two cells joined." : `No two of the ${cells} cells joined.`], numbers: []};
  if (hasTraffic(run)) { number(when(most), `largest aggregate (${size} cells)`, most, "the first output at which there is none larger"); return {sentences: [`The largest aggregate had ${size} cells, at ${when(most)}.`], numbers}; }
  const all = size === cells, name = all ? `${cells === 2 ? "both" : `all ${cells}`} cells` : `${size} of ${cells} cells`;
  if (most === began) sentences.push(`${capital(name)} were together from the start`);
  else { sentences.push(`${capital(name)} joined at ${when(most)}`); number(when(most), all ? "all cells joined" : `largest aggregate (${size} cells)`, most, "the first output at which they are one aggregate"); }
  const later = history.slice(history.indexOf(most) + 1), broke = later.find(h => (h.count > most.count && largest(h) < size) || (size === 2 && h.met_images?.some(pair => String(pair) === String(most.members.find(m => m.length === 2)))));
  if (!broke) { sentences[0] += " and stayed together."; if (history.length === 1) number(String(last.members.filter(m => m.length > 1).length), last.members.filter(m => m.length > 1).length === 1 ? "rouleau" : "rouleaux", last, "aggregates of two cells or more"); return {sentences, numbers}; }
  number(when(broke), "first break", broke, "the first output at which that aggregate has come apart");
  const end = largest(last) === 1;
  if (end) number(when(last), "all single from", last, "from here to the end no two cells are aggregated");
  sentences[0] += `. ${size === 2 ? "They" : "The aggregate"} ${end && when(last) === when(broke) ? `came apart into single cells at ${when(broke)}.` : `broke at ${when(broke)}; ${end ? `all cells were single from ${when(last)}` : `at the end the largest has ${largest(last)} cells`}.`}`;
  return {sentences, numbers};
}

/// {sentences, numbers: [{value, label, about, position}]} of a run that has outputs; numbers by weight, the first four are shown.
function resultOf(run) {
  const summary = run.summary || {}, {sentences, numbers} = aggregation(run), cells = run.cells?.types.length ?? 0, bars = summary.error_bars || {};
  const viscosity = meanOf(run, "relative_viscosity");
  if (viscosity && cells) { numbers.push({value: withError(viscosity.value, viscosity.error), label: "relative viscosity", about: viscosity.about}); sentences.push(`The relative viscosity is ${withError(viscosity.value, viscosity.error)}${viscosity.error === null ? " at the end" : ""}.`); }
  const deformations = (run.cells?.deformation ?? []).map(line => line.at(-1)).filter(v => v !== null);
  if (deformations.length) {
    const mean = deformations.reduce((a, b) => a + b) / deformations.length, value = withError(bars.deformation?.value ?? mean, bars.deformation?.error);
    numbers.push({value, label: cells > 1 ? "mean deformation at the end" : "deformation at the end", about: "(L − B)/(L + B) of the ellipses with the cells' second moments"});
    if (cells === 1) sentences.push(`The cell's deformation is ${value} at the end.`);
  }
  const [came, inside, left] = ["cells_in", "cells_inside", "cells_out"].map(name => run.series?.[name]?.at(-1));
  if (typeof inside === "number") sentences.push(`${came} ${came === 1 ? "cell" : "cells"} came in, ${left} left, and ${inside} ${inside === 1 ? "is" : "are"} inside at the end.`);
  const angle = run.cells?.angle_deg?.[0]?.at(-1);
  if (cells === 1 && typeof angle === "number") numbers.push({value: `${withError(angle, (bars.angle_rad?.error ?? 0) * 180 / Math.PI)}°`, label: "angle of the long axis at the end", about: "against the flow, counter-clockwise"});
  const turns = (summary.rheology || []).at(-1)?.rotation?.[0];
  if (cells === 1 && turns?.turns >= 1) numbers.push({value: format(Math.abs(turns.tank_treading_rad_per_strain), 3), label: "tank-treading, rad per strain", about: `over ${turns.turns} whole turns of the outline`});
  const flow = meanOf(run, "flow_rate_m2_per_s"), speed = meanOf(run, "mean_velocity_m_per_s"), depth = run.domain?.size_um[2];
  if (speed) numbers.push({value: speedWords(speed), label: "mean velocity", about: speed.about});
  if (flow && summary.dimensions !== 3) numbers.push({value: `${format(flow.value, 3)} m²/s`, label: "flow rate per depth", about: flow.about});
  if (flow && summary.dimensions === 3 && depth) numbers.push({value: `${format(flow.value * depth * 1e-6, 3)} m³/s`, label: "flow rate", about: flow.about});
  if (!cells && speed) sentences.push(`The fluid flows at ${speedWords(speed)}${speed.error === null ? " at the end" : " on average"}.`);
  const layer = ["cell_free_layer_lower_m", "cell_free_layer_upper_m"].map(name => meanOf(run, name)?.value).filter(v => typeof v === "number");
  if (layer.length && layersAreThere(summary.rheology.at(-1).means)) numbers.push({value: `${format(1e6 * layer.reduce((a, b) => a + b) / layer.length, 3)} µm`, label: "cell-free layer", about: "mean of both walls"});
  if (typeof summary.conservation?.area_drift_max === "number" && cells) numbers.push({value: `${format(100 * summary.conservation.area_drift_max, 2)} %`, label: `largest ${summary.dimensions === 3 ? "volume" : "area"} drift`, about: "of any cell at any time: a measure of the error"});
  if (numbers.length && run.summary && !Object.keys(bars).length) sentences.push("No error bars were measured (rouleau run --error-bar).");
  if (!sentences.length) sentences.push(cells ? `${cells} ${cells === 1 ? "cell" : "cells"}, ${whenOf(run, run.step.length - 1)} at the end.` : "The fluid alone was simulated.");
  return {sentences, numbers};
}

function sceneOf(run) { try { return JSON.parse(run.scene); } catch { return null; } }  // a scene may have comments
const titleOf = run => run.summary?.title || sceneOf(run)?.title || "Untitled scene";
function expectedOf(run) { const expected = sceneOf(run)?.expected; return typeof expected === "string" ? expected : null; }

/// How a run ended where that is not as it should be, and what it cost.
function statusBox(run) {
  const summary = run.summary || {}, words = {completed: "Completed", diverged: "Diverged", interrupted: "Interrupted"};
  const status = summary.status || "unfinished", last = (summary.stages || []).at(-1), cut = status === "completed" && last && last.ended_by === "max_steps";
  const box = element("div", {class: "card status" + (status === "completed" && !cut ? "" : status === "diverged" ? " bad" : " warn"), role: "status"},
    element("strong", {}, cut ? capital(summary.outcome || "cut short by the limit of steps") : words[status] || "Not finished"));
  if (!run.summary) box.append(element("p", {}, "There is no summary.json: the run is still going on, or was killed. Below is what it had written."));
  if (status === "interrupted") box.append(element("p", {}, howToGoOn(summary)));
  const {failure} = summary;
  if (failure) {
    const where = failure.place_m ? `at (${failure.place_m.map(v => v === null ? "?" : format(v * 1e6)).join(", ")}) µm` : "";
    box.append(element("p", {}, failure.message || spelled(failure.reason)),
      element("p", {}, `${failure.reason}: step ${format(failure.step)}, strain ${format(failure.strain)}, ${format(failure.time_s)} s, ${where}` +
        (failure.cell === null || failure.cell === undefined ? "" : `, cell ${failure.cell}`) + `; ${format(failure.value)} against a limit of ${format(failure.limit)}.`));
    if (failure.remedy) box.append(element("p", {}, element("b", {}, "What to change: "), failure.remedy));
  }
  return box;
}

/// The result in words and numbers, what the scene expected beside it, and in one line what it cost.
function resultCard(run, timeline) {
  const summary = run.summary || {}, {sentences, numbers} = run.step.length ? resultOf(run) : {sentences: [], numbers: []}, expected = expectedOf(run);
  const box = statusBox(run);
  box.classList.add("result");
  if (sentences.length) box.append(element("p", {class: "came-out"}, sentences.join(" ")));
  if (numbers.length) box.append(element("dl", {class: "numbers"}, ...numbers.slice(0, 4).map(({value, label, about, position}) => element("div", {title: about}, element("dt", {}, label),
    element("dd", {}, position >= 0 ? button(value, () => { timeline.stop(); timeline.seek(position); }, {"aria-label": `${label}: ${value}; go there`}) : value)))));
  if (expected) box.append(element("p", {class: "expected"}, element("b", {}, "Expected: "), expected));
  const cost = [["simulated", seconds(summary.simulated_time_s)], ["took", seconds(summary.wall_s)], ["threads", format(summary.threads)], ["steps", format(summary.steps)]];
  if (run.summary) box.append(element("dl", {class: "facts"}, ...cost.map(([k, v]) => element("div", {}, element("dt", {}, k), element("dd", {}, v)))));
  return box;
}
