#!/usr/bin/env python3
"""What a scene does not need costs nothing: counted in instructions per step, not timed.

Each scene runs twice under valgrind (callgrind), for a few and for more steps; the difference divided by the steps
between is what one step costs, whatever start and end cost. valgrind 3.19 knows no AVX-512, so AVX2 code is counted.
"""

import argparse
import concurrent.futures
import copy
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Callable
from pathlib import Path

HERE = Path(__file__).resolve().parent
# Steps between which neither an output nor a check falls. The start of a run takes as many instructions as 400 steps in the
# plane and 150 in space, and is not the same to some ten thousands: over 30 steps ratios are off by up to 0.8 %.
FEW, MORE = 10, 110
FEW_IN_SPACE, MORE_IN_SPACE = 4, 44
LIMIT = 0.01


def instructions(command: list, apart: tuple = ()) -> int:
    """Of a command, without those inside the functions that are counted `apart`."""
    with tempfile.TemporaryDirectory() as folder:
        result = subprocess.run(
            ["valgrind", "--tool=callgrind", f"--callgrind-out-file={folder}/out",
             *[f"--toggle-collect={function}" for function in apart], "--collect-atstart=yes", *map(str, command)],
            env={**os.environ, "ROULEAU_INSTRUCTION_SET": "avx2"}, capture_output=True, text=True)
    found = re.search(r"Collected : (\d+)", result.stderr)
    if result.returncode != 0 or not found:
        raise SystemExit(f"idle_features: {' '.join(map(str, command))} failed:\n{result.stderr}")
    return int(found.group(1))


class Counter:
    """Counts on all cores, which counts do not mind; what its methods return gives the instructions per step when called."""

    def __init__(self, build: Path, folder: Path, pool: concurrent.futures.Executor, few: int = FEW, more: int = MORE):
        self.build, self.folder, self.pool, self.few, self.more = build, folder, pool, few, more
        folder.mkdir(exist_ok=True)

    def scene(self, name: str, scene: dict, apart: tuple = ()) -> Callable[[], float]:
        file = self.folder / f"{name}.json"
        file.write_text(json.dumps(scene))
        return self.per_step(lambda steps: instructions(
            [self.build / "bin/rouleau", "run", file, "--out", self.folder / f"{name}-{steps}", "--quiet",
             "--max-steps", steps], apart))

    def outputs(self, name: str) -> int:
        """How often the longer run of a scene wrote its cells."""
        rows = (self.folder / f"{name}-{self.more}" / "cells.csv").read_text().splitlines()
        header, data = rows[0].split(","), [row.split(",") for row in rows[1:] if not row.startswith("#")]
        return len({row[header.index("step")] for row in data})

    def kernel(self, name: str, more: tuple) -> Callable[[], float]:
        return self.per_step(lambda steps: instructions(
            [self.build / "bin/rouleau-bench", "--kernel", name, "--steps", steps, *more]))

    def per_step(self, count: Callable[[int], int]) -> Callable[[], float]:
        more, few = self.pool.submit(count, self.more), self.pool.submit(count, self.few)
        return lambda: (more.result() - few.result()) / (self.more - self.few)


def without(scene: dict, *keys: str) -> dict:
    return {key: value for key, value in copy.deepcopy(scene).items() if key not in keys}


# Every run writes its first and its last state, and reads them for its report; how well they compress depends on the
# state.
DUE = ("*Observer::observe<*", "*RunDirectory::write(*", "*RunDirectory::finish(*", "*report::write_report(*")
CUBE = ("--cube", 32)  # of the bare fluid in three dimensions


def comparisons(count: Counter, full: dict, bare: tuple) -> list:
    """Of a scene with cells, walls and an interaction: feature, idle, without it, in use."""
    # Walls move, cells are in reach.
    full["stages"] = [{**stage, "strain": 15} for stage in full["stages"] if "shear_rate" in stage]
    quiet = without(full, "output")
    equal, unnamed, shallow = (copy.deepcopy(quiet) for _ in range(3))
    equal["cell_types"]["rbc"]["interior_viscosity"] = equal["fluid"]["viscosity"]
    del unnamed["cell_types"]["rbc"]["interior_viscosity"]
    shallow["interactions"][0]["parameters"]["depth"] = "0 J/m2"
    full["output"] = {"cells": {"strain": 15}, "fields": {"strain": 15, "quantities": ["velocity"]}}
    fluid = without(quiet, "cells", "cell_types", "interactions")
    if bare:  # the bench's cube, which has no walls
        fluid["domain"] = {"size": ["16 um"] * 3, "nodes": [bare[1]] * 3, "y": "periodic"}
        fluid["stages"] = [{"name": "rest", "duration": "1 s"}]
    active = count.scene("full", quiet)
    return [
        ("cells left out; bare fluid benchmark", count.scene("fluid", fluid), count.kernel("plugin", bare), active),
        ("equal viscosities; none named", count.scene("equal", equal), count.scene("unnamed", unnamed), active),
        ("interaction of zero depth; no interaction", count.scene("shallow", shallow),
         count.scene("alone", without(quiet, "interactions")), active),
        ("output not due; none asked for", count.scene("output", full, DUE), count.scene("none", quiet, DUE),
         active)]


def report(rows: list) -> bool:
    """Prints the comparisons; whether nothing idle costs anything."""
    sound = True
    print(f"{'idle feature; compared with':45} {'idle':>12} {'without':>12} {'ratio':>9} {'in use':>12}")
    for feature, *costs in rows:
        idle, without_it, in_use = (cost() for cost in costs)
        passed = abs(idle / without_it - 1) <= LIMIT
        sound &= passed
        print(f"{feature:45} {idle:12.0f} {without_it:12.0f} {idle / without_it:9.5f} {in_use:12.0f} "
              f"{'' if passed else 'beyond 1 %'}", flush=True)
    print()
    return sound


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parent / "build/release", help="build tree with the programs")
    arguments = parser.parse_args()

    failed = False
    with (tempfile.TemporaryDirectory() as folder,
          concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool):
        for dimension, file, bare, steps in ((2, "scenes/four-cells-shear.json", (), (FEW, MORE)),
                                             (3, "limits/scenes/two-cells-3d.json", CUBE, (FEW_IN_SPACE, MORE_IN_SPACE))):
            print(f"Instructions per step, {file} and what is left of it, AVX2, f64\n")
            count = Counter(arguments.build.resolve(), Path(folder) / str(dimension), pool, *steps)
            failed |= not report(comparisons(count, json.loads((HERE.parent / file).read_text()), bare))
            if count.outputs("output") != 2:
                raise SystemExit("idle_features: outputs came due while the idle scene was counted")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
