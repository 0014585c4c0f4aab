"""A sweep in a folder: chunk files, a journal while it runs, a manifest of what is there.

``manifest.json`` is written when the sweep begins (what it is), and when a run ends or is interrupted (the SHA-256 of every chunk). In
between every finished chunk is a line of ``journal.jsonl``, so that a run that is killed loses nothing either.
"""

from __future__ import annotations

import dataclasses
import json
import os
from collections.abc import Collection, Iterator, Mapping
from pathlib import Path
from typing import IO, Any

import numpy as np

from kinetostat._arguments import or_none, texts
from kinetostat._arguments import path as file_path
from kinetostat.errors import ArgumentError
from kinetostat.sweep import _parquet
from kinetostat.sweep._identity import FORMAT, Columns, Plan, difference, schema
from kinetostat.sweep._lock import lock, unlock
from kinetostat.sweep._manifest import damaged, sound_structure
from kinetostat.sweep._signals import unbroken

__all__ = ["Verified", "chunks", "read", "verify"]

_IDENTITY = ("format", "version", "function", "count", "chunk", "settings")


@dataclasses.dataclass(frozen=True)
class Verified:
    """What a folder holds, by its manifest.

    Examples
    --------
    >>> found = Verified(count=30, chunks=3, sound=(0, 2), damaged=(1,))
    >>> found.missing, found.complete
    ((1,), False)
    """

    count: int
    """Rows of the whole sweep."""
    chunks: int
    """Chunks of the whole sweep."""
    sound: tuple[int, ...]
    """Chunks whose file has the SHA-256 of the manifest."""
    damaged: tuple[int, ...]
    """Chunks of the manifest whose file is absent, cut short or altered, or whose number is not one of this sweep."""

    @property
    def missing(self) -> tuple[int, ...]:
        """Chunks that are not sound, computed or not."""
        return tuple(sorted(set(range(self.chunks)) - set(self.sound)))

    @property
    def complete(self) -> bool:
        """Whether every row is there, as it was computed."""
        return len(self.sound) == self.chunks and not self.damaged


def verify(folder: str | os.PathLike[str]) -> Verified:
    """Whether a sweep is complete and as it was computed: every chunk file is read and compared with the manifest.

    Parameters
    ----------
    folder : path
        Folder of :func:`to_folder`.

    Returns
    -------
    Verified

    Raises
    ------
    ArgumentError
        The folder holds no sweep, or its manifest is damaged.

    Examples
    --------
    >>> import tempfile
    >>> from kinetostat import sweep
    >>> from kinetostat.sweep._example import squares
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = sweep.to_folder(folder, squares, 10, chunk=4)
    ...     sweep.verify(folder).complete
    True
    """
    path = Path(file_path("folder", folder))
    manifest = _manifest(path)
    recorded = _recorded(path, manifest)
    total = _chunks(manifest)
    sound = {index for index, digest in recorded.items() if 0 <= index < total and _is_sound(path, index, digest)}
    return Verified(manifest["count"], total, tuple(sorted(sound)), tuple(sorted(set(recorded) - sound)))


def chunks(folder: str | os.PathLike[str], names: Collection[str] | None = None) -> Iterator[tuple[int, int, Columns]]:
    """The finished chunks of a sweep one after the other: first row, the one after the last, and arrays by name.

    Parameters
    ----------
    folder : path
        Folder of :func:`to_folder`.
    names : collection of str, optional
        Columns to read; all without it.

    Raises
    ------
    ArgumentError
        The folder holds no sweep, its manifest is damaged, or a file is not what the manifest says.

    Examples
    --------
    >>> import tempfile
    >>> from kinetostat import sweep
    >>> from kinetostat.sweep._example import squares
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = sweep.to_folder(folder, squares, 10, chunk=4)
    ...     [(first, last) for first, last, columns in sweep.chunks(folder)]
    [(0, 4), (4, 8), (8, 10)]
    """
    path = Path(file_path("folder", folder))
    manifest = _manifest(path)
    recorded = _recorded(path, manifest)
    fields = manifest["schema"] or []
    wanted_names = or_none(texts, "names", names, "a list of names of columns, or None")
    absent = sorted(set(wanted_names or ()) - {field["name"] for field in fields})
    if absent and recorded:
        raise ArgumentError(
            f"names has {absent[0]!r}, and {path} has no such column; it has {', '.join(field['name'] for field in fields)}"
        )
    wanted = [field for field in fields if wanted_names is None or field["name"] in wanted_names]
    alien = sorted(set(recorded) - set(range(_chunks(manifest))))
    if alien:
        raise damaged(path / "manifest.json", f"chunk {alien[0]} is none of the {_chunks(manifest)} of this sweep")
    stored = [field["name"] for field in fields if 0 not in field["shape"]]
    for index in sorted(recorded):
        first = index * manifest["chunk"]
        last = min(first + manifest["chunk"], manifest["count"])
        file = _file(path, index)
        try:
            columns = _parquet.read(file, wanted, stored)
        except FileNotFoundError:
            raise ArgumentError(f"{file} is absent: run the sweep again") from None
        except (KeyError, ValueError) as failed:
            raise ArgumentError(f"{file} is not what the manifest says, one of them is damaged: {failed}") from None
        if any(len(array) != last - first for array in columns.values()):
            raise ArgumentError(f"{file} does not have the {last - first} rows that the manifest says: one of them is damaged")
        yield first, last, columns


