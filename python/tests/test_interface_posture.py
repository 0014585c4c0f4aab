"""Postures, curves, shapes, assembly, problems and force models against closed forms and printed numbers."""

from __future__ import annotations

import copy
import pickle

import numpy as np
import pytest

import kinetostat as ks
from kinetostat.curves import Judged, PointKind, critical_load

POSITION = [0.02, -0.03, 0.05]


@pytest.fixture(scope="module")
def posture() -> ks.Posture:
    return ks.Machine.preset("orthoglide").posture(POSITION)


def test_postures_come_back_the_same(posture: ks.Posture) -> None:
    again = pickle.loads(pickle.dumps(posture))
    assert again == posture
    assert hash(again) == hash(posture)
    np.testing.assert_array_equal(again.commands, posture.commands)
    np.testing.assert_array_equal(again.stiffness().matrix, posture.stiffness().matrix)
    assert copy.copy(posture) == copy.deepcopy(posture) == posture
    assert posture.machine.posture([0.02, -0.03, 0.0500001]) != posture
    loaded = posture.deflected_by([10, 20, 30, 0, 0, 0])
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(loaded)).tool, loaded.tool)
    wrench = np.array([10.0, 0, 0, 0, 0, 0])
    kept = posture.deflected_by(wrench)
    wrench[:] = 1e9
    np.testing.assert_array_equal(pickle.loads(pickle.dumps(kept)).tool, kept.tool)


def come_back(machine: ks.Machine, ways: list[dict[str, object]]) -> int:
    """Postures that came back from their pickle with every bit; how many there were."""
    made = 0
    for way in ways:
        try:
            posture = machine.posture(**way)
        except ks.UnansweredError:
            continue
        once = pickle.loads(pickle.dumps(posture))
        for again in (once, pickle.loads(pickle.dumps(once))):
            assert again == posture
            assert hash(again) == hash(posture)
            assert again.target.tobytes() == posture.target.tobytes()
            assert again._native.limbs == posture._native.limbs
        # Where a direction is rigid the stiffness is no number, the compliance is always one.
        compliance = posture.stiffness().compliance
        np.testing.assert_allclose(once.stiffness().compliance, compliance, rtol=0, atol=1e-12 * np.abs(compliance).max())
        made += 1
    return made


def test_pickles_of_joints_and_poses_are_equal_to_themselves() -> None:
    arm = ks.Machine.preset("heavy_6r")
    turned = arm.with_tool(ks.pose([0.1, 0.02, 0.3], ks.rotation_from_vector([0.1, -0.4, 1.2])))
    home = np.array([actuator.home for actuator in arm.actuators])
    rng = np.random.default_rng(1)
    joints = [{"joints": home + rng.uniform(-1, 1, 6)} for _ in range(100)]
    assert come_back(arm, joints) == come_back(turned, joints) == 100
    turns = [arm.home[:3, :3] @ ks.rotation_from_vector(rng.uniform(-0.3, 0.3, 3)) for _ in range(100)]
    assert come_back(arm, [{"pose": ks.pose(arm.home[:3, 3] + rng.uniform(-0.1, 0.1, 3), turn)} for turn in turns]) > 90
    for name in ("tricept_like", "prs3"):  # turn as they move
        machine = ks.Machine.preset(name)
        assert come_back(machine, [{"position": machine.home[:3, 3] + rng.uniform(-0.03, 0.03, 3)} for _ in range(30)]) > 10


@pytest.mark.parametrize("seed", range(12))
def test_pickles_of_random_arms_are_equal_to_themselves(seed: int) -> None:
    rng = np.random.default_rng(seed)
    builder = ks.MachineBuilder("arm")
    count = int(rng.integers(1, 9))
    offsets = rng.uniform(-0.3, 0.3, (count, 3))
    builder.platform("tool", offsets.sum(axis=0))
    limb = builder.limb("arm", to="tool")
    for index in range(count):
        axis = rng.normal(size=3)
        kind = "prismatic" if rng.uniform() < 0.3 else "revolute"
        limb.actuator(f"j{index}", kind, (axis / np.linalg.norm(axis)).tolist(), 1e5).rigid(offsets[index].tolist())
    ways = [{"joints": rng.uniform(-1, 1, count)} for _ in range(10)]
    assert come_back(builder.machine(), ways) == 10


