"""What the waveform says of each delivered return, against the scanner's pulse and the flight.

Counts and nanoseconds are a scanner's own. Widths are told in widths of the system's pulse, which
the narrowest lone echoes of the same recording show, and brightness in that of its bare ground, so
that another pulse, gain or height gives the same numbers.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from processing.recording.waveforms import Waveforms, waveforms_of

RETURN_MEASURES = 6
"""Brightness, width, area over height, rise, share of the pulse's energy, its whole energy."""

_NEUTRAL = np.array([0.0, 1.0, 1.0, 1.0, 1.0, 0.0], np.float32)
"""Of a return without a waveform: that of bare ground across the beam."""

_MOST = np.array([6.0, 6.0, 6.0, 6.0, 1.5, 8.0], np.float32)
"""Larger values mean the same: 64 times as bright as the ground, six pulses wide."""

_AT_ONCE = 8_192
"""Waveforms in memory: 8 MB where one has 240 samples."""

_SAMPLE = 40_000
"""Returns, evenly among all of a drive, that its pulse is taken from."""

_POINTS_AT_ONCE = 1 << 18

_NARROW = 0.2
"""Share of the lone echoes that are narrower than what is taken for the system's: surfaces across
the beam, past the noise of the narrowest."""


class PulseReference(NamedTuple):
    """What a recording's returns are told against.

    ``width_ns``, ``area_ns`` over height and ``rise_ns`` of echoes of flat targets; ``amplitude``
    and ``energy`` of its ground, counts and counts x ns.
    """

    width_ns: float
    area_ns: float
    rise_ns: float
    amplitude: float
    energy: float


def raw_measures(waveforms: Waveforms, points: Integers) -> Floats:
    """(k, 5) amplitude, width, energy, rise, energy of the whole packet; NaN without a waveform.

    Raises
    ------
    BadFile, MissingInput, NoSpace
    """
    found = np.full((points.size, 5), np.nan)
    numbers = waveforms.pulse_of(points)
    with_one = np.flatnonzero(numbers >= 0)
    for first in range(0, with_one.size, _AT_ONCE):
        some = with_one[first : first + _AT_ONCE]
        pulses = waveforms.pulses(numbers[some])
        samples = waveforms.samples_of(numbers[some])
        places = waveforms.location_ns(points[some])
        found[some] = measures_of_samples(samples, pulses.lengths, pulses.interval_ns, places)
    return found


def measures_of_samples(
    samples: NDArray[np.float32],
    lengths: NDArray[np.int32],
    interval_ns: Floats,
    place_ns: Floats,
) -> Floats:
    """(k, 5) as :func:`raw_measures`, of waveforms of which a row is that of a return.

    Parameters
    ----------
    samples : (k, m) float32
        Counts; 0 behind the length.
    lengths : (k,) int32
    interval_ns, place_ns : (k,) float64
        Between samples; of the return, after the first sample.
    """
    shapes = echo_shapes(samples, lengths, interval_ns, place_ns)
    whole = samples.sum(axis=1, dtype=np.float64) - shapes.baseline * lengths
    return np.column_stack(
        [shapes.amplitude, shapes.width_ns, shapes.energy, shapes.rise_ns, whole * interval_ns]
    )


def pulse_reference(
    raw: Floats, is_only: NDArray[np.bool_], is_ground: NDArray[np.bool_]
) -> PulseReference | None:
    """What the returns of a recording are told against; None where too little has a waveform.

    Parameters
    ----------
    raw : (k, 5) float64
        As :func:`raw_measures` gives it, of a sample of all returns.
    is_only, is_ground : (k,) bool
        Whether a return is its pulse's only one, and on the ground.
    """
    clear = np.isfinite(raw).all(axis=1) & (raw[:, 0] > 0) & (raw[:, 4] > 0)
    lone = raw[clear & is_only]
    lone = lone if len(lone) else raw[clear]
    if not len(lone):
        return None
    bare = raw[clear & is_only & is_ground]
    bare = bare if len(bare) else lone
    width, area, rise = (
        float(np.quantile(one, _NARROW))
        for one in (lone[:, 1], lone[:, 2] / lone[:, 0], lone[:, 3])
    )
    if min(width, area, rise) <= 0:
        return None
    return PulseReference(width, area, rise, *np.median(bare[:, [0, 4]], axis=0).tolist())


def return_measures(raw: Floats, reference: PulseReference) -> NDArray[np.float32]:
    """(k, :data:`RETURN_MEASURES`) float32: returns against the recording, finite."""
    amplitude, width, energy, rise, whole = raw.T
    with np.errstate(invalid="ignore", divide="ignore"):
        columns = [
            np.log2(np.maximum(amplitude, 1e-6) / reference.amplitude),
            width / reference.width_ns,
            energy / amplitude / reference.area_ns,
            rise / reference.rise_ns,
            energy / np.maximum(whole, energy),
            np.log2(np.maximum(whole, 1e-6) / reference.energy),
        ]
    measures = np.column_stack(columns).astype(np.float32)
    measures = np.where(np.isfinite(measures), measures, _NEUTRAL)
    return np.asarray(np.clip(measures, -_MOST, _MOST), np.float32)


def broad_returns(drive: Drive, widest: float, monitor: Monitor) -> Flags | None:
    """Which of a drive's points come of echoes that are wide for the recording.

    Parameters
    ----------
    widest : float
        In widths of the recording's narrowest echoes.

    Returns
    -------
    (n,) bool, or None
        None without waveforms; points without one are not.

    Raises
    ------
    BadFile, MissingInput, NoSpace, Cancelled

    References
    ----------
    Doneus and others 2008; Mücke 2010: low plants widen the echo of the ground.
    """
    waveforms = waveforms_of(drive)
    if waveforms is None:
        return None
    some = np.arange(0, drive.count, max(1, drive.count // _SAMPLE))
    columns, is_only = drive.columns, np.ones(some.size, np.bool_)
    if columns.has("number_of_returns"):
        is_only = np.asarray(columns["number_of_returns"][some]) <= 1
    reference = pulse_reference(raw_measures(waveforms, some), is_only, is_only)
    if reference is None:
        return None
    found = np.zeros(drive.count, np.bool_)
    for start in range(0, drive.count, _POINTS_AT_ONCE):
        monitor.check()
        points = np.arange(start, min(start + _POINTS_AT_ONCE, drive.count))
        measures = return_measures(raw_measures(waveforms, points), reference)
        found[points] = measures[:, 1] > widest
    return found


def neutral_measures(count: int) -> NDArray[np.float32]:
    """(count, :data:`RETURN_MEASURES`) what returns without a waveform are taken for."""
    return np.tile(_NEUTRAL, (count, 1))
