"""One posture of a machine, and what it answers: stiffness, equilibria, curves."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, NamedTuple, final

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core
from kinetostat._arguments import one_of, or_none, text, texts
from kinetostat._arrays import Floats, one, thread_count
from kinetostat._plausibility import counted, sentences
from kinetostat.display import equilibrium_html, posture_html, stiffness_html
from kinetostat.errors import KinetostatError
from kinetostat.results import Gradients
from kinetostat.spatial import rotation_vector
from kinetostat.status import DirectionKind, FoundBy, Status

if TYPE_CHECKING:
    from kinetostat.assembly import Assembly
    from kinetostat.curves import ForceCurve
    from kinetostat.force_models import ForceModel, ModelEquilibria
    from kinetostat.machine import Machine, Progress
    from kinetostat.page import View
    from kinetostat.problem import EquilibriumProblem
    from kinetostat.shapes import Shapes
    from kinetostat.shares import Shares
    from kinetostat.vibration import Vibration

__all__ = ["Direction", "Equilibrium", "LimbStiffness", "LimitViolation", "Posture", "Stiffness"]


class Direction(NamedTuple):
    """A principal direction of a stiffness.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").posture().stiffness().directions[0]
    >>> found.kind.value, found.twist.shape
    ('finite', (6,))
    """

    kind: DirectionKind
    stiffness: float
    """N/m, rotations referred to the machine's natural length; infinite where rigid."""
    twist: Floats
    """(6,): the motion, m and rad, base axes, about the tool's reference point; its longest part is 1 m."""
    behind: list[dict[str, Any]]
    """Joints and springs that move in it, of free and negative directions."""


class LimbStiffness(NamedTuple):
    """Tangent stiffness of a limb at its end, with the motions of its joints and springs [R 4.25, 6.5, 6.8]; base axes.

    A motion ``dt`` of the platform (m, rad, about its reference point) is ``T dt`` at the limb's end, with ``T`` of :attr:`to_end`. The
    limb's share in the stiffness of the platform is ``T.T @ matrix @ T``, and ``lever`` more in the rotations.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> loaded = ks.Machine.preset("stewart_gough_b").posture().deflected_by([0, 0, -1000, 0, 0, 0])
    >>> total = np.zeros((6, 6))
    >>> for limb in loaded.limbs:
    ...     total += limb.to_end.T @ limb.matrix @ limb.to_end
    ...     total[3:, 3:] += limb.lever
    >>> bool(np.allclose(total, loaded.stiffness, rtol=1e-6, atol=1e-3))
    True
    """

    name: str
    platform: str
    """Platform at the limb's end."""
    arm: Floats
    """(3,): from the platform's reference point to the limb's end, m."""
    matrix: Floats
    """(6, 6): ``K_C`` at the limb's end, N/m, N/rad; N m/m, N m/rad; NaN along axes that the limb cannot move along."""
    passive_joints: tuple[str, ...]
    """Names of the rows of ``passive``."""
    passive: Floats
    """(passive joints, 6): ``K_Cq``, m or rad per m and rad of the limb's end."""
    spring_names: tuple[str, ...]
    """Names of the rows of ``springs``."""
    springs: Floats
    """(springs, 6): ``K_Ctheta``, m or rad per m and rad of the limb's end."""
    lever: Floats
    """(3, 3): stiffness of rotations of the platform by the limb's force at its arm, N m/rad; zero without a load."""

    @property
    def to_end(self) -> Floats:
        """(6, 6): ``T``, from the motion of the platform to that of the limb's end."""
        x, y, z = self.arm
        out = np.eye(6)
        out[:3, 3:] = [[0, z, -y], [-z, 0, x], [y, -x, 0]]
        return out


class LimitViolation(NamedTuple):
    """An actuator outside its limits.

    Examples
    --------
    >>> import kinetostat as ks
    >>> ks.Machine.preset("orthoglide").posture([0.25, 0, 0]).limit_violations[0].actuator
    'leg x.slider'
    """

    actuator: str
    command: float
    lower: float
    upper: float


_Of = Literal["theta", "passive", "actuated", "all"]

_DEFLECTED = ("deflected_by", None)
"""What an equilibrium under a wrench was asked, which it knows itself."""


