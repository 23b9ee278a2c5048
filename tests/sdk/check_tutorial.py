"""The tutorial of sdk/README.md, its commands run as they stand, in an empty folder, against an installation.

usage: check_tutorial.py SOURCE BUILD CMAKE
"""

import re
import time

from staged import BUILD, SOURCE, Case, main, rouleau

TUTORIAL = (SOURCE / "sdk/README.md").read_text().split("\n## ")[1]
BLOCKS = re.findall(r"^```sh\n(.*?)^```$", TUTORIAL, re.MULTILINE | re.DOTALL)


class The_tutorial(Case):
    def test_works_as_it_stands(self):
        home = self.path / "home"
        home.mkdir()
        self.environment.update(HOME=str(home), PATH="/usr/local/bin:/usr/bin:/bin")
        # The first block is to be run in the folder of the source, where the build lies in build/release.
        checkout = self.path / "checkout"
        (checkout / "build").mkdir(parents=True)
        (checkout / "build/release").symlink_to(BUILD)
        start = time.monotonic()
        self.call("bash", "-euc", BLOCKS[0], cwd=checkout)
        installed = time.monotonic()
        desk = self.path / "desk"
        desk.mkdir()
        words = self.call("bash", "-euc", "\n".join(BLOCKS[1:]), cwd=desk)
        print(f"tutorial: {installed - start:.1f} s to install, {time.monotonic() - installed:.1f} s for everything after")
        self.assertIn("org.example.yukawa 1.0.0: Screened repulsion", words)
        libraries = set()
        for run, parameter in (("template", "zero_force_distance"), ("yukawa", "strength")):
            self.assertTrue((desk / "runs" / run / "report.html").exists())
            made = rouleau.open(desk / "runs" / run)
            self.assertEqual(made.status, "completed")
            self.assertIn(parameter, made.scene.interactions[0].parameters)
            libraries |= {p.sha256 for p in made.summary.plugins if p.id == "org.example.yukawa"}
        self.assertEqual(len(libraries), 2)  # that of the template, and one's own
        self.assertEqual({p.name for p in desk.iterdir()}, {"yukawa", "runs"})
        self.assertEqual({p.name for p in (desk / "yukawa").iterdir()},
                         {"yukawa.cpp", "yukawa.json", "CMakeLists.txt", "build"})

    def test_has_a_potential_of_less_than_thirty_lines(self):
        source = re.search(r"yukawa\.cpp <<'END'\n(.*?)^END$", TUTORIAL, re.MULTILINE | re.DOTALL).group(1)
        self.assertLess(len(source.splitlines()), 30)


if __name__ == "__main__":
    main()
