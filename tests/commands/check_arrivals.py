#!/usr/bin/env python3
"""Cells come in through an inlet, ten thousand unless another time is given, in pieces of a run that is stopped and goes
on: none is lost, the hematocrit of the inlet is kept, and what flows in flows out or is there.

usage: check_arrivals.py ROULEAU [--seconds SIMULATED] [--piece WALL_CLOCK_SECONDS] [--keep FOLDER]
"""
import argparse
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

WALLS = {"lower": {"wall": {}}, "upper": {"wall": {}}}
HEMATOCRIT = 0.2
MEAN, HEIGHT, AREA = 1e-3, 8e-6, 20e-6 * 8e-6  # SI
SCENE = {
    "rouleau": 1, "title": "Discs that come in and leave",
    "domain": {"size": ["20 um", "8 um"], "nodes": [40, 16], "y": WALLS,
               "x": {"lower": {"inlet": {"mean_velocity": "1 mm/s", "cells": {"type": "disc", "hematocrit": HEMATOCRIT, "length": "10 um"}}},
                     "upper": {"outlet": {"pressure": "0 Pa"}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {"density_factor": 100, "area_correction": True},
    "cell_types": {"disc": {"shape": {"circle": {"radius": "1 um"}}, "segments": 12, "interior_viscosity": "1.2 cP",
                            "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}}]}},
    "interactions": [{"between": ["disc", other], "model": "repulsion", "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}}
                     for other in ("disc", "wall")],
    "output": {"cells": {"seconds": "50 ms"}},
}


def main():
    read = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    read.add_argument("program", type=Path)
    read.add_argument("--seconds", type=float, default=19, help="simulated; 533 cells come in each second")
    read.add_argument("--piece", default="60s", help="wall-clock time of a piece of the run")
    read.add_argument("--keep", type=Path, help="folder of the run, which goes on if it is there")
    given = read.parse_args()
    with tempfile.TemporaryDirectory(prefix="rouleau-arrivals-") as scratch:
        folder = given.keep or Path(scratch)
        folder.mkdir(exist_ok=True)
        (folder / "scene.json").write_text(json.dumps({**SCENE, "stages": [{"name": "flow", "duration": f"{given.seconds} s"}]}))
        pieces = 0
        while True:
            done = subprocess.run([given.program.resolve(), "run", "scene.json", "--out", "run", "--quiet", "--resume", "--max-time", given.piece],
                                  cwd=folder, capture_output=True, text=True)
            pieces += 1
            if done.returncode not in (0, 130):
                sys.exit(done.stderr)
            summary = json.loads((folder / "run/summary.json").read_text())
            if summary["status"] == "completed":
                break
        traffic = summary["cell_traffic"]
        inlet, outlet = traffic["stages"][0]["ends"]
        figures = {
            "cells in": traffic["cells_in"], "inside": traffic["cells_inside"], "out": traffic["cells_out"],
            "waiting": traffic["cells_due"] - traffic["cells_in"],
            "hematocrit of the inlet over what was asked for, less 1": inlet["volume_in"] / inlet["flow_in"] / HEMATOCRIT - 1,
            "what flowed in over what was asked for, less 1": inlet["flow_in"] / (MEAN * HEIGHT * given.seconds) - 1,
            "what flowed in less what flowed out, over what is there": (inlet["flow_in"] + outlet["flow_in"]) / AREA,
            "the same less what is there more, over what flowed in": summary["conservation"]["mass_drift"],
            "steps": summary["steps"], "seconds": round(summary["wall_s"], 1), "pieces": pieces}
        for name, value in figures.items():
            print(f"{name}: {value:.3g}" if isinstance(value, float) else f"{name}: {value}")
        log = [json.loads(line) for line in (folder / "run/log.jsonl").read_text().splitlines()]
        with (folder / "run/series.csv").open() as table:
            last = list(csv.DictReader(table))[-1]
        came = [entry["cell"] for entry in log if entry["event"] == "cell_came"]
        left = [entry["cell"] for entry in log if entry["event"] == "cell_left"]
        faults = [fault for fault, there in {
            "a cell is lost": traffic["cells_in"] != traffic["cells_inside"] + traffic["cells_out"],
            "the log has others": came != list(range(traffic["cells_in"])) or len(set(left)) != traffic["cells_out"],
            "cells wait": figures["waiting"] > 0,
            "another hematocrit": abs(figures["hematocrit of the inlet over what was asked for, less 1"]) > 0.02,
            "another flow": abs(figures["what flowed in over what was asked for, less 1"]) > 1e-6,
            # The lattice's fluid gives way: the pressure that drives it makes it denser by 0.3 % (a mean of 2.25 Pa at
            # a speed of sound of 8.3 cm/s and a hundred times the density).
            "volume is not there": not 0 < figures["what flowed in less what flowed out, over what is there"] < 0.01,
            "volume is lost": not 0 <= figures["the same less what is there more, over what flowed in"] < 1e-6,
            "the columns have others": any(
                abs(float(last[column]) / (sign * end["flow_in"]) - 1) > 1e-9
                for column, end, sign in (("inlet_volume_m2", inlet, 1), ("outlet_volume_m2", outlet, -1))),
        }.items() if there]
        sys.exit("; ".join(faults) or None)


if __name__ == "__main__":
    main()
