#!/usr/bin/env python3
"""A capsule in shear between two walls, in two dimensions, by boundary integrals: height, deformation, angle and viscosity.
Shares no code with Rouleau. Made capsules_in_channels.json, and agrees with capsule_channel.json, which others made (--check).

usage: capsule_in_channel.py [--height 6.4] [--place 0.5] [--capillary 0.05] [--ratio 1] [--strain 8] [--nodes 64] [--step 0.01]
       capsule_in_channel.py --cases FILE [--out FILE] [--processes 2]   a table of [{"height", "place", "capillary", "ratio", "strain"}, ...]
       capsule_in_channel.py --check [--processes 2]                     comparison with capsule_channel.json

Stokes flow, periodic along the walls (12.8). These move in opposite directions; there is no mean pressure gradient. A circle of
radius 1 at rest is put at `place` of the height into the shear flow; `ratio` is its viscosity over that outside. Lengths are
over the radius, rates over the shear rate, tensions over viscosity times rate times radius: the shear modulus is then 1/Ca.

Membrane: tension T = (e^1.5 - e^-1.5)/Ca at the stretch e (neo-Hookean, free across the plane), moment M = 0.01/Ca (c - 1). c is
the turning angle over the rest length, as in Rouleau (forces are then the gradient of an energy), or with --moment present
over the present length, as in capsule_channel.json. The force per rest length is d/ds (T t - dM/ds n/e), n the normal inward.

Flow (Pozrikidis, Boundary Integral and Singularity Methods, 1992):
(1 + ratio)/2 u(x0) = U(x0) + 1/(4 pi) int G(x0, x).f(x) ds + (1 - ratio)/(4 pi) int u(x).T(x, x0).n(x) ds, n outward. G is the
periodic Stokeslet, in closed form by A = ln(2 cosh(k y) - 2 cos(k x))/2, plus for each wave number the regular flow that
cancels it at the walls. Nodes are equidistant at rest, derivatives Fourier's; the logarithm is integrated by Kress's weights
(Linear Integral Equations, 1989, section 12.3). Without a filter the highest modes grow by aliasing (Ca 0.2, ratio 5): the
velocity has none above two thirds of them. Steps are of second order (BDF2), from short ones that grow up to strain 0.5:
G and T are those of the extrapolated shape, forces those of the new one, found by Newton's method.

Columns: strain, height of the centre, deformation and angle (degrees) of the area's ellipse of inertia, relative viscosity, and
area over that at first. The viscosity is 1 plus the cell's stresslet over the channel's area. That is exactly the mean shear
stress at the walls, wherever the cell is: the stress integrated over the channel is the walls' plus what forces f at y add, -f y.
"""

import argparse
import json
import multiprocessing
import pathlib

import numpy as np

FOLDER = pathlib.Path(__file__).resolve().parent
PERIOD = 12.8
K = 2 * np.pi / PERIOD  # wave number
BENDING = 0.01  # modulus over that of shear
OUTPUT = 0.5  # strain
COLUMNS = ["strain", "centre", "deformation", "angle_deg", "relative_viscosity", "area"]
WHAT = "Capsules in shear between two walls in two dimensions: radius 1, period 12.8, bending modulus 0.01, creeping flow."
UNCERTAINTY = ("of six of the hardest cases up to strain 8 (1.6 from the wall; capillary numbers 0.0125 and 0.2; ratios 1 and 5), by half the step: "
               "centre 1e-5, deformation 5e-6, angle 7e-4 deg, viscosity 2e-6; by 48 nodes: centre 6e-6, deformation 9e-7, angle 2e-4 deg, "
               "viscosity 1e-6")


def cross(a, b):
    return a[0] * b[1] - a[1] * b[0]


def periodic(x, pole):
    """At x - pole: y and exp(2 A), then derivatives of A by x, y, xy and yy; not finite at the pole."""
    dx, y = x[0][:, None] - pole[0], x[1][:, None] - pole[1]
    square = 4 * (np.sinh(K * y / 2) ** 2 + np.sin(K * dx / 2) ** 2)
    with np.errstate(divide="ignore", invalid="ignore"):
        along, across = np.sin(K * dx) / square, np.sinh(K * y) / square
        return y, square, K * along, K * across, -2 * K**2 * along * across, K**2 * (np.cosh(K * y) / square - 2 * across**2)


