"""What two sides must have in common before a volume between them means anything."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.text import Text
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.surfaces.ground_cells import GroundCells
from processing.methods.earthwork.surfaces.sides import EpochGround, Level, Side
from processing.methods.earthwork.volumes.volume_result import Registration, Volumes

Floats = NDArray[np.float64]

_FEWEST_CELLS = 25
"""With points, from which anything is said of an epoch; by trial, a square metre of the usual
mesh."""

_APART_M, _EVEN_SHARE = 2.0, 0.1
"""Epochs lie on two height datums where they are farther apart than this everywhere, and differ
by less than this share of it over most of the site. By judgement: geoid heights in Japan are 20 to
45 m, and no site is lowered evenly by metres."""

_LOW_PERCENT, _HIGH_PERCENT = 10, 90
"""What most of a site is."""

_MM = 1000

_WORTH_NAMING_M2 = 0.5
"""Area from which a note has a square metre to name."""


def name_of(side: Side) -> str:
    """What people call a side."""
    if isinstance(side, Level):
        return f"{side.height_m:g} m"
    return side.name


def ground_and_design(before: Side, after: Side) -> tuple[EpochGround, TriangleSurface]:
    """Which of two sides was measured, and which is the design that it is judged by.

    Raises
    ------
    Unsuitable
        They are no measured ground and a design.
    """
    for ground, design in ((before, after), (after, before)):
        if isinstance(ground, EpochGround) and isinstance(design, TriangleSurface):
            return ground, design
    raise Unsuitable(
        Text(
            "As-built control compares a measured ground with a design.",
            "出来形管理では計測した地盤と設計面を比較します。",
        ),
        Text.same(" / ".join(name_of(side) for side in (before, after))),
        Text("Compare an epoch with a design.", "計測データと設計データを比較してください。"),
    )


def notes_of(side: Side) -> tuple[Text, ...]:
    """What a reader must know of a side."""
    return side.notes if isinstance(side, TriangleSurface) else ()


def check_systems(*sides: Side) -> None:
    """Refuse epochs of different reference systems.

    Raises
    ------
    Unsuitable
    """
    named = [side for side in sides if isinstance(side, EpochGround) and side.crs]
    if len({side.crs for side in named}) > 1:
        raise Unsuitable(
            Text(
                "The epochs have different reference systems.", "時期によって座標系が異なります。"
            ),
            Text.same("; ".join(f"{side.name}: {side.crs}" for side in named)),
            Text(
                "Convert one of them, or import it with the right --crs.",
                "一方を変換するか、正しい座標系を指定してインポートし直してください。",
            ),
        )


def common_box(
    sides: tuple[Side, Side], boundary: shapely.Geometry | None, margin_m: float
) -> tuple[Floats, Floats, float]:
    """Corners of what both sides and the boundary have in common, and a height near the ground.

    Returns
    -------
    low, high : (2,) float64
        m, project CRS.
    height_m : float

    Raises
    ------
    Unsuitable
        The sides lie apart, or neither has an extent.
    OutOfRange
        The boundary lies outside.
    """
    boxes = [box for box in map(_box_of, sides) if box is not None]
    if not boxes:
        raise Unsuitable(
            Text("Neither side is a ground.", "どちらの側も地盤ではありません。"),
            Text.same(" / ".join(name_of(side) for side in sides)),
            Text("Choose an epoch or a design.", "計測した時期か設計面を選んでください。"),
        )
    low = np.max([box[0][:2] for box in boxes], axis=0)
    high = np.min([box[1][:2] for box in boxes], axis=0)
    if np.any(low >= high):
        raise _apart(sides, boxes)
    if boundary is not None:
        west, south, east, north = boundary.bounds
        edges = np.array([west, south]), np.array([east, north])
        if np.any(edges[0] >= high) or np.any(edges[1] <= low):
            raise OutOfRange(
                Text(
                    "The boundary lies outside of the ground.",
                    "境界が地盤の範囲の外にあります。",
                ),
                Text.same(_words(edges[0], edges[1])),
                Text(
                    "Choose another boundary; the ground is at {where}.",
                    "別の境界を指定してください。地盤の範囲は {where} です。",
                ).filled(where=_words(low, high)),
            )
        # The whole boundary counts, also where a side doesn't reach: it is reported as unmeasured.
        low, high = edges
    low, high = _with_margin(low, high, sides, margin_m)
    return low, high, float(np.floor(min(box[0][2] for box in boxes)))


def _with_margin(
    low: Floats, high: Floats, sides: tuple[Side, Side], margin_m: float
) -> tuple[Floats, Floats]:
    """A box and what was measured beside it: that tells how ground goes on at its edge."""
    epochs = [side for side in sides if isinstance(side, EpochGround)]
    if not epochs:
        return low, high
    first = np.max([side.low[:2] for side in epochs], axis=0)
    last = np.min([side.high[:2] for side in epochs], axis=0)
    return (
        np.minimum(np.maximum(first, low - margin_m), low),
        np.maximum(np.minimum(last, high + margin_m), high),
    )


def _box_of(side: Side) -> tuple[Floats, Floats] | None:
    if isinstance(side, EpochGround):
        return side.low, side.high
    if isinstance(side, TriangleSurface):
        used = side.xyz[np.unique(side.corners)]
        return used.min(axis=0), used.max(axis=0)
    return None


def check_points(side: EpochGround, cells: GroundCells) -> None:
    """Refuse an epoch with hardly a ground point where it is compared.

    Raises
    ------
    Unsuitable
    """
    count = int(cells.is_counted.sum())
    if count < _FEWEST_CELLS:
        points = int(cells.counts.sum())
        raise Unsuitable(
            Text("An epoch has too few ground points here.", "この範囲の地面の点が少なすぎます。"),
            Text(f"{side.name}: {points} points", f"{side.name}: {points}点"),
            Text(
                "Give the whole scan, find its ground, or choose another boundary.",
                "計測全体を指定するか、地面抽出を実行するか、境界を選び直してください。",
            ),
        )


def check_heights(before: GroundCells, after: GroundCells) -> None:
    """Refuse epochs that lie metres apart everywhere by the same amount: two height datums.

    Raises
    ------
    Unsuitable
    """
    change = after.heights - before.heights
    known = change[np.isfinite(change)]
    if known.size < _FEWEST_CELLS:
        return
    low, middle, high = np.percentile(known, [_LOW_PERCENT, 50, _HIGH_PERCENT])
    if abs(middle) > _APART_M and high - low < _EVEN_SHARE * abs(middle):
        raise Unsuitable(
            Text(
                "The epochs lie apart by the same height everywhere: two height datums.",
                "2時期の高さが全体で一様にずれています（標高の基準が異なるようです）。",
            ),
            Text.same(f"{middle:+.3f} m"),
            Text(
                "Bring both to one datum (a geoid height is missing in one of them).",
                "標高の基準をそろえてください（一方でジオイド高の補正が抜けています）。",
            ),
        )


def check_common(change: ChangeGrid, before: Side, after: Side) -> None:
    """Refuse sides that have no ground in common.

    Raises
    ------
    Unsuitable
    """
    if not (change.is_measured & (change.inside > 0)).any():
        raise _apart((before, after), [])


def notes_on(registration: Registration | None) -> tuple[Text, ...]:
    """What a reader must know of how the epochs fit."""
    if registration is None or not (registration.is_significant or registration.is_corrected):
        return ()
    east, north, up = (round(_MM * value) for value in registration.shift_m)
    words = (
        Text(
            "The later epoch was moved back by {east} mm east, {north} mm north, {up} mm up.",
            "後の時期を東{east}mm・北{north}mm・上{up}mmのずれだけ補正しました。",
        )
        if registration.is_corrected
        else Text(
            "The later epoch lies off by {east} mm east, {north} mm north, {up} mm up on stable "
            "ground; it was not corrected.",
            "変化のない地面で、後の時期が東{east}mm・北{north}mm・上{up}mmずれています"
            "（補正していません）。",
        )
    )
    return (words.filled(east=f"{east:+d}", north=f"{north:+d}", up=f"{up:+d}"),)


def notes_on_gaps(volumes: Volumes) -> tuple[Text, ...]:
    """What a reader must know of ground that nothing tells of."""
    if volumes.left_out_area_m2 < _WORTH_NAMING_M2:
        return ()
    return (
        Text(
            "{area} m² are left out and count nothing: there a design has a hole, or lies ground "
            "beyond the last points of a date.",
            "設計面の穴、またはいずれかの時期の計測点の外側にある{area}㎡は計算から除外し、"
            "土量に含めていません。",
        ).filled(area=f"{volumes.left_out_area_m2:,.0f}"),
    )


def notes_on_others(others: Sequence[EpochGround]) -> tuple[Text, ...]:
    """What a reader must know of other dates that hidden ground was filled by."""
    if not others:
        return ()
    names = ", ".join(one.name for one in others)
    return (
        Text(
            "Ground that a compared date did not show was filled in by other dates too: {names}.",
            "未計測部の補間には、ほかの時期の計測データも使用しました：{names}。",
        ).filled(names=names),
    )


def _apart(sides: tuple[Side, Side], boxes: list[tuple[Floats, Floats]]) -> Unsuitable:
    where = "; ".join(_words(low, high) for low, high in boxes)
    return Unsuitable(
        Text("The two sides have no ground in common.", "2つの地盤が重なっていません。"),
        Text.same(" / ".join(name_of(side) for side in sides) + (f": {where}" if where else "")),
        Text(
            "Choose two recordings of one place, and check their reference systems.",
            "同じ場所の2つの計測を選び、座標系を確認してください。",
        ),
    )


def _words(low: Floats, high: Floats) -> str:
    return f"E {low[0]:.1f} … {high[0]:.1f}, N {low[1]:.1f} … {high[1]:.1f}"
