"""Cut: what a mesh that was cut along a level set has of the mesh before."""

from __future__ import annotations

from typing import Mapping, NamedTuple, Optional, Sequence

import numpy as np

from . import _ductile
from ._arrays import shown, whole
from ._ductile import CutReport, InputError


class Cut(NamedTuple):
    """What a cut mesh has of the mesh before; arrays of indices have -1 where there is none."""

    value: np.ndarray
    """(n,) The values minus the level; exactly 0 at the vertices of the interface."""
    vertices: np.ndarray
    """(n, 2) The vertices a and b of the mesh before between which each one lies."""
    weights: np.ndarray
    """(n,) The weight t of b: the vertex is at (1 - t) a + t b."""
    cells: np.ndarray
    """(m,) The cell that each one is a part of."""
    facets: np.ndarray
    """(k,) The facet that each one is a part of; -1 on the interface."""
    report: CutReport
    """How the mesh was cut."""


def cut_of(data: _ductile.CutData) -> Cut:
    return Cut(data.value, *data.vertex_origins, data.cell_origins, data.facet_origins, data.report)


def _reference(value: object, name: str) -> int:
    return whole(value, name, -2**31, 2**31 - 1)


def references_of(minus: object, plus: object, interface: object) -> tuple[int, int, int]:
    """The references of a cut, as C++ has them."""
    return (_reference(minus, "minus"), _reference(plus, "plus"), _reference(interface, "interface"))


def materials_of(materials: Optional[Mapping[int, Optional[Sequence[int]]]]) \
        -> list[tuple[int, bool, int, int]]:
    """The table of materials, as C++ has it."""
    if materials is None:
        return []
    if not isinstance(materials, Mapping):
        raise InputError(f"materials: expected a dict, found {shown(materials)}")
    rows = []
    for key, sides in materials.items():
        reference, name = _reference(key, "materials: a key"), f"materials[{key}]"
        if sides is not None and (isinstance(sides, str) or np.shape(sides) != (2,)):
            raise InputError(f"{name}: expected None or the references of the two sides, found "
                             f"{shown(sides)}")
        minus, plus = (0, 0) if sides is None else (_reference(sides[0], name),
                                                    _reference(sides[1], name))
        rows.append((reference, sides is not None, minus, plus))
    return rows
