"""Jacobians, frames, inverse solutions and gradients against Pinocchio, closed forms and differences."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks

ARM = ks.Machine.preset("heavy_6r")
HERE = ARM.posture([1.2, 0.1, 0.9])
WRENCH = np.array([100.0, -200.0, -300.0, 15.0, -8.0, 20.0])
URDF = """<robot name="r"><link name="base"/><link name="a"/><link name="b"/><link name="c"/><link name="tip"/>
<joint name="q1" type="revolute"><parent link="base"/><child link="a"/><origin xyz="0 0.1 0.4" rpy="0.1 0 0.3"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
<joint name="q2" type="revolute"><parent link="a"/><child link="b"/><origin xyz="0.1 0 0.3" rpy="0 0.2 0"/><axis xyz="0 1 0"/>
<limit lower="-3" upper="3" effort="0" velocity="1"/></joint>
<joint name="q3" type="prismatic"><parent link="b"/><child link="c"/><origin xyz="0 0 0.5" rpy="0.4 0 0"/><axis xyz="0 0.6 0.8"/>
<limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<joint name="end" type="fixed"><origin xyz="0.2 0 0.1" rpy="0 0 0.7"/><parent link="c"/><child link="tip"/></joint></robot>"""


def twist(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Small motion from one pose to another, base axes."""
    return np.concatenate([other[:3, 3] - one[:3, 3], ks.rotation_vector(other[:3, :3] @ one[:3, :3].T)])


def test_frames_and_jacobian_are_those_of_pinocchio() -> None:
    pin = pytest.importorskip("pinocchio")
    machine = ks.Machine.from_urdf(URDF, tip="tip", stiffness=[2e5, 1e5, 3e6])
    model = pin.buildModelFromXML(URDF)
    data, tip = model.createData(), model.getFrameId("tip")
    rng = np.random.default_rng(7)
    joints = rng.uniform(-0.9, 0.9, (20, 3))
    found = machine.frames(joints)
    for q, tool in zip(joints, found.tool, strict=True):
        pin.computeJointJacobians(model, data, q)
        pin.updateFramePlacements(model, data)
        np.testing.assert_allclose(tool, data.oMf[tip].homogeneous, atol=1e-12)
        theirs = pin.getFrameJacobian(model, data, tip, pin.LOCAL_WORLD_ALIGNED)
        posture = machine.posture(joints=q)
        np.testing.assert_allclose(posture.jacobian("actuated"), theirs, atol=1e-12)
        # Springs of drives turn about the axes of their drives.
        np.testing.assert_allclose(posture.jacobian("theta"), theirs, atol=1e-12)
        np.testing.assert_allclose(np.diag(posture.joint_stiffness()), [2e5, 1e5, 3e6])


def test_compliance_is_that_of_jacobian_and_joint_stiffness() -> None:
    for name, posture in (("heavy_6r", HERE), ("kuka_kr270_like", ks.Machine.preset("kuka_kr270_like").posture())):
        j, k = posture.jacobian("theta"), posture.joint_stiffness()
        assert j.shape == (6, len(posture.coordinates("theta"))), name
        compliance = posture.stiffness().compliance
        np.testing.assert_allclose(j @ np.linalg.inv(k) @ j.T, compliance, rtol=1e-8, atol=1e-9 * np.abs(compliance).max())


def test_closed_loops_move_as_their_jacobians_say() -> None:
    machine = ks.Machine.preset("orthoglide")
    a, b = machine.posture([0.02, 0.01, 0.03]), machine.posture([0.02 + 1e-6, 0.01, 0.03])
    for limb, before, after in zip(machine.limbs, a.limbs, b.limbs, strict=True):
        # Springs are at rest: passive joints and the drive alone carry the tool along.
        whole = a.jacobian("all", limb=limb)
        moved = np.concatenate([after[1] - before[1], after[0] - before[0]])
        np.testing.assert_allclose(whole @ moved, [1e-6, 0, 0, 0, 0, 0], atol=1e-11)
    with pytest.raises(ks.ArgumentError, match="limb is None, expected one of leg x"):
        a.jacobian()


def test_jacobian_at_a_node() -> None:
    (limb, node) = next(name for name in HERE.frames() if name[1] != "tip")
    step = 1e-6
    for k in range(6):
        move = step * np.eye(6)[k]
        ahead, behind = (ARM.posture(joints=HERE.commands + s).frames()[limb, node] for s in (move, -move))
        np.testing.assert_allclose(HERE.jacobian("actuated", at=node)[:, k], twist(behind, ahead) / (2 * step), atol=1e-8)
    with pytest.raises(ks.ArgumentError, match="nowhere"):
        HERE.jacobian(at="nowhere")


