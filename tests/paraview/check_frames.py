"""Opens runs in ParaView (XDMFReader) and in h5py, and compares what the two show with each other and with the scene.

Usage: pvpython check_frames.py ROULEAU
Ends with 77 where h5py is missing. Needs no display.
"""
import json
import pathlib
import subprocess
import sys
import tempfile

try:
    import h5py
    import numpy
    from paraview import servermanager, simple
    from vtkmodules.util.numpy_support import vtk_to_numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

HEIGHT, RATE = 16e-6, 20.0
CHANNEL = {
    "rouleau": 1,
    "domain": {"size": ["24 um", "16 um"], "nodes": [96, 64], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 2000},
    "stages": [{"name": "shear", "shear_rate": "20 1/s", "strain": 0.2, "start": "developed"}],
}
MEMBRANE = [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}},
            {"model": "bending", "parameters": {"modulus": "3.6e-12 dyn cm"}}]
CELLS = {
    "cell_types": {
        "rbc": {"shape": {"biconcave": {"radius": "3.91 um"}}, "segments": 77, "membrane": MEMBRANE},
        "round": {"shape": {"circle": {"radius": "2 um"}}, "segments": 50, "membrane": MEMBRANE},
    },
    "cells": [{"type": "rbc", "at": ["12 um", "8 um"], "angle": "90 deg"}, {"type": "round", "at": ["3 um", "8 um"]}],
}
ALL = ["velocity", "density", "viscosity", "vorticity"]
REGION = {"region": {"from": ["5 um", "3 um"], "to": ["20 um", "12 um"]}, "stride": 3}
SCENES = {
    "cells of unequal size, fields in every second frame":
        CHANNEL | CELLS | {"output": {"cells": {"strain": 0.05}, "fields": {"strain": 0.1, "quantities": ALL}}},
    "equal cells, no fields":
        CHANNEL | CELLS | {"cells": [{"type": "rbc", "at": [x, "8 um"], "angle": "90 deg"} for x in ("6 um", "16 um")],
                           "output": {"cells": {"strain": 0.1}}},
    "frames in several files, one for each checkpoint":
        CHANNEL | CELLS | {"output": {"cells": {"strain": 0.05}, "fields": {"strain": 0.1, "quantities": ALL},
                                      "checkpoint": {"seconds": "0.001 s"}}},
    "a region with a stride in double precision, not compressed":
        CHANNEL | CELLS | {"output": {"fields": {"strain": 0.1, "quantities": ALL, "precision": "f64", "compression": 0}
                                      | REGION}},
    "fluid alone": CHANNEL | {"output": {"fields": {"strain": 0.1, "quantities": ["velocity"], "precision": "f64"}}},
    "fluid alone in a region with a stride":
        CHANNEL | {"output": {"fields": {"strain": 0.1, "quantities": ["velocity", "vorticity"], "compression": 9}
                              | REGION}},
}
SHOWN = {"velocity": "velocity (m/s)", "density": "density deviation", "viscosity": "viscosity (Pa s)",
         "vorticity": "vorticity (1/s)"}
checks = 0


def check(good: bool, what: str) -> None:
    global checks
    checks += 1
    if not good:
        raise AssertionError(what)


def equal(a, b, what: str) -> None:
    a, b = numpy.asarray(a), numpy.asarray(b)
    check(a.shape == b.shape and bool((a == b).all()), f"{what}: {a} and {b}")


def blocks(reader, time: float) -> dict:
    reader.UpdatePipeline(time)
    data = servermanager.Fetch(reader)
    if not data.IsA("vtkMultiBlockDataSet"):
        return {"membranes" if data.IsA("vtkUnstructuredGrid") else "fields": data}
    return {data.GetMetaData(i).Get(data.NAME()): data.GetBlock(i) for i in range(data.GetNumberOfBlocks())}


def check_membranes(shown, stored) -> None:
    points = stored["points"][:]
    first = stored["first"][:]
    equal(vtk_to_numpy(shown.GetPoints().GetData())[:, :2], points, "points")
    equal(shown.GetPoints().GetBounds(), [points[:, 0].min(), points[:, 0].max(), points[:, 1].min(),
                                          points[:, 1].max(), 0, 0], "bounds")
    check(shown.GetNumberOfCells() == len(first) - 1, "number of polylines")
    for cell in range(shown.GetNumberOfCells()):
        line = shown.GetCell(cell)
        check(line.GetClassName() == "vtkPolyLine", "membranes are lines")
        ids = [line.GetPointId(i) for i in range(line.GetNumberOfPoints())]
        equal(ids, [*range(first[cell], first[cell + 1]), first[cell]], "a closed outline")
    for dataset, name in {"cell": "cell", "aggregate": "aggregate", "tension": "tension (N/m)"}.items():
        equal(vtk_to_numpy(shown.GetPointData().GetArray(name)), stored[dataset][:], name)
    owner = numpy.repeat(numpy.arange(len(first) - 1), numpy.diff(first))
    equal(stored["cell"][:], owner, "the cell of each node")


