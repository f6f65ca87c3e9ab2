"""What moves is met where it is at each pulse's time."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.beams import Beams
from processing.laboratory.simulate.scanning.casting import RaycastScene
from processing.laboratory.simulate.scanning.moving import MovingScene, poses_of
from processing.laboratory.simulate.scanning.returns import BeamHits
from processing.laboratory.simulate.scene.materials import Material
from processing.laboratory.simulate.scene.mesh import MeshBuilder, box
from processing.laboratory.simulate.scene.things import Mover
from processing.laboratory.simulate.street.styles import HIGHWAY


def _car(speed_m_s: float, from_s: float = 0.0, to_s: float = 100.0) -> Mover:
    built = MeshBuilder()
    built.add(box((-2.0, -0.9, 0.2), (2.0, 0.9, 1.5)), Material.CAR_PAINT, 64, 5)
    turn = np.pi if speed_m_s < 0 else 0.0
    return Mover(built.mesh(), 20.0, -3.0, speed_m_s, from_s, to_s, turn_rad=turn)


def _watched(street: Street, mover: Mover, seconds: float) -> tuple[Beams, BeamHits]:
    """A beam straight down onto the road at chainage 30, ten thousand times a second."""
    times = np.arange(0, seconds, 1e-4)
    above = street.alignment.at(30.0, -3.0, 50.0)
    directions = np.tile([0.0, 0.0, -1.0], (times.size, 1))
    beams = Beams(0, times, np.tile(above, (times.size, 1)), directions)
    nothing = MeshBuilder().mesh()
    met = BeamHits.of(RaycastScene(nothing, np.zeros(3)).cast(beams.origins, directions), nothing)
    MovingScene(street, [mover]).meet(beams, met)
    return beams, met


def test_a_car_that_passes_is_seen_as_long_as_it_takes_to_pass() -> None:
    street = Street(2, HIGHWAY, 60.0)
    beams, met = _watched(street, _car(10.0), 2.0)
    seen = beams.time_s[np.isfinite(met.ranges)]
    assert seen.min() == pytest.approx(0.8, abs=0.02)
    assert seen.max() == pytest.approx(1.2, abs=0.02)
    assert set(met.label[np.isfinite(met.ranges)].tolist()) == {64}


def test_nothing_is_met_when_it_is_not_there_any_more() -> None:
    street = Street(2, HIGHWAY, 60.0)
    _, met = _watched(street, _car(10.0, to_s=0.7), 2.0)
    assert not np.isfinite(met.ranges).any()


def test_oncoming_vehicles_face_their_way() -> None:
    street = Street(2, HIGHWAY, 60.0)
    times = np.array([0.0, 1.0])
    positions, headings = poses_of(_car(-10.0), street, times)
    direction = positions[1] - positions[0]
    faces = np.array([np.cos(headings[0]), np.sin(headings[0])])
    assert direction[:2] @ faces > 0.99 * np.linalg.norm(direction[:2])
