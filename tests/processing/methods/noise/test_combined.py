"""The combined method: finds noise of known kinds, keeps wires and poles, says no nonsense."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.monitor import SilentMonitor
from processing.core.owned_files import MARK
from processing.methods.noise import drive_noise
from processing.methods.noise.beams.beam_origins import beam_origins
from processing.methods.noise.combined import noise_codes_in_space, noise_codes_with_beams
from processing.methods.noise.drive_noise import NoiseSearch
from processing.methods.noise.row_chunks import row_chunks_of
from processing.recording.drive import Drive
from processing.tools.noise import NOISE, NoiseParameters
from processing.tools.running.runner import RunRequest, columns_of, run
from processing.tools.tool import FinishedColumns
from tests.noisy_street import POLE, NoisyStreet, noisy_street
from tests.processing.image.recordings import drive_of, without_revolutions

Codes = NDArray[np.uint8]


@pytest.fixture(scope="module")
def street() -> NoisyStreet:
    return noisy_street(5, length_m=16.0, pulses_per_revolution=600.0)


@pytest.fixture(scope="module")
def drive(street: NoisyStreet, tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return drive_of(street.drive, tmp_path_factory.mktemp("noisy") / "d")


@pytest.fixture(scope="module")
def found(drive: Drive) -> Mapping[str, Codes]:
    """Give the classes by each method."""
    return {
        method: codes_of(drive, NoiseParameters(method=method))
        for method in ("combined", "radius", "statistical")
    }


def codes_of(drive: Drive, parameters: NoiseParameters) -> Codes:
    into = drive.folder.parent / "found"
    result = run(RunRequest(NOISE.id, drive, parameters), SilentMonitor(), into=into)
    assert isinstance(result, FinishedColumns)
    assert {path.name for path in into.iterdir()} == {
        "classification.bin",
        "classification.bin.sums",
        MARK,
    }
    codes = np.array(columns_of(result)["classification"])
    result.remove()
    return codes


def f_measure(said: NDArray[np.bool_], truth: NDArray[np.bool_]) -> float:
    """Of the noise."""
    return 2 * (said & truth).sum() / (said.sum() + truth.sum())


def test_noise_is_found_and_told_low_from_high(
    street: NoisyStreet, found: Mapping[str, Codes]
) -> None:
    codes, is_noise = found["combined"], street.noise > 0
    assert 0.03 < is_noise.mean() < 0.1
    assert f_measure(codes > 0, is_noise) >= 0.98
    right = is_noise & (codes > 0)
    assert (codes[right] == street.noise[right]).mean() >= 0.99
    for method in ("radius", "statistical"):
        assert f_measure(found[method] > 0, is_noise) < 0.5


def test_thin_things_are_kept(street: NoisyStreet, found: Mapping[str, Codes]) -> None:
    is_pole = (street.drive.surface == POLE) & (street.noise == 0)
    for thin in (street.is_wire, is_pole):
        assert thin.sum() > 100
        assert (found["combined"][thin] == 0).mean() >= 0.95
        assert (found["radius"][thin] == 0).mean() < 0.5


def test_a_cut_of_the_recording_changes_next_to_nothing(
    drive: Drive, street: NoisyStreet, found: Mapping[str, Codes], tmp_path: Path
) -> None:
    codes = np.zeros(drive.count, np.uint8)
    cut = NoiseSearch(drive, codes, tmp_path, drive.count, points_per_chunk=drive.count // 2)
    cut.combined(0.5, SilentMonitor())
    assert ((codes > 0) != (found["combined"] > 0)).mean() < 0.002
    assert f_measure(codes > 0, street.noise > 0) >= 0.965


def test_strictness_goes_from_nothing_to_everything_doubtful(
    drive: Drive, found: Mapping[str, Codes]
) -> None:
    shares = [
        (codes_of(drive, NoiseParameters(strictness=one)) > 0).mean() for one in (0.0, 0.9, 1.0)
    ]
    assert shares[0] <= (found["combined"] > 0).mean() <= shares[1] < shares[2]
    assert shares[0] < 0.05


def test_without_beams_most_noise_is_found_and_surfaces_stay(
    street: NoisyStreet, tmp_path: Path
) -> None:
    whole = drive_of(street.drive, tmp_path / "d")
    order = np.lexsort(np.round(street.drive.xyz[:, :2], 1).T)
    seen = without_revolutions(whole)
    assert beam_origins(seen) is None
    codes = noise_codes_in_space(street.drive.xyz[order])
    is_noise = street.noise[order] > 0
    assert f_measure(codes > 0, is_noise) >= 0.6
    assert (codes[~is_noise] == 0).mean() >= 0.98
    assert codes_of(seen, NoiseParameters()).any()


def test_without_beams_the_order_of_the_points_says_nothing(street: NoisyStreet) -> None:
    xyz = street.drive.xyz
    other = np.random.default_rng(3).permutation(len(xyz))
    np.testing.assert_array_equal(
        noise_codes_in_space(xyz[other]), noise_codes_in_space(xyz)[other]
    )


def test_without_beams_parts_of_a_cloud_find_what_the_whole_does(
    street: NoisyStreet, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen = without_revolutions(drive_of(street.drive, tmp_path / "d"))
    whole = codes_of(seen, NoiseParameters())
    monkeypatch.setattr(drive_noise, "_POINTS_IN_SPACE", seen.count // 3)
    parts = codes_of(seen, NoiseParameters())
    assert f_measure(parts > 0, whole > 0) >= 0.9


def test_spikes_of_kilometres_are_noise_and_change_nothing_else(drive: Drive) -> None:
    xyz = drive.xyz(slice(0, 20_000)) - drive.xyz(slice(0, 1))
    alone = noise_codes_in_space(xyz)
    spikes = np.array([[1e4, 0.0, 0.0], [0.0, 0.0, -1e6]])
    codes = noise_codes_in_space(np.vstack([xyz[:7], spikes, xyz[7:]]))
    assert codes[7:9].tolist() == [18, 7]
    np.testing.assert_array_equal(np.delete(codes, [7, 8]), alone)


@pytest.mark.parametrize(
    "xyz",
    [
        np.zeros((0, 3)),
        np.zeros((1, 3)),
        np.random.default_rng(0).random((10, 3)),
        np.ones((500, 3)),
        np.column_stack([np.random.default_rng(0).random((500, 2)), np.zeros(500)]),
        np.column_stack([np.arange(500.0), np.zeros((500, 2))]),
    ],
    ids=["empty", "one", "ten", "duplicates", "plane", "line"],
)
def test_strange_clouds_lose_nothing(xyz: NDArray[np.float64]) -> None:
    assert not noise_codes_in_space(xyz).any()


def test_a_crown_without_surfaces_keeps_its_leaves() -> None:
    random = np.random.default_rng(4)
    leaves = random.normal(0, 1, (4_000, 3)) * [3.0, 3.0, 2.0]
    ground = np.column_stack([random.uniform(-5, 5, (300, 2)), random.normal(-6, 0.1, 300)])
    assert not noise_codes_in_space(np.vstack([leaves, ground])).any()


def test_points_without_a_place_are_noise() -> None:
    assert (noise_codes_in_space(np.full((30, 3), np.nan)) == 18).all()


def test_stretches_own_every_row_once_and_look_some_metres_around() -> None:
    counts = np.full(200, 50)
    row_starts = np.concatenate([[0], np.cumsum(counts)])
    along = np.arange(200) * 1.0
    chunks = list(row_chunks_of(row_starts, along, 1_500))
    assert [row for one in chunks for row in one.rows] == list(range(200))
    second = chunks[1]
    assert second.rows == range(30, 60)
    assert second.with_overlap == range(24, 66)


def test_a_stop_does_not_make_a_stretch_endless() -> None:
    row_starts = np.arange(1_001) * 50
    along = np.concatenate([np.arange(50.0), np.full(900, 50.0), 50 + np.arange(50.0)])
    for one in row_chunks_of(row_starts, along, 1_000):
        looked = row_starts[one.with_overlap.stop] - row_starts[one.with_overlap.start]
        assert looked <= 2_000
        assert one.with_overlap.start <= one.rows.start < one.rows.stop <= one.with_overlap.stop


def test_spikes_in_a_recording_are_left_out_of_its_rows(drive: Drive) -> None:
    from processing.methods.noise.beams.beam_kernels import PointBeams

    rows, width = 40, 60
    positions = np.stack(np.meshgrid(np.arange(rows), np.arange(width), indexing="ij"), -1)
    xyz = np.column_stack([positions.reshape(-1, 2) * 0.05, np.zeros(rows * width)])
    xyz[100] = [0.0, 0.0, 5e4]
    origins = np.column_stack([xyz[:, 0], np.full(len(xyz), 1.5), np.full(len(xyz), 2.0)])
    beams = PointBeams(
        xyz,
        origins,
        np.linalg.norm(xyz - origins, axis=1),
        positions[..., 1].ravel().astype(np.int32),
        np.arange(rows + 1) * width,
        np.zeros(rows, np.int32),
        0.02,
    )
    codes = noise_codes_with_beams(beams, np.full(len(xyz), 500, np.uint16))
    assert codes[100] == 18
    assert (codes > 0).mean() < 0.05


def test_of_a_steep_bank_before_a_tripod_one_point_in_sixty_is_lost_at_most() -> None:
    random = np.random.default_rng(8)
    around, below = random.uniform(0, 2 * np.pi, 60_000), np.radians(random.uniform(8, 80, 60_000))
    directions = np.column_stack(
        [np.cos(below) * np.cos(around), np.cos(below) * np.sin(around), -np.sin(below)]
    )
    ranges = 1.7 / (0.7 * directions[:, 0] - directions[:, 2])
    xyz = directions[(ranges > 0) & (ranges < 25)] * ranges[(ranges > 0) & (ranges < 25), None]
    xyz += random.normal(0, 0.004, xyz.shape)
    assert (noise_codes_in_space(xyz) > 0).mean() < 0.016
