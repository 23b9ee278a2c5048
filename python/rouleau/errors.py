"""What goes wrong, with its place and its remedy."""

from __future__ import annotations

import dataclasses
import json
from typing import Any, Sequence


@dataclasses.dataclass(frozen=True)
class Fault:
    """One thing that is wrong. What is unknown is None, or "" for the remedy."""

    problem: str  #: what was found, and what is allowed
    remedy: str = ""  #: what to do
    file: str | None = None  #: as it was given
    pointer: str | None = None  #: JSON pointer, such as "/fluid/viscosity"
    line: int | None = None  #: from 1
    column: int | None = None  #: from 1

    @property
    def place(self) -> str:
        """"file:line:column /pointer", as far as it is known."""
        parts = [str(part) for part in (self.file, self.line, self.column) if part is not None] if self.file else []
        return " ".join(part for part in (":".join(parts), self.pointer) if part)

    def __str__(self) -> str:
        words = "\n".join(text for text in (self.problem, self.remedy) if text)
        return self.place + "\n  " + words.replace("\n", "\n  ") if self.place else words


class Error(Exception):
    """Bad input, a refused plugin, a run that failed, or trouble with files.

    `str(error)` is what the program says. `file`, `pointer`, `line`, `column`, `problem` and `remedy` are those of the
    first fault; `faults` has all of them.
    """

    def __init__(self, faults: str | Fault | Sequence[Fault], *, exit_code: int = 2, run: Any = None) -> None:
        if isinstance(faults, str):
            faults = Fault(faults)
        self.faults: list[Fault] = [faults] if isinstance(faults, Fault) else list(faults)
        #: 1 the simulation failed, 2 bad input, 3 a plugin was refused, 4 input or output
        self.exit_code = exit_code
        #: the run that failed (rouleau.Run), with all that it wrote; None where there is none
        self.run = run
        super().__init__("\n".join(map(str, self.faults)))

    @property
    def problem(self) -> str:
        """What was found, and what is allowed."""
        return self.faults[0].problem

    @property
    def remedy(self) -> str:
        """What to do; "" where that is not known."""
        return self.faults[0].remedy

    @property
    def place(self) -> str:
        """"file:line:column /pointer", as far as it is known."""
        return self.faults[0].place

    @property
    def file(self) -> str | None:
        """The file with the fault, as it was given; None where it is in none."""
        return self.faults[0].file

    @property
    def pointer(self) -> str | None:
        """JSON pointer of the fault, such as "/fluid/viscosity"."""
        return self.faults[0].pointer

    @property
    def line(self) -> int | None:
        """Line in the file, from 1."""
        return self.faults[0].line

    @property
    def column(self) -> int | None:
        """Column in the line, from 1."""
        return self.faults[0].column


def fault_of(problem: str, remedy: str, file: str, pointer: str, line: int, column: int) -> Fault:
    """A fault as the program says it, with "" and 0 for what is unknown and lines that go on indented."""
    return Fault(problem.replace("\n  ", "\n"), remedy.replace("\n  ", "\n"), file or None, pointer or None, line or None,
                 column or None)


def faults_in(said: str) -> list[Fault]:
    """Faults in what the program wrote to standard error with ROULEAU_ERRORS=json; its words where it gave none."""
    for line in reversed(said.splitlines()):
        if line.startswith('{"'):
            try:
                listed = json.loads(line)["faults"]
            except (ValueError, KeyError):
                continue
            return [fault_of(**fault) for fault in listed]
    return [Fault(said.strip() or "the program ended without a word")]
