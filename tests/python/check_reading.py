"""rouleau.open: tables, stages, frames, pictures and comparisons of a real run, finished and still going."""

import contextlib
import csv
import json
import math
import os
import pathlib
import shutil
import subprocess
import tempfile

from package import Case, main, need, small_scene

need("numpy", "pandas", "h5py", "matplotlib")

import numpy  # noqa: E402
import rouleau  # noqa: E402

FOLDER = tempfile.TemporaryDirectory(prefix="rouleau-python-")
RUN = rouleau.run(small_scene(), f"{FOLDER.name}/run", progress=False)


class A_run(Case):
    def test_has_the_values_of_its_tables_bit_by_bit(self):
        for name in ("cells", "series", "aggregates"):
            with open(RUN.directory / f"{name}.csv", newline="") as file:
                rows = list(csv.DictReader(file))
            table = getattr(RUN, name)
            self.assertEqual(len(table), len(rows))
            for column in rows[0]:
                if column in ("type", "members", "stage_name"):
                    self.assertEqual(list(table[column]), [row[column] for row in rows])
                else:
                    expected = [float(row[column] or "nan") for row in rows]
                    numpy.testing.assert_array_equal(table[column].to_numpy(dtype=float), expected)

    def test_has_one_row_for_each_time_and_cell(self):
        self.assertFalse(RUN.cells.duplicated(["time_s", "cell"]).any())
        self.assertEqual(set(RUN.cells.groupby("time_s").size()), {2})

    def test_makes_a_table_over_the_strain_in_which_a_rest_has_one_row(self):
        self.assertGreater((RUN.series["strain"] == 0).sum(), 2)  # there was a rest
        table = RUN.pivot("deformation")
        self.assertTrue(table.index.is_unique)
        self.assertEqual(list(table.columns), [0, 1])
        last = RUN.cells[(RUN.cells["strain"] == 0) & (RUN.cells["cell"] == 1)].iloc[-1]
        self.assertEqual(table.loc[0.0, 1], last["deformation"])

    def test_has_its_summary_as_keys_and_as_attributes(self):
        expected = json.loads((RUN.directory / "summary.json").read_text())
        self.assertEqual(RUN.summary, expected)
        self.assertEqual(RUN.summary.conservation.mass_drift, expected["conservation"]["mass_drift"])
        self.assertEqual(RUN.summary.stages[1].name, "shear")
        with self.assertRaisesRegex(AttributeError, 'no "outcomes"'):
            RUN.summary.outcomes
        self.assertEqual((RUN.status, RUN.finished), ("completed", True))
        self.assertEqual(RUN.log[0].event, "started")

    def test_has_stages_that_begin_with_the_state_they_found(self):
        self.assertEqual(RUN.stages, ["rest", "shear"])
        rest, shear = RUN.stage("rest").series, RUN.stage("shear").series
        self.assertEqual(rest["step"].iloc[-1], shear["step"].iloc[0])
        self.assertEqual(shear["strain"].iloc[0], 0)
        self.assertTrue((shear["strain"].iloc[1:] > 0).all())
        self.assertEqual(len(rest) + len(shear), len(RUN.series) + 1)
        self.assert_refused('there is no stage "shear2"; there is rest, shear', RUN.stage, "shear2")

    def test_says_which_columns_there_are(self):
        self.assert_refused('did you mean "deformation"', RUN.pivot, "deformaton")
        self.assert_refused('no column "viscosity"', RUN.mean, "viscosity")


