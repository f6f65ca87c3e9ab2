"""Each kind of image against its equations and against a simulated street's truth."""

from __future__ import annotations

import numpy as np
import pytest

from processing.image.point_image import PointCloudImage
from processing.image.rows.point_image_kernels import (
    _column,
    columns_kernel,
    first_at,
    first_at_column,
    raster_kernel,
)
from processing.recording.kinds import ImageKind
from tests.builders import simulated_drive
from tests.processing.image.recordings import revolutions_of, true_revolutions

FOLDS = np.array([100, 210, 320, 428, 540])


def image_of(kind: ImageKind, pulses: np.ndarray) -> PointCloudImage:
    return PointCloudImage(kind, pulses.astype(np.int64), revolutions_of(FOLDS))


def test_feature_centre_follows_equations_3_5_and_3_6() -> None:
    pulses = np.arange(100, 540)
    image = image_of(ImageKind.FEATURE_CENTER, pulses)
    assert image.width == round(0.99 * 110)
    rows, columns = image.pixel_of(np.arange(pulses.size))
    for point, pulse in enumerate(pulses):
        k = int(np.searchsorted(FOLDS, pulse, side="right")) - 1
        share = (pulse - FOLDS[k]) / (FOLDS[k + 1] - FOLDS[k])
        assert rows[point] == k
        assert columns[point] == int(share * image.width + 1e-9)


def test_trajectory_centre_follows_equations_3_3_and_3_4() -> None:
    pulses = np.arange(160, 480)
    image = image_of(ImageKind.TRAJECTORY_CENTER, pulses)
    middles = (FOLDS[:-1] + FOLDS[1:]) / 2
    rows, columns = image.pixel_of(np.arange(pulses.size))
    for point, pulse in enumerate(pulses):
        k = int(np.searchsorted(middles, pulse, side="right")) - 1
        low, high = middles[k], middles[k + 1] if k + 1 < middles.size else middles[k] + 110
        if high > middles[-1] or pulse < middles[0]:
            continue
        assert columns[point] == int((pulse - low) / (high - low) * image.width + 1e-9)
        assert rows[point] == rows[0] + k + (0 if pulses[0] >= middles[0] else 1)


def test_the_trajectory_is_the_middle_column_of_the_trajectory_centre_kind() -> None:
    image = image_of(ImageKind.TRAJECTORY_CENTER, np.arange(100, 540))
    _, columns = image.pixel_of(FOLDS[1:-1] - 100)
    assert np.abs(columns - image.width / 2).max() <= 2


def test_reversible_rows_have_one_length_and_begin_anew_after_a_stop() -> None:
    pulses = np.concatenate([np.arange(100, 265), np.arange(9000, 9200)])
    folds = np.array([100, 210, 9000, 9110])
    revolutions = revolutions_of(
        folds,
        row_ends=np.array([210, 265, 9110]),
        segments=np.array([0, 0, 1], np.int32),
    )
    image = PointCloudImage(ImageKind.REVERSIBLE, pulses, revolutions)
    rows, columns = image.pixel_of(np.arange(pulses.size))
    assert image.width == 110
    assert image.segments.tolist() == [0, 0, 1, 1]
    assert image.split_rows.tolist() == [2]
    assert columns[:165].tolist() == [m % 110 for m in range(165)]
    assert columns[165:].tolist() == [m % 110 for m in range(200)]
    assert rows[165] == 2


def test_trajectory_based_reversible_rows_are_as_wide_as_their_revolutions() -> None:
    image = image_of(ImageKind.TRAJECTORY_REVERSIBLE, np.arange(100, 540))
    assert image.row_widths.tolist() == [110, 110, 108, 112]
    assert image.width == 112
    assert image.mode_width == 110
    assert image.row_times.tolist() == [0.1, 0.21, 0.32, 0.428]


def test_pulses_outside_all_folds_get_rows_of_their_own() -> None:
    image = image_of(ImageKind.TRAJECTORY_REVERSIBLE, np.arange(0, 700))
    rows, columns = image.pixel_of(np.array([0, 99, 100, 539, 540, 699]))
    assert rows.tolist() == [0, 0, 1, 4, 5, 6]
    assert columns.tolist() == [10, 109, 0, 111, 0, 49]


def test_missing_returns_of_less_than_a_second_leave_empty_rows() -> None:
    folds = np.arange(0, 3001, 100)
    pulses = np.concatenate([np.arange(0, 250), np.arange(1200, 1300)])
    image = PointCloudImage(ImageKind.TRAJECTORY_REVERSIBLE, pulses, revolutions_of(folds))
    assert image.rows == 13
    assert image.segments.tolist() == [0] * 13
    assert np.diff(image.row_starts).tolist() == [100, 100, 50] + [0] * 9 + [100]


