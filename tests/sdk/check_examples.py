"""The examples of the SDK, built against an installed SDK, give what the shipped plugins of the same formula give.

usage: check_examples.py SOURCE BUILD CMAKE
"""

import shutil
import unittest

from staged import Case, main

# What the same formula, rounded otherwise, may differ by after the steps of STEPS: see check().
STEPS = ["--max-steps", "200", "--set", '/output={"cells": {"seconds": "1 ms"}}']


class Examples(Case):
    def check(self, name, model, parameters=""):
        """An example gives the cells that the shipped model gives, to rounding, and not by being left out."""
        prefix = self.install(self.path / "rouleau", "sdk", "program", "plugins")
        program = prefix / "bin" / "rouleau"
        build = self.build(prefix / "share/rouleau/sdk/examples" / name, prefix)
        listing = self.call("nm", "-D", "--defined-only", next(build.glob("*.so"))).split()
        self.assertEqual(listing[1:], ["T", "rouleau_open_v1"])
        swap = lambda word: f"/interactions/0/model={word}"
        mine, shipped, none = self.path / "mine", self.path / "shipped", self.path / "none"
        ours = self.cells(program, mine, "--plugin-dir", build, *STEPS, *parameters, "--set", swap(f"org.example.{name}"))
        theirs = self.cells(program, shipped, *STEPS, *parameters, "--set", swap(model))
        without = self.cells(program, none, *STEPS, "--set", "/interactions=[]")
        self.assertIn(f"org.example.{name}", self.plugin_of(mine))
        self.assertNotIn(model, self.plugin_of(mine))
        self.assertGreaterEqual(len(ours), 8)  # four cells, at the start and at the end at least
        self.assertEqual(len(ours), len(theirs))

        def difference(some, others):
            return max(abs(a[k] - b[k]) / max(abs(a[k]), abs(b[k]), 1e-300)
                       for a, b in zip(some, others) for k in ("x_m", "perimeter_m", "area_m2", "min_gap_m"))

        print(f"{name}: largest relative difference {difference(ours, theirs):.1e}; "
              f"without the potential {difference(ours, without):.1e}")
        # Each force differs by some 1e-16 of itself; 200 steps in which nothing grows leave less than 1e-12. The cells
        # would differ by far more if the potential did not act at all.
        self.assertLess(difference(ours, theirs), 1e-12)
        self.assertGreater(difference(ours, without), 1e-6)
        self.check_conformance(build, program)

    def test_morse_in_plain_c_gives_the_cells_of_the_shipped_morse(self):
        self.check("morse-in-c", "morse")

    @unittest.skipUnless(shutil.which("rustc"), "there is no rustc; scripts/install-dependencies --full installs it")
    def test_lennard_jones_in_rust_gives_the_cells_of_the_shipped_lennard_jones(self):
        self.check("lennard-jones-in-rust", "lennard-jones",
                   ["--set", '/interactions/0/parameters={"depth": "5.2e-8 J/m2"}'])


if __name__ == "__main__":
    main()
