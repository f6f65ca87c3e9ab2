"""PulseWaves: echoes become points with their pulse's waveform, and go out again as LAS."""

from __future__ import annotations

import struct
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory

import laspy
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.core.errors import BadFile, MissingInput, UserError
from processing.core.monitor import SilentMonitor
from processing.formats.points.point_files import read_chunks, read_info, read_sample
from processing.project.importing.import_request import ImportRequest
from processing.project.importing.importing import import_drives
from processing.project.results.label_export import write_labelled_points
from processing.recording.drive import Drive
from processing.recording.waveform_facts import waveform_facts
from processing.recording.waveform_packets.kept_packets import (
    read_packet_files,
    write_packet_files,
)
from processing.recording.waveforms import Waveforms, waveforms_of
from tests.broken_files.damage import outcome
from tests.pulsewaves_flight import (
    DURATION_OFFSET,
    DURATION_SCALE,
    FLIGHT,
    FLUCTUATES,
    OFFSET,
    SCALE,
    Composition,
    Head,
    PulseFlight,
    PulseOfFile,
    Sampling,
    Wave,
    echo,
    write_pulse_flight,
    write_pulses,
)

_CENTIMETRES_M = 0.02


def _points(path: Path) -> dict[str, np.ndarray]:
    info = read_info(path)
    chunks = [chunk.columns for chunk in read_chunks(path, 50)]
    columns = {name: np.concatenate([one[name] for one in chunks]) for name in chunks[0]}
    columns["xyz"] = columns["xyz"] * np.array(info.scale) + np.array(info.offset)
    return columns


def _drive(path: Path, into: Path) -> Drive:
    (folder,) = import_drives(ImportRequest((path,)), into, SilentMonitor())
    return Drive(folder)


def _waveforms(drive: Drive) -> Waveforms:
    waveforms = waveforms_of(drive)
    assert waveforms is not None
    return waveforms


def _returned(flight: PulseFlight) -> list[tuple[int, Wave]]:
    """The pulse and the segment of each point, of pulses with one channel."""
    return [
        (number, segment)
        for number, pulse in enumerate(flight.pulses)
        for segment in pulse.waves[-1]
    ]


def test_echoes_are_points_within_centimetres_of_truth(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "航空.pls")
    info, points = read_info(flight.path), _points(flight.path)
    assert (info.format, info.crs, info.count) == ("PulseWaves", "EPSG:6677", len(flight.xyz))
    apart = np.linalg.norm(points["xyz"] - flight.xyz, axis=1)
    assert apart.max() < _CENTIMETRES_M
    np.testing.assert_allclose(points["time"], 400_000.0 + 20e-6 * flight.pulse, atol=1e-9)
    returns = 1 + (flight.pulse % 3 == 0)
    assert points["number_of_returns"].tolist() == returns.tolist()
    is_second = np.diff(flight.pulse, prepend=-1) == 0
    assert points["return_number"].tolist() == (1 + is_second).tolist()
    assert np.unique(points["scanner"]).tolist() == [7]
    assert np.abs(points["intensity"] - (100 + flight.pulse % 7.0)).max() <= 2


