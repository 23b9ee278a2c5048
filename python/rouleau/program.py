"""The program `rouleau`: where it is, and how it is called."""

from __future__ import annotations

import json
import os
import pathlib
import shutil
import subprocess
from typing import Any, Sequence

from .errors import Error, Fault, faults_in


def program() -> pathlib.Path:
    """The program: what ROULEAU names, else that of the same installation or source folder as this package, else that
    in PATH. Throws Error where there is none."""
    named = os.environ.get("ROULEAU")
    if named:
        found = shutil.which(named)
        if found is None:
            raise Error(Fault(f'the environment variable ROULEAU names "{named}", which is no program',
                              "let it name the program rouleau, or unset it"), exit_code=4)
        return pathlib.Path(found)
    here = pathlib.Path(__file__).resolve().parent
    for place in ("build/release/bin/rouleau", "bin/rouleau"):
        for folder in here.parents[1:6]:
            if os.access(folder / place, os.X_OK) and (folder / place).is_file():
                return folder / place
    found = shutil.which("rouleau")
    if found is None:
        raise Error(Fault("there is no program rouleau beside this package or in PATH",
                          "build it (scripts/build release simulator), or let the environment variable ROULEAU name it"),
                    exit_code=4)
    return pathlib.Path(found)


#: Folders of the potentials that were made here, which the program searches, too.
plugin_folders: list[str] = []


def environment() -> dict[str, str]:
    """That of the program: errors come as JSON, what was made here is found, and what a process of Python starts is alone,
    though mpirun may have started that process as one of several."""
    path = [*plugin_folders, *filter(None, [os.environ.get("ROULEAU_PLUGIN_PATH")])]
    found = {"ROULEAU_PLUGIN_PATH": ":".join(path)} if path else {}
    return {**os.environ, "ROULEAU_ERRORS": "json", "ROULEAU_LAUNCHER": "none", **found}


def call(*words: str | os.PathLike[str], good: Sequence[int] = (0,)) -> str:
    """Standard output of `rouleau WORDS`. Throws Error for an exit code that is not good."""
    command = [os.fspath(program()), *(os.fspath(word) for word in words)]
    try:
        result = subprocess.run(command, env=environment(), stdin=subprocess.DEVNULL, capture_output=True, text=True)
    except OSError as trouble:
        raise not_started(trouble) from None
    if result.returncode not in good:
        raise Error(faults_in(result.stderr), exit_code=result.returncode)
    return result.stdout


def not_started(trouble: OSError) -> Error:
    """The program does not begin."""
    return Error(Fault(f"the program could not be started: {trouble}",
                       "see to it that it is a program of this machine that you may execute (the environment variable "
                       "ROULEAU can name another one)", str(program())), exit_code=4)


def call_json(*words: str | os.PathLike[str], good: Sequence[int] = (0,),
              made: type[dict[str, Any]] | None = None) -> Any:
    """What `rouleau WORDS --json` prints; its objects as dictionaries or what is `made` of them."""
    said = call(*words, "--json", good=good)
    try:
        return json.loads(said, object_hook=made)
    except ValueError:
        raise Error(Fault(f"rouleau {words[0]} --json has not answered in JSON: {said[:200]!r}",
                          "install the program and the package of one version"), exit_code=4) from None
