"""Parameters from observations: which values make runs give what was measured."""

from __future__ import annotations

import concurrent.futures
import dataclasses
import hashlib
import html
import itertools
import json
import math
import os
import pathlib
from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Sequence, Union

from .errors import Error, Fault
from .means import mean_of_seeds
from .pages import Line, chart, link, number, table as html_table, with_bar, write_page, write_whole
from .reading import Run
from .running import ProgressLike
from .scenes import SceneLike, as_json, floats, hashes_of_files, named, text_of, whole
from .surrogate import Process
from .sweeping import Job, at_once, number_and_unit, places_of_seeds, run_all, short_names, unit_word

if TYPE_CHECKING:
    import numpy
    import pandas
    from numpy.typing import NDArray

    Floats = NDArray[numpy.float64]

#: What takes the place of a scene: a function of the parameters' numbers to what would be observed, (value, error) each.
Simulator = Callable[[Mapping[str, float]], Mapping[str, Any]]
FIRST_POINTS = {1: 4, 2: 9, 3: 15}
MOST_POINTS = {1: 12, 2: 30, 3: 50}
GRID = {1: 2001, 2: 71, 3: 25}  # places along each axis
LOGARITHMIC_FROM = 10.0  # ratio of the bounds
FLAT = 0.8  # share of its range that a parameter's 95 % interval may have; all is alike where it has 0.95
MISFIT = 3.5  # standard errors
SURROGATE_SHARE = 0.05  # of an observation's variance that may come from the surrogate
LEAST_MORE = 4  # points beside the first, for each parameter: fewer say too little about how bent a function is
LEAST_FOR_FLAT = 2  # the same before a parameter is called flat
DRAWS = 64


@dataclasses.dataclass(frozen=True)
class Calibration:
    """Parameters that give what was observed, with their uncertainty and the runs that say so."""

    parameters: pandas.DataFrame  #: by key: `value` (the median), `low` and `high` (95 % interval), `low68` and `high68`, `unit`
    fit: pandas.DataFrame  #: by name: `observed`, its `error`, `fitted` and `fitted_error`, `residual` in standard errors
    runs: pandas.DataFrame  #: each point: the numbers of the parameters, for each observation value and error, `chi2`, `directories`
    changes: dict[str, Any]  #: the values as changes of the scene: `rouleau.run(scene, **found.changes)`
    notes: list[str]  #: what to know before it is used; empty where there is nothing
    page: pathlib.Path | None  #: calibration.html; None without

    def __str__(self) -> str:
        lines = [f"{key} = {row.value:.4g} {row.unit}".rstrip() + f" (95 %: {row.low:.4g} to {row.high:.4g})"
                 for key, row in self.parameters.iterrows()]
        return "\n".join([*lines, *self.notes])

    def _repr_html_(self) -> str:
        return f"<pre>{html.escape(str(self))}</pre>"


class _Axis(NamedTuple):
    key: str
    name: str
    low: float
    high: float
    unit: str
    logarithmic: bool

    def value(self, u: float) -> float:
        made = self.low * (self.high / self.low) ** u if self.logarithmic else self.low + u * (self.high - self.low)
        return float(f"{made:.6g}")  # what a scene and the name of a directory have

    def place(self, value: float) -> float:
        if self.logarithmic:
            return math.log(value / self.low) / math.log(self.high / self.low)
        return (value - self.low) / (self.high - self.low)

    def setting(self, value: float) -> Any:
        return f"{value!r} {self.unit}" if self.unit else value


class _Goal(NamedTuple):
    name: str
    value: float
    error: float
    measure: Callable[[Run], Any]


class _Point(NamedTuple):
    u: tuple[float, ...]
    values: tuple[float, ...]
    found: tuple[tuple[float, float], ...]  # value and error of each goal; nan where a run has none
    directories: tuple[str, ...]


