"""Damaged files of a drive: what looks at them answers, or refuses in a sentence; nothing dies."""

from __future__ import annotations

import os
import shutil
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile
from processing.image.images_of_drives import image_of
from processing.image.rows import image_rows as rows_module
from processing.image.rows.point_image_kernels import (
    PixelLayout,
    columns_kernel,
    noiseless_raster_kernel,
    raster_kernel,
    stretches_kernel,
)
from processing.image.search.touched_tiles import _touch_kernel
from processing.project.project import Project
from processing.recording.columns.counted_classes import class_columns
from processing.recording.columns.source_order import sources_of
from processing.recording.drive import Drive
from processing.recording.kinds import ImageKind
from tests.older_project import forget_all_sums
from tests.processing.project.labelled import labelled_project

_LONGEST_S = 600

FILES = (
    "pulse.bin",
    "revolutions.npz",
    "image_rows_trajectory-center.npz",
    "image_rows_reversible.npz",
    "tile_bounds_feature-center.npy",
    "xyz.bin",
    "time.bin",
    "trajectory.npy",
)


@pytest.fixture(scope="module")
def whole(tmp_path_factory: pytest.TempPathFactory) -> Path:
    return labelled_project(tmp_path_factory.mktemp("whole"), length_m=4.0)


@pytest.fixture
def drive(whole: Path, tmp_path: Path) -> Drive:
    with closing(Project.open(whole, writing=False)) as project:
        (folder,) = (one.folder for one in project.drives)
    return Drive(forget_all_sums(Path(shutil.copytree(folder, tmp_path / "drive"))))


def altered(drive: Drive, seed: int, count: int = 47) -> NDArray[np.int64]:
    """The drive's pulses with some values that are any at all."""
    random = np.random.default_rng(seed)
    pulses = np.array(drive.columns["pulse"])
    positions = random.integers(0, pulses.size, count)
    pulses[positions] = random.integers(-(1 << 62), 1 << 62, count)
    return pulses


def written(path: Path, values: NDArray[np.int64]) -> None:
    """Values in a file that doesn't tell that it was written."""
    times = path.stat().st_mtime_ns
    values.tofile(path)
    os.utime(path, ns=(times, times))


def all_pixels(drive: Drive, kind: ImageKind) -> None:
    image = image_of(drive, kind)
    image.raster(range(image.rows), range(image.width))
    image.columns_of(0, drive.count)


