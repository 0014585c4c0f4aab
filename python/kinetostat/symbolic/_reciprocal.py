"""The reciprocal of a pivot, which knows when there is none: as a function of SymPy, and in every language that is printed."""

from __future__ import annotations

from typing import Any

import sympy as sp

__all__ = ["Reciprocal"]

_DIGITS = 30


class Reciprocal(sp.Function):  # type: ignore[misc]
    """``1/pivot``; ``otherwise`` where the pivot is no more than a ``share`` of the ``whole`` that it is a remainder of.

    A remainder that vanishes at some values of the symbols is rounding there, and its reciprocal a large number that means nothing.
    """

    nargs = 4

    @classmethod
    def eval(cls, pivot: sp.Expr, whole: sp.Expr, share: sp.Expr, otherwise: sp.Expr) -> sp.Expr | None:
        """A number where all is known."""
        if not (pivot.is_number and whole.is_number):
            return None
        if pivot.has(sp.nan, sp.zoo, sp.oo) or whole.has(sp.nan, sp.zoo, sp.oo):
            return sp.nan
        nothing = abs(pivot.evalf(_DIGITS)) <= share * abs(whole.evalf(_DIGITS))
        return otherwise if nothing else 1 / pivot

    def fdiff(self, argindex: int = 1) -> sp.Expr:
        """Where there is a reciprocal: minus its square."""
        return -(self**2) if argindex == 1 else sp.S.Zero

    def _printed(self, printer: Any, form: str) -> str:
        pivot, whole, share, otherwise = (printer._print(a) for a in self.args)
        return form.format(pivot=pivot, whole=whole, share=share, otherwise=otherwise)

    def _ccode(self, printer: Any) -> str:
        return self._printed(printer, "(fabs({pivot}) <= {share}*fabs({whole}) ? {otherwise} : 1.0/({pivot}))")

    def _rust_code(self, printer: Any) -> str:
        return self._printed(printer, "(if ({pivot}).abs() <= {share}*({whole}).abs() {{ {otherwise} }} else {{ 1.0/({pivot}) }})")

    def _pythoncode(self, printer: Any) -> str:
        return self._printed(printer, "({otherwise} if abs({pivot}) <= {share}*abs({whole}) else 1/({pivot}))")

    _mpmathcode = _pythoncode

    def _numpycode(self, printer: Any) -> str:
        where = printer._module_format("numpy.where")
        nothing = "abs({pivot}) <= {share}*abs({whole})"
        # Both sides are evaluated: the other one must not divide by zero.
        return self._printed(printer, f"{where}({nothing}, {{otherwise}}, 1/{where}({nothing}, 1.0, {{pivot}}))")

    def _latex(self, printer: Any, exp: str | None = None) -> str:
        form = (
            r"\begin{{cases}} {otherwise} & \text{{for}}\: \left|{pivot}\right| \leq {share} \left|{whole}\right| \\"
            r" \frac{{1}}{{{pivot}}} & \text{{otherwise}} \end{{cases}}"
        )
        own = self._printed(printer, form)
        return own if exp is None else rf"\left({own}\right)^{{{exp}}}"
