"""Vibrations and chatter: reference values (theory of dynamics, D3 and D5), random arms against numpy, invariants, refusals."""

from __future__ import annotations

import pickle
from pathlib import Path

import numpy as np
import pytest
from numpy_robots import hat, turn

import kinetostat as ks
from kinetostat import chatter
from kinetostat.vibration import Damping

ARM6 = Path(__file__).resolve().parents[2] / "crates/kinetostat-cli/tests/cli/vibration_models/arm6.toml"
GRAVITY = np.array([0.0, 0.0, -9.81])


@pytest.fixture(scope="module")
def arm() -> ks.Posture:
    return ks.Machine.open(ARM6).posture()


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
@pytest.mark.parametrize(
    ("force", "expected"),
    [
        ((0, 0, 0), [9.98746752, 11.5425353, 23.2012812, 49.0179614, 53.7168096, 126.52171]),
        ((0, 0, -9000), [10.0068189, 11.523062, 23.1889537, 49.2481057, 53.8574826, 126.550804]),
    ],
)
def test_frequencies_of_the_reference_arm(arm, force, expected):
    found = arm.vibration([*force, 0, 0, 0])
    np.testing.assert_allclose(found.frequencies_hz, expected, rtol=1e-8)
    assert found.stable
    assert not found.circulatory
    assert found.mass == 835.0
    assert set(found.kinds) == {ks.ModeKind.VIBRATION}
    assert found.counts.vibrating == 6


def test_receptance_of_the_reference_arm(arm):
    found = arm.vibration().response([0.0, 10.0, 25.0], 0.03)[:, :3, :3]
    still = [[7.75385244e-7, -2.33069765e-7, 8.29027517e-8], [-2.33069765e-7, 1.37678996e-6, 7.84729328e-8]]
    np.testing.assert_allclose(found[0, :2].real, still, rtol=1e-8)
    np.testing.assert_allclose(found[1, 2, 2], -5.89851087e-07 - 1.65719600e-05j, rtol=1e-7)
    np.testing.assert_allclose(found[2, 0, 2], -9.40831692e-07 - 3.17931684e-07j, rtol=1e-7)


def test_both_ways_to_a_response_agree_and_it_is_reciprocal(arm):
    vibration = arm.vibration([200, -300, 100, 0, 0, 0])
    hz = np.linspace(1, 200, 17)
    for damping in (Damping.ratio([0.03, 0.01]), Damping.rayleigh(2.0, 1e-4), Damping.viscous(q1=900.0, q3=400.0)):
        # By modes only what is diagonal in them: dampers, and K without the loads' part, are not.
        if "ratio" not in repr(damping):
            direct = vibration.response(hz, damping, direct=True)
            assert np.abs(direct - direct.swapaxes(1, 2)).max() <= 1e-9 * np.abs(direct).max()
            continue
        summed, direct = vibration.response(hz, damping), vibration.response(hz, damping, direct=True)
        assert np.abs(summed - direct).max() <= 1e-9 * np.abs(direct).max()
    fast = vibration.response(hz, 0.03, quantity="acceleration")
    w = 2 * np.pi * hz[:, None, None]
    np.testing.assert_allclose(fast, -(w**2) * vibration.response(hz, 0.03), rtol=1e-12, atol=0)


def test_modes_are_normalised_and_shares_add_to_one(arm):
    found = arm.vibration()
    m, k = found.mass_matrix, found.tangent
    np.testing.assert_allclose(found.shapes @ m @ found.shapes.T, np.eye(6), atol=1e-12)
    squared = np.sign(found.frequencies_hz) * (2 * np.pi * found.frequencies_hz) ** 2
    np.testing.assert_allclose(found.shapes @ k @ found.shapes.T, np.diag(squared), atol=1e-9 * squared.max())
    for mode in range(6):
        shares = found.shares(mode)
        for own in (shares.kinetic, shares.elastic):
            assert abs(sum(own.values()) - 1) < 1e-12
            assert min(own.values()) > -1e-12


