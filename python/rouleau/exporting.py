"""Runs and frames for other programs: VTK, STL and PLY files, PyVista, trimesh, xarray. What is exported (a Run, Frame, Cell) is
handed over by reading.py, which imports this module: its types are not named here."""

from __future__ import annotations

import base64
import html
import importlib
import math
import pathlib
import struct
from typing import TYPE_CHECKING, Any, Iterable, Sequence

from .errors import Error, Fault
from .pages import replace_file

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray


def needed(module: str, debian: str | None = None) -> Any:
    """An optional module. Throws Error where it is not installed."""
    try:
        return importlib.import_module(module)
    except ImportError as trouble:
        how = f"apt install {debian}, or pip install {module}" if debian else f"pip install {module}"
        raise Error(Fault(f"the Python package {module} is missing ({trouble})", f"install it: {how}"), exit_code=4) from None


class Mesh:
    """All cells of a frame as one mesh: points [n, 3] in m, and for each primitive (a triangle, or the closed line of an
    outline) its points, its cell and its aggregate."""

    def __init__(self, frame: Any, wrapped: bool) -> None:
        import numpy
        cells = frame.cells
        self.surfaces = any(cell.triangles is not None for cell in cells)
        points, tension, curvature, self.primitives = [numpy.zeros((0, 3))], [], [], []
        numbers, aggregates, first = [], [], 0
        for cell in cells:
            places = cell.wrapped_into(frame.box_m) if wrapped else cell.outline
            points.append(numpy.column_stack([places, numpy.zeros(len(places))]) if places.shape[1] == 2 else places)
            tension.append(cell.tension)
            curvature.append(cell.curvature if cell.curvature is not None else numpy.full(len(places), math.nan))
            own = [[*range(first, first + len(places)), first]] if cell.triangles is None else (cell.triangles + first).tolist()
            self.primitives += own
            numbers += [cell.number] * len(own)
            aggregates += [cell.aggregate] * len(own)
            first += len(places)
        self.points: NDArray[numpy.float64] = numpy.vstack(points)
        self.point_data = {"tension_N_per_m": numpy.concatenate(tension) if tension else numpy.zeros(0)}
        if self.surfaces:
            self.point_data["curvature_1_per_m"] = numpy.concatenate(curvature)
        self.cell_data = {"cell": numpy.array(numbers, numpy.int32), "aggregate": numpy.array(aggregates, numpy.int32)}

    def packed(self) -> Any:
        """Primitives as VTK has them in memory: count, points, count, points, ..."""
        import numpy
        return numpy.array([word for corners in self.primitives for word in (len(corners), *corners)], numpy.int64)


def write_frame(frame: Any, path: pathlib.Path, wrapped: bool) -> pathlib.Path:
    """Frame.write"""
    writers = {".vtp": _vtp, ".stl": _stl, ".ply": _ply}
    if path.suffix.lower() not in writers:
        raise Error(Fault(f"{path.name} has no ending of a known format", "give .vtp (ParaView, VTK), .ply or .stl"))
    mesh = Mesh(frame, wrapped)
    if path.suffix.lower() != ".vtp" and not mesh.surfaces:
        raise Error(Fault(f"{path.name} wants surfaces, and this frame has {'outlines' if frame.cells else 'no cells'}",
                          "write it as .vtp, which has lines, too"))
    replace_file(path, writers[path.suffix.lower()](mesh, frame))
    return path


def write_cell(cell: Any, path: pathlib.Path) -> None:
    """Cell.write"""
    if cell.triangles is None:
        raise Error(Fault("an outline is no surface", "write cells of three dimensions"))
    places = (1e6 * (cell.outline - cell.outline.mean(axis=0))).tolist()
    lines = ["v %.17g %.17g %.17g\n" % tuple(place) for place in places]
    lines += ["f %d %d %d\n" % tuple(corner + 1 for corner in corners) for corners in cell.triangles.tolist()]
    replace_file(path, "".join(lines).encode())


