"""Steps at special values: against pseudo-elimination in numpy, written apart, and against the core. Never a wrong finite number."""

import itertools
import math
import shutil

import numpy as np
import pytest

sp = pytest.importorskip("sympy", reason="SymPy (extra sym) is not installed")

from numpy_robots import frame, turn, walk  # noqa: E402
from test_symbolic import run_printed  # noqa: E402
from test_symbolic_steps import chain_of, machine_of  # noqa: E402

import kinetostat as ks  # noqa: E402
from kinetostat import symbolic  # noqa: E402

AXES = {"x": (1.0, 0, 0), "y": (0, 1.0, 0), "z": (0, 0, 1.0)}
SPECIAL = (0.0, math.pi / 2, math.pi, -math.pi / 2)
NAMES = ("x", "y", "z", "rx", "ry", "rz")

# Joints from the base outwards: p passive, a drive; its axis; upper case slides. Behind each a link along x, y or z.
CHAINS = {
    "planar arm": ("az:x az:x az:x", ("x", "y", "rz")),
    "planar arm with a passive wrist": ("az:x pz:x az:x az:x", ("x", "y", "rz")),
    "folded rods": ("pz:x az:x pz:x az:x", ("x", "y")),
    "slides": ("Ax:y az:x Py:x az:x", ("x", "y", "rz")),
    "wrist": ("az:z ay:x ay:x ax:x ay:x ax:x", NAMES),
    "strut": ("px:z py:z Az:z sz:x pz:x py:y px:x", NAMES),
    "leg of a platform": ("ax:z ay:x sz:x ax:x sy:y sz:z py:x pz:y", NAMES),
}


def elements_of(words):
    return [(w[0].lower(), w[1].lower(), "prismatic" if w[0].isupper() else "revolute", w[3:]) for w in words.split()]


def with_symbols(words):
    """The chain with angles ``q``, lengths ``l`` and stiffnesses ``k`` as symbols."""
    chain = symbolic.Chain("special")
    for i, (role, axis, kind, link) in enumerate(elements_of(words)):
        if role == "p":
            chain.passive(f"p{i}", kind, axis, at=f"q{i}")
        else:
            chain.actuator(f"a{i}", kind, axis, stiffness=f"k{i}", at=f"q{i}")
        chain.move(**{link: f"l{i}"})
    return chain


def by_pseudo_elimination(words, directions, value):
    """``N (N^T C N)^-1 N^T`` with ``N`` orthogonal to all passive joints; None where the end is held rigidly.

    Coordinates of :func:`walk` are zero: where a joint stands is a rigid part behind it.
    """
    limb, compliances = [], []
    for i, (role, axis, kind, link) in enumerate(elements_of(words)):
        at = value[f"q{i}"]
        if role == "p":
            limb.append(("passive", kind, AXES[axis]))
        else:
            limb.append(("spring", kind, AXES[axis], value[f"k{i}"]))
            compliances.append(1 / value[f"k{i}"])
        place = frame(turn(np.array(AXES[axis]), at)) if kind == "revolute" else frame(position=at * np.array(AXES[axis]))
        limb += [("move", place), ("move", frame(position=value[f"l{i}"] * np.array(AXES[link])))]
    _, by_springs, by_passive = walk(limb, np.zeros(len(compliances)), np.zeros(len(limb)))
    rows = [NAMES.index(d) for d in directions]
    by_springs, by_passive = by_springs[rows], by_passive[rows]
    left, sizes, _ = np.linalg.svd(by_passive) if by_passive.size else (np.eye(len(rows)), np.zeros(0), None)
    outside = left[:, int((sizes > 1e-9).sum()) :]
    inner = outside.T @ (by_springs * compliances) @ by_springs.T @ outside
    if inner.size and np.linalg.svd(inner, compute_uv=False)[-1] < 1e-9:
        return None
    return outside @ np.linalg.inv(inner) @ outside.T


def drawn(words, source, angles):
    """Numbers for all symbols, with angles of joints that turn."""
    each = enumerate(elements_of(words))
    turns = {f"q{i}": angles[i] if kind == "revolute" else source.uniform(0.2, 0.8) for i, (_, _, kind, _) in each}
    count = len(turns)
    return turns | {f"{word}{i}": float(source.uniform(0.5, 3)) for word in "lk" for i in range(count)}


def settings_of(words, source):
    """All angles special, of long chains as many drawn by chance, and some special among others."""
    count = len(elements_of(words))
    every = list(itertools.product(SPECIAL, repeat=count)) if count <= 4 else source.choice(SPECIAL, (150, count))
    mixed = np.where(source.random((60, count)) < 0.6, source.choice(SPECIAL, (60, count)), source.uniform(-3, 3, (60, count)))
    return [drawn(words, source, [float(a) for a in angles]) for angles in (*every, *mixed)]


