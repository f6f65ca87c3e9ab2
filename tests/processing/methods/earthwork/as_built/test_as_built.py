from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
import shapely
from numpy.typing import NDArray

from processing.core.errors import Cancelled, OutOfRange, Unsuitable
from processing.core.monitor import SilentMonitor
from processing.methods.earthwork.as_built.as_built import (
    AsBuiltResult,
    AsBuiltRules,
    FaceMeasure,
    evaluate_as_built,
)
from processing.methods.earthwork.as_built.limits import AsBuiltLimits, FaceKind
from processing.methods.earthwork.as_built.limits_file import as_built_limits
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.surfaces.sides import GroundBlock
from tests.embankment import (
    LENGTH_M,
    SLOPE_M,
    SOUTH,
    TOP_M,
    WEST,
    Deviation,
    embankment,
    measured_on,
)

ROAD = "road_embankment"


def judged(
    deviation: Deviation | float,
    design: TriangleSurface | None = None,
    *,
    table: AsBuiltLimits | None = None,
    work_type: str = ROAD,
    boundary: shapely.Geometry | None = None,
    per_m2: float = 12.0,
) -> AsBuiltResult:
    design = design or embankment()
    off = deviation if callable(deviation) else constant(deviation)
    return evaluate_as_built(
        measured_on(design, off, per_m2=per_m2),
        design,
        (table or as_built_limits(), work_type),
        SilentMonitor(),
        boundary=boundary,
    )


def constant(value: float) -> Deviation:
    return lambda xy: np.full(len(xy), value)


