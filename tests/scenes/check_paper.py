"""The scenes of scenes/paper are complete and can be planned, and scripts/paper measures what it says.

usage: check_paper.py PROGRAM ROOT
"""
import importlib.machinery
import importlib.util
import json
import math
import pathlib
import re
import subprocess
import sys
import unittest

import numpy

PROGRAM, ROOT = sys.argv[1], pathlib.Path(sys.argv[2])
sys.dont_write_bytecode = True  # scripts/ holds no compiled copies
loader = importlib.machinery.SourceFileLoader("paper", str(ROOT / "scripts/paper"))
paper = importlib.util.module_from_spec(importlib.util.spec_from_loader("paper", loader))
loader.exec_module(paper)


def outline(shape, turn):
    """100 points shape(angle) -> (x, y), turned counter-clockwise, as an array [100, 2]."""
    points = [shape(2 * math.pi * i / 100) for i in range(100)]
    c, s = math.cos(turn), math.sin(turn)
    return numpy.array([(3 + c * x - s * y, 7 + s * x + c * y) for x, y in points])


def biconcave(angle):
    """Radius 1, long axis along y."""
    y, side = math.sin(angle), math.copysign(1, math.cos(angle))
    return side * 0.5 * math.sqrt(max(0, 1 - y * y)) * (0.207 + 2.002 * y**2 - 1.122 * y**4), y


# Wells in which four cells at rest have no minimum with their own faces apart, and one that compresses the fluid: true, and
# the paper's scenes keep them.
STRONG = {**{f"fig{name}.json": ["depth"] for name in ("1-6e-7", "1-1.3e-6", "4-creeping", "4-inertia", "6-creeping", "6-inertia")},
          "fig1-3e-6.json": ["depth", "compression"]}


class Paper(unittest.TestCase):
    def test_every_scene_is_planned_and_says_what_the_paper_says_and_what_is_expected(self):
        files = sorted((ROOT / "scenes/paper").glob("*.json"))
        self.assertEqual(len(files), 16)
        for file in files:
            with self.subTest(file.name):
                result = subprocess.run([PROGRAM, "plan", file], capture_output=True, text=True)
                self.assertEqual(result.returncode, 0, result.stderr)
                warnings = re.findall(r"warning: (\w+)", result.stdout)
                self.assertEqual(warnings, STRONG.get(file.name, []), result.stdout)
                expected = json.loads(file.read_text())["expected"]
                self.assertTrue(expected["paper"])
                self.assertTrue("end_faces" in expected or 1 <= expected["aggregates_final"] <= 4)

    def test_contacts_are_joined_to_parts(self):
        self.assertEqual(paper.parts([]), "0 1 2 3")
        self.assertEqual(paper.parts([(2, 1)]), "0 1+2 3")
        self.assertEqual(paper.parts([(0, 1), (2, 3)]), "0+1 2+3")
        self.assertEqual(paper.parts([(3, 2), (0, 1), (1, 2)]), "0+1+2+3")

    def test_the_face_of_a_circle_bows_by_its_arc_and_that_of_a_biconcave_cell_is_a_dimple(self):
        at_half = 0.5 * math.sqrt(0.75) * (0.207 + 2.002 * 0.25 - 1.122 * 0.0625)
        for turn in (0.0, 1.0, 2.5):
            for way in (1, -1):
                axis = [way * math.cos(turn), way * math.sin(turn)]
                circle = paper.bow(outline(lambda a: (math.cos(a), math.sin(a)), turn), axis)
                self.assertAlmostEqual(circle, 1 - math.sqrt(0.75), delta=2e-3)  # polygon of 100 sides
                cell = paper.bow(outline(biconcave, turn), axis)
                self.assertAlmostEqual(cell, 0.5 * 0.207 - at_half, delta=2e-3)

    def test_perturbed_rows_are_small_displacements_and_repeat(self):
        self.assertEqual(paper.perturbed_cells(1), paper.perturbed_cells(1))
        self.assertNotEqual(paper.perturbed_cells(1), paper.perturbed_cells(2))
        for cell in paper.perturbed_cells(3):
            self.assertLess(abs(float(cell["at"][1].split()[0]) - 12.544), 0.0501)
            self.assertLess(abs(float(cell["angle"].split()[0]) - 90), 1.001)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
