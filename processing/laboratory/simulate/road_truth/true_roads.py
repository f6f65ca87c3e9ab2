"""How wide and how steep the road of a street really is, each metre along its centre line."""

from __future__ import annotations

import csv
from collections.abc import Sequence
from dataclasses import astuple, dataclass, fields
from pathlib import Path

import numpy as np

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scene.mesh import Floats
from processing.laboratory.simulate.street.layout import SideLayout
from processing.laboratory.simulate.street.plan import LEFT, RIGHT, SIDES
from processing.laboratory.simulate.street.section import StreetSection

STEP_M = 1.0

_FLUSH = frozenset({"apron", "drain"})
"""Strips beside the asphalt that vehicles drive on, where no curb stands before them."""

_PLACES = 21
"""Heights across one half of the carriageway, of which its fall is taken."""

_DIGITS = 4


@dataclass(frozen=True)
class TrueRoad:
    """The carriageway at a place of the centre line.

    Attributes
    ----------
    chainage_m : float
    easting_m, northing_m, height_m : float
        Of the centre line, project CRS.
    left_m, right_m : float
        From the centre line to the foot of the curb, else to the end of the asphalt with a flush
        gutter.
    median_m : float
        Width of the raised strip in the middle; 0 for none.
    left_percent, right_percent : float
        Fall of the asphalt's halves outwards, %: of the straight line through their surface.
    slope_percent : float
        Rise along the centre line, %, over 10 m.
    is_open : bool
        Whether a side street meets the road here, where it has no edge.
    """

    chainage_m: float
    easting_m: float
    northing_m: float
    height_m: float
    left_m: float
    right_m: float
    median_m: float
    left_percent: float
    right_percent: float
    slope_percent: float
    is_open: bool


def true_roads(street: Street, length_m: float, origin: Floats) -> tuple[TrueRoad, ...]:
    """The road each metre of what is driven of a street."""
    return tuple(
        _at(street, float(at), origin) for at in np.arange(0.0, length_m + STEP_M / 2, STEP_M)
    )


def write_true_roads(path: Path, rows: Sequence[TrueRoad]) -> None:
    """Write them as a table whose columns are named as the fields are."""
    with path.open("w", encoding="utf-8", newline="") as file:
        writer = csv.writer(file, lineterminator="\n")
        writer.writerow(one.name for one in fields(TrueRoad))
        for row in rows:
            writer.writerow(
                round(one, _DIGITS) if isinstance(one, float) else int(one) for one in astuple(row)
            )


def read_true_roads(path: Path) -> tuple[TrueRoad, ...]:
    """The table as :func:`write_true_roads` writes it."""
    with path.open(encoding="utf-8", newline="") as file:
        return tuple(
            TrueRoad(
                **{name: float(one) for name, one in row.items() if name != "is_open"},
                is_open=row["is_open"] == "1",
            )
            for row in csv.DictReader(file)
        )


def carriageway_edges(section: StreetSection, chainages: Floats) -> dict[int, Floats]:
    """How far from the centre line the carriageway reaches, by side: (n,) float64, m."""
    return {side: _edge_away(section.layout.sides[side], chainages, side) for side in SIDES}


def _edge_away(layout: SideLayout, chainages: Floats, side: int) -> Floats:
    sweep, line = layout.sweep, 0
    edges = [one for one in sweep.profile.edges if one.role == "road"]
    if edges:
        line = edges[0].foot
    elif layout.mouth is None:
        while line < len(sweep.profile.strips) and sweep.profile.strips[line].kind in _FLUSH:
            line += 1
    away: Floats = np.interp(chainages, sweep.chainages[:, line], side * sweep.offsets[:, line])
    return away


def _at(street: Street, chainage: float, origin: Floats) -> TrueRoad:
    section = street.bare_section(street.within(chainage, chainage + 1e-6)[0])
    terrain, plan = section.layout.terrain, section.plan
    along = np.array([chainage])
    edges = carriageway_edges(section, along)
    half = plan.median_m / 2
    falls = {}
    for side in SIDES:
        away = np.linspace(half, plan.side(side).edge_m, _PLACES)
        heights = terrain.height(np.full(_PLACES, chainage), side * away)
        falls[side] = -100.0 * float(np.polyfit(away, heights, 1)[0])
    ends = np.interp(
        [chainage - 5.0, chainage + 5.0],
        street.alignment.chainages,
        street.alignment.positions[:, 2],
    )
    height = float(terrain.height(chainage, 0.0))
    place = street.alignment.at(chainage, 0.0, height) + origin
    return TrueRoad(
        chainage, float(place[0]), float(place[1]), float(place[2]),
        float(edges[LEFT][0]), float(edges[RIGHT][0]), plan.median_m,
        falls[LEFT], falls[RIGHT], 10.0 * float(ends[1] - ends[0]),
        any(one.mouth is not None for one in section.layout.sides.values()),
    )  # fmt: skip
