"""What the tests of the PETSc adaptor share: meshes, metrics, and what is measured of meshes.

Sums over ranks are made by vectors of PETSc's, so that petsc4py is all that is needed.
"""

import ctypes
import hashlib
import itertools
import sys

import numpy as np
import petsc4py

petsc4py.init(sys.argv)
from petsc4py import PETSc  # noqa: E402

world = PETSc.COMM_WORLD
rank, ranks = world.getRank(), world.getSize()
options = PETSc.Options()


def total(value):
    """The sum of a number of each rank."""
    return gathered(value).sum()


def gathered(value):
    """[rank] A number of each rank, as all of them know it."""
    vector = PETSc.Vec().createMPI((1, ranks), comm=world)
    vector.array[:] = value
    scatter, everything = PETSc.Scatter.toAll(vector)
    scatter.scatter(vector, everything, False, PETSc.Scatter.Mode.FORWARD)
    return everything.array.copy()


def expect(truth, message):
    """Ends the program on all ranks if something is not as it should be on any."""
    failed = gathered(0.0 if truth else 1.0)
    if failed.any():
        if not truth:
            print(f"rank {rank} of {ranks}: {message}", file=sys.stderr, flush=True)
        world.barrier()
        sys.exit(1)


# ---- Meshes ----


def box(dim, n):
    """Vertices and cells of the unit box, n edges along each side; cells cube by cube."""
    axis = np.linspace(0, 1, n + 1)
    points = np.stack(np.meshgrid(*[axis] * dim, indexing="ij")[::-1], -1).reshape(-1, dim)
    step = [(n + 1) ** d for d in range(dim)]
    first = sum(np.meshgrid(*[np.arange(n) * s for s in step], indexing="ij")).ravel()
    cells = []
    for order in itertools.permutations(range(dim)):
        corner = [first]
        for d in order:
            corner.append(corner[-1] + step[d])
        cell = np.array(corner).T
        edges = points[cell[0, 1:]] - points[cell[0, 0]]
        if (np.linalg.det(edges) > 0) != (dim == 2):  # PETSc's tetrahedra are turned the other way
            cell[:, [1, 2]] = cell[:, [2, 1]]
        cells.append(cell)
    return points, np.stack(cells, 1).reshape(-1, dim + 1)


def plex(points, cells):
    """A DMPlex of what rank 0 has, all of it there."""
    dim = points.shape[1]
    if rank:
        points, cells = points[:0], cells[:0]
    return PETSc.DMPlex().createFromCellList(dim, cells.astype(PETSc.IntType), points)


def centroid(dm, point):
    return dm.computeCellGeometryFVM(point)[1]


