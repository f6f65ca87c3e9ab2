"""Points of what is not there, and of what moves."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.returns import BeamHits, Returns
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.scene.chance import chance
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import MeshBuilder, box, plate
from processing.laboratory.simulate.sites.bodies import SiteBody, SiteKind
from processing.laboratory.simulate.sites.ghosts import Ghosts, GhostSources, add_ghosts, ghosts_of
from processing.laboratory.simulate.sites.heights import HeightGrid
from processing.laboratory.simulate.sites.layout import SiteLayout
from processing.laboratory.simulate.sites.movement import DustCloud, MovementTrack, MovingThings
from processing.laboratory.simulate.sites.recording import labels_of, pattern_of
from processing.laboratory.simulate.sites.small_things import worker
from processing.laboratory.simulate.sites.terrain import SiteGround

QUIET = GhostSources([], [], [], 0.0, is_phase=False, restless=0.0)
EYE = np.array([10.0, 10.0, 2.0])


def flat(material: Material) -> SiteLayout:
    z = np.zeros((41, 41), np.float32)
    return SiteLayout(
        SiteGround(
            HeightGrid(z, 0.5),
            np.full(z.shape, int(material), np.uint8),
            np.ones(z.shape, np.bool_),
        )
    )


def beams_to(targets: np.ndarray, time_s: float = 0.0) -> Beams:
    directions = targets - EYE
    directions /= np.linalg.norm(directions, axis=1)[:, None]
    return Beams(
        0, np.full(len(directions), time_s), np.broadcast_to(EYE, directions.shape), directions
    )


def pond_before_a_wall() -> RaycastScene:
    builder = MeshBuilder()
    water = plate(np.array([[0, 0, 0], [20, 0, 0], [20, 20, 0], [0, 20, 0.0]]))
    builder.add(water, Material.WATER, 2, 0)
    builder.add(box((18, 0, 0), (19, 20, 9)), Material.CONCRETE, 1, 1)
    return RaycastScene(builder.mesh(), np.array([10.0, 10.0, 0.0]))


def test_water_shows_the_wall_behind_it_below_the_ground() -> None:
    scene = pond_before_a_wall()
    targets = np.column_stack([np.full(400, 14.0), np.linspace(8, 12, 400), np.zeros(400)])
    beams = beams_to(targets)
    hits = scene.cast(beams.origins, beams.directions)
    met = BeamHits.of(hits, scene.mesh)
    ghosts = ghosts_of(chance(1, "ghosts"), beams, met, (hits, scene), QUIET)
    assert 120 < ghosts.rays.size < 280  # half of what the water takes
    positions = EYE + beams.directions[ghosts.rays] * ghosts.ranges[:, None]
    assert (
        np.abs(positions[:, 0] - 18).max() < 0.2
    )  # straight on, as deep as the wall is high there
    assert (positions[:, 2] < -1).all()
    kind, label = labels_of(positions, ghosts.kinds, flat(Material.WATER))
    assert (kind == int(SiteKind.GHOST)).all()
    assert (label == 7).all()


def test_a_cloud_of_dust_returns_beams_from_within_it_alone() -> None:
    scene = pond_before_a_wall()
    targets = np.column_stack([np.full(400, 18.0), np.linspace(1, 19, 400), np.full(400, 2.0)])
    beams = beams_to(targets)
    hits = scene.cast(beams.origins, beams.directions)
    cloud = DustCloud(np.array([14.0, 10, 2]), np.array([1.0, 2, 1]), np.zeros(3), -1.0, 1.0, 0.4)
    ghost_sources = GhostSources([], [cloud], [], 0.0, is_phase=False, restless=0.0)
    met = BeamHits.of(hits, scene.mesh)
    ghosts = ghosts_of(chance(2, "ghosts"), beams, met, (hits, scene), ghost_sources)
    dust = ghosts.kinds == int(SiteKind.DUST)
    positions = EYE + beams.directions[ghosts.rays[dust]] * ghosts.ranges[dust, None]
    assert dust.sum() > 20
    assert (np.linalg.norm((positions - cloud.centre) / cloud.radii, axis=1) < 1 + 1e-9).all()


def test_a_ghost_takes_the_place_of_what_its_pulse_met() -> None:
    beams = beams_to(np.array([[12.0, 10, 0], [13.0, 10, 0], [14.0, 10, 0]]))
    xyz = np.zeros((4, 3))
    ones = np.ones(4, np.uint8)
    pulse = np.array([0, 1, 1, 2])
    evidence = np.zeros(4, np.int64)
    returns = Returns(pulse, np.zeros(4), xyz, np.ones(4), ones, ones, ones * 2, evidence)
    ghost = Ghosts(np.array([1]), np.array([3.0]), np.array([0.1]), np.array([-2], np.int8))
    found, kinds = add_ghosts(returns, np.zeros(4, np.int8), beams, ghost)
    assert found.pulse.tolist() == [0, 1, 2]
    assert kinds.tolist() == [0, -2, 0]
    assert found.count.tolist() == [1, 1, 1]
    assert np.linalg.norm(found.xyz[1] - EYE) == pytest.approx(3.0)


def test_blades_of_grass_are_told_from_the_ground_by_their_height() -> None:
    xyz = np.array([[5.0, 5, 0.01], [5.0, 5, 0.1], [5.0, 5, 0.3], [5.0, 5, -0.5], [5.0, 5, 0.02]])
    kind = np.array([0, 0, 4, -2, -2], np.int8)
    kinds, labels = labels_of(xyz, kind, flat(Material.GRASS))
    assert kinds.tolist() == [0, 10, 4, -2, -2]
    assert labels.tolist() == [2, 1, 1, 7, 2]
    assert labels_of(xyz, kind, flat(Material.SOIL))[1].tolist() == [2, 2, 1, 7, 2]


def test_a_walker_is_met_where_he_is_at_that_time() -> None:
    body: SiteBody = worker(chance(3, "worker"))
    times = np.array([0.0, 10.0])
    x, y, headings = np.array([12.0, 18.0]), np.array([10.0, 10.0]), np.zeros(2)
    moving = MovingThings([MovementTrack(body, 7, times, x, y, headings)], flat(Material.SOIL))
    for time_s, at in ((0.0, 12.0), (5.0, 15.0)):
        targets = np.column_stack([np.full(41, at), np.linspace(9, 11, 41), np.full(41, 1.0)])
        beams = beams_to(targets, time_s)
        met = BeamHits(
            np.full(41, np.inf),
            np.ones(41),
            np.zeros(41, np.uint8),
            np.zeros(41, np.uint8),
            np.full(41, -1, np.int64),
        )
        moving.meet(beams, met)
        seen = np.isfinite(met.ranges)
        assert 0 < seen.sum() < 30
        assert np.abs(met.ranges[seen] * beams.directions[seen, 0] + EYE[0] - at).max() < 0.9
        assert (met.evidence[seen] // 256 == 7).all()


def test_a_scanner_keeps_to_its_rate_and_its_mirror_s_speed() -> None:
    for name in ("p40", "vz400i", "zf5016"):
        sensor = SENSORS[name]
        for spacing in (0.002, 0.02, 0.2):
            pattern = pattern_of(sensor, spacing)
            assert pattern.step_rad <= spacing / 10 + 1e-12
            assert pattern.column_s >= 1 / sensor.turns_per_s
            assert pattern.pulse_s * sensor.rate_hz >= 1 - 1e-9
