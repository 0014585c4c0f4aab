"""``kinetostat check``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def check(
    model: _Path | Machine,
    *,
    force: Sequence[float] | None = None,
    pose: _Path | None = None,
    pose_tolerance_mm: float | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """What a model file or a job file says, in words.

    Of a model: platforms, limbs, actuators with units and limits, passive joints, springs, masses;
    mobility, stiffness at home, effect of deviations, stability under gravity; and everything that
    looks wrong. Of a job: its model, program, placement, load and outputs, and whether the ends of the
    program can be reached; the program is read, not run.

    Parameters
    ----------
    model : path | Machine
        Preset, model file or job file
    force : Sequence[float]
        Load on the tool by which deflections are judged, N, base axes; 1 kN along each axis without
        it
    pose : path
        Compare with poses jogged on the machine instead: a table (CSV) or TOML with joint values
        and the measured pose of the tool
    pose_tolerance_mm : float
        How far apart such poses may be, mm; 0.1 degrees for each millimetre
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.check("orthoglide", force=[100, 0, 0])
    >>> found["home"]["mobility"], found["home"]["degrees_of_over_constraint"], found["warnings"]
    (3, 3, [])
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--force", force),
        ("--pose", pose),
        ("--pose-tolerance-mm", pose_tolerance_mm),
    ]
    return answered(["check"], options, progress)