def _array(name: str, values: Any, components: int = 1) -> str:
    """A DataArray of VTK's XML: in base64 the number of bytes as UInt64, then the values."""
    import numpy
    kinds = {"f": ("Float64", "<f8"), "i": ("Int64", "<i8")}
    kind, stored = kinds[numpy.asarray(values).dtype.kind]
    data = numpy.ascontiguousarray(values, stored).tobytes()
    text = base64.b64encode(struct.pack("<Q", len(data)) + data).decode()
    several = f' NumberOfComponents="{components}"' if components > 1 else ""
    return f'<DataArray type="{kind}" Name="{html.escape(name)}"{several} format="binary">{text}</DataArray>\n'


def _vtp(mesh: Mesh, frame: Any) -> bytes:
    """VTK's XML PolyData, serial, version 1.0 (VTK File Formats, "XML File Formats")."""
    import numpy
    lengths = numpy.array([len(corners) for corners in mesh.primitives], numpy.int64)
    joined = numpy.array([point for corners in mesh.primitives for point in corners], numpy.int64)

    def part(name: str, filled: bool) -> str:
        inside = (joined, numpy.cumsum(lengths)) if filled else (numpy.zeros(0, numpy.int64),) * 2
        return f"<{name}>\n{_array('connectivity', inside[0])}{_array('offsets', inside[1])}</{name}>\n"

    count = len(lengths)
    time = f'<FieldData>\n<DataArray type="Float64" Name="TimeValue" NumberOfTuples="1" format="ascii">{frame.time_s!r}</DataArray>\n</FieldData>\n'
    text = ('<?xml version="1.0"?>\n<VTKFile type="PolyData" version="1.0" byte_order="LittleEndian" header_type="UInt64">\n<PolyData>\n'
            f'{time}<Piece NumberOfPoints="{len(mesh.points)}" NumberOfVerts="0" NumberOfLines="{0 if mesh.surfaces else count}" '
            f'NumberOfStrips="0" NumberOfPolys="{count if mesh.surfaces else 0}">\n'
            + "<PointData>\n" + "".join(_array(name, values) for name, values in mesh.point_data.items()) + "</PointData>\n"
            + "<CellData>\n" + "".join(_array(name, values) for name, values in mesh.cell_data.items()) + "</CellData>\n"
            + f"<Points>\n{_array('Points', mesh.points, 3)}</Points>\n"
            + part("Lines", not mesh.surfaces) + part("Polys", mesh.surfaces)
            + "</Piece>\n</PolyData>\n</VTKFile>\n")
    return text.encode()


def _stl(mesh: Mesh, frame: Any) -> bytes:
    """Binary STL, in m."""
    import numpy
    corners = mesh.points[numpy.array(mesh.primitives)]
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= numpy.maximum(numpy.linalg.norm(normals, axis=1, keepdims=True), 1e-300)
    records = numpy.zeros(len(corners), [("normal", "<f4", 3), ("corners", "<f4", (3, 3)), ("attribute", "<u2")])
    records["normal"], records["corners"] = normals, corners
    return b"cells of a frame, in m".ljust(80) + struct.pack("<I", len(corners)) + records.tobytes()


def _ply(mesh: Mesh, frame: Any) -> bytes:
    """ASCII PLY, in m, with the number of each triangle's cell."""
    names = list(mesh.point_data)
    head = ["ply", "format ascii 1.0", "comment lengths in m", f"element vertex {len(mesh.points)}",
            *(f"property double {name}" for name in ("x", "y", "z", *names)), f"element face {len(mesh.primitives)}",
            "property list uchar int vertex_indices", "property int cell", "end_header"]
    points = [" ".join(repr(float(v)) for v in (*point, *(mesh.point_data[name][k] for name in names))) for k, point in enumerate(mesh.points)]
    faces = [f"3 {a} {b} {c} {number}" for (a, b, c), number in zip(mesh.primitives, mesh.cell_data["cell"])]
    return "\n".join([*head, *points, *faces, ""]).encode()


def to_pyvista(frame: Any, wrapped: bool) -> Any:
    """Frame.to_pyvista"""
    pyvista = needed("pyvista")
    mesh = Mesh(frame, wrapped)
    made = pyvista.PolyData(mesh.points, faces=mesh.packed()) if mesh.surfaces else pyvista.PolyData(mesh.points, lines=mesh.packed())
    for name, values in mesh.point_data.items():
        made.point_data[name] = values
    for name, values in mesh.cell_data.items():
        made.cell_data[name] = values
    return made


