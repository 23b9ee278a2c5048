#!/usr/bin/env python3
"""How many wrong plugins rouleau conform finds, and whether it ever refuses an honest one.

usage: score.py ROULEAU BUILD_FOLDER [--only CLASS] [--sample N] [--honest RUNS] [--seed N] [--list]

Mutants are honest plugins with one piece of text replaced. Those of mutants/*.json were thought of, class by class (in
manifests too); those of the class "formulas" are all that a rule makes of the shipped models' sources: another operator,
another constant, a sign less. Those of the class "space" are every fourth of these again, wrong in three dimensions only,
where the plugin works in both. Each is compiled and held against `rouleau conform --level publish`; it is found when that
does not conform. A mutant that does not compile, or whose results are the same bits as before (equivalent.json), does not
count; one that is known to be missed (known.json) does. --sample N: N mutants of each class, but those, and 4 N runs of
honest models, chosen by a seed that is printed; one mutant in ten may be missed, at least one. --honest: runs of honest
models.
Python's standard library only.
"""

import argparse
import concurrent.futures
import functools
import json
import os
import random
import re
import subprocess
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

HERE = Path(__file__).resolve().parent
ROOT = HERE.parent.parent
BASES = ROOT / "tests" / "faulty" / "base"
EXAMPLES = [Path("sdk/examples/morse-in-c/morse-in-c.c"), Path("sdk/examples/logarithmic-spring/logarithmic-spring.cpp")]


class Source:
    """An honest plugin: its text, with the base that it includes, and its manifest."""

    def __init__(self, path):
        self.path = ROOT / path
        self.text = self.path.read_text()
        self.language = self.path.suffix[1:]
        base = re.search(r'#include "(\w+)\.h"\n', self.text)
        if base:
            for include in (base[1], "law", "create"):
                self.text = self.text.replace(f'#include "{include}.h"\n', (BASES / f"{include}.h").read_text(), 1)
            own = self.path.with_suffix(".json")
            self.manifests = [own if own.exists() else BASES / f"{base[1]}.json"]
        else:
            self.manifests = sorted(self.path.parent.glob("*.json"))


def listed_mutants():
    for file in sorted(HERE.glob("*.json")):
        if file.name in ("equivalent.json", "known.json"):
            continue
        for group in json.loads(file.read_text()):
            for name, *change in group["mutants"]:
                if "around" in group:
                    change = [group["find"], group["around"].replace("@", change[0])]
                yield {"class": group["class"], "source": group["source"], "name": name, "find": change[0],
                       "replace": change[1], "headers": group.get("headers", []), "in": group.get("in", "source")}


SWAPS = {" + ": " - ", " - ": " + ", " * ": " / ", " / ": " * ", " += ": " -= ", " < ": " > ", " > ": " < ",
         " >= ": " < ", " == ": " != "}


def formula_mutants():
    """Every operator exchanged and every constant changed in the shipped models, a rule without favourites."""
    for path in sorted((ROOT / "plugins").glob("*/*/*.cpp")):
        source = path.relative_to(ROOT).as_posix()
        place = 0
        for line in path.read_text().splitlines(keepends=True):
            start, place = place, place + len(line)
            code = line.split("//")[0]
            if re.match(r"\s*(#|throw|template|using|static_assert|ROULEAU|constexpr int opposite)", code) or '"' in code:
                continue
            for match in re.finditer(r" (?:\+|-|\*|/|\+=|<|>|>=|==) |(?<=[ (])-(?=[A-Za-z(])|(?<![\w.])\d+\.\d+(?:e-?\d+)?",
                                     code):
                token = match[0]
                new = SWAPS.get(token) or ("" if token == "-" else f"({token} * 1.001 + 1e-4)")
                if token in (" < ", " > ") and ("template" in code or "<S" in code or "i <" in code):
                    continue
                yield {"class": "formulas", "source": source, "at": start + match.start(), "find": token,
                       "replace": new, "name": f"{path.stem}-{start + match.start()}"}


