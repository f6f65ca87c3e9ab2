"""Designs as CAD programs export them: what is read, and what each damage is told by."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import BadFile, Cancelled, MissingInput, OutOfRange, Unsuitable
from processing.formats.surfaces.landxml import LandXmlFile, read_landxml
from tests.monitors import CancelledAfter

POINTS = """
<P id="7">-36000.000 -8000.000 12.300</P>
<P id="12">-36000.000 -7990.000 12.200</P>
<P id="3">-35990.000 -8000.000 12.400</P>
<P id="40">-35990.000 -7990.000 12.500</P>
"""
FACES = "<F>7 12 3</F>\n<F>12 40 3</F>"
METRIC = '<Units><Metric linearUnit="meter"/></Units>'


def surface(points: str = POINTS, faces: str = FACES, name: str = "G1", more: str = "") -> str:
    return (
        f'<Surface name="{name}" desc="ExistingGround">{more}<Definition surfType="TIN">'
        f"<Pnts>{points}</Pnts>\n<Faces>{faces}</Faces></Definition></Surface>"
    )


def document(*surfaces: str, head: str = METRIC, encoding: str = "UTF-8") -> str:
    return (
        f'<?xml version="1.0" encoding="{encoding}"?>\n'
        '<LandXML xmlns="http://www.landxml.org/schema/LandXML-1.2" version="1.2">\n'
        f"{head}<Surfaces>{''.join(surfaces)}</Surfaces></LandXML>"
    )


def read(tmp_path: Path, words: str, *, name: str = "") -> LandXmlFile:
    (tmp_path / "design.xml").write_text(words, "utf-8")
    return read_landxml(tmp_path / "design.xml", surface=name)


def test_points_are_easting_northing_height_and_ids_may_be_any(tmp_path: Path) -> None:
    one = read(tmp_path, document(surface())).only()
    corners = one.surface.xyz[one.surface.corners]
    assert corners.tolist() == [
        [[-8000.0, -36000.0, 12.3], [-7990.0, -36000.0, 12.2], [-8000.0, -35990.0, 12.4]],
        [[-7990.0, -36000.0, 12.2], [-7990.0, -35990.0, 12.5], [-8000.0, -35990.0, 12.4]],
    ]
    assert one.surface.corners.dtype == np.int64
    assert (one.surface.name, one.description) == ("G1", "ExistingGround")


def test_invisible_faces_and_those_without_area_in_plan_are_left_out_and_counted(
    tmp_path: Path,
) -> None:
    upright = '<P id="50">-36000.000 -8000.000 15.000</P>'
    faces = '<F n="2 0 0">7 12 3</F><F i="1">12 40 3</F><F>7 12 50</F><F>7 7 3</F>'
    one = read(tmp_path, document(surface(POINTS + upright, faces))).only()
    assert len(one.surface.corners) == 1
    assert (one.invisible, one.flat) == (1, 2)
    # A corner of no face that is left would stretch the extent.
    assert len(one.surface.xyz) == 3


def test_break_lines_belong_to_their_surface(tmp_path: Path) -> None:
    lines = (
        "<SourceData><Breaklines><Breakline brkType='standard'><PntList3D>"
        "-36000 -8000 12.3 -35990 -7990 12.5</PntList3D></Breakline></Breaklines></SourceData>"
    )
    both = read(tmp_path, document(surface(more=lines), surface(name="G2"))).surfaces
    (line,) = both[0].breaklines
    assert line.tolist() == [[-8000.0, -36000.0, 12.3], [-7990.0, -35990.0, 12.5]]
    assert both[1].breaklines == ()


@pytest.mark.parametrize(
    ("names", "crs"),
    [
        ('horizontalDatum="JGD2011" horizontalCoordinateSystemName="9(X,Y)"', "EPSG:6677"),
        ('horizontalDatum="JGD2024" horizontalCoordinateSystemName="19(X,Y)"', "EPSG:6687"),
        ('horizontalDatum="JGD2000" horizontalCoordinateSystemName="1(X,Y)"', "EPSG:2443"),
        ('horizontalDatum="TD" horizontalCoordinateSystemName="２（X，Y）"', "EPSG:30162"),
        ('horizontalCoordinateSystemName="第8系"', "EPSG:6676"),
        ('epsgCode="6675"', "EPSG:6675"),
        ('epsgCode="EPSG:6675" horizontalCoordinateSystemName="8(X,Y)"', "EPSG:6675"),
        ('horizontalDatum="WGS84" horizontalCoordinateSystemName="9(X,Y)"', ""),
        ('horizontalCoordinateSystemName="20(X,Y)"', ""),
        ('name="somewhere"', ""),
    ],
)
def test_the_coordinate_system_is_known_by_zone_or_code(
    tmp_path: Path, names: str, crs: str
) -> None:
    head = f'{METRIC}<CoordinateSystem {names} verticalDatum="T.P"/>'
    found = read(tmp_path, document(surface(), head=head))
    assert (found.crs, found.height_datum, found.zero_above_tp_m) == (crs, "T.P", 0.0)


def test_heights_above_another_zero_say_how_it_lies(tmp_path: Path) -> None:
    head = (
        '<CoordinateSystem verticalDatum="Y.P"><Feature><Property label="differTP" '
        'value="-0.8402"/></Feature></CoordinateSystem>'
    )
    found = read(tmp_path, document(surface(), head=head))
    assert (found.height_datum, found.zero_above_tp_m) == ("Y.P", -0.8402)
    with pytest.raises(BadFile, match="differTP"):
        read(tmp_path, document(surface(), head=head.replace("-0.8402", "－0.8")))


@pytest.mark.parametrize(
    ("units", "across", "up"),
    [
        ('<Metric linearUnit="millimeter"/>', 1e-3, 1e-3),
        ('<Imperial linearUnit="foot"/>', 0.3048, 0.3048),
        ('<Imperial linearUnit="USSurveyFoot"/>', 1200 / 3937, 1200 / 3937),
        ('<Imperial linearUnit="USSurveyFoot" elevationUnit="feet"/>', 1200 / 3937, 1200 / 3937),
        ('<Imperial linearUnit="foot" elevationUnit="meter"/>', 0.3048, 1.0),
    ],
)
def test_other_units_become_metres(tmp_path: Path, units: str, across: float, up: float) -> None:
    one = read(tmp_path, document(surface(), head=f"<Units>{units}</Units>")).only()
    first = one.surface.xyz[one.surface.corners[0, 0]]
    assert first == pytest.approx([-8000.0 * across, -36000.0 * across, 12.3 * up], rel=1e-14)


def test_an_unknown_unit_is_refused(tmp_path: Path) -> None:
    with pytest.raises(BadFile, match="“shaku” is not known"):
        read(tmp_path, document(surface(), head='<Units><Metric linearUnit="shaku"/></Units>'))


@pytest.mark.parametrize("spelling", ["Shift_JIS", "shift-jis", "Windows-31J", "EUC-JP"])
def test_japanese_encodings_are_read(tmp_path: Path, spelling: str) -> None:
    words = document(surface(name="①計画面"), encoding=spelling)
    codec = "euc_jis_2004" if spelling == "EUC-JP" else "cp932"
    words = words.replace("①", "") if spelling == "EUC-JP" else words
    (tmp_path / "a.xml").write_bytes(words.encode(codec))
    assert read_landxml(tmp_path / "a.xml").only().surface.name.endswith("計画面")


@pytest.mark.parametrize("codec", ["utf-8-sig", "utf-16", "utf-16-le", "utf-16-be"])
def test_unicode_is_known_by_its_first_bytes(tmp_path: Path, codec: str) -> None:
    words = document(surface(name="計画"), encoding="UTF-16" if "16" in codec else "UTF-8")
    (tmp_path / "a.xml").write_bytes(words.encode(codec))
    assert read_landxml(tmp_path / "a.xml").only().surface.name == "計画"


def test_a_file_that_names_utf_16_and_is_utf_8_is_read(tmp_path: Path) -> None:
    words = document(surface(name="計画"), encoding="utf-16")
    assert read(tmp_path, words).only().surface.name == "計画"


@pytest.mark.parametrize("encoding", ["UTF-8", "klingon", "base64", "zip", "undefined"])
def test_an_encoding_that_is_not_the_named_one_is_told(tmp_path: Path, encoding: str) -> None:
    (tmp_path / "a.xml").write_bytes(
        document(surface(name="計画"), encoding=encoding).encode("cp932")
    )
    with pytest.raises(BadFile, match=f"not in the encoding that it names .{encoding.lower()}"):
        read_landxml(tmp_path / "a.xml")


def test_a_prefix_for_the_namespace_changes_nothing(tmp_path: Path) -> None:
    words = document(surface()).replace("</", "</lx:").replace("<", "<lx:")
    words = words.replace("<lx:/lx:", "</lx:").replace("<lx:?", "<?")
    words = words.replace("xmlns=", "xmlns:lx=")
    assert len(read(tmp_path, words).only().surface.corners) == 2


@pytest.mark.parametrize(
    ("points", "faces", "message"),
    [
        (POINTS, "<F>7 12 3</F>\n<F>7 12 99</F>", r"Face 2 has the point 99.*line 10, surface G1"),
        (
            POINTS.replace("12.500", ""),
            FACES,
            r"Face 2 has the point 40, which has no height.*line 10",
        ),
        (POINTS.replace("-7990.000 12.5", "-7e300 12.5"), FACES, "lies beyond all coordinates"),
        (POINTS.replace("12.300", "12,300"), FACES, r"“12,300” is no number.*line 4.*with a point"),
        (POINTS.replace("12.300", "NaN"), FACES, "“NaN” is no number"),
        (POINTS.replace("12.300", "1_2"), FACES, "“1_2” is no number"),
        (POINTS.replace("-8000.000 12.3", "12.3"), FACES, r"Face 1 has the point 7"),
        (POINTS.replace(" -8000.000 12.3", ",-8000.0,12.3"), FACES, "point 7 has 1 numbers"),
        (POINTS.replace('"12"', '"7"'), FACES, "Two points have the id 7.*line 5"),
        (POINTS.replace('"12"', '"A"'), FACES, "“A” is no number of a point"),
        (POINTS.replace('id="12"', ""), FACES, "“” is no number of a point"),
        (POINTS, "<F>7 12 3 40</F>", r"A face has 4 corners; a TIN has triangles.*line 9"),
        (POINTS, "<F>7 12 3.5</F>", "“3.5” is no number of a point"),
        (POINTS, "<F>7 7 12</F>", "All faces are without area"),
        ("", FACES, "Face 1 has the point 7"),
    ],
)
def test_each_damage_is_one_sentence_with_its_line(
    tmp_path: Path, points: str, faces: str, message: str
) -> None:
    with pytest.raises(BadFile, match=message) as error:
        read(tmp_path, document(surface(points, faces)))
    assert "\n" not in str(error.value)


def test_a_point_without_height_that_no_face_has_is_passed_over(tmp_path: Path) -> None:
    points = POINTS + '<P id="41">1 2</P>'
    assert len(read(tmp_path, document(surface(points))).only().surface.xyz) == 4


def test_of_several_surfaces_one_is_named(tmp_path: Path) -> None:
    words = document(surface(name="路床"), surface(name="路体"))
    with pytest.raises(Unsuitable, match="several surfaces: 路床, 路体"):
        read(tmp_path, words).only()
    assert read(tmp_path, words, name="路体").only().surface.name == "路体"
    with pytest.raises(OutOfRange, match=r"no such surface.*路床, 路体"):
        read(tmp_path, words, name="法面")
    with pytest.raises(OutOfRange, match="Several surfaces have this name"):
        read(tmp_path, document(surface(), surface()), name="G1")


def test_files_without_a_surface_of_triangles_say_what_they_lack(tmp_path: Path) -> None:
    with pytest.raises(Unsuitable, match="no surface"):
        read(tmp_path, document())
    contours = '<Surface name="C"><SourceData><Contours/></SourceData></Surface>'
    with pytest.raises(Unsuitable, match=r"No surface has triangles: C\."):
        read(tmp_path, document(contours))
    grid = surface(faces="<F>7 12 40 3</F>", name="M").replace('"TIN"', '"grid"')
    with pytest.raises(Unsuitable, match=r"No surface has triangles: M\."):
        read(tmp_path, document(grid))
    assert len(read(tmp_path, document(contours, surface())).surfaces) == 1
    hidden = surface(faces='<F i="1">7 12 3</F>')
    with pytest.raises(Unsuitable, match="No surface has triangles"):
        read(tmp_path, document(hidden))


def test_what_is_no_landxml_is_refused(tmp_path: Path) -> None:
    with pytest.raises(MissingInput):
        read_landxml(tmp_path / "none.xml")
    for words in ("", "0.0 1.0 2.0", "{}", "<html", "LASF\0\0"):
        with pytest.raises(BadFile, match="The file is no LandXML"):
            read(tmp_path, words)
    with pytest.raises(BadFile, match="XML, but no LandXML"):
        read(tmp_path, "<svg><Surfaces/></svg>")


def test_a_file_cut_off_anywhere_is_told(tmp_path: Path) -> None:
    words = document(surface())
    for length in range(len(words) - 1, 150, -7):
        with pytest.raises(BadFile, match=r"ends early|damaged"):
            read(tmp_path, words[:length])


def test_a_tag_that_is_closed_by_another_is_damage(tmp_path: Path) -> None:
    with pytest.raises(BadFile, match=r"damaged: mismatched tag\..*line 10"):
        read(tmp_path, document(surface()).replace("</Faces>", "</Face>"))


def test_entities_are_refused_before_they_grow(tmp_path: Path) -> None:
    bomb = '<!DOCTYPE l [<!ENTITY a "aa"><!ENTITY b "&a;&a;">]>'
    words = document(surface(name="&b;")).replace("<LandXML", bomb + "<LandXML")
    with pytest.raises(BadFile, match="document type"):
        read(tmp_path, words)


def test_a_reading_can_be_stopped(tmp_path: Path) -> None:
    (tmp_path / "a.xml").write_text(document(surface()))
    with pytest.raises(Cancelled):
        read_landxml(tmp_path / "a.xml", monitor=CancelledAfter())
