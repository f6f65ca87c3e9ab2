"""The P21 form of SXF: a drawing as entities of STEP (ISO 10303-21, application protocol 202)."""

from __future__ import annotations

import math
from itertools import groupby

from processing.formats.drawings.sxf_drawing import (
    FONT,
    MAP_FIGURE,
    Place,
    SxfCircle,
    SxfDrawing,
    SxfLine,
    SxfShape,
    SxfText,
)
from processing.formats.drawings.sxf_looks import COLOURS, LINE_TYPES, WIDTHS_MM
from processing.formats.drawings.sxf_sfc import sxf_header

_LENGTH_UNIT = "(\nLENGTH_UNIT()\nNAMED_UNIT(*)\nSI_UNIT(.MILLI.,.METRE.)\n)"
_ANGLE_UNIT = "(\nNAMED_UNIT(*)\nPLANE_ANGLE_UNIT()\nSI_UNIT($,.RADIAN.)\n)"
_HIDDEN_LAYER = "$$SXF_dummy_layer_for_subfigure"
_FIGURE = "$$SXF_FM_"
_ROWS = ("baseline", "middleline", "topline")
_COLUMNS = ("left", "centre", "right")
_BOUNDS = {"left": "baseline left", "centre": "baseline centre", "right": "baseline right"}


def p21_text(drawing: SxfDrawing, name: str) -> str:
    """A drawing as P21, which is all ASCII: other letters are escaped as UTF-16.

    References
    ----------
    SXF level 2, AP202 files: curves and texts as annotation occurrences, the partial figure as a
    draughting subfigure placed by a symbol target, layers as presentation layer assignments; in
    the order and with the fixed words of CAD programs' files.
    """
    file = _Entities(drawing)
    file.draw()
    head = sxf_header("AP202_mode", _escaped(name), drawing.time)
    body = "".join(f"#{number * 10}={entity};\n" for number, entity in enumerate(file.entities, 1))
    return f"{head}{body}ENDSEC;\nEND-ISO-10303-21;\n".replace("\n", "\r\n")


