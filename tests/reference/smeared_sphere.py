#!/usr/bin/env python3
"""What a kernel's moments do to the shape of a capsule: a sphere in a straining Stokes flow whose membrane is smeared out.

usage: smeared_sphere.py            a table: deformation over the exact one, by viscosity ratio and radius in spacings

At small capillary number a capsule in shear is a sphere at rest in the frame that turns with it, and its deformation is proportional
to 11/24 q_n + 3/8 q_t, with the loads q_n n.E.n and q_t (E.n - n n.E.n) of its membrane, both 5 in units of the viscosity (Barthes-Biesel
and Rallison, J. Fluid Mech. 113, 1981). Here forces are spread, and velocities read, by a Gaussian in place of the lattice's kernel:

    plain     by one with the second moment of peskin4, 0.524 spacings^2; arithmetic mean of viscosities
    peskin4   the same with the slip correction (shift, slip, couples; docs/physics.md), harmonic mean
    sharp6    the Gaussian less half its second moment times its Laplacian, with the slip correction
    edge      the same, and a cell's edge that is not smoothed before it sets the viscosity

Harmonics of degree 2 make one equation along the radius: u = U(r) Y n + V(r) grad Y, V = (r U' + 2 U)/6 by continuity, and the dissipation is
least. Cubic Hermite elements for U, out to 60 radii. Forces and velocities, as vectors, are smoothed through their parts of degree 1 and 3.
Nothing of Rouleau is used. Needs numpy and scipy.
"""
import numpy as np
import scipy.sparse as sparse
from scipy.optimize import brentq
from scipy.sparse.linalg import splu
from scipy.special import erf

KERNEL, EDGE, SHARP_EDGE = np.sqrt(0.524), np.sqrt(1 / 12 + 1 / 2), np.sqrt(1 / 12)  # standard deviations, spacings
FAR = 60  # radii
DEGREE = 6  # l (l + 1)


def scaled_bessel(degree, z):
    """The modified spherical Bessel function i_degree(z) exp(-z), degree 1 or 3."""
    at = np.where(z < 0.5, 1, z)
    c, s = (1 + np.exp(-2 * at)) / 2, (1 - np.exp(-2 * at)) / 2
    if degree == 1:
        value, small = (at * c - s) / at**2, z / 3 * (1 + z**2 / 10)
    else:
        value, small = ((at**3 + 15 * at) * c - (6 * at**2 + 15) * s) / at**4, z**3 / 105 * (1 + z**2 / 18)
    return np.where(z < 0.5, small * np.exp(-z), value)


def gaussian(degree, r, centre, variance):
    """What a unit of a harmonic of this degree on the sphere of radius `centre` becomes at r, for each area."""
    return (4 * np.pi * (2 * np.pi * variance) ** -1.5 * np.exp(-((r - centre) ** 2) / (2 * variance))
            * scaled_bessel(degree, r * centre / variance))


def smeared(degree, r, centre, sharpening):
    """The Gaussian less `sharpening` times its Laplacian, which is twice its derivative by the variance."""
    variance, step = KERNEL**2, 0.01 * KERNEL**2
    value = gaussian(degree, r, centre, variance)
    if sharpening:
        value = value - sharpening / step * (gaussian(degree, r, centre, variance + step)
                                             - gaussian(degree, r, centre, variance - step))
    return value


def slip_constants(ratio, sharpening, edge):
    """Shift and slip of docs/physics.md ("Slip correction") for these distributions."""
    x = np.linspace(-8, 8, 16001)

    def kernel(at):
        density = np.exp(-(at**2) / 2 / KERNEL**2) / KERNEL / np.sqrt(2 * np.pi)
        return (1 + erf(at / KERNEL / np.sqrt(2))) / 2 + sharpening * at / KERNEL**2 * density

    def indicator(at):
        return (1 + erf(at / edge / np.sqrt(2))) / 2

    def largest(product):
        return 8 - np.trapz(product, x)

    inside = 1 / ratio
    difference = 1 - inside
    m = largest(kernel(x) ** 2)
    if difference == 0:
        return 0, m
    d = brentq(lambda d: difference * largest(kernel(x + d) * indicator(x)) - inside * d, -6, 6)
    return d, inside * m + difference * (largest(kernel(x) ** 2 * indicator(x - d)) - largest(kernel(x) * indicator(x - d)))


