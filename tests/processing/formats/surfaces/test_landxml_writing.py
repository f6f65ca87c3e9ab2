"""LandXML as it is written: valid, read back to the last digit written, whole or not at all."""

from __future__ import annotations

from dataclasses import replace
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from lxml import etree

from processing.core.errors import Cancelled, InUse, Unsuitable
from processing.formats.surfaces.landxml import read_landxml
from processing.formats.surfaces.landxml_writing import (
    LandXmlFacts,
    LandXmlForm,
    WrittenSurface,
    write_landxml,
)
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.sections.drawing_parts import DrawnSection, SectionedLine
from tests.monitors import CancelledAfter

SPACE = {"l": "http://www.landxml.org/schema/LandXML-1.2"}
FACTS = LandXmlFacts(
    '○○造成工事 <1工区> & "東"',
    "EPSG:6677",
    "JGD2024",
    written_at=datetime(2026, 11, 21, 10, 0, 0, tzinfo=UTC),
)
SURFACE = TriangleSurface(
    np.array(
        [
            [-8000.0004, -36000.1234, 12.3],
            [0.0, 0.0, 0.0],  # of no triangle
            [-7990.0, -36000.0, 12.2],
            [-8000.0, -35990.0, -0.0001],
            [-7990.0, -35990.0, 12.5],
        ]
    ),
    np.array([[0, 2, 3], [2, 4, 3]]),
    "現況",
)
BREAKLINE = np.array([[-8000.0, -36000.0, 12.3], [-7990.0, -35990.0, 12.5]])
NO = np.nan
LINE = SectionedLine(
    "中心線",
    np.array([[-8000.0, -36000.0], [-8000.0, -36000.0], [-7960.0, -35970.0], [-7960.0, -35900.0]]),
    -20.0,
    (
        DrawnSection(
            0.0,
            "No.0",
            np.array([-5.0, -2.5, 0.0, 2.5, 5.0, 7.5]),
            np.array([12.0, 12.1, NO, 12.2, 12.3, NO]),
            np.array([11.0, 11.0, 11.0, 11.0, 11.0, 11.0]),
            3.0,
            0.0,
        ),
        DrawnSection(
            20.0, "No.1", np.array([-1.0, 1.0]), np.array([NO, NO]), np.array([1.0, NO]), 0.0, 0.0
        ),
    ),
)


def schema() -> Any:
    path = Path(__file__).with_name("landxml_as_written.rng")
    return etree.RelaxNG(etree.parse(path))


def written(
    path: Path,
    *surfaces: WrittenSurface,
    facts: LandXmlFacts = FACTS,
    line: SectionedLine | None = None,
    form: LandXmlForm = "J-LandXML",
) -> Any:
    """The file's root, once its schema found no fault."""
    write_landxml(
        path, surfaces or [WrittenSurface(SURFACE)], facts, lines=(line,) if line else (), form=form
    )
    tree = etree.parse(path)
    schema().assertValid(tree)
    return tree.getroot()


@pytest.mark.parametrize("form", ["J-LandXML", "LandXML"])
@pytest.mark.parametrize("line", [None, LINE])
def test_both_forms_are_valid_and_come_back(
    tmp_path: Path, form: LandXmlForm, line: SectionedLine | None
) -> None:
    surface = WrittenSurface(SURFACE, breaklines=(BREAKLINE,))
    written(tmp_path / "a.xml", surface, line=line, form=form)
    found = read_landxml(tmp_path / "a.xml")
    assert (found.crs, found.height_datum) == ("EPSG:6677", "T.P")
    one = found.only()
    assert one.surface.name == "現況"
    expected = np.round(SURFACE.xyz[SURFACE.corners], 3)
    assert one.surface.xyz[one.surface.corners].tolist() == expected.tolist()
    lines = [line.tolist() for line in one.breaklines]
    assert lines == ([BREAKLINE.tolist()] if form == "LandXML" else [])


