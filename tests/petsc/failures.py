"""What is wrong on one rank is told on all: nobody waits for ever, and the next call works."""

from support import *

PETSc.Sys.pushErrorHandler("ignore")


def fails(spoil, spoil_field=lambda values: values):
    dm = plex(*box(2, 8))
    label_box(dm)
    dm = distributed(dm)
    values = np.tile(np.eye(2).ravel() * 100.0, len(coordinates(dm)))
    values = spoil(values)
    metric = PETSc.Vec().createWithArray(values, comm=PETSc.COMM_SELF)
    field = spoil_field(np.ones(len(coordinates(dm))))
    dm.compose("u", PETSc.Vec().createWithArray(field, comm=PETSc.COMM_SELF))
    try:
        dm.adaptMetric(metric, "Face Sets", "Cell Sets")
    except PETSc.Error:
        return True
    return False


def only_last(spoil):
    return lambda values: spoil(values) if rank == ranks - 1 else values


def negative(values):
    values[:4] = (-1, 0, 0, 1)
    return values


def not_finite(values):
    values[:4] = np.nan
    return values


def far_too_fine(values):
    return values * 1e30


for spoil in (negative, not_finite, far_too_fine, lambda values: values[:-4].copy()):
    expect(fails(only_last(spoil)), f"{spoil.__name__}: an error on the last rank was not told here")
options["dm_ductile_fields"] = "u"
for spoil in (not_finite, lambda values: values[:-4].copy()):  # of fields, of which some ranks know
    expect(fails(lambda values: values, only_last(spoil)), "an error of a field was not told here")
expect(not fails(lambda values: values), "nothing is wrong, but it failed")
