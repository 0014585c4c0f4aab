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
# # An arm from a URDF: how far does it sag?
#
# A robot's URDF has lengths, masses and limits, but nothing that bends. With one stiffness for each drive we learn how far the tool of a light arm hangs down, by its own weight and by a gripper with a part of 3 kg.
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Weights act along the chain, and their torques turn with the posture: equilibrium under loads at intermediate places [R 4.16, 4.20]. The drives turn until $K (q - q_0)$ is the torque of all weights at the *bent* posture.

# %%
import xml.etree.ElementTree as ElementTree

import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks

URDF = """<?xml version="1.0"?>
<robot name="light arm">
  <link name="base"/>
  <link name="shoulder">
    <inertial><origin xyz="0 0 0"/><mass value="7"/>
      <inertia ixx=".02" ixy="0" ixz="0" iyy=".02" iyz="0" izz=".02"/></inertial>
  </link>
  <link name="upper">
    <inertial><origin xyz="0.25 0 0.1"/><mass value="11"/>
      <inertia ixx=".04" ixy="0" ixz="0" iyy=".4" iyz="0" izz=".4"/></inertial>
  </link>
  <link name="fore">
    <inertial><origin xyz="0.22 0 0"/><mass value="4"/>
      <inertia ixx=".01" ixy="0" ixz="0" iyy=".2" iyz="0" izz=".2"/></inertial>
  </link>
  <link name="flange">
    <inertial><origin xyz="0.05 0 0"/><mass value="2"/>
      <inertia ixx=".003" ixy="0" ixz="0" iyy=".003" iyz="0" izz=".003"/></inertial>
  </link>
  <link name="tool"/>
  <joint name="turn" type="revolute">
    <parent link="base"/><child link="shoulder"/><origin xyz="0 0 0.18"/><axis xyz="0 0 1"/>
    <limit lower="-3.1" upper="3.1" effort="330" velocity="2"/>
  </joint>
  <joint name="lift" type="revolute">
    <parent link="shoulder"/><child link="upper"/><origin xyz="0 0.14 0"/><axis xyz="0 -1 0"/>
    <limit lower="-0.5" upper="2.5" effort="330" velocity="2"/>
  </joint>
  <joint name="elbow" type="revolute">
    <parent link="upper"/><child link="fore"/><origin xyz="0.61 -0.1 0"/><axis xyz="0 -1 0"/>
    <limit lower="-2.7" upper="2.7" effort="150" velocity="3"/>
  </joint>
  <joint name="bend" type="revolute">
    <parent link="fore"/><child link="flange"/><origin xyz="0.57 0 0"/><axis xyz="0 -1 0"/>
    <limit lower="-2" upper="2" effort="56" velocity="3"/>
  </joint>
  <joint name="end" type="fixed">
    <parent link="flange"/><child link="tool"/><origin xyz="0.2 0 0"/>
  </joint>
</robot>"""
STIFFNESS = {"turn": 2.4e4, "lift": 2.4e4, "elbow": 1.3e4, "bend": 5e3}  # N m/rad

machine = ks.Machine.from_urdf(
    URDF, tip="tool", stiffness={name: (k, "N m/rad") for name, k in STIFFNESS.items()}
)
print(machine)
for drive in machine.actuators:
    low, high = np.degrees(drive.limits)
    print(f"{drive.name:6} {low:6.0f} to {high:4.0f} deg, {STIFFNESS[drive.name]:.0f} N m/rad")

# %% [markdown]
# ## From folded to stretched out
#
# The upper arm leans from upright to level, the elbow opens, and the flange stays level.

# %%
lift = np.radians(np.linspace(90, 0, 31))
joints = np.stack([0 * lift, lift, -lift * 8 / 9, -lift / 9], axis=1)
PART = ks.wrench([0, 0, -3 * 9.81])  # N, held at the tool
own = machine.equilibrium(joints=joints)
held = machine.equilibrium(joints=joints, wrenches=PART)
commanded = np.array([machine.posture(joints=row).target[:3, 3] for row in joints])
radius = commanded[:, 0]
print("reach, m   own weight, mm   with 3 kg, mm   torque of the shoulder, N m")
for k in range(0, 31, 6):
    sag = 1e3 * own.displacement[k, 2], 1e3 * held.displacement[k, 2]
    torque = abs(held.actuator_forces[k, 1])
    print(f"{radius[k]:8.3f} {sag[0]:12.2f} {sag[1]:15.2f} {torque:17.0f}")
