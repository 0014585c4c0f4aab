"""Formulas against the report's tables, the core, differences, and compilers."""

import doctest
import importlib
import keyword
import math
import re
import shutil
import subprocess
import sys
import time

import numpy as np
import pytest

sp = pytest.importorskip("sympy", reason="SymPy (extra sym) is not installed")

import kinetostat as ks  # noqa: E402
from kinetostat import symbolic  # noqa: E402
from kinetostat.errors import ArgumentError  # noqa: E402

a, L, K, G, a0 = sp.symbols("a L K G a0", real=True)


def equal(found, expected):
    assert (sp.Matrix(found) - sp.Matrix(expected)).applyfunc(sp.simplify) == sp.zeros(*sp.Matrix(found).shape)


def two_links():
    chain = symbolic.Chain("two").passive("q1", "revolute", "z", at=a).move(L).node("middle")
    chain.actuator("theta", "revolute", "z", stiffness=K, at=-2 * a).move(L)
    chain.passive("q2", "revolute", "z", at=a)
    force = -G * sp.cos(a) / (2 * sp.sin(a)) - 2 * K / L * (a - a0) / sp.sin(a)
    return chain, [force, G / 2, 0, 0, 0, 0], {"middle": [0, -G, 0, 0, 0, 0]}


def test_table_3_1():
    names = sp.Matrix(3, 3, lambda i, j: sp.Symbol(f"K{min(i, j) + 1}{max(i, j) + 1}"))
    link = symbolic.Stiffness(names, ("x", "y", "rz"))
    for p, joint in enumerate(link.directions):
        expected = sp.Matrix(3, 3, lambda i, j, p=p: names[i, j] - names[i, p] * names[p, j] / names[p, p])
        found = symbolic.with_passive_joint(link, joint)
        equal(found.matrix, expected)
        assert len(found.null_space) == 1
    E, A, length, i_z = sp.symbols("E A L I_z", positive=True)
    beam = symbolic.planar_beam()
    equal(symbolic.with_passive_joint(beam, "y").matrix, sp.diag(E * A / length, 0, E * i_z / length))
    equal(symbolic.with_passive_joint(beam, "rz").matrix, sp.diag(E * A / length, 3 * E * i_z / length**3, 0))


# What a joint at the end does to a beam: factors of entries, 0 where they vanish.
TABLE_3_2 = {
    "x": {(0, 0): 0},
    "y": {(1, 1): 0, (1, 5): 0, (5, 5): sp.Rational(1, 4)},
    "z": {(2, 2): 0, (2, 4): 0, (4, 4): sp.Rational(1, 4)},
    "rx": {(3, 3): 0},
    "ry": {(2, 2): sp.Rational(1, 4), (2, 4): 0, (4, 4): 0},
    "rz": {(1, 1): sp.Rational(1, 4), (1, 5): 0, (5, 5): 0},
}


def scaled(matrix, factors):
    out = matrix.as_mutable()
    for (i, j), factor in factors.items():
        out[i, j] = matrix[i, j] * factor
        out[j, i] = out[i, j]
    return out


@pytest.mark.parametrize("joint", TABLE_3_2)
def test_table_3_2(joint):
    beam = symbolic.beam()
    found = symbolic.with_passive_joint(beam, joint)
    equal(found.matrix, scaled(beam.matrix, TABLE_3_2[joint]))
    assert found.rank == 5
    again = symbolic.with_passive_joint(found, joint)
    assert again.redundant == (joint,)


def test_table_3_3():
    beam, length = symbolic.beam(), sp.Symbol("L", positive=True)
    quarter, half, three = sp.Rational(1, 4), sp.Rational(1, 2), sp.Rational(3, 4)
    at_root = symbolic.with_passive_joint(beam, [0, 0, -length, 0, 1, 0])
    equal(at_root.matrix, scaled(beam.matrix, {(2, 2): quarter, (2, 4): half, (4, 4): three}))
    at_root = symbolic.with_passive_joint(beam, [0, length, 0, 0, 0, 1])
    equal(at_root.matrix, scaled(beam.matrix, {(1, 1): quarter, (1, 5): half, (5, 5): three}))


def platform(angles):
    R, r, h, k = sp.symbols("R r h K11", positive=True)
    legs, arms = [], []
    for below, above in angles:
        phi, psi = sp.rad(below), sp.rad(above)
        arm = [r * sp.cos(psi), r * sp.sin(psi), 0]
        legs.append(symbolic.leg([arm[0] - R * sp.cos(phi), arm[1] - R * sp.sin(phi), h], k))
        arms.append(arm)
    return symbolic.in_parallel(legs, arms)


