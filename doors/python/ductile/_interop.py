"""To and from meshio, VTK and PETSc. Each is imported when it is asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Mapping, Optional

import numpy as np

from ._arrays import component_count, converted, mapping, shown
from ._build import place_of
from ._ductile import InputError
from ._metric import full

if TYPE_CHECKING:
    from ._mesh import Mesh

_REFERENCES = ("gmsh:physical", "medit:ref", "ref", "region", "boundary", "cell_tags")
_VERTEX, _LINE, _TRIANGLE, _TETRAHEDRON = 1, 3, 5, 10  # VTK's types of cells


def _apart(mesh: Mesh, fields: Optional[Mapping[str, Any]]) -> tuple[dict, dict]:
    """Fields at vertices and on cells; by default those of the mesh."""
    if fields is None:
        return dict(mesh.fields), dict(mesh.cell_fields)
    at: tuple[dict, dict] = ({}, {})
    for name, values in mapping(fields, "fields").items():
        array = converted(values, name)
        at[place_of(array, mesh._data, None, name) == "cells"][name] = array
    return at


# ---- meshio ----

def to_meshio(mesh: Mesh, fields: Optional[Mapping[str, Any]]) -> dict[str, Any]:
    cell, facet = ("triangle", "line") if mesh.dim == 2 else ("tetra", "triangle")
    cells = [(cell, mesh.cells), (facet, mesh.facets)]
    refs = [mesh.refs, mesh.facet_refs]
    if mesh.dim == 3 and len(mesh.edges):
        cells.append(("line", mesh.edges))
        refs.append(mesh.edge_refs)
    at_points, on_cells = _apart(mesh, fields)
    at_points = {name: _as_written(np.asarray(values), mesh.dim) for name, values in at_points.items()}
    cell_data: dict[str, list[np.ndarray]] = {"gmsh:physical": refs, "gmsh:geometrical": refs}
    for name, values in on_cells.items():
        array = _as_written(np.asarray(values, float), mesh.dim)
        cell_data[name] = [array] + [np.full((len(c), *array.shape[1:]), np.nan)
                                     for _, c in cells[1:]]
    return {"points": mesh.points, "cells": cells, "point_data": at_points, "cell_data": cell_data,
            "field_data": {name: np.array([ref, dim]) for name, dim, ref in mesh.names}}


def _as_written(values: np.ndarray, dim: int) -> np.ndarray:
    """Values with 1, 3 or 9 components, which all formats hold: as they are, or in space."""
    count = component_count(values.shape)
    if values.ndim < 2 or count in (1, 3, 9):
        return values.reshape(len(values), -1) if values.ndim > 2 else values
    rows = values.reshape(len(values), count)
    if count == 2:
        return np.column_stack([rows, np.zeros(len(rows))])
    if count == 4 and dim == 2:
        wide = np.zeros((len(rows), 3, 3))
        wide[:, :2, :2] = rows.reshape(-1, 2, 2)
        return wide.reshape(-1, 9)
    return full(rows).reshape(-1, 9) if count == 6 else values


def from_meshio(m: Any) -> Mesh:
    """A mesh of meshio's: its triangles or tetrahedra, and what lies on their boundary.

    References are taken from "gmsh:physical", "medit:ref" and the like, names from field_data, fields
    from point_data and, of cells, cell_data. Other cells raise `InputError`.
    """
    from ._mesh import Mesh
    if not (hasattr(m, "cells") and hasattr(m, "cell_data")):
        raise InputError(f"m: expected a meshio.Mesh, found {shown(m)}")
    blocks: dict[str, list[int]] = {}
    for i, block in enumerate(m.cells):
        blocks.setdefault(block.type, []).append(i)
    cell = "tetra" if "tetra" in blocks else "triangle"
    facet, edge = ("triangle", "line") if cell == "tetra" else ("line", None)
    for kind in blocks:
        if kind not in ("vertex", "line", "triangle", "tetra"):
            raise InputError(f"cells[{blocks[kind][0]}]: expected triangles, tetrahedra, lines or "
                             f"vertices, found {kind}")
    if cell not in blocks:
        raise InputError("cells: expected triangles or tetrahedra, found none")
    refs_key = next((key for key in _REFERENCES if key in m.cell_data), None)

    def all_of(kind: Optional[str]) -> tuple[Optional[np.ndarray], Optional[np.ndarray]]:
        if kind not in blocks:
            return None, None
        corners = np.concatenate([m.cells[i].data for i in blocks[kind]])
        refs = None if refs_key is None else \
            np.concatenate([m.cell_data[refs_key][i] for i in blocks[kind]]).astype(np.int32)
        return corners, refs

    cells, refs = all_of(cell)
    facets, facet_refs = all_of(facet)
    edges, edge_refs = all_of(edge)
    names = [(name, int(where[1]), int(where[0])) for name, where in m.field_data.items()
             if np.shape(where) == (2,)]
    mesh = Mesh(m.points, cells, refs=refs, facets=facets, facet_refs=facet_refs, names=names)
    if edges is not None:
        mesh = mesh.replace(edges=edges, edge_refs=edge_refs)
    mesh.fields = {name: np.asarray(values) for name, values in m.point_data.items()}
    mesh.cell_fields = {name: np.concatenate([values[i] for i in blocks[cell]])
                        for name, values in m.cell_data.items() if name not in _REFERENCES
                        and name != "gmsh:geometrical"}
    return mesh


# ---- VTK ----

def to_vtk(mesh: Mesh, fields: Optional[Mapping[str, Any]], boundary: bool) -> Any:
    try:
        from vtkmodules.util.numpy_support import numpy_to_vtk
        from vtkmodules.vtkCommonCore import vtkPoints
        from vtkmodules.vtkCommonDataModel import vtkCellArray, vtkUnstructuredGrid
    except ImportError as error:
        raise ImportError("to_vtk needs the Python module of VTK: install vtk, or python3-vtk9 on "
                          "Debian") from error
    grid = vtkUnstructuredGrid()
    points = vtkPoints()
    spatial = mesh.points if mesh.dim == 3 else \
        np.column_stack([mesh.points, np.zeros(len(mesh.points))])
    points.SetData(numpy_to_vtk(spatial))
    grid.SetPoints(points)
    kinds = [(_TRIANGLE if mesh.dim == 2 else _TETRAHEDRON, mesh.cells)]
    if boundary:
        kinds.append((_LINE if mesh.dim == 2 else _TRIANGLE, mesh.facets))
    types = np.concatenate([np.full(len(c), kind, np.uint8) for kind, c in kinds])
    corners = np.concatenate([np.full(len(c), c.shape[1], np.int32) for _, c in kinds])
    offsets = np.concatenate([[0], np.cumsum(corners)]).astype(np.int32)
    connectivity = mesh.cells.ravel() if not boundary else \
        np.concatenate([c.ravel() for _, c in kinds])
    cells = vtkCellArray()
    cells.SetData(numpy_to_vtk(offsets, deep=True), numpy_to_vtk(connectivity))
    # The cells hold arrays of their own, which share that memory and have to keep it alive.
    cells.GetConnectivityArray()._numpy_reference = connectivity
    grid.SetCells(numpy_to_vtk(types, deep=True), cells)
    at_points, on_cells = _apart(mesh, fields)
    rest = len(types) - len(mesh.cells)
    zeros, before = np.zeros(rest, np.int32), np.zeros(len(mesh.cells), np.int32)
    arrays = {"region": np.concatenate([mesh.refs, zeros])}
    if boundary:
        arrays["boundary"] = np.concatenate([before, mesh.facet_refs])
    for name, values in on_cells.items():
        array = np.asarray(values, float).reshape(len(mesh.cells), -1)
        arrays[name] = np.concatenate([array, np.full((rest, array.shape[1]), np.nan)])
    for data, named in ((grid.GetPointData(), at_points), (grid.GetCellData(), arrays)):
        for name, values in named.items():
            added = numpy_to_vtk(np.ascontiguousarray(np.reshape(values, (len(values), -1))))
            added.SetName(name)
            data.AddArray(added)
    return grid


def from_vtk(data: Any) -> Mesh:
    """A mesh of a ``vtkUnstructuredGrid`` or ``vtkPolyData``, such as pyvista's.

    Its tetrahedra, or otherwise triangles in a plane of constant z, and what lies on their boundary.
    References are taken from "region" and "boundary", fields from the point data and, of cells, the cell
    data. Other cells raise `InputError`.
    """
    from vtkmodules.util.numpy_support import vtk_to_numpy

    from ._mesh import Mesh
    if not hasattr(data, "GetPoints") or data.GetPoints() is None:
        raise InputError(f"data: expected a grid of VTK with points, found {shown(data)}")
    points = vtk_to_numpy(data.GetPoints().GetData()).astype(float)
    arrays = data.GetPolys() if hasattr(data, "GetPolys") else data.GetCells()
    offsets = vtk_to_numpy(arrays.GetOffsetsArray())
    corners = vtk_to_numpy(arrays.GetConnectivityArray())
    types = np.where(np.diff(offsets) == 3, _TRIANGLE, -1) if hasattr(data, "GetPolys") else \
        vtk_to_numpy(data.GetCellTypesArray())
    wrong = ~np.isin(types, (_VERTEX, _LINE, _TRIANGLE, _TETRAHEDRON))
    if wrong.any():
        at = int(np.argmax(wrong))
        raise InputError(f"cell {at}: expected triangles, tetrahedra, lines or vertices, found type "
                         f"{types[at]}")
    cell, facet = (_TETRAHEDRON, _TRIANGLE) if (types == _TETRAHEDRON).any() else (_TRIANGLE, _LINE)

    def of(source: Any) -> dict[str, np.ndarray]:
        named = (source.GetArray(i) for i in range(source.GetNumberOfArrays()))
        return {array.GetName(): vtk_to_numpy(array) for array in named if array is not None}

    def corners_of(kind: int) -> np.ndarray:
        count = {_LINE: 2, _TRIANGLE: 3, _TETRAHEDRON: 4}[kind]
        return corners[offsets[:-1][types == kind][:, None] + np.arange(count)]

    on_cells = {name: values for name, values in of(data.GetCellData()).items()
                if len(values) == len(types)}
    refs, facet_refs = on_cells.pop("region", None), on_cells.pop("boundary", None)
    mesh = Mesh(points, corners_of(cell), facets=corners_of(facet),
                refs=None if refs is None else refs[types == cell],
                facet_refs=None if facet_refs is None else facet_refs[types == facet])
    mesh.fields = {name: values.copy() for name, values in of(data.GetPointData()).items()}
    mesh.cell_fields = {name: values[types == cell] for name, values in on_cells.items()}
    return mesh


# ---- PETSc ----

def to_dmplex(mesh: Mesh, comm: Any) -> Any:
    try:
        from petsc4py import PETSc
    except ImportError as error:
        raise ImportError("to_dmplex needs petsc4py: install it, or python3-petsc4py on Debian") \
            from error
    comm = PETSc.COMM_SELF if comm is None else comm
    first = PETSc.Comm(comm).getRank() == 0
    integers = PETSc.IntType
    cells = mesh.cells.astype(integers)
    dimension = cells.shape[1] - 1
    if dimension == 3:
        cells = cells[:, [0, 2, 1, 3]]  # PETSc's tetrahedra are turned the other way
    count = len(cells) if first else 0
    points = mesh.points if first else mesh.points[:0]
    plex = PETSc.DMPlex().createFromCellList(dimension, cells[:count], points, interpolate=True,
                                             comm=comm)
    first_cell, _ = plex.getHeightStratum(0)
    first_vertex, last_vertex = plex.getDepthStratum(0)
    plex.createLabel("Cell Sets")
    plex.createLabel("Face Sets")
    for cell, ref in enumerate(mesh.refs[:count].tolist()):
        plex.setLabelValue("Cell Sets", first_cell + cell, ref)
    listed = {tuple(corners): ref for corners, ref in
              zip(np.sort(mesh.facets, axis=1).tolist(), mesh.facet_refs.tolist())}
    for facet in range(*plex.getHeightStratum(1)):
        closure, _ = plex.getTransitiveClosure(facet)
        corners = closure[(closure >= first_vertex) & (closure < last_vertex)] - first_vertex
        ref = listed.get(tuple(sorted(corners.tolist())))
        if ref is not None:
            plex.setLabelValue("Face Sets", facet, ref)
    return plex
