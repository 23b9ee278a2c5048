"""What a run that failed advises ends the failure: runs fail, the remedy that they print is applied, word by word, and
the same runs must pass the place. Python's standard library only.

usage: check_remedies.py ROULEAU SOURCE_FOLDER [--all]

--all: every point of attraction of limits/adhesion.json and adhesion-at-rest.json that fails (five core-minutes)
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
    first = re.split(r", or |, so far", remedy)[0]
    changed = copy.deepcopy(scene)
    rest = first
    for pattern, change in WAYS:
        for words in re.finditer(pattern, first):
            change(changed, *words.groups())
            rest = rest.replace(words.group(), "")
    if re.search(r"\w{4}", re.sub(r"\(.*?\)", "", rest)):
        raise AssertionError(f"the remedy says more than was understood: {rest!r} of {remedy!r}")
    return changed


def with_limits(file, *changes):
    """The scene of a limits file, with its changes and these."""
    limits = json.loads((SOURCE / "limits" / file).read_text())
    scene = json.loads((SOURCE / "limits" / limits["scene"]).read_text())
    for pointer, value in [*limits.get("set", {}).items(), *changes]:
        put(scene, pointer, value)
    return scene, limits


class A_remedy_ends_its_failure(unittest.TestCase):
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
        shorter = scene["stages"][0]["density_factor"] / changed["stages"][0]["density_factor"] if failure["step"] else 1
        summary = self.run_scene(changed, None if ALL and failure["step"] else int(1.5 * failure["step"] * shorter) + 500)
        self.assertEqual(summary["status"], "completed", f"{name}: {failure['remedy']}: {summary.get('failure')}")

    def test_cells_that_attract_each_other_and_leak(self):
        for ratio in ("1.2 cP", "6 cP") if ALL else ("1.2 cP",):
            for depth in (1.8e-5, 5e-5, 1e-4) if ALL else (1.8e-5,):
                scene, limits = with_limits("adhesion.json", (DEPTH, f"{depth} J/m2"),
                                            (get(with_limits("adhesion.json")[1], "/matrix/0/pointer"), ratio))
                self.check(f"{depth} J/m2, {ratio}", scene, "area_drift", "area_correction")

    @unittest.skipUnless(ALL, "long")
    def test_pairs_at_rest_without_what_holds_them(self):
        for case in with_limits("adhesion-at-rest.json")[1]["cases"]:
            scene, _ = with_limits("adhesion-at-rest.json", *case["set"].items(),
                                   ("/numerics/slip_correction", False), ("/numerics/area_correction", False))
            del scene["interactions"][1]
            scene["stages"][0]["density_factor"] *= 4
            self.check(case["name"], scene, "area_drift", '["rbc", "self"]')

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
