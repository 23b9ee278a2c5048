"""Every conformance check catches the plugin that was broken for it, and no other check does.

usage: check_faulty.py ROULEAU FOLDER SOURCE_FOLDER [TEST...]
FOLDER holds the built plugins as CHECK/NAME/NAME.json, SOURCE_FOLDER their sources. Python's standard library only.
"""

import concurrent.futures
import functools
import json
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PLUGINS, SOURCE = (Path(a).resolve() for a in sys.argv[1:4])
BASES = ["potential", "operator", "spring", "dashpot", "maxwell"]
HONEST = {base: PLUGINS / "honest" / f"honest-{base}" / f"honest-{base}.json" for base in BASES}

# Plugin: the verdict of the check that catches it, and words that say what happened. The check is its folder's name.
EXPECTED = {
    # manifest and library: see also Faults_of_files
    "exports/second-symbol": ("fail", "common_name"),
    "load/aborts": ("crash", "SIGABRT"),
    "load/writes-to-null": ("crash", "SIGSEGV"),
    "load/never-loaded": ("timeout", "did not end"),
    "load/exits": ("crash", "ended the process"),
    "load/exits-in-order": ("crash", "ended the process"),
    "load/flushes-denormals-on-load": ("fail", "the floating-point mode"),
    "load/unresolved-symbol": ("fail", "function_that_nobody_wrote"),
    "open/refuses-later-hosts": ("fail", "later minor version"),
    "open/another-table": ("fail", "another table"),
    "agreement/another-version": ("fail", "1.0.1"),
    "agreement/another-kind": ("fail", "membrane"),
    "agreement/another-id": ("fail", "the-name-before-the-paper"),
    "create/refuses": ("fail", "the moon is in the wrong quarter"),
    "create/create-crashes": ("crash", "SIGSEGV"),
    "create/changes-directory": ("fail", "the working directory"),
    "create/changes-mask": ("fail", "the file mode mask"),
    "create/changes-locale": ("fail", "the locale"),
    "create/changes-environment": ("fail", "the environment"),
    "create/takes-a-signal": ("fail", "the handler of signal 2"),
    "create/blocks-signals": ("fail", "the mask of signals"),
    "create/limits-files": ("fail", "the limit of resource"),
    "create/is-nice": ("fail", "the priority"),
    "create/leaves-a-daemon": ("fail", "leaves a process behind"),
    "create/create-exits": ("crash", "ended the process"),
    "create/throws-an-int": ("crash", "no std::exception"),
    "create/shared-self": ("fail", "share one self"),
    "compute/compute-crashes": ("crash", "SIGSEGV"),
    "compute/collide-crashes": ("crash", "SIGSEGV"),
    "compute/compute-aborts": ("crash", "SIGABRT"),
    "compute/compute-exits": ("crash", "ended the process"),
    "compute/compute-leaves": ("crash", "ended the process"),
    "compute/exhausts-the-stack": ("crash", "SIGSEGV"),
    "compute/never-ends": ("timeout", "did not end"),
    "compute/throws": ("crash", "out of range"),
    "compute/forgets-an-output": ("fail", "does not write energy"),
    "compute/not-a-number": ("fail", "nan"),
    # physics of collision operators
    "mass/loses-mass": ("fail", "changes the density"),
    "momentum/loses-force": ("fail", "momentum changes by"),
    "velocity/forgets-half-the-force": ("fail", "sum f c + F/2"),
    "equilibrium/always-inertia": ("fail", "inertia off"),
    "stress-relaxation/another-viscosity": ("fail", "of the stress"),
    "symmetry/prefers-x": ("fail", "the axes become"),
    "symmetry/prefers-x-in-space": ("fail", "(D3Q19)"),
    "reductions/another-operator-with-inertia": ("fail", "with and without inertia at velocity 0"),
    "bias/cuts-off": ("fail", "changes in one direction"),
    "precision/another-rate-in-f32": ("fail", "in single and in double precision"),
    # physics of membrane laws
    "gradient/wrong-tension": ("fail", "denergy/dstretch is"),
    "gradient/another-stress": ("fail", "(in three dimensions)"),
    "derivatives/wrong-stiffness": ("fail", "dtension/dstretch is"),
    "rest-state/under-stress": ("warn", "under stress at rest"),
    "rigid-motion/energy-of-rate": ("fail", "the energy depends on the rate"),
    "moduli/buckles": ("fail", "negative"),
    "clamped/another-sheet": ("fail", "clamped at the stretch"),
    "dissipation/negative-viscosity": ("fail", "negative tension_by_rate"),
    "dissipation/negative-area-viscosity": ("fail", "negative area_viscosity"),
    "closed-loop/dissipates-as-conservative": ("fail", "a closed cycle takes the work"),
    "degenerate/crushed": ("fail", "energy is"),
    "state-restored/ages-while-looked-at": ("fail", "a time step of 0 changes state.0"),
    "look-after-step/force-of-the-way": ("fail", "computed from the state after it"),
    "half-steps/root-of-time": ("fail", "two of half its length differ from it by"),
    "settles/ages-without-end": ("fail", "goes on changing while nothing moves"),
    # physics of every kind
    "fluid-independent/stiffer-with-inertia": ("fail", "inertia"),
    "fluid-independent/softer-in-thin-fluids": ("fail", "relaxation rate"),
    "units/lattice-length": ("fail", "on one lattice"),
    "roles/twice-the-modulus": ("fail", "has the role stretching_modulus"),
    "roles/reaches-half-way": ("fail", "has the role cutoff"),
    "reference/another-number": ("fail", "the manifest's /checks/0 says"),
    # physics of interactions
    "gradient/wrong-derivative": ("fail", "-denergy/ddistance is"),
    "derivative/wrong-sign": ("fail", "dforce/ddistance is"),
    "cutoff/breaks-off": ("fail", "at the cutoff of"),
    "near-zero/infinite-core": ("fail", "energy is inf at distance"),
    "energy-optional/another-force-without-energy": ("fail", "without and with the energy, force["),
    "energy-optional/needs-energy": ("crash", "SIGSEGV"),
    # robustness
    "hidden-state/counts-calls": ("fail", "the same call twice"),
    "hidden-state/ends-with-another": ("fail", "after the end of another instance"),
    "bounds/reads-past-the-end": ("fail", "read 0 bytes behind the end of the input distance"),
    "bounds/writes-past-the-end": ("fail", "wrote 0 bytes behind the end of the output energy"),
    "bounds/writes-before-the-beginning": ("fail", "wrote 8 bytes before the output energy"),
    "bounds/reads-behind-its-instance": ("fail", "behind what was allocated for it"),
    "bounds/writes-behind-its-instance": ("fail", "behind what was allocated for it"),
    "struct-size/appended-block-field": ("fail", "behind the end of the block's struct"),
    "struct-size/appended-setup-field": ("fail", "behind the end of the setup's struct"),
    "parameters/create-throws": ("crash", "stiffness must be positive"),
    "parameters/trusts-limits": ("crash", "SIGABRT"),
    "parameters/trusts-names": ("crash", "SIGSEGV"),
    "parameters/trusts-numbers": ("crash", "SIGSEGV"),
    "declared-inputs/reads-undeclared": ("fail", "normal_velocity"),
    "needs-matter/ignores-an-input": ("warn", "normal_velocity"),
    "read-only-inputs/writes-back": ("fail", "wrote to the input distance"),
    "outputs-optional/another-energy-without-force": ("fail", "energy["),
    "outputs-optional/needs-derivative": ("crash", "SIGSEGV"),
    "outputs-optional/needs-velocity-in-space": ("crash", "SIGSEGV (D3Q19)"),
    "blocks/position-in-block": ("fail", "energy["),
    "blocks/size-of-block": ("fail", "each element by itself"),
    "aliasing/writes-before-reading": ("fail", "outputs over inputs"),
    "contained/nan-spreads": ("fail", "with the value nan changes force["),
    "contained/denormals-trap": ("crash", "SIGABRT"),
    "nan-out/clamps": ("warn", "though it depends on it"),
    "parameters-matter/ignores-a-parameter": ("warn", "offset"),
    "threads/shared-buffer": ("fail", "wrong results"),
    "floating-point-mode/rounds-upward": ("fail", "compute changes the floating-point mode"),
    "quiet/allocates": ("fail", "allocations of one call"),
    "quiet/allocates-in-space": ("fail", "(in three dimensions)"),
    "quiet/prints": ("fail", "system call: write"),
    "quiet/reads-the-clock": ("fail", "reads the clock"),
    "system-calls/reads-a-file": ("fail", "in its function create"),
    "system-calls/create-prints": ("fail", "write"),
    "system-calls/reads-when-loaded": ("fail", "that runs when it is loaded"),
    "system-calls/destroy-changes-directory": ("fail", "chdir"),
    "traces/create-seeds-rand": ("fail", "random numbers"),
    "traces/destroy-changes-environment": ("fail", "destroy changes the environment"),
    "traces/writes-at-the-end": ("fail", "that runs when the program ends"),
    "memory/counts": ("fail", "a variable of libcounts.so"),
    "memory/counts-by-thread": ("fail", "a thread-local variable"),
    "memory/changes-its-instance": ("fail", "such as its instance"),
    "traces/draws-a-number": ("fail", "random numbers"),
    "memory/remembers-large-calls": ("fail", "a variable of libremembers-large-calls.so"),
    "surroundings/asks-the-environment": ("fail", "other are"),
    "surroundings/depends-on-the-date": ("fail", "other are"),
    "surroundings/depends-on-an-address": ("fail", "other are"),
    "surroundings/reads-new-memory": ("fail", "other are"),
    "leaks/forgets-a-part": ("fail", "pieces of memory left"),
    "fuzz/rare-input": ("crash", "SIGSEGV"),
    # speed
    "budget/slower-than-claimed": ("fail", "nanoseconds of one element"),
}


