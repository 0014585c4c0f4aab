"""Stiffness at the end of a chain in steps, for all values of its symbols, special ones too.

Unloaded: with springs of any compliance ``w`` in the passive joints the end has the compliance ``W = C + w J_q J_q^T`` [R 3.7, 3.8], which
is positive definite wherever the end is held nowhere rigidly. Then each of these springs is taken away again: of the motions of the end
what is orthogonal to the joints (in the metric ``W^-1``) remains, whatever ``w`` was. A joint that moves only as those before it takes
nothing more away. In an equilibrium under loads the bordered system [R 4.26, 4.28] has no sign: its columns are made orthogonal.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Sequence
from typing import Any

import mpmath
import sympy as sp

from kinetostat.errors import ArgumentError
from kinetostat.symbolic._condensed import held_rigidly
from kinetostat.symbolic._elimination import ONE, ZERO, Arithmetic, Column, Entry, known
from kinetostat.symbolic._expression import Stiffness
from kinetostat.symbolic._linear import DIGITS, numbers
from kinetostat.symbolic._steps import Steps, trimmed

__all__ = ["Sprung", "loaded_in_steps", "unloaded_in_steps"]

_NONE = 1e-20
"""Smaller entries of a vector of numbers of 80 digits are zero."""


@dataclasses.dataclass(frozen=True)
class Sprung:
    """A chain as its end sees it."""

    name: str
    directions: tuple[str, ...]
    rows: Sequence[int]
    """Of the Jacobian, those of the directions."""
    jacobian: sp.Matrix
    """Motion of the end by all coordinates, six rows."""
    springs: Sequence[tuple[int, sp.Matrix]]
    """Stiffness of blocks of coordinates, each with its first one; the others are passive."""
    coordinates: Sequence[str]

    def rigid(self, null: Sequence[Any]) -> ArgumentError:
        """What is said where a wrench moves nothing."""
        return held_rigidly(self.name, [d for d, v in zip(self.directions, null, strict=False) if abs(v) > _NONE])

    def stiffness(self, steps: Steps, entry: Callable[[int, int], Entry], redundant: Sequence[str]) -> Stiffness:
        """From entries by row and column."""
        m = len(self.directions)
        matrix, definitions = trimmed(sp.Matrix(m, m, lambda i, j: entry(i, j).formula), steps.definitions)
        return Stiffness(matrix, self.directions, tuple(redundant), definitions=definitions)


class _Entries:
    """Jacobian, stiffness of the springs and Hessian as entries, with steps for what they share."""

    def __init__(self, chain: Sprung, hessian: sp.Matrix) -> None:
        n = len(chain.coordinates)
        stiffness = sp.zeros(n)
        for first, block in chain.springs:
            stiffness[first : first + block.shape[0], first : first + block.shape[0]] = block
        self.steps = Steps(chain.jacobian.col_join(stiffness).col_join(hessian))
        self.own = Arithmetic(self.steps.kept)
        value = numbers(self.steps.system, self.steps.definitions)
        rows = [[known(self.steps.system[i, j], value[i, j]) for j in range(n)] for i in range(value.rows)]
        self.jacobian, self.stiffness, self.hessian = rows[:6], rows[6 : 6 + n], rows[6 + n :]

    def column(self, rows: Sequence[int], coordinate: int) -> list[Entry]:
        """Motion of the end by a coordinate."""
        return [self.jacobian[r][coordinate] for r in rows]

    @staticmethod
    def part(direction: int) -> range:
        """Directions that a rotation of the axes makes of this one."""
        return range(3) if direction < 3 else range(3, 6)


def _null(last: int, above: Callable[[int, int], Entry]) -> list[Any]:
    """What a triangular matrix with ones on its diagonal maps to zero but for one entry; ``above(k, i)`` is its entry, ``k < i``."""
    found = [mpmath.mpf(0)] * last + [mpmath.mpf(1)]
    for k in reversed(range(last)):
        found[k] = -mpmath.fsum(above(k, i).value * found[i] for i in range(k + 1, last + 1))
    return found


def _unit(size: int, at: int) -> list[Entry]:
    return [ONE if i == at else ZERO for i in range(size)]


def unloaded_in_steps(chain: Sprung) -> Stiffness:
    """Without loads. At values at which the end is held rigidly somewhere its entries are infinite or no numbers."""
    with mpmath.workdps(DIGITS):
        entries = _Entries(chain, sp.zeros(0, len(chain.coordinates)))
        own, m = entries.own, len(chain.directions)
        compliance, columns = _apart(chain, entries)
        free = {i: column for i, column in enumerate(columns) if i not in compliance}
        count = max(len(compliance), 1)
        share = known(sp.Rational(1, count), mpmath.mpf(1) / count)
        weight = own.total((share, c) for c in compliance.values()) if compliance else ONE
        soft = [(column, compliance.get(i, weight)) for i, column in enumerate(columns)]
        whole = [[own.total((c[i], w, c[j]) for c, w in soft) for j in chain.rows] for i in chain.rows]
        sizes = [own.total((c[i], w, c[i]) for c, w in soft for i in entries.part(r)) for r in chain.rows]
        lower, metric = own.factored(whole, sizes)
        for i, g in enumerate(metric):
            if g.gone:
                raise chain.rigid(_null(i, lambda k, i: lower[i][k]))
        units = [own.forward(lower, _unit(m, i)) for i in range(m)]
        joints: list[tuple[Column, Entry]] = []
        redundant = []
        for i, column in free.items():
            moved = own.forward(lower, [column[r] for r in chain.rows])
            left, _ = own.without(moved, joints, metric)
            size = _size(entries, chain, column, [own.dot(u, metric, u) for u in units])
            square = own.square(left, moved, metric, size, sp.S.Zero)
            # It counts at values that make one of those before it redundant.
            joints.append((left, square))
            if not square.value:
                redundant.append(chain.coordinates[i])
        remain = [own.without(u, joints, metric)[0] for u in units]
        half = [[own.dot(remain[i], metric, remain[j]) for j in range(i + 1)] for i in range(m)]
        return chain.stiffness(entries.steps, lambda i, j: half[max(i, j)][min(i, j)], redundant)


def _size(entries: _Entries, chain: Sprung, column: Column, each: Column) -> Entry:
    """Of the square of a column, were it turned into the stiffest direction; ``each`` is that of a unit motion."""
    of = zip(chain.rows, each, strict=True)
    return entries.own.total((column[k], column[k], e) for r, e in of for k in entries.part(r))


def _apart(chain: Sprung, entries: _Entries) -> tuple[dict[int, Entry], list[Column]]:
    """Compliances of springs of one direction by their columns, and all columns; those without one are free.

    A spring of several directions is one of as many single ones along the factors of its stiffness.
    """
    own = entries.own
    columns: list[Column] = [entries.column(range(6), j) for j in range(len(chain.coordinates))]
    compliance: dict[int, Entry] = {}
    for first, block in chain.springs:
        size = block.shape[0]
        inner = [entries.stiffness[first + i][first : first + size] for i in range(size)]
        lower, reciprocals = own.factored(inner)
        if size == 1 and not inner[0][0].gone:
            reciprocals = [own.inverse(inner[0][0])]
        along = [own.forward(lower, [columns[first + i][r] for i in range(size)]) for r in range(6)]
        for i, reciprocal in enumerate(reciprocals):
            columns[first + i] = [along[r][i] for r in range(6)]
            if not reciprocal.gone:
                compliance[first + i] = reciprocal
    return compliance, columns


def loaded_in_steps(chain: Sprung, hessian: sp.Matrix) -> Stiffness:
    """In an equilibrium under loads with this Hessian. At values that make it singular its entries are infinite or no numbers."""
    redundant: list[str] = []
    moving = list(range(len(chain.coordinates)))
    with mpmath.workdps(DIGITS):
        entries = _Entries(chain, hessian)
        while True:
            found = _loaded(chain, entries, moving)
            if not isinstance(found, int):
                break
            redundant.append(chain.coordinates[moving.pop(found)])
    return chain.stiffness(entries.steps, lambda i, j: found[j][i], redundant)


def _loaded(chain: Sprung, entries: _Entries, moving: Sequence[int]) -> list[list[Entry]] | int:
    """Wrenches by unit motions of the end; or the first of the moving coordinates that nothing determines."""
    own, m, n = entries.own, len(chain.directions), len(moving)
    # Wrenches are counted in a stiffness, so that all entries are of one size.
    unit = own.total((entries.stiffness[i][i],) for i in moving)
    unit = ONE if unit.gone else unit
    per_unit = own.inverse(unit)

    def inner(i: int, j: int) -> Entry:
        return own.total([(entries.hessian[i][j], per_unit)], [(entries.stiffness[i][j], per_unit)])

    columns: list[Column] = [[*entries.column(chain.rows, j), *(inner(i, j) for i in moving)] for j in moving]
    sizes = [own.total((e, e) for e in entries.column(range(6), j)) for j in moving]
    for r in chain.rows:
        columns.append([*_unit(m, m), *(entries.jacobian[r][j] for j in moving)])
        sizes.append(own.total((entries.jacobian[k][j],) * 2 for j in moving for k in entries.part(r)))
    ones = [ONE] * (m + n)
    orthogonal: list[tuple[Column, Entry]] = []
    shares: list[list[Entry]] = []
    for at, (column, size) in enumerate(zip(columns, sizes, strict=True)):
        left, share = own.without(column, orthogonal, ones)
        square = own.square(left, column, ones, size, sp.oo)
        shares.append(share)
        if not square.value and at < n:
            return at
        if not square.value:
            raise chain.rigid(_null(at, lambda k, i: shares[i][k])[n:])
        orthogonal.append((left, square))
    found = []
    for r in range(m):
        _, right = own.without(_unit(m + n, r), orthogonal, ones)
        wrench: dict[int, Entry] = {}
        for k in reversed(range(n, n + m)):
            wrench[k] = own.total([(right[k],)], [(shares[i][k], wrench[i]) for i in range(k + 1, n + m)])
        found.append([own.total([(unit, wrench[n + i])]) for i in range(m)])
    return found
