"""Small maps made in a line, to be scored against themselves and against damaged copies."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from processing.core.arrays import Floats
from processing.scoring.features.mapped_features import GeometryType, MappedFeature, MappedFile

EAST, NORTH = -11_000.0, -35_000.0
ORIGIN = np.array([EAST, NORTH, 120.0])


def map_of(features: Sequence[MappedFeature], name: str = "truth.geojson") -> MappedFile:
    numbered = [replace(one, number=number) for number, one in enumerate(features, 1)]
    return MappedFile(Path(name), "EPSG:6677", tuple(numbered))


def feature(
    shape: GeometryType, xyz: Floats | Sequence[Sequence[float]], /, **facts: object
) -> MappedFeature:
    return MappedFeature(1, shape, ORIGIN + np.array(xyz, np.float64).reshape(-1, 3), facts)


def point(x: float, y: float, z: float = 0.0, **facts: object) -> MappedFeature:
    return feature("point", [[x, y, z]], **facts)


def changed(
    file: MappedFile, change: Callable[[MappedFeature], MappedFeature | None]
) -> MappedFile:
    """A copy of a map as a result with every feature changed, or left out where it becomes None."""
    kept = [new for new in map(change, file.features) if new is not None]
    return map_of(kept, "result.geojson")


def moved(file: MappedFile, east: float = 0.0, north: float = 0.0, up: float = 0.0) -> MappedFile:
    off = np.array([east, north, up])
    return changed(file, lambda one: replace(one, xyz=one.xyz + off))


def without_each_third(file: MappedFile) -> MappedFile:
    return changed(file, lambda one: None if one.number % 3 == 0 else one)


def with_facts(
    file: MappedFile, change: Callable[[Mapping[str, object]], dict[str, object]]
) -> MappedFile:
    return changed(file, lambda one: replace(one, facts={**one.facts, **change(one.facts)}))


def with_more(file: MappedFile, *more: MappedFeature) -> MappedFile:
    return map_of([*file.features, *more], "result.geojson")


def curb_pair(start: float, end: float, run: int, kind: str = "curb") -> list[MappedFeature]:
    """Both edges of a straight curb along the easting: 15 cm high, or 3 cm where dropped."""
    height_m = 0.03 if kind == "dropped" else 0.15
    xs = np.arange(start, end + 0.1, 0.5)
    lines = (("upper", 0.02, height_m), ("lower", 0.0, 0.0))
    return [
        feature(
            "line",
            np.column_stack([xs, np.full_like(xs, y), np.full_like(xs, z)]),
            kind="curb",
            edge=edge,
            run=run,
            type=kind,
            height_m=height_m,
        )
        for edge, y, z in lines
    ]


def street_curbs() -> MappedFile:
    """20 m of curb, a dropped one of 4 m, 16 m of curb: 40 m, 20 sections of each edge."""
    pairs = [*curb_pair(0, 20, 1), *curb_pair(20, 24, 2, "dropped"), *curb_pair(24, 40, 3)]
    return map_of(pairs)


def lid(
    x: float, kind: str = "lid", run: int = 1, y: float = 0.0, **facts: object
) -> MappedFeature:
    """A cover of 0.6 m along the easting and 0.4 m across, beginning at x."""
    corners = [(x, y), (x + 0.59, y), (x + 0.59, y + 0.4), (x, y + 0.4)]
    return feature(
        "area", [(a, b, 0.0) for a, b in corners], kind="gutter", type=kind, run=run, **facts
    )


def gutter(count: int = 30, gap: Sequence[int] = (10, 11)) -> MappedFile:
    """Lids one after the other, each tenth a grating, some missing."""
    numbers = [number for number in range(count) if number not in gap]
    return map_of(
        [lid(0.6 * number, "grating" if number % 10 == 5 else "lid") for number in numbers]
    )
