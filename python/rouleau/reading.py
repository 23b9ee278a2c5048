"""Runs as they lie on the disk, finished or still going."""

from __future__ import annotations

import builtins
import dataclasses
import json
import math
import os
import pathlib
from typing import TYPE_CHECKING, Any, NamedTuple, Sequence

from .errors import Error, Fault
from .means import Statistics, statistics

if TYPE_CHECKING:
    import h5py
    import numpy
    import pandas
    from numpy.typing import NDArray

    from .drawing import Animation

    Floats = NDArray[numpy.float64]

TEXT_COLUMNS = {"type": str, "members": str, "stage_name": str}


class Section(dict[str, Any]):
    """A JSON object whose keys are attributes, too: `summary.conservation.mass_drift`."""

    def __getattr__(self, name: str) -> Any:
        if name not in self:
            raise AttributeError(f'there is no "{name}" here; there is {", ".join(self) or "nothing"}')
        return self[name]


class Mean(NamedTuple):
    """A mean of outputs in time."""

    value: float  #: in the column's unit; nan where there are too few outputs
    error: float  #: standard error of the mean, in the same unit


def mean_and_error(values: Sequence[float] | Floats, parts: int = 4, times: Sequence[float] | Floats | None = None,
                   begin: float = -math.inf) -> Mean:
    """Mean of the finite `values` [n] over `times` [n] from `begin` on, by trapezes, and its standard error from the means of
    `parts` parts of equal length. These are nearly independent where a part is longer than the values remember. Times do
    not fall; without them each value counts the same. Nothing is left out. The error is nan where there are fewer values than
    parts, and the mean where there is none."""
    values = list(values)  # a Series may begin with another number than 0
    times = list(times) if times is not None else None
    kept = [k for k, value in enumerate(values) if math.isfinite(value)]
    y = [float(values[k]) for k in kept]
    if times is None:  # a value lasts from one whole number to the next
        x = [float(k) for k in range(len(y)) for _ in (0, 1)][1:] + [float(len(y))]
        y = [value for value in y for _ in (0, 1)]
    else:
        x = [float(times[k]) for k in kept]
    if not y or x[-1] < begin:
        return Mean(math.nan, math.nan)
    first = max(begin, x[0])
    length = x[-1] - first
    if length <= 0:
        return Mean(y[-1], math.nan)
    cuts = [first + length * k / parts for k in range(parts)] + [x[-1]]
    integrals = [_integral(x, y, a, b) for a, b in zip(cuts, cuts[1:])]
    mean = math.fsum(integrals) / length
    if sum(place >= first for place in (x if times is not None else x[::2])) < parts:
        return Mean(mean, math.nan)
    means = [integral * parts / length for integral in integrals]
    return Mean(mean, math.sqrt(math.fsum((m - mean) ** 2 for m in means) / (parts - 1) / parts))


def _integral(x: Sequence[float], y: Sequence[float], begin: float, end: float) -> float:
    """Of straight lines between the points (x, y), from `begin` to `end`."""
    pieces = []
    for a, b, ya, yb in zip(x, x[1:], y, y[1:]):
        left, right = max(a, begin), min(b, end)
        if left < right:
            middle = ((left + right) / 2 - a) / (b - a)
            pieces.append((right - left) * (ya + middle * (yb - ya)))
    return math.fsum(pieces)


