"""DXF for CAD: the map in metres, a layer for each kind, symbols as blocks, names as texts."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

import numpy as np

from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.drawings.dxf_blocks import (
    add_attributes,
    block_values,
    define_attributes,
    need_symbol_block,
)
from processing.formats.drawings.dxf_bodies import BODY_SUFFIX, add_body
from processing.formats.drawings.dxf_document import (
    APP_ID,
    ENCODINGS,
    DxfDocument,
    DxfVersion,
    check_one_of,
)
from processing.formats.drawings.dxf_labels import LABEL_HEIGHT_M, label_of
from processing.formats.drawings.dxf_text import dxf_strings, dxf_text
from processing.formats.drawings.sxf_looks import cad_catalogue, label_layer
from processing.formats.drawings.symbol_shapes import symbol_rotation_deg
from processing.formats.map_delivery import DxfOptions, MapDelivery
from processing.map.catalogue import Catalogue, FeatureKind, Geometry
from processing.map.feature import AttributeValue, Feature, Position, Status
from processing.map.solids import solid_of, thickness_of

CANDIDATE_SUFFIX = "_候補"

_INT32 = 1 << 31
_MOST_XDATA_BYTES = 16_000
_CHECK_EVERY = 16  # features


def write_dxf(
    path: Path,
    features: Iterable[Feature],
    catalogue: Catalogue,
    *,
    version: DxfVersion = "R2018",
    encoding: str = "utf-8",
    crs: str = "",
    language: Language | None = None,
    is_flat: bool = False,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    r"""Draw features: 3D polylines, closed ones for areas, points as their symbol's block.

    A block carries the attributes of its feature. Areas of a kind that has a thickness are bodies
    of 3D faces besides, on a layer of their own.

    Parameters
    ----------
    features : iterable of Feature
        Rejected ones are left out; candidates are drawn on a layer of their own.
    version : {"R12", "R2000", "R2007", "R2010", "R2018"}
        AC1009, AC1015, AC1021, AC1024 or AC1032.
    encoding : {"utf-8", "cp932"}
        What was asked for; the version decides: R2007 and later are UTF-8, R12 and R2000 cp932.
        What cp932 lacks is written as ``\U+XXXX``, which CAD programs read.
    language : {"en", "ja"} or None
        Of the choices in the attributes of blocks; None for the words that are stored.
    is_flat : bool
        In plan, at height 0, without bodies.
    crs : str
        ``EPSG:n`` or empty; written, or that it is not known, to the drawing's properties (R2018)
        and to the extended data of layer 0.
    never : iterable of Path
        Files that must not be overwritten.

    Raises
    ------
    OutOfRange
        There is no such version or encoding.
    Unsuitable
        A feature's kind is not in the catalogue, or its attributes are longer than DXF holds.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    check_one_of(encoding, ENCODINGS.values())
    monitor = monitor or SilentMonitor()
    size = DrawnSize(is_flat=is_flat)
    drawing = MapDrawing(catalogue, version, crs, language, size=size)
    for number, feature in enumerate(features):
        if number % _CHECK_EVERY == 0:
            monitor.check()
        if feature.status is not Status.REJECTED:
            drawing.add(feature)
    drawing.finish()
    with write_safely(path, never=never) as temporary:
        drawing.document.write(temporary, monitor)


