"""Arrays of any shape, type, stride and value: an answer, or an error of the package that says what was expected."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st
from hypothesis.extra import numpy as arrays

import kinetostat as ks

pytestmark = pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")

MACHINE = ks.Machine.preset("orthoglide")
ARM = ks.Machine.preset("heavy_6r")
PLACES = np.random.default_rng(3).uniform(-0.05, 0.05, (6, 3))

anything = settings(max_examples=60, deadline=None, suppress_health_check=[HealthCheck.too_slow])
numbers = st.one_of(st.floats(), st.sampled_from([0.0, -0.0, 1e308, -1e308, 5e-324, np.nan, np.inf, -np.inf]))
dtypes = st.one_of(
    arrays.floating_dtypes(),
    arrays.integer_dtypes(),
    arrays.boolean_dtypes(),
    arrays.complex_number_dtypes(),
    arrays.unicode_string_dtypes(),
    arrays.byte_string_dtypes(),
    arrays.datetime64_dtypes(),
)
any_array = dtypes.flatmap(lambda dtype: arrays.arrays(dtype, arrays.array_shapes(min_dims=0, max_dims=4, min_side=0, max_side=6)))
junk = st.one_of(any_array, st.none(), st.text(), st.lists(st.one_of(numbers, st.lists(numbers, max_size=7)), max_size=7))


def asked(question):
    """The answer, or None where the package refuses it in words; anything else is a fault."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", np.exceptions.ComplexWarning if hasattr(np, "exceptions") else Warning)
            return question()
    except ks.KinetostatError as refused:
        said = str(refused).strip()
    assert said
    assert "panick" not in said
    return None


def never_silent(result):
    """Every row that is called solved has numbers; every other none."""
    if result is None or result.status.size == 0:
        return
    for name, array in result.to_dict().items():
        if array is None or name in ("status", "stable", "share_to_buckling", "commands", "targets"):
            continue
        rows = array.reshape(result.status.size, -1)
        finite = np.isfinite(rows).all(axis=1)
        assert finite[result.solved.ravel()].all(), name


@anything
@given(junk, junk)
def test_any_poses_and_wrenches(poses, wrenches):
    never_silent(asked(lambda: MACHINE.stiffness(poses)))
    never_silent(asked(lambda: MACHINE.equilibrium(poses, wrenches)))
    never_silent(asked(lambda: MACHINE.targets(poses, wrenches)))


@anything
@given(junk)
def test_any_joints(joints):
    never_silent(asked(lambda: ARM.stiffness(joints=joints)))
    asked(lambda: ARM.posture(joints=joints))
    asked(lambda: MACHINE.stiffness(joints=joints))


@anything
@given(junk, junk)
def test_any_place_of_one_posture(position, rotation):
    for machine in (MACHINE, ARM):
        posture = asked(lambda machine=machine: machine.posture(position, rotation))
        if posture is not None:
            asked(posture.stiffness)


@anything
@given(arrays.arrays(np.float64, (3, 3), elements=numbers), arrays.arrays(np.float64, (2, 6), elements=numbers))
def test_right_shapes_of_any_numbers(places, wrenches):
    never_silent(asked(lambda: MACHINE.stiffness(places)))
    never_silent(asked(lambda: MACHINE.equilibrium(places[:2], wrenches)))
    never_silent(asked(lambda: MACHINE.targets(places[:2], wrenches)))


@settings(anything, max_examples=15)
@given(arrays.arrays(np.float64, 6, elements=st.floats(-1e12, 1e12)))
def test_any_load(load):
    found = asked(lambda: MACHINE.posture().deflected_by(load))
    if found is not None:
        assert np.isfinite(found.displacement).all()
    never_silent(asked(lambda: MACHINE.equilibrium([[0, 0, 0]], load)))


@pytest.mark.parametrize("dtype", [np.float16, np.float32, np.longdouble, ">f8", "<f8", ">f4"])
def test_types_of_numbers(dtype):
    given_places = PLACES.astype(dtype)
    wanted = MACHINE.stiffness(given_places.astype(np.float64)).matrix
    np.testing.assert_array_equal(MACHINE.stiffness(given_places).matrix, wanted)


def test_whole_numbers():
    np.testing.assert_array_equal(MACHINE.stiffness(np.zeros((1, 3), dtype=np.int8)).matrix, MACHINE.stiffness([[0.0, 0, 0]]).matrix)


