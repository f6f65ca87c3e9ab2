"""Control points that can't belong to the drives: another zone, axes swapped."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from processing.core.arrays import Flags, Floats
from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.methods.registration.control_points import ControlPoint
from processing.recording.drive import Drive

_BESIDE_M = 20.0
_JAPANESE_ZONES = range(6669, 6688)
"""EPSG codes of the plane zones I to XIX of JGD2011."""


def check_places(control: Sequence[ControlPoint], drives: Sequence[Drive], crs: str) -> None:
    """Refuse control points of which none lies where anything was measured.

    Raises
    ------
    Unsuitable
        Says what they would fit with: their axes swapped, or as points of another zone.
    """
    if not control:
        return
    places = np.array([point.xyz[:2] for point in control])
    if _inside(places, drives).any():
        return
    raise Unsuitable(
        Text(
            "No control point lies where the drives measured.",
            "走行データの計測範囲に標定点が1点もありません。",
        ),
        Text(
            f"{control[0].id}: easting {places[0, 0]:.3f}, northing {places[0, 1]:.3f}",
            f"{control[0].id}：東 {places[0, 0]:.3f}、北 {places[0, 1]:.3f}",
        ),
        _remedy(places, drives, crs),
    )


def _remedy(places: Floats, drives: Sequence[Drive], crs: str) -> Text:
    if _inside(places[:, ::-1], drives).any():
        return Text(
            "Easting and northing are swapped: X of Japanese surveying is the northing.",
            "東と北が入れ替わっています。測量のXは北（northing）です。",
        )
    zone = _other_zone(places, drives, crs)
    if zone:
        return Text(
            f"They fit as points of {zone}: convert them to {crs}.",
            f"{zone} の座標として読むと一致します。{crs} に変換してください。",
        )
    return Text(
        "Check their zone and the order of the columns.",
        "系番号と列の順序を確認してください。",
    )


def _other_zone(places: Floats, drives: Sequence[Drive], crs: str) -> str:
    """The plane zone whose points these would be; empty for none."""
    from pyproj import Transformer
    from pyproj.exceptions import ProjError

    if not crs:
        return ""
    for code in _JAPANESE_ZONES:
        name = f"EPSG:{code}"
        try:
            turned = Transformer.from_crs(name, crs, always_xy=True).transform(*places.T)
        except ProjError:
            continue
        if name != crs and _inside(np.column_stack(turned), drives).any():
            return name
    return ""


def _inside(places: Floats, drives: Sequence[Drive]) -> Flags:
    inside = np.zeros(places.shape[0], np.bool_)
    for drive in drives:
        low = np.array(drive.info.lowest[:2]) - _BESIDE_M
        high = np.array(drive.info.highest[:2]) + _BESIDE_M
        inside |= ((places >= low) & (places <= high)).all(axis=1)
    return inside
