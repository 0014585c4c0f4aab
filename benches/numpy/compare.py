"""numpy and kinetostat beside each other: one process, one core, one thread, interleaved, medians.

Started by `cargo xtask bench-vs-numpy [--json]`, which makes numpy and the module `kinetostat_bench`
available. With --json a list on stdout and nothing else.
"""
import argparse
import json
import os
import statistics
import sys
import time
from pathlib import Path

# Before numpy is loaded.
for name in ('OPENBLAS_NUM_THREADS', 'OMP_NUM_THREADS', 'MKL_NUM_THREADS', 'RAYON_NUM_THREADS'):
    os.environ[name] = '1'
if hasattr(os, 'sched_setaffinity'):
    os.sched_setaffinity(0, {max(os.sched_getaffinity(0))})

import numpy as np  # noqa: E402

import baseline  # noqa: E402
import kinetostat_bench  # noqa: E402
from machines import Arm, Hexapod, Puu, Rod  # noqa: E402

MODELS = Path(__file__).resolve().parent.parent / 'models'
# What issue and design ask for, times faster than numpy.
REQUIRED = {'W1': (15, 25), 'W2': (30, 45), 'W3': (50, 90), 'W3+K': (25, 45), 'W4': (10, 15), 'W5': (200, 360)}
MEANING = {'W1': 'arm: J and K_C', 'W2': 'hexapod: K_C', 'W3': 'arm: equilibrium', 'W3+K': 'arm: equilibrium and K_C',
           'W4': '3-PUU: equilibrium', 'W5': 'rod: equilibrium'}
MOST_APART = 1e-9
# Postures in one call of kinetostat: its results then stay in the cache of the core.
BLOCK = 256


def poses(place, turn=None):
    """Twelve numbers per posture: rotation matrix row by row, position."""
    turn = np.broadcast_to(np.eye(3), (len(place), 3, 3)) if turn is None else turn
    return np.ascontiguousarray(np.hstack([turn.reshape(-1, 9), place]))


def slices(count, size):
    return [slice(i, min(i + size, count)) for i in range(0, count, size)]


class Work:
    """One benchmark case: the same postures for both, numpy in batches of the size that is best for it."""

    def __init__(self, name, model, question, count, batch, numpy, **given):
        self.name, self.model, self.question, self.count, self.given = name, model, question, count, given
        self.parts, self.numpy = slices(count, batch), numpy
        self.task = self.open(model)

    def open(self, model):
        rows = {key: np.ascontiguousarray(value).tobytes() for key, value in self.given.items()}
        return kinetostat_bench.Task(MODELS / f'{model}.toml', self.question, **rows)

    def run_numpy(self):
        """Results are dropped batch by batch, as those of kinetostat are."""
        for part in self.parts:
            self.numpy(part)

    def difference(self, pairs):
        """Largest difference of a number to the largest number of its item, over `pairs` of results."""
        answers = self.task.answers(BLOCK)
        if answers['not_found']:
            return float('nan')
        worst = 0.0
        for part in self.parts:
            for mine, theirs in pairs(answers, self.numpy(part), part):
                mine, theirs = mine.reshape(len(mine), -1), np.asarray(theirs).reshape(len(mine), -1)
                apart = np.abs(mine - theirs).max(1) / np.abs(theirs).max(1)
                worst = max(worst, apart.max()) if np.isfinite(apart).all() else float('nan')
        return float(worst)


def table(answers, name, width, part):
    return np.frombuffer(answers[name]).reshape(-1, width)[part]


