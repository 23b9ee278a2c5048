// ---------------------------------------------------------------------------------------------------------- animation
/// What all animations of a page share: what lies under the cells, their colours, and the cell that was chosen.
class View {
  constructor(runs) {
    const names = new Set(runs.flatMap(run => Object.keys(cellColours(run))));
    const wanted = names.has("blood") ? [names.has("cell") ? "blood" : "tension"] : ["aggregate", "cell"];
    Object.assign(this, {field: "", tracers: true, cell: null, hovered: null, follow: false, listeners: [], turned: [], camera: null, colour: wanted.find(name => names.has(name)) ?? "grey", before: null});
  }
  changed() { for (const listener of this.listeners) listener(); }
  /// All boxes of a page are seen from one side.
  turn() { for (const listener of this.turned) listener(); }
  /// Cells are grey over a field, and get their colours back without one.
  setField(name) {
    if (name && !this.field) { this.before = this.colour; this.colour = "grey"; }
    if (!name && this.field && this.colour === "grey" && this.before) this.colour = this.before;
    this.field = name;
    this.changed();
  }
  /// The cell under the pointer; charts lift it while none is chosen.
  hover(cell) { if (cell !== this.hovered) { this.hovered = cell; this.changed(); } }
  get lifted() { return this.cell ?? this.hovered; }
  choose(cell) { this.cell = cell === this.cell ? null : cell; this.follow &&= this.cell !== null; this.changed(); }
}

/// A round length in um, at most `most`.
const barLength = most => [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].filter(b => b <= most).pop() || most;

/// The lower and the upper wall, {speed, gone}: um/s along x, and um since the run began; of an animation or a box in space. Speeds are
/// from the fields where there are some, else of walls that move against each other.
function wallMotion(view) {
  const {data, timeline, run, fields, ly} = view, output = timeline.output(run), rate = data.shear_rate?.[output] ?? null, still = {speed: 0, gone: 0};
  if (rate === null) return [still, still];
  const flow = fields?.moves ? fields.between(view.between) : null, isOfStage = flow && data.stage[fields.fields.outputs[flow.a]] === data.stage[output];
  const middle = isOfStage ? meanOfWalls(fields.velocity(flow), data.domain.size_um, Math.abs(rate)) : 0, {a, b, share} = view.between, between = name => (data[name][a] ?? 0) + share * ((data[name][b] ?? 0) - (data[name][a] ?? 0));
  return [-1, 1].map(side => ({speed: middle + side * rate * ly / 2, gone: middle ? (middle + side * rate * ly / 2) * between("time_s") : side * Math.sign(rate) * between("strain") * ly / 2}));
}
function meanOfWalls(velocity, [lx, ly], rate) {
  const few = 16, mean = y => Array.from({length: few}, (_, i) => velocity((i + .5) / few * lx, y)?.[0] ?? 0).reduce((a, b) => a + b) / few, speed = (mean(ly * .001) + mean(ly * .999)) / 2;
  return Math.abs(speed) > .05 * rate * ly ? speed : 0;
}
/// Where the fluid is driven along x: 1 or -1, else 0.
const drivenAlong = run => Math.sign((run.summary?.rheology ?? []).map(stage => stage.means?.mean_velocity_m_per_s?.mean).findLast(Number.isFinite) ?? 0);

/// The cells of a run at the timeline's instant, with the flow under them. Drag to move it; + and -, or two fingers, to come
/// closer.
class Animation {
  constructor(parent, timeline, run, view, section = null) {
    const data = timeline.runs[run];
    Object.assign(this, {timeline, run, data, view, section, outlines: section ?? (data.outlines && new Outlines(data.outlines)), fields: data.fields && new Fields(data), colours: cellColours(data, timeline.runs), stages: stagesOf(data), zoom: 1});
    [this.lx, this.ly] = data.domain.size_um;
    this.centre = [this.lx / 2, this.ly / 2];
    this.walls = !data.domain.periodic[1];
    this.open = !data.domain.periodic[0];  // between openings
    this.canvas = element("canvas", {class: "view", role: "img", tabindex: 0, "aria-label": this.description()});
    this.tip = element("div", {class: "tip", role: "status", hidden: ""});
    this.bar = element("div", {class: "bar"});
    this.cellBar = element("div", {class: "bar cells"});
    parent.append(element("div", {class: "view-box"}, this.canvas, this.tip), element("div", {class: "bars"}, ...(isInSpace(data) ? [] : [this.cellBar]), this.bar));
    timeline.listeners.push(() => this.draw());
    view.listeners.push(() => { this.showBars(); this.draw(); });
    new ResizeObserver(() => { if (this.canvas.clientWidth !== this.width) this.draw(); }).observe(this.canvas);
    this.listen();
    this.showBars();
  }
  description() {
    const {data} = this, cells = this.outlines?.count ?? 0;
    return `Animation: ${cells ? `${this.section ? "a section through" : "outlines of"} ${cells} ${cells === 1 ? "cell" : "cells"}${hasTraffic(data) ? ", which come and leave" : ""}` : "the flow"} in a box of ${format(this.lx, 3)} by ${format(this.ly, 3)} µm. Space plays, arrow keys step, plus and minus or two fingers zoom.`;
  }
  showBars() { this.cellBar.replaceChildren(...(this.colours[this.view.colour] ?? this.colours.grey)?.bar() ?? []); }

