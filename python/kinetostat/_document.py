"""Model files as dictionaries."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any

import numpy as np

from kinetostat.errors import ModelError

__all__ = ["plain", "without_none"]


def without_none(value: Any) -> Any:
    """Without keys of which nothing is said."""
    if isinstance(value, dict):
        return {key: without_none(inner) for key, inner in value.items() if inner is not None}
    if isinstance(value, list):
        return [without_none(inner) for inner in value]
    return value


def plain(value: Any, at: str = "") -> Any:
    """Arrays and numbers of numpy as plain ones, without None."""
    if isinstance(value, Mapping):
        return {str(key): plain(inner, f"{at}.{key}" if at else str(key)) for key, inner in value.items() if inner is not None}
    if isinstance(value, (list, tuple)):
        return [plain(inner, f"{at}[{index}]") for index, inner in enumerate(value)]
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), at)
    if isinstance(value, np.generic):
        return plain(value.item(), at)
    if isinstance(value, float) and not np.isfinite(value):
        raise ModelError(f"{at} is {value}: give a finite number")
    return copy.copy(value)
