"""Drawing sheets are read back: true to scale, whole, and clean."""

from __future__ import annotations

import math
import re
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pypdfium2
import pytest
import shapely

from processing.core.errors import Unsuitable, UserError
from processing.core.text import Text
from processing.formats.drawings.drawn_features import read_dxf_features
from processing.formats.drawings.dxf_document import SHEET_MARK
from processing.formats.sheets.drawing_sheet import DrawingSheet
from processing.formats.sheets.grid_division import map_grid, plain_grid
from processing.formats.sheets.label_places import SheetLabel, place_labels
from processing.formats.sheets.map_looks import map_shapes
from processing.formats.sheets.paper_shapes import PaperLine, PaperWords
from processing.formats.sheets.sheet_clips import SheetClips
from processing.formats.sheets.sheet_column import LegendRow, legend_box
from processing.formats.sheets.sheet_layout import layout_of
from processing.formats.sheets.slope_marks import slope_shapes
from processing.formats.work_facts import WorkFacts
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.pages import picture_of

_EAST, _NORTH = -8000.0, -36200.0


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(id_: str, kind: str, geometry: Geometry, *places: Position, **own: Any) -> Feature:
    vertices = (Vertex((_EAST + x, _NORTH + y, z)) for x, y, z in places)
    return Feature(id_, kind, geometry, tuple(vertices), own)


def _street() -> tuple[Feature, ...]:
    """600 m of road in a bend, with a house and trees."""
    bend = [(t, 60.0 + 40.0 * math.sin(t / 120.0), 10.0) for t in map(float, range(0, 601, 10))]
    edges = [tuple((x, y + off, z) for x, y, z in bend) for off in (-4.0, 0.0, 4.0)]
    trees = [
        _feature(f"tree-{n}", "street_tree", Geometry.POINT, (x, y + 6, z), number=f"{n}")
        for n, (x, y, z) in enumerate(bend)
    ]
    house = ((20.0, 80.0, 10.0), (40.0, 80.0, 10.0), (40.0, 95.0, 10.0), (20.0, 95.0, 10.0))
    return (
        _feature("edge-1", "road_edge", Geometry.LINE, *edges[0]),
        _feature("centre", "road_center", Geometry.LINE, *edges[1], name="市道1号線"),
        _feature("edge-2", "road_edge", Geometry.LINE, *edges[2]),
        _feature("fifty", "road_edge", Geometry.LINE, (100.0, 20.0, 5.0), (150.0, 20.0, 5.0)),
        _feature("house", "building", Geometry.AREA, *house, name="見本市役所"),
        *trees,
    )


def _written(
    folder: Path, catalogue: Catalogue, *features: Feature, **options: Any
) -> tuple[tuple[Path, ...], list[Text]]:
    notes: list[Text] = []
    request = ExportRequest(("sheets",), folder, options=options)
    return export(features, catalogue, "EPSG:6677", request, tell=notes.append), notes


@pytest.mark.parametrize("division", ["grid", "map", "route"])
def test_every_division_is_written_clean_and_whole(
    tmp_path: Path, catalogue: Catalogue, division: str
) -> None:
    paths, notes = _written(
        tmp_path, catalogue, *_street(), sheet_division=division, sheet_paper="A0",
        sheet_surveyor="測量 太郎",
    )  # fmt: skip
    assert [note.en for note in notes if "off the sheets" in note.en] == []
    ids: set[str] = set()
    drawings = [path for path in paths if path.suffix == ".dxf"]
    assert len(drawings) > 2
    for path in drawings:
        doc = ezdxf.filemanagement.readfile(path)
        audit = doc.audit()
        assert [one.message for one in (*audit.errors, *audit.fixes)] == []
        for entity in doc.modelspace():
            if entity.has_xdata("ZUKA"):
                ids.add(entity.get_xdata("ZUKA")[0].value)
        if not path.stem.endswith("_layouts"):
            flat = doc.dxfversion
            assert flat == "AC1009"
    assert ids == {feature.id for feature in _street()} | {SHEET_MARK}
    pdf = pypdfium2.PdfDocument(tmp_path / "sheets.pdf")
    assert len(pdf) == len(drawings) - 1
    words = pdf[0].get_textpage().get_text_bounded()
    for expected in ("凡例", "測量 太郎", "第9系", f"1 / {len(pdf)}"):
        assert expected in words


