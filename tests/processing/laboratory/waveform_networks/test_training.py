"""Networks of tiny sizes learn a step, and are the same from their files."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.laboratory.waveform_networks.patches import FirstReturns, Patch
from processing.laboratory.waveform_networks.sizes import NetworkSizes
from processing.laboratory.waveform_networks.training import (
    GLOBAL,
    GLOBAL_POINTS,
    LOCAL,
    LOCAL_POINTS,
    WHOLE_PATCH,
    Lesson,
    as_local_network,
    as_recorded,
    class_weights,
    patch_shares,
    read_trained,
    trained_network,
    write_trained,
)
from processing.methods.waveforms.local_network import shares_of

SIZES = NetworkSizes().scaled(1 / 64, 120)


@pytest.fixture
def patch() -> Patch:
    rng = np.random.default_rng(2)
    xyz = rng.uniform((1_000, 2_000, 0), (1_012, 2_012, 3), (120, 3))
    waves = (rng.uniform(0, 1, (120, 160)) ** 6).astype(np.float16)
    return FirstReturns(xyz, waves, rng.integers(-1, 6, 120)).patch(np.arange(120))


def test_rare_classes_weigh_more_and_none_without_bound(patch: Patch) -> None:
    weights = class_weights([patch])
    counts = np.bincount(patch.classes[patch.classes >= 0], minlength=6)
    np.testing.assert_allclose(weights, 1 / np.log(1.2 + counts / counts.sum()))
    assert weights.max() < 1 / np.log(1.2) + 1e-9


def test_what_is_learnt_from_is_turned_and_cleaned_of_its_noise(patch: Patch) -> None:
    seen = as_recorded(patch, np.random.default_rng(0))
    assert (seen.waves >= 0).all()
    np.testing.assert_allclose(seen.xyz[:, 2], patch.xyz[:, 2], atol=1e-5)
    assert np.abs(seen.waves - patch.waves).max() < 0.2


@pytest.mark.parametrize("kind", [LOCAL, LOCAL_POINTS, GLOBAL, GLOBAL_POINTS, WHOLE_PATCH])
def test_a_network_learns_and_is_the_same_from_its_file(
    kind: str, patch: Patch, tmp_path: Path
) -> None:
    pytest.importorskip("torch")
    said: list[str] = []
    network = trained_network(kind, SIZES, [patch], Lesson(2, said.append, 60))
    assert len(said) == 2
    shares = patch_shares(network, kind, SIZES, patch)
    assert shares.shape == (120, 6)
    np.testing.assert_allclose(shares.sum(axis=1), 1, atol=1e-5)
    write_trained(network, tmp_path / "n.pt")
    again = read_trained(kind, SIZES, tmp_path / "n.pt")
    np.testing.assert_allclose(patch_shares(again, kind, SIZES, patch), shares, atol=1e-6)
    if kind == LOCAL:
        carried = as_local_network(network)
        own = shares_of(carried.scores(carried.maps(patch.waves)))
        np.testing.assert_allclose(own, shares, atol=1e-5)
