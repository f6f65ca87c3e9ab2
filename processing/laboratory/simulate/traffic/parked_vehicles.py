"""What is parked: vehicles at the road's edges, half on walks, in yards; bicycles on walks.

A maker that comes after all others: nothing is parked where something stands already. Each is a
thing of kind ``car``, ``van``, ``truck``, ``bicycle``, ``motorcycle``; all its triangles have
label 64 and piece 0.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from math import cos, sin

import numpy as np

from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.traffic.bodies import TrafficBody
from processing.laboratory.simulate.traffic.kinds import KINDS
from processing.laboratory.simulate.traffic.parking import ParkingPosition, parking_positions

_HINDERING = (1, 4, 6, 64, 65, 66)
_BUILDING = 6
_ROOM_M = 0.15
_STEEPEST = 0.16  # rise per metre that a vehicle is parked on
_LOWEST_M = 0.2  # what is lower is driven over
_STEP_M = 0.4  # higher steps than this under one vehicle are no place to park


@dataclass(frozen=True)
class _Standing:
    """A body's place: rotation (3, 3) with columns forward, left, up, and the place under it."""

    turn: Floats
    position: Floats


def add_parked(section: StreetSection, built: SectionBuilder) -> None:
    """Park what finds room on the section's places."""
    positions = parking_positions(section.seed, section.plan)
    if not positions:
        return
    hindrance = _Hindrance(built.mesh.mesh())
    taken: list[Footprint] = []
    for one in positions:
        body = KINDS[one.kind].drawn_at_rest(section.chance("parked", one.number))
        standing = _standing(section, one, body)
        if standing is None or hindrance.hinders(standing, body):
            continue
        footprint = _footprint(standing, body)
        if any(footprint.touches(other) for other in taken):
            continue
        taken.append(footprint)
        mesh = body.mesh(built.thing(body.kind))
        vertices = mesh.vertices @ standing.turn.T + standing.position
        built.mesh.add_mesh(replace(mesh, vertices=vertices))


def _standing(section: StreetSection, one: ParkingPosition, body: TrafficBody) -> _Standing | None:
    """How a body stands on the ground under its wheels; None where that is too rough."""
    cosine, sine = np.cos(one.turn_rad), np.sin(one.turn_rad)
    ahead, aside = 0.32 * body.length_m, 0.42 * body.width_m
    x = np.array([ahead, ahead, -ahead, -ahead])
    y = np.array([aside, -aside, aside, -aside])
    chainages = one.chainage_m + cosine * x - sine * y
    offsets = one.offset_m + sine * x + cosine * y
    wheels = section.position(chainages, offsets)
    if np.ptp(wheels[:, 2]) > _STEP_M:
        return None
    middle = wheels.mean(axis=0)
    forward = (wheels[:2] - wheels[2:]).sum(axis=0)
    left = (wheels[[0, 2]] - wheels[[1, 3]]).sum(axis=0)
    forward /= np.linalg.norm(forward)
    up = np.cross(forward, left)
    up /= np.linalg.norm(up)
    if np.hypot(up[0], up[1]) > _STEEPEST:
        return None
    return _Standing(np.column_stack([forward, np.cross(up, forward), up]), middle)


def _footprint(standing: _Standing, body: TrafficBody) -> Footprint:
    x, y = standing.position[:2].tolist()
    heading = float(np.arctan2(standing.turn[1, 0], standing.turn[0, 0]))
    return Footprint(x, y, heading, body.length_m / 2 + _ROOM_M / 2, body.width_m / 2 + _ROOM_M / 2)


class _Hindrance:
    """What stands in a section already, and hinders parking."""

    def __init__(self, mesh: Mesh) -> None:
        rows = np.flatnonzero(np.isin(mesh.label, _HINDERING))
        self._corners = mesh.vertices[mesh.triangles[rows]]
        self._is_building = mesh.label[rows] == _BUILDING
        flat = self._corners[:, :, :2]
        self._low, self._high = flat.min(axis=1), flat.max(axis=1)

    def hinders(self, standing: _Standing, body: TrafficBody) -> bool:
        """Whether something stands where the body would be, or a roof is above it."""
        reach = float(np.hypot(body.length_m, body.width_m)) / 2 + _ROOM_M
        position = standing.position[:2]
        is_near = (self._low < position + reach) & (self._high > position - reach)
        near = np.flatnonzero(is_near[:, 0] & is_near[:, 1])
        local = (self._corners[near] - standing.position) @ standing.turn
        low, high = local.min(axis=1), local.max(axis=1)
        half = np.array([body.length_m / 2 + _ROOM_M, body.width_m / 2 + _ROOM_M])
        within = ((low[:, :2] < half) & (high[:, :2] > -half)).all(axis=1)
        is_low = low[:, 2] < body.height_m + 0.2
        within &= (high[:, 2] > _LOWEST_M) & (is_low | self._is_building[near])
        return bool(within.any())


@dataclass(frozen=True)
class Footprint:
    """A turned rectangle.

    Attributes
    ----------
    x, y : float
        Its middle, m.
    heading_rad : float
        Of its length, anticlockwise from x.
    half_length, half_width : float
        m.
    """

    x: float
    y: float
    heading_rad: float
    half_length: float
    half_width: float

    def touches(self, other: Footprint) -> bool:
        """Whether two rectangles share a place: no line of their sides' ways parts them."""
        dx, dy = other.x - self.x, other.y - self.y
        for heading in (self.heading_rad, other.heading_rad):
            for direction in ((cos(heading), sin(heading)), (-sin(heading), cos(heading))):
                apart = abs(dx * direction[0] + dy * direction[1])
                if apart > self._reach(direction) + other._reach(direction):
                    return False
        return True

    def _reach(self, direction: tuple[float, float]) -> float:
        """How far it reaches from its middle along a way."""
        c, s = cos(self.heading_rad), sin(self.heading_rad)
        along = abs(direction[0] * c + direction[1] * s) * self.half_length
        return along + abs(direction[1] * c - direction[0] * s) * self.half_width
