"""PointFinder: from a pixel to the exact place of a measured point."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.image.images_of_drives import image_of
from processing.image.search.clip import Clip
from processing.image.search.enclosed_points import Sight, points_enclosed
from processing.image.search.ray_hits import RayHit, RayHits
from processing.image.tiles.tile_descent import ray_kernel
from processing.image.tiles.tiles import TILE, TileKey
from processing.map.feature import PointReference
from processing.recording.columns.counted_classes import seen_points
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from widgets.scene_view.points.picking import entry_depths, pick, ray_at, sight_at
from widgets.scene_view.rendering.projection import NEAR_M, SceneProjection
from widgets.scene_view.rendering.scene_tile import DrawnTile
from widgets.shared.cursor import PickedPosition
from widgets.shared.view_settings import ViewSettings


@dataclass(frozen=True)
class FoundPoint:
    """A measured point under the mouse.

    Attributes
    ----------
    depth_m : float
        In front of the camera.
    """

    position: PickedPosition
    depth_m: float


class PointFinder:
    """Looks up points of the drives that a view shows.

    Parameters
    ----------
    settings : ViewSettings
        Say whether noise is hidden.
    """

    def __init__(self, settings: ViewSettings) -> None:
        self._settings = settings
        self._drives: dict[str, tuple[Drive, ImageKind]] = {}
        self._origin: Floats = np.zeros(3)
        self._clip: Clip | None = None

    def use(self, drives: Sequence[tuple[Drive, ImageKind]], origin: Floats) -> None:
        """Look for points of these drives, by the tiles of these images, from now on."""
        self._drives = {drive.id: (drive, kind) for drive, kind in drives}
        self._origin = origin

    def clip_to(self, clip: Clip | None) -> None:
        """Find only points in this part of space from now on; None: all."""
        self._clip = clip

    def exact(
        self, shown: Sequence[DrawnTile], projection: SceneProjection, x: float, y: float
    ) -> FoundPoint | None:
        """The front-most of all measured points under a pixel, drawn or not.

        Parameters
        ----------
        shown : sequence of DrawnTile
            What is drawn: drives without anything in the picture aren't searched.
        """
        ray = ray_at(projection, self._origin, x, y)
        near: list[tuple[str, TileKey]] = []
        entries = [np.empty(0)]
        are_shown = {one.tile.id.drive_id for one in shown}
        for id_ in self._drives:
            if id_ in are_shown:
                tiles, depths = self._tiles_on(id_, ray)
                near += [(id_, key) for key in tiles]
                entries.append(depths)
        for seen in self._seen_unsurveyed(shown, projection, x, y):
            near.append(seen)
            entries.append(np.zeros(1))

        def search(number: int, hits: RayHits) -> None:
            drive, kind = self._drives[near[number][0]]
            image, key = image_of(drive, kind), near[number][1]
            hits.search_tile(drive, image, key, self._clip, hides_noise=self._hides_noise)

        sight = sight_at(projection, self._origin, x, y)
        return self._find_point(pick(np.concatenate(entries), search, sight))

    def drawn(
        self, shown: Sequence[DrawnTile], projection: SceneProjection, x: float, y: float
    ) -> FoundPoint | None:
        """The front-most of the points that are drawn, which takes less time."""
        tiles = [
            one for one in shown if one.tile.points.size and one.tile.id.drive_id in self._drives
        ]
        if not tiles:
            return None

        def search(number: int, hits: RayHits) -> None:
            tile = tiles[number].tile
            hits.search_cloud(tile.id.drive_id, tile.points, tile.local_xyz)

        low = np.array([one.low for one in tiles], dtype=np.float64)
        high = np.array([one.high for one in tiles], dtype=np.float64)
        entries = entry_depths(low, high, ray_at(projection, np.zeros(3), x, y))
        return self._find_point(pick(entries, search, sight_at(projection, self._origin, x, y)))

    def enclosed(
        self, projection: SceneProjection, outline: Floats
    ) -> dict[str, NDArray[np.int64]]:
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
            image = image_of(drive, kind)
            if image.pyramid.is_ready:
                points = points_enclosed(drive, image, sight, outline)
                points = seen_points(drive.columns, points, hides_noise=self._hides_noise)
                if self._clip is not None:
                    points = points[self._clip.holds(drive.xyz(points))]
                if points.size:
                    found[drive.id] = points
        return found

    @property
    def _hides_noise(self) -> bool:
        return self._settings.look.hides_noise

    def _tiles_on(self, drive_id: str, ray: Floats) -> tuple[list[TileKey], Floats]:
        """The finest tiles of a drive that a cone meets, and where it enters them."""
        drive, kind = self._drives[drive_id]
        pyramid = image_of(drive, kind).pyramid
        rows, columns = pyramid.shape(0)
        met = np.empty((rows * columns, 3))
        met = met[: ray_kernel(pyramid.facts, pyramid.shapes, ray, met)]
        keys = met[:, :2].astype(np.int64).tolist()
        return [TileKey(0, row, column) for row, column in keys], met[:, 2].copy()

    def _seen_unsurveyed(
        self, shown: Sequence[DrawnTile], projection: SceneProjection, x: float, y: float
    ) -> list[tuple[str, TileKey]]:
        """The tile of the point that is drawn here, if its drive's tiles are only sketched.

        Where such tiles are isn't sure; that this one is here is.
        """
        seen = self.drawn(shown, projection, x, y)
        reference = None if seen is None else seen.position.measured
        if reference is None:
            return []
        drive, kind = self._drives[reference.drive]
        image = image_of(drive, kind)
        if image.pyramid.is_ready:
            return []
        rows, columns = image.pixel_of(np.array([reference.point]))
        return [(drive.id, TileKey(0, int(rows[0]) // TILE, int(columns[0]) // TILE))]

    def _find_point(self, hit: RayHit | None) -> FoundPoint | None:
        if hit is None:
            return None
        drive, _ = self._drives[hit.drive_id]
        easting, northing, height = drive.xyz(np.array([hit.point]))[0].tolist()
        position = PickedPosition((easting, northing, height), PointReference(drive.id, hit.point))
        return FoundPoint(position, hit.depth_m)