def test_equations_3_34_and_3_35():
    R, r, h, k = sp.symbols("R r h K11", positive=True)
    cases = [([(60 * i, 60 * i) for i in range(6)], R - r, 0, 0, 3), (
        [(0, 60), (120, 60), (120, 180), (240, 180), (240, 300), (360, 300)], R / 2 - r, R * r, sp.Rational(3, 2) * (r * R) ** 2, 6
    )]  # fmt: skip
    for angles, across, more, twist, rank in cases:
        d2 = (R - r) ** 2 + more
        expected = sp.diag(d2, d2, 2 * h**2, (r * h) ** 2, (r * h) ** 2, twist)
        expected[0, 4] = expected[4, 0] = r * h * across
        expected[1, 3] = expected[3, 1] = -r * h * across
        found = platform(angles)
        equal(found.matrix, 3 * k / (d2 + h**2) * expected)
        assert found.rank == rank
    numbers = {R: 0.5, r: 0.3, h: 0.6, k: 1e6}
    assert math.isclose(found.matrix[0, 4].subs(numbers), -49090.9090909, rel_tol=1e-10)


def test_equations_4_31_and_4_32():
    chain, wrench, loads = two_links()
    balance = chain.jacobian().matrix.T * sp.Matrix(wrench) + chain.jacobian(node="middle").matrix.T * sp.Matrix(loads["middle"])
    equal(balance, [0, K * (-2 * a + 2 * a0), 0])
    k = chain.stiffness(directions=("x", "y", "rz"), wrench=wrench, loads=loads).matrix
    equal([k[0, 0]], [-G / (4 * L * sp.sin(a) ** 3) - K / L**2 * ((a - a0) * sp.cos(a) - sp.sin(a)) / sp.sin(a) ** 3])
    equal([k[1, 1]], [(wrench[0] - G / 2 * sp.tan(a)) / (2 * L * sp.cos(a))])
    assert k[0, 1] == 0
    table = [(0, 0.345442152, 6.694450654), (0.5, 0.2617993878, 7.464101615), (1.5, 0.1348178805, -52.7085385)]
    for g, angle, expected in table:
        value = k[0, 0].subs({L: 1, K: 1, a0: math.pi / 12, G: 4 * g * math.sin(math.pi / 12), a: angle})
        assert math.isclose(float(value), expected, rel_tol=2e-7)


def arm_dictionary(lengths, stiffness, home):
    elements = []
    for i, (length, k, axis) in enumerate(zip(lengths, stiffness, "zyyxyx", strict=True)):
        elements.append({"actuator": "revolute", "name": f"a{i}", "axis": axis, "stiffness_n_m_per_rad": k, "home_deg": home[i]})
        elements.append({"rigid": {"translation_mm": length}, "name": f"l{i}"})
    document = ks.Machine.preset("two_link").to_dict()
    document["chain"]["arm"]["elements"] = elements
    return document


def test_random_arms_against_the_core():
    source = np.random.default_rng(5)
    for _ in range(3):
        lengths = source.uniform(100, 900, (6, 3)).round(3).tolist()
        stiffness, home = source.uniform(1e4, 1e6, 6).round(2).tolist(), source.uniform(-60, 60, 6).round(2).tolist()
        document = arm_dictionary(lengths, stiffness, home)
        chain = symbolic.Chain("arm")
        for i, axis in enumerate("zyyxyx"):
            chain.actuator(f"a{i}", "revolute", axis, stiffness=stiffness[i], at=math.radians(home[i]))
            chain.move(*(v / 1000 for v in lengths[i]))
        pose = np.eye(4)
        pose[:3, :3], pose[:3, 3] = np.array(chain.end_rotation, float), np.array(chain.end, float)[:, 0]
        vector = np.degrees(ks.rotation_vector(pose[:3, :3]))
        document["platform"][0]["home"] = {"position_mm": (pose[:3, 3] * 1000).tolist(), "rotation_vector_deg": vector.tolist()}
        core = ks.Machine.from_dict(document).posture(joints=np.radians(home)).stiffness().matrix
        compliance = np.array(chain.compliance().matrix, float)
        assert np.abs(core @ compliance - np.eye(6)).max() < 1e-8


