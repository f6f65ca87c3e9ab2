"""``zuka map`` takes maps in: what was exported comes back, the rest by code and layer."""

from __future__ import annotations

from contextlib import closing
from pathlib import Path

import ezdxf
import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.map.catalogue import Geometry
from processing.map.feature import AttributeValue, Feature, Status, Vertex, new_feature_id
from processing.operations.export import ExportRequest, export
from processing.project.project import Project

_CRS = "EPSG:6677"
_AT = (-11_394.608, -35_139.915)


def _feature(
    kind: str, shape: Geometry, *xy: tuple[float, float], **own: AttributeValue
) -> Feature:
    vertices = tuple(Vertex((_AT[0] + x, _AT[1] + y, 5.125)) for x, y in xy)
    return Feature(new_feature_id(), kind, shape, vertices, own)


_MAP = (
    _feature("street_tree", Geometry.POINT, (1.0, 2.0), girth_m=0.62, stems=2, species="欅"),
    _feature("road_edge", Geometry.LINE, (0.0, 0.0), (30.0, 1.0), surface="アスファルト"),
    _feature("gutter_lid", Geometry.AREA, (0.0, 0.0), (0.5, 0.0), (0.5, 0.4), (0.0, 0.4)),
)


@pytest.fixture
def project(tmp_path: Path) -> Path:
    with closing(Project.create(tmp_path / "street.zuka", _CRS)) as made:
        return made.folder


@pytest.fixture(autouse=True)
def _english(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")


def _taken(
    capsys: pytest.CaptureFixture[str], project: Path, *words: object
) -> tuple[int, str, str]:
    status = run_in_terminal(["map", str(project), *map(str, words)])
    said = capsys.readouterr()
    return status, said.out, said.err


def _features(project: Path) -> list[Feature]:
    with closing(Project.open(project)) as opened:
        return list(opened.features.all())


@pytest.mark.parametrize("format_", ["dxf", "gpkg"])
def test_a_map_of_this_program_comes_back_once_and_can_be_taken_back(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str], format_: str
) -> None:
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    (path,) = export(_MAP, catalogue, _CRS, ExportRequest((format_,), tmp_path / "out"))
    assert _taken(capsys, project, path)[:2] == (DONE, "3 features taken in.\n")
    found = {one.id: one for one in _features(project)}
    for one in _MAP:
        back = found[one.id]
        assert (back.kind, back.geometry, back.status) == (one.kind, one.geometry, Status.ACCEPTED)
        assert dict(back.attributes) == dict(one.attributes)
        for vertex, was in zip(back.vertices, one.vertices, strict=True):
            assert vertex.xyz == pytest.approx(was.xyz, abs=1e-6)
    status, out, err = _taken(capsys, project, path)
    assert (status, out) == (DONE, "0 features taken in.\n")
    assert "already" in err
    with closing(Project.open(project, writing=True)) as opened:
        opened.features.undo()
        assert list(opened.features.all()) == []


def _foreign(path: Path) -> Path:
    drawing = ezdxf.new("R2000")
    space = drawing.modelspace()
    x, y = _AT
    space.add_lwpolyline([(x, y), (x + 9, y)], dxfattribs={"layer": "2101-DOUROEN"})
    space.add_point((x, y, 3.0), dxfattribs={"layer": "2238_並木"})
    space.add_line((x, y, 3.0), (x, y + 5, 3.0), dxfattribs={"layer": "MEMO"})
    drawing.saveas(path)
    return path


