"""What the tests beside this file share: the package of this build with the program under test, and a small scene.

Each is called as: check_WHAT.py SOURCE BUILD
"""

import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest
import warnings

sys.dont_write_bytecode = True
SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
sys.path.insert(0, str(BUILD / "python"))
os.environ["ROULEAU"] = str(BUILD / "bin/rouleau")
os.environ["MPLBACKEND"] = "Agg"  # no screen is needed
warnings.simplefilter("ignore", UserWarning)  # the small scene is coarse


def need(*modules):
    """Ends the test as skipped where one of these is not installed."""
    missing = [module for module in modules if importlib.util.find_spec(module) is None]
    if missing:
        print(f"{', '.join(missing)} missing: scripts/install-dependencies --full")
        sys.exit(77)


def small_scene(**changes):
    """Two cells on a coarse lattice: at rest for a while, then in shear to strain 2; a fifth of a second to run."""
    return {
        "rouleau": 1, "title": "small",
        "domain": {"size": ["24 um", "16 um"], "nodes": [48, 32], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
        "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
        "numerics": {"density_factor": 2000},
        "cell_types": {"rbc": {"shape": {"biconcave": {"radius": "3.91 um"}}, "segments": 40,
                               "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-3 dyn/cm"}},
                                            {"model": "bending", "parameters": {"modulus": "3.6e-12 dyn cm"}}]}},
        "cells": [{"type": "rbc", "at": ["1 um", "8 um"], "angle": "90 deg"},
                  {"type": "rbc", "at": ["5 um", "8 um"], "angle": "90 deg"}],
        "interactions": [{"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": "5.2e-8 J/m2"}}],
        "stages": [{"name": "rest", "duration": "0.05 s"},
                   {"name": "shear", "shear_rate": "20 1/s", "strain": 2, "start": "developed"}],
        "output": {"cells": {"strain": 0.25}, "fields": {"strain": 1, "quantities": ["velocity", "viscosity"]}},
        **changes,
    }


class Case(unittest.TestCase):
    """A test with a folder of its own, `path`."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rouleau-python-")
        self.addCleanup(folder.cleanup)
        self.path = pathlib.Path(folder.name).resolve()

    def assert_refused(self, words, call, *arguments, **options):
        """The Error that the call throws, whose text has these words."""
        import rouleau
        with self.assertRaises(rouleau.Error) as caught:
            call(*arguments, **options)
        self.assertIn(words, str(caught.exception))
        return caught.exception


def main():
    unittest.main(module="__main__", argv=sys.argv[:1], warnings="ignore")
