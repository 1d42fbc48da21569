"""Pictures of meshes as SVG, without any other library: cells in 2D, the boundary seen from a corner
in 3D."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any, Optional, Union

import numpy as np

from ._arrays import finite, floats, path_text, shown, whole
from ._build import mesh_data
from ._ductile import InputError

if TYPE_CHECKING:
    from ._mesh import Mesh

# Blue over green to yellow, of equal steps in lightness.
_COLOURS = np.array([[68, 1, 84], [65, 68, 135], [42, 120, 142], [34, 168, 132], [122, 209, 81],
                     [253, 231, 37]], float)
_REGIONS = ["#cfe0ee", "#f6dcc2", "#d5e8cf", "#ead3e3", "#efe9c4", "#d9d6ec"]
_SHADES = 24


def draw(mesh: Mesh, path: Optional[Union[str, os.PathLike[str]]] = None, by: Any = None, *,
         width: int = 800, most: int = 400_000) -> str:
    """Draws a mesh as SVG.

    Parameters
    ----------
    mesh : Mesh
        In 2D all cells are drawn, in 3D the boundary, seen from above one corner.
    path : path, optional
        Where to write the picture, NAME.svg.
    by : (n,) or (m,) array_like, optional
        Values at vertices or on cells, shown by colour. By default colours tell references apart.
    width : int, optional
        Of the picture, in pixels.
    most : int, optional
        Of meshes with more cells than that, only the listed facets are drawn.

    Returns
    -------
    str
        The picture.

    Examples
    --------
    >>> ductile.draw(out, "mesh.svg")
    >>> ductile.draw(out, "quality.svg", by=out.quality())
    """
    mesh_data(mesh, "mesh")
    if path is not None and not path_text(path).endswith(b".svg"):
        raise InputError(f"path: expected a name that ends in .svg, found {shown(path)}")
    width, most = whole(width, "width", 50, 100_000), whole(most, "most", 0, 2**62)
    values = None if by is None else _on_cells(mesh, by)
    svg = _flat(mesh, values, width, most) if mesh.dim == 2 else _solid(mesh, values, width)
    if path is not None:
        with open(path, "w", encoding="utf-8") as file:
            file.write(svg)
    return svg


def _on_cells(mesh: Mesh, by: Any) -> np.ndarray:
    values = finite(floats(by, "by"), "by")
    if values.shape == (len(mesh.points),):
        return values[mesh.cells].mean(axis=1)
    if values.shape != (len(mesh.cells),):
        raise InputError(f"by: expected shape ({len(mesh.points)},) or ({len(mesh.cells)},), found "
                         f"{values.shape}")
    return values


def _flat(mesh: Mesh, values: Optional[np.ndarray], width: int, most: int) -> str:
    at, height = _on_paper(mesh.points, width)
    parts = []
    if len(mesh.cells) <= most:
        fills, group = _fills(mesh.refs, values)
        for number in np.unique(group):
            chosen = mesh.cells[group == number]
            parts.append(_path(at, chosen, closed=True, fill=fills[number], line="none"))
        parts.append(_path(at, _edges(mesh.cells), line="#3a4450", thickness=_thickness(mesh)))
    parts.append(_path(at, mesh.facets, line="#10161c", thickness=1.2))
    return _svg(parts, width, height)


def _solid(mesh: Mesh, values: Optional[np.ndarray], width: int) -> str:
    """The painter's way: facets whose outside is seen, the farthest first."""
    facets, owner = _surface(mesh)
    x, y, z = mesh.points[facets].transpose(2, 0, 1)
    corners = np.stack([x, y, z], axis=2)
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    right, up, towards = _camera()
    normal /= np.maximum(np.linalg.norm(normal, axis=1), 1e-300)[:, None]
    seen = normal @ towards > 0
    facets, owner, normal = facets[seen], owner[seen], normal[seen]
    order = np.argsort(corners[seen].mean(axis=1) @ towards, kind="stable")
    facets, owner, normal = facets[order], owner[order], normal[order]
    at, height = _on_paper(np.column_stack([mesh.points @ right, mesh.points @ up]), width)
    light = 0.72 + 0.28 * np.clip(normal @ _unit([0.2, -0.5, 0.85]), 0, 1)
    fills, group = _fills(mesh.refs[owner], None if values is None else values[owner])
    parts = []
    shades = np.round(light * 20).astype(int)
    for facet, fill, shade in zip(facets, group, shades):
        parts.append((facet, _shaded(fills[fill], shade / 20)))
    lines = f'stroke="#3a4450" stroke-width="{_thickness(mesh)}" stroke-linejoin="round"'
    polygons = "".join(
        f'<path d="M{_xy(at[f[0]])}L{_xy(at[f[1]])}L{_xy(at[f[2]])}Z" fill="{fill}"/>'
        for f, fill in parts)
    return _svg([f"<g {lines}>{polygons}</g>"], width, height)


