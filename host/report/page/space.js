// ------------------------------------------------------------------------------------------------------- the box in space
/// A flat arrow as three triangles from `tail` along `along` (a vector as long as the arrow), its breadth along `across` (of length 1).
function arrowTriangles(tail, along, across) {
  const length = Math.hypot(...along), at = (share, side) => tail.map((t, k) => t + share * along[k] + side * length * across[k]);
  const [a, b, c, d] = [at(0, .06), at(0, -.06), at(.6, -.06), at(.6, .06)];
  return [a, b, c, a, c, d, at(.6, .18), at(.6, -.18), at(1, 0)].flat();
}

/// A run in its box at the timeline's instant: surfaces of cells, walls, the arrows of what moves. Drag, two fingers or arrow keys turn it;
/// Ctrl and the wheel, fingers that part, + and - come closer, 0 is where it began. A wheel or a finger alone belongs to the page. A plane
/// across one axis cuts all open: what lies between it and the eye is left out, and the cells are filled where they are cut.
class SpaceView {
  static start = {azimuth: -.5, elevation: .3, closer: 1};
  static uncut = [0, 0, 0, 1e6];
  static opening = Math.tan(16 * Math.PI / 180);
  static arrows = 14;
  constructor(parent, timeline, run, view, surfaces) {
    const data = timeline.runs[run], {domain} = data;
    Object.assign(this, {timeline, run, data, view, surfaces, places: surfaces.placesOf(data), colours: cellColours(data, timeline.runs), fields: data.fields && new Fields(data), box: domain.size_um, ly: domain.size_um[1], stages: stagesOf(data),
      periodic: domain.periodic, cut: {axis: null, share: .5}});
    // A periodic box that is shorter than it is high is shown as often as makes sense of it.
    const [x, y, z] = this.box, high = Math.max(y, z);
    this.times = domain.periodic[0] && x < .75 * high ? Math.min(24, Math.ceil(1.25 * high / x)) : 1;
    this.shown = [this.times * x, y, z];
    view.camera ??= {...SpaceView.start};
    this.canvas = element("canvas", {class: "view space", role: "img", tabindex: 0, "aria-label": `${this.words()} in a box of ${this.box.map(l => format(l, 3)).join(" by ")} µm, ${this.times > 1 ? `${this.times} periods of it, ` : ""}seen in perspective. Arrow keys turn it, plus and minus zoom.`});
    this.over = element("canvas", {class: "over", "aria-hidden": "true"});
    this.bar = element("div", {class: "bar cells"});
    parent.append(element("div", {class: "view-box"}, this.canvas, this.over), this.cutControls(), this.bar);
    try { this.begin(); } catch (error) {
      if (this.scene) throw error;  // there is WebGL
      this.renderer = null;
      parent.replaceChildren(note("This browser has no WebGL: the surfaces are in frames.xmf, for ParaView."));
      return;
    }
    timeline.listeners.push(() => this.draw());
    view.listeners.push(() => { this.showBar(); this.draw(); });
    view.turned.push(() => this.draw());
    redraws.push(() => this.draw());
    new ResizeObserver(() => { if (this.canvas.clientWidth !== this.width) this.draw(); }).observe(this.canvas);
    this.listen();
    this.showBar();
  }
  words() { const {count} = this.surfaces; return count ? `${count} ${count === 1 ? "cell" : "cells"}` : "The walls"; }
  showBar() { this.bar.replaceChildren(...(this.surfaces.count ? (this.colours[this.view.colour] ?? this.colours.grey)?.bar() ?? [] : [])); }
  get between() { return this.timeline.between(this.run); }
  stageAt(output) { return this.stages.findLast(stage => stage.from <= output); }
  begin() {
    const {Renderer, Camera, Transform, Program, Mesh, Geometry} = ogl, nodes = this.surfaces.nodes;
    this.renderer = new Renderer({canvas: this.canvas, dpr: Math.min(2, window.devicePixelRatio || 1), alpha: true, antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true});
    const {gl} = this.renderer;
    if (!gl) throw new Error("no WebGL");
    gl.clearColor(0, 0, 0, 0);
    this.camera = new Camera(gl, {fov: 32, near: .01, far: 100});
    this.scene = new Transform();
    this.plane = {value: SpaceView.uncut};
    const dynamic = (size, count) => ({size, data: new Float32Array(size * count), usage: gl.DYNAMIC_DRAW}), add = (geometry, program, mode = gl.TRIANGLES) => { const mesh = new Mesh(gl, {mode, geometry, program, frustumCulled: false}); mesh.setParent(this.scene); return mesh; };
    this.repeat = (geometry, program) => { for (let k = 0; k < this.times; ++k) { const mesh = add(geometry, program); mesh.position.x = (k - (this.times - 1) / 2) * this.box[0]; } };
    this.geometry = new Geometry(gl, {position: dynamic(3, nodes), normal: dynamic(3, nodes), colour: dynamic(3, nodes), index: {data: this.surfaces.triangles}});
    // An inner side that is seen lies behind the cut: in one flat colour it is the filled cut itself.
    this.program = new Program(gl, {cullFace: false, uniforms: {plane: this.plane, fill: {value: [1, 1, 1, 0]}},
      vertex: `attribute vec3 position, normal, colour; uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix; varying vec3 p, n, c;
        void main() { p = (modelMatrix * vec4(position, 1.0)).xyz; n = normalMatrix * normal; c = colour; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragment: `precision highp float; uniform vec4 plane, fill; varying vec3 p, n, c;
        void main() { if (dot(plane.xyz, p) > plane.w) discard;
          vec3 m = normalize(n); float light = 0.42 + 0.5 * max(0.0, dot(m, normalize(vec3(0.3, 0.6, 0.75)))) + 0.14 * abs(m.z), shine = 0.18 * pow(max(0.0, dot(m, normalize(vec3(0.15, 0.4, 0.9)))), 24.0);
          gl_FragColor = vec4(gl_FrontFacing ? c * light + shine : mix(c, fill.rgb, fill.a), 1.0); }`});
    if (this.surfaces.count) this.repeat(this.geometry, this.program);
    const flat = () => new Program(gl, {cullFace: false, uniforms: {plane: this.plane, tone: {value: [0, 0, 0]}}, vertex: "attribute vec3 position; uniform mat4 modelViewMatrix, projectionMatrix; varying vec3 p; void main() { p = position; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragment: "precision highp float; uniform vec4 plane; uniform vec3 tone; varying vec3 p; void main() { if (dot(plane.xyz, p) > plane.w) discard; gl_FragColor = vec4(tone, 1.0); }"});
    this.frameProgram = flat(); this.arrowProgram = flat(); this.driveProgram = flat(); this.sectionProgram = flat();
    for (const program of [this.frameProgram, this.driveProgram, this.sectionProgram]) program.uniforms.plane = {value: SpaceView.uncut};
    this.rim = new Geometry(gl, {position: dynamic(3, 4)}); this.sectionRim = new Geometry(gl, {position: dynamic(3, 4)});
    this.arrowGeometry = new Geometry(gl, {position: dynamic(3, 9 * SpaceView.arrows)});
    const driven = drivenAlong(this.data), [lx, ly, lz] = this.shown, flow = Math.min(lx / 3, ly / 2);  // an arrow below the box
    if (driven) add(new Geometry(gl, {position: {size: 3, data: Float32Array.from(arrowTriangles([-driven * flow / 2, -ly / 2 * 1.12, lz / 2], [driven * flow, 0, 0], [0, 1, 0]))}}), this.driveProgram);
    add(this.rim, this.frameProgram, gl.LINE_LOOP); add(this.sectionRim, this.sectionProgram, gl.LINE_LOOP);
    add(new Geometry(gl, {position: {size: 3, data: this.edges()}}), this.frameProgram, gl.LINES);
    this.glassPrograms = [];
    this.addPlanes(); if (this.data.walls?.surface) this.addWalls(this.data.walls.surface);
    add(this.arrowGeometry, this.arrowProgram);
  }
  get corners() { return Array.from({length: 8}, (_, i) => [0, 1, 2].map(k => (i >> k & 1 ? 1 : -1) * this.shown[k] / 2)); }
  edges() {
    const {corners} = this, edges = [];
    for (let i = 0; i < 8; ++i) for (const bit of [1, 2, 4]) if (!(i & bit)) edges.push(...corners[i], ...corners[i | bit]);
    return Float32Array.from(edges);
  }
  /// Glass that is `thin` seen from the front and dense from the side.
  glass(position, normal, index, thin, dense) {
    const {Program, Geometry} = ogl, {gl} = this.renderer;
    const program = new Program(gl, {cullFace: false, transparent: true, depthWrite: false, uniforms: {plane: this.plane, tone: {value: [0, 0, 0]}, seen: {value: [thin, dense]}},
      vertex: `attribute vec3 position, normal; uniform mat4 modelMatrix, modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix; varying vec3 p, n, e;
        void main() { vec4 seen = modelViewMatrix * vec4(position, 1.0); p = (modelMatrix * vec4(position, 1.0)).xyz; n = normalMatrix * normal; e = seen.xyz; gl_Position = projectionMatrix * seen; }`,
      fragment: `precision highp float; uniform vec4 plane; uniform vec3 tone; uniform vec2 seen; varying vec3 p, n, e;
        void main() { if (dot(plane.xyz, p) > plane.w) discard;
          float along = abs(dot(normalize(n), normalize(e))), dense = seen.x + seen.y * pow(1.0 - along, 2.0); gl_FragColor = vec4(tone * dense, dense); }`});
    program.setBlendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    this.glassPrograms.push(program);
    this.repeat(new Geometry(gl, {position: {size: 3, data: position}, normal: {size: 3, data: normal}, index: {data: index}}), program);
  }
  /// Whether the sides of the box across an axis are walls: those that are not periodic, where it is not walls of another shape that
  /// close the box, or openings.
  isWalled(axis) {
    if (axis === 0 || this.periodic[axis]) return false;
    const domain = sceneOf(this.data)?.domain;
    const ends = domain?.["xyz"[axis]];
    return domain ? typeof ends === "object" && !ends.lower?.inlet : !this.data.walls;
  }
  addPlanes() {
    const half = this.box.map(l => l / 2), position = [], normal = [], index = [];
    for (const axis of [1, 2]) if (this.isWalled(axis)) for (const side of [-1, 1]) {
      const [u, v] = [0, 1, 2].filter(k => k !== axis), first = position.length / 3;
      for (const [a, b] of [[-1, -1], [1, -1], [1, 1], [-1, 1]]) { const p = [0, 0, 0], n = [0, 0, 0]; p[axis] = side * half[axis]; p[u] = a * half[u]; p[v] = b * half[v]; n[axis] = side; position.push(...p); normal.push(...n); }
      index.push(...[0, 1, 2, 0, 2, 3].map(i => first + i));
    }
    if (index.length) this.glass(Float32Array.from(position), Float32Array.from(normal), Uint16Array.from(index), .2, .12);
  }
  /// Walls that are no planes.
  addWalls({quantum_um: quantum, points, triangles}) {
    const places = new DataView(bytesOf(points).buffer), index = decodedTriangles(triangles);
    const position = Float32Array.from({length: places.byteLength / 2}, (_, i) => places.getInt16(2 * i, true) * quantum - this.box[i % 3] / 2);
    this.glass(position, normalsAt(position, index), index, .13, .45);
  }
  /// Directions of the screen in the box: to the right, upwards and towards the eye.
  get directions() {
    const {azimuth: a, elevation: e} = this.view.camera;
    return [[Math.cos(a), 0, -Math.sin(a)], [-Math.sin(e) * Math.sin(a), Math.cos(e), -Math.sin(e) * Math.cos(a)], [Math.cos(e) * Math.sin(a), Math.sin(e), Math.cos(e) * Math.cos(a)]];
  }
  /// How far the eye must be to see all of the box.
  distance(aspect) {
    const [right, up, near] = this.directions, along = (v, c) => v.reduce((sum, x, k) => sum + x * c[k], 0), edge = .92 * SpaceView.opening;
    return Math.max(...this.corners.map(c => along(near, c) + Math.max(Math.abs(along(up, c)) / edge, Math.abs(along(right, c)) / edge / aspect))) / this.view.camera.closer;
  }
  heightFor(width) {
    const [x, y, z] = this.shown, across = x * Math.cos(.5) + z * Math.sin(.5), upright = y + .3 * z;
    return Math.round(Math.min(Math.max(width * 1.06 * upright / across, 240), 620, Math.max(280, innerHeight * .7)));
  }
  draw() {
    const {canvas} = this, width = canvas.clientWidth;
    if (!width || !this.renderer) return;
    const height = this.heightFor(width);
    if (this.width !== width || this.height !== height) { this.renderer.setSize(width, height); canvas.style.width = "100%"; Object.assign(this, {width, height}); }
    this.paintCells();
    this.render(width, height);
    const fine = window.devicePixelRatio || 1, {over} = this;
    over.width = Math.round(width * fine); over.height = Math.round(height * fine);
    const context = over.getContext("2d");
    context.scale(fine, fine);
    this.paintSigns(context, width, height);
  }
  /// Places and colours of all nodes.
  paintCells() {
    const {geometry, surfaces, box, between} = this, colour = this.colours[this.view.colour] ?? this.colours.grey;
    if (!surfaces.count) return;
    const nodes = surfaces.between(between), places = surfaces.wrapped(nodes, box, this.periodic), position = geometry.attributes.position, tones = geometry.attributes.colour;
    geometry.attributes.normal.data.set(normalsAt(places, surfaces.triangles));
    for (let i = 0; i < places.length; ++i) position.data[i] = places[i] - box[i % 3] / 2;
    const tension = colour?.tension && surfaces.tension(between);
    for (let own = 0; own < surfaces.count; ++own) {
      if (Number.isNaN(nodes[3 * surfaces.first[own]])) continue;
      const cell = this.places[own];
      if (tension && this.view.cell !== cell) {
        for (let i = surfaces.first[own]; i < surfaces.first[own + 1]; ++i) tones.data.set(colour.rgb(tension[i]), 3 * i);
        continue;
      }
      const rgb = rgbOf(this.view.cell === cell ? css("--text") : colour?.colour ? colour.colour(cell, between) : css(colour ? colour.tone(cell, between) : "--single"));
      for (let i = surfaces.first[own]; i < surfaces.first[own + 1]; ++i) tones.data.set(rgb, 3 * i);
    }
    for (const name of ["position", "normal", "colour"]) geometry.attributes[name].needsUpdate = true;
    this.program.uniforms.fill.value = [...rgbOf(css("--cut")), tension ? 1 : .45];
  }
  render(width, height) {
    const far = this.distance(width / height), [, , near] = this.directions;
    this.camera.perspective({aspect: width / height, near: far / 100, far: far * 10});
    this.camera.position.set(...near.map(v => far * v));
    this.camera.lookAt([0, 0, 0]);
    this.drawCut();
    this.drawArrows();
    this.frameProgram.uniforms.tone.value = rgbOf(css("--quiet")); this.sectionProgram.uniforms.tone.value = rgbOf(css("--accent"));
    this.arrowProgram.uniforms.tone.value = this.driveProgram.uniforms.tone.value = rgbOf(css("--text"));
    for (const program of this.glassPrograms) program.uniforms.tone.value = rgbOf(css("--quiet"));
    this.renderer.render({scene: this.scene, camera: this.camera});
  }
  /// The plane as the shader takes it, on the side of the eye; its rim in the box, and that of the section beside this view.
  drawCut() {
    const {axis, share} = this.cut, plane = SpaceView.uncut.slice(), half = this.shown.map(l => l / 2);
    const frame = ({attributes: {position}}, axis, share) => {
      const [u, v] = [0, 1, 2].filter(k => k !== axis);
      position.data.fill(0);
      if (axis !== null) [[-1, -1], [1, -1], [1, 1], [-1, 1]].forEach(([a, b], i) => { position.data[3 * i + axis] = (2 * share - 1) * half[axis]; position.data[3 * i + u] = a * half[u]; position.data[3 * i + v] = b * half[v]; });
      position.needsUpdate = true;
    };
    if (axis !== null) { plane[axis] = this.camera.position[axis] < 0 ? -1 : 1; plane[3] = plane[axis] * (2 * share - 1) * half[axis]; }
    frame(this.rim, axis, share);
    frame(this.sectionRim, this.section ? 2 : null, this.section && this.section.z / this.section.length);
    this.plane.value = plane;
  }
  cutControls() {
    const words = () => this.cut.axis === null ? "" : `${"xyz"[this.cut.axis]} = ${format(this.cut.share * this.shown[this.cut.axis], 3)} µm`, where = element("span", {class: "quiet"});
    const slider = element("input", {type: "range", min: 0, max: 1, step: .005, value: this.cut.share, hidden: "", "aria-label": "Place of the cut", oninput: () => { this.cut.share = Number(slider.value); changed(); }});
    const changed = () => { slider.hidden = this.cut.axis === null; where.textContent = words(); slider.setAttribute("aria-valuetext", words()); this.draw(); };
    return element("div", {class: "controls"}, choice("Cut", [["", "none"], ["0", "across x"], ["1", "across y"], ["2", "across z"]], "", axis => { this.cut.axis = axis === "" ? null : Number(axis); changed(); }), slider, where);
  }
  /// Arrows in the walls that move, which go with them.
  drawArrows() {
    const {position} = this.arrowGeometry.attributes, [lx, ly, lz] = this.shown, arrows = [], apart = lx / 3, long = Math.min(apart * .6, lz * .8);
    position.data.fill(0);
    wallMotion(this).forEach(({speed, gone}, i) => {
      if (!speed) return;
      const sign = Math.sign(speed), offset = ((gone % apart) + apart) % apart;
      for (const z of [-.25, .25]) for (let k = -1; k <= 3; ++k) {
        const middle = k * apart + offset;
        if (middle < long / 2 || middle > lx - long / 2) continue;
        arrows.push(arrowTriangles([middle - lx / 2 - sign * long / 2, (i ? 1 : -1) * ly / 2, z * lz], [sign * long, 0, 0], [0, 0, 1]));
      }
    });
    arrows.slice(0, SpaceView.arrows).forEach((triangles, i) => position.data.set(triangles, 27 * i));
    position.needsUpdate = true;
  }
  /// What a picture in perspective wants beside it: the axes, and a length in the middle of the box.
  paintSigns(context, width, height) {
    const [right, up] = this.directions, at = [34, width < 500 ? 34 : height - 34], long = 22;  // where the box is not
    context.font = "12px system-ui, sans-serif"; context.lineCap = "round";
    ["x", "y", "z"].forEach((name, k) => {
      const [dx, dy] = [right[k], -up[k]], far = Math.hypot(dx, dy);
      context.strokeStyle = context.fillStyle = css("--text"); context.lineWidth = 1.6;
      context.beginPath(); context.moveTo(...at); context.lineTo(at[0] + long * dx, at[1] + long * dy); context.stroke();
      if (far > .2) context.fillText(name, at[0] + dx * long + 8 * dx / far - 3, at[1] + dy * long + 8 * dy / far + 4);
    });
    if (this.failed()) this.paintFailure(context, width, height);
    const scale = height / 2 / SpaceView.opening / this.distance(width / height), bar = barLength(width / scale / 5), words = `${format(bar)} µm`, left = width - 14 - bar * scale, bottom = height - 14;
    context.lineWidth = 2; context.lineCap = "butt";
    context.beginPath(); context.moveTo(left, bottom); context.lineTo(left + bar * scale, bottom); context.stroke();
    context.fillText(words, left + bar * scale / 2 - context.measureText(words).width / 2, bottom - 6);
  }
  /// Whether a diverged run shows its last output: then a ring marks the place where it went bad.
  failed() { const {data} = this, place = data.summary?.failure?.place_m ?? []; return this.timeline.output(this.run) === data.step.length - 1 && place.length === 3 && place.every(v => v !== null); }
  paintFailure(context, width, height) {
    const place = this.data.summary.failure.place_m.map((v, k) => (this.periodic[k] ? 1e6 * v - this.box[k] * Math.floor(1e6 * v / this.box[k]) : 1e6 * v) - this.box[k] / 2);
    const [x, y, near] = this.directions.map(axis => axis.reduce((sum, v, k) => sum + v * place[k], 0)), scale = height / 2 / SpaceView.opening / (this.distance(width / height) - near);
    for (const [colour, line] of [["--card", 6], ["--bad", 2.5]]) {
      context.strokeStyle = css(colour); context.lineWidth = line;
      context.beginPath(); context.arc(width / 2 + x * scale, height / 2 - y * scale, 11, 0, 2 * Math.PI); context.stroke();
    }
  }
  /// What is seen, the signs included: a canvas.
  get image() {
    const image = this.seen ??= document.createElement("canvas"), {width, height} = this.canvas, context = image.getContext("2d");
    image.width = width; image.height = height;
    for (const layer of [this.canvas, this.over]) context.drawImage(layer, 0, 0, width, height);
    return image;
  }
  /// The picture in so many pixels, for a figure: a canvas.
  picture(width, height) {
    const {renderer} = this, copy = Object.assign(document.createElement("canvas"), {width, height}), {dpr} = renderer;
    renderer.dpr = 1; renderer.setSize(width, height);
    this.paintCells();
    this.render(width, height);
    copy.getContext("2d").drawImage(this.canvas, 0, 0);
    renderer.dpr = dpr; this.width = null;
    this.draw();
    return copy;
  }
  turn(dx, dy) {
    const {camera} = this.view;
    camera.azimuth -= dx;
    camera.elevation = Math.min(1.5, Math.max(-1.5, camera.elevation + dy));
    this.view.turn();
  }
  zoomBy(factor) { this.view.camera.closer = Math.min(9, Math.max(.3, this.view.camera.closer * factor)); this.view.turn(); }
  showAll() { Object.assign(this.view.camera, SpaceView.start); this.view.turn(); }
  listen() {
    const {canvas} = this;
    let held = null, fingers = null;
    canvas.style.touchAction = "pan-x pan-y";
    canvas.addEventListener("pointerdown", event => { if (event.pointerType !== "touch") { held = [event.clientX, event.clientY]; canvas.setPointerCapture(event.pointerId); } });
    canvas.addEventListener("pointermove", event => {
      if (!held || event.pointerType === "touch") return;
      this.turn((event.clientX - held[0]) / 150, (event.clientY - held[1]) / 150);
      held = [event.clientX, event.clientY];
    });
    for (const kind of ["pointerup", "pointercancel"]) canvas.addEventListener(kind, () => { held = null; });
    canvas.addEventListener("touchmove", event => {
      if (event.touches.length !== 2) return;
      event.preventDefault();  // or the page would scroll
      const [a, b] = event.touches, now = {x: (a.clientX + b.clientX) / 2, y: (a.clientY + b.clientY) / 2, apart: Math.max(1, Math.hypot(a.clientX - b.clientX, a.clientY - b.clientY))};
      if (fingers) { this.turn((now.x - fingers.x) / 150, (now.y - fingers.y) / 150); this.zoomBy(now.apart / fingers.apart); }
      fingers = now;
    }, {passive: false});
    for (const kind of ["touchstart", "touchend", "touchcancel"]) canvas.addEventListener(kind, () => { fingers = null; });
    canvas.addEventListener("wheel", event => { if (event.ctrlKey || event.metaKey) { event.preventDefault(); this.zoomBy(Math.exp(-event.deltaY / 500)); } }, {passive: false});
    canvas.addEventListener("keydown", event => {
      const act = {ArrowLeft: () => this.turn(.1, 0), ArrowRight: () => this.turn(-.1, 0), ArrowUp: () => this.turn(0, .1), ArrowDown: () => this.turn(0, -.1), "+": () => this.zoomBy(1.25), "-": () => this.zoomBy(.8),
        "0": () => this.showAll()}[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      act();
      event.preventDefault();
      event.stopPropagation();
    });
  }
}
