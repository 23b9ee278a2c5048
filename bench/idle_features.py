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
FEW, MORE = 50, 250  # steps; a check falls between them (every 200 steps), no output does
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

    def __init__(self, build: Path, folder: Path, pool: concurrent.futures.Executor):
        self.build, self.folder, self.pool = build, folder, pool

    def scene(self, name: str, scene: dict, apart: tuple = ()) -> Callable[[], float]:
        file = self.folder / f"{name}.json"
        file.write_text(json.dumps(scene))
        return self.per_step(lambda steps: instructions(
            [self.build / "bin/rouleau", "run", file, "--out", self.folder / f"{name}-{steps}", "--quiet",
             "--max-steps", steps], apart))

    def outputs(self, name: str) -> int:
        """How often the longer run of a scene wrote its cells."""
        rows = (self.folder / f"{name}-{MORE}" / "cells.csv").read_text().splitlines()
        header, data = rows[0].split(","), [row.split(",") for row in rows[1:] if not row.startswith("#")]
        return len({row[header.index("step")] for row in data})

    def kernel(self, name: str) -> Callable[[], float]:
        return self.per_step(lambda steps: instructions(
            [self.build / "bin/rouleau-bench", "--kernel", name, "--steps", steps]))

    def per_step(self, count: Callable[[int], int]) -> Callable[[], float]:
        more, few = self.pool.submit(count, MORE), self.pool.submit(count, FEW)
        return lambda: (more.result() - few.result()) / (MORE - FEW)


def without(scene: dict, *keys: str) -> dict:
    return {key: value for key, value in copy.deepcopy(scene).items() if key not in keys}


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parent / "build/release", help="build tree with the programs")
    arguments = parser.parse_args()

    full = json.loads((HERE.parent / "scenes/four-cells-shear.json").read_text())
    full["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 15}]  # walls move, cells are in reach
    quiet = without(full, "output")
    rows, failed = [], False

    equal, unnamed = copy.deepcopy(quiet), copy.deepcopy(quiet)
    equal["cell_types"]["rbc"]["interior_viscosity"] = equal["fluid"]["viscosity"]
    del unnamed["cell_types"]["rbc"]["interior_viscosity"]
    shallow = copy.deepcopy(quiet)
    shallow["interactions"][0]["parameters"]["depth"] = "0 J/m2"
    often = copy.deepcopy(full)
    often["output"]["fields"]["strain"] = often["output"]["cells"]["strain"] = 0.005
    # Every run writes its first and its last state, and reads them for its report; how well they compress depends on
    # the state.
    due = ("*Observer::observe<*", "*RunDirectory::write(*", "*RunDirectory::finish(*", "*report::write_report(*")

    with (tempfile.TemporaryDirectory() as folder,
          concurrent.futures.ThreadPoolExecutor(len(os.sched_getaffinity(0))) as pool):
        count = Counter(arguments.build.resolve(), Path(folder), pool)
        active = count.scene("full", quiet)
        comparisons = [  # feature, idle, without it, in use
            ("cells left out; bare fluid benchmark",
             count.scene("fluid", without(quiet, "cells", "cell_types", "interactions")), count.kernel("plugin"), active),
            ("equal viscosities; none named", count.scene("equal", equal), count.scene("unnamed", unnamed), active),
            ("interaction of zero depth; no interaction", count.scene("shallow", shallow),
             count.scene("alone", without(quiet, "interactions")), active),
            ("output not due; none asked for", count.scene("output", full, due), count.scene("none", quiet, due),
             count.scene("often", often))]
        for feature, *costs in comparisons:
            idle, without_it, in_use = (cost() for cost in costs)
            ratio = idle / without_it
            passed = abs(ratio - 1) <= LIMIT
            failed |= not passed
            rows.append((feature, idle, without_it, ratio, in_use, "" if passed else "beyond 1 %"))
        if count.outputs("output") != 2:
            raise SystemExit("idle_features: outputs came due while the idle scene was counted")

    print("Instructions per step, four-cells-shear.json and what is left of it, AVX2, f64\n")
    print(f"{'idle feature; compared with':45} {'idle':>12} {'without':>12} {'ratio':>9} {'in use':>12}")
    for feature, idle, without_it, ratio, in_use, verdict in rows:
        print(f"{feature:45} {idle:12.0f} {without_it:12.0f} {ratio:9.5f} {in_use:12.0f} {verdict}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
