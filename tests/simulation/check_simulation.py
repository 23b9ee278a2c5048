"""rouleau.Simulation: the program's bits, views without copies, forces of one's own, errors, interruption.

usage: check_simulation.py SOURCE BUILD
"""

import copy
import gc
import json
import multiprocessing
import os
import pickle
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import unittest
import weakref
from pathlib import Path

sys.dont_write_bytecode = True
SOURCE, BUILD = (Path(a).resolve() for a in sys.argv[1:3])
sys.path.insert(0, str(BUILD / "python"))
try:
    import numpy
    import pandas  # noqa: F401
except ImportError:
    print("numpy or pandas is missing (Debian: python3-numpy python3-pandas)")
    sys.exit(77)
import rouleau  # noqa: E402

PROGRAM = BUILD / "bin/rouleau"
SMALL = json.loads((SOURCE / "tests/resume/scenes/small.json").read_text())
# Two stages, of which the first ends by rest; a viscosity contrast, attraction, and a law that remembers.
SMALL["cell_types"]["round"] |= {
    "interior_viscosity": "6 cP",
    "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}},
                 {"model": "standard-linear-solid", "parameters": {"modulus": "5e-6 N/m", "relaxation_time": "40 ms"}}]}
SMALL["interactions"] = [{"between": ["round", "round"], "model": "morse", "parameters": {
    "depth": "5.2e-8 J/m2", "zero_force_distance": "1 um", "cutoff": "3 um"}}]
SMALL["stages"] = [{"name": "rest", "duration": "1 s", "until": "at_rest"},
                   {"name": "shear", "shear_rate": "20 1/s", "strain": 0.5}]
SMALL["at_rest"] = {"window": "2 ms", "displacement": "20 um"}
SMALL["output"] = {"cells": {"strain": 0.1}, "checkpoint": {"seconds": 600}}


# A stiff capsule in shear, in three dimensions.
SPACE = json.loads((SOURCE / "tests/physics/scenes/plain-capsule-3d.json").read_text())
SPACE["domain"] |= {"size": ["12 um", "9.6 um", "10.8 um"], "nodes": [40, 32, 36]}
SPACE["cells"] = [{"type": "capsule", "at": ["5 um", "4.8 um", "5.4 um"]}]
SPACE["cell_types"]["capsule"]["interior_viscosity"] = "6 cP"


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)
        self.scene = self.path / "small.json"
        self.scene.write_text(json.dumps(SMALL))

    def program(self, *words, code=0):
        result = subprocess.run([PROGRAM, "run", self.scene, "--quiet", *map(str, words)], capture_output=True, text=True,
                                timeout=120)
        self.assertEqual(result.returncode, code, result.stderr)

    def assert_same_state(self, one, other):
        """To the last bit: membranes, and the fluid that their forces act on."""
        self.assertEqual((one.step_count, one.stage, one.time, one.strain),
                         (other.step_count, other.stage, other.time, other.strain))
        for name in ("positions", "velocities", "forces"):
            self.assertTrue(numpy.array_equal(getattr(one, name), getattr(other, name)), name)
        for name in ("velocity", "density"):
            self.assertTrue(numpy.array_equal(getattr(one, name)().values, getattr(other, name)().values), name)


class It_computes_what_the_program_does(Case):
    def test_to_the_last_bit_through_the_end_of_a_stage_with_any_number_of_threads(self):
        for threads, precision in ((1, "f64"), (2, "f64"), (1, "f32")):
            with self.subTest(threads=threads, precision=precision):
                out = self.path / f"{threads}-{precision}"
                self.program("--out", out, "--max-steps", 150, "--set", f"/numerics/precision={precision}")
                simulation = rouleau.Simulation(self.scene, threads=threads, **{"numerics.precision": precision})
                self.assertEqual(simulation.step(150), 150)
                self.assertEqual(simulation.stage, "shear")  # it has come to the second one
                self.assert_same_state(simulation, rouleau.Simulation.load(out))

    def test_whether_or_not_somebody_looks_between_the_steps(self):
        watched, other = (rouleau.Simulation(SMALL) for _ in range(2))
        for _ in range(60):
            watched.step(1)
            watched.forces
            watched.cells()
        other.step(60)
        self.assert_same_state(watched, other)

    def test_to_the_end_of_the_scene(self):
        self.program("--out", self.path / "run")
        run = rouleau.open(self.path / "run")
        simulation = rouleau.Simulation(SMALL)
        self.assertFalse(simulation.done)
        self.assertEqual(simulation.step(10**9), run.summary.steps)
        self.assertTrue(simulation.done)
        self.assertEqual(simulation.step(1), 0)
        self.assertEqual((simulation.strain, simulation.time), (run.summary.strain, run.summary.simulated_time_s))
        last, cell = run.cells.iloc[-1], simulation.cells().iloc[-1]
        for name in set(run.cells) - {"type", "aggregate", "bonded", "stage", "stage_name"}:
            numpy.testing.assert_allclose(float(cell[name]), float(last[name]), rtol=1e-6, err_msg=name)


