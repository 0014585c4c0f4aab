"""What all tests share.

The locale of the environment is set, as desktop programs that embed Python do: numbers must be written and read with a point under
each. ``cargo xtask test`` runs the tests under one with a decimal comma too.
"""

from __future__ import annotations

import json
import locale
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

locale.setlocale(locale.LC_ALL, "")

ROOT = Path(__file__).resolve().parents[2]


@pytest.fixture(scope="session")
def golden() -> Callable[[str], dict[str, Any]]:
    """Reads a golden file of the Rust tests by its name."""

    def read(name: str) -> dict[str, Any]:
        path = ROOT / "crates/kinetostat/tests/golden" / f"{name}.json"
        return json.loads(path.read_text(encoding="utf-8"))

    return read
