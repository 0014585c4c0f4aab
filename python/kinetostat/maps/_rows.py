"""Rows of a map: the function of its sweep.

The rows of a map run through loads, orientations and places along x, y and z, the last fastest.
"""

from __future__ import annotations

from typing import Any

import numpy as np

from kinetostat import _core
from kinetostat._arrays import Floats
from kinetostat._places import poses_of
from kinetostat.machine import Machine
from kinetostat.maps._variables import chosen
from kinetostat.status import Status


def rows(
    first: int,
    last: int,
    *,
    threads: int | None,
    machine: Machine,
    x: Floats,
    y: Floats,
    z: Floats,
    rotations: Floats | None,
    wrenches: Floats | None,
    names: list[str],
    worst: bool,
    places: bool,
) -> dict[str, Any]:
    """Variables of rows of a map.

    ``rotations`` (k, 3, 3) or none for that of the machine; ``wrenches`` (m, 6) or none; ``worst``: rows do not run through
    orientations, each takes the worst of all; ``places``: with columns of where each row is.
    """
    turns = 1 if worst or rotations is None else len(rotations)
    shape = (1 if wrenches is None else len(wrenches), turns, len(x), len(y), len(z))
    load, turn, *at = np.unravel_index(np.arange(first, last), shape)
    position = np.stack([x[at[0]], y[at[1]], z[at[2]]], axis=-1)
    loads = None if wrenches is None else np.ascontiguousarray(wrenches[load])
    found: dict[str, Any] = {}
    for each in range(len(rotations)) if worst and rotations is not None else [None]:
        turned = None if rotations is None else rotations[turn] if each is None else rotations[each]
        one = _core.evaluate_many(machine._native, _poses(machine, position, turned, threads), loads, names, threads)
        found = worse(found, one) if found else dict(one)
    if not places:
        return found
    where: dict[str, Any] = {"load": load.astype(np.int32)} if loads is not None else {}
    if rotations is not None and not worst:
        where["orientation"] = turn.astype(np.int32)
    return {**where, "x": position[:, 0], "y": position[:, 1], "z": position[:, 2], **found}


def _poses(machine: Machine, position: Floats, rotations: Floats | None, threads: int | None) -> Floats:
    if rotations is None:
        return poses_of(machine._native, position, threads)[0]
    poses = np.empty((len(position), 4, 4))
    poses[:] = machine.home
    poses[:, :3, 3] = position
    poses[:, :3, :3] = rotations
    return poses


def worse(own: dict[str, Any], other: dict[str, Any]) -> dict[str, Any]:
    """The worse of two, column by column. What has no answer in one orientation has none as the worst of all."""
    out = {"status": np.maximum(own["status"], other["status"])}
    unsolved = out["status"] == Status.UNSOLVED
    for variable in chosen([name for name in own if name != "status"]):
        a, b = own[variable.name], other[variable.name]
        if variable.worse == "smaller":
            value = np.minimum(a, b)
        elif variable.worse == "larger":
            value = np.maximum(a, b)
        else:
            value = np.where((np.abs(b) > np.abs(a)) | np.isnan(b), b, a)
        value[unsolved] = np.nan
        out[variable.name] = value
    return out
