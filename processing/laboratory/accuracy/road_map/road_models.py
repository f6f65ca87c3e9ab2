"""Widths, falls, slopes and clearance of known streets, with nothing drawn by hand.

``python -m processing.laboratory.accuracy.road_map.road_models --markdown docs/accuracy.md``
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Iterable, Iterator, Sequence
from dataclasses import replace
from pathlib import Path
from typing import NamedTuple

import numpy as np

from processing.core.arrays import Floats
from processing.core.monitor import SilentMonitor
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.filters.filter_tables import markdown_table
from processing.laboratory.accuracy.filters.filters import write_sections
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    found_by,
    options_of,
    results_of,
    simulated_scenes,
    worn_options_of,
)
from processing.laboratory.seed_ranges import seeds_of
from processing.laboratory.simulate.requests import StreetRequest
from processing.laboratory.simulate.road_truth.true_roads import TrueRoad, read_true_roads
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Status, Vertex, new_feature_id
from processing.methods.road.road_model.road_model import (
    RoadModel,
    RoadModelSettings,
    RoadStation,
    road_models,
)
from processing.scoring.features.clearances import (
    LEAST_INSIDE_M,
    LEAST_POINTS,
    LIMIT_M,
    clearance_score,
)
from processing.scoring.features.file_scores import FileScore, errors_of
from processing.tools.tool import Candidate
from resources import path_of

_HEADING = "## Road model"
_SEEDS = "9641-9648"
_LENGTH_M = 60.0
_PITCH_M = 2.0
_STYLES = ("urban", "rural", "urban", "highway")
_NEAR_M = 1.0
_LEAST_CONFIDENCE = 0.5
_CURB_TOOL, _CLEARANCE_TOOL = "curbs", "clearance"

_COMMAND = (
    "python -m processing.laboratory.accuracy.road_map.road_models --markdown docs/accuracy.md"
)
_ABOUT = f"""`{_COMMAND}`: \
the road model every {_PITCH_M:.0f} m with nothing drawn by hand: the edges are the curbs that \
the tool `curbs` finds with a confidence of {_LEAST_CONFIDENCE} and more, the centre line lies \
midway between them, heights are those of the points. Held against the street's own measures where \
no side street opens and there is no median: the width between the feet of both curbs, the fall of \
each half of the asphalt outwards, the slope over 10 m. Stations without a curb on one side have \
no width and no fall; on roads without curbs there is nothing to find. Places below the clearance \
are those of the tool `clearance` over the carriageway against what hangs there: {LEAST_POINTS} \
points and more below {LIMIT_M} m, {LEAST_INSIDE_M} m and more inside the edge. Every other street \
is an avenue with low branches, every other two are recorded with the errors of good systems and \
worn. One pass sees one carriageway: beyond a median nothing is looked for, and missed. Nobody \
looked at these streets. 9591 to 9598 were scored before: widths of 29 of 124 stations within \
0.5 cm (RMS), slopes within 0.04 %, 11 places found, 4 made up, 4 missed; the falls of 9593, under \
whose road a phase-based scanner drew arcs, were spoilt (32 %), since when the surface across is \
held to the height of the centre line. On 9643 such arcs lie under the centre line itself and \
spoil a few stations: points that are known as noise don't count, and none were here.
"""


class StreetErrors(NamedTuple):
    """What was off on one street: (n,) float64 each, model minus truth.

    ``asked``: stations of which the truth knows the width; ``clearance``: the score of the places.
    """

    street: str
    asked: int
    width: Floats
    fall: Floats
    slope: Floats
    clearance: FileScore


def request_of(number: int, seed: int, length_m: float) -> StreetRequest:
    """The street of a seed: styles and scanners take turns, every other one is an avenue."""
    make = worn_options_of if number % 4 > 1 else options_of
    style = _STYLES[number % len(_STYLES)]
    request = replace(make(number, seed, length_m), style=style, passes=1, stops=False)
    return replace(request, avenue=number % 2 == 0)


def errors_on(scenes: Iterable[RoadScene]) -> Iterator[StreetErrors]:
    """The errors on each street."""
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    for scene in scenes:
        edges = [
            _accepted(one)
            for result in results_of(_CURB_TOOL, scene.drives)
            for one in result.candidates
            if one.confidence >= _LEAST_CONFIDENCE and not one.is_drawing
        ]
        settings = RoadModelSettings(_PITCH_M)
        models = road_models(edges, catalogue, scene.drives, settings, SilentMonitor())
        truth = read_true_roads(scene.delivery / "truth" / "road.csv")
        found = found_by(_CLEARANCE_TOOL, scene.drives).result
        score = clearance_score(found, read_mapped(scene.truth(_CLEARANCE_TOOL)))
        asked = [row for row in truth if not row.is_open and row.median_m == 0]
        yield _held_against(scene.name, models, asked[:: round(_PITCH_M)], score)


def _accepted(one: Candidate) -> Feature:
    vertices = tuple(Vertex((x, y, z)) for x, y, z in one.xyz.tolist())
    return Feature(
        new_feature_id(), one.kind, Geometry(one.geometry), vertices, {}, status=Status.ACCEPTED
    )


def _held_against(
    street: str, models: Sequence[RoadModel], asked: Sequence[TrueRoad], score: FileScore
) -> StreetErrors:
    stations = [one for model in models for one in model.stations]
    width: list[float] = []
    fall: list[float] = []
    slope: list[float] = []
    for true in asked:
        one = _nearest(stations, true)
        if one is not None:
            width.append(one.carriageway.total - true.left_m - true.right_m)
            slope.append(100 * one.slope.slope - true.slope_percent)
            fall += [
                100 * fit.slope - percent
                for fit, percent in zip(
                    one.fall, (true.left_percent, true.right_percent), strict=True
                )
            ]
    return StreetErrors(
        street,
        len(asked),
        np.array(width, np.float64),
        np.array(fall, np.float64),
        np.array(slope, np.float64),
        score,
    )


def _nearest(stations: Sequence[RoadStation], true: TrueRoad) -> RoadStation | None:
    """The station whose line across passes the true place."""
    if not stations:
        return None
    away = [
        float(np.hypot(one.easting_m - true.easting_m, one.northing_m - true.northing_m))
        for one in stations
    ]
    best = int(np.argmin(away))
    return stations[best] if away[best] <= _NEAR_M else None


def section_of(rows: Sequence[StreetErrors]) -> str:
    """The section of the page, without its heading."""
    heads = [
        "street", "stations with both edges", "width, RMS", "95 % within", "fall, RMS",
        "95 % within", "slope, RMS", "95 % within", "places found, false, missed", "lowest, RMS",
    ]  # fmt: skip
    cells = [heads, *(_cells(row) for row in rows)]
    joined = [np.concatenate([getattr(row, name) for row in rows]) for name in _MEASURES]
    counts = [row.clearance.counts_of("places") for row in rows]
    names = ("hits", "false_alarms", "misses")
    total = ", ".join(str(sum(getattr(one, name) for one in counts)) for name in names)
    asked, known = sum(row.asked for row in rows), int(np.isfinite(joined[0]).sum())
    cells.append(["all", f"{known} of {asked}", *_told(joined), total, ""])
    return f"{_ABOUT}\n{markdown_table(cells)}\n"


_MEASURES = ("width", "fall", "slope")


def _cells(row: StreetErrors) -> list[str]:
    counts = row.clearance.counts_of("places")
    lowest = row.clearance.errors_of("lowest")
    known = int(np.isfinite(row.width).sum())
    return [
        row.street,
        f"{known} of {row.asked}",
        *_told([getattr(row, name) for name in _MEASURES]),
        f"{counts.hits}, {counts.false_alarms}, {counts.misses}",
        f"{100 * lowest.rms:.0f} cm" if lowest.count else "–",
    ]


def _told(measures: Sequence[Floats]) -> list[str]:
    """Root mean squares and what 95 % are within: width in cm, falls and slopes in per cent."""
    words = []
    for values, scale, unit in zip(measures, (100, 1, 1), ("cm", "%", "%"), strict=True):
        errors = errors_of("", ("", ""), "", values)
        digits = 1 if unit == "cm" else 2
        words += [
            f"{scale * one:.{digits}f} {unit}" if errors.count else "–"
            for one in (errors.rms, errors.within_95)
        ]
    return words


def main(arguments: Sequence[str] | None = None) -> int:
    """The command."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--markdown", type=Path)
    parser.add_argument("--seeds", default=_SEEDS)
    parser.add_argument("--length", type=float, default=_LENGTH_M)
    asked = parser.parse_args(arguments)
    scenes = simulated_scenes(seeds_of(asked.seeds), asked.length, request_of)
    rows = list(errors_on(scenes))
    write_sections(asked.markdown, {_HEADING: section_of(rows)})
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
