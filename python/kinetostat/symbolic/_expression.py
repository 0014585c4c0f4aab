"""A matrix of formulas: shown, printed as code, evaluated."""

from __future__ import annotations

import dataclasses
import keyword
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import sympy as sp
from sympy.printing.rust import RustCodePrinter

from kinetostat.errors import ArgumentError
from kinetostat.symbolic._substitution import substitute

__all__ = ["Formula", "Stiffness"]

_C = """auto break case char const continue default do double else enum extern float for goto if inline int long register restrict return
short signed sizeof static struct switch typedef union unsigned void volatile while _Alignas _Alignof _Atomic _Bool _Complex _Generic
_Imaginary _Noreturn _Static_assert _Thread_local asm typeof linux unix i386 NAN INFINITY HUGE_VAL HUGE_VALF HUGE_VALL"""
_MATH_H = """acos acosh asin asinh atan atan2 atanh cbrt ceil copysign cos cosh erf erfc exp exp2 expm1 fabs fdim floor fma fmax fmin fmod
frexp hypot ldexp lgamma log log10 log1p log2 modf pow remainder round signbit sin sinh sqrt tan tanh tgamma trunc
M_E M_LOG2E M_LOG10E M_LN2 M_LN10 M_PI M_PI_2 M_PI_4 M_1_PI M_2_PI M_2_SQRTPI M_SQRT2 M_SQRT1_2"""
_RUST = """as async await break const continue crate dyn else enum extern false fn for gen if impl in let loop match mod move mut pub ref
return self Self static struct super trait true type unsafe use where while abstract become box do final macro override priv try typeof
unsized virtual yield Some Ok Err _"""
_KEYWORDS = frozenset([*keyword.kwlist, "math", "abs", "max", "min", "out", *f"{_C} {_MATH_H} {_RUST}".split()])
"""What no printed language takes as a name; one set for all, so that arguments are called the same in each."""


_OfFormulas = TypeVar("_OfFormulas", bound="Formula")


@dataclasses.dataclass(frozen=True)
class Formula:
    """A matrix of formulas with what can be done with it.

    Examples
    --------
    >>> import sympy as sp
    >>> k = sp.Symbol("k", positive=True)
    >>> Formula(sp.Matrix([[k, 0], [0, 2 * k]])).lambdify()(3.0)
    array([[3., 0.],
           [0., 6.]])
    """

    matrix: sp.Matrix
    """The formulas, SI units. Its own ``subs`` does not find symbols by their names: use :meth:`subs`."""

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """Its symbols in alphabetic order: the order of the arguments of printed functions."""
        return tuple(sorted(self.matrix.free_symbols, key=lambda s: str(s.name)))

    def subs(self: _OfFormulas, values: Mapping[str | sp.Symbol, Any]) -> _OfFormulas:
        """The same with values for symbols, by their names or as symbols; see :func:`kinetostat.symbolic.substitute`.

        Raises
        ------
        ArgumentError
            A name that the formulas do not have.

        Examples
        --------
        >>> import sympy as sp
        >>> k = sp.Symbol("k", positive=True)
        >>> Formula(sp.Matrix([[k, 0], [0, 2 * k]])).subs({"k": 3}).matrix
        Matrix([
        [3, 0],
        [0, 6]])
        """
        return dataclasses.replace(self, matrix=substitute(self.matrix, values))

    def simplified(self) -> Formula:
        """The same with every entry simplified by SymPy.

        Examples
        --------
        >>> import sympy as sp
        >>> x = sp.Symbol("x")
        >>> Formula(sp.Matrix([sp.sin(x) ** 2 + sp.cos(x) ** 2])).simplified().matrix
        Matrix([[1]])
        """
        return dataclasses.replace(self, matrix=self.matrix.applyfunc(sp.simplify))

    def latex(self) -> str:
        r"""The matrix in LaTeX.

        Examples
        --------
        >>> import sympy as sp
        >>> "frac" in Formula(sp.Matrix([sp.Symbol("k") / 2])).latex()
        True
        """
        return str(sp.latex(self.matrix))

    def _steps(self) -> tuple[list[tuple[sp.Symbol, sp.Expr]], list[sp.Expr], dict[sp.Symbol, sp.Symbol]]:
        taken = {str(s.name) for s in self.symbols}
        plain: dict[sp.Symbol, sp.Symbol] = {}
        used: set[str] = set()
        for symbol in self.symbols:
            name = "".join(c if c.isascii() and (c.isalnum() or c == "_") else "_" for c in str(symbol.name))
            if name[:1].isdigit() or not name:
                name = f"v_{name}"
            while name in used or name in _KEYWORDS:
                name += "_"
            used.add(name)
            plain[symbol] = sp.Symbol(name, real=True)
        names = (sp.Symbol(f"t{i}", real=True) for i in range(10**6) if f"t{i}" not in used | taken)
        steps, entries = sp.cse(list(self.matrix.xreplace(plain)), symbols=names)
        return steps, list(entries), plain

    def c(self, name: str = "stiffness") -> str:
        """A C99 function ``void name(double a, ..., double *out)``; ``out`` takes the entries row by row.

        A symbol whose name is a word of C, Rust or Python, or a function of their mathematics, gets ``_`` behind it in all three.

        Examples
        --------
        >>> import sympy as sp
        >>> print(Formula(sp.Matrix([sp.Symbol("k") * 2])).c("twice"))
        #include <math.h>
        <BLANKLINE>
        void twice(double k, double *out) {
            out[0] = 2*k;
        }
        """
        steps, entries, plain = self._steps()
        arguments = ", ".join([*(f"double {s}" for s in plain.values()), "double *out"])
        lines = [f"    const double {s} = {sp.ccode(e)};" for s, e in steps]
        lines += [f"    out[{i}] = {sp.ccode(e)};" for i, e in enumerate(entries)]
        return "\n".join(["#include <math.h>", "", f"void {name}({arguments}) {{", *lines, "}"])

    def rust(self, name: str = "stiffness") -> str:
        """A Rust function ``pub fn name(a: f64, ...) -> [f64; n]``: the entries row by row.

        Examples
        --------
        >>> import sympy as sp
        >>> "-> [f64; 1]" in Formula(sp.Matrix([sp.Symbol("k") * 2])).rust()
        True
        """
        steps, entries, plain = self._steps()
        arguments = ", ".join(f"{s}: f64" for s in plain.values())
        lines = [f"    let {s}: f64 = {_rust(e)};" for s, e in steps]
        lines += ["    [", *(f"        {_rust(e)}," for e in entries), "    ]"]
        head = "#[allow(non_snake_case, unused_parens)]"
        return "\n".join([head, f"pub fn {name}({arguments}) -> [f64; {len(entries)}] {{", *lines, "}"])

    def python(self, name: str = "stiffness") -> str:
        """A Python function over ``math`` that returns the rows as lists.

        Examples
        --------
        >>> import sympy as sp
        >>> space = {}
        >>> exec(Formula(sp.Matrix([sp.cos(sp.Symbol("q"))])).python("f"), space)
        >>> space["f"](0.0)
        [[1.0]]
        """
        steps, entries, plain = self._steps()
        wide = self.matrix.shape[1]
        lines = [f"    {s} = {sp.pycode(e)}" for s, e in steps]
        rows = [", ".join(sp.pycode(e) for e in entries[i : i + wide]) for i in range(0, len(entries), wide)]
        lines += ["    return [", *(f"        [{row}]," for row in rows), "    ]"]
        return "\n".join(["import math", "", "", f"def {name}({', '.join(map(str, plain.values()))}):", *lines, ""])

    def lambdify(self, arguments: Sequence[sp.Symbol | str] | None = None) -> Callable[..., Any]:
        """A numpy function of numbers, in the order of ``arguments`` (else of :attr:`symbols`), that returns the matrix.

        Raises
        ------
        ArgumentError
            Where a symbol of the matrix is missing in ``arguments``.

        Examples
        --------
        >>> import sympy as sp
        >>> Formula(sp.Matrix([sp.Symbol("k") * sp.Symbol("a")])).lambdify(["k", "a"])(2.0, 3.0)
        array([[6.]])
        """
        by_name = {str(s.name): s for s in self.symbols}
        order = list(self.symbols) if arguments is None else [by_name.get(str(a), sp.Symbol(str(a))) for a in arguments]
        missing = [name for name, s in by_name.items() if s not in order]
        if missing:
            raise ArgumentError(f"arguments leaves out {', '.join(missing)}")
        function: Callable[..., Any] = sp.lambdify(order, self.matrix, modules="numpy", cse=True)
        return function


