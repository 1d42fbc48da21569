"""Every public function with wrong arguments of every kind: one clear line, never what pybind11 says."""

import functools

import numpy as np
import pytest

import ductile
from conftest import shuffled

WRONG = [None, "text", "a\0b", "\udc80", b"bytes", "", (), [], {}, object(), 3, -1, 0, 0.5, -0.5,
         float("nan"), float("inf"), -float("inf"), 10**30, -10**30, 10**400, True, 1 + 2j,
         [1, 2, 3], [[1, 2], [3]], ["a", "b"], [None], np.zeros(0), np.zeros((2, 2)), np.zeros((3, 4, 5)),
         np.full(7, np.nan), np.array(3), np.array([1, 2], object), np.ones((4, 4), bool),
         np.array([2**40]), lambda *given: None, {"a": 1}, {1: 2}, {"a\0": (1, 2)}, {"a": "b"},
         {"a": (9, 9)}, {"a": [np.nan, 1]}]


@functools.lru_cache(maxsize=None)
def calls(dim):
    """Name of an argument: the function of it."""
    mesh = shuffled(dim, 3)
    out = mesh.remesh(0.5)
    count = len(mesh.points)
    tensors, u = ductile.implied(mesh), mesh.points[:, 0]
    size = ductile.Size(0.3)
    geometry = ductile.Geometry(mesh, 0.01)
    def keyword(call, names):
        return {name: (lambda x, name=name: call(**{name: x})) for name in names.split()}
    found = {
        "points": lambda x: ductile.Mesh(x, mesh.cells), "cells": lambda x: ductile.Mesh(mesh.points, x),
        "metric": mesh.remesh, "facets_on": mesh.facets_on, "cells_in": mesh.cells_in,
        "transfer u": out.transfer, "at u": lambda x: mesh.at(x, mesh.points),
        "at points": lambda x: mesh.at(u, x), "signed inside": mesh.signed_distance,
        "signed at": lambda x: mesh.signed_distance(1, x), "quality": mesh.quality, "full": ductile.full,
        "packed": ductile.packed, "sizes": ductile.sizes, "bound": ductile.bound,
        "intersect A": lambda x: ductile.intersect(x, tensors),
        "intersect B": lambda x: ductile.intersect(tensors, x),
        "intersect C": lambda x: ductile.intersect(tensors, tensors, x),
        "grade mesh": lambda x: ductile.grade(x, tensors), "grade M": lambda x: ductile.grade(mesh, x),
        "factor": lambda x: ductile.grade(mesh, tensors, x), "implied": ductile.implied,
        "metric mesh": lambda x: ductile.metric(x, u, elements=100),
        "metric u": lambda x: ductile.metric(mesh, x, elements=100),
        "complexity mesh": lambda x: ductile.complexity(x, tensors),
        "complexity M": lambda x: ductile.complexity(mesh, x), "info": ductile.info,
        "info M": lambda x: ductile.info(mesh, x), "read": ductile.read, "read_field": ductile.read_field,
        "save_field mesh": lambda x: ductile.save_field("unwritten/x.sol", x, u),
        "save_field values": lambda x: ductile.save_field("unwritten/x.sol", mesh, x),
        "extent": lambda x: ductile.box(x, (2,) * dim), "box cells": lambda x: ductile.box((1,) * dim, x),
        "before": lambda x: ductile.transfer(x, u, out), "after": lambda x: ductile.transfer(mesh, u, x),
        "draw": ductile.draw, "draw by": lambda x: ductile.draw(mesh, by=x),
        "draw width": lambda x: ductile.draw(mesh, width=x), "draw most": lambda x: ductile.draw(mesh, most=x),
        "Geometry mesh": lambda x: ductile.Geometry(x, 0.1),
        "Geometry hausd": lambda x: ductile.Geometry(mesh, x),
        "closest": geometry.closest, "reach": lambda x: geometry.closest(mesh.points, reach=x),
        "default": ductile.Size, "on": lambda x: ductile.Size(0.3).on(x, h=0.1).at(mesh),
        "inside": lambda x: ductile.Size(0.3).inside(x, h=0.1).at(mesh), "Size.at": size.at,
        "from_meshio": ductile.from_meshio, "joined": mesh.joined,
        "fields": lambda x: mesh.to_meshio(x), "save fields": lambda x: mesh.save("unwritten/x.vtu", fields=x),
        "a field": lambda x: mesh.save("unwritten/x.vtu", fields={"u": x}),
        "save": lambda x: mesh.save(x) if not isinstance(x, (str, bytes)) else mesh.save("un\0written.vtu")}
    for more in (keyword(lambda **k: ductile.Mesh(mesh.points, mesh.cells, **k),
                         "refs facets facet_refs vertex_refs names"),
                 keyword(mesh.replace, "points_ points cells refs facets edges edge_refs names required"),
                 keyword(lambda **k: mesh.remesh(0.5, **k),
                         "hmin hmax hgrad hgradreq hausd geometry ar curved_sizes iterations thorough nomove "
                         "noswap noinsert nosurf required_vertices required_facets required_cells memory "
                         "threads progress hsiz"),
                 keyword(lambda **k: out.transfer(u, **k), "conservative on source threads"),
                 keyword(lambda **k: ductile.metric(mesh, u, **k), "elements complexity error"),
                 keyword(lambda **k: ductile.metric(mesh, u, elements=100, **k),
                         "norm hmin hmax anisotropy hgrad recovery threads"),
                 keyword(lambda **k: ductile.bound(tensors, **k), "hmin hmax anisotropy"),
                 keyword(lambda **k: ductile.Geometry(mesh, 0.01, **k), "ar surfaces threads"),
                 keyword(lambda **k: ductile.Size(0.3, **k).at(mesh), "hmin hmax"),
                 keyword(lambda **k: ductile.Size(0.3).near(h=0.1, **k).at(mesh),
                         "point sphere box curve surface"),
                 keyword(lambda **k: ductile.Size(0.3).near(**{"point": (0,) * dim, "h": 0.1, **k}).at(mesh),
                         "h grow hmax distance")):
        found.update((f"{name} ({len(found)})", call) for name, call in more.items())
    assert count > 10 and len(found) > 100
    return found


@pytest.mark.filterwarnings("ignore")
@pytest.mark.parametrize("value", range(len(WRONG)), ids=lambda i: repr(WRONG[i])[:20].encode(
    "ascii", "backslashreplace").decode().replace("\\", "_"))
def test_wrong_arguments_are_told_in_one_clear_line(dim, value, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    wrong = []
    for name, call in calls(dim).items():
        try:
            call(WRONG[value])
        except (ductile.Error, FileNotFoundError) as error:
            text = str(error)
            if "incompatible" in text or "\n" in text or "pybind" in text or ": " not in text:
                wrong.append(f"{name}: {text}")
        except BaseException as error:  # noqa: BLE001: any other kind is a fault
            wrong.append(f"{name}: {type(error).__name__}: {error}")
    assert not wrong, "\n".join(wrong)
