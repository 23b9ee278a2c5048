"""The program as a user meets it: commands, exit codes, messages and files. Python's standard library only.

usage: check_commands.py ROULEAU PLUGIN_FOLDER SOURCE_FOLDER [--no-whole-runs]
"""

import hashlib
import json
import os
import pty
import re
import shutil
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

PROGRAM, PLUGINS, SOURCE = (Path(a).resolve() for a in sys.argv[1:4])
SCENE = SOURCE / "scenes" / "four-cells-shear.json"
SHORT = ["--max-steps", "20", "--quiet"]
whole_runs = unittest.skipIf("--no-whole-runs" in sys.argv, "slow")  # where the program is ten times slower


class Installation:
    """A copy of the program and its plugins that a test may damage; conformance is that of the build."""

    def __init__(self, folder):
        self.root = Path(folder) / "installation"
        (self.root / "bin").mkdir(parents=True)
        shutil.copy(PROGRAM, self.root / "bin" / "rouleau")
        self.plugins = self.root / "lib" / "rouleau" / "plugins"
        shutil.copytree(PLUGINS, self.plugins)
        (self.root / "libexec").symlink_to(PROGRAM.parent.parent / "libexec")
        self.program = self.root / "bin" / "rouleau"

    def run(self, *arguments, **options):
        environment = {**os.environ, **options.pop("env", {})}
        environment.pop("ROULEAU_PLUGIN_PATH", None)
        return subprocess.run([self.program, *map(str, arguments)], capture_output=True, text=True, timeout=300,
                              env=environment, **options)