class A_frame(Case):
    def test_has_outlines_with_the_area_and_centroid_of_the_table(self):
        for strain in (0.0, 1.0, 2.0):
            frame = RUN.frame(strain=strain)
            rows = RUN.cells[RUN.cells["step"] == frame.step]
            for cell, (_, row) in zip(frame.cells, rows.iterrows(), strict=True):
                x, y = cell.outline.T
                cross = x * numpy.roll(y, -1) - numpy.roll(x, -1) * y
                area = 0.5 * cross.sum()
                centroid = ((x + numpy.roll(x, -1)) * cross).sum() / (6 * area)
                self.assertAlmostEqual(area / row["area_m2"], 1, delta=1e-9)
                self.assertAlmostEqual(centroid / row["x_m"], 1, delta=1e-9)

    def test_has_outlines_in_one_piece_that_move_into_the_box_as_a_whole(self):
        frame = RUN.frame()
        for cell in frame.cells:
            steps = numpy.linalg.norm(numpy.diff(cell.outline, axis=0), axis=1)
            self.assertLess(steps.max(), 2e-6)
            moved = cell.moved_into(frame.size_m)
            shift = (moved - cell.outline)[:, 0] / frame.size_m[0]
            self.assertTrue(numpy.allclose(shift, round(shift[0]), atol=1e-12))
            self.assertTrue(0 <= moved[:, 0].mean() < frame.size_m[0])

    def test_has_fields_at_the_places_of_the_lattice(self):
        frame = RUN.frame(strain=1, fields=True)
        velocity = frame.field("velocity")
        self.assertEqual((velocity.values.shape, velocity.unit), ((32, 48, 2), "m/s"))
        self.assertAlmostEqual(velocity.x[0], 0.25e-6, delta=1e-15)
        self.assertAlmostEqual(velocity.y[-1], 15.75e-6, delta=1e-15)
        # Walls move with -+ shear_rate height/2; the nodes beside them lie a quarter of a micrometre away.
        wall = 20 * 8e-6
        self.assertAlmostEqual(velocity.values[-1, :, 0].mean() / wall, 1 - 0.25 / 8, delta=0.02)
        self.assert_refused('has no field "vorticity"; it has', frame.field, "vorticity")

    def test_is_the_nearest_to_a_strain_or_a_time_and_of_a_rest_the_last(self):
        self.assertAlmostEqual(RUN.frame(strain=0.9).strain, 1, delta=0.13)
        self.assertEqual(RUN.frame(strain=0).step, RUN.stage("rest").series["step"].iloc[-1])
        self.assertEqual(RUN.frame(time_s=0).step, 0)
        self.assertEqual(RUN.frame().step, RUN.summary.steps)
        self.assertEqual(RUN.frame(index=0).step, 0)
        self.assert_refused("strain 9 is outside of what the run has", RUN.frame, strain=9)
        self.assert_refused("wants one of", RUN.frame, strain=1, index=0)


class Cells_that_come_and_leave(Case):
    """A run's files as they are written where cells come and leave: 0 leaves, nothing is there, 2 has come."""

    THERE = [[0, 1], [1, 2], [], [2]]

    def setUp(self):
        super().setUp()
        import h5py
        self.folder = pathlib.Path(self.path) / "open"
        self.folder.mkdir()
        rows = [(step, cell) for step, cells in enumerate(self.THERE) for cell in cells]
        texts = {"scene.json": "{}", "summary.json": json.dumps({"status": "completed", "outcome": "completed", "rheology": []}),
                 "cells.csv": "step,time_s,strain,cell,type,deformation,aggregate\n" + "".join(
                     f"{step},{step / 10},0,{cell},rbc,{(1 + cell) / 10},{cell}\n" for step, cell in rows),
                 "series.csv": "step,time_s,strain,stage_name,cells_inside\n" + "".join(
                     f"{step},{step / 10},0,flow,{len(cells)}\n" for step, cells in enumerate(self.THERE))}
        for name, text in texts.items():
            (self.folder / name).write_text(text)
        with h5py.File(self.folder / "frames.h5", "w") as file:
            file.attrs.update(size_m=[2e-5, 1e-5], nodes=[8.0, 4.0])
            for step, cells in enumerate(self.THERE):
                frame = file.create_group(f"frames/{step:06}")
                frame.attrs.update(step=step, time_s=step / 10, strain=0.0, stage=0, stage_name="flow")
                if not cells:
                    continue
                of_node = numpy.repeat(cells, 3)
                frame["membranes/points"] = numpy.stack([1e-6 * of_node, numpy.arange(len(of_node)) * 1e-6], axis=1)
                frame["membranes/tension"] = 1e-6 * of_node
                frame["membranes/first"] = numpy.arange(len(cells) + 1) * 3
                frame["membranes/cell"] = frame["membranes/aggregate"] = of_node

    def test_have_their_numbers_in_every_frame(self):
        run = rouleau.open(self.folder)
        for step, cells in enumerate(self.THERE):
            frame = run.frame(index=step)
            self.assertEqual([cell.number for cell in frame.cells], cells)
            for cell in frame.cells:
                self.assertEqual(list(cell.outline[:, 0]), [1e-6 * cell.number] * 3)
            frame.plot()

    def test_have_a_column_each_in_which_what_was_not_there_is_nan(self):
        run = rouleau.open(self.folder)
        table = run.pivot("deformation", over="step")
        self.assertEqual(list(table.columns), [0, 1, 2])
        expected = [[0.1, 0.2, math.nan], [math.nan, 0.2, 0.3], [math.nan, math.nan, 0.3]]
        numpy.testing.assert_array_equal(table.to_numpy(), expected)
        self.assertEqual(run.results.loc["deformation", "value"], 0.3)
        run.plot("deformation", over="time_s")