class In_three_dimensions(Case):
    def setUp(self):
        super().setUp()
        self.scene.write_text(json.dumps(SPACE))

    def test_it_computes_what_the_program_does_and_saves_what_goes_on(self):
        out = self.path / "run"
        self.program("--out", out, "--max-steps", 40)
        simulation = rouleau.Simulation(self.scene, threads=2)
        simulation.step(25)
        simulation.forces
        simulation.save(self.path / "saved")
        for part in (simulation, rouleau.Simulation.load(self.path / "saved")):
            part.step(15)
            self.assert_same_state(part, rouleau.Simulation.load(out))

    def test_shapes_and_places(self):
        simulation = rouleau.Simulation(SPACE, **{"stages/0/shear_rate": "50 1/s"})
        nodes = simulation.cell_nodes[0].stop
        for array in (simulation.positions, simulation.velocities, simulation.forces):
            self.assertEqual(array.shape, (nodes, 3))
            self.assertFalse(array.flags.writeable)
        middle = (simulation.positions.mean(axis=0) + 0.5) * simulation.spacing
        numpy.testing.assert_allclose(middle, [5e-6, 4.8e-6, 5.4e-6], rtol=1e-6)
        velocity, density = simulation.velocity(), simulation.density()
        self.assertEqual((velocity.values.shape, density.values.shape), ((36, 32, 40, 3), (36, 32, 40)))
        self.assertEqual([len(axis) for axis in (velocity.x, velocity.y, velocity.z)], [40, 32, 36])
        # Couette flow from the start: the walls' speed is half the rate times the height.
        numpy.testing.assert_allclose(velocity.values[0, :, 0, 0], 50 * (velocity.y - 4.8e-6), atol=1e-9)
        self.assertEqual(simulation.cells()["volume_m3"].size, 1)

    def test_a_force_of_ones_own_is_newtons_and_moves_the_cell_as_it_points(self):
        rest = {"stages": [{"name": "rest", "duration": "1 s"}], "output": {}}
        pulled, alone = (rouleau.Simulation(SPACE | rest) for _ in range(2))
        nodes = len(pulled.positions)
        pulled.add_force(lambda simulation: [0, 0, 1e-12 / nodes])
        for simulation in (pulled, alone):
            simulation.step(20)
        self.assertGreater(pulled.positions[:, 2].mean(), alone.positions[:, 2].mean() + 1e-6)
        added = (pulled.forces - alone.forces).sum(axis=0) * pulled.force_unit
        numpy.testing.assert_allclose(added, [0, 0, 1e-12], atol=1e-15)  # what models do sums up to nothing

    def test_without_cells_there_are_no_nodes_in_three_dimensions(self):
        empty = rouleau.Simulation({key: value for key, value in SPACE.items() if key not in ("cells", "cell_types")})
        self.assertEqual(empty.step(3), 3)
        self.assertEqual(empty.positions.shape, (0, 3))

    def test_too_many_numbers_are_refused(self):
        simulation = rouleau.Simulation(SPACE)
        simulation.add_force(lambda simulation: numpy.zeros((3, 2)))
        with self.assertRaises(ValueError):
            simulation.step(1)


