"""A map of 1e6 postures of `orthoglide` through Python: time, and memory beside its output; prints lines of figures.

Run by ``cargo xtask figures --python`` in an environment with xarray.
"""

from __future__ import annotations

import time
from pathlib import Path

import numpy as np
from overhead import figure

import kinetostat as ks

SIDE = 100


def resident(name: str) -> float:
    """Memory of this process, bytes: ``VmRSS`` now, ``VmHWM`` at most so far; NaN where the system does not tell."""
    try:
        lines = Path("/proc/self/status").read_text().splitlines()
    except OSError:
        return np.nan
    return next((1024 * float(line.split()[1]) for line in lines if line.startswith(name)), np.nan)


def main() -> None:
    """Measures and prints."""
    machine = ks.Machine.preset("orthoglide")
    axis = np.linspace(-0.06, 0.06, SIDE)
    # What is imported and compiled once is no memory of a map.
    machine.map(x=axis[:4], y=axis[:4], z=axis[:4])
    before = resident("VmRSS")
    start = time.perf_counter()
    found = machine.map(x=axis, y=axis, z=axis)
    seconds = time.perf_counter() - start
    output = sum(variable.nbytes for variable in found.data_vars.values())
    more = resident("VmHWM") - before
    name = f"Python: map of {SIDE**3} postures of orthoglide"
    print(f"{name}: {', '.join(map(str, found.data_vars))}; {output / 1e6:.0f} MB of output, {more / 1e6:.0f} MB of memory")
    figure(f"{name}, stiffness: time", seconds, 10.0, "s")
    figure(f"{name}: memory beside its output", more / output, 4.0, "times")


if __name__ == "__main__":
    main()
