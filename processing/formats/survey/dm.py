"""Extended DM: the public survey's digital map file, a file for each sheet of level 500.

X is northing, Y easting, in millimetres from a sheet's lower left corner; names of the files are
the sheets' identifiers.
"""

from __future__ import annotations

from collections import Counter
from datetime import datetime

from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.accepted_features import accepted_features
from processing.formats.map_delivery import DmOptions, MapDelivery, Position
from processing.formats.shift_jis import ShiftJisText
from processing.formats.survey.dm_elements import elements_of
from processing.formats.survey.dm_records import DmElement, DmFacts, sheet_records
from processing.formats.survey.map_sheets import MapSheet, zone_for_sheets

NAME = Text("extended DM", "拡張DM")
_NO_SHEET = Text(
    "No sheet of the extended DM was written: no accepted feature has a code there.",
    "拡張DMの分類コードを持つ採用済みの地物がないため、図郭は作成されていません。",
)
_CHECK_EVERY = 64  # features


def write_dm_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write a map that is handed in as sheets; what it can't hold is left out and told.

    Kinds without a code, and candidates, have no place in it; where nothing is left there is no
    sheet.

    Raises
    ------
    Unsuitable
        The reference system is no plane rectangular one of Japan; an element has too many
        vertices.
    OutOfRange
        A place that no sheet of the zone has; a height of more digits than its field.

    References
    ----------
    作業規程の準則 付録7 公共測量標準図式, 数値地形図データファイル仕様 (拡張DM).
    """
    zone = zone_for_sheets(delivery.crs)
    texts = ShiftJisText()
    sheets: dict[MapSheet, list[DmElement]] = {}
    without: Counter[str] = Counter()
    features = accepted_features(delivery, NAME)
    for number, feature in enumerate(features):
        if number % _CHECK_EVERY == 0:
            monitor.check()
            monitor.report(number / len(features))
        kind = delivery.catalogue[feature.kind]
        if not kind.dm_code:
            without[kind.id] += 1
            continue
        for sheet, element in elements_of(zone, kind, feature, texts):
            sheets.setdefault(sheet, []).append(element)
    if not sheets:
        delivery.tell(_NO_SHEET)
    facts = _facts(delivery, texts)
    for sheet in sorted(sheets):
        monitor.check()
        records = sheet_records(sheet, sheets[sheet], facts, sheets.keys())
        content = b"".join(record + b"\r\n" for record in records)
        position(f"{sheet.identifier}.dm").write_bytes(content)
    _tell(delivery, without, texts)


def _facts(delivery: MapDelivery, texts: ShiftJisText) -> DmFacts:
    options = delivery.options_of(DmOptions)
    return DmFacts(
        title=texts.fitted(delivery.name, 30),
        device="Zuka",
        approval=texts.fitted(options.dm_approval, 30),
        company=texts.fitted(options.dm_company, 40),
        made=datetime.now().astimezone().strftime("%y%m"),
        accuracy=options.dm_accuracy,
    )


def _tell(delivery: MapDelivery, without: Counter[str], texts: ShiftJisText) -> None:
    if without:
        names = [(delivery.catalogue[kind].name, number) for kind, number in without.items()]
        delivery.tell(
            Text(
                "Not in the extended DM, which has no code for them: {kinds}.",
                "分類コードのない種別は拡張DMに含まれていません: {kinds}",
            ).filled(
                kinds=Text(
                    ", ".join(f"{name.en} ({number})" for name, number in names),
                    "、".join(f"{name.ja}（{number}）" for name, number in names),
                )
            )
        )
    for note in texts.notes:
        delivery.tell(note)
