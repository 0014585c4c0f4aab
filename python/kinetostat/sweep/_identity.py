"""What a sweep is: two runs with the same identity give the same bits, so that one may go on with the other's chunks."""

from __future__ import annotations

import dataclasses
import hashlib
import math
import pickle
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

from kinetostat import _core
from kinetostat._arguments import function, refused
from kinetostat.errors import ArgumentError
from kinetostat.machine import Machine

FORMAT = 1
"""Counts changes of the manifest that old readers would misunderstand."""

_MOST_ROWS = 2**48
"""More than any memory or disk holds."""

Columns = dict[str, np.ndarray[Any, np.dtype[Any]]]
"""Arrays by name, with one row for each row of the chunk."""

Function = Callable[..., Mapping[str, Any]]
"""``function(first, last, threads=..., **settings)``: arrays with ``last - first`` rows."""


@dataclasses.dataclass(frozen=True)
class Plan:
    """A function, its settings, and how its rows are cut."""

    function: Function
    settings: Mapping[str, Any]
    count: int
    size: int

    def __post_init__(self) -> None:
        function("function", self.function, "a function of first, last, threads and the settings")
        for name, value, least in (("count", self.count, 0), ("chunk", self.size, 1)):
            if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or not least <= value <= _MOST_ROWS:
                raise refused(name, value, f"a whole number, {least} or more")
        if "threads" in self.settings:
            raise ArgumentError("settings has 'threads': how many threads a worker uses is not part of what is computed")
        try:
            pickle.dumps(self.function)
        except Exception as failed:
            raise ArgumentError(
                f"function is {self.function!r}, which cannot be sent to a worker: define it at the top of a module ({failed})"
            ) from None

    @property
    def chunks(self) -> int:
        """How many chunks there are."""
        return -(-self.count // self.size)

    def rows(self, index: int) -> tuple[int, int]:
        """First row of a chunk, and the one after its last."""
        return index * self.size, min((index + 1) * self.size, self.count)

    def identity(self) -> dict[str, Any]:
        """As written in a manifest."""
        return {
            "format": FORMAT,
            "version": _core.VERSION,
            "function": f"{self.function.__module__}.{self.function.__qualname__}",
            "count": int(self.count),
            "chunk": int(self.size),
            "settings": {name: _identified(f"settings[{name!r}]", value) for name, value in sorted(self.settings.items())},
        }


def _identified(name: str, value: Any) -> Any:
    """A value as JSON that tells it from any other."""
    if isinstance(value, Machine):
        return {"machine": value.name, "sha256": value.fingerprint}
    if isinstance(value, np.ndarray) and value.dtype.kind in "fiub":
        same = np.ascontiguousarray(value)
        digest = hashlib.sha256(same.astype(same.dtype.newbyteorder("<"), copy=False).tobytes()).hexdigest()
        return {"array": [int(length) for length in value.shape], "dtype": value.dtype.name, "sha256": digest}
    if isinstance(value, np.generic):
        value = value.item()
    if isinstance(value, float) and not math.isfinite(value):
        return repr(value)
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    if isinstance(value, Mapping):
        return {str(key): _identified(f"{name}[{key!r}]", inner) for key, inner in value.items()}
    if isinstance(value, (list, tuple)):
        return [_identified(f"{name}[{index}]", inner) for index, inner in enumerate(value)]
    raise ArgumentError(
        f"{name} is a {type(value).__name__}: a sweep has to tell its settings apart, expected machines, arrays of numbers, numbers, "
        "text, or lists and dictionaries of these"
    )


def difference(there: Any, here: Any, name: str = "") -> tuple[str, Any, Any] | None:
    """The first field in which two identities differ: its name and both values."""
    if isinstance(there, dict) and isinstance(here, dict):
        for key in dict.fromkeys((*there, *here)):
            if key not in there or key not in here:
                return f"{name}{key}", there.get(key, "nothing"), here.get(key, "nothing")
            found = difference(there[key], here[key], f"{name}{key}.")
            if found is not None:
                return found
        return None
    return None if there == here else (name.rstrip("."), there, here)


def checked(plan: Plan, index: int, result: Any) -> Columns:
    """The result of a chunk as contiguous arrays, if it is one."""
    first, last = plan.rows(index)
    if not isinstance(result, Mapping) or not result:
        raise ArgumentError(f"{plan.function.__qualname__} returned a {type(result).__name__}, expected a dictionary of arrays")
    columns = {str(name): np.ascontiguousarray(value) for name, value in result.items()}
    for name, array in columns.items():
        if array.dtype.kind not in "fiub":
            raise ArgumentError(f"{plan.function.__qualname__} returned {name!r} with dtype {array.dtype}, expected numbers")
        if array.shape[:1] != (last - first,):
            raise ArgumentError(f"{plan.function.__qualname__} returned {name!r} of shape {array.shape}, expected {last - first} rows")
    return columns


def schema(columns: Columns) -> list[dict[str, Any]]:
    """Names, types and shapes of a row."""
    return [{"name": name, "dtype": array.dtype.name, "shape": [int(n) for n in array.shape[1:]]} for name, array in columns.items()]
