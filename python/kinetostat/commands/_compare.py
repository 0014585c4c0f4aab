"""``kinetostat compare``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def compare(
    a: _Path | Machine,
    b: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    x: Sequence[float] | None = None,
    y: Sequence[float] | None = None,
    z: Sequence[float] | None = None,
    tool_length_mm: float | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Which of two designs is stiffer where, and by which parts.

    Puts both at the same places: stiffness along the axes and the shares of their parts beside each
    other, and over a grid the difference at every place that both reach. (`model compare` tells whether
    two files describe one machine.)

    Parameters
    ----------
    a : path | Machine
        Preset or model file
    b : path | Machine
        Preset or model file
    at : Sequence[float]
        Position of the tool, base axes, mm; may be repeated. Without it, each at its home
    x : Sequence[float]
        Grid along x of the base, mm: from, to, and how many places
    y : Sequence[float]
        The same along y
    z : Sequence[float]
        The same along z
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm, of both
    csv : path
        All points as a table (CSV)
    plot : path
        The drawing (SVG)
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.compare("stewart_gough_a", "stewart_gough_b")
    >>> place = found["places"][0]
    >>> place["b"]["smallest_stiffness_n_per_mm"] > place["a"]["smallest_stiffness_n_per_mm"]
    True
    """
    options: list[tuple[str, Any]] = [
        ("a", a),
        ("b", b),
        ("--at", at),
        ("--x", x),
        ("--y", y),
        ("--z", z),
        ("--tool-length-mm", tool_length_mm),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["compare"], options, progress)
