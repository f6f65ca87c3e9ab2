"""``zuka run volume`` on a small site made here, and on what it must refuse."""

from __future__ import annotations

import json
import re
from pathlib import Path

import laspy
import numpy as np
import pypdfium2
import pytest
import rasterio
from pyproj import CRS

from app.cli.terminal import CANCELLED
from processing.core.arrays import Floats
from processing.core.errors import Cancelled
from tests.app.volume_command import (
    CORNER,
    SIDE_M,
    refused,
    reported,
    run,
    write_design,
    write_polygon,
)

PIT_LOW, PIT_HIGH = np.array([6.0, 6.0]), np.array([14.0, 12.0])
PIT_M3 = 8.0 * 6.0 * 0.5


def heights(xy: Floats, *, is_later: bool) -> Floats:
    """A ground with waves, so that a shift to the side can be told, and later a pit in it."""
    rising: Floats = 0.3 * np.sin(xy[:, 0] / 2.0) + 0.3 * np.cos(xy[:, 1] / 2.0)
    in_pit = ((xy > PIT_LOW) & (xy < PIT_HIGH)).all(axis=1)
    return rising - 0.5 * (in_pit & is_later)


def write_epoch(
    path: Path,
    *,
    is_later: bool = False,
    moved: tuple[float, float, float] = (0.0, 0.0, 0.0),
    count: int = 40_000,
    crs: int = 6677,
) -> Path:
    random = np.random.default_rng(1 + is_later)
    plan = random.uniform(0.0, SIDE_M, (count, 2))
    z = heights(plan, is_later=is_later) + random.normal(0, 0.002, count)
    header = laspy.LasHeader(point_format=6, version="1.4")
    header.scales, header.offsets = np.full(3, 0.001), CORNER
    header.add_crs(CRS.from_epsg(crs))
    las = laspy.LasData(header)
    las.x, las.y, las.z = (np.column_stack([plan, z]) + CORNER + np.array(moved)).T
    las.classification = np.full(count, 2, np.uint8)
    las.write(path)
    return path


@pytest.fixture(scope="module")
def epochs(tmp_path_factory: pytest.TempPathFactory) -> tuple[Path, Path]:
    folder = tmp_path_factory.mktemp("epochs")
    return write_epoch(folder / "前.laz"), write_epoch(folder / "後.laz", is_later=True)


def test_a_pit_is_found_and_told_on_paper_and_as_a_map(
    epochs: tuple[Path, Path], tmp_path: Path
) -> None:
    around = [[3.0, 3.0], [17.0, 3.0], [17.0, 16.0], [3.0, 16.0]]
    boundary = write_polygon(tmp_path / "境界.geojson", around)
    tif, pdf = tmp_path / "差.tif", tmp_path / "土量.pdf"
    found = reported(
        tmp_path / "out.json", *epochs, f"boundary={boundary}", f"map={tif}", f"report={pdf}"
    )
    assert found["cut_m3"] == pytest.approx(PIT_M3, rel=0.02)
    assert found["fill_m3"] == pytest.approx(0.0, abs=0.2)
    assert found["net_m3"] == pytest.approx(found["fill_m3"] - found["cut_m3"])
    assert found["area_m2"] == pytest.approx(14.0 * 13.0, rel=1e-6)
    assert (found["method"], found["grid_m"], found["crs"]) == ("grid", 0.2, "EPSG:6677")
    assert found["unmeasured_area_m2"] < 1.0
    assert found["uncertainty_m3"] > 0
    with rasterio.open(tif) as opened:
        assert opened.crs.to_epsg() == 6677
        east, north = CORNER[:2] + np.array([10.0, 9.0])
        assert next(opened.sample([(east, north)]))[0] == pytest.approx(-0.5, abs=0.02)
    assert len(pypdfium2.PdfDocument(pdf)) >= 1


