"""Boards stand beside the road, and some walls carry a sign."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.street.styles import URBAN

KINDS = {"bus_stop", "billboard", "shop_sign", "banner"}
SIGN = 65


@pytest.fixture(scope="module")
def street() -> Street:
    """A long street in a town."""
    return Street(5, URBAN, 240.0)


def test_boards_of_most_kinds_stand_beside_a_street_and_none_shines(street: Street) -> None:
    found: set[str] = set()
    for row in street.within(0.0, 240.0):
        section = street.section(row)
        boards = {one.instance: one.kind for one in section.things if one.kind in KINDS}
        found |= set(boards.values())
        mesh = section.mesh
        of_boards = np.isin(mesh.instance, list(boards))
        assert not (mesh.material[of_boards] == Material.SIGN_FACE).any()
        assert not (mesh.label[of_boards] == SIGN).any()
    assert len(found) >= 3
