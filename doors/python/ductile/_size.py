"""Sizes without tensors."""

from __future__ import annotations

import re
from contextlib import contextmanager
from typing import TYPE_CHECKING, Any, Iterator

import numpy as np

from . import _ductile
from ._arrays import executor, finite, floats, indices, number, point, points, shown, text, whole
from ._build import mesh_data
from ._ductile import InputError

if TYPE_CHECKING:
    from ._mesh import Mesh


class Size:
    """How long edges should be, said by places. Where several sizes hold, the finest one does.

    Parameters
    ----------
    default : float, optional
        The size where nothing finer is asked for; by default the extent of the mesh.
    hmin, hmax : float, optional
        Bounds that hold in the end.

    Examples
    --------
    >>> size = ductile.Size(0.1)
    >>> size.near(sphere=((0.5, 0.5, 0.5), 0.2), h=0.01)
    >>> size.on("wall", h=0.005, grow=1.2)
    >>> out = mesh.remesh(size)

    Notes
    -----
    From each place its size grows with the distance d, as h + d ln(grow), up to `hmax`; or, with
    `distance`, evenly from h to `hmax` over that distance. ``grow=0``: it holds at the place alone.
    """

    def __init__(self, default: float = 0, *, hmin: float = 0, hmax: float = 0) -> None:
        elsewhere = number(default, "default")
        self._sizes = _ductile.Sizes(elsewhere, _ductile.SizeBounds(
            number(hmin, "hmin"), number(hmax, "hmax")))
        self._said = [f"Size({elsewhere:g})"]  # then a call for each place

    def __repr__(self) -> str:
        return "".join(self._said)

    def near(self, *, h: float, point: Any = None, sphere: Any = None, box: Any = None,
             curve: Any = None, surface: Any = None, grow: float = 1.3, hmax: float = 0,
             distance: float = 0) -> Size:
        """Asks for the size `h` near a place, one of the following.

        Parameters
        ----------
        h : float
            The size there.
        point : (d,) array_like
            A point.
        sphere : tuple of (d,) array_like and float
            Centre and radius of a ball; inside of it, too, the size is `h`.
        box : tuple of two (d,) array_like
            Opposite corners of a box along the axes, likewise.
        curve : (n, d) array_like
            A chain of segments through these points.
        surface : tuple of (n, 3) and (m, 3) array_like
            Points, and triangles of them.
        grow, hmax, distance : float, optional
            How the size grows from there, see `Size`.

        Returns
        -------
        Size
            This one, so that calls can be chained.
        """
        places = {"point": point, "sphere": sphere, "box": box, "curve": curve, "surface": surface}
        given = [name for name, place in places.items() if place is not None]
        if len(given) != 1:
            raise InputError("near: expected one of point, sphere, box, curve and surface, found "
                             + (" and ".join(given) or "none"))
        growth, size = self._growth(grow, hmax, distance), number(h, "h")
        add = getattr(self, f"_add_{given[0]}")
        add(places[given[0]], size, growth)
        self._said.append(f".near({given[0]}=..., h={size:g})")
        return self

    def on(self, boundary: str | int, *, h: float, grow: float = 1.3, hmax: float = 0,
           distance: float = 0) -> Size:
        """Asks for the size `h` on a boundary or interface, by its name or its reference.

        A name may be that of a region or a curve, too. See `near` for the other parameters.
        """
        return self._add_reference(boundary, _ductile.of_facets, number(h, "h"),
                                   self._growth(grow, hmax, distance), "on")

    def inside(self, region: str | int, *, h: float, grow: float = 1.3, hmax: float = 0,
               distance: float = 0) -> Size:
        """Asks for the size `h` in a region, by its name or the reference of its cells.

        In there it takes the place of the default, finer or coarser. See `near` for the other
        parameters.
        """
        return self._add_reference(region, _ductile.of_cells, number(h, "h"),
                                   self._growth(grow, hmax, distance), "inside")

    def at(self, mesh: Mesh, *, threads: int = 0) -> np.ndarray:
        """The size at each vertex of a mesh, ``(n,)``."""
        with self._said_of_places():
            return self._sizes.at(mesh_data(mesh, "mesh"), executor(threads))

    @contextmanager
    def _said_of_places(self) -> Iterator[None]:
        """What C++ says is wrong with a place is raised by the call that asked for it."""
        try:
            yield
        except InputError as error:
            said = re.sub(r"^sources\[(\d+)\]", lambda match: self._said[int(match[1]) + 1][1:],
                          str(error))
            raise InputError(said) from None

    # ---- How places are given to C++ ----

    @staticmethod
    def _growth(grow: float, hmax: float, distance: float) -> _ductile.SizeGrowth:
        return _ductile.SizeGrowth(number(grow, "grow"), number(hmax, "hmax"),
                                   number(distance, "distance"))

    def _add_point(self, place: Any, h: float, growth: _ductile.SizeGrowth) -> None:
        self._sizes.ball(point(place, "point"), 0.0, h, growth)

    def _add_sphere(self, place: Any, h: float, growth: _ductile.SizeGrowth) -> None:
        centre, radius = _pair(place, "sphere", "a centre and a radius")
        self._sizes.ball(point(centre, "sphere[0]"), number(radius, "sphere[1]"), h, growth)

    def _add_box(self, place: Any, h: float, growth: _ductile.SizeGrowth) -> None:
        low, high = _pair(place, "box", "two opposite corners")
        ends = np.array([point(low, "box[0]"), point(high, "box[1]")])
        self._sizes.box(ends.min(axis=0), ends.max(axis=0), h, growth)

    def _add_curve(self, place: Any, h: float, growth: _ductile.SizeGrowth) -> None:
        self._sizes.curve(points(place, "curve"), h, growth)

    def _add_surface(self, place: Any, h: float, growth: _ductile.SizeGrowth) -> None:
        corners, triangles = _pair(place, "surface", "points and triangles")
        array = finite(floats(corners, "surface[0]"), "surface[0]")
        array = points(array, "surface[0]")
        self._sizes.surface(array, indices(triangles, "surface[1]", 3, len(array)).astype(np.int32),
                            h, growth)

    def _add_reference(self, place: str | int, dimension: int, h: float,
                       growth: _ductile.SizeGrowth, call: str) -> Size:
        if isinstance(place, str):
            self._sizes.named(text(place, call), h, growth)
        elif isinstance(place, (int, np.integer)) and not isinstance(place, bool):
            self._sizes.referenced(dimension, whole(place, call, -2**31, 2**31 - 1), h, growth)
        else:
            raise InputError(f"{call}: expected a name or a reference, found {shown(place)}")
        self._said.append(f".{call}({place!r}, h={h:g})")
        return self


def _pair(place: Any, name: str, expected: str) -> tuple[Any, Any]:
    try:
        first, second = place
    except (TypeError, ValueError):
        raise InputError(f"{name}: expected {expected}, found {shown(place)}") from None
    return first, second
