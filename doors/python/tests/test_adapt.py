"""Adaptation: metrics in all forms, sizes, progress, threads, processes, fields."""

import _thread
import multiprocessing
import threading
import time

import numpy as np
import pytest

import ductile
from conftest import integral, shuffled, volumes


def same(a, b):
    return all(np.array_equal(getattr(a, name), getattr(b, name))
               for name in ("points", "cells", "facets", "refs", "facet_refs", "metric"))


def test_all_forms_of_a_metric_give_the_same_mesh(mesh):
    d = mesh.dim
    count = len(mesh.points)
    forms = [0.25, np.float32(0.25), np.full(count, 0.25), np.full((count, 1), 0.25),
             np.tile(16 * np.eye(d), (count, 1, 1)),
             ductile.packed(np.tile(16 * np.eye(d), (count, 1, 1))), ductile.Size(0.25)]
    first = mesh.remesh(hsiz=0.25)
    assert first.check() == [] and first.report.converged
    for form in forms:
        assert same(mesh.remesh(form), first)
    asfortran = np.asfortranarray(forms[-2])
    assert same(mesh.remesh(asfortran), first)
    assert same(mesh.remesh(0.25, threads=1), mesh.remesh(0.25, threads=3))


@pytest.mark.parametrize("seed", range(4))
def test_random_meshes_stay_valid_and_good(dim, seed):
    mesh = shuffled(dim, seed)
    x = mesh.points - np.random.default_rng(seed).uniform(0, 1, dim)
    u = np.tanh(8 * (x ** 2).sum(axis=1))
    M = ductile.metric(mesh, u, elements=1000 if dim == 2 else 3000, hgrad=1.5)
    out = mesh.remesh(M)
    assert out.check() == []
    info = ductile.info(out, M)  # M belongs to the mesh before
    assert info.in_metric and info.share_in_range > 0.85 and info.quality.min > 0.1
    np.testing.assert_allclose(info.complexity, ductile.info(out).complexity, rtol=0.1)
    assert len(out.cells) == pytest.approx(1000 if dim == 2 else 3000, rel=0.35)
    assert set(out.refs) == {1, 2} and volumes(out).sum() == pytest.approx(1, abs=1e-12)
    np.testing.assert_allclose(volumes(out)[out.refs == 1].sum(), 0.5, atol=0.1)
    np.testing.assert_allclose(ductile.complexity(out, out.metric), ductile.info(out).complexity)
    assert out.quality(M).min() > 0.05 and len(out.quality()) == len(out.cells)
    for text in (str(info), str(out.report), repr(out)):
        assert len(text) > 20


@pytest.mark.parametrize("recovery, within", (("least-squares", 0.1), ("projection", 0.2)))
def test_a_loop_with_a_layer_keeps_its_elements(recovery, within):
    mesh = ductile.box((1, 1), (20, 20))
    for call in range(10):
        u = np.tanh(20 * (mesh.points.sum(axis=1) - 0.3))
        mesh = mesh.remesh(ductile.metric(mesh, u, elements=3000, recovery=recovery))
        assert call == 0 or len(mesh.cells) == pytest.approx(3000, rel=within), call


def test_options_do_what_they_say(mesh):
    assert same_points(mesh.remesh(0.2, noinsert=True, nomove=True, noswap=True), mesh)
    locked = mesh.remesh(0.1, nosurf=True)
    assert len(locked.facets) == len(mesh.facets)
    assert len(mesh.remesh(hmax=0.1).cells) > 2 * len(mesh.remesh().cells)
    assert mesh.remesh(0.1, hmin=0.3).report.converged
    with pytest.raises(ductile.Error):
        mesh.remesh(1e-4, memory=20)


def same_points(a, b):
    return {tuple(p) for p in a.points.tolist()} == {tuple(p) for p in b.points.tolist()}


def test_required_entities_stay_and_are_found_again(mesh):
    wanted = mesh.facet_refs == 2
    for given in (wanted, np.flatnonzero(wanted), list(np.flatnonzero(wanted))):
        out = mesh.remesh(0.12, required_facets=given, required_vertices=[5], hgradreq=2.3)
        kept = out.origin.facets[out.required_facets]
        np.testing.assert_array_equal(np.sort(kept), np.flatnonzero(wanted))
        assert 5 in out.origin.vertices
    assert len(mesh.required_facets) == 0 and out.check() == []
    cells = mesh.remesh(0.12, required_cells=[0, 4])
    assert {0, 4} <= set(cells.origin.cells)