class Fields_in_space(Case):
    """Of a capsule between walls that move, and in a tube; the lattice of the former is periodic along z."""

    SCENE = {
        "rouleau": 1, "title": "space",
        "domain": {"size": ["8 um", "6 um", "7 um"], "nodes": [16, 12, 14],
                   "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
        "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
        "numerics": {"density_factor": 300},
        "cell_types": {"capsule": {"shape": {"sphere": {"radius": "1.5 um"}}, "triangles": 180,
                                   "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-5 N/m"}}]}},
        "cells": [{"type": "capsule", "at": ["4 um", "2.6 um", "3.3 um"]}],
        "stages": [{"name": "flow", "walls": {"lower": "-0.2 mm/s", "upper": "0.5 mm/s"}, "duration": "2 ms"}],
        "output": {"fields": {"seconds": "2 ms", "quantities": ["velocity", "vorticity"], "precision": "f64"}},
    }

    def last_frame(self, scene, out):
        return rouleau.run(scene, f"{self.path}/{out}", progress=False).frame(index=-1, fields=True)

    def vorticity(self, velocity, spacing, walls):
        """By central differences of [nz, ny, nx, 3], periodic along x and z, walls along y."""
        below, above = 2 * numpy.zeros((2, *velocity[:, :1].shape)) - velocity[:, [0, -1]].swapaxes(0, 1)[:, :, None]
        below[..., 0] += 2 * walls[0]
        above[..., 0] += 2 * walls[1]
        tall = numpy.concatenate([below, velocity, above], axis=1)
        along = {0: (numpy.roll(velocity, -1, 2) - numpy.roll(velocity, 1, 2)) / (2 * spacing),
                 1: (tall[:, 2:] - tall[:, :-2]) / (2 * spacing),
                 2: (numpy.roll(velocity, -1, 0) - numpy.roll(velocity, 1, 0)) / (2 * spacing)}
        return numpy.stack([along[1][..., 2] - along[2][..., 1], along[2][..., 0] - along[0][..., 2],
                            along[0][..., 1] - along[1][..., 0]], axis=-1)

    def test_have_the_vorticity_of_their_velocity(self):
        frame = self.last_frame(self.SCENE, "whole")
        velocity, written = frame.field("velocity").values, frame.field("vorticity")
        self.assertEqual((written.values.shape, written.unit), ((14, 12, 16, 3), "1/s"))
        expected = self.vorticity(velocity, 0.5e-6, (-0.2e-3, 0.5e-3))
        largest = abs(expected).max()
        self.assertGreater(largest, 50)
        for component in range(3):
            self.assertGreater(abs(expected[..., component]).max(), 1e-2 * largest)
        self.assertLess(abs(written.values - expected).max(), 1e-9 * largest)

    def test_of_a_region_are_those_of_the_whole_lattice_there(self):
        scene = json.loads(json.dumps(self.SCENE))
        whole = self.last_frame(scene, "whole")
        scene["output"]["fields"].update(region={"from": ["1 um", "2 um", "2.9 um"], "to": ["6 um", "6 um", "5.3 um"]}, stride=2)
        part = self.last_frame(scene, "part")
        for name in ("velocity", "vorticity"):
            field = part.field(name)
            # Nodes lie at 0.25, 0.75, ... um.
            self.assertTrue((field.values == whole.field(name).values[6:11:2, 4:12:2, 2:12:2]).all())
            for places, first in ((field.x, 1.25e-6), (field.y, 2.25e-6), (field.z, 3.25e-6)):
                self.assertTrue(numpy.allclose(places, first + 1e-6 * numpy.arange(len(places)), atol=1e-15))

    def test_a_cell_is_written_as_a_mesh_with_which_another_run_begins_under_the_same_tension(self):
        left = self.last_frame(self.SCENE, "before").cells[0]
        left.write(f"{self.path}/left.obj")
        scene = json.loads(json.dumps(self.SCENE))
        capsule = scene["cell_types"]["capsule"]
        capsule.update(shape={"mesh": {"file": f"{self.path}/left.obj", "unit": "1 um"}}, stress_free={"sphere": {"radius": "1.5 um"}})
        del capsule["triangles"]
        begun = rouleau.run(scene, f"{self.path}/after", progress=False).frame(index=0).cells[0]
        self.assertGreater(left.tension.max(), 1e-8)
        self.assertTrue(numpy.allclose(begun.tension, left.tension, rtol=1e-6, atol=1e-12))
        places = [cell.outline - cell.outline.mean(axis=0) for cell in (left, begun)]
        self.assertLess(abs(places[0] - places[1]).max(), 1e-12)

    def test_vanish_in_the_wall_of_a_tube_and_turn_about_its_axis(self):
        scene = json.loads(json.dumps(self.SCENE))
        scene["domain"] = {"size": ["2 um", "8 um", "8 um"], "nodes": [8, 32, 32], "walls": {"tube": {"radius": "3.8 um"}}}
        scene["cells"] = []
        scene["stages"] = [{"name": "flow", "pressure_gradient": "1e5 Pa/m", "duration": "60 ms"}]
        scene["output"]["fields"]["seconds"] = "60 ms"
        scene["output"]["fields"]["quantities"].append("wall_shear_stress")
        frame = self.last_frame(scene, "tube")
        self.assertEqual(frame.walls.shear_stress.shape, frame.walls.facets.shape[::2])
        self.assertLess(abs(frame.walls.shear_stress.mean(axis=0) - [1e5 * 3.8e-6 / 2, 0, 0]).max(), 2e-3)  # G R / 2
        field = frame.field("vorticity")
        y, z = numpy.meshgrid(field.y - 4e-6, field.z - 4e-6)
        radius = numpy.hypot(y, z)
        inside = radius < 3.3e-6  # where neither neighbour is solid
        # u = G (R^2 - r^2) / (4 mu): du/dy = -G y / (2 mu), du/dz likewise.
        expected = numpy.stack([0 * y, -1e5 * z / 2.4e-3, 1e5 * y / 2.4e-3], axis=-1)
        layer = field.values[:, :, 3]
        self.assertTrue((layer[radius > 3.8e-6] == 0).all())
        self.assertLess(abs(layer - expected)[inside].max(), 0.01 * abs(expected).max())


