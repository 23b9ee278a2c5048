#!/usr/bin/env python3
"""Runs `rouleau plan` on every broken scene of FOLDER/cases.json; each must be refused at its place and for its reason.

Usage: check_bad_scenes.py ROULEAU FOLDER [--every N]
--every: each N-th case, from a random one on, which is printed.
A case is the scene base.json, which is good, with a change, or a whole scene:
  change   {"text that stands once in the scene": "what stands in its place", ...}
  scene    the text of the whole file instead
  set      an argument of --set
  at       line:column and JSON pointer that the message begins with, behind the file's name
  words    two texts that the rest of the message must hold; or
  message  the lines of that rest, exactly; PLUGINS is the folder of the shipped plugins
  also     places of further faults, in order; a case without them has one fault, and nothing that follows from it is said
  more     how many faults more there are, which are not shown
New text is text, or a list of texts and [text, times]; # in a text that is repeated stands for its number, from 0. A byte
that is no UTF-8, 0xE9 for instance, is written \\udce9. The exit code is 2 in every case.
"""
import json
import pathlib
import random
import subprocess
import sys
import tempfile


def text_of(parts) -> str:
    if isinstance(parts, str):
        return parts
    return "".join(part if isinstance(part, str) else "".join(part[0].replace("#", str(i)) for i in range(part[1]))
                   for part in parts)


def scene_of(case: dict, base: str) -> str:
    scene = text_of(case["scene"]) if "scene" in case else base
    for old, new in case.get("change", {}).items():
        if scene.count(old) != 1:
            raise ValueError(f"{old!r} stands {scene.count(old)} times in the scene")
        scene = scene.replace(old, text_of(new))
    return scene


def plan(program: pathlib.Path, folder: pathlib.Path, name: str, scene: str, *options: str) -> tuple[int, str]:
    """Exit code and error stream, without what is said there while cells are placed for seconds."""
    (folder / name).write_bytes(scene.encode(errors="surrogateescape"))
    run = subprocess.run([program, "plan", name, *options], cwd=folder, capture_output=True, timeout=60)
    said = run.stderr.decode(errors="surrogateescape").splitlines(keepends=True)
    return run.returncode, "".join(line for line in said if not line.startswith("placing cells at random: "))


def faults(program: pathlib.Path, folder: pathlib.Path, name: str, case: dict, base: str) -> list[str]:
    """What is wrong with the program's answer to one case."""
    if not case.keys() <= {"change", "scene", "set", "at", "words", "message", "also", "more"} or len(case.get("words", "ab")) != 2:
        return ["the case itself is wrong"]
    options = ["--set", case["set"]] if "set" in case else []
    try:
        code, answer = plan(program, folder, f"{name}.json", scene_of(case, base), *options)
    except (subprocess.TimeoutExpired, ValueError) as error:
        return [str(error)]
    place, _, rest = answer.replace(str(program.parent.parent / "lib/rouleau/plugins"), "PLUGINS").partition("\n")
    expected = case["at"] if "set" in case else f"{name}.json:{case['at']}"
    found = []
    if code != 2:
        found.append(f"exit code {code}")
    if place != expected:
        found.append(f"begins with {place!r}, expected {expected!r}")
    further = [line for line in rest.splitlines() if not line.startswith("  ")]
    also = [f"{name}.json:{place}" for place in case.get("also", [])]
    also += [f"and {case['more']} fault{'s' if case['more'] > 1 else ''} more"] if "more" in case else []
    if further != also:
        found.append(f"also says {further}, expected {also}")
    if "message" in case and rest != "".join(f"{line}\n" for line in case["message"]):
        found.append("is not the expected message, word for word")
    if "message" not in case:
        found += [f"does not hold {words!r}" for words in case["words"] if words not in rest]
    return [*found, answer] if found else []


def main() -> int:
    if len(sys.argv) != 3 and sys.argv[3:4] != ["--every"]:
        print(__doc__, file=sys.stderr)
        return 2
    program, source = (pathlib.Path(argument).resolve() for argument in sys.argv[1:3])
    every = int(sys.argv[4]) if sys.argv[3:] else 1
    first = random.randrange(every)
    base = (source / "base.json").read_text()
    cases = json.loads((source / "cases.json").read_text())
    failed = 0
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        code, answer = plan(program, folder, "base.json", base)
        if code != 0:
            failed += 1
            print(f"base.json is not good: exit code {code}\n{answer}")
        for name, case in list(cases.items())[first::every]:
            found = faults(program, folder, name, case, base)
            if found:
                failed += 1
                print("\n  ".join([name, *found]).encode(errors="backslashreplace").decode())
    print(f"{len(cases)} cases, each {every}. from {first} on, {failed} failed")
    return 1 if failed or not cases else 0


if __name__ == "__main__":
    sys.exit(main())
