"""Texts of URDF from paths and from objects of other libraries."""

from __future__ import annotations

import json
import math
import os
import re
import xml.etree.ElementTree as ElementTree
from collections.abc import Mapping, Sequence
from typing import Any, Literal

import numpy as np

from kinetostat import _core
from kinetostat._arguments import mapping, one_of, or_none, path, refused, shown, text, text_or_none, texts
from kinetostat._arrays import Floats, one, real
from kinetostat.errors import ArgumentError, ModelError

__all__ = ["model_text", "with_ratings"]

_WRITERS = ("write_xml_string", "to_xml_string")
_UNIT = 1e-12
_STIFFNESS_UNITS = ("N m/rad", "N mm/rad", "N m/deg", "N/m", "N/mm", "N/um")
_ENDLESS = 1e300
"""Pinocchio writes the largest number where a joint has no limit."""


def model_text(
    robot: object,
    base: str | None,
    tip: str | None,
    passive: Sequence[str],
    home: Mapping[str, tuple[Literal["revolute", "prismatic"], float]] | None,
    stiffness: float | Sequence[float] | Mapping[str, float | tuple[float, str]] | None,
) -> tuple[str, str, str, Floats | None, list[str]]:
    """Model file of a robot, name for messages, text of its URDF, gravity (3,) in m/s^2 where it is stated, notices of the import.

    Arguments as given to ``Machine.from_urdf``; they are checked here.
    """
    base, tip, idle = text_or_none("base", base), text_or_none("tip", tip), texts("passive", passive, "a list of names of joints")
    stands = {} if home is None else stands_at(home)
    listed = isinstance(stiffness, (Sequence, np.ndarray)) and not isinstance(stiffness, str)
    single = None if listed or isinstance(stiffness, Mapping) else or_none(real, "stiffness", stiffness)
    urdf, file, gravity = text_of(robot)
    try:
        table = None
        if listed or isinstance(stiffness, Mapping):
            rigid, _ = _core.urdf_to_toml(urdf, file, base, tip, idle, stands, None, None)
            chains = json.loads(_core.Machine.from_toml(rigid, file).to_json())["chain"].values()
            drives = {each["name"]: each["actuator"] for chain in chains for each in chain["elements"] if each.get("actuator")}
            if listed:
                values = one("stiffness", stiffness, (len(drives),)).tolist()  # type: ignore[arg-type]
                stiffness = dict(zip(drives, values, strict=True))
            table = stiffness_table(stiffness, drives)  # type: ignore[arg-type]
        toml, notices = _core.urdf_to_toml(urdf, file, base, tip, idle, stands, single, table)
    except ModelError as wrong:
        raise ModelError(in_words_of_python(str(wrong))) from None
    # Lines in messages are those of the model, which is its text, not those of the URDF.
    return toml, f"model made of {file}", urdf, gravity, notices


def text_of(robot: object) -> tuple[str, str, Floats | None]:
    """Text of the URDF, a name for messages, and gravity (3,) in m/s^2 where the object states it."""
    for method in _WRITERS:
        if hasattr(robot, method):
            text = getattr(robot, method)()
            return text.decode() if isinstance(text, bytes) else str(text), f"{type(robot).__name__}.urdf", None
    # Wrappers of Pinocchio hold their model.
    models: list[Any] = [robot, getattr(robot, "model", None)]
    for model in models:
        if hasattr(model, "jointPlacements") and hasattr(model, "inertias"):
            return _of_pinocchio(model), f"{model.name or 'model'} of Pinocchio", np.array(model.gravity.linear, dtype=np.float64)
    if isinstance(robot, str) and robot.lstrip().startswith("<"):
        return robot, "text.urdf", None
    if isinstance(robot, (str, os.PathLike)):
        name = path("robot", robot)
        try:
            with open(name, encoding="utf-8-sig") as file:
                return file.read(), name, None
        except UnicodeDecodeError as wrong:
            raise ArgumentError(f"robot is {shown(name)}, expected a URDF as text in UTF-8: {wrong}") from None
    raise ArgumentError(
        f"robot is a {type(robot).__name__}, expected a path, the text of a URDF, an object of yourdfpy or urdf_parser_py, "
        "or a model of Pinocchio"
    )


