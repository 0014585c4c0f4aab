"""A machine whose tool is part of its model: for questions that take a model and a straight tool only."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arrays import Floats
from kinetostat.errors import ArgumentError

if TYPE_CHECKING:
    from kinetostat.machine import Machine

__all__ = ["with_tool_in_model"]


def with_tool_in_model(machine: Machine) -> Machine:
    """The same machine without a tool, the frame of its last platform where the tool's was.

    Home of the platform, ends of limbs on it, its centre of mass and its inertia are stated anew. Loads that act on that platform at
    places or in axes of its frame, and deviations of these ends, are not: they are refused.
    """
    from kinetostat.build import placement
    from kinetostat.machine import Machine

    tool = machine.tool
    back = np.asarray(np.linalg.inv(tool), dtype=np.float64)
    document = machine.to_dict()
    platform = document["platform"][-1]
    name = platform["name"]
    loads = [*document.get("load", []), *(load for limb in document["limb"] for load in limb.get("load", []))]
    on = {(limb["name"], key) for limb in document["limb"] for key, at in (("start", limb["from"]), ("end", limb["to"])) if at == name}
    moved = any((deviation.get("limb"), deviation.get("at")) in on for deviation in document.get("deviation", []))
    if moved or any(_names(load, name) for load in loads):
        raise ArgumentError(
            f"{machine.name}: this question takes a straight tool along z of the flange (with_tool(length=...)) "
            f"where loads act on the platform {name!r} or deviations are stated at it"
        )
    platform["home"] = placement(machine.home)
    _masses(platform, back)
    for limb in document["limb"]:
        for key, at in (("start", limb["from"]), ("end", limb["to"])):
            if at == name:
                limb[key] = placement(back @ _pose(limb.get(key)))
    return Machine.from_dict(document, machine.file)


def _names(value: Any, name: str) -> bool:
    """Whether a name stands anywhere in a table."""
    if isinstance(value, dict):
        return any(_names(inner, name) for inner in value.values())
    if isinstance(value, list):
        return any(_names(inner, name) for inner in value)
    return bool(value == name)


def _masses(platform: dict[str, Any], back: Floats) -> None:
    if not platform.get("mass_kg"):
        return
    centre = np.array(platform.pop("centre_of_mass_m", np.zeros(3)), dtype=float)
    if "centre_of_mass_mm" in platform:
        centre = 1e-3 * np.array(platform.pop("centre_of_mass_mm"), dtype=float)
    platform["centre_of_mass_m"] = (back[:3, :3] @ centre + back[:3, 3]).tolist()
    if "inertia_kg_m2" in platform:
        inertia = np.array(platform["inertia_kg_m2"], dtype=float)
        turned = back[:3, :3] @ inertia @ back[:3, :3].T
        platform["inertia_kg_m2"] = (0.5 * (turned + turned.T)).tolist()


def _pose(stated: dict[str, Any] | None) -> Floats:
    """A placement of a model file in any of its conventions as a matrix: as home of a platform the model's own reader tells it."""
    from kinetostat.build import MachineBuilder
    from kinetostat.machine import Machine

    if stated is None:
        return np.eye(4)
    builder = MachineBuilder("place")
    builder.platform("place", np.zeros(3))
    builder.limb("x", to="place").spring6("s", np.ones(6))
    document = builder.to_dict()
    document["platform"][0]["home"] = stated
    return Machine.from_dict(document).home
