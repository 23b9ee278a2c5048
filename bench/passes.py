#!/usr/bin/env python3
"""Where a step goes, by pass: instructions, and bytes against what the memory gives.

A scene runs under valgrind (callgrind) for a few and for more steps; the difference, divided by the steps between, is
one step. Functions that the tasks of a step call are grouped to passes. valgrind 3.19 knows no AVX-512, so AVX2 code is
counted. The same two runs without valgrind give times (summary.json), for which the machine should be idle. What a pass
has to read and write at least follows from counts of nodes; a copy of arrays that leave the caches says how long that
takes.
"""

import argparse
import collections
import json
import os
import re
import shutil
import subprocess
import tempfile
import time
from pathlib import Path

HERE = Path(__file__).resolve().parent
SUSPENSION = {"/numerics/kernel": '"sharp6"', "/numerics/slip_correction": "true", "/numerics/area_correction": "true"}
DENSE = {**SUSPENSION, "/domain/size": '["27 um", "26 um", "22 um"]', "/domain/nodes": "[81, 78, 66]",  # 50 cells
         "/cells/0/random/hematocrit": "0.3", "/cells/0/random/gap": '"0.2 um"'}
SCENES = {  # name: file, what is set, steps counted
    "capsule": ("tests/physics/scenes/plain-capsule-3d.json", {}, (10, 30)),
    "doublet": ("scenes/doublet-3d.json", {}, (10, 30)),
    "suspension": ("scenes/suspension-3d.json", SUSPENSION, (4, 12)),
    "dense": ("scenes/suspension-3d.json", DENSE, (4, 12)),
    "tube": ("scenes/blood/tube-20.json", {}, (4, 12)),
    "slit": ("scenes/slit-3d.json", {}, (10, 30)),
}
# What CellTasks::run and the passes over rows call; the first that fits.
PASSES = [("fluid", r"Fluid<.*>::step\("), ("clear forces", r"Fluid<.*>::clear_force\("), ("spread", r"Coupling<.*>::spread\("),
          ("interpolate", r"Coupling<.*>::interpolate\("), ("membrane laws", r"(Surface|Membrane)Forces::run\("),
          ("contacts", r"Interactions<.*>::run\("), ("contacts with walls", r"WallContacts.*::run\("),
          ("slip correction", r"SurfaceSlip::|SlipCorrection::"),
          ("area correction", r"keep_enclosed\(|take_out_pressures\(|SurfaceNormals"),
          ("viscosity field", r"ViscosityField<.*>::|DisplacementWatch::"), ("move and locate", r"move_nodes\(|::locate\(")]
ACTIVE = 40  # nodes of the lattice that feel a membrane, for each of its own, about
CALLERS = re.compile(r"CellTasks<.*>::run\(|Solver<.*>::run_rows\(|Solver<.*>::make_passes\(\).*Range.*_M_invoke")
OF_TIMES = {"fluid": "fluid", "spread": "spread", "interpolate": "interpolate", "membrane laws": "membrane",
            "contacts": "interaction", "viscosity field": "indicator", "move and locate": "move",
            "slip correction": "corrections"}  # the pass of summary.json with these, and others that it has with them


def run(arguments, scene: str, settings: dict, steps: int, folder: Path, callgrind: Path | None = None) -> dict:
    command = [arguments.build / "bin/rouleau", "run", HERE.parent / scene, "--out", folder / "run", "--quiet",
               "--threads", 1, "--max-steps", steps]
    for pointer, value in settings.items():
        command += ["--set", f"{pointer}={value}"]
    shutil.rmtree(folder / "run", ignore_errors=True)
    environment = dict(os.environ)
    if callgrind:
        command = ["valgrind", "--tool=callgrind", f"--callgrind-out-file={callgrind}", *command]
        environment["ROULEAU_INSTRUCTION_SET"] = "avx2"
    result = subprocess.run(list(map(str, command)), env=environment, capture_output=True, text=True)
    if result.returncode != 0:
        raise SystemExit(f"passes: {' '.join(map(str, command))} failed:\n{result.stdout}{result.stderr}")
    return json.loads((folder / "run/summary.json").read_text())


