"""Questions that the command line answers for straight tools, asked of machines with any tool."""

from __future__ import annotations

import numpy as np
import pytest

import kinetostat as ks
from kinetostat._tool import with_tool_in_model

TOOL = np.eye(4)
TOOL[:3, :3] = ks.rotation_from_vector([0.3, 1.2, -0.4])
TOOL[:3, 3] = [0.05, -0.03, 0.12]
WRENCH = [100.0, -20.0, -30.0, 1.0, 2.0, -3.0]
NAMES = [
    "orthoglide",
    "puu3",
    "hexapod",
    "delta",
    "heavy_6r",
    "kuka_kr270_like",
    "gantry_with_tripod",
    "arm_with_parallel_wrist",
    "compensated_arm",
]


@pytest.mark.parametrize("name", NAMES)
def test_a_tool_in_the_model_is_the_tool(name):
    machine = ks.Machine.preset(name).with_tool(TOOL)
    posture = machine.posture()
    other = with_tool_in_model(machine)
    np.testing.assert_array_equal(other.tool, np.eye(4))
    np.testing.assert_allclose(other.home, machine.home, rtol=0, atol=1e-14)
    same = other.posture(pose=posture.target)
    np.testing.assert_allclose(same.commands, posture.commands, rtol=0, atol=1e-10)
    k = posture.stiffness().matrix
    np.testing.assert_allclose(same.stiffness().matrix, k, rtol=0, atol=1e-9 * np.abs(k).max())
    # With its own weights and loads.
    found, wanted = same.deflected_by(WRENCH), posture.deflected_by(WRENCH)
    np.testing.assert_allclose(found.displacement, wanted.displacement, rtol=0, atol=1e-12)
    np.testing.assert_allclose(found.stiffness, wanted.stiffness, rtol=0, atol=1e-9 * np.abs(wanted.stiffness).max())


@pytest.mark.parametrize("name", ["orthoglide", "heavy_6r"])
def test_typed_questions_take_any_tool(name):
    machine = ks.Machine.preset(name).with_tool(TOOL)
    posture = machine.posture(machine.home[:3, 3] + [0.002, 0.001, -0.003])
    wanted = posture.deflected_by(WRENCH).displacement
    assembled = posture.assembly(force=WRENCH[:3], moment=WRENCH[3:]).displacement_under_load
    np.testing.assert_allclose(assembled[-1], wanted, rtol=0, atol=1e-12)
    assert posture.shares("x").compliance == pytest.approx(posture.stiffness().compliance[0, 0], rel=1e-9)
    curve = posture.curve(force=WRENCH[:3], moment=WRENCH[3:], factor=(0, 1))
    end = curve.branches[0].position[-1] - posture.target[:3, 3]
    np.testing.assert_allclose(end, wanted[:3], rtol=0, atol=1e-9)
    if name == "heavy_6r":  # of one limb: searches of others take long
        shapes = posture.shapes(force=WRENCH[:3], moment=WRENCH[3:], fruitless=5, starts=20)
        np.testing.assert_allclose(shapes.position[0] - posture.target[:3, 3], wanted[:3], rtol=0, atol=1e-9)
    assert machine.drawing(posture).lstrip().startswith("<svg")


def test_what_stands_in_the_frame_of_the_platform_is_refused():
    builder = ks.MachineBuilder("slide")
    builder.platform("table", [0.5, 0, 0])
    builder.limb("x", to="table").actuator("x", "prismatic", "x", 5e6).rigid([0.5, 0, 0])
    builder.load({"wrench": "hose", "platform": "table", "axes": "base", "force_n": [0, 0, -20]})
    posture = builder.machine().with_tool(TOOL).posture()
    with pytest.raises(ks.ArgumentError, match=r"straight tool .* where loads act on the platform 'table'"):
        posture.assembly()
