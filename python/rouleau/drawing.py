"""Figures of runs with matplotlib. What is drawn (a Run, Outputs, Frame, Cell) is handed over by reading.py, which imports this
module: its types are not named here."""

from __future__ import annotations

import html
import json
import os
import pathlib
from typing import Any, Sequence

from .errors import Error, Fault

MOST_LINES = 12
LABELS = {"strain": "strain", "deformation": "deformation", "min_gap_m": "gap to the nearest cell (µm)",
          "relative_viscosity": "relative viscosity"}
#: Endings of columns, their units, what they are drawn in, and how many of these are one; the longest first. The reports' own.
ENDINGS = json.loads(pathlib.Path(__file__).with_name("endings.json").read_text(encoding="utf-8"))


def label_of(column: str) -> tuple[str, float]:
    """What an axis says for a column, and by how much its values are multiplied."""
    for ending, _, unit, scale in ENDINGS:
        if column.endswith(ending) and not column.removesuffix(ending).endswith("_per"):
            return LABELS.get(column, f"{column.removesuffix(ending).replace('_', ' ')} ({unit})"), scale
    return LABELS.get(column, column.replace("_", " ")), 1.0


def plot(outputs: Any, columns: list[str], over: str | None, axes: Any) -> Any:
    """Outputs.plot"""
    from matplotlib import pyplot
    if not columns:
        return overview(outputs, over)
    over = over or ("strain" if outputs.series["strain"].nunique() > 1 else "time_s")
    if axes is None:
        _, axes = pyplot.subplots(len(columns), 1, sharex=True, squeeze=False, constrained_layout=True,
                                  figsize=(6.4, 1.6 + 2.4 * len(columns)))
        axes = list(axes.flat)
    drawn = list(axes) if isinstance(axes, (list, tuple)) or hasattr(axes, "flat") else [axes]
    for column, axis in zip(columns, drawn, strict=True):
        plot_column(outputs, column, over, axis)
    drawn[-1].set_xlabel(label_of(over)[0])
    return drawn[0] if len(drawn) == 1 else drawn


def plot_column(outputs: Any, column: str, over: str, axis: Any) -> None:
    """Lines of a column of cells.csv or series.csv."""
    label, scale = label_of(column)
    along = label_of(over)[1]
    series = outputs.series
    if column in outputs.cells and column not in ("step", "time_s", "strain"):
        table = outputs.pivot(column, over)
        x = along * table.index.to_numpy()
        if table.shape[1] <= MOST_LINES:
            for number, cell in enumerate(table):
                style = ["-", "--"][number % 2]  # a pair of cells has one gap: both lines are to be seen
                axis.plot(x, scale * table[cell], style, label=f"cell {cell}")
            if 1 < table.shape[1]:
                axis.legend()
        else:
            axis.fill_between(x, scale * table.min(axis=1), scale * table.max(axis=1), alpha=0.25, linewidth=0,
                              label="smallest to largest")
            axis.plot(x, scale * table.mean(axis=1), label=f"mean of {table.shape[1]} cells")
            axis.legend()
    elif column in series and over in series:
        rows = series.drop_duplicates(over, keep="last")
        axis.plot(along * rows[over].to_numpy(), scale * rows[column].to_numpy())
    else:
        known = [name for name in (*outputs.cells, *series) if name not in ("step", "type", "stage_name")]
        import difflib
        missing = column if over in series else over
        near = difflib.get_close_matches(missing, known, 1)
        raise Error(Fault(f'there is no column "{missing}"' + (f'; did you mean "{near[0]}"?' if near else ""),
                          "columns: " + ", ".join(dict.fromkeys(known))))
    axis.set_ylabel(label)


