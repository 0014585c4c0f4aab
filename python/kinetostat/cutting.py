"""Forces of cuts: typed answers of ``force``."""

from __future__ import annotations

import dataclasses
from typing import Any

from kinetostat import commands
from kinetostat._arrays import Floats
from kinetostat._asking import numbers_or_nan

__all__ = ["MillingForce", "milling_force"]


@dataclasses.dataclass(frozen=True, eq=False)
class MillingForce:
    """Force on a milling tool over a revolution. Axes: x along the feed, y to its left, z along the tool towards the spindle.

    Examples
    --------
    >>> found = milling_force(material="AlMg4.5Mn", tool="flat", diameter_mm=12, teeth=4, helix_deg=38, width_mm=4, depth_mm=8,
    ...                       climb=True, feed_per_tooth_mm=0.1, rpm=8000)
    >>> bool((abs(found.low) < abs(found.mean)).all() and (abs(found.mean) < abs(found.high)).all())
    True
    """

    mean: Floats
    """(3,): N, which bends the machine."""
    low: Floats
    """(3,): N, mean of the smallest force within the spread of the material."""
    high: Floats
    """(3,): N, mean of the largest one."""
    moment: Floats
    """(3,): mean moment about the tool's tip, N m."""
    peak: Floats
    """(3,): N."""
    torque: float
    """Mean about the spindle, N m."""
    power: float | None
    """Mean, W; none without a spindle speed (``rpm``)."""
    assumed: tuple[str, ...]
    """What was assumed."""
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""


def milling_force(**cut: Any) -> MillingForce:
    """Force of one cut from material, tool, width, depth and feed.

    Parameters
    ----------
    **cut
        As for :func:`kinetostat.commands.force`, units in the names.

    Returns
    -------
    MillingForce

    Examples
    --------
    >>> import numpy as np
    >>> found = milling_force(material="AlMg4.5Mn", tool="flat", diameter_mm=12, teeth=4, helix_deg=38, width_mm=4, depth_mm=8,
    ...                       climb=True, feed_per_tooth_mm=0.1, rpm=8000)
    >>> found.mean.round().tolist(), round(found.power / (found.torque * 8000 * np.pi / 30), 9)
    ([273.0, 612.0, -163.0], 1.0)
    """
    answer = commands.force(**cut)
    mean = answer["mean"]
    return MillingForce(
        mean=numbers_or_nan(mean["force_n"]),
        low=numbers_or_nan(mean["force_low_n"]),
        high=numbers_or_nan(mean["force_high_n"]),
        moment=1e-3 * numbers_or_nan(mean["moment_n_mm"]),
        peak=numbers_or_nan(answer["peak"]["force_n"]),
        torque=1e-3 * mean["torque_n_mm"],
        power=mean["power_w"],
        assumed=tuple(answer["assumed"]),
        answer=answer,
    )
