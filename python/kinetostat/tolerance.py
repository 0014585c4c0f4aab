"""Tolerances: how far results scatter when a machine is not exactly as drawn.

Numbers of the model are named by their paths and scatter in their own units; results are in mm and N/mm, as their names say.
"""

from __future__ import annotations

import dataclasses
import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core
from kinetostat._arguments import flag, mapping, of_kind, one_of, refused, shown, text, texts, told
from kinetostat._arguments import function as callable_given
from kinetostat._arrays import Floats, numbers, one, real, scalar, thread_count, whole_number
from kinetostat._places import poses_of
from kinetostat.errors import ArgumentError, UnansweredError
from kinetostat.machine import Machine

__all__ = ["Distribution", "MachineSamples", "SobolIndices", "draws", "machines", "normal", "sobol", "triangular", "uniform"]

_QUANTITIES = ("error", "deflection_by_load", "deviation", "compensated", "stiffness")
_WORDS = ("normal", "uniform", "triangular")
_MOST_DRAWS = 2**20
_LEAST_SOBOL = 128
"""With 16 sequences, 8 draws in each: below, the scatter between the sequences is no honest interval."""


def _seed(value: int) -> int:
    return whole_number("seed", value, 0, 2**64 - 1)


@dataclasses.dataclass(frozen=True)
class Distribution:
    """How a number scatters about its value.

    Examples
    --------
    >>> Distribution("normal", 5.0, percent=True) == normal(5, percent=True)
    True
    """

    word: str
    """``normal``, ``uniform`` or ``triangular``."""
    spread: float
    """Standard deviation of a normal one, half width of another."""
    percent: bool = False
    """The spread is a percentage of the value."""

    def __post_init__(self) -> None:
        one_of("word", self.word, _WORDS)
        scalar("spread", self.spread)
        flag("percent", self.percent)


def normal(deviation: float, *, percent: bool = False) -> Distribution:
    """Normal, by its standard deviation.

    Examples
    --------
    >>> normal(0.02).word
    'normal'
    """
    return Distribution("normal", scalar("deviation", deviation), percent)


def uniform(half_width: float, *, percent: bool = False) -> Distribution:
    """Everything from minus to plus the half width alike.

    Examples
    --------
    >>> uniform(5, percent=True).spread
    5.0
    """
    return Distribution("uniform", scalar("half_width", half_width), percent)


def triangular(half_width: float, *, percent: bool = False) -> Distribution:
    """Symmetric, zero at minus and plus the half width.

    Examples
    --------
    >>> triangular(0.1).word
    'triangular'
    """
    return Distribution("triangular", scalar("half_width", half_width), percent)


@dataclasses.dataclass(frozen=True)
class MachineSamples:
    """Machines drawn by chance, and the linear function beside them. NaN where a machine has no answer at a place.

    Examples
    --------
    >>> spread = {"chain.leg.q2.length_mm": normal(0.01)}
    >>> found = machines(Machine.preset("orthoglide"), spread, [[0, 0, 0]], quantities=["error"], draws=64)
    >>> found.names, found.columns[0], found.no_answer
    (('chain.leg.q2.length_mm',), 'error_mm', 0)
    """

    names: tuple[str, ...]
    """Of the uncertain numbers."""
    columns: tuple[str, ...]
    """Of the results, with units."""
    values: Floats
    """What the drawing states, shape (numbers,)."""
    inputs: Floats
    """Values drawn, shape (n, numbers), in their own units."""
    samples: Floats
    """Results, shape (n, places, columns)."""
    nominal: Floats
    """Results of the machine as drawn, shape (places, columns)."""
    standard_deviation: Floats
    """Standard deviations by linear propagation, shape (places, columns)."""
    derivatives: Floats
    """Central differences, shape (places, columns, numbers), per unit of each number."""
    no_machine: int
    """Draws whose numbers make no machine."""
    no_answer: int
    """Draws without an answer at a place or more."""
    unstable: int
    """Draws that are not stable under the load at a place or more; their numbers count."""

    def column(self, name: str) -> Floats:
        """One result of all machines, shape (n, places).

        Raises
        ------
        ArgumentError
            If there is no such column.

        Examples
        --------
        >>> spread = {"chain.leg.q2.length_mm": normal(0.01)}
        >>> found = machines(Machine.preset("orthoglide"), spread, [[0, 0, 0]], quantities=["error"], draws=64)
        >>> found.column("error_mm").shape
        (64, 1)
        """
        return self.samples[:, :, self.columns.index(one_of("name", name, self.columns))]

    def nonlinearity(self) -> Floats:
        """Root mean square of exact minus linear in standard deviations, shape (places, columns); beyond 0.1 linear is not enough.

        Examples
        --------
        >>> spread = {"chain.leg.q2.length_mm": normal(0.01)}
        >>> found = machines(Machine.preset("orthoglide"), spread, [[0, 0, 0]], quantities=["stiffness"], draws=64)
        >>> found.nonlinearity().shape == found.nominal.shape
        True
        """
        line = self.nominal + np.einsum("pcd,nd->npc", self.derivatives, self.inputs - self.values)
        off = np.sqrt(np.nanmean((self.samples - line) ** 2, axis=0))
        with np.errstate(divide="ignore", invalid="ignore"):
            found: Floats = np.where(off <= 1e-10 * np.abs(self.nominal), 0.0, off / np.nanstd(self.samples, axis=0))
        return found


