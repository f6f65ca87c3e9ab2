"""Waveforms of a drive: whose they are, where they lie in space, and what is told of bad ones."""

from __future__ import annotations

import shutil
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile
from processing.core.monitor import SilentMonitor
from processing.recording.drive import Drive
from processing.recording.drive_part import write_part
from processing.recording.waveform_facts import waveform_facts
from processing.recording.waveform_packets.descriptors import NoPacket
from processing.recording.waveforms import Waveforms, waveforms_of
from tests.waveform_flight import (
    FLYING_HEIGHT_M,
    SAMPLES,
    Flight,
    change_descriptor,
    change_points,
    import_flight,
    put_packets_inside,
    write_flight,
)


def _waveforms(drive: Drive) -> Waveforms:
    found = waveforms_of(drive)
    assert found is not None
    return found


def _delivered(drive: Drive) -> NDArray[np.int64]:
    """The index in the file of each of the drive's points."""
    return drive.sources(0, drive.count)[1]


@pytest.fixture(scope="module")
def flight(tmp_path_factory: pytest.TempPathFactory) -> Flight:
    return write_flight(tmp_path_factory.mktemp("flight") / "航空.las")


@pytest.fixture(scope="module")
def drive(flight: Flight, tmp_path_factory: pytest.TempPathFactory) -> Drive:
    return import_flight(flight.path, tmp_path_factory.mktemp("import") / "into")


def test_every_point_finds_the_samples_that_were_written_for_its_pulse(
    flight: Flight, drive: Drive
) -> None:
    waveforms, delivered = _waveforms(drive), _delivered(drive)
    samples = waveforms.samples_of(waveforms.pulse_of(slice(0, drive.count)))
    np.testing.assert_array_equal(samples, flight.counts[flight.pulse[delivered]])
    places = waveforms.location_ns(np.arange(drive.count))
    np.testing.assert_allclose(places, flight.place_ns[delivered], atol=1e-3)


def test_a_pulse_with_two_returns_belongs_to_the_first_and_knows_both(
    flight: Flight, drive: Drive
) -> None:
    waveforms = _waveforms(drive)
    assert waveforms.count == 60
    pulses = waveforms.pulses(slice(0, 60))
    np.testing.assert_array_equal(pulses.returns, 1 + (np.arange(60) % 3 == 0))
    assert (drive.columns["return_number"][pulses.owners] == 1).all()
    heights = drive.xyz(waveforms.points_of(0))[:, 2]
    np.testing.assert_allclose(heights, [3.0, 0.0], atol=0.01)
    owned = waveforms.are_owners(slice(0, drive.count))
    assert owned.sum() == 60
    assert set(np.flatnonzero(owned)) == set(pulses.owners)


@pytest.mark.parametrize("flipped", [False, True])
def test_later_samples_lie_farther_from_the_sensor_whatever_sign_the_writer_used(
    tmp_path: Path, flipped: bool
) -> None:
    flight = write_flight(tmp_path / "a.las", flipped=flipped)
    waveforms = _waveforms(drive := import_flight(flight.path, tmp_path / "into"))
    assert (waveforms.files[0].towards_sensor, waveforms.files[0].sign_by) == (
        not flipped,
        "returns",
    )
    pulses = waveforms.pulses(slice(0, waveforms.count))
    assert (pulses.direction[:, 2] < 0).all()
    np.testing.assert_allclose(np.linalg.norm(pulses.direction, axis=1), 0.149896, rtol=1e-4)
    points = np.arange(drive.count)
    rows = waveforms.pulse_of(points)
    places = pulses.xyz_at(rows, waveforms.location_ns(points))
    np.testing.assert_allclose(places, drive.xyz(points), atol=2e-3)


