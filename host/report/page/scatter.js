// --------------------------------------------- charts of single points, as SVG: what is a line stays a line on paper, and
// colours follow the style sheet. Texts and lengths are in pixels of the screen, so a chart is drawn anew for each width.
const corners = (n, turn, inner) => Array.from({length: inner ? 2 * n : n}, (_, i) => {
  const angle = turn + i * 2 * Math.PI / (inner ? 2 * n : n), r = inner && i % 2 ? inner : 1;
  return [r * Math.cos(angle), r * Math.sin(angle)];
});
/// Outlines of marks of about the same area; the first is a circle.
const marks = [corners(24, 0).map(c => c.map(v => v * .95)), corners(4, Math.PI / 4).map(c => c.map(v => v * 1.2)), corners(3, -Math.PI / 2).map(c => c.map(v => v * 1.4)),
  corners(4, 0).map(c => c.map(v => v * 1.35)), corners(3, Math.PI / 2).map(c => c.map(v => v * 1.4)), corners(5, -Math.PI / 2, .5).map(c => c.map(v => v * 1.45)),
  corners(6, 0).map(c => c.map(v => v * 1.1)), corners(4, 0, .45).map(c => c.map(v => v * 1.45))];
const markPath = (shape, x, y, r = 4.6) => "M" + marks[shape % marks.length].map(([a, b]) => `${(x + r * a).toFixed(1)} ${(y + r * b).toFixed(1)}`).join("L") + "Z";
const crossPath = (x, y, r = 4) => `M${x - r} ${y - r}L${x + r} ${y + r}M${x - r} ${y + r}L${x + r} ${y - r}`;

/// A chart whose `content()` says what it holds now (null: nothing):
///   x, y     {title, values, ticks, names}: logarithmic over the values; with `ticks` [{value, text}] these; with
///            `names` evenly spaced, and values are their numbers
///   lines    [{id, tone, shape, dash, faded, points: [{id, x, y, low, high}]}]; null in place of a point breaks the line,
///            low and high are the ends of its range along x; y = 0 is drawn at the lower border
///   failed   [{id, x (null: unknown), tone, unknown (no value rather than no end)}]: at the upper border
///   front, slopes [{from, to, text}], levels [{y, text}], band {y, text} (what lies below means nothing), rings {id: text}
/// `describe(id)` gives what is told of a point, `chosen(id)` is called when one is clicked.
class ScatterChart {
  constructor(parent, {title, note, describe, chosen, height = 380, content}) {
    Object.assign(this, {describe, chosen, height, content, spots: [], at: null});
    this.heading = element("h3", {});
    this.plot = element("div", {class: "plot scatter", tabindex: 0, role: "group", "aria-label": `${title}; arrow keys go from point to point, Enter chooses one`});
    this.tip = element("div", {class: "tip", role: "status", hidden: ""});
    this.note = element("p", {class: "quiet", hidden: ""});
    parent.append(element("div", {class: "card chart"}, this.heading, this.plot, this.note));
    this.name = `scatter-${ScatterChart.all.length}`;
    ScatterChart.all.push(this);
    this.plot.addEventListener("pointermove", e => this.point(e, e.pointerType === "mouse" ? 30 : 44));
    this.plot.addEventListener("pointerdown", e => this.point(e, 44));
    this.plot.addEventListener("pointerleave", e => { if (e.pointerType === "mouse") this.show(null); });
    this.plot.addEventListener("click", () => { if (this.at !== null) this.chosen?.(this.at); });
    this.plot.addEventListener("keydown", e => this.key(e));
    this.plot.addEventListener("blur", () => this.show(null));
    new ResizeObserver(() => { if (!printing && this.plot.clientWidth !== this.width) this.draw(); }).observe(this.plot);
    redraws.push(() => this.draw());
    this.draw();
  }

  draw() {
    const content = this.content(), width = this.width = printing ? 660 : Math.max(240, this.plot.clientWidth), base = printing ? 320 : this.height;
    this.spots = []; this.at = null; this.tip.hidden = true;
    this.heading.textContent = content?.title ?? "";
    this.note.textContent = content?.note ?? ""; this.note.hidden = !content?.note;
    this.plot.hidden = !content?.lines;
    if (!content?.lines) return this.plot.replaceChildren();
    const box = this.box = {left: 52, right: width - (content.levels?.length ? 40 : 14)};
    this.x = this.axis(content.x, box.left, box.right, 90);
    const rows = this.stack(content.failed), height = base + Math.max(0, 15 * (rows - 1));
    box.top = rows ? 15 + 15 * rows : 10;
    box.bottom = height - 40;
    this.y = this.axis(content.y, box.bottom, box.top, 60);
    this.crowded = content.lines.reduce((sum, line) => sum + line.points.length, 0) > 120;
    this.ring = element("circle", {r: 10, class: "at", visibility: "hidden"});
    const clip = element("clipPath", {id: this.name}, element("rect", {x: box.left, y: box.top, width: box.right - box.left, height: box.bottom - box.top}));
    this.svg = element("svg", {viewBox: `0 0 ${width} ${height}`, "aria-hidden": "true"}, element("defs", {}, clip),
      ...this.drawAxes(content, width, height), ...this.drawUnder(content), ...content.lines.map(line => this.drawLine(line)), ...this.drawFailed(),
      ...this.drawRings(content.rings ?? {}), this.ring);
    this.plot.replaceChildren(this.svg, this.tip);
  }
  axis({values, names, ticks}, from, to, apart) {
    if (names) return namedAxis(names, from, to);
    const axis = logAxis(values.length ? values : [1], from, to, {apart});
    if (!ticks) return axis;
    let last = -Infinity;  // of named ticks those that find room
    const shown = ticks.filter(t => { const x = axis.at(t.value), fits = x - last > 12 + 3.4 * t.text.length; if (fits) last = x + 3.4 * t.text.length; return fits; });
    return {...axis, ticks: shown, fine: []};
  }