class A_run_that_goes_on(Case):
    def setUp(self):
        super().setUp()
        self.going = self.path / "run"
        shutil.copytree(RUN.directory, self.going)
        (self.going / "summary.json").unlink()

    def test_is_read_up_to_its_last_whole_lines(self):
        for name in ("cells", "series", "aggregates"):
            table = self.going / f"{name}.csv"
            table.write_bytes(table.read_bytes()[:-30])  # in the midst of a line
        run = rouleau.open(self.going)
        self.assertEqual((run.status, run.finished), ("unfinished", False))
        self.assertEqual(len(run.series), len(RUN.series) - 1)
        self.assertEqual(len(run.cells), len(RUN.cells) - 1)
        self.assertEqual(run.summary.steps, run.series["step"].iloc[-1])

    def test_shows_what_has_been_written_since(self):
        table = self.going / "series.csv"
        text = table.read_text().splitlines(keepends=True)
        table.write_text("".join(text[:4]))
        run = rouleau.open(self.going)
        self.assertEqual(len(run.series), 3)
        table.write_text("".join(text))
        self.assertEqual(len(run.series), len(RUN.series))

    def test_has_the_frames_of_its_closed_files(self):
        if (self.going / "frames-0001.h5").exists():
            (self.going / "frames.h5").unlink()
        else:
            (self.going / "frames.h5").rename(self.going / "frames-0001.h5")
        (self.going / "frames-9999.h5").write_bytes(b"what HDF5 has not written yet")
        run = rouleau.open(self.going)
        self.assertEqual(len(run.frames), len(RUN.frames))
        self.assertEqual(len(run.frame(strain=1).cells), 2)