def _directions(text: str) -> tuple[Direction, ...]:
    def number(value: float | None) -> float:
        return np.inf if value is None else float(value)

    def of(d: dict[str, Any]) -> Direction:
        return Direction(DirectionKind(d["kind"]), number(d["stiffness_n_per_m"]), np.array(d["twist"], dtype=float), d["behind"])

    return tuple(of(found) for found in json.loads(text))


def _limbs(text: str) -> tuple[LimbStiffness, ...]:
    def rows(own: list[dict[str, Any]]) -> tuple[tuple[str, ...], Floats]:
        return tuple(r["name"] for r in own), np.array([r["per_motion_of_end"] for r in own], dtype=float).reshape(-1, 6)

    return tuple(
        LimbStiffness(
            limb["name"],
            limb["platform"],
            np.array(limb["arm_m"], dtype=float),
            np.array(limb["stiffness_n_m_rad"], dtype=float),
            *rows(limb["passive_joints"]),
            *rows(limb["springs"]),
            np.array(limb["lever_n_m_per_rad"], dtype=float),
        )
        for limb in json.loads(text)
    )


@final
class Stiffness:
    """Cartesian stiffness of an unloaded posture of the machine as drawn [R 3.37-3.43].

    Examples
    --------
    >>> import kinetostat as ks
    >>> k = ks.Machine.preset("orthoglide").posture().stiffness()
    >>> k.rank, k.matrix.shape
    (6, (6, 6))
    >>> k.directions[0].kind
    <DirectionKind.FINITE: 'finite'>
    """

    __slots__ = ("_native", "posture")

    def __init__(self, posture: Posture, native: _core.Stiffness) -> None:
        self.posture = posture
        """The posture."""
        self._native = native

    @property
    def matrix(self) -> Floats:
        """(6, 6): N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point.

        NaN in the rows and columns of axes that a rigid direction has a part in: there it is infinite, and :attr:`compliance` holds.
        """
        return self._native.matrix

    @property
    def compliance(self) -> Floats:
        """(6, 6): m/N, m/(N m); rad/N, rad/(N m), within the directions that are neither free nor rigid."""
        return self._native.compliance

    @property
    def rank(self) -> int:
        """Number of directions that are not free."""
        return self._native.rank

    @property
    def against_force(self) -> float:
        """N/m in the softest direction of a force while the tool may turn; 0 where a direction is free."""
        return self._native.against_force

    @property
    def directions(self) -> tuple[Direction, ...]:
        """Principal directions."""
        return _directions(self._native.directions_json())

    @property
    def limbs(self) -> tuple[LimbStiffness, ...]:
        """Stiffness of every limb at its end, in the order of the machine."""
        return _limbs(self.posture._native.limbs_of_stiffness(self._native))

    def __reduce__(self) -> tuple[Any, ...]:
        return Posture.stiffness, (self.posture,)

    def __repr__(self) -> str:
        return repr(self._native)

    def _repr_html_(self) -> str:
        return stiffness_html(self)


