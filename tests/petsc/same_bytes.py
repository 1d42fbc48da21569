"""The same mesh, bit for bit, each time and at any number of threads of a rank. Prints digests of all
ranks for each dimension, which separate_runs.sh compares."""

from support import *

for dim, n in ((2, 20), (3, 7)):
    digests = set()
    for threads in (1, 2, 1):
        options["dm_ductile_threads"] = threads
        dm = plex(*box(dim, n))
        label_box(dm)
        dm = distributed(dm)
        size = lambda x: 0.02 * dim / 2 + 0.2 * abs(x[:, 0] - 0.4 - 0.2 * x[:, 1])
        metric = metric_vector(dm, diagonal(size, *[lambda x: 2 * size(x)] * (dim - 1)))
        digests.add(digest(dm.adaptMetric(metric, "Face Sets", "Cell Sets")))
    expect(len(digests) == 1, f"{dim}D: the mesh is not the same each time")
    begins = gathered(float(int(digests.pop()[:12], 16)))  # 48 bits, which a double holds
    if rank == 0:  # lines of several ranks may come out as one
        print(f"{dim}D:", *[f"{int(begin):012x}" for begin in begins], flush=True)
