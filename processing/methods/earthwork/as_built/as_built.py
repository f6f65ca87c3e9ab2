"""As-built control over whole faces (出来形管理, 面管理): measured ground against a design."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import Enum

import numpy as np
import shapely
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable
from processing.core.monitor import Monitor
from processing.core.text import Text
from processing.methods.earthwork.as_built.cell_medians import cell_medians
from processing.methods.earthwork.as_built.design_faces import FaceRules, design_faces
from processing.methods.earthwork.as_built.limits import AsBuiltLimits, FaceLimits, WorkType
from processing.methods.earthwork.geometry.boundary import inside_shares
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.surfaces.sides import EpochGround
from processing.methods.ground.filters.cells import MOST_CELLS, CellGrid

NARROW_PERCENT, WIDE_PERCENT = 50.0, 80.0
"""Shares of the limit, per cent, that form 31-2 (様式-31-2) counts the values within."""

_LARGEST_CELL_M = 1.0
"""A value for each square metre at least (3次元計測技術を用いた出来形管理要領)."""

_MET = 1.0 + 1e-9
"""A count that meets its limit does so whatever rounding made of the limit."""


@dataclass(frozen=True)
class AsBuiltRules:
    """How values are taken from points.

    Attributes
    ----------
    cell_m : float
        Side of the cells that give one value each; at most 1 m, as the rule has it.
    slope_from, berm_m : float
        See :class:`processing.methods.earthwork.as_built.design_faces.FaceRules`.
    """

    cell_m: float = 1.0
    slope_from: float = FaceRules.slope_from
    berm_m: float = FaceRules.berm_m


class FaceMeasure(Enum):
    """What is judged of a face."""

    MEAN = "mean"
    LARGEST = "largest"
    SMALLEST = "smallest"
    DENSITY = "density"
    REJECTED = "rejected"


@dataclass(frozen=True)
class FaceResult:
    """Deviations of one face: measured less design, positive where the ground is too high.

    Attributes
    ----------
    count : int
        Values: one for each cell that has points on the face.
    mean_m, largest_m, smallest_m : float
        Of the values that are not rejected; NaN without any.
    largest_of_all_m, smallest_of_all_m : float
        With the rejected ones.
    rejected : int
        Values beyond the limit of one value (棄却点数).
    within_50, within_80 : int
        Values within 50 and 80 % of the limit of one value; a side without one allows all.
    area_m2 : float
        Of the face seen from above, within the boundary, less the strips along its edges.
    unmeasured_area_m2 : float
        Part of it in cells that have no value.
    verdicts : mapping of FaceMeasure to bool
        Whether each is within its limit; none is without values.
    """

    limits: FaceLimits
    count: int
    mean_m: float
    largest_m: float
    smallest_m: float
    largest_of_all_m: float
    smallest_of_all_m: float
    rejected: int
    within_50: int
    within_80: int
    area_m2: float
    unmeasured_area_m2: float
    verdicts: Mapping[FaceMeasure, bool]

    @property
    def density_per_m2(self) -> float:
        """Values on a square metre."""
        return self.count / self.area_m2

    @property
    def rejected_share(self) -> float:
        """Share of the values that are rejected, 0 to 1; NaN without values."""
        return self.rejected / self.count if self.count else math.nan

    @property
    def passes(self) -> bool:
        """Everything judged is within its limit."""
        return all(self.verdicts.values())


@dataclass(frozen=True)
class AsBuiltResult:
    """The judgement of a work, and the map of its values.

    Attributes
    ----------
    faces : tuple of FaceResult
        Those that the work type has limits for and the design has; at least one.
    points : int
        Measured points that the values come from.
    grid : CellGrid
        The cells; row = north, column = east.
    deviation_m, percent : (rows, columns) float32
        Deviation of each cell, m, and its share of the limit of one value, %; NaN without. Where
        a cell has a value on either face, the one that is nearer to its limit or more beyond.
    is_judged : (rows, columns) bool
        At least half of the cell is on a face that is judged.
    """

    table: AsBuiltLimits
    work_type: WorkType
    rules: AsBuiltRules
    faces: tuple[FaceResult, ...]
    points: int
    grid: CellGrid
    deviation_m: NDArray[np.float32]
    percent: NDArray[np.float32]
    is_judged: NDArray[np.bool_]

    @property
    def passes(self) -> bool:
        """Every face passes."""
        return all(face.passes for face in self.faces)


@dataclass(frozen=True)
class _JudgedFace:
    """A face with limits: its plan and its share of each cell."""

    limits: FaceLimits
    plan: shapely.Geometry
    shares: NDArray[np.float32]

    def holds(self, xy: NDArray[np.float64], cell: NDArray[np.int64]) -> NDArray[np.bool_]:
        """Which positions are on the face; only cells on its edge are looked at one by one."""
        shares = self.shares.reshape(-1)[cell]
        is_on: NDArray[np.bool_] = shares == 1.0
        unsure = np.flatnonzero((shares > 0.0) & ~is_on)
        is_on[unsure] = shapely.contains_xy(self.plan, xy[unsure])
        return is_on


def evaluate_as_built(
    ground: EpochGround,
    design: TriangleSurface,
    limits: tuple[AsBuiltLimits, str],
    monitor: Monitor,
    *,
    rules: AsBuiltRules | None = None,
    boundary: shapely.Geometry | None = None,
) -> AsBuiltResult:
    """Judge measured ground by a design.

    Each cell gives one value for each face that it has points on: the median of their deviations.
    A stone, a tuft of grass or a wheel's rut moves a mean, and a lowest or highest point is off by
    the scanner's noise; the median bears up to half of the points of a cell being wrong.

    Parameters
    ----------
    ground : EpochGround
        Its points that are ground.
    limits : (AsBuiltLimits, str)
        The table, and the id of the work type in it.
    boundary : shapely.Polygon or shapely.MultiPolygon, optional
        What is judged lies within it, m, project CRS.

    Raises
    ------
    OutOfRange
        The table has no such work type; cells larger than 1 m or too many of them.
    Unsuitable
        The design has nothing to judge, or no point lies on it.

    References
    ----------
    MLIT, 3次元計測技術を用いた出来形管理要領（案）, 面管理編; 出来形管理基準及び規格値.
    """
    table, work_type = limits[0], limits[0][limits[1]]
    rules = rules or AsBuiltRules()
    face_rules = FaceRules(rules.slope_from, rules.berm_m, table.margin_m)
    plans = design_faces(design, face_rules, boundary)
    faces = [one for one in work_type.faces if one.face in plans]
    if not faces:
        raise _not_on_design(design, _NO_FACE)
    grid = _grid([plans[one.face] for one in faces], rules.cell_m)
    judged = [_judged_face(one, plans[one.face], grid) for one in faces]
    keys, deviations = _deviations(ground, design, judged, grid, monitor)
    if not len(keys):
        raise _not_on_design(design, _NO_POINT)
    cells = grid.rows * grid.columns
    values = cell_medians(keys, deviations, len(judged) * cells).reshape(len(judged), -1)
    results = [
        _face_result(table, one, value, grid.size_m)
        for one, value in zip(judged, values, strict=True)
    ]
    shape = (grid.rows, grid.columns)
    map_m, percent = (one.reshape(shape) for one in _maps(values, judged))
    is_judged = np.add.reduce([one.shares for one in judged]) >= 0.5
    facts = (table, work_type, rules, tuple(results), len(keys))
    return AsBuiltResult(*facts, grid, map_m, percent, is_judged)


def _judged_face(limits: FaceLimits, plan: shapely.Geometry, grid: CellGrid) -> _JudgedFace:
    shapely.prepare(plan)
    return _JudgedFace(limits, plan, inside_shares(plan, grid))


def _grid(plans: list[shapely.Geometry], cell_m: float) -> CellGrid:
    if not 0.0 < cell_m <= _LARGEST_CELL_M:
        raise OutOfRange(
            Text(
                "A cell of as-built control is at most 1 m wide.",
                "出来形評価のセルは1 m以下です。",
            ),
            Text.same(f"{cell_m:g} m"),
            Text("Choose a side of 1 m or less.", "1 m以下の値を指定してください。"),
        )
    west, south, east, north = shapely.total_bounds(plans)
    # On whole cells of the reference system: the same position is the same cell in every run.
    first = np.floor(np.array([west, south]) / cell_m)
    columns, rows = (np.ceil(np.array([east, north]) / cell_m) - first).astype(np.int64).tolist()
    if rows * columns > MOST_CELLS:
        raise OutOfRange(
            Text("The design covers too many cells.", "設計面のセル数が多すぎます。"),
            Text.same(f"{rows:,} × {columns:,}"),
            Text(
                "Choose a boundary round a part of it.",
                "設計面の一部を囲む境界を指定してください。",
            ),
        )
    return CellGrid(np.array([*(first * cell_m), 0.0]), cell_m, rows, columns)


def _deviations(
    ground: EpochGround,
    design: TriangleSurface,
    faces: list[_JudgedFace],
    grid: CellGrid,
    monitor: Monitor,
) -> tuple[NDArray[np.int32], NDArray[np.float32]]:
    """Cell and deviation of every point that counts; cells of a second face follow the first's."""
    keys, deviations = [np.empty(0, np.int32)], [np.empty(0, np.float32)]
    cells = grid.rows * grid.columns
    for block in ground.blocks():
        monitor.check()
        position = np.floor((block.xyz[:, :2] - grid.origin[:2]) / grid.size_m)
        is_in = np.all((position >= 0) & (position < [grid.columns, grid.rows]), axis=1)
        xyz, position = block.xyz[is_in], position[is_in].astype(np.int64)
        cell = position[:, 1] * grid.columns + position[:, 0]
        for number, face in enumerate(faces):
            on_face = np.flatnonzero(face.holds(xyz[:, :2], cell))
            off = xyz[on_face, 2] - design.heights_at(xyz[on_face, :2])
            is_reported = np.isfinite(off)
            keys.append((cell[on_face][is_reported] + number * cells).astype(np.int32))
            deviations.append(off[is_reported].astype(np.float32))
    return np.concatenate(keys), np.concatenate(deviations)


