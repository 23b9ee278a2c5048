"""Runs over all combinations of some values."""

from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import math
import numbers
import os
import pathlib
import re
import threading
from typing import TYPE_CHECKING, Any, Callable, Iterable, Iterator, Mapping, NamedTuple, Sequence

from .errors import Error, Fault
from .means import SeedMean, Statistics, mean_of_seeds
from .reading import Mean, Run
from .running import FAILED, Progress, ProgressLike, shown, simulate
from .scenes import SceneLike, as_json, hashes_of_files, named, options_of, pointer_of, text_of, whole

if TYPE_CHECKING:
    import pandas

NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"


def sweep(scene: SceneLike, over: Mapping[str, Sequence[Any]], *, seeds: Sequence[int] | None = None,
          out: str | os.PathLike[str] = "runs/sweep", workers: int | None = None,
          measure: Callable[[Run], Mapping[str, Any]] | None = None, error_bars: bool = False,
          fresh: bool = False, page: bool = True, progress: ProgressLike = None, **changes: Any) -> pandas.DataFrame:
    """Runs a scene for every combination of values and returns a table with a row for each, in the order of the values.

    `over` has a list of values for each key or JSON pointer: `{"/interactions/0/parameters/depth": ["1e-8 J/m2", "1e-7
    J/m2"], "/stages/0/shear_rate": [...]}`; `scene` and `changes` as in `run`. `seeds`: each combination runs once with
    each of these numbers as every `seed` of the scene. `workers` runs go on at a time (None: as many as there are
    processors), in directories below `out` that are named after their values. A run that is there already, of the same
    scene, files and values, is not run again unless `fresh`; one that was interrupted goes on.

    A column has the value of each key, under its last word ("depth") where that is unique. Where all values have one unit
    the numbers stand beside it ("depth_J_per_m2"). Then come `status` ("completed", "diverged", "interrupted"), for each
    quantity of `Run.results` its value, in SI, and `QUANTITY_error`, `wall_s` and `directory`. With `measure`, what that function makes
    of a run stands in place of `Run.results`; a value may be a Mean or a Statistics. With `error_bars` errors are measured, which takes
    40 % longer; without, they are standard errors of means in time. A run that diverged has nan.

    With `seeds` a row has the mean over the completed runs, whose number is `runs`. `QUANTITY_error` is the larger of two
    standard errors of that mean: `QUANTITY_error_between`, from the spread of the seeds, which holds what a run cannot know
    of itself, and `QUANTITY_error_within`, from the errors of the runs. `QUANTITY_bar95` is half of the interval that holds
    the true mean in 95 % of cases (Student's t). One seed leaves both the spread and that interval unknown (nan).

    `page`: writes sweep.html, with tables and charts, sweep.csv, and with seeds sweep-runs.csv with a row for each run.
    Interrupting saves checkpoints and throws KeyboardInterrupt; the same call goes on. Throws Error for bad input.
    """
    import pandas
    over = named("over", over)
    for key, entries in over.items():
        if isinstance(entries, (str, Mapping)) or not hasattr(entries, "__len__") or len(entries) == 0:
            raise Error(Fault(f"{key} has the values {entries!r}", "give a list of one value or more"))
    keys = list(over)
    names = short_names(keys)
    places = places_of_seeds(scene, changes, keys) if seeds is not None else []
    seed_numbers = [whole("a seed", seed, 0, 2 ** 32 - 1) for seed in seeds] if seeds is not None else []
    if seeds is not None and (not seed_numbers or len(set(seed_numbers)) != len(seed_numbers)):
        raise Error(Fault(f"seeds are {list(seeds)!r}", "give at least one number, and each of them once"))
    columns = dict(filter(None, (_numbers(name, values) for name, values in zip(names, over.values()))))
    jobs = []
    for values in itertools.product(*over.values()):
        shown_values = dict(zip(names, values))
        mine = {**changes, **dict(zip(keys, values))}
        jobs += [Job(shown_values, mine)] if seeds is None else [
            Job({**shown_values, "seed": seed}, {**mine, **{place: seed for place in places}}) for seed in seed_numbers]
    made = run_all(scene, jobs, pathlib.Path(out), workers, error_bars, fresh, progress)
    rows = [{**_with_numbers(job.values, columns), "status": run.status,
             **(_measured(run, measure) if run.status == "completed" else {}),
             "wall_s": run.summary.get("wall_s"), "directory": str(run.directory)} for job, run in zip(jobs, made)]
    runs = pandas.DataFrame(rows)
    if seeds is not None:
        own = [*names, *columns.values(), "seed"]
        each = len(seed_numbers)
        rows = [_combined(rows[k:k + each], own) for k in range(0, len(rows), each)]
    table = pandas.DataFrame(rows)
    if page:
        _write(pathlib.Path(out), table, runs, names, columns, seeds is not None)
    return table


