"""rouleau.calibrate: values that were hidden are found back within their bars, what cannot be decided is refused, and runs
are made once.

With a number as third argument so many hidden values are looked for; with "scene" a depth hidden in a shipped scene, in two
minutes (docs/results/means-2026-11.md).
"""

import json
import math
import os
import pathlib
import sys
import time
import unittest

from package import SOURCE, Case, main, need, small_scene

need("numpy", "pandas")
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # the matrices are small

import numpy  # noqa: E402

import rouleau  # noqa: E402
from rouleau.calibrating import quantity_of  # noqa: E402
from rouleau.surrogate import Process  # noqa: E402

SEED = 20261201  # the rules were chosen with others
WITH_SCENE = sys.argv[3:4] == ["scene"]
HIDDEN = int(sys.argv[3]) if len(sys.argv) > 3 and not WITH_SCENE else 20
DEPTH = {"/interactions/0/parameters/depth": ("1e-8 J/m2", "1e-5 J/m2")}


def break_up(depth):
    """A stress that rises with the depth and saturates, Pa."""
    x = depth / 3e-7
    return 0.8 * x ** 0.8 / (1 + x ** 0.8)


def contact(depth):
    """A length that rises, and falls where cells are torn, um."""
    return 4 * math.exp(-0.5 * ((math.log10(depth) + 6.2) / 0.7) ** 2)


class Noisy:
    """A cheap simulator: known functions with a known error, and how often it was called."""

    def __init__(self, noise, error, **functions):
        self.noise, self.error, self.functions, self.calls = noise, error, functions, []

    def __call__(self, values):
        self.calls.append(values)
        return {name: (float(function(*values.values()) + self.noise.normal(0, self.error)), self.error)
                for name, function in self.functions.items()}