def test_elbow_of_the_other_side_is_kept() -> None:
    arm = ks.Machine.preset("heavy_6r")
    home = arm.posture()
    again = pickle.loads(pickle.dumps(home))
    np.testing.assert_array_equal(again.commands, home.commands)


def test_pitchfork_of_the_z_chain() -> None:
    found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    (point,) = found.special
    assert point.kind is PointKind.PITCHFORK
    # Reference values of the theory: Delta and F of the Z chain, L = 1 m, K = 1 N m/rad.
    assert point.displacement == pytest.approx(-0.110931613194, abs=1e-9)
    assert point.force == pytest.approx(-1.03347699957, abs=1e-9)
    own = found.branches[0]
    assert own.wrench.shape == (len(own.force), 6)
    np.testing.assert_allclose(own.wrench[:, 0], own.force, atol=1e-12)
    before = own.displacement > point.displacement + 1e-6
    assert own.stable_when_moved[before].all()
    assert not own.stable_when_moved[own.displacement < point.displacement - 1e-6].any()
    # The slope is the derivative of the force.
    order = np.argsort(own.displacement)
    x, y, slope = own.displacement[order], own.force[order], own.slope[order]
    middle = 0.5 * (slope[1:] + slope[:-1])
    np.testing.assert_allclose(np.diff(y), middle * np.diff(x), atol=2e-3)


def test_a_force_on_a_node_is_an_array_or_words() -> None:
    posture = ks.Machine.preset("three_link_z").posture()
    question = {"direction": [1, 0, 0], "displacement": (0, -0.05)}
    found = posture.curve(**question, loads={"first joint": np.array([0, 0.01, 0])})
    said = posture.curve(**question, loads=["first joint=0,0.01,0"])
    np.testing.assert_array_equal(found.branches[0].force, said.branches[0].force)
    assert len(found.branches[0].force) > 2
    # Two bars of a small angle to the line of the tool: a force across presses them apart.
    assert np.abs(found.branches[0].wrench[:, 1]).min() > 1e-3
    with pytest.raises(ks.ArgumentError, match=r"first joint.*3"):
        posture.curve(**question, loads={"first joint": [0, 0.01]})


def test_critical_load_of_the_z_chain() -> None:
    found = critical_load(ks.Machine.preset("three_link_z").posture(), [-1, 0, 0], most=3)
    (shape,) = [c for c in found.critical_loads if c.judged is Judged.SHAPE]
    assert shape.factor == pytest.approx(1.03347699957, abs=1e-8)


def test_two_shapes_of_the_z_chain() -> None:
    found = ks.Machine.preset("three_link_z").posture().shapes(displaced=[-1e-3, 0, 0])
    assert found.settled
    assert found.stable.tolist() == [True, False]
    assert np.all(np.diff(found.energy) > 0)
    np.testing.assert_allclose(found.position[:, 0], 2.9093129111764097 - 1e-3, atol=1e-12)


def test_assembly_locks_in_what_has_no_resultant(posture: ks.Posture) -> None:
    found = ks.Machine.preset("orthoglide").posture().assembly(deviations=["leg x:foot arm:1deg about x"])
    assert found.over_constraint == 3
    assert np.abs(found.wrench).max() > 1e-3
    # Legs hold each other: forces and moments about the platform's point cancel.
    np.testing.assert_allclose(found.wrench[:, :3].sum(axis=0), 0, atol=1e-6)


