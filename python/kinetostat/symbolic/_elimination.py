"""Elimination whose pivots vanish only where the system is singular: squares of what is left, in steps that have names.

A pivot chosen because it is not zero for general values may be zero at special ones, although the system is regular there. Pivots of
a positive definite matrix, and squares of columns that are made orthogonal, are not.
"""

from __future__ import annotations

import dataclasses
import random
from collections.abc import Callable, Iterable, Sequence
from typing import Any

import mpmath
import sympy as sp

from kinetostat.symbolic._reciprocal import Reciprocal

__all__ = ["ONE", "ZERO", "Arithmetic", "Column", "Entry", "known"]

_NOTHING = mpmath.mpf(10) ** -25
"""What is left of numbers of 80 digits below this share of them is zero."""

_ROUNDING = sp.Float("1e-12")
"""What is left of doubles below this share of them is rounding; of sums of squares, below its square."""


@dataclasses.dataclass(frozen=True)
class Entry:
    """A formula, and its value at random numbers: it need not be looked at to know whether it is zero."""

    formula: sp.Expr
    value: Any
    loose: Any
    """The same with any numbers in place of reciprocals that special values may replace by zero: what cancels only with these is kept."""

    @property
    def gone(self) -> bool:
        """Zero for all values of the symbols."""
        return bool(self.formula == 0)


def known(formula: sp.Expr, value: Any) -> Entry:
    """What no special value replaces."""
    return Entry(formula, value, value)


ZERO = known(sp.S.Zero, mpmath.mpf(0))
ONE = known(sp.S.One, mpmath.mpf(1))
SMALL = known(_ROUNDING, mpmath.mpf(10) ** -12)
Column = Sequence[Entry]


@dataclasses.dataclass(frozen=True)
class Arithmetic:
    """Computes with entries; what comes out gets a name by ``kept``."""

    kept: Callable[[sp.Expr], sp.Expr]
    source: random.Random = dataclasses.field(default_factory=lambda: random.Random(30))

    def total(self, products: Iterable[tuple[Entry, ...]], less: Iterable[tuple[Entry, ...]] = ()) -> Entry:
        """Sum of products, less others."""
        terms = [(sign, p) for sign, part in ((1, products), (-1, less)) for p in part if not any(e.gone for e in p)]
        if not terms:
            return ZERO
        loose = [sign * mpmath.fprod(e.loose for e in p) for sign, p in terms]
        if abs(mpmath.fsum(loose)) <= _NOTHING * max(map(abs, loose)):
            return ZERO
        value = mpmath.fsum(sign * mpmath.fprod(e.value for e in p) for sign, p in terms)
        formula = sp.Add(*(sign * sp.Mul(*(e.formula for e in p)) for sign, p in terms))
        return Entry(self.kept(formula), value, mpmath.fsum(loose))

    def dot(self, a: Column, weights: Column, b: Column) -> Entry:
        """Weighted product of columns."""
        return self.total(zip(a, weights, b, strict=True))

    def inverse(self, entry: Entry) -> Entry:
        """Of what is not zero at any value that is admitted."""
        return known(self.kept(1 / entry.formula), 1 / entry.value)

    def reciprocal(self, pivot: Entry, whole: Entry, otherwise: sp.Expr, *, share: sp.Expr = _ROUNDING) -> Entry:
        """Of what is left of a whole, with the value zero where that is nothing for general values of the symbols."""
        if pivot.gone:
            return ZERO
        formula = self.kept(Reciprocal(pivot.formula, whole.formula, share, otherwise))
        value = mpmath.mpf(0) if abs(pivot.value) <= _NOTHING * abs(whole.value) else 1 / pivot.value
        return Entry(formula, value, value if otherwise != 0 else mpmath.mpf(self.source.randint(10**8, 10**9)) / 7e8)

    def factored(self, matrix: Sequence[Column], sizes: Column | None = None) -> tuple[list[list[Entry]], list[Entry]]:
        """``L D L^T`` of a symmetric positive semidefinite matrix: rows of ``L``, and reciprocals of ``D``.

        A pivot that is zero for all values has the reciprocal zero: its direction is left out. At values that make another one zero
        its reciprocal is infinite. Entries of the diagonal are sums of squares of numbers whose own squares are of these ``sizes``.
        """
        lower: list[list[Entry]] = []
        reciprocals: list[Entry] = []
        for i, row in enumerate(matrix):
            rests: list[Entry] = []
            own: list[Entry] = []
            for j in range(i):
                rests.append(self.total([(row[j],)], zip(rests, lower[j], strict=True)))
                own.append(self.total([(rests[j], reciprocals[j])]))
            pivot = self.total([(row[i],)], zip(rests, own, strict=True))
            whole = row[i] if sizes is None else self.total([(row[i],), (SMALL, sizes[i])])
            found = self.reciprocal(pivot, whole, sp.oo)
            reciprocals.append(found if found.value and found.formula != sp.oo else ZERO)
            lower.append(own)
        return lower, reciprocals

    def forward(self, lower: Sequence[Column], column: Column) -> list[Entry]:
        """``L^-1`` times a column; ``L`` has ones on its diagonal, which are not stored."""
        found: list[Entry] = []
        for own, entry in zip(lower, column, strict=True):
            found.append(self.total([(entry,)], zip(own, found, strict=True)))
        return found

    def square(self, left: Column, column: Column, weights: Column, size: Entry, otherwise: sp.Expr) -> Entry:
        """Reciprocal of the square of what is left of a column; of numbers as large as the square root of ``size``."""
        whole = self.total([(self.dot(column, weights, column),), (size,)])
        return self.reciprocal(self.dot(left, weights, left), whole, otherwise, share=_ROUNDING**2)

    def without(self, column: Column, others: Iterable[tuple[Column, Entry]], weights: Column) -> tuple[list[Entry], list[Entry]]:
        """What of a column is orthogonal to others, which are so to each other, and its shares in these (modified Gram-Schmidt).

        Each of the others comes with the reciprocal of its square.
        """
        left, shares = list(column), []
        for other, reciprocal in others:
            shares.append(self.total([(self.dot(other, weights, left), reciprocal)]))
            left = [self.total([(e,)], [(shares[-1], o)]) for e, o in zip(left, other, strict=True)]
        return left, shares
