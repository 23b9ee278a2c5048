"""The house keeps its order: includes run down only, folders stay small, and no name has two definitions.

usage: check_house.py SOURCE
"""

import collections
import re
import sys
import tempfile
import unittest
from pathlib import Path

SOURCE = Path(sys.argv[1])
HOST = SOURCE / "host"

# A folder may include those before it (docs/architecture.md); core is what everything else stands on.
ORDER = ["base", "json", "units", "hdf5", "core", "scene", "shape", "plugin", "plan", "observe", "monitor", "files", "run",
         "report", "trial", "accuracy", "study", "stability", "conform", "transport", "command"]
MOST_UNITS = 20
# Outside command/ nobody speaks of the command line, but for these files.
SPEAK = {"trial/trial.cpp": "gives a child its options", "json/set_option.cpp": "reads the text of --set"}


def sources():
    return sorted(p for p in HOST.rglob("*") if p.suffix in (".cpp", ".hpp"))


def room(path):
    parts = path.relative_to(HOST).parts
    return parts[0] if len(parts) > 1 else "command"  # the programs


def includes(path):
    """Files of the host that a file includes, as paths."""
    for name in re.findall(r'^#include "([^"]+)"', path.read_text(), re.M):
        beside, from_host = path.parent / name, HOST / name
        found = beside if beside.exists() else from_host
        if found.exists():
            yield found


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
        self.assertEqual({room(p) for p in sources()}, set(ORDER))

    def test_no_include_points_up(self):
        up = collections.defaultdict(list)
        for path in sources():
            own = room(path)
            for other in includes(path):
                if ORDER.index(room(other)) > ORDER.index(own):
                    up[own, room(other)].append(f"{path.relative_to(HOST)} includes {other.relative_to(HOST)}")
        self.assertEqual(dict(up), {})

    def test_the_core_includes_base_and_itself_alone(self):
        for path in sources():
            if room(path) == "core":
                self.assertLessEqual({room(other) for other in includes(path)}, {"base", "core"}, path)
                self.assertNotRegex(path.read_text(), r"#include <(nlohmann|boost|hdf5|udunits2|filesystem|fstream|iostream)",
                                    path)

    def test_json_is_read_by_one_header(self):
        """It refuses what is no whole number; a file that includes the library alone would cast."""
        direct = {str(path.relative_to(HOST)) for path in sources() if "#include <nlohmann/" in path.read_text()}
        self.assertEqual(direct, {"json/json.hpp", "base/text.cpp"})  # the latter stands below, and writes only

    def test_a_folder_is_a_namespace(self):
        for path in sources():
            if len(path.relative_to(HOST).parts) == 1:
                continue
            wanted = "rouleau" if room(path) == "base" or path.name == "core.hpp" else f"rouleau::{room(path)}"
            own = re.findall(r"^namespace (rouleau[\w:]*) \{", path.read_text(), re.M)
            self.assertIn(wanted, own or [wanted], path)

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
            if room(path) != "command" and re.search(option_or_command, words):
                found.add(str(path.relative_to(HOST)))
        self.assertEqual(found, set(SPEAK))

    def test_exit_codes_are_known_to_the_commands_and_to_trials(self):
        for path in sources():
            if re.search(r"\bexit_code::", path.read_text()):
                self.assertIn(room(path), ("command", "trial"), path)


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
    result = unittest.main(argv=sys.argv[:1], exit=False, verbosity=2).result
    failed = len(result.failures) + len(result.errors)
    print(f"{result.testsRun - failed} passed, {failed} failed")
    sys.exit(failed > 0)
