"""Ground of drives: recorded together, cut into tiles, kept as a surface; truth by construction."""

from __future__ import annotations

import dataclasses
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray

from processing.core.errors import BadFile, Cancelled, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.methods.ground.filters import plan_tiles
from processing.methods.ground.filters.cells import CellGrid
from processing.methods.ground.stored_surface import (
    FILE_NAME,
    StoredSurface,
    SurfaceTile,
    SurfaceWriter,
    copy_surface,
    ground_surface_of,
)
from processing.recording.columns.columns import ColumnWriter
from processing.recording.drive import Drive
from processing.recording.drive_info import DriveInfo, SourceFile, write_drive_info
from processing.recording.recorded_together import (
    recorded_together,
    recordings_of,
    surveyed_together,
)
from processing.tools.ground import GroundParameters
from processing.tools.running.runner import RunRequest, run_together
from processing.tools.tool import TogetherResult

Floats = NDArray[np.float64]
_ORIGIN = (-12_400.0, -36_700.0, 50.0)
_DAY_S = 86_400.0


def drive_at(
    folder: Path,
    xyz: Floats,
    *,
    file: str = "a.laz",
    time_s: float = 3.5e8,
    codes: NDArray[np.uint8] | None = None,
) -> Drive:
    """A drive of points given about an origin, measured from a time on."""
    folder.mkdir(parents=True)
    integers = np.rint(xyz / 0.001).astype(np.int32)
    count = len(xyz)
    with ColumnWriter(folder) as writer:
        writer.append(
            {
                "xyz": integers,
                "time": time_s + 1e-3 * np.arange(count),
                "intensity": np.zeros(count, np.uint16),
                "classification": np.zeros(count, np.uint8) if codes is None else codes,
                "pulse": np.arange(count),
            }
        )
    positions = integers * 0.001 + np.array(_ORIGIN)
    low, high = (positions.min(axis=0), positions.max(axis=0)) if count else (np.zeros(3),) * 2
    source = SourceFile(str(folder.parent / file), 1, 1, "", count)
    info = DriveInfo(
        id=folder.name,
        name=folder.name,
        scanner=1,
        count=count,
        scale=(0.001, 0.001, 0.001),
        offset=_ORIGIN,
        lowest=(float(low[0]), float(low[1]), float(low[2])),
        highest=(float(high[0]), float(high[1]), float(high[2])),
        crs="EPSG:6677",
        sources=(source,),
        clock_offset_s=0.0,
        rows_by="top-view",
        rows_reason=Text("", ""),
        cell_m=1.0,
        cells_per_row=100,
    )
    write_drive_info(folder, info)
    return Drive(folder)


def level(side_m: float, step_m: float = 0.2, slope: float = 0.1) -> Floats:
    x, y = np.meshgrid(np.arange(0.0, side_m, step_m), np.arange(0.0, side_m, step_m))
    rng = np.random.default_rng(1)
    return np.column_stack([x.ravel(), y.ravel(), slope * x.ravel() + rng.normal(0, 0.004, x.size)])


def block_on(xyz: Floats, low: tuple[float, float], high: tuple[float, float], m: float) -> Floats:
    """The same points with those in a rectangle lifted: a machine, measured from above."""
    lifted = xyz.copy()
    inside = np.all((xyz[:, :2] > low) & (xyz[:, :2] < high), axis=1)
    lifted[inside, 2] += m
    return lifted


def found(drives: tuple[Drive, ...], into: Path, **parameters: object) -> TogetherResult:
    wanted = dataclasses.replace(GroundParameters(), **parameters)  # type: ignore[arg-type] - by name
    return run_together(
        RunRequest("ground", drives[0], wanted, drives[1:]), SilentMonitor(), into=into
    )


def classes(result: TogetherResult, drive: int = 0) -> NDArray[np.uint8]:
    columns = result.columns[drive]
    return np.asarray(columns.read("classification", 0, columns.count))


