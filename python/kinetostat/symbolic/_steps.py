"""Formulas step by step: intermediate results that have names of their own."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from kinetostat.errors import ArgumentError
from kinetostat.symbolic._linear import Definitions
from kinetostat.symbolic._reciprocal import Reciprocal
from kinetostat.symbolic._substitution import by_name

__all__ = ["Steps", "expanded", "joined", "put_in", "symbols_of", "trimmed"]

_SHORT = 6
"""A step that is used once and has no more operations than this is written where it is used."""

_DIGITS = 30


class Steps:
    """Gives names to intermediate results."""

    def __init__(self, system: sp.Matrix) -> None:
        taken = {str(s.name) for s in system.free_symbols}
        self._names = (sp.Symbol(name, real=True) for name in (f"s{i}" for i in range(10**9)) if name not in taken)
        shared, (self.system,) = sp.cse(system, symbols=self._names)
        self._found: dict[sp.Expr, sp.Symbol] = {e: s for s, e in shared}

    @property
    def definitions(self) -> Definitions:
        """All so far, in order."""
        return tuple((s, e) for e, s in self._found.items())

    def kept(self, entry: sp.Expr) -> sp.Expr:
        """What stands for a new entry: itself where it is short, a name otherwise."""
        if entry.is_Symbol or entry.is_Number or (-entry).is_Symbol:
            return entry
        if entry not in self._found:
            self._found[entry] = next(self._names)
        return self._found[entry]


def symbols_of(matrix: sp.Matrix, definitions: Definitions) -> set[sp.Symbol]:
    """Symbols that are not defined."""
    everything = set().union(matrix.free_symbols, *(e.free_symbols for _, e in definitions))
    return everything - {s for s, _ in definitions}


def trimmed(matrix: sp.Matrix, definitions: Definitions) -> tuple[sp.Matrix, Definitions]:
    """Without steps that nothing needs; short ones that are used once stand where they are used; names count from 0 again."""
    uses: dict[sp.Symbol, int] = {}
    for entry in matrix:
        _count(entry, uses)
    for symbol, e in reversed(definitions):
        if symbol in uses:
            _count(e, uses)
    replaced: dict[sp.Symbol, sp.Expr] = {}
    names = [s for s, _ in definitions]
    found: list[tuple[sp.Symbol, sp.Expr]] = []
    for symbol, e in definitions:
        if symbol not in uses:
            continue
        new = e.xreplace(replaced)
        if uses[symbol] == 1 and sp.count_ops(new) <= _SHORT:
            replaced[symbol] = new
        else:
            replaced[symbol] = names[len(found)]
            found.append((names[len(found)], new))
    return matrix.xreplace(replaced), tuple(found)


def _count(entry: sp.Expr, uses: dict[sp.Symbol, int]) -> None:
    for node in sp.preorder_traversal(entry):
        if node.is_Symbol:
            uses[node] = uses.get(node, 0) + 1
        elif isinstance(node, Reciprocal):  # It is printed with its pivot twice.
            _count(node.args[0], uses)


def put_in(matrix: sp.Matrix, definitions: Definitions, values: Mapping[str | sp.Symbol, Any]) -> tuple[sp.Matrix, Definitions]:
    """With values for symbols; steps that become numbers are put in, too, with 30 digits."""
    found = by_name(symbols_of(matrix, definitions), values)
    # A value may contain a symbol with the name of a step: the steps give way.
    matrix, definitions = _renamed(matrix, definitions, {str(s.name) for v in found.values() for s in v.free_symbols})
    left: list[tuple[sp.Symbol, sp.Expr]] = []
    for symbol, e in definitions:
        _divides(e, found)
        new = e.xreplace(found)
        if new.is_number:
            # Exact numbers would grow into formulas from step to step.
            found[symbol] = new if new.is_Number else new.evalf(_DIGITS)
        else:
            left.append((symbol, new))
    if definitions:
        _divides(matrix, found)
    return matrix.xreplace(found), tuple(left)


def _divides(formula: sp.Basic, values: Mapping[sp.Symbol, sp.Expr]) -> None:
    """Refuses values at which steps divide by zero: they divide by stiffnesses, and by reciprocals that know when there is none."""
    for power in formula.atoms(sp.Pow):
        # Only what has become a number is asked: of a long formula the question alone takes minutes.
        base = power.base.xreplace(values) if power.exp.could_extract_minus_sign() else sp.S.One
        if base.is_Number and base.is_zero:
            raise ArgumentError(
                f"values makes {power.base} zero, and steps divide by it: make a spring without stiffness a passive joint, "
                "ask for the stiffness with wrench=[0] * 6, whose steps take single stiffnesses of zero, or without steps"
            )


def _renamed(matrix: sp.Matrix, definitions: Definitions, taken: set[str]) -> tuple[sp.Matrix, Definitions]:
    """Steps with other names where theirs are taken."""
    own = {str(s.name) for s in symbols_of(matrix, definitions)} | {str(s.name) for s, _ in definitions} | taken
    free = (name for name in (f"s{i}" for i in range(10**9)) if name not in own)
    names = {s: sp.Symbol(next(free), real=True) for s, _ in definitions if str(s.name) in taken}
    return matrix.xreplace(names), tuple((names.get(s, s), e.xreplace(names)) for s, e in definitions)


def joined(parts: Sequence[tuple[sp.Matrix, Definitions]]) -> tuple[list[sp.Matrix], Definitions]:
    """Several matrices with the steps of all."""
    matrices: list[sp.Matrix] = []
    together: Definitions = ()
    symbols = {str(s.name) for matrix, definitions in parts for s in symbols_of(matrix, definitions)}
    for matrix, definitions in parts:
        taken = symbols | {str(s.name) for s, _ in together}
        found, steps = _renamed(matrix, definitions, taken)
        matrices.append(found)
        together += steps
    return matrices, together


def expanded(matrix: sp.Matrix, definitions: Definitions) -> sp.Matrix:
    """All steps put in."""
    known: dict[sp.Symbol, sp.Expr] = {}
    for symbol, e in definitions:
        known[symbol] = e.xreplace(known)
    return matrix.xreplace(known)