def test_the_legend_of_a_flat_sheet_is_no_map(tmp_path: Path, catalogue: Catalogue) -> None:
    paths, _ = _written(tmp_path, catalogue, *_street(), sheet_paper="A0")
    flat = [p for p in paths if p.suffix == ".dxf" and not p.stem.endswith("_layouts")]
    read = [one for path in flat for one in read_dxf_features(path).features]
    assert {one.facts["id"] for one in read} == {feature.id for feature in _street()}


def test_fifty_metres_are_a_hundred_millimetres(tmp_path: Path, catalogue: Catalogue) -> None:
    paths, _ = _written(tmp_path, catalogue, *_street())
    pdf = pypdfium2.PdfDocument(tmp_path / "sheets.pdf")
    assert np.array(pdf[0].get_size()) * 25.4 / 72 == pytest.approx([841.0, 594.0], abs=0.01)
    spans = []
    for page in pdf:
        for one in page.get_objects():
            left, bottom, right, top = one.get_bounds()
            if top - bottom < 3.0:
                spans.append((right - left) * 25.4 / 72)
    # Within the width of the pen, which a span contains at both ends.
    assert min(abs(span - 100.0) for span in spans) < 0.4
    doc = ezdxf.filemanagement.readfile(next(p for p in paths if p.stem.endswith("_layouts")))
    for name in doc.layouts.names()[1:]:
        for view in doc.layouts.get(name).query("VIEWPORT"):
            if view.dxf.id != 1:
                assert view.get_scale() == pytest.approx(1000 / 500)


def test_a_line_on_paper_has_its_length_at_every_scale_and_angle(catalogue: Catalogue) -> None:
    layout = layout_of("A1")
    fifty = _street()[3]
    for scale, turned in ((250, 0.0), (500, 33.0), (1000, 211.0)):
        middle = (_EAST + 125.0, _NORTH + 20.0)
        size = tuple(side * scale / 1000 for side in layout.window_size)
        sheet = DrawingSheet("", middle, (size[0], size[1]), scale, turned)
        (line,) = map_shapes([fifty], catalogue, sheet, layout)
        assert isinstance(line, PaperLine)
        assert np.hypot(*np.diff(line.places, axis=0)[0]) == pytest.approx(50_000 / scale)
        back = sheet.on_ground(line.places, layout)
        assert back == pytest.approx(np.array([v.xyz[:2] for v in fifty.vertices]), abs=1e-9)


def test_the_sheets_of_a_grid_cover_the_map() -> None:
    shapes = SheetClips(_street()).shapes
    for sheets in (
        plain_grid(shapes, 250, (250.0, 250.0)),
        plain_grid(shapes, 500, (600.0, 500.0)),
        map_grid(shapes, 250, "EPSG:6677"),
        map_grid(shapes, 500, "EPSG:6677"),
        map_grid(shapes, 1000, "EPSG:6677"),
    ):
        whole = shapely.union_all([sheet.window for sheet in sheets]).buffer(1e-6)
        assert all(whole.covers(shape) for shape in shapes)
        assert len({sheet.name for sheet in sheets}) == len(sheets)


def test_words_do_not_cover_each_other(tmp_path: Path, catalogue: Catalogue) -> None:
    crowd = [
        _feature(f"t{n}", "street_tree", Geometry.POINT, (n * 0.2, 0.0, 1.0), number=f"番号{n}")
        for n in range(40)
    ]
    paths, notes = _written(tmp_path, catalogue, *crowd)
    (table,) = (path for path in paths if path.suffix == ".csv")
    listed = table.read_text("utf-8-sig").splitlines()[1:]
    doc = ezdxf.filemanagement.readfile(next(p for p in paths if p.stem.endswith("_001")))
    written = [text for text in doc.modelspace().query("TEXT") if "番号" in text.dxf.text]
    written = [text for text in written if text.dxf.layer.endswith("_文字")]
    assert len(written) + len(listed) == 40
    assert written
    assert listed
    assert any("no room" in note.en for note in notes)


