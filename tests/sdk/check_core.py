"""The simulator as a library: installed without the program, found by CMake, its example built and run against it.

usage: check_core.py SOURCE BUILD CMAKE
"""

from staged import SOURCE, Case, files, main

PROJECT = """cmake_minimum_required(VERSION 3.20)
project(made LANGUAGES CXX)
find_package(Rouleau REQUIRED COMPONENTS core)
add_executable(core core.cpp)
target_link_libraries(core PRIVATE Rouleau::core)
"""


class The_core_is_a_library(Case):
    def project(self):
        project = self.path / "project"
        project.mkdir()
        (project / "CMakeLists.txt").write_text(PROJECT)
        (project / "core.cpp").write_text((SOURCE / "examples/core.cpp").read_text())
        return project

    def test_two_capsules_shear_in_a_program_that_reads_no_file(self):
        prefix = self.install(self.path / "core", "sdk", "core")
        build = self.build(self.project(), prefix, "-DCMAKE_BUILD_TYPE=Release",
                           "-DCMAKE_CXX_FLAGS=-Wall -Wextra -Wpedantic -Werror")
        rows = [[float(n) for n in line.split()] for line in self.call(build / "core").splitlines()]
        self.assertEqual(len(rows), 5)
        for left, right in rows:
            self.assertAlmostEqual(left, right, delta=1e-4)  # the same capsule, half a period apart
        self.assertTrue(0.05 < rows[-1][0] < 0.6, rows)
        libraries = self.call("ldd", build / "core")
        for foreign in ("hdf5", "udunits", "boost"):
            self.assertNotIn(foreign, libraries)

    def test_without_it_the_package_says_so(self):
        prefix = self.install(self.path / "sdk", "sdk")
        self.assertIn("has no component core", self.build(self.project(), prefix, expect=1))

    def test_its_headers_include_nothing_of_the_host_but_base_and_core(self):
        prefix = self.install(self.path / "core", "core")
        for header in files(prefix / "include/rouleau/host"):
            self.assertTrue(header.startswith(("base/", "core/")), header)


if __name__ == "__main__":
    main()
