"""Python in the book runs: all fences of a page one after the other."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

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


def test_the_book_has_python_that_runs():
    assert sum(not not_run for page in PAGES for not_run, _ in FENCE.findall(page.read_text())) >= 3
