# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Buckling: how hard may a linkage be pushed?
#
# Three equal links with two springy joints stand in a flat Z between two hinges, as the bars of a gripper or a leg with soft joints do. One end is pushed towards the other. How far does it stay straight in its Z, and what holds it afterwards?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Under load the stiffness of a chain is the first block of the inverse of a bordered matrix with the Hessian $H$ of the load [R 4.28]. The shape holds as long as $V^T (H - K) V$ is negative definite, with $V$ the motions that leave the end where it is [R 5.21]. Where an eigenvalue passes zero, branches cross. With links of 1 m and springs of 1 N m/rad, forces are in units of $K/L$.

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks
from kinetostat.curves import PointKind

machine = ks.Machine.preset("three_link_z")
posture = machine.posture()
curve = posture.curve(direction=[-1, 0, 0], displacement=(0.0, 0.4))
print(curve)
buckles = next(point for point in curve.special if point.kind is PointKind.PITCHFORK)
print(f"it buckles at {buckles.displacement:.6f} m under {buckles.force:.6f} N")

# %% [markdown]
# ## What Table 5.1 of the report prints
#
# Stable Z at 0.2 m: force 1.05, stiffness 0.21 (units of $K/L$ and $K/L^2$). The cell compares with more digits of that, and of the unstable Z, by an independent program (golden file `z_chain` of the tests).

# %%
shorter = posture.curve(direction=[-1, 0, 0], displacement=(0.0, 0.2))
print("branch     x, m    force, N   slope, N/m   stable when moved")
for number, branch in enumerate(shorter.branches, 1):
    at = branch.displacement.argmax()
    row = branch.displacement[at], branch.force[at], branch.slope[at]
    print(
        f"{number:6} {row[0]:8.3f} {row[1]:11.4f} {row[2]:12.4f}   {branch.stable_when_moved[at]}"
    )
    assert np.allclose(row[1:], [(1.41051127, 3.3601066), (1.05202636, 0.21382344)][number - 1])

# %% [markdown]
# ## Check: one unknown, by hand
#
# With the end at $(x, 0)$ the first angle $q$ says where the first joint is, and two circles say where the second is. What is left is an energy of one variable; its stationary points are the equilibria, and the envelope theorem gives the force.

# %%
REST = np.radians(30)


def energy(q, x, bend=1):
    """Energy of both springs, J; ``bend`` says on which side the second joint lies."""
    first = np.array([np.cos(q), np.sin(q)])
    rest = np.stack([x - first[0], -first[1]])
    reach = np.hypot(*rest)
    opening = np.arccos(np.clip(reach / 2, -1, 1))
    heading = np.arctan2(rest[1], rest[0])
    second, third = heading - bend * opening, heading + bend * opening
    return 0.5 * ((second - q + REST) ** 2 + (third - second - REST) ** 2)


def equilibria(x):
    """(q, force towards the base) of all with the second joint on this side."""
    q = np.linspace(-1.2, 1.2, 24001)
    with np.errstate(invalid="ignore"):
        slope = np.gradient(energy(q, x), q)
    possible = np.hypot(x - np.cos(q), np.sin(q)) < 2 - 1e-9
    roots = np.flatnonzero((slope[:-1] * slope[1:] < 0) & possible[:-1] & possible[1:])
    found = []
    for k in roots:
        root = q[k] - slope[k] * (q[k + 1] - q[k]) / (slope[k + 1] - slope[k])
        force = -(energy(root, x + 1e-5) - energy(root, x - 1e-5)) / 2e-5
        found.append((root, force))
    return found


length = np.sqrt(5 + 4 * np.cos(REST))
at_02 = sorted(force for _, force in equilibria(length - 0.2))
print("forces at 0.2 m by hand, N:", np.round(at_02, 4))
for branch in curve.branches:
    at = np.abs(branch.displacement - 0.2).argmin()
    hand = [force for _, force in equilibria(length - branch.displacement[at])]
    assert np.min(np.abs(np.array(hand) - branch.force[at])) < 1e-5
# The pitchfork by an independent program with many digits (the book's errata of chapter 5).
assert abs(buckles.displacement - 0.110931613194) < 1e-9
assert abs(buckles.force - 1.03347699957) < 1e-9

# %% alt="Force against displacement: the Z is stable up to the pitchfork at 0.111 m and 1.033 N, then a leaning branch is stable at a nearly constant force and the Z is not"
figure, axes = plt.subplots(figsize=(7, 4.4))
for branch, color, label in zip(curve.branches, ("C0", "C1"), ("Z", "leaning Z"), strict=True):
    stable, x = branch.stable_when_moved, 1e3 * branch.displacement
    axes.plot(x, np.where(stable, branch.force, np.nan), color=color, label=f"{label}, stable")
    if branch.begins_at is None:
        unstable = np.where(stable, np.nan, branch.force)
        axes.plot(x, unstable, color=color, ls="--", label=f"{label}, unstable")
some = np.arange(0.02, 0.4, 0.04)
hand = [(1e3 * x, force) for x in some for _, force in equilibria(length - x)]
axes.plot(*np.array(hand).T, "kx", markersize=5, label="energy by hand")
axes.plot(1e3 * buckles.displacement, buckles.force, "ko")
axes.annotate(
    "pitchfork",
    (1e3 * buckles.displacement, buckles.force),
    (60, 1.7),
    arrowprops={"arrowstyle": "->"},
)
axes.set(
    xlabel="end pushed in by, mm", ylabel="force, N (units of K/L)", xlim=(0, 400), ylim=(0, 2.2)
)
axes.set_title("Beyond 111 mm the Z leans over and holds hardly more")
axes.legend(loc="lower right")
plt.show()

# %% [markdown]
# ## What to try
#
# - `posture.shapes(displaced=[-0.2, 0, 0])`: all equilibria there, by their energy; which has the lowest?
# - `ks.curves.critical_load(posture, [-1, 0, 0], most=3)`: how many times may the load grow? The estimate from the first load step (`linear`) is 1.8 % low.
# - `Machine.preset("three_link_s")`, which stands straight at first: it buckles under 1 N at once, like a column.
