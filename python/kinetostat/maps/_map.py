"""A map as a Dataset of xarray."""

from __future__ import annotations

import os
from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core, sweep
from kinetostat._plausibility import issue, of_many, sentences
from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine, Progress
from kinetostat.maps._question import Question, asked
from kinetostat.maps._rows import rows
from kinetostat.maps._variables import AXES, Variable
from kinetostat.status import Status
from kinetostat.sweep._folder import chunk_of

if TYPE_CHECKING:
    import xarray

__all__ = ["evaluate"]

_AXES = {"x": "x of the tool's reference point", "y": "y of the tool's reference point", "z": "z of the tool's reference point"}

_CHUNK = 16384

_MOST_NUMBERS = 2_000_000_000
"""Of a map, 16 GB."""


def evaluate(
    machine: Machine,
    *,
    x: ArrayLike | None = None,
    y: ArrayLike | None = None,
    z: ArrayLike | None = None,
    orientations: ArrayLike | Mapping[str, ArrayLike] | None = None,
    over_orientations: Literal["worst"] | None = None,
    loads: ArrayLike | Mapping[str, ArrayLike] | None = None,
    variables: str | Sequence[str] | None = None,
    folder: str | os.PathLike[str] | None = None,
    executor: Executor | Callable[[], Executor] | None = None,
    chunk: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> xarray.Dataset:
    """What a machine is like at every place of a grid; :meth:`Machine.map` is the same.

    Parameters
    ----------
    machine : Machine
        Its tool's reference point is put at every place.
    x, y, z : array_like, shape () or (n,)
        Positions, m, base axes, growing or falling; as at home where none is given. Those of shape (n,) become dimensions.
    orientations : array_like, shape (3, 3) or (k, 3, 3), or mapping of str to (3, 3), optional
        Rotation matrices, base from tool; several become the dimension ``orientation``. As at home without any; a machine that turns
        its tool as it moves takes the nearest one at every place.
    over_orientations : {"worst"}, optional
        Instead of the dimension: the worst value of all orientations, column by column. A place that is out of reach in one of them
        has none.
    loads : array_like, shape (6,) or (m, 6), or mapping of str to (6,), optional
        Wrenches on the tool (N, N m), base axes, about its reference point; several become the dimension ``load``. With a load the
        machine is as it is, with its own loads and deviations; without one it is unloaded, as drawn.
    variables : str or sequence of str, optional
        Names of :func:`variables`. Stiffness without it, and with loads deflection and stability, too.
    folder : path, optional
        Keeps the map there as a Parquet dataset with a manifest (:mod:`kinetostat.sweep`), and goes on where an earlier call stopped.
    executor : concurrent.futures.Executor or callable, optional
        Where chunks are computed; see :func:`kinetostat.sweep.run`. In this process without one.
    chunk : int, optional
        Places of a chunk; that of the folder without it, or 16384.
    threads : int, optional
        Threads of this process, all cores without it; workers of an executor use one each. The answer is the same, bit for bit.
    progress : callable, optional
        Called with what is done, how much there is and the name of the stage; :func:`kinetostat.bar` makes one of tqdm.

    Returns
    -------
    xarray.Dataset
        Variables with their units, and ``status`` (:class:`kinetostat.Status`): numbers are NaN where it is 2; where it is 1 an actuator
        would be outside its limits, of an arm in all configurations that are tried. The coordinate ``orientation_matrix`` holds the
        rotation matrices, ``wrench`` the loads; ``rotation`` is a variable: how far the tool turns under the load.

    Raises
    ------
    ArgumentError
        A question that makes no sense, or a folder that holds another map.
    ImportError
        xarray is not installed (``pip install 'kinetostat[io]'``).

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> machine = ks.Machine.preset("orthoglide")
    >>> found = machine.map(x=np.linspace(-0.05, 0.05, 3), y=[0.0, 0.05], z=0.0)
    >>> dict(found.sizes)
    {'x': 3, 'y': 2}
    >>> found.stiffness_softest.attrs["units"]
    'N/m'
    """
    _xarray()
    question = asked(machine, x, y, z, orientations, over_orientations, loads, variables)
    # What makes no sense of one place is said here, not by a worker.
    rows(0, 1, threads=1, **question.settings(places=False))
    _fits(question)
    size = chunk if chunk is not None or folder is None else chunk_of(folder)
    chunk = _CHUNK if size is None else size
    if folder is None:
        how: dict[str, Any] = {"chunk": chunk, "executor": executor, "threads": threads, "progress": progress}
        found = sweep.run(rows, question.count, question.settings(places=False), **how)
    else:
        units = {"x": "m", "y": "m", "z": "m", **{variable.name: variable.unit for variable in question.variables}}
        how = {"chunk": chunk, "executor": executor, "threads": threads, "progress": progress, "units": units}
        sweep.to_folder(folder, rows, question.count, question.settings(places=True), **how)
        found = sweep.read(folder, ["status", *(variable.name for variable in question.variables)])
    made = _dataset(question, found)
    said = of_many(machine._native, question.wrenches, found["deflection"][:, None] if "deflection" in found else None, found["status"])
    issue(said)
    return made.assign_attrs(warnings="; ".join(sentences(said))) if said else made


def _fits(question: Question) -> None:
    """Refuses a map that no memory takes, before anything is computed."""
    drives = len(question.machine.actuators)
    numbers = question.count * sum(drives if variable.columns is None else variable.columns for variable in question.variables)
    if numbers > _MOST_NUMBERS:
        said = f"{question.count:.3g} places would have {numbers:.3g} numbers ({8e-9 * numbers:.3g} GB)"
        raise ArgumentError(f"{said}, expected at most {_MOST_NUMBERS:.0e}: give fewer places or variables, or map it in parts")


def _xarray() -> Any:
    try:
        import xarray
    except ImportError as absent:
        raise ImportError("maps are Datasets of xarray: pip install 'kinetostat[io]'") from absent
    return xarray


def _dataset(question: Question, found: dict[str, Any]) -> xarray.Dataset:
    named = {"load": question.load_names, "orientation": question.turn_names}
    along = [name for name, names in named.items() if names is not None]
    along += [name for name, values in question.axes.items() if values.ndim]
    kept = [n for name, n in zip((*named, *question.axes), question.shape, strict=True) if name in along]
    data: dict[str, Any] = {}
    for variable in question.variables:
        columns = tuple(len(AXES[dim]) if dim in AXES else -1 for dim in variable.dims)
        data[variable.name] = ((*along, *variable.dims), found[variable.name].reshape(*kept, *columns), _about(question, variable))
    # Signed: NetCDF 3 has no other bytes.
    status = found["status"].view(np.int8).reshape(kept)
    flags = {"flag_values": np.array([s.value for s in Status], np.int8), "flag_meanings": " ".join(s.name.lower() for s in Status)}
    data["status"] = (tuple(along), status, {"long_name": "what became of the place", **flags})
    made: xarray.Dataset = _xarray().Dataset(data, _coordinates(question), _attributes(question))
    return made


def _about(question: Question, variable: Variable) -> dict[str, Any]:
    about: dict[str, Any] = {"units": variable.unit, "long_name": variable.description}
    if variable.columns is None:
        units = {_of_actuator(actuator.unit, variable) for actuator in question.machine.actuators}
        about["units"] = units.pop() if len(units) == 1 else variable.unit
    if question.worst:
        about["over_orientations"] = f"worst: {variable.worse}"
    return about


def _of_actuator(unit: str, variable: Variable) -> str:
    """The unit of a column of an actuator: ``N or N m`` is N where it slides, N m where it turns."""
    slides, _, turns = variable.unit.partition(" or ")
    return turns if turns and unit == "rad" else slides


def _coordinates(question: Question) -> dict[str, Any]:
    made: dict[str, Any] = {}
    for name, values in question.axes.items():
        made[name] = ((name,) if values.ndim else (), values, {"units": "m", "long_name": _AXES[name], "axis": name.upper()})
    frame = {"units": "1", "long_name": "rotation matrix, base from tool"}
    if question.rotations is not None:
        names = question.turn_names
        if names is not None:
            made["orientation"] = ("orientation", names)
            made["orientation_matrix"] = (("orientation", "row", "column"), question.rotations, frame)
        elif question.worst:
            made["orientation_matrix"] = (("worst_of", "row", "column"), question.rotations, frame)
        else:
            made["orientation_matrix"] = (("row", "column"), question.rotations[0], frame)
    if question.wrenches is not None:
        about = {"units": "N, N m", "long_name": "force and moment on the tool, base axes, about its reference point"}
        made["component"] = ("component", ["fx", "fy", "fz", "mx", "my", "mz"])
        if question.load_names is not None:
            made["load"] = ("load", question.load_names)
            made["wrench"] = (("load", "component"), question.wrenches, about)
        else:
            made["wrench"] = ("component", question.wrenches[0], about)
    columns = {dim for variable in question.variables for dim in variable.dims}
    if "actuator" in columns:
        made["actuator"] = ("actuator", [actuator.name for actuator in question.machine.actuators])
    return made | {dim: (dim, list(AXES[dim])) for dim in AXES if dim in columns}


def _attributes(question: Question) -> dict[str, Any]:
    machine = question.machine
    state = "unloaded, as drawn" if question.wrenches is None else "as it is, with its own loads and deviations, under the wrench"
    return {
        "title": f"Map of {machine.name}",
        "machine": machine.name,
        "machine_file": machine.file,
        "machine_sha256": machine.fingerprint,
        "machine_state": state,
        "frame": "base axes; poses are base from tool, about the tool's reference point",
        "tool": machine.tool.reshape(-1),
        "source": f"kinetostat {_core.VERSION}",
        "Conventions": "CF-1.8",
    }
