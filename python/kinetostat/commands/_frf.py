"""``kinetostat frf``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def frf(
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
    frequencies: Sequence[float] | None = None,
    to: Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] | None = None,
    from_: Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]] | None = None,
    quantity: Literal["receptance", "mobility", "accelerance"] | None = None,
    modes: int | None = None,
    hold: str | float | None = None,
    measured: _Path | None = None,
    fit: int | None = None,
    scale: str | float | Sequence[str | float] | None = None,
    scale_within: float | None = None,
    frequencies_known_to: float | None = None,
    damping_known_to: float | None = None,
    damping: float | Sequence[float] | None = None,
    rayleigh: Sequence[float] | None = None,
    loss_factor: float | None = None,
    viscous: str | float | Sequence[str | float] | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """How the tool's tip answers to a vibrating force, over the frequency.

    Entries of the 6 x 6 frequency response at the tool's tip about the equilibrium under weight,
    preloads and the load: receptance, mobility or accelerance. Modes that are left out count by their
    flexibility at rest, so that at 0 Hz the response is the loaded compliance.

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
    frequencies : Sequence[float]
        Lowest and highest frequency, Hz, and how many
    to : Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]]
        Motions of the tip that are looked at, as in x,y,rz [default: the same as --from]
    from_ : Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[Literal["x", "y", "z", "rx", "ry", "rz"]]
        Forces and moments on the tip, as in x,y,rz; without --to, each with the motion along itself
    quantity : Literal["receptance", "mobility", "accelerance"]
        Which motion by force
    modes : int
        Only the lowest modes vibrate; the others count by their flexibility at rest
    hold : str | float
        Directions in which the tool is held while it vibrates, as in rx,ry,rz
    measured : path
        Measured responses to draw beside it: universal file (data set 58) or CSV
    fit : int
        Modes that are found in the measured responses, within --frequencies, and compared with the
        model's
    scale : str | float | Sequence[str | float]
        Numbers of the model that are scaled until its frequencies are the measured ones, by their
        paths: "chain.arm.joint 2.stiffness_n_m_per_rad"; of the damping until its ratios are:
        damping.ratio, damping.ratios.1, damping.rayleigh.stiffness_s, damping.loss_factor,
        damping.viscous.JOINT
    scale_within : float
        They are scaled by at most this factor, up or down
    frequencies_known_to : float
        How well measured frequencies are known, as a share of themselves (one standard deviation)
    damping_known_to : float
        How well measured damping ratios are known, as a share of themselves (one standard
        deviation)
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
    >>> found = ks.commands.frf("heavy_6r", damping=[0.03], frequencies=[1, 50, 100])
    >>> [curve["unit"] for curve in found["curves"]], len(found["frequencies_hz"])
    (['m/N', 'm/N', 'm/N'], 100)
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
        ("--frequencies", frequencies),
        ("--to", to),
        ("--from", from_),
        ("--quantity", quantity),
        ("--modes", modes),
        ("--hold", hold),
        ("--measured", measured),
        ("--fit", fit),
        ("--scale", scale),
        ("--scale-within", scale_within),
        ("--frequencies-known-to", frequencies_known_to),
        ("--damping-known-to", damping_known_to),
        ("--damping", damping),
        ("--rayleigh", rayleigh),
        ("--loss-factor", loss_factor),
        ("--viscous", viscous),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["frf"], options, progress)
