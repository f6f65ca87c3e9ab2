"""Images are read as large as wanted; what is not the listed image is refused."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, MissingInput
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_pixels import read_pixels
from processing.recording.camera_images.image_remarks import far_away, outside_trajectory
from tests.builders import START, simulated_drive
from tests.camera_scene import looking


def written(path: Path, size: tuple[int, int], ending: str, flags: tuple[int, ...] = ()) -> Path:
    """A picture whose left half is red and whose right half is blue."""
    import cv2

    pixels = np.zeros((size[1], size[0], 3), np.uint8)
    pixels[:, : size[0] // 2, 2] = 255
    pixels[:, size[0] // 2 :, 0] = 255
    path.parent.mkdir(parents=True, exist_ok=True)
    _, content = cv2.imencode(ending, pixels, flags)
    content.tofile(path)
    return path


def listed(path: Path, size: tuple[int, int]) -> CameraImage:
    return looking(path, (0.0, 0.0, 2.0), (0.0, 1.0, 0.0), size=size)


@pytest.mark.parametrize("ending", [".jpg", ".png", ".bmp"])
def test_a_picture_with_a_japanese_name_is_read_as_it_is(tmp_path: Path, ending: str) -> None:
    path = written(tmp_path / "写真　その１" / f"前方{ending}", (80, 60), ending)
    found = read_pixels(listed(path, (80, 60)))
    assert found.pixels.shape == (60, 80, 3)
    assert found.note is None
    colours = found.colours_at(np.array([[38.0, 30.0], [41.0, 30.0], [79.4, -0.4]]))
    assert (colours[0] > (200, -1, -1)).all()
    assert colours[1, 2] > 200
    assert colours[2, 2] > 200


def test_large_pictures_are_read_coarser_and_say_so(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jpg", (800, 600), ".jpg")
    found = read_pixels(listed(path, (800, 600)), most_pixels=40_000)
    assert found.pixels.shape == (150, 200, 3)
    assert found.note is not None
    assert "1/4" in found.note.en
    assert found.colours_at(np.array([[700.0, 300.0]]))[0, 2] > 200


def test_a_smaller_copy_is_used_and_said_to_be_scaled(tmp_path: Path) -> None:
    path = written(tmp_path / "a.jpg", (400, 300), ".jpg")
    found = read_pixels(listed(path, (800, 600)))
    assert found.scale == (2.0, 2.0)
    assert found.note is not None
    assert "400 × 300" in found.note.ja
    assert found.colours_at(np.array([[780.0, 10.0]]))[0, 2] > 200


@pytest.mark.parametrize("ending", [".jpg", ".png", ".bmp"])
def test_a_picture_of_another_shape_is_refused(tmp_path: Path, ending: str) -> None:
    path = written(tmp_path / f"a{ending}", (300, 400), ending)
    with pytest.raises(BadFile, match="300 × 400 pixels where the list says 800 × 600"):
        read_pixels(listed(path, (800, 600)))


def test_missing_and_damaged_pictures_say_which(tmp_path: Path) -> None:
    with pytest.raises(MissingInput, match=r"none\.jpg"):
        read_pixels(listed(tmp_path / "none.jpg", (80, 60)))
    for content in (b"", b"no picture", b"\xff\xd8\xff\xff\xff\xff\xff\xff\xff\xff\xff"):
        path = tmp_path / "bad.jpg"
        path.write_bytes(content)
        with pytest.raises(BadFile, match=r"bad\.jpg"):
            read_pixels(listed(path, (80, 60)))


def test_four_hundred_megapixels_that_can_only_be_read_whole_are_refused_unread(
    tmp_path: Path,
) -> None:
    path = written(tmp_path / "a.png", (80, 60), ".png")
    content = bytearray(path.read_bytes())
    content[16:24] = (20_000).to_bytes(4, "big") * 2
    path.write_bytes(content)
    with pytest.raises(BadFile, match="400 megapixels"):
        read_pixels(listed(path, (20_000, 20_000)))


def test_images_in_another_reference_system_are_noticed() -> None:
    image = listed(Path("a.jpg"), (80, 60))
    low, high = START - 20, START + 20
    assert far_away(ImageList((image,)), low, high) is None
    assert far_away(ImageList(()), low, high) is None
    away = replace(image, xyz=(389_000.0, 3_947_000.0, 30.0))
    remark = far_away(ImageList((away,)), low, high)
    assert remark is not None
    assert "reference system" in remark.en
    assert far_away(ImageList((away, image)), low, high) is None


def test_images_after_the_end_of_the_trajectory_are_counted() -> None:
    road = simulated_drive(1, length_m=2.0).trajectory
    image = replace(listed(Path("a.jpg"), (80, 60)), time_s=float(road.time[5]))
    late = replace(image, time_s=float(road.time[-1]) + 3)
    assert outside_trajectory(ImageList((image,)), road) is None
    assert outside_trajectory(ImageList((image,)), None) is None
    remark = outside_trajectory(ImageList((image, late, late)), road)
    assert remark is not None
    assert remark.en.startswith("2 of 3")
