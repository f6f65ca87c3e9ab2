"""KMZ: the map in WGS 84 for globes and telephones, a folder and a colour for each kind."""

from __future__ import annotations

import unicodedata
from collections.abc import Iterable, Sequence
from pathlib import Path
from xml.etree import ElementTree as ET
from zipfile import ZIP_DEFLATED, ZipFile

from pyproj import Transformer

from processing.core.monitor import Monitor
from processing.core.safe_write import write_safely
from processing.formats.map_delivery import MapDelivery
from processing.map.catalogue import FeatureKind, Geometry
from processing.map.feature import Feature

_KML = "http://www.opengis.net/kml/2.2"
_WGS84 = "EPSG:4326"
_LINE_PX = 2
_AREA_ALPHA = "66"  # the picture below stays visible
_CHECK_EVERY = 64  # features


def write_kmz_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a map: longitude and latitude with 9 decimals (0.1 mm), height as the map has it.

    Features lie on the globe's ground, whose heights are not the map's. Attributes are extended
    data under their names in the delivery's language.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.

    References
    ----------
    OGC 12-007r2, KML 2.3, and 07-147r2, KML 2.2.
    """
    transformer = Transformer.from_crs(delivery.crs, _WGS84, always_xy=True)
    root = ET.Element("kml", xmlns=_KML)
    document = ET.SubElement(root, "Document")
    _add(document, "name", delivery.name)
    groups: dict[str, list[Feature]] = {}
    for feature in delivery.features:
        groups.setdefault(feature.kind, []).append(feature)
    for id_ in groups:
        _add_style(document, delivery.catalogue[id_])
    done = 0
    for id_, members in groups.items():
        kind = delivery.catalogue[id_]
        folder = ET.SubElement(document, "Folder")
        _add(folder, "name", kind.name.in_language(delivery.language or "en"))
        for feature in members:
            if done % _CHECK_EVERY == 0:
                monitor.check()
                monitor.report(done / len(delivery.features))
            done += 1
            _add_placemark(folder, kind, feature, delivery, transformer)
    content = ET.tostring(root, encoding="utf-8", xml_declaration=True)
    with (
        write_safely(path, never=never) as temporary,
        ZipFile(temporary, "w", ZIP_DEFLATED) as archive,
    ):
        archive.writestr("doc.kml", content)


def _add(parent: ET.Element, tag: str, words: str) -> None:
    """Add an element of text; XML has no place for control characters."""
    plain = "".join(" " if unicodedata.category(one) in ("Cc", "Cs") else one for one in words)
    ET.SubElement(parent, tag).text = plain


def _add_style(document: ET.Element, kind: FeatureKind) -> None:
    red, green, blue = (kind.colour[at : at + 2] for at in (1, 3, 5))
    style = ET.SubElement(document, "Style", id=kind.id)
    _add(ET.SubElement(style, "IconStyle"), "color", f"ff{blue}{green}{red}")
    line = ET.SubElement(style, "LineStyle")
    _add(line, "color", f"ff{blue}{green}{red}")
    _add(line, "width", str(_LINE_PX))
    _add(ET.SubElement(style, "PolyStyle"), "color", f"{_AREA_ALPHA}{blue}{green}{red}")


def _add_placemark(
    folder: ET.Element,
    kind: FeatureKind,
    feature: Feature,
    delivery: MapDelivery,
    transformer: Transformer,
) -> None:
    mark = ET.SubElement(folder, "Placemark")
    values = (feature.attributes.get(name) for name in ("name", "number"))
    language = delivery.language or "en"
    words = next((str(value) for value in values if value not in (None, "")), "")
    _add(mark, "name", words or kind.name.in_language(language))
    _add(mark, "styleUrl", f"#{kind.id}")
    data = ET.SubElement(mark, "ExtendedData")
    told = {"id": feature.id, "kind": feature.kind, "status": feature.status.value}
    for name, value in (*told.items(), *feature.attributes.items()):
        if value is not None:
            field = kind.attribute(name)
            title = name if field is None else field.name.in_language(language)
            _add(ET.SubElement(data, "Data", name=title), "value", str(value))
    xyz = [vertex.xyz for vertex in feature.vertices]
    match feature.geometry:
        case Geometry.POINT:
            holder = ET.SubElement(mark, "Point")
        case Geometry.LINE:
            holder = ET.SubElement(mark, "LineString")
            _add(holder, "tessellate", "1")
        case Geometry.AREA:
            area = ET.SubElement(mark, "Polygon")
            holder = ET.SubElement(ET.SubElement(area, "outerBoundaryIs"), "LinearRing")
            xyz = [*xyz, xyz[0]]
    _add(holder, "coordinates", _coordinates(xyz, transformer))


def _coordinates(xyz: Sequence[tuple[float, float, float]], transformer: Transformer) -> str:
    eastings, northings, heights = zip(*xyz, strict=True)
    places = zip(*transformer.transform(eastings, northings), heights, strict=True)
    return " ".join(f"{east:.9f},{north:.9f},{height:.3f}" for east, north, height in places)
