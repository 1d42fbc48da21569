"""Meshes cut along level sets, and adapted to them."""

import os
import pathlib
import pickle
import re
import subprocess

import numpy as np
import pytest

import ductile
from conftest import shuffled, volumes


def ball(points, radius=0.3):
    return np.linalg.norm(points - 0.5, axis=1) - radius


def random_function(points, rng, kind):
    """Smooth, with kinks, with values of 0 at vertices, or noisy."""
    waves = sum(np.sin(rng.uniform(2, 9, points.shape[1]) @ points.T + rng.uniform(0, 6))
                for _ in range(3))
    if kind == "kinked":
        return np.abs(waves) - 0.4
    if kind == "zeros":
        return np.round(waves * 3)
    return waves + (rng.normal(0, 0.3, len(points)) if kind == "noisy" else 0)


def interface(mesh, ref=10):
    return mesh.facets[mesh.facet_refs == ref]


def expect_cut(before, out, phi, level=0.0):
    """That a cut mesh is valid, has sides, and knows where it comes from."""
    assert out.check() == []
    assert volumes(out).min() > 0
    assert volumes(out).sum() == pytest.approx(1)
    cut = out.level_set
    a, b = cut.vertices.T
    t = cut.weights[:, None]
    assert np.abs(out.points - ((1 - t) * before.points[a] + t * before.points[b])).max() < 1e-12
    stays = a[:len(before.points)] == b[:len(before.points)]
    assert (out.points[:len(before.points)][stays] == before.points[stays]).all()
    assert (cut.value[interface(out)] == 0).all()
    low = np.where(cut.value[out.cells] < 0, True, False).any(axis=1)
    high = (cut.value[out.cells] > 0).any(axis=1)
    assert not (low & high).any()
    assert (out.refs[low] == 3).all() and (out.refs[high] == 2).all()
    mass = np.bincount(cut.cells, volumes(out), len(before.cells))
    assert mass.sum() == pytest.approx(1)
    assert (cut.facets[out.facet_refs == 10] == -1).all()
    old = cut.facets >= 0
    assert (out.facet_refs[old] == before.facet_refs[cut.facets[old]]).all()
    assert cut.report.interface_facets == len(interface(out))
    assert cut.report.minus_volume == pytest.approx(volumes(out)[out.refs == 3].sum())


@pytest.mark.parametrize("kind", ["smooth", "kinked", "zeros", "noisy"])
def test_random_functions_are_cut_and_adapted(dim, kind):
    for seed in range(6 if dim == 2 else 3):
        rng = np.random.default_rng(seed)
        before = shuffled(dim, seed)
        before = before.replace(refs=np.ones(len(before.cells), int))
        phi = random_function(before.points, rng, kind)
        out = before.cut(phi)
        expect_cut(before, out, phi)
        if kind != "noisy":
            fine = out.remesh(0.15 if dim == 2 else 0.25, hausd=0.01 if dim == 2 else 0.03, hgrad=1.3)
            assert fine.check() == []
            assert set(np.unique(fine.refs)) <= {2, 3}


def test_the_interface_comes_to_lie_on_the_surface(dim):
    mesh = ductile.box((1,) * dim, (10,) * dim)
    cut = mesh.cut(ball(mesh.points))
    h, hausd = 0.1, 0.005
    out = cut.remesh(h, hausd=hausd)
    off = np.abs(ball(out.points[np.unique(interface(out))]))
    assert off.mean() < (1e-3 if dim == 3 else 3e-4)
    # A copy of the arrays knows nothing of the function.
    copy = cut.replace().remesh(h, hausd=hausd)
    assert np.abs(ball(copy.points[np.unique(interface(copy))])).mean() > off.mean()
    geometry = ductile.Geometry(cut, hausd)
    other = cut.remesh(h, geometry=geometry)
    assert (other.points == copy.points).all()


def test_sizes_are_those_of_the_mesh_before(mesh, dim):
    mesh = mesh.replace(refs=np.ones(len(mesh.cells), int))
    cut = mesh.cut(ball(mesh.points) + 0.013)
    kept = cut.remesh(hausd=0.02)
    assert len(kept.cells) < 1.6 * len(mesh.cells)
    sizes = 0.1 + 0.2 * mesh.points[:, 0]
    by_array = cut.remesh(sizes, hausd=0.02)
    assert np.median(by_array.points[:, 0]) < 0.45
    by_tensors = cut.remesh(np.eye(dim) / sizes[:, None, None]**2, hausd=0.02)
    assert len(by_tensors.points) == pytest.approx(len(by_array.points), rel=0.02)
    of_cut = cut.remesh(np.full(len(cut.points), 0.2), hausd=0.02)
    assert (of_cut.points == cut.remesh(0.2, hausd=0.02).points).all()
    with pytest.raises(ductile.InputError, match="metric: expected shape"):
        cut.remesh(np.ones(5))


