#!/usr/bin/env python3
"""Least energy of red cells in a row at fixed areas: neo-Hookean membranes with bending, Morse potential between them.

usage: rouleau_minimum.py CELLS DEPTH [BENDING_MODULUS [NODES [STRENGTH CUTOFF]]]
       J/m2, J (3.6e-19), nodes of a cell (100), J/m2 and um of a repulsion within each membrane (none)

Prints the parts of the energy, J/m, how far the middle of an end cell's outer face stands out (negative: a dimple), and how
near to each other a cell's faces come. Needs numpy and scipy. From cells at rest 3.52 um apart it goes downhill
(L-BFGS-B, the areas by an augmented Lagrangian), so that it ends in the nearest minimum. Nothing of Rouleau is used.
Inside: lengths in um, energies in shear modulus x um, closest points of all nodes on all segments of the others.
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
    def __init__(self, cells, depth, bending_modulus, nodes, strength=0.0, reach=0.0):
        self.strength, self.reach = strength / SHEAR_MODULUS, reach
        self.cells, self.nodes = cells, nodes
        self.depth, self.bending = depth / SHEAR_MODULUS, bending_modulus / SHEAR_MODULUS * 1e12
        shape = biconcave(nodes)
        sides = following(shape) - shape
        self.length = np.hypot(*sides.T)
        self.weight = (self.length + preceding(self.length)) / 2
        self.curvature = turning_angles(sides) / self.weight
        self.area = area(shape)
        # Nodes and segments of a cell that repel each other: half a circle of the reach's diameter apart along the outline.
        ends = np.r_[0, np.cumsum(self.length)]
        ahead = (ends[:-1][None] - ends[:-1][:, None]) % ends[-1]  # from node to segment
        self.apart = (ahead >= np.pi / 2 * reach) & (ends[-1] - ahead - self.length[None] >= np.pi / 2 * reach)
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
        closest, along, distance, vector = self.closest_points(points, other)
        near = distance <= CUTOFF
        decayed = np.exp(DECAY * (ZERO_FORCE_DISTANCE - distance))
        slope = np.where(near, self.weight * self.depth * DECAY * (decayed - decayed**2) / distance, 0)
        pull = slope[:, None] * vector
        share = along[:, None]
        gradient += pull
        np.add.at(other_gradient, closest, -(1 - share) * pull)
        np.add.at(other_gradient, (closest + 1) % self.nodes, -share * pull)
        return 0.5 * self.depth * np.sum((self.weight * (decayed**2 - 2 * decayed))[near])

    def closest_points(self, points, other, allowed=True):
        """Of all nodes on another outline: segment, place on it, distance, vector from there to the node."""
        sides = following(other) - other
        offset = points[:, None, :] - other[None]
        along = np.clip((offset * sides[None]).sum(2) / (sides**2).sum(1)[None], 0, 1)
        apart = offset - along[..., None] * sides[None]
        closest = np.where(allowed, (apart**2).sum(2), np.inf).argmin(1)
        node = np.arange(self.nodes)
        vector = apart[node, closest]
        return closest, along[node, closest], np.hypot(*vector.T), vector

    def self_repulsion(self, points, gradient):
        """Energy A (1 - r/rc)^3 within a membrane, half for each node, as between two cells."""
        closest, along, distance, vector = self.closest_points(points, points, self.apart)
        within = np.maximum(1 - distance / self.reach, 0)
        slope = -0.5 * self.weight * 3 * self.strength / self.reach * within**2 / distance
        push = slope[:, None] * vector
        gradient += push
        np.add.at(gradient, closest, -(1 - along[:, None]) * push)
        np.add.at(gradient, (closest + 1) % self.nodes, -along[:, None] * push)
        return 0.5 * self.strength * np.sum(self.weight * within**3)

    def evaluate(self, flat):
        """Elastic, bending and interaction energy, their gradient, areas and the areas' gradients."""
        points = flat.reshape(self.cells, self.nodes, 2)
        gradient, by_area, areas = np.zeros_like(points), np.zeros_like(points), np.zeros(self.cells)
        elastic = bending = interaction = 0.0
        for c, cell in enumerate(points):
            parts = self.membrane(cell, gradient[c])
            elastic, bending = elastic + parts[0], bending + parts[1]
            if self.strength > 0:
                interaction += self.self_repulsion(cell, gradient[c])
            areas[c], by_area[c] = area(cell), -0.5 * turned(following(cell) - preceding(cell))
            for d in range(self.cells):
                if d != c:
                    interaction += self.contact(cell, points[d], gradient[c], gradient[d])
        return np.array([elastic, bending, interaction]), gradient, areas, by_area

    def least_energy(self, rounds=4, stiffness=5.0):
        """Elastic, bending and interaction energy of the minimum, J/m, and the outlines."""
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
        return energy * SHEAR_MODULUS * 1e-6, at.reshape(self.cells, self.nodes, 2)


def bow(points):
    """How far the middle of the first cell's outer face, at small x, stands out beyond the points half-way to its rims."""
    middle, half = points[:, 1].mean(), np.ptp(points[:, 1]) / 2

    def face(height):
        ahead = following(points)
        cut = (points[:, 1] - height) * (ahead[:, 1] - height) <= 0
        share = (height - points[cut, 1]) / (ahead[cut, 1] - points[cut, 1])
        return (points[cut, 0] + share * (ahead[cut, 0] - points[cut, 0])).min()

    return (face(middle - half / 2) + face(middle + half / 2)) / 2 - face(middle)


def main():
    given = sys.argv[1:]
    if not (2 <= len(given) <= 4 or len(given) == 6):
        sys.exit(__doc__)
    cells, depth = int(given[0]), float(given[1])
    repulsion = (float(given[4]), float(given[5])) if len(given) == 6 else (0.0, 0.0)
    row = Row(cells, depth, float(given[2]) if len(given) > 2 else 3.6e-19, int(given[3]) if len(given) > 3 else 100, *repulsion)
    energy, outlines = row.least_energy()
    print(f"energy {energy.sum():.6e} J/m: elastic {energy[0]:.4e}, bending {energy[1]:.4e}, interaction {energy[2]:.5e}")
    row.apart = np.abs((np.arange(row.nodes)[None] - np.arange(row.nodes)[:, None] + row.nodes // 2) % row.nodes - row.nodes // 2) > 8
    thinnest = min(row.closest_points(cell, cell, row.apart)[2].min() for cell in outlines)
    print(f"bow {bow(outlines[0]):+.4f} um, thinnest {thinnest:.4f} um")


if __name__ == "__main__":
    main()
