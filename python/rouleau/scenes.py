"""Scenes as files or dictionaries, and changes of their values."""

from __future__ import annotations

import collections.abc
import contextlib
import decimal
import fractions
import hashlib
import json
import operator
import os
import pathlib
import tempfile
from typing import TYPE_CHECKING, Any, Iterable, Iterator, Mapping, Union

from .errors import Error, Fault
from .program import call_json

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

#: A scene: the path of its file, or its content.
SceneLike = Union[str, "os.PathLike[str]", Mapping[str, Any]]


def pointer_of(key: str) -> str:
    """The JSON pointer that a key of `changes` means: "fluid.viscosity" and "/fluid/viscosity" are the same."""
    return key if key.startswith("/") else "/" + key.replace(".", "/")


def as_json(value: Any, key: str = "") -> str:
    """JSON of a value, which `key` is to have; what is no JSON by itself as `plain` has it."""
    try:
        return json.dumps(value, default=plain, ensure_ascii=False, allow_nan=False)
    except Exception as trouble:  # also of whoever made the value
        raise Error(Fault(f"{str(value)[:200]} cannot stand in a scene: {trouble}",
                          "use text with a unit, a number, a list or a dictionary",
                          pointer=pointer_of(key) if key else None)) from None


def plain(item: Any) -> Any:
    """A value as JSON knows it: of numpy's numbers and arrays, of sequences, fractions and decimals their numbers, of
    paths and of quantities with a unit (pint, unyt, astropy) text, one for each number of an array. Throws TypeError, and
    what the value throws."""
    magnitude = getattr(item, "magnitude", getattr(item, "value", None))
    unit = getattr(item, "units", getattr(item, "unit", None))
    if magnitude is not None and unit is not None:
        numbers = magnitude.tolist() if hasattr(magnitude, "tolist") else magnitude
        written = format(unit, "C") if hasattr(unit, "dimensionality") else str(unit)  # pint's, for programs
        return _with_unit(numbers, written)
    if isinstance(item, os.PathLike):
        return os.fspath(item)
    if hasattr(item, "tolist"):
        return item.tolist()
    if isinstance(item, (fractions.Fraction, decimal.Decimal)):
        return int(item) if item == int(item) else float(item)
    if isinstance(item, Mapping):
        return dict(item)
    if isinstance(item, collections.abc.Sequence) and not isinstance(item, (bytes, bytearray)):
        return list(item)
    raise TypeError(f"{item!r} is a {type(item).__name__}")


def _with_unit(numbers: Any, unit: str) -> Any:
    if isinstance(numbers, (list, tuple)):
        return [_with_unit(number, unit) for number in numbers]
    written = unit if unit not in ("", "dimensionless") else ""
    return f"{numbers!r} {written}" if written else numbers


def quantity_text(value: Any) -> str:
    """A quantity as text, whatever it was given as."""
    made = json.loads(as_json(value))
    return made if isinstance(made, str) else str(made)


def whole(name: str, value: Any, least: int, most: int | None = None) -> int:
    """A whole number in its range: Python's, numpy's, or a float that is one."""
    try:
        number = int(value) if isinstance(value, float) and value.is_integer() else operator.index(value)
    except TypeError:
        number = least - 1
    if number < least or (most is not None and number > most):
        bounds = f"from {least} to {most}" if most is not None else f"{least} or more"
        raise Error(Fault(f"{name} is {value!r}", f"give a whole number, {bounds}"))
    return number


def floats(what: str, values: Any, remedy: str, lists: bool = False) -> NDArray[numpy.float64]:
    """Numbers as an array, in one dimension where it `lists` them; nan for None. Throws Error for what is no number, and
    for lists of unequal length."""
    import numpy
    try:
        found = numpy.asarray(values)
        if lists and found.ndim != 1:
            raise ValueError
        return found.astype(numpy.float64, casting="unsafe" if found.dtype == object else "same_kind", copy=False)
    except (TypeError, ValueError, OverflowError):
        raise Error(Fault(f"{what}: {' '.join(str(values).split())[:200]}", remedy)) from None


def named(what: str, values: Any) -> dict[Any, Any]:
    """Values by name: a mapping, or a Series of pandas. Throws Error for anything else."""
    if not hasattr(values, "items"):
        raise Error(Fault(f"{what}: {str(values)[:200]}", "give values by name: {name: value}"))
    return dict(values.items())


def settings(changes: Mapping[str, Any], scene: SceneLike) -> list[str]:
    """Assignments, POINTER=VALUE, that make these changes of the scene."""
    def placed(key: str, value: Any) -> Any:
        if not isinstance(scene, Mapping):
            return value
        return _from_here(json.loads(as_json(value, key)), pointer_of(key).rsplit("/", 1)[1])
    return [f"{pointer_of(key)}={as_json(placed(key, value), key)}" for key, value in changes.items()]


