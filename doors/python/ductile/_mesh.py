"""Mesh: points and cells, adapted, measured, saved."""

from __future__ import annotations

import os
from typing import Any, Callable, Iterable, Mapping, NamedTuple, Optional, Sequence, Union

import numpy as np

from . import _ductile, _html, _interop
from ._arrays import (component_count, converted, executor, field_type, finite, flag, floats, mapping,
                      megabytes, named, number, path_text, shown, text, whole)
from ._build import KINDS, data_of, field, mesh_data, options_of, place_of, warn, with_required
from ._cut import Cut, cut_of, materials_of, references_of
from ._ductile import InputError
from ._geometry import Geometry
from ._metric import MetricLike, as_rows, as_tensors, full, packed
from ._size import Size

ProgressFunction = Callable[[str, int, int], Optional[bool]]
Names = Union[Mapping[str, "tuple[int, int]"], Iterable["tuple[str, int, int]"]]


class Origin(NamedTuple):
    """What an adapted mesh still has of the mesh that it was made from, and where the rest lies."""

    vertices: np.ndarray
    """(n,) The vertex at exactly the same place; -1: there is none, the vertex is new or has moved."""
    facets: np.ndarray
    """(k,) The facet that has the same vertices, or -1."""
    cells: np.ndarray
    """(m,) The cell that has the same vertices, or -1."""
    host: np.ndarray
    """(n,) The cell in which each vertex lies, or which is closest."""
    weights: np.ndarray
    """(n, c) Its barycentric weights there, for each of the c corners of a cell."""