def test_j_landxml_says_what_its_rules_ask_for(tmp_path: Path) -> None:
    root = written(tmp_path / "a.xml", WrittenSurface(SURFACE, breaklines=(BREAKLINE,)))
    properties = {
        one.get("label"): one.get("value")
        for one in root.findall("l:Project/l:Feature/l:Property", SPACE)
    }
    assert properties == {"projectPhase": "測量", "applicationCriterion": "MlitLandXmlVer.1.7"}
    assert root.find("l:Project", SPACE).get("name") == FACTS.project
    assert (root.get("date"), root.get("time")) == ("2026-11-21", "10:00:00")
    assert dict(root.find("l:CoordinateSystem", SPACE).attrib) == {
        "name": "CRS1",
        "horizontalDatum": "JGD2011",
        "horizontalCoordinateSystemName": "9(X,Y)",
        "verticalDatum": "T.P",
        "desc": "JGD2024",
    }
    surface = root.find("l:Surfaces/l:Surface", SPACE)
    assert surface.get("desc") == "ExistingGround"
    assert surface.find("l:SourceData", SPACE) is None
    points = surface.findall(".//l:P", SPACE)
    # X is the northing; the point that no triangle has is left out, zero has no sign.
    assert [(one.get("id"), one.text) for one in points] == [
        ("1", "-36000.123 -8000.000 12.300"),
        ("2", "-36000.000 -7990.000 12.200"),
        ("3", "-35990.000 -8000.000 0.000"),
        ("4", "-35990.000 -7990.000 12.500"),
    ]


def test_the_line_and_its_sections_are_an_alignment(tmp_path: Path) -> None:
    root = written(tmp_path / "a.xml", line=LINE)
    alignment = root.find("l:Alignments/l:Alignment", SPACE)
    assert dict(alignment.attrib) == {"name": "中心線", "length": "120.000", "staStart": "-20.000"}
    lines = alignment.findall("l:CoordGeom/l:Line", SPACE)
    assert [
        (one.get("length"), *((end.get("name"), end.text) for end in one)) for one in lines
    ] == [
        ("50.000", ("BP", "-36000.000 -8000.000"), ("IP.1", "-35970.000 -7960.000")),
        ("70.000", ("IP.1", "-35970.000 -7960.000"), ("EP", "-35900.000 -7960.000")),
    ]
    first, second = alignment.findall("l:CrossSects/l:CrossSect", SPACE)
    assert (first.get("name"), first.get("sta")) == ("No.0", "0.000")
    grounds = {one.get("name"): [part.text for part in one] for one in first}
    assert grounds == {
        # Where ground is missing, the list is cut in two.
        "ExistingGround": ["-5.000 12.000 -2.500 12.100", "2.500 12.200 5.000 12.300"],
        "MeasuredGround": [
            "-5.000 11.000 -2.500 11.000 0.000 11.000 2.500 11.000 5.000 11.000 7.500 11.000"
        ],
    }
    assert (second.get("name"), len(second)) == ("No.1", 0)


def test_sections_alone_are_a_file_too(tmp_path: Path) -> None:
    write_landxml(tmp_path / "a.xml", [], FACTS, lines=[LINE])
    tree = etree.parse(tmp_path / "a.xml")
    schema().assertValid(tree)
    assert tree.find("l:Surfaces", SPACE) is None


def test_names_are_made_to_differ(tmp_path: Path) -> None:
    nameless = replace(SURFACE, name="")
    surfaces = [WrittenSurface(one) for one in (SURFACE, SURFACE, nameless, nameless)]
    root = written(tmp_path / "a.xml", *surfaces)
    names = [one.get("name") for one in root.findall("l:Surfaces/l:Surface", SPACE)]
    assert names == ["現況", "現況 (2)", "TIN 3", "TIN 4"]


