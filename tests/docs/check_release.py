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

SOURCE = pathlib.Path(sys.argv[1])
FILES = ("CMakeLists.txt", "CITATION.cff", "codemeta.json", "CHANGELOG.md", "python/rouleau/__init__.py", "scripts/release")
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
        self.assertEqual({build}, {cited["version"], codemeta["version"]})
        self.assertEqual(cited.get("date-released"), codemeta.get("datePublished"))
        self.assertEqual(cited["title"], codemeta["name"])
        self.assertEqual(f"https://spdx.org/licenses/{cited['license']}", codemeta["license"])
        abstract = re.search(r"^abstract: >-\n((?:  .*\n)+)", citation, re.MULTILINE)[1]
        self.assertEqual(" ".join(abstract.split()), codemeta["description"])
        self.assertEqual(re.findall(r"^  - ([a-z A-Z]+)$", citation, re.MULTILINE), codemeta["keywords"])
        article = codemeta["referencePublication"][0]
        self.assertEqual(f"https://doi.org/{re.search(r'^    doi: (.*)$', citation, re.MULTILINE)[1]}", article["id"])
        self.assertIn(f"    title: {article['name']}\n", citation)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
