"""Debian packages made from this build and unpacked, not installed; and the libraries that the tarball brings along.

usage: check_packages.py SOURCE BUILD CMAKE
"""

import gzip
import re
import sys
from pathlib import Path

sys.dont_write_bytecode = True
sys.path.insert(0, str(Path(__file__).resolve().parents[1] / "sdk"))

from staged import BUILD, CMAKE, COMPONENTS, SCENE, SOURCE, TRANSPORTS, Case, files, main  # noqa: E402

PARTS = {"rouleau": {"program", "plugins", "scenes", "documentation"}, "rouleau-dev": {"sdk", "core"},
         "python3-rouleau": {"python"}, **{f"rouleau-{mpi}": {mpi} for mpi in TRANSPORTS}}
COMPILERS = ("libc.so", "libm.so", "libmvec.so", "libdl.so", "librt.so", "libpthread.so", "libresolv.so", "libstdc++.so",
             "libgcc_s.so", "ld-linux", "linux-vdso")


class Packages(Case):
    def setUp(self):
        super().setUp()
        self.environment = {"PATH": "/usr/bin:/bin"}

    def runs_from(self, prefix):
        """What a user does first, in an empty environment; the plugins that the program found."""
        self.environment = {}
        program = prefix / "bin/rouleau"
        listing = self.call(program, "plugins", "--paths")
        self.call(program, "plan", prefix / "share/rouleau/scenes" / SCENE.name)
        self.call(program, "run", prefix / "share/rouleau/scenes" / SCENE.name, "--max-steps", "5", "--out", self.path / "run")
        self.call(program, "verify", self.path / "run")
        return {Path(p) for p in re.findall(r"^ +(/.*\.json)$", listing, re.MULTILINE)}


class Debian_packages(Packages):
    def setUp(self):
        super().setUp()
        # One call serves all tests here: it takes most of their time.
        words = self.call(Path(CMAKE).with_name("cpack"), "--config", BUILD / "CPackConfig.cmake", "-G", "DEB", "-B", self.path / "made",
                          "-D", "CPACK_DEBIAN_COMPRESSION_TYPE=gzip")
        self.assertNotIn("Warning", words)
        self.unpacked, self.fields = {}, {}
        for package in (self.path / "made").glob("*.deb"):
            fields = dict(re.findall(r"^([A-Z][\w-]*): (.*)$", self.call("dpkg-deb", "--field", package), re.MULTILINE))
            self.fields[fields["Package"]] = fields
            self.unpacked[fields["Package"]] = self.path / fields["Package"]
            self.call("dpkg-deb", "--extract", package, self.path / fields["Package"])

    def test_each_file_is_in_the_package_that_is_for_it_and_the_program_runs_where_it_was_unpacked(self):
        wanted = {name for name, parts in PARTS.items() if parts & set(COMPONENTS)}
        self.assertEqual(set(self.unpacked), wanted)
        for name, root in self.unpacked.items():
            with self.subTest(name):
                installed = files(self.install(self.path / f"{name}-installed", *PARTS[name]))
                installed = {f"usr/{f}.gz" if "/man/" in f else f"usr/{f}" for f in installed}
                for said in ("copyright", "changelog.gz", "changelog.Debian.gz"):
                    installed.add(f"usr/share/doc/{name}/{said}")
                self.assertEqual(files(root), installed)
                changes = gzip.decompress((root / f"usr/share/doc/{name}/changelog.gz").read_bytes())
                self.assertEqual(changes, (SOURCE / "CHANGELOG.md").read_bytes())

        needs = self.fields["rouleau"]["Depends"]
        for library in ("libc6", "libhdf5-103", "libudunits2-0", "libboost-program-options", "libgomp1"):
            self.assertIn(library, needs)
        self.assertNotRegex(needs, r"-dev|g\+\+|cmake|python|mpi")
        if "openmpi" in TRANSPORTS:
            self.assertRegex(self.fields["rouleau-openmpi"]["Depends"], r"libopenmpi3.*rouleau \(= |rouleau \(= .*libopenmpi3")
        self.assertEqual(self.fields["rouleau-dev"]["Depends"], "libeigen3-dev (>= 3.4)")
        interface = re.findall(r"^#define ROULEAU_ABI_M\w+ (\d+)", (SOURCE / "sdk/include/rouleau/plugin.h").read_text(), re.MULTILINE)
        self.assertEqual(self.fields["rouleau"]["Provides"],
                         f"rouleau-plugin-interface-{interface[0]} (= {'.'.join(interface)})")
        version = re.search(r"project\(Rouleau VERSION ([\d.]+)", (SOURCE / "CMakeLists.txt").read_text())[1]
        self.assertEqual({f["Version"] for f in self.fields.values()}, {f"{version}-1"})

        prefix = self.unpacked["rouleau"] / "usr"
        self.assertEqual(self.runs_from(prefix), set((prefix / "lib/rouleau/plugins").rglob("*.json")))


class The_libraries_of_the_tarball(Packages):
    def test_programs_take_all_but_the_compilers_and_the_units_from_the_folder_wherever_it_is_and_each_has_its_licence(self):
        prefix = self.install(self.path / "first", "program", "plugins", "scenes", "python", "libraries").rename(self.path / "moved here")
        own = prefix / "lib/rouleau/libraries"
        modules = list((prefix / "lib/python3/dist-packages/rouleau").glob("_core.*.so"))
        for program in (prefix / "bin/rouleau", *(prefix / "libexec/rouleau").iterdir(), *modules):
            taken = re.findall(r"^\s*(\S+)(?: => (.*))? \(0x", self.call("ldd", program), re.MULTILINE)
            self.assertTrue(any(name.startswith("libudunits2") for name, _ in taken), program)
            for name, place in taken:
                if not Path(name).name.startswith(COMPILERS):
                    self.assertEqual(Path(place).parent.resolve(), own, f"{program.name}: {name} => {place}")

        owners = self.call("dpkg-query", "--search", *(f"*/{f.name}" for f in own.iterdir() if not f.is_symlink()))
        self.assertEqual(files(prefix / "share/doc/rouleau/libraries"), {line.split(":")[0] for line in owners.splitlines()})

        self.assertTrue(self.runs_from(prefix))
        ways = [(4, prefix / "bin/rouleau", "plan", SCENE)]
        if modules:
            self.environment = {"PYTHONPATH": str(prefix / "lib/python3/dist-packages")}
            ways.append((1, "/usr/bin/python3", "-c", f"import rouleau; print(rouleau.Simulation('{SCENE}').step(2))"))
            self.assertEqual(self.call(*ways[1][1:]), "2\n")
        (prefix / "share/rouleau/udunits/udunits2.xml").write_text("nothing")
        for expected, *words in ways:
            self.assertIn("UDUNITS-2 cannot be read", self.call(*words, expect=expected))


if __name__ == "__main__":
    main()
