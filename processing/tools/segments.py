"""The tool SEGMENTS: points that hang together get one number."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor
from processing.core.parameters import angle, length, ratio
from processing.core.text import Text
from processing.image.neighbourhoods.segments import OVERLAP_ROWS, JoinLimits, connected_segments
from processing.tools.tool import Needs, OutputColumn, PerPoint, PointBlock, PointResult, Tool


@dataclass(frozen=True)
class SegmentsParameters:
    """When two neighbouring points of the image belong to the same thing."""

    distance_m: float = length(
        0.3,
        low=0.01,
        high=5.0,
        name=Text("Joining distance", "結合距離"),
        explanation=Text(
            "Neighbouring points nearer than this are joined.",
            "これより近い隣り合う点を結合します。",
        ),
    )
    spacing_ratio: float = ratio(
        2.0,
        low=1.0,
        high=10.0,
        name=Text("Spacing ratio", "点間隔に対する倍率"),
        explanation=Text(
            "Where points lie far apart, neighbours are joined up to so many times the usual "
            "spacing there.",
            "点間隔が広い場所では、その場所の通常の間隔のこの倍数まで結合します。",
        ),
    )
    farthest_m: float = length(
        1.0,
        low=0.01,
        high=20.0,
        name=Text("Largest distance", "最大距離"),
        explanation=Text(
            "Points farther apart than this are never joined.",
            "これより離れた点は結合しません。",
        ),
    )
    bend_deg: float = angle(
        25.0,
        low=5.0,
        high=180.0,
        name=Text("Largest bend", "最大屈曲角"),
        explanation=Text(
            "A surface ends where the scan line bends by more, as at a curb or the foot of a "
            "wall. At 180° only distances count.",
            "スキャンラインがこれより大きく曲がる所（縁石や壁の下端など）で面を区切ります。"
            "180°では距離だけで判断します。",
        ),
    )


def compute_segments(
    block: PointBlock, parameters: SegmentsParameters, monitor: Monitor
) -> PointResult:
    """Numbers of connected components.

    Returns
    -------
    PointResult
        ``segment``: (n,) int32, numbered by the components' first points.

    Raises
    ------
    OutOfRange
        The largest distance is less than the joining distance.
    """
    if parameters.farthest_m < parameters.distance_m:
        raise OutOfRange(
            Text(
                "The largest distance is less than the joining distance.",
                "最大距離が結合距離より小さくなっています。",
            ),
            Text.same(f"farthest_m={parameters.farthest_m:g}"),
            Text(
                "Use at least {distance:g} m, or a smaller joining distance.",
                "{distance:g} m以上にするか、結合距離を小さくしてください。",
            ).filled(distance=parameters.distance_m),
        )
    limits = JoinLimits(
        parameters.distance_m,
        parameters.spacing_ratio,
        parameters.farthest_m,
        parameters.bend_deg,
    )
    return PointResult({"segment": connected_segments(block.xyz, block.grid, limits, monitor)})


SEGMENTS = Tool(
    id="segments",
    name=Text("Segments", "セグメント分割"),
    explanation=Text(
        "Joins points that are neighbours in the image, near in space and on one surface; each "
        "connected part gets a number of its own.",
        "画像上で隣り合い、空間的にも近く、同じ面にある点を結合し、つながった部分ごとに番号を付けます。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.PIXELS,
    parameters=SegmentsParameters,
    method=PerPoint(
        compute_segments,
        outputs=(OutputColumn("segment", "int32", 1, Text("Segment", "セグメント")),),
        overlap_rows=OVERLAP_ROWS,
    ),
)
