"""The loops of docs/solvers.md, each where its solver is installed: adapted meshes beat even ones, and names stay."""

import importlib.util
import os
import pathlib
import shutil
import subprocess
import sys

import numpy as np
import pytest

import ductile

EXAMPLES = pathlib.Path(__file__).parents[3] / "docs" / "examples"
PROGRAM = os.environ.get("DUCTILE_PROGRAM", "")
# The scripts of FreeFEM call the program; the package for Python is also built and tested without it.
needs_program = pytest.mark.skipif(not PROGRAM, reason="the program is not built with the package")


def run(folder, *command):
    """What a script prints: {kind: (rows with elements, error, seconds of solving, of adapting)}, and all of it."""
    environment = {**os.environ, "FF_LOADPATH": "/usr/lib/freefem++;;", "OMP_NUM_THREADS": "1",
                   "PATH": os.path.dirname(PROGRAM) + os.pathsep + os.environ["PATH"]}
    done = subprocess.run([str(word) for word in command], cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    rows = {}
    for line in done.stdout.splitlines():
        words = line.split()
        if words and words[0] in ("uniform", "adapted", "adaptmesh"):
            rows.setdefault(words[0], []).append([float(word) for word in words[1:]])
    return {kind: np.array(table) for kind, table in rows.items()}, done.stdout


def gain(rows):
    """How many times smaller the error on the last adapted mesh is than on an even one with as many elements, by the
    line through the two finest even ones in logarithms."""
    even = rows["uniform"][np.argsort(rows["uniform"][:, 0])][-2:]
    (n0, n1), (e0, e1) = np.log(even[:, 0]), np.log(even[:, 1])
    elements, error = np.log(rows["adapted"][-1, :2])
    return np.exp(e1 + (e1 - e0) / (n1 - n0) * (elements - n1) - error)


def lengths(mesh, name):
    corner = mesh.points[mesh.facets[mesh.facets_on(name)]]
    edges = corner[:, 1:] - corner[:, :1]
    return np.sqrt(np.linalg.det(edges @ edges.transpose(0, 2, 1))).sum() / (mesh.dim - 1)


def test_dolfinx(tmp_path):
    if importlib.util.find_spec("dolfinx") is None:
        pytest.skip("dolfinx is not installed (python3-dolfinx)")
    rows, _ = run(tmp_path, sys.executable, EXAMPLES / "dolfinx_corner.py", 2500, "out.vtu")
    assert gain(rows) > 4
    mesh = ductile.read(tmp_path / "out.vtu")
    assert mesh.check() == []
    assert lengths(mesh, "corner") == pytest.approx(2) and lengths(mesh, "rim") == pytest.approx(6)


@needs_program
@pytest.mark.parametrize("script", ["freefem_layer.edp", "freefem_front.edp"])
def test_freefem(script, tmp_path):
    if shutil.which("FreeFem++") is None:
        pytest.skip("FreeFEM is not installed (freefem++)")
    rows, said = run(tmp_path, "FreeFem++", "-nw", "-v", 0, EXAMPLES / script, "-most", 11000)
    assert gain(rows) > 3
    measures = [float(line.split(": ")[1]) for line in said.splitlines() if line.startswith(("area", "length"))]
    assert measures == pytest.approx([1] * len(measures)) and len(measures) in (4, 6)


@needs_program
def test_openfoam(tmp_path):
    if shutil.which("gmshToFoam") is None:
        pytest.skip("OpenFOAM is not installed (openfoam)")
    rows, _ = run(tmp_path, sys.executable, EXAMPLES / "openfoam_pipe.py", 4500, "out.vtu")
    assert gain(rows) > 3
    mesh = ductile.read(tmp_path / "out.vtu")
    assert mesh.check() == []
    arc = np.pi / 2 * 0.25
    assert lengths(mesh, "inner") == pytest.approx(0.05 * arc, rel=0.05)
    assert lengths(mesh, "outer") == pytest.approx(arc, rel=0.01)
