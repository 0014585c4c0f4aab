"""A chain of formulas from a small machine."""

from __future__ import annotations

import dataclasses
import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import sympy as sp

from kinetostat._arguments import of_kind, text_or_none, texts
from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine
from kinetostat.symbolic._chain import Chain
from kinetostat.symbolic._placement import UNITS, number, orientation, translation, unit

__all__ = ["NamedChain", "from_machine"]

_LARGEST = 24
_PLACES = {kind: [f"{kind}_{unit}" for unit in UNITS] for kind in ("home", "rest", "limits")}
_STIFFNESS = {"stiffness_n_m_per_rad": sp.Integer(1), "stiffness_n_per_mm": sp.Integer(1000), "stiffness_n_per_m": sp.Integer(1)}
_STIFFNESS["stiffness_n_mm_per_rad"] = sp.Rational(1, 1000)
_WORDS = ["name", "source", "assumption", "rigid", "node", "passive", "actuator", "spring", "axis", "rigid_drive", "spring6"]
_KNOWN = frozenset([*_WORDS, *_PLACES["home"], *_PLACES["rest"], *_STIFFNESS])
# What does not change the stiffness.
_VIBRATION = ["rotor", "damping_n_s_per_m", "damping_n_m_s_per_rad"]
_SILENT = frozenset([*_PLACES["limits"], "rated_force_n", "rated_torque_n_m", *_VIBRATION])


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


def from_machine(machine: Machine, symbols: Sequence[str] = ("lengths", "angles", "stiffnesses"), *, limb: str | None = None) -> NamedChain:
    """A limb of a small machine with names instead of numbers.

    Parameters
    ----------
    machine : Machine
        Of rigid offsets and rotations, joints that turn or slide, drives, nodes, and springs of one direction or of six with a matrix
        of their own, at rest at home. Without a tool at the flange, weights, loads of its own or deviations.
    symbols : sequence of {"lengths", "angles", "stiffnesses"}
        What gets a name; the rest stays the machine's numbers. Coordinates of joints are ``angles`` (slides too). Fixed rotations and
        matrices of 6-D springs stay numbers.
    limb : str, optional
        Which one, of a machine of several. Its end is the reference point of the platform that it carries, so that the stiffnesses of
        all limbs add up: ``in_parallel(found, [[0, 0, 0]] * len(found))``.

    Returns
    -------
    NamedChain

    Raises
    ------
    ArgumentError
        For a machine of several limbs without ``limb``, for what is not covered, or for more than 24 coordinates; it names the element.

    Notes
    -----
    Where more than about four joints have symbols, ask the chain for ``stiffness(steps=True)``.

    Examples
    --------
    >>> found = from_machine(Machine.preset("two_link"))
    >>> found.chain.end.subs(found.values).evalf(5).T
    Matrix([[1.9319, 0, 0]])
    """
    of_kind("machine", machine, Machine, "a Machine")
    text_or_none("limb", limb, "the name of a limb, or None")
    wanted = texts("symbols", symbols, "some of 'lengths', 'angles', 'stiffnesses'")
    if any(s not in ("lengths", "angles", "stiffnesses") for s in wanted):
        raise ArgumentError(f"symbols is {wanted!r}, expected some of 'lengths', 'angles', 'stiffnesses'")
    document = machine.to_dict()
    own = _limb(machine, document, limb)
    _unloaded(machine, document)
    names = _Names(wanted)
    chain = Chain(machine.name if limb is None else f"{machine.name}: {limb}")
    start, end = own.get("start", {}), own.get("end", {})
    chain.place(translation(start), orientation(start))
    elements = document["chain"][own["chain"]]["elements"]
    homes = _homes(machine, document, own, elements)
    for index, element in enumerate(elements):
        _add(chain, element, f"{element.get('name', f'e{index + 1}')}", document, names, homes.get(index))
        if len(chain.coordinates) > _LARGEST:
            raise ArgumentError(f"{machine.name}: more than {_LARGEST} coordinates at element {index + 1}: too large for formulas")
    # From the tip of the chain to the platform: the inverse of where the tip is in the platform.
    back = orientation(end).T
    chain.place(-back * translation(end), back)
    return NamedChain(chain, names.values)


def _unloaded(machine: Machine, document: Mapping[str, Any]) -> None:
    """Refuses what would load the chain at home: its stiffness is not the unloaded one then."""
    told = f"{machine.name}: formulas are of an unloaded machine"
    if document.get("load"):
        raise ArgumentError(f"{told}, and it has loads of its own; leave [[load]] out, or give loads to Chain.stiffness(loads=...)")
    if document.get("deviation"):
        raise ArgumentError(f"{machine.name} has deviations, which formulas do not cover: leave [[deviation]] out")
    heavy = [p["name"] for p in document["platform"] if p.get("mass_kg")]
    heavy += [e.get("name", "body") for c in document["chain"].values() for e in c["elements"] if "body" in e]
    if heavy and any(document["mechanism"].get("gravity_m_per_s2", ())):
        raise ArgumentError(f"{told}, and it has weights ({', '.join(heavy[:3])}): set gravity_m_per_s2 to [0, 0, 0] to leave them out")
    if not np.array_equal(machine.tool, np.eye(4)):
        raise ArgumentError(f"{machine.name} carries a tool: add it to the chain with move")


