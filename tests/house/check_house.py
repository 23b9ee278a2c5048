"""The house keeps its order: includes run down only and in no circle, lines, functions, units and folders stay small, the map
of docs/architecture.md is that of the includes, and no name has two definitions. The package's modules import each other in no circle.

usage: check_house.py SOURCE [--write-map]
  --write-map   writes the arrows of the map's tables from the includes, and checks nothing
"""

import ast
import collections
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1])
HOST, TOOLS = SOURCE / "host", SOURCE / "tools"
PACKAGE = SOURCE / "python/rouleau"
MAP = SOURCE / "docs/architecture.md"

# A folder may include those before it (docs/architecture.md); core is what everything else stands on.
CORE = ["core/domain", "core/model", "core/geometry", "core/fluid", "core/membrane", "core/cells", "core/surface", "core/contact", "core/coupling",
        "core/solver", "core/ranks", "core"]  # some of them are planned
ORDER = ["base", "json", "units", "hdf5", *CORE, "scene", "shape", "plugin", "plan", "observe", "monitor", "files", "run",
         "report", "trial", "accuracy", "study", "stability", "transport", "command", "conform"]
EVERYONES = {"base", "json", "units", "hdf5"}  # not drawn in the map
MOST_UNITS = 20
MOST_COLUMNS = 120
MOST_LINES_OF_FUNCTION = 80
MOST_LINES_OF_UNIT = 450
# This number may fall; it may not rise.
# Lines above core that ask whether there are two dimensions or three. What holds for x holds for y and z: loops over the axes of a
# scene::Vector, words from scene/dimension_words.hpp, templates in D, constants in arrays of both.
BRANCHES_ON_DIMENSION = 37
ASKS = re.compile(r"\bif\b|\?|[=!]=|&&|\|\||!")
DIMENSION = re.compile(r"\b(D|dimensions?_?(\(\))?)\s*[=!<>]=?\s*[23D]|\b(is_|of_)?(in_)?space_?(\(\))?\s*(\?|\)|&&|\|\||;|,)|\bin_space\b"
                       r"|\.z\.empty\(\)")
# Outside command/ nobody speaks of the command line, but for these files.
SPEAK = {"trial/trial.cpp": "gives a child its options", "json/document.cpp": "reads the text of --set",
         "conform/program.cpp": "is a program", "conform/check_program.cpp": "is a program"}


def sources():
    return sorted(p for root in (HOST, TOOLS) for p in root.rglob("*") if p.suffix in (".cpp", ".hpp"))


def place(path):
    """The path below host/ or tools/."""
    return path.relative_to(TOOLS if path.is_relative_to(TOOLS) else HOST)


def room(path):
    """The folder below host/ or tools/, or below core/; the host's programs belong to command."""
    folders = place(path).parts[:-1]
    return "/".join(folders[:2] if folders[:1] == ("core",) else folders[:1]) or "command"


def top(path):
    return room(path).split("/")[0]


def unit(path):
    return str(place(path).with_suffix(""))


def includes(path):
    """Files of the house that a file includes, as paths."""
    for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
        yield from [file for file in (path.parent / name, HOST / name, TOOLS / name) if file.exists()][:1]


def circles(arrows):
    """Groups of at least two that reach each other (Tarjan); arrows: {name: names}."""
    number, lowest, stack, found = {}, {}, [], []

    def visit(name):
        number[name] = lowest[name] = len(number)
        stack.append(name)
        for other in arrows.get(name, ()):
            if other not in number:
                visit(other)
            if other in stack:
                lowest[name] = min(lowest[name], lowest[other])
        if lowest[name] == number[name]:
            group = stack[stack.index(name):]
            del stack[stack.index(name):]
            if len(group) > 1:
                found.append(sorted(group))

    for name in arrows:
        if name not in number:
            visit(name)
    return found


def unit_arrows():
    arrows = collections.defaultdict(set)
    for path in sources():
        arrows[unit(path)] |= {unit(other) for other in includes(path)} - {unit(path)}
    return arrows


def package_arrows():
    """Modules of the package that each imports: also within functions, and for types alone."""
    arrows = {}
    for path in sorted(PACKAGE.glob("*.py")):
        imports = [node for node in ast.walk(ast.parse(path.read_text())) if isinstance(node, ast.ImportFrom) and node.level]
        arrows[path.stem] = {name for node in imports for name in ([node.module] if node.module else [entry.name for entry in node.names])}
    return arrows


