"""``kinetostat plan-measurement``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def plan_measurement(
    model: _Path | Machine,
    *,
    numbers: str | float | Sequence[str | float] | None = None,
    count: int | None = None,
    mass_kg: float | None = None,
    pull_n: float | None = None,
    pull_direction: Sequence[float] | None = None,
    load_on: str | float | None = None,
    load_at: Sequence[float] | None = None,
    marker: Sequence[float] | None = None,
    sigma_mm: float | None = None,
    tracker: Sequence[float] | None = None,
    x: Sequence[float] | None = None,
    y: Sequence[float] | None = None,
    z: Sequence[float] | None = None,
    work: str | float | Sequence[str | float] | None = None,
    force: Sequence[float] | None = None,
    aim: Literal["average", "determinant", "worst-direction"] | None = None,
    postures: _Path | None = None,
    candidates: int | None = None,
    seed: int | None = None,
    sheet: _Path | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Postures and loads in which to measure a machine for `identify`.

    Of many postures that the machine can take, those are chosen whose readings leave the least error
    after compensation at a place under a load, or, without one, know the numbers best; with how good
    the choice is beside the best possible. The table is the one that `identify` reads: fill in what was
    read.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    numbers : str | float | Sequence[str | float]
        Numbers to identify, as of `identify`
    count : int
        Number of measurements [default: 15]
    mass_kg : float
        Mass that hangs on the tool, kg
    pull_n : float
        Force of a string or cylinder, N, which pulls along x, along y and down
    pull_direction : Sequence[float]
        Direction in which it may pull, base axes; once for each, instead of these three
    load_on : str | float
        Node or body of a limb on which the load acts, as NODE or LIMB:NODE [default: the tool]
    load_at : Sequence[float]
        Where the load acts, mm, in the frame of the tool or node [default: its origin]
    marker : Sequence[float]
        Marker that is read, mm, in the tool's frame; once for each [default: its origin]
    sigma_mm : float
        Standard deviation of a reading, mm [default: 0.02]
    tracker : Sequence[float]
        Place of a laser tracker, mm, base axes: markers that the machine hides from it are no
        choice
    x : Sequence[float]
        Where the tool may be along x, mm, base axes
    y : Sequence[float]
        The same along y
    z : Sequence[float]
        The same along z
    work : str | float | Sequence[str | float]
        Where the machine will work: a job, or joints as in A1=10,A2=-90 (once for each posture).
        The error left there is made small
    force : Sequence[float]
        Force on the tool at these joints, N, base axes; a job has its own
    aim : Literal["average", "determinant", "worst-direction"]
        Without --work: what is made small [default: average]
    postures : path
        Postures to choose from, as a table with the axes (A1_deg, ...; CSV, XLSX or Parquet);
        without it they are drawn
    candidates : int
        Number of postures that are drawn to choose from [default: 300]
    seed : int
        Other seeds draw other postures to choose from [default: 0]
    sheet : path
        The sheet for the shop, as text
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
    >>> import kinetostat as ks
    >>> plan = ks.commands.plan_measurement("kuka_kr270_like", pull_n=1000, count=6, candidates=30)
    >>> len(plan["measurements"]), 0 < plan["efficiency"] <= 1
    (6, True)
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--numbers", numbers),
        ("--count", count),
        ("--mass-kg", mass_kg),
        ("--pull-n", pull_n),
        ("--pull-direction", pull_direction),
        ("--load-on", load_on),
        ("--load-at", load_at),
        ("--marker", marker),
        ("--sigma-mm", sigma_mm),
        ("--tracker", tracker),
        ("--x", x),
        ("--y", y),
        ("--z", z),
        ("--work", work),
        ("--force", force),
        ("--aim", aim),
        ("--postures", postures),
        ("--candidates", candidates),
        ("--seed", seed),
        ("--sheet", sheet),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
    ]
    return answered(["plan-measurement"], options, progress)
