"""Progress of long calls."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import Any

__all__ = ["bar"]


@contextmanager
def bar(**options: Any) -> Iterator[Callable[[int, int, str], None]]:
    """A progress bar of tqdm for the argument ``progress``.

    Parameters
    ----------
    **options
        Handed to ``tqdm.auto.tqdm``.

    Yields
    ------
    callable
        Called with what is done, how much there is (0: nobody knows) and the name of the stage.

    Examples
    --------
    >>> import os
    >>> import kinetostat as ks
    >>> with open(os.devnull, "w") as nowhere, bar(file=nowhere) as progress:
    ...     found = ks.Machine.preset("orthoglide").stiffness([[0, 0, 0], [0.01, 0, 0]], progress=progress)
    >>> found.solved.tolist()
    [True, True]
    """
    from tqdm.auto import tqdm

    with tqdm(**options) as shown:

        def progress(done: int, total: int, stage: str) -> None:
            if stage:
                shown.set_description(stage, refresh=False)
            shown.total = total or None
            shown.n = done
            shown.refresh()

        yield progress
