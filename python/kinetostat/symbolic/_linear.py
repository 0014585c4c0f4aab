"""Linear systems of formulas, with pivots that are surely not zero."""

from __future__ import annotations

import random
from collections.abc import Sequence
from typing import Any, TypeAlias

import mpmath
import sympy as sp

__all__ = ["DIGITS", "Definitions", "UnsolvableError", "at_random", "numbers", "solved", "tidy"]

Definitions: TypeAlias = tuple[tuple[sp.Symbol, sp.Expr], ...]
"""Symbols that stand for intermediate results, each in terms of those before it."""

DIGITS = 80
"""Of numbers at which zero is decided."""

_ZERO = mpmath.mpf(10) ** -25


class UnsolvableError(Exception):
    """A singular system: holds a vector of numbers that it maps to zero, at the values at which zero was decided."""

    def __init__(self, null: list[Any]) -> None:
        super().__init__("singular")
        self.null = null


def at_random(symbols: set[sp.Symbol]) -> dict[sp.Symbol, sp.Rational]:
    """Values at which what is not zero is not zero, but for a chance of none."""
    source = random.Random(20)
    return {s: sp.Rational(source.randint(10**8, 10**9), 7 * 10**8) for s in sorted(symbols, key=str)}


def numbers(matrix: sp.Matrix, definitions: Definitions = ()) -> Any:
    """A matrix of formulas at random values, 80 digits."""
    known = {s for s, _ in definitions}
    free = set().union(matrix.free_symbols, *(e.free_symbols for _, e in definitions)) - known
    values = at_random(free)
    # Under names of ours: a symbol may be called as a function or a constant that the formulas use, sin or pi.
    ours = {s: sp.Symbol(f"_v{i}") for i, s in enumerate([*values, *(s for s, _ in definitions)])}
    matrix = matrix.xreplace(ours)
    definitions = tuple((ours[s], e.xreplace(ours)) for s, e in definitions)

    def steps(matrix: sp.Matrix) -> tuple[Any, Any]:
        return (definitions, matrix) if definitions else sp.cse(matrix, list=False)

    with mpmath.workdps(DIGITS):
        given = [mpmath.mpf(int(v.p)) / int(v.q) for v in values.values()]
        return mpmath.matrix(sp.lambdify([ours[s] for s in values], matrix, modules="mpmath", cse=steps)(*given))


def solved(matrix: sp.Matrix, right: sp.Matrix) -> sp.Matrix:
    """``matrix^-1 right`` by Gauss-Jordan, in lowest terms; whether a formula is zero is decided by its value at random numbers.

    Raises :class:`UnsolvableError` where the matrix is singular for all values of the symbols.
    """
    n = matrix.shape[0]
    work = matrix.row_join(right).as_mutable()
    with mpmath.workdps(DIGITS):
        # The same steps in numbers: a formula need not be looked at to know whether it is zero.
        value = numbers(sp.Matrix(work))
        order: list[int] = []
        for column in range(n):
            step = len(order)
            rows = [r for r in range(step, n) if abs(value[r, column]) > _ZERO]
            if not rows:
                null = [mpmath.mpf(0)] * n
                null[column] = mpmath.mpf(1)
                for r, c in enumerate(order):
                    null[c] = -value[r, column]
                raise UnsolvableError(null)
            best = min(rows, key=lambda r: (not work[r, column].is_Number, sp.count_ops(work[r, column]), -abs(value[r, column])))
            work.row_swap(step, best)
            _swap(value, step, best)
            _reduce(work, value, step, column)
            order.append(column)
    return sp.Matrix(work[:, n:])


def _swap(value: Any, i: int, j: int) -> None:
    for c in range(value.cols):
        value[i, c], value[j, c] = value[j, c], value[i, c]


def _reduce(work: sp.Matrix, value: Any, step: int, column: int) -> None:
    """One pivot: its row divided by it, its column cleared in all others."""
    pivot, size = work[step, column], value[step, column]
    there: Sequence[int] = [c for c in range(column, work.shape[1]) if work[step, c] != 0]
    for c in there:
        work[step, c] = tidy(work[step, c] / pivot) if c != column else sp.S.One
        value[step, c] = value[step, c] / size
    for r in range(work.shape[0]):
        factor, share = work[r, column], value[r, column]
        if r == step or factor == 0:
            continue
        for c in there:
            before, less = value[r, c], share * value[step, c]
            value[r, c] = before - less
            gone = c == column or abs(value[r, c]) <= _ZERO * max(abs(before), abs(less), 1)
            value[r, c] = mpmath.mpf(0) if gone else value[r, c]
            work[r, c] = sp.S.Zero if gone else tidy(work[r, c] - factor * work[step, c])


def tidy(entry: sp.Expr) -> sp.Expr:
    """A fraction in lowest terms."""
    return sp.cancel(sp.together(entry)) if entry != 0 else entry
