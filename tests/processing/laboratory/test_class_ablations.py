"""The thesis' forests in the laboratory, and pictures of labelled streets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.image.attributes.colour_maps import EMPTY_COLOUR, class_colours, error_map_colours
from processing.laboratory.class_training import forests
from processing.laboratory.class_training.pictures import write_label_image
from processing.laboratory.class_training.point_samples import NAMES, PointSample, sample_of
from processing.recording.columns.error_map import ErrorMapValue
from tests.processing.image.recordings import small_drive


def rows_and_codes(telling: int) -> tuple[np.ndarray, np.ndarray]:
    """Two classes that one feature alone tells apart."""
    rng = np.random.default_rng(1)
    codes = rng.choice(np.array([5, 66], np.uint8), 600)
    rows = rng.normal(size=(600, 40)).astype(np.float32)
    rows[:, telling] += 4.0 * (codes == 66)
    return rows, codes


def test_the_feature_that_tells_classes_apart_is_chosen_and_noise_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(forests, "_BORUTA_ROUNDS", 12)
    monkeypatch.setattr(forests, "_BORUTA_TREES", 10)
    rows, codes = rows_and_codes(telling=17)
    assert forests.boruta(rows, codes, np.random.default_rng(0)).tolist() == [17]
    assert forests.importance_of(forests.fitted_forest(rows, codes)).argmax() == 17


def test_a_street_is_scored_as_if_all_its_points_had_been_asked() -> None:
    # Of nine times as many crowns as poles, a tenth is called a pole: every second pole is none.
    true = np.repeat(np.array([5, 66], np.uint8), 10)
    found = np.repeat(np.array([66, 5, 66], np.uint8), [1, 9, 10])
    score = forests.whole_score(true, found, {5: 9_000, 66: 1_000})
    precision = 1_000 / (1_000 + 900)
    pole, crown = 2 * precision / (1 + precision), 2 * 0.9 / 1.9
    assert forests.mean_f(score) == pytest.approx((pole + crown) / 2)


def test_a_sample_has_points_of_every_class_with_their_features_and_survives_its_file(
    tmp_path: Path,
) -> None:
    drive, _ = small_drive(tmp_path / "d")
    labels = np.full(drive.count, 11, np.uint8)
    labels[:40], labels[40:60], labels[60:70] = 5, 7, 0
    found = sample_of(drive, labels, most=30)
    assert np.unique(found.codes, return_counts=True)[1].tolist() == [30, 20, 30]
    assert found.counts == {5: 40, 7: 20, 11: drive.count - 70}
    np.testing.assert_array_equal(found.codes, labels[found.points])
    heights = found.values([NAMES.index("height")])[:, 0]
    np.testing.assert_allclose(heights, drive.xyz(found.points)[:, 2], rtol=1e-6)
    found.write(tmp_path / "sample.npz")
    read = PointSample.read(tmp_path / "sample.npz").asked()
    assert set(read.codes.tolist()) == {5, 11}  # noise is never asked
    assert read.counts == found.counts


def test_a_labelled_street_is_painted_with_what_is_wrong(tmp_path: Path) -> None:
    import cv2

    drive, _ = small_drive(tmp_path / "d")
    truth = np.full(drive.count, 11, np.uint8)
    found = truth.copy()
    found[::2] = 5
    truth[:100] = 0
    path = tmp_path / "pictures" / "street.png"
    write_label_image(drive, truth, found, path)
    picture = cv2.imread(str(path))
    assert picture is not None
    pixels = picture[:, :, ::-1]
    panels = np.split(pixels, 4, axis=1)
    colours = {tuple(one) for one in panels[2].reshape(-1, 3).tolist()}
    wanted = {tuple(class_colours()[code].tolist()) for code in (5, 11)}
    assert colours == {*wanted, EMPTY_COLOUR}
    shown = {tuple(one) for one in panels[3].reshape(-1, 3).tolist()}
    assert tuple(error_map_colours()[ErrorMapValue.WRONGLY_REMOVED].tolist()) in shown
    assert tuple(error_map_colours()[ErrorMapValue.RIGHTLY_REMOVED].tolist()) in shown
