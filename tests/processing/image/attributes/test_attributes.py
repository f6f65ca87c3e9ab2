"""What pixels show: the eight attributes, and colours that every eye can tell apart."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile, MissingInput, Unsuitable
from processing.image.attributes import attributes as attributes_module
from processing.image.attributes.attributes import (
    ATTRIBUTES,
    available,
    colours,
    most_telling_attribute,
)
from processing.image.attributes.colour_maps import (
    EMPTY_COLOUR,
    SHAPE_COLOURS,
    UNKNOWN_COLOUR,
    class_colours,
    grey_ramp,
    height_ramp,
    normal_ramp,
    segment_colours,
    stretch_values,
)
from processing.image.attributes.waveform_values import WAVEFORM_ATTRIBUTES
from processing.image.images_of_drives import image_of
from processing.recording.camera_images.colouring import colours_from_images
from processing.recording.camera_images.image_list import CameraImage, ImageList
from processing.recording.camera_images.image_store import write_images
from processing.recording.columns.classes import point_classes, read_classes
from processing.recording.columns.point_features import POINT_FEATURES
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.builders import simulated_drive
from tests.processing.image.recordings import drive_of, small_drive


@pytest.fixture
def drive(tmp_path: Path) -> Drive:
    return small_drive(tmp_path / "d")[0]


def shown(drive: Drive, attribute: str) -> tuple[NDArray[np.int64], NDArray[np.uint8]]:
    image = image_of(drive, ImageKind.TRAJECTORY_CENTER)
    points = image.raster(range(image.rows), range(image.width))
    return points, colours(drive, points, attribute, 2.0, 98.0)


def lightness(rgb: NDArray[np.uint8]) -> NDArray[np.float64]:
    """CIE L*."""
    linear = np.where(rgb / 255 <= 0.04045, rgb / 255 / 12.92, ((rgb / 255 + 0.055) / 1.055) ** 2.4)
    y = linear @ np.array([0.2126, 0.7152, 0.0722])
    return np.asarray(np.where(y > 0.008856, 116 * np.cbrt(y) - 16, 903.3 * y))


def test_the_attributes_of_the_contract_are_there_and_what_an_evaluation_shows() -> None:
    toned = ["intensity", "toned", "height", "relief"]
    wanted = [*toned, "normal", "shape", "segment", "color", "label", "class"]
    more = ["confidence", "judged", *POINT_FEATURES, *WAVEFORM_ATTRIBUTES]
    assert list(ATTRIBUTES) == [*wanted, *more]
    for attribute in ATTRIBUTES.values():
        assert attribute.title.en
        assert attribute.title.ja


@pytest.mark.parametrize("attribute", ["intensity", "height", "normal", "shape", "class"])
def test_empty_pixels_are_deep_blue_and_no_point_is(drive: Drive, attribute: str) -> None:
    points, pixels = shown(drive, attribute)
    assert pixels.shape == (*points.shape, 3)
    assert (points < 0).any()
    assert (pixels[points < 0] == EMPTY_COLOUR).all()
    assert not (pixels[points >= 0] == EMPTY_COLOUR).all(axis=1).any()


def test_doubt_is_orange_what_is_sure_light_and_what_nobody_asked_grey(drive: Drive) -> None:
    with pytest.raises(Unsuitable, match="Confidence of the class"):
        shown(drive, "confidence")
    drive.columns.add("confidence", np.linspace(0.0, 1.0, drive.count, dtype=np.float32))
    points, pixels = shown(drive, "confidence")
    sure = drive.columns["confidence"][points[points >= 0]]
    found = pixels[points >= 0].astype(int)
    assert (found[sure == 0] == UNKNOWN_COLOUR).all()
    assert (np.diff(lightness(found[np.argsort(sure)][1:])) > -1.5).all()
    assert (found[sure > 0.98] > 220).all()
    assert np.ptp(found[(sure > 0) & (sure < 0.1)], axis=1).min() > 150


def test_intensity_is_grey_between_its_percentiles(drive: Drive) -> None:
    points, pixels = shown(drive, "intensity")
    grey = pixels[points >= 0]
    values = drive.columns["intensity"][points[points >= 0]].astype(float)
    low, high = np.percentile(drive.columns["intensity"], [2, 98])
    assert (grey[:, 0] == grey[:, 1]).all()
    assert (grey[:, 0] == grey[:, 2]).all()
    wanted = np.clip((values - low) / (high - low) * 256, 0, 255).astype(int)
    np.testing.assert_allclose(grey[:, 0].astype(int), wanted, atol=1)


@pytest.mark.parametrize(
    ("intensity", "color", "shown"),
    [("varied", "varied", "intensity"), ("same", "varied", "color"), ("same", "same", "height")],
)
def test_what_tells_something_is_shown_first(
    tmp_path: Path, intensity: str, color: str, shown: str
) -> None:
    drive, _ = small_drive(tmp_path / "d")
    varied = np.arange(drive.count) % 200
    drive.columns.add("intensity", varied if intensity == "varied" else np.zeros(drive.count))
    drive.columns.add("color", np.zeros((drive.count, 3)) + (varied[:, None], 0)[color == "same"])
    assert most_telling_attribute(drive, "intensity") == shown
    assert most_telling_attribute(drive, "normal") == "normal"


def test_a_drive_without_classes_is_not_shown_by_class(drive: Drive) -> None:
    assert "class" not in available(drive)
    assert most_telling_attribute(drive, "class") == "intensity"
    drive.columns.add("label", np.full(drive.count, 2, np.uint8))
    assert "class" in available(drive)
    assert most_telling_attribute(drive, "class") == "class"


@pytest.mark.parametrize(("code", "shown"), [(0, "intensity"), (1, "intensity"), (2, "class")])
def test_delivered_classes_above_1_are_classes(tmp_path: Path, code: int, shown: str) -> None:
    drive, _ = small_drive(tmp_path / "d")
    classes = np.zeros(drive.count, np.uint8)
    classes[-1] = code
    drive.columns.add("classification", classes)
    assert most_telling_attribute(drive, "class") == shown


def test_walls_are_blue_and_the_road_is_red_by_normal(tmp_path: Path) -> None:
    drive, street = small_drive(tmp_path / "d")
    everything = np.arange(drive.count)
    pixels = colours(drive, everything, "normal", 2.0, 98.0).astype(int)
    wall, road = pixels[street.surface == 3], pixels[street.surface == 0]
    assert np.median(wall[:, 2] - wall[:, 0]) > 100
    assert np.median(road[:, 0] - road[:, 2]) > 100


def test_planes_are_blue_by_shape(tmp_path: Path) -> None:
    drive, street = small_drive(tmp_path / "d")
    pixels = colours(drive, np.flatnonzero(street.surface == 0), "shape", 2.0, 98.0)
    assert np.median(pixels[:, 2].astype(int) - pixels[:, 0]) > 40


def test_results_of_tools_are_shown_where_they_are_stored(drive: Drive) -> None:
    count = drive.count
    drive.columns.add("normal", np.tile(np.array([0, 0, -127], np.int8), (count, 1)))
    drive.columns.add("shape", np.tile(np.array([0, 0, 255], np.uint8), (count, 1)))
    drive.columns.add("segment", np.arange(count, dtype=np.int32) % 5)
    drive.columns.add("label", np.full(count, 67, np.uint8))
    points = np.arange(10)
    assert (colours(drive, points, "normal", 2, 98) == normal_ramp()[255]).all()
    assert (colours(drive, points, "shape", 2, 98) == SHAPE_COLOURS[2]).all()
    assert len(np.unique(colours(drive, points, "segment", 2, 98), axis=0)) == 5
    assert (colours(drive, points, "label", 2, 98) == class_colours()[67]).all()
    assert "segment" in available(drive)


def test_what_is_missing_is_said_with_what_to_do(drive: Drive) -> None:
    assert available(drive) == (
        "intensity",
        "toned",
        "height",
        "relief",
        "normal",
        "shape",
        "label",
    )
    for attribute in ("segment", "color"):
        with pytest.raises(Unsuitable) as refusal:
            colours(drive, np.array([0]), attribute, 2, 98)
        assert refusal.value.where.en == drive.info.name
        assert refusal.value.remedy.ja
    with pytest.raises(KeyError):
        colours(drive, np.array([0]), "smell", 2, 98)


def test_points_without_a_label_show_the_street_in_grey_below_the_labels(drive: Drive) -> None:
    points = np.arange(100)
    grey = colours(drive, points, "intensity", 2, 98)[:, 0].astype(int)
    without = colours(drive, points, "label", 2, 98)
    assert (without == without[:, :1]).all()
    assert (np.diff(without[np.argsort(grey), 0].astype(int)) >= 0).all()
    blackest = min(class_colours()[one.code].max() for one in point_classes())
    assert blackest < without.min() < without.max() < 206
    labels = np.zeros(drive.count, np.uint8)
    labels[:50:2] = 6
    drive.columns.add("label", labels)
    shown = colours(drive, points, "label", 2, 98)
    assert (shown[:50:2] == class_colours()[6]).all()
    assert (shown[1:50:2] == without[1:50:2]).all()
    assert (shown[50:] == without[50:]).all()


@pytest.mark.parametrize("bits", [8, 16])
def test_delivered_colours_are_shown_whether_8_or_16_bits_are_used(
    tmp_path: Path, bits: int
) -> None:
    street = simulated_drive(1, length_m=2.0)
    color = np.zeros((street.count, 3), np.uint16)
    color[:, 0] = 200 << (bits - 8)
    color[0] = 255 << (bits - 8)
    drive = drive_of(street, tmp_path / "d", color=color)
    assert (colours(drive, np.arange(1, 5), "color", 2, 98) == (200, 0, 0)).all()


def camera_image(path: Path, **changes: object) -> CameraImage:
    """Looking down from 10 m: 100 × 100 px over 10 m × 10 m."""
    values: dict[str, object] = {
        "path": path,
        "time_s": 100.0,
        "xyz": (0.0, 0.0, 10.0),
        "omega_deg": 0.0,
        "phi_deg": 0.0,
        "kappa_deg": 0.0,
        "focal_px": 100.0,
        "cx_px": 50.0,
        "cy_px": 50.0,
        "width_px": 100,
        "height_px": 100,
        **changes,
    }
    return CameraImage(**values)  # type: ignore[arg-type]


def painted(path: Path, left: tuple[int, int, int], right: tuple[int, int, int]) -> Path:
    """An image file whose halves have these red, green, blue."""
    import cv2

    pixels = np.zeros((100, 100, 3), np.uint8)
    pixels[:, :50], pixels[:, 50:] = left[::-1], right[::-1]
    path.write_bytes(cv2.imencode(".png", pixels)[1].tobytes())
    return path


def test_points_get_the_colour_of_the_pixel_they_fall_in(tmp_path: Path) -> None:
    path = painted(tmp_path / "画像.png", (200, 10, 20), (0, 90, 255))
    xyz = np.array([[-3.0, 0, 0], [3.0, 0, 0], [30.0, 0, 0], [0, 0, 20.0]])
    seen = colours_from_images(xyz, np.full(4, 100.0), ImageList((camera_image(path),)))
    assert seen.colours[:2].tolist() == [[200, 10, 20], [0, 90, 255]]
    assert seen.is_seen.tolist() == [True, True, False, False]


def test_the_nearest_image_of_the_same_time_is_used(tmp_path: Path) -> None:
    near = camera_image(painted(tmp_path / "near.png", (10, 0, 0), (10, 0, 0)))
    far = camera_image(painted(tmp_path / "far.png", (20, 0, 0), (20, 0, 0)), xyz=(0.0, 0.0, 30.0))
    later = camera_image(
        painted(tmp_path / "later.png", (30, 0, 0), (30, 0, 0)), time_s=500.0, xyz=(0.0, 0.0, 5.0)
    )
    images = ImageList((far, later, near))
    times = np.array([100.0, 501.0, np.nan])
    seen = colours_from_images(np.zeros((3, 3)), times, images)
    assert seen.colours[:, 0].tolist() == [10, 30, 30]


def test_an_image_that_is_missing_on_this_machine_leaves_points_unseen(tmp_path: Path) -> None:
    damaged = tmp_path / "damaged.jpg"
    damaged.write_bytes(b"no image")
    for path in (tmp_path / "gone.jpg", damaged):
        images = ImageList((camera_image(path),))
        seen = colours_from_images(np.zeros((1, 3)), np.array([100.0]), images)
        assert not seen.is_seen.any()


def test_a_drive_with_images_is_shown_in_colour(tmp_path: Path) -> None:
    drive, street = small_drive(tmp_path / "d")
    middle = street.trajectory.xyz[street.trajectory.time.size // 2]
    image = camera_image(
        painted(tmp_path / "a.png", (1, 2, 3), (1, 2, 3)),
        time_s=float(street.columns["time"][0]),
        xyz=(float(middle[0]), float(middle[1]), float(middle[2]) + 5),
    )
    write_images(drive.folder, ImageList((image,)))
    reopened = Drive(drive.folder)
    assert "color" in available(reopened)
    pixels = colours(reopened, np.arange(drive.count), "color", 2, 98)
    found = {tuple(colour) for colour in np.unique(pixels, axis=0).tolist()}
    assert found == {(1, 2, 3), UNKNOWN_COLOUR}


def test_ramps_rise_evenly_in_lightness_and_height_goes_in_steps() -> None:
    steps = np.unique(height_ramp(), axis=0)
    assert 16 <= len(steps) <= 32
    rising = np.diff(lightness(height_ramp()))
    assert (rising >= -1e-9).all()
    taken = rising[rising > 1e-9]
    assert taken.max() < 2.5 * taken.min()
    assert (np.diff(lightness(grey_ramp())) > 0).all()


def test_numbers_are_stretched_and_clipped() -> None:
    values = np.array([-5.0, 0.0, 5.0, 10.0, 99.0])
    assert stretch_values(values, 0.0, 10.0).tolist() == [0, 0, 128, 255, 255]
    assert stretch_values(np.array([2.0, 3.0, 4.0]), 3.0, 3.0).tolist() == [0, 128, 255]


def test_segments_keep_their_colours_and_neighbours_differ() -> None:
    numbers = np.arange(-1, 400, dtype=np.int32)
    first = segment_colours(numbers)
    assert (first == segment_colours(numbers)).all()
    assert tuple(first[0]) == UNKNOWN_COLOUR
    steps = np.abs(np.diff(first[1:].astype(int), axis=0)).sum(axis=1)
    assert steps.min() > 40
    assert (np.abs(first.astype(int) - EMPTY_COLOUR).sum(axis=1) > 60).all()


# Linear transforms of linear RGB that show what two kinds of colour-blind eyes see
# (Viénot, Brettel and Mollon 1999).
_BLIND = {
    "protan": np.array([[0.1124, 0.8876, 0.0], [0.1124, 0.8876, 0.0], [0.004, -0.004, 1.0]]),
    "deutan": np.array([[0.2927, 0.7073, 0.0], [0.2927, 0.7073, 0.0], [-0.0223, 0.0223, 1.0]]),
}


@pytest.mark.parametrize("eye", ["normal", "protan", "deutan"])
def test_classes_differ_for_every_eye(eye: str) -> None:
    rgb = np.array([one.rgb for one in point_classes()] + [EMPTY_COLOUR]) / 255
    linear = np.where(rgb <= 0.04045, rgb / 12.92, ((rgb + 0.055) / 1.055) ** 2.4)
    linear = np.clip(linear @ _BLIND[eye].T if eye in _BLIND else linear, 0, 1)
    lab = oklab(linear)
    apart = np.linalg.norm(lab[:, None] - lab[None], axis=2) + np.eye(len(lab))
    # 0.02 in Oklab is about what one can just tell side by side.
    assert apart.min() > 0.06


def oklab(linear: NDArray[np.float64]) -> NDArray[np.float64]:
    cone = np.array(
        [
            [0.4122214708, 0.5363325363, 0.0514459929],
            [0.2119034982, 0.6806995451, 0.1073969566],
            [0.0883024619, 0.2817188376, 0.6299787005],
        ]
    )
    mixed = np.array(
        [
            [0.2104542553, 0.7936177850, -0.0040720468],
            [1.9779984951, -2.4285922050, 0.4505937099],
            [0.0259040371, 0.7827717662, -0.8086757660],
        ]
    )
    return np.asarray(np.cbrt(linear @ cone.T) @ mixed.T)


def test_every_class_of_the_contract_has_names_and_a_colour() -> None:
    codes = [one.code for one in point_classes()]
    assert set(codes) >= {1, 2, 3, 4, 5, 6, 7, 11, 14, 15, 18, 64, 65, 66, 67}
    assert all(one.name.en and one.name.ja for one in point_classes())
    assert len({one.name.ja for one in point_classes()}) == len(codes)
    assert tuple(class_colours()[200]) == UNKNOWN_COLOUR


@pytest.mark.parametrize(
    "text",
    [
        "[[class]\n",
        "class = 3",
        "[[class]]\ncode = 300\nname = { en = 'a', ja = 'b' }\ncolour = '#000000'",
        "[[class]]\ncode = 3\nname = { en = 'a' }\ncolour = '#000000'",
        "[[class]]\ncode = 3\nname = { en = 'a', ja = 'b' }\ncolour = 'red'",
        "[[class]]\ncode = 3\nname = { en = 'a', ja = 'b' }\ncolour = '#000000'\n" * 2,
    ],
)
def test_a_damaged_class_table_is_refused(tmp_path: Path, text: str) -> None:
    path = tmp_path / "classes.toml"
    path.write_text(text, encoding="utf-8")
    with pytest.raises(BadFile):
        read_classes(path)


def test_a_missing_class_table_is_named(tmp_path: Path) -> None:
    with pytest.raises(MissingInput):
        read_classes(tmp_path / "none.toml")


def test_classes_of_a_long_recording_are_met_wherever_they_are(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("processing.image.attributes.attributes._CHUNK_POINTS", 1000)
    monkeypatch.setattr("processing.image.attributes.attributes._CLASS_PIECE_POINTS", 64)
    codes = np.ones(200_000, np.uint8)
    for name, chosen in (
        ("none", slice(0, 0)),
        ("end", slice(-500, None)),
        ("rare", slice(0, None, 97)),
    ):
        folder = tmp_path / name
        folder.mkdir()
        some = codes.copy()
        some[chosen] = 2
        some.tofile(folder / "classification.bin")
        assert attributes_module._has_classes(folder, some.size) is (name != "none")
