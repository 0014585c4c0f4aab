"""Compensated programs and cutting forces as arrays."""

from __future__ import annotations

from pathlib import Path

import numpy as np

import kinetostat as ks
from kinetostat.cutting import milling_force


def test_errors_are_those_of_single_equilibria(tmp_path: Path) -> None:
    source = tmp_path / "in.ngc"
    source.write_text("G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X50\nM2\n")
    machine = ks.Machine.preset("orthoglide")
    found = machine.compensate(source, tmp_path / "out.ngc", force=[100, -50, 20], part_origin=[0.01, 0.02, 0], tolerance=5e-6)
    assert found.within_tolerance
    full = np.flatnonzero(np.abs(found.wrench[:, 0] - 100) < 1e-9)
    assert len(full) > 3
    for i in full[:: max(len(full) // 4, 1)]:
        place = found.position[i] + [0.01, 0.02, 0]
        alone = machine.posture(place).deflected_by([100, -50, 20, 0, 0, 0])
        np.testing.assert_allclose(found.error_before[i], alone.displacement[:3], atol=1e-9)
        commanded = machine.posture(place + found.correction[i]).deflected_by([100, -50, 20, 0, 0, 0])
        np.testing.assert_allclose(commanded.tool[:3, 3], place, atol=6e-6)


def test_power_is_torque_times_speed() -> None:
    found = milling_force(
        material="AlMg4.5Mn", tool="flat", diameter_mm=12, teeth=4, width_mm=4, depth_mm=8, climb=True, feed_per_tooth_mm=0.1, rpm=8000
    )
    np.testing.assert_allclose(found.power, found.torque * 8000 * np.pi / 30, rtol=1e-9)
    assert np.all(np.abs(found.low) <= np.abs(found.high))
