"""The 102 numbers that the thesis describes a point by: their names, formulas and sources.

Fourteen of a sphere at five sizes, four of a disc at four sizes, four of a cell of a grid and six
of mobile mapping are named in Takahashi 2022, sections 4.4 and 4.5: 96. The thesis counts 102 and
doesn't name the other six. Here they are what it computes on the way to the best radius: the
entropy of equation 4-12 at each of the five sizes, and the number of neighbours at which it is
least. The radius there needs no column more, since it is the fourteenth of that size (4-9).

Two of the 102, height and intensity, are delivered with the points; the others are columns.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass

from processing.core.text import Text

SCALES_M: Mapping[str, float] = {"5m": 5.0, "3m": 3.0, "2m": 2.0, "1m": 1.0}
"""Radii of spheres and discs (section 4.4.1)."""

BEST = "best"
"""The fifth size of spheres: the number of neighbours, 10 to 1000, whose entropy (4-12) is least.
"""

SPHERE_FEATURES = (
    ("linearity", Text("Linearity", "直線性"), "(λ1 − λ2) / λ1", "4-1"),
    ("planarity", Text("Planarity", "平面性"), "(λ2 − λ3) / λ1", "4-2"),
    ("scattering", Text("Scattering", "散乱性"), "λ3 / λ1", "4-3"),
    ("omnivariance", Text("Omnivariance", "全方性"), "(λ1 λ2 λ3)^(1/3), m²", "4-4"),
    ("anisotropy", Text("Anisotropy", "異方性"), "(λ1 − λ3) / λ1", "4-5"),
    ("eigenentropy", Text("Eigenentropy", "固有性"), "−Σ λi ln λi, λ in m²", "4-6"),
    ("eigenvalue_sum", Text("Sum of eigenvalues", "固有値の合計"), "λ1 + λ2 + λ3, m²", "4-7"),
    ("curvature_change", Text("Change of curvature", "曲率の変化"), "λ3 / (λ1 + λ2 + λ3)", "4-8"),
    ("radius", Text("Radius", "近傍半径"), "r = max |vk − v|, m", "4-9"),
    ("density", Text("Density", "点群密度"), "(k + 1) / (4/3 π r³), 1/m³", "4-10"),
    ("verticality", Text("Verticality", "垂直度"), "1 − |nz|", "4-11"),
    ("mean_height", Text("Mean height", "Z座標の平均"), "mean z, m", "4.4.1 (4)"),
    ("height_range", Text("Range of heights", "Z座標の最大差"), "max z − min z, m", "4.4.1 (5)"),
    ("height_deviation", Text("Deviation of heights", "Z座標の標準偏差"), "σ(z), m", "4.4.1 (6)"),
    ("entropy", Text("Entropy", "エントロピー"), "−L ln L − P ln P − S ln S", "4-12"),
)
"""Name, title, formula and place in the thesis of what a sphere holds; λ1 ≥ λ2 ≥ λ3 are the
eigenvalues of the covariance of the point and its k neighbours, n the direction of the least.
Verticality is printed 1 − nz, which would change with the sign of a normal that has none."""

DISC_FEATURES = (
    ("plan_eigenvalue_sum", Text("Sum of eigenvalues", "固有値の合計"), "λ1 + λ2, m²", "4-13"),
    ("plan_eigenvalue_ratio", Text("Ratio of eigenvalues", "固有値比"), "λ2 / λ1", "4-14"),
    ("plan_radius", Text("Radius", "近傍半径"), "r = max |vk − v|, m", "4-15"),
    ("plan_density", Text("Density", "点群密度"), "(k + 1) / (2 π r²), 1/m²", "4-16"),
)
"""The same of a disc seen from above; 2 π r² as printed, twice the area of the disc."""

CELL_FEATURES = (
    ("cell_points", Text("Points", "点群数"), "k", "4.4.3 (1)"),
    ("cell_height_range", Text("Range of heights", "Z座標の最大差"), "max z − min z, m",
     "4.4.3 (2)"),
    ("cell_height_deviation", Text("Deviation of heights", "Z座標の標準偏差"), "σ(z), m",
     "4.4.3 (3)"),
    ("cell_height", Text("Height over the lowest", "地面からの相対Z座標"), "z − min z, m",
     "4.4.3 (4)"),
)  # fmt: skip
"""Of the square of 25 cm, seen from above, that a point lies in."""

PATH_FEATURES = (
    ("path_height", Text("Height over the trajectory", "軌跡相対高さ"),
     "z − z of the nearest place of the trajectory, m", "4.5"),
    ("path_distance", Text("Distance from the trajectory", "軌跡相対距離"),
     "distance in plan to the nearest place of the trajectory, m", "4.5"),
)  # fmt: skip
"""Of the trajectory within 30 s of the point's time."""

