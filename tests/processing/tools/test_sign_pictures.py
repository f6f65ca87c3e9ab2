"""The picture of a sign: cut out of the camera image that shows its face, or none."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.cameras.cut_outs import Face, cut_outs
from processing.core.monitor import SilentMonitor
from processing.image.attributes.plate_points import PlatePlace, picture_of
from processing.laboratory.simulate.roadside.sign_plates import axes_of, outline
from processing.recording.camera_images.camera import Camera
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.drive import Drive
from processing.tools.running.runner import RunRequest, run
from processing.tools.signs import SignParameters
from processing.tools.tool import Candidate, CandidateResult
from tests.camera_scene import Triple, looking
from tests.processing.methods.road.bad_recordings import ORIGIN, delivered, imported
from tests.processing.tools.test_signs import (
    CIRCLE,
    DIAMOND,
    FROM_BEHIND,
    PLATES,
    TRIANGLE,
    KnownPlate,
    recording,
    shine,
)

GROUND = (90, 90, 90)
COLOURS = {one: (40 + 25 * number, 250 - 25 * number, 60) for number, one in enumerate(PLATES)}


def corners_of(plate: KnownPlate) -> NDArray[np.float64]:
    right, up, _ = axes_of(plate.hung)
    flat = outline(plate.plate)
    return np.asarray(np.array(plate.middle) + ORIGIN + flat[:, :1] * right + flat[:, 1:] * up)


def photographed(path: Path, at: Triple, ahead: Triple) -> CameraImage:
    """An image in which each plate that looks at the camera has a colour of its own."""
    import cv2

    image = looking(path, at, ahead, focal_px=900.0, size=(1600, 1200))
    image = replace(image, xyz=tuple(np.add(ORIGIN, at).tolist()))
    pixels = np.full((1200, 1600, 3), GROUND, np.uint8)
    for plate in sorted(PLATES, key=lambda one: -math.dist(one.middle, at)):
        if (np.array(at) - plate.middle) @ axes_of(plate.hung)[2] > 0:
            corners = Camera(image).pixels_of(corners_of(plate))
            if np.isfinite(corners).all():
                cv2.fillPoly(pixels, [corners.round().astype(np.int32)], COLOURS[plate])
    path.parent.mkdir(parents=True, exist_ok=True)
    _, content = cv2.imencode(".png", pixels[:, :, ::-1])
    content.tofile(path)
    return image


@pytest.fixture(scope="module")
def plain(tmp_path_factory: pytest.TempPathFactory) -> tuple[Drive, ...]:
    folder = tmp_path_factory.mktemp("street")
    request = delivered(recording(), folder)
    shine(request.inputs[0])
    return imported(folder, request)


@pytest.fixture(scope="module")
def pictured(plain: tuple[Drive, ...], tmp_path_factory: pytest.TempPathFactory) -> Drive:
    """The same drive with two images that look back along the road."""
    photos = tmp_path_factory.mktemp("photos")
    images = [
        photographed(photos / "1.png", (16.0, 0.5, 2.3), (-1.0, 0.4, 0.0)),
        photographed(photos / "2.png", (28.0, 0.5, 2.3), (-1.0, 0.4, 0.0)),
    ]
    write_images(plain[0].folder, ImageList(tuple(images)))
    return Drive(plain[0].folder)


def found_on(drive: Drive, folder: Path) -> CandidateResult:
    result = run(RunRequest("signs", drive, SignParameters()), SilentMonitor(), into=folder / "c")
    assert isinstance(result, CandidateResult)
    return result


def at_plate(result: CandidateResult, plate: KnownPlate) -> Candidate:
    place = plate.centroid + ORIGIN
    (found,) = (one for one in result.candidates if math.dist(one.xyz[0], place) < 0.2)
    return found


def test_a_sign_gets_the_picture_of_its_own_face_whole_and_with_its_surroundings(
    pictured: Drive, tmp_path: Path
) -> None:
    result = found_on(pictured, tmp_path)
    for plate in (CIRCLE, TRIANGLE, DIAMOND):
        picture = at_plate(result, plate).picture
        assert picture is not None
        is_face = (picture == COLOURS[plate]).all(axis=2)
        height, width = is_face.shape
        assert is_face[height // 2, width // 2]
        assert is_face.sum() > 200
        rim = np.concatenate([is_face[0], is_face[-1], is_face[:, 0], is_face[:, -1]])
        assert not rim.any()


def test_the_colour_of_the_face_is_told_and_nothing_of_what_is_around_it(
    pictured: Drive, tmp_path: Path
) -> None:
    assert at_plate(found_on(pictured, tmp_path), CIRCLE).attributes["colour"] == "green"


def test_a_face_that_no_camera_looks_at_has_no_picture(pictured: Drive, tmp_path: Path) -> None:
    found = at_plate(found_on(pictured, tmp_path), FROM_BEHIND)
    assert found.picture is None
    assert "colour" not in found.attributes


def test_without_a_camera_the_plate_is_painted_of_its_points(plain: tuple[Drive, ...]) -> None:
    found = at_plate(found_on(plain[0], plain[0].folder.parent / "points"), CIRCLE)
    told = {name: float(str(found.attributes[name])) for name in ("facing_deg", "tilt_deg")}
    plate = PlatePlace(found.xyz[0], **told, wide_m=0.6, high_m=0.6, turns=20)
    picture = picture_of(plain[0], int(found.points[0]), plate)
    assert picture is not None
    middle = picture.shape[0] // 2
    is_bright = picture.min(axis=2) > 150
    within = slice(middle - 20, middle + 20)
    assert is_bright[within, within].mean() > 0.8  # a few points are of the back
    assert not is_bright[:5, :5].any()


def test_a_place_where_nothing_was_measured_has_no_picture(plain: tuple[Drive, ...]) -> None:
    high_up = ORIGIN + np.array([0.0, 0.0, 40.0])
    plate = PlatePlace(high_up, 90.0, 0.0, wide_m=0.6, high_m=0.6, turns=20)
    assert picture_of(plain[0], 0, plate) is None


def test_a_face_behind_a_thing_that_was_measured_has_no_picture(pictured: Drive) -> None:
    look = np.array([1.0, 0.0, 0.0])
    flat = [(-0.2, -0.2), (0.2, -0.2), (0.2, 0.2), (-0.2, 0.2)]

    def faces(x: float) -> list[Face]:
        corners = np.array([(x, 5.75 + along, 1.0 + up) for along, up in flat])
        return [Face(corners + ORIGIN, look)]

    before, behind = 12.2, 10.6  # of a machine from 11.0 to 12.0, 1.83 m high
    assert cut_outs(faces(before), [pictured], SilentMonitor()).pictures[0] is not None
    assert cut_outs(faces(behind), [pictured], SilentMonitor()).pictures[0] is None


def test_images_that_are_gone_are_counted_and_signs_stay(plain: tuple[Drive, ...]) -> None:
    image = looking(Path("/nowhere/1.png"), (16.0, 0.5, 2.3), (-1.0, 0.4, 0.0), size=(1600, 1200))
    image = replace(image, xyz=tuple(np.add(ORIGIN, (16.0, 0.5, 2.3)).tolist()), focal_px=900.0)
    write_images(plain[0].folder, ImageList((image,)))
    result = found_on(Drive(plain[0].folder), plain[0].folder.parent)
    assert len(result.candidates) == len(PLATES)
    assert all(one.picture is None for one in result.candidates)
    assert "can't be read: 1;" in result.note.en


def test_pixels_of_images_give_their_signs_by_one_line_of_sight_or_by_two(
    pictured: Drive, tmp_path: Path
) -> None:
    assert pictured.images is not None
    images = pictured.images

    def pixel(number: int, plate: KnownPlate, sign: str) -> str:
        place = (plate.centroid + ORIGIN)[None]
        column, line = Camera(images[number]).pixels_of(place)[0].tolist()
        return f"{sign},C:\\photos\\{images[number].path.name},{column:.1f},{line:.1f},"

    rows = ["sign,image,column_px,row_px,shape", pixel(0, CIRCLE, "a"), pixel(1, CIRCLE, "a")]
    rows += [pixel(1, TRIANGLE, ""), ",9.png,800,600,", f",{images[0].path.name},800,2,"]
    table = tmp_path / "pixels.csv"
    table.write_text("\n".join(rows) + "\n", "utf-8")
    request = RunRequest("signs", pictured, SignParameters(positions=str(table)))
    result = run(request, SilentMonitor(), into=tmp_path / "c")
    assert isinstance(result, CandidateResult)
    assert len(result.candidates) == 2
    for plate in (CIRCLE, TRIANGLE):
        assert at_plate(result, plate).xyz[0] == pytest.approx(plate.centroid + ORIGIN, abs=0.03)
    assert "name images that the drives don't have: 5" in result.note.en
    assert "Nothing was measured where these lines look: 6" in result.note.en
