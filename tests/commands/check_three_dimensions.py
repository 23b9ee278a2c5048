#!/usr/bin/env python3
"""Scenes of three dimensions from JSON to files, what is refused there, and that threads and pauses change no bit.

usage: check_three_dimensions.py ROULEAU SCENE_OF_A_DUCT [--no-whole-runs]
"""
import copy
import csv
import json
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
from scene_parts import changed  # noqa: E402

PROGRAM, DUCT = Path(sys.argv[1]).resolve(), json.loads(Path(sys.argv[2]).read_text())
WITHOUT_WHOLE_RUNS = "--no-whole-runs" in sys.argv  # where the program is ten times slower
whole_runs = unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
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
CAPSULE = {
    "cell_types": {"capsule": {"shape": {"sphere": {"radius": "0.45 um"}}, "triangles": 80, "interior_viscosity": "3 cP",
                               "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-6 N/m"}},
                                            {"model": "bending", "parameters": {"modulus": "1e-21 J"}}]}},
    "cells": [{"type": "capsule", "at": ["2 um", "2 um", "0.5 um"]}],
}
SHEARED = {
    **CAPSULE,
    "rouleau": 1,
    "domain": {"size": ["4 um", "4 um", "3 um"], "nodes": [16, 16, 12], "y": WALLS},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 300},
    "cells": [{"type": "capsule", "at": ["1.2 um", "1.7 um", "1 um"]},
              {"type": "capsule", "at": ["3.9 um", "2.2 um", "2.9 um"], "axis": [0, 0, 1], "angle": "20 deg"}],
    "interactions": [{"between": ["capsule", "capsule"], "model": "morse",
                      "parameters": {"depth": "1e-8 J/m2", "zero_force_distance": "0.49 um", "cutoff": "1.5 um"}}],
    "stages": [{"name": "rest", "duration": "0.05 ms"}, {"name": "shear", "shear_rate": "1000 1/s", "strain": 0.2}],
    "output": {"cells": {"strain": 0.02}, "fields": {"strain": 0.1, "quantities": ["velocity", "viscosity"]}},
}
TUBE = {
    **CAPSULE,
    "rouleau": 1,
    "domain": {"size": ["3 um", "3 um", "3.5 um"], "nodes": [12, 12, 14], "walls": {"tube": {"radius": "1.45 um"}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 300},
    "cells": [{"type": "capsule", "at": ["1.5 um", "1.7 um", "2.2 um"]}],
    "stages": [{"name": "flow", "mean_velocity": "1 mm/s", "duration": "2 ms"},
               {"name": "on", "pressure_gradient": "4e6 Pa/m", "duration": "1 ms"}],
    "output": {"cells": {"seconds": "0.1 ms"}, "fields": {"seconds": "1 ms", "quantities": ["velocity", "viscosity"]}},
}


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

    def rows(self, folder, name):
        with open(folder / name, newline="") as file:
            return list(csv.DictReader(file))

    def series(self, folder):
        return self.rows(folder, "series.csv")

    def cells(self, folder):
        return self.rows(folder, "cells.csv")

    def assert_same_bits(self, scene, pause, steps, *tables):
        """So many steps by one thread, by three, and by a run that is cut short at step `pause` and goes on with two have the
        same tables."""
        for precision in ("f32",) if WITHOUT_WHOLE_RUNS else ("f64", "f32"):
            scene = changed(scene, numerics__precision=precision)
            one = self.run_scene(scene, "one" + precision, "--max-steps", steps)
            many = self.run_scene(scene, "many" + precision, "--threads", 3, "--max-steps", steps)
            self.assertEqual(json.loads((one / "summary.json").read_text())["steps"], steps)
            paused = self.folder / ("paused" + precision)
            for options in (("--max-steps", pause), ("--resume", "--threads", 2, "--max-steps", steps)):
                done = self.rouleau("run", self.folder / "scene.json", "--out", paused, "--quiet", *options)
                self.assertEqual(done.returncode, 0, done.stderr)
            for other in (many, paused):
                for name in tables:
                    own, others = self.rows(one, name), self.rows(other, name)
                    known = {row["step"] for row in own}
                    self.assertEqual(own, [row for row in others if row["step"] in known])


class A_run_in_three_dimensions(Case):
    @whole_runs
    def test_of_a_duct_has_the_flow_rate_of_the_series(self):
        scene = changed(DUCT, domain__nodes=[4, 16, 16], domain__size=["5 um", "20 um", "20 um"],
                        fluid__inertia=False, output__fields={"seconds": "0.2 s", "quantities": ["velocity"]})
        last = self.series(self.run_scene(scene, "duct"))[-1]
        expected = 0.0351443 * 1e4 * 20e-6**3 / 1.2e-3
        self.assertAlmostEqual(float(last["flow_rate_m2_per_s"]) / expected, 1, delta=3e-3)
        self.assertAlmostEqual(float(last["relative_viscosity"]), 1, delta=3e-3)

    @whole_runs
    def test_that_is_plane_is_the_run_in_two(self):
        plane, space = self.run_scene(PLANE, "plane"), self.run_scene(SPACE, "space")
        at_rest = 1e-20  # populations hold half of a step's force, 1e-5 and less, with 16 digits
        for a, b in zip(self.series(plane), self.series(space), strict=True):
            for column in ("flow_rate_m2_per_s", "wall_stress_lower_Pa", "wall_stress_upper_Pa", "shear_rate_1_per_s",
                           "relative_viscosity", "kinetic_energy_J_per_m", "viscous_dissipation_W_per_m",
                           "wall_power_W_per_m", "body_force_power_W_per_m", "mach_max"):
                self.assertAlmostEqual(float(b[column]), float(a[column]), msg=column,
                                       delta=1e-9 * abs(float(a[column])) + (at_rest if column == "mach_max" else 1e-22)) if a[column] != "nan" else \
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

    def test_of_cells_has_its_own_columns_and_surfaces(self):
        folder = self.run_scene(SHEARED, "cells")
        first, *_, last = self.cells(folder)
        self.assertEqual((first["area_m2"], first["perimeter_m"]), ("", ""))
        self.assertAlmostEqual(float(first["z_m"]), 1e-6, delta=1e-9)
        self.assertAlmostEqual(float(first["volume_m3"]), 4.19 * 0.45e-6**3, delta=0.25 * 4.19 * 0.45e-6**3)
        self.assertGreater(float(last["deformation"]), 0.01)
        self.assertLess(float(last["axis_y"]), 1)
        self.assertLess(json.loads((folder / "summary.json").read_text())["conservation"]["area_drift_max"], 0.01)
        xdmf = (folder / "frames.xmf").read_text()
        self.assertIn('TopologyType="Triangle" NumberOfElements="160"', xdmf)
        self.assertIn('GeometryType="XYZ"', xdmf)
        plane = self.run_scene(changed(PLANE, stages=PLANE["stages"][:1]), "plane")
        self.assertNotIn("z_m", (plane / "cells.csv").read_text())
        self.assertEqual(self.rouleau("report", folder).returncode, 0)
        self.assertEqual(self.rouleau("verify", folder).returncode, 0)
        try:
            import h5py
        except ImportError:
            return
        with h5py.File(folder / "frames.h5") as file:
            frame = file["frames/000000/membranes"]
            self.assertEqual((frame["points"].shape, frame["triangles"].shape), ((84, 3), (160, 3)))
            self.assertEqual(frame["curvature"].shape, (84,))

    @whole_runs
    def test_of_cells_has_the_same_bits_for_any_number_of_threads_and_when_it_goes_on_after_a_pause(self):
        self.assert_same_bits(changed(SHEARED, numerics__coupling="semi-implicit"), 40, 60, "cells.csv")

    def test_of_cells_with_bonds_keeps_them_over_a_pause_and_a_stage_with_another_time_step(self):
        def bonds(whom):
            return {"between": ["capsule", whom], "model": "bridging",
                    "parameters": {"site_density": "1e14 1/m2", "bond_stiffness": "1e-6 N/m", "zero_force_distance": "0.3 um",
                                   "on_rate": "2e4 1/s", "off_rate": "100 1/s", "cutoff": "0.8 um"}}
        scene = changed(SHEARED, interactions=[bonds("capsule"), bonds("wall")],
                        cells=[{"type": "capsule", "at": ["1.2 um", "0.8 um", "2.8 um"]}, {"type": "capsule", "at": ["2.3 um", "0.9 um", "0.2 um"]}])
        self.assert_same_bits(scene, 40, 60, "cells.csv", "series.csv")
        alone = self.run_scene(changed(scene, interactions=[]), "alone", "--max-steps", 60)
        last, without = (self.cells(folder)[-1] for folder in (self.folder / "onef32", alone))
        self.assertLess(float(last["wall_gap_m"]), float(without["wall_gap_m"]) - 1e-9)  # held by the wall
        self.assertGreater(float(last["min_gap_m"]), 0)

    @whole_runs
    def test_of_cells_that_attract_each_other_loses_energy_at_rest_and_joins_them(self):
        attraction = [{"between": ["capsule", "capsule"], "model": "morse",
                       "parameters": {"depth": "1e-6 J/m2", "zero_force_distance": "0.5 um", "cutoff": "1.5 um"}}]
        scene = changed(SHEARED, interactions=attraction, stages=[{"name": "rest", "duration": "20 ms"}],
                        output={"cells": {"seconds": "2 ms"}, "aggregate_gap": "0.7 um"},
                        cells=[{"type": "capsule", "row": {"count": 2, "spacing": "1.6 um", "axis": "z",
                                                           "center": ["2 um", "2 um", "1.5 um"]}}])
        for model in ("morse", "lennard-jones"):
            options = ("--set", "/interactions/0/model=" + model)
            folder = self.run_scene(scene, model, *options)
            series = self.series(folder)
            energy = [float(row["total_energy_J_per_m"]) for row in series]
            self.assertLess(energy[-1], energy[0])
            for before, after in zip(energy, energy[1:]):
                self.assertLess(after, before + 1e-4 * abs(energy[0]))
            gaps = [float(row["min_gap_m"]) for row in self.cells(folder)]
            self.assertLess(gaps[-1], gaps[0])
            self.assertAlmostEqual(gaps[-1], 0.5e-6, delta=0.15e-6)
            self.assertEqual(series[-1]["aggregate_count"], "1")
            with open(folder / "aggregates.csv", newline="") as file:
                contact = list(csv.DictReader(file))[-1]
            self.assertGreater(float(contact["contact_area_m2"]), 0)
            self.assertEqual(contact["members"], "0+1")

    @whole_runs
    def test_have_error_bars(self):
        scene = changed(SPACE, domain={"size": ["6 um", "6 um", "6 um"], "nodes": [24, 24, 24], "y": WALLS}, output={"cells": {"seconds": "1 ms"}})
        done = self.rouleau("run", self.write(scene), "--error-bar", "--out", self.folder / "bars")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.folder / "bars/summary.json").read_text())
        flow = summary["error_bars"]["flow_rate_m2_per_s"]
        self.assertIsNotNone(flow["error"], flow["how"])
        self.assertRegex(flow["how"], r"lattice .*\((\d+) x \1 x \1 nodes\)")

    @whole_runs
    def test_walls_hold_cells(self):
        scene = changed(SHEARED, stages=[{"name": "rest", "duration": "20 ms", "density_factor": 3000}], output={"cells": {"seconds": "2 ms"}},
                        cells=[{"type": "capsule", "at": ["2 um", "1.1 um", "1.5 um"]}],
                        interactions=[{"between": ["capsule", "wall"], "model": "morse",
                                       "parameters": {"depth": "1e-7 J/m2", "zero_force_distance": "0.49 um", "cutoff": "1.5 um"}}])
        folder = self.run_scene(scene, "held")
        gaps = [float(row["wall_gap_m"]) for row in self.cells(folder)]
        self.assertAlmostEqual(gaps[0], 0.65e-6, delta=0.02e-6)  # its lowest node lies at about 1.1 - 0.45 um
        self.assertLess(gaps[-1], gaps[0] - 0.05e-6)
        self.assertGreater(gaps[-1], 0.3e-6)  # curved, it is held a little nearer than the well
        energy = json.loads((folder / "summary.json").read_text())["energy"]
        self.assertLess(energy["largest_growth_at_rest_relative"], 1e-3)

    def test_of_a_mesh_from_a_file_is_that_of_the_shape(self):
        octahedron = "OFF\n6 8 12\n" + "".join(f"{x} {y} {z}\n" for x, y, z in
                                               [(1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1), (0, 0, -1)])
        octahedron += "".join(f"3 {a} {b} {c}\n" for a, b, c in [(0, 2, 4), (2, 1, 4), (1, 3, 4), (3, 0, 4),
                                                                 (2, 0, 5), (1, 2, 5), (3, 1, 5), (0, 3, 5)])
        (self.folder / "cell.off").write_text(octahedron)
        mesh = {"mesh": {"file": "cell.off", "unit": "0.5 um"}}
        scene = changed(SHEARED, cell_types__capsule__shape=mesh, stages=SHEARED["stages"][:1],
                        output={"cells": {"seconds": "0.02 ms"}})
        del scene["cell_types"]["capsule"]["triangles"]
        first = self.cells(self.run_scene(scene, "mesh"))[0]
        self.assertAlmostEqual(float(first["volume_m3"]) / (4 / 3 * 0.5e-6**3), 1, delta=1e-12)
        places = [float(first[name]) for name in ("x_m", "y_m", "z_m")]
        lines = octahedron.split("\n")
        moved = [" ".join(str(1e-3 * (float(c) + 40)) for c in line.split()) for line in lines[2:8]]
        (self.folder / "cell.off").write_text("\n".join(lines[:2] + moved + lines[8:]))
        scene["cell_types"]["capsule"]["shape"]["mesh"]["unit"] = "0.5 mm"  # longer than the box
        far = self.cells(self.run_scene(scene, "far", "--max-steps", 20))[0]
        for name, place in zip(("x_m", "y_m", "z_m"), places):
            self.assertAlmostEqual(float(far[name]), place, delta=1e-15, msg=name)
        (self.folder / "cell.off").write_text("\n".join(lines[:2] + [" ".join(f"{1.1 * 1e-3 * float(c)}" for c in l.split())
                                                                    for l in lines[2:8]] + lines[8:]))
        done = self.rouleau("run", self.folder / "scene.json", "--out", self.folder / "far", "--resume", "--force")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("/cell_types/capsule/shape/mesh/sha256", done.stderr)
        mesh = json.loads((self.folder / "far/scene.json").read_text())["cell_types"]["capsule"]["shape"]["mesh"]
        self.assertEqual(mesh["file"], str(self.folder / "cell.off"))
        (self.folder / "cell.off").write_text(octahedron.replace("3 0 3 5\n", "3 0 3 4\n"))
        done = self.rouleau("run", self.folder / "scene.json", "--out", self.folder / "no")
        self.assertEqual(done.returncode, 2, done.stderr)
        self.assertIn("cell.off", done.stderr)

    def test_begins_with_cells_at_random(self):
        random = {"hematocrit": 0.2, "seed": 3, "gap": "0.1 um"}
        scene = changed(SHEARED, stages=SHEARED["stages"][:1], output={"cells": {"seconds": "0.02 ms"}},
                        cells=[{"type": "capsule", "at": ["2 um", "2 um", "1.5 um"]}, {"type": "capsule", "random": random}])
        done = self.rouleau("plan", self.write(scene))
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertRegex(done.stdout, r"\d+ of type capsule, hematocrit 0\.\d+ of 0\.2 asked, gap 0\.1 um, seed 3")
        folders = [self.run_scene(scene, f"threads{n}", "--threads", n, "--max-steps", 20) for n in (1, 3)]
        packing, = json.loads((folders[0] / "summary.json").read_text())["packings"]
        first, *_ = rows = self.cells(folders[0])
        volume = float(first["volume_m3"])
        self.assertEqual(packing["count"], round(0.2 * 48e-18 / volume))
        self.assertEqual(packing["cells"], [1, packing["count"]])
        self.assertAlmostEqual(packing["hematocrit"], packing["count"] * volume / 48e-18, delta=1e-6)
        self.assertEqual(float(first["x_m"]), 2e-6)
        begun = [row for row in rows if row["step"] == first["step"]]
        self.assertEqual(len(begun), 1 + packing["count"])
        self.assertGreaterEqual(min(float(row["min_gap_m"]) for row in begun), 0.1e-6)
        self.assertGreater(len({row["axis_y"] for row in begun}), 1)
        self.assertEqual(rows, self.cells(folders[1]))

    def test_writes_the_fields_of_a_region_and_vorticity_as_vectors(self):
        fields = {"seconds": "1 ms", "quantities": ["vorticity", "velocity"],
                  "region": {"from": ["1 um", "0 um", "0.3 um"], "to": ["5 um", "2 um", "0.7 um"]}}
        scene = changed(SPACE, output__fields=fields)
        self.assertIn("x = 1.125 um to 4.875 um (16 nodes), y = 0.125 um to 1.875 um (8 nodes), z = 0.375 um to 0.625 um (2 nodes)",
                      self.rouleau("plan", self.write(scene)).stdout)
        folder = self.run_scene(scene, "region", "--max-steps", 400)
        xdmf = (folder / "frames.xmf").read_text()
        self.assertIn('Dimensions="2 8 16"', xdmf)
        self.assertIn('Name="vorticity (1/s)" AttributeType="Vector"', xdmf)
        self.assertEqual(self.rouleau("report", folder).returncode, 0)
        self.assertEqual(self.rouleau("verify", folder).returncode, 0)

    @whole_runs
    def test_opens_as_a_volume(self):
        folder = self.run_scene(changed(SPACE, domain__z=WALLS, output__fields__stride=2), "volume")
        xdmf = (folder / "frames.xmf").read_text()
        self.assertIn('TopologyType="3DCoRectMesh" Dimensions="2 8 16"', xdmf)
        self.assertIn('Dimensions="2 8 16 3"', xdmf)
        self.assertEqual(self.rouleau("report", folder).returncode, 0)
        self.assertEqual(self.rouleau("verify", folder).returncode, 0)

    @whole_runs
    def test_has_the_same_bits_for_any_number_of_threads_and_when_it_goes_on_after_a_pause(self):
        self.assert_same_bits(changed(SPACE, domain__z=WALLS), 70, 200, "series.csv")


