"""ductile-mpi as its users run it: program_cases.py MPIRUN DUCTILE_MPI DUCTILE RANKS.

The output is valid, references keep their measures, fields their integrals; the same bytes come in
separate runs with other numbers of threads; what goes wrong is told, and nothing is written.
"""

import itertools
import os
import pathlib
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

mpirun, ductile_mpi, ductile, ranks = sys.argv[1:]
os.chdir(tempfile.mkdtemp())
mpi = [mpirun, "--allow-run-as-root", "--oversubscribe", "--bind-to", "none", "-n", ranks]


def run(words, status=0):
    done = subprocess.run(words, capture_output=True, text=True, timeout=100)
    if done.returncode != status:
        sys.exit(f"{words}: expected status {status}, found {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stdout + done.stderr


def adapt(*words, status=0):
    return run([*mpi, ductile_mpi, "adapt", *words], status)


def expect(truth, message):
    if not truth:
        sys.exit(message)


# ---- Meshes as .mesh files ----


def box(dim, n):
    """The unit box, cut in two regions at x = 1/2; sides are references 1 and up, the cut 99."""
    steps = list(itertools.product(range(n + 1), repeat=dim))
    number = {at: i for i, at in enumerate(steps)}
    points = [[a / n for a in at] for at in steps]
    cells, facets = [], {}
    for at in itertools.product(range(n), repeat=dim):
        for order in itertools.permutations(range(dim)):
            corner, cell = list(at), [number[at]]
            for d in order:
                corner[d] += 1
                cell.append(number[tuple(corner)])
            region = 1 if 2 * at[0] < n else 2
            cells.append((cell, region))
            for facet in itertools.combinations(cell, dim):
                facets.setdefault(tuple(sorted(facet)), []).append(region)
    listed = []
    for facet, regions in facets.items():
        if len(regions) == 1:
            for d, end in itertools.product(range(dim), (0, 1)):
                if all(points[v][d] == end for v in facet):
                    listed.append((facet, 1 + 2 * d + end))
        elif regions[0] != regions[1]:
            listed.append((facet, 99))
    return points, cells, listed


def write_mesh(name, dim, points, cells, facets, kept=()):
    names = {2: ("Edges", "Triangles"), 3: ("Triangles", "Tetrahedra")}[dim]
    with open(name, "w") as file:
        print("MeshVersionFormatted 2\nDimension", dim, "\nVertices", len(points), file=file)
        for p in points:
            print(*p, 0, file=file)
        for word, list in zip(names, (facets, cells)):
            print(word, len(list), file=file)
            for corners, reference in list:
                print(*[c + 1 for c in corners], reference, file=file)
        if kept:
            print("RequiredVertices", len(kept), *[v + 1 for v in kept], file=file)
        print("End", file=file)


def write_sol(name, dim, values):
    with open(name, "w") as file:
        print("MeshVersionFormatted 2\nDimension", dim, "\nSolAtVertices", len(values), file=file)
        print("1 1", *values, "End", sep="\n", file=file)


def sections(name):
    words = iter(pathlib.Path(name).read_text().split())
    found = {}
    width = {"Vertices": None, "Edges": 3, "Triangles": 4, "Tetrahedra": 5}
    dim = 0
    for word in words:
        if word == "Dimension":
            dim = int(next(words))
        elif word in width:
            each = width[word] or dim + 1
            count = int(next(words))
            found[word] = [[float(next(words)) for _ in range(each)] for _ in range(count)]
        elif word in ("RequiredVertices", "SolAtVertices"):
            count = int(next(words))
            skip = 2 if word == "SolAtVertices" else 0
            for _ in range(skip):
                next(words)
            found[word] = [float(next(words)) for _ in range(count)]
    return dim, found


def determinant(m):
    if len(m) == 1:
        return m[0][0]
    return sum(
        (-1) ** j * m[0][j] * determinant([row[:j] + row[j + 1 :] for row in m[1:]])
        for j in range(len(m))
    )


def measure(points):
    """Length, area or volume of a simplex, by its Gram matrix."""
    edges = [[a - b for a, b in zip(p, points[0])] for p in points[1:]]
    gram = [[sum(a * b for a, b in zip(u, v)) for v in edges] for u in edges]
    return max(0.0, determinant(gram)) ** 0.5 / (1, 1, 2, 6)[len(edges)]


def measures(name):
    """{(cell or facet, reference): measure}"""
    dim, found = sections(name)
    points = [p[:dim] for p in found["Vertices"]]
    sums = {}
    for kind, word in (("facet", ("Edges", "Triangles")[dim - 2]), ("cell", ("Triangles", "Tetrahedra")[dim - 2])):
        for *corners, reference in found[word]:
            size = measure([points[int(c) - 1] for c in corners])
            sums[kind, reference] = sums.get((kind, reference), 0.0) + size
    return sums


def integral(mesh, values):
    dim, found = sections(mesh)
    points = [p[:dim] for p in found["Vertices"]]
    total = 0.0
    for *corners, _ in found[("Triangles", "Tetrahedra")[dim - 2]]:
        at = [int(c) - 1 for c in corners]
        total += measure([points[v] for v in at]) * sum(values[v] for v in at) / (dim + 1)
    return total


# ---- What is tried ----


def small_near_middle(x):
    return 0.02 * (len(x) - 1) + 0.25 * abs(x[0] - 0.5 - 0.1 * x[1])


def try_box(dim, n):
    points, cells, facets = box(dim, n)
    kept = min(range(len(points)), key=lambda v: sum((a - 0.3) ** 2 for a in points[v]))
    write_mesh("in.mesh", dim, points, cells, facets, [kept])
    write_sol("in.sol", dim, [small_near_middle(x) for x in points])
    u = [1 + x[0] * x[0] + (3 if x[1] > 0.5 else 0) for x in points]
    write_sol("u.sol", dim, u)
    text = adapt("in.mesh", "-o", "out.mesh", "--field", "u.sol", "--threads", "1")
    expect("pass 1:" in text and "blocked" in text, text)
    run([ductile, "info", "out.mesh", "-sol", "out.sol"])
    before, after = measures("in.mesh"), measures("out.mesh")
    expect(before.keys() == after.keys(), f"references {sorted(before)} became {sorted(after)}")
    for key in before:
        expect(abs(before[key] - after[key]) < 1e-9, f"{dim}D: {key}: {before[key]} became {after[key]}")
    _, found = sections("out.mesh")
    stays = found["Vertices"][int(found["RequiredVertices"][0]) - 1][:dim]
    expect(stays == points[kept], f"{dim}D: a required vertex went to {stays}")
    carried = sections("out.u.sol")[1]["SolAtVertices"]
    expect(min(u) <= min(carried) and max(carried) <= max(u), f"{dim}D: bounds of a field are lost")
    old, new = integral("in.mesh", u), integral("out.mesh", carried)
    expect(abs(old - new) < 1e-12 * abs(old), f"{dim}D: an integral of {old} became {new}")
    files = ("out.mesh", "out.sol", "out.u.sol")
    first = [pathlib.Path(f).read_bytes() for f in files]
    adapt("in.mesh", "-o", "out.mesh", "--field", "u.sol", "--threads", "2", "-v", "0")
    expect([pathlib.Path(f).read_bytes() for f in files] == first, f"{dim}D: other bytes")
    return len(found[("Triangles", "Tetrahedra")[dim - 2]])


def try_pieces(dim, count):
    """Of the mesh adapted above; pieces are vtu files that ductile reads."""
    adapt("in.mesh", "-o", "out.pvtu", "--field", "u.sol")
    index = xml.parse("out.pvtu").getroot()
    pieces = [p.get("Source") for p in index.iter("Piece")]
    elements = 0
    for piece in pieces:
        run([ductile, "convert", piece, "piece.mesh"])
        elements += len(sections("piece.mesh")[1][("Triangles", "Tetrahedra")[dim - 2]])
    expect(elements == count, f"{dim}D: pieces have {elements} elements, the mesh {count}")
    arrays = {a.get("Name") for a in index.iter("PDataArray")}
    expect({"u", "metric", "region", "boundary"} <= arrays, f"arrays {arrays}")
    own = {a.get("Name") for a in xml.parse(pieces[0]).getroot().iter("DataArray")}
    expect(arrays - {None} <= own, f"the index names {arrays}, a piece has {own}")


def try_hdf5():
    adapt("in.mesh", "-o", "out.h5")
    expect(pathlib.Path("out.h5").read_bytes()[1:4] == b"HDF", "out.h5 is no HDF5")


def try_mistakes(dim):
    os.remove("out.mesh")
    text = adapt("in.mesh", "-o", "out.mesh", "--hmxa", "1", status=2)
    expect("did you mean" in text, text)
    text = adapt("in.mesh", "-o", "out.mesh", "--near", "point:0,0:0.1", status=2)
    expect("ductile metric" in text, text)
    adapt("missing.mesh", "-o", "out.mesh", status=2)
    write_sol("in.sol", dim, [-1.0] * len(sections("in.mesh")[1]["Vertices"]))
    adapt("in.mesh", "-o", "out.mesh", status=2)
    text = adapt("in.mesh", "-o", "nowhere/out.pvtu", status=2)
    os.remove("in.sol")
    points, cells, facets = box(dim, 3)
    write_mesh("bad.mesh", dim, points, cells + cells[:1], facets)
    adapt("bad.mesh", "-o", "out.mesh", "-hsiz", "0.2", status=1)
    adapt("in.mesh", "-o", "out.mesh", "-hsiz", "1e-9", "-m", "300", status=1)
    left = [f for f in os.listdir() if "tmp" in f or f == "out.mesh"]
    expect(not left, f"there is {left}")


for dim, n in ((2, 10), (3, 5)):
    try_pieces(dim, try_box(dim, n))
    try_hdf5()
    if dim == 2:
        try_mistakes(dim)
