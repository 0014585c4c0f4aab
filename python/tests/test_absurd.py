"""Absurd arguments: refused in words that name the argument, never taken in silence, never an error of what lies below."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import commands, tolerance

MACHINE = ks.Machine.preset("orthoglide")
POSTURE = MACHINE.posture()
MASKED = np.ma.masked_array([100.0, 0, 0, 0, 0, 0], [0, 1, 0, 0, 0, 0])
SPREAD = {"chain.leg.q2.length_mm": tolerance.normal(0.01)}
PROGRAM = "G21 G90 G1 X10 F300"


def still(places: np.ndarray, directions: np.ndarray) -> np.ndarray:
    return 0 * places


def cable(poses: np.ndarray) -> np.ndarray:
    return ks.wrench(-1000 * poses[..., :3, 3])


def spread_of(stated: Any, **more: Any) -> Any:
    return tolerance.machines(MACHINE, stated, [[0, 0, 0]], draws=16, **more)


def spread(value: Any) -> Any:
    return spread_of({"chain.leg.q2.length_mm": value})


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
        (lambda: ks.correct_program(5, still), "program is 5, expected text or bytes"),
        (lambda: ks.correct_program(PROGRAM, 3), "field is 3, expected a function"),
        (lambda: spread(0.01), r"spread of 'chain.leg.q2.length_mm' is 0.01, expected a Distribution: normal\(0.01\)"),
        (lambda: spread(None), "spread of 'chain.leg.q2.length_mm' is None, expected a Distribution"),
        (lambda: tolerance.draws([1.0, 2.0], [0.1, 0.2], 32), r"spread\[0\] is 0.1, expected a Distribution"),
        (lambda: tolerance.draws([1.0], 3, 32), "spread is 3, expected Distributions"),
        (lambda: tolerance.sobol(lambda x: x[:, 0], [1.0], [0.1], 128), r"spread\[0\] is 0.1, expected a Distribution"),
        (lambda: tolerance.normal("a"), "deviation has dtype"),
        (lambda: tolerance.normal([0.1, 0.2]), "deviation has shape"),
        (lambda: tolerance.Distribution("gaussian", 1.0), "word is 'gaussian', expected one of normal, uniform, triangular"),
        (lambda: spread_of({"chain.leg.q2.length_mm": 3}), "spread of 'chain.leg.q2.length_mm' is 3, expected a Distribution"),
        (lambda: spread_of(SPREAD, quantities=[]), r"quantities is \[\], expected one or more of error"),
        (lambda: spread_of(SPREAD, quantities="error"), "quantities is 'error', expected some of error"),
        (lambda: spread_of(SPREAD, quantities=["speed"]), r"quantities is \['speed'\], expected one or more of error"),
        (lambda: spread_of(SPREAD, correlations={"a": 1}), "a key of correlations is 'a', expected two names"),
        (lambda: spread_of(SPREAD, correlations={("a", "b"): "x"}), r"correlations\['a', 'b'\] has dtype"),
        (lambda: spread_of("schema = 1", correlations={("a", "b"): 0.5}), "correlations goes with a dictionary of Distributions"),
        (
            lambda: MACHINE.targets([[0, 0, 0]], np.zeros(6), directions=[]),
            r"directions is \[\], expected 'position', 'pose' or some of x, y",
        ),
        (lambda: MACHINE.targets([[0, 0, 0]], np.zeros(6), directions=["x", "w"]), r"directions is \['x', 'w'\], expected"),
        (lambda: POSTURE.under(cable, tolerance=float("nan")), "tolerance is nan: give finite numbers"),
        (lambda: POSTURE.under(cable, tolerance=0), "tolerance is 0, expected a number above 0"),
        (lambda: POSTURE.under(cable, tolerance="tight"), "tolerance has dtype <U5, expected real numbers"),
        (lambda: POSTURE.under(cable, most_iterations=0), "most_iterations is 0, expected a whole number from 1"),
        (lambda: POSTURE.under(cable, most_iterations=2.5), "most_iterations is 2.5, expected a whole number from 1"),
        (lambda: POSTURE.under(cable, threads="abc"), "threads is 'abc', expected a whole number from 1 to 1024"),
        (lambda: POSTURE.under(3), "model is 3, expected a function of poses"),
        (lambda: POSTURE.under(cable, tangent=3), "tangent is 3, expected a function of poses"),
        (lambda: MACHINE.stiffness([[0, 0, 0]], progress=3), "progress is 3, expected a function of what is done"),
        (lambda: commands.model_list(progress="bar"), "progress is 'bar', expected a function of what is done"),
        (lambda: POSTURE.shapes(force=[1, 0, 0], loads=3), "loads is 3, expected a dictionary of forces by node"),
        (lambda: POSTURE.curve(force=[1, 0, 0], factor=(0, 1), loads={3: [1, 0, 0]}), "a key of loads is 3, expected the name of a node"),
        (lambda: ks.curves.critical_load(POSTURE, [1, 0, 0], most="far"), "most has dtype <U3"),
        (lambda: ks.curves.critical_load(POSTURE, [1, 0, 0], most=float("nan")), "most is nan"),
        (lambda: ks.curves.critical_load(POSTURE, [1, 0, 0], factor=(0, 2)), "factor is no argument here"),
        (lambda: POSTURE.assembly(deviations="leg x:line:1deg about x"), "deviations is 'leg x:line:1deg about x', expected a list"),
        (lambda: POSTURE.assembly(deviations=[3]), r"deviations\[0\] is 3, expected text"),
        (lambda: ks.shares.cheapest_stiffening(MACHINE, "half"), "less has dtype <U4"),
        (lambda: ks.shares.cheapest_stiffening(MACHINE, float("nan")), "less is nan"),
        (lambda: tolerance.sobol(3, [1.0], [tolerance.normal(1)], 128), "function is 3, expected a function of an array"),
        (lambda: MACHINE.map(x=[0, 0.01], variables=3), "variables is 3, expected a list of stiffness_x"),
        (lambda: MACHINE.map(x=[0, 0.01], folder=3), "folder is 3, expected a path"),
        (lambda: ks.Machine.preset(3), "name is 3, expected the name of a preset"),
        (lambda: ks.Machine.preset("two_link\0"), r"name is 'two_link\\x00', expected the name of a preset without the character NUL"),
        (lambda: ks.Machine.preset("a" * 5000), "name has 5000 characters, expected at most 4096: 'aaa"),
        (lambda: ks.Machine.open("mine\0.toml"), "path is .*, expected a path without the character NUL"),
        (lambda: ks.Machine.open(3), "path is 3, expected a path"),
        (lambda: ks.Machine.from_toml(b"schema = 1"), "text is b'schema = 1', expected the text of a model file"),
        (lambda: ks.Machine.from_toml("schema = 1", file=3), "file is 3, expected text"),
        (lambda: ks.Machine.from_dict([1]), r"document is \[1\], expected a dictionary with the keys of a model file"),
        (lambda: ks.Machine.from_urdf("<robot/>", home={"q": 0.5}), r"home\['q'\] is 0.5, expected what the joint does"),
        (
            lambda: ks.Machine.from_urdf("<robot/>", home={"q": ("turns", 0.5)}),
            r"the kind of home\['q'\] is 'turns', expected one of revolute",
        ),
        (lambda: ks.Machine.from_urdf("<robot/>", passive="q1"), "passive is 'q1', expected a list of names of joints"),
        (lambda: ks.Machine.from_urdf("<robot/>", stiffness="stiff"), "stiffness has dtype"),
        (lambda: MACHINE.drawing(3), "posture is 3, expected a Posture"),
        (lambda: MACHINE.drawing(ks.Machine.preset("two_link").posture()), "posture is one of .*two_link.*, not of this machine"),
        (lambda: MACHINE.compensate("in.ngc", "out.ngc", tolerance="tight"), "tolerance has dtype"),
        (lambda: MACHINE.compensate("in.ngc", "out.ngc", model="two_link"), "model is no argument here"),
        (lambda: ks.LimbBuilder("a").link("boom", "tube", "long"), "length has dtype"),
        (lambda: ks.LimbBuilder("a").actuator("q", "revolute", "z", "stiff"), "stiffness has dtype"),
        (lambda: ks.LimbBuilder("a").actuator("q", "turns", "z", 1e5), "kind is 'turns', expected one of revolute, prismatic"),
        (lambda: ks.LimbBuilder("a").actuator("q", "revolute", "z", 1e5, limits=(0, 1, 2)), r"limits has shape \(3,\), expected \(2,\)"),
        (lambda: ks.LimbBuilder("a").body("motor", "heavy"), "mass has dtype"),
        (lambda: ks.MachineBuilder("a").platform("tool", [0, 0, 1], mass="heavy"), "mass has dtype"),
        (lambda: ks.MachineBuilder(3), "name is 3, expected text"),
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


class Raises:
    """Without a representation of its own."""

    def __repr__(self) -> str:
        raise RuntimeError("no words for this")


def test_a_message_is_short_whatever_the_value_holds() -> None:
    for value in (Raises(), 10**5000, [Raises()] * 1000, list(range(10**6)), "a" * 10**6, {"a": {"b": [[[[["deep"]]]]]}}):
        with pytest.raises(ks.ArgumentError) as refused:
            ks.Machine.preset(value)  # type: ignore[arg-type]
        assert str(refused.value).startswith("name ")
        assert len(str(refused.value)) < 1000


@pytest.mark.parametrize(
    ("value", "words"),
    [
        (object, r"mechanism\.name is <class 'object'>, expected a number, text, a list or a dictionary"),
        ([[3j]], r"mechanism\.name\[0\]\[0\] is 3j, expected"),
        (np.array([3j]), r"mechanism\.name\[0\] is 3j, expected"),
        (np.datetime64("2020-01-01"), r"mechanism\.name is .*, expected"),
        (float("inf"), r"mechanism\.name is inf: give a finite number"),
    ],
)
def test_what_no_model_file_holds_is_refused_by_its_place(value: Any, words: str) -> None:
    with pytest.raises(ks.ModelError, match=words):
        ks.Machine.from_dict({"schema": 1, "mechanism": {"name": value}})


def test_a_dictionary_that_holds_itself_is_refused() -> None:
    document: dict[str, Any] = {"schema": 1}
    document["mechanism"] = document
    with pytest.raises(ks.ModelError, match="is nested more than 32 deep"):
        ks.Machine.from_dict(document)