def calibrate(scene: Union[SceneLike, Simulator], parameters: Mapping[str, tuple[Any, Any]], observed: Mapping[str, Sequence[Any]], *,
              seeds: Sequence[int] | None = None, out: str | os.PathLike[str] = "runs/calibrate", workers: int | None = None,
              most_points: int | None = None, fresh: bool = False, page: bool = True, progress: ProgressLike = None,
              **changes: Any) -> Calibration:
    """Finds the values of one to three parameters with which runs of a scene give what was observed.

    `parameters`: for each key or JSON pointer the lowest and the highest value, in one unit: `{"/interactions/0/parameters/
    depth": ("1e-8 J/m2", "1e-5 J/m2")}`. Where positive bounds differ tenfold or more the logarithm is searched.
    `observed`: for each name (value, standard error), in SI. A name is a path in summary.json with dots ("dimensionless.capillary",
    "rheology.-1.means.relative_viscosity"; -1 is the last of a list), or a quantity of `Run.results`. Or it is any word, with
    a function of the run as third entry: (value, error, function), which gives a number, a Mean or a Statistics. In place of a scene there may be a
    function of the parameters' numbers to {name: number or (value, error)}.

    One parameter and one observation that rises or falls with it: bisection. Else the next points are those where a
    Gaussian process, made of all runs so far, expects the greatest improvement, or is least sure where it matters. Each
    point is run once, or once with each of `seeds`; at most `most_points` (12, 30, 50 for one, two, three parameters).
    Runs are in `out` and are not made again, as in `sweep`; another observation takes all of them. `page`: calibration.html.

    The answer has 95 % intervals, which hold the observations' errors, those of the runs, and what is between the runs.
    Throws Error for bad input, where the observation cannot decide a parameter ("flat"), and where no value gives it.
    """
    folder, count = pathlib.Path(out), at_once(workers)
    axes = _axes(parameters)
    goals = _goals(observed)
    limit = whole("most_points", most_points, FIRST_POINTS[len(axes)]) if most_points is not None else MOST_POINTS[len(axes)]
    if callable(scene):
        if seeds is not None or changes:
            raise Error(Fault("a function takes neither seeds nor changes", "let it do both itself"))
        evaluate = _of_function(scene, axes, goals, count)
        known: list[tuple[float, ...]] = []
    else:
        evaluate = _of_scene(scene, axes, goals, seeds, folder, workers, fresh, progress, changes)
        memory, known = _remembered(scene, axes, seeds, folder, changes)
    points: list[_Point] = []

    def compute(places: Sequence[Sequence[float]]) -> None:
        there = {point.values for point in points}
        wanted = [tuple(axis.value(u) for axis, u in zip(axes, place)) for place in places]
        new = [values for values in dict.fromkeys(wanted) if values not in there]
        for values, (found, directories) in zip(new, evaluate(new)):
            points.append(_Point(tuple(axis.place(v) for axis, v in zip(axes, values)), values, found, directories))
        if not callable(scene):
            write_whole(folder / "points.json", json.dumps({**_memories(folder), memory: [list(point.values) for point in points]}))

    compute([[axis.place(value) for axis, value in zip(axes, values)] for values in known])
    compute(_first(len(axes)))
    _check(points, goals)
    most = max(limit, len(known))
    while len(points) < most:
        before = len(points)
        room = min(count, most - before)
        bracket = _bracket(points, goals) if len(axes) == 1 and len(goals) == 1 else None
        if bracket is not None:
            compute([[bracket[0] + (bracket[1] - bracket[0]) * k / (room + 1)] for k in range(1, room + 1)])
        else:
            belief = _Belief(points, goals, len(axes))
            more = (before - len(_first(len(axes)))) / len(axes)
            if (more >= LEAST_FOR_FLAT and belief.is_flat_whatever_comes()) or (more >= LEAST_MORE and belief.is_sure()):
                break
            compute(belief.next_places(room))
        if len(points) == before:
            break
    return _answer(_Belief(points, goals, len(axes)), axes, goals, points, folder, page)


def _axes(parameters: Mapping[str, tuple[Any, Any]]) -> list[_Axis]:
    parameters = named("parameters", parameters)
    if not 1 <= len(parameters) <= 3:
        raise Error(Fault(f"there are {len(parameters)} parameters", "give one, two or three"))
    axes = []
    for name, (key, bounds) in zip(short_names(list(parameters)), parameters.items()):
        parts = [number_and_unit(bound) for bound in bounds] if isinstance(bounds, (tuple, list)) else []
        if len(parts) != 2 or parts[0] is None or parts[1] is None or parts[0][1] != parts[1][1] or not parts[0][0] < parts[1][0]:
            raise Error(Fault(f"{key} has the range {bounds!r}", 'give the lowest and the highest value in one unit: ("1e-8 J/m2", "1e-5 J/m2")'))
        (low, unit), (high, _) = parts[0], parts[1]
        axes.append(_Axis(key, name, low, high, unit, low > 0 and high / low >= LOGARITHMIC_FROM))
    return axes


