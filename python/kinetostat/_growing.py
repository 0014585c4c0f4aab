"""What shall grow along a curve: one motion or one load, and from where to where."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arrays import Floats, one
from kinetostat.errors import ArgumentError


def one_way(what: Mapping[str, Any], displacement: object, turn: object, factor: object) -> None:
    """Refuses a question about two curves, about none, and one without its range or with that of another."""
    given = [name for name, value in what.items() if value is not None]
    ranges = {
        "direction": ("displacement", displacement, "displacement=(from, to), m, as in displacement=(0, 0.02)"),
        "about": ("turn", turn, "turn=(from, to), rad, as in turn=(0, 0.1)"),
        "force (moment)": ("factor", factor, "factor=(from, to), as in factor=(0, 2): so many times the load"),
    }
    if len(given) > 1:
        raise ArgumentError(
            f"{' and '.join(given)} are given, and one of them can grow: a load that acts all the time is constant_force, constant_moment "
            "or loads"
        )
    for name, (word, value, example) in ranges.items():
        if value is not None and name not in given:
            raise ArgumentError(f"{word} goes with {name}")
        if value is None and name in given:
            raise ArgumentError(f"how far? {name} needs {example}")
    if not given:
        raise ArgumentError("say what shall grow: direction and displacement, about and turn, or force (moment) and factor")


def ends(name: str, given: ArrayLike | None, unit: str, most: float) -> Floats | None:
    """Two different numbers, neither of them farther than a bound."""
    if given is None:
        return None
    found = one(name, given, (2,))
    if found[0] == found[1]:
        raise ArgumentError(f"{name} is {found.tolist()}: there is nothing between equal ends; give two different numbers")
    if np.abs(found).max() > most:
        raise ArgumentError(f"{name} is {found.tolist()} {unit}, expected from {-most:.6g} to {most:.6g} {unit}")
    return found
