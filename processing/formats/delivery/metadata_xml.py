"""Metadata of a survey in the Japanese profile, JMP 2.0, as the GSI takes it."""

from __future__ import annotations

from lxml import etree  # type: ignore[import-untyped]

from processing.formats.delivery.management_xml import SurveyFacts

NAMESPACE = "http://zgate.gsi.go.jp/ch/jmp/"
_CREATED, _COMPLETED, _OWNER, _PROCESSOR = "001", "001", "003", "009"
_SHIFT_JIS, _UTF8, _TRANSPORT, _DATA_SET = "023", "004", "018", "005"
"""Codes of ISO 19115: date types, progress, roles, character sets, topics, scopes."""

_DEGREES = 6


def metadata_xml(facts: SurveyFacts) -> bytes:
    """The metadata of the map, UTF-8.

    References
    ----------
    国土地理院技術資料 E1-No.281, JMP2.0仕様書; ISO 19115:2003, annex B.5 (codes).
    """
    root = etree.Element(f"{{{NAMESPACE}}}MD_Metadata", nsmap={None: NAMESPACE})
    data = _under(root, "identificationInfo", "MD_DataIdentification")
    citation = _under(data, "citation")
    _say(citation, "title", _title(facts))
    day = _under(citation, "date")
    _say(day, "date", facts.made_on.isoformat())
    _say(day, "dateType", _CREATED)
    _say(data, "abstract", _abstract(facts))
    _say(data, "purpose", "公共測量")
    _say(data, "status", _COMPLETED)
    _contact(data, "pointOfContact", facts.client, _OWNER)
    _contact(data, "pointOfContact", facts.contractor, _PROCESSOR)
    scale = _under(data, "spatialResolution", "equivalentScale")
    _say(scale, "denominator", str(facts.level))
    _say(_under(data, "language"), "isoCode", "jpn")
    _say(data, "characterSet", _SHIFT_JIS)
    _say(data, "topicCategory", _TRANSPORT)
    box = _under(data, "extent", "geographicElement", "EX_GeographicBoundingBox")
    _say(box, "extentTypeCode", "1")
    _say(_under(box, "extentReferenceSystem"), "code", "JGD2011 / (B,L)")
    names = (
        "westBoundLongitude", "eastBoundLongitude", "southBoundLatitude", "northBoundLatitude",
    )  # fmt: skip
    for name, value in zip(names, facts.bounds, strict=True):
        _say(box, name, f"{value:.{_DEGREES}f}")
    quality = _under(root, "dataQualityInfo", "DQ_DataQuality")
    _say(_under(quality, "scope"), "level", _DATA_SET)
    _say(_under(quality, "lineage"), "statement", _lineage(facts))
    _say(_under(root, "language"), "isoCode", "jpn")
    _say(root, "characterSet", _UTF8)
    _contact(root, "contact", facts.client, _OWNER)
    _say(root, "dateStamp", facts.made_on.isoformat())
    _say(root, "metadataStandardName", "JMP")
    _say(root, "metadataStandardVersion", "2.0")
    written: bytes = etree.tostring(root, encoding="UTF-8", xml_declaration=True, pretty_print=True)
    return written


def _under(parent: etree._Element, *names: str) -> etree._Element:
    for name in names:
        parent = etree.SubElement(parent, f"{{{NAMESPACE}}}{name}")
    return parent


def _say(parent: etree._Element, name: str, words: str) -> None:
    _under(parent, name).text = words


def _contact(parent: etree._Element, name: str, who: str, role: str) -> None:
    if who:
        contact = _under(parent, name)
        _say(contact, "organisationName", who)
        _say(contact, "role", role)


def _title(facts: SurveyFacts) -> str:
    return f"{facts.work} 数値地形図データ（地図情報レベル{facts.level}）"


def _abstract(facts: SurveyFacts) -> str:
    area = f"{facts.area}の" if facts.area else ""
    return f"{area}車載写真レーザ測量による数値地形図データ（地図情報レベル{facts.level}）。"


def _lineage(facts: SurveyFacts) -> str:
    heights = facts.heights or "未記載"
    return (
        f"座標参照系: 世界測地系（JGD2011）平面直角座標系第{facts.zone}系。"
        f"標高の基準: {heights}。点群から図化。{facts.software}"
    )