def cases():
    """The cases with what is compared of their results."""
    joints, wrench = Arm.postures(10000), Arm.wrenches(10000)
    place, angles = Hexapod.postures(10000)
    few = slice(0, 2000)
    puu_place, puu_wrench = Puu.postures(2000), Puu.wrenches(2000)
    arm = dict(joints=joints[few], wrenches=wrench[few])
    return [
        (Work('W1', 'arm', 'stiffness+jacobian', 10000, 1000, lambda s: baseline.arm_stiffness(joints[s]), joints=joints),
         lambda a, r, s: [(table(a, 'jacobian', 252, s), r[0]), (table(a, 'stiffness', 36, s), r[1])]),
        (Work('W2', 'hexapod', 'stiffness', 10000, 250, lambda s: baseline.hexapod_stiffness(place[s], angles[s]),
              poses=poses(place, baseline.turn_xyz(angles))),
         lambda a, r, s: [(table(a, 'stiffness', 36, s), r)]),
        (Work('W3', 'arm', 'equilibrium', 2000, 100, lambda s: baseline.arm_equilibrium(joints[s], wrench[s], False), **arm),
         lambda a, r, s: [(table(a, 'coordinates', 42, s), r[0]), (table(a, 'tool', 12, s)[:, 9:], r[1])]),
        (Work('W3+K', 'arm', 'equilibrium+stiffness', 2000, 100,
              lambda s: baseline.arm_equilibrium(joints[s], wrench[s], True), **arm),
         lambda a, r, s: [(table(a, 'stiffness', 36, s), r[2]), (table(a, 'coordinates', 42, s), r[0])]),
        (Work('W4', 'puu3', 'equilibrium', 2000, 50, lambda s: baseline.puu_equilibrium(puu_place[s], puu_wrench[s]),
              poses=poses(puu_place), wrenches=puu_wrench),
         lambda a, r, s: [(table(a, 'tool', 12, s)[:, 9:], r[0]), (table(a, 'tool', 12, s)[:, :9], r[1])]),
        (Work('W5', 'rod', 'equilibrium', 1, 1, lambda s: baseline.rod_equilibrium(),
              poses=poses(np.array([[1., 0, 0]])), wrenches=np.array([[0, Rod.force, 0, 0, 0, 0]])),
         lambda a, r, s: [(table(a, 'tool', 12, s)[:, 9:], r[None])]),
    ]


def seconds(run):
    """What this process computed, all its threads, so that other programs on the core count for neither side."""
    start = time.process_time()
    run()
    return time.process_time() - start


def measure(case, rounds, twin=None):
    """Medians in us per posture: numpy, kinetostat, kinetostat with the default law of links."""
    runs = [case.run_numpy] + [lambda task=task: task.run(BLOCK) for task in (case.task, twin) if task]
    # A short pass is repeated, so that every median rests on as much.
    passes = [max(1, min(7, round(.02 / seconds(run)))) for run in runs]
    times = [[] for _ in runs]
    for _ in range(rounds):
        for run, own, count in zip(runs, times, passes):
            own += [seconds(run) for _ in range(count)]
    return [statistics.median(own) / case.count * 1e6 for own in times]


def main():
    options = argparse.ArgumentParser()
    options.add_argument('--json', action='store_true')
    options.add_argument('--rounds', type=int, default=15)
    options = options.parse_args()
    say = lambda text: None if options.json else print(text, flush=True)  # noqa: E731
    say(f'numpy {np.__version__}, one core, one thread, medians of {options.rounds} interleaved rounds; us of CPU time per posture\n')
    say(f'{"work":<32}{"numpy":>11}{"kinetostat":>12}{"ratio":>8}{"must":>6}{"goal":>6}{"links bow":>12}{"apart":>10}')
    rows = []
    for case, pairs in cases():
        apart = case.difference(pairs)
        twin = None if options.json else case.open(f'{case.model}_bowing')
        numpy, own, *bowing = measure(case, options.rounds, twin)
        row = {'work': case.name, 'kinetostat_us': own, 'numpy_us': numpy, 'ratio': numpy / own,
               'max_relative_difference': apart}
        rows.append(row)
        must, goal = REQUIRED[case.name]
        say(f'{case.name + "  " + MEANING[case.name]:<32}{numpy:11.3f}{own:12.4f}{row["ratio"]:8.1f}{must:6}{goal:6}'
            f'{(bowing or [0])[0]:12.4f}{apart:10.1e}')
        answers = case.task.answers(BLOCK)
        scalar = case.count - answers['vectorised']
        if scalar:
            say(f'      {scalar} of {case.count} postures are solved one by one' + (f': {case.task.scalar_reason()}' if case.task.scalar_reason() else ''))
    if options.json:
        json.dump(rows, sys.stdout, indent=1)
        print()
    else:
        say('\napart: largest difference of a number to the largest of its item. links bow: the same machine with the'
            '\ndefault law of links, in which a link shortens as it bends; numpy has the plain springs only.')
    apart = [row['work'] for row in rows if not row['max_relative_difference'] <= MOST_APART]
    if apart:
        sys.exit(f'numpy and kinetostat differ by more than {MOST_APART} in {", ".join(apart)}')


main()
