"""Files as they are delivered: LAZ in chunks, and arrays of truth that grow with it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import date
from pathlib import Path
from types import TracebackType
from typing import BinaryIO

import laspy
import numpy as np
from numpy.typing import ArrayLike, NDArray
from pyproj import CRS

from processing.formats.points.reported_writes import ReportedWrites, report_write_failures
from processing.laboratory.simulate.scene.mesh import Floats

CRS_NAME = "EPSG:6677"
"""JGD2011, plane rectangular coordinates, zone IX; easting first."""

SCALE_M = 0.001
SURVEYED = date(2024, 4, 1)  # in the header, so that the same seed gives the same bytes
SOFTWARE, SYSTEM = "Zuka simulation", "SIMULATION"


@dataclass(frozen=True)
class DeliveredPoints:
    """Points of one chunk.

    Attributes
    ----------
    xyz : (n, 3) float64
        m, easting, northing, height.
    time_s : (n,) float64
        Adjusted standard GPS time.
    intensity : (n,) uint16
    number, count : (n,) uint8
        Of the pulse's returns.
    source_id : int
    """

    xyz: Floats
    time_s: Floats
    intensity: NDArray[np.uint16]
    number: NDArray[np.uint8]
    count: NDArray[np.uint8]
    source_id: int


def delivered_header(point_format: int, offset: Floats) -> laspy.LasHeader:
    """The head of a LAS 1.4 file in :data:`CRS_NAME`, as all simulated clouds have it.

    Parameters
    ----------
    offset : (3,) float64
        Near the points, m; coordinates are whole millimetres from it.
    """
    header = laspy.LasHeader(point_format=point_format, version="1.4")
    header.scales, header.offsets = np.full(3, SCALE_M), np.floor(offset)
    header.generating_software, header.creation_date = SOFTWARE, SURVEYED
    header.system_identifier = SYSTEM
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    header.add_crs(CRS.from_user_input(CRS_NAME))
    return header


def point_records(points: DeliveredPoints, header: laspy.LasHeader) -> laspy.ScaleAwarePointRecord:
    """Points as a header's point format holds them; what they don't tell is 0."""
    record = laspy.ScaleAwarePointRecord.zeros(points.time_s.size, header=header)
    placed = np.rint((points.xyz - header.offsets) / header.scales)
    record["X"], record["Y"], record["Z"] = placed.astype(np.int32).T
    record["gps_time"], record["intensity"] = points.time_s, points.intensity
    record["return_number"], record["number_of_returns"] = points.number, points.count
    record["point_source_id"] = np.full(points.time_s.size, points.source_id)
    return record


class PointFile:
    """A LAZ 1.4 file of point format 6, written chunk by chunk; closed by ``with``.

    Parameters
    ----------
    offset : (3,) float64
        Near the points, m; coordinates are whole millimetres from it.
    """

    def __init__(self, path: Path, offset: Floats) -> None:
        self._header, self.count = delivered_header(6, offset), 0
        self._file = ReportedWrites(path.open("wb"))
        self._writer = laspy.LasWriter(
            self._file, self._header, do_compress=True, laz_backend=laspy.LazBackend.LazrsParallel
        )

    def write(self, points: DeliveredPoints) -> None:
        """Add points behind those that are there."""
        record = point_records(points, self._header)
        with report_write_failures(self._file):
            self._writer.write_points(record)
        self.count += points.time_s.size

    def __enter__(self) -> PointFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            with report_write_failures(self._file):
                self._writer.close()
        self._file.close()


class ArrayFile:
    """A ``.npy`` file that grows; closed by ``with``.

    Parameters
    ----------
    width : int
        Of its rows; 0 for one dimension.
    """

    def __init__(self, path: Path, dtype: type[np.generic], width: int = 0) -> None:
        self._dtype, self._count, self._width = np.dtype(dtype), 0, width
        self._file: BinaryIO = path.open("wb")
        self._write_head()

    def write(self, values: ArrayLike) -> None:
        """Add values behind those that are there."""
        array = np.ascontiguousarray(values, self._dtype)
        self._file.write(array.tobytes())
        self._count += len(array)

    def __enter__(self) -> ArrayFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        if error is None:
            self._file.seek(0)
            self._write_head()
        self._file.close()

    def _write_head(self) -> None:
        """The head leaves room for any count (numpy pads the axis that can grow)."""
        shape = (self._count, self._width) if self._width else (self._count,)
        np.lib.format.write_array_header_1_0(
            self._file, {"descr": self._dtype.str, "fortran_order": False, "shape": shape}
        )
