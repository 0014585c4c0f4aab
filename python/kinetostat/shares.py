"""Which part of a machine gives how much of a deflection, and what every number of its model file changes."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arguments import one_of, shown
from kinetostat._arrays import Floats, one, real
from kinetostat._asking import bare, joint_words, place
from kinetostat.errors import ArgumentError

if TYPE_CHECKING:
    from kinetostat.machine import Machine, Progress
    from kinetostat.posture import Posture

__all__ = ["Part", "Sensitivity", "SensitivityErrors", "Shares", "Stiffening", "cheapest_stiffening", "sensitivities", "shares"]

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
    geometric: float
    """Share of all loads that turn with the machine: 0 without a load, may be negative. Part of the 1."""
    passive_joints: tuple[str, ...]
    """They store nothing: their share is 0."""
    answer: dict[str, Any] = dataclasses.field(repr=False, compare=False)
    """What the command prints, with its units in the names."""

    @property
    def share(self) -> Floats:
        """(parts,): share of each part; the sum is 1."""
        return np.array([part.share for part in self.parts])

    @property
    def part_compliance(self) -> Floats:
        """(parts,): m/N, or rad/(N m) for a moment; the sum is :attr:`compliance`."""
        return np.array([part.compliance for part in self.parts])

    def by(self, what: Literal["limb", "kind"]) -> dict[str | None, float]:
        """Shares of limbs (None: what acts on platforms) or of kinds of parts, the largest first; they add to 1.

        Platforms are rigid bodies: what stands under None or ``platform_load`` and ``weight`` are the loads on them.

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("orthoglide").shares(direction="x").by("limb")
        >>> round(found["leg x"], 12)
        1.0
        """
        one_of("what", what, ("limb", "kind"))
        found: dict[str | None, float] = {}
        for part in self.parts:
            key = part.limb if what == "limb" else part.kind
            found[key] = found.get(key, 0.0) + part.share
        return dict(sorted(found.items(), key=lambda pair: -pair[1]))

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
class SensitivityErrors:
    """Estimated errors of derivatives, in their units: how far those of sixth order are from those of fourth.

    What rounding leaves (some 1e-9 of a figure by the size of the number) is not part of them.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = sensitivities(ks.Machine.preset("heavy_6r"), direction="z", wrench=[0, 0, -500, 0, 0, 0])[0]
    >>> found.errors.compliance < 1e-6 * abs(found.compliance)
    True
    """

    deflection: float
    compliance: float
    stiffness: float
    share_to_buckling: float | None
    """None where there is no derivative."""


@dataclasses.dataclass(frozen=True)
class Sensitivity:
    """Derivatives by one number of the model file, per its unit: SI units per :attr:`unit`.

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
    """m/N, or rad/(N m) for a moment, per unit."""
    stiffness: float
    """N/m, or N m/rad for a moment, per unit."""
    share_to_buckling: float | None
    """Of the limb that is nearest to buckling; None without a load that buckles, and where limbs (or shapes of one) are equally near and
    the number changes them differently: the share has no derivative there, only one to each side."""
    stiffness_by_percent: float
    """Relative change of the stiffness by 1 % more of the number."""
    errors: SensitivityErrors
    """How far the derivatives may be off, estimated."""


@dataclasses.dataclass(frozen=True)
class Stiffening:
    """The cheapest way to a smaller deflection, where one percent more stiffness costs the same for every part.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = cheapest_stiffening(ks.Machine.preset("orthoglide"), 0.2, direction="x")
    >>> found.factors.keys()
    dict_keys(['leg x: foot'])
    """

    possible: bool
    """False where no stiffening of springs is enough."""
    factors: dict[str, float]
    """How many times as stiff each part must be, by ``limb: name``; parts that stay are left out."""
    cost: float
    """Sum of all factors less 1; NaN where it is not possible."""
    reached: float
    """Compliance afterwards by that before; NaN where it is not possible."""
    assumption: str
    """What is assumed, in words."""


def _at(machine: Machine, position: ArrayLike | None, joints: ArrayLike | None) -> dict[str, Any]:
    """Model, tool and place as options of the command."""
    model, length = bare(machine)
    options: dict[str, Any] = {"model": model, "tool_length_mm": length}
    if position is not None and joints is not None:
        raise ArgumentError("give a position or joints, not both")
    if position is not None:
        options["at"] = (one("position", position, (3,)) * 1e3).tolist()
    if joints is not None:
        given = one("joints", joints, (len(machine.actuators),))
        options["joints"] = joint_words(machine, given)
    return options


