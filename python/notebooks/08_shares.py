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
# # Shares: which part of the robot bends?
#
# A heavy arm is to drill overhead: 800 N along z. It yields by 0.4 mm. Money is there to make one part stiffer. Which, and by how much?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Under a small load $f$ the tool moves by $C f$, and by virtual work $f^T C f = \sum_b x_b^T K_b x_b$ with $x_b$ the motion of spring $b$: every part has an exact share. Passive joints store nothing. For a drive it is the torque squared by its stiffness.

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks

LOAD = 800.0  # N, along z
machine = ks.Machine.preset("heavy_6r")
shares = machine.shares(direction="z")
print(f"{1e3 * shares.compliance * LOAD:.3f} mm under {LOAD:.0f} N along z")
for part in shares.parts[:6]:
    print(f"{part.name:10} {part.kind:6} {100 * part.share:5.1f} %")
assert abs(sum(part.share for part in shares.parts) - 1) < 1e-12

# %% [markdown]
# ## Check: torques by hand
#
# Direct kinematics in six lines: each joint turns about its axis and carries its link. A force on the tool has the torque $a \cdot (r \times f)$ about an axis $a$; squared and divided by the drive's stiffness it is that drive's part of $f^T C f$.

# %%
document = machine.to_dict()
elements = document["chain"]["arm"]["elements"]
turn, place, joints = np.eye(3), np.zeros(3), []
for element in elements:
    if "actuator" in element:
        axis = {"x": [1, 0, 0], "y": [0, 1, 0], "z": [0, 0, 1]}[element["axis"]]
        joints.append((element["name"], turn @ axis, place, element["stiffness_n_m_per_rad"]))
        turn = turn @ ks.rotation_from_vector(np.radians(element["home_deg"]) * np.array(axis))
    elif "link" in element:
        place = place + turn @ (1e-3 * np.array(element["vector_mm"]))
assert np.allclose(place, machine.home[:3, 3], atol=1e-9)

by_name = shares.by_name()
up = np.array([0, 0, 1.0])
for name, axis, at, stiffness in joints:
    torque = axis @ np.cross(place - at, up)
    hand = torque**2 / stiffness / shares.compliance
    assert np.isclose(hand, by_name[f"arm: {name}"], rtol=1e-9, atol=1e-12)
    if hand > 0.01:
        print(f"{name}: {torque:.3f} N m per N, {100 * hand:.2f} % by hand")

# %% [markdown]
# ## The cheapest stiffening for 30 % less
#
# The command finds the factors on stiffnesses that reach the target at the least relative increase. With a new machine we see that it does.

# %%
answer = ks.commands.shares(machine, direction="z", reduce_percent=30)["stiffening"]
for part in answer["parts"]:
    print(f"{part['name']}: {part['factor']:.3f} times as stiff")
    for element in elements:
        if element.get("name") == part["name"]:
            element["stiffness_n_m_per_rad"] *= part["factor"]
stiffer = ks.Machine.from_dict(document)
ratio = stiffer.shares(direction="z").compliance / shares.compliance
print(f"the new machine yields {ratio:.4f} times as far")
assert np.isclose(ratio, 0.7, atol=1e-6)

# %% [markdown]
# ## The answer depends on where the arm stands

# %%
home = machine.home[:3, 3]
reach = np.linspace(0.9, 2.3, 29)  # m from the base's axis
groups = ["joint 2", "joint 3", "joint 5", "links"]
stack = np.zeros((len(groups), len(reach)))
for column, x in enumerate(reach):
    here = machine.shares(position=[x, 0, home[2]], direction="z")
    for part in here.parts:
        row = groups.index(part.name) if part.name in groups else len(groups) - 1
        stack[row, column] += 1e3 * LOAD * part.compliance  # mm
total = stack.sum(axis=0)
print(f"at {reach[0]:.1f} m {total[0]:.2f} mm, at {reach[-1]:.1f} m {total[-1]:.2f} mm")
change = reach[np.argmax(stack[0] > stack[1])]
print(f"from {change:.2f} m on the shoulder (joint 2) gives more than the elbow (joint 3)")

# %% alt="Deflection under 800 N over the reach of the arm as a stack of parts: near the base the elbow, joint 3, gives most of it, far out the shoulder, joint 2"
figure, axes = plt.subplots(figsize=(7, 4.2))
colors = ["C0", "C1", "C2", "0.75"]
edges = np.vstack([0 * total, np.cumsum(stack, axis=0)])
for row, (name, color) in enumerate(zip(groups, colors, strict=True)):
    axes.fill_between(reach, edges[row], edges[row + 1], color=color, label=name, linewidth=0)
axes.axvline(home[0], color="black", linestyle=":", linewidth=1.2)
axes.text(home[0] + 0.02, 0.92 * total.max(), "home")
axes.set(xlabel="tool's distance from the base's axis, m", ylabel="yields by, mm (800 N along z)")
axes.set(xlim=(reach[0], reach[-1]), ylim=(0, 1.05 * total.max()))
axes.set_title("Near the base the elbow bends, far out the shoulder")
axes.legend(loc="upper center")
plt.show()

# %% [markdown]
# ## What to try
#
# - `direction="x"`, or a direction of your own such as `[1, 0, -1]`: are castings or drives to blame?
# - `ks.shares.sensitivities(machine, wrench=[0, 0, -800, 0, 0, 0])`: what every number of the model file changes.
# - Your own arm: `Machine.open("my_robot.toml")`.
