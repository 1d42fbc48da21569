"""The commands and the Python of the documentation run as they are written, in a folder with the files they name.

The output below them, which may be shortened, may differ in numbers only."""

import os
import pathlib
import re
import shutil
import subprocess
import warnings

import numpy as np
import pytest

import ductile

ROOT = pathlib.Path(__file__).parents[3]
PAGES = ["README.md", "CONTRIBUTING.md", "doors/python/README.md", "docs/gallery/README.md",
         *(f"docs/{path.name}" for path in (ROOT / "docs").glob("*.md"))]
PROGRAM = os.environ.get("DUCTILE_PROGRAM", "")
# What other tests run: ./dev's commands themselves, installs, the runtime's guide, PETSc, solvers.
ELSEWHERE = {"cmake", "mkdir", "pip", "sudo", "apt", "python3", "env/bin/pip", "cc", "gfortran", "mmg3d_O3", "mpirun", "build/flips",
             "FreeFem++", "gmshToFoam", "laplacianFoam", "foamToVTK"}


def blocks(page, *languages):
    """(code, output) of the page's blocks in these languages. A block of no language right below is the output."""
    text = (ROOT / page).read_text(encoding="utf-8")
    found = re.findall(r"^ *```(\S+)\n(.*?)^ *```\n(?:\n```\n(.*?)^```\n)?", text, re.MULTILINE | re.DOTALL)
    return [(code, output) for language, code, output in found if language in languages]


def commands(code):
    """The command lines of a block, without comments, settings of variables and line ends after a backslash."""
    lines = (re.sub(r"(^|\s)#.*", "", line).strip() for line in code.replace("\\\n", " ").splitlines())
    return [re.sub(r"^([A-Z_]+=(\"[^\"]*\"|\S*)\s+)*", "", line) for line in lines if line]


def runs_here(code):
    return all(line.startswith(("ductile ", "cp ~/ductile/docs/examples/bracket.")) for line in commands(code))


def not_said(output, said):
    """The lines of the output that do not occur in what was said, numbers aside."""

    def shapes(text):
        return [re.sub(r"\d[\d.,]*", "N", line.strip()) for line in text.splitlines()]

    return [line for line in shapes(output) if line not in shapes(said)]


def save_bodies(folder):
    """box.vtu with a ball's function, and blade.mesh, whose blade turns so little that its mesh stays."""
    box = ductile.box((1, 1, 1), (8, 8, 8))
    box.save(folder / "box.vtu", fields={"phi": np.linalg.norm(box.points - 0.5, axis=1) - 0.3})
    square = ductile.box((1, 1), (12, 12))
    across = (square.points - 0.5) * [2, 4]
    blade = square.cut(np.linalg.norm(across, axis=1) - 0.5).remesh(1 / 12, hausd=0.002)
    turn = np.zeros_like(blade.points)
    inside = np.unique(blade.cells[blade.refs == 3])
    turn[inside] = 0.01 * (blade.points[inside] - 0.5)[:, ::-1] * [-1, 1]
    blade.metric = None
    blade.save(folder / "blade.mesh")
    for name in ("turn", "turn2"):
        ductile.save_field(folder / f"{name}.sol", blade, turn)


@pytest.fixture(scope="session")
def parts(tmp_path_factory):
    """A folder with the files that the pages name: bracket.*, and part.*, which is a fifth of a unit long."""
    folder = tmp_path_factory.mktemp("parts")
    examples = ROOT / "docs" / "examples"
    for name in ("bracket.msh", "bracket.py", "waves2d.mesh", "waves2d.sol"):
        shutil.copy(examples / name, folder)
    mesh = ductile.read(examples / "bracket.msh")
    mesh = mesh.replace(points=0.5 + (mesh.points - mesh.points.mean(axis=0)) / 600)
    mesh.save(folder / "part.msh")
    mesh.fields = {"u": np.tanh(50 * (mesh.points[:, 0] - 0.5))}
    mesh.cell_fields = {"material": np.ones(len(mesh.cells))}
    mesh.save(folder / "part.vtu")
    fine = mesh.remesh(0.01)
    fine.metric = None
    fine.save(folder / "fine.vtu")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ductile.InputWarning)  # names have no place in these
        for name, saved in (("part", mesh), ("start", mesh), ("step3", fine)):
            saved.save(folder / f"{name}.mesh")
            ductile.save_field(folder / f"{name}.sol", saved, np.full(len(saved.points), 0.02))
        for name in ("part.stl", "scan.ply"):
            ductile.Mesh(mesh.points, mesh.facets).save(folder / name)
    save_bodies(folder)
    box = ductile.box((1, 1), (8, 8))
    box.replace(refs=1 + (box.points[box.cells].mean(axis=1)[:, 0] > 0.5)).save(folder / "square.mesh")
    return folder


@pytest.fixture
def folder(parts, tmp_path, monkeypatch):
    """A copy of that, in which the test runs; ~/ductile is the source tree, and ductile is on the PATH."""
    (tmp_path / "ductile").symlink_to(ROOT)
    monkeypatch.setenv("HOME", str(tmp_path))
    if PROGRAM:
        monkeypatch.setenv("PATH", os.path.dirname(PROGRAM), prepend=os.pathsep)
    monkeypatch.chdir(shutil.copytree(parts, tmp_path / "work"))
    monkeypatch.syspath_prepend(tmp_path / "work")
    pathlib.Path("docs").symlink_to(ROOT / "docs")  # some pages' commands are for the top of the tree


@pytest.mark.skipif(not PROGRAM, reason="the program is not built with the package")
@pytest.mark.parametrize("page", [page for page in PAGES if any(runs_here(code) for code, _ in blocks(page, "sh"))])
def test_commands_of_the_program_run(page, folder):
    for code, output in blocks(page, "sh"):
        if runs_here(code):
            done = subprocess.run(["bash", "-e", "-c", code], capture_output=True, text=True)
            assert done.returncode == 0, code + done.stderr
            assert not_said(output, done.stdout) == []


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "sh", "bash")])
def test_other_commands_are_run_by_other_tests(page):
    known = set(re.search(r"\n  (demo \| .*?)\) \"cmd_", (ROOT / "dev").read_text())[1].split(" | "))
    known |= {"install-test", "paper-test", "bench-test", "test-petsc"}
    for code, _ in blocks(page, "sh", "bash"):
        for line in commands(code) if not runs_here(code) else ():
            program, *words = line.split()
            if program == "./dev":
                assert words[0] in known, line
            else:
                assert program in ELSEWHERE | {"ductile", "cp"}, line


@pytest.mark.parametrize("page", [page for page in PAGES if blocks(page, "python")])
def test_python_runs(page, folder, capsys):
    """Each block goes on where the one before ended. PETSc's pages are only compiled."""
    if page == "docs/first-part.md":
        pytest.importorskip("scipy")
    names = {}
    if page.startswith("docs/gallery"):
        mesh = ductile.box((1, 1), (4, 4))
        names = {"ductile": ductile, "mesh": mesh, "new": mesh.remesh(0.1), "u": mesh.points[:, 0]}
    for code, output in blocks(page, "python"):
        run = compile(code, page, "exec")
        if page != "docs/petsc.md":
            capsys.readouterr()
            exec(run, names)
            assert not_said(output, capsys.readouterr().out) == []
    if page == "docs/python.md":
        for picture in ("sizes.svg", "front.svg"):
            assert "<svg" in pathlib.Path(picture).read_text()