@pytest.mark.parametrize("name", FILES)
def test_a_program_that_looks_at_a_damaged_file_goes_on(
    whole: Path, tmp_path: Path, name: str
) -> None:
    project = forget_all_sums(Path(shutil.copytree(whole, tmp_path / "p.zuka")))
    command = [sys.executable, "-m", "tests.broken_files.damaged_drive", str(project), name, "1"]
    done = subprocess.run(command, capture_output=True, text=True, timeout=_LONGEST_S, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("kind", ["trajectory-center", "reversible"])
@pytest.mark.parametrize("seed", range(4))
def test_pulses_that_changed_since_their_rows_were_found_are_refused(
    drive: Drive, monkeypatch: pytest.MonkeyPatch, kind: str, seed: int
) -> None:
    monkeypatch.setattr(rows_module, "_FEW_POINTS", 0)
    wanted = ImageKind(kind)
    image_of(drive, wanted)
    rows = drive.folder / f"image_rows_{kind}.npz"
    assert rows.is_file()
    written(drive.folder / "pulse.bin", altered(drive, seed))
    with pytest.raises(BadFile, match="pulse numbers") as refused:
        all_pixels(Drive(drive.folder), wanted)
    assert refused.value.where.en == str(drive.folder / "pulse.bin")


def test_rows_that_were_altered_are_found_anew(
    drive: Drive, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(rows_module, "_FEW_POINTS", 0)
    whole = image_of(drive, ImageKind.REVERSIBLE)
    path = drive.folder / "image_rows_reversible.npz"
    with np.load(path) as stored:
        kept = {name: stored[name] for name in stored.files}
    for name in ("row_starts", "origins", "spans", "widths", "segments", "per_span"):
        for step in (-(1 << 30), -7, 7, 1 << 30):
            changed = np.array(kept[name])
            changed.reshape(-1)[changed.size // 2] += step
            np.savez(path, allow_pickle=False, **{**kept, name: changed})
            found = image_of(Drive(drive.folder), ImageKind.REVERSIBLE)
            np.testing.assert_array_equal(found.row_starts, whole.row_starts)
            np.testing.assert_array_equal(found.row_widths, whole.row_widths)
            if name != "segments":
                np.testing.assert_array_equal(found.layout.origins, whole.layout.origins)


@pytest.mark.parametrize("name", ["fold_pulses", "row_ends", "segments", "reference_times"])
def test_turns_that_fall_are_refused(drive: Drive, name: str) -> None:
    path = drive.folder / "revolutions.npz"
    with np.load(path) as stored:
        kept = {one: stored[one] for one in stored.files}
    kept[name][kept[name].size // 2] = np.iinfo(np.int32).max
    np.savez(path, allow_pickle=False, **kept)
    with pytest.raises(BadFile, match="rows of a drive are damaged"):
        Drive(drive.folder)


@pytest.mark.parametrize("cells", [[3, 2, 9], [-5, 2, 9], [0, 2, 1 << 62]])
def test_cells_that_no_view_has_are_refused(cells: list[int]) -> None:
    with pytest.raises(BadFile):
        rows_module.image_rows(ImageKind.TOP_VIEW, np.array(cells), 4)


@pytest.mark.parametrize("seed", range(6))
def test_kernels_stay_inside_their_arrays_whatever_the_pulses_are(drive: Drive, seed: int) -> None:
    image = image_of(drive, ImageKind(("trajectory-center", "reversible")[seed % 2]))
    layout = PixelLayout(altered(drive, seed, 400), *image.layout[1:])
    rows, columns = 12, min(image.width, 80)
    window = np.array([0, 1, 2, columns, image.width])
    # As plain functions: numpy refuses what is beyond an array, and −1 is told by what is not −1.
    with np.errstate(all="ignore"):
        for kernel in (raster_kernel, noiseless_raster_kernel):
            more = () if kernel is raster_kernel else (class_columns(drive.columns),)
            raster = np.empty((rows, columns - 2), np.int64)
            is_whole = kernel.py_func(layout, *more, window, raster)  # type: ignore[attr-defined]
            assert not is_whole or ((raster >= -1) & (raster < drive.count)).all()
        found = np.empty(int(image.row_starts[rows]), np.int32)
        first = np.array([0, 0, image.width])
        if columns_kernel.py_func(layout, first, found):  # type: ignore[attr-defined]
            assert ((found >= 0) & (found < image.width)).all()
        stretches = np.empty((rows, 2), np.int64)
        windows = np.array([[0, rows, 2, columns]])
        if stretches_kernel.py_func(layout, windows, stretches):  # type: ignore[attr-defined]
            assert (stretches[:, 0] <= stretches[:, 1]).all()
        touched = np.zeros((-(-image.rows // 256), -(-image.width // 256)), np.bool_)
        points = np.concatenate([np.arange(0, 3000, 7), [drive.count, 1 << 40]])
        _touch_kernel.py_func(layout, points, 0, touched)  # type: ignore[attr-defined]


def test_places_that_no_delivered_file_has_are_refused(drive: Drive) -> None:
    for files, indices in (([0, 9], [0, 1]), ([0, 0], [0, -1]), ([0, 0], [1 << 60, 0])):
        for name, values in (("source_file", files), ("source_index", indices)):
            dtype = np.uint16 if name == "source_file" else np.int64
            column = np.resize(np.array(values, dtype), drive.count)
            column.tofile(drive.folder / f"{name}.bin")
        with pytest.raises(BadFile, match="where points were delivered"):
            sources_of(Drive(drive.folder).columns, (), 0, drive.count, sources=1)
