"""Maps as files of other programs."""

from __future__ import annotations

import dataclasses
import itertools
import os
import re
from collections.abc import Callable, Iterable, Iterator, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat._arguments import path as file_path
from kinetostat.errors import ArgumentError
from kinetostat.maps._variables import a_map
from kinetostat.sweep import _parquet

if TYPE_CHECKING:
    import xarray

__all__ = ["to_parquet", "to_vtk"]

_ROWS = 65536
_VTK = (".vtu", ".vtk")
_UNFIT = re.compile(r"""[\s%"'<>&]+""")
"""What readers of VTK's forms take for the end of a name or for a code of another character."""


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
    path = file_path("path", path)
    dims = a_map(found)["status"].dims
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

    Values of several loads or orientations are arrays with their names: ``deflection[load=mill]``; spaces, quotes, ``%``, ``<``, ``>`` and
    ``&`` in names become ``_``. Written by meshio, which joins cells one by one; the ending of the path says how (``.vtu`` compressed,
    ``.vtk``). A ``.vtu`` holds the unit of each array (VTK's ``UNITS_LABEL``), and in a comment what it is. Points rise along all axes,
    also where the coordinates of the map fall.

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
    ImportError
        meshio is not installed (``pip install 'kinetostat[io]'``).

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
    path = file_path("path", path)
    ending = os.path.splitext(path)[1].lower()
    if ending not in _VTK:
        raise ArgumentError(f"path is {path!r}, expected an ending of {', '.join(_VTK)}")
    axes = grid_axes(a_map(found))
    points = _points(axes)
    kind, cells = _cells([len(axis) for axis in axes])
    parts = list(grid_values(found))
    data = {part.name: part.values.reshape(len(points), *part.values.shape[3:]) for part in parts}
    mesh = meshio.Mesh(points, [(kind, cells)], point_data=data)

    def write(beside: Path) -> None:
        meshio.write(beside, mesh)
        if ending == ".vtu":
            _with_units(beside, {part.name: part for part in parts})

    _whole(path, write)


def grid_axes(found: xarray.Dataset) -> list[Any]:
    """Coordinates along x, y and z, m, rising; one where a map has one place."""
    return [np.sort(np.atleast_1d(found[name].values)) for name in "xyz"]


@dataclasses.dataclass(frozen=True)
class Part:
    """A variable of one load and orientation on the grid."""

    name: str
    """Without spaces, each name once."""
    long_name: str
    unit: str
    values: Any
    """(x, y, z) or (x, y, z, columns), along rising coordinates."""


def grid_values(found: xarray.Dataset) -> Iterator[Part]:
    """Every variable, by loads and orientations."""
    along = [name for name in "xyz" if name in found["status"].dims]
    falls = [name for name in along if found[name].size > 1 and found[name].values[0] > found[name].values[-1]]
    rising = found.isel({name: slice(None, None, -1) for name in falls})
    counts = tuple(len(axis) for axis in grid_axes(found))
    taken: set[str] = set()
    for name, array in rising.data_vars.items():
        other: list[str] = [dim for dim in ("load", "orientation") if dim in array.dims]
        about, unit = str(array.attrs.get("long_name", name)), str(array.attrs.get("units", "1"))
        for label, part in _parts(array, other):
            values = part.transpose(*along, ...).values
            columns = (int(np.prod(values.shape[len(along) :])),) if values.ndim > len(along) else ()
            yield Part(_spelled(f"{name}{label}", taken), f"{about} {label}".strip(), unit, values.reshape(counts + columns))


def _spelled(name: str, taken: set[str]) -> str:
    """A name that all readers take, and that no other has."""
    plain = _UNFIT.sub("_", name)
    tries = (plain if k == 1 else f"{plain}_{k}" for k in itertools.count(1))
    found = next(each for each in tries if each not in taken)
    taken.add(found)
    return found


def _with_units(path: Path, parts: Mapping[str, Part]) -> None:
    """Adds to a file of VTK's XML the units of its arrays, as VTK keeps them, and what they are, as comments."""
    beside = path.with_name(f"{path.name}.part")
    try:
        with open(path, encoding="utf-8") as written, open(beside, "w", encoding="utf-8", newline="\n") as file:
            file.writelines(_lines_with_units(written, parts))
        os.replace(beside, path)
    finally:
        beside.unlink(missing_ok=True)


def _lines_with_units(lines: Iterable[str], parts: Mapping[str, Part]) -> Iterator[str]:
    from xml.sax.saxutils import escape

    within: Part | None = None
    for line in lines:
        if line.startswith("<UnstructuredGrid>"):
            # Two dashes end a comment.
            about = (f"{part.name}: {part.long_name}, {part.unit}".replace("--", "- -") for part in parts.values())
            yield from (f"<!-- {escape(each)} -->\n" for each in about)
        if line.startswith("<DataArray "):
            name = re.search(r' Name="([^"]*)"', line)
            within = parts.get(name[1]) if name else None
        if within is not None and line.startswith("</DataArray>"):
            yield f'<InformationKey name="UNITS_LABEL" location="vtkDataArray">{escape(within.unit)}</InformationKey>\n'
            within = None
        yield line


def _parts(array: Any, dims: list[str]) -> list[tuple[str, Any]]:
    """An array by loads and orientations, with what stands behind its name."""
    parts = [("", array)]
    for dim in dims:
        parts = [(f"{label}[{dim}={value}]", part.sel({dim: value})) for label, part in parts for value in array[dim].values]
    return parts


def _points(axes: list[Any]) -> Any:
    """(n, 3): all points of a grid, the last axis fastest."""
    points = np.empty((*map(len, axes), 3))
    for k, along in enumerate(np.meshgrid(*axes, indexing="ij", sparse=True)):
        points[..., k] = along
    return points.reshape(-1, 3)


def _cells(counts: list[int]) -> tuple[str, Any]:
    """Lines, quadrilaterals or hexahedra between the points of a grid, the last axis fastest."""
    index = np.arange(int(np.prod(counts))).reshape(counts)
    axes = [k for k in range(3) if counts[k] > 1]
    square: list[tuple[int, ...]] = [(0, 0), (1, 0), (1, 1), (0, 1)]
    cube = [(*corner, up) for up in (0, 1) for corner in square]
    shapes: list[list[tuple[int, ...]]] = [[()], [(0,), (1,)], square, cube]
    around = shapes[len(axes)]
    cells = np.empty((int(np.prod([counts[k] - 1 for k in axes])), len(around)), index.dtype)
    # Corner by corner: Ctrl-C waits for numpy.
    for column, corner in enumerate(around):
        cut = [slice(None)] * 3
        for k, far in zip(axes, corner, strict=True):
            cut[k] = slice(1, None) if far else slice(None, -1)
        cells[:, column] = index[tuple(cut)].reshape(-1)
    return ("vertex", "line", "quad", "hexahedron")[len(axes)], cells


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
