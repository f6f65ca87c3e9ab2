"""What is built where along a street: sections that are alike, each side with its bands."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from typing import Literal, TypeVar

from numpy.random import Generator

from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.street.alignment import MARGIN_M
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN, Range, Style

LEFT, RIGHT = 1, -1
SIDES = (LEFT, RIGHT)

Drain = Literal["none", "apron", "lids", "open"]
Curb = Literal["none", "raised", "semi", "flat", "asphalt"]
Outside = Literal["lots", "fields", "rise", "fall", "wall", "wood"]
Flush = Literal["none", "walk", "gravel", "soil"]
BandName = Literal["drain", "curb", "strip", "walk", "shoulder", "verge", "outside"]

_Name = TypeVar("_Name", bound=str)

_KEPT_SHARE = 0.7
_FARTHEST_M = 60.0
_FLUSH_SHARE = 0.8


@dataclass(frozen=True)
class RoadBand:
    """A band of a side, by its distances from the road's centre, m."""

    name: BandName
    inner_m: float
    outer_m: float


@dataclass(frozen=True)
class SidePlan:
    """One side of a section, from the carriageway's edge outwards.

    Attributes
    ----------
    edge_m : float
        From the road's centre to the edge of the asphalt.
    drain : str
        What takes the water: ``apron`` (L-shaped gutter's concrete), ``lids`` (covered U-gutter),
        ``open`` (open gutter).
    drain_m : float
        Its width.
    curb : str
        ``raised``: the walk is as high as the stone (マウントアップ); ``semi``: some centimetres
        above the road, the stone higher than both; ``flat``: level with the road, a stone between;
        ``asphalt``: a low asphalt kerb with a slope or verge behind.
    curb_high_m, curb_wide_m : float
    strip_m : float
        Planting strip behind the curb.
    walk_m : float
        Sidewalk.
    has_tactile : bool
    verge_m : float
        Between the walk and what is outside: yards, grass.
    outside : str
        What the land is.
    outside_high_m : float
        How far it rises (positive) or falls within its first metres.
    wear : float
        What time made of its kerb stones: 0 as laid, 1 settled, tilted and rounded.
    is_avenue : bool
        A row of large trees stands along it.
    flush : str
        What lies at the carriageway's level where no curb stands: ``walk`` (a flush walk of paving
        or concrete), ``gravel`` or ``soil`` (a shoulder); ``none``: a grass verge.
    shoulder_m : float
        Width of a shoulder of gravel or soil.
    """

    edge_m: float
    drain: Drain
    drain_m: float
    curb: Curb
    curb_high_m: float
    curb_wide_m: float
    strip_m: float
    walk_m: float
    has_tactile: bool
    verge_m: float
    outside: Outside
    outside_high_m: float
    wear: float = 0.0
    is_avenue: bool = False
    flush: Flush = "none"
    shoulder_m: float = 0.0

    def bands(self) -> Iterator[RoadBand]:
        """The bands there are, from the asphalt outwards."""
        curb = 0.0 if self.curb == "none" else self.curb_wide_m
        wide: tuple[tuple[BandName, float], ...] = (
            ("drain", 0.0 if self.drain == "none" else self.drain_m),
            ("curb", curb),
            ("strip", self.strip_m),
            ("walk", self.walk_m),
            ("shoulder", self.shoulder_m),
            ("verge", self.verge_m),
        )
        at = self.edge_m
        for name, width in wide:
            if width > 0:
                yield RoadBand(name, at, at + width)
                at += width
        yield RoadBand("outside", at, max(_FARTHEST_M, at + 1))

    def band(self, name: BandName) -> RoadBand | None:
        """The band of a name, or None."""
        return next((one for one in self.bands() if one.name == name), None)


@dataclass(frozen=True)
class SectionPlan:
    """A stretch of the street that is alike.

    Attributes
    ----------
    index : int
        Its number; 0 holds the drive's beginning, negative ones lie before it.
    start_m, end_m : float
        Chainages.
    lanes : int
        In one direction.
    lane_m : float
    median_m : float
        Width of the raised strip between both directions; 0 for none.
    left, right : SidePlan
    junctions : tuple of int
        Sides (`LEFT`, `RIGHT`) at which a side street meets the road here.
    """

    index: int
    start_m: float
    end_m: float
    style: Style
    lanes: int
    lane_m: float
    median_m: float
    left: SidePlan
    right: SidePlan
    junctions: tuple[int, ...]

    def side(self, side: int) -> SidePlan:
        """The plan of `LEFT` or `RIGHT`."""
        return self.left if side == LEFT else self.right

    @property
    def length_m(self) -> float:
        """How long it is."""
        return self.end_m - self.start_m

    def lane_offset_m(self, lane: int) -> float:
        """Middle of a lane of the drive's direction (left-hand traffic), 0 being the outermost."""
        return self.median_m / 2 + (self.lanes - lane - 0.5) * self.lane_m


