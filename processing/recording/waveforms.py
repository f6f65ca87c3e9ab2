"""Waveforms: the pulses of a recording whose returned light was sampled, and the returns on them.

A pulse here is one packet of samples. A pulse whose returns lie far apart may have been delivered
in two packets, which the time of their points tells.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.errors import UNCHANGED, BadFile
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.drive import Drive
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    DIRECTION,
    KEY_OF_FILE,
    LOCATION,
    PACKET,
    WAVE_COLUMNS,
    PacketFile,
    WaveformDescriptor,
)
from processing.recording.waveform_packets.kept_packets import packets_path, read_packet_files
from processing.recording.waveform_packets.packet_samples import map_bytes, read_samples
from processing.recording.waveform_packets.pulse_index import (
    KEYS,
    POINTS,
    STARTS,
    has_pulse_index,
    make_pulse_index,
)

_PS_IN_NS = 1000.0
_VALUES_AT_ONCE = 16_000_000
_NO_DESCRIPTOR = 65_535


@dataclass(frozen=True, eq=False)
class Pulses:
    """Facts on k packets.

    Attributes
    ----------
    numbers : (k,) int64
        Of the packets.
    owners : (k,) int64
        The point that each packet counts for: its first return.
    returns : (k,) int32
        Points on it.
    descriptor : (k,) uint16
        Index into :attr:`Waveforms.descriptors`.
    lengths : (k,) int32
        Samples.
    interval_ns, gain, offset : (k,) float64
        Between samples; volts = offset + gain x counts.
    anchor : (k, 3) float64
        Place of the first sample, m, project CRS; NaN where no ray was delivered.
    direction : (k, 3) float64
        Away from the sensor, m for each ns of the samples: half the speed of light.
    file : (k,) uint16
        Number of the delivered file, as :class:`PacketFile` has it.
    byte : (k,) int64
        Where the packet begins in it.
    """

    numbers: Integers
    owners: Integers
    returns: NDArray[np.int32]
    descriptor: NDArray[np.uint16]
    lengths: NDArray[np.int32]
    interval_ns: Floats
    gain: Floats
    offset: Floats
    anchor: Floats
    direction: Floats
    file: NDArray[np.uint16]
    byte: Integers

    def xyz_at(self, rows: Integers, time_ns: Floats) -> Floats:
        """Places on the pulses' rays.

        Parameters
        ----------
        rows : (m,) int64
            Which of these pulses.
        time_ns : (m,) float64
            After the first sample.

        Returns
        -------
        (m, 3) float64
            m, project CRS.
        """
        return np.asarray(self.anchor[rows] + time_ns[:, None] * self.direction[rows])


@dataclass(frozen=True, eq=False)
class PulseBlock:
    """Consecutive pulses with their samples.

    Attributes
    ----------
    samples : (k, m) float32
        Counts; m is the longest length of the block, and 0 stands behind a shorter packet's end.
    """

    pulses: Pulses
    samples: NDArray[np.float32]


def waveforms_of(drive: Drive) -> Waveforms | None:
    """The waveforms of a drive, None where no point has one; opened once.

    Raises
    ------
    BadFile, MissingInput, NoSpace
        The drive's packets are damaged or gone.
    """

    def make() -> Waveforms | None:
        if not all(drive.columns.has(name) for name in WAVE_COLUMNS):
            return None
        found = Waveforms(drive)
        return found if found.count else None

    return drive.kept("waveforms", make)


class Waveforms:
    """All packets of a drive, mapped: memory does not grow with the flight.

    Parameters
    ----------
    drive : Drive
        With the columns of :data:`WAVE_COLUMNS`.

    Attributes
    ----------
    files : tuple of PacketFile
        What they were delivered in.
    descriptors : tuple of WaveformDescriptor
        Of all files.

    Raises
    ------
    BadFile, MissingInput, NoSpace
        As :func:`waveforms_of`.
    """

    def __init__(self, drive: Drive) -> None:
        self._drive = drive
        self._pages = MappedPages()
        folder = drive.folder
        if not has_pulse_index(folder):
            make_pulse_index(folder, drive.count, SilentMonitor())
        self._keys, self._starts, self._points = (
            map_bytes(folder / name, self._pages).view("<i8") for name in (KEYS, STARTS, POINTS)
        )
        self._check_index()
        self.files: tuple[PacketFile, ...] = read_packet_files(folder)
        self._data = {
            file.number: map_bytes(packets_path(folder, file.number), self._pages)
            for file in self.files
            if not file.reason.en
        }
        self.descriptors, self._local = _merge_descriptors(self.files)

    @property
    def count(self) -> int:
        """Number of packets."""
        return int(self._keys.size)

    @property
    def point_count(self) -> int:
        """Points with a waveform."""
        return int(self._points.size)

    @cached_property
    def most_samples(self) -> int:
        """The longest packet's."""
        return max((one.samples for one in self.descriptors), default=0)

    def pulse_of(self, points: Integers | slice) -> Integers:
        """The number of each point's packet.

        Returns
        -------
        (k,) int64
            −1 where the point has none.
        """
        keys = np.asarray(self._drive.columns[PACKET][points])
        found = np.searchsorted(self._keys, keys)
        return np.where(keys >= 0, np.minimum(found, self.count - 1), -1).astype(np.int64)

    def location_ns(self, points: Integers | slice) -> Floats:
        """Where returns lie in their packets, ns after the first sample; NaN without a packet."""
        columns = self._drive.columns
        ns = columns[LOCATION][points].astype(np.float64) / _PS_IN_NS
        return np.where(np.asarray(columns[PACKET][points]) >= 0, ns, np.nan)

    def points_of(self, pulse: int) -> Integers:
        """The returns on a packet, by their place in it."""
        first, end = int(self._starts[pulse]), int(self._starts[pulse + 1])
        points = np.array(self._points[first:end])
        order = np.argsort(self._drive.columns[LOCATION][points], kind="stable")
        return np.asarray(points[order], np.int64)

    def returns_of(self, numbers: Integers) -> tuple[Integers, Integers]:
        """The points on packets.

        Parameters
        ----------
        numbers : (k,) int64

        Returns
        -------
        points, row : (m,) int64
            Packet by packet, its owner first; which of the k each is on.
        """
        first = np.asarray(self._starts[:-1][numbers], np.int64)
        count = np.asarray(self._starts[1:][numbers], np.int64) - first
        row = np.repeat(np.arange(count.size), count)
        within = np.arange(row.size) - np.repeat(np.cumsum(count) - count, count)
        return np.asarray(self._points[first[row] + within], np.int64), row

    def owners(self, numbers: Integers | slice) -> Integers:
        """The point that each packet counts for: its first return, (k,) int64."""
        return np.asarray(self._points[self._starts[:-1][numbers]], np.int64)

    def are_owners(self, points: Integers | slice) -> Flags:
        """Which points own a packet; each packet has one owner."""
        if isinstance(points, slice):
            points = np.arange(*points.indices(self._drive.count), dtype=np.int64)
        pulses = self.pulse_of(points)
        return np.asarray((pulses >= 0) & (self.owners(pulses) == points))

    def pulses(self, numbers: Integers | slice) -> Pulses:
        """Facts on packets.

        Raises
        ------
        BadFile
            A point names a packet of which the drive knows nothing.
        """
        self._pages.look()
        if isinstance(numbers, slice):
            numbers = np.arange(*numbers.indices(self.count), dtype=np.int64)
        columns, owners = self._drive.columns, self.owners(numbers)
        keys = np.asarray(self._keys[numbers])
        file, byte = keys // KEY_OF_FILE, keys % KEY_OF_FILE
        descriptor = self._descriptors_of(file, columns[DESCRIPTOR][owners])
        facts = np.array(
            [(one.interval_ns, one.gain, one.offset) for one in self.descriptors]
        ).reshape(-1, 3)[descriptor]
        lengths = np.array([one.samples for one in self.descriptors], np.int32)[descriptor]
        direction = columns[DIRECTION][owners].astype(np.float64) * _PS_IN_NS
        direction *= -self._signs(file)[:, None]
        location = columns[LOCATION][owners].astype(np.float64) / _PS_IN_NS
        return Pulses(
            numbers=numbers,
            owners=owners,
            returns=(self._starts[1:][numbers] - self._starts[:-1][numbers]).astype(np.int32),
            descriptor=descriptor,
            lengths=lengths,
            interval_ns=facts[:, 0],
            gain=facts[:, 1],
            offset=facts[:, 2],
            anchor=self._drive.xyz(owners) - location[:, None] * direction,
            direction=direction,
            file=file.astype(np.uint16),
            byte=byte,
        )

    def samples_of(self, numbers: Integers) -> NDArray[np.float32]:
        """Samples of packets.

        Returns
        -------
        (k, most_samples) float32
            Counts, 0 behind a packet's end.

        Raises
        ------
        BadFile
        """
        return self._read(self.pulses(numbers), self.most_samples)

    def blocks(
        self, pulses: int = 65_536, *, start: int = 0, stop: int | None = None
    ) -> Iterator[PulseBlock]:
        """Packets as they lie in their files, some at a time.

        Parameters
        ----------
        pulses : int
            In a block at most; fewer where packets are long.
        start, stop : int
            The first packet, and the one before which to end; None for all.

        Raises
        ------
        BadFile
        """
        end = self.count if stop is None else min(stop, self.count)
        at_once = max(1, min(pulses, _VALUES_AT_ONCE // max(self.most_samples, 1)))
        for first in range(start, end, at_once):
            some = self.pulses(slice(first, min(first + at_once, end)))
            yield PulseBlock(some, self._read(some, int(some.lengths.max())))

    def _read(self, pulses: Pulses, most: int) -> NDArray[np.float32]:
        self._pages.look()
        samples = np.empty((pulses.numbers.size, most), np.float32)
        widths = np.array([one.bits // 8 for one in self.descriptors], np.int32)[pulses.descriptor]
        for number in np.unique(pulses.file).tolist():
            mine = np.flatnonzero(pulses.file == number)
            read = samples if mine.size == len(samples) else np.empty((mine.size, most), np.float32)
            read_samples(
                self._data[number], pulses.byte[mine], pulses.lengths[mine], widths[mine], read
            )
            if read is not samples:
                samples[mine] = read
        return samples

    def _signs(self, files: Integers) -> Floats:
        """1 where delivered directions lead to the sensor, −1 where they lead away."""
        signs = np.ones(max((file.number for file in self.files), default=0) + 1)
        for file in self.files:
            signs[file.number] = 1.0 if file.towards_sensor else -1.0
        return np.asarray(signs[files])

    def _descriptors_of(self, files: Integers, numbers: NDArray[np.uint8]) -> NDArray[np.uint16]:
        found: NDArray[np.uint16] = np.full(files.shape, _NO_DESCRIPTOR, np.uint16)
        is_known = (files >= 0) & (files < len(self._local))
        found[is_known] = self._local[files[is_known], numbers[is_known]]
        if (found == _NO_DESCRIPTOR).any():
            raise self._damaged()
        return found

    def _check_index(self) -> None:
        """Refuse an index that is not of this drive; one look at each number's bounds."""
        fits = self._starts.size == self._keys.size + 1 and self._starts[-1] == self._points.size
        if fits and self.count:
            fits = int(self._points.min()) >= 0 and int(self._points.max()) < self._drive.count
        if not fits:
            raise self._damaged()

    def _damaged(self) -> BadFile:
        return BadFile(
            Text(
                "What links the points with their waveforms is damaged.",
                "点と波形を結ぶ情報が壊れています。",
            ),
            Text.same(str(self._drive.folder)),
            Text(
                "Import the drive again from the delivered files. {unchanged}",
                "納品ファイルから走行データを再インポートしてください。{unchanged}",
            ).filled(unchanged=UNCHANGED),
        )


def _merge_descriptors(
    files: tuple[PacketFile, ...],
) -> tuple[tuple[WaveformDescriptor, ...], NDArray[np.uint16]]:
    """The descriptors of all files, each once, and the index of each by file and number."""
    merged: dict[WaveformDescriptor, int] = {}
    most = max((file.number for file in files), default=-1) + 1
    local = np.full((most, 256), _NO_DESCRIPTOR, np.uint16)
    for file in files:
        for number, one in file.descriptors.items():
            if one.is_readable:
                local[file.number, number] = merged.setdefault(one, len(merged))
    return tuple(merged), local
