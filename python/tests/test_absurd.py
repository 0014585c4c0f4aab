"""Absurd arguments: refused in words that name the argument, never taken in silence, never an error of what lies below."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import tolerance

MACHINE = ks.Machine.preset("orthoglide")
POSTURE = MACHINE.posture()
MASKED = np.ma.masked_array([100.0, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0])
PROGRAM = "G21 G90 G1 X10 F300"


def still(places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    return 0 * places


def spread(value: Any) -> Any:
    return tolerance.machines(MACHINE, {"chain.leg.q2.length_mm": value}, [[0, 0, 0]], draws=16)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: POSTURE.deflected_by(MASKED), "wrench has masked entries"),
        (lambda: POSTURE.deflected_by(list(MASKED)), "wrench has masked entries"),
        (lambda: POSTURE.held_at(np.ma.masked_array(POSTURE.target, np.eye(4))), "pose has masked entries"),
        (lambda: POSTURE.equilibrium_problem(MASKED), "wrench has masked entries"),
        (lambda: MACHINE.equilibrium([[0, 0, 0]], MASKED), "wrenches has masked entries"),
        (lambda: POSTURE.shares("x", MASKED), "wrench has masked entries"),
        (lambda: ks.wrench(MASKED[:3]), "force has masked entries"),
        (lambda: ks.LimbBuilder("a").rigid(MASKED[:3]), "pose has masked entries"),
        (lambda: ks.LimbBuilder("a").spring6("s", MASKED), "stiffness has masked entries"),
        (lambda: ks.LimbBuilder("a").rigid([[1], [2, 3]]), "pose is no array"),
        (lambda: ks.LimbBuilder("a").actuator("q", "revolute", "z", 1e5, limits=MASKED[:2]), "limits has masked entries"),
        (lambda: MACHINE.posture([0, 0, 0], near=3), "near is 3, expected a Posture"),
        (lambda: MACHINE.targets([[0, 0, 0]], np.zeros(6), directions=3), "directions is 3, expected 'position', 'pose' or some of"),
        (lambda: ks.correct_program(PROGRAM, still, decimals=-1), "decimals is -1, expected a whole number from 3 to 8"),
        (lambda: ks.correct_program(PROGRAM, still, decimals=300), "decimals is 300"),
        (lambda: ks.correct_program(PROGRAM, still, tolerance=float("nan")), "tolerance is nan"),
        (lambda: ks.correct_program(PROGRAM, still, tolerance=-1e-6), "tolerance is -1e-06, expected a number above 0"),
        (lambda: ks.correct_program(5, still), r"program is 5 \(int\), expected text or bytes"),
        (lambda: ks.correct_program(PROGRAM, 3), "field is 3, expected a function"),
        (lambda: spread(0.01), r"spread of 'chain.leg.q2.length_mm' is 0.01, expected a Distribution: normal\(0.01\)"),
        (lambda: spread(None), "spread of 'chain.leg.q2.length_mm' is None, expected a Distribution"),
        (lambda: tolerance.draws([1.0, 2.0], [0.1, 0.2], 32), r"spread\[0\] is 0.1, expected a Distribution"),
        (lambda: tolerance.draws([1.0], 3, 32), "spread is 3, expected Distributions"),
        (lambda: tolerance.sobol(lambda x: x[:, 0], [1.0], [0.1], 128), r"spread\[0\] is 0.1, expected a Distribution"),
        (lambda: tolerance.normal("a"), "deviation has dtype"),
        (lambda: tolerance.normal([0.1, 0.2]), "deviation has shape"),
        (lambda: spread(tolerance.uniform(float("nan"))), "spread of 'chain.leg.q2.length_mm' is nan"),
    ],
)
def test_the_argument_is_named(ask: Callable[[], Any], words: str) -> None:
    with pytest.raises(ks.ArgumentError, match=words):
        ask()


def test_what_is_masked_nowhere_is_an_array() -> None:
    found = POSTURE.deflected_by(np.ma.masked_array([100.0, 0, 0, 0, 0, 0]))
    np.testing.assert_array_equal(found.wrench, [100, 0, 0, 0, 0, 0])


@pytest.mark.parametrize("comment", ["Länge für Stück".encode("latin-1"), bytes(range(0x80, 0x100)), "Länge".encode()])
def test_comments_of_any_encoding_are_carried_byte_for_byte(comment: bytes) -> None:
    lines = [b"(" + comment + b")", b"G21 G90", b"G0 X0 Y0 Z1", b"G1 Z-1 F300 (" + comment + b")", b"G1 X100", b"M2"]
    program = b"\r\n".join(lines) + b"\r\n"
    same = ks.correct_program(program, still)
    assert same.raw == program
    assert same.text.encode("utf-8", "surrogateescape") == program

    def raised(places: np.ndarray, directions: np.ndarray) -> np.ndarray:
        return 0 * places + [0, 0, 1e-4]

    moved = ks.correct_program(program, raised).raw
    assert moved.count(comment) == 2
    assert lines[0] + b"\r\n" in moved.split(b"G21")[0]
    # As text that was read with surrogateescape: the same.
    assert ks.correct_program(program.decode("utf-8", "surrogateescape"), raised).raw == moved
