"""A drive of a machine, as its model states it."""

from __future__ import annotations

import dataclasses
from typing import Literal

__all__ = ["Actuator"]


@dataclasses.dataclass(frozen=True)
class Actuator:
    """A drive of a machine.

    Examples
    --------
    >>> import kinetostat as ks
    >>> drive = ks.Machine.preset("orthoglide").actuators[0]
    >>> drive.name, drive.kind, drive.unit
    ('leg x.slider', 'prismatic', 'm')
    """

    name: str
    """``limb.actuator``, or the actuator's own name in a machine of one limb."""
    kind: Literal["prismatic", "revolute"]
    home: float
    """Command at home, m or rad."""
    limits: tuple[float, float] | None
    """Smallest and largest command, m or rad; none where the model states none."""
    rating: float | None
    """Largest force (N) or torque (N m) that the model states; none where it states none."""

    @property
    def unit(self) -> Literal["m", "rad"]:
        """Unit of its commands."""
        return "m" if self.kind == "prismatic" else "rad"
