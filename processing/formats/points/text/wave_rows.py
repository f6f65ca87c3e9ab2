"""Rows of text with a waveform each: ``x y z label w0 … w159``, samples of 1 ns, first returns.

The rows say neither how the beam ran nor where in its waveform the return lies. The beam is taken
to come straight down, and the return to be the first maximum that is clear.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import BinaryIO

import numpy as np
from numpy.typing import NDArray

from processing.core.monitor import Monitor
from processing.formats.points.delivered.delivered_floats import ColumnBlock
from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms
from processing.formats.points.text.text_header import Heading, TextBeginning, read_beginning
from processing.formats.points.text.text_numbers import TextPart, number_blocks
from processing.recording.waveform_packets.descriptors import (
    DESCRIPTOR,
    DIRECTION,
    LOCATION,
    PACKET,
    WaveformDescriptor,
)

_BEFORE = 4
"""Columns before the samples: x, y, z and the label."""

_LEAST_SAMPLES = 32
"""Rows with fewer numbers behind a whole one are points with attributes: 32 ns are 5 m of range."""

_MOST_LABEL = 255
_SAMPLE_NAME = re.compile(r"w(?:ave)?_?\d+", re.IGNORECASE)
_INTERVAL_PS = 1000
_NUMBER, _BITS = 1, 32
_GAIN, _LOWEST = 0.001, -1000.0
"""Counts are thousandths from −1000 on: whole ones stay as they are, cleaned ones may be negative.
"""

_TOWARDS_SENSOR_M_PS = 299_792_458.0 / 2 * 1e-12
_CLEAR = 0.25
"""Share of a row's highest sample that the first return has at least."""

_PACK = "processing.formats.points.text.wave_rows:write_packets"


def wave_rows_of(begins: TextBeginning) -> Heading | None:
    """What the columns of rows with waveforms are; None where rows have none.

    A header names the samples w0, w1 and so on, or there is none, the fourth number is a class,
    and so many follow that they can only be samples.
    """
    samples = begins.width - _BEFORE
    if samples < 1 or begins.has_words:
        return None
    named = any(_names_samples(text, begins.width) for _, text in begins.header)
    if not named and (begins.header or samples < _LEAST_SAMPLES):
        return None
    if not named and not all(_is_label(row) for row in begins.rows):
        return None
    columns = ("x", "y", "z", "classification", *("-" for _ in range(samples)))
    return Heading(columns, begins.start, has_words=False, is_named=True)


def waveforms_of_rows(path: Path, heading: Heading) -> DeliveredWaveforms:
    """Where the waveforms of such a file are; how many bytes they take is told by its rows."""
    samples = len(heading.columns) - _BEFORE
    descriptor = WaveformDescriptor(_BITS, samples, _INTERVAL_PS, _GAIN, _LOWEST)
    return DeliveredWaveforms(path=path, descriptors={_NUMBER: descriptor}, pack=_PACK)


def wave_blocks(path: Path, heading: Heading) -> Iterator[ColumnBlock]:
    """The points of rows, each with its waveform's place and its height as intensity."""
    width = len(heading.columns)
    first = 0
    for numbers in _rows(path, heading):
        count, samples = len(numbers), numbers[:, _BEFORE:]
        place = _first_returns(samples)
        rows = np.arange(first, first + count, dtype=np.int64)
        direction = np.zeros((count, 3), np.float32)
        direction[:, 2] = _TOWARDS_SENSOR_M_PS
        yield {
            "xyz": numbers[:, :3],
            "classification": numbers[:, 3],
            "intensity": np.maximum(samples[np.arange(count), place], 0.0),
            PACKET: rows * (width - _BEFORE) * (_BITS // 8),
            DESCRIPTOR: np.full(count, _NUMBER, np.uint8),
            LOCATION: (place * float(_INTERVAL_PS)).astype(np.float32),
            DIRECTION: direction,
        }
        first += count


def write_packets(path: Path, into: BinaryIO, monitor: Monitor) -> None:
    """Write the samples of all rows as packets, one behind the other.

    Raises
    ------
    MissingInput, NoSpace, BadFile, Cancelled
    """
    heading = wave_rows_of(read_beginning(path))
    if heading is None:
        raise TypeError(path)
    highest = float(np.iinfo(np.uint32).max)
    for numbers in _rows(path, heading):
        monitor.check()
        counts = np.rint((np.nan_to_num(numbers[:, _BEFORE:]) - _LOWEST) / _GAIN)
        into.write(np.clip(counts, 0.0, highest).astype("<u4").tobytes())


def _rows(path: Path, heading: Heading) -> Iterator[NDArray[np.float64]]:
    width = len(heading.columns)
    return number_blocks(TextPart(path, heading.start, width=width), range(width))


def _first_returns(samples: NDArray[np.float64]) -> NDArray[np.int64]:
    """(n,) the first sample of each row that is a maximum and no small one."""
    padded = np.pad(samples, ((0, 0), (1, 1)), constant_values=-np.inf)
    is_peak = (samples >= padded[:, :-2]) & (samples > padded[:, 2:])
    clear = is_peak & (samples >= _CLEAR * samples.max(axis=1, keepdims=True))
    return np.asarray(clear.argmax(axis=1), np.int64)


def _names_samples(text: str, width: int) -> bool:
    words = [word for word in re.split(r"[\s,;]+", text.lstrip("#/%; ")) if word]
    return len(words) == width and all(_SAMPLE_NAME.fullmatch(word) for word in words[_BEFORE:])


def _is_label(row: tuple[str, ...]) -> bool:
    value = float(row[_BEFORE - 1]) if len(row) >= _BEFORE else -1.0
    return value.is_integer() and 0 <= value <= _MOST_LABEL
