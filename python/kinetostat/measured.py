"""Programs corrected by what was measured of their last trial: typed answers of ``mirror``."""

from __future__ import annotations

import dataclasses
import os
import tempfile
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal, TypeAlias

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat import commands
from kinetostat._arguments import flag, or_none, told
from kinetostat._arguments import path as file_path
from kinetostat._arrays import Floats, numbers, real
from kinetostat._asking import handed_on
from kinetostat.errors import ArgumentError, KinetostatError
from kinetostat.spatial import rotation_from_vector

if TYPE_CHECKING:
    from kinetostat.machine import Progress

__all__ = ["Measurement", "MirroredProgram", "mirror"]

_Path: TypeAlias = str | os.PathLike[str]

_DEG = np.pi / 180


@dataclasses.dataclass(frozen=True, eq=False)
class Measurement:
    """What one measurement of a trial says; lengths in m.

    Examples
    --------
    >>> from kinetostat._example import trial  # a groove that was cut 50 um to its left, see mirror()
    >>> found = trial()
    >>> found.measurements[0].points, round(1e6 * found.measurements[0].rms)
    (41, 50)
    """

    file: str
    points: int
    """Points that count."""
    rms: float
    """Root of the mean square of their deviations across the path."""
    largest: float
    """The largest of them."""
    smoothed_rms: float
    """Root of the mean square along the path after smoothing."""
    smoothed_largest: float
    """The largest after smoothing."""
    scatter: float
    """Standard deviation of a point from the smoothed deviation in one direction."""
    effective_points: float
    """How many points a smoothed deviation rests on."""
    outliers: NDArray[np.int64]
    """Rows, from 1, that no neighbour bears out."""
    beside_corners: NDArray[np.int64]
    """Rows, from 1, so near a corner of the path that they may belong to its other leg; they do not count."""
    left_out: NDArray[np.int64]
    """Rows, from 1, without a place on the path."""
    motion: Floats | None
    """(4, 4): from the frame of the measurement to that of the program, its rotation times the scale; none where none was sought."""
    free: tuple[str, ...]
    """Motions that the points leave open, in words."""
    rejected_rows: NDArray[np.int64]
    """Rows, from 1, that the motion was not fitted to, since they are far from where it brings the others; none where none was sought."""


@dataclasses.dataclass(frozen=True, eq=False)
class MirroredProgram:
    """What became of a trial; lengths in m.

    Examples
    --------
    >>> from kinetostat._example import trial  # a groove that was cut 50 um to its left, see mirror()
    >>> found = trial()
    >>> found.trial, found.outcome, round(1e6 * found.left)
    (1, 'go_on', 50)
    """

    trial: int
    """Number of this trial, from 1."""
    outcome: Literal["go_on", "within_repeatability", "nothing_to_correct", "risen"]
    """Go on with the correction; leave it, because what is left is within the repeatability or nothing; or the error has risen."""
    left: float
    """Smoothed deviation of the mean of all measurements, root mean square."""
    floor: float | None
    """What the repeatability leaves; none where it is not known."""
    left_in_trials: Floats
    """(trials,): the same of all trials so far."""
    largest_correction: float
    """By measurement, in all trials together."""
    factor: float | None
    """Share of the smoothed error of the trial before that is left; none in the first."""
    relaxation_below: float | None
    """The relaxation must stay below this, by what two trials say of the machine; none where they say nothing."""
    measurements: tuple[Measurement, ...]
    answer: dict[str, Any]
    """What the command prints, with its units in the names."""


