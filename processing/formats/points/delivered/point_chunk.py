"""What every reader of point files gives: the file's facts, and its points a chunk at a time."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import Any

from numpy.typing import NDArray

from processing.formats.points.delivered.delivered_waveforms import DeliveredWaveforms

Vector3 = tuple[float, float, float]


@dataclass(frozen=True)
class PointFileInfo:
    """What a point file says of itself.

    Attributes
    ----------
    format : str
        ``LAS``, ``LAZ``, ``COPC``, ``PLY``, ``PCD``, ``E57``, ``PTX``, ``PulseWaves``, ``text``.
    count : int
        Points.
    scale, offset : tuple of float
        Metres = integers x scale + offset.
    lowest, highest : tuple of float
        Extent, m; NaN where the file doesn't know it.
    crs : str
        ``EPSG:n`` of the horizontal system; empty when the file names none.
    has_time, has_color : bool
        Whether its points come with a time, with a colour.
    is_adjusted_standard : bool or None
        True: times are GPS seconds less 1e9; None: week seconds, or it is not said.
    first_time : float
        Time of the first point, NaN without.
    version, point_format : str, int
        Of LAS; empty and -1 elsewhere.
    waveforms : DeliveredWaveforms or None
        What its points refer to, also where it can't be read; None of files without waveforms.
    attributes : tuple of str
        Names of the columns of a chunk but ``xyz``, then names of extra dimensions.
    scanner_positions : tuple of (int, tuple of float)
        Of files of standing scanners: each scan's number, which is that of its points' scanner
        where there are several, and where the scanner stood, m.
    columns_taken : tuple of str
        Of text that doesn't name its columns: what each is taken for, ``-`` for one that is passed
        over.
    """

    path: Path
    format: str
    count: int
    scale: Vector3
    offset: Vector3
    lowest: Vector3
    highest: Vector3
    crs: str
    has_time: bool
    has_color: bool
    is_adjusted_standard: bool | None = None
    first_time: float = float("nan")
    version: str = ""
    point_format: int = -1
    waveforms: DeliveredWaveforms | None = None
    attributes: tuple[str, ...] = ()
    scanner_positions: tuple[tuple[int, Vector3], ...] = ()
    columns_taken: tuple[str, ...] = ()


@dataclass(frozen=True)
class PointChunk:
    """Consecutive points of a file, in its order.

    Attributes
    ----------
    columns : dict of str to array
        ``xyz`` (n, 3) int32; ``intensity``, ``scanner`` uint16; ``return_number``,
        ``number_of_returns``, ``classification``, ``user_data`` uint8; and where the file has
        them ``time`` float64 (s, NaN where it is no time), ``scan_angle_deg`` float32, ``color``
        (n, 3) uint16, ``origin`` (n, 3) float64 (where the scanner was, m), ``label`` uint8
        (painted by hand, from an extra dimension of LAS), ``grid`` (n, 2) int32 (a structured
        scan's sweep and the place in it; −1 where unknown); all or none of
        :data:`processing.recording.waveform_packets.descriptors.WAVE_COLUMNS`, where a packet is
        its byte alone.
    """

    # Any: the columns differ in type.
    columns: dict[str, NDArray[Any]]

    @property
    def count(self) -> int:
        """Points in the chunk."""
        return int(self.columns["xyz"].shape[0])
