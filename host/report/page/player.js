// ------------------------------------------------------------------------------------------------- the animation's controls
const choice = (label, choices, now, change) => {
  const select = element("select", {"aria-label": label, onchange: () => change(select.value)}, ...choices.map(([value, text]) => element("option", {value}, text)));
  select.value = now;
  return element("label", {}, label, select);
};
const button = (text, onclick, more = {}) => element("button", {type: "button", onclick, ...more}, text);

/// Play, scrub and speed, what lies under the cells and how these are coloured, for all animations of the page.
function animationControls(timeline, animations, view, strip = [], spaces = []) {
  const slider = element("input", {type: "range", min: 0, max: Math.max(0, timeline.count - 1), value: 0, "aria-label": "Instant", oninput: () => { timeline.stop(); timeline.seek(Number(slider.value)); }});
  const speedBox = choice("Speed", [["0.25", "¼×"], ["0.5", "½×"], ["1", "1×"], ["2", "2×"], ["4", "4×"]], "1", () => {}), speed = speedBox.querySelector("select");
  const toggle = () => timeline.playing ? timeline.stop() : timeline.play(() => Number(speed.value)), play = button("Play", toggle, {title: "space"});
  timeline.changed = () => { play.textContent = timeline.playing ? "Pause" : "Play"; };
  timeline.listeners.push(() => {
    slider.max = Math.max(0, timeline.count - 1);
    slider.value = timeline.nearest;
    slider.setAttribute("aria-valuetext", timeline.words);
  });
  const first = element("div", {class: "controls"}, play, element("div", {class: "track"}, slider, ...strip), speedBox), second = element("div", {class: "controls"});
  const colours = [...new Map(animations.flatMap(a => Object.entries(a.colours)).map(([name, {title}]) => [name, title]))];
  if (colours.length) {
    const box = choice("Cells by", colours, view.colour, name => { view.colour = name; view.changed(); });
    view.listeners.push(() => { box.querySelector("select").value = view.colour; });
    second.append(box);
  }
  const names = [...new Set(animations.flatMap(a => a.data.fields ? a.data.fields.quantities.map(q => q.name) : []))];
  if (names.length) second.append(choice("Flow", [["", "none"], ...names.map(name => [name, fieldTitles[name]])], view.field, name => view.setField(name)));
  if (animations.some(a => a.fields?.moves)) {
    const box = element("input", {type: "checkbox", onchange: () => { view.tracers = box.checked; view.changed(); }});
    box.checked = view.tracers;
    second.append(element("label", {}, box, "Tracers"));
  }
  const each = act => () => { for (const one of spaces.length ? spaces.slice(0, 1) : animations) act(one); };  // boxes in space turn together
  second.append(element("span", {class: "group"}, button("−", each(a => a.zoomBy(1 / 1.5)), {"aria-label": "zoom out"}), button("+", each(a => a.zoomBy(1.5)), {"aria-label": "zoom in"}), button("Fit", each(a => a.showAll()))));
  if (animations.some(a => a.outlines?.count)) second.append(followControl(animations, view));
  const shown = spaces.length ? spaces : animations;
  second.append(saveMenu("Save", [["Picture, PNG", () => savePicture(shown)], ...(animations.length ? [[spaces.length ? "Section, SVG" : "Picture, SVG", () => saveSvg(animations)]] : []), ["Figure, PDF", () => saveFigures(shown, "pdf")], ["Figure, PNG", () => saveFigures(shown, "png")], ["Video", event => saveVideo(timeline, shown[0], event.currentTarget)]]),
    button("Copy link", event => copyLink(timeline, event.currentTarget), {title: "a link to this page at this instant"}));
  addEventListener("keydown", event => {
    if (event.target.closest("button, select, input, summary, a, textarea") || event.ctrlKey || event.metaKey || event.altKey) return;
    const act = {" ": toggle, ArrowRight: () => { timeline.stop(); timeline.seek(timeline.nearest + 1); }, ArrowLeft: () => { timeline.stop(); timeline.seek(timeline.nearest - 1); },
      "+": each(a => a.zoomBy(1.5)), "-": each(a => a.zoomBy(1 / 1.5)), "0": each(a => a.showAll())}[event.key];
    if (!act || (event.target.closest("[role=tab], .scatter, .map-bar") && event.key.startsWith("Arrow"))) return;
    act();
    event.preventDefault();
  });
  return [first, second];
}

/// Which cell is chosen, and whether the view goes with it.
function followControl(animations, view) {
  const most = Math.max(...animations.map(a => a.outlines?.count ?? 0)), box = element("input", {type: "checkbox", onchange: () => { view.follow = box.checked; if (view.follow && view.cell === null) view.cell = 0; view.changed(); }});
  const select = choice("Cell", [["", "none"], ...Array.from({length: most}, (_, i) => [String(i), String(cellNumber(animations[0].data, i))])], "", value => { view.cell = value === "" ? null : Number(value); view.follow &&= view.cell !== null; view.changed(); });
  view.listeners.push(() => { box.checked = view.follow; select.querySelector("select").value = view.cell === null ? "" : String(view.cell); });
  return element("span", {class: "group"}, select, element("label", {}, box, "Follow"));
}

