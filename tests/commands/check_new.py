"""rouleau new, and models swapped on the command line. Python's standard library only.

usage: check_new.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER
"""

import json
import os
import re
import resource
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PLUGINS, SOURCE = (Path(a).resolve() for a in sys.argv[1:4])
SCENE = SOURCE / "scenes" / "four-cells-shear.json"
KINDS = ("collision", "membrane", "interaction")


def without_schema(file):
    """A shipped scene's text as `new` writes it: its schema is not where the shipped one's is."""
    return re.sub(r'\n *"\$schema": [^\n]*', "", file.read_text())


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name).resolve()
        self.desk = self.path / "desk"
        self.desk.mkdir()
        # An installation of its own: what lies beside the program decides what it prints.
        self.program = self.path / "rouleau here" / "bin" / "rouleau"
        self.program.parent.mkdir(parents=True)
        shutil.copy(PROGRAM, self.program)
        (self.path / "rouleau here/lib/rouleau").mkdir(parents=True)
        (self.path / "rouleau here/lib/rouleau/plugins").symlink_to(PLUGINS)
        shutil.copytree(SOURCE / "cells", self.path / "rouleau here/share/rouleau/cells")
        self.environment = {k: v for k, v in os.environ.items() if not k.startswith("ROULEAU_")}

    def call(self, *words, **options):
        return subprocess.run([self.program, *map(str, words)], capture_output=True, text=True, timeout=300,
                              cwd=self.desk, env=self.environment, **options)

    def new(self, *words):
        result = self.call("new", *words)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def assert_stops(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)
        self.assertEqual(result.stdout, "")