class Case(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.path = Path(self.folder.name)
        self.rouleau = Installation(self.path)

    def scene(self, **changes):
        """The four-cell scene with top-level keys replaced, as a file."""
        scene = json.loads(SCENE.read_text())
        scene.update(changes)
        file = self.path / "scene.json"
        file.write_text(json.dumps(scene))
        return file

    def assert_stops(self, result, code, *words):
        self.assertEqual(result.returncode, code, result.stderr)
        for word in words:
            self.assertIn(word, result.stderr)


class Physics_comes_from_plugins(Case):
    """The host holds no collision, membrane or interaction formula."""

    LIBRARIES = {
        "collision/trt": "trt",
        "membrane/neo-hookean": "neo-hookean",
        "membrane/bending": "bending",
        "interaction/morse": "morse",
    }

    def test_without_its_library_a_scene_that_names_a_model_stops_with_the_loaders_own_words(self):
        for folder, name in self.LIBRARIES.items():
            with self.subTest(name):
                library = self.rouleau.plugins / folder / f"lib{name}.so"
                kept = library.rename(self.path / "kept.so")
                result = self.rouleau.run("run", SCENE, "--out", self.path / "run", *SHORT)
                self.assert_stops(result, 3, f"{name}.json", str(library), "No such file")
                self.assertFalse((self.path / "run" / "summary.json").exists())
                kept.rename(library)

    def test_a_library_that_is_no_library_is_refused_with_the_loaders_own_words(self):
        library = self.rouleau.plugins / "interaction/morse/libmorse.so"
        library.write_text("this is text\n")
        self.assert_stops(self.rouleau.run("plan", SCENE), 3, "morse.json", str(library))

    def test_scenes_that_do_not_name_it_run_on(self):
        for folder, name in self.LIBRARIES.items():
            (self.rouleau.plugins / folder / f"lib{name}.so").unlink()
        scene = self.scene(fluid={"density": "1 g/cm3", "viscosity": "1.2 cP", "collision": {"model": "bgk"}},
                           cell_types={}, cells=[], interactions=[],
                           stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 1}])
        result = self.rouleau.run("run", scene, "--out", self.path / "run", *SHORT)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_an_inactive_interaction_is_left_out_and_its_library_not_opened(self):
        (self.rouleau.plugins / "interaction/morse/libmorse.so").unlink()
        result = self.rouleau.run("run", SCENE, "--set", '/interactions/0/parameters/depth="0 J/m2"', "--out",
                                  self.path / "run", *SHORT)
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads((self.path / "run" / "summary.json").read_text())
        self.assertIn("interaction morse", [o["what"] for o in summary["left_out"]])
        self.assertNotIn("morse", [p["id"] for p in summary["plugins"]])

    def test_no_membrane_or_interaction_library_is_mapped_without_cells(self):
        scene = self.scene(cell_types={}, cells=[], interactions=[],
                           stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 1000}])
        process = subprocess.Popen([self.rouleau.program, "run", scene, "--out", self.path / "run", "--quiet"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            maps = ""
            for _ in range(200):
                maps = Path(f"/proc/{process.pid}/maps").read_text()
                if "libtrt.so" in maps:
                    break
                time.sleep(0.05)
            time.sleep(0.3)
            maps = Path(f"/proc/{process.pid}/maps").read_text()
            self.assertIn("libtrt.so", maps)
            for name in ("neo-hookean", "bending", "morse", "bgk"):
                self.assertNotIn(f"lib{name}.so", maps)
        finally:
            process.send_signal(signal.SIGINT)
            process.wait(timeout=60)
        self.assertEqual(process.returncode, 130)


class Errors_name_what_is_wrong(Case):
    def test_an_id_nobody_offers_is_bad_input_with_the_nearest_name(self):
        result = self.rouleau.run("plan", SCENE, "--set", "/interactions/0/model=morze")
        self.assert_stops(result, 2, "morze", "morse", str(self.rouleau.plugins))

    def test_a_model_of_another_kind_is_bad_input(self):
        result = self.rouleau.run("plan", SCENE, "--set", "/interactions/0/model=bending")
        self.assert_stops(result, 2, "bending", "membrane")

    def test_an_unknown_parameter_is_explained_with_the_models_list(self):
        result = self.rouleau.run("plan", SCENE, "--set", "/interactions/0/parameters/detph=1")
        self.assert_stops(result, 2, "detph", "depth", "zero_force_distance")

    def test_a_parameter_with_the_wrong_unit_names_place_value_and_remedy(self):
        file = self.scene()
        text = json.dumps(json.loads(file.read_text()), indent=2).replace("6e-3 dyn/cm", "6 Pa")
        file.write_text(text)
        line = next(i for i, l in enumerate(text.splitlines(), 1) if "6 Pa" in l)
        result = self.rouleau.run("plan", file)
        self.assert_stops(result, 2, f":{line}:", "/cell_types/rbc/membrane/0/parameters/shear_modulus", '"6 Pa"',
                          "pressure", "N/m")

    def test_a_parameter_outside_its_limits_is_bad_input(self):
        result = self.rouleau.run("plan", SCENE, "--set", '/interactions/0/parameters/depth="-1 J/m2"')
        self.assert_stops(result, 2, "depth", "-1", "0")

    def test_two_manifests_with_one_id_are_refused_naming_both(self):
        shutil.copytree(self.rouleau.plugins / "interaction/morse", self.rouleau.plugins / "interaction/twin")
        result = self.rouleau.run("plan", SCENE)
        self.assert_stops(result, 3, "interaction/morse/morse.json", "interaction/twin/morse.json")

    def test_overlapping_cells_name_both_entries(self):
        result = self.rouleau.run("plan", SCENE, "--set", '/cells/0/row/spacing="1 um"')
        self.assert_stops(result, 2, "/cells/0", "overlap")

    def test_a_cell_through_a_wall_is_bad_input(self):
        result = self.rouleau.run("plan", SCENE, "--set", '/cells/0/row/center=["25 um","2 um"]')
        self.assert_stops(result, 2, "/cells/0", "wall")

    def test_an_output_folder_that_cannot_be_made_is_an_input_output_error(self):
        (self.path / "file").write_text("")
        result = self.rouleau.run("run", SCENE, "--out", self.path / "file" / "run", *SHORT)
        self.assert_stops(result, 4, str(self.path / "file"))

    def test_a_scene_that_does_not_exist_is_an_input_output_error(self):
        self.assert_stops(self.rouleau.run("plan", self.path / "nowhere.json"), 4, "nowhere.json")

    def test_bad_usage_exits_with_2_and_the_nearest_name(self):
        self.assert_stops(self.rouleau.run("rum", SCENE), 2, "run")
        self.assert_stops(self.rouleau.run("run", SCENE, "--thread", "2"), 2, "--threads")
        self.assert_stops(self.rouleau.run("run"), 2, "a SCENE file (JSON) is missing", "rouleau run --help")
        self.assert_stops(self.rouleau.run("report"), 2, "a directory DIR is missing")
        self.assert_stops(self.rouleau.run("run", SCENE, "--threads", "0"), 2, "--threads")
        self.assert_stops(self.rouleau.run("run", SCENE, "--max-steps", "-5"), 2, "--max-steps -5", "zero or more")
        self.assert_stops(self.rouleau.run("plan", SCENE, "--set", "/fluid/densty=1"), 2, "densty", "density")
        self.assert_stops(self.rouleau.run("plan", SCENE, "more"), 2, "more words stand without an option than it takes, 1",
                          "rouleau plan --help")

    def test_a_set_that_the_shell_has_cut_says_to_quote_the_whole(self):
        # As `--set /fluid/viscosity=6 cP` reaches the program.
        for words in ([SCENE, "--set", "/fluid/viscosity=6", "cP"], ["--set", "/fluid/viscosity=6", "cP", SCENE],
                      [SCENE, "--set=/fluid/viscosity=6", "cP", "--set", "/numerics/tau=0.8"]):
            for command in ("run", "plan"):
                self.assert_stops(self.rouleau.run(command, *words), 2, "--set /fluid/viscosity=6 cP: ",
                                  "quote the whole: --set '/fluid/viscosity=6 cP'")
        self.assert_stops(self.rouleau.run("plan", SCENE, "--set", "/x=2", "g", "/", "cm3"), 2, "--set '/x=2 g / cm3'")
        # A second scene is no unit.
        end = self.rouleau.run("plan", "--set", "/fluid/viscosity=6", SCENE, SCENE)
        self.assertEqual(end.returncode, 2)
        self.assertNotIn("quote", end.stderr)

    def test_all_that_is_wrong_is_said_at_once_and_leaves_no_directory(self):
        wrong = ["/numerics/tau=0.1", "/fluid/viscosity=1 um", "/interactions/0/parameters/depht=1",
                 "/interactions/0/model=mors", "/cell_types/rbc/membrane/1/parameters/modulus=-1 J", "/stages/1/shaer_rate=1"]
        words = [word for one in wrong for word in ("--set", one)]
        for command in ("run", "plan"):
            end = self.rouleau.run(command, self.scene(), *words, cwd=self.path)
            self.assert_stops(end, 2, *(f"--set {one.split('=')[0]}\n" for one in wrong if "depht" not in one))
            # The parameters of a model that nobody offers are not judged.
            self.assertEqual(sum(not line.startswith(" ") for line in end.stderr.splitlines()), len(wrong) - 1, end.stderr)
        self.assertFalse((self.path / "runs").exists())

    def test_a_cutoff_before_the_force_changes_sign_is_warned_of_by_plan_and_run(self):
        cut = ["--set", "/interactions/0/parameters/cutoff=0.4 um"]
        for words in (["plan", SCENE, *cut], ["run", SCENE, *cut, "--out", self.path / "run", *SHORT]):
            end = self.rouleau.run(*words)
            self.assertEqual(end.returncode, 0, end.stderr)
            self.assertIn("it attracts nowhere: its cutoff of 0.4 um", end.stdout + end.stderr)

    def test_a_remedy_names_the_density_factor_that_holds(self):
        # The first stage of the scene has one of its own, the second has that of numerics.
        for key, stage in (("/stages/0/density_factor", "aggregate"), ("/numerics/density_factor", "shear")):
            name = key if key.startswith("/stages") else "numerics.density_factor"
            warnings = [line for line in self.rouleau.run("plan", SCENE, "--set", key + "=1e9").stdout.splitlines()
                        if "warning: " in line and "density_factor" in line]
            self.assertTrue(warnings)
            for line in warnings:
                self.assertIn(f"(stage {stage})", line)
                self.assertIn("lower " + name, line)
            end = self.rouleau.run("plan", SCENE, "--set", key + "=1e-9")
            self.assert_stops(end, 2, "more than any run can (1e15)", "a higher " + name)

    def test_the_help_of_plan_says_that_plugins_run(self):
        self.assertIn("so their code runs", self.rouleau.run("plan", "--help").stdout)

    def test_studies_limits_locks_and_manifests_say_all_that_is_wrong_too(self):
        file = self.path / "wrong.json"
        file.write_text('{"rouleau_study": 2,\n"scene": 5,\n"matrx": []}')
        self.assert_stops(self.rouleau.run("study", file), 2, ":1:19 /rouleau_study", ":2:10 /scene", ":3:1 /matrx")
        file.write_text('{"rouleau_limits": 2,\n"scene": 5,\n"tries": []}')
        self.assert_stops(self.rouleau.run("limits", file), 2, ":1:20 /rouleau_limits", ":2:10 /scene", ":3:1 /tries")
        file.write_text('{"lock": 2,\n"plugins": [{}]}')
        self.assert_stops(self.rouleau.run("plan", SCENE, "--lock", file), 2, ":1:10 /lock", ":2:13 /plugins/0",
                          '"id" is missing', '"version" is missing')
        manifest = self.rouleau.plugins / "interaction/morse/morse.json"
        content = manifest.read_text()
        manifest.write_text(content.replace('"version"', '"vrsion"', 1).replace('"kind"', '"knd"', 1))
        self.assert_stops(self.rouleau.run("plan", SCENE), 3, "/vrsion", "/knd")


class A_run_that_goes_bad_stops_before_garbage_is_written(Case):
    def stop(self, reason, *settings):
        arguments = [a for s in settings for a in ("--set", s)]
        result = self.rouleau.run("run", SCENE, "--out", self.path / reason, "--quiet", *arguments)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(reason, result.stderr)
        summary = json.loads((self.path / reason / "summary.json").read_text())
        self.assertEqual(summary["status"], "diverged")
        failure = summary["failure"]
        self.assertEqual(failure["reason"], reason)
        for key in ("step", "place_m", "cell", "value", "limit", "message", "remedy"):
            self.assertIn(key, failure)
        self.assertTrue((self.path / reason / "report.html").exists())
        rows = (self.path / reason / "cells.csv").read_text().lower()
        self.assertNotIn("nan", rows)
        return failure

    def test_a_node_that_moves_too_far(self):
        failure = self.stop("node_step", "/stages/0/density_factor=2e5")
        self.assertGreaterEqual(failure["cell"], 0)
        self.assertGreater(failure["value"], 0.5)

    def test_a_flow_too_fast_for_the_lattice(self):
        self.stop("mach", '/stages/1/shear_rate="600 1/s"', '/stages/0/duration="1 ms"')

    @whole_runs
    def test_area_that_drifts(self):
        failure = self.stop("area_drift", "/checks/area_drift=2e-5")
        self.assertGreater(failure["value"], failure["limit"])
        self.assertNotIn("segments", failure["remedy"])

    @whole_runs
    def test_area_that_drifts_because_segments_are_too_long(self):
        plan = self.rouleau.run("plan", SCENE, "--set", "/cell_types/rbc/segments=32")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertIn("warning: longest segment in lattice spacings is 3.072, above its limit of 2; take more ", plan.stdout)
        failure = self.stop("area_drift", "/cell_types/rbc/segments=32", "/checks/area_drift=2e-5")
        self.assertTrue(failure["remedy"].startswith("take more segments (this cell's are 3."), failure["remedy"])

    def test_membranes_that_cross(self):
        # Bending and stretching all but removed: attraction folds the membranes through each other.
        self.stop("crossing", '/cell_types/rbc/membrane/0/parameters/shear_modulus="1e-8 N/m"', "/checks/stretch=100",
                  '/cell_types/rbc/membrane/1/parameters/modulus="1e-22 J"', "/checks/area_drift=0.5",
                  '/interactions/0/parameters/depth="2e-6 J/m2"', "/stages/0/density_factor=3000")


class Commands_do_what_they_say(Case):
    def test_help_is_everywhere_and_has_an_example(self):
        commands = re.findall(r"^  ([a-z]+) ", self.rouleau.run("--help").stdout, re.MULTILINE)
        self.assertGreaterEqual(set(commands), {"run", "plan", "plugins", "conform", "new", "report"})
        for command in commands:
            result = self.rouleau.run(command, "--help")
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("xample", result.stdout)
            short = self.rouleau.run(command, "-h")
            self.assertEqual((short.returncode, short.stdout), (0, result.stdout), short.stderr)
        self.assertEqual(self.rouleau.run("--help").stdout, self.rouleau.run("-h").stdout)

    def test_plan_prints_json_with_what_is_left_out_and_why(self):
        result = self.rouleau.run("plan", SCENE, "--json")
        plan = json.loads(result.stdout)
        for key in ("conversions", "dimensionless", "limits", "passes", "left_out", "estimate", "models"):
            self.assertIn(key, plan)
        self.assertAlmostEqual(plan["dimensionless"]["reynolds_physical"], 2.548e-4, delta=1e-6)

    def test_plan_measures_the_steps_of_a_scene_and_keeps_nothing(self):
        said = json.loads(self.rouleau.run("plan", SCENE, "--measure", "2", "--json").stdout)["estimate"]
        measured = said["measured"]
        self.assertEqual(measured["threads"], 2)
        self.assertGreaterEqual(measured["steps"], 3)
        self.assertGreater(min(measured["step_s"], measured["output_s"]), 0)
        whole = said["steps_at_most"] * measured["step_s"] + said["output"]["outputs"] * measured["output_s"]
        self.assertAlmostEqual(measured["wall_s"] / whole, 1)
        self.assertIn("steps by 1 thread: ", self.rouleau.run("plan", SCENE, "--measure", "1").stdout)
        self.assertIn("--measure 0: wants a number", self.rouleau.run("plan", SCENE, "--measure", "0").stderr)

    def test_plan_says_what_each_of_several_ranks_would_do_and_how_long_a_step_takes(self):
        words = ["plan", SCENE, "--ranks", 6, "--network", "1 us,5 GB/s,0.25 us", "--step", "1 ms"]
        ranks = json.loads(self.rouleau.run(*words, "--json").stdout)["ranks"]
        self.assertEqual(len(ranks["of_each"]), 6)
        self.assertEqual(sum(rank["nodes"] for rank in ranks["of_each"]), 256 * 128)
        self.assertEqual(sum(rank["cells"] for rank in ranks["of_each"]), 4)
        sent = sum(rank[f"{what}_bytes"] for rank in ranks["of_each"]
                   for what in ("population", "velocity", "position", "force", "node_velocity"))
        self.assertAlmostEqual(sum(rank["received_bytes"] for rank in ranks["of_each"]), sent, delta=1e-6 * sent)
        times = {time["ranks"]: time for time in ranks["times"]["of"]}
        self.assertAlmostEqual(times[1]["step_s"], 1e-3)
        self.assertEqual(ranks["times"]["fastest"], min(times.values(), key=lambda time: time["step_s"])["ranks"])
        self.assertAlmostEqual(times[6]["efficiency"], 1e-3 / times[6]["step_s"] / 6)
        for number in range(6):
            one = json.loads(self.rouleau.run(*words, "--rank", number, "--json").stdout)["ranks"]
            self.assertEqual({**ranks["of_each"][number], **one["rank"]}, one["rank"])
            self.assertEqual(one["rank"]["size"][0] * one["rank"]["size"][1], one["rank"]["nodes"])
        shared = json.loads(self.rouleau.run(*words, "--processors", 2, "--json").stdout)["ranks"]
        self.assertEqual(shared["processors"], 2)
        slower = {time["ranks"]: time["step_s"] for time in shared["times"]["of"]}
        self.assertAlmostEqual(slower[2], times[2]["step_s"])
        self.assertGreater(slower[6], 0.5e-3)
        self.assertGreater(slower[6], 2 * times[6]["step_s"])
        self.assertIn("with 2 processors for all ranks", self.rouleau.run(*words, "--processors", 2).stdout)
        text = self.rouleau.run(*words, "--rank", 5).stdout
        self.assertIn("Rank 5: nodes ", text)
        self.assertIn("   the fastest", text)
        for wrong, what in ((["--rank", 6], "from 0 to 5"), (["--rank", -1], "from 0 to 5"), (["--network", "2 us"], "1 values"),
                            (["--network", "2 us,3 m"], "ends with B/s"), (["--step", "0 s"], "above zero"), (["--step", "1 m"], "length"), (["--processors", 0], "at least one")):
            self.assert_stops(self.rouleau.run("plan", SCENE, "--ranks", 6, *wrong), 2, what)
        self.assert_stops(self.rouleau.run("plan", SCENE, "--rank", 2), 2, "add --ranks N")

    def test_a_lattice_that_one_rank_cannot_compute_is_planned_for_several_and_refused_to_one(self):
        large = ["--set", "/domain/nodes=[65536, 32768]", "--set", '/domain/size=["12845.056 um", "6422.528 um"]']
        plan = self.rouleau.run("plan", SCENE, *large, "--ranks", 4)
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertIn("2147483648 nodes and one rank can compute 1073741824; start the run on 2 ranks or more", plan.stdout)
        # What a run would be refused for the plan is, too, once it has been printed.
        for command in ("run", "plan"):
            self.assert_stops(self.rouleau.run(command, SCENE, *large, *(["--out", self.path / "none"] if command == "run" else [])), 2, "at least 2")
        self.assertIn("Dimensionless numbers", self.rouleau.run("plan", SCENE, *large).stdout)
        refused = json.loads(self.rouleau.run("plan", SCENE, *large, "--json").stdout)
        self.assertGreater(refused["estimate"]["memory_bytes"], 1e11)
        # As many nodes as one rank can compute, and more than there is memory for.
        full = ["--set", "/domain/nodes=[32768, 32768]", "--set", '/domain/size=["6422.528 um", "6422.528 um"]', "--set", "/output={}"]
        plenty = os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") > 9e10
        for command in () if plenty else ("run", "plan"):
            self.assert_stops(self.rouleau.run(command, SCENE, *full, *(["--out", self.path / "none"] if command == "run" else [])), 4, "of memory, and there are")
        self.assertFalse((self.path / "none").exists())

    def test_conversions_and_limits_say_whose_they_are(self):
        scene = json.loads(SCENE.read_text())
        stiff = json.loads(json.dumps(scene["cell_types"]["rbc"]))
        stiff["membrane"][0]["parameters"]["shear_modulus"] = "2e-5 N/m"
        scene["cell_types"]["stiff"] = stiff
        scene["cells"][0]["row"]["count"] = 2
        scene["cells"].append({"type": "stiff", "at": ["40 um", "12.544 um"]})
        scene["interactions"].append({**scene["interactions"][0], "between": ["rbc", "stiff"]})
        file = self.path / "two.json"
        file.write_text(json.dumps(scene))
        plan = json.loads(self.rouleau.run("plan", file, "--json").stdout)
        found = {(row["of"], row["quantity"]): row["si"] for row in plan["conversions"] if row["stage"] == "shear"}
        self.assertAlmostEqual(found["rbc", "neo-hookean: shear_modulus"], 6e-6)
        self.assertAlmostEqual(found["stiff", "neo-hookean: shear_modulus"], 2e-5)
        self.assertAlmostEqual(found["rbc, stiff", "morse: depth"], 5.2e-8, delta=1e-12)
        self.assertAlmostEqual(found["stiff", "interior viscosity"], 6e-3)
        self.assertEqual(sum(row["stage"] == "shear" for row in plan["conversions"]), len(found), "one row each")
        gaps = [limit["name"] for limit in plan["limits"] if limit["name"].startswith("equilibrium gap")]
        self.assertEqual(sorted(gaps), ["equilibrium gap of morse (rbc, rbc) in lattice spacings", "equilibrium gap of morse (rbc, stiff) in lattice spacings"])

    def test_open_numerics_are_chosen_told_and_kept_with_the_run(self):
        scene = self.path / "open.json"
        scene.write_text((SOURCE / "tests/physics/scenes/auto-capsule.json").read_text())
        plan = json.loads(self.rouleau.run("plan", scene, "--json").stdout)
        chosen = {entry["pointer"]: entry for entry in plan["numerics_choice"]["values"]}
        self.assertEqual(set(chosen), {"/domain/nodes", "/cell_types/capsule/segments", "/numerics/tau", "/numerics/density_factor",
                                       "/numerics/coupling", "/numerics/slip_correction", "/numerics/area_correction"})
        for entry in chosen.values():
            self.assertTrue(entry["why"])
        self.assertIn("Numerics, chosen for an error of 1 % of the steady state", self.rouleau.run("plan", scene).stdout)
        runs = [self.path / "run", self.path / "again"]
        self.assertEqual(self.rouleau.run("run", scene, "--out", runs[0], *SHORT).returncode, 0)
        kept = json.loads((runs[0] / "scene.json").read_text())
        self.assertEqual(kept["domain"]["nodes"], chosen["/domain/nodes"]["value"])
        self.assertEqual(kept["numerics"]["density_factor"], chosen["/numerics/density_factor"]["value"])
        self.assertEqual(json.loads((runs[0] / "summary.json").read_text())["numerics_choice"], plan["numerics_choice"])
        # What was chosen is a scene that pins everything, and runs to the same bits.
        self.assertEqual(self.rouleau.run("run", runs[0] / "scene.json", "--out", runs[1], *SHORT).returncode, 0)
        self.assertEqual(*[(run / "cells.csv").read_bytes() for run in runs])
        self.assertEqual(json.loads((runs[1] / "summary.json").read_text())["numerics_choice"]["values"], [])
        # A target that is out of reach is told.
        pinned = self.rouleau.run("plan", scene, "--set", "/domain/nodes=[128,64]", "--set", "/numerics/auto/error=0.005")
        self.assertIn("the expected error is 0.65 %, more than the target of 0.5 %", pinned.stdout)

    def test_a_limit_that_is_passed_is_warned_of_with_name_value_limit_and_remedy(self):
        plan = json.loads(self.rouleau.run("plan", SCENE, "--json", "--set", "/numerics/tau=0.502").stdout)
        self.assertEqual(plan["warnings"], ["tau - 1/2 is 0.002, below its limit of 0.005; raise numerics.tau above 0.505"])
        self.assertIn("tau - 1/2", [limit["name"] for limit in plan["limits"]])

    def test_plan_gives_the_numbers_of_a_driven_flow_by_its_mean_shear_rate(self):
        # One stage driven by G between walls H apart has the numbers of walls that shear at G H / (4 mu).
        plan = lambda stage: json.loads(
            self.rouleau.run("plan", self.scene(stages=[stage], output={}), "--json").stdout)
        height, viscosity, gradient = 25.088e-6, 1.2e-3, 3000
        driven = plan({"name": "flow", "duration": 1, "pressure_gradient": gradient})["dimensionless"]
        sheared = plan({"name": "flow", "duration": 1, "shear_rate": gradient * height / (4 * viscosity)})["dimensionless"]
        for name in ("reynolds_physical", "reynolds_simulated", "capillary", "adhesion_number"):
            self.assertGreater(driven[name], 0)
            self.assertAlmostEqual(driven[name] / sheared[name], 1, delta=1e-12)

    def test_a_force_that_nothing_holds_is_warned_of_and_has_no_numbers(self):
        scene = self.scene(domain={"size": ["50.176 um", "25.088 um"], "nodes": [256, 128], "y": "periodic"},
                           stages=[{"name": "fall", "duration": "10 us", "pressure_gradient": "3 kPa/m"}],
                           output={})
        words = ("stage fall", "periodic along x and y", "gains 3 m/s every second", "3000 times as dense (numerics.density_factor), is 0.001 m/s", "domain.y")
        plan = json.loads(self.rouleau.run("plan", scene, "--json").stdout)
        self.assertTrue(all(word in plan["warnings"][0] for word in words), plan["warnings"])
        self.assertIsNone(plan["dimensionless"]["reynolds_physical"])
        result = self.rouleau.run("run", scene, "--out", self.path / "run", *SHORT)
        self.assert_stops(result, 0, *words)
        self.assertIn("stage fall", json.loads((self.path / "run" / "summary.json").read_text())["warnings"][0])

    def test_plan_says_which_rows_are_left_out_without_output_cells(self):
        left_out = lambda **changes: {o["what"]: o["why"] for o in json.loads(
            self.rouleau.run("plan", self.scene(output={}, **changes), "--json").stdout)["left_out"]}
        self.assertEqual(left_out()["rows of the tables and outlines between the ends of stages"],
                         "output.cells is not set; the start and the end of each stage are written")
        alone = left_out(cells=[], stages=[{"name": "shear", "shear_rate": "20 1/s", "strain": 1}])
        self.assertIn("rows of series.csv between the ends of stages", alone)

    def test_no_manifest_can_steer_the_terminal_of_who_lists_it(self):
        file = self.rouleau.plugins / "interaction/morse/morse.json"
        manifest = json.loads(file.read_text())
        for key in ("title", "author", "reference", "license"):
            manifest[key] = f"{key}\x1b[2J"
        manifest["parameters"][0]["doc"] = "doc\x1b[2J"
        file.write_text(json.dumps(manifest))
        broken = self.rouleau.plugins / "interaction/broken.json"
        broken.write_text(json.dumps({"manifest": 1, "id": "broken\x1b[2J"}))
        for arguments in ([], ["morse"]):
            result = self.rouleau.run("plugins", *arguments)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertIn("title\\u001b[2J", result.stdout)
            self.assertNotIn("\x1b", result.stdout + result.stderr)

    def test_plugins_lists_manifests_and_refused_ones_with_reason(self):
        (self.rouleau.plugins / "interaction/morse/morse.json").write_text('{"manifest": 1, "id": "morse"}')
        result = self.rouleau.run("plugins")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn("neo-hookean", result.stdout)
        self.assertIn("morse.json", result.stdout)
        detail = self.rouleau.run("plugins", "neo-hookean")
        self.assertIn("shear_modulus", detail.stdout)
        self.assertIn("N/m", detail.stdout)

    def test_a_run_leaves_every_file_of_the_contract(self):
        out = self.path / "run"
        result = self.rouleau.run("run", SCENE, "--out", out, "--quiet", "--set", "/stages/0/duration=0.02", "--set",
                                  "/stages/1/strain=0.3")
        self.assertEqual(result.returncode, 0, result.stderr)
        for name in ("summary.json", "cells.csv", "aggregates.csv", "frames.h5", "frames.xmf", "log.jsonl", "report.html"):
            self.assertTrue((out / name).stat().st_size > 0, name)
        summary = json.loads((out / "summary.json").read_text())
        for key in ("status", "steps", "strain", "simulated_time_s", "wall_s", "steps_per_s", "mlups", "peak_rss_bytes",
                    "threads", "precision", "git", "scene_sha256", "plugins", "passes", "left_out", "dimensionless",
                    "limits", "conservation", "aggregates_final", "aggregate_history"):
            self.assertIn(key, summary)
        header = (out / "cells.csv").read_text().splitlines()[0].split(",")
        for name in ("step", "time_s", "strain", "cell", "type", "x_m", "y_m", "angle_rad", "deformation", "area_m2",
                     "perimeter_m", "min_gap_m", "aggregate"):
            self.assertIn(name, header)
        for line in (out / "log.jsonl").read_text().splitlines():
            json.loads(line)
        self.assertEqual(self.rouleau.run("report", out).returncode, 0)

    def test_runs_are_compared_in_one_file(self):
        for name in "ab":
            self.assertEqual(self.rouleau.run("run", SCENE, "--out", self.path / name, *SHORT).returncode, 0)
        a, b = self.path / "a", self.path / "b"
        result = self.rouleau.run("report", "--compare", a, b, cwd=self.path)
        self.assertEqual((result.returncode, result.stdout), (0, "a-and-b.html\n"), result.stderr)
        self.assertIn("runs side by side", (self.path / "a-and-b.html").read_text())
        out = self.path / "c.html"
        self.assertEqual(self.rouleau.run("report", a, b, a, "--compare", "--out", out).stdout, f"{out}\n")
        self.assertEqual({f.name for f in self.path.iterdir()} - {"installation"}, {"a", "b", "a-and-b.html", "c.html"})

        (b / "summary.json").unlink()
        for arguments, words in (((a, b), (str(b), "has no summary.json")), ((a, self.path / "none"), (str(self.path / "none"), "is no directory")),
                                 ((a,), ("2 to 12 runs", "1 was given")), ((a,) * 13, ("2 to 12 runs", "13 were given"))):
            self.assert_stops(self.rouleau.run("report", "--compare", *arguments, cwd=self.path), 2, *words)
        self.assert_stops(self.rouleau.run("report", a, a), 2, "takes one directory", "--compare")
        self.assertEqual(self.rouleau.run("report", a, "--out", out).stdout, f"{out}\n")
        self.assertEqual(out.read_bytes(), (a / "report.html").read_bytes())
        for empty in (("report", a, "--out", ""), ("run", SCENE, "--out", ""), ("run", SCENE, "--lock", "")):
            self.assert_stops(self.rouleau.run(*empty, cwd=self.path), 2, f"{empty[-2]} is empty")
        self.assert_stops(self.rouleau.run("report", "--compare", a, a, "--out", self.path / "none/c.html"), 4, "none/c.html")

    def test_a_report_of_damaged_files_shows_the_rest_and_says_what_is_damaged(self):
        out = self.path / "run"
        self.assertEqual(self.rouleau.run("run", SCENE, "--out", out, "--max-steps", 2000, "--set", "/output/cells/strain=0.02").returncode, 0)
        kept = {name: (out / name).read_bytes() for name in ("cells.csv", "frames.h5")}
        for name, damage in (("frames.h5", lambda content: content[:len(content) // 2]), ("cells.csv", lambda content: content[:len(content) // 2])):
            with self.subTest(name):
                (out / name).write_bytes(damage(kept[name]))
                result = self.rouleau.run("report", out)
                self.assertEqual(result.returncode, 0, result.stderr)
                self.assertIn(f"warning: {out / name}", result.stderr)
                (out / name).write_bytes(kept[name])
        self.assertEqual(self.rouleau.run("report", out).stderr, "")

    def test_what_somebody_put_beside_a_run_stays(self):
        out = self.path / "run"
        short = ("run", SCENE, "--out", out, "--max-steps")
        self.assertEqual(self.rouleau.run(*short, 50).returncode, 0)
        (out / "figure.png").write_text("mine")
        for option in ("--resume", "--overwrite"):
            result = self.rouleau.run(*short, 100, option)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual((out / "figure.png").read_text(), "mine")
        self.assertEqual(json.loads((out / "summary.json").read_text())["resumed"], [])
        (out / "log.jsonl").unlink()
        for name in ("summary.json", "checkpoint.h5"):
            (out / name).unlink()
        self.assert_stops(self.rouleau.run(*short, 100, "--overwrite"), 2, "figure.png", "which no run wrote")

    def test_the_hash_of_the_scene_is_that_of_the_file_in_the_run_directory(self):
        for name, settings in (("as_written", []), ("changed", ["--set", "/title=changed"])):
            out = self.path / name
            self.assertEqual(self.rouleau.run("run", SCENE, "--out", out, *settings, *SHORT).returncode, 0)
            written = (out / "scene.json").read_bytes()
            self.assertEqual(json.loads((out / "summary.json").read_text())["scene_sha256"],
                             hashlib.sha256(written).hexdigest())
            if not settings:
                self.assertEqual(written, SCENE.read_bytes())

    def test_a_run_that_max_steps_cuts_short_says_so(self):
        out = self.path / "run"
        result = self.rouleau.run("run", SCENE, "--out", out, *SHORT)
        self.assertEqual(result.returncode, 0, result.stderr)
        summary = json.loads((out / "summary.json").read_text())
        self.assertEqual(summary["status"], "completed")
        words = f"cut short by the limit of steps at step 20 of at most {summary['steps_at_most']}"
        self.assertGreater(summary["steps_at_most"], 10000)
        self.assertEqual(summary["outcome"], words)
        self.assertTrue(result.stdout.startswith(words), result.stdout)

    def on_a_terminal(self, *arguments, **environment):
        """What a terminal of 80 columns shows of a run."""
        process, terminal = pty.fork()
        if process == 0:
            os.chdir(self.path)
            os.environ.update({"TERM": "xterm", **environment})
            os.execv(self.rouleau.program, [str(self.rouleau.program), "run", str(SCENE), "--overwrite", *arguments])
        shown = b""
        try:
            while part := os.read(terminal, 65536):
                shown += part
        except OSError:
            pass  # how Linux says that the other end is closed
        os.close(terminal)
        _, status = os.waitpid(process, 0)
        return os.waitstatus_to_exitcode(status), shown.decode().replace("\r\n", "\n")

    def test_a_run_says_what_it_will_compute_and_what_came_out_with_colours_on_a_terminal_alone(self):
        os.environ.pop("NO_COLOR", None)
        code, shown = self.on_a_terminal("--max-steps", "20")
        self.assertEqual(code, 0, shown)
        self.assertTrue(shown.startswith("Four red cells gather into a rouleau and are sheared at 20 1/s\n"
                                         "  50.2 x 25.1 um, 256 x 128 nodes, 4 cells; stages: aggregate, shear\n"), shown)
        self.assertRegex(shown, r"\x1b\[32mcut short by the limit of steps at step 20 .*\x1b\[0m\n"
                                r"the cells never join: all 4 stay single\nlargest area drift .*\nreport: runs/\S+/report.html\n$")
        code, shown = self.on_a_terminal("--set", "/fluid/viscosity=1 m")
        self.assertEqual(code, 2, shown)
        self.assertRegex(shown, r"^\x1b\[31m.* /fluid/viscosity\x1b\[0m\n")
        for plain in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
            self.assertNotIn("\x1b[3", self.on_a_terminal("--max-steps", "20", **plain)[1])
        result = self.rouleau.run("run", SCENE, "--max-steps", "20", "--overwrite", cwd=self.path)
        self.assertNotIn("\x1b", result.stdout + result.stderr)
        self.assertIn("\n  into runs/four-cells-shear\n", result.stderr)

    def test_no_run_is_lost_to_a_later_one(self):
        scene = self.scene()
        for expected in ("scene", "scene-2", "scene-3"):
            result = self.rouleau.run("run", scene, *SHORT, cwd=self.path)
            self.assertEqual(result.returncode, 0, result.stderr)
            self.assertEqual(result.stdout.splitlines()[-1], f"report: runs/{expected}/report.html")
        before = (self.path / "runs/scene/summary.json").read_bytes()
        again = ("run", scene, "--out", self.path / "runs/scene", *SHORT)
        self.assert_stops(self.rouleau.run(*again), 2, str(self.path / "runs/scene"), "--overwrite", "--out")
        self.assertEqual((self.path / "runs/scene/summary.json").read_bytes(), before)
        self.assertEqual(self.rouleau.run(*again, "--overwrite").returncode, 0)
        self.assertNotEqual((self.path / "runs/scene/summary.json").read_bytes(), before)
        self.assertEqual(self.rouleau.run("run", scene, "--overwrite", *SHORT, cwd=self.path).returncode, 0)
        self.assertFalse((self.path / "runs/scene-4").exists())

    def test_a_scene_that_cannot_start_leaves_no_directory(self):
        result = self.rouleau.run("run", self.scene(), "--set", '/cells/0/row/spacing="1 um"', cwd=self.path)
        self.assert_stops(result, 2, "overlap")
        self.assertFalse((self.path / "runs").exists())

    @whole_runs
    def test_bits_do_not_depend_on_threads(self):
        tables = []
        for threads in (1, 2):
            out = self.path / str(threads)
            result = self.rouleau.run("run", SCENE, "--out", out, "--quiet", "--threads", threads, "--set",
                                      "/stages/0/duration=0.02", "--set", "/stages/1/strain=0.1")
            self.assertEqual(result.returncode, 0, result.stderr)
            tables.append((out / "cells.csv").read_bytes() + (out / "series.csv").read_bytes())
        self.assertEqual(tables[0], tables[1])

    def test_an_interrupted_run_says_so_and_keeps_what_it_has(self):
        out = self.path / "run"
        process = subprocess.Popen([self.rouleau.program, "run", SCENE, "--out", out, "--quiet"],
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        for _ in range(200):
            if (out / "cells.csv").exists():
                break
            time.sleep(0.05)
        time.sleep(0.5)
        process.send_signal(signal.SIGTERM)
        _, errors = process.communicate(timeout=60)
        self.assertEqual(process.returncode, 130, errors)
        self.assertEqual(json.loads((out / "summary.json").read_text())["status"], "interrupted")


class Words_on_a_terminal(Case):
    def test_fit_its_columns_and_no_word_is_broken(self):
        words = [["--help"], *([command, "--help"] for command in ("run", "plan", "plugins", "conform", "new", "study", "limits", "verify", "report")),
                 ["plan", SCENE], ["plan", SOURCE / "scenes/red-cell-3d.json"], ["plan", SCENE, "--set", "/numerics/density_factor=300000"], ["plugins"]]
        for arguments in words:
            texts = {columns: self.rouleau.run(*arguments, env={"COLUMNS": str(columns)}).stdout for columns in (80, 300)}
            with self.subTest(arguments):
                self.assertEqual(texts[80].split(), texts[300].split())
                for columns in (80, 300):
                    long = [line for line in texts[columns].splitlines() if len(line) > min(columns, 100) and len(line.split()) > 1]
                    self.assertEqual(long, [])

    def test_of_plugins_have_paths_on_request(self):
        short, long = (self.rouleau.run("plugins", *options).stdout for options in ((), ("--paths",)))
        manifests = sum(str(self.rouleau.plugins / "interaction") in line for line in long.splitlines())
        self.assertEqual(manifests, len(list((self.rouleau.plugins / "interaction").glob("*/*.json"))))
        self.assertNotIn("morse.json", short)


class Names_are_no_more_than_names(Case):
    def test_no_stage_is_a_formula_in_a_spreadsheet(self):
        for name in ("=1+1", "+1", "-shear", "@SUM(A1)"):
            with self.subTest(name):
                stages = json.loads(SCENE.read_text())["stages"]
                stages[0]["name"] = name
                self.assert_stops(self.rouleau.run("plan", self.scene(stages=stages)), 2, "/stages/0/name", "formula", "letter or digit")

    def test_a_scene_without_a_name_wants_out(self):
        for name in ("..json", "...json"):
            with self.subTest(name):
                file = self.path / name
                shutil.copy(SCENE, file)
                before = sorted(self.path.rglob("*"))
                self.assert_stops(self.rouleau.run("run", name, "--max-steps", "3", cwd=self.path), 2, "--out")
                for command in ("study", "limits"):
                    self.assertNotEqual(self.rouleau.run(command, name, cwd=self.path).returncode, 0)
                self.assertEqual(sorted(self.path.rglob("*")), before)
                self.assertEqual(self.rouleau.run("run", name, "--out", "named", *SHORT, cwd=self.path).returncode, 0)
                shutil.rmtree(self.path / "named")
                file.unlink()


class Cells_that_nothing_attracts(Case):
    WORDS = re.compile(r"rouleau(x| of)|aggregat|joined|broke|single cells", re.IGNORECASE)

    @whole_runs
    def test_are_close_and_no_more_in_what_a_run_says(self):
        scene = json.loads(SCENE.read_text())
        row = {"type": "rbc", "row": {**scene["cells"][0]["row"], "spacing": "3.0 um"}}
        stages = [{"name": "rest", "duration": "0.002 s"}, {"name": "shear", "shear_rate": "20 1/s", "strain": 0.05, "start": "developed"}]
        often = {"cells": {"seconds": "0.0005 s"}}
        for interactions in ([], [{**scene["interactions"][0], "parameters": {"depth": 0}}],
                             [{"between": ["rbc", "rbc"], "model": "repulsion", "parameters": {"strength": "1e-7 J/m2"}}]):
            with self.subTest(interactions):
                file = self.scene(title="without", cells=[row], interactions=interactions, stages=stages, output=often)
                shutil.rmtree(self.path / "run", ignore_errors=True)
                result = self.rouleau.run("run", file, "--out", self.path / "run")
                self.assertEqual(result.returncode, 0, result.stderr)
                summary = json.loads((self.path / "run/summary.json").read_text())
                self.assertEqual(summary["contacts"], {"close_below_m": 7.5e-7, "attracting": []})
                self.assertEqual([stage["dissociation"] for stage in summary["rheology"]], [[], []])
                said = result.stdout + result.stderr
                self.assertIn("4 of 4 cells were close, with gaps below 0.75 um; nothing attracts them", said)
                self.assertIsNone(self.WORDS.search(said), said)

    def test_are_joined_where_a_well_is_between_them(self):
        file = self.scene(stages=[{"name": "rest", "duration": "0.002 s"}], output={"cells": {"seconds": "0.0005 s"}, "aggregate_gap": "2 um", "bond_share": 0.05})
        result = self.rouleau.run("run", file, "--out", self.path / "run")
        self.assertIn("rouleau of 4 from the start; still whole at the end", result.stdout + result.stderr)
        summary = json.loads((self.path / "run/summary.json").read_text())
        self.assertEqual(summary["contacts"], {"close_below_m": 2e-6, "attracting": [["rbc", "rbc"]]})


class Documents_tell_what_is_so(Case):
    def test_the_example_of_a_scene_runs_without_a_warning(self):
        text = (SOURCE / "docs/scene.md").read_text()
        example = re.search(r"^    \{\n(?:    .*\n)+?    \}\n", text, re.MULTILINE).group(0)
        scene = self.path / "one-cell.json"
        scene.write_text(example)
        plan = self.rouleau.run("plan", scene, "--json")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        self.assertEqual(json.loads(plan.stdout)["warnings"], [])
        out = self.path / "run"
        self.assertEqual(self.rouleau.run("run", scene, "--out", out, "--quiet").returncode, 0)
        self.assertEqual(json.loads((out / "summary.json").read_text())["aggregates_final"], 1)

    def test_every_form_of_cells_in_it_is_accepted(self):
        entries = re.findall(r'^    (\{"type": "rbc".*\})$', (SOURCE / "docs/scene.md").read_text(), re.MULTILINE)
        self.assertEqual(len(entries), 4)
        for entry in entries:
            scene = self.scene(cells=[json.loads(entry)])
            self.assertEqual(self.rouleau.run("plan", scene).returncode, 0, entry)

    def test_every_key_of_a_scene_is_in_its_document(self):
        text = (SOURCE / "docs/reference/scene.md").read_text()

        def keys(rule):
            if isinstance(rule, dict):
                for key in rule.get("properties", {}):
                    yield key
                for value in rule.values():
                    yield from keys(value)
            elif isinstance(rule, list):
                for value in rule:
                    yield from keys(value)

        for key in set(keys(json.loads((SOURCE / "host/scene/scene.schema.json").read_text()))):
            self.assertTrue(re.search(rf"/{re.escape(key)}`|^## {re.escape(key)}$", text, re.MULTILINE), key)

    def test_every_column_key_and_log_event_of_a_run_is_in_its_document(self):
        text = "".join(page.read_text() for page in (SOURCE / "docs").glob("output*.md"))
        out = self.path / "run"
        self.assertEqual(self.rouleau.run("run", SCENE, "--out", out, *SHORT).returncode, 0)
        names = set()
        for table in ("cells", "aggregates", "series"):
            names |= set((out / f"{table}.csv").read_text().splitlines()[0].split(","))

        def add(value):
            if isinstance(value, dict):
                for key, part in value.items():
                    names.add(key)
                    add(part)
            elif isinstance(value, list) and value:
                add(value[0])

        add(json.loads((out / "summary.json").read_text()))
        for line in (out / "log.jsonl").read_text().splitlines():
            names |= set(json.loads(line)) | {json.loads(line)["event"]}
        for name in names:
            # A key may stand within a path: `failure.reason`, `stages[].name`.
            self.assertTrue(re.search(rf"`(?:\w+(?:\[\])?\.)*{re.escape(name)}(?:\[\])?[.`]", text), name)


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
