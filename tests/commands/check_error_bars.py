"""Error bars: when they are made, where they are said, and what becomes of them when something comes between.

usage: check_error_bars.py ROULEAU SCENE_FOLDER [--no-whole-runs]
SCENE_FOLDER: tests/physics/scenes. Python's standard library only.
"""

import json
import re
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, SCENES = (Path(a).resolve() for a in sys.argv[1:3])
whole_runs = unittest.skipIf("--no-whole-runs" in sys.argv, "slow")  # where the program is ten times slower
BAR = re.compile(r"^deformation [0-9.]+ \+- [0-9.]+$", re.M)


def rouleau(*words):
    return subprocess.run([PROGRAM, *map(str, words)], capture_output=True, text=True, timeout=300)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.run_directory = self.path / "run"

    def scene(self, name="capsule.json", strain=0.5, **numerics):
        scene = json.loads((SCENES / name).read_text())
        if name == "capsule.json":
            scene["domain"]["nodes"] = [128, 64]
            scene["cell_types"]["capsule"]["segments"] = 63
            scene["numerics"].update({"slip_correction": True, "area_correction": True, "density_factor": 6000, **numerics})
        scene["stages"][0]["strain"] = strain
        scene["output"] = {"cells": {"strain": 0.25}, "checkpoint": "never"}
        file = self.path / "scene.json"
        file.write_text(json.dumps(scene))
        return file

    def summary(self):
        return json.loads((self.run_directory / "summary.json").read_text())

    def tables(self):
        return {file.name: file.read_bytes() for file in self.run_directory.glob("*.csv")}

    def interrupt_error_bars(self, scene):
        """What the program says after Ctrl-C during its first companion, and its exit code."""
        process = subprocess.Popen([PROGRAM, "run", scene, "--out", self.run_directory, "--overwrite", "--error-bar"],
                                   stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
        for line in process.stderr:
            if line.startswith("error bar: "):
                break
        process.send_signal(signal.SIGINT)
        return process.communicate(timeout=60)[1], process.returncode

    def assert_whole(self, result):
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertRegex(result.stdout, BAR)
        summary = self.summary()
        for name, bar in summary["error_bars"].items():
            self.assertEqual(set(bar), {"value", "error", "how"}, name)
            self.assertTrue(bar["how"], name)
        self.assertGreater(summary["error_bars"]["deformation"]["error"], 0)
        self.assertEqual(rouleau("verify", self.run_directory).returncode, 0)
        self.assertFalse((self.run_directory / "error-bar").exists())
        return summary


class Error_bars(Case):
    def test_are_told_on_the_terminal_in_the_summary_and_in_the_report_and_change_no_table(self):
        scene = self.scene()
        plain = rouleau("run", scene, "--out", self.run_directory, "--quiet")
        self.assertNotIn("+-", plain.stdout)
        self.assertNotIn("error_bars", self.summary())
        tables = self.tables()
        summary = self.assert_whole(rouleau("run", scene, "--out", self.run_directory, "--overwrite", "--quiet", "--error-bar"))
        self.assertEqual(self.tables(), tables)
        self.assertEqual([run["role"] for run in summary["error_bar_runs"]["companions"]], ["lattice", "order", "inertia"])
        self.assertIn(summary["error_bars"]["deformation"]["how"], (self.run_directory / "report.html").read_text())

    @whole_runs
    def test_come_by_themselves_where_numerics_are_chosen_unless_they_are_refused(self):
        scene = self.scene("auto-capsule.json", strain=1)
        summary = self.assert_whole(rouleau("run", scene, "--out", self.run_directory, "--quiet"))
        choice = summary["numerics_choice"]
        self.assertGreater(choice["measured_error"], 0)
        self.assertIn(choice["measured_of"], summary["error_bars"])
        refused = rouleau("run", scene, "--out", self.run_directory, "--overwrite", "--quiet", "--no-error-bar")
        self.assertEqual(refused.returncode, 0, refused.stderr)
        self.assertNotIn("error_bars", self.summary())

    @whole_runs
    def test_that_miss_the_target_are_followed_by_a_finer_run_and_the_first_run_stays(self):
        # A strain of 1.5 is in the middle of the start, which the density of auto's motion delays by far more than it expects.
        command = ("run", self.scene("auto-capsule.json", strain=1.5), "--out", self.run_directory, "--quiet",
                   "--set", '/numerics={"auto": {"error": 0.05}}')
        told = rouleau(*command)
        self.assertEqual(told.returncode, 0, told.stderr)
        self.assertIn("numerics.auto has missed its target", told.stdout)
        self.assertIn("a finer run follows in " + str(self.run_directory / "refined"), told.stdout)
        finer = self.run_directory / "refined" / "summary.json"
        first, second = self.summary(), json.loads(finer.read_text())
        self.assertGreater(second["steps"], first["steps"])
        self.assertLess(second["numerics_choice"]["measured_error"], first["numerics_choice"]["measured_error"])
        for folder in (self.run_directory, finer.parent):
            self.assertEqual(rouleau("verify", folder).returncode, 0)
        written = finer.read_bytes()
        self.assertEqual(rouleau(*command, "--resume").returncode, 0)
        self.assertEqual(finer.read_bytes(), written)
        self.assertEqual(rouleau(*command, "--overwrite", "--no-error-bar").returncode, 0)
        self.assertFalse(finer.parent.exists())

    def test_of_a_target_for_which_there_is_no_time_are_said_before_the_run(self):
        told = rouleau("run", self.scene("auto-capsule.json", strain=1000), "--out", self.run_directory, "--quiet",
                       "--max-time", "0.2s")
        self.assertEqual(told.returncode, 130, told.stderr)
        self.assertLess(told.stderr.index("warning: numerics.auto"), told.stderr.index("ended by --max-time"))
        self.assertIn("more than --max-time", told.stderr)

    def test_cannot_be_wanted_and_refused(self):
        result = rouleau("run", self.scene(), "--error-bar", "--no-error-bar")
        self.assertEqual(result.returncode, 2)
        self.assertIn("give one of them", result.stderr)

    @whole_runs
    def test_are_added_to_a_run_that_has_ended_without_them(self):
        scene = self.scene()
        rouleau("run", scene, "--out", self.run_directory, "--quiet")
        tables, steps = self.tables(), self.summary()["steps"]
        summary = self.assert_whole(rouleau("run", scene, "--out", self.run_directory, "--quiet", "--resume", "--error-bar"))
        self.assertEqual((self.tables(), summary["steps"]), (tables, steps))

    @whole_runs
    def test_that_an_interruption_has_cut_off_are_missing_and_come_with_the_next_command(self):
        for strain in (40, 160, 640):  # on a busy machine the shorter ones may be whole before the signal comes
            told, code = self.interrupt_error_bars(self.scene(strain=strain, density_factor=1500))
            if code != 0:
                break
        self.assertEqual(code, 130, told)
        self.assertIn("the run is whole, its error bars are missing", told)
        command = told.split("to add them: ")[1].splitlines()[0]
        self.assertNotIn("error_bars", self.summary())
        self.assertEqual(self.summary()["status"], "completed")
        self.assertEqual(rouleau("verify", self.run_directory).returncode, 0)
        self.assert_whole(rouleau(*command.split()[1:], "--quiet"))

    def test_of_a_run_that_was_cut_short_are_not_made_and_that_is_said(self):
        result = rouleau("run", self.scene(), "--out", self.run_directory, "--quiet", "--error-bar", "--max-steps", "20")
        self.assertEqual(result.returncode, 0)
        self.assertIn("no error bars: the run has not come to its end", result.stdout)

    def test_that_cannot_be_measured_are_null_and_say_why(self):
        scene = self.scene()
        changed = json.loads(scene.read_text())
        changed["domain"].update(size=["50.8 um", "25.6 um"], nodes=[127, 64])
        scene.write_text(json.dumps(changed))
        result = rouleau("run", scene, "--out", self.run_directory, "--quiet", "--error-bar")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("no error bars: no coarser lattice has the shape of 127 x 64 nodes", result.stdout)
        bar = self.summary()["error_bars"]["deformation"]
        self.assertIsNone(bar["error"])
        self.assertIn("127 x 64", bar["how"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
