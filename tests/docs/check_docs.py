"""The documentation as its readers use it: its commands are run, its links followed, its options and files looked for.

usage: check_docs.py SOURCE BUILD
"""

import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

sys.dont_write_bytecode = True
SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
sys.path.insert(0, str(SOURCE / "scripts/documentation"))

from page_commands import commands_of  # noqa: E402
from pages import PAGES  # noqa: E402
from site_pages import DOORS, name_of, slug  # noqa: E402

PROGRAM = BUILD / "bin/rouleau"
TEXTS = {page: (SOURCE / page).read_text() for page in PAGES}
# Its commands are run by tests/sdk/check_tutorial.py.
TUTORIAL = "sdk/README.md"
COMMANDS = [c for page, text in TEXTS.items() if page != TUTORIAL for c in commands_of(page, text)]
# Options of programs that are not Rouleau's and that pages name in the text.
FOREIGN = {"--component", "--prefix", "--preset", "--build", "--install", "--parallel", "--pkg-config", "--cflags", "--libs",
           "--tool", "--allow-run-as-root", "--oversubscribe", "--mca", "--bind-to"}
# Words that readers had to read twice, and what is meant. Prose and messages do without them; names of keys are not prose.
STUMBLING = {
    r"told": "reported, given", r"dearer": "slower, more expensive", r"knobs?": "setting", r"lone": "single",
    r"in all(?=[,.;:|)]|\s*$)": "together, total", r"frame of rest": "reference frame", r"obeyed": "followed",
    r"buys": "gains", r"looked at": "checked, read", r"nobody knows": "is not known", r"layers? without cells": "cell-free layer",
    r"garbage": "wrong results",
}
# "for" where "because" is meant begins a clause: "..., for hosts compute it in vain".
CAUSAL_FOR = r"[,;] for (?:it|they|he|we|this|these|that|there|such|hosts|models|cells|membranes|laws) (?!and\b)[a-z]+"
STUMBLING_WORDS = re.compile(rf"\b(?:{'|'.join(STUMBLING)})(?!\w)|{CAUSAL_FOR}", re.IGNORECASE | re.MULTILINE)
LITERAL = re.compile(r'"((?:[^"\\\n]|\\.)*)"|`((?:[^`\\]|\\.)*)`')
NUMBER = re.compile(r"-?\d+(\.\d+)?(e[-+]?\d+)?|\binf\b")


def call(command, folder, environment=None):
    return subprocess.run(["bash", "-c", command], cwd=folder, capture_output=True, text=True, timeout=120,
                          env={**os.environ, **(environment or {})})


def help_of(*words):
    if words not in help_of.known:
        result = subprocess.run([*words, "--help"], cwd=SOURCE, capture_output=True, text=True, timeout=60)
        help_of.known[words] = result.stdout + result.stderr
    return help_of.known[words]


help_of.known = {}


def helps_of_rouleau():
    names = re.findall(r"^  ([a-z]+) [A-Z\[]", help_of(str(PROGRAM)), re.MULTILINE)
    return {name: help_of(str(PROGRAM), name) for name in names}


def without_code(text):
    return re.sub(r"^```.*?^```$|^    .*$", "", text, flags=re.MULTILINE | re.DOTALL)


def has_option(help_text, option):
    return re.search(re.escape(option) + r"(?![a-z-])", help_text) is not None


