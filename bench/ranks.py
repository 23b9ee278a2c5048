#!/usr/bin/python3
"""A step by ranks, by as many threads, and by one: measured in turn, beside what `rouleau plan --ranks` expects.

usage: ranks.py [--build build/release] [--cases NAME,...] [--ranks 2,4] [--rounds 5] [--seconds 2] [--prefix "chrt -f 5"]
A line for each case and number of ranks: microseconds a step, least of all rounds, outputs and checks left out; the speed of
ranks over that of threads, least over least and the median of the rounds; the model over what is measured, the median of the
rounds and their range, and the networks. The model is given the network as so many ranks measure it in that round, the number of processors, and
the step of one process while every processor has one, or as many as there are ranks: they share memory as ranks do. Open MPI.
"""

import argparse
import concurrent.futures
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
SPACING = 0.1955  # um
OUTSIDE = ("observe and check", "checkpoint", "cut")  # passes that are no part of a step


def scene(file, nodes=None, hematocrit=0.4):
    """A scene of scenes/ in shear, f64, without outputs; with nodes as large as these, and filled with cells at random."""
    base = json.loads((HERE.parent / "scenes" / file).read_text())
    base["numerics"]["precision"] = "f64"
    base["output"] = {"checkpoint": "never"}
    base["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 1000}]
    base["checks"] = {"every_steps": 1000}
    if nodes:
        base["domain"]["nodes"] = nodes
        base["domain"]["size"] = [f"{count * SPACING} um" for count in nodes]
        base["cells"] = [{"type": "rbc", "random": {"hematocrit": hematocrit, "seed": 1, "gap": "0.2 um"}}]
        if not hematocrit:
            base["cells"] = base["interactions"] = []
    return base


CASES = {
    "fluid": scene("suspension.json", [2048, 1024], 0),
    "1036 cells": scene("suspension.json", [960, 960]),
    "73 cells": scene("suspension.json", [272, 240]),
    "4 cells": scene("four-cells-shear.json"),
}


class Bench:
    def __init__(self, chosen, folder):
        self.program, self.tool = chosen.build / "bin/rouleau", chosen.build / "bin/rouleau-bench"
        self.prefix, self.seconds, self.folder = chosen.prefix.split(), chosen.seconds, Path(folder)
        self.environment = dict(os.environ, OMPI_ALLOW_RUN_AS_ROOT="1", OMPI_ALLOW_RUN_AS_ROOT_CONFIRM="1")

    def call(self, *words):
        done = subprocess.run([str(word) for word in words], env=self.environment, capture_output=True, text=True)
        if done.returncode not in (0, 130):
            sys.exit(f"{' '.join(map(str, words))}: exit code {done.returncode}\n{done.stdout}{done.stderr}")
        return done.stdout

    def mpirun(self, ranks):
        return [*self.prefix, "mpirun", "--oversubscribe", "--bind-to", "none", "-n", ranks]

    def network(self, ranks):
        words = self.call(*self.mpirun(ranks), self.tool, "--only", "network")
        return re.search(r'--network "([^"]*)"', words)[1]

    def step_us(self, file, steps, ranks=1, threads=1, name="run"):
        out = self.folder / name
        before = self.mpirun(ranks) if ranks > 1 else self.prefix
        self.call(*before, self.program, "run", file, "--out", out, "--overwrite", "--quiet", "--threads", threads,
                  "--max-steps", steps)
        summary = json.loads((out / "summary.json").read_text())
        return 1e6 * sum(p["wall_s"] for p in summary["passes"] if p["name"] not in OUTSIDE) / summary["steps"]

    def beside_each_other_us(self, file, steps, count):
        """The mean of so many processes, each with a run of its own."""
        with concurrent.futures.ThreadPoolExecutor(count) as pool:
            return statistics.mean(pool.map(lambda k: self.step_us(file, steps, name=f"run{k}"), range(count)))

    def plan(self, file, ranks, one_us, network):
        report = json.loads(self.call(self.program, "plan", file, "--ranks", ranks, "--json", "--step", f"{one_us} us",
                                      "--network", network, "--processors", os.cpu_count()))
        return next(1e6 * time["step_s"] for time in report["ranks"]["times"]["of"] if time["ranks"] == ranks)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parent / "build/release")
    parser.add_argument("--cases", default=",".join(CASES))
    parser.add_argument("--ranks", default="2")
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--seconds", type=float, default=2, help="that a run by one process takes")
    parser.add_argument("--prefix", default="", help='of every command, such as "chrt -f 5": others wait')
    chosen = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        bench = Bench(chosen, folder)
        print(f"{'case':12} {'ranks':>5} {'one':>9} {'beside':>9} {'threads':>9} {'ranks':>9} {'ratio':>6} {'median':>6} {'model/measured':>14}")
        for name in chosen.cases.split(","):
            file = bench.folder / "scene.json"
            file.write_text(json.dumps(CASES[name]))
            steps = max(20, int(1e6 * chosen.seconds / bench.step_us(file, 20)))
            for ranks in map(int, chosen.ranks.split(",")):
                one, beside, threads, several, model, networks = [], [], [], [], [], []
                for _ in range(chosen.rounds):
                    one.append(bench.step_us(file, steps))
                    threads.append(bench.step_us(file, steps, threads=ranks))
                    beside.append(bench.beside_each_other_us(file, steps, min(ranks, os.cpu_count())))
                    several.append(bench.step_us(file, steps, ranks=ranks))
                    networks.append(bench.network(ranks))
                    model.append(bench.plan(file, ranks, beside[-1], networks[-1]) / several[-1])
                median = statistics.median(t / r for t, r in zip(threads, several))
                print(f"{name:12} {ranks:5} {min(one):9.1f} {min(beside):9.1f} {min(threads):9.1f} {min(several):9.1f} "
                      f"{min(threads) / min(several):6.2f} {median:6.2f} {statistics.median(model):6.2f} "
                      f"({min(model):.2f} to {max(model):.2f})   {'; '.join(networks)}", flush=True)


if __name__ == "__main__":
    main()
