"""Programs that cut where they should: typed answers of ``compensate`` [R chapter 7]."""

from __future__ import annotations

import dataclasses
import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import commands
from kinetostat._arguments import or_none
from kinetostat._arguments import path as file_path
from kinetostat._arrays import Floats, positive
from kinetostat._asking import bare, handed_on, no_option_of, numbers_or_nan, triple, wrenches
from kinetostat._running import arguments

if TYPE_CHECKING:
    from kinetostat.machine import Machine

__all__ = ["CompensatedProgram", "compensate"]


@dataclasses.dataclass(frozen=True, eq=False)
class CompensatedProgram:
    """A compensated program; arrays have one row for each point at which the machine was solved.

    Examples
    --------
    >>> import os, tempfile
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     source, target = os.path.join(folder, "in.ngc"), os.path.join(folder, "out.ngc")
    ...     with open(source, "w") as file:
    ...         _ = file.write("G21 G90 G0 X0 Y0 Z5 G1 Z-1 F300 G1 X50 M2".replace(" G", chr(10) + "G"))
    ...     found = ks.Machine.preset("orthoglide").compensate(source, target, force=[100, 0, 0])
    >>> found.error_before.shape == found.error_after.shape == (len(found.line), 3)
    True
    """

    within_tolerance: bool
    """Whether the error after compensation, measured on the written program, is within what is allowed."""
    position: Floats
    """(n, 3): of the tool's tip in the program, m, part axes."""
    error_before: Floats
    """(n, 3): m, part axes."""
    error_after: Floats
    """(n, 3): m, part axes."""
    correction: Floats
    """(n, 3): m, part axes."""
    wrench: Floats
    """(n, 6): on the tool, N, N m."""
    line: NDArray[np.int64]
    """(n,): line of the program."""
    stable: NDArray[np.bool_]
    """(n,)"""
    stiffness: Floats
    """(n,): smallest against a force, N/m."""
    warnings: tuple[str, ...]
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""


def compensate(
    machine: Machine,
    program: str | os.PathLike[str],
    out: str | os.PathLike[str],
    *,
    force: ArrayLike | None = None,
    moment: ArrayLike | None = None,
    part_origin: ArrayLike | None = None,
    tolerance: float | None = None,
    **options: Any,
) -> CompensatedProgram:
    r"""Writes a program that cuts where it should, and measures its error.

    Parameters
    ----------
    machine : Machine
        With any tool or none.
    program, out : path
        Program to read, and file to write.
    force, moment : array_like, shape (3,), optional
        On the tool on feed moves, N and N m, base axes.
    part_origin : array_like, shape (3,), optional
        Where the program's zero point lies in the base, m.
    tolerance : float, optional
        Largest error after compensation, m.
    **options
        Everything else as for :func:`kinetostat.commands.compensate`.

    Returns
    -------
    CompensatedProgram

    Warns
    -----
    ToleranceMissedWarning
        The program was written, but misses the tolerance.

    Examples
    --------
    >>> import os, tempfile
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     source, target = os.path.join(folder, "in.ngc"), os.path.join(folder, "out.ngc")
    ...     with open(source, "w") as file:
    ...         _ = file.write("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X50\nM2\n")
    ...     found = compensate(ks.Machine.preset("orthoglide"), source, target, force=[100, 0, 0], part_origin=[0, 0, 0])
    >>> found.within_tolerance, bool(np.abs(found.error_after).max() < 0.2 * np.abs(found.error_before).max())
    (True, True)
    """
    import tempfile

    no_option_of(
        options,
        part_origin_mm="part_origin, m",
        tolerance_um="tolerance, m",
        tool_length_mm="a machine with its tool, as machine.with_tool(length=0.1) makes one, m",
        model="the machine itself",
    )
    model, length = bare(machine)
    program, out = file_path("program", program), file_path("out", out)
    largest = or_none(positive, "tolerance", tolerance)
    # A job names its model by a file.
    with tempfile.TemporaryDirectory(prefix="kinetostat-") as folder:
        path = os.path.join(folder, "model.toml")
        with open(path, "w", encoding="utf-8", newline="\n") as file:
            file.write(model.text)
        own = {
            "model": path,
            "program": program,
            "out": out,
            "tool_length_mm": length,
            "force": triple("force", force),
            "moment": triple("moment", moment),
            "part_origin_mm": triple("part_origin", part_origin, 1e3),
            "tolerance_um": None if largest is None else 1e6 * largest,
        }
        with arguments(part_origin_mm="part_origin (in mm)", tolerance_um="tolerance (in um)"):
            answer = commands.compensate(**handed_on(own, {"all_points": True, "points": os.path.join(folder, "points.csv")} | options))
    points = answer["points"]

    def vectors(key: str) -> Floats:
        return np.array([p[key] for p in points], dtype=float).reshape(-1, 3) * 1e-3

    return CompensatedProgram(
        within_tolerance=bool(answer["tolerance"]["held"]),
        position=vectors("position_mm"),
        error_before=vectors("error_before_mm"),
        error_after=vectors("error_after_mm"),
        correction=vectors("correction_mm"),
        wrench=wrenches(points),
        line=np.array([p["line"] for p in points], dtype=np.int64),
        stable=np.array([p["stable"] for p in points], dtype=bool),
        stiffness=1e3 * numbers_or_nan([p["smallest_stiffness_n_per_mm"] for p in points]),
        warnings=tuple(w["message"] for w in answer["warnings"]),
        answer=answer,
    )
