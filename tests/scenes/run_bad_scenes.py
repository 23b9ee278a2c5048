#!/usr/bin/env python3
"""Runs `rouleau plan NAME.json` on every broken scene of a folder and compares exit code and message exactly.

Usage: run_bad_scenes.py ROULEAU FOLDER
Beside NAME.json lies NAME.expected: the exit code on its first line, then the message on the error stream. The program
runs in FOLDER, so that messages name the scene as NAME.json.
"""
import difflib
import pathlib
import subprocess
import sys


def fault(program: pathlib.Path, scene: pathlib.Path) -> str:
    """What is wrong with the program's answer to one scene; empty when nothing is."""
    expected_file = scene.with_suffix(".expected")
    if not expected_file.exists():
        return f"{expected_file.name} is missing"
    code, _, message = expected_file.read_bytes().decode(errors="surrogateescape").partition("\n")
    try:
        run = subprocess.run([program, "plan", scene.name], cwd=scene.parent, capture_output=True, timeout=60)
    except subprocess.TimeoutExpired:
        return "no answer within 60 s"
    found = run.stderr.decode(errors="surrogateescape")
    problems = []
    if run.returncode != int(code):
        problems.append(f"exit code {run.returncode}, expected {code}")
    if found != message:
        problems += difflib.unified_diff(message.splitlines(), found.splitlines(), "expected", "found", lineterm="")
    return "\n  ".join(problems)


def main() -> int:
    if len(sys.argv) != 3:
        print(__doc__, file=sys.stderr)
        return 2
    program, folder = (pathlib.Path(argument).resolve() for argument in sys.argv[1:])
    scenes = sorted(folder.glob("*.json"))
    failed = 0
    for scene in scenes:
        problem = fault(program, scene)
        if problem:
            failed += 1
            print(f"{scene.name}\n  {problem}".encode(errors="backslashreplace").decode())
    for stray in sorted(folder.glob("*.expected")):
        if not stray.with_suffix(".json").exists():
            failed += 1
            print(f"{stray.name} has no scene beside it")
    print(f"{len(scenes) - failed} passed, {failed} failed")
    return 1 if failed or not scenes else 0


if __name__ == "__main__":
    sys.exit(main())
