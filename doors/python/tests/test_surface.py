"""Surfaces alone: triangles in space without tetrahedra."""
import numpy as np
import pytest

import ductile


def sphere(n=24):
    """A sphere of radius 1 with two poles."""
    a, b = np.meshgrid(np.linspace(0, 2 * np.pi, 2 * n, endpoint=False),
                       np.linspace(0, np.pi, n + 1)[1:-1])
    ring = np.c_[(np.cos(a) * np.sin(b)).ravel(), (np.sin(a) * np.sin(b)).ravel(),
                 -np.cos(b).ravel()]
    points = np.r_[ring, [[0, 0, -1], [0, 0, 1]]]
    south, north, columns, cells = len(ring), len(ring) + 1, 2 * n, []
    for i in range(columns):
        k = (i + 1) % columns
        cells += [[south, k, i], [north, len(ring) - columns + i, len(ring) - columns + k]]
        for j in range(n - 2):
            low, high = j * columns, (j + 1) * columns
            cells += [[low + i, low + k, high + k], [low + i, high + k, high + i]]
    return points, np.array(cells)


def volume(mesh):
    a, b, c = (mesh.points[mesh.cells[:, i]] for i in range(3))
    return np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6


def test_is_made_of_arrays_and_adapted():
    mesh = ductile.Mesh(*sphere())
    assert mesh.dim == 3 and mesh.cells.shape[1] == 3 and mesh.facets.shape == (0, 2)
    out = mesh.remesh(0.2, hausd=0.01)
    assert out.cells.shape[1] == 3 and len(out.cells) != len(mesh.cells)
    assert abs(volume(out) / (4 * np.pi / 3) - 1) < 0.03
    assert "triangles" in str(ductile.info(out)) and "tetra" not in str(ductile.info(out))


@pytest.mark.parametrize("ending", [".stl", ".ply", ".obj", ".mesh", ".vtu", ".msh"])
def test_goes_through_files(tmp_path, ending):
    mesh = ductile.Mesh(*sphere())
    mesh.save(tmp_path / ("ball" + ending))
    read = ductile.read(tmp_path / ("ball" + ending))
    assert len(read.cells) == len(mesh.cells) and len(read.points) == len(mesh.points)
    assert read.remesh(0.3, hausd=0.02).cells.shape[1] == 3


def test_carries_fields_by_value():
    mesh = ductile.Mesh(*sphere())
    out = mesh.remesh(0.2, hausd=0.01)
    carried = out.transfer(mesh.points[:, 2])
    assert np.abs(carried - out.points[:, 2]).max() < 0.02
    with pytest.raises(ductile.InputError, match="by their values"):
        out.transfer(mesh.points[:, 2], conservative=True)


def test_follows_a_metric_and_keeps_what_is_required():
    mesh = ductile.Mesh(*sphere())
    sizes = np.where(mesh.points[:, 2] > 0, 0.1, 0.4)
    out = mesh.remesh(sizes, hausd=0.02, required_vertices=[3, 5])
    for v in (3, 5):
        assert (out.points == mesh.points[v]).all(axis=1).any()
    upper = (out.points[out.cells].mean(axis=1)[:, 2] > 0).sum()
    assert upper > 2 * (len(out.cells) - upper)


def test_is_drawn(tmp_path):
    mesh = ductile.Mesh(*sphere())
    for by in (None, mesh.points[:, 2]):
        picture = ductile.draw(mesh, tmp_path / "sphere.svg", by)
        assert picture.count("<path") > len(mesh.cells) / 3
    assert "triangles" in mesh._repr_html_()


def test_limits_growth():
    mesh = ductile.Mesh(*sphere())
    wanted = np.full(len(mesh.points), 0.5)
    wanted[0] = 0.01
    graded = np.sqrt(1 / np.asarray(ductile.grade(mesh, wanted, 1.3))[:, 0])
    assert graded[0] == pytest.approx(0.01)
    near = np.linalg.norm(mesh.points - mesh.points[0], axis=1) < 0.2
    assert graded[near].max() < 0.2
    assert graded.max() < 0.5 + 1e-9


def test_becomes_a_dmplex():
    pytest.importorskip("petsc4py.PETSc")
    mesh = ductile.Mesh(*sphere(8))
    plex = mesh.to_dmplex()
    assert (plex.getDimension(), plex.getCoordinateDim()) == (2, 3)
    first, last = plex.getHeightStratum(0)
    assert last - first == len(mesh.cells)
