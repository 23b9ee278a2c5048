#!/usr/bin/env python3
"""Walls of any shape from scenes to files: drawings and meshes against flows that are known, what is part of a scene,
what is refused, and that no broken input ends the program without a word.

usage: check_walls.py ROULEAU [--no-whole-runs] [--mutants N [SEED]]
"""
import csv
import json
import random
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

TESTS = Path(__file__).resolve().parents[1]
sys.path[:0] = [str(TESTS), str(TESTS.parent / "python")]
sys.dont_write_bytecode = True
from rouleau.shapes import png  # noqa: E402
from scene_parts import changed, tube_stl  # noqa: E402

PROGRAM = Path(sys.argv[1]).resolve()
WITHOUT_WHOLE_RUNS = "--no-whole-runs" in sys.argv  # where the program is ten times slower
MUTANTS, SEED = 30 if WITHOUT_WHOLE_RUNS else 120, 50
if "--mutants" in sys.argv:
    wanted = [int(word) for word in sys.argv[sys.argv.index("--mutants") + 1:]]
    MUTANTS, SEED = (wanted + [SEED])[:2]
FLUID = {"density": "1 g/cm3", "viscosity": "1.2 cP"}
THROAT = [["0 um", "1 um"], ["8 um", "3 um"], ["16 um", "1 um"], ["16 um", "7 um"], ["8 um", "5 um"], ["0 um", "7 um"]]
PLANE = {
    "rouleau": 1,
    "domain": {"size": ["16 um", "8 um"], "nodes": [64, 32], "walls": {"within": {"outline": {"points": THROAT}}},
               "obstacles": [{"sphere": {"center": ["2 um", "4 um"], "radius": "0.8 um"}}]},
    "fluid": FLUID, "numerics": {"density_factor": 10},
    "stages": [{"name": "flow", "mean_velocity": "1 mm/s", "duration": "0.2 ms"}],
    "output": {"cells": {"seconds": "0.02 ms"}, "fields": {"seconds": "0.1 ms", "quantities": ["velocity"]}},
}
CHANNEL = {**PLANE, "domain": {"size": ["2 um", "10 um"], "nodes": [8, 40],
                               "walls": {"within": {"image": {"file": "band.png", "pixel": "0.25 um"}}}},
           "stages": [{"name": "flow", "pressure_gradient": "1e5 Pa/m", "duration": "1 ms"}]}
TUBE = {**PLANE, "domain": {"size": ["1 um", "5.5 um", "5.5 um"], "nodes": [4, 22, 22],
                           "walls": {"tube": {"radius": "2.5 um"}}},
        "stages": [{"name": "flow", "pressure_gradient": "1e5 Pa/m", "duration": "0.2 ms"}],
        "output": {"cells": {"seconds": "0.05 ms"}}}
MESH = {"mesh": {"file": "tube.stl", "unit": "1 um", "at": ["0 um", "2.75 um", "2.75 um"]}}


BAND = png([[255 if 8 <= row < 32 else 0] * 8 for row in range(40)])


