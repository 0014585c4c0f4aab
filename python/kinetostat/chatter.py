"""Does a cut chatter? Exact stability lobes of milling from modal data of the tool.

Exact means: multipliers of the periodic delay equation by collocation. The limit of zeroth order stands beside them under its own name;
on robots it is 1.6 to 3.7 times too optimistic. Not covered: variable pitch, process damping, ball ends, run-out, loss of contact.
"""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import _core
from kinetostat._arguments import flag, of_kind, or_none, told
from kinetostat._arrays import Floats, finite, one, positive, real, thread_count, whole_number
from kinetostat._plausibility import issue
from kinetostat.errors import ArgumentError
from kinetostat.vibration import ToolModes

__all__ = ["CoupledLimit", "Lobes", "MillingCut", "coupled_limit", "lobes", "multipliers", "tool_modes"]

_Progress = Callable[[int, int, str], object]

_COEFFICIENTS = (5e6, 2e10)
"""Tangential cutting coefficients from foam to hardened steel at thin chips, Pa."""

_RATIO = 5e6
"""Radial coefficients below this are ratios, Pa."""

_DEEPEST = 1.0
"""Deepest cut, m."""


@dataclasses.dataclass(frozen=True)
class MillingCut:
    """A straight milling cut of a tool with evenly spaced teeth.

    Examples
    --------
    >>> from kinetostat.chatter import MillingCut
    >>> MillingCut(teeth=2, immersion=0.5, up=True, coefficients=(8e8, 2.4e8, 0.0)).teeth
    2
    """

    teeth: int
    """Number of teeth."""
    immersion: float
    """Width of cut over the tool's diameter, above 0 and at most 1 (a slot)."""
    up: bool
    """Up milling, else down (climb) milling."""
    coefficients: tuple[float, float, float]
    """Tangential, radial and axial cutting coefficient, Pa (1 N/mm^2 is 1e6); the radial one is no ratio, and a positive axial one pushes
    the tool towards the spindle: below zero with a helix that lifts the chip (right-hand with clockwise rotation)."""
    feed: tuple[float, float, float] = (1.0, 0.0, 0.0)
    """Direction of feed, axes of the modal data."""
    tool_axis: tuple[float, float, float] = (0.0, 0.0, 1.0)
    """From the tool's tip to the spindle, axes of the modal data."""
    helix: tuple[float, float] | None = None
    """Helix angle (rad) and tool diameter (m): the edge lags behind its tip; none for straight teeth."""

    def _native(self) -> _Cut:
        helix = or_none(one, "helix", self.helix, (2,))
        return _Cut(
            whole_number("teeth", self.teeth, 1, 1000),
            flag("up", self.up),
            real("immersion", self.immersion),
            _plausible(one("coefficients", self.coefficients, (3,))),
            None if helix is None else (float(helix[0]), float(helix[1])),
            one("feed", self.feed, (3,)).tolist(),
            one("tool_axis", self.tool_axis, (3,)).tolist(),
        )


def _plausible(coefficients: Floats) -> list[float]:
    """Coefficients within the limits that the command ``lobes`` has."""
    low, high = _COEFFICIENTS
    tangential, *others = coefficients.tolist()
    if not low <= tangential <= high or any(abs(other) > high for other in others):
        looks = f"; it looks like N/mm^2, in Pa it is {1e6 * tangential:g}" if low <= 1e6 * tangential <= high else ""
        raise ArgumentError(f"coefficients is {coefficients.tolist()} Pa, expected a tangential one of {low:g} to {high:g} Pa{looks}")
    if 0 < abs(others[0]) < _RATIO:
        raise ArgumentError(
            f"coefficients has a radial one of {others[0]:g} Pa, which looks like a ratio: in Pa it is {others[0] * tangential:g}"
        )
    if others[0] > tangential:
        kind = "the radial coefficient is above the tangential one: give the tangential one first"
        issue([(True, kind, f"{kind} ({others[0]:g} above {tangential:g} Pa; no chip pushes the tooth more than it brakes it)")])
    return [tangential, *others]


def _depths(name: str, depths: Floats) -> Floats:
    deepest = float(np.max(depths, initial=0.0))
    if deepest > _DEEPEST:
        raise ArgumentError(f"{name} is up to {deepest:g} m, expected at most {_DEEPEST:g} m: it looks like mm")
    return depths


@dataclasses.dataclass(frozen=True)
class _Cut:
    """As the core reads it."""

    teeth: int
    up: bool
    immersion: float
    coefficients: list[float]
    helix: tuple[float, float] | None
    feed: list[float]
    tool_axis: list[float]


