"""Vibrations of a machine about its equilibrium under a load: modes, damping, response of the tool."""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Sequence
from typing import Any, Literal, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import _core
from kinetostat._arguments import flag, of_kind, one_of, or_none, text, texts
from kinetostat._arrays import Floats, finite, one, real, whole_number
from kinetostat._plausibility import issue
from kinetostat.errors import ArgumentError
from kinetostat.posture import _DEFLECTED, Equilibrium, Posture
from kinetostat.status import ModeKind

__all__ = ["ComplexModes", "Damping", "DirectionCounts", "ModeShares", "ReducedVibration", "ToolModes", "Vibration", "vibration_of"]

_ALL_MODES = 2**31
_AXES = ("x", "y", "z", "rx", "ry", "rz")


@final
class Damping:
    """How vibrations are damped; one law, by name.

    Examples
    --------
    >>> from kinetostat.vibration import Damping
    >>> Damping.ratio(0.03)
    Damping.ratio(0.03)
    """

    __slots__ = ("_json", "_said")

    def __init__(self, law: Any, said: str) -> None:
        self._json = json.dumps(law)
        self._said = said

    @staticmethod
    def none() -> Damping:
        """No damping.

        Examples
        --------
        >>> from kinetostat.vibration import Damping
        >>> Damping.none()
        Damping.none()
        """
        return Damping("undamped", "Damping.none()")

    @staticmethod
    def ratio(ratio: ArrayLike) -> Damping:
        """Ratio to critical damping of all modes (0.03 is 3 %), or one for each of the lowest modes, the last for all above.

        Examples
        --------
        >>> from kinetostat.vibration import Damping
        >>> Damping.ratio([0.03, 0.02])
        Damping.ratio([0.03, 0.02])
        """
        ratios = finite("ratio", ratio)
        if ratios.ndim > 1:
            raise ArgumentError(f"ratio has shape {ratios.shape}, expected one number or (m,)")
        return Damping({"ratios" if ratios.ndim else "ratio": ratios.tolist()}, f"Damping.ratio({ratios.tolist()!r})")

    @staticmethod
    def rayleigh(mass_per_s: float, stiffness_s: float) -> Damping:
        """``C = mass_per_s M + stiffness_s K`` (1/s, s), ``K`` the material stiffness of the springs.

        Examples
        --------
        >>> from kinetostat.vibration import Damping
        >>> Damping.rayleigh(2.0, 1e-4)
        Damping.rayleigh(2.0, 0.0001)
        """
        law = {"rayleigh": {"mass_per_s": real("mass_per_s", mass_per_s), "stiffness_s": real("stiffness_s", stiffness_s)}}
        return Damping(law, f"Damping.rayleigh({mass_per_s!r}, {stiffness_s!r})")

    @staticmethod
    def structural(loss_factor: float) -> Damping:
        """Loss factor of the springs' material, ``K (1 + i loss_factor)``; in responses alone.

        Examples
        --------
        >>> from kinetostat.vibration import Damping
        >>> Damping.structural(0.05)
        Damping.structural(0.05)
        """
        return Damping({"structural": {"loss_factor": real("loss_factor", loss_factor)}}, f"Damping.structural({loss_factor!r})")

    @staticmethod
    def viscous(**joints: float) -> Damping:
        """Viscous dampers on joints and springs by name, N s/m or N m s/rad; for names with a dot use ``viscous(**{"leg x.slider": 900})``.

        Examples
        --------
        >>> from kinetostat.vibration import Damping
        >>> Damping.viscous(joint_1=900.0)
        Damping.viscous(**{'joint_1': 900.0})
        """
        return Damping({"viscous": [[name, real(name, c)] for name, c in joints.items()]}, f"Damping.viscous(**{joints!r})")

    def __repr__(self) -> str:
        return self._said


