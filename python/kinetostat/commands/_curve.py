"""``kinetostat curve``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def curve(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    direction: Sequence[float] | None = None,
    displacement_mm: Sequence[float] | None = None,
    about: Sequence[float] | None = None,
    turn_deg: Sequence[float] | None = None,
    force_limits: Sequence[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    grow: str | float | Sequence[str | float] | None = None,
    factor: Sequence[float] | None = None,
    hold: str | float | None = None,
    free: str | float | None = None,
    axes: str | float | None = None,
    constant_force: Sequence[float] | None = None,
    constant_moment: Sequence[float] | None = None,
    load: str | float | Sequence[str | float] | None = None,
    branches: int | None = None,
    points: int | None = None,
    all: bool = False,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Force against displacement: stiffness, limit points, buckling, jumps.

    Pushes the tool along a direction and tells which force it takes, or grows a load and tells where
    the tool goes: around limit points, with the places where the machine snaps and where it lands. It
    follows every branch that crosses, too.

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
    direction : Sequence[float]
        Push the tool along this direction of the base
    displacement_mm : Sequence[float]
        from this to that displacement, counted from the commanded place, mm
    about : Sequence[float]
        Turn the tool about this direction of the base
    turn_deg : Sequence[float]
        from this to that angle, counted from the commanded place, degrees
    force_limits : Sequence[float]
        The curve ends where the force along the direction (N, or N m) leaves these limits
    force : Sequence[float]
        Load that grows: force on the tool's tip, N, base axes
    moment : Sequence[float]
        Load that grows: moment on the tool about its tip, N m, base axes
    grow : str | float | Sequence[str | float]
        Load that grows: force on a named node of the chain, N, base axes (repeat for more); not of
        a machine of several limbs
    factor : Sequence[float]
        from this to that many times the load
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
    branches : int
        Branches followed at most, from the start and from each shape that --all finds [default: 12]
    points : int
        Points of one branch at most, each way [default: 600]
    all : bool
        Search for shapes that no branch connects with the start, and follow them too
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
    >>> found = ks.commands.curve("three_link_z", direction=[1, 0, 0], displacement_mm=[0, -200])
    >>> [point["kind"] for point in found["named_points"]]
    ['start', 'pitchfork', 'end', 'end', 'end']
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--direction", direction),
        ("--displacement-mm", displacement_mm),
        ("--about", about),
        ("--turn-deg", turn_deg),
        ("--force-limits", force_limits),
        ("--force", force),
        ("--moment", moment),
        ("--grow", grow),
        ("--factor", factor),
        ("--hold", hold),
        ("--free", free),
        ("--axes", axes),
        ("--constant-force", constant_force),
        ("--constant-moment", constant_moment),
        ("--load", load),
        ("--branches", branches),
        ("--points", points),
        ("--all", all),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["curve"], options, progress)