def _limb(machine: Machine, document: Mapping[str, Any], name: str | None) -> Mapping[str, Any]:
    limbs = document["limb"]
    known = ", ".join(repr(one["name"]) for one in limbs)
    if name is None and len(limbs) != 1:
        told = f"{machine.name}: a formula is of one limb, and it has {len(limbs)} limbs"
        raise ArgumentError(f"{told}: say which with limb= ({known}) and add their stiffnesses with in_parallel")
    chosen: dict[str, Any] | None = next((one for one in limbs if name in (None, one["name"])), None)
    if chosen is None:
        raise ArgumentError(f"{machine.name}: there is no limb {name!r}; limbs: {known}")
    strange = set(chosen) - {"name", "from", "to", "chain", "start", "end", "source", "assumption"}
    if strange:
        raise ArgumentError(f"{machine.name}: {', '.join(sorted(strange))} of limb {chosen['name']!r} is not covered by formulas")
    if chosen["from"] != "base":
        raise ArgumentError(f"{machine.name}: limb {chosen['name']!r} starts at {chosen['from']!r}, formulas cover limbs from the base")
    return chosen


def _homes(
    machine: Machine, document: Mapping[str, Any], own: Mapping[str, Any], elements: Sequence[Mapping[str, Any]]
) -> dict[int, sp.Expr]:
    """Where joints of one of several limbs are at home: the platform decides that. Of a single limb they are as its file says."""
    limbs = document["limb"]
    simple = {"passive", "actuator"}
    if len(limbs) == 1 or not all(e.get(w) in ("revolute", "prismatic") for e in elements for w in simple & set(e)):
        return {}
    commands, coordinates = (iter(v) for v in machine.posture().limbs[limbs.index(own)])
    homes: dict[int, sp.Expr] = {}
    for index, element in enumerate(elements):
        if "actuator" in element:
            homes[index] = _round(next(commands), element["actuator"])
            if _STIFFNESS.keys() & set(element):
                next(coordinates)
        elif "passive" in element:
            homes[index] = _round(next(coordinates), element["passive"])
        elif "spring" in element or "spring6" in element:
            for _ in range(6 if "spring6" in element else 1):
                next(coordinates)
    return homes


def _round(value: float, kind: str) -> sp.Expr:
    """A solved coordinate, exact where it is a whole degree or tenth of a nanometre: what rounding leaves of a zero is no pivot."""
    degrees = math.degrees(value)
    if kind == "revolute" and abs(degrees - round(degrees)) < 1e-9:
        return sp.pi * round(degrees) / 180
    return number(round(value, 10) if kind == "prismatic" and abs(value - round(value, 10)) < 1e-13 else value)


def _add(chain: Chain, element: Mapping[str, Any], name: str, document: Mapping[str, Any], names: _Names, home: sp.Expr | None) -> None:
    if "body" in element:
        # Weights are refused, and a mass without weight does not change the stiffness.
        return
    strange = set(element) - _KNOWN - _SILENT
    if strange:
        raise ArgumentError(f"element {name!r}: {', '.join(sorted(strange))} is not covered by formulas")
    if "node" in element:
        chain.node(element["node"])
    elif "rigid" in element:
        where = translation(element["rigid"])
        named = [v if v == 0 else names.of("lengths", f"L_{name}_{axis}", v) for v, axis in zip(where, "xyz", strict=True)]
        chain.place(named, orientation(element["rigid"]))
    elif "spring6" in element:
        own = element["spring6"]
        table = document.get("stiffness", {}).get(own, {}) if isinstance(own, str) else own
        chain.spring6(name, _six(table, name))
    elif any(word in element for word in ("passive", "actuator", "spring")):
        _joint(chain, element, name, names, home)
    else:
        raise ArgumentError(f"element {name!r} is not covered by formulas")


def _six(table: Mapping[str, Any], name: str) -> sp.Matrix:
    if "diagonal_n_m_rad" in table:
        return sp.diag(*map(number, table["diagonal_n_m_rad"]))
    millimetres = "matrix_n_mm_rad" in table
    entry = table.get("matrix_n_mm_rad", table.get("matrix_n_m_rad"))
    if entry is None:
        raise ArgumentError(f"element {name!r}: formulas need a matrix in N, mm, rad or in N, m, rad")
    # N/mm, N, N mm to N/m, N, N m.
    scale = [1000, 1000, 1000, 1, 1, 1] if millimetres else [1] * 6
    return sp.Matrix(6, 6, lambda i, j: number(entry[i][j]) * scale[i] * scale[j] / (1000 if millimetres else 1))


def _joint(chain: Chain, element: Mapping[str, Any], name: str, names: _Names, assembled: sp.Expr | None) -> None:
    kind = next(element[word] for word in ("passive", "actuator", "spring") if word in element)
    if kind not in ("revolute", "prismatic"):
        told = f"element {name!r}: formulas cover revolute and prismatic joints, not {kind!r}"
        raise ArgumentError(f"{told}: write it as such joints at one place")
    given = [number(element[f"home_{unit}"]) * factor for unit, factor in UNITS.items() if f"home_{unit}" in element]
    home = given[0] if given else sp.Integer(0)
    at_rest = [number(element[f"rest_{unit}"]) * factor for unit, factor in UNITS.items() if f"rest_{unit}" in element]
    # A spring of which nothing is said is at rest where its coordinate is zero.
    if "spring" in element and (at_rest[0] if at_rest else 0) != home:
        raise ArgumentError(f"element {name!r} is at rest elsewhere than at home: formulas do not cover springs that bear a force at home")
    at, axis = names.of("angles", name, home if assembled is None else assembled), list(unit(element["axis"]))
    if "passive" in element:
        chain.passive(name, kind, axis, at)
        return
    stiffness = [number(element[key]) * scale for key, scale in _STIFFNESS.items() if key in element]
    k = names.of("stiffnesses", f"k_{name}", stiffness[0]) if stiffness else None
    if "actuator" in element:
        chain.actuator(name, kind, axis, stiffness=k, at=at)
    elif k is None:
        raise ArgumentError(f"element {name!r}: formulas need the stiffness of a spring")
    else:
        chain.spring(name, kind, axis, stiffness=k, at=at)
