"""``zuka map --compare``: what is new, moved and gone since the last map, in every format."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

import pyogrio
import pytest

from app.cli.terminal import BAD_INPUT, DONE, run_in_terminal
from processing.core.text import Text
from processing.map.catalogue import CHANGE_KIND, Geometry
from processing.map.change import Change
from processing.map.feature import AttributeValue, Feature, Status, Vertex, new_feature_id
from processing.operations.export import ExportRequest, export
from processing.project.project import Project
from processing.project.review.decisions import change_status

_CRS = "EPSG:6677"
_AT = (-11_394.608, -35_139.915)


def _feature(
    kind: str, shape: Geometry, *xy: tuple[float, float], **own: AttributeValue
) -> Feature:
    vertices = tuple(Vertex((_AT[0] + x, _AT[1] + y, 5.125)) for x, y in xy)
    return Feature(new_feature_id(), kind, shape, vertices, own)


def _tree(x: float, y: float) -> Feature:
    return _feature("street_tree", Geometry.POINT, (x, y))


def _lid(x: float) -> Feature:
    return _feature("gutter_lid", Geometry.AREA, (x, 0.0), (x + 0.5, 0.0), (x + 0.5, 0.4), (x, 0.4))


BEFORE = (
    _tree(0.0, 5.0),
    _tree(10.0, 5.0),
    _tree(20.0, 5.0),
    _lid(0.0),
    _lid(10.0),
    _feature("road_edge", Geometry.LINE, (0.0, 0.0), (40.0, 0.0)),
    _feature("road_edge", Geometry.LINE, (0.0, 8.0), (40.0, 8.0)),
    _feature("manhole_water", Geometry.POINT, (5.0, 5.0)),
)
NOW = (
    _tree(0.3, 5.1),  # within what two maps differ by
    _tree(11.5, 5.0),  # moved by 1.5 m; the third is gone
    _tree(30.0, 5.0),  # new
    _lid(0.1),
    _lid(20.0),
    # The road was widened by 2 m over its second half; drawn in two parts.
    _feature("road_edge", Geometry.LINE, (0.0, 0.1), (20.0, 0.1)),
    _feature("road_edge", Geometry.LINE, (20.0, 0.1), (22.0, -2.0), (40.0, -2.0)),
    _feature("guard_rail", Geometry.LINE, (0.0, 1.0), (40.0, 1.0)),
)
EXPECTED = sorted(
    [
        ("gone", "gutter_lid"), ("gone", "road_edge"), ("gone", "street_tree"),
        ("moved", "road_edge"), ("moved", "street_tree"),
        ("new", "gutter_lid"), ("new", "street_tree"),
    ]
)  # fmt: skip


@pytest.fixture(autouse=True)
def _english(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("ZUKA_LANGUAGE", "en")


@pytest.fixture
def project(tmp_path: Path) -> Path:
    with closing(Project.create(tmp_path / "street.zuka", _CRS)) as made:
        made.features.apply(Text.same("map"), Change(added=NOW))
        return made.folder


def _old_map(tmp_path: Path, project: Path, format_: str, **options: str) -> Path:
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    request = ExportRequest((format_,), tmp_path / "old", "en", options)
    made = export(BEFORE, catalogue, _CRS, request)
    return next(path for path in made if path.suffix in (f".{format_}", ".sim"))


def _compared(capsys: pytest.CaptureFixture[str], *words: object) -> tuple[int, str, str]:
    status = run_in_terminal(["map", *map(str, words), "--compare"])
    said = capsys.readouterr()
    return status, said.out, said.err


def _changes(project: Path) -> list[Feature]:
    with closing(Project.open(project)) as opened:
        return [one for one in opened.features.all() if one.kind == CHANGE_KIND]


def _said(project: Path) -> list[tuple[str, str]]:
    with closing(Project.open(project)) as opened:
        kinds = {one.layer: one.id for one in opened.catalogue}
    return sorted(
        (str(one.attributes["change"]), kinds[str(one.attributes["changed_kind"])])
        for one in _changes(project)
    )


@pytest.mark.parametrize("format_", ["dxf", "gpkg", "geojson"])
def test_changes_are_candidates_of_one_step(
    tmp_path: Path, project: Path, format_: str, capsys: pytest.CaptureFixture[str]
) -> None:
    status, out, err = _compared(capsys, project, _old_map(tmp_path, project, format_))
    assert status == DONE, err
    assert out.startswith(f"features.{format_}: 2 new, 2 moved, 3 gone")
    assert "guard" in err.lower()
    assert _said(project) == EXPECTED
    changes = _changes(project)
    assert {one.status for one in changes} == {Status.CANDIDATE}
    moved = {
        one.geometry: one.attributes["moved_m"] for one in changes if "moved_m" in one.attributes
    }
    assert moved[Geometry.POINT] == pytest.approx(1.5, abs=0.01)
    assert moved[Geometry.LINE] == pytest.approx(2.0, abs=0.01)
    with closing(Project.open(project)) as opened:
        opened.features.undo()
        assert not [one for one in opened.features.all() if one.kind == CHANGE_KIND]


def test_a_second_comparison_asks_about_nothing_that_was_judged(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old = _old_map(tmp_path, project, "gpkg")
    _compared(capsys, project, old)
    judged = _changes(project)[:3]
    with closing(Project.open(project)) as opened:
        opened.features.apply(Text.same("no"), change_status(judged, Status.REJECTED))
    _, out, _ = _compared(capsys, project, old)
    assert "3 had been judged" in out
    changes = _changes(project)
    assert len(changes) == len(EXPECTED)
    assert {one.id for one in judged} <= {one.id for one in changes}


def test_accepted_changes_are_rows_and_a_layer(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    _compared(capsys, project, _old_map(tmp_path, project, "gpkg"))
    words = ["export", str(project), "--format", "csv", "gpkg", "--candidates"]
    assert run_in_terminal([*words, "--out", str(tmp_path / "out")]) == DONE
    rows = (tmp_path / "out" / f"ledger_{CHANGE_KIND}.csv").read_text("utf-8-sig").splitlines()
    assert len(rows) == 1 + len(EXPECTED)
    layers = {str(name) for name, _ in pyogrio.list_layers(tmp_path / "out" / "street.gpkg")}
    assert {CHANGE_KIND, f"{CHANGE_KIND}_point", f"{CHANGE_KIND}_area"} <= layers


def _shapefile(tmp_path: Path, project: Path, encoding: str = "utf-8") -> Path:
    named = [_feature("street_tree", Geometry.POINT, (20.0, 5.0), species="欅")]
    with closing(Project.open(project)) as opened:
        request = ExportRequest(("shp",), tmp_path / "shp", "en", {"encoding": encoding})
        export(named, opened.catalogue, _CRS, request)
    return tmp_path / "shp" / "street_tree.shp"


@pytest.mark.parametrize("encoding", ["utf-8", "cp932"])
@pytest.mark.parametrize("has_cpg", [True, False])
def test_a_shapefile_is_read_in_its_own_code_page(
    tmp_path: Path, project: Path, encoding: str, *, has_cpg: bool
) -> None:
    path = _shapefile(tmp_path, project, encoding)
    if not has_cpg:
        path.with_suffix(".cpg").unlink()
    assert run_in_terminal(["map", str(project), str(path)]) == DONE
    with closing(Project.open(project)) as opened:
        assert "欅" in {one.attributes.get("species") for one in opened.features.all()}


def _wrong_page(path: Path) -> None:
    path.with_suffix(".cpg").write_text("UTF-8")


def _unknown_page(path: Path) -> None:
    path.with_suffix(".cpg").write_text("hieroglyphs")


def _no_prj(path: Path) -> None:
    path.with_suffix(".prj").unlink()


def _no_table(path: Path) -> None:
    path.with_suffix(".dbf").unlink()


@pytest.mark.parametrize(
    ("damage", "words"),
    [
        (_wrong_page, "code page that the .cpg says"),
        (_unknown_page, "no known code page"),
        (_no_prj, "does not say its reference system"),
        (_no_table, "lacks its .dbf"),
    ],
)
def test_what_is_wrong_with_a_shapefile_is_one_sentence(
    tmp_path: Path,
    project: Path,
    damage: Callable[[Path], None],
    words: str,
    capsys: pytest.CaptureFixture[str],
) -> None:
    path = _shapefile(tmp_path, project, "cp932")
    damage(path)
    status, out, err = _compared(capsys, project, path)
    assert (status, out) == (BAD_INPUT, "")
    assert words in err
    assert len(err.strip().splitlines()) == 1
    assert not _changes(project)


def _moved(before: tuple[Feature, ...], change: Callable[..., object]) -> list[Feature]:
    return [
        one.with_vertices(
            tuple(Vertex((*change(*v.xyz[:2]), v.xyz[2])) for v in one.vertices)  # type: ignore[misc]
        )
        for one in before
    ]


@dataclass(frozen=True)
class _Elsewhere:
    """A map that lies elsewhere, and what is said of it."""

    change: Callable[..., object]
    crs: str
    words: str


@pytest.mark.parametrize(
    "case",
    [
        _Elsewhere(lambda x, y: (y, x), _CRS, "swap them"),
        _Elsewhere(lambda x, y: (x * 1000, y * 1000), _CRS, "millimetres"),
        _Elsewhere(lambda x, y: (x + 80_000, y), _CRS, "80.0 km"),
        _Elsewhere(lambda x, y: (x, y), "EPSG:6675", "fits as zone 9: give EPSG:6677"),
    ],
)
def test_a_map_that_lies_elsewhere_says_what_it_looks_like(
    tmp_path: Path, project: Path, case: _Elsewhere, capsys: pytest.CaptureFixture[str]
) -> None:
    with closing(Project.open(project)) as opened:
        request = ExportRequest(("gpkg",), tmp_path / "old", "en")
        made = export(_moved(BEFORE, case.change), opened.catalogue, case.crs, request)
    status, _, err = _compared(capsys, project, made[0])
    assert status == BAD_INPUT
    assert case.words in err
    assert len(err.strip().splitlines()) == 1


def test_nothing_drawn_is_nothing_to_compare(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    old = _old_map(tmp_path, project, "gpkg")
    with closing(Project.create(tmp_path / "empty.zuka", _CRS)) as made:
        empty = made.folder
    status, _, err = _compared(capsys, empty, old)
    assert status == BAD_INPUT
    assert "Nothing is accepted" in err


def test_what_goes_on_beyond_the_last_map_is_not_told(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    half = [
        _feature("road_edge", Geometry.LINE, (0.0, 0.1), (10.0, 0.1)),
        _feature("road_edge", Geometry.LINE, (0.0, -9.0), (10.0, -9.0)),
    ]
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    made = export(half, catalogue, _CRS, ExportRequest(("gpkg",), tmp_path / "half"))
    _, out, _ = _compared(capsys, project, made[0])
    assert "0 new, 0 moved, 1 gone" in out


def test_what_was_made_longer_is_new_and_not_moved(
    tmp_path: Path, project: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    shorter = [
        _feature("guard_rail", Geometry.LINE, (0.0, 1.0), (20.0, 1.0)),
        _feature("guard_rail", Geometry.LINE, (39.0, 9.0), (40.0, 9.0)),
        _feature("guard_rail", Geometry.LINE, (39.0, -9.0), (40.0, -9.0)),
    ]
    with closing(Project.open(project)) as opened:
        catalogue = opened.catalogue
    made = export(shorter, catalogue, _CRS, ExportRequest(("gpkg",), tmp_path / "shorter"))
    _, out, _ = _compared(capsys, project, made[0])
    assert "1 new, 0 moved, 2 gone" in out