def test_options(mesh, dim):
    left, right = mesh.refs == 1, mesh.refs == 2
    phi = ball(mesh.points)
    out = mesh.cut(phi, materials={1: (11, 12), 2: (21, 22)}, interface=7)
    assert set(np.unique(out.refs)) == {11, 12, 21, 22}
    assert volumes(out)[out.refs < 20].sum() == pytest.approx(volumes(mesh)[left].sum())
    assert len(interface(out, 7)) > 0
    kept = mesh.cut(phi, materials={1: (11, 12), 2: None})
    assert volumes(kept)[kept.refs == 2].sum() == pytest.approx(volumes(mesh)[right].sum())
    named = mesh.cut(phi, 0.05, minus=5, plus=6)
    assert set(np.unique(named.refs)) == {5, 6}
    assert named.level_set.report.level == 0.05
    assert (named.level_set.value == mesh.cut(phi - 0.05).level_set.value).all()
    bars = np.abs(mesh.points[:, 0] - 0.3) - 0.2
    bars[np.argmax(mesh.points[:, 0] + mesh.points[:, 1] - 0.5 * np.abs(mesh.points[:, -1] - 0.5))] = -1e-3
    assert mesh.cut(bars).level_set.report.removed_components == 0
    assert mesh.cut(bars, least_component=0.01).level_set.report.removed_components == 1
    volume = mesh.cut(phi, keep_volume=0.1)
    assert volumes(volume)[volume.refs == 3].sum() == pytest.approx(0.1, rel=1e-6)
    with pytest.warns(ductile.InputWarning, match="met nowhere"):
        one = mesh.cut(phi, 9)
    assert (one.refs == 3).all() and (one.remesh(hausd=0.02).refs == 3).all()


def test_surfaces_are_cut_along_their_edges():
    solid = ductile.box((1, 1, 1), (6, 6, 6))
    used, corners = np.unique(solid.facets, return_inverse=True)
    surface = ductile.Mesh(solid.points[used], corners.reshape(-1, 3))
    for seed in range(6):
        phi = random_function(solid.points, np.random.default_rng(seed), "smooth")
        out = surface.cut(phi[used])
        assert out.check() == [] and set(np.unique(out.refs)) == {2, 3}
        assert (out.level_set.value[out.facets[out.facet_refs == 10]] == 0).all()
        fine = out.remesh(0.1, hausd=0.01, hgrad=1.3)
        assert fine.check() == [] and set(np.unique(fine.refs)) == {2, 3}
        whole = solid.cut(phi, boundary_only=True)
        assert whole.check() == [] and volumes(whole).sum() == pytest.approx(1)
        assert set(np.unique(whole.facet_refs)) == {2, 3}
        assert len(whole.facets) == len(out.cells)
        assert whole.remesh(0.2, hausd=0.01).check() == []


def test_results_do_not_depend_on_threads(mesh):
    outs = [mesh.cut(ball(mesh.points), threads=n).remesh(0.2, hausd=0.02, threads=n)
            for n in (1, 2, 3, 8)]
    for out in outs[1:]:
        assert (out.points == outs[0].points).all() and (out.cells == outs[0].cells).all()


def test_values_come_along_and_a_pickle_is_a_plain_mesh(mesh):
    u = 1 + mesh.points @ np.arange(1, mesh.dim + 1)
    cut = mesh.cut(ball(mesh.points))
    assert cut.transfer(u) == pytest.approx(1 + cut.points @ np.arange(1, mesh.dim + 1))
    out = cut.remesh(0.2, hausd=0.02)
    assert out.transfer(u, source=mesh) == pytest.approx(
        1 + out.points @ np.arange(1, mesh.dim + 1), abs=1e-9)
    assert out.level_set is None
    again = pickle.loads(pickle.dumps(cut))
    assert again.level_set is None and (again.cells == cut.cells).all()


