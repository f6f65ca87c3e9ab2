"""Echoes of the segments of a PulseWaves file: found once for a file, kept while it is in use.

Each recorder (channel, bits, spacing of samples) has its own noise and its own pulse. Both are
taken from segments spread evenly over the file, so the same file always gives the same echoes.
"""

from __future__ import annotations

import tempfile
import threading
import weakref
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import Unsuitable, report_as_user_error
from processing.formats.points.pulsewaves.pulse_composition import OUTGOING, PulseSampling
from processing.formats.points.pulsewaves.returning_segments import PulseWaves, SegmentBlock
from processing.methods.waveforms.decomposition import Digitiser, decompose
from processing.methods.waveforms.system_pulse import (
    RecordNoise,
    SystemPulse,
    noise_of,
    own_pulse,
    system_pulse,
)
from processing.recording.waveform_packets.packet_samples import read_samples

_LEARNT_FROM = 8_000
"""Segments of a recorder, as many as :mod:`processing.methods.waveforms.drive_echoes` looks at."""

_LEAST_SAMPLES = 5
"""Shorter segments hold no pulse with its flanks."""

_VALUES_AT_ONCE = 4_000_000
_PS_IN_NS = 1000.0

ECHO = np.dtype([("segment", "<i8"), ("time_ns", "<f8"), ("height", "<f4")])
"""``segment``: row of its block; ``time_ns``: after its first sample; ``height``: counts."""


@dataclass(frozen=True)
class Recorder:
    """What segments have in common whose noise and pulse are one."""

    channel: int
    bits: int
    spacing_ps: int


def recorder_of(sampling: PulseSampling) -> Recorder:
    """The recorder of a sampling."""
    return Recorder(sampling.channel, sampling.bits, sampling.spacing_ps)


@dataclass(frozen=True)
class _Known:
    noise: RecordNoise
    pulse: SystemPulse
    digitiser: Digitiser


@dataclass
class SampledSegments:
    """Some thousand segments of a recorder, evenly spread, of however many there are.

    One of so many is kept; where that is too many, every other one goes.
    """

    places: list[tuple[int, int]] = field(default_factory=list)
    _step: int = 1
    _seen: int = 0

    def add(self, byte: Integers, samples: Integers) -> None:
        """See further segments, in the file's order."""
        here = np.arange(-self._seen % self._step, byte.size, self._step)
        self.places += zip(byte[here].tolist(), samples[here].tolist(), strict=True)
        self._seen += byte.size
        while len(self.places) > 2 * _LEARNT_FROM:
            self.places = self.places[::2]
            self._step *= 2


class SegmentEchoes:
    """The echoes of a file, in the order of its blocks, on the disk for as long as this lives.

    Parameters
    ----------
    waves : PulseWaves
    sampled : mapping of Recorder to SampledSegments
        What noise and pulses are learnt from.

    Attributes
    ----------
    count : int
        Echoes.
    silent : int
        Segments without any.

    Raises
    ------
    NoSpace, BadFile
    """

    def __init__(self, waves: PulseWaves, sampled: dict[Recorder, SampledSegments]) -> None:
        self.count = self.silent = 0
        self._lock = threading.Lock()
        self._ends = [0]
        known = _known_of(waves, sampled)
        with report_as_user_error(Path(tempfile.gettempdir())):
            self._file = tempfile.TemporaryFile()  # noqa: SIM115 - closed when this goes
            weakref.finalize(self, self._file.close)
            for block in waves.blocks():
                echoes = _echoes_of(block, waves, known)
                self._file.write(echoes.tobytes())
                self._ends.append(self._ends[-1] + echoes.size)
                self.silent += block.pulse.size - np.unique(echoes["segment"]).size
            self._file.flush()
        self.count = self._ends[-1]

    def of_block(self, number: int) -> NDArray[np.void]:
        """The echoes of one block of :meth:`PulseWaves.blocks`, counted from 0: (k,) `ECHO`.

        Raises
        ------
        NoSpace, BadFile
        """
        first, end = self._ends[number : number + 2]
        with self._lock, report_as_user_error(Path(tempfile.gettempdir())):
            self._file.seek(first * ECHO.itemsize)
            return np.frombuffer(self._file.read((end - first) * ECHO.itemsize), ECHO)


def _echoes_of(
    block: SegmentBlock, waves: PulseWaves, known: dict[Recorder, _Known]
) -> NDArray[np.void]:
    """The echoes of a block, in the order of segments and times."""
    found = [np.empty(0, ECHO)]
    for recorder, one in known.items():
        of_recorder = [recorder_of(sampling) == recorder for sampling in waves.samplings]
        mine = np.flatnonzero(
            np.array(of_recorder)[block.sampling] & (block.samples >= _LEAST_SAMPLES)
        )
        # Segments of like lengths together: memory holds as many as the longest one has room for.
        mine = mine[np.argsort(block.samples[mine], kind="stable")]
        while mine.size:
            longest = block.samples[mine]
            fits = np.arange(1, mine.size + 1) * longest <= _VALUES_AT_ONCE
            some = mine[: max(1, int(fits.sum()))]
            mine = mine[some.size :]
            lengths = block.samples[some].astype(np.int32)
            samples = _samples(waves, block.byte[some], lengths, recorder.bits)
            echoes = decompose(samples, lengths, one.pulse, one.noise, one.digitiser)
            part = np.empty(echoes.row.size, ECHO)
            part["segment"] = some[echoes.row]
            part["time_ns"] = echoes.time_ns
            part["height"] = echoes.height
            found.append(part)
    whole = np.concatenate(found)
    inside = np.isfinite(whole["time_ns"]) & np.isfinite(whole["height"])
    whole = whole[inside]
    return np.asarray(whole[np.lexsort((whole["time_ns"], whole["segment"]))])


