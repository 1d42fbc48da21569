"""A mesh as notebooks show it."""

from __future__ import annotations

import html
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._mesh import Mesh

_MOST_IN_3D = 200_000


def page(mesh: Mesh) -> str:
    """A small picture, if the mesh is not too large for one, and the statistics."""
    from ._draw import draw
    from ._info import info
    picture = ""
    if mesh.dim == 2 or len(mesh.cells) <= _MOST_IN_3D:
        picture = draw(mesh, width=320, most=20_000)
    text = str(info(mesh))
    if mesh.report is not None:
        text += f"\n{mesh.report}"
    return (f'<div style="display:flex;gap:1em;align-items:center">{picture}'
            f"<pre>{html.escape(text)}</pre></div>")
