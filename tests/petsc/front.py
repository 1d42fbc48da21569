"""A front moves through the domain and the mesh follows it, as in a simulation: the number of cells
does not drift, and the sets keep their measures."""

from support import *

dm = plex(*box(2, 16))
label_box(dm)
dm = distributed(dm)
start = measures(dm, [1, 2, 3, 4, 99], [1, 2])
counts = []
for step in range(10):
    centre = 0.3 + 0.04 * step
    size = lambda x: 0.012 + 0.25 * abs(np.hypot(x[:, 0] - centre, x[:, 1] - 0.5) - 0.2)
    dm = dm.adaptMetric(metric_vector(dm, diagonal(size, size)), "Face Sets", "Cell Sets")
    counts.append(int(cell_counts(dm).sum()))
check_plex(dm)
end = measures(dm, [1, 2, 3, 4, 99], [1, 2])
for key in start:
    expect(abs(start[key] - end[key]) < 1e-9, f"{key} is {end[key]}")
if rank == 0:
    print("cells:", counts, flush=True)
# The first mesh is coarse and shows little of the metric; the others are alike.
later = np.array(counts[2:])
expect(later.max() < 1.1 * later.min(), f"the number of cells drifts: {counts}")
