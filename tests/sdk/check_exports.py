"""Every plugin that was built exports rouleau_open_v1 and nothing else. Python's standard library only.

usage: check_exports.py NM PLUGIN_FOLDER
"""

import subprocess
import sys
from pathlib import Path

nm, folder = sys.argv[1], Path(sys.argv[2])
failed = 0
libraries = sorted(folder.rglob("*.so"))
for library in libraries:
    listing = subprocess.run([nm, "-D", "--defined-only", library], capture_output=True, text=True, check=True).stdout
    names = [line.split()[-1] for line in listing.splitlines()]
    if names != ["rouleau_open_v1"]:
        failed += 1
        print(f"{library} exports {', '.join(names) or 'nothing'}")
print(f"{len(libraries) - failed} passed, {failed} failed")
sys.exit(0 if libraries and not failed else 1)
