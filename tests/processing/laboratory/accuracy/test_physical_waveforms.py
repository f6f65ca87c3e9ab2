"""The thesis' physical peer: pulses where a beam from above meets the lowest points."""

from __future__ import annotations

import numpy as np
import pytest

from processing.laboratory.accuracy.archives.physical_waveforms import (
    LowestSurface,
    physical_waveforms,
)
from processing.methods.waveforms.estimation.packet_inputs import SystemResponse
from processing.tools.tool import MadePackets, MadePoints


def test_a_beam_on_a_plane_is_the_pulse_at_its_first_return_or_below() -> None:
    side = np.arange(0.25, 10.0, 0.5)
    x, y = (one.ravel() for one in np.meshgrid(side, side))
    surface = LowestSurface(np.column_stack([x, y, 0 * x]), 0.5)
    times = np.arange(-10.0, 10.0, 0.1)
    pulse = SystemResponse(times, np.exp(-0.5 * (times / 1.7) ** 2))
    on_it, above = [5.0, 5.0, 0.0], [5.0, 5.0, 3.0]
    packets = MadePackets(
        np.array([0, 1]),
        np.full(2, 12_500.0, np.float32),
        np.zeros((2, 3), np.float32),
        np.zeros((2, 160), np.uint16),
    )
    (made,) = physical_waveforms(
        [MadePoints(np.array([on_it, above]), {}, {}, packets)], surface, pulse
    )
    assert made.packets is not None
    ground, crown = made.packets.samples / 256.0
    assert ground[[12, 13]] == pytest.approx([95.8, 95.8], abs=0.1)
    assert (crown @ np.arange(160)) / crown.sum() == pytest.approx(12.5 + 3.0 / 0.149896, abs=0.05)
