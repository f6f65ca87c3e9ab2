"""What the title block of a sheet says, from the project and from what was chosen."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from processing.core.text import Language, Text
from processing.formats.map_delivery import MapDelivery, SectionOptions, SheetOptions
from processing.formats.surfaces.landxml_systems import zone_of_system


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
    """Rows from above; what is not known stays empty."""
    return {
        Text("Drawing", "図面名"): options.sheet_title or delivery.name,
        Text("Sheet", "図面番号"): f"{part.number} / {part.count}",
        Text("Part", "図郭・区間"): part.name,
        Text("Scale", "縮尺"): part.scale,
        Text("Reference system", "座標系"): _system(delivery),
        Text("Heights", "高さの基準"): options.sheet_heights,
        Text("Date", "年月日"): options.sheet_date,
        Text("Client", "計画機関"): options.sheet_client,
        Text("Maker", "作業機関"): options.sheet_maker,
        Text("Surveyor", "測量者"): options.sheet_surveyor,
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
