"""Compares the plugin interface with the description of its first release, by libabigail: fields may be appended,
nothing else. Proves on changed copies of the header that the comparison can tell. Python's standard library only.

usage: check_interface.py C_COMPILER            compare
       check_interface.py C_COMPILER --write     write a new description, for a new minor version
Exits with 77 (skipped) where abidw and abidiff are not installed.
"""

import re
import shutil
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

FOLDER = Path(__file__).resolve().parent
HEADER = FOLDER.parent.parent / "sdk/include/rouleau/plugin.h"
COMPILER = sys.argv[1] if len(sys.argv) > 1 else "cc"

# The one function reaches every struct, by pointers.
SOURCE = """#include <rouleau/plugin.h>
const rouleau_plugin* rouleau_open_v1(uint32_t host_minor) { return host_minor ? NULL : NULL; }
"""
# Nothing of the machine, and nothing that is no part of the interface.
DESCRIBE = ["abidw", "--no-show-locs", "--no-comp-dir-path", "--no-corpus-path", "--no-architecture", "--no-elf-needed",
            "--no-parameter-names", "--type-id-style", "hash"]


def version():
    text = HEADER.read_text()
    return tuple(int(re.search(rf"define ROULEAU_ABI_{part} (\d+)", text).group(1)) for part in ("MAJOR", "MINOR"))


def stored(minor):
    return FOLDER / f"interface-1.{minor}.abi"


def describe(header, folder):
    """libabigail's description of the interface that a header's text declares."""
    include = Path(folder) / "include/rouleau"
    include.mkdir(parents=True, exist_ok=True)
    (include / "plugin.h").write_text(header)
    (Path(folder) / "interface.c").write_text(SOURCE)
    subprocess.run([COMPILER, "-std=c11", "-g", "-O0", "-shared", "-fPIC", "-Iinclude", "interface.c", "-o", "interface.so"],
                   cwd=folder, check=True)
    description = Path(folder) / "interface.abi"
    description.write_text(subprocess.run([*DESCRIBE, "interface.so"], cwd=folder, check=True, capture_output=True,
                                          text=True).stdout)
    return description


# What abidiff says of a struct to which fields were appended; any other line is an incompatible change. (Its own rules
# for suppressing "fields inserted at the end" also suppress what else has changed in such a struct.)
HARMLESS = [r"Leaf changes summary: .*", r"Changed leaf types summary: .*", r"'struct \w+' changed:", r"\d+ data member insertions?:",
            r"Removed/Changed/Added functions summary: 0 Removed, 0 Changed, 0 Added functions?",
            r"Removed/Changed/Added variables summary: 0 Removed, 0 Changed, 0 Added variables?"]
GROWN = re.compile(r"type size changed from (\d+) to (\d+) \(in bits\)")
INSERTED = re.compile(r"'.+', at offset (\d+) \(in bits\)")


def incompatibilities(old, new):
    """Lines of abidiff's report that are more than fields appended; with none the interfaces are compatible."""
    report = subprocess.run(["abidiff", "--leaf-changes-only", "--harmless", "--redundant", "--no-show-locs", old, new],
                            capture_output=True, text=True)
    if report.returncode & 3:  # abidiff's own error or bad usage
        raise RuntimeError(report.stdout + report.stderr)
    found, former_size = [], None
    for line in filter(None, map(str.strip, report.stdout.splitlines())):
        grown, inserted = GROWN.fullmatch(line), INSERTED.fullmatch(line)
        if line.endswith("changed:"):
            former_size = None
        if grown and int(grown[2]) > int(grown[1]):
            former_size = int(grown[1])
        elif inserted and former_size is not None and int(inserted[1]) >= former_size:
            continue
        elif not any(re.fullmatch(pattern, line) for pattern in HARMLESS):
            found.append(line)
    return found


