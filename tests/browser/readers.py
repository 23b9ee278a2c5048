"""What keeps somebody from reading a page: contrast, names, keys, headings (as Lighthouse and WCAG 2.1 AA have them), and colours
as they look without one kind of cones."""
import math

# Linear RGB as it is seen without one kind of cones (Machado, Oliveira and Fernandes 2009, severity 1).
EYES = {"all": ((1, 0, 0), (0, 1, 0), (0, 0, 1)),
        "protan": ((0.152286, 1.052583, -0.204868), (0.114503, 0.786281, 0.099216), (-0.003882, -0.048116, 1.051998)),
        "deutan": ((0.367322, 0.860646, -0.227968), (0.280085, 0.672501, 0.047413), (-0.011820, 0.042940, 0.968881)),
        "tritan": ((1.255528, -0.076749, -0.178779), (-0.078411, 0.930809, 0.147602), (0.004733, 0.691367, 0.303900))}


def linear(text):
    values = [int(text[i:i + 2], 16) / 255 for i in (1, 3, 5)]
    return [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4 for v in values]


def contrast(a, b):
    low, high = sorted(sum(w * v for w, v in zip((0.2126, 0.7152, 0.0722), linear(colour))) for colour in (a, b))
    return (high + 0.05) / (low + 0.05)


def difference(a, b, eye):
    """How far apart two colours ("#rrggbb") look to an eye (CIE 1976)."""
    return math.dist(lab(a, eye), lab(b, eye))


def lab(colour, eye):
    r, g, b = (min(1, max(0, sum(m * v for m, v in zip(row, linear(colour))))) for row in EYES[eye])
    x, y, z = 0.4124 * r + 0.3576 * g + 0.1805 * b, 0.2126 * r + 0.7152 * g + 0.0722 * b, 0.0193 * r + 0.1192 * g + 0.9505 * b
    f = [t ** (1 / 3) if t > 0.008856 else 7.787 * t + 16 / 116 for t in (x / 0.95047, y, z / 1.08883)]
    return 116 * f[1] - 16, 500 * (f[0] - f[1]), 200 * (f[1] - f[2])


OBSTACLES = r"""(() => {
  const found = [], seen = e => e.getClientRects().length > 0 && getComputedStyle(e).visibility === "visible", about = e => e.outerHTML.slice(0, 140);
  const colour = text => { const [r, g, b, a = 1] = text.match(/[\d.]+/g).map(Number); return {rgb: [r, g, b], a}; };
  const over = (top, below) => top.rgb.map((v, i) => top.a * v + (1 - top.a) * below[i]);
  const ground = e => {  // what lies under an element, from the page up
    const layers = [];
    for (let p = e; p; p = p.parentElement) { const c = getComputedStyle(p).backgroundColor; layers.unshift(colour(c === "" ? "rgba(0, 0, 0, 0)" : c)); }
    return layers.reduce((below, layer) => over(layer, below), [255, 255, 255]);
  };
  const opacity = e => { let o = 1; for (let p = e; p; p = p.parentElement) o *= Number(getComputedStyle(p).opacity); return o; };
  const luminance = rgb => rgb.map(v => v / 255).map(v => v <= .04045 ? v / 12.92 : ((v + .055) / 1.055) ** 2.4).reduce((sum, v, i) => sum + v * [.2126, .7152, .0722][i], 0);
  for (const e of document.body.querySelectorAll("*")) {
    if (!seen(e) || e.closest("option, script, style, noscript") || ![...e.childNodes].some(n => n.nodeType === 3 && n.textContent.trim())) continue;
    const style = getComputedStyle(e), below = ground(e), ink = colour(e instanceof SVGElement ? style.fill : style.color);
    ink.a *= opacity(e);
    const [low, high] = [luminance(over(ink, below)), luminance(below)].sort((a, b) => a - b), ratio = (high + .05) / (low + .05), size = parseFloat(style.fontSize);
    if (ratio < (size >= 24 || (size >= 18.6 && Number(style.fontWeight) >= 700) ? 3 : 4.5)) found.push(`contrast ${ratio.toFixed(2)}: ${about(e)}`);
  }
  for (const e of document.querySelectorAll("button, select, input, summary, canvas.view, [role=group], [role=tablist], [role=tabpanel], [role=img], nav"))
    if (!(e.ariaLabel || e.textContent.trim() || e.title || [...e.labels ?? []].some(label => label.textContent.trim()))) found.push(`no name: ${about(e)}`);
  const keys = "a[href], button, select, input, textarea, summary, label, [tabindex]";
  for (const e of document.body.querySelectorAll("*"))
    if (seen(e) && getComputedStyle(e).cursor === "pointer" && !e.closest(keys) && !e.querySelector(keys)) found.push(`out of the keyboard's reach: ${about(e)}`);
  const ids = [...document.querySelectorAll("[id]")].map(e => e.id);
  found.push(...ids.filter((id, i) => ids.indexOf(id) !== i).map(id => `twice: id ${id}`));
  let level = 0;
  for (const e of [...document.querySelectorAll("h1, h2, h3, h4")].filter(seen)) { const now = Number(e.tagName[1]); if (now > level + 1) found.push(`level ${now} follows ${level}: ${about(e)}`); level = now; }
  for (const [what, count] of [["html[lang=en]", 1], ["h1", 1], ["main", 1], ["meta[name=viewport]", 1]]) if (document.querySelectorAll(what).length !== count) found.push(`not one ${what}`);
  if (!document.title) found.push("no title");
  return [...new Set(found)];
})()"""


def obstacles(page):
    """In words; an empty list where there is none."""
    return page.run(OBSTACLES)
