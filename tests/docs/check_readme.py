"""README.md says what is so: its version, what works in two dimensions and in three, its times and its measured numbers
are compared with the program, its scenes and the pages of results that it links to.

usage: check_readme.py SOURCE BUILD
"""

import json
import os
import pathlib
import re
import subprocess
import sys
import unittest

sys.dont_write_bytecode = True
SOURCE, BUILD = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
PROGRAM = BUILD / "bin/rouleau"
README = (SOURCE / "README.md").read_text()

FLAT, SPACE = "scenes/four-cells-shear.json", "scenes/doublet-3d.json"
LAW = {"2D": "/cell_types/rbc/membrane/0", "3D": "/cell_types/rbc/membrane/0"}
VISCOUS = {"model": "viscous", "parameters": {"viscosity": "1e-7 N s/m"}}
SOLID = {"model": "standard-linear-solid", "parameters": {"modulus": "5e-6 N/m", "relaxation_time": "0.1 s"}}
BONDS = {"between": ["rbc", "rbc"], "model": "bridging",
         "parameters": {"site_density": "1e14 1/m2", "bond_stiffness": "1e-7 N/m", "zero_force_distance": "0.49 um",
                        "on_rate": "10 1/s", "off_rate": "1 1/s", "cutoff": "1.5 um"}}
DEPLETION = json.loads((SOURCE / "scenes/dextran-70.json").read_text())["interactions"][0]
DOMAIN = {"2D": {"size": ["60 um", "20 um"], "nodes": [120, 40], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
          "3D": {"size": ["40 um", "12 um", "12 um"], "nodes": [80, 24, 24], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}},
                 "z": {"lower": {"wall": {}}, "upper": {"wall": {}}}}}
OPEN = {"lower": {"inlet": {"mean_velocity": "1 mm/s", "cells": {"type": "rbc", "hematocrit": 0.1}}},
        "upper": {"outlet": {"pressure": "0 Pa"}}}


def scene(dimension):
    return FLAT if dimension == "2D" else SPACE


def attraction(dimension):
    return [(scene(dimension), {}), *[(scene(dimension), {"/interactions/0": law}) for law in (DEPLETION, BONDS)]]


def opened(dimension):
    return [(scene(dimension), {"/domain": {**DOMAIN[dimension], "x": OPEN}, "/cells": [], "/output": {"cells": {"seconds": "1 ms"}},
                                "/stages": [{"name": "flow", "duration": "1 ms"}]})]


# How the README names what works: what `rouleau plan` must accept where it says yes, and refuse where it says no.
WORKS = {
    "attraction between cells": attraction,
    "elastic membranes": lambda d: [(scene(d), {})],
    "viscous membranes": lambda d: [(scene(d), {LAW[d].replace("/0", "/-"): VISCOUS})],
    "membranes that remember": lambda d: [(scene(d), {LAW[d].replace("/0", "/-"): SOLID})],
    "walls": lambda d: [("scenes/capillary-network.json", {})] if d == "2D" else [("scenes/tube-3d.json", {}), ("scenes/slit-3d.json", {})],
    "flow through an inlet": opened,
    "the program chooses": lambda d: [(scene(d), {"/numerics": {"auto": {"error": 0.1}}})],
    "several processes": lambda d: [(scene(d), {"--ranks": "2"})],
}
# What no option, model or key of the program offers: words that its help and its schema would have.
ABSENT = {"graphics processors": r"\b(gpu|cuda|hip|sycl|graphics)\b", "thermal fluctuations": r"\b(thermal|temperature)\b"}


def plan(path, changes):
    words = [PROGRAM, "plan", path]
    for pointer, value in changes.items():
        words += [pointer, value] if pointer.startswith("--") else ["--set", f"{pointer}={json.dumps(value)}"]
    return subprocess.run(words, cwd=SOURCE, capture_output=True, text=True, timeout=120)


