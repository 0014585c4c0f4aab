"""Commands of the command line inside this process."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import os
import re
import tempfile
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from contextvars import ContextVar
from types import MappingProxyType
from typing import Any

import numpy as np

from kinetostat import _core
from kinetostat._arrays import masked, thread_count
from kinetostat.errors import ArgumentError, ToleranceMissedWarning, UnansweredError
from kinetostat.machine import Machine

_WRONG_INPUT, _UNANSWERED, _TOLERANCE_MISSED = 1, 2, 3


@dataclasses.dataclass(frozen=True)
class Completed:
    """What a command leaves.

    Examples
    --------
    >>> done = run(["model", "list"])
    >>> done.code, b"orthoglide" in done.out
    (0, True)
    """

    code: int
    """Exit code: 0 answered, 1 wrong input, 2 no answer, 3 tolerance missed, 130 stopped."""
    out: bytes
    """What it prints to the standard output."""
    err: str
    """What it prints to the standard error."""

    def json(self) -> Any:
        """Its answer, of a command with ``--json``.

        Examples
        --------
        >>> run(["stiffness", "orthoglide", "--json"]).json()["rank"]
        6
        """
        return json.loads(self.out)


def run(words: Sequence[str | os.PathLike[str]], progress: Callable[[int, int, str], object] | None = None) -> Completed:
    """A command by its words, as on the command line, without a process of its own.

    Examples
    --------
    >>> run(["model", "list"]).code
    0
    """
    return Completed(*_core.run_command([os.fspath(word) for word in words], progress))


_ARGUMENTS: ContextVar[Mapping[str, str]] = ContextVar("arguments of a typed question, by options", default=MappingProxyType({}))


@contextlib.contextmanager
def arguments(**names: str) -> Iterator[None]:
    """Messages of commands within name the arguments of a typed question: ``arguments(displacement_mm="displacement")``."""
    before = _ARGUMENTS.set(names)
    try:
        yield
    finally:
        _ARGUMENTS.reset(before)


def in_words_of_python(message: str) -> str:
    """A message of a command with the names of arguments for those of options: with _ for -, or as :func:`arguments` says."""

    def argument(option: re.Match[str]) -> str:
        name = option[1].replace("-", "_")
        return _ARGUMENTS.get().get(name, name) + ("=N" if option[2] else "")

    return re.sub(r"(?<![\w-])--([a-z][a-z-]*)( N\b)?", argument, message)


def _words(value: Any) -> list[str]:
    if isinstance(value, (bool, np.bool_)):
        raise ArgumentError(f"{value} is no value of an option")
    if isinstance(value, (int, float, np.integer, np.floating)):
        return [repr(value.item() if isinstance(value, np.generic) else value)]
    if not isinstance(value, (str, os.PathLike)):
        raise ArgumentError(f"{value!r} ({type(value).__name__}) is no value of an option: give numbers, text or paths")
    return [os.fspath(value)]


def _option(name: str, value: Any) -> list[str]:
    if value is None or value is False:
        return []
    if value is True:
        return [name]
    if masked(value):
        raise ArgumentError(f"{name or 'argument'} has masked entries: fill or leave them out")
    if isinstance(value, (list, tuple, np.ndarray)):
        if len(value) == 0:
            raise ArgumentError(f"{name or 'argument'} is empty")
        if len({np.shape(inner) for inner in value}) > 1:
            raise ArgumentError(f"{name or 'argument'} is {value!r}: its rows are not alike")
    if not name and isinstance(value, str) and value.startswith("-"):
        raise ArgumentError(f"{value!r} is no argument: it begins with a dash")
    head = [name] if name else []
    if isinstance(value, (str, os.PathLike)) or np.ndim(value) == 0:
        return head + _words(value)
    if np.ndim(value[0]) == 0 and not (isinstance(value[0], str) and name):
        return head + [word for inner in value for word in _words(inner)]
    return [word for inner in value for word in _option(name, inner)]


def _in_words(command: Sequence[str], options: Sequence[tuple[str, Any]], folder: str) -> tuple[list[str], dict[str, str]]:
    """Words of the command line, and which files of the folder stand for which machines."""
    words, names = list(command), {}
    for index, (name, value) in enumerate(options):
        if isinstance(value, Machine):
            if not np.array_equal(value.tool, np.eye(4)):
                raise ArgumentError("a command takes a machine without a tool: give its length with tool_length_mm, or its pose in the job")
            path = os.path.join(folder, f"model-{index}.toml")
            with open(path, "w", encoding="utf-8", newline="\n") as file:
                file.write(value.text)
            names[path] = value.name
            value = path
        words += _option(name, thread_count(value) if name == "--threads" else value)
    return words, names


def _done(
    command: Sequence[str],
    options: Sequence[tuple[str, Any]],
    progress: Callable[[int, int, str], object] | None,
    extra: Sequence[str],
) -> Completed:
    with tempfile.TemporaryDirectory(prefix="kinetostat-") as folder:
        words, names = _in_words(command, options, folder)
        done = run([*words, *extra], progress)
    # A file that is gone is no name of a machine.
    for path, name in names.items():
        in_json = json.dumps(name)[1:-1] if extra else name
        out = done.out.replace(path.encode(), in_json.encode())
        done = dataclasses.replace(done, out=out, err=done.err.replace(path, name))
    message = done.err.strip()
    at = message.rfind("error: ")
    reason = message[at + 7 :] if at >= 0 else message
    if done.code == _WRONG_INPUT:
        # What the command line says of its own use is no help here.
        raise ArgumentError(in_words_of_python(reason.split("\n\nUsage: ")[0].rstrip()))
    if done.code == _TOLERANCE_MISSED:
        warnings.warn(reason, ToleranceMissedWarning, stacklevel=4)
    elif done.code != 0 and not (done.code == _UNANSWERED and done.out.startswith(b"{")):
        raise UnansweredError(reason)
    return done


def answered(
    command: Sequence[str],
    options: Sequence[tuple[str, Any]],
    progress: Callable[[int, int, str], object] | None,
) -> dict[str, Any]:
    """The answer of a command with ``--json``."""
    answer: dict[str, Any] = _done(command, options, progress, ["--json"]).json()
    return answer


def listed(
    command: Sequence[str],
    options: Sequence[tuple[str, Any]],
    progress: Callable[[int, int, str], object] | None,
) -> list[dict[str, Any]]:
    """The answers of a command whose ``--json`` is a list."""
    answers: list[dict[str, Any]] = _done(command, options, progress, ["--json"]).json()
    return answers


def texted(
    command: Sequence[str],
    options: Sequence[tuple[str, Any]],
    progress: Callable[[int, int, str], object] | None,
) -> str:
    """What a command prints."""
    return _done(command, options, progress, []).out.decode()
