// ------------------------------------------------------------------------------------------------ several runs side by side
const asText = value => value === undefined || value === null ? "–" : typeof value === "number" ? format(value, 6) : typeof value === "string" ? value : JSON.stringify(value);
const shortened = (text, most = 48) => text.length > most ? `${text.slice(0, most - 1)}…` : text;
/// What a pointer into a scene is called: its last word that is no number.
const settingName = pointer => pointer.split("/").filter(word => word && !/^\d+$/.test(word)).at(-1)?.replaceAll("_", " ") ?? "scene";

/// The settings that differ, {pointer, values}: how cells were placed comes last.
const settingsOf = ({scene}) => (scene ?? []).filter(row => !/^\/(title|expected|notes)\b/.test(row.pointer)).sort((a, b) => a.pointer.startsWith("/cells") - b.pointer.startsWith("/cells"));

/// What tells run `r` from the others, in words: its settings that differ, those first that tell most runs apart; where they are
/// more than three, its title, if it has one of its own; or its directory.
function differenceWords(r, differences, runs) {
  const titles = runs.map(run => run.summary.title || ""), all = settingsOf(differences);
  if (all.length > 3 && titles.every(Boolean) && new Set(titles).size === titles.length) return titles[r];
  const kinds = ({values}) => new Set(values.map(asText)).size, rows = settingsOf(differences).sort((a, b) => kinds(b) - kinds(a));
  const simple = rows.filter(({values}) => values.every(v => typeof v !== "object" || v === null)), named = (simple.length ? simple : rows).slice(0, 3);
  return named.length ? named.map(row => `${settingName(row.pointer)} ${shortened(asText(row.values[r]), 32)}`).join(", ") + (rows.length > named.length ? ` and ${rows.length - named.length} more` : "") : runs[r].directory;
}
function runName(r, {runs, differences}) {
  return element("p", {class: "run-name"}, element("b", {style: `border-color:var(${runTones[r]})`}, runNames[r]), element("strong", {}, differenceWords(r, differences, runs)));
}

function showComparison(data) {
  const {runs, differences} = data, titles = [...new Set(runs.map(titleOf))];
  document.title = `${titles.join(" | ")} – Rouleau`;
  page.append(element("h1", {}, titles.join(" | ")), note(`${runs.length} runs side by side`));
  const warned = runs.map((run, r) => warningBoxes(run, runNames[r])), isShared = warned.every((boxes, r) => boxes.length && JSON.stringify([runs[r].summary.warnings, runs[r].shown.damage, runs[r].summary.resumed]) === JSON.stringify([runs[0].summary.warnings, runs[0].shown.damage, runs[0].summary.resumed]));
  page.append(...isShared ? warningBoxes(runs[0], "all runs") : warned.flat());
  page.append(element("div", {class: "pair"}, ...runs.map((run, r) => {
    const box = statusBox(run);
    box.prepend(runName(r, data));
    box.append(...(run.step.length ? [element("p", {}, resultOf(run).sentences.join(" "))] : []), note(run.directory));
    return box;
  })), links);

  const timeline = new Timeline(runs);
  if (runs.some(run => !run.step.length)) section("Results", element("p", {}, "One of the runs has written no output: there is nothing to lay side by side."));
  else showAllResults(timeline, data);
  showDifferences(data);
  footer(programOf(runs[0].summary), `This page lays ${runs.length} runs side by side; all that it draws is in it.`, `rouleau report --compare ${runs.map(run => /\s/.test(run.directory) ? `"${run.directory}"` : run.directory).join(" ")}`, "beside the directories of the runs", [], licences());
  if (runs.every(run => run.step.length) && !followLink(timeline)) timeline.seek(telling(timeline));
  return timeline;
}

/// The instant at which the first run tells most.
function telling(timeline) {
  const [run] = timeline.runs;
  return nearest(timeline.instants, instantsOf(run)[tellingPosition(run, eventsOf(run))], timeline.over);
}

