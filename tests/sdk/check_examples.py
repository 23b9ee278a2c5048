"""The examples and templates of the SDK, built against an installed SDK, run in scenes: an example gives what the shipped
plugin of the same formula gives.

usage: check_examples.py SOURCE BUILD CMAKE
"""

import json
import shlex
import shutil
import unittest

from staged import COMPONENTS, Case, main

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
        # Each force differs by some 1e-16 of itself and moves a node by far less than a spacing, so that nodes differ by
        # their own rounding at most, 1e-14 a step: 1e-12 in 200 steps. All that the potential does is above 1e-3 (last
        # line), so that a force wrong by 1e-9 of itself would show.
        self.assertLess(difference(ours, theirs), 1e-12)
        self.assertGreater(difference(ours, without), 1e-3)
        self.check_conformance(build)

    def test_morse_in_plain_c_gives_the_cells_of_the_shipped_morse(self):
        self.check("morse-in-c", "morse")
        # With this seed energies at the cutoff are the least numbers above zero, whose differences have no digits.
        self.call(self.path / "rouleau/bin/rouleau", "conform", self.path / "build-morse-in-c/morse-in-c.json",
                  "--only", "gradient", "--seed", "259321176")

    def test_a_law_made_of_its_energy_alone_is_a_spring_near_rest(self):
        """Twice as stiff springs strain half as much, and conformance finds tension and stiffness in order."""
        prefix = self.install(self.path / "rouleau", "sdk", "program", "plugins")
        build = self.build(prefix / "share/rouleau/sdk/examples/logarithmic-spring", prefix)
        self.check_conformance(build)

        def strain(modulus):
            law = {"model": "org.example.logarithmic-spring", "parameters": {"stretching_modulus": f"{modulus} N/m"}}
            out = self.path / str(modulus)
            rows = self.cells(prefix / "bin/rouleau", out, "--plugin-dir", build, *STEPS, "--set",
                              "/cell_types/rbc/membrane/0=" + json.dumps(law))
            self.assertIn(law["model"], self.plugin_of(out))
            return max(abs(row["perimeter_m"] / rows[0]["perimeter_m"] - 1) for row in rows)

        soft, stiff = strain(1e-5), strain(2e-5)
        self.assertGreater(soft, 1.2 * stiff)
        self.assertGreater(stiff, 0)

    @unittest.skipUnless(shutil.which("rustc"), "there is no rustc; scripts/install-dependencies --full installs it")
    def test_lennard_jones_in_rust_gives_the_cells_of_the_shipped_lennard_jones(self):
        self.check("lennard-jones-in-rust", "lennard-jones",
                   ["--set", '/interactions/0/parameters={"depth": "5.2e-8 J/m2"}'])


class Templates(Case):
    def test_each_works_by_the_commands_that_rouleau_new_prints(self):
        prefix = self.install(self.path / "rouleau", *COMPONENTS)
        self.environment["PATH"] = f"{prefix / 'bin'}:{self.environment['PATH']}"
        for kind, *options in (["collision"], ["membrane"], ["membrane", "--dimensions", "3"], ["interaction"]):
            with self.subTest(kind, options=options):
                name = f"my-{kind}" + "-3d" * bool(options)
                words = self.call(prefix / "bin/rouleau", "new", kind, f"org.example.{name}", *options)
                configure, build, test, run = (line for line in words.splitlines() if line.startswith("  "))
                self.call("sh", "-ec", f"{configure} && {build}")
                self.assertEqual(shlex.split(test)[:3], ["ctest", "--test-dir", f"{name}/build"])
                self.check_conformance(self.path / f"{name}/build")
                self.call("sh", "-ec", f"{run} --max-steps 20 --out runs/{name}")
                self.assertIn(f"org.example.{name}", self.plugin_of(self.path / "runs" / name))


if __name__ == "__main__":
    main()
