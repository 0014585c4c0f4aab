"""Arrays as they are read and written in blocks, many rows at a time."""

from __future__ import annotations

import pickle

import numpy as np
import pytest

import kinetostat as ks

MACHINE = ks.Machine.preset("orthoglide")
ARM = ks.Machine.preset("heavy_6r")
COUNT = 3000  # more than one thread reads at a time


def poses_of(machine: ks.Machine, count: int = COUNT) -> np.ndarray:
    """Around home; the tool turned a little otherwise in every third row, so that some rows share their rotation."""
    rng = np.random.default_rng(11)
    poses = np.tile(machine.home, (count, 1, 1))
    poses[:, :3, 3] += rng.uniform(-0.02, 0.02, (count, 3))
    for i in range(0, count, 3):
        angle = rng.uniform(-0.1, 0.1)
        turn = np.array([[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]])
        poses[i, :3, :3] = turn @ poses[i, :3, :3]
    return poses


def test_rows_are_those_of_single_postures():
    poses = poses_of(ARM)
    many = ARM.stiffness(poses)
    loaded = ARM.equilibrium(poses, [100, -20, 30, 0, 5, 0])
    assert many.solved.all()
    assert loaded.solved.all()
    for i in (0, 1, 2, 3, 1022, 1023, 1024, 1025, COUNT - 1):
        posture = ARM.posture(pose=poses[i])
        one = posture.deflected_by([100, -20, 30, 0, 5, 0])
        np.testing.assert_allclose(many.commands[i], posture.commands, rtol=0, atol=1e-9)
        np.testing.assert_allclose(many.matrix[i], posture.stiffness().matrix, rtol=1e-8, atol=1e-8 * np.abs(many.matrix[i]).max())
        np.testing.assert_allclose(loaded.tool[i], one.tool, rtol=0, atol=1e-10)
        np.testing.assert_allclose(loaded.displacement[i], one.displacement, rtol=0, atol=1e-10)
        np.testing.assert_allclose(loaded.actuator_forces[i], one.actuator_forces, rtol=1e-6, atol=1e-5)


@pytest.mark.parametrize("threads", [1, 2])
@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda pose: pose.__setitem__((0, 3), np.nan), "poses holds NaN in row 2047: give finite numbers"),
        (lambda pose: pose.__setitem__((3, 3), np.inf), "poses holds inf in row 2047: give finite numbers"),
        (lambda pose: pose.__setitem__((3, 3), 2.0), r"poses\[2047\] is no pose: the last row"),
        (lambda pose: pose.__setitem__((0, 0), 0.5), r"poses\[2047\] is no pose: its rotation is not orthonormal"),
        (lambda pose: pose.__imul__(np.array([-1.0, 1, 1, 1])[:, None]), r"poses\[2047\] is no pose: its rotation mirrors"),
    ],
)
def test_the_first_row_that_is_wrong_is_named(change, said, threads):
    poses = poses_of(MACHINE)
    change(poses[2047])
    poses[2500] = np.nan
    with pytest.raises(ks.ArgumentError, match=said):
        MACHINE.stiffness(poses, threads=threads)
    with pytest.raises(ks.ArgumentError, match=said):
        MACHINE.equilibrium(poses, threads=threads)


def test_threads_and_blocks_change_no_bit():
    poses = poses_of(MACHINE)
    one = MACHINE.stiffness(poses, threads=1)
    two = MACHINE.stiffness(poses, threads=2)
    assert one.matrix.tobytes() == two.matrix.tobytes()
    parts = [MACHINE.stiffness(part).matrix for part in np.split(poses, [5, 700, 1025])]
    assert np.concatenate(parts).tobytes() == one.matrix.tobytes()


def test_joints_that_are_given_are_the_commands_and_have_limits():
    home = ARM.posture().commands
    joints = np.tile(home, (100, 1))
    lower, upper = ARM.actuators[0].limits
    joints[:, 0] = np.linspace(lower - 0.1, upper + 0.1, 100)
    found = ARM.stiffness(joints=joints)
    loaded = ARM.equilibrium(joints=joints)
    outside = (joints[:, 0] < lower) | (joints[:, 0] > upper)
    assert 0 < outside.sum() < 100
    for answer in (found, loaded):
        np.testing.assert_array_equal(answer.commands, joints)
        np.testing.assert_array_equal(answer.status == ks.Status.OUTSIDE_LIMITS, outside)


@pytest.mark.parametrize(
    "wrench",
    [
        [100, 0, 0, 0, 0, 1.5],
        (100, 0, 0, 0, 0, 1.5),
        np.array([100, 0, 0, 0, 0, 1.5]),
        np.array([100, 0, 0, 0, 0, 1.5], dtype=np.float32),
        np.array([[100, 7], [0, 7], [0, 7], [0, 7], [0, 7], [1.5, 7]])[:, 0],
    ],
)
def test_a_wrench_is_read_from_anything_and_kept(wrench):
    posture = MACHINE.posture([0.01, 0.02, -0.01])
    found = posture.deflected_by(wrench)
    np.testing.assert_array_equal(found.wrench, [100, 0, 0, 0, 0, 1.5])
    again = pickle.loads(pickle.dumps(found))
    np.testing.assert_array_equal(again.wrench, found.wrench)
    np.testing.assert_array_equal(again.tool, found.tool)
    np.testing.assert_array_equal(again.stiffness, found.stiffness)
