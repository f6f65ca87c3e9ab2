"""SectionPosition: where on which line a section stands, and the cut that belongs to it."""

from __future__ import annotations

from dataclasses import dataclass, replace

from processing.map.feature import Position
from processing.section.cut import Cut
from processing.section.stations import Stations

LEAST_WIDTH_M, MOST_WIDTH_M = 0.02, 20.0

BEYOND_M = 30.0
"""So far the section can be stepped straight on beyond the ends of a line."""

HALF_LENGTH_M = 15.0
_BESIDE_M = 5.0
_EXACT_M = 1e-4


@dataclass(frozen=True)
class CutLine:
    """A line that sections stand on.

    Attributes
    ----------
    feature : str
        Id of the drawn line; empty for a trajectory.
    drive : str
        Id of the drive whose trajectory it is; empty for other lines.
    stations : Stations
    half_length_m : float
        So far sections across it reach to either side.
    """

    feature: str
    drive: str
    stations: Stations
    half_length_m: float = HALF_LENGTH_M

    @property
    def is_axis(self) -> bool:
        """Whether it is neither drawn nor driven, but leads through the middle of a site."""
        return not self.feature and not self.drive


@dataclass(frozen=True)
class SectionPosition:
    """A place on a line and how thick the slab there is.

    Attributes
    ----------
    line : CutLine
    station_m : float
        From the line's beginning; less than 0 and more than its length beyond its ends.
    width_m : float
    is_along : bool
        Whether the slab lies along the line instead of across it.
    through : Position or None
        A place that the slab goes through, where it isn't the line's own place.
    """

    line: CutLine
    station_m: float
    width_m: float = 1.0
    is_along: bool = False
    through: Position | None = None

    @property
    def cut(self) -> Cut:
        """The slab; long enough to hold the place that it goes through."""
        stations, half_m = self.line.stations, self.line.half_length_m
        make = stations.cut_along if self.is_along else stations.cut_at
        cut = make(self.station_m, self.width_m, half_m)
        if self.through is None:
            return cut
        offset, _, away = cut.to_section([self.through])[0].tolist()
        middle = cut.middle
        if abs(away) > _EXACT_M:
            east, north = cut.normal
            middle = middle[0] + away * east, middle[1] + away * north, middle[2]
        half_m = max(half_m, abs(offset) + _BESIDE_M)
        return replace(cut, middle=middle, half_length_m=half_m)

    @property
    def beyond_m(self) -> float:
        """How far it stands before the line's beginning (negative) or beyond its end; else 0."""
        inside = min(max(self.station_m, 0.0), self.line.stations.length_m)
        return self.station_m - inside

    def stepped(self, metres: float) -> SectionPosition:
        """The same so many metres further along the line, at the line's own place."""
        length_m = self.line.stations.length_m
        low, high = min(-BEYOND_M, self.station_m), max(length_m + BEYOND_M, self.station_m)
        station_m = min(max(self.station_m + metres, low), high)
        return replace(self, station_m=station_m, through=None)

    def turned(self, *, is_along: bool) -> SectionPosition:
        """The slab at the same place along or across the line."""
        return replace(self, is_along=is_along)
