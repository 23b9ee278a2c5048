"""What is installed: the SDK alone and complete, movable, found by CMake and pkg-config, with headers that need nothing.

usage: check_install.py SOURCE BUILD CMAKE
"""

import json
import re
import shutil
import unittest

from staged import COMPONENTS, SOURCE, Case, files, main

SDK = SOURCE / "sdk"
PROJECT = """cmake_minimum_required(VERSION 3.20)
project(made LANGUAGES {languages})
find_package(Rouleau 0.1 REQUIRED)
enable_testing()
rouleau_add_plugin(made)
rouleau_add_conformance_test(made)
"""


class The_SDK_installs_alone(Case):
    def test_it_has_what_an_author_needs_and_nothing_else(self):
        wanted = {f"include/{f}" for f in files(SDK / "include")}
        wanted |= {f"share/rouleau/schema/{f}" for f in files(SDK / "schema")}
        wanted |= {f"share/rouleau/sdk/{part}/{f}" for part in ("template", "examples") for f in files(SDK / part)}
        wanted |= {"share/rouleau/sdk/README.md", "share/rouleau/sdk/LICENSE", "share/pkgconfig/rouleau-sdk.pc"}
        wanted |= {f"share/cmake/Rouleau/{f}" for f in ("RouleauConfig.cmake", "RouleauConfigVersion.cmake",
                                                       "RouleauTargets.cmake", "RouleauPlugin.cmake", "rouleau-plugin.map")}
        self.assertEqual(files(self.install(self.path / "sdk", "sdk")), wanted)

    def test_all_components_together_are_what_is_installed_without_naming_one(self):
        whole = files(self.install(self.path / "whole"))
        self.assertEqual(files(self.install(self.path / "parts", *COMPONENTS)), whole)
        self.assertIn("bin/rouleau", whole)
        self.assertIn("share/rouleau/schema/scene.schema.json", whole)
        parts = [files(self.install(self.path / c, c)) for c in COMPONENTS]
        self.assertEqual(sum(map(len, parts)), len(whole))  # no file belongs to two

    def test_no_installed_file_names_the_folder_it_was_installed_into_or_built_in(self):
        prefix = self.install(self.path / "sdk", "sdk")
        for file in files(prefix):
            text = (prefix / file).read_text()
            self.assertNotIn(str(self.path), text, file)
            self.assertNotIn(str(SOURCE), text, file)


class Headers_need_nothing(Case):
    LANGUAGES = {"plugin.h": ["c11", "c++17"]}

    def test_they_include_only_each_other_and_the_standard_library(self):
        for header in (SDK / "include/rouleau").iterdir():
            for name in re.findall(r"#include <(.*)>", header.read_text()):
                # No name of the C++ library has a dot or a slash.
                self.assertRegex(name, r"^(std(def|int)\.h|[a-z_]+)$", header)

    def test_each_compiles_alone_without_a_warning_in_c11_or_c_plus_plus_17(self):
        include = self.install(self.path / "sdk", "sdk") / "include"
        compilers = [c for c in (("gcc", "g++"), ("clang", "clang++")) if shutil.which(c[0]) and shutil.which(c[1])]
        self.assertTrue(compilers)
        for header in sorted(p.name for p in (include / "rouleau").iterdir()):
            for standard in self.LANGUAGES.get(header, ["c++17"]):
                language, suffix = ("c++", "cpp") if "+" in standard else ("c", "c")
                file = self.path / f"alone.{suffix}"
                file.write_text(f"#include <rouleau/{header}>\n")
                for compiler in compilers:
                    with self.subTest(header, standard=standard, compiler=compiler[language == "c++"]):
                        self.call(compiler[language == "c++"], f"-std={standard}", "-Wall", "-Wextra", "-Wpedantic",
                                  "-Werror", "-fsyntax-only", "-I", include, file)


