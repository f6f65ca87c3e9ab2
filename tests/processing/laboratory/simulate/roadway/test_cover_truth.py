"""Truth of covers lies on what was built, and its pieces are those of its triangles."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import BuiltSection, Street
from processing.laboratory.simulate.roadway.box_lids import box_lids_of
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.things import TrueFeature
from processing.laboratory.simulate.street.styles import URBAN


@pytest.fixture(scope="module")
def sections() -> list[BuiltSection]:
    street = Street(9541, URBAN, 90.0)
    return [street.section(row) for row in street.within(0.0, 90.0)]


def covers_of(section: BuiltSection, shape: str) -> list[TrueFeature]:
    return [one for one in section.truth if one.file == "covers" and one.facts["shape"] == shape]


def own(section: BuiltSection, instance: int) -> np.ndarray:
    mesh = section.mesh
    corners: np.ndarray = mesh.vertices[mesh.triangles[mesh.instance == instance]]
    return corners.reshape(-1, 3)


def test_a_round_cover_is_as_wide_as_its_iron(sections: list[BuiltSection]) -> None:
    found = [(section, one) for section in sections for one in covers_of(section, "round")]
    assert found
    for section, one in found:
        away = np.hypot(*(own(section, one.instance) - one.xyz[0])[:, :2].T)
        assert 2 * away.max() == pytest.approx(one.facts["diameter_m"], rel=0.1)
        assert one.facts["kind"] == ("valve_cover" if 2 * away.max() < 0.4 else "manhole")


def test_the_corners_of_a_square_cover_are_those_of_its_body(sections: list[BuiltSection]) -> None:
    kinds = set()
    for section in sections:
        for one in covers_of(section, "square"):
            body = own(section, one.instance)
            for corner in one.xyz[:4]:
                assert np.hypot(*(body - corner)[:, :2].T).min() < 0.02
            kinds.add(one.facts["kind"])
    assert kinds == {"manhole_area", "rain_inlet"}


def test_every_piece_of_a_cover_has_triangles(sections: list[BuiltSection]) -> None:
    for section in sections:
        for one in covers_of(section, "round") + covers_of(section, "square"):
            mesh = section.mesh
            pieces = set(mesh.piece[mesh.instance == one.instance].tolist())
            count = one.facts["pieces"]
            assert isinstance(count, int)
            assert set(range(count)) <= pieces


def test_covers_are_of_bright_and_dark_iron_with_a_joint_in_their_frame(
    sections: list[BuiltSection],
) -> None:
    street = Street(9544, URBAN, 200.0)
    more = [street.section(row) for row in street.within(0.0, 200.0)]
    materials = set()
    for section in [*sections, *more]:
        for one in covers_of(section, "round"):
            mesh = section.mesh
            materials |= set(mesh.material[mesh.instance == one.instance].tolist())
    assert materials == {Material.STEEL, Material.OLD_IRON, Material.JOINT}


def test_lids_of_walks_are_covers_that_lie_in_the_walk() -> None:
    street = Street(9541, URBAN, 90.0)
    for row in street.within(0.0, 90.0):
        section = street.bare_section(row)
        lids = [
            one
            for one in covers_of(street.section(row), "square")
            if one.facts["lies_in"] == "walk"
        ]
        assert len(lids) == len(list(box_lids_of(section)))
