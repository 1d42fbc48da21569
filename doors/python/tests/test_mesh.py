"""Meshes of arrays and files, and what is wrong with them."""

import pickle
import re

import numpy as np
import pytest

import ductile
from conftest import shuffled, volumes


def facet_set(facets):
    return {tuple(sorted(facet)) for facet in facets.tolist()}


@pytest.mark.parametrize("index", [np.int32, np.int64, np.uint8, list])
def test_finds_the_boundary_by_itself(dim, index):
    box = ductile.box((1,) * dim, (3,) * dim)
    cells = box.cells.tolist() if index is list else box.cells.astype(index)
    mesh = ductile.Mesh(box.points.tolist() if index is list else box.points, cells)
    assert facet_set(mesh.facets) == facet_set(box.facets)
    assert mesh.check() == [] and mesh.dim == dim
    assert (mesh.facet_refs == 0).all() and (mesh.refs == 0).all()
    np.testing.assert_array_equal(mesh.cells, box.cells)


def test_facets_that_are_given_come_first_and_keep_references(mesh):
    keep = np.flatnonzero(mesh.facet_refs == 1)
    again = ductile.Mesh(mesh.points, mesh.cells, refs=mesh.refs, facets=mesh.facets[keep],
                         facet_refs=mesh.facet_refs[keep], names={"left": (mesh.dim - 1, 1)})
    np.testing.assert_array_equal(again.facets[:len(keep)], mesh.facets[keep])
    assert facet_set(again.facets) == facet_set(mesh.facets)
    np.testing.assert_array_equal(np.flatnonzero(again.facets_on("left")), np.arange(len(keep)))


def test_arrays_are_the_memory_of_the_library(mesh):
    out = mesh.remesh(0.2)
    assert out.points.ctypes.data == out.points.ctypes.data == out._data.address
    for name in ("points", "cells", "facets", "edges", "refs", "facet_refs", "vertex_refs"):
        first, again = getattr(out, name), getattr(out, name)
        assert not first.flags.writeable, name
        if first.size:
            assert first.ctypes.data == again.ctypes.data and not first.flags.owndata, name
    assert out.metric.base is not None
    points = out.points
    expected = points.copy()
    del out
    np.testing.assert_array_equal(points, expected)  # they outlive the mesh


def test_arrays_of_the_right_layout_are_not_converted():
    from ductile import _arrays
    points, cells = np.zeros((4, 2)), np.zeros((1, 3), np.int64)
    assert _arrays.floats(points, "points") is points
    for kind in (np.int32, np.int64):
        given = cells.astype(kind)
        assert np.shares_memory(_arrays.indices(given, "cells", 3, 4), given)


def test_triangles_in_a_plane_of_space_are_flat():
    box = ductile.box((1, 1), (2, 2))
    spatial = np.column_stack([box.points, np.full(len(box.points), 0.7)])
    assert ductile.Mesh(spatial, box.cells).dim == 2
    spatial[0, 2] = 0.8
    surface = ductile.Mesh(spatial, box.cells)
    assert surface.dim == 3 and surface.cells.shape == box.cells.shape


