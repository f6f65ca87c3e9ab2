"""The tool NOISE: which points no surface gave, by the two methods of the study or by all facts."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import report_as_user_error
from processing.core.monitor import Monitor, PartMonitor
from processing.core.owned_files import remove_folder
from processing.core.parameters import ParameterChoice, choice, count, length, ratio
from processing.core.scratch_arrays import scratch_array
from processing.core.text import Text
from processing.methods.noise.drive_noise import NoiseSearch
from processing.methods.noise.noise_codes import HIGH_NOISE, LOW_NOISE
from processing.recording.columns.columns import ColumnWriter
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.drive import Drive
from processing.scoring.points.asked_classes import NOISE_ASKED
from processing.scoring.scorers import NOISE_SCORER
from processing.tools.tool import FinishedColumns, Needs, OutputColumn, PerDrive, Tool

_CLASS = "classification"
_FINDING = 0.95

COMBINED, RADIUS, STATISTICAL = "combined", "radius", "statistical"


@dataclass(frozen=True)
class NoiseParameters:
    """How noise is separated from what was measured; no value needs to be set."""

    method: str = choice(
        COMBINED,
        choices=(
            ParameterChoice(COMBINED, Text("Combined", "複合判定")),
            ParameterChoice(RADIUS, Text("Radius (ROR)", "半径法（ROR）")),
            ParameterChoice(STATISTICAL, Text("Statistical (SOR)", "統計法（SOR）")),
        ),
        name=Text("Method", "方法"),
        explanation=Text(
            "Combined looks at beams, neighbours in the image, density and connection, and keeps "
            "wires and poles. The other two are the usual ones and need values that fit the "
            "density of the points.",
            "「複合判定」はレーザの向き、画像上の隣接点、密度、つながりを総合し、電線や柱を残します。"
            "ほかの2つは一般的な方法で、点密度に合った値の設定が必要です。",
        ),
    )
    strictness: float = ratio(
        0.5,
        low=0.0,
        high=1.0,
        name=Text("Strictness (combined)", "厳しさ（複合判定）"),
        explanation=Text(
            "The higher, the more is called noise. At 0.5 a point is noise when that is likelier "
            "than not.",
            "大きいほど多くの点をノイズとします。0.5では、ノイズの可能性が高い点だけをノイズとします。",
        ),
    )
    radius_m: float = length(
        0.5,
        low=0.01,
        high=10.0,
        name=Text("Radius (ROR)", "半径（ROR）"),
        explanation=Text(
            "How far around a point others are counted.", "各点の周囲で点を数える範囲です。"
        ),
    )
    neighbours: int = count(
        113,
        low=1,
        high=2000,
        name=Text("Neighbours (ROR, SOR)", "近傍点数（ROR・SOR）"),
        explanation=Text(
            "Radius: noise has at most so many points within the radius, itself counted. "
            "Statistical: so many nearest points are measured, itself among them.",
            "半径法では、半径内の点数（自身を含む）がこの数以下の点をノイズとします。"
            "統計法では、自身を含む近い順にこの数の点までの距離を使います。",
        ),
    )
    deviations: float = ratio(
        1.5,
        low=0.0,
        high=20.0,
        name=Text("Standard deviations (SOR)", "標準偏差の倍数（SOR）"),
        explanation=Text(
            "Noise has a mean distance to its neighbours that exceeds the mean of all points by "
            "so many standard deviations.",
            "近傍点までの平均距離が、全点の平均よりも標準偏差のこの倍数を超えて大きい点をノイズとします。",
        ),
    )


def mark_noise(
    drive: Drive, parameters: NoiseParameters, into: Path, points_at_once: int, monitor: Monitor
) -> FinishedColumns:
    """Classes with noise: 7 below the ground, 18 elsewhere; every other point keeps its class.

    Parameters
    ----------
    into : Path
        Where the column ``classification`` comes to lie.
    points_at_once : int
        What the methods of the study hold in memory; the result doesn't depend on it.

    Raises
    ------
    NoSpace
        The disk can't hold the column and some 20 bytes a point meanwhile.
    """
    scratch = into / "scratch"
    with report_as_user_error(into):
        scratch.mkdir()
        codes = scratch_array(scratch / "codes", np.uint8, drive.count)
        search = NoiseSearch(drive, codes, scratch, points_at_once)
        finding = PartMonitor(monitor, 0.0, _FINDING)
        if drive.count == 0:
            pass
        elif parameters.method == RADIUS:
            search.by_radius(parameters.radius_m, parameters.neighbours, finding)
        elif parameters.method == STATISTICAL:
            search.by_statistics(parameters.neighbours, parameters.deviations, finding)
        else:
            search.combined(parameters.strictness, finding)
        _write_classes(drive, search.codes, into, monitor)
        remove_folder(scratch)
    return FinishedColumns(into, (_CLASS,), drive.count)


def _write_classes(drive: Drive, codes: NDArray[np.uint8], into: Path, monitor: Monitor) -> None:
    with ColumnWriter(into) as writer:
        writer.append({_CLASS: np.empty(0, np.uint8)})
        for start, stop in chunk_ranges(drive.count):
            monitor.check()
            found = np.asarray(codes[start:stop])
            if drive.columns.has(_CLASS):
                delivered = read_chunk(drive.folder, _CLASS, start, stop)
                found = np.where(found > 0, found, delivered)
            writer.append({_CLASS: found})


NOISE = Tool(
    id="noise",
    name=Text("Noise", "ノイズ除去"),
    explanation=Text(
        "Classifies points that no surface gave: 7 below the ground, 18 elsewhere. No point is "
        "deleted, and all others keep their class.",
        "実在の面を計測していない点を分類します（地面より下は7、それ以外は18）。"
        "点は削除せず、ほかの点のクラスは変更しません。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.POINTS,
    parameters=NoiseParameters,
    method=PerDrive(
        mark_noise, outputs=(OutputColumn(_CLASS, "uint8", 1, Text("Class", "クラス")),)
    ),
    version=2,
    gives_classes=(LOW_NOISE, HIGH_NOISE),
    scorer=NOISE_SCORER,
    asked=NOISE_ASKED,
)
