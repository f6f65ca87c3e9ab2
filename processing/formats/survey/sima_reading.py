"""SIMA read as a map: points, and parcels as areas through their points."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np

from processing.core.errors import BadFile
from processing.core.japanese_text import read_lines
from processing.core.text import Text
from processing.scoring.features.mapped_features import MappedFeature, MappedFile

_Place = tuple[float, float, float]


def read_sima_features(path: Path) -> MappedFile:
    """The points and parcels of a SIMA file; X is northing there, Y easting.

    Points that are corners of parcels, and nothing else, are not features of their own. The file
    says no reference system, nor what a point is.

    Raises
    ------
    MissingInput, NoSpace
        It can't be read.
    BadFile
        It is no SIMA; a record can't be read, or a parcel names a point that there is not.
    """
    points: dict[str, tuple[str, _Place]] = {}
    parcels: list[tuple[str, list[_Place]]] = []
    corners: set[str] = set()
    lines = read_lines(path)
    if not lines[0].startswith(("G00", "Z00", "A00")):
        raise _damage(path, 1)
    for number, line in enumerate(lines, 1):
        code, *fields = (one.strip() for one in line.split(","))
        try:
            match code:
                case "A01":
                    points[fields[0]] = (fields[1], _place(fields[2:5]))
                case "D00":
                    parcels.append((fields[1], []))
                case "B01":
                    parcels[-1][1].append(points[fields[0]][1])
                    corners.add(fields[0])
        except (LookupError, ValueError) as error:
            raise _damage(path, number) from error
    features = [
        MappedFeature(0, "point", np.array([place]), {"name": name})
        for number, (name, place) in points.items()
        if number not in corners
    ]
    features += [
        MappedFeature(0, "area", np.array(places), {"name": name})
        for name, places in parcels
        if len(places) > 2
    ]
    counted = (MappedFeature(n, one.shape, one.xyz, one.facts) for n, one in enumerate(features, 1))
    return MappedFile(path, "", tuple(counted))


def _place(fields: list[str]) -> _Place:
    x, y = float(fields[0]), float(fields[1])
    height = float(fields[2]) if len(fields) > 2 and fields[2] else math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise ValueError(fields)
    return y, x, height


def _damage(path: Path, line: int) -> BadFile:
    return BadFile(
        Text("The line is no record of SIMA.", "SIMAのレコードとして読めません。"),
        Text(f"{path}, line {line:,}", f"{path}、{line:,}行目"),
        Text(
            "Choose the right file, or have it delivered once more.",
            "正しいファイルを選ぶか、もう一度納品を受けてください。",
        ),
    )
