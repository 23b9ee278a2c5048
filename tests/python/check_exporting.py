"""Frames and runs for other programs: files as their formats are documented (and as VTK reads them where it is there), PyVista,
trimesh and xarray, what notebooks show, and arguments with two names.

PyVista and trimesh are in no package of Debian: what they are given is checked against their documented constructors.
"""

import base64
import importlib.util
import re
import struct
import sys
import types
import unittest
import xml.etree.ElementTree

from package import SOURCE, Case, main, need, small_scene

need("numpy", "pandas", "h5py", "matplotlib")

import numpy  # noqa: E402

import rouleau  # noqa: E402
from rouleau.exporting import needed  # noqa: E402

SPACE = {
    "rouleau": 1, "title": "two capsules in space",
    "domain": {"size": ["10 um", "6 um", "7 um"], "nodes": [20, 12, 14], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 300},
    "cell_types": {"capsule": {"shape": {"sphere": {"radius": "1.5 um"}}, "triangles": 180,
                               "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "1e-5 N/m"}}]}},
    "cells": [{"type": "capsule", "at": ["0.1 um", "2.6 um", "3.3 um"]}, {"type": "capsule", "at": ["5 um", "3 um", "6.9 um"]}],
    "stages": [{"name": "flow", "shear_rate": "50 1/s", "duration": "2 ms"}],
    "output": {"cells": {"seconds": "1 ms"}},
}


class Exported(Case):
    """One run in the plane and one in space for all."""

    @classmethod
    def setUpClass(cls):
        import tempfile
        cls.folder = tempfile.TemporaryDirectory(prefix="rouleau-python-")
        cls.addClassCleanup(cls.folder.cleanup)
        cls.flat = rouleau.run(small_scene(), f"{cls.folder.name}/flat", progress=False)
        cls.space = rouleau.run(SPACE, f"{cls.folder.name}/space", progress=False)


def array_of(element):
    """The values of a DataArray: base64 of the number of bytes, UInt64, and the values."""
    data = base64.b64decode(element.text)
    size = struct.unpack("<Q", data[:8])[0]
    assert len(data) == 8 + size
    values = numpy.frombuffer(data[8:], {"Float64": "<f8", "Int64": "<i8"}[element.get("type")])
    return values.reshape(-1, int(element.get("NumberOfComponents", 1))) if element.get("NumberOfComponents") else values


class Files(Exported):
    def test_of_vtk_have_what_its_format_wants(self):
        frame = self.space.frame()
        root = xml.etree.ElementTree.parse(frame.write(self.path / "cells.vtp", wrapped=False)).getroot()
        self.assertEqual((root.tag, root.get("type"), root.get("byte_order"), root.get("header_type")), ("VTKFile", "PolyData", "LittleEndian", "UInt64"))
        piece = root.find("PolyData/Piece")
        points = array_of(piece.find("Points/DataArray"))
        numpy.testing.assert_array_equal(points, numpy.vstack([cell.outline for cell in frame.cells]))
        self.assertEqual(int(piece.get("NumberOfPoints")), len(points))
        polys = {part.get("Name"): array_of(part) for part in piece.findall("Polys/DataArray")}
        self.assertEqual(int(piece.get("NumberOfPolys")), len(polys["offsets"]))
        numpy.testing.assert_array_equal(polys["offsets"], 3 * numpy.arange(1, 1 + len(polys["offsets"])))
        numpy.testing.assert_array_equal(polys["connectivity"].reshape(-1, 3)[:len(frame.cells[0].triangles)], frame.cells[0].triangles)
        about = {part.get("Name"): array_of(part) for part in [*piece.find("PointData"), *piece.find("CellData")]}
        numpy.testing.assert_array_equal(about["tension_N_per_m"], numpy.concatenate([cell.tension for cell in frame.cells]))
        self.assertEqual(set(about["cell"]), {0, 1})
        self.assertEqual(float(root.find("PolyData/FieldData/DataArray").text), frame.time_s)

    @unittest.skipUnless(importlib.util.find_spec("vtk"), "VTK's Python module is missing (python3-paraview, python3-vtk9)")
    def test_of_vtk_are_read_by_vtk(self):
        from vtkmodules.util.numpy_support import vtk_to_numpy
        from vtkmodules.vtkIOXML import vtkXMLPolyDataReader
        for run, kind in ((self.space, "Polys"), (self.flat, "Lines")):
            frame = run.frame()
            reader = vtkXMLPolyDataReader()
            reader.SetFileName(str(frame.write(self.path / f"{kind}.vtp", wrapped=False)))
            reader.Update()
            read = reader.GetOutput()
            self.assertEqual(reader.GetErrorCode(), 0)
            points = vtk_to_numpy(read.GetPoints().GetData())
            wanted = numpy.vstack([cell.outline for cell in frame.cells])
            numpy.testing.assert_array_equal(points[:, :wanted.shape[1]], wanted)
            count = sum(len(cell.triangles) for cell in frame.cells) if kind == "Polys" else len(frame.cells)
            self.assertEqual((getattr(read, f"GetNumberOf{kind}")(), read.GetNumberOfCells()), (count, count))
            numpy.testing.assert_array_equal(vtk_to_numpy(read.GetPointData().GetArray("tension_N_per_m")),
                                             numpy.concatenate([cell.tension for cell in frame.cells]))
            if kind == "Lines":
                self.assertEqual(read.GetCell(0).GetNumberOfPoints(), len(frame.cells[0].outline) + 1)
                self.assertEqual(read.GetCell(0).GetPointId(0), read.GetCell(0).GetPointId(len(frame.cells[0].outline)))

    def test_have_cells_in_the_box_unless_they_shall_not(self):
        frame = self.space.frame()
        self.assertEqual(len(frame.box_m), 3)
        root = xml.etree.ElementTree.parse(frame.write(self.path / "cells.vtp")).getroot()
        points = array_of(root.find("PolyData/Piece/Points/DataArray"))
        for cell, places in zip(frame.cells, numpy.split(points, 2)):
            self.assertTrue(((places.mean(axis=0) >= 0) & (places.mean(axis=0) < frame.box_m)).all())
            shift = (places - cell.outline) / numpy.array(frame.box_m)
            numpy.testing.assert_allclose(shift, numpy.round(shift[:1]) + 0 * shift, atol=1e-9)

    def test_of_stl_and_ply_have_all_triangles(self):
        frame = self.space.frame()
        count = sum(len(cell.triangles) for cell in frame.cells)
        stl = frame.write(self.path / "cells.stl", wrapped=False).read_bytes()
        self.assertEqual((len(stl), struct.unpack("<I", stl[80:84])[0]), (84 + 50 * count, count))
        first = numpy.frombuffer(stl[84:132], "<f4").reshape(4, 3)
        numpy.testing.assert_allclose(first[1:], frame.cells[0].outline[frame.cells[0].triangles[0]], rtol=1e-6)
        outward = frame.cells[0].outline[frame.cells[0].triangles[0]].mean(axis=0) - frame.cells[0].outline.mean(axis=0)
        self.assertGreater(first[0] @ outward / numpy.linalg.norm(outward), 0.9)
        head, _, body = frame.write(self.path / "cells.ply").read_text().partition("end_header\n")
        vertices, faces = int(re.search(r"element vertex (\d+)", head)[1]), int(re.search(r"element face (\d+)", head)[1])
        self.assertEqual((faces, len(body.splitlines())), (count, vertices + faces))
        self.assertEqual(body.splitlines()[-1].split()[0::4], ["3", "1"])

    def test_are_refused_where_they_cannot_be(self):
        self.assert_refused("no ending of a known format", self.flat.frame().write, self.path / "cells.vtk")
        self.assert_refused("wants surfaces, and this frame has outlines", self.flat.frame().write, self.path / "cells.stl")
        self.assertEqual(list(self.path.iterdir()), [])


class Objects(Exported):
    def stand_in(self, name, **members):
        self.addCleanup(sys.modules.pop, name, None)
        sys.modules[name] = types.SimpleNamespace(**members)

    def test_of_pyvista_have_faces_or_lines_with_their_lengths(self):
        class PolyData:  # pyvista.PolyData(var_inp, faces=None, n_faces=None, lines=None, ...)
            def __init__(self, points, faces=None, lines=None):
                self.points, self.faces, self.lines, self.point_data, self.cell_data = points, faces, lines, {}, {}

        if importlib.util.find_spec("pyvista") is None:
            self.stand_in("pyvista", PolyData=PolyData)
        space, flat = self.space.frame().to_pyvista(), self.flat.frame().to_pyvista()
        faces = numpy.asarray(space.faces).reshape(-1, 4)
        self.assertEqual(set(faces[:, 0]), {3})
        self.assertEqual(len(faces), sum(len(cell.triangles) for cell in self.space.frame().cells))
        self.assertLess(faces[:, 1:].max(), len(space.points))
        self.assertEqual(len(space.cell_data["cell"]), len(faces))
        self.assertEqual(len(space.point_data["curvature_1_per_m"]), len(space.points))
        self.assertEqual((flat.lines[0], flat.lines[1], flat.lines[41]), (41, 0, 0))
        self.assertTrue((flat.points[:, 2] == 0).all())

    def test_of_trimesh_have_the_surface_as_it_is(self):
        class Trimesh:  # trimesh.Trimesh(vertices=None, faces=None, ..., process=True, ...)
            def __init__(self, vertices, faces, process, metadata):
                self.vertices, self.faces, self.process, self.metadata = vertices, faces, process, metadata

        if importlib.util.find_spec("trimesh") is None:
            self.stand_in("trimesh", Trimesh=Trimesh)
        meshes = self.space.frame().to_trimesh()
        self.assertEqual([mesh.metadata["cell"] for mesh in meshes], [0, 1])
        numpy.testing.assert_array_equal(meshes[1].vertices, self.space.frame().cells[1].outline)
        self.assert_refused("this cell is an outline", self.flat.frame().to_trimesh)

    def test_that_need_what_is_missing_say_what_to_install(self):
        error = self.assert_refused("the Python package no_such_package is missing", needed, "no_such_package", "python3-none")
        self.assertIn("apt install python3-none, or pip install no_such_package", error.remedy)

    @unittest.skipUnless(importlib.util.find_spec("xarray"), "python3-xarray is missing")
    def test_of_xarray_have_dimensions_units_and_the_tables_values(self):
        for run, axes in ((self.flat, 2), (self.space, 3)):
            data = run.to_xarray(outlines=True)
            self.assertEqual(data.sizes["time"], len(run.series))
            self.assertEqual(data["x_m"].dims, ("time", "cell"))
            self.assertEqual((data["x_m"].attrs["units"], data["time_s"].attrs["units"]), ("m", "s"))
            numpy.testing.assert_array_equal(data["deformation"].to_numpy(), run.pivot("deformation", over="step").to_numpy())
            numpy.testing.assert_array_equal(data["relative_viscosity"].to_numpy(), run.series["relative_viscosity"].to_numpy())
            numpy.testing.assert_array_equal(data["outline"].to_numpy()[-1, 1], run.frame().cells[1].outline)
            self.assertEqual((data["outline"].dims, data.sizes["axis"]), (("frame", "cell", "node", "axis"), axes))
        shear = self.flat.stage("shear").to_xarray()
        self.assertEqual(shear.sizes["time"], len(self.flat.stage("shear").series))
        self.assertNotIn("outline", shear)


class Pictures_in_space(Exported):
    def test_have_surfaces_in_their_box(self):
        from mpl_toolkits.mplot3d.art3d import Poly3DCollection
        frame = self.space.frame()
        for words in ({}, {"colour": "tension"}, {"color": "aggregate"}):
            axes = frame.plot3d(**words)
            self.assertEqual(len([part for part in axes.collections if isinstance(part, Poly3DCollection)]), 2)
            numpy.testing.assert_allclose([*axes.get_xlim(), *axes.get_ylim(), *axes.get_zlim()], [0, 10, 0, 6, 0, 7])
            axes.figure.savefig(self.path / "space.png")
        self.assertEqual(len(axes.lines), 12)  # the box
        flat = self.flat.frame().plot3d()
        self.assertEqual(len(flat.lines), 2 + 4)
        self.assertIn("cells cut through their middles", frame.plot().get_title())
        self.assertNotIn("cut", self.flat.frame().plot().get_title())
        self.assert_refused('did you mean "deformation"', self.flat.plot, "deformatoin")
        self.assert_refused("these axes are flat", frame.plot3d, axes=self.flat.frame().plot())


class Arguments(Exported):
    def test_may_have_the_names_that_matplotlib_gives_them(self):
        from matplotlib import pyplot
        _, axes = pyplot.subplots()
        frame = self.flat.frame()
        self.assertIs(frame.plot(color="tension", ax=axes), axes)
        self.assertIs(self.flat.plot("deformation", ax=axes), axes)
        self.assertEqual(len(self.flat.animate(2, color="aggregate")), 2)
        self.assert_refused("mean the same", frame.plot, "cell", color="tension")


class In_a_notebook(Exported):
    def test_runs_frames_plans_and_comparisons_show_tables(self):
        plan = rouleau.plan(small_scene())
        for value, words in ((self.flat, ("small", "completed", "relative_viscosity", "<table")), (self.space.frame(), ("10 x 6 x 7 um", "2 of 92 nodes")),
                             (plan, ("capillary", "<table")), (rouleau.compare(self.flat, self.flat), ("relative_viscosity",))):
            for word in words:
                self.assertIn(word, value._repr_html_())
        self.assertLess(len(repr(self.space.frame())), 200)


class The_version(Case):
    def test_is_that_of_the_program_and_of_the_source(self):
        self.assertEqual(rouleau.__version__, re.search(r"^project\(Rouleau VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text(), re.M)[1])

    def test_comes_with_types(self):
        self.assertTrue((SOURCE / "python/rouleau/py.typed").is_file())


if __name__ == "__main__":
    main()