@dataclasses.dataclass(frozen=True)
class Cell:
    """The membrane of a cell at an instant: an outline, or in three dimensions a surface."""

    number: int  #: in the scene, from 0; no other cell gets it, also where cells come and leave
    aggregate: int  #: label of its aggregate: the smallest number of its cells
    outline: Floats  #: [nodes, 2]: x and y in m, one node after another, not wrapped into the periodic box; [nodes, 3] of a surface
    tension: Floats  #: [nodes]: N/m, of the segment from a node to the next one; of a surface the mean of the triangles around it
    curvature: Floats | None = None  #: [nodes]: 1/m, sum of both principal curvatures of a surface; None in two dimensions
    triangles: Any = None  #: [triangles, 3]: nodes of a surface, counter-clockwise seen from outside; None in two dimensions

    def moved_into(self, size_m: Sequence[float]) -> Floats:
        """The outline [nodes, 2] in m, of a surface its section(), with its centre in the periodic box of `size_m`; it is moved as a whole, along x."""
        moved = self.section().outline.copy()
        moved[:, 0] -= size_m[0] * math.floor(float(moved[:, 0].mean()) / size_m[0])
        return moved

    def wrapped_into(self, box_m: Sequence[float]) -> Floats:
        """The nodes [nodes, 2 or 3] in m, moved as a whole so that their centre lies in the periodic box of `box_m`."""
        moved = self.outline.copy()
        for axis, length in enumerate(box_m[:moved.shape[1]]):
            moved[:, axis] -= length * math.floor(float(moved[:, axis].mean()) / length)
        return moved

    def to_trimesh(self) -> Any:
        """The surface as trimesh.Trimesh, in m, not wrapped into the box. Throws Error for an outline, and where the
        optional package trimesh is missing."""
        from . import exporting
        return exporting.to_trimesh(self)

    def write(self, path: str | os.PathLike[str]) -> None:
        """A surface as an OBJ file, in um around the mean of its nodes: what a scene's `mesh` with the unit "1 um" begins as."""
        from . import exporting
        exporting.write_cell(self, pathlib.Path(path))

    def section(self) -> Cell:
        """In three dimensions the outline in which the plane across z through the surface's middle cuts it (of several the
        longest), as a cell of two."""
        import numpy
        if self.triangles is None:
            return self
        z = self.outline[:, 2]
        height = (z.min() + z.max()) / 2
        above = z >= height
        ways: dict[tuple[int, int], list[tuple[int, int]]] = {}
        for corners in self.triangles[above[self.triangles].any(axis=1) & ~above[self.triangles].all(axis=1)].tolist():
            cut = [(min(a, b), max(a, b)) for a, b in zip(corners, corners[1:] + corners[:1]) if above[a] != above[b]]
            ways.setdefault(cut[0], []).append(cut[1])
            ways.setdefault(cut[1], []).append(cut[0])
        loops: list[list[tuple[int, int]]] = []
        while ways:
            edge: tuple[int, int] | None = next(iter(ways))
            loops.append([])
            while edge is not None:
                loops[-1].append(edge)
                edge = next((way for way in ways.pop(edge) if way in ways), None)
        a, b = numpy.array(max(loops, key=len)).T
        share = ((height - z[a]) / (z[b] - z[a]))
        place = self.outline[a, :2] + share[:, None] * (self.outline[b, :2] - self.outline[a, :2])
        tension = self.tension[a] + share * (self.tension[b] - self.tension[a])
        return Cell(self.number, self.aggregate, place, tension)


