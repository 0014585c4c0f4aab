"""Limits of milling by a collocation written afresh: numbers for a test of kinetostat-chatter.

Only the arc is collocated: outside of the cut the tool swings freely, which is a matrix exponential. On the arc

    z' = A z + B D(t) [C z(t) - C z(t - tau)]

at Chebyshev points, exactly at all of them; the arc of the period before is the only memory. The same operator by
first-order semi-discretisation (a second program in this file) at two step counts, extrapolated, must agree.
Conventions of dynamics.md (D8). Needs numpy and scipy; no input.
"""

import json
import sys

try:
    import numpy as np
    from scipy.linalg import expm
except ImportError:
    sys.exit(3)

# Three modes of a tool that lie in no axis; shapes in 1/sqrt(kg), base axes.
SHAPES = np.array([[1.1, 0.5, -0.3], [-0.6, 1.3, 0.4], [0.2, -0.7, 0.9]])
HZ, ZETA = np.array([41.0, 55.0, 128.0]), np.array([0.025, 0.03, 0.018])
KT, KR, KA = 7.1e8, 2.3e8, 0.6e8
TEETH, RPM, FEED = 3, 2300.0, np.radians(35.0)
ENTRY, EXIT = np.arccos(2 * 0.35 - 1), np.pi  # down-milling, a_e/D = 0.35


def system():
    c, s = np.cos(FEED), np.sin(FEED)
    frame = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]])  # columns: feed, left of it, spindle
    shapes = SHAPES @ frame  # rows: shapes seen along feed, normal, axis
    w = 2 * np.pi * HZ
    n = len(w)
    a = np.block([[np.zeros((n, n)), np.eye(n)], [-np.diag(w**2), -np.diag(2 * ZETA * w)]])
    b = np.vstack([np.zeros((n, 3)), shapes])
    return a, b, np.hstack([shapes.T, np.zeros((3, n))])


def cutting(phi):
    """D of (D8) for one tooth, per metre of depth."""
    n = np.array([np.sin(phi), np.cos(phi), 0.0])
    t = np.array([np.cos(phi), -np.sin(phi), 0.0])
    return -np.outer(KT * t + KR * n + KA * np.array([0, 0, 1.0]), n)


def chebyshev(n):
    x = np.cos(np.pi * np.arange(n + 1) / n)
    c = np.r_[2.0, np.ones(n - 1), 2.0] * (-1) ** np.arange(n + 1)
    d = np.outer(c, 1 / c) / (x[:, None] - x[None, :] + np.eye(n + 1))
    return d - np.diag(d.sum(axis=1)), x


def collocated(depth, n=60):
    a, b, c = system()
    omega = RPM * 2 * np.pi / 60
    tau, arc = 60 / (TEETH * RPM), (EXIT - ENTRY) / omega
    assert EXIT - ENTRY < 2 * np.pi / TEETH  # one tooth at a time
    d, x = chebyshev(n)
    d, x = d[::-1, ::-1], x[::-1]
    size = len(a)
    left, right = np.kron(d * 2 / arc, np.eye(size)), np.zeros(((n + 1) * size,) * 2)
    for i in range(n + 1):
        force = b @ (depth * cutting(ENTRY + (x[i] + 1) / 2 * (EXIT - ENTRY))) @ c
        s = slice(i * size, (i + 1) * size)
        left[s, s] -= a + force
        right[s, s] = -force
    left[:size], right[:size] = 0, 0
    left[:size, :size] = np.eye(size)
    right[:size, -size:] = expm(a * (tau - arc))
    values = np.linalg.eigvals(np.linalg.solve(left, right))
    return values[np.argmax(np.abs(values))]


def semi_discretised(depth, steps):
    a, b, c = system()
    omega = RPM * 2 * np.pi / 60
    tau, arc = 60 / (TEETH * RPM), (EXIT - ENTRY) / omega
    h, size = arc / steps, len(a)
    # Known: the state at the entry, and the displacements at all steps' ends of the arc before.
    total = size + 3 * (steps + 1)
    state, seen = np.eye(total)[:size], []
    before = np.eye(total)[size:]
    for i in range(steps):
        seen.append(c @ state)
        force = b @ (depth * cutting(ENTRY + (i + 0.5) / steps * (EXIT - ENTRY)))
        # The delayed displacement is linear within the step: an augmented exponential integrates it exactly.
        big = np.zeros((size + 6, size + 6))
        big[:size, :size], big[:size, size:size + 3], big[size:size + 3, size + 3:] = a + force @ c, -force, np.eye(3)
        p = expm(big * h)
        old, new = before[3 * i:3 * i + 3], before[3 * i + 3:3 * i + 6]
        state = p[:size, :size] @ state + p[:size, size:size + 3] @ old + p[:size, size + 3:] @ (new - old) / h
    seen.append(c @ state)
    values = np.linalg.eigvals(np.vstack([expm(a * (tau - arc)) @ state, *seen]))
    return np.abs(values).max()


def main():
    depth = 2.0e-4
    exact = {str(n): abs(collocated(depth, n)) for n in (24, 36, 60)}
    coarse, fine = semi_discretised(depth, 60), semi_discretised(depth, 120)
    low, high, scan = 0.0, None, 0.0
    while high is None:  # the first crossing by a fine scan
        scan += 2e-6
        if abs(collocated(scan, 30)) > 1:
            low, high = scan - 2e-6, scan
    for _ in range(50):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if abs(collocated(middle)) > 1 else (middle, high)
    value = collocated(high)
    json.dump({
        "multiplier_at_0.2_mm": exact,
        "semi_discretisation_extrapolated": (4 * fine - coarse) / 3,
        "limit_m": high,
        "multiplier": [value.real, value.imag],
    }, sys.stdout, indent=1)


main()
