"""Questions at postures that their place does not tell: redundant arms, other elbows."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks


def redundant() -> ks.Posture:
    """An arm of seven drives, away from home."""
    builder = ks.MachineBuilder("seven")
    builder.platform("tool", [0, 0, 1.05])
    limb = builder.limb("arm", to="tool")
    for index, axis in enumerate("zyzyzyz"):
        limb.actuator(f"j{index}", "revolute", axis, 1e5).rigid([0, 0, 0.15])
    return builder.machine().posture(joints=[0.3, 0.5, -0.4, 0.8, 0.2, -0.6, 0.1])


def flipped(tool: float) -> ks.Posture:
    """The wrist of an arm turned over: the same place, other joints."""
    arm = ks.Machine.preset("heavy_6r").with_tool(length=tool)
    place = arm.home[:3, 3] + [0.1, -0.2, 0.15]
    near = arm.posture(place)
    turned = near.commands + np.array([0, 0, 0, np.pi, 0, np.pi])
    turned[4] = -turned[4]
    found = arm.posture(place, near=arm.posture(joints=turned))
    assert np.abs(found.commands - near.commands).max() > 1
    np.testing.assert_allclose(found.target, near.target, rtol=0, atol=1e-12)
    return found


@pytest.mark.parametrize("posture", [redundant(), flipped(0.0), flipped(0.2)], ids=["redundant", "flipped", "flipped with a tool"])
def test_questions_are_about_the_posture_itself(posture: ks.Posture) -> None:
    machine = posture.machine
    assert np.abs(machine.posture(pose=posture.target).commands - posture.commands).max() > 0.01
    compliance = posture.stiffness().compliance
    for axis, name in enumerate(("x", "y", "z", "rx", "ry", "rz")):
        found = posture.shares(name)
        by_joints = machine.shares(joints=posture.commands, direction=name)
        np.testing.assert_allclose(found.share, by_joints.share, rtol=1e-9, atol=1e-12)
        assert found.compliance == pytest.approx(compliance[axis, axis], rel=1e-9)
    # A small force along a curve, and the only shape under it, are where the machine goes by its compliance.
    force = np.array([3.0, -2.0, 1.0])
    wrench = np.concatenate([force, np.zeros(3)])
    loaded = posture.deflected_by(wrench)
    shapes = posture.shapes(force=force, fruitless=5)
    assert np.abs(shapes.position - loaded.tool[:3, 3]).max(axis=1).min() < 1e-9
    curve = posture.curve(direction=[1, 0, 0], displacement=(0, 1e-5), free="others")
    branch = curve.branches[0]
    slope = (branch.force[-1] - branch.force[0]) / (branch.displacement[-1] - branch.displacement[0])
    # The machine's own loads change the stiffness by less than this.
    assert slope == pytest.approx(1 / compliance[0, 0], rel=1e-3)
    assert posture.assembly().over_constraint == 0
    assert machine.drawing(posture) != machine.drawing(machine.posture(pose=posture.target))
