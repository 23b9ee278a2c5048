"""Shapes of walls from arrays and drawings, as a scene has them."""

from __future__ import annotations

import math
import numbers
import os
import pathlib
import re
import struct
import zlib
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Sequence
from xml.etree import ElementTree

from .errors import Error, Fault
from .scenes import floats

if TYPE_CHECKING:
    import numpy
    from numpy.typing import ArrayLike, NDArray

    Floats = NDArray[numpy.float64]

Shape = dict[str, Any]


def outline(points_m: ArrayLike, lower: Any = None, upper: Any = None) -> Shape:
    """The shape that a polygon encloses: `points_m` [n, 2], x and y of its corners in m, in either sense, the last joined to
    the first. In three dimensions it reaches along z from `lower` to `upper` (m, or text with a unit), without them through
    all of the domain."""
    points = _corners(points_m)
    heights = {"lower": lower, "upper": upper}
    return {"outline": {"points": points.tolist(), **{key: value for key, value in heights.items() if value is not None}}}


def mask(values: ArrayLike, path: str | os.PathLike[str], pixel: Any, at: Any = None, spacing: Any = None) -> Shape:
    """The shape that an array makes, written as a PNG. `values` [ny, nx] have the lowest row first, as fields do. Fluid may be
    where they are True or 1, for `within` and for obstacles alike, and not where they are False or 0. The border runs where
    they pass 0.5. `pixel` is the distance of two values (m, or text with a unit), `at` the lower left corner of the picture
    in the domain, [0, 0] without it. In three dimensions values [nz, ny, nx] make a picture for each layer, `spacing` apart,
    with numbers in their names."""
    import numpy
    grey = floats("this is no mask", values, "give values [ny, nx] or [nz, ny, nx] from 0 to 1")
    if grey.ndim not in (2, 3) or 0 in grey.shape or not ((grey >= 0) & (grey <= 1)).all():
        raise Error(Fault(f"an array of shape {list(grey.shape)} is no mask, or has values that are not from 0 to 1",
                          "give values [ny, nx] or [nz, ny, nx] from 0 to 1"))
    if (grey.ndim == 3) != (spacing is not None):
        raise Error(Fault("the spacing of layers belongs to values [nz, ny, nx], and to these alone", "give both, or neither"))
    path = pathlib.Path(path)
    files = [path] if grey.ndim == 2 else [path.with_name(f"{path.stem}-{k:04}{path.suffix}") for k in range(len(grey))]
    for file, layer in zip(files, grey[None] if grey.ndim == 2 else grey):
        file.write_bytes(png([row.tobytes() for row in numpy.rint(255 * layer).astype(numpy.uint8)]))
    more = {"at": at, "spacing": spacing}
    return {"image": {"file": os.fspath(files[0]) if grey.ndim == 2 else [os.fspath(file) for file in files], "pixel": pixel, "fluid": "light",
                      **{key: value for key, value in more.items() if value is not None}}}


def vessel(polygons_m: Sequence[ArrayLike]) -> Shape:
    """The keys of a scene's `domain` for fluid inside of polygons [n, 2] in m: a polygon within another is an obstacle. Throws
    Error where polygons lie in each other three deep."""
    import numpy
    corners = [_corners(polygon) for polygon in polygons_m] if isinstance(polygons_m, Iterable) else []
    depth = [sum(_holds(other, polygon[0]) for other in corners if not numpy.array_equal(other, polygon)) for polygon in corners]
    if not corners or max(depth) > 1:
        raise Error(Fault("no polygons" if not corners else f"polygon {depth.index(max(depth))} lies in an obstacle",
                          "give the vessel's outline, and in it obstacles"))
    outer, inner = ([outline(polygon) for polygon, of_it in zip(corners, depth) if of_it == wanted] for wanted in (0, 1))
    within = outer[0] if len(outer) == 1 else {"union": outer}
    return {"walls": {"within": within}, **({"obstacles": inner} if inner else {})}