def overview(outputs: Any, over: str | None) -> Any:
    """Cells at four instants, deformation and gaps."""
    from matplotlib import pyplot
    run = outputs._run
    frames = run.frames
    first, last = outputs._steps()
    frames = frames[frames["step"].between(first, last)]
    over = over or ("strain" if outputs.series["strain"].nunique() > 1 else "time_s")
    shown = frames.drop_duplicates(over, keep="last")
    shown = shown.iloc[[round(k * (len(shown) - 1) / 3) for k in range(4)]] if len(shown) > 4 else shown
    rows = (len(shown) + 1) // 2
    width, height = run.frame().size_m if len(shown) else (1.0, 1.0)
    figure = pyplot.figure(figsize=(9, 5 + rows * (0.6 + 4 * height / width)), constrained_layout=True)
    grid = figure.add_gridspec(rows + 2, 2, height_ratios=[0.6 + 4 * height / width] * rows + [2.5, 2.5])
    axes = [figure.add_subplot(grid[k // 2, k % 2]) for k in range(len(shown))]
    for k, (axis, (_, row)) in enumerate(zip(axes, shown.iterrows())):
        run._frame(row).plot(axes=axis)
        if k % 2:
            axis.set_ylabel("")
        if k < len(shown) - 2:
            axis.set_xlabel("")
    lines = [figure.add_subplot(grid[k, :]) for k in (rows, rows + 1)]
    plot(outputs, ["deformation", "min_gap_m"], over, lines)
    return [*axes, *lines]


def images(cell: Any, size_m: Sequence[float]) -> list[Any]:
    """Outlines [nodes, 2] of a cell in m, in the periodic box; on all sides where it reaches over the border. Between walls across
    y none does."""
    home = cell.moved_into(size_m)
    home[:, 1] -= size_m[1] * (home[:, 1].mean() // size_m[1])
    shifts = [(a * size_m[0], b * size_m[1]) for a in (-1, 0, 1) for b in (-1, 0, 1)]
    return [moved for shift in shifts if ((moved := home + shift).max(axis=0) > 0).all() and (moved.min(axis=0) < size_m[:2]).all()]


def wall_patches(frame: Any) -> list[Any]:
    """Walls that are no planes: one patch, in um."""
    import numpy
    from matplotlib.patches import PathPatch
    from matplotlib.path import Path
    if not len(frame.walls):
        return []
    closed = [1e6 * numpy.vstack([corners, corners[:1]]) for corners in frame.walls]
    codes = [code for corners in closed for code in (Path.MOVETO, *[Path.LINETO] * (len(corners) - 2), Path.CLOSEPOLY)]
    return [PathPatch(Path(numpy.vstack(closed), codes), facecolor="0.8", edgecolor="0.25", linewidth=0.8)]


def plot_frame(frame: Any, colour: str, field: str | None, axes: Any) -> Any:
    """Frame.plot"""
    import numpy
    from matplotlib import pyplot
    from matplotlib.collections import LineCollection
    if colour not in ("cell", "aggregate", "tension"):
        raise Error(f'colour is "cell", "aggregate" or "tension", not {colour!r}')
    if axes is None:
        _, axes = pyplot.subplots(constrained_layout=True)
    width, height = (1e6 * length for length in frame.size_m)
    bar = {"ax": axes, "shrink": min(0.9, 1.2 * height / width)}
    if field is not None:
        shown = frame.field(field).section()
        values = numpy.linalg.norm(shown.values, axis=2) if shown.values.ndim == 3 else shown.values
        mesh = axes.pcolormesh(1e6 * shown.x, 1e6 * shown.y, values, shading="nearest", cmap="Greys", rasterized=True)
        axes.figure.colorbar(mesh, label=f"{field} ({shown.unit})", **bar)
    for patch in wall_patches(frame):
        axes.add_patch(patch)
    largest = max((float(abs(cell.tension).max()) for cell in frame.cells), default=0.0)
    in_space = any(cell.triangles is not None for cell in frame.cells)
    for cell in frame.cells:
        for outline in images(cell, frame.size_m):
            closed = 1e6 * numpy.vstack([outline, outline[:1]])
            pieces = numpy.stack([closed[:-1], closed[1:]], axis=1) if colour == "tension" else [closed]
            lines = LineCollection(pieces, linewidths=1.5, capstyle="round")
            if colour == "tension":
                lines.set(cmap="coolwarm", array=1e6 * cell.section().tension, clim=(-1e6 * (largest or 1), 1e6 * (largest or 1)))
            else:
                lines.set_color(f"C{(cell.number if colour == 'cell' else cell.aggregate) % 10}")
            axes.add_collection(lines)
    if colour == "tension" and frame.cells:
        axes.figure.colorbar(lines, label="tension (µN/m)", **bar)
    axes.set(xlim=(0, width), ylim=(0, height), aspect="equal", xlabel="x (µm)", ylabel="y (µm)",
             title=f"strain {frame.strain:.2f}, {frame.time_s:.3g} s" + (", cells cut through their middles" if in_space else ""))
    return axes


def plot_frame_3d(frame: Any, colour: str, axes: Any, wrapped: bool) -> Any:
    """Frame.plot3d"""
    import itertools

    import numpy
    from matplotlib import pyplot
    if colour not in ("cell", "aggregate", "tension"):
        raise Error(f'colour is "cell", "aggregate" or "tension", not {colour!r}')
    if axes is None:
        axes = pyplot.figure(constrained_layout=True).add_subplot(projection="3d")
    elif not hasattr(axes, "plot_trisurf"):
        raise Error(Fault("these axes are flat", 'make them with figure.add_subplot(projection="3d")'))
    largest = 1e6 * max((float(abs(cell.tension).max()) for cell in frame.cells), default=0.0) or 1.0
    box = [1e6 * length for length in frame.box_m or frame.size_m]
    box += [0.0] * (3 - len(box))
    surface = None
    for cell in frame.cells:
        places = 1e6 * (cell.wrapped_into(frame.box_m or frame.size_m) if wrapped else cell.outline)
        shade = f"C{(cell.number if colour == 'cell' else cell.aggregate) % 10}"
        if cell.triangles is None:
            closed = numpy.vstack([places, places[:1]])
            axes.plot(closed[:, 0], closed[:, 1], numpy.zeros(len(closed)), color=shade)
        elif colour == "tension":
            surface = axes.plot_trisurf(*places.T, triangles=cell.triangles, cmap="coolwarm", vmin=-largest, vmax=largest, linewidth=0)
            surface.set_array(1e6 * cell.tension[cell.triangles].mean(axis=1))
        else:
            axes.plot_trisurf(*places.T, triangles=cell.triangles, color=shade, linewidth=0, shade=True)
    if surface is not None:
        axes.figure.colorbar(surface, ax=axes, label="tension (µN/m)", shrink=0.6, pad=0.15)
    corners = list(itertools.product((0, 1), repeat=3 if box[2] else 2))
    for a, b in itertools.combinations(corners, 2):
        if sum(x != y for x, y in zip(a, b)) == 1:
            axes.plot(*[[length * ends[0], length * ends[1]] for length, ends in zip(box, zip((*a, 0), (*b, 0)))], color="0.6", linewidth=0.8)
    flat = 0.3 * max(box)
    axes.set(xlim=(0, box[0]), ylim=(0, box[1]), zlim=(0, box[2]) if box[2] else (-flat / 2, flat / 2), xlabel="x (µm)", ylabel="y (µm)",
             zlabel="z (µm)", title=f"strain {frame.strain:.2f}, {frame.time_s:.3g} s")
    axes.set_box_aspect((box[0], box[1], box[2] or flat))
    return axes


class Animation:
    """Frames one after another. A notebook shows it as the last value of a cell."""

    def __init__(self, run: Any, most_frames: int, colour: str, field: str | None) -> None:
        frames = run.frames
        if field is not None:
            frames = frames[frames["fields"]]
        count = min(most_frames, len(frames))
        if count == 0:
            raise Error(Fault("there are no frames to animate", "", str(run.directory / "frames.h5")))
        self._run, self._colour, self._field = run, colour, field
        self._rows = frames.iloc[[round(k * (len(frames) - 1) / max(1, count - 1)) for k in range(count)]]

    def __len__(self) -> int:
        return len(self._rows)

    def _made(self) -> Any:
        from matplotlib import animation
        from matplotlib.figure import Figure
        from matplotlib.backends.backend_agg import FigureCanvasAgg
        frames = [self._run._frame(row) for _, row in self._rows.iterrows()]
        width, height = frames[0].size_m
        figure = Figure(figsize=(6.4, 1.0 + 5.6 * height / width), dpi=80)
        FigureCanvasAgg(figure)

        def draw(index: int) -> list[Any]:
            figure.clear()
            return [plot_frame(frames[index], self._colour, self._field, figure.add_subplot())]

        return animation.FuncAnimation(figure, draw, frames=len(frames), interval=100, init_func=lambda: [], cache_frame_data=False)

    def _repr_html_(self) -> str:
        return f'<div title="{html.escape(str(self._run.directory))}">{self._made().to_jshtml(default_mode="loop")}</div>'

    def save(self, path: str | os.PathLike[str]) -> pathlib.Path:
        """Writes an .html file that needs no network, a .gif, or with ffmpeg an .mp4, and returns its path."""
        path = pathlib.Path(path)
        partial = path.with_name(f".{path.stem}.partial{path.suffix}")
        try:
            if path.suffix == ".html":
                partial.write_text("<!doctype html><meta charset=utf-8>" + self._repr_html_(), encoding="utf-8")
            else:
                self._made().save(partial, writer="pillow" if path.suffix == ".gif" else "ffmpeg")
            partial.replace(path)
        finally:
            partial.unlink(missing_ok=True)
        return path
