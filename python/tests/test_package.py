"""The package as a whole: quick to import, modules come when they are asked for, typed."""

from __future__ import annotations

import importlib.util
import os
import subprocess
import sys

import pytest

import kinetostat as ks

HEAVY = ("matplotlib", "scipy", "sympy", "xarray", "pandas", "pyarrow", "dask", "meshio", "tqdm", "IPython", "vtk", "pyvista", "ray")
LATER = (
    "assembly",
    "commands",
    "compensation",
    "curves",
    "cutting",
    "maps",
    "measured",
    "plot",
    "shapes",
    "shares",
    "sweep",
    "symbolic",
    "tolerance",
    "view",
)


def python(text):
    """What a program prints in a process of its own."""
    done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return done.stdout


def test_modules_come_when_they_are_asked_for():
    assert set(LATER) <= set(dir(ks))
    found = python(
        "import sys, kinetostat as ks\n"
        f"assert not [n for n in {LATER!r} if 'kinetostat.' + n in sys.modules], sys.modules.keys()\n"
        f"assert not set({HEAVY!r}) & set(sys.modules)\n"
        f"print(*[getattr(ks, n).__name__ for n in {LATER!r} if n != 'symbolic'])\n"
        f"assert not set({HEAVY!r}) & set(sys.modules), 'modules that need others import them when they are used'\n"
    )
    assert found.split() == [f"kinetostat.{name}" for name in LATER if name != "symbolic"]


def test_symbolic_comes_when_it_is_asked_for():
    pytest.importorskip("sympy", reason="SymPy is not installed")
    assert python("import kinetostat as ks; print(ks.symbolic.beam().rank)").strip() == "6"


def test_the_package_is_looked_at_without_sympy():
    found = python(
        "import sys, inspect, pydoc\n"
        "sys.modules['sympy'] = None\n"
        "import kinetostat as ks\n"
        "names = dict(inspect.getmembers(ks))\n"
        "text = pydoc.render_doc(ks)\n"
        "print(hasattr(ks, 'symbolic'), 'symbolic' in names, 'Machine' in names, 'class Machine' in pydoc.plain(text))\n"
        "try: ks.symbolic\n"
        "except AttributeError as absent: print(absent)\n"
        "try: from kinetostat import symbolic\n"
        "except ImportError as absent: print(absent)\n"
    )
    said = "kinetostat.symbolic needs SymPy: pip install 'kinetostat[sym]'"
    assert found.splitlines() == ["False False True True", said, said]


@pytest.mark.skipif(sys.platform != "linux", reason="limits of memory are set by RLIMIT_AS")
def test_memory_that_is_not_there_is_an_error_of_python():
    found = python(
        "import resource\nimport numpy as np\nimport kinetostat as ks\n"
        "arm = ks.Machine.preset('heavy_6r')\n"
        "used = int(open('/proc/self/statm').read().split()[0]) * resource.getpagesize()\n"
        "resource.setrlimit(resource.RLIMIT_AS, (used + (1 << 30),) * 2)\n"
        "joints = np.zeros((4_000_000, 6))\n"
        "places = np.broadcast_to([1.2, 0, 0.9], (4_000_000, 3))\n"
        "ways = [lambda: arm.stiffness(joints=joints), lambda: arm.equilibrium(joints=joints), lambda: arm.targets(places, np.zeros(6))]\n"
        "for ask in ways:\n    try: ask()\n"
        "    except MemoryError as failed: print(failed)\n"
        "print(arm.stiffness(joints=joints[:100]).solved.all())\n"
    )
    said = found.splitlines()
    assert len(said) == 4, found
    assert said[3] == "True"
    assert all("allocate" in line for line in said[:3]), found


def test_star_asks_for_numpy_only():
    found = python(f"import sys\nfrom kinetostat import *\nprint(tolerance.__name__, *(set({HEAVY!r}) & set(sys.modules)))")
    assert found.split() == ["kinetostat.tolerance"]


def test_an_unknown_name_is_an_attribute_error():
    with pytest.raises(AttributeError, match="has no attribute 'symbols'"):
        _ = ks.symbols
    assert not hasattr(ks, "nothing")


def test_all_names_are_there():
    assert set(ks.__all__) <= set(dir(ks))
    assert len(set(ks.__all__)) == len(ks.__all__)
    for name in ks.__all__:
        getattr(ks, name)


def test_types_of_modules_that_come_later(tmp_path):
    if importlib.util.find_spec("mypy") is None:
        pytest.skip("mypy is not installed")
    program = tmp_path / "program.py"
    program.write_text(
        "import kinetostat as ks\nreveal_type(ks.symbolic.beam().rank)\nreveal_type(ks.tolerance.normal(0.1).spread)\nks.sweep.nothing\n"
    )
    words = [sys.executable, "-m", "mypy", "--strict", "--ignore-missing-imports", "--cache-dir", str(tmp_path / "cache"), str(program)]
    where = os.environ | {"PYTHONPATH": os.pathsep.join(os.path.abspath(path) for path in sys.path if path)}
    found = subprocess.run(words, capture_output=True, text=True, check=False, cwd=tmp_path, env=where)
    assert 'Revealed type is "int"' in found.stdout.replace("builtins.", ""), found.stdout + found.stderr
    assert 'Revealed type is "float"' in found.stdout.replace("builtins.", ""), found.stdout
    assert 'has no attribute "nothing"' in found.stdout, found.stdout
    assert found.stdout.strip().endswith("Found 1 error in 1 file (checked 1 source file)"), found.stdout
