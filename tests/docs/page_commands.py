"""Finds the commands that a page of the documentation shows, and says how a test runs each."""

import re
import shlex

# Lines of a block that begin with one of these are commands; others are output, source or drawings.
PROGRAMS = ("rouleau ", "build/release/bin/", "scripts/", "cmake ", "ctest ", "python3 ", "export ", "mkdir ", "paraview ",
            "xdg-open ")

# Not run, and why. Options they show are compared with --help all the same where it is a script or program of Rouleau's.
LEFT_OUT = [
    (r"scripts/(demo|test|build|install-dependencies)\b", "installs packages or builds everything: it is what made the build this test runs in"),
    (r"scripts/(paper|experiments|blood|break-up|rheology|dilute-viscosity|test-aarch64|tidy)\b", "takes minutes to hours; results are in the page"),
    (r"rouleau limits (limits|tests/stability)/", "tries hundreds of runs; tests/limits runs the command on small files, and reads these"),
    (r"scripts/notebooks\b", "runs for minutes; tests/python/check_notebooks.py runs them with smaller scenes"),
    (r"scripts/(package|check-packages)\b", "minutes; tests/packages looks into packages of the build that is tested"),
    (r"scripts/release\b", "commits and tags; tests/docs/check_release.py runs it in a repository of its own"),
    (r"scripts/fuzz\b", "builds a preset of its own and searches for minutes; scripts/test --weekly runs it"),
    (r"rouleau plugins --(install|index)\b", "wants a plugin that is not installed yet; run by tests/commands/check_trust.py"),
    (r"cmake --(preset|build)\b|ctest\b", "the build and the tests that this one is part of"),
    (r"cmake --install\b", "run by tests/sdk/check_install.py and check_tutorial.py"),
    (r"paraview\b|xdg-open\b", "wants a screen; tests/paraview opens the same file"),
    (r"python3 tests/mutants/score\.py", "a quarter of an hour; ctest runs a sample of it, scripts/test --full all"),
    (r"python3 bench/(idle_features|python_stepping)\.py", "needs valgrind; scripts/test --full runs it"),
    (r"python3 bench/passes\.py", "needs valgrind, and minutes"),
    (r"python3 bench/ranks\.py", "minutes, and figures of an idle machine"),
    (r"build/release/bin/rouleau-bench\b", "measures time for a minute"),
    (r"build/release/bin/physics\b", "the physics tests, run by ctest"),
]
# What a placeholder stands for, so that lines which show the form of a command are run too.
PLACEHOLDERS = [
    (r"\bSCENE\b", "scenes/four-cells-shear.json"),
    (r"\[ID\]|(?<=plugins )\bID\b", "morse"),
    (r"\bSTUDY\b", "studies/couette.json"),
    (r"\bLIMITS\b", "limits/shear-rate.json"),
    (r"\bMANIFEST(\.\.\.)?(?!\w)", "build/release/lib/rouleau/plugins/interaction/morse/morse.json --level interface"),
    (r"\bKIND NAME\b", "interaction org.example.documented"),
    (r"\bscene TEMPLATE\b", "scene demo"),
    (r"\bDIR\b", "runs/demo"),
    (r"\bFILE\b", "runs/written"),
    (r"\[options\]", ""),
]
# Enough for every FAQ entry that must fail; a documented run that must not fail is cut off sooner.
STEPS = {0: 40, 1: 1000}


class Command:
    def __init__(self, page, line, shown):
        code = re.search(r"  # exit code (\d+)$", shown)
        self.page, self.line = page, line
        self.expected = int(code[1]) if code else 0
        self.shown = shown[:code.start()] if code else shown
        self.output = []  # lines that the page says it prints

    @property
    def left_out(self):
        return next((why for pattern, why in LEFT_OUT if re.match(pattern, self.shown)), None)

    @property
    def run(self):
        """The command as the test runs it: placeholders filled in, and no run longer than it must be."""
        text = self.shown
        for pattern, stands_for in PLACEHOLDERS:
            text = re.sub(pattern, stands_for, text)
        if re.match(r"(build/release/bin/)?rouleau run\b", text):
            text, rest = re.match(r"([^;|]*)(.*)", text).groups()
            if "--max-steps" not in text:
                text += f" --max-steps {STEPS.get(self.expected, 40)}"
            text = re.sub(r"--max-steps \d{4,}", "--max-steps 200", text) if self.expected == 0 else text
            text += " --quiet" + ("" if "--threads" in text else " --threads 1") + rest
        if re.match(r"(build/release/bin/)?rouleau study\b", text):
            text = re.sub(r" --(budget|repeats) \S+", "", text) + " --budget 2s --repeats 1 --quiet"
        return text.replace("; less ", "; cat ")

    @property
    def options(self):
        words = [word.split("=")[0] for word in re.findall(r"(?<=\s)--[a-z][a-z-]*=?", self.shown)]
        return list(dict.fromkeys(words))

    @property
    def program(self):
        return shlex.split(self.shown.split(";")[0], comments=False)[:2]


def commands_of(page, text):
    """All commands of a page in order; a fenced text block after one is what it prints."""
    found, fence, joined, start = [], None, "", 0
    after_commands = False  # nothing but empty lines since a block of commands
    for number, line in enumerate(text.splitlines(), 1):
        if line.startswith("```"):
            after_commands = fence == "sh" or after_commands and fence is None
            fence = line[3:].strip() or "text" if fence is None else None
            continue
        if fence == "text" and after_commands:
            found[-1].output.append(line)
            continue
        after_commands = after_commands and not line.strip()
        if fence not in (None, "sh") or fence is None and not line.startswith("    "):
            joined = ""
            continue
        body = line if fence else line[4:]
        if not joined:
            start = number
        body = joined + body.strip() if joined else body
        if body.endswith("\\"):
            joined = body[:-1]
            continue
        joined = ""
        if not fence:  # a remark stands two or more spaces behind the command
            body = re.split(r"\s{2,}", body, maxsplit=1)[0]
        if body.startswith(PROGRAMS):
            found.append(Command(page, start, body.rstrip()))
    return found
