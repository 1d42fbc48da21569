"""Meshes from files and of simple shape, and functions that go with a mesh."""

from __future__ import annotations

import os
from typing import Any, Sequence, Union

from . import _ductile
from ._arrays import number
from ._build import field, warn
from ._ductile import InputError
from ._mesh import Mesh


def read(path: Union[str, os.PathLike[str]]) -> Mesh:
    """Reads a mesh of Gmsh, Medit, Mmg or VTK, whatever its name; see `Mesh.save` for the others.

    Fields in the file are in `fields` and `cell_fields`. What has no place in a `Mesh` is left out with
    an `InputWarning`. Raises `InputError`, naming file and line, for what is no mesh.
    """
    data, fields, lines = _ductile.read(os.fspath(path))
    warn(lines)
    mesh = Mesh._of(data)
    for name, on_cells, values in fields:
        (mesh.cell_fields if on_cells else mesh.fields)[name] = values
    return mesh


def read_field(path: Union[str, os.PathLike[str]]) -> Any:
    """Reads a .sol or .solb: the array at the vertices, or a list of them if there are several."""
    arrays, lines = _ductile.read_field(os.fspath(path))
    warn(lines)
    return arrays[0] if len(arrays) == 1 else arrays


def save_field(path: Union[str, os.PathLike[str]], mesh: Mesh, values: Any) -> None:
    """Writes values at the vertices of a mesh, such as a metric, as a .sol or .solb."""
    _, kind, _, rows = field("values", values, mesh._data, "vertices")
    _ductile.save_field(os.fspath(path), rows, kind, mesh.dim)


def box(extent: Sequence[float], cells: Sequence[int]) -> Mesh:
    """A rectangle or a box from the origin on, cut into cells and those into triangles or tetrahedra.

    References of facets: 1 and 2 at the ends of x, 3 and 4 at those of y, 5 and 6 at those of z.

    Examples
    --------
    >>> mesh = ductile.box((1, 1, 1), (10, 10, 10))
    """
    if len(extent) not in (2, 3) or len(cells) != len(extent):
        raise InputError(f"box: expected 2 or 3 extents and as many numbers of cells, found "
                         f"{len(extent)} and {len(cells)}")
    return Mesh._of(_ductile.box([number(x, "extent") for x in extent], [int(n) for n in cells]))


def transfer(before: Mesh, u: Any, after: Mesh, **options: Any) -> Any:
    """Values on one mesh, on another; see `Mesh.transfer`."""
    return after.transfer(u, source=before, **options)