def test_problem_and_scipy(posture: ks.Posture) -> None:
    optimize = pytest.importorskip("scipy.optimize", reason="compares with a solver of SciPy")
    wrench = np.array([300.0, -200.0, 150.0, 5.0, -8.0, 3.0])
    problem = posture.equilibrium_problem(wrench)
    found = optimize.root(problem.residual, problem.x0, jac=problem.jacobian, tol=1e-13)
    loaded = posture.deflected_by(wrench)
    np.testing.assert_allclose(problem.tool(found.x), loaded.tool, atol=1e-10)
    np.testing.assert_allclose(problem.residual(found.x), 0, atol=1e-6)


def test_jacobian_against_differences(posture: ks.Posture) -> None:
    problem = posture.equilibrium_problem()
    x = np.array([1e-4, -2e-4, 1e-4, 2e-2, -1e-2, 3e-2])
    step = 1e-6
    ring = np.stack([(problem.residual(x + e) - problem.residual(x - e)) / (2 * step) for e in step * np.eye(6)], axis=1)
    exact = problem.jacobian(x)
    np.testing.assert_allclose(ring, exact, rtol=2e-5, atol=1e-6 * np.abs(exact).max())


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
def test_a_spring_on_the_tool_is_in_series() -> None:
    machine = ks.Machine.preset("orthoglide")
    places = np.array([[0.0, 0.0, 0.0], POSITION, [-0.04, 0.05, 0.01]])
    stiffness = 5e5  # N/m
    anchor = np.array([0.1, 0.2, -0.1])

    def spring(poses: np.ndarray) -> np.ndarray:
        return ks.wrench(stiffness * (anchor - poses[:, :3, 3]))

    def tangent(poses: np.ndarray) -> np.ndarray:
        return np.broadcast_to(np.diag([-stiffness] * 3 + [0] * 3), (len(poses), 6, 6))

    found = ks.equilibrium_under(machine, spring, poses=places, tangent=tangent)
    assert found.converged.all()
    reached = found.equilibria.tool
    np.testing.assert_allclose(found.wrench[:, :3], stiffness * (anchor - reached[:, :3, 3]), rtol=1e-8)
    # The machine alone under that wrench goes there.
    for i, place in enumerate(places):
        alone = machine.posture(place).deflected_by(found.wrench[i])
        np.testing.assert_allclose(alone.tool, reached[i], atol=1e-10)
    by_differences = ks.equilibrium_under(machine, spring, poses=places)
    np.testing.assert_allclose(by_differences.wrench, found.wrench, rtol=1e-7, atol=1e-6)
    np.testing.assert_allclose(found.tangent - found.equilibria.stiffness, -tangent(places), atol=1e-6)
    single = machine.posture(POSITION).under(spring)
    assert bool(single.converged)
    np.testing.assert_allclose(single.wrench, found.wrench[1], rtol=1e-7, atol=1e-6)


def test_stability_is_that_of_machine_and_model_together() -> None:
    machine = ks.Machine.preset("orthoglide")
    place = np.array([0.01, 0.0, 0.0])
    # A magnet at the commanded place: stable until it is as strong as the softest direction of the machine, the tool free to turn.
    limit = machine.posture(place).stiffness().against_force
    for share, stable in ((-3.0, True), (0.5, True), (0.99, True), (1.01, False), (10.0, False)):
        found = ks.equilibrium_under(machine, lambda p, k=share * limit: ks.wrench(k * (p[:, :3, 3] - place)), poses=place[None])
        assert found.converged[0]
        assert found.equilibria.stable[0]
        assert bool(found.stable[0]) is stable, share
        eigenvalues = np.linalg.eigvalsh((found.tangent[0] + found.tangent[0].T) / 2)
        assert bool(eigenvalues[0] > 0) is stable
    # What is free alone is held by a spring; what a dead wrench bends is as stable as the machine.
    free = ks.Machine.preset("stewart_gough_a").posture()
    assert not free.under(lambda p: np.zeros(6)).stable
    held = free.under(lambda p: np.concatenate([-1e5 * (p[:, :3, 3] - free.target[:3, 3]), -1e4 * turned(p, free.target)], axis=1))
    assert held.converged
    assert held.stable
    # Directions in which a machine is rigid are not free.
    builder = ks.MachineBuilder("one drive")
    builder.platform("tool", [0, 0, 0.5])
    builder.limb("arm", to="tool").actuator("drive", "revolute", "y", 1e5).rigid([0, 0, 0.5])
    pendulum = builder.machine().posture()
    for stiffness, stable in ((1e5, True), (1e6, False)):  # 1e5 N m/rad at 0.5 m: 4e5 N/m
        found = pendulum.under(lambda p, k=stiffness: ks.wrench(k * p[:, :3, 3] * [1, 1, 0]))
        assert found.converged
        assert bool(found.stable) is stable
    # No answer is not stable.
    assert not ks.equilibrium_under(machine, lambda poses: np.zeros(6), poses=[[9, 0, 0]]).stable[0]


