"""PointFinder: from a pixel to the exact place of a measured point."""

from __future__ import annotations

from collections import OrderedDict
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.image.clip import Clip
from processing.image.enclosed_points import Sight, points_enclosed
from processing.image.kinds import ImageKind
from processing.image.tile_kernels import COUNT, HIGHEST, LOWEST
from processing.image.tiles import TileKey, TilePyramid
from processing.points.drive import Drive
from processing.project.feature import PointReference
from widgets.scene_view.points.picking import Pickable, TilePoints, pick
from widgets.scene_view.points.scene_tile import DrawnTile, TileId
from widgets.scene_view.projection import NEAR_M, Projection
from widgets.shared.cursor import Place

Floats = NDArray[np.float64]

_MOST_REMEMBERED = 32


@dataclass(frozen=True)
class FoundPoint:
    """A measured point under the mouse.

    Attributes
    ----------
    depth_m : float
        In front of the camera.
    """

    place: Place
    depth_m: float


class PointFinder:
    """Looks up points of the drives that a view shows; remembers the tiles searched last."""

    def __init__(self) -> None:
        self._drives: dict[str, tuple[Drive, ImageKind]] = {}
        self._origin: Floats = np.zeros(3)
        self._clip: Clip | None = None
        self._searched: OrderedDict[TileId, TilePoints] = OrderedDict()

    def use(self, drives: Sequence[tuple[Drive, ImageKind]], origin: Floats) -> None:
        """Look for points of these drives, by the tiles of these images, from now on."""
        self._drives = {drive.id: (drive, kind) for drive, kind in drives}
        self._origin = origin
        self._searched.clear()

    def clip_to(self, clip: Clip | None) -> None:
        """Find only points in this part of space from now on; None: all."""
        if clip != self._clip:
            self._clip = clip
            self._searched.clear()

    def exact(
        self, shown: Sequence[DrawnTile], projection: Projection, x: float, y: float
    ) -> FoundPoint | None:
        """The front-most of all measured points under a pixel.

        Parameters
        ----------
        shown : sequence of DrawnTile
            What is drawn: the finest tiles among them need not be read again.
        """
        finest = {
            one.tile.id: one.tile
            for one in shown
            if one.tile.id.key.level == 0 and one.tile.clip == self._clip
        }
        layers = [
            _Layer(drive, kind, pyramid)
            for drive, kind in self._drives.values()
            if (pyramid := drive.image(kind).pyramid).is_ready
        ]
        if not layers:
            return None
        firsts = np.cumsum([0, *(len(layer.filled) for layer in layers)])

        def points_of(number: int) -> TilePoints:
            of_layer = int(np.searchsorted(firsts, number, side="right")) - 1
            layer = layers[of_layer]
            id_ = layer.id_of(number - int(firsts[of_layer]))
            drawn = finest.get(id_)
            if drawn is not None:
                return TilePoints(id_.drive_id, drawn.points, drawn.local_xyz)
            return self._points_of(layer, id_)

        low = np.concatenate([layer.bounds[0] for layer in layers]) - self._origin
        high = np.concatenate([layer.bounds[1] for layer in layers]) - self._origin
        return self._found(Pickable(low, high, points_of), projection, x, y)

    def drawn(
        self, shown: Sequence[DrawnTile], projection: Projection, x: float, y: float
    ) -> FoundPoint | None:
        """The front-most of the points that are drawn, which takes less time."""
        tiles = [
            one for one in shown if one.tile.points.size and one.tile.id.drive_id in self._drives
        ]
        if not tiles:
            return None

        def points_of(number: int) -> TilePoints:
            tile = tiles[number].tile
            return TilePoints(tile.id.drive_id, tile.points, tile.local_xyz)

        low = np.array([one.low for one in tiles], dtype=np.float64)
        high = np.array([one.high for one in tiles], dtype=np.float64)
        return self._found(Pickable(low, high, points_of), projection, x, y)

    def enclosed(self, projection: Projection, outline: Floats) -> dict[str, NDArray[np.int64]]:
        """All points that are seen inside an outline, drawn or not, but for those clipped off.

        Parameters
        ----------
        outline : (k, 2) float64
            Corners, pixels of the widget.

        Returns
        -------
        dict of str to (n,) int64
            Drive id to rising indices; only drives that have some.
        """
        sight = Sight(projection.matrix, self._origin, NEAR_M)
        found = {}
        for drive, kind in self._drives.values():
            image = drive.image(kind)
            if image.pyramid.is_ready:
                points = points_enclosed(drive, image, sight, outline)
                if self._clip is not None:
                    points = points[self._clip.holds(drive.xyz(points))]
                if points.size:
                    found[drive.id] = points
        return found

    def _found(
        self, tiles: Pickable, projection: Projection, x: float, y: float
    ) -> FoundPoint | None:
        picked = pick(tiles, projection, x, y)
        if picked is None:
            return None
        drive, _ = self._drives[picked.drive_id]
        easting, northing, height = drive.xyz(np.array([picked.point]))[0].tolist()
        place = Place((easting, northing, height), PointReference(drive.id, picked.point))
        return FoundPoint(place, picked.depth_m)

    def _points_of(self, layer: _Layer, id_: TileId) -> TilePoints:
        there = self._searched.pop(id_, None)
        if there is None:
            points = layer.pyramid.points(id_.key).ravel()
            points = points[points >= 0]
            if self._clip is not None:
                points = points[self._clip.holds(layer.drive.xyz(points))]
            there = TilePoints(id_.drive_id, points, layer.drive.local_xyz(points, self._origin))
        self._searched[id_] = there
        while len(self._searched) > _MOST_REMEMBERED:
            self._searched.popitem(last=False)
        return there


class _Layer:
    """The filled tiles of an image at its finest level."""

    def __init__(self, drive: Drive, kind: ImageKind, pyramid: TilePyramid) -> None:
        self.drive = drive
        self.kind = kind
        self.pyramid = pyramid
        rows, self._columns = pyramid.shape(0)
        table = pyramid.table[: rows * self._columns]
        self.filled = np.flatnonzero(table[:, COUNT] > 0)
        self.bounds = table[self.filled, LOWEST], table[self.filled, HIGHEST]

    def id_of(self, number: int) -> TileId:
        row, column = divmod(int(self.filled[number]), self._columns)
        return TileId(self.drive.id, self.kind, TileKey(0, row, column))
