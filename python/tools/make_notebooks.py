"""Executes the notebooks of python/notebooks and writes them as pages of the book, with their pictures.

Notebooks are percent scripts of jupytext. ``make_notebooks.py [NAME ...]`` executes all, or those named, into book/src/notebooks (or
``--into FOLDER``). ``--try`` executes and compares with the pages: text, code and words to the letter, printed numbers within one percent.
``--check`` executes nothing: it compares text and code alone.
A cell that draws says in its header what the picture shows: ``# %% alt="..."``.
"""

from __future__ import annotations

import argparse
import os
import re
import shutil
import sys
import tempfile
from pathlib import Path
from typing import Any

import jupytext
import nbformat
from nbclient import NotebookClient
from nbclient.exceptions import CellExecutionError

ROOT = Path(__file__).resolve().parents[2]
NOTEBOOKS = ROOT / "python" / "notebooks"
PAGES = ROOT / "book" / "src" / "notebooks"

SECONDS = 120
"""Time limit of a cell."""
LARGEST = 60_000
"""Bytes of a picture."""

# Pictures as SVG without dates. The cell is no part of the page.
_SETUP = """\
%config InlineBackend.figure_formats = ["svg"]
%config InlineBackend.print_figure_kwargs = {"bbox_inches": "tight", "metadata": {"Date": None, "Creator": None}}
"""

_OUTPUT = "<!-- output -->"
_OF_OUTPUT = re.compile(rf"^{_OUTPUT}\n(```text\n.*?^```|<div>[^\n]*)\n\n", re.MULTILINE | re.DOTALL)
_NUMBER = re.compile(r"[-+]?\d+(?:\.\d*)?(?:e[-+]?\d+)?")
_IMAGE = "image/svg+xml"


class NotebookFaultError(Exception):
    """A notebook that no reader should see: a warning, a missing or a heavy picture."""


def executed(path: Path) -> Any:
    """A notebook with its outputs, run in a folder of its own beside nothing but the style of the pictures."""
    notebook = jupytext.read(path)
    notebook.cells.insert(0, nbformat.v4.new_code_cell(_SETUP))
    # The kernel of this Python, whatever kernels the user has.
    os.environ["JUPYTER_PREFER_ENV_PATH"] = "1"
    with tempfile.TemporaryDirectory(prefix="notebook-") as folder:
        shutil.copy(NOTEBOOKS / "matplotlibrc", folder)
        environment = {name: value for name, value in os.environ.items() if name not in ("MPLBACKEND", "MATPLOTLIBRC")}
        environment["IPYTHONDIR"] = os.path.join(folder, ".ipython")
        if "PYTHONPATH" in environment:
            environment["PYTHONPATH"] = os.pathsep.join(map(os.path.abspath, environment["PYTHONPATH"].split(os.pathsep)))
        client = NotebookClient(notebook, timeout=SECONDS, kernel_name="python3", resources={"metadata": {"path": folder}})
        client.execute(env=environment)
    del notebook.cells[0]
    for cell in notebook.cells:
        for output in cell.get("outputs", []):
            if output.output_type == "stream" and output.name == "stderr":
                raise NotebookFaultError(f"{path.name}: a cell warns:\n{cell.source}\n{output.text}")
    return notebook


def pictures(notebook: Any, name: str) -> dict[str, str]:
    """SVG files of an executed notebook by their names."""
    shown = [o.data[_IMAGE] for cell in notebook.cells for o in cell.get("outputs", []) if _IMAGE in o.get("data", {})]
    drawing = [cell for cell in notebook.cells if "alt" in cell.metadata]
    if not drawing or len(shown) != len(drawing):
        raise NotebookFaultError(f'{name}: {len(shown)} pictures, and {len(drawing)} cells with alt="..."')
    # Without indentation: a fifth less.
    found = {f"{name}-{k}.svg": re.sub(r"\n\s*", "\n", text.strip()) + "\n" for k, text in enumerate(shown, 1)}
    for file, text in found.items():
        if len(text.encode()) > LARGEST:
            raise NotebookFaultError(f"{file} has {len(text.encode())} bytes, at most {LARGEST} are allowed: rasterise heavy layers")
    return found


def _outputs(cell: Any) -> list[str]:
    """What a cell printed, and the value of its last line, as blocks of a page."""
    blocks, printed = [], ""
    for output in cell.get("outputs", []):
        if output.output_type == "stream":
            printed += output.text
        elif _IMAGE not in output.data:
            if "text/html" in output.data:
                blocks.append(" ".join(output.data["text/html"].split()))
            else:
                printed += output.data["text/plain"] + "\n"
    if printed:
        lines = "\n".join(line.rstrip() for line in printed.rstrip().split("\n"))
        blocks.insert(0, f"```text\n{lines}\n```")
    return [f"{_OUTPUT}\n{block}" for block in blocks]