  // ---- what is where
  get image() { return this.canvas; }
  stageAt(output) { return this.stages.findLast(stage => stage.from <= output); }
  get between() { return this.timeline.between(this.run); }
  shapes(withTension = false) { return this.outlines.shapes(this.between, withTension); }
  /// Of the longest line of a cell.
  centreOf(shapes, cell) {
    const {xy} = shapes[cell].reduce((best, line) => line.xy.length > best.xy.length ? line : best), sum = [0, 0];
    for (let i = 0; i < xy.length; ++i) sum[i % 2] += xy[i];
    return sum.map(s => 2 * s / xy.length);
  }
  /// The cell at a point of the canvas, or null.
  cellAt(px, py) {
    if (!this.outlines || !this.scale) return null;
    const shapes = this.shapes(), [x, y] = this.toDomain(px, py);
    for (let cell = this.outlines.count - 1; cell >= 0; --cell) {
      if (!shapes[cell].length) continue;
      const [cx, cy] = this.centreOf(shapes, cell), near = (v, middle, length) => v - length * Math.round((v - middle) / length);
      const qx = this.open ? x : near(x, cx, this.lx), qy = this.walls ? y : near(y, cy, this.ly);
      let inside = false;
      for (const {xy} of shapes[cell]) for (let i = 0, j = xy.length - 2; i < xy.length; j = i, i += 2) {
        const [ax, ay, bx, by] = [xy[i], xy[i + 1], xy[j], xy[j + 1]];
        if ((ay > qy) !== (by > qy) && qx < (bx - ax) * (qy - ay) / (by - ay) + ax) inside = !inside;
      }
      if (inside) return cell;
    }
    return null;
  }
  toDomain(px, py) { return [this.middle[0] + (px - this.width / 2) / this.scale, this.middle[1] - (py - this.height / 2) / this.scale]; }

  // ---- pointers and keys
  listen() {
    const {canvas} = this;
    let drag = null;
    const at = event => { const box = canvas.getBoundingClientRect(); return [event.clientX - box.left, event.clientY - box.top]; };
    canvas.addEventListener("pointerdown", event => { drag = {from: at(event), centre: [...this.centre], moved: false, id: event.pointerId}; });
    canvas.addEventListener("pointermove", event => {
      const now = at(event);
      if (drag && event.buttons && (event.pointerType === "mouse" || this.zoom > 1)) {
        const [dx, dy] = now.map((v, i) => v - drag.from[i]);
        if (!drag.moved && Math.hypot(dx, dy) < 5) return;
        if (!drag.moved) canvas.setPointerCapture(drag.id);
        drag.moved = true;
        this.centre = [drag.centre[0] - dx / this.scale, this.walls && this.zoom === 1 ? this.ly / 2 : drag.centre[1] + dy / this.scale];
        this.view.follow = false;
        this.tip.hidden = true;
        this.view.changed();
        return;
      }
      if (event.pointerType === "mouse") this.tell(this.cellAt(...now), now);
    });
    canvas.addEventListener("pointerup", event => {
      if (drag && !drag.moved) { const cell = this.cellAt(...at(event)); if (cell !== null || this.view.cell !== null) this.view.choose(cell); this.tell(event.pointerType === "mouse" || this.view.cell !== null ? cell : null, at(event)); }
      drag = null;
    });
    canvas.addEventListener("pointerleave", event => { if (event.pointerType === "mouse") this.tell(null); });
    this.listenToFingers(at, () => { drag = null; });
    canvas.addEventListener("wheel", event => { if (event.ctrlKey || event.metaKey) { event.preventDefault(); this.zoomBy(event.deltaY < 0 ? 1.15 : 1 / 1.15, at(event)); } }, {passive: false});
  }
  /// Two fingers: what lay between them stays between them. `begin` is called when the second one moves.
  listenToFingers(at, begin) {
    const {canvas} = this;
    let before = null;
    canvas.addEventListener("touchmove", event => {
      if (event.touches.length !== 2) return;
      event.preventDefault();  // or the page would scroll
      begin();
      const [a, b] = [...event.touches].map(at), now = {apart: Math.max(1, Math.hypot(a[0] - b[0], a[1] - b[1])), middle: [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2]};
      this.view.follow = false;
      if (before) this.zoomBy(now.apart / before.apart, before.middle, now.middle);
      before = now;
    }, {passive: false});
    for (const kind of ["touchstart", "touchend", "touchcancel"]) canvas.addEventListener(kind, () => { before = null; });
  }
  /// Comes closer by a factor, to what lies at a point of the canvas; it goes to the point `to`.
  zoomBy(factor, at = [this.width / 2, this.height / 2], to = at) {
    const before = this.toDomain(...at), zoom = Math.min(40, Math.max(1, this.zoom * factor)), scale = this.scale * zoom / this.zoom;
    this.zoom = zoom;
    this.centre = [before[0] - (to[0] - this.width / 2) / scale, before[1] + (to[1] - this.height / 2) / scale];
    if (zoom === 1) this.centre[1] = this.ly / 2;
    this.canvas.style.touchAction = zoom > 1 ? "none" : "";
    this.draw();
  }
  showAll() { this.zoom = 1; this.centre = [this.lx / 2, this.ly / 2]; this.view.follow = false; this.canvas.style.touchAction = ""; this.view.changed(); }

