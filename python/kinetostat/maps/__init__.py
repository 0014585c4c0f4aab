"""Maps: what a machine is like at every place of its workspace, as Datasets of xarray, NetCDF, Parquet, VTK and pictures."""

from kinetostat.maps._map import evaluate
from kinetostat.maps._plot import best_and_worst, plot
from kinetostat.maps._table import to_parquet, to_vtk
from kinetostat.maps._variables import Variable, variables
from kinetostat.maps._view import to_pyvista

__all__ = ["Variable", "best_and_worst", "evaluate", "plot", "to_parquet", "to_pyvista", "to_vtk", "variables"]
