"""Completions and man page: complete by the program's own --help, and what they offer after a tab.

usage: check_shell.py SOURCE BUILD
"""

import os
import pathlib
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import unittest

SOURCE, BUILD = map(pathlib.Path, sys.argv[1:3])
PROGRAM = BUILD / "bin/rouleau"
MADE = BUILD / "share"


def said(*arguments):
    return subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, check=True, env={**os.environ, "COLUMNS": "80"}).stdout


# Read in another way than scripts/documentation/commands.py does.
COMMANDS = {line.split()[0] for line in said("--help").split("Usage:")[1].split("--help")[0].splitlines()[1:] if line.strip()}
OPTIONS = {name: set(re.findall(r"^\s+(--[a-z-]+)", said(name, "--help").split("options:")[1], re.MULTILINE)) for name in COMMANDS}


class In_the_shell(unittest.TestCase):
    def setUp(self):
        self.folder = pathlib.Path(tempfile.mkdtemp(prefix="rouleau-shell-"))
        self.addCleanup(shutil.rmtree, self.folder)
        (self.folder / "scene one.json").touch()
        (self.folder / "notes.txt").touch()
        (self.folder / "runs").mkdir()

    def offered(self, *words):
        """What bash offers for the last of these words."""
        line = " ".join(shlex.quote(word) for word in words)
        script = (f"source {shlex.quote(str(MADE / 'bash/rouleau'))}; COMP_WORDS=({line}); COMP_CWORD={len(words) - 1}; "
                  "_rouleau; printf '%s\\n' \"${COMPREPLY[@]}\"")
        result = subprocess.run(["bash", "-uc", script], cwd=self.folder, capture_output=True, text=True,
                                env={**os.environ, "PATH": f"{PROGRAM.parent}:{os.environ['PATH']}"})
        self.assertEqual((result.returncode, result.stderr), (0, ""))
        return set(result.stdout.split("\n")) - {""}

    def test_bash_offers_every_command_and_every_option(self):
        self.assertGreaterEqual(len(COMMANDS), 6)
        self.assertEqual(self.offered("rouleau", ""), COMMANDS | {"--help", "--version"})
        for name, options in OPTIONS.items():
            self.assertIn("--help", options)
            self.assertEqual(self.offered("rouleau", name, "--"), options, name)

    def test_bash_offers_scenes_folders_models_and_kinds_where_they_belong(self):
        self.assertEqual(self.offered("rouleau", "run", ""), {"scene one.json", "runs"})
        self.assertEqual(self.offered("rouleau", "run", "x.json", "--out", ""), {"runs"})
        self.assertEqual(self.offered("rouleau", "run", "x.json", "--lock", "n"), {"notes.txt"})
        self.assertEqual(self.offered("rouleau", "report", ""), {"runs"})
        self.assertEqual(self.offered("rouleau", "new", "m"), {"membrane"})
        self.assertEqual(self.offered("rouleau", "new", "scene", "c"), {"channel", "capsule"})
        self.assertEqual(self.offered("rouleau", "plugins", "lennard"), {"lennard-jones", "lennard-jones-shifted"})
        self.assertEqual(self.offered("rouleau", "run", "x.json", "--threads", ""), set())

    def test_zsh_and_fish_read_theirs_and_it_names_every_option(self):
        for shell, name, mark in (("zsh", "zsh/_rouleau", "{}["), ("fish", "fish/rouleau.fish", "-l {}")):
            text = (MADE / name).read_text()
            for command, options in OPTIONS.items():
                part = text if shell == "fish" else re.search(rf"^    {command}\) (.*)", text, re.MULTILINE)[1]
                for option in options:
                    self.assertIn(mark.format(option if shell == "zsh" else option[2:]), part, f"{shell} {command}")
            if shutil.which(shell):
                result = subprocess.run([shell, "-n", MADE / name], capture_output=True, text=True)
                self.assertEqual((result.returncode, result.stderr), (0, ""))

    def test_the_man_page_holds_every_help_word_for_word(self):
        page = (MADE / "rouleau.1").read_text()
        lines = {line.replace("\\&", "").replace("\\-", "-").replace("\\e", "\\") for line in page.splitlines()}
        for name in COMMANDS:
            for line in said(name, "--help").strip().splitlines():
                self.assertIn(line, lines)
        if shutil.which("man"):
            result = subprocess.run(["man", "--warnings", "-l", MADE / "rouleau.1"], capture_output=True, text=True,
                                    env={**os.environ, "MANWIDTH": "140", "LC_ALL": "C"})
            self.assertEqual((result.returncode, result.stderr), (0, ""))
            self.assertIn("ROULEAU(1)", result.stdout)
            self.assertIn("--resume", result.stdout)

    def test_the_man_page_names_every_environment_variable_that_the_program_reads(self):
        source = "".join(path.read_text() for path in (SOURCE / "host").rglob("*.cpp"))
        read = set(re.findall(r'(?:getenv|absolute_folder)\("(\w+)"\)', source)) | {"UDUNITS2_XML_PATH"}  # which the library reads
        self.assertGreaterEqual(read, {"ROULEAU_PLUGIN_PATH", "ROULEAU_TIMING_LOCK", "XDG_RUNTIME_DIR"})
        section = (MADE / "rouleau.1").read_text().split(".SH ENVIRONMENT\n")[1].split(".SH ")[0]
        self.assertEqual(set(re.findall(r"^\.TP\n(\w+)$", section, re.MULTILINE)), read)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