def damping_of(native: str) -> Damping:
    """Damping as the core writes it."""
    law = json.loads(native)
    if law == "undamped":
        return Damping.none()
    ((name, numbers),) = law.items()
    match name:
        case "ratio" | "ratios":
            return Damping.ratio(numbers)
        case "rayleigh":
            return Damping.rayleigh(**numbers)
        case "structural":
            return Damping.structural(**numbers)
        case _:
            return Damping.viscous(**dict(numbers))


def _law(damping: Damping | float) -> str:
    """Damping, or the ratio of all modes, as the core reads it."""
    return damping._json if isinstance(damping, Damping) else Damping.ratio(real("damping", damping))._json


@dataclasses.dataclass(frozen=True)
class DirectionCounts:
    """How many directions of motion there are of each kind.

    Examples
    --------
    >>> import kinetostat as ks
    >>> counts = ks.Machine.preset("heavy_6r").posture().vibration().counts
    >>> counts.vibrating, counts.free
    (36, 0)
    """

    vibrating: int
    """Modes that vibrate."""
    free: int
    """Mass without stiffness: frequency zero."""
    unstable: int
    """Negative stiffness."""
    massless: int
    """Stiffness without mass: they follow at once, and have no mode."""
    massless_unstable: int
    """Massless directions of negative stiffness: no frequency tells of them, yet the equilibrium does not hold."""
    neutral: int
    """Neither mass nor stiffness, such as the spin of a slender strut between two ball joints."""
    rigid: int
    """Motions of the tool that the machine cannot make, of six."""


@dataclasses.dataclass(frozen=True)
class ModeShares:
    """What takes part in a mode; each dictionary adds to one.

    Examples
    --------
    >>> import kinetostat as ks
    >>> shares = ks.Machine.preset("heavy_6r").posture().vibration().shares(0)
    >>> round(sum(shares.kinetic.values()), 12), round(sum(shares.elastic.values()), 12)
    (1.0, 1.0)
    """

    kinetic: dict[str, float]
    """Kinetic energy by bodies, links and platforms."""
    elastic: dict[str, float]
    """Elastic energy by joints and springs."""


@dataclasses.dataclass(frozen=True, eq=False)
class ToolModes:
    """Modal data of the tool's tip, base axes: what :mod:`kinetostat.chatter` needs of a machine.

    Examples
    --------
    >>> import kinetostat as ks
    >>> tip = ks.Machine.preset("heavy_6r").posture().vibration().tool_modes(0.03)
    >>> tip.shapes.shape, tip.squared.shape, tip.residual.shape
    ((36, 3), (36,), (3, 3))
    """

    shapes: Floats
    """(m, 3): motion of the tip in modes normalised by mass, 1/sqrt(kg)."""
    squared: Floats
    """(m,): squares of the angular frequencies, (rad/s)^2."""
    damping_ratios: Floats
    """(m,): ratios to critical damping."""
    residual: Floats
    """(3, 3): flexibility of what has no mode, m/N."""
    held: Floats = dataclasses.field(default_factory=lambda: np.zeros((0, 3)))
    """(h, 3): motion of the tip, m per sqrt(N m), in directions without mass of unit stiffness that dampers hold; what they give at rest is
    in the residual."""
    rates: Floats | None = None
    """(m + h, m + h), where damping couples modes: damping by modes (1/s, ``2 zeta w`` on the diagonal), then by the directions
    that are held (s, their times of relaxation on the diagonal)."""


@dataclasses.dataclass(frozen=True, eq=False)
class ComplexModes:
    """Modes under loads without a potential: ``exp(lambda t)``, one of every pair.

    Examples
    --------
    >>> import kinetostat as ks
    >>> wrench = [0, 0, 0, 90, 0, 0]  # a moment that does not turn with the tool
    >>> found = ks.Machine.preset("heavy_6r").posture().vibration(wrench).complex_modes()
    >>> found.eigenvalues.shape, found.verdict in ("stable", "not_judged")
    ((36,), True)
    """

    verdict: Literal["stable", "flutter", "divergence", "not_judged"]
    """What becomes of a small disturbance; not judged where links of one segment are too coarse for it."""
    coarse_links: tuple[str, ...]
    """Those links: give them two segments and more."""
    complexity: float
    """Largest share of the imaginary part in a squared frequency without damping."""
    eigenvalues: NDArray[np.complex128]
    """(m,): 1/s; a positive real part grows."""


