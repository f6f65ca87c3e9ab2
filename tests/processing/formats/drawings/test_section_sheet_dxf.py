"""Sections of a volume, read back by another program: grounds, areas, grid, sheet."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest
import shapely

from processing.core.errors import Cancelled, InUse, OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.drawings.dxf_document import PlanVersion
from processing.formats.drawings.section_sheet_dxf import (
    AFTER_LAYER,
    BEFORE_LAYER,
    CUT_LAYER,
    FILL_LAYER,
    TEXT_LAYER,
    TITLE_LAYER,
    SectionStyle,
    write_section_sheet_dxf,
)
from processing.methods.earthwork.sections.drawing_parts import DrawnSection
from tests.monitors import CancelledAfter

NO = np.nan
OFFSETS = np.array([-6.0, -3.0, 0.0, 3.0, 6.0])
TITLE = Text("Sections", "横断図")


def section(number: int, base: float = 100.0) -> DrawnSection:
    """A cut of 1 m between −3 and 3, a fill of half a metre at the right end."""
    before = np.full(5, base + number)
    after = before + np.array([0.0, -1.0, -1.0, 0.0, 0.5])
    return DrawnSection(20.0 * number, f"No.{number}", OFFSETS, before, after, 6.0, 0.75)


SECTIONS = [section(number) for number in range(5)]


def drawn(path: Path, sections: list[DrawnSection], look: SectionStyle | None = None) -> Any:
    write_section_sheet_dxf(path, sections, TITLE, look)
    doc = ezdxf.filemanagement.readfile(path)
    audit = doc.audit()
    assert [one.message for one in (*audit.errors, *audit.fixes)] == []
    return doc


def lines(doc: Any, layer: str) -> list[np.ndarray]:
    found = doc.modelspace().query(f'LWPOLYLINE[layer=="{layer}"]')
    return [np.array([position[:2] for position in one.get_points()]) for one in found]


def texts(doc: Any, layer: str) -> list[Any]:
    return list(doc.modelspace().query(f'TEXT[layer=="{layer}"]'))


def position_of(text: Any) -> np.ndarray:
    _, position, _ = text.get_placement()
    return np.array([position.x, position.y])


@pytest.mark.parametrize("exaggeration", [1.0, 5.0])
def test_both_grounds_stand_where_grid_and_datum_say(tmp_path: Path, exaggeration: float) -> None:
    look = SectionStyle(scale=100, exaggeration=exaggeration)
    doc = drawn(tmp_path / "a.dxf", [section(3)], look)
    (datum,) = [one for one in texts(doc, TEXT_LAYER) if one.dxf.text.startswith("DL=")]
    (zero,) = [one for one in texts(doc, TEXT_LAYER) if one.dxf.text == "0"]
    origin = np.array([position_of(zero)[0], position_of(datum)[1]])
    for layer, heights in ((BEFORE_LAYER, section(3).before), (AFTER_LAYER, section(3).after)):
        (line,) = lines(doc, layer)
        offset, height = (line - origin).T
        assert offset == pytest.approx(OFFSETS)
        assert height / exaggeration + float(datum.dxf.text[3:]) == pytest.approx(heights)


def test_cut_and_fill_are_filled_to_their_areas(tmp_path: Path) -> None:
    doc = drawn(tmp_path / "a.dxf", [section(0)])
    found = {
        hatch.dxf.layer: shapely.Polygon(
            [vertex[:2] for vertex in hatch.paths.paths[0].vertices]
        ).area
        for hatch in doc.modelspace().query("HATCH")
    }
    assert found == pytest.approx({CUT_LAYER: 6.0, FILL_LAYER: 0.75})


def test_each_section_is_named_with_its_areas(tmp_path: Path) -> None:
    for version in ("R2000", "R2018"):
        doc = drawn(tmp_path / "a.dxf", SECTIONS, SectionStyle(version=version))
        words = [one.dxf.text for one in texts(doc, TEXT_LAYER)]
        assert "No.3 （測点 60.00 m）" in words
        square = "m2" if version == "R2000" else "m²"
        assert words.count(f"切土 6.00 {square} 盛土 0.75 {square}") == 5


@pytest.mark.parametrize("version", ["R2000", "R2018"])
@pytest.mark.parametrize("language", ["en", "ja"])
def test_the_sheet_says_title_scales_and_lines(
    tmp_path: Path, version: PlanVersion, language: Any
) -> None:
    look = SectionStyle(scale=200, exaggeration=2.0, version=version, language=language)
    doc = drawn(tmp_path / "a.dxf", SECTIONS, look)
    words = [one.dxf.text for one in texts(doc, TITLE_LAYER)]
    if language == "en":
        assert words == ["Before", "After", "Horizontal 1:200, vertical 1:100", "Sections"]
    else:
        assert words == ["着手前", "施工後", "縮尺 横1:200 縦1:100", "横断図"]
    assert doc.header["$DWGCODEPAGE"] == "ANSI_932"
    assert {one.dxf.height for one in texts(doc, TEXT_LAYER)} == {0.0025 * 200}


@pytest.mark.parametrize("count", [1, 2, 5, 23])
def test_sections_share_no_room_and_go_up_the_columns(tmp_path: Path, count: int) -> None:
    doc = drawn(tmp_path / "a.dxf", [section(number) for number in range(count)])
    names = [one for one in texts(doc, TEXT_LAYER) if one.dxf.text.startswith("No.")]
    positions = np.array([position_of(one) for one in names])
    assert np.lexsort((positions[:, 1], positions[:, 0])).tolist() == list(range(count))
    boxes = [
        shapely.box(
            *np.min([before.min(0), after.min(0)], 0), *np.max([before.max(0), after.max(0)], 0)
        )
        for before, after in zip(lines(doc, BEFORE_LAYER), lines(doc, AFTER_LAYER), strict=True)
    ]
    tree = shapely.STRtree(boxes)
    assert len(tree.query(boxes, "intersects").T) == count


def test_ground_that_is_missing_interrupts_a_line(tmp_path: Path) -> None:
    holed = DrawnSection(
        0.0, "No.0", OFFSETS, np.array([1.0, 1.0, NO, 1.0, 1.0]), np.full(5, NO), 0.0, 0.0
    )
    doc = drawn(tmp_path / "a.dxf", [holed])
    assert [len(one) for one in lines(doc, BEFORE_LAYER)] == [2, 2]
    assert lines(doc, AFTER_LAYER) == []


def test_a_section_without_ground_is_left_out_and_none_at_all_refused(tmp_path: Path) -> None:
    empty = DrawnSection(0.0, "No.0", OFFSETS, np.full(5, NO), np.full(5, NO), 0.0, 0.0)
    doc = drawn(tmp_path / "a.dxf", [empty, section(1)])
    assert not any("No.0" in one.dxf.text for one in texts(doc, TEXT_LAYER))
    for sections in ([], [empty]):
        with pytest.raises(Unsuitable, match="No section has ground"):
            write_section_sheet_dxf(tmp_path / "b.dxf", sections, TITLE)


@pytest.mark.parametrize("look", [SectionStyle(scale=-1), SectionStyle(exaggeration=0.0),
                                  SectionStyle(exaggeration=float("nan"))])  # fmt: skip
def test_a_scale_that_is_none_is_refused(tmp_path: Path, look: SectionStyle) -> None:
    with pytest.raises(OutOfRange):
        write_section_sheet_dxf(tmp_path / "a.dxf", SECTIONS, TITLE, look)
    assert not list(tmp_path.iterdir())


def test_a_cancel_leaves_nothing_and_inputs_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.dxf"
    with pytest.raises(Cancelled):
        write_section_sheet_dxf(path, SECTIONS, TITLE, monitor=CancelledAfter())
    assert not list(tmp_path.iterdir())
    path.touch()
    with pytest.raises(InUse):
        write_section_sheet_dxf(path, SECTIONS, TITLE, never=[path])
