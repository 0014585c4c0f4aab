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
# # Identification: how stiff is my robot?
#
# A model has the joint stiffnesses of a paper, the robot in the hall has others. We choose postures in which to pull at it, pull (here: at a robot whose stiffnesses we know), and find them from displacements with an error of 20 um.
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** A joint with the compliance $c_k$ turns by $c_k \tau_k$, and the tool moves by $\sum_k J_k c_k J_k^T F$: linear in compliances, never in stiffnesses [R 4.16]. Under weights the difference of two equilibria takes its place.

# %%
import csv
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks

MODEL = "kuka_kr270_like"
drawn = ks.Machine.preset(MODEL)
FACTORS = dict(
    zip(("A1", "A2", "A3", "A4", "A5", "A6"), (0.8, 0.85, 1.2, 1.25, 0.8, 0.75), strict=True)
)
document = drawn.to_dict()
truth = {}
for element in document["chain"]["arm"]["elements"]:
    if element.get("name") in FACTORS:
        element["stiffness_n_m_per_rad"] *= FACTORS[element["name"]]
        truth[element["name"]] = element["stiffness_n_m_per_rad"]
robot = ks.Machine.from_dict(document)

# %% [markdown]
# ## Where to measure
#
# A cable pulls at a point beside axis 6 with 1 kN, along x, along y or down. The fifteen measurements that tell most are chosen of some hundreds.

# %%
POINT = np.array([0, 0.15, 0.2])  # m, in the frame of the flange
folder = Path(tempfile.mkdtemp())
plan = ks.commands.plan_measurement(
    MODEL,
    pull_n=1000,
    count=15,
    candidates=80,
    load_at=list(1e3 * POINT),
    marker=list(1e3 * POINT),
    z=[400, 2500],
    csv=folder / "plan.csv",
)
print(f"efficiency {plan['efficiency']:.3f} of the best that is possible")
print(
    f"variance of postures drawn at random: {plan['variance_of_random_plans']:.1f} times as large"
)

# %% [markdown]
# ## The measurement
#
# The table of the plan wants the displacement of the point in each row. Our robot gives it: two equilibria, under its weight with and without the pull, and an error of the tracker.

# %%
tool = np.eye(4)
tool[:3, 3] = POINT
at_point = robot.with_tool(tool)
rows = plan["measurements"]
joints = np.radians([[axis["value"] for axis in row["axes"]] for row in rows])
joints = np.radians(np.round(np.degrees(joints), 3))  # as the sheet says
pulls = np.array([ks.wrench(row["force_n"]) for row in rows])
pulled = at_point.equilibrium(joints=joints, wrenches=pulls)
at_rest = at_point.equilibrium(joints=joints)
moved = 1e3 * (pulled.tool[:, :3, 3] - at_rest.tool[:, :3, 3])
read = moved + np.random.default_rng(5).normal(0, 0.02, moved.shape)

with (folder / "plan.csv").open(newline="") as file:
    table = list(csv.DictReader(file))
for line, displacement in zip(table, read, strict=True):
    line.update(zip(("dx_mm", "dy_mm", "dz_mm"), displacement, strict=True))
with (folder / "pulls.csv").open("w", newline="") as file:
    writer = csv.DictWriter(file, table[0])
    writer.writeheader()
    writer.writerows(table)

# %% [markdown]
# ## What it says

# %%
found = ks.commands.identify(MODEL, measured=folder / "pulls.csv")
print("joint   paper     robot  identified   95 % between      and, MN m/rad")
for number, (name, true) in zip(found["numbers"], truth.items(), strict=True):
    low, high = 1e-6 * np.array(number["interval"])
    values = 1e-6 * np.array([number["before"], true, number["identified"]])
    print(f"{name:5} {values[0]:7.3f} {values[1]:9.3f} {values[2]:11.3f} {low:14.3f} {high:8.3f}")
    assert abs(number["identified"] / true - 1) < 0.1
print(
    f"of {found['rms_reading_mm']:.2f} mm the paper leaves {found['rms_before_mm']:.3f} mm, the measurement {found['rms_after_mm']:.3f} mm"
)
assert found["rms_after_mm"] < 0.03 < found["rms_before_mm"]

# %% [markdown]
# ## Check: least squares by numpy
#
# For small loads, the columns are $J_k\,(J_k^T F)$ with the Jacobian by differences of poses. What `identify` finds without weights must be the same.

# %%


def jacobian(row):
    """Displacement of the point (3) per turn of each joint, by differences."""
    step = 1e-6
    columns = []
    for k in range(6):
        ends = [
            drawn.with_tool(tool).posture(joints=row + s * step * np.eye(6)[k]).target[:3, 3]
            for s in (1, -1)
        ]
        columns.append((ends[0] - ends[1]) / (2 * step))
    return np.array(columns).T


blocks = [(j := jacobian(row)) * (j.T @ pull[:3]) for row, pull in zip(joints, pulls, strict=True)]
by_hand = np.linalg.lstsq(np.vstack(blocks), 1e-3 * read.ravel(), rcond=None)[0]
small = ks.commands.identify(MODEL, measured=folder / "pulls.csv", small_loads=True)
by_core = np.array([1 / number["identified"] for number in small["numbers"]])
apart = np.abs(by_core / by_hand - 1).max()
print(f"compliances differ by at most {apart:.1e} of themselves")
assert apart < 1e-5

# %% alt="Left: stiffness of each joint over that of the robot, from the paper (off by up to a third) and identified, with its interval about 1. Right: what is left of the displacement of each posture, before and after: it falls from tenths of a millimetre to hundredths"
figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 3.6))
names = list(truth)
true = np.array(list(truth.values()))
before, after = (
    np.array([n[key] for n in found["numbers"]]) / true for key in ("before", "identified")
)
bounds = np.array([n["interval"] for n in found["numbers"]]).T / true
left.axhline(1, color="0.7")
left.plot(names, before, "s", color="C1", label="paper")
left.errorbar(
    names,
    after,
    [after - bounds[0], bounds[1] - after],
    fmt="o",
    color="C0",
    capsize=4,
    label="identified, 95 %",
)
left.set(ylabel="stiffness over that of the robot")
left.legend(loc="upper center")
residuals = found["residuals"]
places = np.arange(len(residuals))
for offset, key, label in ((-0.2, "before", "paper"), (0.2, "after", "identified")):
    right.bar(
        places + offset,
        [0.02 * r[key] for r in residuals],
        0.4,
        color="C1" if key == "before" else "C0",
        label=label,
    )
right.set(xlabel="posture", ylabel="left of the displacement, mm", yscale="log", ylim=(5e-3, 2))
right.legend(loc="upper right")
plt.show()

# %% [markdown]
# ## What to try
#
# - Your own robot: `plan_measurement("my_robot.toml", mass_kg=150, sheet="sheet.txt", ...)`, and on Monday morning a cable, a load cell and a dial gauge.
# - `numbers=["joints", "chain.arm.tilt*.stiffness_n_m_per_rad"]` for bearings that tilt; compare `rms_left_out_mm`.
# - `out="identified.toml"` writes the model with its uncertainty, which `ks.tolerance` and `Machine.compensate` read.
