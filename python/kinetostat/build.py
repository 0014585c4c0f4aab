"""Machines put together from limbs, drives, passive joints, links and platforms: the model file in Python.

A builder only collects; what is wrong is told by the reader of model files when :meth:`MachineBuilder.machine` is called. SI units (m, rad,
N/m, N m/rad, kg). Every element is in the frame reached by those before it.
"""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from kinetostat._arguments import mapping, one_of, or_none, refused, text, text_or_none
from kinetostat._arrays import finite, numbers, one, real, whole_number
from kinetostat.errors import ArgumentError, ModelError, UnansweredError
from kinetostat.machine import Machine
from kinetostat.spatial import rotation_vector

if TYPE_CHECKING:
    import os

__all__ = ["LimbBuilder", "MachineBuilder", "placement"]

_Axis = str | Sequence[float]
_Kind = Literal["revolute", "prismatic"]
_KINDS = ("revolute", "prismatic")
_PASSIVE = (*_KINDS, "universal", "spherical")
_MOST_SEGMENTS = 100
"""As the reader of model files has it."""


def placement(pose: ArrayLike) -> dict[str, Any]:
    """A pose as the model file writes it.

    Parameters
    ----------
    pose : array_like, shape (4, 4) or (3,)
        Pose, or position without a rotation, m.

    Returns
    -------
    dict
        ``position_m`` and, where it turns, ``rotation_vector_rad``.

    Examples
    --------
    >>> placement([0.1, 0, 0])
    {'position_m': [0.1, 0.0, 0.0]}
    """
    return _placed("pose", pose)


def _placed(name: str, pose: ArrayLike) -> dict[str, Any]:
    given = finite(name, pose)
    if given.shape not in ((3,), (4, 4)):
        raise ArgumentError(f"{name} has shape {given.shape}, expected (4, 4), or a position (3,)")
    if given.shape == (3,):
        return {"position_m": given.tolist()}
    matrix = given
    if matrix[3].tolist() != [0, 0, 0, 1]:
        raise ArgumentError(f"{name} is no pose: the last row of a 4 x 4 pose is 0 0 0 1, found {matrix[3].tolist()}")
    out = {"position_m": matrix[:3, 3].tolist()}
    if not np.array_equal(matrix[:3, :3], np.eye(3)):
        out["rotation_vector_rad"] = rotation_vector(matrix[:3, :3]).tolist()
    return out


def _axis(axis: _Axis) -> Any:
    return text("axis", axis) if isinstance(axis, str) else one("axis", axis, (3,)).tolist()


def _kind(kind: Any) -> Any:
    return one_of("kind", kind, _KINDS)


def _stiffness(kind: _Kind, value: float) -> dict[str, float]:
    return {"stiffness_n_per_m" if kind == "prismatic" else "stiffness_n_m_per_rad": real("stiffness", value)}


def _in(kind: _Kind, key: str, value: Any, shape: tuple[int, ...] = ()) -> dict[str, Any]:
    unit = "m" if kind == "prismatic" else "rad"
    return {} if value is None else {f"{key}_{unit}": one(key, value, shape).tolist()}


def _damper(kind: str, value: float | None) -> dict[str, float]:
    key = "damping_n_s_per_m" if kind == "prismatic" else "damping_n_m_s_per_rad"
    return {} if value is None else {key: real("damping", value)}


def _rotor(kind: _Kind, rotor: tuple[float, float, float]) -> dict[str, float]:
    inertia, ratio, servo = one("rotor", rotor, (3,)).tolist()
    slides = kind == "prismatic"
    return {
        "inertia_kg_m2": inertia,
        "lead_m_per_turn" if slides else "ratio": ratio,
        "servo_stiffness_n_per_m" if slides else "servo_stiffness_n_m_per_rad": servo,
    }