def _distribution(name: str, own: Distribution) -> Distribution:
    """Itself, if it is one with a finite spread: a plain number says neither its distribution nor its unit."""
    if not isinstance(own, Distribution):
        hint = f": normal({own!r}), uniform({own!r}), ..." if isinstance(own, (int, float)) else ""
        raise ArgumentError(f"{name} is {shown(own)}, expected a Distribution{hint}")
    real(name, own.spread)
    return own


def _toml(spread: Mapping[str, Distribution], correlations: Mapping[tuple[str, str], float]) -> str:
    lines = ["schema = 1"]
    for name, own in spread.items():
        text("a key of spread", name, "the path of a number of the model")
        own = _distribution(f"the spread of {name!r}", own)
        key, word = ("load", name[5:]) if name.startswith("load ") else ("parameter", name)
        lines += ["[[uncertain]]", f"{key} = {json.dumps(word)}", f"{own.word}{'_percent' if own.percent else ''} = {float(own.spread)!r}"]
    for pair, coefficient in correlations.items():
        if not isinstance(pair, tuple) or len(pair) != 2:
            raise refused("a key of correlations", pair, "two names of numbers as ('a', 'b')")
        a, b = texts("a key of correlations", pair)
        value = real(f"correlations[{a!r}, {b!r}]", coefficient)
        lines += ["[[correlation]]", f"between = [{json.dumps(a)}, {json.dumps(b)}]", f"coefficient = {value!r}"]
    return "\n".join(lines) + "\n"