class Cells_in_layers_whose_faces_repel(Case):
    SCENE = {**SHEARED, "fluid": {**SHEARED["fluid"], "layers": [{"from": "0 um", "to": "2 um", "viscosity": "3 cP"}]},
             "interactions": [*SHEARED["interactions"],
                              {"between": ["capsule", "self"], "model": "repulsion",
                               "parameters": {"strength": "1e-7 J/m2", "cutoff": "0.5 um"}}]}

    def test_have_the_same_bits_for_any_number_of_threads_and_when_they_go_on_after_a_pause(self):
        self.assert_same_bits(self.SCENE, 35, 90, "series.csv", "cells.csv", "aggregates.csv")

    def test_are_planned_and_have_the_viscosities_of_the_layers_around_them(self):
        text = self.rouleau("plan", self.write(self.SCENE)).stdout
        self.assertIn("an active potential acts between cells, within a membrane", text)
        folder = self.run_scene(self.SCENE, "layers", "--max-steps", 20)
        try:
            import h5py
        except ImportError:
            return
        with h5py.File(folder / "frames.h5") as file:
            viscosity = next(frame["fields/viscosity"][:] for frame in file["frames"].values() if "fields" in frame)
        self.assertAlmostEqual(float(viscosity[6, 2, 8]), 3e-3, delta=1e-8)
        self.assertAlmostEqual(float(viscosity[6, 14, 8]), 1.2e-3, delta=1e-8)
        self.assertAlmostEqual(float(viscosity[4, 6, 4]), 3e-3, delta=1e-8)  # inside the first capsule, which is of 3 cP


