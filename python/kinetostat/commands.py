"""Every command of the command line as a function; made by python/tools/make_commands.py from the command line's own table.

A function takes the options of its command by their names and gives what the command prints with ``--json``, as a dictionary (units are
part of its names, see STABILITY.md); commands without such an answer give their text. Where the command line takes the name of a
model, a :class:`kinetostat.Machine` does too. Wrong input raises ``ArgumentError``, a question without an answer ``UnansweredError``; a
program that misses its tolerance is written, and warned of with ``ToleranceMissedWarning``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import Completed, answered, listed, run, texted

if TYPE_CHECKING:
    from kinetostat.machine import Machine

__all__ = [
    "Completed",
    "assemble",
    "check",
    "compare",
    "compensate",
    "convert",
    "curve",
    "deflect",
    "demo",
    "dialect_list",
    "dialect_show",
    "engagement",
    "equilibria",
    "expand",
    "force",
    "import_link_displacements",
    "import_matrix",
    "import_urdf",
    "map",
    "mirror",
    "model_compare",
    "model_draw",
    "model_list",
    "model_schema",
    "model_show",
    "reproduce",
    "run",
    "shares",
    "stiffness",
    "tolerance",
    "verify",
]

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def demo(
    *,
    out: _Path | None = None,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Mill a circular groove on a bending machine: the first look.

    Writes the program, the compensated program, the report, the result and the points, and the model
    and job files that repeat the run.

    Parameters
    ----------
    out : path
        Directory for the files; it is made if it does not exist
    force_overwrite : bool
        Overwrite files of the same names in it
    threads : int
        Number of threads; all cores without it
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import os, tempfile
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = ks.commands.demo(out=folder)
    ...     files = os.listdir(folder)
    >>> found["tolerance"]["held"], "report.html" in files
    (True, True)
    """
    options: list[tuple[str, Any]] = [
        ("--out", out),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["demo"], options, progress)

