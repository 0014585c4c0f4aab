"""Stiffness of small models as formulas: Jacobians, compliance and stiffness with named symbols, over SymPy (extra ``sym``).

Conventions of the package: SI, base axes, linear part before angular, rotations as rotation vectors on SO(3), a wrench is what the
environment applies to the tool. References such as ``[R 3.10]`` are equations of the COROUSSO report; where its print is wrong the
corrected form stands here.

Examples
--------
>>> from kinetostat import symbolic
>>> arm = symbolic.Chain("arm").actuator("q", "revolute", "z", stiffness="k", at=0).move("L")
>>> arm.compliance(directions=("y", "rz")).matrix
Matrix([
[L**2/k, L/k],
[   L/k, 1/k]])
"""

from __future__ import annotations

try:
    import sympy as _sympy  # noqa: F401
except ImportError as missing:  # pragma: no cover
    raise ImportError("kinetostat.symbolic needs SymPy: pip install 'kinetostat[sym]'") from missing

from kinetostat.symbolic._chain import Chain
from kinetostat.symbolic._expression import Formula, Stiffness
from kinetostat.symbolic._links import beam, in_parallel, leg, planar_beam, with_passive_joint
from kinetostat.symbolic._machine import NamedChain, from_machine
from kinetostat.symbolic._substitution import substitute

__all__ = [
    "Chain",
    "Formula",
    "NamedChain",
    "Stiffness",
    "beam",
    "from_machine",
    "in_parallel",
    "leg",
    "planar_beam",
    "substitute",
    "with_passive_joint",
]
