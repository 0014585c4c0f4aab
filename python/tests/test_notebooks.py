"""Notebooks run without a warning, draw, and are the pages of the book."""

from __future__ import annotations

import importlib.util
import os
import re
import subprocess
import sys
from pathlib import Path

import pytest

import kinetostat

ROOT = Path(__file__).resolve().parents[2]
TOOL = ROOT / "python" / "tools" / "make_notebooks.py"
NOTEBOOKS = sorted((ROOT / "python" / "notebooks").glob("*.py"))
SECONDS = 240

# What the extras bring, and what every notebook needs to run and draw.
EXTRAS = {"plot": ["matplotlib"], "sym": ["sympy"], "sweep": ["distributed", "pyarrow"], "io": ["xarray", "pyarrow"]}
TOOLS = ("jupytext", "nbclient", "ipykernel", "matplotlib")


def needed(modules: list[str] | tuple[str, ...], why: str) -> None:
    absent = [module for module in modules if importlib.util.find_spec(module) is None]
    if absent:
        pytest.skip(f"{why} {absent[0]}, which is not installed")


def run(*options: str) -> None:
    # The package that is tested, wherever it comes from: the notebooks run in folders of their own.
    environment = os.environ | {"PYTHONPATH": str(Path(kinetostat.__file__).parents[1])}
    done = subprocess.run([sys.executable, str(TOOL), *options], env=environment, capture_output=True, text=True, timeout=SECONDS)
    assert done.returncode == 0, done.stdout + done.stderr


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_a_notebook_runs_and_prints_what_its_page_says(notebook: Path) -> None:
    needed(TOOLS, "notebooks are executed with")
    extras = re.search(r"kinetostat\[([a-z,]+)\]", notebook.read_text(encoding="utf-8"))
    assert extras, 'a notebook says what it needs: pip install "kinetostat[plot]"'
    for extra in extras.group(1).split(","):
        needed(EXTRAS[extra], f"the notebook needs the extra `{extra}`:")
    run("--try", notebook.stem)


def test_pages_hold_text_and_code_of_the_notebooks() -> None:
    needed(TOOLS, "notebooks are read with")
    run("--check")


def test_every_notebook_has_its_page_in_the_summary() -> None:
    summary = (ROOT / "book" / "src" / "SUMMARY.md").read_text(encoding="utf-8")
    assert len(NOTEBOOKS) == 13
    for notebook in NOTEBOOKS:
        assert f"(notebooks/{notebook.stem}.md)" in summary


PROBES = """
import pathlib
import make_notebooks as tool

def said(source):
    path = pathlib.Path("probe.py")
    path.write_text('# %% alt="a picture"\\n' + source)
    try:
        tool.pictures(tool.executed(path), "probe")
    except (tool.CellExecutionError, tool.NotebookFaultError) as fault:
        return str(fault)
    return "nothing"

assert "a cell warns" in said("import warnings; warnings.warn('careful')")
assert "ZeroDivisionError" in said("1 / 0")
assert "0 pictures, and 1 cells" in said("1")

page = "text\\n\\n<!-- output -->\\n```text\\n{}\\n```\\n\\nmore\\n"
shown = page.format("0.418 mm off, residual 3e-16, stable")
same = lambda printed: not tool.differences("probe", page.format(printed), shown)
assert same("0.4185 mm  off, residual -1e-15, stable")
assert not same("0.43 mm off, residual 3e-16, stable")
assert not same("0.418 mm off, residual 3e-16, unstable")
assert not same("nan mm off, residual 3e-16, stable")
assert tool.differences("probe", shown.replace("more", "else"), shown)
assert tool.differences("probe", "text\\n\\nmore\\n", shown)
"""


def test_errors_warnings_missing_pictures_and_stale_pages_are_found(tmp_path: Path) -> None:
    needed(TOOLS, "notebooks are executed with")
    environment = os.environ | {"PYTHONPATH": str(TOOL.parent)}
    command = [sys.executable, "-c", PROBES]
    done = subprocess.run(command, env=environment, cwd=tmp_path, capture_output=True, text=True, timeout=SECONDS)
    assert done.returncode == 0, done.stdout + done.stderr
