"""A function of the examples."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray


def squares(first: int, last: int, *, threads: int | None = None, power: float = 2.0) -> dict[str, NDArray[Any]]:
    """Rows of a sweep that needs no machine.

    Examples
    --------
    >>> squares(1, 3)["square"].tolist()
    [1.0, 4.0]
    """
    return {"square": np.arange(first, last, dtype=float) ** power}
