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
# # Maps: where should the part lie?
#
# A plate of 60 mm by 60 mm is to be milled on an Orthoglide whose workspace is a cube of 200 mm. The machine is not equally stiff in it. Where on the table does the plate suffer least?
#
# Needs `pip install "kinetostat[plot,io]"`.
#
# **Theory.** The softest stiffness against a force is the inverse of the largest eigenvalue of the compliance of positions, with the tool free to turn. A map asks that, or anything else, at every place of a grid at once; it is a Dataset of xarray, so labels, units and files come along.

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks
from kinetostat import maps

machine = ks.Machine.preset("orthoglide")
grid = np.arange(-0.09, 0.1401, 0.005)  # m
feeds = {
    "feed along x": ks.wrench([215, -10, -25]),
    "feed along y": ks.wrench([10, 215, -25]),
}  # N, on the tool
found = machine.map(
    x=grid,
    y=grid,
    z=0.0,
    loads=feeds,
    variables=["stiffness_softest", "deflection"],
)
print(dict(found.sizes), "-", found.deflection.attrs["long_name"])
soft = found.stiffness_softest.sel(load="feed along x")
print(f"softest stiffness from {1e-6 * soft.min():.3f} to {1e-6 * soft.max():.3f} N/um")

# %% [markdown]
# ## Check: two published places
#
# At the isotropic point the compliance of the identified machine is $3.331344 \cdot 10^{-4}$ mm/N in all directions; at Q1 = (126.35, 126.35, 126.35) mm it has $28.86266$ on the diagonal and $-13.84484$ beside it, both $10^{-4}$ mm/N, by an independent program (golden file `orthoglide_unloaded` of the tests). The eigenvalues of such a matrix are $a - b$ twice and $a + 2b$.

# %%
q1 = 0.12635
two = machine.map(x=[0.0, q1], y=[0.0, q1], z=[0.0, q1], variables="stiffness_softest")
softest = two.stiffness_softest * 1e-3  # N/mm
at_q0, at_q1 = float(softest[0, 0, 0]), float(softest[1, 1, 1])
print(f"Q0: {at_q0:.1f} N/mm, from the compliance {1 / 3.331344e-4:.1f} N/mm")
print(f"Q1: {at_q1:.2f} N/mm, from the compliance {1 / (28.86266e-4 + 13.84484e-4):.2f} N/mm")
assert np.isclose(at_q0, 1 / 3.331344e-4, rtol=1e-6)
assert np.isclose(at_q1, 1 / (28.86266e-4 + 13.84484e-4), rtol=1e-6)
# The map's deflection at a place is that of a single equilibrium there.
alone = machine.posture(position=[grid[5], grid[30], 0.0]).deflected_by(feeds["feed along y"])
there = found.deflection.sel(load="feed along y").values[5, 30]
assert np.isclose(there, np.linalg.norm(alone.displacement[:3]), rtol=1e-9)

# %% [markdown]
# ## The best place for the plate
#
# The worse of both feeds at each place; then the largest value under the plate, for every position of the plate. Places outside the stated workspace or beyond a drive's limit do not count.

# %%
worst = found[["deflection", "status"]].max("load", keep_attrs=True)
low, high = machine.workspace
inside = (worst.x >= low[0]) & (worst.x <= high[0]) & (worst.y >= low[1]) & (worst.y <= high[1])
good = inside & (worst.status == ks.Status.SOLVED)
worse = worst.deflection.where(good, np.inf).values
SIDE = 13  # places under 60 mm
under = np.lib.stride_tricks.sliding_window_view(worse, (SIDE, SIDE)).max(axis=(2, 3))
i, j = np.unravel_index(under.argmin(), under.shape)
x0, y0 = 1e3 * grid[i], 1e3 * grid[j]
print(f"best: corner at x = {x0:.0f}, y = {y0:.0f} mm, at most {1e6 * under[i, j]:.0f} um off")
a, b = np.unravel_index(np.where(np.isfinite(under), under, -1).argmax(), under.shape)
print(f"worst: x = {1e3 * grid[a]:.0f}, y = {1e3 * grid[b]:.0f} mm, {1e6 * under[a, b]:.0f} um")

# %% alt="Map of the deflection under the worse of both feeds, with isolines, best and worst place, the limbs of the machine and the workspace; two squares show the best place for the plate, around the origin, and the worst, in the corner"
axes = plt.subplots(figsize=(7, 6.4), layout="constrained")[1]
maps.plot(worst, "deflection", machine=machine, ax=axes)
for x, y, style, label in (
    (x0, y0, "-", f"here {1e6 * under[i, j]:.0f} um"),
    (1e3 * grid[a], 1e3 * grid[b], ":", f"here {1e6 * under[a, b]:.0f} um"),
):
    square = np.array([[x, x + 60, x + 60, x, x], [y, y, y + 60, y + 60, y]])
    axes.plot(*square, f"C1{style}", lw=3)
    axes.annotate(label, (x + 58, y + 4), color="white", fontweight="bold", ha="right")
axes.grid(visible=False)
axes.set_title("The plate belongs around the isotropic point")
plt.show()

# %% [markdown]
# ## What to try
#
# - `found.to_netcdf("map.nc")`, `maps.to_parquet(found, "map.parquet")`, `maps.to_vtk(found, "map.vtu")` for ParaView.
# - Three dimensions: `z=grid` as well (103 823 places in a few seconds).
# - `maps.variables()` lists what can be asked: `singularity_distance`, `joint_efforts`, `margin`.
