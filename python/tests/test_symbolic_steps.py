"""Formulas step by step and limbs of machines: against the core at random parameters, and against compilers."""

import math
import shutil
import time

import numpy as np
import pytest

sp = pytest.importorskip("sympy", reason="SymPy (extra sym) is not installed")

from test_symbolic import run_printed  # noqa: E402

import kinetostat as ks  # noqa: E402
from kinetostat import symbolic  # noqa: E402
from kinetostat.errors import ArgumentError  # noqa: E402

PLANE = ("x", "y", "rz")


def machine_of(elements):
    """One limb from the base, the platform where its end is."""
    document = ks.Machine.preset("two_link").to_dict()
    document["chain"]["arm"]["elements"] = elements
    chain = symbolic.from_machine(ks.Machine.from_dict(document), symbols=[]).chain
    rotation = np.array(chain.end_rotation.evalf(20), float)
    home = {"position_m": [float(v) for v in chain.end.evalf(20)], "rotation_vector_rad": ks.rotation_vector(rotation).tolist()}
    document["platform"][0]["home"] = home
    return ks.Machine.from_dict(document)


def joint(word, kind, axis, home, stiffness=None, name=None):
    angle = kind == "revolute"
    element = {word: kind, "axis": axis, f"home_{'rad' if angle else 'm'}": home, "name": name}
    if word == "spring":
        element[f"rest_{'rad' if angle else 'm'}"] = home
    if stiffness is not None:
        element["stiffness_n_m_per_rad" if angle else "stiffness_n_per_m"] = stiffness
    return element


def chain_of(words, source):
    """Joints of ``words``: passive (p), drive (a), spring (s), each with an axis; upper case slides, + stays at the place before."""
    elements = []
    for i, word in enumerate(words.split()):
        kind = "prismatic" if word[0].isupper() else "revolute"
        role = {"p": "passive", "a": "actuator", "s": "spring"}[word[0].lower()]
        stiffness = None if role == "passive" else float(source.uniform(1, 3))
        elements.append(joint(role, kind, word[1], float(source.uniform(-0.9, 0.9)), stiffness, f"j{i}"))
        if not word.endswith("+"):
            elements.append({"rigid": {"translation_m": source.uniform(0.2, 0.8, 3).tolist()}, "name": f"l{i}"})
    return elements


# Rank of the stiffness: six less the independent passive joints.
CHAINS = {
    "az ay ay ax ay ax": 6,
    "az ay ay px py pz": None,
    "pz ay sz ax Sy sy Ax": 6 - 1,
    "pz sx py sz ay Sx Ay Az sx": 6 - 2,
    "px+ py+ Az+ px+ py+ pz+": 1,
    "px+ py+ pz+ Az+ pz+ px+ py+": 1,
}


@pytest.mark.parametrize("words", CHAINS)
def test_random_chains_with_all_symbols_against_the_core(words):
    source = np.random.default_rng(len(words))
    found = symbolic.from_machine(machine_of(chain_of(words, source)))
    began = time.monotonic()
    k = found.chain.stiffness(steps=True)
    assert time.monotonic() - began < 30
    assert k.definitions
    rank = CHAINS[words]
    assert rank is None or k.rank == rank
    evaluate = k.lambdify()
    for _ in range(2):
        machine = machine_of(chain_of(words, source))
        values = {s.name: float(v) for s, v in symbolic.from_machine(machine).values.items()}
        own = evaluate(*(values[s.name] for s in k.symbols))
        core = machine.posture().stiffness().matrix
        assert np.allclose(own, core, rtol=1e-8, atol=1e-8 * abs(core).max())
    assert not k.subs({s.name: values[s.name] for s in k.symbols}).definitions


@pytest.mark.parametrize("preset", ["three_link_s", "three_link_z"])
def test_presets_end_in_a_moment(preset):
    machine = ks.Machine.preset(preset)
    began = time.monotonic()
    k = symbolic.from_machine(machine).chain.stiffness(directions=PLANE, steps=True)
    assert time.monotonic() - began < 10
    assert k.rank == 1
    with pytest.raises(ArgumentError, match="use expanded"):
        k.null_space  # noqa: B018
    if preset == "three_link_z":
        found = symbolic.from_machine(machine)
        own = np.array(k.subs(found.values).matrix.evalf(), float)
        core = machine.posture().stiffness().matrix[np.ix_([0, 1, 5], [0, 1, 5])]
        assert np.allclose(own, core, rtol=1e-9, atol=1e-9)