class Job(NamedTuple):
    """One of many runs."""

    values: dict[str, Any]  #: that name its directory
    changes: dict[str, Any]  #: of the scene


def at_once(workers: int | None) -> int:
    """How many runs go on at a time."""
    return whole("workers", workers or os.cpu_count() or 1, 1)


def run_all(scene: SceneLike, jobs: Sequence[Job], out: pathlib.Path, workers: int | None, error_bars: bool, fresh: bool,
            progress: ProgressLike) -> list[Run]:
    """The runs of a scene, so many at a time; those that are there are not made again. Throws Error for bad input."""
    count, listen = at_once(workers), shown(progress)
    speaking, stop = threading.Lock(), threading.Event()

    def tell(now: Progress) -> None:
        with speaking:
            listen(now)

    content = as_json(scene) if isinstance(scene, Mapping) else text_of(scene)

    def one(job: Job) -> Run:
        if stop.is_set():
            raise concurrent.futures.CancelledError
        directory = out / _directory_name(job.values, content, job.changes, [error_bars, *hashes_of_files(scene, job.changes)])
        return _run_of(scene, directory, job.changes, error_bars, fresh, tell, stop)

    with concurrent.futures.ThreadPoolExecutor(count) as pool:
        futures = [pool.submit(one, job) for job in jobs]
        try:
            return [future.result() for future in futures]
        except BaseException:
            stop.set()  # all that goes on saves a checkpoint
            for future in futures:
                future.cancel()
            raise


def places_of_seeds(scene: SceneLike, changes: Mapping[str, Any], keys: Sequence[str] = ()) -> list[str]:
    """Pointers of every seed of a scene: of cells at random places, and of cells that come in. Throws Error where there is
    none, or where one of `keys` is one."""
    try:
        content = json.loads(as_json(scene) if isinstance(scene, Mapping) else text_of(scene))
    except ValueError:
        content = {}  # the program says what is wrong

    def found(value: Any, pointer: str) -> Iterator[str]:
        parts: Iterable[tuple[Any, Any]] = \
            value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        for key, part in parts:
            if isinstance(part, dict) and (key == "random" or ("hematocrit" in part and pointer.endswith("/inlet"))):
                yield f"{pointer}/{key}/seed"
            yield from found(part, f"{pointer}/{key}")

    places = [*found(content.get("cells"), "/cells"), *found(content.get("domain"), "/domain")] if isinstance(content, dict) else []
    for key, value in changes.items():
        if pointer_of(key).startswith(("/cells", "/domain")):
            end = pointer_of(key).rsplit("/", 1)
            places += found({end[1]: json.loads(as_json(value, key))}, end[0])
    if not places:
        raise Error(Fault("seeds are given, and nothing in this scene depends on a seed",
                          "leave `seeds` out, or place cells at random (docs/scene.md)"))
    taken = [key for key in keys if pointer_of(key) in places]
    if taken:
        raise Error(Fault(f"{taken[0]} is a seed, and seeds are given, too", "give seeds in one of the two ways"))
    return list(dict.fromkeys(places))


def number_and_unit(value: Any) -> tuple[float, str] | None:
    """Of "1e-8 J/m2" both parts; of a number that and "". None for anything else."""
    if isinstance(value, str):
        found = re.fullmatch(rf"\s*({NUMBER})\s*", value) or re.fullmatch(rf"\s*({NUMBER})(\s+\S.*?|\s*[^\d\s.].*?)\s*", value)
        return (float(found[1]), (found[2] or "").strip() if found.re.groups > 1 else "") if found else None
    plain_value = json.loads(as_json(value))
    if isinstance(plain_value, str):
        return number_and_unit(plain_value)
    return None if isinstance(plain_value, bool) or not isinstance(plain_value, (int, float)) else (float(plain_value), "")