def in_space(mutants):
    """The same of plugins for both dimensions, wrong in three only: what happens there is the mutant's, what happens in
    two is that of the honest plugin."""
    for mutant in mutants:
        source = Source(mutant["source"])
        manifests = [json.loads(file.read_text()) for file in source.manifests]
        both = all(m.get("dimensions", [2, 3] if m["kind"] == "interaction" else []) == [2, 3] or
                   len(m.get("lattices", [])) == 2 for m in manifests)
        if "spring" in mutant["source"] or mutant.get("at", 1e9) < source.text.find("Triangle<S>"):
            continue  # what is changed is met in two dimensions only
        loaded = mutant["name"].startswith(("load", "constructor", "open", "exit"))  # where there is no dimension yet
        if both and len(manifests) == 1 and mutant.get("in") != "manifest" and not loaded:
            yield {**mutant, "class": "space", "name": mutant["name"] + "-in-space", "space": True}


def replaced(text, mutant):
    """The text with each piece of it replaced once."""
    if "at" in mutant:
        at = mutant["at"]
        return text[:at] + mutant["replace"] + text[at + len(mutant["find"]):]
    pairs = zip(mutant["find"], mutant["replace"]) if isinstance(mutant["find"], list) else [
        (mutant["find"], mutant["replace"])]
    for find, replace in pairs:
        if find not in text:
            raise SystemExit(f"{mutant['name']}: {mutant['source']} does not hold {find!r}")
        text = text.replace(find, replace, 1)
    return text


def build(folder, source, mutant):
    """Compiles a mutant, or the honest plugin, into a folder, with its manifests; the manifests' paths, or None."""
    text, in_manifest = source.text, mutant and mutant.get("in") == "manifest"
    if mutant and not in_manifest:
        text = "".join(f"#include <{name}>\n" for name in mutant.get("headers", [])) + replaced(text, mutant)
    code = folder / ("mutant." + source.language)
    code.write_text(text)
    manifests, library = [], None
    for file in source.manifests:
        manifest = file.read_text().replace("@name@", "mutant")
        library = json.loads(manifest)["library"]
        manifests.append(folder / (json.loads(manifest)["id"] + ".json"))
        manifests[-1].write_text(replaced(manifest, mutant) if in_manifest else manifest)
    compiler = ["cc", "-std=gnu11", "-DPLUGIN_ID=\"mutant\""]
    if source.language == "cpp":
        compiler = ["c++", "-std=c++20", f"-Wl,--version-script={ROOT}/sdk/cmake/rouleau-plugin.map"]
    flags = ["-O2", "-w", "-D_GNU_SOURCE", "-fPIC", "-pthread", "-fvisibility=hidden", "-fno-math-errno",
             "-fno-trapping-math", "-I", str(ROOT / "sdk" / "include")]

    def run(*words):
        done = subprocess.run(["nice", *(["ccache"] if os.environ.get("CCACHE_DIR") else []), *map(str, words)],
                              capture_output=True, text=True)
        if done.returncode != 0 and VERBOSE:
            print(done.stderr[:600])
        return done.returncode == 0

    parts = [code]
    if mutant and mutant.get("space"):
        honest = folder / ("honest." + source.language)
        honest.write_text(source.text)
        # A C++ type of the same name would be one to the linker.
        types = re.findall(r"ROULEAU_[A-Z]+\((\w+),", source.text)
        renamed = {code: ["-Drouleau_open_v1=open_mutant", *(f"-D{name}={name}Mutant" for name in types)],
                   honest: ["-Drouleau_open_v1=open_honest"]}
        if not all(run(*compiler[:3], *flags, *words, "-c", file, "-o", f"{file}.o") for file, words in renamed.items()):
            return None
        glue = HERE / "in_space.c"
        if not run("cc", *flags, "-c", glue, "-o", folder / "glue.o"):
            return None
        parts = [folder / "glue.o", *(f"{file}.o" for file in renamed)]
        compiler = ["c++", f"-Wl,--version-script={ROOT}/sdk/cmake/rouleau-plugin.map"]
    return manifests if run(*compiler, *flags, "-shared", *parts, "-o", folder / library, "-lm") else None


