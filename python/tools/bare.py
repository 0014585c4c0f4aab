"""The installed package where nothing but numpy is: it imports quickly, draws nothing, and answers.

Times are printed and not asserted; `cargo xtask figures` measures them.
"""

from __future__ import annotations

import importlib.util
import inspect
import statistics
import subprocess
import sys
import time

OPTIONAL = ("matplotlib", "scipy", "sympy", "xarray", "pandas", "pyarrow", "dask", "meshio", "tqdm", "IPython", "vtk", "pyvista")


def import_seconds(module: str) -> float:
    """Median time of an import in a process of its own."""
    ask = f"import time, sys; s = time.perf_counter(); import {module}; print(time.perf_counter() - s)"
    runs = [subprocess.run([sys.executable, "-c", ask], check=True, capture_output=True, text=True) for _ in range(5)]
    return statistics.median(float(run.stdout) for run in runs)


def main() -> None:
    """Imports, looks at what came along, and asks one question of each kind."""
    there = [name for name in OPTIONAL if importlib.util.find_spec(name)]
    if there:
        sys.exit(f"this environment is not bare, it has {', '.join(there)}")
    start = time.perf_counter()
    import kinetostat as ks

    first = time.perf_counter() - start
    assert not set(OPTIONAL) & set(sys.modules)
    assert not hasattr(ks, "symbolic")
    assert len(inspect.getmembers(ks)) > 50
    machine = ks.Machine.preset("orthoglide")
    posture = machine.posture(position=[0.0, 0.0, 0.0])
    stiffness = posture.stiffness().matrix[0, 0]
    # The report's isotropic point: 3.331344e-4 mm/N [R Table 6.3].
    assert abs(stiffness * 3.331344e-7 - 1.0) < 1e-6, stiffness
    assert posture.deflected_by(ks.wrench([100, -20, -30])).stable
    assert machine.equilibrium([[0.0, 0.0, 0.0]] * 1000, [100, 0, 0, 0, 0, 0]).solved.all()
    assert ks.commands.run(["--version"]).out.decode().split() == ["kinetostat", ks.__version__]
    whole, numpy = import_seconds("kinetostat"), import_seconds("numpy")
    print(f"kinetostat {ks.__version__} on CPython {sys.version.split()[0]} with numpy alone: import {whole:.3f} s ", end="")
    print(f"(numpy of it {numpy:.3f} s, the first time {first:.3f} s), at most 0.15 s is asked for")


if __name__ == "__main__":
    main()
