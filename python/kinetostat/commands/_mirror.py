"""``kinetostat mirror``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


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
    register: Literal["none", "translation", "rigid"] | None = None,
    scale: bool = False,
    was_run: bool = False,
    limit: str | float | Sequence[str | float] | None = None,
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
        The program as it is drawn, the same in every trial: G-code, or of a robot (`kinetostat
        dialect list`)
    measured : path | Sequence[path]
        Points measured of the last trial (CSV with x_mm,y_mm,z_mm), or a second program; once for
        each measurement of the same trial
    state : path
        The state of all trials (TOML), read and written; without it this is the only trial
    job : path
        Job file (TOML): the compensation by its model, if it names one, comes first, and the mirror
        corrects what is left; each of its features gets figures of its own
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
    register : Literal["none", "translation", "rigid"]
        Motion that brings the points onto the path first; what it takes away is not corrected. A
        state that exists knows it, and without one it must be chosen
    scale : bool
        Seek a scale besides the rigid motion
    was_run : bool
        The program that was measured is the last one written for certain: go on although its
        correction is not seen in the points
    limit : str | float | Sequence[str | float]
        Move a limit, as in correction_mm=5 (repeat for more; `kinetostat compensate --help-all`
        lists them): correction_mm bounds the correction by measurement, blocks_per_second the
        program
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
    ...     found = ks.commands.mirror(file, measured=measured, register="none", out=Path(folder, "trial2.ngc"))
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
        ("--scale", scale),
        ("--was-run", was_run),
        ("--limit", limit),
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
        ("--tolerance-um", tolerance_um),
        ("--decimals", decimals),
        ("--out", out),
        ("--no-header", no_header),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["mirror"], options, progress)