class A_checkpoint(Case):
    def test_goes_on_with_the_same_bits_whether_or_not_forces_were_looked_at(self):
        whole = rouleau.Simulation(self.scene)
        whole.step(100)
        for looks in (False, True):
            with self.subTest(looks=looks):
                broken = rouleau.Simulation(self.scene)
                broken.step(60)
                if looks:
                    broken.forces
                broken.save(self.path / "saved")
                other = rouleau.Simulation.load(self.path / "saved", threads=2)
                for part in (broken, other):
                    part.step(40)
                    self.assert_same_state(part, whole)

    def test_is_one_that_the_program_goes_on_from(self):
        simulation = rouleau.Simulation(self.scene)
        simulation.step(60)
        simulation.save(self.path / "saved")
        self.program("--out", self.path / "saved", "--resume", "--max-steps", 100)
        simulation.step(40)
        self.assert_same_state(simulation, rouleau.Simulation.load(self.path / "saved"))


class Views(Case):
    def test_are_the_simulations_own_memory_and_cannot_be_written_to(self):
        simulation = rouleau.Simulation(SMALL)
        for name in ("positions", "velocities", "forces"):
            view, again = getattr(simulation, name), getattr(simulation, name)
            self.assertEqual(view.shape, (48, 2))
            address, _ = view.__array_interface__["data"]
            self.assertEqual(address, again.__array_interface__["data"][0], name)
            self.assertFalse(view.flags.owndata or view.flags.writeable, name)
            with self.assertRaises(ValueError):
                view[0, 0] = 1
        view = simulation.positions
        before, address = view.copy(), view.__array_interface__["data"][0]
        simulation.step(40)  # into the next stage
        self.assertFalse(numpy.array_equal(view, before))
        self.assertEqual(simulation.positions.__array_interface__["data"][0], address)

    def test_keep_the_memory_after_the_simulation_has_gone(self):
        simulation = rouleau.Simulation(SMALL)
        simulation.step(5)
        view = simulation.positions
        copy, gone = view.copy(), weakref.ref(simulation)
        del simulation
        gc.collect()
        self.assertIsNone(gone())
        self.assertTrue(numpy.array_equal(view, copy))

    def test_have_the_place_and_the_unit_of_what_they_show(self):
        simulation = rouleau.Simulation(SMALL)
        outline = (simulation.positions[simulation.cell_nodes[1]] + 0.5) * simulation.spacing
        numpy.testing.assert_allclose(outline.mean(axis=0), [13e-6, 8e-6], rtol=1e-12)
        numpy.testing.assert_allclose(numpy.hypot(*(outline - [13e-6, 8e-6]).T), 2e-6, rtol=1e-6)

    def test_of_the_fluid_have_the_flow_of_the_walls(self):
        scene = {key: value for key, value in SMALL.items() if key not in ("cells", "cell_types", "interactions", "at_rest")}
        scene["stages"] = [{"name": "shear", "shear_rate": "20 1/s", "strain": 1, "start": "developed"}]
        simulation = rouleau.Simulation(scene)
        simulation.step(10)
        velocity = simulation.velocity()
        self.assertEqual((velocity.values.shape, velocity.unit), ((32, 48, 2), "m/s"))
        wanted = numpy.broadcast_to(20 * (velocity.y[:, None] - 8e-6), (32, 48))
        numpy.testing.assert_allclose(velocity.values[..., 0], wanted, rtol=1e-9)
        numpy.testing.assert_allclose(velocity.values[..., 1], 0, atol=1e-15)
        self.assertEqual((velocity.x[0], len(velocity.x)), (0.25e-6, 48))


