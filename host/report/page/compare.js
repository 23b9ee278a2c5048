// ------------------------------------------------------------------------------------------------ several runs side by side
const asText = value => value === undefined || value === null ? "–" : typeof value === "number" ? format(value, 6) : typeof value === "string" ? value : JSON.stringify(value);
const shortened = (text, most = 48) => text.length > most ? `${text.slice(0, most - 1)}…` : text;
/// What a pointer into a scene is called: its last word that is no number.
const settingName = pointer => pointer.split("/").filter(word => word && !/^\d+$/.test(word)).at(-1)?.replaceAll("_", " ") ?? "scene";

/// The settings that differ, {pointer, values}: how cells were placed comes last.
const settingsOf = ({scene}) => (scene ?? []).filter(row => !["/title", "/expected"].includes(row.pointer)).sort((a, b) => a.pointer.startsWith("/cells") - b.pointer.startsWith("/cells"));

/// What tells run `r` from the others, in words: its settings that differ, those first that tell most runs apart, or its
/// directory.
function differenceWords(r, differences, runs) {
  const kinds = ({values}) => new Set(values.map(asText)).size, rows = settingsOf(differences).sort((a, b) => kinds(b) - kinds(a));
  return rows.length ? rows.slice(0, 3).map(row => `${settingName(row.pointer)} ${shortened(asText(row.values[r]), 32)}`).join(", ") + (rows.length > 3 ? ` and ${rows.length - 3} more` : "") : runs[r].directory;
}
function runName(r, {runs, differences}) {
  return element("p", {class: "run-name"}, element("b", {style: `border-color:var(${runTones[r]})`}, runNames[r]), element("strong", {}, differenceWords(r, differences, runs)));
}

function showComparison(data) {
  const {runs, differences} = data, titles = [...new Set(runs.map(run => run.summary.title || "Untitled scene"))];
  document.title = `${titles.join(" | ")} – Rouleau`;
  page.append(element("h1", {}, titles.join(" | ")), note(`${runs.length} runs side by side`));
  runs.forEach((run, r) => page.append(...warningBoxes(run, runNames[r])));
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
  licences();
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
      animations.push(animation);
      if (space) spaces.push(space);
      box.append(...parts.flatMap(part => [...part.children]).slice(0, 1));
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
    {title: "took", value: ({run}) => seconds(run.summary.wall_s), sort: ({run}) => run.summary.wall_s, number: true}], rows, {sortable: true});
}

function showDifferences(data) {
  const {runs, differences: {scene, plugins, outcome}} = data, none = text => element("p", {}, text), both = runs.length === 2 ? "Both" : "All";
  const each = value => runs.map((_, r) => ({title: runNames[r], value: row => value(row.values[r])}));
  section("Runs", runTable(data));
  section("Scenes", scene === null ? none("One of the runs has no scene.json: the scenes cannot be compared.")
    : scene.length ? table([{title: "JSON pointer", value: r => element("code", {}, r.pointer || "(all)")}, ...each(value => element("code", {}, asText(value)))], scene, {stacked: true}) : none(`${both} runs have the same scene.`));
  const used = plugin => plugin ? element("span", {}, plugin.version, element("br"), element("code", {}, plugin.sha256)) : "not used";
  section("Plugins", plugins.length ? table([{title: "Kind", key: "kind"}, {title: "Id", key: "id"}, ...each(used)], plugins, {stacked: true}) : none(`${both} runs used the same plugins, byte for byte.`));
  const differing = outcome.filter(row => row.differs), alike = outcome.length - differing.length;
  const ratio = ({values: [a, b]}) => typeof a === "number" && typeof b === "number" && a !== 0 ? `${format(100 * (b - a) / Math.abs(a), 3)} %` : "";
  section("Outcome", differing.length ? table([{title: "What", value: r => spelled(r.name).replace(/\//g, ", ")}, ...each(asText).map(column => ({...column, number: true})),
    ...(runs.length === 2 ? [{title: "B against A", number: true, value: ratio}] : [])], differing, {stacked: true}) : none("All numbers are the same."),
    ...(alike && differing.length ? [note(`${alike} more ${alike === 1 ? "is" : "are"} the same in all runs.`)] : []));
}
