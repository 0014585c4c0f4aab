"""Import time of the package and what a call through Python costs beside the same call in Rust; prints lines of figures.

Run by ``cargo xtask figures`` with the program ``python_calls`` as its argument. Python and Rust take turns in rounds of about
20 ms, and the median of the differences counts: a machine whose speed wavers by a tenth from second to second touches both alike.
"""

from __future__ import annotations

import json
import statistics
import subprocess
import sys
import timeit
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np

import kinetostat as ks

COUNT = 20_000
ROUNDS = 200
# Of calls that answer many postures.
FEW = 20


def figure(name: str, measured: float, most: float, unit: str) -> None:
    """A line that ``cargo xtask figures`` reads."""
    line = {"name": name, "measured": measured, "asked": f"at most {most}", "unit": unit, "holds": bool(measured <= most)}
    print("figure " + json.dumps(line))


def time(call: Callable[[], Any], calls: int) -> float:
    """Time of one of so many calls, us."""
    return timeit.timeit(call, number=calls) / calls * 1e6


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
    # A small machine, beside whose time a few microseconds are seen. An equilibrium of the orthoglide takes 190 us, and the same
    # code in another file, a program or a library, takes some percent more or less of that.
    file = Path(__file__).with_name("gantry.toml")
    model = ks.Machine.open(file)
    small, large = model.posture(pose=model.home), machine.posture(pose=poses[0])
    load = ks.wrench([100, -20, -30])
    # What is called, calls and what one call answers, rounds.
    calls: dict[str, tuple[Callable[[], Any], int, float, int]] = {
        "one_stiffness": (lambda: small.stiffness(), 1000, 1.0, ROUNDS),
        "one_equilibrium": (lambda: small.deflected_by(load), 1000, 1.0, ROUNDS),
        "one_of_orthoglide": (lambda: large.deflected_by(load), 100, 1.0, ROUNDS),
        "many_stiffness": (lambda: machine.stiffness(poses, threads=1), 1, COUNT, FEW),
        "many_equilibria": (lambda: machine.equilibrium(poses, load, threads=1), 1, COUNT, FEW),
    }
    over: dict[str, tuple[float, float]] = {}
    with subprocess.Popen([sys.argv[1], str(file)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True) as rust:
        assert rust.stdin
        assert rust.stdout
        rust.stdin.write(";".join(" ".join(map(repr, row)) for row in places.tolist()) + "\n")
        for name, (call, number, each, rounds) in calls.items():
            own, native = np.empty(rounds), np.empty(rounds)
            for i in range(rounds):
                print(name, number, file=rust.stdin, flush=True)
                native[i] = float(rust.stdout.readline())
                own[i] = time(call, number) / each
            more, percent = own - native, 100 * (own / native - 1)
            over[name] = float(np.median(more)), float(np.median(percent))
            spread = np.subtract(*np.percentile(more, [75, 25]))
            print(
                f"{name:<18} Python {np.median(own):8.3f} us, Rust {np.median(native):8.3f} us, {over[name][0]:+.3f} us over Rust "
                f"(half of {rounds} rounds within {spread:.3f} us)"
            )
    for name, what in (("one_stiffness", "stiffness of a posture"), ("one_equilibrium", "equilibrium of a posture")):
        figure(f"Python: one call over Rust, {what}", over[name][0], 3.0, "us")
    for name, what in (("many_stiffness", "stiffness"), ("many_equilibria", "equilibria")):
        figure(f"Python: {COUNT} postures over Rust, {what}", over[name][1], 10.0, "%")


if __name__ == "__main__":
    main()
