"""Beams of a spinning head."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.simulate.assembly.street import Street
from processing.laboratory.simulate.scanning.beams import ScanPattern, beams_of, head_axes
from processing.laboratory.simulate.scanning.sensors import SENSORS
from processing.laboratory.simulate.scanning.simulated_passes import Driving, pass_of
from processing.laboratory.simulate.street.styles import URBAN


@pytest.mark.parametrize("head", SENSORS["vq250"].heads, ids=lambda one: one.name)
def test_beams_of_a_turn_lie_square_to_the_axis_and_come_round(head) -> None:
    driven = pass_of(Street(1, URBAN, 40.0), 0, Driving(9.0, stops=False, drift_m=0.0))
    scan_pattern = ScanPattern(360, 50.0, 0.3)
    beams = beams_of(driven, head, scan_pattern, range(3600, 3600 + 361))
    rotations = driven.rotations[np.searchsorted(driven.time_s, beams.time_s) - 1]
    own = np.einsum("nij,ni->nj", rotations, beams.directions) @ head_axes(head)
    assert np.abs(own[:, 2]).max() < 0.005  # the car turns a little meanwhile
    assert np.allclose(np.linalg.norm(beams.directions, axis=1), 1.0)
    assert own[0, :2] == pytest.approx(own[360, :2], abs=0.005)
    assert own[90, :2] == pytest.approx([-own[0, 1], own[0, 0]], abs=0.01)


def test_pulses_are_the_same_in_whatever_pieces_they_are_asked_for() -> None:
    driven = pass_of(Street(1, URBAN, 40.0), 0, Driving(9.0, stops=False, drift_m=0.0))
    head, scan_pattern = SENSORS["zf9012"].heads[0], ScanPattern(5080, 200.0, 1.0)
    whole = beams_of(driven, head, scan_pattern, range(1000, 3000))
    part = beams_of(driven, head, scan_pattern, range(2000, 2500))
    assert np.array_equal(whole.directions[1000:1500], part.directions)
    assert np.array_equal(whole.origins[1000:1500], part.origins)


def test_heads_of_45_degrees_look_ahead_and_back_to_both_sides() -> None:
    left, right = (head_axes(one)[:, 2] for one in SENSORS["vq250"].heads)
    assert left[1] > 0.5 > -0.5 > right[1]
    assert left[0] == pytest.approx(right[0])
