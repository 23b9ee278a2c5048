"""Scenes as files or dictionaries, and changes of their values."""

from __future__ import annotations

import contextlib
import hashlib
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


def settings(changes: Mapping[str, Any], scene: SceneLike) -> list[str]:
    """Assignments, POINTER=VALUE, that make these changes of the scene."""
    def whole(key: str, value: Any) -> Any:
        return _whole(value, pointer_of(key).rsplit("/", 1)[1]) if isinstance(scene, Mapping) else value
    return [f"{pointer_of(key)}={as_json(whole(key, value))}" for key, value in changes.items()]


def options_of(changes: Mapping[str, Any], scene: SceneLike) -> list[str]:
    """Options of the program that make these changes."""
    return [word for assignment in settings(changes, scene) for word in ("--set", assignment)]


def hashes_of_files(scene: SceneLike, changes: Mapping[str, Any]) -> list[str]:
    """SHA-256 of the files that the scene and its changes name, as far as they are there: part of what a run means."""
    folder = pathlib.Path() if isinstance(scene, Mapping) else pathlib.Path(scene).parent
    content = scene
    if not isinstance(scene, Mapping):
        try:
            content = json.loads(text_of(scene))
        except ValueError:
            return []  # the program says what is wrong
    names = list(_files(content))
    for key, value in changes.items():
        names += _files({pointer_of(key).rsplit("/", 1)[1]: value})
    hashes = []
    for name in names:
        if (folder / name).is_file() and (folder / name).stat().st_size <= 4 << 30:  # more is refused
            with open(folder / name, "rb") as file:
                hashes.append(hashlib.file_digest(file, "sha256").hexdigest())
    return hashes


def text_of(scene: str | os.PathLike[str]) -> str:
    """The text of a scene's file; "" where it cannot be read: the program says why."""
    try:
        return pathlib.Path(scene).read_text(encoding="utf-8-sig", errors="replace") if pathlib.Path(scene).is_file() else ""
    except OSError:
        return ""


def _files(value: Any) -> Iterator[str]:
    for part in value.values() if isinstance(value, Mapping) else value if isinstance(value, (list, tuple)) else ():
        yield from _files(part)
    if isinstance(value, Mapping) and isinstance(value.get("file"), (str, os.PathLike)):
        yield os.fspath(value["file"])


def _whole(value: Any, key: str = "") -> Any:
    """With the names of files, and of folders of plugins, from the working folder."""
    if isinstance(value, Mapping):
        return {name: _whole(part, name) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_whole(part, "file" if key == "plugin_dirs" else "") for part in value]
    return os.path.abspath(value) if key == "file" and value and isinstance(value, (str, os.PathLike)) else value


def name_of(scene: SceneLike) -> str:
    """What a run of the scene is called where nobody says: the file's name without its ending, or "scene"."""
    return "scene" if isinstance(scene, Mapping) else pathlib.Path(scene).stem


@contextlib.contextmanager
def scene_file(scene: SceneLike) -> Iterator[pathlib.Path]:
    """The path of the scene's file, which for a dictionary is there for a while. Relative names of files and `plugin_dirs`
    of a dictionary are relative to the working folder."""
    if not isinstance(scene, Mapping):
        yield pathlib.Path(scene)
        return
    content = {key: value if key in ("notes", "expected") else _whole(value, key) for key, value in scene.items()}
    with tempfile.TemporaryDirectory(prefix="rouleau-") as folder:
        path = pathlib.Path(folder) / "scene.json"
        path.write_text(as_json(content), encoding="utf-8")
        yield path


def in_users_words(faults: list[Fault], scene: SceneLike) -> list[Fault]:
    """Faults of changes and of a dictionary have a pointer, and no place in a file."""
    def nowhere(file: str | None) -> bool:
        return file == "--set" or (isinstance(scene, Mapping) and (file or "").endswith("/scene.json"))

    return [Fault(fault.problem, fault.remedy, None, fault.pointer) if nowhere(fault.file) else fault for fault in faults]
