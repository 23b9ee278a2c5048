"""Pages of sweeps and calibrations: HTML with tables and charts, without script and network."""

from __future__ import annotations

import dataclasses
import html
import math
import os
import pathlib
from typing import Any, Iterable, Sequence

STYLE = """body { font: 15px/1.5 system-ui, sans-serif; max-width: 72rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; font-variant-numeric: tabular-nums; } th, td { padding: .2rem .8rem; text-align: right; white-space: nowrap; }
th { border-bottom: 1px solid; } div.wide { overflow-x: auto; } svg { max-width: 100%; height: auto; margin: .5rem 1rem .5rem 0; }
text { font: 12px system-ui, sans-serif; fill: currentColor; } .verdict { font-size: 1.2rem; }
@media (prefers-color-scheme: dark) { body { background: #16181c; color: #e4e6ea; } a { color: #8ab4f8; } }"""
COLOURS = ("#c8372d", "#2d6fc8", "#2f9150", "#a35cc0", "#c78a1b", "#3aa7a7")
WIDTH, HEIGHT, LEFT, BELOW, TOP, RIGHT = 520, 320, 70, 46, 14, 14


@dataclasses.dataclass(frozen=True)
class Line:
    """Points of a chart, with bars, joined or not."""

    label: str
    x: Sequence[float]
    y: Sequence[float]
    bars: Sequence[float] = ()
    joined: bool = True
    points: bool = True
    colour: int | None = None  # of COLOURS; None: one after another


def number(value: Any, digits: int = 4) -> str:
    """A number as a table shows it; other values as text."""
    if isinstance(value, bool) or not isinstance(value, (int, float)):
        return str(value)
    return "" if isinstance(value, float) and math.isnan(value) else f"{value:.{digits}g}"


def with_bar(value: float, error: float) -> str:
    """"2.17 ± 0.21": two digits of the error, and as many places of the value."""
    if not math.isfinite(error) or error <= 0:
        return number(value) + ("" if error == 0 else " (bar unknown)")
    places = 1 - math.floor(math.log10(error))
    size = max(abs(value), error)
    if not 1e-3 <= size < 1e5:
        power = math.floor(math.log10(size))
        places = max(0, places + power)
        return f"({value / 10.0 ** power:.{places}f} ± {error / 10.0 ** power:.{places}f}) × 10^{power}"
    return f"{round(value, places):.{max(0, places)}f} ± {round(error, places):.{max(0, places)}f}"


def table(names: Sequence[str], rows: Iterable[Sequence[Any]]) -> str:
    """An HTML table."""
    head = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = "".join("<tr>" + "".join(f"<td>{html.escape(number(value))}</td>" for value in row) + "</tr>\n" for row in rows)
    return f'<div class="wide"><table><thead><tr>{head}</tr></thead><tbody>\n{body}</tbody></table></div>\n'


def _ticks(low: float, high: float) -> list[float]:
    step = 10.0 ** math.floor(math.log10((high - low) / 4))
    step *= next(factor for factor in (1, 2, 5, 10) if (high - low) / (factor * step) <= 6)
    return [step * k for k in range(math.ceil(low / step - 1e-9), math.floor(high / step + 1e-9) + 1)]


