"""Toned intensity: the fall with range is taken out, dark and bright are read together."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.stats import spearmanr

from processing.image.attributes.attributes import colours
from processing.image.attributes.toned_intensity import ToneCurve, toned_intensity
from tests.processing.image.recordings import small_drive


def test_even_asphalt_is_as_bright_far_off_as_near_by_and_paint_stays_brighter() -> None:
    random = np.random.default_rng(7)
    ranges = random.uniform(2.0, 30.0, 60_000)
    is_paint = random.random(ranges.size) < 0.1
    reflected = np.where(is_paint, 0.6, 0.1) * random.uniform(0.9, 1.1, ranges.size)
    values = 60_000.0 * reflected / ranges**1.5
    curve = ToneCurve(values, ranges)
    tones = curve.tones(values, ranges, 2.0, 98.0).astype(float)
    near, far = (ranges < 6.0) & ~is_paint, (ranges > 24.0) & ~is_paint
    assert abs(np.median(tones[near]) - np.median(tones[far])) < 10.0
    assert np.median(tones[near]) > 50.0
    assert np.median(tones[is_paint & (ranges > 24.0)]) > np.median(tones[far]) + 60.0
    plain = ToneCurve(values, None).tones(values, None, 2.0, 98.0).astype(float)
    assert abs(np.median(plain[near]) - np.median(plain[far])) > 60.0


def test_a_wall_seen_askew_is_as_bright_as_one_that_faces_the_scanner() -> None:
    random = np.random.default_rng(8)
    facing = random.uniform(0.1, 1.0, 60_000)
    ranges = random.uniform(2.0, 30.0, facing.size)
    is_paint = random.random(facing.size) < 0.1
    reflected = np.where(is_paint, 0.6, 0.1) * random.uniform(0.9, 1.1, facing.size)
    values = 60_000.0 * reflected * facing / ranges
    curve = ToneCurve(values, ranges, facing)
    tones = curve.tones(values, ranges, 2.0, 98.0, facing=facing).astype(float)
    askew, square = (facing < 0.25) & ~is_paint, (facing > 0.85) & ~is_paint
    assert abs(np.median(tones[askew]) - np.median(tones[square])) < 12.0
    assert np.median(tones[is_paint]) > np.median(tones[~is_paint]) + 60.0
    plain = ToneCurve(values, ranges).tones(values, ranges, 2.0, 98.0).astype(float)
    assert abs(np.median(plain[askew]) - np.median(plain[square])) > 40.0


def test_points_without_a_normal_are_toned_by_range_alone() -> None:
    random = np.random.default_rng(9)
    values, ranges = random.uniform(1.0, 9.0, 5_000), random.uniform(2.0, 30.0, 5_000)
    facing = np.full(5_000, np.nan)
    tones = ToneCurve(values, ranges, facing).tones(values, ranges, 2.0, 98.0, facing=facing)
    assert np.array_equal(tones, ToneCurve(values, ranges).tones(values, ranges, 2.0, 98.0))


def test_without_a_trajectory_tones_follow_the_intensity_and_fill_the_scale(
    tmp_path: Path,
) -> None:
    drive, _ = small_drive(tmp_path / "d")
    points = np.arange(drive.count)
    values = np.asarray(drive.columns["intensity"][points], float)
    shown = toned_intensity(drive, points, 2.0, 98.0)
    assert spearmanr(values, shown).statistic > 0.9
    assert shown.min() == 0
    assert shown.max() == 255


def test_a_tone_is_that_of_the_point_however_many_are_asked_for(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    points = np.arange(drive.count)
    whole = toned_intensity(drive, points, 2.0, 98.0)
    some = points[5::97].reshape(-1, 1)
    assert np.array_equal(toned_intensity(drive, some, 2.0, 98.0), whole[some])


def test_height_and_intensity_keep_the_hue_of_height_and_its_light_follows_intensity(
    tmp_path: Path,
) -> None:
    drive, _ = small_drive(tmp_path / "d")
    points = np.arange(0, drive.count, 3)
    height = colours(drive, points, "height", 2.0, 98.0).astype(float)
    both = colours(drive, points, "relief", 2.0, 98.0).astype(float)
    share = both.sum(axis=1) / np.maximum(height.sum(axis=1), 1.0)
    assert share.min() > 0.3
    assert share.max() <= 1.0
    tones = toned_intensity(drive, points, 2.0, 98.0)
    assert np.corrcoef(share, tones)[0, 1] > 0.98
