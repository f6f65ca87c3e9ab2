"""A scanner's pulse as a table: its response to one flat target, by time."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from processing.core.arrays import Floats
from processing.core.errors import BadFile, report_as_user_error
from processing.core.japanese_text import read_lines
from processing.core.text import Text

_LARGEST_BYTES = 4 << 20
_COLUMNS = 2
_REMEDY = Text(
    "Give two columns, time_ns and amplitude, with times that rise.",
    "time_ns と amplitude の2列を、時刻の昇順で指定してください。",
)


def read_pulse(path: Path) -> tuple[Floats, Floats]:
    """Times, ns, evenly apart, and amplitudes at them in any unit.

    Time 0 is where a target's range is taken. Times that lie unevenly are interpolated.

    Raises
    ------
    BadFile
        It isn't such a table; says which line.
    UserError
        The file can't be read.
    """
    with report_as_user_error(path):
        size = path.stat().st_size
    if size > _LARGEST_BYTES:
        raise _bad(path, 1)
    rows = [(number, row) for number, row in enumerate(csv.reader(read_lines(path)), 1) if any(row)]
    values: list[tuple[float, float]] = []
    for position, (number, row) in enumerate(rows):
        numbers = _numbers(row)
        if numbers is None and position == 0:
            continue  # the header
        if numbers is None or (values and numbers[0] <= values[-1][0]):
            raise _bad(path, number)
        values.append(numbers)
    if len(values) < _COLUMNS:
        raise _bad(path, 1)
    times, amplitudes = np.array(values).T
    even = np.linspace(times[0], times[-1], len(times))
    return even, np.interp(even, times, amplitudes)


def _numbers(row: list[str]) -> tuple[float, float] | None:
    try:
        time, amplitude = (float(cell) for cell in row[:_COLUMNS])
    except ValueError:
        return None
    return (time, amplitude) if math.isfinite(time) and math.isfinite(amplitude) else None


def _bad(path: Path, line: int) -> BadFile:
    return BadFile(
        Text("This is no table of a pulse.", "パルス波形の表ではありません。"),
        Text(f"{path}, line {line}", f"{path} {line}行目"),
        _REMEDY,
    )
