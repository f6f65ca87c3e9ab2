"""What is said of an import: what came in, what was there already, and what is missing."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from processing.core.errors import UserError
from processing.core.text import Text
from processing.project.additions import Additions, lacks_trajectory
from processing.project.importing.import_request import ImportRequest
from processing.recording.drive import Drive
from processing.recording.waveform_facts import waveform_facts

_MOST_NAMES = 3


def imported_words(drives: Sequence[Drive], brought: Additions, crs: str) -> Text:
    """What is said after an import into a project of this reference system.

    Parameters
    ----------
    drives : sequence of Drive
        Those that are new or others now.
    """
    if brought.are_none:
        return known_words(brought.known) if brought.known else has_already()
    new = drives[: len(brought.folders)]
    if not new:
        return Text("Added to {names}.", "{names} に追加しました。").filled(
            names=_names([drive.info.name for drive in drives])
        )
    reported = Text("Imported {points:,} points", "{points:,}点をインポートしました")
    if not crs:
        reported = Text(
            "Imported {points:,} points; no file names their reference system (Ctrl+R)",
            "{points:,}点をインポートしました。座標参照系の記載がありません（Ctrl+R）",
        )
    elif any(map(lacks_trajectory, new)):
        reported = Text(
            "Imported {points:,} points without a trajectory: curbs and covered gutters need one "
            "(File ▸ Add a trajectory)",
            "{points:,}点を走行軌跡なしでインポートしました。縁石と蓋付き側溝の抽出には"
            "走行軌跡が必要です（ファイル ▸ 走行軌跡を追加）",
        )
    reported = reported.filled(points=sum(drive.count for drive in new))
    for line in (*column_remarks(new), *waveform_remarks(new)):
        reported = Text("{told}; {line}", "{told} {line}").filled(told=reported, line=line)
    return reported


def column_remarks(drives: Sequence[Drive]) -> tuple[Text, ...]:
    """A line for each delivered text file that doesn't say what its columns are."""
    sources = {
        one.path: one.columns
        for drive in drives
        for one in drive.info.sources
        if one.points and one.columns
    }
    reported = Text(
        "{name}: columns taken as {columns}", "{name}の列を {columns} として読み込みました"
    )
    return tuple(
        reported.filled(name=Path(path).name, columns=" ".join(columns))
        for path, columns in sources.items()
    )


def waveform_remarks(drives: Sequence[Drive]) -> tuple[Text, ...]:
    """A line for each reason why points of new drives lack the waveforms that their files name."""
    facts = [waveform_facts(drive) for drive in drives]
    return tuple(dict.fromkeys(line for one in facts if one is not None for line in one.remarks))


def known_words(known: Sequence[Path]) -> Text:
    """What is said of point files that are in the project already."""
    return Text(
        "In the project already, so not imported again: {names}",
        "すでにプロジェクトにあるため、インポートしませんでした: {names}",
    ).filled(names=_names([path.name for path in known]))


def has_already() -> Text:
    """What is said where no drive lacks what was to be added."""
    return Text(
        "Nothing was added: no drive lacks it. To replace a trajectory, name the drive's point "
        "files with it.",
        "追加が必要な走行データはありません。走行軌跡を差し替えるには、その走行データの"
        "点群ファイルとともに指定してください。",
    )


def lacking_words(drives: Sequence[Drive], brought: Additions, shown: Sequence[str]) -> Text:
    """What is said of new drives without a trajectory; empty where none lacks one.

    Parameters
    ----------
    shown : sequence of str
        The trajectories beside them, as one names them on the command line.
    """
    lacking = [drive for drive in drives[: len(brought.folders)] if lacks_trajectory(drive)]
    if not lacking:
        return Text("", "")
    files = [Path(source.path).name for drive in lacking for source in drive.info.sources]
    names = _names(list(dict.fromkeys(files)))
    if shown:
        reported = Text(
            "{names} has no trajectory; {files} beside it covers it: add {options}",
            "{names} には走行軌跡がありません。同じ場所の {files} が計測時刻を含んでいます。"
            "{options} を付けてください",
        )
        if len(set(files)) > 1:
            reported = Text(
                "{names} have no trajectory; {files} beside them covers them: add {options}",
                reported.ja,
            )
        return reported.filled(
            names=names,
            files=_names(shown),
            options=" ".join(f"--trajectory {path}" for path in shown),
        )
    return Text(
        "No trajectory was given for {names}; curbs and covered gutters need one: add it with "
        "zuka import PROJECT --trajectory FILE",
        "{names} には、縁石と蓋付き側溝の抽出に必要な走行軌跡がありません。"
        "zuka import PROJECT --trajectory FILE で追加してください",
    ).filled(names=names)


def removed_words(names: str) -> Text:
    """What is said of drives that were taken out of the project."""
    return Text(
        "Removed {names}; undo brings it back until the project is closed.",
        "{names} を除きました。プロジェクトを閉じるまでは元に戻せます。",
    ).filled(names=names)


def offered_words(offer: ImportRequest) -> UserError:
    """What is said where a trajectory lies beside files that were imported without one."""
    return UserError(
        Text(
            "The points were imported without a trajectory.", "走行軌跡なしでインポートしました。"
        ),
        Text.same(", ".join(str(path) for path in offer.trajectories)),
        Text(
            "This trajectory covers them. Without one, curbs and covered gutters can't be found.",
            "この走行軌跡が計測時刻を含んでいます。"
            "走行軌跡がないと縁石と蓋付き側溝を抽出できません。",
        ),
    )


def adding_words(request: ImportRequest) -> Text:
    """The title of the work."""
    if request.inputs:
        names = _names([path.name for path in request.inputs])
        return Text("Import {names}", "{names} のインポート").filled(names=names)
    names = _names([path.name for path in request.files])
    return Text("Add {names}", "{names} の追加").filled(names=names)


def _names(names: Sequence[str]) -> str:
    reported = ", ".join(names[:_MOST_NAMES])
    return reported if len(names) <= _MOST_NAMES else f"{reported} …"
