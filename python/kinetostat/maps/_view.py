"""Maps as objects of PyVista."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from kinetostat.maps._table import grid_axes, grid_values
from kinetostat.maps._variables import a_map
from kinetostat.view import library

if TYPE_CHECKING:
    import xarray

__all__ = ["to_pyvista"]


def to_pyvista(found: xarray.Dataset) -> Any:
    """A map as a grid of PyVista: isosurfaces, slices and volumes of a workspace, beside the machine itself.

    Parameters
    ----------
    found : xarray.Dataset
        A map along one to three of x, y and z.

    Returns
    -------
    pyvista.RectilinearGrid
        In m, base axes; variables are point data in SI units, several columns as (n, columns); of several loads or orientations by
        their names, ``deflection[load=mill]``, with ``_`` for spaces. Points rise along all axes. Units stand in the field data
        ``units``. Places without an answer are NaN.

    Raises
    ------
    ImportError
        PyVista is not installed.

    Examples
    --------
    >>> import numpy as np
    >>> import kinetostat as ks
    >>> x = np.linspace(-0.05, 0.05, 3)
    >>> grid = to_pyvista(ks.Machine.preset("orthoglide").map(x=x, y=x, z=x))
    >>> grid.dimensions, grid.point_data["stiffness_softest"].shape
    ((3, 3, 3), (27,))
    """
    grid = library().RectilinearGrid(*(np.array(axis, dtype=float) for axis in grid_axes(a_map(found))))
    for part in grid_values(found):
        values = part.values
        # Points of PyVista run along x first.
        turned = np.ascontiguousarray(values.transpose(2, 1, 0, *range(3, values.ndim)))
        grid.point_data[part.name] = turned.reshape(grid.n_points, *values.shape[3:])
    units = [f"{name}: {array.attrs['units']}" for name, array in found.data_vars.items() if "units" in array.attrs]
    grid.field_data["units"] = units or ["none"]
    return grid
