"""Which plugins a user gets and which are refused: search order, open folders, locks. Python's standard library only.

usage: check_trust.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER
"""

import hashlib
import json
import os
import shutil
import subprocess
import sys
import unittest
import unittest.mock
from pathlib import Path

sys.dont_write_bytecode = True  # nothing is to appear in the source folder
from check_commands import PROGRAM, SHORT, Case


class TrustCase(Case):
    def setUp(self):
        super().setUp()
        self.file = self.scene()
        self.lock = self.file.with_name("scene.lock.json")
        self.morse = self.rouleau.plugins / "interaction/morse"

    def copy_of_morse(self, name, plugin_id="org.example.mine"):
        """A folder with the Morse potential under another id: its library is never opened."""
        folder = self.path / name
        folder.mkdir(parents=True)
        manifest = json.loads((self.morse / "morse.json").read_text())
        manifest["id"] = plugin_id
        (folder / "mine.json").write_text(json.dumps(manifest))
        return folder

    def listed(self, *arguments, **options):
        result = self.rouleau.run("plugins", "--json", *arguments, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(result.stdout)

    def ids(self, *arguments, program=None, environment=None, **options):
        """Ids that `rouleau plugins` lists with ROULEAU_PLUGIN_PATH as given."""
        variables = {k: v for k, v in os.environ.items() if k != "ROULEAU_PLUGIN_PATH"}
        if environment is not None:
            variables["ROULEAU_PLUGIN_PATH"] = environment
        result = subprocess.run([program or self.rouleau.program, "plugins", "--json", *arguments], capture_output=True,
                                text=True, timeout=60, env=variables, **options)
        self.assertEqual(result.returncode, 0, result.stderr)
        return [p["id"] for p in json.loads(result.stdout)["plugins"]]

    def change_library(self, name="interaction/morse/libmorse.so"):
        with open(self.rouleau.plugins / name, "ab") as library:
            library.write(b"x")  # the loader does not mind

    def write_lock(self):
        result = self.rouleau.run("plugins", "--lock", self.file)
        self.assertEqual(result.returncode, 0, result.stderr)
        return json.loads(self.lock.read_text())


class Plugins_are_searched_where_the_user_said(TrustCase):
    def test_a_relative_folder_of_a_scene_begins_with_the_folder_of_the_scene(self):
        self.copy_of_morse("beside/models")
        scene = self.file.rename(self.path / "beside" / self.file.name)
        change = ["--set", '/plugin_dirs=["models"]', "--set", "/interactions/0/model=org.example.mine"]
        elsewhere = self.path / "elsewhere"
        elsewhere.mkdir()
        result = self.rouleau.run("plan", scene, *change, cwd=elsewhere)
        self.assertNotIn("plugin_dirs of the scene", result.stderr)
        self.assertIn(str(self.path / "beside/models"), result.stderr)  # the copy has no library

    def test_what_a_scene_brings_along_is_said_and_can_be_refused(self):
        shutil.move(self.morse, self.path / "models/morse")
        words = (self.file, "--set", '/plugin_dirs=["models"]')
        library = str(self.path / "models/morse/libmorse.so")
        self.assertEqual(self.rouleau.run("plan", *words).stdout.count("the scene brings code along"), 1)
        run = self.rouleau.run("run", *words, *SHORT, "--out", self.path / "run")
        for result in (self.rouleau.run("plan", *words), run):
            self.assertEqual(result.returncode, 0, result.stderr)
            said = result.stdout + result.stderr
            for word in ("the scene brings code along", '"morse"', library, '/plugin_dirs/0 "models"', "ROULEAU_SCENE_PLUGINS=no"):
                self.assertIn(word, said)
        summary = json.loads((self.path / "run/summary.json").read_text())
        self.assertTrue(any(library in warning for warning in summary["warnings"]))
        self.assert_stops(self.rouleau.run("plan", *words, "--no-scene-plugins"), 2, '"morse"', "not searched")
        with unittest.mock.patch.dict(os.environ, ROULEAU_SCENE_PLUGINS="no"):
            self.assert_stops(self.rouleau.run("plan", *words), 2, "not searched")
        own = self.rouleau.run("plan", *words, "--no-scene-plugins", "--plugin-dir", self.path / "models")
        self.assertEqual(own.returncode, 0, own.stderr)
        self.assertNotIn("the scene brings code along", own.stdout + own.stderr)

    def test_never_in_the_working_directory(self):
        folder = self.copy_of_morse("here")
        for environment in (None, "", ":", "::"):
            self.assertNotIn("org.example.mine", self.ids(cwd=folder, environment=environment))
        self.assertIn("org.example.mine", self.ids("--plugin-dir", ".", cwd=folder))

    def test_a_relative_folder_in_the_environment_is_refused(self):
        self.copy_of_morse("here")
        result = subprocess.run([self.rouleau.program, "plugins"], capture_output=True, text=True, cwd=self.path,
                                env={**os.environ, "ROULEAU_PLUGIN_PATH": "here"})
        self.assert_stops(result, 2, '"here"', "absolute")

    def test_the_environment_counts_unless_the_program_runs_with_raised_privileges(self):
        folder = self.copy_of_morse("here")
        self.assertIn("org.example.mine", self.ids(environment=str(folder)))
        if os.geteuid() != 0 or os.statvfs(self.path).f_flag & os.ST_NOSUID:
            self.skipTest("only root can give a program another user's rights, and only where the file system lets it")
        if b"__asan_init" in self.rouleau.program.read_bytes():
            self.skipTest("a program with a leak checker, which nobody can take from it, ends when it has raised privileges")
        raised = self.rouleau.root / "bin" / "raised"
        shutil.copy(self.rouleau.program, raised)
        os.chown(raised, 65534, 65534)
        raised.chmod(0o4755)
        self.path.chmod(0o755)
        found = self.ids(program=raised, environment=str(folder))
        self.assertIn("morse", found)
        self.assertNotIn("org.example.mine", found)

    def test_an_earlier_folder_does_not_silently_win_over_a_later_one(self):
        folder = self.copy_of_morse("here", "morse")
        result = self.rouleau.run("plan", self.file, "--plugin-dir", folder)
        self.assert_stops(result, 3, str(folder / "mine.json"), str(self.morse / "morse.json"))


class Plugins_of_the_users_own(TrustCase):
    """The Morse potential, taken out of the installation and installed again by its user."""

    def setUp(self):
        super().setUp()
        self.offered = self.path / "offered"
        shutil.move(self.morse, self.offered)
        self.data = self.path / "data"
        self.place = self.data / "rouleau/plugins/morse"

    def call(self, *arguments, **variables):
        environment = {k: v for k, v in os.environ.items() if k not in ("ROULEAU_PLUGIN_PATH", "XDG_DATA_HOME")}
        environment |= variables or {"XDG_DATA_HOME": str(self.data)}
        return subprocess.run([self.rouleau.program, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                              env=environment, cwd=self.path)

    def listed(self, **variables):
        plugins = json.loads(self.call("plugins", "--json", **variables).stdout)["plugins"]
        return {plugin["id"]: plugin["origin"] for plugin in plugins}

    def test_are_found_without_an_option_and_named_as_theirs(self):
        self.assertNotIn("morse", self.listed())
        result = self.call("plugins", "--install", self.offered)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(str(self.place), result.stdout)
        self.assertEqual({f.name for f in self.place.iterdir()}, {"morse.json", "libmorse.so"})
        self.assertEqual([f.name for f in (self.data / "rouleau").iterdir()], ["plugins"])
        self.assertEqual((self.listed()["morse"], self.listed()["bending"]), ("user", "installation"))
        self.assertIn(f"{self.place.parent} (user)", self.call("plugins").stdout)
        plan = self.call("plan", self.file)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        home = self.path / "home"
        home.mkdir()
        shutil.copytree(self.data, home / ".local/share")
        self.assertEqual(self.listed(HOME=str(home))["morse"], "user")
        self.assertNotIn("morse", self.listed(XDG_DATA_HOME="data", HOME="home"))  # relative ones are none

    def test_are_replaced_only_on_request_and_whole(self):
        self.assertEqual(self.call("plugins", "--install", self.offered).returncode, 0)
        self.assert_stops(self.call("plugins", "--install", self.offered), 2, str(self.place), "--overwrite")
        (self.place / "left over").touch()
        manifest = json.loads((self.offered / "morse.json").read_text())
        manifest["title"] = "another title"
        (self.offered / "morse.json").write_text(json.dumps(manifest))
        result = self.call("plugins", "--install", self.offered, "--overwrite")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertEqual(json.loads((self.place / "morse.json").read_text())["title"], "another title")
        self.assertEqual({f.name for f in self.place.iterdir()}, {"morse.json", "libmorse.so"})

    def test_are_not_installed_where_they_could_not_be_used(self):
        (self.path / "empty").mkdir()
        self.assert_stops(self.call("plugins", "--install", "empty"), 2, "empty", "holds no manifest")
        taken = self.path / "taken"
        shutil.copytree(self.rouleau.plugins / "membrane/bending", taken)
        self.assert_stops(self.call("plugins", "--install", taken), 2, '"bending"', "give yours another id")
        self.assert_stops(self.call("plugins", "--install", self.offered, XDG_DATA_HOME="", HOME=""), 2, "HOME")
        manifest = json.loads((self.offered / "morse.json").read_text())
        manifest["id"] = "org.example.mine"  # which the library knows nothing of
        (self.offered / "morse.json").write_text(json.dumps(manifest))
        self.assert_stops(self.call("plugins", "--install", self.offered), 3, "rouleau conform", "--level interface")
        self.assertFalse(self.data.exists())


class Open_folders_are_refused(TrustCase):
    def test_a_plugin_that_every_user_could_replace_is_listed_as_refused_and_stops_a_scene_that_names_it(self):
        places = {self.rouleau.plugins: "folder", self.rouleau.plugins / "interaction": "folder", self.morse: "folder",
                  self.morse / "morse.json": "file", self.morse / "libmorse.so": "file"}
        for place, what in places.items():
            with self.subTest(place):
                mode = place.stat().st_mode & 0o7777
                place.chmod(mode | 0o002)
                words = (f"the {what} {place} (mode 0{mode | 0o002:o})", f"chmod o-w {place}")
                refused = {r["id"]: r["reason"] for r in self.listed()["refused"]}
                for word in words:
                    self.assertIn(word, refused["morse"])
                self.assertEqual("trt" in refused, place == self.rouleau.plugins)
                self.assert_stops(self.rouleau.run("plan", self.file, "--set", "/interactions/0/model=morse"), 3, *words)
                place.chmod(mode)
        self.assertEqual(self.rouleau.run("plan", self.file).returncode, 0)

    def test_a_scene_that_does_not_name_it_runs_on(self):
        self.morse.chmod(0o777)
        self.assertEqual(self.rouleau.run("plan", self.file, "--set", "/interactions=[]").returncode, 0)


class A_lock_binds_a_scene_to_its_plugins(TrustCase):
    def test_it_holds_every_plugin_of_the_scene_with_version_and_hashes(self):
        lock = self.write_lock()
        self.assertEqual([p["id"] for p in lock["plugins"]], ["trt", "morse", "bending", "neo-hookean"])
        for plugin in lock["plugins"]:
            folder = self.rouleau.plugins / plugin["kind"] / plugin["id"]
            digest = lambda name: hashlib.sha256((folder / name).read_bytes()).hexdigest()
            self.assertEqual(plugin["library_sha256"], digest(f"lib{plugin['id']}.so"))
            self.assertEqual(plugin["manifest_sha256"], digest(f"{plugin['id']}.json"))
            self.assertEqual(plugin["version"], json.loads((folder / f"{plugin['id']}.json").read_text())["version"])

    def test_a_run_that_obeys_it_says_so_in_its_summary_and_a_plan_prints_it(self):
        self.write_lock()
        self.assertEqual(self.rouleau.run("run", self.file, "--out", self.path / "run", *SHORT).returncode, 0)
        expected = {"file": str(self.lock), "sha256": hashlib.sha256(self.lock.read_bytes()).hexdigest()}
        self.assertEqual(json.loads((self.path / "run/summary.json").read_text())["lock"], expected)
        self.assertEqual(json.loads(self.rouleau.run("plan", self.file, "--json").stdout)["lock"], expected)
        self.assertIn(f"as locked by {self.lock}", self.rouleau.run("plan", self.file).stdout)

    def test_without_one_the_summary_holds_null(self):
        self.assertEqual(self.rouleau.run("run", self.file, "--out", self.path / "run", *SHORT).returncode, 0)
        self.assertIsNone(json.loads((self.path / "run/summary.json").read_text())["lock"])

    def test_another_library_stops_run_and_plan_before_a_directory_is_made(self):
        expected = next(p for p in self.write_lock()["plugins"] if p["id"] == "morse")["library_sha256"]
        self.change_library()
        found = hashlib.sha256((self.morse / "libmorse.so").read_bytes()).hexdigest()
        words = (str(self.morse / "libmorse.so"), expected, found, str(self.lock), f"rouleau plugins --lock {self.file}")
        self.assert_stops(self.rouleau.run("plan", self.file), 3, *words)
        self.assert_stops(self.rouleau.run("run", self.file, "--out", self.path / "run", *SHORT), 3, *words)
        self.assertFalse((self.path / "run").exists())
        self.write_lock()
        self.assertEqual(self.rouleau.run("plan", self.file).returncode, 0)

    def test_another_manifest_stops_a_run(self):
        self.write_lock()
        manifest = self.morse / "morse.json"
        manifest.write_text(manifest.read_text() + "\n")
        self.assert_stops(self.rouleau.run("plan", self.file), 3, "/interactions/0/model", str(manifest),
                          "expected SHA-256 of the manifest")

    def test_a_model_swapped_by_set_is_refused_with_that_reason(self):
        self.write_lock()
        result = self.rouleau.run("plan", self.file, "--set", '/fluid/collision={"model": "bgk"}')
        self.assert_stops(result, 3, '"bgk" is not in the lock', str(self.lock), "binds a changed scene")
        # Values may change: they are no plugins.
        self.assertEqual(self.rouleau.run("plan", self.file, "--set", "/numerics/tau=0.9").returncode, 0)

    def test_a_model_that_is_left_out_needs_no_library_but_its_manifest_decides_that(self):
        self.write_lock()
        nothing = ("--set", '/interactions/0/parameters/depth="0 J/m2"')
        self.change_library()
        self.assertEqual(self.rouleau.run("plan", self.file, *nothing).returncode, 0)
        manifest = self.morse / "morse.json"
        manifest.write_text(manifest.read_text() + "\n")
        self.assert_stops(self.rouleau.run("plan", self.file, *nothing), 3, "SHA-256 of the manifest")

    def test_a_lock_elsewhere_is_named(self):
        other = self.path / "team.json"
        result = self.rouleau.run("plugins", "--lock", self.file, "--out", other)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertFalse(self.lock.exists())
        self.change_library()
        self.assertEqual(self.rouleau.run("plan", self.file).returncode, 0)
        self.assert_stops(self.rouleau.run("plan", self.file, "--lock", other), 3, str(other), f"--out {other}")

    def test_a_damaged_lock_is_an_error_and_not_a_scene_without_one(self):
        self.write_lock()
        self.lock.write_text(self.lock.read_text().replace('"lock": 1', '"lock": 2'))
        self.assert_stops(self.rouleau.run("plan", self.file), 2, str(self.lock), "/lock")
        self.lock.write_text("")
        self.assert_stops(self.rouleau.run("plan", self.file), 2, str(self.lock))
        self.lock.unlink()
        self.lock.symlink_to("nowhere")
        self.assert_stops(self.rouleau.run("plan", self.file), 4, str(self.lock))
        self.assert_stops(self.rouleau.run("plan", self.file, "--lock", self.path / "absent"), 4, "absent")

    def test_a_scene_whose_plugins_cannot_be_used_is_not_locked(self):
        (self.morse / "libmorse.so").unlink()
        self.assert_stops(self.rouleau.run("plugins", "--lock", self.file), 3, "libmorse.so")
        self.assertFalse(self.lock.exists())

    def test_a_lock_that_cannot_be_written_leaves_the_former_one(self):
        self.write_lock()
        before = self.lock.read_bytes()
        result = self.rouleau.run("plugins", "--lock", self.file, "--out", self.path / "absent" / "lock.json")
        self.assert_stops(result, 4, "absent")
        self.assertEqual(self.lock.read_bytes(), before)

    def test_bad_usage_is_told(self):
        self.assert_stops(self.rouleau.run("plugins", "morse", "--lock", self.file), 2, "the ID of a model")
        self.assert_stops(self.rouleau.run("plugins", "--json", "--lock", self.file), 2, "--json")
        self.assert_stops(self.rouleau.run("plugins", "--out", "x"), 2, "--lock")
        self.assert_stops(self.rouleau.run("plugins", "--install", "x", "--lock", "y"), 2, "--lock, --install")
        self.assert_stops(self.rouleau.run("plugins", "--overwrite"), 2, "--install")


class Files_of_others(TrustCase):
    def test_that_are_pipes_or_have_no_end_are_refused_and_not_waited_for(self):
        pipe = self.path / "pipe"
        os.mkfifo(pipe)
        capsule = Path(sys.argv[3]) / "scenes/capsule-3d.json"
        for file, words in ((pipe, "pipe"), ("/dev/zero", "device")):
            self.assert_stops(self.rouleau.run("plan", file), 4, str(file), words)
            mesh = {"membrane": [], "shape": {"mesh": {"file": str(file), "unit": "1 um"}}}
            self.assert_stops(self.rouleau.run("plan", capsule, "--set", f"/cell_types/capsule={json.dumps(mesh)}"), 2,
                              str(file), "/shape/mesh/file", "no plain file")
            self.assert_stops(self.rouleau.run("study", file, "--out", self.path / "study"), 4, words)
        self.assert_stops(self.rouleau.run("plan", self.file, "--set", f'/cells={json.dumps({"file": str(pipe)})}'), 2,
                          "/cells/file", "no plain file")

    def test_of_a_run_are_its_own_and_regular_ones(self):
        run = self.path / "run"
        self.assertEqual(self.rouleau.run("run", self.file, "--out", run, *SHORT).returncode, 0)
        secret = self.path / "secret"
        secret.write_text('{"password": "s3cret"}')
        for name in ("summary.json", "scene.json", "series.csv", "cells.csv", "frames.h5", "log.jsonl"):
            kept = (run / name).rename(self.path / "kept")
            for pipe in (True, False):
                if pipe:
                    os.mkfifo(run / name)
                else:
                    (run / name).symlink_to(secret)
                for command in (("report", run), ("report", "--compare", run, run, "--out", self.path / "two.html"), ("verify", run)):
                    self.rouleau.run(*command)  # ends
                for page in self.path.rglob("*.html"):
                    self.assertNotIn("s3cret", page.read_text(), name)
                    page.unlink()
                (run / name).unlink()
            kept.rename(run / name)
        (run / "log.jsonl").unlink()
        os.mkfifo(run / "log.jsonl")
        self.assert_stops(self.rouleau.run("run", self.file, "--out", run, "--resume", *SHORT), 4, "a pipe that nobody reads")


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
