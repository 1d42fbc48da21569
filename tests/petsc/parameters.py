"""Parameters that are set on the DM hold: they are read from there, as PETSc's other adaptors do."""

from support import *


def adapted(size=0.1, n=10, **parameters):
    dm = plex(*box(2, n))
    label_box(dm)
    dm = distributed(dm)
    for name, value in parameters.items():
        getattr(dm, "metricSet" + name)(value)
    metric = metric_vector(dm, diagonal(*[lambda x: np.full(len(x), size) + 0 * x[:, 0]] * 2))
    result = dm.adaptMetric(metric, "Face Sets", "Cell Sets")
    check_plex(result)
    return dm, result


def places(dm):
    """The places of all vertices, in order, of this rank."""
    return sorted(map(tuple, coordinates(dm).round(12)))


def vertex_count(dm):
    return int(total(float(len(own_points(dm, *dm.getDepthStratum(0))))))


dm, result = adapted(0.03, NoInsertion=True, NoSwapping=True, NoMovement=True)
expect(vertex_count(result) == vertex_count(dm), "nothing may change, but vertices did")
if ranks == 1:
    expect(places(result) == places(dm), "nothing may change, but places did")

dm, result = adapted(0.03, NoInsertion=True)
expect(vertex_count(result) == vertex_count(dm), "vertices were inserted")

dm, result = adapted(0.03, NoSurf=True)
for name, stratum in (("before", dm), ("after", result)):
    pass
faces = [
    sum(1 for f in own_points(d, *d.getHeightStratum(1)) if 1 <= d.getLabelValue("Face Sets", f) <= 4)
    for d in (dm, result)
]
faces = [total(float(count)) for count in faces]
expect(faces[0] == faces[1], f"boundary facets changed: {faces}")
expect(vertex_count(result) > 2 * vertex_count(dm), "the inside was not adapted")

free = vertex_count(adapted(0.02)[1])
bounded = vertex_count(adapted(0.02, MinimumMagnitude=0.06)[1])
expect(bounded < free / 3, f"the smallest size does not hold: {bounded} of {free} vertices")
coarse = vertex_count(adapted(0.5)[1])
bounded = vertex_count(adapted(0.5, MaximumMagnitude=0.1)[1])
expect(bounded > 3 * coarse, f"the largest size does not hold: {bounded}, {coarse} vertices")


def graded(factor):
    dm = plex(*box(2, 20))
    label_box(dm)
    dm = distributed(dm)
    dm.metricSetGradationFactor(factor)
    jump = lambda x: np.where(x[:, 0] < 0.5, 0.02, 0.3)
    return vertex_count(dm.adaptMetric(metric_vector(dm, diagonal(jump, jump)), "Face Sets"))


slow, fast = graded(1.1), graded(2.0)
expect(slow > 1.1 * fast, f"gradation does not hold: {slow}, {fast} vertices")