SQUARE = [[0, 0], [1, 0], [1, 1], [0, 1]]
CELLS = [[0, 1, 2], [0, 2, 3]]
WRONG = [
    (lambda: ductile.Mesh([0, 1], CELLS), "points: expected shape"),
    (lambda: ductile.Mesh([[0, 0], [1, np.inf]], [[0, 1, 1]]), r"points\[1, 1\]: .* inf"),
    (lambda: ductile.Mesh(np.array(SQUARE, complex), CELLS), "points: expected .* real"),
    (lambda: ductile.Mesh(SQUARE, [[0, 1, 2], [0, 2, 4]]), r"cells\[1, 2\]: .* 0 to 3, found 4"),
    (lambda: ductile.Mesh(SQUARE, [[0, 1, -1]]), r"cells\[0, 2\]: .* found -1"),
    (lambda: ductile.Mesh(SQUARE, [[0, 1, 2, 3]]), r"cells: expected shape \(n, 3\)"),
    (lambda: ductile.Mesh(SQUARE, [[0.5, 1, 2]]), "cells: expected whole numbers"),
    (lambda: ductile.Mesh(SQUARE, [[0, 1], [2]]), "cells: "),
    (lambda: ductile.Mesh(SQUARE, CELLS, refs=[1]), r"refs: expected shape \(2,\)"),
    (lambda: ductile.Mesh(SQUARE, CELLS, refs=[1, 2.5]), r"refs\[1\]: .* found 2.5"),
    (lambda: ductile.Mesh(SQUARE, CELLS, facets=[[0, 9]]), r"facets\[0, 1\]: .* found 9"),
    (lambda: ductile.Mesh(SQUARE, [[0, 1, 2], [0, 0, 3]]).remesh(.5), r"cells\[1\]"),
    (lambda: ductile.Mesh([*SQUARE, [2, 0]], [[0, 1, 4]]).remesh(.5), r"^cells\[0\] has no volume"),
    (lambda: square().remesh([1, 1, 1]), r"metric: expected shape \(4,\), \(4, 3\) or \(4, 2, 2\)"),
    (lambda: square().remesh([1, 1, -1, 1]), r"metric: .*\[2\].* found -1"),
    (lambda: square().remesh(np.full((4, 3), np.nan)), r"metric: .*\[0\]"),
    (lambda: square().remesh(np.tile([[1., 2], [0, 1]], (4, 1, 1))), "metric: .*symmetric"),
    (lambda: square().remesh(.5, hgrad=.5), "hgrad: expected"),
    (lambda: square().remesh(hmin=2, hmax=1), "^hmin and hmax: expected"),
    (lambda: square().remesh(hmin="x"), "hmin: expected a number, found 'x'"),
    (lambda: square().remesh(.5, iterations=-1), "iterations"),
    (lambda: square().remesh(.5, iterations=1.5), "iterations"),
    (lambda: square().remesh(.5, hsiz=.5), "metric and hsiz"),
    (lambda: square().remesh(.5, required_facets=[7]), r"required_facets\[0\]: .* found 7"),
    (lambda: square().remesh(.5, required_cells=[True]), r"required_cells: expected shape \(2,\)"),
    (lambda: ductile.metric(square(), [1, 2, 3, np.nan], elements=9), r"u\[3\]: .*finite"),
    (lambda: ductile.metric(square(), [1, 2, 3], elements=9), "u: expected 4 rows"),
    (lambda: ductile.metric(square(), [1, 2, 3, 4]), "one of elements, complexity and error"),
    (lambda: ductile.metric(square(), [1, 2, 3, 4], elements=-1), "elements: .*above 0"),
    (lambda: ductile.metric(square(), [1, 2, 3, 4], elements=np.inf), "elements: .*above 0, found inf"),
    (lambda: ductile.intersect([1, 2], [1]), "B: expected 2 rows"),
    (lambda: ductile.Size(.1).near(h=.1), "near: expected one of point, sphere"),
    (lambda: ductile.Size(.1).near(sphere=1, h=.1), "sphere: expected a centre and a radius"),
    (lambda: square().remesh(ductile.Size(.1).on("wall", h=.1)), r"^on\('wall', h=0.1\): expected"),
    (lambda: square().remesh(ductile.Size(.1).on(77, h=.1)), r"^on\(77, h=0.1\): expected"),
    (lambda: ductile.Size().near(point=(0, 0), h=.1).near(box=((0, 0), (1, 1)), h=-1).at(square()),
     r"^near\(box=..., h=-1\): expected a size"),
    (lambda: ductile.Mesh(SQUARE, CELLS, names={"wall": 3}), r"names\['wall'\]: expected a dimension"),
    (lambda: ductile.Mesh(SQUARE, CELLS, names=[("wall", "x", 3)]), r"names\['wall'\]: expected"),
    (lambda: ductile.Mesh(SQUARE, CELLS, names=[("wall", 1, 2**40)]), r"names\['wall'\]: .* 32 bits"),
    (lambda: ductile.Mesh(SQUARE, CELLS, names={5: (1, 2)}), "names: expected a text, found 5"),
    (lambda: square().remesh(.5, hgradreq=.5), "^hgradreq: expected"),
    (lambda: square().remesh(.5, threads=-1), "^threads: expected a whole number from 0"),
    (lambda: square().remesh(.5, threads=None), "^threads: expected a whole number from 0"),
    (lambda: ductile.Geometry(square(), .1, threads=1.5), "^threads: expected a whole number from 0"),
    (lambda: square().remesh(.5, memory=np.nan), "^memory: expected megabytes from 0"),
    (lambda: square().remesh(.5, memory=-1), "^memory: expected megabytes from 0"),
    (lambda: square().save("mesh.vtu", fields={"heat": [1, 2, 3]}), "^heat: expected a row for each"),
    (lambda: square().remesh(.5).transfer([1, 2, 3]), "u: expected a row for each of 4 vertices"),
    (lambda: square().transfer([1, 2, 3, 4]), "source="),
    (lambda: square().facets_on("wall"), "name 'wall': expected one of none"),
    (lambda: square().replace(cell=CELLS), "'cell'"),
    (lambda: square().save("mesh.xyz"), ".mesh, .meshb"),
    (lambda: ductile.read("no-such-file.msh"), "no-such-file.msh: cannot read"),
    (lambda: ductile.draw(square(), "mesh.png"), ".svg"),
    (lambda: ductile.box((1, 1), (2,)), "box: expected"),
]


