"""The shear stress at which rouleaux part: a ramp, and steps around what it finds."""

from __future__ import annotations

import json
import math
import os
import pathlib
from typing import TYPE_CHECKING, Any, Mapping, NamedTuple

from .errors import Error, Fault
from .running import ProgressLike
from .scenes import SceneLike, as_json, pointer_of, quantity_text, text_of
from .sweeping import Job, at_once, number_and_unit, run_all

if TYPE_CHECKING:
    import pandas

DRIVES = ("shear_rate", "walls", "pressure_gradient", "mean_velocity", "forces")


class BreakUp(NamedTuple):
    """Where the aggregates of a scene part. All in SI."""

    stress_Pa: float  #: viscosity of the suspending fluid times shear rate: middle between the highest that held and the lowest that parted
    bar_Pa: float  #: half of their distance
    shear_rate_per_s: float  #: of that stress
    adhesion_number: float  #: depth of the well / (stress x radius of the first cell type); nan without a well
    strain: float  #: at the lowest rate that parted, from the start of shear
    ramp_stress_Pa: float  #: at which the ramp parted: higher, for parting takes time; nan without a ramp
    cells: int  #: of the largest aggregate with which shear began
    runs: pandas.DataFrame  #: a row for each: `kind` (ramp, step), `shear_rate_per_s`, `stress_Pa`, `parted`, `strain`, `directory`

    def __str__(self) -> str:
        return f"{self.stress_Pa:.3g} +- {self.bar_Pa:.2g} Pa ({self.shear_rate_per_s:.4g} 1/s), {self.cells} cells"


