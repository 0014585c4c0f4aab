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
_KNOWN = frozenset(["name", "source", "assumption", "rigid", "node", "passive", "actuator", "axis", "home_deg", "home_mm", "spring6"])
_STIFFNESS = {"stiffness_n_m_per_rad": sp.Integer(1), "stiffness_n_per_mm": sp.Integer(1000), "stiffness_n_per_m": sp.Integer(1)}
_SILENT = frozenset(["limits_mm", "limits_deg", "rating_n", "rating_n_m"])


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
        6-D springs with a matrix of their own. Without a tool at the flange.
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
    if len(limbs) != 1 or set(limbs[0]) - {"name", "from", "to", "chain", "source", "assumption"}:
        raise ArgumentError(f"{machine.name}: formulas need one limb without poses of its own; it has {len(limbs)} limbs")
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
    strange = set(element) - _KNOWN - _SILENT - set(_STIFFNESS)
    if strange:
        raise ArgumentError(f"element {name!r}: {', '.join(sorted(strange))} is not covered by formulas")
    if "node" in element:
        chain.node(element["node"])
    elif "rigid" in element:
        if set(element["rigid"]) != {"translation_mm"}:
            raise ArgumentError(f"element {name!r}: formulas cover rigid translations in mm only, not {', '.join(element['rigid'])}")
        parts = [_number(v) / 1000 for v in element["rigid"]["translation_mm"]]
        chain.move(*(v if v == 0 else names.of("lengths", f"L_{name}_{axis}", v) for v, axis in zip(parts, "xyz", strict=True)))
    elif "spring6" in element:
        table = document.get("stiffness", {}).get(element["spring6"], {})
        if "matrix_n_mm_rad" not in table:
            raise ArgumentError(f"element {name!r}: formulas need the matrix of {element['spring6']!r} in N, mm, rad")
        scale = [1000, 1000, 1000, 1, 1, 1]
        entry = table["matrix_n_mm_rad"]
        # N/mm, N, N mm to N/m, N, N m.
        chain.spring6(name, sp.Matrix(6, 6, lambda i, j: _number(entry[i][j]) * scale[i] * scale[j] / 1000))
    elif "passive" in element or "actuator" in element:
        _joint(chain, element, name, names)
    else:
        raise ArgumentError(f"element {name!r} is not covered by formulas")


def _joint(chain: Chain, element: Mapping[str, Any], name: str, names: _Names) -> None:
    kind = element.get("passive", element.get("actuator"))
    if kind not in ("revolute", "prismatic"):
        raise ArgumentError(f"element {name!r}: formulas cover revolute and prismatic joints, not {kind!r}")
    home = sp.pi * _number(element.get("home_deg", 0)) / 180 if kind == "revolute" else _number(element.get("home_mm", 0)) / 1000
    at, axis = names.of("angles", name, home), element["axis"]
    if not isinstance(axis, str):
        raise ArgumentError(f"element {name!r}: formulas cover axes along x, y and z")
    if "passive" in element:
        chain.passive(name, kind, axis, at)
        return
    stiffness = [(key, scale) for key, scale in _STIFFNESS.items() if key in element]
    k = names.of("stiffnesses", f"k_{name}", _number(element[stiffness[0][0]]) * stiffness[0][1]) if stiffness else None
    chain.actuator(name, kind, axis, stiffness=k, at=at)
