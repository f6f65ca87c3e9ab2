"""The thesis' forests in the laboratory, and pictures of labelled streets."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.image.attributes.colour_maps import EMPTY_COLOUR, class_colours, error_map_colours
from processing.laboratory.class_training import ablations
from processing.laboratory.class_training.ablations import NAMES, PointSample
from processing.laboratory.class_training.pictures import write_label_image
from processing.recording.columns.error_map import ErrorMapValue
from tests.processing.image.recordings import small_drive


def sample(seed: int, telling: int) -> PointSample:
    """Two classes that one feature alone tells apart."""
    rng = np.random.default_rng(seed)
    codes = rng.choice(np.array([5, 66], np.uint8), 600)
    rows = rng.normal(size=(600, len(NAMES))).astype(np.float32)
    rows[:, telling] += 4.0 * (codes == 66)
    return PointSample(rows, codes, {5: 90_000, 66: 10_000})


def test_the_feature_that_tells_classes_apart_is_chosen_and_noise_is_not(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ablations, "_BORUTA_ROUNDS", 12)
    monkeypatch.setattr(ablations, "_BORUTA_TREES", 10)
    telling = NAMES.index("verticality_1m")
    assert ablations._boruta(sample(1, telling), np.random.default_rng(0)) == [telling]
    importance = ablations._importance(ablations._forest(sample(1, telling), range(len(NAMES))))
    assert importance.argmax() == telling


def test_a_street_is_scored_as_if_all_its_points_had_been_asked() -> None:
    # Of nine times as many crowns as poles, a tenth is called a pole: every second pole is none.
    asked = PointSample(
        np.zeros((20, len(NAMES)), np.float32),
        np.repeat(np.array([5, 66], np.uint8), 10),
        {5: 9_000, 66: 1_000},
    )

    class Fixed:
        def predict(self, rows: np.ndarray) -> np.ndarray:
            return np.repeat([66, 5, 66], [1, 9, len(rows) - 10])

    (found,) = ablations._scores(Fixed(), [0], [asked])
    precision = 1_000 / (1_000 + 900)
    pole, crown = 2 * precision / (1 + precision), 2 * 0.9 / 1.9
    assert found == pytest.approx((pole + crown) / 2)


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
