"""A function of the examples."""

from __future__ import annotations

import numpy as np


def squares(first: int, last: int, *, threads: int | None = None, power: float = 2.0) -> dict[str, np.ndarray]:
    """Rows of a sweep that needs no machine.

    Examples
    --------
    >>> squares(1, 3)["square"].tolist()
    [1.0, 4.0]
    """
    return {"square": np.arange(first, last, dtype=float) ** power}
