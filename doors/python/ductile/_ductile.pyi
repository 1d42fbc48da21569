"""The C++ library as it is; use the package around it."""

from typing import Any, Callable, Optional, Sequence

import numpy as np
from numpy.typing import NDArray

_Floats = NDArray[np.float64]
_Ints = NDArray[np.int32]

version: str
of_facets: int
of_cells: int

class Error(RuntimeError):
    """Something outside failed: memory, the disk, a result that is not valid."""

class InputError(Error, ValueError):
    """An array, a file or an option is wrong."""

class Cancelled(Error):
    """The progress function has returned False."""

class Executor:
    threads: int
    def __init__(self, threads: int = ...) -> None: ...

class FieldType:
    scalar: FieldType
    vector: FieldType
    symmetric: FieldType
    matrix: FieldType

class MeshData:
    dimension: int
    dropped_axis: int
    names: list[tuple[str, int, int]]
    @property
    def cell_dimension(self) -> int: ...
    @property
    def points(self) -> _Floats: ...
    @property
    def cells(self) -> _Ints: ...
    @property
    def facets(self) -> _Ints: ...
    @property
    def edges(self) -> _Ints: ...
    @property
    def refs(self) -> _Ints: ...
    @property
    def facet_refs(self) -> _Ints: ...
    @property
    def edge_refs(self) -> _Ints: ...
    @property
    def vertex_refs(self) -> _Ints: ...
    @property
    def address(self) -> int: ...
    def copy(self) -> MeshData: ...
    def set_edges(self, edges: _Ints, refs: _Ints) -> None: ...
    def required(self, kind: str) -> _Ints: ...
    def require(self, kind: str, indices: _Ints) -> None: ...

class Distribution:
    count: int
    min: float
    low: float
    median: float
    mean: float
    max: float
    histogram_from: float
    histogram_to: float
    histogram: list[int]
    below: int
    above: int

class Statistics:
    in_metric: bool
    edge_length: Distribution
    quality: Distribution
    edges_in_range: int
    edges_short: int
    edges_long: int
    complexity: float
    share_in_range: float

class KernelReport:
    seconds: float
    considered: int
    applied: int
    rounds: int

class Report:
    iterations: int
    converged: bool
    kernels: tuple[str, ...]
    coarsen: KernelReport
    refine: KernelReport
    swap: KernelReport
    smooth: KernelReport
    setup_seconds: float
    renumber_seconds: float
    total_seconds: float
    fixed_vertices: int
    curved_edges: int
    curved_edges_short: int
    held_long_edges: int
    held_short_edges: int
    attempts: int
    warnings: list[str]
    instructions: str

class Options:
    iterations: int
    smallest_size: float
    largest_size: float
    gradation: float
    curved_sizes: bool
    required_gradation: float
    memory_limit: int
    thorough: bool
    move: bool
    swap: bool
    insert: bool
    lock_boundary: bool
    hausdorff_tolerance: float
    geometry: Optional[GeometryData]
    ridge_angle: float

class GeometryData:
    def __init__(self, mesh: MeshData, tolerance: float, ridge_angle: float,
                 surfaces: Sequence[tuple[int, Callable]], threads: Executor) -> None: ...
    dimension: int
    tolerance: float
    def closest(self, points: _Floats, reach: float,
                threads: Executor) -> tuple[_Floats, _Floats, _Ints]: ...

class CutReport:
    level: float
    minus_volume: float
    interface_facets: int
    cut_elements: int
    moved_vertices: int
    removed_components: int
    removed_volume: float
    warnings: list[str]

class CutOptions:
    def __init__(self, level: float, references: tuple[int, int, int],
                 materials: Sequence[tuple[int, bool, int, int]], least_component: float,
                 keep_volume: Optional[float]) -> None: ...

class CutData:
    mesh: MeshData
    value: _Floats
    vertex_origins: tuple[_Ints, _Floats]
    cell_origins: _Ints
    facet_origins: _Ints
    report: CutReport
    def metric(self, metric: Optional[_Floats], threads: Executor) -> _Floats: ...
    def add_surface(self, options: Options, threads: Executor) -> None: ...

class SizeBounds:
    def __init__(self, smallest: float = ..., largest: float = ...,
                 anisotropy: float = ...) -> None: ...

class SizeGrowth:
    def __init__(self, grow: float, largest: float, distance: float) -> None: ...

class MetricFit:
    complexity: float
    error: float
    reached: bool

class MoveOptions:
    bodies: Sequence[int]
    boundaries: Sequence[int]
    remesh_below: float
    turned: Sequence[str]
    keep_partial: bool
    smallest_size: float
    largest_size: float
    gradation: float
    def __init__(self) -> None: ...
class MoveReport:
    share: float
    steps: int
    adaptations: int
    adapted_elements: int
    worst_quality: float
    adapt_seconds: float
    total_seconds: float
    stopped: str
    warnings: list[str]
