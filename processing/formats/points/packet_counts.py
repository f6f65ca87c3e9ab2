"""How many packets the points of a file name, counted in one pass and in bounded memory."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from processing.formats.points.delivered.point_chunk import PointFileInfo
from processing.formats.points.point_files import read_chunks
from processing.recording.waveform_packets.descriptors import DESCRIPTOR, PACKET, NoPacket


@dataclass(frozen=True)
class PacketCounts:
    """What the points of a file name.

    Attributes
    ----------
    packets, points : int
        Packets, and points that have one.
    lacking : dict of NoPacket to int
        Points without, by reason.
    used : frozenset of int
        The descriptors of the packets.
    """

    packets: int
    points: int
    lacking: dict[NoPacket, int]
    used: frozenset[int]


def count_packets(info: PointFileInfo) -> PacketCounts | None:
    """Count the packets of a file; None where it has no readable waveforms.

    Packets don't overlap, so two begin at least the shortest one's length apart: a mark for each
    such stretch of the packets' file, which is a bit in a thousand of it, tells them apart.

    Raises
    ------
    MissingInput, NoSpace, BadFile
    """
    waveforms = info.waveforms
    if waveforms is None or not waveforms.is_readable:
        return None
    lengths = [one.packet_bytes for one in waveforms.descriptors.values() if one.is_readable]
    shortest = min(lengths, default=1)
    marks = np.zeros(waveforms.size // shortest + 1, np.bool_)
    lacking = dict.fromkeys(NoPacket, 0)
    points, used = 0, np.zeros(256, np.bool_)
    for chunk in read_chunks(info.path):
        packets = chunk.columns[PACKET]
        has_packet = packets >= 0
        points += int(np.count_nonzero(has_packet))
        marks[packets[has_packet] // shortest] = True
        used[chunk.columns[DESCRIPTOR][has_packet]] = True
        for why in NoPacket:
            lacking[why] += int(np.count_nonzero(packets == why))
    return PacketCounts(
        packets=int(np.count_nonzero(marks)),
        points=points,
        lacking={why: count for why, count in lacking.items() if count},
        used=frozenset(np.flatnonzero(used).tolist()),
    )
