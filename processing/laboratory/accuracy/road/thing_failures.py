"""Failures of trees, poles and signs as small pictures on sheets that one can look through.

``python -m processing.laboratory.accuracy.road.thing_failures FOLDER --samples FOLDER…
--avenues SEED… --streets SEED…``

Each shows the points of a slab through the place, to the east and to the north, a thing's whole
height and its lowest metres, and the plan of a slice; what is true green, what was found orange.
Nothing is learnt or chosen here: the tools run with their own parameters.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from itertools import chain
from pathlib import Path
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats
from processing.core.output_streams import write_every_character
from processing.formats.vectors.mapped_shapes import read_mapped
from processing.laboratory.accuracy.road.road_pictures import (
    BACKGROUND,
    FOUND,
    INK,
    TRUE,
    Picture,
    caption_of,
    write_sheets,
)
from processing.laboratory.accuracy.road.road_scenes import (
    RoadScene,
    avenue_scenes,
    cloud_of,
    found_by,
    given_scenes,
    options_of,
    simulated_scenes,
)
from processing.laboratory.accuracy.road.road_surroundings import Failure
from processing.laboratory.accuracy.road.tree_tables import MOST_CM
from processing.scoring.features.mapped_features import MappedFeature, MappedFile
from processing.scoring.features.object_matches import (
    ObjectMatch,
    is_in_span,
    match_objects,
    positions_of,
    shows_enough,
)
from processing.scoring.features.poles import LEAST_POINTS, known_type
from processing.scoring.features.poles import WITHIN_M as POLES_WITHIN_M
from processing.scoring.features.signs import LEAST_FRONT_POINTS, SIZE_SHARE
from processing.scoring.features.signs import WITHIN_M as SIGNS_WITHIN_M
from processing.scoring.features.trees import LEAST_TRUNK_POINTS
from processing.scoring.features.trees import WITHIN_M as TREES_WITHIN_M

_LENGTH_M = 70.0
_SIDE_PX = 260
_SLAB_M = 1.5
"""Half the thickness of what is seen from the side."""

_PANELS = ((9.0, -0.5, 8.5), (3.0, -0.3, 2.7))
"""Width, and lowest and highest above the place, m, of what is seen from the side."""

_SLICE_M = (0.9, 1.5)
_PLAN_M = 1.6


@dataclass(frozen=True)
class PaintedKind:
    """How things of one kind are held against the truth.

    Attributes
    ----------
    shown_by : str
        The fact that counts the points that show a true one.
    least : float
        So many must.
    within_m : float
        How near a found one is to the true one.
    is_wrong : function
        Whether a found one is told wrongly beside the true one.
    """

    shown_by: str
    least: float
    within_m: float
    is_wrong: Callable[[ObjectMatch], str]


class TrueAndFound(NamedTuple):
    """What is true and what was found on a street, (n, 3) and (m, 3) float64, m."""

    true: Floats
    found: Floats


def _wrong_girth(pair: ObjectMatch) -> str:
    true, found = (float(str(one.facts["dbh_m"])) for one in (pair.truth, pair.result))
    return (
        f"{100 * (found - true):+.1f} of {100 * true:.0f} cm"
        if abs(found - true) > MOST_CM / 100
        else ""
    )


def _wrong_type(pair: ObjectMatch) -> str:
    known, found = known_type(pair.truth), pair.result.facts.get("type")
    return f"{found} for {known}" if found != known else ""


def _wrong_shape(pair: ObjectMatch) -> str:
    true, found = pair.truth.facts, pair.result.facts
    off = abs(float(str(found["size_m"])) / float(str(true["size_m"])) - 1)
    if found["shape"] == true["shape"] and off <= SIZE_SHARE:
        return ""
    return f"{found['shape']} {found['size_m']} for {true['shape']} {true['size_m']}"


KINDS = {
    "trees": PaintedKind("trunk_points", LEAST_TRUNK_POINTS, TREES_WITHIN_M, _wrong_girth),
    "poles": PaintedKind("points", LEAST_POINTS, POLES_WITHIN_M, _wrong_type),
    "signs": PaintedKind("front_points", LEAST_FRONT_POINTS, SIGNS_WITHIN_M, _wrong_shape),
}


def thing_failures(
    tool: str, street: str, result: MappedFile, truth: MappedFile
) -> Iterator[Failure]:
    """What was missed, is none, or is told wrongly.

    Parameters
    ----------
    tool : str
        One of `KINDS`.
    result, truth : MappedFile
        Points, of which the truth tells by how many points each is shown.
    """
    kind = KINDS[tool]
    asked = [
        is_in_span(one)
        and shows_enough(truth, one, kind.shown_by, kind.least)
        and one.facts.get("supplementary") is not True
        for one in truth.features
    ]
    in_space = tool == "signs"
    found = match_objects(result.features, truth.features, asked, kind.within_m, in_space=in_space)
    met = {pair.truth.number for pair in found.partners}
    for one, is_asked in zip(truth.features, asked, strict=True):
        if is_asked and one.number not in met:
            shown = truth.number(one, kind.shown_by)
            yield Failure(tool, street, "missed", _type_of(one), one.xyz[:1], f"{shown:.0f} points")
    for one in found.alone:
        sure = result.number(one, "confidence")
        yield Failure(tool, street, "false", _type_of(one), one.xyz[:1], f"confidence {sure:.2f}")
    for pair in found.partners:
        told = kind.is_wrong(pair)
        if told:
            yield Failure(tool, street, "wrong", _type_of(pair.truth), pair.truth.xyz[:1], told)


def _type_of(one: MappedFeature) -> str:
    return str(one.facts.get("type") or one.facts.get("species") or one.facts.get("shape") or "")


def paint_thing(failure: Failure, xyz: Floats, things: TrueAndFound) -> Picture:
    """One failure: (rows, columns, 3) uint8.

    Parameters
    ----------
    xyz : (n, 3) float64
        All points of the street, m.
    """
    middle = failure.middle
    off = xyz - middle
    off = off[(np.abs(off[:, :2]) < _PANELS[0][0] / 2).all(axis=1)]
    marks = [
        (one - middle, colour)
        for some, colour in ((things.true, TRUE), (things.found, FOUND))
        for one in some
        if np.hypot(*(one - middle)[:2]) < _PANELS[0][0] / 2
    ]
    foot = float(off[:, 2].min(initial=0.0)) if failure.tool == "signs" else 0.0
    panels = []
    for axis in (0, 1):
        slab = off[np.abs(off[:, 1 - axis]) < _SLAB_M]
        for wide, low, high in _PANELS:
            seen = [(one[[axis, 2]], colour) for one, colour in marks]
            panels.append(
                _panel(slab[:, [axis, 2]], seen, (-wide / 2, foot + low, wide / 2, foot + high))
            )
    level = (-0.3, 0.3) if failure.tool == "signs" else _SLICE_M
    part = off[(off[:, 2] > level[0]) & (off[:, 2] < level[1])]
    half = _PLAN_M / 2
    panels.append(
        _panel(
            part[:, :2], [(one[:2], colour) for one, colour in marks], (-half, -half, half, half)
        )
    )
    return np.vstack([caption_of(failure, len(panels) * _SIDE_PX), np.hstack(panels)])


def _panel(
    points: Floats,
    marks: Sequence[tuple[Floats, tuple[int, int, int]]],
    bounds: tuple[float, float, float, float],
) -> Picture:
    """Points and crosses within bounds: left, low, right, high."""
    picture = np.full((_SIDE_PX, _SIDE_PX, 3), BACKGROUND, np.uint8)
    low, span = np.array(bounds[:2]), np.array(bounds[2:]) - bounds[:2]

    def pixels(places: Floats) -> NDArray[np.int64]:
        at = ((places - low) / span * _SIDE_PX).astype(np.int64)
        return np.column_stack([at[:, 0], _SIDE_PX - 1 - at[:, 1]])

    at = pixels(points)
    at = at[((at >= 0) & (at < _SIDE_PX)).all(axis=1)]
    picture[at[:, 1], at[:, 0]] = INK
    for place, colour in marks:
        east, up = pixels(place[None])[0].tolist()
        for step in range(-6, 7):
            for column, row in ((east + step, up), (east, up + step)):
                if 0 <= column < _SIDE_PX and 0 <= row < _SIDE_PX:
                    picture[row, column] = colour
    picture[:, -1] = INK
    return picture


def pictures_of(scene: RoadScene, tools: Sequence[str]) -> Iterator[tuple[Failure, Picture]]:
    """All failures of some tools on a street, painted."""
    xyz = cloud_of(scene.delivery).xyz
    for tool in tools:
        truth, result = read_mapped(scene.truth(tool)), found_by(tool, scene.drives).result
        things = TrueAndFound(positions_of(truth.features), positions_of(result.features))
        for failure in thing_failures(tool, scene.name, result, truth):
            yield failure, paint_thing(failure, xyz, things)


def main(arguments: Sequence[str] | None = None) -> int:
    """Paint the failures."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("pictures", type=Path)
    parser.add_argument("--samples", type=Path, nargs="*", default=[])
    parser.add_argument("--avenues", type=int, nargs="*", default=[])
    parser.add_argument("--streets", type=int, nargs="*", default=[])
    parser.add_argument("--tools", nargs="*", choices=tuple(KINDS), default=tuple(KINDS))
    parser.add_argument("--length", type=float, default=_LENGTH_M)
    options = parser.parse_args(arguments)
    scenes = chain(
        given_scenes(options.samples),
        avenue_scenes(options.avenues, options.length),
        simulated_scenes(options.streets, options.length, options_of),
    )
    painted = chain.from_iterable(pictures_of(scene, options.tools) for scene in scenes)
    sheets = write_sheets(painted, options.pictures)
    for (tool, what, kind), paths in sheets.items():
        names = ", ".join(path.name for path in paths)
        sys.stdout.write(f"{tool} {what} {kind}: {names}\n")
    return 0


if __name__ == "__main__":
    write_every_character()
    sys.exit(main())
