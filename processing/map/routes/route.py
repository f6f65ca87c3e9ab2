"""Route: a road's centre line, along which stations are counted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from processing.core.arrays import Floats
from processing.map.catalogue import Catalogue
from processing.map.drafting.plan_sides import cross, nearest_fractions
from processing.map.drafting.polyline import Polyline
from processing.map.feature import Feature, Position, Status

CENTRE_LINE_CODE = "2505"
"""Code of a road's centre line (公共測量標準図式, 応用測量)."""

START_FIELD = "start_m"
"""Attribute of a centre line: the station at its first vertex, m; 0 where it is not given."""

PITCH_M = 20.0
"""From one numbered station to the next (測点), as centre lines of roads are staked out."""

ON_THE_LINE_M = 0.5
"""Nearer to the centre line a thing stands in the middle: half the width of a narrow median."""

Side = Literal["left", "right", "middle"]


@dataclass(frozen=True)
class RoutePosition:
    """Where something is along a route.

    Attributes
    ----------
    station_m : float
        From the route's origin, along the centre line in plan.
    offset_m : float
        Across it, positive to the left, looking along the line.
    """

    station_m: float
    offset_m: float

    @property
    def side(self) -> Side:
        """Left or right of the centre line, or on it."""
        if abs(self.offset_m) < ON_THE_LINE_M:
            return "middle"
        return "left" if self.offset_m > 0 else "right"


@dataclass(frozen=True)
class Route:
    """A road's centre line.

    Attributes
    ----------
    name : str
        As ledgers call the route; empty where the line doesn't say it.
    start_m : float
        The station at the line's first vertex.
    line : Polyline
        From the route's origin to its end.
    """

    name: str
    start_m: float
    line: Polyline

    @staticmethod
    def of(feature: Feature) -> Route:
        """The route that a centre line is."""
        words = (feature.attributes.get(id_) for id_ in ("route", "name", "number"))
        name = next((str(one) for one in words if one not in (None, "")), "")
        start = feature.attributes.get(START_FIELD)
        start_m = float(start) if isinstance(start, (int, float)) else 0.0
        return Route(name, start_m, Polyline.of([vertex.xyz for vertex in feature.vertices]))

    def position(self, place: Position) -> tuple[RoutePosition, float]:
        """Where the foot of a place on the centre line is, and how far the place lies from it, m.

        Beyond an end the distance is to the end, larger than the offset across.
        """
        sides = self.line.plan_sides
        local = self.line.local(place)[:2]
        fractions, distances = nearest_fractions(sides, local)
        side = int(np.argmin(distances))
        along: Floats = sides[side, 1] - sides[side, 0]
        length = float(np.hypot(*along))
        station = self.start_m + self.line.plan_distances[side] + fractions[side] * length
        turn = float(cross(along, local - sides[side, 0])) / length if length else 0.0
        return RoutePosition(float(station), turn), float(distances[side])


def routes_of(features: Sequence[Feature], catalogue: Catalogue) -> tuple[Route, ...]:
    """The routes of a map: its accepted centre lines, in their order."""
    return tuple(
        Route.of(one)
        for one in features
        if one.status is Status.ACCEPTED
        and one.kind in catalogue
        and catalogue[one.kind].dm_code == CENTRE_LINE_CODE
        and len(one.vertices) > 1
    )


def station_words(station_m: float) -> str:
    """A station as it is written: ``No.6+3.25``; before the origin ``No.-1+16.75``."""
    hundredths = round(station_m * 100)
    number, rest = divmod(hundredths, round(PITCH_M * 100))
    return f"No.{number}+{rest / 100:.2f}"
