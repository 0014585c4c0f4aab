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
