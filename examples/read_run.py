#!/usr/bin/python3
"""Reads a run of Rouleau and draws two figures into its directory: a start for scripts of your own.

outlines.png               cells at chosen strains, their membranes coloured by tension
gaps-and-deformation.png   gap to the nearest neighbour and deformation of each cell over strain

Example: /usr/bin/python3 examples/read_run.py runs/demo --strains 0 4 9 12
Debian: apt install python3-numpy python3-pandas python3-h5py python3-matplotlib; docs/python.md has the package
"""

import argparse
import pathlib
import sys

import matplotlib

# The package of the source folder that this script lies in; an installed one needs no path.
sys.path.insert(0, str(pathlib.Path(__file__).resolve().parent.parent / "python"))

import rouleau  # noqa: E402

matplotlib.use("Agg")  # pictures go into files: no screen is needed
from matplotlib import pyplot  # noqa: E402


def draw_outlines(run, strains):
    frames = [run.frame(strain=min(strain, run.summary.strain)) for strain in strains]
    if not any(frame.cells for frame in frames):
        raise SystemExit(f"{run.directory}/frames.h5 has no membranes: a scene without cells")
    rows = -(-len(frames) // 2)
    figure, axes = pyplot.subplots(rows, 2, squeeze=False, constrained_layout=True, figsize=(11, 0.6 + 3.2 * rows))
    for axis, frame in zip(axes.flat, frames):
        frame.plot("tension", axes=axis)
    for axis in axes.flat[len(frames):]:
        axis.set_visible(False)
    return save(figure, run.directory / "outlines.png")


def draw_gaps_and_deformation(run):
    gap, deformation = run.plot("min_gap_m", "deformation")
    gap.set_ylim(0, None)
    return save(gap.figure, run.directory / "gaps-and-deformation.png")


def save(figure, path):
    figure.savefig(path, dpi=150)
    pyplot.close(figure)
    return path


def main():
    arguments = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    arguments.add_argument("run", help="directory of a run")
    arguments.add_argument("--strains", type=float, nargs="+", default=[0, 5, 10, 15], help="of the outlines (0 5 10 15)")
    chosen = arguments.parse_args()
    try:
        run = rouleau.open(chosen.run)
        print(draw_outlines(run, chosen.strains))
        print(draw_gaps_and_deformation(run))
    except rouleau.Error as error:
        raise SystemExit(str(error)) from None


if __name__ == "__main__":
    main()
