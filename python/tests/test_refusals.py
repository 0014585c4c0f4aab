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
        (lambda: ORTHOGLIDE.stiffness(MASKED), "masked"),
        (lambda: ORTHOGLIDE.stiffness([[0, 0, 0]], threads=-1), "threads is -1, .* from 1 to 1024"),
        (lambda: ORTHOGLIDE.map(x=[0, 0.01], threads=1025), "threads is 1025"),
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
