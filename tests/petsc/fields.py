"""Fields that are carried along: integrals of conservative ones, bounds, values of others, and the
metric that was adapted to."""

from support import *


options["dm_ductile_fields"] = "u,line"
options["dm_ductile_cell_fields"] = "heat,material"
options["dm_ductile_by_value"] = "line,material"
library = ctypes.CDLL(options["dll_append"])

for dim, n in ((2, 16), (3, 6)):
    for overlap in (0, 1) if ranks > 1 else (0,):
        dm = plex(*box(dim, n))
        label_box(dm)
        dm = distributed(dm, overlap)
        x = coordinates(dm)
        centre = x[corners_of(dm)].mean(axis=1) if len(x) else x
        u = np.stack([1 + (x[:, 0] > 0.4) + x[:, 1] ** 2, np.exp(x[:, 0])], axis=1)
        before = {
            "u": local(u),
            "line": local(1 + x @ np.arange(1, dim + 1)),
            "heat": local(np.sin(3 * centre[:, 0]) + centre[:, 1]),
            "material": local(1.0 + (centre[:, 0] > 0.5)),
        }
        for name, vector in before.items():
            dm.compose(name, vector)
        size = lambda x: 0.02 * dim + 0.2 * abs(x[:, 0] - 0.4 - 0.2 * x[:, 1])
        metric = metric_vector(dm, diagonal(size, *[lambda x: 2 * size(x)] * (dim - 1)))
        adapted = dm.adaptMetric(metric, "Face Sets", "Cell Sets")
        after = {name: adapted.query(name) for name in before}
        case = f"{dim}D, overlap {overlap}"
        for name, on_cells in (("u", False), ("heat", True)):
            old, new = integral(dm, before[name], on_cells), integral(adapted, after[name], on_cells)
            expect(np.all(abs(old - new) < 1e-12 * abs(old)), f"{case}: {name}: {old} became {new}")
        # Another way to the same.
        carried = ctypes.c_void_p()
        code = library.DuctilePetscTransfer(
            ctypes.c_void_p(dm.handle), ctypes.c_void_p(before["u"].handle), 0, 1,
            ctypes.c_void_p(adapted.handle), ctypes.byref(carried))
        expect(code == 0, f"{case}: DuctilePetscTransfer: error {code}")
        same = ctypes.c_int()
        ctypes.CDLL("libpetsc_real.so").VecEqual(
            carried, ctypes.c_void_p(after["u"].handle), ctypes.byref(same))
        expect(same.value == 1, f"{case}: u is another one")
        y = coordinates(adapted)
        got = after["u"].array.reshape(-1, 2)
        expect(len(y) == 0 or (got[:, 0].min() >= 1 and got[:, 0].max() <= 3), f"{case}: bounds")
        line = after["line"].array - (1 + y @ np.arange(1, dim + 1))
        expect(len(y) == 0 or abs(line).max() < 1e-12, f"{case}: {abs(line).max()} off the line")
        expect(set(after["material"].array) <= {1.0, 2.0}, f"{case}: other materials")
        wanted = adapted.query("ductile_metric").array.reshape(-1, dim, dim)
        expect(len(wanted) == len(y), f"{case}: {len(wanted)} metrics for {len(y)} vertices")
        if len(y):
            ratio = np.linalg.det(wanted) / np.linalg.det(diagonal(size, *[lambda x: 2 * size(x)] * (dim - 1))(y))
            expect(0.5 < np.median(ratio) < 2, f"{case}: {np.median(ratio)} of the metric")
