"""Stiffness near a singular posture against numbers of 60 digits: how much of it rounding takes, of one posture and of many."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest

import kinetostat as ks

mpmath = pytest.importorskip("mpmath", reason="mpmath comes with SymPy, which is not installed")

AXES = "zyyxyx"
OFFSETS = [(0.35, 0, 0.675), (0, 0, 1.15), (0.2, 0, -0.041), (1.0, 0, 0), (0.24, 0, 0), (0.1, 0.05, 0.3)]
STIFFNESSES = [2e6, 3e6, 2.5e6, 4e5, 3e5, 1e5]
EPSILON = 2.0**-52


def arm() -> ks.Machine:
    """Six drives with springs; the fourth and the sixth axis are in line where the fifth is at zero."""
    made = ks.MachineBuilder("wrist")
    made.platform("tool", np.sum(OFFSETS, axis=0))
    limb = made.limb("arm", to="tool")
    for index, (axis, offset, stiffness) in enumerate(zip(AXES, OFFSETS, STIFFNESSES, strict=True)):
        limb.actuator(f"q{index}", "revolute", axis, stiffness).rigid(offset)
    return made.machine()


MACHINE = arm()


def turn(axis: str, angle: Any) -> Any:
    c, s = mpmath.cos(angle), mpmath.sin(angle)
    rows = {"x": [[1, 0, 0], [0, c, -s], [0, s, c]], "y": [[c, 0, s], [0, 1, 0], [-s, 0, c]], "z": [[c, -s, 0], [s, c, 0], [0, 0, 1]]}
    return mpmath.matrix(rows[axis])


def exact(joints: Any) -> Any:
    """``J^-T K J^-1`` [R 3.7, 3.8], of the Jacobian of the drawing."""
    rotation, place = mpmath.eye(3), mpmath.zeros(3, 1)
    axes, places = [], []
    for axis, offset, angle in zip(AXES, OFFSETS, joints, strict=True):
        axes.append(rotation * mpmath.matrix([int(axis == other) for other in "xyz"]))
        places.append(place.copy())
        rotation = rotation * turn(axis, mpmath.mpf(float(angle)))
        place = place + rotation * mpmath.matrix([mpmath.mpf(float(v)) for v in offset])
    jacobian = mpmath.zeros(6, 6)
    for k, (w, at) in enumerate(zip(axes, places, strict=True)):
        d = place - at
        linear = (w[1] * d[2] - w[2] * d[1], w[2] * d[0] - w[0] * d[2], w[0] * d[1] - w[1] * d[0])
        for row, value in enumerate((*linear, *w)):
            jacobian[row, k] = value
    back = mpmath.inverse(jacobian)
    return back.T * mpmath.diag([mpmath.mpf(k) for k in STIFFNESSES]) * back


def off(found: Any, wanted: Any) -> float:
    """Largest difference of an entry by the largest entry; NaN fails."""
    size = max(abs(entry) for entry in wanted)
    assert np.isfinite(found).all()
    return float(max(abs(mpmath.mpf(float(found[i, j])) - wanted[i, j]) for i in range(6) for j in range(6)) / size)


@pytest.mark.parametrize("bend", [1e-1, 1e-2, 1e-3, 1e-4, -1e-5, 1e-6])
def test_rounding_is_bounded_by_the_condition(bend: float) -> None:
    with mpmath.workdps(60):
        rows = np.random.default_rng(7).uniform(-1, 1, (5, 6))
        rows[:, 4] = bend
        many = MACHINE.stiffness(joints=rows).matrix
        for joints, of_many in zip(rows, many, strict=True):
            wanted = exact(joints)
            sizes = mpmath.svd_r(wanted, compute_uv=False)
            condition = float(sizes[0] / sizes[5])
            assert condition > 1e2
            assert off(of_many, wanted) <= EPSILON * condition
            # The posture alone is solved by the Jacobian, whose condition is the root of that of the stiffness.
            assert off(MACHINE.posture(joints=joints).stiffness().matrix, wanted) <= 4 * EPSILON * np.sqrt(condition)
