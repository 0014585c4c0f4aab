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

CALLS = {
    "equilibria": ("", "machine.equilibrium(places, load)"),
    "targets": ("", "machine.targets(places, load)"),
    "one thread": ("", "machine.equilibrium(places, load, threads=1)"),
}


@pytest.mark.parametrize("name", ["equilibria", "targets", "one thread"])
def test_ctrl_c(name):
    before, call = CALLS[name]
    child = subprocess.Popen(
        [sys.executable, "-c", CHILD.format(before=before, call=call)],
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
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
    seconds = float(at) - sent
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
