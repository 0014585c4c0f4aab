"""``kinetostat modes``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def modes(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    tool_mass_kg: float | None = None,
    tool_centre_of_mass_mm: Sequence[float] | None = None,
    tool_inertia_kg_m2: Sequence[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    hold: str | float | None = None,
    modes: int | None = None,
    damping: float | Sequence[float] | None = None,
    rayleigh: Sequence[float] | None = None,
    loss_factor: float | None = None,
    viscous: str | float | Sequence[str | float] | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """At which frequencies a machine vibrates at a place, and what moves.

    Modes about the equilibrium under weight, preloads and the load: signed frequencies (negative:
    unstable), motion of the tool, shares of kinetic energy by body and of elastic energy by joint and
    link, and how many directions vibrate, are free, unstable, massless, neutral or rigid.

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
    tool_mass_kg : float
        Mass that the flange carries beside that of the model, kg: spindle and tool, as `mass_kg` of
        a job's tool
    tool_centre_of_mass_mm : Sequence[float]
        Its centre in the frame of the flange, mm; halfway to the tip without it
    tool_inertia_kg_m2 : Sequence[float]
        Its inertia about that centre in axes of the flange, kg m^2; a point without it. Products
        carry their minus sign
    force : Sequence[float]
        Constant force on the tool's tip, N, about whose equilibrium the machine vibrates
    moment : Sequence[float]
        Constant moment on the tool about its tip, N m
    hold : str | float
        Directions in which the tool is held while it vibrates, as in x,y,rz; also: all
    modes : int
        How many modes are shown, the lowest first; unstable and free ones come before
    damping : float | Sequence[float]
        Ratio to critical damping of all modes (0.03 is 3 %), or one for each of the lowest modes,
        the last for all above
    rayleigh : Sequence[float]
        C = A M + B K: A in 1/s, B in s
    loss_factor : float
        Loss factor of all springs, structural damping
    viscous : str | float | Sequence[str | float]
        Dampers at joints and springs by name, N s/m or N m s/rad, as in "joint 1"=900
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
    >>> found = ks.commands.modes("heavy_6r", damping=[0.03])
    >>> found["stable"], found["modes"][0]["damping_ratio"]
    (True, 0.03)
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--tool-mass-kg", tool_mass_kg),
        ("--tool-centre-of-mass-mm", tool_centre_of_mass_mm),
        ("--tool-inertia-kg-m2", tool_inertia_kg_m2),
        ("--force", force),
        ("--moment", moment),
        ("--hold", hold),
        ("--modes", modes),
        ("--damping", damping),
        ("--rayleigh", rayleigh),
        ("--loss-factor", loss_factor),
        ("--viscous", viscous),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["modes"], options, progress)
