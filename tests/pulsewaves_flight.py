"""PulseWaves files of exactly known pulses, written field by field as the specification lists them.

Nothing of the program's reader is used, so that both can't err alike.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

LIGHT_M_NS = 299_792_458.0 / 2 * 1e-9
SCALE = (0.001, 0.001, 0.001)
OFFSET = (500_000.0, 4_000_000.0, 100.0)
FLYING_HEIGHT_M = 500.0
DURATION_SCALE, DURATION_OFFSET = 0.01, 3000.0
BASELINE, PULSE_SIGMA_NS = 5, 1.7
FLUCTUATES = -0x70000001

Wave = tuple[int, Sequence[int]]
"""Duration as it is stored, and samples."""


@dataclass(frozen=True)
class Sampling:
    """A sampling record; 0 bits of segments or samples: the fixed number counts."""

    kind: int = 2
    channel: int = 0
    duration_bits: int = 32
    duration_scale: float = DURATION_SCALE
    duration_offset: float = DURATION_OFFSET
    segment_bits: int = 8
    sample_bits: int = 16
    segments: int = 0
    samples: int = 0
    bits: int = 8
    units_ns: float = 1.0
    compression: int = 0

    def record(self) -> bytes:
        """The 104 bytes."""
        return struct.pack(
            "<IIBBBBffBBHIHHfI64s",
            *(104, 0, self.kind, self.channel, 0, self.duration_bits),
            *(self.duration_scale, self.duration_offset, self.segment_bits, self.sample_bits),
            *(self.segments, self.samples, self.bits, 0, self.units_ns, self.compression, b""),
        )

    def waves(self, segments: Sequence[Wave]) -> bytes:
        """What the waves file holds of one pulse and this sampling."""
        out = b""
        if self.segment_bits:
            out += len(segments).to_bytes(self.segment_bits // 8, "little")
        for duration, samples in segments:
            if self.duration_bits:
                out += duration.to_bytes(self.duration_bits // 8, "little", signed=True)
            if self.sample_bits:
                out += len(samples).to_bytes(self.sample_bits // 8, "little")
            out += b"".join(one.to_bytes(self.bits // 8, "little") for one in samples)
        return out


@dataclass(frozen=True)
class Composition:
    """A pulse descriptor."""

    samplings: tuple[Sampling, ...]
    centre: int = 0
    extra_bytes: int = 0
    units_ns: float = 1.0
    scanner: int = 0
    compression: int = 0

    def record(self) -> bytes:
        """Composition record and sampling records."""
        head = struct.pack(
            "<IIiHHfII64s",
            *(92, 0, self.centre, self.extra_bytes, len(self.samplings)),
            *(self.units_ns, self.compression, self.scanner, b""),
        )
        return head + b"".join(one.record() for one in self.samplings)


@dataclass(frozen=True)
class PulseOfFile:
    """A pulse record, and its waves: the segments of each sampling."""

    time: int
    anchor: tuple[int, int, int]
    target: tuple[int, int, int]
    waves: tuple[Sequence[Wave], ...]
    composition: int = 1
    first: int = 3300
    last: int = 3400
    source: int = 0


@dataclass(frozen=True)
class Head:
    """What a header says beside what its pulses say."""

    scale: tuple[float, float, float] = SCALE
    offset: tuple[float, float, float] = OFFSET
    time_scale: float = 1e-6
    time_offset: float = 0.0
    source: int = 7
    attributes: int = 0
    crs_code: int = 6677
    behind: Mapping[int, Composition] = field(default_factory=dict)


def write_pulses(
    path: Path,
    pulses: Sequence[PulseOfFile],
    compositions: Mapping[int, Composition],
    head: Head | None = None,
) -> None:
    """Write a ``.pls`` and its ``.wvs``."""
    head = head or Head()
    known = {**compositions, **head.behind}
    waves = bytearray(b"PulseWavesWaves\0" + bytes(44))
    records = b""
    for pulse in pulses:
        one = known[pulse.composition]
        records += struct.pack(
            "<qq6ihhHBB",
            *(pulse.time, len(waves), *pulse.anchor, *pulse.target, pulse.first, pulse.last),
            *(pulse.composition, 0, 0),
        )
        if head.attributes:
            records += struct.pack("<H" if head.attributes == 1 else "<I", pulse.source)
        waves += b"\xee" * one.extra_bytes
        for sampling, segments in zip(one.samplings, pulse.waves, strict=True):
            waves += sampling.waves(segments)
    path.with_suffix(".wvs").write_bytes(waves)
    keys = struct.pack("<12H", 1, 1, 0, 2, 1024, 0, 1, 1, 3072, 0, 1, head.crs_code)
    vlrs = [(b"PulseWaves_Proj", 34735, keys)]
    vlrs += [(b"PulseWaves_Spec", 200_000 + n, one.record()) for n, one in compositions.items()]
    before = b"".join(
        struct.pack("<16sIIq64s", user, number, 0, len(data), b"a record") + data
        for user, number, data in vlrs
    )
    behind = [(b"PulseWaves_Spec", 0xFFFFFFFF, b"")]
    behind += [(b"PulseWaves_Spec", 200_000 + n, one.record()) for n, one in head.behind.items()]
    after = b"".join(
        data + struct.pack("<16sIIq64s", user, number, 0, len(data), b"")
        for user, number, data in behind
    )
    size = 48 + (0, 2, 4)[head.attributes]
    times = [pulse.time for pulse in pulses] or [0]
    start = b"PulseWavesPulse\0"
    start += struct.pack("<II", 0, head.source)
    start += struct.pack("<IHH8s", 0, 0, 0, b"")
    start += struct.pack("<64s64s", b"a scanner", b"a test")
    start += struct.pack("<HHBBH", 1, 2020, 0, 3, 352)
    start += struct.pack("<qq", 352 + len(before), len(pulses))
    start += struct.pack("<IIIIq", 0, head.attributes, size, 0, 0)
    start += struct.pack("<Ii", len(vlrs), -1 if head.behind else 0)
    start += struct.pack("<dd", head.time_scale, head.time_offset)
    start += struct.pack("<qq", min(times), max(times))
    start += struct.pack("<6d", *head.scale, *head.offset) + bytes(48)
    path.write_bytes(start + before + records + after)


@dataclass(frozen=True)
class PulseFlight:
    """What was written.

    Attributes
    ----------
    xyz : (n, 3) float64
        Where light came back, in the order of pulses and ranges.
    pulse : (n,) int64
        The pulse of each.
    pulses : list of PulseOfFile
    rays : (k, 3) float64
        m for each ns, away from the scanner, as the rounded targets say.
    """

    path: Path
    xyz: NDArray[np.float64]
    pulse: NDArray[np.int64]
    pulses: list[PulseOfFile]
    rays: NDArray[np.float64]


FLIGHT = Composition(
    (
        Sampling(1, 3, 0, 1.0, 0.0, 0, 0, segments=1, samples=24),
        Sampling(),
    )
)
"""The light that left in 24 samples, and what returned, in segments of any number and length."""


def write_pulse_flight(
    path: Path, pulses: int = 120, *, composition: Composition = FLIGHT, head: Head | None = None
) -> PulseFlight:
    """Write a flight: every third pulse meets a crown 30 m above the ground before the ground."""
    head = head or Head()
    made, places, of_pulse, rays = [], [], [], []
    random = np.random.default_rng(3)
    for number in range(pulses):
        foot = np.array([random.uniform(-20, 20), 0.5 * number, 0.0])
        anchor = np.array([0.0, 0.5 * number, FLYING_HEIGHT_M])
        way = foot - anchor
        anchor_steps = np.rint(anchor / head.scale).astype(int)
        target = anchor + 1000 * LIGHT_M_NS * way / np.linalg.norm(way)
        target_steps = np.rint(target / head.scale).astype(int)
        anchor_m = anchor_steps * np.array(head.scale) + head.offset
        ray = (target_steps - anchor_steps) * np.array(head.scale) / 1000
        heights = (30.0, 0.0) if number % 3 == 0 else (0.0,)
        segments: list[Wave] = []
        for height in heights:
            along = (FLYING_HEIGHT_M - height) / -ray[2]
            begin = round((along - 20 - DURATION_OFFSET) / DURATION_SCALE)
            first = begin * DURATION_SCALE + DURATION_OFFSET
            length = 40 + number % 5
            segments.append((begin, echo(along - first, length, 100 + number % 7)))
            places.append(anchor_m + along * ray)
            of_pulse.append(number)
        left = echo(11.0, 24, 150)
        waves = tuple([(0, left)] if one.kind == 1 else segments for one in composition.samplings)
        made.append(
            PulseOfFile(
                400_000_000_000 + 20 * number,
                tuple(anchor_steps.tolist()),
                tuple(target_steps.tolist()),
                waves,
            )
        )
        rays.append(ray)
    write_pulses(path, made, {1: composition}, head)
    return PulseFlight(path, np.array(places), np.array(of_pulse), made, np.array(rays))


def echo(at: float, length: int, height: float, *, top: int = 255) -> list[int]:
    """Samples of one echo."""
    time = np.arange(length)
    wave = BASELINE + height * np.exp(-0.5 * ((time - at) / PULSE_SIGMA_NS) ** 2)
    return [int(one) for one in np.minimum(np.rint(wave), top)]
