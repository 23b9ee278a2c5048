"""Two runs side by side."""

from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Any, Iterator

from .reading import Run

if TYPE_CHECKING:
    import pandas


@dataclasses.dataclass(frozen=True)
class Comparison:
    """What differs between two runs."""

    a: Run  #: the first
    b: Run  #: the second
    #: with the quantity as index: `a`, `b`, `difference` (b - a), `error` of the difference, all in SI, and `differs`:
    #: whether the difference is larger than that error; None where the error is not known
    quantities: pandas.DataFrame
    #: with the JSON pointer as index: the values `a` and `b` of the scenes where they are not the same as written
    scenes: pandas.DataFrame

    def plot(self, column: str = "deformation", over: str | None = None, axes: Any = None, ax: Any = None) -> Any:
        """Draws a column of both runs over each other, `a` blue and `b` orange, and returns matplotlib's Axes. Arguments as
        in Outputs.plot."""
        from matplotlib.lines import Line2D
        drawn = self.a.plot(column, over=over, axes=axes, ax=ax)
        before = len(drawn.lines), len(drawn.collections)
        self.b.plot(column, over=over, axes=drawn)
        for artist in (*drawn.lines, *drawn.collections):
            artist.set_color("C0")
        for artist in (*drawn.lines[before[0]:], *drawn.collections[before[1]:]):
            artist.set_color("C1")
        drawn.legend([Line2D([], [], color="C0"), Line2D([], [], color="C1")], [self.a.directory.name, self.b.directory.name])
        return drawn

    def _repr_html_(self) -> str:
        return f"<div>{self.quantities._repr_html_()}{self.scenes._repr_html_()}</div>"


def compare(a: Run | str | os.PathLike[str], b: Run | str | os.PathLike[str]) -> Comparison:
    """Compares two runs, or the runs in two directories: their results and their scenes."""
    import pandas
    first, second = (run if isinstance(run, Run) else Run(run) for run in (a, b))
    table = first.results[["value", "error"]].join(second.results[["value", "error"]], lsuffix="_a", rsuffix="_b", how="outer")
    difference = table["value_b"] - table["value_a"]
    error = (table["error_a"].astype(float) ** 2 + table["error_b"].astype(float) ** 2) ** 0.5
    differs = (difference.abs() > error).astype(object).where(error.notna() & difference.notna(), None)
    quantities = pandas.DataFrame({"a": table["value_a"], "b": table["value_b"], "difference": difference, "error": error,
                                   "differs": differs})
    left, right = dict(_leaves(first.scene)), dict(_leaves(second.scene))
    rows = {pointer: (left.get(pointer), right.get(pointer)) for pointer in [*left, *(p for p in right if p not in left)]
            if left.get(pointer) != right.get(pointer)}
    scenes = pandas.DataFrame.from_dict(rows, orient="index", columns=["a", "b"]).rename_axis("pointer")
    return Comparison(first, second, quantities, scenes)


def _leaves(value: Any, pointer: str = "") -> Iterator[tuple[str, Any]]:
    if isinstance(value, dict) and value:
        for key, item in value.items():
            yield from _leaves(item, f"{pointer}/{key.replace('~', '~0').replace('/', '~1')}")
    elif isinstance(value, list) and value:
        for index, item in enumerate(value):
            yield from _leaves(item, f"{pointer}/{index}")
    else:
        yield pointer, value