class A_force_of_ones_own(Case):
    def test_moves_the_cells_that_it_acts_on_and_is_felt_in_newtons(self):
        simulation = rouleau.Simulation(SMALL)
        models_alone = rouleau.Simulation(SMALL)
        pull = numpy.zeros((48, 2))
        pull[simulation.cell_nodes[0], 1] = 2e-7
        simulation.add_force(lambda sim: pull)
        difference = (simulation.forces - models_alone.forces) * simulation.force_unit
        numpy.testing.assert_allclose(difference, pull, atol=1e-12)
        start = simulation.positions.copy()
        simulation.step(30)
        moved = simulation.positions - start
        self.assertGreater(moved[:24, 1].mean(), 0.05)
        self.assertGreater(moved[:24, 1].mean(), moved[24:, 1].mean())

    def test_is_asked_once_a_step_and_can_be_taken_away(self):
        simulation = rouleau.Simulation(SMALL, threads=2)
        calls = []
        simulation.add_force(lambda sim: calls.append(1) or 0.0)
        simulation.step(7)
        simulation.forces
        simulation.step(3)
        self.assertEqual(len(calls), 10)
        simulation.add_force(None)
        simulation.step(3)
        self.assertEqual(len(calls), 10)
        plain = rouleau.Simulation(SMALL)
        plain.step(13)
        self.assert_same_state(simulation, plain)

    def test_that_raises_ends_the_step_with_its_own_exception(self):
        simulation = rouleau.Simulation(SMALL, threads=2)
        simulation.add_force(lambda sim: 1 / 0)
        with self.assertRaises(ZeroDivisionError):
            simulation.step(1)
        with self.assertRaisesRegex(rouleau.Error, "ended in the middle"):
            simulation.step(1)

    def test_is_refused_with_the_slip_correction(self):
        simulation = rouleau.Simulation(SMALL, **{"numerics.slip_correction": True})
        with self.assertRaises(rouleau.Error) as raised:
            simulation.add_force(lambda sim: 0)
        self.assertEqual(raised.exception.pointer, "/numerics/slip_correction")
        self.assertIn("slip_correction to false", raised.exception.remedy)


class Errors(Case):
    def test_have_place_and_remedy(self):
        self.scene.write_text(json.dumps(SMALL).replace('"1.2 cP"', '"1.2 um"'))
        with self.assertRaises(rouleau.Error) as raised:
            rouleau.Simulation(self.scene)
        error = raised.exception
        self.assertEqual((error.file, error.pointer, error.line, error.exit_code), (str(self.scene), "/fluid/viscosity", 1, 2))
        self.assertIn("1.2 um", error.problem)
        with self.assertRaises(rouleau.Error) as raised:
            rouleau.Simulation(SMALL, **{"fluid.viscosity": "1 um", "numerics.tau": -1})
        self.assertEqual(len(raised.exception.faults), 2)
        with self.assertRaises(rouleau.Error) as raised:
            rouleau.Simulation(self.path / "nowhere.json")
        self.assertEqual(raised.exception.exit_code, 4)

    def test_say_which_number_is_none(self):
        simulation = rouleau.Simulation(self.scene, threads=numpy.int64(1))
        self.assertEqual(simulation.step(2.0) + simulation.step(numpy.int32(1)), 3)
        for count in (-1, 1.5, "2", None):
            with self.assertRaisesRegex(rouleau.Error, "count is"):
                simulation.step(count)
        for threads in (0, "2", 1.5):
            with self.assertRaisesRegex(rouleau.Error, "threads is"):
                rouleau.Simulation(self.scene, threads=threads)

    def test_say_that_a_check_has_failed(self):
        simulation = rouleau.Simulation(SMALL, **{"checks.area_drift": 1e-12})
        with self.assertRaises(rouleau.Error) as raised:
            simulation.step(1000)
        self.assertEqual(raised.exception.exit_code, 1)
        self.assertIn("area_drift at step", raised.exception.problem)

    def test_refuse_a_checkpoint_of_another_scene(self):
        simulation = rouleau.Simulation(SMALL)
        simulation.save(self.path / "saved")
        scene = json.loads((self.path / "saved/scene.json").read_text())
        scene["fluid"]["viscosity"] = "2 cP"
        (self.path / "saved/scene.json").write_text(json.dumps(scene))
        with self.assertRaisesRegex(rouleau.Error, "/fluid/viscosity"):
            rouleau.Simulation.load(self.path / "saved")


