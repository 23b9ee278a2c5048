"""Potentials written as a formula, and compiled."""

from __future__ import annotations

import ast
import hashlib
import json
import math
import os
import pathlib
import re
import shutil
import subprocess
import tempfile
import textwrap
from typing import TYPE_CHECKING, Any, Callable, NoReturn

from . import program as host
from .errors import Error, Fault
from .scenes import as_json

if TYPE_CHECKING:
    import numpy
    from numpy.typing import NDArray

#: What a formula may call; C++ has the same names.
FUNCTIONS: dict[str, Callable[..., float]] = {
    "exp": math.exp, "log": math.log, "sqrt": math.sqrt, "sin": math.sin, "cos": math.cos, "tanh": math.tanh,
    "erf": math.erf, "abs": abs}
OPERATORS: dict[type[ast.operator], str] = {ast.Add: "+", ast.Sub: "-", ast.Mult: "*", ast.Div: "/"}
QUANTITY = re.compile(r"\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?)\s*(.*?)\s*")
ELSEWHERE = "name another folder: rouleau.potential(..., folder=...), or the environment variable XDG_CACHE_HOME"
#: Words that C++ or the SDK use, and cannot be parameters.
TAKEN = frozenset("r S power rouleau std auto bool char const double else float for if int long new return short signed struct "
                  "switch this union unsigned void while class using template typename default delete case break".split())

SOURCE = '''\
// {title}
// Made by rouleau.potential. The SDK derives the force and its slope from the energy.
#include <rouleau/interaction.hpp>

template <int n, class T>
T power(const T& x) {{
  if constexpr (n == 1) return x;
  else return x * power<n - 1>(x);
}}

struct Formula {{
  double {declared};
  explicit Formula(const rouleau::Parameters& p) : {made} {{}}
  double cutoff() const {{ return cutoff_; }}

  template <class S>
  S energy(const S& r) const {{
    using std::exp, std::log, std::sqrt, std::sin, std::cos, std::tanh, std::erf, std::abs, std::pow;
    return {formula};
  }}
}};
ROULEAU_INTERACTION(Formula, "{id}", "1.0.0")
'''
BUILD = '''\
cmake_minimum_required(VERSION 3.20)
project({name} LANGUAGES CXX)
find_package(Rouleau REQUIRED)
rouleau_add_plugin({name})
'''


class Potential:
    """A compiled potential, which scenes name by its `id` as long as they are run from this process; elsewhere with
    `--plugin-dir` and its `directory`."""

    def __init__(self, formula: str, identity: str, directory: pathlib.Path, manifest: dict[str, Any],
                 values: dict[str, float]) -> None:
        self.formula = formula  #: energy per area, as it was given
        self.id = identity  #: the model's name in scenes
        self.directory = directory  #: with library and manifest; its folder above has the source
        self.manifest = manifest  #: of the plugin, in which the parameters' names are in lower case

        self._values = values

    def between(self, a: str, b: str, **parameters: Any) -> dict[str, Any]:
        """An entry of a scene's `interactions`: this potential between cells of types `a` and `b` (or "wall"), where
        `parameters` (text with a unit, or numbers in SI) replace those that it was made with. In a scene their names
        are in lower case."""
        return {"between": [a, b], "model": self.id, "parameters": {key.lower(): value for key, value in parameters.items()}}

    def energy(self, distance: float | NDArray[numpy.float64], **parameters: float) -> Any:
        """Energy per membrane area at a distance or distances (any shape), computed by Python: slow, for curves. All are
        plain numbers in the units that the parameters were given with, which have to fit together (SI: m and J/m2);
        `parameters` replace values."""
        import numpy
        values = dict(self._values)
        for name in parameters:
            if name not in values:
                raise Error(f'the potential has no parameter "{name}"; it has ' + ", ".join(values))
        values.update(parameters)
        code = compile(ast.parse(self.formula.strip(), mode="eval"), self.formula, "eval")
        at = numpy.vectorize(lambda r: eval(code, {"__builtins__": {}}, {**FUNCTIONS, **values, "r": float(r)}))  # checked before
        found = at(distance)
        return found if numpy.ndim(distance) else float(found)

    def __repr__(self) -> str:
        return f"<potential {self.id}: {self.formula}>"


