"""What was released must never change, and goes on working in whole runs. Python's standard library only.

usage: check_frozen.py ROULEAU FROZEN_PLUGINS FROZEN_PLUGINS_1_1 C_COMPILER
"""

import csv
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PLUGINS, PLUGINS_1_1 = (Path(a).resolve() for a in sys.argv[1:4])
COMPILER = sys.argv[4]
FOLDER = Path(__file__).resolve().parent
FROZEN = FOLDER / "frozen-1.0"
HEADER = FOLDER.parent.parent / "sdk/include/rouleau/plugin.h"

# `sha256sum` of each file of the first release. No reason is good enough to change a line of this list.
RELEASED = {
    ".clang-format": "b31f421733899646b1bafbeb8ab3dda7391a50169ecac50f16ce7f6abd80409a",
    "README.md": "72033854a28d625b16da70e2b299b39b34d34e1a992dca5852302fc4e691f953",
    "authors_code.cpp": "1a511729fa5a13b0049a913c23eadc5db194632c9bdad49da28412d355526853",
    "collision.c": "922684f3c48488c4f960662982cceaa047a05103f72c3593e8d8cc987e85b028",
    "collision.json": "718ed9df83ec328d2694800402f7f993aaa7b617e0a2e69b00d2f85680386758",
    "every-key.json": "0fed10796e09c9ebdb16fa47d08699f8eec018d05948dadd4d67af5a85a35ee3",
    "interaction-brush.json": "027f6ad4f0c4bc5ac3e8d7bd5e45b5cff2833d247578ec21db3759706484c55e",
    "interaction-damper.json": "b5770eb3695e1d39ce396360803a584c00e3d45006bfff4672092c9866bd18b1",
    "interaction.c": "d8c11a9dfeace00c693900413b5c238c95cfacb0c064c06337f58350960e93ee",
    "membrane-bending.json": "c60b3c29fbc78fce3a879b05b61055367105d5cc3edadf742363a5e01bac5aca",
    "membrane-cell.json": "56a7d71be90185b23e27995abffadd8726ab597bf9a84c2029274d65b4188f1e",
    "membrane-solid.json": "0783fbc0f99105c77fe7cdb6510e9a376b246d6f5805b282dec622675bd3cffd",
    "membrane.c": "2d0a5fa0a097768d75ea46b41e31f8c6592eea839fcf260184995f68cf644fc6",
    "rouleau/plugin.h": "40847be47fbc714e2df46990205d20d68e0f7c00dd3a6114bcb3ffbdf6c6707d",
}
# What interface 1.1 adds, likewise.
RELEASED_1_1 = {
    ".clang-format": "b31f421733899646b1bafbeb8ab3dda7391a50169ecac50f16ce7f6abd80409a",
    "README.md": "9d99ea130c539a23261dcc6dc6dc404d31dac6610be548b7f991d504c48fe232",
    "membrane-elastic.json": "c1b11e73a906c11418874aae65eccfad5f56d1db63e257d91aa46996d72591a0",
    "membrane-viscous.json": "5a41f1f9bb5c96348a32b2634d6efbec86efaa030344008b84b3844051381b1a",
    "membrane.c": "2e777ffbca21981b8fd3e0fe0f9f535fb929dbaac5c291ecc18c800482a4f1a1",
    "rouleau/plugin.h": "4b635da10a502fa6bdca61cdff29634be869170794e5dc2a6269ff796049dd3b",
}

