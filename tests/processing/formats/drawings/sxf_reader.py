"""Readers of both forms of SXF, written from a CAD program's file, not from the writer."""

from __future__ import annotations

import re
from dataclasses import dataclass, field

_FEATURE = re.compile(r"/\*(SXF3?)\r\n#([0-9]+) = ([a-z_]+)\((.*)\)\r\n\1\*/")
_VALUE = re.compile(r"\\'(.*?)\\'|'(\([^)]*\)|[^']*)'")
_ENTITY = re.compile(r"#([0-9]+)=(.*?);\r\n", re.DOTALL)
_ESCAPE = re.compile(r"\\X2\\([0-9A-F]+)\\X0\\")


@dataclass
class ReadDrawing:
    """What both forms say: places on the map in mm, by layer; texts; the figure's placing."""

    lines: list[tuple[str, list[tuple[float, float]]]] = field(default_factory=list)
    circles: list[tuple[str, tuple[float, float], float]] = field(default_factory=list)
    texts: list[tuple[str, str, tuple[float, float]]] = field(default_factory=list)
    layers: list[str] = field(default_factory=list)
    ratio: float = 0.0
    placed: tuple[float, float] = (0.0, 0.0)
    sheet: tuple[float, float] = (0.0, 0.0)
    colours: set[str] = field(default_factory=set)


def read_sfc(data: bytes) -> ReadDrawing:
    """Read the feature comments."""
    text = data.decode("cp932")
    assert text.startswith("ISO-10303-21;\r\nHEADER;\r\nFILE_DESCRIPTION(('SCADEC level2 feature_")
    assert text.endswith("ENDSEC;\r\nEND-ISO-10303-21;\r\n")
    found = _FEATURE.findall(text)
    assert [int(number) for _, number, _, _ in found] == list(range(10, 10 * len(found) + 1, 10))
    features = [(name, [a or b for a, b in _VALUE.findall(rest)]) for _, _, name, rest in found]
    drawing = ReadDrawing(layers=[values[0] for name, values in features if name[:5] == "layer"])
    for name, values in features:
        layer = drawing.layers[int(values[0]) - 1] if values[0].isdigit() else ""
        match name:
            case "polyline_feature":
                xs, ys = ([float(one) for one in axis[1:-1].split(",")] for axis in values[5:])
                assert len(xs) == int(values[4])
                drawing.lines.append((layer, list(zip(xs, ys, strict=True))))
            case "circle_feature":
                x, y, radius = map(float, values[4:])
                drawing.circles.append((layer, (x, y), radius))
            case "text_string_feature":
                drawing.texts.append((layer, values[3], (float(values[4]), float(values[5]))))
            case "sfig_locate_feature":
                drawing.placed = (float(values[2]), float(values[3]))
                drawing.ratio = float(values[5])
            case "drawing_sheet_feature":
                drawing.sheet = (float(values[3]), float(values[4]))
            case "pre_defined_colour_feature":
                drawing.colours.add(values[0])
    return drawing


def read_p21(data: bytes) -> ReadDrawing:
    """Read the entities; each that is named must be there."""
    text = data.decode("ascii")
    assert "'SCADEC level2 AP202_mode'" in text
    found = dict(_ENTITY.findall(text))
    assert all(name in found for body in found.values() for name in re.findall(r"#([0-9]+)", body))
    drawing = ReadDrawing()

    def place(name: str) -> tuple[float, float]:
        x, y = re.findall(r"-?[0-9.]+", found[name].partition("(' ',(")[2])
        return float(x), float(y)

    def names(body: str) -> list[str]:
        return re.findall(r"#([0-9]+)", body)

    for body in found.values():
        if body.startswith("PRESENTATION_LAYER_ASSIGNMENT('"):
            layer, members = _unescaped(body.split("'")[1]), names(body)
            if not layer.startswith("$$"):
                drawing.layers.append(layer)
                for member in members:
                    _read_member(drawing, layer, names(found[member])[-1], found, place)
        if body.startswith("SYMBOL_TARGET"):
            placement, ratio = names(body)[0], float(body.split(",")[-1][:-1])
            drawing.ratio, drawing.placed = ratio, place(names(found[placement])[0])
        if body.startswith("PLANAR_BOX"):
            drawing.sheet = (float(body.split(",")[1]), float(body.split(",")[2]))
        if body.startswith("DRAUGHTING_PRE_DEFINED_COLOUR"):
            drawing.colours.add(body.split("'")[1])
    return drawing


def _read_member(drawing, layer, name, found, place) -> None:  # type: ignore[no-untyped-def]
    body = found[name]
    inner = re.findall(r"#([0-9]+)", body)
    if body.startswith("POLYLINE"):
        drawing.lines.append((layer, [place(one) for one in inner]))
    elif body.startswith("CIRCLE"):
        centre = place(re.findall(r"#([0-9]+)", found[inner[0]])[0])
        drawing.circles.append((layer, centre, float(body.split(",")[-1][:-1])))
    else:
        assert body.startswith("TEXT_LITERAL_WITH_EXTENT")
        spot = place(re.findall(r"#([0-9]+)", found[inner[0]])[0])
        drawing.texts.append((layer, _unescaped(body.split("','")[1].split("',#")[0]), spot))


def _unescaped(words: str) -> str:
    plain = _ESCAPE.sub(lambda hit: bytes.fromhex(hit[1]).decode("utf-16-be"), words)
    return plain.replace("''", "'")
