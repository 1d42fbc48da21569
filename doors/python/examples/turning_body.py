"""A body that turns in a fluid, in a page of code: each step turns the body, moves the mesh with the
temperature on it, and lets heat flow from the body into the fluid. Finite elements of numpy and scipy alone.

    python turning_body.py [STEPS] [PICTURE.svg]

Prints for each step how many triangles the mesh has, its worst quality, and the heat in it.
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import ductile

FLUID, BODY = 1, 3


def start(n=24):
    """A square whose cells within an ellipse are the body."""
    mesh = ductile.box((1, 1), (n, n))
    middle = mesh.points[mesh.cells].mean(axis=1) - 0.5
    refs = np.where((middle / (0.35, 0.1)) ** 2 @ (1, 1) < 1, BODY, FLUID)
    return ductile.Mesh(mesh.points, mesh.cells, refs=refs).remesh(hsiz=1 / n)


def matrices(mesh):
    """The mass matrix, and the stiffness matrix of heat."""
    corner = mesh.points[mesh.cells]
    edges = corner[:, 1:] - corner[:, :1]
    area = np.abs(np.linalg.det(edges)) / 2
    gradients = np.linalg.inv(edges).transpose(0, 2, 1)
    gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
    stiff = area[:, None, None] * np.einsum("cid,cjd->cij", gradients, gradients)
    mass = area[:, None, None] * (1 + np.eye(3)) / 12
    rows = np.repeat(mesh.cells, 3, axis=1).ravel()
    columns = np.tile(mesh.cells, (1, 3)).ravel()
    shape = (len(mesh.points),) * 2
    return tuple(sparse.csc_matrix((part.ravel(), (rows, columns)), shape) for part in (mass, stiff))


def turn(mesh, degrees):
    """The displacement of the body's vertices; 0 at others."""
    angle = np.deg2rad(degrees)
    rotation = np.array([[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]])
    body = np.unique(mesh.cells[mesh.refs == BODY])
    u = np.zeros_like(mesh.points)
    u[body] = (mesh.points[body] - 0.5) @ rotation.T + 0.5 - mesh.points[body]
    return u


def main(steps=12, picture=None, degrees=15, conductivity=1e-3):
    mesh = start()
    heat = np.zeros(len(mesh.points))
    heat[np.unique(mesh.cells[mesh.refs == BODY])] = 1
    metric = 1 / 24
    for step in range(steps):
        mesh = mesh.move(turn(mesh, degrees), bodies=[BODY], metric=metric, fields={"heat": heat},
                         conservative=True)
        metric = mesh.metric
        mass, stiff = matrices(mesh)
        heat = sparse.linalg.spsolve(mass + conductivity * stiff, mass @ mesh.fields["heat"])
        print(f"step {step + 1}: {len(mesh.cells)} triangles, worst quality {mesh.quality().min():.2f}, "
              f"heat {(mass @ heat).sum():.6f}")
    if picture:
        ductile.draw(mesh, picture, by=heat)
    return mesh, heat


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 12, sys.argv[2] if len(sys.argv) > 2 else None)
