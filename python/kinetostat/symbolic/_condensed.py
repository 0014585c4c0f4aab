"""Stiffness at the end of a chain from its bordered system [R 4.26, 4.28]."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence

import sympy as sp

from kinetostat.errors import ArgumentError
from kinetostat.symbolic._expression import Stiffness
from kinetostat.symbolic._linear import UnsolvableError, solved

__all__ = ["Bordered", "condensed", "held_rigidly"]

_NOTHING = 1e-20
"""Smaller entries of a null vector of numbers of 80 digits are zero."""


@dataclasses.dataclass(frozen=True)
class Bordered:
    """``[corner J; J^T -inner]``: wrench on the end and motion of the coordinates, by the motion of the end."""

    corner: sp.Matrix
    jacobian: sp.Matrix
    inner: sp.Matrix
    names: list[str]
    """Of the coordinates: the columns of the Jacobian."""

    @property
    def matrix(self) -> sp.Matrix:
        """The whole."""
        return self.corner.row_join(self.jacobian).col_join(self.jacobian.T.row_join(-self.inner))

    def without(self, coordinate: int) -> Bordered:
        """The same with one coordinate held."""
        keep = [i for i in range(len(self.names)) if i != coordinate]
        jacobian = self.jacobian.extract(list(range(self.jacobian.shape[0])), keep)
        return Bordered(self.corner, jacobian, self.inner.extract(keep, keep), [self.names[i] for i in keep])


def held_rigidly(chain: str, directions: Sequence[str]) -> ArgumentError:
    """What is said of an end that is held rigidly along a combination of directions."""
    told = f"{chain}: held rigidly along a combination of {', '.join(directions)}: the stiffness there is infinite"
    return ArgumentError(f"{told}; leave such directions out, or give the chain the spring that is missing")


def condensed(chain: str, system: Bordered, directions: tuple[str, ...]) -> Stiffness:
    """First block of the inverse in lowest terms, redundant coordinates held: held or not, they do not change the stiffness."""
    n, redundant = len(directions), []
    while True:
        try:
            matrix = solved(system.matrix, _units(system.matrix.shape[0], n))[:n, :].applyfunc(sp.simplify)
        except UnsolvableError as singular:
            force = [d for d, f in zip(directions, singular.null[:n], strict=True) if abs(f) > _NOTHING]
            if force:
                raise held_rigidly(chain, force) from None
            drop = [i for i, x in enumerate(singular.null[n:]) if abs(x) > _NOTHING][-1]
            redundant.append(system.names[drop])
            system = system.without(drop)
            continue
        return Stiffness(matrix, directions, tuple(reversed(redundant)))


def _units(size: int, n: int) -> sp.Matrix:
    return sp.eye(n).col_join(sp.zeros(size - n, n))
