"""Where in the pulse behind a point the local network saw a class: Grad-CAM.

The local network isn't the model that classifies flights; `pulse_occlusion` asks that one.

References
----------
Shinohara 2022, section 3.5.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cache

import numpy as np
from numpy.typing import NDArray

from processing.core.arrays import Floats, Integers
from processing.core.text import Text
from processing.methods.waveforms.local_network import (
    FIRST_AT_NS,
    SAMPLES,
    LocalNetwork,
    cleaned_waves,
    grad_cam,
    read_local_network,
    scale_of,
    shares_of,
)
from processing.recording.columns.counted_classes import class_columns
from processing.recording.drive import Drive
from processing.recording.waveforms import Waveforms, waveforms_of
from resources import path_of

CLASS_CODES = (2, 5, 6, 14, 15, 11)
"""What the network's classes are: the order of the tables of Shinohara 2022."""

_SAMPLE = 500
"""Pulses of a flight, evenly spread, that its middle peak is taken of."""

_NO_WAVEFORM = Text("This point has no waveform.", "この点に波形はありません。")


@dataclass(frozen=True, eq=False)
class PulseGradCam:
    """Where a waveform speaks for a class, by the local network.

    Attributes
    ----------
    code, share : int, float
        The class that the point has, and how likely the network finds it; the likeliest where the
        point has none of the six.
    likeliest, likeliest_share : int, float
        The class that the network itself would give.
    times_ns : (k,) float64
        After the packet's first sample, rising.
    seen : (k,) float32
        0 to 1 of the greatest.
    """

    code: int
    share: float
    likeliest: int
    likeliest_share: float
    times_ns: Floats
    seen: NDArray[np.float32]


def grad_cam_of_pulse(
    drive: Drive, point: int, network: LocalNetwork | None = None
) -> PulseGradCam | Text:
    """Ask the local network about the pulse behind a point; a sentence where it has none.

    Parameters
    ----------
    network : LocalNetwork, optional
        None for the one that comes with the program.

    Raises
    ------
    BadFile, MissingInput, NoSpace
    """
    network = network or shipped_local_network()
    waveforms = waveforms_of(drive)
    number = -1 if waveforms is None else int(waveforms.pulse_of(np.array([point]))[0])
    if waveforms is None or number < 0:
        return _NO_WAVEFORM
    scale = drive.kept("middle peak of pulses", lambda: _middle_peak(waveforms))
    numbers = np.array([number])
    first_ns = _first_ns(waveforms, numbers)
    maps = network.maps(_waves(waveforms, numbers, first_ns) / np.float32(scale))
    (shares,) = shares_of(network.scores(maps))
    best = int(shares.argmax())
    code = int(class_columns(drive.columns).codes_of(np.array([point]))[0])
    asked = CLASS_CODES.index(code) if code in CLASS_CODES else best
    times = np.arange(SAMPLES) - FIRST_AT_NS + first_ns[0]
    pulses = waveforms.pulses(numbers)
    inside = (times >= 0) & (times <= (int(pulses.lengths[0]) - 1) * float(pulses.interval_ns[0]))
    return PulseGradCam(
        CLASS_CODES[asked],
        float(shares[asked]),
        CLASS_CODES[best],
        float(shares[best]),
        times[inside],
        grad_cam(network.class_gradients[asked], maps[0])[inside],
    )


@cache
def shipped_local_network() -> LocalNetwork:
    """The network that comes with the program."""
    return read_local_network(path_of("models/waveforms/local_network.onnx"))


def _middle_peak(waveforms: Waveforms) -> float:
    count = min(_SAMPLE, waveforms.count)
    numbers = np.unique(np.linspace(0, waveforms.count - 1, count).astype(np.int64))
    waves = _waves(waveforms, numbers, _first_ns(waveforms, numbers))
    return scale_of(waves.max(axis=1))


def _waves(waveforms: Waveforms, numbers: Integers, first_ns: Floats) -> NDArray[np.float32]:
    pulses = waveforms.pulses(numbers)
    samples = waveforms.samples_of(numbers)
    return cleaned_waves(samples, pulses.lengths, pulses.interval_ns, first_ns)


def _first_ns(waveforms: Waveforms, numbers: Integers) -> Floats:
    """(k,) where the first return of each packet lies."""
    return np.asarray(waveforms.location_ns(waveforms.owners(numbers)), np.float64)
