"""Metrics: how they are given, made of solutions, and worked on."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Union

import numpy as np

from . import _ductile
from ._arrays import component_count, executor, finite, floats, named, number
from ._build import mesh_data, warn
from ._ductile import FieldType, InputError
from ._size import Size

if TYPE_CHECKING:
    from ._mesh import Mesh

MetricLike = Union[float, np.ndarray, Size]

_ORDER = {2: ((0, 0), (0, 1), (1, 1)), 3: ((0, 0), (0, 1), (1, 1), (0, 2), (1, 2), (2, 2))}


# ---- How they are given ----

def full(M: np.ndarray) -> np.ndarray:
    """The matrices ``(n, d, d)`` of tensors ``(n, 3)`` or ``(n, 6)``.

    Examples
    --------
    >>> eigenvalues = np.linalg.eigvalsh(ductile.full(M))
    """
    rows = floats(M, "M")
    if rows.ndim == 3 and rows.shape[1:] in ((2, 2), (3, 3)):
        return rows
    dimension = _dimension_of(rows, "M")
    matrices = np.empty((len(rows), dimension, dimension))
    for component, (i, j) in enumerate(_ORDER[dimension]):
        matrices[:, i, j] = matrices[:, j, i] = rows[:, component]
    return matrices


def packed(M: np.ndarray) -> np.ndarray:
    """The tensors ``(n, 3)`` or ``(n, 6)`` of symmetric matrices ``(n, d, d)``.

    The order is that of files and of C: m11 m12 m22, in 3D m11 m12 m22 m13 m23 m33.
    """
    matrices = floats(M, "M")
    if matrices.ndim == 2:
        _dimension_of(matrices, "M")
        return matrices
    if matrices.ndim != 3 or matrices.shape[1:] not in ((2, 2), (3, 3)):
        raise InputError(f"M: expected shape (n, 2, 2) or (n, 3, 3), found {matrices.shape}")
    turned = np.swapaxes(matrices, 1, 2)
    size = np.abs(np.trace(matrices, axis1=1, axis2=2))[:, None, None]
    uneven = np.abs(matrices - turned) > 1e-6 * size
    if uneven.any():
        at = np.unravel_index(int(np.argmax(uneven)), matrices.shape)
        n, i, j = map(int, at)
        raise InputError(f"M[{n}]: expected a symmetric matrix, found {matrices[n, i, j]} at "
                         f"[{i}, {j}] and {matrices[n, j, i]} at [{j}, {i}]")
    mean = (matrices + turned) / 2
    order = _ORDER[matrices.shape[1]]
    return np.column_stack([mean[:, i, j] for i, j in order])


def _dimension_of(rows: np.ndarray, name: str) -> int:
    if rows.ndim != 2 or rows.shape[1] not in (3, 6):
        raise InputError(f"{name}: expected shape (n, 3) or (n, 6), found {rows.shape}")
    return 2 if rows.shape[1] == 3 else 3


def as_rows(mesh: Mesh, metric: MetricLike,
            executor: _ductile.Executor = _ductile.Executor()) -> tuple[np.ndarray, FieldType]:
    """What the C++ library takes: components of each vertex in a row, and what they are."""
    count, d = len(mesh.points), mesh.dim
    if isinstance(metric, Size):
        return metric.at(mesh, threads=executor.threads)[:, None], FieldType.scalar
    rows = floats(metric, "metric")
    if rows.ndim == 0:
        return np.full((count, 1), float(rows)), FieldType.scalar
    types = {(): FieldType.scalar, (1,): FieldType.scalar,
             (d * (d + 1) // 2,): FieldType.symmetric, (d, d): FieldType.matrix}
    kind = types.get(rows.shape[1:])
    if kind is None or len(rows) != count:
        raise InputError(f"metric: expected shape ({count},), ({count}, {d * (d + 1) // 2}) or "
                         f"({count}, {d}, {d}), because there are {count} vertices, found "
                         f"{rows.shape}")
    return rows.reshape(count, -1), kind


def as_tensors(mesh: Mesh, metric: MetricLike) -> np.ndarray:
    """One symmetric tensor in each row; those that are no metric are refused."""
    rows, kind = as_rows(mesh, metric)
    return _ductile.as_metric(mesh._data, rows, kind, _ductile.SizeBounds())


# ---- Where they come from ----

def metric(mesh: Mesh, u: Any, *, elements: float | None = None, complexity: float | None = None,
           error: float | None = None, norm: float = 2, hmin: float = 0, hmax: float = 0,
           anisotropy: float = 0, hgrad: float = 0, recovery: str = "least-squares",
           threads: int = 0) -> np.ndarray:
    """The metric in which linear interpolation of a solution has the smallest error.

    Parameters
    ----------
    mesh : Mesh
        The mesh that the solution lives on.
    u : (n,) or (n, ...) array_like
        Values at the vertices; with several components, the metric suits all of them.
    elements, complexity, error : float
        One of them: about how many elements the adapted mesh shall have, the complexity of the
        metric, or the interpolation error in the norm.
    norm : float, optional
        p of the norm L^p; `numpy.inf` is one, too. Small p resolve weak features as well.
    hmin, hmax, anisotropy : float, optional
        Bounds on sizes, and on how much the longest size at a vertex exceeds the shortest.
    hgrad : float, optional
        Sizes grow by at most this factor per unit of metric length; Mmg's default is 1.3. 0: no limit.
    recovery : "least-squares" or "projection", optional
        How to get second derivatives: fits of quadratics, or double projection, which is smoother.
    threads : int, optional
        0: as many as there are cores.

    Returns
    -------
    (n, 3) or (n, 6) ndarray
        m11 m12 m22, in 3D m11 m12 m22 m13 m23 m33.

    Raises
    ------
    InputError
        For values that are not finite or do not belong to the mesh, and goals that make no sense.

    Examples
    --------
    >>> M = ductile.metric(mesh, u, elements=4000, hgrad=1.5)
    >>> new = mesh.remesh(M)
    """
    mesh_data(mesh, "mesh")
    goals = {"elements": elements, "complexity": complexity, "error": error}
    given = {name: number(value, name) for name, value in goals.items() if value is not None}
    if len(given) != 1:
        raise InputError("metric: expected one of elements, complexity and error, found "
                         + (" and ".join(given) or "none"))
    if not all(0 < value < np.inf for value in given.values()):
        name, value = next(iter(given.items()))
        raise InputError(f"{name}: expected a number above 0, found {value:g}")
    if not isinstance(recovery, str) or recovery not in ("least-squares", "projection"):
        said = repr(recovery) if isinstance(recovery, str) else type(recovery).__name__
        raise InputError(f"recovery: expected 'least-squares' or 'projection', found {said}")
    values = floats(u, "u")
    if values.ndim == 0 or len(values) != len(mesh.points):
        raise InputError(f"u: expected {len(mesh.points)} rows, one for each vertex, found shape "
                         f"{values.shape}")
    finite(values, "u")
    options = _ductile.SolutionMetricOptions(
        norm=number(norm, "norm"), complexity=given.get("complexity", 0.0),
        elements=given.get("elements", 0.0), error=given.get("error", 0.0),
        bounds=_ductile.SizeBounds(number(hmin, "hmin"), number(hmax, "hmax"),
                                   number(anisotropy, "anisotropy")),
        gradation=number(hgrad, "hgrad"), projection=recovery == "projection")
    rows = values.reshape(len(values), component_count(values.shape))
    with named(mesh._data.cell_dimension):
        tensors, fit = _ductile.solution_metric(mesh._data, rows, options, executor(threads))
    if not fit.reached:
        warn(["no metric within the bounds is what was asked for; the nearest found has the complexity "
              f"{fit.complexity:.6g}"])
    return tensors


def implied(mesh: Mesh) -> np.ndarray:
    """The metric that a mesh is adapted to already, stretched as it is, ``(n, 3)`` or ``(n, 6)``."""
    return _ductile.implied(mesh_data(mesh, "mesh"))


def sizes(M: np.ndarray) -> np.ndarray:
    """The sizes that a metric asks for at each vertex, ``(n, d)``, the smallest first."""
    values = np.linalg.eigvalsh(finite(full(M), "M"))[:, ::-1]
    if not (values > 0).all():
        at = int(np.argmin((values > 0).all(axis=1)))
        raise InputError(f"M[{at}]: expected a positive definite tensor, found the eigenvalues "
                         f"{values[at].tolist()}")
    return 1 / np.sqrt(values)


# ---- What is done to them ----

def intersect(A: MetricLike, B: MetricLike, *more: MetricLike) -> np.ndarray:
    """The finest sizes that either of two or more metrics asks for.

    Parameters
    ----------
    A, B, *more : (n,), (n, 3), (n, 6) or (n, d, d) array_like
        Metrics of one mesh, or sizes.

    Returns
    -------
    ndarray
        Tensors; sizes ``(n,)`` if all are sizes.
    """
    if len(more) > 24:
        raise InputError(f"intersect: expected at most 26 metrics, found {len(more) + 2}")
    arrays = [floats(a, name) for a, name in zip((A, B, *more), "ABCDEFGHIJKLMNOPQRSTUVWXYZ")]
    for name, array in zip("ABCDEFGHIJKLMNOPQRSTUVWXYZ", arrays):
        if array.ndim not in (1, 2, 3):
            raise InputError(f"{name}: expected sizes or tensors in rows, found shape {array.shape}")
        finite(array, name)
        if array.ndim == 1 and not (array > 0).all():
            at = int(np.argmin(array > 0))
            raise InputError(f"{name}[{at}]: expected a size above 0, found {array[at]}")
    for name, array in zip("BCDEFGHIJKLMNOPQRSTUVWXYZ", arrays[1:]):
        if len(array) != len(arrays[0]):
            raise InputError(f"{name}: expected {len(arrays[0])} rows, as A has, found {len(array)}")
    if all(array.ndim == 1 for array in arrays):
        return np.minimum.reduce(arrays)
    tensors = [packed(array) for array in arrays if array.ndim > 1]
    dimension = _dimension_of(tensors[0], "A")
    for array in arrays:
        if array.ndim == 1:
            tensors.append(packed(np.eye(dimension) / array[:, None, None]**2))
    result = tensors[0]
    for other in tensors[1:]:
        if other.shape != result.shape:
            raise InputError(f"B: expected shape {result.shape}, as A has, found {other.shape}")
        result = _ductile.intersect(result, other)
    return result


def bound(M: np.ndarray, *, hmin: float = 0, hmax: float = 0, anisotropy: float = 0) -> np.ndarray:
    """The metric with its sizes clamped between bounds; 0 is no bound.

    With `anisotropy`, the longest size at a vertex is at most so many times the shortest.
    """
    bounds = _ductile.SizeBounds(number(hmin, "hmin"), number(hmax, "hmax"),
                                 number(anisotropy, "anisotropy"))
    return _ductile.bound(finite(packed(M), "M"), bounds)


def grade(mesh: Mesh, M: MetricLike, factor: float = 1.3) -> np.ndarray:
    """The metric made finer where sizes grow by more than `factor` per unit of metric length."""
    data = mesh_data(mesh, "mesh")
    return _ductile.grade(data, as_tensors(mesh, M), number(factor, "factor"))


def complexity(mesh: Mesh, M: MetricLike) -> float:
    """The integral of sqrt(det M); a mesh adapted to M has about 2.25 triangles or 9.5 tetrahedra
    for each unit of it."""
    data = mesh_data(mesh, "mesh")
    return _ductile.measure(data, as_tensors(mesh, M)).complexity
