"""Long computations in chunks: on any executor, written as they come, resumed where they stopped, provably complete.

A sweep is a pure function of a range of rows. Its rows are cut into chunks; every chunk can be computed anywhere, at any time and again,
and gives the same bits. Workers come from any :class:`concurrent.futures.Executor`: a process pool, ``Client.get_executor()`` of Dask,
``mpi4py.futures.MPIPoolExecutor``, :class:`RayExecutor`.

:func:`run` gives arrays in memory. :func:`to_folder` writes a Parquet dataset with a manifest: ``folder/chunks/*.parquet`` (read it with
pyarrow, polars, pandas, DuckDB) and ``folder/manifest.json``. It goes on where an earlier run stopped; :func:`verify` proves what is there.
"""

from kinetostat.sweep._folder import Verified, chunks, read, verify
from kinetostat.sweep._ray import RayExecutor
from kinetostat.sweep._run import Done, run, to_folder
from kinetostat.sweep._workers import SweepError

__all__ = ["Done", "RayExecutor", "SweepError", "Verified", "chunks", "read", "run", "to_folder", "verify"]
