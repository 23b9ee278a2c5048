"""The logic of scripts/experiments: what is measured in runs, its scenes and changes, and the table that numbers are taken into.

usage: check_experiments.py SOURCE BUILD
"""

import importlib.machinery
import importlib.util
import json
import math
import pathlib
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SOURCE, BUILD = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
missing = [name for name in ("matplotlib", "pandas", "scipy") if importlib.util.find_spec(name) is None]
if missing:
    print(f"{', '.join(missing)} missing: scripts/install-dependencies --full")
    sys.exit(77)

import numpy  # noqa: E402

loader = importlib.machinery.SourceFileLoader("experiments", str(SOURCE / "scripts/experiments"))
experiments = importlib.util.module_from_spec(importlib.util.spec_from_loader("experiments", loader))
loader.exec_module(experiments)
import sensitivity_table  # noqa: E402  the script knows its folder

PAGE = """# A page

## Sensitivities

Words before.

| | relaxation: time, s | inclination: angle |
|---|---|---|
| as it is | 0.1 | 7 +- 1 |
| shear modulus | -10.0 % | +1.9 % |
| volume | - | -0.2 % |

Words after.
"""


def has_its_place(name, pointer):
    """Whether the experiment's scene has what is changed there; what a cell type has of the shipped cell stands only there."""
    place = json.loads((SOURCE / f"scenes/experiments/{name}.json").read_text())
    *way, last = pointer.split("/")[1:]
    for key in way:
        place = place[int(key) if isinstance(place, list) else key]
    return pointer.startswith("/cell_types/rbc/") or (int(last) < len(place) if isinstance(place, list) else last in place)


class Experiments(unittest.TestCase):
    def test_a_relaxation_time_is_found_again(self):
        t = numpy.linspace(0, 0.41, 60)
        big = (2.1 + 1.05) / (2.1 - 1.05)
        ratio = 1.05 * (big + numpy.exp(-t / 0.13)) / (big - numpy.exp(-t / 0.13))
        self.assertAlmostEqual(experiments.relaxation_time(t, ratio)[0], 0.13, delta=1e-6)

    def test_every_change_has_its_place(self):
        for name, (runs, _) in experiments.EXPERIMENTS.items():
            for label, changes in runs().items():
                for pointer in changes:
                    self.assertTrue(has_its_place(name, pointer), f"{name} {label}: {pointer}")

    def test_a_parameter_is_a_fifth_larger_and_no_other(self):
        laws = experiments.parameters("relaxation")["membrane viscosity"]["/cell_types/rbc/membrane"]
        before = experiments.preset()["membrane"]
        differ = [(i, key) for i, law in enumerate(laws) for key in law["parameters"] if law["parameters"][key] != before[i]["parameters"][key]]
        self.assertEqual(differ, [(experiments.VISCOUS, "viscosity")])
        self.assertEqual(laws[experiments.VISCOUS]["parameters"]["viscosity"], "5.04e-07 N s/m")

    def test_all_that_would_be_run_for_sensitivities_can_be_planned(self):
        for name, (coarse, _) in experiments.LATTICES.items():
            for label, changes in {"as it is": {}, **experiments.parameters(name)}.items():
                changed = {**experiments.sensitive()[name][0], "/domain/nodes": coarse, **changes}
                words = [word for pointer, value in changed.items() for word in ("--set", f"{pointer}={json.dumps(value)}")]
                planned = subprocess.run([BUILD / "bin/rouleau", "plan", SOURCE / f"scenes/experiments/{name}.json", "--json", *words],
                                         capture_output=True, text=True, timeout=60)
                self.assertEqual(planned.returncode, 0, f"{name}, {label}: {planned.stderr}")


class Table(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.page = pathlib.Path(self.folder.name) / "page"
        self.page.write_text(PAGE)

    def test_a_number_comes_to_its_place_and_all_others_stay(self):
        sensitivity_table.add(self.page, "volume", {"relaxation: time, s": ((0.1, math.nan), 0.12)})
        self.assertEqual(self.page.read_text(), PAGE.replace("| volume | - |", "| volume | +20.0 % |"))

    def test_new_parameters_and_quantities_get_a_line_and_a_column(self):
        sensitivity_table.add(self.page, "area", {"tumbling: turn": ((20, 0.5), None)})
        lines = self.page.read_text().split("\n")
        self.assertIn("| | relaxation: time, s | inclination: angle | tumbling: turn |", lines)
        self.assertIn("| as it is | 0.1 | 7 +- 1 | 20 +- 0.5 |", lines)
        self.assertIn("| shear modulus | -10.0 % | +1.9 % | - |", lines)
        self.assertIn("| area | - | - | failed |", lines)
        self.assertEqual(lines[-2], "Words after.")

    def test_a_column_of_another_cell_begins_anew(self):
        sensitivity_table.add(self.page, "volume", {"relaxation: time, s": ((0.12, math.nan), 0.12)})
        self.assertEqual(self.page.read_text(), PAGE.replace("| 0.1 |", "| 0.12 |").replace("-10.0 %", "-").replace("| volume | - |", "| volume | +0.0 % |"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
