// ------------------------------------------------------------------------------------------------ cells in three dimensions
/// Surfaces of one run: nodes x, y, z in micrometres, not wrapped into the box, at an output that has them or between two.
class Surfaces {
  constructor(surfaces) {
    Object.assign(this, {data: surfaces, first: surfaces.first, count: surfaces.first.length - 1, nodes: surfaces.first.at(-1), known: []});
    const meshes = surfaces.meshes.map(decodedTriangles), length = surfaces.mesh.reduce((sum, mesh) => sum + meshes[mesh].length, 0);
    this.triangles = new Uint32Array(length);
    let end = 0;
    surfaces.mesh.forEach((mesh, cell) => { for (const node of meshes[mesh]) this.triangles[end++] = surfaces.first[cell] + node; });
  }
  at(kept) {
    return this.known[kept] ??= decodedNodes(this, kept, 3);
  }
  /// The two that have surfaces around a place among the page's outputs, {a, b, share}.
  around({a, share}) {
    const {outputs} = this.data, position = a + share, after = outputs.findIndex(output => output >= position);
    if (after <= 0) { const only = after < 0 ? outputs.length - 1 : 0; return {a: only, b: only, share: 0}; }
    return {a: after - 1, b: after, share: (position - outputs[after - 1]) / (outputs[after] - outputs[after - 1])};
  }
  between(instant) {
    const {a, b, share} = this.around(instant);
    return share ? mixed(this.at(a), this.at(b), share) : this.at(a);
  }
  /// Tension over its scale, from -1 to 1, for each node.
  tension(instant) {
    const {a, b, share} = this.around(instant);
    return decodedTension(this, a, b, share);
  }
  /// Moved as whole cells into the periodic box. Triangles of cells that are not there have no area.
  wrapped(places, box, periodic) {
    const moved = places.map(v => Number.isNaN(v) ? 0 : v), {first} = this;
    for (let cell = 0; cell < this.count; ++cell) {
      for (let k = 0; k < 3; ++k) {
        if (!periodic[k]) continue;
        let sum = 0;
        for (let i = first[cell]; i < first[cell + 1]; ++i) sum += moved[3 * i + k];
        const shift = box[k] * Math.floor(sum / (first[cell + 1] - first[cell]) / box[k]);
        if (shift) for (let i = first[cell]; i < first[cell + 1]; ++i) moved[3 * i + k] -= shift;
      }
    }
    return moved;
  }
}

function decodedTriangles(text) {
  const numbers = new DataView(bytesOf(text).buffer);
  return Uint32Array.from({length: numbers.byteLength / 4}, (_, i) => numbers.getUint32(4 * i, true));
}
/// Outer normals at the nodes of triangles, by the areas around them.
function normalsAt(places, triangles) {
  const normals = new Float32Array(places.length);
  for (let t = 0; t < triangles.length; t += 3) {
    const [a, b, c] = [3 * triangles[t], 3 * triangles[t + 1], 3 * triangles[t + 2]], u = [0, 1, 2].map(k => places[b + k] - places[a + k]), v = [0, 1, 2].map(k => places[c + k] - places[a + k]);
    const cross = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
    for (const at of [a, b, c]) for (let k = 0; k < 3; ++k) normals[at + k] += cross[k];
  }
  return normals;
}

const rgbOf = (() => {
  const context = document.createElement("canvas").getContext("2d", {willReadFrequently: true}), known = new Map();
  return text => {
    if (!known.has(text)) {
      context.fillStyle = "#888"; context.fillStyle = text; context.clearRect(0, 0, 1, 1); context.fillRect(0, 0, 1, 1);
      known.set(text, [...context.getImageData(0, 0, 1, 1).data].slice(0, 3).map(v => v / 255));
    }
    return known.get(text);
  };
})();

