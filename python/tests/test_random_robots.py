"""Ten random robots beside a model in plain numpy: stiffness and equilibria to 1e-9."""

from __future__ import annotations

import numpy as np
import pytest
from numpy_robots import cartesian_stiffness, document, equilibrium, parallel, serial

import kinetostat as ks

ROBOTS = [(make, seed) for make in (serial, parallel) for seed in range(5)]
NAMES = [f"{make.__name__} {seed}" for make, seed in ROBOTS]


def robot(make, seed, with_spring6):
    rng = np.random.default_rng([seed, make is parallel])
    limbs = make(rng, with_spring6)
    machine = ks.Machine.from_dict(document(limbs, "random"))
    return rng, limbs, machine


@pytest.mark.parametrize(("make", "seed"), ROBOTS, ids=NAMES)
@pytest.mark.parametrize("with_spring6", [False, True], ids=["springs", "six springs"])
def test_stiffness(make, seed, with_spring6):
    _, limbs, machine = robot(make, seed, with_spring6)
    wanted = cartesian_stiffness(limbs)
    found = machine.posture().stiffness().matrix
    # Force and moment measured alike: by the diagonal.
    scale = np.diag(1 / np.sqrt(np.diag(wanted)))
    np.testing.assert_allclose(scale @ found @ scale, scale @ wanted @ scale, rtol=0, atol=1e-9)
    many = machine.stiffness(machine.home[None])
    assert many.solved.all()
    np.testing.assert_allclose(scale @ many.matrix[0] @ scale, scale @ wanted @ scale, rtol=0, atol=1e-9)


@pytest.mark.parametrize(("make", "seed"), ROBOTS, ids=NAMES)
def test_equilibrium(make, seed):
    rng, limbs, machine = robot(make, seed, False)
    wrench = rng.uniform(-1, 1, 6) * [1000, 1000, 1000, 100, 100, 100]
    wanted, left = equilibrium(limbs, wrench)
    assert left < 1e-13
    one = machine.posture().deflected_by(wrench)
    many = machine.equilibrium(machine.home[None], wrench)
    assert many.solved.all()
    size = np.abs(wanted[:3, 3] - machine.home[:3, 3]).max()
    assert size > 1e-4, "a load that hardly bends shows nothing"
    for found in (one.tool, many.tool[0]):
        np.testing.assert_allclose(found, wanted, rtol=0, atol=1e-9 * size)
    linear = np.linalg.solve(cartesian_stiffness(limbs), wrench)
    assert np.abs(linear[:3] - one.displacement[:3]).max() > 1e-6 * size, "the linear answer would do as well"
