"""What is known of packets of samples before one is read: how they are coded, and where they lie.

Reference: LAS 1.4 R15 (ASPRS 2019), waveform packet descriptors and waveform data packets.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import IntEnum

from processing.core.text import Text

PACKET, DESCRIPTOR = "wave_packet", "wave_descriptor"
LOCATION, DIRECTION = "wave_location", "wave_direction"
WAVE_COLUMNS = (PACKET, DESCRIPTOR, LOCATION, DIRECTION)
"""The columns that link a point with its waveform; a recording has all of them or none.

``wave_packet``: the packet's file and byte (:func:`packet_key`), or below 0 why there is none
(:class:`NoPacket`); ``wave_descriptor``: number of the descriptor as the file counts them;
``wave_location``: the return's time from the packet's first sample, ps; ``wave_direction``: m/ps,
with the sign that the file gives it.
"""

MOST_SAMPLES = 65_536
"""Longer packets are taken for damage: at 1 ns apart these are 9.8 km of range."""

MOST_SPACING_PS = 100_000
"""Samples farther apart are taken for damage: 15 m of range lie between two."""

_BITS = (8, 16, 32)
_FILE_BIT = 48


@dataclass(frozen=True)
class WaveformDescriptor:
    """How the samples of some packets are coded.

    Attributes
    ----------
    bits : int
        Of an unsigned sample: 8, 16 or 32, little-endian.
    samples : int
        In a packet.
    spacing_ps : int
        Between samples, ps.
    gain, offset : float
        Volts = offset + gain x counts.
    compression : int
        0 for plain samples; 1 as LAStools packs them.
    """

    bits: int
    samples: int
    spacing_ps: int
    gain: float
    offset: float
    compression: int = 0

    @property
    def interval_ns(self) -> float:
        """Between samples, ns."""
        return self.spacing_ps / 1000

    @property
    def packet_bytes(self) -> int:
        """What a plain packet takes."""
        return self.samples * self.bits // 8

    @property
    def is_readable(self) -> bool:
        """Whether its samples can be samples of a waveform at all."""
        has_samples = self.bits in _BITS and 0 < self.samples <= MOST_SAMPLES
        return has_samples and 0 < self.spacing_ps <= MOST_SPACING_PS


class NoPacket(IntEnum):
    """Why a point has no waveform; the column ``wave_packet`` holds these."""

    NONE_GIVEN = -1
    BEYOND_FILE = -2
    UNKNOWN_DESCRIPTOR = -3
    BAD_DESCRIPTOR = -4
    OTHER_SIZE = -5


WHY_NO_PACKET: Mapping[NoPacket, Text] = {
    NoPacket.NONE_GIVEN: Text("delivered without a waveform", "波形なしで納品"),
    NoPacket.BEYOND_FILE: Text(
        "packet beyond the end of the waveform file", "パケットが波形ファイルの終端を超える"
    ),
    NoPacket.UNKNOWN_DESCRIPTOR: Text(
        "descriptor that the file does not have", "ファイルに存在しない記述子"
    ),
    NoPacket.BAD_DESCRIPTOR: Text(
        "descriptor with no samples, with millions, too far apart, or of unknown coding",
        "記述子のサンプル数が0または過大、間隔が過大、もしくは符号化が不明",
    ),
    NoPacket.OTHER_SIZE: Text(
        "packet of another size than its descriptor says", "パケットの大きさが記述子と不一致"
    ),
}
"""The reasons in words, to follow a number of points."""


@dataclass(frozen=True)
class PacketFile:
    """A delivered file's packets, as a drive keeps them.

    Attributes
    ----------
    number : int
        Of the file, as the points' packets name it.
    delivered : str
        The file that the packets came in.
    descriptors : mapping of int to WaveformDescriptor
        By the number that points name.
    towards_sensor : bool
        Whether the points' directions lead back to the sensor, as LASlib reads them; the standard
        leaves it open and writers differ.
    sign_by : str
        What told it: ``returns`` (later returns of a pulse lie farther on), ``down`` (later
        samples lie lower, where no pulse has two returns), or empty where nothing did.
    reason : Text
        Why its points have no waveforms, to follow "no waveforms: "; empty where they have.
    echoes : int
        Points that were made of the waveforms; 0 where points were delivered.
    remark : Text
        What whoever works with its points is to know of how they came; mostly empty.
    """

    number: int
    delivered: str
    descriptors: Mapping[int, WaveformDescriptor] = field(default_factory=dict)
    towards_sensor: bool = True
    sign_by: str = ""
    reason: Text = Text("", "")
    echoes: int = 0
    remark: Text = Text("", "")


def packet_key(file: int, byte: int) -> int:
    """One number for a packet: its file's number, and the byte where it begins there."""
    return file << _FILE_BIT | byte


KEY_OF_FILE = 1 << _FILE_BIT
"""What file numbers are multiplied by in keys of packets: no file has 281 TB."""
