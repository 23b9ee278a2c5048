"""The command rouleau study: what it runs, keeps and leaves out, and how it goes on. Python's standard library only.

usage: check_study.py ROULEAU SOURCE_FOLDER
"""

import csv
import fcntl
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SOURCE = (Path(a).resolve() for a in sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "python"))
sys.dont_write_bytecode = True

import rouleau  # noqa: E402


SCENE = {
    "rouleau": 1,
    "domain": {"size": ["4 um", "8 um"], "nodes": [8, 16], "x": "periodic",
               "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "inertia": False, "collision": {"model": "trt"}},
    "numerics": {"tau": 1.0},
    "stages": [{"name": "start", "shear_rate": "100 1/s", "duration": "10 us"}],
    "output": {"fields": {"seconds": "10 us", "quantities": ["velocity"]}, "checkpoint": "never"},
}
ROWS = {"name": "rows", "refine": [1, 2]}
TAU = {"name": "tau", "pointer": "/numerics/tau", "values": [1, 0.8]}
ERROR = {"name": "velocity", "kind": "velocity_l2", "flow": "couette", "steady": False}
LONG = "8 ms"  # some seconds


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.out = self.path / "out"
        self.lock = self.path / "timing.lock"
        self.environment = {**os.environ, "ROULEAU_TIMING_LOCK": str(self.lock)}

    def study(self, matrix, scene=SCENE, **keys):
        study = {"rouleau_study": 1, "scene": scene, "matrix": matrix, "quantities": [ERROR], "repeats": 1,
                 "warm_up": False, **keys}
        file = self.path / "study.json"
        file.write_text(json.dumps(study))
        return file

    def command(self, file, *arguments):
        return [str(PROGRAM), "study", str(file), "--out", str(self.out), *arguments]

    def run_study(self, file, *arguments, code=0):
        result = subprocess.run(self.command(file, *arguments), capture_output=True, text=True, timeout=120,
                                env=self.environment)
        self.assertEqual(result.returncode, code, result.stderr)
        return result

    def start(self, file, *arguments):
        process = subprocess.Popen(self.command(file, *arguments), stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                                   text=True, env=self.environment)
        self.addCleanup(process.stdout.close)
        self.addCleanup(process.stderr.close)
        self.addCleanup(process.wait)
        self.addCleanup(process.kill)
        return process

    def result(self):
        return json.loads((self.out / "study.json").read_text())

    def finished(self):
        """When each finished run was written, by its directory."""
        return {p.parent.name: p.stat().st_mtime_ns for p in self.out.glob("points/*/summary.json")
                if not p.parent.name.endswith(".running")}

    def wait_for(self, condition, what):
        for _ in range(600):
            if condition():
                return
            time.sleep(0.05)
        self.fail("waited in vain: " + what)

    def running(self):
        """Command lines of processes that write into this test's directory."""
        lines = []
        for file in Path("/proc").glob("[0-9]*/cmdline"):
            try:
                line = file.read_bytes().replace(b"\0", b" ").decode()
                zombie = (file.parent / "stat").read_text().rsplit(")", 1)[1].split()[0] == "Z"
            except OSError:
                continue
            if str(self.out) in line and not zombie:
                lines.append(line)
        return lines


class A_study_runs_every_point(Case):
    def test_and_tells_what_each_cost(self):
        result = self.run_study(self.study([ROWS, TAU], title="Couette", repeats=3, warm_up=True))
        self.assertIn("4 of 4 points left", result.stderr)
        self.assertIn(str(self.out / "study.html"), result.stdout)
        self.assertIn("Couette", (self.out / "study.html").read_text())
        study = self.result()
        self.assertTrue(study["complete"])
        self.assertEqual(study["left_out"], [])
        self.assertEqual([p["id"] for p in study["points"]], [0, 1, 2, 3])
        self.assertEqual([p["labels"] for p in study["points"]],
                         [{"rows": r, "tau": t} for r in ("16", "32") for t in ("1", "0.8")])
        self.assertEqual(study["axes"][0]["positions"], [16, 32])
        self.assertEqual((study["line"], study["default"]), ("rows", {"rows": "16", "tau": "1"}))
        for point in study["points"]:
            self.assertEqual(point["status"], "completed")
            for times in (point["wall_s"], point["cpu_s"]):
                self.assertEqual(len(times["all"]), 3)
                self.assertEqual(times["median"], sorted(times["all"])[1])
                self.assertEqual((times["least"], times["most"]), (min(times["all"]), max(times["all"])))
            self.assertGreater(point["peak_rss_bytes"], 1e6)
            summary = rouleau.open(self.out / point["directory"]).summary
            self.assertEqual(point["steps"], summary.steps)
            self.assertEqual([p["name"] for p in point["passes"]], [p.name for p in summary.passes])
        # 10 us over (tau - 1/2)/3 dx^2/nu.
        self.assertEqual([p["steps"] for p in study["points"]], [288, 480, 1152, 1920])
        with open(self.out / "study.csv", newline="") as file:
            rows = list(csv.DictReader(file))
        self.assertEqual([(r["rows"], r["tau"], r["status"], r["runs"]) for r in rows],
                         [(r, t, "completed", "3") for r in ("16", "32") for t in ("1", "0.8")])

    def test_of_a_scene_in_a_file_of_its_own(self):
        (self.path / "scenes").mkdir()
        (self.path / "scenes/couette.json").write_text(json.dumps(SCENE))
        self.run_study(self.study([TAU], scene="scenes/couette.json", set={"/stages/0/duration": "5 us"}))
        self.assertEqual([p["steps"] for p in self.result()["points"]], [144, 240])

    def test_against_flows_that_are_exact_in_three_dimensions(self):
        between = {"lower": {"wall": {}}, "upper": {"wall": {}}}
        pressure, shear = {"pressure_gradient": "1e4 Pa/m"}, {"shear_rate": "100 1/s"}
        for name, domain, stage, flow, steady, most in [
                ("start in a tube", {"walls": {"tube": {"radius": "4 um"}}}, pressure, "poiseuille", False, 0.012),
                ("tube", {"walls": {"tube": {"radius": "4 um"}}}, {**pressure, "start": "developed"}, "poiseuille", True, 0.002),
                ("duct", {"y": between, "z": between}, {**pressure, "start": "developed"}, "poiseuille", True, 0.001),
                ("duct that is sheared", {"y": between, "z": between}, {**shear, "start": "developed"}, "couette", True, 0.006),
                ("start between walls", {"y": between}, shear, "couette", False, 0.001)]:
            with self.subTest(name):
                self.out = self.path / name.replace(" ", "-")
                scene = {**SCENE, "domain": {"size": ["2 um", "8 um", "8 um"], "nodes": [4, 16, 16], **domain},
                         "numerics": {"tau": 1.0, "density_factor": 1000},
                         "stages": [{"name": "flow", "duration": "2 ms", **stage}],
                         "output": {"fields": {"seconds": "2 ms", "quantities": ["velocity"], "precision": "f64"},
                                    "checkpoint": "never"}}
                self.run_study(self.study([ROWS], scene, quantities=[{**ERROR, "flow": flow, "steady": steady}]))
                coarse, fine = (point["results"]["velocity"]["value"] for point in self.result()["points"])
                self.assertLess(coarse, most)
                self.assertLess(fine, 0.6 * coarse)
                print(f"{name}: errors {coarse:.3g}, {fine:.3g}")

    def test_of_cells_in_three_dimensions_lattice_and_membranes_apart(self):
        scene = {**SCENE, "domain": {"size": ["8 um", "8 um", "8 um"], "nodes": [16, 16, 16], "y": SCENE["domain"]["y"]},
                 "numerics": {"density_factor": 300},
                 "cell_types": {"ball": {"shape": {"sphere": {"radius": "2 um"}}, "triangles": 320, "membrane": [
                     {"model": "neo-hookean", "parameters": {"shear_modulus": "5e-6 N/m"}}]}},
                 "cells": [{"type": "ball", "at": ["4 um", "5 um", "4 um"]}],
                 "stages": [{"name": "shear", "shear_rate": "100 1/s", "strain": 0.2, "start": "developed"}],
                 "output": {"cells": {"strain": 0.05}, "checkpoint": "never"}}
        matrix = [{"name": "radius", "refine": [0.75, 1, 1.5], "of": "lattice"},
                  {"name": "triangles", "refine": [0.5, 1], "of": "membranes"}]
        self.run_study(self.study(matrix, scene, quantities=[
            {"name": "D", "kind": "deformation"}, {"name": "speed", "kind": "speed"},
            {"name": "viscosity", "kind": "relative_viscosity", "intrinsic": True}]))
        study = self.result()
        self.assertEqual([tuple(p["labels"].values()) for p in study["points"]],
                         [(radius, triangles) for radius in ("3", "4", "6") for triangles in ("80", "320")])
        for point in study["points"]:
            self.assertEqual({q: r["why_not"] for q, r in point["results"].items() if r["value"] is None}, {})
            self.assertAlmostEqual(point["results"]["speed"]["value"], 1e-4, delta=2e-5)  # 1 um above the middle
        self.assertEqual((study["line"], study["default"]), ("radius", {"radius": "4", "triangles": "320"}))

    def test_on_the_threads_that_an_axis_names(self):
        self.run_study(self.study([{"name": "threads", "threads": [1, 2]}]))
        points = self.result()["points"]
        self.assertEqual([p["threads"] for p in points], [1, 2])
        self.assertEqual([rouleau.open(self.out / p["directory"]).summary.threads for p in points], [1, 2])


class Failing_points_are_results(Case):
    def test_that_diverge_are_refused_or_take_too_long(self):
        scenes = {"sound": {}, "fast": {"/stages/0/shear_rate": "1e7 1/s", "/checks": {"every_steps": 1}},
                  "impossible": {"/numerics/tau": 0.3}, "endless": {"/stages/0/duration": "1000 s"}}
        self.run_study(self.study([{"name": "case", "settings": scenes}], time_limit="1 s"))
        points = {p["labels"]["case"]: p for p in self.result()["points"]}
        self.assertEqual({name: p["status"] for name, p in points.items()},
                         {"sound": "completed", "fast": "diverged", "impossible": "refused", "endless": "timed_out"})
        self.assertIsNone(points["sound"]["failure"])
        self.assertEqual(points["fast"]["failure"]["reason"], "mach")
        self.assertEqual(points["fast"]["failure"]["step"], points["fast"]["steps"])
        self.assertIn("/numerics/tau", points["impossible"]["failure"]["message"])
        self.assertIn("1 s", points["endless"]["failure"]["message"])
        self.assertTrue(self.result()["complete"])
        before = self.finished()
        self.run_study(self.study([{"name": "case", "settings": scenes}], time_limit="1 s"))
        self.assertEqual(self.finished(), before)  # failures are kept, too

    def test_that_crash_do_not_end_the_study(self):
        process = self.start(self.study([TAU], scene={**SCENE, "stages": [{**SCENE["stages"][0], "duration": LONG}]}))
        self.wait_for(lambda: list(self.out.glob("points/*.running/summary.json")) or
                      list(self.out.glob("points/*.running/log.jsonl")), "the first run")
        (child,) = Path(f"/proc/{process.pid}/task/{process.pid}/children").read_text().split()
        os.kill(int(child), signal.SIGSEGV)
        process.communicate(timeout=120)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(sorted(p["status"] for p in self.result()["points"]), ["completed", "crashed"])
        (crashed,) = (p for p in self.result()["points"] if p["status"] == "crashed")
        self.assertIn("signal 11", crashed["failure"]["message"])


class A_study_goes_on(Case):
    MATRIX = [{"name": "tau", "pointer": "/numerics/tau", "values": [2, 1.5, 1, 0.8]}]
    SLOW = {**SCENE, "stages": [{**SCENE["stages"][0], "duration": LONG}]}

    def end_by(self, signal_number):
        """Ends the study by a signal within its second point or later; its exit code and what was finished by then."""
        process = self.start(self.study(self.MATRIX, scene=self.SLOW))
        self.wait_for(self.finished, "the first point")
        self.wait_for(lambda: list(self.out.glob("points/*.running")), "the next run")
        process.send_signal(signal_number)
        process.communicate(timeout=60)
        self.wait_for(lambda: not self.running(), "the end of the child")
        return process.returncode, self.finished()

    def goes_on(self, finished):
        self.assertGreaterEqual(len(finished), 1)
        self.assertLess(len(finished), 4)
        study = self.result()
        self.assertFalse(study["complete"])
        self.assertIsNone(study["finished"])
        self.assertEqual(len(study["points"]) + len(study["left_out"]), 4)
        result = self.run_study(self.study(self.MATRIX, scene=self.SLOW))
        self.assertIn(f"{len(finished)} of 4 points have been run before", result.stderr)
        after = self.finished()
        self.assertEqual(len(after), 4)
        self.assertEqual({name: after[name] for name in finished}, finished)
        self.assertTrue(self.result()["complete"])
        self.assertEqual(list(self.out.glob("points/*.running")), [])

    def test_after_it_was_killed(self):
        code, finished = self.end_by(signal.SIGKILL)
        self.assertEqual(code, -signal.SIGKILL)
        self.goes_on(finished)

    def test_after_it_was_interrupted(self):
        code, finished = self.end_by(signal.SIGINT)
        self.assertEqual(code, 130)
        self.goes_on(finished)

    def test_and_ends_in_words_when_its_program_is_replaced(self):
        program = self.path / "prefix/bin" / PROGRAM.name
        program.parent.mkdir(parents=True)
        shutil.copy2(PROGRAM, program)
        for folder in ("lib", "share"):
            (program.parent.parent / folder).symlink_to(PROGRAM.parent.parent / folder)
        command = self.command(self.study(self.MATRIX, scene=self.SLOW))
        process = subprocess.Popen([str(program), *command[1:]], stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                   text=True, env=self.environment)
        self.addCleanup(process.kill)
        self.wait_for(lambda: list(self.out.glob("points/*.running")), "the first run")
        copy = program.with_name("new")
        shutil.copy2(program, copy)
        copy.replace(program)
        _, words = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 4, words)
        self.assertIn(f"the program {program} was replaced or removed meanwhile\n  call the same command again", words)

    def test_with_more_values_and_more_repeats(self):
        self.run_study(self.study([TAU]))
        before = self.finished()
        self.run_study(self.study([{**TAU, "values": [1, 0.8, 2]}]), "--repeats", "2")
        self.assertEqual({name: self.finished()[name] for name in before}, before)
        self.assertEqual([len(p["wall_s"]["all"]) for p in self.result()["points"]], [2, 2, 2])

    def test_but_runs_again_what_has_changed(self):
        self.run_study(self.study([TAU]))
        changed = {**SCENE, "fluid": {**SCENE["fluid"], "viscosity": "1.3 cP"}}
        self.run_study(self.study([TAU], scene=changed))
        self.assertEqual(len(self.finished()), 4)


