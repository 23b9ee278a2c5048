#!/usr/bin/env python3
"""Reads a run of Rouleau with h5py and pandas and draws two figures into its directory: a start for scripts of your own.

outlines.png               cells at chosen strains, their membranes coloured by tension
gaps-and-deformation.png   gap to the nearest neighbour and deformation of each cell over strain

Example: python3 examples/read_run.py runs/demo --strains 0 4 9 12
Debian: apt install python3-h5py python3-pandas python3-matplotlib
"""

import argparse
import pathlib

import h5py
import matplotlib
import numpy
import pandas

matplotlib.use("Agg")  # pictures go into files: no screen is needed
from matplotlib import pyplot  # noqa: E402
from matplotlib.collections import LineCollection  # noqa: E402


def nearest_frames(file, strains):
    """Names of the frames nearest to these strains; of frames with one strain (a stage at rest) the last."""
    names = sorted(file["frames"])
    have = numpy.array([file["frames"][name].attrs["strain"] for name in names])
    chosen = {}
    for strain in strains:
        distance = numpy.abs(have - strain)
        chosen[names[numpy.flatnonzero(distance == distance.min())[-1]]] = None
    return list(chosen)


def segments_of(frame, width):
    """Segments [n, 2 ends, 2] in um and their tensions in N/m, each cell brought into the periodic box as a whole."""
    points, first = frame["membranes/points"][:], frame["membranes/first"][:]
    segments = []
    for begin, end in zip(first[:-1], first[1:]):
        cell = points[begin:end].copy()
        cell[:, 0] -= width * numpy.floor(cell[:, 0].mean() / width)
        segments.append(numpy.stack([cell, numpy.roll(cell, -1, axis=0)], axis=1))
    return 1e6 * numpy.concatenate(segments), frame["membranes/tension"][:]


def draw_outlines(run, strains):
    with h5py.File(run / "frames.h5") as file:
        width, height = 1e6 * file.attrs["size_m"]
        frames = [file["frames"][name] for name in nearest_frames(file, strains)]
        frames = [frame for frame in frames if "membranes" in frame]
        drawn = [(frame.attrs["strain"], frame.attrs["time_s"], *segments_of(frame, 1e-6 * width)) for frame in frames]
    if not drawn:
        raise SystemExit(f"{run}/frames.h5 has no membranes: a scene without cells")
    largest = max(numpy.abs(tension).max() for *_, tension in drawn)
    scale = 1e6 * (largest or 1)  # a scene whose membranes resist nothing
    columns = min(2, len(drawn))
    rows = -(-len(drawn) // columns)
    figure, axes = pyplot.subplots(rows, columns, squeeze=False, constrained_layout=True,
                                   figsize=(1 + 5 * columns, 0.6 + rows * (0.5 + 5 * height / width)))
    for axis in axes.flat[len(drawn):]:
        axis.set_visible(False)
    for axis, (strain, time, segments, tension) in zip(axes.flat, drawn):
        # A cell on the periodic border is drawn on both sides.
        for shift in (-width, 0, width):
            lines = LineCollection(segments + [shift, 0], cmap="coolwarm", linewidths=2)
            lines.set_array(1e6 * tension)
            lines.set_clim(-scale, scale)
            axis.add_collection(lines)
        axis.set(xlim=(0, width), ylim=(0, height), aspect="equal", title=f"strain {strain:.2f}, {time:.3g} s",
                 xlabel="x (µm)", ylabel="y (µm)")
    figure.colorbar(lines, ax=axes, label="tension (µN/m), compression negative", shrink=0.8)
    return save(figure, run / "outlines.png")


def draw_gaps_and_deformation(run):
    cells = pandas.read_csv(run / "cells.csv")
    figure, (gap, deformation) = pyplot.subplots(2, 1, sharex=True, figsize=(7, 6), constrained_layout=True)
    # A stage at rest has one strain and many times: its last row stands for it.
    for cell, rows in cells.drop_duplicates(["strain", "cell"], keep="last").groupby("cell"):
        style = ["-", "--"][cell % 2]  # a pair of cells has one gap: both lines are to be seen
        gap.plot(rows["strain"], 1e6 * rows["min_gap_m"], style, label=f"cell {cell}")
        deformation.plot(rows["strain"], rows["deformation"], style)
    gap.set(ylabel="gap to the nearest cell (µm)", ylim=(0, None))
    deformation.set(xlabel="strain", ylabel="deformation (L - B)/(L + B)")
    if cells["cell"].nunique() <= 12:
        gap.legend()
    return save(figure, run / "gaps-and-deformation.png")


def save(figure, path):
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
    return path


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("run", type=pathlib.Path, help="directory of a run")
    arguments.add_argument("--strains", type=float, nargs="+", default=[0, 5, 10, 15], help="of the outlines (0 5 10 15)")
    chosen = arguments.parse_args()
    print(draw_outlines(chosen.run, chosen.strains))
    print(draw_gaps_and_deformation(chosen.run))


if __name__ == "__main__":
    main()
