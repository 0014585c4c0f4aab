"""Pictures with matplotlib, which is imported when one is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import of_kind, one_of, refused
from kinetostat._arrays import positive, whole_number
from kinetostat.errors import ArgumentError

if TYPE_CHECKING:
    from kinetostat import chatter
    from kinetostat.curves import ForceCurve
    from kinetostat.shares import Shares
    from kinetostat.tolerance import MachineSamples
    from kinetostat.vibration import Damping, Vibration

__all__ = ["force_curve", "lobes", "modes", "response", "shares", "tolerance"]


def _axes(given: Any) -> Any:
    """The axes given, or those of a new figure."""
    if given is not None and not hasattr(given, "plot"):
        raise refused("axes", given, "Axes of matplotlib, or None")
    try:
        import matplotlib.pyplot as plt
    except ImportError as absent:
        raise ImportError("pictures need matplotlib: pip install 'kinetostat[plot]'") from absent
    return plt.subplots()[1] if given is None else given


def force_curve(curve: ForceCurve, axes: Any = None) -> Any:
    """Draws force over displacement: stable parts solid, unstable ones dashed, special points by their letters.

    Parameters
    ----------
    curve : ForceCurve
        What is drawn.
    axes : matplotlib.axes.Axes, optional
        Where; new ones without it.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    >>> force_curve(found).get_ylabel()
    'force, N'
    """
    from kinetostat.curves import ForceCurve

    of_kind("curve", curve, ForceCurve, "a ForceCurve")
    axes = _axes(axes)
    turning = curve.answer["grows"] == "rotation"
    scale, unit, load = (180 / np.pi, "deg", "N m") if turning else (1e3, "mm", "N")
    for number, branch in enumerate(curve.branches):
        x, y = branch.displacement * scale, branch.force
        color = f"C{number % 10}"
        axes.plot(np.where(branch.stable_when_moved, x, np.nan), y, color=color, label=f"branch {number + 1}")
        axes.plot(np.where(branch.stable_when_moved, np.nan, x), y, color=color, linestyle="--")
    for point in curve.special:
        axes.plot(point.displacement * scale, point.force, "ko", markersize=4)
        axes.annotate(point.name, (point.displacement * scale, point.force), textcoords="offset points", xytext=(5, 5))
    axes.set_xlabel(f"{'rotation' if turning else 'displacement'}, {unit}")
    axes.set_ylabel(f"{'moment' if turning else 'force'}, {load}")
    axes.legend()
    return axes


def modes(vibration: Vibration, axes: Any = None, *, most: int = 12) -> Any:
    """Draws the share of each direction of the tool in each mode, the natural frequency below it.

    Parameters
    ----------
    vibration : Vibration
        From :meth:`kinetostat.Posture.vibration`.
    axes : matplotlib.axes.Axes, optional
        New ones without it.
    most : int
        Number of the lowest modes that are drawn.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import kinetostat as ks
    >>> modes(ks.Machine.preset("heavy_6r").posture().vibration()).get_xlabel()
    'natural frequency, Hz'
    """
    from kinetostat.vibration import Vibration

    of_kind("vibration", vibration, Vibration, "a Vibration")
    axes = _axes(axes)
    count = whole_number("most", most, 1, 1000)
    moved = np.abs(vibration.tool_shapes[:count, :3])
    bottom = np.zeros(len(moved))
    for name, column in zip("xyz", moved.T, strict=True):
        axes.bar(np.arange(len(moved)), column, bottom=bottom, label=f"tool along {name}")
        bottom = bottom + column
    axes.set_xticks(np.arange(len(moved)), [f"{hz:.4g}" for hz in vibration.frequencies_hz[:count]], rotation=45)
    axes.set_xlabel("natural frequency, Hz")
    axes.set_ylabel("motion of the tool in the mode of unit modal mass, 1/sqrt(kg)")
    axes.legend()
    return axes


def response(vibration: Vibration, damping: Damping | float, axes: Any = None, *, most_hz: float | None = None) -> Any:
    """Draws the receptance of the tool along x, y and z over the frequency (FRF).

    Parameters
    ----------
    vibration : Vibration
        From :meth:`kinetostat.Posture.vibration`.
    damping : Damping or float
        A law, or the ratio of all modes.
    axes : matplotlib.axes.Axes, optional
        New ones without it.
    most_hz : float, optional
        Largest frequency; 1.5 times that of the sixth mode without it.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import kinetostat as ks
    >>> response(ks.Machine.preset("heavy_6r").posture().vibration(), 0.03).get_ylabel()
    'receptance, um/N'
    """
    from kinetostat.vibration import Vibration

    known = of_kind("vibration", vibration, Vibration, "a Vibration").frequencies_hz
    last = 1.5 * float(known[: min(6, len(known))][-1]) if most_hz is None else positive("most_hz", most_hz)
    # Peaks are narrower than any even grid: the natural frequencies are points of their own.
    hz = np.union1d(np.linspace(0.0, last, 1001), known[known <= last])
    found = np.abs(vibration.response(hz, damping))
    axes = _axes(axes)
    for k, name in enumerate("xyz"):
        axes.semilogy(hz, 1e6 * found[:, k, k], label=f"{name} by a force along {name}")
    axes.set_xlabel("frequency, Hz")
    axes.set_ylabel("receptance, um/N")
    axes.legend()
    return axes


def lobes(found: chatter.Lobes, axes: Any = None) -> Any:
    """Draws the limit of stability over the spindle speed, with the zeroth order approximation dashed.

    Parameters
    ----------
    found : Lobes
        From :func:`kinetostat.chatter.lobes`.
    axes : matplotlib.axes.Axes, optional
        New ones without it.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> from kinetostat import chatter
    >>> tip = chatter.tool_modes([[1, 0, 0]], stiffness=[1.34e6], frequencies_hz=[922], damping_ratios=[0.011])
    >>> found = chatter.lobes(tip, chatter.MillingCut(2, 1.0, False, (6e8, 2e8, 0.0)), [4000, 5000], up_to=2e-3)
    >>> lobes(found).get_ylabel()
    'depth of cut, mm'
    """
    from kinetostat.chatter import Lobes

    of_kind("found", found, Lobes, "Lobes of kinetostat.chatter.lobes")
    axes = _axes(axes)
    order = np.argsort(found.speeds_rpm)
    speeds = found.speeds_rpm[order]
    # Stable up to the largest depth that was looked at: the line runs along the upper edge.
    axes.plot(speeds, 1e3 * np.where(np.isnan(found.limit), found.up_to, found.limit)[order], label="limit")
    axes.plot(speeds, 1e3 * found.zeroth_order[order], "--", label="zeroth order (no bound)")
    axes.set_ylim(0, 1e3 * found.up_to)
    axes.set_xlabel("spindle speed, rpm")
    axes.set_ylabel("depth of cut, mm")
    axes.legend()
    return axes


def shares(found: Shares, axes: Any = None, *, most: int = 12) -> Any:
    """Draws how much each part gives of the deflection, the largest first.

    Parameters
    ----------
    found : Shares
        From :meth:`kinetostat.Machine.shares`.
    axes : matplotlib.axes.Axes, optional
        New ones without it.
    most : int
        Number of parts that are drawn; the others together are one bar.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import kinetostat as ks
    >>> shares(ks.Machine.preset("heavy_6r").shares("z")).get_xlabel()
    'share of the deflection, %'
    """
    from kinetostat.shares import Shares

    each = sorted(of_kind("found", found, Shares, "Shares").by_name().items(), key=lambda pair: -abs(pair[1]))
    count = whole_number("most", most, 1, 1000)
    bars = each[:count] + ([("others", sum(share for _, share in each[count:]))] if each[count:] else [])
    axes = _axes(axes)
    axes.barh([name for name, _ in bars][::-1], [100 * share for _, share in bars][::-1])
    axes.set_xlabel("share of the deflection, %")
    axes.set_title(found.direction)
    return axes


def tolerance(found: MachineSamples, column: str | None = None, axes: Any = None, *, place: int = 0) -> Any:
    """Draws the histogram of one result of the drawn machines at a place, with its nominal value and its 95 % interval.

    Parameters
    ----------
    found : MachineSamples
        From :func:`kinetostat.tolerance.machines`.
    column : str, optional
        Name of :attr:`~kinetostat.tolerance.MachineSamples.columns`; the first without it.
    axes : matplotlib.axes.Axes, optional
        New ones without it.
    place : int
        Number of the place.

    Returns
    -------
    matplotlib.axes.Axes

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import kinetostat as ks
    >>> spread = {"chain.leg.q2.length_mm": ks.tolerance.normal(0.01)}
    >>> found = ks.tolerance.machines(ks.Machine.preset("orthoglide"), spread, [[0, 0, 0]], quantities=["error"], draws=64)
    >>> tolerance(found).get_xlabel()
    'error_mm'
    """
    from kinetostat.tolerance import MachineSamples

    of_kind("found", found, MachineSamples, "MachineSamples of kinetostat.tolerance.machines")
    name = found.columns[0] if column is None else one_of("column", column, found.columns)
    at = whole_number("place", place, 0, found.samples.shape[1] - 1)
    values = found.column(name)[:, at]
    known = values[np.isfinite(values)]
    if not known.size:
        raise ArgumentError(f"no drawn machine has an answer at place {at}: take another place, or a narrower spread")
    axes = _axes(axes)
    axes.hist(known, bins="auto")
    axes.axvline(found.nominal[at, found.columns.index(name)], color="k", label="as drawn")
    for bound in np.percentile(known, [2.5, 97.5]):
        axes.axvline(bound, color="k", linestyle=":")
    axes.set_xlabel(name)
    axes.set_ylabel(f"machines of {known.size}")
    axes.legend()
    return axes
