"""Tolerances: against closed forms, SALib, and numbers computed apart."""

from __future__ import annotations

import doctest
from pathlib import Path

import numpy as np
import pytest

import kinetostat as ks
from kinetostat import commands
from kinetostat import tolerance as tol


def test_examples_run() -> None:
    done = doctest.testmod(tol)
    assert done.attempted >= 6
    assert done.failed == 0


def ishigami(x: np.ndarray) -> np.ndarray:
    return np.sin(x[:, 0]) + 7 * np.sin(x[:, 1]) ** 2 + 0.1 * x[:, 2] ** 4 * np.sin(x[:, 0])


def test_sobol_indices_of_ishigami() -> None:
    found = tol.sobol(ishigami, [0, 0, 0], [tol.uniform(np.pi)] * 3, 8192)
    v1, v2 = 0.5 * (1 + 0.1 * np.pi**4 / 5) ** 2, 49 / 8
    v13 = 0.01 * np.pi**8 * (1 / 18 - 1 / 50)
    v = v1 + v2 + v13
    np.testing.assert_allclose(found.first[0], np.array([v1, v2, 0]) / v, atol=0.015)
    np.testing.assert_allclose(found.total[0], np.array([v1 + v13, v2, v13]) / v, atol=0.015)
    assert found.unanswered == 0


def test_sobol_indices_of_ishigami_are_those_of_salib() -> None:
    sample = pytest.importorskip("SALib.sample.sobol")
    analyze = pytest.importorskip("SALib.analyze.sobol")
    problem = {"num_vars": 3, "names": ["a", "b", "c"], "bounds": [[-np.pi, np.pi]] * 3}
    rows = sample.sample(problem, 4096, calc_second_order=False, seed=1)
    theirs = analyze.analyze(problem, ishigami(rows), calc_second_order=False, seed=1)
    ours = tol.sobol(ishigami, [0, 0, 0], [tol.uniform(np.pi)] * 3, 8192)
    np.testing.assert_allclose(ours.first[0], theirs["S1"], atol=0.03)
    np.testing.assert_allclose(ours.total[0], theirs["ST"], atol=0.03)


def test_a_correlated_pair() -> None:
    drawn = tol.draws([1, 2], [tol.normal(0.1), tol.normal(10, percent=True)], 4096, correlation=[[1, 0.6], [0.6, 1]])
    np.testing.assert_allclose(np.cov(drawn.T), [[0.01, 0.012], [0.012, 0.04]], rtol=0.02)


def test_machines_linear_against_draws() -> None:
    machine = ks.Machine.preset("orthoglide")
    spread = {
        "chain.leg.q2.length_mm": tol.normal(0.002),
        "stiffness.bar.scale": tol.normal(1, percent=True),
        "load force_n.x": tol.normal(1, percent=True),
    }
    found = tol.machines(machine, spread, [[0, 0, 0], [0.05, -0.03, 0.02]], [215, -10, -25, 0, 0, 0], draws=512, seed=3)
    assert found.samples.shape == (512, 2, 19)
    assert found.inputs.shape == (512, 3)
    assert found.no_machine == found.no_answer == found.unstable == 0
    at = found.columns.index("deflection_by_load_mm")
    np.testing.assert_allclose(found.samples[:, :, at].std(axis=0), found.standard_deviation[:, at], rtol=0.05)
    assert (found.nonlinearity()[:, at] < 0.1).all()
    # One machine anew, as a model of its own whose load is the drawn one: the deflection is what the machine itself says.
    no_change = tol.machines(machine, {"load force_n.x": tol.normal(1e-12)}, [[0, 0, 0]], [215, -10, -25, 0, 0, 0], draws=16)
    alone = machine.equilibrium([[0, 0, 0]], [215, -10, -25, 0, 0, 0]).displacement[0, :3] * 1e3
    np.testing.assert_allclose(no_change.column("deviation_x_mm")[:, 0], alone[0], rtol=1e-9)


@pytest.mark.parametrize(
    ("spread", "words"),
    [
        ({"chain.leg.q2.lenght_mm": tol.normal(1)}, "chain.leg.q2.length_mm"),
        ({"chain.leg.q2.length_mm": tol.normal(-1)}, "a number above 0 is needed"),
        ({"chain.leg.slider.stiffness_n_per_mm": tol.normal(40, percent=True)}, "stiffness"),
    ],
)
def test_what_is_wrong_is_refused(spread: dict[str, tol.Distribution], words: str) -> None:
    with pytest.raises(ks.ModelError, match=words):
        tol.machines(ks.Machine.preset("orthoglide"), spread, [[0, 0, 0]])


def test_arguments_that_are_wrong() -> None:
    c = [[1, 0.9, -0.9], [0.9, 1, 0.9], [-0.9, 0.9, 1]]
    with pytest.raises(ks.ArgumentError, match="contradict"):
        tol.draws([0, 0, 0], [tol.normal(1)] * 3, 16, correlation=c)
    with pytest.raises(ks.ArgumentError, match="shape"):
        tol.sobol(lambda x: x[:3], [0], [tol.normal(1)], 128)