// ------------------------------------------------------------------------------------------------- what can be taken along
const fileName = (what, ending) => `${(document.title.replace(/ – Rouleau$/, "") + " " + what).toLowerCase().replace(/[^\p{L}\p{N}]+/gu, "-").replace(/^-|-$/g, "").slice(0, 80)}.${ending}`;
function download(name, blob) {
  const link = element("a", {href: URL.createObjectURL(blob), download: name});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 10000);
}
function saveMenu(title, entries, about = "") {
  const menu = element("details", {class: "menu"}, element("summary", about ? {"aria-label": about} : {}, title), element("div", {}, ...entries.map(([text, act]) => button(text, event => { act(event); if (text !== "Video") menu.open = false; }))));
  menu.addEventListener("focusout", event => { if (event.relatedTarget && !menu.contains(event.relatedTarget)) menu.open = false; });
  return menu;
}
/// A copy of a canvas on the page's own ground, so that it can be read wherever it is put.
function onGround(canvas, head = "") {
  const fine = window.devicePixelRatio || 1, room = head ? 24 * fine : 0, copy = document.createElement("canvas"), context = copy.getContext("2d");
  copy.width = canvas.width; copy.height = canvas.height + room;
  context.fillStyle = css("--card"); context.fillRect(0, 0, copy.width, copy.height);
  context.fillStyle = css("--text"); context.font = `600 ${13 * fine}px system-ui, sans-serif`; context.fillText(head, 8 * fine, 17 * fine);
  context.drawImage(canvas, 0, room);
  return copy;
}
const savePng = (canvas, name, head) => onGround(canvas, head).toBlob(blob => download(name, blob), "image/png");
function savePicture(animations) {
  for (const a of animations) savePng(a.image, fileName(`${animations.length > 1 ? runNames[a.run] : ""} ${a.timeline.words}`, "png"));
}
function svgOf(animation) {
  const context = new SvgContext(animation.width, animation.height, css("--card"));
  animation.paint(context);
  return context.text();
}
function saveSvg(animations) {
  for (const a of animations) download(fileName(`${animations.length > 1 ? runNames[a.run] : ""} ${a.timeline.words}`, "svg"), new Blob([svgOf(a)], {type: "image/svg+xml"}));
}

/// What the browser records: MP4, or WebM where it has no MP4.
const videoTypes = [["video/mp4;codecs=avc1.640028", "mp4"], ["video/mp4;codecs=avc1.42E01E", "mp4"], ["video/mp4", "mp4"], ["video/webm;codecs=vp9", "webm"], ["video/webm", "webm"]];
/// Plays from `from` to `to` into a video: a promise of {blob, ending}, or of null where the browser records nothing.
async function recordVideo(timeline, animation, {from = 0, to = timeline.count - 1, speed = 1} = {}) {
  const found = typeof MediaRecorder === "undefined" ? null : videoTypes.find(([type]) => MediaRecorder.isTypeSupported(type));
  if (!found) return null;
  const film = document.createElement("canvas"), context = film.getContext("2d"), even = v => 2 * Math.ceil(v / 2), head = 28;
  const copy = () => {
    const fine = animation.canvas.width / animation.width;
    if (!film.width || film.width !== even(animation.canvas.width)) { film.width = even(animation.canvas.width); film.height = even(animation.canvas.height + head * fine); }
    context.fillStyle = css("--card"); context.fillRect(0, 0, film.width, film.height);
    context.fillStyle = css("--text"); context.font = `${14 * fine}px system-ui, sans-serif`;
    context.fillText(`${animation.stageAt(timeline.output(animation.run)).name}, ${timeline.words}`, 10 * fine, 19 * fine);
    context.drawImage(animation.image, 0, head * fine);
  };
  timeline.stop();
  timeline.seek(from);
  film.width = 0;
  copy();
  const recorder = new MediaRecorder(film.captureStream(60), {mimeType: found[0], videoBitsPerSecond: 6e6}), pieces = [];
  recorder.ondataavailable = event => { if (event.data.size) pieces.push(event.data); };
  const ended = new Promise(resolve => { recorder.onstop = resolve; });
  recorder.start();
  timeline.listeners.push(copy);
  await new Promise(resolve => {
    const watch = () => { if (timeline.position >= to || !timeline.playing) resolve(); else requestAnimationFrame(watch); };
    timeline.play(() => speed);
    requestAnimationFrame(watch);
  });
  timeline.stop();
  timeline.listeners.splice(timeline.listeners.indexOf(copy), 1);
  await new Promise(resolve => setTimeout(resolve, 120));  // the last picture
  recorder.stop();
  await ended;
  return {blob: new Blob(pieces, {type: found[0].split(";")[0]}), ending: found[1]};
}
async function saveVideo(timeline, animation, pressed) {
  const text = pressed.textContent;
  pressed.textContent = "Recording …"; pressed.disabled = true;
  const video = await recordVideo(timeline, animation);
  pressed.textContent = text; pressed.disabled = false;
  if (video) download(fileName("video", video.ending), video.blob); else pressed.textContent = "This browser records no video";
}

/// The part of a link after # that names the instant: "strain=9", or "time=2.1" where the strain rests.
function linkTo(timeline) {
  const run = timeline.runs[0], output = timeline.output(0), strain = stagesOf(run).findLast(s => s.from <= output)?.over === "strain";
  return strain ? `strain=${Number(run.strain[output].toPrecision(6))}` : `time=${Number(run.time_s[output].toPrecision(6))}`;
}
function copyLink(timeline, pressed) {
  history.replaceState(null, "", `#${linkTo(timeline)}`);
  const done = words => { pressed.textContent = words; setTimeout(() => { pressed.textContent = "Copy link"; }, 1500); };
  navigator.clipboard?.writeText(location.href).then(() => done("Copied"), () => done("In the address"));
  if (!navigator.clipboard) done("In the address");
}
/// Goes where the address says; whether it says so.
function followLink(timeline) {
  const [, name, value] = location.hash.match(/^#(strain|time)=([-+.\de]+)$/) ?? [];
  if (!name || !Number.isFinite(Number(value))) return false;
  timeline.stop();
  timeline.seekValue(name === "time" ? "time_s" : "strain", Number(value));
  return true;
}