  drawAxes({x, y, failed}, width, height) {
    const {box} = this, drawn = [], line = (x1, y1, x2, y2, name) => drawn.push(element("path", {d: `M${x1} ${y1}L${x2} ${y2}`, class: name}));
    for (const v of this.x.fine) line(this.x.at(v), box.top, this.x.at(v), box.bottom, "fine");
    for (const v of this.y.fine) line(box.left, this.y.at(v), box.right, this.y.at(v), "fine");
    for (const {value, text} of this.x.ticks) {
      line(this.x.at(value), box.top, this.x.at(value), box.bottom, "grid");
      drawn.push(element("text", {x: this.x.at(value), y: box.bottom + 16, "text-anchor": "middle"}, text));
    }
    for (const {value, text} of this.y.ticks) {
      line(box.left, this.y.at(value), box.right, this.y.at(value), "grid");
      drawn.push(element("text", {x: box.left - 6, y: this.y.at(value) + 4, "text-anchor": "end"}, text));
    }
    if (failed.length) {
      drawn.push(element("rect", {x: box.left, y: 2, width: box.right - box.left, height: box.top - 4, class: "strip"}),
        element("text", {x: box.left - 6, y: 15, "text-anchor": "end"}, "failed"));
    }
    drawn.push(element("path", {d: `M${box.left} ${box.top}V${box.bottom}H${box.right}`, class: "axis"}),
      element("text", {x: box.right, y: height - 6, "text-anchor": "end", class: "title"}, x.title));
    return drawn;
  }

  drawUnder({band, levels = [], slopes = [], front = []}) {
    const {box} = this, drawn = [], clip = `url(#${this.name})`, y = v => this.y.at(v), inside = v => v > this.y.low && v < this.y.high;
    if (band && band.y > this.y.low) {
      const top = Math.max(box.top, y(band.y));
      drawn.push(element("rect", {x: box.left, y: top, width: box.right - box.left, height: box.bottom - top, class: "band"}),
        element("text", {x: box.left + 6, y: Math.min(top + 14, box.bottom - 4), class: "halo"}, band.text));
    }
    for (const level of levels) if (inside(level.y)) drawn.push(element("path", {d: `M${box.left} ${y(level.y)}H${box.right}`, class: "level"}),
      element("text", {x: box.right + 4, y: y(level.y) + 4}, level.text));
    for (const slope of slopes) {
      const [[x0, y0], [x1, y1]] = [slope.from, slope.to].map(p => [this.x.at(p.x), y(p.y)]);
      const share = Math.min(.97, ...[box.top, box.bottom].map(edge => (edge - y0) / (y1 - y0)).filter(s => s > 0));  // the text stands where the line leaves
      const end = [x0 + share * (x1 - x0), y0 + share * (y1 - y0)];
      drawn.push(element("path", {d: pathThrough([[x0, y0], [x1, y1]]), class: "slope", "clip-path": clip}),
        element("text", {x: end[0], y: Math.min(box.bottom - 4, end[1] - 4), "text-anchor": x1 > x0 ? "end" : "start", class: "halo"}, slope.text));
    }
    if (front.length) {  // what is to be had for a time: the best of all that are cheaper
      const steps = front.flatMap((p, i) => [[this.x.at(p.x), i ? y(front[i - 1].y) : box.top], [this.x.at(p.x), p.y > 0 ? y(p.y) : box.bottom]]);
      drawn.push(element("path", {d: pathThrough([...steps, [box.right, steps.at(-1)[1]]]), class: "front", "clip-path": clip}));
    }
    return drawn;
  }