def random_arm(seed):
    """An arm of revolute joints with a body behind each, as a machine and as numbers."""
    rng = np.random.default_rng(seed)
    count = int(rng.integers(2, 7))
    parts, at = [], np.eye(4)
    for _ in range(count):
        move = ks.pose(rng.uniform(-0.6, 0.6, 3), ks.rotation_from_vector(rng.uniform(-1, 1, 3)))
        cloud = rng.uniform(-0.3, 0.3, (7, 3))
        inertia = 10 * sum(r @ r * np.eye(3) - np.outer(r, r) for r in cloud - cloud.mean(axis=0))
        stiffness, mass, centre = rng.uniform(1e4, 1e6), rng.uniform(5, 80), rng.uniform(-0.2, 0.2, 3)
        parts.append((move, np.eye(3)[rng.integers(3)], float(stiffness), float(mass), centre, inertia))
        at = at @ move
    builder = ks.MachineBuilder(f"random_{seed}", gravity=[0.0, 0.0, 0.0])
    builder.platform("tool", at)
    limb = builder.limb("arm", to="tool")
    for i, (move, axis, stiffness, mass, centre, inertia) in enumerate(parts):
        limb.rigid(move).actuator(f"joint_{i}", "revolute", "xyz"[int(np.argmax(axis))], stiffness=stiffness)
        limb.body(f"body_{i}", mass, centre, inertia=inertia)
    return builder.machine(), parts


@pytest.mark.parametrize("seed", range(10))
def test_mass_matrices_and_frequencies_of_random_arms(seed):
    machine, parts = random_arm(seed)
    found = machine.posture(joints=np.zeros(len(parts))).vibration()
    at, columns = np.eye(4), []
    mass = np.zeros((len(parts), len(parts)))
    for i, (move, axis, _, m, centre, inertia) in enumerate(parts):
        at = at @ move
        columns.append((at[:3, :3] @ axis, at[:3, 3]))
        r, place = at[:3, :3], at[:3, :3] @ centre + at[:3, 3]
        linear, turning = np.zeros((3, len(parts))), np.zeros((3, len(parts)))
        for j in range(i + 1):
            turning[:, j] = columns[j][0]
            linear[:, j] = hat(columns[j][0]) @ (place - columns[j][1])
        mass += m * linear.T @ linear + turning.T @ r @ inertia @ r.T @ turning
    stiffness = np.diag([part[2] for part in parts])
    np.testing.assert_allclose(found.mass_matrix, mass, rtol=1e-9, atol=1e-9 * np.abs(mass).max())
    squared = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiffness)).real)
    np.testing.assert_allclose(found.frequencies_hz, np.sqrt(squared) / (2 * np.pi), rtol=1e-9)


def test_a_dead_moment_has_no_potential(arm):
    pushed = arm.vibration([0, 0, 0, 50, 0, 0])
    assert pushed.circulatory
    with pytest.raises(ks.ArgumentError, match="no potential"):
        pushed.response([10.0], 0.03)
    still = pushed.response([0.0], Damping.none(), direct=True)[0].real
    np.testing.assert_allclose(still, pushed.equilibrium.compliance, rtol=1e-8, atol=1e-13)


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
def test_complex_modes_are_those_of_numpy_and_flutter_is_no_stable_state(arm):
    assert arm.vibration([300, 0, 0, 0, 0, 0]).complex_modes() is None
    verdicts = set()
    for size in (800, 200_000, 2_000_000):
        try:
            pushed = arm.vibration([0, 0, 0, size, -0.6 * size, 0.8 * size])
        except ks.Error:
            continue  # no equilibrium under such a moment
        found = pushed.complex_modes()
        squares = np.linalg.eigvals(np.linalg.solve(pushed.mass_matrix, pushed.tangent)).astype(complex)
        own = -(found.eigenvalues**2)
        for square in own:
            assert np.abs(squares - square).min() < 1e-8 * np.abs(squares).max()
        np.testing.assert_allclose(found.complexity, (np.abs(squares.imag) / np.abs(squares)).max(), atol=1e-9)
        grows = np.sqrt(-squares).real.max() > 1e-6 * np.sqrt(np.abs(squares)).max()
        assert (found.verdict in ("flutter", "divergence")) == grows == (not pushed.stable)
        assert found.coarse_links == ()
        verdicts.add(found.verdict)
        damped = pushed.complex_modes(0.03)
        if found.verdict == "stable":
            np.testing.assert_allclose(-damped.eigenvalues.real / np.abs(damped.eigenvalues), 0.03, rtol=0.1)
    assert "stable" in verdicts
    assert "flutter" in verdicts or "divergence" in verdicts, verdicts


@pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")
def test_a_reduction_keeps_what_its_basis_holds_and_its_bounds_hold():
    posture = ks.Machine.preset("heavy_6r").posture()
    whole = posture.vibration([300, -200, -500, 0, 0, 0])
    last = np.inf
    for kept in (0, 4, 10):
        reduced = whole.reduced(kept)
        assert reduced.mass.shape == reduced.stiffness.shape == (6 + kept, 6 + kept)
        for own, of_whole in ((reduced.mass, whole.mass_matrix), (reduced.stiffness, whole.tangent)):
            expected = reduced.basis.T @ of_whole @ reduced.basis
            assert np.abs(own - expected).max() <= 1e-9 * np.abs(expected).max()
        np.testing.assert_allclose(reduced.stiffness[:6, :6], np.linalg.inv(whole.equilibrium.compliance), rtol=1e-6, atol=1e-3)
        squares = np.sort(np.linalg.eigvals(np.linalg.solve(reduced.mass, reduced.stiffness)).real)
        np.testing.assert_allclose(np.sqrt(squares) / (2 * np.pi), reduced.frequencies_hz, rtol=1e-7)
        exact = whole.frequencies_hz
        for k, (hz, bound) in enumerate(zip(reduced.frequencies_hz, reduced.relative_bounds, strict=True)):
            assert hz >= exact[k] * (1 - 1e-10)
            assert np.abs(exact / hz - 1).min() <= bound + 1e-10
        assert reduced.frequencies_hz[0] <= last
        last = reduced.frequencies_hz[0] * (1 + 1e-12)
        assert reduced.kept_hz.shape == (kept,)
        assert reduced.left_out_hz > reduced.kept_hz.max(initial=0)
    with pytest.raises(ks.ArgumentError):
        posture.vibration([0, 0, 0, 900, 0, 0]).reduced(3)


def test_a_held_tool_and_pickles(arm):
    held = arm.vibration(held=["x", "y", "z"])
    assert held.counts.vibrating == 3
    assert held.frequencies_hz[0] > arm.vibration().frequencies_hz[0]
    again = pickle.loads(pickle.dumps(held))
    assert again.held == ("x", "y", "z")
    np.testing.assert_array_equal(again.frequencies_hz, held.frequencies_hz)


@pytest.mark.parametrize(
    ("question", "said"),
    [
        (lambda arm: arm.vibration(held=["up"]), "held.0. is .up., expected"),
        (lambda arm: arm.vibration(held="xyz"), "held is"),
        (lambda arm: arm.vibration([1, 2, 3]), r"\(3,\), expected \(6,\)"),
        (lambda arm: arm.vibration().response([1.0], 1.5), "critical damping is 1"),
        (lambda arm: arm.vibration().response([1.0], -0.1), "not below zero"),
        (lambda arm: arm.vibration().response([np.nan], 0.03), "finite"),
        (lambda arm: arm.vibration().response([[1.0]], 0.03), r"\(1, 1\), expected \(f,\)"),
        (lambda arm: arm.vibration().response([1.0], 0.03, at="nowhere"), "nowhere"),
        (lambda arm: arm.vibration().response([1.0], 0.03, quantity="jerk"), "jerk"),
        (lambda arm: arm.vibration().response([1.0], 0.03, modes=2, direct=True), "exclude"),
        (lambda arm: arm.vibration().shares(6), "mode 6 of 6"),
        (lambda arm: ks.Machine.preset("orthoglide").posture().vibration(), "no mass anywhere"),
    ],
)
def test_what_makes_no_sense_is_refused(arm, question, said):
    with pytest.raises(ks.ArgumentError, match=said):
        question(arm)