class Walls(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="rouleau-walls-")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)
        (self.folder / "band.png").write_bytes(BAND)
        (self.folder / "tube.stl").write_bytes(tube_stl(2.5, 1))

    def write(self, scene, name="scene"):
        (self.folder / f"{name}.json").write_text(json.dumps(scene))
        return f"{name}.json"

    def rouleau(self, *words):
        return subprocess.run([PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=120)

    def run_scene(self, scene, name, *options):
        done = self.rouleau("run", self.write(scene, name), "--out", name, "--quiet", *options)
        self.assertEqual(done.returncode, 0, done.stderr.decode(errors="replace"))
        return list(csv.DictReader((self.folder / name / "series.csv").read_text().splitlines()))

    def refusal(self, scene):
        done = self.rouleau("plan", self.write(scene))
        said = done.stderr.decode(errors="replace")
        self.assertEqual(done.returncode, 2, said)
        return said

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_throat_with_an_obstacle_keeps_its_mean_velocity_and_the_bits_of_any_number_of_threads(self):
        series = self.run_scene(PLANE, "one", "--threads", "1")
        self.assertAlmostEqual(float(series[-1]["mean_velocity_m_per_s"]), 1e-3, delta=1e-5)
        self.run_scene(PLANE, "two", "--threads", "2")
        self.run_scene(PLANE, "paused", "--max-steps", "100")
        self.run_scene(PLANE, "paused", "--resume", "--threads", "2")
        for other in ("two", "paused"):
            self.assertEqual((self.folder / other / "series.csv").read_text(), (self.folder / "one/series.csv").read_text())

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_channel_that_is_drawn_has_poiseuilles_flow(self):
        series = self.run_scene(CHANNEL, "drawn")
        exact = 1e5 * (6e-6) ** 2 / (12 * 1.2e-3)
        self.assertAlmostEqual(float(series[-1]["mean_velocity_m_per_s"]) / exact, 1, delta=5e-3)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_tube_from_a_mesh_has_the_flow_of_a_tube_and_of_hagen_and_poiseuille(self):
        as_mesh = changed(TUBE, domain__walls={"within": MESH})
        flows = [float(self.run_scene(scene, name)[-1]["mean_velocity_m_per_s"]) for name, scene in
                 (("round", TUBE), ("mesh", as_mesh))]
        exact = 1e5 * (2.5e-6) ** 2 / (8 * 1.2e-3)
        # The radius is 10 spacings: 0.65/R^2 of the flow rate. The mesh is a polygon of 96 sides inside of it.
        self.assertAlmostEqual(flows[0] / exact, 1, delta=0.65 / 10 ** 2)
        self.assertAlmostEqual(flows[1] / flows[0], 1, delta=3e-3)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_file_is_part_of_the_scene(self):
        self.run_scene(CHANNEL, "drawn", "--max-steps", "20")
        image = json.loads((self.folder / "drawn/scene.json").read_text())["domain"]["walls"]["within"]["image"]
        self.assertEqual(image["file"], str(self.folder / "band.png"))
        self.assertEqual(len(image["sha256"]), 64)
        (self.folder / "band.png").write_bytes(png([[255 if 9 <= row < 32 else 0] * 8 for row in range(40)]))
        done = self.rouleau("run", self.write(CHANNEL), "--out", "drawn", "--resume", "--quiet")
        self.assertEqual(done.returncode, 2)
        self.assertIn("/domain/walls/within/image/sha256", done.stderr.decode())

    def test_plan_tells_what_the_lattice_makes_of_the_walls(self):
        said = self.rouleau("plan", self.write(PLANE)).stdout.decode()
        for words in ("share of the domain that is fluid", "open at the lower end along x", "widest place", "narrowest passage"):
            self.assertIn(words, said)
        plan = json.loads(self.rouleau("plan", self.write(CHANNEL), "--json").stdout)
        rows = {row["quantity"]: row for row in plan["conversions"]}
        self.assertAlmostEqual(rows["share of the domain that is fluid"]["si"], 0.6, delta=1e-6)
        self.assertAlmostEqual(rows["narrowest passage"]["lattice"], 24, delta=1e-6)
        self.assertAlmostEqual(rows["open at the upper end along x"]["si"], 6e-6, delta=1e-12)

    def test_auto_refines_a_narrow_passage_that_a_lattice_would_be_refused_for(self):
        narrow = changed(PLANE, domain__obstacles__0__sphere__center=["8 um", "4.4 um"], domain__obstacles__0__sphere__radius="0.4 um")
        said = self.refusal(changed(narrow, domain__nodes=[32, 16]))
        self.assertIn("lattice spacings wide", said)
        chosen = changed(narrow, numerics="auto")
        del chosen["domain"]["nodes"]
        plan = json.loads(self.rouleau("plan", self.write(chosen), "--json").stdout)
        rows = {row["quantity"]: row for row in plan["conversions"]}
        self.assertGreater(rows["narrowest passage"]["lattice"], 4)

    def test_closed_ways_are_refused_where_a_flow_is_driven_and_pools_apart_are_told(self):
        wall = {"box": {"lower": ["4 um", "0 um"], "upper": ["5 um", "8 um"]}}
        blocked = changed(PLANE, domain__obstacles=[wall])
        self.assertIn("no way through", self.refusal(blocked))
        still = changed(blocked, stages=[{"name": "rest", "duration": "0.1 ms"}])
        self.assertEqual(self.rouleau("plan", self.write(still)).returncode, 0)
        pool = changed(PLANE, domain__walls={"within": {"union": [{"outline": {"points": THROAT}},
                                                                 {"box": {"lower": ["6 um", "6.2 um"], "upper": ["10 um", "7.8 um"]}}]}})
        said = self.rouleau("plan", self.write(pool)).stdout.decode()
        self.assertIn("have no way to most others", said)

    def test_what_is_not_known_between_such_walls_is_refused(self):
        sides = {"lower": {"wall": {}}, "upper": {"wall": {}}}
        for pointers, words in (
                ({"stages": [{"name": "shear", "shear_rate": "1 1/s", "strain": 1}], "domain__y": sides}, "walls do not move"),
                ({"stages__0__start": "developed"}, "that develops between walls of any shape is not known"),
                ({"fluid__layers": [{"from": "0 um", "to": "1 um", "viscosity": "2 cP"}]}, "layers lie along plane walls"),
                ({"domain__walls": {"within": {"bal": {}}}}, "bal"),
                ({"domain__obstacles": [{"mesh": {"file": "tube.stl", "unit": "1 um"}}]}, "a mesh has three dimensions")):
            self.assertIn(words, self.refusal(changed(PLANE, **pointers)))

    def test_all_that_is_wrong_with_walls_is_said_at_once(self):
        (self.folder / "open.stl").write_bytes(tube_stl(2.4, 0.9, 12, False))
        scene = changed(TUBE, domain__walls={"within": {"union": [
            {"mesh": {**MESH["mesh"], "file": "open.stl"}}, {"image": {"file": "band.png", "pixel": "0.12 um"}},
            {"sphere": {"center": ["90 um", "0 um", "0 um"], "radius": "1 um"}}]}})
        said = self.refusal(scene)
        for words in ("union/0/mesh/file", "the border is not closed", "union/1/image", "8 pixels along x make 0.96 um", "union/2", "it reaches from 89 um"):
            self.assertIn(words, said)

    def mutant(self, chance):
        """A scene with something broken, and what was done to it."""
        kind = chance.choice(["stl", "png", "points", "number", "tree"])
        numbers = ["nan um", "-1 um", "1e300 um", "0 um", 1e308, -5, "1 s", "", None, "1e-30 m", [1], "5 um", "inf m", 1e-5]
        if kind == "stl":
            data = bytearray(tube_stl(2.4, 1, 12))
            for _ in range(chance.randint(1, 20)):
                data[chance.randrange(len(data))] = chance.choice([0, 255, 127, 128, chance.randrange(256)])
            cut = chance.choice([len(data), len(data), chance.randrange(len(data))])
            (self.folder / "tube.stl").write_bytes(bytes(data[:cut]))
            return kind, changed(TUBE, domain__walls={"within": MESH})
        if kind == "png":
            data = bytearray(BAND)
            for _ in range(chance.randint(0, 3)):
                data[chance.randrange(len(data))] = chance.randrange(256)
            cut = chance.choice([len(data), chance.randrange(len(data))])
            (self.folder / "band.png").write_bytes(bytes(data[:cut]))
            return kind, CHANNEL
        if kind == "points":
            points = [[f"{chance.uniform(-5, 20):.3g} um", f"{chance.uniform(-5, 12):.3g} um"] for _ in range(chance.randint(3, 9))]
            return kind, changed(PLANE, domain__walls__within__outline__points=points)
        if kind == "number":
            key = chance.choice(["center", "radius"])
            value = [chance.choice(numbers), chance.choice(numbers)] if key == "center" else chance.choice(numbers)
            return kind, changed(PLANE, **{f"domain__obstacles__0__sphere__{key}": value})
        shape = {"sphere": {"center": ["8 um", "4 um"], "radius": f"{chance.uniform(0, 9):.3g} um"}}
        for _ in range(chance.randint(1, 30)):
            how = chance.choice(["union", "intersection", "difference"])
            other = {"box": {"lower": [f"{chance.uniform(-9, 9):.3g} um", "0 um"], "upper": [f"{chance.uniform(-9, 30):.3g} um", "5 um"]}}
            shape = {how: chance.choice([[shape], [shape, other], [other, shape], []])}
        return kind, changed(PLANE, domain__obstacles=[shape])

    def test_broken_shapes_end_with_words_and_never_by_a_signal(self):
        chance = random.Random(SEED)
        codes = {0: 0, 2: 0}
        for i in range(MUTANTS):
            kind, scene = self.mutant(chance)
            with self.subTest(seed=SEED, mutant=i, kind=kind):
                done = self.rouleau("plan", self.write(scene))
                self.assertIn(done.returncode, codes, done.stderr[-500:])
                codes[done.returncode] += 1
                if done.returncode == 2:
                    self.assertGreater(len(done.stderr), 20)
                    self.assertNotIn(b"internal error", done.stderr)
        self.assertGreater(codes[2], MUTANTS / 3)  # else little is broken


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
