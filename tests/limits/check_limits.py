"""The command rouleau limits: edges, bad files, and how it goes on. Python's standard library only.

usage: check_limits.py ROULEAU SOURCE_FOLDER
"""

import csv
import json
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SOURCE = (Path(a).resolve() for a in sys.argv[1:3])

MODULUS = "/cell_types/rbc/membrane/0/parameters/shear_modulus"
SCENE = {  # one cell in a small channel, set going by the walls
    "rouleau": 1,
    "domain": {"size": ["12.512 um", "12.512 um"], "nodes": [64, 64], "x": "periodic",
               "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "inertia": False},
    "numerics": {"tau": 1.0, "density_factor": 1000},
    "cell_types": {"rbc": {"shape": {"biconcave": {"radius": "3.91 um"}}, "segments": 100,
                           "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-6 N/m"}},
                                        {"model": "bending", "parameters": {"modulus": "3.6e-19 J"}}]}},
    "cells": [{"type": "rbc", "at": ["6.256 um", "6.256 um"]}],
    "stages": [{"name": "shear", "shear_rate": "20 1/s", "strain": 1}],
}
STIFFNESS = {"name": "shear modulus", "pointer": MODULUS, "from": "6e-5 N/m", "to": "6e-3 N/m", "precision": 1.3}


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.out = self.path / "out"

    def write(self, text=None, **keys):
        file = self.path / "limits.json"
        file.write_text(text or json.dumps({"rouleau_limits": 1, "scene": SCENE, "steps": 1000, **keys}))
        return file

    def command(self, file, *arguments):
        return [str(PROGRAM), "limits", str(file), "--out", str(self.out), *arguments]

    def run_limits(self, file, *arguments, code=0):
        result = subprocess.run(self.command(file, *arguments), capture_output=True, text=True, timeout=200)
        self.assertEqual(result.returncode, code, result.stderr + result.stdout)
        return result

    def found(self):
        return json.loads((self.out / "limits.json").read_text())


class Edges(Case):
    def test_the_edge_of_the_explicit_step_is_where_the_plan_says(self):
        """plan's limit of 3 Es in lattice units, 6.3 at tau 1, was measured with a cell at rest."""
        result = self.run_limits(self.write(parameter=STIFFNESS, matrix=[
            {"name": "coupling", "pointer": "/numerics/coupling", "values": ["explicit", "semi-implicit"]}]))
        limits = self.found()
        self.assertTrue(limits["complete"])
        explicit, other = limits["edges"]
        self.assertEqual(explicit["labels"], {"coupling": "explicit"})
        self.assertEqual(explicit["direction"], "above")
        self.assertLess(explicit["unstable_from"], 1.3 * explicit["stable_up_to"])
        lattice = 0.02263 / 6e-6  # rouleau plan: lattice value of the scene's own 6e-6 N/m
        self.assertLess(3 * lattice * explicit["stable_up_to"], 1.3 * 6.3)
        self.assertGreater(3 * lattice * explicit["unstable_from"], 6.3 / 1.3)
        failure = explicit["failure"]
        self.assertIn(failure["reason"], ("node_step", "mach"))
        self.assertGreater(failure["step"], 0)
        self.assertTrue(failure["remedy"])
        if other["stable_up_to"] is not None:
            self.assertGreater(other["stable_up_to"], explicit["stable_up_to"])
        self.assertEqual(explicit["trials"][0]["end"], "completed")
        self.assertIn("explicit: stable up to", result.stdout)
        rows = list(csv.DictReader((self.out / "limits.csv").read_text().splitlines()))
        self.assertEqual([row["coupling"] for row in rows], ["explicit", "semi-implicit"])
        self.assertEqual(float(rows[0]["stable_up_to"]), explicit["stable_up_to"])
        self.assertEqual(rows[0]["reason"], failure["reason"])

    def test_it_goes_on_where_it_was_ended_and_tries_nothing_twice(self):
        file = self.write(parameter={**STIFFNESS, "precision": 1.05}, steps=20000)
        process = subprocess.Popen(self.command(file), stderr=subprocess.PIPE, stdout=subprocess.DEVNULL, text=True)
        for line in process.stderr:
            if "stable" in line or "at step" in line:
                break
        process.send_signal(signal.SIGINT)
        with process.stderr:
            process.stderr.read()
        self.assertEqual(process.wait(60), 130)
        self.assertFalse(self.found()["complete"])
        file.write_text(json.dumps({**json.loads(file.read_text()), "parameter": STIFFNESS}))
        points = self.out / "points"
        before = {p: p.stat().st_mtime_ns for p in points.glob("*.json") if "scene" not in p.name}
        self.assertTrue(before)
        self.run_limits(file)
        self.assertTrue(self.found()["complete"])
        for point, when in before.items():
            self.assertEqual(point.stat().st_mtime_ns, when)
        everything = {p: p.stat().st_mtime_ns for p in points.rglob("*")}
        self.run_limits(file)
        self.assertEqual({p: p.stat().st_mtime_ns for p in points.rglob("*")}, everything)


