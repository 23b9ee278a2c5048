"""Runs over all combinations of some values."""

from __future__ import annotations

import concurrent.futures
import hashlib
import itertools
import json
import os
import pathlib
import re
import threading
from typing import TYPE_CHECKING, Any, Callable, Mapping, Sequence

from .errors import Error
from .reading import Run
from .running import FAILED, Progress, ProgressLike, shown, simulate
from .scenes import SceneLike, as_json, hashes_of_files, options_of, pointer_of, text_of

if TYPE_CHECKING:
    import pandas


def sweep(scene: SceneLike, over: Mapping[str, Sequence[Any]], *, out: str | os.PathLike[str] = "runs/sweep",
          workers: int | None = None, measure: Callable[[Run], Mapping[str, Any]] | None = None, error_bars: bool = False,
          fresh: bool = False, progress: ProgressLike = None, **changes: Any) -> pandas.DataFrame:
    """Runs a scene for every combination of values and returns a table with a row for each, in the order of the values.

    `over` has a list of values for each key or JSON pointer: `{"/interactions/0/parameters/depth": ["1e-8 J/m2", "1e-7
    J/m2"], "/stages/0/shear_rate": [...]}`; `scene` and `changes` as in `run`. `workers` runs go on at a time (None: as
    many as there are processors), in directories below `out` that are named after their values. A run that is there
    already, of the same scene, files and values, is not run again unless `fresh`; one that was interrupted goes on.

    Columns: a value for each key, under its last word ("depth") where that is unique; `status` ("completed", "diverged",
    "interrupted"); for each quantity of `Run.results` its value, in SI, and `QUANTITY_error`; `wall_s`; `directory`. With
    `measure`, what that function makes of a run stands in place of `Run.results`. With `error_bars` errors are
    measured, which takes 40 % longer; without, they are standard errors of means in time. A run that diverged has nan.

    Interrupting saves checkpoints and throws KeyboardInterrupt; the same call goes on. Throws Error for bad input.
    """
    import pandas
    names = _short_names(list(over))
    listen = shown(progress)
    speaking, stop = threading.Lock(), threading.Event()

    def tell(now: Progress) -> None:
        with speaking:
            listen(now)

    content = as_json(scene) if isinstance(scene, Mapping) else text_of(scene)
    jobs = []
    for values in itertools.product(*over.values()):
        mine = dict(zip(over, values))
        jobs.append((dict(zip(names, values)), {**changes, **mine},
                     pathlib.Path(out) / _directory_name(dict(zip(names, values)), content, {**changes, **mine},
                                                     [error_bars, *hashes_of_files(scene, {**changes, **mine})])))

    def one(job: tuple[dict[str, Any], dict[str, Any], pathlib.Path]) -> dict[str, Any]:
        values, settled, directory = job
        if stop.is_set():
            raise concurrent.futures.CancelledError
        made = _run_of(scene, directory, settled, error_bars, fresh, tell, stop)
        return {**values, "status": made.status, **(_measured(made, measure) if made.status == "completed" else {}),
                "wall_s": made.summary.get("wall_s"), "directory": str(made.directory)}

    with concurrent.futures.ThreadPoolExecutor(workers or os.cpu_count() or 1) as pool:
        futures = [pool.submit(one, job) for job in jobs]
        try:
            rows = [future.result() for future in futures]
        except BaseException:
            stop.set()  # all that goes on saves a checkpoint
            for future in futures:
                future.cancel()
            raise
    return pandas.DataFrame(rows)


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
    if measure is not None:
        return measure(made)
    columns: dict[str, float] = {}
    for quantity, row in made.results.iterrows():
        columns[str(quantity)] = row["value"]
        columns[f"{quantity}_error"] = row["error"]
    return columns


def _short_names(keys: list[str]) -> list[str]:
    """The last word of each key, or the whole key where another has the same."""
    last = [pointer_of(key).rsplit("/", 1)[1] for key in keys]
    return [word if last.count(word) == 1 else key for key, word in zip(keys, last)]


def _directory_name(values: Mapping[str, Any], content: str, changes: Mapping[str, Any], further: list[Any]) -> str:
    words = "_".join(f"{name}-{value if isinstance(value, str) else as_json(value)}" for name, value in values.items())
    readable = re.sub(r"[^A-Za-z0-9.+-]+", "_", words).strip("_")[:80]
    whole = json.dumps([content, as_json({pointer_of(k): v for k, v in changes.items()}), *further])
    return f"{readable}-{hashlib.sha256(whole.encode()).hexdigest()[:8]}"
