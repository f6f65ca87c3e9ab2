"""What attributes are called that tools measure and a kind of the catalogue doesn't list.

An office's catalogue lists what its ledgers ask for; what else was measured of a feature is shown
and written all the same, by these names.
"""

from __future__ import annotations

from processing.core.text import Text
from processing.map.catalogue import AttributeField, Catalogue

_NO_YES = (Text("no", "いいえ"), Text("yes", "はい"))

_TYPES = {
    "utility_pole": Text("Utility pole", "電柱"),
    "street_light": Text("Street light", "照明柱"),
    "signal_pole": Text("Signal pole", "信号柱"),
    "sign_pole": Text("Sign post", "標識柱"),
    "mirror_pole": Text("Mirror post", "カーブミラー柱"),
    "arm_pole": Text("Pole with an arm", "アーム付き柱"),
    "bollard": Text("Bollard", "車止め"),
    "delineator": Text("Delineator", "視線誘導標"),
    "other": Text("Other", "その他"),
    "curb": Text("Curb", "縁石"),
    "dropped": Text("Dropped curb", "切下げ"),
    "lid": Text("Lid", "蓋"),
    "grating": Text("Grating", "グレーチング"),
}
"""What poles, curbs and gutters are, as files have it, and what it is called."""

_COLOURS: dict[str, Text] = {
    "blue": Text("Blue", "青"),
    "green": Text("Green", "緑"),
    "yellow": Text("Yellow", "黄"),
    "red": Text("Red", "赤"),
    "white": Text("White", "白"),
}
"""Grounds of signs, as the tool "signs" tells them (`plate_colours`)."""

_MEASURED = {
    one.id: one
    for one in (
        AttributeField(
            "type", Text("Type", "種類"), "choice",
            choices=tuple(_TYPES), choice_names=tuple(_TYPES.values()),
        ),
        AttributeField("width_m", Text("Width of the plate", "板の幅"), "number", "m"),
        AttributeField("plate_high_m", Text("Height of the plate", "板の高さ"), "number", "m"),
        AttributeField("lower_edge_m", Text("Lower edge", "下端高"), "number", "m"),
        AttributeField(
            "colour", Text("Colour of the plate", "板の色"), "choice",
            choices=tuple(_COLOURS), choice_names=tuple(_COLOURS.values()),
        ),
        AttributeField("tilt_deg", Text("Tilt (up: +)", "上下の傾き（上向き+）"), "number", "°"),
        AttributeField("roll_deg", Text("Roll", "板面内の傾き"), "number", "°"),
        AttributeField("supplementary", Text("Supplementary plate", "補助標識"), "text"),
        AttributeField("scan_lines", Text("Scan lines on it", "走査線数"), "count"),
        AttributeField("front_seen", Text("Front measured", "表面の計測"), "text"),
        AttributeField("facing_sure", Text("Facing certain", "向きは確実"), "text"),
        AttributeField(
            "diameter_within_m", Text("Diameter within (95 %)", "直径の誤差範囲（95 %）"),
            "number", "m",
        ),
        AttributeField("taper_m_per_m", Text("Taper", "先細り"), "number", "m/m"),
        AttributeField("arm_m", Text("Length of the arm", "アームの長さ"), "number", "m"),
        AttributeField("arm_height_m", Text("Height of the arm", "アームの高さ"), "number", "m"),
        AttributeField("residual_m", Text("Residual", "残差"), "number", "m"),
        AttributeField(
            "is_low", Text("Lower than allowed", "離隔不足"), "choice",
            choices=("no", "yes"), choice_names=_NO_YES,
        ),
    )
}  # fmt: skip


def field_of(catalogue: Catalogue, kind: str, id_: str) -> AttributeField | None:
    """An attribute as a kind lists it, or as it is called otherwise; None if nobody knows it."""
    listed = catalogue[kind].attribute(id_) if kind in catalogue else None
    return listed or _MEASURED.get(id_)
