"""Ledgers as tables that a spreadsheet opens: one row for each feature, one for each vertex."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TextIO

from processing.core.errors import OutOfRange
from processing.core.monitor import Monitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Text
from processing.formats.format import MAP
from processing.formats.ledgers.ledger_columns import (
    FEATURE_ID,
    POSITION,
    LedgerColumn,
    TableStyle,
    attribute_column,
    crs_column,
    distinct_headers,
    fields_of,
    guard_text,
    header,
    identity_columns,
    kind_columns,
    latitude_columns,
    place_columns,
    status_columns,
)
from processing.formats.ledgers.road_columns import road_columns
from processing.formats.ledgers.route_tables import RouteTable, route_tables
from processing.formats.map_delivery import MapDelivery, Position, TableOptions
from processing.formats.shift_jis import TWINS
from processing.map.catalogue import Catalogue, FeatureKind
from processing.map.feature import Feature
from processing.map.routes.road_sections import RoadSection, road_sections
from processing.map.routes.route_summary import route_summaries

_CHECK_EVERY = 256

_VERTEX_TITLES = (
    ("feature_id", FEATURE_ID, ""),
    ("number", Text("Vertex", "頂点番号"), ""),
    *POSITION,
    ("drive", Text("Drive", "走行データ"), ""),
    ("point", Text("Point", "点番号"), ""),
)


def write_features(
    path: Path,
    features: Sequence[Feature],
    catalogue: Catalogue,
    style: TableStyle,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write all features in one table, with every attribute that any of them has.

    Raises
    ------
    OutOfRange
        A character that the encoding lacks; names it and the feature.
    UserError
        What :func:`processing.core.safe_write.write_safely` raises; `Cancelled`.
    """
    columns = (
        *identity_columns(),
        *kind_columns(catalogue, style),
        *status_columns(style),
        *place_columns(features, style),
        *(attribute_column(one, catalogue, style) for one in fields_of(features, catalogue)),
        crs_column(style),
    )
    _write_rows(path, features, columns, style, monitor=monitor, never=never)


