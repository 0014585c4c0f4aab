"""Typed calls say what looks wrong, as the commands do; energies say what they are of."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import chatter, commands

HEAVY = ks.Machine.preset("heavy_6r")
PROGRAM = "G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100 Y-20\nM2\n"


def test_a_load_that_folds_the_machine_over_is_heard() -> None:
    posture = HEAVY.posture([1.2, 0, 0.9])
    with pytest.warns(ks.PlausibilityWarning) as heard:
        found = posture.deflected_by([1e6, 0, 0, 0, 0, 0])
    assert all(w.filename == __file__ for w in heard)
    said = " ".join(found.warnings)
    assert "folds over under this load" in said
    assert "force on the tool" in said
    assert f"; {len(found.warnings)} warnings>" in repr(found)
    told = {w["message"] for w in commands.deflect("heavy_6r", at=[1200, 0, 900], force=[1e6, 0, 0])["warnings"]}
    assert set(found.warnings) <= told


def test_a_load_that_is_only_unusual_is_written_down() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        found = HEAVY.posture([1.2, 0.1, 0.9]).deflected_by([0, 3000, 10, 0, 0, 0])
        usual = HEAVY.posture([1.2, 0.1, 0.9]).deflected_by([0, 300, 10, 0, 0, 0])
    assert len(found.warnings) == 1
    assert "robots mill with 50 to 1000 N" in found.warnings[0]
    assert usual.warnings == ()
    assert "warning" not in repr(usual)


def test_a_tool_in_millimetres_is_heard() -> None:
    with pytest.warns(ks.PlausibilityWarning, match="no tool has such a length") as heard:
        long = HEAVY.with_tool(length=180)
    assert "180000 mm" in heard[0].message.detail
    assert heard[0].message.detail in long.warnings
    assert "warning" in repr(long)
    pose = np.eye(4)
    pose[:3, 3] = [100, -20, 180]
    with pytest.warns(ks.PlausibilityWarning, match="tool"):
        HEAVY.with_tool(pose)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        usual = HEAVY.with_tool(length=0.18)
        short = HEAVY.with_tool(length=0.01)
    assert usual.warnings == HEAVY.warnings
    assert any("only 10 mm long" in said for said in short.warnings)


def test_a_posture_outside_its_limits_says_so() -> None:
    gantry = ks.Machine.preset("gantry")
    assert "OUTSIDE_LIMITS" in repr(gantry.posture([500, 0, 300]))
    assert "OUTSIDE_LIMITS" not in repr(gantry.posture())


def test_corrections_of_a_metre_are_heard() -> None:
    def constant(size: float) -> ks.Corrected:
        return ks.correct_program(PROGRAM, lambda p, d: np.full_like(p, size) * [0.6, 0.0, -0.8])

    with pytest.warns(ks.PlausibilityWarning, match="corrections are larger than programs have") as heard:
        found = constant(1.0)
    assert "corrections of up to 1000 mm are large" in heard[0].message.detail
    assert len(found.warnings) == 1
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert "are large" in constant(1.5e-3).warnings[0]
        assert "nothing to correct" in constant(1e-6).warnings[0]
        assert constant(2e-4).warnings == ()


def test_energy_of_springs_and_energy_of_all() -> None:
    # Work of a force that grows slowly: the energies of two equilibria differ by it, for the weights are part of the one.
    posture = HEAVY.posture([1.2, 0.1, 0.9])
    rest = posture.deflected_by([0, 0, 0, 0, 0, 0])
    load = np.array([100.0, -200.0, -300.0, 0, 0, 0])
    steps = [posture.deflected_by(load * share) for share in np.linspace(0, 1, 41)]
    places = np.array([step.displacement[:3] for step in steps])
    forces = np.linspace(0, 1, 41)[:, None] * load[:3]
    work = float(np.sum(0.5 * (forces[1:] + forces[:-1]) * np.diff(places, axis=0)))
    assert rest.energy is not None
    assert steps[-1].energy is not None
    assert steps[-1].energy - rest.energy == pytest.approx(work, rel=1e-3)
    # Springs alone hold a small part of what the zero of the weights makes of it.
    assert 0 < steps[-1].spring_energy < 100 < abs(steps[-1].energy)


def test_energy_of_a_spring_by_hand() -> None:
    machine = ks.Machine.preset("two_link").posture()
    curve = machine.curve(direction=[1, 0, 0], displacement=(-0.05, 0.01))
    branch = curve.branches[0]
    work = np.concatenate([[0.0], np.cumsum(0.5 * (branch.force[1:] + branch.force[:-1]) * np.diff(branch.displacement))])
    kept = branch.spring_energy - branch.spring_energy[0]
    np.testing.assert_allclose(kept, work, atol=1e-3 * np.abs(work).max())


FOLDING = [1e6, 0, 0, 0, 0, 0]


def test_many_postures_say_what_one_says() -> None:
    place = np.array([1.2, 0, 0.9])
    with pytest.warns(ks.PlausibilityWarning) as one:
        single = HEAVY.posture(place).deflected_by(FOLDING)
    for ask in (
        lambda: HEAVY.equilibrium([place], FOLDING),
        lambda: HEAVY.equilibrium([place, place], [[0] * 6, FOLDING]),
        lambda: HEAVY.map(x=[1.2], y=0.0, z=0.9, loads=FOLDING),
        lambda: HEAVY.posture(place).vibration(FOLDING),
    ):
        with pytest.warns(ks.PlausibilityWarning) as many:
            found = ask()
        assert {str(w.message) for w in many} == {str(w.message) for w in one}
        assert all(w.filename == __file__ for w in many)
        if isinstance(found, ks.Equilibria):
            assert found.warnings == single.warnings
            assert f"; {len(found.warnings)} warnings>" in repr(found)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        assert HEAVY.equilibrium([place], [0, 300, 10, 0, 0, 0]).warnings == ()


def test_places_and_commands_in_other_units_are_heard() -> None:
    for ask in (
        lambda: HEAVY.stiffness([[1200, 0, 900]] * 3),
        lambda: HEAVY.equilibrium([[1200, 0, 900]] * 3),
        lambda: HEAVY.map(x=[1200]),
    ):
        with pytest.warns(ks.PlausibilityWarning, match="none of the places can be reached"):
            ask()
    degrees = [0, -90, 90, 0, 45, 0]
    for ask in (lambda: HEAVY.posture(joints=degrees), lambda: HEAVY.stiffness(joints=[degrees]), lambda: HEAVY.frames([degrees])):
        with pytest.warns(ks.PlausibilityWarning, match="commands are beyond what actuators have") as heard:
            ask()
        assert "is commanded to 90 rad" in heard[0].message.detail  # type: ignore[union-attr]
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        HEAVY.stiffness([[1200, 0, 900], [1.2, 0, 0.9]])


def test_repeated_warnings_are_one_line() -> None:
    postures = [HEAVY.posture([1.2, 0.01 * k, 0.9]) for k in range(5)]
    with warnings.catch_warnings(record=True) as heard:
        warnings.simplefilter("default")
        for k, posture in enumerate(postures):
            posture.deflected_by([0, 0, 2e4 + 100 * k, 0, 0, 0])
    assert len(heard) == len({str(w.message) for w in heard})


@pytest.mark.parametrize(
    ("coefficients", "words"),
    [
        ((800.0, 240.0, 0.0), "it looks like N/mm\\^2, in Pa it is 8e\\+08"),
        ((8e8, 0.3, 0.0), "looks like a ratio: in Pa it is 2.4e\\+08"),
        ((8e14, 0.0, 0.0), "expected a tangential one of 5e\\+06 to 2e\\+10 Pa"),
        ((-8e8, 0.0, 0.0), "expected a tangential one"),
    ],
)
def test_coefficients_of_cuts_in_other_units_are_refused(coefficients: tuple[float, float, float], words: str) -> None:
    tip = chatter.tool_modes([[1, 0, 0]], stiffness=[1.34e6], frequencies_hz=[922], damping_ratios=[0.011])
    with pytest.raises(ks.ArgumentError, match=words):
        chatter.lobes(tip, chatter.MillingCut(2, 1.0, False, coefficients), [5000.0], up_to=1e-3)
    with pytest.raises(ks.ArgumentError, match=r"up_to is up to 3 m, .* looks like mm"):
        chatter.lobes(tip, chatter.MillingCut(2, 1.0, False, (6e8, 2e8, 0.0)), [5000.0], up_to=3)
