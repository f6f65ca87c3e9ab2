"""PulseWaves: the echoes of its returned light as points, each with its pulse's waveform.

The files hold pulses and no points. Where light came back is found by the program's own
decomposition of waveforms; every echo is a point with the time of its pulse and names the segment
of samples that it lies in. The segments that are used become packets as LAS keeps them, with no
change to a sample. Reference: PulseWaves 0.3 revision 11 (Isenburg, 2011 to 2016).
"""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from functools import lru_cache
from pathlib import Path
from typing import BinaryIO, NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import report_as_user_error
from processing.core.kernels import kernel
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.formats.points.las.las_header import damaged
from processing.formats.points.las.waveform_packets import PACKETS_HEAD_BYTES, packets_head
from processing.formats.points.pulsewaves.pulsewaves_header import (
    PulseWavesHeader,
    read_pulse_header,
)
from processing.formats.points.pulsewaves.returning_segments import (
    PulseWaves,
    SegmentBlock,
    waves_path,
)
from processing.formats.points.pulsewaves.segment_echoes import (
    Recorder,
    SampledSegments,
    SegmentEchoes,
    note_segments,
)
from processing.recording.vehicle_path.clock import ADJUSTMENT_S, WEEK_S
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    DIRECTION,
    LOCATION,
    MOST_SAMPLES,
    PACKET,
    WaveformDescriptor,
)

_PACK = "processing.formats.points.pulsewaves.pulsewaves:write_packets"
_UNITS_TO_TARGET = 1000.0
_MOST_DESCRIPTORS = 255
_MOST_INTENSITY = 65_535.0
_PS_IN_NS = 1000.0
_MOST_SOURCE = 65_535

_Coding = tuple[int, int]
"""Bits and spacing, ps, of samples."""


@dataclass(frozen=True)
class _Packets:
    """How the segments of a file become packets.

    Attributes
    ----------
    descriptors : dict of int to WaveformDescriptor
        By number, from 1.
    number_of : dict of (bits, ps) to (MOST_SAMPLES + 1,) uint8
        The descriptor of a segment of so many samples.
    size : int
        Bytes of all packets with what stands before them.
    """

    descriptors: dict[int, WaveformDescriptor]
    number_of: dict[_Coding, NDArray[np.uint8]]
    size: int

    def numbers(self, block: SegmentBlock, waves: PulseWaves) -> NDArray[np.uint8]:
        """The descriptor of each segment of a block."""
        numbers = np.zeros(block.pulse.size, np.uint8)
        for sampling in np.unique(block.sampling).tolist():
            one, mine = waves.samplings[sampling], block.sampling == sampling
            numbers[mine] = self.number_of[one.bits, one.spacing_ps][block.samples[mine]]
        return numbers

    def bytes_of(self, numbers: NDArray[np.uint8]) -> Integers:
        """The length of the packets of these descriptors."""
        lengths = np.zeros(256, np.int64)
        for number, one in self.descriptors.items():
            lengths[number] = one.packet_bytes
        return np.asarray(lengths[numbers])


@dataclass(frozen=True, eq=False)
class _Survey:
    """What a file holds, as far as all of it must be looked at to know.

    Attributes
    ----------
    is_lengthened : bool
        Whether some segments get the last sample once more, so that 255 descriptors are enough.
    sampled : dict of Recorder to SampledSegments
    first_time, last_time : int
        Lowest and highest as the pulses have them.
    compositions : frozenset of int
        Those in use.
    """

    packets: _Packets
    is_lengthened: bool
    sampled: dict[Recorder, SampledSegments]
    first_time: int
    last_time: int
    compositions: frozenset[int]

    @property
    def has_times(self) -> bool:
        """Whether pulses have times of their own; writers that know none give all the same."""
        return self.first_time < self.last_time or self.first_time == self.last_time != 0


