"""Volumes kept with a project: whole or not at all, listed without their maps."""

from __future__ import annotations

import subprocess
import sys
from contextlib import closing
from dataclasses import replace
from datetime import UTC, date, datetime
from pathlib import Path

import numpy as np
import pytest
from numpy.typing import NDArray
from shapely import LineString, Polygon

from processing.core.errors import BadFile, MissingInput
from processing.core.text import Text
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine
from processing.methods.earthwork.volumes.volume_result import Registration, VolumeResult, Volumes
from processing.methods.ground.filters.cells import CellGrid
from processing.operations.project_volumes import MadeVolume, remove_volume, store_volume
from processing.project.project import Project
from processing.project.volumes.volume import (
    ChosenSide,
    KeptVolume,
    SideKind,
    VolumeRequest,
    new_volume,
)
from processing.project.volumes.volume_store import VolumeStore, write_volume

MADE = datetime(2026, 5, 1, 12, tzinfo=UTC)
BEFORE = ChosenSide(SideKind.EPOCH, "施工前", ("a", "b"), measured_on=date(2026, 4, 1))
DESIGN = ChosenSide(SideKind.DESIGN, "設計", path="/設計/面.xml", surface="天端")
SHIFT = Registration((0.01, -0.02, 0.003), (0.001, 0.002, 0.0005), 812.5, True, False)


def _change() -> ChangeGrid:
    before = np.arange(12, dtype=np.float32).reshape(3, 4)
    before[0, 0] = np.nan
    measured = np.ones((3, 4), np.bool_)
    measured[1, 1] = False
    inside = np.linspace(0, 1, 12, dtype=np.float32).reshape(3, 4)
    grid = CellGrid(np.array([-11234.25, -35123.5, 120.125]), 0.5, 3, 4)
    return ChangeGrid(grid, before, before + np.float32(0.25), measured, inside)


def _result(registration: Registration | None = SHIFT) -> VolumeResult:
    volumes = Volumes(1.5, 2.25, 3.0, 0.5, 0.125, 1.25, 2.0)
    notes = (Text("Much was filled in.", "補間が多くあります。"),)
    return VolumeResult(volumes, "grid", 0.5, _change(), registration, notes)


def _request() -> VolumeRequest:
    return VolumeRequest(
        BEFORE,
        DESIGN,
        {"method": "grid", "grid_m": 0.5, "correct_shift": True},
        Polygon([(0, 0), (10.1, 0), (10.1, 1 / 3)]),
        LineString([(0, 0), (5.5, 7.25)]),
        (LineString([(0, 0, 1.5), (1, 1, 2.5)]),),
    )


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """An empty project's."""
    folder = tmp_path / "site.zuka"
    Project.create(folder, "EPSG:6677").close()
    return folder


def keep(folder: Path, kept: KeptVolume, result: VolumeResult) -> KeptVolume:
    """Have a project keep a volume."""
    made = folder / "tmp" / kept.id
    with closing(Project.open(folder)) as project:
        write_volume(kept, result, made)
        store_volume(project, MadeVolume(kept, made))
    return kept


def _kept(folder: Path, made: datetime = MADE) -> KeptVolume:
    result = _result()
    kept = new_volume(_request(), result, crs="EPSG:6677", version=2, made=made)
    return keep(folder, kept, result)


def test_a_volume_is_read_again_as_it_was_kept(folder: Path) -> None:
    kept = _kept(folder)
    assert VolumeStore(folder).all() == (kept,)
    change, expected = VolumeStore(folder).read_map(kept.id), _change()
    for name in ("before", "after", "is_measured", "inside"):
        np.testing.assert_array_equal(getattr(change, name), getattr(expected, name))
    np.testing.assert_array_equal(change.grid.origin, expected.grid.origin)
    assert (change.grid.size_m, change.grid.rows, change.grid.columns) == (0.5, 3, 4)
    result = VolumeStore(folder).read_result(kept)
    assert (result.volumes, result.registration) == (_result().volumes, SHIFT)
    assert (result.line, result.between) == (None, ())


def test_a_volume_without_registration_and_lines_is_read_again(folder: Path) -> None:
    result = _result(None)
    request = VolumeRequest(ChosenSide(SideKind.LEVEL, height_m=4.25), BEFORE, {})
    kept = new_volume(request, result, crs="", version=1, made=MADE)
    keep(folder, kept, result)
    assert VolumeStore(folder).all() == (kept,)


def _section(station_m: float, count: int, inside: NDArray[np.bool_] | None) -> DrawnSection:
    offsets = np.linspace(-2.0, 2.0, count)
    after = offsets * 0.1
    after[0] = np.nan
    name = f"No.0+{station_m:.2f}"
    return DrawnSection(station_m, name, offsets, offsets * 0.2, after, 1.5, 0.25, inside)


