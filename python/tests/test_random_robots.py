"""Ten random robots against a small model in plain numpy."""

from __future__ import annotations

import numpy as np
import pytest
from independent import random_arm

import kinetostat as ks


def drawn(seed, arm):
    draw = np.random.default_rng(1000 + seed)
    return draw.uniform(-1.2, 1.2, len(arm.axes)), draw.uniform(-1, 1, 6) * [300, 300, 300, 60, 60, 60]


@pytest.mark.parametrize("seed", range(10))
def test_stiffness(seed):
    arm = random_arm(seed)
    commands, _ = drawn(seed, arm)
    machine = ks.Machine.from_dict(arm.document())
    posture = machine.posture(joints=commands)
    position, rotation = arm.tool(commands)
    assert np.abs(posture.target[:3, 3] - position).max() < 1e-12
    assert np.abs(posture.target[:3, :3] - rotation).max() < 1e-12
    # [R 3.10]: springs in series.
    jacobian = arm.jacobian(commands)
    compliance = jacobian / arm.stiffness @ jacobian.T
    expected = np.linalg.inv(compliance)
    found = posture.stiffness().matrix
    # Beside what the matrix itself carries of rounding: entries by their directions.
    scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
    precision = 1e-9 * max(1.0, np.linalg.cond(compliance) * 1e-6)
    assert np.all(np.abs(found - expected) < precision * scale)
    assert np.all(np.abs(posture.stiffness().compliance - compliance) < 1e-9 * np.abs(compliance).max())
    many = machine.stiffness(joints=commands[None])
    assert np.all(np.abs(many.matrix[0] - found) < precision * scale)


@pytest.mark.parametrize("seed", range(10))
def test_equilibrium(seed):
    arm = random_arm(seed)
    commands, wrench = drawn(seed, arm)
    machine = ks.Machine.from_dict(arm.document())
    theta = arm.equilibrium(commands, wrench)
    position, rotation = arm.tool(theta)
    loaded = machine.posture(joints=commands).deflected_by(wrench)
    size = np.abs(arm.links).sum()
    assert np.abs(loaded.tool[:3, 3] - position).max() < 1e-9 * size
    assert np.abs(loaded.tool[:3, :3] - rotation).max() < 1e-9
    many = machine.equilibrium(joints=commands[None], wrenches=wrench)
    assert many.status[0] == ks.Status.SOLVED
    assert np.abs(many.tool[0, :3, 3] - position).max() < 1e-9 * size
    # The torques of the drives carry the load: K (theta - q) = J^T w.
    torque = arm.stiffness * (theta - commands)
    assert np.abs(np.abs(many.actuator_forces[0]) - np.abs(torque)).max() < 1e-8 * np.abs(torque).max()
