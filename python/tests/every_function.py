"""All public functions of the package, each with arguments that are right: what `test_every_argument.py` replaces one by one."""

from __future__ import annotations

import enum
import importlib
import inspect
import pkgutil
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import numpy as np

import kinetostat as ks
from kinetostat import chatter, commands, maps, measured, shares, sweep, symbolic, tolerance, vibration
from kinetostat.sweep._example import squares

MACHINE = ks.Machine.preset("orthoglide")
ARM = ks.Machine.preset("heavy_6r")
POSTURE = MACHINE.posture([0.01, 0.02, -0.01])
STRUT = ks.Machine.preset("three_link_z").posture()
PROGRAM = "G21 G90\nG0 X0 Y0 Z5\nG1 Z-1 F300\nG1 X5\nM2\n"
MAP = MACHINE.map(x=[-0.02, 0.02], y=[0.0, 0.03])
SPREAD = {"chain.leg.q2.length_mm": tolerance.normal(0.01)}
PUSH = {"direction": [1, 0, 0], "displacement": (0, -0.002), "points": 10}

VIBRATION = ARM.posture().vibration()
TAPPED = {"stiffness": [1.34e6], "frequencies_hz": [922], "damping_ratios": [0.011]}
TIP = chatter.tool_modes([[1, 0, 0]], **TAPPED)
CUT = chatter.MillingCut(2, 1.0, True, (6e8, 2e8, 0.0))

MADE = {"Posture", "Stiffness", "Equilibrium", "Machine", "Vibration", "Damping"}
"""Classes whose objects functions of the package make, from what its compiled part gives them."""

SOME_ELSE = {"RayExecutor"}
"""What takes the arguments of another library, and needs it."""


def cable(poses: Any) -> Any:
    return ks.wrench(-1000 * poses[..., :3, 3])


def limb() -> Any:
    return ks.LimbBuilder("arm")


def builder() -> Any:
    return ks.MachineBuilder("made")


def chain() -> Any:
    return symbolic.Chain("arm").actuator("q", "revolute", "z", stiffness="k").move("L").node("tip")


