"""Pages of use can be read: short sentences, short lines, small cells, few numbers in a sentence.

Results (docs/results) and the changelog are not held to that, nor is code.

usage: check_words.py SOURCE BUILD [--counts]     with --counts: how often each page breaks each rule
"""

import pathlib
import re
import sys
import unittest

sys.dont_write_bytecode = True
SOURCE = pathlib.Path(sys.argv[1])
sys.path.insert(0, str(SOURCE / "scripts/documentation"))

from pages import PAGES  # noqa: E402

WORDS, LINE, CELL, NUMBERS = 35, 160, 160, 5  # at most: words and numbers of a sentence, characters of a line and of a cell
ENTRY = 25  # words of an entry of the changelog
RESULTS = "docs/results/"
CODE = re.compile(r"^```.*?^```$|(?:(?<=\n\n)|\A)(?: {4}[^\n]*(?:\n|\Z)|[ \t]*\n(?= {4}))+", re.MULTILINE | re.DOTALL)
LINK = re.compile(r"!?\[([^\]]*)\]\([^)]*\)")
# A number may have spaces between thousands; dates, versions, a lattice's sides and a value with its error are one. 1/s is a unit, and what
# stands behind a letter is a name.
NUMBER = re.compile(r"(?<![\w.^/-])(?!1/\w)\d+(?: \d{3}(?!\d))*(?:[.:-]\d+)*(?:e[-+]?\d+)?(?:(?: x| \+-) \d+(?:\.\d+)?)*")
ABBREVIATED = r"(?<!\bal)(?<!e\.g)(?<!i\.e)(?<!\bFig)(?<!\bPhys)(?<!\bRev)(?<!\bcf)(?<!\b[A-Z])"
END = re.compile(rf"{ABBREVIATED}[.!?][)\"*]*\s+(?=[\"*(]*(?:[A-Z0-9`~]|[a-z-]+\.(?:md|json|csv|h5|html|py)\b))")


def prose(text):
    """Lines of a page with code left out; each stays where it is, so that lines can be named."""
    return CODE.sub(lambda found: "\n" * found[0].count("\n"), text)


def paragraphs(text):
    """Line and text of each paragraph and entry of a list. Links are what they show, a piece of code is one word."""
    start, words = 0, []
    for number, line in enumerate([*prose(text).splitlines(), ""], 1):
        begins = re.match(r"\s*([-*]|\d+\.)\s+|>", line)
        if words and (not line.strip() or begins or line.startswith(("#", "|"))):
            yield start, re.sub(r"`[^`]*`", "`code`", LINK.sub(r"\1", " ".join(words)))
            words = []
        if line.strip() and not line.startswith(("#", "|")):
            start = start if words else number
            words.append(re.sub(r"^\s*([-*]|\d+\.|>)\s+", "", line).strip())


def sentences(text):
    for line, paragraph in paragraphs(text):
        for sentence in END.split(paragraph):
            yield line, sentence


def faults(text):
    """(line, rule, what) of all that breaks a rule."""
    for line, sentence in sentences(text):
        words = len([word for word in sentence.split() if re.search(r"\w", word)])
        if words > WORDS:
            yield line, "sentence", f"{words} words: {sentence[:70]}..."
        numbers = len(NUMBER.findall(sentence))
        if numbers > NUMBERS:
            yield line, "numbers", f"{numbers} numbers: {sentence[:70]}..."
    for line, words in enumerate(prose(text).splitlines(), 1):
        if words.startswith("|"):
            for cell in re.split(r"(?<!\\)\|", LINK.sub(r"\1", words)):
                if len(cell.strip()) > CELL:
                    yield line, "cell", f"{len(cell.strip())} characters: {cell.strip()[:60]}..."
        elif len(words) > LINE:
            yield line, "line", f"{len(words)} characters"


class Words(unittest.TestCase):
    maxDiff = None

    def test_rules_find_what_they_are_for(self):
        long_sentence = ("word " * 12 + "\n") * 3
        for text, rule in ((long_sentence, "sentence"), ("One.\n\n- " + long_sentence, "sentence"), ("a" * 161, "line"),
                           ("Of 1, 2, 3, 4, 5 and 6 cells.", "numbers"), ("| " + "a" * 161 + " | b |", "cell")):
            self.assertEqual([found for _, found, _ in faults(text)], [rule], text)
        for text in ("Word " * 25 + "ends.\n" + "Word " * 25, "Text:\n\n    " + "code " * 60 + "\n\n    " + "code " * 60,
                     "```\n" + "a" * 200 + "\n```\n", "On 2026-11-28, of 1 280 nodes on 52 x 44 x 44 at 1/s, 0.2.0 and D3Q19: 1.9 +- 0.1.",
                     "| a | " + "b" * 160 + " | [c](" + "d" * 160 + ") |", "[a](" + "b" * 90 + ")\nand `1 2 3 4 5 6 7 8 9`."):
            self.assertEqual(list(faults(text)), [], text)

    def test_pages_of_use_can_be_read(self):
        for page in PAGES:
            if page.startswith(RESULTS):
                continue
            found = [f"{page}:{line}: {rule}: {what}" for line, rule, what in faults((SOURCE / page).read_text())]
            self.assertEqual(found, [], f"{page}: at most {WORDS} words and {NUMBERS} numbers a sentence, {LINE} characters a line, "
                                        f"{CELL} a cell. What was measured belongs into {RESULTS}")

    def test_entries_of_the_changelog_are_short(self):
        since_the_first = re.search(r"^## \[Unreleased\]\n(.*?)(?=^## \[0\.1\.0\])", (SOURCE / "CHANGELOG.md").read_text(), re.MULTILINE | re.DOTALL)
        entries = re.findall(r"^- (.*(?:\n  .*)*)", since_the_first[1], re.MULTILINE)
        self.assertGreater(len(entries), 100)
        long = [entry for entry in entries if len(entry.split()) > ENTRY]
        self.assertEqual(long, [], f"at most {ENTRY} words; what was measured belongs into {RESULTS}")


def counts():
    print(f"{'page':40} words  sentence numbers line cell")
    for page in PAGES:
        text = (SOURCE / page).read_text()
        found = [rule for _, rule, _ in faults(text)]
        print(f"{page:40} {len(text.split()):6}  " + "  ".join(f"{found.count(rule):6}" for rule in ("sentence", "numbers", "line", "cell")))


if __name__ == "__main__":
    if "--counts" in sys.argv:
        counts()
    else:
        unittest.main(argv=sys.argv[:1])
