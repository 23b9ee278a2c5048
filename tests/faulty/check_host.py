"""Whatever a plugin does when it is loaded, made and called, `rouleau` ends with a sentence that names it and with code 3.

usage: check_host.py ROULEAU FOLDER SCENE [TEST...]
FOLDER holds the built plugins as CHECK/NAME/NAME.json. Python's standard library only.
"""

import copy
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import threading
import unittest
from pathlib import Path

PROGRAM, PLUGINS, SCENE = (Path(a).resolve() for a in sys.argv[1:4])

# Plugin: function in which it misbehaves, and words that say what it did.
WHEN_MADE = {
    "load/aborts": ("that runs when it is loaded", "stopped the program"),
    "load/writes-to-null": ("that runs when it is loaded", "memory that it does not have"),
    "load/exits": ("that runs when it is loaded", "ended the program"),
    "load/exits-in-order": ("that runs when it is loaded", "ended the program"),
    "load/flushes-denormals-on-load": ("that runs when it is loaded", "the floating-point mode"),
    "create/create-crashes": ("create", "memory that it does not have"),
    "create/create-exits": ("create", "ended the program"),
    "create/throws-an-int": ("create", "thrown an exception that is no std::exception"),
    "create/changes-directory": ("create", "the working directory"),
    "create/changes-mask": ("create", "the file mode mask"),
    "create/changes-locale": ("create", "the locale"),
    "create/changes-environment": ("create", "the environment"),
    "create/takes-a-signal": ("create", "the handler of signal 2"),
}
WHEN_CALLED = {
    "compute/compute-crashes": "memory that it does not have",
    "compute/collide-crashes": "memory that it does not have",
    "compute/compute-aborts": "stopped the program",
    "compute/compute-exits": "ended the program",
    "compute/compute-leaves": "ended the program",
    "compute/exhausts-the-stack": "too much of the stack",
    "compute/throws": "an exception: out of range",
}


class A_plugin_that_misbehaves(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        scene = json.loads(SCENE.read_text())
        scene["cells"][0]["row"]["count"] = 2
        self.scene = scene

    def rouleau(self, command, plugin, *more):
        name = Path(plugin).name
        scene = copy.deepcopy(self.scene)
        if name.startswith("collide"):
            scene["fluid"]["collision"] = {"model": name}
        else:
            scene["interactions"] = [{"between": ["rbc", "rbc"], "model": name, "parameters": {"stiffness": 1e5}}]
        (self.path / "scene.json").write_text(json.dumps(scene))
        return subprocess.run([PROGRAM, command, "scene.json", "--plugin-dir", PLUGINS / plugin, *more], cwd=self.path,
                              capture_output=True, text=True, timeout=120)

    def run_steps(self, plugin, *more):
        return self.rouleau("run", plugin, "--out", "out", "--max-steps", "20", "--quiet", *more)

    def assert_named(self, end, plugin, function, words):
        self.assertEqual(end.returncode, 3, end.stderr)
        for part in (f'the plugin "{Path(plugin).name}"', "in its function " + function, words):
            self.assertIn(part, end.stderr)

    def test_while_it_is_made_is_named(self):
        for plugin, (function, words) in WHEN_MADE.items():
            for call in (lambda p: self.rouleau("plan", p), self.run_steps):
                with self.subTest(plugin):
                    self.assert_named(call(plugin), plugin, function, words)
                    self.assertFalse((self.path / "out").exists(), "nothing has begun")

    def test_while_it_computes_is_named_whichever_thread_calls_it(self):
        for plugin, words in WHEN_CALLED.items():
            for threads in ("1", "2"):
                with self.subTest(plugin, threads=threads):
                    self.assert_named(self.run_steps(plugin, "--threads", threads, "--overwrite"), plugin,
                                      "collide" if "/collide" in plugin else "compute", words)

    def test_by_printing_spoils_no_output(self):
        end = self.rouleau("plan", "quiet/prints", "--json")
        self.assertEqual(end.returncode, 0, end.stderr)
        json.loads(end.stdout)
        ends = [self.run_steps("quiet/prints"), self.run_steps("honest/honest-potential", "--overwrite")]
        said = [re.sub(r" in .* MLUPS", "", end.stdout) for end in ends]
        self.assertEqual((ends[0].returncode, said[0]), (0, said[1]))

    def test_that_takes_the_place_of_a_locked_one_is_never_run(self):
        """A library that is exchanged all the time: what was hashed is what is loaded."""
        honest = self.path / "plugins" / "honest-potential"
        shutil.copytree(PLUGINS / "honest/honest-potential", honest)
        library = honest / "libhonest-potential.so"
        texts = [library.read_bytes(), (PLUGINS / "load/aborts/libaborts.so").read_bytes()]
        self.assertEqual(self.rouleau("plan", honest).returncode, 0)
        lock = subprocess.run([PROGRAM, "plugins", "--lock", "scene.json", "--plugin-dir", honest], cwd=self.path,
                              capture_output=True)
        self.assertEqual(lock.returncode, 0, lock.stderr)
        ended = threading.Event()

        def exchange():
            at = 0
            while not ended.is_set():
                at += 1
                if at % 4 < 2:
                    (self.path / "next").write_bytes(texts[at % 2])
                    os.replace(self.path / "next", library)
                else:
                    with library.open("r+b") as file:  # in its place, as a careless copy does
                        file.write(texts[at % 2])
                        file.truncate()

        thread = threading.Thread(target=exchange)
        thread.start()
        try:
            codes = []
            for _ in range(80):
                end = self.rouleau("plan", honest)
                codes.append(end.returncode)
                self.assertIn(end.returncode, (0, 3), end.stderr)
                if end.returncode == 3:
                    self.assertIn("is not the one that is locked", end.stderr)
        finally:
            ended.set()
            thread.join()
        self.assertEqual(set(codes), {0, 3}, "both were met")


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
