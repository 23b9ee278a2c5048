"""A picture of a run in ParaView: membranes by their tension, walls, and the fluid's speed on a plane across z.

usage: pvbatch cells.py RUN [PICTURE] [--strain S | --time SECONDS] [--up DEGREES] [--state FILE.pvsm]

RUN is the directory of a run (or its frames.xmf), in two dimensions or three; PICTURE is RUN/cells.png when left out. Without a
time it is the last frame. The speed is drawn where that frame has a field "velocity": "output": {"fields": {"strain": 1}} in the
scene. --state keeps all of it for ParaView's own window: File > Load State.
"""

import argparse
import pathlib

from paraview import servermanager, simple

TENSION, VELOCITY = "tension (N/m)", "velocity (m/s)"
INK = [0.1, 0.1, 0.1]


def arguments():
    parser = argparse.ArgumentParser(usage=__doc__)
    parser.add_argument("run", type=pathlib.Path)
    parser.add_argument("picture", type=pathlib.Path, nargs="?")
    parser.add_argument("--strain", type=float)
    parser.add_argument("--time", type=float)
    parser.add_argument("--up", type=float, default=25, help="how far above the plane of x and y the eye is, in three dimensions")
    parser.add_argument("--state", type=pathlib.Path)
    return parser.parse_args()


def time_of_strain(folder, strain):
    """The time of the output that is nearest to a strain, from series.csv."""
    import csv

    with open(folder / "series.csv", newline="") as file:
        rows = list(csv.DictReader(file))
    return float(min(rows, key=lambda row: abs(float(row["strain"]) - strain))["time_s"])


def parts_of(reader):
    """{"membranes", "fields", "walls"}: those that the present frame has, each as a source of its own."""
    data = servermanager.Fetch(reader)
    if not data.IsA("vtkMultiBlockDataSet"):
        return {"membranes" if data.IsA("vtkUnstructuredGrid") else "fields": reader}
    names = [data.GetMetaData(k).Get(data.NAME()) for k in range(data.GetNumberOfBlocks())]
    return {name: simple.ExtractBlock(Input=reader, Selectors=[f"//{name}"]) for k, name in enumerate(names)
            if data.GetBlock(k) and data.GetBlock(k).GetNumberOfPoints()}


def coloured(source, view, name, preset, title, place):
    shown = simple.Show(source, view)
    shown.SetRepresentationType("Surface")
    simple.ColorBy(shown, ("POINTS", name))
    shown.RescaleTransferFunctionToDataRange(False, True)
    colours = simple.GetColorTransferFunction(name)
    colours.ApplyPreset(preset, True)
    if name == TENSION:  # zero is the middle: compressed on one side, stretched on the other
        low, high = source.PointData.GetArray(name).GetRange(0)
        colours.RescaleTransferFunction(-max(abs(low), abs(high)) or -1, max(abs(low), abs(high)) or 1)
    bar = simple.GetScalarBar(colours, view)
    for key, value in {"Title": title, "ComponentTitle": "", "TitleColor": INK, "LabelColor": INK, "WindowLocation": "Any Location",
                       "Position": place, "ScalarBarLength": 0.33}.items():
        setattr(bar, key, value)
    shown.SetScalarBarVisibility(view, True)
    return shown


def main():
    chosen = arguments()
    frames = chosen.run if chosen.run.suffix == ".xmf" else chosen.run / "frames.xmf"
    reader = simple.XDMFReader(FileNames=[str(frames.resolve())])
    times = list(reader.TimestepValues) if hasattr(reader.TimestepValues, "__len__") else [reader.TimestepValues]
    wanted = time_of_strain(frames.parent, chosen.strain) if chosen.strain is not None else chosen.time
    time = times[-1] if wanted is None else min(times, key=lambda t: abs(t - wanted))
    reader.UpdatePipeline(time)

    view = simple.CreateView("RenderView")
    view.ViewSize, view.Background, view.OrientationAxesLabelColor = [1400, 1000], [1, 1, 1], INK
    view.UseColorPaletteForBackground = 0
    view.ViewTime = time
    parts = parts_of(reader)
    bounds = reader.GetDataInformation().GetBounds()
    flat = bounds[4] == bounds[5]
    middle = [(bounds[2 * axis] + bounds[2 * axis + 1]) / 2 for axis in range(3)]

    if "fields" in parts:
        parts["fields"].UpdatePipeline(time)
        plane = parts["fields"]
        if not flat:
            plane = simple.Slice(Input=plane, SliceType="Plane")
            plane.SliceType.Origin, plane.SliceType.Normal = middle, [0, 0, 1]
        plane.UpdatePipeline(time)
        if plane.PointData.GetArray(VELOCITY):
            shown = coloured(plane, view, VELOCITY, "Viridis (matplotlib)", "speed (m/s)", [0.88, 0.08])
            shown.Ambient, shown.Diffuse = 1, 0  # a map and no thing: without light and shade
    if "walls" in parts:
        walls = simple.Show(parts["walls"], view)
        walls.Opacity, walls.DiffuseColor, walls.AmbientColor = 1 if flat else 0.25, [0.5, 0.55, 0.6], [0.5, 0.55, 0.6]
        walls.LineWidth = 2
    if "membranes" in parts:
        parts["membranes"].UpdatePipeline(time)
        cells = parts["membranes"]
        if not flat:
            cells = simple.GenerateSurfaceNormals(Input=simple.ExtractSurface(Input=cells))
            cells.UpdatePipeline(time)
        shown = coloured(cells, view, TENSION, "Cool to Warm", "tension (N/m)", [0.88, 0.58])
        shown.LineWidth = 3
        if not flat:
            shown.Specular, shown.Interpolation = 0.3, "Gouraud"

    extent = max(bounds[1] - bounds[0], bounds[3] - bounds[2])
    view.CameraFocalPoint, view.CameraViewUp = middle, [0, 1, 0]
    view.CameraPosition = [middle[0], middle[1], middle[2] + 3 * extent]
    view.CameraParallelProjection = 1
    simple.ResetCamera(view)
    if not flat:
        camera = view.GetActiveCamera()
        camera.Elevation(chosen.up)
        camera.Azimuth(20)
        camera.OrthogonalizeViewUp()
        simple.ResetCamera(view)
        view.CameraParallelScale *= 0.75
    picture = chosen.picture or frames.parent / "cells.png"
    simple.Render(view)
    simple.SaveScreenshot(str(picture), view)
    if chosen.state:
        servermanager.SaveState(str(chosen.state))
    print(f"{picture}: {', '.join(sorted(parts))} at {time:g} s")


main()
