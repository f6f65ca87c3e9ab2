"""The volume report (土量計算書) as XLSX and CSV: the same numbers as on paper."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from processing.core.text import Language, Text
from processing.formats.reports.plan_picture import change_plan
from processing.formats.reports.report_sheet import (
    ReportSheet,
    SheetPicture,
    SheetRow,
    write_report_csv,
    write_report_xlsx,
)
from processing.formats.reports.volume_rows import (
    MAP_TITLE,
    QUANTITY_COLUMNS,
    REMARKS,
    SECTION_COLUMNS,
    SURFACE_COLUMNS,
    TITLE,
    TOTAL,
    VolumeFacts,
    class_digits,
    method_rows,
    quantities,
    remarks,
    section_rows,
    section_sums,
    surface_rows,
    work_rows,
)
from processing.methods.earthwork.maps.heat_map import change_classes, change_limit
from processing.methods.earthwork.volumes.volume_result import VolumeResult

_SECTIONS = Text("Sections", "断面")
_DIGITS = 2


def write_volume_csv(
    path: Path,
    result: VolumeResult,
    facts: VolumeFacts,
    language: Language,
    *,
    encoding: str = "utf-8",
    never: Iterable[Path] = (),
) -> None:
    """Write the report's facts, numbers, sections and remarks as CSV.

    Parameters
    ----------
    encoding : "utf-8" or "cp932"

    Raises
    ------
    OutOfRange, UserError
        As :func:`processing.formats.reports.report_sheet.write_report_csv`.
    """
    rows = [*_report_rows(result, facts), SheetRow([]), *_section_rows(facts)]
    write_report_csv(path, rows, language, encoding, never=never)


def write_volume_xlsx(
    path: Path,
    result: VolumeResult,
    facts: VolumeFacts,
    language: Language,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write the report as a workbook, with its map and a sheet for the sections.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    limit_m = change_limit(result.change.change_m)
    classes = change_classes(limit_m)
    plan = change_plan(result.change, classes)
    picture = SheetPicture(MAP_TITLE, plan.rgb, classes, class_digits(limit_m), "m")
    sheets = [ReportSheet(TITLE, _report_rows(result, facts), picture)]
    sections = _section_rows(facts)
    if sections:
        sheets.append(ReportSheet(_SECTIONS, sections))
    write_report_xlsx(path, sheets, language, never=never)


def _report_rows(result: VolumeResult, facts: VolumeFacts) -> list[SheetRow]:
    rows = [SheetRow([TITLE], is_head=True)]
    rows += [SheetRow([name, value]) for name, value in work_rows(facts)]
    rows += [SheetRow([]), SheetRow(SURFACE_COLUMNS, is_head=True)]
    rows += [SheetRow(values) for values in surface_rows(facts)]
    rows.append(SheetRow([]))
    rows += [SheetRow([name, value]) for name, value in method_rows(result, facts)]
    rows += [SheetRow([]), SheetRow(QUANTITY_COLUMNS, is_head=True)]
    rows += [
        SheetRow([one.name, one.whole, one.measured, one.unit], digits=_DIGITS)
        for one in quantities(result)
    ]
    rows.append(SheetRow([]))
    return rows + [SheetRow([REMARKS, remark]) for remark in remarks(result)]


def _section_rows(facts: VolumeFacts) -> list[SheetRow]:
    sections = section_rows(facts)
    if not sections:
        return []
    rows = [SheetRow(SECTION_COLUMNS, is_head=True)]
    rows += [
        SheetRow(
            [one.name, one.distance_m, one.cut_m2, one.cut_m3, one.fill_m2, one.fill_m3],
            digits=_DIGITS,
        )
        for one in sections
    ]
    distance, cut, fill = section_sums(sections)
    rows.append(SheetRow([TOTAL, distance, None, cut, None, fill], digits=_DIGITS))
    return rows