def _goals(observed: Mapping[str, Sequence[Any]]) -> list[_Goal]:
    goals = []
    for name, entry in named("observed", observed).items():
        good = isinstance(entry, (tuple, list)) and len(entry) in (2, 3) and all(isinstance(part, (int, float)) for part in entry[:2]) \
            and all(map(callable, entry[2:]))
        if not good or not (entry[1] > 0 and math.isfinite(entry[0]) and math.isfinite(entry[1])):
            raise Error(Fault(f'"{name}" was observed as {entry!r}', "give (value, standard error) with an error above 0, in SI; and a "
                              "function of the run as third entry where the name is in no summary.json"))
        measure = entry[2] if len(entry) == 3 else (lambda run, path=name: quantity_of(run, path))
        goals.append(_Goal(name, float(entry[0]), float(entry[1]), measure))
    if not goals:
        raise Error(Fault("nothing was observed", 'give observed={"relative_viscosity": (1.8, 0.1)}'))
    return goals


def quantity_of(run: Run, path: str) -> Any:
    """What a path with dots leads to in summary.json, or a quantity of Run.results. Throws Error where there is neither."""
    here: Any = run.summary
    for word in path.split("."):
        if isinstance(here, Mapping) and word in here:
            here = here[word]
        elif isinstance(here, list) and word.lstrip("-").isdigit():
            here = here[int(word)] if -len(here) <= int(word) < len(here) else None
        elif here is None:
            return math.nan  # what did not happen in this run
        else:
            results = run.results
            if path in results.index:
                return tuple(results.loc[path, ["value", "error"]])
            there = ", ".join(here) if isinstance(here, Mapping) else f"{len(here)} entries" if isinstance(here, list) else "a value"
            raise Error(Fault(f'"{path}" is neither in summary.json nor in the results: before "{word}" there is {there}',
                              "results: " + ", ".join(results.index), str(run.directory / "summary.json")))
    return here


def _value_and_error(found: Any) -> tuple[float, float]:
    """Of a number, a pair, a Mean, or an object of summary.json; the error is nan where there is none."""
    if isinstance(found, Mapping):
        value, error = found.get("value", found.get("mean")), found.get("error")
    elif hasattr(found, "value") and hasattr(found, "error"):
        value, error = found.value, found.error
    elif isinstance(found, (tuple, list)) and len(found) == 2:
        value, error = found
    else:
        value, error = found, None
    if isinstance(value, str):
        value = [value]  # a number in words is none
    made = floats("this is no number with its error", [value, error], "name one, or give a function that returns one").tolist()
    return made[0], made[1]


Evaluate = Callable[[Sequence[tuple[float, ...]]], list[tuple[tuple[tuple[float, float], ...], tuple[str, ...]]]]


def _of_function(function: Simulator, axes: Sequence[_Axis], goals: Sequence[_Goal], workers: int) -> Evaluate:
    def one(values: tuple[float, ...]) -> tuple[tuple[tuple[float, float], ...], tuple[str, ...]]:
        answer = named("the function gave", function(dict(zip((axis.key for axis in axes), values))))
        if missing := [goal.name for goal in goals if goal.name not in answer]:
            raise Error(Fault(f'the function gave no "{missing[0]}"', "it gave: " + ", ".join(map(str, answer))))
        return tuple(_value_and_error(answer[goal.name]) for goal in goals), ()

    def evaluate(points: Sequence[tuple[float, ...]]) -> list[tuple[tuple[tuple[float, float], ...], tuple[str, ...]]]:
        with concurrent.futures.ThreadPoolExecutor(workers) as pool:
            return list(pool.map(one, points))
    return evaluate


