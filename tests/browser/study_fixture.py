"""Results of a study and of limits as `rouleau study` and `rouleau limits` write them, made up for the tests of their pages: errors fall
with a power of the resolution, times grow with another, some points fail, some numbers are not defined."""
import itertools
import math
import random

MARKUP = "</script><script>document.title = 'broken out'</script><!-- <img src=x onerror=\"document.title='broken out'\">"


def timing(seconds, chance):
    every = [seconds * chance.uniform(0.97, 1.09) for _ in range(3)]
    return {"median": sorted(every)[1], "least": min(every), "most": max(every), "all": every}


def no_time():
    return {"median": None, "least": None, "most": None, "all": []}


def failure(reason, message, remedy, step=None):
    return {"reason": reason, "step": step, "message": message, "remedy": remedy}


def study(resolutions=(5, 10, 20, 30, 40), taus=("0.6", "0.8", "1", "2"), schemes=("plain", "corrected"), title="Capsule in shear: deformation and area"):
    """Two quantities over resolution x tau x scheme: one measured against Richardson's limit, one against zero."""
    chance = random.Random(1)
    exact, order = 0.23861, {"plain": 1.1, "corrected": 2.0, "twice corrected": 2.4}
    points = []
    for number, (n, tau, scheme) in enumerate(itertools.product(resolutions, taus, schemes)):
        labels = {"resolution": str(n), "tau": tau, "scheme": scheme}
        error = (0.35 if scheme == "plain" else 0.45) * (10 / n) ** order[scheme] * 0.1 * (0.6 + 0.4 * float(tau))
        time = 0.9 * (n / 10) ** 3.1 / (float(tau) - 0.45) * (1.15 if scheme == "corrected" else 1)
        drift = 2e-3 * (10 / n) ** 2 * float(tau)
        point = {"id": number, "labels": labels, "directory": f"points/{number:016x}", "status": "completed", "failure": None, "not_deterministic": None, "wall_s": timing(time, chance),
                 "cpu_s": timing(time * 1.04 + 0.05, chance), "steps": round(400 * (n / 10) ** 2 / (float(tau) - 0.45)), "peak_rss_bytes": round(3e7 + 6e4 * n * n), "threads": 1,
                 "passes": [{"name": name, "wall_s": time * share} for name, share in
                            (("collide and stream", 0.52), ("spread forces", 0.17), ("interpolate velocity", 0.15), ("membrane forces", 0.11), ("output", 0.05))],
                 "results": {"deformation": {"value": exact * (1 + error), "error": error, "deviation": error, "uncertainty": 0.0004, "why_not": None},
                             "area drift": {"value": drift, "error": drift, "deviation": drift, "uncertainty": 0, "why_not": None}}}
        if tau == "0.6" and n >= 30:
            point.update(status="diverged", steps=812, wall_s=timing(0.4, chance), cpu_s=timing(0.5, chance), failure=failure(
                "node_step", "Node 17 of cell 0 would move by 1.4 lattice spacings in one step.", "Lower density_factor, or raise tau to 0.8.", 812))
        elif tau == "2" and n == 5 and scheme == "corrected":
            point.update(status="refused", steps=None, wall_s=no_time(), cpu_s=no_time(), passes=[], failure=failure(
                "refused", "the corrected walls want at least 8 nodes between cell and wall; there are 5", "refine the grid"))
        elif tau == "1" and n == max(resolutions) and scheme == "plain":
            point.update(status="timed_out", steps=20000, passes=[], cpu_s=no_time(), failure=failure("timed_out", "stopped after 10 min", "raise time_limit", 20000))
        if point["status"] != "completed":
            point["results"] = {name: {"value": None, "error": None, "deviation": None, "uncertainty": None, "why_not": f"the run {point['status'].replace('_', ' ')}"}
                                for name in point["results"]}
        elif n == 5 and tau == "0.8":
            point["results"]["deformation"] = {"value": None, "error": None, "deviation": None, "uncertainty": None, "why_not": "strain 2 was not reached: the run ended at strain 1.4"}
        points.append(point)
    points[1]["not_deterministic"] = "cells.csv of repeat 2 differs from that of repeat 1"
    quantities = [
        {"name": "deformation", "kind": "deformation", "unit": "", "error": "relative", "target": 0.05,
         "reference": {"kind": "richardson", "value": exact, "uncertainty": 0.0004 * exact, "order": 2.02, "source": f"finest three of tau 0.8, corrected {MARKUP}",
                       "points": [p["id"] for p in points if p["labels"]["tau"] == "0.8" and p["labels"]["scheme"] == "corrected"][-3:], "why_not": None},
         "by_method": [{"method": {"tau": tau, "scheme": scheme}, "order": None if tau == "0.6" else order[scheme] + 0.02, "limit": None if tau == "0.6" else exact,
                        "uncertainty": None if tau == "0.6" else 0.0003, "points": [], "why_not": "two of the finest three points failed" if tau == "0.6" else None}
                       for tau in taus for scheme in schemes],
         "disagreement": "The methods disagree about deformation: tau 2, scheme plain tends to 0.2461 +- 0.0003, tau 0.8, scheme corrected tends to 0.2386 +- 0.0003, further apart than their uncertainties together."},
        {"name": "area drift", "kind": "area_drift", "unit": "", "error": "absolute", "target": 1e-7,
         "reference": {"kind": "analytic", "value": 0, "uncertainty": 0, "order": None, "source": "zero", "points": [], "why_not": None}, "by_method": [], "disagreement": None}]
    cheapest = min((p for p in points if (p["results"]["deformation"]["error"] or 1) < 0.05), key=lambda p: p["wall_s"]["median"])
    return {
        "rouleau_study_result": 1, "title": title, "study_file": "studies/capsule.json", "scene_file": "scenes/capsule.json", "program": "0.1.0-g0123456",
        "program_sha256": "ab" * 32, "machine": {"cpu": "A processor of 2.1 GHz", "cores": 2, "memory_bytes": 8 << 30, "system": "Linux 6.1", "compiler": "g++ 12.2.0"},
        "started": "2026-01-02T03:04:05Z", "finished": "2026-01-02T03:34:05Z", "complete": False,
        "left_out": [{"labels": {"resolution": "60", "tau": "1", "scheme": "plain"}, "why": "--budget 30min", "estimated_s": 700}],
        "axes": [{"name": "resolution", "labels": [str(n) for n in resolutions], "positions": list(resolutions)},
                 {"name": "tau", "labels": list(taus), "positions": [float(t) for t in taus]},
                 {"name": "scheme", "labels": list(schemes), "positions": [None] * len(schemes)}],
        "line": "resolution", "default": {"resolution": "20", "tau": "1", "scheme": "plain"}, "quantities": quantities, "points": points,
        "fronts": {q["name"]: front(points, q["name"]) for q in quantities},
        "knobs": {"deformation": [
            {"axis": "tau", "from": "1", "to": "2", "fixed": {"resolution": "20", "scheme": "plain"}, "error_factor": 1.4, "time_factor": 0.35, "gain": None, "free": True},
            {"axis": "scheme", "from": "plain", "to": "corrected", "fixed": {"resolution": "20", "tau": "1"}, "error_factor": 3.2, "time_factor": 1.15, "gain": 8.4, "free": False},
            {"axis": "resolution", "from": "20", "to": "30", "fixed": {"scheme": "plain", "tau": "1"}, "error_factor": 1.6, "time_factor": 3.5, "gain": 0.36, "free": False}], "area drift": []},
        "sentences": [{"quantity": "deformation", "text": f"To keep the error of deformation below 5 %, take {words(cheapest)}: it runs {cheapest['wall_s']['median']:.2g} s, with an error of 4.9 % +- 0.04 %. The default runs 17 s, 28 times longer, with an error of 1.8 %.",
                       "target": 0.05, "point": cheapest["id"]},
                      {"quantity": "deformation", "text": quantities[0]["disagreement"], "target": None, "point": None},
                      {"quantity": "area drift", "text": "No setting is sure to keep the error of area drift below 1e-07. The nearest is resolution 40, tau 1, scheme corrected: it runs 140 s, with an error of 0.00013.", "target": 1e-7, "point": points[-1]["id"]}],
    }


