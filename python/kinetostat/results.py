"""Results of many postures: arrays with one row for each, and what became of it."""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
from numpy.typing import NDArray

from kinetostat.status import Status

__all__ = ["Equilibria", "Stiffnesses", "Targets"]

Floats = NDArray[np.float64]


@dataclasses.dataclass(frozen=True, eq=False)
class _OfMany:
    """Arrays with the same leading axes; states as numbers of :class:`Status`."""

    status: NDArray[np.uint8]
    """(...,): :class:`Status` of each posture."""

    @property
    def solved(self) -> NDArray[np.bool_]:
        """(...,): where there is an answer, whether within the limits of the actuators or not."""
        return np.asarray(self.status != Status.UNSOLVED)

    def to_dict(self) -> dict[str, Any]:
        """All arrays by their names."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self)}

    def __repr__(self) -> str:
        """Names and shapes, and how many are solved."""
        shapes = ", ".join(f"{name} {value.shape}" for name, value in self.to_dict().items() if value is not None and name != "status")
        return f"<{type(self).__name__}: {int(self.solved.sum())} of {self.status.size} solved; {shapes}>"


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Stiffnesses(_OfMany):
    """Cartesian stiffness of many unloaded postures of the machine as drawn.

    Examples
    --------
    >>> import kinetostat as ks
    >>> ks.Machine.preset("orthoglide").stiffness([[0, 0, 0], [9, 0, 0]])
    <Stiffnesses: 1 of 2 solved; matrix (2, 6, 6), commands (2, 3)>
    """

    matrix: Floats
    """(..., 6, 6): N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point. NaN where unsolved, and along axes that
    a rigid direction has a part in."""
    commands: Floats
    """(..., actuators): m or rad."""

    @property
    def compliance(self) -> Floats:
        """(..., 6, 6): inverse of the matrix; NaN where it is singular or unsolved.

        What is singular is decided where every direction is measured alike: with rotations at 1 m, relative pivots
        below 1e-12. :meth:`Posture.stiffness` names the free and the rigid directions of one posture.
        """
        flat = self.matrix.reshape(-1, 6, 6)
        out = np.full_like(flat, np.nan)
        finite = np.flatnonzero(np.isfinite(flat).all(axis=(1, 2)))
        known = finite[np.linalg.cond(flat[finite]) < 1e12]
        out[known] = np.linalg.inv(flat[known])
        return out.reshape(self.matrix.shape)


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Equilibria(_OfMany):
    """Equilibria of many postures under load: of the machine as it is, with its own loads and deviations.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").equilibrium([[0, 0, 0], [9, 0, 0]], [100, 0, 0, 0, 0, 0])
    >>> found.solved.tolist(), found.stable.tolist()
    ([True, False], [True, False])
    """

    tool: Floats
    """(..., 4, 4): pose of the tool under the load, base from tool, m. NaN where unsolved."""
    displacement: Floats
    """(..., 6): from the commanded pose to that under the load, m and rad, base axes."""
    commands: Floats
    """(..., actuators): m or rad."""
    actuator_forces: Floats
    """(..., actuators): N or N m, of the loads on the actuators."""
    stiffness: Floats | None = None
    """(..., 6, 6): tangent stiffness, NaN along axes that a rigid direction has a part in; none with ``details="rest"``."""
    stable: NDArray[np.bool_] | None = None
    """(...,): every limb keeps its shape and the platform its place; False where unsolved. None unless
    ``details="stability"``."""
    against_force: Floats | None = None
    """(...,): N/m in the softest direction of a force while the tool may turn."""
    share_to_buckling: Floats | None = None
    """(...,): largest share of the way to buckling of all limbs, below 1 is stable; NaN where nothing buckles."""


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Targets(_OfMany):
    """Poses to command so that the loaded tool is where it should be.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").targets([[0, 0, 0]], [100, 0, 0, 0, 0, 0])
    >>> bool(found.targets[0, 0, 3] < 0)  # against the force
    True
    """

    targets: Floats
    """(..., 4, 4): pose to command, base from tool, m."""
    tool: Floats
    """(..., 4, 4): where the tool is then, under the load."""
    commands: Floats
    """(..., actuators): m or rad, of the commanded poses."""
