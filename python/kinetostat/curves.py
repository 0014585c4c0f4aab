"""Force against displacement: stiffness along the way, limit points, buckling, jumps [R 4.5, 5.5]."""

from __future__ import annotations

import dataclasses
import enum
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import commands
from kinetostat._arguments import flag
from kinetostat._arrays import Floats, one, positive
from kinetostat._asking import coordinates_in_si, handed_on, no_option_of, node_loads, numbers_or_nan, place, triple, wrenches
from kinetostat._growing import ends, one_way
from kinetostat._running import arguments, in_words_of_python
from kinetostat.errors import ArgumentError

if TYPE_CHECKING:
    from kinetostat.machine import Progress
    from kinetostat.posture import Posture

__all__ = ["Branch", "BranchEnd", "CriticalLoad", "ForceCurve", "Judged", "PointKind", "SpecialPoint", "critical_load", "curve"]

_DEG = np.pi / 180
_FARTHEST = 1e4
"""m; the command refuses more."""


class PointKind(enum.Enum):
    """What a named point of a curve is.

    Examples
    --------
    >>> PointKind("pitchfork")
    <PointKind.PITCHFORK: 'pitchfork'>
    """

    START = "start"
    LOAD_LIMIT = "load_limit"
    """Under a dead load the machine snaps here."""
    DISPLACEMENT_LIMIT = "displacement_limit"
    """Under prescribed motion the machine snaps here."""
    PITCHFORK = "pitchfork"
    """Buckling of a symmetric shape: two branches cross, one turns back."""
    TRANSCRITICAL = "transcritical"
    CROSSING = "crossing"
    """Stability changes inside the machine while its tool stands still."""
    MULTIPLE = "multiple"
    """Several modes at once."""
    SPECIAL = "special"
    LANDING = "landing"
    END = "end"


class BranchEnd(enum.Enum):
    """Why a branch ends.

    Examples
    --------
    >>> BranchEnd.RANGE.value
    'range'
    """

    RANGE = "range"
    ANGLE = "angle"
    POINTS = "points"
    CLOSED = "closed"
    LOST = "lost"
    STALLED = "stalled"


class Judged(enum.Enum):
    """What loses its stability at a critical load.

    Examples
    --------
    >>> Judged.SHAPE.value
    'shape'
    """

    SHAPE = "shape"
    """The shape, with the tool held where it is."""
    SHAPE_AND_TOOL = "shape_and_tool"
    """Shape and place of the tool, as prescribed."""


@dataclasses.dataclass(frozen=True, eq=False)
class SpecialPoint:
    """A named point of a curve.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    >>> point = found.special[0]
    >>> point.kind.value, round(point.force, 4), point.mode.shape
    ('pitchfork', -1.0335, (4,))
    """

    name: str
    kind: PointKind
    displacement: float
    """m or rad along the direction; NaN where only a factor grows."""
    force: float
    """N or N m along it."""
    factor: float
    """Load factor; NaN where a displacement grows."""
    in_words: str
    mode: Floats
    """Critical mode, largest component 1; empty without one."""
    wrench: Floats
    """(6,): N, N m."""
    stable: bool
    """Under a dead load."""


@dataclasses.dataclass(frozen=True, eq=False)
class Branch:
    """A path of equilibria; arrays have one row a point.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    >>> branch = found.branches[0]
    >>> branch.begins_at, branch.coordinates.shape == (len(branch.force), 4)
    (None, True)
    """

    displacement: Floats
    """(n,): m or rad, along the direction."""
    force: Floats
    """(n,): N or N m, along it."""
    slope: Floats
    """(n,): N/m or N m/rad; NaN where the displacement stands still."""
    factor: Floats
    """(n,): load factor; NaN where a displacement grows."""
    stable: NDArray[np.bool_]
    """(n,): under a dead load."""
    stable_when_moved: NDArray[np.bool_]
    """(n,): under prescribed motion."""
    share_to_buckling: Floats
    """(n,): with the tool held; NaN where nothing buckles."""
    spring_energy: Floats
    """(n,): stored in all springs, J."""
    wrench: Floats
    """(n, 6): on the tool, N, N m."""
    position: Floats
    """(n, 3): of the tool's reference point, m, base axes."""
    rotation_vector: Floats
    """(n, 3): of the tool, rad, base axes."""
    coordinates: Floats
    """(n, coordinates): m or rad, as :attr:`ForceCurve.coordinates` names them."""
    begins_at: str | None
    """Name of the point from which it was found; none for the start's own."""
    ends: tuple[BranchEnd, BranchEnd]


