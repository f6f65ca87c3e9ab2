"""What is chosen on the map for a volume: areas as its boundary, lines as axis and break lines."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable
from pathlib import Path

import numpy as np
import shapely
from shapely.geometry.base import BaseGeometry

from processing.core.errors import MissingInput
from processing.core.text import Language, Text
from processing.formats.vectors.boundary_files import read_boundary
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature
from processing.methods.earthwork.geometry.boundary import boundary_polygon
from processing.project.volumes.epochs import Epoch
from processing.project.volumes.volume import ChosenSide, SideKind

_LEVELS_ONLY = Text(
    "One of the two grounds has to be an epoch or a design.",
    "比較する一方は計測データまたは設計データにしてください。",
)
_NOTHING = Text("Choose both grounds that are compared.", "比較する2つの地盤を選んでください。")
_SAME = Text(
    "Before and after are the same: choose two epochs, a design or a level.",
    "前と後が同じです。別の計測データ、設計データまたは標高を選んでください。",
)
_ONE_EPOCH = Text(
    "The project has one epoch only: import the other one, or choose a design or a level.",
    "計測データが1時期しかありません。もう1時期をインポートするか、設計データか標高を選んでください。",
)
_NO_PROJECT = Text("Open a project first.", "先にプロジェクトを開いてください。")


def reason_against(
    before: ChosenSide | None, after: ChosenSide | None, epochs: tuple[Epoch, ...]
) -> Text | None:
    """Why two grounds can't be compared; None: they can."""
    if not epochs:
        return _NO_PROJECT
    if before is None or after is None:
        return _ONE_EPOCH if len(epochs) == 1 else _NOTHING
    if before.kind is SideKind.LEVEL and after.kind is SideKind.LEVEL:
        return _LEVELS_ONLY
    return _SAME if before == after else None


def boundary_of_features(features: Iterable[Feature]) -> BaseGeometry:
    """The area that chosen features cover.

    Raises
    ------
    MissingInput
        None of them is an area.
    Unsuitable
        An outline crosses itself, or holds no area.
    """
    areas = [one for one in features if one.geometry is Geometry.AREA]
    if not areas:
        raise MissingInput(
            Text(
                "No area is selected that the volume could be computed within.",
                "土量を計算する範囲となる面の地物が選択されていません。",
            ),
            Text("Selection", "選択"),
            Text(
                "Select an area on the map, or compute within everything or an area from a file.",
                "地図で面を選択するか、範囲を「すべて」またはファイルの範囲にしてください。",
            ),
        )
    parts = [
        boundary_polygon([np.array([vertex.xyz[:2] for vertex in area.vertices])]) for area in areas
    ]
    return shapely.union_all(parts)


def name_of_areas(features: Iterable[Feature], catalogue: Catalogue, language: Language) -> str:
    """What areas of the map are called as a boundary: their kinds, and how many of each."""
    kinds = Counter(one.kind for one in features if one.geometry is Geometry.AREA)
    names = (
        (catalogue[kind].name.in_language(language) if kind in catalogue else kind, count)
        for kind, count in kinds.items()
    )
    return ", ".join(name if count == 1 else f"{name} × {count}" for name, count in names)


def boundary_of_file(path: Path, layer: str, crs: str) -> BaseGeometry:
    """The area of a delivered file, of one of its layers where a name is given.

    Raises
    ------
    BadFile, OutOfRange, Unsuitable, MissingInput, NoSpace
        As :func:`processing.formats.vectors.boundary_files.read_boundary`.
    """
    return boundary_polygon(read_boundary(path, crs=crs, layer=layer).rings)


def lines_of_features(features: Iterable[Feature]) -> tuple[BaseGeometry, ...]:
    """The chosen lines in space, as they were chosen.

    Raises
    ------
    MissingInput
        None of them is a line.
    """
    lines = tuple(
        shapely.LineString([vertex.xyz for vertex in one.vertices])
        for one in features
        if one.geometry is Geometry.LINE and len(one.vertices) > 1
    )
    if not lines:
        raise MissingInput(
            Text("No line is selected.", "線の地物が選択されていません。"),
            Text("Selection", "選択"),
            Text(
                "Select the axis or the break lines on the map, or compute without lines.",
                "地図で中心線またはブレークラインを選択するか、線を使わずに計算してください。",
            ),
        )
    return lines
