// ---------------------------------------------------------------------------------------------------------- animation
/// The outlines of a run's cells at the timeline's instant, with the flow under them.
class Animation {
  constructor(parent, timeline, run, chosen) {
    const data = timeline.runs[run];
    Object.assign(this, {timeline, run, data, chosen, outlines: data.outlines, fields: data.fields && new Fields(data.fields)});
    [this.lx, this.ly] = data.domain.size_um;
    this.canvas = element("canvas", {class: "view", role: "img", "aria-label": "Outlines of the cells"});
    this.bar = element("div", {class: "bar"});
    parent.append(this.canvas, this.bar);
    timeline.listeners.push(() => this.draw());
    new ResizeObserver(() => { if (this.canvas.clientWidth !== this.width) this.draw(); }).observe(this.canvas);
  }

  draw() {
    const {canvas, lx, ly, timeline} = this, output = timeline.output(this.run), margin = 6;
    const width = this.width = canvas.clientWidth || 340, most = Math.max(240, innerHeight * 0.7);
    const scale = Math.min((width - 2 * margin) / lx, (most - 2 * margin) / ly), height = ly * scale + 2 * margin;
    const fine = printing ? 3 : window.devicePixelRatio || 1;
    canvas.width = Math.round(width * fine); canvas.height = Math.round(height * fine);
    canvas.style.height = `${height}px`;
    const context = canvas.getContext("2d");
    context.setTransform(fine, 0, 0, fine, 0, 0);
    context.clearRect(0, 0, width, height);
    context.translate((width - lx * scale) / 2, height - margin); context.scale(1, -1);  // y upwards, from the domain's lower left corner
    context.save();
    context.beginPath(); context.rect(0, 0, lx * scale, ly * scale); context.clip();
    const under = this.drawField(context, output, scale);
    if (this.outlines) this.drawCells(context, output, scale, under);
    if (this.failed(output)) this.drawFailure(context, scale);
    context.restore();
    this.drawFrame(context, scale);
  }

  /// Whether a diverged run shows its last output, so that the place where it went bad is marked.
  failed(output) { return output === this.data.step.length - 1 && (this.data.summary?.failure?.place_m || []).length === 2 && this.data.summary.failure.place_m.every(v => v !== null); }
  drawFailure(context, scale) {
    const inBox = (v, length) => v - Math.floor(v / length) * length, [x, y] = this.data.summary.failure.place_m.map(v => v * 1e6);
    const at = [inBox(x, this.lx) * scale, (this.data.domain.periodic_y ? inBox(y, this.ly) : y) * scale];
    for (const [colour, width] of [["--card", 6], ["--bad", 2.5]]) {
      context.strokeStyle = css(colour); context.lineWidth = width;
      context.beginPath(); context.arc(...at, 11, 0, 2 * Math.PI); context.stroke();
      context.beginPath();
      for (const [dx, dy] of [[1, 0], [0, 1], [-1, 0], [0, -1]]) { context.moveTo(at[0] + 7 * dx, at[1] + 7 * dy); context.lineTo(at[0] + 16 * dx, at[1] + 16 * dy); }
      context.stroke();
    }
  }

  drawField(context, output, scale) {
    this.bar.replaceChildren();
    const quantity = this.fields?.quantity(this.chosen());
    if (!quantity) return false;
    const index = this.fields.index(output);
    if (index < 0) { this.bar.replaceChildren(...colourBar(quantity, "none written yet")); return false; }
    const of = this.fields.fields.outputs[index], {over, runs} = this.timeline;
    const stale = of === output ? "" : over === "strain" && grows(runs[this.run]) && this.data.strain[of] !== this.data.strain[output]
      ? `of strain ${format(this.data.strain[of], 3)}, the last written` : `of ${format(this.data.time_s[of], 4)} s, the last written`;
    context.imageSmoothingEnabled = true;
    context.drawImage(this.fields.picture(quantity.name, index), ...this.fields.fields.box_um.map(length => length * scale));
    this.bar.replaceChildren(...colourBar(quantity, stale));
    return true;
  }

  drawCells(context, output, scale, under) {
    const {outlines, data, lx, ly} = this, view = new DataView(bytesOf(outlines.nodes[output]).buffer), origins = outlines.origin_um[output];
    for (let cell = 0; cell + 1 < outlines.first.length; ++cell) {
      const ring = [];
      for (let i = outlines.first[cell]; i < outlines.first[cell + 1]; ++i)
        ring.push([origins[2 * cell] + view.getInt16(4 * i, true) * outlines.quantum_um, origins[2 * cell + 1] + view.getInt16(4 * i + 2, true) * outlines.quantum_um]);
      const base = [-Math.floor(origins[2 * cell] / lx) * lx, outlines.periodic_y ? -Math.floor(origins[2 * cell + 1] / ly) * ly : 0];
      const tone = css(toneOf(data.cells ? data.cells.aggregate[output][cell] : cell)), bad = this.failed(output) && data.summary.failure.cell === cell;
      // The image in the box and its neighbours: what leaves on one side enters on the other.
      for (const ix of [-1, 0, 1]) for (const iy of outlines.periodic_y ? [-1, 0, 1] : [0]) {
        context.beginPath();
        for (const [x, y] of ring) context.lineTo((x + base[0] + ix * lx) * scale, (y + base[1] + iy * ly) * scale);
        context.closePath();
        context.globalAlpha = under ? 0.45 : 0.28; context.fillStyle = tone; context.fill();
        context.globalAlpha = 1;
        if (under) { context.strokeStyle = css("--card"); context.lineWidth = 4; context.stroke(); }
        context.strokeStyle = bad ? css("--bad") : tone; context.lineWidth = bad ? 3 : under ? 2 : 1.6; context.stroke();
      }
    }
  }

