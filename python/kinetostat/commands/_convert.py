"""``kinetostat convert``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import texted

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def convert(
    program: _Path | None = None,
    *,
    to: Literal["krl", "rapid", "ls", "apt", "gcode", "csv", "joints"] | None = None,
    out: _Path | None = None,
    template: _Path | None = None,
    job: _Path | None = None,
    tool_orientation: str | float | None = None,
    free_turn: str | float | None = None,
    stiff_turn: bool = False,
    turn_plot: _Path | None = None,
    tolerance_mm: float | None = None,
    model: str | float | None = None,
    joint_rows: Literal["joint", "linear"] | None = None,
    limit: str | float | Sequence[str | float] | None = None,
    force_overwrite: bool = False,
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
    rapid_from_mm_per_s: float | None = None,
    tool_axis: Literal["x", "y", "z", "-x", "-y", "-z"] | None = None,
    call: str | float | Sequence[str | float] | None = None,
    set: str | float | Sequence[str | float] | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    progress: _Progress | None = None,
) -> str:
    r"""A program of one language in another: G-code for a robot, KRL as RAPID.

    Lines stay lines, arcs stay arcs where the language has them, feeds stay; what stands beside the
    moves becomes notes with their lines, and what is lost is named. The new program is read again and
    compared with the path before it is written: the largest differences are said.

    Parameters
    ----------
    program : path
        Program: G-code, or of a robot; of a job where this is left out
    to : Literal["krl", "rapid", "ls", "apt", "gcode", "csv", "joints"]
        Language of the new program
    out : path
        The new program; the parts of a long one go beside it
    template : path
        Template of the cell (TOML): base, tool, orientation, speeds, zones, digits
    job : path
        Job file: what it says of reading the program
    tool_orientation : str | float
        Orientation of the tool in the part, of a program of positions, as in a_b_c_kuka_deg=0,0,180
    free_turn : str | float
        Arm (preset or model file) along whose way a round tool is turned about its axis: inside the
        limits of the joints, away from singular postures, in one configuration
    stiff_turn : bool
        Choose that turn so that the tip of the tool yields little to a force, too
    turn_plot : path
        Picture of that turn along the path (SVG)
    tolerance_mm : float
        How far lines may leave helices and other curves that the language has not, mm [default:
        0.001]
    model : str | float
        Arm (preset or model file) whose joint values are written, or stand in the program [default:
        that of the job]
    joint_rows : Literal["joint", "linear"]
        How the controller moves between the rows of a table of joint values: of one that is read,
        and of one that is written (linear: a row for each pose; joint: as many as the tolerance
        needs) [default: linear where it is written]
    limit : str | float | Sequence[str | float]
        Move a limit, as in speed_mm_per_s=9000 (repeat for more): shortest_tool_mm,
        longest_tool_mm, nearest_base_mm, speed_mm_per_s, zone_mm. A program that leaves a limit is
        refused
    force_overwrite : bool
        Overwrite the outputs if they exist (never an input)
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
    rapid_from_mm_per_s : float
        Linear motions of a robot's program at this speed or a higher one are rapids, mm/s
    tool_axis : Literal["x", "y", "z", "-x", "-y", "-z"]
        Axis of the tool of a robot's program from its tip to its holder, in axes of its frame
        [default: -z; of KRL -x]
    call : str | float | Sequence[str | float]
        What the program calls by this name, and none of its files holds, moves the tool: NAME=moves
        (repeat for more). Such a call is refused by line; others are taken not to move the tool and
        not to change speed, tool or frame
    set : str | float | Sequence[str | float]
        Value of a name that only the controller knows (a signal, an input, a register), as in di1=1
        (repeat for more)
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
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "groove.ngc")
    ...     _ = file.write_text('G21 G90 G54\nG0 X-20 Y0 Z10\nG1 Z-1 F600\nG1 X20\nG0 Z10\nM30\n')
    ...     said = ks.commands.convert(file, to="apt", out=Path(folder, "groove.apt"))
    ...     text = Path(folder, "groove.apt").read_text()
    >>> text.count("GOTO/")
    4
    """
    options: list[tuple[str, Any]] = [
        ("program", program),
        ("--to", to),
        ("--out", out),
        ("--template", template),
        ("--job", job),
        ("--tool-orientation", tool_orientation),
        ("--free-turn", free_turn),
        ("--stiff-turn", stiff_turn),
        ("--turn-plot", turn_plot),
        ("--tolerance-mm", tolerance_mm),
        ("--model", model),
        ("--joint-rows", joint_rows),
        ("--limit", limit),
        ("--force-overwrite", force_overwrite),
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
        ("--rapid-from-mm-per-s", rapid_from_mm_per_s),
        ("--tool-axis", tool_axis),
        ("--call", call),
        ("--set", set),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
    ]
    return texted(["convert"], options, progress)