def verdict(manifests, seed, publish=True, only=(), timeout=30):
    """The first check that a manifest does not pass, with its words; None when all conform."""
    command = ["nice", str(ROULEAU), "conform", *map(str, manifests), "--seed", str(seed), "--timeout", str(timeout),
               *(["--level", "publish"] if publish else []), *(f"--only={name}" for name in only)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True) as process:
        for line in process.stdout:
            match = re.match(r" {4}(fail|crash|timeout) +(\S+) +(.*)", line)
            if match:
                process.terminate()
                return match[2], match[3]
    return None if process.returncode == 0 else ("conform", f"exit code {process.returncode}")


@functools.cache
def conforms(path, seed):
    """That the unchanged plugin, built in the same way, conforms; without it nothing that is found means anything."""
    with tempfile.TemporaryDirectory() as folder:
        found = verdict(build(Path(folder), Source(path), None), seed)
        if found:
            print(f"  FALSE ALARM {path}, unchanged: {found[0]}: {found[1]}", flush=True)
        return not found


def try_mutant(mutant, seed):
    source = Source(mutant["source"])
    if not conforms(mutant["source"], seed):
        return None
    with tempfile.TemporaryDirectory() as folder:
        manifests = build(Path(folder), source, mutant)
        return "does not compile" if manifests is None else verdict(manifests, seed)


def score(mutants, seed, jobs):
    table, missed = defaultdict(lambda: [0, 0]), []
    by_check = defaultdict(int)
    with concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        for mutant, found in zip(mutants, pool.map(lambda m: try_mutant(m, seed), mutants)):
            if found == "does not compile":
                print(f"  {mutant['name']}: {found}", flush=True)
                continue
            table[mutant["class"]][0] += 1
            if found:
                table[mutant["class"]][1] += 1
                by_check[found[0]] += 1
                if VERBOSE:
                    print(f"  {mutant['class']} {mutant['name']}: {found[0]}: {found[1][:100]}", flush=True)
            else:
                missed.append(mutant)
                print(f"  MISSED {mutant['class']} {mutant['name']} ({mutant['source']}): {mutant['find']!r} -> "
                      f"{mutant['replace']!r}", flush=True)
    print("| class | mutants | found | missed |\n|---|---|---|---|")
    for name, (tried, found) in sorted(table.items()):
        print(f"| {name} | {tried} | {found} | {tried - found} |")
    tried, found = (sum(row[k] for row in table.values()) for k in (0, 1))
    print(f"| all | {tried} | {found} ({100 * found / max(tried, 1):.1f} %) | {tried - found} |")
    print("found by:", ", ".join(f"{name} {count}" for name, count in sorted(by_check.items(), key=lambda x: -x[1])))
    return missed


def templates(folder):
    """The sources of what rouleau new makes, of every kind and for each dimension."""
    kinds = [("collision",), ("interaction",), *(("membrane", "--dimensions", number) for number in ("2", "3", "both"))]
    for words in kinds:
        name = "template-" + "-".join(word for word in words if not word.startswith("--"))
        subprocess.run([ROULEAU, "new", words[0], name, *words[1:], "--dir", folder], stdout=subprocess.DEVNULL, check=True)
        yield folder / name / f"{name}.cpp"