def _of_scene(scene: SceneLike, axes: Sequence[_Axis], goals: Sequence[_Goal], seeds: Sequence[int] | None, folder: pathlib.Path,
              workers: int | None, fresh: bool, progress: ProgressLike, changes: Mapping[str, Any]) -> Evaluate:
    keys = [axis.key for axis in axes]
    places = places_of_seeds(scene, changes, keys) if seeds is not None else []

    def evaluate(points: Sequence[tuple[float, ...]]) -> list[tuple[tuple[tuple[float, float], ...], tuple[str, ...]]]:
        jobs = []
        chosen: list[int | None] = list(seeds) if seeds else [None]
        for values, seed in itertools.product(points, chosen):
            settings = {axis.key: axis.setting(value) for axis, value in zip(axes, values)}
            named = {axis.name: settings[axis.key] for axis in axes}
            jobs.append(Job({**named, **({} if seed is None else {"seed": seed})},
                            {**changes, **settings, **({} if seed is None else {place: seed for place in places})}))
        runs = run_all(scene, jobs, folder, workers, False, fresh, progress)
        each = len(seeds or (0,))
        return [_of_runs(runs[k:k + each], goals) for k in range(0, len(runs), each)]
    return evaluate


def _of_runs(runs: Sequence[Run], goals: Sequence[_Goal]) -> tuple[tuple[tuple[float, float], ...], tuple[str, ...]]:
    done = [run for run in runs if run.status == "completed"]
    found = []
    for goal in goals:
        pairs = [pair for pair in (_value_and_error(goal.measure(run)) for run in done) if math.isfinite(pair[0])]
        mean = mean_of_seeds([value for value, _ in pairs], [error for _, error in pairs])
        found.append((mean.value, mean.error))
    return tuple(found), tuple(str(run.directory) for run in runs)


def _memories(folder: pathlib.Path) -> dict[str, Any]:
    try:
        found = json.loads((folder / "points.json").read_text(encoding="utf-8"))
        return found if isinstance(found, dict) else {}
    except (OSError, ValueError):
        return {}


def _remembered(scene: SceneLike, axes: Sequence[_Axis], seeds: Sequence[int] | None, folder: pathlib.Path,
                changes: Mapping[str, Any]) -> tuple[str, list[tuple[float, ...]]]:
    """What the points of these runs are kept under, and those that are there and in the ranges."""
    content = as_json(scene) if isinstance(scene, Mapping) else text_of(scene)
    whole_key = json.dumps([content, as_json(dict(changes)), [(axis.key, axis.unit) for axis in axes], list(seeds or ()),
                            hashes_of_files(scene, changes)])
    key = hashlib.sha256(whole_key.encode()).hexdigest()[:16]
    kept = _memories(folder).get(key, [])
    return key, [tuple(map(float, values)) for values in kept if len(values) == len(axes) and
                 all(axis.low <= value <= axis.high for axis, value in zip(axes, values))]


def _first(axes: int) -> list[list[float]]:
    """Points to begin with: ends and thirds; in two and three dimensions corners, the middle, and between."""
    if axes == 1:
        return [[0.0], [1.0], [1 / 3], [2 / 3]]
    corners = [list(corner) for corner in itertools.product((0.05, 0.95), repeat=axes)]
    faces = [[0.5 if k != axis else side for k in range(axes)] for axis in range(axes) for side in (0.2, 0.8)]
    return [*corners, [0.5] * axes, *faces]


def _usable(points: Sequence[_Point]) -> list[_Point]:
    return [point for point in points if all(math.isfinite(value) for value, _ in point.found)]


def _check(points: Sequence[_Point], goals: Sequence[_Goal]) -> None:
    bad = [point for point in points if point not in _usable(points)]
    if 2 * len(bad) > len(points):
        missing = ", ".join(goal.name for k, goal in enumerate(goals) if any(not math.isfinite(point.found[k][0]) for point in bad))
        raise Error(Fault(f"of {len(points)} runs {len(bad)} failed or have no {missing}",
                          "look at their reports; give narrower ranges: " + ", ".join(map(str, (bad[0].directories or bad[0].values)))))


def _bracket(points: Sequence[_Point], goals: Sequence[_Goal]) -> tuple[float, float] | None:
    """The two neighbours between which one observation of one parameter lies. None where it does not rise or fall with it
    alone, lies outside, or the neighbours differ by no more than the errors."""
    ordered = sorted(_usable(points))
    pairs = list(zip(ordered, ordered[1:]))

    def noise(point: _Point) -> float:
        return point.found[0][1] if math.isfinite(point.found[0][1]) else 0.0

    steps = [b.found[0][0] - a.found[0][0] for a, b in pairs]
    rises = sum(steps) > 0
    against = [step for step, (a, b) in zip(steps, pairs) if (step < 0) == rises and abs(step) > 2 * math.hypot(noise(a), noise(b))]
    around = [(a, b) for a, b in pairs if (a.found[0][0] - goals[0].value) * (b.found[0][0] - goals[0].value) <= 0]
    if against or len(around) != 1:
        return None
    a, b = around[0]
    if abs(b.found[0][0] - a.found[0][0]) <= max(goals[0].error, 2 * math.hypot(noise(a), noise(b))):
        return None
    return a.u[0], b.u[0]


