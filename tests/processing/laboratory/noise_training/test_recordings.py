"""Recordings with known noise: they hold what they claim to hold, and are kept."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.noise_training import recordings
from processing.laboratory.noise_training.recordings import (
    AIRBORNE,
    SCANS,
    STANDING,
    VARIED,
    RecordedScene,
    recorded_scene,
    thin_scene,
)

_SEED = 10  # measured by phase


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Path]:
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(recordings, "_PULSES", (60_000, 60_001))
        yield tmp_path_factory.mktemp("recordings")


@pytest.fixture(scope="module")
def scene(folder: Path) -> RecordedScene:
    return recorded_scene(STANDING, _SEED, folder)


def test_a_kept_recording_is_taken_again(folder: Path, scene: RecordedScene) -> None:
    (kept,) = folder.glob("standing-*.npz")
    written = kept.stat().st_mtime_ns
    again = recorded_scene(STANDING, _SEED, folder)
    assert kept.stat().st_mtime_ns == written
    np.testing.assert_array_equal(again.xyz, scene.xyz)
    np.testing.assert_array_equal(again.labels, scene.labels)
    assert again.beams is not None


def test_a_scene_holds_noise_and_true_things_and_its_points_lie_on_their_beams(
    scene: RecordedScene,
) -> None:
    assert 0.002 < scene.is_noise.mean() < 0.6
    assert (scene.labels == 11).mean() > 0.05
    assert scene.beams is not None
    lengths = np.linalg.norm(scene.beams.xyz - scene.beams.origins, axis=1)
    np.testing.assert_allclose(lengths, scene.beams.ranges, atol=1e-6)
    assert scene.beams.row_starts[-1] == scene.labels.size


def test_a_flight_has_noise_below_the_ground_and_above(tmp_path: Path) -> None:
    labels = recorded_scene(AIRBORNE, 4, tmp_path).labels
    assert 0 < (labels == 7).mean() < 0.01
    assert 0 < (labels == 18).mean() < 0.01


def test_a_part_of_a_scene_keeps_its_beams_with_their_rows(scene: RecordedScene) -> None:
    kept = np.arange(scene.labels.size) % 3 > 0
    part = scene.chosen(kept)
    assert part.beams is not None
    assert scene.beams is not None
    assert part.beams.row_starts[-1] == part.labels.size == kept.sum()
    rows = np.searchsorted(scene.beams.row_starts, np.flatnonzero(kept), "right")
    own = np.searchsorted(part.beams.row_starts, np.arange(part.labels.size), "right")
    np.testing.assert_array_equal(
        np.diff(part.beams.row_starts), np.bincount(rows - 1, minlength=own.max())
    )


def test_a_thinned_cloud_is_a_part_of_the_scene(scene: RecordedScene) -> None:
    sizes = {thin_scene(scene, seed).labels.size for seed in range(6)}
    assert max(sizes) <= scene.labels.size
    assert len(sizes) > 2


def test_scans_of_a_street_are_one_cloud_without_beams(folder: Path) -> None:
    scene = recorded_scene(SCANS, 302, folder, VARIED)
    assert scene.beams is None
    assert scene.is_noise.any()
    np.testing.assert_allclose(scene.xyz.mean(axis=0), 0.0, atol=5.0)