@dataclasses.dataclass(frozen=True)
class CoupledLimit:
    """The smallest process that makes a tool unstable by coupling its modes, from :func:`coupled_limit`.

    Examples
    --------
    >>> from kinetostat.chatter import coupled_limit, tool_modes
    >>> tip = tool_modes([[1, 0, 0], [0, 1, 0]], stiffness=[1e6, 1.4e6], frequencies_hz=[22.5, 26.6], damping_ratios=[0.02, 0.02])
    >>> coupled_limit(tip, chip=[1, 1, 0], force=[1, -1, 0]).flutters
    True
    """

    factor: float
    """Stiffness of the process, N/m: width of cut times coefficient."""
    flutters: bool
    """Two modes feed each other; else the process pulls harder than the tool holds."""
    frequency_hz: float
    """Of the vibration; 0 where it does not flutter."""


@dataclasses.dataclass(frozen=True, eq=False)
class Lobes:
    """Limits of stability over the spindle speed, from :func:`lobes`.

    Examples
    --------
    >>> from kinetostat.chatter import MillingCut, lobes, tool_modes
    >>> tip = tool_modes([[1, 0, 0]], stiffness=[1.34e6], frequencies_hz=[922], damping_ratios=[0.011])
    >>> found = lobes(tip, MillingCut(2, 1.0, False, (6e8, 2e8, 0.0)), [4000, 5000], up_to=2e-3)
    >>> found.limit.shape, found.flip.shape
    ((2,), (2,))
    """

    speeds_rpm: Floats
    """(s,)"""
    up_to: float
    """Largest depth that was looked at, m."""
    limit: Floats
    """(s,): smallest depth at which the cut becomes unstable, m; NaN where it is stable up to :attr:`up_to`."""
    frequency_hz: Floats
    """(s,): strongest frequency of the vibration at the limit."""
    flip: NDArray[np.bool_]
    """(s,): the tool repeats itself every other tooth (flip), else it vibrates at a frequency of its own (Hopf)."""
    resolved: Floats
    """(s,): by how much the limit changed with the last third more points of collocation, share of it."""
    zeroth_order: Floats
    """(s,): limit of the approximation of zeroth order, m: no bound. NaN where it has none."""
    stable: list[list[tuple[float, float]]]
    """Of every speed all stretches of depth in which the cut is stable, m; those above the first are islands."""


def tool_modes(directions: ArrayLike, *, stiffness: ArrayLike, frequencies_hz: ArrayLike, damping_ratios: ArrayLike) -> ToolModes:
    """Modal data as a tap test gives them, for a tool without a model.

    Parameters
    ----------
    directions : array_like, shape (m, 3)
        In which each mode moves the tip; their length does not matter.
    stiffness : array_like, shape (m,)
        Along these directions, N/m.
    frequencies_hz : array_like, shape (m,)
        Natural frequencies.
    damping_ratios : array_like, shape (m,)
        Ratios to critical damping.

    Returns
    -------
    ToolModes

    Examples
    --------
    >>> from kinetostat.chatter import tool_modes
    >>> tip = tool_modes([[1, 0, 0]], stiffness=[1.34e6], frequencies_hz=[922], damping_ratios=[0.011])
    >>> round(float(1 / tip.shapes[0, 0] ** 2), 5)  # modal mass, kg
    0.03993
    """
    along = finite("directions", directions)
    if along.ndim != 2 or along.shape[1] != 3:
        raise ArgumentError(f"directions has shape {along.shape}, expected (m, 3)")
    count = len(along)

    def column(name: str, value: ArrayLike) -> Floats:
        given = finite(name, value)
        if given.shape != (count,):
            raise ArgumentError(f"{name} has shape {given.shape}, expected ({count},): one for each of the directions {along.shape}")
        return given

    stiff, hz = column("stiffness", stiffness), column("frequencies_hz", frequencies_hz)
    ratios = column("damping_ratios", damping_ratios)
    length = np.linalg.norm(along, axis=1)
    if np.any(length == 0) or np.any(stiff <= 0) or np.any(hz <= 0):
        raise ArgumentError("directions of length 0, stiffnesses and frequencies that are not above 0 are no modes")
    squared = (2 * math.pi * hz) ** 2
    shapes = along * (np.sqrt(squared / stiff) / length)[:, None]
    return ToolModes(shapes, squared, ratios, np.zeros((3, 3)))


def _of_tool(tool: ToolModes) -> ToolModes:
    of_kind("tool", tool, ToolModes, "a kinetostat.vibration.ToolModes")
    return ToolModes(
        shapes=finite("shapes", tool.shapes),
        squared=finite("squared", tool.squared),
        damping_ratios=finite("damping_ratios", tool.damping_ratios),
        residual=finite("residual", tool.residual),
        held=finite("held", tool.held),
        rates=None if tool.rates is None else finite("rates", tool.rates),
    )


def _asked(tool: ToolModes, cut: MillingCut) -> tuple[ToolModes, _Cut]:
    return (_of_tool(tool), of_kind("cut", cut, MillingCut, "a kinetostat.chatter.MillingCut")._native())


