"""Which part of a machine gives how much of a deflection, and what every number of its model file changes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arrays import one
from kinetostat.errors import ArgumentError

if TYPE_CHECKING:
    from kinetostat.machine import Machine

__all__ = ["Part", "Sensitivity", "Shares", "sensitivities", "shares"]

_AXES = ("x", "y", "z", "rx", "ry", "rz")
Direction = Literal["x", "y", "z", "rx", "ry", "rz"]


@dataclasses.dataclass(frozen=True)
class Part:
    """What one part gives.

    Examples
    --------
    >>> import kinetostat as ks
    >>> part = ks.Machine.preset("heavy_6r").shares(direction="z").parts[0]
    >>> part.kind in ("drive", "link"), 0 < part.share < 1
    (True, True)
    """

    limb: str | None
    """Its limb; none for what acts on platforms."""
    name: str
    """As in the model file."""
    kind: str
    """``link``, ``drive``, ``spring``, ``platform_load``, ``loads_of_limb`` or ``weight``; the last two are geometric stiffness."""
    share: float
    """Of the compliance; all shares add to 1."""
    compliance: float
    """m/N, or rad/(N m) for a moment."""


@dataclasses.dataclass(frozen=True)
class Shares:
    """The deflection in a direction, part by part, the largest first.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("heavy_6r").shares(direction="z")
    >>> abs(sum(part.share for part in found.parts) - 1) < 1e-12
    True
    """

    direction: str
    """In words."""
    compliance: float
    """Motion of the tool along the load by the load: m/N, or rad/(N m) for a moment."""
    parts: tuple[Part, ...]
    rounding: float
    """Sum of all parts by the motion of the tool, less 1."""
    stable: bool
    """Whether the machine stays where the load puts it."""

    def by_name(self) -> dict[str, float]:
        """Shares by ``limb: name``.

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("heavy_6r").shares(direction="z").by_name()
        >>> found["arm: joint 2"] > found["arm: joint 6"]
        True
        """
        return {f"{p.limb}: {p.name}" if p.limb else p.name: p.share for p in self.parts}


@dataclasses.dataclass(frozen=True)
class Sensitivity:
    """Derivatives by one number of the model file, per its unit.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = sensitivities(ks.Machine.preset("heavy_6r"), direction="z", wrench=[0, 0, -500, 0, 0, 0])[0]
    >>> found.path.startswith("chain.arm."), abs(found.stiffness_by_percent) > 0
    (True, True)
    """

    path: str
    value: float
    unit: str
    deflection: float
    """m (rad for a moment) per unit, along the direction."""
    compliance: float
    stiffness: float
    share_to_buckling: float | None
    stiffness_by_percent: float
    """Relative change of the stiffness by 1 % more of the number."""


def _asked(
    machine: Machine,
    position: ArrayLike | None,
    joints: ArrayLike | None,
    direction: Direction | Sequence[float],
    wrench: ArrayLike | None,
    more: dict[str, Any],
) -> dict[str, Any]:
    from kinetostat import commands
    from kinetostat.machine import Machine

    options: dict[str, Any] = dict(more)
    tool = machine.tool
    straight = np.eye(4)
    straight[2, 3] = tool[2, 3]
    if not np.array_equal(tool, straight):
        raise ArgumentError("shares take a machine without a tool or with a straight one, along z of the flange")
    if tool[2, 3] != 0.0:
        options["tool_length_mm"] = float(tool[2, 3]) * 1e3
        machine = Machine.from_toml(machine.text, machine.file)
    if position is not None and joints is not None:
        raise ArgumentError("give a position or joints, not both")
    if position is not None:
        options["at"] = (one("position", position, (3,)) * 1e3).tolist()
    if joints is not None:
        given = one("joints", joints, (len(machine.actuators),))
        scale = [1e3 if a.kind == "prismatic" else 180.0 / np.pi for a in machine.actuators]
        options["joints"] = [f"{a.name}={float(x * s)!r}" for a, x, s in zip(machine.actuators, given, scale, strict=True)]
    if isinstance(direction, str):
        if direction not in _AXES:
            raise ArgumentError(f"direction is {direction!r}, expected one of {', '.join(_AXES)}, or three components")
        options["direction"] = direction
    else:
        options["along"] = one("direction", direction, (3,)).tolist()
    if wrench is not None:
        load = one("wrench", wrench, (6,))
        options["force"], options["moment"] = load[:3].tolist(), load[3:].tolist()
    return commands.shares(machine, **options)


def shares(
    machine: Machine,
    position: ArrayLike | None = None,
    *,
    joints: ArrayLike | None = None,
    direction: Direction | Sequence[float] = "z",
    wrench: ArrayLike | None = None,
) -> Shares:
    """Divides the compliance of the tool in a direction exactly among the parts of a machine.

    Parameters
    ----------
    machine : Machine
        With a straight tool or none.
    position : array_like, shape (3,), optional
        Of the tool, base axes, m; home without it.
    joints : array_like, shape (actuators,), optional
        Instead: commands, m or rad.
    direction : {"x", "y", "z", "rx", "ry", "rz"} or array_like, shape (3,)
        A force along, or a moment about, an axis of the base; or the direction of a force, base axes.
    wrench : array_like, shape (6,), optional
        Force (N) and moment (N m) on the tool, base axes, about its reference point: shares of what a further small load meets.
        Without it, of the unloaded machine as drawn.

    Returns
    -------
    Shares

    Raises
    ------
    UnansweredError
        Nothing holds the tool in this direction, or nothing yields; no equilibrium; out of reach.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = shares(ks.Machine.preset("orthoglide"), [0.02, 0.01, 0.03], direction="x")
    >>> round(sum(part.share for part in found.parts), 12)
    1.0
    """
    answer = _asked(machine, position, joints, direction, wrench, {})
    key = "compliance_m_or_rad_per_n_or_n_m"
    parts = tuple(Part(p["limb"], p["name"], p["kind"], p["share"], p[key]) for p in answer["parts"])
    return Shares(answer["direction"], answer[key], parts, answer["rounding"], answer["stable"])


def sensitivities(
    machine: Machine,
    position: ArrayLike | None = None,
    *,
    joints: ArrayLike | None = None,
    direction: Direction | Sequence[float] = "z",
    wrench: ArrayLike | None = None,
) -> list[Sensitivity]:
    """Derivatives of deflection, compliance, stiffness and margin by every number of the model file, the strongest first.

    The machine is commanded for the same place, as a controller that knows the changed machine does.

    Parameters
    ----------
    machine, position, joints, direction, wrench
        As for :func:`shares`; the deflection is that under ``wrench`` and all that acts in the model.

    Returns
    -------
    list of Sensitivity
        Numbers without an effect are left out.

    Raises
    ------
    UnansweredError
        As for :func:`shares`.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = sensitivities(ks.Machine.preset("orthoglide"), wrench=[0, 0, 100, 0, 0, 0])
    >>> len(found) > 10
    True
    """
    answer = _asked(machine, position, joints, direction, wrench, {"sensitivities": True})
    return [
        Sensitivity(
            n["path"],
            n["value"],
            n["unit"],
            n["deflection"],
            n["compliance"],
            n["stiffness"],
            n["share_to_buckling"],
            n["stiffness_by_percent_relative"],
        )
        for n in answer["sensitivities"]["numbers"]
    ]
