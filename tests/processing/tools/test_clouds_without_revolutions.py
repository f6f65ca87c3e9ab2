"""Normals and segments on clouds without revolutions: neighbours in the picture are true ones."""

from dataclasses import replace

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.image.search.nearest import nearest_point
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from processing.tools.listed.registry import TOOLS
from processing.tools.running.runner import RunRequest, check_needs, columns_of, run
from processing.tools.tool import Needs
from tests.structured_scans import ptx_text, sphere_scan

RANDOM = np.random.default_rng(7)


def _drive(tmp_path, name: str, text: str) -> Drive:
    path = tmp_path / name
    path.write_text(text)
    (folder,) = import_drives(ImportRequest((path,)), tmp_path / "made", SilentMonitor())
    return Drive(folder)


def _run(drive: Drive, tool: str, into) -> dict[str, np.ndarray]:
    request = RunRequest(tool, drive, TOOLS[tool].parameters())
    result = run(request, SilentMonitor(), into=into / tool)
    return {name: np.array(values) for name, values in columns_of(result).items()}


def _text(*columns) -> str:
    rows = np.column_stack(columns).tolist()
    return "\n".join([" ".join(f"{value:.4f}" for value in row) for row in rows] + [""])


@pytest.mark.parametrize("is_placed", [True, False])
def test_normals_of_a_sphere_seen_from_inside_point_to_its_middle(tmp_path, is_placed):
    scan = sphere_scan(200, 120)
    text = "x y z column row\n" + _text(scan.xyz, scan.cells)
    name, text = ("room.ptx", ptx_text(scan)) if is_placed else ("room.txt", text)
    drive = _drive(tmp_path, name, text)
    assert drive.image_kinds == (ImageKind.SCAN,)
    assert (drive.info.scanner_position is not None) == is_placed
    normals = _run(drive, "normals", tmp_path)["normal"] / 127.0
    wanted = scan.centre - drive.xyz(slice(None))
    wanted /= np.linalg.norm(wanted, axis=1, keepdims=True)
    has_one = normals.any(axis=1)
    assert has_one.mean() > 0.99
    cosines = np.einsum("ij,ij->i", normals, wanted)[has_one]
    assert np.percentile(cosines, 2) > 0.98


def test_segments_of_a_scan_end_where_the_distance_jumps(tmp_path):
    scan = sphere_scan(200, 120)
    is_near = (scan.cells[:, 0] > 50) & (scan.cells[:, 0] < 100) & (scan.cells[:, 1] > 40)
    near = scan.position + (scan.xyz - scan.position) * np.where(is_near, 0.4, 1.0)[:, None]
    text = "x y z column row\n" + _text(near, scan.cells)
    drive = _drive(tmp_path, "room.txt", text)
    segments = _run(drive, "segments", tmp_path)["segment"]
    inside, outside = segments[is_near], segments[~is_near]
    assert np.bincount(inside).max() > 0.95 * inside.size
    assert np.bincount(outside).max() > 0.95 * outside.size
    assert not set(np.unique(inside)) & set(np.unique(outside))


def test_normals_and_segments_from_above_are_those_of_two_plates(tmp_path):
    plan = RANDOM.uniform([0, 0], [12.0, 8.0], (60_000, 2))
    is_roof = plan[:, 0] > 6.0
    heights = np.where(is_roof, 3.0 + 0.2 * plan[:, 1], 0.0)
    drive = _drive(tmp_path, "site.xyz", _text(plan, heights))
    assert drive.image_kinds == (ImageKind.TOP_VIEW,)
    is_roof = drive.xyz(slice(None))[:, 2] > 2.0
    normals = _run(drive, "normals", tmp_path)["normal"] / 127.0
    slope = np.array([0.0, -0.2, 1.0]) / np.hypot(0.2, 1.0)
    assert np.percentile(normals[~is_roof, 2], 1) > 0.99
    assert np.percentile(normals[is_roof] @ slope, 1) > 0.99
    segments = _run(drive, "segments", tmp_path)["segment"]
    inside, outside = segments[is_roof], segments[~is_roof]
    assert np.bincount(inside).max() > 0.9 * inside.size
    assert np.bincount(outside).max() > 0.9 * outside.size
    assert inside[np.bincount(inside).argmax()] != outside[0]


CLOUDS = {
    "one point": np.array([[5.0, 6.0, 7.0]]),
    "two points": np.array([[5.0, 6.0, 7.0], [105.0, 6.0, 7.0]]),
    "one place": np.full((500, 3), 3.25),
    "a wall": RANDOM.uniform([0, 5, 0], [10.0, 5.0, 3.0], (5_000, 3)),
    "a pole": RANDOM.uniform([1, 5, 0], [1.0, 5.0, 9.0], (500, 3)),
    "no numbers": np.where(RANDOM.random((400, 1)) < 0.2, np.nan, RANDOM.random((400, 3))),
    "far apart": np.concatenate([RANDOM.random((300, 3)), 1e6 + RANDOM.random((300, 3))]),
}


@pytest.mark.parametrize("name", CLOUDS)
def test_odd_clouds_have_a_picture_and_go_through_tools(tmp_path, name):
    xyz = CLOUDS[name]
    drive = _drive(tmp_path, "odd.xyz", _text(xyz))
    good = xyz[np.isfinite(xyz).all(axis=1)]
    assert drive.count == good.shape[0]
    image = image_of(drive, ImageKind.TOP_VIEW)
    rows, columns = image.pixel_of(np.arange(drive.count))
    assert rows.max() < image.rows
    assert columns.max() < image.width
    found = [image.points_at(int(r), int(c)) for r, c in zip(rows[:50], columns[:50], strict=True)]
    assert all(point in points for point, points in enumerate(found))
    assert nearest_point(drive, good[0], 0.01) >= 0
    assert _run(drive, "normals", tmp_path)["normal"].shape == (drive.count, 3)
    assert _run(drive, "segments", tmp_path)["segment"].shape == (drive.count,)


def test_a_tool_that_needs_revolutions_says_why_a_scan_has_none(tmp_path):
    drive = _drive(tmp_path, "room.ptx", ptx_text(sphere_scan()))
    needy = replace(TOOLS["normals"], needs=Needs.REVOLUTIONS)
    with pytest.raises(Unsuitable) as refused:
        check_needs(needy, drive)
    assert "The scanner stood still" in refused.value.remedy.en
