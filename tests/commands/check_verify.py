"""A finished run that was altered is found out, and what a run writes goes nowhere else.

usage: check_verify.py ROULEAU SCENE [--no-whole-runs]
SCENE: with cells and walls. Python's standard library only.
"""

import json
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, SCENE = (Path(a).resolve() for a in sys.argv[1:3])
SEED = int.from_bytes(os.urandom(4), "little")
CHANCE = random.Random(SEED)
STEPS = ["--max-steps", "40", "--quiet"]
TIMES = 3 if "--no-whole-runs" in sys.argv else 12  # that a bit is changed, in each file


def rouleau(*words, **more):
    return subprocess.run([PROGRAM, *words], capture_output=True, text=True, timeout=300, **more)


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.run_directory = self.path / "run"

    def run_scene(self, *words, directory=None, **more):
        return rouleau("run", SCENE, "--out", directory or self.run_directory, *STEPS, *words, **more)


class An_altered_run(Case):
    def setUp(self):
        super().setUp()
        self.assertEqual(self.run_scene().returncode, 0)

    def assert_found(self, name, what):
        end = rouleau("verify", self.run_directory)
        self.assertEqual(end.returncode, 1, f"{what} of {name}, seed {SEED}\n{end.stdout}{end.stderr}")
        self.assertIn(name, [line.split(" ")[0] for line in end.stdout.splitlines()], what)
        if name != "summary.json":  # whose bytes are what the others are compared with
            self.assertEqual(len(end.stdout.splitlines()), 1, what)

    def test_is_found_whichever_file_is_changed_and_however(self):
        end = rouleau("verify", self.run_directory)
        self.assertEqual((end.returncode, end.stderr), (0, ""), end.stdout)
        names = sorted(json.loads((self.run_directory / "summary.json").read_text())["files"])
        there = {file.name for file in self.run_directory.iterdir()}
        self.assertEqual(there - set(names), {"summary.json", "report.html"})
        for name in [*names, "summary.json"]:
            file = self.run_directory / name
            whole = file.read_bytes()

            def bit(data):
                at = CHANCE.randrange(len(data))
                data[at] ^= 1 << CHANCE.randrange(8)
                return data

            def exchanged(data):
                at = CHANCE.randrange(len(data) - 1)
                while data[at] == data[at + 1]:
                    at = (at + 1) % (len(data) - 1)
                data[at], data[at + 1] = data[at + 1], data[at]
                return data

            changes = {"a bit": bit, "two bytes in the wrong order": exchanged,
                       "a cut": lambda data: data[:CHANCE.randrange(len(data))], "nothing left": lambda data: b"",
                       "a byte more": lambda data: data + b"\n"}
            for what, change in changes.items():
                for _ in range(TIMES if change in (bit, exchanged) else 1):
                    file.write_bytes(change(bytearray(whole)))
                    if name == "summary.json" and "files" not in file.read_text(errors="replace"):
                        self.assertNotEqual(rouleau("verify", self.run_directory).returncode, 0)
                        continue
                    if name == "summary.json" and rouleau("verify", self.run_directory).returncode == 2:
                        continue  # its checksum's name is what was hit: it says that there is none
                    self.assert_found(name, what)
            file.unlink()
            end = rouleau("verify", self.run_directory)
            self.assertEqual(end.returncode, 2 if name == "summary.json" else 1)
            self.assertIn(name, end.stdout + end.stderr)
            file.write_bytes(whole)
        self.assertEqual(rouleau("verify", self.run_directory).returncode, 0)

    def test_is_mentioned_by_its_report(self):
        for name in ("series.csv", "cells.csv"):
            file = self.run_directory / name
            whole = file.read_bytes()
            digit = whole.index(b",", whole.index(b"\n")) + 1
            self.assertTrue(whole[digit:digit + 1].isdigit())
            file.write_bytes(whole[:digit] + (b"7" if whole[digit:digit + 1] != b"7" else b"3") + whole[digit + 1:])
            end = rouleau("report", self.run_directory)
            self.assertEqual(end.returncode, 0)
            self.assertIn(name + " was changed", end.stderr)
            self.assertIn(name + " was changed", (self.run_directory / "report.html").read_text())
            file.write_bytes(whole)

    def test_that_went_on_is_sealed_again(self):
        end = rouleau("run", SCENE, "--out", self.run_directory, "--resume", "--force", "--max-steps", "60", "--quiet")
        self.assertEqual(end.returncode, 0, end.stderr)
        self.assertEqual(rouleau("verify", self.run_directory).returncode, 0)

    def test_without_a_summary_or_without_checksums_is_no_finished_run(self):
        summary = self.run_directory / "summary.json"
        content = json.loads(summary.read_text())
        del content["files"], content["summary_xxh3"]
        summary.write_text(json.dumps(content))
        end = rouleau("verify", self.run_directory)
        self.assertEqual(end.returncode, 2)
        self.assertIn("no checksums", end.stderr)


