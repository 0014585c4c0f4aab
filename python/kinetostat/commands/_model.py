"""``kinetostat model``; made by python/tools/make_commands.py."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, Literal

from kinetostat._running import answered, texted

if TYPE_CHECKING:
    from kinetostat.machine import Machine

_Path = str | os.PathLike[str]
_Progress = Callable[[int, int, str], object]


def model_list(
    *,
    progress: _Progress | None = None,
) -> str:
    """The presets, one line each.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "orthoglide" in ks.commands.model_list()
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["model", "list"], options, progress)


def model_show(
    name: str | float,
    *,
    progress: _Progress | None = None,
) -> str:
    """The model file of a preset: a start for your own.

    Parameters
    ----------
    name : str | float
        Name of the preset
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> "[mechanism]" in ks.commands.model_show("two_link")
    True
    """
    options: list[tuple[str, Any]] = [
        ("name", name),
    ]
    return texted(["model", "show"], options, progress)


def model_schema(
    *,
    progress: _Progress | None = None,
) -> str:
    """The JSON Schema of model files, for editors.

    Parameters
    ----------
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import json
    >>> import kinetostat as ks
    >>> "mechanism" in json.loads(ks.commands.model_schema())["properties"]
    True
    """
    options: list[tuple[str, Any]] = [
    ]
    return texted(["model", "schema"], options, progress)


def model_compare(
    a: _Path | Machine,
    b: _Path | Machine,
    *,
    progress: _Progress | None = None,
) -> dict[str, Any]:
    """Are two models one machine but for constant offsets of base, tool and joints.

    Parameters
    ----------
    a : path | Machine
        Preset or model file
    b : path | Machine
        Preset or model file with as many actuators
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    dict
        What the command prints with ``--json``.

    Examples
    --------
    >>> import kinetostat as ks
    >>> found = ks.commands.model_compare("heavy_6r", "heavy_6r")
    >>> found["same"]
    True
    """
    options: list[tuple[str, Any]] = [
        ("a", a),
        ("b", b),
    ]
    return answered(["model", "compare"], options, progress)


def model_draw(
    model: _Path | Machine,
    *,
    at: Sequence[float] | None = None,
    rotation: str | float | None = None,
    joints: str | float | Sequence[str | float] | None = None,
    controller: str | float | Sequence[str | float] | None = None,
    pendant: str | float | Sequence[str | float] | None = None,
    tool_length_mm: float | None = None,
    view: Literal["iso", "front", "side", "top"] | None = None,
    motion: int | None = None,
    force: Sequence[float] | None = None,
    moment: Sequence[float] | None = None,
    scale: float | None = None,
    out: _Path | None = None,
    force_overwrite: bool = False,
    progress: _Progress | None = None,
) -> str:
    """A drawing of a machine (SVG), and of how it moves or bends.

    Links that bend, rigid ones, drives, passive joints, platforms, base and tool, at home or at a
    place. With --motion: how the machine moves in its softest or free direction, by which joints. With
    --force or --moment: the deflected machine over the undeflected one.

    Parameters
    ----------
    model : path | Machine
        Preset or model file
    at : Sequence[float]
        Place of the tool's tip in base axes, mm; home without it
    rotation : str | float
        Orientation of the tool there by a named convention, as in a_b_c_kuka_deg=0,0,90, or the
        word follows: the one nearest to that at home which the machine can have there. Without it,
        the orientation at home; it follows where the machine cannot hold one
    joints : str | float | Sequence[str | float]
        The place by the model's joint values instead, deg and mm, as in shoulder=30 rail=250;
        joints that are not named stay at home
    controller : str | float | Sequence[str | float]
        The same by what the controller shows, as in J1=10 J2=31.324; the model declares it in its
        section controller
    pendant : str | float | Sequence[str | float]
        The name of `--controller` before; it is taken for one version more, with a warning
    tool_length_mm : float
        Distance of the tool's tip along z of the flange, mm
    view : Literal["iso", "front", "side", "top"]
        From where to look; without it, square to a machine in one plane, else obliquely
    motion : int
        Draw the motion in the N-th softest direction of the tool; 1 is a free one, if there is any
    force : Sequence[float]
        Draw the machine under this force on the tool's tip, N (0 0 0: under its own weight)
    moment : Sequence[float]
        Draw the machine under this moment on the tool, N m
    scale : float
        How many times larger the deflection is drawn; without it, a round number that shows it
    out : path
        The drawing; without it, it goes to the standard output
    force_overwrite : bool
        Overwrite an existing file
    progress : callable
        Called with what is done, how much there is and the name of the stage.

    Returns
    -------
    str
        What it prints.

    Examples
    --------
    >>> import kinetostat as ks
    >>> ks.commands.model_draw("two_link").lstrip().startswith("<svg")
    True
    """
    options: list[tuple[str, Any]] = [
        ("model", model),
        ("--at", at),
        ("--rotation", rotation),
        ("--joints", joints),
        ("--controller", controller),
        ("--pendant", pendant),
        ("--tool-length-mm", tool_length_mm),
        ("--view", view),
        ("--motion", motion),
        ("--force", force),
        ("--moment", moment),
        ("--scale", scale),
        ("--out", out),
        ("--force-overwrite", force_overwrite),
    ]
    return texted(["model", "draw"], options, progress)
