"""A matrix of formulas: shown, printed as code, evaluated."""

from __future__ import annotations

import dataclasses
import keyword
from collections.abc import Callable, Mapping, Sequence
from typing import Any, TypeVar

import mpmath
import sympy as sp
from sympy.printing.rust import RustCodePrinter

from kinetostat._arguments import refused, shown, texts
from kinetostat.errors import ArgumentError
from kinetostat.symbolic._linear import Definitions, numbers
from kinetostat.symbolic._steps import expanded, put_in, symbols_of

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
_NUMPY = """array numpy pi nan inf select where sign less less_equal greater greater_equal equal not_equal logical_and logical_or
logical_not amax amin maximum minimum arccos arccosh arcsin arcsinh arctan arctan2 arctanh"""
_KEYWORDS = frozenset([*keyword.kwlist, "math", "abs", "max", "min", "out", *f"{_C} {_MATH_H} {_RUST} {_NUMPY}".split()])
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
    definitions: Definitions = dataclasses.field(default=(), kw_only=True)
    """Steps on the way: symbols that stand in :attr:`matrix` and what they are, each in terms of those before it. Empty for most."""

    def __post_init__(self) -> None:
        if not isinstance(self.matrix, sp.MatrixBase):
            raise refused("matrix", self.matrix, "a matrix of SymPy")
        if not isinstance(self.definitions, tuple) or any(not isinstance(d, tuple) or len(d) != 2 for d in self.definitions):
            raise refused("definitions", self.definitions, "pairs of a symbol and what it is, in order")

    @property
    def symbols(self) -> tuple[sp.Symbol, ...]:
        """Its symbols in alphabetic order, without those of steps: the order of the arguments of printed functions."""
        return tuple(sorted(symbols_of(self.matrix, self.definitions), key=lambda s: str(s.name)))

    def subs(self: _OfFormulas, values: Mapping[str | sp.Symbol, Any]) -> _OfFormulas:
        """The same with values for symbols, by their names or as symbols; see :func:`kinetostat.symbolic.substitute`.

        Raises
        ------
        ArgumentError
            A name that the formulas do not have, or a value of zero by which a step divides.

        Examples
        --------
        >>> import sympy as sp
        >>> k = sp.Symbol("k", positive=True)
        >>> Formula(sp.Matrix([[k, 0], [0, 2 * k]])).subs({"k": 3}).matrix
        Matrix([
        [3, 0],
        [0, 6]])
        """
        matrix, definitions = put_in(self.matrix, self.definitions, values)
        return dataclasses.replace(self, matrix=matrix, definitions=definitions)

    def expanded(self: _OfFormulas) -> _OfFormulas:
        """The same without steps: each definition is put in where it is used, unsimplified. Long for large chains.

        Examples
        --------
        >>> import sympy as sp
        >>> s, k = sp.symbols("s k")
        >>> Formula(sp.Matrix([s + s**2]), definitions=((s, 1 / k),)).expanded().matrix
        Matrix([[1/k + k**(-2)]])
        """
        return dataclasses.replace(self, matrix=expanded(self.matrix, self.definitions), definitions=())

    def simplified(self: _OfFormulas) -> _OfFormulas:
        """The same with every entry simplified by SymPy, steps put in: for short formulas, long ones take minutes.

        Examples
        --------
        >>> import sympy as sp
        >>> x = sp.Symbol("x")
        >>> Formula(sp.Matrix([sp.sin(x) ** 2 + sp.cos(x) ** 2])).simplified().matrix
        Matrix([[1]])
        """
        plain = self.expanded()
        return dataclasses.replace(plain, matrix=plain.matrix.applyfunc(sp.simplify))

    def latex(self) -> str:
        r"""The matrix in LaTeX; where it has steps, an ``aligned`` of the definitions in order, then the matrix.

        Examples
        --------
        >>> import sympy as sp
        >>> "frac" in Formula(sp.Matrix([sp.Symbol("k") / 2])).latex()
        True
        """
        matrix = str(sp.latex(self.matrix))
        if not self.definitions:
            return matrix
        lines = [f"{sp.latex(s)} &= {sp.latex(e)}" for s, e in self.definitions]
        return "\n".join([r"\begin{aligned}", " \\\\\n".join([*lines, f"&{matrix}"]), r"\end{aligned}"])

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
        # Steps are short and in order already; what the entries share comes behind them.
        steps: list[tuple[sp.Symbol, sp.Expr]] = []
        known = dict(plain)
        for symbol, e in self.definitions:
            steps.append((next(names), e.xreplace(known)))
            known[symbol] = steps[-1][0]
        more, entries = sp.cse(list(self.matrix.xreplace(known)), symbols=names)
        return [*steps, *more], list(entries), plain

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
        _is_name(name)
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
        _is_name(name)
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
        _is_name(name)
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
        steps, entries, plain = self._steps()
        if arguments is not None and (isinstance(arguments, str) or not isinstance(arguments, Sequence)):
            raise refused("arguments", arguments, "a list of symbols or their names, or None")
        for index, own in enumerate(arguments or ()):
            if not isinstance(own, (str, sp.Symbol)):
                raise refused(f"arguments[{index}]", own, "a symbol or its name")
        by_name = {str(s.name): p for s, p in plain.items()}
        order = list(by_name) if arguments is None else [str(a) for a in arguments]
        missing = [name for name in by_name if name not in order]
        if missing:
            raise ArgumentError(f"arguments leaves out {', '.join(missing)}")
        rows, columns = self.matrix.shape
        matrix = sp.Matrix(rows, columns, entries)
        names = [by_name.get(name, sp.Dummy(name)) for name in order]
        function: Callable[..., Any] = sp.lambdify(names, matrix, modules="numpy", cse=lambda whole: (steps, whole))
        return function


