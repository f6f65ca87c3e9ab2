"""A design surface from its file, ready to be compared: checked, and in heights above T.P."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.surfaces.landxml import read_landxml
from processing.methods.earthwork.geometry.surface_check import check_surface
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface


@dataclass(frozen=True)
class Design:
    """A design as its file has it.

    Attributes
    ----------
    surface : TriangleSurface
        Its notes tell what was left out, and what was added to its heights.
    crs : str
        ``EPSG:n``, or empty where the file names none.
    """

    surface: TriangleSurface
    crs: str


def read_design(path: Path, name: str, monitor: Monitor) -> Design:
    """The surface of a name in a LandXML file, or its only one.

    Raises
    ------
    UserError
        What :func:`processing.formats.surfaces.landxml.read_landxml` and
        :func:`processing.methods.earthwork.geometry.surface_check.check_surface` raise.
    Unsuitable
        There are several surfaces and no name; tells how to write one.
    """
    found = read_landxml(path, surface=name, monitor=monitor)
    first = found.surfaces[0].surface
    if len(found.surfaces) > 1:
        raise Unsuitable(
            Text(
                "The file has several surfaces: {names}.", "複数のサーフェスがあります（{names}）。"
            ).filled(names=", ".join(one.surface.name or "-" for one in found.surfaces)),
            Text.same(str(path)),
            Text(
                "Write the name of the one that is meant behind the file: {example}.",
                "使用するサーフェスの名前をファイル名の後に書いてください（例：{example}）。",
            ).filled(example=f"{path.name}#{first.name}"),
        )
    checked = check_surface(first)
    surface, notes, up_m = checked.surface, checked.notes, found.zero_above_tp_m
    if up_m:
        surface = replace(surface, xyz=surface.xyz + np.array([0.0, 0.0, up_m]))
        added = Text(
            "The design's heights count from {datum}; {up} m were added for heights above T.P.",
            "設計面の高さの基準は{datum}です。T.P.基準とするため{up} mを加えました。",
        ).filled(datum=found.height_datum or "–", up=f"{up_m:+.4f}")
        notes = (*notes, added)
    return Design(replace(surface, notes=notes), found.crs)