  /// Words about a cell beside the pointer.
  tell(cell, at) {
    this.canvas.style.cursor = cell === null ? "" : "pointer";
    this.view.hover(cell);
    this.tip.hidden = cell === null;
    if (cell === null) return;
    const {cells} = this.data, output = this.timeline.output(this.run), value = (name, unit, digits = 3) => typeof cells?.[name]?.[cell]?.[output] === "number" ? `${format(cells[name][cell][output], digits)}${unit}` : null;
    const size = cells ? cells.aggregate[output].filter(label => label === cells.aggregate[output][cell]).length : 1;
    const rows = [attracts(this.data) ? ["aggregate", cells && (size > 1 ? `of ${size} cells` : "none")] : ["group of close cells", cells && size > 1 ? `${size} cells` : null], ["gap", value("min_gap_um", " µm")], ["gap to a wall", value("wall_gap_um", " µm")], ["deformation", value("deformation", "")],
      ["angle", value("angle_deg", "°")], ["speed", value("speed_um_per_s", " µm/s")]].filter(([, text]) => text);
    this.tip.replaceChildren(element("p", {class: "name"}, element("b", {}, `cell ${cellNumber(this.data, cell)}`), cells ? `, ${cells.types[cell]}` : ""),
      element("dl", {}, ...rows.flatMap(([name, text]) => [element("dt", {}, name), element("dd", {}, text)])));
    placeTip(this.tip, this.canvas, ...at);
  }

  // ---- drawing
  draw() {
    const {canvas, lx, ly} = this, fine = printing ? 3 : window.devicePixelRatio || 1, margin = {x: 7, y: this.walls ? 20 : 7};
    const width = this.width = canvas.clientWidth || 340, most = Math.max(240, this.section ? Math.min(420, innerHeight * .6) : innerHeight * .68);
    this.whole = Math.min((width - 2 * margin.x) / lx, (most - 2 * margin.y) / ly);
    this.height = ly * this.whole + 2 * margin.y;
    canvas.width = Math.round(width * fine); canvas.height = Math.round(this.height * fine);
    canvas.style.height = `${this.height}px`;
    const context = canvas.getContext("2d");
    context.setTransform(fine, 0, 0, fine, 0, 0);
    this.paint(context);
  }

