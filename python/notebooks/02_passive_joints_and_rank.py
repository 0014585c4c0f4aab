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
# # Passive joints and rank: how far apart may a hexapod's joints be?
#
# Six legs between universal and spherical joints carry a platform. Somebody proposes to arrange the joints of base and platform as two equal regular hexagons, leg beside leg: easy to build. Is the platform held?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** A passive joint takes one direction of stiffness away: $K - K j (j^T K j)^{-1} j^T K$, where $j$ is its motion of the end [R 3.16]. What is left has a lower rank, and that is an answer, not a failure: the null space says what moves freely. A leg between a universal and a spherical joint keeps one direction, along itself [R 3.29]; the platform needs six such that differ [R 3.13].
#
# ## One link and its hinge

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks

L, E, G = 0.8, 210e9, 80e9
builder = ks.MachineBuilder("tube with a hinge")
tube = {"outer_diameter_m": 0.04, "inner_diameter_m": 0.03}
builder.section("tube", tube=tube, youngs_modulus_gpa=E / 1e9, shear_modulus_gpa=G / 1e9)
builder.platform("end", [L, 0, 0])
builder.limb("tube", to="end").link("tube", "tube", L).passive("hinge", "revolute", "z")
stiffness = builder.machine().posture().stiffness()
second = np.pi / 64 * (0.04**4 - 0.03**4)
print(
    f"rank {stiffness.rank}; across, with the end free to turn: {stiffness.matrix[1, 1]:.0f} N/m,"
)
print(f"3 E I / L^3 [R Table 3.3]: {3 * E * second / L**3:.0f} N/m")
for direction in stiffness.directions:
    if direction.kind is ks.DirectionKind.FREE:
        print(
            "free:", direction.twist.round(6), "by", [found["name"] for found in direction.behind]
        )
assert np.isclose(stiffness.matrix[1, 1], 3 * E * second / L**3, rtol=1e-9)

# %% [markdown]
# ## The hexapod of the report, and all between its two
#
# The report compares equal hexagons (A: foot and head of each leg at the same angle) with paired joints (B) [R 3.33 - 3.35]. Both are members of one family: joints of the base $\pm\beta$ from three directions, those of the platform as far from three directions between them.

# %%
RADIUS, TOP, HEIGHT, ALONG = 0.5, 0.3, 0.6, 1e6  # m, m, m, N/m


def ends(beta):
    """Feet and heads of six legs, joints of a pair 2 beta apart (rad)."""
    at = np.radians([0, 0, 120, 120, 240, 240]) + beta * np.array([1, -1] * 3)
    above = np.radians([60, 300, 180, 60, 300, 180]) + beta * np.array([-1, 1] * 3)
    feet = RADIUS * np.stack([np.cos(at), np.sin(at), 0 * at], axis=1)
    heads = TOP * np.stack([np.cos(above), np.sin(above), 0 * above], axis=1)
    return feet, heads + np.array([0, 0, HEIGHT])


def hexapod(beta):
    """The machine of that family."""
    builder = ks.MachineBuilder("hexapod")
    builder.platform("tool", [0, 0, HEIGHT])
    for k, (foot, head) in enumerate(zip(*ends(beta), strict=True)):
        x = (head - foot) / np.linalg.norm(head - foot)
        y = np.cross([0, 0, 1], x) / np.linalg.norm(np.cross([0, 0, 1], x))
        turn = np.stack([x, y, np.cross(x, y)], axis=1)
        limb = builder.limb(
            f"leg {k + 1}",
            to="tool",
            start=ks.pose(foot, turn),
            end=ks.pose(head - [0, 0, HEIGHT], turn),
        )
        limb.passive("foot", "universal", ["y", "z"])
        limb.actuator("ram", "prismatic", "x", ALONG, home=float(np.linalg.norm(head - foot)))
        limb.passive("head", "spherical")
    return builder.machine()


for name, beta, printed in (("A", np.radians(30), 3), ("B", 0.0, 6)):
    found = hexapod(beta).posture().stiffness()
    k = np.round(np.diag(found.matrix))
    print(f"{name}: rank {found.rank} (printed: {printed}); K along x {k[0]:.0f}, z {k[2]:.0f} N/m")

# %% [markdown]
# A has rank 3: it turns freely about the vertical, and about two horizontal axes through the point where the lines of its legs meet. The report's formulas give for A $K_{xx} = 300000$, $K_{zz} = 5400000$ N/m and no stiffness about z [R 3.34], for B $K_{xx} = 1036364$, $K_{zz} = 3927273$ N/m [R 3.35] with these lengths.
#
# ## How far from the pair is too far?


# %%
def by_hand(beta):
    """Sum over the legs of k (u; s x u)(u; s x u)^T, about the tool [R 3.13]."""
    feet, heads = ends(beta)
    u = (heads - feet) / np.linalg.norm(heads - feet, axis=1, keepdims=True)
    lines = np.concatenate([u, np.cross(heads - [0, 0, HEIGHT], u)], axis=1)
    return ALONG * lines.T @ lines


betas = np.radians(np.arange(0, 31, 1))
core = np.array([hexapod(beta).posture().stiffness().matrix for beta in betas])
hand = np.array([by_hand(beta) for beta in betas])
assert np.allclose(core, hand, rtol=1e-9, atol=1e-3)
assert np.allclose(np.diag(hand[-1]), [3e5, 3e5, 5.4e6, 243e3, 243e3, 0], atol=1e-3)
turning = core[:, 5, 5] / 1e3  # kN m/rad
softest = 1e-6 / np.linalg.eigvalsh(np.linalg.inv(core[:-1, :, :])[:, :3, :3])[:, -1]
assert np.allclose(softest / softest[0], turning[:-1] / turning[0], rtol=1e-6)  # fall alike
print(f"in pairs: {turning[0]:.1f} kN m/rad about z, {softest[0]:.3f} N/um softest against a force")
print(f"20 deg apart: {turning[10]:.1f} kN m/rad, {softest[10]:.3f} N/um")

# %% alt="Stiffness about z falls from 100 % to zero as the joints of a pair move 60 degrees apart, while stiffness along z grows by a third"
figure, axes = plt.subplots()
apart = 2 * np.degrees(betas)
axes.plot(apart, 100 * turning / turning[0], label="about z, and softest against a force")
axes.plot(apart, 100 * core[:, 2, 2] / core[0, 2, 2], "--", label="along z")
axes.plot(60, 0, "ko", clip_on=False, zorder=5)
axes.annotate("A: rank 3", (60, 0), (50, 18), arrowprops={"arrowstyle": "->"})
axes.plot(0, 100, "ko", clip_on=False, zorder=5)
axes.annotate("B: pairs, rank 6", (0, 100), (5, 122), arrowprops={"arrowstyle": "->"})
axes.set(xlabel="angle between the two joints of a pair, deg", ylabel="share of that of B, %")
axes.set(xlim=(0, 60), ylim=(0, 150))
axes.set_title("The farther apart, the less holds the platform about z")
axes.legend(loc="lower left")
plt.show()

# %% [markdown]
# ## What to try
#
# - Bearings need room: with the joints of a pair 80 mm apart, which angle is that, and what does it cost?
# - `hexapod(np.radians(30)).posture().stiffness().directions` names the joints that move in each free direction.
# - Turn the platform of A about z: `machine.posture(rotation=...)` with a position. Away from home it is held.
