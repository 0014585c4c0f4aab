"""Poses, wrenches and rotations as plain arrays.

A pose is a 4 x 4 matrix, base from tool: rotation, position (m), and 0 0 0 1. A wrench is ``[fx, fy, fz, mx, my, mz]`` (N, N m), a twist
``[x, y, z, rx, ry, rz]`` (m, rad): linear part first, base axes, about the tool's reference point. A wrench is what the environment
applies to the tool.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from kinetostat._arrays import fitting, numbers
from kinetostat.errors import ArgumentError

__all__ = ["pose", "rotation_from_vector", "rotation_vector", "wrench"]


def _check_rotations(m: NDArray[np.float64]) -> None:
    # NaN passes: rows of a stack without a value stay without an answer.
    if np.any(np.abs(np.swapaxes(m, -1, -2) @ m - np.eye(3)) > 1e-6) or np.any(np.linalg.det(m) < 0):
        raise ArgumentError("rotation holds a matrix that is no rotation: give orthonormal ones of determinant 1")


def pose(position: ArrayLike = (0.0, 0.0, 0.0), rotation: ArrayLike | None = None) -> NDArray[np.float64]:
    """Poses from positions and rotations.

    Parameters
    ----------
    position : array_like, shape (..., 3)
        Positions of the tool's reference point, m, base axes.
    rotation : array_like, shape (..., 3, 3), optional
        Rotation matrices, base from tool; none without it.

    Returns
    -------
    ndarray, shape (..., 4, 4)
        Poses, base from tool; leading shapes are broadcast.

    Examples
    --------
    >>> pose([0.1, 0, 0.5])[:3, 3]
    array([0.1, 0. , 0.5])
    """
    places = fitting("position", position, (3,))
    given = np.eye(3) if rotation is None else numbers("rotation", rotation)
    if given.shape == (3,):
        raise ArgumentError("rotation has shape (3,), expected (..., 3, 3): of a rotation vector, rad, rotation_from_vector makes one")
    turns = fitting("rotation", given, (3, 3))
    _check_rotations(turns)
    leading = np.broadcast_shapes(places.shape[:-1], turns.shape[:-2])
    out = np.zeros((*leading, 4, 4))
    out[..., :3, :3] = turns
    out[..., :3, 3] = places
    out[..., 3, 3] = 1.0
    return out


def wrench(force: ArrayLike = (0.0, 0.0, 0.0), moment: ArrayLike = (0.0, 0.0, 0.0)) -> NDArray[np.float64]:
    """Wrenches on the tool from forces and moments.

    Parameters
    ----------
    force : array_like, shape (..., 3)
        N, base axes.
    moment : array_like, shape (..., 3)
        N m, base axes, about the tool's reference point.

    Returns
    -------
    ndarray, shape (..., 6)
        Force, then moment; leading shapes are broadcast.

    Examples
    --------
    >>> wrench([300, 0, -500])
    array([ 300.,    0., -500.,    0.,    0.,    0.])
    """
    forces, moments = np.broadcast_arrays(fitting("force", force, (3,)), fitting("moment", moment, (3,)))
    return np.concatenate([forces, moments], axis=-1)


def rotation_from_vector(vector: ArrayLike) -> NDArray[np.float64]:
    """Rotation matrices from rotation vectors (axis times angle, rad).

    Parameters
    ----------
    vector : array_like, shape (..., 3)
        Rotation vectors, rad, base axes.

    Returns
    -------
    ndarray, shape (..., 3, 3)
        Rotation matrices.

    Examples
    --------
    >>> np.round(rotation_from_vector([0, 0, np.pi / 2]), 12) + 0.0
    array([[ 0., -1.,  0.],
           [ 1.,  0.,  0.],
           [ 0.,  0.,  1.]])
    """
    v = fitting("vector", vector, (3,))
    angle = np.linalg.norm(v, axis=-1)[..., None, None]
    hat = np.zeros((*v.shape[:-1], 3, 3))
    hat[..., 2, 1], hat[..., 0, 2], hat[..., 1, 0] = v[..., 0], v[..., 1], v[..., 2]
    hat[..., 1, 2], hat[..., 2, 0], hat[..., 0, 1] = -v[..., 0], -v[..., 1], -v[..., 2]
    # sin a / a and (1 - cos a) / a^2 without a difference of nearly equal numbers.
    first = np.sinc(angle / np.pi)
    second = 0.5 * np.sinc(angle / (2 * np.pi)) ** 2
    out: NDArray[np.float64] = np.eye(3) + first * hat + second * (hat @ hat)
    return out


def rotation_vector(rotation: ArrayLike) -> NDArray[np.float64]:
    """Rotation vectors (axis times angle, rad) of rotation matrices.

    Parameters
    ----------
    rotation : array_like, shape (..., 3, 3)
        Rotation matrices.

    Returns
    -------
    ndarray, shape (..., 3)
        Rotation vectors, rad, with angles of at most pi.

    Examples
    --------
    >>> rotation_vector([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    array([0.        , 0.        , 1.57079633])
    """
    m = fitting("rotation", rotation, (3, 3))
    _check_rotations(m)
    # The quaternion by the largest of its four squares, so that no root of a small number is divided by.
    trace = np.trace(m, axis1=-2, axis2=-1)
    diagonal = np.diagonal(m, axis1=-2, axis2=-1)
    squares = np.concatenate([1 + 2 * diagonal - trace[..., None], 1 + trace[..., None]], axis=-1)
    largest = np.argmax(squares, axis=-1)
    candidates = np.empty((*m.shape[:-2], 4, 4))
    for i, j, k in ((0, 1, 2), (1, 2, 0), (2, 0, 1)):
        candidates[..., i, i] = squares[..., i]
        candidates[..., i, j] = m[..., j, i] + m[..., i, j]
        candidates[..., i, k] = m[..., k, i] + m[..., i, k]
        candidates[..., i, 3] = m[..., k, j] - m[..., j, k]
        candidates[..., 3, i] = candidates[..., i, 3]
    candidates[..., 3, 3] = squares[..., 3]
    q = np.take_along_axis(candidates, largest[..., None, None], axis=-2)[..., 0, :]
    q = q / np.linalg.norm(q, axis=-1, keepdims=True)
    q = np.where(q[..., 3:] < 0, -q, q)
    sine = np.linalg.norm(q[..., :3], axis=-1, keepdims=True)
    angle = 2 * np.arctan2(sine, q[..., 3:])
    factor = np.divide(angle, sine, out=np.full_like(sine, 2.0), where=sine > 0)
    out: NDArray[np.float64] = q[..., :3] * factor
    return out
