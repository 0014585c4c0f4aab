"""A machine: read from a file, a dictionary or a URDF; asked for stiffness, equilibria and targets."""

from __future__ import annotations

import json
import os
from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core
from kinetostat._arguments import flag, mapping, of_kind, one_of, refused, texts, told
from kinetostat._arguments import path as file_path
from kinetostat._arguments import text as checked_text
from kinetostat._arrays import Floats, one, real, thread_count
from kinetostat._document import plain, without_none
from kinetostat._places import places_of, poses_of, posture_at, shaped, wrenches_of
from kinetostat._plausibility import Said, counted, issue, of_many, sentences
from kinetostat._urdf import model_text, with_ratings
from kinetostat.actuator import Actuator
from kinetostat.display import machine_html
from kinetostat.errors import ArgumentError
from kinetostat.posture import Posture
from kinetostat.results import Equilibria, Frames, Stiffnesses, Targets

if TYPE_CHECKING:
    from concurrent.futures import Executor

    import xarray

    from kinetostat.compensation import CompensatedProgram
    from kinetostat.page import View
    from kinetostat.shares import Shares
    from kinetostat.vibration import Damping

__all__ = ["Actuator", "Machine", "preset_names"]

Progress = Callable[[int, int, str], object]
"""Called with what is done, how much there is (0: nobody knows) and the name of the stage."""

_DETAILS = ("rest", "stiffness", "stability")
_FIELDS = ("tool", "displacement", "actuator_forces", "stiffness")
_DIRECTIONS = ("x", "y", "z", "rx", "ry", "rz")


def preset_names() -> dict[str, str]:
    """Names of the machines that come along, each with what it is.

    Examples
    --------
    >>> "orthoglide" in preset_names()
    True
    """
    return dict(_core.preset_names())


