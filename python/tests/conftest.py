"""What all tests share."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest

GOLDEN = Path(__file__).resolve().parents[2] / "crates" / "kinetostat" / "tests" / "golden"


@pytest.fixture
def golden() -> Any:
    """Reads one of the files of reference numbers that the tests of the core read."""

    def read(name: str) -> dict[str, Any]:
        found: dict[str, Any] = json.loads((GOLDEN / f"{name}.json").read_text())
        return found

    return read