function showAllResults(timeline, data) {
  const {runs} = data, views = element("div", {class: "pair"}), view = new View(runs), animations = [], spaces = [];
  section(runs.some(run => run.cells) ? "Cells" : "Flow", views);
  runs.forEach((run, r) => {
    const box = element("div", {class: "card"}, runName(r, data));
    views.append(box);
    if (isDrawn(run)) {
      const {space, animation, parts} = drawnRun(box, timeline, r, view);
      if (animation) animations.push(animation);
      if (space) spaces.push(space);
      box.append(...parts.flatMap(part => [...part.children]));
    } else if (!run.shown.note) box.append(note("No animation: there are no cells."));
    box.append(...whyNoAnimation(run), instantLine(timeline, r), ...failureNote(run));
  });
  const alike = note("");
  page.append(element("div", {class: "card", style: "margin-top:14px"}, ...animationControls(timeline, animations, view, [], spaces)), alike);
  timeline.listeners.push(() => {
    alike.textContent = timeline.over === "strain" ? "All show the same strain and, where it stands still, the same time since they came to rest: the nearest output of each."
      : "All show the same time: the nearest output of each.";
  });
  section("Charts", axisControls(timeline));
  const notes = plots(timeline, page, {view}), own = runs.map(notesOf);
  own.forEach((texts, r) => { for (const text of texts) {
    if (!own.every(others => others.includes(text))) notes.push(`${runNames[r]}: ${text}`); else if (r === 0) notes.push(text);
  } });
  page.append(element("div", {class: "notes"}, ...notes.map(note)));
}

/// A row for each run: the settings that differ, and what came out; a click on a title sorts.
function runTable({runs, differences}) {
  const settings = settingsOf(differences).slice(0, 6), results = runs.map(run => run.step.length ? resultOf(run).numbers : []);
  const rows = runs.map((run, r) => ({run, r})), leading = text => { const v = parseFloat(String(text ?? "").replaceAll("\u202f", "").replace("−", "-").replace(/^strain /, "")); return Number.isFinite(v) ? v : String(text ?? ""); };
  const labels = [...new Set(results.flatMap(numbers => numbers.map(n => n.label)))].slice(0, 6), found = (r, label) => results[r].find(n => n.label === label)?.value;
  return table([{title: "Run", value: ({r}) => element("span", {class: "run-name"}, element("b", {style: `border-color:var(${runTones[r]})`}, runNames[r])), sort: ({r}) => r},
    ...settings.map(row => ({title: settingName(row.pointer), value: ({r}) => shortened(asText(row.values[r])), sort: ({r}) => leading(row.values[r])})),
    {title: "status", value: ({run}) => run.summary.status}, ...labels.map(label => ({title: label, value: ({r}) => found(r, label) ?? "–", sort: ({r}) => leading(found(r, label)), number: true})),
    {title: "took", value: ({run}) => seconds(run.summary.wall_s), sort: ({run}) => run.summary.wall_s, number: true}], rows, {sortable: true, fitting: true, stacked: true});
}

function showDifferences(data) {
  const {runs, differences: {scene, plugins, outcome}} = data, none = text => element("p", {}, text), both = runs.length === 2 ? "Both" : "All";
  const each = value => runs.map((_, r) => ({title: runNames[r], value: row => value(row.values[r])}));
  section("Runs", runTable(data));
  const settings = scene && settingsOf(data.differences);
  section("Scenes", scene === null ? none("One of the runs has no scene.json: the scenes cannot be compared.")
    : settings.length ? table([{title: "JSON pointer", value: r => element("code", {}, r.pointer || "(all)")}, ...each(value => element("code", {}, asText(value)))], settings, {stacked: true}) : none(`${both} runs have the same scene${scene.length ? " but for its words" : ""}.`));
  const used = plugin => plugin ? element("span", {}, plugin.version, element("br"), element("code", {}, plugin.sha256)) : "not used";
  section("Plugins", plugins.length ? table([{title: "Kind", key: "kind"}, {title: "Id", key: "id"}, ...each(used)], plugins, {stacked: true}) : none(`${both} runs used the same plugins, byte for byte.`));
  showOutcome(data);
}

