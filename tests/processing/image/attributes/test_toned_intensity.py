"""Toned intensity: the fall with range is taken out, dark and bright are read together."""

from __future__ import annotations

from pathlib import Path

import numpy as np

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


def test_without_a_trajectory_tones_follow_the_curve_alone(tmp_path: Path) -> None:
    drive, _ = small_drive(tmp_path / "d")
    points = np.arange(drive.count)
    values = np.asarray(drive.columns["intensity"][points], float)
    shown = toned_intensity(drive, points, 2.0, 98.0)
    order = np.argsort(values, kind="stable")
    assert (np.diff(shown[order].astype(int)) >= 0).all()
    assert shown.min() == 0
    assert shown.max() == 255


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
