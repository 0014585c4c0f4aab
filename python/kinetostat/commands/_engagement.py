"""``kinetostat engagement``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def engagement(
    subject: _Path | None = None,
    *,
    job: _Path | None = None,
    program: _Path | None = None,
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
    block_mm: Sequence[float] | None = None,
    cell_mm: float | None = None,
    memory_mb: float | None = None,
    width_mm: float | None = None,
    depth_mm: float | None = None,
    part: Literal["left", "right"] | None = None,
    rpm: float | None = None,
    rotation: Literal["clockwise", "counter-clockwise"] | None = None,
    spindle_power_w: float | None = None,
    spindle_base_rpm: float | None = None,
    spindle_most_rpm: float | None = None,
    units: Literal["mm", "inch"] | None = None,
    arc_tolerance: float | None = None,
    work_offset: str | float | Sequence[str | float] | None = None,
    block_delete: Literal["run", "skip"] | None = None,
    axes_stand_still: bool = False,
    tool_centre_point: bool = False,
    start_position_mm: Sequence[float] | None = None,
    machine_zero_mm: Sequence[float] | None = None,
    g28_mm: Sequence[float] | None = None,
    g30_mm: Sequence[float] | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""What a program cuts: engagement, force, torque and power along it.

    Takes a G-code program with tool, material and stock from options, or the job file of `compensate`;
    options go over the job file. The tools go through the stock as the program says; at every place the
    force follows from what they meet. No machine is needed: model, placement and tool lengths of a job
    play no part.

    Parameters
    ----------
    subject : path
        G-code program, or a job file
    job : path
        Job file (TOML), for everything that no option says
    program : path
        G-code program, in place of the job's
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
    block_mm : Sequence[float]
        Block before the cut: two opposite corners in the coordinates of the program, mm
    cell_mm : float
        Size of its cells, mm [default: a twentieth of the smallest tool's diameter]
    memory_mb : float
        Memory that it may take, MB [default: 500]
    width_mm : float
        In place of a block: width of the cut on all feed moves, mm; the diameter is a slot
    depth_mm : float
        Its depth, mm
    part : Literal["left", "right"]
        On which side of the tool the part is then, seen along the feed
    rpm : float
        Speed in place of the program's S, turns per minute
    rotation : Literal["clockwise", "counter-clockwise"]
        Sense in place of the program's M3 and M4, seen from the spindle
    spindle_power_w : float
        Rated power of the spindle, W
    spindle_base_rpm : float
        Its base speed: constant torque up to it, constant power above, turns per minute
    spindle_most_rpm : float
        Its largest speed, turns per minute
    units : Literal["mm", "inch"]
        Units of a program that does not say G20 or G21
    arc_tolerance : float
        Largest difference of an arc's radii at start and end, mm [default: 0.005]
    work_offset : str | float | Sequence[str | float]
        Origin of a work coordinate system in the part, mm: G54=x,y,z (repeat for more)
    block_delete : Literal["run", "skip"]
        Blocks marked with `/`: run them (the default), or skip them
    axes_stand_still : bool
        Rotary and second axes (A B C U V W) stand still: take a program with their words
    tool_centre_point : bool
        X, Y and Z are places of the tool's tip in the part all along, however rotary axes stand
        (G43.4 says so in the program)
    start_position_mm : Sequence[float]
        Where the tool stands before the first block, mm
    machine_zero_mm : Sequence[float]
        Where the tool's point is in the part when the machine stands at its zero and no tool length
        is in force, mm: where G53, G28 and G30 count from
    g28_mm : Sequence[float]
        Reference point of G28 in machine coordinates, mm (with --machine-zero-mm)
    g30_mm : Sequence[float]
        Reference point of G30 in machine coordinates, mm (with --machine-zero-mm)
    expand : bool
        Run the program once and go on with its flat form: subprograms, variables, cycles, G41 and
        G42 as plain blocks (`kinetostat expand` shows them)
    subprograms : path | Sequence[path]
        Folder of subprograms beside that of the program (repeat for more)
    tool_diameter_mm : str | float | Sequence[str | float]
        Diameter of a tool for G41 and G42, mm, as in 3=6.5 (repeat for more)
    parameter : str | float | Sequence[str | float]
        Value of a numbered parameter before the program, as in 100=2.5 (repeat for more)
    dialect : Literal["linuxcnc", "fanuc"]
        Controller that the program is written for; what controllers read differently is refused
        without it
    no_comments : bool
        Leave out the comments that say the line of each flat block
    flat_program : path
        File for the flat program, whose lines the messages name; of a conversion (--to) the
        converted one
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
    >>> import tempfile
    >>> from pathlib import Path
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "groove.ngc")
    ...     _ = file.write_text('G21 G90 G54\nG0 X-20 Y0 Z10\nG1 Z-1 F600\nG1 X20\nG0 Z10\nM30\n')
    ...     found = ks.commands.engagement(
    ...         program=file, material="soft aluminium", tool="flat", diameter_mm=10, teeth=2, rpm=6000,
    ...         width_mm=5, depth_mm=1, part="left", rotation="clockwise",
    ...     )
    >>> found["cutting"]["largest_force"]["depth_mm"], found["warnings"]
    (1.0, [])
    """
    options: list[tuple[str, Any]] = [
        ("subject", subject),
        ("--job", job),
        ("--program", program),
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
        ("--block-mm", block_mm),
        ("--cell-mm", cell_mm),
        ("--memory-mb", memory_mb),
        ("--width-mm", width_mm),
        ("--depth-mm", depth_mm),
        ("--part", part),
        ("--rpm", rpm),
        ("--rotation", rotation),
        ("--spindle-power-w", spindle_power_w),
        ("--spindle-base-rpm", spindle_base_rpm),
        ("--spindle-most-rpm", spindle_most_rpm),
        ("--units", units),
        ("--arc-tolerance", arc_tolerance),
        ("--work-offset", work_offset),
        ("--block-delete", block_delete),
        ("--axes-stand-still", axes_stand_still),
        ("--tool-centre-point", tool_centre_point),
        ("--start-position-mm", start_position_mm),
        ("--machine-zero-mm", machine_zero_mm),
        ("--g28-mm", g28_mm),
        ("--g30-mm", g30_mm),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["engagement"], options, progress)