SOFT = r'''
#include <rouleau/plugin.h>
#include <stdlib.h>
struct soft { double A, rc; };
static int create(const rouleau_setup* setup, void** self, char* error, size_t size) {
  struct soft* m = malloc(sizeof *m);
  m->A = FACTOR * setup->parameter_values[0], m->rc = setup->parameter_values[1], *self = m;
  return 0;
}
static double cutoff(const void* self) { return ((const struct soft*)self)->rc; }
static void compute(const void* self, const rouleau_interaction_block* b) {
  const struct soft m = *(const struct soft*)self;
  DEED;
  for (uint32_t i = 0; i < b->count; ++i) {
    const double u = 1 - b->distance[i] / m.rc;
    if (b->energy) b->energy[i] = m.A * m.rc * u * u / 2;
    if (b->force) b->force[i] = m.A * u;
    if (b->force_by_distance) b->force_by_distance[i] = -m.A / m.rc;
  }
}
static const rouleau_interaction functions = {sizeof functions, cutoff, compute};
static const rouleau_model model = {.struct_size = sizeof model, .kind = ROULEAU_INTERACTION_KIND, .id = "org.example.soft",
  .version = "1.0.0", .create = create, .destroy = free, .interaction = &functions};
static const rouleau_model* const models[] = {&model, NULL};
static const rouleau_plugin plugin = {sizeof plugin, ROULEAU_ABI_MINOR, models};
const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) { return &plugin; }
'''
SOFT_MANIFEST = {
    "manifest": 1, "abi": 1, "kind": "interaction", "id": "org.example.soft", "version": "1.0.0", "library": "libsoft.so",
    "title": "Soft repulsion", "license": "MIT", "needs": ["distance"], "gives": ["energy", "force", "force_by_distance"],
    "parameters": [{"name": "stress", "unit": "Pa", "default": 0.2}, {"name": "cutoff", "unit": "m", "default": 3e-6}],
    "claims": {"conservative": True, "smooth_at_cutoff": True, "reproducible": True}}


@unittest.skipUnless(shutil.which("cc"), "a plugin is compiled")
class Somebodys_plugin(Case):
    def setUp(self):
        super().setUp()
        self.plugin = self.path / "plugin"
        self.plugin.mkdir()
        (self.plugin / "soft.json").write_text(json.dumps(SOFT_MANIFEST))
        self.changes = {"/interactions/0/model": "org.example.soft", "/interactions/0/parameters": {}}

    def build(self, factor=1.0, deed="", to="plugin/libsoft.so", more=()):
        (self.path / "soft.c").write_text("double factor_of_model(void);\n" + SOFT)
        subprocess.run(["cc", "-std=gnu11", "-O1", "-fPIC", "-shared", f"-DFACTOR={factor}", f"-DDEED={deed}", "-I",
                        SOURCE / "sdk/include", "soft.c", *more, "-o", to], check=True, cwd=self.path)

    def simulation(self, **more):
        return rouleau.Simulation(self.scene, plugins=[self.plugin], **self.changes, **more)

    def largest_force(self, simulation):
        laws = rouleau.Simulation(self.scene, interactions=[])  # the same places, without what the plugin adds
        return abs(simulation.forces - laws.forces).max()

    def test_that_was_built_anew_computes_anew_and_who_has_begun_goes_on(self):
        self.build()
        first = self.simulation()
        force = self.largest_force(first)
        self.assertGreater(force, 0)
        self.build(10.0)  # by the linker: another file
        self.assertAlmostEqual(self.largest_force(self.simulation()) / force, 10, delta=1e-6)
        self.build(100.0, to="other.so")
        shutil.copyfile(self.path / "other.so", self.plugin / "libsoft.so")  # in place
        self.assertAlmostEqual(self.largest_force(self.simulation()) / force, 100, delta=1e-5)
        (self.plugin / "libsoft.so").write_bytes(b"")
        self.assertEqual(first.step(5), 5)
        with self.assertRaisesRegex(rouleau.Error, "is no shared library"):
            self.simulation()

    def test_of_c_plus_plus_that_was_built_anew_takes_nothing_from_the_old_one(self):
        values = []
        for factor in (1, 10, 100):
            # What an inline function or a template keeps has one address in a process, whatever libraries have it.
            (self.path / "factor.cpp").write_text(
                "template <class T> struct Kept { static double& value() { static double kept = T::factor(); return kept; } };\n"
                f"struct Model {{ static double factor() {{ return {factor}; }} }};\n"
                'extern "C" double factor_of_model() { return Kept<Model>::value(); }\n')
            subprocess.run(["c++", "-O1", "-fPIC", "-c", "factor.cpp", "-o", "factor.o"], check=True, cwd=self.path)
            self.build("factor_of_model()", more=["factor.o", "-lstdc++"])
            values.append(self.largest_force(self.simulation()))
        numpy.testing.assert_allclose(values, values[0] * numpy.array([1, 10, 100]), rtol=1e-6)

    def test_that_ends_python_is_named(self):
        deeds = {"__builtin_trap()": (-signal.SIGILL, "an instruction"), "*(volatile int*)8=1": (-signal.SIGSEGV, "memory"),
                 "abort()": (-signal.SIGABRT, "abort"), "exit(0)": (3, "has ended the program")}
        for deed, (code, word) in deeds.items():
            self.build(deed=deed)
            script = f"import rouleau; rouleau.Simulation({str(self.scene)!r}, threads=2, " \
                     f"plugins=[{str(self.plugin)!r}], **{self.changes!r}).step(9)"
            end = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True, timeout=60,
                                 env={**os.environ, "PYTHONPATH": str(BUILD / "python")})
            self.assertEqual(end.returncode, code, end.stderr)
            self.assertIn('the plugin "org.example.soft"', end.stderr)
            self.assertIn(word, end.stderr)
            self.assertIn("in its function compute", end.stderr)

    def test_that_comes_with_a_scene_is_said_and_can_be_refused(self):
        self.build()
        brought = {**self.changes, "/plugin_dirs": [str(self.plugin)]}
        with self.assertWarnsRegex(UserWarning, "the scene brings code along.*libsoft.so"):
            rouleau.Simulation(self.scene, **brought)
        os.environ["ROULEAU_SCENE_PLUGINS"] = "no"
        self.addCleanup(os.environ.pop, "ROULEAU_SCENE_PLUGINS", None)
        for what in (rouleau.Simulation, rouleau.plan):
            with self.assertRaisesRegex(rouleau.Error, "not searched"):
                what(self.scene, **brought)


