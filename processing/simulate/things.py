"""What a street or a site holds: things, what truth tells of them, what moves."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from processing.simulate.mesh import Floats, Mesh, MeshBuilder

Fact = str | int | float | bool | list[float] | None
TruthFile = Literal["curbs", "gutters", "trees", "signs", "poles"]

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
        Whose truth it belongs to: ``curbs``, ``gutters``, ``trees``, ``signs``, ``poles``.
    geometry : str
        ``Point``, ``LineString`` or ``Polygon`` (closed ring).
    xyz : (n, 3) float64
        m, the street's frame.
    facts : mapping
        Properties as the contract names them, and more; what was seen of it is added later from
        the counts of points on its instance and pieces.
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
        Along the chainage; negative for those that come towards its beginning. It faces its way.
    from_s, to_s : float
        When it is there, on the pass' time.
    sway_m, sway_s : float
        Amplitude and period of its swinging from side to side (people, bicycles).
    """

    mesh: Mesh
    chainage_m: float
    offset_m: float
    speed_m_s: float
    from_s: float
    to_s: float
    sway_m: float = 0.0
    sway_s: float = 1.0


@dataclass
class Built:
    """What makers add to: triangles, things, truth and movers of one section of a street.

    Attributes
    ----------
    first_instance : int
        Number of the section's first thing.
    """

    first_instance: int
    mesh: MeshBuilder = field(default_factory=MeshBuilder)
    things: list[Thing] = field(default_factory=list)
    truth: list[TrueFeature] = field(default_factory=list)
    movers: list[Mover] = field(default_factory=list)

    def thing(self, kind: str) -> int:
        """A new thing; its instance."""
        instance = self.first_instance + len(self.things)
        if len(self.things) >= THINGS_PER_SECTION:
            raise ValueError("too many things in one section")
        self.things.append(Thing(instance, kind))
        return instance