def test_bad_input_is_refused_in_one_sentence(tmp_path: Path, catalogue: Catalogue) -> None:
    with pytest.raises(Unsuitable, match="no features"):
        _written(tmp_path, catalogue)
    with pytest.raises(Unsuitable, match="no such route"):
        _written(tmp_path, catalogue, *_street(), sheet_division="route", sheet_route="none")
    with pytest.raises(Unsuitable, match="no room on the paper"):
        _written(tmp_path, catalogue, *_street(), sheet_division="map", sheet_paper="A3")
    far = _feature("far", "road_edge", Geometry.LINE, (0.0, 0.0, 0.0), (9e6, 9e6, 0.0))
    with pytest.raises(Unsuitable, match="more than"):
        _written(tmp_path, catalogue, far)
    assert list(tmp_path.iterdir()) == []
    (tmp_path / "sheets").write_text("a file where the folder should be")
    with pytest.raises(UserError):
        _written(tmp_path, catalogue, *_street())
    assert [path.name for path in tmp_path.iterdir()] == ["sheets"]


def test_features_off_a_routes_sheets_are_listed(tmp_path: Path, catalogue: Catalogue) -> None:
    far = _feature("far", "street_tree", Geometry.POINT, (300.0, 5000.0, 1.0))
    _, notes = _written(tmp_path, catalogue, *_street(), far, sheet_division="route")
    assert [note.en for note in notes if "off the sheets" in note.en]
    rows = (tmp_path / "sheets/features_off_sheets.csv").read_text("utf-8-sig").splitlines()
    assert rows[1:] == ["far,street_tree,-7700.000,-31200.000"]


def test_a_dense_legend_stays_legible_and_counts_what_has_no_room() -> None:
    rows = [LegendRow(f"kind {number}", lambda _place, _step: ()) for number in range(40)]
    for height, last in ((200.0, "kind 39"), (60.0, "and 5 more kinds")):
        shapes = list(legend_box(rows, "en", (0.0, 0.0), (140.0, height)))
        words = [one for one in shapes if isinstance(one, PaperWords)]
        assert words[-1].words == last
        assert min(one.height for one in words) >= 2.3


