"""What curved boundaries are like, kept for as long as a simulation lasts."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np

from . import _ductile
from ._arrays import finite, floats, named, number
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
    threads : int, optional
        0: as many as there are cores.

    Examples
    --------
    >>> geometry = ductile.Geometry(mesh, hausd=0.001)
    >>> for step in range(10):
    ...     mesh = mesh.remesh(wanted(mesh), geometry=geometry)
    """

    def __init__(self, mesh: Mesh, hausd: float, *, ar: float = 45, threads: int = 0) -> None:
        with named(mesh.dim):
            self._data = _ductile.GeometryData(mesh._data, number(hausd, "hausd"),
                                               number(ar, "ar"), _ductile.Executor(threads, True))

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
        if not reach > 0:
            raise InputError(f"reach: expected a distance above 0, found {reach!r}")
        return Closest(*self._data.closest(given, reach, _ductile.Executor(threads, True)))