@dataclasses.dataclass(frozen=True, eq=False)
class CriticalLoad:
    """How many times a load can grow.

    Examples
    --------
    >>> import kinetostat as ks
    >>> posture = ks.Machine.preset("three_link_z").posture()
    >>> found = critical_load(posture, [-1, 0, 0], most=3).critical_loads[0]
    >>> found.factor > 1, found.conservative
    (True, True)
    """

    judged: Judged
    factor: float
    """First loss of stability on the way; NaN where none was met up to ``followed_to``."""
    linear: float
    """By the stresses of the first load step alone; NaN where they never destabilise."""
    followed_to: float
    mode: Floats
    """Motion of the coordinates, largest component 1."""
    in_words: str
    conservative: bool
    """All loads have a potential; otherwise the factor is that of divergence, and flutter is left open."""
    caution: str
    """What is left open, in words."""


@dataclasses.dataclass(frozen=True, eq=False)
class ForceCurve:
    """Force against displacement, or displacement against a growing load.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    >>> len(found.branches), found.coordinates
    (2, ('q', 'th1', 'th2', 'e'))
    """

    branches: tuple[Branch, ...]
    """The start's own first."""
    points: tuple[SpecialPoint, ...]
    """Start, limits, bifurcations, landings and ends."""
    critical_loads: tuple[CriticalLoad, ...]
    """Of a machine of one limb under a growing load; of others :attr:`special` says where stability ends."""
    coordinates: tuple[str, ...]
    """Names of the coordinates."""
    question: str
    """The question in words."""
    warnings: tuple[str, ...]
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""

    @property
    def special(self) -> tuple[SpecialPoint, ...]:
        """Limits and bifurcations."""
        return tuple(p for p in self.points if p.kind not in (PointKind.START, PointKind.LANDING, PointKind.END))

    def plot(self, axes: Any = None) -> Any:
        """Draws force over displacement with matplotlib; see :func:`kinetostat.plot.force_curve`.

        Examples
        --------
        >>> import matplotlib
        >>> matplotlib.use("Agg")
        >>> import kinetostat as ks
        >>> found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
        >>> found.plot().get_xlabel()
        'displacement, mm'
        """
        from kinetostat.plot import force_curve

        return force_curve(self, axes)

    def __repr__(self) -> str:
        found = ", ".join(f"{p.kind.value} at {p.displacement:.6g}" for p in self.special) or "no limit and no crossing"
        return f"<ForceCurve: {len(self.branches)} branches, {sum(len(b.force) for b in self.branches)} points; {found}>"


def _column(points: Sequence[dict[str, Any]], *names: tuple[str, float]) -> Floats:
    for name, factor in names:
        if points and name in points[0]:
            return numbers_or_nan([p.get(name) for p in points]) * factor
    return np.full(len(points), np.nan)


def _displacement(points: Sequence[dict[str, Any]]) -> Floats:
    return _column(points, ("displacement_mm", 1e-3), ("rotation_deg", _DEG))


def _force(points: Sequence[dict[str, Any]]) -> Floats:
    return _column(points, ("force_along_n", 1.0), ("moment_along_n_m", 1.0))


