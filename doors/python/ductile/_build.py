"""From arguments to what the C++ library takes: meshes, options, fields."""

from __future__ import annotations

import warnings
from typing import Any, Mapping, Optional, Sequence

import numpy as np

from . import _ductile
from ._arrays import (chosen, component_count, converted, field_type, finite, floats, indices,
                      references, shown, text)
from ._ductile import FieldType, InputError

KINDS = ("vertices", "facets", "cells", "edges", "ridges", "corners")


class InputWarning(UserWarning):
    """What a file has and a mesh has no place for, or looks doubtful."""


def mesh_data(mesh: Any, name: str) -> _ductile.MeshData:
    """What C++ has of a `Mesh`."""
    data = getattr(mesh, "_data", None)
    if not isinstance(data, _ductile.MeshData):
        raise InputError(f"{name}: expected a ductile.Mesh, found {shown(mesh)}")
    return data


def warn(lines: Sequence[str]) -> None:
    """Warns the caller of the caller, once for each line."""
    for line in lines:
        warnings.warn(line, InputWarning, stacklevel=3)


def _flat(points: np.ndarray, cells: np.ndarray) -> np.ndarray:
    """Points of triangles in a plane of constant z without their z."""
    if points.ndim != 2 or points.shape[1] not in (2, 3):
        raise InputError(f"points: expected shape (n, 2) or (n, 3), found {points.shape}")
    if points.shape[1] == 3 and cells.shape[1:] == (3,):
        if len(points) and np.ptp(points[:, 2]) > 1e-6 * np.ptp(points[:, :2]):
            return points  # a surface
        return np.ascontiguousarray(points[:, :2])
    return points


def data_of(state: Mapping[str, Any]) -> _ductile.MeshData:
    """A mesh of arrays by the names of `Mesh`'s parameters, and what else pickles hold."""
    cells = converted(state["cells"], "cells")
    points = finite(_flat(floats(state["points"], "points"), cells), "points")
    count, dim = points.shape
    corners = 3 if cells.shape[1:] == (3,) else dim + 1
    cells = indices(cells, "cells", corners, count)
    facets = state["facets"]
    facets = indices(() if facets is None else facets, "facets", corners - 1, count)
    data = _ductile.from_arrays(
        points, references(state["vertex_refs"], "vertex_refs", count),
        (cells, references(state["refs"], "refs", len(cells))),
        (facets, references(state["facet_refs"], "facet_refs", len(facets))))
    edges = state.get("edges")
    if corners == 4 and edges is not None and np.size(converted(edges, "edges")):
        edges = indices(edges, "edges", 2, count).astype(np.int32)
        refs = state.get("edge_refs")
        data.set_edges(edges, references(np.zeros(len(edges), np.int32) if refs is None else refs,
                                         "edge_refs", len(edges)))
    for kind, entities in state.get("required", {}).items():
        if corners == 4 or kind != "edges":
            data.require(kind, entities)
    data.names = _names_of(state["names"])
    return data


def _names_of(names: Any) -> list[tuple[str, int, int]]:
    """Names of references as C++ has them: name, dimension, reference."""
    try:
        pairs = list(names.items()) if isinstance(names, Mapping) else \
            [(name, where) for name, *where in names]
    except (TypeError, ValueError):
        raise InputError(f"names: expected a dict, or rows of a name, a dimension and a reference, "
                         f"found {shown(names)}") from None
    for name, where in pairs:
        text(name, "names")
        array = converted(where, f"names[{name!r}]")
        if not (array.shape == (2,) and array.dtype.kind in "iu"
                and 0 <= array[0] <= 3 and -2**31 <= array[1] < 2**31):
            raise InputError(f"names[{name!r}]: expected a dimension from 0 to 3 and a reference of "
                             f"32 bits, found {shown(where)}")
    return [(name, int(where[0]), int(where[1])) for name, where in pairs]


def with_required(data: _ductile.MeshData, **given: Any) -> _ductile.MeshData:
    """The mesh with more required entities; itself if there are none."""
    asked = {kind: entities for kind, entities in given.items() if entities is not None}
    if not asked:
        return data
    data = data.copy()
    counts = {"vertices": len(data.points), "facets": len(data.facets), "cells": len(data.cells)}
    for kind, entities in asked.items():
        more = chosen(entities, f"required_{kind}", counts[kind])
        data.require(kind, np.union1d(data.required(kind), more).astype(np.int32))
    return data


def options_of(**values: Any) -> _ductile.Options:
    options = _ductile.Options()
    for name, value in values.items():
        try:
            setattr(options, name, value)
        except TypeError:
            raise InputError(f"remesh: expected a number for {name}, found {shown(value)}") from None
    return options


def place_of(array: np.ndarray, data: _ductile.MeshData, on: Optional[str],
             name: str = "u") -> str:
    counts = {"vertices": len(data.points), "cells": len(data.cells)}
    if on is not None and not (isinstance(on, str) and on in counts):
        raise InputError(f"on: expected 'vertices' or 'cells', found {shown(on)}")
    length = len(array) if array.ndim > 0 else -1
    places = [place for place, count in counts.items() if count == length and on in (None, place)]
    if len(places) == 1:
        return places[0]
    if places:
        raise InputError(f"{name}: there are as many vertices as cells: say on='vertices' or on='cells'")
    expected = f"{counts[on]} {on}" if on is not None else \
        f"{counts['vertices']} vertices or {counts['cells']} cells"
    raise InputError(f"{name}: expected a row for each of {expected}, found shape {array.shape}")


def field(name: str, values: Any, data: _ductile.MeshData,
          on: Optional[str]) -> tuple[str, FieldType, bool, np.ndarray]:
    """A field as files have it."""
    text(name, "fields: a name")
    array = floats(values, name)
    place = place_of(array, data, on, name)
    columns = component_count(array.shape)
    kind = field_type(columns, data.dimension)
    if kind is None:
        raise InputError(f"{name}: expected 1 component, a vector, a symmetric tensor or a matrix, "
                         f"found {columns} components")
    return name, kind, place == "cells", array.reshape(len(array), columns)
