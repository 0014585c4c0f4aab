"""Shares and sensitivities against what numpy makes of the same machine."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import shares as of

PLACE = [0.021, -0.013, 0.034]


def compliance_along(machine: ks.Machine, direction: np.ndarray) -> float:
    k = machine.posture(position=PLACE).stiffness().matrix
    push = np.zeros(6)
    push[:3] = direction / np.linalg.norm(direction)
    return float(push @ np.linalg.solve(k, push))


def test_shares_add_to_one_and_to_the_compliance_of_the_matrix() -> None:
    machine = ks.Machine.preset("orthoglide")
    direction = np.array([0.3, -0.5, 0.81])
    found = of.shares(machine, PLACE, direction=direction.tolist())
    assert abs(sum(p.share for p in found.parts) - 1) < 1e-12
    assert found.compliance == pytest.approx(compliance_along(machine, direction), rel=1e-9)
    assert set(found.by_name()) >= {"leg x: slider", "leg y: slider", "leg z: slider"}


def test_a_stiffer_drive_takes_its_share_away() -> None:
    machine = ks.Machine.preset("orthoglide")
    direction = np.array([0.3, -0.5, 0.81])
    found = of.shares(machine, PLACE, direction=direction.tolist())
    share = sum(p.share for p in found.parts if p.name == "slider")
    document = machine.to_dict()
    slider = next(e for e in document["chain"]["leg"]["elements"] if e.get("name") == "slider")
    before = slider["stiffness_n_per_mm"]

    def at(flexibility: float) -> float:
        slider["stiffness_n_per_mm"] = before / flexibility
        return compliance_along(ks.Machine.from_dict(document), direction)

    derivative = (at(1.001) - at(0.999)) / 0.002 / found.compliance
    assert derivative == pytest.approx(share, abs=1e-7)


def test_derivatives_are_those_of_differences() -> None:
    machine = ks.Machine.preset("heavy_6r")
    wrench = [300.0, -200.0, -800.0, 0.0, 0.0, 0.0]
    found = {s.path: s for s in of.sensitivities(machine, direction="z", wrench=wrench)}
    path = "chain.arm.joint 2.stiffness_n_m_per_rad"
    document = machine.to_dict()
    joint = next(e for e in document["chain"]["arm"]["elements"] if e.get("name") == "joint 2")
    before = joint["stiffness_n_m_per_rad"]

    def at(factor: float) -> float:
        joint["stiffness_n_m_per_rad"] = before * factor
        return float(ks.Machine.from_dict(document).posture().deflected_by(wrench).displacement[2])

    derivative = (at(1.001) - at(0.999)) / (0.002 * before)
    assert found[path].deflection == pytest.approx(derivative, rel=1e-5)


def test_estimated_errors_are_those_of_the_derivatives() -> None:
    """Against differences of eighth order of the deflection itself: what is off is no more than estimated, and rounding."""
    machine = ks.Machine.preset("heavy_6r")
    wrench = [0.0, 0, -800, 0, 0, 0]
    document = machine.to_dict()
    found = {s.path: s for s in of.sensitivities(machine, direction="z", wrench=wrench)}
    checked = 0
    for joint in (e for e in document["chain"]["arm"]["elements"] if "stiffness_n_m_per_rad" in e):
        before = joint["stiffness_n_m_per_rad"]
        own = found.get(f"chain.arm.{joint['name']}.stiffness_n_m_per_rad")
        if own is None:
            continue

        def at(share: float, joint: dict = joint, before: float = before) -> float:
            joint["stiffness_n_m_per_rad"] = before * (1 + share)
            return float(ks.Machine.from_dict(document).posture().deflected_by(wrench).displacement[2])

        weights = {1: 4 / 5, 2: -1 / 5, 3: 4 / 105, 4: -1 / 280}
        derivative = sum(w * (at(0.02 * k) - at(-0.02 * k)) for k, w in weights.items()) / (0.02 * before)
        joint["stiffness_n_m_per_rad"] = before
        for error in (own.errors.deflection, own.errors.compliance, own.errors.stiffness):
            assert 0 <= error < np.inf
        assert abs(own.deflection - derivative) <= own.errors.deflection + 1e-7 * abs(derivative)
        checked += 1
    assert checked >= 3


def test_wrong_words_are_refused() -> None:
    machine = ks.Machine.preset("orthoglide")
    with pytest.raises(ks.ArgumentError, match="direction"):
        of.shares(machine, direction="up")  # type: ignore[arg-type]
    with pytest.raises(ks.ArgumentError, match="position"):
        of.shares(machine, [0.0, 0.0])
    with pytest.raises(ks.UnansweredError, match="nothing"):
        of.shares(ks.Machine.preset("two_link"), direction="z")


DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


@pytest.mark.parametrize("loaded", [False, True])
@pytest.mark.parametrize("name", ["orthoglide", "heavy_6r", "stewart_gough_b", "puu3"])
def test_shares_of_a_posture_add_to_one_and_to_its_compliance(name: str, loaded: bool) -> None:
    machine = ks.Machine.preset(name)
    home = machine.posture().target[:3, 3]
    posture = machine.posture(home + np.array([0.011, -0.007, 0.013]))
    wrench = np.array([70.0, -40.0, -90.0, 2.0, 1.0, -3.0])
    compliance = posture.deflected_by(wrench).compliance if loaded else posture.stiffness().compliance
    asked = 0
    for i, direction in enumerate(DIRECTIONS):
        if not compliance[i, i] > 1e-15:
            continue
        found = posture.shares(direction, wrench if loaded else None)  # type: ignore[arg-type]
        assert found.share.shape == found.part_compliance.shape == (len(found.parts),)
        assert abs(found.share.sum() - 1) < 1e-12
        assert found.compliance == pytest.approx(compliance[i, i], rel=1e-8)
        assert found.part_compliance.sum() == pytest.approx(found.compliance, rel=1e-9)
        for what in ("limb", "kind"):
            assert abs(sum(found.by(what).values()) - 1) < 1e-12  # type: ignore[arg-type]
        assert (found.geometric == 0) or loaded
        if not loaded:
            assert (found.share > -1e-15).all()
        asked += 1
    assert asked >= 3


def test_a_posture_and_its_place_have_the_same_shares() -> None:
    machine = ks.Machine.preset("heavy_6r").with_tool(length=0.15)
    posture = machine.posture()
    position = posture.target[:3, 3]
    a, b = posture.shares("x"), of.shares(machine, position, direction="x")
    assert [p.name for p in a.parts] == [p.name for p in b.parts]
    np.testing.assert_allclose(a.share, b.share, rtol=1e-9, atol=1e-15)
    assert a != posture.shares("y")


def test_the_stiffened_machine_yields_as_little_as_is_said() -> None:
    machine = ks.Machine.preset("heavy_6r")
    found = of.cheapest_stiffening(machine, 0.2, direction="z")
    assert found.possible
    document = machine.to_dict()
    changed = 0
    for element in document["chain"]["arm"]["elements"]:
        factor = found.factors.get(f"arm: {element.get('name')}")
        if factor is None:
            continue
        assert factor > 1
        element["stiffness_n_m_per_rad"] *= factor
        changed += 1
    assert changed == len(found.factors) > 0

    def along_z(one: ks.Machine) -> float:
        return float(one.posture().stiffness().compliance[2, 2])

    assert along_z(ks.Machine.from_dict(document)) / along_z(machine) == pytest.approx(0.8, rel=1e-9)
    assert found.reached == pytest.approx(0.8, rel=1e-9)
    assert found.cost == pytest.approx(sum(factor - 1 for factor in found.factors.values()), rel=1e-12)
    with pytest.raises(ks.ArgumentError, match="between 0 and 1"):
        of.cheapest_stiffening(machine, 20.0)
