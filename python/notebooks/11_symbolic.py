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
# # Symbolic: why does a loaded linkage turn soft?
#
# Two links with a springy joint between them carry a weight $G$ at that joint, like the knee of a toggle press. At some weight the linkage has no stiffness left along its line. Which parameters decide that? Numbers say where; a formula says why.
#
# Needs `pip install "kinetostat[plot,sym]"`.
#
# **Theory.** The first block of the inverse of the bordered matrix with the Hessians of all loads [R 4.28], here with named symbols over SymPy. The chain is symmetric: links $L$ at the angle $a$ above the line, a spring $K$ at rest at $a_0$, and the force that holds the end [R 4.31].

# %%
import matplotlib.pyplot as plt
import numpy as np
import sympy as sp

import kinetostat as ks
from kinetostat import symbolic

a, L, K, G, a0 = sp.symbols("a L K G a0", real=True)
chain = symbolic.Chain("two links").passive("q1", "revolute", "z", at=a).move(L).node("middle")
chain.actuator("theta", "revolute", "z", stiffness=K, at=-2 * a).move(L)
chain.passive("q2", "revolute", "z", at=a)
force = -G * sp.cos(a) / (2 * sp.sin(a)) - 2 * K / L * (a - a0) / sp.sin(a)  # [R 4.31]
stiffness = chain.stiffness(
    directions=("x", "y", "rz"),
    wrench=[force, G / 2, 0, 0, 0, 0],
    loads={"middle": [0, -G, 0, 0, 0, 0]},
)
kx = sp.simplify(stiffness.matrix[0, 0])
print("K_x =", kx)
printed = (
    -G / (4 * L * sp.sin(a) ** 3) - K / L**2 * ((a - a0) * sp.cos(a) - sp.sin(a)) / sp.sin(a) ** 3
)
assert sp.simplify(kx - printed) == 0
print("the report's [R 4.32], with its signs: the same")

# %% [markdown]
# The spring gives $K/L^2$ times a function of the angles; the weight *subtracts* $G / (4 L \sin^3 a)$, whatever the spring. At rest ($a = a_0$) nothing is left at
#
# $G^* = 4 K \sin a_0 / L$.

# %%
critical = sp.solve(kx.subs(a, a0), G)[0]
print("G* =", sp.simplify(critical))
assert sp.simplify(critical - 4 * K * sp.sin(a0) / L) == 0

# %% [markdown]
# ## Check: Table 5.2 of the report
#
# $K_x L^2/K$ for $a_0$ = 15 deg, pulled by $d$ = -0.05 L, 0 and 0.05 L, under four weights. Eleven of the twelve printed values come out; 8.67 does not, the formula gives 7.46 (the book's errata).

# %%
function = sp.lambdify((a, L, K, G, a0), kx, "numpy")
rest = np.radians(15)
star = 4 * np.sin(rest)  # N, for K = 1 N m/rad, L = 1 m
table = {
    0: [6.69, 14.9, 107],
    0.5: [3.36, 8.67, 53.9],
    1: [0.03, 0, 0.58],
    1.5: [-3.31, -7.46, -52.7],
}
moves = np.array([-0.05, 0, 0.05])
angles = np.arccos(np.cos(rest) + moves / 2)
missed = []
print("G/G*    formula                    printed")
for share, row in table.items():
    values = np.round(function(angles, 1.0, 1.0, share * star, rest), 3) + 0.0
    print(f"{share:4}  " + " ".join(f"{v:8.3f}" for v in values), " ", row)
    missed += [p for v, p in zip(values, row, strict=True) if abs(v - p) > 0.006 * max(1, abs(p))]
assert missed == [8.67]

# The core, by numbers only: the same machine pulled along its line with the weight at its elbow.
posture = ks.Machine.preset("two_link").posture()
curves = {}
for share in table:
    curve = posture.curve(
        direction=[1, 0, 0],
        displacement=(-0.2, 0.04),
        free="rz",
        loads=[f"elbow=0,{-share * star:.15g},0"],  # N
    )
    branch = curve.branches[0]
    curves[share] = branch
    angle = np.arccos(np.cos(rest) + branch.displacement / 2)
    assert np.allclose(
        branch.slope, function(angle, 1.0, 1.0, share * star, rest), rtol=1e-6, atol=1e-6
    )

# %% [markdown]
# ## Code for a controller

# %%
small = symbolic.Formula(sp.Matrix([kx]))
print(small.c("stiffness_x"))

# %% alt="Stiffness along the line over the displacement for four weights: at the critical weight it is nearly zero, above it negative; points of Table 5.2 lie on the curves but for one"
figure, axes = plt.subplots(figsize=(7, 4.4))
x = np.linspace(-0.2, 0.05, 200)
for number, share in enumerate(table):
    y = function(np.arccos(np.cos(rest) + x / 2), 1.0, 1.0, share * star, rest)
    axes.plot(x, y, color=f"C{number}", label=f"G = {share} G*")
    shown = slice(None, None, 6)
    core = curves[share]
    axes.plot(core.displacement[shown], core.slope[shown], ".", color=f"C{number}", markersize=7)
    axes.plot(moves[:2], table[share][:2], "ko", mfc="none", markersize=7)
axes.plot([], [], ".", color="0.4", markersize=7, label="core, by numbers")
axes.plot([], [], "ko", mfc="none", label="Table 5.2, printed")
axes.annotate("8.67: not reproduced", (0, 8.67), (-0.15, 9.5), arrowprops={"arrowstyle": "->"})
axes.axhline(0, color="black", linewidth=0.8)
axes.set(xlabel="end pulled by d/L", ylabel="stiffness, K/L^2", ylim=(-10, 20), xlim=(-0.2, 0.05))
axes.set_title("The weight takes the same from the stiffness, whatever the spring")
axes.legend(loc="upper left", fontsize=9, ncols=2)
plt.show()

# %% [markdown]
# ## What to try
#
# - `stiffness.matrix[1, 1]`: across the line it is zero without a load, as the report says, but not under one.
# - `small.latex()`, `.rust()`, `.python()`.
# - `chain.stiffness(steps=True)` for arms of more joints: named intermediate results instead of one formula that no computer simplifies.
# - `symbolic.from_machine(machine)` names the parts of a machine of one limb, `limb=` those of one of several; `symbolic.beam()` and `with_passive_joint` give Tables 3.1 to 3.3.
