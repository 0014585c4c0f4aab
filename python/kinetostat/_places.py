"""Places, commands and loads, one or many, as they are given to a machine."""

from __future__ import annotations

import math
from typing import Any, cast

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import _core
from kinetostat._arrays import Floats, fitting, numbers, one, rows
from kinetostat._plausibility import issue, of_commands
from kinetostat.errors import ArgumentError

__all__ = ["places_of", "poses_of", "posture_at", "shaped", "wrenches_of"]

_BLOCK = 1 << 17


def posture_at(
    native: _core.Machine,
    position: ArrayLike | None,
    rotation: ArrayLike | None,
    pose: ArrayLike | None,
    joints: ArrayLike | None,
    near: _core.Posture | None,
) -> _core.Posture:
    """The machine commanded for one place or by joints; at home without either."""
    if joints is not None:
        if pose is not None or position is not None or rotation is not None:
            raise ArgumentError("give joints or a place, not both")
        commands = one("joints", joints, (len(native.actuators()),))
        issue(of_commands(native, commands))
        return native.posture_at_joints(commands.tolist())
    if pose is not None:
        if position is not None or rotation is not None:
            raise ArgumentError("give a pose, or a position and a rotation, not both")
        return native.posture_at_pose(one("pose", pose, (4, 4))[None], near)
    if rotation is None and position is not None:
        place = one("position", position, (3,))
        return native.posture_at_position(place.tolist(), native.turns_as_it_moves(), near)
    at = native.home_pose()
    if position is not None:
        at[:3, 3] = one("position", position, (3,))
    if rotation is not None:
        at[:3, :3] = one("rotation", rotation, (3, 3))
    return native.posture_at_pose(at[None], near)


def poses_of(
    native: _core.Machine, poses: ArrayLike, threads: int | None = None, *, follow: bool = True, name: str = "poses"
) -> tuple[Floats, tuple[int, ...]]:
    """Poses (n, 4, 4) from poses or from positions with the orientation at home.

    ``follow``: where the tool turns as the machine moves, with the one nearest to that which the machine takes there.
    """
    given = numbers(name, poses)
    if given.shape[-2:] == (4, 4):
        return rows(name, given, (4, 4))
    if given.shape[-1:] != (3,):
        raise ArgumentError(f"{name} has shape {given.shape}, expected (..., 4, 4), or positions (..., 3)")
    places, leading = rows(name, given, (3,))
    if follow and native.turns_as_it_moves():
        return _core.poses_following(native, places, threads), leading
    out = np.empty((len(places), 4, 4))
    home = native.home_pose()
    # In blocks: Ctrl-C waits for numpy, and to fill a gigabyte takes seconds.
    for first in range(0, len(out), _BLOCK):
        block = slice(first, first + _BLOCK)
        out[block] = home
        out[block, :3, 3] = places[block]
    return out, leading


def places_of(
    native: _core.Machine, poses: ArrayLike | None, joints: ArrayLike | None, threads: int | None
) -> tuple[Floats | None, Floats | None, tuple[int, ...]]:
    """Poses (n, 4, 4) or commands (n, actuators), whichever is given, and the shape that the answer has before its own axes."""
    if (poses is None) == (joints is None):
        raise ArgumentError("give poses or joints")
    if poses is not None:
        places, leading = poses_of(native, poses, threads)
        return places, None, leading
    commands, leading = rows("joints", cast(ArrayLike, joints), (len(native.actuators()),))
    issue(of_commands(native, commands))
    return None, commands, leading


def wrenches_of(wrenches: ArrayLike, leading: tuple[int, ...]) -> Floats:
    """Wrenches (1, 6) for all places, or (n, 6): one for each."""
    given = fitting("wrenches", wrenches, (6,))
    if given.ndim == 1:
        return given.reshape(1, 6)
    if given.shape[:-1] != leading:
        raise ArgumentError(f"wrenches has shape {given.shape}, expected (6,) or {(*leading, 6)}")
    return np.ascontiguousarray(given.reshape(math.prod(leading), 6))


def shaped(array: NDArray[Any], leading: tuple[int, ...]) -> NDArray[Any]:
    """Rows in the shape of what was asked."""
    return array.reshape(leading + array.shape[1:])
