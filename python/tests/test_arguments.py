"""Whatever is handed over: an answer of the right shape, or an error of this package that says what was wrong."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import kinetostat as ks

MACHINE = ks.Machine.preset("orthoglide")
ANYTHING = st.one_of(
    arrays.arrays(
        dtype=st.one_of(arrays.floating_dtypes(), arrays.integer_dtypes(), arrays.complex_number_dtypes(), arrays.boolean_dtypes()),
        shape=arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=6),
    ),
    st.none(),
    st.text(max_size=5),
    st.lists(st.lists(st.floats(), max_size=4), max_size=4),
)


@settings(deadline=None, max_examples=150)
@given(poses=ANYTHING, wrenches=ANYTHING)
def test_only_errors_of_the_package(poses, wrenches):
    try:
        found = MACHINE.equilibrium(poses, wrenches)
    except ks.KinetostatError as error:
        assert str(error)
        return
    solved = found.solved
    assert np.isfinite(found.tool[solved]).all()
    assert np.isnan(found.tool[~solved]).all()


@settings(deadline=None, max_examples=100)
@given(position=ANYTHING, wrench=ANYTHING)
def test_one_posture(position, wrench):
    try:
        loaded = MACHINE.posture(position=position).deflected_by(wrench)
    except ks.KinetostatError as error:
        assert str(error)
        return
    assert np.isfinite(loaded.tool).all()


@settings(deadline=None, max_examples=50)
@given(
    places=arrays.arrays(np.float64, st.tuples(st.integers(0, 3), st.integers(0, 4), st.just(3)), elements=st.floats(-0.06, 0.06)),
)
def test_leading_axes_stay(places):
    found = MACHINE.stiffness(places)
    assert found.matrix.shape == (*places.shape[:-1], 6, 6)
    assert found.status.shape == places.shape[:-1]


@pytest.mark.parametrize("dtype", [np.float32, np.int64, np.float64, ">f8"])
def test_dtypes_and_strides(dtype):
    base = np.zeros((8, 6), dtype=dtype)
    wide = base[::2, ::2]
    plain = MACHINE.stiffness(np.ascontiguousarray(wide, dtype=np.float64))
    assert np.array_equal(MACHINE.stiffness(wide).matrix, plain.matrix)
    assert np.array_equal(MACHINE.stiffness(np.asfortranarray(wide)).matrix, plain.matrix)


def test_errors_show_both_shapes():
    with pytest.raises(ks.ArgumentError, match=r"wrenches has shape \(2, 5\), expected \(\.\.\., 6\)"):
        MACHINE.equilibrium(np.zeros((2, 3)), np.zeros((2, 5)))
    with pytest.raises(ks.ArgumentError, match=r"position has shape \(2,\), expected \(3,\)"):
        MACHINE.posture(position=[0, 0])


@pytest.mark.parametrize("bad", [np.nan, np.inf])
def test_numbers_that_are_not_finite(bad):
    with pytest.raises(ks.ArgumentError, match="finite"):
        MACHINE.stiffness([[0.0, bad, 0.0]])
    with pytest.raises(ks.ArgumentError, match="finite"):
        MACHINE.posture(position=[0.0, bad, 0.0])


def test_millimetres_for_metres_are_out_of_reach():
    found = MACHINE.stiffness([[0.0, 0.0, 0.0], [50.0, 0.0, 0.0]])
    assert found.status.tolist() == [ks.Status.SOLVED, ks.Status.UNSOLVED]
    assert np.isnan(found.matrix[1]).all()
    with pytest.raises(ks.UnansweredError, match="reach"):
        MACHINE.posture(position=[50.0, 0.0, 0.0])


def test_a_pose_that_mirrors_is_refused():
    mirror = np.diag([1.0, 1.0, -1.0, 1.0])
    with pytest.raises(ks.ArgumentError, match="mirrors"):
        MACHINE.stiffness(mirror[None])