class A_budget_chooses_the_points(Case):
    def test_cheapest_first_and_lists_what_it_left_out(self):
        matrix = [{"name": "time", "pointer": "/stages/0/duration", "values": ["100 s", "10 us", "20 us"]}]
        begin = time.monotonic()
        result = self.run_study(self.study(matrix), "--budget", "5s")
        self.assertLess(time.monotonic() - begin, 20)
        study = self.result()
        self.assertEqual([p["labels"]["time"] for p in study["points"]], ["10 us", "20 us"])
        self.assertEqual([p["labels"]["time"] for p in study["left_out"]], ["100 s"])
        self.assertIn("of the budget were left", study["left_out"][0]["why"])
        self.assertGreater(study["left_out"][0]["estimated_s"], 5)
        self.assertFalse(study["complete"])
        self.assertIn("left out: time 100 s", result.stderr)

    def test_that_is_no_time_is_refused(self):
        for budget in ("soon", "-1 s", "5 m", ""):
            with self.subTest(budget):
                result = self.run_study(self.study([TAU]), "--budget=" + budget, code=2)
                self.assertIn("--budget", result.stderr)


class Timed_runs_take_turns(Case):
    def test_and_a_study_that_waits_says_so(self):
        with open(self.lock, "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            process = self.start(self.study([TAU]))
            line = ""
            while "waiting" not in line:
                line = process.stderr.readline()
                self.assertNotEqual(line, "", "the study ended")
            time.sleep(0.3)
            self.assertIsNone(process.poll())
            self.assertEqual(self.finished(), {})
        process.communicate(timeout=60)
        self.assertEqual(process.returncode, 0)
        self.assertEqual(len(self.finished()), 2)

    def test_and_two_studies_do_not_share_a_directory(self):
        with open(self.lock, "w") as lock:
            fcntl.flock(lock, fcntl.LOCK_EX)
            file = self.study([TAU])
            process = self.start(file)
            self.wait_for(lambda: (self.out / "study.json").exists(), "study.json")
            self.assertIn("another study is writing into", self.run_study(file, code=2).stderr)
            process.send_signal(signal.SIGINT)
            process.communicate(timeout=60)
            self.assertEqual(process.returncode, 130)


class Bad_input_is_refused_at_its_place(Case):
    def refused(self, *words, matrix=(TAU,), **keys):
        result = self.run_study(self.study(list(matrix), **keys), code=2)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertFalse(self.out.exists())

    def test_in_the_study(self):
        self.refused("/repeat", "repeats", repeat=3)
        self.refused("/line", '"row" is no axis of the matrix', "tau", line="row")
        self.refused("/default/tau", '"3" is no label of this axis', "1, 0.8", default={"tau": "3"})
        self.refused("/time_limit", '"10 mm"', time_limit="10 mm")
        self.refused("/matrix/0", "pointers", matrix=[{"name": "a", "values": [1]}])
        self.refused("/matrix/0/refine/0", "not whole", matrix=[{"name": "rows", "refine": [1.03]}])
        self.refused("/matrix/0\n  no setting of this axis makes a scene that can be run; the first: /numerics/taw\n  unknown key \"taw\"; did",
                     matrix=[{"name": "a", "pointer": "/numerics/taw", "values": [1, 2]}])

    def test_in_its_scene(self):
        self.refused("there is no scene", "nowhere.json", scene="nowhere.json")
        self.refused("/scene/numerics/tau\n  0.1 is out of range", scene={**SCENE, "numerics": {"tau": 0.1}})
        (self.path / "scene.json").write_text(json.dumps({**SCENE, "numerics": {"tau": 0.1}}))
        self.refused("scene.json:1:", "/numerics/tau", scene="scene.json")
        (self.path / "scene.json").write_text(json.dumps(SCENE))
        self.refused("/set\n  the scene with these changes is wrong, /numerics/tau: 0.1 is out of range", scene="scene.json", set={"/numerics/tau": 0.1})

    def test_in_the_directory(self):
        self.out.mkdir()
        (self.out / "letter.txt").write_text("dear")
        result = self.run_study(self.study([TAU]), code=2)
        self.assertIn("holds files that no study wrote", result.stderr)
        self.assertEqual([p.name for p in self.out.iterdir()], ["letter.txt"])


class Shipped_studies_are_right(unittest.TestCase):
    def test_and_help_names_one_that_is_there(self):
        result = subprocess.run([PROGRAM, "study", "--help"], capture_output=True, text=True, timeout=60)
        self.assertEqual(result.returncode, 0)
        examples = [word for word in result.stdout.split() if word.startswith("studies/")]
        self.assertGreater(len(examples), 0)
        for example in examples:
            self.assertTrue((SOURCE / example).exists(), example)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
