"""A whole street, built section by section when a section is asked for."""

from __future__ import annotations

import threading
from collections import OrderedDict
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from processing.laboratory.simulate.assembly.furniture import add_furniture
from processing.laboratory.simulate.gutters.aprons import add_aprons
from processing.laboratory.simulate.gutters.gutters import add_gutters
from processing.laboratory.simulate.gutters.transverse_gutters import add_transverse_gutters
from processing.laboratory.simulate.roadside.plants.plant_truth import add_plant_truth
from processing.laboratory.simulate.roadway.box_lids import add_box_lids
from processing.laboratory.simulate.roadway.edges import add_edges
from processing.laboratory.simulate.roadway.ends import add_ends
from processing.laboratory.simulate.roadway.islands import add_islands
from processing.laboratory.simulate.roadway.junctions import add_junctions
from processing.laboratory.simulate.roadway.markings import add_markings
from processing.laboratory.simulate.roadway.pavement import add_pavement
from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import (
    THINGS_PER_SECTION,
    SectionBuilder,
    Thing,
    TrueFeature,
)
from processing.laboratory.simulate.street.alignment import Alignment, alignment_of
from processing.laboratory.simulate.street.cross_section import section_of
from processing.laboratory.simulate.street.plan import SectionPlan, plans_of
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import Style
from processing.laboratory.simulate.street.surfaces import add_ground
from processing.laboratory.simulate.traffic.parked_vehicles import add_parked

SectionMaker = Callable[[StreetSection, SectionBuilder], None]
MAKERS: tuple[SectionMaker, ...] = (
    add_ground,
    add_junctions,
    add_islands,
    add_ends,
    add_edges,
    add_markings,
    add_pavement,
    add_box_lids,
    add_aprons,
    add_gutters,
    add_transverse_gutters,
    add_furniture,
    add_parked,
    add_plant_truth,
)
"""What builds a section, in this order; each draws from streams of its own.

What is parked comes last: it needs free room.
"""

_KEPT_SECTIONS = 24
_LOWEST_INDEX = -100


@dataclass(frozen=True)
class BuiltSection:
    """What one section holds."""

    plan: SectionPlan
    mesh: Mesh
    things: tuple[Thing, ...]
    truth: tuple[TrueFeature, ...]


class Street:
    """The street of a seed: the same whatever is built of it, and in which order.

    Parameters
    ----------
    length_m : float
        What is driven of it; a longer one begins like a shorter one.
    wear : float
        What time made of its kerb stones, 0 to 1.
    is_avenue : bool
        Rows of large trees stand along it, with posts under their crowns.
    is_flush : bool
        Most of its sides have no curb: flush walks, soft shoulders.
    """

    def __init__(
        self,
        seed: int,
        style: Style,
        length_m: float,
        wear: float = 0.0,
        *,
        is_avenue: bool = False,
        is_flush: bool = False,
    ) -> None:
        self.seed, self.style, self.length_m = seed, style, length_m
        self.alignment: Alignment = alignment_of(seed, style, length_m)
        self.plans = tuple(
            plans_of(seed, style, length_m, wear, is_avenue=is_avenue, is_flush=is_flush)
        )
        self._starts = np.array([one.start_m for one in self.plans])
        self._built: OrderedDict[int, BuiltSection] = OrderedDict()
        self._bare: OrderedDict[int, StreetSection] = OrderedDict()
        self._lock = threading.RLock()

    def within(self, from_m: float, to_m: float) -> range:
        """Rows in `plans` of the sections that a stretch of chainage touches."""
        first = int(np.searchsorted(self._starts, from_m, "right")) - 1
        last = int(np.searchsorted(self._starts, to_m, "left"))
        return range(max(0, first), max(first + 1, last))

    def section(self, row: int) -> BuiltSection:
        """One section with everything in it; a few are kept."""
        with self._lock:
            if row not in self._built:
                self._built[row] = self._build(row)
            self._built.move_to_end(row)
            while len(self._built) > _KEPT_SECTIONS:
                self._built.popitem(last=False)
            return self._built[row]

    def bare_section(self, row: int) -> StreetSection:
        """Plan and ground of a section, without building what stands on it; a few are kept."""
        with self._lock:
            if row not in self._bare:
                self._bare[row] = section_of(self.seed, self.plans, row, self.alignment)
            self._bare.move_to_end(row)
            while len(self._bare) > _KEPT_SECTIONS:
                self._bare.popitem(last=False)
            return self._bare[row]

    def ground_height(self, chainages: Floats, offsets: Floats) -> Floats:
        """Height of the ground, z in m: (n,) float64 of (n,) places beside the road."""
        heights = np.empty(chainages.shape)
        rows = np.clip(np.searchsorted(self._starts, chainages, "right") - 1, 0, None)
        for row in np.unique(rows):
            there = rows == row
            ground = self.bare_section(int(row)).ground
            heights[there] = ground.height(chainages[there], offsets[there])
        return heights

    def _build(self, row: int) -> BuiltSection:
        section = self.bare_section(row)
        plan = section.plan
        built = SectionBuilder((plan.index - _LOWEST_INDEX) * THINGS_PER_SECTION + 1)
        for add in MAKERS:
            add(section, built)
        return BuiltSection(plan, built.mesh.mesh(), tuple(built.things), tuple(built.truth))
