// -------------------------------------------------------------------------------------------------------------- tables
function showScene(run) {
  const {scene} = run, summary = run.summary || {}, shown = [];
  const choice = summary.numerics_choice;
  if (choice) shown.push(element("h3", {}, `Numerics, chosen for an error of ${format(100 * choice.target_error, 3)} % of the ${choice.of === "steady" ? "steady state" : "motion"}`),
    element("p", {}, `Expected: ${format(100 * choice.expected_error.resolution, 2)} % by the lattice, ${format(100 * choice.expected_error.inertia, 2)} % by the relaxed density${choice.expected_error.start > 0 ? `, ${format(100 * choice.expected_error.start, 2)} % by the start of the flow` : ""}.${typeof choice.measured_error === "number" ? ` Measured: ${format(100 * choice.measured_error, 2)} % (${spelled(choice.measured_of)}).` : ""}`),
    table([{title: "Setting", key: "pointer"}, {title: "Value", value: r => JSON.stringify(r.value)}, {title: "Why", key: "why"}], choice.values || [], {stacked: true}));
  const conversions = Array.isArray(summary.conversions) ? summary.conversions : [];
  if (conversions.length) shown.push(element("h3", {}, "Every conversion"), conversionTable(conversions));
  const wells = summary.wells || [];
  if (wells.length) shown.push(element("h3", {}, "Potential wells of the interactions"), table([{title: "Model", key: "model"}, {title: "Between", value: r => (r.between || []).join(", ")},
    {title: "Zero-force distance, nm", number: true, value: r => r.zero_force_distance_m === null ? null : r.zero_force_distance_m * 1e9}, {title: "Depth, J/m²", key: "depth_J_m2", number: true},
    {title: "Width, nm", number: true, value: r => r.width_m === null ? null : r.width_m * 1e9},
    ...(wells.some(r => r.widened) ? [{title: "Widened", number: true, value: r => r.widened ? `${format(r.widened, 3)} ×` : "–"}] : [])], wells, {stacked: true}));
  const packings = summary.packings || [];
  if (packings.length) shown.push(element("h3", {}, "Cells placed at random"), freeTable(packings));
  if (scene) shown.push(element("details", {}, element("summary", {}, "The scene as used (scene.json)"), element("pre", {class: "card"}, scene)));
  if (shown.length) section("Scene and conversions", ...shown);
}

/// A row for each quantity of each cell type or pair of them, with a pair of columns for each stage where the stages
/// differ. What has the same quantity and `of` in a stage is told apart by its order: no conversion is left out.
function conversionTable(conversions) {
  const stages = [...new Set(conversions.map(c => c.stage))], rows = new Map(), met = new Map();
  for (const c of conversions) {
    const inStage = JSON.stringify([c.quantity, c.of, c.stage]), nth = met.get(inStage) ?? 0, key = JSON.stringify([c.quantity, c.of, nth]);
    met.set(inStage, nth + 1);
    if (!rows.has(key)) rows.set(key, {quantity: c.quantity, of: c.of ?? "", unit: undefined, stages: new Map()});
    rows.get(key).unit ||= c.unit;
    rows.get(key).stages.set(c.stage, c);
  }
  const all = [...rows.values()], at = (row, stage) => row.stages.get(stage) ?? {};
  const same = stages.every(stage => all.every(row => at(row, stage).si === at(row, stages[0]).si && at(row, stage).lattice === at(row, stages[0]).lattice));
  const columns = (same ? stages.slice(0, 1) : stages).flatMap(stage => [
    {title: same ? "SI" : `SI (${stage})`, number: true, value: row => at(row, stage).si ?? null},
    {title: same ? "Lattice" : `Lattice (${stage})`, number: true, value: row => at(row, stage).lattice ?? null}]);
  return table([{title: "Quantity", key: "quantity"}, ...(all.some(row => row.of) ? [{title: "Of", key: "of"}] : []), {title: "Unit", key: "unit"}, ...columns], all, {stacked: true});
}

