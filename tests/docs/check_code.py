"""Every block of code that the documentation shows does what it is shown for: sources are built, whole models conform
with three seeds, scenes are planned, and what is part of something is put into a whole that is stated here.

Commands are run by check_docs.py and tests/sdk/check_tutorial.py; formulas, drawings and lists are no code. A block that
looks like code and that no line of BLOCKS knows is a failure, and so is a line that knows no block.

usage: check_code.py SOURCE BUILD
"""

import ast
import json
import pathlib
import re
import subprocess
import sys
import tempfile
import textwrap
import unittest

sys.dont_write_bytecode = True
SOURCE, BUILD = (pathlib.Path(word).resolve() for word in sys.argv[1:3])
sys.path[:0] = [str(SOURCE / "scripts/documentation"), str(SOURCE / "tests"), str(SOURCE / "python"), str(pathlib.Path(__file__).parent)]

from page_commands import PROGRAMS  # noqa: E402
from pages import PAGES  # noqa: E402
from rouleau.shapes import png  # noqa: E402
from scene_parts import tube_stl  # noqa: E402

PROGRAM = BUILD / "bin/rouleau"
SHIPPED = SOURCE / "plugins"
SEEDS = ("1", "20261123", "987654321")
COMPILER = re.search(r"^CMAKE_CXX_COMPILER:\w+=(.*)$", (BUILD / "CMakeCache.txt").read_text(), re.MULTILINE)[1]
FLAGS = ["-std=c++17", "-O3", "-fno-math-errno", "-fno-trapping-math", "-fPIC", "-fvisibility=hidden", "-Wno-psabi",
         f"-I{SOURCE}/sdk/include"]
LOOKS_LIKE_CODE = re.compile(r'[;{]\s*$|^\s*#include|^\s*["{}]|^import |find_package\(|template <', re.MULTILINE)


class Block:
    def __init__(self, page, line, text):
        self.page, self.line, self.text = page, line, textwrap.dedent(text).strip("\n")

    def __str__(self):
        return f"{self.page}:{self.line}"


def blocks_of(page):
    """Indented and fenced blocks of a page, or of a header's comments; the files that a command writes with cat."""
    text = (SOURCE / page).read_text()
    if page.endswith((".hpp", ".h")):
        # Blocks of comments stand five spaces or more from the slashes; everything else becomes text.
        lines = [re.sub(r"^\s*///?", "", line) if re.match(r"\s*//", line) else "code" for line in text.splitlines()]
        text = "\n".join(re.sub(r"^ (?=\S)", "", line) for line in lines)
        text = re.sub(r"^ {5}", "    ", text, flags=re.MULTILINE)
    pattern = re.compile(r"^```(?P<language>\w*)\n(?P<fenced>.*?)^```$|(?:(?<=\n\n)|\A)(?P<indented>(?: {4}[^\n]*\n|[ \t]*\n(?= {4}))+)",
                         re.MULTILINE | re.DOTALL)
    for found in pattern.finditer(text + "\n"):
        if found["language"] == "text":
            continue  # what a command prints: check_docs.py
        body = found["fenced"] if found["fenced"] is not None else found["indented"]
        line = text[:found.start()].count("\n") + 1
        files = re.findall(r"<<'(\w+)'\n(.*?)^\1$", body, re.MULTILINE | re.DOTALL)
        for _, content in files:
            yield Block(page, line, content)
        if not files:
            yield Block(page, line, body)


def is_code(block):
    return not block.text.lstrip().startswith((*PROGRAMS, "$ ", "c++ ")) and LOOKS_LIKE_CODE.search(block.text)


def shipped_manifest(name):
    return json.loads(next(SHIPPED.glob(f"*/*/{name}.json")).read_text())


def example_manifest(name):
    return json.loads((SOURCE / f"sdk/examples/{name}/{name}.json").read_text())


FILM = {  # a whole manifest for the fragment on potentials that depend on motion
    "manifest": 1, "abi": 1, "kind": "interaction", "id": "org.example.film", "version": "1.0.0", "library": "libmodel.so",
    "title": "A film that resists approach", "license": "MIT",
    "parameters": [{"name": "damping", "unit": "Pa s/m", "default": 1e3, "minimum": 0},
                   {"name": "cutoff", "unit": "m", "default": 1e-6, "exclusiveMinimum": 0}],
    "needs": ["normal_velocity"], "gives": ["energy", "force"], "inactive_when": {"damping": 0},
    "claims": {"reproducible": True, "conservative": False, "smooth_at_cutoff": False}}
