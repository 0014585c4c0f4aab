"""Every command of the command line as a function; made by python/tools/make_commands.py from the command line's own table.

A function takes the options of its command by their names and gives what the command prints with ``--json``, as a dictionary (units are
part of its names, see STABILITY.md); commands without such an answer give their text. Units of options are those of the command line (mm,
deg, N, N m), not the SI units of everything else in the package: where a name says none, the docstring does. Where the command line
takes the name of a model, a :class:`kinetostat.Machine` does too. Wrong input raises ``ArgumentError``, a question without an answer
``UnansweredError``; a program that misses its tolerance is written, and warned of with ``ToleranceMissedWarning``.
"""

from __future__ import annotations

from kinetostat._running import Completed, run
from kinetostat.commands._assemble import assemble
from kinetostat.commands._chatter import chatter
from kinetostat.commands._check import check
from kinetostat.commands._compare import compare
from kinetostat.commands._compensate import compensate
from kinetostat.commands._convert import convert
from kinetostat.commands._curve import curve
from kinetostat.commands._deflect import deflect
from kinetostat.commands._demo import demo
from kinetostat.commands._dialect import dialect_list, dialect_show
from kinetostat.commands._engagement import engagement
from kinetostat.commands._equilibria import equilibria
from kinetostat.commands._expand import expand
from kinetostat.commands._force import force
from kinetostat.commands._frf import frf
from kinetostat.commands._identify import identify
from kinetostat.commands._import import import_link_displacements, import_matrix, import_urdf
from kinetostat.commands._lobes import lobes
from kinetostat.commands._map import map
from kinetostat.commands._mirror import mirror
from kinetostat.commands._model import model_compare, model_draw, model_list, model_schema, model_show
from kinetostat.commands._modes import modes
from kinetostat.commands._place import place
from kinetostat.commands._plan_measurement import plan_measurement
from kinetostat.commands._reproduce import reproduce
from kinetostat.commands._shares import shares
from kinetostat.commands._stiffness import stiffness
from kinetostat.commands._tolerance import tolerance
from kinetostat.commands._verify import verify
from kinetostat.commands._view import view

__all__ = [
    "Completed",
    "assemble",
    "chatter",
    "check",
    "compare",
    "compensate",
    "convert",
    "curve",
    "deflect",
    "demo",
    "dialect_list",
    "dialect_show",
    "engagement",
    "equilibria",
    "expand",
    "force",
    "frf",
    "identify",
    "import_link_displacements",
    "import_matrix",
    "import_urdf",
    "lobes",
    "map",
    "mirror",
    "model_compare",
    "model_draw",
    "model_list",
    "model_schema",
    "model_show",
    "modes",
    "place",
    "plan_measurement",
    "reproduce",
    "run",
    "shares",
    "stiffness",
    "tolerance",
    "verify",
    "view",
]
