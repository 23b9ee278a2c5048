#!/usr/bin/env python3
"""Two equal vesicles that adhere to each other by a flat disc: their shape, and when the disc stops being flat.

usage: vesicle_doublet.py                 thresholds of adhesion for reduced volumes from 0.6 to 0.8 (five minutes)
       vesicle_doublet.py VOLUME ADHESION shape and stability of one doublet

The energy is that of Ziherl and Svetina (PNAS 104, 761, 2007): bending kappa/2 (c1 + c2)^2 per area of each vesicle, and -Gamma per
area of the disc, which has no thickness; area and volume of each vesicle are kept. Units: the radius R of a sphere of the vesicle's area,
and kappa; so ADHESION is Gamma R^2/kappa, and VOLUME that of the vesicle over the sphere's.

Shape: the equations of axisymmetric vesicles (Seifert, Berndl and Lipowsky, Phys. Rev. A 44, 1182, 1991), integrated from the pole to the
edge of the disc, where the curvature along the meridian jumps from 0 to sqrt(Gamma/kappa).

Stability: the second variation of the energy, with the multipliers of area and volume, for displacements as cos(m phi) that move both
sides of the disc together, up on one vesicle and down on the other. The disc's edge then keeps its place along both meridians: it would have to move
inwards on both by symmetry, and outwards if the displacement is reversed. The displacement is along the axis on the disc and near its edge
and normal to the vesicle elsewhere, so that what is smooth stays smooth; its amplitude is made of cubic Hermite elements along the meridian. The eigenvalues for
m = 0 and 1 contain 0 (a shift of the doublet along its axis, and a rotation about the disc's diameter), which is a check: it comes out below 0.1.
m = 1: a sigmoid contact; m = 0: one vesicle's bulge in the other's dimple; m = 2: a saddle.

Nothing of Rouleau is used. Needs numpy and scipy.
"""
import sys

import numpy as np
from scipy.integrate import solve_ivp
from scipy.linalg import eigh, null_space
from scipy.optimize import brentq, fsolve

POLE = 1e-4  # where the series at the pole ends


def equations(_, state, tension, pressure):
    """Along the meridian from the pole: its angle and curvature, the radius's multiplier, radius, height, area, volume, bending energy."""
    angle, curvature, multiplier, r = state[:4]
    sine, cosine = np.sin(angle), np.cos(angle)
    across = sine / r
    return [curvature,
            (across - curvature) * cosine / r + pressure * r * cosine / 2 + multiplier * across,
            (curvature**2 - across**2) / 2 + tension + pressure * r * sine,
            cosine, sine, 2 * np.pi * r, np.pi * r**2 * sine, np.pi * r * (curvature + across) ** 2]


def meridian(unknowns):
    """From the pole to where it is parallel to the disc; None: it does not get there."""
    curvature, tension, pressure = unknowns
    start = [POLE * curvature, curvature, POLE * tension, POLE, curvature * POLE**2 / 2, np.pi * POLE**2,
             np.pi * curvature * POLE**4 / 4, 2 * np.pi * (POLE * curvature) ** 2]

    def parallel(_, state, *__):
        return state[0] - np.pi

    def closed(_, state, *__):
        return state[3] - 10 * POLE
    parallel.terminal = closed.terminal = True
    parallel.direction, closed.direction = 1, -1
    solution = solve_ivp(equations, [POLE, 8], start, args=(tension, pressure), events=[parallel, closed], rtol=1e-10,
                         atol=1e-12, dense_output=True, method="DOP853")
    return solution if len(solution.t_events[0]) else None


