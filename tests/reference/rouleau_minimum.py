#!/usr/bin/env python3
"""Least energy of red cells in a row at fixed areas: neo-Hookean membranes with bending, Morse potential between neighbours.

usage: rouleau_minimum.py CELLS DEPTH [BENDING_MODULUS [NODES]]     J/m2, J (3.6e-19), nodes of a cell (100)

Prints the parts of the energy, J/m. Needs numpy and scipy. From cells at rest 3.52 um apart it goes downhill
(L-BFGS-B, the areas by an augmented Lagrangian), so that it ends in the nearest minimum. Nothing of Rouleau is used.
Inside: lengths in um, energies in shear modulus x um, closest points of all nodes on all segments of a neighbour.
"""
import sys

import numpy as np
from scipy.optimize import minimize

RADIUS, SPACING = 3.91, 3.52  # um
SHEAR_MODULUS = 6e-6  # N/m
DECAY, ZERO_FORCE_DISTANCE, CUTOFF = 3.84, 0.49, 3.52  # 1/um, um, um


def turned(vectors):
    """By +90 degrees."""
    return np.c_[-vectors[:, 1], vectors[:, 0]]


def following(values):
    return np.roll(values, -1, 0)


def preceding(values):
    return np.roll(values, 1, 0)


def biconcave(nodes):
    """Nodes at equal distances along the outline."""
    angle = np.linspace(0, 2 * np.pi, 200001)
    x = np.cos(angle)
    points = RADIUS * np.c_[x, np.sin(angle) * 0.5 * (0.207 + 2.002 * x**2 - 1.122 * x**4)]
    length = np.r_[0, np.cumsum(np.hypot(*np.diff(points, axis=0).T))]
    places = np.linspace(0, length[-1], nodes, endpoint=False)
    return np.c_[np.interp(places, length, points[:, 0]), np.interp(places, length, points[:, 1])]


def area(points):
    after = following(points)
    return 0.5 * np.sum(points[:, 0] * after[:, 1] - points[:, 1] * after[:, 0])


def turning_angles(tangents):
    before = preceding(tangents)
    cross = before[:, 0] * tangents[:, 1] - before[:, 1] * tangents[:, 0]
    return np.arctan2(cross, (before * tangents).sum(1))


class Row:
    def __init__(self, cells, depth, bending_modulus, nodes):
        self.cells, self.nodes = cells, nodes
        self.depth, self.bending = depth / SHEAR_MODULUS, bending_modulus / SHEAR_MODULUS * 1e12
        shape = biconcave(nodes)
        sides = following(shape) - shape
        self.length = np.hypot(*sides.T)
        self.weight = (self.length + preceding(self.length)) / 2
        self.curvature = turning_angles(sides) / self.weight
        self.area = area(shape)
        self.start = np.concatenate([turned(shape) + [SPACING * (c - (cells - 1) / 2), 0] for c in range(cells)])

    def membrane(self, points, gradient):
        """Elastic and bending energy; their gradient is added."""
        sides = following(points) - points
        length = np.hypot(*sides.T)
        tangent, stretch = sides / length[:, None], length / self.length
        elastic = np.sum(self.length * (0.4 * stretch**2.5 + 2 * stretch**-0.5 - 2.4))
        tension = (stretch**1.5 - stretch**-1.5)[:, None] * tangent
        excess = turning_angles(tangent) / self.weight - self.curvature
        moment = self.bending * excess
        shear = ((moment - following(moment)) / length)[:, None] * turned(tangent)
        gradient += preceding(tension + shear) - tension - shear
        return elastic, 0.5 * self.bending * np.sum(excess**2 * self.weight)

    def contact(self, points, other, gradient, other_gradient):
        """Half the energy between two cells: of the nodes of one and the outline of the other."""
        sides = following(other) - other
        offset = points[:, None, :] - other[None]
        along = np.clip((offset * sides[None]).sum(2) / (sides**2).sum(1)[None], 0, 1)
        apart = offset - along[..., None] * sides[None]
        square = (apart**2).sum(2)
        closest, node = square.argmin(1), np.arange(self.nodes)
        distance = np.sqrt(square[node, closest])
        near = distance <= CUTOFF
        decayed = np.exp(DECAY * (ZERO_FORCE_DISTANCE - distance))
        slope = np.where(near, self.weight * self.depth * DECAY * (decayed - decayed**2) / distance, 0)
        pull = slope[:, None] * apart[node, closest]
        share = along[node, closest][:, None]
        gradient += pull
        np.add.at(other_gradient, closest, -(1 - share) * pull)
        np.add.at(other_gradient, (closest + 1) % self.nodes, -share * pull)
        return 0.5 * self.depth * np.sum((self.weight * (decayed**2 - 2 * decayed))[near])

    def evaluate(self, flat):
        """Elastic, bending and interaction energy, their gradient, areas and the areas' gradients."""
        points = flat.reshape(self.cells, self.nodes, 2)
        gradient, by_area, areas = np.zeros_like(points), np.zeros_like(points), np.zeros(self.cells)
        elastic = bending = interaction = 0.0
        for c, cell in enumerate(points):
            parts = self.membrane(cell, gradient[c])
            elastic, bending = elastic + parts[0], bending + parts[1]
            areas[c], by_area[c] = area(cell), -0.5 * turned(following(cell) - preceding(cell))
            for d in (c - 1, c + 1):
                if 0 <= d < self.cells:
                    interaction += self.contact(cell, points[d], gradient[c], gradient[d])
        return np.array([elastic, bending, interaction]), gradient, areas, by_area

    def least_energy(self, rounds=4, stiffness=5.0):
        """Elastic, bending and interaction energy of the minimum, J/m."""
        at, pressure = self.start.ravel().copy(), np.zeros(self.cells)
        for _ in range(rounds):

            def augmented(flat):
                energy, gradient, areas, by_area = self.evaluate(flat)
                excess = areas - self.area
                force = pressure + stiffness * excess
                return (energy.sum() + pressure @ excess + 0.5 * stiffness * excess @ excess,
                        (gradient + force[:, None, None] * by_area).ravel())

            at = minimize(augmented, at, jac=True, method="L-BFGS-B",
                          options={"maxiter": 4000, "maxfun": 8000, "maxcor": 40, "ftol": 1e-15, "gtol": 1e-8}).x
            energy, _, areas, _ = self.evaluate(at)
            pressure = pressure + stiffness * (areas - self.area)
        print(f"areas kept to {np.abs(areas / self.area - 1).max():.1e}")
        return energy * SHEAR_MODULUS * 1e-6


def main():
    if not 3 <= len(sys.argv) <= 5:
        sys.exit(__doc__)
    cells, depth = int(sys.argv[1]), float(sys.argv[2])
    bending_modulus = float(sys.argv[3]) if len(sys.argv) > 3 else 3.6e-19
    energy = Row(cells, depth, bending_modulus, int(sys.argv[4]) if len(sys.argv) > 4 else 100).least_energy()
    print(f"energy {energy.sum():.6e} J/m: elastic {energy[0]:.4e}, bending {energy[1]:.4e}, interaction {energy[2]:.5e}")


if __name__ == "__main__":
    main()