def turned(poses: np.ndarray, home: np.ndarray) -> np.ndarray:
    """Small rotation vectors from home."""
    turn = poses[:, :3, :3] @ home[:3, :3].T
    return np.stack([turn[:, 2, 1] - turn[:, 1, 2], turn[:, 0, 2] - turn[:, 2, 0], turn[:, 1, 0] - turn[:, 0, 1]], axis=-1) / 2


def test_force_models_say_what_is_wrong() -> None:
    machine = ks.Machine.preset("orthoglide")
    with pytest.raises(ks.ArgumentError, match=r"shape \(2,\), expected \(1, 6\)"):
        ks.equilibrium_under(machine, lambda poses: np.zeros(2), poses=[[0, 0, 0]])
    with pytest.raises(ks.ArgumentError, match="not finite"):
        ks.equilibrium_under(machine, lambda poses: np.full(6, np.nan), poses=[[0, 0, 0]])
    far = ks.equilibrium_under(machine, lambda poses: np.zeros(6), poses=[[9, 0, 0], [0, 0, 0]])
    assert far.converged.tolist() == [False, True]
    # Moves away faster than the machine holds it: no answer is said, none is invented.
    runaway = ks.equilibrium_under(machine, lambda p: ks.wrench(1e7 * (p[:, :3, 3] - 0.001)), poses=[[0, 0, 0]], most_iterations=1)
    assert not runaway.converged[0]


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
def test_program_with_a_field_of_python() -> None:
    program = "G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100\nM2\n"

    def bow(positions: np.ndarray, directions: np.ndarray) -> np.ndarray:
        out = np.zeros_like(positions)
        out[:, 2] = 0.05 * positions[:, 0] ** 2 / 0.1
        return out

    found = ks.correct_program(program, bow)
    assert 0 < found.error_after <= found.allowed < 1e-5
    assert found.error_before == pytest.approx(5e-3, rel=1e-6)
    assert found.pieces > 5

    def fails(positions: np.ndarray, directions: np.ndarray) -> np.ndarray:
        raise KeyError("own")

    with pytest.raises(KeyError, match="own"):
        ks.correct_program(program, fails)
    with pytest.raises(ks.ArgumentError, match="shape"):
        ks.correct_program(program, lambda positions, directions: np.zeros(2))


def test_what_notebooks_show(posture: ks.Posture) -> None:
    shown = posture.machine._repr_html_()
    assert "<svg" in shown
    assert "leg x.slider" in shown
    assert "N/m" in posture.stiffness()._repr_html_()
    stands = posture.machine.posture([0.02, 0, 0.03])._repr_html_()
    assert "<svg" in stands
    assert "tool at 20, 0, 30 mm" in stands
    # Where it cannot be drawn it is said why.
    outside = posture.machine.posture([0.25, 0, 0])._repr_html_()
    assert "leg x.slider is outside its limits" in outside
    assert "workspace" in outside
    # Rounding of sums is not shown as stiffness about a free axis.
    free = ks.Machine.preset("stewart_gough_a").posture().stiffness()
    assert np.abs(free.matrix[5]).max() < 1e-9
    assert "<td>mz</td>" + 6 * "<td>0</td>" in free._repr_html_()
    assert "stable" in posture.deflected_by([1, 0, 0, 0, 0, 0])._repr_html_()


