"""A body turns in a flow: the Navier-Stokes equations on a moving mesh, by linear elements with SUPG and PSPG.

    python turning_body.py [STEPS] [NAME]

The velocity goes along with the mesh, so it is the velocity minus that of the mesh that carries momentum. The old
coordinates go along, too: they tell how fast the mesh moves. Every third mesh is adapted to the flow. Prints the torque
on the body, and draws the speed of every sixth step as NAME_1.svg, NAME_2.svg, ...
"""
import sys

import numpy as np
import scipy.sparse as sparse
import scipy.sparse.linalg

import ductile

BODY, LENGTH, HEIGHT, CENTRE, AXES, TURN, VISCOSITY = 3, 4, 2, np.array([1.2, 1.0]), (0.4, 0.14), np.pi / 6, 2e-3


def turned(points, angle):
    c, s = np.cos(angle), np.sin(angle)
    return CENTRE + (points - CENTRE) @ [[c, s], [-s, c]]


def flow(mesh, old, mesh_velocity, dt):
    """The velocity after one implicit step from `old`, and the torque on the body."""
    n, cells, body = len(mesh.points), mesh.cells[mesh.refs != BODY], np.unique(mesh.cells[mesh.refs == BODY])
    edges = mesh.points[cells][:, 1:] - mesh.points[cells][:, :1]
    area, grad = np.linalg.det(edges) / 2, np.linalg.inv(edges).transpose(0, 2, 1)
    grad = np.concatenate([-grad.sum(axis=1, keepdims=True), grad], axis=1)  # [cell, corner, axis]
    carrier = (old - mesh_velocity)[cells].mean(axis=1)
    along = np.einsum("ck,cik->ci", carrier, grad)
    tau = (4 / dt**2 + 2 * (carrier**2).sum(axis=1) / area + (8 * VISCOSITY / area) ** 2) ** -0.5
    test, push, product = 1 / 3 + tau[:, None] * along, tau[:, None, None] * grad, grad @ grad.transpose(0, 2, 1)
    rate, rest = np.zeros((2, len(cells), 3, 3, 3, 3))  # [cell, equation, corner, unknown, corner]
    for k in (0, 1):
        rate[:, k, :, k] = (1 + np.eye(3)) / 12 + tau[:, None, None] * along[:, :, None] / 3
        rate[:, 2, :, k] = push[:, :, None, k] / 3
        rest[:, k, :, k] = test[:, :, None] * along[:, None] + VISCOSITY * product
        rest[:, k, :, 2] = test[:, :, None] * grad[:, None, :, k]
        rest[:, 2, :, k] = grad[:, None, :, k] / 3 + push[:, :, None, k] * along[:, None]
    rest[:, 2, :, 2] = tau[:, None, None] * product
    dofs = (cells[:, None] + n * np.arange(3)[:, None]).reshape(-1, 9)
    place, shape = (np.repeat(dofs, 9, axis=1).ravel(), np.tile(dofs, (1, 9)).ravel()), (3 * n, 3 * n)
    before, matrix = (sparse.csr_matrix(((area[:, None] * part.reshape(-1, 81)).ravel(), place), shape)
                      for part in (rate / dt, rate / dt + rest))
    right = before @ np.concatenate([*old.T, np.zeros(n)])
    x, y = mesh.points.T
    walls = np.flatnonzero((x < 1e-9) | (y < 1e-9) | (y > HEIGHT - 1e-9))  # where the velocity is (1, 0)
    outflow = np.concatenate([np.flatnonzero(x > LENGTH - 1e-9), np.setdiff1d(body, cells)])  # the pressure is 0
    lever = (mesh.points[body] - CENTRE) @ [[0, 1], [-1, 0]]
    solution, free = np.repeat([1.0, 0, 0], n), np.ones(3 * n, bool)
    solution[body], solution[n + body] = TURN * lever.T
    free[np.concatenate([walls, n + walls, body, n + body, 2 * n + outflow])] = False
    known = right - matrix @ (solution * ~free)
    solution[free] = sparse.linalg.spsolve(matrix[free][:, free], known[free])
    velocity, force = (both[:2 * n].reshape(2, n).T for both in (solution, right - matrix @ solution))
    return velocity.copy(), (force[body] * lever).sum()


def main(steps=42, name=None, n=40, dt=0.15):
    box = ductile.box((LENGTH, HEIGHT), (2 * n, n))
    distance = AXES[1] * (np.linalg.norm((box.points - CENTRE) / AXES, axis=1) - 1)
    mesh = box.cut(distance, minus=BODY).remesh(HEIGHT / n, hausd=0.0005, hgrad=1.3)
    velocity = np.tile([1.0, 0.0], (len(mesh.points), 1))
    for step in range(1, steps + 1):
        mesh = mesh.move(turned(mesh.points, TURN * dt) - mesh.points, bodies=[BODY], metric=mesh.metric,
                         fields={"velocity": velocity, "place": mesh.points})
        velocity, torque = flow(mesh, mesh.fields["velocity"], (mesh.points - mesh.fields["place"]) / dt, dt)
        print(f"step {step}: {len(mesh.cells)} triangles, quality {mesh.quality().min():.2f}, torque {torque:.4f}")
        if name and step % 6 == 0:
            ductile.draw(mesh, f"{name}_{step // 6}.svg", by=np.linalg.norm(velocity, axis=1))
        if step % 3 == 0:
            mesh = mesh.remesh(ductile.metric(mesh, velocity, elements=200 * n, hmin=0.01, hgrad=1.4))
            velocity = mesh.transfer(velocity)
    return mesh, velocity


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 42, sys.argv[2] if len(sys.argv) > 2 else None)