def polygons(path: str | os.PathLike[str], unit_m: float = 1e-6, deviation: float = 0.1) -> list[Floats]:
    """The closed lines of a drawing, .dxf or .svg, as polygons [n, 2] in m, in its order. `unit_m`: a unit of the drawing, in m.
    Curves become straight pieces, at most `deviation` units away. The y axis points up: that of an SVG is turned, and its
    lower left corner becomes the origin. Its lengths in mm, cm, in, pt and pc become px, its units: 96 an inch. Lines and arcs of
    a DXF that meet at their ends are one line. DXF needs ezdxf."""
    for name, value in (("unit_m", unit_m), ("deviation", deviation)):
        if not isinstance(value, numbers.Real) or not 0 < value < math.inf:
            raise Error(Fault(f"{name} is {value!r}", "give a number above 0"))
    path = pathlib.Path(path)
    if not path.is_file():
        raise Error(Fault("this is no plain file", "give a .dxf or .svg file", str(path)), exit_code=4)
    readers = {".dxf": _dxf, ".svg": _svg}
    if path.suffix.lower() not in readers:
        raise Error(Fault(f'no drawing is read from "{path.suffix}"', "save it as .dxf or .svg", str(path)))
    lines = map(_distinct, readers[path.suffix.lower()](path, deviation))
    found = [unit_m * _corners(line) for line in lines if len(line) > 2]
    if not found:
        raise Error(Fault("there is no closed line in this drawing", "close its outlines; text and pictures are not read", str(path)))
    return found


def _corners(points: ArrayLike) -> Floats:
    import numpy
    found = floats("this is no polygon", points, "give x and y of each corner in m, [n, 2]")
    if found.ndim != 2 or found.shape[1] != 2 or not numpy.isfinite(found).all():
        raise Error(Fault(f"an array of shape {list(found.shape)} is no polygon, or has values that are no numbers",
                          "give x and y of each corner, [n, 2]"))
    if len(found) > 1 and (found[0] == found[-1]).all():
        found = found[:-1]
    if len(found) < 3:
        raise Error(Fault(f"a polygon of {len(found)} different corners encloses nothing", "give three corners or more"))
    return found


def _holds(polygon: Floats, place: Floats) -> bool:
    import numpy
    (x, y), (nx, ny) = polygon.T, numpy.roll(polygon, -1, axis=0).T
    across = (y > place[1]) != (ny > place[1])
    at = x[across] + (place[1] - y[across]) / (ny[across] - y[across]) * (nx[across] - x[across])
    return bool((at > place[0]).sum() % 2)


def png(rows: Sequence[Sequence[int]]) -> bytes:
    """A greyscale PNG of values from 0 to 255, the lowest row first."""
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", len(rows[0]), len(rows), 8, 0, 0, 0, 0)
    lines = zlib.compress(b"".join(b"\0" + bytes(row) for row in reversed(rows)), 9)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", lines) + chunk(b"IEND", b"")


Line = list[tuple[float, float]]


def _distinct(line: Line) -> Line:
    """A closed line without the points that are where the next one is, but for rounding."""
    reach = 1e-12 * max((abs(v) for point in line for v in point), default=0.0)
    return [point for point, other in zip(line, line[1:] + line[:1]) if math.dist(point, other) > reach]


def _dxf(path: pathlib.Path, deviation: float) -> list[Line]:
    try:
        from ezdxf.filemanagement import readfile
        from ezdxf.lldxf.const import DXFError
        from ezdxf.path import make_path
    except ImportError:
        raise Error(Fault("a .dxf file is read with ezdxf, which is not installed", "apt install python3-ezdxf, or pip install ezdxf",
                          str(path))) from None
    try:
        entities = list(readfile(path).modelspace())
    except (OSError, DXFError) as trouble:
        raise Error(Fault(f"this is no DXF file: {trouble}", "save the drawing again", str(path)), exit_code=4) from None
    lines: list[Line] = []
    for entity in entities:
        try:
            made = make_path(entity)
        except TypeError:
            continue  # text, dimensions
        line = [(point.x, point.y) for point in made.flattening(deviation)]
        if len(line) > 1:
            lines.append(line)
    reach = 1e-6 * max((abs(v) for line in lines for point in line for v in point), default=0.0)
    return list(_joined(lines, reach))


def _joined(lines: list[Line], reach: float) -> Iterator[Line]:
    """Closed lines, put together from those that meet at their ends."""
    waiting = list(lines)
    while waiting:
        line = waiting.pop(0)
        while math.dist(line[0], line[-1]) > reach:
            follows = next(((k, other) for k, one in enumerate(waiting) for other in (one, one[::-1])
                            if math.dist(line[-1], other[0]) <= reach), None)
            if follows is None:
                break
            waiting.pop(follows[0])
            line = line + follows[1][1:]
        else:
            yield line[:-1]