def plans_of(
    seed: int,
    style: Style,
    length_m: float,
    wear: float = 0.0,
    *,
    is_avenue: bool = False,
    is_flush: bool = False,
) -> list[SectionPlan]:
    """All sections of a street in their order; a longer street begins like a shorter one."""
    street = _Street(seed, style, wear, is_avenue=is_avenue, is_flush=is_flush)
    ahead = list(street.outwards(1, length_m + MARGIN_M * 0.9))
    behind = list(street.outwards(-1, MARGIN_M * 0.9))
    return [*behind[::-1], *ahead]


class _Street:
    def __init__(
        self, seed: int, style: Style, wear: float, *, is_avenue: bool, is_flush: bool
    ) -> None:
        random = chance(seed, "street")
        self.seed, self.style, self.wear = seed, style, wear
        self.is_avenue, self.is_flush = is_avenue, is_flush
        self.lanes = int(random.integers(style.lanes[0], style.lanes[1] + 1))
        self.lane_m = float(random.uniform(*style.lane_m))
        self.has_median = bool(random.random() < style.median_share)
        self.median_m = float(random.uniform(1.0, 3.0)) if self.has_median else 0.0
        self.shoulders_m = {side: float(random.uniform(*style.shoulder_m)) for side in SIDES}
        self.first_m = -float(random.uniform(0, style.section_m[0]))
        self.sides = {side: self._first_side(side) for side in SIDES}

    def _first_side(self, side: int) -> SidePlan:
        made = self._side(chance(self.seed, "side", side), side)
        return self._flush(made, chance(self.seed, "flush side", side))

    def outwards(self, direction: int, until_m: float) -> Iterator[SectionPlan]:
        """Sections from the beginning on, or (−1) from it backwards."""
        index, at = (0, self.first_m) if direction > 0 else (-1, self.first_m)
        sides, was_junction = dict(self.sides), True
        while direction * at < until_m:
            random = chance(self.seed, "section", index)
            is_junction = not was_junction and random.random() < self.style.junction_share
            long = float(random.uniform(*self.style.section_m))
            junctions: tuple[int, ...] = ()
            if is_junction:
                long = float(random.uniform(16, 30))
                junctions = ((LEFT,), (RIGHT,), SIDES)[int(random.integers(3))]
            for side in SIDES:
                fresh = chance(self.seed, "side", side, index)
                if not is_junction and fresh.random() > _KEPT_SHARE:
                    drawn = chance(self.seed, "flush side", side, index)
                    sides[side] = self._flush(self._side(fresh, side), drawn)
            start, end = (at, at + long) if direction > 0 else (at - long, at)
            yield SectionPlan(
                index,
                start,
                end,
                self.style,
                self.lanes,
                self.lane_m,
                self.median_m,
                sides[LEFT],
                sides[RIGHT],
                junctions,
            )
            was_junction, at, index = is_junction, at + direction * long, index + direction

    def _flush(self, side: SidePlan, random: Generator) -> SidePlan:
        """The same side without a curb, as most are of a street that is wanted so."""
        if not self.is_flush or random.random() > _FLUSH_SHARE:
            return side
        return _flush_side(random, side, self.style)

    def _side(self, random: Generator, side: int) -> SidePlan:
        edge = self.median_m / 2 + self.lanes * self.lane_m + self.shoulders_m[side]
        plain = SidePlan(
            edge, "none", 0.0, "none", 0.0, 0.0, 0.0, 0.0, has_tactile=False, verge_m=0.0,
            outside="lots", outside_high_m=0.0, wear=self.wear,
            is_avenue=self.is_avenue,
        )  # fmt: skip
        if self.style is URBAN:
            return _urban_side(random, plain)
        if self.style is HIGHWAY:
            return _highway_side(random, plain)
        return _rural_side(random, plain)


def _one_of(random: Generator, shares: Mapping[_Name, float]) -> _Name:
    names = list(shares)
    return names[int(random.choice(len(names), p=list(shares.values())))]