def test_machine_with_names_against_the_core():
    machine = ks.Machine.preset("two_link")
    found = symbolic.from_machine(machine)
    k = found.chain.stiffness(directions=("x", "y", "rz"), wrench=[0] * 6).matrix.subs(found.values)
    core = machine.posture().stiffness().matrix
    assert abs(np.array(k.evalf(), float) - core[np.ix_([0, 1, 5], [0, 1, 5])]).max() < 1e-9
    assert math.isclose(core[0, 0], 14.92820323, rel_tol=1e-9)


def test_jacobian_and_hessian_against_differences():
    q = sp.symbols("q0:4", real=True)

    def chain():
        out = symbolic.Chain()
        for i, (kind, axis) in enumerate([("revolute", "z"), ("prismatic", "x"), ("revolute", "y"), ("revolute", "x")]):
            out.passive(f"q{i}", kind, axis, at=q[i]).move(0.3, 0.1 * i, -0.2)
        return out

    wrench = [3.0, -2.0, 5.0, 0.7, -0.4, 0.2]
    torque = sp.lambdify(q, chain().jacobian().matrix.T * sp.Matrix(wrench))
    place = sp.lambdify(q, chain().end)
    at, step = np.array([0.3, 0.2, -0.5, 0.8]), 1e-6
    h = np.array(chain().hessian(wrench).matrix.subs(dict(zip(q, at, strict=True))), float)
    j = np.array(chain().jacobian().matrix.subs(dict(zip(q, at, strict=True))), float)
    for i in range(4):
        d = step * np.eye(4)[i]
        assert np.allclose((torque(*(at + d)) - torque(*(at - d)))[:, 0] / (2 * step), h[:, i], atol=1e-8)
        assert np.allclose((place(*(at + d)) - place(*(at - d)))[:, 0] / (2 * step), j[:3, i], atol=1e-8)


def test_redundant_and_rigid_are_named():
    chain = symbolic.Chain("strut").passive("foot", "revolute", "z", at=0).spring("s", "prismatic", "z", stiffness="k")
    chain.passive("head", "revolute", "z", at=0)
    found = chain.stiffness(directions=("z", "rz"))
    assert found.redundant == ("head",)
    equal(found.matrix, sp.diag(sp.Symbol("k", real=True), 0))
    with pytest.raises(ArgumentError, match="held rigidly along a combination of x"):
        chain.stiffness(directions=("x", "z"))
    with pytest.raises(ArgumentError, match="3 limbs"):
        symbolic.from_machine(ks.Machine.preset("orthoglide"))


def formula():
    chain, wrench, loads = two_links()
    return chain.stiffness(directions=("x", "y", "rz"), wrench=wrench, loads=loads)


VALUES = {"G": 0.7, "K": 1.3, "L": 0.9, "a": 0.4, "a0": 0.25}


def run_printed(tmp_path, language, found):
    names = [s.name for s in found.symbols]
    numbers = ", ".join(repr(VALUES[n]) for n in names)
    if language == "c":
        body = f'int main(void) {{ double o[9]; f({numbers}, o); for (int i = 0; i < 9; i++) printf("%.17g\\n", o[i]); return 0; }}'
        (tmp_path / "f.c").write_text(f"#include <stdio.h>\n{found.c('f')}\n{body}\n", encoding="utf-8")
        subprocess.run(["cc", "-std=c99", "-Wall", "-Werror", "f.c", "-o", "f", "-lm"], cwd=tmp_path, check=True)
    else:
        body = f'fn main() {{ for v in f({numbers}) {{ println!("{{v:e}}"); }} }}'
        (tmp_path / "f.rs").write_text(f"{found.rust('f')}\n{body}\n", encoding="utf-8")
        subprocess.run(["rustc", "-D", "warnings", "f.rs", "-o", "f"], cwd=tmp_path, check=True)
    text = subprocess.run([str(tmp_path / "f")], check=True, capture_output=True, text=True).stdout
    return np.array(text.split(), float).reshape(3, 3)


@pytest.mark.parametrize(("language", "compiler"), [("c", "cc"), ("rust", "rustc")])
def test_printed_code_runs(tmp_path, language, compiler):
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} at hand: the printed {language} is not compiled here")
    found = formula()
    expected = np.array(found.matrix.subs({s: VALUES[s.name] for s in found.symbols}).evalf(), float)
    assert np.allclose(run_printed(tmp_path, language, found), expected, rtol=1e-12, atol=1e-13)


def test_printed_python_and_lambdify():
    found = formula()
    expected = np.array(found.matrix.subs({s: VALUES[s.name] for s in found.symbols}).evalf(), float)
    space = {}
    exec(found.python("f"), space)
    assert np.allclose(space["f"](**{s.name: VALUES[s.name] for s in found.symbols}), expected, rtol=1e-12, atol=1e-13)
    assert np.allclose(found.lambdify(list(VALUES))(*VALUES.values()), expected, rtol=1e-12, atol=1e-13)