def potential(energy: str, *, cutoff: str = "3.52 um", name: str = "potential", folder: str | os.PathLike[str] | None = None,
              **parameters: str | float) -> Potential:
    """Makes a potential of its energy per membrane area as a formula of the distance `r` between surfaces, compiles it
    through the SDK and has `rouleau conform` test it. A positive slope of the energy attracts.

        morse = rouleau.potential("De*(exp(2*b*(r0 - r)) - 2*exp(b*(r0 - r)))", De="5.2e-8 J/m2", b="3.84e6 1/m", r0="4.9e-7 m")
        rouleau.run(scene, interactions=[morse.between("rbc", "rbc")])

    The formula has + - * / **, exp, log, sqrt, sin, cos, tanh, erf, abs, numbers, `r`, and the `parameters`, each with its
    value and unit as text (or a plain number). Units have to fit: constants that have one are parameters. `cutoff` is the
    distance beyond which the energy is left out, as it is: nothing is shifted. `name` has lower-case letters, digits and
    "-". It needs a C++ compiler and CMake, and takes some ten seconds; the same potential is made once and then found in
    `folder` (~/.cache/rouleau/potentials). Throws Error with the formula and the place in it, with the compiler's words,
    or with the checks that did not pass.
    """
    given = {key: _quantity(key, value) for key, value in parameters.items()}
    translated, used = _translated(energy, set(given))
    if len({key.lower() for key in [*given, "cutoff"]}) <= len(given):
        raise Error(Fault("two parameters differ in upper and lower case alone, or one is called cutoff", "rename one"))
    for key in given:
        if key not in used:
            raise Error(Fault(f'the parameter "{key}" does not occur in the formula', f"leave it out, or write: {energy}"))
    if not re.fullmatch(r"[a-z][a-z0-9]*(-[a-z0-9]+)*", name):
        raise Error(Fault(f'the name "{name}" is none for a model', 'take lower-case letters, digits and "-", a letter first'))
    reach = _quantity("cutoff", cutoff)
    digest = hashlib.sha256(json.dumps([energy, given, reach, SOURCE]).encode()).hexdigest()[:10]
    identity = f"python.{name}-{digest}"
    manifest = _manifest(energy, name, identity, given, reach)
    place = "the folder for potentials"
    try:
        cache = None if folder is not None else os.environ.get("XDG_CACHE_HOME") or pathlib.Path.home() / ".cache"
        place = str(folder if cache is None else cache)
        root = pathlib.Path(place) if cache is None else pathlib.Path(place) / "rouleau/potentials"
        home = (root / f"{name}-{digest}").resolve()
        if not ((home / "conforms").is_file() and (home / "build" / f"lib{name}.so").is_file()):
            _make(home, name, identity, energy, translated, list(given), manifest)
    except (OSError, RuntimeError) as trouble:  # no HOME, a folder of somebody else's
        raise Error(Fault(f"the potential cannot be kept: {trouble}", ELSEWHERE, place), exit_code=4) from None
    if str(home / "build") not in host.plugin_folders:
        host.plugin_folders.insert(0, str(home / "build"))
    return Potential(energy, identity, home / "build", manifest, {key: value for key, (value, _) in given.items()})


def _quantity(name: str, value: str | float) -> tuple[float, str]:
    """The number and the unit of a parameter."""
    if name in TAKEN or name in FUNCTIONS or not re.fullmatch(r"[A-Za-z][A-Za-z0-9_]*", name):
        raise Error(Fault(f'"{name}" cannot be the name of a parameter', "take another one, such as De, b or r0"))
    given = json.loads(as_json(value, name))  # a number or text, whatever has a number or a unit
    if isinstance(given, (int, float)):
        return float(given), "1"
    match = QUANTITY.fullmatch(str(given))
    if match is None:
        raise Error(Fault(f'{name} is "{value}"', 'write a number and a unit, such as "0.49 um"'))
    return float(match[1]), match[2] or "1"


