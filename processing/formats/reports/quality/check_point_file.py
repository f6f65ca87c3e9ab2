"""Check points read from a table."""

from __future__ import annotations

import math
from pathlib import Path

from processing.core.errors import OutOfRange, use_one_of
from processing.core.text import Text
from processing.formats.trajectories.text_table import read_table
from processing.map.catalogue import Catalogue
from processing.map.quality.check_points import CheckPoint

_CONTROL = "control"


def read_check_points(path: Path, catalogue: Catalogue) -> tuple[CheckPoint, ...]:
    """The check points of a CSV: ``id,easting_m,northing_m`` and, if known, ``height_m,kind,role``.

    Rows whose role is ``control`` are passed over: a map that was fitted to them proves nothing.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, lacks a column or has a bad cell; names the line. It has no check point.
    OutOfRange
        A kind that the catalogue lacks.
    """
    table = read_table(path)
    ids, east, north = table.words("id"), table.numbers("easting_m"), table.numbers("northing_m")
    heights = table.numbers("height_m") if table.has("height_m") else [math.nan] * len(ids)
    kinds = table.words("kind") if table.has("kind") else [""] * len(ids)
    roles = table.words("role") if table.has("role") else [""] * len(ids)
    for number, kind in enumerate(kinds):
        if kind and kind not in catalogue:
            raise OutOfRange(
                Text("The catalogue has no such kind.", "カタログにない種別です。"),
                Text.same(f"{path}: {ids[number]}, {kind}"),
                use_one_of(one.id for one in catalogue),
            )
    found = tuple(
        CheckPoint(ids[at], float(east[at]), float(north[at]), float(heights[at]), kinds[at])
        for at in range(len(ids))
        if roles[at].lower() != _CONTROL
    )
    if not found:
        raise OutOfRange(
            Text("The file has no check point.", "検証点がありません。"),
            Text.same(str(path)),
            Text("Give at least one row with role check.", "検証点の行を1行以上指定してください。"),
        )
    return found
