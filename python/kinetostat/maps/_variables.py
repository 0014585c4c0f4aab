"""What can be asked of a place."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Literal

from kinetostat import _core
from kinetostat.errors import ArgumentError

__all__ = ["Variable", "variables"]

Worse = Literal["smaller", "larger", "larger size", "neither"]

AXES: dict[str, tuple[str, ...]] = {"axis": ("x", "y", "z"), "principal": ("softest", "middle", "stiffest")}
"""Coordinates of the columns of variables."""


@dataclasses.dataclass(frozen=True)
class Variable:
    """A result of a place.

    Examples
    --------
    >>> variables()["deflection"].worse, variables()["principal_compliance"].dims
    ('larger', ('principal',))
    """

    name: str
    unit: str
    """SI; ``1`` without one."""
    columns: int | None
    """How many numbers it is; none: one for each actuator."""
    description: str
    worse: Worse
    """Which of two values is the worse one."""

    @property
    def dims(self) -> tuple[str, ...]:
        """Dimensions of its columns in a map."""
        if self.columns == 1:
            return ()
        if self.columns is None:
            return ("actuator",)
        if self.name == "principal_directions":
            return ("principal", "axis")
        if self.name.startswith("principal_"):
            return ("principal",)
        return ("axis",) if self.columns == 3 else (f"{self.name}_column",)


def variables() -> dict[str, Variable]:
    """Variables of a map by their names.

    Examples
    --------
    >>> variables()["stiffness_softest"].unit
    'N/m'
    """
    return {row[0]: Variable(*row) for row in _core.map_variables()}


def chosen(names: str | Sequence[str]) -> list[Variable]:
    """Variables by their names, each known and once."""
    known = variables()
    wanted = [names] if isinstance(names, str) else list(names)
    for name in wanted:
        if name not in known:
            raise ArgumentError(f"variables has {name!r}, expected some of {', '.join(known)}")
    if not wanted or len(set(wanted)) < len(wanted):
        raise ArgumentError(f"variables is {wanted}, expected one or more names, each once")
    return [known[name] for name in wanted]