class TransferReport:
    vertices_outside: int
    volume_outside: float
    volume_left_out: float

class SolutionMetricOptions:
    def __init__(self, *, norm: float, complexity: float, error: float, bounds: SizeBounds,
                 gradation: float, projection: bool) -> None: ...

class Sizes:
    count: int
    def __init__(self, elsewhere: float, bounds: SizeBounds) -> None: ...
    def ball(self, centre: Sequence[float], radius: float, size: float,
             growth: SizeGrowth) -> None: ...
    def box(self, low: Sequence[float], high: Sequence[float], size: float,
            growth: SizeGrowth) -> None: ...
    def curve(self, points: _Floats, size: float, growth: SizeGrowth) -> None: ...
    def surface(self, points: _Floats, triangles: _Ints, size: float,
                growth: SizeGrowth) -> None: ...
    def referenced(self, dimension: int, reference: int, size: float,
                   growth: SizeGrowth) -> None: ...
    def named(self, name: str, size: float, growth: SizeGrowth) -> None: ...
    def at(self, mesh: MeshData, threads: Executor) -> _Floats: ...

def from_arrays(points: _Floats, vertex_refs: _Ints, cells: tuple[NDArray[Any], _Ints],
                facets: tuple[NDArray[Any], _Ints]) -> MeshData: ...
def box(extent: Sequence[float], cells: Sequence[int]) -> MeshData: ...
def read(path: str) -> tuple[MeshData, list[tuple[str, bool, _Floats]], list[str]]: ...
def read_field(path: str) -> tuple[list[_Floats], list[str]]: ...
def save(mesh: MeshData, path: str,
         fields: Sequence[tuple[str, FieldType, bool, _Floats]]) -> list[str]: ...
def save_field(path: str, values: _Floats, type: FieldType, dimension: int) -> None: ...
def holds_fields(path: str) -> bool: ...
def formats() -> list[tuple[str, str, bool, bool]]: ...
def check(mesh: MeshData) -> list[str]: ...
def join_vertices(mesh: MeshData, tolerance: float) -> tuple[MeshData, np.ndarray]: ...
def check_adapted(before: MeshData, after: MeshData, tolerance: float) -> list[str]: ...
def measure(mesh: MeshData, metric: Optional[_Floats]) -> Statistics: ...
def quality(mesh: MeshData, metric: Optional[_Floats]) -> _Floats: ...
def remesh(mesh: MeshData, metric: Optional[tuple[_Floats, FieldType]], options: Options,
           threads: Executor, progress: Optional[Callable[[str, int, int], Optional[bool]]],
           ) -> tuple[MeshData, _Floats, Report]: ...
def remesh_to_sizes(mesh: MeshData, sizes: Sizes, options: Options, threads: Executor,
                    progress: Optional[Callable[[str, int, int], Optional[bool]]],
                    ) -> tuple[MeshData, _Floats, Report]: ...
def refine_to_level_set(mesh: MeshData, metric: Optional[tuple[_Floats, FieldType]],
                        function: Callable[[_Floats], _Floats], tolerance: float, smallest: float,
                        threads: Executor) -> tuple[MeshData, _Floats, Report]: ...
def cut(mesh: MeshData, values: _Floats, options: CutOptions, threads: Executor) -> CutData: ...
def move(mesh: MeshData, displacement: _Floats,
         carried: tuple[Optional[tuple[_Floats, FieldType]],
                        Sequence[tuple[str, FieldType, bool, _Floats]], bool],
         options: MoveOptions, threads: Executor) -> tuple[MeshData, _Floats, list[_Floats], MoveReport]: ...
def solution_metric(mesh: MeshData, values: _Floats, options: SolutionMetricOptions,
                    threads: Executor) -> tuple[_Floats, MetricFit]: ...
def implied(mesh: MeshData) -> _Floats: ...
def default_metric(mesh: MeshData) -> _Floats: ...
def as_metric(mesh: MeshData, rows: _Floats, type: FieldType, bounds: SizeBounds) -> _Floats: ...
def intersect(a: _Floats, b: _Floats) -> _Floats: ...
def bound(metric: _Floats, bounds: SizeBounds) -> _Floats: ...
def grade(mesh: MeshData, metric: _Floats, factor: float) -> _Floats: ...
def origins(before: MeshData, after: MeshData) -> tuple[_Ints, _Ints, _Ints, _Ints, _Floats]: ...
def transfer(before: MeshData, after: MeshData, values: _Floats,
             how: tuple[FieldType, bool, bool], threads: Executor) -> tuple[_Floats, TransferReport]: ...
def signed_distance(mesh: MeshData, inside: Sequence[int], tolerance: float, ridge_angle: float,
                    points: Optional[_Floats], threads: Executor) -> _Floats: ...
def interpolate_at(mesh: MeshData, values: _Floats, points: _Floats) -> _Floats: ...