@pytest.mark.parametrize("name", CHAINS)
@pytest.mark.filterwarnings("ignore:(invalid value|divide by zero|overflow):RuntimeWarning")
def test_steps_at_special_angles(name):
    words, directions = CHAINS[name]
    found = with_symbols(words).stiffness(directions=directions, steps=True)
    evaluate, names = found.lambdify(), [s.name for s in found.symbols]
    rigid = 0
    settings = settings_of(words, np.random.default_rng(7))
    for value in settings:
        own = evaluate(*(value[n] for n in names))
        expected = by_pseudo_elimination(words, directions, value)
        if expected is None:
            assert not np.isfinite(own).all(), value
            rigid += 1
        else:
            np.testing.assert_allclose(own, expected, rtol=1e-7, atol=1e-7 * max(1.0, abs(expected).max()), err_msg=str(value))
    assert rigid < len(settings) - 20


@pytest.mark.parametrize("name", CHAINS)
def test_values_put_in_are_values_computed_with(name):
    words, directions = CHAINS[name]
    found = with_symbols(words).stiffness(directions=directions, steps=True)
    source = np.random.default_rng(11)
    exact = {0.0: sp.S.Zero, math.pi / 2: sp.pi / 2, math.pi: sp.pi, -math.pi / 2: -sp.pi / 2}
    for value in settings_of(words, source)[:: 29 if len(words.split()) < 5 else 60]:
        expected = by_pseudo_elimination(words, directions, value)
        for given in (value, {n: exact.get(v, sp.Rational(str(v))) for n, v in value.items()}):
            put_in = found.subs({s.name: given[s.name] for s in found.symbols})
            assert not put_in.definitions
            own = np.array([complex(e.evalf()).real if e.is_finite else np.nan for e in put_in.matrix]).reshape(put_in.matrix.shape)
            # Angles first, the rest later, and everything in one formula: the same.
            angles = found.subs({s.name: given[s.name] for s in found.symbols if s.name.startswith("q")})
            later = angles.subs({s.name: given[s.name] for s in angles.symbols}).matrix
            if expected is None:
                assert not np.isfinite(own).all()
                assert not all(e.is_finite for e in later)
                continue
            np.testing.assert_allclose(own, expected, rtol=1e-7, atol=1e-7 * max(1.0, abs(expected).max()))
            np.testing.assert_allclose(np.array(later.evalf(), float), own, rtol=1e-9, atol=1e-9 * max(1.0, abs(expected).max()))


def test_an_arm_in_line_is_rigid_along_it_and_right_beside_it():
    chain = with_symbols("az:x az:x az:x")
    value = {"l0": 1.1, "l1": 0.7, "l2": 0.5, "k0": 2.0, "k1": 3.0, "k2": 1.5, "q0": 0.0, "q1": 0.0, "q2": 0.0}
    along = chain.stiffness(directions=("x", "y", "rz"), steps=True).subs(value)
    assert not all(e.is_finite for e in along.matrix)
    # Levers of 2.3, 1.2 and 0.5 m.
    levers = np.array([[2.3, 1], [1.2, 1], [0.5, 1]])
    expected = np.linalg.inv(levers.T @ np.diag([1 / 2, 1 / 3, 1 / 1.5]) @ levers)
    across = chain.stiffness(directions=("y", "rz"), steps=True)
    np.testing.assert_allclose(across.lambdify()(*(value[s.name] for s in across.symbols)), expected, rtol=1e-12)


# As in test_symbolic_steps; the plus leaves out the link behind a joint.
WORDS = ("az ay ay ax ay ax", "pz sx ay Sx Az sy sz", "az+ py+ Sx+ Sy+ Sz sx sy", "px+ py+ Az+ pz+ py+ px+ sz")


@pytest.mark.parametrize("words", WORDS)
@pytest.mark.filterwarnings("ignore:(invalid value|divide by zero|overflow):RuntimeWarning")
def test_special_angles_against_the_core(words):
    """Machines whose joints stand at multiples of 90 degrees at home: what the core says of them, with free and rigid directions."""
    source = np.random.default_rng(len(words))
    elements = chain_of(words, source)
    general = symbolic.from_machine(machine_of(elements)).chain.stiffness(steps=True)
    evaluate, finite = general.lambdify(), 0
    for _ in range(5):
        for e in elements:
            if "home_rad" in e:
                e["home_rad"] = float(source.choice([*SPECIAL, source.uniform(-1, 1), 0.3]))
                if "rest_rad" in e:
                    e["rest_rad"] = e["home_rad"]
        machine = machine_of(elements)
        values = {s.name: float(v) for s, v in symbolic.from_machine(machine).values.items()}
        core = machine.posture().stiffness()
        own = evaluate(*(values[s.name] for s in general.symbols))
        if any(d.kind is ks.DirectionKind.RIGID for d in core.directions):
            assert not np.isfinite(own).all()
            continue
        np.testing.assert_allclose(own, core.matrix, rtol=1e-7, atol=1e-7 * max(1.0, abs(core.matrix).max()))
        assert np.linalg.matrix_rank(own, tol=1e-6) == core.rank
        finite += 1
    assert finite


