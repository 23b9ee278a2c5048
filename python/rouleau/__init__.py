"""Rouleau: deformable red blood cells that attract each other while they flow."""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from .errors import Error as Error, Fault as Fault
    from .simulation import FluidField as FluidField, Simulation as Simulation

_HOME = {"Error": "errors", "Fault": "errors", "FluidField": "simulation", "Simulation": "simulation"}

__all__ = sorted(_HOME)


def __getattr__(name: str) -> object:
    if name not in _HOME:
        raise AttributeError(f"module 'rouleau' has no attribute {name!r}")
    value: object = getattr(importlib.import_module("." + _HOME[name], __name__), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return __all__