def _speeds(name: str, value: ArrayLike) -> Floats:
    given = finite(name, value)
    if given.ndim != 1:
        raise ArgumentError(f"{name} has shape {given.shape}, expected (s,)")
    return given


def coupled_limit(tool: ToolModes, *, chip: ArrayLike, force: ArrayLike) -> CoupledLimit | None:
    """Mode coupling: the smallest process stiffness at which a cut without regeneration (low frequency, fast teeth) is unstable.

    A displacement along ``chip`` thickens the chip, and the cut pushes back against ``force``: ``F = -Kc f (n . r)``.

    Parameters
    ----------
    tool : ToolModes
        Modal data of the tip, every mode damped.
    chip : array_like, shape (3,)
        Direction that thickens the chip.
    force : array_like, shape (3,)
        Direction of the force.

    Returns
    -------
    CoupledLimit | None
        ``None`` where no process along these directions makes the tool unstable.

    Examples
    --------
    >>> from kinetostat.chatter import coupled_limit, tool_modes
    >>> tip = tool_modes([[1, 0, 0], [0, 1, 0]], stiffness=[1e6, 1.4e6], frequencies_hz=[22.5, 26.6], damping_ratios=[0.02, 0.02])
    >>> coupled_limit(tip, chip=[1, 0, 0], force=[1, 0, 0]) is None
    True
    """
    found = _core.coupled_limit_of(_of_tool(tool), one("chip", chip, (3,)).tolist(), one("force", force, (3,)).tolist())
    return None if found is None else CoupledLimit(*found)


def lobes(
    tool: ToolModes,
    cut: MillingCut,
    speeds_rpm: ArrayLike,
    *,
    up_to: float,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> Lobes:
    """Exact limits of stability at spindle speeds.

    Parameters
    ----------
    tool : ToolModes
        From :meth:`kinetostat.vibration.Vibration.tool_modes` or :func:`tool_modes`.
    cut : MillingCut
        What is cut.
    speeds_rpm : array_like, shape (s,)
        Spindle speeds.
    up_to : float
        Largest depth of cut that is looked at, m.
    threads : int | None
        All cores if none.
    progress : Callable | None
        Called with what is done, how much there is and the stage.

    Returns
    -------
    Lobes

    Examples
    --------
    A slot with one mode, against a reference value:

    >>> from kinetostat.chatter import MillingCut, lobes, tool_modes
    >>> tip = tool_modes([[1, 0, 0]], stiffness=[1340045.0], frequencies_hz=[922], damping_ratios=[0.011])
    >>> found = lobes(tip, MillingCut(2, 1.0, False, (6e8, 2e8, 0.0)), [5000.0], up_to=1e-3)
    >>> round(float(found.limit[0]) * 1e3, 3), bool(found.flip[0])
    (0.409, False)
    """
    speeds, depth = _speeds("speeds_rpm", speeds_rpm), positive("up_to", up_to)
    _depths("up_to", np.array(depth))
    found = _core.lobes_of(*_asked(tool, cut), speeds, depth, thread_count(threads), told(progress))
    return Lobes(speeds_rpm=speeds, up_to=depth, **found)


def multipliers(
    tool: ToolModes,
    cut: MillingCut,
    speeds_rpm: ArrayLike,
    depths: ArrayLike,
    *,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> Floats:
    """Size of the largest multiplier: a disturbance is so much larger after each tooth; below 1 the cut is stable.

    Parameters
    ----------
    tool : ToolModes
        Modal data of the tip.
    cut : MillingCut
        What is cut.
    speeds_rpm : array_like, shape (...)
        Spindle speeds.
    depths : array_like, shape (...)
        Depths of cut, m, broadcast against the speeds.
    threads : int | None
        All cores if none.
    progress : Callable | None
        Called with what is done, how much there is and the stage.

    Returns
    -------
    Floats
        (...)

    Examples
    --------
    >>> from kinetostat.chatter import MillingCut, multipliers, tool_modes
    >>> tip = tool_modes([[1, 0, 0]], stiffness=[1.34e6], frequencies_hz=[922], damping_ratios=[0.011])
    >>> cut = MillingCut(2, 1.0, False, (6e8, 2e8, 0.0))
    >>> (multipliers(tip, cut, 5000.0, [0.3e-3, 0.5e-3]) < 1).tolist()
    [True, False]
    """
    given, deep = finite("speeds_rpm", speeds_rpm), _depths("depths", finite("depths", depths))
    try:
        given, deep = np.broadcast_arrays(given, deep)
    except ValueError:
        raise ArgumentError(f"speeds_rpm has shape {given.shape} and depths {deep.shape}: they do not broadcast") from None
    shape = given.shape
    speeds, deep = (np.ascontiguousarray(array, dtype=float).reshape(-1) for array in (given, deep))
    found = _core.multipliers_of(*_asked(tool, cut), speeds, deep, thread_count(threads), told(progress))
    return found.reshape(shape)
