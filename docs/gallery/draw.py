#!/usr/bin/env python3
"""Draws the pictures of the gallery into the folder of this file: for each idea a mesh before and after.

    pip install ./doors/python          or PYTHONPATH=build/release/python after ./dev test
    python3 docs/gallery/draw.py
"""

import os

import numpy as np

import ductile

HERE = os.path.dirname(os.path.abspath(__file__))
WIDTH = 400


def draw(name, mesh, by=None):
    ductile.draw(mesh, os.path.join(HERE, name + ".svg"), by, width=WIDTH)
    print(f"{name}: {len(mesh.cells)} cells, mean quality {mesh.quality().mean():.3f}")


def shaken(cells, by, seed=1):
    """The unit square cut evenly, its inner vertices moved at random by a fraction of a cell."""
    mesh = ductile.box((1, 1), (cells, cells))
    points = np.array(mesh.points)
    inside = np.all((points > 1e-9) & (points < 1 - 1e-9), axis=1)
    points[inside] += np.random.default_rng(seed).uniform(-by, by, (inside.sum(), 2)) / cells
    return mesh.replace(points=points)


def tensors(angle, along, across):
    """Metric tensors with the size `along` in the direction of `angle` and `across` at right angles to it."""
    c, s = np.cos(angle), np.sin(angle)
    a, b = 1 / along**2, 1 / across**2
    return np.column_stack([a * c * c + b * s * s, (a - b) * c * s, a * s * s + b * c * c])


def kernels():
    """What each kernel does alone, and all of them."""
    mesh = shaken(9, 0.4)
    x, y = mesh.points.T
    metric = tensors(np.full(len(x), np.pi / 6), np.full(len(x), 0.16), 0.05 + 0.1 * np.abs(y - 0.5))
    none = {"nomove": True, "noswap": True, "noinsert": True}
    draw("kernels-before", mesh)
    for name in ("nomove", "noswap", "noinsert"):
        draw(f"kernels-{name[2:]}", mesh.remesh(metric, **{**none, name: False}))
    draw("kernels-all", mesh.remesh(metric))


def front(points):
    return np.tanh(20 * (points[:, 1] - 0.5 - 0.2 * np.sin(6 * points[:, 0])))


def solution():
    """The metric of a solution, made and adapted to three times."""
    before = mesh = ductile.box((1, 1), (16, 16))
    for _ in range(3):
        mesh = mesh.remesh(ductile.metric(mesh, front(mesh.points), elements=600, hgrad=1.5))
    draw("solution-before", before, front(before.points))
    draw("solution-after", mesh, front(mesh.points))


def transfer():
    """A field on another mesh of the same domain, its integral kept."""
    old = ductile.box((1, 1), (16, 16))
    u = sum(np.exp(-80 * np.sum((old.points - place) ** 2, axis=1)) for place in ((0.3, 0.3), (0.65, 0.7)))
    new = old.remesh(ductile.metric(old, u, elements=600, hgrad=1.5))
    draw("transfer-before", old, u)
    draw("transfer-after", new, new.transfer(u, conservative=True))


def places():
    mesh = ductile.box((1, 1), (6, 6))
    size = ductile.Size(0.2).near(point=(0.3, 0.3), h=0.015).near(curve=[(0.55, 0.9), (0.9, 0.5)], h=0.03)
    draw("places-before", mesh)
    draw("places-after", mesh.remesh(size))


def gradation():
    mesh = shaken(12, 0.2)
    h = np.where(np.linalg.norm(mesh.points - 0.5, axis=1) < 0.15, 0.02, 0.15)
    draw("gradation-without", mesh.remesh(h))
    draw("gradation-with", mesh.remesh(h, hgrad=1.3))


def regions():
    """Two materials: the interface between them is kept, and coarsened within itself."""
    box = ductile.box((1, 1), (16, 16))
    centre = box.points[box.cells].mean(axis=1)
    inside = (np.abs(centre[:, 0] - 0.5) < 0.25) & (np.abs(centre[:, 1] - 0.5) < 0.25)
    mesh = ductile.Mesh(box.points, box.cells, refs=1 + inside.astype(int))
    draw("regions-before", mesh)
    draw("regions-after", mesh.remesh(ductile.Size(0.15).inside(2, h=0.05)))


def required():
    """A frozen side with edges of 0.25 where the metric asks for 0.05."""
    mesh = ductile.box((1, 1), (4, 4))
    middle = mesh.points[mesh.facets].mean(axis=1)
    frozen = middle[:, 1] > 1 - 1e-9
    for name, options in (("without", {}), ("with", {"hgradreq": 1.5})):
        draw(f"required-{name}", mesh.remesh(0.05, required_facets=frozen, **options))


