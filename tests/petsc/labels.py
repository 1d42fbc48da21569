"""Labels of cells, facets, edges and vertices; tagged lines inside of a region; an annulus, whose facets stay
where they are; DMAdaptLabel."""

from support import *

# A line inside of one region, and a vertex on it that has a name.
dm = plex(*box(2, 12))
label_box(dm, region=lambda x: 7)
dm.createLabel("Vertex Sets")
for facet in range(*dm.getHeightStratum(1)):
    x = centroid(dm, facet)
    if dm.getSupportSize(facet) == 2 and abs(x[1] - 0.5) < 1e-9 and 0.25 < x[0] < 0.75:
        dm.setLabelValue("Face Sets", facet, 42)
first = dm.getDepthStratum(0)[0]
for v, x in enumerate(coordinates(dm)):
    if np.allclose(x, (0.75, 0.25)):
        dm.setLabelValue("Vertex Sets", first + v, 5)
dm = distributed(dm)
fine = lambda x: 0.02 + 0.2 * abs(x[:, 0] + x[:, 1] - 1)
adapted = dm.adaptMetric(metric_vector(dm, diagonal(fine, fine)), "Face Sets", "Cell Sets")
check_plex(adapted)
expect(abs(measures(adapted, [42], [7])["face", 42] - 0.5) < 1e-9, "the line has changed")
expect(abs(measures(adapted, [42], [7])["cell", 7] - 1) < 1e-9, "the region has changed")
first = adapted.getDepthStratum(0)[0]
named = [
    v for v in own_points(adapted, *adapted.getDepthStratum(0))
    if adapted.getLabelValue("Vertex Sets", v) == 5
]
expect(total(float(len(named))) == 1, "the named vertex is not there, or too often")
for v in named:
    expect_here = np.allclose(coordinates(adapted)[v - first], (0.75, 0.25), atol=0)
    if not expect_here:
        print("the named vertex has moved", file=sys.stderr)
        sys.exit(1)

# Lines of edges in 3D: where two sides meet, inside of a region, and between regions.
dm = plex(*box(3, 6))
label_box(dm)
label_lines(dm)
dm = distributed(dm)
expect(all(abs(length - 1) < 1e-12 for length in line_lengths(dm).values()), "lines are not there")
for call in range(2):
    size = lambda x: 0.06 + 0.3 * abs(x[:, 2] - 0.3 - 0.4 * call)
    dm = dm.adaptMetric(metric_vector(dm, diagonal(size, size, size)), "Face Sets", "Cell Sets")
    check_plex(dm)
    for value, length in line_lengths(dm).items():
        expect(abs(length - 1) < 1e-9, f"call {call}: line {value} is {length} long")

# An annulus keeps its facets, so that its sets keep their measures to the last digits.
around, across = 40, 5
angle = 2 * np.pi * np.arange(around) / around
radius = np.linspace(0.5, 1, across + 1)
points = np.array([(r * np.cos(a), r * np.sin(a)) for r in radius for a in angle])
cells = []
for j in range(across):
    for i in range(around):
        a, b = j * around + i, j * around + (i + 1) % around
        cells += [(a, a + around, b + around), (a, b + around, b)]
dm = plex(points, np.array(cells))
dm.createLabel("Face Sets")
dm.createLabel("Cell Sets")
for facet in range(*dm.getHeightStratum(1)):
    if dm.getSupportSize(facet) == 1:
        dm.setLabelValue("Face Sets", facet, 1 if np.hypot(*centroid(dm, facet)) < 0.75 else 2)
for cell in range(*dm.getHeightStratum(0)):
    dm.setLabelValue("Cell Sets", cell, 3)
dm = distributed(dm)
adapted = dm.adaptMetric(metric_vector(dm, diagonal(fine, fine)), "Face Sets", "Cell Sets")
check_plex(adapted)
before, after = measures(dm, [1, 2], [3]), measures(adapted, [1, 2], [3])
for key in before:
    expect(abs(before[key] - after[key]) < 1e-9, f"annulus: {key} is {after[key]}")

# By a label: cells near a corner are refined, the others keep about their size.
dm = plex(*box(2, 12))
label_box(dm)
dm = distributed(dm)
dm.createLabel("adapt")
for cell in range(*dm.getHeightStratum(0)):
    if np.hypot(*centroid(dm, cell)) < 0.5:
        dm.setLabelValue("adapt", cell, 1)  # DM_ADAPT_REFINE
adapted = dm.adaptLabel("adapt")
check_plex(adapted)
after = measures(adapted, [1, 2, 3, 4, 99], [1, 2])
before = measures(dm, [1, 2, 3, 4, 99], [1, 2])
for key in before:
    expect(abs(before[key] - after[key]) < 1e-9, f"by label: {key} is {after[key]}")
near = [
    sum(1.0 for c in own_points(d, *d.getHeightStratum(0)) if np.hypot(*centroid(d, c)) < 0.4)
    for d in (dm, adapted)
]
near = [total(count) for count in near]
expect(near[1] > 2.5 * near[0], f"cells were not refined: {near}")