def read(folder: str | os.PathLike[str], names: Collection[str] | None = None) -> Columns:
    """All rows of a complete sweep, as :func:`run` gives them.

    Parameters
    ----------
    folder : path
        Folder of :func:`to_folder`.
    names : collection of str, optional
        Columns to read; all without it.

    Raises
    ------
    ArgumentError
        Chunks are missing or damaged: :func:`to_folder` computes them.

    Examples
    --------
    >>> import tempfile
    >>> from kinetostat import sweep
    >>> from kinetostat.sweep._example import squares
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     done = sweep.to_folder(folder, squares, 5, chunk=2)
    ...     sweep.read(folder)["square"].tolist()
    [0.0, 1.0, 4.0, 9.0, 16.0]
    """
    names = or_none(texts, "names", names, "a list of names of columns, or None")
    found = verify(folder)
    if not found.complete:
        raise ArgumentError(
            f"{os.fspath(folder)} has {len(found.sound)} of {found.chunks} chunks ({len(found.damaged)} damaged): run the sweep again, "
            "it computes the others"
        )
    whole: Columns = {}
    for first, last, columns in chunks(folder, names):
        for name, array in columns.items():
            if name not in whole:
                whole[name] = np.empty((found.count, *array.shape[1:]), array.dtype)
            whole[name][first:last] = array
    return whole


def chunk_of(folder: str | os.PathLike[str]) -> int | None:
    """Rows of a chunk of the sweep that a folder holds; none where there is no sweep."""
    path = Path(file_path("folder", folder))
    return int(_manifest(path)["chunk"]) if (path / "manifest.json").is_file() else None


class Store:
    """The folder while a run writes it; one run at a time."""

    def __init__(self, folder: str | os.PathLike[str], plan: Plan, notes: Mapping[str, str] | None) -> None:
        _parquet.library()
        self.path = Path(file_path("folder", folder))
        self.notes = notes
        _fit_for_a_sweep(self.path)
        (self.path / "chunks").mkdir(parents=True, exist_ok=True)
        self.lock = lock(self.path / "journal.jsonl")
        self.journal: IO[str] = open(self.path / "journal.jsonl", "a", encoding="utf-8")  # noqa: SIM115, closed by close()
        try:
            self.manifest = self._begun(plan.identity())
            recorded = _recorded(self.path, self.manifest)
            total = _chunks(self.manifest)
            self.done = {i: digest for i, digest in recorded.items() if 0 <= i < total and _is_sound(self.path, i, digest)}
            self.damaged = len(recorded) - len(self.done)
            self.journal.write("\n")  # ends a line at which an earlier run was killed
            for left in self.path.glob("*.part"):
                left.unlink()
        except BaseException:
            self.journal.close()
            unlock(self.lock)
            raise

    def _begun(self, identity: dict[str, Any]) -> dict[str, Any]:
        if not (self.path / "manifest.json").exists():
            manifest = {**identity, "schema": None, "complete": False, "chunks": {}}
            _replace(self.path / "manifest.json", manifest)
            return manifest
        manifest = _manifest(self.path)
        found = difference({key: manifest[key] for key in _IDENTITY}, json.loads(json.dumps(identity)))
        if found is not None:
            name, there, here = found
            raise ArgumentError(
                f"{self.path} holds another sweep: {name} is {json.dumps(there)} there and {json.dumps(here)} here; "
                "take another folder, or remove this one"
            )
        return manifest

    def keep(self, index: int, columns: Columns) -> None:
        """Writes a chunk, whole or not at all."""
        if index in self.done:
            return
        with unbroken():
            self._same_schema(schema(columns))
            beside = self.path / f"{index:08}.part"
            _parquet.write(beside, columns, self.notes)
            digest = _parquet.digest(beside)
            os.replace(beside, _file(self.path, index))
            # One write of a whole line: what is cut short is no JSON, and ignored.
            self.journal.write(json.dumps({"chunk": index, "sha256": digest}) + "\n")
            self.journal.flush()
            self.done[index] = digest

    def _same_schema(self, found: list[dict[str, Any]]) -> None:
        if self.manifest["schema"] is None:
            self.manifest["schema"] = found
            _replace(self.path / "manifest.json", self.manifest)
        elif self.manifest["schema"] != found:
            raise ArgumentError(f"{self.path}: schema is {self.manifest['schema']} there and {found} here")

    def close(self, total: int) -> None:
        """Writes the manifest of what is there, and empties the journal."""
        with unbroken():
            self.manifest["chunks"] = {str(index): self.done[index] for index in sorted(self.done)}
            self.manifest["complete"] = len(self.done) == total
            _replace(self.path / "manifest.json", self.manifest)
            self.journal.truncate(0)
            self.journal.close()
            unlock(self.lock)


