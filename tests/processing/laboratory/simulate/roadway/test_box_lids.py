"""Lids of boxes lie on the pavement, apart from lowered curbs, and nothing stands on them."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.furniture import add_furniture
from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadway.box_lids import BoxLid, add_box_lids, box_lids_of
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import URBAN
from processing.laboratory.simulate.street.walk_lines import walk_lines


@pytest.fixture(scope="module")
def sections() -> list[StreetSection]:
    """Sections of a street with walks."""
    street = Street(3, URBAN, 200.0)
    return [street.bare_section(row) for row in street.within(0.0, 200.0)]


def _lids(sections: list[StreetSection]) -> list[tuple[StreetSection, BoxLid]]:
    found = [(section, lid) for section in sections for lid in box_lids_of(section)]
    assert len(found) > 3
    return found


def test_lids_lie_in_the_walk_clear_of_lowered_curbs(sections: list[StreetSection]) -> None:
    for section, lid in _lids(sections):
        side = 1 if lid.offset_m > 0 else -1
        lines = walk_lines(section, side)
        assert lines is not None
        inner, outer = lines.between(np.array([lid.chainage_m]))
        assert inner[0] < abs(lid.offset_m) - lid.wide_m / 2
        assert outer[0] > abs(lid.offset_m) + lid.wide_m / 2
        for drop in section.layout.sides[side].drops:
            low, high = lid.chainage_m - lid.long_m / 2, lid.chainage_m + lid.long_m / 2
            assert high < drop.from_m or low > drop.to_m


def test_lids_are_as_high_as_the_pavement_and_a_little_more(sections: list[StreetSection]) -> None:
    for section in sections:
        built = SectionBuilder(1)
        add_box_lids(section, built)
        mesh = built.mesh.mesh()
        for lid, thing in zip(box_lids_of(section), built.things, strict=False):
            own = mesh.vertices[np.unique(mesh.triangles[mesh.instance == thing.instance])]
            ground = section.position(lid.chainage_m, lid.offset_m)
            assert own[:, 2].max() > ground[2]
            reach = np.linalg.norm((own - ground)[:, :2], axis=1).max()
            assert reach < np.hypot(lid.long_m, lid.wide_m) / 2 + 0.05


def test_nothing_is_set_up_on_a_lid(sections: list[StreetSection]) -> None:
    for section in sections[:4]:
        built = SectionBuilder(1)
        add_furniture(section, built)
        lids = list(box_lids_of(section))
        for one in built.truth:
            if one.file not in ("poles", "trees"):
                continue
            for lid in lids:
                middle = section.position(lid.chainage_m, lid.offset_m)
                away = np.linalg.norm((one.xyz[0] - middle)[:2])
                assert away > min(lid.long_m, lid.wide_m) / 2