def page(notebook: Any, name: str) -> str:
    """A notebook as a page; of one that was not executed, without outputs."""
    blocks, count = [f"<!-- Made by python/tools/make_notebooks.py from python/notebooks/{name}.py -->"], 0
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            blocks.append(cell.source.strip())
            continue
        blocks.append(f"```python\n{cell.source.strip()}\n```")
        blocks.extend(_outputs(cell))
        if "alt" in cell.metadata:
            count += 1
            blocks.append(f"![{cell.metadata['alt']}]({name}-{count}.svg)")
    blocks.append(f"*This page is the notebook `python/notebooks/{name}.py`, executed. Jupyter opens it with jupytext.*")
    return "\n\n".join(blocks) + "\n"


def without_outputs(text: str) -> str:
    """A page as it is before its notebook is executed."""
    return _OF_OUTPUT.sub("", text)


def _same(one: str, other: str) -> bool:
    """The same words; numbers within one percent, or both next to nothing (residuals differ from computer to computer)."""
    if [_NUMBER.sub("#", word) for word in one.split()] != [_NUMBER.sub("#", word) for word in other.split()]:
        return False
    pairs = zip(_NUMBER.findall(one), _NUMBER.findall(other), strict=True)
    sizes = ((abs(float(a) - float(b)), max(abs(float(a)), abs(float(b)))) for a, b in pairs)
    return all(off <= 0.01 * size or size < 0.02 for off, size in sizes)


def differences(name: str, made: str, shown: str) -> list[str]:
    """Where two pages of a notebook differ."""
    if without_outputs(made) != without_outputs(shown):
        return [f"book/src/notebooks/{name}.md is not what python/notebooks/{name}.py says"]
    own, others = _OF_OUTPUT.findall(made), _OF_OUTPUT.findall(shown)
    if len(own) != len(others):
        return [f"book/src/notebooks/{name}.md shows {len(others)} outputs, and there are {len(own)}"]
    pairs = zip(own, others, strict=True)
    return [f"python/notebooks/{name}.py prints\n{a}\nand book/src/notebooks/{name}.md says\n{b}" for a, b in pairs if not _same(a, b)]


def sources() -> dict[str, Path]:
    """Notebooks by their names."""
    return {path.stem: path for path in sorted(NOTEBOOKS.glob("*.py"))}


def faults() -> list[str]:
    """What differs between pages and notebooks."""
    wrong, expected = [], set()
    for name, path in sources().items():
        wanted = page(jupytext.read(path), name)
        expected |= {f"{name}.md", *re.findall(rf"\(({name}-\d+\.svg)\)", wanted)}
        file = PAGES / f"{name}.md"
        if not file.exists() or without_outputs(file.read_text(encoding="utf-8")) != wanted:
            wrong.append(f"book/src/notebooks/{name}.md is not what python/notebooks/{name}.py says")
    there = {path.name for path in PAGES.iterdir()} if PAGES.exists() else set()
    wrong += [f"book/src/notebooks/{name} is missing" for name in sorted(expected - there) if name.endswith(".svg")]
    return wrong + [f"book/src/notebooks/{name} belongs to no notebook" for name in sorted(there - expected)]


def made(path: Path) -> dict[str, str]:
    """Page and pictures of a notebook, by their file names: the page first."""
    notebook = executed(path)
    return {f"{path.stem}.md": page(notebook, path.stem), **pictures(notebook, path.stem)}


def write(path: Path, into: Path) -> None:
    """Executes a notebook and writes its page and pictures."""
    files = made(path)
    into.mkdir(parents=True, exist_ok=True)
    for old in into.glob(f"{path.stem}-*.svg"):
        old.unlink()
    for file, text in files.items():
        (into / file).write_text(text, encoding="utf-8", newline="\n")


def tried(path: Path) -> list[str]:
    """Executes a notebook and compares it with its page."""
    text = made(path)[f"{path.stem}.md"]
    shown = PAGES / f"{path.stem}.md"
    return differences(path.stem, text, shown.read_text(encoding="utf-8") if shown.exists() else "")


def main() -> None:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("names", nargs="*", metavar="NAME", help="notebooks without .py; all without any")
    parser.add_argument("--check", action="store_true", help="compare text and code of the pages with the notebooks")
    parser.add_argument("--try", action="store_true", dest="try_", help="execute, and compare with the pages")
    parser.add_argument("--into", type=Path, default=PAGES, help="folder for pages and pictures")
    asked = parser.parse_args()
    known = sources()
    unknown = sorted(set(asked.names) - set(known))
    if unknown:
        sys.exit(f"there is no notebook {unknown[0]!r}; there are {', '.join(known)}")
    wrong = faults() if asked.check else []
    for name in [] if asked.check else asked.names or known:
        try:
            if asked.try_:
                wrong += tried(known[name])
            else:
                write(known[name], asked.into)
        except (CellExecutionError, NotebookFaultError) as fault:
            sys.exit(f"{name}: {fault}")
    if wrong:
        sys.exit("\n".join([*wrong, "make the pages anew with python python/tools/make_notebooks.py"]))


if __name__ == "__main__":
    main()