def _fit_for_a_sweep(folder: Path) -> None:
    """Refuses what is no folder, and a folder with other files: only one that is empty, or that holds a sweep, is written to."""
    if folder.exists() and not folder.is_dir():
        raise ArgumentError(f"{folder} is a file, expected a folder: one that is not there yet, an empty one, or that of this sweep")
    if not folder.is_dir() or (folder / "manifest.json").exists():
        return
    # What a run leaves that was killed before its manifest was written.
    others = sorted(entry.name for entry in folder.iterdir() if entry.name not in ("chunks", "journal.jsonl", "manifest.json.part"))
    if others:
        raise ArgumentError(f"{folder} is not empty and holds no sweep (it has {others[0]!r}, and no manifest.json): take another folder")


def _file(folder: Path, index: int) -> Path:
    return folder / "chunks" / f"{index:08}.parquet"


def _is_sound(folder: Path, index: int, digest: str) -> bool:
    file = _file(folder, index)
    return file.is_file() and _parquet.digest(file) == digest


def _manifest(folder: Path) -> dict[str, Any]:
    file = folder / "manifest.json"
    try:
        found = json.loads(file.read_text(encoding="utf-8"))
    except FileNotFoundError:
        raise ArgumentError(f"{folder} holds no sweep: it has no manifest.json") from None
    except (ValueError, OSError, RecursionError) as failed:
        raise ArgumentError(f"{file} is no manifest of a sweep: {failed}") from None
    absent = [key for key in (*_IDENTITY, "schema", "complete", "chunks") if not isinstance(found, dict) or key not in found]
    if absent:
        raise ArgumentError(f"{file} is no manifest of a sweep: it has no {absent[0]!r}")
    if found["format"] != FORMAT:
        raise ArgumentError(f"{file} has format {found['format']}, expected {FORMAT}: it is of another version ({found['version']})")
    return sound_structure(file, dict(found))


def _chunks(manifest: dict[str, Any]) -> int:
    """Chunks of the whole sweep."""
    return -(-int(manifest["count"]) // int(manifest["chunk"]))


def _recorded(folder: Path, manifest: dict[str, Any]) -> dict[int, str]:
    """SHA-256 by chunk, of the manifest and of the journal of a run that did not end."""
    recorded = {int(index): str(digest) for index, digest in manifest["chunks"].items()}
    journal = folder / "journal.jsonl"
    for line in journal.read_text(encoding="utf-8").splitlines() if journal.exists() else []:
        try:
            entry = json.loads(line)
            recorded[int(entry["chunk"])] = str(entry["sha256"])
        except (ValueError, KeyError, TypeError, OverflowError):
            continue  # the line at which a run was killed
    return recorded


def _replace(file: Path, content: dict[str, Any]) -> None:
    beside = file.with_suffix(".json.part")
    with open(beside, "w", encoding="utf-8", newline="\n") as out:
        json.dump(content, out, indent=1)
        out.write("\n")
        out.flush()
        os.fsync(out.fileno())
    os.replace(beside, file)
