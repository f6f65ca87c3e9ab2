"""Samples out of packets: bytes of a mapped file to counts."""

from __future__ import annotations

import mmap
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from processing.core.errors import UNCHANGED, BadFile, report_as_user_error
from processing.core.kernels import kernel
from processing.core.text import Text
from processing.recording.columns.mapped_pages import MappedPages


def map_bytes(path: Path, pages: MappedPages) -> NDArray[np.uint8]:
    """A file's bytes, mapped and not to be written.

    Raises
    ------
    MissingInput, BadFile
    """
    with report_as_user_error(path):
        if not path.stat().st_size:
            return np.empty(0, np.uint8)
        with path.open("rb") as file:
            mapped = mmap.mmap(file.fileno(), 0, access=mmap.ACCESS_READ)
    pages.add(mapped)
    return np.frombuffer(mapped, np.uint8)


def read_samples(
    data: NDArray[np.uint8],
    starts: NDArray[np.int64],
    lengths: NDArray[np.int32],
    widths: NDArray[np.int32],
    out: NDArray[np.float32],
) -> None:
    """Counts of plain packets.

    Parameters
    ----------
    data : (m,) uint8
        The file.
    starts : (k,) int64
        Byte of each packet.
    lengths, widths : (k,) int32
        Samples in it, and bytes of one.
    out : (k, at least the longest) float32
        Filled with counts, 0 behind the packet's end.

    Raises
    ------
    BadFile
        A packet does not lie in the file: it is shorter than it was when it was imported.
    """
    if starts.size and int((starts + lengths * widths.astype(np.int64)).max()) > data.size:
        raise _too_short()
    _read_samples_kernel(data, starts, lengths, widths, out)


def _too_short() -> BadFile:
    return BadFile(
        Text(
            "A file of waveforms is shorter than its points say.",
            "波形ファイルが点の情報より短くなっています。",
        ),
        Text("waveforms of the drive", "走行データの波形"),
        Text(
            "Import the drive again from the delivered files. {unchanged}",
            "納品ファイルから走行データを再インポートしてください。{unchanged}",
        ).filled(unchanged=UNCHANGED),
    )


def warm_up() -> None:
    """Compile the kernels."""
    one = np.ones(1, np.int32)
    read_samples(np.zeros(1, np.uint8), np.zeros(1, np.int64), one, one, np.zeros((1, 1), "f4"))


@kernel
def _read_samples_kernel(
    data: NDArray[np.uint8],
    starts: NDArray[np.int64],
    lengths: NDArray[np.int32],
    widths: NDArray[np.int32],
    out: NDArray[np.float32],
) -> None:
    for row in range(starts.size):
        at, width, length = starts[row], widths[row], lengths[row]
        for sample in range(length):
            value = np.int64(0)
            for byte in range(width):
                value |= np.int64(data[at + byte]) << (8 * byte)
            out[row, sample] = value
            at += width
        for sample in range(length, out.shape[1]):
            out[row, sample] = 0.0