def _of_pinocchio(model: Any) -> str:
    """A URDF with the tree of joints, placements, inertias and limits of a model: links are its bodies, frames fixed links."""
    root = ElementTree.Element("robot", name=str(model.name or "model"))
    frames = [frame for frame in model.frames if getattr(frame.type, "name", str(frame.type)) in ("BODY", "OP_FRAME")]
    carriers: list[str] = []
    taken: set[str] = set()
    for joint in range(model.njoints):
        own = (f for f in frames if f.parentJoint == joint and np.array_equal(_matrix(f.placement), np.eye(4)))
        carriers.append(next((str(f.name) for f in own), str(model.names[joint])))
        taken.add(carriers[-1])
        _link(root, carriers[-1], model.inertias[joint] if joint else None)
    for joint in range(1, model.njoints):
        _joint(root, model, joint, carriers)
    for frame in frames:
        if str(frame.name) in taken:
            continue
        taken.add(str(frame.name))
        _link(root, str(frame.name), None)
        fixed = ElementTree.SubElement(root, "joint", name=f"to {frame.name}", type="fixed")
        _between(fixed, carriers[frame.parentJoint], str(frame.name), _matrix(frame.placement))
    return ElementTree.tostring(root, encoding="unicode")


def _joint(root: ElementTree.Element, model: Any, joint: int, carriers: list[str]) -> None:
    name, kind = str(model.names[joint]), str(model.joints[joint].shortname())
    model_of_joint = model.joints[joint]
    if model_of_joint.nv != 1 or "Mimic" in kind:
        raise ArgumentError(
            f"joint {name!r} is a {kind}: a URDF of a machine has joints of one freedom that turn or slide, each by itself"
            + ("; build the model without a root joint" if kind == "JointModelFreeFlyer" else "")
        )
    first = int(model_of_joint.idx_q)
    # The joint's motion in its own frame, linear, then angular; joints without bounds have cosine and sine for coordinates.
    zero = np.zeros(model.nq)
    zero[first] = float(model_of_joint.nq == 2)
    data = model_of_joint.createData()
    model_of_joint.calc(data, zero)
    motion = np.array(data.S, dtype=np.float64).reshape(6)
    slides = abs(np.linalg.norm(motion[:3]) - 1) < _UNIT and not motion[3:].any()
    turns = abs(np.linalg.norm(motion[3:]) - 1) < _UNIT and not motion[:3].any()
    if not slides and not turns:
        raise ArgumentError(f"joint {name!r} is a {kind}, expected one that turns or slides")
    lower, upper = float(model.lowerPositionLimit[first]), float(model.upperPositionLimit[first])
    bounded = model_of_joint.nq == 1 and -_ENDLESS < lower <= upper < _ENDLESS
    if slides and not bounded:
        raise ArgumentError(f"joint {name!r} slides without limits, and a URDF has to state them: set them in the model first")
    element = ElementTree.SubElement(root, "joint", name=name, type="prismatic" if slides else "revolute" if bounded else "continuous")
    _between(element, carriers[model.parents[joint]], carriers[joint], _matrix(model.jointPlacements[joint]))
    ElementTree.SubElement(element, "axis", xyz=_numbers(motion[:3] if slides else motion[3:]))
    if bounded:
        efforts = getattr(model, "upperEffortLimit", None)
        effort = float((model.effortLimit if efforts is None else efforts)[model_of_joint.idx_v])
        ElementTree.SubElement(
            element,
            "limit",
            lower=repr(lower),
            upper=repr(upper),
            effort=repr(effort if effort < _ENDLESS else 0.0),
            velocity="0",
        )


def _link(root: ElementTree.Element, name: str, inertia: Any) -> None:
    link = ElementTree.SubElement(root, "link", name=name)
    if inertia is None or not inertia.mass > 0:
        return
    element = ElementTree.SubElement(link, "inertial")
    ElementTree.SubElement(element, "origin", xyz=_numbers(inertia.lever))
    ElementTree.SubElement(element, "mass", value=repr(float(inertia.mass)))
    matrix = np.array(inertia.inertia, dtype=np.float64)
    parts = {f"i{'xyz'[i]}{'xyz'[j]}": repr(float(matrix[i, j])) for i in range(3) for j in range(i, 3)}
    ElementTree.SubElement(element, "inertia", parts)


