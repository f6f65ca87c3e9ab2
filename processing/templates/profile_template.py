"""ProfileTemplate: the shape that a curb or gutter should have in a section, drawn once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from processing.errors import OutOfRange
from processing.text import Text

ProfilePlace = tuple[float, float]
"""Offset to the right (looking along the line) and height, m, about the anchor."""
Profile = tuple[ProfilePlace, ...]

USUAL_TOLERANCE_M = 0.02
LEAST_TOLERANCE_M, MOST_TOLERANCE_M = 0.003, 0.20
_LARGEST_M = 10.0
_SMALLEST_M = 0.02
_SAME_M = 1e-6
_MOST_PLACES = 200
_LONGEST_NAME = 80


@dataclass(frozen=True)
class MadeLine:
    """A line that a fit makes.

    Attributes
    ----------
    kind : str
        Id of a feature kind of the catalogue.
    at : ProfilePlace
        The vertex of the shape that the line follows.
    """

    kind: str
    at: ProfilePlace = (0.0, 0.0)


@dataclass(frozen=True)
class ProfileTemplate:
    """What a section should look like, and where nothing should be.

    Attributes
    ----------
    name : str
    shape : tuple of Profile
        Open polylines of two places and more; the anchor, (0, 0), is one of their vertices.
    lines : tuple of MadeLine
        At vertices of the shape.
    empty : tuple of Profile
        Rings (the first place not repeated) in which no point should be.
    tolerance_m : float
        Points this near to the shape lie on it.

    Raises
    ------
    OutOfRange
        The shape is no profile, or something lies beside it.
    """

    name: str
    shape: tuple[Profile, ...]
    lines: tuple[MadeLine, ...]
    empty: tuple[Profile, ...] = ()
    tolerance_m: float = USUAL_TOLERANCE_M

    def __post_init__(self) -> None:
        wrong = self._what_is_wrong()
        if wrong is not None:
            raise OutOfRange(
                wrong,
                Text("template “{name}”", "テンプレート「{name}」").filled(name=self.name),
                Text("Draw the template again.", "テンプレートを描き直してください。"),
            )

    @property
    def vertices(self) -> Profile:
        """The places of the shape, each once, in the order in which they were drawn."""
        return _each_once(place for profile in self.shape for place in profile)

    @property
    def length_m(self) -> float:
        """Length of the shape."""
        return sum(
            math.dist(one, other)
            for profile in self.shape
            for one, other in itertools.pairwise(profile)
        )

    @property
    def box(self) -> tuple[float, float, float, float]:
        """Least and largest offset, least and largest height of shape and empty zones, m."""
        places = [place for profile in (*self.shape, *self.empty) for place in profile]
        across, up = [place[0] for place in places], [place[1] for place in places]
        return min(across), max(across), min(up), max(up)

    def mirrored(self) -> ProfileTemplate:
        """The same shape for the other side of the street."""
        return replace(
            self,
            shape=tuple(_mirrored(profile) for profile in self.shape),
            lines=tuple(replace(line, at=_mirrored((line.at,))[0]) for line in self.lines),
            empty=tuple(_mirrored(profile) for profile in self.empty),
        )

    def about(self, vertex: ProfilePlace) -> ProfileTemplate:
        """The same shape with another of its vertices as the anchor."""
        return replace(
            self,
            shape=tuple(_moved(profile, vertex) for profile in self.shape),
            lines=tuple(replace(line, at=_moved((line.at,), vertex)[0]) for line in self.lines),
            empty=tuple(_moved(profile, vertex) for profile in self.empty),
        )

    def kind_at(self, vertex: ProfilePlace) -> str:
        """The kind of the line made at a vertex; empty where none is."""
        return next((line.kind for line in self.lines if _is_same(line.at, vertex)), "")

    def with_kind_at(self, vertex: ProfilePlace, kind: str) -> ProfileTemplate:
        """Another kind for the line at a vertex; an empty one takes the line away."""
        others = tuple(line for line in self.lines if not _is_same(line.at, vertex))
        lines = (*others, MadeLine(kind, vertex)) if kind else others
        order = self.vertices
        return replace(self, lines=tuple(sorted(lines, key=lambda one: _index(order, one.at))))

    def _what_is_wrong(self) -> Text | None:
        places = [place for profile in (*self.shape, *self.empty) for place in profile]
        if not self.name.strip() or len(self.name) > _LONGEST_NAME:
            return Text("A template needs a name.", "テンプレートには名前が必要です。")
        if not self.shape or any(len(_each_once(profile)) < 2 for profile in self.shape):
            return Text(
                "A wanted shape needs at least two places.", "断面形状には2点以上が必要です。"
            )
        if any(len(_each_once(zone)) < 3 for zone in self.empty):
            return Text(
                "An empty zone needs at least three places.", "空白域には3点以上が必要です。"
            )
        finite = all(math.isfinite(value) for place in places for value in place)
        far = not finite or max(abs(value) for place in places for value in place) > _LARGEST_M
        if far or self.length_m < _SMALLEST_M or len(places) > _MOST_PLACES:
            return Text(
                "A template is 2 cm to 10 m large and has at most 200 places.",
                "テンプレートの大きさは2cm～10m、点数は200点以内にしてください。",
            )
        order = self.vertices
        if _index(order, (0.0, 0.0)) < 0 or any(_index(order, one.at) < 0 for one in self.lines):
            return Text(
                "Lines are made at vertices of the shape, and the anchor is one of them.",
                "線を作成する位置と基準点は、断面形状の頂点でなければなりません。",
            )
        if not LEAST_TOLERANCE_M <= self.tolerance_m <= MOST_TOLERANCE_M:
            return Text(
                "The tolerance of a template is 3 mm to 20 cm.",
                "テンプレートの許容差は3mm～20cmにしてください。",
            )
        return None


def _mirrored(profile: Profile) -> Profile:
    return tuple((0.0 - offset, height) for offset, height in profile)


def _moved(profile: Profile, origin: ProfilePlace) -> Profile:
    return tuple((offset - origin[0], height - origin[1]) for offset, height in profile)


def _is_same(one: ProfilePlace, other: ProfilePlace) -> bool:
    return math.dist(one, other) <= _SAME_M


def _index(places: Profile, wanted: ProfilePlace) -> int:
    """Where a place stands among others; −1 where it doesn't."""
    found = (number for number, place in enumerate(places) if _is_same(place, wanted))
    return next(found, -1)


def _each_once(places: Iterable[ProfilePlace]) -> Profile:
    kept: list[ProfilePlace] = []
    for place in places:
        if _index(tuple(kept), place) < 0:
            kept.append(place)
    return tuple(kept)
