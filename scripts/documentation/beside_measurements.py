"""What scripts/experiments and scripts/blood share: runs of shipped scenes, and numbers beside what was measured."""
import dataclasses
import datetime
import json
import math
import os
import pathlib
import platform
import subprocess
import sys

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent
sys.path.insert(0, str(ROOT / "python"))
sys.dont_write_bytecode = True

import rouleau  # noqa: E402
from rouleau.scenes import changes_of  # noqa: E402


def measured(name):
    return json.loads((ROOT / "tests" / "reference" / "experiments" / f"{name}.json").read_text())


@dataclasses.dataclass
class Point:
    """A number that was measured, within limits, beside what the simulation gives."""

    quantity: str
    at: str  #: under which conditions
    low: float  #: of what was measured
    high: float
    value: float  #: simulated
    error: float = math.nan  #: of the simulated value
    x: float = math.nan  #: place in the figure

    @property
    def inside(self):
        return self.low <= self.value <= self.high


def add_options(parser, out):
    """The options of both scripts; `out` is a folder below runs/."""
    parser.add_argument("--set", nargs="*", default=[], metavar="POINTER=VALUE", help="for every run")
    parser.add_argument("--program", default=ROOT / "build" / "release" / "bin" / "rouleau")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "runs" / out)


def take(options):
    """Makes the options those of every run."""
    os.environ["ROULEAU"] = str(options.program)
    options.changes = changes_of(options.set)


def made(scene, label, changes, out, options):
    """A scene's run with changes, if it has completed; makes it where it is not there."""
    row = rouleau.sweep(scene, {}, out=out, measure=lambda run: {}, workers=1, progress=False, page=False,
                        **{**changes, **options.changes}).iloc[0]
    print(f"  {label}: {row['status']}, {row['wall_s']:.0f} s, {row['directory']}", flush=True)
    return rouleau.open(row["directory"]) if row["status"] == "completed" else None


def table(results):
    """Rows of a page: points by the name of what they belong to."""
    lines = ["| experiment | quantity | at | measured | simulated | |", "|---|---|---|---|---|---|"]
    for name, found in results.items():
        for p in found:
            error = "" if math.isnan(p.error) else f" +- {p.error:.2g}"
            lines.append(f"| {name} | {p.quantity} | {p.at} | {p.low:.3g} to {p.high:.3g} | {p.value:.3g}{error} | "
                         f"{'inside' if p.inside else '**outside**'} |")
    return "\n".join(lines)


def draw_point(axes, p, marker="o"):
    """The range that was measured as a grey bar, what the simulation gives as a dot with its error."""
    axes.plot([p.x, p.x], [p.low, p.high], color="0.6", linewidth=6, solid_capstyle="butt")
    axes.errorbar([p.x], [p.value], None if math.isnan(p.error) else [p.error], fmt=marker,
                  color="tab:green" if p.inside else "tab:red")


def pyplot_of(script):
    """matplotlib's pyplot, which makes the same bytes of a figure again."""
    from matplotlib import pyplot, rcParams
    rcParams["svg.hashsalt"] = script
    return pyplot


def made_with(script, program):
    """The line of a page of results that says when and with what it was made."""
    version = subprocess.run([program, "--version"], capture_output=True, text=True, check=True).stdout.split("\n")[0]
    return f"{datetime.date.today()}, `scripts/{script}`, {version}, {platform.machine()}."


def write_page(name, parts, kept):
    """Writes a page of docs/results; what stands there from the heading `kept` on is written by hand, and stays."""
    page = ROOT / "docs" / "results" / f"{name}.md"
    _, kept, rest = page.read_text().partition(kept) if page.exists() else ("", "", "")
    page.write_text("\n".join([*parts, kept + rest]))


def main_of(script, main):
    try:
        main()
    except rouleau.Error as error:
        sys.exit(f"scripts/{script}: {error}")
