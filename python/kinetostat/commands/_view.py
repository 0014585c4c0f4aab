"""``kinetostat view``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

from kinetostat._running import texted

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def view(
    subject: str | float | None = None,
    *,
    at: Sequence[float] | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    port: int | None = None,
    no_browser: bool = False,
    export: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> str:
    """A machine in three dimensions, in the browser: move it, load it, see it bend.

    The page shows the machine with its limbs, joints and platforms, as it is commanded and, larger than
    it is, as it bends under a load; joints, tool and force are moved by hand, and every figure is
    computed anew. With a job, the path of its program is coloured by the error of the tool, before and
    after compensation. Without anything it asks the questions of `kinetostat start` first, and files
    that are dropped onto it are shown. The page comes from this program and goes to this computer only;
    Ctrl-C ends it.

    Parameters
    ----------
    subject : str | float
        Preset, model file, or job file; without one the page asks the questions of `kinetostat
        start`
    at : Sequence[float]
        Start with the tool's tip here, mm, base axes
    joints : str | float | Sequence[str | float]
        Start with these joints, deg and mm, as in shoulder=30 rail=250; others at home
    force : Sequence[float]
        Start with this force on the tool, N, base axes
    moment : Sequence[float]
        Start with this moment on the tool, N m, base axes
    port : int
        Port on this computer [default: any that is free]
    no_browser : bool
        Say where the page is and open no browser
    export : path
        Write the page with its results as one file, which needs no server
    force_overwrite : bool
        Overwrite an existing file
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import os, tempfile
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     _ = ks.commands.view("orthoglide", force=[215, -10, -25], export=os.path.join(folder, "orthoglide.html"))
    ...     os.listdir(folder)
    ['orthoglide.html']
    """
    options: list[tuple[str, Any]] = [
        ("subject", subject),
        ("--at", at),
        ("--joints", joints),
        ("--force", force),
        ("--moment", moment),
        ("--port", port),
        ("--no-browser", no_browser),
        ("--export", export),
        ("--force-overwrite", force_overwrite),
    ]
    return texted(["view"], options, progress)