def instructions(file: Path) -> collections.Counter:
    """By pass: what the functions that tasks call take, with all that they call."""
    names, found = {}, collections.Counter()

    def name(text: str) -> str:
        number, rest = re.match(r"\((\d+)\)(?: (.*))?$", text).groups()
        if rest:
            names[number] = rest
        return names[number]

    caller, callee, is_call = "", "", False
    for line in file.read_text().splitlines():
        if line.startswith("fn="):
            caller = name(line[3:])
        elif line.startswith("cfn="):
            callee = name(line[4:])
        elif line.startswith("calls="):
            is_call = True
        elif is_call:
            is_call = False
            if CALLERS.search(caller) and not CALLERS.search(callee):
                group = next((group for group, pattern in PASSES if re.search(pattern, callee)), None)
                if group:
                    found[group] += int(line.split()[1])
    return found


def times(summary: dict) -> dict:
    return {entry["name"]: entry["wall_s"] for entry in summary["passes"]}


def stream() -> float:
    """Bytes a second that a copy reads and writes, in arrays of 256 MB."""
    source, best = bytearray(b"\1") * (1 << 28), 0.0
    target = bytearray(1 << 28)
    for _ in range(5):
        begin = time.perf_counter()
        target[:] = source
        best = max(best, 2 * len(source) / (time.perf_counter() - begin))
    return best


def least_bytes(nodes: float, active: float, membrane: float, word: int) -> dict:
    """That a pass reads and writes at least, of numbers that every step takes anew from memory: 19 populations there and
    back; in active nodes a force there, a velocity back and a rate; of a membrane node places, velocities and forces in
    doubles. What stencils touch again is in a cache."""
    vector = 3 * 8 * membrane
    return {"fluid": nodes * 2 * 19 * word + active * 7 * word, "clear forces": active * 3 * word,
            "spread": active * 6 * word + 2 * vector, "interpolate": active * 3 * word + 2 * vector,
            "membrane laws": 2 * vector, "contacts": 2 * vector, "slip correction": 4 * vector,
            "area correction": 4 * vector, "move and locate": 3 * vector, "viscosity field": vector}


def table(arguments, name: str, precision: str, folder: Path, bandwidth: float) -> None:
    scene, settings, (few, more) = SCENES[name]
    settings = {**settings, "/numerics/precision": f'"{precision}"'}
    counts = []
    for steps in (few, more):
        run(arguments, scene, settings, steps, folder, folder / "callgrind")
        counts.append(instructions(folder / "callgrind"))
    step = {group: (counts[1][group] - counts[0][group]) / (more - few) for group, _ in PASSES}
    first, last = (run(arguments, scene, settings, steps, folder) for steps in (few, 5 * more))
    spent = {key: (value - times(first).get(key, 0)) / (5 * more - few) for key, value in times(last).items()}
    nodes = 1.0
    for axis in json.loads((folder / "run/scene.json").read_text())["domain"]["nodes"]:
        nodes *= axis
    # Of triangles and nodes, which are half as many.
    triples = re.findall(r'Dimensions="(\d+) 3"', (folder / "run/frames.xmf").read_text())
    membrane = float(min(map(int, triples), default=0))
    bytes_of = least_bytes(nodes, min(nodes, ACTIVE * membrane), membrane, 4 if precision == "f32" else 8)
    whole = sum(step.values())
    print(f"\n{name}, {precision} ({scene}), a step\n{'pass':20} {'instructions':>14} {'share':>7} {'least bytes':>12} "
          f"{'at stream, us':>14} {'measured, us':>13}")
    for group, count in step.items():
        if count > 0:
            least = bytes_of.get(group, 0)
            took = spent.get(OF_TIMES.get(group, ""))
            print(f"{group:20} {count:14.0f} {count / whole:7.1%} {least:12.0f} {least / bandwidth * 1e6:14.1f} "
                  f"{'' if took is None else f'{took * 1e6:.1f}':>13}")
    print(f"{'all':20} {whole:14.0f}", flush=True)


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--build", type=Path, default=HERE.parent / "build/release", help="build tree or installation")
    parser.add_argument("--scenes", nargs="+", choices=SCENES, default=list(SCENES))
    parser.add_argument("--precisions", nargs="+", choices=("f32", "f64"), default=["f32", "f64"])
    arguments = parser.parse_args()
    bandwidth = stream()
    print(f"A copy of 256 MB reads and writes {bandwidth / 1e9:.1f} GB/s")
    with tempfile.TemporaryDirectory() as folder:
        for name in arguments.scenes:
            for precision in arguments.precisions:
                table(arguments, name, precision, Path(folder), bandwidth)


if __name__ == "__main__":
    main()
