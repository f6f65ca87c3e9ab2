"""Facts on the waveforms of a recording: how many, how they are coded, which points have none."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from processing.core.text import Text
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.drive import Drive
from processing.recording.waveform_packets.descriptors import (
    PACKET,
    WHY_NO_PACKET,
    NoPacket,
    PacketFile,
    WaveformDescriptor,
)
from processing.recording.waveform_packets.kept_packets import read_packet_files
from processing.recording.waveforms import waveforms_of


@dataclass(frozen=True)
class WaveformFacts:
    """What there is of waveforms.

    Attributes
    ----------
    pulses, points : int
        Packets, and points that have one.
    lacking : dict of NoPacket to int
        Points without, by reason.
    descriptors : tuple of WaveformDescriptor
        Those in use.
    files : tuple of PacketFile
        What the packets were delivered in.
    """

    pulses: int
    points: int
    lacking: dict[NoPacket, int]
    descriptors: tuple[WaveformDescriptor, ...]
    files: tuple[PacketFile, ...]

    @property
    def remarks(self) -> tuple[Text, ...]:
        """What is to be told of points and waveforms: how they came, what should be and is not."""
        told = [file.remark for file in self.files if file.remark.en]
        unread = [_NO_WAVEFORMS.filled(reason=file.reason) for file in self.files if file.reason.en]
        return (*told, *unread, *remarks_on_lacking(self.lacking))


_NO_WAVEFORMS = Text("No waveforms: {reason}", "波形なし: {reason}")
_LACKING = Text(
    "{points:,} points are used without their waveform: {reason}",
    "{points:,}点は波形なしで使用します（{reason}）",
)


def remarks_on_lacking(lacking: Mapping[NoPacket, int]) -> tuple[Text, ...]:
    """A line for each reason why points have no waveform, but that none was delivered."""
    return tuple(
        _LACKING.filled(points=points, reason=WHY_NO_PACKET[why])
        for why, points in lacking.items()
        if why is not NoPacket.NONE_GIVEN
    )


def waveform_facts(drive: Drive) -> WaveformFacts | None:
    """The facts of a drive; None where its files name no waveforms.

    Raises
    ------
    BadFile, MissingInput, NoSpace
    """
    files = read_packet_files(drive.folder)
    if not files and not drive.columns.has(PACKET):
        return None
    counts: dict[NoPacket, int] = {}
    if drive.columns.has(PACKET):
        for start, stop in chunk_ranges(drive.count):
            packets = read_chunk(drive.folder, PACKET, start, stop)
            for why in NoPacket:
                counts[why] = counts.get(why, 0) + int(np.count_nonzero(packets == why))
    waveforms = waveforms_of(drive)
    return WaveformFacts(
        pulses=0 if waveforms is None else waveforms.count,
        points=0 if waveforms is None else waveforms.point_count,
        lacking={why: points for why, points in counts.items() if points},
        descriptors=() if waveforms is None else waveforms.descriptors,
        files=files,
    )