def test_hessian_is_the_derivative_of_the_torques() -> None:
    step = 1e-5
    torques = lambda q: ARM.posture(joints=q).jacobian("actuated").T @ WRENCH  # noqa: E731
    q = HERE.commands
    ring = np.stack([(torques(q + e) - torques(q - e)) / (2 * step) for e in step * np.eye(6)], axis=1)
    np.testing.assert_allclose(HERE.load_hessian(WRENCH, "actuated"), ring, atol=1e-5)
    assert np.abs(ring).max() > 100


def test_frames_of_many_are_those_of_one() -> None:
    joints = HERE.commands + np.random.default_rng(3).normal(0, 0.1, (5, 20, 6))
    found = ARM.frames(joints)
    assert found.tool.shape == (5, 20, 4, 4)
    for at in ((0, 0), (4, 19)):
        posture = ARM.posture(joints=joints[at])
        np.testing.assert_array_equal(found.tool[at], posture.target)
        for name, frame in zip(found.nodes, found.frames[at], strict=True):
            np.testing.assert_array_equal(frame, posture.frames()[name])
    loops = ks.Machine.preset("orthoglide")
    back = loops.frames([loops.posture([0.02, 0.01, 0.03]).commands])
    np.testing.assert_allclose(back.tool[0, :3, 3], [0.02, 0.01, 0.03], atol=1e-9)


def test_all_inverse_solutions_of_a_spherical_wrist() -> None:
    found = ARM.inverse_solutions(HERE.target)
    assert len(found) == 8
    for posture in found:
        np.testing.assert_allclose(ARM.posture(joints=posture.commands).target, HERE.target, atol=1e-9)
    apart = [np.abs(np.exp(1j * a.commands) - np.exp(1j * b.commands)).max() for i, a in enumerate(found) for b in found[:i]]
    assert min(apart) > 1e-3
    inside = [posture.status == ks.Status.SOLVED for posture in found]
    assert inside == sorted(inside, reverse=True)
    assert inside[0]


def test_all_inverse_solutions_of_three_joints_in_a_plane() -> None:
    lengths = (0.5, 0.4, 0.3)
    made = ks.MachineBuilder("planar")
    made.platform("tool", [sum(lengths), 0, 0])
    arm = made.limb("arm", to="tool")
    for k, length in enumerate(lengths):
        arm.actuator(f"q{k}", "revolute", "z", 1e5).rigid([length, 0, 0])
    machine = made.machine()
    rng = np.random.default_rng(11)
    for _ in range(20):
        q = rng.uniform(-2.5, 2.5, 3)
        q[1] = np.sign(q[1]) * max(abs(q[1]), 0.1)
        target = machine.posture(joints=q).target
        # The elbow on the other side of the line from the base to the wrist.
        wrist = target[:2, 3] - lengths[2] * target[:2, 0]
        base = 2 * np.arctan2(wrist[1], wrist[0]) - q[0]
        other = np.array([base, -q[1], q.sum() - base + q[1]])
        found = machine.inverse_solutions(target)
        assert len(found) == 2
        distance = [[np.abs(np.exp(1j * p.commands) - np.exp(1j * w)).max() for p in found] for w in (q, other)]
        assert max(map(min, distance)) < 1e-7


def test_an_arm_that_is_none_has_no_inverse_solutions() -> None:
    assert ARM.inverse_solutions([9, 0, 0]) == ()
    with pytest.raises(ks.ArgumentError):
        ks.Machine.preset("orthoglide").inverse_solutions([0, 0, 0])


