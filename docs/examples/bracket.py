#!/usr/bin/env python3
"""A bracket of steel with a hole, in millimetres: its mesh, and how it bends under a load. Needs numpy and scipy.

    python3 docs/examples/bracket.py          writes bracket.msh beside this file
"""

import pathlib

import numpy as np
from scipy.sparse import coo_matrix
from scipy.sparse.linalg import spsolve
from scipy.spatial import Delaunay

LONG, HIGH, ARM, PLATE, THICK = 120.0, 100.0, 40.0, 25.0, 15.0  # an L: a plate at the wall, and an arm
HOLE, RADIUS, FILLET = np.array([85.0, 20.0]), 10.0, 12.0
NAMES = {"wall": 1, "load": 2, "hole": 3, "free": 4}  # of boundary facets, with their references
STEEL = 1
YOUNG, POISSON, LOAD = 210e3, 0.3, 2e3  # N/mm^2, none, N


def arc(centre, radius, begin, end, count):
    angle = np.linspace(begin, end, count)
    return centre + radius * np.column_stack([np.cos(angle), np.sin(angle)])


def divided(corners, size):
    """The closed line through the corners, its edges cut to the size."""
    pieces = []
    for a, b in zip(corners, np.roll(corners, -1, axis=0)):
        count = max(1, round(np.linalg.norm(b - a) / size))
        pieces.append(a + (b - a) * np.arange(count)[:, None] / count)
    return np.concatenate(pieces)


def is_inside(points, loop):
    """Does a ray from the point cross the closed line an odd number of times?"""
    a, b = loop, np.roll(loop, -1, axis=0)
    x, y = points[:, :1], points[:, 1:]
    with np.errstate(divide="ignore", invalid="ignore"):
        crosses = x < (b - a)[:, 0] * (y - a[:, 1]) / (b - a)[:, 1] + a[:, 0]
    return ((a[:, 1] > y) != (b[:, 1] > y)) & crosses


def outline(size):
    """Triangles of the bracket seen from the side."""
    fillet = arc(np.array([PLATE + FILLET, ARM + FILLET]), FILLET, 1.5 * np.pi, np.pi, 8)
    outer = divided(np.array([[0, 0], [LONG, 0], [LONG, ARM], *fillet, [PLATE, HIGH], [0, HIGH]]), size)
    hole = arc(HOLE, RADIUS, 0, 2 * np.pi, 29)[:-1]
    fixed = np.concatenate([outer, hole])

    def within(points):
        return (is_inside(points, outer).sum(axis=1) % 2 == 1) & (is_inside(points, hole).sum(axis=1) % 2 == 0)

    rows, columns = np.mgrid[0:HIGH:size * np.sqrt(0.75), 0:LONG:size]
    columns[1::2] += size / 2
    inner = np.column_stack([columns.ravel(), rows.ravel()])
    apart = np.linalg.norm(inner[:, None] - fixed, axis=2).min(axis=1) > 0.6 * size
    points = np.concatenate([fixed, inner[apart & within(inner)]])
    for _ in range(20):  # each inner point moves to the mean of its neighbours
        triangles = Delaunay(points).simplices
        triangles = triangles[within(points[triangles].mean(axis=1))]
        edges = np.concatenate([triangles[:, pair] for pair in ([0, 1], [1, 2], [2, 0])])
        edges = np.unique(np.sort(edges, axis=1), axis=0)
        sums = np.zeros((len(points), 3))
        for a, b in (edges.T, edges.T[::-1]):
            np.add.at(sums, a, np.column_stack([points[b], np.ones(len(b))]))
        points[len(fixed):] = (sums[:, :2] / sums[:, 2:])[len(fixed):]
    return points, triangles


def facets_of(points, cells):
    """The triangles of the boundary, and their references."""
    faces = np.concatenate([cells[:, np.delete(np.arange(4), i)] for i in range(4)])
    _, first, count = np.unique(np.sort(faces, axis=1), axis=0, return_index=True, return_counts=True)
    facets = faces[first[count == 1]]
    corners = points[facets]
    refs = np.full(len(facets), NAMES["free"])
    on_hole = np.abs(np.linalg.norm(corners[:, :, ::2] - HOLE, axis=2) - RADIUS) < 1e-6
    flat = np.ptp(corners[:, :, 1], axis=1) == 0
    for name, found in (("wall", corners[:, :, 0] == 0), ("load", corners[:, :, 0] == LONG), ("hole", on_hole)):
        refs[found.all(axis=1) & ~flat] = NAMES[name]
    return facets, refs