def label_box(dm, region=lambda x: 1 + int(x[0] > 0.5)):
    """Sides of the unit box are Face Sets 1 and up, facets between regions 99, regions Cell Sets."""
    dim = dm.getDimension()
    for name in ("Face Sets", "Cell Sets"):
        dm.createLabel(name)
    for cell in range(*dm.getHeightStratum(0)):
        dm.setLabelValue("Cell Sets", cell, region(centroid(dm, cell)))
    for facet in range(*dm.getHeightStratum(1)):
        if dm.getSupportSize(facet) == 1:
            x = centroid(dm, facet)
            side = [d for d in range(2 * dim) if abs(x[d // 2] - d % 2) < 1e-9][0]
            dm.setLabelValue("Face Sets", facet, 1 + side)
        elif len({dm.getLabelValue("Cell Sets", c) for c in dm.getSupport(facet)}) == 2:
            dm.setLabelValue("Face Sets", facet, 99)


lines_of_box = {7: (0, 0), 8: (1 / 3, 0.5), 9: (0.5, 2 / 3)}  # [Edge Set] x and y


def label_lines(dm):
    """Edge Sets of lines along the box: an edge of it, one inside of a region, one between regions."""
    first, x = dm.getDepthStratum(0)[0], coordinates(dm)
    dm.createLabel("Edge Sets")
    for edge in range(*dm.getDepthStratum(1)):
        ends = x[dm.getCone(edge) - first]
        for value, line in lines_of_box.items():
            if np.allclose(ends[:, :2], line):
                dm.setLabelValue("Edge Sets", edge, value)


def line_lengths(dm):
    """{Edge Set: length} of all ranks together; each edge must be on its line."""
    first, x = dm.getDepthStratum(0)[0], coordinates(dm)
    found = dict.fromkeys(lines_of_box, 0.0)
    for edge in own_points(dm, *dm.getDepthStratum(1)):
        value = dm.getLabelValue("Edge Sets", edge)
        if value in found:
            ends = x[dm.getCone(edge) - first]
            found[value] += np.linalg.norm(ends[1] - ends[0])
            found[value] += 1e3 * abs(ends[:, :2] - lines_of_box[value]).max()
    return {value: total(length) for value, length in found.items()}


def distributed(dm, overlap=0):
    """By the order of the cells: PETSc's own choice, PT-Scotch, gives other parts each time."""
    if dm.getComm().getSize() > 1:
        dm.getPartitioner().setType("simple")
        dm.distribute(overlap=overlap)
    return dm


# ---- Metrics ----


def coordinates(dm):
    return dm.getCoordinatesLocal().array.reshape(-1, dm.getCoordinateDim())


def metric_vector(dm, tensor_at):
    """The local vector of a metric, which is an array [vertex, dim, dim] of coordinates."""
    values = np.ascontiguousarray(tensor_at(coordinates(dm))).ravel()
    return PETSc.Vec().createWithArray(values, comm=PETSc.COMM_SELF)


def diagonal(*size_of):
    """The metric of sizes along the axes: functions of coordinates [vertex, dim]."""

    def tensor_at(x):
        metric = np.zeros((len(x), len(size_of), len(size_of)))
        for d, size in enumerate(size_of):
            metric[:, d, d] = size(x) ** -2.0
        return metric

    return tensor_at


# ---- What is measured ----


def own_points(dm, begin, end):
    """Those of a stratum that no other rank owns."""
    leaves = set()
    if dm.getComm().getSize() > 1:
        _, local, remote = dm.getPointSF().getGraph()
        if remote is not None:
            leaves = set(range(len(remote)) if local is None else local.tolist())
    return [p for p in range(begin, end) if p not in leaves]


def measures(dm, face_sets, cell_sets):
    """{set: area or volume} of all ranks together."""
    found = {("face", s): 0.0 for s in face_sets} | {("cell", s): 0.0 for s in cell_sets}
    for height, kind, name in ((0, "cell", "Cell Sets"), (1, "face", "Face Sets")):
        for point in own_points(dm, *dm.getHeightStratum(height)):
            key = (kind, dm.getLabelValue(name, point))
            if key in found:
                found[key] += dm.computeCellGeometryFVM(point)[0]
    return {key: total(value) for key, value in sorted(found.items())}


def cell_counts(dm):
    """[rank] Cells that are not another's."""
    return gathered(float(len(own_points(dm, *dm.getHeightStratum(0))))).astype(int)


def check_plex(dm):
    """DMPlexCheck(), which petsc4py does not have."""
    library = ctypes.CDLL("libpetsc_real.so")
    expect(library.DMPlexCheck(ctypes.c_void_p(dm.handle)) == 0, "DMPlexCheck has failed")


def corners_of(dm):
    """[cell, corner] Vertices of the cells, counted from the first vertex."""
    begin, end = dm.getDepthStratum(0)
    cells = []
    for cell in range(*dm.getHeightStratum(0)):
        closure = dm.getTransitiveClosure(cell)[0]
        cells.append([p - begin for p in closure if begin <= p < end])
    return np.array(cells, dtype=int).reshape(-1, dm.getDimension() + 1)


def digest(dm):
    """A number that is the same if this rank's mesh is, bit for bit."""
    hashed = hashlib.sha256(coordinates(dm).tobytes())
    for point in range(*dm.getChart()):
        hashed.update(dm.getCone(point).tobytes())
        hashed.update(dm.getConeOrientation(point).tobytes())
    for index in range(dm.getNumLabels()):
        name = dm.getLabelName(index)
        if name.endswith("Sets"):
            for value in sorted(dm.getLabelIdIS(name).indices.tolist()):
                points = dm.getStratumIS(name, value).indices
                hashed.update(name.encode() + bytes(str(value), "ascii") + points.tobytes())
    graph = dm.getPointSF().getGraph() if ranks > 1 else ()
    for part in graph:
        if part is not None:
            hashed.update(np.asarray(part).tobytes())
    return hashed.hexdigest()


def integral(dm, values, on_cells=False):
    """Of each component of a local vector, over all ranks of the mesh."""
    x, cells = coordinates(dm), corners_of(dm)
    dim = dm.getDimension()
    values = values.array.reshape(len(cells) if on_cells else len(x), -1)
    own = [p - dm.getHeightStratum(0)[0] for p in own_points(dm, *dm.getHeightStratum(0))]
    p = x[cells[own]]
    volume = np.abs(np.linalg.det(p[:, 1:] - p[:, :1])) / (2 if dim == 2 else 6)
    at = values[own] if on_cells else values[cells[own]].mean(axis=1)
    return np.array([total(float(s)) for s in (volume[:, None] * at).sum(axis=0)])


def local(array):
    return PETSc.Vec().createWithArray(np.ascontiguousarray(array).ravel(), comm=PETSc.COMM_SELF)


def quality(dm, tensor_at):
    """Edges in range, edges, and the worst and mean quality of the cells, in a metric, of all ranks.

    Quality is the mean ratio in the mean of the metrics at a cell's corners.
    """
    dim = dm.getDimension()
    x, cells = coordinates(dm), corners_of(dm)
    metric = tensor_at(x)
    pairs = list(itertools.combinations(range(dim + 1), 2))
    mean = metric[cells].mean(axis=1)
    p = x[cells]
    volume = np.abs(np.linalg.det(p[:, 1:] - p[:, :1])) * np.sqrt(np.linalg.det(mean))
    squares = sum(
        np.einsum("ci,cij,cj->c", p[:, a] - p[:, b], mean, p[:, a] - p[:, b]) for a, b in pairs
    )
    if dim == 2:
        shape = 2 * np.sqrt(3) * volume / squares
    else:
        shape = 12 * np.cbrt(volume / 2) ** 2 / squares
    edges = []
    for point in own_points(dm, *dm.getDepthStratum(1)):
        edges.append(dm.getCone(point) - dm.getDepthStratum(0)[0])
    edges = np.array(edges, dtype=int).reshape(-1, 2)
    e = x[edges[:, 1]] - x[edges[:, 0]]
    a, b = (np.sqrt(np.einsum("ei,eij,ej->e", e, metric[edges[:, k]], e)) for k in (0, 1))
    same = np.abs(a - b) < 1e-6 * a
    length = np.where(same, a, (a - b) / np.where(same, 1, np.log(a / b)))
    good = total(float(((length >= 2**-0.5) & (length <= 2**0.5)).sum()))
    count = total(float(len(length)))
    worst = gathered(shape.min() if len(shape) else 1.0).min()
    average = total(float(shape.sum())) / total(float(len(shape)))
    return {
        "cells": int(cell_counts(dm).sum()),
        "in range": good / count,
        "worst": worst,
        "mean": average,
        "longest": gathered(length.max() if len(length) else 0.0).max(),
    }
