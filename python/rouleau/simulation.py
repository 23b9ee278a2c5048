"""A scene that is stepped from Python: the same bits as `rouleau run`, arrays without copies, forces of your own."""

from __future__ import annotations

import os
import pathlib
import warnings
import weakref
from typing import TYPE_CHECKING, Any, Callable, NamedTuple, NoReturn, Sequence, SupportsIndex, Union

import numpy as np
import numpy.typing as npt

from .errors import Error, Fault, fault_of
from .scenes import SceneLike, scene_file, settings, whole

if TYPE_CHECKING:
    import pandas

try:
    from . import _core
except ImportError as trouble:
    raise Error(Fault(f"rouleau.Simulation needs the compiled module: {trouble}",
                      "install python3-rouleau, or build Rouleau with python3-dev and pybind11-dev"), exit_code=4) from trouble

__all__ = ["FluidField", "Simulation"]

Doubles = npt.NDArray[np.float64]


def _error(faults: Sequence[tuple[str, str, str, str, int, int]], exit_code: int) -> Error:
    """What the compiled module raises."""
    return Error([fault_of(*fault) for fault in faults], exit_code=exit_code)


class FluidField(NamedTuple):
    """A quantity of the fluid in the nodes of the lattice."""

    values: Doubles  #: rows from below, nodes of a row from the left: (rows, nodes) or, of a vector, (rows, nodes, 2);
    #: in three dimensions (layers, rows, nodes) or (layers, rows, nodes, 3)
    x: Doubles  #: places of the nodes of a row, m, shape (nodes,)
    y: Doubles  #: places of the rows, m, shape (rows,)
    unit: str  #: of the values; "1" for a number
    z: Doubles | None = None  #: places of the layers, m, shape (layers,); None in two dimensions


