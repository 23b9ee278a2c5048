"""The surfaces of three-dimensional runs as one picture, for docs/pictures."""

import dataclasses

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


GROUND, PLATE, INK = "#fbf3e6", "#8d99a6", "#333333"
REDS = ["#c23b30", "#d9604c"]


def turned(points, elevation):
    """Places seen by an eye that looks along z from above: to the right, upwards, and towards the eye."""
    sine, cosine = numpy.sin(numpy.radians(elevation)), numpy.cos(numpy.radians(elevation))
    x, y, z = points.T
    return numpy.column_stack([x, y * cosine + z * -sine, y * sine + z * cosine])


def smooth(points, triangles, cuts=2):
    """Triangles cut into four, so many times, and a normal for each: the shade of a coarse mesh without its facets."""
    corners = points[triangles]
    flat = numpy.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = numpy.zeros_like(points)
    for corner in range(3):
        numpy.add.at(normals, triangles[:, corner], flat)
    normals = normals[triangles]

    def cut(values):
        a, b, c = values[:, 0], values[:, 1], values[:, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        return numpy.concatenate([numpy.stack(part, axis=1) for part in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))])

    for _ in range(cuts):
        corners, normals = cut(corners), cut(normals)
    middle = normals.mean(axis=1)
    return corners, middle / numpy.linalg.norm(middle, axis=1, keepdims=True)


def close_up(axes, frame, elevation=14, box_um=None, cuts=2):
    """The cells of a frame, near, with a light from above on the left; with a box their middles are brought back into it."""
    from matplotlib.collections import PolyCollection

    light = numpy.array([-0.35, 0.75, 0.56])
    shapes, tones, depths = [], [], []
    for cell in frame.cells:
        place_um = 1e6 * numpy.asarray(cell.outline)
        if box_um is not None:
            place_um -= numpy.floor(place_um.mean(axis=0) / box_um) * box_um
        corners, normals = smooth(turned(place_um, elevation), numpy.asarray(cell.triangles), cuts)
        outwards = numpy.sum(normals * (corners.mean(axis=1) - corners.mean(axis=(0, 1))))
        normals = normals * numpy.sign(outwards)  # whichever way round the mesh has its triangles
        seen = normals[:, 2] > -0.05
        bright = 0.38 + 0.62 * numpy.clip(normals @ light, 0, 1)
        shine = numpy.clip(normals @ (light + [0, 0, 1]) / numpy.linalg.norm(light + [0, 0, 1]), 0, 1) ** 24
        colours = numpy.outer(bright, matplotlib.colors.to_rgb(REDS[cell.number % 2])) + 0.25 * shine[:, None]
        shapes.append(corners[seen, :, :2])
        tones.append(numpy.clip(colours[seen], 0, 1))
        depths.append(corners[seen, :, 2].mean(axis=1))
    order = numpy.argsort(numpy.concatenate(depths))
    tones = numpy.concatenate(tones)[order]
    axes.add_collection(PolyCollection(numpy.concatenate(shapes)[order], facecolors=tones, edgecolors=tones, linewidths=0.3))


def sheared(frame, path, height_um, left_um, right_um, depth_um, pixels=900, elevation=14):
    """One picture of a film: cells between two walls that move, with a bar of 5 um and the strain."""
    lower, upper = (turned(numpy.array([[0, y, depth_um / 2]]), elevation)[0, 1] for y in (0, height_um))
    bottom, top = lower - 1.6, upper + 1.6
    size = (pixels / 100, pixels / 100 * (top - bottom) / (right_um - left_um))
    figure = pyplot.figure(figsize=size, facecolor=GROUND)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set(xlim=(left_um, right_um), ylim=(bottom, top))
    axes.set_axis_off()
    width = right_um - left_um
    for y, below, way in ((upper, 0, 1), (lower, -0.6, -1)):
        axes.add_patch(pyplot.Rectangle((left_um, y + below), width, 0.6, color=PLATE, lw=0))
        for part in (0.2, 0.5, 0.8):
            x = left_um + part * width
            axes.annotate("", (x + 2 * way, y - 1.1 * way), (x - 2 * way, y - 1.1 * way),
                          arrowprops={"arrowstyle": "-|>", "color": PLATE, "lw": 2.2, "mutation_scale": 16})
    close_up(axes, frame, elevation)
    x = left_um + 1
    axes.plot([x, x + 5], [lower + 2.2] * 2, color=INK, lw=3, solid_capstyle="butt")
    axes.text(x + 2.5, lower + 2.6, "5 um", ha="center", va="bottom", color=INK, fontsize=11)
    axes.text(right_um - 1, lower + 2.2, f"strain {frame.strain:.0f}", ha="right", va="bottom", color=INK, fontsize=11)
    figure.savefig(path, dpi=100, facecolor=GROUND)
    pyplot.close(figure)


