"""``kinetostat assemble``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def assemble(
    model: _Path | Machine,
    *,
    deviation: str | float | Sequence[str | float] | None = None,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    along: Sequence[float] | None = None,
    points: int | None = None,
    plot: _Path | None = None,
    component: Literal["x", "y", "z", "size"] | None = None,
    all: bool = False,
    csv: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """What assembly with errors locks in: shifts, internal forces, springs.

    Counts over-constraint and names the directions in which the limbs fight; tells where the platforms
    and passive joints go by the deviations of the model, which wrenches stay in the limbs and how much
    every spring is bent: without load, to first order, and under a load.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    deviation : str | float | Sequence[str | float]
        One more deviation, as in "leg x:line:1deg about x", "leg y:bar:0.2mm longer" or "*:foot:1mm
        along z" (* is every limb); repeat for more
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
    force : Sequence[float]
        Force on the tool's tip, N, base axes
    moment : Sequence[float]
        Moment on the tool about its tip, N m, base axes
    along : Sequence[float]
        Along a straight line instead of at one place, mm, base axes
    points : int
        Points of the line [default: 41]
    plot : path
        Draw the displacement along the line: alone, together, and the sum of both alone (SVG)
    component : Literal["x", "y", "z", "size"]
        What is drawn
    all : bool
        Show every joint and spring, not only those that move most
    csv : path
        All numbers as a table (CSV)
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
    >>> found = ks.commands.assemble("orthoglide", deviation="leg x:foot arm:1deg about x")
    >>> found["over_constraint"]["degree"], found["most_strained_limb"]
    (3, 'leg x')
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--deviation", deviation),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--force", force),
        ("--moment", moment),
        ("--along", along),
        ("--points", points),
        ("--plot", plot),
        ("--component", component),
        ("--all", all),
        ("--csv", csv),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["assemble"], options, progress)