def functions(text):
    """(name line, lines) of the functions at namespace scope and in classes, by the indentation that clang-format gives."""
    for indent in ("", "  "):
        start = None
        for number, line in enumerate(text.splitlines()):
            if line == indent + "}" and start is not None:
                yield start[1].strip(), number - start[0] + 1
                start = None
            elif re.match(indent + r"(?!namespace|template|public|private|protected|class|struct|enum)[A-Za-z~\[]", line):
                start = number, line


def map_arrows():
    """{room: rooms that it includes}, as the map draws them: core's folders from each other, other rooms from all of core."""
    arrows = collections.defaultdict(set)
    for path in sources():
        for other in includes(path):
            if "/" in room(path) and top(other) == "core":
                arrows[room(path)].add(room(other))
            arrows[top(path)].add(top(other))
    return {name: sorted(others - {name, *EVERYONES}, key=ORDER.index) for name, others in arrows.items()}


def with_map(text):
    """The text of docs/architecture.md with the arrows of the includes in the last column of its two tables of rooms."""
    arrows = map_arrows()

    def row(found):
        others = ", ".join(other.removeprefix("core/") for other in arrows.get(found[1], ())) or "-"
        return f"| {found[1]}{found[2]} |{found[3]}| {others} |"
    return re.sub(r"^\| ([a-z0-9/]+?)(/?) \|(.*)\|[^|\n]*\|$",
                  lambda found: row(found) if found[1] in ORDER else found[0], text, flags=re.M)


def type_definitions(files):
    """{qualified name: files} of the classes, structs and enumerations that are defined at namespace scope, where
    clang-format leaves them at the line's beginning; those of anonymous namespaces belong to their file alone."""
    found = collections.defaultdict(list)
    for path in files:
        namespaces = []
        for line in path.read_text().splitlines():
            if opened := re.match(r"namespace ?([\w:]*) \{(.*)", line):
                if "}" not in opened[2]:
                    namespaces.append(opened[1])
            elif line.startswith("}  // namespace"):
                namespaces.pop()
            elif defined := re.match(r"(?:struct|class|enum class|enum|union) (\w+)(?: final)?(?: :[^;]*)? \{", line):
                if "" not in namespaces:
                    found["::".join([*namespaces, defined[1]])].append(str(path))
    return found


class Includes_run_down(unittest.TestCase):
    def test_every_folder_has_a_place_in_the_order(self):
        self.assertLessEqual({room(p) for p in sources()}, set(ORDER))

    def test_no_include_points_up(self):
        up = collections.defaultdict(list)
        for path in sources():
            own = room(path)
            for other in includes(path):
                if ORDER.index(room(other)) > ORDER.index(own):
                    up[own, room(other)].append(f"{place(path)} includes {place(other)}")
        self.assertEqual(dict(up), {})

    def test_the_core_includes_base_and_itself_alone(self):
        for path in sources():
            if top(path) == "core":
                self.assertLessEqual({top(other) for other in includes(path)}, {"base", "core"}, path)
                self.assertNotRegex(path.read_text(), r"#include <(nlohmann|boost|hdf5|udunits2|filesystem|fstream|iostream)",
                                    path)

    def test_json_is_read_by_one_header(self):
        """It refuses what is no whole number; a file that includes the library alone would cast."""
        direct = {str(place(path)) for path in sources() if "#include <nlohmann/" in path.read_text()}
        self.assertEqual(direct, {"json/json.hpp", "base/text.cpp"})  # the latter stands below, and writes only

    def test_a_folder_is_a_namespace(self):
        for path in sources():
            if len(place(path).parts) == 1:
                continue
            wanted = "rouleau" if room(path) == "base" or path.name == "core.hpp" else f"rouleau::{top(path)}"
            own = re.findall(r"^namespace (rouleau[\w:]*) \{", path.read_text(), re.M)
            self.assertIn(wanted, own or [wanted], path)

    def test_no_units_include_each_other_in_a_circle(self):
        self.assertEqual(circles(unit_arrows()), [])

    def test_no_modules_of_the_package_import_each_other_in_a_circle(self):
        arrows = package_arrows()
        self.assertLessEqual({"drawing", "errors"}, arrows["reading"])
        self.assertEqual(circles(arrows), [])

    def test_the_map_is_drawn_from_the_includes(self):
        map_of_the_house = MAP.read_text()
        self.assertEqual(map_of_the_house, with_map(map_of_the_house), "check_house.py SOURCE --write-map writes it")
        rooms = set(re.findall(r"^\| ([a-z0-9/]+?)/? \|", map_of_the_house, re.M))
        self.assertLessEqual({room(p) for p in sources()} | {top(p) for p in sources()}, rooms)

    def test_a_circle_is_found(self):
        self.assertEqual(circles({"a": ["b"], "b": ["c", "d"], "c": ["a"], "d": ["e"], "e": []}), [["a", "b", "c"]])