def write_dxf_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Draw a map that is handed in, as :func:`write_dxf`."""
    options = delivery.options_of(DxfOptions)
    catalogue = delivery.catalogue
    if options.drawing_layers == "cad":
        catalogue = cad_catalogue(catalogue)
    write_dxf(
        path,
        delivery.features,
        catalogue,
        version=cast("DxfVersion", options.dxf_version),
        encoding=options.encoding,
        crs=delivery.crs,
        language=delivery.language,
        is_flat=options.dxf_heights == "2d",
        monitor=monitor,
        never=never,
    )


@dataclass(frozen=True)
class _Looks:
    """Where a feature is drawn and how: what its entities have in common."""

    layer: str
    own: Mapping[str, Any]  # attributes of DXF in which the kind differs from its layer


@dataclass(frozen=True)
class DrawnSize:
    """How large a drawing's symbols and patterns are, and whether it has words.

    Attributes
    ----------
    scale : int
        At which symbols and patterns have the size on paper that they have at 1:500 in the
        catalogue.
    has_labels : bool
        Whether names and numbers are written beside features.
    is_flat : bool
        Whether it lies in plan, at height 0: lines then show their patterns in every program.
    """

    scale: int = 500
    has_labels: bool = True
    is_flat: bool = False

    @property
    def factor(self) -> float:
        """Of symbols and patterns."""
        return self.scale / 500


class MapDrawing:
    """A drawing of a map being filled.

    Parameters
    ----------
    catalogue : Catalogue
    version, crs, language
        As of :func:`write_dxf`.
    size : DrawnSize
        That of level 500, with labels, where nothing else is said.

    Attributes
    ----------
    document : DxfDocument
    """

    def __init__(
        self,
        catalogue: Catalogue,
        version: DxfVersion,
        crs: str,
        language: Language | None,
        *,
        size: DrawnSize = DrawnSize(),
    ) -> None:
        self._size = size
        self._catalogue = catalogue
        self._language = language
        self.document = DxfDocument(version)
        self._doc, self._space = self.document.doc, self.document.space
        self._lowest = [math.inf] * 3
        self._highest = [-math.inf] * 3
        header = self._doc.header
        header["$LTSCALE"] = size.factor
        header["$LUNITS"] = 2
        header["$LUPREC"] = 3
        self.document.tell_system(crs)
        self.document.add_line_types()

    def add(self, feature: Feature) -> None:
        """Draw a feature."""
        if feature.kind not in self._catalogue:
            raise _refusal(
                feature,
                Text("The catalogue has no such kind.", "カタログにない種別です。"),
                Text(
                    "Add the kind to the catalogue, or give the feature another one.",
                    "カタログに種別を追加するか、地物の種別を変更してください。",
                ),
            )
        kind = self._catalogue[feature.kind]
        looks = self._looks(kind, feature)
        positions = [self._place(vertex.xyz) for vertex in feature.vertices]
        data = self._extended_data(feature)
        for entity in self._entities(kind, feature, positions, looks):
            entity.set_xdata(APP_ID, data)
        if self._size.has_labels:
            self._add_label(kind, feature, looks)
        for axis in range(3):
            values = [position[axis] for position in positions]
            self._lowest[axis] = min(self._lowest[axis], *values)
            self._highest[axis] = max(self._highest[axis], *values)

    def _place(self, position: Position) -> Position:
        return (position[0], position[1], 0.0) if self._size.is_flat else position

    # Any: an entity of ezdxf, which is not typed here.
    def _line(
        self, positions: list[Position], attributes: Mapping[str, Any], *, is_closed: bool = False
    ) -> Any:
        looks = dict(attributes)
        if not self._size.is_flat:
            return self._space.add_polyline3d(positions, close=is_closed, dxfattribs=looks)
        plan = [(x, y) for x, y, _ in positions]
        if self.document.has_light_polylines:
            return self._space.add_lwpolyline(plan, close=is_closed, dxfattribs=looks)
        return self._space.add_polyline2d(plan, close=is_closed, dxfattribs=looks)

    def _entities(
        self, kind: FeatureKind, feature: Feature, positions: list[Position], looks: _Looks
    ) -> list[Any]:
        attributes = {"layer": looks.layer, **looks.own}
        match feature.geometry:
            case Geometry.POINT:
                if kind.symbol:
                    return [self._symbol(kind, feature, attributes)]
                return [self._space.add_point(positions[0], dxfattribs=attributes)]
            case Geometry.LINE:
                return [self._line(positions, attributes)]
            case Geometry.AREA:
                outline = self._line(positions, attributes, is_closed=True)
                return [outline, *self._body(kind, feature, positions, looks)]

    def _symbol(self, kind: FeatureKind, feature: Feature, attributes: Mapping[str, Any]) -> Any:
        """The block of a symbol with what is known about the feature."""
        block = need_symbol_block(self.document, kind.symbol)
        alike = (one for one in self._catalogue if one.symbol == kind.symbol)
        define_attributes(block, {one.id: one for each in alike for one in each.attributes})
        turned = {**attributes, "rotation": symbol_rotation_deg(feature)}
        if self._size.factor != 1.0:
            turned |= dict.fromkeys(("xscale", "yscale", "zscale"), self._size.factor)
        place = self._place(feature.vertices[0].xyz)
        insert = self._space.add_blockref(block.name, place, dxfattribs=turned)
        add_attributes(insert, block_values(kind, feature, self._language), self.document.encoding)
        return insert

    def _body(
        self, kind: FeatureKind, feature: Feature, positions: list[Position], looks: _Looks
    ) -> list[Any]:
        thickness_m = 0.0 if self._size.is_flat else thickness_of(kind, feature)
        solid = solid_of(np.array(positions), thickness_m) if thickness_m else None
        if solid is None:
            return []
        layer = looks.layer + BODY_SUFFIX
        self._need_layer(layer, kind)
        self._lowest[2] = min(self._lowest[2], float(solid.positions[:, 2].min()))
        return add_body(self._space, solid, {**looks.own, "layer": layer, "linetype": "BYLAYER"})

    def _looks(self, kind: FeatureKind, feature: Feature) -> _Looks:
        layer = kind.layer
        if feature.status is Status.CANDIDATE:
            layer += CANDIDATE_SUFFIX
        self._need_layer(layer, kind)
        # Kinds may share a layer: it looks like the first of them, the others say how they differ.
        first = self._catalogue.of_layer(kind.layer)[0]
        own: dict[str, Any] = {}
        if (kind.aci, kind.colour) != (first.aci, first.colour):
            own["color"] = kind.aci
            if self.document.has_true_colours:
                own["true_color"] = int(kind.colour[1:], 16)
        if kind.line_type != first.line_type:
            own["linetype"] = kind.line_type.upper()
        return _Looks(layer, own)

    def _need_layer(self, layer: str, kind: FeatureKind) -> None:
        if layer in self._doc.layers:
            return
        self.document.require_encodable(layer)
        first = self._catalogue.of_layer(kind.layer)[0]
        looks: dict[str, Any] = {"color": first.aci, "linetype": first.line_type.upper()}
        if self.document.has_true_colours:
            looks["true_color"] = int(first.colour[1:], 16)
        self._doc.layers.add(layer, **looks)

    def _add_label(self, kind: FeatureKind, feature: Feature, looks: _Looks) -> None:
        label = label_of(kind, feature)
        if label is None:
            return
        layer = label_layer(looks.layer)
        self._need_layer(layer, kind)
        attributes = {
            "layer": layer,
            "height": LABEL_HEIGHT_M,
            "rotation": label.rotation_deg,
            **{key: value for key, value in looks.own.items() if key != "linetype"},
        }
        self.document.write_text(label.words, self._place(label.position), label.align, attributes)

    def _extended_data(self, feature: Feature) -> list[tuple[int, Any]]:
        encoding = self.document.encoding
        data: list[tuple[int, Any]] = [
            (1000, dxf_text(feature.id, encoding)),
            (1000, feature.kind),
            (1000, feature.status.value),
            (1040, float(feature.provenance.confidence)),
            (1000, dxf_text(feature.provenance.tool, encoding)),
        ]
        for name, value in feature.attributes.items():
            if value is not None:
                named = [(1000, piece) for piece in dxf_strings(name, encoding)[:1]]
                data += [(1002, "{"), *named, *_tags(value, encoding), (1002, "}")]
        size = sum(len(str(value).encode(encoding)) + 3 for _, value in data)
        if size > _MOST_XDATA_BYTES:
            raise _refusal(
                feature,
                Text(
                    "The attributes are longer than a DXF entity can hold (16 kB).",
                    "属性がDXFの要素に入る長さ（16 kB）を超えています。",
                ),
                Text("Shorten the texts.", "文字列を短くしてください。"),
            )
        return data

    def finish(self) -> None:
        """Set the extent and what is seen when the file is opened."""
        if math.inf not in self._lowest:
            self.document.show(tuple(self._lowest), tuple(self._highest))


def _tags(value: AttributeValue, encoding: str) -> list[tuple[int, Any]]:
    """A value as extended data: bool 1070, whole number 1071, number 1040, text 1000 in pieces."""
    if isinstance(value, bool):
        return [(1070, int(value))]
    if isinstance(value, int) and -_INT32 <= value < _INT32:
        return [(1071, value)]
    if isinstance(value, float) and math.isfinite(value):
        return [(1040, value)]
    return [(1000, piece) for piece in dxf_strings(str(value), encoding)]


def _refusal(feature: Feature, what: Text, remedy: Text) -> Unsuitable:
    where = Text(f"{feature.kind}, feature {feature.id}", f"{feature.kind}、地物 {feature.id}")
    return Unsuitable(what, where, remedy)