def honest(build_folder, runs, seed, jobs):
    """The shipped models, the honest ones that the faulty are made of, those of the first release, the SDK's examples,
    what rouleau new makes. One run in ten has the check of threads, which takes as long as all others."""
    shown = subprocess.run([ROULEAU, "conform", "--help"], capture_output=True, text=True, check=True).stdout
    quick = set(re.findall(r"^    ([a-z0-9-]+) +\S", shown, re.M)) - {"threads"}
    shipped = sorted((build_folder / "lib" / "rouleau" / "plugins").glob("*/*/*.json"))
    shipped += sorted((build_folder / "tests" / "faulty" / "plugins" / "honest").glob("*/*.json"))
    others = sorted((build_folder / "tests" / "abi" / "frozen-1.0").glob("*.json"))
    wrong = 0
    with tempfile.TemporaryDirectory() as folder, concurrent.futures.ThreadPoolExecutor(jobs) as pool:
        sources = [*EXAMPLES, *templates(Path(folder))]
        files = [(file, True) for file in shipped] + [(file, False) for file in [*others, *sources]]
        tries = [(*files[(seed + i) % len(files)], seed + i) for i in range(runs)]
        built = {}
        for path in sorted({file for file, *_ in tries} & set(sources)):
            place = Path(folder) / "built" / path.stem
            place.mkdir(parents=True)
            built[path], = build(place, Source(path), None)

        def run(tried):
            file, publish, number = tried
            file = built.get(file, file)
            only = (quick if publish else quick - {"pinned"}) if number % 10 else ()
            return verdict([file], number, publish, only, timeout=900)  # a busy machine is no fault of the model
        for done, ((file, publish, number), found) in enumerate(zip(tries, pool.map(run, tries))):
            if done % 500 == 499:
                print(f"  {done + 1} runs, {wrong} false alarms before", flush=True)
            if found:
                wrong += 1
                level = " --level publish" if publish else ""
                print(f"  FALSE ALARM {file} --seed {number}{level}: {found[0]}: {found[1]}", flush=True)
    print(f"honest: {runs} runs of {len(files)} models, {wrong} false alarms")
    return wrong


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("rouleau", type=Path)
    parser.add_argument("build", type=Path)
    parser.add_argument("--only", help="mutants of this class")
    parser.add_argument("--every", type=int, default=9, help="of the class formulas, each N-th")
    parser.add_argument("--sample", type=int, default=0, metavar="N")
    parser.add_argument("--honest", type=int, default=0, metavar="RUNS")
    parser.add_argument("--seed", type=int, default=int.from_bytes(os.urandom(3), "big"))
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--list", action="store_true")
    parser.add_argument("--verbose", action="store_true")
    options = parser.parse_args()
    global ROULEAU, VERBOSE
    ROULEAU, VERBOSE = options.rouleau.resolve(), options.verbose
    print(f"seed {options.seed}", flush=True)
    equivalent = json.loads((HERE / "equivalent.json").read_text())
    listed, formulas = list(listed_mutants()), list(formula_mutants())
    mutants = listed + formulas[::options.every] + list(in_space(listed + formulas[4::options.every]))[::4]
    mutants = [m for m in mutants if not {m["name"], m["name"].removesuffix("-in-space")} & set(equivalent) and
               options.only in (None, m["class"])]
    if options.list:
        print("\n".join(f"{m['class']} {m['name']}" for m in mutants))
        return 0
    if options.sample:
        rng = random.Random(options.seed)
        known = json.loads((HERE / "known.json").read_text())
        classes = defaultdict(list)
        for mutant in mutants:
            if mutant["name"] not in known:
                classes[mutant["class"]].append(mutant)
        chosen = [m for _, of_class in sorted(classes.items()) for m in rng.sample(of_class, options.sample)]
        missed = score(chosen, options.seed, options.jobs)
        alarms = honest(options.build, 4 * options.sample, options.seed, options.jobs)
        return 1 if alarms or len(missed) > max(1, len(chosen) // 10) else 0
    if options.honest:
        return 1 if honest(options.build, options.honest, options.seed, options.jobs) else 0
    return 1 if len(score(mutants, options.seed, options.jobs)) > 0.05 * len(mutants) else 0


if __name__ == "__main__":
    sys.exit(main())
