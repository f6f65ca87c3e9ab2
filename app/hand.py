"""The tools that a window's mouse can take, made for its document."""

from __future__ import annotations

from app.document import Document
from processing.project.catalogue import Geometry
from widgets.mouse_tools.cut_lines import ExtendLine, SplitLine, TrimLine
from widgets.mouse_tools.draw_parallel import DrawParallel
from widgets.mouse_tools.draw_path import DrawPath
from widgets.mouse_tools.draw_point import DrawPoint
from widgets.mouse_tools.draw_shape import DrawShape, Shape
from widgets.mouse_tools.draw_template import DrawTemplate, TemplatePart
from widgets.mouse_tools.edit_vertices import EditVertices
from widgets.mouse_tools.measure import MeasureTool
from widgets.mouse_tools.mouse_tool import DragShape
from widgets.mouse_tools.move_features import MoveFeatures
from widgets.mouse_tools.paint_brush import PaintBrush
from widgets.mouse_tools.paint_outline import PaintOutline
from widgets.mouse_tools.paint_segments import PaintSegments
from widgets.mouse_tools.select import Select
from widgets.mouse_tools.toolbox import MouseToolbox


def make_toolbox(document: Document) -> MouseToolbox:
    """All mouse tools, the pointer in the hand; views come later."""
    shared = document.shared
    at_hand = document.do_at_hand
    tools = {
        "select": Select(document, shared),
        "lasso": Select(document, shared, DragShape.LASSO),
        "point": DrawPoint(document, shared),
        "line": DrawPath(document, shared, Geometry.LINE, at_hand),
        "area": DrawPath(document, shared, Geometry.AREA, at_hand),
        "rectangle": DrawShape(document, shared, Shape.RECTANGLE),
        "circle": DrawShape(document, shared, Shape.CIRCLE),
        "parallel": DrawParallel(document, shared),
        "edit": EditVertices(document, shared),
        "move": MoveFeatures(document, shared),
        "split": SplitLine(document, shared),
        "extend": ExtendLine(document, shared),
        "trim": TrimLine(document, shared),
        "measure": MeasureTool(document, shared),
        "measure-area": MeasureTool(document, shared, is_closed=True),
        "template": DrawTemplate(shared, TemplatePart.SHAPE),
        "template-zone": DrawTemplate(shared, TemplatePart.EMPTY_ZONE),
        "paint-brush": PaintBrush(document, shared, at_hand),
        "paint-rectangle": PaintOutline(document, shared, at_hand, DragShape.BOX),
        "paint-lasso": PaintOutline(document, shared, at_hand, DragShape.LASSO),
        "paint-segment": PaintSegments(document, shared, at_hand),
    }
    return MouseToolbox(document, shared, tools)
