"""Whether a manifest is whole: what a damaged one says is an error of that file, not one of Python somewhere behind it."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import numpy as np

from kinetostat.errors import ArgumentError

__all__ = ["damaged", "sound_structure"]


def damaged(file: Path, why: str) -> ArgumentError:
    """The error of a damaged manifest."""
    return ArgumentError(f"{file} is a damaged manifest of a sweep: {why}; put the right one back, or remove the folder")


def sound_structure(file: Path, found: dict[str, Any]) -> dict[str, Any]:
    """The manifest, if every value of it is of the kind that is written there."""
    for name, least in (("count", 0), ("chunk", 1)):
        value = found[name]
        if not isinstance(value, int) or isinstance(value, bool) or value < least:
            raise damaged(file, f"{name} is {value!r}, expected a whole number, {least} or more")
    for name, kind, what in (
        ("version", str, "text"),
        ("function", str, "text"),
        ("settings", dict, "a dictionary"),
        ("complete", bool, "true or false"),
        ("chunks", dict, "a dictionary of SHA-256 by chunk"),
    ):
        if not isinstance(found[name], kind):
            raise damaged(file, f"{name} is {found[name]!r}, expected {what}")
    for key, digest in found["chunks"].items():
        if not re.fullmatch(r"-?(0|[1-9][0-9]*)", key, re.ASCII):
            raise damaged(file, f"chunks has {key!r}, expected the number of a chunk")
        if not isinstance(digest, str) or not re.fullmatch("[0-9a-f]{64}", digest):
            raise damaged(file, f"chunks[{key!r}] is {digest!r}, expected a SHA-256")
    schema = found["schema"]
    if schema is None:
        if found["chunks"]:
            raise damaged(file, "schema is null although there are chunks")
        return found
    if not isinstance(schema, list) or not all(map(_is_field, schema)):
        raise damaged(file, f"schema is {schema!r}, expected a list of name, dtype and shape")
    if len({field["name"] for field in schema}) < len(schema):
        raise damaged(file, "schema has a name twice")
    return found


def _is_field(field: Any) -> bool:
    if not isinstance(field, dict) or not {"name", "dtype", "shape"} <= set(field):
        return False
    if not isinstance(field["name"], str) or not isinstance(field["dtype"], str) or not isinstance(field["shape"], list):
        return False
    try:
        kind = np.dtype(field["dtype"]).kind
    except (TypeError, ValueError, SyntaxError):
        return False
    return kind in "fiub" and all(type(length) is int and length >= 0 for length in field["shape"])
