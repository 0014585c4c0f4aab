"""Machines from the builder against closed forms, and against the same machine from its file."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks
from kinetostat.build import MachineBuilder


def two_link(k1: float, k2: float, a: float, b: float, q: tuple[float, float]) -> ks.Machine:
    builder = MachineBuilder("two links")
    reach = [a * np.cos(q[0]) + b * np.cos(sum(q)), a * np.sin(q[0]) + b * np.sin(sum(q)), 0]
    turn = ks.rotation_from_vector([0, 0, sum(q)])
    builder.platform("tool", ks.pose(reach, turn))
    arm = builder.limb("arm", to="tool")
    arm.actuator("shoulder", "revolute", "z", k1, home=q[0], limits=(-3, 3), rating=900).rigid([a, 0, 0])
    arm.actuator("elbow", "revolute", "z", k2, home=q[1]).rigid([b, 0, 0])
    return builder.machine()


def test_two_link_arm_closed_form() -> None:
    k1, k2, a, b, q = 2e5, 1e5, 0.7, 0.5, (0.4, 0.9)
    machine = two_link(k1, k2, a, b, q)
    assert machine.actuators[0].limits == (-3, 3)
    assert machine.actuators[0].rating == 900
    s1, c1, s12, c12 = np.sin(q[0]), np.cos(q[0]), np.sin(sum(q)), np.cos(sum(q))
    jacobian = np.array([[-a * s1 - b * s12, -b * s12], [a * c1 + b * c12, b * c12]])
    compliance = jacobian @ np.diag([1 / k1, 1 / k2]) @ jacobian.T
    found = machine.posture().stiffness()
    assert found.rank == 6  # four directions are rigid
    np.testing.assert_allclose(found.compliance[:2, :2], compliance, rtol=1e-9)


def test_springs_in_series() -> None:
    builder = MachineBuilder("springs")
    builder.platform("tool", [0.3, 0, 0])
    stiff = np.array([3e6, 4e6, 5e6, 1e4, 2e4, 3e4])
    builder.limb("x", to="tool").actuator("x", "prismatic", "x", 1e6).spring("give", "prismatic", "x", 2e6).spring6("foot", stiff).rigid(
        [0.3, 0, 0]
    )
    found = builder.machine().posture().stiffness()
    assert found.compliance[0, 0] == pytest.approx(1 / 1e6 + 1 / 2e6 + 1 / 3e6, rel=1e-12)
    assert found.compliance[1, 1] == pytest.approx(1 / 4e6 + 0.3**2 / 3e4, rel=1e-12)


def test_cantilever_and_weight() -> None:
    builder = MachineBuilder("boom", gravity=[0, 0, -9.81])
    builder.platform("tool", [1, 0, 0], mass=10)
    builder.section("bar", round={"diameter_m": 0.06}, youngs_modulus_gpa=210, poissons_ratio=0.3)
    builder.limb("arm", to="tool").actuator("turn", "revolute", "x", None).link("bar", "bar", 1.0)
    machine = builder.machine()
    bending = 210e9 * np.pi * 0.06**4 / 64
    assert machine.posture().stiffness().compliance[2, 2] == pytest.approx(1 / (3 * bending), rel=1e-3)
    sag = machine.posture().deflected_by(np.zeros(6)).displacement[2]
    assert sag == pytest.approx(-98.1 / (3 * bending), rel=1e-3)


def test_saved_and_read_again(tmp_path: Path) -> None:
    machine = two_link(1e5, 2e5, 0.6, 0.4, (0.2, 0.5))
    path = tmp_path / "arm.toml"
    machine.save(path)
    again = ks.Machine.open(path)
    assert again == machine
    assert hash(again) == hash(machine)


def test_mistakes_are_those_of_the_file() -> None:
    builder = MachineBuilder("wrong")
    builder.platform("tool", [0, 0, 0])
    builder.limb("arm", to="nowhere").actuator("x", "prismatic", "x", 1e6)
    with pytest.raises(ks.ModelError, match="nowhere"):
        builder.machine()
    with pytest.raises(ks.ArgumentError, match=r"shape \(2,\), expected \(3,\)"):
        builder.limb("other", to="tool").spring("s", "prismatic", [1, 0], 1.0)
    with pytest.raises(ks.ArgumentError, match="already"):
        builder.limb("arm", to="tool")
