"""Answers of many postures as tables, shares by a word, stiffness of imported drives, and platforms that contradict their limbs."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks

MACHINE = ks.Machine.preset("orthoglide")
ARM = """<robot name="arm"><link name="base"/><link name="boom"/><link name="slide"/><link name="hook"/>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="boom"/><origin xyz="0 0 1.5"/><axis xyz="0 1 0"/>
<limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<joint name="reach" type="prismatic"><parent link="boom"/><child link="slide"/><origin xyz="0 0 0.5"/><axis xyz="1 0 0"/>
<limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<joint name="end" type="fixed"><origin xyz="1 0 0"/><parent link="slide"/><child link="hook"/></joint></robot>"""


def test_answers_have_rows() -> None:
    places = np.stack(np.meshgrid([0.0, 0.02, 9.0], [0.0, 0.03], [0.0], indexing="ij"), axis=-1)[:, :, 0]
    found = MACHINE.equilibrium(places, [100, 0, 0, 0, 0, 0])
    assert len(found) == 3
    np.testing.assert_array_equal(found[1].displacement, found.displacement[1])
    np.testing.assert_array_equal(found[found.solved].stiffness, found.stiffness[found.solved])
    assert found[0, 1].status.shape == ()
    assert MACHINE.equilibrium(places, details="rest")[:2].stiffness is None


def test_answers_as_tables() -> None:
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    found = MACHINE.equilibrium([[0, 0, 0], [0.02, 0.01, 0], [9, 0, 0]], [100, -20, 5, 0, 0, 0])
    table, data = found.to_pandas(), found.to_xarray()
    assert len(table) == 3
    assert table.notna().all(axis=1).tolist() == [True, True, False]
    for k, name in enumerate(("x", "y", "z", "rx", "ry", "rz")):
        np.testing.assert_array_equal(table[f"displacement_{name}"], found.displacement[:, k])
        np.testing.assert_array_equal(data.displacement.sel(component=name), found.displacement[:, k])
    np.testing.assert_array_equal(table["stiffness_x_rz"], found.stiffness[:, 0, 5])
    np.testing.assert_array_equal(data.stiffness.sel(component="x", direction="rz"), found.stiffness[:, 0, 5])
    np.testing.assert_array_equal(table["tool_0_3"], found.tool[:, 0, 3])
    np.testing.assert_array_equal(table["commands_2"], found.commands[:, 2])
    assert MACHINE.stiffness([[0, 0, 0]]).to_xarray().matrix.dims == ("dim_0", "component", "direction")


def test_shares_take_the_direction_as_a_word_everywhere() -> None:
    assert MACHINE.shares("x").parts == MACHINE.shares(direction="x").parts
    assert MACHINE.shares("x").compliance == pytest.approx(MACHINE.posture().shares("x").compliance, rel=1e-12)
    with pytest.raises(ks.ArgumentError, match="direction is given twice"):
        MACHINE.shares("x", direction="y")
    with pytest.raises(ks.ArgumentError, match="direction is 'up'"):
        MACHINE.shares("up")  # type: ignore[arg-type]


def test_stiffness_of_imported_drives() -> None:
    wanted = ks.Machine.from_urdf(ARM, tip="hook", stiffness={"shoulder": (2e5, "N m/rad"), "reach": (3e6, "N/m")})
    # By hand: the shoulder is 0.5 m below the slide and 1 m behind the hook.
    by_hand = [0.5**2 / 2e5 + 1 / 3e6, 1 / 2e5]
    np.testing.assert_allclose(wanted.posture().stiffness().compliance[[0, 2], [0, 2]], by_hand, rtol=1e-9)
    for stiffness in ([2e5, 3e6], np.array([2e5, 3e6]), {"reach": 3e6, "shoulder": 2e5}, {"reach": (3e3, "N/mm"), "shoulder": 2e5}):
        assert ks.Machine.from_urdf(ARM, tip="hook", stiffness=stiffness).to_dict() == wanted.to_dict()
    with pytest.raises(ks.ArgumentError, match=r"stiffness has shape \(3,\), expected \(2,\)"):
        ks.Machine.from_urdf(ARM, tip="hook", stiffness=[1.0, 2.0, 3.0])
    with pytest.raises(ks.ArgumentError, match=r"stiffness\['elbow'\] is 1.0, expected a value and its unit"):
        ks.Machine.from_urdf(ARM, tip="hook", stiffness={"elbow": 1.0})


@pytest.mark.parametrize("home", [[0.9, 0.3, 0], [0.9, 0, 0]])
def test_a_platform_away_from_the_end_of_its_limb_is_refused(home: list[float]) -> None:
    made = ks.MachineBuilder("slide")
    made.platform("tool", home)
    made.limb("arm", to="tool").actuator("x", "prismatic", "x", 5e6).rigid([0.5, 0, 0])
    with pytest.raises(ks.ModelError, match=r"at home the limb 'arm' ends .* away from the platform 'tool'"):
        made.machine()


def test_power_needs_a_speed() -> None:
    cut = {"material": "AlMg4.5Mn", "tool": "flat", "diameter_mm": 12, "teeth": 4, "helix_deg": 38, "width_mm": 4, "depth_mm": 8}
    cut |= {"climb": True, "feed_per_tooth_mm": 0.1}
    still, fast = ks.cutting.milling_force(**cut), ks.cutting.milling_force(**cut, rpm=8000)
    assert still.power is None
    assert fast.power == pytest.approx(still.torque * 8000 * 2 * np.pi / 60, rel=1e-12)