def write_ledger(
    path: Path,
    features: Sequence[Feature],
    kind: FeatureKind,
    style: TableStyle,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write the ledger of one kind: its attributes first, then where each feature is.

    Points get latitude and longitude too where the reference system is known.

    Raises
    ------
    OutOfRange, UserError
        As :func:`write_features`.
    """
    columns = ledger_columns(features, kind, style)
    _write_rows(path, features, columns, style, monitor=monitor, never=never)


def ledger_columns(
    features: Sequence[Feature], kind: FeatureKind, style: TableStyle
) -> tuple[LedgerColumn, ...]:
    """The columns of the ledger of one kind: its attributes first, then where each feature is."""
    catalogue = Catalogue((kind,))
    fields = {one.id: one for one in (*kind.attributes, *fields_of(features, catalogue))}
    return (
        *(attribute_column(one, catalogue, style) for one in fields.values()),
        *place_columns(features, style),
        *latitude_columns(features, style),
        crs_column(style),
        *status_columns(style),
        *identity_columns(),
    )


def write_road_ledger(
    path: Path,
    sections: Sequence[RoadSection],
    catalogue: Catalogue,
    style: TableStyle,
    *,
    never: Iterable[Path] = (),
) -> None:
    """Write the road's ledger sheet (道路台帳調書): a row for each section between stations.

    Raises
    ------
    OutOfRange, UserError
        As :func:`write_features`.
    """
    columns = road_columns(catalogue, style)
    with _open_table(path, style, never) as table:
        table.write([header(*one.title, style.language) for one in columns], "")
        for section in sections:
            table.write([one.cell(section) for one in columns], "")


def write_vertices(
    path: Path,
    features: Iterable[Feature],
    style: TableStyle,
    *,
    monitor: Monitor | None = None,
    never: Iterable[Path] = (),
) -> None:
    """Write every vertex in its order, with the measured point it rests on.

    Raises
    ------
    OutOfRange, UserError
        As :func:`write_features`.
    """
    monitor = monitor or SilentMonitor()
    with _open_table(path, style, never) as table:
        table.write([header(*one, style.language) for one in _VERTEX_TITLES], "")
        for number, feature in enumerate(features):
            if number % _CHECK_EVERY == 0:
                monitor.check()
            for position, vertex in enumerate(feature.vertices, 1):
                point = vertex.measured
                cells = [guard_text(feature.id), str(position), *map(style.number, vertex.xyz)]
                cells += [guard_text(point.drive), str(point.point)] if point else ["", ""]
                table.write(cells, feature.id)


def write_csv_features(
    path: Path, delivery: MapDelivery, monitor: Monitor, *, never: Iterable[Path] = ()
) -> None:
    """Write a map that is handed in as one table, as :func:`write_features`."""
    style = style_of(delivery)
    write_features(path, delivery.features, delivery.catalogue, style, monitor=monitor, never=never)


def write_csv_map(delivery: MapDelivery, position: Position, monitor: Monitor) -> None:
    """Write a map that is handed in as tables of all features, of vertices, and of each kind."""
    features, style = delivery.features, style_of(delivery)
    write_csv_features(position(f"{MAP}.csv"), delivery, monitor)
    write_vertices(position("vertices.csv"), features, style, monitor=monitor)
    for kind in delivery.catalogue:
        members = [feature for feature in features if feature.kind == kind.id]
        if members:
            write_ledger(position(f"ledger_{kind.id}.csv"), members, kind, style, monitor=monitor)
    for table in route_tables(
        route_summaries(features, delivery.catalogue), delivery.catalogue, style
    ):
        _write_route_table(position(f"ledger_{table.id}.csv"), table, style)
    sections = road_sections(features, delivery.catalogue)
    if sections:
        write_road_ledger(position("ledger_road_sections.csv"), sections, delivery.catalogue, style)


def _write_route_table(path: Path, table: RouteTable, style: TableStyle) -> None:
    with _open_table(path, style, ()) as file:
        file.write(table.headers, "")
        for row in table.rows:
            file.write([words for words, _ in row], "")


def style_of(delivery: MapDelivery) -> TableStyle:
    """How the tables of a map are written that is handed in."""
    options = delivery.options_of(TableOptions)
    return TableStyle(delivery.language, options.encoding, options.digits, delivery.crs)


def _write_rows(
    path: Path,
    features: Sequence[Feature],
    columns: Sequence[LedgerColumn],
    style: TableStyle,
    *,
    monitor: Monitor | None,
    never: Iterable[Path],
) -> None:
    monitor = monitor or SilentMonitor()
    with _open_table(path, style, never) as table:
        table.write(distinct_headers([column.header(style.language) for column in columns]), "")
        for number, feature in enumerate(features):
            if number % _CHECK_EVERY == 0:
                monitor.check()
                monitor.report(number / len(features))
            table.write([column.cell(feature) for column in columns], feature.id)


class _Table:
    """A file being written, row by row."""

    def __init__(self, file: TextIO, style: TableStyle) -> None:
        self._style = style
        self._headers: Sequence[str] = ()
        self._writer = csv.writer(file, lineterminator="\r\n")

    def write(self, cells: Sequence[str], feature: str) -> None:
        """Write a row, the headers first; ``feature`` is named with what can't be written."""
        if self._style.encoding == "cp932":
            cells = [cell.translate(TWINS) for cell in cells]
        self._headers = self._headers or cells
        for column, cell in zip(self._headers, cells, strict=True):
            try:
                cell.encode(self._style.encoding)
            except UnicodeEncodeError as error:
                raise self._lacking(error, feature, column) from error
        self._writer.writerow(cells)

    def _lacking(self, error: UnicodeEncodeError, feature: str, column: str) -> OutOfRange:
        character = error.object[error.start]
        code = f"U+{ord(character):04X}"
        shown = character if character.isprintable() else ""
        name = {"cp932": "Shift_JIS (cp932)"}.get(self._style.encoding, "UTF-8")
        return OutOfRange(
            Text(
                f"{name} has no character “{shown}” ({code}).",
                f"{name}では文字「{shown}」（{code}）を表せません。",
            ),
            Text(f"feature {feature}, {column}", f"地物 {feature}、{column}")
            if feature
            else Text(f"header {column}", f"見出し {column}"),
            Text(
                "Replace the character, or export as UTF-8; nothing was written.",
                "その文字を置き換えるか、UTF-8で書き出してください。何も書き込まれていません。",
            ),
        )


@contextmanager
def _open_table(path: Path, style: TableStyle, never: Iterable[Path]) -> Iterator[_Table]:
    encoding = "utf-8-sig" if style.encoding == "utf-8" else style.encoding
    with (
        write_safely(path, never=never) as temporary,
        temporary.open("w", encoding=encoding, newline="") as file,
    ):
        yield _Table(file, style)