def _branch(found: dict[str, Any], names: Sequence[dict[str, Any]]) -> Branch:
    points = found["points"]
    coordinates = np.array([p["coordinates"] for p in points], dtype=float).reshape(len(points), -1)
    return Branch(
        displacement=_displacement(points),
        force=_force(points),
        slope=_column(points, ("slope_n_per_mm", 1e3), ("slope_n_m_per_deg", 1 / _DEG)),
        factor=_column(points, ("factor", 1.0)),
        stable=np.array([p["stable_under_dead_load"] for p in points], dtype=bool),
        stable_when_moved=np.array([p["stable_under_prescribed_motion"] for p in points], dtype=bool),
        share_to_buckling=numbers_or_nan([p["share_to_buckling"] for p in points]),
        spring_energy=numbers_or_nan([p["spring_energy_j"] for p in points]),
        wrench=wrenches(points),
        position=np.array([p["position_mm"] for p in points], dtype=float).reshape(-1, 3) * 1e-3,
        rotation_vector=np.array([p["rotation_vector_deg"] for p in points], dtype=float).reshape(-1, 3) * _DEG,
        coordinates=coordinates_in_si(names, coordinates),
        begins_at=found["from"],
        ends=(BranchEnd(found["ends"][0]), BranchEnd(found["ends"][1])),
    )


def _point(found: dict[str, Any]) -> SpecialPoint:
    return SpecialPoint(
        name=found["name"],
        kind=PointKind(found["kind"]),
        displacement=float(_displacement([found])[0]),
        force=float(_force([found])[0]),
        factor=float(_column([found], ("factor", 1.0))[0]),
        in_words=found["in_words"],
        mode=np.array(found["mode"], dtype=float),
        wrench=wrenches([found])[0],
        stable=found["stable_under_dead_load"],
    )


def _critical(found: dict[str, Any]) -> CriticalLoad:
    factor, linear = numbers_or_nan([found["factor"], found["linear_factor"]])
    return CriticalLoad(
        judged=Judged(found["judged"]),
        factor=float(factor),
        linear=float(linear),
        followed_to=found["followed_to_factor"],
        mode=np.array(found["mode"], dtype=float),
        in_words=found["mode_in_words"],
        conservative=found["conservative"],
        caution=found["caution"],
    )