/// What the run reports with its measured errors: those that have one first.
function showErrorBars(summary) {
  const bars = Object.entries(summary.error_bars || {}).map(([name, bar]) => ({name, ...bar}));
  if (!bars.length) return;
  const runs = summary.error_bar_runs || {}, measured = bars.filter(bar => bar.error !== null), rest = bars.filter(bar => bar.error === null);
  section("Error bars", table([{title: "Quantity", value: r => drawnAs(r.name).title}, {title: "Value", value: r => { const {factor} = drawnAs(r.name); return withError(factor * r.value, r.error === null ? null : factor * r.error); }, number: true}, {title: "Error made of", key: "how"}], [...measured, ...rest], {stacked: true}),
    note(runs.missing || `Measured by ${(runs.companions || []).length} runs of the same scene with other numerics, which took ${format(100 * runs.share_of_run, 2)} % of this run's time.`));
}

function showDimensionless(given) {
  const meaning = {
    capillary: "shear stress against membrane elasticity", membrane_strain: "stretch that the shear stress asks for",
    adhesion_number: "attraction against shear stress", viscosity_ratio: "interior against suspending fluid",
    hematocrit: "share of the domain that the cells at rest enclose; with a feed as many as its hematocrit fills it with",
  };
  const has = name => given[name] !== undefined;
  const rows = [];
  if (has("reynolds_physical")) rows.push({name: "Reynolds number", real: given.reynolds_physical, simulated: given.reynolds_simulated, what: "inertia against viscosity; simulated with density_factor times the density"});
  for (const [name, what] of Object.entries(meaning)) if (has(name)) rows.push({name: name === "capillary" ? "Capillary number" : spelled(name), real: given[name], simulated: given[name], what});
  if (has("mach_wall")) rows.push({name: "Mach number of the walls", simulated: given.mach_wall, what: "of the lattice, not of the fluid"});
  if (has("mach_max")) rows.push({name: "Largest Mach number", simulated: given.mach_max, what: "of the lattice; compressibility errors grow with its square"});
  const known = new Set(["reynolds_physical", "reynolds_simulated", "mach_wall", "mach_max", ...Object.keys(meaning)]);
  for (const [name, value] of Object.entries(given)) if (!known.has(name)) rows.push({name: spelled(name), real: value, simulated: value, what: ""});
  if (rows.length) section("Dimensionless numbers", table([{title: "Number", key: "name"}, {title: "True", key: "real", number: true}, {title: "Simulated", key: "simulated", number: true}, {title: "What it is", key: "what"}], rows, {stacked: true}));
}

function showLimits(limits) {
  if (!limits.length) return;
  section("Limits and margins", table([{title: "Limit of the method", key: "name"}, {title: "Value", key: "value", number: true}, {title: "Limit", key: "limit", number: true},
    {title: "Margin", number: true, value: r => r.margin === null ? "–" : `${format(r.margin, 3)} ×`, mark: r => r.margin === null ? "" : r.margin < 1 ? "over" : r.margin < 1.5 ? "near" : ""},
    {title: "To widen it", key: "remedy"}], limits, {stacked: true}),
    note("Margin: by what factor the value may still change before it passes the limit; below 1 it has passed."));
}

function showPlugins(summary) {
  const plugins = summary.plugins || [];
  if (!plugins.length) return;
  const lock = summary.lock ? element("p", {}, "Locked by ", element("code", {}, summary.lock.file), ", SHA-256 ", element("code", {}, summary.lock.sha256))
    : note("Plugin versions were not pinned (rouleau plugins --lock pins them).");
  section("Plugins", table([{title: "Id", key: "id"}, {title: "Version", key: "version"}, {title: "Kind", key: "kind"},
    {title: "SHA-256", value: r => element("code", {}, r.sha256)}, {title: "Library", value: r => element("code", {}, r.library)}], plugins, {stacked: true}), lock);
}

/// What the run cost, and where the time went.
function showCost(summary) {
  const facts = [["Steps", format(summary.steps)], ["Strain", format(summary.strain)], ["Simulated", seconds(summary.simulated_time_s)], ["Took", seconds(summary.wall_s)], ["Steps per second", format(summary.steps_per_s, 3)],
    ["Million lattice updates per second", format(summary.mlups, 3)], ["Threads", format(summary.threads)], ["Precision", format(summary.precision)], ["Memory", summary.peak_rss_bytes ? `${format(summary.peak_rss_bytes / 1048576, 3)} MiB` : "–"]];
  if (Object.keys(summary).length) section("Cost", table([{title: "", value: r => r[0]}, {title: "", value: r => r[1], number: true}], facts.filter(([, text]) => text !== "–")));
  if ((summary.passes || []).length) section("Time by pass", passTable(summary.passes));
  if (Array.isArray(summary.stages) && summary.stages.length) section("Stages", freeTable(summary.stages));
}
function showConservation(summary) {
  if (summary.conservation) section("Conservation", table([{title: "Quantity", key: "name"}, {title: "Value", key: "value", number: true}],
    Object.entries(summary.conservation).map(([name, value]) => ({name: spelled(name), value}))));
}