@pytest.mark.parametrize("name", ["", "._chain", "._expression", "._links", "._machine"])
def test_examples_run(name):
    module = importlib.import_module(f"kinetostat.symbolic{name}")
    found = doctest.testmod(module)
    assert found.attempted > 0
    assert found.failed == 0


def test_sympy_is_imported_only_when_used():
    code = "import sys, kinetostat; sys.exit('sympy' in sys.modules)"
    assert subprocess.run([sys.executable, "-c", code], check=False).returncode == 0


def test_names_stand_for_symbols_of_any_assumptions():
    k = symbolic.beam()
    numbers = {"E": 210e9, "G": 80e9, "A": 6e-4, "L": 0.7, "I_y": 3e-8, "I_z": 7e-8, "J": 9e-8}
    # SymPy's own does nothing with them: that is why there is ours.
    assert k.matrix.subs(numbers) == k.matrix
    found = k.subs(numbers)
    assert type(found) is type(k)
    assert found.directions == k.directions
    assert not found.matrix.free_symbols
    wanted = 4 * 210e9 * 3e-8 / 0.7
    assert math.isclose(found.matrix[4, 4], wanted, rel_tol=1e-15)
    assert math.isclose(symbolic.substitute(k.matrix[4, 4], {s: numbers[s.name] for s in k.symbols}), wanted, rel_tol=1e-15)
    # Some only, and by other symbols; all at once.
    assert symbolic.substitute(k.matrix[0, 0], {"A": 1, "L": 1}) == sp.Symbol("E", positive=True)
    a, b = sp.symbols("a b", positive=True)
    assert symbolic.substitute(a - b, {"a": b, "b": a}) == b - a
    # One name with two assumptions in one formula: both.
    assert symbolic.substitute(a + sp.Symbol("a"), {"a": 2}) == 4


def test_values_of_a_machine_may_be_more_than_a_formula_has():
    found = symbolic.from_machine(ks.Machine.preset("two_link"))
    place = symbolic.substitute(found.chain.end, found.values)
    assert math.isclose(float(place[0]), 2 * math.cos(math.pi / 12), rel_tol=1e-14)


@pytest.mark.parametrize(
    ("values", "words"),
    [
        ({"K": 1}, "no symbol 'K'; its symbols are A, E, L"),
        ({3: 1}, "expected a name or a symbol"),
        ({"A": 1, sp.Symbol("A", positive=True): 2}, "'A' is given twice: 1 and 2"),
    ],
)
def test_names_that_would_change_nothing_are_refused(values, words):
    with pytest.raises(ks.ArgumentError, match=words):
        symbolic.substitute(symbolic.beam().matrix[0, 0], values)


def test_presets_from_machine_are_covered_or_refused_with_a_reason():
    covered, reasons = {}, {}
    for name in ks.preset_names():
        try:
            covered[name] = symbolic.from_machine(ks.Machine.preset(name))
        except ArgumentError as refused:
            reasons[name] = str(refused)
    real = r"it has ([02-9]|\d\d+) limbs|of limb '.*is not covered|element .*(is not covered by|formulas (need|cover))|it has weights"
    assert [words for words in reasons.values() if not re.search(real, words)] == []
    assert sorted(covered) == ["three_link_s", "three_link_z", "two_link"]
    found = covered["three_link_s"]
    values = {s.name: v for s, v in found.values.items()}
    springs = found.chain.jacobian(of="springs")
    assert springs.subs({s.name: values[s.name] for s in springs.symbols}).matrix.evalf().shape[0] == 6


def test_a_built_arm_against_the_core():
    b = ks.MachineBuilder("arm")
    b.platform("tool", [0.9, 0, 0.1])
    arm = b.limb("arm", to="tool").actuator("q1", "revolute", "z", 1e5, limits=(-2, 2), rating=100).rigid([0.5, 0, 0])
    arm.actuator("q2", "revolute", [0, 1, 0], 2e5).spring("give", "prismatic", "y", 3e6).rigid([0.4, 0, 0.1])
    arm.spring6("flange", [1e8, 2e8, 3e8, 1e6, 2e6, 3e6])
    machine = b.machine()
    found = symbolic.from_machine(machine)
    compliance = found.chain.compliance()
    rng = np.random.default_rng(5)
    for commands in rng.uniform(-1, 1, (4, 2)):
        values = {s.name: v for s, v in found.values.items()} | {"q1": commands[0], "q2": commands[1]}
        own = np.array(compliance.subs({s.name: values[s.name] for s in compliance.symbols}).matrix.evalf(), float)
        core = machine.posture(joints=commands).stiffness().matrix
        assert np.allclose(np.linalg.inv(own), core, rtol=1e-9, atol=1e-9 * abs(core).max())


