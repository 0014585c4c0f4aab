"""Poses as a model file writes them, exactly."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import sympy as sp

from kinetostat.symbolic._links import hat

__all__ = ["number", "orientation", "rotation", "translation", "unit"]

UNITS = {"m": sp.Integer(1), "mm": sp.Rational(1, 1000), "rad": sp.Integer(1), "deg": sp.pi / 180}
_TRANSLATIONS = {f"{word}_{length}": UNITS[length] for word in ("translation", "position") for length in ("m", "mm")}
# The axes of the turns one after the other, each about the new axis, and which of the three numbers belongs to each.
_TURNS = {
    "rotation_intrinsic_xyz": ("xyz", (0, 1, 2)),
    "roll_pitch_yaw_urdf": ("zyx", (2, 1, 0)),
    "w_p_r_fanuc": ("zyx", (2, 1, 0)),
    "a_b_c_kuka": ("zyx", (0, 1, 2)),
}
_NEARLY_VERTICAL = sp.Rational(9, 10)


def number(value: float) -> sp.Expr:
    """A number of a file as the fraction that its decimals say."""
    return sp.Rational(repr(float(value)))


def unit(axis: str | Sequence[float]) -> sp.Matrix:
    """A direction as a file writes it: a letter with its sign, or three numbers of any length."""
    if isinstance(axis, str):
        sign, letter = (-1, axis[1:]) if axis.startswith("-") else (1, axis)
        return sign * sp.Matrix([int(letter == other) for other in "xyz"])
    parts = sp.Matrix([number(v) for v in axis])
    return parts / sp.sqrt(parts.dot(parts))


def rotation(axis: sp.Matrix, angle: sp.Expr) -> sp.Matrix:
    """Rotation about a unit axis (Rodrigues)."""
    cross = hat(axis)
    return sp.eye(3) + sp.sin(angle) * cross + (1 - sp.cos(angle)) * cross * cross


def translation(placement: Mapping[str, Any]) -> sp.Matrix:
    """In m; zero where none is written."""
    for key, scale in _TRANSLATIONS.items():
        if key in placement:
            return sp.Matrix([number(v) * scale for v in placement[key]])
    return sp.zeros(3, 1)


def orientation(placement: Mapping[str, Any]) -> sp.Matrix:
    """Rotation matrix in the convention that the placement names; none where it writes none."""
    for key, value in placement.items():
        convention, _, angle = key.rpartition("_")
        if convention in _TURNS:
            axes, order = _TURNS[convention]
            turns = [rotation(unit(a), number(value[i]) * UNITS[angle]) for a, i in zip(axes, order, strict=True)]
            return turns[0] * turns[1] * turns[2]
        if convention == "rotation_vector":
            return _about(sp.Matrix([number(v) for v in value]), UNITS[angle])
        if convention == "quaternion":
            w, *v = value if angle == "wxyz" else [value[3], *value[:3]]
            return _quaternion(number(w), hat(sp.Matrix([number(c) for c in v])))
    return _axes(placement)


def _about(vector: sp.Matrix, scale: sp.Expr) -> sp.Matrix:
    size = sp.sqrt(vector.dot(vector))
    return sp.eye(3) if size == 0 else rotation(vector / size, size * scale)


def _quaternion(w: sp.Expr, cross: sp.Matrix) -> sp.Matrix:
    # Whatever its length, which decimals leave beside 1.
    square = w**2 - (cross * cross).trace() / 2
    return sp.eye(3) + 2 * (w * cross + cross * cross) / square


def _axes(placement: Mapping[str, Any]) -> sp.Matrix:
    if "x_axis" not in placement:
        return sp.eye(3)
    x = unit(placement["x_axis"])
    if "y_axis" in placement:
        z = x.cross(unit(placement["y_axis"]))
        z = z / sp.sqrt(z.dot(z))
        return x.row_join(z.cross(x)).row_join(z)
    # As a link: the new y axis is horizontal, or, near the vertical, square to y.
    y = unit("z" if abs(x[2]) < _NEARLY_VERTICAL else "y").cross(x)
    y = y / sp.sqrt(y.dot(y))
    return x.row_join(y).row_join(x.cross(y))
