#!/usr/bin/python3
"""A step through rouleau.Simulation costs what one of the program costs: counted in instructions per step, and timed.

Of the four-cell scene in shear without outputs. Instructions as in idle_features.py; it fails where step(n) needs 2 % more than
the program. Times are processor times of rounds that alternate.
"""

import argparse
import concurrent.futures
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

from idle_features import FEW, HERE, MORE, Counter, instructions

LIMIT = 0.02
ALL_AT_ONCE = "simulation.step(count)"
ONE_BY_ONE = "for _ in range(count): simulation.step(1)"
CODE = """
import sys, time, rouleau
simulation, count = rouleau.Simulation(sys.argv[1]), int(sys.argv[2])
start = time.process_time()
{}
print(time.process_time() - start)
"""


def main() -> int:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parent / "build/release", help="build tree with the programs")
    parser.add_argument("--one-by-one", action="store_true", help="instructions of n calls step(1), too")
    parser.add_argument("--rounds", type=int, default=0, help="times, too: so many rounds of --steps steps (0)")
    parser.add_argument("--steps", type=int, default=5000, help="of a round (5000)")
    chosen = parser.parse_args()
    os.environ["PYTHONPATH"] = str(chosen.build / "python")
    scene = json.loads((HERE.parent / "scenes/four-cells-shear.json").read_text())
    scene["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 15}]
    scene["output"] = {"cells": {"strain": 15}, "checkpoint": "never"}

    with tempfile.TemporaryDirectory() as work, concurrent.futures.ThreadPoolExecutor(2) as pool:
        counter = Counter(chosen.build, Path(work), pool)
        program, file = counter.scene("scene", scene), Path(work, "scene.json")
        stepped = {words: counter.per_step(lambda steps, words=words: instructions(
            [sys.executable, "-c", CODE.format(words), file, steps])) for words in (ALL_AT_ONCE, ONE_BY_ONE)[:1 + chosen.one_by_one]}
        base = program()
        print(f"{'rouleau run':42} {base:10.0f} instructions a step, from {FEW} to {MORE} steps")
        ratios = {}
        for words, count in stepped.items():
            ratios[words] = count() / base
            print(f"{words:42} {ratios[words] * base:10.0f} {100 * (ratios[words] - 1):+.2f} %")

        def program_seconds(steps: int) -> float:
            before = resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime
            subprocess.run([chosen.build / "bin/rouleau", "run", file, "--out", Path(work, "timed"), "--overwrite", "--quiet",
                            "--max-steps", str(steps)], check=True, capture_output=True)
            return resource.getrusage(resource.RUSAGE_CHILDREN).ru_utime - before

        times = []
        for _ in range(chosen.rounds):
            seconds = program_seconds(FEW + chosen.steps) - program_seconds(FEW)
            said = subprocess.run([sys.executable, "-c", CODE.format(ALL_AT_ONCE), file, str(chosen.steps)], check=True,
                                  capture_output=True, text=True)
            times.append((seconds, float(said.stdout)))
        if times:
            seconds, stepped_seconds = (statistics.median(column) for column in zip(*times))
            ratio = statistics.median(python / program for program, python in times)
            print(f"processor time of {chosen.steps} steps: {seconds:.3f} s and {stepped_seconds:.3f} s, ratio {ratio:.3f} "
                  f"(medians of {len(times)} rounds)")
    return 1 if ratios[ALL_AT_ONCE] > 1 + LIMIT else 0


if __name__ == "__main__":
    sys.exit(main())