  drawLine(line) {
    const {box} = this, small = this.crowded, group = element("g", {class: "line" + (line.faded ? " faded" : ""), "data-line": line.id, style: `color:var(${line.tone})`});
    let run = [];
    const flush = () => { if (run.length > 1) group.append(element("path", {d: pathThrough(run), class: "through", ...(line.dash ? {"stroke-dasharray": line.dash} : {})})); run = []; };
    const points = line.points.map(p => p && {...p, px: this.x.at(p.x), py: p.y > 0 ? this.y.at(p.y) : box.bottom});
    for (const p of points) if (p) run.push([p.px, p.py]); else flush();
    flush();
    for (const p of points) if (p) {
      if (p.high > p.low) {
        const [a, b] = [this.x.at(p.low), this.x.at(p.high)];
        group.append(element("path", {d: `M${a} ${p.py}H${b}M${a} ${p.py - 3}V${p.py + 3}M${b} ${p.py - 3}V${p.py + 3}`, class: "whisker"}));
      }
      group.append(element("path", {d: markPath(line.shape, p.px, p.py, small ? 3.4 : 4.6), class: p.y > 0 ? "mark" : "mark open", "data-point": p.id}));
      this.spots.push({id: p.id, x: p.px, y: p.py});
    }
    return group;
  }

  /// Gives failed points that would lie over each other rows of their own; returns how many there are.
  stack(failed) {
    const {left, right} = this.box, ends = [];
    const placed = failed.map(f => ({...f, px: f.x === null ? left + 7 : Math.min(Math.max(this.x.at(f.x), left + 7), right - 7)}));
    this.failed = placed.sort((a, b) => a.px - b.px);
    for (const f of placed) {
      let row = ends.findIndex(end => f.px - end > 11);
      if (row < 0) row = ends.length < 5 ? ends.push(-Infinity) - 1 : 4;
      ends[row] = f.px;
      f.row = row;
    }
    return ends.length;
  }
  drawFailed() {
    return this.failed.map(f => {
      const [x, y] = [f.px, 11 + 15 * f.row];
      this.spots.push({id: f.id, x, y});
      return f.unknown ? element("text", {x, y: y + 5, "text-anchor": "middle", class: "unknown", style: `color:var(${f.tone})`, "data-point": f.id}, "?")
        : element("path", {d: crossPath(x, y), class: "cross", style: `color:var(${f.tone})`, "data-point": f.id});
    });
  }
  drawRings(rings) {
    return Object.entries(rings).flatMap(([id, text]) => {
      const spot = this.spots.find(s => String(s.id) === id);
      if (!spot) return [];
      const wide = 7 * text.length, [near, far] = [spot.x + 12, spot.x - 12];
      const [x, y, anchor] = near + wide < this.width ? [near, spot.y - 8, "start"] : far > wide ? [far, spot.y + 15, "end"] : [this.width, spot.y - 13, "end"];
      return [element("circle", {cx: spot.x, cy: spot.y, r: 8, class: text ? "ring" : "ring chosen"}), element("text", {x, y, "text-anchor": anchor, class: "halo strong"}, text)];
    });
  }

  point(event, reach) {
    const frame = this.svg?.getBoundingClientRect();
    if (!frame) return;
    const scale = this.width / frame.width, x = (event.clientX - frame.left) * scale, y = (event.clientY - frame.top) * scale;
    let best = null, least = reach;
    for (const spot of this.spots) { const far = Math.hypot(spot.x - x, spot.y - y); if (far < least) { least = far; best = spot; } }
    this.show(best?.id ?? null);
  }
  key(event) {
    const step = {ArrowRight: 1, ArrowDown: 1, ArrowLeft: -1, ArrowUp: -1}[event.key];
    if (step) {
      const order = [...this.spots].sort((a, b) => a.x - b.x || a.y - b.y), now = order.findIndex(s => s.id === this.at);
      if (order.length) this.show(order[(now + step + order.length) % order.length].id);
    } else if (event.key === "Enter" && this.at !== null) this.chosen?.(this.at);
    else if (event.key === "Escape") this.show(null);
    else return;
    event.preventDefault();
  }
  /// Tells of a point, here in words and in the other charts with a ring; of none with null.
  show(id) {
    if (id === this.at) return;
    this.at = id;
    for (const chart of ScatterChart.all) chart.mark(id);
    this.tip.hidden = id === null;
    if (id === null) return;
    this.tip.replaceChildren(...this.describe(id));
    const spot = this.spots.find(s => s.id === id), scale = this.plot.clientWidth / this.width;
    placeTip(this.tip, this.plot, spot.x * scale, spot.y * scale);
  }
  mark(id) {
    const spot = this.spots.find(s => s.id === id);
    this.ring?.setAttribute("visibility", spot ? "visible" : "hidden");
    if (spot) { this.ring.setAttribute("cx", spot.x); this.ring.setAttribute("cy", spot.y); }
  }
}
ScatterChart.all = [];

/// The mark and line of a legend.
const swatch = ({tone, shape, dash}) => element("svg", {width: 26, height: 12, "aria-hidden": "true", style: `color:var(${tone})`},
  element("path", {d: "M0 6H26", class: "through", ...(dash ? {"stroke-dasharray": dash} : {})}), element("path", {d: markPath(shape, 13, 6, 4), class: "mark"}));