FILM_SOURCE = """#include <rouleau/interaction.hpp>
struct Film {
  double damping, rc;
  explicit Film(const rouleau::Parameters& p) : damping{p["damping"]}, rc{p["cutoff"]} {}
  double cutoff() const { return rc; }
%s
};
ROULEAU_INTERACTION(Film, "org.example.film", "1.0.0")
"""
DECLARED = """#include <rouleau/membrane.hpp>
using namespace rouleau;
struct Model {
%s
};
"""
RELAXING = """#include <rouleau/membrane.hpp>
struct Relaxing {
  static constexpr int state_count = 1;
  double tau;
  explicit Relaxing(const rouleau::Parameters& p) : tau{p["relaxation_time"]} {}
  template <class S>
  rouleau::Tension<S> operator()(const rouleau::Segment<S>& segment, rouleau::State<S, 1>& state, double time_step) const {
    const S goal = segment.stretch;
%s
    return {S(0), S(0)};
  }
};
ROULEAU_MEMBRANE(Relaxing, "org.example.relaxing", "1.0.0")
"""


class Code(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rouleau-code-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, *words):
        result = subprocess.run([str(w) for w in words], cwd=self.folder, capture_output=True, text=True, timeout=250)
        self.assertEqual(result.returncode, 0, f"{words}\n{result.stdout}{result.stderr}")
        return result.stdout

    # What may be done with a block. Each takes the block; those with parameters are made below.

    def compile(self, source):
        (self.folder / "model.cpp").write_text(source)
        self.call(COMPILER, *FLAGS, "-shared", f"-Wl,--version-script={SOURCE}/sdk/cmake/rouleau-plugin.map", "model.cpp",
                  "-o", "libmodel.so")

    def conform(self, source, manifest):
        self.compile(source)
        (self.folder / "model.json").write_text(json.dumps({**manifest, "library": "libmodel.so"}))
        for seed in SEEDS:
            self.call(PROGRAM, "conform", "model.json", "--seed", seed)

    def plan(self, scene):
        (self.folder / "scene.json").write_text(scene if isinstance(scene, str) else json.dumps(scene))
        self.call(PROGRAM, "plan", "scene.json")

    def whole_scene(self):
        return json.loads(next(b.text for b in blocks_of("docs/scene.md") if b.text.startswith('{\n  "rouleau": 1')))

    def with_part(self, key, text):
        """The scene of docs/scene.md in an ampler domain, with one more entry of a list."""
        scene = self.whole_scene()
        scene["domain"] = {**scene["domain"], "size": ["50 um", "25 um"], "nodes": [200, 100]}
        part = json.loads(text)
        if key == "membrane":
            scene["cell_types"]["rbc"]["membrane"].append(part)
        elif key == "cells":
            scene["cells"] = [part]
        elif key == "stages":
            scene["stages"], scene["output"] = [part], {"cells": {"seconds": "0.1 s"}}
            if part.get("until") == "parted":  # of cells that something joins
                scene["interactions"] = [{"between": ["rbc", "rbc"], "model": "morse", "parameters": {"depth": "5.2e-8 J/m2"}}]
        else:
            scene[key] = [part]
        self.plan(scene)


def model(manifest):
    return lambda test, block: test.conform(block.text, manifest())


def part_of_scene(key):
    return lambda test, block: test.with_part(key, block.text)


def cells_of_a_file(test, block):
    """With the table of the section below it."""
    table = next(b.text for b in blocks_of("docs/scene.md") if b.text.startswith("type,x_um"))
    (test.folder / json.loads(block.text)["file"]).write_text(table.rstrip() + "\n")
    test.with_part("cells", block.text)


def domain_of_a_tube(test, block):
    scene = json.loads((SOURCE / "scenes/tube-3d.json").read_text())
    domain = json.loads("{" + block.text.strip().rstrip(",") + "}")
    test.assertEqual(domain, {"domain": scene["domain"]})
    test.plan(scene)


