"""The surfaces of three-dimensional runs as one picture, for docs/pictures."""

import matplotlib

matplotlib.use("agg")
import numpy
from matplotlib import pyplot
from mpl_toolkits.mplot3d.art3d import Poly3DCollection

LIGHT = numpy.array([0.3, -0.8, 0.5]) / numpy.linalg.norm([0.3, -0.8, 0.5])
TONES = ["#c8553d", "#3d7ec8"]


def shaded(corners, tone):
    """Colours of triangles [n, 3 corners, 3] under a light from the front, above."""
    normals = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= numpy.linalg.norm(normals, axis=1, keepdims=True)
    bright = 0.45 + 0.55 * numpy.clip(normals @ LIGHT, 0, 1)
    return numpy.clip(numpy.outer(bright, matplotlib.colors.to_rgb(tone)), 0, 1)


def draw(panels, path):
    """panels: {caption: rouleau frame}, all to one scale. The eye looks along z, y is up, as in the two-dimensional pictures."""
    def centred(frame):
        points = [1e6 * numpy.asarray(cell.outline) for cell in frame.cells]
        middle = numpy.concatenate(points).mean(axis=0)
        return [place_um - middle for place_um in points]

    # Axes in three dimensions leave a margin of a fifth.
    half = 0.79 * max(abs(points[:, :2]).max() for frame in panels.values() for points in centred(frame))
    figure = pyplot.figure(figsize=(2.2 * len(panels), 2.4))
    for place, (caption, frame) in enumerate(panels.items()):
        axes = figure.add_subplot(1, len(panels), place + 1, projection="3d", proj_type="ortho")
        for number, (cell, place_um) in enumerate(zip(frame.cells, centred(frame))):
            corners = place_um[:, [0, 2, 1]] * [1, -1, 1]  # a right-handed turn: y goes up
            triangles = corners[numpy.asarray(cell.triangles)]
            tones = shaded(triangles, TONES[number % 2])
            axes.add_collection3d(Poly3DCollection(triangles, facecolors=tones, edgecolors=tones, linewidths=0.2))
        axes.set(xlim=(-half, half), ylim=(-half, half), zlim=(-half, half), box_aspect=(1, 1, 1))
        axes.view_init(elev=22, azim=-70)
        axes.set_axis_off()
        axes.set_title(caption, fontsize=10, y=-0.02)
    figure.subplots_adjust(0, 0.06, 1, 1, 0, 0)
    figure.savefig(path, dpi=110)
    pyplot.close(figure)
