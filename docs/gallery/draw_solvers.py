#!/usr/bin/env python3
"""Runs the loops of docs/solvers.md and draws each: the last adapted mesh beside the error against the elements.

    python3 docs/gallery/draw_solvers.py [NAME...]      dolfinx, freefem-2d, freefem-3d, openfoam; default: all

Needs the solvers, matplotlib, and ductile on the PATH and in Python. Prints the tables of the page.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

import matplotlib
import numpy as np

import ductile

matplotlib.use("Agg")
import matplotlib.pyplot as plt

HERE = pathlib.Path(__file__).resolve().parent
EXAMPLES = HERE.parent / "examples"
LOOPS = {  # name: command, the mesh and its field, elements of the mesh that is drawn, panel of `ductile view` or None
    "dolfinx": ([sys.executable, EXAMPLES / "dolfinx_corner.py"], "out.vtu", "u", 1600, None),
    "freefem-2d": (["FreeFem++", "-nw", "-v", 0, EXAMPLES / "freefem_front.edp"], "front.mesh", "u.sol", 2000, None),
    "freefem-3d": (["FreeFem++", "-nw", "-v", 0, EXAMPLES / "freefem_layer.edp"], "layer.mesh", "u.sol", 16000, 1),
    "openfoam": ([sys.executable, EXAMPLES / "openfoam_pipe.py"], "out.vtu", "temperature", 8000, 0),
}
KINDS = {"uniform": ("even meshes", "o-", "0.55"), "adaptmesh": ("FreeFEM's adaptmesh", "s-", "tab:blue"),
         "adapted": ("Ductile", "o-", "tab:red")}


def rows_of(said):
    rows = {}
    for line in said.splitlines():
        words = line.split()
        if words and words[0] in KINDS:
            rows.setdefault(words[0], {})[int(words[1])] = [float(word) for word in words[2:]]
    return rows


def draw_errors(axes, rows, what):
    for kind, table in rows.items():
        label, line, colour = KINDS[kind]
        elements = sorted(table)
        axes.loglog(elements, [table[n][0] for n in elements], line, color=colour, label=label, markersize=4)
    axes.set(xlabel=what, ylabel="error in the L2 norm")
    axes.grid(True, which="both", linewidth=0.3)
    axes.legend(frameon=False)


def draw_mesh(axes, folder, path, field, panel):
    axes.axis("off")
    if panel is not None:  # in space
        sol = ["-sol", field, "--by", "1"] if field.endswith(".sol") else ["--by", field]
        subprocess.run(["ductile", "view", path, *sol, "--cut", "z", "-o", "mesh.png", "--size", "800"], cwd=folder,
                       check=True)
        picture = plt.imread(folder / "mesh.png")
        half = picture.shape[1] // 2
        axes.imshow(picture[48:-70, panel * half:(panel + 1) * half])
        return
    mesh = ductile.read(folder / path)
    u = mesh.fields[field] if field in mesh.fields else ductile.read_field(folder / field)
    x, y = mesh.points.T
    axes.tripcolor(x, y, mesh.cells, np.ravel(u), shading="gouraud", cmap="viridis")
    axes.triplot(x, y, mesh.cells, linewidth=0.25, color="black")
    axes.set_aspect("equal")


def run(folder, command, most):
    words = [str(word) for word in command]
    words += [str(most), "out.vtu"] if words[0] == sys.executable else ["-most", str(most)]
    done = subprocess.run(words, cwd=folder, stdout=subprocess.PIPE, text=True, check=True,
                          env={"FF_LOADPATH": "/usr/lib/freefem++;;", **os.environ})
    return done.stdout


def main(names):
    for name in names or LOOPS:
        command, path, field, shown, panel = LOOPS[name]
        with tempfile.TemporaryDirectory() as place:
            folder = pathlib.Path(place)
            said = run(folder, command, 100000)
            print(f"{name}\n{said}", flush=True)
            figure, (left, right) = plt.subplots(1, 2, figsize=(10, 4.2), width_ratios=(1.1, 1))
            run(folder, command, shown)
            draw_mesh(left, folder, path, field, panel)
            draw_errors(right, rows_of(said), "triangles" if panel is None else "tetrahedra")
            figure.tight_layout()
            figure.savefig(HERE / f"solver-{name}.png", dpi=100)


if __name__ == "__main__":
    main(sys.argv[1:])
