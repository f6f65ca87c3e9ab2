"""Lines from files that other programs drew: where sections stand, and break lines."""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.errors import BadFile, Unsuitable, report_as_user_error
from processing.core.text import Text
from processing.formats.format import Content
from processing.formats.registry import FORMATS


def read_lines(path: Path, *, crs: str = "") -> tuple[Floats, ...]:
    """The lines of a file, in its order; closed ones end where they begin.

    Parameters
    ----------
    path : Path
        ``.geojson`` (``.json``), ``.gpkg`` or ``.dxf``, by the ending.
    crs : str
        ``EPSG:n`` that they must be in, where both are known; empty for any.

    Returns
    -------
    tuple of (k, 3) float64
        m, project CRS; NaN heights where a line lies in plan only.

    Raises
    ------
    MissingInput, BadFile
        There is no such file, or it can't be read.
    OutOfRange
        Another ending.
    Unsuitable
        No line in it, or another reference system.
    """
    FORMATS.format_to_read(path, Content.LINES)
    with report_as_user_error(path), path.open("rb"):
        pass
    shapes, own = _shapes(path)
    if crs and own and own != crs:
        raise Unsuitable(
            Text("The lines are in another reference system.", "線の座標系が異なります。"),
            Text.same(f"{path}: {own} ≠ {crs}"),
            Text(
                "Convert them to the system of the points.", "点群と同じ座標系に変換してください。"
            ),
        )
    lines = tuple(
        shapely.get_coordinates(line, include_z=True)
        for shape in shapes
        for line in shapely.get_parts(shape)
        if line.geom_type in ("LineString", "LinearRing") and line.length > 0
    )
    if not lines:
        raise Unsuitable(
            Text("The file has no line.", "ファイルに線がありません。"),
            Text.same(str(path)),
            Text("Draw a line and save it there.", "線を描いて保存してください。"),
        )
    return lines


def _shapes(path: Path) -> tuple[NDArray[np.object_], str]:
    """All shapes of the file and its system as ``EPSG:n``, or empty."""
    from pyogrio import raw
    from pyogrio.errors import DataLayerError, DataSourceError

    try:
        with warnings.catch_warnings():
            # Of GDAL, about what other programs left out of the file: what counts is what it reads.
            warnings.simplefilter("ignore", RuntimeWarning)
            facts, _, binary, _ = raw.read(path, columns=[])
            shapes = shapely.from_wkb(binary)
    except (DataSourceError, DataLayerError, shapely.errors.GEOSException, ValueError) as error:
        raise BadFile(
            Text("The file can't be read.", "ファイルを読めません。"),
            Text.same(str(path)),
            Text("Export it again.", "もう一度書き出してください。"),
        ) from error
    kept = np.array([shape for shape in shapes if shape is not None], dtype=object)
    system = str(facts["crs"] or "")
    # GeoJSON without a system counts as WGS 84 to the reader, but plans of works aren't.
    is_reported = system.startswith("EPSG:") and system != "EPSG:4326"
    return kept, system if is_reported else ""