class Readme(unittest.TestCase):
    def test_what_works_is_what_plan_accepts(self):
        table = re.search(r"^\| \| 2D \| 3D \|\n\|---\|---\|---\|\n((?:\|.*\n)+)", README, re.MULTILINE)[1]
        rows = [[cell.strip() for cell in row.strip("|").split("|")] for row in table.splitlines()]
        self.assertEqual(len(rows), len(WORKS) + len(ABSENT))
        for what, *answers in rows:
            found = [name for name in (*WORKS, *ABSENT) if what.startswith(name)]
            self.assertEqual(len(found), 1, f"{what}: no line of WORKS or ABSENT says how that is tested")
            if found[0] in ABSENT:
                self.assertEqual(answers, ["no", "no"], what)
                offered = (SOURCE / "host/scene/scene.schema.json").read_text()
                offered += subprocess.run([PROGRAM, "run", "--help"], capture_output=True, text=True).stdout
                self.assertIsNone(re.search(ABSENT[found[0]], offered, re.IGNORECASE), what)
                continue
            for dimension, answer in zip(("2D", "3D"), answers):
                for path, changes in WORKS[found[0]](dimension):
                    with self.subTest(what=what, dimension=dimension, changes=changes):
                        result = plan(path, changes)
                        self.assertEqual(result.returncode, {"yes": 0, "no": 2}[answer], result.stdout[-500:] + result.stderr)
                        if answer == "no":
                            self.assertIn("does not work in three dimensions", result.stderr)

    def test_its_version_is_the_programs_and_that_of_the_citation(self):
        said = re.search(r"^Version (\d+\.\d+),", README, re.MULTILINE)[1]
        printed = subprocess.run([PROGRAM, "--version"], capture_output=True, text=True).stdout
        self.assertRegex(printed, rf"\b{re.escape(said)}\.\d+")
        self.assertRegex((SOURCE / "CITATION.cff").read_text(), rf"(?m)^version: {re.escape(said)}\.\d+$")

    def test_the_demo_takes_as_long_as_plan_expects(self):
        low, high = map(float, re.search(r"runs them in (\d+) to (\d+) s", README).groups())
        expected = float(re.search(r"about ([\d.]+) s on one core", plan(FLAT, {}).stdout)[1])
        self.assertLess(expected, 1.5 * high)
        self.assertGreater(expected, low / 2)
        measured = re.search(r"first build of the demo.*\| (\d+) s \(", (SOURCE / "docs/results/build-2026-11.md").read_text())[1]
        self.assertAlmostEqual(float(re.search(r"once in (\d+) CPU seconds", README)[1]) / float(measured), 1, delta=0.1)

    def test_diameters_within_the_error_bars_are_counted(self):
        rows = re.findall(r"^\| [\d.]+ \| [\d.]+ \(([\d.]+) to ([\d.]+)\) \| \**([\d.]+)\** \| [\d.]+ \(([\d.]+) to ([\d.]+)\) \| \**([\d.]+)\** \|$",
                          (SOURCE / "docs/results/tweezers-2026-11.md").read_text(), re.MULTILINE)
        values = [tuple(map(float, row[k:k + 3])) for row in rows for k in (0, 3)]
        within = sum(low <= found <= high for low, high, found in values)
        self.assertIn(f"{within} of {len(values)} diameters within the error bars", " ".join(README.split()))

    def test_the_error_of_a_capsule_is_that_of_the_table(self):
        table = (SOURCE / "docs/results/slip-3d-2026-11.md").read_text()
        heads, row = (re.search(rf"^\| {name} \|.*$", table, re.MULTILINE)[0].strip("|").split("|")
                      for name in ("plain / corrected / corrected and `sharp6`", "D, Ca 0.15, strain 3.1"))
        place = next(k for k, head in enumerate(heads) if head.strip() == "6")
        error = float(row[place].split("/")[-1]) / float(row[-1]) - 1
        self.assertIn(f"within {100 * error:.1f} % of a boundary integral at 6 lattice spacings a radius", " ".join(README.split()))

    def test_points_of_experiments_are_counted(self):
        table = (SOURCE / "docs/results/experiments.md").read_text()
        rows = re.findall(r"^\| ([a-z-]+) \|.*\| (inside|\*\*outside\*\*) \|$", table, re.MULTILINE)
        inside = sum(verdict == "inside" for _, verdict in rows)
        self.assertIn(f"meets {inside} of {len(rows)} points of [eight experiments]", " ".join(README.split()))
        self.assertEqual(len({name for name, _ in rows}), 8)

    def test_the_tests_take_as_long_as_was_measured(self):
        minutes = {"half an hour": 30, "three quarters of an hour": 45, "an hour": 60}
        said = minutes[re.search(r"runs the tests: about (.*?) on two cores", " ".join(README.split()))[1]]
        log = " ".join((SOURCE / "docs/results/build-2026-11.md").read_text().split())
        build, tests = (float(re.search(pattern, log)[1].replace(" ", "")) for pattern in
                        (r"release \(930 jobs, ([\d ]+) s of the clock", r"runs its tests \(.*?([\d ]+) s\b"))
        self.assertAlmostEqual((build + tests) / 60 / said, 1, delta=0.4)

    def test_films_move_and_the_first_picture_is_one(self):
        first = re.search(r"!\[[^\]]*\]\(([^)]*)\)", README)[1]
        self.assertIn(b"ANIM", (SOURCE / first).read_bytes()[:100])  # a WebP that moves
        self.assertIn("in-space", first)

    def test_every_command_is_there(self):
        for block in re.findall(r"\n\n((?:    .*\n)+)", README):
            for line in block.split("\n"):
                if line.strip():
                    self.assertTrue(os.access(SOURCE / line.split()[0], os.X_OK), line)

    def test_pictures_and_scenes_are_there_and_short_lines_fit(self):
        for path in re.findall(r"\]\(((?:docs/pictures|scenes)/[^)]*)\)", README):
            self.assertTrue((SOURCE / path).is_file(), path)
            self.assertLess(os.path.getsize(SOURCE / path), 1_000_000, path)
        self.assertLess(len(README.split()), 700)  # it is a door, and pages are the house


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
