"""Equilibria under wrenches that depend on where the tool is: cables, magnets, contacts, processes, as functions of Python."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat._arguments import function as callable_given
from kinetostat._arguments import of_kind, or_none
from kinetostat._arrays import Floats, numbers, positive, thread_count, whole_number
from kinetostat._places import poses_of
from kinetostat._plausibility import issue, of_many, sentences
from kinetostat.errors import ArgumentError, PlausibilityWarning
from kinetostat.results import Equilibria
from kinetostat.spatial import rotation_from_vector
from kinetostat.status import DirectionKind

if TYPE_CHECKING:
    from kinetostat.machine import Machine
    from kinetostat.posture import Posture

__all__ = ["ForceModel", "ModelEquilibria", "equilibrium_under"]

ForceModel = Callable[[Floats], ArrayLike]
"""Takes poses of the tool (n, 4, 4), base from tool, m; gives wrenches (n, 6) on it, N and N m, base axes, about its reference point."""

_STEP = 1e-6
"""Step of differences, m and rad."""

_MOST_ITERATIONS = 100_000

_ROUNDING = 1e-10
"""Eigenvalues below this share of the largest stiffness are zero: what differences of a model leave."""


@dataclasses.dataclass(frozen=True, eq=False)
class ModelEquilibria:
    """Equilibria under a model of force, and which of them were found.

    Examples
    --------
    >>> import kinetostat as ks
    >>> def cable(poses):  # 1 N/mm towards the origin
    ...     return ks.wrench(-1000 * poses[..., :3, 3])
    >>> found = ks.Machine.preset("orthoglide").posture([0.05, 0, 0]).under(cable)
    >>> bool(np.abs(found.unbalanced).max() < 1e-6), bool(found.stable)
    (True, True)
    >>> def magnet(poses):  # stronger than the machine
    ...     return ks.wrench(1e7 * poses[..., :3, 3])
    >>> found = ks.Machine.preset("orthoglide").posture([0, 0, 0]).under(magnet)
    >>> bool(found.converged), bool(found.equilibria.stable), bool(found.stable)
    (True, True, False)
    """

    converged: NDArray[np.bool_]
    """(...,): the wrench is that of the model at the tool's pose. Where not, all numbers of ``equilibria`` are those of the last
    iteration and no answer; ``unbalanced`` says how far off."""
    wrench: Floats
    """(..., 6): on the tool, N, N m."""
    unbalanced: Floats
    """(..., 6): wrench of the model at the tool's pose less the wrench that bends the machine, N, N m; NaN where unsolved."""
    tangent: Floats
    """(..., 6, 6): stiffness with that of the model: of the machine less the derivative of the wrench; N/m, N/rad; N m/m, N m/rad."""
    iterations: int
    """Iterations of the slowest."""
    equilibria: Equilibria
    """The machine under these wrenches; its ``stable`` is that of the machine under dead wrenches of this size, which do not change as
    the tool moves. That of both together is ``stable``."""

    stable: NDArray[np.bool_]
    """(...,): machine and model together are stable: the limbs keep their shapes, and the symmetric part of ``tangent`` has no eigenvalue
    that is zero (free to move) or below within rounding, where the machine is not rigid. False where not converged.

    Of a model with a potential ``tangent`` is symmetric, and this is a minimum of the energy of both. Where it is not symmetric (follower
    forces, friction, cutting), true says that every small motion of the tool is held back; false does not say that it runs away,
    and neither says anything about flutter, a question of masses and damping."""


def _stable(
    machine: Machine,
    postures: Callable[[int], Posture],
    known: Equilibria,
    stiffness: Floats,
    tangents: Floats,
    done: NDArray[np.bool_],
) -> NDArray[np.bool_]:
    """Whether machine and model together are stable, where there is an answer."""
    assert known.share_to_buckling is not None
    out = done & ~(known.share_to_buckling >= 1)
    # Rotations at the machine's natural length: there, rigid directions are at right angles to the others.
    length = np.repeat([1.0, machine._native.natural_length()], 3)
    for at in np.flatnonzero(out):
        both, alone = ((k + k.T) / 2 / length[:, None] / length for k in (tangents[at], stiffness[at]))
        zero = _ROUNDING * max(np.abs(both).max(), np.abs(alone).max())
        if (np.abs(np.linalg.eigvalsh(alone)) <= zero).any():
            # Free or rigid: a model moves nothing where the machine is rigid.
            twists = [d.twist * length for d in postures(int(at)).stiffness().directions if d.kind == DirectionKind.RIGID]
            moves = np.linalg.svd(np.reshape(twists, (-1, 6)))[2][len(twists) :]
            both = moves @ both @ moves.T
        out[at] = bool((np.linalg.eigvalsh(both) > zero).all()) if both.size else True
    return out