  /// Draws the instant into a context of `width` by `height` pixels: that of the canvas, or one that writes SVG.
  paint(context) {
    const {lx, ly, width, height, view} = this, shapes = this.outlines && this.shapes(Boolean(this.colour?.tension)), scale = this.scale = this.whole * this.zoom;
    context.clearRect(0, 0, width, height);
    const followed = view.follow && view.cell !== null && shapes && this.outlines.has(shapes, view.cell) ? this.centreOf(shapes, view.cell) : null;
    this.middle = followed && this.walls && this.zoom === 1 ? [followed[0], ly / 2] : followed ?? this.centre;
    const [cx, cy] = this.middle, half = [width / scale / 2, height / scale / 2];
    // One period at most, and what of it the canvas shows.
    const clip = {left: Math.max(this.open ? 0 : cx - lx / 2, cx - half[0]), right: Math.min(this.open ? lx : cx + lx / 2, cx + half[0]), bottom: this.walls ? 0 : Math.max(cy - ly / 2, cy - half[1]), top: this.walls ? ly : Math.min(cy + ly / 2, cy + half[1])};
    context.save();
    context.translate(width / 2 - cx * scale, height / 2 + cy * scale); context.scale(1, -1);  // y upwards
    context.save();
    context.beginPath(); context.rect(clip.left * scale, clip.bottom * scale, (clip.right - clip.left) * scale, (clip.top - clip.bottom) * scale); context.clip();
    const images = (low, high, length, from, to) => { const list = []; for (let k = Math.ceil((from - high) / length); k <= Math.floor((to - low) / length); ++k) list.push(k * length); return list; };
    const acrossX = (low, high) => this.open ? [0] : images(low, high, lx, clip.left, clip.right), acrossY = (low, high) => this.walls ? [0] : images(low, high, ly, clip.bottom, clip.top);
    const flow = this.fields?.between(this.between) ?? null, under = this.paintField(context, flow, scale, acrossX, acrossY);
    if (flow && view.tracers && this.fields.moves && this.hasFlow) this.paintTracers(context, flow, scale, acrossX);
    if (this.data.walls && (!this.section || this.section.isMiddle)) this.paintSolid(context, scale, acrossX, acrossY);
    else if (this.data.walls) this.paintWallLines(context, scale, acrossX, acrossY);
    if (shapes) this.paintCells(context, shapes, scale, under, acrossX, acrossY);
    if (this.failed()) this.paintFailure(context, scale, acrossX);
    context.restore();
    this.paintFrame(context, scale, clip);
    context.restore();
    this.paintScale(context, scale);
  }

  paintField(context, flow, scale, acrossX, acrossY) {
    this.bar.replaceChildren();
    const quantity = this.fields?.quantity(this.view.field);
    if (!quantity) return false;
    if (!this.hasFlow) { this.bar.replaceChildren(note(`The flow was kept at z = ${format(this.fields.fields.z_um, 3)} µm.`)); return false; }
    if (!flow) { this.bar.replaceChildren(...colourBar(quantity, "none written yet")); return false; }
    const {outputs, box_um: [x, y, w, h]} = this.fields.fields, strain = this.timeline.over !== "time_s" && grows(this.data);
    const name = i => strain && this.stageAt(outputs[i]).over === "strain" ? `strain ${format(this.data.strain[outputs[i]], 3)}` : `${format(this.data.time_s[outputs[i]], 4)} s`;
    const words = flow.share > 0 && flow.share < 1 ? `between what was written at ${name(flow.a)} and ${name(flow.b)}`
      : outputs[flow.share ? flow.b : flow.a] === this.timeline.output(this.run) ? "" : `of ${name(flow.a)}, the last written`;
    context.imageSmoothingEnabled = true;
    for (const dx of acrossX(x, x + w)) for (const dy of acrossY(y, y + h)) for (const [index, alpha] of [[flow.a, 1], [flow.b, flow.share]]) if (alpha > 0) {
      context.globalAlpha = alpha;
      context.drawImage(this.fields.picture(quantity.name, index), (x + dx) * scale, (y + dy) * scale, w * scale, h * scale);
    }
    context.globalAlpha = 1;
    this.bar.replaceChildren(...colourBar(quantity, words));
    return true;
  }

  /// Whether the flow of the page is that of the section.
  get hasFlow() { const z = this.fields?.fields.z_um; return !this.section || z === undefined || Math.abs(z - this.section.z) < .03 * this.section.length; }
  paintTracers(context, flow, scale, acrossX) {
    const {data, timeline} = this, output = timeline.output(this.run), stage = this.stageAt(output), life = Math.max(6, timeline.count / 14);
    const from = Math.max(0, stage.from - 1), each = (data.time_s[stage.to] - data.time_s[from]) / Math.max(1, stage.to - from);  // s for each output
    context.strokeStyle = css("--tracer");
    drawTracers(context, this.fields.velocity(flow), {position: timeline.position, life, seconds: Math.min(life * each, 1e9), box: this.fields.fields.box_um, scale, shift: x => acrossX(x - 3, x + 3),
      number: Math.min(300, Math.round(this.width * this.height / 2200))});
  }

