"""Meshes and fields that the tests share."""

import numpy as np
import pytest

import ductile


def shuffled(dim: int, seed: int) -> ductile.Mesh:
    """A box of two regions, its vertices renumbered and those inside moved, by arrays alone."""
    rng = np.random.default_rng(seed)
    box = ductile.box((1.0,) * dim, (int(rng.integers(4, 8)),) * dim)
    inside = (np.abs(box.points - 0.5) < 0.49).all(axis=1) & (np.abs(box.points[:, 0] - 0.5) > 0.01)
    points = box.points + 0.02 * inside[:, None] * rng.uniform(-1, 1, box.points.shape)
    order = rng.permutation(len(points))
    place = np.empty(len(points), int)
    place[order] = np.arange(len(points))
    refs = 1 + (points[box.cells].mean(axis=1)[:, 0] > 0.5)
    return ductile.Mesh(points[order], place[box.cells], refs=refs, facets=place[box.facets],
                        facet_refs=box.facet_refs)


def volumes(mesh: ductile.Mesh) -> np.ndarray:
    corner = mesh.points[mesh.cells]
    return np.linalg.det(corner[:, 1:] - corner[:, :1]) / (2 if mesh.dim == 2 else 6)


def integral(mesh: ductile.Mesh, u: np.ndarray) -> float:
    values = u if len(u) == len(mesh.cells) else u[mesh.cells].mean(axis=1)
    return float(volumes(mesh) @ values)


@pytest.fixture(params=[2, 3], ids=["2d", "3d"])
def dim(request):
    return request.param


@pytest.fixture
def mesh(dim):
    return shuffled(dim, 7)