@dataclasses.dataclass(frozen=True)
class Field:
    """A field on the lattice at an instant."""

    values: Floats  #: [ny, nx], or [ny, nx, 2] of vectors; in three dimensions [nz, ny, nx], or [nz, ny, nx, 3]
    unit: str  #: such as "m/s"
    x: Floats  #: [nx]: places of the nodes along x, m
    y: Floats  #: [ny]: along y, m
    z: Floats | None = None  #: [nz]: along z, m; None in two dimensions

    def section(self) -> Field:
        """In three dimensions the layer in the middle of z, as a field of two: of vectors the first two components."""
        if self.z is None:
            return self
        layer = self.values[len(self.z) // 2]
        return Field(layer[..., :2] if layer.ndim == 3 else layer, self.unit, self.x, self.y)


class Walls(list["Floats"]):
    """Polygons around walls (Frame.walls), and what the walls' surface has: its facets, segments or in three dimensions triangles."""

    facets: Floats  #: [m, 2, 2] in m, with the wall at their left; in three dimensions [m, 3, 3], triangles
    shear_stress: Floats | None  #: [m, 2] or [m, 3] in Pa: force of the fluid along each facet, per area; None where it was not written

    def __init__(self, polygons: Sequence[Floats] = (), facets: Floats | None = None, shear_stress: Floats | None = None) -> None:
        import numpy
        super().__init__(polygons)
        self.facets = numpy.zeros((0, 2, 2)) if facets is None else facets
        self.shear_stress = shear_stress


@dataclasses.dataclass(frozen=True)
class Frame:
    """Cells and fields at an instant."""

    step: int  #: number of the step, over all stages
    time_s: float  #: simulated time since the first stage began, s
    strain: float  #: summed over the stages
    stage: str  #: name of the stage
    size_m: tuple[float, float]  #: of the box along x and y, m
    cells: list[Cell]  #: those that are there, by their numbers
    fields: dict[str, Field]  #: by name: velocity, density, viscosity, vorticity; empty where none were due
    walls: Sequence[Floats] = ()  #: polygons [n, 2] in m around walls that are no planes, which lie at their left; in three dimensions around those that the plane across z through the middle cuts. Of a run's frame: Walls
    box_m: tuple[float, ...] = ()  #: of the box along every axis, m: three lengths in three dimensions

    def field(self, name: str) -> Field:
        """One of the fields. Throws Error where it was not written."""
        if name not in self.fields:
            raise Error(Fault(f'the frame at strain {self.strain:.4g} has no field "{name}"; it has ' +
                              (", ".join(self.fields) or "none"),
                              "ask for it in the scene's output.fields, or for run.frame(..., fields=True)"))
        return self.fields[name]

    def plot(self, colour: str | None = None, field: str | None = None, axes: Any = None, *, color: str | None = None,
             ax: Any = None) -> Any:
        """Draws outlines and walls in um and returns matplotlib's Axes. `colour`: "cell" (None), "aggregate" or "tension" (uN/m, with
        a bar). `field`: one that is drawn under them; of a velocity, its magnitude. `color` and `ax` are other names of
        `colour` and `axes`. In three dimensions each cell is cut through its own middle across z: `plot3d` shows surfaces."""
        from . import drawing
        return drawing.plot_frame(self, either("colour", colour, "color", color) or "cell", field, either("axes", axes, "ax", ax))

    def plot3d(self, colour: str | None = None, axes: Any = None, *, wrapped: bool = True, color: str | None = None, ax: Any = None) -> Any:
        """Draws the cells in space, in um, with the box, and returns matplotlib's three-dimensional Axes. `colour`: "cell" (None),
        "aggregate" or "tension". `wrapped`: each cell is moved as a whole, its centre into the box. Outlines lie in the plane z = 0."""
        from . import drawing
        return drawing.plot_frame_3d(self, either("colour", colour, "color", color) or "cell", either("axes", axes, "ax", ax), wrapped)

    def to_pyvista(self, wrapped: bool = True) -> Any:
        """All cells as one pyvista.PolyData in m: triangles, or lines of outlines, with the tension (and curvature) of each
        point and the `cell` and `aggregate` of each triangle. Throws Error where the optional package pyvista is missing."""
        from . import exporting
        return exporting.to_pyvista(self, wrapped)

    def to_trimesh(self) -> list[Any]:
        """Each cell as trimesh.Trimesh (Cell.to_trimesh), by their numbers."""
        return [cell.to_trimesh() for cell in self.cells]

    def write(self, path: str | os.PathLike[str], wrapped: bool = True) -> pathlib.Path:
        """Writes all cells in m, whole or not at all, and returns the path: .vtp (ParaView, VTK; also outlines), .ply or .stl.
        `wrapped`: each cell is moved as a whole, its centre into the box."""
        from . import exporting
        return exporting.write_frame(self, pathlib.Path(path), wrapped)

    def _facts(self) -> list[tuple[str, str]]:
        nodes = {len(cell.outline) for cell in self.cells}
        return [("stage", self.stage), ("strain", f"{self.strain:.4g}"), ("time", f"{self.time_s:.4g} s"),
                ("cells", f"{len(self.cells)}" + (f" of {'or '.join(f'{n} ' for n in sorted(nodes)[:3])}nodes" if nodes else "")),
                ("box", " x ".join(f"{1e6 * length:.4g}" for length in self.box_m or self.size_m) + " um"),
                ("fields", ", ".join(self.fields))]

    def __repr__(self) -> str:
        return "<frame: " + ", ".join(f"{name} {value}" for name, value in self._facts() if value) + ">"

    def _repr_html_(self) -> str:
        from . import exporting
        return exporting.card("Frame", self._facts())


def either(name: str, value: Any, other: str, alias: Any) -> Any:
    """The value of an argument that has two names. Throws Error where both are given."""
    if value is not None and alias is not None:
        raise Error(Fault(f"{name} and {other} are given, and mean the same", "give one of them"))
    return alias if value is None else value


class Outputs:
    """What a run, or one of its stages, wrote in the course of time."""

    _run: Run

    def _steps(self) -> tuple[float, float]:
        return -math.inf, math.inf

    def _rows(self, name: str) -> pandas.DataFrame:
        table = self._run._table(name)
        first, last = self._steps()
        return table[table["step"].between(first, last)].reset_index(drop=True)

    @property
    def cells(self) -> pandas.DataFrame:
        """cells.csv: one row for each output time and cell that is there, in SI units as its columns say, and beside them `stage_name`.
        A stage at rest has many times of one strain: `pivot` makes a table over the strain."""
        return self._rows("cells")

    @property
    def series(self) -> pandas.DataFrame:
        """series.csv: one row for each output time, in SI units as its columns say."""
        return self._rows("series")

    @property
    def aggregates(self) -> pandas.DataFrame:
        """aggregates.csv: one row for each contact, and one with empty contact columns for a cell that has none."""
        return self._rows("aggregates")

    def pivot(self, column: str, over: str = "strain") -> pandas.DataFrame:
        """A column of cells.csv with a row for each value of `over` ("strain", "time_s" or "step") and a column for each
        cell, nan where that was not there. Of several outputs with one strain (a stage at rest) the last stands for all."""
        cells = _with_columns(self.cells, "cells.csv", column, over)
        return cells.drop_duplicates([over, "cell"], keep="last").pivot(index=over, columns="cell", values=column)

    def mean(self, column: str, begin: float = 0.5, parts: int = 4) -> Mean:
        """Mean in time and standard error (`mean_and_error`) of a column of series.csv after the share `begin` of the
        time: of a stage's second half what summary.json has."""
        series = _with_columns(self.series, "series.csv", column)
        times = series["time_s"].to_numpy()
        own = self._own(series)  # a stage begins with the last output of the one before it
        return mean_and_error(series[column][own].to_numpy(), parts, times[own], times[0] + begin * (times[-1] - times[0]))

    def statistics(self, column: str) -> Statistics:
        """Where a column became steady, and its mean from there with an error that knows that values follow each other
        (`rouleau.statistics`): of series.csv, or of cells.csv the mean over the cells. Of a run its last stage. What is not
        steady has no mean."""
        series = self.series
        if column in series or column not in self.cells:
            table = _with_columns(series, "series.csv", column)
        else:
            table = self.cells.groupby(["step", "time_s", "stage_name"], sort=False)[column].mean().reset_index()
        table = table[self._own(table)]
        return statistics(table[column].tolist(), table["time_s"].tolist())

    def _own(self, series: pandas.DataFrame) -> pandas.Series[bool]:
        return series["step"] >= -1

    def plot(self, *columns: str, over: str | None = None, axes: Any = None, ax: Any = None) -> Any:
        """Draws columns of cells.csv (a line for each cell; beyond twelve the mean and the range) or series.csv and
        returns matplotlib's Axes, of several columns a list. Without columns: cells at four instants, deformation and
        gaps. `over`: "strain" or "time_s"; left out, the strain where it grows. Lengths are drawn in um, angles in degrees.
        `ax` is another name of `axes`."""
        from . import drawing
        return drawing.plot(self, list(columns), over, either("axes", axes, "ax", ax))

    def to_xarray(self, outlines: bool = False) -> Any:
        """series.csv over `time` and cells.csv over `time` and `cell` as xarray.Dataset, with the unit of each variable in its
        attribute `units`, nan where a cell is not there. `outlines`: also the nodes of every frame over `frame`, `cell`, `node`
        and `axis`, and their tension. Throws Error where the optional package xarray is missing."""
        from . import exporting
        return exporting.to_xarray(self, outlines)


class Stage(Outputs):
    """One stage of a run: the state with which it began, and every output since then."""

    def __init__(self, run: Run, name: str, first: float, last: float) -> None:
        self._run, self.name, self._range = run, name, (first, last)

    def _steps(self) -> tuple[float, float]:
        return self._range

    def _own(self, series: pandas.DataFrame) -> pandas.Series[bool]:
        return series["stage_name"] == self.name

    def __repr__(self) -> str:
        return f"<stage {self.name} of {self._run.directory}>"


class Run(Outputs):
    """A run's directory. Tables of a run that is still going are read anew whenever they are asked for."""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = pathlib.Path(directory)
        self._run = self
        self._tables: dict[str, pandas.DataFrame] = {}
        if not self.directory.is_dir():
            raise Error(Fault("this is no directory", "give the directory of a run, such as runs/demo", str(directory)), exit_code=4)
        if not (self.directory / "scene.json").is_file():
            raise Error(Fault("this directory holds no run: there is no scene.json", "give the directory that rouleau run "
                              "wrote; that of a study holds its runs in points/", str(directory)), exit_code=4)

    @property
    def finished(self) -> bool:
        """Whether the run has ended: completed, diverged or interrupted. summary.json is written last."""
        return (self.directory / "summary.json").is_file()

    @property
    def status(self) -> str:
        """"completed", "diverged", "interrupted", or "unfinished" for a run that is going on or was killed."""
        return str(self.summary["status"])

    @property
    def summary(self) -> Section:
        """summary.json, with keys as attributes: `run.summary.dimensionless.capillary`. Of an unfinished run `status`,
        `title`, `steps`, `strain` and `simulated_time_s` as far as they are on the disk."""
        if self.finished:
            found: Section = self._json("summary.json")
            return found
        series = self.series
        last = series.iloc[-1] if len(series) else {"step": 0, "strain": 0.0, "time_s": 0.0}
        return Section(status="unfinished", title=self.scene.get("title", ""), steps=int(last["step"]),
                       strain=float(last["strain"]), simulated_time_s=float(last["time_s"]))

    @property
    def scene(self) -> Section:
        """The scene as it was run."""
        found: Section = self._json("scene.json")
        return found

    @property
    def log(self) -> list[Section]:
        """log.jsonl: what happened when; each entry has `event` and `wall_s`, seconds since the run began."""
        lines = _plain(self.directory / "log.jsonl").read_text(encoding="utf-8").split("\n")[:-1]
        return [json.loads(line, object_hook=Section) for line in lines]

    @property
    def stages(self) -> list[str]:
        """Names of the stages that have outputs, in their order."""
        return list(dict.fromkeys(self.series["stage_name"]))

    def stage(self, name: str) -> Stage:
        """The stage of this name. Throws Error where the run has none, or has not come to it."""
        series = self.series
        rows = series.index[series["stage_name"] == name]
        if len(rows) == 0:
            raise Error(Fault(f'there is no stage "{name}"; there is ' + (", ".join(self.stages) or "none yet"), "",
                              str(self.directory / "series.csv")))
        return Stage(self, name, float(series["step"][max(rows[0] - 1, 0)]), float(series["step"][rows[-1]]))

    def statistics(self, column: str) -> Statistics:
        """Outputs.statistics of the last stage."""
        return self.stage(self.stages[-1]).statistics(column)

    @property
    def error_bars(self) -> pandas.DataFrame:
        """The measured errors of a run with error bars: `value`, `error` and `how` it was measured, in SI, for each
        quantity (index). Empty without error bars."""
        import pandas
        bars = self.summary.get("error_bars") or {}
        return pandas.DataFrame.from_dict(bars, orient="index", columns=["value", "error", "how"]).rename_axis("quantity")

    @property
    def results(self) -> pandas.DataFrame:
        """What came out: `value`, `error` and `how` the error was found, in SI, for each quantity (index). With error bars
        these are all. Without them there are means of the last stage with their standard error (Outputs.statistics). Of
        what is not steady it is the mean in time over the second half, with an unknown error (nan). The cells' mean
        deformation at the end and, where cells attract each other, the number of aggregates have no known error (nan)."""
        import pandas
        bars = self.error_bars
        if len(bars):
            return bars
        last = self.stage(self.stages[-1])
        series = last.series
        attracting = bool(self.summary.get("contacts", {}).get("attracting"))
        empty = last.mean("cell_free_layer_empty").value if "cell_free_layer_empty" in series else math.nan
        rows: dict[str, tuple[float, float, str]] = {}
        cells = self.cells
        end = cells[cells["step"] == series["step"].max()]
        if len(end):
            rows["deformation"] = (float(end["deformation"].mean()), math.nan, "at the end; no error bar")
            if attracting:
                rows["aggregates"] = (float(end["aggregate"].nunique()), math.nan, "at the end; no error bar")
        for column in MEANS:
            if column not in series or series[column].isna().all() or (column.startswith("aggregate") and not attracting) or \
                    (column.startswith("cell_free_layer") and not empty < MOST_EMPTY_COLUMNS):
                continue
            known = last.statistics(column)
            rows[column] = (known.value, known.error, f"mean of the last stage from {known.begin:.4g} s on; no error bar") \
                if known.steady else (last.mean(column).value, math.nan, f"mean of the last stage's second half; {known.verdict}")
        return pandas.DataFrame.from_dict(rows, orient="index", columns=["value", "error", "how"]).rename_axis("quantity")

    @property
    def lifetimes(self) -> pandas.DataFrame:
        """How long joined cells stayed together: a row for each `stage` and number of `cells`, with how many aggregates were
        `seen`, how many `broken` or `grown`, and their `time_s` together. Rates are of breaking alone, with their standard error
        (that of one event where none broke). Empty where nothing attracts. Outputs see no break that mends between two of them."""
        import pandas
        rows = [{"stage": stage["stage"], **size} for stage in self.summary.get("lifetimes", ()) for size in stage["sizes"]]
        return pandas.DataFrame(rows, columns=["stage", "cells", "seen", "broken", "grown", "time_s", "break_up_rate_per_s",
                                               "standard_error_per_s", "mean_lifetime_s"])

    @property
    def frames(self) -> pandas.DataFrame:
        """The frames that are on the disk: `step`, `time_s`, `strain`, `stage_name`, whether there are `fields`, and the
        `file` with its `name` in it. Of a run that goes on these are the frames up to its last checkpoint."""
        import pandas
        rows = []
        finished = self.finished
        for path in self._frame_files():
            try:
                with _opened(path) as file:
                    all_frames = _part(file, "frames")
                    for name in sorted(all_frames or ()):
                        frame = _part(all_frames, name)
                        about = frame.attrs
                        rows.append((int(about["step"]), float(about["time_s"]), float(about["strain"]),
                                     _text(about["stage_name"]),
                                     len(_part(frame, "fields") or ()) > 0 or _part(frame, "walls") is not None, path.name, name))
            except (OSError, KeyError, RuntimeError):
                if finished:
                    raise Error(Fault("this file is damaged", "rouleau verify says what has changed", str(path)), exit_code=4) from None
                break  # the segment that is being written
        names = ["step", "time_s", "strain", "stage_name", "fields", "file", "name"]
        return pandas.DataFrame(rows, columns=names).drop_duplicates("name", keep="last").reset_index(drop=True)

    def frame(self, *, strain: float | None = None, time_s: float | None = None, index: int | None = None,
              fields: bool = False) -> Frame:
        """The frame nearest to a strain (of several with one strain the last) or to a time in s, or that of an index (-1:
        the last); without any of them the last. `fields`: only of those that have fields. Throws Error for a strain or
        time that the run has not reached."""
        frames = self.frames
        if fields:
            frames = frames[frames["fields"]].reset_index(drop=True)
        place = str(self.directory / "frames.h5")
        if len(frames) == 0:
            raise Error(Fault("there are no frames" + (" with fields" if fields else "") + " yet" * (not self.finished),
                              "set output.fields in the scene" if fields else "", place))
        if sum(given is not None for given in (strain, time_s, index)) > 1:
            raise Error("frame() wants one of strain, time_s and index")
        if strain is None and time_s is None:
            chosen = -1 if index is None else index
            if not -len(frames) <= chosen < len(frames):
                raise Error(Fault(f"there is no frame {chosen}; there are {len(frames)}", "", place))
            return self._frame(frames.iloc[chosen])
        column, wanted = ("strain", strain) if strain is not None else ("time_s", time_s)
        assert wanted is not None
        have = frames[column].to_numpy()
        steps = abs(have[1:] - have[:-1])
        margin = 0.5 * steps.max(initial=0) + 1e-9 * abs(have).max()
        if not have.min() - margin <= wanted <= have.max() + margin:
            raise Error(Fault(f"{column} {wanted:g} is outside of what the run has: {have.min():g} to {have.max():g}", "", place))
        distance = abs(have - wanted)
        return self._frame(frames.iloc[int((distance <= distance.min()).nonzero()[0][-1])])

    def animate(self, most_frames: int = 60, colour: str | None = None, field: str | None = None, *, color: str | None = None) -> Animation:
        """An animation that plays in a notebook, of at most `most_frames` frames, evenly chosen; its `save` writes an
        HTML, GIF or MP4 file. `colour`, `color` and `field` as in Frame.plot."""
        from . import drawing
        return drawing.Animation(self, most_frames, either("colour", colour, "color", color) or "cell", field)

    def __repr__(self) -> str:
        summary = self.summary
        words = summary.get("outcome") or f"{summary.status} at step {summary.steps}, strain {summary.strain:.4g}"
        return f"<run {self.directory}: {words}>"

    def _repr_html_(self) -> str:
        from . import exporting
        from .pages import table, with_bar
        summary = self.summary
        facts = [("title", str(summary.get("title", "") or self.scene.get("title", ""))), ("outcome", str(summary.get("outcome", ""))),
                 ("status", str(summary.status)), ("strain", f"{summary.get('strain', 0):.4g}"), ("steps", str(summary.get("steps", "")))]
        try:
            results = self.results
        except (Error, LookupError):  # there is none yet
            return exporting.card(str(self.directory), facts)
        shown = table(["quantity (SI)", "value", "how"], [[name, with_bar(float(row["value"]), float(row["error"])), row["how"]]
                                                          for name, row in results.iterrows()])
        return exporting.card(str(self.directory), facts, shown)

    def _json(self, name: str) -> Any:
        path = self.directory / name
        try:
            return json.loads(_plain(path, 16).read_text(encoding="utf-8"), object_hook=Section)
        except ValueError as error:
            raise Error(Fault(f"this is no JSON: {error}", "rouleau verify says what has changed", str(path)), exit_code=4) from None

    def _table(self, name: str) -> pandas.DataFrame:
        if name in self._tables:
            return self._tables[name].copy()
        finished = self.finished
        table = _read_table(self.directory / f"{name}.csv")
        if name != "series":
            series = self._table("series")
            table.insert(3, "stage_name", table["step"].map(dict(zip(series["step"], series["stage_name"]))))
        if finished:
            self._tables[name] = table
            return table.copy()
        return table

    def _frame_files(self) -> list[pathlib.Path]:
        whole = self.directory / "frames.h5"
        return [whole] if whole.is_file() and self.finished else sorted(self.directory.glob("frames-[0-9]*.h5")) or \
            ([whole] if whole.is_file() else [])

    def _frame(self, row: pandas.Series) -> Frame:
        import numpy
        path = self.directory / row["file"]
        with _opened(path) as file:
            frame = _part(_part(file, "frames"), row["name"])
            size = tuple(float(length) for length in file.attrs["size_m"])
            cells = []
            membranes = _part(frame, "membranes")
            if membranes is not None:
                points, tension, first, cell_of, aggregate = (
                    _part(membranes, part)[:] for part in ("points", "tension", "first", "cell", "aggregate"))
                curvature, triangles = (None if (part := _part(membranes, name)) is None else part[:]
                                        for name in ("curvature", "triangles"))
                for b, e in zip(first[:-1], first[1:]):
                    surface = {} if triangles is None or curvature is None else {
                        "curvature": curvature[b:e],
                        "triangles": triangles[(triangles[:, 0] >= b) & (triangles[:, 0] < e)] - b}
                    cells.append(Cell(int(cell_of[b]), int(aggregate[b]), points[b:e], tension[b:e], **surface))
            sheared = _part(frame, "walls")
            on_walls = None if sheared is None else _part(sheared, "wall_shear_stress")[:]
            fields: dict[str, Field] = {}
            shown = _part(frame, "fields")
            for name in shown or ():
                data = _part(shown, name)
                values = data[:].astype(numpy.float64)
                axes = len(size)
                if axes == 2 and values.ndim == 3:
                    values = values[:, :, :2]
                if "fields_first_m" in file.attrs:
                    begin, spacing = file.attrs["fields_first_m"], file.attrs["fields_spacing_m"]
                else:
                    spacing = numpy.array(size) / numpy.array(file.attrs["nodes"])
                    begin = spacing / 2
                spacing, begin = numpy.broadcast_to(spacing, axes), numpy.broadcast_to(begin, axes)
                places = [begin[k] + spacing[k] * numpy.arange(values.shape[axes - 1 - k]) for k in range(axes)]
                fields[name] = Field(values, _text(data.attrs["unit"]), *places)
        return Frame(int(row["step"]), float(row["time_s"]), float(row["strain"]), str(row["stage_name"]),
                     (size[0], size[1]), cells, fields, self._walls(on_walls), size)

    def _walls(self, shear_stress: Floats | None) -> Walls:
        """Frame.walls, which the first file of frames has."""
        with _opened(self._frame_files()[0]) as file:
            group = _part(file, "walls")
            if group is None:
                return Walls()
            polygons: list[Floats] = []
            points, facets = _part(group, "points"), _part(group, "triangles")
            if (first := _part(group, "first")) is not None:
                corners = _part(group, "corners")
                polygons = [corners[b:e] for b, e in zip(first[:-1], first[1:])]
                if facets is None:
                    points, facets = corners, _part(group, "segments")
            places = None if facets is None or points is None else points[:][facets[:]]
            if shear_stress is not None and places is not None:
                shear_stress = shear_stress[:, :places.shape[2]]
            return Walls(polygons, places, shear_stress)


#: Share of columns without cells from which on a mean cell-free layer says nothing.
MOST_EMPTY_COLUMNS = 0.05
#: Columns of series.csv whose mean over a stage says something.
MEANS = ("relative_viscosity", "particle_stress_Pa", "aggregate_size_number_mean", "aggregate_size_weight_mean",
         "cell_free_layer_lower_m", "cell_free_layer_upper_m", "flow_rate_m2_per_s",
         "mean_velocity_m_per_s", "discharge_hematocrit")


def open(directory: str | os.PathLike[str]) -> Run:  # noqa: A001
    """The run in a directory, finished or still going. Throws Error where there is none."""
    return Run(directory)


def _read_table(path: pathlib.Path) -> pandas.DataFrame:
    """A table with all its whole lines: a run that goes on may be in the midst of one."""
    import io

    import pandas
    if not path.is_file():
        raise Error(Fault("this table is missing", "a run that has just begun has none yet", str(path)), exit_code=4)
    with builtins.open(_plain(path), encoding="utf-8", newline="") as file:
        text = file.read()
    text = text[:text.rfind("\n") + 1]
    if not text:
        raise Error(Fault("this table is empty", "a run that has just begun has no outputs yet", str(path)), exit_code=4)
    return pandas.read_csv(io.StringIO(text), float_precision="round_trip", keep_default_na=False, na_values=["", "nan"],
                           dtype=TEXT_COLUMNS)


def _with_columns(table: pandas.DataFrame, file: str, *names: str) -> pandas.DataFrame:
    import difflib
    for name in names:
        if name not in table:
            near = difflib.get_close_matches(name, list(table), 1)
            raise Error(Fault(f'{file} has no column "{name}"' + (f'; did you mean "{near[0]}"?' if near else ""),
                              "columns: " + ", ".join(table)))
    return table


def _plain(path: pathlib.Path, most_mib: int | None = 2048) -> pathlib.Path:
    """The path of a regular file of at most so many MiB: another would be waited for. Throws Error."""
    if not path.is_file():
        raise Error(Fault("this is no plain file", "bring the file back", str(path)), exit_code=4)
    if most_mib is not None and path.stat().st_size > most_mib << 20:
        raise Error(Fault(f"this file has more than {most_mib} MiB", "it is no file of a run", str(path)), exit_code=4)
    return path


def _opened(path: pathlib.Path) -> h5py.File:
    import h5py
    return h5py.File(_plain(path, None), "r", locking=False)  # another process may be writing beside it


def _part(group: h5py.Group, name: str) -> Any:
    """A group's member, None where there is none. Throws Error where it would be read from elsewhere than from files in
    the run's folder."""
    import h5py
    links, key = group.id.links, name.encode()
    if not links.exists(key):  # `in` would follow the link
        return None
    kind, part = links.get_info(key).type, None
    if kind == h5py.h5l.TYPE_HARD:
        part = group[name]
    if kind == h5py.h5l.TYPE_EXTERNAL:  # step by step: there may be other links on the way
        folder = pathlib.Path(group.file.filename).resolve().parent
        file, path = map(os.fsdecode, links.get_val(key))
        if (folder / file).resolve().parent == folder and (folder / file).is_file():
            part = _opened(folder / file)
            for step in filter(None, path.split("/")):
                part = part if part is None else _part(part, step)
    if part is None or (isinstance(part, h5py.Dataset) and (part.is_virtual or part.external)):
        raise Error(Fault(f"{group.name}/{name} leads to another file: it is damaged", "do not use this run unless you "
                          "trust whoever made it", str(group.file.filename)), exit_code=4)
    return part


def _text(value: Any) -> str:
    return value.decode() if isinstance(value, bytes) else str(value)