def pairs(xx, xy, yx, yy):
    """[i, x, j, pole] of four matrices of x and pole."""
    return np.stack([[xx, xy], [yx, yy]]).transpose(0, 2, 1, 3)


class Walls:
    """What walls at 0 and `height` add to the periodic Stokeslet.

    For each wave number k that is exp(i k x) times four flows, of stream functions exp(-k y)/k, y exp(-k y), and the same from
    the other wall. Without k, it is the shear flow that stops both walls."""

    def __init__(self, height):
        self.height, self.numbers = height, np.arange(1, 161)
        at_walls = self.flows(np.array([0.0, height]), self.numbers)
        self.inverse = np.linalg.inv(at_walls.transpose(3, 2, 0, 1).reshape(-1, 4, 4))

    def flows(self, y, numbers):
        """Velocities [component, flow, y, number]."""
        k, y = K * numbers, y[:, None]
        z = self.height - y
        a, b = np.exp(-k * y), np.exp(-k * z)
        return np.stack([[-a, (1 - k * y) * a, b, (k * z - 1) * b], [-1j * a, -1j * k * y * a, -1j * b, -1j * k * z * b]])

    def tractions(self, y, normal, numbers):
        k, y, (nx, ny) = K * numbers, y[:, None], normal[:, :, None]
        z = self.height - y
        a, b = 2 * k * np.exp(-k * y), 2 * k * np.exp(-k * z)
        xx = 1j * np.stack([-a, (2 - k * y) * a, b, (k * z - 2) * b])
        xy = np.stack([a, (k * y - 1) * a, b, (k * z - 1) * b])
        yy = 1j * np.stack([a, k * y * a, -b, -k * z * b])
        return np.stack([xx * nx + xy * ny, xy * nx + yy * ny])

    def strengths(self, pole, numbers):
        """Of the four flows, for forces along x and y at the poles: minus what the Stokeslet does at the walls."""
        k, values = K * numbers, []
        for wall in (0, self.height):
            y = k * (wall - pole[1])[:, None]
            scale = np.exp(-abs(y)) / numbers
            values += [[(1 - abs(y)) * scale, -1j * y * scale], [-1j * y * scale, (1 + abs(y)) * scale]]
        values = np.array(values) * np.exp(-1j * k * pole[0][:, None])  # wall and component, force, pole, number
        return -self.inverse[: len(numbers)] @ values.transpose(3, 0, 1, 2).reshape(len(numbers), 4, -1)

    def prepare(self, x, pole):
        """The wave numbers that matter, and the strengths."""
        gaps = [np.min(place) + np.min(other) for place, other in ((x[1], pole[1]), (self.height - x[1], self.height - pole[1]))]
        count = int(np.ceil(36 / (K * min(gaps))))
        assert 0 < count <= len(self.numbers), "too near a wall"
        return self.numbers[:count], self.strengths(pole, self.numbers[:count])

    @staticmethod
    def add_up(flows, x, numbers, strengths):
        flows = flows * np.exp(1j * K * numbers * x[0][:, None])
        left = flows.transpose(0, 2, 3, 1).reshape(2 * x.shape[1], -1)
        right = strengths.reshape(left.shape[1], -1)
        return (left.real @ right.real - left.imag @ right.imag).reshape(2, x.shape[1], 2, -1)

    def velocity(self, x, pole):
        """[i, x, j, pole]: along i at x of a force along j at the pole, times 4 pi."""
        numbers, strengths = self.prepare(x, pole)
        result = self.add_up(self.flows(x[1], numbers), x, numbers, strengths)
        y, h = x[1][:, None], self.height
        result[0, :, 0] += K / h * (pole[1] * (h - y) + (h - pole[1]) * y)
        return result

    def traction(self, x, normal, pole):
        numbers, strengths = self.prepare(x, pole)
        result = self.add_up(self.tractions(x[1], normal, numbers), x, numbers, strengths)
        result[:, :, 0] += normal[::-1, :, None] * K * (1 - 2 * pole[1] / self.height)
        return result


