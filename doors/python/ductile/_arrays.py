"""Arguments as the C++ library reads them: contiguous arrays of its types, copied only if they are of
another layout, and refused by array and index if they are wrong."""

from __future__ import annotations

import os
import re
from contextlib import contextmanager
from typing import Any, Iterator, Mapping, Sequence

import numpy as np

from ._ductile import Executor, FieldType, InputError

Array = np.ndarray


def converted(values: Any, name: str) -> Array:
    """The values as an array of whatever type."""
    try:
        return np.asarray(values)
    except (ValueError, TypeError, OverflowError) as error:
        reason = " ".join(str(error).split())
        raise InputError(f"{name}: expected an array of numbers, found {reason}") from None


def floats(values: Any, name: str) -> Array:
    """The values as float64, in C order; the same array if it is that."""
    array = converted(values, name)
    if array.dtype.kind not in "fiub":
        raise InputError(f"{name}: expected an array of real numbers, found one of {array.dtype}")
    return np.asarray(array, dtype=np.float64, order="C")


def finite(array: Array, name: str) -> Array:
    """The array, in which every number is finite."""
    fine = np.isfinite(array)
    if not fine.all():
        at = np.unravel_index(int(np.argmin(fine)), array.shape)
        index = ", ".join(str(int(i)) for i in at)
        raise InputError(f"{name}[{index}]: expected a finite number, found {array[at]}")
    return array


def indices(values: Any, name: str, columns: int, count: int) -> Array:
    """Indices of entities, of which there are `count`, in rows; int32 and int64 stay as they are."""
    array = converted(values, name)
    if array.size == 0:
        return np.zeros((0, columns), np.int32)
    if array.dtype.kind not in "iu":
        raise InputError(f"{name}: expected whole numbers, found {array.dtype}")
    if array.ndim != 2 or array.shape[1] != columns:
        raise InputError(f"{name}: expected shape (n, {columns}), found {array.shape}")
    low, high = array.min(), array.max()
    if low < 0 or high >= count:
        row, column = np.unravel_index(int(np.argmax((array < 0) | (array >= count))), array.shape)
        raise InputError(f"{name}[{row}, {column}]: expected a vertex from 0 to {count - 1}, found "
                         f"{array[row, column]}")
    kept = array.dtype if array.dtype in (np.int32, np.int64) else np.int64
    return np.ascontiguousarray(array, dtype=kept)


def references(values: Any, name: str, count: int) -> Array:
    """One int32 for each of `count` entities, or none for any if they are not given."""
    if values is None:
        return np.zeros(0, np.int32)
    array = converted(values, name)
    if array.shape != (count,):
        raise InputError(f"{name}: expected shape ({count},), found {array.shape}")
    if array.dtype.kind not in "biuf":
        raise InputError(f"{name}: expected whole numbers, found {array.dtype}")
    with np.errstate(invalid="ignore"):
        whole = array.astype(np.int32)
    wrong = whole != array
    if wrong.any():
        at = int(np.argmax(wrong))
        raise InputError(f"{name}[{at}]: expected a whole number of 32 bits, found {array[at]}")
    return np.ascontiguousarray(whole)


def chosen(values: Any, name: str, count: int) -> Array:
    """Indices of entities, as int32, that are given as such or by an array of booleans."""
    array = converted(values, name)
    if array.dtype == bool:
        if array.shape != (count,):
            raise InputError(f"{name}: expected shape ({count},), found {array.shape}")
        return np.flatnonzero(array).astype(np.int32)
    if array.size == 0:
        return np.zeros(0, np.int32)
    if array.dtype.kind not in "iu" or array.ndim != 1:
        raise InputError(f"{name}: expected indices or booleans in one dimension, found "
                         f"{array.dtype} of shape {array.shape}")
    wrong = (array < 0) | (array >= count)
    if wrong.any():
        at = int(np.argmax(wrong))
        raise InputError(f"{name}[{at}]: expected an index from 0 to {count - 1}, found {array[at]}")
    return np.ascontiguousarray(array, dtype=np.int32)


def point(values: Any, name: str) -> list[float]:
    """A point in the plane or in space, as three coordinates."""
    array = finite(floats(values, name), name)
    if array.shape not in ((2,), (3,)):
        raise InputError(f"{name}: expected 2 or 3 coordinates, found shape {array.shape}")
    return [*map(float, array), 0.0][:3]


def points(values: Any, name: str) -> Array:
    """Points in the plane or in space, with three coordinates each."""
    array = finite(floats(values, name), name)
    if array.ndim != 2 or array.shape[1] not in (2, 3) or len(array) == 0:
        raise InputError(f"{name}: expected shape (n, 2) or (n, 3), found {array.shape}")
    if array.shape[1] == 3:
        return array
    return np.column_stack([array, np.zeros(len(array))])


