"""Covered gutters: lids that lie side by side, holes that are open, truth on the mesh."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.gutters.beds import Bed, squeeze_share
from processing.laboratory.simulate.gutters.gutters import add_gutters
from processing.laboratory.simulate.gutters.lid_shapes import LID_KINDS, Lid, lid_pieces
from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import RURAL


@dataclass(frozen=True)
class _Gutters:
    mesh: Mesh
    truth: tuple[TrueFeature, ...]


def _lids_of(built: SectionBuilder) -> tuple[TrueFeature, ...]:
    return tuple(one for one in built.truth if one.file == "gutters")


def _covered(seed: int) -> tuple[StreetSection, _Gutters]:
    """A section of a country road with covered gutters, with nothing but them."""
    street = Street(seed, RURAL, 400.0)
    for row, plan in enumerate(street.plans):
        if "lids" in (plan.left.drain, plan.right.drain) and not plan.junctions:
            section = street.bare_section(row)
            built = SectionBuilder(1)
            add_gutters(section, built)
            return section, _Gutters(built.mesh.mesh(), _lids_of(built))
    raise ValueError("no covered gutter")


SEEDS = [0, 5]


@pytest.fixture(scope="module", params=SEEDS)
def built(request: pytest.FixtureRequest) -> _Gutters:
    return _covered(request.param)[1]


def _runs(built: _Gutters) -> dict[object, list[TrueFeature]]:
    runs: dict[object, list[TrueFeature]] = {}
    for one in built.truth:
        runs.setdefault(one.facts["run"], []).append(one)
    return runs


def test_covers_of_a_run_follow_each_other_without_overlap(built: _Gutters) -> None:
    for covers in _runs(built).values():
        assert [one.facts["order"] for one in covers] == list(range(len(covers)))
        for one, after in pairwise(covers):
            rear, front = one.xyz, after.xyz
            along = rear[1] - rear[0]
            along /= np.linalg.norm(along)
            edge = max(rear[1] @ along, rear[2] @ along)
            assert min(front[0] @ along, front[3] @ along) > edge


def test_corners_of_the_truth_are_corners_of_the_mesh(built: _Gutters) -> None:
    mesh = built.mesh
    for one in built.truth:
        of_it = mesh.vertices[np.unique(mesh.triangles[mesh.instance == one.instance])]
        away = np.linalg.norm(of_it[None] - one.xyz[:4, None], axis=2).min(axis=1)
        assert away.max() < 1e-4


def test_a_cover_is_as_long_and_wide_as_its_facts_say(built: _Gutters) -> None:
    for one in built.truth:
        ring = one.xyz
        np.testing.assert_allclose(ring[0], ring[4])
        assert np.linalg.norm(ring[1] - ring[0]) == pytest.approx(one.facts["length_m"], abs=1e-4)
        assert np.linalg.norm(ring[2] - ring[1]) == pytest.approx(one.facts["width_m"], abs=1e-4)


def test_lids_lie_on_the_grounds_height_but_for_accidents() -> None:
    section, built = _covered(0)
    away = []
    for one in built.truth:
        middle = one.xyz[:4].mean(axis=0)
        side = 1 if one.facts["side"] == "left" else -1
        band = section.plan.side(side).band("drain")
        assert band is not None
        ground = section.position(one.chainage_m, side * (band.inner_m + band.outer_m) / 2)
        away.append(abs(middle[2] - ground[2]))
    assert np.median(away) < 0.01
    assert max(away) < 0.06


def _depths(built: _Gutters, positions: Floats) -> Floats:
    import open3d as o3d

    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(
        o3d.core.Tensor(built.mesh.vertices.astype(np.float32)),
        o3d.core.Tensor(built.mesh.triangles.astype(np.uint32)),
    )
    down = np.broadcast_to([0.0, 0.0, -1.0], positions.shape)
    rays = np.hstack([positions - down, down]).astype(np.float32)
    hits = scene.cast_rays(o3d.core.Tensor(rays))["t_hit"].numpy()
    found: Floats = hits.astype(np.float64) - 1.0
    return found


def test_a_beam_through_a_hole_reaches_the_channel_and_one_beside_it_the_lid() -> None:
    built = _covered(5)[1]
    through, beside = [], []
    for one in built.truth:
        holes = one.facts["holes"]
        if one.facts["type"] != "lid" or not holes or one.facts["uncovered"] != 1.0:
            continue
        rear_right, front_right, front_left = one.xyz[:3]
        along = (front_right - rear_right) / np.linalg.norm(front_right - rear_right)
        across = (front_left - front_right) / np.linalg.norm(front_left - front_right)
        end = (front_right + front_left) / 2 - 0.004 * along
        at = 0.245 * np.linalg.norm(front_left - front_right) if holes == 2 else 0.0
        through.append(end + at * across)
        beside.append(end - 0.1 * along)
    depths = _depths(built, np.array(through))
    assert np.mean(depths > 0.1) > 0.3, "holes that soil fills are few here"
    assert (depths > 0.003).all() or np.mean(depths > 0.003) > 0.95
    assert np.median(np.abs(_depths(built, np.array(beside)))) < 0.002


def test_the_same_lids_are_laid_whatever_is_built_first() -> None:
    street = Street(7, RURAL, 300.0)
    rows = list(street.within(0.0, 200.0))

    def built(row: int) -> SectionBuilder:
        built = SectionBuilder(1)
        add_gutters(street.bare_section(row), built)
        return built

    one = [built(row) for row in rows]
    other = [built(row) for row in rows[::-1]][::-1]
    for first, second in zip(one, other, strict=True):
        np.testing.assert_array_equal(first.mesh.mesh().vertices, second.mesh.mesh().vertices)
        assert [lid.facts for lid in first.truth] == [lid.facts for lid in second.truth]


@pytest.mark.parametrize("holes", [1, 2])
def test_a_lids_top_is_its_rectangle_less_its_notches(holes: int) -> None:
    notches = ((-0.05, 0.05),) if holes == 1 else ((-0.13, -0.03), (0.03, 0.13))
    lid = Lid(0.6, 0.38, 0.1, notches, (0.015, 0.015))
    shape = lid_pieces(lid)
    top = shape.piece < 24
    corners = shape.vertices[shape.triangles[top]]
    areas = np.linalg.norm(
        np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0]), axis=1
    )
    assert areas.sum() / 2 == pytest.approx(0.6 * 0.38 - holes * 2 * 0.1 * 0.015)
    assert set(shape.piece[top]) == set(range(24))
    cut = lid_pieces(replace(lid, depths_m=(0.015, 0.0)))
    assert len(cut.triangles) < len(shape.triangles)


def test_moulds_shares_are_those_of_the_survey() -> None:
    assert sum(one.share for one in LID_KINDS) == pytest.approx(1.0, abs=0.002)


def test_lids_are_left_out_where_the_bed_grows_narrow() -> None:
    """A bed that changes to its neighbour's width is cast in concrete there, never overlapped."""
    along = np.linspace(0.0, 20.0, 41)
    wide = np.interp(along, [0.0, 16.0, 20.0], [0.6, 0.6, 0.45])
    inner = np.column_stack([along, np.full(41, 3.0), np.zeros(41)])
    bed = Bed(1, along, inner, inner + np.column_stack([np.zeros(41), wide, np.zeros(41)]))
    assert bed.usual_width_m > 0.57
    first, last = bed.usual_nodes()
    assert first == 0
    assert 15.5 <= along[last] <= 17.0
    end = bed.line(0.57 * squeeze_share(bed, 0.57))
    assert (end[:, 1] < bed.outer[:, 1]).all()
