"""Runs and plans of scenes, by the program."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import warnings
from typing import TYPE_CHECKING, Any, Callable, Sequence, Union

from .errors import Error, Fault, faults_in
from .program import call_json, environment, not_started, program
from .reading import Run, Section
from .scenes import SceneLike, in_users_words, name_of, options_of, quantity_text, scene_file, whole

if TYPE_CHECKING:
    import pandas

FAILED, INTERRUPTED = 1, 130
PERIOD_S = 0.25  # between two looks at a run that is going on


@dataclasses.dataclass(frozen=True)
class Progress:
    """How far a run has come, at its last output."""

    directory: pathlib.Path  #: of the run
    stage: str  #: name of the stage; "" before the first
    fraction: float  #: steps over the most steps of the stage, 0 to 1; a stage may end earlier
    step: int  #: over all stages
    strain: float  #: summed over the stages
    time_s: float  #: simulated time, s

    def __str__(self) -> str:
        return f"{self.directory.name}: {self.stage} {100 * self.fraction:3.0f} %, strain {self.strain:.2f}, {self.time_s:.3g} s"


#: What is done with progress: called with it several times a second, a line on the terminal or in the notebook where
#: there is one (None), or nothing (False).
ProgressLike = Union[Callable[[Progress], object], bool, None]


def run(scene: SceneLike, out: str | os.PathLike[str] | None = None, *, threads: int = 1, overwrite: bool = False,
        resume: bool = False, error_bars: bool = False, max_steps: int | None = None, max_time: str | None = None,
        plugin_dirs: Sequence[str | os.PathLike[str]] = (), progress: ProgressLike = None, **changes: Any) -> Run:
    """Simulates a scene with the program and returns its run.

    `scene` is a file's path or a dictionary. `changes` replace its values: `**{"fluid.viscosity": "6 cP"}`, or with a
    JSON pointer `**{"/interactions/0/parameters/depth": "1e-7 J/m2"}`; quantities are text with a unit, or numbers in SI.
    `out` is the run's directory, where left out the first free one of runs/NAME, runs/NAME-2, ...

    `threads`: results do not depend on their number. `overwrite`: replace the run that is there. `resume`: go on with
    it. `error_bars`: measure the error of every number. `max_steps` over all stages, and `max_time` such as "110min",
    end a run early, in good order. `plugin_dirs`: more folders with models.

    Interrupting (Ctrl-C, a notebook's stop button) saves a checkpoint and returns the run, whose status is "interrupted"
    and which `resume` continues. Throws Error for bad input, with its place and remedy, and for a run that diverged,
    which is its `run`. The program's warnings are Python's, and that the finer run failed which followed a missed
    target of numerics.auto is one.
    """
    directory = pathlib.Path(out) if out is not None else _free_directory(name_of(scene))
    options = ["--threads", str(whole("threads", threads, 1, 1024))]
    options += [f"--{word}" for word, wanted in (("overwrite", overwrite), ("resume", resume), ("error-bar", error_bars)) if wanted]
    options += ["--max-steps", str(whole("max_steps", max_steps, 0))] if max_steps is not None else []
    options += ["--max-time", quantity_text(max_time)] if max_time is not None else []
    options += [word for folder in plugin_dirs for word in ("--plugin-dir", os.fspath(folder))]
    made = simulate(scene, directory, [*options, *options_of(changes, scene)], shown(progress), threading.Event())
    if progress is None and sys.stderr.isatty():
        print(file=sys.stderr)
    for warning in made.summary.get("warnings", ()):
        warnings.warn(warning, stacklevel=2)
    return made


def simulate(scene: SceneLike, directory: pathlib.Path, options: list[str], progress: Callable[[Progress], object],
             stop: threading.Event) -> Run:
    """One run; when `stop` is set it is interrupted. Throws Error like `run`."""
    with scene_file(scene) as path, tempfile.TemporaryFile("w+") as said:
        command = [str(program()), "run", str(path), "--out", str(directory), "--quiet", *options]
        # A session of its own: Ctrl-C reaches this process, which asks for a checkpoint once.
        try:
            child = subprocess.Popen(command, env=environment(), stdin=subprocess.DEVNULL,
                                     stdout=subprocess.DEVNULL, stderr=said, start_new_session=True)
        except OSError as trouble:
            raise not_started(trouble) from None
        try:
            while child.poll() is None:
                try:
                    if stop.wait(0) and child.poll() is None:
                        child.send_signal(signal.SIGINT)
                        child.wait()
                        break
                    with contextlib.suppress(subprocess.TimeoutExpired):
                        child.wait(PERIOD_S)
                    now = progress_of(directory)
                    if now is not None:
                        progress(now)
                except KeyboardInterrupt:
                    if stop.is_set():
                        raise
                    stop.set()
        finally:
            if child.poll() is None:  # interrupted again, or a callback that throws
                child.terminate()
                child.wait()
        said.seek(0)
        words = said.read()
    if child.returncode == 0 or (child.returncode == INTERRUPTED and (directory / "scene.json").is_file()):
        return Run(directory)
    if child.returncode == FAILED and (directory / "summary.json").is_file():
        failed = Run(directory)
        if failed.status == "completed":  # numerics.auto has missed its target, and the finer run that followed failed
            warnings.warn(f"the finer run {directory / 'refined'} failed; what the first one found stands", stacklevel=3)
            return failed
        failure = failed.summary.failure
        place = f"step {failure.step}, strain {failure.strain:.4g}" + \
            (f", cell {failure.cell}" if failure.cell is not None else "")
        raise Error(Fault(f"{directory} diverged ({failure.reason}) at {place}: {failure.message}", failure.remedy),
                    exit_code=FAILED, run=failed)
    if child.returncode == INTERRUPTED:
        raise KeyboardInterrupt
    raise Error(in_users_words(faults_in(words), scene), exit_code=child.returncode)


def progress_of(directory: pathlib.Path) -> Progress | None:
    """How far a run has come; None before it has begun to write."""
    try:
        with open(directory / "series.csv", "rb") as file:
            header = file.readline().decode().rstrip("\n").split(",")
            file.seek(max(file.tell(), file.seek(0, os.SEEK_END) - 4000))
            whole = file.read().decode().split("\n")[:-1]
        last = dict(zip(header, whole[-1].split(",")))
        name, most, first, done = "", 1, 0, 0
        for line in (directory / "log.jsonl").read_text(encoding="utf-8").split("\n")[:-1]:
            event = json.loads(line)
            if event["event"] == "stage":
                name, most, first = event["name"], max(1, event["most_steps"]), done
            elif event["event"] == "stage_ended":
                done += event["steps"]
        step = int(last["step"])
        return Progress(directory, name, min(1.0, max(0, step - first) / most), step, float(last["strain"]),
                        float(last["time_s"]))
    except (OSError, IndexError, KeyError, ValueError):
        return None


def shown(progress: ProgressLike) -> Callable[[Progress], object]:
    """The callback that `progress` means."""
    if callable(progress):
        return progress
    if progress is False:
        return lambda now: None
    if "IPython" in sys.modules and hasattr(sys.modules["IPython"].get_ipython(), "kernel"):
        from IPython.display import display
        line = display({"text/plain": ""}, raw=True, display_id=True)
        return lambda now: line.update({"text/plain": str(now)}, raw=True)
    if progress is None and not sys.stderr.isatty():
        return lambda now: None
    return lambda now: print(f"\r{str(now):<76}", end="", file=sys.stderr, flush=True)


def _free_directory(name: str) -> pathlib.Path:
    if name in ("", ".", ".."):
        raise Error("the scene has no name from which that of a directory could be made; name the directory (out)")
    for number in range(1, 1_000_000):
        directory = pathlib.Path("runs") / (name if number == 1 else f"{name}-{number}")
        if not directory.exists():
            return directory
    raise Error(f"runs/{name} and all its numbers are taken; name another directory (out)", exit_code=4)


class Plan(Section):
    """What a run would compute, leave out and cost; keys are attributes: `plan.dimensionless.capillary`.

    `conversions`, `limits`, `passes`, `left_out`, `wells`, `packings` and `models` are lists of objects, of which
    `plan.table(name)` makes a DataFrame. `estimate` has time in s, memory and output in bytes."""

    def table(self, name: str) -> pandas.DataFrame:
        """One of the lists as DataFrame, SI units in its columns or beside the values."""
        import pandas
        return pandas.DataFrame(self[name])

    def _repr_html_(self) -> str:
        from .exporting import card
        from .pages import number, table
        limits = table(["limit", "value", "limit", "margin"], [[limit.name, number(limit.value), number(limit.limit),
                       "" if limit.margin is None else number(limit.margin)] for limit in self.limits])
        facts = [(name.replace("_", " "), number(value)) for name, value in self.dimensionless.items() if isinstance(value, (int, float))]
        return card(repr(self).strip("<>"), [*facts, ("estimated time", f"{self.estimate.wall_s:.3g} s")], limits)

    def __repr__(self) -> str:
        beyond = [limit.name for limit in self.limits if limit.margin is not None and limit.margin < 1]
        return f"<plan of {self.title or 'a scene'}: " + ("beyond its limits: " + ", ".join(beyond) if beyond else "within all limits") + ">"


def plan(scene: SceneLike, *, plugin_dirs: Sequence[str | os.PathLike[str]] = (), **changes: Any) -> Plan:
    """Conversions, dimensionless numbers, limits, what would be computed and what it would cost, without a step. `scene`,
    `plugin_dirs`, `changes` and Error as in `run`."""
    folders = [word for folder in plugin_dirs for word in ("--plugin-dir", os.fspath(folder))]
    with scene_file(scene) as path:
        try:
            answer = call_json("plan", path, *folders, *options_of(changes, scene), made=Section)
        except Error as error:
            raise Error(in_users_words(error.faults, scene), exit_code=error.exit_code) from None
    for warning in answer.warnings:
        if warning.startswith("the scene brings code along"):  # which has run by now
            warnings.warn(warning, stacklevel=2)
    return Plan(answer)


def plugins(*, plugin_dirs: Sequence[str | os.PathLike[str]] = ()) -> pandas.DataFrame:
    """The models that scenes can name, with their `id` as index: `kind`, `title`, `version`, `parameters` (a list, each with
    its unit, default and limits), `manifest` and more. What was refused has a row in `attrs["refused"]`."""
    import pandas
    folders = [word for folder in plugin_dirs for word in ("--plugin-dir", os.fspath(folder))]
    answer = call_json("plugins", *folders, good=(0, 3))
    table = pandas.DataFrame(answer["plugins"]).set_index("id")
    first = ["kind", "title", "version"]
    table = table[first + [name for name in table if name not in first]]
    table.attrs["refused"] = answer.get("refused", [])
    return table
