"""What a run that failed advises ends the failure: runs fail, the remedy that they print is applied, word by word, and
the same runs must pass the place. Python's standard library only.

usage: check_remedies.py ROULEAU SOURCE_FOLDER [--all]

--all: every point of attraction of limits/adhesion.json and tests/stability/adhesion-at-rest.json that fails (some core-minutes)
"""

import copy
import json
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, SOURCE = (Path(a).resolve() for a in sys.argv[1:3])
ALL = "--all" in sys.argv

DEPTH = "/interactions/0/parameters/depth"
LEAST_THICKNESS = "0.8 um"  # of a red cell, and a little less
WAYS = [  # what a remedy may say, and the change of the scene that it means
    (r"set (numerics\.\w+) and (numerics\.\w+) to true", lambda s, a, b: (put(s, a, True), put(s, b, True))),
    (r"set (numerics\.\w+) to (true|\"\w+\")", lambda s, key, value: put(s, key, json.loads(value))),
    (r"lower the attraction to a depth of (\S+) J/m2", lambda s, value: put(s, DEPTH, f"{value} J/m2")),
    (r'add an interaction "repulsion" between \["(\w+)", "(\w+)"\] with (?:a strength of (\S+) J/m2 and )?a cutoff '
     r"(?:of (\S+ um) or more|below the cells' least thickness)",
     lambda s, a, b, strength, cutoff: s.setdefault("interactions", []).append(
         {"between": [a, b], "model": "repulsion",
          "parameters": {"strength": f"{strength} J/m2", "cutoff": cutoff or LEAST_THICKNESS}})),
    (r"lower ([\w./]+)(?: and ([\w./]+))? to (\S+?)(?=,|$| and)",
     lambda s, a, b, value: [put(s, key, float(value)) for key in (a, b) if key]),
    (r"lower ((?:numerics\.|/stages/\d/)density_factor)(?! to| and)", lambda s, key: put(s, key, get(s, key) / 2)),
    (r"take more (segments|triangles)", lambda s, what: [kind.pop(what) for kind in s["cell_types"].values()]),
]


def keys_of(pointer):
    return [int(k) if k.isdigit() else k for k in pointer.strip("/").replace(".", "/").split("/")]


def get(scene, pointer):
    for key in keys_of(pointer):
        scene = scene[key]
    return scene


def put(scene, pointer, value):
    *above, last = keys_of(pointer)
    for key in above:
        scene = scene[key]
    scene[last] = value


def applied(remedy, scene):
    """The scene with all that the first way of the remedy says: what stands before ", or"."""
    first = re.split(r", or | or set|, so far|; lower", remedy)[0].split(": ")[-1]
    changed = copy.deepcopy(scene)
    rest = first
    for pattern, change in WAYS:
        for words in re.finditer(pattern, first):
            change(changed, *words.groups())
            rest = rest.replace(words.group(), "")
    if re.search(r"\w{4}", re.sub(r"\(.*?\)", "", rest)):
        raise AssertionError(f"the remedy says more than was understood: {rest!r} of {remedy!r}")
    return changed


def factor(scene):
    return scene["stages"][0].get("density_factor", scene["numerics"]["density_factor"])


def with_limits(file, *changes):
    """The scene of a limits file, with its changes and these."""
    limits = json.loads((SOURCE / "limits" / file).read_text())
    scene = json.loads((SOURCE / "limits" / limits["scene"]).read_text())
    for pointer, value in [*limits.get("set", {}).items(), *changes]:
        put(scene, pointer, value)
    return scene, limits


