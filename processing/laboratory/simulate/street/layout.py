"""What a section's cross sections amount to: the lines of its surfaces, side by side."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.corner_track import CornerTrack
from processing.laboratory.simulate.street.dropped_curbs import Drop
from processing.laboratory.simulate.street.ground import StreetGround, Strip
from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.measures import BandSurfaces
from processing.laboratory.simulate.street.sweep import Sweep
from processing.laboratory.simulate.street.terrain import SectionTerrain


@dataclass(frozen=True)
class CornerLayout:
    """One corner of a side street's mouth.

    Attributes
    ----------
    sweep : Sweep
        From the asphalt's edge to the land, round the corner.
    drops : tuple of Drop
        Where its curb is lowered, by the track's metres.
    land : Strip
        What lies behind.
    """

    track: CornerTrack
    sweep: Sweep
    drops: tuple[Drop, ...]
    land: Strip


@dataclass(frozen=True)
class Outline:
    """A side's lines across the road at one place: (k,) float64 each.

    Attributes
    ----------
    away, above : (k,) float64
        m from the centre, and over the terrain.
    strips : tuple of Strip
        Between them.
    """

    away: Floats
    above: Floats
    strips: tuple[Strip, ...]


@dataclass(frozen=True)
class SideLayout:
    """The lines of one side.

    Attributes
    ----------
    sweep : Sweep
        From the asphalt's edge to the land; at a junction the edge and the land alone.
    drops : tuple of Drop
        Where the curb is lowered, by chainage.
    mouth : Mouth or None
        The side street that meets the road here.
    corners : tuple of CornerLayout
        Its corners: before it and behind it.
    end : (Outline, Outline) or None
        Where the section meets the next one: its own lines and those of the next.
    """

    sweep: Sweep
    drops: tuple[Drop, ...]
    looks: BandSurfaces
    mouth: Mouth | None
    corners: tuple[CornerLayout, ...]
    end: tuple[Outline, Outline] | None


@dataclass(frozen=True)
class SectionSurfaces:
    """The surfaces of a section.

    Attributes
    ----------
    terrain : SectionTerrain
        The height over which all lines stand.
    ground : StreetGround
        All lines on common nodes.
    road_nodes : (n,) float64
        Chainages of the carriageway's nodes.
    road_lines : (m,) float64
        Offsets of the carriageway's lines, right to left, without its edges.
    sides : mapping of side to SideLayout
    median : tuple of Sweep
        Both halves of the raised strip in the middle; empty where there is none.
    """

    terrain: SectionTerrain
    ground: StreetGround
    road_nodes: Floats
    road_lines: Floats
    sides: Mapping[int, SideLayout]
    median: tuple[Sweep, ...]