def open_pulsewaves(path: Path) -> FloatFile:
    """The echoes of a PulseWaves file, with their waveforms and where the scanner was.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        It can't be read, is compressed or damaged; there is no ``.wvs`` beside it.
    """
    header = read_pulse_header(path)
    beside = waves_path(path)
    state = _state_of(path, beside)
    survey, echoes = _survey_of(path, state), _echoes_of(path, state)
    packets = survey.packets
    return FloatFile(
        path,
        "PulseWaves",
        lambda: _blocks(PulseWaves(header), survey, echoes),
        waveforms=DeliveredWaveforms(
            path=beside,
            size=packets.size,
            has_head=True,
            descriptors=packets.descriptors,
            pack=_PACK,
            echoes=echoes.count,
            remark=_remark_on(survey, echoes),
        ),
        crs=header.crs,
        is_adjusted_standard=True if _taken_off_s(header, survey) else None,
        beside=(beside,),
    )


def write_packets(path: Path, into: BinaryIO, monitor: Monitor) -> None:
    """Write the segments that points may name as packets, one behind the other.

    Parameters
    ----------
    path : Path
        The ``.wvs``.

    Raises
    ------
    MissingInput, NoSpace, BadFile, Cancelled
    """
    beside = (path.with_suffix(ending) for ending in _ENDINGS)
    pulses = next((one for one in beside if one.is_file()), path.with_suffix(_ENDINGS[0]))
    waves = PulseWaves(read_pulse_header(pulses))
    packets = _survey_of(pulses, _state_of(pulses, waves.path)).packets
    into.write(packets_head(packets.size - PACKETS_HEAD_BYTES))
    bytes_of_sample = np.array([one.bits // 8 for one in waves.samplings], np.int64)
    for block in waves.blocks():
        monitor.check()
        lengths = packets.bytes_of(packets.numbers(block, waves))
        widths = bytes_of_sample[block.sampling]
        for some in _stretches(lengths):
            own = np.empty(int(lengths[some].sum()), np.uint8)
            _gather_kernel(
                waves.data,
                block.byte[some],
                block.samples[some] * widths[some],
                widths[some],
                np.cumsum(lengths[some]),
                own,
            )
            into.write(own.data)


_ENDINGS = (".pls", ".PLS")
_LATEST = np.iinfo(np.int64).max
_BYTES_AT_ONCE = 16 << 20

_ECHOES = Text(
    "The points are the {echoes:,} echoes that Zuka found in the waveforms of the pulses; "
    "{silent:,} waveforms hold none.",
    "点は、パルスの波形からZukaが検出した{echoes:,}個のエコーです"
    "（エコーのない波形: {silent:,}個）。",
)
_LENGTHENED = Text(
    "{echoes} They have more lengths than LAS can tell: some waveforms repeat their last sample.",
    "{echoes}波形の長さの種類がLASの上限を超えるため、一部は最後のサンプルを繰り返しています。",
)


def _remark_on(survey: _Survey, echoes: SegmentEchoes) -> Text:
    told = _ECHOES.filled(echoes=echoes.count, silent=echoes.silent)
    return _LENGTHENED.filled(echoes=told) if survey.is_lengthened else told


_State = tuple[tuple[int, int], ...]


def _state_of(*paths: Path) -> _State:
    """Size and time of change of files, by which a changed one is known."""
    found = []
    for path in paths:
        with report_as_user_error(path):
            status = path.stat()
        found.append((status.st_size, status.st_mtime_ns))
    return tuple(found)


@lru_cache(maxsize=16)
def _survey_of(path: Path, _state: _State) -> _Survey:
    """One pass over all segments; kept, as a file is asked for its facts, a sample and points."""
    waves = PulseWaves(read_pulse_header(path))
    counts: Counter[tuple[_Coding, int]] = Counter()
    sampled: dict[Recorder, SampledSegments] = {}
    first_time, last_time = _LATEST, -_LATEST
    compositions: set[int] = set()
    for block in waves.blocks():
        note_segments(block, waves, sampled)
        compositions.update(np.unique(block.pulses["composition"]).tolist())
        first_time = min(first_time, int(block.pulses["time"].min(initial=_LATEST)))
        last_time = max(last_time, int(block.pulses["time"].max(initial=-_LATEST)))
        for sampling in np.unique(block.sampling).tolist():
            one, mine = waves.samplings[sampling], block.sampling == sampling
            lengths, found = np.unique(block.samples[mine], return_counts=True)
            for length, count in zip(lengths.tolist(), found.tolist(), strict=True):
                counts[(one.bits, one.spacing_ps), length] += count
    packets, is_lengthened = _packets_of(path, counts)
    times = first_time, last_time
    return _Survey(packets, is_lengthened, sampled, *times, frozenset(compositions))


@lru_cache(maxsize=4)
def _echoes_of(path: Path, state: _State) -> SegmentEchoes:
    """Found once: it takes a hundred times as long as reading them."""
    survey = _survey_of(path, state)
    return SegmentEchoes(PulseWaves(read_pulse_header(path)), survey.sampled)


def _packets_of(path: Path, counts: Counter[tuple[_Coding, int]]) -> tuple[_Packets, bool]:
    """A descriptor for each coding and length; where these are too many, for like lengths.

    Lengths are rounded up to multiples of 2, of 4 and so on until 255 descriptors are enough.
    """
    codings = sorted({coding for coding, _ in counts})
    if len(codings) > _MOST_DESCRIPTORS:
        raise damaged(
            path,
            Text(
                f"Its samples are coded in {len(codings):,} ways.",
                f"サンプルの符号化が{len(codings):,}種類あります。",
            ),
        )
    step, kinds = 1, sorted(counts)
    while len(kinds) > _MOST_DESCRIPTORS:
        step *= 2
        kinds = sorted({(coding, _rounded_up(length, step)) for coding, length in counts})
    descriptors = {
        number: WaveformDescriptor(bits, length, spacing_ps, 1.0, 0.0)
        for number, ((bits, spacing_ps), length) in enumerate(kinds, 1)
    }
    numbers = {kind: number for number, kind in enumerate(kinds, 1)}
    number_of = {coding: np.zeros(MOST_SAMPLES + 1, np.uint8) for coding in codings}
    size = PACKETS_HEAD_BYTES
    for (coding, length), count in counts.items():
        number = numbers[coding, _rounded_up(length, step)]
        number_of[coding][length] = number
        size += count * descriptors[number].packet_bytes
    return _Packets(descriptors, number_of, size), step > 1


def _rounded_up(length: int, step: int) -> int:
    return -(-length // step) * step


def _taken_off_s(header: PulseWavesHeader, survey: _Survey) -> float:
    """What is taken off times, s: standard GPS times lose their last digits as one number."""
    first, last = (
        one * header.time_scale + header.time_offset
        for one in (survey.first_time, survey.last_time)
    )
    return ADJUSTMENT_S if first >= 0.0 and last > 2 * WEEK_S else 0.0


def _blocks(waves: PulseWaves, survey: _Survey, echoes: SegmentEchoes) -> Iterator[ColumnBlock]:
    centres = _centres(waves.header, survey)
    byte = PACKETS_HEAD_BYTES
    for number, block in enumerate(waves.blocks()):
        descriptors = survey.packets.numbers(block, waves)
        lengths = survey.packets.bytes_of(descriptors)
        packets = byte + np.cumsum(lengths) - lengths
        byte += int(lengths.sum())
        found = _points_of(block, echoes.of_block(number), waves)
        segment = found.echoes["segment"]
        columns: ColumnBlock = {
            "xyz": found.xyz,
            "intensity": np.clip(np.rint(found.echoes["height"]), 0.0, _MOST_INTENSITY),
            "return_number": found.number,
            "number_of_returns": found.of_pulse,
            "scanner": np.clip(waves.sources(block)[found.pulse], 0, _MOST_SOURCE),
            PACKET: packets[segment],
            DESCRIPTOR: descriptors[segment],
            LOCATION: (found.echoes["time_ns"] * _PS_IN_NS).astype(np.float32),
            DIRECTION: found.to_sensor.astype(np.float32),
        }
        if survey.has_times:
            times = _times_of(block.pulses["time"], waves.header, survey)
            columns["time"] = times[found.pulse]
        if centres is not None:
            back = centres[block.pulses["composition"]]
            origin = _anchors(block, waves.header) - back[:, None] * _rays(block, waves.header)
            columns["origin"] = origin[found.pulse]
        yield columns


class _EchoPlaces(NamedTuple):
    """Echoes of a block in the order of pulses and ranges.

    ``echoes`` (k,) as of :data:`ECHO`; ``pulse`` (k,) rows of the block's pulses; ``xyz`` (k, 3)
    m, NaN where the pulse has no direction; ``to_sensor`` (k, 3) m/ps; ``number``, ``of_pulse``
    (k,): which echo of its pulse, from 1, and of how many.
    """

    echoes: NDArray[np.void]
    pulse: Integers
    xyz: Floats
    to_sensor: Floats
    number: Integers
    of_pulse: Integers


def _points_of(block: SegmentBlock, echoes: NDArray[np.void], waves: PulseWaves) -> _EchoPlaces:
    """Where echoes lie: anchor + (duration to the first sample + samples after it) x ray."""
    spacing_ps = np.array([one.spacing_ps for one in waves.samplings], np.float64)
    steps = np.array([one.steps for one in waves.samplings], np.float64)
    sampling = block.sampling[echoes["segment"]]
    after = echoes["time_ns"] * _PS_IN_NS / spacing_ps[sampling] * steps[sampling]
    along = block.start[echoes["segment"]] + after
    order = np.lexsort((along, block.pulse[echoes["segment"]]))
    echoes, along, sampling = echoes[order], along[order], sampling[order]
    pulse = block.pulse[echoes["segment"]]
    ray = _rays(block, waves.header)[pulse]
    xyz = _anchors(block, waves.header)[pulse] + along[:, None] * ray
    xyz[~ray.any(axis=1)] = np.nan
    count = np.bincount(pulse, minlength=block.pulses.size)
    first = np.cumsum(count) - count
    return _EchoPlaces(
        echoes,
        pulse,
        xyz,
        -ray * (steps / spacing_ps)[sampling][:, None],
        np.arange(pulse.size) - first[pulse] + 1,
        count[pulse],
    )


def _anchors(block: SegmentBlock, header: PulseWavesHeader) -> Floats:
    return np.asarray(block.pulses["anchor"] * np.array(header.scale) + np.array(header.offset))


def _rays(block: SegmentBlock, header: PulseWavesHeader) -> Floats:
    """The way of each pulse in one sampling unit, (n, 3) m, away from the scanner."""
    way = block.pulses["target"].astype(np.float64) - block.pulses["anchor"]
    return np.asarray(way * np.array(header.scale) / _UNITS_TO_TARGET)


def _centres(header: PulseWavesHeader, survey: _Survey) -> Floats | None:
    """Units from the optical centre to the anchor by composition; None where one says none.

    A path through origins needs times that differ.
    """
    if not survey.first_time < survey.last_time:
        return None
    centres = np.zeros(256)
    for number in survey.compositions:
        units = header.compositions[number].centre_units
        if units is None:
            return None
        centres[number] = units
    return centres


def _times_of(times: Integers, header: PulseWavesHeader, survey: _Survey) -> Floats:
    """Seconds; from the first pulse's on, so that no digit of the differences is lost."""
    first_s = survey.first_time * header.time_scale
    first_s += header.time_offset - _taken_off_s(header, survey)
    return np.asarray((times - survey.first_time) * header.time_scale + first_s)


def _stretches(lengths: Integers) -> Iterator[slice]:
    """Parts of packets that memory has room for."""
    ends, first = np.cumsum(lengths), 0
    while first < lengths.size:
        begin = int(ends[first] - lengths[first])
        stop = max(first + 1, int(np.searchsorted(ends, begin + _BYTES_AT_ONCE, "right")))
        yield slice(first, stop)
        first = stop


def warm_up() -> None:
    """Compile the kernels."""
    one, byte = np.ones(1, np.int64), np.zeros(1, np.uint8)
    _gather_kernel(byte, one - 1, one, one, one, byte.copy())


@kernel
def _gather_kernel(
    data: NDArray[np.uint8],
    byte: NDArray[np.int64],
    sizes: NDArray[np.int64],
    widths: NDArray[np.int64],
    ends: NDArray[np.int64],
    out: NDArray[np.uint8],
) -> None:
    """Put bytes one behind the other; the last sample again where there is room for more."""
    place = 0
    for row in range(byte.size):
        for at in range(sizes[row]):
            out[place + at] = data[byte[row] + at]
        place += sizes[row]
        while place < ends[row]:
            out[place] = out[place - widths[row]]
            place += 1