class A_tube(Case):
    def test_carries_a_cell_at_the_mean_velocity_that_is_kept_and_its_fluid_rests_in_the_wall(self):
        folder = self.run_scene(TUBE, "tube")
        flow = [row for row in self.rows(folder, "series.csv") if row["stage_name"] == "flow"][-1]
        self.assertAlmostEqual(float(flow["flow_rate_m2_per_s"]) * 3.5e-6 / (1e-3 * 3.14159 * 1.45e-6**2), 1, delta=0.06)
        self.assertAlmostEqual(float(flow["relative_viscosity"]), 1, delta=0.15)
        self.assertEqual(flow["wall_stress_lower_Pa"], flow["wall_stress_upper_Pa"])  # of all of the wall: G R/2
        driven = float(flow["pressure_gradient_Pa_per_m"]) * 1.45e-6 / 2
        self.assertAlmostEqual(float(flow["wall_stress_lower_Pa"]) / driven, 1, delta=0.1)
        self.assertEqual(float(flow["wall_power_W_per_m"]), 0)
        self.assertAlmostEqual(float(flow["viscous_dissipation_W_per_m"]) / float(flow["body_force_power_W_per_m"]), 1,
                               delta=0.05)
        cells = self.rows(folder, "cells.csv")
        first, later = cells[0], next(row for row in cells if row["step"] == flow["step"])
        self.assertAlmostEqual(float(first["wall_gap_m"]), 1.45e-6 - 0.45e-6 - (0.2**2 + 0.45**2)**0.5 * 1e-6, delta=0.05e-6)
        moved = float(later["x_m"]) - float(first["x_m"])
        # Its axis is that of the tube; it goes as far as its velocity says, which is that over the mean one.
        self.assertAlmostEqual(float(first["offset_from_axis_m"]), (0.2**2 + 0.45**2)**0.5 * 1e-6, delta=1e-10)
        self.assertAlmostEqual(float(later["offset_from_axis_m"]), ((float(later["y_m"]) - 1.5e-6)**2 + (float(later["z_m"]) - 1.75e-6)**2)**0.5, delta=1e-18)
        self.assertAlmostEqual(float(later["velocity_x_m_per_s"]) / float(flow["mean_velocity_m_per_s"]), float(later["velocity_over_mean"]), delta=1e-12)
        before = cells[cells.index(later) - 1]
        went = (float(later["x_m"]) - float(before["x_m"])) / (float(later["time_s"]) - float(before["time_s"]))
        self.assertAlmostEqual(went / float(later["velocity_x_m_per_s"]), 1, delta=0.01)
        self.assertGreater(moved, 1.5e-6)
        self.assertLess(moved, 4e-6)
        self.assertLess(json.loads((folder / "summary.json").read_text())["conservation"]["area_drift_max"], 0.02)
        self.assertEqual(self.rouleau("report", folder).returncode, 0)
        try:
            import h5py
            import numpy
        except ImportError:
            return
        with h5py.File(folder / "frames.h5") as file:
            velocity = numpy.array([frame["fields/velocity"][:] for frame in file["frames"].values() if "fields" in frame])[-1]
        z, y = numpy.mgrid[0:14, 0:12]
        solid = (y - 5.5)**2 + (z - 6.5)**2 >= 5.8**2
        self.assertEqual(float(numpy.abs(velocity[solid]).max()), 0)
        self.assertGreater(float(velocity[~solid][:, :, 0].min()), 0)

    @whole_runs
    def test_has_the_same_bits_for_any_number_of_threads_and_when_it_goes_on_after_a_pause(self):
        self.assert_same_bits(TUBE, 35, 90, "series.csv", "cells.csv")

    def test_begins_with_the_flow_that_it_would_have_without_cells(self):
        scene = changed(TUBE, stages__0__start="developed", cells=[], stages__0__duration="0.5 ms", stages__1__duration="0.1 ms")
        flow = [row for row in self.series(self.run_scene(scene, "tube")) if row["stage_name"] == "flow"]
        for row in flow:  # of 5.8 spacings
            self.assertAlmostEqual(float(row["relative_viscosity"]), 1, delta=0.02)
        late = [row for row in self.series(self.run_scene(changed(scene, stages__0__start="impulsive"), "late"))
                if row["stage_name"] == "flow"]
        self.assertGreater(float(late[1]["relative_viscosity"]), 1.2)

    def test_is_planned_with_its_own_numbers(self):
        text = self.rouleau("plan", self.write(TUBE)).stdout
        self.assertIn("radius of the tube", text)
        self.assertRegex(text, "warning: radius of the tube in lattice spacings is 5.8, below")
        self.assertRegex(text, r"driving force density, without cells +4\.566e\+06")  # 8 mu U / R^2