def check_fields(shown, stored, file) -> None:
    spacing = file.attrs["size_m"] / file.attrs["nodes"]
    origin = file.attrs.get("fields_first_m", spacing / 2)
    step = file.attrs.get("fields_spacing_m", spacing)
    ny, nx = next(iter(stored.values())).shape[:2]
    check(shown.GetDimensions() == (nx, ny, 1), f"dimensions {shown.GetDimensions()}")
    for i, j in ((0, 0), (nx - 1, 0), (0, ny - 1), (nx // 2, ny // 3)):
        place = shown.GetPoint(j * nx + i)
        check(numpy.allclose(place, [origin[0] + i * step[0], origin[1] + j * step[1], 0], rtol=1e-12, atol=0),
              f"node {i}, {j} is shown at {place}")
    for dataset in stored:
        array = shown.GetPointData().GetArray(SHOWN[dataset])
        check(array is not None, f"{SHOWN[dataset]} is missing")
        equal(vtk_to_numpy(array).reshape(stored[dataset].shape), stored[dataset][:], dataset)
    check(shown.GetPointData().GetNumberOfArrays() == len(stored), "number of fields")


def check_couette(shown) -> None:
    """Without cells the developed flow is known: u = rate (y - H/2), at the places that ParaView shows."""
    velocity = vtk_to_numpy(shown.GetPointData().GetArray("velocity (m/s)"))
    y = numpy.array([shown.GetPoint(i)[1] for i in range(shown.GetNumberOfPoints())])
    single = velocity.dtype == numpy.float32
    error = numpy.abs(velocity[:, 0] - RATE * (y - HEIGHT / 2)).max() / (RATE * HEIGHT / 2)
    check(error < (1e-6 if single else 1e-9), f"Couette flow is off by {error}")
    check(bool((velocity[:, 2] == 0).all()), "a third component")
    vorticity = shown.GetPointData().GetArray("vorticity (1/s)")
    if vorticity:
        check(numpy.allclose(vtk_to_numpy(vorticity), -RATE, rtol=1e-5), "vorticity of Couette flow")


def check_run(directory: pathlib.Path, scene: dict) -> None:
    reader = simple.XDMFReader(FileNames=[str(directory / "frames.xmf")])
    reader.UpdatePipelineInformation()
    with h5py.File(directory / "frames.h5") as file:
        frames = list(file["frames"].values())
        times = [frame.attrs["time_s"] for frame in frames]
        check(times == sorted(times), "times in order")
        equal(list(reader.TimestepValues), [frame.attrs["time_s"] for frame in frames if len(frame)], "times")
        for frame in frames:
            shown = blocks(reader, frame.attrs["time_s"])
            if "membranes" in frame:
                check_membranes(shown["membranes"], frame["membranes"])
            if "fields" in frame:
                check_fields(shown["fields"], frame["fields"], file)
                if "cells" not in scene:
                    check_couette(shown["fields"])
            else:
                check(shown.get("fields") is None, "fields where none were due")
    simple.Delete(reader)


def check_names_in_calculator(directory: pathlib.Path) -> None:
    """Names with units can be used in ParaView's expressions, in quotes."""
    reader = simple.XDMFReader(FileNames=[str(directory / "frames.xmf")])
    speed = simple.Calculator(Input=reader, Function='mag("velocity (m/s)")', ResultArrayName="speed (m/s)")
    speed.UpdatePipeline(0)
    largest = speed.PointData["speed (m/s)"].GetRange()[1]
    expected = RATE * HEIGHT / 2 * (63 / 64)
    check(abs(largest / expected - 1) < 1e-6, f"largest speed {largest}, not {expected}")


def main() -> int:
    program = pathlib.Path(sys.argv[1]).resolve()
    with tempfile.TemporaryDirectory() as scratch:
        for number, (name, scene) in enumerate(SCENES.items()):
            directory = pathlib.Path(scratch) / str(number)
            file = pathlib.Path(scratch) / f"{number}.json"
            file.write_text(json.dumps(scene))
            subprocess.run([program, "run", file, "--out", directory], check=True, stdout=subprocess.DEVNULL,
                           stderr=subprocess.DEVNULL)
            try:
                check_run(directory, scene)
                if name == "fluid alone":
                    check_names_in_calculator(directory)
                if name.startswith("frames in several files"):
                    check(len(list(directory.glob("frames-*.h5"))) > 2, "several files")
            except AssertionError as problem:
                print(f"{name}: {problem}")
                return 1
    print(f"{checks} checks passed")
    return 0


sys.exit(main())
