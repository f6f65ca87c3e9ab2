"""Waveforms of a recording: their packets are taken over into the drive's folder, and indexed."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import numpy as np

from processing.core.disk_room import refuse_small_disk
from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.format import function_of
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.project.importing.recording import Recording
from processing.recording.columns.ordering import chunk_ranges, read_chunk
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    KEY_OF_FILE,
    PACKET,
    PacketFile,
)
from processing.recording.waveform_packets.kept_packets import (
    link_file,
    packets_path,
    write_packet_files,
)
from processing.recording.waveform_packets.pulse_index import make_pulse_index
from processing.recording.waveform_packets.ray_signs import ray_signs

_COPIED_BYTES = 8 << 20
_COPYING = Text("Copying waveforms of {name}", "{name} の波形をコピー中")


def keep_waveforms(
    recording: Recording,
    waveforms: Mapping[int, DeliveredWaveforms],
    name: str,
    monitor: Monitor,
) -> None:
    """Take over the packets that a recording's points name, and make the index of its pulses.

    Of files whose waveforms can't be read the reason is kept. May be done again; what a killed
    import copied whole stays.

    Parameters
    ----------
    waveforms : mapping of int to DeliveredWaveforms
        By number of the delivered file; a drive that is completed has its packets already.
    name : str
        The recording's.

    Raises
    ------
    UserError, Cancelled
    """
    unread = [
        PacketFile(number=number, delivered=str(one.path), reason=one.reason)
        for number, one in waveforms.items()
        if number in recording.sources and not one.is_readable
    ]
    if PACKET not in recording.names or not waveforms:
        if unread:
            write_packet_files(recording.folder, unread)
        return
    monitor.report(1.0, _COPYING.filled(name=name))
    used = _used_descriptors(recording)
    for number in used:
        _take_packets(waveforms[number], number, recording.folder, monitor)
    make_pulse_index(recording.folder, recording.count, monitor)
    signs = ray_signs(recording.folder, recording.count, recording.quantisation)
    files = [
        PacketFile(
            number=number,
            delivered=str(waveforms[number].path),
            descriptors={one: waveforms[number].descriptors[one] for one in sorted(used[number])},
            towards_sensor=signs[number].towards_sensor,
            sign_by=signs[number].told_by,
            echoes=waveforms[number].echoes,
            remark=waveforms[number].remark,
        )
        for number in sorted(used)
    ]
    write_packet_files(recording.folder, [*files, *unread])


def _used_descriptors(recording: Recording) -> dict[int, set[int]]:
    """The descriptors that points name, by number of the file."""
    used: dict[int, set[int]] = {}
    for start, stop in chunk_ranges(recording.count):
        packets = read_chunk(recording.folder, PACKET, start, stop)
        numbers = read_chunk(recording.folder, DESCRIPTOR, start, stop)
        chosen = packets >= 0
        pairs = np.unique(packets[chosen] // KEY_OF_FILE * 256 + numbers[chosen])
        for pair in pairs.tolist():
            used.setdefault(pair // 256, set()).add(pair % 256)
    return used


def _take_packets(source: DeliveredWaveforms, number: int, folder: Path, monitor: Monitor) -> None:
    """Copy a file's packets; another recording of the same import may have them already."""
    target = packets_path(folder, number)
    if _is_whole(target, source.size):
        return
    for other in sorted(folder.parent.glob(f"*/{target.name}")):
        if _is_whole(other, source.size):
            link_file(other, target)
            return
    refuse_small_disk(folder, source.size)
    temporary = target.with_suffix(".part")
    if source.pack:
        with report_as_user_error(folder), temporary.open("wb") as made:
            function_of(source.pack)(source.path, made, monitor)
        temporary.replace(target)
        return
    with report_as_user_error(source.path), source.path.open("rb") as file:
        file.seek(source.first_byte)
        with temporary.open("wb") as copy:
            left = source.size
            while left:
                monitor.check()
                data = file.read(min(left, _COPIED_BYTES))
                if not data:
                    raise _became_shorter(source.path)
                copy.write(data)
                left -= len(data)
        temporary.replace(target)


def _is_whole(path: Path, size: int) -> bool:
    return path.is_file() and path.stat().st_size == size


def _became_shorter(path: Path) -> BadFile:
    return BadFile(
        Text(
            "The file became shorter while its waveforms were copied.",
            "波形のコピー中にファイルが短くなりました。",
        ),
        Text.same(str(path)),
        Text(
            "Import it again when nothing writes to it any more. {unchanged}",
            "書き込みが終わってから、もう一度インポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )
