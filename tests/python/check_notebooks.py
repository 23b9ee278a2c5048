"""The notebooks of examples/notebooks and the code of docs/python.md do what they show, with smaller scenes.

A notebook's cell with the tag "parameters" is exchanged for quick values.
"""

import contextlib
import io
import json
import os
import pathlib
import re
import tempfile

from package import SOURCE, Case, main, need, small_scene

need("numpy", "pandas", "h5py", "matplotlib", "nbclient", "nbformat", "ipykernel")

import nbclient  # noqa: E402
import nbformat  # noqa: E402

NOTEBOOKS = SOURCE / "examples/notebooks"
SHEAR = [{"name": "shear", "shear_rate": "20 1/s", "strain": 0.5, "start": "developed"}]
QUICK = {
    "rouleau-in-shear": 'scene, changes = "small.json", {}',
    "phase-diagram": f'scene, strain = "{SOURCE}/scenes/four-cells-shear.json", 0.5\ndepths, rates = ["1e-8 J/m2", "1e-6 J/m2"], [80]',
    "red-cell-in-space": f'scene, changes = "{SOURCE}/scenes/templates/red-cell-3d.json", {{"stages.0.strain": 0.2, "output.cells.strain": 0.1}}',
    "new-potential": f'scene, changes = "small.json", {{"stages": {SHEAR}}}',
}
WITHOUT_OUTPUTS = {"phase-diagram"}  # sixteen runs: scripts/notebooks stores them where there is time
HOME = tempfile.TemporaryDirectory(prefix="rouleau-cache-")


class Notebooks(Case):
    def setUp(self):
        super().setUp()
        (self.path / "small.json").write_text(json.dumps(small_scene()))
        os.environ.update(PYTHONPATH=str(SOURCE / "python"), XDG_CACHE_HOME=HOME.name, MPLBACKEND="module://matplotlib_inline.backend_inline")

    def execute(self, name):
        book = nbformat.read(NOTEBOOKS / f"{name}.ipynb", as_version=4)
        marked = [cell for cell in book.cells if "parameters" in cell.metadata.get("tags", ())]
        self.assertEqual(len(marked), 1)
        marked[0].source = QUICK[name]
        nbclient.NotebookClient(book, timeout=120, kernel_name="python3", resources={"metadata": {"path": str(self.path)}}).execute()
        outputs = [output for cell in book.cells if cell.cell_type == "code" for output in cell.outputs]
        self.assertFalse([output for output in outputs if output.output_type == "error"])
        pictures = sum("image/png" in output.get("data", {}) for output in outputs)
        text = "\n".join(output.get("text", "") + output.get("data", {}).get("text/html", "") +
                         output.get("data", {}).get("text/plain", "") for output in outputs)
        return pictures, text

    def test_from_scene_to_figure(self):
        pictures, text = self.execute("rouleau-in-shear")
        self.assertEqual(pictures, 3)
        self.assertIn("radians turned", text)
        self.assertIn("in-shear: shear 100 %", text)  # the last that the line of progress said
        self.assertIn("data:image/png", text)  # the animation

    def test_phase_diagram(self):
        pictures, text = self.execute("phase-diagram")
        self.assertEqual(pictures, 2)
        self.assertIn("completed", text)
        self.assertEqual(len(list(self.path.glob("runs/phase-diagram/*/summary.json"))), 2)

    def test_new_potential(self):
        pictures, text = self.execute("new-potential")
        self.assertEqual(pictures, 2)
        self.assertIn("python.gaussian-well-", text)
        self.assertIn('the check "units" failed', text)

    def test_a_red_cell_in_space(self):
        pictures, text = self.execute("red-cell-in-space")
        self.assertEqual(pictures, 2)
        self.assertIn("(1002, 3) (2000, 3)", text)
        self.assertTrue((self.path / "cell.vtp").is_file())

    def test_are_all_tried_and_hold_what_they_showed_without_a_machines_folders(self):
        self.assertEqual({path.stem for path in NOTEBOOKS.glob("*.ipynb")}, set(QUICK))
        for path in NOTEBOOKS.glob("*.ipynb"):
            self.assertLess(path.stat().st_size, 600_000, path)
            self.assertNotRegex(path.read_text(), r"/(?:tmp|root|home|work)/")
            cells = [cell for cell in nbformat.read(path, as_version=4).cells if cell.cell_type == "code"]
            self.assertFalse([output for cell in cells for output in cell.outputs if output.output_type == "error"], path)
            if path.stem not in WITHOUT_OUTPUTS:
                self.assertTrue(any("image/png" in output.get("data", {}) for cell in cells for output in cell.outputs), path)


class The_page(Case):
    def test_has_code_that_runs_block_after_block(self):
        blocks = re.findall(r"^```python\n(.*?)^```", (SOURCE / "docs/python.md").read_text(), re.MULTILINE | re.DOTALL)
        self.assertGreater(len(blocks), 5)
        os.environ.update(XDG_CACHE_HOME=HOME.name, MPLBACKEND="Agg")
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(self.path)
        pathlib.Path("scenes").mkdir()
        scene = small_scene(stages=[{"name": "aggregate", "duration": "0.05 s"}, {**SHEAR[0], "strain": 2}])
        pathlib.Path("scenes/four-cells-shear.json").write_text(json.dumps(scene))
        pathlib.Path("scenes/rheology").mkdir()
        random = small_scene(cells=[{"type": "rbc", "random": {"hematocrit": 0.2, "seed": 1}}], stages=SHEAR)
        pathlib.Path("scenes/rheology/suspension.json").write_text(json.dumps(random))
        drawing = '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 400 200"><path d="M0 20H400V180H0Z M150 80h60v40h-60Z"/></svg>'
        pathlib.Path("chip.svg").write_text(drawing)
        names = {}
        for block in blocks:
            with self.subTest(block=block), contextlib.redirect_stdout(io.StringIO()):
                exec(compile(block, "docs/python.md", "exec"), names)


if __name__ == "__main__":
    main()