class A_mean(Case):
    def test_has_the_error_of_the_mean_of_its_parts(self):
        # Four parts with means 1, 2, 3, 4: mean 2.5, variance of the means 5/3.
        mean = rouleau.mean_and_error([0, 2, 1, 3, math.nan, 2, 4, 3, 5])
        self.assertEqual(mean.value, 2.5)
        self.assertAlmostEqual(mean.error, math.sqrt(5 / 3 / 4), delta=1e-15)
        # Nothing is left out: of five values the parts have one and a quarter each.
        mean = rouleau.mean_and_error([1, 1, 1, 1, 6])
        self.assertEqual(mean.value, 2)
        self.assertAlmostEqual(mean.error, math.sqrt((3 * 1 ** 2 + 3 ** 2) / 3 / 4), delta=1e-15)

    def test_weights_outputs_by_the_time_for_which_they_stand(self):
        # 3 - t from 1 on: as in the program's own tests, wherever outputs fall.
        for times in ([0, 0.9, 1.1, 1.2, 1.3, 2], [0, 1, 1.25, 1.5, 1.75, 2]):
            mean = rouleau.mean_and_error([3 - t for t in times], times=times, begin=1)
            self.assertAlmostEqual(mean.value, 1.5, delta=1e-14)
            self.assertAlmostEqual(mean.error, math.sqrt(0.3125 / 3 / 4), delta=1e-14)

    def test_takes_a_part_of_a_column(self):
        import pandas
        column = pandas.Series([9.0, 1.0, 2.0, 3.0, 2.0])[1:]
        self.assertEqual(rouleau.mean_and_error(column), rouleau.mean_and_error(column.tolist()))
        self.assertEqual(rouleau.mean_and_error(column, times=column.index), rouleau.mean_and_error(column.tolist(), times=[1, 2, 3, 4]))

    def test_of_too_few_values_is_no_number(self):
        self.assertTrue(math.isnan(rouleau.mean_and_error([1, 2, 3]).error))
        self.assertTrue(all(map(math.isnan, rouleau.mean_and_error([math.nan]))))

    def test_has_one_value_in_the_summary_in_python_and_in_tables_of_results(self):
        for told in RUN.summary.rheology:
            stage = RUN.stage(told.stage)
            for column, mean in told.means.items():
                if not isinstance(mean, dict):
                    continue
                with self.subTest(stage=told.stage, column=column):
                    own = stage.mean(column)
                    scale = max(abs(mean["mean"]), 1e-300)
                    self.assertAlmostEqual(own.value / scale, mean["mean"] / scale, delta=1e-9)
                    found, known = stage.statistics(column), told.statistics[column]
                    self.assertEqual(found.verdict, known["verdict"])
                    for name, value in (("mean", found.value), ("standard_error", found.error), ("bar_95", found.bar95),
                                        ("independent_parts", found.parts), ("length_of_part_s", found.length)):
                        if known[name] is None or not found.steady:
                            self.assertEqual(known[name] is None, not math.isfinite(value) or not found.steady, name)
                        else:
                            self.assertAlmostEqual(value / scale, known[name] / scale, delta=1e-6 * abs(value / scale) + 1e-9)
        last = RUN.summary.rheology[-1].means
        shared = [name for name in RUN.results.index if isinstance(last.get(name), dict)]
        self.assertIn("relative_viscosity", shared)
        self.assertIn("aggregate_size_number_mean", shared)
        for name in shared:
            known = RUN.summary.rheology[-1].statistics[name]["mean"]
            self.assertAlmostEqual(RUN.results.loc[name, "value"] / (last[name]["mean"] if known is None else known), 1, delta=1e-9)

    def test_of_layers_and_of_cells_that_nothing_joins_is_no_result(self):
        self.assertGreater(RUN.stage("shear").mean("cell_free_layer_empty").value, 0.05)
        self.assertNotIn("cell_free_layer_lower_m", RUN.results.index)
        self.assertIn("aggregates", RUN.results.index)
        alone = rouleau.run(small_scene(interactions=[]), self.path / "alone", progress=False)
        self.assertFalse([name for name in alone.results.index if "aggregate" in name])


