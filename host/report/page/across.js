// ------------------------------------------------------------------------------------- the flow across x, and its profile
/// Velocities along x at the timeline's instant: on the plane across x where the run is in space, and their profile over y, in space on the
/// line through the middle of z, else the mean along x.
class FlowAcross {
  constructor(parent, timeline, run) {
    const data = timeline.runs[run], fields = new Fields(data), {across} = data.fields;
    Object.assign(this, {timeline, run, data, fields, across, ly: data.domain.size_um[1], lz: data.domain.size_um[2] ?? 0, known: []});
    this.most = Math.max(...data.fields.outputs.map((_, i) => Math.max(...this.profile({a: i, b: i, share: 0}).map(Math.abs))), 1e-12);
    [this.unit, this.factor] = this.most >= 1e3 ? ["mm/s", 1e-3] : ["µm/s", 1];
    const what = across ? `Velocity along x on the plane x = ${format(across.x_um, 3)} µm, and its profile` : "Profile of the velocity along x";
    this.canvas = element("canvas", {class: "view across", role: "img", "aria-label": `${what}; the fastest flow is ${format(this.most * this.factor, 3)} ${this.unit}.`});
    parent.append(element("div", {class: "chart-head"}, element("h3", {}, what), saveMenu("Save", [["Picture, PNG", () => savePng(this.canvas, fileName("profile", "png"))], ["Picture, SVG", () => this.saveSvg()], ["Data, CSV", () => this.saveCsv()]], "Save the profile")), this.canvas);
    timeline.listeners.push(() => this.draw());
    redraws.push(() => this.draw());
    new ResizeObserver(() => { if (this.canvas.clientWidth !== this.width) this.draw(); }).observe(this.canvas);
  }
  /// All velocities of a field on the plane, um/s; row by row of z.
  plane(i) {
    return this.known[i] ??= (() => { const view = new DataView(bytesOf(this.across.values[i]).buffer), {ny, nz, quantum_um_per_s: quantum} = this.across; return Float32Array.from({length: ny * nz}, (_, k) => view.getInt16(2 * k, true) * quantum); })();
  }
  planeAt({a, b, share}) { return share ? mixed(this.plane(a), this.plane(b), share) : this.plane(a); }
  /// Over y, evenly spaced.
  profile(between) {
    if (this.across) { const {ny, nz} = this.across, all = this.planeAt(between), low = Math.floor((nz - 1) / 2), high = Math.ceil((nz - 1) / 2); return Array.from({length: ny}, (_, y) => (all[low * ny + y] + all[high * ny + y]) / 2); }
    const {nx, ny} = this.fields.fields.velocity, velocity = this.fields.velocity(between), [x0, y0, width, height] = this.fields.fields.box_um;
    return Array.from({length: ny}, (_, j) => Array.from({length: nx}, (_, i) => velocity(x0 + (i + .5) / nx * width, y0 + (j + .5) / ny * height)[0]).reduce((sum, u) => sum + u, 0) / nx);
  }
  /// Where the profile's values stand, um.
  places(count) { const [from, length] = this.across ? [this.across.box_um[0], this.across.box_um[2]] : [this.fields.fields.box_um[1], this.fields.fields.box_um[3]]; return Array.from({length: count}, (_, i) => from + (i + .5) / count * length); }
  get between() { return this.fields.between(this.timeline.between(this.run)); }
  draw() {
    const {canvas} = this, fine = printing ? 3 : window.devicePixelRatio || 1, width = this.width = canvas.clientWidth || 340;
    this.height = this.across ? Math.min(width * .46, 340) + 60 : Math.min(width * .6, 300);
    canvas.width = Math.round(width * fine); canvas.height = Math.round(this.height * fine); canvas.style.height = `${this.height}px`;
    const context = canvas.getContext("2d");
    context.setTransform(fine, 0, 0, fine, 0, 0);
    this.paint(context);
  }
  paint(context) {
    const {width, height, between} = this, bottom = height - 44, map = this.across ? this.paintPlane(context, between, {left: 44, bottom, room: Math.min(width * .42, 340)}) : {right: 4, top: 24};
    context.font = "12px system-ui, sans-serif";
    if (!between) { context.fillStyle = css("--quiet"); context.fillText("no flow was written yet", map.right + 20, height / 2); return; }
    this.paintProfile(context, this.profile(between), {left: map.right + 48, right: width - 12, top: map.top, bottom});
    const asOf = this.fields.asOf(this.timeline.between(this.run));
    context.fillStyle = css("--quiet"); context.fillText(asOf, width - 16 - context.measureText(asOf).width, map.top + 14);
  }
  /// The velocities on the plane, z to the right; where its picture ends.
  paintPlane(context, between, {left, bottom, room}) {
    const {ny, nz, box_um: [y0, z0, wide, deep]} = this.across, scale = Math.min(room / this.lz, (bottom - 24) / this.ly), right = left + this.lz * scale, top = bottom - this.ly * scale;
    if (between) {
      const all = this.planeAt(between), colours = palette("speed"), least = Math.min(0, ...all), small = document.createElement("canvas"), inner = small.getContext("2d");
      const image = inner.createImageData(small.width = nz, small.height = ny);
      for (let z = 0; z < nz; ++z) for (let y = 0; y < ny; ++y) { const i = 4 * ((ny - 1 - y) * nz + z); image.data.set(colours[Math.round(254 * Math.min(1, Math.max(0, all[z * ny + y] - least) / (this.most - least)))], i); image.data[i + 3] = 255; }
      inner.putImageData(image, 0, 0);
      context.imageSmoothingEnabled = true;
      context.drawImage(small, left + z0 * scale, bottom - (y0 + wide) * scale, deep * scale, wide * scale);
    }
    context.strokeStyle = css("--quiet"); context.lineWidth = 1;
    context.beginPath(); context.rect(left, top, right - left, bottom - top); context.stroke();
    this.paintAxes(context, {left, right, top, bottom}, linearAxis([0, this.lz], left, right, {room: 0, apart: 60}), "z, µm");
    return {right, top};
  }
  paintAxes(context, {left, right, top, bottom}, across, title) {
    const upwards = linearAxis([0, this.ly], bottom, top, {room: 0, apart: 48});
    context.font = "12px system-ui, sans-serif"; context.fillStyle = css("--quiet"); context.strokeStyle = css("--line"); context.lineWidth = 1;
    const centred = (text, x, y) => context.fillText(text, x - context.measureText(text).width / 2, y);
    for (const {value, text} of across.ticks) { context.beginPath(); context.moveTo(across.at(value), bottom); context.lineTo(across.at(value), bottom + 4); context.stroke(); centred(text, across.at(value), bottom + 17); }
    for (const {value, text} of upwards.ticks) { context.beginPath(); context.moveTo(left - 4, upwards.at(value)); context.lineTo(left, upwards.at(value)); context.stroke(); context.fillText(text, left - 8 - context.measureText(text).width, upwards.at(value) + 4); }
    context.fillStyle = css("--text");
    centred(title, (left + right) / 2, bottom + 36);
    context.fillText("y, µm", left - 40, top - 12);
    return upwards;
  }
  paintProfile(context, profile, box) {
    const {left, right, top, bottom} = box, high = this.most * this.factor, low = Math.min(0, ...profile) < -.02 * this.most ? -high : 0, across = linearAxis([low, high], left, right, {room: .03, apart: 80});
    context.strokeStyle = css("--line"); context.lineWidth = 1;
    context.beginPath(); context.rect(left, top, right - left, bottom - top); context.stroke();
    context.beginPath(); context.moveTo(across.at(0), top); context.lineTo(across.at(0), bottom); context.stroke();
    const upwards = this.paintAxes(context, box, across, `velocity, ${this.unit}`), places = this.places(profile.length);
    context.strokeStyle = css("--c0"); context.lineWidth = 2;
    context.beginPath();
    profile.forEach((u, i) => context.lineTo(across.at(u * this.factor), upwards.at(places[i])));
    context.stroke();
  }
  saveSvg() { const context = new SvgContext(this.width, this.height, css("--card")); this.paint(context); download(fileName("profile", "svg"), new Blob([context.text()], {type: "image/svg+xml"})); }
  saveCsv() {
    const {between} = this, profile = between ? this.profile(between) : [], places = this.places(profile.length);
    download(fileName("profile", "csv"), new Blob([`y_um,velocity_um_per_s\n${profile.map((u, i) => `${places[i].toPrecision(6)},${u.toPrecision(6)}`).join("\n")}\n`], {type: "text/csv"}));
  }
}