class Cases(Case):
    """tests/stability/cases.py, which runs extreme cases by hand."""

    def judged(self, code, bounds=None, **case):
        file = self.write(cases=[{"name": "a", **case}], **(bounds or {}))
        words = [sys.executable, Path(__file__).resolve().parents[1] / "stability/cases.py", PROGRAM, file, "--out", self.out]
        done = subprocess.run(words, capture_output=True, text=True)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done.stdout

    def test_cases_end_right_or_with_a_reason(self):
        area = {"table": "cells", "column": "area_m2", "value": 1.362222e-11, "tolerance": 2e-14}  # its polygon lies within
        self.assertIn("a: right answer", self.judged(0, expect="right", answer=area))
        self.assertIn("stopped with a reason: node_step", self.judged(0, expect="stops", set={MODULUS: "6e-3 N/m"}))
        self.assertIn("stopped with a reason: refused", self.judged(0, expect="stops", set={"/cells/-": SCENE["cells"][0]}))

    def test_a_wrong_answer_and_a_hang_are_wrong(self):
        answer = {"table": "cells", "column": "area_m2", "value": 2e-11, "tolerance": 1e-13}
        self.assertIn("WRONG: area_m2 is", self.judged(1, answer=answer))
        self.assertIn("NOT AS EXPECTED", self.judged(1, expect="stops"))
        self.assertIn("stretch is", self.judged(1, bounds={"sound": {"stretch": 1.000001}}))
        self.assertIn("timed out", self.judged(1, {"time_limit": "0.5 s"}, steps=100000000, set={"/stages/0/strain": 1000}))


class BadFiles(Case):
    def refused(self, words, **keys):
        result = self.run_limits(self.write(**keys), code=2)
        self.assertRegex(result.stderr, r"limits\.json:\d+:\d+")
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(self.out.exists())

    def test_nothing_to_do(self):
        self.refused(["\"parameter\""])

    def test_unknown_key(self):
        self.refused(["/paramter", "did you mean \"parameter\""], paramter=STIFFNESS)

    def test_units_that_differ(self):
        self.refused(["/parameter/to", "same unit"], parameter={**STIFFNESS, "to": "6 dyn/cm"})

    def test_no_unit_at_all(self):
        self.refused(["/parameter/from", "6e-6 N/m"], parameter={**STIFFNESS, "from": "6e-5 N/n"})

    def test_range_upside_down(self):
        self.refused(["/parameter/to", "exchange"], parameter={**STIFFNESS, "to": "6e-6 N/m"})

    def test_logarithm_of_zero(self):
        self.refused(["/parameter/from", "linear"], parameter={**STIFFNESS, "from": "0 N/m"})

    def test_precision_without_meaning(self):
        self.refused(["/parameter/precision", "1.1"], parameter={**STIFFNESS, "precision": 1})

    def test_pointer_that_leads_nowhere(self):
        self.refused(["/parameter/pointer"], parameter={**STIFFNESS, "pointer": "/cells/7/at"})

    def test_no_pointer(self):
        self.refused(["/parameter", "pointer"], parameter={"name": "x", "from": 1, "to": 2})

    def test_both_pointers(self):
        self.refused(["leave one of them out"], parameter={**STIFFNESS, "pointers": [MODULUS]})

    def test_parameter_the_scene_has_not(self):
        self.refused(["/parameter/from\n  the scene with this value, /numerics/tow\n  unknown key \"tow\""], parameter={**STIFFNESS, "pointer": "/numerics/tow"})

    def test_scene_that_is_not_there(self):
        self.refused(["/scene", "there is no scene"], scene="none.json", parameter=STIFFNESS)

    def test_time_limit(self):
        self.refused(["/time_limit"], parameter=STIFFNESS, time_limit="2 um")

    def test_a_directory_of_something_else_is_left_alone(self):
        self.out.mkdir()
        (self.out / "precious.txt").write_text("precious")
        result = self.run_limits(self.write(parameter=STIFFNESS), code=2)
        self.assertIn("--out", result.stderr)
        self.assertEqual([p.name for p in self.out.iterdir()], ["precious.txt"])


class Shipped(unittest.TestCase):
    def test_kept_files_are_read_and_name_scenes_that_are_there(self):
        files = sorted((SOURCE / "limits").glob("*.json"))
        self.assertGreater(len(files), 1)
        for file in files:
            with self.subTest(file=file.name), tempfile.TemporaryDirectory() as folder:
                # Ended at once: what is wrong in the file is told before the first trial begins.
                process = subprocess.Popen([str(PROGRAM), "limits", str(file), "--out", folder + "/out"],
                                           stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
                for _ in range(600):
                    if (Path(folder) / "out/limits.json").exists() or process.poll() is not None:
                        break
                    time.sleep(0.05)
                process.send_signal(signal.SIGINT)
                with process.stderr:
                    words = process.stderr.read()
                self.assertIn(process.wait(60), (130, 0, 1), words)
                self.assertTrue((Path(folder) / "out/limits.json").exists(), words)


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], exit=False, verbosity=2)
    sys.exit(bool(program.result.failures or program.result.errors))