def conform(*manifests, **limits):
    """Exit code and JSON of rouleau conform; SEED in the environment repeats a run."""
    options = [f"--{name}={value}" for name, value in limits.items()]
    if "SEED" in os.environ:
        options.append(f"--seed={os.environ['SEED']}")
    result = subprocess.run([PROGRAM, "conform", *map(str, manifests), "--json", *options], capture_output=True,
                            text=True, timeout=800)
    if not result.stdout:
        raise AssertionError(f"rouleau conform printed nothing: exit code {result.returncode}, {result.stderr}")
    return result.returncode, json.loads(result.stdout)


@functools.cache
def honest(base):
    """Checks of the honest plugin of a base, by name."""
    _, report = conform(HONEST[base])
    return {check["name"]: check for check in report["plugins"][0]["checks"]}


def base_of(name):
    """The base that the source of a plugin includes."""
    source, = SOURCE.glob(f"{name}.c*")
    return re.search(r'#include "(\w+)\.h"', source.read_text())[1]


def stands(check):
    return check["verdict"] in ("pass", "warn")


class Case(unittest.TestCase):
    def assert_caught(self, plugin, base, by, verdict, words):
        """That this check alone has a bad verdict, and that all that builds on it is skipped and nothing else."""
        checks = {check["name"]: check for check in plugin["checks"]}
        caught = checks[by]
        told = json.dumps({name: (check["verdict"], check["what"]) for name, check in checks.items()
                           if check["verdict"] not in ("pass", "skip") or name == by}, indent=1)
        self.assertEqual(caught["verdict"], verdict, told)
        self.assertIn(words, caught["what"] + caught.get("output", ""), told)
        blocked = set()
        for name, check in checks.items():
            if name == by:
                if not stands(check):
                    blocked.add(name)
            elif blocked & set(check["after"]):
                self.assertEqual(check["verdict"], "skip", f"{name} builds on {by}\n{told}")
                self.assertIn(check.get("blocked_by"), blocked, name)
                blocked.add(name)
            elif plugin["kind"]:
                # A manifest of its own may claim more, to which a check then applies.
                alike = honest(base)[name]
                self.assertIn(check["verdict"], (alike["verdict"], "pass"),
                              f"{name} should not mind what {by} catches: {check['what']}\n{told}")
                self.assertNotIn("blocked_by", check, name)


