#!/usr/bin/env python3
"""Heat through the wall of a pipe with OpenFOAM, on tetrahedra that follow the solution, and on even ones.

    python3 docs/examples/openfoam_pipe.py [MOST [MESH.vtu]]

At most MOST tetrahedra; the last adapted mesh goes to the file. A quarter of the pipe, hot inside and cold outside.
Gmsh's format takes meshes to OpenFOAM (gmshToFoam), VTK's takes solutions back (foamToVTK). Each line has the kind of
mesh, its tetrahedra, the error of the temperature in the L2 norm, and the seconds of solving, with the way there and
back, and of adapting.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time

import numpy as np

import ductile

INNER, OUTER, LONG = 0.05, 1.0, 0.25
FOAM_AT = {"WM_PROJECT_DIR": "/usr/share/openfoam"}  # Debian's; others set it themselves
FOAM = 'FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n{}\n'
CASE = {  # file: class, contents
    "system/controlDict": ("dictionary", """application laplacianFoam; startFrom startTime; startTime 0; endTime 1;
        stopAt endTime; deltaT 1; writeControl timeStep; writeInterval 1; writePrecision 10;"""),
    "system/fvSchemes": ("dictionary", """ddtSchemes { default steadyState; } gradSchemes { default leastSquares; }
        divSchemes { default none; } laplacianSchemes { default Gauss linear corrected; }
        interpolationSchemes { default linear; } snGradSchemes { default corrected; }"""),
    "system/fvSolution": ("dictionary", """solvers { T { solver PCG; preconditioner DIC; tolerance 1e-10; relTol 0; } }
        SIMPLE { nNonOrthogonalCorrectors 8; }"""),
    "constant/transportProperties": ("dictionary", "DT [0 2 -1 0 0 0 0] 1;"),
    "0/T": ("volScalarField", """dimensions [0 0 0 1 0 0 0]; internalField uniform 0; boundaryField {
        inner { type fixedValue; value uniform 1; } outer { type fixedValue; value uniform 0; }
        sides { type zeroGradient; } }"""),
}


def exact(points):
    return np.log(np.hypot(points[:, 0], points[:, 1]) / OUTER) / np.log(INNER / OUTER)


def quarter_pipe():
    """Thin tetrahedra for a start, with names on the boundary."""
    box = ductile.box((1, 1, 1), (16, 24, 4))
    radius = INNER + (OUTER - INNER) * box.points[:, 0]
    angle = np.pi / 2 * box.points[:, 1]
    points = np.column_stack([radius * np.cos(angle), radius * np.sin(angle), LONG * box.points[:, 2]])
    at = radius[box.facets]
    refs = np.select([(at < INNER + 1e-9).all(axis=1), (at > OUTER - 1e-9).all(axis=1)], [1, 2], 3)
    return ductile.Mesh(points, box.cells, facets=box.facets, facet_refs=refs,
                        names={"inner": (2, 1), "outer": (2, 2), "sides": (2, 3)})


def solve(mesh, folder):
    """The mesh as OpenFOAM has it, with the temperature at its vertices and on its cells."""
    for name, (kind, text) in CASE.items():
        path = folder / name
        path.parent.mkdir(exist_ok=True)
        path.write_text(FOAM.format(kind, path.name, text))
    mesh.save(folder / "mesh.vtu")
    for command in (["ductile", "convert", "mesh.vtu", "mesh.msh", "--version-of-file", "2"], ["gmshToFoam", "mesh.msh"],
                    ["laplacianFoam"], ["foamToVTK", "-latestTime", "-ascii"]):
        done = subprocess.run(command, cwd=folder, capture_output=True, text=True, env=FOAM_AT | os.environ)
        assert done.returncode == 0, " ".join(command) + ": " + done.stdout[-2000:] + done.stderr
    return ductile.read(next(folder.glob("VTK/*/internal.vtu")))


def error_of(foam):
    corner = foam.points[foam.cells]
    volume = np.abs(np.linalg.det(corner[:, 1:] - corner[:, :1])) / 6
    return np.sqrt(volume @ (foam.cell_fields["T"].ravel() - exact(corner.mean(axis=1)))**2)


def main(most=30000, path=None):
    def step(kind, mesh, adapting):
        begin = time.perf_counter()
        with tempfile.TemporaryDirectory() as folder:
            foam = solve(mesh, pathlib.Path(folder))
        print(f"{kind} {len(mesh.cells)} {error_of(foam):.2e} {time.perf_counter() - begin:.2f} {adapting:.2f}", flush=True)
        return ductile.transfer(foam, foam.fields["T"], mesh)  # OpenFOAM may have changed the order of the vertices

    start = quarter_pipe()
    geometry = ductile.Geometry(start, hausd=0.0005)
    for size in (0.06, 0.08, 0.11, 0.15):
        mesh = start.remesh(size, geometry=geometry)
        if len(mesh.cells) <= most:
            temperature = step("uniform", mesh, 0)
    for elements in (n for n in (2000, 4000, 8000, 16000) if n <= most):
        begin = time.perf_counter()
        metric = ductile.metric(mesh, temperature, elements=elements, anisotropy=2, hgrad=1.3)
        mesh = mesh.remesh(metric, geometry=geometry, hgrad=1.3)
        temperature = step("adapted", mesh, time.perf_counter() - begin)
    if path:
        mesh.save(path, fields={"temperature": temperature})


if __name__ == "__main__":
    main(*map(int, sys.argv[1:2]), *sys.argv[2:])