def mirror(
    program: _Path,
    measured: _Path | ArrayLike | Sequence[_Path | ArrayLike],
    out: _Path,
    *,
    state: _Path | None = None,
    job: _Path | None = None,
    relaxation: float | None = None,
    smoothing: float | None = None,
    window: float | None = None,
    repeatability: float | None = None,
    align: Literal["nearest", "arc-length"] | None = None,
    register: Literal["none", "translation", "rigid"] | None = None,
    scale: bool = False,
    tolerance: float | None = None,
    progress: Progress | None = None,
    **options: Any,
) -> MirroredProgram:
    r"""Writes the program of the next trial: the one that is drawn, with the measured deviations mirrored.

    Measure the new program, and give the points with the same ``state``: each trial corrects what the one before has left, until that
    is within the repeatability.

    Parameters
    ----------
    program : path
        The program as it is drawn, the same in every trial: G-code.
    measured : path or array_like, shape (n, 3), or sequence of them
        Points of the last trial, m, where their rows are in the order in which the tool went; or a file (CSV with ``x_mm,y_mm,z_mm``,
        or a second program). Several are measurements of the same trial.
    out : path
        The program of the next trial.
    state : path, optional
        State of all trials (TOML), read and written; without it this is the only one.
    job : path, optional
        Job file with a model: its compensation comes first.
    relaxation : float, optional
        Share of the deviation that is mirrored, above 0 and below 2; 1 without it.
    smoothing : float, optional
        Standard deviation of the kernel along the path, m; 5 mm without it.
    window : float, optional
        How far the tool may have been from its path, m; 1 mm without it.
    repeatability : float, optional
        Standard deviation of one measured deviation in one direction, m; from several measurements of this trial without it.
    align : {"nearest", "arc-length"}, optional
        How points find their places on the path.
    register : {"none", "translation", "rigid"}, optional
        Motion that brings the points onto the path first. What it takes away is not corrected: ``"none"`` for points in the frame of the
        program. It must be chosen unless ``state`` has trials already.
    scale : bool
        Seek a scale besides the rigid motion.
    tolerance : float, optional
        How far the straight pieces may leave the corrected path, m; 0.5 um without it.
    progress : callable, optional
        Called with what is done, how much there is and the name of the stage.
    **options
        Everything else as for :func:`kinetostat.commands.mirror`.

    Returns
    -------
    MirroredProgram

    Raises
    ------
    ArgumentError
        The program cannot be followed (with its line), the points do not fit it, or the state is that of another program.
    UnansweredError
        With a job: its machine cannot get somewhere.

    Examples
    --------
    >>> import os, tempfile
    >>> import numpy as np
    >>> x = np.linspace(0, 0.04, 41)
    >>> points = np.stack([x, 5e-5 + 0 * x, 0 * x], axis=-1)  # 50 um to the left of the groove
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     program = os.path.join(folder, "groove.ngc")
    ...     with open(program, "w") as file:
    ...         _ = file.write("G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n")
    ...     found = mirror(program, points, os.path.join(folder, "trial2.ngc"), register="none")
    >>> found.outcome, round(1e6 * found.left), round(1e6 * found.largest_correction)
    ('go_on', 50, 50)
    """

    def scaled(name: str, length: float | None, factor: float) -> float | None:
        return None if length is None else factor * real(name, length)

    program, out = file_path("program", program), file_path("out", out)
    state, job = or_none(file_path, "state", state), or_none(file_path, "job", job)
    with tempfile.TemporaryDirectory(prefix="kinetostat-") as folder:
        files = _files(measured, folder)
        try:
            own = {
                "measured": [path for path, _ in files],
                "out": out,
                "state": state,
                "job": job,
                "relaxation": relaxation,
                "smoothing_mm": scaled("smoothing", smoothing, 1e3),
                "window_mm": scaled("window", window, 1e3),
                "repeatability_um": scaled("repeatability", repeatability, 1e6),
                "align": align,
                "register": register,
                "scale": flag("scale", scale),
                "tolerance_um": scaled("tolerance", tolerance, 1e6),
                "progress": told(progress),
            }
            answer = commands.mirror(program, **handed_on(own, options))
        except KinetostatError as wrong:
            raise type(wrong)(_with_names(str(wrong), files)) from None
    convergence = answer["convergence"] or {}
    floor = answer["floor_mm"]
    return MirroredProgram(
        trial=answer["trial"],
        outcome=answer["outcome"],
        left=1e-3 * answer["left_mm"],
        floor=None if floor is None else 1e-3 * floor,
        left_in_trials=1e-3 * np.array(answer["left_in_trials_mm"], dtype=float),
        largest_correction=1e-3 * answer["largest_correction_mm"],
        factor=convergence.get("factor"),
        relaxation_below=convergence.get("relaxation_below"),
        measurements=tuple(map(_measurement, answer["measurements"])),
        answer=answer,
    )


def _files(measured: Any, folder: str) -> list[tuple[str, str]]:
    """Measurements as files, each with what it is called here: points become tables in a folder."""
    if _is_path(measured):
        path = file_path("measured", measured)
        return [(path, path)]
    several = isinstance(measured, (list, tuple)) and any(_is_path(one) or np.ndim(one) > 1 for one in measured)
    files: list[tuple[str, str]] = []
    for index, one in enumerate(measured if several else [measured]):
        name = f"measured[{index}]" if several else "measured"
        path = file_path(name, one) if _is_path(one) else _table(one, index, folder, name)
        files.append((path, path if _is_path(one) else name))
    return files


def _with_names(message: str, files: Sequence[tuple[str, str]]) -> str:
    """A table that is gone is no name of a measurement."""
    for path, name in files:
        message = message.replace(path, name)
    return message


def _is_path(value: Any) -> bool:
    return isinstance(value, (str, os.PathLike))


def _table(points: ArrayLike, index: int, folder: str, name: str) -> str:
    given = numbers(name, points)
    if given.ndim != 2 or given.shape[1] != 3:
        raise ArgumentError(f"{name} has shape {given.shape}, expected (n, 3), m, or a path")
    if not np.all(np.isfinite(given)):
        row = int(np.flatnonzero(~np.isfinite(given).all(axis=1))[0])
        raise ArgumentError(f"{name}[{row}] is {given[row].tolist()}: give finite numbers, m")
    path = os.path.join(folder, f"points-{index + 1}.csv")
    with open(path, "w", encoding="utf-8", newline="\n") as file:
        file.write("x_m,y_m,z_m\n")
        file.writelines(f"{x!r},{y!r},{z!r}\n" for x, y, z in given.tolist())
    return path


def _measurement(found: dict[str, Any]) -> Measurement:
    figures, registration = found["figures"], found["registration"]
    motion = None
    if registration is not None:
        motion = np.eye(4)
        turn = rotation_from_vector(_DEG * np.array(registration["rotation_vector_deg"]))
        motion[:3, :3] = registration["scale"] * turn
        motion[:3, 3] = 1e-3 * np.array(registration["shift_mm"])
    return Measurement(
        file=found["file"],
        points=figures["points"],
        rms=1e-3 * figures["rms_mm"],
        largest=1e-3 * figures["largest_mm"],
        smoothed_rms=1e-3 * figures["smoothed_rms_mm"],
        smoothed_largest=1e-3 * figures["smoothed_largest_mm"],
        scatter=1e-3 * figures["scatter_mm"],
        effective_points=figures["effective_points"],
        outliers=np.array([point["row"] for point in found["outliers"]], dtype=np.int64),
        beside_corners=np.array(found["beside_corners"], dtype=np.int64),
        left_out=np.array([point["row"] for point in found["left_out"]], dtype=np.int64),
        motion=motion,
        free=() if registration is None else tuple(registration["free"]),
        rejected_rows=np.array([] if registration is None else registration["rejected_rows"], dtype=np.int64),
    )