class Each_check_catches_its_plugin(Case):
    def run_all(self, names, judge, **further):
        """Asks `judge` of each plugin, with its verdict and words that are expected. `further`: options, of a name."""
        with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
            def run(name):
                manifest = PLUGINS / name / (Path(name).name + ".json")
                options = {key: of(name) for key, of in further.items()}
                return conform(manifest, **options, **({"timeout": 3} if EXPECTED[name][0] == "timeout" else {}))
            for name, (code, report) in zip(names, pool.map(run, names)):
                with self.subTest(name, seed=report["seed"]):
                    verdict, words = EXPECTED[name]
                    self.assertEqual(code, 0 if verdict == "warn" else 3)
                    self.assertEqual(report["conforms"], verdict == "warn")
                    judge(name, report["plugins"][0], verdict, words)

    def test_alone(self):
        def judge(_, plugin, verdict, words):
            check, = plugin["checks"]
            self.assertEqual(check["verdict"], verdict, check["what"])
            self.assertIn(words, check["what"] + check.get("output", ""))
        self.run_all(list(EXPECTED), judge, only=lambda name: name.split("/")[0])

    def test_and_no_other_check_does(self):
        """Of a fourth of them, others in each run of the tests, since all checks of one take a second and a half; of all with
        ALL in the environment."""
        names = list(EXPECTED)
        if "ALL" not in os.environ:
            names = random.sample(names, len(names) // 4)
        self.run_all(names, lambda name, plugin, verdict, words: self.assert_caught(
            plugin, base_of(name), name.split("/")[0], verdict, words))

    def test_every_source_is_run(self):
        sources = {f"{file.parent.name}/{file.stem}" for file in SOURCE.glob("*/*.c*")}
        self.assertEqual({name for name in sources if not name.startswith("honest/")}, set(EXPECTED))

    def test_every_check_has_a_plugin_that_it_must_catch(self):
        checks = {name for base in BASES for name in honest(base)}
        broken_for = {name.split("/")[0] for name in EXPECTED} | {"manifest", "library"}
        self.assertEqual(checks - broken_for, set(), "add a plugin to tests/faulty for each")
        self.assertEqual(broken_for - checks, set(), "no such check")


class Nothing_is_wrong_with_the_honest_plugins(Case):
    def test_they_conform_without_a_warning(self):
        for base in BASES:
            with self.subTest(base):
                minded = {name: (check["verdict"], check["what"]) for name, check in honest(base).items()
                          if check["verdict"] not in ("pass", "skip") or "blocked_by" in check}
                self.assertEqual(minded, {})


class Honest_models_that_are_hard_to_judge(Case):
    """Terms that cancel at the cutoff and round alike near it; states of which one is what is left of sums with another."""

    def test_conform(self):
        for name in ("honest-cosine", "honest-catch-bond"):
            with self.subTest(name):
                code, report = conform(PLUGINS / "honest" / name / f"{name}.json", level="publish")
                self.assertEqual(code, 0, [check for check in report["plugins"][0]["checks"]
                                           if check["verdict"] not in ("pass", "skip")])


class A_check_starts_quickly(Case):
    """Some thousand of them are started here alone."""

    def test_without_the_libraries_of_a_run(self):
        program = PROGRAM.parent.parent / "libexec/rouleau/conform-check"
        loaded = subprocess.run(["ldd", program], capture_output=True, text=True, check=True).stdout
        self.assertIn("libudunits2", loaded)
        self.assertNotIn("libhdf5", loaded)  # 34 more, half of the time of a short check


class Publishing(Case):
    """Level publish: all other levels without a warning, and reference numbers for all that a model has."""

    def reasons(self, manifest):
        code, report = conform(manifest, level="publish")
        self.assertEqual(code, 0 if report["conforms"] else 3)
        checks = report["plugins"][0]["checks"]
        return {check["name"]: check["what"] for check in checks if check["verdict"] not in ("pass", "skip")}

    def test_honest_models_may_be_published(self):
        for base in BASES:
            with self.subTest(base):
                self.assertEqual(self.reasons(HONEST[base]), {})

    def test_manifests_that_say_too_little_may_not(self):
        faults = [
            ("potential", '"checks"', '"x-checks"', "reference", "no reference numbers"),
            ("potential", '"force": 0.5,', "", "pinned", "says anything of force"),
            ("operator", '"inertia": true', '"inertia": false', "reference", "the manifest's /checks/"),
            ("maxwell", '"time_step": 0.05,', "", "reference", "the manifest's /checks/"),
            ("spring", '"reproducible": true', '"reproducible": false', "hidden-state", "claims not to be reproducible"),
        ]
        for base, text, other, by, words in faults:
            with self.subTest(base, text=text), tempfile.TemporaryDirectory() as folder:
                copied = Path(shutil.copytree(HONEST[base].parent, Path(folder) / base)) / HONEST[base].name
                manifest = copied.read_text()
                self.assertIn(text, manifest)
                copied.write_text(manifest.replace(text, other))
                self.assertIn(words, self.reasons(copied)[by])


class Faults_of_files(Case):
    """Faults that are in no source: of manifests, and of the file of a library."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.path = Path(folder.name)

    def copy(self, folder):
        """A copy of the honest potential: its manifest and its library."""
        copied = Path(shutil.copytree(HONEST["potential"].parent, self.path / folder))
        return copied / HONEST["potential"].name, copied / "libhonest-potential.so"

    def assert_one_caught(self, manifest, by, words):
        code, report = conform(manifest)
        self.assertEqual(code, 3)
        self.assert_caught(report["plugins"][0], "potential", by, "fail", words)

    def test_manifests(self):
        faults = {"library-path-leads-out": "library", "unknown-key": "homepage", "default-outside-limits": "must be above 0"}
        self.assertEqual({file.stem for file in (SOURCE / "manifest").iterdir()}, set(faults))
        for name, words in faults.items():
            with self.subTest(name):
                self.assert_one_caught(SOURCE / "manifest" / f"{name}.json", "manifest", words)

    def test_two_plugins_with_one_id(self):
        manifests = [self.copy(folder)[0] for folder in ("one", "another")]
        code, report = conform(*manifests)
        self.assertEqual(code, 3)
        for plugin in report["plugins"]:
            self.assert_caught(plugin, "potential", "manifest", "fail", str(manifests[1]))

    def test_no_library(self):
        manifest, library = self.copy("plugin")
        library.unlink()
        self.assert_one_caught(manifest, "library", "does not exist")

    def test_a_library_that_is_a_link_out_of_its_folder(self):
        manifest, library = self.copy("plugin")
        library.rename(self.path / library.name)
        library.symlink_to(self.path / library.name)
        self.assert_one_caught(manifest, "library", "leads out of the folder")

    def test_a_library_for_another_processor(self):
        manifest, library = self.copy("plugin")
        with library.open("r+b") as file:
            file.seek(18)  # e_machine of the ELF header
            file.write((243).to_bytes(2, sys.byteorder))  # RISC-V
        self.assert_one_caught(manifest, "library", "another kind of processor")

    def test_a_library_that_is_cut_short(self):
        manifest, library = self.copy("plugin")
        whole = library.read_bytes()
        for size, words in [(len(whole) // 2, "cut short"), (10, "not an ELF file"), (0, "not an ELF file")]:
            with self.subTest(size):
                library.write_bytes(whole[:size])
                self.assert_one_caught(manifest, "library", words)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]])
