"""``kinetostat demo``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def demo(
    *,
    out: _Path | None = None,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Mill a circular groove on a bending machine: the first look.

    Writes the program, the compensated program, the report, the result and the points, and the model
    and job files that repeat the run.

    Parameters
    ----------
    out : path
        Directory for the files; it is made if it does not exist
    force_overwrite : bool
        Overwrite files of the same names in it
    threads : int
        Number of threads; all cores without it
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import os, tempfile
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     found = ks.commands.demo(out=folder)
    ...     files = os.listdir(folder)
    >>> found["tolerance"]["held"], "report.html" in files
    (True, True)
    """
    options: list[tuple[str, Any]] = [
        ("--out", out),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["demo"], options, progress)