def unit_word(unit: str) -> str:
    """A unit as part of a column's name: "J/m2" is "J_per_m2", "1/s" is "1_per_s"."""
    words = unit.replace("µ", "u").replace("^", "").replace("%", "percent").replace("/", " per ")
    return re.sub(r"[^A-Za-z0-9]+", "_", words).strip("_")


def _numbers(name: str, values: Sequence[Any]) -> tuple[str, str] | None:
    """A key, and the name of the column with its numbers; None where values are no quantities of one unit."""
    parts = [number_and_unit(value) for value in values]
    units = {part[1] if part else "" for part in parts}
    return (name, f"{name}_{unit_word(*units)}") if None not in parts and len(units) == 1 and units != {""} else None


def _with_numbers(values: Mapping[str, Any], columns: Mapping[str, str]) -> dict[str, Any]:
    row = dict(values)
    for name, column in columns.items():
        part = number_and_unit(values[name])
        row[column] = part[0] if part else math.nan
    return row


def _combined(rows: Sequence[Mapping[str, Any]], own: Sequence[str]) -> dict[str, Any]:
    """One row of several that differ by their seed."""
    done = [row for row in rows if row["status"] == "completed"]
    bad = next((row["status"] for row in rows if row["status"] != "completed"), "completed")
    made: dict[str, Any] = {name: rows[0][name] for name in own if name != "seed"}
    made.update(status=bad, runs=len(done))
    every = dict.fromkeys(name for row in done for name in row)
    for name in every:
        values = [row.get(name) for row in done]
        if name in (*own, "status", "wall_s", "directory") or (name.endswith("_error") and name.removesuffix("_error") in every) or \
                not all(isinstance(value, numbers.Real) and not isinstance(value, bool) for value in values):
            continue
        mean = mean_of_seeds([_real(value) for value in values],
                             [_real(row.get(f"{name}_error")) for row in done])
        made.update({name: mean.value, f"{name}_error": mean.error, f"{name}_error_between": mean.between,
                     f"{name}_error_within": mean.within, f"{name}_bar95": mean.bar95})
    times = [row["wall_s"] for row in rows if row["wall_s"] is not None]
    return {**made, "wall_s": math.fsum(times), "directories": [row["directory"] for row in rows]}


def _write(out: pathlib.Path, table: pandas.DataFrame, runs: pandas.DataFrame, names: Sequence[str], columns: Mapping[str, str],
           seeded: bool) -> None:
    """sweep.html and sweep.csv"""
    from .drawing import label_of
    from .pages import Line, chart, link, table as html_table, with_bar, write_page, write_whole
    page = out / "sweep.html"
    own = {*names, *columns.values(), "seed", "status", "runs", "wall_s", "directory", "directories"}
    extra = ("_error", "_error_between", "_error_within", "_bar95")
    quantities = [str(name) for name in table if name not in own and not str(name).endswith(extra)
                  and table[name].map(lambda value: value is None or isinstance(value, numbers.Real)).all()]
    axes = [columns.get(name, name) for name in names]
    first = next((axis for axis in axes if table[axis].map(lambda v: isinstance(v, numbers.Real)).all()), None)
    others = [axis for axis in axes if axis != first]
    bar = "_bar95" if seeded else "_error"
    if seeded and len(runs) == len(table):  # of one seed
        bar = "_error"
    charts = []
    for name in quantities if first is not None and table[first].nunique() > 1 else []:
        label, scale = label_of(name)
        lines = []
        for _, rows in table.groupby(others[0] if len(others) == 1 else others, sort=False) if others else [((), table)]:
            words = ", ".join(f"{other} {rows[other].iloc[0]}" for other in others)
            bars = [scale * _real(value) for value in rows[name + bar]] if name + bar in rows else []
            lines.append(Line(words, rows[first].tolist(), [scale * _real(value) for value in rows[name]], bars))
        charts.append(chart(lines, label_of(str(first))[0], label))
    shown_rows = []
    for _, row in table.iterrows():
        cells = [row[axis] for axis in axes] + [row["status"]] + ([row["runs"]] if seeded else [])
        shown_rows.append(cells + [with_bar(_real(row[q]), _real(row.get(q + bar))) for q in quantities])
    heads = [*axes, "status", *(["runs"] if seeded else []), *quantities]
    said = "Bars are 95 % intervals of the mean over the seeds (Student's t, from the larger of the errors between seeds and within runs)." \
        if bar == "_bar95" else "Bars are standard errors of one run, which do not hold what another seed would change."
    parts = [f"<p>{len(table)} combinations, {len(runs)} runs. {said} Values are in SI units in the table, and with their units in the charts.</p>\n",
             html_table(heads, shown_rows), *charts]
    if seeded:
        heads = [*axes, "seed", "status", *quantities]
        parts += ["<h2>Runs</h2>\n<p>Each with the standard error that it knows of itself.</p>\n", html_table(heads, [
            [row[axis] for axis in axes] + [row["seed"], row["status"]] +
            [with_bar(_real(row.get(q)), _real(row.get(q + "_error"))) for q in quantities] for _, row in runs.iterrows()])]
    parts.append("<h2>Reports</h2>\n<p>" + " &middot; ".join(link(name, page) for name in runs["directory"]) + "</p>\n")
    write_page(page, "Sweep over " + ", ".join(names), parts)
    if seeded:
        write_whole(out / "sweep-runs.csv", runs.to_csv(index=False))
        table = table.assign(directories=table["directories"].map(" ".join))
    write_whole(out / "sweep.csv", table.to_csv(index=False))


