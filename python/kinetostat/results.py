"""Results of many postures: arrays with one row for each, and what became of it."""

from __future__ import annotations

import dataclasses
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from kinetostat._plausibility import counted
from kinetostat.status import Status

if TYPE_CHECKING:
    import pandas
    import xarray
    from typing_extensions import Self

__all__ = ["Equilibria", "Frames", "Gradients", "Stiffnesses", "Targets"]

Floats = NDArray[np.float64]

_LEFT_OUT: Any = None
"""An array that ``fields`` leaves out."""

_COMPONENTS = ("x", "y", "z", "rx", "ry", "rz")

_INNER = {
    **dict.fromkeys(("matrix", "stiffness"), ("component", "direction")),
    **dict.fromkeys(("tool", "targets"), ("row", "column")),
    **dict.fromkeys(("commands", "actuator_forces"), ("actuator",)),
    "displacement": ("component",),
    "frames": ("node", "row", "column"),
}
"""Axes of the arrays behind the leading ones."""


@dataclasses.dataclass(frozen=True, eq=False)
class _OfMany:
    """Arrays with the same leading axes; states as numbers of :class:`Status`."""

    status: NDArray[np.uint8]
    """(...,): :class:`Status` of each posture."""
    warnings: tuple[str, ...] = dataclasses.field(default=(), kw_only=True)
    """Loads, displacements and places that look wrong although they can be computed; those beyond a limit are issued, too."""

    @property
    def solved(self) -> NDArray[np.bool_]:
        """(...,): where there is an answer, whether within the limits of the actuators or not."""
        return np.asarray(self.status != Status.UNSOLVED)

    def to_dict(self) -> dict[str, Any]:
        """All arrays by their names."""
        return {field.name: getattr(self, field.name) for field in dataclasses.fields(self) if not field.kw_only}

    def __len__(self) -> int:
        """Rows along the first axis."""
        return len(self.status)

    def __getitem__(self, index: Any) -> Self:
        """Rows by an index, a slice or a mask of the leading axes."""
        found: dict[str, Any] = {name: value if value is None else value[index] for name, value in self.to_dict().items()}
        return type(self)(**found | {"status": np.asarray(found["status"], np.uint8), "warnings": self.warnings})

    def to_xarray(self) -> xarray.Dataset:
        """A Dataset; leading axes are ``dim_0``, ``dim_1``, components and actuators their own (SI units).

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("orthoglide").equilibrium([[0, 0, 0], [9, 0, 0]], [100, 0, 0, 0, 0, 0])
        >>> found.to_xarray().displacement.sel(component="x").shape
        (2,)
        """
        try:
            import xarray
        except ImportError as absent:
            raise ImportError("to_xarray needs xarray: pip install 'kinetostat[io]'") from absent
        leading = [f"dim_{k}" for k in range(self.status.ndim)]
        data = {name: ([*leading, *_INNER.get(name, ())], value) for name, value in self.to_dict().items() if value is not None}
        return xarray.Dataset(data, {"component": list(_COMPONENTS), "direction": list(_COMPONENTS)})

    def to_pandas(self) -> pandas.DataFrame:
        """A DataFrame with one row for each posture; arrays of several numbers are columns as ``displacement_x`` (SI units).

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("orthoglide").equilibrium([[0, 0, 0], [9, 0, 0]], [100, 0, 0, 0, 0, 0])
        >>> round(float(found.to_pandas().displacement_x[0]) * 1e6, 1)
        33.3
        """
        try:
            import pandas
        except ImportError as absent:
            raise ImportError("to_pandas needs pandas: pip install pandas") from absent
        columns: dict[str, Any] = {}
        for name, value in self.to_dict().items():
            if value is None:
                continue
            flat = value.reshape(self.status.size, *value.shape[self.status.ndim :])
            inner = zip(_INNER.get(name, ()), flat.shape[1:], strict=True)
            words = [_COMPONENTS if dim in ("component", "direction") else [str(k) for k in range(size)] for dim, size in inner]
            for at, column in zip(np.ndindex(flat.shape[1:]), flat.reshape(len(flat), -1).T, strict=True):
                columns["_".join([name, *(own[k] for own, k in zip(words, at, strict=True))])] = column
        return pandas.DataFrame(columns)

    def __repr__(self) -> str:
        """Names and shapes, and how many are solved."""
        shapes = ", ".join(f"{name} {value.shape}" for name, value in self.to_dict().items() if value is not None and name != "status")
        return f"<{type(self).__name__}: {int(self.solved.sum())} of {self.status.size} solved; {shapes}{counted(self.warnings)}>"


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

    commands: Floats
    """(..., actuators): m or rad."""
    tool: Floats = _LEFT_OUT
    """(..., 4, 4): pose of the tool under the load, base from tool, m. NaN where unsolved; none where ``fields`` leaves it out."""
    displacement: Floats = _LEFT_OUT
    """(..., 6): from the commanded pose to that under the load, m and rad, base axes; none where ``fields`` leaves it out."""
    actuator_forces: Floats = _LEFT_OUT
    """(..., actuators): N or N m, of the loads on the actuators; none where ``fields`` leaves them out."""
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


@dataclasses.dataclass(frozen=True, eq=False, repr=False)
class Frames(_OfMany):
    """Forward kinematics of many postures of the unloaded machine as drawn.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("scara").frames([[0.4, 1.1, -0.05, 0.3], [0.1, 0.4, 0, 0]])
    >>> found.frames.shape == (2, len(found.nodes), 4, 4), found.nodes[-1]
    (True, ('arm', 'tip'))
    """

    tool: Floats
    """(..., 4, 4): pose of the tool, base from tool, m."""
    frames: Floats
    """(..., nodes, 4, 4): poses of all nodes of all limbs, base from node, m."""
    nodes: tuple[tuple[str, str], ...] = dataclasses.field(kw_only=True)
    """Limb and name of each node."""

    def __getitem__(self, index: Any) -> Self:
        """Rows by an index, a slice or a mask of the leading axes."""
        return type(self)(np.asarray(self.status[index]), self.tool[index], self.frames[index], nodes=self.nodes, warnings=self.warnings)


@dataclasses.dataclass(frozen=True, eq=False)
class Gradients:
    """Derivatives of the tool's pose and of the stiffness matrix by numbers of the model file, per their units, the commands being held.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("scara").posture().gradients()
    >>> found.stiffness.shape == (len(found.paths), 6, 6)
    True
    """

    paths: tuple[str, ...]
    """Paths of the numbers."""
    values: Floats
    """(p,): their values, in their units."""
    units: tuple[str, ...]
    """Their units."""
    pose: Floats
    """(p, 6): motion of the tool, m and rad, base axes, by each number. NaN where :attr:`unanswered` has the path."""
    stiffness: Floats
    """(p, 6, 6): change of the stiffness matrix, N/m, N/rad; N m/m, N m/rad, by each number."""
    pose_error: Floats
    """(p, 6): estimated errors of :attr:`pose`."""
    stiffness_error: Floats
    """(p, 6, 6): estimated errors of :attr:`stiffness`."""
    unanswered: dict[str, str]
    """Reasons for the numbers without derivatives, by path."""
