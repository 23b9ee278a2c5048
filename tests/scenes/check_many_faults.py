#!/usr/bin/env python3
"""All that is wrong with a scene is said at once, and nothing that only follows from it.

Usage: check_many_faults.py ROULEAU FOLDER [SEED]
The broken scenes of FOLDER/cases.json (check_bad_scenes.py) are put beside a fault that the schema finds and one that reading
finds, both far from theirs, and five of them, drawn at random from different parts of the scene, are put together: each must be
said in the words that it has alone, and nothing else. Faults in the text itself, at which reading ends, are left out.
"""
import json
import math
import pathlib
import random
import sys
import tempfile

from check_bad_scenes import plan, scene_of

PLANTED = [('"at_rest": {"windw": "1 s"}', "/at_rest/windw"), ('"at_rest": {"window": "1 m"}', "/at_rest/window")]
PARTS = {"at_rest", "cell_types", "cells", "checks", "domain", "fluid", "interactions", "numerics", "output", "stages"}
# Of all cells together; looked for where nothing is wrong with what is written, and stands at least in a document that
# fits its schema.
OF_ALL_CELLS = {"cells-too-many", "force-beside-no-cell", "gravity-on-nothing", "inlet-cells-far-behind", "inlet-cells-without-end", "openings-through-a-cell", "membrane-nodes-too-many", "numerics-auto-no-lattice", "random-beside-cell-longer-than-domain",
                "random-cell-longer-than-domain", "random-count-beyond-region", "random-share-of-tiny-cells", "random-share-tiny",
                "random-too-dense"}
# Cases that a fault in another part may leave open: what they are about is not known then.
NEEDS = {"field-region": {"domain"}, "length-beyond-box": {"domain"}, "unit-forgotten": {"domain"}, "random": {"domain", "cell_types"},
         "missing-nodes": {"domain", "numerics"}, "missing-segments": {"numerics"}, "cell-without-shape": {"numerics"}, "layer-": {"domain"},
         "layers-with": {"fluid", "cells", "cell_types", "domain"}, "layers-oscillating": {"fluid", "domain"}, "output-by-strain": {"stages"},
         "cell-type-unknown": {"cell_types"}, "wall-misspelt": {"cell_types"}, "no-cell-types": {"cell_types"}}
# What others are about stands elsewhere then, or is gone: the key, the flow, the walls. Openings refuse layers and drives that
# others bring (BETWEEN_OPENINGS).
RENAMES = {"cell-type-name-with-comma", "unknown-key-at-the-top", "output-by-strain-without-shear", "shear-between-periodic-sides"}
BETWEEN_OPENINGS = ("inlet-", "openings-", "outlet-")
COMBINED, AT_ONCE = 60, 5  # scenes, and faults in each


def is_json(text: str) -> bool:
    """By the host's rules: the first fault in the text itself ends its reading."""
    def pairs(members):
        if len({key for key, _ in members}) < len(members):
            raise ValueError("a key stands twice")
        return dict(members)

    def finite(number):
        if math.isinf(float(number)):
            raise ValueError("a number overflows")
        return float(number)

    def refuse(constant):
        raise ValueError(constant)

    try:
        value = json.loads(text.encode(errors="surrogateescape").decode(), object_pairs_hook=pairs, parse_float=finite,
                           parse_int=lambda digits: finite(digits) and int(digits), parse_constant=refuse)
        json.dumps(value, ensure_ascii=False).encode()
    except (ValueError, RecursionError):
        return False
    return True


def messages(answer: str) -> dict[str, str]:
    """What is said, by pointer; places begin a line, what is wrong there follows indented."""
    found, pointer = {}, ""
    for line in answer.splitlines():
        if line.startswith("  "):
            found[pointer] += line + "\n"
            continue
        pointer = line.partition(" ")[2]
        while pointer in found:
            pointer += " again"
        found[pointer] = ""
    return found


def part_of(found: dict[str, str]) -> str:
    """The part of the scene that what is said is about."""
    return next(iter(found)).split("/")[1] if "/" in next(iter(found)) else ""


def main() -> int:
    program, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    seed = int(sys.argv[3]) if len(sys.argv) > 3 else random.randrange(1 << 30)
    chance = random.Random(seed)
    print(f"seed {seed}")
    base = (source / "base.json").read_text()
    cases = json.loads((source / "cases.json").read_text())
    scenes = {name: scene_of(case, base) for name, case in cases.items() if "change" in case and "set" not in case}
    scenes = {name: scene for name, scene in scenes.items() if is_json(scene) and not name.startswith("many-")}
    tried, failed, hidden = 0, 0, set()

    def check(what: str, scene: str, expected: dict[str, str], optional=()) -> int:
        """How many of the expected faults are said."""
        nonlocal tried, failed
        tried += 1
        code, answer = plan(program, folder, "scene.json", scene)
        found = messages(answer)
        absent = [pointer for pointer in expected if pointer not in found and pointer not in optional]
        more = [pointer for pointer in found if pointer not in optional and expected.get(pointer, "") != found[pointer]]
        if code != 2 or absent or more:
            failed += 1
            print(f"{what}: exit code {code}, not said {absent}, said or put otherwise {more}\n{answer}")
        return len(expected.keys() & found.keys())

    with tempfile.TemporaryDirectory() as path:
        folder = pathlib.Path(path)
        alone = {}
        for name, scene in scenes.items():
            alone[name] = messages(plan(program, folder, "scene.json", scene)[1])
        for text, pointer in PLANTED:
            def with_it(scene):
                return scene[:scene.rindex("}")].rstrip() + ",\n  " + text + "\n}\n"
            planted = messages(plan(program, folder, "scene.json", with_it(base))[1])
            for name, scene in scenes.items():
                if text[:text.index(":") + 1] not in scene:
                    hidden = alone[name] if name in OF_ALL_CELLS else ()
                    check(f"{name} beside {pointer}", with_it(scene), {**alone[name], **planted}, hidden)
        said = wanted = 0
        single = sorted(name for name in scenes.keys() - RENAMES - OF_ALL_CELLS if len(cases[name]["change"]) == 1 and not name.startswith(BETWEEN_OPENINGS))
        while wanted < COMBINED * AT_ONCE:
            names = chance.sample(single, AT_ONCE)
            parts = {part_of(alone[name]) for name in names}
            if len(parts) < AT_ONCE:
                continue  # one may be what makes the other wrong
            if parts & PARTS < parts:
                parts |= PARTS  # a key at the top that is unknown or missing may be any
            if "no-cell-types" in names:
                parts.add("cell_types")  # a key at the top that is wrong may be the one that is missing
            open_parts = {prefix for prefix, needed in NEEDS.items() if needed & parts}
            hidden = {pointer for name in names if name.startswith(tuple(open_parts)) for pointer in alone[name]}
            changes = {old: new for name in names for old, new in cases[name]["change"].items()}
            if len(changes) < sum(len(cases[name]["change"]) for name in names):
                continue  # two of them change the same text
            try:
                scene = scene_of({"change": changes}, base)
            except ValueError:
                continue
            if is_json(scene):
                wanted += AT_ONCE
                expected = {pointer: words for name in names for pointer, words in alone[name].items()}
                said += check(" ".join(names), scene, expected, hidden)
    print(f"{len(scenes)} broken scenes, {tried} tries, {failed} failed; of {wanted} faults, {AT_ONCE} in a scene, {said} said")
    return 1 if failed or not tried else 0


if __name__ == "__main__":
    sys.exit(main())
