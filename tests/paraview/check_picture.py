"""examples/paraview/cells.py makes a picture of a run in three dimensions, under pvbatch, with surfaces, walls and a plane.

usage: check_picture.py ROULEAU SOURCE PVBATCH XVFB
"""

import contextlib
import json
import os
import pathlib
import struct
import subprocess
import sys
import tempfile
import zlib

ROULEAU, SOURCE, *PROGRAMS = sys.argv[1:]
SCENE = {
    "rouleau": 1,
    "domain": {"size": ["12 um", "12 um", "12 um"], "nodes": [24, 24, 24],
               "walls": {"within": {"cylinder": {"axis": "x", "center": ["6 um", "6 um"], "radius": "5.5 um"}}}},
    "fluid": {"density": "1 g/cm3", "viscosity": "1.2 cP"},
    "numerics": {"density_factor": 1000},
    "cell_types": {"ball": {"shape": {"sphere": {"radius": "2 um"}},
                            "membrane": [{"model": "neo-hookean", "parameters": {"shear_modulus": "6e-6 N/m"}}]}},
    "cells": [{"type": "ball", "at": ["6 um", "6 um", "6 um"]}],
    "stages": [{"name": "flow", "pressure_gradient": "5 kPa/m", "duration": "1 ms"}],
    "output": {"cells": {"seconds": "1 ms"}, "fields": {"seconds": "1 ms", "quantities": ["velocity"]}},
}


def pixels(path):
    """Rows of an 8-bit RGB picture, each after its filter: as many different ones as the picture has."""
    data, at, parts = path.read_bytes(), 8, []
    while at < len(data):
        length, kind = struct.unpack(">I4s", data[at:at + 8])
        parts += [data[at + 8:at + 8 + length]] if kind == b"IDAT" else []
        at += length + 12
    width, height = struct.unpack(">II", data[16:24])
    raw = zlib.decompress(b"".join(parts))
    return width, height, len({raw[k * len(raw) // height:(k + 1) * len(raw) // height] for k in range(height)})


@contextlib.contextmanager
def display():
    """A display of its own, by a number that the server finds free. It starts afresh for nobody: where the last window of a program
    closes it otherwise does, and refuses whoever comes meanwhile."""
    reading, writing = os.pipe()
    server = subprocess.Popen([PROGRAMS[1], "-displayfd", str(writing), "-screen", "0", "1280x1024x24", "-noreset", "-ac", "-nolisten", "tcp"],
                              pass_fds=[writing], stderr=subprocess.DEVNULL)
    try:
        os.close(writing)
        with os.fdopen(reading) as number:
            yield ":" + number.readline().strip()
    finally:
        server.terminate()
        server.wait()


with tempfile.TemporaryDirectory(prefix="rouleau-picture-") as name, display() as where:
    folder = pathlib.Path(name)
    (folder / "scene.json").write_text(json.dumps(SCENE))
    subprocess.run([ROULEAU, "run", "scene.json", "--out", "run", "--quiet"], cwd=folder, check=True, capture_output=True)
    words = [PROGRAMS[0], f"{pathlib.Path(SOURCE).resolve()}/examples/paraview/cells.py", "run", "picture.png", "--state", "cells.pvsm"]
    result = subprocess.run(words, cwd=folder, capture_output=True, text=True, timeout=300, env={**os.environ, "DISPLAY": where})
    assert result.returncode == 0, result.stdout + result.stderr
    assert "picture.png: fields, membranes, walls at 0.001" in result.stdout, result.stdout
    width, height, rows = pixels(folder / "picture.png")
    assert (width, height) == (1400, 1000) and rows > height / 3, (width, height, rows)
    assert "ServerManagerState" in (folder / "cells.pvsm").read_text()
print("1 passed, 0 failed")
