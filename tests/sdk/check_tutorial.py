"""The tutorial of sdk/README.md, its commands run as they stand, in an empty folder, against an installation.

usage: check_tutorial.py SOURCE BUILD CMAKE
"""

import json
import re
import time

from staged import BUILD, SOURCE, Case, main

TUTORIAL = (SOURCE / "sdk/README.md").read_text().split("\n## ")[1]
BLOCKS = re.findall(r"^```sh\n(.*?)^```$", TUTORIAL, re.MULTILINE | re.DOTALL)


class The_tutorial(Case):
    def test_works_as_it_stands(self):
        home = self.path / "home"
        home.mkdir()
        self.environment.update(HOME=str(home), PATH="/usr/local/bin:/usr/bin:/bin")
        program = home / "rouleau/bin/rouleau"
        # The first block is to be run in the folder of the source, where the build lies in build/release.
        checkout = self.path / "checkout"
        (checkout / "build").mkdir(parents=True)
        (checkout / "build/release").symlink_to(BUILD)
        start = time.monotonic()
        self.call("bash", "-euc", BLOCKS[0], cwd=checkout)
        installed = time.monotonic()
        desk = self.path / "desk"
        desk.mkdir()
        blocks = BLOCKS[1:]
        if not self.has_conform(program):
            # Until the program has the command, ctest is expected to fail with its words; everything else is as written.
            expected = ('"$OUT" 2>&1 && exit 99; grep -q "rouleau conform: not in this version" "$OUT"')
            self.environment["OUT"] = str(self.path / "ctest.txt")
            blocks = [re.sub(r"^(ctest .*)$", rf"\1 >{expected}", b, flags=re.MULTILINE) for b in blocks]
            self.assertEqual(sum(b.count("exit 99") for b in blocks), 2)
        words = self.call("bash", "-euc", "\n".join(blocks), cwd=desk)
        print(f"tutorial: {installed - start:.1f} s to install, {time.monotonic() - installed:.1f} s for everything after")
        self.assertIn("org.example.yukawa 1.0.0: Screened repulsion", words)
        libraries = set()
        for run, parameter in (("template", "zero_force_distance"), ("yukawa", "strength")):
            self.assertTrue((desk / "runs" / run / "report.html").exists())
            summary = json.loads((desk / "runs" / run / "summary.json").read_text())
            self.assertEqual(summary["status"], "completed")
            self.assertIn(parameter, json.loads((desk / "runs" / run / "scene.json").read_text())["interactions"][0]["parameters"])
            libraries |= {p["sha256"] for p in summary["plugins"] if p["id"] == "org.example.yukawa"}
        self.assertEqual(len(libraries), 2)  # that of the template, and one's own
        self.assertEqual({p.name for p in desk.iterdir()}, {"yukawa", "runs"})
        self.assertEqual({p.name for p in (desk / "yukawa").iterdir()},
                         {"yukawa.cpp", "yukawa.json", "CMakeLists.txt", "build"})

    def test_has_a_potential_of_less_than_thirty_lines(self):
        source = re.search(r"yukawa\.cpp <<'END'\n(.*?)^END$", TUTORIAL, re.MULTILINE | re.DOTALL).group(1)
        self.assertLess(len(source.splitlines()), 30)


if __name__ == "__main__":
    main()