class LimbBuilder:
    """A limb in the making: elements from its start to its end. Made by :meth:`MachineBuilder.limb`.

    Methods give the limb itself, so that it reads like the drawing.

    Examples
    --------
    >>> arm = LimbBuilder("arm").actuator("shoulder", "revolute", "z", 2e5).rigid([0.5, 0, 0])
    >>> len(arm.elements)
    2
    """

    def __init__(self, name: str) -> None:
        self.name = text("name", name)
        self.elements: list[dict[str, Any]] = []
        self.loads: list[dict[str, Any]] = []

    def _add(self, element: Mapping[str, Any]) -> LimbBuilder:
        self.elements.append({key: value for key, value in element.items() if value is not None})
        return self

    def rigid(self, pose: ArrayLike, name: str | None = None) -> LimbBuilder:
        """A part that does not give way: pose (4, 4) or translation (3,), m.

        Examples
        --------
        >>> LimbBuilder("arm").rigid([0.5, 0, 0]).elements
        [{'rigid': {'position_m': [0.5, 0.0, 0.0]}}]
        """
        return self._add({"rigid": placement(pose), "name": text_or_none("name", name)})

    def actuator(
        self,
        name: str,
        kind: _Kind,
        axis: _Axis,
        stiffness: float | None,
        *,
        home: float = 0.0,
        limits: tuple[float, float] | None = None,
        rating: float | None = None,
        rotor: tuple[float, float, float] | None = None,
        damping: float | None = None,
    ) -> LimbBuilder:
        """A drive with its spring in series.

        Parameters
        ----------
        name : str
            Name, unique in the limb.
        kind : {"revolute", "prismatic"}
            Turns about its axis, or slides along it.
        axis : str or sequence of float
            ``"x"``, ``"-z"`` or three numbers.
        stiffness : float or None
            N m/rad or N/m; None does not give way.
        home : float
            Command at home, rad or m.
        limits : tuple of float, optional
            Smallest and largest command, rad or m.
        rating : float, optional
            Largest torque (N m) or force (N).
        rotor : tuple of float, optional
            For vibrations: inertia of the motor's rotor, kg m^2; its turns for one turn of the joint, or how far a slide goes for one
            turn of it, m; stiffness of the servo as the joint feels it, N m/rad or N/m.
        damping : float, optional
            For vibrations: damper beside the spring, N m s/rad or N s/m.

        Examples
        --------
        >>> LimbBuilder("arm").actuator("shoulder", "revolute", "z", 2e5).elements[0]["stiffness_n_m_per_rad"]
        200000.0
        """
        _kind(kind)
        spring: dict[str, Any] = {"rigid_drive": True} if stiffness is None else _stiffness(kind, stiffness)
        rated = "rated_force_n" if kind == "prismatic" else "rated_torque_n_m"
        return self._add(
            {
                "actuator": kind,
                "name": text("name", name),
                "axis": _axis(axis),
                **spring,
                rated: or_none(real, "rating", rating),
                "rotor": None if rotor is None else _rotor(kind, rotor),
                **_damper(kind, damping),
                **_in(kind, "home", home),
                **_in(kind, "limits", limits, (2,)),
            }
        )

    def passive(
        self,
        name: str,
        kind: Literal["revolute", "prismatic", "universal", "spherical"],
        axis: _Axis | Sequence[_Axis] | None = None,
        *,
        home: float | Sequence[float] | None = None,
        damping: float | None = None,
    ) -> LimbBuilder:
        """A joint that nothing drives; two axes for a universal one, none for a spherical one; home in rad or m.

        ``damping`` is a damper for vibrations, N m s/rad or N s/m.

        Examples
        --------
        >>> LimbBuilder("leg").passive("gimbal", "universal", ["y", "z"]).elements
        [{'passive': 'universal', 'name': 'gimbal', 'axes': ['y', 'z']}]
        """
        one_of("kind", kind, _PASSIVE)
        element: dict[str, Any] = {"passive": kind, "name": text("name", name)}
        if kind == "universal":
            if isinstance(axis, str) or not isinstance(axis, (Sequence, np.ndarray)) or len(axis) != 2:
                raise refused("axis", axis, "two axes of a universal joint as ['y', 'z']")
            element["axes"] = [_axis(a) for a in axis]  # type: ignore[arg-type]
        elif axis is not None:
            element["axis"] = _axis(axis)  # type: ignore[arg-type]
        if home is not None:
            element |= (
                {"homes_rad": finite("home", home).tolist()}
                if finite("home", home).ndim
                else _in("prismatic" if kind == "prismatic" else "revolute", "home", home)
            )
        return self._add(element | _damper(kind, damping))

    def spring(
        self,
        name: str,
        kind: _Kind,
        axis: _Axis,
        stiffness: float,
        *,
        rest: float = 0.0,
        home: float = 0.0,
        damping: float | None = None,
    ) -> LimbBuilder:
        """A spring of one freedom: N m/rad or N/m; deflection at rest and at home, rad or m.

        ``damping`` is a damper for vibrations, N m s/rad or N s/m.

        Examples
        --------
        >>> LimbBuilder("arm").spring("give", "prismatic", "x", 1e6).elements[0]["stiffness_n_per_m"]
        1000000.0
        """
        _kind(kind)
        more = {**_in(kind, "rest", rest), **_in(kind, "home", home)}
        more = (more if any(more.values()) else {}) | _damper(kind, damping)
        return self._add({"spring": kind, "name": text("name", name), "axis": _axis(axis), **_stiffness(kind, stiffness), **more})

    def spring6(self, name: str, stiffness: ArrayLike) -> LimbBuilder:
        """A spring of six freedoms: matrix (6, 6) or diagonal (6,), N/m, N/rad; N m/m, N m/rad.

        Examples
        --------
        >>> LimbBuilder("arm").spring6("flange", [1e8, 1e8, 1e8, 1e6, 1e6, 1e6]).elements[0]["name"]
        'flange'
        """
        given = numbers("stiffness", stiffness)
        key = "diagonal_n_m_rad" if given.shape == (6,) else "matrix_n_m_rad"
        return self._add(
            {"spring6": {key: one("stiffness", given, (6,) if given.shape == (6,) else (6, 6)).tolist()}, "name": text("name", name)}
        )

    def link(self, name: str, section: str, length: float, *, segments: int | None = None) -> LimbBuilder:
        """A straight elastic link along x: name of a section of the machine, length in m.

        Examples
        --------
        >>> LimbBuilder("arm").link("boom", "tube", 0.8).elements
        [{'link': 'tube', 'name': 'boom', 'length_m': 0.8}]
        """
        parts = or_none(whole_number, "segments", segments, 1, _MOST_SEGMENTS)
        where = {"link": text("section", section), "name": text("name", name)}
        return self._add({**where, "length_m": real("length", length), "segments": parts})

    def node(self, name: str) -> LimbBuilder:
        """A named place, for loads.

        Examples
        --------
        >>> LimbBuilder("arm").node("elbow").elements
        [{'node': 'elbow'}]
        """
        return self._add({"node": text("name", name)})

    def body(self, name: str, mass: float, centre: ArrayLike = (0.0, 0.0, 0.0), *, inertia: ArrayLike | None = None) -> LimbBuilder:
        """A mass, kg, with its centre in the frame reached there, m, and its inertia (3, 3) about the centre, kg m^2, for vibrations.

        Examples
        --------
        >>> LimbBuilder("arm").body("motor", 12).elements[0]["mass_kg"]
        12.0
        """
        where = one("centre", centre, (3,)).tolist()
        about = or_none(one, "inertia", inertia, (3, 3))
        return self._add(
            {
                "body": text("name", name),
                "mass_kg": real("mass", mass),
                "centre_of_mass_m": where,
                "inertia_kg_m2": None if about is None else about.tolist(),
            }
        )

    def element(self, element: Mapping[str, Any]) -> LimbBuilder:
        """Any other element, with the keys of the model file.

        Examples
        --------
        >>> LimbBuilder("leg").element({"coupled": "q1", "motion": "revolute", "axis": "z", "ratio": -1}).elements[0]["ratio"]
        -1
        """
        return self._add(mapping("element", element, "a dictionary with the keys of the model file"))

    def wrench(self, name: str, node: str, force: ArrayLike = (0.0, 0.0, 0.0), moment: ArrayLike = (0.0, 0.0, 0.0)) -> LimbBuilder:
        """A load on a node all the time, N and N m, base axes; it keeps its direction.

        Examples
        --------
        >>> LimbBuilder("arm").wrench("cable", "elbow", [0, 0, -50]).loads[0]["axes"]
        'base'
        """
        return self.load(
            {
                "wrench": text("name", name),
                "node": text("node", node),
                "axes": "base",
                "force_n": one("force", force, (3,)).tolist(),
                "moment_n_m": one("moment", moment, (3,)).tolist(),
            }
        )

    def load(self, load: Mapping[str, Any]) -> LimbBuilder:
        """Any other load, with the keys of the model file.

        Examples
        --------
        >>> len(LimbBuilder("arm").load({"counterweight": "w", "at": {"node": "elbow"}, "mass_kg": 40}).loads)
        1
        """
        self.loads.append(dict(mapping("load", load, "a dictionary with the keys of the model file")))
        return self