  get colour() { return this.colours[this.view.colour] ?? this.colours.grey; }
  paintCells(context, shapes, scale, under, acrossX, acrossY) {
    const {colour, view, between} = this;
    shapes.forEach((lines, cell) => { for (const {xy, tension: tensions} of lines) {
      let [left, right, low, high] = [Infinity, -Infinity, Infinity, -Infinity];
      for (let i = 0; i < xy.length; i += 2) { left = Math.min(left, xy[i]); right = Math.max(right, xy[i]); low = Math.min(low, xy[i + 1]); high = Math.max(high, xy[i + 1]); }
      const tone = colour.colour ? colour.colour(cell, between) : css(colour.tone(cell, between)), bad = this.failed() && this.data.summary.failure.cell === cellNumber(this.data, cell), chosen = view.cell === cell;
      for (const dx of acrossX(left, right)) for (const dy of acrossY(low, high)) {
        context.beginPath();
        for (let i = 0; i < xy.length; i += 2) context.lineTo((xy[i] + dx) * scale, (xy[i + 1] + dy) * scale);
        context.closePath();
        context.globalAlpha = colour.colour ? .75 : under ? .5 : .3; context.fillStyle = tone; context.fill();
        context.globalAlpha = 1;
        if (under || chosen) { context.strokeStyle = css(chosen ? "--text" : "--card"); context.lineWidth = chosen ? 5 : 4; context.stroke(); }
        if (colour.tension && tensions && !bad) {
          context.lineWidth = 3.2; context.lineCap = "round";
          for (let i = 0; i < tensions.length; ++i) {
            const next = (i + 1) % tensions.length;
            context.strokeStyle = colour.tension(tensions[i]);
            context.beginPath(); context.moveTo((xy[2 * i] + dx) * scale, (xy[2 * i + 1] + dy) * scale); context.lineTo((xy[2 * next] + dx) * scale, (xy[2 * next + 1] + dy) * scale); context.stroke();
          }
          continue;
        }
        context.strokeStyle = bad ? css("--bad") : tone; context.lineWidth = bad ? 3 : 2; context.stroke();
      }
    } });
  }

  /// Whether a diverged run shows its last output, so that the place where it went bad is marked.
  failed() { const {data} = this, place = data.summary?.failure?.place_m || []; return this.timeline.output(this.run) === data.step.length - 1 && place.length === 2 && place.every(v => v !== null); }
  paintFailure(context, scale, acrossX) {
    const inBox = (v, length) => v - Math.floor(v / length) * length, [x, y] = this.data.summary.failure.place_m.map(v => v * 1e6);
    for (const dx of acrossX(inBox(x, this.lx), inBox(x, this.lx))) {
      const at = [(inBox(x, this.lx) + dx) * scale, (this.walls ? y : inBox(y, this.ly)) * scale];
      for (const [colour, width] of [["--card", 6], ["--bad", 2.5]]) {
        context.strokeStyle = css(colour); context.lineWidth = width;
        context.beginPath(); context.arc(...at, 11, 0, 2 * Math.PI); context.stroke();
        context.beginPath();
        for (const [ox, oy] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) { context.moveTo(at[0] + 7 * ox, at[1] + 7 * oy); context.lineTo(at[0] + 16 * ox, at[1] + 16 * oy); }
        context.stroke();
      }
    }
  }

  /// Walls that are no planes: filled, so that what the lattice has in them is not seen as fluid, with a thick line where they meet it.
  paintSolid(context, scale, acrossX, acrossY) {
    const {corners_um: corners, first, segments} = this.data.walls;
    context.fillStyle = css("--wall"); context.strokeStyle = css("--text"); context.lineWidth = 2; context.lineCap = "round";
    for (const dx of acrossX(0, this.lx)) for (const dy of acrossY(0, this.ly)) {
      const to = (draw, corner) => context[draw]((corners[2 * corner] + dx) * scale, (corners[2 * corner + 1] + dy) * scale);
      context.beginPath();
      for (let p = 0; p + 1 < first.length; ++p) { for (let i = first[p]; i < first[p + 1]; ++i) to(i === first[p] ? "moveTo" : "lineTo", i); context.closePath(); }
      context.fill();
      context.beginPath();
      segments.forEach(([a, b], i) => { if (!i || segments[i - 1][1] !== a) to("moveTo", a); to("lineTo", b); });
      context.stroke();
    }
  }

