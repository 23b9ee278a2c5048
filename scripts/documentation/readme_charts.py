"""The two charts of README.md as SVG, from the tables of docs/performance.md and docs/accuracy.md: no number is typed twice."""

import math
import re

INK, QUIET, LINE = "#1d2430", "#5d6470", "#d9d9d3"
RED, BLUE, GREY = "#a3212b", "#0072b2", "#9aa0a8"


def svg(width, height, title, body):
    return (f'<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {width} {height}" width="{width}" height="{height}" '
            f'font-family="system-ui, sans-serif" font-size="13" role="img"><title>{title}</title>'
            f'<rect width="100%" height="100%" fill="#fff"/>{"".join(body)}</svg>\n')


def text(x, y, words, anchor="start", colour=INK, weight="normal", more=""):
    return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}" fill="{colour}" font-weight="{weight}"{more}>{words}</text>'


def line(x1, y1, x2, y2, colour=LINE, width=1):
    return f'<path d="M{x1:.1f} {y1:.1f}L{x2:.1f} {y2:.1f}" stroke="{colour}" stroke-width="{width}" fill="none"/>'


def only(matches, what):
    if len(matches) != 1:
        raise SystemExit(f"readme_charts: found {len(matches)} places that say {what}")
    return matches[0]


def step_times(page):
    """[(label, microseconds a step, colour)] of the four-cell scene."""
    row = only(re.findall(r"^\| \*\*whole step\*\* \|(.*)\|$", page, re.M), "what a whole step takes")
    f64, f32, avx2, _, sse2 = [float(cell.strip(" *")) for cell in row.split("|")]
    paper = float(only(re.findall(r"The paper needed ([\d ]+) us for a step", page), "what the paper needed").replace(" ", ""))
    return [("Zhang et al. 2008, as published", paper, GREY), ("Rouleau, SSE2 (any x86-64)", sse2, RED),
            ("Rouleau, AVX2", avx2, RED), ("Rouleau, AVX-512", f64, RED), ("Rouleau, AVX-512, single precision", f32, RED)]


def speed(page):
    width, left, right, top, step = 640, 256, 70, 44, 30
    bars = step_times(page)
    low, high = 1, 5  # powers of ten, us
    height = top + step * len(bars) + 34

    def at(value):
        return left + (math.log10(value) - low) / (high - low) * (width - left - right)

    body = [text(16, 24, "Time of a step: four red cells, 256 x 128 nodes, one core", weight="600")]
    for power in range(low, high + 1):
        label = ["10 us", "100 us", "1 ms", "10 ms", "100 ms"][power - low]
        body += [line(at(10**power), top, at(10**power), height - 28), text(at(10**power), height - 12, label, "middle", QUIET)]
    for place, (label, value, colour) in enumerate(bars):
        y = top + place * step
        shown = f"{value / 1000:.0f} ms" if value >= 1000 else f"{value:g} us"
        body += [text(left - 8, y + 19, label, "end"),
                 f'<rect x="{left}" y="{y + 5}" width="{at(value) - left:.1f}" height="20" fill="{colour}"/>',
                 text(at(value) + 6, y + 19, shown)]
    return svg(width, height, "Time of a step of the four-cell scene", body)


def error_curves(page):
    """{scheme: [(radius, seconds, error in percent)]} of the deformation, tau 1, Re 0.42."""
    curves = {}
    for scheme in ("plain", "corrected"):
        row = only(re.findall(rf"^\| {scheme} \| 1 \| 0\.42 \|(.*)\|$", page, re.M), f"the error of {scheme} over the run time")
        cells = [re.match(r" ([+-][\d.]+) % / \S+ deg / ([\d.]+) s ", cell + " ") for cell in row.split("|")]
        curves[scheme] = [(radius, float(cell[2]), abs(float(cell[1]))) for radius, cell in zip((10, 15, 20, 30, 40), cells)]
    return curves


def error_against_time(page):
    width, height, left, right, top, bottom = 640, 330, 74, 30, 44, 52
    x_range, y_range = (math.log10(0.1), 2), (math.log10(0.02), math.log10(3))

    def x(seconds):
        return left + (math.log10(seconds) - x_range[0]) / (x_range[1] - x_range[0]) * (width - left - right)

    def y(percent):
        return height - bottom - (math.log10(percent) - y_range[0]) / (y_range[1] - y_range[0]) * (height - top - bottom)

    body = [text(16, 24, "Error of a capsule's deformation against run time, one core", weight="600")]
    for seconds, label in ((0.1, "0.1 s"), (1, "1 s"), (10, "10 s"), (100, "100 s")):
        body += [line(x(seconds), top, x(seconds), height - bottom), text(x(seconds), height - bottom + 18, label, "middle", QUIET)]
    for percent in (0.03, 0.1, 0.3, 1, 3):
        body += [line(left, y(percent), width - right, y(percent)), text(left - 8, y(percent) + 4, f"{percent:g} %", "end", QUIET)]
    body.append(text((left + width - right) / 2, height - 12, "run time; numbers at the points: cell radius in lattice spacings",
                     "middle", QUIET))
    for (scheme, points), colour in zip(error_curves(page).items(), (BLUE, RED)):
        path = "L".join(f"{x(seconds):.1f} {y(error):.1f}" for _, seconds, error in points)
        body.append(f'<path d="M{path}" stroke="{colour}" stroke-width="2" fill="none"/>')
        for radius, seconds, error in points:
            body += [f'<circle cx="{x(seconds):.1f}" cy="{y(error):.1f}" r="4" fill="{colour}"/>',
                     text(x(seconds) + 8, y(error) - 6, radius, colour=colour)]
        _, seconds, error = points[2]
        words = {"plain": "plain scheme", "corrected": "slip and area corrected"}[scheme]
        body.append(text(x(seconds) + 36, y(error) + (-8 if scheme == "plain" else -14), words, colour=colour, weight="600"))
    return svg(width, height, "Error of a capsule's deformation against run time", body)


def write(root, folder):
    made = {"speed.svg": speed((root / "docs/performance.md").read_text()),
            "error-against-time.svg": error_against_time((root / "docs/accuracy.md").read_text())}
    for name, drawing in made.items():
        (folder / name).write_text(drawing)
    return [folder / name for name in made]
