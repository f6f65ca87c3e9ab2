"""Sections as CSV: every place of the ground line, and where features are crossed."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Sequence
from dataclasses import dataclass

from processing.core.errors import OutOfRange
from processing.core.text import Text
from processing.formats.map_delivery import MapDelivery, SectionOptions
from processing.formats.sections.route_sections import CrossedFeature, RouteSection
from processing.map.routes.route import station_words

_COLUMNS = (
    "route", "station", "station_m", "offset_m", "height_m", "easting_m", "northing_m", "point",
    "code", "name", "feature",
)  # fmt: skip


@dataclass(frozen=True)
class _Place:
    """A row: where it is, and the feature that is crossed there."""

    along_m: float
    height_m: float
    crossed: CrossedFeature | None = None


def section_table(
    sections: Sequence[RouteSection], delivery: MapDelivery, options: SectionOptions
) -> bytes:
    """The places of some sections in the order of the route, those of one from left to right.

    Offsets are metres to the right of the centre line; ``point`` is ``ground``, ``centre`` or
    ``feature``.

    Raises
    ------
    OutOfRange
        A character that the encoding lacks.
    """
    table = io.StringIO()
    writer = csv.writer(table, lineterminator="\r\n")
    writer.writerow(_COLUMNS)
    for section in sections:
        for place in _places(section):
            writer.writerow(_row(section, place, delivery, options.digits))
    encoding = "utf-8-sig" if options.encoding == "utf-8" else options.encoding
    try:
        return table.getvalue().encode(encoding)
    except UnicodeEncodeError as error:
        raise OutOfRange(
            Text("The encoding lacks a character.", "文字コードに含まれない文字があります。"),
            Text.same(f"{error.object[error.start]!r} ({options.encoding})"),
            Text("Choose UTF-8; nothing was written.",
                 "UTF-8を選んでください。何も書き込まれていません。"),
        ) from error  # fmt: skip


def _places(section: RouteSection) -> Iterable[_Place]:
    found = [_Place(x, y) for part in section.ground for x, y in part.tolist()]
    found += [_Place(one.along_m, one.height_m, one) for one in section.crossed]
    middle = section.ground_at(0.0) if section.station_m is not None else None
    if middle is not None:
        found.append(_Place(0.0, middle))
    return sorted(found, key=lambda one: one.along_m)


def _row(section: RouteSection, place: _Place, delivery: MapDelivery, digits: int) -> list[str]:
    station, offset = section.station_m, place.along_m
    if station is None:
        station, offset = place.along_m, 0.0
    easting, northing = section.place_of(place.along_m)
    point = "centre" if section.station_m is not None and offset == 0.0 else "ground"
    name = code = id_ = ""
    if place.crossed is not None:
        kind = place.crossed.kind
        point, code, id_ = "feature", kind.dm_code, place.crossed.feature.id
        name = kind.name.in_language(delivery.language or "ja")
    route = section.route.name
    return [
        f"'{route}" if route[:1] in ("=", "+", "-", "@") else route,
        station_words(station),
        *(f"{round(one, digits) + 0.0:.{digits}f}"
          for one in (station, offset, place.height_m, easting, northing)),
        point, code, name, id_,
    ]  # fmt: skip