class Machine:
    """A robot with its tool: geometry, springs, loads, as its model file says.

    Made by :meth:`preset`, :meth:`open`, :meth:`from_toml`, :meth:`from_dict` or :meth:`from_urdf`; never changed afterwards. Units are
    SI (m, rad, N, N m); poses are 4 x 4 matrices, base from tool; base axes; wrenches act on the tool, about its reference point.

    Examples
    --------
    >>> import kinetostat as ks
    >>> machine = ks.Machine.preset("orthoglide")
    >>> posture = machine.posture(position=[0, 0, 0])
    >>> k = posture.stiffness().matrix
    >>> k.shape
    (6, 6)
    >>> loaded = posture.deflected_by(ks.wrench([100, -20, -30]))
    >>> loaded.stable
    True
    """

    __slots__ = ("__weakref__", "_fingerprint", "_native", "_notices")

    _native: _core.Machine
    _fingerprint: str | None
    _notices: tuple[str, ...]

    def __init__(self) -> None:
        raise TypeError("use Machine.preset, Machine.open, Machine.from_toml, Machine.from_dict or Machine.from_urdf")

    @classmethod
    def _of(cls, native: _core.Machine, notices: Sequence[str] = ()) -> Machine:
        made = object.__new__(cls)
        made._native = native
        made._notices = tuple(notices)
        made._fingerprint = None
        return made

    # Where it comes from -------------------------------------------------------------------------------------------

    @classmethod
    def preset(cls, name: str) -> Machine:
        """A machine that comes along; :func:`preset_names` lists them.

        Examples
        --------
        >>> Machine.preset("two_link").name
        'two_link'
        """
        return cls._of(_core.Machine.preset(checked_text("name", name, "the name of a preset")))

    @classmethod
    def open(cls, path: str | os.PathLike[str]) -> Machine:
        """A model file (TOML) by its path, or a preset by its name.

        Raises
        ------
        ModelError
            Every problem of the file with its line and what to do.

        Examples
        --------
        >>> Machine.open("orthoglide").name
        'orthoglide'
        """
        return cls._of(_core.Machine.open(file_path("path", path)))

    @classmethod
    def from_toml(cls, text: str, file: str = "model.toml") -> Machine:
        """A model from the text of a model file; ``file`` names it in messages.

        Examples
        --------
        >>> text = Machine.preset("two_link").text
        >>> Machine.from_toml(text) == Machine.preset("two_link")
        True
        """
        # The reader names faults of the text with their lines.
        written = checked_text("text", text, "the text of a model file", longest=None)
        return cls._of(_core.Machine.from_toml(written, checked_text("file", file)))

    @classmethod
    def from_dict(cls, document: Mapping[str, Any], file: str = "dictionary") -> Machine:
        """A model from a dictionary with the keys of a model file; values of None are left out.

        Examples
        --------
        >>> document = Machine.preset("two_link").to_dict()
        >>> document["mechanism"]["name"] = "mine"
        >>> Machine.from_dict(document).name
        'mine'
        """
        given = plain(mapping("document", document, "a dictionary with the keys of a model file"))
        return cls._of(_core.Machine.from_json(json.dumps(given, allow_nan=True), checked_text("file", file)))

    @classmethod
    def from_urdf(
        cls,
        robot: object,
        *,
        base: str | None = None,
        tip: str | None = None,
        passive: Sequence[str] = (),
        home: Mapping[str, tuple[Literal["revolute", "prismatic"], float]] | None = None,
        stiffness: float | Sequence[float] | Mapping[str, float | tuple[float, str]] | None = None,
        efforts_are_ratings: bool = False,
    ) -> Machine:
        """A machine from a URDF: geometry, masses and limits; what bends is given here or stays rigid.

        Parameters
        ----------
        robot : path, str or object
            Path of a URDF file, its text (beginning with ``<``), an object with ``write_xml_string()`` (yourdfpy) or
            ``to_xml_string()`` (urdf_parser_py), or a model of Pinocchio (``pin.Model``, or a wrapper with one). A model has no text
            any more: the tree of its joints, their placements, axes and limits, its inertias, its frames and its gravity are
            taken. What stood at fixed joints has become one body with the link that carries it; shapes, friction and transmissions
            are not taken, joints of several freedoms (a floating base) and coupled ones are refused.
        base, tip : str, optional
            Links that stand and that carry the tool.
        passive : sequence of str
            Joints that nothing drives.
        home : mapping, optional
            Where joints stand at home: ``{"joint": ("revolute", 0.5)}``, rad or m.
        stiffness : float, sequence or mapping, optional
            One stiffness for all drives that turn, N m/rad; one for each drive in the order of commands, N m/rad or N/m; or by joint,
            ``{"joint": 2e5}``, or with a unit ``{"joint": (2e5, "N m/rad")}``; units are N m/rad, N mm/rad, N m/deg, N/m, N/mm, N/um.
            Drives without one are rigid.
        efforts_are_ratings : bool
            The ``effort`` of a ``<limit>``, where it is above 0, is the rating of its drive, N m or N.

        Returns
        -------
        Machine
            What was skipped or looks wrong is in :attr:`warnings`.

        Notes
        -----
        The ``effort`` of a ``<limit>`` is not taken as the rating of a drive unless ``efforts_are_ratings`` says that it is one: it is the
        largest effort that a controller may ask for, often 0 or a placeholder, and programs that need more than a rating are refused.

        Examples
        --------
        >>> urdf = '''<robot name="crane"><link name="post"/><link name="boom"/>
        ... <joint name="shoulder" type="revolute"><parent link="post"/><child link="boom"/>
        ... <origin xyz="0 0 1.5"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="0" velocity="1"/></joint>
        ... <link name="hook"/><joint name="end" type="fixed"><origin xyz="1 0 0"/>
        ... <parent link="boom"/><child link="hook"/></joint></robot>'''
        >>> crane = Machine.from_urdf(urdf, tip="hook", stiffness=2e5)
        >>> loaded = crane.posture(joints=[0.0]).deflected_by([0, 0, -100, 0, 0, 0])
        >>> round(float(loaded.displacement[2]), 6)
        -0.0005
        """
        ratings = flag("efforts_are_ratings", efforts_are_ratings)
        toml, file, text, gravity, notices = model_text(robot, base, tip, passive, home, stiffness)
        made = cls._of(_core.Machine.from_toml(toml, file), notices)
        document = made.to_dict()
        if ratings:
            document = with_ratings(document, text)
        if gravity is not None:
            document["mechanism"]["gravity_m_per_s2"] = gravity.tolist()
        return made if document == made.to_dict() else cls._of(cls.from_dict(document, file)._native, notices)

    # What it is ----------------------------------------------------------------------------------------------------

    @property
    def name(self) -> str:
        """Name of the machine."""
        return self._native.name

    @property
    def file(self) -> str:
        """Name of its file, ``preset NAME``, or what it was made from."""
        return self._native.file

    @property
    def text(self) -> str:
        """Text of its model file, comments included."""
        return self._native.text

    @property
    def warnings(self) -> list[str]:
        """What looks wrong in the model, in the URDF that it was made from, and in its tool, although it can be computed."""
        return [*self._native.warnings, *self._notices, *sentences(self._tool_warnings())]

    def _tool_warnings(self) -> list[Said]:
        bare = np.array_equal(self._native.tool(), np.eye(4))
        return [] if bare else _core.tool_warnings(self._native)

    @property
    def actuators(self) -> tuple[Actuator, ...]:
        """Its drives, in the order of commands."""
        return tuple(Actuator(*row) for row in self._native.actuators())

    @property
    def damping(self) -> Damping:
        r"""How the model says that its vibrations are damped; ``Damping.none()`` where it says nothing.

        Examples
        --------
        >>> Machine.from_toml(Machine.preset("heavy_6r").text + "[damping]\nratio = 0.03\n").damping
        Damping.ratio(0.03)
        """
        from kinetostat.vibration import damping_of

        return damping_of(self._native.damping_json())

    @property
    def platforms(self) -> tuple[str, ...]:
        """Names of its platforms, the base first."""
        return tuple(self._native.platform_names())

    @property
    def limbs(self) -> tuple[str, ...]:
        """Names of its limbs."""
        return tuple(self._native.limb_names())

    @property
    def home(self) -> Floats:
        """(4, 4): pose of the tool at home, base from tool."""
        return self._native.home_pose()

    @property
    def tool(self) -> Floats:
        """(4, 4): flange from tool."""
        return self._native.tool()

    @property
    def workspace(self) -> tuple[Floats, Floats] | None:
        """Two opposite corners of the workspace that the model states, m; none where it states none."""
        found = self._native.workspace()
        return None if found is None else (np.array(found[0]), np.array(found[1]))

    @property
    def turns_as_it_moves(self) -> bool:
        """Whether the tool turns as the machine moves, because it has fewer than six freedoms."""
        return self._native.turns_as_it_moves()

    def to_toml(self) -> str:
        """The model as a file: every key, no comments. The tool is not part of it.

        Examples
        --------
        >>> machine = Machine.preset("two_link")
        >>> Machine.from_toml(machine.to_toml()).actuators == machine.actuators
        True
        """
        return self._native.to_toml()

    def to_dict(self) -> dict[str, Any]:
        """The model as a dictionary with the keys of a model file.

        Examples
        --------
        >>> Machine.preset("two_link").to_dict()["mechanism"]["name"]
        'two_link'
        """
        found: dict[str, Any] = without_none(json.loads(self._native.to_json()))
        return found

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes the model file, whole or not at all.

        Parameters
        ----------
        path : path
            File to write; an existing one is replaced.

        Examples
        --------
        >>> import os, tempfile
        >>> machine = Machine.preset("two_link")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     path = os.path.join(folder, "mine.toml")
        ...     machine.save(path)
        ...     Machine.open(path).name
        'two_link'
        """
        target = file_path("path", path)
        beside = f"{target}.{os.getpid()}.part"
        try:
            with open(beside, "w", encoding="utf-8", newline="\n") as file:
                file.write(self.to_toml())
            os.replace(beside, target)
        except BaseException:
            if os.path.exists(beside):
                os.remove(beside)
            raise

    def with_tool(self, tool: ArrayLike | None = None, *, length: float | None = None) -> Machine:
        """The same machine with another tool.

        Parameters
        ----------
        tool : array_like, shape (4, 4), optional
            Pose of the tool's reference point, flange from tool, m.
        length : float, optional
            Instead: a straight tool, its tip so many m along z of the flange.

        Warns
        -----
        PlausibilityWarning
            No tool is so long, or so short. What is only unusual is in :attr:`warnings`.

        Examples
        --------
        >>> longer = Machine.preset("heavy_6r").with_tool(length=0.2)
        >>> float(longer.tool[2, 3])
        0.2
        """
        if (tool is None) == (length is None):
            raise ArgumentError("give a tool or its length, m")
        pose = np.eye(4)
        if length is not None:
            pose[2, 3] = real("length", length)
        else:
            pose = one("tool", cast(ArrayLike, tool), (4, 4))
        made = self._of(self._native.with_tool(pose[None]), self._notices)
        issue(made._tool_warnings())
        return made

    # What it does --------------------------------------------------------------------------------------------------

    def posture(
        self,
        position: ArrayLike | None = None,
        rotation: ArrayLike | None = None,
        *,
        pose: ArrayLike | None = None,
        joints: ArrayLike | None = None,
        near: Posture | None = None,
    ) -> Posture:
        """The machine commanded for a place; at home without one.

        Parameters
        ----------
        position : array_like, shape (3,), optional
            Position of the tool's reference point, m.
        rotation : array_like, shape (3, 3), optional
            Rotation matrix with the position, base from tool; as at home without it. Where the tool turns as the machine moves,
            the one nearest to that at home is taken.
        pose : array_like, shape (4, 4), optional
            Instead of both: base from tool.
        joints : array_like, shape (actuators,), optional
            Instead of a place: commands, m or rad.
        near : Posture, optional
            Where several postures reach the place, the one next to this is taken. Without it the one next to home, and of an arm that
            leaves the limits of a joint there the one within all limits whose joints are nearest to home.

        Returns
        -------
        Posture

        Raises
        ------
        UnansweredError
            The place is out of reach; the message says the nearest one that was found.

        Examples
        --------
        >>> posture = Machine.preset("orthoglide").posture([0.01, 0, 0])
        >>> posture.commands.round(4).tolist()
        [-0.3405, -0.3503, -0.3503]
        """
        if near is not None:
            of_kind("near", near, Posture, "a Posture")
        found = posture_at(self._native, position, rotation, pose, joints, None if near is None else near._native)
        return Posture(self, found)

    def stiffness(
        self,
        poses: ArrayLike | None = None,
        *,
        joints: ArrayLike | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Stiffnesses:
        """Cartesian stiffness of many postures of the unloaded machine as drawn.

        Parameters
        ----------
        poses : array_like, shape (..., 4, 4) or (..., 3)
            Poses of the tool, base from tool, or positions with the orientation at home, m. Where the tool turns as the machine moves
            (:attr:`turns_as_it_moves`), positions take the orientation nearest to that at home, as :meth:`posture` does; a pose with
            an orientation that the machine cannot have there is unsolved.
        joints : array_like, shape (..., actuators)
            Instead, for a serial machine without passive joints: commands, m or rad.
        threads : int, optional
            Number of threads; all cores without it. The answer is the same.
        progress : callable, optional
            Called with what is done, how much there is and the name of the stage; :func:`kinetostat.bar` makes one of tqdm.

        Returns
        -------
        Stiffnesses
            Arrays with the leading axes of what was given.

        Notes
        -----
        Near a singular posture rounding takes digits: an entry may be off by the largest one times ``eps cond``, with ``eps`` = 2.2e-16
        and the condition number of the matrix (rotations at 1 m). :meth:`Posture.stiffness` loses by ``4 eps sqrt(cond)`` only: beyond
        a condition of 1e8, where the two may differ in the eighth digit, take that of the posture.

        Examples
        --------
        >>> machine = Machine.preset("orthoglide")
        >>> x = np.linspace(-0.05, 0.05, 5)
        >>> machine.stiffness(np.stack([x, 0 * x, 0 * x], axis=-1)).matrix.shape
        (5, 6, 6)
        """
        threads = thread_count(threads)
        places, commands, leading = places_of(self._native, poses, joints, threads)
        found = _core.stiffness_of_many(self._native, places, commands, threads, told(progress))
        return Stiffnesses(**_arrays(found, leading), warnings=self._said(None, None, found))

    def frames(self, joints: ArrayLike, *, threads: int | None = None, progress: Progress | None = None) -> Frames:
        """Forward kinematics: poses of the tool and of all nodes for many commands, of the unloaded machine as drawn.

        Parameters
        ----------
        joints : array_like, shape (..., actuators)
            Commands, m or rad.
        threads, progress
            As for :meth:`stiffness`.

        Returns
        -------
        Frames
            With the leading axes of ``joints``; closed loops follow the commands from home.

        Examples
        --------
        >>> machine = Machine.preset("heavy_6r")
        >>> q = np.zeros((3, 6)) + machine.posture().commands
        >>> bool(np.allclose(machine.frames(q).tool, machine.home, atol=1e-9))
        True
        """
        threads = thread_count(threads)
        _, commands, leading = places_of(self._native, None, joints, threads)
        assert commands is not None
        found = _core.frames_of_many(self._native, commands, threads, told(progress))
        said = self._said(None, None, found)
        return Frames(**_arrays(found, leading), nodes=tuple(_core.frame_names(self._native)), warnings=said)

    def inverse_solutions(self, pose: ArrayLike) -> tuple[Posture, ...]:
        """All postures of a serial arm without passive joints at a pose of its tool.

        Parameters
        ----------
        pose : array_like, shape (4, 4) or (3,)
            Base from tool, m; or a position with the orientation at home, m.

        Returns
        -------
        tuple of Posture
            Those within all limits first, then by their distance from home; empty where the pose is out of reach. In closed form for arms
            with six axes and a spherical wrist, which have up to eight; of other arms those that Newton's iteration finds from 129
            shapes over the ranges of the joints. Of an arm with more joints than freedoms they are examples.

        Raises
        ------
        ArgumentError
            The machine has several limbs, or passive joints.

        Examples
        --------
        >>> machine = Machine.preset("scara")
        >>> found = machine.inverse_solutions(machine.posture(joints=[0.4, 1.1, -0.05, 0.3]).target)
        >>> sorted(round(float(posture.commands[1]), 9) for posture in found)
        [-1.1, 1.1]
        """
        places, leading = poses_of(self._native, pose, name="pose")
        if leading:
            raise ArgumentError(f"pose has shape {(*leading, 4, 4)}, expected (4, 4), or a position (3,)")
        return tuple(Posture(self, found) for found in _core.inverse_solutions(self._native, places))

    def shares(
        self,
        position: ArrayLike | Literal["x", "y", "z", "rx", "ry", "rz"] | None = None,
        *,
        joints: ArrayLike | None = None,
        direction: Literal["x", "y", "z", "rx", "ry", "rz"] | Sequence[float] = "z",
        wrench: ArrayLike | None = None,
        progress: Progress | None = None,
    ) -> Shares:
        """Which part gives how much of the deflection in a direction: :func:`kinetostat.shares.shares`.

        Parameters
        ----------
        position : array_like, shape (3,), or {"x", "y", "z", "rx", "ry", "rz"}, optional
            As for :func:`kinetostat.shares.shares`, m; or the direction, as :meth:`kinetostat.Posture.shares` takes it, at home.
        joints, direction, wrench, progress
            As for :func:`kinetostat.shares.shares`, rad, N, N m, base axes.

        Returns
        -------
        Shares

        Examples
        --------
        >>> Machine.preset("heavy_6r").shares("z").parts[0].share > 0.1
        True
        """
        from kinetostat.shares import shares

        if isinstance(position, str):
            if direction != "z":
                raise ArgumentError(f"direction is given twice, as {position!r} and {direction!r}: give it once")
            position, direction = None, one_of("direction", position, _DIRECTIONS)  # type: ignore[assignment]
        return shares(self, position, joints=joints, direction=direction, wrench=wrench, progress=progress)

    def equilibrium(
        self,
        poses: ArrayLike | None = None,
        wrenches: ArrayLike = (0.0,) * 6,
        *,
        joints: ArrayLike | None = None,
        details: Literal["rest", "stiffness", "stability"] = "stability",
        fields: Sequence[str] | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Equilibria:
        """Equilibria of many postures of the machine as it is, with its own loads and deviations, under wrenches on the tool.

        Parameters
        ----------
        poses : array_like, shape (..., 4, 4) or (..., 3)
            Commanded poses of the tool, or positions with the orientation at home, m, as for :meth:`stiffness`.
        wrenches : array_like, shape (6,) or (..., 6)
            Force and moment on the tool (N, N m), base axes, about its reference point: one for all, or one for each.
        joints : array_like, shape (..., actuators)
            Instead of poses, for a serial machine without passive joints: commands, m or rad.
        details : {"rest", "stiffness", "stability"}
            How much is computed; each includes those before it.
        fields : sequence of str, optional
            Names of ``tool``, ``displacement``, ``actuator_forces`` and ``stiffness`` that are kept, all without it; the others are None
            and take no memory. States, commands and, by ``details``, stability are kept always. Without ``displacement`` nothing warns of
            a machine that folds over.
        threads, progress
            As for :meth:`stiffness`.

        Returns
        -------
        Equilibria

        Examples
        --------
        >>> machine = Machine.preset("orthoglide")
        >>> found = machine.equilibrium([[0, 0, 0], [0.01, 0, 0]], [100, 0, 0, 0, 0, 0])
        >>> bool(found.stable.all()), found.displacement.shape
        (True, (2, 6))
        """
        one_of("details", details, _DETAILS)
        threads = thread_count(threads)
        places, commands, leading = places_of(self._native, poses, joints, threads)
        loads = wrenches_of(wrenches, leading)
        level = _DETAILS.index(details)
        names = _FIELDS if fields is None else texts("fields", fields, f"a list of {', '.join(_FIELDS)}")
        for index, name in enumerate(names):
            one_of(f"fields[{index}]", name, _FIELDS)
        tool, moved, forces, stiff = (name in names for name in _FIELDS)
        kept = (tool, moved, forces, stiff)
        found = _core.equilibrium_of_many(self._native, loads, level, places, commands, kept, threads, told(progress))
        stability = found.pop("stability", None)
        arrays: dict[str, Any] = {name: shaped(array, leading) for name, array in found.items()}
        if stability is not None:
            arrays["stable"] = shaped(stability[:, 0] > 0, leading)
            arrays["against_force"] = shaped(stability[:, 1], leading)
            arrays["share_to_buckling"] = shaped(stability[:, 2], leading)
        return Equilibria(**arrays, warnings=self._said(loads, found["displacement"][:, :3] if moved else None, found))

    def targets(
        self,
        poses: ArrayLike,
        wrenches: ArrayLike,
        *,
        directions: Sequence[str] | Literal["position", "pose"] = "position",
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> Targets:
        """Poses to command so that the loaded tool is where it should be: compensation [R 7.7-7.13].

        Parameters
        ----------
        poses : array_like, shape (..., 4, 4) or (..., 3)
            Where the tool should be under the load, base from tool, m; positions as for :meth:`stiffness`.
        wrenches : array_like, shape (6,) or (..., 6)
            Force and moment on the tool there (N, N m).
        directions : {"position", "pose"} or sequence of str
            What is corrected: names of ``x y z rx ry rz``, base axes. With ``"position"`` the target has the orientation of the pose,
            or where the tool turns as the machine moves the nearest to it that the machine can have there.
        threads, progress
            As for :meth:`stiffness`.

        Returns
        -------
        Targets

        Examples
        --------
        >>> machine = Machine.preset("orthoglide")
        >>> found = machine.targets([[0, 0, 0]], [100, -20, -30, 0, 0, 0])
        >>> bool(np.abs(found.tool[0, :3, 3]).max() < 1e-12)
        True
        """
        known = {"position": _DIRECTIONS[:3], "pose": _DIRECTIONS}
        names = known.get(directions, ()) if isinstance(directions, str) else directions
        if not isinstance(names, Sequence) or not names or any(name not in _DIRECTIONS for name in names):
            raise refused("directions", directions, f"'position', 'pose' or some of {', '.join(_DIRECTIONS)}")
        threads = thread_count(threads)
        wanted = [name in names for name in _DIRECTIONS]
        # Where the position alone is corrected, each target takes the orientation nearest to that at home by itself.
        places, leading = poses_of(self._native, poses, threads, follow=wanted != [True] * 3 + [False] * 3)
        loads = wrenches_of(wrenches, leading)
        found = _core.targets_of_many(self._native, places, loads, wanted, threads, told(progress))
        moved = found["tool"][:, :3, 3] - found["targets"][:, :3, 3]
        return Targets(**_arrays(found, leading), warnings=self._said(loads, moved, found))

    def _said(self, loads: Floats | None, displacement: Floats | None, found: Mapping[str, Any]) -> tuple[str, ...]:
        """The ``warnings`` of an answer for many postures; those beyond a limit are issued, of the line that asked."""
        said = of_many(self._native, loads, displacement, found["status"])
        issue(said)
        return sentences(said)

    def map(
        self,
        *,
        x: ArrayLike | None = None,
        y: ArrayLike | None = None,
        z: ArrayLike | None = None,
        orientations: ArrayLike | Mapping[str, ArrayLike] | None = None,
        over_orientations: Literal["worst"] | None = None,
        loads: ArrayLike | Mapping[str, ArrayLike] | None = None,
        variables: str | Sequence[str] | None = None,
        folder: str | os.PathLike[str] | None = None,
        executor: Executor | Callable[[], Executor] | None = None,
        chunk: int | None = None,
        threads: int | None = None,
        progress: Progress | None = None,
    ) -> xarray.Dataset:
        """What the machine is like at every place of a grid: :func:`kinetostat.maps.evaluate`, where the arguments are explained.

        Parameters
        ----------
        x, y, z : array_like, shape () or (n,)
            Positions, m, base axes; as at home where none is given.
        orientations : array_like, shape (3, 3) or (k, 3, 3), or mapping of str to (3, 3), optional
            Rotation matrices, base from tool.
        over_orientations : {"worst"}, optional
            The worst value of all orientations instead of all.
        loads : array_like, shape (6,) or (m, 6), or mapping of str to (6,), optional
            Wrenches on the tool (N, N m), base axes, about its reference point; unloaded and as drawn without any.
        variables : str or sequence of str, optional
            Names of :func:`kinetostat.maps.variables`.
        folder, executor, chunk, threads, progress
            Where it is kept, where and how it is computed.

        Returns
        -------
        xarray.Dataset
            Variables with units, coordinates in m, and ``status``.

        Examples
        --------
        >>> machine = Machine.preset("orthoglide")
        >>> found = machine.map(x=[-0.05, 0.0, 0.05], loads=[100, 0, 0, 0, 0, 0])
        >>> found.deflection.dims
        ('x',)
        """
        from kinetostat import maps

        return maps.evaluate(
            self,
            x=x,
            y=y,
            z=z,
            orientations=orientations,
            over_orientations=over_orientations,
            loads=loads,
            variables=variables,
            folder=folder,
            executor=executor,
            chunk=chunk,
            threads=threads,
            progress=progress,
        )

    def compensate(self, program: str | os.PathLike[str], out: str | os.PathLike[str], **options: Any) -> CompensatedProgram:
        """Writes a program that cuts where it should; see :func:`kinetostat.compensation.compensate`.

        Examples
        --------
        >>> import os, tempfile
        >>> machine = Machine.preset("orthoglide")
        >>> with tempfile.TemporaryDirectory() as folder:
        ...     source = os.path.join(folder, "in.ngc")
        ...     with open(source, "w") as file:
        ...         print("G21 G90", "G0 X0 Y0 Z5", "G1 Z-1 F300", "G1 X50", "M2", sep=chr(10), file=file)
        ...     found = machine.compensate(source, os.path.join(folder, "out.ngc"), force=[100, 0, 0])
        >>> found.within_tolerance
        True
        """
        from kinetostat.compensation import compensate

        return compensate(self, program, out, **options)

    def drawing(self, posture: Posture | None = None, **options: Any) -> str:
        """A drawing of the machine (SVG), at home or at a posture.

        Parameters
        ----------
        posture : Posture, optional
            Where it stands; at home without one.
        **options
            As for :func:`kinetostat.commands.model_draw`: ``view``, ``motion``, ``force``, ``moment``, ``scale``.

        Examples
        --------
        >>> Machine.preset("two_link").drawing().lstrip().startswith("<svg")
        True
        """
        from kinetostat import commands
        from kinetostat._asking import bare, handed_on, place

        model, length = bare(self)
        where: dict[str, Any] = {"model": model, "tool_length_mm": length} if posture is None else place(self._own(posture))
        return commands.model_draw(**handed_on(where, options))

    def view(self, posture: Posture | None = None, *, force: ArrayLike | None = None, moment: ArrayLike | None = None) -> View:
        """The machine in three dimensions, at home or at a posture; a notebook shows it.

        Parameters
        ----------
        posture : Posture, optional
            Where it stands; at home without one.
        force, moment : array_like, shape (3,), optional
            On the tool, N and N m, base axes.

        Examples
        --------
        >>> Machine.preset("orthoglide").view(force=[215, -10, -25]).html[:15]
        '<!doctype html>'
        """
        from kinetostat.page import View

        parts = [np.zeros(3) if part is None else one(name, part, (3,)) for name, part in (("force", force), ("moment", moment))]
        return View(self.posture() if posture is None else self._own(posture), np.concatenate(parts))

    def to_pyvista(self, posture: Posture | None = None, *, axes: float | None = None) -> Any:
        """The machine as a ``pyvista.MultiBlock``, at home or at a posture; see :func:`kinetostat.view.to_pyvista`.

        Examples
        --------
        >>> blocks = Machine.preset("orthoglide").to_pyvista()
        >>> blocks["leg x"].n_cells
        1
        """
        from kinetostat.view import to_pyvista

        return to_pyvista(self.posture() if posture is None else self._own(posture), axes=axes)

    def _own(self, posture: Posture) -> Posture:
        """A posture of this machine."""
        found = of_kind("posture", posture, Posture, "a Posture")
        if found.machine != self:
            raise ArgumentError(f"posture is one of {found.machine!r}, not of this machine")
        return found

    def _repr_html_(self) -> str:
        return machine_html(self)

    # As a value ----------------------------------------------------------------------------------------------------

    @property
    def fingerprint(self) -> str:
        """SHA-256 of the model and its tool: the same on every machine and in every run."""
        if self._fingerprint is None:
            self._fingerprint = self._native.fingerprint()
        return self._fingerprint

    def __hash__(self) -> int:
        return int(self.fingerprint[:15], 16)

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Machine):
            return NotImplemented
        return self.fingerprint == other.fingerprint

    def __reduce__(self) -> tuple[Any, ...]:
        return _restored, (self.text, self.file, self.tool, self._notices)

    def __copy__(self) -> Machine:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> Machine:
        return self

    def __repr__(self) -> str:
        limbs, actuators = len(self.limbs), len(self._native.actuators())
        counts = f"{limbs} limb{'s' * (limbs != 1)}, {actuators} actuator{'s' * (actuators != 1)}"
        return f"<Machine '{self.name}' ({self.file}): {counts}{counted(self._tool_warnings())}>"


def _arrays(found: Mapping[str, Any], leading: tuple[int, ...]) -> dict[str, Any]:
    return {name: shaped(array, leading) for name, array in found.items()}


def _restored(text: str, file: str, tool: Floats, notices: Sequence[str] = ()) -> Machine:
    """A machine that was pickled."""
    native = _core.Machine.from_toml(text, file)
    return Machine._of(native if np.array_equal(tool, np.eye(4)) else native.with_tool(tool[None]), notices)