class Mesh:
    """A mesh of triangles in the plane or of tetrahedra in space. It does not change.

    Parameters
    ----------
    points : (n, 2) or (n, 3) array_like
        Coordinates. Triangles in a plane of constant z become a mesh of dimension 2, others a surface.
    cells : (m, 3) or (m, 4) array_like of int
        Vertices of triangles or tetrahedra, from 0.
    refs : (m,) array_like of int, optional
        References (tags) of cells. Between cells of different references there is an interface, which
        is kept.
    facets : (k, d) array_like of int, optional
        Edges in 2D, triangles in 3D, of the boundary or inside. Facets of the boundary and of
        interfaces that are not given follow those that are, with reference 0.
    facet_refs, vertex_refs : array_like of int, optional
        Their references.
    names : dict of str to (dimension, reference), optional
        What entities of a dimension with a reference are called.

    Attributes
    ----------
    points, cells, facets, edges, refs, facet_refs, edge_refs, vertex_refs : ndarray
        Views of the memory that C++ works on; they cannot be written to, see `replace`. In 3D, `edges`
        are those of ridges; in 2D they are the facets.
    dim : int
        2 or 3; of a surface alone, triangles in space, 3.
    fields, cell_fields : dict of str to ndarray
        Values at vertices and on cells: what a file has, or what you put there. `save` writes them.
    metric : ndarray or None
        Of an adapted mesh, the metric at its vertices.
    report : Report or None
        Of an adapted mesh, how the adaptation went; with a `Size`, the last one, with the seconds and
        warnings of all.
    level_set : Cut or None
        Of a mesh that `cut` made, what it has of the mesh before.

    Examples
    --------
    >>> mesh = ductile.Mesh([[0, 0], [1, 0], [1, 1], [0, 1]], [[0, 1, 2], [0, 2, 3]])
    >>> mesh.remesh(0.1)
    Mesh(dim=2, points=135, cells=230, facets=38)

    Notes
    -----
    Thread safety: any number of threads may use one mesh. Work is done without the interpreter's lock.
    """

    def __init__(self, points: Any, cells: Any, *, refs: Any = None, facets: Any = None,
                 facet_refs: Any = None, vertex_refs: Any = None, names: Names = ()) -> None:
        state = {"points": points, "cells": cells, "refs": refs, "facets": facets,
                 "facet_refs": facet_refs, "vertex_refs": vertex_refs, "names": names}
        self._set(data_of(state))

    # ---- Inside ----

    @classmethod
    def _of(cls, data: _ductile.MeshData) -> Mesh:
        mesh = cls.__new__(cls)
        mesh._set(data)
        return mesh

    def _set(self, data: _ductile.MeshData) -> None:
        self._data = data
        self.fields: dict[str, np.ndarray] = {}
        self.cell_fields: dict[str, np.ndarray] = {}
        self.metric: Optional[np.ndarray] = None
        self.report: Optional[_ductile.Report] = None
        self._source: Optional[_ductile.MeshData] = None
        self._tolerance = 0.0
        self._cut: Optional[_ductile.CutData] = None
        self.level_set: Optional[Cut] = None
        self._origin: Optional[Origin] = None

    def _state(self) -> dict[str, Any]:
        data = self._data
        state: dict[str, Any] = {name: getattr(data, name) for name in
                                 ("points", "cells", "refs", "facets", "facet_refs",
                                  "vertex_refs", "names")}
        if data.dimension == 3:
            state["edges"], state["edge_refs"] = data.edges, data.edge_refs
        state["required"] = {kind: data.required(kind) for kind in KINDS}
        return state

    def __getstate__(self) -> dict[str, Any]:
        return {"mesh": self._state(), "fields": self.fields, "cell_fields": self.cell_fields,
                "metric": self.metric}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._set(data_of(state["mesh"]))
        self.fields, self.cell_fields = state["fields"], state["cell_fields"]
        self.metric = state["metric"]

    def _require_source(self, source: Optional[Mesh] = None) -> _ductile.MeshData:
        if source is not None:
            return mesh_data(source, "source")
        if self._source is None:
            raise InputError("this mesh was not made by remesh (and after pickling it does not know "
                             "of what): pass the other mesh as source=")
        return self._source

    def _tensors(self, M: Optional[MetricLike]) -> Optional[np.ndarray]:
        """A metric of this mesh, or of the one it was made from, as tensors at the vertices here."""
        if M is None:
            return self.metric
        if self._source is None or isinstance(M, Size) or np.ndim(M) == 0 \
                or np.shape(M)[0] == len(self.points):
            return as_tensors(self, M)
        return _carried(full(as_tensors(Mesh._of(self._source), M)), self._source, self.origin)

    # ---- What it has ----

    @property
    def dim(self) -> int:
        return self._data.dimension

    @property
    def points(self) -> np.ndarray:
        return self._data.points

    @property
    def cells(self) -> np.ndarray:
        return self._data.cells

    @property
    def facets(self) -> np.ndarray:
        return self._data.facets

    @property
    def edges(self) -> np.ndarray:
        return self._data.edges

    @property
    def refs(self) -> np.ndarray:
        return self._data.refs

    @property
    def facet_refs(self) -> np.ndarray:
        return self._data.facet_refs

    @property
    def edge_refs(self) -> np.ndarray:
        return self._data.edge_refs

    @property
    def vertex_refs(self) -> np.ndarray:
        return self._data.vertex_refs

    @property
    def names(self) -> list[tuple[str, int, int]]:
        """Names of references: name, dimension of the entities, reference."""
        return self._data.names

    @property
    def required_vertices(self) -> np.ndarray:
        """Indices of the vertices that adaptation must not touch."""
        return self._data.required("vertices")

    @property
    def required_facets(self) -> np.ndarray:
        """Indices of the facets that adaptation must not touch."""
        return self._data.required("facets")

    @property
    def required_cells(self) -> np.ndarray:
        """Indices of the cells that adaptation must not touch."""
        return self._data.required("cells")

    def facets_on(self, name: str) -> np.ndarray:
        """Which facets carry a reference of this name, ``(k,)`` of bool."""
        return np.isin(self.facet_refs, self._references_of(name, self._data.cell_dimension - 1))

    def cells_in(self, name: str) -> np.ndarray:
        """Which cells carry a reference of this name, ``(m,)`` of bool."""
        return np.isin(self.refs, self._references_of(name, self._data.cell_dimension))

    def _references_of(self, name: str, dimension: int) -> list[int]:
        text(name, "name")
        found = [ref for named, dim, ref in self.names if named == name and dim == dimension]
        if not found:
            known = sorted({named for named, dim, _ in self.names if dim == dimension})
            raise InputError(f"name {name!r}: expected one of {', '.join(known) or 'none'}")
        return found

    def __repr__(self) -> str:
        return (f"Mesh(dim={self.dim}, points={len(self.points)}, cells={len(self.cells)}, "
                f"facets={len(self.facets)})")

    def _repr_html_(self) -> str:
        return _html.page(self)

    # ---- Adaptation ----

    def remesh(self, metric: Optional[MetricLike] = None, *, hsiz: Optional[float] = None,
               hmin: float = 0, hmax: float = 0, hgrad: float = 0, hgradreq: float = 0,
               hausd: float = 0, geometry: Optional[Geometry] = None, ar: float = 45,
               curved_sizes: bool = False, iterations: int = 16, thorough: bool = False,
               nomove: bool = False, noswap: bool = False, noinsert: bool = False,
               nosurf: bool = False, required_vertices: Any = None, required_facets: Any = None,
               required_cells: Any = None, memory: int = 0, threads: int = 0,
               progress: Optional[ProgressFunction] = None) -> Mesh:
        """The mesh adapted so that edges have the lengths that are asked for.

        Parameters
        ----------
        metric : float, Size or array_like, optional
            A size everywhere; a `Size`, to which the mesh is adapted again while it asks for more
            than vertices have seen; a size at each vertex, ``(n,)``; or a metric tensor,
            ``(n, 3)`` in 2D and ``(n, 6)`` in 3D (m11 m12 m22 m13 m23 m33, as in files, not in the
            order of Mmg's own functions), or ``(n, d, d)``. By default the sizes that the mesh has,
            within `hmin` and `hmax`, or those of `curved_sizes`. A mesh that `cut` made also takes
            arrays for the mesh before, whose sizes are then the default.
        hsiz : float, optional
            The same as a number for `metric`, by Mmg's name.
        hmin, hmax : float, optional
            No edge shorter or longer than this is asked for; 0: no bound.
        hgrad : float, optional
            Sizes grow by at most this factor per unit of metric length; Mmg's default is 1.3. 0: as
            given.
        hgradreq : float, optional
            Sizes at required entities are those that these have, and grow or fall by at most this
            factor from there; Mmg's default is 2.3. 0: as given.
        hausd : float, optional
            How far curved boundaries may be from where they were; 0: they keep their facets, or
            with a `geometry` its own.
        geometry : Geometry, optional
            What curved boundaries are like; by default what they are like in this mesh, and the
            interface of a mesh that `cut` made like the level set. In a loop, pass that of the first
            mesh to every call.
        ar : float, optional
            Facets that turn by as many degrees meet at a ridge, which stays.
        curved_sizes : bool, optional
            Sizes on curved boundaries are bounded by what `hausd` allows, in each direction by how
            the boundary bends there, and grow from there by `hgrad`, or 1.3. Without a `metric`
            nothing else limits them but `hmin` and `hmax`: Mmg's ``-A``. With an `hgrad` the bounds
            hold anyway.
        iterations : int, optional
            At most this many rounds.
        thorough : bool, optional
            Better quality and lengths for more time.
        nomove, noswap, noinsert : bool, optional
            Do not smooth vertices; swap edges and faces; split and collapse edges.
        nosurf : bool, optional
            Leave boundaries and interfaces as they are.
        required_vertices, required_facets, required_cells : array_like of bool or int, optional
            Entities that must not be touched, besides those that the mesh has: one bool for each, or
            indices.
        memory : int, optional
            At most so many megabytes; 0: no limit.
        threads : int, optional
            0: as many as there are cores. The mesh is the same, bit for bit, for any number.
        progress : callable, optional
            ``progress(step, iteration, changes)`` is called after each step, on the thread that called
            `remesh`. If it returns False, `Cancelled` is raised; what it raises itself comes through.

        Returns
        -------
        Mesh
            With `metric`, `report` and `origin`; with the names, not the fields of this one, see
            `transfer`.

        Raises
        ------
        InputError
            For arrays and options that are wrong, by name and index. What looks doubtful is an
            `InputWarning`, and in `report.warnings`.
        Cancelled
            If `progress` returned False. Ctrl-C raises KeyboardInterrupt.
        MemoryError, Error
            If memory runs out, or would.

        Examples
        --------
        >>> out = mesh.remesh(hmax=0.1, hausd=0.001, hgrad=1.3)
        >>> out = mesh.remesh(M, required_facets=mesh.facet_refs == 99)
        """
        if hsiz is not None:
            if metric is not None:
                raise InputError("remesh: expected one of metric and hsiz, found both")
            metric = number(hsiz, "hsiz")
        if progress is not None and not callable(progress):
            raise InputError(f"progress: expected a function, found {shown(progress)}")
        if not isinstance(geometry, (Geometry, type(None))):
            raise InputError(f"geometry: expected a ductile.Geometry, found {shown(geometry)}")
        data = with_required(self._data, vertices=required_vertices, facets=required_facets,
                              cells=required_cells)
        options = options_of(smallest_size=number(hmin, "hmin"), largest_size=number(hmax, "hmax"),
                           gradation=number(hgrad, "hgrad"),
                           curved_sizes=flag(curved_sizes, "curved_sizes"),
                           required_gradation=number(hgradreq, "hgradreq"),
                           hausdorff_tolerance=number(hausd, "hausd") or (geometry.hausd if geometry else 0),
                           geometry=geometry and geometry._data, ridge_angle=number(ar, "ar"),
                           iterations=whole(iterations, "iterations", 0, 1000),
                           thorough=flag(thorough, "thorough"), move=not flag(nomove, "nomove"),
                           swap=not flag(noswap, "noswap"), insert=not flag(noinsert, "noinsert"),
                           lock_boundary=flag(nosurf, "nosurf"),
                           memory_limit=megabytes(memory))
        runs = executor(threads)
        if self._cut is not None and options.hausdorff_tolerance and geometry is None:
            self._cut.add_surface(options, runs)
        if isinstance(metric, Size):
            with named(self._data.cell_dimension), metric._said_of_places():
                result = _ductile.remesh_to_sizes(data, metric._sizes, options, runs, progress)
        else:
            rows = self._rows(data, metric, options.curved_sizes, runs)
            with named(self._data.cell_dimension):
                result = _ductile.remesh(data, rows, options, runs, progress)
        out = Mesh._of(result[0])
        out.metric, out.report = result[1:]
        out._source, out._tolerance = data, options.hausdorff_tolerance
        warn(out.report.warnings)
        return out

    def move(self, displacement: Any, *, bodies: Iterable[int] = (), boundaries: Iterable[int] = (),
             metric: Optional[MetricLike] = None, hmin: float = 0, hmax: float = 0, hgrad: float = 0,
             fields: Optional[Mapping[str, Any]] = None, conservative: bool = False,
             turned: Iterable[str] = (), keep_partial: bool = False, threads: int = 0) -> Mesh:
        """A new mesh, in which bodies have moved; it is adapted near them where it must be.

        Parameters
        ----------
        displacement : (n, d) array_like
            A vector for each vertex.
        bodies, boundaries : iterable of int, optional
            References of cells and of facets that move. By default displacements decide: vertices
            move that have one, and regions with such vertices inside.
        metric : optional
            The sizes to adapt to, as in `remesh`; vertices take them along, and tensors turn with the
            mesh. By default those of the mesh. In a loop, give the `metric` of the moved mesh to the
            next call.
        hmin, hmax, hgrad : float, optional
            As in `remesh`.
        fields : dict of str to array_like, optional
            A row for each vertex or each cell. They go with the mesh, and come back as `fields` and
            `cell_fields`.
        conservative : bool, optional
            Keep their integrals instead of their values.
        turned : iterable of str, optional
            The fields of vectors or tensors that turn with the mesh, such as directions of fibres.
        keep_partial : bool, optional
            If the way is blocked, return the mesh of the place that was reached; `report.stopped`
            says why. Otherwise `Error` is raised.

        Returns
        -------
        Mesh
            With `metric`, `report`, `fields`, `cell_fields` and `origin`: places of this mesh, before
            the motion.

        Examples
        --------
        >>> new = mesh.move(u, bodies=[3])
        >>> newer = new.move(v, bodies=[3], metric=new.metric)
        """
        vectors = finite(floats(displacement, "displacement"), "displacement")
        if vectors.shape != self.points.shape:
            raise InputError(f"displacement: expected shape {self.points.shape}, found {vectors.shape}")
        options = _ductile.MoveOptions()
        options.bodies = [whole(ref, "bodies", -2**31, 2**31 - 1) for ref in bodies]
        options.boundaries = [whole(ref, "boundaries", -2**31, 2**31 - 1) for ref in boundaries]
        options.smallest_size, options.largest_size = number(hmin, "hmin"), number(hmax, "hmax")
        options.gradation = max(0.0, number(hgrad, "hgrad"))
        options.keep_partial = flag(keep_partial, "keep_partial")
        options.turned = list(turned)
        given = [field(name, values, self._data, None)
                 for name, values in mapping(fields or {}, "fields").items()]
        runs = executor(threads)
        with named(self.dim):
            rows = None if metric is None else as_rows(self, metric, runs)
            data, tensors, carried, origin, report = _ductile.move(
                self._data, vectors, (rows, given, flag(conservative, "conservative")), options, runs)
        out = Mesh._of(data)
        out.metric, out.report, out._origin = tensors, report, Origin(*origin)
        for (name, _, on_cells, _), values in zip(given, carried):
            shaped = values.reshape(-1, *np.shape((fields or {})[name])[1:])
            (out.cell_fields if on_cells else out.fields)[name] = shaped
        warn(report.warnings)
        return out

    def cut(self, phi: Any, level: float = 0, *, minus: int = 3, plus: int = 2, interface: int = 10,
            materials: Optional[Mapping[int, Optional[Sequence[int]]]] = None,
            least_component: float = 0, keep_volume: Optional[float] = None,
            boundary_only: bool = False, threads: int = 0) -> Mesh:
        """The mesh cut where a function is `level`.

        The level set becomes facets, on a surface alone edges. Elements close to it may be bad; `remesh` makes good ones, and
        with `hausd` puts the interface on the curved surface of the function.

        Parameters
        ----------
        phi : (n,) array_like
            Values at the vertices. If nothing else is known, take signed distances.
        level : float, optional
        minus, plus, interface : int, optional
            References of the cells where `phi` is lower and higher, and of the facets between them.
            Facets inside that have the reference already, of an earlier cut, are dropped.
        materials : dict of int to (int, int) or None, optional
            For each reference of cells, those of its two sides, or None if it is not split.
        least_component : float, optional
            Connected parts of either side with less than this fraction of the volume become part of
            the other side.
        keep_volume : float, optional
            `level` is changed so that the cells of lower values have this volume within 1e-6 of it;
            if no level gives that, there is a warning.
        boundary_only : bool, optional
            Cut only the triangles of the boundary of tetrahedra: these get the references of the
            sides, and the edges between them `interface`.
        threads : int, optional
            0: as many as there are cores. The mesh is the same, bit for bit, for any number.

        Returns
        -------
        Mesh
            With `level_set`; vertices that there were come first.

        Raises
        ------
        InputError
            For arrays and options that are wrong, and if a required entity would be cut.

        Examples
        --------
        >>> phi = np.linalg.norm(mesh.points - 0.5, axis=1) - 0.3
        >>> out = mesh.cut(phi).remesh(0.05, hausd=0.001)
        """
        values = finite(floats(phi, "phi"), "phi")
        if values.shape != (len(self.points),):
            raise InputError(f"phi: expected shape ({len(self.points)},), one value for each vertex, "
                             f"found {values.shape}")
        options = _ductile.CutOptions(
            number(level, "level"), references_of(minus, plus, interface), materials_of(materials),
            (number(least_component, "least_component"),
             None if keep_volume is None else number(keep_volume, "keep_volume"),
             flag(boundary_only, "boundary_only")))
        with named(self.dim):
            data = _ductile.cut(self._data, values, options, executor(threads))
        out = Mesh._of(data.mesh)
        out._cut, out._source, out.level_set = data, self._data, cut_of(data)
        warn(out.level_set.report.warnings)
        return out

    def refine_to(self, function: Callable[[np.ndarray], Any], tolerance: float,
                  metric: Optional[MetricLike] = None, *, hmin: float = 0, threads: int = 0) -> Mesh:
        """The mesh refined where a function is 0, so that `cut` finds its zero.

        Parameters
        ----------
        function : callable
            Values ``(n,)`` at points ``(n, d)``.
        tolerance : float
            Largest distance between the zeros of the function and of its linear interpolant. Films
            and specks of that sign between vertices are resolved, too.
        metric : float or array_like, optional
            Sizes elsewhere, as in `remesh`; by default those that the mesh has.
        hmin : float, optional
            Edges are not divided below this; 0: `tolerance`.
        threads : int, optional

        Returns
        -------
        Mesh
            With `metric`, `report` and `origin`, as `remesh` returns it.

        Examples
        --------
        >>> mesh = mesh.refine_to(f, 0.001)
        >>> out = mesh.cut(f(mesh.points)).remesh(0.1, hausd=0.001)
        """
        if not callable(function):
            raise InputError(f"function: expected a function, found {shown(function)}")

        def at(points: np.ndarray) -> np.ndarray:
            values = finite(floats(function(points), "function"), "function")
            if values.shape != (len(points),):
                raise InputError(f"function: expected a value for each of {len(points)} points, found "
                                 f"an array of shape {values.shape}")
            return values

        runs = executor(threads)
        rows = None if metric is None else as_rows(self, metric, runs)
        with named(self.dim):
            result = _ductile.refine_to_level_set(
                self._data, rows, at, number(tolerance, "tolerance"), number(hmin, "hmin"), runs)
        out = Mesh._of(result[0])
        out.metric, out.report = result[1:]
        out._source = self._data
        warn(out.report.warnings)
        return out

    def _rows(self, data: _ductile.MeshData, metric: Optional[MetricLike], curved_sizes: bool,
              runs: _ductile.Executor) -> Any:
        """A metric as C++ takes it; that of the mesh before a cut is carried."""
        if self._cut is None or (metric is None and curved_sizes):
            return None if metric is None else as_rows(Mesh._of(data), metric, runs)
        before = Mesh._of(self._require_source())
        if metric is None:
            return self._cut.metric(None, runs), _ductile.FieldType.symmetric
        if np.ndim(metric) > 0 and len(metric) == len(before.points) != len(self.points):
            return self._cut.metric(as_tensors(before, metric), runs), _ductile.FieldType.symmetric
        return as_rows(Mesh._of(data), metric, runs)

    @property
    def origin(self) -> Origin:
        """Of an adapted or moved mesh: which vertex, facet and cell of the mesh before each one is."""
        if self._origin is None:
            self._origin = Origin(*_ductile.origins(self._require_source(), self._data))
        return self._origin

    def transfer(self, u: Any, *, conservative: bool = False, on: Optional[str] = None,
                 source: Optional[Mesh] = None, threads: int = 0) -> Any:
        """Values on the mesh that this one was made from, on this one.

        Parameters
        ----------
        u : array_like, or dict of str to array_like
            A row for each vertex or each cell of the other mesh; rows may have any shape.
        conservative : bool, optional
            Keep integrals, where both meshes cover the same domain, and bounds. Otherwise values are
            interpolated at vertices; a cell gets that of the cell in which its centroid lies, so
            integers stay integers.
        on : "vertices" or "cells", optional
            Where the values live, if there are as many of both.
        source : Mesh, optional
            The other mesh, if this one was not made from it by `remesh`.

        Returns
        -------
        ndarray or dict
            Likewise for the vertices or cells of this mesh.

        Examples
        --------
        >>> new = mesh.remesh(M)
        >>> u = new.transfer(u, conservative=True)
        """
        how: dict[str, Any] = {"conservative": conservative, "on": on, "source": source,
                               "threads": threads}
        if isinstance(u, Mapping):
            return {name: self.transfer(values, **how) for name, values in u.items()}
        before = self._require_source(source)
        conservative = flag(conservative, "conservative")
        array = converted(u, "u")
        if array.dtype.kind == "c":
            return (self.transfer(array.real, **how) + 1j * self.transfer(array.imag, **how))
        on_cells = place_of(array, before, on) == "cells"
        values = floats(array, "u")
        if conservative:
            finite(values, "u")
        columns = component_count(values.shape)
        rows = values.reshape(len(values), columns)
        runs = executor(threads)
        kind = field_type(columns, before.dimension)
        parts = [(rows, kind)] if kind is not None else \
            [(np.ascontiguousarray(rows[:, [i]]), _ductile.FieldType.scalar)
             for i in range(columns)]
        with named(self._data.cell_dimension):
            carried = [_ductile.transfer(before, self._data, part,
                                         (part_kind, on_cells, conservative), runs)[0]
                       for part, part_kind in parts]
        result = carried[0] if len(carried) == 1 else np.column_stack(carried)
        result = result.reshape(-1, *values.shape[1:])
        return result.astype(array.dtype) if on_cells and not conservative else result

    def at(self, u: Any, points: Any) -> np.ndarray:
        """Values at the vertices of this mesh, interpolated at points; outside, at the closest."""
        values, places = floats(u, "u"), finite(floats(points, "points"), "points")
        if values.ndim == 0 or len(values) != len(self.points):
            raise InputError(f"u: expected {len(self.points)} rows, one for each vertex, found shape "
                             f"{values.shape}")
        if places.ndim != 2 or places.shape[1] != self.dim:
            raise InputError(f"points: expected shape (n, {self.dim}), found {places.shape}")
        rows = values.reshape(len(values), component_count(values.shape))
        return _ductile.interpolate_at(self._data, rows, places).reshape(-1, *values.shape[1:])

    def signed_distance(self, inside: Union[int, str, Iterable[Union[int, str]]], at: Any = None, *,
                        hausd: float = 0, ar: float = 45, threads: int = 0) -> np.ndarray:
        """The distance to the interface between some regions and the others, negative inside.

        The interface is curved through its vertices, so that a level set that is moved and cut step
        by step does not shrink. The boundary of the mesh is not part of it.

        Parameters
        ----------
        inside : int, str, or several
            References or names of the cells where the distance is negative.
        at : (n, d) array_like or Mesh, optional
            Points, or a mesh, at the vertices of which distances are wanted; by default this mesh.
            On its interface they are exactly 0.
        hausd : float, optional
            How far the curved interface may be from its facets; 0: a tenth of their edges.
        ar : float, optional
            Facets that turn by as many degrees meet at a ridge.
        threads : int, optional

        Returns
        -------
        (n,) ndarray

        Examples
        --------
        >>> phi = mesh.signed_distance(inside=3)
        """
        keys = [inside] if isinstance(inside, (int, str, np.integer)) else inside
        if not isinstance(keys, (list, tuple, set)) and np.ndim(keys) != 1:
            raise InputError(f"inside: expected references or names of cells, found {shown(inside)}")
        refs = [ref for key in keys
                for ref in (self._references_of(key, self.dim) if isinstance(key, str) else
                            [whole(key, "inside", -2**31, 2**31 - 1)])]
        places = at.points if isinstance(at, Mesh) else at
        if places is not None:
            places = finite(floats(places, "at"), "at")
            if places.ndim != 2 or places.shape[1] != self.dim:
                raise InputError(f"at: expected shape (n, {self.dim}), found {places.shape}")
        with named(self.dim):
            return _ductile.signed_distance(self._data, refs, number(hausd, "hausd"),
                                            number(ar, "ar"), places, executor(threads))

    # ---- Measures and checks ----

    def quality(self, M: Optional[MetricLike] = None) -> np.ndarray:
        """The quality of each cell: its mean ratio, 1 if ideal, 0 if flat. `M` is as in `info`."""
        with named(self._data.cell_dimension):
            return _ductile.quality(self._data, self._tensors(M))

    def check(self) -> list[str]:
        """What is wrong with the mesh, a line for each kind of fault; empty if nothing is.

        Entities are counted from 1 there, as in a file. Of an adapted mesh the domain and its topology
        are compared with those of the mesh that it was made from as well.
        """
        if self._source is None or self._cut is not None:
            return _ductile.check(self._data)
        return _ductile.check_adapted(self._source, self._data, self._tolerance)

    # ---- Out ----

    def save(self, path: Union[str, os.PathLike[str]], *,
             fields: Optional[Mapping[str, Any]] = None) -> None:
        """Writes a file of the format that its name says.

        Those are .mesh, .meshb, .msh, .vtu, .vtk, .stl and .su2.

        Parameters
        ----------
        path : path
        fields : dict of str to array_like, optional
            A row for each vertex or each cell. By default `fields` and `cell_fields` of the mesh and
            its metric, as far as the format holds them.
        """
        name = path_text(path)
        given = []
        if fields is not None:
            given = [field(key, values, self._data, None)
                     for key, values in mapping(fields, "fields").items()]
        elif _ductile.holds_fields(name):
            own = dict(self.fields)
            if self.metric is not None:
                own.setdefault("metric", self.metric)
            given = [field(key, values, self._data, "vertices") for key, values in own.items()]
            given += [field(key, values, self._data, "cells")
                      for key, values in self.cell_fields.items()]
        warn(_ductile.save(self._data, name, given))

    def joined(self, tolerance: float = 0) -> Mesh:
        """The mesh in which vertices that are at most `tolerance` from each other are one.

        Facets that become the same are one, too. `fields` keep the values of the vertices that stay.
        What is not connected because vertices are there twice, without being meant as a crack, is so
        afterwards.
        """
        data, kept = _ductile.join_vertices(self._data, number(tolerance, "tolerance"))
        mesh = Mesh._of(data)
        mesh.fields = {name: np.asarray(values)[kept] for name, values in self.fields.items()}
        mesh.cell_fields = dict(self.cell_fields)
        return mesh

    def to_meshio(self, fields: Optional[Mapping[str, Any]] = None) -> dict[str, Any]:
        """Arguments of ``meshio.Mesh``; references are in "gmsh:physical", names in field_data."""
        return _interop.to_meshio(self, fields)

    def to_vtk(self, fields: Optional[Mapping[str, Any]] = None, *, boundary: bool = False) -> Any:
        """A ``vtkUnstructuredGrid``, which pyvista wraps; with facets, too, if `boundary` is true.

        Needs the Python module of VTK. References are in the arrays "region" and "boundary".
        """
        return _interop.to_vtk(self, fields, boundary)

    def to_dmplex(self, comm: Any = None) -> Any:
        """A ``petsc4py.PETSc.DMPlex`` with labels "Cell Sets" and "Face Sets". Needs petsc4py.

        With more than one process in `comm`, the first one's mesh counts; ``distribute()`` it then.
        """
        return _interop.to_dmplex(self, comm)

    def replace(self, **arrays: Any) -> Mesh:
        """The same mesh with other arrays, by the names of `Mesh`'s parameters.

        Examples
        --------
        >>> moved = mesh.replace(points=mesh.points + displacement)
        """
        state = self._state()
        unknown = set(arrays) - (set(state) - {"required"}) - {"edges", "edge_refs"}
        if unknown:
            raise InputError(f"replace: expected names of arrays, found {sorted(unknown)[0]!r}")
        return Mesh._of(data_of({**state, **arrays}))


# ---- Inside ----

def _carried(tensors: np.ndarray, source: _ductile.MeshData, origin: Origin) -> np.ndarray:
    """Metrics of a mesh at the vertices of the one made from it: the means of their logarithms."""
    values, vectors = np.linalg.eigh(tensors)
    logarithms = np.einsum("nij,nj,nkj->nik", vectors, np.log(values), vectors)
    mean = np.einsum("nc,ncij->nij", origin.weights, logarithms[source.cells[origin.host]])
    values, vectors = np.linalg.eigh(mean)
    return packed(np.einsum("nij,nj,nkj->nik", vectors, np.exp(values), vectors))
