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
# # First stiffness: which way may this arm be pushed?
#
# An arm of two steel tubes and two geared drives holds a tool about 1 m from its base. A process pushes the tool with 200 N. How far does it go, and does it go where it is pushed?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Every part that bends is a spring on a rigid chain. With $J$ the motion of the tool by each spring and $K$ their stiffnesses, the tool's compliance is $C = J K^{-1} J^T$, and the Cartesian stiffness its inverse [R 3.7, 3.8]. Both are 6 x 6: forces before moments, base axes.

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks

UPPER, FORE = 0.6, 0.5  # m
DRIVES = 1.2e5, 6.0e4  # N m/rad
ELBOW = np.radians(60)  # rad, with the upper arm along x

tube = {"outer_diameter_m": 0.09, "inner_diameter_m": 0.08}
builder = ks.MachineBuilder("two tubes")
builder.section("tube", tube=tube, youngs_modulus_gpa=210, poissons_ratio=0.3)
tool = np.array([UPPER + FORE * np.cos(ELBOW), FORE * np.sin(ELBOW), 0])
builder.platform("tool", ks.pose(tool, ks.rotation_from_vector([0, 0, ELBOW])))
arm = builder.limb("arm", to="tool")
arm.actuator("shoulder", "revolute", "z", DRIVES[0]).link("upper", "tube", UPPER)
arm.actuator("elbow", "revolute", "z", DRIVES[1], home=ELBOW).link("fore", "tube", FORE)
machine = builder.machine()
posture = machine.posture()
posture.stiffness()

# %% [markdown]
# The table is what Jupyter shows of a stiffness. Nothing is free (rank 6), but a push along x also moves the tool along y: the matrix is not diagonal.
#
# ## Push it all around

# %%
LOAD = 200.0  # N
angle = np.radians(np.arange(0, 361, 3))
push = ks.wrench(np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1) * LOAD)
moved = 1e3 * push @ posture.stiffness().compliance.T  # mm
length = np.linalg.norm(moved[:, :2], axis=1)
for k in (length[:60].argmax(), length[:60].argmin()):
    print(f"pushed towards {np.degrees(angle[k]):3.0f} deg: {length[k]:.3f} mm")

# The same by the core, which bends the arm and solves its equilibrium, for all directions at once.
loaded = machine.equilibrium(np.broadcast_to(posture.target, (len(push), 4, 4)), push)
off = np.abs(1e3 * loaded.displacement[:, :2] - moved[:, :2]).max()
print(f"the bent arm goes elsewhere by at most {1e3 * off:.2f} um: linear is enough here")

# %% alt="The arm from above; around its tool the slender ellipse of the places to which 200 N in all directions move it, and arrows: a push along x moves the tool mostly along the ellipse"
figure, axes = plt.subplots(figsize=(7, 4.2))
for line in posture.limb_lines():
    axes.plot(*1e3 * line[:, :2].T, "o-", color="0.35", linewidth=4, label="arm, from above")
GROWN = 200
at = 1e3 * tool[:2]
axes.plot(*(at + GROWN * moved[:, :2]).T, label=f"tool under {LOAD:.0f} N, x {GROWN}")
for arrow, color in (([200, 0], "C1"), (GROWN * moved[0, :2], "C2")):
    axes.annotate("", at + arrow, at, arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2})
axes.plot([], [], color="C1", label="pushed along x ...")
axes.plot([], [], color="C2", label=f"... it goes there, x {GROWN}")
axes.set(xlabel="x, mm", ylabel="y, mm", aspect="equal", xlim=(-50, 1600))
ratio = length.max() / length.min()
axes.set_title(f"The tool yields {ratio:.0f} times as far one way as the other")
axes.legend(loc="upper right")
plt.show()

# %% [markdown]
# ## Check: the same by hand
#
# A drive turns the rest of the arm about its axis, and a tube is a cantilever: $L/EA$ along, $L^3/3EI$ across, $L^2/2EI$ for the rotation of its end and $L/EI$ for a moment [R 3.25]. Each carries what is behind it along.

# %%
E = 210e9
area = np.pi / 4 * (0.09**2 - 0.08**2)
second = np.pi / 64 * (0.09**4 - 0.08**4)


def at_tool(compliance, place):
    """Compliance (x, y, rz) at a place, seen from the tool."""
    carried = np.eye(3)
    carried[0, 2], carried[1, 2] = -(tool - place)[1], (tool - place)[0]
    return carried @ compliance @ carried.T


def cantilever(length, turned):
    """Compliance (x, y, rz) at the end of a tube."""
    own = np.diag([length / (E * area), length**3 / (3 * E * second), length / (E * second)])
    own[1, 2] = own[2, 1] = length**2 / (2 * E * second)
    turn = ks.rotation_from_vector([0, 0, turned])
    return turn @ own @ turn.T


base, elbow = np.zeros(3), np.array([UPPER, 0, 0])
by_hand = (
    at_tool(np.diag([0, 0, 1 / DRIVES[0]]), base)
    + at_tool(cantilever(UPPER, 0), elbow)
    + at_tool(np.diag([0, 0, 1 / DRIVES[1]]), elbow)
    + at_tool(cantilever(FORE, ELBOW), tool)
)
core = posture.stiffness().compliance[np.ix_([0, 1, 5], [0, 1, 5])]
print(f"compliance along x: {1e6 * by_hand[0, 0]:.4f} um/N by hand, {1e6 * core[0, 0]:.4f} um/N")
assert np.allclose(core, by_hand, rtol=1e-9, atol=1e-15)

# %% [markdown]
# ## What to try
#
# - Stretch the elbow (`ELBOW = 0`): along the arm only the tubes' length yields.
# - Push across the plane: `ks.wrench([0, 0, 200])`. Which part gives way? (`machine.shares(direction="z")`.)
# - Make the drives rigid (`None` in place of a stiffness) and see what is left for the tubes.