def one_cell(file, domain, stage, **numerics):
    """A red cell of a scene of limits/, alone in a flow, with both corrections."""
    scene = json.loads((SOURCE / "limits/scenes" / file).read_text())
    scene["domain"] = {"size": ["18 um", "9 um", "9 um"][:len(domain["nodes"])], **domain}
    scene["fluid"]["inertia"] = True
    scene["numerics"] = {"slip_correction": True, "area_correction": True, **numerics}
    scene["cell_types"]["rbc"].pop("segments", None)
    if len(domain["nodes"]) == 2:
        scene["cell_types"]["rbc"]["segments"] = 52
        scene["cells"] = [{"type": "rbc", "at": ["9 um", "4.7 um"], "angle": "90 deg"}]
    else:
        scene["cells"] = [{"type": "rbc", "at": ["9 um", "4.6 um", "4.5 um"], "axis": [1, 0.05, 0]}]
    scene["stages"] = [{"name": "flow", "start": "developed", **stage}]
    scene["output"] = {"cells": {"seconds": "2 ms"}}
    del scene["interactions"]
    return scene


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def run_scene(self, scene, steps=None):
        file, out = self.path / "scene.json", self.path / f"out{len(list(self.path.iterdir()))}"
        file.write_text(json.dumps(scene))
        result = subprocess.run([PROGRAM, "run", file, "--out", out, "--quiet", "--no-error-bar",
                                 *(["--max-steps", str(steps)] if steps else [])],
                                capture_output=True, text=True, timeout=900)
        self.assertIn(result.returncode, (0, 1), result.stderr)
        return json.loads((out / "summary.json").read_text())

    def check(self, name, scene, reason, *words, move=None):
        """`words`: what the failure must say; `move`: of "move them apart", by so many um."""
        failure = self.run_scene(scene).get("failure")
        self.assertIsNotNone(failure, f"{name} did not fail")
        print(f"{name}: {failure['reason']} at step {failure['step']}: {failure['message']}: {failure['remedy']}")
        self.assertEqual(failure["reason"], reason, failure)
        for word in words:
            self.assertIn(word, failure["message"] + failure["remedy"])
        if move:
            apart, wanted = (float(re.search(pattern, text)[1]) for pattern, text in
                             ((r"are (\S+) um apart", failure["message"]), (r"apart, to (\S+) um", failure["remedy"])))
            changed = copy.deepcopy(scene)
            move(changed, wanted - apart)
            self.assertEqual(self.run_scene(changed, 500)["status"], "completed", f"{name}: moved to {wanted} um")
            failure["remedy"] = failure["remedy"].split(", or ")[1]
        changed = applied(failure["remedy"], scene)
        self.assertNotEqual(changed, scene)
        # Half as far again as the failure, and 500 steps.
        shorter = factor(scene) / factor(changed) if failure["step"] else 1
        steps = None if ALL and failure["step"] else int(1.5 * failure["step"] * shorter) + 500
        summary = self.run_scene(changed, steps)
        self.assertEqual(summary["status"], "completed", f"{name}: {failure['remedy']}: {summary.get('failure')}")


