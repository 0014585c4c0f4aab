"""Pictures of maps."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import of_kind, refused
from kinetostat._arguments import shown as in_words
from kinetostat._arguments import text as checked_text
from kinetostat._arrays import whole_number
from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine
from kinetostat.maps._variables import Variable, a_map, variables
from kinetostat.status import Status

if TYPE_CHECKING:
    import xarray

__all__ = ["best_and_worst", "plot"]

_MOST_LEVELS = 1000

_SCALES = {"N/m": (1e-6, "N/um"), "m": (1e3, "mm"), "N m/rad": (1e-3, "kN m/rad"), "rad": (180 / np.pi, "deg"), "m/N": (1e6, "um/N")}


def best_and_worst(found: xarray.Dataset, variable: str) -> tuple[dict[str, Any], dict[str, Any]]:
    """Where a variable is best and where it is worst, among places within the limits of all actuators.

    Parameters
    ----------
    found : xarray.Dataset
        A map.
    variable : str
        A variable with one number for each place.

    Returns
    -------
    best, worst : dict
        Coordinates by dimension, and ``value``.

    Raises
    ------
    ArgumentError
        No place has an answer, or the variable has neither best nor worst.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").map(x=np.linspace(-0.05, 0.05, 11))
    >>> best, worst = best_and_worst(found, "stiffness_softest")
    >>> float(best["x"])
    0.0
    """
    about = _single(found, variable)
    if about.worse == "neither":
        raise ArgumentError(f"{variable} is neither better nor worse")
    values = found[variable].values
    good = (found["status"].values == Status.SOLVED) & ~np.isnan(values)
    if not good.any():
        raise ArgumentError(f"no place has an answer for {variable} within the limits of all actuators")
    size = np.abs(values) if about.worse == "larger size" else values
    size = size if about.worse == "smaller" else -size
    ends = []
    for at in (np.argmax(np.where(good, size, -np.inf)), np.argmin(np.where(good, size, np.inf))):
        index = np.unravel_index(at, values.shape)
        place = {str(dim): found[dim].values[k] for dim, k in zip(found[variable].dims, index, strict=True)}
        ends.append({**place, "value": values[index]})
    return ends[0], ends[1]


def plot(
    found: xarray.Dataset, variable: str = "stiffness_softest", *, machine: Machine | None = None, levels: int = 10, ax: Any = None
) -> Any:
    """Draws a map along one or two dimensions, with isolines and with its best and worst places marked.

    Places outside the limits of an actuator are hatched; places without an answer stay empty.

    Parameters
    ----------
    found : xarray.Dataset
        A map with one or two dimensions; select the others first: ``found.sel(load="mill").isel(z=0)``.
    variable : str
        A variable with one number for each place.
    machine : Machine, optional
        Its limbs at home and its stated workspace are drawn, too.
    levels : int
        Number of isolines.
    ax : matplotlib Axes, optional
        Where to draw, with a legend of its own below; a new figure without it.

    Returns
    -------
    matplotlib Axes

    Raises
    ------
    ImportError
        matplotlib is not installed (``pip install 'kinetostat[plot]'``).

    Examples
    --------
    >>> import matplotlib
    >>> matplotlib.use("Agg")
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> x = np.linspace(-0.05, 0.05, 5)
    >>> axes = plot(ks.Machine.preset("orthoglide").map(x=x, y=x), "stiffness_softest")
    >>> axes.get_xlabel()
    'x, mm'
    """
    about = _single(found, variable)
    if machine is not None:
        of_kind("machine", machine, Machine, "a Machine, or None")
    levels = whole_number("levels", levels, 1, _MOST_LEVELS)
    if ax is not None and not hasattr(ax, "plot"):
        raise refused("ax", ax, "Axes of matplotlib, or None")
    dims = [str(dim) for dim in found[variable].dims]
    if len(dims) not in (1, 2) or not set(dims) <= set("xyz"):
        raise ArgumentError(f"{variable} has dimensions {dims}, expected one or two of x, y, z: select the others first")
    try:
        import matplotlib.pyplot as pyplot
    except ImportError as absent:
        raise ImportError("pictures need matplotlib: pip install 'kinetostat[plot]'") from absent
    own = ax is None
    ax = pyplot.subplots(layout="constrained")[1] if own else ax
    unit = str(found[variable].attrs.get("units", about.unit))
    scale, shown = _SCALES.get(unit, (1.0, unit))
    label = f"{variable}" + ("" if shown == "1" else f", {shown}")
    values = found[variable] * scale
    outside = found["status"].values != Status.SOLVED
    if len(dims) == 1:
        at = found[dims[0]].values * 1e3
        ax.plot(at, values.values, color="C0")
        ax.plot(np.where(outside, at, np.nan), values.values, color="0.6", linewidth=3, label="outside limits")
        ax.set(xlabel=f"{dims[0]}, mm", ylabel=label)
    else:
        _plane(ax, found, values.transpose(dims[1], dims[0]), outside.T, levels, label)
        if machine is not None:
            _outline(ax, machine, dims)
    _ends(ax, found, variable, dims, scale, shown)
    fixed = ", ".join(f"{name} = {float(found[name]) * 1e3:g} mm" for name in "xyz" if name not in dims and name in found.coords)
    _legend(ax, own)
    ax.set_title(f"{found.attrs.get('machine', '')}" + (f" ({fixed})" if fixed else ""))
    return ax


def _single(found: xarray.Dataset, name: str) -> Variable:
    a_map(found)
    about = variables().get(checked_text("variable", name, "the name of a variable of the map"))
    if about is None or name not in found:
        have = [str(other) for other in found.data_vars if other != "status"]
        raise ArgumentError(f"variable is {in_words(name)}, which the map does not have, expected one of {', '.join(have)}")
    if found[name].dims != found["status"].dims:
        # A column of a variable of several, selected by its user, has lost its dimension.
        raise ArgumentError(f"{name} has several numbers for each place: select one of {[str(dim) for dim in about.dims]}")
    return about


def _plane(ax: Any, found: xarray.Dataset, values: Any, outside: Any, levels: int, label: str) -> None:
    down, across = (str(dim) for dim in values.dims)
    x, y = found[across].values * 1e3, found[down].values * 1e3
    masked: Any = np.ma  # without types in older versions of numpy
    numbers = masked.masked_invalid(values.values)
    mesh = ax.pcolormesh(x, y, numbers, shading="nearest", cmap="viridis", rasterized=True)
    ax.figure.colorbar(mesh, ax=ax, label=label)
    if min(numbers.shape) > 1 and numbers.count() and numbers.max() > numbers.min():
        lines = ax.contour(x, y, numbers, levels=levels, colors="white", linewidths=0.7)
        ax.clabel(lines, fontsize="x-small", fmt="%.4g")
    if outside.any() and min(outside.shape) > 1:
        ax.contourf(x, y, outside.astype(float), levels=[0.5, 1.5], colors="none", hatches=["///"])
        ax.fill([], [], facecolor="none", edgecolor="black", hatch="///", label="outside limits")
    ax.set(xlabel=f"{across}, mm", ylabel=f"{down}, mm", aspect="equal")


def _ends(ax: Any, found: xarray.Dataset, variable: str, dims: list[str], scale: float, unit: str) -> None:
    try:
        ends = best_and_worst(found, variable)
    except ArgumentError:
        return
    for name, marker, end in zip(("best", "worst"), ("*", "X"), ends, strict=True):
        value = end["value"] * scale
        at = (end[dims[0]] * 1e3, end[dims[1]] * 1e3 if len(dims) == 2 else value)
        text = f"{name}: {value:.4g}" + ("" if unit == "1" else f" {unit}")
        ax.plot(
            *at,
            marker,
            markersize=12,
            markerfacecolor="white",
            markeredgecolor="black",
            linestyle="none",
            label=text,
            zorder=5,
            clip_on=False,
        )


def _legend(ax: Any, own: bool) -> None:
    """Below the picture: of the figure where that is all ours, else of the axes alone, for another map may be drawn beside it."""
    handles, labels = ax.get_legend_handles_labels()
    how: dict[str, Any] = {"fontsize": "small", "frameon": False, "handles": handles, "labels": labels}
    if own:
        ax.figure.legend(loc="outside lower center", ncols=3, **how)
    elif handles:
        ax.legend(loc="upper center", bbox_to_anchor=(0.5, -0.18), ncols=2, **how)


def _outline(ax: Any, machine: Machine, dims: list[str]) -> None:
    """The limbs at home, cut where the picture ends, and the stated workspace."""
    k = ["xyz".index(dim) for dim in dims]
    ax.set(xlim=ax.get_xlim(), ylim=ax.get_ylim())
    for index, line in enumerate(machine.posture().limb_lines()):
        label = "limbs at home" if index == 0 else None
        ax.plot(line[:, k[0]] * 1e3, line[:, k[1]] * 1e3, "o-", color="0.2", linewidth=2, markersize=4, alpha=0.6, label=label)
    if machine.workspace is not None:
        a, b = (corner[k] * 1e3 for corner in machine.workspace)
        ax.plot([a[0], b[0], b[0], a[0], a[0]], [a[1], a[1], b[1], b[1], a[1]], "k--", linewidth=1, label="stated workspace")
