"""ProfileTemplate: the shape that a curb or gutter should have in a section, drawn once."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterable
from dataclasses import dataclass, replace

from processing.core.errors import OutOfRange
from processing.core.text import Text

ProfilePoint = tuple[float, float]
"""Offset to the right (looking along the line) and height, m, about the anchor."""
TemplateProfile = tuple[ProfilePoint, ...]

USUAL_TOLERANCE_M = 0.02
"""How far points may lie off the shape: a scanner's noise, a worn edge and a line drawn by hand."""

LEAST_TOLERANCE_M, MOST_TOLERANCE_M = 0.003, 0.20
"""From a scanner's noise to what still tells a curb from none."""

_LARGEST_M, _SMALLEST_M = 10.0, 0.02
"""Sides of a template: a carriageway's, and what a tolerance leaves of a step."""

_SAME_M = 1e-6
"""Vertices nearer than this are one."""

_MOST_POSITIONS, _LONGEST_NAME = 200, 80
"""Vertices and letters; more are a slip, or a damaged file."""


@dataclass(frozen=True)
class MadeLine:
    """A line that a fit makes.

    Attributes
    ----------
    kind : str
        Id of a feature kind of the catalogue.
    at : ProfilePoint
        The vertex of the shape that the line follows.
    """

    kind: str
    at: ProfilePoint = (0.0, 0.0)


@dataclass(frozen=True)
class ProfileTemplate:
    """What a section should look like, and where nothing should be.

    Attributes
    ----------
    name : str
    shape : tuple of TemplateProfile
        Open polylines of two positions and more; the anchor, (0, 0), is one of their vertices.
    lines : tuple of MadeLine
        At vertices of the shape.
    empty : tuple of TemplateProfile
        Rings (the first position not repeated) in which no point should be.
    tolerance_m : float
        Points this near to the shape lie on it.

    Raises
    ------
    OutOfRange
        The shape is no profile, or something lies beside it.
    """

    name: str
    shape: tuple[TemplateProfile, ...]
    lines: tuple[MadeLine, ...]
    empty: tuple[TemplateProfile, ...] = ()
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
    def vertices(self) -> TemplateProfile:
        """The positions of the shape, each once, in the order in which they were drawn."""
        return _each_once(position for profile in self.shape for position in profile)

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
        positions = [position for profile in (*self.shape, *self.empty) for position in profile]
        across, up = (
            [position[0] for position in positions],
            [position[1] for position in positions],
        )
        return min(across), max(across), min(up), max(up)

    def mirrored(self) -> ProfileTemplate:
        """The same shape for the other side of the street."""
        return replace(
            self,
            shape=tuple(_mirrored(profile) for profile in self.shape),
            lines=tuple(replace(line, at=_mirrored((line.at,))[0]) for line in self.lines),
            empty=tuple(_mirrored(profile) for profile in self.empty),
        )

    def about(self, vertex: ProfilePoint) -> ProfileTemplate:
        """The same shape with another of its vertices as the anchor."""
        return replace(
            self,
            shape=tuple(_moved(profile, vertex) for profile in self.shape),
            lines=tuple(replace(line, at=_moved((line.at,), vertex)[0]) for line in self.lines),
            empty=tuple(_moved(profile, vertex) for profile in self.empty),
        )

    def kind_at(self, vertex: ProfilePoint) -> str:
        """The kind of the line made at a vertex; empty where none is."""
        return next((line.kind for line in self.lines if _is_same(line.at, vertex)), "")

    def with_kind_at(self, vertex: ProfilePoint, kind: str) -> ProfileTemplate:
        """Another kind for the line at a vertex; an empty one takes the line away."""
        others = tuple(line for line in self.lines if not _is_same(line.at, vertex))
        lines = (*others, MadeLine(kind, vertex)) if kind else others
        order = self.vertices
        return replace(self, lines=tuple(sorted(lines, key=lambda one: _index(order, one.at))))

    def _what_is_wrong(self) -> Text | None:
        positions = [position for profile in (*self.shape, *self.empty) for position in profile]
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
        finite = all(math.isfinite(value) for position in positions for value in position)
        far = (
            not finite
            or max(abs(value) for position in positions for value in position) > _LARGEST_M
        )
        if far or self.length_m < _SMALLEST_M or len(positions) > _MOST_POSITIONS:
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


def _mirrored(profile: TemplateProfile) -> TemplateProfile:
    return tuple((0.0 - offset, height) for offset, height in profile)


def _moved(profile: TemplateProfile, origin: ProfilePoint) -> TemplateProfile:
    return tuple((offset - origin[0], height - origin[1]) for offset, height in profile)


def _is_same(one: ProfilePoint, other: ProfilePoint) -> bool:
    return math.dist(one, other) <= _SAME_M


def _index(positions: TemplateProfile, wanted: ProfilePoint) -> int:
    """Where a position stands among others; −1 where it doesn't."""
    found = (number for number, position in enumerate(positions) if _is_same(position, wanted))
    return next(found, -1)


def _each_once(positions: Iterable[ProfilePoint]) -> TemplateProfile:
    kept: list[ProfilePoint] = []
    for position in positions:
        if _index(tuple(kept), position) < 0:
            kept.append(position)
    return tuple(kept)
