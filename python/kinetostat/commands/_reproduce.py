"""``kinetostat reproduce``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable
from typing import Any

from kinetostat._running import listed

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def reproduce(
    id: str | float | None = None,
    *,
    html: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> list[dict[str, Any]]:
    """The numbers of the COROUSSO report L1.1, computed again and set beside their print.

    Each table, each equation with a number in it and each figure of chapters 2 to 7: what is printed,
    what comes out, and whether they agree; where they do not, why.

    Parameters
    ----------
    id : str | float
        Which one, as in table-5.2, eq-3.34 or fig-5.7; all without it
    html : path
        Write a page with all numbers and the figures drawn
    force_overwrite : bool
        Overwrite an existing file
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    list of dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.reproduce("eq-3.34")
    >>> found[0]["id"], next(item["status"] for item in found[0]["items"] if item["name"] == "K11")
    ('eq-3.34', 'agrees')
    """
    options: list[tuple[str, Any]] = [
        ("id", id),
        ("--html", html),
        ("--force-overwrite", force_overwrite),
    ]
    return listed(["reproduce"], options, progress)