def walls_of_any_shape(test, block):
    """With the files that the page speaks of."""
    white = [[255 if 30 <= y < 130 else 0] * 400 for y in range(160)]
    (test.folder / "chip.png").write_bytes(png(white))
    (test.folder / "vessel.stl").write_bytes(tube_stl(15, 100, lids=False))
    rest = {"rouleau": 1, "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"}, "numerics": {"density_factor": 100},
            "stages": [{"name": "flow", "mean_velocity": "1 mm/s", "duration": "20 ms"}]}
    written = json.loads("{" + block.text.strip().rstrip(",") + "}")
    if "cells" in written["domain"].get("x", {}).get("lower", {}).get("inlet", {}):
        rest["cell_types"] = json.loads((SOURCE / "scenes/bifurcation.json").read_text())["cell_types"]
        del rest["stages"][0]["mean_velocity"]
    test.plan(rest | written)


def cells_in_space(test, block):
    scene = json.loads((SOURCE / "scenes/suspension-3d.json").read_text())
    test.plan(scene | json.loads("{" + block.text.strip().rstrip(",") + "}"))


def keys_of_a_type_in_space(test, block):
    scene = json.loads((SOURCE / "scenes/suspension-3d.json").read_text())
    scene["cell_types"]["rbc"].update(json.loads("{" + block.text + "}"))
    test.plan(scene)


def cells_of_the_template_in_space(test, block):
    scene = json.loads((SOURCE / "scenes/templates/red-cell-3d.json").read_text())
    test.plan(scene | json.loads("{" + block.text.strip().rstrip(",") + "}"))


def law_in_space(test, block):
    scene = json.loads((SOURCE / "scenes/suspension-3d.json").read_text())
    scene["cell_types"]["rbc"]["membrane"].append(json.loads(block.text))
    test.plan(scene)


def other_settings(test, block):
    """Keys that replace those of the whole scene; more than one setting of a key stands for alternatives."""
    for text in re.split(r"\n\s*\n", block.text):
        scene = test.whole_scene()
        scene.update(json.loads("{" + text.rstrip().rstrip(",") + "}"))
        if isinstance(scene["numerics"], str) or "auto" in scene["numerics"]:
            scene["domain"].pop("nodes", None)
        test.plan(scene)


def state_of_the_maxwell_branch(test, block):
    test.assertEqual(json.loads("{" + block.text + "}")["state"][0].items()
                     - shipped_manifest("standard-linear-solid")["state"][0].items(), set())


def law_of_both_dimensions(test, block):
    written, shipped = json.loads("{" + block.text.rstrip().rstrip(",") + "}"), shipped_manifest("skalak")
    test.assertEqual(written["dimensions"], shipped["dimensions"])
    test.assertEqual(written["in_3d"]["needs"], shipped["in_3d"]["needs"])
    test.assertLessEqual(set(written["in_3d"]["gives"]), set(shipped["in_3d"]["gives"]))


def relaxing_model(test, block):
    if "goal" not in block.text:
        return test.compile(DECLARED % block.text)
    manifest = {"manifest": 1, "abi": 1, "kind": "membrane", "id": "org.example.relaxing", "version": "1.0.0",
                "library": "libmodel.so", "title": "Forgets its first stretch", "license": "MIT",
                "parameters": [{"name": "relaxation_time", "unit": "s", "default": 0.1, "exclusiveMinimum": 0}],
                "needs": ["stretch"], "gives": ["tension", "energy"], "claims": {"reproducible": True},
                "state": [{"name": "memory", "unit": "1", "initial": 1}]}
    test.conform(RELAXING % block.text, manifest)


def quantity_of_a_study(test, block):
    """With the reference where the page says it lies; tests/schemas holds studies to the schema."""
    reference = json.loads(block.text)["reference"]
    value = json.loads((SOURCE / "studies" / reference["file"]).resolve().read_text())
    for key in reference["pointer"].split("/")[1:]:
        value = value[int(key)] if isinstance(value, list) else value[key]
    test.assertIsInstance(value, float)


def quantity_with_a_bar(test, block):
    (bar,) = json.loads("{" + block.text + "}").values()
    test.assertEqual(set(bar), {"value", "error", "how"})


def study(test, block):
    """Cut to a second of run time: a study that cannot be read ends with another code."""
    text = json.loads(block.text)
    text["scene"] = str(SOURCE / "studies" / text["scene"])
    (test.folder / "study.json").write_text(json.dumps(text))
    test.call(PROGRAM, "study", "study.json", "--budget", "1s", "--repeats", "1", "--quiet")


