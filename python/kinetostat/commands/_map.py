"""``kinetostat map``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


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
        variable of --variables, as in margin, joint_efforts_2 or f1
    variables : str | float | Sequence[str | float]
        Further variables for the answer and the files, SI, with commas: stiffness_stiffest,
        rotational_stiffness_z, principal_stiffness, principal_directions, joint_efforts,
        effort_share, share_to_buckling, margin, singularity_distance, f1 to f6 (natural
        frequencies, Hz), ...; a wrong name lists all
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