def arguments(folder: Path) -> dict[str, tuple[Callable[..., Any], dict[str, Any]]]:
    """By name of the function: the function, and arguments that are right. A name before a point is a class or a module."""
    source = folder / "in.ngc"
    source.write_text(PROGRAM)
    sweep.to_folder(folder / "sweep", squares, 5, chunk=2)
    out = str(folder / "out.ngc")
    written = {"program": source, "out": out, "force": [10, 0, 0], "force_overwrite": True}
    points = np.array([[1e-3 * x, 5e-5, -1e-3] for x in range(6)])
    drawn = tolerance.machines(MACHINE, SPREAD, [[0, 0, 0]], quantities=["error"], draws=16)
    found = STRUT.curve(**PUSH)
    many = {"poses": [[0, 0, 0.01]], "threads": 1, "progress": None}
    place = {"position": [0.01, 0, 0], "direction": "x", "progress": None}
    wrench = [10, 0, 0, 0, 1, 0]
    held = {"hold": None, "free": None, "constant_force": None, "constant_moment": None, "loads": None, "progress": None}
    return {
        "kinetostat.Machine.preset": (ks.Machine.preset, {"name": "two_link"}),
        "kinetostat.Machine.open": (ks.Machine.open, {"path": "two_link"}),
        "kinetostat.Machine.from_toml": (ks.Machine.from_toml, {"text": MACHINE.text, "file": "mine.toml"}),
        "kinetostat.Machine.from_dict": (ks.Machine.from_dict, {"document": MACHINE.to_dict(), "file": "mine"}),
        "kinetostat.Machine.from_urdf": (ks.Machine.from_urdf, {"robot": URDF, "tip": "hook", "stiffness": 2e5}),
        "kinetostat.Machine.save": (MACHINE.save, {"path": folder / "model.toml"}),
        "kinetostat.Machine.with_tool": (MACHINE.with_tool, {"tool": np.eye(4)}),
        "kinetostat.Machine.posture": (MACHINE.posture, {"position": [0.01, 0, 0]}),
        "kinetostat.Machine.stiffness": (MACHINE.stiffness, many),
        "kinetostat.Machine.shares": (MACHINE.shares, place),
        "kinetostat.Machine.equilibrium": (MACHINE.equilibrium, {**many, "wrenches": wrench}),
        "kinetostat.Machine.targets": (MACHINE.targets, {**many, "wrenches": wrench}),
        "kinetostat.Machine.map": (MACHINE.map, {"x": [0.0, 0.01], "loads": wrench}),
        "kinetostat.Machine.compensate": (MACHINE.compensate, written),
        "kinetostat.Machine.drawing": (MACHINE.drawing, {"posture": POSTURE}),
        "kinetostat.Machine.view": (MACHINE.view, {"posture": POSTURE, "force": [1, 0, 0], "moment": [0, 1, 0]}),
        "kinetostat.Machine.to_pyvista": (MACHINE.to_pyvista, {"posture": POSTURE}),
        "kinetostat.Posture.to_pyvista": (POSTURE.to_pyvista, {"axes": 0.1}),
        "kinetostat.Posture.deflected_by": (POSTURE.deflected_by, {"wrench": wrench}),
        "kinetostat.Posture.held_at": (POSTURE.held_at, {"pose": POSTURE.target}),
        "kinetostat.Posture.under": (POSTURE.under, {"model": cable}),
        "kinetostat.Posture.equilibrium_problem": (POSTURE.equilibrium_problem, {"wrench": wrench}),
        "kinetostat.Posture.curve": (STRUT.curve, PUSH),
        "kinetostat.Posture.shapes": (POSTURE.shapes, {"displaced": [1e-3, 0, 0], "starts": 2, **held}),
        "kinetostat.Posture.shares": (POSTURE.shares, {"direction": "x", "wrench": wrench}),
        "kinetostat.Posture.assembly": (POSTURE.assembly, {"deviations": ["leg x:foot arm:1deg about x"]}),
        "kinetostat.EquilibriumProblem": (ks.EquilibriumProblem, {"posture": POSTURE, "wrench": wrench}),
        "kinetostat.EquilibriumProblem.tool": (POSTURE.equilibrium_problem().tool, {"x": np.zeros(6)}),
        "kinetostat.EquilibriumProblem.residual": (POSTURE.equilibrium_problem().residual, {"x": np.zeros(6)}),
        "kinetostat.EquilibriumProblem.jacobian": (POSTURE.equilibrium_problem().jacobian, {"x": np.zeros(6)}),
        "kinetostat.LimbBuilder": (ks.LimbBuilder, {"name": "arm"}),
        "kinetostat.LimbBuilder.rigid": (limb().rigid, {"pose": [1, 0, 0], "name": "post"}),
        "kinetostat.LimbBuilder.actuator": (limb().actuator, {"name": "q", "kind": "revolute", "axis": "z", "stiffness": 1e5}),
        "kinetostat.LimbBuilder.passive": (limb().passive, {"name": "q", "kind": "revolute", "axis": "z"}),
        "kinetostat.LimbBuilder.spring": (limb().spring, {"name": "q", "kind": "revolute", "axis": "z", "stiffness": 1e5}),
        "kinetostat.LimbBuilder.spring6": (limb().spring6, {"name": "q", "stiffness": np.ones(6)}),
        "kinetostat.LimbBuilder.link": (limb().link, {"name": "boom", "section": "tube", "length": 1.0}),
        "kinetostat.LimbBuilder.node": (limb().node, {"name": "elbow"}),
        "kinetostat.LimbBuilder.body": (limb().body, {"name": "motor", "mass": 2.0}),
        "kinetostat.LimbBuilder.element": (limb().element, {"element": {"node": "elbow"}}),
        "kinetostat.LimbBuilder.wrench": (limb().wrench, {"name": "hose", "node": "elbow"}),
        "kinetostat.LimbBuilder.load": (limb().load, {"load": {"counterweight": "w"}}),
        "kinetostat.MachineBuilder": (ks.MachineBuilder, {"name": "made"}),
        "kinetostat.MachineBuilder.platform": (builder().platform, {"name": "tool", "home": [0, 0, 1]}),
        "kinetostat.MachineBuilder.section": (lambda **given: builder().section(**given), {"name": "bar"}),
        "kinetostat.MachineBuilder.limb": (lambda **given: builder().limb(**given), {"name": "arm", "to": "tool"}),
        "kinetostat.MachineBuilder.load": (builder().load, {"load": {"wrench": "hose"}}),
        "kinetostat.MachineBuilder.save": (rail().save, {"path": folder / "rail.toml"}),
        "kinetostat.correct_program": (ks.correct_program, {"program": PROGRAM, "field": lambda places, directions: 0 * places}),
        "kinetostat.equilibrium_under": (ks.equilibrium_under, {"where": MACHINE, "model": cable, "poses": [[0, 0, 0.01]]}),
        "kinetostat.pose": (ks.pose, {}),
        "kinetostat.rotation_from_vector": (ks.rotation_from_vector, {"vector": [0, 0, 1]}),
        "kinetostat.rotation_vector": (ks.rotation_vector, {"rotation": np.eye(3)}),
        "kinetostat.wrench": (ks.wrench, {}),
        "kinetostat.assembly.assembly": (ks.assembly.assembly, {"posture": POSTURE}),
        "kinetostat.build.placement": (importlib.import_module("kinetostat.build").placement, {"pose": np.eye(4)}),
        "kinetostat.compensation.compensate": (ks.compensation.compensate, {"machine": MACHINE, **written}),
        "kinetostat.curves.curve": (ks.curves.curve, {"posture": STRUT, **PUSH}),
        "kinetostat.curves.critical_load": (ks.curves.critical_load, {"posture": STRUT, "force": [-1, 0, 0], "most": 1.0, "points": 10}),
        "kinetostat.curves.ForceCurve.plot": (found.plot, {}),
        "kinetostat.cutting.milling_force": (ks.cutting.milling_force, {}),
        "kinetostat.display.table": (display().table, {"head": ["a"], "rows": [[1.0]]}),
        "kinetostat.display.machine_html": (display().machine_html, {"machine": MACHINE}),
        "kinetostat.display.posture_html": (display().posture_html, {"posture": POSTURE}),
        "kinetostat.display.stiffness_html": (display().stiffness_html, {"stiffness": POSTURE.stiffness()}),
        "kinetostat.display.equilibrium_html": (display().equilibrium_html, {"equilibrium": POSTURE.deflected_by(wrench)}),
        "kinetostat.maps.evaluate": (maps.evaluate, {"machine": MACHINE, "x": [0.0, 0.01], "loads": wrench}),
        "kinetostat.maps.best_and_worst": (maps.best_and_worst, {"found": MAP, "variable": "stiffness_x"}),
        "kinetostat.maps.plot": (maps.plot, {"found": MAP, "variable": "stiffness_x"}),
        "kinetostat.maps.to_parquet": (maps.to_parquet, {"found": MAP, "path": folder / "map.parquet"}),
        "kinetostat.maps.to_pyvista": (maps.to_pyvista, {"found": MAP}),
        "kinetostat.maps.to_vtk": (maps.to_vtk, {"found": MAP, "path": folder / "map.vtu"}),
        "kinetostat.measured.mirror": (
            measured.mirror,
            {"program": source, "measured": points, "out": out, "register": "none", "force_overwrite": True},
        ),
        "kinetostat.Machine.frames": (ARM.frames, {"joints": [[0.0] * 6]}),
        "kinetostat.Machine.inverse_solutions": (ARM.inverse_solutions, {"pose": ARM.home}),
        "kinetostat.Posture.jacobian": (POSTURE.jacobian, {"of": "theta", "at": "tip", "limb": "leg x"}),
        "kinetostat.Posture.joint_stiffness": (POSTURE.joint_stiffness, {"limb": "leg x"}),
        "kinetostat.Posture.load_hessian": (POSTURE.load_hessian, {"wrench": wrench, "limb": "leg x"}),
        "kinetostat.Posture.coordinates": (POSTURE.coordinates, {"of": "all", "limb": "leg x"}),
        "kinetostat.Posture.gradients": (POSTURE.gradients, {"paths": ["chain.leg.q2.length_mm"], "wrench": wrench}),
        "kinetostat.plot.force_curve": (ks.plot.force_curve, {"curve": found}),
        "kinetostat.plot.modes": (ks.plot.modes, {"vibration": VIBRATION}),
        "kinetostat.plot.response": (ks.plot.response, {"vibration": VIBRATION, "damping": 0.03}),
        "kinetostat.plot.lobes": (ks.plot.lobes, {"found": chatter.lobes(TIP, CUT, [5000.0], up_to=1e-3)}),
        "kinetostat.plot.shares": (ks.plot.shares, {"found": POSTURE.shares("x")}),
        "kinetostat.plot.tolerance": (ks.plot.tolerance, {"found": drawn}),
        "kinetostat.shapes.shapes": (ks.shapes.shapes, {"posture": POSTURE, "displaced": [1e-3, 0, 0], "starts": 2}),
        "kinetostat.shares.shares": (shares.shares, {"machine": MACHINE, **place}),
        "kinetostat.shares.sensitivities": (shares.sensitivities, {"machine": MACHINE, **place, "wrench": wrench}),
        "kinetostat.shares.cheapest_stiffening": (shares.cheapest_stiffening, {"machine": MACHINE, "less": 0.2, **place}),
        "kinetostat.shares.Shares.by": (POSTURE.shares("x").by, {"what": "limb"}),
        "kinetostat.sweep.run": (sweep.run, {"function": squares, "count": 5}),
        "kinetostat.sweep.to_folder": (sweep.to_folder, {"folder": folder / "sweep", "function": squares, "count": 5, "chunk": 2}),
        "kinetostat.sweep.verify": (sweep.verify, {"folder": folder / "sweep"}),
        "kinetostat.sweep.chunks": (sweep.chunks, {"folder": folder / "sweep"}),
        "kinetostat.sweep.read": (sweep.read, {"folder": folder / "sweep"}),
        "kinetostat.symbolic.Chain": (symbolic.Chain, {"name": "arm"}),
        "kinetostat.symbolic.Chain.move": (chain().move, {"x": 1}),
        "kinetostat.symbolic.Chain.turn": (chain().turn, {"axis": "z", "angle": "a"}),
        "kinetostat.symbolic.Chain.place": (chain().place, {"position": [0, 0, 1], "rotation": np.eye(3, dtype=int)}),
        "kinetostat.symbolic.Chain.node": (lambda **given: chain().node(**given), {"name": "elbow"}),
        "kinetostat.symbolic.Chain.passive": (chain().passive, {"name": "p", "kind": "revolute", "axis": "z"}),
        "kinetostat.symbolic.Chain.actuator": (chain().actuator, {"name": "p", "kind": "revolute", "axis": "z", "stiffness": "c"}),
        "kinetostat.symbolic.Chain.spring": (chain().spring, {"name": "p", "kind": "revolute", "axis": "z", "stiffness": "c"}),
        "kinetostat.symbolic.Chain.spring6": (lambda **given: chain().spring6(**given), {"name": "p", "stiffness": "C"}),
        "kinetostat.symbolic.Chain.jacobian": (chain().jacobian, {"of": "all", "node": "tip"}),
        "kinetostat.symbolic.Chain.compliance": (chain().compliance, {"directions": ("y", "rz")}),
        "kinetostat.symbolic.Chain.hessian": (chain().hessian, {"wrench": ["F", 0, 0, 0, 0, 0]}),
        "kinetostat.symbolic.Chain.stiffness": (chain().stiffness, {"directions": ("y",)}),
        "kinetostat.symbolic.Formula": (symbolic.Formula, {"matrix": symbolic.beam().matrix}),
        "kinetostat.symbolic.Formula.subs": (symbolic.beam().subs, {"values": {"E": 1}}),
        "kinetostat.symbolic.Formula.c": (symbolic.beam().c, {"name": "k"}),
        "kinetostat.symbolic.Formula.rust": (symbolic.beam().rust, {"name": "k"}),
        "kinetostat.symbolic.Formula.python": (symbolic.beam().python, {"name": "k"}),
        "kinetostat.symbolic.Formula.lambdify": (symbolic.beam().lambdify, {}),
        "kinetostat.symbolic.Stiffness": (symbolic.Stiffness, {"matrix": symbolic.beam().matrix}),
        "kinetostat.symbolic.from_machine": (symbolic.from_machine, {"machine": ks.Machine.preset("two_link")}),
        "kinetostat.symbolic.in_parallel": (symbolic.in_parallel, {"limbs": [symbolic.beam()], "arms": [[0, 0, 0]]}),
        "kinetostat.symbolic.leg": (symbolic.leg, {"direction": [0, 0, 1], "stiffness": "k"}),
        "kinetostat.symbolic.substitute": (symbolic.substitute, {"expression": symbolic.beam().matrix, "values": {"E": 1}}),
        "kinetostat.symbolic.with_passive_joint": (symbolic.with_passive_joint, {"link": symbolic.planar_beam(), "joint": "rz"}),
        "kinetostat.Posture.vibration": (ARM.posture().vibration, {"wrench": wrench, "held": ["x"]}),
        "kinetostat.vibration.vibration_of": (vibration.vibration_of, {"posture": ARM.posture(), "wrench": wrench, "held": ["x"]}),
        "kinetostat.vibration.Vibration.damping_ratios": (VIBRATION.damping_ratios, {"damping": 0.03}),
        "kinetostat.vibration.Vibration.complex_modes": (VIBRATION.complex_modes, {"damping": 0.03}),
        "kinetostat.vibration.Vibration.reduced": (VIBRATION.reduced, {"kept": 3}),
        "kinetostat.vibration.Vibration.response": (VIBRATION.response, {"frequencies_hz": [1.0], "damping": 0.03}),
        "kinetostat.vibration.Vibration.shares": (VIBRATION.shares, {"mode": 0}),
        "kinetostat.vibration.Vibration.tool_modes": (VIBRATION.tool_modes, {"damping": 0.03}),
        "kinetostat.vibration.Damping.ratio": (vibration.Damping.ratio, {"ratio": 0.03}),
        "kinetostat.vibration.Damping.rayleigh": (vibration.Damping.rayleigh, {"mass_per_s": 2.0, "stiffness_s": 1e-4}),
        "kinetostat.vibration.Damping.structural": (vibration.Damping.structural, {"loss_factor": 0.05}),
        "kinetostat.chatter.coupled_limit": (chatter.coupled_limit, {"tool": TIP, "chip": [1, 1, 0], "force": [1, -1, 0]}),
        "kinetostat.chatter.lobes": (chatter.lobes, {"tool": TIP, "cut": CUT, "speeds_rpm": [5000.0], "up_to": 1e-3}),
        "kinetostat.chatter.multipliers": (chatter.multipliers, {"tool": TIP, "cut": CUT, "speeds_rpm": [5000.0], "depths": [1e-3]}),
        "kinetostat.chatter.tool_modes": (chatter.tool_modes, {"directions": [[1, 0, 0]], **TAPPED}),
        "kinetostat.tolerance.Distribution": (tolerance.Distribution, {"word": "normal", "spread": 1.0}),
        "kinetostat.tolerance.MachineSamples.column": (drawn.column, {"name": "error_mm"}),
        "kinetostat.tolerance.draws": (tolerance.draws, {"values": [1.0], "spread": [tolerance.normal(1)], "n": 16}),
        "kinetostat.tolerance.machines": (
            tolerance.machines,
            {"machine": MACHINE, "spread": SPREAD, "poses": [[0, 0, 0]], "quantities": ["error"], "draws": 16},
        ),
        "kinetostat.tolerance.normal": (tolerance.normal, {"deviation": 1.0}),
        "kinetostat.tolerance.sobol": (
            tolerance.sobol,
            {"function": lambda x: x[:, 0], "values": [1.0], "spread": [tolerance.normal(1)], "n": 128},
        ),
        "kinetostat.tolerance.triangular": (tolerance.triangular, {"half_width": 1.0}),
        "kinetostat.tolerance.uniform": (tolerance.uniform, {"half_width": 1.0}),
        "kinetostat.page.View": (ks.page.View, {"posture": POSTURE, "wrench": [1, 0, 0, 0, 0, 0]}),
        "kinetostat.page.View.live": (MACHINE.view().live, {"height": 400}),
        "kinetostat.page.View.save": (MACHINE.view().save, {"path": folder / "page.html"}),
        "kinetostat.view.to_pyvista": (ks.view.to_pyvista, {"posture": POSTURE}),
        "kinetostat.commands.run": (commands.run, {"words": ["model", "list"]}),
    }