def curved():
    """A disc: its boundary is coarsened within a distance of a smooth model."""
    angle = np.linspace(0, 2 * np.pi, 61)[:-1]
    rings = np.linspace(0, 1, 9)[1:]
    points = np.vstack([[0, 0], *(r * np.column_stack([np.cos(angle), np.sin(angle)]) for r in rings)])
    n = len(angle)
    i, j = np.arange(n), (np.arange(n) + 1) % n
    cells = [np.column_stack([np.zeros(n, int), 1 + i, 1 + j])]
    for k in range(len(rings) - 1):
        low, high = 1 + k * n, 1 + (k + 1) * n
        cells += [np.column_stack([low + i, high + i, high + j]), np.column_stack([low + i, high + j, low + j])]
    mesh = ductile.Mesh(points, np.concatenate(cells))
    draw("curved-before", mesh)
    draw("curved-after", mesh.remesh(0.3, hausd=0.01, hgrad=1.3))


def bracket():
    """A bracket under load, coloured by stress, and adapted to its displacement."""
    before = ductile.read(os.path.join(HERE, "..", "examples", "bracket.msh"))
    metric = ductile.metric(before, before.fields["displacement"], elements=8000, hgrad=1.5)
    after = before.remesh(metric, hausd=0.05, hgrad=1.5)
    draw("bracket-before", before, before.fields["stress"])
    draw("bracket-after", after, after.transfer(before.fields["stress"]))


def space():
    """Tetrahedra, seen from outside: fine near an edge and a point of the cube."""
    mesh = ductile.box((1, 1, 1), (4, 4, 4))
    size = ductile.Size(0.25).near(point=(1, 0, 1), h=0.04, grow=1.4).near(curve=[(0, 0, 0), (1, 0, 0)], h=0.06)
    draw("space-before", mesh)
    draw("space-after", mesh.remesh(size))


def part(mesh, cells):
    """Some of the cells, as a mesh."""
    return ductile.Mesh(mesh.points, mesh.cells[cells], refs=mesh.refs[cells])


def waves_on(ball):
    """The surface of a ball alone, cut along a function."""
    used, facets = np.unique(ball.facets[ball.facet_refs == 10], return_inverse=True)
    points, facets = ball.points[used], facets.reshape(-1, 3)
    a, b, c = (points[facets[:, i]] - 0.5 for i in range(3))
    inwards = np.einsum("ij,ij->i", np.cross(a, b), c) < 0
    facets[inwards] = facets[inwards, ::-1]
    x, y, z = 15 * points.T
    waves = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    mesh = ductile.Mesh(points, facets).cut(waves).remesh(0.03, hausd=0.002)
    return mesh, mesh.refs


def level_sets():
    """A sphere, a gyroid, a surface alone, two materials, and a disc that is carried round in fifty steps."""
    box = ductile.box((1, 1, 1), (12, 12, 12))
    cut = box.cut(np.linalg.norm(box.points - 0.5, axis=1) - 0.3)
    for name, mesh in (("cut", cut), ("adapted", cut.remesh(0.08, hausd=0.004, hgrad=1.3))):
        half = mesh.points[mesh.cells].mean(axis=1)[:, 1] > 0.5
        draw(f"level-set-{name}", part(mesh, half | (mesh.refs == 3)))
    x, y, z = 2 * np.pi * box.points.T + 0.1
    gyroid = np.sin(x) * np.cos(y) + np.sin(y) * np.cos(z) + np.sin(z) * np.cos(x)
    mesh = box.cut(gyroid).remesh(0.07, hausd=0.01, hgrad=1.3)
    draw("level-set-gyroid", part(mesh, mesh.refs == 3))

    draw("level-set-surface", *waves_on(cut.remesh(0.05, hausd=0.003, hgrad=1.3)))

    square, even = shaken(16, 0.2), ductile.box((1, 1), (16, 16))
    points = np.array(square.points)
    points[even.points[:, 0] == 0.5, 0] = 0.5
    left = even.points[even.cells].mean(axis=1)[:, 0] < 0.5
    square = square.replace(points=points, refs=np.where(left, 1, 2))
    phi = np.linalg.norm(square.points - 0.5, axis=1) - 0.3
    mesh = square.cut(phi, materials={1: (11, 12), 2: (21, 22)})
    draw("level-set-materials", mesh.remesh(0.06, hausd=0.001, hgrad=1.3))

    mesh = shaken(24, 0.2)
    mesh = mesh.cut(np.linalg.norm(mesh.points - [0.5, 0.7], axis=1) - 0.2).remesh(
        1 / 24, hausd=0.001, hgrad=1.3)
    draw("level-set-first", mesh)
    c, s = np.cos(2 * np.pi / 50), np.sin(2 * np.pi / 50)
    for _ in range(50):
        before = (mesh.points - 0.5) @ np.array([[c, -s], [s, c]]) + 0.5
        mesh = mesh.cut(mesh.signed_distance(3, before)).remesh(1 / 24, hausd=0.001, hgrad=1.3)
    draw("level-set-last", mesh)
    corner = mesh.points[mesh.cells[mesh.refs == 3]]
    print(np.linalg.det(corner[:, 1:] - corner[:, :1]).sum() / 2 / (np.pi * 0.2**2))


if __name__ == "__main__":
    for idea in (kernels, solution, transfer, places, gradation, regions, required, curved, bracket, space, level_sets):
        idea()
