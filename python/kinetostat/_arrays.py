"""Arguments as arrays of float64, with messages that show both shapes."""

from __future__ import annotations

import math
import operator
from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat._arguments import shown
from kinetostat.errors import ArgumentError

Floats = NDArray[np.float64]


def _shape(shape: tuple[Any, ...]) -> str:
    return "(" + ", ".join(map(str, shape)) + ("," if len(shape) == 1 else "") + ")"


_FEW = 36
"""Numbers that a message still shows."""

_DEEPEST = 64
"""Axes that an array can have."""


def masked(value: Any, depth: int = 0) -> bool:
    """Whether entries are masked, in lists of arrays too: numpy would take what is behind the mask."""
    if isinstance(value, np.ma.MaskedArray):
        return bool(np.asarray(value.mask).any())
    return depth < _DEEPEST and isinstance(value, (list, tuple)) and any(masked(inner, depth + 1) for inner in value)


def numbers(name: str, value: ArrayLike) -> Floats:
    """As C-contiguous, aligned float64; refuses complex numbers, text, objects and what is ragged."""
    if masked(value):
        raise ArgumentError(f"{name} has masked entries: fill or leave them out")
    try:
        given = np.asarray(value)
    except (ValueError, TypeError, OverflowError, RecursionError) as ragged:
        raise ArgumentError(f"{name} is no array: {ragged}") from None
    if given.dtype.kind not in "fiub":
        raise ArgumentError(f"{name} has dtype {given.dtype}, expected real numbers")
    return np.require(given, np.float64, ["C", "A"]) if given.ndim else given.astype(np.float64)


def fitting(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Numbers whose last axes have a shape; the axes before are free."""
    given = numbers(name, value)
    if given.shape[max(given.ndim - len(shape), 0) :] != shape:
        raise ArgumentError(f"{name} has shape {_shape(given.shape)}, expected {_shape(('...', *shape))}")
    return given


def finite(name: str, value: ArrayLike) -> Floats:
    """Finite numbers of any shape."""
    given = numbers(name, value)
    if not np.all(np.isfinite(given)):
        culprit = float(given[~np.isfinite(given)].flat[0])
        said = f"is {given.tolist()}" if given.size <= _FEW else f"holds {culprit}"
        raise ArgumentError(f"{name} {said}: give finite numbers")
    return given


def rows(name: str, value: ArrayLike, shape: tuple[int, ...]) -> tuple[Floats, tuple[int, ...]]:
    """The same as rows (n, *shape), with the shape of the axes before."""
    given = fitting(name, value, shape)
    leading = given.shape[: given.ndim - len(shape)]
    return given.reshape(math.prod(leading), *shape), leading


def one(name: str, value: ArrayLike, shape: tuple[int, ...]) -> Floats:
    """Finite numbers of exactly this shape."""
    # The usual case without a detour: a sum is finite where all its terms are, unless it overflows.
    plain = type(value) is np.ndarray and value.dtype == np.float64 and value.shape == shape and value.flags.c_contiguous
    if plain and math.isfinite(value.sum()):  # type: ignore[union-attr]
        return value  # type: ignore[return-value]
    given = numbers(name, value)
    if given.shape != shape:
        raise ArgumentError(f"{name} has shape {_shape(given.shape)}, expected {_shape(shape)}")
    return finite(name, given)


def whole_number(name: str, value: int, least: int, most: int) -> int:
    """A whole number between two bounds, both possible."""
    try:
        found = operator.index(value)
    except TypeError:
        raise ArgumentError(f"{name} is {shown(value)}, expected a whole number from {least} to {most}") from None
    if not least <= found <= most:
        raise ArgumentError(f"{name} is {shown(found)}, expected a whole number from {least} to {most}")
    return found


def scalar(name: str, value: Any) -> float:
    """One number, finite or not."""
    given = numbers(name, value)
    if given.ndim:
        raise ArgumentError(f"{name} has shape {_shape(given.shape)}, expected one number")
    return float(given)


def real(name: str, value: Any) -> float:
    """One finite number."""
    return float(one(name, value, ()))


def positive(name: str, value: Any) -> float:
    """One finite number above zero."""
    found = real(name, value)
    if found <= 0:
        raise ArgumentError(f"{name} is {found:g}, expected a number above 0")
    return found


def thread_count(threads: int | None) -> int | None:
    """Threads from 1 to 1024, or None for all cores."""
    return None if threads is None else whole_number("threads", threads, 1, 1024)