def _reaches_home(machine: Machine) -> bool:
    try:
        machine.posture()
    except UnansweredError:
        return False
    return True


class MachineBuilder:
    """A machine in the making.

    Parameters
    ----------
    name : str
        Name of the machine.
    gravity : array_like, shape (3,), optional
        m/s^2, base axes; needed as soon as anything has a mass.
    description : str, optional
        What it is.

    Examples
    --------
    >>> b = MachineBuilder("slide")
    >>> b.platform("tool", [0.5, 0, 0])
    >>> b.limb("arm", to="tool").actuator("x", "prismatic", "x", 5e6).rigid([0.5, 0, 0]).name
    'arm'
    >>> float(round(b.machine().posture().stiffness().matrix[0, 0]))
    5000000.0
    """

    def __init__(self, name: str, *, gravity: ArrayLike | None = None, description: str | None = None) -> None:
        fields = {
            "name": text("name", name),
            "description": text_or_none("description", description),
            "gravity_m_per_s2": None if gravity is None else one("gravity", gravity, (3,)).tolist(),
        }
        self._mechanism = {key: value for key, value in fields.items() if value is not None}
        self._platforms: list[dict[str, Any]] = []
        self._sections: dict[str, dict[str, Any]] = {}
        self._limbs: list[tuple[LimbBuilder, dict[str, Any]]] = []
        self._loads: list[dict[str, Any]] = []

    def platform(
        self,
        name: str,
        home: ArrayLike,
        *,
        mass: float | None = None,
        centre: ArrayLike | None = None,
        inertia: ArrayLike | None = None,
    ) -> None:
        """A moving body; the last one carries the tool.

        Parameters
        ----------
        name : str
            Unique; ``base`` is taken.
        home : array_like, shape (4, 4) or (3,)
            Pose in the base when the machine is at home, m.
        mass : float, optional
            kg.
        centre : array_like, shape (3,), optional
            Centre of mass in the platform's frame, m.
        inertia : array_like, shape (3, 3), optional
            About the centre of mass, axes of the platform, kg m^2, for vibrations.

        Examples
        --------
        >>> MachineBuilder("press").platform("ram", [0, 0, 1])
        """
        table: dict[str, Any] = {"name": text("name", name), "home": _placed("home", home)}
        if mass is not None:
            table["mass_kg"] = real("mass", mass)
        if centre is not None:
            table["centre_of_mass_m"] = one("centre", centre, (3,)).tolist()
        if inertia is not None:
            table["inertia_kg_m2"] = one("inertia", inertia, (3, 3)).tolist()
        self._platforms.append(table)

    def section(self, name: str, **values: Any) -> None:
        """A section of links, with the keys of the model file.

        Parameters
        ----------
        name : str
            By which links find it.
        **values
            As ``tube={"outer_diameter_m": 0.1, "inner_diameter_m": 0.08}, youngs_modulus_gpa=210, poissons_ratio=0.3``.

        Examples
        --------
        >>> MachineBuilder("arm").section("bar", round={"diameter_m": 0.05}, youngs_modulus_gpa=210, poissons_ratio=0.3)
        """
        if text("name", name) in self._sections:
            raise ArgumentError(f"there is a section {name!r} already")
        self._sections[name] = values

    def limb(
        self, name: str, *, to: str, start: ArrayLike | None = None, end: ArrayLike | None = None, begins_at: str = "base"
    ) -> LimbBuilder:
        """A limb between two platforms; what it returns takes its elements.

        Parameters
        ----------
        name : str
            Unique.
        to : str
            Platform where it ends.
        start, end : array_like, shape (4, 4) or (3,), optional
            Where it begins and ends in the frames of its platforms, m.
        begins_at : str
            Platform where it begins.

        Examples
        --------
        >>> MachineBuilder("arm").limb("arm", to="tool").name
        'arm'
        """
        if any(name == made.name for made, _ in self._limbs):
            raise ArgumentError(f"name is {name!r}, and there is a limb of that name already")
        made = LimbBuilder(name)
        table: dict[str, Any] = {"name": name, "from": text("begins_at", begins_at), "to": text("to", to), "chain": name}
        for key, value in (("start", start), ("end", end)):
            if value is not None:
                table[key] = _placed(key, value)
        self._limbs.append((made, table))
        return made

    def load(self, load: Mapping[str, Any]) -> None:
        """A load on platforms, with the keys of the model file.

        Examples
        --------
        >>> MachineBuilder("arm").load({"wrench": "hose", "platform": "tool", "axes": "base", "force_n": [0, 0, -20]})
        """
        self._loads.append(dict(mapping("load", load, "a dictionary with the keys of the model file")))

    def to_dict(self) -> dict[str, Any]:
        """The dictionary of the model file.

        Examples
        --------
        >>> MachineBuilder("arm").to_dict()["mechanism"]
        {'name': 'arm'}
        """
        out: dict[str, Any] = {"schema": 1, "mechanism": self._mechanism, "platform": self._platforms}
        if self._sections:
            out["section"] = self._sections
        out["chain"] = {made.name: {"elements": made.elements} for made, _ in self._limbs}
        out["limb"] = [table | ({"load": made.loads} if made.loads else {}) for made, table in self._limbs]
        if self._loads:
            out["load"] = self._loads
        return out

    def machine(self) -> Machine:
        """The machine.

        Raises
        ------
        ModelError
            What is missing or contradicts itself, as of a model file; a platform whose home is not where its limbs end at home.

        Examples
        --------
        >>> b = MachineBuilder("rail")
        >>> b.platform("tool", [0, 0, 0])
        >>> b.limb("x", to="tool").actuator("x", "prismatic", "x", 1e7).name
        'x'
        >>> b.machine().name
        'rail'
        """
        made = Machine.from_dict(self.to_dict(), file=f"builder of '{self._mechanism['name']}'")
        for said in made._native.warnings:
            limb = re.match(r"warning: at home the limb '(.*)' ends .* away from the platform", said)
            if limb and (self._is_driven(limb[1]) or not _reaches_home(made)):
                raise ModelError(said.removeprefix("warning: "))
        return made

    def _is_driven(self, limb: str) -> bool:
        """True if the home of the actuators alone says where a limb ends."""
        return not any("passive" in element for made, _ in self._limbs if made.name == limb for element in made.elements)

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model file (TOML), whole or not at all; see :meth:`Machine.save`.

        Examples
        --------
        >>> import os, tempfile
        >>> b = MachineBuilder("rail")
        >>> b.platform("tool", [0, 0, 0])
        >>> _ = b.limb("x", to="tool").actuator("x", "prismatic", "x", 1e7)
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "rail.toml")
        ...     b.save(path)
        ...     Machine.open(path) == b.machine()
        True
        """
        self.machine().save(path)
