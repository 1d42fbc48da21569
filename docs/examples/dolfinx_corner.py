#!/usr/bin/env python3
"""Poisson's equation on an L with dolfinx, on meshes that follow the solution, and on even ones.

    python3 docs/examples/dolfinx_corner.py [MOST [MESH.vtu]]

At most MOST triangles; the last adapted mesh goes to the file. At the inner corner the gradient of the solution is
infinite. Each line has the kind of mesh, its triangles, the error in the L2 norm, and the seconds of solving and of
adapting.
"""

import sys
import time

import dolfinx
import numpy as np
import ufl
from dolfinx.fem.petsc import LinearProblem
from mpi4py import MPI
from petsc4py import PETSc

import ductile


def exact(x):
    angle = (np.arctan2(x[0], -x[1]) + np.pi / 4) % (2 * np.pi) - np.pi / 4  # from one side of the inner corner
    return np.hypot(x[0], x[1])**(2 / 3) * np.sin(2 / 3 * angle)


def ell(n):
    """An L of n x n squares without a quarter; the two sides of the inner corner are called `corner`."""
    box = ductile.box((2, 2), (n, n))
    points = box.points - 1
    cells = box.cells[~(points[box.cells].mean(axis=1) * [-1, -1] > 0).all(axis=1)]
    used, cells = np.unique(cells, return_inverse=True)
    points, cells = points[used], cells.reshape(-1, 3)
    mesh = ductile.Mesh(points, cells)
    middle = points[mesh.facets].mean(axis=1)
    refs = np.where((np.abs(middle) < 1e-9).any(axis=1), 1, 2)
    return ductile.Mesh(points, cells, facets=mesh.facets, facet_refs=refs, names={"corner": (1, 1), "rim": (1, 2)})


def flat(table):
    """dolfinx has lists of lists in old versions, and arrays in new ones."""
    return np.asarray(getattr(table, "array", table)).ravel()


def to_dolfinx(mesh):
    """The mesh in dolfinx, and which vertex of ours each of its nodes is."""
    element = ufl.VectorElement("Lagrange", ufl.Cell("triangle", geometric_dimension=2), 1)
    domain = dolfinx.mesh.create_mesh(MPI.COMM_SELF, mesh.cells.astype(np.int64), mesh.points, ufl.Mesh(element))
    return domain, np.asarray(domain.geometry.input_global_indices)


def facets_called(name, mesh, domain, vertex_of):
    """The facets of a name, by their numbers in dolfinx."""
    for one, other in ((1, 0), (1, 2), (2, 0)):
        domain.topology.create_connectivity(one, other)
    facets = dolfinx.mesh.exterior_facet_indices(domain.topology)
    ours = np.empty(len(mesh.points), int)  # [vertex in dolfinx]
    ours[flat(domain.topology.connectivity(2, 0))] = vertex_of[flat(domain.geometry.dofmap)]
    pairs = np.sort(ours[flat(domain.topology.connectivity(1, 0)).reshape(-1, 2)[facets]], axis=1)
    wanted = set(map(tuple, np.sort(mesh.facets[mesh.facets_on(name)], axis=1)))
    return facets[[tuple(pair) in wanted for pair in pairs]]


def solve(mesh):
    """The solution at the vertices of the mesh, and its error."""
    domain, vertex_of = to_dolfinx(mesh)
    space = dolfinx.fem.FunctionSpace(domain, ("Lagrange", 1))
    u, v = ufl.TrialFunction(space), ufl.TestFunction(space)
    rim, zero = dolfinx.fem.Function(space), PETSc.ScalarType(0)
    rim.interpolate(exact)
    on = {name: dolfinx.fem.locate_dofs_topological(space, 1, facets_called(name, mesh, domain, vertex_of))
          for name in ("corner", "rim")}
    conditions = [dolfinx.fem.dirichletbc(rim, on["rim"]), dolfinx.fem.dirichletbc(zero, on["corner"], space)]
    load = dolfinx.fem.Constant(domain, zero) * v * ufl.dx
    uh = LinearProblem(ufl.inner(ufl.grad(u), ufl.grad(v)) * ufl.dx, load, bcs=conditions,
                       petsc_options={"ksp_type": "preonly", "pc_type": "lu"}).solve()
    fine = dolfinx.fem.Function(dolfinx.fem.FunctionSpace(domain, ("Lagrange", 3)))
    fine.interpolate(exact)
    error = dolfinx.fem.assemble_scalar(dolfinx.fem.form((uh - fine)**2 * ufl.dx))**0.5
    values = np.empty(len(mesh.points))
    values[vertex_of[flat(domain.geometry.dofmap)]] = uh.x.array[flat(space.dofmap.list)]
    return values, error


def main(most=30000, path=None):
    solve(ell(2))  # compiles, once
    for n in (8, 16, 32, 64, 128):
        mesh, begin = ell(n), time.perf_counter()
        if len(mesh.cells) > most:
            break
        _, error = solve(mesh)
        print(f"uniform {len(mesh.cells)} {error:.2e} {time.perf_counter() - begin:.2f} 0", flush=True)
    mesh = ell(8)
    u, _ = solve(mesh)
    for elements in (n for n in (400, 800, 1600, 3200, 6400, 12800) if n <= most):
        begin = time.perf_counter()
        mesh = mesh.remesh(ductile.metric(mesh, u, elements=elements, hgrad=1.5))
        adapted = time.perf_counter()
        u, error = solve(mesh)
        print(f"adapted {len(mesh.cells)} {error:.2e} {time.perf_counter() - adapted:.2f} {adapted - begin:.2f}",
              flush=True)
    if path:
        mesh.save(path, fields={"u": u})


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *sys.argv[2:])