class A_plan_in_three_dimensions(Case):
    def test_knows_its_memory_and_its_fields(self):
        plan = json.loads(self.rouleau("plan", self.write(SPACE), "--json").stdout)
        self.assertGreaterEqual(plan["estimate"]["memory_bytes"], 32 * 16 * 4 * 19 * 8)
        plane = json.loads(self.rouleau("plan", self.write(PLANE), "--json").stdout)
        self.assertGreater(plan["estimate"]["output"]["fields_bytes"], 3.9 * plane["estimate"]["output"]["fields_bytes"])
        self.assertIn("z = 0.125 um to", self.rouleau("plan", self.write(changed(SPACE, output__fields__stride=3))).stdout)


class Numerics_auto(Case):
    SCENE = changed(SHEARED, domain={"size": ["1.8 um", "1.8 um", "1.8 um"], "y": WALLS}, interactions=[],
                    cells=[{"type": "capsule", "at": ["0.9 um", "0.9 um", "0.9 um"]}],
                    numerics={"auto": {"error": 0.1, "of": "steady"}, "precision": "f32"},
                    stages=[{"name": "shear", "shear_rate": "1000 1/s", "strain": 2, "start": "developed"}],
                    output={"cells": {"strain": 0.1}})

    def setUp(self):
        super().setUp()
        self.scene = copy.deepcopy(self.SCENE)
        del self.scene["cell_types"]["capsule"]["triangles"]

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "whole runs")
    def test_chooses_a_lattice_that_plan_explains_and_a_run_measures_its_errors(self):
        plan = self.rouleau("plan", self.write(self.scene))
        self.assertRegex(plan.stdout, r"/domain/nodes +\[(\d+),\1,\1\]")
        done = self.rouleau("run", self.write(self.scene), "--out", self.folder / "out", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        summary = json.loads((self.folder / "out/summary.json").read_text())
        choice = summary["numerics_choice"]
        self.assertIsNotNone(summary["error_bars"]["deformation"]["error"], summary["error_bars"]["deformation"]["how"])
        self.assertEqual(choice["measured_error"] > 0.1, "has missed its target" in done.stdout, done.stdout)
        written = json.loads((self.folder / "out/scene.json").read_text())
        nodes = written["domain"]["nodes"]
        self.assertEqual(len(set(nodes)), 1)
        self.assertGreaterEqual(nodes[0] * 0.45 / 1.8, 6.5)
        self.assertEqual((written["numerics"]["kernel"], written["numerics"]["slip_correction"]), ("sharp6", True))
        self.assertTrue(written["numerics"]["area_correction"])

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "whole runs")
    def test_that_misses_its_target_is_followed_by_a_finer_run(self):
        # At a strain of 0.7 the fluid's unsteady term delays the shape by more than auto's motion expects.
        scene = changed(self.scene, numerics={"auto": {"error": 0.08}, "precision": "f32"}, stages__0__strain=0.7)
        done = self.rouleau("run", self.write(scene), "--out", self.folder / "out", "--quiet")
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("numerics.auto has missed its target", done.stdout)
        first, finer = (json.loads((self.folder / "out" / name).read_text()) for name in ("summary.json", "refined/summary.json"))
        self.assertGreater(finer["steps"], first["steps"])
        self.assertLess(finer["numerics_choice"]["measured_error"], first["numerics_choice"]["measured_error"])

    def test_chooses_in_a_tube_too(self):
        scene = changed(TUBE, domain={"size": ["3 um", "3 um", "3.5 um"], "walls": TUBE["domain"]["walls"]},
                        numerics={"auto": {"error": 0.1}})
        plan = json.loads(self.rouleau("plan", self.write(scene), "--json").stdout)
        values = {value["pointer"]: value["value"] for value in plan["numerics_choice"]["values"]}
        nodes = values["/domain/nodes"]
        self.assertEqual([nodes[0], 7 * nodes[0]], [nodes[1], 6 * nodes[2]])

    def test_says_what_to_write_where_no_lattice_fits(self):
        for command in ("plan", "run"):
            done = self.rouleau(command, self.write(changed(self.scene, domain__size=["1.8 um", "1.8 um", "1.7345678912 um"])))
            self.assertEqual(done.returncode, 2)
            self.assertIn("/domain/size", done.stderr)
            self.assertIn("along all three can be chosen", done.stderr)
            self.assertNotIn("sphere", done.stderr)