Matrix = tuple[float, float, float, float, float, float]
_NUMBER = re.compile(r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?")
_PX = {"": 1.0, "px": 1.0, "pt": 96 / 72, "pc": 16.0, "in": 96.0, "cm": 96 / 2.54, "mm": 96 / 25.4}
_MOVING = {"transform", "transform-origin", "translate", "rotate", "scale", "x", "y", "width", "height", "cx", "cy", "r", "rx", "ry", "d"}


def _svg(path: pathlib.Path, deviation: float) -> list[Line]:
    try:
        root = ElementTree.parse(path).getroot()
        box = _numbers(root.get("viewBox", ""))
        bottom = box[1] + box[3] if len(box) == 4 else _length(root, "height")
        left = box[0] if len(box) == 4 else 0.0
        for sheet in root.iterfind(".//{*}style"):
            _refuse_moving(set(_css(sheet.text)) & {*_MOVING, "display", "visibility"})
        root.tag = "g"  # an svg in it is another matter
        root.attrib.pop("style", None)  # where the page stands in another
        lines = list(_svg_lines(root, (1, 0, 0, 1, 0, 0), deviation))
    except (ElementTree.ParseError, ValueError, LookupError, OSError) as trouble:
        raise Error(Fault(f"this is no SVG that can be read: {trouble}", "save the drawing again, as plain SVG", str(path)), exit_code=4) from None
    return [[(x - left, bottom - y) for x, y in line] for line in lines]


def _words(pattern: str, text: str) -> list[str]:
    """What matches in a text that has separators beside, and nothing else."""
    rest = re.sub(r"[\s,]", "", re.sub(pattern, "", text))
    if rest:
        raise ValueError(f'"{rest[:40]}" is not understood in "{text[:80]}"')
    return re.findall(pattern, text)


def _numbers(text: str) -> list[float]:
    return [float(number) for number in _words(_NUMBER.pattern, text)]


def _css(text: str | None) -> dict[str, str]:
    return dict(re.findall(r"([\w-]+)\s*:\s*([\w-]*)", text or ""))


def _refuse_moving(properties: set[str]) -> None:
    if properties:
        raise ValueError(f"CSS sets {', '.join(sorted(properties))}: write it as an attribute of the element")


def _length(element: ElementTree.Element, name: str) -> float:
    text = element.get(name, "0").strip()
    found = re.fullmatch(rf"({_NUMBER.pattern})\s*([a-z]*)", text)
    if not found or found[2] not in _PX or (text.startswith("-") and name not in ("x", "y", "cx", "cy")):
        raise ValueError(f'{name} is "{text}": give a number (0 or more for a size), with px, mm, cm, in, pt, pc or no unit')
    return float(found[1]) * _PX[found[2]]


def _svg_lines(element: ElementTree.Element, matrix: Matrix, deviation: float) -> Iterator[Line]:
    """The closed lines of an element and of those in it."""
    kind = element.tag.rpartition("}")[2]
    try:
        css = _css(element.get("style"))
        shown = {**element.attrib, **css}
        if kind in ("defs", "clipPath", "mask", "symbol", "marker", "pattern") or shown.get("display") == "none":
            return
        _refuse_moving(_MOVING.intersection(css) | {"transform-origin"}.intersection(shown))
        if kind in ("use", "svg") or shown.get("visibility") in ("hidden", "collapse"):
            raise ValueError("it stands for another element: unlink it" if kind == "use" else "a drawing in a drawing is not read" if kind == "svg"
                             else "it is hidden: leave it out")
        for what, text in re.findall(r"(\w+)\s*\(([^)]*)\)", element.get("transform", "")):
            matrix = _times(matrix, _transform(what, _numbers(text)))
        a, b, c, d, e, f = matrix
        size = abs(a * d - b * c)
        lines = _svg_shape(kind, element, deviation / max(1e-12, math.sqrt(size)))  # it deviates before the transformation
    except (ValueError, IndexError) as trouble:
        name = f' id="{element.get("id")}"' if "id" in element.keys() else ""
        raise ValueError(f"<{kind}{name}>: {trouble}") from None
    for line in lines if size > 0 else []:
        yield [(a * x + c * y + e, b * x + d * y + f) for x, y in line]
    for child in element:
        yield from _svg_lines(child, matrix, deviation)


def _transform(kind: str, v: list[float]) -> Matrix:
    if len(v) not in {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3)}.get(kind, (len(v),)):
        raise ValueError(f'the transformation "{kind}" has {len(v)} numbers')
    if kind == "matrix":
        return v[0], v[1], v[2], v[3], v[4], v[5]
    if kind == "translate":
        return 1, 0, 0, 1, v[0], v[1] if len(v) > 1 else 0
    if kind == "scale":
        return v[0], 0, 0, v[-1], 0, 0
    if kind == "rotate":
        cos, sin = math.cos(math.radians(v[0])), math.sin(math.radians(v[0]))
        x, y = v[1:3] if len(v) == 3 else (0.0, 0.0)
        return cos, sin, -sin, cos, x - cos * x + sin * y, y - sin * x - cos * y
    raise ValueError(f'the transformation "{kind}" is not read')


