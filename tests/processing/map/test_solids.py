"""Bodies below areas: closed, as thick as they say, their faces looking outwards."""

from __future__ import annotations

from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.catalogue_writing import write_catalogue
from processing.map.feature import Feature, Vertex
from processing.map.solids import Solid, solid_of, thickness_of
from resources import path_of

LID = np.array([[0.0, 0.0, 5.0], [0.6, 0.0, 5.03], [0.6, 0.38, 5.03], [0.0, 0.38, 5.0]])
ELBOW = np.array([[0, 0, 1], [2, 0, 1], [2, 1, 1], [1, 1, 1], [1, 2, 1], [0, 2, 1]], float)


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def volume_m3(solid: Solid) -> float:
    """By the divergence theorem: right only if the faces close the body and look outwards."""
    total = 0.0
    for face in (*solid.top, *solid.sides, *solid.bottom):
        first, *others = solid.positions[list(face)]
        for second, third in pairwise(others):
            total += float(np.dot(first, np.cross(second, third))) / 6
    return total


def area(kind: str, ring: NDArray[np.float64], **attributes: float) -> Feature:
    vertices = tuple(Vertex((float(x), float(y), float(z))) for x, y, z in ring)
    return Feature("f", kind, Geometry.AREA, vertices, attributes=attributes)


@pytest.mark.parametrize("ring", [LID, LID[::-1], ELBOW, ELBOW[::-1], np.roll(ELBOW, 2, axis=0)])
def test_a_body_is_closed_and_has_the_volume_of_its_top_times_its_thickness(
    ring: NDArray[np.float64],
) -> None:
    solid = solid_of(ring + np.array([1000.0, -2000.0, 50.0]), 0.1)
    assert solid is not None
    top_m2 = 3.0 if len(ring) == 6 else 0.38 * np.hypot(0.6, 0.03)
    assert volume_m3(solid) == pytest.approx(top_m2 * 0.1, rel=1e-6)
    edges = [
        (face[at - 1], face[at])
        for face in (*solid.top, *solid.sides, *solid.bottom)
        for at in range(len(face))
    ]
    assert sorted(edges) == sorted((second, first) for first, second in edges)


def test_a_lid_has_one_face_above_and_four_beside() -> None:
    solid = solid_of(LID, 0.1)
    assert solid is not None
    assert [len(face) for face in solid.top] == [4]
    assert [len(face) for face in solid.sides] == [4] * 4
    # Square to the top, on a slope too.
    down = solid.positions[4:] - solid.positions[:4]
    assert np.linalg.norm(down, axis=1) == pytest.approx(0.1)
    assert down @ (LID[1] - LID[0]) == pytest.approx(0.0, abs=1e-12)


@pytest.mark.parametrize(
    "ring",
    [
        LID[:2],
        LID[[0, 1, 0]],
        np.array([[0, 0, 0], [1, 0, 0], [1, 0, 1], [0, 0, 1]], float),
        LID * [np.nan, 1, 1],
    ],
)
def test_what_has_no_area_in_plan_has_no_body(ring: NDArray[np.float64]) -> None:
    assert solid_of(ring, 0.1) is None


def test_lids_and_gratings_are_bodies_and_other_areas_are_not(catalogue: Catalogue) -> None:
    thick = {
        kind.id: thickness_of(kind, replace(area(kind.id, LID), geometry=kind.geometry))
        for kind in catalogue
    }
    assert {id_: one for id_, one in thick.items() if one} == {
        "gutter_lid": 0.1,
        "gutter_grating": 0.05,
    }


@pytest.mark.parametrize(
    ("own", "thickness_m"), [(0.125, 0.125), (0.0, 0.1), (-1.0, 0.1), (np.inf, 0.1), (True, 0.1)]
)
def test_a_feature_says_itself_how_thick_it_is(
    catalogue: Catalogue, own: float, thickness_m: float
) -> None:
    lid = area("gutter_lid", LID, thickness_m=own)
    assert thickness_of(catalogue["gutter_lid"], lid) == thickness_m


def test_the_thickness_of_a_kind_is_written_and_read_again(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    write_catalogue(tmp_path / "kinds.toml", catalogue)
    assert read_catalogue(tmp_path / "kinds.toml")["gutter_grating"].thickness_m == 0.05
