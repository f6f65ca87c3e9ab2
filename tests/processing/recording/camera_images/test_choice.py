"""The images that see a place are found, best first, and their fields of view are drawn."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
import shapely

from processing.recording.camera_images.choice import ImageFinder, field_of_view
from processing.recording.camera_images.image_list import CameraImage
from tests.builders import START
from tests.camera_scene import looking

NORTH, EAST, SOUTH = (0.0, 1.0, 0.0), (1.0, 0.0, 0.0), (0.0, -1.0, 0.0)


def front(along_m: float, **changes: object) -> CameraImage:
    image = looking(Path(f"front_{along_m:04.0f}.jpg"), (0.0, along_m, 2.0), NORTH)
    return replace(image, **changes)  # type: ignore[arg-type]


def at(east: float, north: float, up: float = 2.0) -> np.ndarray:
    return START + np.array([east, north, up])


def names(choice: ImageFinder, position: np.ndarray) -> list[str]:
    return [sighting.image.path.stem for sighting in choice.seeing(position)]


def test_nearer_images_come_first_and_those_behind_not_at_all() -> None:
    choice = ImageFinder([front(0), front(10), front(20), front(30)])
    assert names(choice, at(0, 25)) == ["front_0020", "front_0010", "front_0000"]


def test_an_image_is_better_where_its_pixels_are_smaller() -> None:
    tele = front(0, focal_px=2500.0)
    choice = ImageFinder([front(9), tele])
    assert names(choice, at(0, 20))[0] == "front_0000"


def test_the_middle_of_an_image_is_better_than_its_edge() -> None:
    choice = ImageFinder([front(10.0), looking(Path("left.jpg"), (0.0, 10.0, 2.0), (0.7, 1, 0))])
    assert names(choice, at(7.0, 20.0))[0] == "left"


def test_a_place_at_the_very_edge_is_not_seen() -> None:
    image = front(0)
    edge = at(10 * (image.width_px / 2) / image.focal_px, 10)
    assert not names(ImageFinder([image]), edge)


def test_what_is_known_to_be_hidden_comes_last() -> None:
    choice = ImageFinder([front(0), front(10)])
    found = choice.seeing(at(0, 20), lambda number, _: True if number == 1 else None)
    assert [(one.image.path.stem, one.is_hidden) for one in found] == [
        ("front_0000", None),
        ("front_0010", True),
    ]


def test_a_place_far_from_every_image_has_a_nearest_one() -> None:
    choice = ImageFinder([front(0), front(10)])
    assert choice.seeing(at(0, 500)) == ()
    number, distance = choice.nearest_m(at(0, 500))
    assert (number, distance) == (1, pytest.approx(490.0))


def test_without_images_there_is_nothing_near() -> None:
    choice = ImageFinder([])
    assert choice.seeing(at(0, 0)) == ()
    assert choice.nearest_m(at(0, 0)) == (-1, np.inf)


def test_a_place_that_is_no_number_is_seen_by_none() -> None:
    assert ImageFinder([front(0)]).seeing(np.full(3, np.nan)) == ()


@pytest.mark.parametrize("ahead", [NORTH, EAST, SOUTH, (-1.0, -0.1, -0.3)])
def test_the_field_of_view_holds_what_the_image_shows(ahead: tuple[float, float, float]) -> None:
    image = looking(Path("a.jpg"), (0.0, 0.0, 2.0), ahead)
    field = shapely.Polygon(field_of_view(image, 30.0))
    random = np.random.default_rng(1)
    positions = START + random.uniform(-25, 25, (400, 3)) * (1, 1, 0.05) + (0, 0, 2)
    near = np.hypot(*(positions - image.xyz)[:, :2].T) < 29
    choice = ImageFinder([image])
    for position in positions[near]:
        is_seen = bool(choice.seeing(position))
        is_held = field.buffer(0.5).contains(shapely.Point(position[:2]))
        assert is_held or not is_seen


def test_a_panorama_sees_all_around() -> None:
    image = looking(Path("a.jpg"), (0.0, 0.0, 2.0), NORTH, projection="equirectangular")
    ring = field_of_view(image, 20.0)
    np.testing.assert_allclose(np.hypot(*(ring - image.xyz[:2]).T), 20.0)
