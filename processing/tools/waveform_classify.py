"""The tool WAVEFORM-CLASSIFY: six classes of flights, from waveforms or from points alone."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.parameters import ratio, switch
from processing.core.text import Text
from processing.methods.classes.flight_classes import classify_flight, flight_cell_m
from processing.recording.drive import Drive
from processing.scoring.points.six_classes import SIX
from processing.scoring.scorers import SIX_CLASS_SCORER
from processing.tools.classify import unknown_classes, write_classes
from processing.tools.tool import Needs, OutputColumn, Together, TogetherResult, Tool

_FINDING = 0.95
"""Of the progress: when all points have a class."""

_BY_WAVEFORMS = Text("classes by waveforms and surroundings", "波形と周囲の点から分類しました")
_BY_POINTS = Text(
    "no waveforms: classes by points and their intensity alone",
    "波形がないため、点と反射強度のみから分類しました",
)


@dataclass(frozen=True)
class WaveformClassifyParameters:
    """How sure a class must be, and from what it is told."""

    least_confidence: float = ratio(
        0.0,
        low=0.0,
        high=1.0,
        name=Text("Least confidence", "信頼度の下限"),
        explanation=Text(
            "Points whose class is less likely than this become “other” (1).",
            "クラスの信頼度がこの値より低い点は「その他」（1）とします。",
        ),
    )
    uses_waveforms: bool = switch(
        default=True,
        name=Text("Use waveforms", "波形を使用"),
        explanation=Text(
            "Off: classes are told from points alone, as where a flight has no waveforms.",
            "オフの場合は、波形のないデータと同様に点のみから分類します。",
        ),
    )


def mark_six_classes(
    drives: tuple[Drive, ...],
    parameters: WaveformClassifyParameters,
    into: Path,
    points_at_once: int,
    monitor: Monitor,
) -> TogetherResult:
    """The class of every point and how sure it is; noise keeps its class.

    Parameters
    ----------
    drives : tuple of Drive
        Strips that were flown together.
    into : Path
        Gets the columns of the first drive, and folders for the others.
    points_at_once : int
        Not asked: what is in memory at a time is part of the method.

    Raises
    ------
    BadFile, MissingInput, NoSpace, Cancelled
    """
    del points_at_once
    folders = [into / str(number) if number else into for number in range(len(drives))]
    scratch = into / "scratch"
    with report_as_user_error(into):
        for folder in folders[1:]:
            folder.mkdir()
        scratch.mkdir()
        found = [unknown_classes(drive, scratch) for drive in drives]
        flown = [number for number, drive in enumerate(drives) if drive.count]
        by_waveforms = bool(flown) and classify_flight(
            [drives[number] for number in flown],
            [found[number] for number in flown],
            scratch,
            PartMonitor(monitor, 0.0, _FINDING),
            cell_m=flight_cell_m(drives),
            uses_waveforms=parameters.uses_waveforms,
        )
        columns = tuple(
            write_classes(drive, one, parameters.least_confidence, folder, monitor)
            for drive, one, folder in zip(drives, found, folders, strict=True)
        )
        remove_folder(scratch)
    return TogetherResult(columns, note=_BY_WAVEFORMS if by_waveforms else _BY_POINTS)


WAVEFORM_CLASSIFY = Tool(
    id="waveform-classify",
    name=Text("Classes of flights", "航空計測の分類"),
    explanation=Text(
        "Gives every return of a flight one of six classes with a confidence: ground (2), "
        "vegetation (5), buildings (6), roads (11), wires (14), towers (15). Waveforms are used "
        "where there are any, else points and their intensity alone.",
        "航空レーザの各点に6クラスと信頼度を付けます。地面（2）、植生（5）、建物（6）、道路（11）、"
        "電線（14）、鉄塔（15）。波形があれば使用し、なければ点と反射強度のみから分類します。",
    ),
    group=Text("Waveforms", "波形"),
    needs=Needs.POINTS,
    parameters=WaveformClassifyParameters,
    method=Together(
        mark_six_classes,
        outputs=(
            OutputColumn("classification", "uint8", 1, Text("Class", "クラス")),
            OutputColumn("confidence", "float32", 1, Text("Confidence", "信頼度")),
        ),
    ),
    gives_classes=(1, *sorted(SIX)),
    scorer=SIX_CLASS_SCORER,
)
