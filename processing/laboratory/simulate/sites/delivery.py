"""A site's files: clouds as delivered, and the truth beside them."""

from __future__ import annotations

import json
from collections.abc import Mapping
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path
from types import TracebackType
from typing import Any

import numpy as np

from processing.laboratory.simulate.scanning.delivered_files import (
    SCALE_M,
    ArrayFile,
    DeliveredPoints,
    PointFile,
)
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.recording import SitePoints
from processing.laboratory.simulate.sites.volumes import SEEN_CELL_M

CRS = "EPSG:6677"


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
        self._position, self._starts_s = position, starts_s
        self.seen = np.zeros(cells, np.int64)
        self.of_label = np.zeros(256, np.int64)
        self._open = ExitStack()
        self._points = self._open.enter_context(PointFile(path, position.offsets))
        self._labels, self._kinds = (
            self._open.enter_context(ArrayFile(truth / f"{name}_{path.stem}.npy", kind))
            for name, kind in (("labels", np.uint8), ("kinds", np.int8))
        )

    def __enter__(self) -> CloudFile:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        at: TracebackType | None,
    ) -> None:
        self._open.__exit__(kind, error, at)

    def write(self, points: SitePoints) -> None:
        """Add points behind those that are there."""
        if points.time_s.size == 0:
            return
        shift = np.array([self._position.easting_m, self._position.northing_m, 0.0])
        xyz = points.xyz + shift
        self._points.write(
            DeliveredPoints(
                xyz,
                self._starts_s + points.time_s,
                points.intensity,
                points.number,
                points.count,
                points.station,
            )
        )
        self._labels.write(points.label)
        self._kinds.write(points.kind)
        self.of_label += np.bincount(points.label, minlength=256)
        offsets = self._position.offsets
        whole = np.round((xyz[points.label == 2] - offsets) / SCALE_M)  # as it is delivered
        self._count_ground(whole * SCALE_M + offsets - shift)

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
