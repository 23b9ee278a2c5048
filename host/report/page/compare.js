// ------------------------------------------------------------------------------------------------- two runs side by side
function runName(run, r) {
  return element("p", {class: "run-name"}, element("b", {style: `background:var(${runTones[r]})`}, runNames[r]), run.summary.title || "Untitled scene", " ",
    element("span", {class: "quiet"}, run.directory));
}
const asText = value => value === undefined ? "–" : typeof value === "number" ? format(value, 6) : typeof value === "string" ? value : JSON.stringify(value);

function showComparison({runs, differences}) {
  document.title = `${runs.map(run => run.summary.title || run.directory).join(" | ")} – Rouleau`;
  page.append(element("h1", {}, "Two runs side by side"));
  runs.forEach((run, r) => page.append(...warningBoxes(run, runNames[r])));
  page.append(element("div", {class: "pair"}, ...runs.map((run, r) => element("div", {}, runName(run, r), statusBox(run)))), links);

  const timeline = new Timeline(runs);
  if (runs.some(run => !run.step.length)) section("Results", element("p", {}, "One of the runs has written no output: there is nothing to lay side by side."));
  else showBothResults(timeline, runs);
  showDifferences(differences);
  licences();
  if (runs.every(run => run.step.length)) timeline.seek(0);
  return timeline;
}

function showBothResults(timeline, runs) {
  const views = element("div", {class: "pair"}), chosen = {name: ""}, animations = [];
  section(runs.some(run => run.cells) ? "Cells" : "Flow", views);
  runs.forEach((run, r) => {
    const box = element("div", {class: "card"}, runName(run, r));
    views.append(box);
    if (run.outlines || run.fields) animations.push(new Animation(box, timeline, r, () => chosen.name));
    else if (!run.shown.note) box.append(note("No animation: there are no cells."));
    box.append(...whyNoAnimation(run), instantLine(timeline, r), ...failureNote(run));
  });
  page.append(element("div", {class: "card", style: "margin-top:14px"}, animationControls(timeline, animations, chosen)));
  const alike = note("");
  timeline.listeners.push(() => {
    alike.textContent = timeline.over === "strain" ? "Both show the same strain and, where it stands still, the same time since they came to rest: the nearest output of each."
      : "Both show the same time: the nearest output of each.";
  });
  page.append(alike);
  const grid = element("div", {class: "charts"});
  section("Plots", axisControls(timeline), grid);
  const notes = plots(timeline, grid, grid);
  const own = runs.map(notesOf);
  own.forEach((texts, r) => { for (const text of texts) {
    if (!own[1 - r].includes(text)) notes.push(`${runNames[r]}: ${text}`); else if (r === 0) notes.push(text);
  } });
  for (const text of notes) page.append(note(text));
}

function showDifferences({scene, plugins, outcome}) {
  const sides = ["a", "b"].map((side, r) => ({title: runNames[r], value: row => element("code", {}, asText(row[side]))}));
  const none = text => element("p", {}, text);
  section("Scenes", scene === null ? none("One of the runs has no scene.json: the scenes cannot be compared.")
    : scene.length ? table([{title: "JSON pointer", value: r => element("code", {}, r.pointer || "(all)")}, ...sides], scene, {stacked: true}) : none("Both runs have the same scene."));
  const used = side => row => row[side] ? element("span", {}, row[side].version, element("br"), element("code", {}, row[side].sha256)) : "not used";
  section("Plugins", plugins.length ? table([{title: "Kind", key: "kind"}, {title: "Id", key: "id"}, {title: "A", value: used("a")}, {title: "B", value: used("b")}], plugins, {stacked: true})
    : none("Both runs used the same plugins, byte for byte."));
  const differing = outcome.filter(row => row.differs), alike = outcome.length - differing.length;
  const ratio = row => typeof row.a === "number" && typeof row.b === "number" && row.a !== 0 ? `${format(100 * (row.b - row.a) / Math.abs(row.a), 3)} %` : "";
  const value = side => row => asText(row[side] === null ? undefined : row[side]);
  section("Outcome", differing.length ? table([{title: "What", value: r => spelled(r.name).replace(/\//g, ", ")}, {title: "A", value: value("a"), number: true}, {title: "B", value: value("b"), number: true},
    {title: "B against A", number: true, value: ratio}], differing, {stacked: true}) : none("All numbers are the same."),
    ...(alike && differing.length ? [note(`${alike} more ${alike === 1 ? "is" : "are"} the same in both.`)] : []));
}
