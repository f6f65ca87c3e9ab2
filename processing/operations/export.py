"""The map as the files that are handed in: all of them whole, or none of them there."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from processing.core.errors import OutOfRange, Unsuitable, use_one_of
from processing.core.monitor import Monitor, PartMonitor, SilentMonitor
from processing.core.safe_write import write_safely
from processing.core.text import Language, Text
from processing.formats.drawings.dxf import write_dxf
from processing.formats.drawings.dxf_document import DxfVersion
from processing.formats.ledgers.ledger_columns import TableStyle
from processing.formats.ledgers.ledger_csv import write_features, write_ledger, write_vertices
from processing.formats.vectors.geojson import write_geojson
from processing.formats.vectors.geopackage import write_geopackage
from processing.map.catalogue import Catalogue, Geometry
from processing.map.feature import Feature, Status
from processing.project.results.label_export import write_labelled_points
from processing.recording.drive import Drive

_LEAST_VERTICES = {Geometry.POINT: 1, Geometry.LINE: 2, Geometry.AREA: 3}
_ENCODINGS = ("utf-8", "cp932")
_VERSIONS = ("R2000", "R2018")
_MOST_DIGITS = 9
_STEM = "features"


@dataclass(frozen=True)
class ExportRequest:
    """Which files are wanted, where, and how.

    Attributes
    ----------
    formats : tuple of str
        Keys of :data:`FORMATS`.
    folder : Path
        Made if it is missing; files of the same names in it are replaced.
    language : "en" or "ja"
        Of the ledgers' headers.
    dxf_version : "R2000" or "R2018"
    encoding : "utf-8" or "cp932"
        Of the ledgers; a DXF's is fixed by its version.
    candidates : bool
        Whether features that nobody has judged are handed in too.
    digits : int
        Decimals of metres in the ledgers, 0 to 9: those of the delivered coordinates.
    never : tuple of Path
        Delivered files, which must not be overwritten.
    """

    formats: tuple[str, ...]
    folder: Path
    language: Language = "ja"
    dxf_version: str = "R2018"
    encoding: str = "utf-8"
    candidates: bool = False
    digits: int = 3
    never: tuple[Path, ...] = ()


@dataclass(frozen=True)
class _Job:
    """What all writers are given."""

    features: tuple[Feature, ...]
    catalogue: Catalogue
    crs: str
    request: ExportRequest
    drives: tuple[Drive, ...]


Writer = Callable[[_Job, Callable[[str], Path], Monitor], None]


@dataclass(frozen=True)
class ExportFormat:
    """A kind of file that can be handed in: its title, and what writes it."""

    id: str
    title: Text
    write: Writer


def export(
    features: Iterable[Feature],
    catalogue: Catalogue,
    crs: str,
    request: ExportRequest,
    monitor: Monitor | None = None,
    *,
    drives: tuple[Drive, ...] = (),
) -> tuple[Path, ...]:
    """Write the map's accepted features in each format that is asked for.

    A map without features gives files without features: a script's next step finds them.
    Files take their own names when the last one is whole, so that an error, a cancel or a full disk
    leaves the folder as it was.

    Parameters
    ----------
    features : iterable of Feature
        Written in their order; rejected ones never, candidates if the request says so.
    crs : str
        ``EPSG:n``; empty where it is not known: the files then say so, nothing is guessed.
    drives : tuple of Drive
        Whose points are written with their labels.

    Returns
    -------
    tuple of Path
        The files, in the order of the formats.

    Raises
    ------
    OutOfRange
        A format, version, encoding, number of digits or reference system that there is not; a
        coordinate that is no number; a character that the encoding lacks.
    Unsuitable
        A feature with too few vertices or of a kind the catalogue lacks.
    InUse, NoSpace, MissingInput, BadFile, Cancelled
        What stands against writing; nothing was written.
    """
    monitor = monitor or SilentMonitor()
    _check_request(request, crs)
    wanted = tuple(feature for feature in features if _is_wanted(feature, request))
    for feature in wanted:
        _check_feature(feature, catalogue)
    job = _Job(wanted, catalogue, crs, request, drives)
    paths: list[Path] = []
    with ExitStack() as whole:

        def position(name: str) -> Path:
            path = request.folder / name
            temporary = whole.enter_context(write_safely(path, never=request.never))
            paths.append(path)
            return temporary

        for number, name in enumerate(request.formats):
            monitor.check()
            monitor.report(number / len(request.formats), _saying(name, crs))
            ends = (number / len(request.formats), (number + 1) / len(request.formats))
            FORMATS[name].write(job, position, PartMonitor(monitor, *ends))
    return tuple(paths)


def _write_dxf(job: _Job, position: Callable[[str], Path], monitor: Monitor) -> None:
    version: DxfVersion = "R2000" if job.request.dxf_version == "R2000" else "R2018"
    write_dxf(
        position(f"{_STEM}.dxf"),
        job.features,
        job.catalogue,
        version=version,
        encoding=job.request.encoding,
        crs=job.crs,
        monitor=monitor,
    )


def _write_csv(job: _Job, position: Callable[[str], Path], monitor: Monitor) -> None:
    request = job.request
    style = TableStyle(request.language, request.encoding, request.digits, job.crs)
    path = position(f"{_STEM}.csv")
    write_features(path, job.features, job.catalogue, style, monitor=monitor)
    write_vertices(position("vertices.csv"), job.features, style, monitor=monitor)
    for kind in job.catalogue:
        members = [feature for feature in job.features if feature.kind == kind.id]
        if members:
            write_ledger(position(f"ledger_{kind.id}.csv"), members, kind, style, monitor=monitor)


def _write_geopackage(job: _Job, position: Callable[[str], Path], monitor: Monitor) -> None:
    path = position(f"{_STEM}.gpkg")
    write_geopackage(path, job.features, job.catalogue, crs=job.crs, monitor=monitor)


def _write_geojson(job: _Job, position: Callable[[str], Path], monitor: Monitor) -> None:
    write_geojson(position(f"{_STEM}.geojson"), job.features, crs=job.crs, monitor=monitor)


def _write_points(job: _Job, position: Callable[[str], Path], monitor: Monitor) -> None:
    write_labelled_points(job.drives, position, monitor)


FORMATS: Mapping[str, ExportFormat] = {
    one.id: one
    for one in (
        ExportFormat("dxf", Text("Drawing (DXF)", "図面（DXF）"), _write_dxf),
        ExportFormat("csv", Text("Ledgers (CSV)", "台帳（CSV）"), _write_csv),
        ExportFormat("gpkg", Text("GIS (GeoPackage)", "GIS（GeoPackage）"), _write_geopackage),
        ExportFormat("geojson", Text("GIS (GeoJSON)", "GIS（GeoJSON）"), _write_geojson),
        ExportFormat("las", Text("Labelled points (LAS)", "ラベル付き点群（LAS）"), _write_points),
    )
}
"""What can be handed in, by name."""


def _is_wanted(feature: Feature, request: ExportRequest) -> bool:
    return feature.status is Status.ACCEPTED or (
        request.candidates and feature.status is Status.CANDIDATE
    )


def _saying(name: str, crs: str) -> Text:
    if not crs:
        return Text(
            "{title}; the reference system is not known",
            "{title}（座標参照系は不明のまま出力します）",
        ).filled(title=FORMATS[name].title)
    return FORMATS[name].title


def _check_request(request: ExportRequest, crs: str) -> None:
    if not request.formats:
        raise _no_such("", tuple(FORMATS))
    for name in request.formats:
        if name not in FORMATS:
            raise _no_such(name, tuple(FORMATS))
    if request.encoding not in _ENCODINGS:
        raise _no_such(request.encoding, _ENCODINGS)
    if request.dxf_version not in _VERSIONS:
        raise _no_such(request.dxf_version, _VERSIONS)
    if not 0 <= request.digits <= _MOST_DIGITS:
        raise _no_such(str(request.digits), (f"0–{_MOST_DIGITS}",))
    if crs:
        _check_crs(crs)


def _no_such(value: str, allowed: Sequence[str]) -> OutOfRange:
    return OutOfRange(
        Text("The export can't be written like this.", "この指定では書き出せません。"),
        Text.same(value or "–"),
        use_one_of(allowed),
    )


def _check_crs(crs: str) -> None:
    from pyproj import CRS
    from pyproj.exceptions import CRSError

    try:
        CRS.from_user_input(crs)
    except CRSError as error:
        raise OutOfRange(
            Text("There is no such reference system.", "そのような座標参照系はありません。"),
            Text.same(crs),
            Text(
                "Set the project's reference system, for instance EPSG:6677.",
                "プロジェクトの座標参照系を設定してください（例: EPSG:6677）。",
            ),
        ) from error


def _check_feature(feature: Feature, catalogue: Catalogue) -> None:
    remedy = Text(
        "Correct or delete the feature; nothing was written.",
        "地物を修正または削除してください。何も書き込まれていません。",
    )
    where = Text(f"{feature.kind}, feature {feature.id}", f"{feature.kind}、地物 {feature.id}")
    if feature.kind not in catalogue:
        what = Text("The catalogue has no such kind.", "カタログにない種別です。")
        raise Unsuitable(what, where, remedy)
    least = _LEAST_VERTICES[feature.geometry]
    if len(feature.vertices) < least:
        what = Text(
            f"It has {len(feature.vertices)} of at least {least} vertices.",
            f"頂点が{len(feature.vertices)}個しかありません（{least}個以上必要）。",
        )
        raise Unsuitable(what, where, remedy)
    if not all(math.isfinite(value) for vertex in feature.vertices for value in vertex.xyz):
        what = Text("A coordinate is no number.", "座標が数値ではありません。")
        raise OutOfRange(what, where, remedy)