class What_is_read_at_once_stays_small(unittest.TestCase):
    def test_lines_end_within_120_columns(self):
        found = [f"{place(path)}:{number}" for path in sources()
                 for number, line in enumerate(path.read_text().splitlines(), 1) if len(line) > MOST_COLUMNS]
        self.assertEqual(found, [])

    def test_functions_have_less_than_80_lines(self):
        for path in sources():
            for name, lines in functions(path.read_text()):
                self.assertLess(lines, MOST_LINES_OF_FUNCTION, f"{place(path)}: {name}")

    def test_units_have_less_than_450_lines(self):
        units = collections.Counter()
        for path in sources():
            units[unit(path)] += len(path.read_text().splitlines())
        for name, lines in units.items():
            self.assertLess(lines, MOST_LINES_OF_UNIT, name)

    def test_functions_are_measured(self):
        text = "namespace a {\nstruct B {\n  int c() {\n    return 1;\n  }\n};\nvoid d(int e,\n       int f) {\n  g();\n}\n}\n"
        self.assertEqual(sorted(functions(text)), [("int c() {", 3), ("void d(int e,", 4)])

    def test_few_lines_above_core_ask_for_the_dimension(self):
        found = [f"{place(path)}: {line}" for path in sources() if top(path) != "core" and path.is_relative_to(HOST)
                 for line in re.sub(
                     r'"(\\.|[^"\\])*"|//.*', "", path.read_text()).splitlines() if ASKS.search(line) and DIMENSION.search(line)]
        self.assertLessEqual(len(found), BRANCHES_ON_DIMENSION, found)

    def test_no_folder_is_crowded(self):
        for folder in {p.parent for p in sources()}:
            units = {p.stem for p in folder.iterdir() if p.suffix in (".cpp", ".hpp")}
            self.assertLessEqual(len(units), MOST_UNITS, folder)


class The_command_line_stays_in_command(unittest.TestCase):
    def test_no_message_below_names_an_option_or_a_command(self):
        found = set()
        for path in sources():
            code = re.sub(r"^\s*//.*$|  //.*$", "", path.read_text().replace("'\"'", ""), flags=re.M)
            words = "\n".join(re.findall(r'"((?:[^"\\\n]|\\.)*)"', code))
            option_or_command = r"(?<![\w-])--[a-z]|\brouleau (run|plan|plugins|conform|new|study|limits|report)\b"
            if top(path) != "command" and re.search(option_or_command, words):
                found.add(str(place(path)))
        self.assertEqual(found, set(SPEAK))

    def test_exit_codes_are_known_to_the_commands_and_to_trials(self):
        for path in sources():
            if re.search(r"\bexit_code::", path.read_text()):
                self.assertIn(room(path), ("command", "trial", "conform"), path)


class A_type_has_one_definition(unittest.TestCase):
    """Two of one name merge without a word when the program is linked: of two destructors one is called for both."""

    def test_no_qualified_name_is_defined_twice(self):
        found = type_definitions(sources())
        self.assertGreater(len(found), 250)
        self.assertEqual({name: files for name, files in found.items() if len(files) > 1}, {})

    def test_two_definitions_of_one_name_are_found(self):
        with tempfile.TemporaryDirectory() as folder:
            files = [Path(folder) / "trial.hpp", Path(folder) / "trials.hpp", Path(folder) / "own.cpp"]
            for file, text in zip(files, ("struct Trial {\n  int a;\n};\n", "class Trial : public Base {\n};\n",
                                          "namespace {\nstruct Trial {\n};\n}  // namespace\n")):
                file.write_text(f"namespace rouleau::made {{\n{text}}}  // namespace rouleau::made\n")
            self.assertEqual(type_definitions(files), {"rouleau::made::Trial": [str(files[0]), str(files[1])]})


if __name__ == "__main__":
    if sys.argv[2:] == ["--write-map"]:
        MAP.write_text(with_map(MAP.read_text()))
        sys.exit()
    result = unittest.main(argv=sys.argv[:1], exit=False, verbosity=2).result
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    sys.exit(failed > 0)
