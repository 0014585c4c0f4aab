"""Writes python/kinetostat/commands from the command line's own table of commands and options.

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

TARGET = Path(__file__).resolve().parents[1] / "kinetostat" / "commands"

HEAD = '''"""Every command of the command line as a function; made by python/tools/make_commands.py from the command line's own table.

A function takes the options of its command by their names and gives what the command prints with ``--json``, as a dictionary (units are
part of its names, see STABILITY.md); commands without such an answer give their text. Units of options are those of the command line (mm,
deg, N, N m), not the SI units of everything else in the package: where a name says none, the docstring does. Where the command line
takes the name of a model, a :class:`kinetostat.Machine` does too. Wrong input raises ``ArgumentError``, a question without an answer
``UnansweredError``; a program that misses its tolerance is written, and warned of with ``ToleranceMissedWarning``.
"""

from __future__ import annotations

from kinetostat._running import Completed, run
{imports}

__all__ = {names}
'''

ROOM = '''"""{title}; made by python/tools/make_commands.py."""

from __future__ import annotations

{imports}
'''

LEFT_OUT = {"completions", "explain", "man", "schema", "start"}
LISTS = {"reproduce"}
"""Commands whose JSON is a list."""
NAMES_BEFORE = {"pendant"}
"""Hidden options that are taken all the same, for one version more; other hidden ones are refused, or are for tests."""


def offered(argument: dict[str, Any]) -> bool:
    """Whether an option is one of the function."""
    return not argument["hidden"] or argument["name"] in NAMES_BEFORE


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
    shown = [a for a in arguments if a["name"] != "json" and offered(a)]
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


def room(name: str, made: list[tuple[str, str]]) -> str:
    """The module of one command and those below it."""
    body = "\n\n\n".join(text for _, text in made)
    abstract = sorted(kind for kind in ("Callable", "Sequence") if f"{kind}[" in body or kind == "Callable")
    running = sorted({kind for kind in ("answered", "listed", "texted") if f"return {kind}(" in body})
    imports = ["import os"] if "_Path" in body else []
    imports.append(f"from collections.abc import {', '.join(abstract)}")
    typed = " | Machine" in body
    typing = [*(["TYPE_CHECKING"] if typed else []), "Any", *(["Literal"] if "Literal[" in body else [])]
    imports += [f"from typing import {', '.join(typing)}", "", f"from kinetostat._running import {', '.join(running)}"]
    if typed:
        imports += ["", "if TYPE_CHECKING:", "    from kinetostat.machine import Machine"]
    imports += [""]
    if "_Path" in body:
        imports.append("_Path = str | os.PathLike[str]")
    imports.append("_Progress = Callable[[int, int, str], object]")
    head = ROOM.replace("{title}", f"``kinetostat {name}``").replace("{imports}", "\n".join(imports))
    return head + "\n\n" + body + "\n"


def files() -> dict[str, str]:
    """Texts of all modules of the package by their names."""
    root = json.loads(_core.command_tree())
    shown = [command for command in root["commands"] if command["name"] not in LEFT_OUT]
    rooms = {f"_{identifier(command['name']).rstrip('_')}": (command["name"], functions([command["name"]], command)) for command in shown}
    names = [name for _, made in rooms.values() for name, _ in made]
    exported = sorted([*names, "Completed", "run"], key=lambda name: (not name[0].isupper(), name))
    listed = "[\n" + "".join(f'    "{name}",\n' for name in exported) + "]"
    imports = [
        f"from kinetostat.commands.{room} import {', '.join(sorted(name for name, _ in made))}" for room, (_, made) in sorted(rooms.items())
    ]
    texts = {f"{name}.py": room(command, made) for name, (command, made) in rooms.items()}
    texts["__init__.py"] = HEAD.replace("{names}", listed).replace("{imports}", "\n".join(imports))
    return texts


if __name__ == "__main__":
    wanted = files()
    there = {path.name: path.read_text() for path in TARGET.glob("*.py")}
    if "--check" in sys.argv:
        if there != wanted:
            sys.exit("python/kinetostat/commands is not what the command line says; make it anew with python python/tools/make_commands.py")
    else:
        TARGET.mkdir(exist_ok=True)
        for name in there.keys() - wanted.keys():
            (TARGET / name).unlink()
        for name, text in wanted.items():
            (TARGET / name).write_text(text)