def mesh(size=6.0, layers=3):
    """points, cells, facets, references of facets: the outline in layers of prisms, each of three tetrahedra."""
    flat, triangles = outline(size)
    points = np.concatenate([np.column_stack([flat[:, 0], np.full(len(flat), y), flat[:, 1]])
                             for y in np.linspace(0, THICK, layers + 1)])
    a, b, c = (np.sort(triangles, axis=1) + len(flat) * np.arange(layers)[:, None, None]).reshape(-1, 3).T
    above = len(flat)
    cells = np.concatenate([np.column_stack(four) for four in (
        (a, b, c, c + above), (a, b, b + above, c + above), (a, a + above, b + above, c + above))])
    turned = np.linalg.det(points[cells[:, 1:]] - points[cells[:, :1]]) < 0
    cells[turned] = cells[turned][:, [1, 0, 2, 3]]
    return points, cells, *facets_of(points, cells)


def solve(points, cells, facets, refs):
    """Displacement and von Mises' stress at the vertices: linear elasticity by linear finite elements."""
    edges = points[cells[:, 1:]] - points[cells[:, :1]]
    volume = np.linalg.det(edges) / 6
    gradient = np.linalg.inv(edges).transpose(0, 2, 1)
    gradient = np.concatenate([-gradient.sum(axis=1, keepdims=True), gradient], axis=1)
    strain = np.zeros((len(cells), 6, 4, 3))  # xx, yy, zz, yz, zx, xy of each corner's displacement
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        strain[:, i, :, i] = gradient[:, :, i]
        strain[:, 3 + i, :, j], strain[:, 3 + i, :, k] = gradient[:, :, k], gradient[:, :, j]
    strain = strain.reshape(len(cells), 6, 12)
    shear = YOUNG / (2 + 2 * POISSON)
    law = np.diag([2 * shear] * 3 + [shear] * 3)
    law[:3, :3] += YOUNG * POISSON / ((1 + POISSON) * (1 - 2 * POISSON))
    stiffness = volume[:, None, None] * (strain.transpose(0, 2, 1) @ law @ strain)

    unknowns = (3 * cells[:, :, None] + np.arange(3)).reshape(-1, 12)
    rows, columns = np.repeat(unknowns, 12, axis=1), np.tile(unknowns, 12)
    matrix = coo_matrix((stiffness.ravel(), (rows.ravel(), columns.ravel()))).tocsr()
    force = np.zeros((len(points), 3))
    loaded = facets[refs == NAMES["load"]]
    area = np.linalg.norm(np.cross(*(points[loaded[:, 1:]] - points[loaded[:, :1]]).transpose(1, 0, 2)), axis=1) / 2
    for corner in loaded.T:
        np.add.at(force[:, 2], corner, -LOAD / area.sum() * area / 3)
    free = np.ones(len(points), bool)
    free[facets[refs == NAMES["wall"]]] = False
    free = np.repeat(free, 3)
    displacement = np.zeros(3 * len(points))
    displacement[free] = spsolve(matrix[free][:, free].tocsc(), force.ravel()[free])

    s = law @ (strain @ displacement[unknowns][:, :, None])
    x, y, z = s[:, 0, 0], s[:, 1, 0], s[:, 2, 0]
    mises = np.sqrt(((x - y)**2 + (y - z)**2 + (z - x)**2) / 2 + 3 * (s[:, 3:, 0]**2).sum(axis=1))
    share = np.zeros((2, len(points)))
    for corner in cells.T:
        np.add.at(share[0], corner, volume * mises)
        np.add.at(share[1], corner, volume)
    return displacement.reshape(-1, 3), share[0] / share[1]


def main():
    points, cells, facets, refs = mesh()
    displacement, stress = solve(points, cells, facets, refs)
    with open(pathlib.Path(__file__).with_name("bracket.msh"), "w", encoding="utf-8") as file:
        names = [f'2 {ref} "{name}"' for name, ref in NAMES.items()] + [f'3 {STEEL} "steel"']
        print("$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$PhysicalNames", len(names), *names, sep="\n", file=file)
        print("$EndPhysicalNames\n$Nodes", len(points), sep="\n", file=file)
        for i, (x, y, z) in enumerate(points):
            print(i + 1, f"{x:.10g} {y:.10g} {z:.10g}", file=file)
        print("$EndNodes\n$Elements", len(facets) + len(cells), sep="\n", file=file)
        for i, (corners, ref) in enumerate([*zip(facets, refs), *((cell, STEEL) for cell in cells)]):
            print(i + 1, 2 if len(corners) == 3 else 4, 2, ref, ref, *corners + 1, file=file)
        print("$EndElements", file=file)
        for name, values in (("stress", stress[:, None]), ("displacement", displacement)):
            print(f'$NodeData\n1\n"{name}"\n1\n0\n3\n0\n{values.shape[1]}\n{len(values)}', file=file)
            for i, row in enumerate(values):
                print(i + 1, *(f"{value:.5g}" for value in row), file=file)
            print("$EndNodeData", file=file)


if __name__ == "__main__":
    main()
