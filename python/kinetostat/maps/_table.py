"""Maps as files of other programs."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat.errors import ArgumentError
from kinetostat.sweep import _parquet

if TYPE_CHECKING:
    import xarray

__all__ = ["to_parquet", "to_vtk"]

_ROWS = 65536
_VTK = (".vtu", ".vtk", ".xdmf", ".xmf")


def to_parquet(found: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Writes a map as one Parquet file: a row for each place, with its coordinates, units as metadata of the columns.

    Examples
    --------
    >>> import tempfile, os
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").map(x=[0.0, 0.01])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     to_parquet(found, os.path.join(folder, "map.parquet"))
    """
    _, parquet = _parquet.library()
    dims = found["status"].dims
    shape = found["status"].shape
    notes = {str(name): str(array.attrs["units"]) for name, array in found.variables.items() if "units" in array.attrs}
    columns = {str(name): array.transpose(*dims, ...).values for name, array in found.data_vars.items()}
    flat = {name: values.reshape(-1, *values.shape[len(dims) :]) for name, values in columns.items()}

    def write(beside: Path) -> None:
        writer = None
        try:
            for first in range(0, max(int(np.prod(shape)), 1), _ROWS):
                at = np.unravel_index(np.arange(first, min(first + _ROWS, int(np.prod(shape)))), shape)
                where = {str(name): found[name].values[index] for name, index in zip(dims, at, strict=True)}
                single = {str(name): np.full(len(at[0]), found[name].values) for name in "xyz" if name not in dims and name in found.coords}
                part = _parquet.table({**where, **single, **{name: values[first : first + _ROWS] for name, values in flat.items()}}, notes)
                writer = writer or parquet.ParquetWriter(beside, part.schema, compression="zstd", use_dictionary=list(map(str, dims)))
                writer.write_table(part)
        finally:
            if writer is not None:
                writer.close()

    _whole(path, write)


def to_vtk(found: xarray.Dataset, path: str | os.PathLike[str]) -> None:
    """Writes a map for ParaView and its like: points with their values, joined to cells of the grid.

    Values of several loads or orientations are arrays with their names: ``deflection[load=mill]``. Written by meshio, which joins
    cells one by one; the ending of the path says how (``.vtu`` compressed, ``.vtk``, ``.xdmf``).

    Parameters
    ----------
    found : xarray.Dataset
        A map.
    path : path
        File to write.

    Raises
    ------
    ArgumentError
        The path has another ending.

    Examples
    --------
    >>> import tempfile, os
    >>> import kinetostat as ks
    >>> found = ks.Machine.preset("orthoglide").map(x=[0.0, 0.01], y=[0.0, 0.01])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     to_vtk(found, os.path.join(folder, "map.vtu"))
    """
    try:
        import meshio
    except ImportError as absent:
        raise ImportError("VTK files are written by meshio: pip install 'kinetostat[io]'") from absent
    if os.path.splitext(path)[1].lower() not in _VTK:
        raise ArgumentError(f"path is {os.fspath(path)!r}, expected an ending of {', '.join(_VTK)}")
    axes = grid_axes(found)
    points = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, 3)
    kind, cells = _cells([len(axis) for axis in axes])
    data = {name: values.reshape(len(points), *values.shape[3:]) for name, values in grid_values(found)}
    mesh = meshio.Mesh(points, [(kind, cells)], point_data=data)
    _whole(path, lambda beside: meshio.write(beside, mesh))


def grid_axes(found: xarray.Dataset) -> list[Any]:
    """Coordinates along x, y and z, m; one where a map has one place."""
    return [np.atleast_1d(found[name].values) for name in "xyz"]


def grid_values(found: xarray.Dataset) -> Iterator[tuple[str, Any]]:
    """Every variable, by loads and orientations, as (x, y, z) or (x, y, z, columns)."""
    along = [name for name in "xyz" if name in found["status"].dims]
    counts = tuple(len(axis) for axis in grid_axes(found))
    for name, array in found.data_vars.items():
        other: list[str] = [dim for dim in ("load", "orientation") if dim in array.dims]
        for label, part in _parts(array, other):
            values = part.transpose(*along, ...).values
            columns = (int(np.prod(values.shape[len(along) :])),) if values.ndim > len(along) else ()
            yield f"{name}{label}", values.reshape(counts + columns)


def _parts(array: Any, dims: list[str]) -> list[tuple[str, Any]]:
    """An array by loads and orientations, with what stands behind its name."""
    parts = [("", array)]
    for dim in dims:
        parts = [(f"{label}[{dim}={value}]", part.sel({dim: value})) for label, part in parts for value in array[dim].values]
    return parts


def _cells(counts: list[int]) -> tuple[str, Any]:
    """Lines, quadrilaterals or hexahedra between the points of a grid, the last axis fastest."""
    index = np.arange(int(np.prod(counts))).reshape(counts)
    axes = [k for k in range(3) if counts[k] > 1]
    square: list[tuple[int, ...]] = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cube = [(*corner, up) for up in (0, 1) for corner in square]
    shapes: list[list[tuple[int, ...]]] = [[()], [(0,), (1,)], square, cube]
    around = shapes[len(axes)]
    cells = []
    for corner in around:
        cut = [slice(None)] * 3
        for k, far in zip(axes, corner, strict=True):
            cut[k] = slice(1, None) if far else slice(None, -1)
        cells.append(index[tuple(cut)].reshape(-1))
    return ("vertex", "line", "quad", "hexahedron")[len(axes)], np.stack(cells, axis=-1)


def _whole(path: str | os.PathLike[str], write: Callable[[Path], object]) -> None:
    """A file, whole or not at all."""
    target = Path(path)
    if not target.suffix:
        raise ArgumentError(f"{target} has no ending: it says how the file is written")
    beside = target.with_name(f".{target.stem}.{os.getpid()}{target.suffix}")
    try:
        write(beside)
        os.replace(beside, target)
    finally:
        beside.unlink(missing_ok=True)
