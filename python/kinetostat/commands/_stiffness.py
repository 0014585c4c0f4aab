"""``kinetostat stiffness``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def stiffness(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    tool_length_mm: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """How stiff is the machine at one place.

    The 6 x 6 stiffness matrix of the tool with units, axes and reference point, its principal
    directions, and the share of each limb; under a load if a force is given.

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
    force : Sequence[float]
        Force on the tool's tip, N
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.stiffness("orthoglide", at=[10, 0, 0])
    >>> found["rank"], len(found["stiffness_n_m_rad"])
    (6, 6)
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--force", force),
        ("--moment", moment),
        ("--tool-length-mm", tool_length_mm),
    ]
    return answered(["stiffness"], options, progress)