def fuzz_target(test, block):
    (test.folder / "target.cpp").write_text(block.text.replace("some_schema", "SCHEMA_OF_ITS_OWN"))
    test.call(COMPILER, "-std=c++20", "-fsyntax-only", "-Wno-psabi", *[f"-I{SOURCE}/{f}" for f in ("host", "tests/fuzz", "sdk/include")],
              "target.cpp")


# page, how the block begins, what is done with it.
BLOCKS = [
    ("docs/library.md", "find_package(Rouleau REQUIRED COMPONENTS core)", "the same two lines as a project: tests/sdk/check_core.py builds it"),
    ("docs/models.md", '{"model": "lim"', law_in_space),
    ("docs/models.md", '{"model": "viscous"', part_of_scene("membrane")),
    ("docs/models.md", '{"model": "standard-linear-solid"', part_of_scene("membrane")),
    ("docs/models.md", '{"between": ["rbc", "rbc"], "model": "bridging"', part_of_scene("interactions")),
    ("docs/models.md", "#include <rouleau/membrane.hpp>", model(lambda: shipped_manifest("standard-linear-solid"))),
    ("sdk/README.md", '"dimensions": [2, 3]', law_of_both_dimensions),
    ("docs/models.md", '"state": [', state_of_the_maxwell_branch),
    ("docs/models.md", "template <class S>\nrouleau::Pair<S> operator()(const rouleau::Contact<S>& contact)",
     lambda test, block: test.conform(FILM_SOURCE % block.text, FILM)),
    ("docs/scene.md", '{\n  "rouleau": 1', lambda test, block: test.plan(block.text)),
    ("docs/scene.md", '"cell_types": { "rbc": { "from"', cells_in_space),
    ("docs/scene.md", '"shape": {"biconcave"', keys_of_a_type_in_space),
    ("docs/scene.md", '{"type": "rbc", "at"', part_of_scene("cells")),
    ("docs/scene.md", '{"type": "rbc", "row"', part_of_scene("cells")),
    ("docs/scene.md", '{"type": "rbc", "list"', part_of_scene("cells")),
    ("docs/scene.md", '{"type": "rbc", "random"', part_of_scene("cells")),
    ("docs/scene.md", '{"file"', cells_of_a_file),
    ("docs/scene.md", '{"name": "carry"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "channel"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "shake"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "faster"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "shear"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "pull"', part_of_scene("stages")),
    ("docs/scene.md", '{"name": "weaken"', "of a scene with two interactions; tests/unit/contact/forces.cpp has such courses"),
    ("docs/scene.md", '{"between": ["rbc", "rbc"], "model": "morse"', part_of_scene("interactions")),
    ("docs/scene.md", '{"between": ["rbc", "wall"], "model": "repulsion"', part_of_scene("interactions")),
    ("docs/scene.md", '{"between": ["rbc", "self"], "model": "repulsion"', part_of_scene("interactions")),
    ("docs/scene.md", '"domain": {', other_settings),
    ("docs/scene.md", '"fluid": {', other_settings),
    ("docs/scene.md", '"numerics": {', other_settings),
    ("docs/auto.md", '"domain": {', other_settings),
    ("docs/auto.md", '"numerics": {', other_settings),
    ("docs/error-bars.md", '"deformation"', quantity_with_a_bar),
    ("docs/study.md", '{\n  "rouleau_study": 1', study),
    ("docs/study-quantities.md", '{"name": "deformation"', quantity_of_a_study),
    ("docs/three-dimensions.md", '{\n  "rouleau": 1', lambda test, block: test.plan(block.text.split("\n\nrouleau run")[0])),
    ("docs/three-dimensions.md", '"domain": {', domain_of_a_tube),
    ("docs/three-dimensions.md", '"cells": [', cells_in_space),
    ("docs/three-dimensions.md", '"cell_types": {', "of scenes/capsule-3d.json, which tests/physics runs"),
    ("docs/first-run-3d.md", '"cells": [', cells_of_the_template_in_space),
    ("docs/first-run-3d.md", "import rouleau", lambda test, block: ast.parse(block.text)),
    ("docs/first-run.md", "import rouleau", lambda test, block: ast.parse(block.text)),
    ("docs/output-frames.md", "import h5py", lambda test, block: ast.parse(block.text)),
    ("docs/python.md", "import rouleau\nrun", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/python.md", "import rouleau\nfrom", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/python.md", "import numpy\n", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/python.md", "table = rouleau.sweep", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/python.md", "def deformation", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/python.md", "scene = {", "run by tests/python/check_notebooks.py, block after block"),
    ("docs/resume.md", "import h5py", lambda test, block: ast.parse(block.text)),
    ("docs/simulation.md", "import rouleau", lambda test, block: ast.parse(block.text)),
    ("docs/testing.md", "// Locks:", fuzz_target),
    ("docs/walls.md", '"walls": { "within"', "of scenes/couette-cylinders.json"),
    ("docs/walls.md", '"output": {', "needs walls of a shape; tests/python/check_reading.py reads such a run"),
    ("docs/walls.md", '"domain": {\n', walls_of_any_shape),
    ("docs/walls.md", '"domain": { "size": ["60 um", "20 um"],', walls_of_any_shape),
    ("docs/walls.md", '"domain": { "size": ["18 um", "40 um"],', "tests/commands/check_openings.py runs such domains"),
    ("docs/walls.md", '"domain": { "size": ["60 um", "16 um"],', walls_of_any_shape),
    ("docs/walls.md", '"domain": { "size": ["100 um", "40 um"],', walls_of_any_shape),
    ("docs/walls.md", '"domain": { "size": ["100 um", "40 um", "40 um"]', walls_of_any_shape),
    ("sdk/README.md", "// Screened repulsion of flat surfaces", lambda test, block: test.conform(block.text, YUKAWA())),
    ("sdk/README.md", '{\n  "manifest": 1', "the manifest of the source before it, with which that is conformed"),
    ("sdk/README.md", "#include <rouleau/interaction.hpp>\n\nstruct MorseEnergy",
     model(lambda: {**shipped_manifest("morse"), "id": "org.example.morse"})),
    ("sdk/include/rouleau/dual.hpp", "struct LogarithmicSpring",
     lambda test, block: test.conform("#include <rouleau/membrane.hpp>\n" + block.text, example_manifest("logarithmic-spring"))),
    ("sdk/include/rouleau/state.hpp", "static constexpr int state_count", lambda test, block: test.compile(DECLARED % block.text)),
    ("sdk/include/rouleau/state.hpp", '"state": [', state_of_the_maxwell_branch),
    ("sdk/include/rouleau/state.hpp", "template <class S>\nTension<S>", relaxing_model),
    ("sdk/include/rouleau/state.hpp", "const S kept", relaxing_model),
]
YUKAWA = lambda: json.loads(next(b.text for b in blocks_of("sdk/README.md") if b.text.startswith('{\n  "manifest": 1')))  # noqa: E731
EVERYWHERE = [*PAGES, *sorted(p.relative_to(SOURCE).as_posix() for p in (SOURCE / "sdk/include/rouleau").iterdir())]
FOUND = [block for page in EVERYWHERE for block in blocks_of(page)]
CODE = [block for block in FOUND if is_code(block)]


def entry_of(block):
    fitting = [entry for entry in BLOCKS if entry[0] == block.page and block.text.startswith(entry[1])]
    return fitting[0] if len(fitting) == 1 else None


class Every_block(Code):
    def test_is_known(self):
        for block in CODE:
            self.assertIsNotNone(entry_of(block), f"{block}: this block is neither built nor listed:\n{block.text}")
        known = [entry_of(block) for block in CODE]
        for entry in BLOCKS:
            self.assertEqual(known.count(entry), 1, f"{entry[:2]} is not there, or more than once")

    def test_does_what_it_is_shown_for(self):
        done = 0
        for block in CODE:
            entry = entry_of(block)
            if entry and callable(entry[2]):
                with self.subTest(place=str(block)):
                    entry[2](self, block)
                    done += 1
        parts = [f"{block} ({entry_of(block)[2]})" for block in CODE if entry_of(block) and isinstance(entry_of(block)[2], str)]
        print(f"docs: {len(FOUND)} blocks, {len(CODE)} of them code: {done} built, conformed or planned; not: {'; '.join(parts)}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
