"""Both forms of SXF are read back by readers of the test's own and say the same drawing."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any

import pytest

from processing.core.errors import Unsuitable
from processing.core.text import Text
from processing.map.catalogue import Catalogue, Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Position, Vertex
from processing.operations.export import ExportRequest, export
from resources import path_of
from tests.processing.formats.drawings.sxf_reader import ReadDrawing, read_p21, read_sfc

_EDGE = ((-7890.2, -36050.5004, 12.3), (-7890.2, -36050.5004, 12.4), (-7850.1, -36040.25, 12.5))
_RING = ((-7880.0, -36050.0, 1.0), (-7870.0, -36050.0, 1.0), (-7870.0, -36045.0, 1.0))


@pytest.fixture(scope="module")
def catalogue() -> Catalogue:
    return read_catalogue(path_of("catalogue/level500.toml"))


def _feature(kind: str, geometry: Geometry, *positions: Position, **own: Any) -> Feature:
    return Feature(f"id-{kind}", kind, geometry, tuple(map(Vertex, positions)), own)


def _written(
    folder: Path, catalogue: Catalogue, *features: Feature
) -> tuple[ReadDrawing, ReadDrawing, list[Text]]:
    notes: list[Text] = []
    paths = export(
        features, catalogue, "EPSG:6677", ExportRequest(("sxf",), folder), tell=notes.append
    )
    assert [path.suffix for path in paths] == [".sfc", ".p21"]
    return read_sfc(paths[0].read_bytes()), read_p21(paths[1].read_bytes()), notes


def test_both_forms_hold_the_map_to_the_resolution_of_the_form(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    features = (
        _feature("road_edge", Geometry.LINE, *_EDGE),
        _feature("building", Geometry.AREA, *_RING, name="庁舎's *\\"),
        _feature("contour", Geometry.LINE, *_RING),
        _feature("manhole", Geometry.POINT, _RING[0]),
    )
    sfc, p21, notes = _written(tmp_path, catalogue, *features)
    assert notes == []
    (title,) = (words for layer, words, _ in sfc.texts if layer == "S-TTL-TXT")
    north, east = map(float, re.findall(r"[XY]=(-?[0-9.]+)", title))
    assert "縮尺 1:500" in title
    assert "EPSG:6677" in title

    def on_map(*positions: Position) -> list[tuple[float, float]]:
        return [((x - east) * 1000, (y - north) * 1000) for x, y, _ in positions]

    lines = [places for layer, places in sfc.lines if layer == "S-BGD-EXST"]
    for read, drawn in ((lines[0], _EDGE[1:]), (lines[1], (*_RING, _RING[0]))):
        assert read == [pytest.approx(place, abs=1e-6) for place in on_map(*drawn)]
    assert [layer for layer, _ in sfc.lines].count("S-BGD-LWCN") == 1
    assert ("S-BGD-TXT", "庁舎’s *￥") in [(layer, words) for layer, words, _ in sfc.texts]
    assert sfc.circles

    # The other form says the same; its strings keep what a comment can't.
    assert sorted(p21.lines) == sorted(sfc.lines)
    assert sorted(p21.circles) == sorted(sfc.circles)
    assert {words for _, words, _ in p21.texts} == {title, "庁舎's *\\\\"}
    assert (p21.layers, p21.colours) == (sfc.layers, sfc.colours)
    assert (p21.ratio, p21.placed, p21.sheet) == (sfc.ratio, sfc.placed, sfc.sheet)


def test_the_map_lies_within_the_frame_of_the_smallest_paper(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    for length, ratio, sheet in ((40, 1 / 500, 297), (200, 1 / 500, 594), (900, 1 / 1000, 1189)):
        line = _feature("road_edge", Geometry.LINE, (5.0, 5.0, 0.0), (5.0 + length, 50.0, 0.0))
        sfc, _, _ = _written(tmp_path / str(length), catalogue, line)
        assert sfc.ratio == ratio
        assert sfc.sheet[0] == sheet
        (frame,) = (places for layer, places in sfc.lines if layer == "S-TTL-FRAM")
        (drawn,) = (places for layer, places in sfc.lines if layer == "S-BGD-EXST")
        for axis in (0, 1):
            low, high = (side([one[axis] for one in frame]) for side in (min, max))
            for place in drawn:
                assert low <= sfc.placed[axis] + place[axis] * ratio <= high


def test_texts_of_other_alphabets_are_replaced_and_told(
    tmp_path: Path, catalogue: Catalogue
) -> None:
    name = _feature("road_name", Geometry.POINT, _RING[0], name="𠮷野通り")
    sfc, p21, notes = _written(tmp_path, catalogue, name)
    for drawing in (sfc, p21):
        assert "〓野通り" in [words for _, words, _ in drawing.texts]
    assert len(notes) == 1


def test_a_map_that_no_sheet_holds_is_refused(tmp_path: Path, catalogue: Catalogue) -> None:
    far = _feature("road_edge", Geometry.LINE, (0.0, 0.0, 0.0), (100_000.0, 0.0, 0.0))
    with pytest.raises(Unsuitable):
        _written(tmp_path / "out", catalogue, far)
    assert not list((tmp_path / "out").glob("*"))


def test_an_empty_map_is_an_empty_sheet(tmp_path: Path, catalogue: Catalogue) -> None:
    sfc, p21, _ = _written(tmp_path, catalogue)
    assert [layer for layer, _ in sfc.lines] == ["S-TTL-FRAM"]
    assert p21.sheet == (297.0, 210.0)