class _Belief:
    """What the points so far say: a surrogate for each observation, and how likely each place is."""

    def __init__(self, points: Sequence[_Point], goals: Sequence[_Goal], axes: int) -> None:
        import numpy
        usable = _usable(points)
        if len(usable) < 2:
            raise Error(Fault("fewer than two runs have what was observed", "look at their reports; give narrower ranges"))
        self.axes, self.goals, self.failed = axes, goals, [numpy.array(point.u) for point in points if point not in usable]
        self.u = numpy.array([point.u for point in usable])
        self.processes = [Process(self.u, [point.found[k][0] for point in usable],
                                  [point.found[k][1] if math.isfinite(point.found[k][1]) else 0.0 for point in usable])
                          for k in range(len(goals))]
        low, high = numpy.zeros(axes), numpy.ones(axes)
        for _ in range(3):  # again where it is likely, more finely
            self.ticks = [numpy.linspace(low[k], high[k], GRID[axes]) for k in range(axes)]
            self.places = numpy.stack([part.ravel() for part in numpy.meshgrid(*self.ticks, indexing="ij")], axis=1)
            logs = self.log_likelihood(self.places, self.processes)
            near = self.places[logs > logs.max() - 20]
            step = (high - low) / (GRID[axes] - 1)
            low, high = numpy.maximum(near.min(axis=0) - step, 0), numpy.minimum(near.max(axis=0) + step, 1)
        weights = numpy.exp(logs - logs.max())
        self.weights = weights / weights.sum()
        self.best = self.places[int(numpy.argmax(logs))]

    def log_likelihood(self, places: Any, processes: Sequence[Process], sure: bool = False) -> Any:
        import numpy
        total = numpy.zeros(len(places))
        for goal, process in zip(self.goals, processes):
            mean, spread = process.at(places)
            variance = goal.error ** 2 + (0 if sure else spread ** 2)
            total += -0.5 * (mean - goal.value) ** 2 / variance - 0.5 * numpy.log(variance / goal.error ** 2)
        return total

    def marginal(self, axis: int) -> Any:
        """Probability of each of the places along an axis."""
        shape = [len(ticks) for ticks in self.ticks]
        return self.weights.reshape(shape).sum(axis=tuple(k for k in range(self.axes) if k != axis))

    def quantiles(self, axis: int, shares: Sequence[float], weights: Any = None, ticks: Any = None) -> list[float]:
        import numpy
        density = self.marginal(axis) if weights is None else weights
        x = self.ticks[axis] if ticks is None else ticks
        pieces = numpy.append(0.0, (density[1:] + density[:-1]) / 2)  # a density, by trapezes
        along = numpy.cumsum(pieces) / pieces.sum()
        return [float(numpy.interp(share, along, x)) for share in shares]

    def is_flat_whatever_comes(self) -> bool:
        """Whether a parameter stays undecided even were the surrogate exact."""
        import numpy
        ticks = numpy.linspace(0, 1, 41 if self.axes < 3 else 21)
        places = numpy.stack([part.ravel() for part in numpy.meshgrid(*[ticks] * self.axes, indexing="ij")], axis=1)
        logs = self.log_likelihood(places, self.processes, sure=True)
        weights = numpy.exp(logs - logs.max()).reshape([len(ticks)] * self.axes)
        ends = [self.quantiles(0, (0.025, 0.975), weights.sum(axis=tuple(k for k in range(self.axes) if k != axis)), ticks)
                for axis in range(self.axes)]
        return any(high - low > FLAT for low, high in ends)

    def flat_axes(self) -> list[int]:
        """Parameters that the observations do not decide."""
        return [axis for axis in range(self.axes) if (lambda ends: ends[1] - ends[0] > FLAT)(self.quantiles(axis, (0.025, 0.975)))]

    def is_sure(self) -> bool:
        """Whether what is between the points adds little to the observations' errors."""
        return all(float(self.weights @ process.at(self.places)[1] ** 2) < SURROGATE_SHARE * goal.error ** 2
                   for goal, process in zip(self.goals, self.processes))

    def next_places(self, count: int) -> list[Any]:
        """Where to compute next: in turn where the greatest improvement is expected and where the surrogates are least sure
        of what is likely."""
        import numpy
        noise = numpy.random.default_rng(1)
        candidates = numpy.vstack([noise.random((600, self.axes)), self.places[noise.choice(len(self.places), 400, p=self.weights)]])
        candidates = numpy.clip(candidates + noise.normal(0, 0.01, candidates.shape), 0, 1)
        for place in self.failed:
            candidates = candidates[numpy.linalg.norm(candidates - place, axis=1) > 0.05]
        draws = noise.normal(size=(len(self.goals), DRAWS))
        processes, chosen = list(self.processes), []
        for turn in range(count):
            if (len(self.u) + turn) % 2 == 0:
                reached = sum(((process.at(self.u)[0] - goal.value) / goal.error) ** 2 for goal, process in zip(self.goals, processes)).min()
                drawn = numpy.zeros((len(candidates), DRAWS))
                for goal, process, shares in zip(self.goals, processes, draws):
                    mean, spread = process.at(candidates)
                    drawn += ((mean[:, None] + spread[:, None] * shares - goal.value) / goal.error) ** 2
                merit = numpy.maximum(reached - drawn, 0).mean(axis=1)
            else:
                merit = numpy.zeros(len(candidates))
            if merit.max() <= 0:
                logs = self.log_likelihood(candidates, processes)
                spreads = sum((process.at(candidates)[1] / goal.error) ** 2 for goal, process in zip(self.goals, processes))
                merit = numpy.exp(0.5 * (logs - logs.max())) * spreads
            place = candidates[int(numpy.argmax(merit))]
            chosen.append(place)
            processes = [process.believing(place) for process in processes]
        return chosen