@final
class Equilibrium:
    """Equilibrium of a machine under a wrench on its tool [R 4.28-4.34, 6.21-6.30].

    Examples
    --------
    >>> import kinetostat as ks
    >>> loaded = ks.Machine.preset("orthoglide").posture().deflected_by([100, 0, 0, 0, 0, 0])
    >>> loaded.stable, loaded.found_by
    (True, <FoundBy.DIRECTLY: 'directly'>)
    """

    __slots__ = ("_native", "_question", "posture")

    def __init__(self, posture: Posture, native: _core.Equilibrium, question: tuple[str, Any]) -> None:
        self.posture = posture
        """The commanded posture."""
        self._native = native
        self._question = question

    @property
    def tool(self) -> Floats:
        """(4, 4): pose of the tool, base from tool, m."""
        return self._native.tool

    @property
    def displacement(self) -> Floats:
        """(6,): from the commanded pose to that under load, m and rad, base axes."""
        return self._native.displacement

    def view(self) -> View:
        """The equilibrium in three dimensions; a notebook shows it.

        It is solved anew from the commands of its posture and its wrench.

        Examples
        --------
        >>> import kinetostat as ks
        >>> loaded = ks.Machine.preset("orthoglide").posture().deflected_by([100, 0, 0, 0, 0, 0])
        >>> loaded.view().html[:15]
        '<!doctype html>'
        """
        from kinetostat.page import View

        return View(self.posture, self.wrench)

    @property
    def displacement_without_load(self) -> Floats:
        """(6,): from the commanded pose to that without the wrench, by own weight, other loads of the model and its deviations, m and rad.

        Found anew each time that it is asked; :class:`UnansweredError <kinetostat.errors.UnansweredError>` where there is no equilibrium.
        """
        return self.posture.deflected_by(np.zeros(6)).displacement

    @property
    def displacement_by_load(self) -> Floats:
        """(6,): from the pose without the wrench to that under it, m and rad, base axes: own weight is not in it.

        Examples
        --------
        >>> import kinetostat as ks
        >>> loaded = ks.Machine.preset("heavy_6r").posture().deflected_by([0, 0, -100, 0, 0, 0])
        >>> own = loaded.displacement_without_load
        >>> bool(np.allclose(own[:3] + loaded.displacement_by_load[:3], loaded.displacement[:3], rtol=0, atol=1e-12))
        True
        >>> bool(abs(own[2]) > 5 * abs(loaded.displacement_by_load[2]))
        True
        """
        rest = self.posture.deflected_by(np.zeros(6)).tool
        turn = rotation_vector(self.tool[:3, :3] @ rest[:3, :3].T)
        return np.concatenate([self.tool[:3, 3] - rest[:3, 3], turn])

    @property
    def wrench(self) -> Floats:
        """(6,): N and N m on the tool, base axes, about its reference point."""
        return self._native.wrench

    @property
    def stiffness(self) -> Floats:
        """(6, 6): tangent stiffness; N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point.

        NaN in the rows and columns of axes that a rigid direction has a part in: there it is infinite, and :attr:`compliance` holds.
        """
        return self._native.stiffness

    @property
    def compliance(self) -> Floats:
        """(6, 6): inverse of :attr:`stiffness` within the directions that are neither free nor rigid; m/N, m/(N m); rad/N, rad/(N m)."""
        return self._native.compliance

    @property
    def actuator_forces(self) -> Floats:
        """(actuators,): N and N m of the loads on the actuators."""
        return self._native.actuator_forces

    @property
    def stable(self) -> bool:
        """Whether every limb keeps its shape and the platform its place."""
        return self._native.stable

    @property
    def share_to_buckling(self) -> float | None:
        """Largest share of the way to buckling of all limbs, below 1 is stable; none where nothing buckles."""
        return self._native.share_to_buckling

    @property
    def against_force(self) -> float:
        """N/m in the softest direction of a force while the tool may turn."""
        return self._native.against_force

    @property
    def energy(self) -> float | None:
        """Of springs, weights and loads of the model, J, without the wrench on the tool; none where a load has no potential.

        Its zero is arbitrary, that of the weights and loads, and the same in all equilibria of a posture: differences count.
        """
        return self._native.energy

    @property
    def spring_energy(self) -> float:
        """Stored in all springs, J."""
        return self._native.spring_energy

    @property
    def warnings(self) -> tuple[str, ...]:
        """What looks wrong in the load and the displacement although it can be computed, as the command ``deflect`` says it."""
        return sentences(_core.load_warnings(self.posture._native, self._native))

    @property
    def found_by(self) -> FoundBy:
        """How it was found: where several equilibria exist it tells which of them this is."""
        return FoundBy(json.loads(self._native.found_by_json()))

    @property
    def directions(self) -> tuple[Direction, ...]:
        """Principal directions of the tangent stiffness."""
        return _directions(self._native.directions_json())

    @property
    def limbs(self) -> tuple[LimbStiffness, ...]:
        """Stiffness of every limb at its end, in the order of the machine."""
        return _limbs(self.posture._native.limbs_of_equilibrium(self._native))

    def __reduce__(self) -> tuple[Any, ...]:
        kind, value = self._question
        return getattr(Posture, kind), (self.posture, self._native.wrench.tolist() if value is None else value)

    def __repr__(self) -> str:
        return f"{repr(self._native)[:-1]}{counted(self.warnings)}>"

    def _repr_html_(self) -> str:
        return equilibrium_html(self)