def shown(value: Any) -> str:
    """A value in a message: on one line, and short."""
    words = " ".join(repr(value).split())
    return words if len(words) <= 80 else words[:77] + "..."


def number(value: Any, name: str) -> float:
    """A float; what is None or no number is refused."""
    try:
        if isinstance(value, (str, bytes)) or np.ndim(value) != 0:
            raise TypeError
        return float(value)
    except (TypeError, ValueError, OverflowError):
        raise InputError(f"{name}: expected a number, found {shown(value)}") from None


def whole(value: Any, name: str, least: int, most: int) -> int:
    """An int within bounds."""
    if isinstance(value, (int, np.integer)) and not isinstance(value, bool) and least <= value <= most:
        return int(value)
    raise InputError(f"{name}: expected a whole number from {least} to {most}, found {shown(value)}")


def flag(value: Any, name: str) -> bool:
    """True or False."""
    if isinstance(value, (bool, np.bool_)) or (isinstance(value, int) and value in (0, 1)):
        return bool(value)
    raise InputError(f"{name}: expected True or False, found {shown(value)}")


def text(value: Any, name: str) -> str:
    """A text that C++ can have: without control characters, and in UTF-8."""
    if not isinstance(value, str):
        raise InputError(f"{name}: expected a text, found {shown(value)}")
    if any(ord(letter) < 32 or ord(letter) == 127 or 0xD800 <= ord(letter) < 0xE000
           for letter in value):
        raise InputError(f"{name}: expected a text without control characters, found {shown(value)}")
    return value


def path_text(path: Any, name: str = "path") -> bytes:
    """The name of a file, for C++."""
    try:
        encoded = os.fsencode(path)
        encoded.decode("utf-8")
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected the name of a file, found {shown(path)}") from None
    if b"\0" in encoded or not encoded:
        raise InputError(f"{name}: expected the name of a file, found {shown(path)}")
    return encoded


def mapping(values: Any, name: str) -> Mapping[str, Any]:
    """A dict, or what is like one, with texts for keys."""
    if not isinstance(values, Mapping):
        raise InputError(f"{name}: expected a dict, found {shown(values)}")
    for key in values:
        text(key, f"{name}: a key")
    return values


def executor(threads: Any) -> Executor:
    """What runs the work: so many threads, 0 for as many as there are cores."""
    return Executor(whole(threads, "threads", 0, 4096))


def megabytes(value: Any) -> int:
    """The bytes of a limit on memory."""
    limit = number(value, "memory")
    if not 0 <= limit <= 2**30:
        raise InputError(f"memory: expected megabytes from 0 to {2**30}, found {shown(value)}")
    return int(limit) << 20


def field_type(components: int, dimension: int) -> FieldType | None:
    """The type of field with so many components; None if there is none."""
    return {1: FieldType.scalar, dimension: FieldType.vector,
            dimension * (dimension + 1) // 2: FieldType.symmetric,
            dimension * dimension: FieldType.matrix}.get(components)


_CELLS = {2: "triangles", 3: "tetrahedra"}
_FACETS = {2: "edges", 3: "triangles"}
_OPTIONS = {"gradation": "hgrad", "required_gradation": "hgradreq", "smallest_size": "hmin",
            "largest_size": "hmax", "hausdorff_tolerance": "hausd", "ridge_angle": "ar"}


@contextmanager
def named(dimension: int) -> Iterator[None]:
    """What C++ says is wrong is raised by the names that arrays and options have here."""
    try:
        yield
    except InputError as error:
        cells, facets = _CELLS[dimension], _FACETS[dimension]
        names = {f"{cells}.vertices": "cells", f"{cells}.reference": "refs",
                 f"{facets}.vertices": "facets", f"{facets}.reference": "facet_refs",
                 "edges.vertices": "edges", "edges.reference": "edge_refs"}
        text = str(error)
        for theirs, ours in names.items():
            text = text.replace(f"mesh: {theirs}[", f"{ours}[").replace(theirs, ours)
        text = re.sub(r"^bounds on sizes:", "hmin and hmax:", text)
        text = re.sub(r"^(options?[. ])?(\w+)(?=[:,])",
                      lambda match: _OPTIONS.get(match[2], match[0]), text)
        raise InputError(text) from None


def component_count(shape: Sequence[int]) -> int:
    """Of one entity of a field, of any shape."""
    return int(np.prod(shape[1:], dtype=int))