def square():
    return ductile.Mesh(SQUARE, CELLS)


@pytest.mark.parametrize("number", range(len(WRONG)))
def test_what_is_wrong_is_named(number):
    call, expected = WRONG[number]
    with pytest.raises(ValueError, match=expected) as caught:
        call()
    assert isinstance(caught.value, ductile.InputError) and isinstance(caught.value, ductile.Error)
    assert "\n" not in str(caught.value)


def test_random_arguments_are_taken_or_refused(dim):
    """Arrays of any type, shape and value: a valid mesh, or an error that says something."""
    rng = np.random.default_rng(dim)
    box = ductile.box((1,) * dim, (2,) * dim)

    def spoilt(array):
        kind = rng.integers(8)
        array = array.astype(rng.choice([array.dtype, np.int8, np.int64, np.uint64, np.float32, object]))
        if kind == 0:
            return array[: rng.integers(len(array))]
        if kind == 1:
            return array.reshape(-1)
        if kind == 2:
            array.flat[rng.integers(array.size)] = rng.choice([-1, 0, 100])
        if kind == 3 and array.dtype.kind in "fO":
            array.flat[rng.integers(array.size)] = rng.choice([np.nan, np.inf, 1e30])
        if kind == 4:
            return np.asfortranarray(array)[..., ::-1]
        if kind == 5:
            return [array, None, "x", 1.5, {}][rng.integers(5)]
        return array

    taken = refused = 0
    for _ in range(60):
        points, cells, refs, facets = (spoilt(a) if rng.random() < 0.15 else a for a in
                                       (box.points, box.cells, box.refs, box.facets))
        try:
            mesh = ductile.Mesh(points, cells, refs=refs, facets=facets)
            metric = ductile.implied(mesh)
            metric = spoilt(metric) if rng.random() < 0.3 else metric
            out = mesh.remesh(metric, hmin=0.1, iterations=3)
        except ductile.Error as error:
            assert str(error) and "\n" not in str(error)
            refused += 1
            continue
        assert out.check() == []
        taken += 1
    assert taken > 15 and refused > 15