LINE_FEATURES = (
    ("scan_line_length", Text("Scan-line length", "スキャンライン長"),
     "Σ |v(i+1) − v(i)| of points no more than 0.3 m apart, m", "4.5"),
    ("scan_line_curvature", Text("Scan-line curvature", "スキャンライン曲率"),
     "D / L: L from the first to the last of these points, D farthest from that line", "4.5"),
)  # fmt: skip
"""Of the stretch of a scan line that a point lies on."""

DELIVERED_FEATURES = ("height", "intensity")
"""The two that come with the points (section 4.5); `height` is the third number of ``xyz``."""


@dataclass(frozen=True)
class PointFeature:
    """One of the columns.

    Attributes
    ----------
    id : str
        Of the column, in files and as an image attribute.
    group : str
        `sphere_…` and `disc_…` with a size, `cell`, `path` or `line`: what it is computed with.
    place : int
        Its place in the group.
    formula : str
        With its unit.
    source : str
        Equation or section of Takahashi 2022.
    """

    id: str
    title: Text
    group: str
    place: int
    formula: str
    source: str


NEIGHBOURS_BEST = "neighbours_best"

_IN_PLAN = Text("{title} in plan, {scale}", "2次元 {title} {scale}")
_IN_CELL = Text("{title} in the cell", "グリッド {title}")
_IN_SPHERE = Text("{title}, {scale}", "{title} {scale}")
_SCALES = {name: Text.same(name.replace("m", " m")) for name in SCALES_M} | {
    BEST: Text("best radius", "最適半径")
}


def _columns() -> Iterator[PointFeature]:
    for scale in (*SCALES_M, BEST):
        for place, (id_, title, formula, source) in enumerate(SPHERE_FEATURES):
            words = _IN_SPHERE.filled(title=title, scale=_SCALES[scale])
            name = f"{id_}_{scale}"
            yield PointFeature(name, words, f"sphere_{scale}", place, formula, source)
    words = Text("Neighbours, best radius", "近傍点数 最適半径")
    yield PointFeature(
        NEIGHBOURS_BEST, words, f"sphere_{BEST}", len(SPHERE_FEATURES), "k of least 4-12", "4.4.1"
    )
    for scale in SCALES_M:
        for place, (id_, title, formula, source) in enumerate(DISC_FEATURES):
            words = _IN_PLAN.filled(title=title, scale=_SCALES[scale])
            yield PointFeature(f"{id_}_{scale}", words, f"disc_{scale}", place, formula, source)
    for place, (id_, title, formula, source) in enumerate(CELL_FEATURES):
        words = _IN_CELL.filled(title=title)
        yield PointFeature(id_, words, "cell", place, formula, source)
    for group, listed in (("path", PATH_FEATURES), ("line", LINE_FEATURES)):
        for place, (id_, title, formula, source) in enumerate(listed):
            yield PointFeature(id_, title, group, place, formula, source)


POINT_FEATURES: Mapping[str, PointFeature] = {column.id: column for column in _columns()}
"""By name, a hundred."""

SELECTED = (
    "path_height",
    "path_distance",
    "cell_height_range",
    "scan_line_length",
    "cell_height_deviation",
    "cell_height",
    "verticality_2m",
    "height_range_5m",
    "scan_line_curvature",
    "verticality_5m",
    "height_deviation_5m",
    "height_range_1m",
    "height_range_3m",
    "verticality_3m",
    "verticality_1m",
)
"""Those of at least 1.5 % of a forest's importance (table 4-1), without height and intensity."""
