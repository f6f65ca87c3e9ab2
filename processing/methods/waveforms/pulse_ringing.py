"""Returns that are the end of a stronger one's own pulse: a receiver that swings after an echo.

Some receivers answer a strong echo with a damped oscillation. Where its second swing is above the
sensor's threshold it is delivered as a return, always as far behind the echo: a dense layer of
points under the ground. What a recording's flat targets show behind their maximum tells it.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Flags, Floats, Integers
from processing.core.monitor import Monitor
from processing.methods.waveforms.system_pulse import noise_of
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from processing.recording.waveforms import PulseBlock, Waveforms, waveforms_of

_LEARNT_FROM = 8_000
"""Packets, evenly among all, as :mod:`processing.methods.waveforms.drive_echoes` learns from."""

_CLEAR = 25.0
"""Standard deviations of the noise that an echo has whose swing is looked at: one of 4 % is as high
as the noise, and some hundred of them tell it to a tenth of that."""

_NARROWEST = 0.35
"""Share of the clear echoes, by width, that are taken: flat targets across the beam."""

_FEWEST = 20
_LEAST = 0.01
"""Swing, as a share of the echo, below which none is delivered: a threshold of six deviations of
the noise asks an echo of 600."""

_MARGIN = 1.5
"""A return so many times as high as the swing may still be it, with noise of up to half of it. On
simulated flights with ringing 99 % of such returns and 0.4 % of all others are below."""

_PACKETS_AT_ONCE = 16_384


class Ringing(NamedTuple):
    """What a pulse does behind its end.

    ``shares`` (m,) float64 of its maximum, a sample each behind it, 0 up to the pulse's own end;
    ``interval_ns`` between samples.
    """

    shares: Floats
    interval_ns: float


def ringing_returns(drive: Drive, monitor: Monitor) -> Flags | None:
    """Which of a drive's points are swings of the receiver.

    Returns
    -------
    (n,) bool, or None
        None where there are no waveforms, or where the pulse ends without a swing.

    Raises
    ------
    BadFile, MissingInput, Cancelled
    """
    waveforms = waveforms_of(drive)
    ringing = None if waveforms is None else _own_ringing(waveforms)
    if waveforms is None or ringing is None:
        return None
    found = np.zeros(drive.count, np.bool_)
    for block in waveforms.blocks(_PACKETS_AT_ONCE):
        monitor.check()
        several = np.flatnonzero(block.pulses.returns > 1)
        if several.size:
            points, row = waveforms.returns_of(block.pulses.numbers[several])
            found[points] = _are_swings(block, several[row], waveforms.location_ns(points), ringing)
    return found


def _own_ringing(waveforms: Waveforms) -> Ringing | None:
    """The swing of the packets of the commonest description."""
    numbers = np.arange(0, waveforms.count, max(1, waveforms.count // _LEARNT_FROM))
    pulses = waveforms.pulses(numbers)
    own = pulses.descriptor == np.bincount(pulses.descriptor).argmax()
    shares = ringing_of(waveforms.samples_of(numbers[own]), pulses.lengths[own])
    return None if shares is None else Ringing(shares, float(pulses.interval_ns[own][0]))


def ringing_of(samples: NDArray[np.float32], lengths: NDArray[np.int32]) -> Floats | None:
    """What flat targets show behind their maximum.

    Parameters
    ----------
    samples : (n, m) float32
        Counts, some thousand packets.
    lengths : (n,) int32
        Samples of each.

    Returns
    -------
    (m,) float64, or None
        As :class:`Ringing` has them; None where nothing swings.
    """
    noise = noise_of(samples, lengths)
    inside = np.arange(samples.shape[1]) < np.asarray(lengths)[:, None]
    waves = np.where(inside, samples - noise.baseline, 0.0)
    peak = waves.argmax(axis=1)
    height = waves[np.arange(len(waves)), peak]
    rows = np.flatnonzero(height > _CLEAR * noise.sigma)
    widths = (waves[rows] > 0.5 * height[rows, None]).sum(axis=1)
    if rows.size < _FEWEST:
        return None
    rows = rows[widths <= np.quantile(widths, _NARROWEST)]
    shares = np.zeros(samples.shape[1])
    for lag in range(1, samples.shape[1]):
        reached = rows[peak[rows] + lag < np.asarray(lengths)[rows]]
        if reached.size < _FEWEST:
            break
        # The median: some have other echoes there, most have none.
        shares[lag] = np.median(waves[reached, peak[reached] + lag] / height[reached])
    rising = np.flatnonzero(np.diff(shares[1:]) >= 0.0)
    shares[: rising[0] + 2 if rising.size else shares.size] = 0.0
    shares = np.maximum(shares, 0.0)
    return shares if shares.max() >= _LEAST else None


def _are_swings(block: PulseBlock, row: Integers, place_ns: Floats, ringing: Ringing) -> Flags:
    """Which returns are; ``row`` (k,) of their packets in the block, ``place_ns`` in them."""
    pulses = block.pulses
    order = np.lexsort((place_ns, row))
    row, place_ns = row[order], place_ns[order]
    height = echo_shapes(
        block.samples[row], pulses.lengths[row], pulses.interval_ns[row], place_ns
    ).amplitude
    # A swing lies within a sample of where it is looked for.
    padded = np.pad(ringing.shares, 1)
    near = np.maximum(np.maximum(padded[:-2], padded[1:-1]), padded[2:])
    expected = np.zeros(row.size)
    for back in range(1, int(pulses.returns[row].max(initial=1))):
        lag = np.rint((place_ns[back:] - place_ns[:-back]) / ringing.interval_ns)
        known = (row[back:] == row[:-back]) & (lag < near.size) & np.isfinite(height[:-back])
        share = near[np.where(known, lag, 0).astype(np.int64)]
        swing = np.where(known, share * height[:-back], 0.0)
        expected[back:] = np.maximum(expected[back:], swing)
    found = np.zeros(row.size, np.bool_)
    found[order] = height < _MARGIN * expected
    return found