def words(point):
    return ", ".join(f"{axis} {label}" for axis, label in point["labels"].items())


def front(points, quantity):
    """Numbers of the points than which none is cheaper and better, cheapest first."""
    chosen, best = [], math.inf
    for point in sorted((p for p in points if p["results"][quantity]["error"] is not None), key=lambda p: p["wall_s"]["median"]):
        if point["results"][quantity]["error"] < best:
            best = point["results"][quantity]["error"]
            chosen.append(point["id"])
    return chosen


def large_study():
    """300 points of 60 methods."""
    return study(resolutions=(10, 15, 20, 30, 40), taus=tuple(f"{0.7 + 0.1 * k:.1f}" for k in range(20)), schemes=("plain", "corrected", "twice corrected"),
                 title="Three hundred points")


def small_study():
    """One axis of words, one quantity without a reference, nothing else: what an early end leaves."""
    result = study(resolutions=(20,), taus=("1",), schemes=("plain", "corrected"))
    result.update(title="Two operators", axes=[{"name": "operator", "labels": ["plain", "corrected"], "positions": [None, None]}], line="operator", default={"operator": "plain"},
                  knobs={}, sentences=[], left_out=[], complete=True, fronts={})
    for point in result["points"]:
        point["labels"] = {"operator": point["labels"]["scheme"]}
        point.update(status="completed", failure=None, not_deterministic=None, wall_s=timing(1, random.Random(2)),
                     results={"deformation": {"value": 0.24, "error": None, "deviation": None, "uncertainty": None, "why_not": "there is no reference"}})
    result["quantities"] = [dict(result["quantities"][0], disagreement=None, by_method=[], reference={
        "kind": "richardson", "value": None, "uncertainty": None, "order": None, "source": None, "points": [], "why_not": "Richardson wants three points of a line; there is one"})]
    return result