class _Entities:
    """The entities of a drawing as they are numbered."""

    def __init__(self, drawing: SxfDrawing) -> None:
        self.entities: list[str] = []
        self._drawing = drawing
        self._on_layers: dict[str, list[str]] = {}
        styles = drawing.styles
        colours, types = list(COLOURS), {code: name for name, code in LINE_TYPES.items()}
        unit = self._add(_LENGTH_UNIT)
        self._colours = {
            code: self._add(f"DRAUGHTING_PRE_DEFINED_COLOUR('{colours[code - 1]}')")
            for code in sorted({style.colour for style in styles})
        }
        self._types = {
            code: self._add(f"DRAUGHTING_PRE_DEFINED_CURVE_FONT('{types[code]}')")
            for code in sorted({style.line_type for style in styles})
        }
        self._widths = {
            code: self._add(
                "LENGTH_MEASURE_WITH_UNIT("
                f"POSITIVE_LENGTH_MEASURE({_length(WIDTHS_MM[code - 1])}),{unit})"
            )
            for code in sorted({style.width for style in styles})
        }
        source = self._add("EXTERNAL_SOURCE(IDENTIFIER('scadec'))")
        font = f"EXTERNALLY_DEFINED_TEXT_FONT(IDENTIFIER('{_escaped(FONT)}'),{source})"
        self._font = self._add(font)

    def draw(self) -> None:
        """Add the figure, its place, what lies beside it, the sheet and its layers."""
        drawn = [self._shape(shape) for shape in self._drawing.on_map]
        figure = self._figure(drawn)
        on_sheet = [figure, *(self._shape(shape) for shape in self._drawing.on_paper)]
        self._on_layers = {_HIDDEN_LAYER: [figure], **self._on_layers}
        sheet = self._sheet(on_sheet)
        for layer, members in self._on_layers.items():
            joined = ",".join(members)
            assigned = self._add(
                f"PRESENTATION_LAYER_ASSIGNMENT('{_escaped(layer)}',' ',({joined}))"
            )
            self._add(f"PRESENTATION_LAYER_USAGE({assigned},{sheet})")

    def _add(self, entity: str) -> str:
        """Add an entity; gives how others name it."""
        self.entities.append(entity)
        return f"#{len(self.entities) * 10}"

    def _shape(self, shape: SxfShape) -> str:
        match shape:
            case SxfLine():
                points = ",".join(map(self._point, shape.places))
                drawn = self._curve(shape, self._add(f"POLYLINE(' ',({points}))"))
            case SxfCircle():
                placed = self._add(f"AXIS2_PLACEMENT_2D(' ',{self._point(shape.centre)},$)")
                circle = self._add(f"CIRCLE(' ',{placed},{_length(shape.radius)})")
                drawn = self._curve(shape, circle)
            case SxfText():
                drawn = self._text(shape)
        self._on_layers.setdefault(shape.style.layer, []).append(drawn)
        return drawn

    def _curve(self, shape: SxfLine | SxfCircle, curve: str) -> str:
        style = shape.style
        looks = f"{self._types[style.line_type]},{self._widths[style.width]}"
        pen = self._add(f"CURVE_STYLE(' ',{looks},{self._colours[style.colour]})")
        assigned = self._add(f"PRESENTATION_STYLE_ASSIGNMENT(({pen}))")
        return self._add(
            "(\nANNOTATION_CURVE_OCCURRENCE()\nANNOTATION_OCCURRENCE()\n"
            "DRAUGHTING_ANNOTATION_OCCURRENCE()\nGEOMETRIC_REPRESENTATION_ITEM()\n"
            f"REPRESENTATION_ITEM(' ')\nSTYLED_ITEM(({assigned}),{curve})\n)"
        )

    def _text(self, shape: SxfText) -> str:
        row, column = _ROWS[(shape.base - 1) // 3], _COLUMNS[(shape.base - 1) % 3]
        extent = self._add(f"PLANAR_EXTENT(' ',{_length(shape.width)},{_length(shape.height)})")
        placed = self._placement(shape.place, shape.angle_deg)
        literal = self._add(
            f"TEXT_LITERAL_WITH_EXTENT('$$SXF_{row} {column}','{_escaped(shape.words)}',{placed},"
            f"'{_BOUNDS[column]}',.RIGHT.,{self._font},{extent})"
        )
        defined = self._add(f"TEXT_STYLE_FOR_DEFINED_FONT({self._colours[shape.style.colour]})")
        letter = shape.width / max(len(shape.words), 1)
        style = self._add(
            f"(\nTEXT_STYLE(' ',{defined})\n"
            "TEXT_STYLE_WITH_BOX_CHARACTERISTICS(("
            f"BOX_HEIGHT({_length(shape.height)}),BOX_WIDTH({_length(letter)}),"
            f"BOX_SLANT_ANGLE({_fine(0.0)}),BOX_ROTATE_ANGLE({_fine(0.0)})))\n"
            f"TEXT_STYLE_WITH_SPACING(LENGTH_MEASURE({_length(0.0)}))\n)"
        )
        assigned = self._add(f"PRESENTATION_STYLE_ASSIGNMENT(({style}))")
        return self._add(
            "(\nANNOTATION_OCCURRENCE()\nANNOTATION_TEXT_OCCURRENCE()\n"
            "DRAUGHTING_ANNOTATION_OCCURRENCE()\nGEOMETRIC_REPRESENTATION_ITEM()\n"
            f"REPRESENTATION_ITEM(' ')\nSTYLED_ITEM(({assigned}),{literal})\n)"
        )

    def _figure(self, drawn: list[str]) -> str:
        """The partial figure of what was drawn, and its place on the sheet."""
        context = self._context()
        origin = self._add(f"AXIS2_PLACEMENT_2D(' ',{self._point((0.0, 0.0))},$)")
        name = _escaped(_FIGURE + MAP_FIGURE)
        items = ",".join([*drawn, origin])
        figure = self._add(f"DRAUGHTING_SUBFIGURE_REPRESENTATION('{name}',({items}),{context})")
        mapped = self._add(f"SYMBOL_REPRESENTATION_MAP({origin},{figure})")
        ratio = _fine(1 / self._drawing.scale)
        placed = self._placement(self._drawing.placed_at, 0.0)
        target = self._add(f"SYMBOL_TARGET(' ',{placed},{ratio},{ratio})")
        symbol = self._add(
            "(\nANNOTATION_SYMBOL()\nGEOMETRIC_REPRESENTATION_ITEM()\n"
            f"MAPPED_ITEM({mapped},{target})\nREPRESENTATION_ITEM(' ')\n)"
        )
        style = self._add("PRESENTATION_STYLE_ASSIGNMENT((NULL_STYLE(.NULL.)))")
        return self._add(
            "(\nANNOTATION_OCCURRENCE()\nANNOTATION_SUBFIGURE_OCCURRENCE()\n"
            "ANNOTATION_SYMBOL_OCCURRENCE()\nDRAUGHTING_ANNOTATION_OCCURRENCE()\n"
            f"GEOMETRIC_REPRESENTATION_ITEM()\nREPRESENTATION_ITEM('{name}')\n"
            f"STYLED_ITEM(({style}),{symbol})\n)"
        )

    def _sheet(self, drawn: list[str]) -> str:
        """The sheet with what a drawing must say of itself; blank where nothing is known."""
        definition = self._add("DRAWING_DEFINITION(' ',' ')")
        revision = self._add(f"DRAUGHTING_DRAWING_REVISION('01',{definition},' ')")
        title = _escaped(self._drawing.title or " ")
        self._add(f"DRAUGHTING_TITLE(({revision}),'JAPANESE','{title}')")
        width, height = self._drawing.size_mm
        corner = self._placement((0.0, 0.0), 0.0)
        box = self._add(f"PLANAR_BOX(' ',{_length(width)},{_length(height)},{corner})")
        items = ",".join([*drawn, box])
        paper = f"A{self._drawing.paper}_horizontal"
        context = self._context()
        sheet = self._add(f"DRAWING_SHEET_REVISION('{paper}',({items}),{context},'01')")
        self._add(f"DRAWING_SHEET_REVISION_USAGE({sheet},{revision},'01')")
        self._add(f"PRESENTATION_SIZE({sheet},{box})")
        contract_type = self._add("CONTRACT_TYPE(' ')")
        contract = self._add(f"CONTRACT(' ',' ',{contract_type})")
        self._add(f"DRAUGHTING_CONTRACT_ASSIGNMENT({contract},({revision}))")
        status = self._add("APPROVAL_STATUS(' ')")
        approval = self._add(f"APPROVAL({status},' ')")
        year, month, day = self._drawing.date
        date = self._add(f"CALENDAR_DATE({year},{day},{month})")
        self._add(f"APPROVAL_DATE_TIME({date},{approval})")
        self._add(f"DRAUGHTING_APPROVAL_ASSIGNMENT({approval},({revision}))")
        for role in ("creator", "owner"):
            named = self._add(f"ORGANIZATION_ROLE('{role}')")
            organisation = self._add("ORGANIZATION($,' ',' ')")
            self._add(f"DRAUGHTING_ORGANIZATION_ASSIGNMENT({organisation},{named},({revision}))")
        return sheet

    def _context(self) -> str:
        angle, length = self._add(_ANGLE_UNIT), self._add(_LENGTH_UNIT)
        return self._add(
            "(\nGEOMETRIC_REPRESENTATION_CONTEXT(2)\n"
            f"GLOBAL_UNIT_ASSIGNED_CONTEXT(({angle},{length}))\n"
            "REPRESENTATION_CONTEXT('ID1','2D')\n)"
        )

    def _placement(self, place: Place, angle_deg: float) -> str:
        cos, sin = math.cos(math.radians(angle_deg)), math.sin(math.radians(angle_deg))
        direction = self._add(f"DIRECTION(' ',({_fine(cos)},{_fine(sin)}))")
        return self._add(f"AXIS2_PLACEMENT_2D(' ',{self._point(place)},{direction})")

    def _point(self, place: Place) -> str:
        return self._add(f"CARTESIAN_POINT(' ',({_length(place[0])},{_length(place[1])}))")


def _escaped(words: str) -> str:
    r"""Words as a string of ISO 10303-21: ``\X2\`` before UTF-16, ``\X0\`` behind it."""
    parts = []
    for is_plain, letters in groupby(words, key=lambda one: " " <= one <= "~"):
        joined = "".join(letters)
        if is_plain:
            parts.append(joined.replace("\\", "\\\\").replace("'", "''"))
        else:
            parts.append(f"\\X2\\{joined.encode('utf-16-be').hex().upper()}\\X0\\")
    return "".join(parts)


def _length(value: float) -> str:
    return f"{value:.6f}"


def _fine(value: float) -> str:
    """Directions and ratios."""
    return f"{value:.14f}"