@pytest.mark.parametrize("name", ['a"b', "a\nb", "<&>", "\0\x1b\ud800", "𠮷野家", "'"])
def test_any_name_can_be_written(tmp_path: Path, name: str) -> None:
    written(tmp_path / "a.xml", WrittenSurface(replace(SURFACE, name=name)))
    read = read_landxml(tmp_path / "a.xml").only().surface.name
    assert read == name.replace("\0", "\ufffd").replace("\x1b", "\ufffd").replace(
        "\ud800", "\ufffd"
    )


@pytest.mark.parametrize(
    ("crs", "zone"), [("EPSG:6669", "1(X,Y)"), ("EPSG:6687", "19(X,Y)"), ("EPSG:2451", "9(X,Y)")]
)
def test_zones_are_named_and_read_back(tmp_path: Path, crs: str, zone: str) -> None:
    root = written(tmp_path / "a.xml", facts=replace(FACTS, crs=crs))
    system = root.find("l:CoordinateSystem", SPACE)
    assert system.get("horizontalCoordinateSystemName") == zone
    assert read_landxml(tmp_path / "a.xml").crs == crs


@pytest.mark.parametrize("crs", ["", "EPSG:32654", "EPSG:6688", "EPSG:6668"])
def test_other_systems_are_for_plain_landxml_alone(tmp_path: Path, crs: str) -> None:
    facts = replace(FACTS, crs=crs, height_datum="")
    with pytest.raises(Unsuitable, match="19 plane rectangular systems"):
        write_landxml(tmp_path / "a.xml", [WrittenSurface(SURFACE)], facts)
    assert not list(tmp_path.iterdir())
    written(tmp_path / "a.xml", facts=facts, form="LandXML")
    found = read_landxml(tmp_path / "a.xml")
    assert (found.crs, found.height_datum) == (crs, "")


def test_what_is_no_surface_is_refused(tmp_path: Path) -> None:
    with pytest.raises(Unsuitable, match="neither a surface nor a section"):
        write_landxml(tmp_path / "a.xml", [], FACTS)
    none = replace(SURFACE, corners=np.empty((0, 3), np.int64))
    hole = replace(SURFACE, xyz=np.where(SURFACE.xyz == 12.5, np.nan, SURFACE.xyz))
    for surface in (none, hole):
        with pytest.raises(Unsuitable, match="no triangles, or a corner of one is no place"):
            write_landxml(tmp_path / "a.xml", [WrittenSurface(surface)], FACTS)
    assert not list(tmp_path.iterdir())


def test_a_cancel_leaves_what_was_there(tmp_path: Path) -> None:
    path = tmp_path / "a.xml"
    path.write_text("before")
    with pytest.raises(Cancelled):
        write_landxml(path, [WrittenSurface(SURFACE)], FACTS, monitor=CancelledAfter())
    assert [one.name for one in tmp_path.iterdir()] == ["a.xml"]
    assert path.read_text() == "before"
    with pytest.raises(InUse):
        write_landxml(path, [WrittenSurface(SURFACE)], FACTS, never=[path])


coordinate = st.floats(-200_000, 200_000, allow_nan=False, width=64)


@given(
    st.lists(st.tuples(coordinate, coordinate, coordinate), min_size=3, max_size=3),
    st.integers(0, 6),
)
def test_a_round_trip_is_exact_to_the_digits_written(
    tmp_path_factory: pytest.TempPathFactory, positions: list[tuple[float, ...]], decimals: int
) -> None:
    xyz = np.array(positions)
    xyz[:, :2] += [[0, 0], [1_000_000, 0], [0, 1_000_000]]  # so that it has an area
    surface = TriangleSurface(xyz, np.array([[2, 0, 1]]), "a")
    path = tmp_path_factory.mktemp("trip") / "a.xml"
    facts = replace(FACTS, decimals=decimals)
    write_landxml(path, [WrittenSurface(surface)], facts)
    read = read_landxml(path).only().surface
    assert read.xyz[read.corners[0]].tolist() == np.round(xyz[[2, 0, 1]], decimals).tolist()
