"""What is known of a drive, line by line, and what a surveyor says of it: its name and its day."""

from __future__ import annotations

from dataclasses import replace
from datetime import date
from pathlib import Path

from processing.core.errors import UNCHANGED, OutOfRange
from processing.core.text import Text
from processing.map.change import Change
from processing.project.project import Project
from processing.recording.drive import Drive
from processing.recording.drive_info import FILE_NAME, write_drive_info
from processing.recording.measured_day import measured_day

_NONE = Text("none", "なし")
_UNKNOWN = Text("unknown", "不明")


def description_change(project: Project, drive: Drive, name: str, measured_on: str) -> Change:
    """The step that gives a drive another name, or says on which day it was measured.

    Parameters
    ----------
    name : str
        Spaces around it don't count.
    measured_on : str
        As ``2026-04-01``; empty for the day that its times name.

    Raises
    ------
    OutOfRange
        The name is empty or another drive's, or the day is none.
    NoSpace
    """
    name, measured_on = name.strip(), measured_on.strip()
    _check(project, drive, name, measured_on)
    info = replace(drive.info, name=name, measured_on=measured_on)
    if info == drive.info:
        return Change()
    files = project.new_step_files()
    write_drive_info(files.expect(FILE_NAME, drive.id).parent, info)
    return Change(files=files.files())


def brief_facts(drive: Drive) -> tuple[tuple[Text, Text], ...]:
    """Names and values that need no reading: points, extent, reference system, rows, files."""
    info = drive.info
    size = " × ".join(f"{b - a:,.1f}" for a, b in zip(info.lowest, info.highest, strict=True))
    return (
        (Text("Points", "点数"), Text.same(f"{info.count:,}")),
        (Text("Extent", "範囲"), Text.same(f"{size} m")),
        (Text("Reference system", "座標参照系"), Text.same(info.crs) if info.crs else _UNKNOWN),
        (Text("Rows", "行"), _rows_words(drive)),
        *(
            (Text("Delivered file", "納品ファイル"), Text.same(str(drive.source_path(source))))
            for source in info.sources
        ),
    )


def facts_of_drive(drive: Drive) -> tuple[tuple[Text, Text], ...]:
    """Names and values with units, in the order in which they are shown."""
    scanner, images = drive.info.scanner, drive.noted_images or ()
    counted = Text("{count:,}", "{count:,}枚").filled(count=len(images))
    return (
        *brief_facts(drive),
        (Text("Scanner", "スキャナ"), Text.same(str(scanner)) if scanner else _UNKNOWN),
        (Text("Measured for", "計測時間"), _duration_of(drive)),
        (Text("Trajectory", "走行軌跡"), _trajectory_words(drive)),
        (Text("Camera images", "カメラ画像"), counted if images else _NONE),
    )


def day_by_times(drive: Drive) -> str:
    """The day that the times of a drive name, as ``2026-04-01``; empty where they name none."""
    day = measured_day((drive,), is_said=False)
    return "" if day is None else day.isoformat()


def _rows_words(drive: Drive) -> Text:
    """How the drive's rows were found, or why there are none."""
    info = drive.info
    if drive.revolutions is None:
        words = Text(
            "No revolutions of a scanner: {reason}", "スキャナの回転を特定できません: {reason}"
        )
        return words.filled(reason=info.rows_reason)
    pulses = f"{drive.revolutions.pulses_per_revolution:.0f}"
    if not info.has_measured_times:
        words = Text("{pulses} pulses per revolution. {how}", "1回転{pulses}パルス。{how}")
        return words.filled(pulses=pulses, how=info.rows_reason)
    return Text(
        "{rate} revolutions per second, {pulses} pulses per revolution",
        "毎秒{rate}回転、1回転{pulses}パルス",
    ).filled(rate=f"{drive.revolutions.revolution_rate_hz:.1f}", pulses=pulses)


def _duration_of(drive: Drive) -> Text:
    if not (drive.count and drive.info.has_measured_times and drive.columns.has("time")):
        return _UNKNOWN
    seconds = float(drive.columns["time"][-1]) - float(drive.columns["time"][0])
    return Text("{s:,.1f} s", "{s:,.1f}秒").filled(s=seconds) if seconds > 0 else _UNKNOWN


def _trajectory_words(drive: Drive) -> Text:
    if drive.trajectory is None:
        return _NONE
    return Text("{count:,} positions", "{count:,}点").filled(count=len(drive.trajectory.xyz))


def _check(project: Project, drive: Drive, name: str, measured_on: str) -> None:
    others = {one.info.name for one in project.drives if one.id != drive.id}
    where = Text.same(name or Path(drive.folder).name)
    if not name or name in others:
        raise OutOfRange(
            Text(
                "Every drive needs a name of its own.", "走行データの名前が空か、重複しています。"
            ),
            where,
            Text(
                "Give another name. {unchanged}", "別の名前を入力してください。{unchanged}"
            ).filled(unchanged=UNCHANGED),
        )
    try:
        if measured_on:
            date.fromisoformat(measured_on)
    except ValueError as error:
        raise OutOfRange(
            Text("This is no day.", "日付として読み取れません。"),
            Text.same(measured_on),
            Text("Write it as 2026-04-01.", "2026-04-01 のように入力してください。"),
        ) from error