def strided(array):
    """The same numbers with other strides."""
    spread = np.full((2 * array.shape[0], *array.shape[1:], 3), np.nan)
    spread[::2, ..., 1] = array
    yield "every second", spread[::2, ..., 1]
    yield "Fortran", np.asfortranarray(array)
    yield "backwards", array[::-1].copy()[::-1]
    yield "transposed", np.ascontiguousarray(array.swapaxes(0, -1)).swapaxes(0, -1)
    read_only = array.copy()
    read_only.flags.writeable = False
    yield "read-only", read_only
    # One byte beside where a float64 begins.
    raw = np.zeros(array.nbytes + 1, dtype=np.uint8)
    shifted = raw[1:].view(np.float64).reshape(array.shape)
    shifted[...] = array
    yield "unaligned", shifted


def test_strides():
    poses = ks.pose(PLACES, MACHINE.home[:3, :3])
    load = np.tile(ks.wrench([100, -20, -30]), (len(PLACES), 1)) * np.linspace(0.5, 1, len(PLACES))[:, None]
    wanted = MACHINE.equilibrium(poses, load)
    for (name, places), (_, wrenches) in zip(strided(poses), strided(load), strict=True):
        found = MACHINE.equilibrium(places, wrenches)
        np.testing.assert_array_equal(found.tool, wanted.tool, err_msg=name)
        np.testing.assert_array_equal(found.stiffness, wanted.stiffness, err_msg=name)


def test_leading_axes():
    grid = PLACES.reshape(2, 3, 3)
    found = MACHINE.equilibrium(grid, [100, 0, 0, 0, 0, 0])
    assert found.tool.shape == (2, 3, 4, 4)
    assert found.status.shape == (2, 3)
    np.testing.assert_array_equal(found.tool.reshape(6, 4, 4), MACHINE.equilibrium(PLACES, [100, 0, 0, 0, 0, 0]).tool)
    assert MACHINE.stiffness(PLACES[0]).matrix.shape == (6, 6)
    assert MACHINE.stiffness(np.empty((0, 3))).matrix.shape == (0, 6, 6)


@pytest.mark.parametrize(
    ("ask", "words"),
    [
        (lambda: MACHINE.stiffness(np.zeros((4, 5))), ("(4, 5)", "(..., 3)")),
        (lambda: MACHINE.equilibrium(np.zeros((4, 3)), np.zeros((3, 6))), ("(3, 6)", "(4, 6)")),
        (lambda: MACHINE.posture(position=[0, 0]), ("(2,)", "(3,)")),
        (lambda: MACHINE.posture(position=[0, np.nan, 0]), ("position", "nan")),
        (lambda: MACHINE.stiffness([[0, 0, np.inf]]), ("inf", "finite")),
        (lambda: MACHINE.stiffness(np.zeros((1, 4, 4))), ("0 0 0 1",)),
        (lambda: MACHINE.stiffness([[1j, 0, 0]]), ("complex",)),
        (lambda: MACHINE.stiffness([[0, 0, 0]], threads=0), ("threads", "0")),
        (lambda: ks.rotation_vector(2 * np.eye(3)), ("no rotation",)),
    ],
)
def test_messages_show_what_was_found_and_expected(ask, words):
    with pytest.raises(ks.ArgumentError) as refused:
        ask()
    for word in words:
        assert word in str(refused.value)


def test_millimetres_where_metres_belong():
    """The usual slip: the place is out of reach, and the message says how far."""
    with pytest.raises(ks.UnansweredError, match="cannot be reached; the nearest pose found is 49690 mm"):
        MACHINE.posture(position=[50.0, 0.0, 0.0])
    many = MACHINE.stiffness([[50.0, 0.0, 0.0], [0.05, 0.0, 0.0]])
    assert many.status.tolist()[0] == ks.Status.UNSOLVED
    assert np.isnan(many.matrix[0]).all()
    assert many.solved.tolist() == [False, True]


@pytest.mark.parametrize("text", ["", "schema = 1", "schema = 2", "\0", "[mechanism", "schema = 1\n[mechanism]\nname = 3"])
def test_models_that_are_none(text):
    with pytest.raises(ks.ModelError) as refused:
        ks.Machine.from_toml(text, "mine.toml")
    assert "mine.toml" in str(refused.value)
