"""What became of a posture or an equilibrium."""

from __future__ import annotations

import enum

__all__ = ["DirectionKind", "FoundBy", "ModeKind", "Status"]


class Status(enum.IntEnum):
    """What became of one posture of many.

    Examples
    --------
    >>> Status.UNSOLVED == 2
    True
    """

    SOLVED = 0
    """There is an answer, and all commands are within their limits."""
    OUTSIDE_LIMITS = 1
    """There is an answer, but an actuator would be outside its limits.

    An arm that leaves its limits in the configuration next to home is tried in others: in all eight of an arm of six axes whose last
    three meet in one point, and in some of another serial arm. Of other machines, and with ``near``, one posture is tried."""
    UNSOLVED = 2
    """There is none: the place cannot be reached, or has no equilibrium. Its numbers are NaN.

    :meth:`kinetostat.Machine.posture` and :meth:`kinetostat.Posture.deflected_by` say of one place why."""


class FoundBy(enum.Enum):
    """How an equilibrium was found. Where several exist it tells which of them this is.

    Examples
    --------
    >>> FoundBy("directly")
    <FoundBy.DIRECTLY: 'directly'>
    """

    DIRECTLY = "directly"
    """Newton's iteration from the commanded posture."""
    OUT_OF_LINE = "out_of_line"
    """Newton's iteration from a posture slightly out of line: of shapes that mirror each other it is one."""
    GROWING_LOAD = "growing_load"
    """The load grew from rest in steps."""
    OTHER_START = "other_start"
    """Newton's iteration from another start: it may lie on another branch."""
    CONTINUATION = "continuation"
    """A curve of equilibria was followed to it."""
    RELAXATION = "relaxation"
    """Damped steps from the commanded posture of an under-constrained machine: the nearest of its equilibria on the way."""


class DirectionKind(enum.Enum):
    """What a principal direction of a stiffness is.

    Examples
    --------
    >>> [kind.value for kind in DirectionKind]
    ['free', 'finite', 'negative', 'rigid']
    """

    FREE = "free"
    """Nothing resists."""
    FINITE = "finite"
    NEGATIVE = "negative"
    """The machine goes away by itself."""
    RIGID = "rigid"
    """Nothing gives way."""


class ModeKind(enum.Enum):
    """What a mode of vibration is.

    Examples
    --------
    >>> [kind.value for kind in ModeKind]
    ['vibration', 'free', 'unstable']
    """

    VIBRATION = "vibration"
    """It swings about the equilibrium."""
    FREE = "free"
    """Mass that nothing holds: frequency zero."""
    UNSTABLE = "unstable"
    """It goes away; its frequency is negative."""