def _answer(belief: _Belief, axes: Sequence[_Axis], goals: Sequence[_Goal], points: Sequence[_Point], folder: pathlib.Path,
            page: bool) -> Calibration:
    import numpy
    import pandas
    rows, notes = {}, []
    for k, axis in enumerate(axes):
        low, low68, middle, high68, high = (axis.value(u) for u in belief.quantiles(k, (0.025, 0.16, 0.5, 0.84, 0.975)))
        rows[axis.key] = (middle, low, high, low68, high68, axis.unit)
        density = belief.marginal(k)
        for end, there, word in ((density[0], belief.ticks[k][0] <= 0, "lower"), (density[-1], belief.ticks[k][-1] >= 1, "upper")):
            if there and end > 0.2 * density.max():
                notes.append(f"{axis.key} is likely up to the {word} end of its range: the value may lie beyond it")
    parameters = pandas.DataFrame.from_dict(rows, orient="index", columns=["value", "low", "high", "low68", "high68", "unit"])
    middle_place = numpy.array([[axis.place(rows[axis.key][0]) for axis in axes]])
    compared = {}
    for goal, process in zip(goals, belief.processes):
        at_best = [float(part[0]) for part in process.at(belief.best[None, :] if len(axes) > 1 else middle_place)]
        compared[goal.name] = (goal.value, goal.error, *at_best, (at_best[0] - goal.value) / math.hypot(goal.error, at_best[1]))
    fit = pandas.DataFrame.from_dict(compared, orient="index", columns=["observed", "error", "fitted", "fitted_error", "residual"])
    listed = []
    for point in points:
        row: dict[str, Any] = {f"{axis.name}_{unit_word(axis.unit)}" if axis.unit else axis.name: v for axis, v in zip(axes, point.values)}
        for goal, (value, error) in zip(goals, point.found):
            row.update({goal.name: value, f"{goal.name}_error": error})
        row["chi2"] = sum(((value - goal.value) / math.hypot(goal.error, error if math.isfinite(error) else 0)) ** 2
                          for goal, (value, error) in zip(goals, point.found))
        listed.append({**row, "directories": list(point.directories)})
    runs = pandas.DataFrame(listed)
    failed = len(points) - len(_usable(points))
    if failed:
        notes.append(f"{failed} of {len(points)} points failed or have no value; they are left out")
    if not belief.is_sure():
        notes.append("what is between the runs still adds to the interval: more points (most_points) or seeds narrow it")
    flat = belief.flat_axes()
    verdict = None
    if (fit["residual"].abs() > MISFIT).any():
        name = str(fit["residual"].abs().idxmax())
        worst = fit.loc[name]
        verdict = Fault(f"no value in the ranges gives what was observed: the nearest has {name} = {worst['fitted']:.4g}, "
                        f"{abs(worst['residual']):.1f} standard errors from {worst['observed']:.4g}",
                        "widen the ranges, or look whether the scene is what was observed")
    elif flat:
        names = " and ".join(axes[k].key for k in flat)
        verdict = Fault(f"flat: the observations do not decide {names}; from {axes[flat[0]].value(0):.4g} to {axes[flat[0]].value(1):.4g} "
                        "they are met almost alike", "observe something that depends on it, or more precisely, or give it a fixed value")
    written = _page(belief, axes, goals, points, parameters, fit, notes, verdict, folder) if page else None
    if verdict is not None:
        raise Error(Fault(verdict.problem, verdict.remedy + (f"; {written} shows the runs" if written else "")))
    return Calibration(parameters, fit, runs, {axis.key: axis.setting(rows[axis.key][0]) for axis in axes}, notes, written)