class Simulation:
    """A scene between two of its steps.

    `scene` is a path or a dictionary; `changes` replace values of it, as `**{"fluid.viscosity": "6 cP"}` or with JSON
    pointers. `plugins` are folders with plugins, searched first. `threads` share the work of a step; results do not
    depend on their number. What is wrong raises rouleau.Error with its place and a remedy.

        sim = rouleau.Simulation("scenes/four-cells-shear.json")
        while not sim.done:
            sim.step(1000)
            print(sim.strain, sim.cells()["deformation"].mean())

    Nothing is written but by save(). Arrays that are called views show the simulation's own memory: they change with
    every step, cannot be written to, and keep the simulation alive. In three dimensions they are copies instead, of three
    components for two. They are in lattice units; `spacing`, `time_step` and `force_unit` have what these are in SI.
    """

    def __init__(self, scene: SceneLike, *, threads: int = 1, plugins: Sequence[Union[str, os.PathLike[str]]] = (),
                 **changes: Any) -> None:
        self._threads = whole("threads", threads, 1, 1024)
        with scene_file(scene) as file:
            self._core = _core.Session(os.fspath(file), settings(changes, scene), [os.fspath(folder) for folder in plugins])
        self._spacing: float = self._core.stage()["length"]
        for sentence in self._core.code_of_the_scene():
            warnings.warn(sentence, stacklevel=2)

    def __reduce_ex__(self, protocol: SupportsIndex) -> NoReturn:
        """copy, deepcopy and pickle: a second name of one state would be none of its own."""
        raise Error(Fault("a Simulation can be neither copied nor pickled: its state is no part of Python",
                          "make another one of the same scene, or save() this one and load() it as often as you like"))

    @classmethod
    def load(cls, directory: Union[str, os.PathLike[str]], *, threads: int = 1,
             plugins: Sequence[Union[str, os.PathLike[str]]] = ()) -> Simulation:
        """Goes on from the checkpoint of a directory: one of save(), or of `rouleau run`."""
        simulation = cls(pathlib.Path(directory) / "scene.json", threads=threads, plugins=plugins)
        simulation._core.restore(os.fspath(directory))
        return simulation

    def save(self, directory: Union[str, os.PathLike[str]]) -> None:
        """Writes a checkpoint into a run directory, which is made, or replaced if it holds a run. Both load() and
        `rouleau run SCENE --out DIRECTORY --resume` go on from it."""
        self._core.save(os.fspath(directory))

    def step(self, count: int = 1) -> int:
        """Takes time steps, through the stages of the scene; returns how many: fewer when the scene ends. Other threads
        of Python run meanwhile. Ctrl-C raises KeyboardInterrupt between two steps; the simulation can go on. Raises
        rouleau.Error with exit_code 1 when a check of the scene fails."""
        return self._core.step(whole("count", count, 0), self._threads)

    @property
    def done(self) -> bool:
        """Whether the last stage has ended."""
        return self._core.done

    @property
    def step_count(self) -> int:
        """Steps taken, over all stages."""
        return self._core.steps

    @property
    def time(self) -> float:
        """Simulated time since the first stage began, s."""
        return self._core.time

    @property
    def strain(self) -> float:
        """Strain over all stages: magnitude of the shear rate times time."""
        return self._core.strain

    @property
    def stage(self) -> str:
        """Name of the present stage."""
        return str(self._core.stage()["name"])

    @property
    def spacing(self) -> float:
        """Of the lattice, m: the unit of positions. Node (0, 0) of the lattice is at position (0, 0), which is half a
        spacing inside the domain's lower left corner."""
        return self._spacing

    @property
    def time_step(self) -> float:
        """Of the present stage, s. The unit of velocities is spacing / time_step."""
        return float(self._core.stage()["time"])

    @property
    def force_unit(self) -> float:
        """Unit of forces in the present stage, N/m: newtons on a node for each metre of depth; in three dimensions N."""
        return float(self._core.stage()["force"])

    @property
    def positions(self) -> Doubles:
        """View of the membrane nodes' positions, shape (nodes, 2) or (nodes, 3), spacings; not wrapped into the
        periodic box."""
        return self._core.positions()

    @property
    def velocities(self) -> Doubles:
        """View of the membrane nodes' displacements in the last step, shape (nodes, 2) or (nodes, 3), spacings."""
        return self._core.velocities()

    @property
    def forces(self) -> Doubles:
        """View of the forces on the membrane nodes at the present positions, shape (nodes, 2) or (nodes, 3), in
        force_unit. Asking for it computes them, once; the next step does not compute them again."""
        return self._core.forces()

    @property
    def cell_nodes(self) -> list[slice]:
        """Which nodes each cell has, by its number: `sim.positions[sim.cell_nodes[0]]` is the first cell's outline,
        or its surface. A cell that has not come in yet, or has left, has none; what stands at other nodes means nothing."""
        return [slice(begin, end) for begin, end in self._core.cell_nodes()]

    def velocity(self) -> FluidField:
        """Velocity of the fluid, m/s: a copy. Needs the forces of the next step."""
        return self._field("velocity", "m/s")

    def density(self) -> FluidField:
        """Density of the fluid over its mean less one: a copy. Needs the forces of the next step."""
        return self._field("density", "1")

    def _field(self, name: str, unit: str) -> FluidField:
        fields = self._core.fluid()
        places = [(np.arange(count) + 0.5) * self._spacing for count in reversed(fields["density"].shape)]
        return FluidField(fields[name], places[0], places[1], unit, *places[2:])

    def cells(self) -> pandas.DataFrame:
        """One row for each cell that is there, with the columns of cells.csv: deformation, area_m2, min_gap_m, ..."""
        import pandas

        return pandas.DataFrame(self._core.cells())

    def add_force(self, force: Callable[[Simulation], npt.ArrayLike] | None) -> None:
        """Adds a force of your own to the membrane nodes, every step. `force(simulation)` returns newtons for each metre
        of depth, shape (nodes, 2), or newtons, shape (nodes, 3), or what can be broadcast to it. None takes it away.

        It is asked when the forces of the models are known, and reads positions and velocities. Python is entered once
        a step: that costs some 14 us for 48 nodes, beside 17 us for a step of the smallest scene and 0.3 ms for one of
        four cells. An exception that it raises comes out of step(), and leaves a simulation that cannot go on. Raises
        rouleau.Error for scenes with slip_correction. Checkpoints do not hold it."""
        if force is None:
            self._core.set_force(None)
            return
        myself, asked = weakref.ref(self), force

        def add(forces: Doubles) -> None:
            simulation = myself()
            if simulation is not None:
                forces += np.asarray(asked(simulation), dtype=float) / simulation.force_unit

        self._core.set_force(add)
