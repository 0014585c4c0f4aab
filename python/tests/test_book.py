"""Python in the book runs: all fences of a page one after the other."""

from __future__ import annotations

import importlib.util
import inspect
import re
from pathlib import Path
from typing import get_origin

import pytest

import kinetostat as ks

BOOK = Path(__file__).resolve().parents[2] / "book" / "src"
FENCE = re.compile(r"^(<!-- not run: [^\n]*-->\n)?```python\n(.*?)^```$", re.MULTILINE | re.DOTALL)
# Pages of notebooks are made by executing them (test_notebooks.py).
PAGES = sorted(page for page in BOOK.rglob("*.md") if "```python" in page.read_text() and page.parent.name != "notebooks")


@pytest.mark.parametrize("page", PAGES, ids=lambda page: str(page.relative_to(BOOK)))
def test_python_of_the_book_runs(page, tmp_path, monkeypatch):
    if "sympy" in page.read_text():
        pytest.importorskip("sympy", reason="the page needs the extra `sym`")
    monkeypatch.chdir(tmp_path)
    names = {"__name__": "book"}
    for not_run, body in FENCE.findall(page.read_text()):
        code = compile(body, str(page), "exec")
        if not not_run:
            exec(code, names)


def test_the_reference_is_what_the_docstrings_say():
    tool = importlib.util.spec_from_file_location("make_reference", BOOK.parents[1] / "python" / "tools" / "make_reference.py")
    made = importlib.util.module_from_spec(tool)
    tool.loader.exec_module(made)
    page = made.page()
    assert (BOOK / "python_reference.md").read_text(encoding="utf-8") == page, "run python/tools/make_reference.py"
    # An alias of a type is a class for Python 3.10.
    own = {name: getattr(ks, name) for name in ks.__all__ if get_origin(getattr(ks, name)) is None}
    documented = [name for name, value in own.items() if inspect.isclass(value) or inspect.isfunction(value)]
    absent = [name for name in documented if f"**`{name}" not in page]
    assert not absent


def test_the_book_has_python_that_runs():
    assert sum(not not_run for page in PAGES for not_run, _ in FENCE.findall(page.read_text())) >= 3
