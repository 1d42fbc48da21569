"""ductile-mpi as its users run it: program_cases.py MPIRUN DUCTILE_MPI DUCTILE RANKS.

The output is valid, references keep their measures, fields their integrals; the same bytes come in
separate runs with other numbers of threads; what goes wrong is told, and nothing is written.
"""

import itertools
import os
import pathlib
import random
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


def lines(points):
    """Edges along the third axis: where two sides meet, inside of a region, between regions."""
    places = {7: (0.0, 0.0), 8: (0.2, 0.4), 9: (0.6, 0.6)}
    found = []
    for reference, place in places.items():
        along = sorted((p[2], v) for v, p in enumerate(points) if tuple(p[:2]) == place)
        found += [((a, b), reference) for (_, a), (_, b) in zip(along, along[1:])]
    return found


required_words = {2: ("RequiredEdges", "RequiredTriangles"), 3: ("RequiredTriangles", "RequiredTetrahedra")}


def write_mesh(name, dim, points, cells, facets, kept=(), required=(), edges=(), marks=None, references=None):
    """required: numbers of facets, and of cells; edges: of tetrahedra; marks: numbers of edges by word;
    references: of vertices"""
    names = {2: ("Edges", "Triangles"), 3: ("Triangles", "Tetrahedra")}[dim]
    with open(name, "w") as file:
        print("MeshVersionFormatted 2\nDimension", dim, "\nVertices", len(points), file=file)
        for v, p in enumerate(points):
            print(*p, (references or {}).get(v, 0), file=file)
        for word, list in zip(names, (facets, cells)):
            print(word, len(list), file=file)
            for corners, reference in list:
                print(*[c + 1 for c in corners], reference, file=file)
        if edges:
            print("Edges", len(edges), file=file)
        for corners, reference in edges:
            print(*[c + 1 for c in corners], reference, file=file)
        for word, numbers in (marks or {}).items():
            print(word, len(numbers), *[i + 1 for i in numbers], file=file)
        if kept:
            print("RequiredVertices", len(kept), *[v + 1 for v in kept], file=file)
        for word, numbers in zip(required_words[dim], required):
            print(word, len(numbers), *[i + 1 for i in numbers], file=file)
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
        elif word in ("SolAtVertices", "Ridges", "Corners") or word.startswith("Required"):
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
    """{(cell, facet or edge, reference): measure}, and of ridges"""
    dim, found = sections(name)
    points = [p[:dim] for p in found["Vertices"]]
    sums = {}
    words = {"edge": "Edges", "facet": ("Edges", "Triangles")[dim - 2], "cell": ("Triangles", "Tetrahedra")[dim - 2]}
    found["ridges"] = [found["Edges"][int(i) - 1][:2] + [0.0] for i in found.get("Ridges", [])]
    for kind, word in (words | {"ridge": "ridges"}).items():
        for *corners, reference in found.get(word, []):
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
    required = [[len(facets) // 2], [len(cells) // 2, len(cells) // 3]]
    edges = lines(points) if dim == 3 else []
    marks = {"Ridges": [0, 1, 2, n]} | ({"RequiredEdges": [n + 1, n + 2, n]} if edges else {})
    write_mesh("in.mesh", dim, points, cells, facets, [kept], required, edges, marks)
    write_sol("in.sol", dim, [small_near_middle(x) for x in points])
    u = [1 + x[0] * x[0] + (3 if x[1] > 0.5 else 0) for x in points]
    write_sol("u.sol", dim, u)
    text = adapt("in.mesh", "-o", "out.mesh", "--field", "u.sol", "--threads", "1")
    expect("pass 1:" in text and "blocked" in text, text)
    turned = [line for line in text.splitlines() if "listed the other way round" in line]
    by_rank = [line.split("warning: ")[1].startswith("rank") for line in turned]
    expect(all(by_rank) if ranks != "1" else by_rank == [False], text)
    expect(turned and turned == sorted(set(turned)), text)  # each once, in the order of ranks
    run([ductile, "info", "out.mesh", "-sol", "out.sol"])
    before, after = measures("in.mesh"), measures("out.mesh")
    expect(before.keys() == after.keys(), f"references {sorted(before)} became {sorted(after)}")
    for key in before:
        expect(abs(before[key] - after[key]) < 1e-9, f"{dim}D: {key}: {before[key]} became {after[key]}")
    _, found = sections("out.mesh")
    stays = found["Vertices"][int(found["RequiredVertices"][0]) - 1][:dim]
    expect(stays == points[kept], f"{dim}D: a required vertex went to {stays}")
    places = lambda of, corners: sorted(of[int(c)][:dim] for c in corners)
    for word, list, numbers in zip(required_words[dim], ("facet", "cell"), required):
        name = {"facet": ("Edges", "Triangles"), "cell": ("Triangles", "Tetrahedra")}[list][dim - 2]
        old = sorted(places(points, (facets, cells)[list == "cell"][i][0]) for i in numbers)
        new = [found[name][int(i) - 1] for i in found[word]]
        new = sorted(places(found["Vertices"], [c - 1 for c in cell[:-1]]) for cell in new)
        expect(old == new, f"{dim}D: required: {old} became {new}")
    held = [places(points, edges[i][0]) for i in marks.get("RequiredEdges", [])]
    now = [found["Edges"][int(i) - 1] for i in found.get("RequiredEdges", [])] if edges else []
    now = [places(found["Vertices"], [c - 1 for c in edge[:-1]]) for edge in now]
    expect(sorted(held) == sorted(now), f"{dim}D: required edges: {held} became {now}")
    carried = sections("out.u.sol")[1]["SolAtVertices"]
    expect(min(u) <= min(carried) and max(carried) <= max(u), f"{dim}D: bounds of a field are lost")
    old, new = integral("in.mesh", u), integral("out.mesh", carried)
    expect(abs(old - new) < 1e-12 * abs(old), f"{dim}D: an integral of {old} became {new}")
    files = ("out.mesh", "out.sol", "out.u.sol")
    first = [pathlib.Path(f).read_bytes() for f in files]
    adapt("in.mesh", "-o", "out.mesh", "--field", "u.sol", "--threads", "2", "-v", "0")
    expect([pathlib.Path(f).read_bytes() for f in files] == first, f"{dim}D: other bytes")
    if ranks == "1":
        run([ductile, "adapt", "in.mesh", "-o", "serial.mesh", "--field", "u.sol", "--threads", "2"])
        for file, bytes in zip(("serial.mesh", "serial.sol", "serial.u.sol"), first):
            expect(pathlib.Path(file).read_bytes() == bytes, f"{dim}D: {file} is another than on one rank")
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


def write_vtu(name, dim, points, cells, heat):
    """In words, with one value on each cell."""
    corners = [v for cell, _ in cells for v in cell]
    arrays = {
        "Points": ("Float64", 3, [x for p in points for x in (*p, 0.0)[:3]], ""),
        "Cells": ("Int64", 1, corners, "connectivity"),
        "offsets": ("Int64", 1, range(dim + 1, len(corners) + 1, dim + 1), "offsets"),
        "types": ("UInt8", 1, [{2: 5, 3: 10}[dim]] * len(cells), "types"),
        "CellData": ("Float64", 1, heat, "heat"),
    }
    text = {
        key: f'<DataArray type="{kind}" Name="{array}" NumberOfComponents="{each}" format="ascii">'
        + " ".join(map(str, values)) + "</DataArray>"
        for key, (kind, each, values, array) in arrays.items()
    }
    pathlib.Path(name).write_text(
        '<VTKFile type="UnstructuredGrid" version="1.0"><UnstructuredGrid>'
        f'<Piece NumberOfPoints="{len(points)}" NumberOfCells="{len(cells)}">'
        f"<Points>{text['Points']}</Points><Cells>{text['Cells']}{text['offsets']}{text['types']}</Cells>"
        f"<CellData>{text['CellData']}</CellData></Piece></UnstructuredGrid></VTKFile>"
    )


def try_hdf5(dim, n):
    points, cells, _ = box(dim, n)
    write_vtu("in.vtu", dim, points, cells, [1.0 + i % 7 for i in range(len(cells))])
    adapt("in.vtu", "-hsiz", "0.2", "-o", "out.h5", "--complete-boundary")
    found = pathlib.Path("out.h5").read_bytes()
    expect(found[1:4] == b"HDF", "out.h5 is no HDF5")
    for name in (b"vertex_fields", b"cell_fields", b"heat"):
        expect(name in found, f"out.h5 has no {name}")


def ball(dim, n):
    """The box, of which cubes around the centre become spheres of radius 1; its surface is 1."""
    points, cells, facets = box(dim, n)
    centred = [[2 * a - 1 for a in p] for p in points]
    scales = [max(map(abs, p)) / max(1e-300, sum(a * a for a in p) ** 0.5) for p in centred]
    points = [[a * scale for a in p] for p, scale in zip(centred, scales)]
    return points, [(c, 1) for c, _ in cells], [(f, 1) for f, reference in facets if reference != 99]


def try_curved(dim, n, tolerance):
    """Sizes from curvature alone; then again, measured from the first mesh."""
    write_mesh("ball.mesh", dim, *ball(dim, n))
    curved = ("-hausd", str(tolerance), "-v", "0", "--no-metric", "-o", "round.mesh")
    adapt("ball.mesh", "-A", "-hmax", "0.7", *curved)
    adapt("round.mesh", "-geometry", "ball.mesh", "-hsiz", str(0.15 * dim), "-hgrad", "1.3", *curved)
    run([ductile, "info", "round.mesh"])
    found = sections("round.mesh")[1]
    facets = found[("Edges", "Triangles")[dim - 2]]
    for v in {int(c) - 1 for facet in facets for c in facet[:dim]}:
        off = abs(sum(a * a for a in found["Vertices"][v][:dim]) ** 0.5 - 1)
        expect(off < 0.1 * tolerance, f"{dim}D: a vertex is {off} from the sphere")
    whole = {2: 3.14159265, 3: 4.18879020}[dim]
    lost = 1 - measures("round.mesh")["cell", 1.0] / whole
    expect(abs(lost) < 2 * dim * tolerance, f"{dim}D: {lost} of the ball is lost")
    count = len(sections("ball.mesh")[1][("Edges", "Triangles")[dim - 2]])
    expect(len(facets) < 0.8 * count, f"{dim}D: {count} facets became {len(facets)}")


def lengths_near(name, place, radius):
    """Of edges with a middle within a distance of a place."""
    dim, found = sections(name)
    points = [p[:dim] for p in found["Vertices"]]
    cells = found[("Triangles", "Tetrahedra")[dim - 2]]
    edges = {tuple(sorted(pair)) for cell in cells for pair in itertools.combinations(map(int, cell[:-1]), 2)}
    for a, b in edges:
        p, q = points[a - 1], points[b - 1]
        if sum(((x + y) / 2 - at) ** 2 for x, y, at in zip(p, q, place)) <= radius**2:
            yield sum((x - y) ** 2 for x, y in zip(p, q)) ** 0.5


def try_places(dim):
    """Sizes by places, which a coarse mesh shows little of; also of a round thing, again and again."""
    points, cells, facets = box(dim, 4)
    write_mesh("coarse.mesh", dim, points, cells, facets, edges=lines(points) if dim == 3 else [])
    place, size = [0.3, 0.6, 0.45][:dim], 0.025 * (dim - 1)
    near = f"sphere:{','.join(map(str, [*place, 2 * size]))}:{size}"
    asked = ("-hsiz", "0.5", "--near", near, "--on", "99:0.1", "--inside", "2:0.25:0", "-hausd", "0.01")
    adapt("coarse.mesh", *asked, "-o", "places.mesh")
    run([ductile, "adapt", "coarse.mesh", *asked, "-o", "serial.mesh"])
    if ranks == "1":
        for ending in ("mesh", "sol"):
            same = pathlib.Path(f"places.{ending}").read_bytes() == pathlib.Path(f"serial.{ending}").read_bytes()
            expect(same, f"{dim}D: places.{ending} is another than on one rank")
    kind = ("Triangles", "Tetrahedra")[dim - 2]
    here, serial = (len(sections(f"{name}.mesh")[1][kind]) for name in ("places", "serial"))
    expect(abs(here / serial - 1) < 0.25, f"{dim}D: {here} elements by places, {serial} on one rank")
    lengths = list(lengths_near("places.mesh", place, 2 * size))
    mean, longest = sum(lengths) / len(lengths), max(lengths)
    # Small meshes on several ranks keep some edges that are blocked.
    expect(mean < 1.4 * size and longest < 4 * size, f"{dim}D: {mean}, at most {longest} where {size} is wanted")
    before, after = measures("coarse.mesh"), measures("places.mesh")
    for key in before:
        expect(abs(before[key] - after[key]) < 1e-9, f"{dim}D: {key}: {before[key]} became {after[key]}")


def try_loose_edge():
    """One from corner to corner of the box, which no element has."""
    points, cells, facets = box(3, 2)
    write_mesh("loose.mesh", 3, points, cells, facets, edges=[((0, len(points) - 1), 5)])
    text = adapt("loose.mesh", "-hsiz", "0.4", "-o", "loose.out.mesh")
    expect(text.count("1 of 1 listed edges belong to no tetrahedron") == 1, text)


def same_as_serial(words, mesh):
    """On one rank the mesh and its metric are those of ductile adapt."""
    adapt(*words, "-o", mesh)
    if ranks == "1":
        run([ductile, "adapt", *words, "-o", "serial.mesh"])
        for ending in (".mesh", ".sol"):
            ours = pathlib.Path(mesh).with_suffix(ending).read_bytes()
            expect(ours == pathlib.Path(f"serial{ending}").read_bytes(), f"{words}: {ending} is another on one rank")


def try_points(dim, n):
    """Vertices whose references mark points, a few or many, inside and on boundaries, stay where they are;
    those whose reference is that of a whole side do not."""
    points, cells, facets = box(dim, n)
    for seed, count in enumerate((1, 8, 20, 20)):
        marked = random.Random(seed).sample(range(len(points)), count)
        references = {v: 100 + i for i, v in enumerate(marked)}
        write_mesh("points.mesh", dim, points, cells, facets, references=references)
        same_as_serial(["points.mesh", "-hsiz", str(1.5 / n), "--threads", "1"], "points.out.mesh")
        run([ductile, "info", "points.out.mesh"])
        _, found = sections("points.out.mesh")
        now = {int(p[dim]): p[:dim] for p in found["Vertices"] if p[dim] != 0}
        lost = [r for v, r in references.items() if now.get(r) != points[v]]
        expect(len(now) == count and not lost, f"{dim}D: {count} points, lost or moved: {lost}, there are {now}")
        corners = {int(found["Vertices"][int(v) - 1][dim]) for v in found["Corners"]}
        expect(corners >= set(references.values()), f"{dim}D: {corners} are corners")
    side = [v for v, p in enumerate(points) if p[0] == 0]
    references = {v: 5 for v in side} | {v: 100 + v for v in marked if v not in side}
    write_mesh("points.mesh", dim, points, cells, facets, references=references)
    text = adapt("points.mesh", "-hsiz", "0.5", "-o", "points.out.mesh")
    expect("not required are left out" in text, text)
    left = [p for p in sections("points.out.mesh")[1]["Vertices"] if p[0] == 0]
    expect(len(left) < len(side) / 2, f"{dim}D: {len(left)} of {len(side)} vertices with a line's reference stay")


def try_join(dim, n):
    """Two regions with vertices of their own where they meet become one mesh."""
    points, cells, facets = box(dim, n)
    twin = {v: len(points) + i for i, v in enumerate(v for v, p in enumerate(points) if p[0] == 0.5)}
    points = points + [points[v] for v in twin]
    cells = [([twin.get(v, v) for v in cell] if region == 2 else cell, region) for cell, region in cells]
    write_mesh("twins.mesh", dim, points, cells, facets)
    write_sol("u.sol", dim, [1 + p[0] for p in points])
    words = ["twins.mesh", "-hsiz", str(1.3 / n), "--join", "0", "--complete-boundary", "--field", "u.sol"]
    text = adapt(*words, "-o", "twins.out.mesh")
    expect(f"{len(twin)} vertices were joined" in text, text)
    same_as_serial(words, "twins.out.mesh")
    run([ductile, "info", "twins.out.mesh"])
    before, after = measures("twins.mesh"), measures("twins.out.mesh")
    for key in {("cell", 1.0), ("cell", 2.0), ("facet", 99.0)}:
        expect(abs(before[key] - after[key]) < 1e-9, f"{dim}D: {key}: {before[key]} became {after[key]}")


def try_mistakes(dim):
    os.remove("out.mesh")
    text = adapt("in.mesh", "-o", "out.mesh", "--hmxa", "1", status=2)
    expect("did you mean" in text and text.count("ductile-mpi: ") == 1, text)
    expect("Mmg's" in adapt("in.mesh", "-o", "out.mesh", "-nsd", "0", status=2), "-nsd is not Mmg's")
    for option in ("-ls", "-lag"):
        said = adapt("in.mesh", "-o", "out.mesh", option, "0", status=2)
        expect(f"option {option}: expected none" in said, f"{option} is not refused")
    for words, status, said in (
        ([], 2, "Commands:"), (["help"], 0, "Commands:"), (["--version"], 0, "ductile-mpi "),
        (["help", "adapt"], 0, "mpirun -n N ductile-mpi adapt"), (["adpt"], 2, "did you mean 'adapt'"),
    ):  # fmt: skip
        text = run([*mpi, ductile_mpi, *words], status)
        expect(text.count(said) == 1 and "--json" not in text, f"{words}: {text}")
    text = adapt("in.mesh", "-o", "out.mesh", "--near", "point:0,0,0:0.1", status=2)
    expect("the mesh has dimension 2, found 3 numbers" in text, text)
    text = adapt("in.mesh", "-o", "out.mesh", "--json", "out.json", status=2)
    expect(text.count("ductile-mpi: ") == 1 and "\n  not in ductile-mpi; " in text, text)
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
    try_hdf5(dim, n)
    try_curved(dim, 24 if dim == 2 else 10, 0.004 if dim == 2 else 0.02)
    try_places(dim)
    try_points(dim, n)
    try_join(dim, 6)
    if dim == 2:
        try_mistakes(dim)
    else:
        try_loose_edge()