# Chatter ------------------------------------------------------------------------------------------------------------

ONE_MODE = {"stiffness": [0.03993 * (2 * np.pi * 922) ** 2], "frequencies_hz": [922], "damping_ratios": [0.011]}


@pytest.mark.parametrize(
    ("immersion", "up", "expected", "zeroth"),
    [
        (1.0, True, [0.408628, 3.009212, 0.401360], [0.369919, 2.129513, 0.356293]),
        (0.5, True, [0.260279, 1.601949, 0.251865], [0.254252, 1.463653, 0.244887]),
        (0.5, False, [0.847204, 1.564793, 1.447859], [0.921829, 1.599953, 2.794410]),
    ],
)
def test_lobes_of_the_reference_values(immersion, up, expected, zeroth):
    tip = chatter.tool_modes([[1, 0, 0]], **ONE_MODE)
    cut = chatter.MillingCut(2, immersion, up, (6e8, 2e8, 0.0))
    found = chatter.lobes(tip, cut, [5000, 9000, 17000], up_to=10e-3)
    np.testing.assert_allclose(found.limit * 1e3, expected, rtol=1e-4)
    np.testing.assert_allclose(found.zeroth_order * 1e3, zeroth, rtol=3e-6)
    assert all(stable[0] == (0.0, limit) for stable, limit in zip(found.stable, found.limit, strict=True))


def test_multipliers_of_the_reference_values():
    tip = chatter.tool_modes([[1, 0, 0]], **ONE_MODE)
    slot = chatter.MillingCut(2, 1.0, True, (6e8, 2e8, 0.0))
    found = chatter.multipliers(tip, slot, 5000.0, [0.2e-3, 0.5e-3, 1e-3], threads=1)
    np.testing.assert_allclose(found, [0.81974278, 1.07397559, 1.40647353], rtol=1e-6)


def test_an_arm_chatters_as_its_own_modes_do(arm):
    tip = arm.vibration().tool_modes(0.03)
    cut = chatter.MillingCut(2, 0.5, True, (8e8, 2.4e8, 0.0))
    found = chatter.lobes(tip, cut, np.linspace(2000, 4000, 5), up_to=5e-3)
    below, above = (chatter.multipliers(tip, cut, found.speeds_rpm, found.limit * k) for k in (0.999, 1.001))
    assert np.all(below < 1)
    assert np.all(above > 1)
    # Turned about the tool's axis together: the same limits.
    r = turn(np.array([0.0, 0.0, 1.0]), 0.7)
    turned = ks.vibration.ToolModes(tip.shapes @ r.T, tip.squared, tip.damping_ratios, r @ tip.residual @ r.T)
    fed = chatter.MillingCut(2, 0.5, True, (8e8, 2.4e8, 0.0), feed=tuple(r[:, 0]))
    again = chatter.lobes(turned, fed, found.speeds_rpm, up_to=5e-3)
    np.testing.assert_allclose(again.limit, found.limit, rtol=1e-6)


