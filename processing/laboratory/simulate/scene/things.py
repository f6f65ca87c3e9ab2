"""What a street or a site holds: things, what truth tells of them, what moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from processing.laboratory.simulate.scene.mesh import Floats, Mesh, MeshBuilder

Fact = str | int | float | bool | list[float] | None
TruthFile = Literal[
    "curbs",
    "gutters",
    "trees",
    "signs",
    "poles",
    "wires",
    "markings",
    "barriers",
    "walls",
    "covers",
    "plant_areas",
    "edges",
]

THINGS_PER_SECTION = 20_000
NO_THING = 0
"""The instance of what is no single thing: the road, a field."""


@dataclass(frozen=True)
class Thing:
    """Something that points can belong to.

    Attributes
    ----------
    instance : int
        Its number in the whole street, from 1.
    kind : str
        In a word: ``curb``, ``lid``, ``tree``, ``car``.
    """

    instance: int
    kind: str


@dataclass(frozen=True)
class TrueFeature:
    """A feature of the ledger as it stands: what a perfect tool would find.

    Attributes
    ----------
    file : str
        Whose truth it belongs to: ``curbs``, ``gutters``, ``trees``, ``signs``, ``poles``,
        ``wires``, ``markings``, ``barriers``, ``walls``, ``covers``, ``plant_areas``, ``edges``.
    geometry : str
        ``Point``, ``LineString`` or ``Polygon`` (closed ring).
    xyz : (n, 3) float64
        m, the street's frame.
    facts : mapping
        Properties as the contract names them, and more; what was seen of it is added later from
        the counts of points on its instance and pieces. ``in_span`` false: too far off to be asked
        for, wherever the vehicle drove.
    instance : int
        The thing whose points show it.
    chainage_m : float
        Where along the road it is; tells whether the vehicle passed it.
    """

    file: TruthFile
    geometry: Literal["Point", "LineString", "Polygon"]
    xyz: Floats
    facts: Mapping[str, Fact]
    instance: int
    chainage_m: float


@dataclass(frozen=True)
class Mover:
    """Something that moves along the road during the recording.

    Attributes
    ----------
    mesh : Mesh
        In its own frame: x forward, y left, z up, m, about the place on the ground under it.
    chainage_m, offset_m : float
        Where it is at time 0 of the recording; offsets count to the left of the road's centre.
    speed_m_s : float
        Along the chainage; negative for those that come towards its beginning.
    from_s, to_s : float
        When it is there, on the pass' time.
    turn_rad : float
        Where it faces, anticlockwise from the road's direction: π for oncoming traffic.
    aside_m_s : float
        Speed to the left, of those that cross the road.
    sway_m, sway_s : float
        Amplitude and period of its swinging from side to side (people, bicycles).
    surge_m, surge_s : float
        Amplitude and period of its falling back and catching up along the road.
    phase_rad : float
        Of both swings at time 0.
    course : (n, 2) float64 or None
        Times and chainages that its own chainage counts from, of those that keep their distance
        from the recording vehicle.
    kind : str
        In a word: ``car``, ``bus``, ``person``.
    """

    mesh: Mesh
    chainage_m: float
    offset_m: float
    speed_m_s: float
    from_s: float
    to_s: float
    turn_rad: float = 0.0
    aside_m_s: float = 0.0
    sway_m: float = 0.0
    sway_s: float = 1.0
    surge_m: float = 0.0
    surge_s: float = 1.0
    phase_rad: float = 0.0
    course: Floats | None = None
    kind: str = "car"

    def direction_at(self, time_s: ArrayLike) -> tuple[Floats, Floats]:
        """Chainages and offsets at times of the pass, m: (...) float64 each."""
        time = np.asarray(time_s, np.float64)
        surge = self.surge_m * np.sin(2 * np.pi * time / self.surge_s + self.phase_rad)
        along: Floats = self.chainage_m + self.speed_m_s * time + surge
        if self.course is not None:
            along = along + np.interp(time, self.course[:, 0], self.course[:, 1])
        sway = self.sway_m * np.sin(2 * np.pi * time / self.sway_s + self.phase_rad)
        aside: Floats = self.offset_m + self.aside_m_s * time + sway
        return along, aside


@dataclass
class SectionBuilder:
    """What makers add to: triangles, things and truth of one section of a street.

    Attributes
    ----------
    first_instance : int
        Number of the section's first thing.
    """

    first_instance: int
    mesh: MeshBuilder = field(default_factory=MeshBuilder)
    things: list[Thing] = field(default_factory=list)
    truth: list[TrueFeature] = field(default_factory=list)
    _last_things: int = 0

    def thing(self, kind: str) -> int:
        """A new thing; its instance."""
        instance = self.first_instance + len(self.things) - self._last_things
        if len(self.things) >= THINGS_PER_SECTION:
            raise ValueError("too many things in one section")
        self.things.append(Thing(instance, kind))
        return instance

    def last_thing(self, kind: str) -> int:
        """A new thing numbered down from the section's end: it moves no number of the others."""
        self._last_things += 1
        instance = self.first_instance + THINGS_PER_SECTION - self._last_things
        if len(self.things) >= THINGS_PER_SECTION:
            raise ValueError("too many things in one section")
        self.things.append(Thing(instance, kind))
        return instance