class Capsule:
    def __init__(self, height, capillary, ratio, nodes, moment):
        self.walls, self.ratio, self.nodes = Walls(height), ratio, nodes
        self.modulus, self.bending, self.present = 1 / capillary, BENDING / capillary, moment == "present"
        self.weight = 2 * np.pi / nodes
        self.angle = self.weight * np.arange(nodes)
        between = self.angle[:, None] - self.angle
        waves = np.arange(1, nodes // 2)
        cosines, sines = np.cos(between[:, :, None] * waves), np.sin(between[:, :, None] * waves)
        self.derivative = -2 / nodes * sines @ waves
        self.filter = np.kron(np.eye(2), 1 + 2 * cosines[:, :, : nodes // 3].sum(axis=2)) / nodes
        # Integrates ln(4 sin^2((s - s')/2)) times a function.
        self.log_weights = -4 * np.pi / nodes * (cosines @ (1 / waves) + np.cos(between * nodes / 2) / nodes)
        self.sine = 4 * np.sin(between / 2) ** 2 + np.eye(nodes)

    def geometry(self, x):
        """Derivative of the place by the rest length, stretch, unit tangent."""
        tangent = x @ self.derivative.T
        stretch = np.hypot(*tangent)
        return tangent, stretch, tangent / stretch

    def motion(self, x):
        """(a, b), where the velocity is a + b.f, f the forces per rest length."""
        n, h = self.nodes, self.weight
        _, stretch, t = self.geometry(x)
        y, square, ax, ay, *_ = periodic(x, x)
        np.fill_diagonal(square, (K * stretch) ** 2)
        log = (self.log_weights + h * np.log(square / self.sine)) / 2
        yax, yay = h * y * ax, h * y * ay
        np.fill_diagonal(yax, h * t[0] * t[1])
        np.fill_diagonal(yay, h * t[1] ** 2)
        single = pairs(-log - yay, yax, yax, yay - log) + h * self.walls.velocity(x, x)
        shear = np.concatenate([x[1] - self.walls.height / 2, np.zeros(n)])
        both = np.column_stack([shear, single.reshape(2 * n, 2 * n) / (4 * np.pi)])
        if self.ratio != 1:
            both = np.linalg.solve((1 + self.ratio) / 2 * np.eye(2 * n) - (1 - self.ratio) / (4 * np.pi) * self.double_layer(x), both)
        both = self.filter @ both
        return both[:, 0], both[:, 1:]

    def double_layer(self, x):
        """By the velocities: int u.T.n ds, of components j at the poles."""
        tangent, _, t = self.geometry(x)
        normal = self.weight * np.stack([tangent[1], -tangent[0]])  # outward, times length
        (nx, ny), same = normal[:, :, None], np.arange(self.nodes)
        y, _, ax, ay, axy, ayy = periodic(x, x)
        xxy, xyy = -2 * ay - 2 * y * ayy, 2 * y * axy  # T: stress xy of a force along x, yy of one along x
        kernel = pairs((-4 * ax - xyy) * nx + xxy * ny, xxy * nx + xyy * ny, xxy * nx + xyy * ny, xyy * nx + (2 * y * ayy - 2 * ay) * ny)
        turning = self.weight * cross(t, t @ self.derivative.T)  # curvature times length
        kernel[:, same, :, same] = (-2 * turning * t[:, None] * t).transpose(2, 0, 1)
        return (kernel + self.walls.traction(x, normal, x)).reshape(2 * self.nodes, -1).T

    def forces(self, x, derivatives=False):
        """On the fluid, per rest length; or their derivatives by x."""
        d, n, power = self.derivative, self.nodes, 3 if self.present else 2
        tangent, e, t = self.geometry(x)
        second, inward = tangent @ d.T, np.stack([-t[1], t[0]])
        curvature = cross(tangent, second) / e**power
        shear = d @ (self.bending * (curvature - 1)) / e
        tension = self.modulus * (e**1.5 - e**-1.5)
        if not derivatives:
            return ((tension * t - shear * inward) @ d.T).ravel()
        by_tangent = np.stack([second[1], -second[0]]) / e**power - power * curvature * t / e  # of the curvature
        by_second = inward / e ** (power - 1)
        of_curvature = by_tangent[:, :, None] * d + by_second[:, :, None] * (d @ d)  # [component, node, other node]
        of_shear = self.bending * d @ of_curvature / e[:, None]
        stiffness, along = 1.5 * self.modulus * (e**0.5 + e**-2.5), t[:, None] * t
        turn = np.array([[0, -1], [1, 0]])[:, :, None]
        local = stiffness * along + tension / e * (np.eye(2)[:, :, None] - along) - shear / e * (turn - 2 * inward[:, None] * t)
        whole = local[:, :, :, None] * d - inward[:, None, :, None] * of_shear  # [component, by component, node, by node]
        return (d @ whole).transpose(0, 2, 1, 3).reshape(2 * n, 2 * n)

    def step(self, before, x, ratio, step):
        """The shape after a step `ratio` times as long as that from `before` to x; ratio 0 for the first step."""
        shape, size = x.shape, step * (1 + ratio) / (1 + 2 * ratio)
        new = (1 + ratio) * x - ratio * before
        flow, mobility = self.motion(new)
        known = (((1 + ratio) ** 2 * x - ratio**2 * before) / (1 + 2 * ratio)).ravel() + size * flow
        inverse = np.linalg.inv(np.eye(2 * self.nodes) - size * mobility @ self.forces(new, True))
        for _ in range(50):
            change = inverse @ (known + size * mobility @ self.forces(new) - new.ravel())
            new = new + change.reshape(shape)
            if np.abs(change).max() < 1e-11:
                return new
        raise ArithmeticError("Newton's method finds no new shape")

    def row(self, strain, x):
        """As in COLUMNS."""
        tangent, weight = x @ self.derivative.T, self.weight
        area = weight * cross(x, tangent).sum() / 2
        centre = weight * np.array([x[0] ** 2 @ tangent[1], -x[1] ** 2 @ tangent[0]]) / (2 * area)
        a, b = x - centre[:, None]
        xx, xy, yy = weight * np.array([a**3 @ tangent[1] / 3, a**2 * b @ tangent[1] / 2, -b**3 @ tangent[0] / 3])
        mean, half = (xx + yy) / 2, np.hypot((xx - yy) / 2, xy)
        large, small = np.sqrt(mean + half), np.sqrt(mean - half)
        angle = np.degrees(np.arctan2(2 * xy, xx - yy)) / 2 if half > 1e-12 else None
        forces, (flow, mobility) = self.forces(x), self.motion(x)
        u = (flow + mobility @ forces).reshape(2, -1)
        stresslet = weight * (-x[1] @ forces[: self.nodes] + (self.ratio - 1) * (u[1] @ tangent[1] - u[0] @ tangent[0]))
        viscosity = 1 + stresslet / (PERIOD * self.walls.height)
        return [strain, centre[1], (large - small) / (large + small), angle, viscosity, area / np.pi]

    def history(self, place, strain, step):
        x = np.stack([np.cos(self.angle), place * self.walls.height + np.sin(self.angle)])
        each = round(OUTPUT / step)
        times = [OUTPUT * (i / (2 * each)) ** 2 for i in range(2 * each)]  # the last of these steps is as long as those that follow
        times += [OUTPUT + step * i for i in range(round((strain - OUTPUT) / step) + 1)]
        rows, before, last = [self.row(0.0, x)], x, 0
        for i in range(1, len(times)):
            size = times[i] - times[i - 1]
            ratio = size / last if last else 0
            before, x, last = x, self.step(before, x, ratio, size), size
            if i % each == 0 and i > each:
                rows.append(self.row(OUTPUT * (i // each - 1), x))
        return rows


def compute(job):
    case, options = job
    capsule = Capsule(case["height"], case["capillary"], case["ratio"], options.nodes, options.moment)
    return capsule.history(case["place"], case["strain"], options.step)


def verify():
    """Nothing flows at the walls; rigid motion has no stress; derivatives of forces are those of the forces."""
    place, pole = np.array([[0.3, -2.0], [0.0, 6.4]]), np.array([[0.1, 0.5], [1.2, 4.0]])
    y, square, ax, ay, *_ = periodic(place, pole)
    log = np.log(square) / 2
    at_walls = pairs(-log - y * ay, y * ax, y * ax, y * ay - log) + Walls(6.4).velocity(place, pole)
    assert np.abs(at_walls).max() < 1e-12, at_walls
    capsule = Capsule(6.4, 0.1, 5, 96, "rest")
    x = np.stack([1.2 * np.cos(capsule.angle), 1.4 + 0.8 * np.sin(capsule.angle)])
    one, none = np.ones(96), np.zeros(96)
    for u in (np.concatenate(parts) for parts in ((one, none), (none, one), (x[1], -x[0]))):
        assert np.abs(capsule.double_layer(x) @ u + 2 * np.pi * u).max() < 1e-9
    change = 1e-5 * np.stack([np.sin(2 * capsule.angle), np.cos(3 * capsule.angle)])
    for capsule.present in (False, True):
        slope = (capsule.forces(x + change) - capsule.forces(x - change)) / 2
        assert np.abs(slope - capsule.forces(x, True) @ change.ravel()).max() < 1e-6 * np.abs(slope).max()


def check(pool, options):
    """Largest differences from the histories in capsule_channel.json."""
    given, options.moment = json.loads((FOLDER / "capsule_channel.json").read_text()), "present"
    cases = [{"height": 6.4, "place": 0.5, "capillary": one["parameters"]["Ca"], "ratio": one["parameters"]["lam"],
              "strain": one["values"][-1][0]} for one in given]
    for one, case, rows in zip(given, cases, pool.imap(compute, [(case, options) for case in cases])):
        both = [(theirs, rows[round(theirs[0] / OUTPUT)]) for theirs in one["values"]]
        share = np.pi / (PERIOD * case["height"])
        off = [max(abs(ours[2] - theirs[1]) for theirs, ours in both), max(abs(ours[3] - theirs[2]) for theirs, ours in both[1:]),
               max(abs((ours[4] - 1) / share - theirs[5]) for theirs, ours in both), max(abs(row[5] - 1) for row in rows)]
        print("Ca {capillary}, ratio {ratio}, up to strain {strain}: ".format(**case)
              + "deformation {:.1e}, angle {:.1e} deg, intrinsic viscosity {:.1e}, area {:.1e}".format(*off), flush=True)
        assert off[0] < 1e-4 and off[1] < 0.02 and off[2] < 1e-3 and off[3] < 1e-5, off


def make_table(pool, options):
    """Written anew after each case."""
    cases, texts = json.loads(pathlib.Path(options.cases).read_text()), []
    head = {"what": WHAT, "made_by": f"tests/reference/capsule_in_channel.py --cases FILE --nodes {options.nodes} --step {options.step:g}",
            "uncertainty": UNCERTAINTY, "columns": COLUMNS}
    for case, rows in zip(cases, pool.imap(compute, [(case, options) for case in cases])):
        lines = [json.dumps([value if value is None else round(value, 6) for value in row]) for row in rows]
        name = json.dumps({key: case[key] for key in ("height", "place", "capillary", "ratio")})
        texts.append(f'  {name[:-1]}, "rows": [\n    ' + ",\n    ".join(lines) + "]}")
        text = json.dumps(head, indent=2)[:-2] + ',\n  "cases": [\n' + ",\n".join(texts) + "\n  ]\n}\n"
        pathlib.Path(options.out).write_text(text)
        print(f"{name} to strain {case['strain']}: area changes by {max(abs(row[5] - 1) for row in rows):.1e}", flush=True)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    for name, value in (("height", 6.4), ("place", 0.5), ("capillary", 0.05), ("ratio", 1.0), ("strain", 8.0), ("step", 0.01)):
        parser.add_argument("--" + name, type=float, default=value)
    parser.add_argument("--nodes", type=int, default=64, help="even")
    parser.add_argument("--moment", default="rest", choices=["rest", "present"])
    parser.add_argument("--cases", metavar="FILE")
    parser.add_argument("--out", metavar="FILE", default=FOLDER / "capsules_in_channels.json")
    parser.add_argument("--processes", type=int, default=1)
    parser.add_argument("--check", action="store_true")
    options = parser.parse_args()
    verify()
    if not (options.check or options.cases):
        for row in compute((vars(options), options)):
            print("%.2f %.6f %.6f %9s %.6f %.8f" % (*row[:3], "-" if row[3] is None else "%.4f" % row[3], *row[4:]))
        return
    with multiprocessing.Pool(options.processes) as pool:
        (check if options.check else make_table)(pool, options)


if __name__ == "__main__":
    main()
