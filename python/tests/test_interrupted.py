"""Ctrl-C, and exceptions of callbacks, end a long call at once."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time

import numpy as np
import pytest

import kinetostat as ks

pytestmark = pytest.mark.skipif(os.name != "posix", reason="SIGINT is sent as POSIX systems do")

CHILD = """
import signal, sys, time
import numpy as np
import kinetostat as ks
# Programs that a shell starts in the background ignore it.
signal.signal(signal.SIGINT, signal.default_int_handler)
machine = ks.Machine.preset("orthoglide")
places = np.random.default_rng(0).uniform(-0.05, 0.05, (2_000_000, 3))
load = [100, -20, -30, 0, 0, 0]
{before}
print("begins", flush=True)
try:
    {call}
    print("ended by itself", flush=True)
except KeyboardInterrupt:
    print("interrupted", time.time(), flush=True)
# The module still answers.
assert machine.stiffness(places[:1000]).solved.all()
print("answers", flush=True)
"""

FILES = """
with open("spread.toml", "w") as file:
    file.write('schema = 1\\n[[uncertain]]\\nparameter = "chain.leg.q2.length_mm"\\nnormal = 0.02\\n')
with open("long.ngc", "w") as file:
    file.write("G21 G90\\nG0 X0 Y0 Z5\\nG1 Z-1 F300\\n" + "".join(f"G1 X{50 * (i % 2)} Y{i / 400:.4f}\\n" for i in range(20000)) + "M2\\n")
"""

CALLS = {
    "equilibria": ("", "machine.equilibrium(places, load)"),
    "targets": ("", "machine.targets(places, load)"),
    "one thread": ("", "machine.equilibrium(places, load, threads=1)"),
    # Commands of the command line in this process; each takes far longer than a test by itself.
    "command map": ("", "ks.commands.map('orthoglide', x=[-50, 50, 300], y=[-50, 50, 300], z=[-50, 50, 20], force=load[:3])"),
    "command equilibria": ("", "ks.commands.equilibria('orthoglide', force=load[:3], starts=1_000_000, fruitless=1_000_000)"),
    "command tolerance": (FILES, "ks.commands.tolerance('orthoglide', uncertain='spread.toml', machines=1_000_000)"),
    "command compensate": (FILES, "ks.commands.compensate(model='orthoglide', program='long.ngc', out='out.ngc', force=load[:3])"),
    # 30 numbers of a million draws, the first arrays of this process.
    "draws": ("", "ks.tolerance.draws([1.0] * 30, [ks.tolerance.normal(1)] * 30, 10**6)"),
    "sobol": ("", "ks.tolerance.sobol(lambda x: x[:, 0], [0.0] * 20, [ks.tolerance.normal(1)] * 20, 2**18)"),
    "shapes": ("", "machine.posture().shapes(force=load[:3], starts=1_000_000, fruitless=1_000_000)"),
}


def interrupted_after(name, folder):
    """Seconds from Ctrl-C to ``KeyboardInterrupt`` of a call that runs in a process and a folder of its own, which it leaves empty."""
    before, call = CALLS[name]
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD.format(before=before, call=call)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        cwd=folder,
        env=os.environ | {"PYTHONPATH": os.pathsep.join(os.path.abspath(path) for path in sys.path if path)},
    )
    try:
        assert child.stdout is not None
        assert child.stdout.readline() == "begins\n"
        time.sleep(0.3)
        sent = time.time()
        child.send_signal(signal.SIGINT)
        out, err = child.communicate(timeout=60)
    finally:
        child.kill()
        child.wait()
    first, second = out.splitlines()
    word, at = first.split()
    assert word == "interrupted", (out, err)
    assert second == "answers"
    left = {path.name for path in folder.iterdir()} - {"spread.toml", "long.ngc"}
    assert not left, f"half written: {left}"
    return float(at) - sent


@pytest.mark.parametrize("name", CALLS)
def test_ctrl_c(name, tmp_path):
    seconds = interrupted_after(name, tmp_path)
    print(f"{name}: KeyboardInterrupt after {seconds:.3f} s, 0.5 s are asked for")
    # Other programs of this machine take their time too.
    assert seconds < 3.0


def test_an_exception_of_the_callback_comes_out():
    machine = ks.Machine.preset("orthoglide")
    places = np.random.default_rng(0).uniform(-0.05, 0.05, (300_000, 3))

    def progress(done, total, stage):
        if done:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        machine.equilibrium(places, [100, 0, 0, 0, 0, 0], progress=progress)
    assert machine.stiffness(places[:1000]).solved.all()


def test_progress_ends_with_all():
    machine = ks.Machine.preset("orthoglide")
    seen = []
    machine.stiffness(np.zeros((5000, 3)), progress=lambda *now: seen.append(now))
    done = [each[0] for each in seen]
    assert done == sorted(done)
    assert done[-1] == 5000
    assert {total for _, total, _ in seen} <= {0, 5000}
