// ---------------------------------------------------------------------------------------------------- a figure for a paper
/// What the figure of a run shows, in sentences.
function captionOf(drawn) {
  const {data, timeline, run, view} = drawn, summary = data.summary ?? {}, output = timeline.output(run), cells = drawn.surfaces?.count ?? drawn.outlines?.count ?? 0, colour = drawn.colours[view.colour];
  const when = grows(data) ? `strain ${format(data.strain[output], 3)}, ${format(data.time_s[output], 3)} s` : `${format(data.time_s[output], 3)} s`, box = `${data.domain.size_um.map(l => format(l, 3)).join(" × ")} µm`, cut = drawn.cut?.axis ?? null;
  return [`${titleOf(data)}.`, `At ${when}${cells ? `; ${cells} ${cells === 1 ? "cell" : "cells"}` : ""} in a box of ${box}.`, colour?.scale ? `Colour: ${colour.title}.` : null,
    cut === null ? null : `Cut at ${"xyz"[cut]} = ${format(drawn.cut.share * drawn.shown[cut], 3)} µm.`, drawn.surfaces ? "In perspective; the bar is a length in the middle of the box." : null, `Computed with Rouleau ${programOf(summary)}.`].filter(Boolean).join(" ");
}
/// Words in lines no longer than `width`.
function wrapped(context, text, width) {
  const lines = [""];
  for (const word of text.split(" ")) { const longer = `${lines.at(-1)} ${word}`.trim(); if (context.measureText(longer).width > width && lines.at(-1)) lines.push(word); else lines[lines.length - 1] = longer; }
  return lines;
}
/// Draws what a box in space or an animation shows, with the bar of its colours and a caption, on white: into what `into(width, height)`
/// gives, a context; returns that.
function paintFigure(drawn, into) {
  const root = document.documentElement, before = {printing, paper: root.classList.contains("paper")}, isSpace = Boolean(drawn.renderer), width = isSpace ? 720 : drawn.width, high = isSpace ? Math.round(720 * drawn.height / drawn.width) : drawn.height;
  printing = true; root.classList.add("paper");
  try {
    const colour = drawn.colours[drawn.view.colour], scale = colour?.scale, room = scale ? 52 : 10, caption = captionOf(drawn), probe = document.createElement("canvas").getContext("2d");
    probe.font = "13px Helvetica, Arial, sans-serif";
    const lines = wrapped(probe, caption, width - 24), height = high + room + 18 * lines.length + 14, context = into(width, height);
    context.fillStyle = "#fff"; context.fillRect(0, 0, width, height);
    if (isSpace) { context.drawImage(drawn.picture(3 * width, 3 * high), 0, 0, width, high); drawn.paintSigns(context, width, high); } else { context.save(); drawn.paint(context); context.restore(); }
    context.fillStyle = "#000"; context.font = "12px Helvetica, Arial, sans-serif";
    if (scale) {
      const left = 12, long = Math.min(240, width - 24), top = high + 22, steps = 48;
      context.fillText(scale.title, left, top - 6);
      for (let i = 0; i < steps; ++i) { context.fillStyle = rampColour(scale.stops, (i + .5) / steps); context.fillRect(left + i / steps * long, top, long / steps + .3, 9); }
      context.fillStyle = "#000";
      scale.ends.forEach((text, i) => context.fillText(text, left + i / (scale.ends.length - 1) * (long - context.measureText(text).width), top + 22));
    }
    context.font = "13px Helvetica, Arial, sans-serif";
    lines.forEach((line, i) => context.fillText(line, 12, high + room + 16 + 18 * i));
    return context;
  } finally {
    printing = before.printing; root.classList.toggle("paper", before.paper);
    redrawAll();
  }
}
function figurePdf(drawn) { return paintFigure(drawn, (width, height) => new PdfContext(width, height)).bytes(captionOf(drawn)); }
function figureCanvas(drawn) {
  const canvas = document.createElement("canvas"), fine = 3;
  paintFigure(drawn, (width, height) => { canvas.width = fine * width; canvas.height = Math.round(fine * height); const context = canvas.getContext("2d"); context.scale(fine, fine); return context; });
  return canvas;
}
const figureName = (drawn, ending) => fileName(`${drawn.timeline.runs.length > 1 ? runNames[drawn.run] : ""} figure ${drawn.timeline.words}`, ending);
function saveFigures(list, kind) {
  for (const drawn of list) if (kind === "pdf") download(figureName(drawn, "pdf"), new Blob([figurePdf(drawn)], {type: "application/pdf"})); else figureCanvas(drawn).toBlob(blob => download(figureName(drawn, "png"), blob), "image/png");
}
