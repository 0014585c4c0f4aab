"""Ray's workers as an executor: Ray has remote functions whose futures are those of the standard library."""

from __future__ import annotations

from collections.abc import Callable
from concurrent.futures import Executor, Future
from typing import Any

__all__ = ["RayExecutor"]


class RayExecutor(Executor):
    """The Ray cluster this process is connected to (``ray.init``), as an executor.

    Parameters
    ----------
    **options
        Of ``ray.remote``: ``num_cpus``, ``resources``, ``max_retries`` (3 in Ray itself: a lost worker costs its chunk).

    Examples
    --------
    >>> issubclass(RayExecutor, Executor)
    True
    >>> import ray  # doctest: +SKIP
    >>> _ = ray.init()  # doctest: +SKIP
    >>> machine.map(x=[0.0, 0.01], executor=RayExecutor())  # doctest: +SKIP
    """

    def __init__(self, **options: Any) -> None:
        import ray

        self._ray = ray
        self._options = {"num_cpus": 1, **options}
        self._remote: dict[Callable[..., Any], Any] = {}
        self._max_workers = max(1, int(ray.cluster_resources().get("CPU", 1)))

    def submit(self, fn: Callable[..., Any], /, *args: Any, **kwargs: Any) -> Future[Any]:
        """Starts a call on a worker.

        Examples
        --------
        >>> RayExecutor().submit(abs, -2).result()  # doctest: +SKIP
        2
        """
        if fn not in self._remote:
            self._remote[fn] = self._ray.remote(**self._options)(fn)
        future: Future[Any] = self._remote[fn].remote(*args, **kwargs).future()
        return future