class New_makes_a_model(Case):
    def test_of_each_kind_with_three_files_named_after_the_last_part_of_the_id(self):
        for kind in KINDS:
            self.new(kind, f"org.example.my-{kind}")
            folder = self.desk / f"my-{kind}"
            self.assertEqual({f.name for f in folder.iterdir()}, {f"my-{kind}.cpp", f"my-{kind}.json", "CMakeLists.txt"})
            manifest = json.loads((folder / f"my-{kind}.json").read_text())
            self.assertEqual(manifest["id"], f"org.example.my-{kind}")
            self.assertEqual(manifest["kind"], kind)
            self.assertEqual(manifest["library"], f"libmy-{kind}.so")
            source = (folder / f"my-{kind}.cpp").read_text()
            self.assertRegex(source, rf"ROULEAU_{kind.upper()}\(My{kind.capitalize()}, \"org.example.my-{kind}\"")
            self.assertLess(len(source.splitlines()), 30)
            self.assertIn(f"rouleau_add_plugin(my-{kind})", (folder / "CMakeLists.txt").read_text())
            for file in folder.iterdir():
                self.assertIsNone(re.search("model-name|model-id|ModelType", file.read_text()), file)

    def test_whose_manifest_is_accepted_and_has_unit_default_and_limits_of_every_parameter(self):
        for kind in KINDS:
            self.new(kind, f"org.example.of-{kind}")
            result = self.call("plugins", f"org.example.of-{kind}", "--json", "--plugin-dir", self.desk)
            self.assertEqual(result.returncode, 0, result.stderr)
            for parameter in json.loads(result.stdout)["parameters"]:
                for key in ("unit", "default", "usual", "doc"):
                    self.assertIn(key, parameter)
                self.assertTrue({"minimum", "exclusiveMinimum"} & set(parameter))
            manifest = json.loads((self.desk / f"of-{kind}/of-{kind}.json").read_text())
            if kind != "collision":  # populations are arrays, which "checks" has no words for
                self.assertTrue(all("source" in check for check in manifest["checks"]))

    def test_from_the_files_of_the_sdk(self):
        self.new("membrane", "org.example.stiff")
        for suffix in (".cpp", ".json"):
            text = (SOURCE / f"sdk/template/membrane/model-name{suffix}").read_text()
            for mark, word in (("model-id", "org.example.stiff"), ("model-name", "stiff"), ("ModelType", "Stiff")):
                text = text.replace(mark, word)
            self.assertEqual((self.desk / f"stiff/stiff{suffix}").read_text(), text)

    def test_of_a_membrane_in_the_dimensions_that_are_asked_for(self):
        for word, dimensions in (("2", None), ("3", [3]), ("both", [2, 3])):
            words = self.new("membrane", f"org.example.of-{word}", "--dimensions", word)
            manifest = json.loads((self.desk / f"of-{word}/of-{word}.json").read_text())
            self.assertEqual(manifest.get("dimensions"), dimensions)
            self.assertEqual("/cell_types/capsule/" in words, word == "3")
            result = self.call("plugins", f"org.example.of-{word}", "--json", "--plugin-dir", self.desk)
            self.assertEqual(result.returncode, 0, result.stderr)
        self.assert_stops(self.call("new", "membrane", "m", "--dimensions", "4"), 2, "2, 3 or both", '"4"')
        self.assert_stops(self.call("new", "interaction", "m", "--dimensions", "3"), 2, "for membrane laws")

    def test_whose_type_does_not_hide_a_letter_of_the_formula(self):
        self.new("membrane", "e")
        self.assertIn("struct EModel {", (self.desk / "e/e.cpp").read_text())

    def test_in_another_folder_on_request(self):
        elsewhere = self.path / "else where"
        elsewhere.mkdir()
        words = self.new("interaction", "org.example.yukawa", "--dir", elsewhere)
        self.assertTrue((elsewhere / "yukawa/yukawa.cpp").exists())
        self.assertEqual(list(self.desk.iterdir()), [])
        self.assertEqual(shlex.split(re.search("cmake -S .*", words).group(0))[2], str(elsewhere / "yukawa"))

    def test_and_prints_the_commands_that_come_next_and_what_an_id_should_be(self):
        share = self.path / "rouleau here/share"
        words = self.new("interaction", "org.example.yukawa")
        self.assertIn("The SDK is not beside this program", words)
        self.assertNotIn("is a plain name", words)
        (share / "cmake/Rouleau").mkdir(parents=True)
        (share / "cmake/Rouleau/RouleauConfig.cmake").touch()
        shutil.copytree(SOURCE / "scenes", share / "rouleau/scenes")
        words = self.new("interaction", "stiff")
        self.assertIn("is a plain name", words)
        self.assertIn("org.example.stiff", words)
        commands = [shlex.split(line) for line in words.splitlines() if line.startswith("  ")]
        self.assertEqual([c[0] for c in commands], ["cmake", "cmake", "ctest", "rouleau"])
        self.assertIn(f"-DCMAKE_PREFIX_PATH={self.path / 'rouleau here'}", commands[0])
        self.assertEqual(commands[3][2], str(share / "rouleau/scenes/four-cells-shear.json"))
        self.assertEqual(commands[3][-1], "/interactions/0/model=stiff")


