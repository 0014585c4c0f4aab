"""A chain in words of the field, and its Jacobian, compliance and stiffness as formulas."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from fractions import Fraction
from typing import Any, Literal, TypeAlias

import sympy as sp

from kinetostat._arguments import flag, mapping, one_of, shown, text, texts
from kinetostat.errors import ArgumentError
from kinetostat.symbolic._condensed import Bordered, condensed
from kinetostat.symbolic._expression import Formula, Stiffness
from kinetostat.symbolic._given import formula, formulas
from kinetostat.symbolic._given import matrix as matrix_given
from kinetostat.symbolic._linear import UnsolvableError, solved
from kinetostat.symbolic._placement import rotation
from kinetostat.symbolic._stepwise import Sprung, loaded_in_steps, unloaded_in_steps

__all__ = ["Chain"]

DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")
Kind: TypeAlias = Literal["revolute", "prismatic"]
Expression: TypeAlias = Any
"""A SymPy formula, a number, or text that names a symbol."""
_ROUNDING = 1e-12
"""How far a unit vector that is written in decimals may be off."""
_LARGEST_DENOMINATOR = 10_000


@dataclasses.dataclass(frozen=True)
class _Motion:
    """One coordinate: where its axis is, and what holds it."""

    name: str
    kind: Kind
    axis: sp.Matrix
    origin: sp.Matrix
    passive: bool


def _axis(axis: str | Sequence[Expression]) -> sp.Matrix:
    if isinstance(axis, str):
        sign, letter = (-1, axis[1:]) if axis.startswith("-") else (1, axis)
        if letter not in ("x", "y", "z"):
            raise ArgumentError(f"axis is {shown(axis)}, expected x, y, z, -x, -y, -z or three entries")
        return sign * sp.Matrix([int(letter == other) for other in "xyz"])
    found = formulas("axis", axis, 3)
    if sp.simplify(found.dot(found)) == 1:
        return found
    near = _exact(found)
    if near is None:
        raise ArgumentError(
            f"axis is {list(found)}, whose length is not 1: expected three entries of a unit vector, as [0, 0, 1] or "
            "[sympy.sqrt(2) / 2, 0, sympy.sqrt(2) / 2]; divide by the length"
        )
    return near


def _exact(axis: sp.Matrix) -> sp.Matrix | None:
    """A unit vector that was rounded: with roots of fractions where it is one of these, else as it is; none where its length is not 1."""
    if axis.free_symbols or not all(entry.is_real for entry in axis):
        return None
    numbers = [float(entry) for entry in axis]
    if not abs(math.hypot(*numbers) - 1) <= _ROUNDING:
        return None
    squares = [Fraction(x * x).limit_denominator(_LARGEST_DENOMINATOR) for x in numbers]
    if sum(squares) == 1 and all(abs(math.sqrt(s) - abs(x)) <= _ROUNDING for s, x in zip(squares, numbers, strict=True)):
        return sp.Matrix(
            [sp.sqrt(sp.Rational(s.numerator, s.denominator)) * (-1 if x < 0 else 1) for s, x in zip(squares, numbers, strict=True)]
        )
    return axis


def neat(entry: sp.Expr) -> sp.Expr:
    """Short formulas simplified; long ones as they are, for that takes minutes."""
    short = sp.count_ops(entry) <= 16 and len(entry.free_symbols) <= 3
    return sp.trigsimp(entry) if short else entry


class Chain:
    """A serial chain from the base to its end; elements are added from the base outwards, each call returns the chain.

    Text names a symbol, SymPy formulas and numbers stay what they are. Angles in rad, lengths in m, N/m and N m/rad.

    Examples
    --------
    The two links of [R 4.31, 4.32]: symmetric, springy in the middle, with a load on the middle.

    >>> import sympy as sp
    >>> a = sp.Symbol("a", real=True)
    >>> chain = (
    ...     Chain("two links")
    ...     .passive("q1", "revolute", "z", at=a).move("L").node("middle")
    ...     .actuator("theta", "revolute", "z", stiffness="K", at=-2 * a).move("L")
    ...     .passive("q2", "revolute", "z", at=a)
    ... )
    >>> chain.end.T
    Matrix([[2*L*cos(a), 0, 0]])
    """

    def __init__(self, name: str = "chain") -> None:
        self.name = text("name", name)
        self._turn = sp.eye(3)
        self._place = sp.zeros(3, 1)
        self._motions: list[_Motion] = []
        self._springs: list[tuple[int, sp.Matrix]] = []
        self._nodes: dict[str, tuple[int, sp.Matrix]] = {}

    @property
    def end(self) -> sp.Matrix:
        """(3, 1): where the end is, m, base axes.

        Examples
        --------
        >>> Chain().move("L").end.T
        Matrix([[L, 0, 0]])
        """
        return self._place

    @property
    def end_rotation(self) -> sp.Matrix:
        """(3, 3): how the end is turned, base from end.

        Examples
        --------
        >>> Chain().end_rotation == sp.eye(3)
        True
        """
        return self._turn

    @property
    def coordinates(self) -> tuple[str, ...]:
        """Names of the columns of :meth:`jacobian`.

        Examples
        --------
        >>> Chain().passive("q", "revolute", "z").coordinates
        ('q',)
        """
        return tuple(m.name for m in self._motions)

    def move(self, x: Expression = 0, y: Expression = 0, z: Expression = 0) -> Chain:
        """A rigid offset, m, in the axes at this place of the chain.

        Examples
        --------
        >>> Chain().move("L", 0, "h").end.T
        Matrix([[L, 0, h]])
        """
        self._place = (self._place + self._turn * sp.Matrix([formula(n, v) for n, v in (("x", x), ("y", y), ("z", z))])).applyfunc(neat)
        return self

    def turn(self, axis: str | Sequence[Expression], angle: Expression) -> Chain:
        """A fixed rotation, rad.

        Examples
        --------
        >>> Chain().turn("z", sp.pi / 2).move("L").end.T
        Matrix([[0, L, 0]])
        """
        return self._turned(rotation(_axis(axis), formula("angle", angle)))

    def _turned(self, by: sp.Matrix) -> Chain:
        self._turn = (self._turn * by).applyfunc(neat)
        return self

    def place(self, position: Sequence[Expression], rotation: sp.Matrix) -> Chain:
        """A rigid offset (m) and, behind it, a rotation matrix: a pose in the axes at this place of the chain.

        Examples
        --------
        >>> Chain().place([0, 0, "h"], sp.Matrix([[0, -1, 0], [1, 0, 0], [0, 0, 1]])).move("L").end.T
        Matrix([[0, L, h]])
        """
        turn = matrix_given("rotation", rotation, (3, 3))
        return self.move(*formulas("position", position, 3))._turned(turn)

    def node(self, name: str) -> Chain:
        """A place that a load may act on.

        Examples
        --------
        >>> Chain().move("L").node("middle").name
        'chain'
        """
        if text("name", name) in self._nodes:
            raise ArgumentError(f"there is a node {name!r} already")
        self._nodes[name] = (len(self._motions), self._place)
        return self

    def _joint(self, name: str, kind: Kind, axis: str | Sequence[Expression], at: Expression, passive: bool) -> None:
        unit = _axis(axis)
        where, by = self._turn * unit, formula("at", at)
        self._motions.append(_Motion(name, kind, where, self._place, passive))
        if kind == "revolute":
            self.turn(list(unit), by)
        else:
            self._place = (self._place + where * by).applyfunc(neat)

    def passive(self, name: str, kind: Kind, axis: str | Sequence[Expression], at: Expression | None = None) -> Chain:
        """A joint that nothing drives, at the coordinate ``at`` (its own name without it), rad or m.

        Examples
        --------
        >>> Chain().passive("q", "prismatic", "x").end.T
        Matrix([[q, 0, 0]])
        """
        _named(name, kind)
        self._joint(name, kind, axis, sp.Symbol(name, real=True) if at is None else at, True)
        return self

    def actuator(
        self,
        name: str,
        kind: Kind,
        axis: str | Sequence[Expression],
        *,
        stiffness: Expression | None = None,
        at: Expression | None = None,
    ) -> Chain:
        """A drive at the coordinate ``at`` (its own name without it), with its stiffness (N m/rad or N/m), rigid without one.

        Examples
        --------
        >>> Chain().actuator("q", "revolute", "z", stiffness="k").move("L").end.T
        Matrix([[L*cos(q), L*sin(q), 0]])
        """
        _named(name, kind)
        where = sp.Symbol(name, real=True) if at is None else formula("at", at)
        if stiffness is None:
            return self.turn(axis, where) if kind == "revolute" else self.move(*(_axis(axis) * where))
        given = formula("stiffness", stiffness)
        self._joint(name, kind, axis, where, False)
        self._springs.append((len(self._motions) - 1, sp.Matrix([[given]])))
        return self

    def spring(self, name: str, kind: Kind, axis: str | Sequence[Expression], *, stiffness: Expression, at: Expression = 0) -> Chain:
        """A virtual spring of one direction, at rest without ``at``.

        Examples
        --------
        >>> Chain().spring("bend", "revolute", "y", stiffness="k").coordinates
        ('bend',)
        """
        return self.actuator(name, kind, axis, stiffness=stiffness, at=at)

    def spring6(self, name: str, stiffness: sp.Matrix | Stiffness | str) -> Chain:
        """A virtual spring of six directions at rest, as at the end of an elastic link: translations before rotations.

        Parameters
        ----------
        name : str
            Of the spring; its coordinates are ``name.x`` to ``name.rz``.
        stiffness : (6, 6) matrix, Stiffness or str
            In the axes of this place, SI; text makes a symmetric matrix of symbols ``K11 ... K66``.

        Examples
        --------
        >>> Chain().move("L").spring6("link", "K").coordinates[:2]
        ('link.x', 'link.y')
        """
        text("name", name)
        if isinstance(stiffness, Stiffness) and stiffness.definitions:
            raise ArgumentError(f"stiffness of {name!r} has steps: put numbers in with subs, or use expanded()")
        if isinstance(stiffness, str):
            text("stiffness", stiffness)
            k = sp.Matrix(6, 6, lambda i, j: sp.Symbol(f"{stiffness}{min(i, j) + 1}{max(i, j) + 1}", real=True))
        else:
            k = matrix_given("stiffness", stiffness.matrix if isinstance(stiffness, Stiffness) else stiffness, (6, 6))
        if (k - k.T).applyfunc(sp.simplify) != sp.zeros(6):
            raise ArgumentError(f"stiffness of {name!r} is not symmetric")
        self._springs.append((len(self._motions), k))
        for i, direction in enumerate(DIRECTIONS):
            kind: Kind = "prismatic" if i < 3 else "revolute"
            self._joint(f"{name}.{direction}", kind, "xyz"[i % 3], 0, False)
        return self

    def _columns(self, place: sp.Matrix, count: int) -> tuple[sp.Matrix, sp.Matrix]:
        linear, angular = sp.zeros(3, len(self._motions)), sp.zeros(3, len(self._motions))
        for i, m in enumerate(self._motions[:count]):
            linear[:, i] = m.axis.cross(place - m.origin) if m.kind == "revolute" else m.axis
            angular[:, i] = m.axis if m.kind == "revolute" else sp.zeros(3, 1)
        return linear.applyfunc(neat), angular

    def jacobian(self, *, of: Literal["all", "passive", "springs"] = "all", node: str | None = None) -> Formula:
        """Motion of the end (or of a node) by coordinate: spatial Jacobian at the end, base axes [R 3.6].

        Parameters
        ----------
        of : {"all", "passive", "springs"}
            Which columns, in the order of the chain.
        node : str, optional
            A node instead of the end.

        Returns
        -------
        Formula
            Six rows: x y z (m), rx ry rz (rad).

        Examples
        --------
        >>> Chain().passive("q", "revolute", "z").move("L").jacobian().matrix.T
        Matrix([[-L*sin(q), L*cos(q), 0, 0, 0, 1]])
        """
        one_of("of", of, ("all", "passive", "springs"))
        wanted = [i for i, m in enumerate(self._motions) if of == "all" or m.passive == (of == "passive")]
        place, count = self._end_or(node)
        linear, angular = self._columns(place, count)
        return Formula(linear.col_join(angular).extract(list(range(6)), wanted))

    def _end_or(self, node: str | None) -> tuple[sp.Matrix, int]:
        if node is None:
            return self._place, len(self._motions)
        if text("node", node) not in self._nodes:
            raise ArgumentError(f"there is no node {node!r}; nodes: {', '.join(self._nodes) or 'none'}")
        count, place = self._nodes[node]
        return place, count

    def _spring_matrix(self) -> sp.Matrix:
        k = sp.zeros(len(self._motions))
        for first, block in self._springs:
            n = block.shape[0]
            k[first : first + n, first : first + n] = block
        return k

    def compliance(self, *, directions: Sequence[str] = DIRECTIONS) -> Formula:
        """``J_theta K_theta^-1 J_theta^T``: deflection by unit loads with the passive joints locked, m/N, rad/(N m) [R 3.7].

        Raises
        ------
        ArgumentError
            Where a spring is singular (a direction without stiffness has no compliance), or a direction unknown.

        Examples
        --------
        >>> Chain().spring("k", "prismatic", "x", stiffness="k").compliance(directions=["x"]).matrix
        Matrix([[1/k]])
        """
        rows = _rows(directions)
        linear, angular = self._columns(self._place, len(self._motions))
        j = linear.col_join(angular).extract(rows, list(range(len(self._motions))))
        total = sp.zeros(len(rows))
        for first, block in self._springs:
            part = j[:, first : first + block.shape[0]]
            try:
                total += part * solved(block, part.T)
            except UnsolvableError:
                names = self._motions[first].name.split(".")[0]
                raise ArgumentError(f"spring {names!r} is singular: make its free direction a passive joint") from None
        return Formula(total.applyfunc(neat))

    def hessian(self, wrench: Sequence[Expression], loads: Mapping[str, Sequence[Expression]] | None = None) -> Formula:
        """``d(J^T F + sum J_j^T G_j)/dx``, base components of the loads frozen [R 4.20, 4.21 corrected].

        Not symmetric where moments act: a moment with fixed base components has no potential.

        Parameters
        ----------
        wrench : sequence of 6
            On the end, N and N m, base axes.
        loads : mapping, optional
            Wrenches on nodes by their names.

        Examples
        --------
        >>> Chain().passive("q", "revolute", "z", at=0).move("L").hessian(["F", 0, 0, 0, 0, 0]).matrix
        Matrix([[-F*L]])
        """
        n = len(self._motions)
        total = sp.zeros(n)
        for node, load in [(None, wrench), *_on_nodes(loads).items()]:
            given = formulas("wrench" if node is None else f"loads[{node!r}]", load, 6)
            f, m = given[:3, :], given[3:, :]
            place, count = self._end_or(node)
            v, w = self._columns(place, count)
            for i in range(count):
                for j in range(count):
                    near = w[:, j].cross(v[:, i]) if j <= i else w[:, i].cross(v[:, j])
                    total[i, j] += f.dot(near) + (m.dot(w[:, j].cross(w[:, i])) if j <= i else 0)
        return Formula(total.applyfunc(neat))

    def stiffness(
        self,
        *,
        directions: Sequence[str] = DIRECTIONS,
        wrench: Sequence[Expression] | None = None,
        loads: Mapping[str, Sequence[Expression]] | None = None,
        steps: bool = False,
    ) -> Stiffness:
        """Cartesian stiffness at the end, unloaded [R 3.8] or in an equilibrium under loads [R 4.26, 4.28].

        Parameters
        ----------
        directions : sequence of str
            Rows and columns. The others are free of load (not held); for a chain in a plane give its three.
        wrench : sequence of 6, optional
            On the end in this equilibrium, N and N m, base axes. That it is one is for the caller to see to.
        loads : mapping, optional
            Wrenches on nodes, dead (fixed in base axes).
        steps : bool
            Give intermediate results names (``definitions`` of what comes back) instead of one formula in lowest terms. For more than
            about four joints with angles as symbols: the one formula takes minutes or longer, the steps a second (with a spring of
            six stiffnesses behind one such joint half a minute). They hold for all values of angles and lengths, special ones (all
            links in line) too, and for all stiffnesses that are not zero: steps divide by them. ``subs`` refuses a zero; printed
            functions and ``lambdify`` divide by it. Where a stiffness may vanish ask with
            ``wrench=[0] * 6``, whose steps take zeros as long as not all springs vanish. At values that hold the end rigidly
            somewhere, or at which loads make it buckle, entries are infinite or NaN.

        Returns
        -------
        Stiffness
            Singular where passive joints let the end go: that is a result. Joints that move without the end are named in
            ``redundant``.

        Raises
        ------
        ArgumentError
            Where the end is held rigidly in a direction: its stiffness is infinite, the message says which.

        Examples
        --------
        >>> from kinetostat.symbolic import beam
        >>> chain = Chain().move("L").spring6("link", beam()).passive("q", "revolute", "z", at=0)
        >>> chain.stiffness().matrix[1, 1], chain.stiffness().rank
        (3*E*I_z/L**3, 5)

        An arm of three joints, step by step.

        >>> arm = Chain("arm")
        >>> for i in "123":
        ...     arm = arm.actuator(f"q{i}", "revolute", "z", stiffness=f"k{i}").move(f"L{i}")
        >>> found = arm.stiffness(directions=("x", "y", "rz"), steps=True)
        >>> found.definitions[0]
        (s0, q1 + q2)
        >>> [str(s) for s in found.symbols]
        ['L1', 'L2', 'L3', 'k1', 'k2', 'k3', 'q1', 'q2', 'q3']
        """
        rows = _rows(directions)
        flag("steps", steps)
        linear, angular = self._columns(self._place, len(self._motions))
        jacobian, names = linear.col_join(angular), [m.name for m in self._motions]
        loaded = wrench is not None or len(_on_nodes(loads)) > 0
        hessian = self.hessian(wrench if wrench is not None else [0] * 6, loads).matrix if loaded else None
        if steps:
            own = Sprung(self.name, tuple(directions), rows, jacobian, self._springs, names)
            return unloaded_in_steps(own) if hessian is None else loaded_in_steps(own, hessian)
        if hessian is not None:
            every = list(range(len(names)))
            bordered = Bordered(sp.zeros(len(rows)), jacobian.extract(rows, every), self._spring_matrix() - hessian, names)
        else:
            moving = [i for i, m in enumerate(self._motions) if m.passive]
            corner = self.compliance(directions=directions).matrix
            bordered = Bordered(corner, jacobian.extract(rows, moving), sp.zeros(len(moving)), [names[i] for i in moving])
        return condensed(self.name, bordered, tuple(directions))

    def __repr__(self) -> str:
        return f"<Chain {self.name!r}: {len(self._motions)} coordinates>"


def _on_nodes(loads: Any) -> Mapping[str, Any]:
    """Wrenches by names of nodes."""
    return {} if loads is None else mapping("loads", loads, "a dictionary of wrenches by names of nodes")


def _named(name: Any, kind: Any) -> None:
    """A joint says what it is called and what it does."""
    text("name", name)
    one_of("kind", kind, ("revolute", "prismatic"))


def _rows(directions: Sequence[str]) -> list[int]:
    given = texts("directions", directions, f"some of {', '.join(DIRECTIONS)}, each once")
    unknown = [d for d in given if d not in DIRECTIONS]
    if unknown or len(set(given)) != len(given) or not given:
        raise ArgumentError(f"directions is {tuple(given)!r}, expected some of {', '.join(DIRECTIONS)}, each once")
    return [DIRECTIONS.index(d) for d in given]
