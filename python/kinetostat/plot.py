"""Pictures with matplotlib, which is imported when one is drawn."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import of_kind, refused

if TYPE_CHECKING:
    from kinetostat.curves import ForceCurve

__all__ = ["force_curve"]


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
    import matplotlib.pyplot as plt

    from kinetostat.curves import ForceCurve

    of_kind("curve", curve, ForceCurve, "a ForceCurve")
    if axes is not None and not hasattr(axes, "plot"):
        raise refused("axes", axes, "Axes of matplotlib, or None")
    if axes is None:
        axes = plt.subplots()[1]
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
