"""A trial of the examples."""

from __future__ import annotations

import os
import tempfile

import numpy as np

from kinetostat.measured import MirroredProgram, mirror


def trial() -> MirroredProgram:
    """A groove of 40 mm along x that was cut 50 um to its left, as :func:`kinetostat.measured.mirror` answers it.

    Examples
    --------
    >>> trial().trial
    1
    """
    x = np.linspace(0, 0.04, 41)
    points = np.stack([x, 5e-5 + 0 * x, 0 * x], axis=-1)
    with tempfile.TemporaryDirectory() as folder:
        program = os.path.join(folder, "groove.ngc")
        with open(program, "w", encoding="utf-8") as file:
            file.write("G21 G90\nG0 X0 Y0 Z0\nG1 X40 F600\nM30\n")
        return mirror(program, points, os.path.join(folder, "trial2.ngc"), register="none")
