#!/usr/bin/env python3
"""Flow between openings from scenes to files: velocity and pressure against flows that are known, what goes in and out,
the same bytes for any threads, ranks and after a kill, and what is refused.

usage: check_openings.py ROULEAU [--no-whole-runs]
"""
import copy
import csv
import json
import math
import shutil
import signal
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "resume"))
from check_kills import differences  # noqa: E402
from scene_parts import changed, tube_stl  # noqa: E402

PROGRAM = Path(sys.argv[1]).resolve()
WITHOUT_WHOLE_RUNS = "--no-whole-runs" in sys.argv  # where the program is ten times slower
MPIRUN = shutil.which("mpirun.openmpi") or shutil.which("mpirun")
HAS_RANKS = MPIRUN and (PROGRAM.parent.parent / "libexec/rouleau/transport-openmpi.so").exists()
UM, VISCOSITY, HEIGHT, LENGTH, MEAN = 1e-6, 1.2e-3, 10e-6, 20e-6, 1e-3
WALLS = {"lower": {"wall": {}}, "upper": {"wall": {}}}
RED_CELL = {"shape": {"biconcave": {"radius": "3.91 um"}}, "segments": 60, "interior_viscosity": "6 cP",
            "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}},
                         {"model": "bending", "parameters": {"modulus": "3.6e-12 dyn cm"}}]}


def ends(inlet, outlet="0 Pa"):
    return {"lower": {"inlet": inlet}, "upper": {"outlet": {"pressure": outlet}}}


VELOCITY, PRESSURE = {"mean_velocity": "1 mm/s"}, {"pressure": f"{12 * VISCOSITY * MEAN * LENGTH / HEIGHT ** 2!r} Pa"}
CHANNEL = {
    "rouleau": 1,
    "domain": {"size": ["20 um", "10 um"], "nodes": [40, 20], "x": ends(VELOCITY), "y": WALLS},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {"density_factor": 20},
    "stages": [{"name": "flow", "duration": "8 ms"}], "output": {"cells": {"seconds": "4 ms"}},
}
STEP = changed(CHANNEL, domain__obstacles=[{"box": {"lower": ["8 um", "0 um"], "upper": ["20 um", "4 um"]}}],
               stages__0__duration="14 ms")
# Round walls lie between nodes, where the lattice keeps no mass to rounding.
ROUND = changed(STEP, domain__obstacles=[*STEP["domain"]["obstacles"], {"sphere": {"center": ["4 um", "9 um"], "radius": "2.3 um"}}])
RADIUS = 2.5e-6
TUBE = changed(CHANNEL, domain={"size": ["6 um", "5.5 um", "5.5 um"], "nodes": [24, 22, 22], "x": ends(VELOCITY),
                                "walls": {"tube": {"radius": "2.5 um"}}},
               stages__0__duration="0.6 ms", output__cells__seconds="0.3 ms")
DUCT_STEP = changed(CHANNEL, domain={"size": ["6 um", "5 um", "4 um"], "nodes": [18, 15, 12], "x": ends(VELOCITY), "y": WALLS,
                                     "z": WALLS, "obstacles": [{"box": {"lower": ["3 um", "0 um", "0 um"],
                                                                        "upper": ["6 um", "2 um", "4 um"]}}]},
                    stages__0__duration="3 ms", output__cells__seconds="0.5 ms")
FED_LENGTH, FED_HEIGHT = 60 * UM, 16 * UM
REPULSION = {"model": "repulsion", "parameters": {"strength": "1e-7 J/m2", "cutoff": "1 um"}}
FED = changed(CHANNEL, domain={"size": ["60 um", "16 um"], "nodes": [120, 32], "y": WALLS,
                               "x": ends({**VELOCITY, "cells": {"type": "rbc", "hematocrit": 0.2, "seed": 3}})},
              numerics={"density_factor": 100, "area_correction": True}, cell_types={"rbc": RED_CELL},
              cells=[{"type": "rbc", "at": ["30 um", "8 um"], "angle": "1 rad"}],
              interactions=[{"between": ["rbc", other], **REPULSION} for other in ("rbc", "wall")],
              stages__0__duration="0.15 s", output__cells__seconds="5 ms")