class Shipped_cells(Case):
    def test_are_listed_each_number_with_its_source(self):
        files = {file.stem: json.loads(file.read_text()) for file in (SOURCE / "cells").glob("*.json")}
        words = self.call("plugins", "--cells").stdout
        for name, cell in files.items():
            self.assertIn(name, words)
            self.assertIn(cell["title"][:30], words)
            one = self.call("plugins", "--cells", name).stdout
            for pointer, source in cell["sources"].items():
                self.assertIn(f"  {pointer}  ", one)
                self.assertIn("source: " + source["source"][:20], one)
        said = json.loads(self.call("plugins", "--cells", "--json").stdout)
        self.assertEqual({cell["name"]: cell["cell_type"] for cell in said}, {name: cell["cell_type"] for name, cell in files.items()})
        self.assert_stops(self.call("plugins", "--cells", "human-red"), 2, "no shipped cell", 'did you mean "human-red-cell"')
        self.assert_stops(self.call("plugins", "--cells", "--lock", SCENE), 2, "give one of these alone")

    def test_of_another_installation_change_no_run_that_goes_on(self):
        self.new("scene", "red-cell-3d")
        run = ["--quiet", "--no-error-bar", "--set", "/output/cells/strain=0.005"]
        whole, paused = self.desk / "whole", self.desk / "paused"
        for out, steps in ((whole, 20), (paused, 10)):
            done = self.call("run", "red-cell-3d.json", "--out", out, "--max-steps", steps, *run)
            self.assertEqual(done.returncode, 0, done.stderr)
        cell = self.program.parent.parent / "share/rouleau/cells/human-red-cell.json"
        cell.write_text(cell.read_text().replace('"6 mPa s"', '"9 mPa s"'))
        on = ["--out", paused, "--resume", "--max-steps", 20]
        refused = self.call("run", "red-cell-3d.json", *on, *run)
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn('/cell_types/rbc/interior_viscosity: "6 mPa s" in the checkpoint, "9 mPa s" now', refused.stderr)
        done = self.call("run", paused / "scene.json", *on, *run[:2])
        self.assertEqual(done.returncode, 0, done.stderr)
        for name in ("scene.json", "cells.csv", "series.csv"):
            self.assertEqual((whole / name).read_bytes(), (paused / name).read_bytes(), name)