def test_stations_find_the_ground_behind_a_machine_for_each_other(tmp_path: Path) -> None:
    cloud = block_on(level(30.0), (12.0, 12.0), (16.0, 14.5), 2.5)
    behind = cloud[:, 0] > 12.0
    stations = tuple(
        drive_at(tmp_path / name, cloud[part], file=f"{name}.laz", time_s=3.5e8 + wait)
        for name, part, wait in (
            ("west", ~behind, 0.0),
            ("east", behind | (cloud[:, 1] < 3), 900.0),
        )
    )
    result = found(stations, tmp_path / "run")
    assert [one.count for one in result.columns] == [one.count for one in stations]
    for number, station in enumerate(stations):
        local = station.xyz(slice(None)) - np.array(_ORIGIN)
        is_machine = local[:, 2] > 0.1 * local[:, 0] + 1.0
        assert (classes(result, number)[~is_machine] == 2).mean() > 0.99
        assert (classes(result, number)[is_machine] == 1).all()
        heights = result.columns[number].read("height_above_ground", 0, station.count)
        np.testing.assert_allclose(heights[~is_machine], 0.0, atol=0.1)
        np.testing.assert_allclose(heights[is_machine], 2.5, atol=0.15)
    assert "cells of 0." in result.note.en


def test_epochs_are_never_one_recording_and_a_day_at_one_place_is(tmp_path: Path) -> None:
    xyz = level(6.0)
    here = drive_at(tmp_path / "here", xyz, file="1.laz")
    soon = drive_at(tmp_path / "soon", xyz, file="2.laz", time_s=3.5e8 + 0.5 * _DAY_S)
    later = drive_at(tmp_path / "later", xyz, file="3.laz", time_s=3.5e8 + 30 * _DAY_S)
    away = drive_at(tmp_path / "away", xyz + np.array([500.0, 0.0, 0.0]), file="4.laz")
    shared = drive_at(tmp_path / "shared", xyz, file="3.laz", time_s=3.5e8 + 33 * _DAY_S)
    assert recorded_together(here, (later, away, soon, shared)) == (here, soon)
    assert surveyed_together(here, (away, later)) == (here, later)
    next_year = drive_at(tmp_path / "next year", xyz, file="9.laz", time_s=3.5e8 + 400 * _DAY_S)
    assert surveyed_together(here, (next_year, soon)) == (here, soon)
    parts = recordings_of((here, later, away, soon, shared))
    assert parts == ((here, soon), (later, shared), (away,))
    saturday = drive_at(tmp_path / "saturday", xyz, file="5.laz", time_s=7 * _DAY_S - 900.0)
    sunday = drive_at(tmp_path / "sunday", xyz, file="6.laz", time_s=300.0)
    tuesday = drive_at(tmp_path / "tuesday", xyz, file="7.laz", time_s=2 * _DAY_S + 300.0)
    assert recordings_of((sunday, tuesday, saturday)) == ((sunday, saturday), (tuesday,))


def test_strips_written_anew_are_met_in_place_of_the_delivered_ones(tmp_path: Path) -> None:
    # An estimated file beside its archive in one project: classified together, every point counted
    # twice.
    xyz, beside = level(6.0), level(6.0) + np.array([3.0, 0.0, 0.0])
    strips = {
        (file, number): drive_at(
            tmp_path / f"{file} {number}", cloud, file=file, time_s=3.5e8 + 600.0 * number
        )
        for file in ("archive.laz", "estimated.las")
        for number, cloud in enumerate((xyz, beside))
    }
    first, second, new_first, new_second = strips.values()
    assert recorded_together(first, (second, new_first, new_second)) == (first, second)
    assert recorded_together(new_first, (first, second, new_second)) == (new_first, new_second)
    parts = recordings_of((first, second, new_first, new_second))
    assert parts == ((first, second), (new_first, new_second))


def test_clouds_without_times_in_files_of_their_own_may_be_epochs(tmp_path: Path) -> None:
    xyz = level(6.0)
    one = drive_at(tmp_path / "one", xyz, file="before.ply", time_s=np.nan)
    other = drive_at(tmp_path / "other", xyz, file="after.ply", time_s=np.nan)
    same = drive_at(tmp_path / "same", xyz, file="before.ply", time_s=np.nan)
    assert recorded_together(one, (other, same)) == (one, same)


def test_noise_keeps_its_class_and_is_left_out_of_the_search(tmp_path: Path) -> None:
    xyz = level(20.0)
    codes = np.zeros(len(xyz), np.uint8)
    deep = np.arange(0, len(xyz), 40)
    xyz[deep, 2] -= 0.6
    codes[deep] = np.where(deep % 80 == 0, 7, 18)
    drive = drive_at(tmp_path / "d", xyz, codes=codes)
    labels = np.zeros(len(xyz), np.uint8)
    painted = deep[::3]
    labels[painted] = 18
    labels[1:7:2] = 7
    drive.columns.add("label", labels)
    said = classes(found((drive,), tmp_path / "run"))
    expected = np.where(labels > 0, labels, codes)
    is_noise = expected > 0
    np.testing.assert_array_equal(said[is_noise], expected[is_noise])
    assert (said[~is_noise] == 2).mean() > 0.99


