"""What the import form says of the files that were chosen, in the user's language."""

from __future__ import annotations

from processing.core.errors import UserError
from processing.core.text import Language, Text
from processing.formats.format import Content
from processing.operations.delivery_overview import (
    DeliveryOverview,
    FileOverview,
    TrajectoryState,
)
from widgets.dialogs.delivery_map import DeliveryShapes
from widgets.dialogs.delivery_table import DeliveredRow

_KILOMETRE_M = 1000.0
_COUNTS = {
    Content.POINTS: Text("{count:,} points", "{count:,}点"),
    Content.TRAJECTORY: Text("{count:,} records", "{count:,}行"),
    Content.IMAGES: Text("{count:,} images", "{count:,}枚"),
}
_SAYS_NO_SYSTEM = Text("not said", "記載なし")
_UNREADABLE = Text("see below", "下記参照")
_WANTING = (TrajectoryState.MISSING, TrajectoryState.NOT_COVERING)


def rows_of(overview: DeliveryOverview, language: Language) -> tuple[DeliveredRow, ...]:
    """A line of the form's table for each file."""
    return tuple(_row(one, language) for one in overview.files)


def shapes_of(overview: DeliveryOverview) -> DeliveryShapes:
    """What the form's small map draws."""
    ways = [one.line for one in overview.files if one.content is Content.TRAJECTORY]
    images = [one.line for one in overview.files if one.content is Content.IMAGES]
    points = [one for one in overview.files if one.content is Content.POINTS]
    extents = [one.extent for one in points if one.extent is not None]
    return DeliveryShapes(extents, ways, images)


def summary_of(overview: DeliveryOverview) -> tuple[Text, ...]:
    """What belongs together, what is missing, and what speaks against the import."""
    points = [one for one in overview.files if one.content is Content.POINTS]
    readable = [one for one in points if one.trouble is None]
    said: list[Text] = []
    for number in sorted({one.recording for one in readable if one.recording >= 0}):
        together = [one for one in readable if one.recording == number]
        said.append(_recorded(together))
    if readable and not overview.crs and overview.trouble is None:
        said.append(
            Text(
                "No file names its reference system: choose it below, or later (Ctrl+R).",
                "座標参照系の記載がありません。下で選ぶか、後で指定してください（Ctrl+R）。",
            )
        )
    troubles = [one.trouble for one in overview.files] if overview.files else []
    said += [_said(one) for one in troubles if one is not None]
    if overview.trouble is not None and not any(troubles):
        said.append(_said(overview.trouble))
    return tuple(said)


def _recorded(together: list[FileOverview]) -> Text:
    """What was recorded at one time by one vehicle or from one place."""
    scanners = {number for one in together for number in one.scanners}
    days = sorted({one.day for one in together if one.day is not None})
    said = Text(
        "Recorded together: {names} – {points:,} points, scanners: {scanners}",
        "1回の計測: {names}（{points:,}点、スキャナ{scanners}台）",
    ).filled(
        names=", ".join(one.path.name for one in together),
        points=sum(one.count for one in together),
        scanners=max(1, len(scanners)),
    )
    if not days:
        return said
    return Text("{said}, {day}", "{said} {day}").filled(said=said, day=days[0].isoformat())


def _row(one: FileOverview, language: Language) -> DeliveredRow:
    trouble = one.trouble
    kind = one.content.value.in_language(language)
    if trouble is not None:
        return DeliveredRow(one.path, (kind, _UNREADABLE.in_language(language)), is_wanting=True)
    is_points = one.content is Content.POINTS
    state = one.trajectory if is_points else TrajectoryState.NOT_NEEDED
    says_state = is_points and state is not TrajectoryState.NOT_NEEDED
    return DeliveredRow(
        one.path,
        (
            kind,
            _COUNTS[one.content].filled(count=one.count).in_language(language),
            _extent(one),
            ", ".join(map(str, one.scanners)),
            _time(one),
            (one.crs or _SAYS_NO_SYSTEM.in_language(language)) if is_points else "",
            state.value.in_language(language) if says_state else "",
        ),
        is_wanting=state in _WANTING,
    )


def _extent(one: FileOverview) -> str:
    if one.extent is None:
        return ""
    east = one.extent[2] - one.extent[0]
    north = one.extent[3] - one.extent[1]
    if max(east, north) >= _KILOMETRE_M:
        return f"{east / _KILOMETRE_M:.1f} × {north / _KILOMETRE_M:.1f} km"
    return f"{east:.0f} × {north:.0f} m"


def _time(one: FileOverview) -> str:
    if one.times is None:
        return ""
    seconds = one.times[1] - one.times[0]
    day = "" if one.day is None else f"{one.day.isoformat()}  "
    return f"{day}{seconds:.0f} s" if seconds >= 10.0 else f"{day}{seconds:.1f} s"


def _said(trouble: UserError) -> Text:
    return Text("{what} {remedy}", "{what}{remedy}").filled(
        what=trouble.what, remedy=trouble.remedy
    )
