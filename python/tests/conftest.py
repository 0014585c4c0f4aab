"""What all tests share.

The locale of the environment is set, as desktop programs that embed Python do: numbers must be written and read with a point under
each. ``cargo xtask test`` runs the tests under one with a decimal comma too.

The random cases of hypothesis are the same in every run, so that a commit passes or fails by itself;
``pytest --hypothesis-profile default`` takes new ones.
"""

from __future__ import annotations

import locale

from hypothesis import settings

settings.register_profile("same cases", derandomize=True)
settings.load_profile("same cases")

locale.setlocale(locale.LC_ALL, "")