class New_scene(Case):
    TEMPLATES = {"demo": "two dimensions, 2 cells", "channel": "two dimensions, 14 cells", "suspension": "two dimensions, 17 cells",
                 "capsule": "two dimensions, 1 cell,", "vessel": "two dimensions, 13 cells", "drawing": "two dimensions, 14 cells", "suspension-3d": "three dimensions, 14 cells",
                 "red-cell-3d": "three dimensions, 1 cell,", "doublet-3d": "three dimensions, 2 cells", "tube-3d": "three dimensions, 4 cells"}

    def test_of_each_template_plans_and_runs_as_it_is(self):
        for template, about in self.TEMPLATES.items():
            with self.subTest(template):
                words = self.new("scene", template)
                scene = self.desk / f"{template}.json"
                self.assertIn(f"rouleau run {template}.json", words)
                self.assertIn(about, words)
                self.assertRegex(words, r"about [0-9.]+ (s|min|h) on one core")
                shipped = [SOURCE / "scenes" / folder / scene.name for folder in ("templates", ".")]  # the former goes first
                self.assertEqual(scene.read_text(), next(without_schema(file) for file in shipped if file.exists()))
                plan = self.call("plan", scene, "--json")
                self.assertEqual(plan.returncode, 0, plan.stderr)
                exceeded = [limit["name"] for limit in json.loads(plan.stdout)["limits"] if limit["margin"] < 1]
                self.assertEqual(exceeded, [])
                steps = "2" if template.endswith("-3d") else "20"
                result = self.call("run", scene, "--out", self.path / template, "--max-steps", steps, "--quiet")
                self.assertEqual(result.returncode, 0, result.stderr)

    def test_of_a_drawing_writes_the_picture_that_it_names_and_overwrites_none(self):
        self.new("scene", "drawing", "--name", "chip")
        shipped = (SOURCE / "scenes/templates/drawing.png").read_bytes()
        self.assertEqual((self.desk / "chip.png").read_bytes(), shipped)
        self.assertNotIn("drawing.png", (self.desk / "chip.json").read_text())
        (self.desk / "chip.json").unlink()
        refused = self.call("new", "scene", "drawing", "--name", "chip")
        self.assertEqual(refused.returncode, 2, refused.stderr)
        self.assertIn("chip.png", refused.stderr)
        self.assertFalse((self.desk / "chip.json").exists())

    def test_has_the_name_and_the_template_that_are_meant_whichever_stands_first(self):
        shipped = {name: next(without_schema(f) for f in (SOURCE / f"scenes/templates/{name}.json", SOURCE / f"scenes/{name}.json")
                              if f.exists()) for name in self.TEMPLATES}
        for words, file, template in (((), "demo", "demo"), (("first", "channel"), "first", "channel"), (("channel", "second"), "second", "channel"),
                                      (("capsule", "--name", "third"), "third", "capsule"), (("--name", "fourth"), "fourth", "demo"),
                                      (("doublet-3d", "--name", "capsule"), "capsule", "doublet-3d"), (("fifth",), "fifth", "demo")):
            with self.subTest(words):
                self.new("scene", *words)
                self.assertEqual((self.desk / f"{file}.json").read_text(), shipped[template])
        self.assertIn("Its name ends in -3d, but it has two dimensions", self.new("scene", "mine-3d"))
        self.assertIn("If a template was meant: rouleau new scene suspension-3d\n", self.new("scene", "suspention-3d"))
        for words in (("first-too",), ("channels", "channel")):
            self.assertNotIn("was meant", self.new("scene", *words))
        self.assert_stops(self.call("new", "scene", "capsule", "channel"), 2, "both", "new scene channel --name capsule")
        self.assert_stops(self.call("new", "scene", "capsul", "--name", "x"), 2, 'did you mean "capsule"?')
        self.assert_stops(self.call("new", "interaction", "org.example.x", "--name", "y"), 2, "for scenes only")

    def test_has_notes_on_its_parts_which_a_run_does_not_look_at(self):
        self.new("scene", "mine.json")  # the ending may be given
        scene = json.loads((self.desk / "mine.json").read_text())
        shipped = json.loads((SOURCE / "scenes/templates/demo.json").read_text())
        del shipped["$schema"]  # it is not there for a file elsewhere
        self.assertEqual(scene, shipped)
        notes = scene.pop("notes")
        self.assertLessEqual({"fluid", "numerics", "stages", "output"}, set(notes))
        (self.desk / "bare.json").write_text(json.dumps(scene))
        plans = [self.call("plan", self.desk / name, "--json").stdout for name in ("mine.json", "bare.json")]
        self.assertEqual(*[{**json.loads(plan), "scene": ""} for plan in plans])

    def test_refuses_what_it_cannot_make_and_leaves_what_is_there(self):
        self.assert_stops(self.call("new", "scene", "a", "chanel"), 2, 'did you mean "channel"?')
        for name in ("a/b", "../a", "", ".a", "a b", "a.lock"):
            with self.subTest(name):
                self.assert_stops(self.call("new", "scene", name), 2, "cannot be the name of a scene")
        self.assert_stops(self.call("new", "interaction", "org.example.x", "channel"), 2, "for scenes only")
        self.assertEqual(list(self.desk.iterdir()), [])
        (self.desk / "a.json").write_text("mine")
        self.assert_stops(self.call("new", "scene", "a"), 2, "a.json", "exists already")
        self.assertEqual((self.desk / "a.json").read_text(), "mine")
        self.assert_stops(self.call("new", "scene", "b", "--dir", self.path / "nowhere"), 4, "nowhere/b.json")


