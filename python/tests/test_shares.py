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


def test_wrong_words_are_refused() -> None:
    machine = ks.Machine.preset("orthoglide")
    with pytest.raises(ks.ArgumentError, match="direction"):
        of.shares(machine, direction="up")  # type: ignore[arg-type]
    with pytest.raises(ks.ArgumentError, match="position"):
        of.shares(machine, [0.0, 0.0])
    with pytest.raises(ks.UnansweredError, match="nothing"):
        of.shares(ks.Machine.preset("two_link"), direction="z")
