"""What the edit menu does with the chosen features: one change, one line in the undo menu."""

from __future__ import annotations

import pytest

from app.document.document import Document
from app.drawing.map_edits import MapEdits
from app.jobs.jobs import JobQueue
from processing.core.text import Text
from processing.map.catalogue import Geometry
from processing.map.change import Change
from processing.map.feature import Feature, Status, Vertex

LABEL = Text("Draw", "作図")


@pytest.fixture
def document(qapp, tmp_path):
    jobs = JobQueue()
    document = Document(jobs)
    document.create(tmp_path / "p.zuka", "EPSG:6677")
    yield document
    jobs.close()
    document.close()
    document.tiles.close()


def _sign(id_: str, easting: float) -> Feature:
    return Feature(id_, "sign", Geometry.POINT, (Vertex((easting, 2.0, 3.0)),))


def test_chosen_features_are_rejected_as_one_step_that_says_how_many(document):
    signs = (_sign("a", 1.0), _sign("b", 2.0))
    document.apply(LABEL, Change(added=signs))
    document.shared.selection.choose_features(frozenset({"a", "b"}))
    MapEdits(document).set_status(Status.REJECTED, Text("Reject", "却下"))
    assert {one.status for one in document.features()} == {Status.REJECTED}
    assert document.undo_stack.undo_label == Text("Reject: 2 features", "却下: 2個の地物")
    document.undo()
    assert {one.status for one in document.features()} == {Status.ACCEPTED}


def test_ledgers_are_filled_in_along_the_route_as_one_step(document):
    edits, told = MapEdits(document), []
    document.reported.connect(told.append)
    document.apply(LABEL, Change(added=(_sign("a", 30.0),)))
    edits.number_along_routes()
    assert told[-1].en.startswith("Draw the road's centre line first")
    ends = (Vertex((0.0, 0.0, 3.0)), Vertex((100.0, 0.0, 3.0)))
    centre = Feature("c", "road_center", Geometry.LINE, ends, {"route": "市道1号線"})
    document.apply(LABEL, Change(added=(centre,)))
    edits.number_along_routes()
    (filled,) = (one for one in document.features() if one.id == "a")
    assert filled.attributes == {
        "number": "1",
        "route": "市道1号線",
        "station": "No.1+10.00",
        "side": "left",
    }
    edits.number_along_routes()
    assert told[-1].en.startswith("All that ledgers list")
    document.undo()
    assert not next(one for one in document.features() if one.id == "a").attributes


def test_widths_are_drawn_along_the_route_as_one_step(document):
    edits, told = MapEdits(document), []
    document.reported.connect(told.append)

    def line(id_: str, kind: str, northing: float) -> Feature:
        ends = (Vertex((0.0, northing, 3.0)), Vertex((40.0, northing, 3.0)))
        return Feature(id_, kind, Geometry.LINE, ends, {"route": "市道1号線"})

    edits.draw_widths()
    assert told[-1].en.startswith("Draw the road's centre line first")
    document.apply(LABEL, Change(added=(line("c", "road_center", 0.0),)))
    edits.draw_widths()
    assert told[-1].en.startswith("No width can be measured")
    edges = (line("l", "road_edge", 3.0), line("r", "road_edge", -3.2))
    document.apply(LABEL, Change(added=edges))
    for _ in range(2):  # the second time replaces what the first has drawn
        edits.draw_widths()
        drawn = [one for one in document.features() if one.kind == "width_line"]
        assert [one.attributes["name"] for one in drawn] == ["6.2"] * 3
        assert told[-1].en.startswith("3 width lines drawn")
    document.undo()
    document.undo()
    assert {one.kind for one in document.features()} == {"road_center", "road_edge"}


def test_centre_lines_between_edges_need_a_way_that_was_driven(document):
    edits, told = MapEdits(document), []
    document.reported.connect(told.append)
    edits.draw_centre_lines()
    assert told[-1].en.startswith("No centre line can be made")
    assert not tuple(document.features())
