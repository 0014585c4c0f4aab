"""The command `kinetostat` that the package installs."""

from __future__ import annotations

import signal
import sys

from kinetostat import _core


def main() -> int:
    """Runs the command line with the words of this process; gives its exit code."""
    # The command handles Ctrl-C itself: it removes unfinished files and says that it was stopped.
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    return _core.run_as_process(sys.argv)
