"""``kinetostat dialect``; made by python/tools/make_commands.py."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from kinetostat._running import answered, texted

_Progress = Callable[[int, int, str], object]


def dialect_list(
    *,
    progress: _Progress | None = None,
) -> str:
    """The languages that are read.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "krl" in ks.commands.dialect_list()
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["dialect", "list"], options, progress)


def dialect_show(
    name: str | float,
    *,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Every word of a language: followed, carried byte for byte, or refused and why.

    Parameters
    ----------
    name : str | float
        Name of a language, as `dialect list` has it
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.dialect_show("krl")
    >>> next(word["treatment"] for word in found["words"] if word["word"] == "LIN")
    'followed'
    """
    options: list[tuple[str, Any]] = [
        ("name", name),
    ]
    return answered(["dialect", "show"], options, progress)