FORWARDED = {
    "kinetostat.Machine.compensate": "kinetostat.compensation.compensate",
    "kinetostat.Machine.drawing": "kinetostat.commands.model_draw",
    "kinetostat.Posture.under": "kinetostat.equilibrium_under",
    "kinetostat.Posture.curve": "kinetostat.curves.curve",
    "kinetostat.Posture.shapes": "kinetostat.shapes.shapes",
    "kinetostat.Posture.assembly": "kinetostat.assembly.assembly",
    "kinetostat.compensation.compensate": "kinetostat.commands.compensate",
    "kinetostat.curves.critical_load": "kinetostat.curves.curve",
    "kinetostat.cutting.milling_force": "kinetostat.commands.force",
    "kinetostat.measured.mirror": "kinetostat.commands.mirror",
}
"""Functions with further arguments by name, and the function that takes them."""

URDF = """<robot name="crane"><link name="post"/><link name="boom"/>
<joint name="shoulder" type="revolute"><parent link="post"/><child link="boom"/>
<origin xyz="0 0 1.5"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
<link name="hook"/><joint name="end" type="fixed"><origin xyz="1 0 0"/>
<parent link="boom"/><child link="hook"/></joint></robot>"""


def display() -> Any:
    return importlib.import_module("kinetostat.display")