def test_picture_of_a_curve() -> None:
    matplotlib = pytest.importorskip("matplotlib", reason="draws with matplotlib")
    matplotlib.use("agg")
    found = ks.Machine.preset("three_link_z").posture().curve(direction=[1, 0, 0], displacement=(0, -0.2))
    axes = found.plot()
    assert axes.get_xlabel() == "displacement, mm"
    dashed = [line for line in axes.get_lines() if line.get_linestyle() == "--"]
    assert np.isfinite(dashed[0].get_xdata()).any()  # the unstable part of the straight branch
    matplotlib.pyplot.close(axes.figure)


def test_urdf_from_an_object_that_writes_it() -> None:
    class Robot:
        def write_xml_string(self) -> bytes:
            return (
                b'<robot name="r"><link name="a"/><link name="b"/><joint name="j" type="revolute"><parent link="a"/><child link="b"/>'
                b'<axis xyz="0 0 1"/><limit lower="-1" upper="1" effort="0" velocity="1"/></joint><link name="t"/>'
                b'<joint name="e" type="fixed"><origin xyz="2 0 0"/><parent link="b"/><child link="t"/></joint></robot>'
            )

    machine = ks.Machine.from_urdf(Robot(), tip="t", stiffness=1e5)
    compliance = machine.posture().stiffness().compliance
    assert compliance[1, 1] == pytest.approx(2.0**2 / 1e5, rel=1e-9)


def test_what_is_rigid_is_nan_one_by_one_in_batches_and_loaded() -> None:
    machine = ks.Machine.preset("kuka_kr270_like")
    joints = np.deg2rad([0.0, -95.0, 105.0, 0.0, 0.0, 0.0])  # the wrist is stretched
    posture = machine.posture(joints=joints)
    moving, locked = [0, 2, 4], [1, 3, 5]
    loaded = posture.deflected_by([100, 0, 0, 0, 0, 0])
    for matrix, compliance in ((posture.stiffness().matrix, posture.stiffness().compliance), (loaded.stiffness, loaded.compliance)):
        assert np.isnan(matrix[locked]).all()
        assert np.isnan(matrix[:, locked]).all()
        # Axes 2, 3 and 5 turn about y, the others across it.
        of_moving = np.linalg.inv(compliance[np.ix_(moving, moving)])
        np.testing.assert_allclose(matrix[np.ix_(moving, moving)], of_moving, rtol=2e-3, atol=1e-3 * np.abs(of_moving).max())
        assert compliance[4, 4] == pytest.approx(1 / 3.31e6 + 1 / 2.46e6 + 1 / 3.03e5, rel=1e-3)
    many = machine.stiffness(joints=[joints, joints]).matrix
    np.testing.assert_array_equal(np.isnan(many[1]), np.isnan(posture.stiffness().matrix))
    found = machine.equilibrium(joints=[joints, joints], wrenches=[[100, 0, 0, 0, 0, 0]] * 2, details="stiffness")
    assert found.stiffness is not None
    np.testing.assert_array_equal(np.isnan(found.stiffness[0]), np.isnan(loaded.stiffness))


def test_limbs_add_up_to_the_stiffness_of_the_tool(posture: ks.Posture) -> None:
    loaded = posture.deflected_by([100, -50, 20, 0, 0, 0])
    total = np.zeros((6, 6))
    for limb in loaded.limbs:
        assert limb.passive.shape == (len(limb.passive_joints), 6)
        assert limb.springs.shape == (len(limb.spring_names), 6)
        assert np.isfinite(limb.passive).all()
        assert np.isfinite(limb.springs).all()
        total += limb.to_end.T @ limb.matrix @ limb.to_end
        total[3:, 3:] += limb.lever
    np.testing.assert_allclose(total, loaded.stiffness, rtol=1e-7, atol=1e-7 * np.abs(loaded.stiffness).max())
