"""The kinds of what drives and stands in streets, with the most room each takes."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial

from numpy.random import Generator

from processing.laboratory.simulate.traffic.bodies import TrafficBody
from processing.laboratory.simulate.traffic.people_shapes import bicycle, motorcycle, person
from processing.laboratory.simulate.traffic.vehicle_shapes import (
    bus,
    kei_car,
    saloon,
    small_truck,
    truck,
    van,
)


@dataclass(frozen=True)
class MoverKind:
    """Something that drives, walks or stands.

    Attributes
    ----------
    drawn : callable
        Its body, as it moves.
    drawn_at_rest : callable
        Its body where it is parked.
    length_m, width_m : float
        At most, without mirrors.
    """

    name: str
    drawn: Callable[[Generator], TrafficBody]
    drawn_at_rest: Callable[[Generator], TrafficBody]
    length_m: float
    width_m: float


def _alike(
    name: str, drawn: Callable[[Generator], TrafficBody], size: tuple[float, float]
) -> MoverKind:
    return MoverKind(name, drawn, drawn, *size)


KINDS = {
    one.name: one
    for one in (
        _alike("kei_car", kei_car, (3.43, 1.48)),
        _alike("saloon", saloon, (4.98, 1.88)),
        _alike("van", van, (5.33, 1.88)),
        _alike("small_truck", small_truck, (6.34, 2.0)),
        _alike("truck", truck, (12.03, 2.49)),
        _alike("bus", bus, (11.94, 2.49)),
        MoverKind("motorcycle", motorcycle, partial(motorcycle, is_ridden=False), 2.2, 0.74),
        MoverKind("bicycle", bicycle, partial(bicycle, is_ridden=False), 2.0, 0.6),
        MoverKind("person", person, partial(person, is_walking=False), 2.6, 1.2),
    )
}
"""By name."""