/// What came out, physics first; numerics and the machine are folded, and what is rounding is left out.
function showOutcome({runs, differences: {outcome}}) {
  const differing = outcome.filter(row => row.differs), alike = outcome.length - differing.length, notes = [];
  const scales = new Map(), quantity = name => name.replace(/^mean\/.*\//, "").replace(/_(lower|upper)(?=_)/, ""), sizes = ({values}) => values.filter(Number.isFinite).map(Math.abs);
  for (const row of outcome) scales.set(quantity(row.name), Math.max(scales.get(quantity(row.name)) ?? 0, ...sizes(row)));
  const isRounding = row => sizes(row).length > 0 && Math.max(...sizes(row)) < 1e-9 * scales.get(quantity(row.name)), isLayer = ({name}) => /cell_free/.test(name) && (/empty/.test(name) || !runs.every(run => layersAreThere(run.summary.rheology?.at(-1)?.means)));
  const real = differing.filter(row => !isRounding(row) && !isLayer(row)), isNumerics = ({name}) => /^conservation|mach|simulated$/.test(name) || !/^(mean|stretch|dimensionless|failure|status|aggregates)/.test(name);
  const spreadOf = (r, name) => { const [, stage, of] = name.match(/^mean\/(.*)\/([^/]*)$/) ?? []; return of ? runs[r].summary.rheology?.find(s => s.stage === stage)?.means?.[of]?.error ?? null : null; };
  const value = (row, r) => { const v = row.values[r], {factor} = drawnAs(row.name); return typeof v !== "number" ? asText(v) : isNothing(v, row) && v ? "≈ 0" : row.name.startsWith("mean/") ? withError(factor * v, factor * errorOf(r, row.name), factor * (spreadOf(r, row.name) ?? 0)) : format(factor * v, 4); };
  const isNothing = (v, row) => Math.abs(v) < 1e-9 * scales.get(quantity(row.name));
  // What was measured with an error says whether a difference is one.
  const errorOf = (r, name) => { const [, stage, of] = name.match(/^mean\/(.*)\/([^/]*)$/) ?? []; return of && stage === runs[r].summary.rheology?.at(-1)?.stage ? runs[r].summary.error_bars?.[of]?.error ?? 0 : 0; };
  const ratio = row => {
    const [a, b] = row.values;
    if (typeof a !== "number" || typeof b !== "number" || Math.abs(a) <= 1e-6 * Math.abs(b) || isNothing(a, row)) return "";
    return Math.abs(b - a) <= errorOf(0, row.name) + errorOf(1, row.name) ? "within the errors" : `${format(100 * (b - a) / Math.abs(a), 3)} %`;
  };
  const rows = list => table([{title: "What", value: r => drawnAs(r.name).title.replace(/\//g, ", ")}, ...runs.map((_, r) => ({title: runNames[r], number: true, value: row => value(row, r)})),
    ...(runs.length === 2 ? [{title: "B against A", number: true, value: ratio}] : [])], list, {stacked: true});
  const order = ({name}) => ["mean", "stretch", "aggregates", "dimensionless"].findIndex(group => name.startsWith(group)), physics = real.filter(row => !isNumerics(row)).sort((a, b) => (order(a) + 5) % 5 - (order(b) + 5) % 5), numerics = real.filter(isNumerics);
  if (alike && differing.length) notes.push(`${alike} more ${alike === 1 ? "is" : "are"} the same in all runs.`);
  if (differing.length > real.length) notes.push("Left out: what differs by rounding alone, and cell-free layers of boxes that have none.");
  section("Outcome", ...(differing.length ? [...(physics.length ? [rows(physics)] : [element("p", {}, "All physical results are the same.")]),
    ...(numerics.length ? [element("details", {}, element("summary", {}, "Numerics, cost and machine"), rows(numerics))] : []), ...notes.map(note)] : [element("p", {}, "All numbers are the same.")]));
}