def _translated(formula: str, names: set[str]) -> tuple[str, set[str]]:
    """The formula in C++, and the names in it."""
    used: set[str] = set()

    def refuse(node: ast.expr, problem: str) -> NoReturn:
        part = ast.get_source_segment(formula.strip(), node) or "this"
        raise Error(Fault(f'in the formula "{formula.strip()}": "{part}" {problem}', "allowed are + - * / **, " +
                          ", ".join(FUNCTIONS) + ", numbers, r and the parameters: " + (", ".join(sorted(names)) or "none"),
                          column=node.col_offset + 1))

    def integer(node: ast.expr) -> int | None:
        sign = 1
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, ast.USub):
            node, sign = node.operand, -1
        return sign * node.value if isinstance(node, ast.Constant) and type(node.value) is int else None

    def walk(node: ast.expr) -> str:
        if isinstance(node, ast.Constant) and type(node.value) in (int, float):
            return repr(float(node.value))
        if isinstance(node, ast.Name):
            if node.id != "r" and node.id not in names:
                refuse(node, "is no parameter that was given")
            used.add(node.id)
            return node.id
        if isinstance(node, ast.UnaryOp) and isinstance(node.op, (ast.USub, ast.UAdd)):
            return f"(-{walk(node.operand)})" if isinstance(node.op, ast.USub) else walk(node.operand)
        if isinstance(node, ast.BinOp) and type(node.op) in OPERATORS:
            return f"({walk(node.left)} {OPERATORS[type(node.op)]} {walk(node.right)})"
        if isinstance(node, ast.BinOp) and isinstance(node.op, ast.Pow):
            whole = integer(node.right)
            if whole is not None and 1 <= abs(whole) <= 16:
                product = f"power<{abs(whole)}>({walk(node.left)})"
                return product if whole > 0 else f"(1.0 / {product})"
            return f"pow({walk(node.left)}, {walk(node.right)})"
        if isinstance(node, ast.Call) and isinstance(node.func, ast.Name) and node.func.id in FUNCTIONS \
                and len(node.args) == 1 and not node.keywords:
            return f"{node.func.id}({walk(node.args[0])})"
        refuse(node, "is not understood")

    try:
        tree = ast.parse(formula.strip(), mode="eval")
    except SyntaxError as error:
        raise Error(Fault(f'the formula "{formula.strip()}" is not complete or has a mistake: {error.msg}', "", column=error.offset)) from None
    code = walk(tree.body)
    if "r" not in used:
        raise Error(Fault(f'the formula "{formula.strip()}" does not depend on the distance', "write it with r"))
    return code, used


def _manifest(formula: str, name: str, identity: str, given: dict[str, tuple[float, str]], reach: tuple[float, str]) -> dict[str, Any]:
    def entry(parameter: str, value: float, unit: str) -> dict[str, Any]:
        usual = sorted((value / 10, value * 10)) if value else [-1.0, 1.0]
        return {"name": parameter.lower(), "unit": unit, "default": value, "usual": usual,
                **({"exclusiveMinimum": 0} if value > 0 else {}), "doc": f"{parameter} of the formula."}

    cutoff = {**entry("cutoff", *reach), "role": "cutoff", "doc": "Distance beyond which the interaction is left out."}
    return {"manifest": 1, "abi": 1, "kind": "interaction", "id": identity, "version": "1.0.0", "library": f"lib{name}.so",
            "title": f"Energy per area {' '.join(formula.split())}"[:200], "author": "rouleau.potential", "license": "MIT",
            "parameters": [*(entry(parameter, *value) for parameter, value in given.items()), cutoff],
            "needs": ["distance"], "gives": ["energy", "force", "force_by_distance"],
            "claims": {"conservative": True, "smooth_at_cutoff": False, "reproducible": True}}


