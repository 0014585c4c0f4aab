"""``kinetostat identify``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def identify(
    model: _Path | Machine,
    *,
    measured: _Path | None = None,
    numbers: str | float | Sequence[str | float] | None = None,
    find_frame: bool = False,
    sigma_mm: float | None = None,
    friction: bool = False,
    prior_percent: float | None = None,
    robust: bool = False,
    resamples: int | None = None,
    small_loads: bool = False,
    work: _Path | None = None,
    out: _Path | None = None,
    report: _Path | None = None,
    pdf: _Path | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Stiffnesses of a machine from measured deflections.

    Pull at the tool with a known force, or hang a known mass on it, in some fifteen postures, and read
    how far it moves: with a laser tracker, or with a dial gauge. The stiffnesses that fit the readings
    best are found, with what the readings can and cannot tell of them.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    measured : path
        Table of the measurements (CSV, XLSX or Parquet, see below)
    numbers : str | float | Sequence[str | float]
        Numbers to identify: paths as in `chain.arm.A2.stiffness_n_m_per_rad`, * for any text;
        `joints` for the stiffness of every drive; `geometry` for errors of the links, from places
    find_frame : bool
        Readings are in the instrument's own frame: find it from places (x_mm, ...) without a load
    sigma_mm : float
        Standard deviation of a reading where the table has none, mm [default: 0.02]
    friction : bool
        Friction of the drives, too, from rows with `branch` loading and unloading
    prior_percent : float
        How far the model's numbers are trusted, percent: what the readings do not tell stays near
        them
    robust : bool
        Readings far from the fit count less, so that a few bad ones spoil little
    resamples : int
        Intervals from fits to N drawings of as many postures (bootstrap), in place of Student's;
        1000 are usual
    small_loads : bool
        Displacements in proportion to the load, without weights: as textbooks do
    work : path
        Job of the work that the machine is for: what is left along its program before and after
    out : path
        Model file with the identified numbers, their standard deviations and correlations
    report : path
        The report with pictures, as one HTML file
    pdf : path
        The report as PDF
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
    ...     table = Path(folder, "pulls.csv")
    ...     plan = ks.commands.plan_measurement("kuka_kr270_like", pull_n=1000, count=6, candidates=30, csv=table)
    ...     _ = table.write_text(table.read_text().replace(",,,,", ",0.1,0.2,0.3,"))
    ...     found = ks.commands.identify("kuka_kr270_like", measured=table)
    >>> found["readings"], len(found["numbers"])
    (18, 6)
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--measured", measured),
        ("--numbers", numbers),
        ("--find-frame", find_frame),
        ("--sigma-mm", sigma_mm),
        ("--friction", friction),
        ("--prior-percent", prior_percent),
        ("--robust", robust),
        ("--resamples", resamples),
        ("--small-loads", small_loads),
        ("--work", work),
        ("--out", out),
        ("--report", report),
        ("--pdf", pdf),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["identify"], options, progress)