def _samples(
    waves: PulseWaves, byte: Integers, lengths: NDArray[np.int32], bits: int
) -> NDArray[np.float32]:
    samples = np.empty((byte.size, int(lengths.max(initial=1))), np.float32)
    read_samples(waves.data, byte, lengths, np.full(byte.size, bits // 8, np.int32), samples)
    return samples


def _known_of(
    waves: PulseWaves, sampled: dict[Recorder, SampledSegments]
) -> dict[Recorder, _Known]:
    """Noise and pulse of each recorder.

    Where a recorder has too few clear echoes, the pulse is that of the one with most segments that
    has enough; where none has, that of the light which left, if it was recorded; else a Gaussian as
    long as the narrowest echoes.
    """
    own: dict[Recorder, SystemPulse] = {}
    read = {}
    for recorder, some in sorted(sampled.items(), key=_by_number):
        samples, lengths = _read(waves, some, recorder.bits)
        noise = noise_of(samples, lengths)
        read[recorder] = samples, lengths, noise
        try:
            own[recorder] = own_pulse(samples, lengths, noise, _top_of(recorder))
        except Unsuitable:
            continue
    lent = next(iter(own.items()), None) or (_outgoing_pulse(waves) if read else None)
    known = {}
    for recorder, (samples, lengths, noise) in read.items():
        if recorder in own:
            pulse = own[recorder]
        elif lent is not None:
            ratio = lent[0].spacing_ps / recorder.spacing_ps
            pulse = SystemPulse(lent[1].table, lent[1].grid * ratio)
        else:
            pulse = _gaussian(samples, lengths, noise)
        interval = recorder.spacing_ps / _PS_IN_NS
        known[recorder] = _Known(noise, pulse, Digitiser(interval, _top_of(recorder)))
    return known


def _by_number(item: tuple[Recorder, SampledSegments]) -> tuple[int, int, int, int]:
    recorder, some = item
    return -len(some.places), recorder.channel, recorder.bits, recorder.spacing_ps


def _top_of(recorder: Recorder) -> float:
    return 2.0**recorder.bits - 1


def _read(
    waves: PulseWaves, some: SampledSegments, bits: int
) -> tuple[NDArray[np.float32], NDArray[np.int32]]:
    places = np.array(some.places, np.int64).reshape(-1, 2)
    room = _VALUES_AT_ONCE // max(1, int(places[:, 1].max(initial=1)))
    places = places[:: max(1, -(-len(places) // max(1, min(room, _LEARNT_FROM))))]
    lengths = places[:, 1].astype(np.int32)
    return _samples(waves, places[:, 0], lengths, bits), lengths


def _outgoing_pulse(waves: PulseWaves) -> tuple[Recorder, SystemPulse] | None:
    """The pulse as it left, where the file has it."""
    sampled: dict[Recorder, SampledSegments] = {}
    for block in waves.blocks(OUTGOING):
        note_segments(block, waves, sampled)
    for recorder, some in sorted(sampled.items(), key=_by_number):
        samples, lengths = _read(waves, some, recorder.bits)
        try:
            noise = noise_of(samples, lengths)
            return recorder, own_pulse(samples, lengths, noise, _top_of(recorder))
        except Unsuitable:
            continue
    return None


def note_segments(
    block: SegmentBlock, waves: PulseWaves, sampled: dict[Recorder, SampledSegments]
) -> None:
    """Note the segments of a block with those of their recorders that are long enough."""
    for number in np.unique(block.sampling).tolist():
        mine = (block.sampling == number) & (block.samples >= _LEAST_SAMPLES)
        if mine.any():
            some = sampled.setdefault(recorder_of(waves.samplings[number]), SampledSegments())
            some.add(block.byte[mine], block.samples[mine])


_NARROW = 0.35
"""Share of echoes, by width, from which a Gaussian's width is taken: flat targets."""

_FWHM = 2.3548
"""Full width at half maximum of a Gaussian, in standard deviations."""


def _gaussian(
    samples: NDArray[np.float32], lengths: NDArray[np.int32], noise: RecordNoise
) -> SystemPulse:
    """A Gaussian as long as the narrowest of the highest echoes."""
    inside = np.arange(samples.shape[1]) < lengths[:, None]
    waves = np.where(inside, samples - noise.baseline, -np.inf)
    is_high = waves > 0.5 * waves.max(axis=1, keepdims=True)
    # Each sample above half of the maximum stands for one spacing.
    widths: Floats = is_high.sum(axis=1).astype(np.float64)
    fwhm = max(2.0, float(np.quantile(widths, _NARROW)))
    sigma = min(fwhm, 100.0) / _FWHM
    times = np.arange(-np.ceil(4 * sigma) - 2, np.ceil(4 * sigma) + 3)
    return system_pulse(times, np.exp(-0.5 * (times / sigma) ** 2))
