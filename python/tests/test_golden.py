"""Every golden file of the Rust tests, through Python: numbers of the report, of closed forms and of programs written apart."""

from __future__ import annotations

import json
from pathlib import Path

import golden_chains
import golden_models
import golden_orthoglide
import pytest

ROOT = Path(__file__).resolve().parents[2]
FILES = sorted([*ROOT.glob("crates/*/tests/**/golden/*.json"), *ROOT.glob("crates/kinetostat-links/tests/data/*.json")])
ROOMS = (golden_orthoglide, golden_chains, golden_models)


@pytest.mark.parametrize("path", FILES, ids=[path.stem for path in FILES])
def test_golden(path):
    check = next((getattr(room, path.stem) for room in ROOMS if hasattr(room, path.stem)), None)
    assert check is not None, f"no check for {path.relative_to(ROOT)}: write one in python/tests/golden_*.py"
    check(json.loads(path.read_text(encoding="utf-8")))


def test_there_are_golden_files():
    assert len(FILES) >= 15
