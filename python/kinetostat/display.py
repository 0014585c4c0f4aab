"""What notebooks show: tables with units, and the drawing of a machine. Plain HTML and SVG; needs nothing else."""

from __future__ import annotations

import html
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import of_kind, refused, text, texts

if TYPE_CHECKING:
    from kinetostat.machine import Machine
    from kinetostat.posture import Equilibrium, Posture, Stiffness

__all__ = ["equilibrium_html", "machine_html", "posture_html", "stiffness_html", "table"]

_AXES = ("x", "y", "z", "rx", "ry", "rz")


def table(head: Sequence[str], rows: Sequence[Sequence[Any]], caption: str = "") -> str:
    """An HTML table; everything in it is text.

    Parameters
    ----------
    head : sequence of str
        Names of the columns, units with them.
    rows : sequence of sequence
        Cells; numbers are shown with five digits.
    caption : str
        What it is.

    Returns
    -------
    str
        HTML.

    Examples
    --------
    >>> table(["drive", "N"], [["<x>", 2.0]])
    '<table><thead><tr><th>drive</th><th>N</th></tr></thead><tbody><tr><td>&lt;x&gt;</td><td>2</td></tr></tbody></table>'
    """

    def cell(value: Any) -> str:
        if isinstance(value, (float, np.floating)):
            return f"{value + 0.0:.5g}"
        return html.escape(str(value))

    names = texts("head", head)
    if isinstance(rows, str) or not isinstance(rows, Sequence) or any(isinstance(r, str) or not isinstance(r, Sequence) for r in rows):
        raise refused("rows", rows, "a list of rows, each a list of cells")
    caption = text("caption", caption)
    title = f"<caption>{html.escape(caption)}</caption>" if caption else ""
    columns = "".join(f"<th>{html.escape(name)}</th>" for name in names)
    body = "".join("<tr>" + "".join(f"<td>{cell(value)}</td>" for value in row) + "</tr>" for row in rows)
    return f"<table>{title}<thead><tr>{columns}</tr></thead><tbody>{body}</tbody></table>"


def _matrix(values: np.ndarray[Any, Any], caption: str) -> str:
    rows = [[name, *map(float, row)] for name, row in zip(("fx", "fy", "fz", "mx", "my", "mz"), values, strict=True)]
    return table(["", *_AXES], rows, caption)


def _drawn(machine: Machine, posture: Posture | None = None) -> str:
    """The drawing, or why there is none."""
    try:
        return machine.drawing(posture)
    except Exception as error:  # a display never hides the object that it shows
        return f"<p>{html.escape(str(error))}</p>"


def machine_html(machine: Machine) -> str:
    """Drives, limbs, platforms and the drawing at home of a machine.

    Examples
    --------
    >>> import kinetostat as ks
    >>> shown = machine_html(ks.Machine.preset("two_link"))
    >>> "<svg" in shown and "arm" in shown
    True
    """
    from kinetostat.machine import Machine

    of_kind("machine", machine, Machine, "a Machine")

    def shown(drive: Any) -> list[Any]:
        limits = "" if drive.limits is None else f"{drive.limits[0]:.5g} to {drive.limits[1]:.5g}"
        rating = "" if drive.rating is None else f"{drive.rating:.5g} {'N' if drive.unit == 'm' else 'N m'}"
        return [drive.name, drive.kind, f"{drive.home:.5g} {drive.unit}", limits, rating]

    drives = table(["drive", "kind", "home", "limits", "rating"], [shown(drive) for drive in machine.actuators])
    parts = table(
        ["limb", "from", "to", "chain"],
        [[limb["name"], limb["from"], limb["to"], limb["chain"]] for limb in machine.to_dict()["limb"]],
    )
    return f"<div><h4>{html.escape(machine.name)}</h4><p>{html.escape(machine.file)}</p>{drives}{parts}{_drawn(machine)}</div>"