class A_hidden_value(Case):
    def look_for(self, name, parameters, errors, run_error, functions, where, count=HIDDEN, least=0.85):
        """In how many cases a parameter lies in its 95 % interval."""
        held, inner, calls, widths, refused = 0, 0, [], [], 0
        for k in range(count):
            noise = numpy.random.default_rng([SEED, len(name), k])
            hidden = where(noise)
            observed = {goal: (float(function(*hidden) + noise.normal(0, errors[goal])), errors[goal]) for goal, function in functions.items()}
            simulator = Noisy(noise, run_error, **functions)
            try:
                found = rouleau.calibrate(simulator, parameters, observed, workers=2, page=False)
            except rouleau.Error as error:
                refused += 1
                print(f"  {name} {k}: {error.problem}")
                continue
            rows = found.parameters
            held += sum(low <= value <= high for low, value, high in zip(rows["low"], hidden, rows["high"]))
            inner += sum(low <= value <= high for low, value, high in zip(rows["low68"], hidden, rows["high68"]))
            calls.append(len(simulator.calls))
            widths.append(math.log10(rows["high"].iloc[0] / rows["low"].iloc[0]))
        answered = (count - refused) * len(parameters)
        print(f"{name}: in the 95 % interval {held} of {answered}, in the 68 % interval {inner}; refused {refused} of {count}; "
              f"{numpy.mean(calls):.1f} points; intervals of {numpy.mean(widths):.2f} decades")
        self.assertGreaterEqual(held, least * answered)
        self.assertLessEqual(refused, 0.15 * count)

    def test_of_a_depth_is_found_from_a_stress_that_rises_with_it(self):
        self.look_for("one depth, monotone", DEPTH, {"stress": 0.02}, 0.01, {"stress": break_up}, lambda noise: [10 ** noise.uniform(-7.5, -5.8)])

    def test_of_a_depth_is_found_from_two_observations_of_which_one_rises_and_falls(self):
        self.look_for("one depth, two observations", DEPTH, {"stress": 0.05, "length": 0.2}, 0.02, {"stress": break_up, "length": contact},
                      lambda noise: [10 ** noise.uniform(-7.5, -5.8)])

    def test_of_two_parameters_are_found_from_two_observations(self):
        functions = {"stress": lambda depth, modulus: break_up(depth) * (1 + 0.3 * modulus),
                     "deformation": lambda depth, modulus: 0.5 / (1 + modulus) + 0.05 * break_up(depth)}
        self.look_for("two parameters", {**DEPTH, "modulus": (0.2, 1.9)}, {"stress": 0.02, "deformation": 0.01}, 0.005, functions,
                      lambda noise: [10 ** noise.uniform(-7.5, -6.2), noise.uniform(0.4, 1.6)], count=max(10, HIDDEN // 2), least=0.8)


class Refused(Case):
    def test_is_what_the_observation_cannot_decide(self):
        simulator = Noisy(numpy.random.default_rng(SEED), 0.02, stress=lambda depth: 1.0 + 0.001 * math.log10(depth))
        error = self.assert_refused("flat: the observations do not decide /interactions/0/parameters/depth", rouleau.calibrate, simulator, DEPTH,
                                    {"stress": (1.0, 0.1)}, out=self.path / "flat")
        self.assertIn("calibration.html shows the runs", error.remedy)
        self.assertIn("No value is given", (self.path / "flat/calibration.html").read_text())
        self.assertLessEqual(len(simulator.calls), 6)

    def test_are_two_parameters_that_one_observation_cannot_tell_apart(self):
        simulator = Noisy(numpy.random.default_rng(SEED), 0.001, sum=lambda a, b: a + b)
        self.assert_refused("flat: the observations do not decide a and b", rouleau.calibrate, simulator, {"a": (0, 1), "b": (0, 1)},
                            {"sum": (1.0, 0.01)}, page=False)

    def test_is_what_no_value_gives(self):
        simulator = Noisy(numpy.random.default_rng(SEED), 0.001, stress=break_up)
        self.assert_refused("no value in the ranges gives what was observed", rouleau.calibrate, simulator, DEPTH, {"stress": (2.0, 0.01)}, page=False)

    def test_is_bad_input(self):
        for parameters, words in (({}, "there are 0 parameters"), ({"a": (1, 1)}, "the range (1, 1)"), ({"a": ("1 m", "2 um")}, "in one unit")):
            self.assert_refused(words, rouleau.calibrate, dict, parameters, {"b": (1, 1)})
        for observed, words in (({}, "nothing was observed"), ({"b": (1, 0)}, "an error above 0"), ({"b": 3}, "was observed as 3")):
            self.assert_refused(words, rouleau.calibrate, dict, {"a": (1, 2)}, observed)
        self.assert_refused("give values by name", rouleau.calibrate, dict, ["a"], {"b": (1, 1)})
        self.assert_refused("workers is -1", rouleau.calibrate, dict, {"a": (1, 2)}, {"a": (1, 1)}, workers=-1)

    def test_is_what_a_function_gives_that_was_not_asked_for(self):
        for answer, words in ((None, "the function gave: None"), ({"c": 1}, 'gave no "b"'), ({"b": "high"}, "no number"), ({"b": (1, "low")}, "no number"),
                              ({"b": [1, 2, 3]}, "no number")):
            self.assert_refused(words, rouleau.calibrate, lambda values: answer, {"a": (1, 2)}, {"b": (1, 1)})

    def test_are_ends_of_the_range_named_where_the_value_is_likely_there(self):
        simulator = Noisy(numpy.random.default_rng(SEED), 0.001, y=lambda a: a)
        found = rouleau.calibrate(simulator, {"a": (0, 1)}, {"y": (0.99, 0.05)}, page=False)
        self.assertIn("upper end of its range", str(found))


class A_surrogate(Case):
    def test_goes_through_exact_values_and_knows_what_it_does_not_know(self):
        u = numpy.linspace(0, 1, 8)[:, None]
        process = Process(u, numpy.sin(4 * u[:, 0]), numpy.zeros(8))
        at = numpy.linspace(0, 1, 50)[:, None]
        mean, spread = process.at(at)
        self.assertLess(abs(mean - numpy.sin(4 * at[:, 0])).max(), 0.03)
        self.assertLess((abs(mean - numpy.sin(4 * at[:, 0])) / spread).max(), 4)
        self.assertGreater(process.at(numpy.array([[2.0]]))[1][0], 5 * spread.max())


class A_scene(Case):
    def setUp(self):
        super().setUp()
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.path)

    def test_has_a_hidden_depth_found_back_and_its_runs_are_made_once(self):
        # Two cells at rest: how far they are flattened against each other depends on the depth.
        scene = small_scene(stages=[{"name": "rest", "duration": "0.2 s"}], output={"cells": {"seconds": "0.02 s"}})
        key = "/interactions/0/parameters/depth"

        def distance(run):
            cells = run.cells[run.cells["step"] == run.cells["step"].max()]
            return abs(cells["x_m"].diff().iloc[-1])

        hidden = 3.3e-7
        truth = rouleau.run(scene, "truth", progress=False, **{key: f"{hidden} J/m2"})
        value, error = distance(truth), 0.01e-6
        found = rouleau.calibrate(scene, {key: ("3e-8 J/m2", "3e-6 J/m2")}, {"distance_m": (value, error, distance)}, out="cal", workers=2,
                                  progress=False)
        row = found.parameters.loc[key]
        print(f"hidden {hidden:.3g}, found {found}")
        self.assertLess(row["low"], hidden)
        self.assertGreater(row["high"], hidden)
        self.assertEqual(row["unit"], "J/m2")
        self.assertLess(abs(found.fit.loc["distance_m", "residual"]), 1)
        self.assertEqual(found.changes[key], f"{row['value']!r} J/m2")
        self.assertEqual(rouleau.run(scene, "again", progress=False, **found.changes).status, "completed")
        page = pathlib.Path("cal/calibration.html").read_text()
        for words in ("Fit and residuals", "J/m2", "<svg", "report.html", f"{len(found.runs)} points"):
            self.assertIn(words, page)
        written = {path: path.stat().st_mtime_ns for path in pathlib.Path("cal").glob("*/summary.json")}
        self.assertEqual(len(written), len(found.runs))
        again = rouleau.calibrate(scene, {key: ("3e-8 J/m2", "3e-6 J/m2")}, {"distance_m": (value, error, distance)}, out="cal", progress=False)
        self.assertAlmostEqual(again.parameters.loc[key, "value"] / row["value"], 1, delta=0.02)
        other = rouleau.calibrate(scene, {key: ("3e-8 J/m2", "3e-6 J/m2")}, {"distance_m": (value + error, error, distance)}, out="cal", progress=False)
        self.assertNotEqual(other.parameters.loc[key, "value"], row["value"])
        self.assertEqual(written, {path: path.stat().st_mtime_ns for path in written})
        print(f"{len(found.runs)} runs, with another observation {len(other.runs)}")

    @unittest.skipUnless(WITH_SCENE, "minutes: give the argument scene")
    def test_that_is_shipped_has_a_hidden_depth_found_from_the_deformation_of_its_cells(self):
        scene, key = SOURCE / "scenes/four-cells-shear.json", "/interactions/0/parameters/depth"
        rest = {"/stages/1/strain": 0.1}  # what is observed comes before the shear

        def deformation(run):
            return run.stage("aggregate").pivot("deformation", over="step").iloc[-1].mean()

        hidden = 1.3e-7
        truth = rouleau.run(scene, "truth", progress=False, **rest, **{key: f"{hidden} J/m2"})
        observed, error = deformation(truth), 0.005
        begun = time.monotonic()
        found = rouleau.calibrate(scene, {key: ("2e-8 J/m2", "2e-6 J/m2")}, {"deformation": (observed, error, deformation)},
                                  out=os.environ.get("CALIBRATION", "cal"), workers=2, progress=False, **rest)
        print(f"hidden {hidden:.3g}, deformation {observed:.4g} +- {error:.2g}; found {found}\n{len(found.runs)} runs, {time.monotonic() - begun:.0f} s")
        print(found.runs.drop(columns="directories").to_string())
        self.assertLess(found.parameters.loc[key, "low"], hidden)
        self.assertGreater(found.parameters.loc[key, "high"], hidden)

    def test_may_be_named_by_what_its_summary_has(self):
        run = rouleau.run(small_scene(), "run", progress=False)
        self.assertEqual(quantity_of(run, "dimensionless.capillary"), run.summary.dimensionless.capillary)
        self.assertEqual(quantity_of(run, "rheology.-1.means.relative_viscosity")["mean"], run.summary.rheology[-1].means.relative_viscosity.mean)
        self.assertEqual(quantity_of(run, "deformation")[0], run.results.loc["deformation", "value"])
        self.assertTrue(math.isnan(quantity_of(run, "rheology.-1.dissociation.7.parted.strain")))  # did not happen
        self.assert_refused('before "capillaryy" there is', quantity_of, run, "dimensionless.capillaryy")

    def test_averages_over_seeds(self):
        scene = small_scene(cells=[{"type": "rbc", "random": {"hematocrit": 0.2, "seed": 1}}])
        shear = {"/stages/1/shear_rate": ("10 1/s", "40 1/s")}
        wanted = {"capillary": (rouleau.plan(scene).dimensionless.capillary, 1e-4, lambda run: run.summary.dimensionless.capillary)}
        found = rouleau.calibrate(scene, shear, wanted, seeds=[1, 2], out="seeds", progress=False, most_points=4, **{"stages.1.strain": 0.05})
        self.assertAlmostEqual(found.parameters["value"].iloc[0], 20, delta=1)
        self.assertEqual({len(directories) for directories in found.runs["directories"]}, {2})
        self.assertEqual(len(json.loads(pathlib.Path("seeds/points.json").read_text())), 1)


if __name__ == "__main__":
    main()
