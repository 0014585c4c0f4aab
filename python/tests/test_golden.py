"""The same reference numbers as the tests of the core."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks

# From the file's N, mm, rad to N, m, rad: translations by forces, by moments, rotations by moments.
TO_SI = np.block([[np.full((3, 3), 1e-3), np.ones((3, 3))], [np.ones((3, 3)), np.full((3, 3), 1e3)]])


def test_unloaded_compliance_of_the_orthoglide(golden):
    machine = ks.Machine.preset("orthoglide")
    points = golden("orthoglide_unloaded")["points"]
    assert points
    many = machine.stiffness(np.array([point["point"] for point in points]) * 1e-3)
    for row, point in enumerate(points):
        expected = np.array(point["computed"]["C"]) * TO_SI
        one = machine.posture(position=np.array(point["point"]) * 1e-3).stiffness()
        scale = np.sqrt(np.outer(np.diag(expected), np.diag(expected)))
        assert np.all(np.abs(one.compliance - expected) < 1e-9 * scale), point["name"]
        assert np.all(np.abs(many.compliance[row] - expected) < 1e-9 * scale), point["name"]


@pytest.mark.parametrize("case", ["A", "B"])
def test_hexapods_of_two_force_legs(golden, case):
    found = next(c for c in golden("stewart_gough")["cases"] if c["name"] == case)
    stiffness = ks.Machine.preset(f"stewart_gough_{case.lower()}").posture().stiffness()
    assert stiffness.rank == found["rank"]
    expected = np.zeros((6, 6))
    for entry, value in found["computed"].items():
        i, j = int(entry[0]) - 1, int(entry[1]) - 1
        expected[i, j] = expected[j, i] = value
    assert np.abs(stiffness.matrix - expected).max() < 1e-9 * np.abs(expected).max()


@pytest.mark.parametrize("delta", [0.05, 0.1, 0.2, 0.4])
def test_all_shapes_of_the_z_chain(golden, delta):
    # Forces on the tool that moves towards the base by delta, turns as it likes, and how stiff it is there.
    expected = sorted((c["F_x"], c["K_x"], c["stable"]) for c in golden("z_chain")["cases"] if c["delta"] == delta)
    answer = ks.commands.equilibria("three_link_z", displaced_mm=[-1e3 * delta, 0, 0], free="rz")
    found = sorted((e["force_n"][0], e["stiffness_n_m_rad"][0][0], e["stable"]) for e in answer["equilibria"])
    assert len(found) == len(expected)
    for (force, stiffness, stable), (wanted_force, wanted_stiffness, wanted_stable) in zip(found, expected, strict=True):
        assert force == pytest.approx(wanted_force, abs=2e-8)
        assert stiffness == pytest.approx(wanted_stiffness, abs=2e-6)
        assert stable is wanted_stable