DISC = {"shape": {"circle": {"radius": "1.5 um"}}, "segments": 16, "interior_viscosity": "1.2 cP",
        "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}}]}
FORKED = changed(FED, domain__size=["40 um", "16 um"], domain__nodes=[80, 32],
                 domain__x=ends({**VELOCITY, "cells": {"type": "disc", "hematocrit": 0.3}}),
                 domain__obstacles=[{"union": [{"box": {"lower": ["20 um", "7 um"], "upper": ["40 um", "9 um"]}},
                                               {"sphere": {"center": ["20 um", "8 um"], "radius": "1 um"}}]}],
                 cell_types={"disc": changed(DISC, membrane__0__parameters__shear_modulus="3e-2 dyn/cm")}, cells=[],
                 stages__0__duration="0.04 s", output__cells__seconds="1 ms",
                 interactions=[{"between": ["disc", other], **REPULSION} for other in ("disc", "wall")])
DENSE_HEMATOCRIT, DENSE_SECONDS = 0.4, 0.06
DENSE = changed(FED, domain__size=["40 um", "16 um"], domain__nodes=[120, 48], cells=[],
                domain__x=ends({**VELOCITY, "cells": {"type": "rbc", "hematocrit": DENSE_HEMATOCRIT}}),
                stages__0__duration=f"{DENSE_SECONDS} s", output__cells__seconds="1 ms")
CAPSULE = {"shape": {"sphere": {"radius": "1 um"}}, "triangles": 320, "interior_viscosity": "1.2 cP",
           "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-4 N/m"}}]}
FED_TUBE = changed(TUBE, domain={"size": ["14 um", "5.5 um", "5.5 um"], "nodes": [56, 22, 22], "walls": {"tube": {"radius": "2.5 um"}},
                                 "x": ends({**VELOCITY, "cells": {"type": "ball", "hematocrit": 0.1}})},
                   numerics={"density_factor": 100, "area_correction": True}, cell_types={"ball": CAPSULE},
                   interactions=[{"between": ["ball", other], **REPULSION} for other in ("ball", "wall")],
                   stages__0__duration="16 ms", output__cells__seconds="1 ms")


# Between walls of a shape, for a domain has planes across y and z alone; and their likes along another axis.
SHAPED = changed(ROUND, domain__y="periodic", domain__walls={"within": {"box": {"lower": ["0 um", "1 um"], "upper": ["20 um", "9.5 um"]}}},
                 stages__0__duration="2 ms", output__cells__seconds="0.5 ms")
DUCT = changed(SHAPED, domain={"size": ["6 um", "5 um", "4 um"], "nodes": [24, 20, 16], "x": ends(VELOCITY), "y": "periodic", "z": "periodic",
                               "walls": {"within": {"box": {"lower": ["0 um", "0.5 um", "0.6 um"], "upper": ["6 um", "4.5 um", "3.5 um"]}}},
                               "obstacles": [{"sphere": {"center": ["3 um", "4.5 um", "1 um"], "radius": "1 um"}}]},
               stages__0__duration="0.2 ms", output__cells__seconds="0.1 ms")
FED_ALONG_Y = changed(FED, domain={"size": ["18 um", "40 um"], "nodes": [36, 80],
                                   "y": ends({**VELOCITY, "cells": {"type": "rbc", "hematocrit": 0.2, "seed": 3}}),
                                   "walls": {"within": {"box": {"lower": ["1 um", "0 um"], "upper": ["17 um", "40 um"]}}}},
                      cells=[{"type": "rbc", "at": ["9 um", "20 um"], "angle": "1 rad"}], stages__0__duration="0.1 s")
FED_ALONG_Z = changed(FED_TUBE, stages__0__duration="9 ms",
                      domain={"size": ["5.5 um", "5.5 um", "10 um"], "nodes": [22, 22, 40],
                              "z": ends({**VELOCITY, "cells": {"type": "ball", "hematocrit": 0.15}}),
                              "walls": {"within": {"cylinder": {"axis": "z", "center": ["2.75 um", "2.75 um"], "radius": "2.5 um"}}}})


def turned(scene, axis):
    """x and another axis exchanged."""
    def exchange(value):
        value = [*value]
        value[0], value["xyz".index(axis)] = value["xyz".index(axis)], value[0]
        return value

    def shape(written):
        return {name: {key: exchange(value) if key in ("lower", "upper", "center") else value for key, value in part.items()}
                for name, part in written.items()}

    domain = copy.deepcopy(scene["domain"])
    domain.update(size=exchange(domain["size"]), nodes=exchange(domain["nodes"]), obstacles=[shape(one) for one in domain["obstacles"]],
                  walls={"within": shape(domain["walls"]["within"])})
    domain["x"], domain[axis] = domain[axis], domain["x"]
    return changed(scene, domain=domain)


