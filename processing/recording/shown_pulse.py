"""The pulse behind a point, as it is looked at: its samples and the returns on it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.recording.drive import Drive
from processing.recording.waveform_facts import waveform_facts
from processing.recording.waveform_packets.descriptors import (
    PACKET,
    WHY_NO_PACKET,
    NoPacket,
    WaveformDescriptor,
)
from processing.recording.waveform_packets.echo_shapes import EchoShapes, echo_shapes
from processing.recording.waveforms import waveforms_of


@dataclass(frozen=True, eq=False)
class ShownPulse:
    """A pulse and what is on it.

    Attributes
    ----------
    number, count : int
        Of the pulse, from 0, and how many the drive has.
    descriptor : WaveformDescriptor
    counts : (m,) float32
    points : (k,) int64
        The returns, by their place.
    places_ns : (k,) float64
        After the first sample.
    shapes : EchoShapes
        Of the returns.
    heights : (k,) float64
        Of the returns, m.
    metres_in_ns : float
        Along the ray, away from the sensor; NaN where no ray was delivered.
    range_m : float
        From the sensor to the first sample; NaN without a trajectory.
    chosen : int
        Which of the returns was asked for.
    """

    number: int
    count: int
    descriptor: WaveformDescriptor
    counts: NDArray[np.float32]
    points: Integers
    places_ns: Floats
    shapes: EchoShapes
    heights: Floats
    metres_in_ns: float
    range_m: float
    chosen: int


def pulse_behind(drive: Drive, point: int) -> ShownPulse | Text:
    """The pulse that a point is a return of, or a sentence on why there is none.

    Raises
    ------
    BadFile, MissingInput, NoSpace
    """
    waveforms = waveforms_of(drive)
    if waveforms is None:
        facts = waveform_facts(drive)
        remarks = () if facts is None else facts.remarks
        return remarks[0] if remarks else _NO_WAVEFORMS
    number = int(waveforms.pulse_of(np.array([point]))[0])
    if number < 0:
        why = NoPacket(int(drive.columns[PACKET][point]))
        return _NONE_HERE.filled(reason=WHY_NO_PACKET[why])
    pulses = waveforms.pulses(np.array([number]))
    points = waveforms.points_of(number)
    places = waveforms.location_ns(points)
    length = int(pulses.lengths[0])
    counts = waveforms.samples_of(np.array([number]))[:, :length]
    shapes = echo_shapes(
        np.repeat(counts, points.size, axis=0),
        np.full(points.size, length, np.int32),
        np.full(points.size, pulses.interval_ns[0]),
        places,
    )
    speed = float(np.linalg.norm(pulses.direction[0]))
    return ShownPulse(
        number=number,
        count=waveforms.count,
        descriptor=waveforms.descriptors[int(pulses.descriptor[0])],
        counts=counts[0],
        points=points,
        places_ns=places,
        shapes=shapes,
        heights=drive.xyz(points)[:, 2],
        metres_in_ns=speed if speed > 0 else float("nan"),
        range_m=_range_to(drive, int(pulses.owners[0]), pulses.anchor[0]),
        chosen=int(np.flatnonzero(points == point)[0]),
    )


_NO_WAVEFORMS = Text(
    "This recording has no waveforms: its files hold points alone.",
    "この計測データに波形はありません（点のみのファイルです）。",
)
_NONE_HERE = Text("This point has no waveform: {reason}.", "この点に波形はありません: {reason}。")


def _range_to(drive: Drive, point: int, place: Floats) -> float:
    """From the sensor at a point's time to a place, m; NaN where nobody knows where it was."""
    trajectory = drive.trajectory
    time = np.array([float(drive.columns["time"][point])])
    if trajectory is None or not trajectory.covers(time)[0]:
        return float("nan")
    return float(np.linalg.norm(trajectory.positions_at(time)[0] - place))
