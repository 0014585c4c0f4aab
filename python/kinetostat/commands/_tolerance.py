"""``kinetostat tolerance``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def tolerance(
    model: _Path | Machine,
    *,
    uncertain: _Path | None = None,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    tool_length_mm: float | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    only: Literal["error", "deflection-by-load", "deviation", "compensated", "stiffness"] | Sequence[Literal["error", "deflection-by-load", "deviation", "compensated", "stiffness"]] | None = None,
    machines: int | None = None,
    seed: int | None = None,
    sobol: int | None = None,
    csv: _Path | None = None,
    plot: _Path | None = None,
    force_overwrite: bool = False,
    threads: int | None = None,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    r"""How far do results scatter when the machine is not exactly as drawn.

    Builds thousands of machines whose numbers scatter as a file says, commands each as the drawing
    says, and tells the spread of its error, its deflection and its stiffness, before and after
    compensation; beside it what linear propagation says, and whether that is enough.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    uncertain : path
        What is uncertain (TOML, see below), or a model that `identify` wrote [default: what the
        model says]
    at : Sequence[float]
        Place of the tool's tip in base axes, mm; once for each place; home without it
    rotation : str | float
        Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    force : Sequence[float]
        Force on the tool's tip, N, base axes
    moment : Sequence[float]
        Moment on the tool about its tip, N m, base axes
    only : Literal["error", "deflection-by-load", "deviation", "compensated", "stiffness"] | Sequence[Literal["error", "deflection-by-load", "deviation", "compensated", "stiffness"]]
        What is asked; without it, error and stiffness, and under a load everything
    machines : int
        Number of machines, rounded up to a multiple of 16 [default: 4096]
    seed : int
        Seed of the draws; the same seed draws the same machines [default: 0]
    sobol : int
        Sobol indices, too, from so many draws, each of which asks for as many machines as there are
        uncertain numbers, and two
    csv : path
        All machines as a table (CSV): the numbers drawn, then the results at every place
    plot : path
        Histogram of the first result at the first place, with the linear one above it (SVG)
    force_overwrite : bool
        Overwrite outputs that exist (never an input)
    threads : int
        Number of threads; all cores without it. The result is the same
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
    ...     file = Path(folder, "uncertain.toml")
    ...     _ = file.write_text('schema = 1\n[[uncertain]]\nparameter = "chain.leg.q2.length_mm"\nnormal = 0.02\n')
    ...     found = ks.commands.tolerance("orthoglide", uncertain=file, force=[100, 0, 0], machines=256)
    >>> error = next(r for r in found["places"][0]["results"] if r["name"] == "error_mm")
    >>> error["draws"]["answered"], found["uncertain"][0]["distribution"]
    (256, 'normal')
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--uncertain", uncertain),
        ("--at", at),
        ("--rotation", rotation),
        ("--tool-length-mm", tool_length_mm),
        ("--force", force),
        ("--moment", moment),
        ("--only", only),
        ("--machines", machines),
        ("--seed", seed),
        ("--sobol", sobol),
        ("--csv", csv),
        ("--plot", plot),
        ("--force-overwrite", force_overwrite),
        ("--threads", threads),
    ]
    return answered(["tolerance"], options, progress)
