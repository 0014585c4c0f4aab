"""The golden files of the Rust tests, through Python: numbers of the report and of programs written apart."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks

# N, N m/m ... of a matrix in N, mm, rad.
MM = np.diag([1e-3] * 3 + [1.0] * 3)


def stiffness_in_si(given):
    """K (N/mm, N, N mm) as K (N/m, N, N m): of u^T K u in N mm."""
    return 1e-3 * np.linalg.inv(MM) @ np.array(given) @ np.linalg.inv(MM)


def wrench_in_si(given):
    """N and N mm as N and N m."""
    return np.array(given) * [1, 1, 1, 1e-3, 1e-3, 1e-3]


def close(found, wanted, relative):
    """Entries agree to a share of the largest."""
    wanted = np.asarray(wanted, dtype=float)
    np.testing.assert_allclose(found, wanted, rtol=0, atol=relative * np.abs(wanted).max())


def test_orthoglide_unloaded(golden):
    file = golden("orthoglide_unloaded")
    machine = ks.Machine.preset("orthoglide")
    points = 1e-3 * np.array([case["point"] for case in file["points"]])
    assert len(points) >= 5
    many = machine.stiffness(points)
    assert many.solved.all()
    for i, case in enumerate(file["points"]):
        wanted = stiffness_in_si(case["computed"]["K"])
        one = machine.posture(position=points[i]).stiffness()
        # In mm and rad all entries are of like size.
        for found in (many.matrix[i], one.matrix):
            close(1e3 * MM @ found @ MM, 1e3 * MM @ wanted @ MM, 1e-11)
        compliance = np.linalg.inv(MM) @ one.compliance @ np.linalg.inv(MM) * 1e-3
        close(compliance, case["computed"]["C"], 1e-11)
        printed = case["printed"]
        np.testing.assert_allclose(np.diag(compliance)[:3] * 1e4, printed["diag"], rtol=5e-7)
        np.testing.assert_allclose(np.diag(compliance)[3:] * 1e7, printed["rot"], rtol=5e-7)


def test_orthoglide_milling(golden):
    file = golden("orthoglide_milling")
    machine = ks.Machine.preset("orthoglide")
    wrench = wrench_in_si(file["wrench"])
    points = 1e-3 * np.array([case["point"] for case in file["points"]])
    many = machine.equilibrium(points, wrench)
    assert many.solved.all()
    assert many.stable.all()
    for i, case in enumerate(file["points"]):
        wanted = case["computed"]
        one = machine.posture(position=points[i]).deflected_by(wrench)
        for displacement, forces in (
            (many.displacement[i], many.actuator_forces[i]),
            (one.displacement, one.actuator_forces),
        ):
            close(1e3 * displacement[:3], wanted["dp"], 1e-10)
            close(displacement[3:], wanted["rotvec"], 1e-10)
            close(forces, wanted["actuator_forces"], 1e-10)
        turned = ks.rotation_vector(one.tool[:3, :3] @ machine.home[:3, :3].T)
        close(turned, wanted["rotvec"], 1e-9)


@pytest.mark.parametrize("name", ["A", "B"])
def test_stewart_gough(golden, name):
    file = golden("stewart_gough")
    case = next(case for case in file["cases"] if case["name"] == name)
    wanted = np.zeros((6, 6))
    for key, value in case["computed"].items():
        i, j = int(key[0]) - 1, int(key[1]) - 1
        wanted[i, j] = wanted[j, i] = value
    found = ks.Machine.preset(f"stewart_gough_{name.lower()}").posture().stiffness()
    close(found.matrix, wanted, 1e-10)
    assert found.rank == case["rank"]
