#!/usr/bin/env python3
"""Scenes of three dimensions from JSON to files, what is refused there, and that threads and pauses change no bit.

usage: check_three_dimensions.py ROULEAU SCENE_OF_A_DUCT
"""
import copy
import csv
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, DUCT = Path(sys.argv[1]).resolve(), json.loads(Path(sys.argv[2]).read_text())
WALLS = {"lower": {"wall": {}}, "upper": {"wall": {}}}
PLANE = {
    "rouleau": 1,
    "domain": {"size": ["8 um", "4 um"], "nodes": [32, 16], "y": WALLS},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP", "inertia": True},
    "numerics": {"tau": 0.9, "density_factor": 1000},
    "stages": [{"name": "pushed", "pressure_gradient": "2e5 Pa/m", "duration": "3 ms"},
               {"name": "sheared", "walls": {"lower": "-0.1 mm/s", "upper": "0.3 mm/s"}, "duration": "2 ms"}],
    "output": {"cells": {"seconds": "0.5 ms"},
               "fields": {"seconds": "2.5 ms", "quantities": ["velocity", "density", "viscosity"], "precision": "f64"}},
}
SPACE = copy.deepcopy(PLANE)
SPACE["domain"] = {"size": ["8 um", "4 um", "1 um"], "nodes": [32, 16, 4], "y": WALLS}


def changed(scene, **pointers):
    scene = copy.deepcopy(scene)
    for pointer, value in pointers.items():
        *path, last = pointer.split("__")
        place = scene
        for key in path:
            place = place[int(key) if key.isdigit() else key]
        place[last] = value
    return scene


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = Path(folder.name)

    def rouleau(self, *arguments):
        return subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, cwd=self.folder)

    def write(self, scene, name="scene.json"):
        file = self.folder / name
        file.write_text(json.dumps(scene))
        return file

    def run_scene(self, scene, out, *options):
        done = self.rouleau("run", self.write(scene), "--out", self.folder / out, "--quiet", *options)
        self.assertIn(done.returncode, (0,), done.stderr)
        return self.folder / out

    def series(self, folder):
        with open(folder / "series.csv", newline="") as file:
            return list(csv.DictReader(file))


