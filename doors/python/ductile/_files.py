"""Meshes from files and of simple shape, and functions that go with a mesh."""

from __future__ import annotations

import os
from typing import Any, Sequence, Union

from . import _ductile
from ._arrays import converted, number, path_text, shown, whole
from ._build import field, mesh_data, warn
from ._ductile import InputError
from ._mesh import Mesh


def read(path: Union[str, os.PathLike[str]]) -> Mesh:
    """Reads a mesh of Gmsh, Medit, Mmg or VTK, whatever its name; see `Mesh.save` for the others.

    Fields in the file are in `fields` and `cell_fields`. What has no place in a `Mesh` is left out with
    an `InputWarning`. Raises `InputError`, naming file and line, for what is no mesh.
    """
    data, fields, lines = _ductile.read(path_text(path))
    warn(lines)
    mesh = Mesh._of(data)
    for name, on_cells, values in fields:
        (mesh.cell_fields if on_cells else mesh.fields)[name] = values
    return mesh


def read_field(path: Union[str, os.PathLike[str]]) -> Any:
    """Reads a .sol or .solb: the array at the vertices, or a list of them if there are several."""
    arrays, lines = _ductile.read_field(path_text(path))
    warn(lines)
    return arrays[0] if len(arrays) == 1 else arrays


def save_field(path: Union[str, os.PathLike[str]], mesh: Mesh, values: Any) -> None:
    """Writes values at the vertices of a mesh, such as a metric, as a .sol or .solb."""
    _, kind, _, rows = field("values", values, mesh_data(mesh, "mesh"), "vertices")
    _ductile.save_field(path_text(path), rows, kind, mesh.dim)


def box(extent: Sequence[float], cells: Sequence[int]) -> Mesh:
    """A rectangle or a box from the origin on, cut into cells and those into triangles or tetrahedra.

    References of facets: 1 and 2 at the ends of x, 3 and 4 at those of y, 5 and 6 at those of z.

    Examples
    --------
    >>> mesh = ductile.box((1, 1, 1), (10, 10, 10))
    """
    sides = [number(x, "extent") for x in _listed(extent, "extent")]
    counts = [whole(n, "cells", 1, 2**31 - 1) for n in _listed(cells, "cells")]
    if len(sides) not in (2, 3) or len(counts) != len(sides):
        raise InputError(f"box: expected 2 or 3 extents and as many numbers of cells, found "
                         f"{len(sides)} and {len(counts)}")
    return Mesh._of(_ductile.box(sides, counts))


def _listed(values: Any, name: str) -> list[Any]:
    array = converted(values, name)
    if array.ndim != 1:
        raise InputError(f"{name}: expected 2 or 3 numbers, found {shown(values)}")
    return list(array)


def transfer(before: Mesh, u: Any, after: Mesh, **options: Any) -> Any:
    """Values on one mesh, on another; see `Mesh.transfer`."""
    mesh_data(after, "after")
    mesh_data(before, "before")
    return after.transfer(u, source=before, **options)
