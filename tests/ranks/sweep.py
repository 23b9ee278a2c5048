"""Every shipped scene and every shipped model by 1, 2, 3, 4, 6 and 8 ranks, with 1 and 2 threads each: the bytes of one process?

usage: sweep.py ROULEAU MPIRUN SOURCE [--only TEXT] [--whole] [--ranks "2 8"] [--threads "1"]

Too long for CI (half an hour on two processors), where `ranks` does the same for a few scenes. Compared are the tables, summary.json, frames.h5 and
the arrays of checkpoint.h5, which are all that a run goes on from (HDF5 files where h5py is installed). Scenes are those of scenes/ and of tests/physics/scenes, where some choose their
numerics (`auto`); each takes its first steps (60, in three dimensions 15), and --whole runs it to its end. Models are put into a scene of red cells in two dimensions (tests/resume/scenes/kinetics.json) and into one in three (scenes/doublet-3d.json).
"""

import argparse
import json
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path

KINETICS = "tests/resume/scenes/kinetics.json"
DOUBLET = "scenes/doublet-3d.json"
REQUIRED = {  # parameters that have no default
    "bridging": {"site_density": "1e14 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.6 um", "on_rate": "20 1/s",
                 "off_rate": "1 1/s", "cutoff": "1.5 um"},
    "lennard-jones": {"depth": "5e-8 J/m2"}, "lennard-jones-shifted": {"depth": "5e-8 J/m2"}, "morse": {"depth": "5.2e-8 J/m2"},
    "repulsion": {"strength": "1e-7 J/m2", "cutoff": "1 um"},
    "area": {"modulus": "10 Pa"}, "volume": {"modulus": "10 Pa"}, "bending": {"modulus": "3.6e-19 J"},
    "hooke": {"stretching_modulus": "6e-6 N/m"}, "inextensible": {"stretching_modulus": "6e-5 N/m"},
    "neo-hookean": {"shear_modulus": "6e-6 N/m"}, "skalak": {"shear_modulus": "6e-6 N/m"}, "perimeter": {"modulus": "6e-6 N/m"},
    "lim": {"shear_modulus": "4e-6 N/m", "area_modulus": "4e-6 N/m"}, "surface-area": {"modulus": "6e-6 N/m"}, "local-area": {"modulus": "6e-6 N/m"},
    "standard-linear-solid": {"modulus": "3e-6 N/m", "relaxation_time": "0.05 s"},
    "viscous": {"viscosity": "1e-7 N s/m"},
}


def works_in_space(about):
    """By its manifest."""
    if about["kind"] == "collision":
        return "D3Q19" in about.get("lattices", [])
    return 3 in about.get("dimensions", [2] if about["kind"] == "membrane" else [2, 3])


def scenes_of_models(root, folder):
    """A scene for each model and each number of dimensions that it says it has."""
    for manifest in sorted((root / "plugins").glob("*/*/*.json")):
        about = json.loads(manifest.read_text())
        kind, model = about["kind"], about["id"]
        parameters = dict(REQUIRED.get(model, {}))
        if model == "depletion":  # the scene that is shipped has the parameters of dextran
            parameters = json.loads((root / "scenes/depletion-regularised.json").read_text())["interactions"][0]["parameters"]
        for base in KINETICS, DOUBLET:
            scene = json.loads((root / base).read_text())
            spatial = len(scene["domain"]["nodes"]) == 3
            if spatial and not works_in_space(about):
                continue
            if not spatial and 2 not in about.get("dimensions", [2]):
                continue
            entry = {"model": model, "parameters": parameters}
            membrane = next(iter(scene["cell_types"].values()))["membrane"]
            if kind == "collision":
                scene["fluid"]["collision"] = entry
            elif kind == "interaction":
                scene["interactions"] = [{"between": ["rbc", "rbc"], **entry}]
            elif model not in [law["model"] for law in membrane]:
                membrane.append(entry)
            if not spatial:
                scene["output"] = {"cells": {"seconds": 1e-4}, "fields": {"seconds": 1e-3, "quantities": ["velocity", "viscosity"]},
                                   "checkpoint": {"seconds": 600}}
            file = folder / f"{model}-{3 if spatial else 2}d.json"
            file.write_text(json.dumps(scene))
            yield file


def steps_of(file):
    return 15 if len(json.loads(file.read_text())["domain"]["size"]) == 3 else 60


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("mpirun")
    parser.add_argument("source", type=Path)
    parser.add_argument("--only", default="", help="scenes whose path has this text")
    parser.add_argument("--whole", action="store_true", help="to the end of the scene")
    parser.add_argument("--ranks", default="1 2 3 4 6 8")
    parser.add_argument("--threads", default="1 2")
    arguments = parser.parse_args()
    root = arguments.source.resolve()
    arguments.program, arguments.mpirun = (str(Path(shutil.which(name)).resolve()) for name in (arguments.program, arguments.mpirun))
    sys.argv[1:5] = [arguments.program, arguments.mpirun, str(root), ""]
    sys.path.insert(0, str(Path(__file__).parent))
    from check_ranks import ENVIRONMENT, checkpoint, differences, h5py, own_words, ranks

    cuts = [(int(count), int(threads)) for count in arguments.ranks.split() for threads in arguments.threads.split()]
    failures, compared = [], 0
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        (folder / "models").mkdir()
        shipped = sorted((root / "scenes").rglob("*.json")) + sorted((root / "tests/physics/scenes").glob("*.json"))
        scenes = [*shipped, *scenes_of_models(root, folder / "models")]
        for scene in (s for s in scenes if arguments.only in str(s)):
            begin = time.monotonic()
            switches = [] if arguments.whole else ["--max-steps", str(steps_of(scene))]

            def run(before, directory, threads):
                command = [*before, "run", str(scene), "--out", str(directory), "--quiet", "--overwrite", "--no-error-bar", "--threads", str(threads), *switches]
                return subprocess.run(command, capture_output=True, text=True, env=ENVIRONMENT)

            alone = folder / "alone"
            result = run([arguments.program], alone, 1)
            if result.returncode != 0:
                failures.append(f"{scene.name}: one process ends with {result.returncode}: {result.stderr.strip()}")
                print(failures[-1], flush=True)
                continue
            wrong = []
            for count, threads in cuts:
                together = folder / "together"
                result = run(ranks(count), together, threads)
                if result.returncode != 0:
                    wrong.append(f"{count} x {threads}: {own_words(result.stderr).splitlines()[0]}")
                    continue
                found = differences(alone, together)
                if h5py is not None and (alone / "checkpoint.h5").exists() and checkpoint(alone) != checkpoint(together):
                    found.append("checkpoint.h5")
                compared += 1
                wrong += [f"{count} x {threads}: {found}"] if found else []
            failures += [f"{scene.name}: {what}" for what in wrong]
            has = "no h5py" if h5py is None else "checkpoint" if (alone / "checkpoint.h5").exists() else "no checkpoint"
            print(f"{scene.name}: {'; '.join(wrong) if wrong else 'same bytes'} ({has}, {time.monotonic() - begin:.0f} s)", flush=True)
    print(f"{compared} runs compared, {len(failures)} of them differ or failed")
    return bool(failures)


if __name__ == "__main__":
    sys.exit(main())
