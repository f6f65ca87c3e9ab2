"""All that stands beside a section: each kind is added in turn and takes its places."""

from __future__ import annotations

from processing.laboratory.simulate.border.barriers import add_barriers
from processing.laboratory.simulate.border.boxes import add_boxes
from processing.laboratory.simulate.border.land import add_land
from processing.laboratory.simulate.border.lots import add_lots
from processing.laboratory.simulate.roadside.boards import add_boards
from processing.laboratory.simulate.roadside.bollards import add_bollards
from processing.laboratory.simulate.roadside.lights import add_lights
from processing.laboratory.simulate.roadside.mirrors import add_mirrors
from processing.laboratory.simulate.roadside.overhead_signs import add_overhead_signs
from processing.laboratory.simulate.roadside.plants.hedges import add_hedges
from processing.laboratory.simulate.roadside.plants.street_trees import add_street_trees
from processing.laboratory.simulate.roadside.plants.weeds import add_weeds
from processing.laboratory.simulate.roadside.poles import add_utility_poles
from processing.laboratory.simulate.roadside.signals import add_signals
from processing.laboratory.simulate.roadside.signs import add_signs
from processing.laboratory.simulate.roadside.wires import add_wires
from processing.laboratory.simulate.roadway.box_lids import box_lids_of
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.section import StreetSection

KINDS = (
    add_lots,
    add_land,
    add_utility_poles,
    add_signals,
    add_overhead_signs,
    add_lights,
    add_signs,
    add_mirrors,
    add_wires,
    add_street_trees,
    add_bollards,
    add_hedges,
    add_weeds,
    add_boxes,
    add_barriers,
    add_boards,
)
"""In this order: what comes first chooses its places first."""


def add_furniture(section: StreetSection, built: SectionBuilder) -> None:
    """Add poles, wires, lights, signals, signs and plants of a section."""
    positions = FreePositions(section)
    for lid in box_lids_of(section):
        half = lid.long_m / 2, lid.wide_m / 2
        positions.block(
            (lid.chainage_m - half[0], lid.chainage_m + half[0]),
            (lid.offset_m - half[1], lid.offset_m + half[1]),
        )
    for add in KINDS:
        add(positions, built)