def to_trimesh(cell: Any) -> Any:
    """Cell.to_trimesh"""
    if cell.triangles is None:
        raise Error(Fault("this cell is an outline, and trimesh has surfaces", "take a run in three dimensions"))
    trimesh = needed("trimesh")
    return trimesh.Trimesh(vertices=cell.outline, faces=cell.triangles, process=False,
                           metadata={"cell": cell.number, "aggregate": cell.aggregate, "unit": "m"})


def to_xarray(outputs: Any, outlines: bool) -> Any:
    """Outputs.to_xarray"""
    import numpy
    from .drawing import ENDINGS
    xarray = needed("xarray", "python3-xarray")

    def unit_of(column: str) -> dict[str, str]:
        for ending, unit, *_ in ENDINGS:
            if column.endswith(ending) and not column.removesuffix(ending).endswith("_per"):
                return {"units": str(unit).replace("²", "2").replace("³", "3").replace("µ", "u").replace("°", "degree")}
        return {}

    series, cells = outputs.series.drop_duplicates("step", keep="last"), outputs.cells
    coords: dict[str, Any] = {name: ("time", series[name].to_numpy(), unit_of(name)) for name in ("time_s", "strain", "step", "stage_name")}
    data: dict[str, Any] = {}
    for name in series.columns.difference(["time_s", "strain", "step", "stage_name", "stage"], sort=False):
        data[name] = ("time", series[name].to_numpy(), unit_of(name))
    steps = series["step"].to_numpy()
    own = cells[cells["step"].isin(steps)].drop_duplicates(["step", "cell"], keep="last")
    numbers = numpy.sort(own["cell"].unique())
    for name in own.columns.difference(["time_s", "strain", "step", "stage_name", "cell", "type"], sort=False):
        table = own.pivot(index="step", columns="cell", values=name).reindex(index=steps, columns=numbers)
        data[name if name not in data else f"cell_{name}"] = (("time", "cell"), table.to_numpy(), unit_of(name))
    coords["cell"] = ("cell", numbers)
    if len(own):
        coords["type"] = ("cell", own.drop_duplicates("cell").set_index("cell")["type"].reindex(numbers).astype(str).to_numpy())
    if outlines:
        first, last = outputs._steps()
        rows = [row for _, row in outputs._run.frames.iterrows() if first <= row["step"] <= last]
        frames = [outputs._run._frame(row) for row in rows]
        nodes = max((len(cell.outline) for frame in frames for cell in frame.cells), default=0)
        axes = len(frames[0].box_m) if frames else 2
        places = numpy.full((len(frames), len(numbers), nodes, axes), math.nan)
        tension = numpy.full((len(frames), len(numbers), nodes), math.nan)
        at = {int(number): k for k, number in enumerate(numbers)}
        for k, frame in enumerate(frames):
            for cell in frame.cells:
                places[k, at[cell.number], :len(cell.outline)] = cell.outline
                tension[k, at[cell.number], :len(cell.outline)] = cell.tension
        coords["frame_time_s"] = ("frame", numpy.array([frame.time_s for frame in frames]), {"units": "s"})
        coords["frame_strain"] = ("frame", numpy.array([frame.strain for frame in frames]))
        coords["axis"] = ("axis", list("xyz")[:axes])
        data["outline"] = (("frame", "cell", "node", "axis"), places, {"units": "m"})
        data["tension"] = (("frame", "cell", "node"), tension, {"units": "N/m"})
    return xarray.Dataset(data, coords, {"title": str(outputs._run.scene.get("title", "")), "directory": str(outputs._run.directory)})


def card(title: str, lines: Iterable[tuple[str, str]], below: str = "") -> str:
    """What a notebook shows: a title, a table of names and values, and what stands below."""
    rows = "".join(f'<tr><th style="text-align:left">{html.escape(name)}</th><td style="text-align:left">{html.escape(value)}</td></tr>'
                   for name, value in lines if value)
    return f'<div class="rouleau"><strong>{html.escape(title)}</strong><table>{rows}</table>{below}</div>'


def short(values: Sequence[str], most: int = 6) -> str:
    """Words with commas, the rest as their number."""
    return ", ".join(values[:most]) + (f" and {len(values) - most} more" if len(values) > most else "")