def _surface(mesh: Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Facets of one cell, turned outwards, and their cells; a surface alone gives its triangles as they are turned."""
    if mesh.cells.shape[1] == 3:
        return mesh.cells, np.arange(len(mesh.cells))
    turned = np.array([[1, 2, 3], [0, 3, 2], [0, 1, 3], [0, 2, 1]])
    facets = mesh.cells[:, turned].reshape(-1, 3)
    owner = np.repeat(np.arange(len(mesh.cells)), 4)
    key = np.sort(facets, axis=1).astype(np.int64)
    count = len(mesh.points)
    _, first, times = np.unique((key[:, 0] * count + key[:, 1]) * count + key[:, 2]
                                if count < 2_000_000 else key, axis=None if count < 2_000_000 else 0,
                                return_index=True, return_counts=True)
    alone = np.sort(first[times == 1])
    facets, owner = facets[alone].copy(), owner[alone]
    a, b, c = mesh.points[facets].transpose(1, 0, 2)
    inside = mesh.points[mesh.cells[owner]].mean(axis=1)
    inwards = np.einsum("ni,ni->n", np.cross(b - a, c - a), inside - a) > 0
    facets[inwards] = facets[inwards][:, [0, 2, 1]]
    return facets, owner


def _unit(vector: Any) -> np.ndarray:
    array = np.asarray(vector, float)
    return array / np.linalg.norm(array)


def _camera() -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    towards = _unit([0.55, -0.75, 0.5])
    right = _unit(np.cross([0, 0, 1], towards))
    return right, np.cross(towards, right), towards


def _on_paper(points: np.ndarray, width: int) -> tuple[np.ndarray, int]:
    """Where points are drawn, y downwards, and the height of the picture."""
    low, high = points.min(axis=0), points.max(axis=0)
    margin = 6
    scale = (width - 2 * margin) / max(high[0] - low[0], 0.4 * (high[1] - low[1]), 1e-300)
    height = int(np.ceil(scale * (high[1] - low[1]) + 2 * margin))
    left = (width - scale * (high[0] - low[0])) / 2
    return np.column_stack([left + scale * (points[:, 0] - low[0]),
                            margin + scale * (high[1] - points[:, 1])]), height


def _thickness(mesh: Mesh) -> float:
    return round(float(np.clip(40 / np.sqrt(max(len(mesh.cells), 1)), 0.15, 0.8)), 2)


def _edges(cells: np.ndarray) -> np.ndarray:
    edges = np.sort(cells[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2), axis=1)
    return np.unique(edges, axis=0)


def _fills(refs: np.ndarray, values: Optional[np.ndarray]) -> tuple[list[str], np.ndarray]:
    """Colours, and which of them each entity has."""
    if values is None:
        kinds, group = np.unique(refs, return_inverse=True)
        return [_REGIONS[i % len(_REGIONS)] for i in range(len(kinds))], group
    low, high = values.min(initial=np.inf), values.max(initial=-np.inf)
    share = (values - low) / (high - low) if high > low else np.zeros(len(values))
    places = np.linspace(0, len(_COLOURS) - 1, _SHADES)
    colours = np.column_stack([np.interp(places, range(len(_COLOURS)), _COLOURS[:, i])
                               for i in range(3)])
    return ["#%02x%02x%02x" % tuple(int(c) for c in colour) for colour in colours], \
        np.minimum((share * _SHADES).astype(int), _SHADES - 1)


def _shaded(colour: str, light: float) -> str:
    parts = [int(int(colour[i:i + 2], 16) * light) for i in (1, 3, 5)]
    return "#%02x%02x%02x" % tuple(parts)


def _xy(place: np.ndarray) -> str:
    return f"{place[0]:.1f} {place[1]:.1f}"


def _path(at: np.ndarray, chains: np.ndarray, *, closed: bool = False, fill: str = "none",
          line: str = "none", thickness: float = 0) -> str:
    text = np.array([_xy(place) for place in at])
    end = "Z" if closed else ""
    data = "".join("M" + "L".join(chain) + end for chain in text[chains])
    stroke = "" if line == "none" else f' stroke="{line}" stroke-width="{thickness}"'
    return f'<path d="{data}" fill="{fill}"{stroke}/>'


def _svg(parts: list[str], width: int, height: int) -> str:
    return (f'<svg xmlns="http://www.w3.org/2000/svg" width="{width}" height="{height}" '
            f'viewBox="0 0 {width} {height}">' + "\n".join(parts) + "</svg>\n")
