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

function statusBox(run) {
  const summary = run.summary || {};
  const words = {completed: "Completed", diverged: "Diverged", interrupted: "Interrupted"};
  const status = summary.status || "unfinished", last = (summary.stages || []).at(-1);
  const cut = status === "completed" && last && last.ended_by === "max_steps";
  const box = element("div", {class: "card status" + (status === "completed" && !cut ? "" : status === "diverged" ? " bad" : " warn"), role: "status"},
    element("strong", {}, cut ? (summary.outcome || "cut short by the limit of steps").replace(/^./, c => c.toUpperCase()) : words[status] || "Not finished"));
  if (!run.summary) box.append(element("p", {}, "There is no summary.json: the run is still going on, or was killed. Below is what it had written."));
  if (status === "interrupted") box.append(element("p", {}, howToGoOn(summary)));
  const failure = summary.failure;
  if (failure) {
    const where = failure.place_m ? `at (${failure.place_m.map(v => v === null ? "?" : format(v * 1e6)).join(", ")}) µm` : "";
    box.append(element("p", {}, failure.message || spelled(failure.reason)),
      element("p", {}, `${failure.reason}: step ${format(failure.step)}, strain ${format(failure.strain)}, ${format(failure.time_s)} s, ${where}` +
        (failure.cell === null || failure.cell === undefined ? "" : `, cell ${failure.cell}`) + `; ${format(failure.value)} against a limit of ${format(failure.limit)}.`));
    if (failure.remedy) box.append(element("p", {}, element("b", {}, "What to change: "), failure.remedy));
  }
  const facts = [["steps", format(summary.steps)], ["strain", format(summary.strain)], ["simulated", seconds(summary.simulated_time_s)],
    ["took", seconds(summary.wall_s)], ["steps/s", format(summary.steps_per_s, 3)], ["MLUPS", format(summary.mlups, 3)],
    ["threads", format(summary.threads)], ["precision", format(summary.precision)],
    ["memory", summary.peak_rss_bytes ? `${format(summary.peak_rss_bytes / 1048576, 3)} MiB` : "–"]];
  if (run.summary) box.append(element("dl", {class: "facts"}, ...facts.map(([k, v]) => element("div", {}, element("dt", {}, k), element("dd", {}, v)))));
  return box;
}
function notesOf(run) {
  const notes = [];
  if (run.shown.outputs < run.shown.of) notes.push(`${run.shown.outputs} of ${run.shown.of} outputs are shown here; the files have all.`);
  if (run.outlines && run.shown.node_stride > 1) notes.push(`Outlines are drawn through one in ${run.shown.node_stride} of their nodes.`);
  if (run.fields) notes.push("The flow is shown as means over blocks of the lattice" + (run.fields.derived ? ", the vorticity computed from the velocity that was written." : "."));
  return notes;
}

function showRun(run) {
  const summary = run.summary || {}, title = summary.title || "Untitled scene";
  document.title = `${title} – Rouleau`;
  page.append(element("h1", {}, title), note([summary.scene_file, summary.started, summary.machine].filter(Boolean).join(" · ")));
  page.append(...warningBoxes(run), statusBox(run), links);

  const timeline = new Timeline([run]);
  if (!timeline.count) section("Results", element("p", {}, "No output has been written."), ...whyNoAnimation(run));
  else showResults(timeline, run);
  showErrorBars(summary);
  showScene(run);
  showDimensionless(summary.dimensionless || {});
  showLimits(summary.limits || []);
  if ((summary.left_out || []).length) section("Left out, and why", table([{title: "What", key: "what"}, {title: "Why", key: "why"}], summary.left_out, {stacked: true}));
  showPlugins(summary);
  showPasses(summary.passes || []);
  showHistory(summary);
  showProvenance(run);
  licences();
  timeline.seek(summary.status === "diverged" ? timeline.count - 1 : 0);  // where it went bad
  return timeline;
}
const whyNoAnimation = run => run.shown.note ? [element("p", {}, run.shown.note)] : [];

function showResults(timeline, run) {
  const top = element("div", {class: "stage"}), grid = element("div", {class: "charts"}), side = element("div", {});
  section(run.cells ? "Cells" : "Flow", top, grid);
  if (run.outlines || run.fields) {
    const chosen = {name: ""}, box = element("div", {class: "card"});
    top.append(box);
    const animation = new Animation(box, timeline, 0, () => chosen.name);
    box.append(animationControls(timeline, [animation], chosen), instantLine(timeline, 0), ...failureNote(run), ...whyNoAnimation(run));
  } else {
    side.style.gridColumn = "1 / -1";
    if (run.shown.note) top.append(element("div", {class: "card", style: "grid-column: 1 / -1"}, ...whyNoAnimation(run)));
  }
  top.append(side);
  const notes = plots(timeline, side, grid);
  side.append(axisControls(timeline));
  if (run.cells && run.outlines) notes.push("In the animation a colour is an aggregate, named after its first cell; in the charts it is a cell.");
  notes.push("Point at a chart to go to that instant, drag across it to look closer, click a name to hide its line.");
  for (const text of [...notesOf(run), ...notes]) page.append(note(text));
}
