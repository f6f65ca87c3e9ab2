"""What the title block of a sheet says, from the project and from what was chosen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from datetime import date

from processing.core.text import Language, Text
from processing.formats.map_delivery import MapDelivery, SectionOptions, SheetOptions
from processing.formats.sheets.paper_layers import (
    CLIENT,
    DATE,
    DISTRICT,
    MAKER,
    SCALE,
    SYSTEM,
    TITLE,
)
from processing.formats.surfaces.landxml_systems import zone_of_system
from processing.formats.work_facts import day

_DRAWING, _PART, _SCALE = (
    Text("Drawing", "図面名"), Text("Part", "図郭・区間"), Text("Scale", "縮尺"),
)  # fmt: skip
_SYSTEM, _DATE = Text("Reference system", "座標系"), Text("Date", "年月日")
_CLIENT, _MAKER = Text("Client", "計画機関"), Text("Maker", "作業機関")

VALUE_LAYERS: Mapping[Text, str] = {
    _DRAWING: TITLE,
    _PART: DISTRICT,
    _SCALE: SCALE,
    _SYSTEM: SYSTEM,
    _DATE: DATE,
    _CLIENT: CLIENT,
    _MAKER: MAKER,
}
"""The layer of a row's value, where it has one of its own."""


@dataclass(frozen=True)
class SheetPart:
    """Which part of a job a sheet is.

    Attributes
    ----------
    name : str
        Of its part of the map or of a route.
    scale : str
        As it is written.
    number, count : int
        Of the sheet, from 1, and of all sheets.
    """

    name: str
    scale: str
    number: int
    count: int


def title_block(
    delivery: MapDelivery, options: SheetOptions | SectionOptions, part: SheetPart
) -> Mapping[Text, str]:
    """Rows from above: what was chosen, or else what the project's work details say.

    What neither knows stays empty.
    """
    work = delivery.work
    language: Language = delivery.language or "ja"
    made_on = "" if work.made_on == date.min else day(work.made_on).in_language(language)
    return {
        _DRAWING: options.sheet_title or work.work or delivery.name,
        Text("Sheet", "図面番号"): f"{part.number} / {part.count}",
        _PART: part.name,
        _SCALE: part.scale,
        _SYSTEM: _system(delivery),
        Text("Heights", "高さの基準"): options.sheet_heights or work.height_datum,
        _DATE: options.sheet_date or made_on,
        _CLIENT: options.sheet_client or work.client,
        _MAKER: options.sheet_maker or work.contractor,
        Text("Surveyor", "測量者"): options.sheet_surveyor or work.surveyor,
    }


def _system(delivery: MapDelivery) -> str:
    language: Language = delivery.language or "ja"
    if not delivery.crs:
        return Text("not known", "不明").in_language(language)
    zone = zone_of_system(delivery.crs)
    if not zone:
        return delivery.crs
    words = Text("Plane rectangular, zone {zone} ({crs})", "平面直角座標系 第{zone}系（{crs}）")
    return words.filled(zone=zone, crs=delivery.crs).in_language(language)
