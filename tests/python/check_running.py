"""rouleau.run, plan, plugins and sweep: the program's results, faults as exceptions, progress, interruption."""

import decimal
import fractions
import json
import os
import pathlib
import shutil
import signal
import subprocess
import tempfile

from package import BUILD, SOURCE, Case, main, need, small_scene

need("numpy", "pandas")

import numpy  # noqa: E402
import rouleau  # noqa: E402
from rouleau.means import mean_of_seeds  # noqa: E402
from rouleau.scenes import hashes_of_files, scene_file  # noqa: E402
from rouleau.sweeping import places_of_seeds  # noqa: E402

SCENE = SOURCE / "scenes/four-cells-shear.json"


class In_a_folder(Case):
    """Where runs/ may be made."""

    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.path)


class A_run(In_a_folder):
    def test_has_the_bytes_that_the_program_writes(self):
        rouleau.run(small_scene(), "python", progress=False)
        pathlib.Path("small.json").write_text(json.dumps(small_scene()))
        subprocess.run([BUILD / "bin/rouleau", "run", "small.json", "--out", "program", "--quiet"], check=True, capture_output=True)
        for name in ("cells.csv", "series.csv", "aggregates.csv"):
            self.assertEqual(pathlib.Path("python", name).read_bytes(), pathlib.Path("program", name).read_bytes())

    def test_takes_changes_with_dots_and_with_slashes_and_values_of_numpy(self):
        run = rouleau.run(small_scene(), max_steps=10, progress=False, **{
            "fluid.viscosity": "2 cP", "/stages/1/strain": numpy.float64(1.5), "cells.0.at": ["2 um", "8 um"], "title": "changed"})
        self.assertEqual(run.scene.fluid.viscosity, "2 cP")
        self.assertEqual(run.scene.stages[1].strain, 1.5)
        self.assertEqual((run.scene.title, run.summary.steps), ("changed", 10))
        self.assertAlmostEqual(run.cells["x_m"][0], 2e-6, delta=1e-9)

    def test_goes_into_the_first_free_directory(self):
        names = [rouleau.run(small_scene(), max_steps=1, progress=False).directory for _ in range(2)]
        self.assertEqual(names, [pathlib.Path("runs/scene"), pathlib.Path("runs/scene-2")])

    def test_warns_as_the_program_does(self):
        with self.assertWarnsRegex(UserWarning, "cell radius in lattice spacings"):
            rouleau.run(small_scene(), max_steps=1, progress=False)

    def test_tells_how_far_it_has_come(self):
        seen = []
        rouleau.run(SCENE, "run", max_steps=6000, progress=seen.append)
        self.assertEqual({now.stage for now in seen}, {"aggregate"})
        self.assertTrue(all(a.step <= b.step and a.fraction <= b.fraction for a, b in zip(seen, seen[1:])))
        self.assertLessEqual(seen[-1].fraction, 6000 / 100920)