def test_what_surrounds_the_map_lies_on_the_layers_of_its_codes(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    work = WorkFacts(work="道路台帳図化業務", client="見本市", contractor="見本測量")
    request = ExportRequest(("sheets",), tmp_path, "ja", {"sheet_division": "route"})
    export(_street(), catalogue, "EPSG:6677", request, work=work)
    flat = ezdxf.filemanagement.readfile(tmp_path / "sheets" / "features_001.dxf")
    layers = {entity.dxf.layer for entity in flat.modelspace()}
    standard = ("7901", "7902", "7903", "7904", "7905", "7911", "7912", "7913", "8201", "8202")
    assert {layer[:4] for layer in layers} >= {*standard, "8204", "8205", "8208", "8211", "8266"}
    words = {entity.dxf.layer: entity.dxf.text for entity in flat.modelspace().query("TEXT")}
    # The project's work details fill the title block in.
    assert words["8201_図面タイトル"] == "道路台帳図化業務"
    assert (words["8204_計画機関名"], words["8205_作業機関名"]) == ("見本市", "見本測量")


def test_a_client_gets_the_layers_of_the_standard_for_cad_drawings(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    request = ExportRequest(("sheets", "dxf"), tmp_path, "ja", {"drawing_layers": "cad"})
    paths = export(_street(), catalogue, "EPSG:6677", request)
    for path in paths:
        if path.suffix == ".dxf":
            drawing = ezdxf.filemanagement.readfile(path)
            spaces = [
                drawing.modelspace(),
                *(drawing.paperspace(n) for n in drawing.layout_names_in_taborder()[1:]),
            ]
            layers = {entity.dxf.layer for space in spaces for entity in space}
            assert all(layer.startswith(("S-", "0", "VIEWPORT")) for layer in layers), (
                path,
                layers,
            )
            assert "S-BGD-TXT" in layers  # words of the map
            assert not any(layer.endswith("_文字") for layer in layers)
            assert not drawing.audit().errors


def test_lines_of_sheets_lie_in_plan_where_every_program_shows_their_patterns(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    request = ExportRequest(("sheets",), tmp_path, "ja", {"sheet_division": "route"})
    export(_street(), catalogue, "EPSG:6677", request)
    for name in ("features_001.dxf", "features_layouts.dxf"):
        drawing = ezdxf.filemanagement.readfile(tmp_path / "sheets" / name)
        lines = drawing.modelspace().query("POLYLINE LWPOLYLINE")
        assert lines
        assert not any(one.dxftype() == "POLYLINE" and one.is_3d_polyline for one in lines)


def test_a_reader_hides_the_layers_of_the_pdf(tmp_path: Path, catalogue: Catalogue) -> None:
    request = ExportRequest(("sheets",), tmp_path, "ja", {"sheet_paper": "A3"})
    export(_street(), catalogue, "EPSG:6677", request)
    path = tmp_path / "sheets.pdf"
    shown = picture_of(path)
    assert (shown < 128).any()
    data = path.read_bytes()
    assert "7901_図枠外枠".encode("utf-16-be").replace(b"\\", b"\\\\") in _unescaped(data)
    # Of the same length, so that no place in the file moves: all layers are hidden.
    assert data.count(b"/ON [") == 1
    path.write_bytes(data.replace(b"/ON [", b"/OFF["))
    assert (picture_of(path) == 255).all()


def _unescaped(data: bytes) -> bytes:
    """Bytes of strings as they are meant: octal numbers read, signs behind a backslash kept."""
    return re.sub(rb"\\([0-7]{3})", lambda found: bytes([int(found[1], 8)]), data)


def test_words_of_lines_that_go_straight_up_read_alike() -> None:
    window = shapely.box(0.0, 0.0, 200.0, 100.0)
    lines = [
        shapely.LineString([(20.0 * n + 10.0, 20.0), (20.0 * n + 10.0 + off, 80.0)])
        for n, off in enumerate((-0.5, -0.01, 0.0, 0.01, 0.5))
    ]
    lines += [line.reverse() for line in lines]
    for line in lines:
        (place,) = place_labels([SheetLabel("f", "6.0", 2.0, line)], window, [], [])
        assert place is not None
        assert place.angle_deg == pytest.approx(90.0, abs=0.6)


def test_slopes_have_long_and_short_hachures_towards_their_foot(catalogue: Catalogue) -> None:
    layout = layout_of("A1")
    sheet = DrawingSheet("a", (_EAST, _NORTH), (360.0, 260.0), 500, 30.0)
    for top, foot in (((0.0, 0.0), (0.0, -4.0)), ((0.0, 0.0), (0.0, 4.0))):  # right, then left
        slope = [
            _feature("t", "slope_top", Geometry.LINE, (0.0, top[1], 9.0), (20.5, top[1], 9.0)),
            _feature("f", "slope_foot", Geometry.LINE, (-1.0, foot[1], 5.0), (21.0, foot[1], 5.0)),
        ]
        marks = list(slope_shapes(slope, catalogue, sheet, layout))
        # 4 m are 8 mm wide: 4 mm apart on the 41 mm of the top.
        assert len(marks) == 11
        lengths = [math.dist(*mark.places) for mark in marks]
        assert lengths == pytest.approx([8.0, 4.0] * 5 + [8.0])
        ends = sheet.on_ground([mark.places[1] for mark in marks[::2]], layout)
        assert ends[:, 1] == pytest.approx(_NORTH + foot[1])
        assert {mark.pen.layer for mark in marks} == {"6101_人工斜面"}
        assert not list(slope_shapes(slope[:1], catalogue, sheet, layout))


def test_a_wide_slope_has_hachures_of_ten_millimetres(catalogue: Catalogue) -> None:
    layout = layout_of("A1")
    sheet = DrawingSheet("a", (_EAST, _NORTH), (360.0, 260.0), 500)
    wide = [
        _feature("t", "slope_top", Geometry.LINE, (0.0, 0.0, 9.0), (20.0, 0.0, 9.0)),
        _feature("f", "slope_foot", Geometry.LINE, (-1.0, -15.0, 5.0), (21.0, -15.0, 5.0)),
    ]
    lengths = [math.dist(*mark.places) for mark in slope_shapes(wide, catalogue, sheet, layout)]
    assert max(lengths) == pytest.approx(10.0)
    narrow = [wide[0], _feature("n", "slope_foot", Geometry.LINE, (0.0, -0.2, 9), (20.0, -0.2, 9))]
    assert not list(slope_shapes(narrow, catalogue, sheet, layout))