def test_sections_are_read_again_with_the_earth_between_them(folder: Path) -> None:
    xy = np.array([[0.0, 0.0], [20.0, 1 / 3]])
    sections = _section(0.0, 5, np.arange(4) > 0), _section(10.0, 9, None)
    line = SectionedLine("中心線", xy, 2.5, sections)
    result = replace(_result(), method="end-area", line=line, between=((1.5, np.nan),))
    kept = new_volume(_request(), result, crs="", version=1, made=MADE)
    keep(folder, kept, result)
    store = VolumeStore(folder)
    found = store.read_result(kept)
    assert found.line is not None
    np.testing.assert_array_equal(found.line.xy, xy)
    assert (found.line.name, found.line.start_m) == ("中心線", 2.5)
    np.testing.assert_array_equal(found.between, result.between)
    for section, expected in zip(found.line.sections, line.sections, strict=True):
        assert (section.name, section.cut_m2) == (expected.name, expected.cut_m2)
        for name in ("station_m", "offsets", "before", "after", "fill_m2"):
            np.testing.assert_array_equal(getattr(section, name), getattr(expected, name))
    np.testing.assert_array_equal(found.line.sections[0].is_inside, sections[0].is_inside)
    assert found.line.sections[1].is_inside is None
    path = folder / "results" / "volumes" / kept.id / "sections.npz"
    path.write_bytes(path.read_bytes()[:-30])
    with pytest.raises(BadFile):
        store.read_result(kept)


def test_the_first_one_is_listed_first(folder: Path) -> None:
    later = _kept(folder, datetime(2026, 6, 1, tzinfo=UTC))
    earlier = _kept(folder)
    assert VolumeStore(folder).all() == (earlier, later)


def test_what_was_not_taken_in_is_not_there(folder: Path) -> None:
    kept = new_volume(_request(), _result(), crs="", version=1, made=MADE)
    write_volume(kept, _result(), folder / "tmp" / kept.id)
    assert VolumeStore(folder).all() == ()
    with pytest.raises(MissingInput):
        VolumeStore(folder).read_map(kept.id)


def test_writing_that_fails_leaves_no_folder(tmp_path: Path) -> None:
    kept = new_volume(_request(), _result(), crs="", version=1, made=MADE)
    unknown = replace(kept, crs=object())  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        write_volume(unknown, _result(), tmp_path / "made")
    assert not (tmp_path / "made").exists()


def test_a_removed_volume_is_gone_and_others_stay_until_undo_brings_it_back(
    folder: Path,
) -> None:
    removed, kept = _kept(folder), _kept(folder)
    with closing(Project.open(folder)) as project:
        remove_volume(project, removed)
        assert VolumeStore(folder).all() == (kept,)
    with closing(Project.open(folder)) as project:
        assert project.history.undo_label is not None
        assert project.history.undo_label.en.startswith("Remove Volume")
        assert project.features.undo() is not None
    assert {one.id for one in VolumeStore(folder).all()} == {removed.id, kept.id}
    assert VolumeStore(folder).read_result(removed).volumes == _result().volumes


@pytest.mark.parametrize("text", ["", "[]", "{", '{"made": 3}', "\x00\x00"])
def test_damaged_facts_are_left_out_of_the_list(folder: Path, text: str) -> None:
    damaged, kept = _kept(folder), _kept(folder)
    home = folder / "results" / "volumes"
    (home / damaged.id / "volume.json").write_text(text, encoding="utf-8")
    assert VolumeStore(folder).all() == (kept,)
    with pytest.raises(BadFile):
        VolumeStore(folder).read_map(damaged.id)


@pytest.mark.parametrize("name", ["before.npy", "inside.npy"])
def test_a_damaged_map_is_said_in_a_sentence(folder: Path, name: str) -> None:
    kept = _kept(folder)
    path = folder / "results" / "volumes" / kept.id / name
    whole = path.read_bytes()
    for broken in (b"", whole[:20], whole[:-3], np.lib.format.magic(1, 0)):
        path.write_bytes(broken)
        with pytest.raises(BadFile):
            VolumeStore(folder).read_map(kept.id)
    path.unlink()
    with pytest.raises(MissingInput):
        VolumeStore(folder).read_map(kept.id)


_WRITES_ON = """
import sys
from datetime import UTC, datetime
from pathlib import Path
from processing.operations.project_volumes import MadeVolume, store_volume
from processing.project.project import Project
from processing.project.volumes.volume import new_volume
from processing.project.volumes.volume_store import write_volume
from tests.processing.project.volumes.test_volume_store import large_result, request_of_a_site

folder = Path(sys.argv[1])
project = Project.open(folder)
result = large_result()
while True:
    kept = new_volume(request_of_a_site(), result, crs="", version=1, made=datetime.now(UTC))
    write_volume(kept, result, folder / "tmp" / kept.id)
    store_volume(project, MadeVolume(kept, folder / "tmp" / kept.id))
    print(kept.id, flush=True)
"""


def request_of_a_site() -> VolumeRequest:
    """Give what was compared."""
    return _request()


def large_result() -> VolumeResult:
    """Give a map that takes some time to write."""
    shape = (1500, 1500)
    ground = np.zeros(shape, np.float32)
    grid = CellGrid(np.zeros(3), 0.1, *shape)
    ones = np.ones(shape, np.float32)
    change = ChangeGrid(grid, ground, ones, ones > 0, ones)
    return replace(_result(), change=change)


@pytest.mark.parametrize("count", [1, 2, 3])
def test_a_kill_while_volumes_are_written_leaves_only_whole_ones(folder: Path, count: int) -> None:
    command = [sys.executable, "-c", _WRITES_ON, str(folder)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        written = [process.stdout.readline().strip() for _ in range(count)]
        process.kill()
    Project.open(folder).close()
    found = VolumeStore(folder).all()
    assert set(written) <= {kept.id for kept in found}
    for kept in found:
        assert VolumeStore(folder).read_result(kept).change.change_m.shape == (1500, 1500)
