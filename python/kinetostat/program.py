"""Programs corrected by a field of one's own: measured errors, other models, a function of Python."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import numpy as np
from numpy.typing import ArrayLike

from kinetostat import _core
from kinetostat._arguments import function, refused
from kinetostat._arrays import Floats, numbers, positive, whole_number
from kinetostat._plausibility import issue, sentences
from kinetostat.errors import ArgumentError

__all__ = ["Corrected", "correct_program"]


@dataclasses.dataclass(frozen=True)
class Corrected:
    """A program whose path is its own plus a correction, and what was measured when it was read again.

    Examples
    --------
    >>> found = correct_program("G21 G90 G1 X10 F300", lambda places, directions: 0 * places)
    >>> found.error_after <= found.allowed
    True
    """

    raw: bytes
    """The program, byte for byte: what the correction does not touch is as it was, in whatever encoding."""
    pieces: int
    """Motions written."""
    places: int
    """Places at which the field was asked again."""
    error_before: float
    """Largest distance from path plus correction if the program were left as it is, m."""
    error_after: float
    """Largest distance of the written program, m."""
    allowed: float
    """What was allowed, m: the tolerance, chords of arcs and rounding."""
    warnings: tuple[str, ...] = ()
    """What looks wrong in the corrections, as the command ``compensate`` says it of a table."""

    @property
    def text(self) -> str:
        r"""The program as text (UTF-8). Bytes that are none, such as umlauts of Latin-1, stand in it as ``surrogateescape`` writes them.

        Examples
        --------
        >>> found = correct_program(b"(L\xe4nge)\nG21 G90 G1 X10 F300", lambda places, directions: 0 * places)
        >>> found.raw.decode("latin-1").splitlines()[0], found.text.encode("utf-8", "surrogateescape") == found.raw
        ('(Länge)', True)
        """
        return self.raw.decode("utf-8", "surrogateescape")


def correct_program(
    program: str | bytes,
    field: Callable[[Floats, Floats], ArrayLike],
    *,
    tolerance: float = 5e-6,
    decimals: int | None = None,
) -> Corrected:
    r"""Adds a field of corrections to the path of a G-code program, divides blocks where it varies, and reads the result again.

    Parameters
    ----------
    program : str or bytes
        G-code; bytes in any encoding in which its words are ASCII (Latin-1 of controllers, UTF-8).
    field : callable
        Positions (n, 3), part axes, m, and directions of motion (n, 3), NaN where there is none, to corrections (n, 3), m; called for
        many points at once. It has to be continuous, and equal points must get equal answers each time.
    tolerance : float
        Largest distance of the path from path plus correction, m.
    decimals : int, optional
        Digits after the point, 3 to 8; as many as the program has without it, and those that the tolerance needs.

    Returns
    -------
    Corrected

    Raises
    ------
    ArgumentError
        The program cannot be followed (with its line), or the field gives another shape or numbers that are not finite.
    UnansweredError
        The tolerance cannot be held: the field jumps, or is another one each time that it is called.

    Warns
    -----
    PlausibilityWarning
        Corrections are larger than a program may have without being asked: usually they are in mm, not m.

    Examples
    --------
    >>> def sag(positions, directions):  # 1 um for each 10 mm of x
    ...     return np.stack([0 * positions[:, 0], 0 * positions[:, 0], 1e-4 * positions[:, 0]], axis=-1)
    >>> found = correct_program("G21 G90\nG0 X0 Y0 Z1\nG1 Z-1 F300\nG1 X100\nM2\n", sag)
    >>> round(found.error_before * 1e6, 3), found.error_after <= found.allowed
    (10.0, True)
    """

    def called(positions: Floats, directions: Floats) -> Floats:
        found = numbers("field", field(positions, directions))
        if found.shape != positions.shape:
            raise ArgumentError(f"field gives shape {found.shape}, expected {positions.shape}")
        return np.ascontiguousarray(found)

    function("field", field, "a function of positions and directions")
    digits = None if decimals is None else whole_number("decimals", decimals, 3, 8)
    written, told = _core.correct_program(_bytes(program), called, positive("tolerance", tolerance), digits)
    found = told.pop("warnings")
    issue(found)
    return Corrected(written, **told, warnings=sentences(found))


def _bytes(program: str | bytes) -> bytes:
    if isinstance(program, (bytes, bytearray, memoryview)):
        return bytes(program)
    if not isinstance(program, str):
        raise refused("program", program, "text or bytes of G-code")
    try:
        # As text is read with errors="surrogateescape".
        return program.encode("utf-8", "surrogateescape")
    except UnicodeEncodeError as wrong:
        raise ArgumentError(f"program holds what is no text: {wrong}") from None
