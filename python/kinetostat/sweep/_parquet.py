"""One chunk as one Parquet file."""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from kinetostat.sweep._identity import Columns


def library() -> tuple[Any, Any]:
    """The modules pyarrow and pyarrow.parquet."""
    try:
        import pyarrow
        import pyarrow.parquet
    except ImportError as absent:
        raise ImportError("a sweep in a folder needs pyarrow: pip install 'kinetostat[sweep]'") from absent
    return pyarrow, pyarrow.parquet


def table(columns: Columns, notes: Mapping[str, str] | None = None) -> Any:
    """Arrays as a table: a row of an array of several axes becomes a list of fixed length, in C order."""
    arrow, _ = library()
    arrays, fields = [], []
    for name, array in columns.items():
        width = int(np.prod(array.shape[1:], dtype=np.int64))
        if array.ndim > 1 and width == 0:
            continue  # no numbers, and Arrow has no lists of none
        flat = arrow.array(array.reshape(-1))
        if array.ndim > 1:
            flat = arrow.FixedSizeListArray.from_arrays(flat, width)
        about = {"unit": notes[name]} if notes and name in notes else None
        arrays.append(flat)
        fields.append(arrow.field(name, flat.type, nullable=False, metadata=about))
    return arrow.Table.from_arrays(arrays, schema=arrow.schema(fields))


def write(path: Path, columns: Columns, notes: Mapping[str, str] | None = None) -> None:
    """Writes a file; the same columns give the same bytes with the same pyarrow."""
    _, parquet = library()
    # No dictionary: it would make one of all NaN, and what comes back has to be what was written, bit for bit.
    parquet.write_table(table(columns, notes), path, compression="zstd", use_dictionary=False, store_schema=True)


def read(path: Path, fields: list[dict[str, Any]], stored: list[str]) -> Columns:
    """Columns of a file; KeyError or ValueError where it is not as ``stored`` and ``fields`` say."""
    _, parquet = library()
    with parquet.ParquetFile(path) as file:
        if file.schema_arrow.names != stored:
            raise ValueError(f"columns {file.schema_arrow.names}, expected {stored}")
        found = file.read(columns=[field["name"] for field in fields])
        rows = file.metadata.num_rows
    columns: Columns = {}
    for field in fields:
        if 0 in field["shape"]:
            columns[field["name"]] = np.empty((rows, *field["shape"]), field["dtype"])
            continue
        column = found.column(field["name"]).combine_chunks()
        if field["shape"]:
            if not hasattr(column.type, "list_size"):
                raise ValueError(f"{field['name']!r} of single numbers, expected shape {field['shape']}")
            column = column.flatten()
        flat = column.to_numpy(zero_copy_only=False)
        if flat.dtype != field["dtype"]:
            raise ValueError(f"{field['name']!r} of {flat.dtype}, expected {field['dtype']}")
        columns[field["name"]] = flat.reshape(rows, *field["shape"])
    return columns


def digest(path: Path) -> str:
    """SHA-256 of a file."""
    found = hashlib.sha256()
    with open(path, "rb") as file:
        while block := file.read(1 << 20):
            found.update(block)
    return found.hexdigest()
