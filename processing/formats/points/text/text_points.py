"""Points as text: XYZ, PTS, TXT, CSV, with or without a header line."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path

from processing.formats.points.delivered.delivered_floats import ColumnBlock, FloatFile
from processing.formats.points.delivered.field_names import block_of
from processing.formats.points.text.column_words import PASSED_OVER
from processing.formats.points.text.text_header import Heading, read_beginning, read_heading
from processing.formats.points.text.text_numbers import TextPart, number_blocks
from processing.formats.points.text.wave_rows import wave_blocks, wave_rows_of, waveforms_of_rows


def open_text_points(path: Path, columns: tuple[str, ...] = ()) -> FloatFile:
    """A text file of points.

    Parameters
    ----------
    path : Path
        Lines of numbers, divided by blanks, tabs, commas or semicolons. A header line names the
        columns; without one they are x y z, x y z intensity, x y z red green blue, or x y z
        intensity red green blue (more are passed over). A first line with one whole number is
        the number of points (PTS) and passed over. Rows with a waveform are x y z label and its
        samples (:mod:`processing.formats.points.text.wave_rows`).
    columns : tuple of str
        What the columns are, whatever the file says; ``-`` for one that is passed over.

    Raises
    ------
    ColumnsNeeded
        Its header is not understood for certain.
    OutOfRange
        The given columns don't fit.
    MissingInput, NoSpace, BadFile
        It can't be read, is not text, or doesn't begin with points.
    """
    waves = None if columns else wave_rows_of(read_beginning(path))
    if waves is not None:
        delivered = waveforms_of_rows(path, waves)
        return FloatFile(path, "text", lambda: wave_blocks(path, waves), waveforms=delivered)
    heading = read_heading(path, columns)
    taken = () if heading.is_named else heading.columns
    return FloatFile(path, "text", lambda: _blocks(path, heading), taken)


def _blocks(path: Path, heading: Heading) -> Iterator[ColumnBlock]:
    wanted = {at: name for at, name in enumerate(heading.columns) if name != PASSED_OVER}
    width = len(heading.columns) if heading.has_words else None
    for numbers in number_blocks(TextPart(path, heading.start, width=width), tuple(wanted)):
        yield block_of({name: numbers[:, i] for i, name in enumerate(wanted.values())})