def in_cells(cells: list[tuple[int, int]], value: float, elsewhere: float) -> Deviation:
    """A deviation in cells (metres east of the western toe, north of the end)."""

    def deviation(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        position = np.floor(xy - [WEST, SOUTH]).astype(np.int64)
        hit = np.zeros(len(xy), bool)
        for cell in cells:
            hit |= (position == cell).all(axis=1)
        return np.where(hit, value, elsewhere)

    return deviation


def test_a_known_deviation_is_found_on_both_faces() -> None:
    result = judged(0.012)
    assert [one.limits.face for one in result.faces] == [FaceKind.FLAT, FaceKind.SLOPE]
    for face in result.faces:
        assert face.mean_m == pytest.approx(0.012, abs=1e-6)
        assert face.largest_m == pytest.approx(0.012, abs=1e-6)
        assert face.rejected == 0
        assert face.passes
    assert result.passes


def test_areas_are_those_of_the_plan_less_the_strips_along_the_edges() -> None:
    top, slope = judged(0.0).faces
    assert top.area_m2 == pytest.approx((TOP_M - 0.1) * LENGTH_M, abs=0.01)
    # Both slopes: strips at shoulder and toe, and at both ends.
    assert slope.area_m2 == pytest.approx(2 * (SLOPE_M - 0.1) * (LENGTH_M - 0.1), abs=0.01)
    assert top.unmeasured_area_m2 == pytest.approx(0.0, abs=0.5)
    assert top.count >= top.area_m2


def test_numbers_are_those_of_numpy_over_the_cells() -> None:
    noise = np.random.default_rng(3).normal(0.01, 0.03, (70, 60))

    def bumpy(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        position = np.floor(xy - [WEST, SOUTH]).astype(np.int64).clip(-5, 50)
        return noise[position[:, 1] + 5, position[:, 0] + 5]

    top = judged(bumpy).faces[0]
    # Cells that the top has a part of: from the shoulder 5.33 m on to 5.33 + 20 m.
    first, last = math.floor(SLOPE_M), math.ceil(SLOPE_M + TOP_M)
    cells = noise[5:55, 5 + first : 5 + last].ravel()
    assert top.count == len(cells)
    assert top.mean_m == pytest.approx(cells.mean(), abs=1e-6)
    assert top.largest_m == pytest.approx(cells.max(), abs=1e-6)
    assert top.smallest_m == pytest.approx(cells.min(), abs=1e-6)
    assert top.within_50 == (np.abs(cells) <= 0.075).sum()
    assert top.within_80 == (np.abs(cells) <= 0.120).sum()


def test_three_rejected_values_are_counted_and_left_out_of_mean_and_extremes() -> None:
    spots = [(10, 10), (12, 20), (15, 30)]
    top = judged(in_cells(spots, 0.4, 0.012)).faces[0]
    assert top.rejected == 3
    assert top.mean_m == pytest.approx(0.012, abs=1e-6)
    assert top.largest_m == pytest.approx(0.012, abs=1e-6)
    assert top.largest_of_all_m == pytest.approx(0.4, abs=1e-6)
    assert top.count == 1000
    assert top.verdicts[FaceMeasure.REJECTED]  # 0.3 % are allowed


def test_one_rejected_value_more_than_the_share_allows_fails() -> None:
    spots = [(10, 10), (12, 20), (15, 30), (16, 30)]
    assert not judged(in_cells(spots, 0.4, 0.012)).faces[0].verdicts[FaceMeasure.REJECTED]


def test_more_rejected_values_than_allowed_fail() -> None:
    spots = [(10 + number, 10) for number in range(5)]
    top, slope = judged(in_cells(spots, -0.4, 0.0)).faces
    assert top.rejected == 5
    assert not top.verdicts[FaceMeasure.REJECTED]
    assert top.verdicts[FaceMeasure.MEAN]
    assert not top.passes
    assert slope.passes


@pytest.mark.parametrize(
    ("value", "passes"), [(0.0499, True), (0.0501, False), (-0.0499, True), (-0.0501, False)]
)
def test_the_mean_is_judged_on_each_side_of_its_limit(value: float, passes: bool) -> None:
    assert judged(value).faces[0].verdicts[FaceMeasure.MEAN] is passes


@pytest.mark.parametrize(
    ("value", "rejected"), [(0.1499, 0), (0.1501, 1), (-0.1499, 0), (-0.1501, 1)]
)
def test_one_value_is_judged_on_each_side_of_its_limit(value: float, rejected: int) -> None:
    assert judged(in_cells([(12, 25)], value, 0.0)).faces[0].rejected == rejected


def test_a_one_sided_limit_lets_the_ground_be_too_high() -> None:
    top = judged(0.2, work_type="river_embankment").faces[0]
    assert top.passes
    assert (top.rejected, top.within_50) == (0, top.count)
    assert not judged(-0.12, work_type="river_embankment").faces[0].passes


def test_a_stone_in_a_cell_moves_its_value_by_nothing() -> None:
    def stones(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        position = (xy - [WEST, SOUTH]) % 1.0
        return np.where((position < 0.45).all(axis=1), 0.3, 0.0)

    top = judged(stones, per_m2=60.0).faces[0]
    assert top.rejected == 0
    assert top.mean_m == pytest.approx(0.0, abs=0.002)


def test_ground_that_is_off_beside_the_shoulder_only_is_not_judged() -> None:
    shoulders = np.array([SLOPE_M, SLOPE_M + TOP_M])

    def rounded(xy: NDArray[np.float64]) -> NDArray[np.float64]:
        off = np.abs((xy[:, 0] - WEST)[:, None] - shoulders).min(axis=1)
        return np.where(off < 0.0499, -0.5, 0.0)

    for face in judged(rounded, per_m2=40.0).faces:
        assert face.smallest_of_all_m == pytest.approx(0.0, abs=1e-6)


def test_a_berm_belongs_to_the_slope_that_it_interrupts() -> None:
    design = embankment(berm_m=1.5)
    top, slope = judged(0.0, design).faces
    assert top.area_m2 == pytest.approx((TOP_M - 0.1) * LENGTH_M, abs=0.01)
    steep = 4 * (SLOPE_M / 2 - 0.1) * (LENGTH_M - 0.1)
    berms = 2 * (1.5 - 0.1) * LENGTH_M
    assert slope.area_m2 == pytest.approx(steep + berms, abs=0.01)


def test_a_narrow_top_is_no_berm() -> None:
    top, _ = judged(0.0, embankment(top_m=2.0)).faces
    assert top.area_m2 == pytest.approx(1.9 * LENGTH_M, abs=0.01)


def test_faces_are_the_same_where_each_triangle_has_corners_of_its_own() -> None:
    design = embankment(berm_m=1.5)
    apart = TriangleSurface(
        design.xyz[design.corners].reshape(-1, 3),
        np.arange(3 * len(design.corners)).reshape(-1, 3),
        "",
    )
    assert [one.area_m2 for one in judged(0.0, apart).faces] == pytest.approx(
        [one.area_m2 for one in judged(0.0, design).faces]
    )


def test_areas_are_right_where_a_corner_lies_on_another_triangle_s_side() -> None:
    positions = np.array([[0, 0], [10, 0], [10, 10], [0, 10], [5, 5], [5, 0]], np.float64)
    xyz = np.column_stack([positions + np.array([WEST, SOUTH]), np.full(6, 20.0)])
    # Beside the corner in the middle of the diagonal lies a triangle that has it on its side.
    corners = np.array([[0, 5, 4], [5, 1, 4], [1, 2, 4], [0, 2, 3]])
    (flat,) = judged(0.0, TriangleSurface(xyz, corners, "")).faces
    assert flat.area_m2 == pytest.approx(100.0)
    assert flat.count == 100


def test_a_boundary_limits_what_is_judged() -> None:
    box = shapely.box(WEST + 10, SOUTH + 10, WEST + 20, SOUTH + 30)
    result = judged(0.0, boundary=box)
    (top,) = result.faces
    assert top.area_m2 == pytest.approx(200.0)
    assert top.count == 200
    assert (result.grid.rows, result.grid.columns) == (20, 10)


def test_cells_without_points_lower_the_density_and_are_told() -> None:
    design = embankment()
    whole = measured_on(design, constant(0.0))

    def half() -> list[GroundBlock]:
        return [
            replace(block, xyz=block.xyz[block.xyz[:, 1] < SOUTH + LENGTH_M / 2])
            for block in whole.blocks()
        ]

    ground = replace(whole, blocks=half)
    result = evaluate_as_built(ground, design, (as_built_limits(), ROAD), SilentMonitor())
    top = result.faces[0]
    assert top.density_per_m2 == pytest.approx(0.5, abs=0.05)
    assert top.unmeasured_area_m2 == pytest.approx(top.area_m2 / 2, abs=1.0)
    assert not top.verdicts[FaceMeasure.DENSITY]
    assert np.isnan(result.percent[result.grid.rows // 2 + 1 :]).all()
    assert result.is_judged[result.grid.rows // 2 + 1 :].any()


def test_a_face_without_a_value_fails_without_numbers() -> None:
    design = embankment()
    whole = measured_on(design, constant(0.0))

    def top_only() -> list[GroundBlock]:
        return [
            replace(block, xyz=block.xyz[np.abs(block.xyz[:, 2] - 24.0) < 1e-6])
            for block in whole.blocks()
        ]

    ground = replace(whole, blocks=top_only)
    result = evaluate_as_built(ground, design, (as_built_limits(), ROAD), SilentMonitor())
    top, slope = result.faces
    assert top.passes
    assert (slope.count, slope.rejected) == (0, 0)
    assert math.isnan(slope.mean_m)
    assert math.isnan(slope.rejected_share)
    assert not any(slope.verdicts.values())
    assert not result.passes


def test_the_map_shows_deviation_by_limit_of_the_face_in_each_cell() -> None:
    result = judged(in_cells([(12, 25)], -0.3, 0.075))
    assert result.percent[25, 12] == pytest.approx(-200.0, abs=0.01)
    assert result.percent[24, 12] == pytest.approx(50.0, abs=0.01)
    assert result.percent[24, 2] == pytest.approx(100 * 0.075 / 0.19, abs=0.01)
    assert result.deviation_m[25, 12] == pytest.approx(-0.3, abs=1e-6)


def test_a_design_with_a_hole_has_no_values_in_it() -> None:
    design = embankment()
    middle = design.xyz[design.corners].mean(axis=1)
    is_hole = (np.abs(middle[:, 1] - SOUTH - 25) < 5) & (np.abs(middle[:, 2] - 24.0) < 1e-6)
    holed = TriangleSurface(design.xyz, design.corners[~is_hole], "")
    top, hole = judged(0.0, holed).faces[0], judged(0.0, design).faces[0]
    assert hole.area_m2 - top.area_m2 == pytest.approx(TOP_M * 10.0, abs=1.1)


def test_no_point_on_the_design_is_told_with_where_it_lies() -> None:
    design = embankment()
    far = TriangleSurface(design.xyz + np.array([1000.0, 0.0, 0.0]), design.corners, "far.xml")
    ground = measured_on(design, constant(0.0))
    with pytest.raises(Unsuitable, match="No measured ground point") as told:
        evaluate_as_built(ground, far, (as_built_limits(), ROAD), SilentMonitor())
    assert "far.xml" in told.value.where.en


def test_a_design_without_triangles_is_told() -> None:
    design = TriangleSurface(np.zeros((0, 3)), np.zeros((0, 3), np.int64), "empty.xml")
    ground = measured_on(embankment(), constant(0.0))
    with pytest.raises(Unsuitable, match="no area to judge"):
        evaluate_as_built(ground, design, (as_built_limits(), ROAD), SilentMonitor())


def test_a_boundary_beside_the_design_is_told() -> None:
    with pytest.raises(Unsuitable, match="no area to judge"):
        judged(0.0, boundary=shapely.box(0.0, 0.0, 10.0, 10.0))


def test_a_design_without_a_face_of_the_work_type_is_told() -> None:
    table = as_built_limits()
    road = table[ROAD]
    slopes = replace(road, faces=tuple(one for one in road.faces if one.face is FaceKind.SLOPE))
    flat = TriangleSurface(
        np.array([[WEST, SOUTH, 5.0], [WEST + 9, SOUTH, 5.0], [WEST, SOUTH + 9, 5.0]]),
        np.array([[0, 1, 2]]),
        "flat.xml",
    )
    with pytest.raises(Unsuitable, match="none of the faces") as told:
        judged(0.0, flat, table=replace(table, work_types=(slopes,)))
    assert "flat.xml" in told.value.where.ja


def test_points_that_are_nowhere_are_passed_over() -> None:
    design = embankment()
    whole = measured_on(design, constant(0.01))

    def broken() -> list[GroundBlock]:
        blocks = [GroundBlock(block.xyz.copy(), block.station) for block in whole.blocks()]
        blocks[0].xyz[::7, 2] = np.nan
        blocks[1].xyz[::5, 0] = np.nan
        return [*blocks, GroundBlock(np.empty((0, 3)), 1)]

    limits = (as_built_limits(), ROAD)
    ground = replace(whole, blocks=broken)
    result = evaluate_as_built(ground, design, limits, SilentMonitor())
    assert result.faces[0].mean_m == pytest.approx(0.01, abs=1e-6)


@pytest.mark.parametrize("cell_m", [0.0, -1.0, 1.5, math.nan])
def test_cells_larger_than_the_rule_allows_are_refused(cell_m: float) -> None:
    design = embankment()
    with pytest.raises(OutOfRange, match="at most 1 m"):
        evaluate_as_built(
            measured_on(design, constant(0.0)),
            design,
            (as_built_limits(), ROAD),
            SilentMonitor(),
            rules=AsBuiltRules(cell_m=cell_m),
        )


def test_a_cancel_stops_between_blocks() -> None:
    class Stopping(SilentMonitor):
        def check(self) -> None:
            raise Cancelled

    design = embankment()
    with pytest.raises(Cancelled):
        evaluate_as_built(
            measured_on(design, constant(0.0)), design, (as_built_limits(), ROAD), Stopping()
        )
