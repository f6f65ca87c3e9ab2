from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
import shapely
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from processing.core.errors import OutOfRange, Unsuitable, UserError
from processing.core.monitor import SilentMonitor
from processing.core.text import Text
from processing.methods.earthwork.geometry.triangle_surface import TriangleSurface
from processing.methods.earthwork.geometry.volume_scope import VolumeScope
from processing.methods.earthwork.surfaces.sides import EpochGround, Level, Side
from processing.methods.earthwork.volumes.comparison import compare
from processing.methods.earthwork.volumes.volume_parameters import VolumeParameters
from tests.processing.methods.earthwork.grounds import ORIGIN, flat, rolling, scan_of

Floats = NDArray[np.float64]
GRID = VolumeParameters()


def volume(before: Side, after: Side, parameters: VolumeParameters = GRID, **within: object):
    return compare(before, after, parameters, SilentMonitor(), VolumeScope(**within))  # type: ignore[arg-type]


def box(west: float, south: float, east: float, north: float) -> shapely.Polygon:
    return shapely.box(ORIGIN[0] + west, ORIGIN[1] + south, ORIGIN[0] + east, ORIGIN[1] + north)


def raised(height_m: float) -> EpochGround:
    return scan_of(lambda x, y: rolling(x, y) + height_m, name="after", seed=2)


def test_a_layer_everywhere_is_its_height_times_the_area() -> None:
    result = volume(scan_of(rolling), raised(0.3), boundary=box(3, 4, 17, 16))

    assert result.volumes.area_m2 == pytest.approx(14 * 12)
    assert result.volumes.fill_m3 == pytest.approx(0.3 * 14 * 12, rel=0.005)
    assert result.volumes.cut_m3 == pytest.approx(0.0, abs=0.01)
    assert result.volumes.net_m3 == result.volumes.fill_m3 - result.volumes.cut_m3
    assert result.volumes.unmeasured_area_m2 == pytest.approx(0.0, abs=0.5)


@given(height_m=st.floats(-2.0, 2.0), seed=st.integers(0, 5))
def test_epochs_the_other_way_round_swap_cut_and_fill(height_m: float, seed: int) -> None:
    before = scan_of(rolling, per_m2=40, size_m=(10.0, 10.0), seed=seed)
    after = scan_of(
        lambda x, y: height_m * np.sin(x), per_m2=40, size_m=(10.0, 10.0), seed=seed + 9
    )
    there, back = volume(before, after).volumes, volume(after, before).volumes

    assert there.fill_m3 == pytest.approx(back.cut_m3, abs=1e-3)
    assert there.cut_m3 == pytest.approx(back.fill_m3, abs=1e-3)


def test_noise_adds_neither_cut_nor_fill_where_nothing_changed() -> None:
    before = scan_of(rolling, noise_m=0.02, seed=3)
    after = scan_of(rolling, noise_m=0.02, seed=4)
    result = volume(before, after, boundary=box(2, 2, 18, 18))
    plain = float(np.nansum(np.abs(result.change.change_m * result.change.inside))) * 0.2**2

    # A plain sum of what is higher and what is lower takes noise for earth.
    assert plain > 1.0
    assert result.volumes.cut_m3 + result.volumes.fill_m3 < 0.15 * plain
    assert abs(result.volumes.net_m3) < result.volumes.uncertainty_m3


@pytest.mark.parametrize("method", ["grid", "tin", "end-area", "prismoidal"])
def test_every_method_finds_the_volume_of_a_ramp(method: str) -> None:
    # A wedge: 0 at one end, 2 m at the other, 16 m long and 10 m wide.
    ramp = scan_of(lambda x, _: np.clip(x - 2.0, 0.0, 16.0) / 8.0, per_m2=200)
    parameters = replace(GRID, method=method, interval_m=2.0)
    line = np.array([[2.0, 10.0], [18.0, 10.0]]) + ORIGIN[:2]
    result = volume(
        Level(float(ORIGIN[2])), ramp, parameters, boundary=box(2, 5, 18, 15), line=line
    )

    assert result.method == method
    assert result.volumes.fill_m3 == pytest.approx(160.0, rel=0.005)
    assert result.volumes.cut_m3 == pytest.approx(0.0, abs=0.1)


