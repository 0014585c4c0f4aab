"""Values for symbols by their names: SymPy takes symbols of one name and other assumptions for others, and changes nothing then."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import sympy as sp

from kinetostat._arguments import refused
from kinetostat.errors import ArgumentError
from kinetostat.symbolic._given import formula as formula_given
from kinetostat.symbolic._given import values_by_name

__all__ = ["by_name", "substitute"]


def substitute(expression: Any, values: Mapping[str | sp.Symbol, Any]) -> Any:
    """A formula or a matrix of formulas with values for symbols, which may be given by their names.

    ``expression.subs({"k": 2})`` of SymPy itself changes nothing where ``k`` is a positive or a real symbol, as those of this package
    are: there ``"k"`` is another symbol. Here names count.

    Parameters
    ----------
    expression : sympy.Expr or sympy.Matrix
        Any formula, as ``chain.end`` or ``chain.stiffness().matrix``.
    values : mapping of str or sympy.Symbol
        Numbers, formulas, or text that names a (real) symbol. All are put in at once: ``{"a": "b", "b": "a"}`` swaps.

    Returns
    -------
    sympy.Expr or sympy.Matrix

    Raises
    ------
    ArgumentError
        A name that the formula does not have (of symbols, such as those of :attr:`NamedChain.values`, there may be more), a symbol
        that is given twice with different values, or a key of another kind.

    Examples
    --------
    >>> from kinetostat.symbolic import beam
    >>> substitute(beam().matrix[0, 0], {"E": 210e9, "A": "a", "L": 1})
    210000000000.0*a
    """
    if not isinstance(expression, (sp.Expr, sp.MatrixBase)):
        raise refused("expression", expression, "a formula or a matrix of formulas of SymPy")
    return expression.subs(by_name(expression.free_symbols, values), simultaneous=True)


def by_name(symbols: set[sp.Symbol], values: Mapping[str | sp.Symbol, Any]) -> dict[sp.Symbol, sp.Expr]:
    """The values by the symbols that have the names; refuses as :func:`substitute` does."""
    there: dict[str, list[sp.Symbol]] = {}
    for symbol in symbols:
        there.setdefault(str(symbol.name), []).append(symbol)
    found: dict[sp.Symbol, sp.Expr] = {}
    for key, value in values_by_name(values).items():
        if not isinstance(key, (str, sp.Symbol)):
            raise refused("a key of values", key, "a name or a symbol")
        name = key if isinstance(key, str) else str(key.name)
        if isinstance(key, str) and name not in there:
            known = ", ".join(sorted(there)) or "none"
            raise ArgumentError(f"the formula has no symbol {name!r}; its symbols are {known}")
        formula = formula_given(f"values[{name!r}]", value)
        for symbol in there.get(name, []):
            if found.get(symbol, formula) != formula:
                raise ArgumentError(f"{name!r} is given twice: {found[symbol]} and {formula}")
            found[symbol] = formula
    return found
