"""Loops of solving and adapting, with the defaults of metric() and remesh()."""

import numpy as np
import pytest

import ductile

sparse = pytest.importorskip("scipy.sparse")
linalg = pytest.importorskip("scipy.sparse.linalg")


def solve_poisson(mesh, source, exact):
    """Linear finite elements for -div grad u = source with u = exact on the boundary."""
    corner = mesh.points[mesh.cells]
    edges = corner[:, 1:] - corner[:, :1]
    area = np.linalg.det(edges) / 2
    gradients = np.linalg.inv(edges).transpose(0, 2, 1)
    gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
    stiff = area[:, None, None] * np.einsum("cid,cjd->cij", gradients, gradients)
    rows, columns = np.repeat(mesh.cells, 3, axis=1), np.tile(mesh.cells, (1, 3))
    matrix = sparse.csr_matrix((stiff.ravel(), (rows.ravel(), columns.ravel())),
                               (len(mesh.points),) * 2)
    middles = (corner + corner[:, [1, 2, 0]]) / 2  # a rule that is exact for quadratics
    f = source(middles) * area[:, None] / 6
    load = np.zeros(len(mesh.points))
    for i, j in ((0, 1), (1, 2), (2, 0)):
        np.add.at(load, mesh.cells[:, i], f[:, i])
        np.add.at(load, mesh.cells[:, j], f[:, i])
    outer = np.unique(mesh.facets)
    inner = np.setdiff1d(np.arange(len(mesh.points)), outer)
    u = exact(mesh.points)
    load -= matrix[:, outer] @ u[outer]
    u[inner] = linalg.spsolve(matrix[inner][:, inner].tocsc(), load[inner])
    return u


def l2_error(mesh, u, exact):
    corner, values = mesh.points[mesh.cells], u[mesh.cells]
    area = np.linalg.det(corner[:, 1:] - corner[:, :1]) / 2
    missed = (values + values[:, [1, 2, 0]]) / 2 - exact((corner + corner[:, [1, 2, 0]]) / 2)
    return np.sqrt((area[:, None] * missed**2).sum() / 3)


@pytest.mark.parametrize("angle", [0.3, 1, np.pi / 2])
@pytest.mark.parametrize("steep", [20, 60])
def test_error_of_a_solver_does_not_grow_with_the_cycles(angle, steep):
    """The first mesh misses the steeper layer, so that the second may be worse than it."""
    across = np.array([np.cos(angle), np.sin(angle)])

    def exact(x):
        return np.tanh(steep * ((x - 0.5) @ across))

    def source(x):
        return 2 * steep**2 * exact(x) * (1 - exact(x)**2)

    mesh, errors = ductile.box((1, 1), (32, 32)), []
    for _ in range(6):
        u = solve_poisson(mesh, source, exact)
        errors.append(l2_error(mesh, u, exact))
        mesh = mesh.remesh(ductile.metric(mesh, u, elements=2000))
    for cycle in range(2, 6):
        assert errors[cycle] < 1.2 * min(errors[:cycle]), errors
    assert errors[-1] < 0.05 * errors[0], errors
