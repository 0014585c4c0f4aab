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
    assert len(NOTEBOOKS) == 12
    for notebook in NOTEBOOKS:
        assert f"(notebooks/{notebook.stem}.md)" in summary
