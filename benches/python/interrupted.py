"""How long Ctrl-C takes to end a long call, the longest of all that the tests interrupt; prints a line of figures.

Run by ``cargo xtask figures --python`` in the environment of the tests, whose processes it starts.
"""

from __future__ import annotations

import math
import sys
import tempfile
from pathlib import Path

from overhead import figure

sys.path.insert(0, str(Path(__file__).parents[2] / "python/tests"))

from test_interrupted import CALLS, interrupted_after


def main() -> None:
    """Measures and prints."""
    longest = -math.inf
    for name in CALLS:
        with tempfile.TemporaryDirectory() as folder:
            seconds = interrupted_after(name, Path(folder))
        print(f"{name}: KeyboardInterrupt {seconds:.3f} s after Ctrl-C")
        longest = max(longest, seconds)
    figure(f"Python: Ctrl-C to KeyboardInterrupt, the longest of {len(CALLS)} calls", longest, 0.5, "s")


if __name__ == "__main__":
    main()
