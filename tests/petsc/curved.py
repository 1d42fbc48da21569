"""Curved boundaries, and an interface that nobody has labelled, are measured from the mesh that is composed
as "ductile_geometry", on all ranks and in all calls: vertices stay on the true circles and spheres. Prints digests, which separate_runs.sh compares."""

from support import *


def ball(dim, n):
    """The unit ball: cubes around its centre become spheres."""
    points, cells = box(dim, 2 * n)
    points = 2 * points - 1
    largest = abs(points).max(axis=1)
    scale = largest / np.maximum(np.linalg.norm(points, axis=1), 1e-300)
    return points * scale[:, None], cells


def boundary_vertices(dm):
    """[vertex] Those of facets of one cell, which no other rank has."""
    first, found = dm.getDepthStratum(0)[0], set()
    for facet in own_points(dm, *dm.getHeightStratum(1)):
        if dm.getLabelValue("Face Sets", facet) == 1:
            found |= {p - first for p in dm.getTransitiveClosure(facet)[0] if p < dm.getDepthStratum(0)[1] and p >= first}
    return sorted(found)


def label_surface(dm):
    dm.createLabel("Face Sets")
    for facet in range(*dm.getHeightStratum(1)):
        if dm.getSupportSize(facet) == 1:
            dm.setLabelValue("Face Sets", facet, 1)


def label_core(dm):
    dm.createLabel("Cell Sets")
    for cell in range(*dm.getHeightStratum(0)):
        dm.setLabelValue("Cell Sets", cell, 1 if np.linalg.norm(centroid(dm, cell)) < 0.5 else 2)


def interface_vertices(dm):
    """[vertex] Those of facets between two regions of this rank."""
    begin, end = dm.getDepthStratum(0)
    found = set()
    for facet in range(*dm.getHeightStratum(1)):
        if len({dm.getLabelValue("Cell Sets", c) for c in dm.getSupport(facet)}) == 2:
            found |= {p - begin for p in dm.getTransitiveClosure(facet)[0] if begin <= p < end}
    return sorted(found)


def facet_count(dm):
    facets = own_points(dm, *dm.getHeightStratum(1))
    return int(total(float(sum(dm.getLabelValue("Face Sets", f) == 1 for f in facets))))


measure_of_ball = {2: np.pi, 3: 4 * np.pi / 3}
for dim, n, tolerance, coarse in ((2, 24, 0.004, 0.3), (3, 6, 0.02, 0.5)):
    dm = plex(*ball(dim, n))
    label_surface(dm)
    label_core(dm)
    dm = distributed(dm)
    before = facet_count(dm)
    dm.compose("ductile_geometry", dm.clone())
    for call in range(4):
        dm.metricSetHausdorffNumber(tolerance)
        at = 0.4 * np.array([np.cos(call), np.sin(call), 0][:dim])
        size = lambda x: np.minimum(0.1 * dim / 2 + 0.3 * np.linalg.norm(x - at, axis=1), coarse)
        dm = dm.adaptMetric(metric_vector(dm, diagonal(*[size] * dim)), "Face Sets", "Cell Sets")
    check_plex(dm)
    x = coordinates(dm)[boundary_vertices(dm)]
    off = abs(np.linalg.norm(x, axis=1) - 1).max() if len(x) else 0.0
    expect(off < 0.1 * tolerance, f"{dim}D: a vertex of the boundary is {off} from the true one")
    x = coordinates(dm)[interface_vertices(dm)]
    inside = abs(np.linalg.norm(x, axis=1) - 0.5).max() if len(x) else 0.0
    expect(inside < 0.1 * tolerance, f"{dim}D: a vertex of the interface is {inside} from the true one")
    expect(total(float(len(x))) > 10, f"{dim}D: the interface is gone")
    after = facet_count(dm)
    expect(after < 0.8 * before, f"{dim}D: {before} facets became {after}, which is not coarser")
    volume = total(sum(dm.computeCellGeometryFVM(c)[0] for c in own_points(dm, *dm.getHeightStratum(0))))
    lost = 1 - volume / measure_of_ball[dim]
    expect(abs(lost) < dim * 2 * tolerance, f"{dim}D: {lost} of the ball is lost")
    begins = gathered(float(int(digest(dm)[:12], 16)))
    off, cells = gathered(off).max(), int(cell_counts(dm).sum())
    if rank == 0:
        print(f"{dim}D: {cells} cells, {after} facets of {before}, off by {off:.2e},",
              f"{lost:.2e} lost,", *[f"{int(begin):012x}" for begin in begins], flush=True)
