"""Arguments that are no arrays: each is refused by its name, with what was expected and what was found.

Numbers and arrays are those of :mod:`kinetostat._arrays`.
"""

from __future__ import annotations

import os
import reprlib
from collections.abc import Callable, Iterable, Mapping, Sequence
from typing import Any, TypeVar

import numpy as np

from kinetostat.errors import ArgumentError

T = TypeVar("T")

LONGEST = 4096
"""Characters of a name or a path: as many as the path of a file may have."""


class _Short(reprlib.Repr):
    """A value in a message: short whatever it holds, and never an error of its own."""

    def __init__(self) -> None:
        super().__init__()
        self.maxstring = self.maxother = self.maxlong = 100


_SHORT = _Short()


def shown(value: Any) -> str:
    """A value in a message."""
    try:
        return _SHORT.repr(value)
    except Exception:  # as of whole numbers with more digits than Python prints
        return f"<{type(value).__name__}>"


def refused(name: str, value: Any, expected: str) -> ArgumentError:
    """What is said of a value of another kind."""
    return ArgumentError(f"{name} is {shown(value)}, expected {expected}")


def of_kind(name: str, value: Any, kind: type[T] | tuple[type[T], ...], expected: str) -> T:
    """A value of one of some classes."""
    if not isinstance(value, kind):
        raise refused(name, value, expected)
    return value


def text(name: str, value: Any, expected: str = "text", *, longest: int | None = LONGEST) -> str:
    """Text that can be written down, without the character NUL, at which other programs would end it."""
    found = of_kind(name, value, str, expected)
    if longest is not None and len(found) > longest:
        raise ArgumentError(f"{name} has {len(found)} characters, expected at most {longest}: {shown(found)}")
    if longest is not None and "\0" in found:
        raise ArgumentError(f"{name} is {shown(found)}, expected {expected} without the character NUL")
    try:
        found.encode("utf-8")
    except UnicodeEncodeError as wrong:
        raise ArgumentError(f"{name} is {shown(found)}, expected {expected} that UTF-8 can write: {wrong.reason}") from None
    return found


def text_or_none(name: str, value: Any, expected: str = "text") -> str | None:
    """Text, or nothing."""
    return None if value is None else text(name, value, expected)


def path(name: str, value: Any) -> str:
    """A path as text."""
    found = os.fspath(value) if isinstance(value, os.PathLike) else value
    return text(name, found, "a path")


def flag(name: str, value: Any) -> bool:
    """True or false, and nothing that is merely taken for one of them."""
    return bool(of_kind(name, value, (bool, np.bool_), "True or False"))


def function(name: str, value: Any, expected: str = "a function") -> Any:
    """Something that can be called."""
    if not callable(value):
        raise refused(name, value, expected)
    return value


def told(progress: T) -> T:
    """The function that hears of the progress of a call, or None."""
    given: Any = progress
    if given is not None and not callable(given):
        raise refused("progress", given, "a function of what is done, how much there is and the name of the stage, or None")
    return progress


def one_of(name: str, value: Any, words: Sequence[str]) -> str:
    """One of some words."""
    if not isinstance(value, str) or value not in words:
        raise ArgumentError(f"{name} is {shown(value)}, expected one of {', '.join(words)}")
    return value


def texts(name: str, value: Any, expected: str = "a list of text") -> list[str]:
    """Several texts; one alone is none, for it would be taken apart into its letters."""
    if isinstance(value, (str, bytes, Mapping)) or not isinstance(value, Iterable):
        raise refused(name, value, expected)
    return [text(f"{name}[{index}]", each) for index, each in enumerate(value)]


def mapping(name: str, value: Any, expected: str) -> Mapping[Any, Any]:
    """A dictionary, or another mapping."""
    return of_kind(name, value, Mapping, expected)


def or_none(check: Callable[..., T], name: str, value: Any, *more: Any) -> T | None:
    """What a check gives, and nothing for nothing."""
    return None if value is None else check(name, value, *more)
