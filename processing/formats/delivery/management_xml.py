"""Management files of an electronic delivery: what was delivered, for whom, and where it lies."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from datetime import date
from io import BytesIO
from pathlib import Path

from lxml import etree  # type: ignore[import-untyped]

from processing.core.errors import BadFile, OutOfRange, report_as_user_error
from processing.core.japanese_text import decode_text
from processing.core.text import Text
from processing.formats.delivery.delivered_files import (
    RECORDS,
    RESULTS,
    SURVEY,
    TOPOGRAPHY,
    SurveyFile,
)
from processing.formats.shift_jis import ShiftJisText

_VERSION = re.compile(r"(\d{2})\.DTD", re.IGNORECASE)
_NO_DATE = "9999-01-01"
"""What the rules write where a date is not known."""

_DECLARED = re.compile(r"^\s*<\?xml[^>]*\?>\s*")
_DAY = re.compile(r"\d{4}-\d{2}-\d{2}")
INDEX, SURVEYED, OF_TOPOGRAPHY = "INDEX_D.XML", "SURVEY.XML", "SURV_CHI.XML"
_ROOTS = {INDEX: "gyomudata", SURVEYED: "surveydata", OF_TOPOGRAPHY: "surv_data"}
_DTD_STEMS = {INDEX: "INDE_D", SURVEYED: "SURVEY", OF_TOPOGRAPHY: "SURV_D"}
_CATEGORY, _KIND = "地形測量及び写真測量", "車載写真レーザ測量"


@dataclass(frozen=True)
class SurveyFacts:
    """What management files say of a survey; what is empty is left blank there.

    Attributes
    ----------
    edition : str
        適用要領基準.
    begins, ends : str
        ``YYYY-MM-DD`` or empty.
    zone : int
        Of the plane rectangular coordinate system.
    bounds : (west, east, south, north) of float
        Degrees.
    software : str
        Name and version of the program.
    """

    work: str
    area: str
    client: str
    contractor: str
    begins: str
    ends: str
    edition: str
    level: int
    zone: int
    bounds: tuple[float, float, float, float]
    folder: str
    software: str
    heights: str
    made_on: date = field(default_factory=date.today)


def check_day(value: str) -> str:
    """A date as it is written; the one for unknown dates where it is empty.

    Raises
    ------
    OutOfRange
        It is no date.
    """
    found = _DAY.fullmatch(value)
    try:
        return date.fromisoformat(found[0]).isoformat() if found else _unknown_day(value)
    except ValueError as error:
        raise OutOfRange(
            Text("That is no date.", "日付として読めません。"),
            Text.same(value),
            Text("Write it as 2026-04-01.", "2026-04-01のように入力してください。"),
        ) from error


def _unknown_day(value: str) -> str:
    if value:
        raise ValueError(value)
    return _NO_DATE


def index_xml(facts: SurveyFacts, texts: ShiftJisText, dtds: Mapping[str, Path]) -> bytes:
    """``INDEX_D.XML``: the work (業務管理ファイル)."""
    west, east, south, north = facts.bounds
    content: _Members = [
        (
            "基礎情報",
            [
                ("メディア番号", "1"),
                ("メディア総枚数", "1"),
                ("適用要領基準", facts.edition),
                ("測量データフォルダ名", SURVEY),
            ],
        ),
        (
            "業務件名等",
            [
                ("業務名称", facts.work),
                ("履行期間-着手", check_day(facts.begins)),
                ("履行期間-完了", check_day(facts.ends)),
            ],
        ),
        (
            "場所情報",
            [
                ("測地系", "02"),
                (
                    "境界座標情報",
                    [
                        ("西側境界座標経度", _angle(west, 3)),
                        ("東側境界座標経度", _angle(east, 3)),
                        ("北側境界座標緯度", _angle(north, 2)),
                        ("南側境界座標緯度", _angle(south, 2)),
                    ],
                ),
            ],
        ),
        ("発注者情報", [("発注者機関事務所名", facts.client)]),
        ("受注者情報", [("受注者名", facts.contractor)]),
        ("業務情報", [("業務概要", _abstract(facts))]),
    ]
    return _file(INDEX, content, texts, dtds)


def survey_xml(facts: SurveyFacts, texts: ShiftJisText, dtds: Mapping[str, Path]) -> bytes:
    """``SURVEY.XML``: what was surveyed (測量情報管理ファイル)."""
    base = f"{SURVEY}/{TOPOGRAPHY}"
    west, east, south, north = facts.bounds
    content: _Members = [
        ("基礎情報", [("適用要領基準", facts.edition)]),
        (
            "場所情報",
            [
                ("測量区域名", facts.area),
                (
                    "区域情報",
                    [
                        ("平面直角座標系", f"{facts.zone:02d}"),
                        ("西側境界座標経度", _angle(west, 3)),
                        ("東側境界座標経度", _angle(east, 3)),
                        ("北側境界座標緯度", _angle(north, 2)),
                        ("南側境界座標緯度", _angle(south, 2)),
                    ],
                ),
            ],
        ),
        (
            "測量情報",
            [
                ("測量区分", _CATEGORY),
                ("測量細区分", _KIND),
                ("等級精度", f"地図情報レベル{facts.level}"),
                ("測量記録フォルダパス名", f"{base}/{RECORDS}/{facts.folder}"),
                ("測量成果フォルダパス名", f"{base}/{RESULTS}/{facts.folder}"),
            ],
        ),
        ("ソフトメーカ用TAG", facts.software),
    ]
    return _file(SURVEYED, content, texts, dtds)


def topography_xml(
    files: Sequence[SurveyFile], texts: ShiftJisText, dtds: Mapping[str, Path]
) -> bytes:
    """``SURV_CHI.XML``: every file of the topographic survey (測量成果管理ファイル)."""
    titles = dict.fromkeys((one.part, one.folder, one.title) for one in files)
    content: _Members = []
    for part, folder, title in titles:
        members: _Members = [
            ("測量成果区分フォルダ名", part),
            ("測量細区分フォルダ名", folder),
            ("測量成果名称", title),
        ]
        for one in files:
            if (one.part, one.folder, one.title) == (part, folder, title):
                named: _Members = [("測量成果ファイル名", one.name)]
                if one.subtitle:
                    named.append(("測量成果ファイル名副題", one.subtitle))
                members.append(("成果ファイル情報", named))
        content.append(("測量成果情報", members))
    return _file(OF_TOPOGRAPHY, content, texts, dtds)


def dtds_beside(path: Path) -> dict[str, Path]:
    """The DTDs in the folder of one, by the management file that each is for.

    Raises
    ------
    MissingInput, NoSpace
        It can't be read.
    BadFile
        None of them is for these files.
    """
    with report_as_user_error(path):
        beside = sorted(one for one in path.parent.iterdir() if one.suffix.upper() == ".DTD")
        path.read_bytes()
    found = {
        name: one
        for name, stem in _DTD_STEMS.items()
        for one in beside
        if re.fullmatch(rf"{stem}\d\d\.DTD", one.name.upper())
    }
    if not found:
        raise BadFile(
            Text("No DTD of an electronic delivery is there.", "電子納品のDTDがありません。"),
            Text.same(str(path.parent)),
            Text(
                "Choose the folder with INDE_D##.DTD, SURVEY##.DTD and SURV_D##.DTD.",
                "INDE_D##.DTD・SURVEY##.DTD・SURV_D##.DTDのあるフォルダを選んでください。",
            ),
        )
    return found


def fault_by_dtd(content: bytes, dtd: Path) -> str:
    """What a management file lacks by its DTD; empty where it is as prescribed.

    Raises
    ------
    BadFile
        The DTD can't be read as one.
    """
    try:
        with report_as_user_error(dtd):
            said = decode_text(dtd.read_bytes(), dtd)
        # The library knows no Shift_JIS: it gets both as Unicode, without what they declare.
        rules = etree.DTD(BytesIO(_DECLARED.sub("", said).encode("utf-8")))
        words = _DECLARED.sub("", content.decode("cp932"))
        rules.validate(etree.fromstring(words, etree.XMLParser(load_dtd=False)))
    except (etree.DTDParseError, etree.XMLSyntaxError) as error:
        raise BadFile(
            Text("The file is no DTD, or is damaged.", "DTDではないか、壊れています。"),
            Text.same(f"{dtd}: {error}"),
            Text(
                "Copy it again from the ministry's page.",
                "国土交通省のページから入手し直してください。",
            ),
        ) from error
    return str(rules.error_log[0].message) if len(rules.error_log) else ""


_Members = list[tuple[str, "str | _Members"]]


def _file(name: str, content: _Members, texts: ShiftJisText, dtds: Mapping[str, Path]) -> bytes:
    dtd = dtds.get(name)
    version = _VERSION.search(dtd.name) if dtd is not None else None
    root = etree.Element(_ROOTS[name])
    if version is not None:
        root.set("DTD_version", version[1])
    _add(root, content, texts)
    doctype = "" if dtd is None else f'<!DOCTYPE {_ROOTS[name]} SYSTEM "{dtd.name.upper()}">\n'
    body = etree.tostring(root, encoding="unicode", pretty_print=True)
    words = f'<?xml version="1.0" encoding="Shift_JIS"?>\n{doctype}{body}'
    return words.replace("\n", "\r\n").encode("cp932")


def _add(parent: etree._Element, content: _Members, texts: ShiftJisText) -> None:
    for name, value in content:
        one = etree.SubElement(parent, name)
        if isinstance(value, str):
            one.text = texts.fitted(value)
        else:
            _add(one, value, texts)


def _angle(degrees: float, digits: int) -> str:
    """``1394530``: degrees, minutes, whole seconds."""
    seconds = round(abs(degrees) * 3600)
    return f"{seconds // 3600:0{digits}d}{seconds // 60 % 60:02d}{seconds % 60:02d}"


def _abstract(facts: SurveyFacts) -> str:
    heights = f"、標高の基準 {facts.heights}" if facts.heights else ""
    return (
        f"{_KIND}による数値地形図データ（地図情報レベル{facts.level}、"
        f"世界測地系（JGD2011）平面直角座標系第{facts.zone}系{heights}）"
    )
