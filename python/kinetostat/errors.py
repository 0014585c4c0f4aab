"""What can go wrong.

A physical finding (a free direction, an unstable shape, a joint outside its limits) is part of a result, never an exception.
"""

from __future__ import annotations

from typing import Any

__all__ = ["ArgumentError", "KinetostatError", "ModelError", "PlausibilityWarning", "ToleranceMissedWarning", "UnansweredError"]


class KinetostatError(Exception):
    """Any error of this package.

    Examples
    --------
    >>> import kinetostat as ks
    >>> try:
    ...     ks.Machine.preset("none of these")
    ... except KinetostatError as error:
    ...     print(type(error).__name__)
    ModelError
    """

    diagnostics: tuple[dict[str, Any], ...] = ()
    """Faults of a command one by one, as ``kinetostat schema error`` describes them: code, file, line, message, remedy. Empty elsewhere."""


class ModelError(KinetostatError, ValueError):
    """A model that is none; the message has the line, what was expected and what to do.

    Examples
    --------
    >>> import kinetostat as ks
    >>> try:
    ...     ks.Machine.from_toml("schema = 1")
    ... except ModelError as error:
    ...     print("mechanism" in str(error))
    True
    """


class ArgumentError(KinetostatError, ValueError):
    """An argument of the wrong shape, unit or value; the message says what was expected and what was found.

    Examples
    --------
    >>> import kinetostat as ks
    >>> try:
    ...     ks.Machine.preset("orthoglide").posture([0, 0])
    ... except ArgumentError as error:
    ...     print(error)
    position has shape (2,), expected (3,)
    """


class UnansweredError(KinetostatError, RuntimeError):
    """The question is right but has no answer: a place out of reach, or an iteration that did not converge.

    Examples
    --------
    >>> import kinetostat as ks
    >>> try:
    ...     ks.Machine.preset("orthoglide").posture([9, 0, 0])
    ... except UnansweredError:
    ...     print("out of reach")
    out of reach
    """


class _Detailed(UserWarning):
    """A warning whose text is constant, so that filters merge repeated ones."""

    def __init__(self, text: str, detail: str = "") -> None:
        super().__init__(text)
        self.detail = detail
        """Message with figures and places."""


class PlausibilityWarning(_Detailed):
    """A figure beyond what machines have: usually a unit is wrong. A command warns of it too, or refuses a program.

    The text is that of the kind, ``detail`` has the figures. What is only unusual is not issued; with the others it is in the ``warnings``
    of the result.

    Examples
    --------
    >>> import warnings
    >>> import kinetostat as ks
    >>> with warnings.catch_warnings(record=True) as found:
    ...     warnings.simplefilter("always")
    ...     machine = ks.Machine.preset("heavy_6r").with_tool(length=180)  # mm taken for m
    >>> str(found[0].message), found[0].message.detail in machine.warnings
    ('no tool has such a length; check its unit (m)', True)
    """


class ToleranceMissedWarning(_Detailed):
    """A program was written, but it misses the tolerance that was asked for; ``detail`` and the answer say where.

    Examples
    --------
    >>> import warnings
    >>> with warnings.catch_warnings(record=True) as found:
    ...     warnings.simplefilter("always")
    ...     warnings.warn(ToleranceMissedWarning("missed", "worst at line 3"), stacklevel=1)
    >>> found[0].message.detail
    'worst at line 3'
    """