def rail() -> Any:
    made = ks.MachineBuilder("rail")
    made.platform("tool", [0, 0, 0])
    made.limb("x", to="tool").actuator("x", "prismatic", "x", 1e7)
    return made


def modules() -> Iterator[Any]:
    """The package and all modules that are public."""
    yield ks
    for found in pkgutil.iter_modules(ks.__path__, "kinetostat."):
        if not found.name.rpartition(".")[2].startswith("_"):
            yield importlib.import_module(found.name)


def public() -> dict[str, Callable[..., Any]]:
    """All functions that take arguments, and classes that are made by their users, by the first name under which they are found."""
    found: dict[str, Callable[..., Any]] = {}
    seen: set[int] = set()
    for module in modules():
        for name in getattr(module, "__all__", []):
            value = getattr(module, name)
            if id(value) in seen or name in SOME_ELSE:
                continue
            seen.add(id(value))
            found.update(_functions(f"{module.__name__}.{name}", value))
    return {name: function for name, function in found.items() if parameters(function) or name in FORWARDED}


def _functions(name: str, value: Any) -> Iterator[tuple[str, Callable[..., Any]]]:
    if inspect.isfunction(value):
        yield name, value
    if not inspect.isclass(value) or issubclass(value, (Exception, enum.Enum, tuple)):
        return
    # Dataclasses are answers, but for those that say what is wanted.
    if "__dataclass_fields__" in vars(value):
        made = value.__name__ in ("Distribution", "Formula") or value is symbolic.Stiffness
    else:
        made = value.__name__ not in MADE
    if made:
        yield name, value
    for own, method in vars(value).items():
        plain = getattr(method, "__func__", method)
        if not own.startswith("_") and inspect.isfunction(plain):
            yield f"{name}.{own}", plain


def parameters(function: Callable[..., Any]) -> list[str]:
    """Names of the arguments that a function takes, but for further ones by name."""
    found = inspect.signature(function).parameters
    variable = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    return [name for name, one in found.items() if name not in ("self", "cls") and one.kind not in variable]


def takes_more(function: Callable[..., Any]) -> bool:
    """Whether it takes further arguments by name."""
    return any(one.kind is inspect.Parameter.VAR_KEYWORD for one in inspect.signature(function).parameters.values())
