"""Any number of ranks, with and without overlap, full, isotropic and uniform metrics: the mesh is one
that PETSc accepts, and every Face Set and Cell Set has the measure that it had."""

from support import *


def size(x):
    return 0.03 + 0.2 * abs(x[:, 0] - 0.5 - 0.1 * np.sin(6 * x[:, 1]))


def full(dm):
    sizes = [size] + [lambda x: 3 * size(x)] * (dm.getDimension() - 1)
    return metric_vector(dm, diagonal(*sizes))


def isotropic(dm):
    dm.metricSetIsotropic(True)
    values = size(coordinates(dm)) ** -2.0
    return PETSc.Vec().createWithArray(values, comm=PETSc.COMM_SELF)


def uniform(dm):
    dm.metricSetUniform(True)
    return PETSc.Vec().createWithArray(np.array([0.12**-2.0]), comm=PETSc.COMM_SELF)


for dim, n, makers in ((2, 12, (full, isotropic, uniform)), (3, 5, (full, uniform))):
    faces, cells = [*range(1, 2 * dim + 1), 99], (1, 2)
    for overlap in (0, 1) if ranks > 1 else (0,):
        for maker in makers:
            dm = plex(*box(dim, n))
            label_box(dm)
            dm = distributed(dm, overlap)
            metric = maker(dm)
            adapted = dm.adaptMetric(metric, "Face Sets", "Cell Sets")
            check_plex(adapted)
            before, after = measures(dm, faces, cells), measures(adapted, faces, cells)
            case = f"{dim}D, overlap {overlap}, {maker.__name__}"
            for key in before:
                expect(abs(before[key] - after[key]) < 1e-9, f"{case}: {key} is {after[key]}")
            counts = cell_counts(adapted)
            expect(counts.min() > 0.5 * counts.mean(), f"{case}: ranks have {counts} cells")
            expect(counts.sum() != cell_counts(dm).sum(), f"{case}: nothing was adapted")

# All of the mesh on one rank, as a script that forgets to distribute it has it.
dm = plex(*box(2, 12))
label_box(dm)
adapted = dm.adaptMetric(full(dm), "Face Sets", "Cell Sets")
check_plex(adapted)
expect(cell_counts(adapted).min() > 0, "a rank starves")

# Parts of every second cell, or third: there is no vertex inside of any.
points, cells = box(2, 12)
dm = plex(points, np.concatenate([cells[r::ranks] for r in range(ranks)]))
label_box(dm)
dm = distributed(dm)
adapted = dm.adaptMetric(full(dm), "Face Sets", "Cell Sets")
check_plex(adapted)
expect(quality(adapted, diagonal(size, lambda x: 3 * size(x)))["worst"] > 0.3, "nothing got better")