@pytest.mark.filterwarnings("ignore:.*no place for names")
@pytest.mark.parametrize("ending", [".mesh", ".meshb", ".msh", ".vtu", ".vtk"])
def test_files_keep_everything(tmp_path, dim, ending):
    mesh = shuffled(dim, 3)
    named = mesh.replace(names=[("wall", dim - 1, 1), ("steel", dim, 2)])
    out = named.remesh(0.3)
    path = tmp_path / f"out{ending}"
    out.fields["u"] = out.points @ np.arange(1.0, dim + 1)
    out.cell_fields["volume"] = volumes(out)
    out.save(path)
    again = ductile.read(path)
    for name in ("points", "cells", "refs", "facets", "facet_refs"):
        np.testing.assert_array_equal(getattr(again, name), getattr(out, name), err_msg=name)
    if ending not in (".mesh", ".meshb"):
        np.testing.assert_array_equal(again.fields["u"], out.fields["u"])
        np.testing.assert_array_equal(again.cell_fields["volume"], out.cell_fields["volume"])
        assert again.fields["metric"].shape[0] == len(out.points)
    if ending == ".msh":
        assert sorted(again.names) == sorted(out.names) and again.cells_in("steel").any()


def test_fields_of_their_own_files(tmp_path, mesh):
    M = ductile.implied(mesh)
    ductile.save_field(tmp_path / "M.sol", mesh, M)
    np.testing.assert_array_equal(ductile.read_field(tmp_path / "M.sol"), M)


def test_what_a_format_cannot_hold_is_a_warning(tmp_path, dim):
    mesh = shuffled(dim, 3)
    required = mesh.remesh(0.5, required_facets=mesh.facet_refs == 1)
    with pytest.warns(ductile.InputWarning):
        required.save(tmp_path / "out.su2")
        required.save(tmp_path / "out.vtu")


def test_pickled_and_replaced(mesh):
    out = mesh.remesh(0.4, required_facets=[0, 3])
    again = pickle.loads(pickle.dumps(out))
    for name in ("points", "cells", "refs", "facets", "facet_refs", "vertex_refs", "edges",
                 "edge_refs", "required_facets", "required_vertices", "metric"):
        np.testing.assert_array_equal(getattr(again, name), getattr(out, name), err_msg=name)
    moved = out.replace(points=out.points * 2)
    np.testing.assert_array_equal(moved.points, 2 * out.points)
    np.testing.assert_array_equal(moved.required_facets, out.required_facets)
    assert moved.check() == []


def test_pictures_and_notebooks(tmp_path, mesh):
    out = mesh.remesh(0.15)
    path = tmp_path / "mesh.svg"
    for by in (None, out.points[:, 0], out.quality()):
        svg = ductile.draw(out, path, by)
        assert path.read_text() == svg
        assert svg.count("<path") > 1 and "nan" not in svg
        inside = [float(x) for x in re.findall(r"[ML](\d+\.\d) ", svg)]
        assert len(inside) > len(out.facets) / 2 and min(inside) >= 0 and max(inside) <= 800
    page = out._repr_html_()
    assert page.startswith("<div") and "<svg" in page and "quality" in page and "converged" in page


def test_stubs_name_what_the_module_has():
    import ast
    import pathlib

    from ductile import _ductile
    stub = pathlib.Path(ductile.__file__).with_name("_ductile.pyi").read_text(encoding="utf-8")
    said = {}
    for node in ast.parse(stub).body:
        if isinstance(node, ast.ClassDef):
            said[node.name] = {part.name if isinstance(part, ast.FunctionDef) else part.target.id
                               for part in node.body
                               if isinstance(part, (ast.FunctionDef, ast.AnnAssign))}
        elif isinstance(node, (ast.FunctionDef, ast.AnnAssign)):
            said[node.name if isinstance(node, ast.FunctionDef) else node.target.id] = None
    has = {name for name in dir(_ductile) if not name.startswith("__")}
    assert has == set(said)
    for name, members in said.items():
        if members:
            kind = getattr(_ductile, name)
            theirs = {member for member in vars(kind) if not member.startswith("__")}
            theirs -= {"name", "value"} if hasattr(kind, "__members__") else set()
            assert theirs == members - {"__init__"}, name
    assert sorted(ductile.__all__) == ductile.__all__ and all(
        getattr(ductile, name).__doc__ for name in ductile.__all__)
