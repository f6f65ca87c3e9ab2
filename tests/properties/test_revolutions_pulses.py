"""Whatever the clock and however many pulses are lost, pulses are numbered as they were fired."""

from __future__ import annotations

import numpy as np
from hypothesis import given, settings
from hypothesis import strategies as st

from processing.recording.columns.point_source import PointColumns
from processing.recording.revolutions.pulse_clock import PulseNumbering, estimate_clock


def _points(time: np.ndarray) -> PointColumns:
    ones = np.ones(time.size, dtype=np.uint8)
    xyz = np.arange(3 * time.size, dtype=np.int32).reshape(-1, 3)
    return PointColumns(xyz, (0.001,) * 3, (0.0,) * 3, time, ones, ones)


def _fired(seed: int, kept_share: float, gaps: int) -> np.ndarray:
    """Pulses that came back: some lost one by one, some in gaps of up to a turn."""
    random = np.random.default_rng(seed)
    fired = np.ones(30_000, dtype=bool)
    fired[random.uniform(size=fired.size) > kept_share] = False
    for start in random.integers(0, fired.size, gaps):
        fired[start : start + int(random.integers(10, 3_000))] = False
    fired[:2_000] |= random.uniform(size=2_000) < kept_share
    return np.flatnonzero(fired)


@settings(max_examples=40, deadline=None)
@given(
    seed=st.integers(0, 10_000),
    rate_hz=st.floats(20_000.0, 900_000.0),
    kept_share=st.floats(0.4, 1.0),
    gaps=st.integers(0, 8),
    start=st.sampled_from([0.0, 63_353.27, 376_892_634.29]),
)
def test_exact_times_give_back_the_pulses(seed, rate_hz, kept_share, gaps, start):
    pulses = _fired(seed, kept_share, gaps)
    points = _points(start + pulses / rate_hz)
    clock = estimate_clock([points])
    assert clock is not None
    numbering = PulseNumbering(clock, float(points.time[0]), 7)
    numbers = numbering.number(points, is_last=True)
    assert (numbers - 7 == pulses - pulses[0]).all()


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), cuts=st.lists(st.integers(1, 800), max_size=5))
def test_stretches_number_as_the_whole_does(seed, cuts):
    pulses = _fired(seed, 0.8, 3)
    for quantum in (0.0, 2.0**-18):
        time = pulses / 1.016e6
        time = np.floor(time / quantum) * quantum if quantum else time
        points = _points(time)
        clock = estimate_clock([points])
        assert clock is not None
        whole = PulseNumbering(clock, 0.0, 0).number(points, is_last=True)
        parts, start = [], 0
        numbering = PulseNumbering(clock, 0.0, 0)
        for cut in [*(25 * cut for cut in sorted(set(cuts))), points.count]:
            stop = min(cut, points.count)
            if stop <= start:
                continue
            part = points.chunk(start, stop)
            numbers = numbering.number(part, is_last=stop == points.count)
            parts.append(numbers)
            start += numbers.size
        assert (np.concatenate(parts) == whole).all()
        assert (np.diff(whole) > 0).all()
