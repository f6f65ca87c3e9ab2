"""What labels alone make of points whose things are known."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.accuracy.labels_against_tools import (
    LabelledStreet,
    corrections_of,
    features_of_labels,
)


def _column(x: float, y: float, height_m: float) -> np.ndarray:
    up = np.arange(0.0, height_m, 0.05)
    return np.column_stack([np.full(up.size, x), np.full(up.size, y), up])


def test_what_hangs_together_is_one_thing_at_its_foot() -> None:
    pole, trunk = _column(0.0, 0.0, 6.0), _column(10.0, 0.0, 3.0)
    rng = np.random.default_rng(1)
    crown = rng.normal((10.0, 0.0, 4.0), 0.4, (300, 3))
    plate = rng.uniform((4.7, 0.0, 2.0), (5.3, 0.0, 2.6), (60, 3))
    along = np.arange(0.0, 8.0, 0.05)
    curb = np.concatenate(
        [
            np.column_stack([along, np.full(along.size, 3.0), np.full(along.size, z)])
            for z in (0, 0.15)
        ]
    )
    xyz = np.concatenate([pole, trunk, crown, plate, curb])
    sizes = [len(one) for one in (pole, trunk, crown, plate, curb)]
    codes = np.repeat(np.array([66, 66, 5, 65, 67], np.uint8), sizes)
    found = features_of_labels(xyz, codes)
    assert [len(found[tool].features) for tool in ("poles", "trees", "signs")] == [1, 1, 1]
    assert found["poles"].features[0].xyz[0] == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    assert found["trees"].features[0].xyz[0] == pytest.approx((10.0, 0.0, 0.0), abs=1e-6)
    assert found["signs"].features[0].xyz[0] == pytest.approx((5.0, 0.0, 2.3), abs=0.05)
    edges = {one.facts["edge"]: one.xyz for one in found["curbs"].features}
    assert edges["upper"][:, 2] == pytest.approx(0.15)
    assert edges["lower"][:, 2] == pytest.approx(0.0)
    assert np.ptp(edges["upper"][:, 0]) > 6.0


def test_wrong_points_that_touch_are_one_correction() -> None:
    side = np.arange(0.05, 1.0, 0.1)
    patch = np.stack(np.meshgrid(side, side, [0.0]), axis=-1).reshape(-1, 3)
    xyz = np.concatenate([patch, patch + np.array([5.0, 0.0, 0.0]), [[20.0, 0.0, 0.0]]])
    true = np.full(len(xyz), 2, np.uint8)
    street = LabelledStreet(xyz, true, np.full(len(xyz), 11, np.uint8))
    assert corrections_of(street) == {2: 2}
    assert not corrections_of(LabelledStreet(xyz, true, true))
