"""``kinetostat verify``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


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
    weight: Literal["touch-off", "all", "none"] | None = None,
    touch_off: Sequence[float] | None = None,
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
    call: str | float | Sequence[str | float] | None = None,
    set: str | float | Sequence[str | float] | None = None,
    expand: bool = False,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    flat_program: _Path | None = None,
    chord_tolerance_um: float | None = None,
    limit: str | float | Sequence[str | float] | None = None,
    pdf: _Path | None = None,
    language: Literal["en", "fr", "de"] | None = None,
    part_number: str | float | None = None,
    revision: str | float | None = None,
    points: _Path | None = None,
    vtk: _Path | None = None,
    all_points: bool = False,
    force_overwrite: bool = False,
    threads: int | None = None,
    tolerance_um: float | None = None,
    decimals: str | float | None = None,
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
        or it follows the feed; the program is the same, the claim about it is not [default: turns,
        which is an assumption until it is stated]
    below_z_mm : float
        The load acts only below this height of the program, mm
    weight : Literal["touch-off", "all", "none"]
        How much of the displacement by the machine's own weight counts as an error of the program;
        it must be stated where own weight moves the tool
    touch_off : Sequence[float]
        Place where this machine touched the part off, program coordinates, mm, for --weight touch-
        off: one, or three and more (repeat it) that give the frame's orientation, too
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
    chord_tolerance_um : float
        How far the chords of arcs may leave them, micrometres [default: 0.4, in a compensated
        program at most 0.8 of the path's default tolerance]
    limit : str | float | Sequence[str | float]
        Move a limit, as in correction_mm=5 (repeat for more): correction_mm, own_weight_mm,
        tilt_deg, force_n, moment_n_m, share_of_rating, share_of_buckling, blocks_per_second,
        shortest_tool_mm, longest_tool_mm, nearest_base_mm, below_base_mm, speed_mm_per_s, zone_mm.
        A program that leaves a limit is refused
    pdf : path
        The report as PDF, to be signed and filed
    language : Literal["en", "fr", "de"]
        Language of the reports [default: en]. In French and German the HTML report is the paper
    part_number : str | float
        Number of the part, for the reports and the result
    revision : str | float
        Revision of the part
    points : path
        Points of the path as a table: CSV, of long programs the worst of every stretch; Parquet
        with every point where the name ends in .parquet
    vtk : path
        The path as lines for ParaView (VTK): errors, corrections and loads as vectors at its points
    all_points : bool
        Every point in the table, however large it becomes
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
    tolerance_um : float
        How far the tool may be off in all, micrometres [default: what `compensate` allows itself]
    decimals : str | float
        Digits after the point with which the program was written, in mm; their rounding is part of
        what `compensate` allows itself [default: 4, or those of the job]
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
        ("--weight", weight),
        ("--touch-off", touch_off),
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
        ("--call", call),
        ("--set", set),
        ("--expand", expand),
        ("--subprograms", subprograms),
        ("--tool-diameter-mm", tool_diameter_mm),
        ("--parameter", parameter),
        ("--dialect", dialect),
        ("--no-comments", no_comments),
        ("--flat-program", flat_program),
        ("--chord-tolerance-um", chord_tolerance_um),
        ("--limit", limit),
        ("--pdf", pdf),
        ("--language", language),
        ("--part-number", part_number),
        ("--revision", revision),
        ("--points", points),
        ("--vtk", vtk),
        ("--all-points", all_points),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
        ("--tolerance-um", tolerance_um),
        ("--decimals", decimals),
        ("--against", against),
    ]
    return answered(["verify"], options, progress)
