"""Model files as dictionaries."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from kinetostat._arguments import shown
from kinetostat.errors import ModelError

__all__ = ["plain", "without_none"]


def without_none(value: Any) -> Any:
    """Without keys of which nothing is said."""
    if isinstance(value, dict):
        return {key: without_none(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, list):
        return [without_none(inner) for inner in value]
    return value


_DEEPEST = 32
"""Tables within tables: far more than a model has."""


def plain(value: Any, at: str = "", depth: int = 0) -> Any:
    """Arrays and numbers of numpy as plain ones, without None; refuses what no model file can hold."""
    if depth > _DEEPEST:
        raise ModelError(f"{at[:100]} is nested more than {_DEEPEST} deep: a model is not")
    if isinstance(value, Mapping):
        return {str(key): plain(inner, f"{at}.{key}" if at else str(key), depth + 1) for key, inner in value.items() if inner is not None}
    if isinstance(value, (list, tuple)):
        return [plain(inner, f"{at}[{index}]", depth + 1) for index, inner in enumerate(value)]
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), at, depth + 1)
    if isinstance(value, np.generic) and not isinstance(value.item(), np.generic):
        return plain(value.item(), at, depth + 1)
    if isinstance(value, float) and not np.isfinite(value):
        raise ModelError(f"{at} is {value}: give a finite number")
    if not isinstance(value, (bool, int, float, str)):
        raise ModelError(f"{at} is {shown(value)}, expected a number, text, a list or a dictionary")
    return value