class Interface(unittest.TestCase):
    def setUp(self):
        self.folder = tempfile.TemporaryDirectory()
        self.addCleanup(self.folder.cleanup)
        self.header = HEADER.read_text()

    def verdict(self, header, minor=0):
        return incompatibilities(stored(minor), describe(header, self.folder.name))

    def changed(self, before, after):
        self.assertEqual(self.header.count(before), 1, f"the header has {before!r} not once")
        return self.header.replace(before, after)

    def assert_breaks(self, before, after, words):
        found = self.verdict(self.changed(before, after))
        self.assertTrue(any(words in line for line in found), found or "not found out")

    def test_the_interface_of_today_is_compatible_with_every_minor_version_so_far(self):
        for minor in range(version()[1] + 1):
            with self.subTest(minor):
                self.assertEqual(self.verdict(self.header, minor), [])

    def test_the_newest_description_is_that_of_the_header(self):
        new = describe(self.header, self.folder.name)
        report = subprocess.run(["abidiff", "--harmless", stored(version()[1]), new], capture_output=True, text=True)
        self.assertEqual(report.returncode, 0, report.stdout + "\na new minor version needs its own description: --write")

    def test_the_description_names_no_path_and_holds_every_struct_of_the_header(self):
        text = stored(version()[1]).read_text()
        self.assertNotIn("/", re.sub(r"</|/>|'void \(.*?'", "", text))
        structs = re.findall(r"^typedef struct (\w+) \{", self.header, re.MULTILINE)
        self.assertEqual(len(structs), 10)
        for struct in structs:
            self.assertIn(f"<class-decl name='{struct}'", text)

    def test_a_field_appended_to_any_struct_is_compatible(self):
        structs = re.findall(r"^\} (rouleau_\w+);", self.header, re.MULTILINE)
        for struct in structs:
            with self.subTest(struct):
                self.assertEqual(self.verdict(self.changed(f"}} {struct};", f"  double* appended;\n}} {struct};")), [])

    def test_a_field_appended_to_every_struct_at_once_is_compatible(self):
        header = re.sub(r"^\} (rouleau_\w+);", r"  void (*appended)(void);\n} \1;", self.header, flags=re.MULTILINE)
        self.assertEqual(self.verdict(header), [])

    def test_a_field_inserted_is_found_out(self):
        self.assert_breaks("  double relaxation_rate;", "  double inserted;\n  double relaxation_rate;", "'double inserted'")

    def test_a_field_inserted_beside_one_appended_is_found_out(self):
        header = self.changed("  double relaxation_rate;", "  double inserted;\n  double relaxation_rate;")
        header = header.replace("} rouleau_setup;", "  double appended;\n} rouleau_setup;")
        self.assertTrue(any("'double inserted'" in line for line in self.verdict(header)))

    def test_a_field_put_into_padding_is_found_out(self):
        # Between struct_size and the first pointer there are four bytes; struct_size would not tell of it.
        self.assert_breaks("typedef struct rouleau_membrane {\n  uint32_t struct_size;",
                           "typedef struct rouleau_membrane {\n  uint32_t struct_size, padding;", "type size hasn't changed")

    def test_a_field_removed_is_found_out(self):
        self.assert_breaks("  const double* curvature; ", "  ", "curvature'")

    def test_the_last_field_removed_is_found_out(self):
        self.assert_breaks("  const rouleau_interaction* interaction;\n", "", "interaction'")

    def test_a_type_changed_is_found_out_even_if_its_size_is_the_same(self):
        self.assert_breaks("  double time_step; /* as in", "  int64_t time_step; /* as in", "time_step")

    def test_fields_of_one_type_in_another_order_are_found_out(self):
        header = self.changed("  double* moment; ", "  double* tmp; ")
        header = header.replace("  double* tension; ", "  double* moment; ").replace("  double* tmp; ", "  double* tension; ")
        self.assertTrue(any("tension" in line for line in self.verdict(header)))

    def test_a_function_that_takes_or_returns_something_else_is_found_out(self):
        self.assert_breaks("double (*cutoff)(const void* self)", "float (*cutoff)(const void* self)", "cutoff")
        self.assert_breaks("char* error, size_t error_size)", "char* error, uint32_t error_size)", "create")

    def test_a_table_that_is_no_list_of_pointers_any_more_is_found_out(self):
        self.assert_breaks("  const rouleau_model* const* models;", "  const rouleau_model* models;", "models")


if __name__ == "__main__":
    if not (shutil.which("abidw") and shutil.which("abidiff")):
        print("skipped: abidw and abidiff are not installed (Debian package abigail-tools)")
        sys.exit(77)
    if "--write" in sys.argv:
        with tempfile.TemporaryDirectory() as work:
            stored(version()[1]).write_text(describe(HEADER.read_text(), work).read_text())
        sys.exit(0)
    program = unittest.main(argv=sys.argv[:1], verbosity=2, exit=False)
    sys.exit(0 if program.result.wasSuccessful() else 1)
