"""Barriers: on the ground, off the carriageway, open at dropped curbs and around what stands."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.border.along import posts, stations, sweep_section, wall
from processing.laboratory.simulate.border.barrier_shapes import BARRIERS, BarrierRun
from processing.laboratory.simulate.border.barriers import add_barriers
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.things import SectionBuilder
from processing.laboratory.simulate.street.dropped_curbs import drops_of
from processing.laboratory.simulate.street.free_positions import (
    FreePosition,
    FreePositions,
    free_from_m,
)
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, RURAL, URBAN, Style


def _sections(seed: int, style: Style) -> list[StreetSection]:
    street = Street(seed, style, 150.0)
    return [street.bare_section(row) for row in street.within(0.0, 150.0)]


@pytest.mark.parametrize("kind", list(BARRIERS))
def test_a_barrier_reaches_the_ground_and_is_as_high_as_barriers_are(kind: str) -> None:
    section = _sections(1, RURAL)[1]
    start = section.plan.start_m + 1.0
    for number in range(6):
        built = SectionBuilder(1)
        BARRIERS[kind](chance(number, "test"), section, built, BarrierRun(start, start + 18.0, 8.0))
        mesh = built.mesh.mesh()
        ground = section.position(np.linspace(start, start + 18.0, 40), 8.0)[:, 2]
        assert mesh.vertices[:, 2].min() < ground.min()
        highest = mesh.vertices[:, 2].max() - ground.max()
        assert (1.9 if kind == "noise" else 0.6) < highest < (4.2 if kind == "noise" else 1.3)
        assert (mesh.label == 1).all()


@pytest.mark.parametrize("style", [URBAN, RURAL, HIGHWAY])
def test_barriers_stand_behind_curb_and_gutter_or_in_the_median(style: Style) -> None:
    for seed in range(2):
        for section in _sections(seed, style):
            built = SectionBuilder(1)
            add_barriers(FreePositions(section), built)
            mesh = built.mesh.mesh()
            if not len(mesh.vertices):
                continue
            alignment = section.alignment
            near = np.linspace(section.plan.start_m - 5, section.plan.end_m + 5, 800)
            centre = np.column_stack(
                [np.interp(near, alignment.chainages, alignment.positions[:, k]) for k in range(2)]
            )
            used = mesh.vertices[np.unique(mesh.triangles)]
            away = np.array([np.linalg.norm(centre - one, axis=1).min() for one in used[:, :2]])
            least = min(free_from_m(section.plan.left), free_from_m(section.plan.right))
            beside = away > max(section.plan.median_m / 2, 0.01)
            assert away[beside].min(initial=np.inf) > least
            assert away[~beside].max(initial=0.0) <= section.plan.median_m / 2


def test_a_barrier_leaves_dropped_curbs_and_poles_open() -> None:
    seen = 0
    for seed in (0, 1, 3, 5):
        for section in _sections(seed, URBAN):
            positions = FreePositions(section)
            spot = FreePosition(
                (section.plan.start_m + section.plan.end_m) / 2,
                free_from_m(section.plan.left) + 0.3,
            )
            positions.take(spot, 0.15)
            built = SectionBuilder(1)
            add_barriers(positions, built)
            kinds = {one.instance: one.kind for one in built.things}
            mesh = built.mesh.mesh()
            for instance, kind in kinds.items():
                if kind not in ("fence", "guard_pipe", "guardrail"):
                    continue
                of_it = mesh.vertices[np.unique(mesh.triangles[mesh.instance == instance])]
                for drop in drops_of(section.seed, section.plan, 1):
                    middle = section.position((drop.from_m + drop.to_m) / 2, spot.offset_m)
                    assert np.linalg.norm(of_it - middle, axis=1).min() > 0.5
                assert np.linalg.norm(of_it - positions.where(spot), axis=1).min() > 0.15
                seen += 1
    assert seen > 3


def test_rubber_poles_are_poles_of_the_truth_on_the_ground() -> None:
    found = 0
    for section in [one for seed in range(3) for one in _sections(seed, URBAN)]:
        built = SectionBuilder(1)
        add_barriers(FreePositions(section), built)
        mesh = built.mesh.mesh()
        for one in built.truth:
            if one.file == "barriers":
                continue
            assert one.file == "poles"
            of_it = mesh.vertices[mesh.triangles[mesh.instance == one.instance]].reshape(-1, 3)
            assert np.ptp(of_it[:, 2]) == pytest.approx(float(one.facts["height_m"]) + 0.3)
            assert of_it[:, 2].max() - one.xyz[0, 2] == pytest.approx(one.facts["height_m"])
            found += 1
    assert found > 0


def test_a_swept_wall_is_closed() -> None:
    section = _sections(0, URBAN)[0]
    along = stations(section.plan.start_m + 1, section.plan.start_m + 9)
    vertices, triangles = sweep_section(section, along, 9.0, wall(0.15, 1.2))
    corners = vertices[triangles]
    keys = np.round(corners, 6).view([("", np.float64)] * 3).reshape(-1, 3)
    edges: dict[frozenset[bytes], int] = {}
    for one in keys:
        names = [position.tobytes() for position in one]
        for first, second in ((0, 1), (1, 2), (2, 0)):
            edge = frozenset((names[first], names[second]))
            edges[edge] = edges.get(edge, 0) + 1
    assert set(edges.values()) == {2}


def test_posts_have_the_girth_of_their_radius() -> None:
    vertices, triangles = posts(np.zeros((2, 3)), 0.1, np.array([1.0, 2.0]))
    assert np.hypot(*vertices[:, :2].T) == pytest.approx(0.1)
    assert vertices[:, 2].max() == 2.0
    assert triangles.max() < len(vertices)


def test_rubber_poles_do_not_stand_in_the_line_of_a_barrier() -> None:
    poles = 0
    for seed in (205, 208, 0, 5):
        for section in _sections(seed, URBAN):
            built = SectionBuilder(1)
            add_barriers(FreePositions(section), built)
            mesh = built.mesh.mesh()
            barriers = mesh.vertices[np.unique(mesh.triangles[mesh.label == 1])][:, :2]
            for one in built.truth:
                if one.file != "poles":
                    continue
                poles += 1
                away = np.linalg.norm(barriers - one.xyz[0, :2], axis=1)
                assert away.min(initial=np.inf) > 0.6
    assert poles > 3


@pytest.mark.parametrize("kind", list(BARRIERS))
def test_truth_of_a_barrier_is_the_line_of_its_foot_and_its_pieces_count_its_triangles(
    kind: str,
) -> None:
    section = _sections(1, RURAL)[1]
    start = section.plan.start_m + 1.0
    built = SectionBuilder(1)
    stretch = BarrierRun(start, start + 18.0, 8.0)
    BARRIERS[kind](chance(3, "test"), section, built, stretch)
    (truth,) = (one for one in built.truth if one.file == "barriers")
    mesh = built.mesh.mesh()
    assert truth.instance == built.things[0].instance
    foot = section.position(np.linspace(start, start + 18.0, 10), 8.0)
    assert truth.xyz == pytest.approx(foot, abs=1e-6)
    middles = mesh.vertices[mesh.triangles].mean(axis=1)
    pieces = (truth.xyz[:-1] + truth.xyz[1:]) / 2
    away = np.hypot(*(middles - pieces[mesh.piece])[:, :2].T)
    assert away.max() < 1.5
    highest = (mesh.vertices[mesh.triangles][:, :, 2].max(axis=1) - pieces[mesh.piece, 2]).max()
    assert float(truth.facts["height_m"]) == pytest.approx(highest, abs=0.15)
