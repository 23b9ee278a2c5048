"""scripts/release in a repository of its own, and whether the files that name the version agree.

usage: check_release.py SOURCE BUILD
"""

import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE = pathlib.Path(sys.argv[1])
FILES = ("CMakeLists.txt", "CITATION.cff", "CHANGELOG.md", "scripts/release")
VERSION = "98.7.6"  # of no release


class Release(unittest.TestCase):
    def setUp(self):
        self.root = pathlib.Path(tempfile.mkdtemp(prefix="rouleau-release-"))
        self.addCleanup(shutil.rmtree, self.root)
        for name in FILES:
            (self.root / name).parent.mkdir(exist_ok=True)
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
        self.assertEqual((self.root / "CITATION.cff").read_text().count("date-released"), 1)

    def test_changes_that_are_not_committed_are_refused(self):
        self.name_in_changelog()
        (self.root / "CHANGELOG.md").write_text("")
        self.assert_refused(self.release(VERSION), "not committed")

    def test_a_version_that_the_changelog_does_not_have_is_refused(self):
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

    def test_build_and_citation_name_one_version(self):
        build = re.search(r"project\(Rouleau VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        cited = re.search(r"^version: (.*)$", (SOURCE / "CITATION.cff").read_text(), re.MULTILINE)[1]
        self.assertEqual(build, cited)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