def machines(
    machine: Machine,
    spread: Mapping[str, Distribution] | str,
    poses: ArrayLike,
    wrench: ArrayLike = (0.0,) * 6,
    *,
    quantities: Sequence[str] = _QUANTITIES,
    correlations: Mapping[tuple[str, str], float] | None = None,
    draws: int = 4096,
    seed: int = 0,
    threads: int | None = None,
    progress: Callable[[int, int, str], object] | None = None,
) -> MachineSamples:
    """Machines whose numbers scatter, each commanded as the drawing says.

    Parameters
    ----------
    machine : Machine
        As drawn.
    spread : mapping of str to Distribution, or str
        By path of the model's number, or ``load force_n.x`` .. ``load moment_n_m.z``, ``load factor``; or the text of a file.
    poses : array_like, shape (places, 4, 4) or (places, 3)
        Where the tool is commanded to, m; positions as for :meth:`kinetostat.Machine.stiffness`. Arms are
        commanded as next to home, be it outside their limits.
    wrench : array_like, shape (6,)
        Force and moment on the tool (N, N m), base axes.
    quantities : sequence of str
        Of ``error`` (from where the unloaded tool is commanded to where it is: manufacture, assembly and the machine's own weight),
        ``deflection_by_load`` (from there to where the wrench moves it: own weight is not in it), ``deviation`` (both together,
        ``deflection`` in maps), ``compensated`` (the deviation that stays when commands compensate the machine as drawn), ``stiffness``.
    correlations : mapping of pairs of names to float, optional
        Of the numbers' normal scores; not with the text of a file, which states its own.
    draws : int
        Number of machines, 1 to 2**20, rounded up to a multiple of 16.
    seed : int
        The same seed draws the same machines.
    threads, progress
        As for :meth:`kinetostat.Machine.stiffness`.

    Returns
    -------
    MachineSamples

    Raises
    ------
    ArgumentError
        For a number of draws, threads or a seed out of range, and for more than 200 million results: what they would take is said
        before anything is computed.
    ModelError
        For an unknown number (with the nearest), a negative spread, contradicting correlations.
    UnansweredError
        If the machine as drawn has no answer.

    Examples
    --------
    >>> orthoglide = Machine.preset("orthoglide")
    >>> found = machines(orthoglide, {"chain.leg.q2.length_mm": normal(0.01)}, [[0, 0, 0]], [100, 0, 0, 0, 0, 0], draws=64)
    >>> found.samples.shape[:2], found.inputs.shape
    ((64, 1), (64, 1))
    """
    of_kind("machine", machine, Machine, "a Machine")
    asked = texts("quantities", quantities, f"some of {', '.join(_QUANTITIES)}")
    if not asked or any(name not in _QUANTITIES for name in asked):
        raise ArgumentError(f"quantities is {shown(quantities)}, expected one or more of {', '.join(_QUANTITIES)}")
    count = whole_number("draws", draws, 1, _MOST_DRAWS)
    threads = thread_count(threads)
    pairs = {} if correlations is None else mapping("correlations", correlations, "a dictionary of numbers by pairs of names")
    if isinstance(spread, str):
        if pairs:
            raise ArgumentError(
                "correlations goes with a dictionary of Distributions: the text of a file states its own, as [[correlation]]"
            )
        stated = text("spread", spread, "the text of a file", longest=None)
    else:
        stated = _toml(mapping("spread", spread, "a dictionary of Distributions by paths of numbers, or the text of a file"), pairs)
    places, _ = poses_of(machine._native, poses, threads)
    load = one("wrench", wrench, (6,))[None]
    found: dict[str, Any] = _core.tolerance_of_machine(
        machine._native, stated, "spread", places, load, asked, count, _seed(seed), threads, told(progress)
    )
    found["names"], found["columns"] = tuple(found["names"]), tuple(found["columns"])
    found["values"] = np.asarray(found["values"])
    return MachineSamples(**found)


def draws(values: ArrayLike, spread: Sequence[Distribution], n: int, *, correlation: ArrayLike | None = None, seed: int = 0) -> Floats:
    """Quasi-random draws (scrambled Sobol sequences), shape (n, numbers), n rounded up to a multiple of 16.

    Raises
    ------
    ArgumentError
        For n below 1 or above 2**20, or a correlation matrix that is none.

    Examples
    --------
    >>> draws([1.0, 2.0], [normal(0.1), uniform(0.5)], 32).shape
    (32, 2)
    """
    each = _each(values, spread)
    pairs = []
    if correlation is not None:
        matrix = one("correlation", correlation, (len(each), len(each)))
        if not (np.allclose(matrix, matrix.T, rtol=0, atol=1e-12) and np.allclose(np.diag(matrix), 1, rtol=0, atol=1e-12)):
            raise ArgumentError("correlation is not symmetric with ones on its diagonal")
        matrix = (matrix + matrix.T) / 2
        pairs = [(i, j, float(matrix[i, j])) for i in range(len(each)) for j in range(i)]
    return _core.drawn_numbers(each, pairs, whole_number("n", n, 1, _MOST_DRAWS), _seed(seed))


