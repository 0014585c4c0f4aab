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
# # Cutting forces: how hard does the cut push?
#
# Before a machine bends somebody has to say by which force. An end mill of 12 mm cuts aluminium, a third of its diameter wide. Which force bends the machine, which one do the edges see, and how much of it is known at all?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Each slice of an edge takes off a chip of thickness $h$ and meets $k_{11} h^{1-m}$ per millimetre of its width (Kienzle), times factors for how it is cut [R 2.4, Table 2.2]. Summed over edges and averaged over a revolution it is the force that a slow machine follows. Axes: x along the feed, y to its left, z along the tool to the spindle; force on the tool.

# %%
import matplotlib.pyplot as plt
import numpy as np

from kinetostat.cutting import milling_force

CUT = {
    "material": "AlMg4.5Mn",
    "tool": "flat",
    "diameter_mm": 12,
    "teeth": 4,
    "helix_deg": 38,
    "depth_mm": 8,
    "feed_per_tooth_mm": 0.1,
    "rpm": 8000,
}
climb = milling_force(**CUT, width_mm=4, climb=True)
for k, axis in enumerate("xyz"):
    print(
        f"mean force on the tool along {axis}: {climb.mean[k]:4.0f} N"
        f"   ({climb.low[k]:.0f} to {climb.high[k]:.0f} N by the spread of the material)"
    )
print(f"torque {climb.torque:.2f} N m, power {climb.power / 1e3:.2f} kW")
print("assumed:", climb.assumed[0])

# %% [markdown]
# ## Check: the sum over edges by hand
#
# First the report's Table 2.3, $F = 2 k_{c1.1} h^{1-m_c} b\, v_c^{-0.07}$ with all further factors in the 2 (the book's errata): for $h$ = 0.2 mm, $b$ = 8 mm it prints 2.23, 2.17 and 2.12 kN at 1000, 1500 and 2000 m/min.

# %%
K11, M = 780.0, 0.23  # N/mm2 and exponent of AlMg4.5Mn, Table 2.2
speeds = np.array([1000, 1500, 2000])  # m/min
table = 2 * K11 * 0.2 ** (1 - M) * 8 * speeds**-0.07
print("Table 2.3, kN:", np.round(table / 1e3, 2))
assert np.allclose(np.round(table / 1e3, 2), [2.23, 2.17, 2.12])


def revolution(width, up=False, teeth=4, radius=6.0, depth=8.0, feed=0.1, helix=38.0, slices=250):
    """Force over a revolution, N: (angles, 3). 1.3: milling with coefficients of turning tests."""
    turn = np.linspace(0, 2 * np.pi, 360, endpoint=False)
    z = (np.arange(slices) + 0.5) * depth / slices
    tooth = 2 * np.pi * np.arange(teeth) / teeth
    lag = z * np.tan(np.radians(helix)) / radius
    phi = np.mod(turn[:, None, None] - tooth[:, None] - lag, 2 * np.pi)
    arc = np.arccos(1 - width / radius)
    inside = phi < arc if up else (phi > np.pi - arc) & (phi < np.pi)
    chip = np.where(inside, feed * np.sin(phi), 0.0).clip(min=0)
    tangential = 1.3 * K11 * chip ** (1 - M) * depth / slices
    radial, axial = 0.4 * tangential, -0.25 * tangential
    x = -tangential * np.cos(phi) - radial * np.sin(phi)
    y = tangential * np.sin(phi) - radial * np.cos(phi)
    return turn, np.stack([part.sum(axis=(1, 2)) for part in (x, y, axial)], axis=-1)


turn, force = revolution(4)
print("mean by hand, N:", np.round(force.mean(axis=0), 1), " core:", np.round(climb.mean, 1))
assert np.allclose(force.mean(axis=0), climb.mean, rtol=2e-3)

# %% [markdown]
# ## How wide may the cut be?
#
# The mean force for all widths, climb and conventional. Across the wall (y, to the left of the feed) it decides how far the tool leaves it: in climb milling the part is on the right, in conventional milling on the left.

# %%
widths = np.array([0.5, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12])  # mm
wall = {
    name: np.array([milling_force(**CUT, width_mm=w, **{name: True}).mean for w in widths])
    for name in ("climb", "conventional")
}
for name, up in (("climb", False), ("conventional", True)):
    hand = np.array([revolution(w, up, slices=120)[1].mean(axis=0) for w in widths])
    assert np.allclose(hand, wall[name], rtol=5e-3, atol=1.0), name
third = widths == 4
print(f"4 mm wide, climb: {wall['climb'][third, 1].item():.0f} N off the wall")
print(f"4 mm wide, conventional: {wall['conventional'][third, 1].item():.0f} N into the wall")

# %% alt="Left: force over a third of a revolution, which rises and falls with each tooth around its mean. Right: mean force along x and y over the width of cut in climb and conventional milling; in climb milling the tool is pushed off the wall, in conventional milling into it; in a slot both are the same"
figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.2))
degrees = np.degrees(turn)
for k, axis in enumerate("xyz"):
    left.plot(degrees, force[:, k], color=f"C{k}", label=f"along {axis}")
    left.axhline(climb.mean[k], color=f"C{k}", linestyle=":", linewidth=1.2)
left.plot([], [], "k:", linewidth=1.2, label="mean (core)")
left.set(xlabel="angle of the spindle, deg", ylabel="force on the tool, N", xlim=(0, 180))
peak = np.linalg.norm(climb.peak[:2]) / np.linalg.norm(climb.mean[:2])
left.set(ylim=(0, 1250), xticks=range(0, 181, 30))
left.set_title(f"The peak is {peak:.1f} times the mean")
left.legend(ncols=2, loc="upper center")
for name, style in (("climb", "-"), ("conventional", "--")):
    for k, axis in enumerate("xy"):
        along = "along the feed" if axis == "x" else "to its left"
        right.plot(widths, wall[name][:, k], f"C{k}{style}", label=f"{name}, {along}")
right.axhline(0, color="black", linewidth=0.8)
right.set(xlabel="width of the cut, mm", ylabel="mean force on the tool, N", ylim=(-1000, 1900))
right.set_title("Climb pushes off, conventional pulls in")
right.legend(fontsize=9, loc="upper left")
plt.show()

# %% [markdown]
# ## What to try
#
# - `run_out_um=20`: the mean stays, the peak grows.
# - `helix_deg=0`: the same mean, and another peak.
# - Give the mean to a machine: `machine.posture(...).deflected_by([*climb.mean, *climb.moment])`. And its band: `climb.low`, `climb.high`.
