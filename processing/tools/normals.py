"""The tool NORMALS: which way surfaces face, and whether points lie on lines, planes or neither."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.core.monitor import Monitor
from processing.core.parameters import length
from processing.core.text import Text
from processing.image.neighbourhoods.normals import OVERLAP_ROWS, oriented_surface_shapes
from processing.tools.tool import Needs, OutputColumn, PerPoint, PointBlock, PointResult, Tool


@dataclass(frozen=True)
class NormalsParameters:
    """How far around a point its surface is looked at."""

    radius_m: float = length(
        0.2,
        low=0.05,
        high=2.0,
        name=Text("Search radius", "探索半径"),
        explanation=Text(
            "Small keeps edges such as curbs sharp, large evens out noise. Where points lie "
            "farther apart, up to four times as far is searched.",
            "小さいほど縁石などの稜線が鮮明になり、大きいほどノイズがならされます。"
            "点間隔が広い場所では最大4倍まで広げて探索します。",
        ),
    )


def compute_normals(
    block: PointBlock, parameters: NormalsParameters, monitor: Monitor
) -> PointResult:
    """Normals towards the scanner, and shapes.

    Returns
    -------
    PointResult
        ``normal``: (n, 3) int8, unit vector × 127, zero where there is none; ``shape``: (n, 3)
        uint8, linearity, planarity and scattering × 255.
    """
    found = oriented_surface_shapes(
        block.xyz, block.grid, parameters.radius_m, monitor, seen_from=block.seen_from
    )
    return PointResult(
        {
            "normal": np.rint(found.normals * 127).astype(np.int8),
            "shape": np.rint(found.shapes * 255).astype(np.uint8),
        }
    )


NORMALS = Tool(
    id="normals",
    name=Text("Normals and shape", "法線と形状"),
    explanation=Text(
        "Finds for every point which way its surface faces, and whether the points around it form "
        "a line, a plane or neither.",
        "各点について、面の向きと、周囲の点が線状・面状・散乱のどれに近いかを求めます。",
    ),
    group=Text("Points", "点群"),
    needs=Needs.PIXELS,
    parameters=NormalsParameters,
    method=PerPoint(
        compute_normals,
        outputs=(
            OutputColumn("normal", "int8", 3, Text("Normal direction", "法線方向")),
            OutputColumn("shape", "uint8", 3, Text("Shape", "形状")),
        ),
        overlap_rows=OVERLAP_ROWS,
    ),
)
