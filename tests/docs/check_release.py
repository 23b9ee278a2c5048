"""scripts/release in a repository of its own, and whether the files that name the version agree.

usage: check_release.py SOURCE BUILD
"""

import datetime
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest
import zipfile

SOURCE = pathlib.Path(sys.argv[1])
FILES = ("CMakeLists.txt", "CITATION.cff", "codemeta.json", "CHANGELOG.md", "python/rouleau/__init__.py", "README.md",
         "packaging/conda/meta.yaml", "packaging/spack/package.py", "scripts/release")
VERSION = "98.7.6"  # of no release


class Release(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="rouleau-release-"))
        self.addCleanup(shutil.rmtree, self.root)
        for name in FILES:
            (self.root / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(SOURCE / name, self.root / name)
        self.git("init", "--quiet")
        self.commit()

    def git(self, *arguments):
        return subprocess.run(["git", *arguments], cwd=self.root, env=self.environment(), capture_output=True, text=True,
                              check=True).stdout.strip()

    def environment(self):
        """Whoever runs the test need have no name in git, and nothing of theirs counts."""
        names = {f"GIT_{who}_{what}": "test" for who in ("AUTHOR", "COMMITTER") for what in ("NAME", "EMAIL")}
        return {**os.environ, **names, "GIT_CONFIG_GLOBAL": "/dev/null", "GIT_CONFIG_SYSTEM": "/dev/null"}

    def commit(self):
        self.git("add", "--all")
        self.git("commit", "--quiet", "--message", "a state")

    def release(self, *arguments):
        return subprocess.run([self.root / "scripts/release", *arguments], env=self.environment(), capture_output=True, text=True)

    def name_in_changelog(self, version=VERSION):
        file = self.root / "CHANGELOG.md"
        file.write_text(file.read_text() + f"\n## [{version}] - 2031-05-04\n")
        self.commit()

    def assert_refused(self, result, word):
        self.assertEqual(result.returncode, 1, result.stdout)
        self.assertIn(word, result.stderr)
        self.assertEqual(self.git("tag"), "")

    def test_a_release_is_a_commit_with_the_version_and_a_tag(self):
        self.name_in_changelog()
        result = self.release(VERSION)
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"project(Rouleau VERSION {VERSION} ", (self.root / "CMakeLists.txt").read_text())
        self.assertIn(f"\nversion: {VERSION}\ndate-released: 2031-05-04\n", (self.root / "CITATION.cff").read_text())
        codemeta = json.loads((self.root / "codemeta.json").read_text())
        self.assertEqual((codemeta["version"], codemeta["datePublished"]), (VERSION, "2031-05-04"))
        for name, line in (("python/rouleau/__init__.py", f'__version__ = "{VERSION}"'), ("README.md", f"Version {VERSION.rsplit('.', 1)[0]}, "),
                           ("packaging/conda/meta.yaml", f'{{% set version = "{VERSION}" %}}'),
                           ("packaging/spack/package.py", f'    version("{VERSION}", tag="v{VERSION}")')):
            self.assertIn(f"\n{line}", (self.root / name).read_text())
        self.assertEqual(self.git("rev-parse", f"v{VERSION}^{{commit}}"), self.git("rev-parse", "HEAD"))
        self.assertEqual(self.git("status", "--porcelain"), "")

    def test_a_dry_run_changes_nothing(self):
        self.name_in_changelog()
        before = self.git("rev-parse", "HEAD")
        result = self.release(VERSION, "--dry-run")
        self.assertEqual(result.returncode, 0, result.stderr)
        self.assertIn(f"v{VERSION}", result.stdout)
        self.assertEqual((self.git("rev-parse", "HEAD"), self.git("status", "--porcelain"), self.git("tag")), (before, "", ""))

    def test_a_second_release_replaces_the_day_of_the_first(self):
        for version in (VERSION, "99.0.0"):
            self.name_in_changelog(version)
            self.assertEqual(self.release(version).returncode, 0)
        for name, word in (("CITATION.cff", "date-released"), ("codemeta.json", "datePublished")):
            self.assertEqual((self.root / name).read_text().count(word), 1)

    def test_what_is_unreleased_becomes_the_section_of_the_version_with_the_day_of_today(self):
        file = self.root / "CHANGELOG.md"
        file.write_text("# Changelog\n\n## [Unreleased]\n\n### Added\n\n- A new thing.\n\n## [0.1.0] - 2026-11-23\n\n- The first.\n")
        self.commit()
        today = datetime.date.today()
        self.assertEqual(self.release(VERSION).returncode, 0)
        days = {d.isoformat() for d in (today, datetime.date.today())}  # midnight may have passed
        text = file.read_text()
        self.assertIn(re.search(r"## \[Unreleased\]\n\n## \[98\.7\.6\] - (.*)\n\n### Added\n\n- A new thing\.\n\n## \[0\.1\.0\]", text)[1],
                      days)
        self.assertEqual(self.git("status", "--porcelain"), "")

    def test_changes_that_are_not_committed_are_refused(self):
        self.name_in_changelog()
        (self.root / "CHANGELOG.md").write_text("")
        self.assert_refused(self.release(VERSION), "not committed")

    def test_a_version_of_which_the_changelog_says_nothing_is_refused(self):
        file = self.root / "CHANGELOG.md"
        for text in ("## [Unreleased]\n\n## [0.1.0] - 2026-11-23\n\n- The first.\n", "## [0.1.0] - 2026-11-23\n\n- The first.\n"):
            file.write_text(text)
            self.commit()
            self.assert_refused(self.release(VERSION), "CHANGELOG.md")

    def test_a_tag_that_exists_is_refused(self):
        self.name_in_changelog()
        self.git("tag", f"v{VERSION}")
        result = self.release(VERSION)
        self.assertEqual(result.returncode, 1)
        self.assertIn("exists", result.stderr)

    def test_what_is_no_version_is_refused(self):
        for word in ("v1.2.3", "1.2", "1.2.3-rc1", "01.2.3"):
            self.assertEqual(self.release(word).returncode, 2, word)

    def test_build_citation_and_codemeta_say_the_same(self):
        build = re.search(r"project\(Rouleau VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        citation = (SOURCE / "CITATION.cff").read_text()
        codemeta = json.loads((SOURCE / "codemeta.json").read_text())
        cited = dict(re.findall(r"^(\w[\w-]*): (.+)$", citation, re.MULTILINE))
        package = re.search(r'^__version__ = "(.*)"', (SOURCE / "python/rouleau/__init__.py").read_text(), re.MULTILINE)[1]
        conda = re.search(r'^{% set version = "(.*)" %}', (SOURCE / "packaging/conda/meta.yaml").read_text(), re.MULTILINE)[1]
        spack = re.findall(r'version\("([\d.]+)", tag="v([\d.]+)"', (SOURCE / "packaging/spack/package.py").read_text())
        self.assertEqual({build}, {cited["version"], codemeta["version"], package, conda, *spack[0]})
        self.assertEqual(cited.get("date-released"), codemeta.get("datePublished"))
        self.assertEqual(cited["title"], codemeta["name"])
        self.assertEqual(f"https://spdx.org/licenses/{cited['license']}", codemeta["license"])
        abstract = re.search(r"^abstract: >-\n((?:  .*\n)+)", citation, re.MULTILINE)[1]
        self.assertEqual(" ".join(abstract.split()), codemeta["description"])
        self.assertEqual(re.findall(r"^  - ([a-z A-Z]+)$", citation, re.MULTILINE), codemeta["keywords"])
        article = codemeta["referencePublication"][0]
        self.assertEqual(f"https://doi.org/{re.search(r'^    doi: (.*)$', citation, re.MULTILINE)[1]}", article["id"])
        self.assertIn(f"    title: {article['name']}\n", citation)


    def test_earlier_versions_stand_at_commits_of_their_number(self):
        rows = re.findall(r"^\| (\d+\.\d+\.\d+) \| `([0-9a-f]{8})` \|", (SOURCE / "CONTRIBUTING.md").read_text(), re.MULTILINE)
        self.assertEqual([version for version, _ in rows], ["0.1.0", "0.2.0"])
        if not (SOURCE / ".git").exists():
            self.skipTest("this source has no history")
        for version, commit in rows:
            shown = subprocess.run(["git", "show", f"{commit}:CMakeLists.txt"], cwd=SOURCE, capture_output=True, text=True)
            if shown.returncode != 0:
                self.skipTest("the history does not reach so far back")
            self.assertIn(f"project(Rouleau VERSION {version} ", shown.stdout)


class Recipes(unittest.TestCase):
    """What can be known of them without conda and spack: their form, and that what they name is there."""

    def test_options_and_components_of_the_recipes_are_those_of_the_build(self):
        build = "".join(path.read_text() for path in [SOURCE / "CMakeLists.txt", *SOURCE.glob("*/CMakeLists.txt"), *SOURCE.glob("host/transport/*.cmake")])
        conda, spack = ((SOURCE / name).read_text() for name in ("packaging/conda/meta.yaml", "packaging/spack/package.py"))
        options = set(re.findall(r"\b(ROULEAU_[A-Z]+)(?==|\")", conda + spack)) - {"ROULEAU_GIT"}
        self.assertEqual(options, {"ROULEAU_MPI", "ROULEAU_PYTHON"} | {name for name in options if name == "ROULEAU_PYTHON_FOLDER"})
        for name in options:
            self.assertTrue(re.search(rf"set\({name} ", build), name)
        for component in re.findall(r"--component (\w+)", conda):
            self.assertTrue(re.search(rf"COMPONENT {component}\b", build), component)
        compile(spack, "package.py", "exec")
        wanted = re.search(r"Python (3\.\d+) \(for man page and completions\)", (SOURCE / "docs/install.md").read_text())[1]
        self.assertIn(f'depends_on("python@{wanted}:"', spack)
        self.assertEqual(conda.count(f"    - python >={wanted}\n"), 2)

    def test_the_conda_recipe_is_yaml(self):
        try:
            import jinja2
            import yaml
        except ImportError:
            self.skipTest("jinja2 or yaml is missing")
        text = re.sub(r"# \[.*\]$", "", (SOURCE / "packaging/conda/meta.yaml").read_text(), flags=re.MULTILINE)
        recipe = yaml.safe_load(jinja2.Template(text).render(compiler=lambda language: f"{language}-compiler"))
        self.assertEqual(recipe["source"]["git_rev"], f"v{recipe['package']['version']}")
        self.assertIn("cxx-compiler", recipe["requirements"]["build"])

    def test_the_python_package_becomes_a_wheel_with_all_its_files(self):
        python = next((python for python in ("/usr/bin/python3", sys.executable) if subprocess.run(
            [python, "-c", "import setuptools, wheel; assert int(setuptools.__version__.split('.')[0]) >= 61"], capture_output=True).returncode == 0), None)
        if not python:
            self.skipTest("setuptools and wheel are missing (Debian: python3-setuptools, python3-wheel)")
        with tempfile.TemporaryDirectory(prefix="rouleau-wheel-") as name:
            folder = pathlib.Path(name)
            shutil.copytree(SOURCE / "python/rouleau", folder / "python/rouleau")
            (folder / "docs").mkdir()
            for file in ("pyproject.toml", "docs/python.md"):
                shutil.copy(SOURCE / file, folder / file)
            made = subprocess.run([python, "-c", "from setuptools.build_meta import build_wheel; print(build_wheel('.'))"], cwd=folder,
                                  capture_output=True, text=True)
            self.assertEqual(made.returncode, 0, made.stderr)
            with zipfile.ZipFile(next(folder.glob("rouleau-*-py3-none-any.whl"))) as wheel:
                held = {file.split("/")[1] for file in wheel.namelist() if file.startswith("rouleau/")}
        self.assertEqual(held, {path.name for path in (SOURCE / "python/rouleau").iterdir() if path.name != "__pycache__"})


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