def posture_html(posture: Posture) -> str:
    """Where the drives of a posture stand between their limits, and the drawing of the machine there.

    Examples
    --------
    >>> import kinetostat as ks
    >>> shown = posture_html(ks.Machine.preset("orthoglide").posture([0.02, 0, 0.03]))
    >>> "<svg" in shown and "mm" in shown
    True
    """
    from kinetostat.posture import Posture

    of_kind("posture", posture, Posture, "a Posture")
    commands = np.concatenate([commands for commands, _ in posture.limbs]) if posture.limbs else np.empty(0)

    def shown(drive: Any, command: float) -> list[Any]:
        factor, unit = (1e3, "mm") if drive.unit == "m" else (np.degrees(1.0), "deg")
        limits = "" if drive.limits is None else f"{factor * drive.limits[0]:.5g} to {factor * drive.limits[1]:.5g} {unit}"
        return [drive.name, f"{factor * command + 0.0:.5g} {unit}", limits]

    x, y, z = 1e3 * posture.target[:3, 3] + 0.0
    rows = [shown(drive, float(command)) for drive, command in zip(posture.machine.actuators, commands, strict=True)]
    drives = table(["drive", "command", "limits"], rows, f"tool at {x:.5g}, {y:.5g}, {z:.5g} mm")
    outside = "".join(f"<p>{html.escape(found.actuator)} is outside its limits</p>" for found in posture.limit_violations)
    return f"<div>{drives}{outside}{_drawn(posture.machine, posture)}</div>"


def _without_rounding(matrix: np.ndarray[Any, Any]) -> np.ndarray[Any, Any]:
    """Zero where a number is nothing beside the stiffest translation and rotation: what is left of a sum by rounding."""
    stiffest = np.nan_to_num(np.abs(np.diag(matrix))).reshape(2, 3).max(axis=1)
    size = np.sqrt(np.repeat(stiffest, 3))
    return np.where(np.abs(matrix) <= 1e-12 * np.outer(size, size), 0.0, matrix)


def stiffness_html(stiffness: Stiffness) -> str:
    """Matrix and principal directions of a stiffness.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "N/m" in stiffness_html(ks.Machine.preset("two_link").posture().stiffness())
    True
    """
    from kinetostat.posture import Stiffness

    of_kind("stiffness", stiffness, Stiffness, "a Stiffness of a Posture")
    caption = "stiffness: N/m, N/rad; N m/m, N m/rad; base axes, about the tool's reference point"
    matrix = _matrix(_without_rounding(stiffness.matrix), caption)
    # The longest part of a twist is 1 m.
    rows = [[d.kind.value, d.stiffness, *(0.0 if abs(x) < 1e-12 else float(x) for x in d.twist)] for d in stiffness.directions]
    directions = table(["direction", "N/m", "x, m", "y, m", "z, m", "rx, rad", "ry, rad", "rz, rad"], rows, f"rank {stiffness.rank}")
    return f"<div>{matrix}{directions}</div>"


def equilibrium_html(equilibrium: Equilibrium) -> str:
    """Displacement, wrench, forces of the drives and tangent stiffness of an equilibrium.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "mm" in equilibrium_html(ks.Machine.preset("orthoglide").posture().deflected_by([1, 0, 0, 0, 0, 0]))
    True
    """
    from kinetostat.posture import Equilibrium

    of_kind("equilibrium", equilibrium, Equilibrium, "an Equilibrium")
    moved, wrench = equilibrium.displacement, equilibrium.wrench
    units = [("mm", 1e3, "N")] * 3 + [("deg", 180 / np.pi, "N m")] * 3
    rows = [[_AXES[k], f"{moved[k] * units[k][1]:.5g} {units[k][0]}", f"{wrench[k]:.5g} {units[k][2]}"] for k in range(6)]
    what = "stable" if equilibrium.stable else "NOT stable"
    head = table(["", "displacement", "wrench on the tool"], rows, f"{what}, found {equilibrium.found_by.value.replace('_', ' ')}")
    named = zip(equilibrium.posture.machine.actuators, equilibrium.actuator_forces, strict=True)
    drives = table(["drive", "load on it"], [[a.name, f"{f:.5g} {'N' if a.unit == 'm' else 'N m'}"] for a, f in named])
    return f"<div>{head}{drives}{_matrix(equilibrium.stiffness, 'tangent stiffness: N/m, N/rad; N m/m, N m/rad')}</div>"