class A_leak_is_judged_by_the_strain_of_the_flow(Case):
    """What area_correction puts back adds up in a steady flow; what it does to a result does not."""
    WALLS = {"lower": {"wall": {}}, "upper": {"wall": {}}}
    TUBE = {"nodes": [48, 24, 24], "walls": {"tube": {"radius": "4.5 um"}}}

    def goes_on(self, scene, limit):
        scene["checks"] = {"area_drift": limit}
        summary = self.run_scene(scene)
        self.assertEqual(summary["status"], "completed", summary.get("failure"))
        self.assertGreater(summary["conservation"]["area_leakage_max"], 0)
        self.assertLess(summary["conservation"]["area_drift_max"], 1e-3)

    def test_a_cell_in_a_channel_goes_on(self):
        """Its sum passes the limit at half of the time and grows by 0.3 per second."""
        self.goes_on(one_cell("two-cells.json", {"nodes": [48, 24], "y": self.WALLS},
                              {"pressure_gradient": "2e5 Pa/m", "duration": "20 ms"}, density_factor=150), 0.005)

    def test_a_cell_in_space_goes_on(self):
        """Its sum passes the limit at half of the time."""
        scene = one_cell("two-cells-3d.json", {"nodes": [20, 20, 20], "size": ["16 um"] * 3, "y": self.WALLS},
                         {"shear_rate": "100 1/s", "strain": 4}, density_factor=400, tau=1.5, kernel="sharp6",
                         coupling="auto")
        scene["cells"] = [{"type": "rbc", "at": ["8 um"] * 3, "angle": "60 deg"}]
        self.goes_on(scene, 0.005)

    def test_a_cell_that_leaks_2_percent_in_a_strain_of_1_is_stopped_in_the_plane(self):
        scene, _ = with_limits("adhesion.json", (DEPTH, "5e-5 J/m2"), ("/numerics/slip_correction", True),
                               ("/numerics/area_correction", True), ("/output", {}),
                               ("/cell_types/rbc/interior_viscosity", "1.2 cP"))
        scene["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 2, "start": "developed"}]
        self.check("leak in the plane", scene, "area_drift", "while the flow strained by 1")

    def test_a_cell_that_leaks_2_percent_in_a_strain_of_1_is_stopped_in_space(self):
        self.check("leak in a tube", one_cell("two-cells-3d.json", self.TUBE,
                                              {"mean_velocity": "1 mm/s", "duration": "6 ms"}, density_factor=400,
                                              tau=2.0, kernel="sharp6", coupling="auto"),
                   "area_drift", "while the flow strained by 1", "lower numerics.density_factor")


class A_remedy_ends_its_failure(Case):
    def test_cells_that_attract_each_other_and_leak(self):
        for ratio in ("1.2 cP", "6 cP") if ALL else ("1.2 cP",):
            for depth in (1.8e-5, 5e-5, 1e-4) if ALL else (1.8e-5,):
                scene, limits = with_limits("adhesion.json", (DEPTH, f"{depth} J/m2"),
                                            (get(with_limits("adhesion.json")[1], "/matrix/0/pointer"), ratio))
                self.check(f"{depth} J/m2, {ratio}", scene, "area_drift", "area_correction")

    def test_cells_in_space_that_attract_each_other_and_leak(self):
        for ratio in ("1.2 cP", "6 cP") if ALL else ("6 cP",):
            scene, _ = with_limits("contact-3d.json", (DEPTH, "2e-5 J/m2"), ("/cells/1/at/1", "6.6 um"),
                                   ("/stages", [{"name": "rest", "duration": "60 ms"}]), ("/output", {}),
                                   ("/cell_types/rbc/interior_viscosity", ratio))
            self.check(f"in space, {ratio}", scene, "area_drift", "area_correction")

    @unittest.skipUnless(ALL, "long")
    def test_pairs_at_rest_without_what_holds_them(self):
        for case in with_limits("../tests/stability/adhesion-at-rest.json")[1]["cases"]:
            scene, _ = with_limits("../tests/stability/adhesion-at-rest.json", *case["set"].items(),
                                   ("/numerics/slip_correction", False), ("/numerics/area_correction", False))
            del scene["interactions"][1]
            scene["stages"][0]["density_factor"] *= 4
            self.check(case["name"], scene, "area_drift", '["rbc", "self"]')

    def test_membranes_beyond_the_stable_stiffness(self):
        """A little beyond the edges of limits/stretching.json and kernels.json."""
        modulus = "/cell_types/rbc/membrane/0/parameters/shear_modulus"
        for reason, *settings in (("mach", ("/numerics/tau", 2), (modulus, "1.4e-5 N/m")),
                                  ("energy_growth", ("/numerics/tau", 2), (modulus, "2e-3 N/m"),
                                   ("/numerics/coupling", "semi-implicit")),
                                  ("energy_growth", ("/numerics/kernel", "linear2"), (modulus, "1e-6 N/m"))):
            with self.subTest(settings):
                self.check(str(settings), with_limits("stretching.json", *settings)[0], reason)

    def test_an_attraction_beyond_all_bounds(self):
        scene, _ = with_limits("adhesion.json", (DEPTH, "6e-3 J/m2"), ("/stages/0/duration", "2 ms"))
        self.check("6e-3 J/m2", scene, "mach", "morse pulls them together", "lower the attraction")

    def test_cells_that_begin_in_the_core_of_a_potential(self):
        plane, _ = with_limits("adhesion.json", ("/cells/0/row/spacing", "2.7 um"), (DEPTH, "5e-5 J/m2"),
                               ("/stages/0/duration", "2 ms"))
        del plane["stages"][1:], plane["output"]["fields"]
        space, _ = with_limits("contact-3d.json", (DEPTH, "1e-5 J/m2"), ("/cells/1/at/1", "6 um"))
        words = "cells 0 and 1 are", "morse pushes them apart with", "move them apart, to"
        self.check("plane", plane, "mach", *words,
                   move=lambda s, by: put(s, "/cells/0/row/spacing", f"{2.7 + by} um"))
        self.check("space", space, "mach", *words, move=lambda s, by: put(s, "/cells/1/at/1", f"{6 + by} um"))


if __name__ == "__main__":
    sys.argv[1:] = []
    unittest.main()
