"""Formulas as they are given: what is none is refused by the name of its argument."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

import sympy as sp

from kinetostat._arguments import refused, shown, text
from kinetostat.errors import ArgumentError

__all__ = ["formula", "formulas", "matrix", "values_by_name"]

_EXPECTED = "a formula of SymPy, a number, or text that names a symbol"
_SIGNS = frozenset("+-*/^()[]{}<>=,;!")
"""What formulas have, and names of symbols do not."""


def formula(name: str, value: Any, **assumed: bool) -> sp.Expr:
    """A formula as it is, or a symbol by its name, real unless something else is assumed of it."""
    if isinstance(value, str):
        symbol = text(name, value)
        if not symbol or symbol[0].isdigit() or set(symbol) & _SIGNS:
            raise ArgumentError(
                f"{name} is {shown(value)}, which is no name of a symbol: text names one symbol; write numbers as numbers, and formulas "
                "with SymPy, as in 2 * sympy.Symbol('L', real=True)"
            )
        return sp.Symbol(symbol, **(assumed or {"real": True}))
    try:
        found = sp.sympify(value, strict=True)
    except (sp.SympifyError, TypeError, ValueError, AttributeError, RecursionError):
        raise refused(name, value, _EXPECTED) from None
    if not isinstance(found, sp.Expr):
        raise refused(name, value, _EXPECTED)
    if found.has(sp.nan, sp.oo, -sp.oo, sp.zoo):
        raise ArgumentError(f"{name} is {shown(value)}: give finite numbers")
    return found


def formulas(name: str, value: Any, count: int) -> sp.Matrix:
    """So many formulas, as a column."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, (Iterable, sp.MatrixBase)):
        raise refused(name, value, f"{count} formulas, numbers or names of symbols")
    each = list(value)
    if len(each) != count:
        raise ArgumentError(f"{name} has {len(each)} entries, expected {count}")
    return sp.Matrix([formula(f"{name}[{index}]", entry) for index, entry in enumerate(each)])


def matrix(name: str, value: Any, shape: tuple[int, int] | None = None) -> sp.Matrix:
    """A matrix of formulas of a shape, or of any."""
    expected = f"a matrix of formulas or numbers{'' if shape is None else f', {shape}'}"
    if isinstance(value, (str, bytes, Mapping)):
        raise refused(name, value, expected)
    try:
        found = sp.Matrix(value)
    except (sp.SympifyError, TypeError, ValueError, AttributeError, RecursionError):
        raise refused(name, value, expected) from None
    if shape is not None and found.shape != shape:
        raise ArgumentError(f"{name} has shape {found.shape}, expected {shape}")
    if not all(isinstance(entry, sp.Expr) for entry in found):
        raise ArgumentError(f"{name} is {shown(value)}, expected {expected}")
    return found


def values_by_name(values: Any) -> Mapping[Any, Any]:
    """Values for symbols."""
    if not isinstance(values, Mapping):
        raise refused("values", values, "a dictionary of numbers or formulas by names of symbols")
    return values