def _called(name: str, function: Callable[[Floats], ArrayLike], poses: Floats, shape: tuple[int, ...]) -> Floats:
    found = numbers(name, function(poses.copy()))
    wanted = (len(poses), *shape)
    try:
        full = np.broadcast_to(found, wanted)
    except ValueError:
        raise ArgumentError(f"{name} gives shape {found.shape}, expected {wanted}") from None
    if not np.isfinite(full).all():
        row = int(np.argwhere(~np.isfinite(full))[0][0])
        raise ArgumentError(f"{name} gives a number that is not finite at the pose {poses[row].tolist()}")
    return np.array(full)


def _moved(poses: Floats, twist: Floats) -> Floats:
    out: Floats = poses.copy()
    out[:, :3, 3] += twist[:3]
    out[:, :3, :3] = rotation_from_vector(twist[3:]) @ out[:, :3, :3]
    return out


def _by_differences(model: ForceModel, poses: Floats) -> Floats:
    out = np.empty((len(poses), 6, 6))
    for k in range(6):
        step = np.zeros(6)
        step[k] = _STEP
        ahead, behind = (_called("model", model, _moved(poses, s), (6,)) for s in (step, -step))
        out[:, :, k] = (ahead - behind) / (2 * _STEP)
    return out


def equilibrium_under(
    where: Machine | Posture,
    model: ForceModel,
    *,
    poses: ArrayLike | None = None,
    tangent: Callable[[Floats], ArrayLike] | None = None,
    tolerance: float = 1e-9,
    most_iterations: int = 50,
    threads: int | None = None,
) -> ModelEquilibria:
    """Equilibria under a wrench that depends on where the tool is, for many postures at once.

    Newton's iteration on the wrench: with the machine's tangent stiffness ``K`` and the derivative ``D`` of the model by the tool's
    motion, ``(K - D) dx = f(x) - w`` and ``w + K dx`` is the next wrench.

    Parameters
    ----------
    where : Machine or Posture
        With a machine, ``poses`` says where it is commanded to.
    model : callable
        Poses (n, 4, 4) of the tool, base from tool, m, to wrenches (n, 6) on it, N and N m, base axes, about its reference point; called
        for all postures at once.
    poses : array_like, shape (..., 4, 4) or (..., 3), optional
        Commanded poses.
    tangent : callable, optional
        Poses (n, 4, 4) to derivatives (n, 6, 6) of the wrench by motion of the tool (m, rad, base axes). By differences without it.
    tolerance : float
        Largest unbalanced part of the wrench, above 0: of its size, and at least this many N and N m.
    most_iterations : int
        Iterations at most, from 1.
    threads : int, optional
        Number of threads; all cores without it.

    Returns
    -------
    ModelEquilibria
        ``converged`` says where there is an answer, ``stable`` whether machine and model together stay there.

    Raises
    ------
    ArgumentError
        An argument of another kind or out of range; a model or a tangent that gives another shape, or numbers that are not finite.

    Examples
    --------
    >>> import kinetostat as ks
    >>> machine = ks.Machine.preset("orthoglide")
    >>> def magnet(poses):  # pulls along z, the more the higher the tool is
    ...     return ks.wrench(np.stack([0 * poses[:, 0, 3], 0 * poses[:, 0, 3], 100 + 2e4 * poses[:, 2, 3]], axis=-1))
    >>> found = equilibrium_under(machine, magnet, poses=[[0, 0, 0], [0, 0, 0.05]])
    >>> found.converged.tolist(), found.wrench.shape
    ([True, True], (2, 6))
    """
    from kinetostat.machine import Machine
    from kinetostat.posture import Posture

    of_kind("where", where, (Machine, Posture), "a Machine or a Posture")
    callable_given("model", model, "a function of poses (n, 4, 4)")
    or_none(callable_given, "tangent", tangent, "a function of poses (n, 4, 4), or None")
    allowed = positive("tolerance", tolerance)
    most = whole_number("most_iterations", most_iterations, 1, _MOST_ITERATIONS)
    threads = thread_count(threads)
    single = isinstance(where, Posture)
    if single == (poses is not None):
        raise ArgumentError("give poses with a machine, and none with a posture")
    machine = where.machine if isinstance(where, Posture) else where
    commanded = where.target if isinstance(where, Posture) else poses
    assert commanded is not None
    flat, leading = poses_of(machine._native, commanded)
    loads = _called("model", model, flat, (6,))
    answer, slope = None, np.zeros((len(flat), 6, 6))
    moving: NDArray[np.float64] = slope

    def posture_at(at: int) -> Posture:
        return where if isinstance(where, Posture) else machine.posture(pose=flat[at])

    unbalanced = np.full((len(flat), 6), np.nan)
    done = np.zeros(len(flat), dtype=bool)
    iterations = 0
    while iterations < most:
        iterations += 1
        with warnings.catch_warnings():
            # Loads on the way to the answer are not the caller's.
            warnings.simplefilter("ignore", PlausibilityWarning)
            answer = _solved(where, machine, flat, loads, threads)
        assert answer.stiffness is not None
        moving = _of_what_moves(machine, posture_at, answer, loads)
        good = np.flatnonzero(answer.solved)
        unbalanced[:] = np.nan
        if len(good) == 0:
            break
        at = answer.tool[good]
        unbalanced[good] = _called("model", model, at, (6,)) - loads[good]
        slope[good] = _by_differences(model, at) if tangent is None else _called("tangent", tangent, at, (6, 6))
        size = np.maximum(np.linalg.norm(loads, axis=-1), 1.0)
        done = np.linalg.norm(unbalanced, axis=-1) <= allowed * size
        open_ = good[~done[good]]
        if len(open_) == 0:
            break
        k = moving[open_]
        moved = _stepped(k - slope[open_], unbalanced[open_])
        loads[open_] += np.einsum("nij,nj->ni", k, moved)
    assert answer is not None
    assert answer.stiffness is not None
    said = of_many(machine._native, loads[done], answer.displacement[done, :3], answer.status[done])
    issue(said)
    shaped: dict[str, Any] = {
        name: None if value is None else value.reshape(leading + value.shape[1:]) for name, value in answer.to_dict().items()
    }
    return ModelEquilibria(
        converged=done.reshape(leading),
        wrench=loads.reshape(*leading, 6),
        unbalanced=unbalanced.reshape(*leading, 6),
        tangent=(answer.stiffness - slope).reshape(*leading, 6, 6),
        iterations=iterations,
        equilibria=Equilibria(**shaped, warnings=sentences(said)),
        stable=_stable(
            machine,
            posture_at,
            answer,
            moving,
            moving - slope,
            done,
        ).reshape(leading),
    )


