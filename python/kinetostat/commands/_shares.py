"""``kinetostat shares``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def shares(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    direction: Literal["x", "y", "z", "rx", "ry", "rz"] | None = None,
    along: Sequence[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    tool_length_mm: float | None = None,
    sensitivities: bool = False,
    reduce_percent: float | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Which link, drive, joint gives how much of the deflection in a direction.

    Divides the compliance of the tool in one direction exactly among all springs of the machine, and
    what loads add as they turn; all shares add to 100 %. Without a force it is that of the unloaded
    machine as drawn; under one, what a further small load meets.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    at : Sequence[float]
        Place of the tool's tip in base axes, mm; home without it
    rotation : str | float
        Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90, or the
        word follows: the one nearest to that at home which the machine can have there. Without it,
        the orientation at home; it follows where the machine cannot hold one
    joints : str | float | Sequence[str | float]
        The place by the model's joint values instead, deg and mm, as in shoulder=30 rail=250;
        joints that are not named stay at home
    controller : str | float | Sequence[str | float]
        The same by what the controller shows, as in J1=10 J2=31.324; the model declares it in its
        section controller
    pendant : str | float | Sequence[str | float]
        The name of `--controller` before; it is taken for one version more, with a warning
    direction : Literal["x", "y", "z", "rx", "ry", "rz"]
        Along which axis of the base the tool is pushed, or about which it is turned
    along : Sequence[float]
        Any other direction of the push, base axes
    force : Sequence[float]
        Force on the tool's tip, N: shares under it
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    sensitivities : bool
        Besides: what every number of the model file changes, the strongest first
    reduce_percent : float
        Besides: the cheapest stiffening that lowers the deflection by so many percent
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
    >>> found = ks.commands.shares("heavy_6r", direction="z")
    >>> round(sum(part["share"] for part in found["parts"]), 12)
    1.0
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--direction", direction),
        ("--along", along),
        ("--force", force),
        ("--moment", moment),
        ("--tool-length-mm", tool_length_mm),
        ("--sensitivities", sensitivities),
        ("--reduce-percent", reduce_percent),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["shares"], options, progress)