def test_origin_says_where_vertices_lie(mesh):
    out = mesh.remesh(0.13)
    origin = out.origin
    assert out.origin is origin
    old = origin.vertices >= 0
    assert 0 < old.sum() < len(out.points) and origin.vertices.min() == -1
    np.testing.assert_array_equal(out.points[old], mesh.points[origin.vertices[old]])
    corners = mesh.points[mesh.cells[origin.host]]
    np.testing.assert_allclose(np.einsum("nc,ncd->nd", origin.weights, corners), out.points,
                               atol=1e-12)


@pytest.mark.parametrize("shape", [(), (1,), (2,), (3,), (5,), (2, 2), (3, 3), (2, 3)])
def test_fields_are_carried(mesh, shape):
    out = mesh.remesh(0.22)
    factors = np.arange(1.0, 1 + int(np.prod(shape)) * mesh.dim).reshape(mesh.dim, -1)
    linear = (mesh.points @ factors).reshape(-1, *shape)
    expected = (out.points @ factors).reshape(-1, *shape)
    for conservative in (False, True):
        got = out.transfer(linear, conservative=conservative)
        np.testing.assert_allclose(got, expected, atol=1e-9 * np.abs(expected).max())
        constant = out.transfer(np.full((len(mesh.cells), *shape), 3.0), conservative=conservative)
        np.testing.assert_allclose(constant, 3, rtol=1e-12)
        assert constant.shape == (len(out.cells), *shape)


def test_integrals_are_kept_and_materials_stay_whole(mesh):
    out = mesh.remesh(0.11)
    u = np.tanh(20 * (mesh.points[:, 0] - 0.4))
    rho = np.random.default_rng(1).uniform(1, 2, len(mesh.cells))
    carried = out.transfer({"u": u, "rho": rho}, conservative=True)
    for values, before in ((carried["u"], u), (carried["rho"], rho)):
        assert integral(out, values) == pytest.approx(integral(mesh, before), abs=1e-12)
        assert values.min() >= before.min() - 1e-12 and values.max() <= before.max() + 1e-12
    material = out.transfer(mesh.refs)
    assert material.dtype == mesh.refs.dtype
    np.testing.assert_array_equal(material, out.refs)
    waves = out.transfer(u * np.exp(1j * u), conservative=True)
    assert waves.dtype.kind == "c" and np.isfinite(waves).all()
    elsewhere = ductile.box((1,) * mesh.dim, (4,) * mesh.dim)
    moved = ductile.transfer(out, carried["u"], elsewhere, conservative=True)
    assert integral(elsewhere, moved) == pytest.approx(integral(mesh, u), abs=1e-10)
    np.testing.assert_allclose(out.at(out.points[:, 0], [[0.3] * mesh.dim]), [0.3], atol=1e-12)


def test_only_one_generation_is_kept(mesh):
    out = mesh.remesh(0.3)
    for _ in range(3):
        out = out.remesh(0.3)
    assert isinstance(out._source, type(out._data)) and not hasattr(out._source, "_source")


def test_sizes_without_tensors(mesh):
    d = mesh.dim
    named = mesh.replace(names={"wall": (d - 1, 1), "steel": (d, 2)})
    size = ductile.Size(0.5, hmin=0.01)
    assert size.near(sphere=((0.5,) * d, 0.1), h=0.2) is size
    size.near(point=(0.1,) * d, h=0.1).near(box=((0.8,) * d, (1.1,) * d), h=0.15, grow=1.1)
    size.near(curve=[(0,) * d, (1,) * d], h=0.3, distance=0.2, hmax=0.4)
    size.on("wall", h=0.08, grow=1.2).on(4, h=0.2).inside("steel", h=0.4)
    at = size.at(named)
    x = named.points
    growth = np.log(1.3)
    assert at.shape == (len(x),) and at.max() <= 0.5
    assert (at[x[:, 0] == 0] <= 0.08).all()
    assert (at <= 0.1 + growth * np.linalg.norm(x - 0.1, axis=1) + 1e-12).all()
    assert (at <= 0.08 + np.log(1.2) * x[:, 0] + 1e-12).all()
    assert (at[x[:, 0] > 0.51] <= 0.4).all()
    out = named.remesh(ductile.Size(0.3).on("wall", h=0.1), hgrad=1.5)
    assert out.check() == [] and ductile.info(out, ductile.Size(0.3).on("wall", h=0.1))
    if d == 3:
        square = ([(0, 0, 0.5), (1, 0, 0.5), (1, 1, 0.5), (0, 1, 0.5)], [(0, 1, 2), (0, 2, 3)])
        at = ductile.Size(0.5).near(surface=square, h=0.1).at(named)
        assert (at[np.abs(x[:, 2] - 0.5) < 1e-12] == 0.1).all()


