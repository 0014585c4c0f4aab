"""Many places at once take the postures that one place takes: other configurations, and orientations that follow."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import tolerance


def within(machine: ks.Machine, commands: np.ndarray) -> np.ndarray:
    low, high = np.array([actuator.limits for actuator in machine.actuators]).T
    return ((commands >= low) & (commands <= high)).all(axis=-1)


@pytest.mark.parametrize("name", ["heavy_6r", "kuka_kr270_like", "scara"])
def test_arms_reach_within_their_limits_what_their_joints_reach(name: str) -> None:
    arm = ks.Machine.preset(name)
    low, high = np.array([actuator.limits for actuator in arm.actuators]).T
    joints = np.random.default_rng(20).uniform(low, high, (100, len(low)))
    poses = np.array([arm.posture(joints=q).target for q in joints])
    wrench = [120.0, -50.0, 80.0, 3.0, -4.0, 5.0]
    stiffness, loaded = arm.stiffness(poses), arm.equilibrium(poses, wrench)
    targets = arm.targets(poses, wrench)
    assert (stiffness.status == ks.Status.SOLVED).all()
    assert (loaded.status == ks.Status.SOLVED).all()
    assert within(arm, stiffness.commands).all()
    assert within(arm, loaded.commands).all()
    # The corrected command may leave the limits where the place itself is close to them.
    assert (targets.status == ks.Status.SOLVED).mean() > 0.97
    solved = targets.status == ks.Status.SOLVED
    np.testing.assert_allclose(targets.tool[solved, :3, 3], poses[solved, :3, 3], rtol=0, atol=1e-9)
    by_joints = arm.equilibrium(joints=loaded.commands, wrenches=wrench)
    assert np.abs(by_joints.tool - loaded.tool).max() < 1e-8
    for pose, commands, matrix in zip(poses[:40], stiffness.commands, stiffness.matrix, strict=False):
        # Where these commands lead, and its stiffness there by itself.
        there = arm.posture(joints=commands)
        np.testing.assert_allclose(there.target, pose, rtol=0, atol=1e-9)
        np.testing.assert_allclose(there.stiffness().matrix, matrix, rtol=0, atol=1e-6 * np.abs(matrix).max())
        # One place by itself: of several configurations within limits, its search may end in another one.
        single = arm.posture(pose=pose)
        assert within(arm, single.commands)
        np.testing.assert_allclose(arm.posture(joints=single.commands).target, pose, rtol=0, atol=1e-9)


def test_a_question_about_an_arm_in_another_configuration_is_about_that_posture() -> None:
    arm = ks.Machine.preset("heavy_6r")
    low, high = np.array([actuator.limits for actuator in arm.actuators]).T
    joints = np.random.default_rng(20).uniform(low, high, (60, len(low)))
    poses = [arm.posture(joints=q).target for q in joints]
    # The eight configurations differ by half a turn about joint 4 at least, or in the elbow.
    postures = [p for p in map(lambda pose: arm.posture(pose=pose), poses) if np.abs(p.commands).max() > 2]
    posture = postures[0]
    shares = posture.shares("x")
    assert shares.compliance == pytest.approx(posture.stiffness().compliance[0, 0], rel=1e-9)


@pytest.mark.parametrize(("name", "places"), [("prs3", [[0.02, 0.03, -0.75], [0.0, 0.01, -0.76]]), ("tricept_like", None)])
def test_positions_of_a_machine_that_turns_take_the_orientation_that_follows(name: str, places: list[list[float]] | None) -> None:
    machine = ks.Machine.preset(name)
    home = machine.home[:3, 3]
    positions = np.array(home + np.array([[0, 0.003, 0], [0.03, -0.03, 0.01], [-0.02, 0.015, 0]]) if places is None else places)
    postures = [machine.posture(position) for position in positions]
    wrench = [10.0, 4.0, -6.0, 0, 0, 0]
    stiffness, loaded = machine.stiffness(positions), machine.equilibrium(positions, wrench)
    targets = machine.targets(positions, wrench)
    assert (stiffness.status == 0).all()
    assert (loaded.status == 0).all()
    assert (targets.status == 0).all()
    for i, posture in enumerate(postures):
        np.testing.assert_allclose(stiffness.commands[i], posture.commands, rtol=0, atol=1e-8)
        matrix = posture.stiffness().matrix
        np.testing.assert_allclose(stiffness.matrix[i], matrix, rtol=0, atol=1e-7 * np.abs(matrix).max())
        np.testing.assert_allclose(loaded.displacement[i], posture.deflected_by(wrench).displacement, rtol=0, atol=1e-11)
        # Commanded there and loaded, the tool is where it was to be.
        again = machine.posture(pose=targets.targets[i], near=posture).deflected_by(wrench)
        np.testing.assert_allclose(again.tool[:3, 3], positions[i], rtol=0, atol=1e-10)
    np.testing.assert_allclose(targets.tool[:, :3, 3], positions, rtol=0, atol=1e-10)
    # The pose of home itself, too.
    assert machine.targets(machine.home, wrench).status == 0


def test_a_map_of_a_hybrid_has_numbers_where_it_stands() -> None:
    machine = ks.Machine.preset("tricept_like")
    h = machine.home[:3, 3]
    g = np.linspace(-0.03, 0.03, 5)
    found = machine.map(x=h[0] + g, y=h[1] + g, z=h[2] + 0.01)
    assert (found.status == 0).all()
    assert np.isfinite(found.stiffness_softest).all()
    one = machine.posture([h[0] + g[4], h[1] + g[0], h[2] + 0.01])
    assert found.stiffness_x.values[4, 0] == pytest.approx(1 / one.stiffness().compliance[0, 0], rel=1e-6)


@pytest.mark.parametrize("name", ["prs3", "tricept_like"])
def test_tolerances_of_a_machine_that_turns_as_it_moves(name: str) -> None:
    machine = ks.Machine.preset(name)
    place = machine.home[:3, 3] + [0.004, 0.003, 0.002]
    spread = {"load force_n.x": tolerance.normal(5.0)}
    wrench = [50.0, 20.0, -30.0, 0, 0, 0]
    found = tolerance.machines(machine, spread, [place], wrench, draws=16)
    assert np.isfinite(found.samples).all()
    compensated = found.columns.index("compensated_mm")
    deviation = found.columns.index("deviation_mm")
    assert found.nominal[0, compensated] < 1e-6 < found.nominal[0, deviation]


def test_the_distance_from_singular_is_zero_where_the_stiffness_is_singular() -> None:
    machine = ks.Machine.preset("stewart_gough_a")
    found = machine.map(x=[0.0], y=0, z=0.6, variables=["singularity_distance", "stiffness_softest"])
    assert float(found.stiffness_softest[0]) == 0
    assert float(found.singularity_distance[0]) == 0
