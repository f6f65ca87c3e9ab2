"""SceneTile: the points of one tile as the 3D view draws them."""

from __future__ import annotations

from collections.abc import Collection
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from processing.image.attributes.tile_cache import TileRequest
from processing.image.search.clip import Clip
from processing.image.tiles.tiles import TileKey
from processing.recording.kinds import ImageKind
from widgets.shared.view_settings import PointStyle


@dataclass(frozen=True)
class TileId:
    """One tile of one drive's image."""

    drive_id: str
    kind: ImageKind
    key: TileKey

    @property
    def parent(self) -> TileId:
        """The tile of the next coarser level that covers it, whether the image has it or not."""
        return TileId(self.drive_id, self.kind, self.key.above)


@dataclass(frozen=True)
class TileAppearance:
    """What is shown of the tiles: in which colours, and of which part of space.

    Attributes
    ----------
    look : PointStyle
        With the standard point size, which makes no difference here.
    clip : Clip or None
        None: all of it.
    """

    look: PointStyle
    clip: Clip | None = None


@dataclass(frozen=True)
class SceneTile:
    """Filled pixels of a tile, in one order throughout, without those that are clipped off.

    Attributes
    ----------
    request : TileRequest
        What was asked for, colours included.
    points : (n,) int64
        Indices in the drive.
    local_xyz : (n, 3) float32
        Metres from the view's origin.
    colours : (n, 3) uint8
    spacing_m : float
        Mean distance of neighbours.
    age : int
        Of the request it was made for: places are about the origin of that time.
    clip : Clip or None
        What it was clipped to.
    whole : SceneTile or None
        The tile before it was clipped.
    """

    request: TileRequest
    points: NDArray[np.int64]
    local_xyz: NDArray[np.float32]
    colours: NDArray[np.uint8]
    spacing_m: float
    age: int = 0
    clip: Clip | None = None
    whole: SceneTile | None = None

    @property
    def id(self) -> TileId:
        """Which tile it is."""
        return TileId(self.request.drive_id, self.request.kind, self.request.key)

    @property
    def showing(self) -> TileAppearance:
        """What its colours show, and of which part of space."""
        request = self.request
        look = PointStyle(
            request.attribute,
            request.low_percent,
            request.high_percent,
            hides_noise=request.hides_noise,
        )
        return TileAppearance(look, self.clip)

    def clipped(self, clip: Clip | None, origin: NDArray[np.float64]) -> SceneTile:
        """The tile with exactly the points that a clip leaves.

        Parameters
        ----------
        origin : (3,) float64
            The view's local origin, m, project CRS.
        """
        whole = self if self.whole is None else self.whole
        if clip is None or clip == self.clip:
            return whole if clip is None else self
        kept = clip.holds(whole.local_xyz + origin)
        return replace(
            whole,
            points=whole.points[kept],
            local_xyz=whole.local_xyz[kept],
            colours=whole.colours[kept],
            clip=clip,
            whole=whole,
        )


@dataclass(frozen=True)
class DrawnTile:
    """A tile in the scene and its bounds, (3,) float32 metres from the view's origin."""

    tile: SceneTile
    low: NDArray[np.float32]
    high: NDArray[np.float32]


def shown_tiles(wanted: Collection[TileId], loaded: Collection[TileId]) -> frozenset[TileId]:
    """The tiles to draw while some of those wanted are still on their way.

    In place of a missing tile stands the nearest coarser one that is there; where none is, the
    finer ones that are there. So nothing disappears before its successor has come.
    """
    there = set(loaded)
    highest = max((tile.key.rank for tile in there), default=0)
    shown: set[TileId] = set()
    for tile in wanted:
        if tile in there:
            shown.add(tile)
            continue
        above = tile.parent
        while above not in there and above.key.rank < highest:
            above = above.parent
        if above in there:
            shown.add(above)
        else:
            shown.update(finer for finer in there if _covers(tile, finer))
    return frozenset(tile for tile in shown if not _is_covered(tile, shown, highest))


def _covers(coarse: TileId, fine: TileId) -> bool:
    steps = coarse.key.level - fine.key.level
    return (
        coarse.key.rank > fine.key.rank
        and (coarse.drive_id, coarse.kind) == (fine.drive_id, fine.kind)
        and (coarse.key.row, coarse.key.column) == (fine.key.row >> steps, fine.key.column >> steps)
    )


def _is_covered(tile: TileId, shown: set[TileId], highest: int) -> bool:
    # A coarser tile that stands in for a missing one shows all that lies below it.
    while tile.key.rank < highest:
        tile = tile.parent
        if tile in shown:
            return True
    return False