class SmearedSphere:
    def __init__(self, radius, ratio, harmonic, edge, sharpening):
        self.radius, self.sharpening = radius, sharpening
        inner = np.linspace(0, max(radius - 7, 0.3 * radius), 40)
        middle = np.arange(inner[-1], radius + 8, 0.08)[1:]
        outer = middle[-1] * np.exp(np.linspace(0, np.log(FAR * radius / middle[-1]), 150))[1:]
        self.places = x = np.concatenate([inner, middle, outer])
        count, size = len(x) - 1, np.diff(x)
        gauss, weight = np.polynomial.legendre.leggauss(4)
        t = (gauss + 1) / 2
        scale = np.stack([np.ones(count), size, np.ones(count), size], 1)[:, :, None]
        shapes = [np.stack([1 - 3 * t**2 + 2 * t**3, t - 2 * t**2 + t**3, 3 * t**2 - 2 * t**3, t**3 - t**2]),
                  np.stack([6 * t**2 - 6 * t, 1 - 4 * t + 3 * t**2, 6 * t - 6 * t**2, 3 * t**2 - 2 * t]),
                  np.stack([12 * t - 6, 6 * t - 4, 6 - 12 * t, 6 * t - 2])]
        u, u1, u2 = (scale * shape / size[:, None, None] ** k for k, shape in enumerate(shapes))
        self.r, self.weight = x[:-1, None] + size[:, None] * t, size[:, None] * weight / 2
        r = self.r[:, None, :]
        v, v1 = (r * u1 + 2 * u) / 6, (r * u2 + 3 * u1) / 6
        shear = (v1 - v / r + u / r) / 2
        covered = ((erf((self.r + radius) / edge / np.sqrt(2)) - erf((self.r - radius) / edge / np.sqrt(2))) / 2
                   - edge / self.r / np.sqrt(2 * np.pi) * (np.exp(-((self.r - radius) ** 2) / 2 / edge**2)
                                                           - np.exp(-((self.r + radius) ** 2) / 2 / edge**2)))
        viscosity = 1 / (1 + (1 / ratio - 1) * covered) if harmonic else 1 + (ratio - 1) * covered

        def pairs(a, b):
            return a[:, :, None, :] * b[:, None, :, :]

        dissipation = (2 * DEGREE * pairs(shear, shear) + pairs(u1, u1)
                       + (2 * pairs(u, u) - DEGREE * (pairs(u, v) + pairs(v, u)) + (DEGREE**2 - DEGREE) * pairs(v, v))
                       / r[:, :, None, :] ** 2)
        stiffness = ((2 * viscosity * self.weight * self.r**2)[:, None, None, :] * dissipation).sum(-1)
        self.unknowns = 2 * np.arange(count)[:, None] + np.arange(4)
        rows, columns = np.repeat(self.unknowns[:, :, None], 4, 2), np.repeat(self.unknowns[:, None, :], 4, 1)
        self.matrix = sparse.coo_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel()))).tocsc()
        self.free = np.setdiff1d(np.arange(2 * len(x)), [0, 2 * len(x) - 2, 2 * len(x) - 1])
        self.factors = splu(self.matrix[self.free][:, self.free])
        self.normal, self.tangential = u, v

    def solved(self, load):
        u = np.zeros(2 * len(self.places))
        u[self.free] = self.factors.solve(load[self.free])
        return u

    def driven(self, force, at):
        """By normal and tangential forces on each area of the sphere of radius `at`."""
        one, three = (force[0] + 3 * force[1]) / 5, (2 * force[1] - force[0]) / 5
        one, three = (part * smeared(degree, self.r, at, self.sharpening) * at**2 for degree, part in ((1, one), (3, three)))
        normal, tangential = 2 * one - 3 * three, one + three
        load = np.zeros(2 * len(self.places))
        each = ((normal * self.r**2 * self.weight)[:, None] * self.normal
                + (DEGREE * tangential * self.r**2 * self.weight)[:, None] * self.tangential).sum(-1)
        np.add.at(load, self.unknowns.ravel(), each.ravel())
        return self.solved(load)

    def strained(self):
        """By a flow far away, U = r."""
        far = np.zeros(2 * len(self.places))
        far[-2:] = self.places[-1], 1
        return far + self.solved(-self.matrix @ far)

    def read(self, u, at):
        of = u[self.unknowns][:, :, None]
        normal, tangential = (of * self.normal).sum(1), (of * self.tangential).sum(1)
        one, three = (normal + 3 * tangential) / 5, (2 * tangential - normal) / 5
        one, three = ((smeared(degree, self.r, at, self.sharpening) * part * self.r**2 * self.weight).sum()
                      for degree, part in ((1, one), (3, three)))
        return np.array([2 * one - 3 * three, one + three])

    def deformation(self, shift=0.0, slip=0.0):
        """Over the exact one, with forces and velocities at this distance inside, and so much slip."""
        at = self.radius - shift
        couples = np.eye(2) + shift / at * np.array([[-2.0, -6], [1, 1]])
        adjoint = np.eye(2) + shift / at * np.array([[-2.0, 6], [-1, 1]])
        mobility = np.stack([adjoint @ self.read(self.driven(couples @ force * (self.radius / at) ** 2, at), at)
                             for force in np.eye(2)], 1)
        mobility[1, 1] += slip
        force = -np.linalg.solve(mobility, adjoint @ self.read(self.strained(), at))
        return (11 / 24 * -force[0] + 3 / 8 * -2 * force[1]) / (5 * 5 / 6)


def main():
    sharpening = KERNEL**2 / 2
    schemes = {"plain": (False, EDGE, 0), "peskin4": (True, EDGE, 0), "sharp6": (True, EDGE, sharpening),
               "edge": (True, SHARP_EDGE, sharpening)}
    print("ratio radius " + " ".join(f"{name:>8}" for name in schemes))
    for ratio in (1, 5, 20):
        for radius in (6, 8, 12, 16):
            found = []
            for name, (harmonic, edge, sharp) in schemes.items():
                constants = (0, 0) if name == "plain" else slip_constants(ratio, sharp, edge)
                found.append(SmearedSphere(radius, ratio, harmonic, edge, sharp).deformation(*constants))
            print(f"{ratio:5} {radius:6} " + " ".join(f"{value:8.4f}" for value in found))


if __name__ == "__main__":
    main()