def two_joints():
    chain = symbolic.Chain("arm").actuator("q1", "revolute", "z", stiffness="K", at="a").move("L")
    return chain.actuator("q2", "revolute", "z", stiffness="G", at="a0").move("L").passive("e", "revolute", "z", at=0)


def test_steps_and_lowest_terms_are_one_formula():
    plain = two_joints().stiffness(directions=("x", "y"))
    steps = two_joints().stiffness(directions=("x", "y"), steps=True)
    assert not plain.definitions
    values = {"G": sp.Rational(7, 10), "K": sp.Rational(13, 10), "L": sp.Rational(9, 10), "a": sp.Rational(2, 5), "a0": sp.Rational(1, 4)}
    gap = (steps.expanded().subs(values).matrix - plain.subs(values).matrix).evalf(30)
    assert max(abs(v) for v in gap) < 1e-25
    assert steps.expanded().matrix.free_symbols == plain.matrix.free_symbols
    assert [s.name for s in steps.symbols] == ["G", "K", "L", "a", "a0"]


def by_numpy(chain, springs, values, load):
    """First block of the inverse of the bordered matrix, as numbers: Jacobian and Hessian by the chain, stiffnesses given."""
    rows = [0, 1, 5]
    j = np.array(chain.jacobian().subs(values).matrix.evalf(), float)[rows]
    h = chain.hessian(load)
    inner = np.diag(springs) - np.array(h.subs({s.name: values[s.name] for s in h.symbols}).matrix.evalf(), float)
    return np.linalg.inv(np.block([[np.zeros((3, 3)), j], [j.T, -inner]]))[:3, :3]


VALUES = {"L": 0.9, "a": 0.4, "a0": 0.25}


def three_joints():
    return two_joints().actuator("q3", "revolute", "z", stiffness="G", at="b").move("L")


def test_a_loaded_chain_in_steps():
    load, values = [0.3, -0.2, 0, 0, 0, 0.1], {**VALUES, "b": -0.6}
    steps = three_joints().stiffness(directions=PLANE, wrench=load, steps=True)
    own = np.array(steps.subs({**values, "G": 0.7, "K": 1.3}).matrix.evalf(), float)
    expected = by_numpy(three_joints(), [1.3, 0.7, 0, 0.7], values, load)
    assert np.allclose(own, expected, rtol=1e-10, atol=1e-12)


@pytest.mark.parametrize(("language", "compiler"), [("c", "cc"), ("rust", "rustc")])
def test_printed_steps_run(tmp_path, language, compiler):
    if shutil.which(compiler) is None:
        pytest.skip(f"no {compiler} at hand: the printed {language} is not compiled here")
    # Arguments of the printed function are the names that run_printed has values for.
    chain = two_joints().actuator("q3", "revolute", "z", stiffness="G", at=0).move("L")
    found = chain.stiffness(directions=PLANE, steps=True)
    expected = by_numpy(chain, [1.3, 0.7, 0, 0.7], VALUES, [0] * 6)
    values = {**VALUES, "G": 0.7, "K": 1.3}
    assert np.allclose(run_printed(tmp_path, language, found), expected, rtol=1e-12, atol=1e-13)
    space = {}
    exec(found.python("f"), space)
    assert np.allclose(space["f"](**values), expected, rtol=1e-12, atol=1e-13)


def test_latex_has_the_definitions_first():
    text = two_joints().stiffness(directions=("x", "y"), steps=True).latex()
    assert text.index("s_{0} &=") < text.index("s_{1} &=") < text.index("matrix")
    assert text.startswith(r"\begin{aligned}")


def test_names_of_steps_give_way():
    chain = symbolic.Chain().actuator("s0", "revolute", "z", stiffness="s1").move("L").actuator("s2", "revolute", "z", stiffness="k")
    k = chain.move("L").stiffness(directions=("x", "y"), steps=True)
    assert [s.name for s in k.symbols] == ["L", "k", "s0", "s1", "s2"]
    defined = {s.name for s, _ in k.definitions}
    assert not defined & {"s0", "s1", "s2"}
    name = next(iter(defined))
    again = k.subs({"k": name})
    assert name in {s.name for s in again.symbols}
    numbers = {"s0": 0.2, "s1": 2, "s2": 0.5, "L": 0.7}
    left = np.array(again.subs({**numbers, name: 3}).matrix.evalf(), float)
    assert np.allclose(left, np.array(k.subs({**numbers, "k": 3}).matrix.evalf(), float), rtol=1e-13)


