"""The page of every model that is shipped, from the manifests and from what the program says."""

import json
import subprocess

import cells

HEAD = """# Every model that is shipped

Made by scripts/docs from the manifests in plugins/; not to be edited. [../models.md](../models.md) says what each
computes and how to choose, `rouleau plugins ID` prints the same of any model that is installed, yours too. Quantities
in a scene may have any unit of the same dimension; plain numbers are taken in SI units. Values outside the usual range
are warned of, those outside the limits refused. A parameter without default must be given.
"""
KINDS = {
    "collision": ("Collision operators", "`fluid.collision` of a scene."),
    "membrane": ("Membrane laws", "In the list `cell_types.NAME.membrane`; all in it add up."),
    "interaction": ("Interactions", "In the list `interactions`; all that are given add up."),
}
CLAIMS = {
    "conservative": {True: "conservative", False: "not conservative"},
    "smooth_at_cutoff": {True: "smooth at the cutoff", False: "broken off at the cutoff"},
    "reproducible": {True: "reproducible to the last bit", False: "not reproducible"},
}


def number(value):
    return value if isinstance(value, str) else f"{value:.10g}"


def limits(parameter):
    if "choices" in parameter:
        return " or ".join(f'`"{word}"`' for word in parameter["choices"])
    words = {"minimum": "at least", "exclusiveMinimum": "above", "maximum": "at most", "exclusiveMaximum": "below"}
    return ", ".join(f"{word} {number(parameter[key])}" for key, word in words.items() if key in parameter)


def parameter_row(parameter):
    usual = " to ".join(number(value) for value in parameter.get("usual", []))
    default = number(parameter["default"]) if "default" in parameter else "must be given"
    unit = parameter.get("unit", "")
    role = f"`{parameter['role']}`" if "role" in parameter else ""
    return [f"`{parameter['name']}`", role, unit, default, limits(parameter), usual, parameter.get("doc", "")]


def names(words):
    return ", ".join(f"`{word}`" for word in words)


def claims(manifest):
    said = []
    for claim, value in manifest.get("claims", {}).items():
        said.append(CLAIMS[claim][value] if claim in CLAIMS else f"{claim} {value}")
    return ", ".join(said)


def dimensions_of(manifest, program):
    """Whether a manifest gives them or leaves them to the host, the program says them."""
    said = subprocess.run([program, "plugins", manifest["id"], "--json"], capture_output=True, text=True, check=True, timeout=60)
    return json.loads(said.stdout)["dimensions"]


def section(manifest, path, program):
    text = f"\n### {manifest['id']}\n\n{manifest['title']}. Version {manifest['version']}.\n\n"
    if manifest.get("parameters"):
        text += cells.table(["parameter", "role", "unit", "default", "limits", "usual", "meaning"], map(parameter_row, manifest["parameters"]))
    else:
        text += "No parameters.\n"
    if manifest.get("state"):
        text += "\n" + cells.table(["remembers", "unit", "at first", "meaning"], [
            [f"`{state['name']}`", state["unit"], number(state.get("initial", 0)), state.get("doc", "")] for state in manifest["state"]])
    text += f"\n- works in {' and '.join(map(str, dimensions_of(manifest, program)))} dimensions\n"
    text += f"- needs {names(manifest['needs'])}\n- gives {names(manifest['gives'])}\n"
    if "in_3d" in manifest:
        text += f"- in three dimensions needs {names(manifest['in_3d']['needs']) or 'nothing'}\n"
        text += f"- in three dimensions gives {names(manifest['in_3d']['gives'])}\n"
    if claims(manifest):
        text += f"- claims to be {claims(manifest)}\n"
    if "inactive_when" in manifest:
        at = " and ".join(f"`{key}` is {number(value)}" for key, value in manifest["inactive_when"].items())
        text += f"- left out when {at}\n"
    if "stands_for" in manifest:
        at = " and ".join(f'`"{key}": "{value}"`' for key, value in manifest["stands_for"].items())
        text += f"- stands for the potential at {at}: `plan` compares the two\n"
    checks = len(manifest.get("checks", []) + manifest.get("in_3d", {}).get("checks", []))
    text += f"- {checks} reference numbers in the manifest\n" if checks else ""
    if "reference" in manifest:
        text += f"- reference: {manifest['reference']}\n"
    return text + f"- manifest: [{path}](../../{path})\n"


def page(folder, program):
    manifests = []
    for path in sorted(folder.glob("**/*.json")):
        manifest = json.loads(path.read_text())
        if "manifest" in manifest:
            manifests.append((manifest, path.relative_to(folder.parent).as_posix()))
    text = HEAD
    for kind, (title, place) in KINDS.items():
        text += f"\n## {title}\n\n{place}\n"
        for manifest, path in sorted(manifests, key=lambda pair: pair[0]["id"]):
            if manifest["kind"] == kind:
                text += section(manifest, path, program)
    return text
