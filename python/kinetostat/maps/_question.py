"""What is asked of a map, checked."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arguments import of_kind, refused
from kinetostat._arrays import Floats, fitting, numbers
from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine
from kinetostat.maps._variables import Variable, chosen

NATURAL = ("stiffness_softest", "stiffness_x", "stiffness_y", "stiffness_z")
"""Variables where none are named."""

LOADED = (*NATURAL, "deflection", "deflection_xyz", "stable")
"""The same under a load."""


@dataclasses.dataclass(frozen=True)
class Question:
    """A grid, orientations, loads and variables."""

    machine: Machine
    axes: dict[str, Floats]
    """Positions along x, y and z, m; of no axis but shape () where one is given."""
    rotations: Floats | None
    """(k, 3, 3), or none."""
    turn_names: list[str] | None
    """Names of the dimension of orientations; none where there is no such dimension."""
    wrenches: Floats | None
    """(m, 6), or none."""
    load_names: list[str] | None
    variables: list[Variable]
    worst: bool

    def settings(self, places: bool) -> dict[str, Any]:
        """Settings of the sweep."""
        return {
            "machine": self.machine,
            **{name: np.atleast_1d(values) for name, values in self.axes.items()},
            "rotations": self.rotations,
            "wrenches": self.wrenches,
            "names": [variable.name for variable in self.variables],
            "worst": self.worst,
            "places": places,
        }

    @property
    def shape(self) -> tuple[int, ...]:
        """Loads, orientations, and places along x, y and z."""
        turns = 1 if self.worst or self.rotations is None else len(self.rotations)
        loads = 1 if self.wrenches is None else len(self.wrenches)
        return (loads, turns, *(values.size for values in self.axes.values()))

    @property
    def count(self) -> int:
        """Rows."""
        return int(np.prod(self.shape))


def asked(
    machine: Machine,
    x: ArrayLike | None,
    y: ArrayLike | None,
    z: ArrayLike | None,
    orientations: ArrayLike | Mapping[str, ArrayLike] | None,
    over_orientations: str | None,
    loads: ArrayLike | Mapping[str, ArrayLike] | None,
    names: str | Sequence[str] | None,
) -> Question:
    """A question, or an error that says what is wrong with it."""
    of_kind("machine", machine, Machine, "a Machine")
    home = machine.home[:3, 3]
    axes = {name: _axis(name, home[k] if given is None else given) for k, (name, given) in enumerate(zip("xyz", (x, y, z), strict=True))}
    if all(values.ndim == 0 for values in axes.values()):
        raise ArgumentError("a map runs along x, y or z: give an array of at least one of them, m")
    turns, turn_names = _several("orientations", orientations, (3, 3))
    if turns is not None:
        _rotations(turns)
    if over_orientations is not None and (not isinstance(over_orientations, str) or over_orientations != "worst"):
        raise refused("over_orientations", over_orientations, "'worst' or None")
    if over_orientations is not None and turn_names is None:
        raise ArgumentError("over_orientations needs several orientations")
    wrenches, load_names = _several("loads", loads, (6,))
    variables = chosen(names if names is not None else NATURAL if wrenches is None else LOADED)
    for variable in variables:
        if over_orientations is not None and variable.worse == "neither":
            raise ArgumentError(f"{variable.name} has no worst value over orientations")
        if variable.name == "singularity_distance" and not machine.actuators:
            raise ArgumentError(f"variables has 'singularity_distance', a question about drives: {machine.name!r} has none")
    worst = over_orientations is not None
    return Question(machine, axes, turns, None if worst else turn_names, wrenches, load_names, variables, worst)


def _axis(name: str, value: ArrayLike) -> Floats:
    given = numbers(name, value)
    if not np.all(np.isfinite(given)):
        raise ArgumentError(f"{name} holds {float(given[~np.isfinite(given)][0])}: give finite numbers, m")
    if given.ndim > 1 or given.size == 0:
        raise ArgumentError(f"{name} has shape {given.shape}, expected one number or some (n,), m")
    if given.ndim == 1 and given.size > 1 and not (np.all(np.diff(given) > 0) or np.all(np.diff(given) < 0)):
        raise ArgumentError(f"{name} must grow or fall from place to place")
    return given


def _several(name: str, value: Any, shape: tuple[int, ...]) -> tuple[Floats | None, list[str] | None]:
    """One or more arrays of a shape, and their names where it is more than one."""
    if value is None:
        return None, None
    if isinstance(value, Mapping):
        for key in value:
            if not isinstance(key, str):
                raise refused(f"a key of {name}", key, "a name")
        names = list(value)
        if not names:
            raise ArgumentError(f"{name} is empty")
        found = np.stack([fitting(f"{name}[{key!r}]", inner, shape) for key, inner in value.items()])
    else:
        found = fitting(name, value, shape)
        names = [str(k) for k in range(len(found))] if found.ndim > len(shape) else []
    if found.ndim > len(shape) + 1 or len(found) == 0 or not np.all(np.isfinite(found)):
        raise ArgumentError(f"{name} has shape {found.shape}, expected finite numbers {shape} or {('n', *shape)}")
    return found.reshape(-1, *shape), names or None


def _rotations(turns: Floats) -> None:
    off = np.abs(turns @ turns.transpose(0, 2, 1) - np.eye(3)).max(axis=(1, 2))
    bad = np.flatnonzero((off > 1e-9) | (np.linalg.det(turns) < 0))
    if bad.size:
        raise ArgumentError(f"orientations[{bad[0]}] is no rotation matrix: its axes are off by {off[bad[0]]:.3g}, or left-handed")
