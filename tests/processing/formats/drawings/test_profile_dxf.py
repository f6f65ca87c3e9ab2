"""A profile's DXF is read back by another program: ground line, heights, grid and texts."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest

from processing.core.errors import InUse, OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.drawings.profile_dxf import (
    GRID_LAYER,
    GROUND_LAYER,
    POINT_LAYER,
    TEXT_LAYER,
    TITLE_LAYER,
    ProfileStyle,
    write_profile_dxf,
)
from processing.section.cut import Cut
from processing.section.profile import Crossing, SectionProfile

DATUM = 99.0
"""The lowest height is 99.9 m: half a metre below it, rounded down to a line of the grid."""

GROUND = np.array([[-4.0, 100.15], [-2.01, 100.15], [-1.99, 100.0], [6.3, 99.9]])
PROFILE = SectionProfile(
    cut=Cut((-11_394.608, -35_139.915, 102.0), (0.0, 1.0), 1.0, 15.0),
    ground=(GROUND, np.array([[7.0, 100.0], [7.4, 100.1]])),
    points=np.array([[0.0, 100.01], [1.0, 150.0]]),
    crossings=(Crossing(Text("Curb", "縁石"), "2101_縁石", 30, -2.0, 100.15),),
    station_m=45.25,
    title=Text("Across the trajectory", "走行軌跡の横断"),
)


def drawn(path: Path, look: ProfileStyle | None = None, profile: SectionProfile = PROFILE) -> Any:
    write_profile_dxf(path, profile, look)
    doc = ezdxf.filemanagement.readfile(path)
    audit = doc.audit()
    assert [one.message for one in (*audit.errors, *audit.fixes)] == []
    return doc


def texts(doc: Any, layer: str) -> list[str]:
    return [text.dxf.text for text in doc.modelspace().query(f'TEXT[layer=="{layer}"]')]


@pytest.mark.parametrize("exaggeration", [1.0, 2.0, 10.0])
def test_the_ground_line_is_in_metres_above_the_datum(tmp_path: Path, exaggeration: float) -> None:
    doc = drawn(tmp_path / "profile.dxf", ProfileStyle(exaggeration=exaggeration))
    first, second = doc.modelspace().query(f'LWPOLYLINE[layer=="{GROUND_LAYER}"]')
    datum = next(float(one[3:]) for one in texts(doc, TEXT_LAYER) if one.startswith("DL="))
    positions = np.array([position[:2] for position in first.get_points()])
    assert positions[:, 0] == pytest.approx(GROUND[:, 0])
    assert positions[:, 1] / exaggeration + datum == pytest.approx(GROUND[:, 1])
    assert len(second) == 2
    assert doc.units == 6  # metres


def test_heights_are_written_at_the_lines_of_the_grid(tmp_path: Path) -> None:
    doc = drawn(tmp_path / "profile.dxf", ProfileStyle(scale=100))
    found = {
        (round(text.dxf.align_point.x, 6), text.dxf.text)
        for text in doc.modelspace().query(f'TEXT[layer=="{TEXT_LAYER}"]')
        if text.dxf.rotation == 90.0
    }
    assert {(-3.0, "100.150"), (0.0, "99.976"), (7.0, "100.000")} <= found
    assert not any(x == 8.0 for x, _ in found), "beyond its end there is no ground"
    written = texts(doc, TEXT_LAYER)
    assert {"DL=99", "100", "101", "離れ", "地盤高", "-4", "8"} <= set(written)
    lines = doc.modelspace().query(f'LINE[layer=="{GRID_LAYER}"]')
    level = [line for line in lines if line.dxf.start.y == line.dxf.end.y]
    assert sorted(round(line.dxf.start.y + DATUM, 6) for line in level) == [99.0, 100.0, 101.0]


def test_what_crosses_stands_on_the_layer_of_its_kind(tmp_path: Path) -> None:
    doc = drawn(tmp_path / "profile.dxf")
    (circle,) = doc.modelspace().query('CIRCLE[layer=="2101_縁石"]')
    assert (circle.dxf.center.x, circle.dxf.center.y + DATUM) == pytest.approx((-2.0, 100.15))
    assert texts(doc, "2101_縁石") == ["縁石 100.150"]
    assert doc.layers.get("2101_縁石").dxf.color == 30


def test_points_are_drawn_within_the_frame_or_not_at_all(tmp_path: Path) -> None:
    query = f'POINT[layer=="{POINT_LAYER}"]'
    (point,) = drawn(tmp_path / "with.dxf").modelspace().query(query)
    assert point.dxf.location.y + DATUM == pytest.approx(100.01)
    without = drawn(tmp_path / "without.dxf", ProfileStyle(has_points=False))
    assert not without.modelspace().query(query)


@pytest.mark.parametrize("version", ["R2000", "R2018"])
def test_the_title_says_where_and_how_in_both_versions(tmp_path: Path, version: Any) -> None:
    doc = drawn(tmp_path / "profile.dxf", ProfileStyle(exaggeration=2.0, version=version))
    title = " ".join(texts(doc, TITLE_LAYER))
    assert "走行軌跡の横断" in title
    assert "測点 45.250 m" in title
    assert "横1:100 縦1:50" in title
    assert "東距 -11394.608 北距 -35139.915" in title
    assert "方位角 0.0000°" in title
    assert (tmp_path / "profile.dxf").read_bytes().count(b"\r\n") > 100


def test_it_speaks_english_too(tmp_path: Path) -> None:
    doc = drawn(tmp_path / "profile.dxf", ProfileStyle(language="en"))
    assert "Across the trajectory" in texts(doc, TITLE_LAYER)
    assert texts(doc, "2101_縁石") == ["Curb 100.150"]


def test_a_section_without_ground_is_refused_and_nothing_is_written(tmp_path: Path) -> None:
    empty = SectionProfile(PROFILE.cut, (), np.empty((0, 2)))
    with pytest.raises(Unsuitable):
        write_profile_dxf(tmp_path / "profile.dxf", empty)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(("scale", "exaggeration"), [(0, 1.0), (100, 0.0), (100, float("nan"))])
def test_a_scale_that_cannot_be_is_refused(tmp_path: Path, scale: int, exaggeration: float) -> None:
    with pytest.raises(OutOfRange):
        write_profile_dxf(
            tmp_path / "p.dxf", PROFILE, ProfileStyle(scale=scale, exaggeration=exaggeration)
        )


def test_a_layer_that_cp932_lacks_is_refused_for_r2000(tmp_path: Path) -> None:
    foreign = Crossing(Text.same("x"), "层", 7, 0.0, 100.0)
    profile = SectionProfile(PROFILE.cut, PROFILE.ground, PROFILE.points, (foreign,))
    with pytest.raises(Unsuitable):
        write_profile_dxf(tmp_path / "p.dxf", profile, ProfileStyle(version="R2000"))


def test_an_input_is_never_overwritten(tmp_path: Path) -> None:
    delivered = tmp_path / "street.dxf"
    delivered.write_text("as it was")
    with pytest.raises(InUse):
        write_profile_dxf(delivered, PROFILE, never=[delivered])
    assert delivered.read_text() == "as it was"