class Interrupting(In_a_folder):
    def test_saves_a_checkpoint_from_which_the_run_goes_on(self):
        scene = json.loads(SCENE.read_text())
        scene["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 1.5}]
        interrupted = rouleau.run(scene, "run", progress=lambda now: os.kill(os.getpid(), signal.SIGINT))
        self.assertEqual(interrupted.status, "interrupted")
        self.assertLess(interrupted.summary.strain, 1.5)
        done = rouleau.run(scene, "run", resume=True, progress=False)
        self.assertEqual((done.status, len(done.summary.resumed)), ("completed", 1))
        whole = rouleau.run(scene, "whole", progress=False)
        self.assertEqual((done.directory / "cells.csv").read_bytes(), (whole.directory / "cells.csv").read_bytes())


class Faults(In_a_folder):
    def let_the_program_be(self, program):
        self.addCleanup(os.environ.__setitem__, "ROULEAU", os.environ["ROULEAU"])
        os.environ["ROULEAU"] = program

    def test_have_place_and_remedy(self):
        pathlib.Path("bad.json").write_text('{\n  "rouleau": 1,\n  "fluid": {"density": "1 g/cm3", "viscosity": 1.2}\n}\n')
        error = self.assert_refused("bad.json:3:48 /fluid/viscosity", rouleau.run, "bad.json")
        self.assertEqual(error.exit_code, 2)
        fault = next(fault for fault in error.faults if fault.pointer == "/fluid/viscosity")
        self.assertEqual((fault.file, fault.line, fault.column), ("bad.json", 3, 48))
        self.assertIn("1.2 has no unit", fault.problem)
        self.assertIn("write it with the unit that is meant", fault.problem)
        self.assertEqual({fault.pointer for fault in error.faults if "missing" in fault.problem}, {None})
        self.assertFalse(pathlib.Path("runs").exists())

    def test_of_a_dictionary_or_a_change_have_a_pointer_and_no_file(self):
        error = self.assert_refused('"6 Pa" is a pressure', rouleau.plan, small_scene(), **{"fluid.viscosity": "6 Pa"})
        self.assertEqual((error.file, error.line, error.pointer), (None, None, "/fluid/viscosity"))
        error = self.assert_refused('unknown key "speed"', rouleau.run, small_scene(speed=1))
        self.assertEqual((error.file, error.pointer), (None, "/speed"))

    def test_of_a_run_that_diverged_bring_the_run(self):
        error = self.assert_refused("diverged", rouleau.run, small_scene(), "run", progress=False, **{"numerics.tau": 30})
        self.assertEqual((error.exit_code, error.run.status), (1, "diverged"))
        self.assertEqual(error.remedy, error.run.summary.failure.remedy)

    def test_of_directories_that_are_taken_name_them(self):
        rouleau.run(small_scene(), "run", max_steps=1, progress=False)
        error = self.assert_refused("run", rouleau.run, small_scene(), "run")
        self.assertIn("--overwrite", error.remedy)
        rouleau.run(small_scene(), "run", max_steps=1, progress=False, overwrite=True)

    def test_of_a_missing_program_say_how_to_name_one(self):
        self.let_the_program_be("/no/program")
        self.assert_refused("let it name the program", rouleau.plan, SCENE)

    def test_of_a_finer_run_leave_the_first_one_and_warn(self):
        program = self.path / "program"  # in place of one whose first run misses its target, and whose finer run diverges
        program.write_text("""#!/bin/sh
mkdir run && echo '{"status": "completed", "warnings": []}' > run/summary.json && echo '{}' > run/scene.json; exit 1
""")
        program.chmod(0o755)
        self.let_the_program_be(str(program))
        with self.assertWarnsRegex(UserWarning, "run/refined failed; what the first one found stands"):
            self.assertEqual(rouleau.run(small_scene(), "run", progress=False).status, "completed")

    def test_of_what_cannot_stand_in_a_scene_name_it(self):
        loop = []
        loop.append(loop)
        for value in (object(), float("nan"), decimal.Decimal("nan"), b"1", 1j, {1}, loop, Odd(), {(1, 2): 3}):
            error = self.assert_refused("cannot stand in a scene", rouleau.plan, small_scene(), title=value)
            self.assertEqual(error.pointer, "/title")
        for scene in (None, 3, ["a"]):
            for call in (rouleau.plan, rouleau.run, lambda scene: rouleau.sweep(scene, {"title": ["a"]})):
                self.assert_refused("is no scene", call, scene)
        for words in ({"threads": "2"}, {"threads": 0}, {"max_steps": 2.5}, {"max_steps": -1}):
            self.assert_refused(f"{list(words)[0]} is", rouleau.run, small_scene(), "run", **words)
        for values in ([], "20 1/s", 20):
            self.assert_refused("title has the values", rouleau.sweep, small_scene(), {"title": values})
        self.assert_refused("give values by name", rouleau.sweep, small_scene(), ["title"])
        self.assert_refused("workers is -1", rouleau.sweep, small_scene(), {"title": ["a"]}, workers=-1)

    def test_of_a_program_that_does_not_start_or_answer_are_told(self):
        pathlib.Path("rouleau").write_text("#!/nowhere\n")
        pathlib.Path("rouleau").chmod(0o755)
        self.let_the_program_be(str(pathlib.Path("rouleau").resolve()))
        for call in (rouleau.plan, rouleau.run):
            self.assertEqual(self.assert_refused("could not be started", call, small_scene()).exit_code, 4)
        pathlib.Path("rouleau").write_text("#!/bin/sh\nexit 0\n")
        self.assertEqual(self.assert_refused("has not answered in JSON", rouleau.plan, small_scene()).exit_code, 4)

    def test_of_a_place_for_temporary_files_name_the_variable(self):
        before, tempfile.tempdir = tempfile.tempdir, "/nowhere"
        self.addCleanup(setattr, tempfile, "tempdir", before)
        self.assertIn("TMPDIR", self.assert_refused("no place for a scene", rouleau.plan, small_scene()).remedy)


class Odd:
    @property
    def tolist(self):
        raise RuntimeError("inside")


class Unit:
    """As pint has them."""
    dimensionality = {}

    def __init__(self, words):
        self.words = words

    def __format__(self, how):
        return {"C": self.words}[how]


class Quantity:
    def __init__(self, magnitude, words):
        self.magnitude, self.units = magnitude, Unit(words)


class Values(Case):
    def test_of_other_packages_mean_what_they_say(self):
        def numbers(scene, **changes):
            return [row.si for row in rouleau.plan(scene, **changes).conversions]

        wanted = numbers(small_scene())
        for key, values in {
                "stages.1.shear_rate": [20, numpy.float32(20), numpy.int64(20), numpy.array(20.0), decimal.Decimal("20"),
                                        fractions.Fraction(40, 2), Quantity(numpy.float64(20), "1/second")],
                "fluid.viscosity": [Quantity(1.2, "millipascal*second"), decimal.Decimal("1.2e-3")],
                "fluid.density": [Quantity(1.0, "gram/centimeter**3"), 1000],
                "domain.size": [Quantity(numpy.array([24.0, 16.0]), "micrometer"), (24e-6, 16e-6)],
                "domain.nodes": [numpy.array([48, 32]), range(48, 31, -16)],
                "numerics.density_factor": [Quantity(2000.0, "dimensionless")],
                "cells.0.at": [[Quantity(1, "micrometer"), Quantity(8.0, "micrometer")]]}.items():
            for value in values:
                numpy.testing.assert_allclose(numbers(small_scene(), **{key: value}), wanted, rtol=1e-12)
        fluid = {"density": Quantity(1.0, "gram/centimeter**3"), "viscosity": "1.2 cP"}
        self.assertEqual(numbers(small_scene(fluid=fluid)), wanted)

    def test_of_time_may_be_quantities(self):
        run = rouleau.run(small_scene(), self.path / "run", max_steps=numpy.int64(2), threads=numpy.int64(1),
                          max_time=Quantity(5.0, "minute"))
        self.assertEqual(run.summary.steps, 2)


class Under_a_launcher(In_a_folder):
    """What each of several processes of Python calls that mpirun or srun has started."""

    def test_each_process_computes_by_itself(self):
        for rank in ("0", "1"):
            os.environ.update(OMPI_COMM_WORLD_RANK=rank, OMPI_COMM_WORLD_SIZE="2")
            self.addCleanup(os.environ.pop, "OMPI_COMM_WORLD_RANK", None)
            self.addCleanup(os.environ.pop, "OMPI_COMM_WORLD_SIZE", None)
            self.assertGreater(rouleau.plan(small_scene()).estimate.wall_s, 0)
            self.assertGreater(len(rouleau.plugins()), 5)
            self.assertEqual(rouleau.run(small_scene(), f"run{rank}", max_steps=2, progress=False).summary.steps, 2)


class A_plan(Case):
    def test_has_numbers_and_tables(self):
        plan = rouleau.plan(SCENE, **{"fluid.viscosity": "2.4 cP"})
        self.assertAlmostEqual(plan.dimensionless.capillary, 2 * rouleau.plan(SCENE).dimensionless.capillary, delta=1e-12)
        table = plan.table("conversions")
        viscosity = table[(table["quantity"] == "viscosity") & (table["stage"] == "shear")]
        self.assertEqual(list(viscosity["si"]), [2.4e-3])
        self.assertIn("within all limits", repr(rouleau.plan(SCENE)))
        self.assertIn("beyond its limits: ", repr(rouleau.plan(SCENE, **{"numerics.tau": 7})))


class Plugins(Case):
    def test_are_those_of_the_program(self):
        table = rouleau.plugins()
        self.assertEqual(table.loc["morse", "kind"], "interaction")
        self.assertIn("depth", [p["name"] for p in table.loc["morse", "parameters"]])


class A_sweep(In_a_folder):
    def test_has_a_row_for_each_combination_with_values_and_error_bars(self):
        table = rouleau.sweep(small_scene(), {"/stages/1/shear_rate": ["10 1/s", "20 1/s"], "numerics.tau": [0.8, 1.0]},
                              out="sweep", workers=2, progress=False)
        self.assertEqual([*zip(table["shear_rate"], table["tau"])],
                         [("10 1/s", 0.8), ("10 1/s", 1.0), ("20 1/s", 0.8), ("20 1/s", 1.0)])
        self.assertEqual(set(table["status"]), {"completed"})
        for _, row in table.iterrows():
            run = rouleau.open(row["directory"])
            self.assertEqual((run.scene.stages[1].shear_rate, run.scene.numerics.tau), (row["shear_rate"], row["tau"]))
            # So short a run has no steady part: a plain mean, of which no error is known.
            told = run.summary.rheology[-1]
            self.assertIsNone(told.statistics["relative_viscosity"]["mean"])
            self.assertAlmostEqual(row["relative_viscosity"] / told.means["relative_viscosity"]["mean"], 1, delta=1e-12)
            self.assertTrue(numpy.isnan(row["relative_viscosity_error"]))

    def test_runs_nothing_twice_and_what_is_new(self):
        over = {"/stages/1/shear_rate": ["10 1/s"]}
        first = rouleau.sweep(small_scene(), over, out="sweep", progress=False)
        again = rouleau.sweep(small_scene(), {"/stages/1/shear_rate": ["20 1/s", "10 1/s"]}, out="sweep", progress=False)
        self.assertEqual(again["wall_s"][1], first["wall_s"][0])
        self.assertEqual(again["directory"][1], first["directory"][0])
        other = rouleau.sweep(small_scene(), over, out="sweep", progress=False, **{"fluid.viscosity": "2 cP"})
        self.assertNotEqual(other["directory"][0], first["directory"][0])
        written = pathlib.Path(first["directory"][0], "summary.json").stat().st_mtime_ns
        rouleau.sweep(small_scene(), over, out="sweep", progress=False, fresh=True)
        self.assertGreater(pathlib.Path(first["directory"][0], "summary.json").stat().st_mtime_ns, written)

    def test_runs_again_what_has_another_file_whose_name_begins_with_the_working_folder(self):
        table = pathlib.Path("cells.csv")
        scene = small_scene(cells={"file": "cells.csv"})
        rows = ["type;x_um;y_um;angle_deg", "rbc;1;8;90", "rbc;5;8;90"]
        results = []
        for last in ("rbc;5;8;90", "rbc;5;8;90", "rbc;6,5;8;90"):
            table.write_text("\n".join([*rows[:2], last]))
            results.append(rouleau.sweep(scene, {"/stages/1/shear_rate": ["20 1/s"]}, out="sweep", progress=False))
        first, again, other = (str(result["directory"][0]) for result in results)
        self.assertEqual(first, again)
        self.assertNotEqual(first, other)
        self.assertAlmostEqual(rouleau.open(other).cells["x_m"][1], 6.5e-6, delta=1e-12)
        self.assertEqual(rouleau.open(first).scene.cells.file, str(table.resolve()))
        changed = rouleau.plan(small_scene(), **{"/cells": {"file": "cells.csv"}})
        self.assertIn("small", repr(changed))
        self.assertEqual(len(rouleau.Simulation(scene).cells()), 2)

    def test_knows_the_files_of_every_layer_of_a_picture(self):
        for name in "ab":
            pathlib.Path(f"{name}.png").write_bytes(name.encode())
        scene = {"domain": {"obstacles": [{"image": {"file": ["a.png", "b.png"], "pixel": "1 um"}}]}}
        before = hashes_of_files(scene, {})
        self.assertEqual(len(before), 2)
        pathlib.Path("b.png").write_bytes(b"c")
        self.assertNotEqual(hashes_of_files(scene, {})[1], before[1])
        with scene_file(scene) as path:
            files = json.loads(path.read_text())["domain"]["obstacles"][0]["image"]["file"]
        self.assertEqual(files, [str(self.path / "a.png"), str(self.path / "b.png")])

    def test_runs_anew_what_another_library_computed(self):
        plugin = pathlib.Path("morse").resolve()
        shutil.copytree(BUILD / "lib/rouleau/plugins/interaction/morse", plugin)
        made = [plugin / "morse.json", plugin / "libmorse.so"]
        for file in made:  # another id of the same length
            file.write_bytes(file.read_bytes().replace(b'"morse"', b'"norse"').replace(b"\0morse\0", b"\0norse\0"))
        scene = small_scene(plugin_dirs=[str(plugin)])
        scene["interactions"][0]["model"] = "norse"

        def swept():
            table = rouleau.sweep(scene, {"stages.1.strain": [0.02]}, out="sweep", workers=1, progress=False)
            return os.stat(table.directory[0] + "/summary.json").st_mtime_ns

        first = swept()
        self.assertEqual(swept(), first)
        with open(made[1], "ab") as library:
            library.write(b"x")  # the loader does not mind
        self.assertNotEqual(swept(), first)

    def test_goes_on_where_runs_diverge(self):
        table = rouleau.sweep(small_scene(), {"numerics.tau": [1, 30]}, out="sweep", progress=False)
        self.assertEqual(list(table["status"]), ["completed", "diverged"])
        self.assertTrue(numpy.isnan(table["deformation"][1]))

    def test_measures_what_it_is_asked_for(self):
        table = rouleau.sweep(small_scene(), {"numerics.tau": [1]}, out="sweep", progress=False,
                              measure=lambda run: {"turned": run.pivot("angle_rad").iloc[-1].max()})
        self.assertEqual(list(table.columns), ["tau", "status", "turned", "wall_s", "directory"])

    def test_has_numbers_with_their_unit_beside_what_was_given(self):
        table = rouleau.sweep(small_scene(), {"stages.1.shear_rate": ["10 1/s", "2e1 1/s"], "fluid.density": [1000],
                                              "fluid.viscosity": ["1.2 cP", "1.2e-3 Pa s"]}, out="sweep", progress=False,
                              measure=lambda run: {}, **{"stages.1.strain": 0.02})
        self.assertEqual(list(table["shear_rate_1_per_s"]), [10, 10, 20, 20])
        self.assertNotIn("viscosity_cP", table)  # in two units: as they were given
        self.assertEqual(set(table["density"]), {1000})

    def test_has_measured_error_bars_where_they_are_asked_for(self):
        table = rouleau.sweep(small_scene(cells=small_scene()["cells"][:1]), {"numerics.tau": [1]}, out="sweep", progress=False,
                              error_bars=True)
        bars = json.loads(pathlib.Path(table["directory"][0], "summary.json").read_text())["error_bars"]
        self.assertEqual((table["deformation"][0], table["deformation_error"][0]),
                         (bars["deformation"]["value"], bars["deformation"]["error"]))

    def test_that_is_interrupted_goes_on_where_it_was(self):
        long = {"/stages/1/strain": [200, 201]}  # seconds, also on a fast machine
        asked = []

        def interrupt_once(now):
            if not asked:
                asked.append(now)
                os.kill(os.getpid(), signal.SIGINT)

        with self.assertRaises(KeyboardInterrupt):
            rouleau.sweep(small_scene(), long, out="sweep", workers=2, progress=interrupt_once)
        begun = [rouleau.open(directory).status for directory in pathlib.Path("sweep").iterdir()]
        self.assertIn("interrupted", begun)
        table = rouleau.sweep(small_scene(), long, out="sweep", workers=2, progress=False)
        self.assertEqual(list(table["status"]), ["completed", "completed"])
        self.assertTrue(any(rouleau.open(directory).summary.resumed for directory in table["directory"]))

    def test_with_bad_input_ends_with_its_fault(self):
        self.assert_refused('unknown unit "1/x"', rouleau.sweep, small_scene(),
                            {"/stages/1/shear_rate": ["10 1/s", "20 1/x"]}, out="sweep", progress=False)


class A_sweep_with_seeds(In_a_folder):
    SCENE = small_scene(cells=[{"type": "rbc", "random": {"hematocrit": 0.2, "seed": 7}}])
    OVER = {"/stages/1/shear_rate": ["10 1/s", "40 1/s"]}

    def test_has_means_over_the_seeds_with_both_kinds_of_errors(self):
        table = rouleau.sweep(self.SCENE, self.OVER, seeds=[1, 2, 3], out="sweep", workers=2, progress=False)
        self.assertEqual([*zip(table["shear_rate_1_per_s"], table["runs"], table["status"])], [(10, 3, "completed"), (40, 3, "completed")])
        for _, row in table.iterrows():
            runs = [rouleau.open(directory) for directory in row["directories"]]
            self.assertEqual([run.scene.cells[0].random.seed for run in runs], [1, 2, 3])
            values, errors = zip(*(run.results.loc["relative_viscosity", ["value", "error"]] for run in runs))
            self.assertAlmostEqual(row["relative_viscosity"], numpy.mean(values), delta=1e-12)
            self.assertAlmostEqual(row["relative_viscosity_error_between"], numpy.std(values, ddof=1) / 3 ** 0.5, delta=1e-12)
            self.assertTrue(numpy.isnan(errors).all() and numpy.isnan(row["relative_viscosity_error_within"]))  # too short for any
            self.assertEqual(row["relative_viscosity_error"], row["relative_viscosity_error_between"])
            self.assertAlmostEqual(row["relative_viscosity_bar95"], 4.302653 * row["relative_viscosity_error"], delta=1e-6)
            self.assertTrue(numpy.isnan(row["deformation_error_within"]))
        written = {path: path.stat().st_mtime_ns for path in pathlib.Path("sweep").glob("*/summary.json")}
        again = rouleau.sweep(self.SCENE, self.OVER, seeds=[3, 1, 2, 4], out="sweep", progress=False)
        self.assertEqual(list(again["runs"]), [4, 4])
        self.assertEqual(written, {path: path.stat().st_mtime_ns for path in written})
        page = pathlib.Path("sweep/sweep.html").read_text()
        for words in ("2 combinations, 8 runs", "95 % intervals", "<svg", "relative viscosity", "/report.html"):
            self.assertIn(words, page)
        self.assertNotIn("http", page)
        lines = pathlib.Path("sweep/sweep.csv").read_text().splitlines()
        self.assertEqual(len(lines), 3)
        self.assertIn("relative_viscosity_bar95", lines[0])
        self.assertEqual(len(pathlib.Path("sweep/sweep-runs.csv").read_text().splitlines()), 9)

    def test_finds_every_seed_also_of_changes(self):
        domain = {"x": {"lower": {"inlet": {"mean_velocity": "1 mm/s", "cells": {"type": "rbc", "hematocrit": 0.2}}}}}
        self.assertEqual(places_of_seeds({"cells": [{"random": {}}, {"at": [0, 0]}, {"random": {}}], "domain": domain}, {}),
                         ["/cells/0/random/seed", "/cells/2/random/seed", "/domain/x/lower/inlet/cells/seed"])
        self.assertEqual(places_of_seeds({}, {"cells.1": {"random": {}}}), ["/cells/1/random/seed"])

    def test_is_refused_where_seeds_change_nothing(self):
        self.assert_refused("nothing in this scene depends on a seed", rouleau.sweep, small_scene(), self.OVER, seeds=[1, 2])
        self.assert_refused("seeds are given, too", rouleau.sweep, self.SCENE, {"cells.0.random.seed": [1]}, seeds=[1, 2])
        self.assert_refused("each of them once", rouleau.sweep, self.SCENE, self.OVER, seeds=[1, 1])
        self.assert_refused("a seed is -1", rouleau.sweep, self.SCENE, self.OVER, seeds=[-1])

    def test_averages_those_that_completed(self):
        table = rouleau.sweep(self.SCENE, {"numerics.tau": [1, 30]}, seeds=[1, 2], out="sweep", progress=False,
                              measure=lambda run: {"x": rouleau.Mean(run.scene.cells[0].random.seed, 0.25)})
        self.assertEqual([*zip(table["status"], table["runs"])], [("completed", 2), ("diverged", 0)])
        self.assertEqual((table["x"][0], table["x_error"][0], table["x_error_within"][0]), (1.5, 0.5, 0.125 * 2 ** 0.5))
        self.assertTrue(numpy.isnan(table["x"][1]))


class Means_over_seeds(Case):
    def test_have_bars_that_hold_what_single_runs_do_not_know(self):
        mean = mean_of_seeds([1.963, 2.376], [0.005, 0.009])
        self.assertAlmostEqual(mean.value, 2.1695, delta=1e-12)
        self.assertAlmostEqual(mean.error, 0.2065, delta=1e-12)
        self.assertLess(mean.value - mean.bar95, 1.963)
        self.assertGreater(mean.value + mean.bar95, 2.376)
        self.assertEqual(mean_of_seeds([2.0], [0.1])[1], 0.1)
        self.assertTrue(numpy.isnan(mean_of_seeds([2.0], [0.1]).bar95))

    def test_hold_the_true_mean_in_95_of_100_cases(self):
        noise = numpy.random.default_rng(20261130)
        for count, between, within in ((2, 1.0, 0.02), (3, 1.0, 1.0), (5, 0.0, 1.0), (8, 0.3, 0.1)):
            held = 0
            for _ in range(2000):
                means = noise.normal(0, between, count) + noise.normal(0, within, count)
                found = mean_of_seeds(means.tolist(), [within] * count)
                held += abs(found.value) <= found.bar95
            print(f"{count} seeds, spread {between}, error of a run {within}: {held / 20:.1f} % of 2000 bars hold the mean")
            self.assertGreater(held / 2000, 0.935)


if __name__ == "__main__":
    main()
