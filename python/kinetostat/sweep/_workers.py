"""Chunks on workers: a bounded number under way, lost workers replaced, nothing that is finished lost."""

from __future__ import annotations

import queue
import uuid
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from concurrent.futures import BrokenExecutor, CancelledError, Executor, Future
from typing import Any

from kinetostat.errors import ArgumentError, KinetostatError
from kinetostat.sweep._identity import Columns, Plan, checked

__all__ = ["SweepError"]

Workers = Executor | Callable[[], Executor] | None
Keep = Callable[[int, Columns], None]

_ATTEMPTS = 3
"""Pools that may break one after the other without a finished chunk between."""

_UNKNOWN = 64
"""Chunks under way where an executor does not tell how many workers it has."""


class SweepError(KinetostatError, RuntimeError):
    """A sweep that stopped before its end; the message says how much is kept.

    Examples
    --------
    >>> issubclass(SweepError, KinetostatError)
    True
    """


def compute(plan: Plan, todo: Iterable[int], executor: Workers, under_way: int | None, threads: int | None, keep: Keep) -> None:
    """Computes chunks and hands each over as it comes, always in this thread."""
    if executor is None:
        for index in todo:
            first, last = plan.rows(index)
            keep(index, checked(plan, index, plan.function(first, last, threads=threads, **plan.settings)))
        return
    if not isinstance(executor, Executor) and not callable(executor):
        raise ArgumentError(f"executor is {executor!r}, expected an executor, or a function that makes one")
    if isinstance(executor, Executor):
        _Pool(plan, todo, executor, None, under_way, keep).work()
        return
    made = _made(executor)
    pool = _Pool(plan, todo, made, executor, under_way, keep)
    try:
        pool.work()
    except BaseException:
        _give_up(pool.executor)
        raise
    pool.executor.shutdown()


def _made(make: Callable[[], Executor]) -> Executor:
    """What a function makes; refused where it is no executor."""
    made = make()
    if not isinstance(made, Executor):
        told = f"executor() made {made!r} ({type(made).__name__}), expected an executor of concurrent.futures"
        raise ArgumentError(f"{told}, as lambda: ProcessPoolExecutor(4) makes one")
    return made


def _give_up(executor: Executor) -> None:
    """Ends an executor of our own without waiting for chunks under way: they can be computed again."""
    # Python 3.14 has terminate_workers(); without it the exit of this process would wait for them.
    processes = list((getattr(executor, "_processes", None) or {}).values())
    executor.shutdown(wait=False, cancel_futures=True)
    for process in processes:
        process.terminate()


class _Pool:
    """Chunks that wait, those under way, and those that came back."""

    def __init__(
        self, plan: Plan, todo: Iterable[int], executor: Executor, make: Callable[[], Executor] | None, under_way: int | None, keep: Keep
    ) -> None:
        self.plan = plan
        self.waiting = deque(todo)
        self.executor = executor
        self.make = make
        self.keep = keep
        self.limit = under_way if under_way is not None else _limit(executor)
        self.under_way: dict[Future[Any], int] = {}
        # A queue and no wait(): it costs the same however many are under way, and takes the futures of every library.
        self.back: queue.SimpleQueue[Future[Any]] = queue.SimpleQueue()
        self.failed: set[int] = set()
        self.broken_since_progress = 0

    def work(self) -> None:
        try:
            while self.waiting or self.under_way:
                try:
                    self._submit()
                    self._take(self.back.get())
                except BrokenExecutor as lost:
                    self._replace(lost)
        except BaseException:
            self._keep_finished()
            raise

    def _submit(self) -> None:
        while self.waiting and len(self.under_way) < self.limit:
            index = self.waiting[0]
            first, last = self.plan.rows(index)
            try:
                future = self.executor.submit(on_worker, self.plan.function, first, last, self.plan.settings, uuid.uuid4().hex)
            except BrokenExecutor:
                raise
            except RuntimeError as closed:
                raise SweepError(f"the executor takes no more chunks, from chunk {index} on: {closed}") from closed
            self.waiting.popleft()
            self.under_way[future] = index
            future.add_done_callback(self.back.put)

    def _take(self, future: Future[Any]) -> None:
        index = self.under_way.get(future)
        if index is None:
            return  # of a pool that was given up
        try:
            result = future.result()
        except BrokenExecutor:
            raise
        except (Exception, CancelledError) as failed:
            del self.under_way[future]
            if index not in self.failed:
                # Once more: Dask hands on a result that is lost with its worker as one of several errors, it cancels what was under
                # way when its scheduler does not answer for a while, and nodes have faults.
                self.failed.add(index)
                self.waiting.appendleft(index)
                return
            first, last = self.plan.rows(index)
            raise SweepError(f"chunk {index} (rows {first} to {last - 1}) failed: {type(failed).__name__}: {failed}") from failed
        # Not before it is kept: what interrupts here must not lose it.
        self.keep(index, checked(self.plan, index, result))
        del self.under_way[future]
        self.broken_since_progress = 0

    def _replace(self, lost: BaseException) -> None:
        """Another pool after one broke; the chunks that were under way go to the front."""
        self._keep_finished()
        self.waiting.extendleft(sorted(self.under_way.values(), reverse=True))
        indices = sorted(self.under_way.values())
        self.under_way.clear()
        self.broken_since_progress += 1
        if self.make is None:
            raise SweepError(
                f"the workers are lost ({type(lost).__name__}: {lost}); chunks under way: {indices}. Give a function that makes "
                "the executor instead of an executor, and lost workers are replaced"
            ) from lost
        if self.broken_since_progress >= _ATTEMPTS:
            raise SweepError(
                f"workers were lost {_ATTEMPTS} times without a finished chunk between ({type(lost).__name__}: {lost}); "
                f"under way: {indices}"
            ) from lost
        _give_up(self.executor)
        self.executor = _made(self.make)

    def _keep_finished(self) -> None:
        """Keeps what came back and waits in the queue; the rest is not waited for."""
        for future, index in list(self.under_way.items()):
            if future.cancel() or not future.done() or future.cancelled() or future.exception() is not None:
                continue
            self.keep(index, checked(self.plan, index, future.result()))
            del self.under_way[future]
            self.broken_since_progress = 0


def on_worker(function: Callable[..., Any], first: int, last: int, settings: Mapping[str, Any], submission: str) -> Any:
    """One chunk on a worker; ``submission`` tells it from the same chunk of every other submission.

    Dask takes two calls with equal arguments for one task. The same chunk asked for again, after a run was stopped or the chunk failed,
    would then be the task that is just being cancelled, or the error of the first attempt.
    """
    del submission
    # One thread in each worker: there are as many workers as cores, and the answer is the same.
    return function(first, last, threads=1, **settings)


def _limit(executor: Executor) -> int:
    workers = getattr(executor, "_max_workers", None)
    return 2 * workers if isinstance(workers, int) and workers > 0 else _UNKNOWN