def _page(belief: _Belief, axes: Sequence[_Axis], goals: Sequence[_Goal], points: Sequence[_Point], parameters: pandas.DataFrame,
          fit: pandas.DataFrame, notes: Sequence[str], verdict: Fault | None, folder: pathlib.Path) -> pathlib.Path:
    """calibration.html: values, fit and residuals, runs."""
    import numpy
    path = folder / "calibration.html"
    parts = []
    if verdict is None:
        for key, row in parameters.iterrows():
            parts.append(f'<p class="verdict">{html.escape(str(key))} = <strong>{html.escape(f"{row.value:.4g} {row.unit}".rstrip())}</strong>, '
                         f"95 %: {row.low:.4g} to {row.high:.4g}</p>\n")
    else:
        parts.append(f'<p class="verdict"><strong>No value is given.</strong> {html.escape(verdict.problem)}.</p>\n')
    parts += [f"<p>{html.escape(note)}.</p>\n" for note in notes]
    parts.append("<h2>Fit and residuals</h2>\n" + html_table(
        ["", "observed", "fitted", "residual, standard errors"],
        [[name, with_bar(row.observed, row.error), with_bar(row.fitted, row.fitted_error), f"{row.residual:+.2f}"] for name, row in fit.iterrows()]))
    usable = _usable(points)
    for k, axis in enumerate(axes):
        label = f"{axis.name} ({axis.unit})" if axis.unit else axis.name
        for goal, process, j in zip(goals, belief.processes, range(len(goals))):
            lines = []
            if len(axes) == 1:
                along = numpy.linspace(0, 1, 201)
                mean, spread = process.at(along[:, None])
                x = [axis.value(u) for u in along]
                lines = [Line("surrogate, two standard deviations" if sign == 0 else "", x, (mean + 2 * sign * spread).tolist(),
                              points=False, colour=1) for sign in (0, -1, 1)]
            lines.append(Line("runs", [p.values[k] for p in usable], [p.found[j][0] for p in usable],
                              [p.found[j][1] if math.isfinite(p.found[j][1]) else 0.0 for p in usable], joined=False))
            parts.append(chart(lines, label, goal.name, (goal.value, goal.error)))
        density = belief.marginal(k) / belief.marginal(k).max()
        parts.append(chart([Line("", [axis.value(u) for u in belief.ticks[k]], density.tolist(), points=False)], label, "probability (greatest: 1)"))
    heads = [*(f"{axis.name} ({axis.unit})" if axis.unit else axis.name for axis in axes), *(goal.name for goal in goals)]
    rows = [[*(number(v) for v in point.values), *(with_bar(*found) for found in point.found)] for point in points]
    parts.append(f"<h2>{len(points)} points</h2>\n<p>In the order in which they were computed. The grey band of a chart is what was observed.</p>\n"
                 + html_table(heads, rows))
    parts.append("<p>" + " &middot; ".join(link(name, path) for point in points for name in point.directories) + "</p>\n")
    return write_page(path, "Calibration of " + ", ".join(axis.name for axis in axes), parts)
