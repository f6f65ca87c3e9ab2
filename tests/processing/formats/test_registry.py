"""One registry of formats: what is in it is everywhere, and everything that it names is there."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from processing.core.errors import MissingInput, OutOfRange
from processing.core.monitor import SilentMonitor
from processing.formats.format import DELIVERED, MAP, Content, Format, function_of
from processing.formats.format_list import FormatList
from processing.formats.points.delivered.delivered_floats import chunks_of
from processing.formats.registry import FORMATS
from processing.formats.vectors.feature_files import write_feature_file
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Provenance, Status, Vertex
from processing.operations.export import ExportRequest, check_formats, export
from processing.project.importing.dropped_files import content_of, request_of_files
from resources import path_of
from tests.delivered_files import make_las, sbet_bytes, trajectory_rows, trajectory_text
from tests.processing.formats.tiny_format import TINY

MORE = FORMATS.including(TINY)


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


@pytest.fixture
def tree() -> Feature:
    vertices = (Vertex((1.25, 2.5, 3.75)),)
    return Feature("t", "street_tree", Geometry.POINT, vertices, {}, Status.ACCEPTED, Provenance())


@pytest.fixture
def tiny_file(tmp_path: Path) -> Path:
    folder = tmp_path / "delivery"
    folder.mkdir()
    path = folder / "scan.tiny"
    path.write_text("TINY\n1 2 3\n4 5 6\n")
    return path


@pytest.mark.parametrize("one", tuple(FORMATS), ids=lambda one: one.id)
def test_every_function_that_a_format_names_is_there(one: Format) -> None:
    named = [*one.reads.values(), *one.writes.values(), one.sniff, one.sniff_folder]
    named += [one.layers, one.writes_map]
    assert one.reads or one.writes or one.writes_map
    assert all(callable(function_of(name)) for name in named if name)
    assert all(ending == ending.lower() and ending.startswith(".") for ending in one.endings)
    assert one.name.en
    assert one.name.ja


def test_every_content_has_a_name_in_both_languages_and_a_format() -> None:
    for content in Content:
        assert content.value.en != content.value.ja
        assert FORMATS.read(content) or FORMATS.written(content)


def test_what_shares_its_endings_with_points_is_told_by_its_content() -> None:
    for content in (Content.TRAJECTORY, Content.IMAGES):
        assert all(one.sniff or one.magic for one in FORMATS.read(content))


def test_what_a_map_can_be_written_as_can_be_chosen() -> None:
    for one in FORMATS.maps():
        assert one.writes_map or one.writes[Content.FEATURES]
    assert [option.id for option in FORMATS.map_options()] == [
        "dxf_version", "dxf_heights", "dm_accuracy", "dm_company", "dm_approval",
        "delivery_start", "delivery_end", "delivery_area", "delivery_advice",
        "delivery_folder", "delivery_edition", "delivery_dtds", "sheet_scale",
        "sheet_division", "drawing_layers", "sheet_overlap", "section_scale",
        "section_height_scale", "profile_scale", "profile_height_scale", "sheet_paper",
        "sheet_title", "sheet_client", "sheet_maker", "sheet_surveyor", "sheet_date",
        "digits", "road_pitch", "road_clearance", "walk_clearance", "encoding", "landxml_form",
        "section_pitch", "section_stations",
        "section_reach", "section_depth", "sheet_heights", "lane_pitch", "sheet_route",
        "check_points", "check_map", "map_level",
    ]  # fmt: skip


def test_a_file_is_known_by_its_first_bytes_whatever_its_name(tmp_path: Path) -> None:
    path = tmp_path / "file.bin"
    make_las(tmp_path / "a.las")
    for content, expected in (
        ((tmp_path / "a.las").read_bytes(), Content.POINTS),
        (trajectory_text(trajectory_rows()).encode(), Content.TRAJECTORY),
        (sbet_bytes(), Content.TRAJECTORY),
        (sbet_bytes()[:-1], Content.TRAJECTORY),
        (b"path,time_s,easting_m,omega_deg\n", Content.IMAGES),
        (b"2\n2\n0 0 0\n", Content.POINTS),
        (b"1 2 3\n", Content.POINTS),
        (b"", Content.POINTS),
    ):
        path.write_bytes(content)
        assert content_of(path) is expected


def test_a_refusal_names_the_formats_and_endings_that_there_are() -> None:
    with pytest.raises(OutOfRange) as refusal:
        FORMATS.format_to_write(Path("a.pdf"), Content.POINTS)
    error = refusal.value
    assert error.what.en == "Points are written as LAS or LAZ."
    assert error.what.ja == "点群はLAS・LAZで書き出します。"
    assert error.remedy.en == "Give a name ending in .las or .laz."
    assert error.remedy.ja == ".las・.laz で終わる名前にしてください。"


def test_an_added_format_is_in_the_filter_of_a_dialog() -> None:
    assert "*.tiny" not in FORMATS.filter_read(*DELIVERED).en
    assert "*.tiny " in MORE.filter_read(*DELIVERED).ja
    assert MORE["tiny"].file_filter.ja == "小形式 (*.tiny)"


def test_an_added_format_is_taken_dropped_in_a_folder_and_by_its_content(tiny_file: Path) -> None:
    assert request_of_files((tiny_file,), "", MORE).inputs == (tiny_file,)
    assert request_of_files((tiny_file.parent,), "", MORE).inputs == (tiny_file,)
    with pytest.raises(MissingInput):
        request_of_files((tiny_file.parent,), "")
    found = MORE.recognised(tiny_file.read_bytes(), *DELIVERED)
    assert found == (TINY, Content.POINTS)
    (chunk,) = chunks_of(found[0].reader(Content.POINTS)(tiny_file), 10)
    assert chunk.count == 2
    with pytest.raises(MissingInput, match="Tiny"):
        request_of_files((), "", MORE)


def test_an_added_format_is_named_where_another_is_refused() -> None:
    with pytest.raises(OutOfRange, match=r"geojson, .*las, .*tiny"):
        check_formats(("dwg",), MORE)
    with pytest.raises(OutOfRange, match=r"or \.tiny"):
        MORE.format_to_write(Path("a.las"), Content.FEATURES)


def test_an_added_format_is_exported_and_written_by_its_ending(
    tmp_path: Path, catalogue: Catalogue, tree: Feature
) -> None:
    request = ExportRequest(("tiny",), tmp_path / "out", options={"tiny_decimals": 2})
    (path,) = export([tree], catalogue, "", request, formats=MORE)
    assert path.name == f"{MAP}.tiny"
    assert path.read_text() == "TINY\nstreet_tree 1.25 2.50 3.75\n"
    other = tmp_path / "found.tiny"
    write_feature_file(other, [tree], catalogue, "", SilentMonitor(), formats=MORE)
    np.testing.assert_equal(other.read_text().split()[2:], ["1.2", "2.5", "3.8"])


def test_options_of_an_added_format_are_offered_and_checked(
    tmp_path: Path, catalogue: Catalogue, tree: Feature
) -> None:
    assert "tiny_decimals" in [option.id for option in MORE.map_options()]
    request = ExportRequest(("tiny",), tmp_path / "out", options={"tiny_decimals": 9})
    with pytest.raises(OutOfRange, match="tiny_decimals=9"):
        export([tree], catalogue, "", request, formats=MORE)


def test_a_format_that_needs_a_system_is_refused_without_one(
    tmp_path: Path, catalogue: Catalogue, tree: Feature
) -> None:
    needy = FormatList([Format(**{**vars(TINY), "needs_crs": True})])
    request = ExportRequest(("tiny",), tmp_path / "out")
    with pytest.raises(MissingInput, match="reference system"):
        export([tree], catalogue, "", request, formats=needy)
    assert not (tmp_path / "out").exists()
    assert export([tree], catalogue, "EPSG:6677", request, formats=needy)