@dataclasses.dataclass(frozen=True, eq=False)
class ReducedVibration:
    """A machine by six motions of one place and a few vibrations with it held (Craig and Bampton).

    Coordinates are the six motions of the place (base axes, about it), then the amplitudes of the vibrations.

    Examples
    --------
    >>> import kinetostat as ks
    >>> arm = ks.Machine.preset("heavy_6r").posture().vibration()
    >>> reduced = arm.reduced(6)
    >>> reduced.mass.shape, bool(reduced.frequencies_hz[0] >= arm.frequencies_hz[0])
    ((12, 12), True)
    """

    mass: Floats
    """(6 + k, 6 + k): kg, kg m, kg m^2."""
    stiffness: Floats
    """(6 + k, 6 + k): the stiffness of the place under the load, and squares of ``kept_hz`` in rad/s."""
    basis: Floats
    """(n, 6 + k): the machine's independent coordinates by these."""
    kept_hz: Floats
    """(k,): frequencies with the place held."""
    left_out_hz: float | None
    """The lowest one that was left out; ``None`` where all were kept. Trust the reduction well below it."""
    frequencies_hz: Floats
    """(6 + k,): frequencies of the reduced machine, never below the exact ones of the same number."""
    relative_bounds: Floats
    """(6 + k,): an exact frequency is not farther away than this share; a bound, mostly far from sharp."""


