#!/usr/bin/env python3
"""Ten thousand cells come in through an inlet, in pieces of a run that is stopped and goes on: none is lost, the
hematocrit of the inlet is kept, and what flows in flows out.

usage: check_arrivals.py ROULEAU [--seconds SIMULATED] [--piece WALL_CLOCK_SECONDS] [--keep FOLDER]
"""
import argparse
import json
import subprocess
import sys
import tempfile
from pathlib import Path

WALLS = {"lower": {"wall": {}}, "upper": {"wall": {}}}
HEMATOCRIT = 0.2
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
            "what flowed in less what flowed out, over the former": 1 + outlet["flow_in"] / inlet["flow_in"],
            "steps": summary["steps"], "seconds": round(summary["wall_s"], 1), "pieces": pieces}
        for name, value in figures.items():
            print(f"{name}: {value:.3g}" if isinstance(value, float) else f"{name}: {value}")
        log = [json.loads(line) for line in (folder / "run/log.jsonl").read_text().splitlines()]
        came = [entry["cell"] for entry in log if entry["event"] == "cell_came"]
        left = [entry["cell"] for entry in log if entry["event"] == "cell_left"]
        faults = [fault for fault, there in {
            "a cell is lost": traffic["cells_in"] != traffic["cells_inside"] + traffic["cells_out"],
            "the log has others": came != list(range(traffic["cells_in"])) or len(set(left)) != traffic["cells_out"],
            "cells wait": figures["waiting"] > 0,
            "another hematocrit": abs(figures["hematocrit of the inlet over what was asked for, less 1"]) > 0.02,
            # Flows are sampled when cells are looked for. Those of the outlet scatter by a hundredth while cells leave, so
            # that their mean is known to some 2e-4; without cells what goes out is what comes in to 1e-8.
            "volume is lost": abs(figures["what flowed in less what flowed out, over the former"]) > 1e-3,
        }.items() if there]
        sys.exit("; ".join(faults))


if __name__ == "__main__":
    main()
