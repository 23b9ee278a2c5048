// ------------------------------------------------------------------------------------- what happened: stages, joins, breaks
const together = members => members.filter(m => m.length > 1);
const groupWords = members => members.map(m => m.join("+")).join(", ");
/// The first output at a time of summary.json or after it; -1: there is none. Times of the page have nine digits.
const outputAt = (run, time) => run.time_s.findIndex(t => t >= time * (1 - 1e-8));

/// Whether cells attract each other, so that those that are close are joined. A run without a summary does not say; one of an
/// earlier version says it by its wells.
const attracts = ({summary}) => summary?.contacts ? summary.contacts.attracting.length > 0
  : Boolean(summary) && (summary.wells?.some(well => typeof well.depth_J_m2 === "number" && !["wall", "self"].includes(well.between?.[1])) ?? true);
/// Whether so few columns are empty that the cell-free layers are no property of the box.
const layersAreThere = means => (means?.cell_free_layer_empty?.mean ?? 1) < .05;
/// The changes of who is joined: none where nothing attracts. Cells that only come close, or part, change no bond.
function joinHistory(run) {
  if (!attracts(run)) return [];
  const history = (run.summary.aggregate_history ?? []).map(h => h.joined ? {...h, members: h.joined, count: h.joined.length} : h).filter(h => Array.isArray(h.members));
  const what = h => JSON.stringify([h.members, h.through_image]);
  return history.filter((h, k) => k === 0 || h.met_images || what(h) !== what(history[k - 1]));
}

/// The changes of the aggregates without those that were undone within three outputs: cells at the edge of
/// output.aggregate_gap flicker. {count, members, time_s, strain} each, the first is how the run began.
function lastingHistory(run) {
  const history = joinHistory(run), key = h => JSON.stringify(h.members);
  const place = h => outputAt(run, h.time_s);
  for (let i = 1; i + 1 < history.length;) {
    if (key(history[i - 1]) === key(history[i + 1]) && place(history[i + 1]) - place(history[i]) <= 3) { history.splice(i, 2); i = Math.max(1, i - 1); } else ++i;
  }
  return history;
}

/// Events of a run in their order, {position, kind: stage | join | break, text}, at most `most` of aggregates: those that
/// moved most cells.
function eventsOf(run, most = 12) {
  if (!run.step.length) return [];
  const events = stagesOf(run).slice(1).map(stage => ({position: stage.from, kind: "stage", text: stage.name})), changes = [], history = lastingHistory(run);
  history.slice(1).forEach((now, i) => {
    const before = history[i], old = together(before.members), fresh = together(now.members), same = m => list => list.length === m.length && list.every(c => m.includes(c));
    // An aggregate that cells have left together with the domain has not broken.
    const there = new Set(now.members.flat()), stays = m => m.every(c => there.has(c)), rest = old.filter(m => !stays(m)).map(m => m.filter(c => there.has(c)));
    const made = fresh.filter(m => !old.some(same(m)) && !rest.some(same(m))), gone = old.filter(m => stays(m) && !fresh.some(same(m)));
    const kind = gone.length && made.length ? (now.count - there.size < before.count - before.members.flat().length ? "join" : "break") : made.length ? "join" : "break", position = outputAt(run, now.time_s);
    if (position < 0 || !(made.length || gone.length)) return;
    const few = run.cells && run.cells.types.length <= 8, size = Math.max(...(kind === "join" ? made : gone).map(m => m.length));
    const text = kind === "join" ? few ? `${groupWords(made)} joined` : `${size} cells joined` : few ? `${groupWords(gone)} broke` : `${size} cells broke up`;
    changes.push({position, kind, text, size});
  });
  const kept = [...changes].sort((a, b) => b.size - a.size || a.position - b.position).slice(0, most);
  return [...events, ...kept].sort((a, b) => a.position - b.position);
}

/// Where the story is told best: where the run went bad, or the first aggregate to break, or where the last joined, or the middle.
function tellingPosition(run, events) {
  if ((run.summary || {}).status === "diverged") return run.step.length - 1;
  const broke = events.find(e => e.kind === "break"), joined = events.findLast(e => e.kind === "join");
  return (broke ?? joined)?.position ?? Math.round(.6 * (run.step.length - 1));
}

/// A strip with the stages and the events of a run; a click jumps there.
function storyStrip(timeline, events) {
  const last = Math.max(1, timeline.count - 1), box = element("div", {class: "story", role: "group", "aria-label": "Stages and events"});
  for (const stage of timeline.stages)
    box.append(element("span", {class: "stage-part", style: `left:${100 * Math.max(0, stage.from - .5) / last}%;right:${100 - 100 * Math.min(last, stage.to + .5) / last}%`}, stage.name));
  const buttons = events.filter(e => e.kind !== "stage").map(event => element("button", {type: "button", class: event.kind, style: `left:${100 * event.position / last}%`,
    title: event.text, "aria-label": `go to: ${event.text}`, onclick: () => { timeline.stop(); timeline.seek(event.position); }}, element("span", {}, event.text)));
  box.append(...buttons);
  box.classList.toggle("short", !buttons.length);
  // Words that would lie over each other are left to the pointer.
  new ResizeObserver(() => {
    const ends = [-Infinity, -Infinity];
    for (const button of buttons) {
      const words = button.firstChild;
      words.hidden = false;
      const wide = words.offsetWidth, middle = parseFloat(button.style.left) / 100 * box.clientWidth;
      const left = Math.min(Math.max(middle - wide / 2, 0), box.clientWidth - wide), row = ends.findIndex(end => left > end + 8);
      words.hidden = row < 0;
      if (row < 0) continue;
      words.style.left = `${left - middle + 14}px`; words.style.top = `${16 + 16 * row}px`;
      ends[row] = left + wide;
    }
  }).observe(box);
  return box;
}
