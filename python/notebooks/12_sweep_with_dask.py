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
# # A sweep with Dask: what if it is stopped?
#
# A map of a whole workspace in many variables is a night's work for a slow model, and a cluster's for a large one. Workers come and go there. Is the answer complete, is it the same, and what happens to a run that was stopped?
#
# Needs `pip install "kinetostat[plot,sweep,io]"`.
#
# **How it works.** A sweep is a pure function of rows. Its rows are cut into chunks that any `concurrent.futures.Executor` may compute, anywhere and again: a process pool, Dask, MPI. Only this process writes: Parquet files and a manifest with the SHA-256 of every chunk.

# %%
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pyarrow.parquet as parquet
from dask.distributed import Client, LocalCluster

import kinetostat as ks
from kinetostat import sweep

machine = ks.Machine.preset("hexapod")
low, high = machine.workspace
axes_m = [np.linspace(low[k], high[k], n) for k, n in enumerate((25, 25, 9))]  # m
LOAD = ks.wrench([300, 0, -500])  # N
question = {
    "x": axes_m[0],
    "y": axes_m[1],
    "z": axes_m[2],
    "loads": LOAD,
    "variables": ["stiffness_softest", "deflection", "share_to_buckling"],
}
serial = machine.map(**question)
print(f"{serial.status.size} places, by threads of this process; {dict(serial.sizes)}")

# %% [markdown]
# ## The same by two processes of Dask, stopped in the middle
#
# We stop the run as Ctrl-C would, when half of the chunks are done, and call it again.


# %%
def stopping(done, count, stage):
    """A progress callback that loses its patience."""
    if done > count / 2:
        raise KeyboardInterrupt


folder = tempfile.TemporaryDirectory()
kept = Path(folder.name, "map")
with (
    LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
    Client(cluster) as client,
):
    try:
        machine.map(
            **question, folder=kept, executor=client.get_executor(), chunk=500, progress=stopping
        )
    except KeyboardInterrupt:
        half = sweep.verify(kept)
        print(f"stopped: {len(half.damaged)} damaged; complete: {half.complete}")
        assert 0 < len(half.sound) < half.chunks
    swept = machine.map(**question, folder=kept, executor=client.get_executor(), chunk=500)

proof = sweep.verify(kept)
print(f"now: {len(proof.sound)} of {proof.chunks} chunks sound, complete: {proof.complete}")

# %% [markdown]
# ## Check: bit by bit, and by another program
#
# The answer of the workers against that of the threads, byte for byte; the Parquet files read by pyarrow alone; and two places solved one at a time.

# %%
for name in (*question["variables"], "status"):
    assert serial[name].values.tobytes() == swept[name].values.tobytes(), name
table = parquet.read_table(kept / "chunks")
columns = {name: table[name].to_numpy() for name in ("x", "y", "z", "deflection")}
print(f"pyarrow reads {table.num_rows} rows of {table.num_columns} columns")
for row in (1234, 4321):
    place = [columns[axis][row] for axis in "xyz"]
    alone = machine.posture(position=place).deflected_by(LOAD)
    moved = np.linalg.norm(alone.displacement[:3])
    print(f"row {row}: {1e6 * columns['deflection'][row]:.3f} um, alone {1e6 * moved:.3f} um")
    assert np.isclose(moved, columns["deflection"][row], rtol=1e-9)
folder.cleanup()

# %% alt="Three sections of the workspace at rising heights with the softest stiffness as colour: the hexapod is softer the lower its tool hangs and away from the middle"
levels = (0, 4, 8)
softest = serial.stiffness_softest * 1e-6  # N/um
figure, panels = plt.subplots(1, 3, figsize=(9.5, 3.6), sharey=True)
for panel, k in zip(panels, levels, strict=True):
    shown = softest.isel(z=k).where(serial.status.isel(z=k) == ks.Status.SOLVED)
    mesh = panel.pcolormesh(
        1e3 * serial.x,
        1e3 * serial.y,
        shown.values.T,
        vmin=float(softest.min()),
        vmax=float(softest.max()),
        rasterized=True,
    )
    panel.set(xlabel="x, mm", aspect="equal", title=f"z = {1e3 * float(serial.z[k]):.0f} mm")
    panel.grid(visible=False)
panels[0].set(ylabel="y, mm")
figure.colorbar(mesh, ax=panels, label="softest stiffness, N/um")
mean = softest.mean(("x", "y")).values
figure.suptitle(
    f"The hexapod: {mean[0]:.0f} N/um at the lowest section, {mean[-1]:.0f} at the highest",
    fontweight="bold",
    x=0.02,
    ha="left",
)
plt.show()

# %% [markdown]
# ## What to try
#
# - A million places (`np.linspace(..., 100)` three times), `chunk=16384`; on one computer threads alone are the quickest.
# - Kill a worker (`kill -9`) while it runs: Dask computes its chunk again.
# - A function of your own in a module: `sweep.to_folder("out", function, count, settings, executor=...)`; tolerances and programs, too. The book's page on sweeps has SLURM and MPI.
