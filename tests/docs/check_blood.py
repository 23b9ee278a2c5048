"""The logic of scripts/blood: Pries' laws, where cells of narrow tubes begin, and that what it would run can be run.

usage: check_blood.py SOURCE BUILD
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

sys.dont_write_bytecode = True
SOURCE, BUILD = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
missing = [name for name in ("matplotlib", "pandas") if importlib.util.find_spec(name) is None]
if missing:
    print(f"{', '.join(missing)} missing: scripts/install-dependencies --full")
    sys.exit(77)

loader = importlib.machinery.SourceFileLoader("blood", str(SOURCE / "scripts/blood"))
blood = importlib.util.module_from_spec(importlib.util.spec_from_loader("blood", loader))
loader.exec_module(blood)
LAW = json.loads((SOURCE / "tests/reference/experiments/tubes-pries.json").read_text())["law"]


def by_the_reference(diameter, hematocrit):
    """Both quantities, from the text of the reference's formulas."""
    known = {"exp": math.exp, "D": diameter, "H": hematocrit}

    def value(text):
        python = re.sub(r"(?<=\)) ?(?=\()", " * ", text.replace("^", "**"))
        python = re.sub(r"\b(\d[\d.e-]*) (?=exp|D\b)", r"\1 * ", python)
        return eval(python, {"__builtins__": {}}, known)  # formulas of a file of ours

    c, k = LAW["C"].split(", k = ")
    known["k"] = value(k)
    known["C"] = value(c)
    known["m45"] = value(LAW["m45"])
    return value(LAW["mu_rel"]), value(LAW["H_T_over_H_D"])


class Blood(unittest.TestCase):
    def test_pries_laws_are_those_of_the_reference(self):
        for diameter in (5, 8, 12.5, 20, 40):
            for hematocrit in (0.15, 0.3, 0.45, 0.6):
                viscosity, ratio = by_the_reference(diameter, hematocrit)
                self.assertAlmostEqual(blood.relative_viscosity(diameter, hematocrit), viscosity, delta=1e-12)
                self.assertAlmostEqual(blood.tube_over_discharge(diameter, hematocrit), ratio, delta=1e-12)

    def test_pries_laws_give_the_numbers_that_others_tabulate(self):
        for diameter, hematocrit, viscosity, ratio in ((8, 0.45, 1.267, 0.732), (8, 0.15, 1.073, 0.585), (20, 0.45, 1.588, 0.735),
                                                       (20, 0.15, 1.126, 0.591), (40, 0.45, 1.923, 0.787)):
            self.assertAlmostEqual(blood.relative_viscosity(diameter, hematocrit), viscosity, delta=6e-4)
            self.assertAlmostEqual(blood.tube_over_discharge(diameter, hematocrit), ratio, delta=6e-4)

    def test_cells_in_a_row_keep_apart_and_are_the_same_again(self):
        for count in blood.NARROW:
            cells = blood.in_a_row(count, 42.4, 1)
            self.assertEqual(cells, blood.in_a_row(count, 42.4, 1))
            self.assertNotEqual(cells, blood.in_a_row(count, 42.4, 2))
            x = [float(cell["at"][0].split()[0]) for cell in cells[0]["list"]]
            self.assertEqual(len(x), count)
            gaps = [right - left for left, right in zip(x, [*x[1:], x[0] + 42.4])]
            self.assertGreater(min(gaps), 4.5)

    def test_every_scene_is_planned_and_every_change_has_its_place(self):
        for part, runs in blood.PARTS.items():
            for label, (scene, changes) in runs().items():
                content = json.loads((SOURCE / f"scenes/blood/{scene}.json").read_text())
                for pointer in changes.keys() - blood.LEAK.keys():
                    *way, last = pointer.split("/")[1:]
                    place = content
                    for key in way:
                        place = place[int(key) if isinstance(place, list) else key]
                    self.assertIn(int(last) if isinstance(place, list) else last,
                                  range(len(place)) if isinstance(place, list) else place, f"{part} {label}: {pointer}")
        for path in sorted((SOURCE / "scenes/blood").glob("*.json")):
            planned = subprocess.run([BUILD / "bin/rouleau", "plan", path, "--json"], capture_output=True, text=True, timeout=60)
            self.assertEqual(planned.returncode, 0, f"{path}: {planned.stderr}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