def test_a_size_is_met_on_a_mesh_that_is_far_too_coarse(dim):
    mesh = ductile.box((1,) * dim, (1,) * dim)
    h = 0.02 if dim == 2 else 0.08
    size = ductile.Size(0.5).near(point=(0.42,) * dim, h=h)
    out = mesh.remesh(size)
    assert out.check() == [] and len(out.origin.host) == len(out.points)
    assert out.origin.host.max() < len(mesh.cells)
    nearest = np.argmin(np.linalg.norm(out.points - 0.42, axis=1))
    around = out.cells[(out.cells == nearest).any(axis=1)]
    lengths = np.linalg.norm(out.points[np.unique(around)] - out.points[nearest], axis=1)
    assert lengths.max() < 2.5 * h
    assert ductile.info(out, size).share_in_range > 0.8


def test_metrics_are_worked_on(mesh):
    d, count = mesh.dim, len(mesh.points)
    rng = np.random.default_rng(5)
    factors = rng.normal(size=(2, count, d, d))
    A, B = factors @ np.swapaxes(factors, -1, -2) + np.eye(d)
    np.testing.assert_array_equal(ductile.full(ductile.packed(A)), A)
    both = ductile.full(ductile.intersect(A, B))
    for one in (A, B):  # no length is shorter in the intersection
        assert np.linalg.eigvalsh(both - one).min() > -1e-9 * np.abs(both).max()
    np.testing.assert_array_equal(ductile.intersect(A, B), ductile.intersect(ductile.packed(B), A))
    np.testing.assert_array_equal(ductile.intersect([1, 2], [2, 1], [3, 3]), [1, 1])
    sized = ductile.sizes(ductile.intersect(A, np.full(count, 0.1), B))
    assert sized.shape == (count, d) and sized.max() < 0.1001
    bounded = ductile.sizes(ductile.bound(A, hmin=0.3, hmax=0.6))
    assert bounded.min() > 0.2999 and bounded.max() < 0.6001
    graded = ductile.sizes(ductile.grade(mesh, np.where(np.arange(count) == 0, 0.01, 1.0), 1.2))
    assert 0.01 * 0.999 < graded.min() and graded.max() < 0.6
    assert ductile.info(mesh, ductile.implied(mesh)).edge_length.mean == pytest.approx(1, abs=0.25)


# ---- Progress, threads, processes ----

def test_progress_is_asked_and_cancels(mesh):
    steps = []
    mesh.remesh(0.1, progress=lambda *now: steps.append(now))
    assert {"coarsen", "refine", "swap", "smooth"} <= {step for step, _, _ in steps}
    with pytest.raises(ductile.Cancelled):
        mesh.remesh(0.1, progress=lambda step, iteration, changes: np.bool_(iteration < 2))
    with pytest.raises(ZeroDivisionError):
        mesh.remesh(0.1, progress=lambda *now: 1 / 0)
    with pytest.raises(TypeError):
        mesh.remesh(0.1, progress=lambda: True)
    assert same(mesh.remesh(0.1, progress=lambda *now: True), mesh.remesh(0.1))


def test_control_c_cancels():
    mesh = ductile.box((1, 1), (10, 10))
    timer = threading.Timer(0.2, _thread.interrupt_main)
    begin = time.monotonic()
    timer.start()
    with pytest.raises(KeyboardInterrupt):
        mesh.remesh(0.0003)  # takes a minute
    assert time.monotonic() - begin < 20


def test_others_go_on_meanwhile():
    mesh = ductile.box((1, 1), (10, 10))
    stop, count = threading.Event(), [0]

    def run():
        while not stop.is_set():
            count[0] += 1
            time.sleep(0.001)

    other = threading.Thread(target=run)
    other.start()
    before = count[0]
    mesh.remesh(0.006)
    during = count[0] - before
    stop.set()
    other.join()
    assert during > 20


