// ----------------------------------------------------------------------------------- a drawing context that writes SVG
/// The part of CanvasRenderingContext2D that the animation uses, written down as SVG.
class SvgContext {
  constructor(width, height, ground) {
    Object.assign(this, {width, height, parts: [`<rect width="${width}" height="${height}" fill="${ground}"/>`], state: {matrix: [1, 0, 0, 1, 0, 0], clip: ""}, kept: [], clips: 0, path: [],
      globalAlpha: 1, lineWidth: 1, lineCap: "butt", fillStyle: "#000", strokeStyle: "#000", font: "12px sans-serif", dash: []});
  }
  text() { return `<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 ${this.width} ${this.height}" width="${this.width}" height="${this.height}">${this.parts.join("\n")}</svg>\n`; }
  /// In pixels from the left and from above.
  moved(x, y) { const [a, b, c, d, e, f] = this.state.matrix; return [a * x + c * y + e, b * x + d * y + f].map(v => Number(v.toFixed(2))); }
  /// As the file has it.
  at(x, y) { return this.moved(x, y); }
  clearRect() {}
  save() { this.kept.push({matrix: [...this.state.matrix], clip: this.state.clip}); }
  restore() { this.state = this.kept.pop(); }
  translate(x, y) { const [a, b, c, d] = this.state.matrix, [e, f] = this.moved(x, y); this.state.matrix = [a, b, c, d, e, f]; }
  scale(x, y) { const m = this.state.matrix; this.state.matrix = [m[0] * x, m[1] * x, m[2] * y, m[3] * y, m[4], m[5]]; }
  setLineDash(dash) { this.dash = dash; }
  measureText(words) { return {width: 6.6 * words.length}; }
  beginPath() { this.path = []; }
  moveTo(x, y) { this.path.push(`M${this.at(x, y).join(" ")}`); }
  lineTo(x, y) { this.path.push(`${this.path.length ? "L" : "M"}${this.at(x, y).join(" ")}`); }
  closePath() { this.path.push("Z"); }
  rect(x, y, w, h) { this.moveTo(x, y); this.lineTo(x + w, y); this.lineTo(x + w, y + h); this.lineTo(x, y + h); this.closePath(); }
  arc(x, y, r) { this.moveTo(x - r, y); for (const end of [x + r, x - r]) this.path.push(`A${r} ${r} 0 0 1 ${this.at(end, y).join(" ")}`); }
  clip() {
    const id = `clip${++this.clips}`;
    this.parts.push(`<clipPath id="${id}"><path d="${this.path.join("")}"/></clipPath>`);
    this.state.clip = ` clip-path="url(#${id})"`;
  }
  shape(how) { this.parts.push(`<path d="${this.path.join("")}" ${how}${this.globalAlpha < 1 ? ` opacity="${this.globalAlpha.toFixed(3)}"` : ""}${this.state.clip}/>`); }
  fill() { this.shape(`fill="${this.fillStyle}"`); }
  stroke() { this.shape(`fill="none" stroke="${this.strokeStyle}" stroke-width="${this.lineWidth}" stroke-linecap="${this.lineCap}" stroke-linejoin="round"${this.dash.length ? ` stroke-dasharray="${this.dash.join(" ")}"` : ""}`); }
  fillRect(x, y, w, h) { this.beginPath(); this.rect(x, y, w, h); this.fill(); }
  fillText(words, x, y) {
    const [px, py] = this.at(x, y), safe = words.replace(/[&<>]/g, c => ({"&": "&amp;", "<": "&lt;", ">": "&gt;"})[c]);
    this.parts.push(`<text x="${px}" y="${py}" font-family="sans-serif" font-size="${parseFloat(this.font.match(/[\d.]+px/) ?? "12")}" fill="${this.fillStyle}">${safe}</text>`);
  }
  drawImage(canvas, x, y, w, h) {
    const matrix = this.state.matrix.map(v => Number(v.toFixed(4))).join(" ");
    this.parts.push(`<g${this.state.clip}><image href="${canvas.toDataURL()}" transform="matrix(${matrix})" x="${x}" y="${y}" width="${w}" height="${h}" preserveAspectRatio="none" opacity="${this.globalAlpha}"/></g>`);
  }
}
