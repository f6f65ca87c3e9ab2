"""Shapefiles: one for each kind, with heights, for GIS programs of offices."""

from __future__ import annotations

import shutil
import warnings
from collections.abc import Mapping, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from processing.core.errors import NoSpace, report_as_user_error
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.format import MAP
from processing.formats.map_delivery import MapDelivery, Position, ShapefileOptions
from processing.formats.shift_jis import ShiftJisText
from processing.formats.vectors.geopackage import (
    GEOMETRY_TYPES,
    ColumnValues,
    feature_columns,
    feature_shapes,
)
from processing.map.catalogue import Geometry
from processing.map.feature import Feature

_NAME_LETTERS = 10
_TEXT_BYTES = 254
"""What a table of dBASE holds: of a column's name, of a text."""

_PARTS = (".shp", ".shx", ".dbf", ".prj", ".cpg")


def write_shapefile_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write a map that is handed in; a kind drawn in another shape gets a second file.

    Coordinates are kept to the last bit. Names of columns are shortened to 10 letters, texts to
    254 bytes; in Shift_JIS missing characters are replaced. All of it is told.

    Raises
    ------
    NoSpace
        The library can't write a file.

    References
    ----------
    ESRI, Shapefile technical description, 1998 (PointZ, PolyLineZ, PolygonZ).
    """
    groups: dict[tuple[str, Geometry], list[Feature]] = {}
    for feature in delivery.features:
        groups.setdefault((feature.kind, feature.geometry), []).append(feature)
    if not groups:
        groups[MAP, Geometry.POINT] = []
    writer = _Writer(delivery)
    for number, ((kind, geometry), members) in enumerate(groups.items()):
        monitor.check()
        monitor.report(number / len(groups))
        known = delivery.catalogue[kind].geometry if kind in delivery.catalogue else geometry
        name = kind if known is geometry else f"{kind}_{geometry.value}"
        with TemporaryDirectory(prefix="zuka-shp-") as folder:
            writer.write(Path(folder) / f"{name}.shp", members, GEOMETRY_TYPES[geometry])
            for made in (Path(folder) / f"{name}{part}" for part in _PARTS):
                if made.exists():
                    copy = position(made.name)
                    with report_as_user_error(copy):
                        shutil.copyfile(made, copy)
    writer.tell()


class _Writer:
    """Writes the files of a map, and remembers what was shortened."""

    def __init__(self, delivery: MapDelivery) -> None:
        self._delivery = delivery
        self._encoding = delivery.options_of(ShapefileOptions).encoding
        self._texts = ShiftJisText()
        self._names: dict[str, str] = {}
        self._cut = 0

    def write(self, path: Path, features: Sequence[Feature], geometry_type: str) -> None:
        """Write the files of one kind."""
        import pyogrio.raw
        from pyogrio.errors import DataLayerError, DataSourceError

        catalogue = self._delivery.catalogue
        known = bool(features) and features[0].kind in catalogue
        fields = catalogue[features[0].kind].attributes if known else ()
        columns = self._fitted(feature_columns(features, fields))
        with warnings.catch_warnings():
            # Said by the export itself, once: the reference system is not known.
            warnings.filterwarnings("ignore", "'crs' was not provided", UserWarning)
            try:
                pyogrio.raw.write(
                    str(path),
                    feature_shapes(features),
                    [values for values, _ in columns.values()],
                    list(columns),
                    field_mask=[missing for _, missing in columns.values()],
                    driver="ESRI Shapefile",
                    geometry_type=geometry_type,
                    crs=self._delivery.crs or None,
                    encoding=self._encoding.upper(),
                    nan_as_null=True,
                )
            except (DataLayerError, DataSourceError) as error:
                raise NoSpace(
                    Text("The Shapefile can't be written.", "Shapefileを書き込めません。"),
                    Text.same(path.name),
                    Text(
                        "Check that the disk has space; nothing is half written.",
                        "ディスクの空き容量を確認してください。書きかけのファイルは残りません。",
                    ),
                ) from error

    def _fitted(self, columns: Mapping[str, ColumnValues]) -> dict[str, ColumnValues]:
        """Columns with names and texts that the table holds."""
        found: dict[str, ColumnValues] = {}
        for name, (values, missing) in columns.items():
            is_text = values.dtype == object
            fitted = np.array([self._text(one) for one in values], object) if is_text else values
            found[self._name(name, found)] = (fitted, missing)
        return found

    def _name(self, name: str, taken: Mapping[str, ColumnValues]) -> str:
        letters = "".join(one if one.isascii() and one.isprintable() else "_" for one in name)
        own, number = letters[:_NAME_LETTERS], 2
        while own.lower() in {one.lower() for one in taken}:
            end = f"_{number}"
            own, number = letters[: _NAME_LETTERS - len(end)] + end, number + 1
        if own != name:
            self._names[name] = own
        return own

    def _text(self, words: str | None) -> str | None:
        if words is None:
            return None
        if self._encoding == "cp932":
            return self._texts.fitted(words, _TEXT_BYTES)
        cut = words.encode()[:_TEXT_BYTES].decode("utf-8", "ignore")
        self._cut += cut != words
        return cut

    def tell(self) -> None:
        """Say what was shortened and replaced."""
        if self._names:
            pairs = ", ".join(f"{name} → {own}" for name, own in sorted(self._names.items()))
            self._delivery.tell(
                Text(
                    "Shapefiles have names of 10 letters; columns were renamed: {pairs}.",
                    "Shapefileの列名は10文字までのため、変更しました: {pairs}",
                ).filled(pairs=pairs)
            )
        if self._cut:
            self._delivery.tell(
                Text(
                    "Texts longer than the 254 bytes of a Shapefile were cut: {count}.",
                    "Shapefileの254バイトを超える文字列を切り詰めました: {count}件",
                ).filled(count=self._cut)
            )
        for note in self._texts.notes:
            self._delivery.tell(note)
