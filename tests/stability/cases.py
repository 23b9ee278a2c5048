#!/usr/bin/env python3
"""Extreme cases: each must come to the right answer, or stop with a reason before it writes what is wrong. Some take
minutes, so that no test runs them all; docs/stability.md has what they came to.

usage: cases.py ROULEAU FILE [--out DIR] [--only NAME]

A FILE has a scene (or the name of its file) and changes of it, as the files of `rouleau limits`, bounds of what is sound, and cases: a name, more
changes, the most steps, how it should end (right, stops, either) and what the last row of a table should say.
Exit code 1: one was WRONG or did not end as expected. Python's standard library only.
"""
import argparse
import copy
import csv
import json
import math
import shutil
import subprocess
import sys
from pathlib import Path

BOUNDS = {"area_drift": 0.02, "energy_growth": 0.01, "stretch": 3, "mass_drift": 1e-4}
SECONDS = {"s": 1, "min": 60, "h": 3600}
OF_CELLS = ("x_m", "y_m", "z_m", "deformation", "area_m2", "volume_m3", "perimeter_m", "surface_area_m2")
OF_SERIES = ("mach_max", "mass_drift", "kinetic_energy_J_per_m")


def put(scene, pointer, value):
    *above, last = [int(key) if key.isdigit() else key for key in pointer.strip("/").split("/")]
    for key in above:
        scene = scene.setdefault(key, {}) if isinstance(scene, dict) else scene[key]
    if last == "-":
        scene.append(value)
    else:
        scene[last] = value


def rows_of(folder, table):
    file = folder / f"{table}.csv"
    if not file.exists():
        return []
    with open(file) as text:
        return list(csv.DictReader(text))


def no_number(folder):
    """The first value that is no number where there must be one."""
    for table, columns in (("cells", OF_CELLS), ("series", OF_SERIES)):
        for number, row in enumerate(rows_of(folder, table), 1):
            for column in columns:
                if column in row and not math.isfinite(float(row[column] or "nan")):
                    return f"{column} in row {number} of {table}.csv is {row[column]}"
    return None


def unsound(summary, bounds):
    """What a run that came to its end did not report."""
    def at(first, second):
        value = (summary.get(first) or {}).get(second)
        return math.nan if value is None else value
    values = [("area_drift", at("conservation", "area_drift_max")), ("area_drift", at("conservation", "area_leakage_max")),
              ("energy_growth", at("energy", "largest_growth_at_rest_relative")),
              ("mass_drift", at("conservation", "mass_drift")), ("stretch", at("stretch", "max"))]
    if at("stretch", "min") == at("stretch", "min"):
        values.append(("stretch", 1 / at("stretch", "min")))
    return next((f"{name} is {value:.3g}" for name, value in values if value > bounds[name]), None)


def judged(folder, done, bounds, answer):
    """Verdict and words."""
    garbage = no_number(folder)
    if garbage:
        return "WRONG", garbage
    if done is None:
        return "WRONG", "timed out"
    if done.returncode not in (0, 1, 2):
        return "WRONG", f"exit code {done.returncode}: {done.stderr.strip()}"
    summary = json.loads((folder / "summary.json").read_text()) if (folder / "summary.json").exists() else {}
    if done.returncode:
        reason = (summary.get("failure") or {}).get("reason") or ("refused" if done.returncode == 2 else None)
        return ("stopped with a reason" if reason else "WRONG"), f"{reason}: {done.stderr.strip().splitlines()[-1:]}"
    words = unsound(summary, bounds)
    if not words and answer:
        rows = rows_of(folder, answer["table"])
        if answer["table"] == "cells":
            rows = [row for row in rows if int(row["cell"]) == answer.get("cell", 0)]
        found = float(rows[-1].get(answer["column"], "nan")) if rows else math.nan
        if not abs(found - answer["value"]) <= answer["tolerance"]:
            words = f"{answer['column']} is {found:g}, and should be {answer['value']:g} +- {answer['tolerance']:g}"
    return ("WRONG", words) if words else ("right answer", "sound")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rouleau", type=Path)
    parser.add_argument("file", type=Path)
    parser.add_argument("--out", type=Path, default=Path("runs/cases"))
    parser.add_argument("--only", help="the case of this name")
    given = parser.parse_args()
    whole = json.loads(given.file.read_text())
    number, unit = whole.get("time_limit", "2 min").split()
    bounds, well = {**BOUNDS, **whole.get("sound", {})}, True
    for index, case in enumerate(whole["cases"]):
        if given.only not in (None, case["name"]):
            continue
        scene = copy.deepcopy(whole["scene"])
        if isinstance(scene, str):
            scene = json.loads((given.file.parent / scene).read_text())
        for pointer, value in {**whole.get("set", {}), **case.get("set", {})}.items():
            put(scene, pointer, value)
        folder = given.out / f"{given.file.stem}-{index}"
        shutil.rmtree(folder, ignore_errors=True)
        folder.mkdir(parents=True)
        (folder / "scene.json").write_text(json.dumps(scene))
        steps = case.get("steps", whole.get("steps"))
        try:
            done = subprocess.run([given.rouleau, "run", folder / "scene.json", "--out", folder / "run", "--quiet",
                                   *(["--max-steps", str(steps)] if steps else [])],
                                  capture_output=True, text=True, timeout=float(number) * SECONDS[unit])
        except subprocess.TimeoutExpired:
            done = None
        verdict, words = judged(folder / "run", done, bounds, case.get("answer"))
        fits = {"right": verdict == "right answer", "stops": verdict == "stopped with a reason"}.get(
            case.get("expect", "either"), verdict != "WRONG")
        well = well and fits
        print(f"{case['name']}: {verdict}: {words}" + ("" if fits else f" (NOT AS EXPECTED: {case.get('expect', 'either')})"), flush=True)
    return 0 if well else 1


if __name__ == "__main__":
    sys.exit(main())
