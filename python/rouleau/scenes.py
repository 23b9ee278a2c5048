"""Scenes as files or dictionaries, and changes of their values."""

from __future__ import annotations

import contextlib
import json
import os
import pathlib
import tempfile
from typing import Any, Iterator, Mapping, Union

from .errors import Error, Fault

#: A scene: the path of its file, or its content.
SceneLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def pointer_of(key: str) -> str:
    """The JSON pointer that a key of `changes` means: "fluid.viscosity" and "/fluid/viscosity" are the same."""
    return key if key.startswith("/") else "/" + key.replace(".", "/")


def as_json(value: Any) -> str:
    """JSON of a value; numpy's numbers and arrays, and paths, too."""
    def other(item: Any) -> Any:
        if hasattr(item, "tolist"):
            return item.tolist()
        if isinstance(item, os.PathLike):
            return os.fspath(item)
        raise Error(f"{item!r} cannot stand in a scene; use text with a unit, a number, a list or a dictionary")
    return json.dumps(value, default=other, ensure_ascii=False)


def settings(changes: Mapping[str, Any]) -> list[str]:
    """Options of the program that make these changes."""
    return [word for key, value in changes.items() for word in ("--set", f"{pointer_of(key)}={as_json(value)}")]


def name_of(scene: SceneLike) -> str:
    """What a run of the scene is called where nobody says: the file's name without its ending, or "scene"."""
    return "scene" if isinstance(scene, Mapping) else pathlib.Path(scene).stem


@contextlib.contextmanager
def scene_file(scene: SceneLike) -> Iterator[pathlib.Path]:
    """The path of the scene's file, which for a dictionary is there for a while. Relative `plugin_dirs` of a dictionary
    are relative to the working folder."""
    if not isinstance(scene, Mapping):
        yield pathlib.Path(scene)
        return
    content = dict(scene)
    folders = content.get("plugin_dirs")
    if isinstance(folders, list):
        content["plugin_dirs"] = [os.path.abspath(f) if isinstance(f, (str, os.PathLike)) else f for f in folders]
    with tempfile.TemporaryDirectory(prefix="rouleau-") as folder:
        path = pathlib.Path(folder) / "scene.json"
        path.write_text(as_json(content), encoding="utf-8")
        yield path


def in_users_words(faults: list[Fault], scene: SceneLike) -> list[Fault]:
    """Faults of changes and of a dictionary have a pointer, and no place in a file."""
    def nowhere(file: str | None) -> bool:
        return file == "--set" or (isinstance(scene, Mapping) and (file or "").endswith("/scene.json"))

    return [Fault(fault.problem, fault.remedy, None, fault.pointer) if nowhere(fault.file) else fault for fault in faults]
