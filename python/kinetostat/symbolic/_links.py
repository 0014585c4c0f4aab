"""Links, legs and what passive joints do to them."""

from __future__ import annotations

from collections.abc import Sequence

import sympy as sp

from kinetostat._arguments import of_kind, refused, shown
from kinetostat.errors import ArgumentError
from kinetostat.symbolic._expression import Stiffness
from kinetostat.symbolic._given import formula, formulas
from kinetostat.symbolic._steps import joined

__all__ = ["beam", "hat", "in_parallel", "leg", "planar_beam", "with_passive_joint"]


def _positive(names: str) -> tuple[sp.Symbol, ...]:
    return tuple(sp.symbols(names, positive=True))


def hat(v: sp.Matrix) -> sp.Matrix:
    """Matrix of the cross product ``v x``."""
    return sp.Matrix([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def beam() -> Stiffness:
    """Cantilever along x, symmetric section, at its end [R 3.25, 3.26 corrected: K55 by I_y, K66 by I_z].

    Examples
    --------
    >>> k = beam().matrix
    >>> k[4, 4], k[5, 5]
    (4*E*I_y/L, 4*E*I_z/L)
    """
    E, G, A, L, y, z, j = _positive("E G A L I_y I_z J")
    k = sp.diag(E * A / L, 12 * E * z / L**3, 12 * E * y / L**3, G * j / L, 4 * E * y / L, 4 * E * z / L)
    k[2, 4] = k[4, 2] = 6 * E * y / L**2
    k[1, 5] = k[5, 1] = -6 * E * z / L**2
    return Stiffness(k)


def planar_beam() -> Stiffness:
    """Cantilever along x in the plane, directions x, y, rz [R Table 3.1].

    Examples
    --------
    >>> planar_beam().matrix[1, 1]
    12*E*I_z/L**3
    """
    whole = beam().matrix
    return Stiffness(whole.extract([0, 1, 5], [0, 1, 5]), ("x", "y", "rz"))


def with_passive_joint(link: Stiffness, joint: str | Sequence[sp.Expr]) -> Stiffness:
    """A link with one more passive joint: ``K - K j (j^T K j)^-1 j^T K`` [R 3.10, 3.16].

    Parameters
    ----------
    link : Stiffness
        What the joint is added to; may have passive joints already.
    joint : str or sequence
        Direction of a joint at the end (``"x"`` slides along x, ``"rz"`` turns about z), or its column of the Jacobian, in the
        order of ``link.directions``.

    Returns
    -------
    Stiffness
        Singular; its null space holds the joint's motion. A joint that the link does not resist already leaves it as it is and is
        named in ``redundant``.

    Raises
    ------
    ArgumentError
        For an unknown direction, a column of another length, or a link with steps.

    Examples
    --------
    >>> with_passive_joint(planar_beam(), "rz").matrix
    Matrix([
    [A*E/L,            0, 0],
    [    0, 3*E*I_z/L**3, 0],
    [    0,            0, 0]])
    """
    if of_kind("link", link, Stiffness, "a Stiffness of this module").definitions:
        raise ArgumentError("the link's stiffness has steps: add the passive joint to the chain instead, or use expanded()")
    if isinstance(joint, str):
        if joint not in link.directions:
            raise ArgumentError(f"joint is {shown(joint)}, expected one of {', '.join(link.directions)}")
        column = sp.Matrix([1 if d == joint else 0 for d in link.directions])
    else:
        column = formulas("joint", joint, len(link.directions))
    u = link.matrix * column
    left = link.matrix.T * column
    mu = sp.simplify((column.T * u)[0])
    if mu == 0:
        name = joint if isinstance(joint, str) else str(tuple(joint))
        return Stiffness(link.matrix, link.directions, (*link.redundant, name))
    return Stiffness((link.matrix - u * left.T / mu).applyfunc(sp.cancel), link.directions, link.redundant)


def leg(direction: Sequence[sp.Expr], stiffness: sp.Expr | str) -> Stiffness:
    """A leg between a universal and a spherical joint: it takes a force along itself only [R 3.29].

    Parameters
    ----------
    direction : sequence of 3
        From its foot to its head, any length, base axes.
    stiffness : symbol, number or str
        Along the leg, N/m.

    Examples
    --------
    >>> leg([0, 0, 2], "K11").matrix[2, 2]
    K11
    """
    u = formulas("direction", direction, 3)
    square = sp.expand((u.T * u)[0])
    if sp.simplify(square) == 0:
        raise ArgumentError(f"direction is {tuple(u)}, expected three numbers or formulas, not all zero")
    k = formula("stiffness", stiffness, positive=True)
    return Stiffness(sp.diag(k * u * u.T / sp.simplify(square), sp.zeros(3)))


def in_parallel(limbs: Sequence[Stiffness], arms: Sequence[Sequence[sp.Expr]]) -> Stiffness:
    """Unloaded limbs on one platform, ``sum T^T K T`` with ``T = [I, -(s x); 0, I]`` [R 3.13, arm corrected].

    Parameters
    ----------
    limbs : sequence of Stiffness
        At their ends, base axes, six directions. Forces in the limbs would add terms: they are unloaded here. Where a limb has steps
        the sum has the steps of all.
    arms : sequence of 3-vectors
        From the reference point to the end of each limb, m, base axes (the report's 3.33 prints the opposite).

    Raises
    ------
    ArgumentError
        Where the numbers of limbs and arms differ, or a limb is planar.

    Examples
    --------
    >>> pair = in_parallel([leg([0, 0, 1], "k")] * 2, [[1, 0, 0], [-1, 0, 0]])
    >>> pair.matrix[2, 2], pair.matrix[4, 4], pair.rank
    (2*k, 2*k, 2)
    """
    for name, each, expected in (("limbs", limbs, "a list of Stiffness"), ("arms", arms, "a list of three entries for each limb")):
        if isinstance(each, str) or not isinstance(each, Sequence):
            raise refused(name, each, expected)
    if len(limbs) != len(arms) or not limbs:
        raise ArgumentError(f"{len(limbs)} limbs and {len(arms)} arms: give one arm for each limb")
    for index, limb in enumerate(limbs):
        if of_kind(f"limbs[{index}]", limb, Stiffness, "a Stiffness of this module").matrix.shape != (6, 6):
            raise ArgumentError(f"limbs[{index}] has the directions {', '.join(limb.directions)}, expected all six")
    offsets = [formulas(f"arms[{index}]", arm, 3) for index, arm in enumerate(arms)]
    parts, definitions = joined([(limb.matrix, limb.definitions) for limb in limbs])
    total = sp.zeros(6)
    for part, arm in zip(parts, offsets, strict=True):
        t = sp.eye(6)
        t[:3, 3:] = -hat(arm)
        total += t.T * part * t
    return Stiffness(total if definitions else total.applyfunc(sp.simplify), definitions=definitions)