class The_package_is_found_where_it_was_moved_to(Case):
    def setUp(self):
        super().setUp()
        self.install(self.path / "first", "sdk")
        self.prefix = (self.path / "first").rename(self.path / "moved here")

    def project(self, name, languages="CXX", source=SDK / "template/interaction/model-name.cpp"):
        folder = self.path / name
        folder.mkdir()
        (folder / "CMakeLists.txt").write_text(PROJECT.format(languages=languages))
        if source:
            shutil.copy(source, folder / f"made{source.suffix}")
        manifest = json.loads((SDK / "template/interaction/model-name.json").read_text())
        (folder / "made.json").write_text(json.dumps({**manifest, "library": "libmade.so"}))
        return folder

    def test_cmake_builds_a_plugin_of_cpp_or_of_c_that_exports_one_function_beside_its_manifest(self):
        for name, languages, source in (("cpp", "CXX", SDK / "template/interaction/model-name.cpp"),
                                        ("c", "C", SDK / "examples/morse-in-c/morse-in-c.c")):
            with self.subTest(name):
                project = self.project(name, languages, source)
                (project / "CMakePresets.json").write_text('{"version": 3}')  # no manifest
                build = self.build(project, self.prefix, "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
                listing = self.call("nm", "-D", "--defined-only", build / "libmade.so").split()
                self.assertEqual(listing[1:], ["T", "rouleau_open_v1"])
                self.assertTrue((build / "made.json").exists())
                self.assertFalse((build / "CMakePresets.json").exists())
                command = json.loads((build / "compile_commands.json").read_text())[0]["command"]
                for flag in ("-O3", "-fno-math-errno", "-fno-trapping-math", "-fvisibility=hidden"):
                    self.assertIn(flag, command.split())

    def test_a_build_type_and_a_standard_that_were_chosen_stay(self):
        build = self.build(self.project("chosen"), self.prefix, "-DCMAKE_BUILD_TYPE=Debug", "-DCMAKE_CXX_STANDARD=20",
                           "-DCMAKE_EXPORT_COMPILE_COMMANDS=ON")
        command = json.loads((build / "compile_commands.json").read_text())[0]["command"].split()
        self.assertIn("-g", command)
        self.assertIn("-std=gnu++20", command)

    def test_without_a_program_the_conformance_test_is_left_out_with_a_word_on_how_to_get_it(self):
        self.environment["PATH"] = "/usr/bin:/bin"
        project = self.project("no-program")
        words = self.call("cmake", "-S", project, "-B", self.path / "b", f"-DCMAKE_PREFIX_PATH={self.prefix}")
        self.assertIn("conform_made is left out", words)
        self.assertIn("-DROULEAU_PROGRAM", words)

    def test_a_missing_source_or_manifest_is_named(self):
        words = self.build(self.project("no-source", source=None), self.prefix, expect=1)
        self.assertRegex(" ".join(words.split()), r"neither made\.cpp nor made\.c is in")
        project = self.project("no-manifest")
        (project / "made.json").unlink()
        self.assertRegex(" ".join(self.build(project, self.prefix, expect=1).split()), r"no manifest, made\.json, is in")

    @unittest.skipUnless(shutil.which("pkg-config"), "there is no pkg-config")
    def test_the_command_for_other_build_systems_in_the_document_makes_a_plugin(self):
        text = (SDK / "README.md").read_text()
        command = re.search(r"^    c\+\+ (?:.*\\\n)*.*libyukawa\.so$", text, re.MULTILINE).group(0)
        prefix = self.prefix.rename(self.path / "moved")  # pkg-config escapes spaces, which $(...) does not read
        self.environment["PKG_CONFIG_PATH"] = str(prefix / "share/pkgconfig")
        shutil.copy(SDK / "template/interaction/model-name.cpp", self.path / "yukawa.cpp")
        self.call("sh", "-ec", command)
        listing = self.call("nm", "-D", "--defined-only", self.path / "libyukawa.so").split()
        self.assertEqual(listing[1:], ["T", "rouleau_open_v1"])
        schemas = self.call("pkg-config", "--variable=schemadir", "rouleau-sdk").strip()
        self.assertEqual(files(schemas), files(SDK / "schema"))


class The_document_tells_what_is_so(Case):
    TEXT = (SDK / "README.md").read_text()

    def test_every_field_of_the_interface_is_in_it(self):
        header = re.sub(r"/\*.*?\*/", "", (SDK / "include/rouleau/plugin.h").read_text(), flags=re.DOTALL)
        structs = re.findall(r"typedef struct (\w+) \{(.*?)\} \1;", header, re.DOTALL)
        self.assertGreaterEqual(len(structs), 10)
        for name, body in structs:
            for declaration in filter(str.strip, body.split(";")):
                function = re.search(r"\(\*(\w+)\)", declaration)
                fields = [function.group(1)] if function else re.findall(r"(\w+)\s*(?:,|$)", declaration.strip())
                self.assertTrue(fields, declaration)
                for field in fields:
                    self.assertIn(f"`{field}`", self.TEXT, f"{name}::{field}")

    def test_every_key_of_a_manifest_is_in_it(self):
        def keys(rule):
            if isinstance(rule, dict):
                yield from rule.get("properties", {})
                for value in rule.values():
                    yield from keys(value)

        for key in set(keys(json.loads((SDK / "schema/manifest.schema.json").read_text()))):
            self.assertIn(f"`{key}`", self.TEXT)

    def test_the_lines_it_counts_are_those_there_are(self):
        def lines(file):
            return sum(1 for line in file.read_text().splitlines() if line.split("//")[0].strip())

        sentence = " ".join(re.search(r"Lines of source.*?`bgk`\)", self.TEXT, re.DOTALL).group(0).split())
        kinds = ("interaction", "membrane", "collision")
        templates = [str(lines(SDK / "template" / kind / "model-name.cpp")) for kind in kinds]
        self.assertIn(f"| template | {' | '.join(templates)} |", sentence)
        for kind in kinds:
            shipped = {f.stem: lines(f) for f in (SOURCE / "plugins" / kind).glob("*/*.cpp")}
            named = [(int(n), name) for n, name in re.findall(r"(\d+) \(`([a-z-]+)`\)", sentence) if name in shipped]
            self.assertEqual([(n, shipped[name]) for n, name in named], [(min(shipped.values()),) * 2])


if __name__ == "__main__":
    main()
