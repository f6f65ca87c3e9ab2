"""Width lines: how wide a road is, drawn across it at its stations and where that changes.

Carriageway and footways have lines of their own, square to the centre line.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping, Sequence

import numpy as np

from processing.map.catalogue import Catalogue, Geometry
from processing.map.change import Change
from processing.map.feature import (
    AttributeValue,
    Feature,
    Provenance,
    Vertex,
    new_feature_id,
)
from processing.map.routes.road_widths import StationedRoute, WidthLines, accepted_with_kinds
from processing.map.routes.route import routes_of, station_words
from processing.map.routes.route_summary import stretches_of

WIDTH_KIND = "width_line"

SIDES = ("left", "right")

_MADE = "made_along"
"""Parameter of what was drawn here, so that it can be drawn anew."""

_LEAST_M = 0.05  # narrower is no footway
_NEAR_M = 2.0
"""A change of width nearer to a station is shown by its line."""


def width_lines(features: Sequence[Feature], catalogue: Catalogue, pitch_m: float) -> Change:
    """Draw the widths of all routes; lines that this drew before are replaced.

    Parameters
    ----------
    features : sequence of Feature
        The whole map; accepted ones count.
    pitch_m : float
        From station to station.

    Returns
    -------
    Change
        Empty where there is no route, no width, or the catalogue has no such kind.
    """
    if WIDTH_KIND not in catalogue:
        return Change()
    accepted = accepted_with_kinds(features, catalogue)
    across = WidthLines(accepted)
    before = tuple(
        one for one in features if one.kind == WIDTH_KIND and _MADE in one.provenance.parameters
    )
    made = Provenance(parameters={_MADE: pitch_m})
    drawn: list[Feature] = []
    for route in routes_of(features, catalogue):
        line = StationedRoute.of(route, pitch_m)
        for station in _stations(line, across):
            drawn += _across(line, station, across, made)
    return Change(added=tuple(drawn), removed=before if drawn else ())


def _stations(line: StationedRoute, across: WidthLines) -> list[float]:
    """Those of the pitch, and where the width has changed."""
    stations = list(line.stations)
    for one in stretches_of(StationedRoute.of(line.route, 1.0), across):
        if min((abs(one.start_m - each) for each in stations), default=math.inf) >= _NEAR_M:
            stations.append(one.start_m)
    return sorted(stations)


def _across(
    line: StationedRoute, station_m: float, across: WidthLines, made: Provenance
) -> Iterator[Feature]:
    """The lines at a station, from left to right as one looks along the route."""
    widths, median = across.widths(line, station_m), across.median_ends(line, station_m)
    height = line.height_at(station_m)
    rays = [line.ray(station_m, is_left=is_left) for is_left in (True, False)]

    def place(side: int, off_m: float) -> Vertex:
        foot, end = rays[side]
        x, y = (foot + (end - foot) * (off_m / np.hypot(*(end - foot)))).tolist()
        return Vertex((x, y, height))

    own = {"route": line.route.name, "note": station_words(station_m)}
    begins = [sum(pair) for pair in zip(median, widths.carriageway, strict=True)]
    if any(median):
        for side, name in enumerate(SIDES):
            ends = (place(side, median[side]), place(side, begins[side]))
            yield from _line(ends, widths.carriageway[side], {**own, "side": name}, made)
    else:
        ends = (place(0, begins[0]), place(1, begins[1]))
        yield from _line(ends, widths.carriageway_m, {**own, "side": "middle"}, made)
    for side, name in enumerate(SIDES):
        width = widths.footway[side]
        ends = (place(side, begins[side]), place(side, begins[side] + width))
        yield from _line(ends, width, {**own, "side": name}, made)


def _line(
    ends: tuple[Vertex, Vertex],
    width_m: float,
    own: Mapping[str, AttributeValue],
    made: Provenance,
) -> Iterator[Feature]:
    """A line, unless its width isn't known or nothing."""
    if math.isnan(width_m) or width_m < _LEAST_M:
        return
    told = {"name": f"{width_m:.1f}", "width_m": round(width_m, 2), **own}
    yield Feature(new_feature_id(), WIDTH_KIND, Geometry.LINE, ends, told, provenance=made)