def test_anchors_and_rays_are_those_of_the_pulses(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    drive = _drive(flight.path, tmp_path / "into")
    waveforms = _waveforms(drive)
    numbers = waveforms.pulse_of(np.arange(drive.count))
    pulses = waveforms.pulses(numbers)
    order = np.argsort(drive.columns["source_index"][:])
    for row, (pulse, (duration, samples)) in zip(order, _returned(flight), strict=True):
        one = flight.pulses[pulse]
        anchor = np.array(one.anchor) * SCALE + OFFSET
        first = duration * DURATION_SCALE + DURATION_OFFSET
        wanted = anchor + first * flight.rays[pulse]
        np.testing.assert_allclose(pulses.anchor[row], wanted, atol=2e-4)
        np.testing.assert_allclose(pulses.direction[row], flight.rays[pulse], rtol=1e-6)
        assert pulses.lengths[row] == len(samples)
    assert (pulses.gain == 1).all()
    assert (pulses.offset == 0).all()
    assert [one.sign_by for one in waveforms.files] == ["down"]


def test_every_point_names_its_own_samples(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    drive = _drive(flight.path, tmp_path / "into")
    waveforms = _waveforms(drive)
    assert waveforms.count == len(flight.xyz)
    order = np.argsort(drive.columns["source_index"][:])
    numbers = waveforms.pulse_of(order)
    for number, (_, (_, samples)) in zip(numbers, _returned(flight), strict=True):
        read = waveforms.samples_of(np.array([number]))[0]
        assert read[: len(samples)].tolist() == list(samples)
    for number in numbers[:10].tolist():
        (point,) = waveforms.points_of(number)
        assert waveforms.pulse_of(np.array([point]))[0] == number


def test_the_drive_says_where_its_points_come_from(tmp_path: Path) -> None:
    drive = _drive(write_pulse_flight(tmp_path / "a.pls").path, tmp_path / "into")
    facts = waveform_facts(drive)
    assert facts is not None
    assert "160 echoes" in facts.remarks[0].en
    assert "160個のエコー" in facts.remarks[0].ja
    assert drive.trajectory is not None


def test_points_go_out_as_las_with_the_same_samples(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    drive = _drive(flight.path, tmp_path / "into")
    out = tmp_path / "out"
    out.mkdir()
    write_labelled_points([drive], lambda name: out / name, SilentMonitor())
    (written,) = out.glob("*.la[sz]")
    las = laspy.read(written)
    assert (las.header.version.minor, las.header.point_format.id) == (4, 9)
    assert np.abs(las.xyz - flight.xyz).max() < _CENTIMETRES_M
    again = _drive(written, tmp_path / "again")
    waveforms = _waveforms(again)
    numbers = waveforms.pulse_of(np.argsort(again.columns["source_index"][:]))
    for number, (_, (_, samples)) in zip(numbers, _returned(flight), strict=True):
        read = waveforms.samples_of(np.array([number]))[0]
        assert read[: len(samples)].tolist() == list(samples)
    before, after = _waveforms(drive), waveforms
    np.testing.assert_allclose(
        before.pulses(slice(0, None)).anchor, after.pulses(slice(0, None)).anchor, atol=1e-3
    )


def test_echoes_that_are_no_longer_those_of_the_drive_are_not_written(tmp_path: Path) -> None:
    """A later program may find others; classes would go to the wrong points."""
    drive = _drive(write_pulse_flight(tmp_path / "a.pls").path, tmp_path / "into")
    (file,) = read_packet_files(drive.folder)
    write_packet_files(drive.folder, [replace(file, echoes=file.echoes + 1)])
    with pytest.raises(BadFile, match="finds 160 echoes in the waveforms now; 161 were imported"):
        write_labelled_points([drive], lambda name: tmp_path / name, SilentMonitor())


@pytest.mark.parametrize("bits", [8, 16])
@pytest.mark.parametrize("units_ns", [0.5, 1.0, 2.0])
def test_samples_of_any_width_and_spacing(tmp_path: Path, bits: int, units_ns: float) -> None:
    """Spacings other than the composition's count its units between samples."""
    sampling = Sampling(bits=bits, units_ns=units_ns, duration_bits=16, duration_offset=3200.0)
    ray = (0.0, 0.0, -0.15)
    pulses, heights = [], []
    for number in range(60):
        at = 20 + 0.07 * number
        pulses.append(
            PulseOfFile(
                number, (0, 1000 * number, 500_000), (0, 1000 * number, 350_000),
                ([(1000, echo(at, 50, 150))],),
            )
        )  # fmt: skip
        heights.append(OFFSET[2] + 500 + (3210 + at * units_ns) * ray[2])
    path = tmp_path / "a.pls"
    write_pulses(path, pulses, {1: Composition((sampling,))})
    points = _points(path)
    assert np.abs(points["xyz"][:, 2] - heights).max() < _CENTIMETRES_M * max(1.0, units_ns)
    assert {one.interval_ns for one in _waveforms(_drive(path, tmp_path / "d")).descriptors} == {
        units_ns
    }


def test_fixed_samples_from_the_anchor_on_with_descriptors_behind_the_pulses(
    tmp_path: Path,
) -> None:
    """As LAS becomes PulseWaves: no durations, no numbers, no place of the optical centre."""
    sampling = Sampling(
        duration_bits=0, duration_offset=0.0, segment_bits=0, sample_bits=0, segments=1, samples=64
    )
    one = Composition((sampling,), centre=FLUCTUATES, extra_bytes=3)
    pulses = [
        PulseOfFile(k, (0, 1000 * k, 20_000), (0, 1000 * k, -130_000), ([(0, echo(30, 64, 90))],),
                    composition=9, first=0, last=63, source=70_000)
        for k in range(40)
    ]  # fmt: skip
    head = Head(attributes=2, source=0, behind={9: one})
    path = tmp_path / "a.pls"
    write_pulses(path, pulses, {}, head)
    points = _points(path)
    assert "origin" not in points
    np.testing.assert_allclose(points["xyz"][:, 2], OFFSET[2] + 20 - 30 * 0.15, atol=0.02)
    assert np.unique(points["scanner"]).tolist() == [65_535]


def test_the_optical_centre_lies_behind_the_anchor(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls", composition=replace(FLIGHT, centre=200))
    points = _points(flight.path)
    anchors = np.array([one.anchor for one in flight.pulses]) * SCALE + OFFSET
    wanted = anchors - 200 * flight.rays
    np.testing.assert_allclose(points["origin"], wanted[flight.pulse], atol=1e-6)


def test_of_two_channels_the_sensitive_one_is_taken_where_it_is_not_cut_off(tmp_path: Path) -> None:
    sensitive, weak = Sampling(channel=1), Sampling(channel=0)
    pulses = []
    for number in range(60):
        height = 1200 if number % 4 == 0 else 120
        waves = (
            [(30_000, echo(20, 48, height))],
            [(30_000, echo(20, 48, height / 8))],
        )
        pulses.append(
            PulseOfFile(
                number, (0, 1000 * number, 500_000), (0, 1000 * number, 350_000),
                waves, source=3,
            )
        )  # fmt: skip
    path = tmp_path / "a.pls"
    write_pulses(path, pulses, {1: Composition((sensitive, weak))}, Head(attributes=1))
    points = _points(path)
    assert points["number_of_returns"].tolist() == [1] * 60
    wanted = np.where(np.arange(60) % 4 == 0, 150, 120)
    assert np.abs(points["intensity"] - wanted).max() <= 3
    assert points["scanner"].tolist() == [3] * 60
    drive = _drive(path, tmp_path / "into")
    assert _waveforms(drive).count == 60


def test_standard_gps_times_keep_their_microseconds(tmp_path: Path) -> None:
    head = Head(time_scale=1e-9, time_offset=1_000_000_000.0)
    flight = write_pulse_flight(tmp_path / "a.pls", head=head)
    pulses = [
        replace(one, time=300_000_000_000_000_000 + 100 * number)
        for number, one in enumerate(flight.pulses)
    ]
    write_pulses(flight.path, pulses, {1: FLIGHT}, head)
    info, points = read_info(flight.path), _points(flight.path)
    assert info.is_adjusted_standard
    np.testing.assert_allclose(points["time"] - 3e8, 1e-7 * flight.pulse, atol=6e-8)


def test_pulses_that_all_have_one_time_have_none(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    write_pulses(flight.path, [replace(one, time=0) for one in flight.pulses], {1: FLIGHT})
    assert not read_info(flight.path).has_time
    assert _drive(flight.path, tmp_path / "into").count == len(flight.xyz)


def test_waveforms_of_too_many_lengths_repeat_their_last_sample(tmp_path: Path) -> None:
    lengths = range(40, 400)
    pulses = [
        PulseOfFile(k, (0, 500 * k, 500_000), (0, 500 * k, 350_000),
                    ([(30_000, echo(20, length, 150))],))
        for k, length in enumerate(lengths)
    ]  # fmt: skip
    path = tmp_path / "a.pls"
    write_pulses(path, pulses, {1: Composition((Sampling(),))})
    drive = _drive(path, tmp_path / "into")
    facts, waveforms = waveform_facts(drive), _waveforms(drive)
    assert facts is not None
    assert "repeat their last sample" in facts.remarks[0].en
    numbers = waveforms.pulse_of(np.argsort(drive.columns["source_index"][:]))
    kept = waveforms.pulses(numbers).lengths
    assert (kept - np.array(lengths)).tolist() == [length % 2 for length in lengths]
    for number, length, one in zip(numbers, lengths, pulses, strict=True):
        read = waveforms.samples_of(np.array([number]))[0]
        samples = list(one.waves[0][0][1])
        assert read[: length + length % 2].tolist() == samples + samples[-1:] * (length % 2)


def test_a_pulse_without_returned_light_gives_no_point(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    pulses = [
        replace(one, waves=(one.waves[0], [])) if number == 4 else one
        for number, one in enumerate(flight.pulses)
    ]
    write_pulses(flight.path, pulses, {1: FLIGHT})
    points = _points(flight.path)
    assert 400_000.00008 not in np.round(points["time"], 6)
    assert points["time"].size == len(flight.xyz) - 1


def test_few_pulses_are_enough(tmp_path: Path) -> None:
    """The pulse can't be learnt from three echoes; what left tells it, or their own width."""
    flight = write_pulse_flight(tmp_path / "a.pls", 3)
    assert np.linalg.norm(_points(flight.path)["xyz"] - flight.xyz, axis=1).max() < 0.05
    alone = Composition((FLIGHT.samplings[1],))
    flight = write_pulse_flight(tmp_path / "b.pls", 3, composition=alone)
    assert np.linalg.norm(_points(flight.path)["xyz"] - flight.xyz, axis=1).max() < 0.05


def test_a_file_without_pulses_has_no_points(tmp_path: Path) -> None:
    path = tmp_path / "a.pls"
    write_pulses(path, [], {1: FLIGHT})
    assert read_info(path).count == 0


Damage = Callable[[bytearray, bytearray], object]
"""Changes the bytes of the .pls, of the .wvs."""


def _refused(tmp_path: Path, damage: Damage, composition: Composition = FLIGHT) -> UserError:
    flight = write_pulse_flight(tmp_path / "道路.pls", 30)
    waves = flight.path.with_suffix(".wvs")
    if composition is not FLIGHT:
        data = flight.path.read_bytes()
        old, new = FLIGHT.record(), composition.record()
        assert len(old) == len(new)
        flight.path.write_bytes(data.replace(old, new))
    pls, wvs = bytearray(flight.path.read_bytes()), bytearray(waves.read_bytes())
    damage(pls, wvs)
    flight.path.write_bytes(pls)
    waves.write_bytes(wvs)
    with pytest.raises(UserError) as caught:
        read_info(flight.path)
    assert "道路" in caught.value.where.en
    assert caught.value.remedy.en
    assert caught.value.what.ja
    return caught.value


def _pulses_at(pls: bytearray) -> int:
    return int(struct.unpack_from("<q", pls, 176)[0])


def _put(pls: bytearray, byte: int, form: str, *values: float) -> None:
    struct.pack_into(form, pls, byte, *values)


@pytest.mark.parametrize(
    ("damage", "told"),
    [
        (lambda pls, _: _put(pls, 172, "<B", 2), "PulseWaves 2.3"),
        (lambda pls, _: _put(pls, 192, "<I", 5), "format 5"),
        (lambda pls, _: _put(pls, 204, "<I", 1), "compressed"),
        (lambda _, wvs: _put(wvs, 16, "<I", 1), "compressed"),
        (lambda _, wvs: _put(wvs, 0, "<B", 0), "PulseWavesWaves"),
        (lambda pls, _: pls.__delitem__(slice(300, None)), "ends inside its header"),
        (lambda pls, _: pls.__delitem__(slice(_pulses_at(pls) + 480, None)), "pulse 11 of 30"),
        (lambda pls, _: _put(pls, 184, "<q", 1 << 60), "pulse 33 of"),
        (lambda pls, _: _put(pls, 184, "<q", -1), "no pulses"),
        (lambda pls, _: _put(pls, 200, "<I", 47), "47 bytes each"),
        (lambda pls, _: _put(pls, 176, "<q", 1 << 50), "can't begin"),
        (lambda pls, _: _put(pls, 216, "<I", 1 << 31), "reaches beyond"),
        (lambda pls, _: _put(pls, 352 + 24, "<q", 1 << 62), "reaches beyond"),
        (lambda pls, _: _put(pls, 256, "<d", np.nan), "scale or offset"),
        (lambda pls, _: _put(pls, 288, "<d", 1e300), "scale or offset"),
        (lambda pls, _: _put(pls, _pulses_at(pls) + 92, "<B", 77), "descriptor 77"),
        (
            lambda pls, _: _put(pls, _pulses_at(pls) + 56, "<q", 1 << 40),
            "Pulse 2 is damaged. Its samples",
        ),
        (
            lambda pls, _: _put(pls, _pulses_at(pls) + 56, "<q", -5),
            "Pulse 2 is damaged. Its samples",
        ),
        (
            lambda pls, _: _put(pls, _pulses_at(pls) + 56, "<q", 7),
            "Pulse 2 is damaged. Its samples",
        ),
        (lambda _, wvs: wvs.__delitem__(slice(-3, None)), "Pulse 30 is damaged. Its samples"),
    ],
)
def test_what_is_damaged_is_told_in_one_sentence(tmp_path: Path, damage: Damage, told: str) -> None:
    error = _refused(tmp_path, damage)
    assert isinstance(error, BadFile)
    assert told in error.what.en


@pytest.mark.parametrize(
    ("change", "told"),
    [
        ({"sample_bits": 0, "samples": 0}, "0 samples"),
        ({"sample_bits": 0, "samples": 5_000_000}, "5000000 samples"),
        ({"segment_bits": 0, "segments": 0}, "0 segments"),
        ({"segment_bits": 16, "sample_bits": 0, "samples": 1, "duration_bits": 0}, "segments of"),
        ({"bits": 12}, "12 bits of a sample"),
        ({"duration_bits": 24}, "24 bits of a duration"),
        ({"units_ns": -1.0}, "-1.0 ns between"),
        ({"units_ns": float("nan")}, "nan ns between"),
        ({"duration_scale": float("inf")}, "inf as scale"),
        ({"compression": 3}, "compressed"),
    ],
)
def test_samplings_that_nobody_can_read_are_told(
    tmp_path: Path, change: dict[str, float], told: str
) -> None:
    samplings = FLIGHT.samplings[0], replace(FLIGHT.samplings[1], **change)
    fill: Damage = lambda _, wvs: wvs.extend(b"\xff" * 70_000)  # noqa: E731 - a value of the table
    error = _refused(tmp_path, fill, replace(FLIGHT, samplings=samplings))
    assert told in error.what.en


def test_without_its_samples_the_name_of_their_file_is_told(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    flight.path.with_suffix(".wvs").unlink()
    with pytest.raises(MissingInput, match=r"a\.wvs"):
        read_info(flight.path)
    flight.path.with_suffix(".wvz").write_bytes(b"packed")
    with pytest.raises(BadFile, match="compressed"):
        read_info(flight.path)


def test_samples_alone_name_the_file_of_their_pulses(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    with pytest.raises(BadFile, match=r"Choose a\.pls"):
        read_info(flight.path.with_suffix(".wvs"))


def test_another_file_of_samples_is_seen_at_once(tmp_path: Path) -> None:
    flight = write_pulse_flight(tmp_path / "a.pls")
    waves = flight.path.with_suffix(".wvs")
    assert read_info(flight.path).count == len(flight.xyz)
    waves.write_bytes(waves.read_bytes()[:-1])
    with pytest.raises(BadFile, match="Pulse 120 is damaged"):
        read_info(flight.path)


def _read_all(path: Path) -> None:
    """Either file may be the one that is told."""

    def read() -> None:
        read_info(path)
        read_sample(path, 20)
        for _ in read_chunks(path):
            pass

    outcome(read, path.with_suffix(""))


@settings(max_examples=150, deadline=None)
@given(
    st.lists(
        st.tuples(st.booleans(), st.integers(0, 100_000), st.binary(min_size=1, max_size=8)),
        min_size=1,
        max_size=6,
    )
)
def test_changed_bytes_end_in_points_or_in_a_sentence(
    changes: list[tuple[bool, int, bytes]],
) -> None:
    with TemporaryDirectory() as folder:
        flight = write_pulse_flight(Path(folder) / "航測.pls", 12)
        waves = flight.path.with_suffix(".wvs")
        for in_pulses, byte, put in changes:
            path = flight.path if in_pulses else waves
            data = bytearray(path.read_bytes())
            at = byte % len(data)
            data[at : at + len(put)] = put
            path.write_bytes(data)
        _read_all(flight.path)


@settings(max_examples=100, deadline=None)
@given(st.binary(max_size=800), st.binary(max_size=200))
def test_random_bytes_are_refused_in_a_sentence(pulses: bytes, samples: bytes) -> None:
    with TemporaryDirectory() as folder:
        path = Path(folder) / "航測.pls"
        path.write_bytes(b"PulseWavesPulse\0" + pulses)
        path.with_suffix(".wvs").write_bytes(b"PulseWavesWaves\0" + samples)
        _read_all(path)
