"""Curbs: their truth lies on the mesh, dropped parts are as low as they were built, runs meet."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from scipy.spatial import cKDTree

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.roadway.ends import add_ends
from processing.laboratory.simulate.roadway.islands import add_islands
from processing.laboratory.simulate.roadway.junctions import add_junctions
from processing.laboratory.simulate.scene.mesh import Floats, Mesh
from processing.laboratory.simulate.scene.things import SectionBuilder, TrueFeature
from processing.laboratory.simulate.street.plan import SIDES
from processing.laboratory.simulate.street.section import StreetSection
from processing.laboratory.simulate.street.styles import HIGHWAY, URBAN, Style
from processing.laboratory.simulate.street.surfaces import add_ground
from processing.laboratory.simulate.street.sweep import FACE_PIECE, PIECE_M, Sweep

CLOSE_M = 1e-4


def _built(section: StreetSection) -> tuple[Mesh, list[TrueFeature]]:
    built = SectionBuilder(1)
    for add in (add_ground, add_junctions, add_islands, add_ends):
        add(section, built)
    return built.mesh.mesh(), built.truth


def _street(seed: int, style: Style = URBAN) -> list[StreetSection]:
    street = Street(seed, style, 150.0)
    return [street.bare_section(row) for row in street.within(-20, 170)]


@pytest.fixture(scope="module", params=[4, 6])
def sections(request: pytest.FixtureRequest) -> list[StreetSection]:
    return _street(request.param)


@pytest.fixture(scope="module")
def built(sections: list[StreetSection]) -> list[tuple[StreetSection, Mesh, list[TrueFeature]]]:
    return [(one, *_built(one)) for one in sections]


Whole = list[tuple[StreetSection, Mesh, list[TrueFeature]]]


def _nearest(positions: Floats, vertices: Floats) -> Floats:
    from scipy.spatial import cKDTree

    found: Floats = cKDTree(vertices).query(positions)[0]
    return found


def test_lower_edges_are_edges_of_the_mesh(built: Whole) -> None:
    for _, mesh, truth in built:
        for one in truth:
            if one.facts["edge"] == "lower":
                own = mesh.triangles[mesh.instance == one.instance]
                vertices = mesh.vertices[np.unique(own)]
                assert _nearest(one.xyz, vertices).max() < CLOSE_M


def test_upper_edges_without_chamfer_are_edges_of_the_mesh(built: Whole) -> None:
    found = 0
    for _, mesh, truth in built:
        for one in truth:
            if one.facts["edge"] == "upper" and one.facts["chamfer_m"] == 0:
                assert _nearest(one.xyz, mesh.vertices).max() < CLOSE_M
                found += 1
    assert found


def _crossing(sweep: Sweep, foot: int, top: int) -> tuple[Floats, Floats]:
    """Where the planes of a stone's face and top meet, from the mesh's own lines."""
    away = np.column_stack(sweep.profile.away)
    step = 1 if top > foot else -1
    f0, f1, t0, t1 = foot, foot + step, foot + 2 * step, top
    height = sweep.heights
    with np.errstate(divide="ignore", invalid="ignore"):
        face = (away[:, f1] - away[:, f0]) / (height[:, f1] - height[:, f0])
        level = (height[:, t1] - height[:, t0]) / (away[:, t1] - away[:, t0])
        start = away[:, f0] - away[:, t0]
        rise = (height[:, t0] + level * start - height[:, f0]) / (1 - level * face)
    return away[:, f0] + face * rise, height[:, f0] + rise


def test_upper_edges_of_chamfered_stones_are_where_face_and_top_meet(
    sections: list[StreetSection],
) -> None:
    found = 0
    for section in sections:
        for side in SIDES:
            sweep = section.layout.sides[side].sweep
            for edge in sweep.profile.edges:
                if edge.role != "road":
                    continue
                away, height = _crossing(sweep, edge.foot, edge.top)
                stands = edge.above - sweep.profile.above[edge.foot] > 0.03
                position = sweep.edge_positions(section.alignment, edge)
                assert np.abs(edge.away - away)[stands].max() < CLOSE_M
                assert np.abs(position[:, 2] - height)[stands].max() < CLOSE_M
                found += 1
    assert found


def test_dropped_curbs_are_as_low_and_as_long_as_they_were_built(built: Whole) -> None:
    found = 0
    for section, _, truth in built:
        for side in SIDES:
            for drop in section.layout.sides[side].drops:
                runs = [
                    one
                    for one in truth
                    if one.facts["type"] == "dropped"
                    and one.facts["side"] == ("left" if side > 0 else "right")
                    and abs(one.chainage_m - (drop.from_m + drop.to_m) / 2) < 1.0
                ]
                upper, lower = (
                    next(one.xyz for one in runs if one.facts["edge"] == edge)
                    for edge in ("upper", "lower")
                )
                steps = upper[:, 2] - lower[:, 2]
                length = np.linalg.norm(np.diff(lower, axis=0), axis=1).sum()
                assert abs(float(np.median(steps)) - drop.high_m) < 0.02
                assert length == pytest.approx(drop.to_m - drop.from_m - drop.ramp_m, rel=0.25)
                found += 1
    assert found > 3


def test_vertices_are_close_and_both_edges_have_the_same_number(built: Whole) -> None:
    for _, _, truth in built:
        pairs: dict[object, dict[object, Floats]] = {}
        for one in truth:
            pairs.setdefault(one.facts["run"], {})[one.facts["edge"]] = one.xyz
            steps = np.linalg.norm(np.diff(one.xyz, axis=0), axis=1)
            assert steps.max() < PIECE_M * 1.6
        for lines in pairs.values():
            if "lower" in lines:
                assert lines["lower"].shape == lines["upper"].shape


def test_pieces_count_half_metres_along_the_upper_edge(built: Whole) -> None:
    for _, mesh, truth in built:
        for one in truth:
            if one.facts["edge"] == "upper":
                length = np.linalg.norm(np.diff(one.xyz, axis=0), axis=1).sum()
                pieces = mesh.piece[mesh.instance == one.instance]
                for part in (pieces[pieces < FACE_PIECE], pieces[pieces >= FACE_PIECE]):
                    assert abs(int(part.max() % FACE_PIECE) - length / PIECE_M) <= 2


def test_faces_are_told_from_tops_so_that_truth_knows_where_a_foot_shows(built: Whole) -> None:
    faces = 0
    for _, mesh, truth in built:
        for one in truth:
            if one.facts["edge"] == "lower":
                own = mesh.instance == one.instance
                corners = mesh.vertices[mesh.triangles[own & (mesh.piece >= FACE_PIECE)]]
                positions = cKDTree(corners.reshape(-1, 3))
                away, _ = positions.query(one.xyz)
                assert away.max() < 0.002
                tops = mesh.triangles[own & (mesh.piece < FACE_PIECE)]
                higher = mesh.vertices[tops][..., 2].max() - one.xyz[:, 2].min()
                assert higher > 0
                faces += 1
    assert faces > 5


def _meets(one: StreetSection, other: StreetSection, side: int) -> bool:
    return side not in one.plan.junctions + other.plan.junctions and (
        one.plan.side(side).curb == other.plan.side(side).curb != "none"
        and one.plan.side(side).drain == other.plan.side(side).drain
        and (one.plan.side(side).strip_m > 0) == (other.plan.side(side).strip_m > 0)
    )


@pytest.mark.parametrize("style", [URBAN, HIGHWAY])
def test_curbs_of_neighbouring_sections_meet(style: Style) -> None:
    found = 0
    for seed in (4, 6, 9):
        for one, other in pairwise(_street(seed, style)):
            for side in SIDES:
                if not _meets(one, other, side):
                    continue
                ends = []
                for section, node in ((one, -1), (other, 0)):
                    sweep = section.layout.sides[side].sweep
                    edge = next(each for each in sweep.profile.edges if each.role == "road")
                    ends.append(sweep.edge_positions(section.alignment, edge)[node])
                assert np.linalg.norm(ends[0] - ends[1]) < 1e-3
                found += 1
    assert found
