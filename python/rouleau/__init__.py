"""Rouleau: deformable red blood cells that attract each other while they flow.

    import rouleau
    run = rouleau.run("scenes/four-cells-shear.json", out="runs/demo")
    run.plot("deformation")

Lengths are in metres, times in seconds, angles in radians, all in SI, unless a name says otherwise. What is heavy
(pandas, h5py, matplotlib) is imported when it is first used.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .breaking import BreakUp as BreakUp, break_up as break_up
    from .calibrating import Calibration as Calibration, calibrate as calibrate
    from .comparing import Comparison as Comparison, compare as compare
    from .errors import Error as Error, Fault as Fault
    from .means import SeedMean as SeedMean, Statistics as Statistics, mean_of_seeds as mean_of_seeds, statistics as statistics
    from .potentials import Potential as Potential, potential as potential
    from .reading import Cell as Cell, Field as Field, Frame as Frame, Mean as Mean, Run as Run, Stage as Stage
    from .reading import mean_and_error as mean_and_error, open as open
    from .running import Plan as Plan, Progress as Progress, plan as plan, plugins as plugins, run as run
    from .simulation import FluidField as FluidField, Simulation as Simulation
    from .shapes import mask as mask, outline as outline, polygons as polygons, vessel as vessel
    from .sweeping import sweep as sweep

__version__ = "0.3.0"

_HOME = {
    "break_up": "breaking", "BreakUp": "breaking",
    "calibrate": "calibrating", "Calibration": "calibrating",
    "Cell": "reading", "compare": "comparing", "Comparison": "comparing", "Error": "errors", "Fault": "errors",
    "Field": "reading", "FluidField": "simulation", "Frame": "reading", "mask": "shapes", "Mean": "reading", "mean_and_error": "reading",
    "mean_of_seeds": "means", "SeedMean": "means", "Statistics": "means", "statistics": "means",
    "open": "reading", "outline": "shapes", "Plan": "running", "plan": "running", "plugins": "running", "polygons": "shapes",
    "Potential": "potentials", "potential": "potentials", "Progress": "running", "Run": "reading", "run": "running",
    "Simulation": "simulation", "Stage": "reading", "sweep": "sweeping", "vessel": "shapes",
}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'rouleau' has no attribute {name!r}")
    value: object = getattr(importlib.import_module("." + _HOME[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