  /// Of another plane than the one that the run kept, lines alone.
  paintWallLines(context, scale, acrossX, acrossY) {
    context.strokeStyle = css("--text"); context.lineWidth = 2; context.lineCap = "round";
    for (const {xy} of this.section.wallLines()) for (const dx of acrossX(0, this.lx)) for (const dy of acrossY(0, this.ly)) {
      context.beginPath();
      for (let i = 0; i < xy.length; i += 2) context.lineTo((xy[i] + dx) * scale, (xy[i + 1] + dy) * scale);
      context.stroke();
    }
  }

  /// Walls as thick lines, with arrows that go with them where they move; periodic borders and openings as dashes.
  paintFrame(context, scale, clip) {
    const {lx, ly, walls} = this, closed = walls && !sceneOf(this.data)?.domain?.y?.lower?.inlet;
    const edge = (solid, x0, y0, x1, y1) => {
      context.beginPath(); context.setLineDash(solid ? [] : [5, 4]); context.lineWidth = solid ? 3 : 1;
      context.strokeStyle = css(solid ? "--text" : "--quiet");
      context.moveTo(x0 * scale, y0 * scale); context.lineTo(x1 * scale, y1 * scale); context.stroke(); context.setLineDash([]);
    };
    for (let k = Math.ceil(clip.left / lx - 1e-9); k * lx <= clip.right + 1e-9 * lx; ++k) edge(false, k * lx, clip.bottom, k * lx, clip.top);
    for (let k = Math.ceil(clip.bottom / ly - 1e-9); k * ly <= clip.top + 1e-9 * ly; ++k) edge(closed, clip.left, k * ly, clip.right, k * ly);
    if (walls) this.paintWalls(context, scale, clip);
  }
  paintWalls(context, scale, clip) {
    const apart = 64 / scale, size = 7;
    context.fillStyle = css("--text");
    wallMotion(this).forEach(({speed, gone}, i) => {
      if (!speed) return;
      const sign = Math.sign(speed), y = (i ? this.ly : 0) * scale + (i ? 1 : -1) * 11;
      for (let k = Math.ceil((clip.left - gone) / apart); gone + k * apart <= clip.right; ++k) {
        const x = (gone + k * apart) * scale;
        if (x < clip.left * scale + 6 || x > clip.right * scale - 6) continue;
        context.beginPath(); context.moveTo(x - sign * size, y - 4.5); context.lineTo(x + sign * size, y); context.lineTo(x - sign * size, y + 4.5); context.closePath(); context.fill();
      }
    });
  }
  paintScale(context, scale) {
    const bar = barLength(this.lx / this.zoom / 4), words = `${format(bar)} µm`, bottom = this.height - (this.walls ? 26 : 13);
    const left = Math.max(14, this.width / 2 - Math.min(this.width, this.lx * scale) / 2 + 8);
    context.font = "12px system-ui, sans-serif";
    context.fillStyle = css("--card"); context.globalAlpha = 0.8;
    context.fillRect(left - 5, bottom - 22, Math.max(bar * scale, context.measureText(words).width) + 10, 27);
    context.globalAlpha = 1;
    context.fillStyle = context.strokeStyle = css("--text"); context.lineWidth = 2;
    context.fillText(words, left, bottom - 6);
    context.beginPath(); context.moveTo(left, bottom); context.lineTo(left + bar * scale, bottom); context.stroke();
  }
}

/// What the mark in a diverged run's animation means.
function failureNote(run) {
  const failure = (run.summary || {}).failure;
  if (!failure?.place_m || !run.step.length || !isDrawn(run)) return [];
  const last = run.step.at(-1), cell = run.outlines && typeof failure.cell === "number" ? ", the red outline the cell" : "";
  return [note(`At the last instant the red ring marks the place where the run diverged${cell}` + (last < failure.step ? `: at step ${format(failure.step)}, while what is drawn is of step ${format(last)}, the last written.` : "."))];
}

/// Strain, time, step and stage that a run shows.
function instantLine(timeline, run) {
  const data = timeline.runs[run], words = [element("span"), element("span"), element("span"), element("span")];
  timeline.listeners.push(() => {
    const i = timeline.output(run), texts = [`strain ${format(data.strain[i], 3)}`, `${format(data.time_s[i], 4)} s`, `step ${format(data.step[i])}`, `stage ${data.stage[i]}`];
    if (!grows(data)) texts[0] = "";
    texts.forEach((text, k) => { words[k].textContent = text; words[k].hidden = !text; });
  });
  return element("div", {class: "now"}, ...words);
}