def _real(value: Any) -> float:
    return float(value) if isinstance(value, numbers.Real) else math.nan


def _run_of(scene: SceneLike, directory: pathlib.Path, changes: Mapping[str, Any], error_bars: bool, fresh: bool,
            progress: Callable[[Progress], object], stop: threading.Event) -> Run:
    options = options_of(changes, scene) + (["--error-bar"] if error_bars else [])
    if (directory / "scene.json").is_file():
        there = Run(directory)
        anew = fresh or (there.finished and not _has_its_plugins(there))
        if not anew and there.finished and there.status != "interrupted":
            return there
        options.append("--overwrite" if anew else "--resume")
    try:
        made = simulate(scene, directory, options, progress, stop)
    except Error as error:
        if error.exit_code != FAILED or error.run is None:
            raise
        failed: Run = error.run
        return failed
    if stop.is_set() and made.status == "interrupted":
        raise concurrent.futures.CancelledError
    return made


def _has_its_plugins(there: Run) -> bool:
    """Whether the libraries that a run computed with are what they were."""
    def is_same(plugin: Mapping[str, Any]) -> bool:
        try:
            return hashlib.sha256(pathlib.Path(plugin["library"]).read_bytes()).hexdigest() == str(plugin["sha256"])
        except OSError:
            return False
    return all(map(is_same, there.summary.get("plugins", ())))


def _measured(made: Run, measure: Callable[[Run], Mapping[str, Any]] | None) -> Mapping[str, Any]:
    columns: dict[str, Any] = {}
    if measure is not None:
        for name, value in named("measure gave", measure(made)).items():
            if isinstance(value, (Mean, SeedMean, Statistics)):
                columns.update({name: value.value, f"{name}_error": value.error})
            else:
                columns[name] = value
        return columns
    for quantity, row in made.results.iterrows():
        columns[str(quantity)] = row["value"]
        columns[f"{quantity}_error"] = row["error"]
    return columns


def short_names(keys: list[str]) -> list[str]:
    """The last word of each key, or the whole key where another has the same."""
    last = [pointer_of(key).rsplit("/", 1)[1] for key in keys]
    return [word if last.count(word) == 1 else key for key, word in zip(keys, last)]


def _directory_name(values: Mapping[str, Any], content: str, changes: Mapping[str, Any], further: list[Any]) -> str:
    words = "_".join(f"{name}-{value if isinstance(value, str) else as_json(value)}" for name, value in values.items())
    readable = re.sub(r"[^A-Za-z0-9.+-]+", "_", words).strip("_")[:80]
    whole = json.dumps([content, as_json({pointer_of(k): v for k, v in changes.items()}), *further])
    return f"{readable}-{hashlib.sha256(whole.encode()).hexdigest()[:8]}"
