"""A site's files: clouds as delivered, and the truth beside them."""

from __future__ import annotations

import datetime as dt
import json
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np
from numpy.typing import NDArray

from processing.formats.points.reported_writes import ReportedWrites, report_write_failures
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.recording import SitePoints
from processing.laboratory.simulate.sites.volumes import SEEN_CELL_M

CRS = "EPSG:6677"
_SCALE_M = 0.001
_DAY = dt.date(2026, 1, 1)
"""Written into every header: the same seed gives the same bytes on any day."""


@dataclass(frozen=True)
class SiteReference:
    """Where a site's frame lies in the reference system, and when it was recorded.

    Attributes
    ----------
    easting_m, northing_m : float
        Of the first node.
    offsets : (3,) float64
        Of the files' whole numbers.
    """

    easting_m: float
    northing_m: float

    @property
    def offsets(self) -> Floats:
        """Whole hundreds of metres near the site."""
        return np.array([np.floor(self.easting_m / 100), np.floor(self.northing_m / 100), 0]) * 100

    def on_map(self, xy: Floats) -> Floats:
        """Places of the site's frame in the reference system: (n, 2) float64."""
        return np.asarray(xy + np.array([self.easting_m, self.northing_m]), np.float64)


class GrowingArray:
    """An array of numbers in a ``.npy`` file whose length is known at its end only.

    Parameters
    ----------
    path : Path
        As :func:`numpy.load` reads it, once it is closed.
    kind : dtype
        Of its numbers.
    """

    def __init__(self, path: Path, kind: np.dtype[Any]) -> None:
        self._kind, self.count = kind, 0
        self._file = path.open("wb")
        self._head()

    def add(self, values: NDArray[Any]) -> None:
        """Put values of any number behind those that are there."""
        self._file.write(np.ascontiguousarray(values, self._kind).tobytes())
        self.count += values.size

    def close(self, *, is_whole: bool) -> None:
        """Note the length, unless nobody will read it."""
        if is_whole:
            self._file.seek(0)
            self._head()
        self._file.close()

    def _head(self) -> None:
        # NumPy leaves room for a shape of 21 digits, so that the head never grows.
        shape = {"descr": self._kind.str, "fortran_order": False, "shape": (self.count,)}
        np.lib.format.write_array_header_1_0(self._file, shape)


class CloudFile:
    """A cloud that is written as its points come, with its labels and kinds.

    Parameters
    ----------
    truth : Path
        Folder of its labels and kinds.
    starts_s : float
        Adjusted standard GPS time of the recording's beginning.
    cells : (int, int)
        Rows and columns of the cells that ground points are counted in.
    """

    def __init__(
        self,
        path: Path,
        truth: Path,
        position: SiteReference,
        starts_s: float,
        *,
        cells: tuple[int, int],
    ) -> None:
        import laspy

        self._position, self._starts_s = position, starts_s
        self.seen = np.zeros(cells, np.int64)
        self.of_label = np.zeros(256, np.int64)
        self._labels = GrowingArray(truth / f"labels_{path.stem}.npy", np.dtype(np.uint8))
        self._kinds = GrowingArray(truth / f"kinds_{path.stem}.npy", np.dtype(np.int8))
        self._header = _header(position)
        self._laspy: Any = laspy  # laspy has no types
        self._file = ReportedWrites(path.open("wb"))
        self._writer: Any = laspy.LasWriter(
            self._file,
            self._header,
            do_compress=True,
            laz_backend=laspy.LazBackend.LazrsParallel,
        )

    def __enter__(self) -> CloudFile:
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, _: TracebackType | None
    ) -> None:
        is_whole = error is None
        if is_whole:
            with report_write_failures(self._file):
                self._writer.close()
        self._file.close()
        self._labels.close(is_whole=is_whole)
        self._kinds.close(is_whole=is_whole)

    def write(self, points: SitePoints) -> None:
        """Add points behind those that are there."""
        if points.time_s.size == 0:
            return
        laspy = self._laspy
        shift = np.array([self._position.easting_m, self._position.northing_m, 0.0])
        whole = np.round((points.xyz + shift - self._position.offsets) / _SCALE_M).astype(np.int32)
        record = laspy.ScaleAwarePointRecord.zeros(points.time_s.size, header=self._header)
        record.X, record.Y, record.Z = whole.T
        record.intensity = points.intensity
        record.return_number, record.number_of_returns = points.number, points.count
        record.gps_time = self._starts_s + points.time_s
        record.point_source_id = np.full(points.time_s.size, points.station, np.uint16)
        with report_write_failures(self._file):
            self._writer.write_points(record)
        self._labels.add(points.label)
        self._kinds.add(points.kind)
        self.of_label += np.bincount(points.label, minlength=256)
        self._count_ground(whole[points.label == 2] * _SCALE_M + self._position.offsets - shift)

    def _count_ground(self, xyz: Floats) -> None:
        rows, columns = self.seen.shape
        i = np.clip(xyz[:, 0] / SEEN_CELL_M, 0, columns - 1).astype(np.int64)
        j = np.clip(xyz[:, 1] / SEEN_CELL_M, 0, rows - 1).astype(np.int64)
        self.seen += np.bincount(j * columns + i, minlength=rows * columns).reshape(rows, columns)

    @property
    def counts(self) -> dict[str, int]:
        """Points in all and of each label."""
        names = {"ground": 2, "other": 1, "low_noise": 7, "high_noise": 18}
        return {
            "points": int(self.of_label.sum()),
            **{name: int(self.of_label[code]) for name, code in names.items()},
        }


def write_terrain(path: Path, heights: HeightGrid, position: SiteReference) -> None:
    """The true ground of one date."""
    np.savez_compressed(
        path,
        z=heights.z,
        x0=np.float64(position.easting_m),
        y0=np.float64(position.northing_m),
        res=np.float64(heights.res),
    )


def write_json(path: Path, content: Mapping[str, Any]) -> None:
    """A description as JSON."""
    path.write_text(json.dumps(content, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


def write_site(path: Path, polygon: Floats) -> None:
    """The site's polygon, (n, 2) in the reference system, as GeoJSON."""
    ring = [[float(x), float(y)] for x, y in [*polygon, polygon[0]]]
    geometry = {"type": "Polygon", "coordinates": [ring]}
    feature = {"type": "Feature", "properties": {"kind": "site"}, "geometry": geometry}
    name = {"name": "urn:ogc:def:crs:EPSG::6677"}
    crs = {"type": "name", "properties": name}
    write_json(path, {"type": "FeatureCollection", "crs": crs, "features": [feature]})


def _header(position: SiteReference) -> Any:  # laspy has no types
    import laspy
    from pyproj import CRS as System  # noqa: N811  `CRS` is this module's own name

    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales = np.full(3, _SCALE_M)
    header.offsets = position.offsets
    header.creation_date = _DAY
    header.generating_software = "Zuka"
    header.system_identifier = "simulated"
    header.add_crs(System.from_user_input(CRS))
    header.global_encoding.gps_time_type = laspy.header.GpsTimeType.STANDARD
    return header
