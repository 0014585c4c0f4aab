"""Equilibrium as functions of plain vectors, for solvers of others."""

from __future__ import annotations

from typing import TYPE_CHECKING, final

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arguments import of_kind
from kinetostat._arrays import Floats, one
from kinetostat.spatial import rotation_from_vector

if TYPE_CHECKING:
    from kinetostat.posture import Posture

__all__ = ["EquilibriumProblem"]


def _hat(v: Floats) -> Floats:
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def _spin_of_rotation_vector(v: Floats) -> Floats:
    """(3, 3): rotation in base axes per change of a rotation vector."""
    angle = float(np.linalg.norm(v))
    hat = _hat(v)
    # (1 - cos a)/a^2 and (a - sin a)/a^3, the second by its series where its difference would cancel.
    first = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    second = (angle - np.sin(angle)) / angle**3 if angle > 1e-2 else 1 / 6 - angle**2 / 120 + angle**4 / 5040
    out: Floats = np.eye(3) + first * hat + second * (hat @ hat)
    return out


@final
class EquilibriumProblem:
    """The wrench that holds the tool less the wrench that acts on it, as a function of where the tool is.

    Unknowns are the six of the tool: ``x = [position - commanded position (m), rotation vector from the commanded orientation (rad)]``,
    base axes. For every ``x`` all limbs are in equilibrium with the tool held there; where the residual vanishes the tool needs no holding.

    Parameters
    ----------
    posture : Posture
        The commanded posture.
    wrench : array_like, shape (6,)
        Force and moment on the tool (N, N m), base axes, about its reference point.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> problem = ks.Machine.preset("orthoglide").posture().equilibrium_problem([100, 0, 0, 0, 0, 0])
    >>> x = problem.x0
    >>> for _ in range(5):
    ...     x = x - np.linalg.solve(problem.jacobian(x), problem.residual(x))
    >>> bool(np.abs(problem.residual(x)).max() < 1e-6)
    True
    """

    __slots__ = ("_last", "posture", "wrench")

    def __init__(self, posture: Posture, wrench: ArrayLike = (0.0,) * 6) -> None:
        from kinetostat.posture import Posture

        self.posture = of_kind("posture", posture, Posture, "a Posture")
        """The commanded posture."""
        self.wrench = one("wrench", wrench, (6,)).copy()
        """(6,): N, N m."""
        self._last: tuple[bytes, Floats, Floats] | None = None

    @property
    def x0(self) -> Floats:
        """(6,): where to start, the commanded pose."""
        return np.zeros(6)

    def tool(self, x: ArrayLike) -> Floats:
        """(4, 4): pose of the tool for unknowns (6,), base from tool, m.

        Examples
        --------
        >>> import kinetostat as ks
        >>> problem = ks.Machine.preset("orthoglide").posture().equilibrium_problem()
        >>> float(problem.tool([0.001, 0, 0, 0, 0, 0])[0, 3])
        0.001
        """
        given = one("x", x, (6,))
        pose = self.posture.target
        pose[:3, 3] += given[:3]
        pose[:3, :3] = rotation_from_vector(given[3:]) @ pose[:3, :3]
        return pose

    def _at(self, x: ArrayLike) -> tuple[Floats, Floats]:
        given = one("x", x, (6,))
        key = given.tobytes()
        if self._last is None or self._last[0] != key:
            found = self.posture.held_at(self.tool(given))
            self._last = (key, found.wrench, found.stiffness)
        return self._last[1], self._last[2]

    def residual(self, x: ArrayLike) -> Floats:
        """(6,): holding wrench less acting wrench, N and N m.

        Parameters
        ----------
        x : array_like, shape (6,)
            Unknowns, m and rad.

        Raises
        ------
        UnansweredError
            The limbs have no equilibrium with the tool there.

        Examples
        --------
        >>> import kinetostat as ks
        >>> problem = ks.Machine.preset("orthoglide").posture().equilibrium_problem([100, 0, 0, 0, 0, 0])
        >>> round(float(problem.residual(problem.x0)[0]), 6)
        -100.0
        """
        out: Floats = self._at(x)[0] - self.wrench
        return out

    def jacobian(self, x: ArrayLike) -> Floats:
        """(6, 6): derivative of the residual by ``x``; N/m, N/rad; N m/m, N m/rad.

        Examples
        --------
        >>> import numpy as np
        >>> import kinetostat as ks
        >>> posture = ks.Machine.preset("orthoglide").posture()
        >>> bool(np.allclose(posture.equilibrium_problem().jacobian(np.zeros(6)), posture.stiffness().matrix, rtol=1e-6, atol=1e-3))
        True
        """
        given = one("x", x, (6,))
        out: Floats = self._at(given)[1].copy()
        out[:, 3:] = out[:, 3:] @ _spin_of_rotation_vector(given[3:])
        return out
