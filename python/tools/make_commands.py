"""Writes python/kinetostat/commands.py from the command line's own table of commands and options.

Run with ``--check`` to compare with what is there.
"""

from __future__ import annotations

import json
import keyword
import sys
import textwrap
from pathlib import Path
from typing import Any

from command_examples import EXAMPLES

from kinetostat import _core

TARGET = Path(__file__).resolve().parents[1] / "kinetostat" / "commands.py"

HEAD = '''"""Every command of the command line as a function; made by python/tools/make_commands.py from the command line's own table.

A function takes the options of its command by their names and gives what the command prints with ``--json``, as a dictionary (units are
part of its names, see STABILITY.md); commands without such an answer give their text. Where the command line takes the name of a
model, a :class:`kinetostat.Machine` does too. Wrong input raises ``ArgumentError``, a question without an answer ``UnansweredError``; a
program that misses its tolerance is written, and warned of with ``ToleranceMissedWarning``.
"""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import Completed, answered, listed, run, texted

if TYPE_CHECKING:
    from kinetostat.machine import Machine

__all__ = {names}

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]
'''

LEFT_OUT = {"completions", "man"}
LISTS = {"reproduce"}
"""Commands whose JSON is a list."""


def identifier(name: str) -> str:
    """The name of a Python argument or function."""
    plain = name.replace("-", "_").lower()
    return plain + "_" if keyword.iskeyword(plain) else plain


def annotation(argument: dict[str, Any]) -> str:
    """Type of an argument's values."""
    if not argument["takes_values"]:
        return "bool"
    single = {"path": "_Path", "float": "float", "int": "int"}.get(argument["type"], "str | float")
    if argument["values"]:
        single = "Literal[" + ", ".join(f'"{value}"' for value in argument["values"]) + "]"
    if argument["name"] in ("model", "a", "b", "models") and argument["positional"]:
        return "_Path | Machine"
    if argument["most"] > 1:
        whole = f"Sequence[{single}]"
        return whole if argument["fewest"] > 1 else f"{single} | {whole}"
    if argument["repeats"]:
        return f"{single} | Sequence[{single}]"
    return single


def wrapped(text: str, indent: str) -> str:
    """Text in lines of at most 110 columns."""
    clean = text.replace('"""', "'''")
    return "\n".join(textwrap.wrap(clean, 108 - len(indent), initial_indent=indent, subsequent_indent=indent))


def example(name: str) -> str:
    """The example of a function, as a docstring holds it."""
    if name not in EXAMPLES:
        sys.exit(f"there is no example of the command {name}: write a short one into python/tools/command_examples.py")
    return EXAMPLES[name].strip()


def function(path: list[str], command: dict[str, Any]) -> str:
    """The definition of one command's function."""
    arguments = command["arguments"]
    has_json = any(a["name"] == "json" for a in arguments)
    shown = [a for a in arguments if a["name"] != "json"]
    positional = [a for a in shown if a["positional"]]
    named = [a for a in shown if not a["positional"]]
    lines = []
    for a in positional:
        default = "" if a["required"] else " = None"
        optional = "" if a["required"] else " | None"
        lines.append(f"    {identifier(a['name'])}: {annotation(a)}{optional}{default},")
    lines.append("    *,")
    for a in named:
        kind = annotation(a)
        lines.append(
            f"    {identifier(a['name'])}: bool = False," if kind == "bool" else f"    {identifier(a['name'])}: {kind} | None = None,"
        )
    lines.append("    progress: _Progress | None = None,")
    about = (command["about"] or "").strip()
    long = (command["long_about"] or "").strip()
    rest = long[len(about) :].strip() if long.startswith(about) else long
    doc = [f'    """{about.rstrip(".?")}.', ""]
    if rest:
        doc += [wrapped(paragraph, "    ") for paragraph in rest.split("\n\n")] + [""]
    doc += ["    Parameters", "    ----------"]
    for a in shown:
        doc.append(f"    {identifier(a['name'])} : {annotation(a).replace('_Path', 'path')}")
        doc.append(wrapped((a["help"] or "As on the command line.").replace("\n", " "), "        "))
    doc += [
        "    progress : callable",
        "        Called with what is done, how much there is and the name of the stage.",
    ]
    name = identifier("_".join(path))
    if not has_json:
        call, returns, said = "texted", "str", "What it prints."
    elif name in LISTS:
        call, returns, said = "listed", "list[dict[str, Any]]", "What the command prints with ``--json``."
    else:
        call, returns, said = "answered", "dict[str, Any]", "What the command prints with ``--json``."
    kind = returns.replace("[str, Any]", "").replace("[", " of ").rstrip("]")
    doc += ["", "    Returns", "    -------", f"    {kind}", f"        {said}"]
    doc += ["", "    Examples", "    --------", textwrap.indent(example(name), "    "), '    """']
    if any("\\" in line for line in doc):
        doc[0] = doc[0].replace('"""', 'r"""', 1)
    pairs = [f'        ("{"" if a["positional"] else "--"}{a["name"]}", {identifier(a["name"])}),' for a in [*positional, *named]]
    words = ", ".join(f'"{word}"' for word in path)
    return "\n".join(
        [
            f"def {name}(",
            *lines,
            f") -> {returns}:",
            *doc,
            "    options: list[tuple[str, Any]] = [",
            *pairs,
            "    ]",
            f"    return {call}([{words}], options, progress)",
        ]
    )


def functions(path: list[str], command: dict[str, Any]) -> list[tuple[str, str]]:
    """Names and definitions of a command and its own commands."""
    if command["commands"]:
        return [one for inner in command["commands"] for one in functions([*path, inner["name"]], inner)]
    return [(identifier("_".join(path)), function(path, command))]


def text() -> str:
    """The whole module."""
    root = json.loads(_core.command_tree())
    made = [one for command in root["commands"] if command["name"] not in LEFT_OUT for one in functions([command["name"]], command)]
    names = sorted([name for name, _ in made] + ["Completed", "run"], key=lambda n: (not n[0].isupper(), n))
    listed = "[\n" + "".join(f'    "{name}",\n' for name in names) + "]"
    return "\n\n".join([HEAD.replace("{names}", listed), *(body for _, body in made)]) + "\n"


if __name__ == "__main__":
    wanted = text()
    if "--check" in sys.argv:
        if TARGET.read_text() != wanted:
            sys.exit(
                "python/kinetostat/commands.py is not what the command line says; make it anew with python python/tools/make_commands.py"
            )
    else:
        TARGET.write_text(wanted)
