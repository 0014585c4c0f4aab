"""``kinetostat import``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any, Literal

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def import_urdf(
    file: _Path,
    *,
    base: str | float | None = None,
    tip: str | float | None = None,
    flange_z: Literal["x", "y", "z"] | None = None,
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
    flange_z : Literal["x", "y", "z"]
        Axis of the tip link that points out of the flange, where tools lie: x of `flange` in ROS, z
        of `tool0`; without it, the frame of the tip is taken as it is
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
        ("--flange-z", flange_z),
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