def suspension(frame, path, box_um, elevation=22):
    """All cells of a box, brought back into it, as large as they can be in a picture of 600 by 400 pixels."""
    figure = pyplot.figure(figsize=(6, 4), facecolor=GROUND)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set_axis_off()
    close_up(axes, frame, elevation, numpy.asarray(box_um))
    seen = numpy.concatenate([shape.vertices for shape in axes.collections[0].get_paths()])
    low, high = seen.min(axis=0), seen.max(axis=0)
    half = 0.53 * max((high - low) / [6, 4])
    for name, middle, part in zip("xy", (low + high) / 2, (6, 4)):
        axes.set(**{f"{name}lim": (middle - part * half, middle + part * half)})
    figure.savefig(path, dpi=100, facecolor=GROUND)
    pyplot.close(figure)


def mesh_of(path):
    """Points [n, 3] and triangles [m, 3] of an OBJ file."""
    lines = [line.split() for line in path.read_text().splitlines()]
    return (numpy.array([[float(word) for word in words[1:]] for words in lines if words[:1] == ["v"]]),
            numpy.array([[int(word) - 1 for word in words[1:]] for words in lines if words[:1] == ["f"]]))


def blank(window, pixels, ground):
    """A figure without a margin, and its axes, of what lies within (left, right, low, high)."""
    left, right, low, high = window
    figure = pyplot.figure(figsize=(pixels / 100, pixels / 100 * (high - low) / (right - left)), facecolor=ground)
    axes = figure.add_axes([0, 0, 1, 1])
    axes.set(xlim=(left, right), ylim=(low, high))
    axes.set_axis_off()
    return figure, axes


def glass(walls, length_um, window, pixels, elevation):
    """A vessel as two images [rows, columns, 4]: behind the cells, and before them, darker where one looks along its wall."""
    from matplotlib.collections import PolyCollection

    points = walls[0] * [1, 1, 1]
    points[:, 0] = numpy.clip(points[:, 0], 0, length_um)
    corners, normals = smooth(turned(points, elevation), walls[1])
    images = []
    for part, least, most in ((normals[:, 2] < 0, 0.10, 0.5), (normals[:, 2] >= 0, 0.0, 0.5)):
        figure, axes = blank(window, pixels, "black")
        order = numpy.argsort(corners[part, :, 2].mean(axis=1))
        tones = numpy.repeat(least + (most - least) * (1 - numpy.abs(normals[part, 2][order])) ** 3, 3).reshape(-1, 3)
        axes.add_collection(PolyCollection(corners[part][order][:, :, :2], facecolors=tones, edgecolors=tones, linewidths=0.5))
        figure.canvas.draw()
        share = numpy.asarray(figure.canvas.buffer_rgba())[:, :, 0] / 255
        pyplot.close(figure)
        images.append(numpy.dstack([*(tone * numpy.ones_like(share) for tone in matplotlib.colors.to_rgb(PLATE)), share]))
    return images


def between(frames, parts):
    """Frames, and `parts` - 1 between each and the next, where each cell that both have goes straight on."""
    before = None
    for frame in frames:
        for part in range(1, parts) if before is not None else ():
            share = part / parts
            ends = {cell.number: cell for cell in frame.cells}
            cells = [dataclasses.replace(cell, outline=(1 - share) * cell.outline + share * ends[cell.number].outline)
                     for cell in before.cells if cell.number in ends]
            yield dataclasses.replace(before, cells=cells, time_s=(1 - share) * before.time_s + share * frame.time_s)
        yield frame
        before = frame


def through_vessel(frames, folder, walls, size_um, pixels=900, elevation=20):
    """The pictures of a film, 000.png and so on: cells in a vessel of glass, with a bar of 10 um, arrows of the flow and the time.
    walls: points and triangles in um."""
    low, high = (turned(numpy.array([[0, y, z]]), elevation)[0, 1] for y, z in ((2.2, size_um[2] - 1.5), (size_um[1] - 1, 1.5)))
    left, right = window = (-4, size_um[0] + 4)
    window = (*window, low, high)
    behind, before = glass(walls, size_um[0], window, pixels, elevation)
    ends = [turned(numpy.array([[x, y, size_um[2] / 2]]), elevation)[0, :2]
            for x, y in ((-2, 13.6), (size_um[0] + 2, 20.6), (size_um[0] + 2, 7))]
    for number, frame in enumerate(frames):
        figure, axes = blank(window, pixels, GROUND)
        axes.imshow(behind, extent=window, aspect="auto", zorder=0)
        close_up(axes, frame, elevation, cuts=1)
        axes.imshow(before, extent=window, aspect="auto", zorder=3)
        for x, y in ends:
            axes.annotate("", (x + 1.6, y), (x - 1.6, y), arrowprops={"arrowstyle": "-|>", "color": PLATE, "lw": 2.2, "mutation_scale": 16})
        axes.plot([left + 1, left + 11], [low + 1.2] * 2, color=INK, lw=3, solid_capstyle="butt")
        axes.text(left + 6, low + 1.6, "10 um", ha="center", va="bottom", color=INK, fontsize=11)
        axes.text(right - 1, high - 0.8, f"{1e3 * frame.time_s:.0f} ms", ha="right", va="top", color=INK, fontsize=11)
        axes.set(xlim=window[:2], ylim=window[2:])
        figure.savefig(f"{folder}/{number:03}.png", dpi=100, facecolor=GROUND)
        pyplot.close(figure)
