"""Figures that look wrong in a question although it can be answered, the same in calls for one posture and for many."""

from __future__ import annotations

import sys
import warnings
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat import _core
from kinetostat._arrays import Floats
from kinetostat.errors import PlausibilityWarning
from kinetostat.status import Status

if TYPE_CHECKING:
    from numpy.typing import NDArray

Said = tuple[bool, str, str]
"""True if it is issued; its kind, a constant sentence; its message, with figures."""

_TURNS = 20.0
"""Largest command of an actuator that turns, rad: three turns."""

_FAR = 100.0
"""Largest command of an actuator that slides, m."""

_COMMANDS = "commands are beyond what actuators have; check their units (rad, m)"
_NOWHERE = "none of the places can be reached; check their unit (m) and the frame in which they are"


def sentences(found: Sequence[Said]) -> tuple[str, ...]:
    """All messages, for the ``warnings`` of a result."""
    return tuple(message for _, _, message in found)


def issue(found: Sequence[Said]) -> None:
    """Issues what is beyond a limit as a warning, of the line that called the package.

    The text is that of the kind, so that filters of Python merge repeated ones; ``detail`` has the figures.
    """
    if not any(beyond for beyond, _, _ in found):
        return
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_globals.get("__name__", "").partition(".")[0] == "kinetostat":
        level, frame = level + 1, frame.f_back
    for beyond, kind, message in found:
        if beyond:
            warnings.warn(PlausibilityWarning(kind, message), stacklevel=level)


def counted(found: Sequence[object]) -> str:
    """How many there are, for the end of a representation."""
    return f"; {len(found)} warning{'s' * (len(found) != 1)}" if found else ""


def of_commands(native: _core.Machine, commands: Floats) -> list[Said]:
    """Commands in degrees or millimetres, of one posture or many."""
    most = np.abs(commands.reshape(-1, commands.shape[-1])).max(axis=0, initial=0.0)
    units = {"revolute": ("rad", _TURNS), "prismatic": ("m", _FAR)}
    each = zip(native.actuators(), most, strict=True)
    return [
        (True, _COMMANDS, f"{row[0]} is commanded to {at:.6g} {units[row[1]][0]}: usually a unit is wrong")
        for row, at in each
        if at > units[row[1]][1]
    ]


def of_many(native: _core.Machine, wrenches: Floats | None, displacement: Any, status: NDArray[np.uint8]) -> list[Said]:
    """Loads, displacements (..., 3) and places of many postures."""

    def largest(vectors: Any) -> float:
        # Of numbers so large that their squares are none it is infinite.
        with np.errstate(over="ignore"):
            return float(np.linalg.norm(vectors, axis=-1).max(initial=0.0, where=~np.isnan(vectors[..., 0])))

    force, moment = (0.0, 0.0) if wrenches is None else (largest(wrenches[..., :3]), largest(wrenches[..., 3:]))
    found = _core.answer_warnings(native, force, moment, 0.0 if displacement is None else largest(displacement))
    if status.size and (status == Status.UNSOLVED).all():
        found.append((True, _NOWHERE, f"none of {status.size} places can be reached, or has an equilibrium"))
    return found
