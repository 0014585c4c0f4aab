"""What can be asked of a place."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import Any, Literal

from kinetostat import _core
from kinetostat._arguments import refused, shown, texts
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
        if self.name == "natural_frequencies":
            return ("mode",)
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


def a_map(found: Any) -> Any:
    """A Dataset that is a map."""
    if not hasattr(found, "data_vars") or "status" not in found.data_vars:
        raise refused("found", found, "a map, a Dataset of xarray with the variable 'status'")
    return found


def chosen(names: str | Sequence[str]) -> list[Variable]:
    """Variables by their names, each known and once."""
    known = variables()
    wanted = [names] if isinstance(names, str) else texts("variables", names, f"a list of {', '.join(known)}")
    for name in wanted:
        if name not in known:
            raise ArgumentError(f"variables has {shown(name)}, expected some of {', '.join(known)}")
    if not wanted or len(set(wanted)) < len(wanted):
        raise ArgumentError(f"variables is {shown(wanted)}, expected one or more names, each once")
    return [known[name] for name in wanted]