def _times(m: Matrix, n: Matrix) -> Matrix:
    return (m[0] * n[0] + m[2] * n[1], m[1] * n[0] + m[3] * n[1], m[0] * n[2] + m[2] * n[3], m[1] * n[2] + m[3] * n[3],
            m[0] * n[4] + m[2] * n[5] + m[4], m[1] * n[4] + m[3] * n[5] + m[5])


def _svg_shape(kind: str, element: ElementTree.Element, deviation: float) -> list[Line]:
    if kind == "path":
        return _svg_path(element.get("d", ""), deviation)
    if kind in ("polygon", "polyline"):
        v = _numbers(element.get("points", ""))
        return _svg_path(f"M{' '.join(map(str, v))}{'z' if kind == 'polygon' else ''}", deviation) if v else []
    if kind == "rect":
        x, y, w, h = (_length(element, name) for name in ("x", "y", "width", "height"))
        rx, ry = (_length(element, name if name in element.keys() else other) for name, other in (("rx", "ry"), ("ry", "rx")))
        if w == 0 or h == 0 or rx == 0 or ry == 0:
            return [[(x, y), (x + w, y), (x + w, y + h), (x, y + h)]] if w > 0 and h > 0 else []
        rx, ry = min(rx, w / 2), min(ry, h / 2)
        centres = ((x + w - rx, y + h - ry), (x + rx, y + h - ry), (x + rx, y + ry), (x + w - rx, y + ry))
        rounded = ((cx + rx * a, cy + ry * b) for k, (cx, cy) in enumerate(centres)
                   for a, b in _arc(k * math.pi / 2, math.pi / 2, max(rx, ry), deviation))
        return [list(rounded)]
    if kind in ("circle", "ellipse"):
        cx, cy = _length(element, "cx"), _length(element, "cy")
        rx, ry = (_length(element, name) for name in (("r", "r") if kind == "circle" else ("rx", "ry")))
        return [[(cx + rx * x, cy + ry * y) for x, y in _arc(0, 2 * math.pi, max(rx, ry), deviation)[:-1]]] if rx > 0 and ry > 0 else []
    return []


def _arc(begin: float, turn: float, radius: float, deviation: float) -> Line:
    """Points of the unit circle from an angle on, through `turn`: chords of a circle of `radius` deviate by less."""
    step = 2 * math.acos(max(0.0, 1 - deviation / radius)) if radius > 0 else 1.0
    count = max(8, math.ceil(abs(turn) / max(step, 1e-3)))
    return [(math.cos(begin + turn * k / count), math.sin(begin + turn * k / count)) for k in range(count + 1)]