def children_sum(threads):
    simulation = rouleau.Simulation(SMALL, threads=threads)
    simulation.step(40)
    return float(simulation.positions.sum())


class Other_processes(Case):
    def test_of_a_fork_compute_the_same_whatever_threads_have_run_before(self):
        wanted = children_sum(1)
        for before, then in ((2, 2), (2, 1), (1, 2), (3, 2)):
            children_sum(before)
            with multiprocessing.get_context("fork").Pool(2) as pool:
                found = pool.map_async(children_sum, [then, then])
                self.assertEqual(found.get(timeout=60), [wanted, wanted])
            self.assertEqual(children_sum(before), wanted)  # and the parent goes on

    def test_goes_on_in_the_child_with_what_the_parent_had_begun(self):
        simulation, other = (rouleau.Simulation(SMALL, threads=2) for _ in range(2))
        for each in (simulation, other):
            each.step(20)
        other.step(20)
        child = os.fork()
        if child == 0:
            signal.alarm(60)
            simulation.step(20)
            os._exit(0 if numpy.array_equal(simulation.positions, other.positions) else 1)
        self.assertEqual(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]), 0)

    def test_and_copies_are_refused_in_words(self):
        simulation = rouleau.Simulation(SMALL)
        for copied in (copy.copy, copy.deepcopy, pickle.dumps):
            with self.assertRaisesRegex(rouleau.Error, r"neither copied nor pickled.*\n.*save\(\)"):
                copied(simulation)


class Steps(Case):
    SLOW = SOURCE / "scenes/four-cells-shear.json"

    def test_are_interrupted_by_ctrl_c_between_two_of_them(self):
        simulation = rouleau.Simulation(self.SLOW)
        threading.Timer(0.5, os.kill, (os.getpid(), signal.SIGINT)).start()
        with self.assertRaises(KeyboardInterrupt):
            simulation.step(10**6)
        steps = simulation.step_count
        self.assertGreater(steps, 0)
        self.assertEqual(simulation.step(3), 3)
        again = rouleau.Simulation(self.SLOW)
        again.step(steps + 3)
        self.assert_same_state(simulation, again)

    def test_let_other_threads_run(self):
        simulation = rouleau.Simulation(self.SLOW)
        beats, stop = [], threading.Event()

        def beat():
            while not stop.is_set():
                beats.append(1)
                time.sleep(0.005)

        thread = threading.Thread(target=beat)
        thread.start()
        during, steps = 0, 200
        while during <= 5 and steps < 10**4:  # one call; a longer one where the machine leaves a thread little time
            before = len(beats)
            simulation.step(steps)
            during, steps = len(beats) - before, 2 * steps
        stop.set()
        thread.join()
        self.assertGreater(during, 5)


if __name__ == "__main__":
    program = unittest.main(argv=sys.argv[:1], verbosity=1, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