SCENE = {
    "rouleau": 1, "title": "Two cells of the first release's models",
    "domain": {"size": ["25.6 um", "12.8 um"], "nodes": [128, 64],
               "x": "periodic", "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "collision": {"model": "frozen.bgk"}},
    "numerics": {"tau": 1, "density_factor": 10000, "slip_correction": False, "coupling": "explicit"},
    "cell_types": {"cell": {
        "shape": {"circle": {"radius": "2 um"}}, "segments": 64,
        "membrane": [{"model": "frozen.solid", "parameters": {"modulus": "2e-6 N/m"}},
                     {"model": "frozen.bending", "parameters": {"modulus": "2e-19 J"}},
                     {"model": "frozen.cell", "parameters": {"area_modulus": "10 Pa"}}]}},
    # Each is the other turned by half a turn about a node of the lattice.
    "cells": [{"type": "cell", "at": ["10.5 um", "6.2 um"]}, {"type": "cell", "at": ["15.1 um", "6.6 um"]}],
    "stages": [{"name": "shear", "shear_rate": "20 1/s", "strain": 0.5}],
    "output": {"cells": {"strain": 0.1}},
}
SURFACE = {
    "rouleau": 1, "title": "A sphere of the laws of interface 1.1",
    "domain": {"size": ["8 um", "8 um", "8 um"], "nodes": [20, 20, 20], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {"tau": 1, "density_factor": 1000},
    "cell_types": {"cell": {"shape": {"sphere": {"radius": "2 um"}}, "membrane": [
        {"model": "frozen.elastic-surface", "parameters": {"modulus": "5e-6 N/m"}},
        {"model": "frozen.viscous-surface", "parameters": {"viscosity": "2e-8 N s/m", "area_viscosity": "4e-8 N s/m"}}]}},
    "cells": [{"type": "cell", "at": ["4 um", "4 um", "4 um"]}],
    "stages": [{"name": "shear", "shear_rate": "200 1/s", "strain": 0.5}],
    "output": {"cells": {"strain": 0.1}},
}
NO_BRANCH = {"branch_modulus": 0, "viscosity": 0}
BRUSH = {"between": ["cell", "cell"], "model": "frozen.brush",
         "parameters": {"chains": "1e3 1/um2", "thickness": "1 um"}}


def declarations(text):
    """What a compiler sees of a header, in one line."""
    return " ".join(re.sub(r"/\*.*?\*/", " ", text, flags=re.DOTALL).split())


class The_first_release(unittest.TestCase):
    def test_none_of_its_files_has_changed(self):
        for folder, released in (FROZEN, RELEASED), (FOLDER / "frozen-1.1", RELEASED_1_1):
            found = {str(f.relative_to(folder)): hashlib.sha256(f.read_bytes()).hexdigest()
                     for f in sorted(folder.rglob("*")) if f.is_file()}
            self.assertEqual(found, released)

    def test_its_header_is_that_of_the_sdk_while_no_field_was_appended(self):
        text = HEADER.read_text()
        if re.search(r"define ROULEAU_ABI_MINOR (\d+)", text).group(1) == "0":
            self.assertEqual(declarations(text), declarations((FROZEN / "rouleau/plugin.h").read_text()))

    def test_its_header_needs_nothing_but_a_c11_compiler(self):
        with tempfile.TemporaryDirectory() as work:
            Path(work, "alone.c").write_text("#include <rouleau/plugin.h>\n")
            subprocess.run([COMPILER, "-std=c11", "-Wall", "-Wextra", "-Wpedantic", "-Werror", f"-I{FROZEN}", "-c", "alone.c"],
                           cwd=work, check=True)

    def test_its_plugins_export_one_function_as_they_did(self):
        for kind in ("collision", "membrane", "interaction"):
            symbols = subprocess.run(["nm", "-D", "--defined-only", PLUGINS / f"libfrozen-{kind}.so"], capture_output=True,
                                     text=True, check=True).stdout
            names = [line.split()[-1] for line in symbols.splitlines() if " T " in line]
            self.assertEqual(names, ["rouleau_open_v1"])


class Conforms(unittest.TestCase):
    def test_its_plugins_pass_the_conformance_checks_of_this_release(self):
        manifests = sorted([*PLUGINS.glob("*.json"), *PLUGINS_1_1.glob("*.json")])
        result = subprocess.run([PROGRAM, "conform", *manifests], capture_output=True, text=True, timeout=250)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


class Runs(unittest.TestCase):
    """Scenes whose every model was built with the header of the first release."""

    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)

    def run_scene(self, name, scene):
        file, out = self.path / f"{name}.json", self.path / name
        file.write_text(json.dumps(scene))
        environment = {k: v for k, v in os.environ.items() if k != "ROULEAU_PLUGIN_PATH"}
        result = subprocess.run([PROGRAM, "run", file, "--plugin-dir", PLUGINS, "--plugin-dir", PLUGINS_1_1, "--out", out, "--quiet"],
                                capture_output=True, text=True, timeout=250, env=environment)
        self.assertEqual(result.returncode, 0, result.stderr)
        with open(out / "cells.csv", newline="") as table:
            rows = [{k: float(v) for k, v in row.items() if re.fullmatch(r"[-+0-9.e]+|nan|inf", v)} for row in csv.DictReader(table)]
        return json.loads((out / "summary.json").read_text()), rows

    def test_shear_moves_and_deforms_cells_as_with_the_shipped_models_of_the_same_formulas(self):
        scene = json.loads(json.dumps(SCENE))
        laws = scene["cell_types"]["cell"]["membrane"]
        laws[0]["parameters"].update(NO_BRANCH)
        laws[2]["parameters"]["perimeter_modulus"] = 0
        summary, frozen = self.run_scene("frozen", scene)
        self.assertEqual(sorted(p["id"] for p in summary["plugins"]),
                         ["frozen.bending", "frozen.bgk", "frozen.cell", "frozen.solid"])
        scene["fluid"]["collision"] = {"model": "bgk"}
        scene["cell_types"]["cell"]["membrane"] = [
            {"model": "hooke", "parameters": {"stretching_modulus": "2e-6 N/m"}},
            {"model": "bending", "parameters": {"modulus": "2e-19 J"}},
            {"model": "area", "parameters": {"modulus": "10 Pa"}}]
        _, shipped = self.run_scene("shipped", scene)
        self.assertGreater(frozen[-1]["deformation"], 0.01)
        for one, other in zip(frozen, shipped, strict=True):
            for column in ("x_m", "y_m", "deformation", "area_m2", "perimeter_m"):
                # Round-off of some thousand steps, relative to the cell.
                scale = {"deformation": 1, "area_m2": 1.3e-11}.get(column, 1e-5)
                self.assertLess(abs(one[column] - other[column]) / scale, 1e-9, column)

    def test_surfaces_deform_as_with_the_shipped_models_of_the_same_formulas(self):
        summary, frozen = self.run_scene("frozen", SURFACE)
        self.assertEqual({p["id"] for p in summary["plugins"]} & {"frozen.elastic-surface", "frozen.viscous-surface"},
                         {"frozen.elastic-surface", "frozen.viscous-surface"})
        scene = json.loads(json.dumps(SURFACE))
        laws = scene["cell_types"]["cell"]["membrane"]
        laws[0] = {"model": "neo-hookean", "parameters": {"shear_modulus": "5e-6 N/m"}}
        laws[1]["model"] = "viscous"
        _, shipped = self.run_scene("shipped", scene)
        del laws[1]
        _, elastic = self.run_scene("elastic", scene)
        for one, other in zip(frozen[1:], shipped[1:], strict=True):
            self.assertLess(abs(one["deformation"] / other["deformation"] - 1), 1e-9)
        self.assertGreater(elastic[-1]["deformation"], 1.05 * frozen[-1]["deformation"])

    def test_a_brush_pushes_cells_apart_and_keeps_their_common_centre(self):
        scene = json.loads(json.dumps(SCENE))
        scene["domain"]["y"] = "periodic"
        scene["interactions"] = [BRUSH]
        scene["stages"] = [{"name": "rest", "duration": "20 ms"}]
        scene["output"] = {"cells": {"seconds": 0.004}}
        summary, rows = self.run_scene("brush", scene)
        pairs = [rows[i:i + 2] for i in range(0, len(rows), 2)]
        gaps = [pair[0]["min_gap_m"] for pair in pairs]
        self.assertLess(gaps[0], 1e-6)
        self.assertEqual(gaps, sorted(gaps))
        self.assertGreater(gaps[-1], gaps[0] + 5e-8)
        # The forces on the two are opposite and everything is symmetric about the place between them.
        for axis in ("x_m", "y_m"):
            centres = [(pair[0][axis] + pair[1][axis]) / 2 for pair in pairs]
            self.assertLess(max(centres) - min(centres), 1e-9 * 25.6e-6)
        self.assertLess(abs(summary["conservation"]["mass_drift"]), 1e-12)

    def test_friction_slows_the_parting_of_cells_and_keeps_their_common_centre(self):
        def run(name, interactions):
            scene = json.loads(json.dumps(SCENE))
            scene["domain"]["y"] = "periodic"
            scene["interactions"] = interactions
            scene["stages"] = [{"name": "rest", "duration": "4 ms"}]
            scene["output"] = {"cells": {"seconds": 0.004}}
            _, rows = self.run_scene(name, scene)
            return rows[:2], rows[-2:]

        damper = {"between": ["cell", "cell"], "model": "frozen.damper",
                  "parameters": {"friction": "3e4 Pa s/m", "range": "2 um"}}
        _, free = run("free", [BRUSH])
        before, damped = run("damped", [BRUSH, damper])
        parted = [pair[0]["min_gap_m"] - before[0]["min_gap_m"] for pair in (free, damped)]
        self.assertGreater(parted[1], 0)
        self.assertLess(parted[1], 0.8 * parted[0])
        for axis in ("x_m", "y_m"):
            self.assertLess(abs(damped[0][axis] + damped[1][axis] - before[0][axis] - before[1][axis]), 1e-9 * 25.6e-6)

    def test_a_branch_that_has_no_time_to_relax_is_a_spring_beside_the_other(self):
        def deformation(modulus, branch):
            scene = json.loads(json.dumps(SCENE))
            scene["cell_types"]["cell"]["membrane"][0]["parameters"] = {
                "modulus": modulus, "branch_modulus": branch, "relaxation_time": "10 s", "viscosity": 0}
            _, rows = self.run_scene(f"branch-{modulus}-{branch}", scene)
            return rows[-1]["deformation"]

        # 25 ms of shear: the branch has relaxed by a quarter of a percent at most.
        soft, stiff, branched = deformation(2e-6, 0), deformation(6e-6, 0), deformation(2e-6, 4e-6)
        self.assertGreater(abs(soft - stiff), 0.02 * soft)
        self.assertLess(abs(branched - stiff), 0.01 * abs(soft - stiff))


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    sys.exit(0 if program.result.wasSuccessful() else 1)
