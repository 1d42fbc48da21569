"""Random meshes and metrics: each result is a mesh that PETSc accepts and has the measures that it
had. The cases are the same each time; more of them by -cases, others by -seed."""

from support import *

cases = options.getInt("cases", 24)
random = np.random.default_rng(options.getInt("seed", 1))
for case in range(cases):
    dim = 3 if case % 4 == 3 else 2
    n = int(random.integers(3, 14 if dim == 2 else 6))
    points, cells = box(dim, n)
    inside = ((points > 1e-9) & (points < 1 - 1e-9)).all(axis=1)
    if n % 2 == 0:  # the interface between the regions stays straight
        inside &= abs(points[:, 0] - 0.5) > 1e-9
    shift = random.uniform(-0.15 / n, 0.15 / n, points.shape)
    dm = plex(points + inside[:, None] * shift, cells)
    label_box(dm, region=lambda x: 1 + int(x[0] > 0.5) if n % 2 == 0 else 1)
    dm = distributed(dm, overlap=int(random.integers(0, 2)))
    smallest = random.uniform(0.03, 0.1) * dim / 2
    slope, stretch = random.uniform(0.05, 0.6), random.uniform(1, 5)
    direction = random.normal(size=dim)
    direction /= np.linalg.norm(direction)
    turn = np.linalg.qr(random.normal(size=(dim, dim)))[0]

    def tensor_at(x):
        size = smallest + slope * abs((x - 0.5) @ direction)
        scale = np.diag([1.0] + [stretch**-2.0] * (dim - 1))
        return (turn @ scale @ turn.T)[None] * size[:, None, None] ** -2.0

    adapted = dm.adaptMetric(metric_vector(dm, tensor_at), "Face Sets", "Cell Sets")
    check_plex(adapted)
    sets = ([*range(1, 2 * dim + 1), 99], (1, 2))
    before, after = measures(dm, *sets), measures(adapted, *sets)
    for key in before:
        expect(abs(before[key] - after[key]) < 1e-9, f"case {case}: {key} is {after[key]}")
    expect(cell_counts(adapted).min() > 0, f"case {case}: a rank starves")
