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
# # Tolerances: 0.42 mm, plus or minus what?
#
# A computed deflection has three digits too many. Bars are a few hundredths longer than drawn, legs are bolted askew, castings vary, and the cutting force is known to ten percent. How far does the tool's error scatter, and is compensation with the numbers of the drawing still worth it?
#
# Needs `pip install "kinetostat[plot]"`.
#
# **Theory.** Either linear, $\sigma^2 = g^T \Sigma g$ with the derivatives $g$ of the result; or thousands of machines as chance draws them (quasi-random Sobol sequences), each commanded as the drawing says, each compensated as the drawing says. Where the two differ, linear is not enough.

# %%
import matplotlib.pyplot as plt
import numpy as np

import kinetostat as ks
from kinetostat import tolerance

document = ks.Machine.preset("orthoglide").to_dict()
document["deviation"] = [
    {"limb": limb, "at": "line", "tilted_by_deg": 0.0, "about": "x"}
    for limb in ("leg x", "leg y", "leg z")
]
machine = ks.Machine.from_dict(document)
spread = {
    "chain.leg.q2.length_mm": tolerance.normal(0.01),
    "section.foot beam.scale": tolerance.uniform(5, percent=True),
    "load factor": tolerance.normal(10, percent=True),
    **{f"deviation.{limb}.line.tilted_by_deg": tolerance.normal(0.03) for limb in machine.limbs},
}
PLACE = [0.12635, 0.12635, 0.12635]  # m, Q1 of the report
LOAD = ks.wrench([215, -10, -25], [1, 21.5, 0])  # N, N m
quantities = ["deviation", "compensated"]
drawn = tolerance.machines(machine, spread, [PLACE], LOAD, quantities=quantities, draws=2048)
before, after = drawn.column("deviation_mm")[:, 0], drawn.column("compensated_mm")[:, 0]
print(f"{len(before)} machines, {drawn.no_answer} without an answer, {drawn.unstable} unstable")
nominal = drawn.nominal[0, drawn.columns.index("deviation_mm")]
print(f"tool off without compensation: {nominal:.3f} mm as drawn")
for name, values in (("without compensation", before), ("with it", after)):
    low, high = np.quantile(values, [0.05, 0.95])
    print(
        f"{name}: {values.mean():.3f} +- {values.std():.3f} mm, 90 % in {low:.3f} to {high:.3f} mm"
    )
# As drawn, by an independent program (golden file orthoglide_milling of the tests).
assert np.isclose(nominal, np.linalg.norm([0.286756, -0.1802286, -0.2436269]), rtol=1e-5)

# %% [markdown]
# ## Is linear enough? Whose fault is it?
#
# The components of the error are nearly linear in all numbers, so $g_i \sigma_i$ tells who is to blame. The length of an error that is zero as drawn never is linear.

# %%
off = drawn.nonlinearity()[0]
for name in ("deviation_x_mm", "deviation_mm", "compensated_mm"):
    value = off[drawn.columns.index(name)]
    words = "linear is enough" if value < 0.1 else "NOT linear"
    print(f"{name:15} off from linear by {value:.2f} standard deviations: {words}")

# Variance of the components together, input by input.
rows = [drawn.columns.index(f"compensated_{axis}_mm") for axis in "xyz"]
variance = ((drawn.derivatives[0, rows] * drawn.inputs.std(axis=0)) ** 2).sum(axis=0)
blame = dict(zip(drawn.names, 100 * variance / variance.sum(), strict=True))
tilts = sum(blame.pop(name) for name in drawn.names if name.startswith("deviation"))
for name, percent in {"tilts of the three legs": tilts, **blame}.items():
    print(f"{percent:5.1f} %  {name}")

# %% [markdown]
# ## Check: a machine with a closed form
#
# One drive, a rigid arm: the tool goes by $F L^2/k$ to first order in the angle. With $k$ normal, 10 %, numpy draws its own machines; mean and spread have to agree.

# %%
builder = ks.MachineBuilder("crane")
builder.platform("tool", [0.5, 0, 0])
builder.limb("arm", to="tool").actuator("q", "revolute", "z", 1e6).rigid([0.5, 0, 0])
scatter = {"chain.arm.q.stiffness_n_m_per_rad": tolerance.normal(10, percent=True)}
one = tolerance.machines(
    builder.machine(),
    scatter,
    [[0.5, 0, 0]],
    [0, 100, 0, 0, 0, 0],
    quantities=["deflection_by_load"],
)
core = one.column("deflection_by_load_mm")[:, 0]
stiffness = np.random.default_rng(7).normal(1e6, 1e5, 400_000)
hand = 1e3 * 100 * 0.5**2 / stiffness
print(f"core {1e3 * core.mean():.3f} +- {1e3 * core.std():.3f} um")
print(f"hand {1e3 * hand.mean():.3f} +- {1e3 * hand.std():.3f} um")
assert np.isclose(core.mean(), hand.mean(), rtol=1e-3)
assert np.isclose(core.std(), hand.std(), rtol=2e-2)

# %% alt="Histograms of the distance from the programmed place: without compensation a bell around 0.42 mm, with the compensation of the drawing a skewed heap around 0.09 mm"
figure, axes = plt.subplots()
bins = np.linspace(0, before.max(), 60)
for values, label in ((before, "not compensated"), (after, "compensated as drawn")):
    axes.hist(
        values, bins, alpha=0.85, label=f"{label}: {values.mean():.2f} +- {values.std():.2f} mm"
    )
axes.axvline(nominal, ymax=0.75, color="black", linestyle="--", linewidth=1.2)
top = 1.35 * axes.get_ylim()[1]
axes.text(nominal + 0.006, 0.7 * top, "as drawn")
axes.set(xlabel="distance of the tool from its programmed place, mm", ylabel="machines of 2048")
axes.set(xlim=(0, bins[-1]), ylim=(0, top))
axes.set_title(
    f"Compensation leaves {100 * after.mean() / before.mean():.0f} % of the error, not zero"
)
axes.legend(loc="upper center")
plt.show()

# %% [markdown]
# ## What to try
#
# - Measure the tilts of the legs (remove them from `spread`): what is left?
# - `correlations={("chain.leg.q2.length_mm", "section.foot beam.scale"): 0.5}`.
# - `tolerance.sobol` for functions that are not linear, and `kinetostat tolerance` for the same from a file, with a report.
