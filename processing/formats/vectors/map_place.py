"""Whether a delivered map lies where the project is, and what is wrong with it where it doesn't."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import UNCHANGED, Unsuitable, UserError
from processing.core.text import Text
from processing.formats.surfaces.landxml_systems import zone_of_system
from processing.map.map_extent import Bounds
from processing.map.reference_transform import reference_transform
from processing.scoring.features.mapped_features import MappedFile

_FARTHEST_M = 1000.0
"""A map of the next quarter is taken in; one of another zone is tens of kilometres away."""

_UNITS = (
    (0.001, Text("millimetres", "ミリメートル")),
    (0.01, Text("centimetres", "センチメートル")),
    (1000.0, Text("kilometres", "キロメートル")),
    (0.3048, Text("feet", "フィート")),
)
_FIRST_ZONE = 6668


def check_place(mapped: MappedFile, places: Sequence[Floats], crs: str, own: Bounds | None) -> None:
    """Refuse a map that lies elsewhere, and say what it looks like: another zone, unit or order.

    Parameters
    ----------
    mapped : MappedFile
        As the file has it, in the system that it is said to be in.
    places : sequence of (n, 3) float64
        The same in the project's system.
    crs : str
        Of the project.
    own : Bounds or None
        The project's extent; None where it is empty: then any place will do.

    Raises
    ------
    Unsuitable
    """
    if own is None or not places:
        return
    every = np.concatenate(list(places))[:, :2]
    distance = _apart(every, own)
    if distance <= _FARTHEST_M:
        return
    raw = np.concatenate([one.xyz for one in mapped.features])[:, :2]
    raise Unsuitable(
        Text(
            "The map lies {distance} km from the project's.",
            "図面の位置が、プロジェクトから{distance} km離れています。",
        ).filled(distance=f"{distance / 1000:,.1f}"),
        Text.same(str(mapped.path)),
        Text("{hint} {unchanged}", "{hint}{unchanged}").filled(
            hint=_hint(raw, crs, own), unchanged=UNCHANGED
        ),
    )


def _apart(xy: Floats, own: Bounds) -> float:
    """How far the nearest place lies from a box."""
    west, south, east, north = own
    gaps = np.stack(
        [
            np.maximum(np.maximum(west - xy[:, 0], xy[:, 0] - east), 0.0),
            np.maximum(np.maximum(south - xy[:, 1], xy[:, 1] - north), 0.0),
        ]
    )
    nearest = float(np.min(np.hypot(*gaps)))
    return math.inf if math.isnan(nearest) else nearest


def _hint(raw: Floats, crs: str, own: Bounds) -> Text:
    """What would bring the map to its place."""
    if _apart(raw[:, ::-1], own) <= _FARTHEST_M:
        return Text(
            "Northing and easting stand in each other's place: swap them in the file.",
            "X（北）とY（東）が逆になっています。ファイル内で入れ替えてください。",
        )
    for factor, name in _UNITS:
        if _apart(raw * factor, own) <= _FARTHEST_M:
            return Text(
                "Its numbers look like {unit}: write it in metres.",
                "座標の単位が{unit}のようです。メートルで出力し直してください。",
            ).filled(unit=name)
    zone = _fitting_zone(raw, crs, own)
    if zone:
        return Text(
            "It fits as zone {zone}: give EPSG:{code} as its reference system.",
            "第{zone}系とすると位置が合います。座標参照系にEPSG:{code}を指定してください。",
        ).filled(zone=zone, code=_FIRST_ZONE + zone)
    return Text(
        "Check its reference system, zone and unit.",
        "座標参照系・系番号・単位を確認してください。",
    )


def _fitting_zone(raw: Floats, crs: str, own: Bounds) -> int:
    """The plane rectangular zone in which the map would lie where the project is; 0: none."""
    if not zone_of_system(crs):
        return 0
    few = np.zeros((2, 3))
    few[0, :2], few[1, :2] = raw.min(axis=0), raw.max(axis=0)
    for zone in range(1, 20):
        try:
            moved = reference_transform(f"EPSG:{_FIRST_ZONE + zone}", crs).apply(few)
        except UserError:
            continue
        if _apart(moved[:, :2], own) <= _FARTHEST_M:
            return zone
    return 0