def _asked(
    where: dict[str, Any],
    direction: Direction | Sequence[float],
    wrench: ArrayLike | None,
    progress: Progress | None,
    **more: Any,
) -> dict[str, Any]:
    from kinetostat import commands

    options = {**where, **more}
    if isinstance(direction, str):
        if direction not in _AXES:
            raise ArgumentError(f"direction is {shown(direction)}, expected one of {', '.join(_AXES)}, or three components")
        options["direction"] = direction
    else:
        options["along"] = one("direction", direction, (3,)).tolist()
    if wrench is not None:
        load = one("wrench", wrench, (6,))
        options["force"], options["moment"] = load[:3].tolist(), load[3:].tolist()
    return commands.shares(**options, progress=progress)


def _shares(answer: dict[str, Any]) -> Shares:
    key = "compliance_m_or_rad_per_n_or_n_m"
    return Shares(
        direction=answer["direction"],
        compliance=answer[key],
        parts=tuple(Part(p["limb"], p["name"], p["kind"], p["share"], p[key]) for p in answer["parts"]),
        rounding=answer["rounding"],
        stable=answer["stable"],
        geometric=answer["geometric_share"],
        passive_joints=tuple(answer["passive_joints"]),
        answer=answer,
    )


def shares_of_posture(
    posture: Posture,
    *,
    direction: Direction | Sequence[float] = "z",
    wrench: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Shares:
    """As :func:`shares`, at a posture; :meth:`kinetostat.Posture.shares`."""
    return _shares(_asked(place(posture), direction, wrench, progress))


def shares(
    machine: Machine,
    position: ArrayLike | None = None,
    *,
    joints: ArrayLike | None = None,
    direction: Direction | Sequence[float] = "z",
    wrench: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Shares:
    """Divides the compliance of the tool in a direction exactly among the parts of a machine.

    Parameters
    ----------
    machine : Machine
        With any tool or none.
    position : array_like, shape (3,), optional
        Of the tool, base axes, m; home without it.
    joints : array_like, shape (actuators,), optional
        Instead: commands, m or rad.
    direction : {"x", "y", "z", "rx", "ry", "rz"} or array_like, shape (3,)
        A force along, or a moment about, an axis of the base; or the direction of a force, base axes.
    wrench : array_like, shape (6,), optional
        Force (N) and moment (N m) on the tool, base axes, about its reference point: shares of what a further small load meets.
        Without it, of the unloaded machine as drawn.
    progress : callable, optional
        As for :meth:`kinetostat.Machine.stiffness`.

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
    return _shares(_asked(_at(machine, position, joints), direction, wrench, progress))


def cheapest_stiffening(
    machine: Machine,
    less: float,
    position: ArrayLike | None = None,
    *,
    joints: ArrayLike | None = None,
    direction: Direction | Sequence[float] = "z",
    progress: Progress | None = None,
) -> Stiffening:
    """The cheapest stiffening of springs that makes the deflection in a direction smaller.

    Parameters
    ----------
    machine, position, joints, direction, progress
        As for :func:`shares`; of the unloaded machine as drawn.
    less : float
        By which share the deflection is to become smaller, between 0 and 1.

    Returns
    -------
    Stiffening

    Raises
    ------
    UnansweredError
        As for :func:`shares`.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = cheapest_stiffening(ks.Machine.preset("heavy_6r"), 0.25, direction="z")
    >>> found.possible, round(found.reached, 9)
    (True, 0.75)
    """
    share = real("less", less)
    if not 0 < share < 1:
        raise ArgumentError(f"less is {share}, expected a share between 0 and 1")
    answer = _asked(_at(machine, position, joints), direction, None, progress, reduce_percent=100 * share)
    found = answer["stiffening"]

    def number(value: float | None) -> float:
        return np.nan if value is None else float(value)

    return Stiffening(
        possible=found["possible"],
        factors={f"{p['limb']}: {p['name']}" if p["limb"] else p["name"]: p["factor"] for p in found["parts"]},
        cost=number(found["cost"]),
        reached=number(found["compliance_ratio_reached"]),
        assumption=found["assumption"],
    )


def sensitivities(
    machine: Machine,
    position: ArrayLike | None = None,
    *,
    joints: ArrayLike | None = None,
    direction: Direction | Sequence[float] = "z",
    wrench: ArrayLike | None = None,
    progress: Progress | None = None,
) -> list[Sensitivity]:
    """Derivatives of deflection, compliance, stiffness and margin by every number of the model file, the strongest first.

    The machine is commanded for the same place, as a controller that knows the changed machine does.

    Parameters
    ----------
    machine, position, joints, direction, wrench, progress
        As for :func:`shares`; the deflection is that under ``wrench`` and all that acts in the model. A tool that is not straight is
        put into the model first: numbers at its last platform are those of that model.

    Returns
    -------
    list of Sensitivity
        Numbers that change none of displacement, stiffness and share of the way to buckling are left out.

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
    answer = _asked(_at(machine, position, joints), direction, wrench, progress, sensitivities=True)
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
            SensitivityErrors(*(n["estimated_errors"][key] for key in ("deflection", "compliance", "stiffness", "share_to_buckling"))),
        )
        for n in answer["sensitivities"]["numbers"]
    ]
