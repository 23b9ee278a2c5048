// ------------------------------------------------------------------------------------------------ the page of one run
/// What has to be known before anything else: files that are damaged, and what the run warned of; `name` is that of one run
/// among others.
function warningBoxes(run, name = "") {
  const damage = run.shown.damage || [], summary = run.summary || {}, warnings = [...(summary.warnings || [])];
  for (const {step, damaged_checkpoint: damaged} of summary.resumed || [])
    if (damaged) warnings.push(`The newest checkpoint was damaged, so that the run went on from the one before it, at step ${format(step)}: ${damaged}`);
  return [...(damage.length ? [warningBox(damage, "", name ? `Some of the files of ${name} are damaged` : "Some of the run's files are damaged")] : []),
    ...(warnings.length ? [warningBox(warnings, name && ` of ${name}`)] : [])];
}

/// How a run that was stopped can be ended; summaries of earlier versions do not say whether there is a checkpoint.
function howToGoOn({checkpoint_step: step}) {
  if (step === null) return "The run was stopped before its end. No checkpoint was kept, so that it can only begin again.";
  if (step === undefined) return "The run was stopped before its end; continue it with --resume.";
  return `The run was stopped before its end. The same command with --resume goes on from step ${format(step)}.`;
}
function notesOf(run) {
  const notes = [];
  if (isDrawn(run)) notes.push("Between two outputs the animation is interpolated.");
  if (run.shown.outputs < run.shown.of) notes.push(`${run.shown.outputs} of ${run.shown.of} outputs are shown here; the files have all.`);
  if (run.outlines && run.shown.node_stride > 1) notes.push(`Outlines are drawn through one in ${run.shown.node_stride} of their nodes.`);
  if (run.fields) notes.push("The flow is shown as means over blocks of the lattice" + (run.fields.derived ? ", the vorticity computed from the velocity that was written." : "."));
  return notes;
}
const whyNoAnimation = run => run.shown.note ? [element("p", {}, run.shown.note)] : [];

/// The scene goes with the page, so that a reader can run it again.
function runFooter(run) {
  const save = run.scene ? [button("Save scene.json", () => download("scene.json", new Blob([run.scene], {type: "application/json"})), {class: "small"})] : [];
  footer(programOf(run.summary), "This page shows one run; all that it draws is in it, and it can be sent as it is.", run.scene ? "rouleau run scene.json" : null, "with the scene that this page carries", save, licences());
}

function showRun(run) {
  const summary = run.summary || {}, title = titleOf(run), timeline = new Timeline([run]);
  document.title = `${title} – Rouleau`;
  page.append(element("h1", {}, title), note([summary.scene_file, summary.started, summary.machine].filter(Boolean).join(" · ")));
  page.append(...(run.shown.damage || []).length ? [warningBox(run.shown.damage, "", "Some of the run's files are damaged")] : []);
  page.append(resultCard(run, timeline), ...warningBoxes({...run, shown: {...run.shown, damage: []}}), links);
  if (!timeline.count) section("Results", element("p", {}, "No output has been written."), ...whyNoAnimation(run));
  else showResults(timeline, run);
  showTables(run);
  runFooter(run);
  if (timeline.count) begin(timeline, run, summary);
  return timeline;
}

/// Where the page begins: where its address says, or at the telling instant, from which it plays once unless motion is
/// unwanted.
function begin(timeline, run, summary) {
  if (followLink(timeline)) return;
  timeline.seek(tellingPosition(run, eventsOf(run)));
  const still = matchMedia("(prefers-reduced-motion: reduce)").matches || summary.status === "diverged" || !isDrawn(run);
  if (still) return;
  const started = setTimeout(() => { if (!printing && document.visibilityState === "visible") timeline.play(); }, 900), cancel = () => clearTimeout(started);
  for (const kind of ["pointerdown", "keydown", "beforeprint"]) addEventListener(kind, cancel, {once: true});
}

