"""rouleau.break_up: a stress that is known is closed in on, what never parts or never was together is refused."""

import json
import math
import pathlib
import types
import unittest
from unittest import mock

from package import SOURCE, Case, main, need

need("numpy", "pandas")

import pandas  # noqa: E402

import rouleau  # noqa: E402
from rouleau import breaking  # noqa: E402
from rouleau.reading import Section  # noqa: E402

SCENE = {"stages": [{"name": "rest", "duration": "1 s"}, {"name": "shear", "shear_rate": "20 1/s", "strain": 5, "density_factor": 77}]}
VISCOSITY = 1.2e-3


class Fake:
    """Runs of a rouleau of three that parts at a rate, in steady shear; a ramp is seen to part it at 1.5 times that."""

    def __init__(self, parts, members=(0, 1, 2), ramp=1.5, reach=400.0):
        self.parts, self.members, self.ramp, self.reach, self.stages = parts, members, ramp, reach, []
        self.status = "completed"

    def __call__(self, scene, jobs, out, workers, bars, fresh, progress):
        return [self.one(job.changes["/stages"]) for job in jobs]

    def one(self, stages):
        self.stages.append(stages)
        rate = stages[-1]["shear_rate"]
        steady = isinstance(rate, str)
        parted = self.parts(float(rate.split()[0])) if steady else self.ramp is not None
        now = float(rate.split()[0]) if steady else self.ramp or self.reach
        series = pandas.DataFrame({
            "stage_name": ["rest", "shear"], "strain": [0.0, 4.0], "shear_rate_1_per_s": [0.0, now], "relative_viscosity": [float("nan"), 1.5],
            "wall_stress_lower_Pa": [0.0, 1.5 * VISCOSITY * now], "wall_stress_upper_Pa": [0.0, -1.5 * VISCOSITY * now]})
        summary = json.loads(json.dumps({
            "rheology": [{"dissociation": []}, {"dissociation": [{"members": list(self.members)}] if self.members else []}],
            "stages": [{"ended_by": "parted" if parted else "strain"}], "dimensionless": {"adhesion_number": 6.0 / now}}), object_hook=Section)
        return types.SimpleNamespace(series=series, summary=summary, directory=pathlib.Path("nowhere"), status=self.status)


class BreakUp(Case):
    def found(self, fake, **options):
        with mock.patch.object(breaking, "run_all", fake):
            return rouleau.break_up(SCENE, out=self.path / "none", workers=2, **options)

    def test_a_stress_is_closed_in_on(self):
        for threshold in (13.0, 23.7, 61.0):  # below the ramp's rate and above it
            with self.subTest(threshold=threshold):
                fake = Fake(lambda rate, at=threshold: rate >= at, ramp=30.0)
                found = self.found(fake, tolerance=0.04)
                self.assertLessEqual(abs(found.shear_rate_per_s - threshold), found.bar_Pa / VISCOSITY * (1 + 1e-9))
                self.assertLessEqual(found.bar_Pa, 0.05 * found.stress_Pa)
                self.assertAlmostEqual(found.stress_Pa, VISCOSITY * found.shear_rate_per_s)
                self.assertAlmostEqual(found.adhesion_number, 6.0 / found.shear_rate_per_s)
                self.assertAlmostEqual(found.ramp_stress_Pa, VISCOSITY * 30)
                self.assertEqual((found.cells, found.strain), (3, 4.0))
                self.assertEqual(len(found.runs), len(fake.stages))
                self.assertEqual([stage["name"] for stage in fake.stages[0]], ["rest", "shear"])
                self.assertEqual(fake.stages[0][1]["density_factor"], 77)
                alone = self.found(Fake(lambda rate, at=threshold: rate >= at), tolerance=0.04, most="70 1/s", ramp=None)
                self.assertLessEqual(abs(alone.shear_rate_per_s - threshold), alone.bar_Pa / VISCOSITY * (1 + 1e-9))
                self.assertTrue(math.isnan(alone.ramp_stress_Pa))
                self.assertEqual(set(alone.runs["kind"]), {"step"})

    def test_rates_that_hold_above_one_that_parts_are_within_the_bar(self):
        found = self.found(Fake(lambda rate: 9 < rate < 11 or rate > 18, ramp=30.0))
        bar = found.bar_Pa / VISCOSITY
        self.assertTrue(any(row.parted and row.shear_rate_per_s >= found.shear_rate_per_s - 1.01 * bar for row in found.runs.itertuples()))
        for row in found.runs[found.runs["kind"] == "step"].itertuples():
            if abs(row.shear_rate_per_s - found.shear_rate_per_s) > 1.01 * bar:
                self.assertEqual(row.parted, row.shear_rate_per_s > found.shear_rate_per_s)

    def test_what_has_no_stress_is_refused(self):
        for fake, words in ((Fake(lambda _: True, members=()), "no cells are joined"), (Fake(lambda _: True, ramp=None), "parted up to 400 1/s"),
                            (Fake(lambda _: True), "at any rate"), (Fake(lambda _: False), "nothing parts within a strain of 15")):
            with self.subTest(words=words), self.assertRaisesRegex(rouleau.Error, words):
                self.found(fake)
        diverged = Fake(lambda _: True)
        diverged.status = "diverged"
        with self.assertRaisesRegex(rouleau.Error, "ended as diverged"):
            self.found(diverged)
        with self.assertRaisesRegex(rouleau.Error, "stages.0.duration would be lost"):
            self.found(Fake(lambda _: True), **{"stages.0.duration": "1 s"})
        with self.assertRaisesRegex(rouleau.Error, "nothing parts within a strain of 15"):
            self.found(Fake(lambda _: False), ramp=None)
        with self.assertRaisesRegex(rouleau.Error, "tolerance 2"):
            self.found(Fake(lambda _: True), tolerance=2)

    def test_the_program_takes_its_ramp(self):
        with self.assertRaisesRegex(rouleau.Error, "no aggregate parted up to 5 1/s") as refused:
            rouleau.break_up(SOURCE / "scenes/blood/pair-2d.json", most="5 1/s", ramp="0.2 s", workers=1, out=self.path / "pair",
                             progress=False, **{"domain.nodes": [64, 48]})
        run = rouleau.open(refused.exception.faults[0].file)
        self.assertEqual(run.stages, ["aggregate", "shear"])
        self.assertAlmostEqual(run.series["shear_rate_1_per_s"].iloc[-1], 5, delta=0.05)
        self.assertEqual(set(run.lifetimes["cells"]), {2})


if __name__ == "__main__":
    main()