def test_numbers_of_draws_out_of_range_are_refused() -> None:
    one = [tol.normal(1)]
    machine = ks.Machine.preset("two_link")
    for n in (-1, 0, 2**20 + 1, 1.5):
        with pytest.raises(ks.ArgumentError, match="from 1 to 1048576"):
            tol.draws([0], one, n)  # type: ignore[arg-type]
        with pytest.raises(ks.ArgumentError, match=r"draws is .* from 1 to 1048576"):
            tol.machines(machine, {}, [[0, 0, 0]], draws=n)  # type: ignore[arg-type]
    for n in (0, 16, 127, 2**20 + 1):
        with pytest.raises(ks.ArgumentError, match="from 128 to 1048576"):
            tol.sobol(lambda x: x[:, 0], [0], one, n)
    with pytest.raises(ks.ArgumentError, match="seed is -1"):
        tol.draws([0], one, 16, seed=-1)
    for threads in (-1, 0, 1025):
        with pytest.raises(ks.ArgumentError, match=r"threads is .* from 1 to 1024"):
            tol.machines(machine, {}, [[0, 0, 0]], threads=threads)


def test_no_variance_has_no_parts() -> None:
    with pytest.raises(ks.UnansweredError, match=r"output 1 .* does not vary"):
        tol.sobol(lambda x: np.stack([x[:, 0], 0 * x[:, 0] + 1], axis=1), [0], [tol.normal(1)], 128)


def test_spreads_and_correlations_of_numpy() -> None:
    text = tol._toml({"a": tol.Distribution("normal", np.float64(0.01))}, {})
    assert "normal = 0.01\n" in text
    with pytest.raises(ks.ArgumentError, match="spread of 'a' is inf"):
        tol._toml({"a": tol.normal(np.inf)}, {})
    near = np.corrcoef(np.random.default_rng(0).normal(size=(3, 100)))
    assert tol.draws([1, 2, 3], [tol.normal(0.1)] * 3, 64, correlation=near).shape == (64, 3)


def test_more_results_than_can_be_kept_are_refused_before_they_are_computed(tmp_path: Path) -> None:
    machine = ks.Machine.preset("orthoglide")
    spread = {"chain.leg.q2.length_mm": tol.normal(0.01)}
    begun = []
    with pytest.raises(ks.ArgumentError, match=r"39845888000 numbers \(319 GB\), and 200000000 \(1\.6 GB\) can be kept"):
        tol.machines(machine, spread, np.zeros((2000, 3)), [1, 0, 0, 0, 0, 0], draws=2**20, progress=lambda *now: begun.append(now))
    assert begun == []
    file = tmp_path / "spread.toml"
    file.write_text(tol._toml(spread, {}))
    with pytest.raises(ks.ArgumentError, match=r"machines 1048576: .* \(1\.6 GB\) can be kept; take fewer places or machines"):
        commands.tolerance("orthoglide", uncertain=file, at=[[0.1 * k, 1, 2] for k in range(20)], force=[1, 0, 0], machines=2**20)
    many = [tol.normal(1)] * 200
    with pytest.raises(ks.ArgumentError, match="can be kept; take fewer"):
        tol.draws([1.0] * 200, many, 2**20)
    with pytest.raises(ks.ArgumentError, match="can be kept; take a smaller n"):
        tol.sobol(lambda x: x[:, 0], [1.0] * 200, many, 2**20)


def test_correlations_beside_the_text_of_a_file_are_refused() -> None:
    text = "schema = 1\n[[uncertain]]\nparameter = 'chain.leg.q2.length_mm'\nnormal = 0.01\n"
    names = ("chain.leg.q2.length_mm", "stiffness.bar.scale")
    with pytest.raises(ks.ArgumentError, match=r"\[\[correlation\]\]"):
        tol.machines(ks.Machine.preset("orthoglide"), text, [[0, 0, 0]], draws=16, correlations={names: 0.9})


def test_a_percentage_of_zero_is_refused() -> None:
    with pytest.raises(ks.ArgumentError, match=r"spread\[1\] is a percentage of a number that is zero"):
        tol.draws([2.0, 0.0], [tol.normal(5, percent=True)] * 2, 16)


def test_sobol_indices_with_missing_answers() -> None:
    def missing_above(bound: float):
        def function(x: np.ndarray) -> np.ndarray:
            return np.where(x.sum(axis=1) > bound, np.nan, x.sum(axis=1))

        return function

    one = [tol.normal(1), tol.normal(1)]
    for n in (128, 4096):
        with pytest.raises(ks.UnansweredError, match=rf"is no number in \d+ of {n} draws, and at most 2 % can be left out"):
            tol.sobol(missing_above(1.0), [0, 0], one, n)
    # Three standard deviations off in four ways: some are missing, and what is left is nearly the whole.
    found = tol.sobol(missing_above(4.2), [0, 0], one, 4096)
    assert 0 < found.unanswered <= 0.02 * 4096
    np.testing.assert_allclose(found.first[0], [0.5, 0.5], atol=0.05)


def test_sobol_indices_of_nothing_are_refused():
    with pytest.raises(ks.ArgumentError, match="spread is empty"):
        tol.sobol(lambda x: np.zeros(len(x)), [], [], 128)
    with pytest.raises(ks.ArgumentError, match="shape"):
        tol.sobol(lambda x: np.zeros((len(x), 0)), [1.0], [tol.normal(1)], 128)