def test_a_design_is_a_side_and_its_holes_count_nothing() -> None:
    corners = np.array([[2, 2, 1], [18, 2, 1], [18, 18, 1], [2, 18, 1]], np.float64) + ORIGIN
    design = TriangleSurface(corners, np.array([[0, 1, 2], [0, 2, 3]]), "design")
    half = TriangleSurface(corners, np.array([[0, 1, 2]]), "half")

    whole = volume(scan_of(flat), design, boundary=box(2, 2, 18, 18))
    part = volume(scan_of(flat), half, boundary=box(2, 2, 18, 18))

    assert whole.volumes.fill_m3 == pytest.approx(256.0, rel=0.005)
    assert part.volumes.fill_m3 == pytest.approx(128.0, rel=0.02)
    assert part.volumes.unmeasured_area_m2 == pytest.approx(128.0, rel=0.02)
    assert any("left out" in note.en for note in part.notes)


def test_triangles_of_a_design_count_as_they_are() -> None:
    # A ridge between the middles of cells: on cells its edge would be cut off.
    ridge = np.array(
        [[2, 2, 0], [18, 2, 0], [10.03, 2, 4], [2, 18, 0], [18, 18, 0], [10.03, 18, 4]]
    )
    corners = np.array([[0, 2, 3], [2, 5, 3], [2, 1, 5], [1, 4, 5]])
    design = TriangleSurface(ridge + ORIGIN, corners, "ridge", (Text("told", "注記"),))
    parameters = replace(GRID, method="tin", grid_m=0.5)
    result = volume(scan_of(flat), design, parameters, boundary=box(2, 2, 18, 18))

    assert result.volumes.fill_m3 == pytest.approx(4 * 16 * 16 / 2, rel=1e-4)
    assert Text("told", "注記") in result.notes


def test_break_lines_belong_to_the_ground_that_they_lie_on() -> None:
    def ridge(x: Floats, _: Floats) -> Floats:
        return np.maximum(2.0 - np.abs(x - 10.1) / 2.0, 0.0)

    crest = np.array([[10.1, 1, 2.0], [10.1, 19, 2.0]]) + ORIGIN
    in_plan = np.array([[10.1, 1, np.nan], [10.1, 19, np.nan]]) + ORIGIN
    above = crest + np.array([0.0, 0.0, 5.0])
    parameters = replace(GRID, method="tin", grid_m=0.5)
    off = []
    for number, lines in enumerate(((), (crest,), (in_plan,), (above,))):
        result = volume(
            scan_of(flat, per_m2=60),
            scan_of(ridge, per_m2=60, seed=2),
            parameters,
            boundary=box(4, 4, 16, 16),
            break_lines=lines,
        )
        off.append(abs(result.volumes.fill_m3 - 8.0 * 12))
        assert any("neither ground" in note.en for note in result.notes) == (number == 3)
        assert result.volumes.cut_m3 < 0.2

    # Forced into the level ground before, the crest would take 2 m for a step of nothing.
    assert max(off) < 0.006 * 8.0 * 12


def test_a_hole_under_a_machine_is_filled_and_told() -> None:
    def away(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10, y - 10) > 2.5

    after = scan_of(lambda x, y: rolling(x, y) + 0.5, keep=away, seed=5)
    result = volume(scan_of(rolling), after, boundary=box(3, 3, 17, 17))

    assert result.volumes.unmeasured_area_m2 == pytest.approx(np.pi * 2.5**2, rel=0.15)
    assert result.volumes.fill_m3 == pytest.approx(98.0, abs=result.volumes.uncertainty_m3)
    assert result.volumes.measured_fill_m3 < result.volumes.fill_m3


def test_hidden_ground_takes_the_shape_of_the_other_date_and_no_change_is_invented() -> None:
    def ridged(x: Floats, y: Floats) -> Floats:
        return rolling(x, y) + np.maximum(1.0 - np.abs(x - 10.0), 0.0)

    def shown(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10, y - 10) > 4.0

    after = scan_of(ridged, keep=shown, seed=6)
    result = volume(scan_of(ridged), after, boundary=box(3, 3, 17, 17))

    # A smooth surface over the hole would cut the ridge off: 8 m³.
    assert result.volumes.unmeasured_area_m2 > 40.0
    assert result.volumes.cut_m3 + result.volumes.fill_m3 < 0.2
    assert result.volumes.uncertainty_m3 < 2.5


