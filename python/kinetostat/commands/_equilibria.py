"""``kinetostat equilibria``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def equilibria(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    displaced_mm: Sequence[float] | None = None,
    turned_deg: Sequence[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    hold: str | float | None = None,
    free: str | float | None = None,
    axes: str | float | None = None,
    constant_force: Sequence[float] | None = None,
    constant_moment: Sequence[float] | None = None,
    load: str | float | Sequence[str | float] | None = None,
    starts: int | None = None,
    fruitless: int | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """All shapes that a chain or a machine can take while its tool is held, or under a force.

    A chain may have several equilibria, stable and unstable, for one place of its tool, and so has a
    machine near a flat posture: this finds them, sorts them by energy, and says how complete the list
    is and how sure.

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
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    displaced_mm : Sequence[float]
        The tool is held this far from the commanded place, base axes, mm
    turned_deg : Sequence[float]
        and turned by this rotation vector, base axes, degrees
    force : Sequence[float]
        Force on the tool's tip, N, base axes; with it the tool is free unless --hold says otherwise
    moment : Sequence[float]
        Moment on the tool about its tip, N m, base axes
    hold : str | float
        Directions in which the tool is held, as in x,y,rz; the others are free. Also: all, none
    free : str | float
        Directions in which the tool is free, as in y,rz; the others are held. Also: rotations, and
        others (all but the one it is pushed along)
    axes : str | float
        Axes of these directions in the base, as in a_b_c_kuka_deg=30,0,0; without it, the base
    constant_force : Sequence[float]
        Force that acts on the tool's tip all the time, N, base axes
    constant_moment : Sequence[float]
        Moment that acts on the tool all the time, N m, base axes
    load : str | float | Sequence[str | float]
        Force on a named node of the chain all the time, N, base axes (repeat for more); of a
        machine of several limbs LIMB:NODE=FX,FY,FZ
    starts : int
        Evenly spread starts at most [default: 5000]
    fruitless : int
        The search ends after this many starts in a row that found nothing new [default: 400; 100
        for a machine of several limbs]
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
    >>> found = ks.commands.equilibria("three_link_z", displaced_mm=[-1, 0, 0])
    >>> [shape["stable"] for shape in found["equilibria"]]
    [True, False]
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--displaced-mm", displaced_mm),
        ("--turned-deg", turned_deg),
        ("--force", force),
        ("--moment", moment),
        ("--hold", hold),
        ("--free", free),
        ("--axes", axes),
        ("--constant-force", constant_force),
        ("--constant-moment", constant_moment),
        ("--load", load),
        ("--starts", starts),
        ("--fruitless", fruitless),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["equilibria"], options, progress)