def test_a_plan_in_tiles_has_the_ground_of_the_whole(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    rng = np.random.default_rng(2)
    xyz = level(300.0, 1.0, 0.05)
    xyz[:, 2] += np.sin(xyz[:, 1] / 20.0) + rng.normal(0, 0.02, len(xyz))
    for _ in range(40):
        corner = rng.uniform(0, 290, 2)
        size = rng.uniform(3, 25, 2)
        xyz = block_on(xyz, tuple(corner), tuple(corner + size), rng.uniform(2, 9))
    drive = drive_at(tmp_path / "d", xyz)
    whole = found((drive,), tmp_path / "whole")
    monkeypatch.setattr(plan_tiles, "MOST_CELLS", 45_000)
    cut = found((drive,), tmp_path / "cut")
    assert len(StoredSurface(cut.kept[0]).extents) >= 4
    assert (classes(whole) == classes(cut)).mean() > 0.9995
    surfaces = [StoredSurface(result.kept[0]) for result in (whole, cut)]
    positions = drive.xyz(slice(0, None, 7))[:, :2]
    heights = [surface.heights_at(positions) for surface in surfaces]
    is_measured = ~surfaces[0].is_filled_at(positions)
    apart = np.abs(heights[0] - heights[1])[is_measured]
    assert (apart < 0.01).mean() > 0.97
    assert apart.max() < 0.2


def test_tiles_own_every_occupied_cell_once_and_leave_empty_land_out() -> None:
    grid = CellGrid(np.zeros(3), 1.0, 4000, 4000)
    along = np.linspace(10.0, 3990.0, 5000)
    xyz = np.column_stack([along, along, np.zeros(5000)])
    tiles = plan_tiles.plan_tiles(lambda: [xyz], grid, 50.0)
    owners = sum(
        (xyz[:, 1] // 1 >= tile.rows.start)
        & (xyz[:, 1] // 1 < tile.rows.stop)
        & (xyz[:, 0] // 1 >= tile.columns.start)
        & (xyz[:, 0] // 1 < tile.columns.stop)
        for tile in tiles
    )
    assert np.all(owners == 1)
    assert sum(tile.grid.rows * tile.grid.columns for tile in tiles) < 0.2 * 4000 * 4000
    assert all(tile.grid.rows * tile.grid.columns <= plan_tiles.MOST_CELLS for tile in tiles)


@pytest.mark.parametrize("method", ["adaptive", "published", "lowest"])
@pytest.mark.parametrize("what", ["two points", "one place", "only noise", "nothing"])
def test_what_has_no_ground_is_refused_and_leaves_nothing(
    tmp_path: Path, method: str, what: str
) -> None:
    xyz = np.zeros((0, 3)) if what == "nothing" else np.ones((2 if what == "two points" else 9, 3))
    if what == "only noise":
        xyz = level(3.0)
    codes = np.full(len(xyz), 18 if what == "only noise" else 0, np.uint8)
    drive = drive_at(tmp_path / "d", xyz, codes=codes)
    with pytest.raises(OutOfRange, match="three or more places"):
        found((drive,), tmp_path / "run", method=method)
    assert [path.name for path in tmp_path.iterdir()] == ["d"]


@pytest.mark.parametrize("method", ["adaptive", "published", "lowest"])
def test_points_of_one_plane_and_spikes_come_through(tmp_path: Path, method: str) -> None:
    rng = np.random.default_rng(3)
    upright = np.column_stack([rng.uniform(0, 9, 900), np.zeros(900), rng.uniform(0, 3, 900)])
    ten = rng.uniform(0, 5, (10, 3)) * [1, 1, 0]
    spikes = np.vstack([level(20.0), [[10.0, 10.0, 1e4], [10.0, 10.0, -1e4], [1e4, 10.0, 0.0]]])
    for number, xyz in enumerate((upright, ten, spikes)):
        result = found(
            (drive_at(tmp_path / f"d{number}", xyz),), tmp_path / f"{number}", method=method
        )
        said = classes(result)
        assert set(np.unique(said)) <= {1, 2}
        assert (said == 2).any()
        if method == "adaptive" and number == 2:
            assert (said[:-3] == 2).mean() > 0.99
            assert (said[-3:] == 1).all()


def test_a_surface_for_a_method_without_one_is_refused_before_any_work(tmp_path: Path) -> None:
    drive = drive_at(tmp_path / "d", level(3.0))
    with pytest.raises(OutOfRange, match="Only the adaptive method"):
        found((drive,), tmp_path / "run", method="lowest", surface="s.tif")
    with pytest.raises(OutOfRange, match="too small"):
        found((drive,), tmp_path / "run", grid_m=0.05)


class _Stopping:
    """Stops the work at one of its checks."""

    def __init__(self, after: int) -> None:
        self.left = after

    def report(self, fraction: float, text: Text | None = None) -> None:
        pass

    def check(self) -> None:
        self.left -= 1
        if self.left == 0:
            raise Cancelled


@pytest.mark.parametrize("method", ["adaptive", "published", "lowest"])
def test_a_cancel_at_any_time_leaves_nothing(tmp_path: Path, method: str) -> None:
    drive = drive_at(tmp_path / "d", level(10.0))
    request = RunRequest("ground", drive, GroundParameters(method=method))
    for after in range(1, 40, 9):
        watching = _Stopping(after)
        try:
            run_together(request, watching, into=tmp_path / f"{after}")
        except Cancelled:
            assert [path.name for path in tmp_path.iterdir()] == ["d"]
        else:
            assert after > 9
            return


def test_a_kept_surface_serves_all_its_drives_until_it_is_deleted(tmp_path: Path) -> None:
    drives = tuple(drive_at(tmp_path / name, level(20.0)) for name in ("a", "b"))
    result = found(drives, tmp_path / "run")
    assert ground_surface_of(drives[0]) is None
    for drive in drives:
        copy_surface(result.kept[0], drive.folder / FILE_NAME)
        surface = ground_surface_of(drive)
        assert surface is not None
        assert surface.crs == "EPSG:6677"
        position = np.array([[10.0, 10.0], [-50.0, 0.0], [np.nan, 1.0]]) + np.array(_ORIGIN[:2])
        heights = surface.heights_at(position)
        assert heights[0] == pytest.approx(51.0, abs=0.03)
        assert np.isnan(heights[1:]).all()
        assert surface.is_filled_at(position).tolist() == [False, True, True]
        (drive.folder / FILE_NAME).unlink()
        assert ground_surface_of(drive) is None


def test_heights_go_on_between_tiles_of_a_surface(tmp_path: Path) -> None:
    grid = CellGrid(np.array([1000.0, 2000.0, 30.0]), 0.5, 40, 60)
    rows, columns = np.mgrid[:40, :60]
    plane = (0.2 * columns + 0.1 * rows).astype(np.float32)
    filled = columns >= 50
    with SurfaceWriter(tmp_path / "s.tiles", grid, "") as writer:
        for part in (np.s_[0:40, 0:31], np.s_[0:40, 29:60]):
            writer.add(SurfaceTile(0, part[1].start, plane[part], filled[part]))
    surface = StoredSurface(tmp_path / "s.tiles")
    rng = np.random.default_rng(4)
    cells = rng.uniform([0.5, 0.5], [59.5, 39.5], (5000, 2))
    heights = surface.heights_at(cells * 0.5 + grid.origin[:2])
    expected = 30.0 + 0.2 * (cells[:, 0] - 0.5) + 0.1 * (cells[:, 1] - 0.5)
    np.testing.assert_allclose(heights, expected, atol=1e-5)
    found_filled = surface.is_filled_at(cells * 0.5 + grid.origin[:2])
    np.testing.assert_array_equal(found_filled, cells[:, 0] >= 50)
    whole, where = surface.window(range(40), range(60))
    np.testing.assert_allclose(whole, plane + 30.0, rtol=1e-6)
    np.testing.assert_array_equal(where, filled)


def test_a_damaged_surface_is_said_in_a_sentence(tmp_path: Path) -> None:
    path = tmp_path / "s.tiles"
    for content in (b"", b"ZUKAGND1" + bytes(4), b"ZUKAGND1" + bytes(20), b"x" * 64):
        path.write_bytes(content)
        with pytest.raises(BadFile, match="damaged"):
            StoredSurface(path)
