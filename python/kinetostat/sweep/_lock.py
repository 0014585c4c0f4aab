"""One run at a time writes a folder. The lock ends with the process, however it ends."""

from __future__ import annotations

import os
from pathlib import Path

from kinetostat.errors import ArgumentError

_HELD: set[int] = set()


def lock(file: Path) -> int:
    """Locks a file, which is made if it is not there."""
    held = os.open(file, os.O_RDWR | os.O_CREAT, 0o666)
    try:
        import fcntl

        fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except ImportError:
        pass  # not on Windows
    except BlockingIOError:
        os.close(held)
        raise ArgumentError(f"{file.parent} is being written by another run") from None
    _HELD.add(held)
    return held


def unlock(held: int) -> None:
    """Ends a lock."""
    _HELD.discard(held)
    os.close(held)


def _forked() -> None:
    """Workers that outlive a killed parent must not hold its lock."""
    while _HELD:
        os.close(_HELD.pop())


if hasattr(os, "register_at_fork"):
    os.register_at_fork(after_in_child=_forked)