def test_further_dates_are_named_and_only_points_will_do(
    epochs: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    output = tmp_path / "out.json"
    sides = ("--before", epochs[0], "--after", epochs[1])
    assert run(output, *sides, "--also", epochs[0]) == 0
    found = json.loads(output.read_text(encoding="utf-8"))

    assert any("other dates too: 前" in note["en"] for note in found["notes"])
    assert found["cut_m3"] == pytest.approx(PIT_M3, rel=0.02)
    assert found["left_out_area_m2"] < 1.0
    line = refused(tmp_path, capsys, *sides, "--also", "12.5", name="other.json")
    assert "Only points tell of hidden ground" in line


def test_a_level_and_a_design_are_grounds_too(epochs: tuple[Path, Path], tmp_path: Path) -> None:
    design = write_design(tmp_path / "設計.xml", "計画面", "上の面")
    level = reported(tmp_path / "level.json", epochs[0], CORNER[2] + 2.0)
    named = reported(tmp_path / "design.json", epochs[0], f"{design}#計画面")
    higher = reported(tmp_path / "higher.json", epochs[0], f"{design}#上の面")
    assert named["fill_m3"] == pytest.approx(level["fill_m3"], rel=1e-6)
    assert higher["net_m3"] - named["net_m3"] == pytest.approx(named["area_m2"], rel=1e-6)


def test_heights_of_another_datum_are_brought_to_tokyo_peil(
    epochs: tuple[Path, Path], tmp_path: Path
) -> None:
    design = write_design(tmp_path / "設計.xml", "計画面")
    plain = reported(tmp_path / "plain.json", epochs[0], design)
    text = design.read_text(encoding="utf-8")
    said = '<Feature><Property label="differTP" value="-0.5"/></Feature>'
    told_there = rf"<CoordinateSystem \1>{said}</CoordinateSystem>"
    text, times = re.subn(r"<CoordinateSystem ([^>]*)/>", told_there, text)
    assert times == 1
    design.write_text(text, encoding="utf-8")
    lower = reported(tmp_path / "lower.json", epochs[0], design)
    fallen = plain["net_m3"] - lower["net_m3"]
    assert fallen == pytest.approx(0.5 * plain["area_m2"], rel=1e-6)
    assert any("-0.5" in note["en"] for note in lower["notes"])


def test_a_shift_is_told_and_corrected_where_asked_for(
    epochs: tuple[Path, Path], tmp_path: Path
) -> None:
    moved = write_epoch(tmp_path / "moved.laz", is_later=True, moved=(0.0, 0.0, 0.05))
    off = reported(tmp_path / "off.json", epochs[0], moved)
    assert off["registration"]["shift_m"][2] == pytest.approx(0.05, abs=0.003)
    assert any("not corrected" in note["en"] for note in off["notes"])
    right = reported(tmp_path / "right.json", epochs[0], moved, "correct_shift=true")
    assert right["registration"]["is_corrected"]
    assert right["net_m3"] == pytest.approx(-PIT_M3, rel=0.05)


def test_what_does_not_fit_is_refused_in_a_line(
    epochs: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before, after = epochs
    far = write_epoch(tmp_path / "far.laz", moved=(500.0, 0.0, 0.0))
    other = write_epoch(tmp_path / "other.laz", crs=6676)
    ten = write_epoch(tmp_path / "ten.laz", count=10)
    high = write_epoch(tmp_path / "high.laz", moved=(0.0, 0.0, 37.0))
    assert "in common" in refused(tmp_path, capsys, "--before", before, "--after", far)
    assert "reference system" in refused(tmp_path, capsys, "--before", before, "--after", other)
    assert "ten" in refused(tmp_path, capsys, "--before", before, "--after", ten)
    assert "datum" in refused(tmp_path, capsys, "--before", before, "--after", high)
    assert "--after" in refused(tmp_path, capsys, "--before", before)
    both = ("--before", before, "--after", after)
    assert ".json" in refused(tmp_path, capsys, *both, name="out.txt")
    for setting in ("map=x.png", "report=x.doc", "boundary=x.txt", "grid_m=7"):
        refused(tmp_path, capsys, *both, "--set", setting)


def test_boundaries_that_are_no_area_of_the_site_are_refused(
    epochs: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    both = ("--before", epochs[0], "--after", epochs[1])
    crossed = [[2.0, 2.0], [10.0, 10.0], [10.0, 2.0], [2.0, 10.0]]
    write_polygon(tmp_path / "crossed.geojson", crossed)
    write_polygon(tmp_path / "far.geojson", [[90.0, 90.0], [99.0, 90.0], [99.0, 99.0]])
    for name in ("crossed", "far"):
        words = f"boundary={tmp_path / name}.geojson"
        refused(tmp_path, capsys, *both, "--set", words)


def test_designs_without_triangles_or_with_many_are_refused(
    epochs: tuple[Path, Path], tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    many = write_design(tmp_path / "many.xml", "計画面", "上の面")
    line = refused(tmp_path, capsys, "--before", epochs[0], "--after", many)
    assert "計画面" in line
    assert "many.xml#" in line
    refused(tmp_path, capsys, "--before", epochs[0], "--after", f"{many}#下の面")
    none = tmp_path / "none.xml"
    none.write_text('<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2"/>')
    refused(tmp_path, capsys, "--before", epochs[0], "--after", none)


def test_a_delivered_file_is_never_written_over(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    before, after = (
        write_epoch(tmp_path / name, is_later=later)
        for name, later in (("a.laz", False), ("b.laz", True))
    )
    corners = [[3.0, 3.0], [17.0, 3.0], [17.0, 16.0]]
    boundary = write_polygon(tmp_path / "boundary.json", corners)
    taken = tmp_path / "taken.pdf"
    taken.hardlink_to(after)
    held = [path.read_bytes() for path in (before, boundary, taken)]
    both = ("--before", before, "--after", after, "--set", f"boundary={boundary}")
    refused(tmp_path, capsys, *both, name=boundary.name)
    # The map is not written either where the report can't be.
    settings = ("--set", f"map={tmp_path / 'map.tif'}", "--set", f"report={taken}")
    refused(tmp_path, capsys, *both, *settings)
    assert [path.read_bytes() for path in (before, boundary, taken)] == held


def test_stopped_work_leaves_nothing(
    epochs: tuple[Path, Path], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stop(*_: object, **__: object) -> None:
        raise Cancelled

    monkeypatch.setattr("processing.operations.volume.compare", stop)
    both = ("--before", epochs[0], "--after", epochs[1])
    assert run(tmp_path / "out.json", *both) == CANCELLED
    assert list(tmp_path.iterdir()) == []
