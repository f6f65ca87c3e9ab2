"""The tool GROUND: which points are ground, how high all others stand, and the surface itself."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.parameters import ParameterChoice, angle, choice, file, length, ratio, switch
from processing.core.text import Text
from processing.core.worked_ahead import in_order
from processing.methods.ground.drive_ground import adaptive_ground
from processing.methods.ground.drive_points import DrivePoints
from processing.methods.ground.drive_references import lowest_ground_of, published_ground_of
from processing.methods.ground.filters.adaptive import GroundAssumptions
from processing.methods.ground.filters.published_method import PublishedSteps
from processing.methods.ground.ground_columns import CLASS, GROUND, HEIGHT, OTHER
from processing.methods.ground.stored_surface import FILE_NAME
from processing.methods.noise.beams.behind_surfaces import echoes_of
from processing.methods.waveforms.pulse_ringing import ringing_returns
from processing.methods.waveforms.return_measures import broad_returns
from processing.recording.drive import Drive
from processing.scoring.points.asked_classes import GROUND_ASKED
from processing.scoring.scorers import GROUND_SCORER
from processing.tools.tool import (
    FinishedColumns,
    Needs,
    OutputColumn,
    Together,
    TogetherResult,
    Tool,
)

ADAPTIVE, PUBLISHED, LOWEST = "adaptive", "published", "lowest"
_PAPER_GRID_M = 3.0
_SMALLEST_GRID_M = 0.1
_UNTIL_NONE = 1000
_ECHOES = Text("Looking for echoes", "多重反射の点を探しています")
_CELLS = Text("cells of {size:.2f} m", "格子{size:.2f}m")


@dataclass(frozen=True)
class GroundParameters:
    """How ground is separated from what stands on it; no value needs to be set."""

    method: str = choice(
        ADAPTIVE,
        choices=(
            ParameterChoice(ADAPTIVE, Text("Adaptive", "自動調整")),
            ParameterChoice(PUBLISHED, Text("Published (triangles)", "論文の方法（三角網）")),
            ParameterChoice(LOWEST, Text("Lowest points", "最下点")),
        ),
        name=Text("Method", "方法"),
        explanation=Text(
            "Adaptive chooses its cells by the density of the points, keeps slopes and "
            "steps, and removes walls, machines, plants and buildings of any size. The other two "
            "are there to compare with.",
            "「自動調整」は点密度から格子を決め、法面・段差を残し、擁壁・建設機械・草木・建物を"
            "大きさによらず除きます。ほかの2つは比較用です。",
        ),
    )
    grid_m: float = length(
        0.0,
        low=0.0,
        high=50.0,
        name=Text("Grid", "格子間隔"),
        explanation=Text(
            "Side of a cell. 0 lets the data choose it; for the published method and the lowest "
            "points 0 is 3 m, as in the paper: about 1.5 times the width of a machine.",
            "格子の一辺の長さです。0では点群から自動で決まります。「論文の方法」と「最下点」では、"
            "0は論文と同じ3m（取り除く機械の幅の約1.5倍）です。",
        ),
        zero=Text("Automatic", "自動"),
    )
    steep_deg: float = angle(
        80.0,
        low=10.0,
        high=90.0,
        name=Text("Steep from (published)", "急傾斜とする角度（論文）"),
        explanation=Text(
            "A triangle this steep or steeper loses its highest corner.",
            "傾きがこの角度以上の三角形から、最も高い頂点を取り除きます。",
        ),
    )
    slope_from_deg: float = angle(
        4.0,
        low=0.0,
        high=90.0,
        name=Text("Slope from (published)", "斜面とする角度（論文）"),
        explanation=Text(
            "Triangles from here up to steep are slopes and are divided by the fine grid.",
            "傾きがこの角度から急傾斜までの三角形を斜面とし、細かい格子で分割します。",
        ),
    )
    fine_grid_m: float = length(
        0.0,
        low=0.0,
        high=50.0,
        name=Text("Fine grid (published)", "細分割の格子間隔（論文）"),
        explanation=Text(
            "Divides slopes. 0 is a fifth of the grid; the paper doesn't say it.",
            "斜面を分割する格子の間隔です。0では格子間隔の5分の1とします（論文に記載なし）。",
        ),
    )
    distance_m: float = length(
        0.3,
        low=0.001,
        high=5.0,
        name=Text("Distance (published)", "鉛直距離（論文）"),
        explanation=Text(
            "A point no farther above or below the triangles is ground.",
            "三角網からの鉛直距離がこの値以下の点を地面とします。",
        ),
    )
    until_none_is_steep: bool = switch(
        default=False,
        name=Text("Until none is steep (published)", "急傾斜がなくなるまで（論文）"),
        explanation=Text(
            "Repeat the removal of corners; the paper does it once.",
            "頂点の除去を繰り返します。論文では1回だけ行います。",
        ),
    )
    tolerance_m: float = length(
        0.0,
        low=0.0,
        high=5.0,
        name=Text("Tolerance (lowest)", "許容高さ（最下点）"),
        explanation=Text(
            "Points so little above the lowest one of their cell are ground too. 0 keeps one "
            "point in each cell.",
            "格子内の最下点からこの高さまでの点も地面とします。0では各格子に1点だけ残します。",
        ),
    )
    widest_echo: float = ratio(
        0.0,
        low=0.0,
        high=20.0,
        name=Text("Widest echo (adaptive)", "エコー幅の上限（自動調整）"),
        explanation=Text(
            "Of flights with waveforms: returns whose echo is wider than so many of the "
            "recording's narrowest ones are no ground, as of low plants. 0 asks no widths.",
            "波形付きの航空計測で、エコー幅がデータ中の最も狭いエコーのこの倍数を超える点を、"
            "低い植生などとして地面から除きます。0では幅を使いません。",
        ),
    )
    surface: str = file(
        name=Text("Surface file (adaptive)", "地表面ファイル（自動調整）"),
        explanation=Text(
            "A GeoTIFF (.tif) for the surface: heights in band 1, and in band 2 a 1 where the "
            "height is filled in and not measured. Empty writes none.",
            "地表面を書き出すGeoTIFF（.tif）です。バンド1は標高、バンド2は補間した場所が1、"
            "計測した場所が0です。空欄では書き出しません。",
        ),
    )


def mark_ground(
    drives: tuple[Drive, ...],
    parameters: GroundParameters,
    into: Path,
    points_at_once: int,
    monitor: Monitor,
) -> TogetherResult:
    """Classes and heights above ground, from all drives recorded together.

    Parameters
    ----------
    drives : tuple of Drive
        Recorded together.
    into : Path
        Gets the columns of the first drive, and folders for the others.

    Raises
    ------
    OutOfRange
        Too few points; parameters that don't fit together.
    NoSpace, Cancelled
    """
    _check(parameters)
    folders = [into / str(number) if number else into for number in range(len(drives))]
    with report_as_user_error(into):
        for folder in folders[1:]:
            folder.mkdir()
    echoes = _echoes(drives, parameters, monitor) if parameters.method == ADAPTIVE else ()
    points = DrivePoints(drives, points_at_once, monitor, echoes)
    grid_m = parameters.grid_m or _PAPER_GRID_M
    kept: tuple[Path, ...] = ()
    if parameters.method == ADAPTIVE:
        habits = GroundAssumptions(grid_m=parameters.grid_m)
        kept = (into / FILE_NAME,)
        grid_m = adaptive_ground(points, habits, folders, kept[0], monitor).size_m
    elif parameters.method == PUBLISHED:
        steps = PublishedSteps(
            grid_m=grid_m,
            steep_deg=parameters.steep_deg,
            slope_from_deg=parameters.slope_from_deg,
            fine_grid_m=parameters.fine_grid_m,
            distance_m=parameters.distance_m,
            most_removals=_UNTIL_NONE if parameters.until_none_is_steep else 1,
        )
        published_ground_of(points, steps, folders, monitor)
    else:
        lowest_ground_of(points, grid_m, parameters.tolerance_m, folders, monitor)
    columns = tuple(
        FinishedColumns(folder, (CLASS, HEIGHT), drive.count)
        for folder, drive in zip(folders, drives, strict=True)
    )
    return TogetherResult(columns, kept, _CELLS.filled(size=grid_m))


def _echoes(
    drives: tuple[Drive, ...], parameters: GroundParameters, monitor: Monitor
) -> list[NDArray[np.bool_] | None]:
    """What is no ground for sure: points that can't be where they say, and by their waveforms.

    A scanner on a tripod can't have seen some of them; some returns of a flight are the
    receiver's own swing, or too wide.
    """
    monitor.report(0.0, _ECHOES)

    def of(drive: Drive) -> NDArray[np.bool_] | None:
        found = [echoes_of(drive, monitor), ringing_returns(drive, monitor)]
        if parameters.widest_echo > 0.0:
            found.append(broad_returns(drive, parameters.widest_echo, monitor))
        known = [one for one in found if one is not None]
        return np.logical_or.reduce(known) if known else None

    return list(in_order(of, drives))


def _check(parameters: GroundParameters) -> None:
    """Refuse what can't be meant before any work is done.

    Raises
    ------
    OutOfRange
    """
    if 0.0 < parameters.grid_m < _SMALLEST_GRID_M:
        raise OutOfRange(
            Text("The cells would be too small.", "格子が小さすぎます。"),
            Text.same(f"grid_m={parameters.grid_m:g}"),
            Text("Use 0 or at least 0.1 m.", "0か0.1m以上の値を指定してください。"),
        )
    if parameters.surface and parameters.method != ADAPTIVE:
        raise OutOfRange(
            Text(
                "Only the adaptive method gives a surface.",
                "地表面を出力できるのは「自動調整」だけです。",
            ),
            Text.same(f"surface={parameters.surface}"),
            Text(
                "Take the adaptive method, or leave the surface file empty.",
                "「自動調整」を選ぶか、地表面ファイルを空欄にしてください。",
            ),
        )


GROUND_TOOL = Tool(
    id="ground",
    name=Text("Ground", "地面抽出"),
    explanation=Text(
        "Classifies ground (2) and everything else (1); noise (7, 18) keeps its class. All drives "
        "recorded together are looked at as one, so that stations see behind obstacles for each "
        "other. Where nothing was measured the surface is filled in, and marked as filled.",
        "点を地面（2）とそれ以外（1）に分類します。ノイズ（7・18）のクラスはそのままです。"
        "同時に計測した走行データ・器械点はまとめて処理し、死角を互いに補います。"
        "計測されていない場所の地表面は補間し、補間した場所として区別します。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.POINTS,
    parameters=GroundParameters,
    method=Together(
        mark_ground,
        outputs=(
            OutputColumn(CLASS, "uint8", 1, Text("Class", "クラス")),
            OutputColumn(
                HEIGHT, "float32", 1, Text("Height above ground (m)", "地面からの高さ（m）")
            ),
        ),
    ),
    version=4,
    gives_classes=(GROUND, OTHER),
    scorer=GROUND_SCORER,
    asked=GROUND_ASKED,
)
