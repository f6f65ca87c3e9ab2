"""A click beside a point seen from above finds it in any direction; in rows only along them."""

import numpy as np
import pytest

from processing.image.point_image import PointCloudImage
from processing.recording.kinds import ImageKind

# One point in the middle of 11 × 11 cells, and one far off in the middle row.
CELLS = np.array([5 * 11 + 0, 5 * 11 + 5, 10 * 11 + 10])


@pytest.mark.parametrize("position", [(5, 5), (5, 7), (3, 5), (7, 4), (8, 8)])
def test_a_filled_cell_is_found_from_every_side(position: tuple[int, int]) -> None:
    above = PointCloudImage(ImageKind.TOP_VIEW, CELLS, 11)
    scan = PointCloudImage(ImageKind.SCAN, CELLS, 11)
    nearest = 2 if position == (8, 8) else 1
    assert above.nearest_filled(*position) == nearest
    assert scan.nearest_filled(*position) == (1 if position[0] == 5 else -1)


def test_nothing_is_found_where_all_cells_around_are_empty() -> None:
    above = PointCloudImage(ImageKind.TOP_VIEW, CELLS, 11)
    assert above.nearest_filled(1, 9) == -1
    assert above.nearest_filled(-1, 5) == -1