class Two_runs(Case):
    def test_differ_in_their_scenes_and_results(self):
        other = rouleau.run(small_scene(), self.path / "soft", progress=False,
                            **{"/cell_types/rbc/membrane/0/parameters/shear_modulus": "2e-3 dyn/cm"})
        compared = rouleau.compare(RUN, other.directory)
        self.assertEqual(list(compared.scenes.index), ["/cell_types/rbc/membrane/0/parameters/shear_modulus"])
        self.assertEqual(list(compared.scenes.iloc[0]), ["6e-3 dyn/cm", "2e-3 dyn/cm"])
        row = compared.quantities.loc["deformation"]
        self.assertEqual(row["difference"], row["b"] - row["a"])
        self.assertIsNone(row["differs"])  # without error bars its error is not known
        self.assertEqual(len(compared.plot("deformation").lines), 4)

    def test_that_are_the_same_do_not_differ(self):
        compared = rouleau.compare(RUN, RUN)
        self.assertEqual(len(compared.scenes), 0)
        self.assertTrue((compared.quantities["difference"].dropna() == 0).all())
        self.assertFalse(compared.quantities.loc["relative_viscosity", "differs"])


class Figures(Case):
    def tearDown(self):
        from matplotlib import pyplot
        pyplot.close("all")

    def test_have_the_right_unit_for_every_column_that_a_run_can_have(self):
        from rouleau.drawing import label_of
        drawn = {"": ("", 1), "s": ("(s)", 1), "m": ("(µm)", 1e6), "rad": ("(°)", 180 / math.pi), "m2": ("(µm²)", 1e12), "m3": ("(µm³)", 1e18),
                 "1/s": ("(1/s)", 1), "Pa": ("(Pa)", 1), "Pa/m": ("(Pa/m)", 1), "m2/s": ("(µm²/s)", 1e12), "m3/s": ("(µm³/s)", 1e18), "m/s": ("(µm/s)", 1e6), "J/m": ("(J/m)", 1), "W/m": ("(W/m)", 1)}
        tables = json.loads(subprocess.run([os.environ["ROULEAU"], "columns"], capture_output=True, check=True).stdout)
        columns = [column for table in tables for column in table["columns"]]
        self.assertGreater(len(columns), 60)
        for column in columns:
            with self.subTest(column["column"]):
                unit, scale = drawn[column["unit"]]
                label, found = label_of(column["column"])
                self.assertEqual(found, scale)
                self.assertTrue(label.endswith(unit) and ("(" in label) == (unit != ""), label)

    def test_show_a_line_for_each_cell(self):
        axes = RUN.plot("deformation")
        self.assertEqual([line.get_label() for line in axes.lines], ["cell 0", "cell 1"])
        numpy.testing.assert_array_equal(axes.lines[1].get_ydata(), RUN.pivot("deformation")[1])
        self.assertEqual((axes.get_xlabel(), axes.get_ylabel()), ("strain", "deformation"))

    def test_have_lengths_in_micrometres_and_angles_in_degrees(self):
        gap, angle = RUN.stage("shear").plot("min_gap_m", "angle_rad", over="time_s")
        self.assertEqual(gap.get_ylabel(), "gap to the nearest cell (µm)")
        numpy.testing.assert_allclose(gap.lines[0].get_ydata(), 1e6 * RUN.stage("shear").pivot("min_gap_m", "time_s")[0])
        self.assertEqual(angle.get_ylabel(), "angle (°)")
        self.assertAlmostEqual(angle.lines[0].get_ydata()[0], 90, delta=5)
        self.assert_refused('there is no column "gap"', RUN.plot, "gap")

    def test_of_a_frame_show_a_cell_on_both_sides_of_the_border(self):
        frame = RUN.frame(index=0)  # its first cell lies across x = 0
        axes = frame.plot()
        self.assertEqual(len(axes.collections), 3)
        self.assertEqual(axes.get_xlim(), (0, 24))
        drawn = axes.collections[0].get_segments()[0]
        numpy.testing.assert_allclose(drawn[:-1], 1e6 * frame.cells[0].outline, atol=1e-9)
        self.assertEqual(len(RUN.frame(fields=True).plot("tension", "velocity").figure.axes), 3)  # two colour bars
        self.assert_refused('colour is "cell"', frame.plot, "red")

    def test_without_columns_show_frames_deformation_and_gaps(self):
        axes = RUN.plot()
        self.assertEqual([a.get_ylabel() for a in axes[-2:]], ["deformation", "gap to the nearest cell (µm)"])
        self.assertEqual(len(axes), 6)

    def test_move_in_a_page_of_their_own(self):
        page = RUN.animate(3).save(self.path / "run.html").read_text()
        self.assertEqual(page.count("data:image/png"), 3)
        self.assertNotRegex(page, "(src|href)=.https?:.*[.]js")
        self.assertEqual([f.name for f in self.path.iterdir()], ["run.html"])


