"""What typed questions share: the place of a posture in the words of a command, and its answer in SI units."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arguments import of_kind, refused, texts
from kinetostat._arrays import Floats, one
from kinetostat._tool import with_tool_in_model
from kinetostat.errors import ArgumentError, KinetostatError
from kinetostat.spatial import rotation_vector

if TYPE_CHECKING:
    from kinetostat.machine import Machine
    from kinetostat.posture import Posture


def numbers_or_nan(values: Sequence[Any]) -> Floats:
    """Numbers of an answer; what is null there is NaN here."""
    return np.array([np.nan if value is None else value for value in values], dtype=float)


def triple(name: str, value: ArrayLike | None, factor: float = 1.0) -> list[float] | None:
    """Three numbers for an option."""
    if value is None:
        return None
    found: list[float] = (one(name, value, (3,)) * factor).tolist()
    return found


def node_loads(loads: Mapping[str, ArrayLike] | Sequence[str] | None) -> list[str] | None:
    """Forces on nodes, N, in the words of a command."""
    if loads is None:
        return None
    if not isinstance(loads, Mapping):
        return texts("loads", loads, "a dictionary of forces by node, or a list of text as 'node=fx,fy,fz'") or None
    for node in loads:
        if not isinstance(node, str):
            raise refused("a key of loads", node, "the name of a node")
    forces = ((node, one(f"loads[{node!r}]", force, (3,)).tolist()) for node, force in loads.items())
    return [f"{node}={','.join(map(repr, force))}" for node, force in forces] or None


def handed_on(own: dict[str, Any], further: Mapping[str, Any]) -> dict[str, Any]:
    """Options of a command: those that a function makes of its own arguments, and further ones of its caller."""
    no_option_of(further, **dict.fromkeys(own, "none of it: this function gives it to the command itself, by its own arguments"))
    return {**own, **further}


def no_option_of(options: Mapping[str, Any], **arguments: str) -> None:
    """Refuses options of the command that are arguments of the typed question under another name, or its own business."""
    for name, instead in arguments.items():
        if name in options:
            raise ArgumentError(f"{name} is no argument here, expected {instead}")


def bare(machine: Machine) -> tuple[Machine, float | None]:
    """The machine without its tool, and the length of a straight one in mm; another tool becomes part of the model."""
    from kinetostat.machine import Machine

    tool = of_kind("machine", machine, Machine, "a Machine").tool
    if np.array_equal(tool, np.eye(4)):
        return machine, None
    straight = np.eye(4)
    straight[2, 3] = tool[2, 3]
    if not np.array_equal(tool, straight):
        return with_tool_in_model(machine), 0.0
    return machine._of(machine._native.with_tool(np.eye(4)[None])), float(1e3 * tool[2, 3])


def joint_words(machine: Machine, joints: Floats) -> list[str]:
    """Commands of all actuators, m or rad, in the words of a command: mm and deg by name."""
    scales = [1e3 if actuator.kind == "prismatic" else 180.0 / np.pi for actuator in machine.actuators]
    each = zip(machine.actuators, joints, scales, strict=True)
    return [f"{actuator.name}={float(value * scale)!r}" for actuator, value, scale in each]


def place(posture: Posture) -> dict[str, Any]:
    """Model, place and tool as options of a command.

    The command finds the posture by the place of its tool; where that leads to another one, as with redundant arms and other elbows, by
    its joints. Where these do not say where the machine is, the command would answer for another posture.
    """
    from kinetostat.posture import Posture

    machine = of_kind("posture", posture, Posture, "a Posture").machine
    target = posture.target
    model, length = bare(machine)
    options: dict[str, Any] = {"model": model, "tool_length_mm": length}
    again = _found(machine, pose=target)
    if again is not None and _same(again, posture):
        turn = ",".join(repr(float(x)) for x in rotation_vector(target[:3, :3]))
        return {**options, "at": (1e3 * target[:3, 3]).tolist(), "rotation": f"rotation_vector_rad={turn}"}
    by_joints = _found(machine, joints=posture.commands)
    if by_joints is not None and _same(by_joints, posture):
        return {**options, "joints": joint_words(machine, posture.commands)}
    other = "none" if again is None else again.commands.tolist()
    raise ArgumentError(
        "several postures reach the place of this one, and this question is about the one next to home: "
        f"its commands are {other}, those of the posture {posture.commands.tolist()}"
    )


def _found(machine: Machine, *, pose: Floats | None = None, joints: Floats | None = None) -> Posture | None:
    """The posture that a command finds."""
    try:
        return machine.posture(pose=pose, joints=joints)
    except KinetostatError:
        return None


def _same(one: Posture, other: Posture) -> bool:
    """Whether two postures have the same commands and all their joints at the same places."""
    if np.abs(one.commands - other.commands).max(initial=0.0) > 1e-9:
        return False
    pairs = [(one.target, other.target), *zip(one.limb_lines(), other.limb_lines(), strict=True)]
    return all(np.allclose(a, b, rtol=0, atol=1e-7) for a, b in pairs)


def coordinates_in_si(names: Sequence[dict[str, Any]], values: Floats) -> Floats:
    """Coordinates in m and rad from those in mm and deg, the last axis by their names."""
    factors = np.array([1e-3 if name["unit"] == "mm" else np.pi / 180 for name in names])
    return values * factors if values.size else values


def wrenches(points: Sequence[dict[str, Any]]) -> Floats:
    """(n, 6): N, N m."""
    return np.array([[*p["force_n"], *p["moment_n_m"]] for p in points], dtype=float).reshape(-1, 6)