def break_up(scene: SceneLike, *, most: Any = "400 1/s", ramp: Any = "1 s", strain: float = 15.0, tolerance: float = 0.05,
             out: str | os.PathLike[str] = "runs/break-up", workers: int | None = None, fresh: bool = False,
             progress: ProgressLike = None, **changes: Any) -> BreakUp:
    """The shear stress at which the aggregates of a scene part.

    The stages of `scene` that nothing drives stay, and let aggregates form; shear takes the place of the others, with the
    `density_factor` of the first of them. First it rises evenly from 0 to `most` within `ramp`, until none of the aggregates
    is joined as a whole (`"until": "parted"`); with `ramp=None` the first steady rate is `most` instead. Steady rates follow,
    each for a `strain` in a flow that is developed when it begins, as many at a time as there are `workers` (None:
    processors). What holds and what parts close in on a rate, to `tolerance` of it. `changes` as in `run`. Runs go to `out`,
    and those that are there are not made again unless `fresh`.

    A fluid that is simulated denser than it is lags behind a ramp (`plan`): the steps tell, not the ramp. Cells are together
    by their energy (`output.bond_share`), and one that leaves and comes back has parted. A pair that turns in shear is
    pulled apart and pressed together by turns, a quarter of a turn each: give it a strain in which it turns by half. Throws
    Error where nothing is joined when shear begins, where `most` parts none, and for bad input.
    """
    import pandas
    try:
        content = json.loads(as_json(scene) if isinstance(scene, Mapping) else text_of(scene))
        stages = [stage for stage in content["stages"] if not any(key in stage for key in DRIVES)]
        driven = [stage for stage in content["stages"] if stage not in stages][:1]
    except (ValueError, KeyError, TypeError):
        stages, driven = [], []  # the program says what is wrong
    kept = {key: driven[0][key] for key in ("density_factor",) if driven and key in driven[0]}
    lasts, lasts_unit = (math.inf, "") if ramp is None else number_and_unit(ramp) or (0.0, "")
    fastest, unit = number_and_unit(most) or (0.0, "")
    if not (lasts > 0 and fastest > 0 and strain > 0 and 0 < tolerance < 1):
        raise Error(Fault(f"most is {most!r}, ramp {ramp!r}, strain {strain!r} and tolerance {tolerance!r}",
                          "give a rate such as \"400 1/s\", a time such as \"1 s\" or None, and numbers above 0"))
    if named := [key for key in changes if pointer_of(key).startswith("/stages")]:
        raise Error(Fault(f"{named[0]} would be lost: stages are made anew", "change the stages in the scene itself"))
    rows: list[dict[str, Any]] = []
    rows_due: dict[str, Any] = {"strain": 0.25, **({} if ramp is None else {"seconds": f"{lasts / 200!r} {lasts_unit}"})}
    together = 0
    adhesion = math.nan

    def sheared(kind: str, drives: list[dict[str, Any]]) -> None:
        nonlocal together, adhesion
        jobs = [Job({kind: drive["shear_rate"] if kind == "step" else quantity_text(most)},
                    {**changes, "/stages": [*stages, {"name": "shear", "until": "parted", **kept, **drive}],
                     "/output/cells": rows_due}) for drive in drives]
        made = run_all(scene, jobs, pathlib.Path(out), workers, False, fresh, progress)
        for run in made:
            if run.status != "completed":
                raise Error(Fault(f"a run of it ended as {run.status}", "see its report; a lower density_factor keeps fast shear stable",
                                  str(run.directory)), run=run)
            last = run.series.iloc[-1]
            at_start = [len(one["members"]) for one in run.summary.rheology[-1].dissociation]
            if not at_start:
                raise Error(Fault("no cells are joined when shear begins",
                                  "let a stage at rest go before, long enough for them to join", str(run.directory)))
            together = max(at_start)
            stress = (last["wall_stress_lower_Pa"] - last["wall_stress_upper_Pa"]) / 2 / last["relative_viscosity"]
            rate = float(last["shear_rate_1_per_s"])
            begun = run.series["strain"][run.series["stage_name"] != "shear"]
            rows.append({"kind": kind, "shear_rate_per_s": rate, "stress_Pa": float(stress),
                         "parted": run.summary.stages[-1].ended_by == "parted",
                         "strain": float(last["strain"]) - (float(begun.iloc[-1]) if len(begun) else 0.0),
                         "directory": str(run.directory)})
            if kind == "step":
                number = run.summary.dimensionless.get("adhesion_number")
                adhesion = math.nan if number is None else number * rate

    def step(rates: list[float]) -> None:
        sheared("step", [{"shear_rate": f"{rate:.6g} 1/s", "strain": strain, "start": "developed"} for rate in rates])

    first, ramp_stress, reach = fastest, math.nan, fastest
    if ramp is not None:
        sheared("ramp", [{"shear_rate": {"from": f"0 {unit}", "to": quantity_text(most)}, "duration": quantity_text(ramp)}])
        if not rows[0]["parted"]:
            raise Error(Fault(f"no aggregate parted up to {quantity_text(most)}", "give a higher rate as most, or a longer ramp",
                              rows[0]["directory"]))
        first, ramp_stress = rows[0]["shear_rate_per_s"], rows[0]["stress_Pa"]
        reach = 4 * first
    parts = at_once(workers) + 1
    low, high, guess = 0.0, math.inf, first
    while high - low > 2 * tolerance * high or not math.isfinite(high):
        if min(guess, high) < 1e-3 * first or (guess > reach and math.isinf(high)):
            raise Error(Fault("steady shear parts it at any rate" if high < guess else f"nothing parts within a strain of {strain:g}",
                              "let a stage at rest go before" if high < guess else "give a larger strain or a higher rate as most",
                              rows[-1]["directory"]))
        step([guess] if math.isinf(high) else [low + (high - low) * (k + 1) / parts for k in range(parts - 1)])
        guess *= 2
        steps = [row for row in rows if row["kind"] == "step"]
        high = min((row["shear_rate_per_s"] for row in steps if row["parted"]), default=math.inf)
        low = max((row["shear_rate_per_s"] for row in steps if not row["parted"]), default=0.0)
    low, high = min(low, high), max(low, high)  # one that held may lie above one that parted: the bar has both
    lowest = min((row for row in rows if row["kind"] == "step" and row["parted"]), key=lambda row: float(row["shear_rate_per_s"]))
    viscosity = lowest["stress_Pa"] / lowest["shear_rate_per_s"]
    rate = (low + high) / 2
    return BreakUp(viscosity * rate, viscosity * (high - low) / 2, rate, adhesion / rate, lowest["strain"], ramp_stress,
                   together, pandas.DataFrame(rows))
