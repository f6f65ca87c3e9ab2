"""The tools that a window's mouse can take, made for its document."""

from __future__ import annotations

from app.document.document import Document
from processing.map.catalogue import Geometry
from widgets.mouse_tools.drawing.draw_line import DrawLine
from widgets.mouse_tools.drawing.draw_parallel import DrawParallel
from widgets.mouse_tools.drawing.draw_point import DrawPoint
from widgets.mouse_tools.drawing.draw_row import DrawRow
from widgets.mouse_tools.drawing.draw_shape import DrawShape, ThreePointShape
from widgets.mouse_tools.drawing.draw_template import DrawTemplate, TemplatePart
from widgets.mouse_tools.drawing.measure import MeasureTool
from widgets.mouse_tools.drawing.toolbox import MouseToolbox
from widgets.mouse_tools.editing.cut_lines import ExtendLine, SplitLine, TrimLine
from widgets.mouse_tools.editing.edit_vertices import EditVertices
from widgets.mouse_tools.editing.move_features import MoveFeatures
from widgets.mouse_tools.editing.select import Select
from widgets.mouse_tools.mouse_tool import DragShape
from widgets.mouse_tools.painting.paint_brush import PaintBrush
from widgets.mouse_tools.painting.paint_outline import PaintOutline
from widgets.mouse_tools.painting.paint_segments import PaintSegments


def make_toolbox(document: Document) -> MouseToolbox:
    """All mouse tools, the pointer in the hand; views come later."""
    shared = document.shared
    in_background = document.run_in_background
    tools = {
        "select": Select(document, shared),
        "lasso": Select(document, shared, DragShape.LASSO),
        "point": DrawPoint(document, shared),
        "line": DrawLine(document, shared, Geometry.LINE, in_background),
        "area": DrawLine(document, shared, Geometry.AREA, in_background),
        "rectangle": DrawShape(document, shared, ThreePointShape.RECTANGLE),
        "circle": DrawShape(document, shared, ThreePointShape.CIRCLE),
        "row": DrawRow(document, shared),
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
        "paint-brush": PaintBrush(document, shared, in_background),
        "paint-rectangle": PaintOutline(document, shared, in_background, DragShape.BOX),
        "paint-lasso": PaintOutline(document, shared, in_background, DragShape.LASSO),
        "paint-segment": PaintSegments(document, shared, in_background),
    }
    return MouseToolbox(document, shared, tools)