class Openings(unittest.TestCase):
    def setUp(self):
        scratch = tempfile.TemporaryDirectory(prefix="rouleau-openings-")
        self.addCleanup(scratch.cleanup)
        self.folder = Path(scratch.name)

    def write(self, scene, name="scene"):
        (self.folder / f"{name}.json").write_text(json.dumps(scene))
        return f"{name}.json"

    def rouleau(self, *words, ranks=0):
        launcher = [MPIRUN, "--allow-run-as-root", "--oversubscribe", "-n", str(ranks)] if ranks else []
        return subprocess.run([*launcher, PROGRAM, *words], cwd=self.folder, capture_output=True, timeout=300)

    def run_scene(self, scene, name, *options, ranks=0):
        done = self.rouleau("run", self.write(scene), "--out", name, "--quiet", *options, ranks=ranks)
        self.assertEqual(done.returncode, 0, done.stderr.decode(errors="replace"))
        return self.rows(name)

    def rows(self, name):
        text = (self.folder / name / "series.csv").read_text()
        return [{k: v if k == "stage_name" else float(v) for k, v in row.items()} for row in csv.DictReader(text.splitlines())]

    def refusal(self, scene):
        done = self.rouleau("plan", self.write(scene))
        said = done.stderr.decode(errors="replace")
        self.assertEqual(done.returncode, 2, said)
        return said

    def balance(self, row, unit="m2"):
        return abs(row[f"outlet_flow_{unit}_per_s"] / row[f"inlet_flow_{unit}_per_s"] - 1)

    def plane(self, inlet, rows, name):
        """Errors of flow and pressure drop against plane Poiseuille flow. A velocity makes a layer of a spacing behind the
        inlet whose pressure is off, so that there the drop is of order 1.5."""
        scene = changed(CHANNEL, domain__nodes=[2 * rows, rows], domain__x=ends(inlet, "7 Pa" if inlet is VELOCITY else "0 Pa"))
        row = self.run_scene(scene, name)[-1]
        self.assertLess(self.balance(row), 1e-6)
        spacing = HEIGHT / rows
        drop = 12 * VISCOSITY * MEAN * (LENGTH - spacing) / HEIGHT ** 2  # from the first node to the last
        if inlet is VELOCITY:
            outside = 7 + drop * spacing / 2 / (LENGTH - spacing)
            self.assertAlmostEqual(row["outlet_pressure_Pa"], outside, delta=0.02 * drop)
        return (abs(row["inlet_flow_m2_per_s"] / (MEAN * HEIGHT) - 1),
                abs((row["inlet_pressure_Pa"] - row["outlet_pressure_Pa"]) / drop - 1))

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_plane_poiseuille_flow_of_second_order_by_velocity_and_by_pressure(self):
        flows, drops = zip(*[self.plane(VELOCITY, rows, f"by-velocity-{rows}") for rows in (8, 16)])
        self.assertLess(max(flows), 1e-6)
        self.assertLess(drops[1], 5e-3)
        self.assertGreater(math.log2(drops[0] / drops[1]), 1.4)
        flows, drops = zip(*[self.plane(PRESSURE, rows, f"by-pressure-{rows}") for rows in (8, 16)])
        self.assertLess(flows[1], 5e-3)
        self.assertGreater(math.log2(flows[0] / flows[1]), 1.8)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_tube_has_hagen_and_poiseuilles_pressure_drop(self):
        row = self.run_scene(TUBE, "tube")[-1]
        self.assertLess(self.balance(row, "m3"), 2e-5)  # a round wall
        flow, spacing = math.pi * RADIUS ** 2 * MEAN, 0.25e-6
        self.assertAlmostEqual(row["inlet_flow_m3_per_s"] / flow, 1, delta=5e-3)
        drop = 8 * VISCOSITY * row["inlet_flow_m3_per_s"] / (math.pi * RADIUS ** 4) * (6e-6 - spacing)
        # The radius is 10 spacings: 0.65/R^2 of the flow rate, as of the tube that a force drives.
        self.assertAlmostEqual((row["inlet_pressure_Pa"] - row["outlet_pressure_Pa"]) / drop, 1, delta=0.65 / 10 ** 2)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_what_comes_in_goes_out_over_a_step_and_between_other_shapes(self):
        for name, scene, unit, off in (("step", STEP, "m2", 1e-6), ("duct", DUCT_STEP, "m3", 1e-6), ("round", ROUND, "m2", 1e-3)):
            rows = self.run_scene(scene, name)
            self.assertLess(self.balance(rows[-1], unit), off)
            area = HEIGHT if unit == "m2" else 5e-6 * 4e-6
            self.assertAlmostEqual(rows[-1][f"inlet_flow_{unit}_per_s"] / (MEAN * area), 1, delta=1e-6)
            means = json.loads((self.folder / name / "summary.json").read_text())["rheology"][-1]["means"]
            self.assertAlmostEqual(means[f"outlet_flow_{unit}_per_s"]["mean"] / (MEAN * area), 1, delta=0.1)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_walls_get_what_the_pressures_lose_and_openings_nothing(self):
        row = self.run_scene(CHANNEL, "stress")[-1]
        gradient = (row["inlet_pressure_Pa"] - row["outlet_pressure_Pa"]) / (LENGTH - 0.5e-6)
        for wall in ("lower", "upper"):
            self.assertAlmostEqual(row[f"wall_stress_{wall}_Pa"] / (gradient * HEIGHT / 2), 1, delta=1e-3)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_shapes_that_end_at_an_opening_go_on_beyond_it(self):
        (self.folder / "tube.stl").write_bytes(tube_stl(2.5, 6))
        points = [["0 um", "1 um"], ["20 um", "1 um"], ["20 um", "9 um"], ["0 um", "9 um"]]
        drawn = changed(CHANNEL, domain={"size": ["20 um", "10 um"], "nodes": [40, 20], "x": ends(VELOCITY),
                                         "walls": {"within": {"outline": {"points": points}}}})
        row = self.run_scene(drawn, "drawn")[-1]
        self.assertLess(self.balance(row), 1e-6)
        self.assertAlmostEqual(row["inlet_flow_m2_per_s"] / (MEAN * 8e-6), 1, delta=1e-6)
        gradient = (row["inlet_pressure_Pa"] - row["outlet_pressure_Pa"]) / (LENGTH - 0.5e-6)
        self.assertAlmostEqual(row["wall_stress_lower_Pa"] / (gradient * 4e-6), 1, delta=2e-3)
        mesh = {"mesh": {"file": "tube.stl", "unit": "1 um", "at": ["0 um", "2.75 um", "2.75 um"]}}
        flows = [self.run_scene(changed(TUBE, domain__walls=walls, stages__0__duration="0.3 ms"), name)[-1]
                 for name, walls in (("round", {"tube": {"radius": "2.5 um"}}), ("mesh", {"within": mesh}))]
        # The mesh is a polygon of 96 sides inside of the tube.
        for key in ("inlet_flow_m3_per_s", "inlet_pressure_Pa"):
            self.assertAlmostEqual(flows[1][key] / flows[0][key], 1, delta=5e-3)

    def same_bytes(self, scene, name):
        self.run_scene(scene, f"{name}-1", "--threads", "1")
        self.run_scene(scene, f"{name}-2", "--threads", "2")
        self.run_scene(scene, f"{name}-paused", "--max-steps", "101")
        self.run_scene(scene, f"{name}-paused", "--resume", "--threads", "2")
        others = [f"{name}-2", f"{name}-paused"]
        for ranks in (2, 3) if HAS_RANKS else ():
            self.run_scene(scene, f"{name}-ranks-{ranks}", ranks=ranks)
            others.append(f"{name}-ranks-{ranks}")
        for other in others:
            self.assertEqual(differences(self.folder / f"{name}-1", self.folder / other), [], other)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_the_same_bytes_for_threads_and_ranks_and_resumed(self):
        fields = {"cells": {"seconds": "0.05 ms"}, "fields": {"seconds": "0.1 ms", "quantities": ["velocity", "density"]}}
        short = {"stages__0__duration": "0.2 ms", "output": fields}
        self.same_bytes(changed(ROUND, fluid__inertia=True, **short), "plane")
        self.same_bytes(changed(TUBE, domain__x=ends({"pressure": "5 Pa"}), **short), "space")

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_run_that_is_killed_goes_on_to_the_same_bytes(self):
        for name, whole, duration in (("plane", STEP, "0.1 ms"), ("space", TUBE, "0.03 ms")):
            # An output at every step, so that one is due where the run goes on: walls are asked for the step before it.
            scene = changed(whole, output={"cells": {"seconds": "0.1 us"}, "checkpoint": {"seconds": "20 ms"}},
                            stages__0__duration=duration)
            self.run_scene(scene, name)
            process = subprocess.Popen([PROGRAM, "run", self.write(scene), "--out", f"{name}-killed", "--quiet"], cwd=self.folder)
            series = self.folder / f"{name}-killed/series.csv"
            while process.poll() is None and not (series.exists() and len(series.read_text().splitlines()) > 8):
                pass
            process.kill()
            self.assertEqual(process.wait(), -signal.SIGKILL)
            self.run_scene(scene, f"{name}-killed", "--resume")
            self.assertEqual(series.read_text(), (self.folder / name / "series.csv").read_text())

    def traffic(self, name):
        """Steps at which cells came and left, by their numbers, from the log."""
        came, left = {}, {}
        for line in (self.folder / name / "log.jsonl").read_text().splitlines():
            entry = json.loads(line)
            if entry["event"] in ("cell_came", "cell_left"):
                to = came if entry["event"] == "cell_came" else left
                self.assertNotIn(entry["cell"], to)
                to[entry["cell"]] = entry["step"]
        return came, left

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_cells_come_at_the_hematocrit_and_leave_whole(self):
        rows = self.run_scene(FED, "fed")
        came, left = self.traffic("fed")
        last = rows[-1]
        self.assertEqual(last["cells_in"], len(came))
        self.assertEqual(last["cells_out"], len(left))
        self.assertGreater(len(left), 5)
        with open(self.folder / "fed/cells.csv") as table:
            cells = list(csv.DictReader(table))
        for row in rows:
            there = [cell for cell in cells if int(cell["step"]) == row["step"]]
            self.assertEqual(row["cells_in"] - row["cells_out"] + 1, row["cells_inside"])  # one was placed
            self.assertEqual(row["cells_inside"], len(there))
            self.assertEqual(len({cell["cell"] for cell in there}), len(there))
            for cell in there:
                self.assertTrue(0 < float(cell["x_m"]) < FED_LENGTH and float(cell["min_gap_m"]) > 0, cell)
        self.assertEqual(sorted(came), list(range(1, 1 + len(came))))
        self.assertTrue(all(step > came.get(cell, 0) for cell, step in left.items()))
        # What came in makes up a fifth of what flowed in, to one cell.
        area = float(next(cell for cell in cells if cell["cell"] == "1")["area_m2"])
        self.assertAlmostEqual(len(came) * area / (0.2 * MEAN * FED_HEIGHT * last["time_s"]), 1, delta=1 / len(came))
        ends_of_x = json.loads((self.folder / "fed/summary.json").read_text())["cell_traffic"]["stages"][0]["ends"]
        self.assertAlmostEqual(ends_of_x[0]["discharge_hematocrit"] / 0.2, 1, delta=0.05)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_the_same_bytes_where_cells_come_and_leave(self):
        self.same_bytes(changed(FED, stages__0__duration="40 ms"), "fed")
        self.same_bytes(changed(FORKED, stages__0__duration="20 ms"), "forked")

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_cells_in_space_come_and_leave(self):
        self.run_scene(FED_TUBE, "tube")
        came, left = self.traffic("tube")
        self.assertGreater(len(came), 3)
        self.assertGreater(len(left), 0)
        if not HAS_RANKS:
            return
        self.run_scene(FED_TUBE, "tube-ranks", ranks=2)
        self.assertEqual(differences(self.folder / "tube", self.folder / "tube-ranks"), [])

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_openings_beside_each_other_have_their_own_flows(self):
        # A wall from end to end: two channels of 3 um and 5 um between the same two pressures.
        wall = {"box": {"lower": ["0 um", "3 um"], "upper": ["20 um", "5 um"]}}
        heights = (3e-6, 5e-6)
        scene = changed(CHANNEL, domain__nodes=[80, 40], domain__x=ends(PRESSURE), domain__obstacles=[wall],
                        stages__0__duration="2 ms", output__cells__seconds="1 ms")
        row = self.run_scene(scene, "beside")[-1]
        gradient = float(PRESSURE["pressure"].split()[0]) / LENGTH
        for end in ("inlet", "outlet"):
            for number, height in enumerate(heights, 1):
                flow = row[f"{end}_{number}_flow_m2_per_s"]
                self.assertAlmostEqual(flow / (gradient * height ** 3 / (12 * VISCOSITY)), 1, delta=1e-2)
            parts = sum(row[f"{end}_{number}_flow_m2_per_s"] for number in (1, 2))
            self.assertAlmostEqual(parts / row[f"{end}_flow_m2_per_s"], 1, delta=1e-12)
        self.assertNotIn("inlet_3_flow_m2_per_s", row)
        self.assertNotIn("inlet_1_cells", row)  # none may come
        rows = {row["quantity"]: row["si"] for row in json.loads(self.rouleau("plan", "scene.json", "--json").stdout)["conversions"]}
        for name, height in (("inlet 1, around (0 um, 1.5 um)", 3e-6), ("inlet 2, around (0 um, 7.5 um)", 5e-6),
                             ("outlet 1, around (20 um, 1.5 um)", 3e-6), ("outlet 2, around (20 um, 7.5 um)", 5e-6)):
            self.assertAlmostEqual(rows[name] / height, 1, delta=1e-9)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_cells_are_counted_by_the_opening_that_they_leave_through(self):
        rows = self.run_scene(FORKED, "forked")
        inlet, outlet = json.loads((self.folder / "forked/summary.json").read_text())["cell_traffic"]["stages"][0]["ends"]
        self.assertNotIn("openings", inlet)
        last = rows[-1]
        self.assertGreater(min(last["outlet_1_cells"], last["outlet_2_cells"]), 3)
        self.assertEqual(last["outlet_1_cells"] + last["outlet_2_cells"], last["cells_out"])
        self.assertEqual([opening["cells_out"] for opening in outlet["openings"]],
                         [last["outlet_1_cells"], last["outlet_2_cells"]])
        for key in ("cells_out", "volume_out", "flow_in"):
            self.assertAlmostEqual(sum(opening[key] for opening in outlet["openings"]) / outlet[key], 1, delta=1e-12)
        went = {}  # where each cell was last seen
        with open(self.folder / "forked/cells.csv") as table:
            for cell in csv.DictReader(table):
                went[int(cell["cell"])] = (float(cell["x_m"]), float(cell["y_m"]))
        _, left = self.traffic("forked")
        # The wall between the outlets begins at 20 um: who was last seen behind that left through the branch it was in.
        seen = [went[cell][1] > 9e-6 for cell in left if went[cell][0] > 22e-6]
        self.assertGreaterEqual(last["outlet_2_cells"], sum(seen))
        self.assertGreaterEqual(last["outlet_1_cells"], len(seen) - sum(seen))

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_behind_a_pressure_cells_come_by_the_flow_that_is_measured(self):
        pressure = f"{12 * VISCOSITY * MEAN * 40e-6 / FED_HEIGHT ** 2!r} Pa"
        scene = changed(FORKED, domain__x=ends({"pressure": pressure, "cells": {"type": "disc", "hematocrit": 0.3}}),
                        domain__obstacles=[], stages__0__duration="0.06 s")
        last = self.run_scene(scene, "by-pressure", "--max-steps", "9000")[-1]
        last = self.run_scene(scene, "by-pressure", "--resume")[-1]
        traffic = json.loads((self.folder / "by-pressure/summary.json").read_text())["cell_traffic"]
        inlet = traffic["stages"][0]["ends"][0]
        self.assertEqual(traffic["cells_in"], traffic["cells_due"])
        self.assertGreater(last["cells_in"], 15)
        self.assertAlmostEqual(inlet["volume_in"], 0.3 * inlet["flow_in"], delta=inlet["volume_in"] / inlet["cells_in"])
        flows = [row["inlet_flow_m2_per_s"] for row in self.rows("by-pressure")]  # every millisecond
        self.assertAlmostEqual(inlet["flow_in"] / (1e-3 * (sum(flows) - flows[-1] / 2)), 1, delta=0.02)
        self.run_scene(scene, "by-pressure-whole", "--threads", "2")
        self.assertEqual(differences(self.folder / "by-pressure", self.folder / "by-pressure-whole"), [])

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_a_dense_feed_keeps_its_hematocrit_and_no_cell_waits(self):
        self.run_scene(DENSE, "dense")
        traffic = json.loads((self.folder / "dense/summary.json").read_text())["cell_traffic"]
        inlet = traffic["stages"][0]["ends"][0]
        self.assertEqual(traffic["cells_in"], traffic["cells_due"])
        self.assertGreater(traffic["cells_out"], 5)
        # The whole number of cells is off by half a one.
        flow = MEAN * FED_HEIGHT * DENSE_SECONDS
        self.assertAlmostEqual(inlet["volume_in"] / flow / DENSE_HEMATOCRIT, 1, delta=0.02)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_stages_can_be_made_longer_when_a_run_with_a_feed_goes_on(self):
        short, longer = (changed(FORKED, stages__0__duration=time) for time in ("20 ms", "30 ms"))
        self.run_scene(longer, "at-once")
        self.run_scene(short, "longer")
        self.run_scene(longer, "longer", "--resume", "--force")
        for table in ("series.csv", "cells.csv"):
            rows = [[row for row in (self.folder / name / table).read_text().splitlines()] for name in ("at-once", "longer")]
            self.assertEqual(*rows)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_flow_along_another_axis_is_that_along_x_turned(self):
        for name, scene, axis in (("y", SHAPED, "y"), ("y-pressure", changed(SHAPED, domain__x=ends(PRESSURE)), "y"),
                                  ("duct-y", DUCT, "y"), ("duct-z", changed(DUCT, domain__x=ends(PRESSURE)), "z")):
            rows, rows_too = self.run_scene(scene, name), self.run_scene(turned(scene, axis), f"{name}-turned")
            self.assertEqual(len(rows), len(rows_too))
            for key, value in rows[-1].items():
                if key == "stage_name" or math.isnan(value):
                    continue
                if axis == "z" and key.endswith(("_J_per_m", "_W_per_m")):  # over the depth, which is the length now
                    value *= 4 / 6
                off = 1e-7 if key == "mean_velocity_m_per_s" else 1e-9  # the fluid's area comes from parts of the domain
                self.assertAlmostEqual(rows_too[-1][key], value, delta=off * abs(value), msg=f"{name} {key}")
            self.assertFalse(math.isnan(rows_too[-1]["wall_stress_lower_Pa"]))

    def fed_along(self, scene, name, axis, content):
        rows = self.run_scene(scene, name)
        came, left = self.traffic(name)
        self.assertEqual((rows[-1]["cells_in"], rows[-1]["cells_out"]), (len(came), len(left)))
        self.assertGreater(len(came), 3)
        self.assertGreater(len(left), 0)
        with open(self.folder / name / "cells.csv") as table:
            cells = list(csv.DictReader(table))
        length = float(scene["domain"]["size"]["xyz".index(axis)].split()[0]) * UM
        self.assertTrue(all(0 < float(cell[f"{axis}_m"]) < length and float(cell["min_gap_m"]) > 0 for cell in cells))
        self.assertEqual(sorted(came)[-1], len(came) - (0 if scene.get("cells") else 1))
        inlet = json.loads((self.folder / name / "summary.json").read_text())["cell_traffic"]["stages"][0]["ends"][0]
        hematocrit = scene["domain"][axis]["lower"]["inlet"]["cells"]["hematocrit"]
        self.assertAlmostEqual(inlet["volume_in"], hematocrit * inlet["flow_in"], delta=content)

    @unittest.skipIf(WITHOUT_WHOLE_RUNS, "slow")
    def test_cells_come_and_leave_along_y_and_along_z(self):
        self.fed_along(FED_ALONG_Y, "along-y", "y", 30e-12)
        self.fed_along(FED_ALONG_Z, "along-z", "z", 6e-18)
        self.same_bytes(changed(FED_ALONG_Y, stages__0__duration="40 ms"), "bytes-y")
        self.same_bytes(changed(FED_ALONG_Z, stages__0__duration="4 ms"), "bytes-z")

    def test_plan_tells_inlet_and_outlet(self):
        for scene, open_area, speed in ((CHANNEL, HEIGHT, 1.5e-3), (TUBE, math.pi * RADIUS ** 2, 2e-3),
                                        (ROUND, HEIGHT, 1.5e-3 * 20 / 12)):
            plan = json.loads(self.rouleau("plan", self.write(scene), "--json").stdout)
            rows = {row["quantity"]: row for row in plan["conversions"]}
            self.assertAlmostEqual(rows["open at the lower end along x, the inlet"]["si"] / open_area, 1, delta=1e-6)
            self.assertIn("open at the upper end along x, the outlet", rows)
            self.assertAlmostEqual(rows["mean velocity at the inlet"]["si"], MEAN, delta=1e-12)
            self.assertAlmostEqual(rows["largest speed of the flow, about"]["si"] / speed, 1, delta=0.01)
        said = self.rouleau("plan", self.write(changed(CHANNEL, domain__x=ends({"pressure": "1 Pa"})))).stdout.decode()
        self.assertIn("pressure at the inlet, above that at the outlet", said)

    def test_columns_are_there_between_openings_only(self):
        self.assertEqual(self.rouleau("run", self.write(changed(CHANNEL, stages__0__duration="2 us")), "--out", "open",
                                      "--quiet").returncode, 0)
        closed = changed(CHANNEL, stages__0={"name": "flow", "duration": "2 us", "mean_velocity": "1 mm/s"})
        del closed["domain"]["x"]
        self.assertEqual(self.rouleau("run", self.write(closed), "--out", "closed", "--quiet").returncode, 0)
        for name, there in (("open", True), ("closed", False)):
            self.assertEqual("inlet_flow_m2_per_s" in (self.folder / name / "series.csv").read_text(), there)
            self.assertEqual("inlet_flow" in (self.folder / name / "summary.json").read_text(), there)
            self.assertNotIn("m3_per_s", (self.folder / name / "series.csv").read_text())

    def test_what_openings_do_not_know_is_refused_with_a_remedy(self):
        cells = {"type": "rbc", "hematocrit": 0.3}
        fed = changed(CHANNEL, cell_types={"rbc": RED_CELL})
        for scene, words in (
                (changed(CHANNEL, domain__x={"lower": {"inlet": VELOCITY}}), "\"upper\" is missing"),
                (changed(CHANNEL, domain__x=ends({**VELOCITY, **PRESSURE})), "not at both"),
                (changed(CHANNEL, domain__x=ends({})), "does not say what it is kept at"),
                (changed(CHANNEL, domain__x=ends({"mean_velocity": "-1 mm/s"})), "its mean velocity is above 0"),
                (changed(fed, domain__x=ends({**VELOCITY, "cells": {**cells, "type": "rcb"}})), "did you mean \"rbc\"?"),
                (changed(fed, domain__x=ends({**VELOCITY, "cells": {**cells, "length": "15 um"}})), "twice as long"),
                (changed(fed, domain__x=ends({**VELOCITY, "cells": cells}), stages__0={"name": "s", "shear_rate": "1 1/s", "strain": 1}),
                 "no duration"),
                (changed(CHANNEL, domain__x=ends(PRESSURE), domain__y="periodic"), "nothing that could hold it"),
                (changed(CHANNEL, stages__0__mean_velocity="1 mm/s"), "leave this out"),
                (changed(CHANNEL, stages__0__pressure_gradient="1 Pa/m"), "leave this out"),
                (changed(CHANNEL, stages__0__start="developed"), "let the flow come to be"),
                (changed(CHANNEL, stages__0__shear_rate=0, stages__0__oscillation={"frequency": "1 kHz", "amplitude": "1 1/s"}),
                 "openings do not oscillate"),
                (changed(CHANNEL, fluid__layers=[{"from": "0 um", "to": "1 um", "viscosity": "2 cP"}]), "knows of no layers"),
                (changed(CHANNEL, fluid__body_force=["1 N/m3", "0 N/m3"]), "drive the flow along x"),
                (changed(CHANNEL, domain__obstacles=[{"box": {"lower": ["8 um", "0 um"], "upper": ["9 um", "10 um"]}}]),
                 "no way from the inlet to the outlet"),
                (changed(CHANNEL, domain__obstacles=[{"box": {"lower": ["0 um", "0 um"], "upper": ["9 um", "10 um"]}}]),
                 "no way from the inlet to the outlet"),
                (changed(FED_ALONG_Y, domain__obstacles=[{"box": {"lower": ["0 um", "20 um"], "upper": ["18 um", "29 um"]}}]),
                 "lower end along y"),
                (changed(CHANNEL, domain__y=ends(VELOCITY)), "open along x already"),
                (changed(CHANNEL, domain__x="periodic", domain__y={**ends(VELOCITY), "upper": {"wall": {}}}), "an inlet below goes with an outlet above"),
                (changed(FED_ALONG_Y, stages__0={"name": "s", "shear_rate": "1 1/s", "duration": "1 ms"}, interactions=[]), "shear_rate"),
                (changed(FED_ALONG_Y, stages__0__mean_velocity="1 mm/s"), "give domain.y.lower.inlet"),
                (changed(FED_ALONG_Y, fluid__body_force=["0 N/m3", "1 N/m3"]), "drive the flow along y"),
                (changed(FED_ALONG_Y, cells=[{"type": "rbc", "at": ["9 um", "2 um"]}]), "too near the inlet"),
                (changed(DUCT_STEP, domain={"size": ["6 um", "5 um", "6 um"], "nodes": [18, 15, 18], "y": WALLS, "z": ends(VELOCITY)},
                         stages__0={"name": "s", "shear_rate": "1 1/s", "duration": "1 ms"}), "across what flows"),
                (changed(fed, cells=[{"type": "rbc", "at": ["2 um", "5 um"]}]), "too near the inlet")):
            with self.subTest(words=words):
                self.assertIn(words, self.refusal(scene))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