def test_dampers_that_couple_modes_are_in_the_lobes(arm):
    vibration = arm.vibration()
    damping = Damping.viscous(q1=900.0, q2=900.0, q3=400.0, q4=60.0, q5=60.0, q6=20.0)
    tip = vibration.tool_modes(damping)
    h, n = len(tip.held), len(tip.shapes) + len(tip.held)
    assert tip.rates.shape == (n, n)
    np.testing.assert_allclose(np.diag(tip.rates)[: n - h], 2 * tip.damping_ratios * np.sqrt(tip.squared), rtol=1e-6)
    # Put together here, the modal data are the direct response.
    hz = np.array([5.0, 17.0, 40.0, 90.0])
    direct = vibration.response(hz, damping, direct=True)[:, :3, :3]
    points, stiff = np.vstack([tip.shapes, tip.held]), np.concatenate([tip.squared, np.ones(h)])
    mass = np.concatenate([np.ones(n - h), np.zeros(h)])
    for f, wanted in zip(hz, direct, strict=True):
        w = 2 * np.pi * f
        dynamic = np.diag(stiff - w * w * mass) + 1j * w * tip.rates
        found = points.T @ np.linalg.solve(dynamic, points) + tip.residual - tip.held.T @ tip.held
        assert np.abs(found - wanted).max() <= 1e-7 * np.abs(wanted).max()
    cut = chatter.MillingCut(2, 0.5, True, (8e8, 2.4e8, 0.0))
    alone = ks.vibration.ToolModes(tip.shapes, tip.squared, tip.damping_ratios, tip.residual)
    with_all, without = (chatter.lobes(t, cut, [2000.0, 3000.0], up_to=20e-3).limit for t in (tip, alone))
    assert np.all(np.isfinite(with_all))
    assert np.abs(with_all / without - 1).max() > 1e-3


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"teeth": 0}, "teeth"),
        ({"immersion": 1.5}, "immersion"),
        ({"coefficients": (-1.0, 0.0, 0.0)}, "coefficient"),
        ({"feed": (0.0, 0.0, 1.0)}, "feed"),
    ],
)
def test_cuts_that_make_no_sense_are_refused(change, said):
    tip = chatter.tool_modes([[1, 0, 0]], **ONE_MODE)
    given = {"teeth": 2, "immersion": 0.5, "up": True, "coefficients": (8e8, 2.4e8, 0.0)}
    with pytest.raises(ks.ArgumentError, match=said):
        chatter.lobes(tip, chatter.MillingCut(**{**given, **change}), [5000.0], up_to=1e-3)
    with pytest.raises(ks.ArgumentError, match="speed"):
        chatter.lobes(tip, chatter.MillingCut(**given), [-5000.0], up_to=1e-3)
    with pytest.raises(ks.ArgumentError, match=r"stiffness has shape \(2,\), expected \(1,\)"):
        chatter.tool_modes([[1, 0, 0]], **{**ONE_MODE, "stiffness": [1e6, 1e6]})


def test_modes_that_feed_each_other_are_those_of_numpy():
    # The smallest process at which a root of M s^2 + C s + K + Kc f n^T crosses the axis, by bisection over numpy's roots.
    hz, stiff, ratio = np.array([22.508, 26.631]), np.array([1e6, 1.4e6]), 0.02
    w = 2 * np.pi * hz
    tip = chatter.tool_modes([[1, 0, 0], [0, 1, 0]], stiffness=stiff, frequencies_hz=hz, damping_ratios=[ratio, ratio])
    n, f = np.array([1.0, 1.0]) / np.sqrt(2), np.array([1.0, -1.0]) / np.sqrt(2)
    mass, damping = np.diag(stiff / w**2), np.diag(2 * ratio * stiff / w)

    def grows(factor):
        k = np.diag(stiff) + factor * np.outer(f, n)
        a = np.block([[np.zeros((2, 2)), np.eye(2)], [-np.linalg.solve(mass, k), -np.linalg.solve(mass, damping)]])
        return np.linalg.eigvals(a).real.max() > 0

    low, high = 1e4, 1e6
    assert not grows(low)
    assert grows(high)
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if grows(middle) else (middle, high)
    found = chatter.coupled_limit(tip, chip=[1, 1, 0], force=[1, -1, 0])
    assert found.flutters
    np.testing.assert_allclose(found.factor, low, rtol=1e-8)
    assert hz[0] < found.frequency_hz < hz[1]
    assert chatter.coupled_limit(tip, chip=[1, 0, 0], force=[1, 0, 0]) is None
    pulled = chatter.coupled_limit(tip, chip=[1, 0, 0], force=[-1, 0, 0])
    assert not pulled.flutters
    np.testing.assert_allclose([pulled.factor, pulled.frequency_hz], [1e6, 0], rtol=1e-9, atol=1e-12)
    with pytest.raises(ks.ArgumentError, match="chip"):
        chatter.coupled_limit(tip, chip=[0, 0, 0], force=[1, 0, 0])