def _each(values: ArrayLike, spread: Sequence[Distribution]) -> list[tuple[float, str, float]]:
    if isinstance(spread, str) or not isinstance(spread, Sequence):
        raise refused("spread", spread, "Distributions, one for each number")
    each = [_distribution(f"spread[{i}]", own) for i, own in enumerate(spread)]
    centre = one("values", values, (len(each),))
    none = [i for i, (x, own) in enumerate(zip(centre, each, strict=True)) if own.percent and x == 0]
    if none:
        raise ArgumentError(f"spread[{none[0]}] is a percentage of a number that is zero, which is zero: state it in the number's own unit")
    return [(float(x), d.word, float(d.spread) * (abs(float(x)) / 100 if d.percent else 1)) for x, d in zip(centre, each, strict=True)]


@dataclasses.dataclass(frozen=True)
class SobolIndices:
    """Which part of the variance each number explains, with half widths of 95 % confidence; shape (outputs, numbers).

    Examples
    --------
    >>> found = sobol(lambda x: x[:, 0] * x[:, 1], [1, 1], [normal(1), normal(1)], 1024)
    >>> bool((found.total >= found.first).all())
    True
    """

    first: Floats
    """Alone."""
    first_plus_minus: Floats
    """Half widths."""
    total: Floats
    """Together with others."""
    total_plus_minus: Floats
    """Half widths."""
    unanswered: int
    """Draws that were left out because the function gave what is no number: at most 2 % of them, of one output."""


def sobol(
    function: Callable[[Floats], ArrayLike], values: ArrayLike, spread: Sequence[Distribution], n: int, *, seed: int = 0
) -> SobolIndices:
    """Sobol indices (Saltelli, Jansen) of any function of independent numbers.

    Parameters
    ----------
    function : callable
        Takes values, shape (m, numbers), and gives (m,) or (m, outputs).
    values : array_like, shape (numbers,)
        About which the numbers scatter.
    spread : sequence of Distribution
        How.
    n : int
        Draws, 128 to 2**20; the function is asked for ``n * (numbers + 2)`` rows.
    seed : int
        Of the draws.

    Raises
    ------
    ArgumentError
        For n out of range: fewer draws give no honest interval.
    UnansweredError
        If an output has no variance: it has no parts. If more than 2 % of the draws have no answer: indices of those that are left
        are not those of the function, and their scatter does not tell how far they are off.

    Examples
    --------
    >>> found = sobol(lambda x: 3 * x[:, 0] + 4 * x[:, 1], [0, 0], [normal(1), normal(1)], 1024)
    >>> bool(np.all(np.abs(found.first[0] - [0.36, 0.64]) < found.first_plus_minus[0]))
    True
    """
    callable_given("function", function, "a function of an array (m, numbers)")
    each = _each(values, spread)
    if not each:
        raise ArgumentError("spread is empty: give a Distribution for each number, at least one")
    design = _core.sobol_design(each, whole_number("n", n, _LEAST_SOBOL, _MOST_DRAWS), _seed(seed))
    rows = design.reshape(-1, len(each))
    answers = numbers("the function's answer", function(rows))
    if answers.shape[:1] != rows.shape[:1] or answers.ndim > 2 or answers.size == 0:
        raise ArgumentError(f"the function gave shape {answers.shape} for {rows.shape}, expected ({len(rows)},) or ({len(rows)}, outputs)")
    outputs = answers.reshape(len(rows), -1).T
    found = [_core.sobol_of_answers(column.tolist(), len(each)) for column in outputs]
    table = np.stack([own for own, _ in found])
    still = np.flatnonzero(np.isnan(table).any(axis=(1, 2)))
    missing = [len(design) - used for _, used in found]
    worst = int(np.argmax(missing))
    if missing[worst] > _core.MOST_MISSING * len(design):
        raise UnansweredError(
            f"output {worst} of the function is no number in {missing[worst]} of {len(design)} draws, and at most "
            f"{100 * _core.MOST_MISSING:g} % can be left out: what the others say is not said of the whole; "
            "narrow the spread to where the function has answers"
        )
    if still.size:
        raise UnansweredError(f"output {still[0]} of the function does not vary, or too few of its answers are numbers: no Sobol indices")
    first, first_plus_minus, total, total_plus_minus = (table[:, :, k] for k in range(4))
    return SobolIndices(first, first_plus_minus, total, total_plus_minus, missing[worst])
