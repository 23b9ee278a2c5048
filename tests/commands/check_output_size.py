#!/usr/bin/env python3
"""Compares the size of the output that `rouleau plan` expects with that of the run.

Usage: check_output_size.py ROULEAU
"""
import json
import pathlib
import subprocess
import sys
import tempfile

MEMBRANE = [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}},
            {"model": "bending", "parameters": {"modulus": "3.6e-12 dyn cm"}}]
FLUID = {
    "rouleau": 1,
    "domain": {"size": ["24 um", "16 um"], "nodes": [96, 64], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 4000},
    "stages": [{"name": "rest", "duration": "2 ms"}, {"name": "shear", "shear_rate": "20 1/s", "strain": 0.2}],
}
CELLS = FLUID | {
    "cell_types": {"rbc": {"shape": {"biconcave": {"radius": "3.91 um"}}, "segments": 77, "membrane": MEMBRANE},
                   "disc": {"shape": {"circle": {"radius": "2 um"}}, "segments": 50, "membrane": MEMBRANE}},
    "cells": [{"type": "rbc", "at": ["12 um", "8 um"], "angle": "90 deg"}, {"type": "disc", "at": ["4 um", "8 um"]},
              {"type": "disc", "at": ["20 um", "8 um"]}],
}
ALL = ["velocity", "density", "viscosity", "vorticity"]
REGION = {"region": {"from": ["2 um", "2 um"], "to": ["20 um", "9 um"]}, "stride": 2}
# Name, scene, output, and how far the estimate may be from the run's frames.h5, relatively or by 8 kB that HDF5 may take
# or leave in a small file. None: compressed fields, of which only the most is known.
CASES = [
    ("cells", CELLS, {"cells": {"strain": 0.005}}, 0.03),
    ("cells by seconds and strain", CELLS, {"cells": {"strain": 0.01, "seconds": "0.3 ms"}}, 0.03),
    ("nothing but the ends of stages", CELLS, {}, 0.03),
    ("fields", CELLS, {"fields": {"strain": 0.02, "quantities": ALL, "compression": 0}}, 0.03),
    ("fields in double precision", FLUID,
     {"fields": {"strain": 0.02, "quantities": ["velocity"], "precision": "f64", "compression": 0}}, 0.03),
    ("fields of a region", CELLS,
     {"cells": {"strain": 0.01}, "fields": {"strain": 0.01, "quantities": ALL, "compression": 0} | REGION}, 0.03),
    ("compressed fields", CELLS, {"cells": {"strain": 0.02}, "fields": {"strain": 0.02, "quantities": ALL}}, None),
    ("cells with a checkpoint", CELLS, {"cells": {"strain": 0.02}, "checkpoint": {"seconds": 600}}, 0.08),
    ("compressed fields of a region", FLUID,
     {"fields": {"strain": 0.02, "quantities": ALL, "compression": 9, "precision": "f64"} | REGION}, None),
]


def main() -> int:
    program = pathlib.Path(sys.argv[1]).resolve()
    failed = 0
    with tempfile.TemporaryDirectory() as scratch:
        for name, scene, output, tolerance in CASES:
            file, directory = pathlib.Path(scratch) / "scene.json", pathlib.Path(scratch) / name
            # A frames.h5 that is put together of segments, as with checkpoints, has up to 400 bytes a frame less.
            file.write_text(json.dumps(scene | {"output": {"checkpoint": "never"} | output}))
            plan = json.loads(subprocess.run([program, "plan", file, "--json"], check=True, capture_output=True).stdout)
            subprocess.run([program, "run", file, "--out", directory], check=True, capture_output=True)
            expected = plan["estimate"]["output"]
            frames = sum(file.stat().st_size for file in directory.glob("frames*.h5"))
            tables = sum(table.stat().st_size for table in directory.glob("*.csv"))
            rows = len((directory / "series.csv").read_text().splitlines()) - 1
            ratios = expected["frames_bytes"] / frames, expected["tables_bytes"] / tables
            good = expected["outputs"] == rows and abs(ratios[1] - 1) < 0.25  # numbers have 3 to 17 digits
            good = good and (ratios[0] >= 1 if tolerance is None else abs(ratios[0] - 1) < max(tolerance, 8000 / frames))
            good = good and expected["fields_compressed"] == (tolerance is None)
            checkpoints = [file.stat().st_size for file in directory.glob("checkpoint*.h5")]
            good = good and bool(checkpoints) == ("checkpoint" in output) == (expected["checkpoint_bytes"] > 0)
            good = good and all(abs(expected["checkpoint_bytes"] - size) < 0.05 * size + 40_000 for size in checkpoints)
            good = good and json.loads((directory / "summary.json").read_text())["output_estimate"] == expected
            failed += not good
            words = "".join(f", checkpoint {size} (expected {expected['checkpoint_bytes']:.0f})" for size in checkpoints)
            print(f"{'passed' if good else 'FAILED'}  {name}: {rows} rows (expected {expected['outputs']:.0f}), frames.h5 "
                  f"{frames} (expected over that: {ratios[0]:.3f}), tables {tables} ({ratios[1]:.3f}){words}")
    return 1 if failed else 0


if __name__ == "__main__":
    sys.exit(main())