@final
class Vibration:
    """Modes of a machine about its equilibrium under a load, from :meth:`kinetostat.Posture.vibration`.

    Frequencies are signed: ``-f`` of a direction that goes away with ``exp(2 pi f t)``. Shapes are normalised by mass.

    Examples
    --------
    >>> import kinetostat as ks
    >>> arm = ks.Machine.preset("heavy_6r").posture().vibration()
    >>> arm.stable, arm.frequencies_hz.shape
    (True, (36,))
    """

    __slots__ = ("_native", "held", "posture")

    def __init__(self, posture: Posture, native: _core.Vibration, held: tuple[str, ...]) -> None:
        self.posture = posture
        """The posture."""
        self.held = held
        """Directions in which the tool is held while it vibrates."""
        self._native = native

    @property
    def equilibrium(self) -> Equilibrium:
        """The equilibrium about which the machine vibrates."""
        return Equilibrium(self.posture, self._native.equilibrium, _DEFLECTED)

    @property
    def frequencies_hz(self) -> Floats:
        """(m,): signed frequencies, ascending."""
        return self._native.frequencies_hz

    @property
    def kinds(self) -> tuple[ModeKind, ...]:
        """What each mode is."""
        return tuple(ModeKind(kind) for kind in json.loads(self._native.kinds_json))

    @property
    def counts(self) -> DirectionCounts:
        """Directions of each kind."""
        return DirectionCounts(**json.loads(self._native.counts_json))

    @property
    def neutral(self) -> tuple[str, ...]:
        """Joints and springs that take part in neutral directions."""
        return tuple(self._native.neutral)

    @property
    def stable(self) -> bool:
        """No small disturbance grows; free directions are allowed. Of loads without a potential :meth:`complex_modes` says more."""
        return self._native.stable

    @property
    def circulatory(self) -> bool:
        """True where loads have no potential (a moment that does not turn with the tool).

        Frequencies are those of the symmetric part then; :meth:`complex_modes` says more.
        """
        return self._native.circulatory

    @property
    def mass(self) -> float:
        """Mass that vibrates, kg."""
        return self._native.total_mass

    @property
    def without_mass(self) -> tuple[str, ...]:
        """Limbs and platforms without any mass: their own frequencies are missing."""
        return tuple(self._native.without_mass(self.posture._native))

    @property
    def tool_shapes(self) -> Floats:
        """(m, 6): motion of the tool in each mode, base axes, m and rad, times ``1/sqrt(kg)``."""
        return self._native.tool_shapes

    @property
    def shapes(self) -> Floats:
        """(m, n): modes by the independent coordinates, so that ``shapes @ mass_matrix @ shapes.T`` is one."""
        return self._native.shapes

    @property
    def mass_matrix(self) -> Floats:
        """(n, n): kg, kg m, kg m^2 by the independent coordinates."""
        return self._native.mass_matrix

    @property
    def tangent(self) -> Floats:
        """(n, n): stiffness less that of the loads, ``K - H``, N/m, N, N m/rad."""
        return self._native.tangent

    @property
    def places(self) -> tuple[str, ...]:
        """Names of the places where it can be pushed and looked at, for :meth:`response`."""
        return tuple(self._native.places)

    def shares(self, mode: int) -> ModeShares:
        """What takes part in a mode, counted from 0.

        Examples
        --------
        >>> import kinetostat as ks
        >>> lowest = ks.Machine.preset("heavy_6r").posture().vibration().shares(0)
        >>> max(lowest.elastic, key=lowest.elastic.get)
        'joint 2'
        """
        kinetic, elastic = self._native.shares(whole_number("mode", mode, 0, _ALL_MODES))
        return ModeShares(dict(kinetic), dict(elastic))

    def damping_ratios(self, damping: Damping | float) -> Floats:
        """(m,): ratios to critical damping of all modes.

        Parameters
        ----------
        damping : Damping | float
            A law, or the ratio of all modes.

        Returns
        -------
        Floats
            (m,)

        Examples
        --------
        >>> import kinetostat as ks
        >>> arm = ks.Machine.preset("heavy_6r").posture().vibration()
        >>> arm.damping_ratios(0.03).tolist()[:2]
        [0.03, 0.03]
        """
        return self._native.damping_ratios(_law(damping))

    def complex_modes(self, damping: Damping | float | None = None) -> ComplexModes | None:
        """Complex modes under loads without a potential, and whether the machine flutters.

        Parameters
        ----------
        damping : Damping | float | None
            A law, or the ratio of all modes; none as usual.

        Returns
        -------
        ComplexModes | None
            ``None`` where all loads have a potential, and real modes say it all.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("heavy_6r").posture().vibration().complex_modes() is None
        True
        """
        found = self._native.complex_modes(_law(Damping.none() if damping is None else damping))
        if found is None:
            return None
        said, complexity, eigenvalues = found
        verdict = json.loads(said)
        if isinstance(verdict, str):
            return ComplexModes(verdict, (), complexity, eigenvalues)  # type: ignore[arg-type]
        return ComplexModes("not_judged", tuple(verdict["not_judged"]["links"]), complexity, eigenvalues)

    def reduced(self, kept: int = 6, *, at: str | None = None) -> ReducedVibration:
        """Craig and Bampton's reduction to six motions of a place and the lowest vibrations with it held.

        Parameters
        ----------
        kept : int
            How many of these vibrations.
        at : str | None
            A node or a platform; the tool if not given.

        Returns
        -------
        ReducedVibration

        Raises
        ------
        ArgumentError
            The place cannot move in six directions, or loads have no potential.
        UnansweredError
            The machine is not stable: no bound holds then.

        Examples
        --------
        >>> import kinetostat as ks
        >>> ks.Machine.preset("heavy_6r").posture().vibration().reduced(3).stiffness.shape
        (9, 9)
        """
        place, count = or_none(text, "at", at), whole_number("kept", kept, 0, _ALL_MODES)
        mass, stiffness, basis, kept_hz, left_out_hz, frequencies = self._native.reduced(place, count)
        return ReducedVibration(mass, stiffness, basis, kept_hz, left_out_hz, frequencies[:, 0].copy(), frequencies[:, 1].copy())

    def response(
        self,
        frequencies_hz: ArrayLike,
        damping: Damping | float,
        *,
        at: str | None = None,
        by: str | None = None,
        quantity: Literal["displacement", "velocity", "acceleration"] = "displacement",
        modes: int | None = None,
        direct: bool = False,
    ) -> NDArray[np.complex128]:
        """What a place does when another is pushed: ``response[i] @ wrench`` is the motion at ``frequencies_hz[i]``.

        Parameters
        ----------
        frequencies_hz : ArrayLike
            (f,)
        damping : Damping | float
            A law, or the ratio of all modes.
        at : str | None
            The place that is looked at, of :attr:`places`; the tool if none.
        by : str | None
            The place that is pushed; the tool if none.
        quantity : str
            Displacement (m/N), velocity or acceleration.
        modes : int | None
            So many of the lowest modes, and the flexibility of all others; all modes if none.
        direct : bool
            Solved at every frequency instead of summed over modes.

        Returns
        -------
        NDArray[np.complex128]
            (f, 6, 6): m, rad (and by time) per N, N m; base axes, at the origins of the places.

        Examples
        --------
        At rest the tool gives way as under a lasting force:

        >>> import kinetostat as ks, numpy as np
        >>> arm = ks.Machine.preset("heavy_6r").posture().vibration()
        >>> still = arm.response([0.0], 0.03)[0].real
        >>> bool(np.allclose(still, arm.equilibrium.compliance, rtol=1e-9, atol=1e-16))
        True
        """
        hz = finite("frequencies_hz", frequencies_hz)
        if hz.ndim != 1:
            raise ArgumentError(f"frequencies_hz has shape {hz.shape}, expected (f,)")
        asked = one_of("quantity", quantity, ("displacement", "velocity", "acceleration"))
        if flag("direct", direct) and modes is not None:
            raise ArgumentError("modes and direct exclude each other: the direct solution has all modes")
        kept = None if direct else _ALL_MODES if modes is None else whole_number("modes", modes, 0, _ALL_MODES)
        return self._native.response(hz, _law(damping), or_none(text, "at", at), or_none(text, "by", by), asked, kept)

    def tool_modes(self, damping: Damping | float) -> ToolModes:
        """Modal data of the tool's tip.

        Examples
        --------
        >>> import kinetostat as ks
        >>> arm = ks.Machine.preset("heavy_6r").posture().vibration()
        >>> arm.tool_modes(0.03).damping_ratios[0]
        np.float64(0.03)
        """
        return ToolModes(*self._native.tool_modes(_law(damping)))

    def __reduce__(self) -> tuple[Any, ...]:
        return vibration_of, (self.posture, self._native.equilibrium.wrench.tolist(), self.held)

    def __repr__(self) -> str:
        shown = ", ".join(f"{f:.4g}" for f in self.frequencies_hz[:4])
        more = ", ..." if len(self.frequencies_hz) > 4 else ""
        return f"<Vibration of '{self.posture.machine.name}': {shown}{more} Hz>"


def vibration_of(posture: Posture, wrench: ArrayLike, held: Sequence[str]) -> Vibration:
    """The same as :meth:`kinetostat.Posture.vibration`.

    Examples
    --------
    >>> import kinetostat as ks
    >>> from kinetostat.vibration import vibration_of
    >>> vibration_of(ks.Machine.preset("heavy_6r").posture(), [0, 0, 0, 0, 0, 0], ["x", "y", "z"]).held
    ('x', 'y', 'z')
    """
    of_kind("posture", posture, Posture, "a kinetostat.Posture")
    directions = texts("held", held, f"a list of {', '.join(_AXES)}")
    for index, name in enumerate(directions):
        one_of(f"held[{index}]", name, _AXES)
    x, y, z, rx, ry, rz = (name in directions for name in _AXES)
    native = _core.vibration_of(posture._native, one("wrench", wrench, (6,)), (x, y, z, rx, ry, rz))
    issue(_core.load_warnings(posture._native, native.equilibrium))
    return Vibration(posture, native, tuple(name for name in _AXES if name in directions))
