"""examples/read_run.py on a short real run; skipped (exit code 77) where h5py, pandas or matplotlib is not installed.

usage: check_example.py SOURCE BUILD
"""

import pathlib
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
PYTHON = next((python for python in (sys.executable, "/usr/bin/python3") if subprocess.run(
    [python, "-c", "import h5py, numpy, pandas, matplotlib"], capture_output=True).returncode == 0), None)
if PYTHON is None:
    print("h5py, pandas or matplotlib is not installed: scripts/install-dependencies --full")
    sys.exit(77)
COLOURS = """
import matplotlib.image, numpy, sys
picture = matplotlib.image.imread(sys.argv[1])[:, :, :3]
coloured = (picture.max(axis=2) - picture.min(axis=2) > 0.1).sum()
print(*picture.shape[:2], coloured)
"""


class The_example(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rouleau-example-")
        self.addCleanup(folder.cleanup)
        self.run_folder = pathlib.Path(folder.name) / "run"

    def call(self, *command):
        result = subprocess.run(command, cwd=SOURCE, capture_output=True, text=True, timeout=200)
        self.assertEqual(result.returncode, 0, result.stderr)
        return result.stdout

    def simulate(self, *settings):
        self.call(BUILD / "bin/rouleau", "run", "scenes/four-cells-shear.json", "--out", self.run_folder, "--quiet",
                  "--set", '/stages=[{"name":"shear","shear_rate":"20 1/s","strain":1}]', "--set", "/numerics/density_factor=9000",
                  *settings)

    def test_draws_two_pictures_of_a_run(self):
        self.simulate()
        said = self.call(PYTHON, "examples/read_run.py", self.run_folder, "--strains", "0", "0.5", "1").split()
        self.assertEqual([pathlib.Path(name).name for name in said], ["outlines.png", "gaps-and-deformation.png"])
        for name in said:
            height, width, coloured = map(int, self.call(PYTHON, "-c", COLOURS, name).split())
            self.assertGreater(min(height, width), 500)
            self.assertGreater(coloured, 1000)  # lines are there: an empty pair of axes is grey
            self.assertFalse(coloured > height * width / 3)

    def test_says_so_when_a_run_has_no_cells(self):
        self.simulate("--set", "/cells=[]")
        result = subprocess.run([PYTHON, "examples/read_run.py", self.run_folder], cwd=SOURCE, capture_output=True, text=True)
        self.assertNotEqual(result.returncode, 0)
        self.assertIn("has no membranes", result.stderr)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
