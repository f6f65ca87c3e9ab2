"""Points get the colours of what the photographs show, and none from what hides them."""

from __future__ import annotations

import shutil
from dataclasses import replace
from pathlib import Path

import laspy
import numpy as np
import pytest

from processing.core.errors import Cancelled, MissingInput, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.image.attributes.attributes import available, colours
from processing.project.importing.importing import ImportRequest, import_drives
from processing.project.results.point_results import write_point_results
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.tools.colour import ColourParameters
from processing.tools.running.runner import RunRequest, columns_of, run
from processing.tools.tool import FinishedColumns
from tests.builders import SimulatedDrive, simulated_drive, write_laz, write_trajectory_csv
from tests.camera_scene import SURFACE_COLOURS, looking, photograph
from tests.processing.image.recordings import drive_of

ROAD, WALL, POLE = 0, 3, 4


class RecordingMonitor(SilentMonitor):
    """Notes what is said, and stops when asked for long enough."""

    def __init__(self, stops_after: int = 10**9) -> None:
        self.texts: list[str] = []
        self._left = stops_after

    def report(self, fraction: float, text: Text | None = None) -> None:
        self.texts.extend([text.en] if text else [])

    def check(self) -> None:
        self._left -= 1
        if self._left < 0:
            raise Cancelled


def photographs(folder: Path) -> tuple[CameraImage, ...]:
    ways = {"left": (-1.0, -0.2, -0.1), "right": (1.0, 0.4, -0.1), "front": (0.0, 1.0, -0.3)}
    images = []
    for name, ahead in ways.items():
        for number, along in enumerate((1.0, 5.0)):
            path = folder / "写真" / f"{name}_{number:04d}.png"
            images.append(looking(path, (-0.5, along, 2.0), ahead, size=(600, 450)))
            photograph(images[-1])
    return tuple(images)


def with_images(drive: Drive, images: tuple[CameraImage, ...]) -> Drive:
    write_images(drive.folder, ImageList(images))
    return Drive(drive.folder)


@pytest.fixture(scope="module")
def street() -> SimulatedDrive:
    return simulated_drive(3, pulses_per_revolution=600.0, lost_share=0.0)


@pytest.fixture(scope="module")
def taken(tmp_path_factory: pytest.TempPathFactory) -> tuple[CameraImage, ...]:
    return photographs(tmp_path_factory.mktemp("taken"))


@pytest.fixture
def images(tmp_path: Path, taken: tuple[CameraImage, ...]) -> tuple[CameraImage, ...]:
    """Give photographs that may be damaged."""
    folder = shutil.copytree(taken[0].path.parent, tmp_path / "写真")
    return tuple(replace(image, path=folder / image.path.name) for image in taken)


@pytest.fixture
def drive(tmp_path: Path, street: SimulatedDrive, images: tuple[CameraImage, ...]) -> Drive:
    return with_images(drive_of(street, tmp_path / "d"), images)


def found_by(request: RunRequest, **more: int) -> dict[str, np.ndarray]:
    """The columns of a run, read; its folder is gone."""
    found = run(request, SilentMonitor(), into=request.drive.folder.parent / "found", **more)
    assert isinstance(found, FinishedColumns)
    columns = {name: np.array(values) for name, values in columns_of(found).items()}
    found.remove()
    return columns


def coloured(drive: Drive, **parameters: object) -> dict[str, np.ndarray]:
    request = RunRequest("colour", drive, ColourParameters(**parameters))  # type: ignore[arg-type]
    return found_by(request)


def share_right(found: dict[str, np.ndarray], street: SimulatedDrive, surface: int) -> float:
    chosen = (found["is_seen"] > 0) & (street.surface == surface)
    assert chosen.sum() > 50
    return float((found["seen_color"][chosen] == SURFACE_COLOURS[surface]).all(axis=1).mean())


def test_points_have_the_colour_of_their_own_surface(drive: Drive, street: SimulatedDrive) -> None:
    found = coloured(drive)
    for surface, least in ((ROAD, 0.95), (WALL, 0.95), (POLE, 0.85)):
        assert share_right(found, street, surface) > least
    assert (found["seen_color"][found["is_seen"] == 0] == 0).all()


def test_walls_behind_poles_dont_get_the_colour_of_poles(
    drive: Drive, street: SimulatedDrive
) -> None:
    assert drive.images is not None
    drive = with_images(drive, drive.images.images[:1])
    pole = SURFACE_COLOURS[POLE]
    walls = street.surface == WALL

    def wrong(found: dict[str, np.ndarray]) -> int:
        return int((found["seen_color"][walls] == pole).all(axis=1).sum())

    unregarded = wrong(coloured(drive, regards_hidden=False))
    assert unregarded > 30
    # The side of the pole that no beam met hides nothing.
    assert wrong(coloured(drive)) < 0.5 * unregarded