assert held.stable.all()

# %% [markdown]
# ## Check: the same URDF by the standard library and numpy
#
# We read the file with `xml.etree`, walk along it, and turn each joint by the torque of all that hangs behind it, until nothing changes.

# %%
root = ElementTree.fromstring(URDF)


def vector(node, name):
    return np.array(node.find(name).get("xyz").split(), dtype=float)


def by_hand(commands, payload):
    """Places of the joints and of the tool (5, 3) of the sagging arm."""
    chain = root.findall("joint")
    masses = {link.get("name"): link.find("inertial") for link in root.findall("link")}
    bent = np.zeros(4)
    for _ in range(60):
        turn, place, axes, weights = np.eye(3), np.zeros(3), [], []
        for joint in chain:
            place = place + turn @ vector(joint, "origin")
            if joint.get("type") == "revolute":
                axis, k = vector(joint, "axis"), len(axes)
                axes.append((turn @ axis, place, len(weights)))
                turn = turn @ ks.rotation_from_vector((commands[k] + bent[k]) * axis)
            own = masses[joint.find("child").get("link")]
            if own is not None:
                mass = float(own.find("mass").get("value"))
                weights.append((place + turn @ vector(own, "origin"), mass))
        weights.append((place, payload))
        down = np.array([0, 0, -9.81])
        for k, (axis, at, first) in enumerate(axes):
            torque = sum(axis @ np.cross(p - at, m * down) for p, m in weights[first:])
            bent[k] = torque / list(STIFFNESS.values())[k]
    return np.array([at for _, at, _ in axes] + [place])


hand = np.array([by_hand(row, 3.0) for row in joints[::10]])
off = np.abs(hand[:, -1] - held.tool[::10, :3, 3]).max()
print(f"places of the tool differ by at most {1e9 * off:.4f} nm")
assert off < 1e-11

# %% alt="Left: the arm from the side in four postures from folded to stretched out, arrows show its sag 30 times larger. Right: sag over the reach, by the own weight and with a part of 3 kg; both grow several times"
figure, (left, right) = plt.subplots(1, 2, figsize=(9.5, 4.0), width_ratios=(1, 1.1))
GROWN = 30
for k, color in ((0, "C2"), (1, "C0"), (2, "C1"), (3, "C4")):
    line = np.vstack([np.zeros(3), hand[k]])[:, [0, 2]]
    left.plot(*line.T, "o-", color="0.6", markersize=4)
    sunk = line[-1] + GROWN * held.displacement[10 * k, [0, 2]]
    left.annotate("", sunk, line[-1], arrowprops={"arrowstyle": "-|>", "color": color, "lw": 2})
left.set(xlabel="x, m", ylabel="z, m", aspect="equal", ylim=(-0.25, 1))
left.set_title(f"Sag with 3 kg, x {GROWN}")
right.plot(radius, -1e3 * own.displacement[:, 2], label="own weight")
right.plot(radius, -1e3 * held.displacement[:, 2], "--", label="with a part of 3 kg")
right.set(xlabel="reach of the tool, m", ylabel="tool hangs down by, mm", ylim=(0, None))
ratio = held.displacement[30, 2] / held.displacement[0, 2]
right.set_title(f"Stretched out it sags {ratio:.1f} times as far")
right.legend(loc="upper left")
plt.show()

# %% [markdown]
# ## What to try
#
# - Your own robot: `Machine.from_urdf("robot.urdf", base="base_link", tip="tool0", stiffness=2e4)`, or an object of yourdfpy. Read `machine.warnings`.
# - `machine.save("arm.toml")`: from then on the model file is yours; give the links a section, too.
# - Command what lifts the tool back: `machine.targets(...)`. The controller compensates gravity torques, not the twist of the gears.
