"""Pixel and point lead to each other, exactly, whatever was lost, returned twice or stopped."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.image.point_image import PointCloudImage
from processing.recording.kinds import ImageKind
from tests.processing.image.recordings import random_recording

KINDS = st.sampled_from(
    [
        ImageKind.TRAJECTORY_CENTER,
        ImageKind.FEATURE_CENTER,
        ImageKind.REVERSIBLE,
        ImageKind.TRAJECTORY_REVERSIBLE,
    ]
)
ONE_TO_ONE = st.sampled_from([ImageKind.REVERSIBLE, ImageKind.TRAJECTORY_REVERSIBLE])


@st.composite
def images(draw: st.DrawFn, kinds: st.SearchStrategy[ImageKind] = KINDS) -> PointCloudImage:
    recording = random_recording(
        draw(st.integers(0, 10_000)),
        pulses_per_revolution=draw(st.integers(4, 40)),
        revolutions=draw(st.integers(1, 12)),
        lost_share=draw(st.sampled_from([0.0, 0.2, 0.9])),
        double_share=draw(st.sampled_from([0.0, 0.3])),
        # At 1,000 pulses a second: none, missing returns, a stop.
        stop_pulses=draw(st.sampled_from([0, 300, 5000])),
    )
    return PointCloudImage(draw(kinds), recording.pulses, recording.revolutions)


@given(images())
@settings(max_examples=150)
def test_every_point_is_in_exactly_one_pixel(image: PointCloudImage) -> None:
    points = np.arange(image.drive_count)
    rows, columns = image.pixel_of(points)
    assert image.row_starts[0] == 0
    assert image.row_starts[-1] == image.drive_count
    assert rows.min() >= 0
    assert rows.max() < image.rows
    assert columns.min() >= 0
    assert columns.max() < image.width
    found = [
        image.points_at(row, column) for row in range(image.rows) for column in range(image.width)
    ]
    assert sorted(np.concatenate(found).tolist()) == points.tolist()


@given(images())
@settings(max_examples=100)
def test_the_points_of_a_pixel_have_that_pixel(image: PointCloudImage) -> None:
    for row in range(image.rows):
        for column in range(image.width):
            rows, columns = image.pixel_of(image.points_at(row, column))
            assert (rows == row).all()
            assert (columns == column).all()


@given(images())
@settings(max_examples=100)
def test_columns_of_consecutive_points_are_those_of_single_points(image: PointCloudImage) -> None:
    _, columns = image.pixel_of(np.arange(image.drive_count))
    middle = image.drive_count // 2
    assert image.columns_of(0, image.drive_count).tolist() == columns.tolist()
    assert image.columns_of(middle, image.drive_count).tolist() == columns[middle:].tolist()


@given(images(ONE_TO_ONE))
@settings(max_examples=100)
def test_a_pixel_holds_one_pulse_and_a_pulse_one_pixel(image: PointCloudImage) -> None:
    pulses = image.layout.pulses
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    pixels = rows * image.width + columns
    assert ((np.diff(pixels) == 0) == (np.diff(pulses) == 0)).all()


@given(images(ONE_TO_ONE))
@settings(max_examples=100)
def test_consecutive_shots_are_neighbours_except_at_row_ends(image: PointCloudImage) -> None:
    pulses = image.layout.pulses
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    is_next = np.diff(pulses) == 1
    is_same_row = np.diff(rows) == 0
    assert (np.diff(columns)[is_next & is_same_row] == 1).all()
    assert (np.diff(rows)[is_next & ~is_same_row] == 1).all()


@given(images(), st.integers(1, 7), st.data())
@settings(max_examples=150)
def test_rasters_of_any_step_show_what_points_at_shows(
    image: PointCloudImage, step: int, data: st.DataObject
) -> None:
    top = data.draw(st.integers(0, image.rows - 1))
    left = data.draw(st.integers(0, image.width - 1))
    rows = range(top, data.draw(st.integers(top, image.rows)))
    columns = range(left, data.draw(st.integers(left, image.width)))
    raster = image.raster(rows, columns, step)
    assert raster.shape == (-(-len(rows) // step), -(-len(columns) // step))
    for i, row in enumerate(rows[::step]):
        for j, first in enumerate(columns[::step]):
            pixels = [
                image.points_at(row, column)
                for column in range(first, min(first + step, columns.stop))
            ]
            shown = next((int(points[0]) for points in pixels if points.size), -1)
            assert raster[i, j] == shown


@given(images())
@settings(max_examples=100)
def test_no_row_is_empty_but_inside_a_gap_of_at_most_a_second(image: PointCloudImage) -> None:
    counts = np.diff(image.row_starts)
    for row in np.flatnonzero(counts == 0):
        after = image.row_starts[row]
        gap = image.layout.pulses[after] - image.layout.pulses[after - 1]
        assert gap <= 1000


@given(images())
@settings(max_examples=100)
def test_a_stop_of_five_seconds_begins_a_segment(image: PointCloudImage) -> None:
    rows, _ = image.pixel_of(np.arange(image.drive_count))
    after = np.flatnonzero(np.diff(image.layout.pulses) > 4000) + 1
    first_rows = rows[after]
    assert (image.segments[first_rows] != image.segments[rows[after - 1]]).all()
    assert np.isin(first_rows, image.split_rows).all()


@given(images(ONE_TO_ONE))
@settings(max_examples=100)
def test_a_fixed_raster_and_its_overflow_hold_every_point(image: PointCloudImage) -> None:
    raster = image.fixed_raster(range(image.rows))
    assert raster.points.shape == (image.rows, min(image.mode_width, image.width))
    rows, columns = image.pixel_of(np.arange(image.drive_count))
    inside = columns < raster.points.shape[1]
    assert raster.overflow.tolist() == np.flatnonzero(~inside).tolist()
    assert raster.row_of_point.tolist() == rows.tolist()
    assert raster.column_of_point[inside].tolist() == columns[inside].tolist()
    for point in raster.overflow:
        row, column = rows[point], raster.column_of_point[point]
        filled = np.flatnonzero(raster.points[row] >= 0)
        assert column == (filled[-1] if filled.size else -1)


@given(st.integers(0, 1000), st.integers(1, 9), st.integers(1, 200))
@settings(max_examples=100)
def test_a_top_view_shows_the_first_point_of_each_cell(
    seed: int, cells_per_row: int, count: int
) -> None:
    random = np.random.default_rng(seed)
    cells = np.sort(random.integers(0, 60, count))
    image = PointCloudImage(ImageKind.TOP_VIEW, cells, cells_per_row)
    rows, columns = image.pixel_of(np.arange(count))
    assert (rows * cells_per_row + columns).tolist() == cells.tolist()
    raster = image.raster(range(image.rows), range(image.width)).ravel()
    for cell in range(raster.size):
        points = np.flatnonzero(cells == cell)
        assert raster[cell] == (points[0] if points.size else -1)
