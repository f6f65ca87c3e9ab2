"""Form 31-2 (様式-31-2 出来形合否判定総括表) as XLSX and CSV: the same numbers as on paper."""

from __future__ import annotations

from collections.abc import Iterable
from pathlib import Path

from processing.core.text import Language, Text
from processing.formats.reports.as_built_rows import (
    COLUMNS,
    FORM,
    MAP_TITLE,
    NO_DATA,
    RESULT,
    TITLE,
    AsBuiltFacts,
    face_rows,
    fact_rows,
    notes,
    verdict,
)
from processing.formats.reports.plan_picture import NO_VALUE, as_built_plan
from processing.formats.reports.report_sheet import (
    ReportSheet,
    SheetPicture,
    SheetRow,
    write_report_csv,
    write_report_xlsx,
)
from processing.methods.earthwork.as_built.as_built import AsBuiltResult
from processing.methods.earthwork.maps.heat_map import SHARE_CLASSES

_UNIT = Text("Unit", "単位")
_NOTE = Text("Note", "備考")


def write_as_built_csv(
    path: Path,
    result: AsBuiltResult,
    facts: AsBuiltFacts,
    language: Language,
    *,
    encoding: str = "utf-8",
    never: Iterable[Path] = (),
) -> None:
    """Write the form's facts, numbers and notes as CSV.

    Parameters
    ----------
    encoding : "utf-8" or "cp932"

    Raises
    ------
    OutOfRange, UserError
        As :func:`processing.formats.reports.report_sheet.write_report_csv`.
    """
    write_report_csv(path, _rows(result, facts), language, encoding, never=never)


def write_as_built_xlsx(
    path: Path,
    result: AsBuiltResult,
    facts: AsBuiltFacts,
    language: Language,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write the form as a workbook, with its heat map.

    Raises
    ------
    UserError
        What :func:`processing.core.safe_write.write_safely` raises.
    """
    plan = as_built_plan(result)
    picture = SheetPicture(MAP_TITLE, plan.rgb, SHARE_CLASSES, 0, "%", ((NO_DATA, NO_VALUE),))
    sheet = ReportSheet(FORM, _rows(result, facts), picture)
    write_report_xlsx(path, [sheet], language, never=never)


def _rows(result: AsBuiltResult, facts: AsBuiltFacts) -> list[SheetRow]:
    rows = [SheetRow([Text("{title} ({form})", "{title}（{form}）").filled(title=TITLE, form=FORM)],
                     is_head=True)]  # fmt: skip
    rows += [SheetRow([name, value]) for name, value in fact_rows(result, facts)]
    rows += [SheetRow([RESULT, verdict(passes=result.passes)]), SheetRow([])]
    face, item, measured, limit, judgement = COLUMNS
    rows.append(SheetRow([face, item, measured, _UNIT, limit, judgement], is_head=True))
    for one in result.faces:
        rows += [
            SheetRow([one.limits.name, row.name, row.value, row.unit, row.limit, row.verdict])
            for row in face_rows(one, result.table)
        ]
    rows.append(SheetRow([]))
    return rows + [SheetRow([_NOTE, note]) for note in notes(result)]