WORDS = [*keyword.kwlist, *keyword.softkwlist, "math", "abs", "out", "t0", "t1", "", "1a", "None_", "sin_"]
WORDS += [
    "auto",
    "restrict",
    "sin",
    "cos",
    "sqrt",
    "pow",
    "exp",
    "inline",
    "register",
    "typedef",
    "_Bool",
    "_Generic",
    "M_PI",
    "NAN",
    "asm",
    "unix",
    "double",
]
WORDS += ["fn", "let", "mut", "self", "Self", "dyn", "try", "yield", "box", "virtual", "Some", "Ok", "Err", "f64", "std"]


def words_as_names():
    names = [sp.Symbol(word, real=True) for word in dict.fromkeys(WORDS)]
    total = sum((i + 1) * s for i, s in enumerate(names))
    return symbolic.Formula(sp.Matrix([[sp.sin(total) * sp.sqrt(total**2 + 2), sp.cos(total) ** 3, sp.exp(-total) + total]]))


def test_any_name_makes_python():
    space = {}
    found = words_as_names()
    values = [0.001 * i for i in range(len(found.symbols))]
    exec(found.python("f"), space)
    expected = np.array(found.matrix.subs(dict(zip(found.symbols, values, strict=True))).evalf(), float)
    assert np.allclose(space["f"](*values), expected, rtol=1e-12)


@pytest.mark.parametrize(("language", "compiler", "standard"), [("c", "cc", "c99"), ("c", "cc", "gnu11"), ("rust", "rustc", "")])
def test_any_name_compiles(tmp_path, language, compiler, standard):
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} at hand: the printed {language} is not compiled here")
    found = words_as_names()
    file = tmp_path / ("f.c" if language == "c" else "f.rs")
    file.write_text(getattr(found, language)("f"), encoding="utf-8")
    words = ["cc", f"-std={standard}", "-Wall", "-Werror", "-c"] if language == "c" else ["rustc", "--crate-type=lib"]
    subprocess.run([*words, str(file), "-o", str(tmp_path / "f.o")], cwd=tmp_path, check=True)


@pytest.mark.parametrize("name", ["sin", "cos", "pi", "array", "exp", "nan", "select", "E"])
def test_a_symbol_may_be_called_like_a_function_or_a_constant(name):
    q, k = sp.Symbol(name, real=True), sp.Symbol("k", positive=True)
    found = symbolic.Formula(sp.Matrix([[sp.pi * q + sp.sin(q), sp.cos(q) * sp.exp(k)]]))
    expected = [[np.pi * 0.3 + np.sin(0.3), np.cos(0.3) * np.exp(2)]]
    assert np.allclose(found.lambdify([name, "k"])(0.3, 2.0), expected, rtol=1e-14)
    # A bar of length pi that turns by q, with a second spring along it: whether formulas are zero is decided at numbers.
    arm = symbolic.Chain().actuator(name, "revolute", "z", stiffness="k").move(sp.pi).spring("s", "prismatic", "x", stiffness="c")
    turned = sp.Matrix([[sp.cos(q), -sp.sin(q)], [sp.sin(q), sp.cos(q)]])
    whole = turned * sp.diag(sp.Symbol("c", positive=True), k / sp.pi**2) * turned.T
    found = arm.stiffness(directions=("x", "y"))
    values = {"k": 2.0, "c": 5.0, name: 0.3}
    own = np.array(symbolic.Formula(whole).subs(values).matrix.evalf(), float)
    assert np.allclose(np.array(found.subs(values).matrix.evalf(), float), own, rtol=1e-12)
    assert found.rank == 2


def test_the_rank_of_long_formulas_takes_no_time():
    chain = symbolic.Chain().actuator("q", "revolute", "z", stiffness="k").move("L").actuator("p", "revolute", "y", stiffness="c").move("M")
    chain = chain.actuator("r", "revolute", "z", stiffness="n").move("N").passive("b", "revolute", "y", at=0).move("O")
    found = chain.compliance()
    before = time.perf_counter()
    assert symbolic.Stiffness(found.matrix).rank == 3
    assert time.perf_counter() - before < 5
