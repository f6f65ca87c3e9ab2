"""The tool that docs/adding_a_mouse_tool.md shows is a tool."""

from __future__ import annotations

import importlib.util
from pathlib import Path

import pytest
from PySide6.QtCore import QObject

from processing.map.catalogue import Geometry
from tests.widgets.builders import KINDS, OpenMap
from widgets.mouse_tools.drawing.drawing_tool import NO_POINT, DrawingTool
from widgets.mouse_tools.drawing.toolbox import MouseToolbox
from widgets.mouse_tools.editing.select import Select
from widgets.mouse_tools.mouse_tool import Hit
from widgets.shared.cursor import PickedPosition

GUIDE = Path(__file__).parents[3] / "docs" / "adding_a_mouse_tool.md"
WEST = Hit(PickedPosition((10.0, 20.0, 3.0)))
EAST = Hit(PickedPosition((10.2, 20.0, 3.1)))


@pytest.fixture
def source() -> OpenMap:
    return OpenMap()


@pytest.fixture
def tool(source: OpenMap, tmp_path: Path) -> DrawingTool:
    """Make the tool of the guide, with a kind to draw."""
    path = tmp_path / "draw_between.py"
    example = GUIDE.read_text(encoding="utf-8").split("```python\n")[1].split("```")[0]
    path.write_text(example, encoding="utf-8")
    spec = importlib.util.spec_from_file_location("draw_between", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    made = module.DrawBetween(source, source.shared)
    assert isinstance(made, DrawingTool)
    made.set_kind(KINDS["pole"])
    source.listen_to(made)
    return made


def test_two_clicks_make_a_point_halfway(source: OpenMap, tool: DrawingTool) -> None:
    tool.press(WEST)
    tool.move(EAST)
    assert tool.is_busy
    tool.press(EAST)
    (feature,) = source.stored.values()
    (vertex,) = feature.vertices
    assert vertex.xyz == pytest.approx((10.1, 20.0, 3.05))
    assert vertex.is_occluded
    assert feature.kind == "pole"
    assert not tool.is_busy


def test_it_is_taken_back_and_left_like_any_other(source: OpenMap, tool: DrawingTool) -> None:
    tool.press(Hit(None))
    assert source.reported == [NO_POINT]
    tool.press(WEST)
    tool.step_back()
    assert not tool.is_busy
    tool.press(WEST)
    tool.leave()
    assert source.shared.sketch.drawing is None
    assert source.stored == {}


def test_it_goes_into_the_hand(source: OpenMap, tool: DrawingTool) -> None:
    parent = QObject()
    tools = {"select": Select(source, source.shared), "between": tool}
    toolbox = MouseToolbox(source, source.shared, tools, parent=parent)
    toolbox.choose("between")
    toolbox.current_tool.press(WEST)
    toolbox.current_tool.press(EAST)
    assert [feature.geometry for feature in source.stored.values()] == [Geometry.POINT]