REASONS = {"plain": "node_step", "semi-implicit": "area_loss", "corrected": "energy_growth"}


def limits(title="Stiffness of the membrane"):
    """The shear modulus's edge for 3 schemes x 3 kernels: one has none, one fails everywhere, two fail at both ends."""
    low, high = 6e-6, 6e-2
    edges = []
    for i, (scheme, kernel) in enumerate(itertools.product(REASONS, ("peskin4", "cosine4", "linear2"))):
        edge = low * (high / low) ** (0.35 + 0.055 * i)
        stops = failure(REASONS[scheme], f"at {edge:.3g} N/m a node moved too far {MARKUP if i == 0 else ''}", "Lower the time step.", 400 + 97 * i)
        labels = {"scheme": scheme, "kernel": kernel}
        values = [low, high, *(edge * f for f in (0.1, 0.4, 0.96, 1.05, 1.8, 12) if low < edge * f < high)]
        if i == 4:
            edges.append(edge_of(labels, high, None, None, [trial(v) for v in values]))
        elif i == 7:
            timed_out = failure("timed_out", "no end within 10 min", None)
            edges.append(edge_of(labels, None, low, timed_out, [trial(v, timed_out, "timed_out") for v in values]))
        else:
            crossing = failure("crossing", "two membranes cross", None, 12)
            both = i in (2, 5)  # fails at both ends: all trials stand with the first edge
            trials = [trial(v, crossing if both and v < low * 3.5 else stops if v > edge else None) for v in values + ([low * 3, low * 4] if both else [])]
            if i == 8:  # a silent failure far below the edge
                trials[2].update(reason="area_loss")
            edges.append(edge_of(labels, edge * 0.96, edge * 1.05, stops, trials, [trials[2]["value"]] if i == 8 else []))
            if both:
                edges.append(edge_of(labels, low * 4, low * 3, crossing, [], direction="below"))
    return {
        "rouleau_limits_result": 1, "title": title, "limits_file": "limits/stiffness.json", "scene_file": "scenes/capsule.json", "program": "0.1.0-g0123456", "program_sha256": "cd" * 32,
        "machine": {"cpu": "A processor of 2.1 GHz", "cores": 2, "memory_bytes": 8 << 30, "system": "Linux 6.1", "compiler": "g++ 12.2.0"},
        "started": "2026-01-02T03:04:05Z", "finished": "2026-01-02T03:34:05Z", "complete": True,
        "sound": {"area_drift": 0.01, "energy_growth": 0.01, "stretch": 3, "mass_drift": 1e-6}, "steps": 20000,
        "axes": [{"name": "scheme", "labels": list(REASONS), "positions": [None] * 3}, {"name": "kernel", "labels": ["peskin4", "cosine4", "linear2"], "positions": [None] * 3}],
        "parameter": {"name": "shear modulus", "pointers": ["/cell_types/rbc/membrane/0/parameters/shear_modulus"], "unit": "N/m", "scale": "log", "from": low, "to": high, "precision": 1.1,
                      "whole": False},
        "edges": edges,
        "warnings": [],
    }


def trial(value, why=None, end="diverged"):
    return {"value": value, "end": end if why else "completed", **{key: why and why[key] for key in ("reason", "step")}}


def edge_of(labels, stable, unstable, why, trials, contradicting=(), direction="above"):
    return {"labels": labels, "direction": direction, "stable_up_to": stable, "unstable_from": unstable, "out_of_order": list(contradicting), "failure": why, "trials": trials}


if __name__ == "__main__":  # study_fixture.py FOLDER: the results as directories, to look at their pages
    import json
    import pathlib
    import sys
    for name, result in {"study": study(), "large": large_study(), "small": small_study(), "limits": limits()}.items():
        folder = pathlib.Path(sys.argv[1]) / name
        folder.mkdir(parents=True, exist_ok=True)
        (folder / ("limits.json" if name == "limits" else "study.json")).write_text(json.dumps(result, allow_nan=False, sort_keys=True))