def test_meshes_are_adapted_by_several_threads_at_once(mesh):
    results = [None] * 4
    threads = [threading.Thread(target=lambda i=i: results.__setitem__(i, mesh.remesh(0.12)))
               for i in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert all(same(result, results[0]) for result in results)


def adapted(mesh):
    return mesh.remesh(0.15)


def test_processes_that_fork_adapt_too(mesh):
    expected = mesh.remesh(0.15, threads=2)  # threads of OpenMP have run before
    with multiprocessing.get_context("fork").Pool(2) as pool:
        for result in pool.map_async(adapted, [mesh] * 3).get(timeout=60):
            assert same(result, expected)


def disk():
    """A polygon of 40 edges of the reference 1 in the unit circle."""
    x = np.linspace(0, 2 * np.pi, 40, endpoint=False)
    rim = np.stack((np.cos(x), np.sin(x)), axis=1)
    fan = np.stack((np.arange(40), (np.arange(40) + 1) % 40, np.full(40, 40)), axis=1)
    return ductile.Mesh(np.concatenate((rim, [[0, 0]])), fan, facets=fan[:, :2], facet_refs=np.ones(40, int))


def test_geometry_has_points_and_normals():
    polygon = disk()
    geometry = ductile.Geometry(polygon, hausd=0.01)
    assert geometry.dim == 2 and geometry.hausd == 0.01
    found = geometry.closest([[2, 0], [0, -0.5], [0, 5]], reach=1.5)
    assert found.points[:2] == pytest.approx(np.array([[1, 0], [0, -1]]), abs=5e-3)
    assert np.linalg.norm(found.points[:2], axis=1) == pytest.approx(np.ones(2), abs=1e-4)
    assert found.normals[:2] == pytest.approx(np.array([[1, 0], [0, -1]]), abs=5e-3)
    assert np.isnan(found.points[2]).all() and found.refs[2] == 0
    for wrong in ({"points": [[0, 0, 0]]}, {"points": [[0, np.nan]]}, {"points": [[0, 0]], "reach": 0}):
        with pytest.raises(ductile.InputError):
            geometry.closest(**wrong)
    with pytest.raises(ductile.InputError, match="tolerance"):
        ductile.Geometry(polygon, hausd=0)
    with pytest.raises(ductile.InputError, match="geometry: expected a ductile.Geometry"):
        polygon.remesh(0.1, geometry=polygon)


def test_signed_distances_are_those_of_the_smooth_interface(dim):
    box = ductile.box((2,) * dim, (16 if dim == 2 else 12,) * dim)
    x = box.points - 1
    far = np.maximum(np.abs(x).max(axis=1), 1e-30)
    out = np.maximum(2 * far - 1, 0)  # cubes are balls up to half of the extent
    round_ = 0.8 * np.minimum(far, 0.5) / np.maximum(np.linalg.norm(x, axis=1), 1e-30)
    x = x * ((1 - out) * round_ + out)[:, None]
    refs = np.where((np.abs(box.points[box.cells].mean(axis=1) - 1) < 0.5).all(axis=1), 3, 2)
    mesh = ductile.Mesh(x, box.cells, refs=refs, names={"ball": (dim, 3)})
    phi = mesh.signed_distance(3)
    assert phi == pytest.approx(np.linalg.norm(x, axis=1) - 0.4, abs=2e-3)
    assert (phi == 0).sum() == (abs(np.linalg.norm(x, axis=1) - 0.4) < 1e-12).sum()
    assert (phi == mesh.signed_distance(["ball"], threads=1)).all()
    assert phi == pytest.approx(mesh.signed_distance((3,), mesh), abs=1e-12)
    assert -phi == pytest.approx(mesh.signed_distance({2}), abs=1e-3)
    points = np.random.default_rng(5).uniform(-1.2, 1.2, (500, dim))
    found = mesh.signed_distance(np.array([3]), points, hausd=0.01)
    assert found == pytest.approx(np.linalg.norm(points, axis=1) - 0.4, abs=2e-3)
    for inside, message in ((7, "no element has the reference 7"), ("box", "name 'box'"),
                            ([2, 3], "expected facets between elements inside and others")):
        with pytest.raises(ductile.InputError, match=message):
            mesh.signed_distance(inside)


def rounded(x, radius=1.0):
    """The closest point of the unit circle or sphere."""
    return radius * x / np.linalg.norm(x)


def test_surfaces_are_functions(dim):
    box = ductile.box((2,) * dim, (16 if dim == 2 else 6,) * dim)
    x = box.points - 1
    far = np.maximum(np.abs(x).max(axis=1), 1e-30)
    ball = ductile.Mesh(x * (far / np.maximum(np.linalg.norm(x, axis=1), 1e-30))[:, None], box.cells,
                        facets=box.facets, facet_refs=np.full(len(box.facets), 3),
                        names={"wall": (dim - 1, 3)})
    for surfaces in ({3: rounded}, {"wall": rounded}):
        geometry = ductile.Geometry(ball, hausd=0.04, surfaces=surfaces, threads=2)
        out = ball.remesh(0.2, geometry=geometry, threads=2).remesh(0.3, geometry=geometry, threads=1)
        radius = np.linalg.norm(out.points[np.unique(out.facets)], axis=1)
        assert np.abs(radius - 1).max() < 1e-12 and out.check() == []
    same = [ball.remesh(0.2, geometry=geometry, threads=threads).points for threads in (1, 2, 4)]
    assert all((points == same[0]).all() for points in same)
    near = geometry.closest([[1.01] + [0.2] * (dim - 1)]).points
    assert np.linalg.norm(near) == pytest.approx(1, abs=1e-15)


def test_surfaces_that_are_wrong():
    for surfaces, text in (({77: rounded}, "no facet has the reference 77"),
                           ({"nothing": rounded}, "no facets have the name 'nothing'"),
                           ({1: 5}, "expected a function"),
                           ({1: lambda x: [1, 2, 3]}, "expected a point of 2 coordinates")):
        with pytest.raises(ductile.InputError, match=text):
            ductile.Geometry(disk(), hausd=0.01, surfaces=surfaces)
    with pytest.raises(ZeroDivisionError):
        ductile.Geometry(disk(), hausd=0.01, surfaces={1: lambda x: 1 / 0})


def test_curved_boundaries_are_followed(dim):
    box = ductile.box((2,) * dim, (8 if dim == 2 else 6,) * dim)
    x = box.points - 1
    far = np.maximum(np.abs(x).max(axis=1), 1e-30)
    ball = ductile.Mesh(x * (far / np.maximum(np.linalg.norm(x, axis=1), 1e-30))[:, None], box.cells)
    sizes = ductile.Size(0.2).near(point=(0.7,) + (0,) * (dim - 1), h=0.05)
    for metric, bounds in ((None, {"hmax": 0.12}), (sizes, {}), (0.5, {})):
        out = ball.remesh(metric, hausd=0.01, hgrad=1.5, **bounds)
        assert out.check() == [] and not out.report.warnings
        radius = np.linalg.norm(out.points[np.unique(out.facets)], axis=1)
        assert radius.min() > 0.93 and radius.max() < 1.02
    alone = ball.remesh(hausd=0.02, curved_sizes=True)
    assert alone.check() == [] and len(alone.cells) < len(ball.cells)
    with pytest.raises(ductile.InputError, match="curved_sizes: expected"):
        ball.remesh(curved_sizes=True)
    geometry = ductile.Geometry(ball, hausd=0.04)  # as far as its chords are off
    out = ball
    for _ in range(3):
        out = out.remesh(0.3, geometry=geometry).remesh(0.15, geometry=geometry)
    radius = np.linalg.norm(out.points[np.unique(out.facets)], axis=1)
    assert np.abs(radius - 1).max() < 0.01
    with pytest.raises(ductile.InputError, match="hausd: expected that of the geometry"):
        ball.remesh(0.15, hausd=0.02, geometry=geometry)
    exact = ball.remesh(0.15)  # without hausd the facets stay
    assert volumes(exact).sum() == pytest.approx(np.abs(volumes(ball)).sum(), rel=1e-9)


def test_vertices_that_are_not_connected_are_warned_of_and_joined(dim):
    box = ductile.box((1,) * dim, (3,) * dim)
    other = box.points + np.eye(dim)[0]
    twice = ductile.Mesh(np.vstack([box.points, other]), np.vstack([box.cells, box.cells + len(other)]))
    with pytest.warns(ductile.InputWarning, match="is at the place of vertex"):
        out = twice.remesh(0.3)
    assert any("joined()" in line for line in out.report.warnings)
    joined = twice.joined()
    assert len(joined.points) == 2 * len(other) - 4**(dim - 1)
    assert joined.remesh(0.3).check() == []
    with pytest.raises(ductile.InputError, match="no farther apart than the tolerance"):
        twice.joined(0.9)