def options_of(changes: Mapping[str, Any], scene: SceneLike) -> list[str]:
    """Options of the program that make these changes."""
    return [word for assignment in settings(changes, scene) for word in ("--set", assignment)]


def changes_of(assignments: Iterable[str]) -> dict[str, Any]:
    """Changes as `run` takes them, of texts POINTER=VALUE as the program's --set takes them: a value is JSON, else text."""
    def value_of(text: str) -> Any:
        try:
            return json.loads(text)
        except json.JSONDecodeError:
            return text
    return {pointer: value_of(value) for pointer, _, value in (assignment.partition("=") for assignment in assignments)}


def hashes_of_files(scene: SceneLike, changes: Mapping[str, Any]) -> list[str]:
    """SHA-256 of the files and of the shipped cells that the scene and its changes name, as far as they are there: part of
    what a run means."""
    folder = pathlib.Path() if isinstance(scene, Mapping) else path_of(scene).parent
    content = scene
    if not isinstance(scene, Mapping):
        try:
            content = json.loads(text_of(scene))
        except ValueError:
            return []  # the program says what is wrong
    parts = [content, *({pointer_of(key).rsplit("/", 1)[1]: value} for key, value in changes.items())]
    names = [name for part in parts for name in _named(part, "file")]
    if cells := {name for part in parts for name in _named(part, "from")}:
        names += [cell["file"] for cell in call_json("plugins", "--cells") if cell["name"] in cells]
    hashes = []
    for name in names:
        if (folder / name).is_file() and (folder / name).stat().st_size <= 4 << 30:  # more is refused
            with open(folder / name, "rb") as file:
                hashes.append(hashlib.file_digest(file, "sha256").hexdigest())
    return hashes


def text_of(scene: str | os.PathLike[str]) -> str:
    """The text of a scene's file; "" where it cannot be read: the program says why."""
    try:
        return path_of(scene).read_text(encoding="utf-8-sig", errors="replace") if path_of(scene).is_file() else ""
    except OSError:
        return ""


def _named(value: Any, by: str) -> Iterator[str]:
    """What the key `by` names, wherever it stands."""
    for part in value.values() if isinstance(value, Mapping) else value if isinstance(value, (list, tuple)) else ():
        yield from _named(part, by)
    if isinstance(value, Mapping):  # a file, or the layers of a picture
        named = value.get(by)
        yield from (os.fspath(name) for name in (named if isinstance(named, (list, tuple)) else [named]) if isinstance(name, (str, os.PathLike)))


def _from_here(value: Any, key: str = "") -> Any:
    """With the names of files, and of folders of plugins, from the working folder."""
    if isinstance(value, Mapping):
        return {name: _from_here(part, name) for name, part in value.items()}
    if isinstance(value, (list, tuple)):
        return [_from_here(part, "file" if key in ("plugin_dirs", "file") else "") for part in value]
    return os.path.abspath(value) if key == "file" and value and isinstance(value, (str, os.PathLike)) else value


def name_of(scene: SceneLike) -> str:
    """What a run of the scene is called where nobody says: the file's name without its ending, or "scene"."""
    return "scene" if isinstance(scene, Mapping) else path_of(scene).stem


def path_of(scene: str | os.PathLike[str]) -> pathlib.Path:
    """Where a scene's file is. Throws Error for what is neither a path nor, as others have seen, a dictionary."""
    if not isinstance(scene, (str, os.PathLike)):
        raise Error(Fault(f"{type(scene).__name__} is no scene", "give the path of a scene's file, or a dictionary"))
    return pathlib.Path(scene)


@contextlib.contextmanager
def scene_file(scene: SceneLike) -> Iterator[pathlib.Path]:
    """The path of the scene's file, which for a dictionary is there for a while. Relative names of files and `plugin_dirs`
    of a dictionary are relative to the working folder."""
    if not isinstance(scene, Mapping):
        yield path_of(scene)
        return
    content = {key: value if key in ("notes", "expected") else _from_here(value, key)
               for key, value in json.loads(as_json(scene)).items()}
    text = as_json(content)
    try:
        temporary = tempfile.TemporaryDirectory(prefix="rouleau-")
    except OSError as trouble:
        raise Error(Fault(f"there is no place for a scene's file: {trouble}",
                          "let the environment variable TMPDIR name a folder that you may write to"), exit_code=4) from None
    with temporary as folder:
        path = pathlib.Path(folder) / "scene.json"
        path.write_text(text, encoding="utf-8")
        yield path


def in_users_words(faults: list[Fault], scene: SceneLike) -> list[Fault]:
    """Faults of changes and of a dictionary have a pointer, and no place in a file."""
    def nowhere(file: str | None) -> bool:
        return file == "--set" or (isinstance(scene, Mapping) and (file or "").endswith("/scene.json"))

    return [Fault(fault.problem, fault.remedy, None, fault.pointer) if nowhere(fault.file) else fault for fault in faults]