  /// Walls as thick lines, periodic borders as dashes, and a bar for the scale.
  drawFrame(context, scale) {
    const {lx, ly, data} = this, periodic = data.domain.periodic_y;
    const edge = (solid, ...points) => {
      context.beginPath(); context.setLineDash(solid ? [] : [5, 4]); context.lineWidth = solid ? 3 : 1;
      context.strokeStyle = css(solid ? "--text" : "--quiet");
      context.moveTo(points[0], points[1]); context.lineTo(points[2], points[3]); context.stroke(); context.setLineDash([]);
    };
    edge(false, 0, 0, 0, ly * scale); edge(false, lx * scale, 0, lx * scale, ly * scale);
    edge(!periodic, 0, 0, lx * scale, 0); edge(!periodic, 0, ly * scale, lx * scale, ly * scale);
    const bar = [0.1, 0.2, 0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500, 1000].filter(b => b <= lx / 4).pop() || lx / 4, words = `${format(bar)} µm`;
    context.scale(1, -1); context.font = "12px system-ui, sans-serif";
    context.fillStyle = css("--card"); context.globalAlpha = 0.8;
    context.fillRect(5, -33, Math.max(bar * scale, context.measureText(words).width) + 10, 27);
    context.globalAlpha = 1;
    context.fillStyle = context.strokeStyle = css("--text"); context.lineWidth = 2;
    context.fillText(words, 10, -17);
    context.beginPath(); context.moveTo(10, -11); context.lineTo(10 + bar * scale, -11); context.stroke();
  }
}

/// Play, scrub, speed and what lies under the cells, for all animations of the page.
function animationControls(timeline, animations, chosen) {
  const slider = element("input", {type: "range", min: 0, max: Math.max(0, timeline.count - 1), value: 0, "aria-label": "Instant",
    oninput: () => { timeline.stop(); timeline.seek(Number(slider.value)); }});
  const speed = element("select", {}, ...[["0.25", "¼×"], ["0.5", "½×"], ["1", "1×"], ["2", "2×"], ["4", "4×"]].map(([v, t]) => element("option", {value: v}, t)));
  speed.value = "1";
  const changed = () => { play.textContent = timeline.playing ? "Pause" : "Play"; };
  const play = element("button", {type: "button", onclick: () => timeline.playing ? timeline.stop() : timeline.play(() => Number(speed.value), changed)}, "Play");
  const controls = element("div", {class: "controls"}, play, slider, element("label", {}, "Speed", speed));
  const names = [...new Set(animations.flatMap(a => a.data.fields ? a.data.fields.quantities.map(q => q.name) : []))];
  if (names.length) {
    const under = element("select", {onchange: () => { chosen.name = under.value; for (const a of animations) a.draw(); }},
      element("option", {value: ""}, "none"), ...names.map(name => element("option", {value: name}, fieldTitles[name])));
    under.value = chosen.name;
    controls.append(element("label", {}, "Flow", under));
  }
  timeline.listeners.push(() => {
    slider.max = Math.max(0, timeline.count - 1);
    slider.value = timeline.position;
    slider.setAttribute("aria-valuetext", timeline.words);
  });
  return controls;
}

/// What the mark in a diverged run's animation means.
function failureNote(run) {
  const failure = (run.summary || {}).failure;
  if (!failure?.place_m || !run.step.length || !(run.outlines || run.fields)) return [];
  const last = run.step.at(-1), cell = run.outlines && typeof failure.cell === "number" ? ", the red outline the cell" : "";
  return [note(`At the last instant the red ring marks the place where the run diverged${cell}` + (last < failure.step ? `: at step ${format(failure.step)}, while what is drawn is of step ${format(last)}, the last written.` : "."))];
}

/// Strain, time, step and stage that a run shows.
function instantLine(timeline, run) {
  const data = timeline.runs[run], words = [element("span"), element("span"), element("span"), element("span")];
  timeline.listeners.push(() => {
    const i = timeline.output(run);
    const texts = [`strain ${format(data.strain[i], 3)}`, `${format(data.time_s[i], 4)} s`, `step ${format(data.step[i])}`, `stage ${data.stage[i]}`];
    texts.forEach((text, k) => { words[k].textContent = text; });
  });
  return element("div", {class: "now"}, ...words);
}