def _svg_path(text: str, deviation: float) -> list[Line]:
    """Closed parts of a path's data (SVG 1.1, section 8.3): those that end with Z, or where they began."""
    words = _words(rf"[MmLlHhVvCcSsQqTtAaZz]|{_NUMBER.pattern}", text)
    need = {"M": 2, "L": 2, "H": 1, "V": 1, "C": 6, "S": 4, "Q": 4, "T": 2, "A": 7, "Z": 0}
    lines: list[Line] = []
    line: Line = []
    command, last, control, place = "", "", (0.0, 0.0), (0.0, 0.0)
    while words:
        if words[0].isalpha():
            command = words.pop(0)
        kind = command.upper()
        v: list[float] = []
        while len(v) < need.get(kind, 0) and words and not words[0].isalpha():
            word = words.pop(0)
            if kind == "A" and len(v) in (3, 4):  # flags may have no separator behind them
                words[:0] = [word[1:]] if word[1:] else []
                word = word[0]
                if word not in "01":
                    break
            v.append(float(word))
        if len(v) != need.get(kind) or (kind == "Z" and not line):
            raise ValueError(f'the path\'s "{command}" is not understood')
        here = place if command.islower() else (0.0, 0.0)
        if kind == "Z":
            lines.append(line)
            place, line, last = line[0], [line[0]], kind
            continue
        if kind in "HV":
            end = (v[0] + here[0], place[1]) if kind == "H" else (place[0], v[0] + here[1])
        else:
            end = (v[-2] + here[0], v[-1] + here[1])
        points = [(v[i] + here[0], v[i + 1] + here[1]) for i in range(0, len(v) - 1, 2)] if kind != "A" else []
        if kind == "M":
            if len(line) > 2 and math.dist(line[0], line[-1]) <= 1e-6 * deviation:
                lines.append(line[:-1])
            line, command = [end], "l" if command == "m" else "L"
        elif kind == "A":
            line += _svg_arc(place, v, end, deviation)
        else:
            mirrored = (2 * place[0] - control[0], 2 * place[1] - control[1])
            if kind == "S":
                points.insert(0, mirrored if last in ("C", "S") else place)
            if kind == "T":
                points.insert(0, mirrored if last in ("Q", "T") else place)
            line += _bezier([place, *points], deviation) if kind in "CSQT" else [end]
            control = points[-2] if kind in "CSQT" else end
        place, last = end, kind
    if len(line) > 2 and math.dist(line[0], line[-1]) <= 1e-6 * deviation:
        lines.append(line[:-1])
    return lines


def _bezier(points: Line, deviation: float) -> Line:
    """Points of a Bezier curve behind its first: second differences bound how far chords deviate."""
    degree = len(points) - 1
    bend = max(math.hypot(*(a - 2 * b + c for a, b, c in zip(*three))) for three in zip(points, points[1:], points[2:]))
    count = max(1, math.ceil(math.sqrt(degree * (degree - 1) * bend / (8 * deviation))))
    return [tuple(sum(math.comb(degree, i) * (1 - t)**(degree - i) * t**i * p[k] for i, p in enumerate(points)) for k in (0, 1))  # type: ignore[misc]
            for t in (j / count for j in range(1, count + 1))]


def _svg_arc(place: tuple[float, float], v: list[float], end: tuple[float, float], deviation: float) -> Line:
    """An elliptical arc from its ends (SVG 1.1, appendix F.6.5)."""
    rx, ry, turned = abs(v[0]), abs(v[1]), math.radians(v[2])
    if rx == 0 or ry == 0 or place == end:
        return [end]
    cos, sin = math.cos(turned), math.sin(turned)
    dx, dy = (place[0] - end[0]) / 2, (place[1] - end[1]) / 2
    x, y = cos * dx + sin * dy, -sin * dx + cos * dy
    larger = math.sqrt(max(1.0, (x / rx)**2 + (y / ry)**2))
    rx, ry = rx * larger, ry * larger
    size = math.sqrt(max(0.0, (rx * ry)**2 / ((rx * y)**2 + (ry * x)**2) - 1)) * (-1 if bool(v[3]) == bool(v[4]) else 1)
    cx, cy = size * rx * y / ry, -size * ry * x / rx
    begin, until = math.atan2((y - cy) / ry, (x - cx) / rx), math.atan2((-y - cy) / ry, (-x - cx) / rx)
    turn = (until - begin) % (2 * math.pi) if v[4] else -((begin - until) % (2 * math.pi))
    mx, my = cos * cx - sin * cy + (place[0] + end[0]) / 2, sin * cx + cos * cy + (place[1] + end[1]) / 2
    return [(mx + cos * rx * a - sin * ry * b, my + sin * rx * a + cos * ry * b) for a, b in _arc(begin, turn, max(rx, ry), deviation)[1:-1]] + [end]
