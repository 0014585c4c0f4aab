"""``kinetostat chatter``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import Any

from kinetostat._running import answered

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def chatter(
    job: _Path,
    *,
    model: str | float | None = None,
    program: _Path | None = None,
    damping: float | Sequence[float] | None = None,
    rayleigh: Sequence[float] | None = None,
    loss_factor: float | None = None,
    viscous: str | float | Sequence[str | float] | None = None,
    modes_up_to_hz: float | None = None,
    every_mm: float | None = None,
    most_places: int | None = None,
    threads: int | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""Where a program chatters, and at which spindle speed and depth it would not.

    Takes the job of `compensate` with a material, a cutter and a stock (or an engagement), and a model
    with masses. Along the program the tools go through the stock; wherever the cut or the posture
    changes, the limit of depth at the programmed spindle speed is computed: exact, in the posture of
    the machine there, under the mean force of the cut. Where it does not chatter, the vibration that
    the passing teeth force, and what it leaves on the wall. Flat end mills with straight edges or a
    helix; spindles that turn to the right; no process damping.

    Parameters
    ----------
    job : path
        Job file (TOML)
    model : str | float
        Preset or model file, in place of the job's
    program : path
        G-code program, in place of the job's
    damping : float | Sequence[float]
        Ratio to critical damping of all modes (0.03 is 3 %), or one for each of the lowest modes,
        the last for all above
    rayleigh : Sequence[float]
        C = A M + B K: A in 1/s, B in s
    loss_factor : float
        Loss factor of all springs, structural damping
    viscous : str | float | Sequence[str | float]
        Dampers at joints and springs by name, N s/m or N m s/rad, as in "joint 1"=900
    modes_up_to_hz : float
        Modes above this count by their flexibility at rest, Hz [default: 300, and as far as modes
        count]
    every_mm : float
        Places of one cut that are farther apart are judged by themselves, mm [default: 25]
    most_places : int
        Most places that are judged [default: 2000]
    threads : int
        Number of threads; all cores without it. The result is the same
    csv : path
        All points as a table (CSV)
    plot : path
        The drawing (SVG)
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> import kinetostat as ks
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     file = Path(folder, "slot.toml")
    ...     _ = file.write_text('schema = 1\nmodel = "heavy_6r"\nprogram = "slot.ngc"\n[placement]\npart_origin_mm = [1450, 70, 500]\n[tool]\nlength_mm = 200\ncutter = { shape = "flat", diameter_mm = 12, teeth = 2 }\n[material]\nname = "linear aluminium"\n[engagement]\nwidth_mm = 12\ndepth_mm = 3\npart = "right"\n')
    ...     _ = Path(folder, "slot.ngc").write_text(
    ...         "G21 G90 G17\nT1 M6\nS3000 M3\nG0 X0 Y0 Z5\nG1 Z-3 F600\nG1 X40\nG0 Z5\nM30\n"
    ...     )
    ...     found = ks.commands.chatter(file, damping=[0.03])
    >>> found["chatters"], [stretch["first_line"] for stretch in found["stretches"]]
    (True, [6])
    """
    options: list[tuple[str, Any]] = [
        ("job", job),
        ("--model", model),
        ("--program", program),
        ("--damping", damping),
        ("--rayleigh", rayleigh),
        ("--loss-factor", loss_factor),
        ("--viscous", viscous),
        ("--modes-up-to-hz", modes_up_to_hz),
        ("--every-mm", every_mm),
        ("--most-places", most_places),
        ("--threads", threads),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["chatter"], options, progress)
