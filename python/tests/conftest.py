"""What all tests share.

The locale of the environment is set, as desktop programs that embed Python do: numbers must be written and read with a point under
each. ``cargo xtask test`` runs the tests under one with a decimal comma too.
"""

from __future__ import annotations

import locale

locale.setlocale(locale.LC_ALL, "")
