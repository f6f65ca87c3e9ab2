"""Segments of returned light in a PulseWaves file: which samples of the ``.wvs`` are whose.

A pulse may have several segments, each recorded by several channels of different sensitivity. A
point has one waveform, so of segments of one time that of the most sensitive channel is taken that
isn't cut off at the highest count.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.errors import UNCHANGED, BadFile, MissingInput, report_as_user_error
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.formats.points.las.las_header import damaged
from processing.formats.points.pulsewaves.pulse_composition import RETURNING, PulseSampling
from processing.formats.points.pulsewaves.pulsewaves_header import PulseWavesHeader, packed
from processing.recording.columns.mapped_pages import MappedPages
from processing.recording.waveform_packets.packet_samples import map_bytes

_ENDING, _PACKED_ENDING = ".wvs", ".wvz"
_SIGNATURE, _HEAD_BYTES = b"PulseWavesWaves\0", 60
_PULSES_AT_ONCE, _SEGMENTS_AT_ONCE = 16_384, 65_536
_MOST_SEGMENTS = 1_000
"""Of one pulse: a crown gives some ten, and no scanner records more."""

_RECORD = (
    ("time", "<i8", 0),
    ("waves", "<i8", 8),
    ("anchor", "(3,)<i4", 16),
    ("target", "(3,)<i4", 28),
    ("first", "<i2", 40),
    ("last", "<i2", 42),
    ("composition", "u1", 44),
)
"""Type 0; what else its 48 bytes say (edge, direction and facet of the mirror, intensity and class
of the pulse) has no place in a recording."""

_SHORT_SOURCE, _LONG_SOURCE = 1, 2
_BEYOND, _TOO_MANY = 1, 2


@dataclass(frozen=True, eq=False)
class SegmentBlock:
    """Consecutive pulses and their segments of returned light.

    Attributes
    ----------
    pulses : (n,) structured
        Their records.
    pulse, sampling : (k,) int64
        Each segment's pulse, a row of ``pulses``; and which of :attr:`PulseWaves.samplings`.
    byte, samples : (k,) int64
        Where its samples are in the ``.wvs``, and how many.
    start : (k,) float64
        Units of the composition from the anchor to the first sample.
    """

    pulses: NDArray[np.void]
    pulse: Integers
    sampling: Integers
    byte: Integers
    samples: Integers
    start: Floats


class PulseWaves:
    """A PulseWaves file opened with its samples, mapped: memory does not grow with it.

    Parameters
    ----------
    header : PulseWavesHeader

    Attributes
    ----------
    samplings : tuple of PulseSampling
        Of all compositions.
    data : (m,) uint8
        The ``.wvs``.

    Raises
    ------
    MissingInput, NoSpace, BadFile
        There is no ``.wvs``, or it is no such file.
    """

    def __init__(self, header: PulseWavesHeader) -> None:
        self.header = header
        self.path = waves_path(header.path)
        self._pages = MappedPages()
        self.data = map_bytes(self.path, self._pages)
        _check_head(self.path, bytes(self.data[:_HEAD_BYTES]))
        self.samplings: tuple[PulseSampling, ...] = ()
        self._places = np.zeros((256, 3), np.int64)
        for number, one in header.compositions.items():
            self._places[number] = len(self.samplings), len(one.samplings), one.extra_bytes
            self.samplings += one.samplings
        self._whole, self._real = _tables(self.samplings)
        self._record = np.dtype(
            {
                "names": [name for name, _, _ in _fields(header)],
                "formats": [kind for _, kind, _ in _fields(header)],
                "offsets": [at for _, _, at in _fields(header)],
                "itemsize": header.pulse_size,
            }
        )

    def blocks(self, kind: int = RETURNING) -> Iterator[SegmentBlock]:
        """All pulses in the file's order with their segments, some at a time.

        Raises
        ------
        NoSpace, BadFile
            A pulse is of a composition that the file does not have or nobody can read, its samples
            lie beyond the end of the ``.wvs``.
        """
        header = self.header
        for first in range(0, header.count, _PULSES_AT_ONCE):
            self._pages.look()
            count = min(_PULSES_AT_ONCE, header.count - first)
            with report_as_user_error(header.path), header.path.open("rb") as file:
                file.seek(header.pulses_at + first * header.pulse_size)
                read = file.read(count * header.pulse_size)
            pulses = np.frombuffer(
                read[: len(read) // header.pulse_size * header.pulse_size], self._record
            )
            if pulses.size < count:
                raise self._damaged_pulse(
                    first + pulses.size,
                    Text("The file became shorter.", "ファイルが短くなりました。"),
                )
            self._check_compositions(pulses["composition"], first)
            done = 0
            while done < count:
                block, walked = self._walk(pulses[done:], first + done, kind)
                done += walked
                yield block

    def _walk(self, pulses: NDArray[np.void], first: int, kind: int) -> tuple[SegmentBlock, int]:
        """The segments of as many of these pulses as there is room for."""
        waves = pulses["waves"].astype(np.int64)
        has_none = (pulses["first"] == 0) & (pulses["last"] == 0) & (waves < _HEAD_BYTES)
        waves[(waves < _HEAD_BYTES) & ~has_none] = self.data.size + 1
        waves[has_none] = -1
        whole = np.empty((_SEGMENTS_AT_ONCE, _FACTS), np.int64)
        start = np.empty(_SEGMENTS_AT_ONCE, np.float64)
        state = np.zeros(3, np.int64)
        _walk_kernel(
            self.data,
            waves,
            pulses["composition"].astype(np.int64),
            self._places,
            self._whole,
            self._real,
            kind,
            whole,
            start,
            state,
        )
        count, walked, error = state.tolist()
        if error == _BEYOND:
            raise self._beyond(first + walked, int(pulses["waves"][walked]))
        if error == _TOO_MANY:
            raise self._damaged_pulse(
                first + walked,
                Text(
                    f"It has more than {_MOST_SEGMENTS:,} segments of samples.",
                    f"サンプルの区間が{_MOST_SEGMENTS:,}を超えています。",
                ),
            )
        own = whole[:count].copy()
        block = SegmentBlock(
            pulses[:walked], own[:, 0], own[:, 1], own[:, 2], own[:, 3], start[:count].copy()
        )
        return block, walked

    def sources(self, block: SegmentBlock) -> Integers:
        """The scanner or flight line of each pulse of a block, as its file counts them.

        The scanner that its composition names where any names one; else the pulse's own source id;
        else the file's.
        """
        named = np.zeros(256, np.int64)
        for number, one in self.header.compositions.items():
            named[number] = one.scanner
        pulses = block.pulses
        if np.unique(named[named > 0]).size > 1:
            return np.asarray(named[pulses["composition"]])
        if "source" in (pulses.dtype.names or ()):
            return np.asarray(pulses["source"], np.int64)
        return np.full(pulses.size, self.header.source, np.int64)

    def _check_compositions(self, numbers: NDArray[np.uint8], first: int) -> None:
        for number in np.unique(numbers).tolist():
            composition = self.header.compositions.get(number)
            pulse = first + int((numbers == number).argmax())
            if composition is None:
                raise self._damaged_pulse(
                    pulse,
                    Text(
                        f"It names the pulse descriptor {number}, which the file does not have.",
                        f"パルス記述子{number}がファイルにありません。",
                    ),
                )
            if composition.is_packed:
                raise packed(self.header.path)
            if composition.fault.en:
                raise self._damaged_pulse(
                    pulse,
                    Text(
                        "Its pulse descriptor {number} can't be read: {fault}",
                        "パルス記述子{number}を読み取れません。{fault}",
                    ).filled(number=number, fault=composition.fault),
                )

    def _damaged_pulse(self, pulse: int, what: Text) -> BadFile:
        byte = self.header.pulses_at + pulse * self.header.pulse_size
        whole = Text("Pulse {pulse:,} is damaged. {what}", "パルス{pulse:,}が壊れています。{what}")
        return damaged(self.header.path, whole.filled(pulse=pulse + 1, what=what), byte)

    def _beyond(self, pulse: int, byte: int) -> BadFile:
        what = Text(
            "Its samples at byte {byte:,} do not lie in {name}, which ends at byte {end:,}.",
            "サンプルの位置（{byte:,}バイト目）が {name} の範囲外です（終端は{end:,}バイト目）。",
        )
        return self._damaged_pulse(
            pulse, what.filled(byte=byte, name=self.path.name, end=self.data.size)
        )


def waves_path(path: Path) -> Path:
    """The ``.wvs`` beside a ``.pls``.

    Raises
    ------
    MissingInput, BadFile
        There is none, or only a packed one.
    """
    for ending in (_ENDING, _ENDING.upper()):
        if path.with_suffix(ending).is_file():
            return path.with_suffix(ending)
    for ending in (_PACKED_ENDING, _PACKED_ENDING.upper()):
        if path.with_suffix(ending).is_file():
            raise packed(path.with_suffix(ending))
    raise MissingInput(
        Text(
            "The waveforms of the pulses are not beside them, and points are made of these.",
            "パルスの波形ファイルが同じフォルダにありません。点は波形から求めます。",
        ),
        Text.same(str(path.with_suffix(_ENDING))),
        Text(
            "Put it beside {name} under the same name. {unchanged}",
            "同じ名前で {name} と同じフォルダに置いてください。{unchanged}",
        ).filled(name=path.name, unchanged=UNCHANGED),
    )


def _check_head(path: Path, head: bytes) -> None:
    if not head.startswith(_SIGNATURE) or len(head) < _HEAD_BYTES:
        raise damaged(
            path,
            Text(
                "This is no file of PulseWaves samples: it doesn't begin with “PulseWavesWaves”.",
                "PulseWavesの波形ファイルではありません（先頭が「PulseWavesWaves」ではありません）。",
            ),
            0,
        )
    if int.from_bytes(head[16:20], "little"):
        raise packed(path)


def _fields(header: PulseWavesHeader) -> list[tuple[str, str, int]]:
    fields, place = list(_RECORD), 48
    if header.attributes & _SHORT_SOURCE:
        fields.append(("source", "<u2", place))
        place += 2
    if header.attributes & _LONG_SOURCE:
        fields = [one for one in fields if one[0] != "source"]
        fields.append(("source", "<u4", place))
    return fields


def _tables(samplings: tuple[PulseSampling, ...]) -> tuple[NDArray[np.int64], Floats]:
    """What the kernel wants to know of samplings."""
    whole = [
        (
            *(one.kind, one.channel, one.segment_bytes, one.duration_bytes, one.sample_bytes),
            *(one.segments, one.samples, one.bits // 8),
        )
        for one in samplings
    ]
    real = [(one.duration_scale, one.duration_offset, one.steps) for one in samplings]
    return (
        np.array(whole, np.int64).reshape(-1, 8),
        np.array(real, np.float64).reshape(-1, 3),
    )


def warm_up() -> None:
    """Compile the kernels."""
    one, real = np.ones(1, np.int64), np.ones((1, 3))
    _walk_kernel(
        np.zeros(1, np.uint8),
        -one,
        one,
        np.zeros((256, 3), np.int64),
        np.zeros((1, 8), np.int64),
        real,
        RETURNING,
        np.zeros((_MOST_SEGMENTS, _FACTS), np.int64),
        np.zeros(_MOST_SEGMENTS),
        np.zeros(3, np.int64),
    )


_FACTS = 7
"""Of a segment: pulse, sampling, byte, samples, highest count, whether it is cut off, channel."""


@kernel
def _number_at(data: NDArray[np.uint8], place: int, width: int) -> int:
    """An unsigned number; −1 where it does not lie in the file."""
    if place < 0 or place + width > data.size:
        return -1
    value = 0
    for byte in range(width):
        value |= int(data[place + byte]) << (8 * byte)
    return value


@kernel
def _highest(data: NDArray[np.uint8], place: int, samples: int, width: int) -> int:
    top = 0
    for sample in range(samples):
        value = int(data[place + sample * width])
        if width == 2:
            value |= int(data[place + sample * width + 1]) << 8
        top = max(top, value)
    return top


@kernel
def _segment_kernel(
    data: NDArray[np.uint8],
    place: int,
    facts: NDArray[np.int64],
    scale: NDArray[np.float64],
    whole: NDArray[np.int64],
    start: NDArray[np.float64],
) -> int:
    """Note one segment; the byte behind it, −1 where it does not lie in the file."""
    duration = 0
    if facts[3] > 0:
        duration = _number_at(data, place, facts[3])
        if duration < 0:
            return -1
        if duration >= 1 << (8 * facts[3] - 1):
            duration -= 1 << (8 * facts[3])
        place += facts[3]
    samples = int(facts[6])
    if facts[4] > 0:
        samples = _number_at(data, place, facts[4])
        if samples < 0:
            return -1
        place += facts[4]
    if place + samples * facts[7] > data.size:
        return -1
    whole[2], whole[3] = place, samples
    start[0] = duration * scale[0] + scale[1]
    return place + samples * int(facts[7])


@kernel
def _walk_kernel(
    data: NDArray[np.uint8],
    waves: NDArray[np.int64],
    composition: NDArray[np.int64],
    places: NDArray[np.int64],
    samplings: NDArray[np.int64],
    scales: NDArray[np.float64],
    kind: int,
    whole: NDArray[np.int64],
    start: NDArray[np.float64],
    state: NDArray[np.int64],
) -> None:
    """Note the segments of pulses until there is no room for those of another one.

    ``waves``: where a pulse's are, −1 for none. ``state``: segments noted, pulses walked, an error.
    """
    for row in range(waves.size):
        first = state[0]
        if first + _MOST_SEGMENTS > whole.shape[0]:
            return
        if waves[row] >= 0:
            _pulse_kernel(
                data,
                waves[row] + places[composition[row], 2],
                places[composition[row]],
                samplings,
                scales,
                kind,
                whole,
                start,
                state,
            )
            if state[2] != 0:
                return
            for at in range(first, state[0]):
                whole[at, 0] = row
            _choose_kernel(whole, start, scales, first, state)
        state[1] += 1


@kernel
def _pulse_kernel(
    data: NDArray[np.uint8],
    place: int,
    own: NDArray[np.int64],
    samplings: NDArray[np.int64],
    scales: NDArray[np.float64],
    kind: int,
    whole: NDArray[np.int64],
    start: NDArray[np.float64],
    state: NDArray[np.int64],
) -> None:
    """Note the segments of one pulse that are of a kind and not empty."""
    most = state[0] + _MOST_SEGMENTS
    for k in range(own[0], own[0] + own[1]):
        facts = samplings[k]
        segments = facts[5]
        if facts[2] > 0:
            segments = _number_at(data, place, facts[2])
            place += facts[2]
        if segments < 0:
            state[2] = _BEYOND
            return
        for _ in range(segments):
            at = min(state[0], whole.shape[0] - 1)
            place = _segment_kernel(data, place, facts, scales[k], whole[at], start[at : at + 1])
            if place < 0:
                state[2] = _BEYOND
                return
            if facts[0] != kind or whole[at, 3] == 0:
                continue
            if state[0] >= most:
                state[2] = _TOO_MANY
                return
            top = _highest(data, whole[at, 2], whole[at, 3], facts[7])
            whole[at, 1], whole[at, 4], whole[at, 6] = k, top, facts[1]
            whole[at, 5] = 1 if top >= (1 << (8 * facts[7])) - 1 else 0
            state[0] += 1


@kernel
def _choose_kernel(
    whole: NDArray[np.int64],
    start: NDArray[np.float64],
    scales: NDArray[np.float64],
    first: int,
    state: NDArray[np.int64],
) -> None:
    """Leave one channel's segment of those that overlap in time.

    The best is taken, and those of other channels that overlap with it are left out, again and
    again.
    """
    count = state[0] - first
    if count < 2:
        return
    fate = np.zeros(count, np.int64)  # 1 taken, -1 left out
    while True:
        best = -1
        for one in range(count):
            if fate[one] == 0 and (best < 0 or _is_better(whole[first + one], whole[first + best])):
                best = one
        if best < 0:
            break
        fate[best] = 1
        begin = start[first + best]
        end = begin + whole[first + best, 3] * scales[whole[first + best, 1], 2]
        for one in range(count):
            own = start[first + one]
            own_end = own + whole[first + one, 3] * scales[whole[first + one, 1], 2]
            is_other = whole[first + one, 6] != whole[first + best, 6]
            if fate[one] == 0 and is_other and own < end and begin < own_end:
                fate[one] = -1
    kept = first
    for one in range(count):
        if fate[one] == 1:
            whole[kept] = whole[first + one]
            start[kept] = start[first + one]
            kept += 1
    state[0] = kept


@kernel
def _is_better(one: NDArray[np.int64], other: NDArray[np.int64]) -> bool:
    """Whether a segment tells more than another: not cut off, and higher."""
    if one[5] != other[5]:
        return bool(one[5] < other[5])
    return bool(one[4] > other[4])