def _maps(
    values: NDArray[np.float32], faces: list[_JudgedFace]
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Deviation and share of the limit of each cell, of the face that is nearer to its limit."""
    shares = np.stack(
        [
            face.limits.single.percent(value.astype(np.float64))
            for face, value in zip(faces, values, strict=True)
        ]
    )
    worst = np.argmax(np.nan_to_num(np.abs(shares), nan=-1.0), axis=0)
    cells = np.arange(values.shape[1])
    return values[worst, cells], shares[worst, cells].astype(np.float32)


def _face_result(
    table: AsBuiltLimits, face: _JudgedFace, values: NDArray[np.float32], cell_m: float
) -> FaceResult:
    has_value = np.isfinite(values)
    found = values[has_value].astype(np.float64)
    limits = face.limits
    is_rejected = limits.single.beyond(found)
    kept = found[~is_rejected]
    narrow, wide = (limits.single.part(share) for share in (NARROW_PERCENT, WIDE_PERCENT))
    area_m2 = float(shapely.area(face.plan))
    empty = face.shares.reshape(-1)[~has_value].sum(dtype=np.float64)
    mean, largest, smallest = _three(kept)
    rejected = int(is_rejected.sum())
    return FaceResult(
        limits=limits,
        count=len(found),
        mean_m=mean,
        largest_m=largest,
        smallest_m=smallest,
        largest_of_all_m=_three(found)[1],
        smallest_of_all_m=_three(found)[2],
        rejected=rejected,
        within_50=int((~narrow.beyond(found)).sum()),
        within_80=int((~wide.beyond(found)).sum()),
        area_m2=area_m2,
        unmeasured_area_m2=float(empty) * cell_m**2,
        verdicts={
            FaceMeasure.MEAN: limits.mean.holds(mean),
            FaceMeasure.LARGEST: limits.single.holds(largest),
            FaceMeasure.SMALLEST: limits.single.holds(smallest),
            FaceMeasure.DENSITY: len(found) * _MET >= table.density_per_m2 * area_m2,
            FaceMeasure.REJECTED: len(found) > 0
            and rejected <= table.rejected_share * len(found) * _MET,
        },
    )


def _three(values: NDArray[np.float64]) -> tuple[float, float, float]:
    """Mean, largest and smallest."""
    if not len(values):
        return math.nan, math.nan, math.nan
    return float(values.mean()), float(values.max()), float(values.min())


_NO_FACE = Text(
    "The design has none of the faces that the work type has limits for.",
    "設計面に、この工種の規格値がある部位がありません。",
)
_NO_POINT = Text(
    "No measured ground point lies on the design.", "設計面の上に地面の計測点がありません。"
)


def _not_on_design(design: TriangleSurface, what: Text) -> Unsuitable:
    west, south, east, north = design.extent()
    where = Text(
        "{name}: easting {west:.1f} to {east:.1f}, northing {south:.1f} to {north:.1f}",
        "{name}: 東{west:.1f}～{east:.1f}、北{south:.1f}～{north:.1f}",
    ).filled(name=design.name or "TIN", west=west, south=south, east=east, north=north)
    return Unsuitable(
        what,
        where,
        Text(
            "Check design, work type, boundary and reference system, and that ground was filtered.",
            "設計面、工種、境界、座標系と、地面の抽出が済んでいるかを確認してください。",
        ),
    )
