"""Where the drives of a job lie and how they stand: a map of their extents for QGIS."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import closing
from pathlib import Path

from processing.core.errors import UserError
from processing.formats.vectors.geojson import write_geojson
from processing.formats.vectors.geopackage import write_geopackage
from processing.map.catalogue import Geometry
from processing.map.catalogue_file import read_catalogue
from processing.map.feature import Feature, Provenance, Vertex
from processing.operations.batch.job_page import UnitRow
from processing.project.project import Project, is_project
from processing.recording.drive import Drive
from resources import path_of

NAMES = ("index_map.geojson", "index_map.gpkg")
_KIND = "drive"


def write_index_map(folder: Path, rows: Sequence[UnitRow]) -> tuple[Path, ...]:
    """Write the extents of all drives, with the job's state, points, time and project of each.

    Drives of another reference system than the first one's get files of their own, whose names
    tell it.

    Returns
    -------
    tuple of Path
        None where nothing was imported.

    Raises
    ------
    NoSpace, MissingInput
    """
    by_system: dict[str, list[Feature]] = {}
    for row in rows:
        for crs, feature in _extents(folder, row):
            by_system.setdefault(crs, []).append(feature)
    catalogue = read_catalogue(path_of("catalogue/level500.toml"))
    written: list[Path] = []
    for crs, features in by_system.items():
        other = "" if not written else f"_{crs.replace(':', '_').lower()}"
        geojson, gpkg = (folder / f"{Path(name).stem}{other}{Path(name).suffix}" for name in NAMES)
        write_geojson(geojson, features, crs=crs)
        write_geopackage(gpkg, features, catalogue, crs=crs)
        written += [geojson, gpkg]
    return tuple(written)


def _extents(folder: Path, row: UnitRow) -> Iterator[tuple[str, Feature]]:
    path = row.folder / f"{row.state.name}.zuka"
    if not is_project(path):
        return
    try:
        project = Project.open(path, writing=False)
    except UserError:
        return  # told with the drive
    with closing(project):
        for drive in project.drives:
            yield project.crs, _extent(drive, row, path.relative_to(folder))


def _extent(drive: Drive, row: UnitRow, project: Path) -> Feature:
    (west, south, low), (east, north, _) = drive.info.lowest, drive.info.highest
    corners = ((west, south), (east, south), (east, north), (west, north))
    return Feature(
        kind=_KIND,
        geometry=Geometry.AREA,
        vertices=tuple(Vertex((x, y, low)) for x, y in corners),
        attributes={
            "name": drive.info.name,
            "delivery": row.state.name,
            "state": row.standing,
            "points": drive.count,
            "seconds": round(row.seconds, 1),
            "project": project.as_posix(),
            "error": "; ".join(
                one.error.what.en for one in row.state.troubles if one.error is not None
            ),
        },
        provenance=Provenance("batch"),
        id=f"{row.state.name}/{drive.id}",
    )
