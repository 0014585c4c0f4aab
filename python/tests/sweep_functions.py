"""Functions of sweeps that workers import."""

from __future__ import annotations

import os
import signal
import time
from typing import Any

import numpy as np

import kinetostat as ks


def stiff(
    first: int, last: int, *, threads: int | None, machine: ks.Machine, places: np.ndarray, wait: float = 0.0, kill: str = "", at: int = 5
) -> dict[str, Any]:
    """Stiffness and deflection of places; one worker kills itself by SIGKILL, once, at the chunk that holds row ``at``."""
    time.sleep(wait)
    if kill and first <= at < last:
        try:
            os.close(os.open(kill, os.O_CREAT | os.O_EXCL))
        except FileExistsError:
            pass
        else:
            os.kill(os.getpid(), signal.SIGKILL)
    found = machine.equilibrium(places[first:last], [100, -20, -30, 1, 2, 3], threads=threads)
    return {"status": found.status, "displacement": found.displacement, "stiffness": found.stiffness, "force": found.against_force}


def always_killed(first: int, last: int, *, threads: int | None) -> dict[str, Any]:
    os.kill(os.getpid(), signal.SIGKILL)
    return {}


def counted(first: int, last: int, *, threads: int | None, log: str, fail: int = -1, wait: float = 0.0) -> dict[str, Any]:
    """Notes every chunk that is computed; fails at one."""
    time.sleep(wait)
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"{first}\n")
    if first == fail:
        raise ZeroDivisionError("a place without an answer")
    return {"row": np.arange(first, last), "root": np.sqrt(np.arange(first, last)), "nan": np.full(last - first, np.nan)}


def fails_once(first: int, last: int, *, threads: int | None, mark: str, log: str) -> dict[str, Any]:
    """Notes every attempt; the first at row 5 fails."""
    with open(log, "a", encoding="utf-8") as file:
        file.write(f"{first}\n")
    if first == 5 and not os.path.exists(mark):
        open(mark, "w", encoding="utf-8").close()
        raise OSError("a fault of a node")
    return {"row": np.arange(first, last)}


def short(first: int, last: int, *, threads: int | None) -> dict[str, Any]:
    return {"row": np.arange(first, last - 1)}


def texts(first: int, last: int, *, threads: int | None) -> dict[str, Any]:
    return {"row": np.array(["a"] * (last - first))}


def programs(first: int, last: int, *, threads: int | None, folder: str, names: list[str]) -> dict[str, Any]:
    """Compensates programs and tells the largest error of each before, mm."""
    errors = []
    for name in names[first:last]:
        done = ks.commands.compensate(
            model="orthoglide",
            program=os.path.join(folder, name),
            force=[100, -20, -30],
            out=os.path.join(folder, f"out-{name}"),
            force_overwrite=True,
            threads=threads,
        )
        errors.append(done["summary"]["max_position_error_before_mm"])
    return {"error_before_mm": np.array(errors)}
