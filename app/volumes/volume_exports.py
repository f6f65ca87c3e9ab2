"""What a volume can be given out as: each kind of file by its id, and how it is written."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import shapely
from numpy.typing import NDArray
from shapely.geometry.base import BaseGeometry

from app.volumes.volume_reports import (
    ExportedVolume,
    Write,
    form_writer,
    is_judged,
    report_writer,
)
from processing.core.errors import Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.formats.drawings.earthwork_dxf import EarthworkPlan, PlanStyle, write_earthwork_dxf
from processing.formats.drawings.section_sheet_dxf import SectionStyle, write_section_sheet_dxf
from processing.formats.format import Format
from processing.formats.points.ground_las import write_ground_las
from processing.formats.registry import FORMATS
from processing.formats.surfaces.change_geotiff import write_change_geotiff
from processing.formats.surfaces.landxml_writing import LandXmlFacts, WrittenSurface, write_landxml
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.triangulation import triangulate_ground
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.heat_map import change_classes
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.earthwork.volumes.volume_parameters import END_AREA, PRISMOIDAL
from processing.operations.volume_papers import PAPER, TABLE, WORKBOOK
from processing.project.volumes.volume import KeptVolume, SideKind

_TITLE = Text("Cut {cut} m³, fill {fill} m³", "切土量 {cut} m³、盛土量 {fill} m³")
_NAME = Text("{what} ({format})", "{what}（{format}）")
_REPORT = Text("Volume report", "土量計算書")
_FORM = Text("As-built form 31-2", "様式-31-2 出来形合否判定総括表")
_AFTER = Text("Ground after", "変化後の地盤")
_MOST_CORNERS = 200_000
_LONGEST_CELLS = 3.0


def _has_epoch(kept: KeptVolume) -> bool:
    return SideKind.EPOCH in (kept.request.before.kind, kept.request.after.kind)


def _has_sections(kept: KeptVolume) -> bool:
    return kept.method in (END_AREA, PRISMOIDAL)


def _always(_kept: KeptVolume) -> bool:
    return True


@dataclass(frozen=True)
class VolumeExport:
    """One kind of file.

    Attributes
    ----------
    what : Text
        What is in it.
    is_for : callable
        Whether it can be made of a volume.
    """

    id: str
    what: Text
    format: Format
    write: Write
    is_for: Callable[[KeptVolume], bool] = _always

    @property
    def name(self) -> Text:
        """What is in it, and its format."""
        return _NAME.filled(what=self.what, format=self.format.name)


def _write_geotiff(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    write_change_geotiff(
        path, given.result.change, crs=given.kept.crs, monitor=monitor, never=given.never
    )


def _write_plan(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    volumes = given.kept.volumes
    amounts = _TITLE.filled(cut=f"{volumes.cut_m3:,.1f}", fill=f"{volumes.fill_m3:,.1f}")
    plan = EarthworkPlan(
        title=(Text.same(given.details.work), amounts),
        change=given.result.change,
        classes=change_classes(given.limit_m),
        contours=given.contours,
        boundary=_rings_of(given.kept.request.boundary),
        crs=given.kept.crs,
    )
    look = PlanStyle(language=given.language)
    write_earthwork_dxf(path, plan, look, monitor=monitor, never=given.never)


def _write_sections(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    line = given.result.line
    if line is None:
        raise Unsuitable(
            Text("The volume has no sections.", "この結果には断面がありません。"),
            Text.same(given.details.work),
            Text(
                "Compute it by end areas or the prismoidal formula.",
                "平均断面法またはプリズモイダル公式で計算してください。",
            ),
        )
    look = SectionStyle(language=given.language)
    write_section_sheet_dxf(
        path, line.sections, Text.same(given.details.work), look, monitor=monitor, never=given.never
    )


def _write_surface(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    surface = _later_ground(given.result.change, given.kept.request.boundary, monitor)
    named = TriangleSurface(surface.xyz, surface.corners, _AFTER.in_language(given.language))
    facts = LandXmlFacts(given.details.work, given.kept.crs, given.details.height_datum)
    written = (WrittenSurface(named),)
    lines = () if given.result.line is None else (given.result.line,)
    write_landxml(path, written, facts, lines=lines, monitor=monitor, never=given.never)


def _write_ground(path: Path, given: ExportedVolume, monitor: Monitor) -> None:
    """The points of the later epoch, or of the only one."""
    epochs = [side for side in given.sides(monitor) if isinstance(side, EpochGround)]
    write_ground_las(path, epochs[-1], monitor, never=given.never)


def _later_ground(
    change: ChangeGrid, boundary: BaseGeometry | None, monitor: Monitor
) -> TriangleSurface:
    """Triangles between the middles of cells, as many of them as programs can read."""
    grid = change.grid
    step = max(1, int(np.ceil(np.sqrt(grid.rows * grid.columns / _MOST_CORNERS))))
    rows, columns = (
        part.reshape(-1)
        for part in np.meshgrid(
            np.arange(0, grid.rows, step), np.arange(0, grid.columns, step), indexing="ij"
        )
    )
    is_there = np.isfinite(change.change_m[rows, columns])
    rows, columns = rows[is_there], columns[is_there]
    heights = change.after[rows, columns].astype(np.float64)
    plan = np.column_stack([columns, rows]) + 0.5
    xyz = grid.origin + np.column_stack([plan * grid.size_m, heights])
    longest_m = _LONGEST_CELLS * step * grid.size_m
    return triangulate_ground(xyz, (), monitor, longest_m=longest_m, boundary=boundary)


VOLUME_EXPORTS: tuple[VolumeExport, ...] = (
    VolumeExport("report", _REPORT, FORMATS["pdf"], report_writer(PAPER)),
    VolumeExport("report-table", _REPORT, FORMATS["xlsx"], report_writer(WORKBOOK)),
    VolumeExport("report-csv", _REPORT, FORMATS["csv"], report_writer(TABLE)),
    VolumeExport("form", _FORM, FORMATS["pdf"], form_writer(PAPER), is_judged),
    VolumeExport("form-table", _FORM, FORMATS["xlsx"], form_writer(WORKBOOK), is_judged),
    VolumeExport("form-csv", _FORM, FORMATS["csv"], form_writer(TABLE), is_judged),
    VolumeExport("surface", _AFTER, FORMATS["landxml"], _write_surface),
    VolumeExport(
        "ground", Text("Ground points", "地面の点群"), FORMATS["laz"], _write_ground, _has_epoch
    ),
    VolumeExport(
        "geotiff", Text("Height difference", "標高差"), FORMATS["geotiff"], _write_geotiff
    ),
    VolumeExport(
        "plan",
        Text("Heat map and contours", "ヒートマップ・等高線図"),
        FORMATS["dxf"],
        _write_plan,
    ),
    VolumeExport(
        "sections", Text("Sections", "断面図"), FORMATS["dxf"], _write_sections, _has_sections
    ),
)
"""In the order in which they are offered."""


def _rings_of(boundary: BaseGeometry | None) -> tuple[NDArray[np.float64], ...]:
    if boundary is None:
        return ()
    rings = shapely.get_rings(shapely.get_parts(boundary))
    return tuple(shapely.get_coordinates(ring)[:-1] for ring in rings)