def _between(element: ElementTree.Element, parent: str, child: str, pose: Floats) -> None:
    ElementTree.SubElement(element, "parent", link=parent)
    ElementTree.SubElement(element, "child", link=child)
    ElementTree.SubElement(element, "origin", xyz=_numbers(pose[:3, 3]), rpy=_numbers(_roll_pitch_yaw(pose[:3, :3])))


def _matrix(placement: Any) -> Floats:
    return np.array(placement.homogeneous, dtype=np.float64)


def _numbers(values: Any) -> str:
    return " ".join(repr(float(x)) for x in np.asarray(values).reshape(-1))


def _roll_pitch_yaw(matrix: Floats) -> Floats:
    """Of Rz(yaw) Ry(pitch) Rx(roll); where the pitch is a right angle, without roll."""
    flat = math.hypot(matrix[0, 0], matrix[1, 0])
    pitch = math.atan2(-matrix[2, 0], flat)
    if flat < 1e-9:
        return np.array([0.0, pitch, math.atan2(-matrix[0, 1], matrix[1, 1])])
    return np.array([math.atan2(matrix[2, 1], matrix[2, 2]), pitch, math.atan2(matrix[1, 0], matrix[0, 0])])


def stiffness_table(stiffness: Mapping[str, float | tuple[float, str]], drives: Mapping[str, str]) -> str:
    """Stiffness of joints by name as a table of text with units; a plain number is in the SI unit of its drive."""
    lines = ["name,value,unit"]
    for name, given in stiffness.items():
        own = f"stiffness[{shown(name)}]"
        if np.ndim(given) == 0 and not isinstance(given, str) and name in drives:
            given = (given, "N/m" if drives[name] == "prismatic" else "N m/rad")  # type: ignore[assignment]
        value, unit = _pair(own, given, f"a value and its unit as (2e5, 'N m/rad'); units: {', '.join(_STIFFNESS_UNITS)}")
        if unit not in _STIFFNESS_UNITS:
            raise ArgumentError(f"{own} has the unit {shown(unit)}, expected one of the units: {', '.join(_STIFFNESS_UNITS)}")
        lines.append(f"{text(f'the joint of {own}', name)},{real(own, value)!r},{unit}")
    return "\n".join([*lines, ""])


def stands_at(home: Any) -> dict[str, tuple[bool, float]]:
    """Where joints stand at home by name: whether they turn, and rad or m."""
    found: dict[str, tuple[bool, float]] = {}
    for name, given in mapping("home", home, "a dictionary as {'joint': ('revolute', 0.5)}").items():
        own = f"home[{shown(name)}]"
        kind, at = _pair(own, given, "what the joint does and where it stands as ('revolute', 0.5), rad or m")
        turns = one_of(f"the kind of {own}", kind, ("revolute", "prismatic")) == "revolute"
        found[text(f"the joint of {own}", name)] = (turns, real(own, at))
    return found


def _pair(name: str, given: Any, expected: str) -> tuple[Any, Any]:
    if not isinstance(given, (tuple, list)) or len(given) != 2:
        raise refused(name, given, expected)
    return given[0], given[1]


def with_ratings(document: dict[str, Any], text: str) -> dict[str, Any]:
    """A model with the ``effort`` of the limits of a URDF as the ratings of its drives, where it is above 0."""
    efforts = {str(joint.get("name")).strip(): _effort(joint) for joint in ElementTree.fromstring(text).iter("joint")}
    for chain in document.get("chain", {}).values():
        for element in chain["elements"]:
            effort = efforts.get(element.get("name"), 0.0)
            if "actuator" in element and 0 < effort < _ENDLESS:
                element["rated_torque_n_m" if element["actuator"] == "revolute" else "rated_force_n"] = effort
    return document


def _effort(joint: ElementTree.Element) -> float:
    limit = joint.find("limit")
    stated = "0" if limit is None else limit.get("effort", "0")
    try:
        return float(stated)
    except ValueError:
        raise ArgumentError(f"effort of the joint {joint.get('name')!r} is {stated!r}, expected a number, N m or N") from None


def in_words_of_python(text: str) -> str:
    """Options of the command line as arguments of :meth:`Machine.from_urdf`."""
    return re.sub(r"--(base|tip|home|passive|joint-stiffness)\b ?(?=(LINK)?)", lambda m: m[1].removeprefix("joint-") + "=", text)
