"""Statistics and reports as text."""

from __future__ import annotations

from typing import TYPE_CHECKING, Optional

from . import _ductile
from ._build import mesh_data
from ._metric import MetricLike

if TYPE_CHECKING:
    from ._mesh import Mesh


class Info:
    """Counts, edge lengths and quality of a mesh; `print` shows them.

    Attributes
    ----------
    dim, vertices, cells, facets : int
        Dimension and counts.
    edge_length, quality : Distribution
        With `count`, `min`, `low` (1 % are at most this), `median`, `mean`, `max`, `histogram`. Lengths
        are metric lengths if there is a metric; quality is the mean ratio, 1 for ideal elements.
    share_in_range : float
        The share of edges that are from 1/sqrt(2) to sqrt(2) long in the metric.
    complexity : float
        Of the metric.
    """

    def __init__(self, mesh: Mesh, statistics: _ductile.Statistics) -> None:
        self.dim = mesh.dim
        self._cell_dimension = mesh._data.cell_dimension
        self.vertices = len(mesh.points)
        self.cells = len(mesh.cells)
        self.facets = len(mesh.facets)
        self.in_metric = statistics.in_metric
        self.edge_length = statistics.edge_length
        self.quality = statistics.quality
        self.share_in_range = statistics.share_in_range
        self.edges_short = statistics.edges_short
        self.edges_long = statistics.edges_long
        self.complexity = statistics.complexity

    def __str__(self) -> str:
        cells, facets = cell_names(self._cell_dimension)
        lines = [", ".join((_counted(self.vertices, "vertices"), _counted(self.cells, cells),
                            _counted(self.facets, facets))),
                 _figures("edge length" if self.in_metric else "edge, plain", self.edge_length),
                 _figures("quality", self.quality)]
        if self.in_metric:
            lines.insert(2, f"  {self.share_in_range:.2%} of {self.edge_length.count:,} edges in "
                            f"[0.71, 1.41], {self.edges_short:,} shorter, {self.edges_long:,} longer")
            lines.append(f"  complexity of the metric {self.complexity:.6g}")
        return "\n".join(lines)

    __repr__ = __str__


_ONE = {"vertices": "vertex", "triangles": "triangle", "tetrahedra": "tetrahedron", "edges": "edge"}


def _counted(count: int, many: str) -> str:
    return f"{count:,} {_ONE[many] if count == 1 else many}"


def cell_names(dimension: int) -> tuple[str, str]:
    """What cells and facets are called in a dimension."""
    return ("triangles", "edges") if dimension == 2 else ("tetrahedra", "triangles")


def _figures(name: str, d: _ductile.Distribution) -> str:
    return (f"  {name:12} min {d.min:.4g}, 1 % below {d.low:.4g}, median {d.median:.4g}, "
            f"mean {d.mean:.4g}, max {d.max:.4g}")


def info(mesh: Mesh, M: Optional[MetricLike] = None) -> Info:
    """Counts, edge lengths and quality of a mesh.

    Parameters
    ----------
    mesh : Mesh
    M : metric or size, optional
        To measure in; by default the metric that the mesh was adapted to, or plain lengths if it was
        not. A metric of the mesh that it was adapted from is carried over.

    Returns
    -------
    Info
    """
    data = mesh_data(mesh, "mesh")
    return Info(mesh, _ductile.measure(data, mesh._tensors(M)))


def _report_text(report: _ductile.Report) -> str:
    lines = [f"{'converged' if report.converged else 'not converged'} after {report.iterations} "
             f"{'round' if report.iterations == 1 else 'rounds'} in {report.total_seconds:.3g} s"]
    for name in report.kernels:
        kernel = getattr(report, name)
        lines.append(f"  {name:8} {kernel.seconds:8.3f} s  {kernel.applied:,} times")
    if report.held_long_edges or report.held_short_edges:
        lines.append(f"  required entities hold {report.held_long_edges:,} edges that are too long "
                     f"and {report.held_short_edges:,} that are too short")
    return "\n".join(lines + [f"  warning: {line}" for line in report.warnings])


for _method in ("__str__", "__repr__"):
    setattr(_ductile.Report, _method, _report_text)