def _is_name(name: Any) -> None:
    """A name that every printed language takes for a function."""
    if not isinstance(name, str) or not (name.isascii() and name.isidentifier()) or name in _KEYWORDS:
        raise ArgumentError(f"name is {shown(name)}, expected letters, digits and _ that are no word of C, Rust or Python")


class _RustPrinter(RustCodePrinter):  # type: ignore[misc]
    """Sums and products always have parentheses here, for SymPy drops those of a sum within a product (seen in 1.14).

    Whole numbers are floats everywhere but in exponents: Rust has no arithmetic between integers and f64.
    """

    def _print_Add(self, expr: sp.Expr, order: object = None) -> str:  # noqa: N802
        return f"({super()._print_Add(expr, order)})"

    def _print_Mul(self, expr: sp.Expr) -> str:  # noqa: N802
        return f"({super()._print_Mul(expr)})"

    def _print_Integer(self, expr: sp.Integer, type_cast: bool = False) -> str:  # noqa: N802
        return f"{int(expr)}.0"

    def _print_Infinity(self, expr: sp.Expr) -> str:  # noqa: N802
        return "f64::INFINITY"

    # Before 1.13 SymPy prints these on their own.
    _print_Zero = _print_One = _print_NegativeOne = _print_Integer  # noqa: N815

    def _print_Pow(self, expr: sp.Expr) -> str:  # noqa: N802
        if expr.exp.is_Integer and expr.exp != -1:
            return f"({self._print(expr.base)}).powi({int(expr.exp)})"
        return str(super()._print_Pow(expr))


def _rust(expression: sp.Expr) -> str:
    return str(_RustPrinter().doprint(sp.sympify(expression).evalf(17)))


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

    def __post_init__(self) -> None:
        super().__post_init__()
        texts("directions", self.directions, "names of rows and columns")
        texts("redundant", self.redundant, "names of passive joints")

    @property
    def null_space(self) -> list[sp.Matrix]:
        """Motions of the end without resistance, a basis (columns in the order of :attr:`directions`).

        Empty for a regular matrix.

        Raises
        ------
        ArgumentError
            For a matrix with steps, whose entries are no formulas in the parameters.

        Examples
        --------
        >>> from kinetostat.symbolic import planar_beam, with_passive_joint
        >>> with_passive_joint(planar_beam(), "x").null_space
        [Matrix([
        [1],
        [0],
        [0]])]
        """
        if self.definitions:
            raise ArgumentError("the null space of a stiffness with steps is not formed: use expanded(), or put numbers in with subs first")
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
        # Decided at random numbers: to simplify long formulas takes minutes. Decimals have no 80 digits.
        if self.definitions or not self.matrix.has(sp.Float):
            return _rank(numbers(self.matrix, self.definitions))
        return int(self.matrix.shape[0]) - len(self.null_space)


def _rank(matrix: Any) -> int:
    """Of numbers with 80 digits: what is smaller than the largest by 25 digits is zero."""
    with mpmath.workdps(80):
        sizes = mpmath.svd_r(matrix, compute_uv=False)
        return sum(1 for s in sizes if s > sizes[0] * mpmath.mpf(10) ** -25)