def chart(lines: Sequence[Line], x_label: str, y_label: str, level: tuple[float, float] | None = None) -> str:
    """An SVG of points with bars. The x axis is logarithmic where positive values go over a factor of 30. `level`: a
    value and its error, drawn as a band across."""
    xs = [x for line in lines for x, y in zip(line.x, line.y) if math.isfinite(x) and math.isfinite(y)]
    ys = [y + sign * bar for line in lines for y, bar in zip(line.y, line.bars or [0.0] * len(line.y)) for sign in (-1, 1)
          if math.isfinite(y) and math.isfinite(bar)]
    ys += [level[0] - level[1], level[0] + level[1]] if level else []
    if not xs or not ys:
        return ""
    logarithmic = min(xs) > 0 and max(xs) / min(xs) >= 30

    def along(x: float) -> float:
        return math.log10(x) if logarithmic else x

    def widened(low: float, high: float) -> tuple[float, float]:
        margin = 0.06 * (high - low) or 0.5 * abs(low) or 1.0
        return low - margin, high + margin

    (x0, x1), (y0, y1) = widened(along(min(xs)), along(max(xs))), widened(min(ys), max(ys))

    def px(x: float) -> float:
        return LEFT + (along(x) - x0) / (x1 - x0) * (WIDTH - LEFT - RIGHT)

    def py(y: float) -> float:
        return HEIGHT - BELOW - (y - y0) / (y1 - y0) * (HEIGHT - BELOW - TOP)

    def text(x: float, y: float, words: str, anchor: str, more: str = "") -> str:
        return f'<text x="{x:.1f}" y="{y:.1f}" text-anchor="{anchor}"{more}>{html.escape(words)}</text>'

    def bar_of(x: float, low: float, high: float, colour: str) -> str:
        return f'<path d="M{x:.1f} {low:.1f}V{high:.1f}m-3 0h6M{x - 3:.1f} {low:.1f}h6" stroke="{colour}" fill="none"/>'

    drawn = [f'<svg viewBox="0 0 {WIDTH} {HEIGHT}" width="{WIDTH}" height="{HEIGHT}" role="img" '
             f'aria-label="{html.escape(y_label)} over {html.escape(x_label)}">',
             f'<path d="M{LEFT} {TOP}V{HEIGHT - BELOW}H{WIDTH - RIGHT}" stroke="currentColor" fill="none"/>']
    if level:
        top, height = py(level[0] + level[1]), max(1.0, py(level[0] - level[1]) - py(level[0] + level[1]))
        drawn.append(f'<rect x="{LEFT}" y="{top:.1f}" width="{WIDTH - LEFT - RIGHT}" height="{height:.1f}" fill="#888" opacity=".3"/>')
    powers = range(math.ceil(x0), math.floor(x1) + 1)
    marks = [10.0 ** p for p in powers] if logarithmic and len(powers) > 1 else \
        [x for x in _ticks(10 ** x0 if logarithmic else x0, 10 ** x1 if logarithmic else x1) if x > 0 or not logarithmic]
    drawn += [text(px(x), HEIGHT - BELOW + 17, f"{x:.6g}", "middle") for x in marks]
    drawn += [text(LEFT - 6, py(y) + 4, f"{y:.6g}", "end") for y in _ticks(y0, y1)]
    drawn.append(text((LEFT + WIDTH - RIGHT) / 2, HEIGHT - 8, x_label, "middle"))
    drawn.append(text(0, 0, y_label, "middle", f' transform="translate(14 {(HEIGHT - BELOW + TOP) / 2:.0f}) rotate(-90)"'))
    for k, line in enumerate(lines):
        colour = COLOURS[(k if line.colour is None else line.colour) % len(COLOURS)]
        places = [(px(x), py(y)) for x, y in zip(line.x, line.y) if math.isfinite(x) and math.isfinite(y)]
        if line.joined and len(places) > 1:
            way = "L".join(f"{x:.1f} {y:.1f}" for x, y in sorted(places))
            drawn.append(f'<path d="M{way}" stroke="{colour}" fill="none" stroke-width="1.5"/>')
        drawn += [bar_of(px(x), py(y - bar), py(y + bar), colour) for x, y, bar in zip(line.x, line.y, line.bars)
                  if math.isfinite(x) and math.isfinite(y) and math.isfinite(bar)]
        drawn += [f'<circle cx="{x:.1f}" cy="{y:.1f}" r="3.5" fill="{colour}"/>' for x, y in places] if line.points else []
        if line.label:
            top = TOP + 16 * sum(bool(before.label) for before in lines[:k])
            drawn.append(f'<rect x="{LEFT + 10}" y="{top}" width="10" height="10" fill="{colour}"/>')
            drawn.append(text(LEFT + 26, top + 9, line.label, "start"))
    return "".join(drawn) + "</svg>\n"


def write_page(path: pathlib.Path, title: str, parts: Iterable[str]) -> pathlib.Path:
    """Writes a page whole or not at all."""
    body = "".join(parts)
    text = (f'<!doctype html>\n<html lang="en"><meta charset="utf-8"><meta name="viewport" content="width=device-width">'
            f"<title>{html.escape(title)}</title><style>{STYLE}</style>\n<h1>{html.escape(title)}</h1>\n{body}</html>\n")
    write_whole(path, text)
    return path


def write_whole(path: pathlib.Path, text: str) -> None:
    """Writes a file whole or not at all, and makes its folder."""
    path.parent.mkdir(parents=True, exist_ok=True)
    replace_file(path, text.encode())


def replace_file(path: pathlib.Path, content: bytes) -> None:
    """The same in a folder that is there. Nothing is left beside it where that fails."""
    partial = path.with_name(f".{path.name}.partial")
    try:
        partial.write_bytes(content)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def link(path: pathlib.Path | str, page: pathlib.Path) -> str:
    """A link from a page to a run's report, relative."""
    relative = os.path.relpath(pathlib.Path(path) / "report.html", page.parent)
    return f'<a href="{html.escape(relative)}">{html.escape(pathlib.Path(path).name)}</a>'
