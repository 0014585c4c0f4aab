"""Commands of the command line inside this process."""

from __future__ import annotations

import contextlib
import dataclasses
import json
import keyword
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
from kinetostat._arguments import path as file_path
from kinetostat._arguments import refused, shown, told
from kinetostat._arrays import masked, thread_count
from kinetostat.errors import ArgumentError, ToleranceMissedWarning, UnansweredError
from kinetostat.machine import Machine

_MISSED = "the program was written, but misses the tolerance; the answer and the detail of this warning say where"

_WRONG_INPUT, _UNANSWERED, _TOLERANCE_MISSED, _DOUBTFUL = 1, 2, 3, 4


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
    """Exit code: 0 answered, 1 wrong input, 2 no answer, 3 tolerance missed, 4 tolerance kept only if assumptions hold, 130 stopped."""
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
    if isinstance(words, (str, bytes)) or not isinstance(words, Sequence):
        raise refused("words", words, "a list of words as ['model', 'list']")
    each = [file_path(f"words[{index}]", word) for index, word in enumerate(words)]
    return Completed(*_core.run_command(each, told(progress)))


_ARGUMENTS: ContextVar[Mapping[str, str]] = ContextVar("arguments of a typed question, by options", default=MappingProxyType({}))


@contextlib.contextmanager
def arguments(**names: str) -> Iterator[None]:
    """Messages of commands within name the arguments of a typed question: ``arguments(displacement_mm="displacement")``."""
    before = _ARGUMENTS.set(names)
    try:
        yield
    finally:
        _ARGUMENTS.reset(before)


def _argument(option: str) -> str:
    """The argument of an option by its name without dashes before it: with _ for -, and behind a word of Python's own, as in ``from_``."""
    name = option.replace("-", "_")
    return f"{name}_" if keyword.iskeyword(name) else name


def in_words_of_python(message: str) -> str:
    """A message of a command with the names of arguments for those of options: with _ for -, or as :func:`arguments` says."""

    def argument(option: re.Match[str]) -> str:
        name = _argument(option[1])
        return _ARGUMENTS.get().get(name, name) + ("=N" if option[2] else "")

    return re.sub(r"(?<![\w-])--([a-z][a-z-]*)( N\b)?", argument, message)


def _word(name: str, value: Any, of_option: bool) -> str:
    """The word of a value."""
    plain = value.item() if isinstance(value, np.generic) else value
    if isinstance(plain, (int, float)) and not isinstance(plain, bool):
        return repr(plain)
    if not isinstance(plain, (str, os.PathLike)):
        raise refused(name, value, "a number, text or a path")
    word = file_path(name, plain)
    if not of_option and word.startswith("-"):
        raise ArgumentError(f"{name} is {shown(word)}: what begins with a dash is taken for an option")
    return word


def _shape(row: Any) -> tuple[int, ...] | None:
    """The shape of a row, none where its own rows are not alike."""
    try:
        return tuple(np.shape(row))
    except ValueError:
        return None


def _option(option: str, value: Any) -> list[str]:
    """An option of the command line with its value; an argument without an option has its name without dashes."""
    name = _argument(option.removeprefix("--"))
    head = [option] if option.startswith("--") else []
    if value is None or value is False:
        return []
    if isinstance(value, (bool, np.bool_)):
        if not head:
            raise refused(name, value, "text or a path")
        return head if value else []
    if masked(value):
        raise ArgumentError(f"{name} has masked entries: fill or leave them out")
    if hasattr(value, "__array__"):
        value = np.asarray(value)
    if isinstance(value, np.ndarray) and value.ndim == 0:
        value = value.item()
    if isinstance(value, (str, os.PathLike)) or not isinstance(value, (Sequence, np.ndarray)):
        return [*head, _word(name, value, bool(head))]
    if len(value) == 0:
        raise ArgumentError(f"{name} is empty")
    shapes = {_shape(inner) for inner in value}
    if len(shapes) > 1 or None in shapes:
        raise ArgumentError(f"{name} is {shown(value)}: its rows are not alike")
    if np.ndim(value[0]) == 0 and not (isinstance(value[0], str) and head):
        return head + [_word(f"{name}[{index}]", inner, bool(head)) for index, inner in enumerate(value)]
    return [word for inner in value for word in _option(option, inner)]


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


def _faults(done: Completed) -> tuple[dict[str, Any], ...]:
    """Faults of a command that failed; none where it printed a result or text."""
    if done.code in (0, _TOLERANCE_MISSED, _DOUBTFUL) or not done.out.startswith(b"{"):
        return ()
    report: dict[str, Any] = done.json()
    return tuple(report["errors"]) if "exit_code" in report else ()


def _done(
    command: Sequence[str],
    options: Sequence[tuple[str, Any]],
    progress: Callable[[int, int, str], object] | None,
    extra: Sequence[str],
) -> Completed:
    told(progress)
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
    faults = _faults(done)
    if done.code == _WRONG_INPUT:
        # What the command line says of its own use is no help here.
        error = ArgumentError(in_words_of_python(reason.split("\n\nUsage: ")[0].rstrip()))
        error.diagnostics = faults
        raise error
    if done.code == _TOLERANCE_MISSED:
        warnings.warn(ToleranceMissedWarning(_MISSED, reason), stacklevel=4)
    elif done.code not in (0, _DOUBTFUL) and (faults or not (done.code == _UNANSWERED and done.out.startswith(b"{"))):
        unanswered = UnansweredError(reason)
        unanswered.diagnostics = faults
        raise unanswered
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