function showHistory(run, summary) {
  const history = attracts(run) ? joinHistory(run) : summary.aggregate_history || [], gap = summary.contacts?.close_below_m;
  const title = attracts(run) ? "Aggregates" : `Cells that are close${gap ? ` (gaps below ${format(1e6 * gap, 3)} µm)` : ""}; nothing joins them`;
  const folded = rows => history.length > 12 ? element("details", {}, element("summary", {}, `All ${history.length} changes`), rows) : rows;
  if (history.length && history[0].members?.flat().length !== 1) section(title, folded(table([{title: "Strain", key: "strain", number: true}, {title: "Time, s", key: "time_s", number: true}, {title: "Count", key: "count", number: true},
    {title: "Members", value: r => (r.members || []).map(m => m.join("+")).join(" | ")}, {title: "Connected across the periodic boundary", value: r => r.through_image ? "yes" : "no"}], history.slice(0, 200), {stacked: true})),
    ...(history.length > 200 ? [note(`The first 200 of ${history.length} changes; summary.json has all.`)] : []));
  const stages = summary.rheology || [], largest = name => Math.max(...stages.map(stage => Math.abs(stage.means?.[name]?.mean ?? 0)));
  const isResult = (means, name) => (attracts(run) || !/^(aggregate|contact)/.test(name)) && (!name.startsWith("cell_free") || (!name.endsWith("empty") && layersAreThere(means)))
    && Math.abs(means[name].mean) >= 1e-9 * largest(name);  // below is rounding, of walls at rest for example
  const means = [...stages].reverse().flatMap(stage => Object.entries(stage.means || {}).filter(([, v]) => v && typeof v === "object" && typeof v.mean === "number")
    .filter(([name]) => isResult(stage.means, name)).map(([name, {mean, deviation}]) => {
      const {title, factor} = drawnAs(name), scaled = v => typeof v !== "number" ? "–" : Math.abs(v) < 1e-12 * Math.abs(mean) ? "0" : format(factor * v, 2);
      const known = stage.statistics?.[name], steady = typeof known?.mean === "number";
      return {title, stage: stage.stage, mean: steady ? withError(factor * known.mean, factor * known.bar_95) : "–", parts: steady ? format(known.independent_parts, 2) : "–", half: format(factor * mean, 3), deviation: scaled(deviation), verdict: steady ? "" : known?.verdict ?? ""};
    }));
  if (means.length) section("Means", table([{title: "Quantity", key: "title"}, {title: "Stage", key: "stage"}, {title: "Mean, 95 %", key: "mean", number: true}, {title: "Independent parts", key: "parts", number: true}, {title: "Second half", key: "half", number: true}, {title: "Standard deviation", key: "deviation", number: true},
    ...(means.some(r => r.verdict) ? [{title: "No mean, since", key: "verdict"}] : [])], means, {stacked: true}),
    note("Means from where a stage became steady, with bars that know chance and nothing of the lattice. Second half: plain means in time over it, and the standard deviation of its outputs."));
}

function showProvenance(run) {
  const summary = run.summary || {};
  const origin = [["Scene", summary.scene_file], ["Scene SHA-256", summary.scene_sha256], ["Program", summary.git], ["Machine", summary.machine], ["Started", summary.started]].filter(([, v]) => v);
  if (origin.length) section("Provenance", table([{title: "", value: r => r[0]}, {title: "", value: r => element("code", {}, r[1])}], origin));
}

const licences = () => element("details", {}, element("summary", {}, "Charts: uPlot 1.6.32, and its licence"), element("pre", {class: "prose"}, document.getElementById("uplot-licence").textContent.trim()));
