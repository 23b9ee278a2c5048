"""The package as a whole: every public name is documented and typed, and importing it is quick."""

import ast
import inspect
import re
import statistics
import subprocess
import sys

from package import BUILD, SOURCE, Case, main, need

import rouleau

PACKAGE = SOURCE / "python/rouleau"
HERE = {name: getattr(rouleau, name) for name in rouleau.__all__
        if name not in ("FluidField", "Simulation") or any((BUILD / "python/rouleau").glob("_core.*.so"))}


def members(value):
    """Public functions, properties and methods of a class, its own."""
    for name, member in vars(value).items():
        if not name.startswith("_") and (callable(member) or isinstance(member, property)):
            yield name, member


class Public_names(Case):
    def test_have_docstrings(self):
        for name, value in HERE.items():
            self.assertTrue(value.__doc__ and not value.__doc__.startswith(name + "("), name)  # not dataclass's own
            if inspect.isclass(value):
                for member_name, member in members(value):
                    self.assertTrue(inspect.getdoc(member), f"{name}.{member_name}")

    def test_have_fields_that_say_what_they_are(self):
        for path in PACKAGE.glob("*.py"):
            lines = path.read_text().splitlines()
            for node in ast.walk(ast.parse(path.read_text())):
                if not isinstance(node, ast.ClassDef) or node.name not in HERE:
                    continue
                for field in node.body:
                    if isinstance(field, ast.AnnAssign) and not field.target.id.startswith("_"):
                        line = field.lineno - 1
                        self.assertTrue("#:" in lines[line] or lines[line - 1].strip().startswith("#:"), f"{node.name}.{field.target.id}")

    def test_stand_in_the_page_about_the_package(self):
        page = (SOURCE / "docs/python.md").read_text()
        for name in rouleau.__all__:
            self.assertRegex(page, rf"\b{name}\b")

    def test_take_the_arguments_that_the_page_gives_them(self):
        page = (SOURCE / "docs/python.md").read_text()
        for block in re.findall(r"^```python\n(.*?)^```", page, re.MULTILINE | re.DOTALL):
            for node in ast.walk(ast.parse(block)):
                if isinstance(node, ast.Call) and ast.unparse(node.func).startswith("rouleau.") and node.func.attr in HERE:
                    value = HERE[node.func.attr]
                    given = {word.arg: None for word in node.keywords if word.arg}
                    inspect.signature(value).bind(*node.args, **given)

    def test_are_those_that_the_package_has(self):
        self.assertEqual(dir(rouleau), rouleau.__all__)
        with self.assertRaisesRegex(AttributeError, "no attribute 'runn'"):
            rouleau.runn


class The_package(Case):
    def test_is_imported_in_less_than_three_tenths_of_a_second(self):
        code = "import time; t = time.perf_counter(); import rouleau; print(time.perf_counter() - t)"
        command = [sys.executable, "-c", f"import sys; sys.path.insert(0, {str(SOURCE / 'python')!r}); {code}"]
        times = [float(subprocess.run(command, check=True, capture_output=True, text=True).stdout) for _ in range(5)]
        print(f"import rouleau: {1000 * statistics.median(times):.1f} ms")
        self.assertLess(statistics.median(times), 0.3)

    def test_imports_nothing_heavy_before_it_is_used(self):
        code = (f"import sys; sys.path.insert(0, {str(SOURCE / 'python')!r}); import rouleau; rouleau.open, rouleau.run, rouleau.Error; "
                "print([m for m in ('numpy', 'pandas', 'h5py', 'matplotlib') if m in sys.modules])")
        self.assertEqual(subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout, "[]\n")

    def test_has_types_that_mypy_accepts_when_it_is_strict(self):
        need("mypy")
        result = subprocess.run([sys.executable, "-m", "mypy", "--config-file", SOURCE / "python/mypy.ini", "--cache-dir",
                                 self.path, PACKAGE], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)


if __name__ == "__main__":
    need("numpy")
    main()
