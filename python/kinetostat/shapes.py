"""All shapes that a machine can take while its tool is held, or under a load [R 5.5]."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import commands
from kinetostat._arrays import Floats
from kinetostat._asking import coordinates_in_si, node_loads, numbers_or_nan, place, triple, wrenches
from kinetostat._running import arguments

if TYPE_CHECKING:
    from kinetostat.machine import Progress
    from kinetostat.posture import Posture

__all__ = ["Shapes", "shapes"]


@dataclasses.dataclass(frozen=True, eq=False)
class Shapes:
    """Equilibria by rising energy; arrays have one row each.

    Examples
    --------
    >>> import kinetostat as ks
    >>> ks.Machine.preset("three_link_z").posture().shapes(displaced=[-0.001, 0, 0])
    <Shapes: 2 equilibria, 1 stable; search settled>
    """

    energy: Floats
    """(n,): springs, weights and loads up to a constant, J."""
    stable: NDArray[np.bool_]
    """(n,): under the conditions as prescribed."""
    shape_stable: NDArray[np.bool_]
    """(n,): with the tool held."""
    share_to_buckling: Floats
    """(n,): NaN where nothing buckles."""
    stiffness: Floats
    """(n, 6, 6): N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point."""
    wrench: Floats
    """(n, 6): on the tool, N, N m."""
    position: Floats
    """(n, 3): of the tool's reference point, m, base axes."""
    rotation_vector: Floats
    """(n, 3): of the tool, rad."""
    coordinates: Floats
    """(n, coordinates): m or rad."""
    names: tuple[str, ...]
    """Names of the coordinates."""
    chance_of_more: float
    """Upper bound (95 %) of the chance that one more start would find another."""
    settled: bool
    """The search ended because it found nothing new for long, not because it was stopped."""
    incomplete: bool
    """There certainly are more: the energy has a minimum, and none of those found is one."""
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""

    def __repr__(self) -> str:
        end = "INCOMPLETE" if self.incomplete else "settled" if self.settled else "NOT settled"
        return f"<Shapes: {len(self.energy)} equilibria, {int(self.stable.sum())} stable; search {end}>"


def shapes(
    posture: Posture,
    *,
    displaced: ArrayLike | None = None,
    turned: ArrayLike | None = None,
    force: ArrayLike | None = None,
    moment: ArrayLike | None = None,
    hold: str | None = None,
    free: str | None = None,
    constant_force: ArrayLike | None = None,
    constant_moment: ArrayLike | None = None,
    loads: Mapping[str, ArrayLike] | Sequence[str] | None = None,
    starts: int | None = None,
    fruitless: int | None = None,
    progress: Progress | None = None,
) -> Shapes:
    """Finds all equilibria with the tool held at a place, or under a load.

    Parameters
    ----------
    posture : Posture
        The commanded posture.
    displaced : array_like, shape (3,), optional
        The tool is held so far from the commanded place, m, base axes,
    turned : array_like, shape (3,), optional
        and turned by this rotation vector, rad.
    force, moment : array_like, shape (3,), optional
        Or the load on the tool, N and N m.
    hold, free, constant_force, constant_moment, loads
        As for :func:`kinetostat.curves.curve`.
    starts, fruitless : int, optional
        Starts at most; starts in a row without anything new after which the search ends.

    progress : callable, optional
        Called with what is done, how much there is (0: nobody knows) and the name of the stage.

    Returns
    -------
    Shapes

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = shapes(ks.Machine.preset("three_link_z").posture(), displaced=[-0.001, 0, 0])
    >>> found.stable.tolist(), found.settled
    ([True, False], True)
    """
    turn = triple("turned", turned, 180 / np.pi)
    with arguments(displaced_mm="displaced", turned_deg="turned", load="loads"):
        answer = commands.equilibria(
            **place(posture),
            displaced_mm=triple("displaced", displaced, 1e3),
            turned_deg=turn,
            force=triple("force", force),
            moment=triple("moment", moment),
            hold=hold,
            free=free,
            constant_force=triple("constant_force", constant_force),
            constant_moment=triple("constant_moment", constant_moment),
            load=node_loads(loads),
            starts=starts,
            fruitless=fruitless,
            progress=progress,
        )
    each = answer["equilibria"]
    names = answer["coordinates"]
    coordinates = np.array([e["coordinates"] for e in each], dtype=float).reshape(len(each), len(names))
    return Shapes(
        energy=numbers_or_nan([e["energy_j"] for e in each]),
        stable=np.array([e["stable"] for e in each], dtype=bool),
        shape_stable=np.array([e["shape_stable"] for e in each], dtype=bool),
        share_to_buckling=numbers_or_nan([e["share_to_buckling"] for e in each]),
        stiffness=np.array([e["stiffness_n_m_rad"] for e in each], dtype=float).reshape(-1, 6, 6),
        wrench=wrenches(each),
        position=np.array([e["position_mm"] for e in each], dtype=float).reshape(-1, 3) * 1e-3,
        rotation_vector=np.array([e["rotation_vector_deg"] for e in each], dtype=float).reshape(-1, 3) * np.pi / 180,
        coordinates=coordinates_in_si(names, coordinates),
        names=tuple(name["name"] for name in names),
        chance_of_more=answer["coverage"]["chance_of_more_at_most"],
        settled=answer["coverage"]["settled"],
        incomplete=answer["coverage"]["incomplete"],
        answer=answer,
    )