class Three_dimensions_refuse(Case):
    def refused(self, scene, pointer, *words, code=2):
        for command in ("plan", "run"):
            done = self.rouleau(command, self.write(scene), *(["--out", "no"] if command == "run" else []))
            self.assertEqual(done.returncode, code, done.stdout + done.stderr)
            for word in (pointer, *words):
                self.assertIn(word, done.stderr)
        self.assertFalse((self.folder / "no").exists())

    def test_cells_and_what_belongs_to_them(self):
        scene = SPACE | CAPSULE
        capsule = "cell_types__capsule__"
        self.refused(changed(scene, **{capsule + "shape": {"circle": {"radius": "0.5 um"}}}),
                     "/cell_types/capsule/shape/circle", 'take "sphere"')
        self.refused(changed(scene, **{capsule + "segments": 20}), "/cell_types/capsule/segments", "triangles")
        self.refused(changed(scene, **{capsule + "triangles": 100}), "/cell_types/capsule/triangles", "80 or 180")
        self.refused(changed(scene, cells__0__at=["2 um", "2 um"]), "/cells/0/at", "three lengths")
        self.refused(changed(scene, cells__0__at=["2 um", "3.7 um", "0.5 um"]), "/cells/0", "wall across y")
        self.refused(changed(scene, cells__0__axis=[0, 0, 0]), "/cells/0/axis", "no direction")
        two = [{"type": "capsule", "at": ["2 um", "2 um", "0.1 um"]}, {"type": "capsule", "at": ["2.3 um", "2 um", "0.9 um"]}]
        self.refused(scene | {"cells": two}, "/cells/1", "overlap")
        def random(**keys):
            return changed(scene, cells=[{"type": "capsule", "random": {"count": 2, "seed": 1} | keys}])

        self.refused(random(count=2, gap="1 um"), "/cells/0/random", "came to a standstill", "a gap smaller than 1 um")
        self.refused(random(count=120), "/cells/0/random", "would fill", "ask for fewer cells")
        self.refused(random(region={"lower": ["0 um", "0 um"], "upper": ["2 um", "2 um"]}), "/cells/0/random/region/lower", "three lengths")
        self.refused(random(region={"lower": ["0 um"] * 3, "upper": ["2 um", "2 um", "1.5 um"]}), "/cells/0/random/region/upper/2",
                     "size along z is 1 um")
        bonds = {"site_density": "1e14 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.1 um", "on_rate": 20,
                 "off_rate": 1, "cutoff": "0.3 um"}
        acting = [{"between": ["capsule", "self"], "model": "bridging", "parameters": bonds}]
        self.refused(scene | {"interactions": acting}, "/interactions/0/model", "cannot act within a membrane", "remembers")
        laws = [{"model": "inextensible", "parameters": {"stretching_modulus": "1e-6 N/m"}}]
        self.refused(changed(scene, **{capsule + "membrane": laws}), "/cell_types/capsule/membrane/0/model",
                     "three dimensions", "neo-hookean")
        plane = changed(PLANE | CAPSULE, cells__0__at=["2 um", "2 um"])
        self.refused(plane, "/cell_types/capsule/shape/sphere", 'take "circle"')

    def test_numbers_that_do_not_go_together(self):
        self.refused(changed(SPACE, domain__nodes=[32, 16]), "/domain/nodes", "three numbers and nodes two")
        self.refused(changed(SPACE, domain__size=["8 um", "4 um"]), "/domain/nodes", "three numbers and size two")
        self.refused(changed(SPACE, domain__size=["8 um", "4 um", "1.1 um"]), "/domain/size/2", 'write "1 um" here')
        self.refused(changed(SPACE, domain__nodes=[65536, 65536, 65536]), "/domain/nodes", "too many")
        self.refused(changed(SPACE, fluid__body_force=[0, 0]), "/fluid/body_force", "2 components")
        self.refused(changed(PLANE, fluid__body_force=[0, 0, 1]), "/fluid/body_force", "3 components")
        self.refused(changed(PLANE, domain__z="periodic"), "/domain/z", "no z in two dimensions")

    def test_tubes_that_are_none(self):
        self.refused(changed(PLANE, domain__walls=TUBE["domain"]["walls"]), "/domain/walls", "three dimensions")
        self.refused(changed(TUBE, domain__y=WALLS), "/domain/y", "the tube closes y and z")
        self.refused(changed(TUBE, domain__z="periodic"), "/domain/z", "the tube closes y and z")
        self.refused(changed(TUBE, domain__walls__tube__radius="1.6 um"), "/domain/walls/tube/radius", '"1.5 um"')
        self.refused(changed(TUBE, domain__walls__tube__radius="0.4 um"), "/domain/walls/tube/radius", "1.6 lattice spacings")
        self.refused(changed(TUBE, domain__walls__tube__axis="y"), "/domain/walls/tube/axis", '"x"')
        self.refused(changed(TUBE, domain__walls={}), "/domain/walls", "tube")
        self.refused(changed(SPACE, domain={"size": ["8 um", "4 um", "1 um"], "nodes": [32, 16, 4]}), "/domain", '"y"')
        self.refused(changed(TUBE, cells__0__at=["1.5 um", "2.4 um", "2.4 um"]), "/cells/0", "the wall of the tube by 0.0874 um")
        self.refused(changed(TUBE, stages__1={"name": "s", "shear_rate": 1, "duration": 1}), "/stages/1/shear_rate",
                     "pressure_gradient or mean_velocity")
        layers = [{"from": "0 um", "to": "1 um", "viscosity": "3 cP"}]
        self.refused(changed(TUBE, fluid__layers=layers, cells=[]), "/fluid/layers", "a tube")

    def test_regions_of_fields(self):
        region = {"from": ["1 um", "0 um", "0.3 um"], "to": ["5 um", "2 um", "0.7 um"]}
        fields = {"seconds": "1 ms", "quantities": ["velocity"], "region": region}
        scene = changed(SPACE, output__fields=fields)
        self.refused(changed(scene, output__fields__region__to=["5 um", "2 um"]), "/output/fields/region/to", "three lengths")
        self.refused(changed(PLANE, output__fields=fields), "/output/fields/region/from", "two lengths")
        self.refused(changed(scene, output__fields__region__to=["5 um", "2 um", "1.1 um"]), "/output/fields/region/to/2",
                     "ends at 1.1 um along z, outside the domain, which ends at 1 um")

    def test_developed_flows_that_are_not_known(self):
        shaken = {"name": "o", "pressure_gradient": 0, "oscillation": {"amplitude": "1e4 Pa/m", "frequency": "50 Hz"},
                  "duration": "1 ms", "start": "developed"}
        self.refused(changed(TUBE, stages__1=shaken), "/stages/1/start", "an oscillation settles to in a tube")
        duct = changed(SPACE, domain__z=WALLS)
        self.refused(changed(duct, stages__1=shaken), "/stages/1/start", "an oscillation settles to in a duct")
        layers = [{"from": "0 um", "to": "1 um", "viscosity": "3 cP"}]
        self.refused(changed(duct, fluid__layers=layers, stages__0__start="developed"), "/stages/0/start",
                     "layers settle to in a duct")

    def test_an_operator_whose_manifest_names_d2q9_alone(self):
        shipped = PROGRAM.parent.parent / "lib/rouleau/plugins/collision/bgk"
        manifest = json.loads((shipped / "bgk.json").read_text())
        del manifest["lattices"]
        folder = self.folder / "plane"
        shutil.copytree(shipped, folder)
        (folder / "bgk.json").write_text(json.dumps({**manifest, "id": "plane"}))
        self.refused(changed(SPACE, fluid__collision={"model": "plane"}, plugin_dirs=["plane"]), "/fluid/collision/model",
                     "D3Q19", "bgk, central-moment, mrt, regularised, trt")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
