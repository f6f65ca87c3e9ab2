"""How the waveforms of PulseWaves pulses are sampled: composition records and their samplings."""

from __future__ import annotations

import struct
from dataclasses import dataclass

from processing.core.text import Text
from processing.recording.waveform_packets.descriptors import MOST_SAMPLES, MOST_SPACING_PS

OUTGOING, RETURNING = 1, 2
_COMPOSITION = struct.Struct("<IIiHHfII")
_SAMPLING = struct.Struct("<IIBBBBffBBHIHHfI")
_NOT_ALONG_THE_RAY = -0x70000001
"""0x8FFFFFFF as a signed number: the optical centre is not a fixed way behind the anchor."""

_MOST_SAMPLINGS = 64
"""Scanners have one for what leaves and some for what returns."""

_DURATION_BITS, _COUNT_BITS, _SAMPLE_BITS = (0, 8, 16, 32), (0, 8, 16), (8, 16)
_PS_IN_NS = 1000.0
_LARGEST_FACTOR = 1e9


@dataclass(frozen=True)
class PulseSampling:
    """One recorder's samples of a pulse: segments one behind the other.

    Attributes
    ----------
    kind : int
        :data:`OUTGOING`, :data:`RETURNING`, or what no description covers.
    channel : int
        Of several recorders of the same light.
    duration_bytes, segment_bytes, sample_bytes : int
        Of the numbers before samples: duration from the anchor (with sign), number of segments, and
        of samples; 0 where there is no such number.
    duration_scale, duration_offset : float
        Units of the composition = number x scale + offset.
    segments, samples : int
        Where no number says it.
    bits : int
        Of a sample.
    spacing_ps : int
        Between samples, ps.
    steps : float
        Units of the composition between samples.
    """

    kind: int
    channel: int
    duration_bytes: int
    duration_scale: float
    duration_offset: float
    segment_bytes: int
    sample_bytes: int
    segments: int
    samples: int
    bits: int
    spacing_ps: int
    steps: float


@dataclass(frozen=True)
class PulseComposition:
    """How pulses of one kind are sampled.

    Attributes
    ----------
    centre_units : int or None
        Sampling units from the optical centre to the anchor; None where that is no fixed number.
    extra_bytes : int
        Before a pulse's waves.
    scanner : int
        Number of the scanner; 0 for none in particular.
    samplings : tuple of PulseSampling
    fault : Text
        Why such pulses can't be read, a sentence; empty where they can.
    is_packed : bool
        Whether the fault is that samples are compressed.
    """

    centre_units: int | None = None
    extra_bytes: int = 0
    scanner: int = 0
    samplings: tuple[PulseSampling, ...] = ()
    fault: Text = Text("", "")
    is_packed: bool = False


def composition_of(record: bytes) -> PulseComposition:
    """What a record says; what is wrong with it is told with it, as no pulse may be of its kind."""
    if len(record) < _COMPOSITION.size:
        return PulseComposition(fault=_ENDS_EARLY)
    size, _, centre, extra, count, units, compression, scanner = _COMPOSITION.unpack_from(record)
    if not 0 < count <= _MOST_SAMPLINGS:
        return PulseComposition(fault=_bad("samplings", "サンプリング数", count))
    if not _is_spacing(units):
        return PulseComposition(fault=_bad("ns between samples", "サンプル間隔ns", f"{units:g}"))
    samplings, place, is_packed = [], size, compression != 0
    for _ in range(count):
        if size < _COMPOSITION.size or place + _SAMPLING.size > len(record):
            return PulseComposition(fault=_ENDS_EARLY)
        values = _SAMPLING.unpack_from(record, place)
        if values[0] < _SAMPLING.size:
            return PulseComposition(fault=_ENDS_EARLY)
        fault = _fault_of(values)
        if fault.en:
            return PulseComposition(fault=fault)
        is_packed = is_packed or values[15] != 0
        samplings.append(_sampling_of(values, units))
        place += values[0]
    return PulseComposition(
        centre_units=None if centre == _NOT_ALONG_THE_RAY else centre,
        extra_bytes=extra,
        scanner=scanner,
        samplings=tuple(samplings),
        is_packed=is_packed,
    )


def _is_spacing(ns: float) -> bool:
    return 0.5 <= ns * _PS_IN_NS <= MOST_SPACING_PS


_Numbers = tuple[
    int, int, int, int, int, int, float, float, int, int, int, int, int, int, float, int
]


def _fault_of(values: _Numbers) -> Text:
    duration, scale, offset, segments_in, samples_in, segments, samples, bits = values[5:13]
    own = values[14]
    checks = (
        (duration in _DURATION_BITS, "bits of a duration", "時間のビット数", duration),
        (abs(scale) <= _LARGEST_FACTOR, "as scale of a duration", "時間の倍率", scale),
        (abs(offset) <= _LARGEST_FACTOR, "as offset of a duration", "時間のオフセット", offset),
        (segments_in in _COUNT_BITS, "bits of segments", "区間数のビット数", segments_in),
        (samples_in in _COUNT_BITS, "bits of samples", "サンプル数のビット数", samples_in),
        (segments_in > 0 or segments > 0, "segments", "区間数", segments),
        (samples_in > 0 or 0 < samples <= MOST_SAMPLES, "samples", "サンプル数", samples),
        (bits in _SAMPLE_BITS, "bits of a sample", "サンプルのビット数", bits),
        (own == 0 or _is_spacing(own), "ns between samples", "サンプル間隔ns", own),
    )
    for is_right, english, japanese, found in checks:
        if not is_right:
            return _bad(english, japanese, found)
    return Text("", "")


def _sampling_of(values: _Numbers, units: float) -> PulseSampling:
    own = values[14] or units
    return PulseSampling(
        kind=values[2],
        channel=values[3],
        duration_bytes=values[5] // 8,
        duration_scale=values[6],
        duration_offset=values[7],
        segment_bytes=values[8] // 8,
        sample_bytes=values[9] // 8,
        segments=values[10],
        samples=values[11],
        bits=values[12],
        spacing_ps=round(own * _PS_IN_NS),
        steps=own / units,
    )


_ENDS_EARLY = Text(
    "Its record ends before all samplings are described.",
    "サンプリングの記述の途中でレコードが終わっています。",
)


def _bad(english: str, japanese: str, found: object) -> Text:
    return Text(f"It can't have {found} {english}.", f"{japanese}の値 {found} が正しくありません。")
