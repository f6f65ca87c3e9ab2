"""A structured scan is imported as a drive whose image is the scan's own grid."""

import numpy as np
import pytest

from processing.core.errors import Unsuitable
from processing.core.monitor import SilentMonitor
from processing.image.images_of_drives import image_of
from processing.project.importing.importing import ImportRequest, import_drives
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.structured_scans import ptx_text, sphere_scan, write_e57


def _imported(tmp_path, *paths):
    folders = import_drives(ImportRequest(paths), tmp_path / "made", SilentMonitor())
    return [Drive(folder) for folder in folders]


def _cells(drive):
    rows, columns = image_of(drive, ImageKind.SCAN).pixel_of(np.arange(drive.count))
    return np.column_stack([rows, columns])


@pytest.mark.parametrize("suffix", ["ptx", "e57"])
def test_a_pixel_of_the_scan_image_is_a_cell_of_the_grid(tmp_path, suffix):
    scan, path = sphere_scan(), tmp_path / f"room.{suffix}"
    if suffix == "ptx":
        path.write_text(ptx_text(scan))
    else:
        write_e57(path, scan)
    (drive,) = _imported(tmp_path, path)
    image = image_of(drive, ImageKind.SCAN)
    assert drive.image_kinds == (ImageKind.SCAN,)
    assert (image.rows, image.width) == scan.shape
    assert np.array_equal(_cells(drive), scan.cells)
    assert np.allclose(drive.xyz(slice(None)), scan.xyz, atol=2e-4)
    empty = image.raster(range(image.rows), range(image.width)) < 0
    assert empty.sum() == scan.shape[0] * scan.shape[1] - scan.cells.shape[0]
    assert drive.info.scanner_position == tuple(scan.position)
    assert drive.revolutions is None
    assert not (drive.folder / "grid.bin").exists()
    assert drive.info.source_runs or suffix == "e57"
    _, indices = drive.sources(0, drive.count)
    assert sorted(indices.tolist()) == list(range(drive.count))


def test_every_scan_of_a_file_becomes_a_drive_with_its_number_and_place(tmp_path):
    scans = [sphere_scan(20 + k, 16, position=(10.0 * k, 0.0, 1.0)) for k in range(3)]
    path = tmp_path / "rooms.ptx"
    path.write_text(ptx_text(*scans))
    drives = _imported(tmp_path, path)
    assert [drive.info.name for drive in drives] == ["rooms (1)", "rooms (2)", "rooms (3)"]
    for drive, scan in zip(drives, scans, strict=True):
        assert np.array_equal(_cells(drive), scan.cells)
        assert drive.info.scanner_position == tuple(scan.position)


def test_a_place_that_the_sweeps_contradict_is_not_kept(tmp_path):
    scan = sphere_scan()
    lines = ptx_text(scan).splitlines()
    # The points were moved to the project's frame, and the pose was left out.
    shifted = scan.xyz - scan.position + np.array([2.0, 1.0, 0.5])
    lines[2] = lines[9] = "0 0 0"
    lines[9] += " 1"
    at = 10 + scan.cells[:, 0] * scan.shape[1] + scan.cells[:, 1]
    for line, row in zip(at.tolist(), shifted.tolist(), strict=True):
        lines[line] = " ".join(f"{value:.5f}" for value in (*row, 0.5))
    path = tmp_path / "room.ptx"
    path.write_text("\n".join([*lines, ""]))
    (drive,) = _imported(tmp_path, path)
    assert drive.info.rows_by == "scan"
    assert drive.info.scanner_position is None


def _text_scan(tmp_path, grid, xyz):
    path = tmp_path / "scan.csv"
    rows = np.column_stack([xyz, grid])
    lines = [",".join(f"{value:.4f}" for value in row) for row in rows.tolist()]
    path.write_text("\n".join(["x,y,z,column,row", *lines, ""]))
    return path


@pytest.mark.parametrize(
    ("damage", "why"),
    [
        ("repeated", "many points share a cell"),
        ("unknown", "points lack their row or column"),
        ("line", "all points lie in one sweep"),
        ("wide", "nearly all of its cells are empty"),
        ("shuffled", "neighbours in it lie far apart"),
    ],
)
def test_a_grid_that_contradicts_itself_gives_the_top_view_and_says_why(tmp_path, damage, why):
    scan = sphere_scan()
    grid, xyz = scan.cells.astype(np.float64), scan.xyz
    if damage == "repeated":
        grid = grid // [1, 2]
    elif damage == "unknown":
        grid[5, 0] = -1
    elif damage == "line":
        grid[:, 0] = 0
    elif damage == "wide":
        grid[7] = 2e9
    else:
        xyz = np.random.default_rng(1).permutation(xyz)
    (drive,) = _imported(tmp_path, _text_scan(tmp_path, grid, xyz))
    assert drive.image_kinds == (ImageKind.TOP_VIEW,)
    assert why in drive.info.rows_reason.en
    position = drive.xyz(slice(None))
    assert np.allclose(np.sort(position, axis=0), np.sort(xyz, axis=0), atol=1e-3)
    _, indices = drive.sources(0, drive.count)
    assert np.allclose(xyz[indices], position, atol=1e-3)


def test_several_returns_of_a_beam_share_a_pixel_the_first_one_shown(tmp_path):
    scan = sphere_scan()
    xyz = np.repeat(scan.xyz, 2, axis=0)
    xyz[1::2] += 0.1
    path = tmp_path / "scan.csv"
    returns = np.tile([2, 1], scan.xyz.shape[0])  # the last one is delivered first
    xyz[0::2], xyz[1::2] = xyz[1::2].copy(), xyz[0::2].copy()
    table = np.column_stack([xyz, np.repeat(scan.cells, 2, axis=0), returns])
    lines = [",".join(f"{value:.4f}" for value in row) for row in table.tolist()]
    path.write_text("\n".join(["x,y,z,column,row,return_number", *lines, ""]))
    (drive,) = _imported(tmp_path, path)
    image = image_of(drive, ImageKind.SCAN)
    row, column = scan.cells[77]
    points = image.points_at(int(row), int(column))
    assert drive.columns["return_number"][points].tolist() == [1, 2]
    assert np.allclose(drive.xyz(points[:1])[0], scan.xyz[77], atol=1e-3)


def test_other_images_of_a_scan_are_refused_with_the_reason(tmp_path):
    path = tmp_path / "room.ptx"
    path.write_text(ptx_text(sphere_scan()))
    (drive,) = _imported(tmp_path, path)
    with pytest.raises(Unsuitable) as refused:
        image_of(drive, ImageKind.REVERSIBLE)
    assert "The scanner stood still" in refused.value.remedy.en
