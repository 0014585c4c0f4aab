"""What looks wrong in a question although it can be answered."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

from kinetostat.errors import PlausibilityWarning


def sentences(found: Sequence[tuple[bool, str]]) -> tuple[str, ...]:
    """All of it, for the ``warnings`` of a result."""
    return tuple(said for _, said in found)


def issue(found: Sequence[tuple[bool, str]], *, level: int = 3) -> None:
    """What is beyond a limit is issued as a warning: without ``level``, of the line that called the caller of this function."""
    for beyond, said in found:
        if beyond:
            warnings.warn(said, PlausibilityWarning, stacklevel=level)


def counted(found: Sequence[object]) -> str:
    """How many there are, for the end of a representation."""
    return f"; {len(found)} warning{'s' * (len(found) != 1)}" if found else ""
