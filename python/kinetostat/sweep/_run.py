"""Sweeps in memory and in folders."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Callable, Mapping
from concurrent.futures import Executor
from typing import Any

import numpy as np

from kinetostat._arguments import mapping, or_none, text, told
from kinetostat._arrays import thread_count, whole_number
from kinetostat.errors import ArgumentError
from kinetostat.sweep._folder import Store, chunk_of
from kinetostat.sweep._identity import Columns, Function, Plan, schema
from kinetostat.sweep._workers import compute

__all__ = ["Done", "run", "to_folder"]

Progress = Callable[[int, int, str], object]

_CHUNK = 4096

_MOST_UNDER_WAY = 1_000_000


@dataclasses.dataclass(frozen=True)
class Done:
    """What a run did for a folder.

    Examples
    --------
    >>> import tempfile
    >>> from kinetostat.sweep._example import squares
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     to_folder(f"{folder}/sweep", squares, 10, chunk=4)
    Done(chunks=3, computed=3, damaged=0)
    """

    chunks: int
    """Chunks of the whole sweep, all of them there now."""
    computed: int
    """Chunks that this run computed."""
    damaged: int
    """Of these, chunks whose file was there but cut short, altered or gone."""


def run(
    function: Function,
    count: int,
    settings: Mapping[str, Any] | None = None,
    *,
    chunk: int = 4096,
    executor: Executor | Callable[[], Executor] | None = None,
    under_way: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
) -> Columns:
    """All rows of a sweep in memory.

    Memory: the answer, and the chunks under way.

    Parameters
    ----------
    function : callable
        ``function(first, last, threads=..., **settings)``, a dictionary of arrays with ``last - first`` rows. It stands at the top of a
        module that workers can import, and its answer depends on nothing but these arguments.
    count : int
        Rows of the sweep.
    settings : mapping, optional
        Arguments of the function by name: machines, arrays of numbers, numbers, text, and lists and dictionaries of these.
    chunk : int
        Rows of a chunk. A chunk should take a second or so: less, and sending it costs more; more, and a lost worker does.
    executor : concurrent.futures.Executor or callable, optional
        Where chunks are computed, or a function that makes such an executor: it is called again when workers are lost
        (``functools.partial(ProcessPoolExecutor, 4)``). In this process without one.
    under_way : int, optional
        Largest number of chunks that are sent and not yet back; twice the workers, or 64 where an executor does not tell how many.
    threads : int, optional
        Threads of the function in this process, all cores without it. Workers of an executor use one each.
    progress : callable, optional
        Called with rows that are done, ``count`` and the name of the stage; :func:`kinetostat.bar` makes one of tqdm.

    Returns
    -------
    dict of str to ndarray
        The same bits with any executor and any size of chunk, as long as each row of the function depends on that row alone.

    Raises
    ------
    SweepError
        The function failed, on an executor twice (the message says for which rows), or workers were lost and none can be made.

    Examples
    --------
    >>> from kinetostat import sweep
    >>> from kinetostat.sweep._example import squares
    >>> sweep.run(squares, 5, {"power": 3.0}, chunk=2)["square"].tolist()
    [0.0, 1.0, 8.0, 27.0, 64.0]
    """
    plan, under_way, threads = _planned(function, count, settings, chunk, under_way, threads)
    told(progress)
    whole: Columns = {}
    done: set[int] = set()
    found: list[Any] = []

    def keep(index: int, columns: Columns) -> None:
        first, last = plan.rows(index)
        if not found:
            found.append(schema(columns))
            whole.update({name: np.empty((plan.count, *array.shape[1:]), array.dtype) for name, array in columns.items()})
        elif found[0] != schema(columns):
            raise ArgumentError(f"rows {first} to {last - 1}: columns are {schema(columns)}, and were {found[0]} before")
        for name, array in columns.items():
            whole[name][first:last] = array
        done.add(index)
        _tell(progress, plan, done)

    compute(plan, range(plan.chunks), executor, under_way, threads, keep)
    return whole


def to_folder(
    folder: str | os.PathLike[str],
    function: Function,
    count: int,
    settings: Mapping[str, Any] | None = None,
    *,
    chunk: int | None = None,
    executor: Executor | Callable[[], Executor] | None = None,
    under_way: int | None = None,
    threads: int | None = None,
    progress: Progress | None = None,
    units: Mapping[str, str] | None = None,
) -> Done:
    """A sweep as a Parquet dataset with a manifest; goes on where an earlier run of the same sweep stopped.

    Chunks are written as they come, each by a temporary file that is renamed, by this process only: workers need no common file system.
    Chunks that are there are compared with their SHA-256 first, and computed again where they differ. However a run ends (an
    exception, Ctrl-C, ``kill -9``), what was finished is kept. The version of this program is part of what a sweep is: another one may
    compute other last digits. The text of the function is not: take another folder when it changes.

    Parameters
    ----------
    folder : path
        Made if it is not there. One run at a time writes it.
    units : mapping, optional
        Units by column, noted in the Parquet files.
    chunk : int, optional
        Rows of a chunk; that of the folder without it, or 4096 in a new one.
    function, count, settings, executor, under_way, threads, progress
        As for :func:`run`.

    Returns
    -------
    Done

    Raises
    ------
    ArgumentError
        The folder holds another sweep; the message names the field that differs, and both values.
    SweepError
        As for :func:`run`. What is finished is kept.

    Examples
    --------
    >>> import tempfile
    >>> from kinetostat import sweep
    >>> from kinetostat.sweep._example import squares
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     first = sweep.to_folder(folder, squares, 10, chunk=4)
    ...     again = sweep.to_folder(folder, squares, 10, chunk=4)
    >>> first.computed, again.computed
    (3, 0)
    """
    size = (chunk_of(folder) or _CHUNK) if chunk is None else chunk
    plan, under_way, threads = _planned(function, count, settings, size, under_way, threads)
    told(progress)
    or_none(mapping, "units", units, "a dictionary of units by column, or None")
    store = Store(folder, plan, units)
    before = len(store.done)

    def keep(index: int, columns: Columns) -> None:
        store.keep(index, columns)
        _tell(progress, plan, store.done)

    try:
        if store.done:
            _tell(progress, plan, store.done)
        todo = [index for index in range(plan.chunks) if index not in store.done]
        compute(plan, todo, executor, under_way, threads, keep)
    finally:
        store.close(plan.chunks)
    return Done(plan.chunks, len(store.done) - before, store.damaged)


def _planned(
    function: Function, count: int, settings: Mapping[str, Any] | None, chunk: int, under_way: int | None, threads: int | None
) -> tuple[Plan, int | None, int | None]:
    """What is computed, and how much at a time."""
    given = {} if settings is None else mapping("settings", settings, "a dictionary of arguments of the function, or None")
    for key in given:
        text("a key of settings", key, "the name of an argument of the function")
    plan = Plan(function, dict(given), count, chunk)
    return plan, or_none(whole_number, "under_way", under_way, 1, _MOST_UNDER_WAY), thread_count(threads)


def _tell(progress: Progress | None, plan: Plan, done: Any) -> None:
    if progress is not None:
        # Only the last chunk is shorter.
        short = plan.chunks * plan.size - plan.count if plan.chunks - 1 in done else 0
        progress(len(done) * plan.size - short, plan.count, "sweep")
