"""The two charts of README.md, from the tables of docs/performance.md and of a page of docs/results: no number is typed twice."""

import re

import matplotlib

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402
from matplotlib.ticker import FuncFormatter, NullFormatter, NullLocator  # noqa: E402

INK, QUIET, LINE = "#1d2430", "#5d6470", "#d9d9d3"
RED, BLUE, GREY = "#a3212b", "#0072b2", "#9aa0a8"
STYLE = {
    "svg.fonttype": "none", "svg.hashsalt": "rouleau",  # text stays text; the same bytes from the same numbers
    "font.family": "sans-serif", "font.size": 10, "text.color": INK,
    "figure.titleweight": "semibold", "figure.titlesize": 11, "axes.labelcolor": QUIET,
    "axes.spines.top": False, "axes.spines.right": False, "axes.spines.bottom": False, "axes.spines.left": False,
    "axes.grid": True, "axes.axisbelow": True, "grid.color": LINE,
    "xtick.color": LINE, "ytick.color": LINE, "xtick.labelcolor": QUIET, "ytick.labelcolor": QUIET,
}


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


def plot(title, height):
    figure, axes = pyplot.subplots(figsize=(8, height), layout="constrained")
    figure.suptitle(title, x=0.01, horizontalalignment="left")
    return figure, axes


def microseconds(value, _=None):
    return f"{value / 1000:g} ms" if value >= 1000 else f"{value:g} us"


def speed(page):
    labels, times, colours = zip(*step_times(page))
    figure, axes = plot("Time of a step: four red cells, 256 x 128 nodes, one core", 2.6)
    bars = axes.barh(labels, times, color=colours, height=0.65)
    axes.bar_label(bars, [microseconds(float(f"{time:.3g}")) for time in times], padding=4)
    axes.set(xscale="log", xlim=(10, 1e5))
    axes.invert_yaxis()
    axes.grid(False, axis="y")
    axes.tick_params(axis="y", labelcolor=INK)
    axes.xaxis.set_major_formatter(FuncFormatter(microseconds))
    axes.xaxis.set_minor_locator(NullLocator())
    return figure


def error_curves(page):
    """{scheme: [(radius, seconds, error in percent)]} of the deformation, tau 1, Re 0.42."""
    curves = {}
    for scheme in ("plain", "corrected"):
        row = only(re.findall(rf"^\| {scheme} \| 1 \| 0\.42 \|(.*)\|$", page, re.M), f"the error of {scheme} over the run time")
        cells = [re.match(r" ([+-][\d.]+) % / \S+ deg / ([\d.]+) s ", cell + " ") for cell in row.split("|")]
        curves[scheme] = [(radius, float(cell[2]), abs(float(cell[1]))) for radius, cell in zip((10, 15, 20, 30, 40), cells)]
    return curves


def error_against_time(page):
    words = {"plain": "plain scheme", "corrected": "slip and area corrected"}
    figure, axes = plot("Error of a capsule's deformation against run time, one core", 3.8)
    for (scheme, points), colour in zip(error_curves(page).items(), (BLUE, RED)):
        radii, seconds, errors = zip(*points)
        axes.loglog(seconds, errors, "o-", color=colour, linewidth=1.6, markersize=6)
        for radius, second, error in points:
            axes.annotate(radius, (second, error), (6, 5), textcoords="offset points", color=colour)
        axes.annotate(words[scheme], (seconds[2], errors[2]), (30, 14), textcoords="offset points", color=colour, weight="semibold")
    axes.set(xlabel="run time; numbers at the points: cell radius in lattice spacings",
             xlim=(0.1, 100), ylim=(0.02, 3), yticks=(0.03, 0.1, 0.3, 1, 3))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g} s"))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g} %"))
    for axis in (axes.xaxis, axes.yaxis):
        axis.set_minor_formatter(NullFormatter())
    return figure


def write(root, folder):
    written = []
    with matplotlib.rc_context(STYLE):
        for name, draw, page in (("speed", speed, "performance"), ("error-against-time", error_against_time, "results/error-against-time-2d")):
            figure = draw((root / f"docs/{page}.md").read_text())
            written.append(folder / f"{name}.svg")
            figure.savefig(written[-1], metadata={"Date": None})
            pyplot.close(figure)
    return written