def test_a_longer_gap_is_closed_up_and_known_as_a_split() -> None:
    folds = np.arange(0, 3001, 100)
    pulses = np.concatenate([np.arange(0, 250), np.arange(2200, 2300)])
    image = PointCloudImage(ImageKind.TRAJECTORY_REVERSIBLE, pulses, revolutions_of(folds))
    assert image.rows == 4
    assert image.segments.tolist() == [0, 0, 0, 1]
    assert image.split_rows.tolist() == [3]
    assert image.row_times[3] == 2.2


def test_of_several_points_in_a_pixel_the_one_nearest_its_centre_is_shown() -> None:
    revolutions = revolutions_of(np.array([0, 1000, 2000]))
    image = PointCloudImage(ImageKind.FEATURE_CENTER, np.arange(2000), revolutions)
    rows, columns = image.pixel_of(np.arange(2000))
    exact = (np.arange(2000) % 1000) / 1000 * image.width
    for row, column in [(0, 0), (0, 57), (1, 500), (1, 989)]:
        points = image.points_at(row, column)
        inside = np.flatnonzero((rows == row) & (columns == column))
        assert sorted(points.tolist()) == inside.tolist()
        off = np.abs(exact - column - 0.5)
        assert off[points[0]] == off[inside].min()


def test_a_click_beside_a_point_finds_it_within_three_pixels_of_its_row() -> None:
    pulses = np.array([105, 130, 131, 215])
    image = PointCloudImage(ImageKind.TRAJECTORY_REVERSIBLE, pulses, revolutions_of(FOLDS))
    assert image.nearest_filled(0, 5) == 0
    assert image.nearest_filled(0, 2) == 0
    assert image.nearest_filled(0, 8) == 0
    assert image.nearest_filled(0, 9) == -1
    assert image.nearest_filled(0, 32) == 2
    assert image.nearest_filled(0, 29) == 1
    assert image.nearest_filled(0, 20, within_px=10) == 1
    assert image.nearest_filled(-1, 5) == -1
    assert image.nearest_filled(0, 5000) == -1


def test_asking_outside_the_image_gives_no_points_and_no_wrong_ones() -> None:
    image = image_of(ImageKind.REVERSIBLE, np.arange(100, 540))
    assert image.points_at(-1, 0).size == 0
    assert image.points_at(0, image.width).size == 0
    with pytest.raises(IndexError):
        image.pixel_of(np.array([440]))
    with pytest.raises(IndexError):
        image.raster(range(2), range(-1, 5))


def test_an_image_without_points_is_empty() -> None:
    empty = np.empty(0, np.int64)
    for kind in (ImageKind.REVERSIBLE, ImageKind.TRAJECTORY_CENTER):
        image = PointCloudImage(kind, empty, revolutions_of(FOLDS))
        assert (image.rows, image.width, image.drive_count) == (0, 0, 0)
    assert PointCloudImage(ImageKind.TOP_VIEW, empty, 10).rows == 0


@pytest.mark.parametrize("kind", [ImageKind.TRAJECTORY_REVERSIBLE, ImageKind.FEATURE_CENTER])
def test_rows_of_a_street_are_its_revolutions(kind: ImageKind) -> None:
    street = simulated_drive(3, length_m=3.0, multi_return_share=0.1)
    image = PointCloudImage(kind, street.pulse, true_revolutions(street))
    rows, columns = image.pixel_of(np.arange(street.count))
    offset = rows - street.turn
    # A pulse on a fold may go either way by the rounding of its time.
    assert (offset == np.median(offset)).mean() > 0.99
    if kind is ImageKind.TRAJECTORY_REVERSIBLE:
        whole = (street.turn > 0) & (offset == np.median(offset))
        assert np.abs(columns[whole] - street.column[whole]).max() <= 1


def test_kernels_do_the_same_without_the_compiler() -> None:
    image = image_of(ImageKind.FEATURE_CENTER, np.arange(100, 540, 3))
    layout = image.layout
    compiled = image.raster(range(image.rows), range(image.width), 2)
    plain = np.empty_like(compiled)
    raster_kernel.py_func(layout, np.array([0, 2, 0, image.width, image.width]), plain)  # type: ignore[attr-defined]
    assert plain.tolist() == compiled.tolist()
    columns = np.empty(10, np.int32)
    columns_kernel.py_func(layout, np.array([0, 0, image.width]), columns)  # type: ignore[attr-defined]
    assert columns.tolist() == image.columns_of(0, 10).tolist()
    assert first_at.py_func(layout.pulses, 0, 10, 106) == 2  # type: ignore[attr-defined]
    assert first_at_column.py_func(layout, 1, 0) == image.row_starts[1]  # type: ignore[attr-defined]
    assert _column.py_func(layout, 0, 0) == 0  # type: ignore[attr-defined]
