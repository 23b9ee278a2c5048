"""Ends runs at random moments and lets them go on: the results must be those of a run that nobody disturbed.

usage: check_kills.py ROULEAU [--kills N] [--seed N] [--set POINTER=VALUE]... SCENE...

For each scene one run is left alone. Others are killed (SIGKILL) or asked to stop (SIGINT, SIGTERM, SIGHUP) again and
again, each time going on with --resume and another number of threads, until one comes to its end. Then the tables must
have the same bytes, frames.h5 the same content (where h5py is installed) and summary.json the same values but for times
and what was measured of the machine. Checkpoints are frequent in these scenes, so that many kills hit one being written.
"""

import argparse
import json
import os
import random
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter
from pathlib import Path

try:
    import h5py
except ImportError:
    h5py = None

TABLES = ["cells.csv", "aggregates.csv", "series.csv", "aggregate_sizes.csv"]
MEASURED = ["wall_s", "steps_per_s", "mlups", "peak_rss_bytes", "threads", "ranks", "message_library", "started",
            "resumed", "files", "summary_xxh3"]
COSTS_ALONE = ["checkpoint", "ranks", "cut"]  # passes that only some of the runs have: blocks are cut again where a rank is slow
INTERRUPTED = 130


def summary(directory):
    """What a run must come to, however often it was ended."""
    content = json.loads((directory / "summary.json").read_text())
    for key in MEASURED:
        content.pop(key)
    content["passes"] = [(p["name"], p["calls"]) for p in content["passes"] if p["name"] not in COSTS_ALONE]
    content["stages"] = [{k: v for k, v in stage.items() if k != "wall_s"} for stage in content["stages"]]
    return content


def frames(directory):
    """Every attribute and array of frames.h5 under its path."""
    content = {}

    def visit(path, item):
        content[path, "attributes"] = {k: (v.tolist() if hasattr(v, "tolist") else v) for k, v in item.attrs.items()}
        if isinstance(item, h5py.Dataset):
            content[path, "values"] = (str(item.dtype), item.shape, item[...].tobytes())

    with h5py.File(directory / "frames.h5") as file:
        visit("/", file["/"])
        for name in sorted(file["/frames"]):
            visit("frames/" + name, file["/frames/" + name])
            file["/frames/" + name].visititems(lambda path, item, name=name: visit(f"frames/{name}/{path}", item))
    return content


def differences(left_alone, disturbed):
    found = [name for name in TABLES if (left_alone / name).read_bytes() != (disturbed / name).read_bytes()]
    expected, got = summary(left_alone), summary(disturbed)
    found += [f"summary.json {key}: {expected.get(key)} and {got.get(key)}"
              for key in sorted(expected.keys() | got.keys()) if expected.get(key) != got.get(key)]
    if h5py is not None:
        expected, got = frames(left_alone), frames(disturbed)
        found += [f"frames.h5 {key}" for key in sorted(expected.keys() | got.keys()) if expected.get(key) != got.get(key)]
    written = json.loads((disturbed / "summary.json").read_text())["files"]
    left_over = [entry.name for entry in disturbed.iterdir()
                 if entry.name.endswith(".partial") or entry.name.startswith("frames-") and entry.name not in written]
    return found + [f"{name} is left over" for name in left_over]


class Trial:
    def __init__(self, program, scene, changes, folder, chance):
        self.program, self.scene, self.chance = program, scene, chance
        self.changes = [word for change in changes for word in ("--set", change)]
        self.left_alone, self.folder = folder / "left-alone", folder
        started = time.monotonic()
        self.run(self.left_alone)
        self.seconds = time.monotonic() - started
        self.kills = Counter()

    def command(self, directory, *options):
        return [self.program, "run", str(self.scene), "--out", str(directory), "--quiet", *self.changes, *options]

    def run(self, directory, *options):
        result = subprocess.run(self.command(directory, *options), capture_output=True, text=True, timeout=300)
        if result.returncode != 0:
            sys.exit(f"{self.scene}: exit code {result.returncode}\n{result.stdout}{result.stderr}")

    def disturb(self, number):
        """Kills a run until it comes to its end; returns what differs from the run that was left alone."""
        directory = self.folder / f"run-{number}"
        for _ in range(200):
            options = ["--resume", "--threads", str(self.chance.randint(1, 3))]
            process = subprocess.Popen(self.command(directory, *options), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                       text=True)
            kind = self.chance.choice([signal.SIGKILL] * 5 + [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
            try:
                process.wait(self.chance.uniform(0.02, 0.8 * self.seconds))
            except subprocess.TimeoutExpired:
                process.send_signal(kind)
            output = "".join(process.communicate(timeout=300))
            if process.returncode == 0:
                return differences(self.left_alone, directory)
            if process.returncode not in (-kind, INTERRUPTED):
                return [f"exit code {process.returncode} after {kind.name}\n{output}"]
            self.kills[kind.name] += 1
        return ["the run did not come to an end"]


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("program", type=Path)
    parser.add_argument("scenes", nargs="+", type=Path)
    parser.add_argument("--kills", type=int, default=10, help="at least so many for each scene")
    parser.add_argument("--set", action="append", default=[], help="of each scene")
    parser.add_argument("--seed", type=int, default=int.from_bytes(os.urandom(4), "little"))
    arguments = parser.parse_args()
    chance = random.Random(arguments.seed)
    print(f"seed {arguments.seed}{'' if h5py else '; frames.h5 is not compared: no h5py here'}")
    failures = 0
    for scene in arguments.scenes:
        with tempfile.TemporaryDirectory() as folder:
            trial = Trial(arguments.program.resolve(), scene, arguments.set, Path(folder), chance)
            runs = 0
            while trial.kills.total() < arguments.kills:
                found = trial.disturb(runs)
                runs += 1
                if found:
                    failures += 1
                    print(f"{scene.name}, run {runs}: " + "\n  ".join(found))
            print(f"{scene.name}: {runs} runs, each ended and gone on with: {dict(trial.kills)}; "
                  f"{trial.seconds:.1f} s when left alone")
    return 1 if failures else 0


if __name__ == "__main__":
    sys.exit(main())
