// ----------------------------------------------------------------------------------- a drawing context that writes PDF
/// Characters of WinAnsi that Unicode has elsewhere, and words for those that it lacks.
const pdfLetters = {"−": "\x96", "–": "\x96", "—": "\x97", "…": "\x85", "’": "\x92", "“": "\x93", "”": "\x94", "\u202f": "\xa0", "μ": "\xb5", "≤": "<=", "≥": ">=", "⁻": "-", "⁰": "0", "⁴": "4", "⁵": "5", "⁶": "6", "⁷": "7", "⁸": "8", "⁹": "9"};
const pdfText = text => [...text].map(c => pdfLetters[c] ?? (c.charCodeAt(0) < 256 && c.length === 1 ? c : "?")).join("").replace(/[\\()]/g, "\\$&");

/// As SvgContext, for one page of PDF: lines and letters stay such, pictures are JPEG.
class PdfContext extends SvgContext {
  constructor(width, height) {
    super(width, height, "#fff");
    Object.assign(this, {parts: [], images: [], alphas: [], measure: document.createElement("canvas").getContext("2d")});
  }
  at(x, y) { const [px, py] = this.moved(x, y); return [px, Number((this.height - py).toFixed(2))]; }
  measureText(words) { this.measure.font = `${this.size}px Helvetica, Arial, sans-serif`; return this.measure.measureText(words); }
  get size() { return parseFloat(this.font.match(/[\d.]+px/) ?? "12"); }
  moveTo(x, y) { this.path.push(`${this.at(x, y).join(" ")} m`); }
  lineTo(x, y) { this.path.push(`${this.at(x, y).join(" ")} ${this.path.length ? "l" : "m"}`); }
  closePath() { this.path.push("h"); }
  arc(x, y, r) {
    const k = .5523 * r, to = (...places) => this.path.push(`${places.map(([px, py]) => this.at(px, py).join(" ")).join(" ")} c`);
    this.moveTo(x + r, y);
    to([x + r, y + k], [x + k, y + r], [x, y + r]); to([x - k, y + r], [x - r, y + k], [x - r, y]); to([x - r, y - k], [x - k, y - r], [x, y - r]); to([x + k, y - r], [x + r, y - k], [x + r, y]);
  }
  clip() { this.state.clip += `${this.path.join(" ")} W n `; }
  tone(colour) { return rgbOf(colour).map(v => Number(v.toFixed(3))).join(" "); }
  /// What comes before a mark: where it may be, and how much it covers.
  open() {
    if (!(this.globalAlpha < 1)) return `q ${this.state.clip}`;
    const alpha = this.globalAlpha.toFixed(2), known = this.alphas.indexOf(alpha), number = known < 0 ? this.alphas.push(alpha) - 1 : known;
    return `q ${this.state.clip}/A${number} gs `;
  }
  fill() { this.parts.push(`${this.open()}${this.tone(this.fillStyle)} rg ${this.path.join(" ")} f Q`); }
  stroke() { this.parts.push(`${this.open()}${this.tone(this.strokeStyle)} RG ${this.lineWidth} w ${this.lineCap === "round" ? 1 : 0} J 1 j [${this.dash.join(" ")}] 0 d ${this.path.join(" ")} S Q`); }
  fillText(words, x, y) { this.parts.push(`${this.open()}BT ${this.tone(this.fillStyle)} rg /${/\b[67]00\b/.test(this.font) ? "B" : "F"} ${this.size} Tf ${this.at(x, y).join(" ")} Td (${pdfText(words)}) Tj ET Q`); }
  drawImage(canvas, x, y, w, h) {
    const ground = Object.assign(document.createElement("canvas"), {width: canvas.width, height: canvas.height}), context = ground.getContext("2d"), [a, b, c, d, e, f] = this.state.matrix;
    context.fillStyle = "#fff"; context.fillRect(0, 0, ground.width, ground.height); context.drawImage(canvas, 0, 0);
    this.images.push({width: ground.width, height: ground.height, data: atob(ground.toDataURL("image/jpeg", .94).split(",")[1])});
    const place = [a * w, -b * w, -c * h, d * h, a * x + c * (y + h) + e, this.height - (b * x + d * (y + h) + f)].map(v => Number(v.toFixed(3))).join(" ");
    this.parts.push(`${this.open()}${place} cm /I${this.images.length - 1} Do Q`);
  }
  /// The file, in bytes.
  bytes(title) {
    const {width, height, images, alphas} = this, page = this.parts.join("\n"), stream = (head, data) => `<<${head}/Length ${data.length}>>\nstream\n${data}\nendstream`;
    const font = name => `<</Type/Font/Subtype/Type1/BaseFont/${name}/Encoding/WinAnsiEncoding>>`;
    const objects = ["<</Type/Catalog/Pages 2 0 R>>", "<</Type/Pages/Kids[3 0 R]/Count 1>>",
      `<</Type/Page/Parent 2 0 R/MediaBox[0 0 ${width} ${height}]/Contents 4 0 R/Resources<</Font<</F 5 0 R/B 6 0 R>>/ExtGState<<${alphas.map((alpha, i) => `/A${i}<</ca ${alpha}/CA ${alpha}>>`).join("")}>>/XObject<<${images.map((_, i) => `/I${i} ${8 + i} 0 R`).join("")}>>>>>>`,
      stream("", page), font("Helvetica"), font("Helvetica-Bold"), `<</Title(${pdfText(title)})/Creator(Rouleau)>>`,
      ...images.map(image => stream(`/Type/XObject/Subtype/Image/Width ${image.width}/Height ${image.height}/ColorSpace/DeviceRGB/BitsPerComponent 8/Filter/DCTDecode`, image.data))];
    let file = "%PDF-1.4\n%\xe2\xe3\xcf\xd3\n";
    const places = objects.map((object, i) => { const at = file.length; file += `${i + 1} 0 obj\n${object}\nendobj\n`; return at; }), table = file.length;
    file += `xref\n0 ${objects.length + 1}\n0000000000 65535 f \n${places.map(at => `${String(at).padStart(10, "0")} 00000 n \n`).join("")}trailer\n<</Size ${objects.length + 1}/Root 1 0 R/Info 7 0 R>>\nstartxref\n${table}\n%%EOF\n`;
    return Uint8Array.from(file, c => c.charCodeAt(0));
  }
}