class A_run_in_three_dimensions(Case):
    def test_of_a_duct_has_the_flow_rate_of_the_series(self):
        scene = changed(DUCT, domain__nodes=[4, 16, 16], domain__size=["5 um", "20 um", "20 um"],
                        fluid__inertia=False, output__fields={"seconds": "0.2 s", "quantities": ["velocity"]})
        last = self.series(self.run_scene(scene, "duct"))[-1]
        expected = 0.0351443 * 1e4 * 20e-6**3 / 1.2e-3
        self.assertAlmostEqual(float(last["flow_rate_m2_per_s"]) / expected, 1, delta=3e-3)
        self.assertAlmostEqual(float(last["relative_viscosity"]), 1, delta=3e-3)

    def test_that_is_plane_is_the_run_in_two(self):
        plane, space = self.run_scene(PLANE, "plane"), self.run_scene(SPACE, "space")
        for a, b in zip(self.series(plane), self.series(space), strict=True):
            for column in ("flow_rate_m2_per_s", "wall_stress_lower_Pa", "wall_stress_upper_Pa", "shear_rate_1_per_s",
                           "relative_viscosity", "kinetic_energy_J_per_m", "viscous_dissipation_W_per_m",
                           "wall_power_W_per_m", "body_force_power_W_per_m", "mach_max"):
                self.assertAlmostEqual(float(b[column]), float(a[column]), msg=column,
                                       delta=1e-9 * abs(float(a[column])) + 1e-22) if a[column] != "nan" else \
                    self.assertEqual(b[column], "nan", column)
        try:
            import h5py
            import numpy
        except ImportError:
            return
        with h5py.File(plane / "frames.h5") as a, h5py.File(space / "frames.h5") as b:
            self.assertEqual(list(b.attrs["nodes"]), [32, 16, 4])
            self.assertEqual(b.attrs["periodic_z"], 1)
            self.assertEqual(list(a["frames"]), list(b["frames"]))
            seen = 0
            for name, frame in a["frames"].items():
                for field, values in frame.get("fields", {}).items():
                    other = b["frames"][name]["fields"][field]
                    self.assertEqual(other.shape[:3], (4, 16, 32))
                    largest = float(numpy.abs(values[:]).max()) or 1
                    self.assertLess(float(numpy.abs(other[:] - values[:][None]).max()), 1e-9 * largest + 1e-15, (name, field))
                    seen += 1
            self.assertGreater(seen, 5)

    def test_opens_as_a_volume(self):
        folder = self.run_scene(changed(SPACE, domain__z=WALLS, output__fields__stride=2), "volume")
        xdmf = (folder / "frames.xmf").read_text()
        self.assertIn('TopologyType="3DCoRectMesh" Dimensions="2 8 16"', xdmf)
        self.assertIn('Dimensions="2 8 16 3"', xdmf)
        self.assertEqual(self.rouleau("report", folder).returncode, 0)
        self.assertEqual(self.rouleau("verify", folder).returncode, 0)

    def test_has_the_same_bits_for_any_number_of_threads_and_when_it_goes_on_after_a_pause(self):
        for precision in ("f64", "f32"):
            scene = changed(SPACE, domain__z=WALLS, numerics__precision=precision)
            one = self.run_scene(scene, "one" + precision)
            many = self.run_scene(scene, "many" + precision, "--threads", 3)
            paused = self.folder / ("paused" + precision)
            steps = json.loads((one / "summary.json").read_text())["steps"]
            done = self.rouleau("run", self.folder / "scene.json", "--out", paused, "--quiet", "--max-steps", steps // 3)
            self.assertEqual(done.returncode, 0, done.stderr)
            done = self.rouleau("run", self.folder / "scene.json", "--out", paused, "--quiet", "--resume")
            self.assertEqual(done.returncode, 0, done.stderr)
            for other in (many, paused):
                tables = [self.series(folder) for folder in (one, other)]
                # The end of a pause is an output of its own.
                common = [row for row in tables[1] if row["step"] in {own["step"] for own in tables[0]}]
                self.assertEqual(tables[0], common, other)


class A_plan_in_three_dimensions(Case):
    def test_knows_its_memory_and_its_fields(self):
        plan = json.loads(self.rouleau("plan", self.write(SPACE), "--json").stdout)
        self.assertGreaterEqual(plan["estimate"]["memory_bytes"], 32 * 16 * 4 * 19 * 8)
        plane = json.loads(self.rouleau("plan", self.write(PLANE), "--json").stdout)
        self.assertGreater(plan["estimate"]["output"]["fields_bytes"], 3.9 * plane["estimate"]["output"]["fields_bytes"])
        self.assertIn("z = 0.125 um to", self.rouleau("plan", self.write(changed(SPACE, output__fields__stride=3))).stdout)


class Three_dimensions_refuse(Case):
    def refused(self, scene, pointer, *words, code=2):
        for command in ("plan", "run"):
            done = self.rouleau(command, self.write(scene), *(["--out", "no"] if command == "run" else []))
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            for word in (pointer, *words):
                self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "no").exists())

    def test_cells_and_what_belongs_to_them(self):
        cells = {"cell_types": {"rbc": {"shape": {"circle": {"radius": "1 um"}}, "segments": 20, "membrane": []}},
                 "cells": [{"type": "rbc", "at": ["2 um", "2 um"]}]}
        self.refused(SPACE | cells, "/cells", "two dimensions only")

    def test_numbers_that_do_not_go_together(self):
        self.refused(changed(SPACE, domain__nodes=[32, 16]), "/domain/nodes", "three numbers and nodes two")
        self.refused(changed(SPACE, domain__size=["8 um", "4 um"]), "/domain/nodes", "three numbers and size two")
        self.refused(changed(SPACE, domain__size=["8 um", "4 um", "1.1 um"]), "/domain/size/2", 'write "1 um" here')
        self.refused(changed(SPACE, domain__nodes=[65536, 65536, 65536]), "/domain/nodes", "too many")
        self.refused(changed(SPACE, fluid__body_force=[0, 0]), "/fluid/body_force", "2 components")
        self.refused(changed(PLANE, fluid__body_force=[0, 0, 1]), "/fluid/body_force", "3 components")
        self.refused(changed(PLANE, domain__z="periodic"), "/domain/z", "no z in two dimensions")

    def test_what_is_not_there_yet(self):
        fields = {"seconds": "1 ms", "quantities": ["velocity", "vorticity"]}
        self.refused(changed(SPACE, output__fields=fields), "/output/fields/quantities/1", "vorticity")
        fields = {"seconds": "1 ms", "quantities": ["velocity"],
                  "region": {"from": ["0 um", "0 um"], "to": ["2 um", "2 um"]}}
        self.refused(changed(SPACE, output__fields=fields), "/output/fields/region", "whole lattice")
        self.refused(changed(SPACE, numerics="auto"), "/numerics", "two dimensions only")
        self.refused(changed(SPACE, domain__z=WALLS, stages__0__start="developed"), "/stages/0/start", "two walls")
        done = self.rouleau("run", self.write(SPACE), "--error-bar", "--out", "no")
        self.assertEqual(done.returncode, 2)
        self.assertIn("--error-bar", done.stderr)

    def test_an_operator_whose_manifest_names_d2q9_alone(self):
        self.refused(changed(SPACE, fluid__collision={"model": "central-moment"}), "/fluid/collision/model",
                     "D3Q19", "bgk, mrt, regularised, trt")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