class A_run_of_somebody_else(Case):
    def setUp(self):
        super().setUp()
        self.run_folder = self.path / "run"
        shutil.copytree(RUN.directory, self.run_folder)

    def frames(self):
        import h5py
        return h5py.File(next(iter(sorted(self.run_folder.glob("frames*.h5")))), "a")

    def test_shows_no_other_file(self):
        import h5py
        (self.path / "secret").write_bytes(b"s" * 8000)
        for name in ("tension", "points"):
            with self.frames() as file:
                membranes = file["frames/000000/membranes"]
                shape = membranes[name].shape
                del membranes[name]
                layout = h5py.h5p.create(h5py.h5p.DATASET_CREATE)
                layout.set_external(bytes(self.path / "secret"), 0, math.prod(shape))
                h5py.h5d.create(membranes.id, name.encode(), h5py.h5t.STD_U8LE, h5py.h5s.create_simple(shape), layout)
            self.assert_refused("another file", rouleau.open(self.run_folder).frame, index=0)
        os.mkfifo(self.run_folder / "pipe")
        for target in ("pipe", "../secret"):
            with self.frames() as file:
                del file["frames/000000"]
                file["frames/000000"] = h5py.ExternalLink(target, "/frames/000000")
            self.assert_refused("another file", rouleau.open(self.run_folder).frame, index=0)

    def test_is_not_waited_for(self):
        for name in ("summary.json", "series.csv", "log.jsonl"):
            kept = (self.run_folder / name).rename(self.path / name)
            os.mkfifo(self.run_folder / name)
            with contextlib.suppress(rouleau.Error):
                run = rouleau.open(self.run_folder)
                self.assertTrue((run.summary, run.series, run.log))
            (self.run_folder / name).unlink()
            kept.rename(self.run_folder / name)


class What_is_no_run(Case):
    def test_is_refused_with_its_place(self):
        error = self.assert_refused("there is no scene.json", rouleau.open, self.path)
        self.assertEqual((error.file, error.exit_code), (str(self.path), 4))
        self.assert_refused("this is no directory", rouleau.open, self.path / "none")


if __name__ == "__main__":
    main()
