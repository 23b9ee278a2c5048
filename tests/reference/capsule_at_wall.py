#!/usr/bin/env python3
"""A capsule in shear above a wall, in two dimensions, by boundary integrals: how it deforms and is driven away from the wall.
Shares no code with Rouleau (tests/physics/lift.cpp compares it with capsule_at_wall.json).

usage: capsule_at_wall.py [--nodes 160] [--step 0.01] [--strain 8] [--json]

The fluid fills the half plane above the wall and is sheared; viscosities inside and outside are equal. A circle of radius 1 is
put 1.5 above the wall; its membrane is stretched by a tenth then, and obeys Hooke's law. Lengths are over the radius, rates over
the shear rate. u(x) = y e_x + 1/(4 pi) int G(x, x0).q(x0) ds, q the force on the fluid per length over viscosity times shear
rate, and G Green's function of a point force above a wall: Blake's image in two dimensions (Pozrikidis, Boundary Integral and
Singularity Methods, 1992, section 3.3). q is linear on straight segments; those beside a node are integrated by hand. Steps are
Runge-Kutta's of fourth order. Prints strain, height, distance along the wall, deformation and angle over pi, of the area's
ellipse of inertia, and the area over that at first.
"""

import argparse
import json

import numpy as np


def greens_function(x, pole, with_free=True):
    """G[..., i, j]: velocity along i at x of a force along j at the pole, times 4 pi viscosity."""
    def free(r):
        square = np.sum(r * r, axis=-1)
        return (-0.5 * np.log(square))[..., None, None] * np.eye(2) + r[..., :, None] * r[..., None, :] / square[..., None, None]

    h = pole[..., 1]
    image = np.stack([pole[..., 0], -h], axis=-1)
    r = x - image
    square = np.sum(r * r, axis=-1)[..., None, None]
    sign = np.array([1.0, -1.0])  # of forces along and across the wall
    dipole = sign * (np.eye(2) / square - 2 * r[..., :, None] * r[..., None, :] / square**2)
    turned = np.zeros(dipole.shape)  # delta_j2 r_i - delta_i2 r_j
    turned[..., :, 1] += r
    turned[..., 1, :] -= r
    doublet = r[..., 1, None, None] * dipole + sign * turned / square
    height = h[..., None, None]
    result = -free(r) + 2 * height**2 * dipole - 2 * height * doublet
    return result + free(x - pole) if with_free else result


def velocity(x, rest_length, stiffness):
    """Of the nodes."""
    n = len(x)
    after = np.roll(x, -1, axis=0) - x
    length = np.linalg.norm(after, axis=1)
    along = after / length[:, None]
    tension = stiffness * (length / rest_length - 1)
    pull = tension[:, None] * along
    q = (pull - np.roll(pull, 1, axis=0)) / ((length + np.roll(length, 1)) / 2)[:, None]
    points, weights = np.polynomial.legendre.leggauss(6)
    points, weights = (points + 1) / 2, weights / 2
    places = x[:, None, :] + points[None, :, None] * after[:, None, :]
    forces = (1 - points)[None, :, None] * q[:, None, :] + points[None, :, None] * np.roll(q, -1, axis=0)[:, None, :]
    forces = forces * (weights[None, :] * length[:, None])[:, :, None]
    result = np.stack([x[:, 1], np.zeros(n)], axis=1)
    for i in range(n):
        green = greens_function(x[i], places)
        for segment in (i, (i - 1) % n):  # beside the node: the image alone, and the rest by hand
            green[segment] = greens_function(x[i], places[segment], False)
        result[i] += np.einsum("spij,spj->i", green, forces) / (4 * np.pi)
        for segment, other in ((i, (i + 1) % n), ((i - 1) % n, (i - 1) % n)):
            size, t = length[segment], along[segment]
            own, far = size * (0.75 - np.log(size) / 2), size * (0.25 - np.log(size) / 2)
            direct = own * q[i] + far * q[other] + t * (t @ (q[i] + q[other])) * size / 2
            result[i] += direct / (4 * np.pi)
    return result


def shape(x):
    """Area, centre, deformation and angle over pi of what the polygon encloses."""
    y = np.roll(x, -1, axis=0)
    cross = x[:, 0] * y[:, 1] - x[:, 1] * y[:, 0]
    area = cross.sum() / 2
    centre = ((x + y) * cross[:, None]).sum(axis=0) / (6 * area)
    second = np.zeros((2, 2))
    for a, b, c in zip(x - centre, y - centre, (x - centre)[:, 0] * (y - centre)[:, 1] - (x - centre)[:, 1] * (y - centre)[:, 0]):
        s = a + b
        second += c / 24 * (np.outer(a, a) + np.outer(b, b) + np.outer(s, s))
    values, axes = np.linalg.eigh(second / area)
    small, large = np.sqrt(values)
    return area, centre, (large - small) / (large + small), np.arctan(axes[1, 1] / axes[0, 1]) / np.pi


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--nodes", type=int, default=160)
    parser.add_argument("--step", type=float, default=0.01)
    parser.add_argument("--strain", type=float, default=8)
    parser.add_argument("--capillary", type=float, default=0.1)
    parser.add_argument("--json", action="store_true")
    arguments = parser.parse_args()
    # Nothing flows along the wall or through it.
    wall = greens_function(np.array([[0.3, 0.0], [-2.0, 0.0]]), np.array([0.1, 1.2]))
    assert np.abs(wall).max() < 1e-12, wall
    angle = 2 * np.pi * np.arange(arguments.nodes) / arguments.nodes
    x = np.stack([np.cos(angle), 1.5 + np.sin(angle)], axis=1)
    rest_length = np.linalg.norm(np.roll(x, -1, axis=0) - x, axis=1) / 1.1
    move = lambda place: velocity(place, rest_length, 1 / arguments.capillary)  # noqa: E731
    first = shape(x)[0]
    rows, steps = [], round(arguments.strain / arguments.step)
    for step in range(steps + 1):
        if step % round(0.5 / arguments.step) == 0:
            area, centre, deformation, turned = shape(x)
            rows.append([round(step * arguments.step, 6), centre[1], centre[0], deformation, turned, area / first])
            if not arguments.json:
                print("%.2f %.5f %.4f %.5f %.4f %.7f" % tuple(rows[-1]), flush=True)
        h = arguments.step
        k1 = move(x)
        k2 = move(x + h / 2 * k1)
        k3 = move(x + h / 2 * k2)
        x = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + move(x + h * k3))
    if arguments.json:
        print(json.dumps({"columns": ["strain", "height", "distance", "deformation", "angle_over_pi", "area"], "rows": rows}))


if __name__ == "__main__":
    main()
