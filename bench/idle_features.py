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
from pathlib import Path

HERE = Path(__file__).resolve().parent
FEW, MORE = 50, 450  # steps; two checks fall between them (every 200 steps), no output does
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
    def __init__(self, build: Path, folder: Path):
        self.build, self.folder = build, folder

    def scene(self, name: str, scene: dict, apart: tuple = ()) -> float:
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

    def kernel(self, name: str) -> float:
        return self.per_step(lambda steps: instructions(
            [self.build / "bin/rouleau-bench", "--kernel", name, "--steps", steps]))

    @staticmethod
    def per_step(count) -> float:
        with concurrent.futures.ThreadPoolExecutor(2) as both:  # counts do not mind company
            few, more = both.map(count, (FEW, MORE))
        return (more - few) / (MORE - FEW)


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

    with tempfile.TemporaryDirectory() as folder:
        count = Counter(arguments.build.resolve(), Path(folder))

        def compare(feature: str, idle: float, without_it: float, active: float | None = None) -> None:
            nonlocal failed
            ratio = idle / without_it
            passed = abs(ratio - 1) <= LIMIT
            failed |= not passed
            rows.append((feature, idle, without_it, ratio, active, "" if passed else "beyond 1 %"))

        fluid = count.scene("fluid", without(quiet, "cells", "cell_types", "interactions"))
        compare("cells left out; bare fluid benchmark", fluid, count.kernel("plugin"), count.scene("full", quiet))

        equal, unnamed = copy.deepcopy(quiet), copy.deepcopy(quiet)
        equal["cell_types"]["rbc"]["interior_viscosity"] = equal["fluid"]["viscosity"]
        del unnamed["cell_types"]["rbc"]["interior_viscosity"]
        compare("equal viscosities; none named", count.scene("equal", equal), count.scene("unnamed", unnamed), rows[0][4])

        shallow = copy.deepcopy(quiet)
        shallow["interactions"][0]["parameters"]["depth"] = "0 J/m2"
        compare("interaction of zero depth; no interaction", count.scene("shallow", shallow),
                count.scene("alone", without(quiet, "interactions")), rows[0][4])

        often = copy.deepcopy(full)
        often["output"]["fields"]["strain"] = often["output"]["cells"]["strain"] = 0.005
        # Every run writes its first and its last state; how well they compress depends on the state.
        due = ("*Observer::observe<*", "*RunDirectory::write(*")
        idle = count.scene("output", full, due)
        if count.outputs("output") != 2:
            raise SystemExit("idle_features: outputs came due while the idle scene was counted")
        compare("output not due; none asked for", idle, count.scene("none", quiet, due), count.scene("often", often))

    print("Instructions per step, four-cells-shear.json and what is left of it, AVX2, f64\n")
    print(f"{'idle feature; compared with':45} {'idle':>12} {'without':>12} {'ratio':>9} {'in use':>12}")
    for feature, idle, without_it, ratio, active, verdict in rows:
        print(f"{feature:45} {idle:12.0f} {without_it:12.0f} {ratio:9.5f} {active:12.0f} {verdict}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
