"""Control points from files: CSV, or the points of a SIMA file."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.formats.survey.sima_reading import read_sima_features
from processing.formats.trajectories.text_table import TextTable, read_table
from processing.methods.registration.control_points import ControlPoint, Role

_SIMA = ".sim"
_AXES = ("easting_m", "northing_m", "height_m")


def read_control_points(path: Path) -> tuple[ControlPoint, ...]:
    """Read control points: ``id,easting_m,northing_m,height_m[,role][,where]`` or SIMA.

    ``where`` says what a point is on: a word with “pole” or “corner” limits what is looked for.
    Points of SIMA are all control points.

    Raises
    ------
    MissingInput
        There is no such file.
    BadFile
        It is no such table; names the line.
    """
    if path.suffix.lower() == _SIMA:
        return _of_sima(path)
    table = read_table(path)
    table.require(("id", *_AXES))
    ids = table.words("id")
    for row, one in enumerate(ids):
        if ids.index(one) < row:
            raise table.damage(
                row, Text(f"The point {one} is given twice.", f"点 {one} が重複しています。")
            )
    places = np.column_stack([table.numbers(axis) for axis in _AXES])
    wheres = table.words("where") if table.has("where") else [""] * len(ids)
    return tuple(
        ControlPoint(name, place, _role(table, row), where)
        for row, (name, place, where) in enumerate(zip(ids, places, wheres, strict=True))
    )


def _role(table: TextTable, row: int) -> Role:
    if not table.has("role"):
        return Role.CONTROL
    word = table.words("role")[row].lower()
    if word not in {"", *(role.value for role in Role)}:
        raise table.damage(
            row,
            Text(
                f"“{word[:40]}” is no role: control or check.",
                f"role「{word[:40]}」は使えません。control か check を指定してください。",
            ),
        )
    return Role(word) if word else Role.CONTROL


def _of_sima(path: Path) -> tuple[ControlPoint, ...]:
    points = []
    for feature in read_sima_features(path).features:
        if feature.shape != "point":
            continue
        place = np.asarray(feature.xyz[0], np.float64)
        if not np.isfinite(place).all():
            raise BadFile(
                Text("A control point has no height.", "標定点に標高がありません。"),
                Text.same(f"{path}: {feature.facts['name']}"),
                Text(
                    "Take the point out, or give its height.",
                    "その点を外すか、標高を入れてください。",
                ),
            )
        points.append(ControlPoint(str(feature.facts["name"]), place))
    return tuple(points)
