"""A survey as the folder of an electronic delivery (測量成果電子納品要領).

The tree and the management files are those of the ministry's rule; the map is in extended DM
(標準図式データファイル形式), which the rule takes where both sides agree on it.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import replace
from pathlib import Path

from processing.core.errors import MissingInput, Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.delivery.accuracy_pdf import write_accuracy_pdf
from processing.formats.delivery.delivered_files import (
    RECORDS,
    RESULTS,
    SURVEY,
    TOPOGRAPHY,
    SurveyFile,
    check_file,
    check_folder,
)
from processing.formats.delivery.management_xml import (
    INDEX,
    OF_TOPOGRAPHY,
    SURVEYED,
    SurveyFacts,
    check_day,
    dtds_beside,
    fault_by_dtd,
    index_xml,
    survey_xml,
    topography_xml,
)
from processing.formats.delivery.metadata_xml import metadata_xml
from processing.formats.map_delivery import DeliveryOptions, MapDelivery, Position
from processing.formats.reports.quality.quality_pdf import write_quality_pdf
from processing.formats.reports.quality.quality_report import checked_points, quality_facts
from processing.formats.shift_jis import ShiftJisText
from processing.formats.survey.dm import write_dm_map
from processing.formats.survey.map_sheets import zone_for_sheets
from processing.formats.work_facts import WorkFacts
from processing.map.map_extent import extent_of
from processing.map.reference_transform import reference_transform

_DM, _QUALITY, _ACCURACY, _METADATA = (
    "数値地形図データファイル", "品質評価表", "数値地形図データ作成精度管理表", "メタデータ",
)  # fmt: skip
_LEVEL = 500
"""Of the sheets of the extended DM."""

_NO_DTDS = Text(
    "The management files are without DTD and not checked: give the edition's (--delivery-dtds)"
    " and complete them with the client's delivery program.",
    "管理ファイルにDTDがなく、検査していません。適用する要領のDTDを指定し（--delivery-dtds）、"
    "発注者指定の電子納品ソフトで不足項目を補ってください。",
)
_FAULT = Text(
    "{file} is not yet as {dtd} prescribes: {fault}.",
    "{file}は{dtd}の規定を満たしていません: {fault}",
)
_NO_ACCURACY = Text(
    "No 精度管理表 was written: give check points (--check-points).",
    "検証点（--check-points）の指定がないため、精度管理表は作成していません。",
)
_NO_HEIGHTS = Text(
    "The zero of heights is not known: say in the work details whether JGD2011 or JGD2024.",
    "標高の基準が未入力です。工事情報でJGD2011かJGD2024かを入力してください。",
)


_Place = Callable[..., Path]


def write_delivery_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write the folder: management files, map sheets, quality papers, metadata.

    Raises
    ------
    Unsuitable
        The reference system is no plane rectangular one of Japan; nothing has a code of the DM.
    MissingInput, OutOfRange, BadFile
        Check points or DTDs can't be read; a date or name is not as the rule has it.
    UserError
        What stands against writing; `Cancelled`.
    """
    options = delivery.options_of(DeliveryOptions)
    facts = _facts(delivery, options)
    dtds = dtds_beside(Path(options.delivery_dtds)) if options.delivery_dtds else {}
    files: list[SurveyFile] = []

    def place(part: str, name: str, title: str, subtitle: str = "") -> Path:
        one = SurveyFile(part, facts.folder, check_file(name), title, subtitle)
        files.append(one)
        return position(one.path)

    def sheet(name: str) -> Path:
        return place(RESULTS, name.upper(), _DM, Path(name).stem)

    write_dm_map(delivery, sheet, monitor)
    if not files:
        raise Unsuitable(
            Text(
                "Nothing on the map has a class code, so there is nothing to deliver.",
                "分類コードをもつ地物がないため、納品するデータがありません。",
            ),
            Text("electronic delivery", "電子納品"),
            Text("Accept or draw features first.", "先に地物を採用または作図してください。"),
        )
    _write_papers(delivery, facts, place, monitor)
    metadata = f"{options.delivery_advice or 'META0001'}.XML"
    place(RESULTS, metadata, _METADATA).write_bytes(metadata_xml(facts))
    _write_management(delivery, facts, files, dtds, position)


