"""Side streets: their carriageway, the corners with curbs and walks, and the land between."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from processing.laboratory.simulate.roadway.transverse import transverse_of
from processing.laboratory.simulate.scene.mesh import Floats, grid
from processing.laboratory.simulate.scene.things import NO_THING, SectionBuilder
from processing.laboratory.simulate.street.corner_track import CornerTrack
from processing.laboratory.simulate.street.junction_shape import Mouth
from processing.laboratory.simulate.street.layout import CornerLayout
from processing.laboratory.simulate.street.profile import ROAD
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.surfaces import asphalt_of
from processing.laboratory.simulate.street.sweep import SKIRT_M, add_runs, add_surfaces

CARRIAGEWAY_COLUMNS = 9
"""Nodes across a side street."""

_UNDER_M = 0.05
_BELOW_M = 0.008
"""The side street's asphalt reaches under the road's, so that no beam passes between them."""

_LEAST_ROW_M = 0.02
_LAND_ACROSS_M, _LAND_ALONG_M = 0.8, 2.0


def add_junctions(section: StreetSection, built: SectionBuilder) -> None:
    """Add the side streets of a section."""
    for side in section.plan.junctions:
        part = section.layout.sides[side]
        if part.mouth is None:
            continue
        for corner in part.corners:
            add_surfaces(corner.sweep, section.alignment, built, part.looks.walk)
            add_runs(corner.sweep, section.alignment, built)
            _add_land(section, corner, built)
        _add_carriageway(section, part.mouth, part.corners, built)


def _add_land(section: StreetSection, corner: CornerLayout, built: SectionBuilder) -> None:
    """The block behind a corner: from the section's end to the side street's last line."""
    track = corner.track
    from_end, beside = track.square(corner.sweep.profile.away[-1])
    above = corner.sweep.profile.above[-1]
    top = float(beside[-1])
    is_road = np.arange(from_end.size) <= track.last
    columns, picked = np.unique(from_end[is_road], return_index=True)
    low = beside[is_road][picked]
    kept = _thinned(columns, _LAND_ACROSS_M) | (picked >= track.first)
    columns, low, road_level = columns[kept], low[kept], above[is_road][picked][kept]
    up = np.unique(np.append(beside[beside > low[-1] + 1e-9], [low[-1], top]))
    up = up[_thinned(up, _LAND_ALONG_M)]
    share = (up - low[-1]) / (top - low[-1])
    # One row and one column more reach under the lines that the thinned ones only follow.
    share, columns = np.append(0.0, share), np.append(columns, columns[-1] + _UNDER_M)
    low, road_level = np.append(low, low[-1]), np.append(road_level, road_level[-1])
    rows_beside = low[None, :] + share[:, None] * (top - low[None, :])
    rows_beside[0] -= _UNDER_M
    rows_from_end = np.broadcast_to(columns, rows_beside.shape)
    chainage, offset = track.placed(track.chainages(rows_from_end), rows_beside)
    level = float(np.median(above))
    height = section.layout.terrain.height(chainage, offset)
    height = height + road_level[None, :] + share[:, None] * (level - road_level[None, :])
    height[0] -= _UNDER_M
    height[1:, -1] -= _UNDER_M
    rows = section.alignment.at(chainage, offset, height)
    built.mesh.add(grid(rows), corner.land.material, corner.land.label, NO_THING)
    skirt = np.stack([rows[:, 0], rows[:, 0] - [0.0, 0.0, SKIRT_M]], axis=1)
    built.mesh.add(grid(skirt), corner.land.material, corner.land.label, NO_THING)


def _thinned(positions: Floats, least_m: float) -> NDArray[np.bool_]:
    """Rising places, the first and last always, no closer than this where more are there."""
    steps = np.floor((positions - positions[0]) / least_m)
    kept = np.append(True, np.diff(steps) > 0)
    kept[-1] = True
    return kept


def street_sides(corners: tuple[CornerLayout, ...], beside: Floats) -> tuple[Floats, Floats]:
    """Where the side street's asphalt begins and ends, in the square frame, at depths (n,)."""
    limits = []
    for corner in corners:
        track = corner.track
        from_end, depth = track.square(corner.sweep.profile.away[0])
        kept = slice(track.first, None)
        rising = np.maximum.accumulate(depth[kept])
        limits.append(track.chainages(np.interp(beside, rising, from_end[kept])))
    return limits[0], limits[1]


def street_height(
    section: StreetSection, mouth: Mouth, track: CornerTrack, along: Floats, beside: Floats
) -> Floats:
    """Height of a side street's asphalt, z in m, at places of the square frame."""
    chainage, offset = track.placed(along, beside)
    return section.layout.terrain.height(chainage, offset) + mouth.crown(chainage, beside)


def _add_carriageway(
    section: StreetSection, mouth: Mouth, corners: tuple[CornerLayout, ...], built: SectionBuilder
) -> None:
    depths = [one.track.square(one.sweep.profile.away[0])[1][one.track.first :] for one in corners]
    top = min(float(one[-1]) for one in depths)
    beside = np.unique(np.concatenate([[0.0, top], *depths]))
    beside = beside[(beside >= 0) & (beside <= top)]
    beside = beside[np.append(True, np.diff(beside) > _LEAST_ROW_M)]
    gutter = transverse_of(section, mouth)
    if gutter is not None:
        apart = (beside < gutter[0] - _LEAST_ROW_M) | (beside > gutter[1] + _LEAST_ROW_M)
        beside = np.sort(np.concatenate([beside[apart], gutter]))
    low, high = street_sides(corners, beside)
    share = np.linspace(0.0, 1.0, CARRIAGEWAY_COLUMNS)
    along = low[:, None] + share * (high - low)[:, None]
    deep = np.broadcast_to(beside[:, None], along.shape)
    chainage, offset = corners[0].track.placed(along, deep)
    height = street_height(section, mouth, corners[0].track, along, deep)
    rows = section.alignment.at(chainage, offset, height)
    under_s, under_o = corners[0].track.placed(along[:1], deep[:1] - _UNDER_M)
    below = section.layout.terrain.height(under_s, under_o) - _BELOW_M
    rows = np.concatenate([section.alignment.at(under_s, under_o, below), rows])
    opening = len(rows) if gutter is None else int(np.searchsorted(beside, gutter[0])) + 2
    for part in (rows[:opening], rows[opening:]):
        if len(part) > 1:
            built.mesh.add(grid(part), asphalt_of(section.seed), ROAD, NO_THING)
