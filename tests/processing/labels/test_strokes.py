"""Points under a brush and of segments, against plain arithmetic over all points."""

from __future__ import annotations

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.labels import strokes
from processing.labels.rules import PaintOver, PaintRule
from processing.labels.strokes import (
    StrokePath,
    points_of_segment,
    points_under_brush,
    segments_of,
    stroke_is_short,
)
from processing.recording.drive import Drive
from tests.widgets.builders import imported_drive


@pytest.fixture(scope="module")
def drive(tmp_path_factory) -> Drive:
    return imported_drive(tmp_path_factory.mktemp("street"))


def distances(drive: Drive, start, end):
    xyz = drive.xyz(slice(0, drive.count))
    along = end - start
    length = along @ along
    share = np.clip((xyz - start) @ along / length, 0, 1) if length else np.zeros(drive.count)
    return np.linalg.norm(xyz - start - share[:, None] * along, axis=1)


@pytest.mark.parametrize("radius_m", [0.05, 0.5, 30.0])
def test_the_brush_takes_exactly_the_points_within_its_radius(drive, radius_m):
    random = np.random.default_rng(2)
    xyz = drive.xyz(slice(0, drive.count))
    for point in random.integers(0, drive.count, 5):
        start = xyz[point]
        for end in (start, start + random.normal(0, 0.4, 3)):
            away = distances(drive, start, end)
            found = points_under_brush(drive, start, end, radius_m)
            # Points at the very edge may fall on either side of it by rounding.
            unsure = np.abs(away - radius_m) < 1e-9
            wanted = np.flatnonzero((away <= radius_m) & ~unsure)
            np.testing.assert_array_equal(found[~unsure[found]], wanted)
            assert (np.diff(found) > 0).all()


def test_a_brush_far_from_everything_takes_nothing(drive):
    far = np.array([0.0, 0.0, 0.0])
    assert points_under_brush(drive, far, far, 1.0).size == 0


def test_the_compiled_loop_does_what_the_plain_one_does(drive):
    integers = np.asarray(drive.columns["xyz"][:300])
    scale, stretches = np.array(drive.info.scale), np.array([[0, 200], [250, 300]])
    stroke = StrokePath(np.stack([integers[10], integers[260]]).astype(float), 0.5)
    plain, compiled = np.empty(300, np.int64), np.empty(300, np.int64)
    kernel = strokes._near_stroke_kernel
    count = kernel.py_func(integers, scale, stretches, stroke, plain)
    assert kernel(integers, scale, stretches, stroke, compiled) == count
    np.testing.assert_array_equal(plain[:count], compiled[:count])
    none = np.empty(0, np.int64)
    assert kernel.py_func(integers, scale, stretches, stroke, none) == count


def test_a_segment_is_all_its_points(tmp_path):
    drive = imported_drive(tmp_path / "a")
    with pytest.raises(Unsuitable):
        segments_of(drive, np.array([0]))
    with pytest.raises(Unsuitable):
        points_of_segment(drive, 1)
    segments = np.arange(drive.count, dtype=np.int32) % 7 - 1
    drive.columns.add("segment", segments)
    np.testing.assert_array_equal(segments_of(drive, np.array([0, 3])), [-1, 2])
    np.testing.assert_array_equal(points_of_segment(drive, 3), np.flatnonzero(segments == 3))


def test_a_jump_from_one_thing_to_another_is_no_way():
    here = np.zeros(3)
    assert stroke_is_short(here, np.array([1.9, 0, 0]), 0.1)
    assert not stroke_is_short(here, np.array([2.1, 0, 0]), 0.1)
    assert stroke_is_short(here, np.array([9.0, 0, 0]), 1.0)


def test_rules_choose_the_points_that_are_painted():
    labels = np.array([0, 2, 6, 11, 6], np.uint8)
    everything = PaintRule(6)
    assert everything.chosen(labels, labels).tolist() == [True, True, False, True, False]
    unlabelled = PaintRule(6, PaintOver.UNLABELLED)
    assert unlabelled.chosen(labels, labels).tolist() == [True, False, False, False, False]
    one_class = PaintRule(0, PaintOver.ONE_CLASS, 6)
    assert one_class.chosen(labels, labels).tolist() == [False, False, True, False, True]