def _of_what_moves(machine: Machine, postures: Callable[[int], Posture], known: Equilibria, loads: Floats) -> Floats:
    """Stiffness of the motions that the machine can make, zero along rigid directions."""
    assert known.stiffness is not None
    out: Floats = known.stiffness.copy()
    length = np.repeat([1.0, machine._native.natural_length()], 3)
    for at in np.flatnonzero(known.solved & np.isnan(out).any(axis=(1, 2))):
        compliance = postures(int(at)).deflected_by(loads[at]).compliance
        out[at] = np.linalg.pinv(compliance * length[:, None] * length, rcond=1e-12) * length[:, None] * length
    return out


def _stepped(matrices: Floats, wrenches: Floats) -> Floats:
    """Motions; a direction without stiffness is left as it is."""
    try:
        out: Floats = np.linalg.solve(matrices, wrenches[..., None])[..., 0].astype(np.float64)
        return out
    except np.linalg.LinAlgError:
        out = np.einsum("nij,nj->ni", np.linalg.pinv(matrices), wrenches)
        return out


def _solved(where: Machine | Posture, machine: Machine, poses: Floats, loads: Floats, threads: int | None) -> Equilibria:
    from kinetostat.errors import UnansweredError
    from kinetostat.posture import Posture
    from kinetostat.status import Status

    if not isinstance(where, Posture):
        return machine.equilibrium(poses, loads, details="stability", threads=threads)
    # A posture is one of several that may reach its place: it is solved itself.
    try:
        one = where.deflected_by(loads[0])
    except UnansweredError:
        return _none(len(where.commands))
    share = np.nan if one.share_to_buckling is None else one.share_to_buckling
    return (
        Equilibria(
            status=np.array([where.status], dtype=np.uint8),
            tool=one.tool[None],
            displacement=one.displacement[None],
            commands=where.commands[None],
            actuator_forces=one.actuator_forces[None],
            stiffness=one.stiffness[None],
            stable=np.array([one.stable]),
            against_force=np.array([one.against_force]),
            share_to_buckling=np.array([share]),
        )
        if Status(where.status) != Status.UNSOLVED
        else _none(len(where.commands))
    )


def _none(actuators: int) -> Equilibria:
    from kinetostat.status import Status

    nan = np.full
    return Equilibria(
        status=np.array([Status.UNSOLVED], dtype=np.uint8),
        tool=nan((1, 4, 4), np.nan),
        displacement=nan((1, 6), np.nan),
        commands=nan((1, actuators), np.nan),
        actuator_forces=nan((1, actuators), np.nan),
        stiffness=nan((1, 6, 6), np.nan),
        stable=np.array([False]),
        against_force=nan(1, np.nan),
        share_to_buckling=nan(1, np.nan),
    )