def test_far_points_are_left_uncoloured(drive: Drive) -> None:
    seen = [int(coloured(drive, reach_m=reach)["is_seen"].sum()) for reach in (4.0, 40.0)]
    assert 0 < seen[0] < seen[1]


def test_many_blocks_give_the_same_colours_as_one(drive: Drive) -> None:
    request = RunRequest("colour", drive, ColourParameters())
    whole = found_by(request)
    cut = found_by(request, points_per_block=5_000)
    same = (whole["seen_color"] == cut["seen_color"]).all(axis=1)
    assert same.all()


def test_it_can_be_cancelled_between_images(drive: Drive) -> None:
    into = drive.folder.parent / "found"
    with pytest.raises(Cancelled):
        run(
            RunRequest("colour", drive, ColourParameters()),
            RecordingMonitor(stops_after=6),
            into=into,
        )
    assert not into.exists()


def test_missing_images_are_told_and_the_others_used(drive: Drive) -> None:
    assert drive.images is not None
    for image in drive.images.images[:3]:
        image.path.unlink()
    told = RecordingMonitor()
    request = RunRequest("colour", drive, ColourParameters())
    found = columns_of(run(request, told, into=drive.folder.parent / "found"))
    assert any("3 of 6 camera images are missing" in text for text in told.texts)
    assert found["is_seen"].any()


def test_damaged_images_are_left_out(drive: Drive) -> None:
    assert drive.images is not None
    drive.images[0].path.write_bytes(b"no image")
    assert coloured(drive)["is_seen"].any()
    for image in drive.images:
        image.path.write_bytes(b"no image")
    with pytest.raises(MissingInput, match="6 camera images can be read"):
        coloured(drive)


def test_without_one_image_left_nothing_is_done(drive: Drive) -> None:
    assert drive.images is not None
    for image in drive.images:
        image.path.unlink()
    with pytest.raises(MissingInput, match="None of the 6"):
        coloured(drive)


def test_images_of_another_reference_system_are_refused(drive: Drive) -> None:
    assert drive.images is not None
    far = tuple(replace(image, xyz=(389_000.0, 3_947_000.0, 30.0)) for image in drive.images)
    with pytest.raises(Unsuitable, match="reference system"):
        coloured(with_images(drive, far))


def test_seen_colours_are_shown_before_delivered_ones(
    tmp_path: Path, street: SimulatedDrive, images: tuple[CameraImage, ...]
) -> None:
    delivered = np.full((street.count, 3), 200 << 8, np.uint16)
    delivered[0] = 65535
    drive = with_images(drive_of(street, tmp_path / "d", color=delivered), images)
    found = coloured(drive)
    for name, values in found.items():
        drive.columns.add(name, values)
    assert "color" in available(drive)
    points = np.arange(drive.count)
    shown = colours(drive, points, "color", 2, 98)
    seen = found["is_seen"] > 0
    np.testing.assert_array_equal(shown[seen], found["seen_color"][seen])
    assert (shown[~seen][1:] == 200).all()


@pytest.mark.parametrize("has_delivered", [False, True])
def test_the_output_has_the_colours_where_las_keeps_them(
    tmp_path: Path, has_delivered: bool
) -> None:
    street = simulated_drive(3, length_m=3.0)
    source = write_laz(street, tmp_path / "street.laz")
    if has_delivered:
        cloud = laspy.convert(laspy.read(source), point_format_id=7)
        cloud.red = cloud.green = cloud.blue = np.full(street.count, 1234, np.uint16)
        cloud.write(source)
    trajectory = write_trajectory_csv(street, tmp_path / "trajectory.csv")
    request = ImportRequest((source,), (trajectory,))
    (folder,) = import_drives(request, tmp_path / "drives", SilentMonitor())
    drive = Drive(folder)
    seen = np.arange(drive.count) % 3 == 0
    color = np.where(seen[:, None], [[255, 16, 0]], 0).astype(np.uint8)
    (tmp_path / "found").mkdir()
    with ColumnWriter(tmp_path / "found") as writer:
        writer.append({"seen_color": color, "is_seen": seen})
    result = FinishedColumns(tmp_path / "found", ("seen_color", "is_seen"), drive.count)
    (output,) = write_point_results([(drive, result)], tmp_path / "out.laz", SilentMonitor())
    before, after = laspy.read(source), laspy.read(output)
    assert after.header.point_format.id == 7
    np.testing.assert_array_equal(after.xyz, before.xyz)
    np.testing.assert_array_equal(after.gps_time, before.gps_time)
    is_seen = np.asarray(after.is_seen) > 0
    assert is_seen.sum() == seen.sum()
    rest = 1234 if has_delivered else 0
    np.testing.assert_array_equal(after.red, np.where(is_seen, 65535, rest))
    np.testing.assert_array_equal(after.green, np.where(is_seen, 16 * 257, rest))
    np.testing.assert_array_equal(after.blue, np.where(is_seen, 0, rest))
