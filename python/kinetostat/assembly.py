"""What assembly with errors locks in: shifts of platforms, internal wrenches, bent springs [R 5.5.3, 6.3]."""

from __future__ import annotations

import dataclasses
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import commands
from kinetostat._arguments import texts
from kinetostat._arrays import Floats
from kinetostat._asking import place, triple

if TYPE_CHECKING:
    from kinetostat.machine import Progress
    from kinetostat.posture import Posture

__all__ = ["Assembly", "assembly"]

_DEG = np.pi / 180


@dataclasses.dataclass(frozen=True, eq=False)
class Assembly:
    """A machine put together although its parts do not fit.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").posture().assembly(deviations=["leg x:foot arm:1deg about x"], force=[100, 0, 0])
    >>> found.platforms, found.displacement.shape, found.wrench_under_load.shape
    (('tool',), (1, 6), (3, 6))
    """

    over_constraint: int
    """Number of wrenches that the limbs can lock in against each other."""
    stresses: tuple[str, ...]
    """Directions in which the limbs fight, in words."""
    platforms: tuple[str, ...]
    limbs: tuple[str, ...]
    displacement: Floats
    """(platforms, 6): where the platforms go without load, m and rad, base axes."""
    displacement_by_deviations: Floats
    """(platforms, 6): the part that the deviations cause."""
    displacement_linear: Floats
    """(platforms, 6): without load, to first order."""
    displacement_under_load: Floats | None
    """(platforms, 6): under the load; none without one."""
    wrench: Floats
    """(limbs, 6): what stays in the limbs without load, N and N m."""
    wrench_under_load: Floats | None
    """(limbs, 6): under the load; none without one."""
    springs: tuple[dict[str, Any], ...]
    """Every spring with the names ``limb``, ``spring``, ``unit``, ``deflection`` (m or rad) and ``torque`` (N or N m), without load."""
    stable: bool
    warnings: tuple[str, ...]
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""


def _twists(each: Sequence[dict[str, Any]], case: str) -> Floats | None:
    if not each or each[0]["shift_mm"].get(case) is None:
        return None
    rows = [[*(1e-3 * np.array(p["shift_mm"][case])), *(_DEG * np.array(p["rotation_vector_deg"][case]))] for p in each]
    return np.array(rows, dtype=float)


def _wrenches(each: Sequence[dict[str, Any]], case: str) -> Floats | None:
    if not each or each[0]["force_n"].get(case) is None:
        return None
    return np.array([[*limb["force_n"][case], *limb["moment_n_m"][case]] for limb in each], dtype=float)


def _springs(limb: dict[str, Any]) -> list[dict[str, Any]]:
    out = []
    for spring in limb["springs"]:
        turns = spring["deflection_unit"] == "deg"
        torque = spring["torque"]["without_load"]
        scale = 1e-3 if spring["torque_unit"] == "N mm" else 1.0
        out.append(
            {
                "limb": limb["name"],
                "spring": spring["name"],
                "unit": "rad" if turns else "m",
                "deflection": spring["deflection"]["without_load"] * (_DEG if turns else 1e-3),
                "torque": None if torque is None else torque * scale,
            }
        )
    return out


def assembly(
    posture: Posture,
    *,
    deviations: Sequence[str] = (),
    force: ArrayLike | None = None,
    moment: ArrayLike | None = None,
    progress: Progress | None = None,
) -> Assembly:
    """Puts a machine together with the deviations of its model and further ones.

    Parameters
    ----------
    posture : Posture
        The commanded posture.
    deviations : sequence of str
        More of them, as in ``"leg x:line:1deg about x"``, ``"leg y:q2:0.2mm longer"`` or ``"*:line:1mm along z"`` (* is every limb).
    force, moment : array_like, shape (3,), optional
        Load on the tool, N and N m, base axes.

    progress : callable, optional
        Called with what is done, how much there is (0: nobody knows) and the name of the stage.

    Returns
    -------
    Assembly

    Examples
    --------
    >>> import kinetostat as ks
    >>> posture = ks.Machine.preset("orthoglide").posture()
    >>> found = assembly(posture, deviations=["leg x:foot arm:1deg about x"])
    >>> found.over_constraint, found.wrench.shape
    (3, (3, 6))
    """
    further = texts("deviations", deviations, "a list of text as 'leg x:line:1deg about x'")
    answer = commands.assemble(
        **place(posture),
        deviation=further or None,
        force=triple("force", force),
        moment=triple("moment", moment),
        all=True,
        progress=progress,
    )
    platforms, limbs = answer["platforms"], answer["limbs"]
    zero = np.zeros((len(platforms), 6))

    def of(case: str) -> Floats:
        found = _twists(platforms, case)
        return zero if found is None else found

    held = _wrenches(limbs, "without_load")
    return Assembly(
        over_constraint=answer["over_constraint"]["degree"],
        stresses=tuple(s["in_words"] for s in answer["over_constraint"]["stresses"]),
        platforms=tuple(p["name"] for p in platforms),
        limbs=tuple(limb["name"] for limb in limbs),
        displacement=of("without_load"),
        displacement_by_deviations=of("without_load_by_deviations"),
        displacement_linear=of("without_load_linear"),
        displacement_under_load=_twists(platforms, "under_load"),
        wrench=np.zeros((len(limbs), 6)) if held is None else held,
        wrench_under_load=_wrenches(limbs, "under_load"),
        springs=tuple(spring for limb in limbs for spring in _springs(limb)),
        stable=answer["stable"],
        warnings=tuple(w["message"] for w in answer["warnings"]),
        answer=answer,
    )
