"""Messages for arguments that make no sense."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import commands

ORTHOGLIDE = ks.Machine.preset("orthoglide")
GRAVITY = {"schema": 1, "mechanism": {"name": "a", "gravity_m_per_s2": [0, 0, float("nan")]}}
MASKED = np.ma.masked_array([[0.01, 0, 0.0]], [[True, False, False]])


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: ks.Machine.from_dict(GRAVITY), r"mechanism\.gravity_m_per_s2\[2\] is nan"),
        (lambda: commands.stiffness("orthoglide", at=[]), "empty"),
        (lambda: commands.stiffness("orthoglide", at=[[1, 2], 3]), "not alike"),
        (lambda: commands.stiffness("orthoglide", at=[[1, 2], [3]]), "not alike"),
        (lambda: commands.stiffness("--help"), "dash"),
        (lambda: ORTHOGLIDE.map(x=[0, 0.01], executor=3), "executor is 3"),  # type: ignore[arg-type]
        (lambda: ORTHOGLIDE.map(x=[0, 0.01], executor=lambda: None), r"executor\(\) made None \(NoneType\), expected an executor"),
        (lambda: ORTHOGLIDE.stiffness(MASKED), "masked"),
        (lambda: ORTHOGLIDE.stiffness([MASKED[0], MASKED[0]]), "masked"),
        (lambda: ORTHOGLIDE.stiffness([[0.01, np.ma.masked, 0]]), "masked"),
        (lambda: ORTHOGLIDE.posture(position=(0, 0, np.ma.masked)), "masked"),
        (lambda: commands.stiffness("orthoglide", at=MASKED), "masked"),
        (lambda: commands.stiffness("orthoglide", at=[MASKED[0]]), "masked"),
        (lambda: commands.stiffness("orthoglide", at=3j), "at is 3j, expected a number, text or a path"),  # type: ignore[arg-type]
        (lambda: ORTHOGLIDE.posture().curve(), "say what shall grow: direction and displacement"),
        (lambda: commands.curve("orthoglide"), r"Either a displacement \(direction X Y Z displacement_mm FROM TO"),
        (lambda: ORTHOGLIDE.map(x=[0, np.nan]), "x holds nan: give finite numbers, m"),
        (lambda: commands.demo(threads=0), "threads is 0, expected a whole number from 1 to 1024"),
        (lambda: commands.demo(threads=-1), "threads is -1"),
        (lambda: commands.demo(threads="a"), "threads is 'a', expected a whole number"),  # type: ignore[arg-type]
        (lambda: commands.demo(threads=1.5), "threads is 1.5"),  # type: ignore[arg-type]
        (lambda: commands.map("orthoglide", x=[0, 10, 10], threads=1025), "threads is 1025"),
        (lambda: ORTHOGLIDE.stiffness([[0, 0, 0]], threads=-1), "threads is -1, .* from 1 to 1024"),
        (lambda: ORTHOGLIDE.map(x=[0, 0.01], threads=1025), "threads is 1025"),
        (lambda: ks.pose([0, 0, 0], [0, 0, 0.3]), r"shape \(3,\).* rotation_from_vector"),
        (lambda: ks.pose([0, 0, 0], np.eye(3) * 1.2), "no rotation"),
    ],
)
def test_the_message_names_what_is_wrong(ask: Callable[[], Any], words: str) -> None:
    with pytest.raises((ks.ArgumentError, ks.ModelError), match=words):
        ask()


def test_universal_joints_of_arrays() -> None:
    made = ks.LimbBuilder("a").passive("u", "universal", np.eye(3)[:2], home=np.array([0.1, 0.2]))  # type: ignore[arg-type]
    assert made.elements[0]["homes_rad"] == [0.1, 0.2]
    assert made.elements[0]["axes"] == [[1, 0, 0], [0, 1, 0]]


def built(fill: Callable[[ks.LimbBuilder, float], object], value: float) -> ks.Machine:
    builder = ks.MachineBuilder("nan")
    builder.platform("tool", [0.5, 0, 0])
    limb = builder.limb("arm", to="tool").rigid([0.5, 0, 0])
    fill(limb, value)
    return builder.machine()


@pytest.mark.parametrize("value", [float("nan"), float("inf")])
@pytest.mark.parametrize(
    ("fill", "words"),
    [
        (lambda limb, v: limb.rigid([v, 0, 0]), "pose is"),
        (lambda limb, v: limb.actuator("q", "revolute", "z", v), "stiffness is"),
        (lambda limb, v: limb.actuator("q", "prismatic", "z", v), "stiffness is"),
        (lambda limb, v: limb.actuator("q", "revolute", "z", 1e5, home=v), "home is"),
        (lambda limb, v: limb.actuator("q", "revolute", "z", 1e5, limits=(-1, v)), "limits is"),
        (lambda limb, v: limb.actuator("q", "revolute", "z", 1e5, rating=v), "rating is"),
        (lambda limb, v: limb.actuator("q", "revolute", [v, 0, 0], 1e5), "axis is"),
        (lambda limb, v: limb.passive("q", "revolute", "z", home=v), "home is"),
        (lambda limb, v: limb.passive("q", "universal", ["x", "y"], home=[0, v]), "home is"),
        (lambda limb, v: limb.spring("q", "revolute", "z", v), "stiffness is"),
        (lambda limb, v: limb.spring("q", "revolute", "z", 1e5, rest=v), "rest is"),
        (lambda limb, v: limb.spring6("q", [1e5, 1e5, v, 1, 1, 1]), "stiffness is"),
        (lambda limb, v: limb.link("q", "tube", v), "length is"),
        (lambda limb, v: limb.body("q", v), "mass is"),
        (lambda limb, v: limb.body("q", 1.0, [0, v, 0]), "centre is"),
    ],
)
def test_what_is_no_number_is_refused_by_name_in_the_builder(
    fill: Callable[[ks.LimbBuilder, float], object], words: str, value: float
) -> None:
    with pytest.raises(ks.ArgumentError, match=rf"^{words} .*{value}.*: give finite numbers$"):
        built(fill, value)


BENDING = ks.Machine.preset("three_link_z").posture()
ALONG = [1, 0, 0]


@pytest.mark.parametrize(
    ("question", "words"),
    [
        ({"direction": ALONG}, r"direction needs displacement=\(from, to\), m, as in displacement=\(0, 0\.02\)"),
        ({"about": ALONG}, r"about needs turn=\(from, to\), rad"),
        ({"force": ALONG}, r"force \(moment\) needs factor=\(from, to\)"),
        ({"direction": ALONG, "displacement": (0, 0.1), "force": ALONG, "factor": (0, 2)}, "direction and force .* one of them can grow"),
        ({"direction": ALONG, "displacement": (0, 0.1), "factor": (0, 2)}, "factor goes with force"),
        ({"direction": ALONG, "displacement": (0.1, 0.1)}, r"displacement is \[0\.1, 0\.1\]: there is nothing between equal ends"),
        ({"direction": ALONG, "displacement": (0, 2e4)}, "displacement is .* m, expected from -10000 to 10000 m"),
        ({"about": [0, 0, 1], "turn": (0, 4)}, "turn is .* rad, expected from -3.14159 to 3.14159 rad"),
        (
            {"direction": ALONG, "displacement": (0, 0.1), "force_limits": (5, -5)},
            r"force_limits is \[5\.0, -5\.0\], expected the lower one",
        ),
        ({"force": ALONG, "factor": (0, 2), "force_limits": (-5, 5)}, "force_limits end a motion"),
        ({"moment": [0, 0, 0], "factor": (0, 2)}, "which load shall grow"),
        ({"direction": ALONG, "displacement": (0, 0.1), "loads": {"none": ALONG}}, "^loads 'none=1.0,0.0,0.0'"),
    ],
)
def test_a_curve_names_its_own_arguments(question: dict[str, Any], words: str) -> None:
    with pytest.raises(ks.ArgumentError, match=words) as refused:
        BENDING.curve(**question)
    assert not any(other in str(refused.value) for other in ("_mm", "_deg", "grow NODE", "Usage", "--"))


def test_warnings_of_a_curve_name_its_own_arguments() -> None:
    found = BENDING.curve(direction=ALONG, displacement=(0, -0.2), points=10)
    assert any("points=N allows more, force_limits" in said for said in found.warnings)


def test_other_typed_questions_name_their_own_arguments() -> None:
    with pytest.raises(ks.ArgumentError, match="factor is no argument here, expected most"):
        ks.curves.critical_load(BENDING, [-1, 0, 0], factor=(0, 3))
    with pytest.raises(ks.ArgumentError, match="part_origin_mm is no argument here, expected part_origin, m"):
        ORTHOGLIDE.compensate("in.ngc", "out.ngc", part_origin_mm=[0, 0, 0])
    with pytest.raises(ks.ArgumentError, match="tool_length_mm is no argument here, expected a machine with its tool"):
        ORTHOGLIDE.compensate("in.ngc", "out.ngc", tool_length_mm=100)
    with pytest.raises(ks.ArgumentError, match=r"^turned: "):
        BENDING.shapes(turned=[0, 0, 4])


def test_commands_do_not_print_the_usage_of_the_command_line() -> None:
    with pytest.raises(ks.ArgumentError, match="factor") as refused:
        commands.curve("three_link_z", force=[1, 0, 0])
    assert "Usage" not in str(refused.value)


def test_a_field_that_jumps_or_rolls_dice_is_no_fault_of_the_package() -> None:
    program = "G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100\nM2\n"
    dice = np.random.default_rng(1)
    with pytest.raises(ks.UnansweredError, match="has to be continuous, and to give the same correction at the same place") as refused:
        ks.correct_program(program, lambda p, d: 1e-4 * dice.normal(size=p.shape))
    assert "please report" not in str(refused.value)


def test_warnings_of_a_urdf_say_that_their_lines_are_those_of_the_model() -> None:
    urdf = """<robot name="crane"><link name="post"/><link name="boom"/>
    <joint name="shoulder" type="revolute"><parent link="post"/><child link="boom"/><origin xyz="0 0 1.5"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="0" velocity="1"/></joint><link name="hook"/><joint name="end" type="fixed">
    <origin xyz="1000 0 0"/><parent link="boom"/><child link="hook"/></joint></robot>"""
    crane = ks.Machine.from_urdf(urdf, tip="hook", stiffness=2e5)
    said = next(w for w in crane.warnings if "reaches over 1000 m" in w)
    assert "model made of text.urdf:" in said
    line = int(said.split("text.urdf:")[1].split(":")[0])
    assert crane.text.splitlines()[line - 1].strip() in said
