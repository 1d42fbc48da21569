"""What curved boundaries are like, kept for as long as a simulation lasts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Callable, Mapping, NamedTuple, Optional, Union

import numpy as np

from . import _ductile
from ._arrays import executor, finite, floats, named, number, shown, whole
from ._build import mesh_data
from ._ductile import InputError

if TYPE_CHECKING:
    from ._mesh import Mesh


class Closest(NamedTuple):
    """Points of a geometry."""

    points: np.ndarray
    """``(n, d)``; NaN where none is within reach."""
    normals: np.ndarray
    """``(n, d)``, of unit length and outwards, where not on an interface."""
    refs: np.ndarray
    """``(n,)``, the references of the facets there; 0 where none is within reach."""


def _refs(mesh: Mesh, key: Union[int, str]) -> list[int]:
    """The references of facets that a key of `surfaces` stands for."""
    if not isinstance(key, str):
        return [whole(key, "surfaces: a key", -2**31, 2**31 - 1)]
    refs = [ref for name, dim, ref in mesh.names if name == key and dim == mesh.dim - 1]
    if not refs:
        raise InputError(f"surfaces: no facets have the name {key!r}")
    return refs


def _checked(surface: Callable, ref: int, dim: int) -> Callable:
    """The function with three coordinates, of which C++ knows."""
    if not callable(surface):
        raise InputError(f"surfaces[{ref}]: expected a function, found {shown(surface)}")

    def closest(point: list[float]) -> list[float]:
        result = floats(surface(np.array(point[:dim])), f"surfaces[{ref}]")
        if result.shape != (dim,):
            raise InputError(f"surfaces[{ref}]: expected a point of {dim} coordinates, found an "
                             f"array of shape {result.shape}")
        return [*result, 0.0][:3]

    return closest


class Geometry:
    """The curved boundaries and interfaces of a domain, taken once from a mesh of it.

    `Mesh.remesh` with ``geometry=`` measures `hausd` from it, not from the mesh that is adapted, so
    that what is round stays round in every call of a loop.

    Parameters
    ----------
    mesh : Mesh
        The first mesh, or a finer one of the same domain, with the same references.
    hausd : float
        How far facets of adapted meshes may be from it.
    ar : float, optional
        Facets that turn by as many degrees meet at a ridge, which stays.
    surfaces : dict of int or str to callable, optional
        What facets of a reference, or a name, truly lie on: a function of a point, an array
        ``(d,)``, that returns the closest point of the surface. New and moved vertices are put on it.
        It may go on beyond its ridges, which are those of the mesh. As Python runs one function at a
        time, threads wait for each other there; from C++ and C they do not.
    threads : int, optional
        0: as many as there are cores.

    Examples
    --------
    >>> geometry = ductile.Geometry(mesh, hausd=0.001)
    >>> for step in range(10):
    ...     mesh = mesh.remesh(wanted(mesh), geometry=geometry)
    """

    def __init__(self, mesh: Mesh, hausd: float, *, ar: float = 45,
                 surfaces: Optional[Mapping[Union[int, str], Callable]] = None, threads: int = 0) -> None:
        data = mesh_data(mesh, "mesh")
        if not isinstance(surfaces, (Mapping, type(None))):
            raise InputError(f"surfaces: expected a dict, found {shown(surfaces)}")
        functions = [(ref, _checked(surface, ref, mesh.dim))
                     for key, surface in (surfaces or {}).items() for ref in _refs(mesh, key)]
        with named(mesh._data.cell_dimension):
            self._data = _ductile.GeometryData(data, number(hausd, "hausd"),
                                               number(ar, "ar"), functions, executor(threads))

    def __repr__(self) -> str:
        return f"Geometry(dim={self.dim}, hausd={self.hausd:g})"

    @property
    def dim(self) -> int:
        """2 or 3."""
        return self._data.dimension

    @property
    def hausd(self) -> float:
        """How far facets of adapted meshes may be from it."""
        return self._data.tolerance

    def closest(self, points: Any, *, reach: float = np.inf, threads: int = 0) -> Closest:
        """The closest point of the geometry to each of some points, at most `reach` away.

        Parameters
        ----------
        points : (n, d) array_like
        reach : float, optional
        threads : int, optional

        Returns
        -------
        Closest
        """
        given = finite(floats(points, "points"), "points")
        if given.ndim != 2 or given.shape[1] != self.dim:
            raise InputError(f"points: expected an array of shape (n, {self.dim}), found "
                             f"{given.shape}")
        if not number(reach, "reach") > 0:
            raise InputError(f"reach: expected a distance above 0, found {shown(reach)}")
        return Closest(*self._data.closest(given, reach, executor(threads)))
