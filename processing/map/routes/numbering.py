"""What ledgers ask about places along a route: number, route, station, side."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace

from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.change import Change, Replacement
from processing.map.feature import AttributeValue, Feature, Position, Status
from processing.map.routes.route import (
    CENTRE_LINE_CODE,
    Route,
    RoutePosition,
    routes_of,
    station_words,
)

REACH_M = 100.0
"""What lies farther from every centre line belongs to none: wider than any road with its verges."""

NUMBER, ROUTE = "number", "route"


@dataclass(frozen=True)
class _Placed:
    """A feature of a ledger, and where it begins and ends along its route."""

    feature: Feature
    route: int
    first: RoutePosition
    last: RoutePosition


def number_along_routes(features: Sequence[Feature], catalogue: Catalogue) -> Change:
    """Fill in what accepted features of ledgers don't say yet; what is written stays.

    Numbers go on after the highest of the kind, in the order of routes and stations, so that what
    was handed in keeps its number when more is added. Kinds are those that ask for a route.

    Parameters
    ----------
    features : sequence of Feature
        The whole map, its centre lines among them.

    Returns
    -------
    Change
        Empty where there is no centre line, or nothing to fill in.
    """
    routes = routes_of(features, catalogue)
    if not routes:
        return Change()
    replaced: list[Replacement] = []
    for kind in catalogue:
        is_asked = kind.attribute(ROUTE) is not None and kind.attribute(NUMBER) is not None
        if not is_asked or kind.dm_code == CENTRE_LINE_CODE:  # a line's number is the route's
            continue
        members = [one for one in features if one.kind == kind.id and one.status is Status.ACCEPTED]
        replaced.extend(_numbered(members, kind, routes))
    return Change(replaced=tuple(replaced))


def _numbered(
    members: Sequence[Feature], kind: FeatureKind, routes: Sequence[Route]
) -> Iterator[Replacement]:
    placed = sorted(
        (one for feature in members if (one := _placed(feature, routes)) is not None),
        key=lambda one: (one.route, one.first.station_m, one.feature.id),
    )
    written = (_as_number(feature.attributes.get(NUMBER)) for feature in members)
    highest = max((number for number in written if number is not None), default=0)
    for one in placed:
        values = _values(one, routes[one.route])
        if one.feature.attributes.get(NUMBER) in (None, ""):
            highest += 1
            values[NUMBER] = str(highest)
        filled = _filled(one.feature, kind, values)
        if filled != one.feature:
            yield Replacement(one.feature, filled)


def _placed(feature: Feature, routes: Sequence[Route]) -> _Placed | None:
    """Where a feature is along the route nearest to it; None where all are too far."""
    found = [route.position(_middle(feature)) for route in routes]
    nearest = min(range(len(routes)), key=lambda number: found[number][1])
    if found[nearest][1] > REACH_M:
        return None
    if feature.geometry is Geometry.POINT:
        return _Placed(feature, nearest, found[nearest][0], found[nearest][0])
    along = [routes[nearest].position(vertex.xyz)[0] for vertex in feature.vertices]
    first = min(along, key=lambda one: one.station_m)
    last = max(along, key=lambda one: one.station_m)
    return _Placed(feature, nearest, first, last)


def _middle(feature: Feature) -> Position:
    return feature.vertices[len(feature.vertices) // 2].xyz


def _values(placed: _Placed, route: Route) -> dict[str, AttributeValue]:
    """What the route says about a feature, by attribute."""
    offset_m = (placed.first.offset_m + placed.last.offset_m) / 2
    side = RoutePosition(placed.first.station_m, offset_m).side
    values: dict[str, AttributeValue] = {
        "station": station_words(placed.first.station_m),
        "start_station": station_words(placed.first.station_m),
        "end_station": station_words(placed.last.station_m),
        "side": side,
    }
    if route.name:
        values[ROUTE] = route.name
    return values


def _filled(feature: Feature, kind: FeatureKind, values: Mapping[str, AttributeValue]) -> Feature:
    """A feature that says what its kind asks for and it didn't say."""
    new = {
        id_: value
        for id_, value in values.items()
        if kind.attribute(id_) is not None and feature.attributes.get(id_) in (None, "")
    }
    return replace(feature, attributes={**feature.attributes, **new}) if new else feature


def _as_number(value: AttributeValue) -> int | None:
    """The number at the end of what is written: 12 of ``街-12``; None where there is none."""
    words = "" if value is None else str(value)
    digits = words[len(words.rstrip("0123456789")) :]
    return int(digits) if digits else None
