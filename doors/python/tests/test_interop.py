"""meshio, VTK and PETSc where they are installed; the example, where scipy is."""

import builtins
import gc
import importlib.util
import pathlib

import numpy as np
import pytest

import ductile
from conftest import shuffled, volumes


@pytest.fixture
def out(dim):
    mesh = shuffled(dim, 2).replace(names={"wall": (dim - 1, 1), "steel": (dim, 2)})
    adapted = mesh.remesh(0.25)
    adapted.fields["u"] = adapted.points @ np.arange(1.0, dim + 1)
    adapted.cell_fields["volume"] = volumes(adapted)
    return adapted


def test_meshio_there_and_back(out, tmp_path):
    meshio = pytest.importorskip("meshio")
    arguments = out.to_meshio()
    assert np.shares_memory(arguments["points"], out.points)
    theirs = meshio.Mesh(**arguments)
    again = ductile.from_meshio(theirs)
    for name in ("points", "cells", "refs", "facet_refs", "facets", "edges", "edge_refs"):
        np.testing.assert_array_equal(getattr(again, name), getattr(out, name), err_msg=name)
    assert sorted(again.names) == sorted(out.names)
    np.testing.assert_array_equal(again.fields["u"], out.fields["u"])
    np.testing.assert_array_equal(again.cell_fields["volume"], out.cell_fields["volume"])
    out.save(tmp_path / "out.vtu")
    read = meshio.read(tmp_path / "out.vtu")
    assert len(ductile.from_meshio(read).cells) == len(out.cells)
    theirs.write(tmp_path / "theirs.msh", file_format="gmsh22")
    assert len(ductile.read(tmp_path / "theirs.msh").cells) == len(out.cells)
    quads = meshio.Mesh(np.zeros((4, 3)), [("quad", [[0, 1, 2, 3]])])
    with pytest.raises(ductile.InputError, match=r"cells\[0\]: .* found quad"):
        ductile.from_meshio(quads)


def test_vtk(out):
    pytest.importorskip("vtkmodules")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    for boundary in (False, True):
        grid = out.to_vtk({"u": out.fields["u"], "q": out.quality()}, boundary=boundary)
        count = len(out.cells)
        points = vtk_to_numpy(grid.GetPoints().GetData())
        np.testing.assert_array_equal(points[:, :out.dim], out.points)
        assert out.dim == 2 or np.shares_memory(points, out.points)
        assert grid.GetNumberOfCells() == count + boundary * len(out.facets)
        connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        np.testing.assert_array_equal(connectivity[:out.cells.size], out.cells.ravel())
        assert np.shares_memory(connectivity, out.cells) is not boundary
        u = vtk_to_numpy(grid.GetPointData().GetArray("u")).ravel()
        np.testing.assert_array_equal(u, out.fields["u"])
        regions = vtk_to_numpy(grid.GetCellData().GetArray("region"))
        np.testing.assert_array_equal(regions.ravel()[:count], out.refs)
        assert grid.GetCellType(0) == (5 if out.dim == 2 else 10)
        again = ductile.from_vtk(grid)
        for name in ("points", "cells", "refs") + (("facets", "facet_refs") if boundary else ()):
            np.testing.assert_array_equal(getattr(again, name), getattr(out, name), err_msg=name)
        np.testing.assert_array_equal(again.fields["u"].ravel(), out.fields["u"])
        np.testing.assert_array_equal(again.cell_fields["q"].ravel(), out.quality())


def test_vtk_of_others():
    vtk = pytest.importorskip("vtkmodules.vtkFiltersSources")
    plane = vtk.vtkDiskSource()
    plane.SetCircumferentialResolution(12)
    plane.Update()
    with pytest.raises(ductile.InputError, match="cell 0: expected triangles"):
        ductile.from_vtk(plane.GetOutput())
    filters = pytest.importorskip("vtkmodules.vtkFiltersCore")
    triangles = filters.vtkTriangleFilter()
    triangles.SetInputConnection(plane.GetOutputPort())
    triangles.Update()
    disk = ductile.from_vtk(triangles.GetOutput())
    assert disk.dim == 2 and disk.remesh(0.1).check() == []