def _write_papers(
    delivery: MapDelivery, facts: SurveyFacts, place: _Place, monitor: Monitor
) -> None:
    work = _work(delivery, facts)
    points = checked_points(delivery)
    quality = quality_facts(delivery, points, monitor, software=facts.software, work=work)
    write_quality_pdf(place(RESULTS, "HINSH001.PDF", _QUALITY), quality, "ja", monitor)
    if points is None:
        delivery.tell(_NO_ACCURACY)
    else:
        write_accuracy_pdf(place(RECORDS, "SEIDO001.PDF", _ACCURACY), points, work, monitor)
    if not facts.heights:
        delivery.tell(_NO_HEIGHTS)


def _write_management(
    delivery: MapDelivery,
    facts: SurveyFacts,
    files: list[SurveyFile],
    dtds: Mapping[str, Path],
    position: Position,
) -> None:
    texts = ShiftJisText()
    beside = f"{SURVEY}/{TOPOGRAPHY}/"
    written = (
        ("", INDEX, index_xml(facts, texts, dtds)),
        (f"{SURVEY}/", SURVEYED, survey_xml(facts, texts, dtds)),
        (beside, OF_TOPOGRAPHY, topography_xml(files, texts, dtds)),
    )
    for folder, name, content in written:
        position(folder + name).write_bytes(content)
        dtd = dtds.get(name)
        if dtd is None:
            continue
        fault = fault_by_dtd(content, dtd)
        position(folder + check_file(dtd.name.upper())).write_bytes(dtd.read_bytes())
        if fault:
            delivery.tell(_FAULT.filled(file=name, dtd=dtd.name, fault=fault))
    if len(dtds) < len(written):
        delivery.tell(_NO_DTDS)
    for note in texts.notes:
        delivery.tell(note)


def _facts(delivery: MapDelivery, options: DeliveryOptions) -> SurveyFacts:
    zone = zone_for_sheets(delivery.crs)
    extent = extent_of(delivery.features)
    if extent is None:
        raise MissingInput(
            Text("The map has no features to deliver.", "納品する地物がありません。"),
            Text("electronic delivery", "電子納品"),
            Text("Accept or draw features first.", "先に地物を採用または作図してください。"),
        )
    for value in (options.delivery_start, options.delivery_end):
        check_day(value)
    work = delivery.work
    return SurveyFacts(
        work=work.work or delivery.name,
        area=options.delivery_area or work.place,
        client=work.client,
        contractor=work.contractor,
        begins=options.delivery_start,
        ends=options.delivery_end,
        edition=options.delivery_edition,
        level=_LEVEL,
        zone=zone,
        bounds=_degrees(extent, delivery.crs),
        folder=check_folder(options.delivery_folder or "ZUKA_A"),
        software=work.software,
        heights=_heights(work.height_datum),
        made_on=work.made_on,
    )


def _work(delivery: MapDelivery, facts: SurveyFacts) -> WorkFacts:
    """The work as its papers name it."""
    return replace(
        delivery.work,
        work=facts.work,
        place=facts.area,
        crs=delivery.crs,
        height_datum=facts.heights,
    )


def _heights(said: str) -> str:
    """The datum of heights as products name it: 測地成果2024 is that of JGD2024."""
    year = re.fullmatch(r"JGD\s?(2011|2024)", said.strip(), re.IGNORECASE)
    return f"JGD{year[1]}（測地成果{year[1]}）" if year else said.strip()


def _degrees(
    extent: tuple[float, float, float, float], crs: str
) -> tuple[float, float, float, float]:
    """West, east, south and north of a box in a plane system."""
    import numpy as np

    west, south, east, north = extent
    corners = np.array([(x, y, 0.0) for x in (west, east) for y in (south, north)])
    moved = reference_transform(crs, "EPSG:6668").apply(corners)
    lons, lats = moved[:, 0], moved[:, 1]
    return float(lons.min()), float(lons.max()), float(lats.min()), float(lats.max())