def tripod():
    """Three struts from the ground to a platform that their feet do not lie symmetrically about; each with springs at its foot."""
    builder = ks.MachineBuilder("tripod")
    builder.platform("tool", [0, 0, 1])
    for i, (x, y) in enumerate([(0.8, 0.1), (-0.5, 0.7), (-0.4, -0.6)]):
        pose = ks.pose([x, y, 0], ks.rotation_from_vector(np.radians([10 * i, 5, 90 * i])))
        limb = builder.limb(f"strut {i}", to="tool", start=pose)
        limb.spring6("foot", [1e7, 2e7, 3e7, 4e5, 5e5, 6e5]).passive("u", "revolute", "x").passive("v", "revolute", "y")
        limb.actuator("slide", "prismatic", "z", 2e6, home=math.dist((x, y, 0), (0, 0, 1)))
        limb.passive("a", "revolute", "z").passive("b", "revolute", "y").passive("c", "revolute", "x")
    return builder.machine()


def test_limbs_of_a_machine_add_up_to_its_stiffness():
    machine = tripod()
    with pytest.raises(ArgumentError, match=r"3 limbs: say which with limb= \('strut 0', 'strut 1', 'strut 2'\)"):
        symbolic.from_machine(machine)
    with pytest.raises(ArgumentError, match="no limb 'leg'; limbs: 'strut 0'"):
        symbolic.from_machine(machine, limb="leg")
    found = [symbolic.from_machine(machine, ["stiffnesses"], limb=name) for name in machine.limbs]
    total = symbolic.in_parallel([f.chain.stiffness(steps=True) for f in found], [[0, 0, 0]] * 3)
    own = np.array(total.subs({"k_slide": 2e6}).matrix.evalf(), float)
    core = machine.posture().stiffness().matrix
    assert np.allclose(own, core, rtol=1e-8, atol=1e-8 * abs(core).max())


PLACEMENTS = [
    {"rotation_vector_deg": [10, 20, 30]},
    {"rotation_vector_rad": [0, 0, 0.5]},
    {"rotation_intrinsic_xyz_deg": [10, -20, 30]},
    {"roll_pitch_yaw_urdf_deg": [10, -20, 30]},
    {"roll_pitch_yaw_urdf_rad": [0.1, -0.2, 0.3]},
    {"a_b_c_kuka_deg": [40, 50, 60]},
    {"w_p_r_fanuc_deg": [40, 50, 60]},
    {"quaternion_wxyz": [0.8, 0.6, 0, 0]},
    {"quaternion_xyzw": [0.5, -0.5, 0.5, 0.5]},
    {"x_axis": [1, 2, -1]},
    {"x_axis": "z"},
    {"x_axis": "-y", "y_axis": "z"},
]


@pytest.mark.parametrize("placement", PLACEMENTS, ids=str)
def test_turned_rigid_parts_start_and_end_against_the_core(placement):
    builder = ks.MachineBuilder("turned")
    builder.platform("tool", [0.3, 0.1, 0.2])
    limb = builder.limb("arm", to="tool").spring6("root", [1e7, 2e7, 3e7, 4e5, 5e5, 6e5])
    limb.rigid([0.3, 0.1, 0.2]).actuator("q", "prismatic", "z", 1e6).passive("p", "revolute", "x")
    document = builder.machine().to_dict()
    rigid = next(e for e in document["chain"]["arm"]["elements"] if "rigid" in e)["rigid"]
    rigid.update(placement)
    document["limb"][0]["start"] = {"position_mm": [100, 0, 50], **placement}
    document["limb"][0]["end"] = {"position_m": [0.1, 0.2, 0.3], **placement}
    chain = symbolic.from_machine(ks.Machine.from_dict(document), symbols=[]).chain
    rotation = np.array(chain.end_rotation.evalf(20), float)
    place = [float(v) for v in chain.end.evalf(20)]
    document["platform"][0]["home"] = {"position_m": place, "rotation_vector_rad": ks.rotation_vector(rotation).tolist()}
    core = ks.Machine.from_dict(document).posture().stiffness()
    assert core.rank == 5
    own = chain.stiffness(steps=True).lambdify()()
    assert np.allclose(own, core.matrix, rtol=1e-9, atol=1e-9 * abs(core.matrix).max())


