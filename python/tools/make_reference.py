"""Writes the reference of the package, book/src/python_reference.md, from its docstrings; ``--check`` compares it."""

from __future__ import annotations

import argparse
import ast
import enum
import importlib
import inspect
import pkgutil
import re
import sys
import textwrap
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import kinetostat as ks

PAGE = Path(__file__).resolve().parents[2] / "book" / "src" / "python_reference.md"
_HEAD = """\
<!-- Made by python/tools/make_reference.py from the docstrings of the package. -->
# Reference of the Python package

Public names by module, with signature, arguments and results, as `help()` shows them with examples. Units are SI where a name does not
state another one; arrays are in base axes, linear part before angular.
"""
_SECTIONS = ("Parameters", "Returns", "Raises", "Warns", "Notes")


def modules() -> Iterator[Any]:
    """The package and its public modules, commands excepted, which the command line documents."""
    yield ks
    for found in sorted(pkgutil.iter_modules(ks.__path__, "kinetostat."), key=lambda module: module.name):
        if not found.name.rpartition(".")[2].startswith("_") and found.name != "kinetostat.commands":
            yield importlib.import_module(found.name)


def plain(text: str) -> str:
    """Text of a docstring as Markdown on one line."""
    text = re.sub(r":[a-z]+:`~?(?:[^`<]*\.)?([^`.]+)`", r"`\1`", text).replace("``", "`")
    parts = re.split(r"(`[^`]*`)", " ".join(text.split()))
    return "".join(part if part.startswith("`") else re.sub(r"([<>*_$\[\]|])", r"\\\1", part) for part in parts)


def sections(doc: str) -> tuple[str, dict[str, str]]:
    """Words before the first section, and the text of each section."""
    pieces = re.split(r"^([A-Z][a-z]+)\n-+\n", inspect.cleandoc(doc), flags=re.MULTILINE)
    return pieces[0], dict(zip(pieces[1::2], pieces[2::2], strict=True))


def entries(text: str) -> str:
    """Entries of a section as ``name : kind`` with indented words, in one line."""
    blocks = re.split(r"\n(?=\S)", text.strip("\n"))
    out = []
    for block in blocks:
        first, _, rest = block.partition("\n")
        name, colon, kind = first.partition(" : ")
        head = f"`{name}`" + (f" ({plain(kind)})" if colon else "")
        out.append(f"{head}: {plain(rest)}" if rest.strip() else head)
    return "; ".join(out)


def described(name: str, value: Any, depth: int) -> list[str]:
    """Lines of a name: signature and words, arguments, results."""
    indent = "  " * depth
    signature = ""
    if callable(value) and not (inspect.isclass(value) and issubclass(value, (Exception, enum.Enum))):
        try:
            given = inspect.signature(value)
            bare = [p.replace(annotation=inspect.Parameter.empty) for p in given.parameters.values() if p.name not in ("self", "cls")]
            signature = str(given.replace(parameters=bare, return_annotation=inspect.Signature.empty))
        except (TypeError, ValueError):
            signature = "(...)"
    words, found = sections(getattr(value, "__doc__", None) or "")
    lines = [f"{indent}- **`{name}{signature}`** {plain(words)}".rstrip()]
    for title in _SECTIONS:
        if title in found:
            text = plain(found[title]) if title == "Notes" else entries(found[title])
            lines.append(f"{indent}  - {title}: {text}")
    return lines


def fields(value: type) -> Iterator[tuple[str, str]]:
    """Attributes of a class with the docstrings below them."""
    try:
        body = ast.parse(textwrap.dedent(inspect.getsource(value))).body[0]
    except (OSError, TypeError):
        return
    for own, below in zip(getattr(body, "body", []), getattr(body, "body", [])[1:], strict=False):
        described_below = isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant) and isinstance(below.value.value, str)
        if isinstance(own, ast.AnnAssign) and isinstance(own.target, ast.Name) and described_below:
            yield own.target.id, below.value.value  # type: ignore[attr-defined]


def members(value: type) -> Iterator[tuple[str, Any]]:
    """Public methods and properties of a class, inherited ones of the package too."""
    seen: set[str] = set()
    for base in value.__mro__:
        if not base.__module__.startswith("kinetostat"):
            continue
        for name, own in vars(base).items():
            plain_function = getattr(own, "__func__", own)
            if name.startswith("_") or name in seen or not (inspect.isfunction(plain_function) or isinstance(own, property)):
                continue
            seen.add(name)
            yield name, plain_function if inspect.isfunction(plain_function) else own


def page() -> str:
    """The whole page."""
    lines, seen = [_HEAD], set()
    for module in modules():
        names = [n for n in getattr(module, "__all__", []) if not n.startswith("_") and not inspect.ismodule(getattr(module, n))]
        fresh = [n for n in names if id(getattr(module, n)) not in seen and getattr(getattr(module, n), "__doc__", None)]
        seen.update(id(getattr(module, n)) for n in fresh)
        if not fresh:
            continue
        lines += [f"\n## {module.__name__}\n", plain(sections(module.__doc__ or "")[0]), ""]
        for name in fresh:
            value = getattr(module, name)
            if not (inspect.isclass(value) or inspect.isfunction(value)):
                continue
            lines += described(name, value, 0)
            if inspect.isclass(value):
                lines += [f"  - **`{name}.{own}`** {plain(words)}" for own, words in fields(value)]
                for own, member in members(value):
                    lines += described(f"{name}.{own}", member, 1)
    return "\n".join(lines) + "\n"


def main() -> None:
    """Writes the page, or compares it."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--check", action="store_true")
    if not parser.parse_args().check:
        PAGE.write_text(page(), encoding="utf-8")
    elif PAGE.read_text(encoding="utf-8") != page():
        sys.exit(f"{PAGE} is not what the docstrings say: run python/tools/make_reference.py")


if __name__ == "__main__":
    main()
