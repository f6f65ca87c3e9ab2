"""What a map file holds, as scores need it: shapes with facts, wherever they were read from."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Literal

from processing.core.arrays import Floats
from processing.core.errors import BadFile, Unsuitable
from processing.core.text import Text

GeometryType = Literal["point", "line", "area"]

IN_DEGREES = "OGC:CRS84"
"""What a GeoJSON means that names no reference system and whose places can be degrees."""

SHAPE_NAMES: Mapping[GeometryType, Text] = {
    "point": Text("a point", "点"),
    "line": Text("a line", "線"),
    "area": Text("an area", "面"),
}


@dataclass(frozen=True)
class MappedFeature:
    """One feature of a map.

    Attributes
    ----------
    number : int
        Its place in the file, from 1, for messages.
    shape : str
        ``point``, ``line`` or ``area``.
    xyz : (n, 3) float64
        Easting, northing and height, m; a ring without its first place repeated. Height is NaN
        where the file has none.
    facts : mapping
        Its properties, of whatever type the file has them.
    """

    number: int
    shape: GeometryType
    xyz: Floats
    facts: Mapping[str, object]


@dataclass(frozen=True)
class MappedFile:
    """The features of a file.

    Attributes
    ----------
    path : Path
        For messages.
    crs : str
        ``EPSG:n``; empty where the file doesn't say; `IN_DEGREES`.
    features : tuple of MappedFeature
        In the file's order.
    """

    path: Path
    crs: str
    features: tuple[MappedFeature, ...]

    def of_kinds(
        self, kinds: Mapping[str, Mapping[str, object]], shape: GeometryType, name: Text
    ) -> list[MappedFeature]:
        """The features of some kinds; those that name no kind, and those a person didn't reject.

        Parameters
        ----------
        kinds : mapping of str to mapping
            By ``kind``, the facts that it implies.
        shape : str
            What they must be.
        name : Text
            What they are called, for messages.

        Raises
        ------
        BadFile
            There are features, but none of these kinds; or one has another shape.
        """
        chosen = []
        for feature in self.features:
            kind = feature.facts.get("kind")
            if kind is not None and kind not in kinds:
                continue
            implied = kinds[str(kind)] if kind is not None else {}
            # Tables of a whole map have empty fields where a kind lacks them.
            lacking = {n: v for n, v in implied.items() if feature.facts.get(n) in (None, "")}
            chosen.append(replace(feature, facts={**feature.facts, **lacking}))
        if self.features and not chosen:
            raise BadFile(
                Text("The file holds none of: {name}.", "ファイルに{name}がありません。").filled(
                    name=name
                ),
                Text.same(str(self.path)),
                Text(
                    "Choose the file of this tool; “kind” is one of {kinds}.",
                    "このツールのファイルを指定してください。「kind」は次のいずれかです: {kinds}",
                ).filled(kinds=", ".join(kinds)),
            )
        for feature in chosen:
            if feature.shape != shape:
                raise self._other_shape(feature, shape)
        return [one for one in chosen if one.facts.get("status") != "rejected"]

    def number(self, feature: MappedFeature, name: str) -> float:
        """A fact that is a number; NaN where the feature hasn't it.

        Raises
        ------
        BadFile
            It is no number.
        """
        value = feature.facts.get(name)
        if value is None:
            return math.nan
        if isinstance(value, bool) or not isinstance(value, (int, float)):
            raise self.wrong(feature, name, Text("a number", "数値"))
        return float(value)

    def word(self, feature: MappedFeature, name: str, known: tuple[str, ...]) -> str:
        """A fact that is one of some words.

        Raises
        ------
        BadFile
            The feature hasn't it, or it is another word.
        """
        value = feature.facts.get(name)
        if value not in known:
            raise self.wrong(feature, name, Text.same(" / ".join(known)))
        return str(value)

    def wrong(self, feature: MappedFeature, name: str, wanted: Text) -> BadFile:
        """The error for a property that is missing or isn't what it should be."""
        return BadFile(
            Text(
                "The property “{name}” is missing or is not what it should be ({wanted}).",
                "属性「{name}」がないか、値が正しくありません（正しい値: {wanted}）。",
            ).filled(name=name, wanted=wanted),
            self.where(feature),
            Text(
                "Correct the file, or write it again with the tool.",
                "ファイルを修正するか、ツールで出力し直してください。",
            ),
        )

    def where(self, feature: MappedFeature) -> Text:
        """The file and a feature in it, for a message."""
        number = f"{feature.number:,}"
        return Text(f"{self.path}, feature {number}", f"{self.path}、{number}番目の地物")

    def _other_shape(self, feature: MappedFeature, wanted: GeometryType) -> BadFile:
        return BadFile(
            Text("The feature is {is_}, not {wanted}.", "地物が{wanted}ではなく{is_}です。").filled(
                is_=SHAPE_NAMES[feature.shape], wanted=SHAPE_NAMES[wanted]
            ),
            self.where(feature),
            Text(
                "Choose the file that this tool writes, or a truth of the same kind.",
                "このツールの出力、または同じ種類の正解を指定してください。",
            ),
        )


def check_same_system(result: MappedFile, truth: MappedFile) -> None:
    """Refuse files whose places can't be compared in metres.

    Raises
    ------
    Unsuitable
        They name different reference systems, or a file's places are degrees.
    """
    for file in (result, truth):
        if file.crs == IN_DEGREES:
            raise Unsuitable(
                Text(
                    "The places are degrees; scores need metres.",
                    "座標が度単位です。評価にはメートル単位の座標が必要です。",
                ),
                Text.same(str(file.path)),
                Text(
                    "Write the file in the project's plane reference system, and name it in “crs”.",
                    "プロジェクトの平面直角座標系で出力し、「crs」に座標系を記してください。",
                ),
            )
    if result.crs and truth.crs and result.crs != truth.crs:
        raise Unsuitable(
            Text(
                "The result is in {result}, the truth in {truth}.",
                "結果の座標参照系は{result}、正解は{truth}で、異なります。",
            ).filled(result=result.crs, truth=truth.crs),
            Text.same(f"{result.path}, {truth.path}"),
            Text(
                "Transform one of them, so that both are in the same reference system.",
                "一方を変換し、同じ座標参照系にそろえてください。",
            ),
        )
