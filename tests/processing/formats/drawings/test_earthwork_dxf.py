"""The plan of a volume, read back by another program: colours, contours, boundary, legend."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import ezdxf.filemanagement
import numpy as np
import pytest
import shapely
from ezdxf.path import from_hatch

from processing.core.errors import Cancelled, InUse, OutOfRange, Unsuitable
from processing.core.text import Text
from processing.formats.drawings.dxf_document import PlanVersion
from processing.formats.drawings.earthwork_dxf import (
    BOUNDARY_LAYER,
    CHANGE_LAYER,
    CONTOUR_LAYER,
    INDEX_LAYER,
    LABEL_LAYER,
    LEGEND_LAYER,
    TITLE_LAYER,
    UNMEASURED_LAYER,
    EarthworkPlan,
    PlanStyle,
    write_earthwork_dxf,
)
from processing.formats.vectors.boundary_files import read_boundary
from processing.methods.earthwork.maps.change_grid import ChangeGrid
from processing.methods.earthwork.maps.contours import LevelLine
from processing.methods.earthwork.maps.heat_map import change_classes
from processing.methods.ground.filters.cells import CellGrid
from tests.monitors import CancelledAfter

EAST, NORTH, CELL, SIDE = -12_000.0, -35_000.0, 0.5, 80
VERSIONS: tuple[PlanVersion, ...] = ("R2000", "R2018")


def change_grid() -> ChangeGrid:
    """A hollow of 40 cm in the west with a heap inside it, untouched ground in the east."""
    after = np.zeros((SIDE, SIDE), np.float32)
    after[:, :30] = -0.4
    after[20:40, 10:20] = 0.15
    grid = CellGrid(np.array([EAST, NORTH, 50.0]), CELL, SIDE, SIDE)
    whole = np.ones((SIDE, SIDE))
    is_measured = whole > 0
    is_measured[60:70, 50:60] = False
    return ChangeGrid(grid, np.zeros_like(after), after, is_measured, whole.astype(np.float32))


def ring() -> np.ndarray:
    length = SIDE * CELL
    corners = [[0.0, 0.0], [length, 0.0], [length, length], [0.0, length]]
    return np.array([EAST, NORTH]) + corners


def level_line(xy: np.ndarray, level_m: float, *, is_index: bool) -> LevelLine:
    return LevelLine(level_m, is_index, np.column_stack([xy, np.full(len(xy), level_m)]))


def contours() -> tuple[LevelLine, ...]:
    angles = np.linspace(0.0, 2 * np.pi, 41)
    circle = np.column_stack([np.cos(angles), np.sin(angles)])
    circle[-1] = circle[0]
    middle = np.array([EAST, NORTH]) + 0.5 * SIDE * CELL
    straight = np.array([[EAST + 35.0, NORTH + 2.0], [EAST + 5.0, NORTH + 2.0]])
    return (
        level_line(middle + 10 * circle, 51.0, is_index=False),
        level_line(middle + 5 * circle, 52.5, is_index=True),
        level_line(straight, 50.0, is_index=True),
    )


PLAN = EarthworkPlan(
    title=(Text("Earthwork", "切盛土量図"), Text("Cut 420.0 m³", "切土 420.0 m³")),
    change=change_grid(),
    classes=change_classes(0.5),
    contours=contours(),
    boundary=(ring(),),
    crs="EPSG:6677",
)


def drawn(path: Path, plan: EarthworkPlan = PLAN, look: PlanStyle | None = None) -> Any:
    write_earthwork_dxf(path, plan, look)
    doc = ezdxf.filemanagement.readfile(path)
    audit = doc.audit()
    assert [one.message for one in (*audit.errors, *audit.fixes)] == []
    return doc


def filled_areas(doc: Any) -> dict[str, float]:
    """Filled area left of the legend by layer: holes are taken away."""
    found: dict[str, float] = {}
    for hatch in doc.modelspace().query("HATCH"):
        for path in hatch.paths.paths:
            ring = shapely.Polygon([vertex[:2] for vertex in path.vertices])
            if ring.bounds[0] < EAST + SIDE * CELL:
                sign = 1 if path.path_type_flags & 1 else -1
                layer = hatch.dxf.layer
                found[layer] = found.get(layer, 0.0) + sign * ring.area
    return found


@pytest.mark.parametrize("version", VERSIONS)
def test_each_class_is_filled_on_a_layer_that_says_its_limits(
    tmp_path: Path, version: PlanVersion
) -> None:
    doc = drawn(tmp_path / "a.dxf", look=PlanStyle(version=version))
    assert filled_areas(doc) == pytest.approx(
        {
            f"{CHANGE_LAYER}2_-0.500～-0.250m": (80 * 30 - 200) * 0.25,
            f"{CHANGE_LAYER}5_-0.025～+0.025m": 80 * 50 * 0.25,
            f"{CHANGE_LAYER}7_+0.100～+0.250m": 200 * 0.25,
            UNMEASURED_LAYER: 100 * 0.25,
        }
    )
    layers = [one for one in doc.layers if one.dxf.name.startswith(CHANGE_LAYER)]
    colours = [one.color if version == "R2000" else one.rgb for one in layers]
    assert len(set(colours[:9])) == 9
    if version == "R2018":
        assert tuple(colours[0]) == change_classes(0.5)[0].rgb
    assert all(hatch.dxf.color == 256 for hatch in doc.modelspace().query("HATCH"))
    pattern = doc.modelspace().query(f'HATCH[layer=="{UNMEASURED_LAYER}"]').first
    assert not pattern.dxf.solid_fill
    assert all(from_hatch(hatch) for hatch in doc.modelspace().query("HATCH"))


def test_contours_lie_at_their_heights_on_layers_of_the_drafting_standard(tmp_path: Path) -> None:
    space = drawn(tmp_path / "a.dxf").modelspace()
    (thin,) = space.query(f'LWPOLYLINE[layer=="{CONTOUR_LAYER}"]')
    circle, straight = space.query(f'LWPOLYLINE[layer=="{INDEX_LAYER}"]')
    assert [one.dxf.elevation for one in (thin, circle, straight)] == [51.0, 52.5, 50.0]
    assert (thin.closed, circle.closed, straight.closed) == (True, True, False)
    assert len(thin) == 40
    found = np.array([position[:2] for position in straight.get_points()])
    assert found == pytest.approx(PLAN.contours[2].xyz[:, :2])


def test_index_contours_are_labelled_along_them_and_upright(tmp_path: Path) -> None:
    plain = EarthworkPlan(contours=contours())
    for plan in (PLAN, plain):
        space = drawn(tmp_path / "a.dxf", plan, PlanStyle(scale=200)).modelspace()
        labels = {one.dxf.text: one for one in space.query(f'TEXT[layer=="{LABEL_LAYER}"]')}
        assert set(labels) == {"52.5", "50.0"}
        x, y, height = labels["50.0"].dxf.align_point
        assert (x, height) == (pytest.approx(EAST + 20.0), 50.0)
        # The line runs west, so what is above it is to its right.
        assert (y - NORTH - 2.0) == pytest.approx(0.0 if plan is PLAN else 0.75 * 0.0018 * 200)
        assert labels["50.0"].dxf.rotation == pytest.approx(0.0, abs=1e-9)
        # Over colours a label has a plate that keeps it legible.
        assert len(space.query("SOLID")) == (2 if plan is PLAN else 0)


@pytest.mark.parametrize("version", VERSIONS)
def test_the_boundary_is_read_back_as_one(tmp_path: Path, version: PlanVersion) -> None:
    drawn(tmp_path / "a.dxf", look=PlanStyle(version=version))
    read = read_boundary(tmp_path / "a.dxf", crs="EPSG:6677", layer=BOUNDARY_LAYER)
    assert read.crs == "EPSG:6677"
    assert sorted(map(tuple, read.rings[0].tolist())) == sorted(map(tuple, ring().tolist()))


@pytest.mark.parametrize("version", VERSIONS)
@pytest.mark.parametrize("language", ["en", "ja"])
def test_texts_say_what_the_colours_mean_and_where_it_is(
    tmp_path: Path, version: PlanVersion, language: Any
) -> None:
    doc = drawn(tmp_path / "a.dxf", look=PlanStyle(version=version, language=language))
    texts = {
        layer: [one.dxf.text for one in doc.modelspace().query(f'TEXT[layer=="{layer}"]')]
        for layer in (TITLE_LAYER, LEGEND_LAYER)
    }
    assert "EPSG:6677" in texts[TITLE_LAYER][0]
    assert "1:200" in texts[TITLE_LAYER][0]
    assert texts[TITLE_LAYER][-1] == ("Earthwork" if language == "en" else "切盛土量図")
    minus = "－" if version == "R2000" else "−"
    words = ["above +0.500 m", f"below {minus}0.500 m", "not measured"]
    if language == "ja":
        words = ["+0.500 m 超", f"{minus}0.500 m 未満", "未計測（補間）"]
    assert [one for one in texts[LEGEND_LAYER] if one in words] == words
    assert doc.header["$DWGCODEPAGE"] == "ANSI_932"


def test_texts_keep_their_size_on_paper_and_overlap_nothing(tmp_path: Path) -> None:
    for scale in (100, 500):
        space = drawn(tmp_path / "a.dxf", look=PlanStyle(scale=scale)).modelspace()
        title = list(space.query(f'TEXT[layer=="{TITLE_LAYER}"]'))
        assert {one.dxf.height for one in title} == {0.0025 * scale}
        heights = sorted(one.dxf.insert.y for one in title)
        assert heights[0] > NORTH + SIDE * CELL
        assert min(np.diff(heights)) > 1.5 * 0.0025 * scale
        legend = [
            one.dxf.align_point.y
            for one in space.query(f'TEXT[layer=="{LEGEND_LAYER}"]')
            if one.dxf.text.endswith(("m", "超", "未満", "）")) and one.dxf.text != "m"
        ]
        assert min(-np.diff(sorted(legend, reverse=True))) > 1.5 * 0.0025 * scale


def test_parts_may_be_missing_but_not_all(tmp_path: Path) -> None:
    only = EarthworkPlan(boundary=(ring(),))
    doc = drawn(tmp_path / "a.dxf", only)
    assert len(doc.modelspace().query("HATCH")) == 0
    with pytest.raises(Unsuitable, match="no change, no contour and no boundary"):
        write_earthwork_dxf(tmp_path / "b.dxf", EarthworkPlan())
    nothing = change_grid()
    nothing.after[:] = math.nan
    with pytest.raises(Unsuitable, match="no change"):
        write_earthwork_dxf(
            tmp_path / "b.dxf", EarthworkPlan(change=nothing, classes=change_classes(0.5))
        )
    look = PlanStyle(version="R12")  # type: ignore[arg-type]
    with pytest.raises(OutOfRange):
        write_earthwork_dxf(tmp_path / "b.dxf", only, look)
    assert [one.name for one in tmp_path.iterdir()] == ["a.dxf"]


def test_a_cancel_leaves_nothing_and_inputs_are_kept(tmp_path: Path) -> None:
    path = tmp_path / "a.dxf"
    with pytest.raises(Cancelled):
        write_earthwork_dxf(path, PLAN, monitor=CancelledAfter())
    assert not list(tmp_path.iterdir())
    path.touch()
    with pytest.raises(InUse):
        write_earthwork_dxf(path, PLAN, never=[path])


def test_noise_is_drawn_in_some_bytes_a_cell(tmp_path: Path) -> None:
    random = np.random.default_rng(5)
    after = random.normal(0.0, 0.1, (150, 150)).astype(np.float32)
    grid = CellGrid(np.array([EAST, NORTH, 0.0]), 0.2, 150, 150)
    whole = np.ones(after.shape, np.float32)
    change = ChangeGrid(grid, 0 * after, after, whole > 0, whole)
    drawn(tmp_path / "a.dxf", EarthworkPlan(change=change, classes=change_classes(0.5)))
    assert (tmp_path / "a.dxf").stat().st_size < 3e6
