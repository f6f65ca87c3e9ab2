"""Benchmark of a large import: its time against decoding the same files, and its memory."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import BadFile
from processing.core.text import Text
from processing.laboratory.bench.case import Measurement
from processing.laboratory.bench.large_street import LongDelivery
from processing.laboratory.bench.watched_run import WatchedRun, run_watched


@dataclass(frozen=True)
class WatchedImport:
    """An import that was watched from outside.

    Attributes
    ----------
    seconds : float
    resident_gib, anonymous_gib : float or None
        Peaks over the process with its modules loaded; None where the system doesn't tell.
    """

    seconds: float
    resident_gib: float | None
    anonymous_gib: float | None


def measure_large_import(
    delivery: LongDelivery, project: Path, points: int
) -> tuple[Measurement, Measurement]:
    """Import into a project that stays, and decoding alone; each in a process of its own."""
    clouds = [str(cloud) for cloud in delivery.clouds]
    begin, end = _moments(_run("decode", clouds))
    importing, decoding_s = import_watched(delivery, project), end - begin
    what = Text(
        "Import of {points} points in {files} files, times decoding them by laspy and lazrs",
        "{files}ファイル・{points}点のインポート（laspyとlazrsによる復号時間に対する比）",
    )
    reported = f"import {importing.seconds:.1f} s, decoding {decoding_s:.1f} s"
    return (
        Measurement(
            "large-import",
            what.filled(points=f"{points:,}", files=len(clouds)),
            importing.seconds / decoding_s,
            "x",
            2.0,
            is_at_most=True,
            detail=reported,
            figures={"points": points, "import_s": importing.seconds, "decoding_s": decoding_s},
        ),
        memory_row("large-import-memory", _MEMORY, importing.resident_gib, importing.anonymous_gib),
    )


def import_watched(delivery: LongDelivery, project: Path) -> WatchedImport:
    """Import a delivery into a new project, in a process of its own.

    Raises
    ------
    BadFile
        It could not be imported.
    """
    clouds = [str(cloud) for cloud in delivery.clouds]
    run = _run("import", [str(project), str(delivery.trajectory), *clouds])
    begin, end = _moments(run)
    return WatchedImport(end - begin, *run.over_baseline(begin, begin, end))


def memory_row(
    name: str, what: Text, resident: float | None, anonymous: float | None, reported: str = ""
) -> Measurement:
    """GiB over the baseline: all that is resident is judged, mapped pages of files included."""
    figures: dict[str, float] = {}
    words = ["this system doesn't tell"]
    if resident is not None and anonymous is not None:
        words = [f"of these {anonymous:.2f} GiB in no file"]
        figures = {"resident_gib": resident, "anonymous_gib": anonymous}
    return Measurement(
        name,
        what,
        resident,
        "GiB",
        1.5,
        is_at_most=True,
        detail="; ".join(words + [reported] * bool(reported)),
        figures=figures,
    )


_MEMORY = Text(
    "Peak memory of that import, all its processes, over the baseline",
    "そのインポートの最大メモリ（全プロセス、基準からの増分）",
)


def _run(what: str, arguments: list[str]) -> WatchedRun:
    run = run_watched("processing.laboratory.bench.cases.import_run", [what, *arguments])
    if run.status != 0:
        last = run.complaints.strip().splitlines()[-1:] or [""]
        raise BadFile(
            Text("The recording could not be imported.", "計測データをインポートできません。"),
            Text.same(last[0]),
            Text("Make room on the disk and try again.", "ディスクを空けて再実行してください。"),
        )
    return run


def _moments(run: WatchedRun) -> tuple[float, float]:
    ready, done = (float(line.split()[1]) for line in run.lines)
    return ready, done
