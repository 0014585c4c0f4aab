"""What can go wrong.

A physical finding (a free direction, an unstable shape, a joint outside its limits) is part of a result, never an exception.
"""

from __future__ import annotations

__all__ = ["ArgumentError", "KinetostatError", "ModelError", "ToleranceMissedWarning", "UnansweredError"]


class KinetostatError(Exception):
    """Any error of this package."""


class ModelError(KinetostatError, ValueError):
    """A model that is none; the message has the line, what was expected and what to do."""


class ArgumentError(KinetostatError, ValueError):
    """An argument of the wrong shape, unit or value; the message says what was expected and what was found."""


class UnansweredError(KinetostatError, RuntimeError):
    """The question is right but has no answer: a place out of reach, or an iteration that did not converge."""


class ToleranceMissedWarning(UserWarning):
    """A program was written, but it misses the tolerance that was asked for; the answer says where."""
