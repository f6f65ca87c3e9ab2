"""The SFC form of SXF: each feature in a comment of a STEP file, in Shift_JIS."""

from __future__ import annotations

from collections.abc import Iterator

from processing.formats.drawings.sxf_drawing import (
    FONT,
    MAP_FIGURE,
    SxfCircle,
    SxfDrawing,
    SxfLine,
    SxfShape,
    SxfText,
)
from processing.formats.drawings.sxf_looks import COLOURS, LINE_TYPES, WIDTHS_MM

_HEADER = """ISO-10303-21;
HEADER;
FILE_DESCRIPTION(('SCADEC level2 {mode}'),
        '2;1');
FILE_NAME('{name}',
        '{time}',
        (''),
        (''),
        'SCADEC_API_Ver3.10$$3.0',
        'Zuka',
        '');
FILE_SCHEMA(('ASSOCIATIVE_DRAUGHTING'));
ENDSEC;
DATA;
"""


def sxf_header(mode: str, name: str, time: str) -> str:
    """The head of both forms.

    Parameters
    ----------
    mode : {"feature_mode", "AP202_mode"}
    name : str
        Of the file, as the form writes texts.
    """
    return _HEADER.format(mode=mode, name=name, time=time)


def sfc_text(drawing: SxfDrawing, name: str) -> str:
    """A drawing as SFC.

    References
    ----------
    SXF level 2, feature comment files: definitions, figures, their places, attributes of the
    drawing, its sheet, its layers; as CAD programs write them.
    """
    blocks = [sxf_header("feature_mode", _quotable(name), drawing.time)]
    for number, (feature, version) in enumerate(_features(drawing), 1):
        blocks.append(f"\n/*SXF{version}\n#{number * 10} = {feature}\nSXF{version}*/\n")
    blocks.append("ENDSEC;\nEND-ISO-10303-21;\n")
    return "".join(blocks).replace("\n", "\r\n")


def _features(drawing: SxfDrawing) -> Iterator[tuple[str, str]]:
    """Each feature and the mark of the version that has it, in the order of the form."""
    layers = {layer: str(code) for code, layer in enumerate(drawing.layers, 1)}
    for feature in _definitions(drawing):
        yield feature, ""
    for shape in drawing.on_map:
        yield _shape(shape, layers), ""
    yield _call("sfig_org_feature", _string(MAP_FIGURE), "1"), ""
    ratio = _fine(1 / drawing.scale)
    x, y = map(_length, drawing.placed_at)
    placed = ("0", _string(MAP_FIGURE), x, y, _fine(0.0), ratio, ratio)
    yield _call("sfig_locate_feature", *placed), ""
    for shape in drawing.on_paper:
        yield _shape(shape, layers), ""
    blank = [_string(" ")]
    date = [str(one) for one in drawing.date]
    yield _call("drawing_attribute_feature", *blank * 7, *date, *blank * 2), "3"
    width, height = map(str, drawing.size_mm)
    sheet = (_string(drawing.title or " "), str(drawing.paper), "1", width, height)
    yield _call("drawing_sheet_feature", *sheet), ""
    for layer in drawing.layers:
        yield _call("layer_feature", _string(layer), "1"), ""


def _definitions(drawing: SxfDrawing) -> Iterator[str]:
    styles = drawing.styles
    colours = list(COLOURS)
    types = {code: name for name, code in LINE_TYPES.items()}
    for code in sorted({style.colour for style in styles}):
        yield _call("pre_defined_colour_feature", _string(colours[code - 1]))
    for code in sorted({style.line_type for style in styles}):
        yield _call("pre_defined_font_feature", _string(types[code]))
    for code in sorted({style.width for style in styles}):
        yield _call("width_feature", _length(WIDTHS_MM[code - 1]))
    yield _call("text_font_feature", _string(FONT))


def _shape(shape: SxfShape, layers: dict[str, str]) -> str:
    style = shape.style
    looks = (layers[style.layer], str(style.colour))
    pen = (str(style.line_type), str(style.width))
    match shape:
        case SxfLine():
            lists = (
                f"({','.join(map(_length, axis))})" for axis in zip(*shape.places, strict=True)
            )
            return _call("polyline_feature", *looks, *pen, str(len(shape.places)), *lists)
        case SxfCircle():
            circle = (*map(_length, shape.centre), _length(shape.radius))
            return _call("circle_feature", *looks, *pen, *circle)
        case SxfText():
            x, y = map(_length, shape.place)
            box = (_length(shape.height), _length(shape.width), _length(0.0))
            turned = (_fine(shape.angle_deg), _fine(0.0), str(shape.base), "1")
            words = _string(shape.words)
            return _call("text_string_feature", *looks, "1", words, x, y, *box, *turned)


def _call(name: str, *values: str) -> str:
    quoted = (value if value.startswith("\\'") else f"'{value}'" for value in values)
    return f"{name}({','.join(quoted)})"


def _string(words: str) -> str:
    return f"\\'{_quotable(words)}\\'"


def _quotable(words: str) -> str:
    """Words without what ends a string or the comment: the wide letters stand for it."""
    return words.replace("'", "’").replace("\\", "￥").replace("*/", "＊/")


def _length(value: float) -> str:
    return f"{value:.6f}"


def _fine(value: float) -> str:
    """Angles and ratios."""
    return f"{value:.14f}"