def test_light_of_lone_returns_that_goes_down_comes_from_a_flight(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las", flipped=True)

    def keep_first(fields: NDArray[np.void]) -> None:
        fields["descriptor"][np.diff(fields["byte"].astype(np.int64), prepend=0) == 0] = 0

    change_points(flight.path, keep_first)
    waveforms = _waveforms(import_flight(flight.path, tmp_path / "into"))
    assert (waveforms.files[0].towards_sensor, waveforms.files[0].sign_by) == (False, "down")


def test_blocks_give_every_pulse_once_and_the_same_samples(drive: Drive) -> None:
    waveforms = _waveforms(drive)
    blocks = list(waveforms.blocks(17))
    numbers = np.concatenate([block.pulses.numbers for block in blocks])
    np.testing.assert_array_equal(numbers, np.arange(waveforms.count))
    whole = waveforms.samples_of(numbers)
    np.testing.assert_array_equal(np.concatenate([block.samples for block in blocks]), whole)
    assert max(len(block.samples) for block in blocks) == 17


@pytest.mark.parametrize("bits", [8, 16, 32])
def test_unsigned_samples_of_all_widths_are_read(tmp_path: Path, bits: int) -> None:
    flight = write_flight(tmp_path / "a.las", bits=bits, spacing_ps=500)
    waveforms = _waveforms(import_flight(flight.path, tmp_path / "into"))
    pulses = waveforms.pulses(slice(0, 1))
    assert (waveforms.descriptors[0].bits, pulses.interval_ns[0]) == (bits, 0.5)
    assert (pulses.gain[0], pulses.offset[0]) == (0.5, -2.0)
    np.testing.assert_array_equal(waveforms.samples_of(np.array([0])), flight.counts[:1])


def test_packets_inside_the_file_are_read_as_those_beside_it(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    put_packets_inside(flight.path)
    waveforms = _waveforms(import_flight(flight.path, tmp_path / "into"))
    np.testing.assert_array_equal(waveforms.samples_of(np.arange(60)), flight.counts)


def test_a_writer_that_counts_from_behind_the_records_header_is_understood(
    tmp_path: Path,
) -> None:
    flight = write_flight(tmp_path / "a.las")

    def count_from_zero(fields: NDArray[np.void]) -> None:
        fields["byte"] -= np.uint64(60)

    change_points(flight.path, count_from_zero)
    waveforms = _waveforms(import_flight(flight.path, tmp_path / "into"))
    np.testing.assert_array_equal(waveforms.samples_of(np.arange(60)), flight.counts)


def test_waveforms_stay_when_the_delivered_files_are_gone(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    drive = import_flight(flight.path, tmp_path / "into")
    flight.path.unlink()
    flight.path.with_suffix(".wdp").unlink()
    np.testing.assert_array_equal(_waveforms(drive).samples_of(np.arange(60)), flight.counts)


def test_a_part_of_a_drive_has_the_waveforms_of_its_points(drive: Drive, tmp_path: Path) -> None:
    def is_first(start: int, stop: int) -> NDArray[np.bool_]:
        return np.asarray(drive.columns["return_number"][start:stop] == 1)

    part = write_part(drive, is_first, tmp_path / "part", SilentMonitor(), beside=lambda a, b: {})
    waveforms = _waveforms(part)
    assert (waveforms.count, waveforms.point_count) == (60, 60)
    np.testing.assert_array_equal(
        waveforms.samples_of(np.arange(60)), _waveforms(drive).samples_of(np.arange(60))
    )


def test_the_index_is_made_again_when_it_is_gone(drive: Drive, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(drive.folder, copy)
    for file in copy.glob("pulse_*.bin"):
        file.unlink()
    assert _waveforms(Drive(copy)).count == 60


def _beyond(fields: NDArray[np.void]) -> None:
    fields["byte"][:5] = 1 << 40


def _overflow(fields: NDArray[np.void]) -> None:
    fields["byte"][:5] = np.uint64(2**64 - 1)


def _unknown(fields: NDArray[np.void]) -> None:
    fields["descriptor"][:5] = 9


def _other_size(fields: NDArray[np.void]) -> None:
    fields["size"][:5] = 4_000_000_000


def _without(fields: NDArray[np.void]) -> None:
    fields["descriptor"][:5] = 0


@pytest.mark.parametrize(
    ("spoil", "why"),
    [
        (_beyond, NoPacket.BEYOND_FILE),
        (_overflow, NoPacket.BEYOND_FILE),
        (_unknown, NoPacket.UNKNOWN_DESCRIPTOR),
        (_other_size, NoPacket.OTHER_SIZE),
        (_without, NoPacket.NONE_GIVEN),
    ],
)
def test_points_whose_packet_is_bad_are_used_without_it_and_counted(
    tmp_path: Path, spoil: Callable[[NDArray[np.void]], None], why: NoPacket
) -> None:
    flight = write_flight(tmp_path / "a.las")
    change_points(flight.path, spoil)
    drive = import_flight(flight.path, tmp_path / "into")
    facts = waveform_facts(drive)
    assert facts is not None
    assert drive.count == len(flight.xyz)
    assert facts.lacking == {why: 5}
    assert facts.points == drive.count - 5
    assert bool(facts.remarks) == (why is not NoPacket.NONE_GIVEN)
    assert _waveforms(drive).pulse_of(np.flatnonzero(_delivered(drive) == 0)).tolist() == [-1]


@pytest.mark.parametrize("samples", [0, 5_000_000, SAMPLES + 1])
def test_descriptors_that_cannot_be_leave_the_points(tmp_path: Path, samples: int) -> None:
    flight = write_flight(tmp_path / "a.las")
    change_descriptor(flight.path, samples=samples)
    drive = import_flight(flight.path, tmp_path / "into")
    facts = waveform_facts(drive)
    assert drive.count == len(flight.xyz)
    assert waveforms_of(drive) is None
    assert facts is not None
    assert facts.pulses == 0
    assert len(facts.remarks) == 1


def test_a_packet_file_cut_short_loses_the_last_waveforms_only(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    beside = flight.path.with_suffix(".wdp")
    beside.write_bytes(beside.read_bytes()[: 60 + 30 * SAMPLES])
    drive = import_flight(flight.path, tmp_path / "into")
    assert _waveforms(drive).count == 30
    facts = waveform_facts(drive)
    assert facts is not None
    assert facts.lacking == {NoPacket.BEYOND_FILE: 40}


@pytest.mark.parametrize("inside", [False, True])
def test_missing_packets_are_told_with_the_file_and_the_points_are_kept(
    tmp_path: Path, inside: bool
) -> None:
    flight = write_flight(tmp_path / "a.las")
    if inside:
        put_packets_inside(flight.path)
        data = flight.path.read_bytes()
        flight.path.write_bytes(data[: len(data) - 60 - 60 * SAMPLES])
    else:
        flight.path.with_suffix(".wdp").unlink()
    if inside:
        with pytest.raises(BadFile):
            import_flight(flight.path, tmp_path / "into")
        return
    drive = import_flight(flight.path, tmp_path / "into")
    facts = waveform_facts(drive)
    assert waveforms_of(drive) is None
    assert facts is not None
    assert "a.wdp" in facts.remarks[0].en
    assert drive.count == len(flight.xyz)


def test_compressed_samples_are_refused_in_a_sentence_and_the_points_kept(tmp_path: Path) -> None:
    flight = write_flight(tmp_path / "a.las")
    change_descriptor(flight.path, samples=SAMPLES, compression=7)
    flight.path.with_suffix(".wdp").rename(tmp_path / "a.wdz")
    drive = import_flight(flight.path, tmp_path / "into")
    facts = waveform_facts(drive)
    assert waveforms_of(drive) is None
    assert facts is not None
    assert "compress" in facts.remarks[0].en


def test_rays_reach_the_flying_height_at_the_time_light_takes(flight: Flight, drive: Drive) -> None:
    pulses = _waveforms(drive).pulses(slice(0, 5))
    up_m = FLYING_HEIGHT_M - pulses.anchor[:, 2]
    sensor = pulses.xyz_at(np.arange(5), up_m / pulses.direction[:, 2])
    np.testing.assert_allclose(sensor[:, 0], 0.0, atol=0.5)


def test_a_damaged_description_of_the_packets_is_told(drive: Drive, tmp_path: Path) -> None:
    copy = tmp_path / "copy"
    shutil.copytree(drive.folder, copy)
    (copy / "waveforms.json").write_text("{")
    with pytest.raises(BadFile):
        waveforms_of(Drive(copy))