def test_vtk_keeps_memory_alive(dim):
    vtk = pytest.importorskip("vtkmodules.vtkCommonDataModel")
    from vtkmodules.util.numpy_support import vtk_to_numpy
    mesh = ductile.box((1,) * dim, (6,) * dim)
    expected = mesh.points.copy(), mesh.cells.copy(), 2 * mesh.points[:, 0]
    grids = []
    for boundary in (False, True):
        copy = vtk.vtkUnstructuredGrid()
        copy.ShallowCopy(mesh.to_vtk({"u": 2 * mesh.points[:, 0]}, boundary=boundary))
        grids.append(copy)  # as pyvista.wrap does
    del mesh
    gc.collect()
    garbage = [np.full(n, 7, np.int32) for n in range(0, 6000, 7)]
    for grid in grids:
        points = vtk_to_numpy(grid.GetPoints().GetData())[:, :dim]
        np.testing.assert_array_equal(points, expected[0])
        connectivity = vtk_to_numpy(grid.GetCells().GetConnectivityArray())
        np.testing.assert_array_equal(connectivity[:expected[1].size], expected[1].ravel())
        u = vtk_to_numpy(grid.GetPointData().GetArray("u")).ravel()
        np.testing.assert_array_equal(u, expected[2])
    assert garbage


def test_dmplex(out):
    petsc = pytest.importorskip("petsc4py.PETSc")
    options = petsc.Options()
    options["dm_plex_check_all"] = True
    try:
        plex = out.to_dmplex(petsc.COMM_SELF)
        plex.setFromOptions()
    finally:
        options.delValue("dm_plex_check_all")
    first, last = plex.getHeightStratum(0)
    assert last - first == len(out.cells)
    volume = [plex.computeCellGeometryFVM(cell)[0] for cell in range(first, last)]
    np.testing.assert_allclose(volume, volumes(out), rtol=1e-10)
    for label, refs in (("Cell Sets", out.refs), ("Face Sets", out.facet_refs)):
        for ref, times in zip(*np.unique(refs, return_counts=True)):
            assert plex.getStratumSize(label, int(ref)) == times


def test_what_is_not_installed_is_said_clearly(monkeypatch):
    mesh = ductile.box((1, 1), (2, 2))
    real = builtins.__import__

    def without(name, *rest):
        if name.startswith(("vtkmodules", "petsc4py")):
            raise ImportError(name)
        return real(name, *rest)

    monkeypatch.setattr(builtins, "__import__", without)
    with pytest.raises(ImportError, match="to_vtk needs the Python module of VTK: install vtk"):
        mesh.to_vtk()
    with pytest.raises(ImportError, match="to_dmplex needs petsc4py: install it"):
        mesh.to_dmplex()


def test_example_solves_adapts_and_transfers(tmp_path, capsys):
    pytest.importorskip("scipy")
    path = pathlib.Path(__file__).parent.parent / "examples" / "solve_and_adapt.py"
    spec = importlib.util.spec_from_file_location("example", path)
    example = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(example)
    mesh, u = example.main(3, tmp_path / "front.svg", elements=2000)
    assert mesh.check() == [] and (tmp_path / "front.svg").exists()
    assert 0.9 < u.max() < 1.01 and u.min() > -0.01
    centre = (u[:, None] * mesh.points).sum(axis=0) / u.sum()
    assert centre[0] < 0.5  # it has been carried around
    integrals = [float(line.split("integral ")[1].split(",")[0])
                 for line in capsys.readouterr().out.splitlines()]
    assert len(integrals) == 3 and max(integrals) - min(integrals) < 1e-5


@pytest.mark.parametrize("components", [(), (1,), (2,), (3,), (4,), (6,), (9,), (2, 2), (3, 3)])
def test_meshio_writes_all_fields_of_an_adapted_mesh_as_msh_2(dim, components, tmp_path):
    meshio = pytest.importorskip("meshio")
    if dim == 3 and np.prod(components) == 4:
        pytest.skip("neither a vector nor a tensor in space")
    out = ductile.box((1,) * dim, (4,) * dim).remesh(0.3)
    out.fields = {"metric": out.metric, "u": np.ones((len(out.points), *components))}
    out.cell_fields = {"q": np.ones((len(out.cells), *components))}
    meshio.Mesh(**out.to_meshio()).write(tmp_path / "out.msh", file_format="gmsh22")
    read = ductile.read(tmp_path / "out.msh")
    np.testing.assert_array_equal(read.cells, out.cells)
    assert set(read.fields) >= {"u"}
