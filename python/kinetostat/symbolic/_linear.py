"""Linear systems of formulas, with pivots that are surely not zero."""

from __future__ import annotations

import random

import sympy as sp

__all__ = ["UnsolvableError", "at_random", "solved"]

_DIGITS = 40


class UnsolvableError(Exception):
    """A singular system: holds a vector that it maps to zero."""

    def __init__(self, null: sp.Matrix) -> None:
        super().__init__("singular")
        self.null = null


def at_random(matrix: sp.Matrix) -> dict[sp.Symbol, sp.Rational]:
    """Values at which what is not zero is not zero, but for a chance of none."""
    source = random.Random(20)
    return {s: sp.Rational(source.randint(10**8, 10**9), 7 * 10**8) for s in sorted(matrix.free_symbols, key=str)}


def _zero(entry: sp.Expr, values: dict[sp.Symbol, sp.Rational]) -> bool:
    return bool(entry == 0) or bool(abs(entry.subs(values).evalf(_DIGITS, maxn=400)) < sp.Float(10) ** -25)


def solved(matrix: sp.Matrix, right: sp.Matrix) -> sp.Matrix:
    """``matrix^-1 right`` by Gauss-Jordan; whether a formula is zero is decided by its value at random numbers of 40 digits.

    Raises :class:`UnsolvableError` where the matrix is singular for all values of the symbols.
    """
    n = matrix.shape[0]
    values = at_random(matrix.row_join(right))
    work = matrix.row_join(right).as_mutable()
    order: list[int] = []
    for column in range(n):
        step = len(order)
        rows = [r for r in range(step, n) if not _zero(work[r, column], values)]
        if not rows:
            null = sp.zeros(n, 1)
            null[column] = 1
            for r, c in enumerate(order):
                null[c] = -work[r, column]
            raise UnsolvableError(null)
        best = min(rows, key=lambda r: sp.count_ops(work[r, column]))
        work.row_swap(step, best)
        pivot = work[step, column]
        work[step, :] = (work[step, :] / pivot).applyfunc(_tidy)
        for r in range(n):
            factor = work[r, column]
            if r == step or factor == 0:
                continue
            for c in range(column, work.shape[1]):
                if work[step, c] != 0:
                    entry = _tidy(work[r, c] - factor * work[step, c])
                    work[r, c] = sp.S.Zero if _zero(entry, values) else entry
        order.append(column)
    return sp.Matrix(work[:, n:])


def _tidy(entry: sp.Expr) -> sp.Expr:
    return sp.cancel(sp.together(entry)) if entry != 0 else entry