def test_a_loaded_chain_at_special_angles():
    """Joints that stand at right angles under a load: the saddle system in numpy, no pivot chosen beforehand."""
    chain, load = with_symbols("az:x az:x az:x az:x"), [0.3, -0.2, 0, 0, 0, 0.1]
    directions, rows = ("x", "y", "rz"), [0, 1, 5]
    found = chain.stiffness(directions=directions, wrench=load, steps=True)
    jacobian, hessian = chain.jacobian().lambdify(), chain.hessian(load)
    evaluate, source = found.lambdify(), np.random.default_rng(3)
    regular = 0
    for value in settings_of("az:x az:x az:x az:x", source)[::3]:
        at = {s.name: value[s.name] for s in found.symbols}
        j = jacobian(*(value[s.name] for s in chain.jacobian().symbols))[rows]
        h = hessian.lambdify()(*(value[s.name] for s in hessian.symbols))
        springs = np.diag([value[f"k{i}"] for i in range(4)])
        saddle = np.block([[np.zeros((3, 3)), j], [j.T, h - springs]]).astype(float)
        if np.linalg.cond(saddle) > 1e10:
            continue
        expected = np.linalg.inv(saddle)[:3, :3]
        np.testing.assert_allclose(evaluate(**at), expected, rtol=1e-8, atol=1e-8 * abs(expected).max())
        regular += 1
    assert regular > 60


@pytest.mark.parametrize(("language", "compiler"), [("c", "cc"), ("rust", "rustc")])
def test_printed_steps_at_a_special_value(tmp_path, language, compiler):
    """A strut whose two passive joints fall into one line at ``a = 0``: its second one is redundant there, and the print knows it."""
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} at hand: the printed {language} is not compiled here")
    chain = symbolic.Chain().spring("s", "prismatic", "x", stiffness="K").spring("t", "prismatic", "y", stiffness="G")
    chain.spring("u", "revolute", "z", stiffness="K").passive("p", "prismatic", "x", at=0).turn("z", sp.Symbol("a", real=True) - 0.4)
    found = chain.passive("q", "prismatic", "x", at=0).stiffness(directions=("x", "y", "rz"), steps=True)
    # The value of ``a`` in run_printed is 0.4: along x nothing holds, across it the spring G, and K about z.
    expected = np.diag([0, 0.7, 1.3])
    assert np.allclose(run_printed(tmp_path, language, found), expected, rtol=1e-12, atol=1e-12)
    space = {}
    exec(found.python("f"), space)
    assert np.allclose(space["f"](**{s.name: {"G": 0.7, "K": 1.3, "a": 0.4}[s.name] for s in found.symbols}), expected, atol=1e-12)
    assert r"\begin{cases}" in found.latex()
    free = found.lambdify()(*({"G": 0.7, "K": 1.3, "a": 0.5}[s.name] for s in found.symbols))
    assert np.allclose(free, np.diag([0, 0, 1.3]), atol=1e-12)


@pytest.mark.parametrize(
    ("given", "exact"),
    [
        ([0.0, 0.0, 1.0], [0, 0, 1]),
        ([0.6, 0.0, -0.8], [sp.Rational(3, 5), 0, -sp.Rational(4, 5)]),
        (np.array([1.0, -1.0, 0.0]) / math.sqrt(2), [sp.sqrt(2) / 2, -sp.sqrt(2) / 2, 0]),
        (np.ones(3) / math.sqrt(3), [sp.sqrt(3) / 3] * 3),
    ],
)
def test_axes_in_decimals_become_exact(given, exact):
    jacobian = symbolic.Chain().passive("q", "revolute", given).move("L", "h").jacobian().matrix
    assert list(jacobian[3:]) == exact
    assert jacobian == symbolic.Chain().passive("q", "revolute", exact).move("L", "h").jacobian().matrix


def test_an_axis_of_no_nice_numbers_stays_what_it_is():
    axis = np.array([math.sin(1.0), 0.0, math.cos(1.0)])
    found = symbolic.Chain().passive("q", "revolute", axis).jacobian().matrix[3:, 0]
    np.testing.assert_allclose(np.array(found, dtype=float).reshape(3), axis, rtol=0, atol=1e-15)


def test_what_is_no_unit_vector_or_no_symbol_is_refused():
    for axis in ([0.0, 0.0, 1.1], [0, 0, 1 + 1e-9], ["a", 0, 0]):
        with pytest.raises(ks.ArgumentError, match="whose length is not 1: expected three entries of a unit vector"):
            symbolic.Chain().passive("q", "revolute", axis)
    for text in ("2*L", "0.5", "", "-L"):
        with pytest.raises(ks.ArgumentError, match="is no name of a symbol"):
            symbolic.Chain().move(text)