@pytest.mark.parametrize("call, said", [
    (lambda m, p: m.cut(p[:-1]), "phi: expected shape"),
    (lambda m, p: m.cut(np.column_stack([p, p])), "phi: expected shape"),
    (lambda m, p: m.cut("phi"), "phi: expected an array"),
    (lambda m, p: m.cut(np.where(p == p.max(), np.nan, p)), r"phi\[\d+\]: expected a finite"),
    (lambda m, p: m.cut(p, "x"), "level: expected a number"),
    (lambda m, p: m.cut(p, np.inf), "level: expected"),
    (lambda m, p: m.cut(p, minus=1.5), "minus: expected a whole number"),
    (lambda m, p: m.cut(p, interface=2**31), "interface: expected a whole number"),
    (lambda m, p: m.cut(p, materials=[1]), "materials: expected a dict"),
    (lambda m, p: m.cut(p, materials={1: 2}), r"materials\[1\]: expected None or"),
    (lambda m, p: m.cut(p, materials={1: "ab"}), r"materials\[1\]: expected None or"),
    (lambda m, p: m.cut(p, materials={1: (2, "x")}), r"materials\[1\]: expected a whole"),
    (lambda m, p: m.cut(p, materials={1: (8, 9)}), "reference 2, which"),
    (lambda m, p: m.cut(p, least_component=1), "least_component: expected a fraction"),
    (lambda m, p: m.cut(p, keep_volume=2), "keep_volume: expected one between 0"),
    (lambda m, p: m.cut(p, threads=-1), "threads: expected"),
])
def test_wrong_calls(mesh, call, said):
    with pytest.raises(ductile.InputError, match=said) as raised:
        call(mesh, ball(mesh.points))
    assert "\n" not in str(raised.value)


def test_required_cells_are_not_cut(mesh):
    phi = ball(mesh.points)
    crossed = np.flatnonzero((phi[mesh.cells] < -0.02).any(axis=1) & (phi[mesh.cells] > 0.02).any(axis=1))
    kept = ductile.Mesh(mesh.points, mesh.cells, refs=mesh.refs)
    kept._data.require("cells", crossed[:1].astype(np.int32))
    with pytest.raises(ductile.InputError, match="required"):
        kept.cut(phi)


def test_a_coarse_mesh_is_refined_where_a_function_is_zero(dim):
    def specks(points):
        return np.minimum(np.linalg.norm(points - 0.31, axis=1) - 0.06, np.abs(points[:, 0] - 0.77) - 0.02)

    before = ductile.box((1,) * dim, (4,) * dim)
    fine = before.refine_to(specks, 0.01, 0.25, hmin=0.015)
    assert fine.check() == [] and len(fine.cells) > 2 * len(before.cells)
    out = fine.cut(specks(fine.points))
    ball = np.pi * 0.06**2 if dim == 2 else 4 / 3 * np.pi * 0.06**3
    assert volumes(out)[out.refs == 3].sum() == pytest.approx(0.04 + ball, rel=0.1)
    assert (fine.points == before.refine_to(specks, 0.01, 0.25, hmin=0.015, threads=1).points).all()


@pytest.mark.parametrize("arguments, error, said", [
    ((1, 0.1), ductile.InputError, "function: expected a function"),
    ((lambda p: p[:, 0], 0), ductile.InputError, "tolerance"),
    ((lambda p: p[:, 0], "x"), ductile.InputError, "tolerance: expected a number"),
    ((lambda p: p, 0.1), ductile.InputError, "function: expected a value for each"),
    ((lambda p: np.full(len(p), np.nan), 0.1), ductile.InputError, "function.*finite"),
    ((lambda p: 1 // 0, 0.1), ZeroDivisionError, ""),
])
def test_wrong_calls_of_refine_to(mesh, arguments, error, said):
    with pytest.raises(error, match=said):
        mesh.refine_to(*arguments)


def blocks(kind):
    page = (pathlib.Path(__file__).parents[3] / "docs" / "level-sets.md").read_text()
    return re.findall(rf"^```{kind}\n(.*?)^```", page, re.MULTILINE | re.DOTALL)


def test_the_page_runs(tmp_path, monkeypatch):
    """The code of docs/level-sets.md, and its commands where the program is built beside the module."""
    monkeypatch.chdir(tmp_path)
    sphere, film, loop = blocks("python")
    names = {}
    exec(sphere, names)
    ball = names["out"]
    assert volumes(ball)[ball.refs == 3].sum() == pytest.approx(4 / 3 * np.pi * 0.3**3, rel=0.04)
    exec(film, names)
    thin = names["out"]
    assert volumes(thin)[thin.refs == 3].sum() == pytest.approx(0.02, rel=0.1)
    exec(loop, names)
    disc = names["mesh"]
    assert volumes(disc)[disc.refs == 3].sum() == pytest.approx(np.pi * 0.2**2, rel=0.006)
    program = pathlib.Path(ductile.__file__).parents[2] / "meshadapt" / "cli"
    if not (program / "ductile").exists():
        return
    (commands,) = blocks("sh")
    monkeypatch.setenv("PATH", str(program), prepend=os.pathsep)
    for command in commands.splitlines():
        subprocess.run(command, shell=True, check=True)
    again = ductile.read("out.mesh")
    assert (again.cells == ball.cells).all()