class A_run_writes_only_its_own_files(Case):
    """Links that somebody has put where a run writes."""

    def outside(self):
        file = self.path / "outside"
        file.write_text("not the run's\n")
        return file

    def test_when_it_replaces_another(self):
        self.assertEqual(self.run_scene().returncode, 0)
        names = [file.name for file in self.run_directory.iterdir()]
        for name in names:
            outside = self.outside()
            (self.run_directory / name).unlink(missing_ok=True)
            (self.run_directory / name).symlink_to(outside)
            end = self.run_scene("--overwrite")
            self.assertEqual(outside.read_text(), "not the run's\n", name)
            self.assertEqual(end.returncode, 0, name + end.stderr)

    def test_when_it_goes_on(self):
        self.assertEqual(self.run_scene().returncode, 0)
        for name in ("cells.csv", "series.csv", "aggregates.csv", "aggregate_sizes.csv", "log.jsonl"):
            copy = self.path / ("copy-" + name)
            shutil.copytree(self.run_directory, copy)
            outside = self.path / "outside"
            shutil.copy(copy / name, outside)
            before = outside.read_bytes()
            (copy / name).unlink()
            (copy / name).symlink_to(outside)
            end = rouleau("run", SCENE, "--out", copy, "--resume", "--force", "--max-steps", "60", "--quiet")
            self.assertEqual(outside.read_bytes(), before, name)
            self.assertEqual(end.returncode, 4, end.stderr)
            self.assertIn("it is a link", end.stderr)

    def test_and_none_beside_another_run_even_when_the_log_is_gone(self):
        long = subprocess.Popen([PROGRAM, "run", SCENE, "--out", self.run_directory, "--quiet"],
                                stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            while not (self.run_directory / "series.csv").exists():
                time.sleep(0.01)
            (self.run_directory / "log.jsonl").unlink()
            for more in (["--overwrite"], ["--resume"], []):
                end = self.run_scene(*more)
                self.assertEqual(end.returncode, 2, end.stderr)
                self.assertIn("another run is writing", end.stderr)
        finally:
            long.kill()
            long.wait()


class Instruction_sets(Case):
    def with_set(self, name):
        return {"env": {**os.environ, "ROULEAU_INSTRUCTION_SET": name}}

    def test_that_there_are_not_are_refused(self):
        for name in ("nonsense", "AVX2"):
            end = self.run_scene(**self.with_set(name))
            self.assertEqual(end.returncode, 2, name)
            self.assertIn("ROULEAU_INSTRUCTION_SET", end.stderr)

    def test_that_differ_from_the_checkpoints_are_named(self):
        self.assertEqual(self.run_scene().returncode, 0)
        used = json.loads((self.run_directory / "summary.json").read_text())["instruction_set"]
        if used == "baseline":
            self.skipTest("this processor has one instruction set")
        more = ["run", SCENE, "--out", self.run_directory, "--resume", "--max-steps", "60", "--quiet"]
        end = rouleau(*more, **self.with_set("baseline"))
        self.assertEqual(end.returncode, 2, end.stderr)
        self.assertIn(f"instruction set: {used} in the checkpoint, baseline now", end.stderr)
        self.assertEqual(rouleau(*more, "--force", **self.with_set("baseline")).returncode, 0)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *(word for word in sys.argv[3:] if word != "--no-whole-runs")])