class New_refuses(Case):
    def test_an_unknown_kind_with_the_nearest_one(self):
        self.assert_stops(self.call("new", "colision", "x"), 2, '"colision"', 'did you mean "collision"?',
                          "collision, membrane, interaction")

    def test_names_that_cannot_be_ids_or_types_or_targets(self):
        for name in ("Yukawa", "my_well", "a..b", "x-", "../x", "a/b", "", "ä", "x" * 101):
            with self.subTest(name):
                self.assert_stops(self.call("new", "interaction", name), 2, "cannot be the id of a model",
                                  "org.example.yukawa")
        self.assert_stops(self.call("new", "interaction", "org.example.2pole"), 2, "begins with a letter")
        self.assert_stops(self.call("new", "interaction", "org.example.test"), 2, 'CMake has a target "test"')
        self.assertEqual(list(self.desk.iterdir()), [])

    def test_an_id_that_is_installed_already(self):
        self.assert_stops(self.call("new", "interaction", "morse"), 2, '"morse"', "morse.json")

    def test_missing_words(self):
        self.assert_stops(self.call("new"), 2, "a KIND", "is missing")
        self.assert_stops(self.call("new", "membrane"), 2, "a NAME is missing")

    def test_to_touch_anything_that_is_there(self):
        target = self.desk / "yukawa"
        makers = {"file": lambda: target.write_text("mine"), "folder": target.mkdir,
                  "link": lambda: target.symlink_to(self.path / "nowhere")}
        for kind, make in makers.items():
            with self.subTest(kind):
                make()
                self.assert_stops(self.call("new", "interaction", "org.example.yukawa"), 2, "yukawa", "exists already")
                self.assertEqual([f.name for f in self.desk.iterdir()], ["yukawa"])
                if kind == "folder":
                    self.assertEqual(list(target.iterdir()), [])
                    target.rmdir()
                else:
                    if kind == "file":
                        self.assertEqual(target.read_text(), "mine")
                    target.unlink()

    def test_a_folder_that_does_not_exist_with_exit_code_4(self):
        self.assert_stops(self.call("new", "membrane", "x", "--dir", self.path / "nowhere"), 4,
                          str(self.path / "nowhere/x"), "No such file", "--dir")

    def test_with_the_option_that_it_has(self):
        result = self.call("new", "scene", "first", "--dir", "/proc/self/fdinfo")
        self.assertEqual(result.returncode, 4)
        self.assertNotIn("--out", result.stderr)

    def test_to_leave_half_of_it_when_writing_fails(self):
        # A limit on the size of files stands for a full disk: the source is longer than 64 bytes.
        result = self.call("new", "membrane", "x", preexec_fn=lambda: limit_files(64))
        self.assert_stops(result, 4, "x.cpp", "File too large")
        self.assertEqual(list(self.desk.iterdir()), [])


def limit_files(size):
    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)
    resource.setrlimit(resource.RLIMIT_FSIZE, (size, size))


class Models_are_swapped_by_set_alone(Case):
    def run_scene(self, *settings):
        out = self.path / f"run{len(list(self.path.iterdir()))}"
        words = [w for s in settings for w in ("--set", s)]
        return self.call("run", SCENE, "--out", out, "--quiet", "--max-steps", "20", *words), out

    def test_from_morse_to_lennard_jones_by_the_models_name_because_parameters_share_theirs(self):
        for model in ("morse", "lennard-jones", "lennard-jones-shifted"):
            result, out = self.run_scene(f"/interactions/0/model={model}")
            self.assertEqual(result.returncode, 0, result.stderr)
            plugins = [p["id"] for p in json.loads((out / "summary.json").read_text())["plugins"]]
            self.assertIn(model, plugins)
            self.assertEqual(sum(p in plugins for p in ("morse", "lennard-jones", "lennard-jones-shifted")), 1)

    def test_a_parameter_that_the_new_model_does_not_have_is_explained_with_its_list(self):
        result, _ = self.run_scene('/interactions/0/parameters/decay="3.84 1/um"', "/interactions/0/model=lennard-jones")
        self.assert_stops(result, 2, "/interactions/0/parameters/decay", '"lennard-jones" has no parameter "decay"',
                          "its parameters: depth, zero_force_distance, cutoff")
        result = self.call("plan", SCENE, "--set", "/cell_types/rbc/membrane/0/model=hooke")
        self.assert_stops(result, 2, "/cell_types/rbc/membrane/0/parameters/shear_modulus", '"hooke" has no parameter',
                          "its parameters: stretching_modulus")
        result = self.call("plan", SCENE, "--set", "/fluid/collision/model=central-moment", "--set",
                           "/fluid/collision/parameters/energy_rate=1")
        self.assert_stops(result, 2, '"central-moment" has no parameter "energy_rate"', "bulk_rate", "magic")


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
