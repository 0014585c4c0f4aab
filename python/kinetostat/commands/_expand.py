"""``kinetostat expand``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import texted

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def expand(
    program: _Path,
    *,
    out: _Path | None = None,
    subprograms: _Path | Sequence[_Path] | None = None,
    tool_diameter_mm: str | float | Sequence[str | float] | None = None,
    parameter: str | float | Sequence[str | float] | None = None,
    dialect: Literal["linuxcnc", "fanuc"] | None = None,
    no_comments: bool = False,
    call: str | float | Sequence[str | float] | None = None,
    set: str | float | Sequence[str | float] | None = None,
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
        Program in G-code, of SINUMERIK (.mpf) or Heidenhain (.h), in APT (.apt, .cls), KRL (.src),
        RAPID (.mod) or FANUC TP (.ls)
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
    call : str | float | Sequence[str | float]
        What the program calls by this name, and none of its files holds, moves the tool: NAME=moves
        (repeat for more). Such a call is refused by line; others are taken not to move the tool and
        not to change speed, tool or frame
    set : str | float | Sequence[str | float]
        Value of a name that only the controller knows (a signal, an input, a register), as in di1=1
        (repeat for more)
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
        ("--call", call),
        ("--set", set),
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