def compensate(
    job: _Path | None = None,
    *,
    model: str | float | None = None,
    program: _Path | None = None,
    tool_length_mm: float | None = None,
    part_origin_mm: Sequence[float] | None = None,
    part_orientation: str | float | None = None,
    tool_orientation: str | float | None = None,
    scale: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    load_axes: Literal["base", "tool", "feed"] | None = None,
    milling: Sequence[float] | None = None,
    load_at_corners: Literal["turns", "follows-feed"] | None = None,
    below_z_mm: float | None = None,
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
    correct: Literal["position", "pose"] | None = None,
    rapid_from_mm_per_s: float | None = None,
    tool_axis: Literal["x", "y", "z", "-x", "-y", "-z"] | None = None,
    joint_rows: Literal["joint", "linear"] | None = None,
    free_turn: bool = False,
    stiff_turn: bool = False,
    turn_plot: _Path | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    chord_tolerance_um: float | None = None,
    uncertain: _Path | None = None,
    machines: int | None = None,
    limit: str | float | Sequence[str | float] | None = None,
    report: _Path | None = None,
    points: _Path | None = None,
    all_points: bool = False,
    force_overwrite: bool = False,
    threads: int | None = None,
    out: _Path | None = None,
    to: Literal["krl", "rapid", "ls"] | None = None,
    template: _Path | None = None,
    map: _Path | None = None,
    no_compensation: bool = False,
    again: bool = False,
    no_header: bool = False,
    tolerance_um: float | None = None,
    arcs: Literal["fit", "lines"] | None = None,
    min_block_mm: float | None = None,
    decimals: str | float | None = None,
    max_feed_factor: float | None = None,
    backward_step_um: float | None = None,
    max_blocks_per_second: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""Write a program that cuts where it should.

    Reads model, program, placement and load from a job file, from options, or from both (options go
    over the job file), solves the machine along the program, writes the compensated program, reads it
    again from its bytes and solves it once more: the error after compensation is measured, not
    promised. Nothing is overwritten without --force-overwrite, an input never.

    Parameters
    ----------
    job : path
        Job file (TOML): model, program, placement, load, tolerances, outputs
    model : str | float
        Preset or model file
    program : path
        Program: G-code, or of a robot (`kinetostat dialect list`)
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    part_origin_mm : Sequence[float]
        Where the program's zero point lies in the machine's base, mm
    part_orientation : str | float
        Orientation of the program's axes in the base, as in a_b_c_kuka_deg=90,0,0
    tool_orientation : str | float
        Orientation of the tool in the base, or the word follows: everywhere the one nearest to that
        at home which the machine can have. Without it, the one at home; it follows where the
        machine cannot hold one
    scale : float
        Length in the machine per length in the program [default: 1]
    force : Sequence[float]
        Force on the tool's tip, N: everywhere on feed moves (with --at: at that place)
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    load_axes : Literal["base", "tool", "feed"]
        Axes of force and moment [default: base]
    milling : Sequence[float]
        Milling force instead, N: to the right of the feed, along it, along the part's z
    load_at_corners : Literal["turns", "follows-feed"]
        Load on the steps that are written at sharp corners: it turns evenly while the tool steps,
        or it follows the feed; the program is the same, the claim about it is not [default: turns]
    below_z_mm : float
        The load acts only below this height of the program, mm
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
    correct : Literal["position", "pose"]
        What of the tool's pose is corrected, in programs that state its orientation (of robots, and
        of machines with rotary axes) [default: position]
    rapid_from_mm_per_s : float
        Linear motions at this speed or a higher one position the tool in air, mm/s: no load acts
        there
    tool_axis : Literal["x", "y", "z", "-x", "-y", "-z"]
        Axis of the tool from its tip to its holder, in axes of its frame [default: -z]
    joint_rows : Literal["joint", "linear"]
        How the controller moves between the rows of a table of joint values
    free_turn : bool
        Turn a round tool about its axis along the path of an arm: inside the limits of the joints,
        away from singular postures, in one configuration
    stiff_turn : bool
        Choose that turn so that the tip of the tool yields little to a force, too
    turn_plot : path
        Picture of that turn along the path (SVG)
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
    chord_tolerance_um : float
        How far the chords of arcs may leave them, micrometres [default: 0.4, in a compensated
        program at most 0.8 of the path's default tolerance]
    uncertain : path
        What is uncertain about machine and load (TOML; see `kinetostat tolerance --help`): the
        errors before and after compensation come as a band over many machines
    machines : int
        Number of machines drawn for the band, rounded up to a multiple of 16 [default: 1024]
    limit : str | float | Sequence[str | float]
        Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
        tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second,
        shortest_tool_mm, longest_tool_mm. A program that leaves a limit is refused
    report : path
        The report, one HTML file
    points : path
        Points of the path as a table (CSV); of long programs the worst of every stretch
    all_points : bool
        Every point in the table, however large it becomes
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
    out : path
        The compensated program; without it, PROGRAM-compensated beside the job or the program
    to : Literal["krl", "rapid", "ls"]
        Convert the program for a robot first, and compensate that (other languages: `kinetostat
        convert`)
    template : path
        Template of the cell for that (`kinetostat help convert`): numbers, speeds, zones, and tool
        and part where the job has none
    map : path
        Corrections from a table instead of a model: CSV with the columns
        x_mm,y_mm,z_mm,dx_mm,dy_mm,dz_mm on a full grid
    no_compensation : bool
        Write the program of a machine as it was read, byte for byte; with --expand its flat form
    again : bool
        Compensate a program that is marked as compensated once more
    no_header : bool
        Leave out the header that marks the program as compensated
    tolerance_um : float
        How far the straight pieces may leave the corrected path, micrometres [default: a third of
        the repeatability that the model states, 20 for an arm that states none, else 0.5]
    arcs : Literal["fit", "lines"]
        What becomes of arcs where they are corrected: arcs again, or straight pieces [default: fit]
    min_block_mm : float
        Shortest block that the controller takes, mm: shorter pieces are shared out anew, and lines
        that need them are named
    decimals : str | float
        Digits after the point in mm, one more in inches [default: 4]
    max_feed_factor : float
        How many times the programmed feed may be written at most, to keep the speed along the part
        where the tool's own path is longer [default: 1.2]
    backward_step_um : float
        Warn of steps that cut backwards by more than this, micrometres [default: 50]
    max_blocks_per_second : float
        Blocks that the controller reads in a second: as --min-block-mm, and a warning if the
        written program asks for more
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
    ...     found = ks.commands.compensate(
    ...         model="orthoglide", program=file, force=[100, -20, -30], out=Path(folder, "corrected.ngc")
    ...     )
    >>> found["tolerance"]["held"], found["summary"]["blocks"]
    (True, 6)
    """
    options: list[tuple[str, Any]] = [
        ("job", job),
        ("--model", model),
        ("--program", program),
        ("--tool-length-mm", tool_length_mm),
        ("--part-origin-mm", part_origin_mm),
        ("--part-orientation", part_orientation),
        ("--tool-orientation", tool_orientation),
        ("--scale", scale),
        ("--force", force),
        ("--moment", moment),
        ("--load-axes", load_axes),
        ("--milling", milling),
        ("--load-at-corners", load_at_corners),
        ("--below-z-mm", below_z_mm),
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
        ("--correct", correct),
        ("--rapid-from-mm-per-s", rapid_from_mm_per_s),
        ("--tool-axis", tool_axis),
        ("--joint-rows", joint_rows),
        ("--free-turn", free_turn),
        ("--stiff-turn", stiff_turn),
        ("--turn-plot", turn_plot),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
        ("--chord-tolerance-um", chord_tolerance_um),
        ("--uncertain", uncertain),
        ("--machines", machines),
        ("--limit", limit),
        ("--report", report),
        ("--points", points),
        ("--all-points", all_points),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
        ("--out", out),
        ("--to", to),
        ("--template", template),
        ("--map", map),
        ("--no-compensation", no_compensation),
        ("--again", again),
        ("--no-header", no_header),
        ("--tolerance-um", tolerance_um),
        ("--arcs", arcs),
        ("--min-block-mm", min_block_mm),
        ("--decimals", decimals),
        ("--max-feed-factor", max_feed_factor),
        ("--backward-step-um", backward_step_um),
        ("--max-blocks-per-second", max_blocks_per_second),
    ]
    return answered(["compensate"], options, progress)

def verify(
    verified: _Path,
    *,
    job: _Path | None = None,
    model: str | float | None = None,
    tool_length_mm: float | None = None,
    part_origin_mm: Sequence[float] | None = None,
    part_orientation: str | float | None = None,
    tool_orientation: str | float | None = None,
    scale: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    load_axes: Literal["base", "tool", "feed"] | None = None,
    milling: Sequence[float] | None = None,
    load_at_corners: Literal["turns", "follows-feed"] | None = None,
    below_z_mm: float | None = None,
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
    correct: Literal["position", "pose"] | None = None,
    rapid_from_mm_per_s: float | None = None,
    tool_axis: Literal["x", "y", "z", "-x", "-y", "-z"] | None = None,
    joint_rows: Literal["joint", "linear"] | None = None,
    free_turn: bool = False,
    stiff_turn: bool = False,
    turn_plot: _Path | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    chord_tolerance_um: float | None = None,
    uncertain: _Path | None = None,
    machines: int | None = None,
    limit: str | float | Sequence[str | float] | None = None,
    report: _Path | None = None,
    points: _Path | None = None,
    all_points: bool = False,
    force_overwrite: bool = False,
    threads: int | None = None,
    tolerance_um: float | None = None,
    against: _Path | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""How far off is the tool along any compensated program.

    Solves the machine along a program against the one that it was made from: who or what compensated it
    does not matter, and nothing is taken from how it was written. Says the error along it, feature by
    feature where the job names some, and whether it keeps the tolerance. Lines are those of the
    original, output lines those of the program.

    Parameters
    ----------
    verified : path
        The program that is verified
    job : path
        Job file (TOML): model, original, placement, load, tolerances, features
    model : str | float
        Preset or model file
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    part_origin_mm : Sequence[float]
        Where the program's zero point lies in the machine's base, mm
    part_orientation : str | float
        Orientation of the program's axes in the base, as in a_b_c_kuka_deg=90,0,0
    tool_orientation : str | float
        Orientation of the tool in the base, or the word follows: everywhere the one nearest to that
        at home which the machine can have. Without it, the one at home; it follows where the
        machine cannot hold one
    scale : float
        Length in the machine per length in the program [default: 1]
    force : Sequence[float]
        Force on the tool's tip, N: everywhere on feed moves (with --at: at that place)
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    load_axes : Literal["base", "tool", "feed"]
        Axes of force and moment [default: base]
    milling : Sequence[float]
        Milling force instead, N: to the right of the feed, along it, along the part's z
    load_at_corners : Literal["turns", "follows-feed"]
        Load on the steps that are written at sharp corners: it turns evenly while the tool steps,
        or it follows the feed; the program is the same, the claim about it is not [default: turns]
    below_z_mm : float
        The load acts only below this height of the program, mm
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
    correct : Literal["position", "pose"]
        What of the tool's pose is corrected, in programs that state its orientation (of robots, and
        of machines with rotary axes) [default: position]
    rapid_from_mm_per_s : float
        Linear motions at this speed or a higher one position the tool in air, mm/s: no load acts
        there
    tool_axis : Literal["x", "y", "z", "-x", "-y", "-z"]
        Axis of the tool from its tip to its holder, in axes of its frame [default: -z]
    joint_rows : Literal["joint", "linear"]
        How the controller moves between the rows of a table of joint values
    free_turn : bool
        Turn a round tool about its axis along the path of an arm: inside the limits of the joints,
        away from singular postures, in one configuration
    stiff_turn : bool
        Choose that turn so that the tip of the tool yields little to a force, too
    turn_plot : path
        Picture of that turn along the path (SVG)
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
    chord_tolerance_um : float
        How far the chords of arcs may leave them, micrometres [default: 0.4, in a compensated
        program at most 0.8 of the path's default tolerance]
    uncertain : path
        What is uncertain about machine and load (TOML; see `kinetostat tolerance --help`): the
        errors before and after compensation come as a band over many machines
    machines : int
        Number of machines drawn for the band, rounded up to a multiple of 16 [default: 1024]
    limit : str | float | Sequence[str | float]
        Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
        tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second,
        shortest_tool_mm, longest_tool_mm. A program that leaves a limit is refused
    report : path
        The report, one HTML file
    points : path
        Points of the path as a table (CSV); of long programs the worst of every stretch
    all_points : bool
        Every point in the table, however large it becomes
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
    tolerance_um : float
        How far the tool may be off in all, micrometres [default: what `compensate` allows itself]
    against : path
        The original: the program as it is drawn; without it, the one that the job names
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
    ...     question = {"model": "orthoglide", "force": [100, -20, -30]}
    ...     out = Path(folder, "corrected.ngc")
    ...     _ = ks.commands.compensate(program=file, out=out, **question)
    ...     found = ks.commands.verify(out, against=file, **question)
    >>> found["held"], found["max_position_error_mm"] < 1e-3
    (True, True)
    """
    options: list[tuple[str, Any]] = [
        ("verified", verified),
        ("--job", job),
        ("--model", model),
        ("--tool-length-mm", tool_length_mm),
        ("--part-origin-mm", part_origin_mm),
        ("--part-orientation", part_orientation),
        ("--tool-orientation", tool_orientation),
        ("--scale", scale),
        ("--force", force),
        ("--moment", moment),
        ("--load-axes", load_axes),
        ("--milling", milling),
        ("--load-at-corners", load_at_corners),
        ("--below-z-mm", below_z_mm),
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
        ("--correct", correct),
        ("--rapid-from-mm-per-s", rapid_from_mm_per_s),
        ("--tool-axis", tool_axis),
        ("--joint-rows", joint_rows),
        ("--free-turn", free_turn),
        ("--stiff-turn", stiff_turn),
        ("--turn-plot", turn_plot),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
        ("--chord-tolerance-um", chord_tolerance_um),
        ("--uncertain", uncertain),
        ("--machines", machines),
        ("--limit", limit),
        ("--report", report),
        ("--points", points),
        ("--all-points", all_points),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
        ("--tolerance-um", tolerance_um),
        ("--against", against),
    ]
    return answered(["verify"], options, progress)

def deflect(
    subject: str | float,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    program: _Path | None = None,
    tool_length_mm: float | None = None,
    part_origin_mm: Sequence[float] | None = None,
    part_orientation: str | float | None = None,
    tool_orientation: str | float | None = None,
    scale: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    load_axes: Literal["base", "tool", "feed"] | None = None,
    milling: Sequence[float] | None = None,
    load_at_corners: Literal["turns", "follows-feed"] | None = None,
    below_z_mm: float | None = None,
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
    correct: Literal["position", "pose"] | None = None,
    rapid_from_mm_per_s: float | None = None,
    tool_axis: Literal["x", "y", "z", "-x", "-y", "-z"] | None = None,
    joint_rows: Literal["joint", "linear"] | None = None,
    free_turn: bool = False,
    stiff_turn: bool = False,
    turn_plot: _Path | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    chord_tolerance_um: float | None = None,
    uncertain: _Path | None = None,
    machines: int | None = None,
    limit: str | float | Sequence[str | float] | None = None,
    report: _Path | None = None,
    points: _Path | None = None,
    all_points: bool = False,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """How far is the tool off: at one place, or along a program.

    With --at: displacement and rotation under a load at one place, actuator forces and stability. With
    a job file, or with --program: the same along a whole program, with report and tables; nothing is
    compensated. The outputs that a job file names are those of `compensate`: name what you want here
    with --report, --points and --json.

    Parameters
    ----------
    subject : str | float
        Preset, model file, or job file
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
    program : path
        Program: G-code, or of a robot (`kinetostat dialect list`)
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    part_origin_mm : Sequence[float]
        Where the program's zero point lies in the machine's base, mm
    part_orientation : str | float
        Orientation of the program's axes in the base, as in a_b_c_kuka_deg=90,0,0
    tool_orientation : str | float
        Orientation of the tool in the base, or the word follows: everywhere the one nearest to that
        at home which the machine can have. Without it, the one at home; it follows where the
        machine cannot hold one
    scale : float
        Length in the machine per length in the program [default: 1]
    force : Sequence[float]
        Force on the tool's tip, N: everywhere on feed moves (with --at: at that place)
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    load_axes : Literal["base", "tool", "feed"]
        Axes of force and moment [default: base]
    milling : Sequence[float]
        Milling force instead, N: to the right of the feed, along it, along the part's z
    load_at_corners : Literal["turns", "follows-feed"]
        Load on the steps that are written at sharp corners: it turns evenly while the tool steps,
        or it follows the feed; the program is the same, the claim about it is not [default: turns]
    below_z_mm : float
        The load acts only below this height of the program, mm
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
    correct : Literal["position", "pose"]
        What of the tool's pose is corrected, in programs that state its orientation (of robots, and
        of machines with rotary axes) [default: position]
    rapid_from_mm_per_s : float
        Linear motions at this speed or a higher one position the tool in air, mm/s: no load acts
        there
    tool_axis : Literal["x", "y", "z", "-x", "-y", "-z"]
        Axis of the tool from its tip to its holder, in axes of its frame [default: -z]
    joint_rows : Literal["joint", "linear"]
        How the controller moves between the rows of a table of joint values
    free_turn : bool
        Turn a round tool about its axis along the path of an arm: inside the limits of the joints,
        away from singular postures, in one configuration
    stiff_turn : bool
        Choose that turn so that the tip of the tool yields little to a force, too
    turn_plot : path
        Picture of that turn along the path (SVG)
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
    chord_tolerance_um : float
        How far the chords of arcs may leave them, micrometres [default: 0.4, in a compensated
        program at most 0.8 of the path's default tolerance]
    uncertain : path
        What is uncertain about machine and load (TOML; see `kinetostat tolerance --help`): the
        errors before and after compensation come as a band over many machines
    machines : int
        Number of machines drawn for the band, rounded up to a multiple of 16 [default: 1024]
    limit : str | float | Sequence[str | float]
        Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
        tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second,
        shortest_tool_mm, longest_tool_mm. A program that leaves a limit is refused
    report : path
        The report, one HTML file
    points : path
        Points of the path as a table (CSV); of long programs the worst of every stretch
    all_points : bool
        Every point in the table, however large it becomes
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.deflect("orthoglide", force=[100, 0, 0])
    >>> found["stable"], round(found["displacement_mm"][0], 4)
    (True, 0.0333)
    """
    options: list[tuple[str, Any]] = [
        ("subject", subject),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--program", program),
        ("--tool-length-mm", tool_length_mm),
        ("--part-origin-mm", part_origin_mm),
        ("--part-orientation", part_orientation),
        ("--tool-orientation", tool_orientation),
        ("--scale", scale),
        ("--force", force),
        ("--moment", moment),
        ("--load-axes", load_axes),
        ("--milling", milling),
        ("--load-at-corners", load_at_corners),
        ("--below-z-mm", below_z_mm),
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
        ("--correct", correct),
        ("--rapid-from-mm-per-s", rapid_from_mm_per_s),
        ("--tool-axis", tool_axis),
        ("--joint-rows", joint_rows),
        ("--free-turn", free_turn),
        ("--stiff-turn", stiff_turn),
        ("--turn-plot", turn_plot),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
        ("--chord-tolerance-um", chord_tolerance_um),
        ("--uncertain", uncertain),
        ("--machines", machines),
        ("--limit", limit),
        ("--report", report),
        ("--points", points),
        ("--all-points", all_points),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["deflect"], options, progress)

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

def shares(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    direction: Literal["x", "y", "z", "rx", "ry", "rz"] | None = None,
    along: Sequence[float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    tool_length_mm: float | None = None,
    sensitivities: bool = False,
    reduce_percent: float | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Which link, drive, joint gives how much of the deflection in a direction.

    Divides the compliance of the tool in one direction exactly among all springs of the machine, and
    what loads add as they turn; all shares add to 100 %. Without a force it is that of the unloaded
    machine as drawn; under one, what a further small load meets.

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
    direction : Literal["x", "y", "z", "rx", "ry", "rz"]
        Along which axis of the base the tool is pushed, or about which it is turned
    along : Sequence[float]
        Any other direction of the push, base axes
    force : Sequence[float]
        Force on the tool's tip, N: shares under it
    moment : Sequence[float]
        Moment on the tool about its tip, N m
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    sensitivities : bool
        Besides: what every number of the model file changes, the strongest first
    reduce_percent : float
        Besides: the cheapest stiffening that lowers the deflection by so many percent
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
    >>> found = ks.commands.shares("heavy_6r", direction="z")
    >>> round(sum(part["share"] for part in found["parts"]), 12)
    1.0
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--direction", direction),
        ("--along", along),
        ("--force", force),
        ("--moment", moment),
        ("--tool-length-mm", tool_length_mm),
        ("--sensitivities", sensitivities),
        ("--reduce-percent", reduce_percent),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["shares"], options, progress)

def compare(
    a: _Path | Machine,
    b: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    x: Sequence[float] | None = None,
    y: Sequence[float] | None = None,
    z: Sequence[float] | None = None,
    tool_length_mm: float | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Which of two designs is stiffer where, and by which parts.

    Puts both at the same places: stiffness along the axes and the shares of their parts beside each
    other, and over a grid the difference at every place that both reach. (`model compare` tells whether
    two files describe one machine.)

    Parameters
    ----------
    a : path | Machine
        Preset or model file
    b : path | Machine
        Preset or model file
    at : Sequence[float]
        Position of the tool, base axes, mm; may be repeated. Without it, each at its home
    x : Sequence[float]
        Grid along x of the base, mm: from, to, and how many places
    y : Sequence[float]
        The same along y
    z : Sequence[float]
        The same along z
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm, of both
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
    >>> found = ks.commands.compare("stewart_gough_a", "stewart_gough_b")
    >>> place = found["places"][0]
    >>> place["b"]["smallest_stiffness_n_per_mm"] > place["a"]["smallest_stiffness_n_per_mm"]
    True
    """
    options: list[tuple[str, Any]] = [
        ("a", a),
        ("b", b),
        ("--at", at),
        ("--x", x),
        ("--y", y),
        ("--z", z),
        ("--tool-length-mm", tool_length_mm),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["compare"], options, progress)

def map(
    model: _Path | Machine,
    *,
    x: float | Sequence[float] | None = None,
    y: float | Sequence[float] | None = None,
    z: float | Sequence[float] | None = None,
    rotation: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    plot: _Path | None = None,
    show: str | float | None = None,
    variables: str | float | Sequence[str | float] | None = None,
    section: str | float | None = None,
    csv: _Path | None = None,
    vtk: _Path | None = None,
    netcdf: _Path | None = None,
    parquet: _Path | None = None,
    resume: _Path | None = None,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """How stiff is the machine all over its workspace.

    Puts the tool at every place of a grid, all with one orientation, and tells where it is stiff and
    where soft; under a force, how far the tool goes and whether the machine stays stable. Places that
    cannot be reached are counted. Memory does not grow with the grid.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    x : float | Sequence[float]
        Places along x of the base, mm: from, to (they rise whichever end is named first), and how
        many [default: 21]; or one value. Without it, as at home
    y : float | Sequence[float]
        The same along y
    z : float | Sequence[float]
        The same along z
    rotation : str | float | Sequence[str | float]
        Orientation of the tool everywhere by a named convention, as in a_b_c_kuka_deg=0,0,90, or
        the word follows: at every place the one nearest to that at home which the machine can have.
        Without it, the orientation at home; it follows where the machine cannot hold one. Several:
        the worst of them counts at a place
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    force : Sequence[float]
        Force on the tool's tip, N, base axes. Several: the worst of them counts at a place
    moment : Sequence[float]
        Moment on the tool about its tip, N m, base axes; one for all forces, or one for each
    plot : path
        Draw a section of the map (SVG)
    show : str | float
        What is drawn: softest, x, y, z (stiffness), displacement, rotation, or a column of a
        variable of --variables, as in margin or joint_efforts_2
    variables : str | float | Sequence[str | float]
        Further variables for the answer and the files, SI, with commas: stiffness_stiffest,
        rotational_stiffness_z, principal_stiffness, principal_directions, joint_efforts,
        effort_share, share_to_buckling, margin, singularity_distance, ...; a wrong name lists all
    section : str | float
        Where a grid in space is cut for the drawing, as in z=150 (the nearest places, mm); across z
        in its middle without it
    csv : path
        All places as a table (CSV), written as they are solved
    vtk : path
        All places for ParaView (legacy VTK, SI)
    netcdf : path
        All places as NetCDF-3, SI
    parquet : path
        All places as Parquet, SI
    resume : path
        Keep what is solved in this directory, and go on from there after a run that was stopped
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.map("orthoglide", x=[-50, 50, 3])
    >>> found["places"]["regular"], found["figures"][0]["unit"]
    (3, 'N/mm')
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--x", x),
        ("--y", y),
        ("--z", z),
        ("--rotation", rotation),
        ("--tool-length-mm", tool_length_mm),
        ("--force", force),
        ("--moment", moment),
        ("--plot", plot),
        ("--show", show),
        ("--variables", variables),
        ("--section", section),
        ("--csv", csv),
        ("--vtk", vtk),
        ("--netcdf", netcdf),
        ("--parquet", parquet),
        ("--resume", resume),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["map"], options, progress)

def mirror(
    program: _Path,
    *,
    measured: _Path | Sequence[_Path] | None = None,
    state: _Path | None = None,
    job: _Path | None = None,
    relaxation: float | None = None,
    smoothing_mm: float | None = None,
    window_mm: float | None = None,
    repeatability_um: float | None = None,
    align: Literal["nearest", "arc-length"] | None = None,
    register: bool = False,
    no_register: bool = False,
    scale: bool = False,
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
    tolerance_um: float | None = None,
    decimals: str | float | None = None,
    out: _Path | None = None,
    no_header: bool = False,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""Correct a program by what was measured of its last trial.

    Brings measured points onto the path, names outliers, smooths the deviations along the path, and
    writes the program with them mirrored. Measure the new program, and give the points with the same
    state: each trial corrects what the one before has left, until that is within the repeatability.

    Parameters
    ----------
    program : path
        The program as it is drawn, the same in every trial: G-code
    measured : path | Sequence[path]
        Points measured of the last trial (CSV with x_mm,y_mm,z_mm), or a second program; once for
        each measurement of the same trial
    state : path
        The state of all trials (TOML), read and written; without it this is the only trial
    job : path
        Job file with a model (TOML): its compensation comes first, and the mirror corrects what is
        left
    relaxation : float
        Share of the deviation that is mirrored, above 0 and below 2 [default: 1]
    smoothing_mm : float
        Smoothing along the path, standard deviation of its kernel, mm [default: 5]
    window_mm : float
        How far the tool may have been from its path, mm [default: 1]
    repeatability_um : float
        Standard deviation of one measured deviation in one direction, micrometres; without it, from
        several measurements of this trial
    align : Literal["nearest", "arc-length"]
        How points find their places on the path [default: nearest]
    register : bool
        Bring the points onto the path by a rigid motion first; the default
    no_register : bool
        The points are in the frame of the program: no motion is sought, and a shift of the whole is
        corrected too
    scale : bool
        Seek a scale besides the rigid motion
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
    tolerance_um : float
        How far the straight pieces may leave the corrected path, micrometres [default: 0.5]
    decimals : str | float
        Digits after the point in mm, one more in inches [default: 4]
    out : path
        The corrected program of the next trial
    no_header : bool
        Leave out the header that marks the program as compensated
    plot : path
        Deviation along the path before and after smoothing, correction and outliers (SVG)
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
    ...     _ = file.write_text('G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n')
    ...     measured = Path(folder, "trial1.csv")
    ...     _ = measured.write_text("x_mm,y_mm,z_mm\n" + "".join(f"{x},0.05,0\n" for x in range(41)))
    ...     found = ks.commands.mirror(file, measured=measured, no_register=True, out=Path(folder, "trial2.ngc"))
    >>> found["outcome"], round(found["left_mm"], 3), round(found["largest_correction_mm"], 3)
    ('go_on', 0.05, 0.05)
    """
    options: list[tuple[str, Any]] = [
        ("program", program),
        ("--measured", measured),
        ("--state", state),
        ("--job", job),
        ("--relaxation", relaxation),
        ("--smoothing-mm", smoothing_mm),
        ("--window-mm", window_mm),
        ("--repeatability-um", repeatability_um),
        ("--align", align),
        ("--register", register),
        ("--no-register", no_register),
        ("--scale", scale),
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
        ("--tolerance-um", tolerance_um),
        ("--decimals", decimals),
        ("--out", out),
        ("--no-header", no_header),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["mirror"], options, progress)

def tolerance(
    model: _Path | Machine,
    *,
    uncertain: _Path | None = None,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    tool_length_mm: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    only: Literal["error", "deflection", "deviation", "compensated", "stiffness"] | Sequence[Literal["error", "deflection", "deviation", "compensated", "stiffness"]] | None = None,
    machines: int | None = None,
    seed: int | None = None,
    sobol: int | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""How far do results scatter when the machine is not exactly as drawn.

    Builds thousands of machines whose numbers scatter as a file says, commands each as the drawing
    says, and tells the spread of its error, its deflection and its stiffness, before and after
    compensation; beside it what linear propagation says, and whether that is enough.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    uncertain : path
        What is uncertain (TOML, see below)
    at : Sequence[float]
        Place of the tool's tip in base axes, mm; once for each place; home without it
    rotation : str | float
        Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    force : Sequence[float]
        Force on the tool's tip, N, base axes
    moment : Sequence[float]
        Moment on the tool about its tip, N m, base axes
    only : Literal["error", "deflection", "deviation", "compensated", "stiffness"] | Sequence[Literal["error", "deflection", "deviation", "compensated", "stiffness"]]
        What is asked; without it, error and stiffness, and under a load everything
    machines : int
        Number of machines, rounded up to a multiple of 16 [default: 4096]
    seed : int
        Seed of the draws; the same seed draws the same machines [default: 0]
    sobol : int
        Sobol indices, too, from so many draws, each of which asks for as many machines as there are
        uncertain numbers, and two
    csv : path
        All machines as a table (CSV): the numbers drawn, then the results at every place
    plot : path
        Histogram of the first result at the first place, with the linear one above it (SVG)
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
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
    ...     file = Path(folder, "uncertain.toml")
    ...     _ = file.write_text('schema = 1\n[[uncertain]]\nparameter = "chain.leg.q2.length_mm"\nnormal = 0.02\n')
    ...     found = ks.commands.tolerance("orthoglide", uncertain=file, force=[100, 0, 0], machines=256)
    >>> error = next(r for r in found["places"][0]["results"] if r["name"] == "error_mm")
    >>> error["draws"]["answered"], found["uncertain"][0]["distribution"]
    (256, 'normal')
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--uncertain", uncertain),
        ("--at", at),
        ("--rotation", rotation),
        ("--tool-length-mm", tool_length_mm),
        ("--force", force),
        ("--moment", moment),
        ("--only", only),
        ("--machines", machines),
        ("--seed", seed),
        ("--sobol", sobol),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["tolerance"], options, progress)

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
        G-code program, or a job file (its name ends in .toml)
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

def expand(
    program: _Path,
    *,
    out: _Path | None = None,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
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
    progress: _Progress | None = None,
) -> str:
    r"""A program with subprograms, variables and cycles as plain blocks.

    Runs the program once and writes what it runs: subprograms, loops and branches as their blocks,
    expressions as numbers, canned cycles and polar words as moves, G41 and G42 as the way of the tool's
    centre. The moves are those of LinuxCNC. What is not followed is refused with its line.

    Parameters
    ----------
    program : path
        Program in G-code, of SINUMERIK (.mpf) or Heidenhain (.h), or in APT (.apt, .cls)
    out : path
        File for the flat program; without it, it is printed
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
    force_overwrite : bool
        Overwrite the output if it exists (never the input)
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
    ...     file = Path(folder, "loop.ngc")
    ...     _ = file.write_text('G21 G90\n#1=0\nO1 WHILE [#1 LT 3]\nG1 X[#1*10] F600\n#1=[#1+1]\nO1 ENDWHILE\nM30\n')
    ...     text = ks.commands.expand(file)
    >>> text.count("X")
    3
    """
    options: list[tuple[str, Any]] = [
        ("program", program),
        ("--out", out),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
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
    ]
    return texted(["expand"], options, progress)

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
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
    ]
    return texted(["convert"], options, progress)

def dialect_list(
    *,
    progress: _Progress | None = None,
) -> str:
    """The languages that are read.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "krl" in ks.commands.dialect_list()
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["dialect", "list"], options, progress)

def dialect_show(
    name: str | float,
    *,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Every word of a language: followed, carried byte for byte, or refused and why.

    Parameters
    ----------
    name : str | float
        Name of a language, as `dialect list` has it
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.dialect_show("krl")
    >>> next(word["treatment"] for word in found["words"] if word["word"] == "LIN")
    'followed'
    """
    options: list[tuple[str, Any]] = [
        ("name", name),
    ]
    return answered(["dialect", "show"], options, progress)

def check(
    model: _Path | Machine,
    *,
    force: Sequence[float] | None = None,
    pose: _Path | None = None,
    pose_tolerance_mm: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """What a model file or a job file says, in words.

    Of a model: platforms, limbs, actuators with units and limits, passive joints, springs, masses;
    mobility, stiffness at home, effect of deviations, stability under gravity; and everything that
    looks wrong. Of a job: its model, program, placement, load and outputs, and whether the ends of the
    program can be reached; the program is read, not run.

    Parameters
    ----------
    model : path | Machine
        Preset, model file or job file
    force : Sequence[float]
        Load on the tool by which deflections are judged, N, base axes; 1 kN along each axis without
        it
    pose : path
        Compare with poses jogged on the machine instead: a table (CSV) or TOML with joint values
        and the measured pose of the tool
    pose_tolerance_mm : float
        How far apart such poses may be, mm; 0.1 degrees for each millimetre
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.check("orthoglide", force=[100, 0, 0])
    >>> found["home"]["mobility"], found["home"]["degrees_of_over_constraint"], found["warnings"]
    (3, 3, [])
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--force", force),
        ("--pose", pose),
        ("--pose-tolerance-mm", pose_tolerance_mm),
    ]
    return answered(["check"], options, progress)

def import_urdf(
    file: _Path,
    *,
    base: str | float | None = None,
    tip: str | float | None = None,
    loops: _Path | None = None,
    passive: str | float | Sequence[str | float] | None = None,
    home: str | float | Sequence[str | float] | None = None,
    joint_stiffness: str | float | None = None,
    link_section: _Path | None = None,
    out: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """A model file from a URDF.

    Geometry, masses and limits come from the URDF; it says nothing of what bends. Joint stiffnesses and
    the section of links are given here, or filled in where the written file says FILL IN. Everything
    that is skipped, replaced or looks wrong is reported.

    Parameters
    ----------
    file : path
        URDF file (a xacro file must be expanded first)
    base : str | float
        Link that stands; the root without it
    tip : str | float
        Link that carries the tool; needed where the tree has several ends
    loops : path
        Closed loops (TOML): what the proposed `constraint` element of a URDF says
    passive : str | float | Sequence[str | float]
        Joints that nothing drives
    home : str | float | Sequence[str | float]
        Where a joint stands at home, as in joint_5=30deg or rail=1200mm; zero without it
    joint_stiffness : str | float
        Stiffness of the drives: one number for all that turn, N m/rad, or a table (CSV) with the
        columns name,value,unit
    link_section : path
        Links are straight beams of this section (TOML: the keys of a section of a model file);
        rigid without it
    out : path
        The model file; without it, the model goes to the standard output
    force_overwrite : bool
        Overwrite an existing file
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
    ...     file = Path(folder, "crane.urdf")
    ...     _ = file.write_text('<robot name="crane"><link name="post"/><link name="boom"/><joint name="shoulder" type="revolute"><parent link="post"/><child link="boom"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="0" velocity="1"/></joint></robot>')
    ...     found = ks.commands.import_urdf(file, joint_stiffness=2e5)
    >>> found["robot"], found["actuators"]
    ('crane', ['shoulder'])
    """
    options: list[tuple[str, Any]] = [
        ("file", file),
        ("--base", base),
        ("--tip", tip),
        ("--loops", loops),
        ("--passive", passive),
        ("--home", home),
        ("--joint-stiffness", joint_stiffness),
        ("--link-section", link_section),
        ("--out", out),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["import", "urdf"], options, progress)

def import_matrix(
    file: _Path,
    *,
    dofs: _Path | None = None,
    matrix: str | float | None = None,
    interface: str | float | None = None,
    fixed: str | float | None = None,
    averaged: bool = False,
    end_mm: Sequence[float] | None = None,
    symmetrise: bool = False,
    units: str | float | None = None,
    nodes: _Path | None = None,
    x_axis: Sequence[float] | None = None,
    y_axis: Sequence[float] | None = None,
    name: str | float | None = None,
    out: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""The stiffness of a link from a matrix: 6 x 6 (CSV, JSON), or of a mesh's interfaces.

    Writes a table [stiffness.NAME] for a model file. A 6 x 6 says its units in its header. A matrix of
    many degrees of freedom (Nastran DMIG, CalculiX .sti or .mtx, Harwell-Boeing) is condensed: the
    nodes of --interface become one rigid body at the link's end (or move it by their average), those of
    --fixed are held. What is not a stiffness is refused in words.

    Parameters
    ----------
    file : path
        File with the matrix: CSV or JSON (6 x 6), DMIG, .sti, .mtx or Harwell-Boeing
    dofs : path
        Which node and direction each row is: the .dof file of CalculiX, the mapping file of Ansys
    matrix : str | float
        Which matrix, where the file has several (DMIG)
    interface : str | float
        Nodes of the end that moves: numbers as in 12,13,14 or the name of a set of the mesh
    fixed : str | float
        Nodes of the end that is held; none if the matrix is of a link held already
    averaged : bool
        The interface may warp: the end moves by the average of its nodes and spreads its load over
        them (RBE3); without it they are tied rigidly (RBE2)
    end_mm : Sequence[float]
        The link's end in the mesh, mm; the middle of the interface's nodes without it
    symmetrise : bool
        The matrix is not symmetric because of noise: take its symmetric part, and say so in the
        table
    units : str | float
        Units of a file that has none: n-mm, n-m, kn-mm, kn-m, lbf-in
    nodes : path
        Where the nodes are, and their sets: a mesh (*NODE or GRID), or CSV with node,x_mm,y_mm,z_mm
    x_axis : Sequence[float]
        Direction of the link's x axis in the mesh [default: 1 0 0]
    y_axis : Sequence[float]
        Direction that the link's y axis leans to in the mesh [default: 0 1 0]
    name : str | float
        Name of the table [stiffness.NAME]; the file's name without it
    out : path
        The table; without it, it goes to the standard output
    force_overwrite : bool
        Overwrite an existing file
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
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> rows = [",".join(str(x) for x in row) for row in np.diag([1e5, 1e4, 1e4, 1e7, 1e8, 1e8])]
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "boom.csv")
    ...     _ = file.write_text("\n".join(rows))
    ...     found = ks.commands.import_matrix(file, units="n-mm")
    >>> found["name"], found["rank"]
    ('boom', 6)
    """
    options: list[tuple[str, Any]] = [
        ("file", file),
        ("--dofs", dofs),
        ("--matrix", matrix),
        ("--interface", interface),
        ("--fixed", fixed),
        ("--averaged", averaged),
        ("--end-mm", end_mm),
        ("--symmetrise", symmetrise),
        ("--units", units),
        ("--nodes", nodes),
        ("--x-axis", x_axis),
        ("--y-axis", y_axis),
        ("--name", name),
        ("--out", out),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["import", "matrix"], options, progress)

def import_link_displacements(
    file: _Path,
    *,
    end_mm: Sequence[float] | None = None,
    loads: _Path | None = None,
    force_n: float | None = None,
    moment_n_mm: float | None = None,
    filter: bool = False,
    units: str | float | None = None,
    nodes: _Path | None = None,
    x_axis: Sequence[float] | None = None,
    y_axis: Sequence[float] | None = None,
    name: str | float | None = None,
    out: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""The stiffness of a link from displacements of its interface under six loads.

    FILE has the columns case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm (units mm, m; displacements also
    um), or is the .dat file of CalculiX with one step per case. A rigid motion is fitted to the nodes
    in each case, the interface may warp (an averaged interface); the compliance, how sure it is and
    what of it is not symmetric are reported.

    Parameters
    ----------
    file : path
        File with the displacements: CSV, or the .dat file of CalculiX
    end_mm : Sequence[float]
        Where the loads act and the stiffness belongs: the link's end in the mesh, mm
    loads : path
        Loads of the cases (CSV): case,fx_n,fy_n,fz_n,mx_n_mm,my_n_mm,mz_n_mm
    force_n : float
        Force of the cases fx, fy, fz, N
    moment_n_mm : float
        Moment of the cases mx, my, mz, N mm
    filter : bool
        Take entries of the compliance for zero that the noise hides (less than twice their
        deviation)
    units : str | float
        Units of a file that has none: n-mm, n-m, kn-mm, kn-m, lbf-in
    nodes : path
        Where the nodes are, and their sets: a mesh (*NODE or GRID), or CSV with node,x_mm,y_mm,z_mm
    x_axis : Sequence[float]
        Direction of the link's x axis in the mesh [default: 1 0 0]
    y_axis : Sequence[float]
        Direction that the link's y axis leans to in the mesh [default: 0 1 0]
    name : str | float
        Name of the table [stiffness.NAME]; the file's name without it
    out : path
        The table; without it, it goes to the standard output
    force_overwrite : bool
        Overwrite an existing file
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
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> arms = np.array([[0, 5, 0], [0, -5, 3], [0, 0, -6], [2, 1, 1]])  # of nodes from the end at 10 mm along x
    >>> lines = ["case,node,x_mm,y_mm,z_mm,ux_mm,uy_mm,uz_mm"]
    >>> for case, shift, turn in [(f"f{a}", e / 20, 0 * e) for a, e in zip("xyz", np.eye(3))] + [
    ...     (f"m{a}", 0 * e, e / 5000) for a, e in zip("xyz", np.eye(3))
    ... ]:
    ...     for node, arm in enumerate(arms):
    ...         numbers = [*(arm + [10, 0, 0]), *(shift + np.cross(turn, arm))]
    ...         lines.append(",".join([case, str(node), *(repr(float(x)) for x in numbers)]))
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "u.csv")
    ...     _ = file.write_text("\n".join(lines))
    ...     found = ks.commands.import_link_displacements(file, end_mm=[10, 0, 0], force_n=100, moment_n_mm=1000)
    >>> round(found["stiffness_n_mm_rad"][0][0]), round(found["stiffness_n_mm_rad"][3][3])
    (2000, 5000000)
    """
    options: list[tuple[str, Any]] = [
        ("file", file),
        ("--end-mm", end_mm),
        ("--loads", loads),
        ("--force-n", force_n),
        ("--moment-n-mm", moment_n_mm),
        ("--filter", filter),
        ("--units", units),
        ("--nodes", nodes),
        ("--x-axis", x_axis),
        ("--y-axis", y_axis),
        ("--name", name),
        ("--out", out),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["import", "link-displacements"], options, progress)

def reproduce(
    id: str | float | None = None,
    *,
    html: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[dict[str, Any]]:
    """The numbers of the COROUSSO report L1.1, computed again and set beside their print.

    Each table, each equation with a number in it and each figure of chapters 2 to 7: what is printed,
    what comes out, and whether they agree; where they do not, why.

    Parameters
    ----------
    id : str | float
        Which one, as in table-5.2, eq-3.34 or fig-5.7; all without it
    html : path
        Write a page with all numbers and the figures drawn
    force_overwrite : bool
        Overwrite an existing file
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    list of dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.reproduce("eq-3.34")
    >>> found[0]["id"], next(item["status"] for item in found[0]["items"] if item["name"] == "K11")
    ('eq-3.34', 'agrees')
    """
    options: list[tuple[str, Any]] = [
        ("id", id),
        ("--html", html),
        ("--force-overwrite", force_overwrite),
    ]
    return listed(["reproduce"], options, progress)

def model_list(
    *,
    progress: _Progress | None = None,
) -> str:
    """The presets, one line each.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "orthoglide" in ks.commands.model_list()
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["model", "list"], options, progress)

def model_show(
    name: str | float,
    *,
    progress: _Progress | None = None,
) -> str:
    """The model file of a preset: a start for your own.

    Parameters
    ----------
    name : str | float
        Name of the preset
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "[mechanism]" in ks.commands.model_show("two_link")
    True
    """
    options: list[tuple[str, Any]] = [
        ("name", name),
    ]
    return texted(["model", "show"], options, progress)

def model_schema(
    *,
    progress: _Progress | None = None,
) -> str:
    """The JSON Schema of model files, for editors.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import json
    >>> import kinetostat as ks
    >>> "mechanism" in json.loads(ks.commands.model_schema())["properties"]
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["model", "schema"], options, progress)

def model_compare(
    a: _Path | Machine,
    b: _Path | Machine,
    *,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Are two models one machine but for constant offsets of base, tool and joints.

    Parameters
    ----------
    a : path | Machine
        Preset or model file
    b : path | Machine
        Preset or model file with as many actuators
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.model_compare("heavy_6r", "heavy_6r")
    >>> found["same"]
    True
    """
    options: list[tuple[str, Any]] = [
        ("a", a),
        ("b", b),
    ]
    return answered(["model", "compare"], options, progress)

def model_draw(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    view: Literal["iso", "front", "side", "top"] | None = None,
    motion: int | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    scale: float | None = None,
    out: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> str:
    """A drawing of a machine (SVG), and of how it moves or bends.

    Links that bend, rigid ones, drives, passive joints, platforms, base and tool, at home or at a
    place. With --motion: how the machine moves in its softest or free direction, by which joints. With
    --force or --moment: the deflected machine over the undeflected one.

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
    view : Literal["iso", "front", "side", "top"]
        From where to look; without it, square to a machine in one plane, else obliquely
    motion : int
        Draw the motion in the N-th softest direction of the tool; 1 is a free one, if there is any
    force : Sequence[float]
        Draw the machine under this force on the tool's tip, N (0 0 0: under its own weight)
    moment : Sequence[float]
        Draw the machine under this moment on the tool, N m
    scale : float
        How many times larger the deflection is drawn; without it, a round number that shows it
    out : path
        The drawing; without it, it goes to the standard output
    force_overwrite : bool
        Overwrite an existing file
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> ks.commands.model_draw("two_link").lstrip().startswith("<svg")
    True
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--view", view),
        ("--motion", motion),
        ("--force", force),
        ("--moment", moment),
        ("--scale", scale),
        ("--out", out),
        ("--force-overwrite", force_overwrite),
    ]
    return texted(["model", "draw"], options, progress)
