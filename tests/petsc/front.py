"""A front moves through the domain and the mesh follows it, as in a simulation, with a field: the number
of cells does not drift away from that of one rank, the sets keep their measures and the field its
integral. `mpirun -n 4 python3 front.py -steps 20 -dim 3` makes a longer run of it."""

from support import *

steps, dim = options.getInt("steps", 10), options.getInt("dim", 2)
finest = options.getReal("finest", {2: 0.012, 3: 0.04}[dim])
options["dm_ductile_fields"] = "u"
faces = [*range(1, 2 * dim + 1), 99]


def begin(comm):
    """A box of the ranks of comm, with a field that jumps."""
    points, cells = box(dim, {2: 16, 3: 6}[dim])
    if comm.getRank():
        points, cells = points[:0], cells[:0]
    dm = PETSc.DMPlex().createFromCellList(dim, cells.astype(PETSc.IntType), points, comm=comm)
    label_box(dm)
    dm = distributed(dm)
    x = coordinates(dm)
    dm.compose("u", local(1 + (x[:, 0] > 0.4) + x[:, 1] ** 2))
    return dm


def follow(dm, step):
    centre = np.array([0.3 + 0.4 * step / steps, 0.5, 0.5][:dim])
    size = lambda x: finest + 0.25 * abs(np.linalg.norm(x - centre, axis=1) - 0.2)
    return dm.adaptMetric(metric_vector(dm, diagonal(*[size] * dim)), "Face Sets", "Cell Sets")


dm, alone = begin(world), begin(PETSc.COMM_SELF) if rank == 0 else None
start, u = measures(dm, faces, [1, 2]), integral(dm, dm.query("u"))
counts, serial = [], []
for step in range(steps):
    dm = follow(dm, step)
    counts.append(int(cell_counts(dm).sum()))
    if rank == 0 and ranks > 1:
        alone = follow(alone, step)
        serial.append(int(alone.getHeightStratum(0)[1]))
check_plex(dm)
end = measures(dm, faces, [1, 2])
for key in start:
    expect(abs(start[key] - end[key]) < 1e-9, f"{key} is {end[key]}")
lost = abs(integral(dm, dm.query("u")) / u - 1).max()
expect(lost < 1e-12, f"{lost} of the field's integral is lost")
if rank == 0:
    print(f"cells on {ranks} ranks: {counts}\non one: {serial}\nintegral: {lost:.1e} lost", flush=True)
# The first mesh is coarse and shows little of the metric; the later ones are alike.
later = np.array(counts[steps // 2 :])
expect(later.max() < 1.1 * later.min(), f"the number of cells drifts: {counts}")
ratio = np.array(counts[2:]) / serial[2:] if serial else np.ones(1)
if serial:
    print("ratios:", *ratio.round(3), flush=True)
off = abs(ratio.mean() - 1), abs(ratio - 1).max()
expect(off[0] < 0.02 * (dim - 1) ** 2 and off[1] < 0.1, f"{off[0]} and at most {off[1]} off one rank")