class _RustPrinter(RustCodePrinter):  # type: ignore[misc]
    """SymPy's printer drops the parentheses of a sum within a product (seen in 1.14): sums and products always have them here."""

    def _print_Add(self, expr: sp.Expr, order: object = None) -> str:  # noqa: N802
        return f"({super()._print_Add(expr, order)})"

    def _print_Mul(self, expr: sp.Expr) -> str:  # noqa: N802
        return f"({super()._print_Mul(expr)})"


def _rust(expression: sp.Expr) -> str:
    # Floats everywhere but in exponents: Rust has no arithmetic between integers and f64.
    decimal = sp.sympify(expression).evalf(17)
    text = _RustPrinter().doprint(decimal)
    return f"{text}.0" if text.lstrip("-").isdigit() else str(text)


@dataclasses.dataclass(frozen=True)
class Stiffness(Formula):
    """Cartesian stiffness, and what of it is no number.

    Examples
    --------
    >>> from kinetostat.symbolic import Chain
    >>> chain = Chain("strut").spring("u", "prismatic", "x", stiffness="k")
    >>> chain.stiffness(directions=("x",)).matrix
    Matrix([[k]])
    """

    directions: tuple[str, ...] = ("x", "y", "z", "rx", "ry", "rz")
    """Rows and columns."""
    redundant: tuple[str, ...] = ()
    """Passive joints that turn or slide without the end moving, with the others; they do not change the stiffness."""

    @property
    def null_space(self) -> list[sp.Matrix]:
        """Motions of the end without resistance, a basis (columns in the order of :attr:`directions`).

        Empty for a regular matrix.

        Examples
        --------
        >>> from kinetostat.symbolic import planar_beam, with_passive_joint
        >>> with_passive_joint(planar_beam(), "x").null_space
        [Matrix([
        [1],
        [0],
        [0]])]
        """
        return list(self.matrix.applyfunc(sp.simplify).nullspace(simplify=True))

    @property
    def rank(self) -> int:
        """Rank for general values of the symbols.

        Examples
        --------
        >>> from kinetostat.symbolic import beam
        >>> beam().rank
        6
        """
        return int(self.matrix.shape[0]) - len(self.null_space)
