"""Solve, adapt, transfer: a front that a rotating flow carries around, with linear finite elements of
numpy and scipy alone.

    python solve_and_adapt.py [STEPS] [PICTURE.svg]

Every few steps the mesh is adapted to the solution, which goes to the new mesh so that its integral is
kept. Prints for each mesh how many triangles it has, and the integral.
"""

import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import ductile


def assemble(mesh, diffusion, velocity):
    """Mass and transport matrices: (u, v) and diffusion (grad u, grad v) + (velocity . grad u, v)."""
    corner = mesh.points[mesh.cells]
    edges = corner[:, 1:] - corner[:, :1]
    area = np.abs(np.linalg.det(edges)) / 2
    gradients = np.linalg.inv(edges).transpose(0, 2, 1)
    gradients = np.concatenate([-gradients.sum(axis=1, keepdims=True), gradients], axis=1)
    flow = velocity(corner.mean(axis=1))
    along = np.einsum("cd,cjd->cj", flow, gradients)
    stiff = area[:, None, None] * (
        diffusion * np.einsum("cid,cjd->cij", gradients, gradients)
        + along[:, None, :] / 3
        + streamline(area, flow)[:, None, None] * along[:, :, None] * along[:, None, :])
    mass = area[:, None, None] * (1 + np.eye(3)) / 12
    rows = np.repeat(mesh.cells, 3, axis=1).ravel()
    columns = np.tile(mesh.cells, (1, 3)).ravel()
    shape = (len(mesh.points),) * 2
    return tuple(sparse.csc_matrix((part.ravel(), (rows, columns)), shape) for part in (mass, stiff))


def streamline(area, flow):
    """Diffusion along the flow that keeps linear elements from wiggling, over speed squared."""
    return 0.5 * np.sqrt(area) / np.maximum(np.linalg.norm(flow, axis=1), 1e-12)


def rotation(x):
    return 2 * np.pi * np.column_stack([0.5 - x[:, 1], x[:, 0] - 0.5])


def blob(x):
    return np.clip(1.5 - 10 * np.linalg.norm(x - (0.5, 0.75), axis=1), 0, 1)


def integral(mesh, u):
    corner = mesh.points[mesh.cells]
    return np.abs(np.linalg.det(corner[:, 1:] - corner[:, :1])) / 2 @ u[mesh.cells].mean(axis=1)


def main(steps=4, picture=None, elements=3000):
    mesh = ductile.box((1, 1), (20, 20))
    for _ in range(3):  # the first mesh fits the first solution
        mesh = mesh.remesh(ductile.metric(mesh, blob(mesh.points), elements=elements, hgrad=1.5))
    u = blob(mesh.points)
    dt, inner = 0.005, 4
    for step in range(steps):
        mass, stiff = assemble(mesh, 1e-5, rotation)
        solve = sparse.linalg.factorized(mass + dt * stiff)
        states = [u]
        for _ in range(inner):
            states.append(solve(mass @ states[-1]))
        u = states[-1]
        # Fine where the front has been and where it will be: both ends of these steps, and further on.
        ahead = 2 * states[-1] - states[0]
        M = ductile.metric(mesh, np.column_stack([u, np.clip(ahead, 0, 1)]), elements=elements,
                           hgrad=1.5)
        new = mesh.remesh(M)
        u = new.transfer(u, conservative=True)
        mesh = new
        print(f"step {step + 1}: {len(mesh.cells)} triangles, integral {integral(mesh, u):.6f}, "
              f"u from {u.min():.3f} to {u.max():.3f}")
    if picture:
        ductile.draw(mesh, picture, by=u)
    return mesh, u


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 4, *sys.argv[2:3])