class Documentation(unittest.TestCase):
    maxDiff = None

    def checkout(self):
        """A folder that looks like the source after the build, but for runs/, which the commands fill."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="rouleau-docs-"))
        self.addCleanup(shutil.rmtree, folder)
        for entry in SOURCE.iterdir():
            if entry.name not in ("build", "runs", "scenes", ".git"):
                (folder / entry.name).symlink_to(entry)
        shutil.copytree(SOURCE / "scenes", folder / "scenes")  # locks are written beside them
        (folder / "build").mkdir()
        (folder / "build/release").symlink_to(BUILD)
        example = re.search(r"^    \{\n.*?^    \}$", TEXTS["docs/scene.md"], re.MULTILINE | re.DOTALL)[0]
        (folder / "one-cell.json").write_text(example)  # docs/scene.md tells its reader to save it
        run = call(f"{PROGRAM} run scenes/four-cells-shear.json --out runs/demo --max-steps 200 --quiet", folder)
        self.assertEqual(run.returncode, 0, run.stderr)  # what scripts/demo would have left
        return folder

    def test_every_command_does_what_its_page_says(self):
        self.assertGreater(len(COMMANDS), 40)  # else they are not found any more
        counts = {"run": 0, "left out": 0}
        environment = {"PATH": f"{BUILD / 'bin'}:{os.environ['PATH']}"}
        for page in PAGES:
            folder = None
            for command in [c for c in COMMANDS if c.page == page]:
                if command.left_out or (command.shown.startswith("python3 examples/") and not self.can_draw()):
                    counts["left out"] += 1
                    continue
                folder = folder or self.checkout()
                with self.subTest(place=f"{page}:{command.line}", command=command.run):
                    result = call(command.run, folder, environment)
                    said = result.stdout + result.stderr
                    self.assertEqual(result.returncode, command.expected, said)
                    # Numbers may differ in the last digit between machines, and how far a line is set in says nothing.
                    lines = [NUMBER.sub("N", line.strip()) for line in said.splitlines()]
                    for line in command.output:
                        self.assertIn(NUMBER.sub("N", line.strip()), lines)
                    counts["run"] += 1
        print(f"docs: {counts['run']} commands run, {counts['left out']} left out")

    @staticmethod
    def can_draw():
        """tests/docs/check_example.py runs the example where its packages are."""
        return subprocess.run(["python3", "-c", "import h5py, pandas, matplotlib"], capture_output=True).returncode == 0

    def test_every_option_of_a_command_exists(self):
        for command in COMMANDS:
            words = command.program
            if words[0] in ("cmake", "ctest", "export", "mkdir", "paraview", "xdg-open"):
                continue
            if words[0].endswith("rouleau"):
                if words[1].startswith("-"):
                    continue  # of the program itself, which has been run
                text = help_of(str(PROGRAM), words[1])
            elif words[0] == "python3":
                text = (SOURCE / words[1]).read_text()
            elif words[0].startswith("build/release/"):
                path = BUILD / words[0].removeprefix("build/release/")
                if not path.exists():
                    continue  # built with another target
                text = help_of(str(path))
            else:
                self.assertTrue(os.access(SOURCE / words[0], os.X_OK), f"{command.page}:{command.line}: {words[0]}")
                text = help_of(str(SOURCE / words[0]))
            for option in command.options:
                self.assertTrue(has_option(text, option), f"{command.page}:{command.line}: {words} has no option {option}")

    def test_every_option_that_the_text_names_exists(self):
        scripts = [p for p in (SOURCE / "scripts").iterdir() if p.is_file()]
        everything = "\n".join([help_of(str(PROGRAM)), *helps_of_rouleau().values(), *[help_of(str(p)) for p in scripts]])
        if (BUILD / "bin/rouleau-bench").exists():
            everything += help_of(str(BUILD / "bin/rouleau-bench"))
        for page, text in TEXTS.items():
            for code in re.findall(r"`([^`\n]+)`", without_code(text)):
                named = [p.read_text() for word in re.findall(r"\w+\.py", code) for p in SOURCE.glob(f"*/**/{word}")]
                for option in re.findall(r"(?<![\w-])--[a-z][a-z-]+", code):
                    known = option in FOREIGN or has_option("\n".join([everything, *named]), option)
                    self.assertTrue(known, f"{page}: `{code}`")

    def test_no_words_that_have_to_be_read_twice(self):
        for words in ("which was told before", "0.1 in all.", "twelve in all", "is a warning, for hosts compute it in vain"):
            self.assertTrue(STUMBLING_WORDS.search(words), words)  # they would be found
        for words in ("in all scenes", "for it to rest", "alone", "a cell, for example"):
            self.assertIsNone(STUMBLING_WORDS.search(words), words)
        spoken = {f"rouleau {name} --help": text for name, text in {"": help_of(str(PROGRAM)), **helps_of_rouleau()}.items()}
        found = [f"{place}:{text.count(chr(10), 0, words.start()) + 1}: {words[0]}"
                 for place, text in {**TEXTS, **spoken}.items() for words in STUMBLING_WORDS.finditer(text)]
        # Messages, descriptions and what the pages of reports say: literals of more than one word.
        sources = [p for folder in ("host", "plugins", "sdk/schema", "python", "scenes") for p in (SOURCE / folder).rglob("*")
                   if p.suffix in (".cpp", ".hpp", ".js", ".json", ".py") and "uplot" not in p.parts]
        self.assertGreater(len(sources), 300)
        for path in sources:
            for line, text in enumerate(path.read_text().splitlines(), 1):
                literals = [] if text.lstrip().startswith("//") else [a or b for a, b in LITERAL.findall(text)]
                found += [f"{path.relative_to(SOURCE)}:{line}: {words[0]}" for literal in literals if " " in literal.strip()
                          for words in STUMBLING_WORDS.finditer(literal)]
        self.assertEqual(found, [], f"write instead {STUMBLING}")

    def test_every_file_that_is_named_exists(self):
        folders = "|".join(p.name for p in SOURCE.iterdir() if p.is_dir() and p.name not in ("build", "runs", ".git"))
        helps = helps_of_rouleau()
        self.assertIn("scenes/four-cells-shear.json", helps["run"])
        spoken = {f"rouleau {name} --help": text for name, text in {"": help_of(str(PROGRAM)), **helps}.items()}
        for page, text in {**TEXTS, **spoken}.items():
            for name in re.findall(rf"(?<![\w/.-])((?:{folders})/[\w./-]*\w)", text):
                if re.search(r"\b[A-Z]{2,}\b", name.replace("README", "")):
                    continue  # a placeholder, such as plugins/KIND/NAME
                below = (SOURCE / page).parent / name  # sdk/README.md names files of its own folder
                there = (SOURCE / name).exists() or below.exists() or any(SOURCE.glob(name + "*"))
                self.assertTrue(there, f"{page} names {name}")

    def test_every_page_that_the_source_names_exists(self):
        named = 0
        for folder in ("host", "sdk", "plugins", "bench", "tests", "scripts", "examples"):
            for path in (SOURCE / folder).rglob("*"):
                if path.suffix not in (".cpp", ".hpp", ".h", ".c", ".py", ".txt", ".cmake"):
                    continue
                for name in re.findall(r"(?<![\w/$.{-])([A-Za-z][\w/.-]*\.md)\b", path.read_text()):
                    if name.startswith("share/"):
                        continue  # of an installation
                    named += 1
                    there = [p for p in (SOURCE, SOURCE / "docs", path.parent) if (p / name).exists()]
                    self.assertTrue(there, f"{path.relative_to(SOURCE)} names {name}")
        self.assertGreater(named, 20)

    def test_every_number_of_a_plan_says_where_it_is_from(self):
        table = (SOURCE / "host/plan/constants.hpp").read_text()
        page = (SOURCE / "docs/results/plan-constants.md").read_text()
        named = set(re.findall(r"\[([A-Za-z-]+(?: [a-z-]+)*)\]", table))
        self.assertEqual(named, set(re.findall(r"^## (.*)$", page, re.M)))

    def test_every_link_leads_somewhere(self):
        anchors = {page: {slug(re.sub(r"[`*]|\]\([^)]*\)|\[", "", title)) for title in re.findall(r"^#+ (.*)$", text, re.MULTILINE)}
                   for page, text in TEXTS.items()}
        for page, text in TEXTS.items():
            for target in re.findall(r"\]\(([^)\s]+)\)", text):
                if target.startswith(("http:", "https:")):
                    continue
                path, _, anchor = target.partition("#")
                goal = os.path.normpath(os.path.join(os.path.dirname(page), path)) if path else page
                self.assertTrue((SOURCE / goal).exists(), f"{page}: {target}")
                if anchor:
                    self.assertIn(anchor, anchors[goal], f"{page}: {target}")

    def test_every_page_is_in_the_reading_order(self):
        there = {p.relative_to(SOURCE).as_posix() for p in (SOURCE / "docs").glob("**/*.md")}
        self.assertEqual(there - set(PAGES), set())

    def test_generated_pages_are_current(self):
        result = subprocess.run([SOURCE / "scripts/docs", "--check", "--program", PROGRAM], capture_output=True, text=True)
        self.assertEqual(result.returncode, 0, result.stderr)

    def test_reasons_of_divergence_are_the_programs_own(self):
        source = "".join(re.sub(r'"\s*"', "", p.read_text()) for p in (SOURCE / "host").glob("**/*.[ch]pp"))
        table = re.findall(r"^\| `([a-z_]+)` \| ([^|]*) \|", TEXTS["docs/faq.md"].split("\n## ")[1], re.MULTILINE)
        self.assertEqual(len(table), 8)
        for reason, message in table:
            self.assertTrue(f'"{reason}"' in source, reason)
            said = message.split(" N")[0]
            self.assertTrue(said in source or said[-45:] in source, message)  # some are put together from pieces

    def site(self):
        """A folder with the site."""
        folder = pathlib.Path(tempfile.mkdtemp(prefix="rouleau-site-"))
        self.addCleanup(shutil.rmtree, folder)
        result = subprocess.run([SOURCE / "scripts/docs", "--site", folder], capture_output=True, text=True)
        if "the site needs" in result.stderr:
            self.skipTest(result.stderr)
        self.assertEqual(result.returncode, 0, result.stderr)
        return folder

    def test_the_site_holds_every_page_and_no_dead_link_and_its_search_finds_ordinary_words(self):
        folder = self.site()
        pages = {path.name: path.read_text() for path in folder.glob("*.html")}
        self.assertEqual(len(pages), len(PAGES))
        for name, text in pages.items():
            for path, anchor in re.findall(r'(?:href|src)="([^":#]*)(?:#([^"]*))?"', text):
                self.assertTrue((folder / (path or name)).is_file(), f"{name}: {path}")
                if anchor:
                    self.assertIn(f'id="{anchor}"', pages[path or name], f"{name}: {path}#{anchor}")
            self.assertNotRegex(text, r'(?:href|src)="(?:https?:)?//[^"]*\.(?:js|css|woff)')  # works without a network
        for _, links in DOORS.values():
            for page in links:
                self.assertIn(f'href="{name_of(page)}"', pages["index.html"].split('class="doors"')[1])
        self.assertIn('<span class="nt">', pages["scene.html"])  # keys of JSON, coloured
        self.search(folder)
        self.room(folder)

    def room(self, folder):
        """On a screen and on a phone nothing is cut off at the side, tables neither."""
        if not shutil.which("chromium"):
            return
        from browser import SCREENS, Browser
        texts = [re.search(r"<main.*?</main>", path.read_text(), re.DOTALL)[0] for path in sorted(folder.glob("*.html"))]
        whole = folder / "whole.htm"
        whole.write_text(re.sub(r"<main.*?</main>", lambda _: "\n".join(texts), (folder / "scene.html").read_text(), flags=re.DOTALL)
                         .replace('class="page"', 'class="whole"').split("<script", 1)[0].replace("<img ", "<i "))  # nothing to wait for
        with Browser(patience=120) as browser:  # many pages in one, beside other tests
            for name, width in (("desktop", 758), ("phone", 390)):  # what lists at both sides leave of 1280
                page = browser.open(whole.as_uri(), **{**SCREENS[name], "width": width})
                page.run("document.querySelectorAll('nav, aside').forEach(part => part.remove())")
                with self.subTest(screen=name):
                    self.assertEqual(page.run("""[...document.querySelectorAll(".table")].filter(t => t.scrollWidth > t.clientWidth)
                                                 .map(t => t.innerText.slice(0, 60))"""), [])
                    self.assertEqual(page.run("document.documentElement.scrollWidth"), width)

    def search(self, folder):
        """Words in several forms, with words between them that no index has, and one that is still being typed."""
        if not shutil.which("chromium"):
            return
        sys.path.insert(0, str(SOURCE / "tests/browser"))
        from browser import Browser
        words = ["install", "segments", "triangles", "membranes", "walls", "checkpoints", "hemocell", "error bars",
                 "membrane laws", "how to resume", "the density factor", "slip-correction", "membra", "Newcomer's"]
        with Browser(patience=120) as browser:  # many pages in one, beside other tests
            page = browser.open((folder / "resume.html").as_uri())
            self.assertNotIn("&#x27;", page.run("searchable.map(s => s.of + s.title).join()"))
            self.assertEqual(page.run("document.querySelectorAll('main pre').length"), page.run("document.querySelectorAll('.code button').length"))
            for text in words:
                found = page.run(f"(field.value = {json.dumps(text)}, field.dispatchEvent(new Event('input')), found.children.length)")
                self.assertGreater(found, 1, text)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
