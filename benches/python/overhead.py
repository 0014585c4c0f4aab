"""Import time of the package and what a call through Python costs beside the same call in Rust; prints lines of figures.

Run by ``cargo xtask figures`` with the program ``python_calls`` as its argument. Rounds of Python and Rust take turns, and the
shortest time counts: what other programs of the machine do meanwhile touches both alike.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import timeit
from collections.abc import Callable
from typing import Any

import numpy as np

import kinetostat as ks

COUNT = 20_000
ROUNDS = 4


def figure(name: str, measured: float, most: float, unit: str) -> None:
    """A line that ``cargo xtask figures`` reads."""
    line = {"name": name, "measured": measured, "asked": f"at most {most}", "unit": unit, "holds": bool(measured <= most)}
    print("figure " + json.dumps(line))


def shortest(call: Callable[[], Any], number: int) -> float:
    """Shortest time of a call, us."""
    return min(timeit.repeat(call, number=number, repeat=7)) / number * 1e6


def import_seconds() -> float:
    """Median time of an import in processes of their own."""
    ask = "import time; s = time.perf_counter(); import kinetostat; print(time.perf_counter() - s)"
    runs = [subprocess.run([sys.executable, "-c", ask], check=True, capture_output=True, text=True) for _ in range(9)]
    return statistics.median(float(run.stdout) for run in runs)


def main() -> None:
    """Measures and prints."""
    figure("Python: import of the package, numpy included", import_seconds(), 0.15, "s")
    machine = ks.Machine.preset("orthoglide")
    places = np.random.default_rng(1).uniform(-0.05, 0.05, (COUNT, 3))
    poses = np.tile(machine.home, (COUNT, 1, 1))
    poses[:, :3, 3] = places
    given = "\n".join(" ".join(map(repr, row)) for row in places.tolist())
    # A small machine, beside whose time a few microseconds are seen: of a call of 190 us this machine alone loses or gains more.
    small = ks.Machine.preset("two_link")
    posture = small.posture(pose=small.home)
    # It folds over under a load.
    bearing = machine.posture(pose=poses[0])
    load = ks.wrench([100, -20, -30])
    calls: dict[str, tuple[Callable[[], Any], int, float]] = {
        "one_stiffness_us": (lambda: posture.stiffness(), 2000, 1.0),
        "one_equilibrium_us": (lambda: bearing.deflected_by(load), 500, 1.0),
        "many_stiffness_us": (lambda: machine.stiffness(poses, threads=1), 1, COUNT),
        "many_equilibria_us": (lambda: machine.equilibrium(poses, load, threads=1), 1, COUNT),
    }
    own = dict.fromkeys(calls, np.inf)
    rust = dict.fromkeys(calls, np.inf)
    for _ in range(ROUNDS):
        said = subprocess.run([sys.argv[1]], input=given, check=True, capture_output=True, text=True).stdout
        for name, value in json.loads(said).items():
            rust[name] = min(rust[name], value)
        for name, (call, number, each) in calls.items():
            own[name] = min(own[name], shortest(call, number) / each)
    for name in calls:
        print(f"{name:<20} Python {own[name]:9.3f} us, Rust {rust[name]:9.3f} us")
    for name, what in (("one_stiffness_us", "stiffness of a posture"), ("one_equilibrium_us", "equilibrium of a posture")):
        figure(f"Python: one call over Rust, {what}", own[name] - rust[name], 3.0, "us")
    for name, what in (("many_stiffness_us", "stiffness"), ("many_equilibria_us", "equilibria")):
        figure(f"Python: {COUNT} postures over Rust, {what}", 100 * (own[name] / rust[name] - 1), 10.0, "%")


if __name__ == "__main__":
    main()
