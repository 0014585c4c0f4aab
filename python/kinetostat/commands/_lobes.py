"""``kinetostat lobes``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def lobes(
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
    rpm: Sequence[float] | None = None,
    depth_mm: float | None = None,
    coefficients_n_per_mm2: Sequence[float] | None = None,
    feed_per_tooth_mm: float | None = None,
    immersion: float | None = None,
    up: bool = False,
    climb: bool = False,
    feed_direction: Sequence[float] | None = None,
    teeth: int | None = None,
    helix_deg: float | None = None,
    diameter_mm: float | None = None,
    tool_axis: Sequence[float] | None = None,
    modes_up_to_hz: float | None = None,
    material: str | float | None = None,
    materials: _Path | None = None,
    rake_deg: float | None = None,
    wear: float | None = None,
    coolant: Literal["dry", "emulsion", "oil"] | None = None,
    edge: Literal["carbide", "high-speed-steel", "ceramic"] | None = None,
    correct_speed: bool = False,
    process_factor: float | None = None,
    damping: float | Sequence[float] | None = None,
    rayleigh: Sequence[float] | None = None,
    loss_factor: float | None = None,
    viscous: str | float | Sequence[str | float] | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """At which spindle speed and depth a milling cut chatters.

    Stability lobes of the machine in its loaded posture, exact (monodromy of the regenerative cut by
    collocation), flip and Hopf told apart, with islands. Limits of zeroth order stand beside them under
    their own name: on robots they may be several times too large. Straight edges or a helix of even
    pitch; linear force law, stated or of a material; no process damping.

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
    rpm : Sequence[float]
        Slowest and fastest spindle speed, rpm, and how many
    depth_mm : float
        Largest depth of cut that is looked at, mm
    coefficients_n_per_mm2 : Sequence[float]
        Force by area of chip: tangential, radial and axial, N/mm^2 (the radial one is no ratio; a
        positive axial one pushes the tool towards the spindle: below zero with a helix that lifts
        the chip)
    feed_per_tooth_mm : float
        Feed per tooth, mm: the law of --material is taken as a straight line at the mean thickness
        of its chips
    immersion : float
        Width of cut by diameter of the tool: 1 is a slot
    up : bool
        Up (conventional) milling; without it down (climb)
    climb : bool
        Down (climb) milling, as without it
    feed_direction : Sequence[float]
        Direction of the feed, base axes
    teeth : int
        Number of teeth
    helix_deg : float
        Helix angle, degrees; it needs --diameter-mm
    diameter_mm : float
        Diameter of the tool, mm
    tool_axis : Sequence[float]
        From the tip towards the spindle, base axes [default: against z of the tool's tip]
    modes_up_to_hz : float
        Modes above this count by their flexibility at rest, Hz [default: 1000, and as far as modes
        count]
    material : str | float
        What is cut, by any of its names; case, spaces and hyphens do not matter
    materials : path
        Materials of your own (TOML), found before those of the library
    rake_deg : float
        Rake angle of the tool, degrees (factor K_gamma); without it that of the table of tools
    wear : float
        Wear of the edge (factor K_TW): 1 sharp, 1.3 to 1.5 worn
    coolant : Literal["dry", "emulsion", "oil"]
        How the cut is cooled (factor K_CL)
    edge : Literal["carbide", "high-speed-steel", "ceramic"]
        What the edge is made of (factor K_CM)
    correct_speed : bool
        Correct for the cutting speed (factor K_V); it needs --rpm
    process_factor : float
        Milling with coefficients of turning tests (factor K_PRO): 1.2 to 1.4 [default: 1.3 for such
        coefficients]
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
    >>> cut = {"teeth": 2, "coefficients_n_per_mm2": [800, 240, 0], "rpm": [3000, 3600, 2]}
    >>> found = ks.commands.lobes("heavy_6r", damping=[0.03], immersion=0.5, up=True, **cut)
    >>> len(found["points"])
    2
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
        ("--rpm", rpm),
        ("--depth-mm", depth_mm),
        ("--coefficients-n-per-mm2", coefficients_n_per_mm2),
        ("--feed-per-tooth-mm", feed_per_tooth_mm),
        ("--immersion", immersion),
        ("--up", up),
        ("--climb", climb),
        ("--feed-direction", feed_direction),
        ("--teeth", teeth),
        ("--helix-deg", helix_deg),
        ("--diameter-mm", diameter_mm),
        ("--tool-axis", tool_axis),
        ("--modes-up-to-hz", modes_up_to_hz),
        ("--material", material),
        ("--materials", materials),
        ("--rake-deg", rake_deg),
        ("--wear", wear),
        ("--coolant", coolant),
        ("--edge", edge),
        ("--correct-speed", correct_speed),
        ("--process-factor", process_factor),
        ("--damping", damping),
        ("--rayleigh", rayleigh),
        ("--loss-factor", loss_factor),
        ("--viscous", viscous),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["lobes"], options, progress)
