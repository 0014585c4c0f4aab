"""Machines as values: pickled, copied, compared, hashed the same in every process, shared by threads and by forked processes."""

from __future__ import annotations

import copy
import multiprocessing
import os
import pickle
import subprocess
import sys
import threading

import numpy as np
import pytest

import kinetostat as ks

NAMES = sorted(ks.preset_names())
PLACES = np.random.default_rng(5).uniform(-0.05, 0.05, (3000, 3))


@pytest.mark.parametrize("name", NAMES)
def test_pickled_copied_and_compared(name):
    machine = ks.Machine.preset(name)
    for protocol in range(2, pickle.HIGHEST_PROTOCOL + 1):
        again = pickle.loads(pickle.dumps(machine, protocol))
        assert again == machine
        assert hash(again) == hash(machine)
        assert again.name == machine.name
    assert copy.copy(machine) == machine == copy.deepcopy(machine)
    assert ks.Machine.from_dict(machine.to_dict()).fingerprint == ks.Machine.from_toml(machine.to_toml()).fingerprint
    assert {machine: 1}[ks.Machine.preset(name)] == 1


def test_tool_is_part_of_the_value():
    machine = ks.Machine.preset("heavy_6r")
    longer = machine.with_tool(length=0.2)
    assert longer != machine
    again = pickle.loads(pickle.dumps(longer))
    assert again == longer
    np.testing.assert_array_equal(again.tool, longer.tool)
    np.testing.assert_array_equal(again.posture().stiffness().matrix, longer.posture().stiffness().matrix)


def test_all_presets_differ():
    assert len({ks.Machine.preset(name) for name in NAMES}) == len(NAMES)


def test_hash_is_the_same_in_every_process():
    ask = "import kinetostat as ks; m = ks.Machine.preset('orthoglide'); print(hash(m), m.fingerprint)"
    said = set()
    for seed in ("0", "1", "random"):
        env = {**os.environ, "PYTHONHASHSEED": seed}
        said.add(subprocess.run([sys.executable, "-c", ask], env=env, check=True, capture_output=True, text=True).stdout)
    machine = ks.Machine.preset("orthoglide")
    assert said == {f"{hash(machine)} {machine.fingerprint}\n"}


def test_saved_and_opened(tmp_path):
    machine = ks.Machine.preset("orthoglide")
    path = tmp_path / "mine.toml"
    machine.save(path)
    assert ks.Machine.open(path).fingerprint == ks.Machine.from_toml(machine.to_toml()).fingerprint
    assert [entry.name for entry in tmp_path.iterdir()] == ["mine.toml"]


def test_any_number_of_threads_gives_the_same_bits():
    machine = ks.Machine.preset("orthoglide")
    wanted = machine.equilibrium(PLACES, [100, -20, -30, 0, 0, 0], threads=1)
    for threads in (None, 2, 3, 16):
        found = machine.equilibrium(PLACES, [100, -20, -30, 0, 0, 0], threads=threads)
        for name, array in wanted.to_dict().items():
            np.testing.assert_array_equal(getattr(found, name), array, err_msg=f"{name}, {threads} threads")


def test_threads_of_python_share_a_machine():
    machine = ks.Machine.preset("orthoglide")
    wanted = machine.stiffness(PLACES).matrix
    found = [None] * 4

    def ask(i):
        found[i] = machine.stiffness(PLACES, threads=1 + i % 2).matrix

    threads = [threading.Thread(target=ask, args=(i,)) for i in range(len(found))]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    for matrix in found:
        np.testing.assert_array_equal(matrix, wanted)


def test_others_run_meanwhile():
    """The interpreter is not held while the core works."""
    machine = ks.Machine.preset("orthoglide")
    many = np.tile(PLACES, (20, 1))
    done = threading.Event()
    turns = 0

    def ask():
        machine.equilibrium(many, [100, 0, 0, 0, 0, 0], threads=1)
        done.set()

    thread = threading.Thread(target=ask)
    thread.start()
    while not done.wait(0.001):
        turns += 1
    thread.join()
    assert turns > 5


def in_child(machine, to):
    to.send(machine.stiffness(PLACES).matrix)


@pytest.mark.skipif(not hasattr(os, "fork"), reason="this system does not fork")
# Python 3.12 warns of threads of the parent: that is what this test is about.
@pytest.mark.filterwarnings("ignore:This process .* is multi-threaded:DeprecationWarning")
@pytest.mark.parametrize("method", ["fork", "spawn"])
def test_child_processes_compute_on_their_own_threads(method):
    machine = ks.Machine.preset("orthoglide")
    wanted = machine.stiffness(PLACES).matrix
    context = multiprocessing.get_context(method)
    mine, theirs = context.Pipe()
    child = context.Process(target=in_child, args=(machine, theirs))
    child.start()
    assert mine.poll(60), "the child waits for threads that it does not have"
    np.testing.assert_array_equal(mine.recv(), wanted)
    child.join(10)
    assert child.exitcode == 0