def _make(home: pathlib.Path, name: str, identity: str, formula: str, translated: str, names: list[str],
          manifest: dict[str, Any]) -> None:
    """Writes, compiles and tests the plugin in another folder, which becomes `home` when all is well."""
    for tool in ("cmake", "c++"):
        if shutil.which(tool) is None:
            raise Error(Fault(f"{tool} is not in PATH; a potential is compiled", "install a C++ compiler, cmake and make "
                              "(Debian: apt install g++ cmake make)"), exit_code=4)
    home.parent.mkdir(parents=True, exist_ok=True)
    if os.statvfs(home.parent).f_flag & os.ST_NOEXEC:
        raise Error(Fault("libraries cannot be loaded from this folder: its disk is mounted without the right to execute "
                          "(noexec)", ELSEWHERE, str(home.parent)), exit_code=4)
    with tempfile.TemporaryDirectory(prefix=".making-", dir=home.parent) as scratch:
        made = pathlib.Path(scratch) / "made"
        made.mkdir()
        (made / f"{name}.json").write_text(as_json(manifest), encoding="utf-8")
        fields = [*(f'{n}{{p["{n.lower()}"]}}' for n in names), 'cutoff_{p["cutoff"]}']
        (made / f"{name}.cpp").write_text(SOURCE.format(
            title=" ".join(formula.split()).rstrip("\\"), declared=", ".join([*names, "cutoff_"]), made=", ".join(fields),
            formula=translated, id=identity), encoding="utf-8")
        (made / "CMakeLists.txt").write_text(BUILD.format(name=name), encoding="utf-8")
        _compile(made, _sdk(pathlib.Path(scratch)))
        manifest_file = made / "build" / f"{name}.json"
        answer = host.call_json("conform", manifest_file, good=(0, 3))
        bad = [check for plugin in answer["plugins"] for check in plugin["checks"]
               if check["verdict"] in ("fail", "crash", "timeout")]
        if bad:
            raise Error([Fault(_words_of(check), "", formula) for check in bad], exit_code=3)
        (made / "conforms").write_text("rouleau conform has passed\n")
        try:
            made.rename(home)
        except OSError:  # another process was quicker, or one that was interrupted left something
            if not ((home / "conforms").is_file() and (home / "build" / f"lib{name}.so").is_file()):
                shutil.rmtree(home)
                made.rename(home)


def _words_of(check: dict[str, Any]) -> str:
    """What a check of rouleau conform wants, and what it found."""
    found = f' {check["measured"]:.3g}, limit {check["limit"]:.3g}' if check.get("measured") is not None else ""
    return f'the check "{check["name"]}" failed, by which a model {check["says"]}: {check["what"]}{found}'


def _compile(made: pathlib.Path, sdk: pathlib.Path) -> None:
    build = made / "build"
    for words in (["cmake", "-S", made, "-B", build, f"-DCMAKE_PREFIX_PATH={sdk}"], ["cmake", "--build", build]):
        result = subprocess.run(list(map(str, words)), capture_output=True, text=True, stdin=subprocess.DEVNULL)
        if result.returncode != 0:
            raise Error(Fault("the potential could not be compiled:\n" + textwrap.indent((result.stdout + result.stderr).strip()[-4000:], "  "),
                              "the formula may ask for what the SDK's numbers do not have"), exit_code=3)


def _sdk(scratch: pathlib.Path) -> pathlib.Path:
    """The prefix where the SDK is installed; out of a build folder it is installed into `scratch`."""
    prefix = host.program().resolve().parent.parent
    if any((prefix / place / "RouleauConfig.cmake").is_file() for place in ("share/cmake/Rouleau", "lib/cmake/Rouleau")):
        return prefix
    if (prefix / "CMakeCache.txt").is_file():
        subprocess.run(["cmake", "--install", prefix, "--component", "sdk", "--prefix", scratch / "sdk"], check=True,
                       stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL)
        return scratch / "sdk"
    raise Error(Fault(f"the SDK is not installed in {prefix}, where the program is", "install it (rouleau-dev, or "
                      "cmake --install build/release --component sdk)"), exit_code=4)
