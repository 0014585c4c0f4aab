"""``kinetostat force``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any, Literal

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def force(
    *,
    list_materials: bool = False,
    material: str | float | None = None,
    materials: _Path | None = None,
    rake_deg: float | None = None,
    wear: float | None = None,
    coolant: Literal["dry", "emulsion", "oil"] | None = None,
    edge: Literal["carbide", "high-speed-steel", "ceramic"] | None = None,
    correct_speed: bool = False,
    process_factor: float | None = None,
    tool: Literal["flat", "ball", "bull", "face"] | None = None,
    diameter_mm: float | None = None,
    teeth: int | None = None,
    helix_deg: float | None = None,
    corner_radius_mm: float | None = None,
    lead_angle_deg: float | None = None,
    run_out_um: float | None = None,
    run_out_angle_deg: float | None = None,
    max_chip_mm: float | None = None,
    flute_length_mm: float | None = None,
    stick_out_mm: float | None = None,
    tool_table: _Path | None = None,
    tool_number: int | None = None,
    width_mm: float | None = None,
    depth_mm: float | None = None,
    part: Literal["left", "right"] | None = None,
    climb: bool = False,
    conventional: bool = False,
    feed_per_tooth_mm: float | None = None,
    feed_mm_per_min: float | None = None,
    rpm: float | None = None,
    counter_clockwise: bool = False,
    down_feed_per_tooth_mm: float | None = None,
    spindle_power_w: float | None = None,
    spindle_base_rpm: float | None = None,
    spindle_most_rpm: float | None = None,
    drill: bool = False,
    turning: bool = False,
    feed_per_turn_mm: float | None = None,
    lips: int | None = None,
    point_angle_deg: float | None = None,
    hole_mm: float | None = None,
    chisel_factor: float | None = None,
    approach_angle_deg: float | None = None,
    speed_m_per_min: float | None = None,
    fit: _Path | None = None,
    acts_on: Literal["tool", "part"] | None = None,
    group: Literal["aluminium", "magnesium", "copper", "steel", "stainless", "cast-iron", "titanium", "nickel", "plastic", "wood", "other"] | None = None,
    spread_percent: float | None = None,
    out_material: _Path | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Force of one cut: from material, tool, width, depth and feed.

    The force on a milling tool over the revolution: its mean, which bends the machine; its peak; and
    the force at the moment at which the wall is made, which prints into it. With torque, power,
    harmonics and how far to trust all of it. It needs no machine and no program. With --fit it goes the
    other way: from mean forces of a dynamometer to the coefficients of a material.

    Parameters
    ----------
    list_materials : bool
        Table of the known materials: law, spread and source; with --json all that is known of them
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
    tool : Literal["flat", "ball", "bull", "face"]
        Shape of the tool
    diameter_mm : float
        Its diameter, mm; of a face mill that at the tip
    teeth : int
        Number of teeth
    helix_deg : float
        Helix angle, degrees [default: 0]; positive lifts the chip
    corner_radius_mm : float
        Radius of the corner of a bull-nosed tool, mm
    lead_angle_deg : float
        Angle between the edge of a face mill and the plane of the feed, degrees: 90 is a cylinder
    run_out_um : float
        Run-out: how far the axis of the teeth lies beside that of the rotation, um
    run_out_angle_deg : float
        Where the run-out points, seen from tooth 0, degrees [default: 0]
    max_chip_mm : float
        Feed per tooth that the maker of the tool allows, mm
    flute_length_mm : float
        Length of its edges, mm
    stick_out_mm : float
        Length outside the holder, mm
    tool_table : path
        Table of tools (TOML)
    tool_number : int
        Number of the tool in the table; without it, a program calls its tools (T)
    width_mm : float
        Width of the cut (ae), across the feed, mm; the diameter is a slot
    depth_mm : float
        Depth of the cut (ap), along the tool, mm
    part : Literal["left", "right"]
        On which side of the tool the part is, seen along the feed
    climb : bool
        Climb (down) milling: the part is on the right, with a spindle that turns clockwise
    conventional : bool
        Conventional (up) milling: the part is on the left, with a spindle that turns clockwise
    feed_per_tooth_mm : float
        Feed per tooth, mm
    feed_mm_per_min : float
        Feed, mm/min; it needs --rpm
    rpm : float
        Speed of the spindle, turns per minute; power, cutting speed and frequencies need it
    counter_clockwise : bool
        The spindle turns counter-clockwise (M4), seen from it down to the tool
    down_feed_per_tooth_mm : float
        Feed down the tool axis per tooth, mm (a ramp in a slot); negative where the tool rises
    spindle_power_w : float
        Rated power of the spindle, W
    spindle_base_rpm : float
        Its base speed: constant torque up to it, constant power above, turns per minute
    spindle_most_rpm : float
        Its largest speed, turns per minute
    drill : bool
        A drill instead of a milling tool: --diameter-mm, --feed-per-turn-mm, perhaps --rpm
    turning : bool
        A turning tool: --depth-mm, --feed-per-turn-mm, perhaps --speed-m-per-min
    feed_per_turn_mm : float
        Feed per turn, mm
    lips : int
        Lips of the drill [default: 2]
    point_angle_deg : float
        Angle between the lips, degrees [default: 118]
    hole_mm : float
        Diameter of the hole that is there already, mm [default: none]
    chisel_factor : float
        Thrust of lips and chisel together over that of the lips [default: 1, no chisel]
    approach_angle_deg : float
        Angle between the edge and the feed of the turning tool, degrees [default: 90]
    speed_m_per_min : float
        Cutting speed of turning, m/min: power and --correct-speed need it
    fit : path
        Mean forces of a dynamometer at several feeds (CSV: feed_mm_per_tooth,fx_n,fy_n,fz_n): the
        coefficients that fit them best, with --material as the name of what was cut
    acts_on : Literal["tool", "part"]
        What the forces of the file act on: the tool, or the part (a dynamometer under it shows the
        force on the part, which is turned) [default: tool]
    group : Literal["aluminium", "magnesium", "copper", "steel", "stainless", "cast-iron", "titanium", "nickel", "plastic", "wood", "other"]
        Family of the material [default: other]
    spread_percent : float
        How far the force of another batch or tool may lie from this one, % [default: the interval
        of the fit, which knows this batch alone]
    out_material : path
        The material as a file (TOML) for --materials and for jobs; without it, it is printed
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
    >>> found = ks.commands.force(
    ...     material="soft aluminium", tool="flat", diameter_mm=10, teeth=2, helix_deg=30, width_mm=5, depth_mm=1, climb=True,
    ...     rpm=6000, feed_per_tooth_mm=0.05,
    ... )
    >>> len(found["mean"]["force_n"]), found["cut"]["milling"]
    (3, 'climb')
    """
    options: list[tuple[str, Any]] = [
        ("--list-materials", list_materials),
        ("--material", material),
        ("--materials", materials),
        ("--rake-deg", rake_deg),
        ("--wear", wear),
        ("--coolant", coolant),
        ("--edge", edge),
        ("--correct-speed", correct_speed),
        ("--process-factor", process_factor),
        ("--tool", tool),
        ("--diameter-mm", diameter_mm),
        ("--teeth", teeth),
        ("--helix-deg", helix_deg),
        ("--corner-radius-mm", corner_radius_mm),
        ("--lead-angle-deg", lead_angle_deg),
        ("--run-out-um", run_out_um),
        ("--run-out-angle-deg", run_out_angle_deg),
        ("--max-chip-mm", max_chip_mm),
        ("--flute-length-mm", flute_length_mm),
        ("--stick-out-mm", stick_out_mm),
        ("--tool-table", tool_table),
        ("--tool-number", tool_number),
        ("--width-mm", width_mm),
        ("--depth-mm", depth_mm),
        ("--part", part),
        ("--climb", climb),
        ("--conventional", conventional),
        ("--feed-per-tooth-mm", feed_per_tooth_mm),
        ("--feed-mm-per-min", feed_mm_per_min),
        ("--rpm", rpm),
        ("--counter-clockwise", counter_clockwise),
        ("--down-feed-per-tooth-mm", down_feed_per_tooth_mm),
        ("--spindle-power-w", spindle_power_w),
        ("--spindle-base-rpm", spindle_base_rpm),
        ("--spindle-most-rpm", spindle_most_rpm),
        ("--drill", drill),
        ("--turning", turning),
        ("--feed-per-turn-mm", feed_per_turn_mm),
        ("--lips", lips),
        ("--point-angle-deg", point_angle_deg),
        ("--hole-mm", hole_mm),
        ("--chisel-factor", chisel_factor),
        ("--approach-angle-deg", approach_angle_deg),
        ("--speed-m-per-min", speed_m_per_min),
        ("--fit", fit),
        ("--acts-on", acts_on),
        ("--group", group),
        ("--spread-percent", spread_percent),
        ("--out-material", out_material),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["force"], options, progress)