def test_a_drawing_of_others_is_known_by_layers_and_codes_and_the_rest_is_told(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = _foreign(tmp_path / "既存図.dxf")
    status, _, err = _taken(capsys, project, path)
    assert status == BAD_INPUT
    assert "does not say its reference system" in err
    status, out, err = _taken(capsys, project, path, "--crs", _CRS)
    assert (status, out) == (DONE, "2 features taken in.\n")
    assert "MEMO (1)" in err
    assert {one.kind for one in _features(project)} == {"road_edge", "street_tree"}
    assert _taken(capsys, project, path, "--crs", _CRS, "--kind", "wall")[0] == DONE
    assert [one.kind for one in _features(project)].count("wall") == 1


def test_a_sima_file_becomes_points_and_parcels_of_the_kind_that_is_given(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "境界.sim"
    rows = ["G00,01,現場,", "A00,", "A01,1,K1,-35139.915,-11394.608,5.125,", "A01,2,K2,1.0,2.0,,"]
    path.write_text("\r\n".join([*rows, "A99,"]) + "\r\n", encoding="cp932")
    assert _taken(capsys, project, path, "--crs", _CRS)[0] == BAD_INPUT
    status, _, err = _taken(capsys, project, path, "--crs", _CRS, "--kind", "boundary_stake")
    assert status == DONE
    assert "no heights" in err
    stakes = sorted(_features(project), key=lambda one: str(one.attributes["name"]))
    assert stakes[0].vertices[0].xyz == pytest.approx((*_AT, 5.125))
    assert stakes[1].vertices[0].is_occluded


def test_a_sheet_of_the_extended_dm_is_known_by_its_codes_and_its_zone(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    hole = _feature("manhole_sewer", Geometry.POINT, (9.0, 3.0), diameter_m=0.6)
    features = (
        *_MAP[:2], hole, _feature("rain_inlet", Geometry.AREA, (0.0, 0.0), (1.0, 0.0), (1.0, 1.0))
    )  # fmt: skip
    (path,) = export(features, catalogue, _CRS, ExportRequest(("dm",), tmp_path / "out"))
    assert _taken(capsys, project, path)[:2] == (DONE, "4 features taken in.\n")
    found = {one.kind: one for one in _features(project)}
    assert set(found) == {one.kind for one in features}
    for one in features:
        for vertex, was in zip(found[one.kind].vertices, one.vertices, strict=True):
            assert vertex.xyz[:2] == pytest.approx(was.xyz[:2], abs=0.002)
    assert found["road_edge"].vertices[1].xyz[2] == pytest.approx(5.125)
    whole = path.read_bytes()
    path.write_bytes(whole[: len(whole) - 86])
    assert _taken(capsys, project, path)[0] == BAD_INPUT


@pytest.mark.parametrize(
    ("name", "content", "words"),
    [
        ("a.sim", "G00,01,x,\r\nA01,1,K1,abc,2,\r\n", "line 2"),
        ("b.sim", "hello\r\n", "line 1"),
        ("a.dm", "M 09LD2800\r\nshort\r\n", "record 2"),
        ("b.dm", "hello\r\n", "record 1"),
        ("c.dxf", "no drawing", "no DXF"),
        ("d.gpkg", "no database", "no GeoPackage"),
        ("e.pdf", "", "read from"),
    ],
)
def test_bad_files_are_refused_in_one_line_and_change_nothing(
    tmp_path: Path,
    project: Path,
    capsys: pytest.CaptureFixture[str],
    *,
    name: str,
    content: str,
    words: str,
) -> None:
    path = tmp_path / name
    path.write_text(content)
    status, _, err = _taken(capsys, project, path, "--crs", _CRS)
    assert status == BAD_INPUT
    assert words in err
    assert err.strip().count("\n") == 0
    assert _taken(capsys, project, tmp_path / "none.dxf", "--crs", _CRS)[0] == BAD_INPUT
    assert _taken(capsys, project, path, "--crs", "EPSG:1")[0] == BAD_INPUT
    assert _features(project) == []


def test_places_in_another_zone_are_brought_into_the_project_s(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    (path,) = export(_MAP[:1], catalogue, "EPSG:6676", ExportRequest(("gpkg",), tmp_path / "out"))
    status, _, err = _taken(capsys, project, path)
    assert status == DONE
    assert "transformed" in err
    assert _features(project)[0].vertices[0].xyz[0] < -100_000
    assert _taken(capsys, project, path, "--crs", _CRS)[0] == BAD_INPUT