def curve(
    posture: Posture,
    *,
    direction: ArrayLike | None = None,
    displacement: tuple[float, float] | None = None,
    about: ArrayLike | None = None,
    turn: tuple[float, float] | None = None,
    force: ArrayLike | None = None,
    moment: ArrayLike | None = None,
    factor: tuple[float, float] | None = None,
    force_limits: tuple[float, float] | None = None,
    hold: str | None = None,
    free: str | None = None,
    constant_force: ArrayLike | None = None,
    constant_moment: ArrayLike | None = None,
    loads: Mapping[str, ArrayLike] | Sequence[str] | None = None,
    branches: int | None = None,
    points: int | None = None,
    search_all: bool = False,
    progress: Progress | None = None,
) -> ForceCurve:
    """Pushes or turns the tool and tells which force it takes, or grows a load and tells where the tool goes.

    Parameters
    ----------
    posture : Posture
        The commanded posture.
    direction : array_like, shape (3,), optional
        Direction in the base along which the tool is pushed, over ``displacement`` (from, to), m.
    about : array_like, shape (3,), optional
        Or the direction about which it is turned, over ``turn`` (from, to), rad.
    force, moment : array_like, shape (3,), optional
        Or the load that grows, N and N m, base axes, over ``factor`` (from, to) times it.
    force_limits : tuple of float, optional
        The curve ends where the force along the direction leaves these, the lower and the upper one, N or N m.
    hold, free : str, optional
        Directions in which the tool is held or free, as in ``"x,y,rz"``; also ``all``, ``none``, ``rotations``, ``others``.
    constant_force, constant_moment : array_like, shape (3,), optional
        What acts all the time, N and N m.
    loads : dict of str to array_like of shape (3,), or sequence of str, optional
        Forces on named nodes all the time, N, base axes; ``"node=fx,fy,fz"`` as words. A node of a limb is ``"limb:node"``.
    branches, points : int, optional
        Branches, and points of one branch, at most.
    search_all : bool
        Search for shapes that no branch connects with the start, too.

    progress : callable, optional
        Called with what is done, how much there is (0: nobody knows) and the name of the stage.

    Returns
    -------
    ForceCurve
        Arrays in SI units; the command's dictionary is its ``answer``.

    Raises
    ------
    ArgumentError
        What is asked contradicts itself or the machine.
    UnansweredError
        The curve could not be followed from its start.

    Examples
    --------
    >>> import kinetostat as ks
    >>> posture = ks.Machine.preset("three_link_z").posture()
    >>> found = curve(posture, direction=[1, 0, 0], displacement=(0, -0.2))
    >>> round(found.special[0].displacement, 6), round(found.special[0].force, 6)
    (-0.110932, -1.033477)
    """
    load = None if force is None and moment is None else [triple("force", force), triple("moment", moment)]
    along, axis = triple("direction", direction), triple("about", about)
    far = ends("displacement", displacement, "m", _FARTHEST)
    angles = ends("turn", turn, "rad", np.pi)
    times = ends("factor", factor, "", np.inf)
    one_way({"direction": along, "about": axis, "force (moment)": load}, displacement, turn, factor)
    if load is not None and not np.any([x for part in load for x in part or ()]):
        raise ArgumentError("force and moment are zero: which load shall grow?")
    limits = None if force_limits is None else one("force_limits", force_limits, (2,)).tolist()
    if limits is not None and load is not None:
        raise ArgumentError("force_limits end a motion, and here a load grows: give its end in factor")
    if limits is not None and not limits[0] < limits[1]:
        raise ArgumentError(f"force_limits is {limits}, expected the lower one and then the upper one, N or N m")
    with arguments(displacement_mm="displacement", turn_deg="turn", load="loads", all="search_all"):
        answer = commands.curve(
            **place(posture),
            direction=along,
            displacement_mm=None if far is None else (1e3 * far).tolist(),
            about=axis,
            turn_deg=None if angles is None else (angles / _DEG).tolist(),
            force=triple("force", force),
            moment=triple("moment", moment),
            factor=None if times is None else times.tolist(),
            force_limits=limits,
            hold=hold,
            free=free,
            constant_force=triple("constant_force", constant_force),
            constant_moment=triple("constant_moment", constant_moment),
            load=node_loads(loads),
            branches=branches,
            points=points,
            all=flag("search_all", search_all),
            progress=progress,
        )
        warnings = tuple(in_words_of_python(w["message"]) for w in answer["warnings"])
    names = answer["coordinates"]
    return ForceCurve(
        branches=tuple(_branch(b, names) for b in answer["branches"]),
        points=tuple(_point(p) for p in answer["named_points"]),
        critical_loads=tuple(_critical(c) for c in answer["critical_loads"]),
        coordinates=tuple(c["name"] for c in names),
        question=answer["question"],
        warnings=warnings,
        answer=answer,
    )


def critical_load(posture: Posture, force: ArrayLike, *, most: float = 10.0, **question: Any) -> ForceCurve:
    """How many times a force can grow before the machine loses its stability.

    Parameters
    ----------
    posture : Posture
        The commanded posture.
    force : array_like, shape (3,)
        On the tool, N, base axes.
    most : float
        Factor up to which the load grows.
    **question
        As for :func:`curve`: ``hold``, ``constant_force`` and so on.

    Returns
    -------
    ForceCurve
        Its ``critical_loads`` (machines of one limb) and ``special`` points say where.

    Examples
    --------
    >>> import kinetostat as ks
    >>> posture = ks.Machine.preset("three_link_z").posture()
    >>> found = critical_load(posture, [-1, 0, 0], most=3)
    >>> shape = next(c for c in found.critical_loads if c.judged is Judged.SHAPE)
    >>> round(shape.factor, 6), round(shape.linear, 6)
    (1.033477, 1.015104)
    """
    no_option_of(question, factor="most: the load grows from none to so many times itself")
    own = {"force": force, "factor": (0.0, positive("most", most))}
    return curve(posture, **handed_on(own, question))
