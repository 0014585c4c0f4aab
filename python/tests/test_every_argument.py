"""Every argument of every public function: a value of a wrong kind is refused by name, in words of the package."""

from __future__ import annotations

import inspect
import re
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

pytest.importorskip("xarray")
pytest.importorskip("pyarrow")
pytest.importorskip("meshio")
pytest.importorskip("pyvista")
pytest.importorskip("sympy")
matplotlib = pytest.importorskip("matplotlib")
matplotlib.use("Agg")
# Every call draws a figure of its own.
matplotlib.rcParams["figure.max_open_warning"] = 0

import every_function  # noqa: E402

import kinetostat as ks  # noqa: E402
from kinetostat import commands  # noqa: E402

pytestmark = pytest.mark.filterwarnings("ignore::kinetostat.PlausibilityWarning")

ALL = every_function.public()
TYPED = sorted(name for name in ALL if not name.startswith("kinetostat.commands.") or name.endswith(".run"))
COMMANDS = [name for name in commands.__all__ if name not in ("Completed", "run")]


BY_ITSELF = ("posture", "where", "machine", "model", "poses")
"""Arguments that functions which hand others on give themselves."""


class Nothing:
    """Of no kind that anything takes."""

    def __repr__(self) -> str:
        return "<nothing>"


ANYTHING = [
    b"bytes",
    3j,
    float("nan"),
    10**400,
    "a\0b",
    "\ud800",
    "a" * 100_000,
    {1: 2},
    {"a": Nothing()},
    [Nothing()],
    [[1, 2], 3],
    [],
    True,
    np.zeros((2, 0)),
    np.array(["a"], dtype=object),
]
"""What some arguments take and others do not."""


@pytest.fixture(scope="module")
def right(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Any]:
    return every_function.arguments(tmp_path_factory.mktemp("right"))


def replaced(name: str) -> Iterator[tuple[str, str]]:
    """The arguments of a function, with those that it hands on; and the name of the function that knows them."""
    known = set(every_function.parameters(ALL[name]))
    yield from ((name, own) for own in known)
    if every_function.takes_more(ALL[name]) and name in every_function.FORWARDED:
        for further, own in replaced(every_function.FORWARDED[name]):
            # The first argument is what the method is called of.
            if own not in known and own not in BY_ITSELF:
                yield further, own


def asked(function: Any, given: dict[str, Any]) -> Any:
    """The answer, or the error."""
    try:
        found = function(**given)
        return list(found) if inspect.isgenerator(found) else found
    except BaseException as error:
        return error


def alternatives(given: dict[str, Any], own: str) -> dict[str, Any]:
    """The right arguments without those that exclude this one, and with those without which it says nothing."""
    for some in ({"position", "joints", "pose", "rotation"}, {"poses", "joints"}, {"tool", "length"}):
        if own in some and not (own == "rotation" and "position" in given) and own in some - given.keys():
            given = {key: value for key, value in given.items() if key not in some}
    together = {"turn": {"about": [0, 0, 1]}, "displacement": {"direction": [1, 0, 0]}}
    return {**given, **together.get(own, {})}


def test_every_public_function_is_called(right: dict[str, Any]) -> None:
    """A new function needs arguments in `every_function.py`."""
    assert sorted(right) == TYPED
    for name, (function, given) in right.items():
        if name != "kinetostat.cutting.milling_force":
            assert not isinstance(asked(function, given), BaseException), name


@pytest.mark.parametrize("name", TYPED)
def test_a_wrong_kind_is_refused_by_name(name: str, right: dict[str, Any]) -> None:
    function, given = right[name]
    faults = []
    for _, own in replaced(name):
        found = asked(function, {**alternatives(given, own), own: Nothing()})
        if not isinstance(found, ks.KinetostatError) or not re.search(rf"\b{own}\b.*expected ", str(found)):
            faults.append(f"{own}: {found!r:.400}")
    assert faults == []


@pytest.mark.parametrize("name", COMMANDS)
def test_a_wrong_kind_is_refused_by_every_command(name: str) -> None:
    function = getattr(commands, name)
    needed = [p.name for p in inspect.signature(function).parameters.values() if p.default is p.empty]
    for own in every_function.parameters(function):
        found = asked(function, {**dict.fromkeys(needed, "orthoglide"), own: Nothing()})
        assert isinstance(found, ks.ArgumentError), f"{name}({own}=<nothing>): {found!r}"
        assert re.search(rf"\b{own}\b.* is <nothing>, expected ", str(found)), f"{name}({own}=<nothing>): {found}"


@pytest.mark.parametrize("name", TYPED)
def test_anything_is_answered_or_refused_in_words(name: str, right: dict[str, Any]) -> None:
    """Never an error of what lies below, never a panic."""
    function, given = right[name]
    faults = []
    for where, own in replaced(name):
        if where.startswith("kinetostat.commands."):
            continue  # what commands make of their options is a question of the command line
        for value in ANYTHING:
            if own == "search_all" and value is True:
                continue  # what it says, and takes long
            found = asked(function, {**alternatives(given, own), own: value})
            if not isinstance(found, BaseException) or isinstance(found, OSError):
                continue
            said = str(found).strip()
            if said.startswith("squares() got"):
                continue  # a function of the caller, with its own words
            if not isinstance(found, ks.KinetostatError) or not said or "panick" in said:
                faults.append(f"{own}={str(type(value)) + ascii(value):.60}: {found!r:.400}")
    assert faults == []
