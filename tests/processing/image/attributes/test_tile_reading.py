"""What is told before a tile is read changes nothing in what is read."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.image.attributes.attributes import ATTRIBUTES
from processing.image.attributes.tile_reading import expect_tile
from processing.image.images_of_drives import image_of
from processing.image.point_image import PointCloudImage
from processing.image.tiles.tiles import TileKey
from processing.recording.columns.columns import Columns
from processing.recording.columns.coordinates import Coordinates
from processing.recording.columns.quantisation import Quantisation
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import small_drive


class ToldColumns(Columns):
    """Remembers what it was told of."""

    def __init__(self, folder: Path, count: int) -> None:
        super().__init__(folder, count)
        self.told: dict[str, list[tuple[int, int]]] = {}

    def expect(self, name: str, starts: np.ndarray, stops: np.ndarray) -> None:
        self.told[name] = list(zip(starts.tolist(), stops.tolist(), strict=True))
        super().expect(name, starts, stops)


@pytest.mark.parametrize("attribute", ["intensity", "height", "class"])
def test_every_point_that_a_tile_shows_was_told_of(tmp_path: Path, attribute: str) -> None:
    drive, _ = small_drive(tmp_path / "d")
    image = image_of(drive, ImageKind.TRAJECTORY_REVERSIBLE)
    for level in range(image.pyramid.levels):
        for key in image.pyramid.keys(level):
            columns = ToldColumns(drive.folder, drive.count)
            expect_tile(columns, image, key, attribute)
            assert set(columns.told) == {"pulse", *ATTRIBUTES[attribute].needs}
            points = image.pyramid.points(key)
            shown = np.sort(points[points >= 0])
            for stretches in columns.told.values():
                starts, stops = np.array(stretches).T
                at = np.searchsorted(starts, shown, side="right") - 1
                assert (shown >= starts[at]).all()
                assert (shown < stops[at]).all()


def test_a_coarse_tile_of_long_rows_is_told_of_row_by_row(tmp_path: Path) -> None:
    rows, width = 40, 3_000
    image = cells_of(rows, width)
    told = ToldColumns(tmp_path, rows * width)
    for name in ("pulse", "intensity"):
        told.hold(name, np.zeros(rows * width))
    expect_tile(told, image, TileKey(3, 0, 0), "intensity")
    apart = [(row * width, (row + 1) * width) for row in range(0, rows, 8)]
    assert told.told == {"pulse": apart, "intensity": apart}
    expect_tile(told, image, TileKey(0, 0, 0), "intensity")
    assert told.told["pulse"] == [(0, rows * width)]


def test_an_image_without_points_needs_nothing(tmp_path: Path) -> None:
    told = ToldColumns(tmp_path, 0)
    expect_tile(told, cells_of(0, 5), TileKey(0, 0, 0), "intensity")
    assert not told.told


def cells_of(rows: int, width: int) -> PointCloudImage:
    """A top view with one point in each cell."""
    xyz = np.zeros((rows * width, 3), np.int32)
    coordinates = Coordinates({"xyz": xyz}, Quantisation((1.0, 1.0, 1.0), (0.0, 0.0, 0.0)))
    pulses = np.arange(rows * width)
    return PointCloudImage(ImageKind.TOP_VIEW, pulses, width, coordinates=coordinates)