/// The surfaces of a run at the timeline's instant, in their box. Drag, two fingers or arrow keys turn it; Ctrl and the wheel, fingers that
/// part, + and - come closer, 0 is where it began. A wheel or a finger alone belongs to the page. A plane across one axis cuts them open: what lies between it and the eye is left out.
class SpaceView {
  static start = {azimuth: -.5, elevation: .35, distance: .85};
  static uncut = [0, 0, 0, 1];
  constructor(parent, timeline, run, view) {
    const data = timeline.runs[run], surfaces = new Surfaces(data.surfaces);
    const places = new Map((data.cells?.ids ?? []).map((number, place) => [number, place]));
    this.places = data.surfaces.cells.map((number, cell) => places.get(number) ?? cell);  // among the cells of the page
    Object.assign(this, {timeline, run, data, view, surfaces, colours: cellColours(data), box: data.surfaces.size_um, periodic: data.surfaces.periodic, cut: {axis: null, share: .5}, ...SpaceView.start});
    this.canvas = element("canvas", {class: "view space", role: "img", tabindex: 0, "aria-label": `${surfaces.count} ${surfaces.count === 1 ? "cell" : "cells"} in a box of ${this.box.map(l => format(l, 3)).join(" by ")} µm, seen in perspective. Arrow keys turn it, plus and minus zoom.`});
    parent.append(this.canvas, this.cutControls());
    try { this.begin(); } catch { parent.replaceChildren(note("This browser has no WebGL: the surfaces are in frames.xmf, for ParaView.")); return; }
    timeline.listeners.push(() => this.draw());
    view.listeners.push(() => this.draw());
    redraws.push(() => this.draw());
    new ResizeObserver(() => { if (this.canvas.clientWidth !== this.width) this.draw(); }).observe(this.canvas);
    this.listen();
  }
  begin() {
    const {Renderer, Camera, Transform, Program, Mesh, Geometry} = ogl, nodes = this.surfaces.nodes, [x, y, z] = this.box.map(l => l / 2);
    this.renderer = new Renderer({canvas: this.canvas, dpr: Math.min(2, window.devicePixelRatio || 1), alpha: true, antialias: true, premultipliedAlpha: true, preserveDrawingBuffer: true});
    const {gl} = this.renderer;
    if (!gl) throw new Error("no WebGL");
    gl.clearColor(0, 0, 0, 0);
    this.camera = new Camera(gl, {fov: 32, near: .01, far: 100});
    this.scene = new Transform();
    this.geometry = new Geometry(gl, {position: {size: 3, data: new Float32Array(3 * nodes), usage: gl.DYNAMIC_DRAW}, normal: {size: 3, data: new Float32Array(3 * nodes), usage: gl.DYNAMIC_DRAW},
      colour: {size: 3, data: new Float32Array(3 * nodes), usage: gl.DYNAMIC_DRAW}, index: {data: this.surfaces.triangles}});
    this.program = new Program(gl, {cullFace: false, uniforms: {plane: {value: SpaceView.uncut}},
      vertex: `attribute vec3 position, normal, colour; uniform mat4 modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix; varying vec3 p, n, c;
        void main() { p = position; n = normalMatrix * normal; c = colour; gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }`,
      fragment: `precision highp float; uniform vec4 plane; varying vec3 p, n, c;
        void main() { if (dot(plane.xyz, p) > plane.w) discard;
          float light = 0.45 + 0.6 * abs(dot(normalize(n), normalize(vec3(0.3, 0.5, 0.8)))); gl_FragColor = vec4(c * light * (gl_FrontFacing ? 1.0 : 0.55), 1.0); }`});
    new Mesh(gl, {geometry: this.geometry, program: this.program, frustumCulled: false}).setParent(this.scene);
    if (this.data.walls?.surface) this.addWalls(this.data.walls.surface);
    const corners = Array.from({length: 8}, (_, i) => [i & 1 ? x : -x, i & 2 ? y : -y, i & 4 ? z : -z]), edges = [];
    for (let i = 0; i < 8; ++i) for (const bit of [1, 2, 4]) if (!(i & bit)) edges.push(...corners[i], ...corners[i | bit]);
    this.frameProgram = new Program(gl, {uniforms: {tone: {value: [0, 0, 0]}}, vertex: "attribute vec3 position; uniform mat4 modelViewMatrix, projectionMatrix; void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0); }",
      fragment: "precision highp float; uniform vec3 tone; void main() { gl_FragColor = vec4(tone, 1.0); }"});
    this.rim = new Geometry(gl, {position: {size: 3, data: new Float32Array(12), usage: gl.DYNAMIC_DRAW}});
    new Mesh(gl, {mode: gl.LINE_LOOP, geometry: this.rim, program: this.frameProgram, frustumCulled: false}).setParent(this.scene);
    new Mesh(gl, {mode: gl.LINES, geometry: new Geometry(gl, {position: {size: 3, data: new Float32Array(edges)}}), program: this.frameProgram, frustumCulled: false}).setParent(this.scene);
  }
  /// Walls that are no planes: glass, denser where it is seen from the side.
  addWalls({quantum_um: quantum, points, triangles}) {
    const {Program, Mesh, Geometry} = ogl, {gl} = this.renderer, places = new DataView(bytesOf(points).buffer), index = decodedTriangles(triangles);
    const position = Float32Array.from({length: places.byteLength / 2}, (_, i) => places.getInt16(2 * i, true) * quantum - this.box[i % 3] / 2);
    this.wallProgram = new Program(gl, {cullFace: false, transparent: true, depthWrite: false, uniforms: {plane: this.program.uniforms.plane, tone: {value: [0, 0, 0]}},
      vertex: `attribute vec3 position, normal; uniform mat4 modelViewMatrix, projectionMatrix; uniform mat3 normalMatrix; varying vec3 p, n, e;
        void main() { vec4 seen = modelViewMatrix * vec4(position, 1.0); p = position; n = normalMatrix * normal; e = seen.xyz; gl_Position = projectionMatrix * seen; }`,
      fragment: `precision highp float; uniform vec4 plane; uniform vec3 tone; varying vec3 p, n, e;
        void main() { if (dot(plane.xyz, p) > plane.w) discard;
          float along = abs(dot(normalize(n), normalize(e))), dense = 0.13 + 0.45 * pow(1.0 - along, 2.0); gl_FragColor = vec4(tone * dense, dense); }`});
    this.wallProgram.setBlendFunc(gl.ONE, gl.ONE_MINUS_SRC_ALPHA);
    new Mesh(gl, {geometry: new Geometry(gl, {position: {size: 3, data: position}, normal: {size: 3, data: normalsAt(position, index)}, index: {data: index}}), program: this.wallProgram, frustumCulled: false}).setParent(this.scene);
  }
  draw() {
    const {canvas, geometry, surfaces, box} = this, width = canvas.clientWidth;
    if (!width || !this.renderer) return;
    const height = Math.round(Math.min(width * .76, 520)), between = this.timeline.between(this.run), colour = this.colours[this.view.colour] ?? this.colours.grey;
    if (this.width !== width) { this.renderer.setSize(width, height); canvas.style.width = "100%"; this.camera.perspective({aspect: width / height}); this.width = width; }
    const nodes = surfaces.between(between), places = surfaces.wrapped(nodes, box, this.periodic), position = geometry.attributes.position, tones = geometry.attributes.colour;
    geometry.attributes.normal.data.set(normalsAt(places, surfaces.triangles));
    for (let i = 0; i < places.length; ++i) position.data[i] = places[i] - box[i % 3] / 2;
    const tension = colour?.tension && surfaces.tension(between);
    for (let own = 0; own < surfaces.count; ++own) {
      if (Number.isNaN(nodes[3 * surfaces.first[own]])) continue;
      const cell = this.places[own];
      if (tension && this.view.cell !== cell) {
        for (let i = surfaces.first[own]; i < surfaces.first[own + 1]; ++i) tones.data.set(rampRgb(rampStops.tension, (tension[i] + 1) / 2), 3 * i);
        continue;
      }
      const rgb = rgbOf(this.view.cell === cell ? css("--text") : colour?.colour ? colour.colour(cell, between) : css(colour ? colour.tone(cell, between) : "--single"));
      for (let i = surfaces.first[own]; i < surfaces.first[own + 1]; ++i) tones.data.set(rgb, 3 * i);
    }
    for (const name of ["position", "normal", "colour"]) geometry.attributes[name].needsUpdate = true;
    const far = this.distance * 1.15 * Math.hypot(...box) / (2 * Math.tan(16 * Math.PI / 180)), {azimuth, elevation} = this;
    this.camera.perspective({near: far / 100, far: far * 10});
    this.camera.position.set(far * Math.cos(elevation) * Math.sin(azimuth), far * Math.sin(elevation), far * Math.cos(elevation) * Math.cos(azimuth));
    this.camera.lookAt([0, 0, 0]);
    this.drawCut();
    this.frameProgram.uniforms.tone.value = rgbOf(css("--quiet") || css("--text"));
    if (this.wallProgram) this.wallProgram.uniforms.tone.value = rgbOf(css("--quiet"));
    this.renderer.render({scene: this.scene, camera: this.camera});
  }
  /// The plane as the shader takes it, on the side of the eye, and its rim in the box.
  drawCut() {
    const {axis, share} = this.cut, {position} = this.rim.attributes, plane = SpaceView.uncut.slice(), half = this.box.map(l => l / 2);
    position.data.fill(0);
    if (axis !== null) {
      const place = (share - .5) * this.box[axis], side = this.camera.position[axis] < 0 ? -1 : 1, [u, v] = [0, 1, 2].filter(k => k !== axis);
      plane[axis] = side; plane[3] = side * place;
      [[-1, -1], [1, -1], [1, 1], [-1, 1]].forEach(([a, b], i) => { position.data[3 * i + axis] = place; position.data[3 * i + u] = a * half[u]; position.data[3 * i + v] = b * half[v]; });
    }
    position.needsUpdate = true;
    this.program.uniforms.plane.value = plane;
  }
  cutControls() {
    const words = () => this.cut.axis === null ? "" : `${"xyz"[this.cut.axis]} = ${format(this.cut.share * this.box[this.cut.axis], 3)} µm`, where = element("span", {class: "quiet"});
    const slider = element("input", {type: "range", min: 0, max: 1, step: .005, value: this.cut.share, disabled: "", "aria-label": "Place of the cut", oninput: () => { this.cut.share = Number(slider.value); changed(); }});
    const changed = () => { slider.disabled = this.cut.axis === null; where.textContent = words(); slider.setAttribute("aria-valuetext", words()); this.draw(); };
    return element("div", {class: "controls"}, choice("Cut", [["", "none"], ["0", "across x"], ["1", "across y"], ["2", "across z"]], "", axis => { this.cut.axis = axis === "" ? null : Number(axis); changed(); }), slider, where);
  }
  turn(dx, dy) {
    this.azimuth -= dx;
    this.elevation = Math.min(1.5, Math.max(-1.5, this.elevation + dy));
    this.draw();
  }
  zoomBy(factor) { this.distance = Math.min(4, Math.max(.1, this.distance / factor)); this.draw(); }
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
        "0": () => { Object.assign(this, SpaceView.start); this.draw(); }}[event.key];
      if (!act || event.ctrlKey || event.metaKey || event.altKey) return;
      act();
      event.preventDefault();
      event.stopPropagation();
    });
  }
}
