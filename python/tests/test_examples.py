"""Every public function, class and method of the package is documented with an example that runs as a doctest."""

from __future__ import annotations

import importlib
import inspect
import pkgutil
import typing

import pytest

import kinetostat as ks


def modules():
    """Names of all public modules of the package."""
    found = [
        one.name
        for one in pkgutil.walk_packages(ks.__path__, "kinetostat.")
        if not any(part.startswith("_") for part in one.name.split("."))
    ]
    return ["kinetostat", *found]


def members(name, thing):
    """A public name and, of a class, its public methods with their names."""
    yield name, thing
    if not inspect.isclass(thing):
        return
    for key, raw in vars(thing).items():
        if key.startswith("_"):
            continue
        plain = raw.__func__ if isinstance(raw, (staticmethod, classmethod)) else raw
        if inspect.isfunction(plain):
            yield f"{name}.{key}", plain


def public():
    """All that has to have an example: functions, classes and methods of ``__all__`` of every module, each once."""
    seen, absent = {}, []
    for module in modules():
        try:
            loaded = importlib.import_module(module)
        except ImportError as missing:
            absent.append(f"{module}: {missing}")
            continue
        assert loaded.__doc__, f"{module} has no docstring"
        assert hasattr(loaded, "__all__"), f"{module} has no __all__"
        for key in loaded.__all__:
            thing = getattr(loaded, key)
            # Names of types, such as Callable[...], are classes to Python 3.10.
            if typing.get_origin(thing) is not None or not (inspect.isclass(thing) or inspect.isfunction(thing)):
                continue
            for name, one in members(key, thing):
                seen.setdefault(id(one), (f"{one.__module__}.{name}", one))
    return sorted(seen.values(), key=lambda pair: pair[0]), absent


PUBLIC, ABSENT = public()


def test_every_module_is_walked():
    if ABSENT:
        pytest.skip("; ".join(ABSENT))


def test_the_walk_finds_the_package():
    names = {name for name, _ in PUBLIC}
    assert len(names) > 150
    assert {"kinetostat.machine.Machine.from_urdf", "kinetostat.commands.stiffness", "kinetostat.sweep.run"} & names


@pytest.mark.parametrize(("name", "thing"), PUBLIC, ids=[name for name, _ in PUBLIC])
def test_has_an_example(name, thing):
    text = inspect.getdoc(thing) or ""
    assert text.strip(), f"{name} has no docstring"
    section = text.partition("\nExamples\n--------\n")[2]
    assert ">>> " in section, f"{name} has no Examples section with a line that begins with >>>"
