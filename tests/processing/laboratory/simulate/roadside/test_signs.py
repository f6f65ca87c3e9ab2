"""Plates: their triangles tell what their truth tells."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadside.sign_plates import (
    BACK_PIECE,
    FRONT_PIECE,
    PlateMounting,
    SignPlate,
    add_plate,
    centre_and_normal,
    outline,
)
from processing.laboratory.simulate.roadside.signs import add_signs
from processing.laboratory.simulate.scene.mesh import Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.free_positions import FreePositions
from processing.laboratory.simulate.street.styles import URBAN

PLATES = [
    SignPlate("circle", 0.6),
    SignPlate("triangle", 0.8),
    SignPlate("square", 0.6),
    SignPlate("diamond", 0.45),
    SignPlate("pentagon", 0.6),
    SignPlate("rectangle", 0.4, 0.2),
]


def _hung(plate: SignPlate) -> tuple[Mesh, TrueFeature]:
    built = SectionBuilder(1)
    where = PlateMounting(np.array([3.0, 4.0, 2.5]), np.deg2rad(30.0), 0.02, 0.01, ground_m=0.1)
    add_plate(built, plate, where, 12.0)
    return built.mesh.mesh(), built.truth[0]


def _side(mesh: Mesh, instance: int, piece: int) -> tuple[np.ndarray, np.ndarray]:
    chosen = (mesh.instance == instance) & (mesh.piece == piece)
    return centre_and_normal((mesh.vertices, mesh.triangles[chosen]))


@pytest.mark.parametrize("plate", PLATES, ids=lambda one: one.shape)
def test_a_plate_faces_where_it_was_hung_and_is_dull_behind(plate: SignPlate) -> None:
    mesh, truth = _hung(plate)
    centre, normal = _side(mesh, 1, FRONT_PIECE)
    behind, back = _side(mesh, 1, BACK_PIECE)
    np.testing.assert_allclose(truth.xyz[0], centre, atol=1e-9)
    assert truth.facts["facing_deg"] == pytest.approx(60.0, abs=0.01)
    assert normal @ back == pytest.approx(-1.0)
    assert (centre - behind) @ normal == pytest.approx(0.0025, abs=1e-6)
    assert truth.facts["height_m"] == pytest.approx(centre[2] - 0.1)


@pytest.mark.parametrize("plate", PLATES, ids=lambda one: one.shape)
def test_outlines_are_as_large_as_their_names_say(plate: SignPlate) -> None:
    corners = outline(plate)
    wide, high = np.ptp(corners, axis=0)
    stated = {
        "circle": (0.6, 0.6),
        "triangle": (0.8, 0.8 * np.sqrt(3) / 2),
        "square": (0.6, 0.6),
        "diamond": (0.45 * np.sqrt(2), 0.45 * np.sqrt(2)),
        "pentagon": (0.6, 0.6),
        "rectangle": (0.4, 0.2),
    }[plate.shape]
    np.testing.assert_allclose([wide, high], stated, rtol=0.065)
    following = np.roll(corners, -1, axis=0)
    area = (corners[:, 0] * following[:, 1] - corners[:, 1] * following[:, 0]).sum() / 2
    assert area > 0


def test_a_stop_sign_stands_on_its_tip() -> None:
    corners = outline(SignPlate("triangle", 0.8))
    assert abs(corners[np.argmin(corners[:, 1]), 0]) < 0.02
    _, truth = _hung(SignPlate("triangle", 0.8))
    middle = truth.facts["bbox_centre"]
    assert isinstance(middle, list)
    assert truth.xyz[0, 2] - middle[2] > 0.08


def test_signs_of_a_street_hang_clear_of_the_ground_and_beside_the_road() -> None:
    street = Street(3, URBAN, 200.0)
    signs = 0
    for row in street.within(0.0, 200.0):
        built = SectionBuilder(1)
        add_signs(FreePositions(street.bare_section(row)), built)
        mesh = built.mesh.mesh()
        for sign in built.truth:
            if sign.file != "signs":
                continue
            centre, normal = _side(mesh, sign.instance, FRONT_PIECE)
            np.testing.assert_allclose(sign.xyz[0], centre, atol=1e-6)
            turn = np.rad2deg(np.arctan2(normal[0], normal[1])) % 360
            assert turn == pytest.approx(sign.facts["facing_deg"])
            height = sign.facts["height_m"]
            assert isinstance(height, float)
            assert 1.2 < height < 9.0
            signs += 1
    assert signs > 4
