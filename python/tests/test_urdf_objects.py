"""Machines from objects of yourdfpy and Pinocchio, beside the same URDF as text and beside what Pinocchio says of the model."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks

STIFFNESS = {"j1": (2e5, "N m/rad"), "j2": (1e5, "N m/rad"), "j3": (1e7, "N/m")}
URDF = """<robot name="arm3">
<link name="base_link"/>
<link name="upper"><inertial><origin xyz="0.1 0 0.2" rpy="0.1 0 0"/><mass value="12"/>
<inertia ixx="0.3" iyy="0.2" izz="0.1" ixy="0.01" ixz="0" iyz="0.02"/></inertial></link>
<link name="fore"><inertial><origin xyz="0.2 0 0"/><mass value="7"/>
<inertia ixx="0.05" iyy="0.1" izz="0.1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="slide"><inertial><origin xyz="0 0 0.05"/><mass value="2"/>
<inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial></link>
<link name="tool0"><inertial><origin xyz="0 0 0"/><mass value="0.5"/>
<inertia ixx="0.001" iyy="0.001" izz="0.001" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="j1" type="revolute"><parent link="base_link"/><child link="upper"/><origin xyz="0 0 0.4" rpy="0 0 0.3"/>
<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="500" velocity="2"/></joint>
<joint name="j2" type="continuous"><parent link="upper"/><child link="fore"/><origin xyz="0.3 0 0.5" rpy="0.2 -0.1 0"/>
<axis xyz="0 0.6 0.8"/></joint>
<joint name="j3" type="prismatic"><parent link="fore"/><child link="slide"/><origin xyz="0.6 0 0" rpy="0 1.5707963267948966 0.4"/>
<axis xyz="1 0 0"/><limit lower="-0.2" upper="0.3" effort="900" velocity="1"/></joint>
<joint name="flange" type="fixed"><parent link="slide"/><child link="tool0"/><origin xyz="0 0.02 0.1" rpy="0 0 1"/></joint>
</robot>"""
JOINTS = ([0.0, 0.0, 0.0], [0.3, -0.4, 0.1], [-2.0, 2.5, -0.15])


@pytest.fixture(scope="module")
def pin():
    return pytest.importorskip("pinocchio", reason="Pinocchio (pip install pin) is not installed")


def same(found, wanted):
    assert [(a.name, a.kind) for a in found.actuators] == [(a.name, a.kind) for a in wanted.actuators]
    for joints in JOINTS:
        a, b = found.posture(joints=joints), wanted.posture(joints=joints)
        np.testing.assert_allclose(a.target, b.target, rtol=0, atol=1e-14)
        k = b.stiffness().matrix
        np.testing.assert_allclose(a.stiffness().matrix, k, rtol=0, atol=1e-12 * np.abs(k).max())
        # Under their own weight.
        np.testing.assert_allclose(a.deflected_by([0.0] * 6).displacement, b.deflected_by([0.0] * 6).displacement, rtol=0, atol=1e-14)


def test_yourdfpy(tmp_path):
    yourdfpy = pytest.importorskip("yourdfpy", reason="yourdfpy is not installed")
    path = tmp_path / "arm.urdf"
    path.write_text(URDF)
    robot = yourdfpy.URDF.load(str(path), load_meshes=False, build_scene_graph=False)
    found = ks.Machine.from_urdf(robot, stiffness=STIFFNESS)
    wanted = ks.Machine.from_urdf(URDF, stiffness=STIFFNESS)
    assert found.name == "arm3"
    assert [a.limits for a in found.actuators] == [a.limits for a in wanted.actuators]
    same(found, wanted)


def test_a_model_of_pinocchio_is_the_machine_of_its_urdf(pin):
    model = pin.buildModelFromXML(URDF)
    found = ks.Machine.from_urdf(model, tip="tool0", stiffness=STIFFNESS)
    wanted = ks.Machine.from_urdf(URDF, stiffness=STIFFNESS)
    assert found.name == "arm3"
    assert [a.limits for a in found.actuators] == [a.limits for a in wanted.actuators]
    same(found, wanted)
    # A wrapper holds its model, and the machine is a value like others.
    assert ks.Machine.from_urdf(pin.RobotWrapper(model), tip="tool0", stiffness=STIFFNESS) == found


def test_places_and_weights_are_those_that_pinocchio_computes(pin):
    model = pin.buildSampleModelManipulator()
    rng = np.random.default_rng(5)
    for i in range(1, model.njoints):
        model.inertias[i] = pin.Inertia.Random()
        model.jointPlacements[i] = pin.SE3.Random()
    model.lowerPositionLimit, model.upperPositionLimit = -np.full(model.nq, 3.0), np.full(model.nq, 3.0)
    model.gravity.linear = np.array([1.0, -2.0, -9.0])
    machine = ks.Machine.from_urdf(model, tip="effector_body", stiffness=1e13)
    data = model.createData()
    frame = model.getFrameId("effector_body")
    for _ in range(5):
        q = rng.uniform(-2.5, 2.5, model.nq)
        pin.framesForwardKinematics(model, data, q)
        loaded = machine.posture(joints=q).deflected_by([0.0] * 6)
        np.testing.assert_allclose(machine.posture(joints=q).target, data.oMf[frame].homogeneous, rtol=0, atol=1e-12)
        # What gravity asks of the drives; the loads on them are its opposite.
        torque = pin.computeGeneralizedGravity(model, data, q)
        np.testing.assert_allclose(loaded.actuator_forces, -torque, rtol=0, atol=1e-6)
        assert np.abs(torque).max() > 0.1


def test_what_no_urdf_says_is_refused(pin):
    with pytest.raises(ks.ArgumentError, match=r"'root_joint' is a JointModelFreeFlyer.*without a root joint"):
        ks.Machine.from_urdf(pin.buildSampleModelHumanoid())
    model = pin.Model()
    joint = model.addJoint(0, pin.JointModelPX(), pin.SE3.Identity(), "rail")
    model.appendBodyToJoint(joint, pin.Inertia.Random(), pin.SE3.Identity())
    with pytest.raises(ks.ArgumentError, match="'rail' slides without limits"):
        ks.Machine.from_urdf(model)
    helical = pin.Model()
    helical.addJoint(0, pin.JointModelHX(0.1), pin.SE3.Identity(), "screw")
    with pytest.raises(ks.ArgumentError, match="'screw' is a JointModelHX, expected one that turns or slides"):
        ks.Machine.from_urdf(helical)


def test_other_objects_are_refused_in_words():
    with pytest.raises(ks.ArgumentError, match="robot is a dict, expected a path"):
        ks.Machine.from_urdf({})


def test_efforts_are_no_ratings_and_ratings_can_be_added():
    machine = ks.Machine.from_urdf(URDF, stiffness=STIFFNESS)
    assert [a.rating for a in machine.actuators] == [None] * 3
    document = machine.to_dict()
    (chain,) = document["chain"].values()
    next(e for e in chain["elements"] if e.get("name") == "j1")["rated_torque_n_m"] = 500.0
    assert [a.rating for a in ks.Machine.from_dict(document).actuators] == [500.0, None, None]


def test_efforts_are_ratings_where_that_is_said():
    machine = ks.Machine.from_urdf(URDF, stiffness=STIFFNESS, efforts_are_ratings=True)
    # What turns has a torque, what slides a force; j2 states none.
    assert [(a.name, a.kind, a.rating) for a in machine.actuators] == [
        ("j1", "revolute", 500.0),
        ("j2", "revolute", None),
        ("j3", "prismatic", 900.0),
    ]
    same(machine, ks.Machine.from_urdf(URDF, stiffness=STIFFNESS))
    # Placeholders are no ratings.
    assert [a.rating for a in ks.Machine.from_urdf(CRANE, tip="hook", efforts_are_ratings=True).actuators] == [None, None]
    with pytest.raises(ks.ArgumentError, match="effort of the joint 'shoulder' is 'much', expected a number, N m or N"):
        ks.Machine.from_urdf(CRANE.replace('effort="0"', 'effort="much"'), tip="hook", efforts_are_ratings=True)


CRANE = """<robot name="crane"><link name="post"/>
<joint name="shoulder" type="revolute"><parent link="post"/><child link="boom"/><origin xyz="0 0 1.5"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<link name="boom"><inertial><origin xyz="0.5 0.2 0.1"/><mass value="3"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="elbow" type="revolute"><parent link="boom"/><child link="jib"/><origin xyz="1 0 0"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<link name="jib"><inertial><origin xyz="0.1 -0.3 0"/><mass value="2"/>
<inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
<joint name="end" type="fixed"><origin xyz="0.7 0 0"/><parent link="jib"/><child link="hook"/></joint><link name="hook"/></robot>"""


def test_lines_of_limbs_run_from_joint_to_joint():
    (line,) = ks.Machine.from_urdf(CRANE, tip="hook").posture(joints=[0.0, 0.0]).limb_lines()
    np.testing.assert_allclose(line, [[0, 0, 0], [0, 0, 1.5], [1, 0, 1.5], [1.7, 0, 1.5]], rtol=0, atol=1e-12)
    # A preset: shoulder, elbow and wrist once each, and no centre of mass between them.
    (arm,) = ks.Machine.preset("heavy_6r").posture().limb_lines()
    assert len(arm) == len(np.unique(arm.round(9), axis=0)) == 7


@pytest.mark.parametrize(
    ("stiffness", "words"),
    [
        ({"ankle": 2e5}, r"stiffness\['ankle'\] is 200000.0, expected a value and its unit as \(2e5, 'N m/rad'\)"),
        ({"shoulder": (2e5, "Nm")}, "units: N m/rad, N mm/rad"),
        ({"shoulder": ("stiff", "N m/rad")}, r"stiffness\['shoulder'\] has dtype"),
    ],
)
def test_stiffnesses_without_units_are_refused_in_words(stiffness, words):
    with pytest.raises(ks.ArgumentError, match=words):
        ks.Machine.from_urdf(CRANE, tip="hook", stiffness=stiffness)


def test_what_is_to_do_is_said_in_the_arguments_of_python():
    forked = CRANE.replace(
        "</robot>", '<link name="sign"/><joint name="nail" type="fixed"><parent link="jib"/><child link="sign"/></joint></robot>'
    )
    with pytest.raises(ks.ModelError, match="name it: tip=LINK; links at the ends of the tree are: 'hook', 'sign'"):
        ks.Machine.from_urdf(forked)
    assert repr(ks.Machine.from_urdf(forked, tip="hook")).endswith("1 limb, 2 actuators>")
