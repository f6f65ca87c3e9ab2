"""Styles of streets: what their widths, curves and furniture are drawn from."""

from __future__ import annotations

from dataclasses import dataclass

from processing.core.errors import name_with_type
from processing.core.text import Text

Range = tuple[float, float]


@dataclass(frozen=True)
class Style:
    """What streets of one style are drawn from; lengths in m.

    Attributes
    ----------
    lanes : tuple of int
        Fewest and most in one direction.
    camber, shoulder_m, lane_m : (float, float)
    least_radius_m : float
        Of curves.
    curve_share : float
        How much of the road is curved.
    most_grade, most_tilt : float
        Rise per metre along and across the road.
    junction_share, median_share : float
        How many sections are junctions; how many streets have a median.
    section_m : (float, float)
        Length of stretches that are alike.
    speed_m_s : (float, float)
        Of the recording vehicle.
    """

    id: str
    name: Text
    lanes: tuple[int, int]
    lane_m: Range
    shoulder_m: Range
    camber: Range
    least_radius_m: float
    curve_share: float
    most_grade: float
    most_tilt: float
    junction_share: float
    median_share: float
    section_m: Range
    speed_m_s: Range


# Lane widths, cross falls, least radii, grades and super-elevation lie within the Road Structure
# Ordinance (道路構造令, 1970, articles 5, 12 to 20, 24), classes 1, 3 and 4.
URBAN = Style(
    "urban",
    Text("Street in a town", "市街地の道路"),
    lanes=(1, 2),
    lane_m=(2.75, 3.5),
    shoulder_m=(0.25, 0.75),
    camber=(0.012, 0.02),
    least_radius_m=60.0,
    curve_share=0.4,
    most_grade=0.04,
    most_tilt=0.02,
    junction_share=0.22,
    median_share=0.15,
    section_m=(18.0, 60.0),
    speed_m_s=(6.0, 12.0),
)
RURAL = Style(
    "rural",
    Text("Country road", "郊外・山間の道路"),
    lanes=(1, 1),
    lane_m=(2.2, 3.25),
    shoulder_m=(0.2, 0.75),
    camber=(0.012, 0.02),
    least_radius_m=30.0,
    curve_share=0.65,
    most_grade=0.08,
    most_tilt=0.06,
    junction_share=0.08,
    median_share=0.0,
    section_m=(25.0, 80.0),
    speed_m_s=(7.0, 14.0),
)
HIGHWAY = Style(
    "highway",
    Text("Expressway or bypass", "自動車専用道路・バイパス"),
    lanes=(2, 2),
    lane_m=(3.5, 3.75),
    shoulder_m=(1.25, 2.5),
    camber=(0.02, 0.025),
    least_radius_m=300.0,
    curve_share=0.6,
    most_grade=0.05,
    most_tilt=0.06,
    junction_share=0.0,
    median_share=1.0,
    section_m=(40.0, 120.0),
    speed_m_s=(16.0, 26.0),
)
STYLES = {one.id: one for one in (URBAN, RURAL, HIGHWAY)}


def style_of(name: str) -> Style:
    """The style of a name.

    Raises
    ------
    OutOfRange
        There is none; names those there are.
    """
    return name_with_type(
        STYLES, name, Text("There is no such style of street.", "この道路種別はありません。")
    )
