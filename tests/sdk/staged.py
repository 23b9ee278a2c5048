"""Installations of the build under test into folders of their own, and how the tests beside this file call programs."""

import importlib.util
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE, BUILD, CMAKE = Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3]
sys.path.insert(0, str(SOURCE / "python"))
sys.dont_write_bytecode = True

import rouleau  # noqa: E402

SCENE = SOURCE / "scenes" / "four-cells-shear.json"
COMPONENTS = ["sdk", "core", "program", "plugins", "scenes", "documentation"]
if (SOURCE / "python/CMakeLists.txt").exists():
    COMPONENTS.append("python")
TRANSPORTS = [f.stem.removeprefix("transport-") for f in (BUILD / "libexec/rouleau").glob("transport-*.so")]
COMPONENTS += TRANSPORTS


def files(folder):
    """All files below a folder, as paths from it."""
    return {str(f.relative_to(folder)) for f in Path(folder).rglob("*") if f.is_file()}


class Case(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name).resolve()
        # Nothing of the machine's own installations or settings may help or disturb.
        self.environment = {k: v for k, v in os.environ.items()
                            if not k.startswith(("ROULEAU_", "CMAKE_", "PKG_CONFIG"))}

    def call(self, *words, expect=0, **options):
        """Runs a program; its output, after its exit code was found as expected."""
        result = subprocess.run([str(w) for w in words], text=True, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                                stdin=subprocess.DEVNULL, timeout=500, cwd=options.pop("cwd", self.path),
                                env=self.environment, **options)
        self.assertEqual(result.returncode, expect, f"{words}\n{result.stdout}")
        return result.stdout

    def install(self, prefix, *components):
        """Installs components, or without any as a user does who names none."""
        for words in [["--component", c] for c in components] or [[]]:
            self.call(CMAKE, "--install", BUILD, "--prefix", prefix, *words)
        return prefix

    def build(self, source, prefix, *options, expect=0):
        """Configures and builds a project against an installed SDK; the build folder."""
        build = self.path / f"build-{Path(source).name}"
        words = self.call(CMAKE, "-S", source, "-B", build, f"-DCMAKE_PREFIX_PATH={prefix}", *options, expect=expect)
        if expect:
            return words
        self.call(CMAKE, "--build", build)
        return build

    def check_conformance(self, build):
        """Runs a plugin's ctest, which holds it against the interface and its manifest."""
        words = self.call(Path(CMAKE).with_name("ctest"), "--test-dir", build, "--output-on-failure")
        self.assertIn("conform_", words)

    def cells(self, program, out, *options):
        """Rows of cells.csv of a short run of the four-cell scene, by column name. Skips the test without pandas."""
        if importlib.util.find_spec("pandas") is None:
            self.skipTest("pandas is missing: scripts/install-dependencies --full")
        self.call(program, "run", SCENE, "--out", out, "--quiet", *options)
        return rouleau.open(out).cells.to_dict("records")

    def plugin_of(self, out):
        return [plugin.id for plugin in rouleau.open(out).summary.plugins]


def main():
    program = unittest.main(module="__main__", argv=sys.argv[:1], verbosity=2, exit=False)
    failed = len(program.result.failures) + len(program.result.errors)
    print(f"{program.result.testsRun - failed} passed, {failed} failed")
    sys.exit(1 if failed else 0)