def test_what_loads_the_machine_is_refused_in_words():
    document = ks.Machine.preset("three_link_z").to_dict()
    loaded = {**document, "load": [{"wrench": "push", "platform": "tool", "axes": "base", "force_n": [0.1, 0, 0]}]}
    with pytest.raises(ArgumentError, match="loads of its own; leave"):
        symbolic.from_machine(ks.Machine.from_dict(loaded))
    off = {**document, "deviation": [{"limb": "arm", "at": "first link", "longer_by_mm": 0.1}]}
    with pytest.raises(ArgumentError, match="deviations"):
        symbolic.from_machine(ks.Machine.from_dict(off))
    heavy = {**document, "platform": [{**document["platform"][0], "mass_kg": 2.0}]}
    heavy["mechanism"] = {**document["mechanism"], "gravity_m_per_s2": [0, 0, -9.81]}
    with pytest.raises(ArgumentError, match=r"weights \(tool\): set gravity_m_per_s2 to \[0, 0, 0\]"):
        symbolic.from_machine(ks.Machine.from_dict(heavy))
    heavy["mechanism"]["gravity_m_per_s2"] = [0, 0, 0]
    assert symbolic.from_machine(ks.Machine.from_dict(heavy)).chain.coordinates == ("q", "th1", "th2", "e")


def test_links_with_steps_are_refused_where_formulas_are_needed():
    k = two_joints().stiffness(directions=("x", "y"), steps=True)
    with pytest.raises(ArgumentError, match="has steps"):
        symbolic.with_passive_joint(k, "x")
    with pytest.raises(ArgumentError, match="has steps"):
        symbolic.Chain().spring6("s", k)


@pytest.mark.parametrize("without", [["k1"], ["k2"], ["k3"], ["k1", "k2"], ["k2", "k3"]])
def test_a_stiffness_of_zero_is_a_passive_joint_or_refused(without):
    chain = symbolic.Chain("arm")
    for i in "123":
        chain = chain.actuator(f"q{i}", "revolute", "z", stiffness=f"k{i}").move(f"L{i}")
    angles, lengths, k = np.array([0.3, 0.5, -0.4]), np.array([1.0, 0.8, 0.5]), np.array([1e5, 2e5, 3e5])
    k[[int(name[1]) - 1 for name in without]] = 0
    values = {f"{word}{i + 1}": float(each[i]) for word, each in (("q", angles), ("L", lengths), ("k", k)) for i in range(3)}
    unloaded = chain.stiffness(directions=PLANE, steps=True)
    with pytest.raises(ArgumentError, match=f"values makes {without[0]} zero, and steps divide by it: make a spring without stiffness"):
        unloaded.subs(values)
    with pytest.raises(ArgumentError, match=r"values makes k\d zero"):
        unloaded.subs({without[-1]: 0})

    # The same arm in numpy: springs with stiffness bend, the others are passive joints [R 3.7, 3.8].
    along = np.cumsum(angles)
    links = np.stack([lengths * np.cos(along), lengths * np.sin(along)])
    levers = links[:, ::-1].cumsum(axis=1)[:, ::-1]
    jacobian = np.stack([-levers[1], levers[0], np.ones(3)])
    stiff, free = k > 0, k == 0
    compliance = jacobian[:, stiff] @ np.diag(1 / k[stiff]) @ jacobian[:, stiff].T
    passive = jacobian[:, free]
    bordered = np.block([[compliance, passive], [passive.T, np.zeros((free.sum(),) * 2)]])
    expected = np.linalg.inv(bordered)[:3, :3]
    found = chain.stiffness(directions=PLANE, wrench=[0] * 6, steps=True)
    np.testing.assert_allclose(np.array(found.subs(values).matrix.evalf(), float), expected, rtol=1e-9, atol=1e-6)
    np.testing.assert_allclose(found.lambdify()(**{s.name: values[s.name] for s in found.symbols}), expected, rtol=1e-9, atol=1e-6)