def test_gradients_of_a_two_link_arm_by_hand() -> None:
    a, b, k1, k2 = 0.7, 0.5, 2e5, 1e5
    made = ks.MachineBuilder("two")
    made.platform("tool", [a + b, 0, 0])
    arm = made.limb("arm", to="tool").actuator("q1", "revolute", "z", k1).rigid([a, 0, 0], "upper")
    arm.actuator("q2", "revolute", "z", k2).rigid([b, 0, 0], "fore")
    arm.spring6("foot", [1e7, 1e7, 1e7, 1e6, 1e6, 1e6])
    machine = made.machine()
    q = np.array([0.4, 0.9])
    posture = machine.posture(joints=q)
    found = posture.gradients()
    at = {path: i for i, path in enumerate(found.paths)}
    # dK = -K (dC) K, dC = -J_1 J_1^T / k1^2 by the first spring.
    j, k = posture.jacobian("actuated"), posture.stiffness().matrix
    for name, column, stiffness in (("q1", 0, k1), ("q2", 1, k2)):
        i = at[f"chain.arm.{name}.stiffness_n_m_per_rad"]
        np.testing.assert_allclose(found.stiffness[i], k @ np.outer(j[:, column], j[:, column]) @ k / stiffness**2, rtol=1e-6, atol=1e-6)
        np.testing.assert_allclose(found.pose[i], 0, atol=1e-12)
    # The fore arm is longer: the tool goes along it.
    i = next(i for path, i in at.items() if path.startswith("chain.arm.fore") and path.endswith("position_m.x"))
    along = [np.cos(q.sum()), np.sin(q.sum()), 0, 0, 0, 0]
    np.testing.assert_allclose(found.pose[i], along, atol=1e-9)
    assert found.units[i] == "m"


def test_gradients_under_load_are_differences() -> None:
    path, step = "chain.arm.joint 2.stiffness_n_m_per_rad", 1.3e4
    found = HERE.gradients([path], WRENCH)
    each = []
    for sign in (1, -1):
        document = ARM.to_dict()
        joint = next(e for e in document["chain"]["arm"]["elements"] if e.get("name") == "joint 2")
        joint["stiffness_n_m_per_rad"] += sign * step
        loaded = ks.Machine.from_dict(document).posture(joints=HERE.commands).deflected_by(WRENCH)
        each.append((loaded.tool, loaded.stiffness))
    moved = twist(each[1][0], each[0][0]) / (2 * step)
    np.testing.assert_allclose(found.pose[0], moved, rtol=2e-5, atol=1e-5 * np.abs(moved).max())
    slope = (each[0][1] - each[1][1]) / (2 * step)
    np.testing.assert_allclose(found.stiffness[0], slope, rtol=1e-5, atol=1e-5 * np.abs(slope).max())
    assert found.unanswered == {}
    assert (found.stiffness_error < 1e-6 * np.abs(found.stiffness).max()).all()
    with pytest.raises(ks.ModelError):
        HERE.gradients(["chain.arm.nothing"])


def test_fields_that_are_left_out() -> None:
    places = np.array([[1.2, 0.1, 0.9], [1.3, 0.0, 0.8], [9, 0, 0]])
    whole = ARM.equilibrium(places, WRENCH)
    part = ARM.equilibrium(places, WRENCH, fields=["displacement"])
    assert part.tool is None
    assert part.stiffness is None
    assert part.actuator_forces is None
    for name in ("status", "commands", "displacement", "stable", "against_force"):
        np.testing.assert_array_equal(getattr(part, name), getattr(whole, name))
    assert part[:2].displacement.shape == (2, 6)
    with pytest.raises(ks.ArgumentError, match=r"fields\[0\] is 'moment', expected one of tool, displacement"):
        ARM.equilibrium(places, WRENCH, fields=["moment"])


def test_a_posture_gives_way_in_its_own_configuration() -> None:
    """Either elbow yields as its own springs say, J K^-1 J^T; what is found later is of the same equilibrium."""
    machine = ks.Machine.preset("scara")
    load = np.array([0.3, -0.5, 0.2, 0, 0, 0])
    both = machine.inverse_solutions(machine.posture(joints=[0.4, 1.1, -0.05, 0.3]).target)
    moved = []
    for posture in both:
        j, k = posture.jacobian("theta"), posture.joint_stiffness()
        expected = j @ np.linalg.solve(k, j.T @ load)
        loaded = posture.deflected_by(load)
        moved.append(loaded.displacement_by_load)
        np.testing.assert_allclose(moved[-1], expected, rtol=0, atol=2e-3 * np.linalg.norm(expected))
        np.testing.assert_allclose(loaded.compliance @ loaded.stiffness, np.eye(6), atol=1e-6)
        np.testing.assert_allclose(loaded.actuator_forces, posture.jacobian("actuated").T @ load + weights(posture), rtol=0, atol=0.02)
        assert loaded.stable
        assert loaded.spring_energy > 0
    assert len(both) == 2
    assert np.linalg.norm(moved[0] - moved[1]) > 0.01 * np.linalg.norm(moved[0])


def weights(posture: ks.Posture) -> np.ndarray:
    """Loads of its own weight on the actuators."""
    return posture.deflected_by(np.zeros(6)).actuator_forces