def test_ground_far_beyond_the_last_points_is_left_out_and_named() -> None:
    def shown(x: Floats, _: Floats) -> NDArray[np.bool_]:
        return x < 24.0

    wide = {"size_m": (40.0, 20.0)}
    before = scan_of(rolling, **wide)  # type: ignore[arg-type]
    after = scan_of(lambda x, y: rolling(x, y) + 0.5, keep=shown, seed=4, **wide)  # type: ignore[arg-type]
    result = volume(before, after, boundary=box(2, 2, 38, 18))

    # As far as holes reach, 10 m, it takes the shape that the other date shows.
    assert result.volumes.left_out_area_m2 == pytest.approx(4 * 16, rel=0.1)
    assert result.volumes.unmeasured_area_m2 == pytest.approx(14 * 16, rel=0.03)
    assert result.volumes.measured_fill_m3 == pytest.approx(0.5 * 22 * 16, rel=0.03)
    assert result.volumes.fill_m3 == pytest.approx(0.5 * 32 * 16, rel=0.15)
    assert abs(result.volumes.fill_m3 - 0.5 * 32 * 16) < result.volumes.uncertainty_m3
    assert any("left out and count nothing" in note.en for note in result.notes)


def test_a_roof_over_hidden_ground_is_no_fill() -> None:
    def hidden(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10, y - 10) < 6.0

    def roof(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return (np.abs(x - 10) < 1.2) & (np.abs(y - 10) < 2.0)

    def hut(x: Floats, y: Floats) -> Floats:
        return np.where(roof(x, y), 3.5, rolling(x, y))

    after = scan_of(hut, keep=lambda x, y: ~hidden(x, y) | roof(x, y), seed=7)
    result = volume(scan_of(rolling), after, boundary=box(2, 2, 18, 18))

    assert result.volumes.fill_m3 + result.volumes.cut_m3 < 0.5
    assert result.volumes.unmeasured_area_m2 == pytest.approx(np.pi * 6.0**2, rel=0.1)


def test_a_pit_with_upright_walls_is_cut() -> None:
    def floor(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return (np.abs(x - 10) < 2.0) & (np.abs(y - 10) < 3.0)

    after = scan_of(lambda x, y: np.where(floor(x, y), -2.5, flat(x, y)), seed=8)
    result = volume(scan_of(flat), after, boundary=box(2, 2, 18, 18))

    assert result.volumes.cut_m3 == pytest.approx(2.5 * 4 * 6, rel=0.05)


def test_a_third_date_fills_what_both_compared_ones_hid() -> None:
    def pit(x: Floats, y: Floats) -> Floats:
        return rolling(x, y) - 2.0 * (np.hypot(x - 10, y - 10) < 2.0)

    def shown(x: Floats, y: Floats) -> NDArray[np.bool_]:
        return np.hypot(x - 10, y - 10) > 3.0

    sides = scan_of(pit, keep=shown), scan_of(pit, keep=shown, seed=2)
    third = scan_of(pit, name="五月", seed=3)
    area = VolumeScope(box(3, 3, 17, 17))
    alone = compare(*sides, GRID, SilentMonitor(), area)
    result = compare(*sides, GRID, SilentMonitor(), area, others=(third,))
    middle = np.array([[10.0, 10.0]]) + ORIGIN[:2]
    deep = np.floor((middle - result.change.grid.origin[:2]) / result.change.grid.size_m)
    column, row = deep[0].astype(int)

    assert result.change.before[row, column] < alone.change.before[row, column] - 1.5
    assert any("五月" in note.en for note in result.notes)
    elsewhere = scan_of(pit, crs="EPSG:6678")
    with pytest.raises(Unsuitable, match="different reference systems"):
        compare(*sides, GRID, SilentMonitor(), area, others=(elsewhere,))


def test_only_ground_that_changed_bears_what_set_ups_are_off() -> None:
    def little(x: Floats, y: Floats) -> Floats:
        return rolling(x, y) + 0.5 * (np.hypot(x - 10, y - 10) < 2.0)

    layer = volume(scan_of(rolling, noise_m=0.003), raised(0.5), boundary=box(2, 2, 18, 18))
    heap = volume(
        scan_of(rolling, noise_m=0.003),
        scan_of(little, noise_m=0.003, seed=8),
        boundary=box(2, 2, 18, 18),
    )

    assert heap.volumes.fill_m3 == pytest.approx(0.5 * np.pi * 4.0, rel=0.03)
    assert heap.volumes.cut_m3 < 0.05
    assert heap.volumes.uncertainty_m3 < 0.5 * layer.volumes.uncertainty_m3


def test_a_shift_of_the_later_epoch_is_found_and_corrected_on_request() -> None:
    def changed(x: Floats, y: Floats) -> Floats:
        return rolling(x, y) + np.where(x > 13, 0.8, 0.0)

    before = scan_of(rolling, noise_m=0.003)
    after = scan_of(changed, noise_m=0.003, seed=7, shift_m=(0.05, -0.03, 0.05))
    found = volume(before, after, boundary=box(2, 2, 18, 18))
    mended = volume(before, after, replace(GRID, correct_shift=True), boundary=box(2, 2, 18, 18))

    assert found.registration is not None
    assert mended.registration is not None
    assert found.registration.is_significant
    assert not found.registration.is_corrected
    assert found.registration.shift_m == pytest.approx((0.05, -0.03, 0.05), abs=0.008)
    assert any("mm up" in note.en for note in found.notes)
    assert mended.registration.is_corrected
    true_m3 = 0.8 * 5 * 16
    assert abs(mended.volumes.net_m3 - true_m3) < 0.03 * true_m3
    assert abs(found.volumes.net_m3 - true_m3) > 0.1 * true_m3


def test_chance_is_no_shift_to_take_back() -> None:
    # On level ground nothing tells of a shift to the side.
    before, after = scan_of(flat, noise_m=0.01), scan_of(flat, noise_m=0.01, seed=3)
    result = volume(before, after, replace(GRID, correct_shift=True))

    assert result.registration is not None
    assert result.registration.shift_m[:2] == (0.0, 0.0) or not result.registration.is_corrected
    assert abs(result.volumes.net_m3) < 1.0


def test_epochs_that_lie_well_are_not_said_to_be_off() -> None:
    result = volume(scan_of(rolling, noise_m=0.005), raised(0.0))

    assert result.registration is not None
    assert not result.registration.is_significant
    assert result.notes == ()


def test_without_a_boundary_all_common_ground_counts() -> None:
    result = volume(scan_of(flat), scan_of(lambda x, _: flat(x, x) + 1.0, seed=2))

    assert result.volumes.area_m2 == pytest.approx(400.0, rel=0.03)
    assert result.volumes.fill_m3 == pytest.approx(result.volumes.area_m2, rel=0.01)


def refused(error: type[UserError], before: Side, after: Side, **within: object) -> str:
    with pytest.raises(error) as raised_error:
        volume(before, after, **within)
    return str(raised_error.value)


def test_what_can_not_be_compared_is_refused_in_a_sentence() -> None:
    here = scan_of(flat)
    ten = scan_of(flat, per_m2=0.025)

    assert "no ground in common" in refused(
        Unsuitable, here, scan_of(flat, shift_m=(500.0, 0.0, 0.0))
    )
    assert "different reference systems" in refused(
        Unsuitable, here, scan_of(flat, crs="EPSG:6678")
    )
    assert "two height datums" in refused(Unsuitable, here, scan_of(flat, shift_m=(0, 0, 36.7)))
    assert "too few ground points" in refused(Unsuitable, here, ten)
    assert "lies outside" in refused(OutOfRange, here, raised(0.1), boundary=box(90, 90, 99, 99))
    assert "Neither side" in refused(Unsuitable, Level(1.0), Level(2.0))


def test_a_mesh_too_fine_for_a_county_is_refused() -> None:
    wide = scan_of(flat, size_m=(3000.0, 3000.0), per_m2=0.01)
    with pytest.raises(OutOfRange, match="too fine"):
        volume(wide, wide, replace(GRID, grid_m=0.05))
