"""rouleau.potential: a formula becomes a plugin that conforms and computes what the shipped model computes.

Needs a compiler and CMake, as every build does.
"""


import os
import types
import unittest.mock

from package import SOURCE, Case, main, need

need("numpy", "pandas")

import numpy  # noqa: E402
import rouleau  # noqa: E402

MORSE = "De*(exp(2*b*(r0 - r)) - 2*exp(b*(r0 - r)))"
VALUES = {"De": "5.2e-8 J/m2", "b": "3.84 1/um", "r0": "0.49 um"}
SCENE = SOURCE / "scenes/four-cells-shear.json"


class A_formula(Case):
    def test_of_the_morse_potential_computes_what_the_shipped_model_computes(self):
        morse = rouleau.potential(MORSE, name="my-morse", folder=self.path, **VALUES)
        written = rouleau.run(SCENE, self.path / "written", max_steps=2523, progress=False, interactions=[morse.between("rbc", "rbc")])
        shipped = rouleau.run(SCENE, self.path / "shipped", max_steps=2523, progress=False)
        self.assertEqual([p.id for p in written.summary.plugins if p.kind == "interaction"], [morse.id])
        moved = (shipped.cells["x_m"].to_numpy()[-4:] - shipped.cells["x_m"].to_numpy()[:4])
        self.assertGreater(abs(moved).max(), 1e-9)  # they attract each other
        self.assertLess(abs(written.cells["x_m"] - shipped.cells["x_m"]).max(), 1e-9 * abs(moved).max())

        # Made once: the second time it is found, and no compiler is looked for.
        kept = {path: path.stat().st_mtime_ns for path in morse.directory.iterdir()}
        again = rouleau.potential(MORSE, name="my-morse", folder=self.path, **VALUES)
        self.assertEqual(again.id, morse.id)
        self.assertEqual({path: path.stat().st_mtime_ns for path in morse.directory.iterdir()}, kept)

        self.assertEqual(morse.energy(0.49e-6, b=3.84e6, r0=0.49e-6), -5.2e-8)
        r = numpy.array([0.3e-6, 0.6e-6, 1e-6])
        s = numpy.exp(3.84e6 * (0.49e-6 - r))
        numpy.testing.assert_allclose(morse.energy(r, b=3.84e6, r0=0.49e-6), 5.2e-8 * (s**2 - 2 * s), rtol=1e-12)

    def test_whose_constants_want_units_does_not_conform(self):
        error = self.assert_refused("units", rouleau.potential, "De*exp(-r)", folder=self.path, De="1e-7 J/m2")
        self.assertEqual(error.exit_code, 3)
        self.assertEqual(list(self.path.iterdir()), [])  # nothing half made is left

    def test_that_is_not_understood_is_refused_with_its_part(self):
        for formula, words in [("De*foo(r)", '"foo(r)" is not understood'), ("De*(", "was never closed"),
                               ("De*x/r", '"x" is no parameter'), ("De*2", "does not depend on the distance"),
                               ("De if r else De", "is not understood"), ("__import__('os')*r*De", "is not understood")]:
            with self.subTest(formula=formula):
                self.assert_refused(words, rouleau.potential, formula, folder=self.path, De="1e-7 J/m2")
        self.assert_refused('"k" does not occur', rouleau.potential, "k0*r", folder=self.path, k0="1 J/m3", k=1)
        self.assert_refused("upper and lower case", rouleau.potential, "a*A*r", folder=self.path, a=1, A=1)
        self.assert_refused('l is "about 1 um"', rouleau.potential, "r/l", folder=self.path, l="about 1 um")
        self.assert_refused("cannot be the name", rouleau.potential, "r*int", folder=self.path, int=1)

    def test_is_told_of_a_place_where_it_cannot_be_kept(self):
        error = self.assert_refused("cannot be kept", rouleau.potential, "De*r", folder="/proc/nowhere", De="1 J/m3")
        self.assertIn("folder=", error.remedy)
        self.assertEqual((error.file, error.exit_code), ("/proc/nowhere", 4))
        with unittest.mock.patch.dict(os.environ, XDG_CACHE_HOME="/proc/nowhere"):
            self.assert_refused("cannot be kept", rouleau.potential, "De*r", De="1 J/m3")
        with unittest.mock.patch.dict(os.environ), unittest.mock.patch("pathlib.Path.home", side_effect=RuntimeError("no home")):
            os.environ.pop("XDG_CACHE_HOME", None)
            self.assert_refused("no home", rouleau.potential, "De*r", De="1 J/m3")
        with unittest.mock.patch("os.statvfs", return_value=types.SimpleNamespace(f_flag=os.ST_NOEXEC)):
            self.assert_refused("noexec", rouleau.potential, "De*r", folder=self.path, De="1 J/m3")
        for value in (None, [1], float("nan"), b"1"):
            self.assert_refused("", rouleau.potential, "De*r", De=value, folder=self.path)


if __name__ == "__main__":
    main()
