// ------------------------------------------------------------------------------------------------ cells in three dimensions
/// Surfaces of one run: nodes x, y, z in micrometres, not wrapped into the box, at an output that has them or between two.
class Surfaces {
  constructor(surfaces) {
    Object.assign(this, {data: surfaces, first: surfaces.first, count: surfaces.first.length - 1, nodes: surfaces.first.at(-1), known: []});
    const meshes = surfaces.meshes.map(decodedTriangles), length = surfaces.mesh.reduce((sum, mesh) => sum + meshes[mesh].length, 0);
    this.triangles = new Uint32Array(length);
    this.range = [];  // of each cell's among them
    let end = 0;
    surfaces.mesh.forEach((mesh, cell) => { const begin = end; for (const node of meshes[mesh]) this.triangles[end++] = surfaces.first[cell] + node; this.range.push([begin, end]); });
  }
  /// Where each cell stands among those of the page.
  placesOf(run) {
    const places = new Map((run.cells?.ids ?? []).map((number, place) => [number, place]));
    return this.data.cells.map((number, cell) => places.get(number) ?? cell);
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
/// The lines in which a plane cuts triangles, [{xy, tension}]: closed, or open where the surface ends. `axis` = `place` is the plane, and
/// xy counts along the other two axes; `share` is a number of each node, or null.
function cutLines(places, triangles, axis, place, share, range = [0, triangles.length]) {
  const [u, v] = [0, 1, 2].filter(k => k !== axis), points = new Map(), next = new Map(), above = node => places[3 * node + axis] > place;
  const cross = (a, b) => {
    const [low, high] = a < b ? [a, b] : [b, a], key = low * 67108864 + high;
    if (!points.has(key)) {
      const p = 3 * low, q = 3 * high, s = (place - places[p + axis]) / (places[q + axis] - places[p + axis]), between = (from, to) => from + s * (to - from);
      points.set(key, [between(places[p + u], places[q + u]), between(places[p + v], places[q + v]), share ? between(share[low], share[high]) : 0]);
    }
    return key;
  };
  for (let t = range[0]; t < range[1]; t += 3) {
    const first = above(triangles[t]), second = above(triangles[t + 1]), third = above(triangles[t + 2]);
    if (first === second && second === third) continue;
    const alone = second === third ? 0 : first === third ? 1 : 2, a = triangles[t + alone], one = cross(a, triangles[t + (alone + 1) % 3]), other = cross(a, triangles[t + (alone + 2) % 3]);
    // Along every line in one sense: above at the left.
    if (above(a)) next.set(one, other); else next.set(other, one);
  }
  const lines = [], ends = new Set(next.values()), starts = [...[...next.keys()].filter(key => !ends.has(key)), ...next.keys()];
  for (const start of starts) {
    const keys = [];
    for (let key = start; key !== undefined && keys.at(-1) !== key;) { keys.push(key); const then = next.get(key); next.delete(key); key = then; if (key === start) break; }
    if (keys.length < 3) continue;
    lines.push({xy: Float32Array.from(keys.flatMap(key => points.get(key).slice(0, 2))), tension: share && Float32Array.from(keys, key => points.get(key)[2])});
  }
  return lines;
}

/// What one plane z = const cuts of a run's surfaces, where the animation of a run in the plane has outlines.
class Section {
  constructor(run, surfaces) {
    Object.assign(this, {surfaces, walls: run.walls, z: run.domain.size_um[2] / 2, length: run.domain.size_um[2], periodic: run.domain.periodic[2], places: surfaces.placesOf(run), count: run.cells?.types.length ?? surfaces.count});
  }
  /// For each cell of the page its lines; none of a cell that the plane does not meet.
  shapes(instant, withTension) {
    const {surfaces} = this, nodes = surfaces.between(instant), tension = withTension ? surfaces.tension(instant) : null, shapes = Array.from({length: this.count}, () => []);
    for (let own = 0; own < surfaces.count; ++own) {
      const [from, to] = [surfaces.first[own], surfaces.first[own + 1]];
      if (Number.isNaN(nodes[3 * from])) continue;
      let [low, high] = [Infinity, -Infinity];
      for (let i = from; i < to; ++i) { low = Math.min(low, nodes[3 * i + 2]); high = Math.max(high, nodes[3 * i + 2]); }
      const images = this.periodic ? Array.from({length: Math.max(0, Math.floor((high - this.z) / this.length) - Math.ceil((low - this.z) / this.length) + 1)}, (_, k) => Math.ceil((low - this.z) / this.length) + k) : [0];
      for (const k of images) shapes[this.places[own]].push(...cutLines(nodes, surfaces.triangles, 2, this.z + k * this.length, tension, surfaces.range[own]));
    }
    return shapes;
  }
  has(shapes, cell) { return shapes[cell].length > 0; }
  get isMiddle() { return Math.abs(this.z - this.length / 2) < 1e-6 * this.length; }
  /// Lines in which the plane cuts walls that are no planes.
  wallLines() {
    const {surface} = this.walls ?? {};
    if (!surface) return [];
    if (!this.wall) {
      const view = new DataView(bytesOf(surface.points).buffer);
      this.wall = {places: Float32Array.from({length: view.byteLength / 2}, (_, i) => view.getInt16(2 * i, true) * surface.quantum_um), triangles: decodedTriangles(surface.triangles)};
    }
    return cutLines(this.wall.places, this.wall.triangles, 2, this.z, null);
  }
}

/// What a run in space without cells has of them.
const noSurfaces = {cells: [], first: [0], there: [null], meshes: [], mesh: [], outputs: [0], origin_um: [[]], nodes: [""], quantum_um: 1, tension: {scale_N_per_m: 0, values: [""]}};

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

