"""What the scene's schema says beside its rules (units, defaults) is what the program does: docs/reference/scene.md is made of it.

usage: check_schema.py SOURCE BUILD
"""

import copy
import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
PROGRAM = BUILD / "bin/rouleau"
SCHEMA = json.loads((SOURCE / "host/scene/scene.schema.json").read_text())

SCENE = {
    "rouleau": 1,
    "domain": {"size": ["24 um", "16 um"], "nodes": [96, 64], "y": {"lower": {"wall": {}}, "upper": {"wall": {}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 2000},
    "cell_types": {
        "red": {"shape": {"biconcave": {"radius": "2 um"}}, "segments": 40, "membrane": [{"model": "hooke", "parameters": {"stretching_modulus": 1e-5}}]},
        "round": {"shape": {"circle": {"radius": "1 um"}}, "segments": 24, "membrane": []},
        "oval": {"shape": {"ellipse": {"semi_axes": ["1 um", "0.9 um"]}}, "segments": 24, "interior_density": "1.1 g/cm3", "membrane": []},
    },
    "cells": [
        {"type": "red", "at": ["5 um", "8 um"]},
        {"type": "round", "row": {"count": 2, "spacing": "3 um", "center": ["12 um", "3 um"]}},
        {"type": "oval", "list": [{"at": ["12 um", "8 um"]}]},
        {"type": "round", "random": {"count": 1, "seed": 1, "region": {"lower": ["15 um", "9 um"], "upper": ["23 um", "15 um"]}}},
    ],
    "interactions": [],
    "stages": [{"name": "shear", "shear_rate": "20 1/s", "strain": 0.01},
               {"name": "driven", "pressure_gradient": "1 kPa/m", "duration": "1 ms"},
               {"name": "carried", "walls": {"lower": 0, "upper": "1 mm/s"}, "duration": "1 ms",
                "oscillation": {"amplitude": {"lower": 0, "upper": "0.1 mm/s"}, "frequency": "1 kHz"}}],
    "output": {"cells": {"strain": 0.25, "seconds": "1 ms"}, "fields": {"strain": 1, "seconds": "1 ms", "quantities": ["velocity"],
               "region": {"from": ["5 um", "2 um"], "to": ["15 um", "10 um"]}}, "checkpoint": {"seconds": 600}},
    "at_rest": {}, "equilibrium": {}, "checks": {},
}
# Another value than the default, which must change what the program prints or writes: else a wrong default would pass unseen.
OTHER = {
    "/domain/x": None,  # there is one word only
    "/fluid/inertia": True, "/fluid/collision": {"model": "bgk"}, "/fluid/body_force": ["10 N/m3", "0 N/m3"],
    "/fluid/gravity": ["0 m/s2", "-9.81 m/s2"],
    "/numerics/tau": 0.9, "/numerics/density_factor": 2000, "/numerics/kernel": "roma3", "/numerics/slip_correction": True,
    "/numerics/area_correction": True, "/numerics/precision": "f32", "/numerics/coupling": "semi-implicit",
    "/cell_types/round/shape/circle/prestretch": 1.1, "/cells/0/angle": 1, "/cells/1/row/axis": "y", "/cells/1/row/angle": 1,
    "/cells/2/list/0/angle": 1, "/stages/0/start": "developed", "/stages/1/start": None, "/stages/2/start": None, "/output/fields/stride": 2, "/output/fields/precision": "f64",
    "/output/fields/compression": 0, "/output/checkpoint": None, "/output/aggregate_gap": "3 um", "/output/bond_share": None,
    "/at_rest/displacement": None, "/at_rest/window": None, "/equilibrium/rate": None, "/equilibrium/window": None, "/checks/mach": None, "/checks/node_step": None,
    "/checks/area_drift": None, "/checks/stretch": None, "/checks/energy_growth": None, "/checks/every_steps": None,
}
# Where no short run shows the value: the schema's, and how the header says it.
HEADER = {"/at_rest/displacement": ("0.01 um", r"displacement = 0\.01e-6;"), "/at_rest/window": ("0.2 s", r"window = 0\.2;"),
          "/equilibrium/rate": ("0.001 1/s", r" rate = 1e-3;"), "/equilibrium/window": ("0.2 s", r"window = 0\.2;"),
          "/checks/mach": (0.3, r"mach = 0\.3;"), "/checks/node_step": (0.5, r"node_step = 0\.5;"),
          "/checks/area_drift": (0.02, r"area_drift = 0\.02;"), "/checks/stretch": (5, r"stretch = 5;"),
          "/checks/energy_growth": (0.01, r"energy_growth = 0\.01;"), "/checks/every_steps": (200, r"every_steps = 200;"),
          "/output/bond_share": (0.15, r"bond_share = 0\.15;"), "/output/checkpoint": ({"seconds": 600}, r"checkpoint_seconds = 600;")}


def resolved(rule):
    while "$ref" in rule:
        rule = {**SCHEMA["definitions"][rule["$ref"].rsplit("/", 1)[1]], **{k: v for k, v in rule.items() if k != "$ref"}}
    return rule


def walk(rule, value, pointer=""):
    """Every rule that SCENE uses or leaves out, with its pointer."""
    rule = resolved(rule)
    for branch in [rule, *map(resolved, rule.get("oneOf", []))]:
        if not isinstance(value, dict) or any(key not in value for key in branch.get("required", [])):
            continue
        for key, below in branch.get("properties", {}).items():
            yield f"{pointer}/{key}", resolved(below)
            if key in value:
                yield from walk(below, value[key], f"{pointer}/{key}")
    extra = rule.get("additionalProperties")
    if isinstance(extra, dict) and isinstance(value, dict):
        for key in value:
            yield from walk(extra, value[key], f"{pointer}/{key}")
    for branch in [rule, *map(resolved, rule.get("oneOf", []))]:
        if isinstance(value, list) and "items" in branch:
            for place, item in enumerate(value):
                yield from walk(resolved(branch["items"]), item, f"{pointer}/{place}")


RULES = dict(walk(SCHEMA, SCENE))
QUANTITY = SCHEMA["definitions"]["quantity"]["type"]


def changed(*settings):
    scene = copy.deepcopy(SCENE)
    for pointer, value in settings:
        *path, last = pointer.split("/")[1:]
        at = scene
        for key in path:
            at = at[int(key)] if isinstance(at, list) else at.setdefault(key, {})
        if value is None:
            at.pop(last, None)
        elif isinstance(at, list):
            at[int(last)] = value
        else:
            at[last] = value
    return scene


class The_schema(unittest.TestCase):
    def setUp(self):
        folder = tempfile.TemporaryDirectory(prefix="rouleau-schema-")
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def call(self, command, scene, *more):
        (self.folder / "scene.json").write_text(json.dumps(scene))
        return subprocess.run([PROGRAM, command, "scene.json", *more], cwd=self.folder, capture_output=True, text=True)

    def results(self, scene):
        """What a plan and a few steps give, without times and hashes of the scene."""
        plan = self.call("plan", scene, "--json")
        self.assertEqual(plan.returncode, 0, plan.stderr)
        run = self.call("run", scene, "--quiet", "--overwrite", "--out", "run", "--max-steps", "3")
        tables = [(self.folder / "run" / name).read_text() for name in ("cells.csv", "aggregates.csv", "series.csv")]
        plan = re.sub(r'"(scene_sha256|file)": "[^"]*"', "", plan.stdout)
        said = re.sub(r" in [^(\n]*\(1 thread, \S+ MLUPS\)", "", run.stdout + run.stderr)
        return plan, said, run.returncode, tables

    def test_every_unit_is_the_one_that_the_program_wants(self):
        with_unit = {p: rule for p, rule in RULES.items() if "unit" in rule}
        self.assertGreater(len(with_unit), 20)
        for pointer, rule in with_unit.items():
            rule = {**rule, **resolved(rule["oneOf"][0])} if "oneOf" in rule else rule  # a value in place of which there is a ramp
            vector = rule["type"] == "array"
            result = self.call("plan", changed((pointer, ["1 kg", "1 kg"] if vector else "1 kg")))
            self.assertEqual(result.returncode, 2, pointer)
            wanted = re.search(r"wants ([^(\n]*?) *(?:\(|$)", result.stderr, re.MULTILINE)
            self.assertIsNotNone(wanted, f"{pointer}: {result.stderr}")
            # The program names the dimension by a unit of its own choice: it must take the schema's, and read it as SI.
            number = resolved(rule["items"] if vector else rule)
            self.assertEqual(number["type"], QUANTITY, pointer)
            one = f"1e-6 {rule['unit']}"
            with self.subTest(pointer=pointer, wanted=wanted[1]):
                said = self.call("plan", changed((pointer, [one, one] if vector else one))).stderr
                self.assertNotIn("wants", said)

    def test_every_quantity_has_a_unit(self):
        for pointer, rule in RULES.items():
            if "/parameters/" in pointer:
                continue  # the manifest's
            items = resolved(rule["items"]) if rule.get("type") == "array" else {}
            if QUANTITY in (rule.get("type"), items.get("type")):
                self.assertIn("unit", rule, pointer)

    def test_every_default_is_what_the_program_takes_when_the_key_is_left_out(self):
        with_default = {p: rule["default"] for p, rule in RULES.items() if "default" in rule}
        self.assertEqual(set(OTHER), set(with_default))
        header = (SOURCE / "host/scene/scene.hpp").read_text()
        base = {}
        for pointer, default in with_default.items():
            other = OTHER.get(pointer)
            without = json.dumps(changed((pointer, None)))
            if without not in base:
                base[without] = self.results(json.loads(without))
            with self.subTest(pointer=pointer):
                self.assertEqual(self.results(changed((pointer, default))), base[without])
                if other is not None:
                    self.assertNotEqual(self.results(changed((pointer, other))), base[without])
                if pointer in HEADER:
                    value, pattern = HEADER[pointer]
                    self.assertEqual(default, value)
                    self.assertTrue(re.search(pattern, header), pattern)

    def test_every_shipped_file_names_its_schema_for_editors_where_it_lies_and_where_it_is_installed(self):
        kinds = {"rouleau": "scene", "rouleau_study": "study", "rouleau_limits": "limits"}
        files = [file for folder in ("scenes", "studies", "limits") for file in (SOURCE / folder).glob("**/*.json")]
        self.assertGreater(len(files), 90)
        for file in files:
            shipped = json.loads(file.read_text())
            named = (file.parent / shipped["$schema"]).absolute()
            kind = next(kinds[key] for key in kinds if key in shipped)
            with self.subTest(file=str(file.relative_to(SOURCE))):
                # share/rouleau has the folders scenes and schema side by side, as the source has.
                self.assertEqual(pathlib.Path(os.path.normpath(named)), SOURCE.absolute() / f"schema/{kind}.schema.json")
                self.assertEqual(json.loads(named.read_text())["properties"]["$schema"]["type"], "string")

    def test_descriptions_that_speak_of_a_default_have_one(self):
        for pointer, rule in RULES.items():
            for said in re.findall(r"([^;.,:]*) (?:\()?when left out", rule.get("description", "")):
                if re.search(r"fluid's|spacing|domain|at the end", said):
                    continue  # the default is no constant
                if "markdownDescription" in rule and "when left out" in rule["markdownDescription"]:
                    continue
                self.assertIn("default", rule, pointer)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