function showResults(timeline, run) {
  const events = eventsOf(run), view = new View([run]), box = element("div", {class: "stage"});
  section(run.cells ? "Cells" : "Flow", box);
  if (isDrawn(run)) {
    const card = element("div", {class: "card"}), {space, animation, parts} = drawnRun(card, timeline, 0, view), [first, second] = animationControls(timeline, animation ? [animation] : [], view, [storyStrip(timeline, events)], space ? [space] : []);
    timeline.animation = animation;
    card.append(first, instantLine(timeline, 0), second, ...failureNote(run), ...whyNoAnimation(run));
    if (space) card.append(note("Drag, or two fingers, to turn; Ctrl and the wheel, or + and −, to come closer; a cut across an axis opens all that lies before it."));
    box.append(card, ...parts);
  } else if (run.shown.note) box.append(element("div", {class: "card"}, ...whyNoAnimation(run)));
  section("Charts", axisControls(timeline), note("Point at a chart to go to that instant, drag across it to look closer, click a name to hide its line, a tick above to go to an event."));
  const notes = plots(timeline, page, {view, events});
  page.append(element("div", {class: "notes"}, ...[...notesOf(run), ...notes].map(note)));
}

/// Draws a run into `card`, {space, animation, parts}: in space its box there and, as parts for elsewhere, a section and the flow across x.
function drawnRun(card, timeline, r, view) {
  const run = timeline.runs[r];
  const flowCard = () => { const flow = element("div", {class: "card"}); timeline.across = new FlowAcross(flow, timeline, r); return flow; };
  if (!isInSpace(run)) {
    const hasProfile = run.fields?.velocity && !run.walls && drivenAlong(run);
    return {space: null, animation: new Animation(card, timeline, r, view), parts: hasProfile ? [element("div", {class: "pair"}, flowCard())] : []};
  }
  const surfaces = new Surfaces(run.surfaces ?? noSurfaces), section = new Section(run, surfaces), box = element("div", {class: "card"}), parts = [];
  const space = new SpaceView(card, timeline, r, view, surfaces), name = run.fields ? "Section and flow" : "Section";
  box.append(element("div", {class: "chart-head"}, element("h3", {}, name)));
  // Of plasma in a box shorter than it is high a section shows nothing that its profile does not.
  const animation = run.fields?.across && !surfaces.count && space.times > 1 ? null : new Animation(box, timeline, r, view, section);
  if (animation) { space.section = section; box.append(sectionControls(section, [animation, space])); parts.push(box); animation.canvas.classList.add("framed"); }
  if (run.fields?.across) parts.push(flowCard());
  return {space: space.renderer ? space : null, animation, parts: [element("div", {class: parts.length > 1 ? "pair" : ""}, ...parts)]};
}
/// Where the section lies, which `views` show.
function sectionControls(section, views) {
  const words = () => `z = ${format(section.z, 3)} µm`, where = element("span", {class: "quiet"}, words());
  const slider = element("input", {type: "range", min: 0, max: 1, step: .005, value: .5, "aria-label": "Place of the section", "aria-valuetext": words(), oninput: () => {
    section.z = Number(slider.value) * section.length;
    where.textContent = words(); slider.setAttribute("aria-valuetext", words());
    for (const view of views) view.draw();
  }});
  return element("div", {class: "controls"}, element("label", {}, "Plane across z"), slider, where);
}

/// All that is in tables, in four tabs.
function showTables(run) {
  const summary = run.summary || {}, margins = (summary.limits || []).map(l => l.margin).filter(m => typeof m === "number"), least = Math.min(...margins);
  const mark = margins.length && least < 1.5 ? {text: `${format(least, 3)} ×`, kind: least < 1 ? "bad" : "warn"} : null;
  tabs([
    {title: "Result", fill: () => { showHistory(run, summary); showErrorBars(summary); }},
    {title: "Physics", fill: () => { showDimensionless(summary.dimensionless || {}); showScene(run); }},
    {title: "Numerics", mark, fill: () => {
      showLimits(summary.limits || []);
      if ((summary.left_out || []).length) section("Not computed in this run", table([{title: "What", key: "what"}, {title: "Why", key: "why"}], summary.left_out, {stacked: true}));
      showConservation(summary);
      showCost(summary);
    }},
    {title: "Provenance", fill: () => { showPlugins(summary); showProvenance(run); }},
  ]);
}