@final
class Posture:
    """A machine whose actuators are commanded; made by :meth:`Machine.posture`, never changed.

    Postures are equal where machine, target and all coordinates of all limbs are; they can be pickled, and come back with
    these numbers to the last bit.

    Examples
    --------
    >>> import copy, pickle
    >>> import kinetostat as ks
    >>> posture = ks.Machine.preset("orthoglide").posture([0.01, 0, 0])
    >>> pickle.loads(pickle.dumps(posture)) == posture, copy.deepcopy(posture) == posture
    (True, True)
    >>> posture.status
    <Status.SOLVED: 0>
    """

    __slots__ = ("__weakref__", "_native", "_target", "machine")

    def __init__(self, machine: Machine, native: _core.Posture, target: Floats | None = None) -> None:
        self.machine = machine
        """The machine."""
        self._native = native
        self._target = None if target is None else target.copy()

    @property
    def commands(self) -> Floats:
        """(actuators,): m or rad."""
        return self._native.commands

    @property
    def target(self) -> Floats:
        """(4, 4): where the tool is commanded to, base from tool, m."""
        return self._native.target if self._target is None else self._target.copy()

    @property
    def limbs(self) -> tuple[tuple[Floats, Floats], ...]:
        """Of every limb: commands of its actuators and all its coordinates (springs at home, passive joints), m or rad."""
        return tuple((np.array(commands), np.array(coordinates)) for commands, coordinates in self._native.limbs)

    def limb_lines(self) -> list[Floats]:
        """Each limb as a line (n, 3) through its joints and the ends of its links; base axes, m.

        Examples
        --------
        >>> import kinetostat as ks
        >>> [line.shape[1] for line in ks.Machine.preset("orthoglide").posture().limb_lines()]
        [3, 3, 3]
        """
        return self._native.limb_lines()

    @property
    def limit_violations(self) -> list[LimitViolation]:
        """Actuators outside their limits, m or rad."""
        return [LimitViolation(*row) for row in self._native.limit_violations]

    @property
    def status(self) -> Status:
        """Whether all commands are within their limits."""
        return Status.OUTSIDE_LIMITS if self._native.limit_violations else Status.SOLVED

    def to_pyvista(self, *, axes: float | None = None) -> Any:
        """The machine at this posture as a ``pyvista.MultiBlock``; see :func:`kinetostat.view.to_pyvista`.

        Examples
        --------
        >>> import kinetostat as ks
        >>> blocks = ks.Machine.preset("heavy_6r").posture().to_pyvista()
        >>> blocks.keys()
        ['arm', 'tool']
        """
        from kinetostat.view import to_pyvista

        return to_pyvista(self, axes=axes)

    # What it answers ---------------------------------------------------------------------------------------------------

    def stiffness(self) -> Stiffness:
        """Cartesian stiffness of the unloaded machine as drawn.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("orthoglide").posture().stiffness().rank
        6
        """
        return Stiffness(self, self._native.stiffness())

    def deflected_by(self, wrench: ArrayLike) -> Equilibrium:
        """Equilibrium of the machine as it is, with its own loads and deviations, under a wrench on the tool.

        Parameters
        ----------
        wrench : array_like, shape (6,)
            Force and moment (N, N m), base axes, about the tool's reference point.

        Raises
        ------
        UnansweredError
            No equilibrium was found: how far the load got.

        Warns
        -----
        PlausibilityWarning
            The load is beyond what machining has, or the machine folds over under it.

        Examples
        --------
        >>> import kinetostat as ks
        >>> loaded = ks.Machine.preset("orthoglide").posture().deflected_by([100, 0, 0, 0, 0, 0])
        >>> round(float(loaded.displacement[0]) * 1e6, 1)
        33.3
        """
        # Issues the warnings, too: each way from Python into the core and back takes half a microsecond.
        return Equilibrium(self, self.machine._native.deflected(self._native, wrench), _DEFLECTED)

    def frames(self) -> dict[tuple[str, str], Floats]:
        """(4, 4) by limb and node: poses of all nodes of the unloaded machine as drawn, base from node, m.

        Examples
        --------
        >>> import kinetostat as ks
        >>> list(ks.Machine.preset("two_link").posture().frames())[-1]
        ('arm', 'tip')
        """
        return dict(zip(_core.frame_names(self.machine._native), _core.frames_of(self._native), strict=True))

    def jacobian(self, of: _Of = "theta", *, at: str | None = None, limb: str | None = None) -> Floats:
        """Jacobian of a node of a limb [R 3.2-3.6], for the unloaded machine as drawn.

        Parameters
        ----------
        of : {"theta", "passive", "actuated", "all"}
            Columns: coordinates of springs, passive joints, commands of actuators, or all in the order of :meth:`coordinates`.
        at : str, optional
            Name of a node; the reference point of the platform at which the limb ends, that of the tool as a rule, without it.
        limb : str, optional
            Name of the limb; needed where there are several.

        Returns
        -------
        ndarray, shape (6, n)
            Motion of the node's origin, m and rad, base axes, by each coordinate, m or rad.

        Examples
        --------
        >>> import numpy as np
        >>> import kinetostat as ks
        >>> posture = ks.Machine.preset("heavy_6r").posture()
        >>> j, k = posture.jacobian("theta"), posture.joint_stiffness()
        >>> bool(np.allclose(j @ np.linalg.inv(k) @ j.T, posture.stiffness().compliance, rtol=1e-9, atol=1e-15))
        True
        """
        number, columns = self._columns(of, limb)
        found: Floats = _core.limb_jacobian(self._native, number, or_none(text, "at", at))[:, columns]
        return found

    def joint_stiffness(self, *, limb: str | None = None) -> Floats:
        """(n, n): stiffness matrix ``K_theta`` of the springs of a limb [R 3.7], in the order of ``jacobian("theta")``; N/m, N, N m/rad.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("scara").posture().joint_stiffness().shape
        (28, 28)
        """
        return _core.limb_springs(self._native, self._limb(limb))

    def load_hessian(self, wrench: ArrayLike, of: _Of = "theta", *, at: str | None = None, limb: str | None = None) -> Floats:
        """Hessian of a wrench on a node of a limb [R 4.21]: the derivative of ``J.T @ wrench`` by the coordinates.

        Parameters
        ----------
        wrench : array_like, shape (6,)
            Force and moment (N, N m), base axes, about the node's origin; it keeps its direction.
        of, at, limb
            As for :meth:`jacobian`.

        Returns
        -------
        ndarray, shape (n, n)
            N/m, N, N m/rad; symmetric where no moment acts.

        Examples
        --------
        >>> import kinetostat as ks
        >>> h = ks.Machine.preset("heavy_6r").posture().load_hessian([0, 0, -500, 0, 0, 0], "actuated")
        >>> h.shape, bool(abs(h - h.T).max() < 1e-9)
        ((6, 6), True)
        """
        number, columns = self._columns(of, limb)
        found = _core.limb_hessian(self._native, number, one("wrench", wrench, (6,))[None], or_none(text, "at", at))
        return found[np.ix_(columns, columns)]

    def coordinates(self, of: _Of = "all", *, limb: str | None = None) -> tuple[str, ...]:
        """Names of the columns of :meth:`jacobian`.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("orthoglide").posture().coordinates("passive", limb="leg x")
        ('q1', 'q2', 'q3')
        """
        number, columns = self._columns(of, limb)
        names = _core.limb_coordinates(self._native, number)
        return tuple(names[column][0] for column in columns)

    def _limb(self, name: str | None) -> int:
        limbs = self.machine.limbs
        if name is None and len(limbs) == 1:
            return 0
        return limbs.index(one_of("limb", name, limbs))

    def _columns(self, of: str, limb: str | None) -> tuple[int, list[int]]:
        number = self._limb(limb)
        one_of("of", of, ("theta", "passive", "actuated", "all"))
        return number, [k for k, (_, role) in enumerate(_core.limb_coordinates(self._native, number)) if of in (role, "all")]

    def gradients(self, paths: Sequence[str] | None = None, wrench: ArrayLike | None = None, *, threads: int | None = None) -> Gradients:
        """Derivatives of the tool's pose and of the stiffness matrix by numbers of the model file, the commands being held.

        Parameters
        ----------
        paths : sequence of str, optional
            Numbers as :func:`kinetostat.shares.sensitivities` names them; all of the file without it.
        wrench : array_like, shape (6,), optional
            Load on the tool (N, N m): derivatives of the loaded pose and the tangent stiffness of the machine as it is. Of the unloaded
            machine as drawn without it.
        threads : int, optional
            As for :meth:`kinetostat.Machine.stiffness`.

        Returns
        -------
        Gradients

        Raises
        ------
        UnansweredError
            No equilibrium, or the commands alone do not lead to this posture.

        Notes
        -----
        By central differences of three steps, extrapolated to sixth order, with the difference to fourth order as the error.

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("heavy_6r").posture().gradients(["chain.arm.joint 2.stiffness_n_m_per_rad"])
        >>> bool(abs(found.pose).max() < 1e-9), bool(found.stiffness[0, 2, 2] > 0)
        (True, True)
        """
        names = [] if paths is None else texts("paths", paths, "a list of paths of numbers")
        load = None if wrench is None else one("wrench", wrench, (6,))[None]
        found = _core.gradients_of(self.machine._native, self._native, names, load, thread_count(threads))
        about = found.pop("about")
        return Gradients(
            paths=tuple(row[0] for row in about),
            values=np.array([row[1] for row in about], dtype=float),
            units=tuple(row[2] for row in about),
            unanswered={row[0]: row[3] for row in about if row[3] is not None},
            **found,
        )

    def held_at(self, pose: ArrayLike) -> Equilibrium:
        """Equilibrium with the tool held at a pose: the wrench that holds it is part of the answer.

        Parameters
        ----------
        pose : array_like, shape (4, 4)
            Base from tool, m.

        Examples
        --------
        >>> import kinetostat as ks
        >>> posture = ks.Machine.preset("orthoglide").posture()
        >>> moved = posture.target
        >>> moved[0, 3] += 1e-4
        >>> round(float(posture.held_at(moved).wrench[0]))
        300
        """
        # A copy: what the caller does with its array later is not part of this equilibrium.
        given = one("pose", pose, (4, 4)).copy()
        return Equilibrium(self, self._native.held_at(given[None]), ("held_at", given))

    def vibration(self, wrench: ArrayLike = (0.0,) * 6, *, held: Sequence[str] = ()) -> Vibration:
        """Modes about the equilibrium under a wrench on the tool.

        Parameters
        ----------
        wrench : array_like, shape (6,)
            Force and moment (N, N m), base axes, about the tool's reference point.
        held : Sequence[str]
            Directions of ``x y z rx ry rz`` (base axes) in which the tool is held while the machine vibrates.

        Raises
        ------
        ArgumentError
            The machine has no mass anywhere, or a mass that no body has.
        UnansweredError
            No equilibrium was found.

        Examples
        --------
        >>> import kinetostat as ks
        >>> arm = ks.Machine.preset("heavy_6r").posture().vibration([0, 0, -500, 0, 0, 0])
        >>> bool(0 < arm.frequencies_hz[0] < arm.frequencies_hz[1])
        True
        """
        from kinetostat.vibration import vibration_of

        return vibration_of(self, wrench, held)

    def under(self, model: ForceModel, **options: Any) -> ModelEquilibria:
        """Equilibrium under a wrench that depends on where the tool is; see :func:`kinetostat.equilibrium_under`.

        Examples
        --------
        >>> import kinetostat as ks
        >>> def cable(poses):  # 1 N/mm towards the origin
        ...     return ks.wrench(-1000 * poses[..., :3, 3])
        >>> found = ks.Machine.preset("orthoglide").posture([0.05, 0, 0]).under(cable)
        >>> bool(found.converged)
        True
        """
        from kinetostat.force_models import equilibrium_under

        return equilibrium_under(self, model, **options)

    def equilibrium_problem(self, wrench: ArrayLike = (0.0,) * 6) -> EquilibriumProblem:
        """Equilibrium as residual and Jacobian, for SciPy and others; see :class:`kinetostat.EquilibriumProblem`.

        Examples
        --------
        >>> import kinetostat as ks
        >>> problem = ks.Machine.preset("orthoglide").posture().equilibrium_problem([100, 0, 0, 0, 0, 0])
        >>> problem.residual(problem.x0).shape, problem.jacobian(problem.x0).shape
        ((6,), (6, 6))
        """
        from kinetostat.problem import EquilibriumProblem

        return EquilibriumProblem(self, wrench)

    def curve(self, **question: Any) -> ForceCurve:
        """Force against displacement, or displacement by a load that grows; see :func:`kinetostat.curves.curve` for what can be asked.

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
        >>> [str(point.kind.value) for point in found.special]
        ['pitchfork']
        """
        from kinetostat.curves import curve

        return curve(self, **question)

    def shapes(self, **question: Any) -> Shapes:
        """All equilibria with the tool at a place or under a load; see :func:`kinetostat.shapes.shapes` for what can be asked.

        Examples
        --------
        >>> import kinetostat as ks
        >>> len(ks.Machine.preset("three_link_z").posture().shapes(displaced=[-0.001, 0, 0]).energy)
        2
        """
        from kinetostat.shapes import shapes

        return shapes(self, **question)

    def shares(
        self,
        direction: Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[float] = "z",
        wrench: ArrayLike | None = None,
        *,
        progress: Progress | None = None,
    ) -> Shares:
        """Which part gives how much of the deflection in a direction; see :func:`kinetostat.shares.shares`.

        Parameters
        ----------
        direction : {"x", "y", "z", "rx", "ry", "rz"} or array_like, shape (3,)
            A force along, or a moment about, an axis of the base; or the direction of a force, base axes.
        wrench : array_like, shape (6,), optional
            Force (N) and moment (N m) on the tool: shares of what a further small load meets. Of the unloaded machine without it.
        progress : callable, optional
            As for :meth:`kinetostat.Machine.stiffness`.

        Returns
        -------
        Shares
            With arrays ``share`` and ``part_compliance`` in the order of ``parts``; shares add to 1.

        Examples
        --------
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("orthoglide").posture([0.02, 0.01, 0.03]).shares("x")
        >>> abs(float(found.share.sum()) - 1) < 1e-12, found.parts[0].name
        (True, 'foot')
        """
        from kinetostat.shares import shares_of_posture

        return shares_of_posture(self, direction=direction, wrench=wrench, progress=progress)

    def assembly(self, **question: Any) -> Assembly:
        """What assembly with errors locks in; see :func:`kinetostat.assembly.assembly`.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("orthoglide").posture().assembly().over_constraint
        3
        """
        from kinetostat.assembly import assembly

        return assembly(self, **question)

    # As a value ----------------------------------------------------------------------------------------------------

    @property
    def fingerprint(self) -> str:
        """SHA-256 of machine, target and all coordinates: the same on every machine and in every run."""
        found = hashlib.sha256(self.machine.fingerprint.encode())
        for numbers in (self.target, *(array for limb in self.limbs for array in limb)):
            found.update(len(numbers).to_bytes(8, "little"))
            found.update((np.asarray(numbers, dtype="<f8") + 0.0).tobytes())
        return found.hexdigest()

    def __hash__(self) -> int:
        return int(self.fingerprint[:15], 16)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Posture):
            return NotImplemented
        return self.fingerprint == other.fingerprint

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.machine, self.target, self._native.limbs)

    def __copy__(self) -> Posture:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Posture:
        return self

    def __repr__(self) -> str:
        return repr(self._native)

    def _repr_html_(self) -> str:
        return posture_html(self)


def _restored(machine: Machine, target: Floats, limbs: list[tuple[list[float], list[float]]]) -> Posture:
    """A posture that was pickled: reached by its place, or by its joints, whichever gives its target to the last bit."""

    def same(found: _core.Posture) -> bool:
        return found.target.tobytes() == target.tobytes() and found.limbs == limbs

    by_place = machine._native.posture_of_limbs(target[None], limbs)
    if not same(by_place):
        try:
            by_joints = machine._native.posture_at_joints([command for commands, _ in limbs for command in commands])
        except KinetostatError:  # of a machine whose joints do not say where it is
            return Posture(machine, by_place, target)
        if same(by_joints):
            return Posture(machine, by_joints)
    # A rotation matrix that is made orthonormal again may change in the last bit: the target is kept as it was.
    return Posture(machine, by_place, target)
