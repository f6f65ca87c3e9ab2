"""Waveforms as attributes of points: what each return looks like in its pulse."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.recording.waveform_packets.echo_shapes import echo_shapes
from processing.recording.waveforms import waveforms_of

BACKSCATTER = "wave_backscatter"

_VALUES_AT_ONCE = 8_000_000
"""Samples held in memory at a time: 32 MB."""

_SAMPLED_POINTS = 20_000
"""Of a drive, to know what is dark and what is bright: a percentile is right to half a percent."""

_REFERENCE_RANGE_M = 1_000.0
"""Backscatter is the energy as it were from here: an airborne scanner's usual height."""


@dataclass(frozen=True)
class WaveformAttribute:
    """A measure of the return in its waveform, by which points are coloured."""

    id: str
    title: Text


WAVEFORM_ATTRIBUTES: Mapping[str, WaveformAttribute] = {
    one.id: one
    for one in (
        WaveformAttribute("wave_amplitude", Text("Waveform: amplitude", "波形: 振幅")),
        WaveformAttribute("wave_width", Text("Waveform: width", "波形: パルス幅")),
        WaveformAttribute("wave_energy", Text("Waveform: energy", "波形: エネルギー")),
        WaveformAttribute("wave_rise", Text("Waveform: rise time", "波形: 立ち上がり時間")),
        WaveformAttribute(BACKSCATTER, Text("Waveform: backscatter", "波形: 後方散乱")),
    )
}
"""By id. Backscatter is known where a trajectory tells the range."""

_MEASURES = {
    "wave_amplitude": "amplitude",
    "wave_width": "width_ns",
    "wave_energy": "energy",
    "wave_rise": "rise_ns",
    BACKSCATTER: "energy",
}


def waveform_values(drive: Drive, name: str, points: Integers) -> Floats:
    """A waveform attribute of points.

    Parameters
    ----------
    name : str
        A key of `WAVEFORM_ATTRIBUTES`.

    Returns
    -------
    (k,) float64
        Counts, ns or counts x ns, as :class:`EchoShapes` says; backscatter: the energy times the
        square of the range in kilometres, as the lidar equation has it for a target that is wider
        than the beam (Shinohara 2022, equation 2.8). NaN where it is not known.

    Raises
    ------
    BadFile, MissingInput, NoSpace
    """
    values = np.full(points.size, np.nan)
    waveforms = waveforms_of(drive)
    if waveforms is None:
        return values
    numbers = waveforms.pulse_of(points)
    with_one = np.flatnonzero(numbers >= 0)
    at_once = max(1, _VALUES_AT_ONCE // waveforms.most_samples)
    for first in range(0, with_one.size, at_once):
        some = with_one[first : first + at_once]
        pulses = waveforms.pulses(numbers[some])
        shapes = echo_shapes(
            waveforms.samples_of(numbers[some]),
            pulses.lengths,
            pulses.interval_ns,
            waveforms.location_ns(points[some]),
        )
        values[some] = getattr(shapes, _MEASURES[name])
    if name == BACKSCATTER:
        values *= (_ranges_m(drive, points) / _REFERENCE_RANGE_M) ** 2
    return values


def waveform_ends(drive: Drive, name: str, percents: tuple[float, float]) -> tuple[float, float]:
    """The values at two percentiles of a drive's points, from a sample of them."""

    def sampled() -> Floats:
        step = max(1, drive.count // _SAMPLED_POINTS)
        values = waveform_values(drive, name, np.arange(0, drive.count, step, dtype=np.int64))
        return np.asarray(values[np.isfinite(values)])

    waveforms_of(drive)  # opened before: while one part is made, no other one can be
    values = drive.kept(("waveform sample", name), sampled)
    if not values.size:
        return 0.0, 1.0
    low, high = np.percentile(values, percents)
    return float(low), float(high)


def _ranges_m(drive: Drive, points: Integers) -> Floats:
    """From the sensor to points; NaN where the trajectory doesn't cover them."""
    ranges = np.full(points.size, np.nan)
    if drive.trajectory is None:
        return ranges
    times = np.asarray(drive.columns["time"][points])
    covered = np.flatnonzero(drive.trajectory.covers(times))
    sensor = drive.trajectory.positions_at(times[covered])
    ranges[covered] = np.linalg.norm(drive.xyz(points[covered]) - sensor, axis=1)
    return ranges
