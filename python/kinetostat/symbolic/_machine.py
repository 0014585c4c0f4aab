"""A chain of formulas from a small machine."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine
from kinetostat.symbolic._chain import Chain

__all__ = ["NamedChain", "from_machine"]

_LARGEST = 24
_UNITS = {"m": sp.Integer(1), "mm": sp.Rational(1, 1000), "rad": sp.Integer(1), "deg": sp.pi / 180}
_TRANSLATIONS = {f"{word}_{unit}": _UNITS[unit] for word in ("translation", "position") for unit in ("m", "mm")}
_PLACES = {kind: [f"{kind}_{unit}" for unit in _UNITS] for kind in ("home", "rest", "limits")}
_STIFFNESS = {"stiffness_n_m_per_rad": sp.Integer(1), "stiffness_n_per_mm": sp.Integer(1000), "stiffness_n_per_m": sp.Integer(1)}
_STIFFNESS["stiffness_n_mm_per_rad"] = sp.Rational(1, 1000)
_WORDS = ["name", "source", "assumption", "rigid", "node", "passive", "actuator", "spring", "axis", "rigid_drive", "spring6"]
_KNOWN = frozenset([*_WORDS, *_PLACES["home"], *_PLACES["rest"], *_STIFFNESS])
# What does not change the stiffness.
_SILENT = frozenset([*_PLACES["limits"], "rated_force_n", "rated_torque_n_m"])


@dataclasses.dataclass(frozen=True)
class NamedChain:
    """A chain and the numbers of its symbols.

    Examples
    --------
    >>> from kinetostat import Machine
    >>> found = from_machine(Machine.preset("two_link"), symbols=["stiffnesses"])
    >>> [str(s) for s in found.values]
    ['k_theta']
    """

    chain: Chain
    """The chain."""
    values: dict[sp.Symbol, sp.Expr]
    """What the machine has for each symbol: m, rad, N/m, N m/rad; angles and places at home."""


class _Names:
    def __init__(self, wanted: Sequence[str]) -> None:
        self.wanted = wanted
        self.values: dict[sp.Symbol, sp.Expr] = {}

    def of(self, theme: str, name: str, value: sp.Expr) -> sp.Expr:
        if theme not in self.wanted:
            return value
        symbol = sp.Symbol("".join(c if c.isalnum() else "_" for c in name), real=True)
        while symbol in self.values:
            symbol = sp.Symbol(f"{symbol.name}_", real=True)
        self.values[symbol] = value
        return symbol


def from_machine(machine: Machine, symbols: Sequence[str] = ("lengths", "angles", "stiffnesses")) -> NamedChain:
    """The one limb of a small machine with names instead of numbers.

    Parameters
    ----------
    machine : Machine
        One limb from its base to its tool, of rigid translations along the axes, joints that turn or slide, drives, nodes and
        springs of one direction or of six with a matrix of their own, at rest at home. Without a tool at the flange.
    symbols : sequence of {"lengths", "angles", "stiffnesses"}
        What gets a name; the rest stays the machine's numbers. Coordinates of joints are ``angles`` (slides too). Matrices of 6-D
        springs stay numbers.

    Returns
    -------
    NamedChain

    Raises
    ------
    ArgumentError
        For a machine of several limbs, an element that is not covered, or more than 24 coordinates; it names the element.

    Examples
    --------
    >>> found = from_machine(Machine.preset("two_link"))
    >>> found.chain.end.subs(found.values).evalf(5).T
    Matrix([[1.9319, 0, 0]])
    """
    unknown = [s for s in symbols if s not in ("lengths", "angles", "stiffnesses")]
    if unknown or isinstance(symbols, str):
        raise ArgumentError(f"symbols is {symbols!r}, expected some of 'lengths', 'angles', 'stiffnesses'")
    document = machine.to_dict()
    limbs = document.get("limb", [])
    if len(limbs) != 1:
        raise ArgumentError(f"{machine.name}: formulas need one limb; it has {len(limbs)} limbs")
    strange = set(limbs[0]) - {"name", "from", "to", "chain", "source", "assumption"}
    if strange:
        raise ArgumentError(f"{machine.name}: {', '.join(sorted(strange))} of limb {limbs[0]['name']!r} is not covered by formulas")
    if abs(machine.tool - sp.matrix2numpy(sp.eye(4), dtype=float)).max() > 0:
        raise ArgumentError(f"{machine.name} carries a tool: add it to the chain with move")
    names = _Names(symbols)
    chain = Chain(machine.name)
    for index, element in enumerate(document["chain"][limbs[0]["chain"]]["elements"]):
        _add(chain, element, f"{element.get('name', f'e{index + 1}')}", document, names)
        if len(chain.coordinates) > _LARGEST:
            raise ArgumentError(f"{machine.name}: more than {_LARGEST} coordinates at element {index + 1}: too large for formulas")
    return NamedChain(chain, names.values)


def _number(value: float) -> sp.Expr:
    return sp.Rational(repr(float(value)))


def _add(chain: Chain, element: Mapping[str, Any], name: str, document: Mapping[str, Any], names: _Names) -> None:
    strange = set(element) - _KNOWN - _SILENT
    if strange:
        raise ArgumentError(f"element {name!r}: {', '.join(sorted(strange))} is not covered by formulas")
    if "node" in element:
        chain.node(element["node"])
    elif "rigid" in element:
        found = [(key, unit) for key, unit in _TRANSLATIONS.items() if key in element["rigid"]]
        if len(found) != 1 or len(element["rigid"]) != 1:
            raise ArgumentError(f"element {name!r}: formulas cover rigid translations only, not {', '.join(sorted(element['rigid']))}")
        parts = [_number(v) * found[0][1] for v in element["rigid"][found[0][0]]]
        chain.move(*(v if v == 0 else names.of("lengths", f"L_{name}_{axis}", v) for v, axis in zip(parts, "xyz", strict=True)))
    elif "spring6" in element:
        own = element["spring6"]
        table = document.get("stiffness", {}).get(own, {}) if isinstance(own, str) else own
        chain.spring6(name, _six(table, name))
    elif any(word in element for word in ("passive", "actuator", "spring")):
        _joint(chain, element, name, names)
    else:
        raise ArgumentError(f"element {name!r} is not covered by formulas")


def _six(table: Mapping[str, Any], name: str) -> sp.Matrix:
    if "diagonal_n_m_rad" in table:
        return sp.diag(*map(_number, table["diagonal_n_m_rad"]))
    millimetres = "matrix_n_mm_rad" in table
    entry = table.get("matrix_n_mm_rad", table.get("matrix_n_m_rad"))
    if entry is None:
        raise ArgumentError(f"element {name!r}: formulas need a matrix in N, mm, rad or in N, m, rad")
    # N/mm, N, N mm to N/m, N, N m.
    scale = [1000, 1000, 1000, 1, 1, 1] if millimetres else [1] * 6
    return sp.Matrix(6, 6, lambda i, j: _number(entry[i][j]) * scale[i] * scale[j] / (1000 if millimetres else 1))


def _joint(chain: Chain, element: Mapping[str, Any], name: str, names: _Names) -> None:
    kind = next(element[word] for word in ("passive", "actuator", "spring") if word in element)
    if kind not in ("revolute", "prismatic"):
        raise ArgumentError(f"element {name!r}: formulas cover revolute and prismatic joints, not {kind!r}")
    given = [_number(element[f"home_{unit}"]) * factor for unit, factor in _UNITS.items() if f"home_{unit}" in element]
    home = given[0] if given else sp.Integer(0)
    at_rest = [_number(element[f"rest_{unit}"]) * factor for unit, factor in _UNITS.items() if f"rest_{unit}" in element]
    # A spring of which nothing is said is at rest where its coordinate is zero.
    if "spring" in element and (at_rest[0] if at_rest else 0) != home:
        raise ArgumentError(f"element {name!r} is at rest elsewhere than at home: formulas do not cover springs that bear a force at home")
    at, axis = names.of("angles", name, home), element["axis"]
    if not isinstance(axis, str):
        parts = sp.Matrix([_number(v) for v in axis])
        axis = list(parts / sp.sqrt(parts.dot(parts)))
    if "passive" in element:
        chain.passive(name, kind, axis, at)
        return
    stiffness = [_number(element[key]) * scale for key, scale in _STIFFNESS.items() if key in element]
    k = names.of("stiffnesses", f"k_{name}", stiffness[0]) if stiffness else None
    if "actuator" in element:
        chain.actuator(name, kind, axis, stiffness=k, at=at)
    elif k is None:
        raise ArgumentError(f"element {name!r}: formulas need the stiffness of a spring")
    else:
        chain.spring(name, kind, axis, stiffness=k, at=at)