class Doublet:
    """One vesicle of it, the pole down, the disc on top."""

    def __init__(self, volume, adhesion, guess):
        def misses(unknowns):
            solution = meridian(unknowns)
            if solution is None:
                return [10, 10, 10]
            end = solution.y_events[0][0]
            return [end[1] - np.sqrt(adhesion), (end[5] + np.pi * end[3] ** 2) / (4 * np.pi) - 1,
                    end[6] / (4 * np.pi / 3) - volume]
        self.unknowns, details, _, _ = fsolve(misses, guess, full_output=True, xtol=1e-11)
        if np.abs(details["fvec"]).max() > 1e-8:
            raise ArithmeticError(f"no doublet found for volume {volume}, adhesion {adhesion}")
        self.adhesion = adhesion
        self.solution = meridian(self.unknowns)
        self.length = self.solution.t_events[0][0]
        self.end = self.solution.y_events[0][0]
        self.disc = self.end[3]
        self.bending = self.end[7] / (8 * np.pi)  # over that of a sphere

    def eigenvalues(self, m, cap_elements=160):
        """The lowest four of the second variation."""
        gauss, gauss_weight = np.polynomial.legendre.leggauss(5)
        knots = np.r_[np.linspace(0, self.length, cap_elements + 1),
                      self.length + self.disc * np.linspace(0, 1, cap_elements // 2 + 1)[1:]]
        step = np.diff(knots)
        s = ((knots[1:] + knots[:-1]) / 2)[:, None] + step[:, None] / 2 * gauss
        weight, element = (step[:, None] / 2 * gauss_weight).ravel(), np.repeat(np.arange(len(step)), 5)
        s, x, h = s.ravel(), np.tile((gauss + 1) / 2, len(step)), step[element]
        quadratic, area, volume, r = self.densities(s, m)
        shape = np.array([  # value, first and second derivative of the four functions of an element
            [1 - 3 * x**2 + 2 * x**3, (-6 * x + 6 * x**2) / h, (-6 + 12 * x) / h**2],
            [h * (x - 2 * x**2 + x**3), 1 - 4 * x + 3 * x**2, (-4 + 6 * x) / h],
            [3 * x**2 - 2 * x**3, (6 * x - 6 * x**2) / h, (6 - 12 * x) / h**2],
            [h * (-(x**2) + x**3), -2 * x + 3 * x**2, (-2 + 6 * x) / h]])
        size = 2 * len(knots)
        stiffness, mass, constraints = np.zeros((size, size)), np.zeros((size, size)), np.zeros((2, size))
        of_point = np.einsum("aip,ijp,bjp,p->pab", shape, quadratic, shape, weight)
        mass_of_point = np.einsum("ap,bp,p->pab", shape[:, 0], shape[:, 0], weight * r)
        linear = np.einsum("aip,kip,p->pka", shape, np.array([area, volume]), weight)
        for point in range(len(s)):
            place = 2 * element[point] + np.arange(4)
            stiffness[np.ix_(place, place)] += of_point[point]
            mass[np.ix_(place, place)] += mass_of_point[point]
            constraints[:, place] += linear[point]
        fixed = {0: [1, size - 1], 1: [0, size - 2]}.get(m, [0, 1, size - 2, size - 1])  # smooth at the pole and in the middle
        free = [i for i in range(size) if i not in fixed]
        stiffness, mass = stiffness[np.ix_(free, free)], mass[np.ix_(free, free)]
        if m == 0:
            allowed = null_space(constraints[:, free])
            stiffness, mass = allowed.T @ stiffness @ allowed, allowed.T @ mass @ allowed
        return eigh(stiffness, mass, eigvals_only=True, subset_by_index=[0, 3])

    def densities(self, s, m):
        """For amplitude, its first and second derivative f along s, integrated over phi: the second-order part of the energy
        as a form [3, 3], the first-order parts of area and volume [3] (m = 0), and the radius."""
        cap = s < self.length
        at = np.where(cap, self.solution.sol(np.clip(s, POLE, self.length)), 0.0)
        angle = np.where(cap, at[0], np.pi)
        r = np.where(cap, np.where(s < POLE, s, at[3]), self.disc - (s - self.length))
        height, curvature = np.where(cap, at[4], self.end[4]), at[1]
        sine, cosine = np.where(cap, np.sin(angle), 0.0), np.cos(angle)
        _, tension, pressure = self.unknowns
        change = np.where(cap, (sine / r - curvature) * cosine / r + pressure * r * cosine / 2 + at[2] * sine / r, 0.0)
        # The displacement's direction: normal, and along the axis where w = 1.
        begin = s[(angle > 0.72 * np.pi) & (s > 0.4 * self.length)][0]
        width = 0.8 * (self.length - begin)
        t = np.clip((s - begin) / width, 0, 1)
        w, w1 = t**4 * (35 - 84 * t + 70 * t**2 - 20 * t**3), 140 * t**3 * (1 - t) ** 3 / width
        w2 = 420 * t**2 * (1 - t) ** 2 * (1 - 2 * t) / width**2
        normal = [(sine, cosine * curvature, -sine * curvature**2 + cosine * change),
                  (-cosine, sine * curvature, cosine * curvature**2 + sine * change)]
        along = [[(1 - w) * n, (1 - w) * n1 - w1 * n, (1 - w) * n2 - 2 * w1 * n1 - w2 * n] for n, n1, n2 in normal]
        for order, part in enumerate((w, w1, w2)):
            along[1][order] = along[1][order] + part
        (dr, dr1, dr2), (dz, dz1, dz2) = along
        surface_tension = np.where(cap, tension, tension - self.adhesion / 2)
        angles = 2 * np.pi * (np.arange(8) + 0.5) / 8

        def expand(f, f1, f2):
            total = [Series(0.0)] * 3
            for phi in angles:
                even, odd = (np.cos(m * phi), -m * np.sin(m * phi)) if m else (1.0, 0.0)
                a, a1, a2, p, p1, pp = f * even, f1 * even, f2 * even, f * odd, f1 * odd, -m * m * f * even
                radius = Series(r, a * dr)
                rs, zs = Series(cosine, a1 * dr + a * dr1), Series(sine, a1 * dz + a * dz1)
                rss = Series(-sine * curvature, a2 * dr + 2 * a1 * dr1 + a * dr2)
                zss = Series(cosine * curvature, a2 * dz + 2 * a1 * dz1 + a * dz2)
                rp, zp, rsp, zsp = (Series(0 * r, v) for v in (p * dr, p * dz, p1 * dr + p * dr1, p1 * dz + p * dz1))
                rpp, zpp = Series(0 * r, pp * dr), Series(0 * r, pp * dz)
                first, mixed, second = rs * rs + zs * zs, rs * rp + zs * zp, rp * rp + radius * radius + zp * zp
                n_r, n_phi, n_z = radius * zs, zp * rs - rp * zs, -(radius * rs)  # outward, as long as the area element
                squared = first * second - mixed * mixed
                element = squared.root()
                curving = (first * ((rpp - radius) * n_r + 2.0 * rp * n_phi + zpp * n_z)
                           - 2.0 * mixed * (rsp * n_r + rs * n_phi + zsp * n_z) + second * (rss * n_r + zss * n_z))
                volume = 0.5 * radius * n_r
                energy = 0.5 * curving * curving / (squared * squared * element) + surface_tension * element + pressure * volume
                total = [sum_ + part for sum_, part in zip(total, (energy, element, volume))]
            return [2 * np.pi / len(angles) * part for part in total]

        unit = np.eye(3)
        alone = [expand(*unit[i]) for i in range(3)]
        form = np.zeros((3, 3, len(s)))
        for i in range(3):
            form[i, i] = alone[i][0].second
            for j in range(i):
                form[i, j] = form[j, i] = (expand(*(unit[i] + unit[j]))[0].second - alone[i][0].second - alone[j][0].second) / 2
        linear = [np.array([np.broadcast_to(alone[i][k].first, s.shape) for i in range(3)]) for k in (1, 2)]
        return form, *linear, r


class Series:
    """a + first e + second e^2, what is of higher order left out."""
    __array_ufunc__ = None

    def __init__(self, value, first=0.0, second=0.0):
        self.value, self.first, self.second = value, first, second

    def __add__(self, other):
        other = other if isinstance(other, Series) else Series(other)
        return Series(self.value + other.value, self.first + other.first, self.second + other.second)

    def __neg__(self):
        return Series(-self.value, -self.first, -self.second)

    def __sub__(self, other):
        return self + -other

    def __mul__(self, other):
        other = other if isinstance(other, Series) else Series(other)
        return Series(self.value * other.value, self.value * other.first + self.first * other.value,
                      self.value * other.second + self.first * other.first + self.second * other.value)
    __rmul__ = __mul__

    def __truediv__(self, other):
        one = 1 / other.value
        ratio = other.first * one
        return self * Series(one, -ratio * one, (ratio * ratio - other.second * one) * one)

    def root(self):
        value = np.sqrt(self.value)
        first = self.first / (2 * value)
        return Series(value, first, (self.second - first * first) / (2 * value))


class Family:
    """Doublets of one volume; those asked for one after another should not be far apart."""
    STARTS = {0.85: (0.3096, -2.7209, 8.1841), 0.8: (0.0528, -3.1946, 10.1082), 0.75: (-0.2103, -3.4747, 11.7218),
              0.7: (-0.4781, -3.6057, 13.0955), 0.65: (-0.7488, -3.6087, 14.2445)}  # at adhesion 9

    def __init__(self, volume):
        self.volume = volume
        near = min(self.STARTS, key=lambda v: abs(v - volume))
        guess = self.STARTS[near]
        for v in np.linspace(near, volume, 1 + round(abs(near - volume) / 0.005)):
            guess = Doublet(v, 9.0, guess).unknowns
        self.last = (3.0, guess)

    def doublet(self, adhesion):
        """By steps of 0.25 in the contact curvature."""
        before, guess = self.last
        for curvature in np.linspace(before, np.sqrt(adhesion), 2 + int(abs(np.sqrt(adhesion) - before) / 0.25))[1:]:
            found = Doublet(self.volume, curvature**2, guess)
            guess = found.unknowns
        self.last = (np.sqrt(adhesion), guess)
        return found

    def growing(self, m, adhesion):
        """The lowest eigenvalue; of those above -0.1, the second one where the lowest is 0 but for the elements' error."""
        lowest = self.doublet(adhesion).eigenvalues(m)
        return lowest[0] if m == 2 or lowest[0] < -0.1 else lowest[1]

    def thresholds(self, m, most=80):
        """Where the eigenvalue changes its sign, from 0.5 on."""
        adhesions = [curvature**2 for curvature in np.arange(0.75, np.sqrt(most), 0.5)]
        values = [self.growing(m, a) for a in adhesions]
        return [brentq(lambda a: self.growing(m, a), low, high, xtol=0.02)
                for low, high, v, w in zip(adhesions, adhesions[1:], values, values[1:]) if v * w < 0], values[-1] < 0


def main(arguments):
    if arguments:
        volume, adhesion = map(float, arguments)
        found = Family(volume).doublet(adhesion)
        print(f"disc {found.disc:.4f}, bending energy over a sphere's {found.bending:.4f}, tension {found.unknowns[1]:.3f}, "
              f"pressure {-found.unknowns[2]:.3f}")
        for m in range(3):
            print(f"m = {m}:", *(f"{value:.3f}" for value in found.eigenvalues(m)))
        return
    for volume in (0.6, 0.65, 0.7, 0.75, 0.8):
        for m in range(3):
            changes, unstable = Family(volume).thresholds(m)
            print(f"volume {volume}, m = {m}: changes at", *(f"{a:.2f}" for a in changes), "unstable" if unstable else "stable",
                  "beyond", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
