"""Elastostatics of robots that machine: how stiff, how far off under load, whether stable, what to command instead.

Arrays in, arrays out: SI units (m, rad, N, N m), float64, base axes, linear part before angular; a wrench is what the environment
applies to the tool. Functions that run a command of the command line (:mod:`kinetostat.commands`) return the same dictionaries as its
JSON, with units in the names.
"""

from __future__ import annotations

import importlib as _importlib
import os as _os
from typing import TYPE_CHECKING as _TYPE_CHECKING
from typing import Any as _Any

from kinetostat import _core, errors, spatial
from kinetostat.build import LimbBuilder, MachineBuilder
from kinetostat.errors import (
    ArgumentError,
    KinetostatError,
    ModelError,
    PlausibilityWarning,
    ToleranceMissedWarning,
    UnansweredError,
)
from kinetostat.force_models import ForceModel, ModelEquilibria, equilibrium_under
from kinetostat.machine import Actuator, Machine, preset_names
from kinetostat.posture import Direction, Equilibrium, LimbStiffness, LimitViolation, Posture, Stiffness
from kinetostat.problem import EquilibriumProblem
from kinetostat.program import Corrected, correct_program
from kinetostat.progress import bar
from kinetostat.results import Equilibria, Frames, Gradients, Stiffnesses, Targets
from kinetostat.spatial import pose, rotation_from_vector, rotation_vector, wrench
from kinetostat.status import DirectionKind, FoundBy, ModeKind, Status

if _TYPE_CHECKING:
    from kinetostat import (
        assembly,
        chatter,
        commands,
        compensation,
        curves,
        cutting,
        maps,
        measured,
        page,
        plot,
        shapes,
        shares,
        sweep,
        tolerance,
        vibration,
        view,
    )
    from kinetostat import symbolic as symbolic

__version__ = _core.VERSION

__all__ = [
    "Actuator",
    "ArgumentError",
    "Corrected",
    "Direction",
    "DirectionKind",
    "Equilibria",
    "Equilibrium",
    "EquilibriumProblem",
    "ForceModel",
    "FoundBy",
    "Frames",
    "Gradients",
    "KinetostatError",
    "LimbBuilder",
    "LimbStiffness",
    "LimitViolation",
    "Machine",
    "MachineBuilder",
    "ModeKind",
    "ModelEquilibria",
    "ModelError",
    "PlausibilityWarning",
    "Posture",
    "Status",
    "Stiffness",
    "Stiffnesses",
    "Targets",
    "ToleranceMissedWarning",
    "UnansweredError",
    "__version__",
    "assembly",
    "bar",
    "chatter",
    "commands",
    "compensation",
    "correct_program",
    "curves",
    "cutting",
    "equilibrium_under",
    "errors",
    "maps",
    "measured",
    "page",
    "plot",
    "pose",
    "preset_names",
    "rotation_from_vector",
    "rotation_vector",
    "shapes",
    "shares",
    "spatial",
    "sweep",
    "tolerance",
    "vibration",
    "view",
    "wrench",
]

# A child process has none of its parent's threads.
if hasattr(_os, "register_at_fork"):
    _os.register_at_fork(after_in_child=_core.forked)

# Modules that are imported when they are asked for: `import kinetostat` stays quick.
_WHEN_ASKED = (
    "assembly",
    "chatter",
    "commands",
    "compensation",
    "curves",
    "cutting",
    "maps",
    "measured",
    "page",
    "plot",
    "shapes",
    "shares",
    "sweep",
    "symbolic",  # not in __all__: it needs SymPy, and `from kinetostat import *` does not
    "tolerance",
    "vibration",
    "view",
)


def __getattr__(name: str) -> _Any:
    if name in _WHEN_ASKED:
        try:
            return _importlib.import_module(f"{__name__}.{name}")
        except ImportError as absent:
            # An AttributeError is what hasattr, inspect and pydoc expect of a module that cannot be imported.
            raise AttributeError(str(absent)) from absent
    raise AttributeError(f"module {__name__!r} has no attribute {name!r}")


def __dir__() -> list[str]:
    return sorted({*globals(), *_WHEN_ASKED})
