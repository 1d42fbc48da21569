"""Mesh adaptation of triangles and tetrahedra, from numpy arrays to numpy arrays.

>>> import ductile
>>> mesh = ductile.box((1, 1), (10, 10))
>>> size = ductile.Size(0.1).near(point=(0.5, 0.5), h=0.01)
>>> fine = mesh.remesh(size)
>>> fine.save("fine.vtu")

A `Mesh` has points and cells; `Mesh.remesh` makes one whose edges have the sizes that are asked for:
a number, a size at each vertex, a `Size`, or a metric tensor at each vertex, as `metric` makes it of a
solution. What is wrong with arguments raises `InputError`, a `ValueError` that names the array and
the index.
"""

from ._build import InputWarning
from ._ductile import Cancelled, Error, InputError, Report
from ._ductile import version as __version__
from ._cut import Cut
from ._draw import draw
from ._files import box, read, read_field, save_field, transfer
from ._geometry import Geometry
from ._info import Info, info
from ._interop import from_meshio, from_vtk
from ._mesh import Mesh, Origin
from ._metric import (bound, complexity, full, grade, implied, intersect, metric, packed, sizes)
from ._size import Size

__all__ = [
    "Cancelled", "Cut", "Error", "Geometry", "Info", "InputError", "InputWarning", "Mesh", "Origin", "Report", "Size",
    "__version__", "bound", "box", "complexity", "draw", "from_meshio", "from_vtk", "full", "grade", "implied",
    "info", "intersect", "metric", "packed", "read", "read_field", "save_field", "sizes", "transfer",
]
