"""On one rank the mesh is that of `ductile adapt`, to the last bit: one_rank.py -ductile PROGRAM."""

import subprocess
import tempfile

from support import *

program = options.getString("ductile")
folder = tempfile.mkdtemp()


def corners_at(dm, height):
    """Vertices, counted from 1, of the points of a height, and their values in a label."""
    begin, end = dm.getDepthStratum(0)
    name = ("Cell Sets", "Face Sets", "Edge Sets")[height]
    for point in range(*dm.getHeightStratum(height)):
        closure = dm.getTransitiveClosure(point)[0]
        corners = [p - begin + 1 for p in closure if begin <= p < end]
        yield *corners, dm.getLabelValue(name, point)


def write(dm, metric):
    dim, x = dm.getDimension(), coordinates(dm)
    words = ("Edges", "Triangles", "Tetrahedra")
    with open(f"{folder}/in.mesh", "w") as file:
        print("MeshVersionFormatted 2\nDimension", dim, "\nVertices", len(x), file=file)
        for p in x:
            print(*p.tolist(), 0, file=file)
        for height in range(dim):
            lines = [line for line in corners_at(dm, height) if line[-1] >= 0]
            print(words[dim - 1 - height], len(lines), file=file)
            for line in lines:
                print(*line, file=file)
        print("End", file=file)
    with open(f"{folder}/in.sol", "w") as file:
        print("MeshVersionFormatted 2\nDimension", dim, "\nSolAtVertices", len(x), "\n1 3", file=file)
        for m in metric.tolist():
            print(*[m[j][i] for j in range(dim) for i in range(j + 1)], file=file)
        print("End", file=file)


for dim, n in ((2, 16), (3, 6)):
    dm = plex(*box(dim, n))
    label_box(dm)
    if dim == 3:
        label_lines(dm)
    size = lambda x: 0.02 * dim + 0.2 * abs(x[:, 0] - 0.4 - 0.2 * x[:, 1])
    tensor_at = diagonal(*[size] * dim)
    write(dm, tensor_at(coordinates(dm)))
    adapted = dm.adaptMetric(metric_vector(dm, tensor_at), "Face Sets", "Cell Sets")
    subprocess.run([program, "adapt", f"{folder}/in.mesh", "-hgrad", "1.3", "-v", "0"], check=True)
    words = open(f"{folder}/in.o.mesh").read().split()
    begin = words.index("Vertices") + 2
    count = int(words[begin - 1])
    if dim == 3:
        begin_of_edges = words.index("Edges") + 2
        listed = int(words[begin_of_edges - 1])
        edges = np.array(words[begin_of_edges : begin_of_edges + 3 * listed], dtype=int).reshape(-1, 3)
        ours = np.array([line for line in corners_at(adapted, 2) if line[-1] >= 0])
        for array in (edges, ours):
            array[:, :2].sort()
        expect(set(map(tuple, edges)) == set(map(tuple, ours)), "3D: other edges than of ductile adapt")
        expect(listed > 20, f"3D: {listed} edges are on lines")
    serial = np.array(words[begin : begin + count * (dim + 1)], dtype=float).reshape(count, dim + 1)
    same = np.array_equal(serial[:, :dim], coordinates(adapted))
    expect(same, f"{dim}D: {count} vertices of ductile adapt, {len(coordinates(adapted))} others here")