def _urban_side(random: Generator, plain: SidePlan) -> SidePlan:
    curbs: dict[Curb, float] = {"raised": 0.5, "semi": 0.2, "flat": 0.12, "none": 0.18}
    curb = _one_of(random, curbs)
    drains: dict[Drain, float] = {"apron": 0.62, "none": 0.18, "lids": 0.2}
    drain = _one_of(random, drains)
    high: dict[Curb, Range] = {"raised": (0.1, 0.25), "semi": (0.12, 0.22), "flat": (0.12, 0.25)}
    side = replace(
        plain,
        drain="lids" if curb == "none" else drain,
        drain_m=float(random.uniform(0.38, 0.66)),
        verge_m=float(random.uniform(0.2, 3.0)),
        outside="lots",
    )
    if curb == "none":
        return side
    return replace(
        side,
        curb=curb,
        curb_high_m=float(random.uniform(*high[curb])),
        curb_wide_m=float(random.uniform(0.12, 0.2)),
        strip_m=float(random.uniform(0.6, 1.5)) if random.random() < 0.35 else 0.0,
        walk_m=float(random.uniform(1.2, 4.5)),
        has_tactile=bool(random.random() < 0.4),
    )


def _rural_side(random: Generator, plain: SidePlan) -> SidePlan:
    drains: dict[Drain, float] = {"lids": 0.5, "open": 0.15, "apron": 0.1, "none": 0.25}
    drain = _one_of(random, drains)
    outsides: dict[Outside, float] = {"fields": 0.25, "rise": 0.2, "fall": 0.15, "wall": 0.15}
    outsides |= {"wood": 0.1, "lots": 0.15}
    outside = _one_of(random, outsides)
    side = replace(
        plain,
        drain=drain,
        drain_m=float(random.uniform(0.38, 0.66)),
        verge_m=float(random.uniform(0.3, 2.0)),
        outside=outside,
    )
    if random.random() < 0.2:
        side = replace(
            side,
            curb="raised",
            curb_high_m=float(random.uniform(0.1, 0.2)),
            curb_wide_m=float(random.uniform(0.12, 0.18)),
            walk_m=float(random.uniform(1.0, 2.5)),
        )
    return replace(side, outside_high_m=_outside_high_m(random, outside))


def _highway_side(random: Generator, plain: SidePlan) -> SidePlan:
    outsides: dict[Outside, float] = {"rise": 0.3, "fall": 0.45, "wall": 0.15, "fields": 0.1}
    outside = _one_of(random, outsides)
    drains: dict[Drain, float] = {"open": 0.25, "apron": 0.35, "none": 0.4}
    curbs: dict[Curb, float] = {"asphalt": 0.4, "raised": 0.1, "none": 0.5}
    curb = _one_of(random, curbs)
    return replace(
        plain,
        drain=_one_of(random, drains),
        drain_m=float(random.uniform(0.4, 0.7)),
        curb=curb,
        curb_high_m=float(random.uniform(0.07, 0.15)),
        curb_wide_m=float(random.uniform(0.12, 0.25)),
        verge_m=float(random.uniform(0.5, 2.5)),
        outside=outside,
        outside_high_m=_outside_high_m(random, outside),
    )


def _flush_side(random: Generator, side: SidePlan, style: Style) -> SidePlan:
    """A flush walk or a soft shoulder in place of what the side has, some behind an apron."""
    kinds: dict[Flush, float] = {"walk": 0.15, "gravel": 0.3, "soil": 0.25, "none": 0.3}
    if style is URBAN:
        kinds = {"walk": 0.65, "gravel": 0.2, "soil": 0.15, "none": 0.0}
    kind = _one_of(random, kinds)
    drains: dict[Drain, float] = {"none": 0.7, "apron": 0.2, "lids": 0.1}
    return replace(
        side,
        drain=_one_of(random, drains),
        drain_m=float(random.uniform(0.38, 0.66)),
        curb="none",
        strip_m=0.0,
        walk_m=float(random.uniform(1.2, 3.5)) if kind == "walk" else 0.0,
        has_tactile=bool(kind == "walk" and random.random() < 0.2),
        flush=kind,
        shoulder_m=float(random.uniform(0.5, 2.0)) if kind in ("gravel", "soil") else 0.0,
    )


def _outside_high_m(random: Generator, outside: str) -> float:
    if outside == "rise":
        return float(random.uniform(1.0, 8.0))
    if outside == "wall":
        return float(random.uniform(0.8, 5.0))
    if outside == "fall":
        return -float(random.uniform(0.8, 6.0))
    return float(random.uniform(-0.4, 0.4))
